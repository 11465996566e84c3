//! Bytes in, a [`Model`] out: every number that the frame path relies on is checked here, once.

use super::container::{
    AlphaMode, Channel, Clip, Cluster, Delta, Header, Influence, Interpolation, Joint, MAGIC, Material, NONE,
    NONE_LONG, Node, Part, Path, Section, SectionKind, Skin, Target, Texture, TextureFormat, Timeline, VERSION,
};
use super::error::ModelError;
use crate::math::{Scalar, Vec3};
use crate::mesh::{Bounds, Mesh, MeshData, Positions};
use bytemuck::Pod;
use core::mem::offset_of;
use core::ops::RangeInclusive;

/// A checked model in the bytes of a [container](crate::model::container). Copying it copies references only.
#[derive(Clone, Copy, Debug)]
pub struct Model<'a> {
    pub(super) header: &'a Header,
    pub(super) nodes: &'a [Node],
    pub(super) parts: &'a [Part],
    pub(super) clusters: &'a [Cluster],
    pub(super) materials: &'a [Material],
    pub(super) textures: &'a [Texture],
    pub(super) skins: &'a [Skin],
    pub(super) joints: &'a [Joint],
    pub(super) targets: &'a [Target],
    pub(super) clips: &'a [Clip],
    pub(super) channels: &'a [Channel],
    pub(super) timelines: &'a [Timeline],
    pub(super) points: &'a [[i16; 3]],
    pub(super) normals: &'a [[i8; 2]],
    pub(super) colors: &'a [[u8; 3]],
    pub(super) uvs: &'a [[u16; 2]],
    pub(super) small_uvs: &'a [[u8; 2]],
    pub(super) indices: &'a [u16],
    pub(super) influences: &'a [Influence],
    pub(super) deltas: &'a [Delta],
    pub(super) times: &'a [u16],
    pub(super) keys: &'a [i16],
    pub(super) bytes: &'a [u8],
}

/// Words of a node's transform, or of a joint's, in the memory of a pose.
pub(super) const MATRIX_WORDS: usize = 12;

/// Words before the posed vertices of a part in the memory of a pose: scale, offset, middle and half of the box.
pub(super) const POSED_HEAD: usize = 10;

/// Returns the number of words of that many vectors of three 16-bit numbers.
pub(super) const fn vector_words(vectors: usize) -> usize {
    3 * vectors.div_ceil(2)
}

/// Returns some items of a section.
pub(super) fn items<T>(all: &[T], first: u32, count: usize) -> &[T] {
    all.get(first as usize..).and_then(|rest| rest.get(..count)).unwrap_or_default()
}

/// Returns the little-endian number at a byte; 0 past the end.
const fn number_at(bytes: &[u8], at: usize) -> usize {
    match bytes.split_at_checked(at) {
        Some((_, [a, b, c, d, ..])) => u32::from_le_bytes([*a, *b, *c, *d]) as usize,
        _ => 0,
    }
}

/// Returns the number of words that a pose takes, from the bytes of a container.
pub(super) const fn pose_words(bytes: &[u8]) -> usize {
    number_at(bytes, offset_of!(Header, pose_words))
}

impl<'a> Model<'a> {
    /// Returns the number of draws that the bytes of a container speak of: for the size of an array in a constant, as
    /// [`place`](Self::place) takes it. [`from_bytes`](Self::from_bytes) checks it.
    #[must_use]
    pub const fn draws(bytes: &[u8]) -> usize {
        number_at(bytes, offset_of!(Header, draws))
    }

