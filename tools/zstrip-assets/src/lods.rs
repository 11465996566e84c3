//! Makes levels of detail: meshes of fewer triangles that can stand for a mesh that is small on the screen.
//!
//! Each level is simplified from the mesh itself. Where parts of a shape meet, vertices stay, so that parts of
//! different levels leave no gap between them. A level's error is measured, not estimated: a bound of the distance
//! between both surfaces, both ways, and the distance by which texels slide along the surface.

use std::collections::HashMap;
use std::ops::Range;

use meshopt::{SimplifyOptions, VertexDataAdapter};

use crate::cluster;
use crate::distance::{Tree, between, weights};
use crate::geometry::{Vector, cross, dot};
use crate::model::{Import, Mesh, Vertices};
use crate::options::Options;
use crate::process::unit_positions;
use crate::report::{Note, Report};
use crate::weld::compact;

/// A level has at most this part of the triangles of the one before; otherwise it is not worth its flash.
const MOST: f64 = 0.9;

/// The least triangles of a mesh that levels are made of.
const LEAST: usize = 16;

/// Weights of attributes against distances, where the mesh has size 1.
const NORMALS: f32 = 0.05;
const COLORS: f32 = 0.1;

/// Samples of a triangle of a level: weights of its second and third corner.
const SAMPLES: [[f64; 2]; 7] =
    [[1. / 3., 1. / 3.], [0.5, 0.], [0.5, 0.5], [0., 0.5], [0.2, 0.2], [0.6, 0.2], [0.2, 0.6]];

/// Adds levels of detail to an import's meshes. `shapes` are ranges of meshes whose borders meet.
pub(crate) fn add(import: &mut Import, shapes: &[Range<usize>], options: &Options, report: &mut Report) {
    if options.lods == 0 {
        return;
    }
    let (mut short, mut posed) = (0, 0);
    for shape in shapes {
        let locks = shared(&import.meshes[shape.clone()]);
        for (number, lock) in shape.clone().zip(locks) {
            let mesh = &import.meshes[number];
            if !mesh.vertices.joints.is_empty() || !mesh.vertices.morphs.is_empty() {
                posed += 1;
                continue;
            }
            let is_textured = mesh.material.is_some_and(|material| import.materials[material].texture.is_some());
            let levels = levels(mesh, &lock, is_textured, options);
            short += usize::from(levels.len() < options.lods && mesh.triangles.len() >= LEAST);
            let mut finer = number;
            for level in levels {
                let coarser = import.meshes.len();
                import.meshes[finer].coarser = Some(coarser);
                import.meshes.push(level);
                finer = coarser;
            }
        }
    }
    report.add(Note::LevelsEnded { meshes: short });
    report.add(Note::LevelsOfMoved { meshes: posed });
}

/// Returns for each vertex of each mesh whether another mesh has one at its position.
fn shared(meshes: &[Mesh]) -> Vec<Vec<bool>> {
    let key = |p: &[f32; 3]| p.map(|x| (x + 0.0).to_bits());
    // The only mesh at a position, or none where there are several.
    let mut owners: HashMap<[u32; 3], Option<usize>> = HashMap::new();
    for (k, mesh) in meshes.iter().enumerate() {
        for p in &mesh.vertices.positions {
            let owner = owners.entry(key(p)).or_insert(Some(k));
            *owner = owner.filter(|owner| *owner == k);
        }
    }
    let is_shared = |p: &[f32; 3]| owners.get(&key(p)).is_some_and(Option::is_none);
    meshes.iter().map(|mesh| mesh.vertices.positions.iter().map(is_shared).collect()).collect()
}

/// Returns the levels of a mesh, from fine to coarse, with their errors.
fn levels(mesh: &Mesh, lock: &[bool], is_textured: bool, options: &Options) -> Vec<Mesh> {
    let mut levels: Vec<Mesh> = Vec::new();
    if mesh.triangles.len() < LEAST {
        return levels;
    }
    let (unit, _) = unit_positions(&mesh.vertices.positions);
    let surface = Surface::new(mesh, is_textured);
    let (mut count, mut error) = (mesh.triangles.len(), 0.0);
    for level in 1..=options.lods {
        let target = (mesh.triangles.len() as f64 * options.lod_ratio.powi(level as i32)).round() as usize;
        let mut triangles = simplify(mesh, &unit, lock, is_textured, target.max(4));
        if triangles.is_empty() || triangles.len() as f64 > count as f64 * MOST {
            break;
        }
        count = triangles.len();
        let all: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
        let vertices = compact(&mesh.vertices, &mut triangles, &all);
        let (unit, _) = unit_positions(&vertices.positions);
        let clusters = cluster::group(&unit, &triangles, options);
        // It has no more vertices than the mesh, so it is one mesh.
        let Some(mut coarse) = cluster::split(&vertices, &clusters, options.max_vertices).pop() else { break };
        // Errors grow from level to level, because the coarsest level is chosen whose error is small.
        error = surface.error_of(&coarse).max(error);
        (coarse.name, coarse.material, coarse.error) = (mesh.name.clone(), mesh.material, error);
        levels.push(coarse);
    }
    levels
}

