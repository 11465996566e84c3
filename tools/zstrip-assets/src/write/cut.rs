//! Triangles that cross a side of a texture that does not repeat become several triangles that cross none.
//!
//! Textures of containers repeat ([`wraps`](super::wraps)). A triangle of the import comes in; triangles that cover the
//! same points come out, and each of them can be given coordinates within the texture. A clamped texture goes on with
//! its last texel from the middle of that texel on, so triangles are cut there; a mirrored one is cut at its sides:
//!
//! ```text
//!      u = 0        1 - half a texel
//!        |                :
//!        |     a----------*-------c     Corners *: new vertices.
//!        |      \         :     /       On the left, triangles keep their coordinates.
//!        |       \        :   /         On the right, u becomes 1 - half a texel.
//!        |        \       : /
//!        |         \      *
//!        |          \   / :
//!        |            b   :
//! ```
//!
//! Triangles of a mesh that have a cut side in common are cut at the same points of it, also where a seam of the
//! texture is between them and only one of them crosses: the other one gets the points as corners. So a mesh without
//! gaps stays one without gaps. Attributes of new vertices are those of the line between the two old ones.

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};

use super::parts::CLUSTER;
use super::report::{WriteNote, WriteReport};
use super::wraps::crossed;
use crate::geometry::{dot, sub, unit};
use crate::model::{Cluster, Import, Mesh, Vertices, Wrap};

/// The most sides that a triangle is cut at, along each axis. A mesh with a triangle that crosses more stays as it is.
const MOST_SIDES: usize = 32;

/// A mesh may become this many times as large, and get [`MOST_MORE`] triangles beside that. A mesh that would get more
/// stays as it is.
const MOST_TIMES: usize = 4;
/// Triangles that a mesh may get beside [`MOST_TIMES`] as many.
const MOST_MORE: usize = 10_000;

/// The part of a side, or of a triangle's range of coordinates, that counts as nothing.
const NEAR: f64 = 1e-6;

/// Cuts the triangles of an import whose materials have textures of the sizes given.
pub(super) fn cut<'i>(import: &'i Import, sizes: &[Option<[u32; 2]>], report: &mut WriteReport) -> Cow<'i, Import> {
    let mut import = Cow::Borrowed(import);
    // Triangles before and after, by material.
    let mut counts: BTreeMap<usize, [usize; 2]> = BTreeMap::new();
    for number in 0..import.meshes.len() {
        let mesh = &import.meshes[number];
        let Some((material, size)) = mesh.material.and_then(|k| Some((k, (*sizes.get(k)?)?))) else { continue };
        let Some(texture) = import.materials[material].texture else { continue };
        let axes = Axes { wrap: texture.wrap, half: size.map(|texels| 0.5 / f64::from(texels)) };
        if texture.wrap == [Wrap::Repeat; 2] || mesh.vertices.uvs.is_empty() {
            continue;
        }
        let Some((mesh, cut, into)) = cut_mesh(mesh, &axes) else { continue };
        let [before, after] = counts.entry(material).or_default();
        (*before, *after) = (*before + cut, *after + into);
        import.to_mut().meshes[number] = mesh;
    }
    for (material, [triangles, into]) in counts {
        let name = import.materials[material].name.clone();
        report.notes.push(WriteNote::Cut { material, name, triangles, into });
    }
    import
}

/// The ways in which a texture goes on along u and v, and half a texel.
struct Axes {
    wrap: [Wrap; 2],
    half: [f64; 2],
}

impl Axes {
    /// Returns the coordinates of an axis that a triangle is cut at; `None` where these are too many.
    fn cuts(&self, axis: usize, uvs: [[f64; 2]; 3]) -> Option<Vec<f64>> {
        let [low, high] = range(axis, uvs);
        let half = self.half[axis];
        let mut sides = crossed(self.wrap[axis], low, high, half).take(MOST_SIDES + 1).collect::<Vec<_>>();
        if self.wrap[axis] == Wrap::Clamp {
            // The middle of the last texel.
            sides.iter_mut().for_each(|side| *side = side.clamp(half, 1.0 - half));
        }
        (sides.len() <= MOST_SIDES).then_some(sides)
    }
}