    /// Reads a model where it lies: nothing is copied. The bytes begin at a multiple of 4, as
    /// [`include_model`](crate::include_model) makes them; bytes past the container's end are ignored.
    ///
    /// # Errors
    /// The first mistake found, with the number found and the one that was needed. What this function accepts is drawn
    /// without errors. It takes some instructions per vertex and triangle: call it once, not per frame.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, ModelError> {
        let model = Self::of_sections(bytes)?;
        model.check()?;
        Ok(model)
    }

    /// Returns the box around the model at rest.
    #[must_use]
    pub const fn bounds(&self) -> Bounds {
        bounds_of(self.header.center, self.header.half)
    }

    /// Returns the number of triangles of the finest parts, counted once per draw.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        let parts = self.nodes.iter().flat_map(|node| items(self.parts, node.first_part.into(), node.parts.into()));
        parts.fold(0, |sum, part| sum.saturating_add(part.triangles as usize))
    }

    /// Returns the mesh of a part at rest, for draws of one's own: positions, indices, colours and bounds. Normals and
    /// texture coordinates are packed, and not in it.
    #[must_use]
    pub fn mesh(&self, part: usize) -> Option<Mesh<'a>> {
        self.parts.get(part).map(|part| self.mesh_of(part))
    }

    pub(super) fn mesh_of(&self, part: &Part) -> Mesh<'a> {
        Mesh::of_checked(self.mesh_data(part), bounds_of(part.center, part.half), part.triangles as u16)
    }

    /// Returns the number of a node by its name.
    #[must_use]
    pub fn node_named(&self, name: &str) -> Option<usize> {
        self.nodes.iter().position(|node| self.name(node.name, node.name_length.into()) == name.as_bytes())
    }

    /// Returns the bytes of a name.
    pub(super) fn name(&self, first: u32, length: usize) -> &'a [u8] {
        items(self.bytes, first, length)
    }

    fn of_sections(bytes: &'a [u8]) -> Result<Self, ModelError> {
        let past = bytes.as_ptr().align_offset(4);
        if past != 0 {
            return Err(ModelError::Misaligned { past: 4_usize.saturating_sub(past) });
        }
        let short = |needed: usize| ModelError::Short { found: bytes.len(), needed };
        let head = bytes.get(..size_of::<Header>()).and_then(|head| bytemuck::try_from_bytes::<Header>(head).ok());
        let Some(header) = head else {
            return Err(match bytes.first_chunk() {
                Some(magic) if *magic != MAGIC => ModelError::Magic { found: *magic },
                _ => short(size_of::<Header>()),
            });
        };
        if header.magic != MAGIC {
            return Err(ModelError::Magic { found: header.magic });
        }
        if header.version != VERSION || cfg!(target_endian = "big") {
            return Err(ModelError::Version { found: header.version, needed: VERSION });
        }
        let count = SectionKind::COUNT as i64;
        in_range(None, 0, "sections", header.sections.into(), count..=count)?;
        let Some(bytes) = bytes.get(..header.length as usize) else { return Err(short(header.length as usize)) };
        in_range(None, 0, "length", header.length.into(), size_of::<Header>() as i64..=u32::MAX.into())?;
        let from = Sections { bytes, header };
        Ok(Self {
            header,
            nodes: from.section(SectionKind::Nodes)?,
            parts: from.section(SectionKind::Parts)?,
            clusters: from.section(SectionKind::Clusters)?,
            materials: from.section(SectionKind::Materials)?,
            textures: from.section(SectionKind::Textures)?,
            skins: from.section(SectionKind::Skins)?,
            joints: from.section(SectionKind::Joints)?,
            targets: from.section(SectionKind::Targets)?,
            clips: from.section(SectionKind::Clips)?,
            channels: from.section(SectionKind::Channels)?,
            timelines: from.section(SectionKind::Timelines)?,
            points: from.section(SectionKind::Points)?,
            normals: from.section(SectionKind::Normals)?,
            colors: from.section(SectionKind::Colors)?,
            uvs: from.section(SectionKind::Uvs)?,
            small_uvs: from.section(SectionKind::SmallUvs)?,
            indices: from.section(SectionKind::Indices)?,
            influences: from.section(SectionKind::Influences)?,
            deltas: from.section(SectionKind::Deltas)?,
            times: from.section(SectionKind::Times)?,
            keys: from.section(SectionKind::Keys)?,
            bytes: from.section(SectionKind::Bytes)?,
        })
    }

    fn check(&self) -> Result<(), ModelError> {
        let [x, y, z] = self.header.half;
        in_range(None, 0, "half", x.min(y).min(z).into(), 0..=i64::from(i32::MAX))?;
        // Others add the number of weights to numbers of their own.
        in_range(None, 0, "weights", self.header.weights.into(), 0..=0xFFFF)?;
        let (first, count) = (self.header.rest_weights, self.header.weights.into());
        within(None, 0, "rest_weights", first, count, self.keys.len())?;
        self.check_nodes()?;
        self.check_materials()?;
        self.check_skins()?;
        let pose_words = self.check_parts()?;
        self.check_clips()?;
        in_range(None, 0, "pose_words", self.header.pose_words.into(), exactly(pose_words))
    }

    fn check_nodes(&self) -> Result<(), ModelError> {
        let mut draws = 0;
        for (k, node) in self.nodes.iter().enumerate() {
            let kind = Some(SectionKind::Nodes);
            number_or_none(kind, k, "parent", node.parent, 0..=k as i64 - 1)?;
            within(kind, k, "first_part", node.first_part.into(), node.parts.into(), self.parts.len())?;
            within(kind, k, "name", node.name, node.name_length.into(), self.bytes.len())?;
            draws += i64::from(node.parts);
        }
        in_range(None, 0, "number of nodes", self.nodes.len() as i64, 0..=i64::from(NONE))?;
        in_range(None, 0, "draws", self.header.draws.into(), exactly(draws as u64))?;
        in_range(None, 0, "draws", draws, 0..=0xFFFF)
    }

    fn check_materials(&self) -> Result<(), ModelError> {
        for (k, material) in self.materials.iter().enumerate() {
            let kind = Some(SectionKind::Materials);
            number_or_none(kind, k, "texture", material.texture, below(self.textures.len()))?;
            if AlphaMode::of(material.alpha_mode).is_none() {
                in_range(kind, k, "alpha_mode", material.alpha_mode.into(), 0..=2)?;
            }
        }
        for (k, texture) in self.textures.iter().enumerate() {
            let kind = Some(SectionKind::Textures);
            let least = texture.width.min(texture.height);
            in_range(kind, k, "the smaller side", least.into(), 1..=0xFFFF)?;
            in_range(kind, k, "levels", texture.levels.into(), 1..=16)?;
            let Some(format) = TextureFormat::of(texture.format) else {
                return in_range(kind, k, "format", texture.format.into(), 0..=6);
            };
            if format == TextureFormat::Rgb565 {
                in_range(kind, k, "texels modulo 2", (texture.texels & 1).into(), 0..=0)?;
            }
            let past = |format| texture.bytes_before(format, texture.levels);
            within(kind, k, "texels", texture.texels, past(format), self.bytes.len())?;
            within(kind, k, "palette", texture.palette, 3 * u64::from(texture.colors), self.bytes.len())?;
            if texture.alpha != NONE_LONG {
                within(kind, k, "alpha", texture.alpha, past(TextureFormat::Palette4), self.bytes.len())?;
            }
        }
        Ok(())
    }

    fn check_skins(&self) -> Result<(), ModelError> {
        let mut first = 0;
        for (k, skin) in self.skins.iter().enumerate() {
            let kind = Some(SectionKind::Skins);
            in_range(kind, k, "first_joint", skin.first_joint.into(), exactly(first))?;
            in_range(kind, k, "joints", skin.joints.into(), 1..=256)?;
            first += u64::from(skin.joints);
        }
        in_range(None, 0, "number of joints", self.joints.len() as i64, exactly(first))?;
        for (k, joint) in self.joints.iter().enumerate() {
            in_range(Some(SectionKind::Joints), k, "node", joint.node.into(), below(self.nodes.len()))?;
        }
        Ok(())
    }

    /// Checks parts, and returns the number of words of a pose.
    ///
    /// # Format
    /// Sums of numbers of at most 32 bits, each of an item that is there: below 2⁶⁴.
    fn check_parts(&self) -> Result<u64, ModelError> {
        let mut words = self.words_before_parts();
        // Where the next part begins: vertices, indices, clusters, targets, deltas.
        let [mut vertex, mut index, mut cluster, mut target, mut delta] = [0_u64; 5];
        in_range(None, 0, "number of parts", self.parts.len() as i64, 0..=i64::from(NONE))?;
        for (k, part) in self.parts.iter().enumerate() {
            let kind = Some(SectionKind::Parts);
            in_range(kind, k, "vertices", part.vertices.into(), 0..=0xFFFF)?;
            in_range(kind, k, "triangles", part.triangles.into(), 0..=0xFFFF)?;
            in_range(kind, k, "first_vertex", part.first_vertex.into(), exactly(vertex))?;
            in_range(kind, k, "first_index", part.first_index.into(), exactly(index))?;
            in_range(kind, k, "first_cluster", part.first_cluster.into(), exactly(cluster))?;
            in_range(kind, k, "first_target", part.first_target.into(), exactly(target))?;
            let vertices = u64::from(part.vertices);
            vertex += vertices;
            index += 3 * u64::from(part.triangles);
            cluster += u64::from(part.clusters);
            target += u64::from(part.targets);
            within(kind, k, "first_vertex", part.first_vertex, vertices, self.points.len())?;
            within(kind, k, "first_index", part.first_index, 3 * u64::from(part.triangles), self.indices.len())?;
            within(kind, k, "first_cluster", part.first_cluster, part.clusters.into(), self.clusters.len())?;
            within(kind, k, "first_target", part.first_target, part.targets.into(), self.targets.len())?;
            in_range(kind, k, "material", part.material.into(), below(self.materials.len()))?;
            in_range(kind, k, "uv_shift", part.uv_shift.into(), 0..=15)?;
            if part.uv_bits != 8 {
                in_range(kind, k, "uv_bits", part.uv_bits.into(), 16..=16)?;
            }
            let uvs = if part.uv_bits == 8 { self.small_uvs.len() } else { self.uvs.len() };
            for (field, first, length) in [
                ("first_normal", part.first_normal, self.normals.len()),
                ("first_color", part.first_color, self.colors.len()),
                ("first_uv", part.first_uv, uvs),
            ] {
                if first != NONE_LONG {
                    within(kind, k, field, first, vertices, length)?;
                }
            }
            number_or_none(kind, k, "coarser", part.coarser, k as i64 + 1..=self.parts.len() as i64 - 1)?;
            within(kind, k, "first_weight", part.first_weight, part.targets.into(), self.header.weights as usize)?;
            let pose = if part.is_posed() { words } else { NONE_LONG.into() };
            in_range(kind, k, "pose", part.pose.into(), exactly(pose))?;
            if part.is_posed() {
                words += part.posed_words() as u64;
                in_range(kind, k, "clusters", part.clusters.into(), 0..=0)?;
                in_range(kind, k, "coarser", part.coarser.into(), exactly(NONE.into()))?;
            }
            Mesh::new(self.mesh_data(part)).map_err(|error| ModelError::Mesh { part: k, error })?;
            self.check_clusters(k, part)?;
            self.check_influences(k, part)?;
            for (n, item) in items(self.targets, part.first_target, part.targets.into()).iter().enumerate() {
                let (kind, n) = (Some(SectionKind::Targets), part.first_target as usize + n);
                in_range(kind, n, "first_delta", item.first_delta.into(), exactly(delta))?;
                delta += u64::from(item.vertices);
                within(kind, n, "first_delta", item.first_delta, item.vertices.into(), self.deltas.len())?;
                let (first, moved) = (item.first_vertex.into(), item.vertices.into());
                within(kind, n, "first_vertex", first, moved, part.vertices as usize)?;
            }
        }
        Ok(words)
    }

    fn check_clusters(&self, number: usize, part: &Part) -> Result<(), ModelError> {
        let (clusters, mut expected) = (self.clusters_of(part), 0);
        for (k, cluster) in clusters.iter().enumerate() {
            let k = part.first_cluster as usize + k;
            let kind = Some(SectionKind::Clusters);
            in_range(kind, k, "first_triangle", cluster.first_triangle.into(), exactly(expected))?;
            in_range(kind, k, "triangles", cluster.triangles.into(), 1..=0xFFFF)?;
            let (first, count) = (cluster.first_triangle.into(), cluster.triangles.into());
            within(kind, k, "first_triangle", first, count, part.triangles as usize)?;
            expected += u64::from(cluster.triangles);
            let first = part.first_index.saturating_add(3 * u32::from(cluster.first_triangle));
            for index in items(self.indices, first, 3 * usize::from(cluster.triangles)) {
                let vertex = usize::from(*index);
                if !self.holds(&cluster.center, &cluster.half, part, vertex) {
                    return Err(ModelError::Outside { section: SectionKind::Clusters, item: k, part: number, vertex });
                }
            }
        }
        if clusters.is_empty() {
            return Ok(());
        }
        let all = exactly(part.triangles.into());
        in_range(Some(SectionKind::Parts), number, "triangles in clusters", expected as i64, all)
    }

    fn check_influences(&self, number: usize, part: &Part) -> Result<(), ModelError> {
        if part.skin == NONE {
            return Ok(());
        }
        let kind = Some(SectionKind::Parts);
        in_range(kind, number, "skin", part.skin.into(), below(self.skins.len()))?;
        let (first, vertices) = (part.first_influence, part.vertices);
        within(kind, number, "first_influence", first, vertices.into(), self.influences.len())?;
        let (joints, first_joint) = self.joints_of(part);
        for (vertex, influence) in items(self.influences, first, vertices as usize).iter().enumerate() {
            let kind = Some(SectionKind::Influences);
            let item = first as usize + vertex;
            let [b, c, d] = influence.weights.map(i64::from);
            // The weights fall, and the first one, which is what is left, is not below the second one.
            in_range(kind, item, "second weight", b, 0..=128)?;
            in_range(kind, item, "third weight", c, 0..=b.min(256 - 2 * b))?;
            in_range(kind, item, "fourth weight", d, 0..=c.min(256 - 2 * b - c))?;
            for (joint, weight) in influence.joints.iter().zip([1, b, c, d]) {
                if weight == 0 {
                    continue;
                }
                in_range(kind, item, "joint", (*joint).into(), below(joints.len()))?;
                let Some(joint_of) = joints.get(usize::from(*joint)) else { continue };
                let k = first_joint + usize::from(*joint);
                in_range(Some(SectionKind::Joints), k, "used", joint_of.used.into(), 1..=1)?;
                // Morph targets move a vertex before its joints do, so the box cannot be checked against them here.
                if part.targets == 0 && !self.holds(&joint_of.center, &joint_of.half, part, vertex) {
                    return Err(ModelError::Outside { section: SectionKind::Joints, item: k, part: number, vertex });
                }
            }
        }
        Ok(())
    }

    fn check_clips(&self) -> Result<(), ModelError> {
        let mut first = 0;
        for (k, line) in self.timelines.iter().enumerate() {
            let kind = Some(SectionKind::Timelines);
            in_range(kind, k, "first_time", line.first_time.into(), exactly(first))?;
            in_range(kind, k, "times", line.times.into(), 1..=0x1_0000)?;
            first += u64::from(line.times);
            within(kind, k, "first_time", line.first_time, line.times.into(), self.times.len())?;
            let times = items(self.times, line.first_time, line.times as usize);
            for (n, pair) in times.windows(2).enumerate() {
                if let [a, b] = pair {
                    let item = line.first_time as usize + n + 1;
                    in_range(Some(SectionKind::Times), item, "time", (*b).into(), i64::from(*a) + 1..=0xFFFF)?;
                }
            }
        }
        let mut first = 0;
        for (k, clip) in self.clips.iter().enumerate() {
            let kind = Some(SectionKind::Clips);
            in_range(kind, k, "first_channel", clip.first_channel.into(), exactly(first))?;
            first += u64::from(clip.channels);
            within(kind, k, "first_channel", clip.first_channel, clip.channels.into(), self.channels.len())?;
            in_range(kind, k, "duration", clip.duration.into(), 1..=i64::from(u32::MAX))?;
            within(kind, k, "name", clip.name, clip.name_length.into(), self.bytes.len())?;
            let [x, y, z] = clip.half;
            in_range(kind, k, "half", x.min(y).min(z).into(), 0..=i64::from(i32::MAX))?;
            let channels = items(self.channels, clip.first_channel, clip.channels as usize);
            let mut before = Some(0);
            for (n, channel) in channels.iter().enumerate() {
                before = self.check_channel(clip.first_channel as usize + n, channel, before)?;
            }
        }
        Ok(())
    }

    /// Checks a channel after one that moves the node `before`, or after one of weights if that is `None`. Returns the
    /// node that the channel moves itself; `None` for weights.
    fn check_channel(&self, number: usize, channel: &Channel, before: Option<u16>) -> Result<Option<u16>, ModelError> {
        let kind = Some(SectionKind::Channels);
        let path = in_range(kind, number, "path", channel.path.into(), 0..=3).map(|()| Path::of(channel.path))?;
        in_range(kind, number, "interpolation", channel.interpolation.into(), 0..=2)?;
        in_range(kind, number, "timeline", channel.timeline.into(), below(self.timelines.len()))?;
        let values = Interpolation::of(channel.interpolation).map_or(0, Interpolation::values);
        let (numbers, weights) = match path {
            Some(Path::Weights) => (u64::from(channel.weights), channel.weights),
            Some(Path::Rotation) => (4, 0),
            _ => (3, 0),
        };
        in_range(kind, number, "weights", channel.weights.into(), exactly(weights.into()))?;
        let node = match (path, before) {
            // Weights stand in any order.
            (Some(Path::Weights), _) => {
                let all = self.header.weights as usize;
                within(kind, number, "target", channel.target.into(), weights.into(), all)?;
                None
            }
            // After weights, there are weights only.
            (_, None) => return in_range(kind, number, "path", channel.path.into(), 3..=3).map(|()| None),
            (_, Some(before)) => {
                let nodes = i64::from(before)..=self.nodes.len() as i64 - 1;
                in_range(kind, number, "target", channel.target.into(), nodes)?;
                Some(channel.target)
            }
        };
        let keys = self.timelines.get(channel.timeline as usize).map_or(0, |line| u64::from(line.times));
        within(kind, number, "first_key", channel.first_key, keys * numbers * values as u64, self.keys.len())?;
        Ok(node)
    }

    /// Returns the number of words of a pose before those of posed parts: below 2²², as weights are below 2¹⁶.
    fn words_before_parts(&self) -> u64 {
        let most = self.skins.iter().map(|skin| skin.joints as usize).max().unwrap_or(0);
        (MATRIX_WORDS * (self.nodes.len() + most) + self.header.weights as usize) as u64
    }

    /// Returns the joints of a part's skin, and the number of the first one.
    pub(super) fn joints_of(&self, part: &Part) -> (&'a [Joint], usize) {
        match self.skins.get(usize::from(part.skin)) {
            Some(skin) => (items(self.joints, skin.first_joint, skin.joints as usize), skin.first_joint as usize),
            None => (&[], 0),
        }
    }

    /// Returns the clusters of a part.
    pub(super) fn clusters_of(&self, part: &Part) -> &'a [Cluster] {
        items(self.clusters, part.first_cluster, part.clusters.into())
    }

    /// Returns whether a box holds a vertex of a part.
    fn holds(&self, center: &[i16; 3], half: &[u16; 3], part: &Part, vertex: usize) -> bool {
        let points = items(self.points, part.first_vertex, part.vertices as usize);
        let Some(point) = points.get(vertex) else { return false };
        point.iter().zip(center).zip(half).all(|((p, c), h)| p.abs_diff(*c) <= *h)
    }

    /// Returns the slices of a part's mesh at rest, but for normals and texture coordinates, which are packed.
    pub(super) fn mesh_data(&self, part: &Part) -> MeshData<'a> {
        let vertices = part.vertices as usize;
        let (scale, offset) = (Scalar::from_bits(part.scale), Vec3::from_bits(part.offset));
        let points = items(self.points, part.first_vertex, vertices);
        let colors = (part.first_color != NONE_LONG).then(|| items(self.colors, part.first_color, vertices));
        MeshData {
            indices: Some(items(self.indices, part.first_index, 3 * part.triangles as usize)),
            colors,
            bounds: Some(bounds_of(part.center, part.half)),
            ..MeshData::new(Positions::Quantized { points, scale, offset })
        }
    }
}

