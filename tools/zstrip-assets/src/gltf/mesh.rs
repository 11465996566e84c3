//! Primitives of glTF meshes: attributes, indices, skin weights and morph targets.

use gltf::json::accessor::{ComponentType, Type};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root, accessor};

use super::accessor::Buffers;
use super::material::{Mapping, srgb};
use crate::draft::{Context, Draft};
use crate::error::{Error, Kind, Place};
use crate::model::{Morph, Vertices};
use crate::report::Note;

/// Bytes of a number in a mesh.
const NUMBER_BYTES: u64 = 4;

/// Numbers that a morph target takes at least.
const TARGET_NUMBERS: u64 = 12;

/// Reads the primitives of a mesh that are triangles.
pub(super) fn read(json: &Root, number: usize, buffers: &Buffers, context: &mut Context) -> Result<Vec<Draft>, Error> {
    let mesh = &json.meshes[number];
    let mut drafts = Vec::new();
    for (k, primitive) in mesh.primitives.iter().enumerate() {
        let Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) = primitive.mode else {
            context.ignore("primitive of points or lines");
            continue;
        };
        let at = format!("meshes[{number}].primitives[{k}]");
        let mut reader = Reader { json, primitive, buffers, at, context };
        let Some(vertices) = reader.vertices()? else { continue };
        let corners = reader.indices(vertices.len())?;
        let name = mesh.name.clone().unwrap_or_default();
        let at = || Place::Json(format!("meshes[{number}].name"));
        context.take_numbers(name.len() as u64 / NUMBER_BYTES, at)?;
        let material = primitive.material.map(|material| material.value());
        drafts.push(Draft { name, material, vertices, triangles: triangles(mode, &corners), groups: Vec::new() });
    }
    Ok(drafts)
}

/// Triangles of a list, strip or fan.
fn triangles(mode: Mode, corners: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => {
            let turn = |(k, w): (usize, &[u32])| if k % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] };
            corners.windows(3).enumerate().map(turn).collect()
        }
        Mode::TriangleFan => corners.windows(2).skip(1).map(|w| [w[0], w[1], corners[0]]).collect(),
        _ => corners.as_chunks::<3>().0.to_vec(),
    }
}

/// Elements, and how many numbers the file has for each.
type List<const N: usize> = (Vec<[f32; N]>, usize);

struct Reader<'r, 'o> {
    json: &'r Root,
    primitive: &'r Primitive,
    buffers: &'r Buffers,
    at: String,
    context: &'r mut Context<'o>,
}

impl Reader<'_, '_> {
    fn fail<T>(&self, field: &str, kind: Kind, message: String) -> Result<T, Error> {
        Err(self.context.error(Place::Json(format!("{}{field}", self.at)), kind, message))
    }

    fn accessor(&self, semantic: Semantic) -> Option<Index<accessor::Accessor>> {
        self.primitive.attributes.get(&Checked::Valid(semantic)).copied()
    }

    /// The elements of an accessor, as many as there are positions.
    fn list<const N: usize>(
        &mut self,
        accessor: Option<Index<accessor::Accessor>>,
        types: &[Type],
        count: usize,
    ) -> Result<Option<List<N>>, Error> {
        let Some(index) = accessor else { return Ok(None) };
        let numbers = self.buffers.numbers(self.json, index.value(), types, self.context)?;
        if numbers.count != count {
            let message = format!(
                "accessor {} has {} elements, where there are {count} vertices; export the file again",
                index.value(),
                numbers.count
            );
            return self.fail(".attributes", Kind::Index, message);
        }
        Ok(Some((numbers.arrays::<N>(), numbers.width)))
    }

    fn vertices(&mut self) -> Result<Option<Vertices>, Error> {
        let Some(index) = self.accessor(Semantic::Positions) else {
            self.context.ignore("primitive without positions");
            return Ok(None);
        };
        let positions = self.buffers.numbers(self.json, index.value(), &[Type::Vec3], self.context)?;
        let count = positions.count;
        let mut vertices = Vertices { positions: positions.arrays(), ..Vertices::default() };
        if let Some((normals, _)) = self.list(self.accessor(Semantic::Normals), &[Type::Vec3], count)? {
            vertices.normals = normals;
        }
        let mapping = Mapping::of(self.json, self.primitive.material.map(|material| material.value()));
        if let Some((uvs, _)) = self.list(self.accessor(Semantic::TexCoords(mapping.set)), &[Type::Vec2], count)? {
            vertices.uvs = uvs.into_iter().map(|uv| mapping.apply(uv)).collect();
        }
        let colors = self.accessor(Semantic::Colors(0));
        if let Some((colors, width)) = self.list::<4>(colors, &[Type::Vec3, Type::Vec4], count)? {
            let encode =
                |[r, g, b, a]: [f32; 4]| [srgb(r), srgb(g), srgb(b), if width == 4 { a.clamp(0.0, 1.0) } else { 1.0 }];
            vertices.colors = colors.into_iter().map(encode).collect();
        }
        self.weights(&mut vertices)?;
        for target in self.primitive.targets.iter().flatten() {
            let positions = match self.list(target.positions, &[Type::Vec3], count)? {
                Some((positions, _)) => positions,
                None => {
                    let at = || Place::Json(format!("{}.targets", self.at));
                    self.context.take_numbers(3 * count as u64 + TARGET_NUMBERS, at)?;
                    vec![[0.0; 3]; count]
                }
            };
            let mut morph = Morph { positions, normals: Vec::new() };
            if let Some((normals, _)) = self.list(target.normals, &[Type::Vec3], count)? {
                morph.normals = normals;
            }
            vertices.morphs.push(morph);
        }
        Ok(Some(vertices))
    }

