//! Finds triangles that show nothing, triangles that face the wrong way, and edges that do not join two triangles.

use std::collections::HashSet;

use crate::draft::Draft;
use crate::geometry::{dot, face_normal};
use crate::model::Vertices;
use crate::options::Winding;
use crate::report::{Note, Report};

/// Drops triangles without area, and triangles whose places an earlier one has in the same order.
///
/// Two triangles back to back stay: together they are a sheet that is seen from both sides.
pub(crate) fn drop_invisible(draft: &mut Draft, places: &[u32], report: &mut Report) {
    let (mut degenerate, mut duplicate) = (0, 0);
    let mut seen = HashSet::with_capacity(draft.triangles.len());
    let vertices = &draft.vertices;
    let mut keep = |triangle: &[u32; 3]| {
        let mut at = triangle.map(|v| places[v as usize]);
        let is_thin = face_normal(triangle.map(|v| vertices.positions[v as usize])).is_none() && !has_morph(vertices);
        if at[0] == at[1] || at[1] == at[2] || at[2] == at[0] || is_thin {
            degenerate += 1;
            return false;
        }
        let least = (0..3).min_by_key(|k| at[*k]).unwrap_or(0);
        at.rotate_left(least);
        let is_new = seen.insert(at);
        duplicate += usize::from(!is_new);
        is_new
    };
    let kept: Vec<bool> = draft.triangles.iter().map(&mut keep).collect();
    let mut of_triangles = kept.iter();
    draft.triangles.retain(|_| *of_triangles.next().unwrap_or(&true));
    let mut of_groups = kept.iter();
    draft.groups.retain(|_| *of_groups.next().unwrap_or(&true));
    report.add(Note::Degenerate { triangles: degenerate });
    report.add(Note::Duplicate { triangles: duplicate });
}

/// A triangle of no area may get one when it is morphed.
fn has_morph(vertices: &Vertices) -> bool {
    vertices.morphs.iter().any(|morph| !morph.positions.is_empty())
}

/// Turns triangles over as the option says, and reports those whose normals in the file point to their back.
pub(crate) fn wind(draft: &mut Draft, winding: Winding, report: &mut Report) {
    let vertices = &draft.vertices;
    let (mut flipped, mut opposed) = (0, 0);
    for triangle in &mut draft.triangles {
        if winding == Winding::Flip {
            triangle.swap(1, 2);
            flipped += 1;
        }
        if is_opposed(vertices, *triangle) {
            if winding == Winding::FromNormals {
                triangle.swap(1, 2);
                flipped += 1;
            } else {
                opposed += 1;
            }
        }
    }
    report.add(Note::Flipped { triangles: flipped });
    report.add(Note::Opposed { triangles: opposed });
}

/// Returns whether the normals of a triangle's vertices point to its back.
fn is_opposed(vertices: &Vertices, triangle: [u32; 3]) -> bool {
    if vertices.normals.is_empty() {
        return false;
    }
    let corners = triangle.map(|v| vertices.positions[v as usize]);
    let sum = triangle.map(|v| vertices.normals[v as usize].map(f64::from));
    let sum = std::array::from_fn(|k| sum[0][k] + sum[1][k] + sum[2][k]);
    face_normal(corners).is_some_and(|normal| dot(normal, sum) < 0.0)
}

/// Edges that do not join two triangles of the same winding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Edges {
    /// Edges with one triangle.
    pub open: usize,
    /// Edges with more than two triangles.
    pub non_manifold: usize,
    /// Edges with two triangles that face opposite ways.
    pub inconsistent: usize,
}

/// Counts edges of triangles, whose corners are places.
pub fn edges(triangles: impl Iterator<Item = [u32; 3]>) -> Edges {
    let mut sides: Vec<(u32, u32, bool)> = Vec::new();
    for t in triangles {
        sides.extend([(t[0], t[1]), (t[1], t[2]), (t[2], t[0])].map(|(a, b)| (a.min(b), a.max(b), a < b)));
    }
    sides.sort_unstable();
    let mut edges = Edges::default();
    for run in sides.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        match run {
            [_] => edges.open += 1,
            [a, b] => edges.inconsistent += usize::from(a.2 == b.2),
            _ => edges.non_manifold += 1,
        }
    }
    edges
}

impl Edges {
    pub(crate) fn report(self, report: &mut Report) {
        report.add(Note::OpenEdges { edges: self.open });
        report.add(Note::NonManifold { edges: self.non_manifold });
        report.add(Note::Inconsistent { edges: self.inconsistent });
    }
}
