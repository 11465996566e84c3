//! Finds vertices that are equal, or at one place.

use std::collections::HashMap;

use crate::model::Vertices;

/// Returns for each vertex the first one whose attributes are all equal.
pub fn equal(vertices: &Vertices) -> Vec<u32> {
    classes(vertices.len(), |a, b| vertices.bits(a).cmp(vertices.bits(b)))
}

/// Returns for each vertex the first one at its place, which also moves as it does.
///
/// With a distance above 0, vertices are looked at in order: each joins the first of the places so far within the
/// distance, or is a place of its own.
pub fn places(vertices: &Vertices, distance: f64) -> Vec<u32> {
    if distance > 0.0 {
        return places_within(vertices, distance);
    }
    let moves = |a, b| vertices.motion_bits(a).cmp(vertices.motion_bits(b));
    classes(vertices.len(), |a, b| vertices.position_bits(a).cmp(vertices.position_bits(b)).then_with(|| moves(a, b)))
}

/// Returns the vertices that triangles use, each once, in the order of their use. `same` is what [`equal`] returns.
///
/// Vertices that are used one after the other then lie one after the other, which suits caches of flash.
pub fn compact(vertices: &Vertices, triangles: &mut [[u32; 3]], same: &[u32]) -> Vertices {
    let mut numbers = vec![u32::MAX; vertices.len()];
    let mut order = Vec::new();
    for index in triangles.iter_mut().flatten() {
        let first = same[*index as usize];
        let number = &mut numbers[first as usize];
        if *number == u32::MAX {
            *number = order.len() as u32;
            order.push(first);
        }
        *index = *number;
    }
    vertices.select(&order)
}

/// Returns for each number below `count` the first one that compares as equal.
fn classes(count: usize, compare: impl Fn(usize, usize) -> std::cmp::Ordering) -> Vec<u32> {
    let mut sorted: Vec<u32> = (0..count as u32).collect();
    sorted.sort_unstable_by(|a, b| compare(*a as usize, *b as usize).then(a.cmp(b)));
    let mut classes = vec![0; count];
    for run in sorted.chunk_by(|a, b| compare(*a as usize, *b as usize).is_eq()) {
        run.iter().for_each(|k| classes[*k as usize] = run[0]);
    }
    classes
}

fn places_within(vertices: &Vertices, distance: f64) -> Vec<u32> {
    // Cells of a grid as large as the distance: places within it are in the cell of the vertex or beside it.
    let mut grid: HashMap<[u64; 3], Vec<u32>> = HashMap::new();
    let at = |n: usize| vertices.positions[n].map(f64::from);
    let mut places = Vec::with_capacity(vertices.len());
    for n in 0..vertices.len() {
        let cell = at(n).map(|x| (x / distance).floor());
        let near = |place: usize| {
            let square: f64 = at(n).iter().zip(at(place)).map(|(a, b)| (a - b) * (a - b)).sum();
            square <= distance * distance && vertices.motion_bits(n).eq(vertices.motion_bits(place))
        };
        let around = (0..27).map(|k| [k % 3, k / 3 % 3, k / 9].map(|step| f64::from(step) - 1.0));
        let first = around
            .filter_map(|step| grid.get(&std::array::from_fn(|k| (cell[k] + step[k] + 0.0).to_bits())))
            .flat_map(|cell| cell.iter().copied().filter(|place| near(*place as usize)).min())
            .min();
        places.push(first.unwrap_or_else(|| {
            grid.entry(cell.map(|x| (x + 0.0).to_bits())).or_default().push(n as u32);
            n as u32
        }));
    }
    places
}