impl Part {
    /// Returns whether a pose moves vertices of the part.
    pub(super) const fn is_posed(&self) -> bool {
        self.skin != NONE || self.targets > 0
    }

    /// Returns the number of words of the part's posed vertices.
    pub(super) const fn posed_words(&self) -> usize {
        let vectors = vector_words(self.vertices as usize);
        POSED_HEAD + if self.has_normals() { 2 * vectors } else { vectors }
    }

    pub(super) const fn has_normals(&self) -> bool {
        self.first_normal != NONE_LONG
    }
}

impl Texture {
    /// Returns the number of bytes of the levels before a level.
    pub(super) fn bytes_before(&self, format: TextureFormat, level: u8) -> u64 {
        let bytes = |level| {
            let (width, height) = self.size(level);
            format.bytes(width, height)
        };
        (0..level).map(bytes).sum()
    }

    /// Returns the number of columns and rows of a level.
    pub(super) fn size(&self, level: u8) -> (u16, u16) {
        let side = |length: u16| (length >> (level & 15)).max(1);
        (side(self.width), side(self.height))
    }
}

/// Returns the box with this middle and half size.
pub(super) const fn bounds_of(center: [i32; 3], half: [i32; 3]) -> Bounds {
    Bounds { center: Vec3::from_bits(center), half: Vec3::from_bits(half) }
}