/// Returns the triangles that are left, near `target` of them. Vertices stay where they are, and so do seams.
fn simplify(mesh: &Mesh, unit: &[[f32; 3]], lock: &[bool], is_textured: bool, target: usize) -> Vec<[u32; 3]> {
    let Vertices { normals, uvs, colors, .. } = &mesh.vertices;
    let mut weights = Vec::new();
    if !normals.is_empty() {
        weights.extend([NORMALS; 3]);
    }
    let is_textured = is_textured && !uvs.is_empty();
    if is_textured {
        weights.extend([units_per_uv(mesh, unit).min(100.0); 2]);
    }
    if !colors.is_empty() {
        weights.extend([COLORS; 3]);
    }
    let mut attributes = Vec::with_capacity(weights.len() * unit.len());
    for v in 0..unit.len() {
        attributes.extend(normals.get(v).into_iter().flatten());
        attributes.extend(uvs.get(v).filter(|_| is_textured).into_iter().flatten());
        attributes.extend(colors.get(v).into_iter().flat_map(|color| &color[..3]));
    }
    let stride = weights.len() * size_of::<f32>();
    let bytes = meshopt::typed_to_bytes(unit);
    let Ok(positions) = VertexDataAdapter::new(bytes, size_of::<[f32; 3]>(), 0) else { return Vec::new() };
    let corners = mesh.triangles.as_flattened();
    let options = SimplifyOptions::None;
    let left = if weights.is_empty() {
        meshopt::simplify_with_locks(corners, &positions, lock, 3 * target, 1.0, options, None)
    } else {
        meshopt::simplify_with_attributes_and_locks(
            corners,
            &positions,
            &attributes,
            &weights,
            stride,
            lock,
            3 * target,
            1.0,
            options,
            None,
        )
    };
    left.as_chunks::<3>().0.to_vec()
}

/// Returns the length of a unit of texture coordinates: the mean by areas.
fn units_per_uv(mesh: &Mesh, positions: &[[f32; 3]]) -> f32 {
    let (mut area, mut of_texture) = (0.0, 0.0);
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| positions[v as usize].map(f64::from));
        let normal = cross(sub(b, a), sub(c, a));
        area += dot(normal, normal).sqrt();
        let [a, b, c] = triangle.map(|v| mesh.vertices.uvs[v as usize].map(f64::from));
        of_texture += ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
    }
    let length = (area / of_texture).sqrt();
    if length.is_finite() { length as f32 } else { 0.0 }
}

fn sub(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|k| a[k] - b[k])
}

/// A mesh that levels are compared with.
struct Surface<'m> {
    mesh: &'m Mesh,
    is_textured: bool,
    /// The length of a unit of texture coordinates, in the mean.
    units_per_uv: f64,
    tree: Tree,
}

fn corners(mesh: &Mesh) -> Vec<[Vector; 3]> {
    mesh.triangles.iter().map(|t| t.map(|v| mesh.vertices.positions[v as usize].map(f64::from))).collect()
}

impl<'m> Surface<'m> {
    fn new(mesh: &'m Mesh, is_textured: bool) -> Self {
        let is_textured = is_textured && !mesh.vertices.uvs.is_empty();
        let units_per_uv = if is_textured { units_per_uv(mesh, &mesh.vertices.positions).into() } else { 0.0 };
        Self { mesh, is_textured, units_per_uv, tree: Tree::new(&corners(mesh)) }
    }

    /// Returns a bound of the distance between the mesh and a level of it, and at least the distance by which texels
    /// slide.
    fn error_of(&self, level: &Mesh) -> f64 {
        let of_level = corners(level);
        let apart = between(&self.tree.triangles, &of_level);
        if self.is_textured { self.slide(level, &of_level).max(apart) } else { apart }
    }

    /// Returns the largest distance of samples of a level from the place of the texel that they show. That is the place
    /// on the mesh for which its distance, and that of its texture coordinates as a length, are least together.
    fn slide(&self, level: &Mesh, of_level: &[[Vector; 3]]) -> f64 {
        let uvs = |mesh: &Mesh, triangle: &[u32; 3]| -> [Vector; 3] {
            triangle.map(|v| mesh.vertices.uvs[v as usize]).map(|[u, v]| [f64::from(u), f64::from(v), 0.0])
        };
        let mut largest: f64 = 0.0;
        for (triangle, at) in level.triangles.iter().zip(of_level) {
            let of_level = uvs(level, triangle);
            for [s, t] in SAMPLES {
                let (p, shown) = (mixed(at, [s, t]), mixed(&of_level, [s, t]));
                let mut least = f64::INFINITY;
                self.tree.visit(p, &mut |_, number| {
                    let (at, there) = (&self.tree.triangles[number], uvs(self.mesh, &self.mesh.triangles[number]));
                    // The nearest place of the triangle, and that of the nearest texel.
                    for place in [weights(p, *at), weights(shown, there)] {
                        let apart = length(sub(p, mixed(at, place)));
                        least = least.min(apart + self.units_per_uv * length(sub(shown, mixed(&there, place))));
                    }
                    least
                });
                largest = largest.max(least);
            }
        }
        largest
    }
}

/// Returns the point of a triangle with these weights of its second and third corner.
fn mixed([a, b, c]: &[Vector; 3], [s, t]: [f64; 2]) -> Vector {
    std::array::from_fn(|k| a[k] + s * (b[k] - a[k]) + t * (c[k] - a[k]))
}

fn length(v: Vector) -> f64 {
    dot(v, v).sqrt()
}
