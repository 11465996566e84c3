//! Depth-tested frames from vertices that are already snapped: the oracle for flat and Gouraud pictures.
//!
//! In: triangles with 24.8 positions, 16-bit depth codes and a colour per vertex, in draw order. Out: a [`Frame`] whose
//! ids and depth codes are exact (coverage and depth by [`exact`], test `Less` on the depth rounded half up) and whose
//! colours are the plane through the vertex colours, in f64.

use super::exact;
use super::frame::{Cull, Frame};

/// A vertex as it is after the viewport transform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnappedVertex {
    /// x right, y down, in 1/256 px.
    pub position: [i32; 2],
    /// 0 near, 65535 far.
    pub depth: u16,
    pub color: [f64; 3],
}

/// How colours spread over a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shading {
    /// The first vertex gives the colour.
    Flat,
    /// The plane through the three colours, linear on screen.
    Gouraud,
}

/// Draws one triangle into `frame`.
///
/// The frame's depths are `code / 65535`, so that [`Frame::depth_codes`] gives the codes back; `gap` is the difference
/// of codes, divided likewise, and zero on a tie. `margin` is the distance to the nearest edge, though no decision here
/// is in doubt.
pub fn draw(frame: &mut Frame, cull: Cull, tri: &[SnappedVertex; 3], shading: Shading, id: u32) {
    let position = exact::widen(tri.map(|v| v.position));
    let area = exact::area2(position);
    if area == 0 || cull.drops(area < 0) {
        return;
    }
    let z = tri.map(|v| i64::from(v.depth));
    for y in 0..frame.height {
        for x in 0..frame.width {
            let (px, py) = (i64::from(x), i64::from(y));
            let index = frame.index(x, y);
            frame.note_margin(index, margin_at(position, px, py));
            if !exact::covers(position, px, py) {
                continue;
            }
            let code = exact::depth_rounded(position, z, px, py);
            let color = match shading {
                Shading::Flat => tri[0].color,
                Shading::Gouraud => gouraud_at(position, tri, px, py),
            };
            frame.offer(index, code as f64 / 65535.0, color, id);
        }
    }
}

/// Draws `tris` in order, with ids from 1, on an empty frame.
pub fn render(
    (width, height): (u32, u32),
    background: [f64; 3],
    cull: Cull,
    shading: Shading,
    tris: &[[SnappedVertex; 3]],
) -> Frame {
    let mut frame = Frame::new(width, height, background);
    for (tri, id) in tris.iter().zip(1..) {
        draw(&mut frame, cull, tri, shading, id);
    }
    frame
}

/// Colour plane at a pixel centre.
fn gouraud_at(position: exact::Triangle, tri: &[SnappedVertex; 3], px: i64, py: i64) -> [f64; 3] {
    let (weights, sum) = exact::barycentric_at(position, exact::center(px, py));
    let weights = weights.map(|w| exact::to_f64((w, sum)));
    std::array::from_fn(|channel| (0..3).map(|i| weights[i] * tri[i].color[channel]).sum())
}

/// Distance in px from a pixel centre to the nearest edge inside the triangle, or to the edge most violated outside it.
fn margin_at(position: exact::Triangle, px: i64, py: i64) -> f64 {
    let (weights, _) = exact::barycentric_at(position, exact::center(px, py));
    let distance = |i: usize| {
        let (a, b) = (position[(i + 1) % 3], position[(i + 2) % 3]);
        let length = ((b[0] - a[0]) as f64).hypot((b[1] - a[1]) as f64);
        weights[i] as f64 / length / 256.0
    };
    distance(0).min(distance(1)).min(distance(2)).abs()
}
