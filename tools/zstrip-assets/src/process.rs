//! Turns drafts into meshes: the steps in their order.
//!
//! Drafts come in groups, each the parts of a shape that have different materials. Where parts meet, edges are not
//! open, normals are smooth, and simplifying must not tear a gap. So these steps look at a group as a whole.

use std::collections::HashMap;

use crate::clean::{drop_invisible, edges, wind};
use crate::cluster;
use crate::draft::{Context, Draft, NO_GROUP};
use crate::model::{Bounds, Mesh};
use crate::normals::{Faces, flat, smooth};
use crate::options::Normals;
use crate::report::Note;
use crate::simplify::simplify;
use crate::weld::{compact, equal, places};

/// Drops what shows nothing, welds, and turns triangles over.
pub(crate) fn repair(group: &mut [Draft], context: &mut Context) {
    let (options, report) = (context.options, &mut context.report);
    let distance = options.weld_distance * context.unit;
    for draft in &mut *group {
        let at = places(&draft.vertices, distance);
        if distance > 0.0 {
            let old = draft.vertices.positions.clone();
            for (position, place) in draft.vertices.positions.iter_mut().zip(&at) {
                *position = old[*place as usize];
            }
            let moved = old.iter().zip(&draft.vertices.positions).filter(|(old, new)| old != new);
            report.add(Note::Moved { vertices: moved.count() });
        }
        drop_invisible(draft, &at, report);
        wind(draft, options.winding, report);
        if options.normals != Normals::Keep {
            draft.vertices.normals = Vec::new();
        }
        let count = draft.vertices.len();
        weld(draft);
        report.add(Note::Welded { vertices: count - draft.vertices.len() });
    }
    let points = points(group);
    let corners = |(draft, points): (&Draft, &Vec<u32>)| -> Vec<[u32; 3]> {
        draft.triangles.iter().map(|t| t.map(|v| points[v as usize])).collect()
    };
    edges(group.iter().zip(&points).flat_map(corners)).report(report);
}

/// Simplifies each draft to its budget, makes normals, and divides each into meshes with clusters.
pub(crate) fn finish(
    mut group: Vec<Draft>,
    budget: &dyn Fn(usize) -> Option<usize>,
    context: &mut Context,
) -> Vec<Vec<Mesh>> {
    let locks = shared(&group);
    for (draft, lock) in group.iter_mut().zip(&locks) {
        let from = draft.triangles.len();
        let Some(budget) = budget(from).filter(|budget| *budget < from) else { continue };
        let (unit, size) = unit_positions(&draft.vertices.positions);
        let (left, error) = simplify(&unit, &draft.triangles, lock, budget);
        // Triangles that are left have other corners, so their groups are those of no triangle of the file.
        draft.groups = Vec::new();
        draft.triangles = left;
        let error = (f64::from(error) * f64::from(size) / context.unit) as f32;
        context.report.add(Note::Simplified { from, to: draft.triangles.len(), budget, error });
        weld(draft);
    }
    make_normals(&mut group, context);
    group.into_iter().map(|draft| divide(draft, context)).collect()
}

/// Divides a draft into meshes with clusters.
fn divide(draft: Draft, context: &mut Context) -> Vec<Mesh> {
    let (unit, _) = unit_positions(&draft.vertices.positions);
    let clusters = cluster::group(&unit, &draft.triangles, context.options);
    let mut meshes = cluster::split(&draft.vertices, &clusters, context.options.max_vertices);
    if meshes.len() > 1 {
        context.report.add(Note::Split { mesh: draft.name.clone(), parts: meshes.len() });
    }
    for mesh in &mut meshes {
        (mesh.name, mesh.material) = (draft.name.clone(), draft.material);
    }
    meshes
}

/// Makes equal vertices one, and drops those that no triangle uses.
fn weld(draft: &mut Draft) {
    let same = equal(&draft.vertices);
    draft.vertices = compact(&draft.vertices, &mut draft.triangles, &same);
}

