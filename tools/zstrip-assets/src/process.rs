//! Turns drafts into meshes: the steps in their order.

use crate::clean::{drop_invisible, edges, wind};
use crate::cluster;
use crate::draft::{Context, Draft};
use crate::error::{Error, Kind, Place};
use crate::model::{Mesh, Vertices};
use crate::normals::{Faces, flat, smooth};
use crate::options::Normals;
use crate::report::Note;
use crate::simplify::simplify;
use crate::weld::{compact, equal, places};

/// A draft whose triangles are repaired, before they are simplified.
pub(crate) struct Repaired {
    draft: Draft,
}

impl Repaired {
    /// The number of triangles, by which a budget is divided.
    pub fn triangles(&self) -> usize {
        self.draft.triangles.len()
    }
}

/// Drops what shows nothing, welds, and turns triangles over.
pub(crate) fn repair(mut draft: Draft, context: &mut Context) -> Repaired {
    let (options, report) = (context.options, &mut context.report);
    let at = places(&draft.vertices, options.weld_distance);
    if options.weld_distance > 0.0 {
        let old = draft.vertices.positions.clone();
        for (position, place) in draft.vertices.positions.iter_mut().zip(&at) {
            *position = old[*place as usize];
        }
        let moved = old.iter().zip(&draft.vertices.positions).filter(|(old, new)| old != new);
        report.add(Note::Moved { vertices: moved.count() });
    }
    drop_invisible(&mut draft, &at, report);
    wind(&mut draft, options.winding, report);
    edges(draft.triangles.iter().map(|t| t.map(|v| at[v as usize]))).report(report);
    if options.normals != Normals::Keep {
        draft.vertices.normals = Vec::new();
    }
    let count = draft.vertices.len();
    weld(&mut draft.vertices, &mut draft.triangles);
    report.add(Note::Welded { vertices: count - draft.vertices.len() });
    Repaired { draft }
}

/// Simplifies to `budget` triangles, makes normals, and divides into meshes with clusters.
pub(crate) fn finish(repaired: Repaired, budget: Option<usize>, context: &mut Context) -> Result<Vec<Mesh>, Error> {
    let mut draft = repaired.draft;
    let (options, report) = (context.options, &mut context.report);
    if draft.triangles.is_empty() {
        return Ok(Vec::new());
    }
    if let Some(budget) = budget.filter(|budget| *budget < draft.triangles.len()) {
        let from = draft.triangles.len();
        let (unit, size) = unit_positions(&draft.vertices.positions);
        let (left, error) = simplify(&unit, &draft.triangles, budget);
        // Triangles that are left have other corners, so their groups are those of no triangle of the file.
        draft.groups = Vec::new();
        draft.triangles = left;
        report.add(Note::Simplified { from, to: draft.triangles.len(), budget, error: error * size });
        weld(&mut draft.vertices, &mut draft.triangles);
    }
    make_normals(&mut draft, context);
    if draft.vertices.len() > u32::MAX as usize / 4 {
        return Err(context.error(Place::File, Kind::Limit, "more than 2^30 vertices"));
    }
    let (unit, _) = unit_positions(&draft.vertices.positions);
    let clusters = cluster::group(&unit, &draft.triangles, options);
    let mut meshes = cluster::split(&draft.vertices, &clusters, options.max_vertices);
    if meshes.len() > 1 {
        context.report.add(Note::Split { mesh: draft.name.clone(), parts: meshes.len() });
    }
    for mesh in &mut meshes {
        (mesh.name, mesh.material) = (draft.name.clone(), draft.material);
    }
    Ok(meshes)
}

/// Makes equal vertices one, and drops those that no triangle uses.
fn weld(vertices: &mut Vertices, triangles: &mut [[u32; 3]]) {
    let same = equal(vertices);
    *vertices = compact(vertices, triangles, &same);
}

/// Gives normals to all corners that have none, and splits vertices whose corners differ.
fn make_normals(draft: &mut Draft, context: &mut Context) {
    let (options, report) = (context.options, &mut context.report);
    let is_missing = |normal: &[f32; 3]| *normal == [0.0; 3];
    let vertices = &draft.vertices;
    let given: Vec<[f32; 3]> =
        if vertices.normals.is_empty() { vec![[0.0; 3]; vertices.len()] } else { vertices.normals.clone() };
    if !draft.triangles.iter().flatten().any(|v| is_missing(&given[*v as usize])) {
        return;
    }
    let at = places(vertices, 0.0);
    let groups = if options.normals == Normals::Keep { &draft.groups[..] } else { &[] };
    let faces = Faces { positions: &vertices.positions, triangles: &draft.triangles, groups, places: &at };
    let (made, crowded) = match options.normals {
        Normals::Flat => (flat(&faces), 0),
        Normals::Keep | Normals::Smooth => smooth(&faces, options.crease_angle),
    };
    // Each corner becomes a vertex of its own; those that are equal are then welded.
    let corners = draft.triangles.as_flattened();
    let mut split = vertices.select(corners);
    let missing = corners.iter().map(|v| is_missing(&given[*v as usize]));
    report.add(Note::NormalsMade { corners: missing.filter(|missing| *missing).count() });
    report.add(Note::CrowdedPoints { points: crowded });
    let normal = |(v, made): (&u32, &[f32; 3])| {
        let given = given[*v as usize];
        if is_missing(&given) { *made } else { given }
    };
    split.normals = corners.iter().zip(made.as_flattened()).map(normal).collect();
    draft.triangles = (0..draft.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    draft.vertices = split;
    weld(&mut draft.vertices, &mut draft.triangles);
}

/// Positions as parts of the largest extent, from 0 to 1, and that extent: meshopt squares numbers in 32 bits.
fn unit_positions(positions: &[[f32; 3]]) -> (Vec<[f32; 3]>, f32) {
    let Some(bounds) = crate::model::Bounds::around(positions.iter().copied()) else { return (Vec::new(), 0.0) };
    let extent = |k: usize| f64::from(bounds.max[k]) - f64::from(bounds.min[k]);
    let size = (0..3).map(extent).fold(0.0, f64::max);
    let factor = if size > 0.0 { 1.0 / size } else { 0.0 };
    let unit = |p: &[f32; 3]| std::array::from_fn(|k| ((f64::from(p[k]) - f64::from(bounds.min[k])) * factor) as f32);
    (positions.iter().map(unit).collect(), size as f32)
}