/// The bytes that sections are taken from.
struct Sections<'a> {
    bytes: &'a [u8],
    header: &'a Header,
}

impl<'a> Sections<'a> {
    fn section<T: Pod>(&self, kind: SectionKind) -> Result<&'a [T], ModelError> {
        let Section { offset, count } = self.header.table.get(kind as usize).copied().unwrap_or_default();
        let error = ModelError::Section { section: kind, offset, count, length: self.header.length };
        let size = u64::from(count) * size_of::<T>() as u64;
        let Ok(size) = usize::try_from(size) else { return Err(error) };
        if offset % 4 != 0 || (offset as usize) < size_of::<Header>() {
            return Err(error);
        }
        let bytes = self.bytes.get(offset as usize..).and_then(|rest| rest.get(..size)).ok_or(error)?;
        bytemuck::try_cast_slice(bytes).map_err(|_| error)
    }
}

/// Returns an error if a number is out of range.
fn in_range(
    section: Option<SectionKind>,
    item: usize,
    field: &'static str,
    found: i64,
    range: RangeInclusive<i64>,
) -> Result<(), ModelError> {
    if range.contains(&found) {
        return Ok(());
    }
    Err(ModelError::Number { section, item, field, found, least: *range.start(), most: *range.end() })
}

/// Returns an error if a number is out of range, and does not stand for "none".
fn number_or_none(
    section: Option<SectionKind>,
    item: usize,
    field: &'static str,
    found: u16,
    range: RangeInclusive<i64>,
) -> Result<(), ModelError> {
    if found == NONE {
        return Ok(());
    }
    // Where there is no number, "none" is the one that is left.
    in_range(section, item, field, found.into(), if range.is_empty() { exactly(NONE.into()) } else { range })
}

/// Returns an error if `count` items from `first` on end past the last of `length` items.
fn within(
    section: Option<SectionKind>,
    item: usize,
    field: &'static str,
    first: u32,
    count: u64,
    length: usize,
) -> Result<(), ModelError> {
    if u64::from(first).saturating_add(count) <= length as u64 {
        return Ok(());
    }
    Err(ModelError::Items { section, item, field, first, count, length })
}

/// Returns the range of one number.
fn exactly(number: u64) -> RangeInclusive<i64> {
    number as i64..=number as i64
}

/// Returns the range of the numbers of that many items.
fn below(count: usize) -> RangeInclusive<i64> {
    0..=count as i64 - 1
}
