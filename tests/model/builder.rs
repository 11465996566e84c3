//! A writer of containers, for models that tests make up.

use zstrip::bytemuck::{Pod, Zeroable, bytes_of, cast_slice};
use zstrip::math::{Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::model::container::{
    Channel, Clip, Cluster, Delta, Header, Influence, Joint, MAGIC, Material, NONE, NONE_LONG, Node, Part, Section,
    SectionKind, Skin, Target, Texture, Timeline, VERSION,
};

/// A model as lists. Numbers that follow from the lists are filled in by [`build`](Self::build).
#[derive(Clone, Debug, Default)]
pub struct Builder {
    pub nodes: Vec<Node>,
    pub parts: Vec<PartLists>,
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    pub skins: Vec<Vec<Joint>>,
    pub clips: Vec<ClipLists>,
    /// Weights of morph targets at rest.
    pub weights: Vec<i16>,
    pub bytes: Vec<u8>,
}

/// A part as lists; empty ones are left out.
#[derive(Clone, Debug)]
pub struct PartLists {
    pub item: Part,
    pub points: Vec<[i16; 3]>,
    pub normals: Vec<[i8; 2]>,
    pub colors: Vec<[u8; 3]>,
    pub uvs: Vec<[u16; 2]>,
    pub small_uvs: Vec<[u8; 2]>,
    pub triangles: Vec<[u16; 3]>,
    pub influences: Vec<Influence>,
    /// First vertices and deltas.
    pub targets: Vec<(u16, Vec<Delta>)>,
    pub clusters: Vec<Cluster>,
}

#[derive(Clone, Debug, Default)]
pub struct ClipLists {
    pub name: &'static str,
    pub duration: u32,
    /// Channels with the times of their keys, and the values.
    pub channels: Vec<(Channel, Vec<u16>, Vec<i16>)>,
}

/// The bytes of a container, which begin at a multiple of 4.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Container {
    words: Vec<u32>,
    length: usize,
}

impl Container {
    pub fn of(bytes: &[u8]) -> Self {
        let mut words = vec![0; bytes.len().div_ceil(4)];
        zstrip::bytemuck::cast_slice_mut(&mut words)[..bytes.len()].copy_from_slice(bytes);
        Self { words, length: bytes.len() }
    }

    pub fn bytes(&self) -> &[u8] {
        &cast_slice(&self.words)[..self.length]
    }
}

/// A node without parent, parts and name that changes nothing.
pub fn node() -> Node {
    Node { parent: NONE, rotation: [0, 0, 0, 0x7FFF], scale: [1 << 16; 3], ..Node::zeroed() }
}

/// A white material.
pub fn material() -> Material {
    Material { color: [255; 4], texture: NONE, ..Material::zeroed() }
}

impl PartLists {
    /// Makes a part of positions and triangles.
    pub fn new(scale: i32, offset: [i32; 3], points: Vec<[i16; 3]>, triangles: Vec<[u16; 3]>) -> Self {
        let item = Part { scale, offset, skin: NONE, coarser: NONE, uv_bits: 16, ..Part::zeroed() };
        Self {
            item,
            points,
            normals: vec![],
            colors: vec![],
            uvs: vec![],
            small_uvs: vec![],
            triangles,
            influences: vec![],
            targets: vec![],
            clusters: vec![],
        }
    }
}

/// Sections that grow.
struct Sections([(Vec<u8>, u32); SectionKind::COUNT]);

impl Sections {
    /// Appends items, and returns the number of the first one.
    fn add<T: Pod>(&mut self, kind: SectionKind, items: &[T]) -> u32 {
        let (bytes, count) = &mut self.0[kind as usize];
        let first = *count;
        bytes.extend_from_slice(cast_slice(items));
        *count += items.len() as u32;
        first
    }

    /// The same for an attribute: [`NONE_LONG`] if there are none.
    fn add_some<T: Pod>(&mut self, kind: SectionKind, items: &[T]) -> u32 {
        if items.is_empty() { NONE_LONG } else { self.add(kind, items) }
    }
}

impl Builder {
    /// Adds a name to the bytes, and returns its place.
    pub fn name(&mut self, name: &str) -> (u32, u16) {
        let first = self.bytes.len() as u32;
        self.bytes.extend_from_slice(name.as_bytes());
        (first, name.len() as u16)
    }

    /// Adds bytes at an even place, and returns it.
    pub fn data(&mut self, data: &[u8]) -> u32 {
        self.bytes.resize(self.bytes.len().next_multiple_of(2), 0);
        let first = self.bytes.len() as u32;
        self.bytes.extend_from_slice(data);
        first
    }