/// Returns the least and the largest coordinate of three vertices along an axis.
fn range(axis: usize, uvs: [[f64; 2]; 3]) -> [f64; 2] {
    let all = uvs.map(|uv| uv[axis]);
    [all.into_iter().fold(f64::INFINITY, f64::min), all.into_iter().fold(f64::NEG_INFINITY, f64::max)]
}

/// The bits of a position, by which positions are compared: 0 and -0 are equal.
type Place = [u32; 3];

/// Returns a mesh with its triangles cut, the number of those that were cut, and of those that they became. Returns
/// `None` if the mesh stays as it is.
fn cut_mesh(mesh: &Mesh, axes: &Axes) -> Option<(Mesh, usize, usize)> {
    let mut work = Work { vertices: mesh.vertices.clone(), known: HashMap::new(), sides: HashMap::new() };
    let mut cuts = Vec::with_capacity(mesh.triangles.len());
    let (mut parts, most) = (0, MOST_TIMES * mesh.triangles.len() + MOST_MORE);
    for triangle in &mesh.triangles {
        let uvs = triangle.map(|v| work.uv(v));
        let of = [axes.cuts(0, uvs)?, axes.cuts(1, uvs)?];
        // Counted before memory is taken, as if each line crossed all others.
        parts += (of[0].len() + 1) * (of[1].len() + 1);
        if parts > most {
            return None;
        }
        for (axis, at) in of.iter().enumerate() {
            at.iter().for_each(|at| work.note(triangle, axis, *at));
        }
        cuts.push(of);
    }
    if work.sides.is_empty() {
        return None;
    }
    for at in work.sides.values_mut() {
        at.sort_unstable_by(f64::total_cmp);
        at.dedup_by(|a, b| *a - *b < NEAR);
    }
    let (mut triangles, mut clusters) = (Vec::new(), Vec::new());
    let (mut cut, mut into) = (0, 0);
    let counts: Vec<_> = match &mesh.clusters[..] {
        [] => vec![mesh.triangles.len()],
        clusters => clusters.iter().map(|cluster| cluster.count).collect(),
    };
    let mut pairs = mesh.triangles.iter().zip(&cuts);
    for (number, count) in counts.into_iter().enumerate() {
        let first = triangles.len();
        for (triangle, cuts) in pairs.by_ref().take(count) {
            let before = triangles.len();
            work.cut(*triangle, cuts, &mut triangles);
            let parts = triangles.len() - before;
            if parts != 1 {
                (cut, into) = (cut + 1, into + parts);
            }
            if triangles.len() > most {
                return None;
            }
        }
        let Some(cluster) = mesh.clusters.get(number) else { continue };
        // A cluster that has grown too large becomes several.
        let mut first = first;
        for run in triangles[first..].chunks(CLUSTER) {
            clusters.push(Cluster { first, count: run.len(), vertices: distinct(run), ..cluster.clone() });
            first += run.len();
        }
    }
    Some((Mesh { vertices: work.vertices, triangles, clusters, ..mesh.clone() }, cut, into))
}

/// Returns the number of vertices that triangles use.
fn distinct(triangles: &[[u32; 3]]) -> usize {
    let mut all = triangles.as_flattened().to_vec();
    all.sort_unstable();
    all.dedup();
    all.len()
}

/// A corner of a polygon: a vertex, and its place in the triangle: the weights of the second and the third corner.
#[derive(Clone, Copy)]
struct Corner {
    vertex: u32,
    at: [f64; 2],
}

/// A mesh while it is cut.
struct Work {
    vertices: Vertices,
    /// New vertices, by the two that they lie between and the bits of their place.
    known: HashMap<(u32, u32, u64), u32>,
    /// Places of cuts on sides of triangles, from the lower end to the higher one.
    sides: HashMap<[Place; 2], Vec<f64>>,
}

impl Work {
    fn uv(&self, vertex: u32) -> [f64; 2] {
        self.vertices.uvs[vertex as usize].map(f64::from)
    }

    fn place(&self, vertex: u32) -> Place {
        self.vertices.positions[vertex as usize].map(|x| (x + 0.0).to_bits())
    }

    /// Returns the ends of a side in their order.
    fn ordered(&self, a: u32, b: u32) -> [u32; 2] {
        if (self.place(a), a) <= (self.place(b), b) { [a, b] } else { [b, a] }
    }