    /// Reads all sets of joints and weights, and keeps the four largest weights of each vertex.
    fn weights(&mut self, vertices: &mut Vertices) -> Result<(), Error> {
        let count = vertices.len();
        let mut sets = Vec::new();
        while let Some(joints) = self.accessor(Semantic::Joints(sets.len() as u32)) {
            let set = sets.len() as u32;
            let Some((joints, _)) = self.list::<4>(Some(joints), &[Type::Vec4], count)? else { break };
            let Some((weights, _)) = self.list::<4>(self.accessor(Semantic::Weights(set)), &[Type::Vec4], count)?
            else {
                return self.fail(".attributes", Kind::Missing, format!("JOINTS_{set} without WEIGHTS_{set}"));
            };
            sets.push((joints, weights));
        }
        if sets.is_empty() {
            return Ok(());
        }
        let (mut dropped, mut most, mut missing) = (0, 0.0f32, 0);
        for v in 0..count {
            let (joints, weights, lost) = largest_four(
                sets.iter().flat_map(|(joints, weights)| (0..4).map(move |k| (joints[v][k] as u16, weights[v][k]))),
            );
            missing += usize::from(weights[0] == 0.0);
            dropped += usize::from(lost > 0.0);
            most = most.max(lost);
            vertices.joints.push(joints);
            vertices.weights.push(if weights[0] == 0.0 { [1.0, 0.0, 0.0, 0.0] } else { weights });
        }
        self.context.report.add(Note::WeightsMissing { vertices: missing });
        if dropped > 0 {
            self.context.report.add(Note::WeightsDropped { vertices: dropped, most });
        }
        Ok(())
    }

    /// The corners of triangles: indices, or all vertices in their order.
    fn indices(&mut self, count: usize) -> Result<Vec<u32>, Error> {
        let Some(index) = self.primitive.indices else { return Ok((0..count as u32).collect()) };
        let numbers = self.buffers.numbers(self.json, index.value(), &[Type::Scalar], self.context)?;
        if numbers.kind == ComponentType::F32 {
            return self.fail(".indices", Kind::Syntax, "indices that are floats".to_owned());
        }
        if let Some(at) = numbers.values.iter().position(|value| *value < 0.0 || *value >= count as f64) {
            let message = format!("index {at} is {}, where there are {count} vertices", numbers.values[at]);
            return self.fail(".indices", Kind::Index, message);
        }
        Ok(numbers.values.iter().map(|value| *value as u32).collect())
    }
}

/// The four largest weights, from large to small, with the sum 1, their joints, and which part of all weights is lost.
///
/// Joints of weight 0 are joint 0, so that vertices which move alike are equal.
pub(crate) fn largest_four(all: impl Iterator<Item = (u16, f32)>) -> ([u16; 4], [f32; 4], f32) {
    // A joint may occur twice; its weights then add up.
    let mut kept: Vec<(u16, f32)> = Vec::new();
    for (joint, weight) in all.filter(|(_, weight)| *weight > 0.0) {
        match kept.iter_mut().find(|(known, _)| *known == joint) {
            Some((_, sum)) => *sum += weight,
            None => kept.push((joint, weight)),
        }
    }
    kept.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let total: f32 = kept.iter().map(|(_, weight)| weight).sum();
    let lost: f32 = kept.iter().skip(4).map(|(_, weight)| weight).sum();
    kept.truncate(4);
    let sum: f32 = kept.iter().map(|(_, weight)| weight).sum();
    let (mut joints, mut weights) = ([0; 4], [0.0; 4]);
    for (k, (joint, weight)) in kept.iter().enumerate() {
        (joints[k], weights[k]) = (*joint, weight / sum);
    }
    (joints, weights, if total > 0.0 { lost / total } else { 0.0 })
}
