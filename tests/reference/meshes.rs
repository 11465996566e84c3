//! Random meshes in integers, for property tests: grids, fans and strips whose triangles share vertices and never
//! overlap.
//!
//! Screen coordinates are 1/256 px, y down; clip coordinates are raw 16.16 numbers, y up.

use super::rng::Rng;
use super::scenes::ClipVertex;

/// Triangles that share vertices: no two of them overlap.
#[derive(Clone, Debug)]
pub struct Mesh<V> {
    pub vertices: Vec<V>,
    pub triangles: Vec<[u16; 3]>,
}

impl<V: Copy> Mesh<V> {
    /// The vertices of triangle `index`.
    pub fn triangle(&self, index: usize) -> [V; 3] {
        self.triangles[index].map(|i| self.vertices[usize::from(i)])
    }

    /// Turns some triangles over and rotates the vertices of others; the area covered stays the same.
    pub fn shuffle_windings(&mut self, rng: &mut Rng) {
        for triangle in &mut self.triangles {
            triangle.rotate_left(rng.below(3) as usize);
            if rng.one_in(2) {
                triangle.swap(1, 2);
            }
        }
    }
}

/// A grid of `columns` x `rows` distorted cells that covers the viewport: every pixel belongs to exactly one triangle.
///
/// Inner vertices are moved by less than a quarter of a cell, so that no triangle turns over; the outer ones stay on or
/// outside the border. With `snap_to` 128, all vertices are on pixel centres, corners or edge mid-points.
///
/// # Panics
/// If a cell is smaller than 8 times `snap_to`, or there are more than 65,536 vertices.
pub fn grid(rng: &mut Rng, columns: u16, rows: u16, width: u32, height: u32, snap_to: i32) -> Mesh<[i32; 2]> {
    let mut place = |i: u16, count: u16, size: u32| {
        let cell = 256 * size as i32 / i32::from(count);
        assert!(cell >= 8 * snap_to, "cells too small to be distorted");
        let at = (256 * i64::from(size) * i64::from(i) / i64::from(count)) as i32;
        let play = if i == 0 || i == count { 0 } else { (cell - 1) / 4 - snap_to };
        let moved = at + rng.between(-play, play);
        // The last row or column must not be pulled inside the border.
        if i == count { at + (snap_to - at % snap_to) % snap_to } else { moved / snap_to * snap_to }
    };
    let mut vertices = Vec::new();
    for j in 0..=rows {
        for i in 0..=columns {
            vertices.push([place(i, columns, width), place(j, rows, height)]);
        }
    }
    assert!(vertices.len() <= 65_536, "indices are 16 bits");
    let mut triangles = Vec::new();
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
        let at = |i: u16, j: u16| j * (columns + 1) + i;
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
        let cell = if rng.one_in(2) { [[a, c, b], [b, c, d]] } else { [[a, c, d], [a, d, b]] };
        triangles.extend(cell);
    }
    Mesh { vertices, triangles }
}

/// A fan of `count` triangles around a point near the middle of the viewport, star-shaped.
///
/// # Panics
/// If `count < 5`.
pub fn fan(rng: &mut Rng, count: u16, width: u32, height: u32) -> Mesh<[i32; 2]> {
    assert!(count >= 5, "fewer could leave an angle of half a turn");
    let [cx, cy] = [width, height].map(|size| 128 * size as i32 + rng.between(-64, 64));
    let reach = 128 * width.max(height) as i32;
    let mut vertices = vec![[cx, cy]];
    for i in 0..count {
        // Walk around a square: a position per slot keeps the angles ascending, and any scale keeps the angle.
        let slot = 8 * reach / i32::from(count);
        let along = slot * i32::from(i) + rng.between(0, slot / 2);
        let (side, t) = (along / (2 * reach), along % (2 * reach) - reach);
        let (x, y) = [(t, -reach), (reach, t), (-t, reach), (-reach, -t)][side as usize % 4];
        let scale = rng.between(64, 320);
        let scaled = [x, y].map(|c| (i64::from(c) * i64::from(scale) / 256) as i32);
        vertices.push([cx + scaled[0], cy + scaled[1]]);
    }
    let triangles = (1..=count).map(|i| [0, i % count + 1, i]).collect();
    Mesh { vertices, triangles }
}

/// A triangle strip of `count` triangles that zigzags from left to right across the viewport.
///
/// The triangles are listed with one winding, as a strip's are after every second one is turned.
pub fn strip(rng: &mut Rng, count: u16, width: u32, height: u32) -> Mesh<[i32; 2]> {
    let [w, h] = [width, height].map(|size| 256 * size as i32);
    let step = (w + w / 4) / i32::from(count + 1);
    let vertices = (0..count + 2).map(|i| {
        let x = -w / 8 + step * i32::from(i) + rng.between(0, step / 2);
        let low = if i % 2 == 0 { 0 } else { h / 2 + 1 };
        [x, low + rng.between(0, h / 2 - 1)]
    });
    let vertices = vertices.collect();
    let triangles = (0..count).map(|i| if i % 2 == 0 { [i, i + 1, i + 2] } else { [i, i + 2, i + 1] });
    let triangles = triangles.collect();
    Mesh { vertices, triangles }
}

/// Puts a screen mesh into clip space so that the exact projection gives the same 1/256-px positions back.
///
/// Every vertex gets a w of its own, a multiple of 128 times the least common multiple of the sizes, because then
/// `x = w * (2 X / (256 width) - 1)` is an integer; z is anywhere in 0..=w.
///
/// # Panics
/// If a vertex is so far out that x or y does not fit in 32 bits.
pub fn lift(rng: &mut Rng, mesh: &Mesh<[i32; 2]>, width: u32, height: u32) -> Mesh<ClipVertex> {
    let (mut a, mut b) = (width, height);
    while b != 0 {
        (a, b) = (b, a % b);
    }
    let unit = i64::from(width) * i64::from(height / a) * 128;
    let highest = ((1 << 24) / unit).max(1);
    let vertices = mesh.vertices.iter().map(|&[x, y]| {
        let w = unit * (1 + rng.below(highest as u64) as i64);
        let narrow = |value: i64| i32::try_from(value).expect("within the range of clip space");
        let across = w / (128 * i64::from(width)) * (i64::from(x) - 128 * i64::from(width));
        let down = w / (128 * i64::from(height)) * (i64::from(y) - 128 * i64::from(height));
        let w = narrow(w);
        [narrow(across), narrow(-down), rng.between(0, w), w]
    });
    let vertices = vertices.collect();
    let triangles = mesh.triangles.clone();
    Mesh { vertices, triangles }
}