    /// Notes where a line cuts the sides of a triangle.
    fn note(&mut self, triangle: &[u32; 3], axis: usize, at: f64) {
        for k in 0..3 {
            let [a, b] = self.ordered(triangle[k], triangle[(k + 1) % 3]);
            let [from, to] = [a, b].map(|v| self.uv(v)[axis]);
            let part = (at - from) / (to - from);
            // Where the side is along the line, the quotient is no number, and nothing is noted.
            if part > NEAR && part < 1.0 - NEAR {
                self.sides.entry([self.place(a), self.place(b)]).or_default().push(part);
            }
        }
    }

    /// Cuts a triangle at its lines, after points were put on its sides.
    fn cut(&mut self, triangle: [u32; 3], cuts: &[Vec<f64>; 2], to: &mut Vec<[u32; 3]>) {
        const CORNERS: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let mut border = Vec::with_capacity(8);
        for k in 0..3 {
            let next = (k + 1) % 3;
            let corner = |k: usize| Corner { vertex: triangle[k], at: CORNERS[k] };
            border.push(corner(k));
            let [a, b] = self.ordered(triangle[k], triangle[next]);
            let Some(mut parts) = self.sides.get(&[self.place(a), self.place(b)]).cloned() else { continue };
            let is_turned = a != triangle[k];
            if is_turned {
                parts.reverse();
            }
            for part in parts {
                let vertex = self.between(a, b, part);
                let part = if is_turned { 1.0 - part } else { part };
                border.push(Corner { vertex, at: mixed(CORNERS[k], CORNERS[next], part) });
            }
        }
        if border.len() == 3 {
            to.push(triangle);
            return;
        }
        let uvs = triangle.map(|v| self.uv(v));
        let mut polygons = vec![border];
        for (axis, cuts) in cuts.iter().enumerate() {
            let [low, high] = range(axis, uvs);
            // Coordinates have 24 bits.
            let near = NEAR * (high - low) + 1e-7 * low.abs().max(high.abs());
            for at in cuts {
                let whole = std::mem::take(&mut polygons);
                whole.into_iter().for_each(|polygon| self.split(&polygon, axis, *at, near, &mut polygons));
            }
        }
        polygons.into_iter().for_each(|polygon| self.triangulate(polygon, to));
    }

    /// Splits a convex polygon at a line.
    fn split(&mut self, polygon: &[Corner], axis: usize, at: f64, near: f64, to: &mut Vec<Vec<Corner>>) {
        let distances: Vec<_> = polygon.iter().map(|corner| self.uv(corner.vertex)[axis] - at).collect();
        let mut parts = [Vec::new(), Vec::new()];
        for (k, corner) in polygon.iter().enumerate() {
            let next = (k + 1) % polygon.len();
            let (d, e) = (distances[k], distances[next]);
            for (part, is_beyond) in parts.iter_mut().zip([d > near, d < -near]) {
                if !is_beyond {
                    part.push(*corner);
                }
            }
            if (d > near && e < -near) || (d < -near && e > near) {
                let other = polygon[next];
                // From the vertex of the lower number on: the polygon on the other side gets the same new vertex.
                let vertex = if corner.vertex < other.vertex {
                    self.between(corner.vertex, other.vertex, d / (d - e))
                } else {
                    self.between(other.vertex, corner.vertex, e / (e - d))
                };
                let new = Corner { vertex, at: mixed(corner.at, other.at, d / (d - e)) };
                parts.iter_mut().for_each(|part| part.push(new));
            }
        }
        let [is_below, is_above] = [distances.iter().any(|d| *d < -near), distances.iter().any(|d| *d > near)];
        match (is_below, is_above) {
            (true, true) => to.extend(parts),
            _ => to.push(polygon.to_vec()),
        }
    }