/// Numbers the positions of all vertices of a group: equal ones have the same number.
fn points(group: &[Draft]) -> Vec<Vec<u32>> {
    let mut numbers = HashMap::new();
    let mut number = |position: &[f32; 3]| {
        let next = numbers.len() as u32;
        // 0 and -0 are one.
        *numbers.entry(position.map(|x| (x + 0.0).to_bits())).or_insert(next)
    };
    group.iter().map(|draft| draft.vertices.positions.iter().map(&mut number).collect()).collect()
}

/// Returns for each vertex of each draft whether another draft has one at its position.
fn shared(group: &[Draft]) -> Vec<Vec<bool>> {
    let points = points(group);
    let count = points.iter().flatten().max().map_or(0, |most| *most as usize + 1);
    let mut owners = vec![usize::MAX; count];
    let mut is_shared = vec![false; count];
    for (k, point) in points.iter().enumerate().flat_map(|(k, points)| points.iter().map(move |point| (k, point))) {
        let owner = &mut owners[*point as usize];
        is_shared[*point as usize] |= *owner != usize::MAX && *owner != k;
        *owner = k;
    }
    points.iter().map(|points| points.iter().map(|point| is_shared[*point as usize]).collect()).collect()
}

/// Gives normals to all corners that have none, and splits vertices whose corners differ.
fn make_normals(group: &mut [Draft], context: &mut Context) {
    let (options, report) = (context.options, &mut context.report);
    let missing: usize =
        group.iter().map(|draft| draft.triangles.iter().flatten().filter(|v| is_missing(draft, **v)).count()).sum();
    if missing == 0 {
        return;
    }
    // All drafts as one.
    let (mut positions, mut triangles, mut groups) = (Vec::new(), Vec::new(), Vec::new());
    for draft in &*group {
        let first = positions.len() as u32;
        positions.extend(&draft.vertices.positions);
        triangles.extend(draft.triangles.iter().map(|t| t.map(|v| first + v)));
        groups.extend(draft.groups.iter().copied().filter(|_| options.normals == Normals::Keep));
        groups.resize(triangles.len(), NO_GROUP);
    }
    let points = points(group).concat();
    let faces = Faces { positions: &positions, triangles: &triangles, groups: &groups, places: &points };
    let (made, crowded) = match options.normals {
        Normals::Flat => (flat(&faces), 0),
        Normals::Keep | Normals::Smooth => smooth(&faces, options.crease_angle),
    };
    report.add(Note::NormalsMade { corners: missing });
    report.add(Note::CrowdedPoints { points: crowded });

    let mut made = made.into_iter();
    for draft in group {
        // Each corner becomes a vertex of its own; those that are equal are then welded.
        let corners = draft.triangles.as_flattened();
        let normal = |(v, made): (&u32, [f32; 3])| {
            if is_missing(draft, *v) { made } else { draft.vertices.normals[*v as usize] }
        };
        let own = made.by_ref().take(draft.triangles.len()).flatten();
        let mut split = draft.vertices.select(corners);
        split.normals = corners.iter().zip(own).map(normal).collect();
        draft.triangles = (0..draft.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        draft.vertices = split;
        weld(draft);
    }
}

/// Returns whether a vertex has no normal.
fn is_missing(draft: &Draft, v: u32) -> bool {
    draft.vertices.normals.get(v as usize).is_none_or(|normal| *normal == [0.0; 3])
}

/// Positions as parts of the largest extent, from 0 to 1, and that extent: meshopt squares numbers in 32 bits.
pub(crate) fn unit_positions(positions: &[[f32; 3]]) -> (Vec<[f32; 3]>, f32) {
    let Some(bounds) = Bounds::around(positions.iter().copied()) else { return (Vec::new(), 0.0) };
    let extent = |k: usize| f64::from(bounds.max[k]) - f64::from(bounds.min[k]);
    let size = (0..3).map(extent).fold(0.0, f64::max);
    let factor = if size > 0.0 { 1.0 / size } else { 0.0 };
    let unit = |p: &[f32; 3]| std::array::from_fn(|k| ((f64::from(p[k]) - f64::from(bounds.min[k])) * factor) as f32);
    (positions.iter().map(unit).collect(), size as f32)
}
