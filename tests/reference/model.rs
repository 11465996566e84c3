//! The rasterizer that the conformance checker is itself checked with: exact coverage and depth, and 2-D homogeneous
//! clipping.
//!
//! It passes every record, which shows that files, checker and references agree on the rules.

use super::conformance::{ClipTriangle, PerspectiveTriangle, Rasterizer, ScreenTriangle};
use super::homogeneous::{Vertex, Viewport, for_each_sample};
use super::{diamonds, exact};

/// A rasterizer without any cleverness.
#[derive(Clone, Copy, Debug)]
pub struct Model;

impl Rasterizer for Model {
    fn triangle(&mut self, width: u32, height: u32, v: ScreenTriangle, hit: &mut dyn FnMut(u32, u32)) {
        exact::for_each_pixel(exact::widen(v), width, height, hit);
    }

    fn samples(&mut self, width: u32, height: u32, v: ScreenTriangle, hit: &mut dyn FnMut(usize, u32, u32)) {
        for (sample, place) in exact::STANDARD_SAMPLES.into_iter().enumerate() {
            for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
                let at = [256 * i64::from(x) + place[0], 256 * i64::from(y) + place[1]];
                if exact::covers_at(exact::widen(v), at) {
                    hit(sample, x, y);
                }
            }
        }
    }

    fn depth_scene(&mut self, width: u32, height: u32, tris: &[(ScreenTriangle, [u16; 3])]) -> (Vec<u32>, Vec<u16>) {
        let count = width as usize * height as usize;
        let (mut winners, mut depths) = (vec![0; count], vec![u16::MAX; count]);
        for (&(v, z), id) in tris.iter().zip(1..) {
            let (tri, z) = (exact::widen(v), z.map(i64::from));
            exact::for_each_pixel(tri, width, height, |x, y| {
                let index = y as usize * width as usize + x as usize;
                let depth = exact::depth_rounded(tri, z, x.into(), y.into());
                if depth < i64::from(depths[index]) {
                    // Inside the triangle the plane stays between the vertices' codes.
                    depths[index] = depth as u16;
                    winners[index] = id;
                }
            });
        }
        (winners, depths)
    }

    fn perspective(&mut self, width: u32, height: u32, triangle: &PerspectiveTriangle) -> Vec<Option<[f64; 2]>> {
        let tri = exact::widen(triangle.v);
        let mut values = vec![None; width as usize * height as usize];
        exact::for_each_pixel(tri, width, height, |x, y| {
            let at = exact::center(x.into(), y.into());
            values[(y * width + x) as usize] = Some([triangle.u, triangle.t].map(|at_vertices| {
                let (num, den) = exact::perspective_at(tri, triangle.w.map(i64::from), at_vertices.map(i64::from), at);
                num as f64 / den as f64
            }));
        });
        values
    }

    fn clip_triangles(&mut self, width: u32, height: u32, tris: &[ClipTriangle], hit: &mut dyn FnMut(usize, u32, u32)) {
        let viewport = Viewport { clip_y_down: true, ..Viewport::new(width, height) };
        for (index, tri) in tris.iter().enumerate() {
            let vertices = tri.map(|v| Vertex { position: v.map(f64::from), attributes: [] });
            for_each_sample(&viewport, (width, height), &vertices, |sample| {
                if sample.covered {
                    hit(index, sample.x, sample.y);
                }
            });
        }
    }

    fn line(&mut self, width: u32, height: u32, [a, b]: [[i32; 2]; 2], hit: &mut dyn FnMut(u32, u32)) {
        for (x, y) in diamonds::pixels(a, b) {
            if (0..width as i32).contains(&x) && (0..height as i32).contains(&y) {
                hit(x as u32, y as u32);
            }
        }
    }

    fn point(&mut self, width: u32, height: u32, center: [i32; 2], side: u32, hit: &mut dyn FnMut(u32, u32)) {
        let inside = |pixel: u32, c: i32| {
            let (twice, side) = (2 * (256 * pixel as i32 + 128), side as i32);
            2 * c - side <= twice && twice < 2 * c + side
        };
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            if inside(x, center[0]) && inside(y, center[1]) {
                hit(x, y);
            }
        }
    }
}