    /// Makes triangles of a convex polygon, some corners of which lie on its sides. Corners are cut off, first those
    /// whose cut is short.
    fn triangulate(&self, mut polygon: Vec<Corner>, to: &mut Vec<[u32; 3]>) {
        const LEAST: f64 = 1e-12;
        let position = |corner: Corner| self.vertices.positions[corner.vertex as usize];
        while polygon.len() >= 3 {
            let count = polygon.len();
            let around = |k: usize| [polygon[(k + count - 1) % count], polygon[k], polygon[(k + 1) % count]];
            let all: f64 = (1..count - 1).map(|k| area([polygon[0], polygon[k], polygon[k + 1]])).sum();
            let ears = (0..count).filter(|k| {
                let ear = area(around(*k));
                // What is left must not be a line.
                ear > LEAST && (count == 3 || all - ear > LEAST)
            });
            let length = |k: &usize| {
                let [a, _, b] = around(*k);
                let apart = sub(position(a), position(b));
                dot(apart, apart)
            };
            // There is no ear where all that is left is a line.
            let Some(ear) = ears.min_by(|a, b| length(a).total_cmp(&length(b))) else { return };
            to.push(around(ear).map(|corner| corner.vertex));
            polygon.remove(ear);
        }
    }

    /// Returns the vertex that lies at a part of the way from one vertex to another.
    fn between(&mut self, a: u32, b: u32, part: f64) -> u32 {
        let next = self.vertices.len() as u32;
        let vertex = *self.known.entry((a, b, part.to_bits())).or_insert(next);
        if vertex == next {
            self.vertices.push_between(a as usize, b as usize, part);
        }
        vertex
    }
}

/// Returns twice the area of three places in the triangle.
fn area([a, b, c]: [Corner; 3]) -> f64 {
    let [b, c] = [b, c].map(|corner| [corner.at[0] - a.at[0], corner.at[1] - a.at[1]]);
    b[0] * c[1] - b[1] * c[0]
}

fn mixed<const N: usize>(a: [f64; N], b: [f64; N], part: f64) -> [f64; N] {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * part)
}

fn mixed_floats<const N: usize>(a: [f32; N], b: [f32; N], part: f64) -> [f32; N] {
    mixed(a.map(f64::from), b.map(f64::from), part).map(|x| x as f32)
}

impl Vertices {
    /// Adds the vertex at a part of the way from one vertex to another. All attributes are those of the line between
    /// them. Normals get the length 1 again, and of joints, the four with the largest weights stay.
    fn push_between(&mut self, a: usize, b: usize, part: f64) {
        fn push<const N: usize>(list: &mut Vec<[f32; N]>, a: usize, b: usize, part: f64) {
            if !list.is_empty() {
                list.push(mixed_floats(list[a], list[b], part));
            }
        }
        push(&mut self.positions, a, b, part);
        push(&mut self.uvs, a, b, part);
        push(&mut self.colors, a, b, part);
        if !self.normals.is_empty() {
            let [from, to] = [a, b].map(|v| self.normals[v].map(f64::from));
            // Opposite normals have no middle.
            let normal = unit(mixed(from, to, part)).unwrap_or(from);
            self.normals.push(normal.map(|x| x as f32));
        }
        for morph in &mut self.morphs {
            push(&mut morph.positions, a, b, part);
            push(&mut morph.normals, a, b, part);
        }
        if !self.joints.is_empty() {
            let (joints, weights) = mixed_joints(&self.joints, &self.weights, a, b, part);
            self.joints.push(joints);
            self.weights.push(weights);
        }
    }
}

/// Returns the four joints with the largest weights at a part of the way from one vertex to another. The sum of their
/// weights is 1.
fn mixed_joints(joints: &[[u16; 4]], weights: &[[f32; 4]], a: usize, b: usize, part: f64) -> ([u16; 4], [f32; 4]) {
    let mut sums: Vec<(u16, f64)> = Vec::with_capacity(8);
    for (v, share) in [(a, 1.0 - part), (b, part)] {
        for (joint, weight) in joints[v].iter().zip(weights[v]) {
            let weight = f64::from(weight) * share;
            match sums.iter_mut().find(|(known, _)| known == joint) {
                Some((_, sum)) => *sum += weight,
                None => sums.push((*joint, weight)),
            }
        }
    }
    sums.sort_by(|a, b| b.1.total_cmp(&a.1));
    sums.truncate(4);
    let all: f64 = sums.iter().map(|(_, weight)| weight).sum();
    let of = |k: usize| sums.get(k).filter(|(_, weight)| *weight > 0.0);
    let weight = |k| of(k).map_or(0.0, |(_, weight)| (weight / all) as f32);
    ([0, 1, 2, 3].map(|k| of(k).map_or(0, |(joint, _)| *joint)), [0, 1, 2, 3].map(weight))
}

#[cfg(test)]
mod tests;
