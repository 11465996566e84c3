//! Depth-tested frames from vertices that are already snapped: the oracle for flat and Gouraud pictures.
//!
//! In: triangles with 24.8 positions, 16-bit depth codes and a colour per vertex, in draw order. Out: a [`Frame`] whose ids
//! and depth codes are exact (coverage and depth by [`exact`], test `Less` on the depth rounded half up) and whose colours are
//! the plane through the vertex colours, in f64.

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
/// The frame's depths are `code / 65535`, so that [`Frame::depth_codes`] gives the codes back; `gap` is the difference of codes,
/// divided likewise, and zero on a tie. `margin` is the distance to the nearest edge, though no decision here is in doubt.
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

#[cfg(test)]
mod tests {
    use super::super::homogeneous;
    use super::super::rng::Rng;
    use super::*;

    fn random(rng: &mut Rng) -> [SnappedVertex; 3] {
        [(); 3].map(|()| SnappedVertex {
            position: [rng.between(-2000, 10_000), rng.between(-2000, 10_000)],
            depth: rng.between(0, 65535) as u16,
            color: [rng.unit(), rng.unit(), rng.unit()],
        })
    }

    /// The same triangle in clip space, with w = 1.
    fn unsnap(tri: &[SnappedVertex; 3]) -> [homogeneous::Vertex<3>; 3] {
        tri.map(|v| {
            let [x, y] = v.position.map(|c| f64::from(c) / 4096.0 - 1.0);
            homogeneous::Vertex {
                position: [x, -y, f64::from(v.depth) / 65535.0, 1.0],
                attributes: v.color,
            }
        })
    }

    #[test]
    fn agrees_with_homogeneous_rasterization() {
        let seed = 5;
        let mut rng = Rng::new(seed);
        for cull in [Cull::None, Cull::Back, Cull::Front] {
            let tris: Vec<_> = (0..30).map(|_| random(&mut rng)).collect();
            let snapped = render((32, 32), [0.0; 3], cull, Shading::Gouraud, &tris);
            let mut other = Frame::new(32, 32, [0.0; 3]);
            let viewport = homogeneous::Viewport::new(32, 32);
            for (tri, id) in tris.iter().zip(1..) {
                homogeneous::draw(&mut other, &viewport, cull, &unsnap(tri), id, |s| s.linear);
            }
            let result = snapped.compare(&other, 1e-6, 1.5 / 65535.0);
            assert_eq!(result.other_id, 0, "seed {seed} {cull:?}: {result:?}");
            assert!(result.compared > 900, "{result:?}");
            assert!(result.depth_error < 0.501 / 65535.0, "{result:?}");
            assert!(result.color_error < 1e-9, "{result:?}");
        }
    }

    #[test]
    fn flat_takes_the_first_vertex_and_ties_keep_the_first_triangle() {
        let mut rng = Rng::new(9);
        let mut tri = random(&mut rng);
        tri[0].position = [0, 0];
        tri[1].position = [2560, 0];
        tri[2].position = [0, 2560];
        let mut second = tri;
        second[0].color = [9.0; 3];
        let frame = render((8, 8), [0.0; 3], Cull::None, Shading::Flat, &[tri, second]);
        assert_eq!((frame.id[0], frame.color[0]), (1, tri[0].color));
        assert_eq!(frame.gap[0], 0.0);
        assert_eq!(frame.id[63], 0);
    }
}