    pub fn build(mut self) -> Container {
        let mut to = Sections(core::array::from_fn(|_| (vec![], 0)));
        let most = self.skins.iter().map(Vec::len).max().unwrap_or(0);
        let mut pose_words = 12 * (self.nodes.len() + most) + self.weights.len();
        for lists in &self.parts {
            let mut part = lists.item;
            let positions = Positions::Quantized {
                points: &lists.points,
                scale: Scalar::from_bits(part.scale),
                offset: Vec3::from_bits(part.offset),
            };
            let mesh =
                Mesh::new(MeshData { indices: Some(lists.triangles.as_flattened()), ..MeshData::new(positions) });
            let bounds = *mesh.expect("a mesh").bounds();
            (part.center, part.half) = (bounds.center.to_bits(), bounds.half.to_bits());
            part.first_vertex = to.add(SectionKind::Points, &lists.points);
            part.vertices = lists.points.len() as u32;
            part.first_index = to.add(SectionKind::Indices, lists.triangles.as_flattened());
            part.triangles = lists.triangles.len() as u32;
            part.first_normal = to.add_some(SectionKind::Normals, &lists.normals);
            part.first_color = to.add_some(SectionKind::Colors, &lists.colors);
            if lists.small_uvs.is_empty() {
                part.first_uv = to.add_some(SectionKind::Uvs, &lists.uvs);
            } else {
                part.first_uv = to.add_some(SectionKind::SmallUvs, &lists.small_uvs);
                part.uv_bits = 8;
            }
            part.first_influence = to.add(SectionKind::Influences, &lists.influences);
            part.first_cluster = to.add(SectionKind::Clusters, &lists.clusters);
            part.clusters = lists.clusters.len() as u16;
            part.targets = lists.targets.len() as u16;
            part.first_target = to.0[SectionKind::Targets as usize].1;
            for (first_vertex, deltas) in &lists.targets {
                let first_delta = to.add(SectionKind::Deltas, deltas);
                let vertices = deltas.len() as u16;
                to.add(SectionKind::Targets, &[Target { first_delta, first_vertex: *first_vertex, vertices }]);
            }
            part.pose = NONE_LONG;
            if part.skin != NONE || part.targets > 0 {
                part.pose = pose_words as u32;
                let vectors = 3 * lists.points.len().div_ceil(2);
                pose_words += 10 + if lists.normals.is_empty() { vectors } else { 2 * vectors };
            }
            to.add(SectionKind::Parts, &[part]);
        }
        for joints in &self.skins {
            let first_joint = to.add(SectionKind::Joints, joints);
            to.add(SectionKind::Skins, &[Skin { first_joint, joints: joints.len() as u32 }]);
        }
        for clip in core::mem::take(&mut self.clips) {
            let (name, name_length) = self.name(clip.name);
            let first_channel = to.0[SectionKind::Channels as usize].1;
            for (channel, times, keys) in &clip.channels {
                let first_time = to.add(SectionKind::Times, times);
                let timeline = to.add(SectionKind::Timelines, &[Timeline { first_time, times: times.len() as u32 }]);
                let first_key = to.add(SectionKind::Keys, keys);
                to.add(SectionKind::Channels, &[Channel { timeline, first_key, ..*channel }]);
            }
            let item = Clip {
                first_channel,
                channels: clip.channels.len() as u32,
                duration: clip.duration,
                name,
                name_length: name_length.into(),
                ..Clip::zeroed()
            };
            to.add(SectionKind::Clips, &[item]);
        }
        to.add(SectionKind::Nodes, &self.nodes);
        to.add(SectionKind::Materials, &self.materials);
        to.add(SectionKind::Textures, &self.textures);
        let rest_weights = to.add(SectionKind::Keys, &self.weights);
        to.add(SectionKind::Bytes, &self.bytes);

        let mut header = Header {
            magic: MAGIC,
            version: VERSION,
            sections: SectionKind::COUNT as u16,
            draws: self.nodes.iter().map(|node| u32::from(node.parts)).sum(),
            pose_words: pose_words as u32,
            weights: self.weights.len() as u32,
            rest_weights,
            half: [1 << 16; 3],
            ..Header::zeroed()
        };
        let mut bytes = vec![0; size_of::<Header>()];
        for (place, (section, count)) in header.table.iter_mut().zip(&to.0) {
            *place = Section { offset: bytes.len() as u32, count: *count };
            bytes.extend_from_slice(section);
            bytes.resize(bytes.len().next_multiple_of(4), 0);
        }
        header.length = bytes.len() as u32;
        bytes[..size_of::<Header>()].copy_from_slice(bytes_of(&header));
        Container::of(&bytes)
    }
}
