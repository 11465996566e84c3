//! Makes normals: one per corner of a triangle, smooth up to a crease angle.
//!
//! The normal of a corner is the sum of the unit normals of faces around its place, each times the angle that the face
//! has there. Faces count whose normal is within the crease angle of the corner's own face; or, where the file has
//! smoothing groups, those of the same group. So the division of a flat side into triangles does not matter.

use crate::draft::{FLAT_GROUP, NO_GROUP};
use crate::geometry::{Vector, corner_angle, dot, face_normal, unit};

/// The most corners at a place that are compared pair by pair. Beyond, all of them look smooth.
const MOST_AT_A_PLACE: usize = 1024;

/// Triangles, as far as normals need them.
pub struct Faces<'a> {
    /// Positions of vertices.
    pub positions: &'a [[f32; 3]],
    /// Triangles with an area.
    pub triangles: &'a [[u32; 3]],
    /// A smoothing group per triangle, or nothing.
    pub groups: &'a [u32],
    /// For each vertex, the first one at its place.
    pub places: &'a [u32],
}

/// Returns the unit normals of all corners, and the number of places at which too many meet.
pub fn smooth(faces: &Faces, crease_degrees: f64) -> (Vec<[[f32; 3]; 3]>, usize) {
    let corners = |t: usize| faces.triangles[t].map(|v| faces.positions[v as usize]);
    let own: Vec<Vector> = (0..faces.triangles.len()).map(|t| face_normal(corners(t)).unwrap_or([0.0; 3])).collect();
    let group = |t: usize| faces.groups.get(t).copied().unwrap_or(NO_GROUP);
    // The angle between equal vectors may come out above 0 by rounding.
    let least = crease_degrees.to_radians().cos() - 1e-9;
    let joins = |t: usize, other: usize| match (group(t), group(other)) {
        (FLAT_GROUP, _) | (_, FLAT_GROUP) => t == other,
        (NO_GROUP, NO_GROUP) => dot(own[t], own[other]) >= least,
        (a, b) => a == b,
    };

    let mut normals = vec![[[0.0; 3]; 3]; faces.triangles.len()];
    let mut crowded = 0;
    for around in corners_by_place(faces) {
        let is_crowded = around.len() > MOST_AT_A_PLACE;
        crowded += usize::from(is_crowded);
        let part = |&(t, k): &(u32, u8)| {
            let angle = corner_angle(corners(t as usize), usize::from(k));
            own[t as usize].map(|x| x * angle)
        };
        let parts: Vec<Vector> = around.iter().map(part).collect();
        let sum = |chosen: &dyn Fn(usize) -> bool| {
            let chosen = around.iter().zip(&parts).filter(|((t, _), _)| chosen(*t as usize));
            chosen.fold([0.0; 3], |sum: Vector, (_, part)| std::array::from_fn(|k| sum[k] + part[k]))
        };
        let all = is_crowded.then(|| sum(&|_| true));
        for &(t, k) in &around {
            let t = t as usize;
            let sum = all.unwrap_or_else(|| sum(&|other| joins(t, other)));
            normals[t][usize::from(k)] = unit(sum).unwrap_or(own[t]).map(|x| x as f32);
        }
    }
    (normals, crowded)
}

/// Returns the normals of all faces, for each of their corners.
pub fn flat(faces: &Faces) -> Vec<[[f32; 3]; 3]> {
    let normal = |t: &[u32; 3]| face_normal(t.map(|v| faces.positions[v as usize])).unwrap_or([0.0; 3]);
    faces.triangles.iter().map(|t| [normal(t).map(|x| x as f32); 3]).collect()
}

/// The corners at each place, as triangles and which of their corners it is.
fn corners_by_place(faces: &Faces) -> Vec<Vec<(u32, u8)>> {
    let mut sorted: Vec<(u32, u32, u8)> = Vec::with_capacity(3 * faces.triangles.len());
    for (t, triangle) in faces.triangles.iter().enumerate() {
        sorted.extend((0..3u8).map(|k| (faces.places[triangle[usize::from(k)] as usize], t as u32, k)));
    }
    sorted.sort_unstable();
    sorted.chunk_by(|a, b| a.0 == b.0).map(|run| run.iter().map(|(_, t, k)| (*t, *k)).collect()).collect()
}
