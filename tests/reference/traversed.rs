//! The crate's traversals by themselves behind the checker's trait: triangles and samples of triangles. All else is
//! drawn as [`Subject`] draws it.

use super::conformance::{ClipTriangle, PerspectiveTriangle, Rasterizer, ScreenTriangle};
use super::subject::Subject;
use std::ops::Range;
use zstrip::internals::{PixelRect, blocks, bounding_box, covered_samples, moves, signed_area, spans};
use zstrip::vertex::ScreenVertex;

/// Finds the pixels of a triangle with this signed area in a rectangle, and calls a function for runs of them.
pub type Traversal = fn(&[ScreenVertex; 3], i64, &PixelRect, &mut dyn FnMut(i32, Range<i32>));

/// All traversals, the scanline one first.
pub const WALKS: [(&str, Traversal); 3] =
    [("scanline", by_scanline), ("bounding box", by_bounding_box), ("blocks", by_blocks)];

fn by_scanline(v: &[ScreenVertex; 3], area: i64, clip: &PixelRect, run: &mut dyn FnMut(i32, Range<i32>)) {
    spans(v, area, clip, run);
}

fn by_bounding_box(v: &[ScreenVertex; 3], area: i64, clip: &PixelRect, run: &mut dyn FnMut(i32, Range<i32>)) {
    bounding_box(v, area, clip, run);
}

fn by_blocks(v: &[ScreenVertex; 3], area: i64, clip: &PixelRect, run: &mut dyn FnMut(i32, Range<i32>)) {
    blocks(v, area, clip, |block| {
        assert!(block.x % 8 == 0 && block.y % 8 == 0 && block.rows != [0; 8], "{block:?}");
        assert_eq!(block.is_whole(), block.rows.iter().all(|row| *row == 255), "{block:?}");
        for (y, bits) in (block.y..).zip(block.rows) {
            for x in (0..8).filter(|x| bits >> x & 1 == 1) {
                run(y, block.x + x..block.x + x + 1);
            }
        }
    });
}

/// Covers triangles by one of the traversals.
pub struct Traversed {
    how: (&'static str, Traversal),
    others: Subject,
}

impl Traversed {
    pub fn new(how: (&'static str, Traversal)) -> Self {
        Self { how, others: Subject::default() }
    }
}

impl Rasterizer for Traversed {
    fn triangle(&mut self, width: u32, height: u32, v: ScreenTriangle, hit: &mut dyn FnMut(u32, u32)) {
        let v = v.map(|[x, y]| ScreenVertex::new(x, y, 0));
        let clip = PixelRect { x: 0..width as i32, y: 0..height as i32 };
        (self.how.1)(&v, signed_area(&v[0], &v[1], &v[2]), &clip, &mut |y, columns| {
            columns.for_each(|x| hit(x as u32, y as u32));
        });
    }

    /// Over the bounding box, all samples at once; otherwise, the triangle moved for each of them.
    fn samples(&mut self, width: u32, height: u32, v: ScreenTriangle, hit: &mut dyn FnMut(usize, u32, u32)) {
        let v = v.map(|[x, y]| ScreenVertex::new(x, y, 0));
        let clip = PixelRect { x: 0..width as i32, y: 0..height as i32 };
        let area = signed_area(&v[0], &v[1], &v[2]);
        if self.how.0 == "bounding box" {
            return covered_samples(&v, area, 4, &clip, |x, y, covered| {
                (0..4).filter(|sample| covered >> sample & 1 == 1).for_each(|sample| hit(sample, x as u32, y as u32));
            });
        }
        for (sample, (right, down)) in moves(4).iter().enumerate() {
            let moved = v.map(|v| ScreenVertex::new(v.x + right, v.y + down, 0));
            (self.how.1)(&moved, area, &clip, &mut |y, columns| {
                columns.for_each(|x| hit(sample, x as u32, y as u32));
            });
        }
    }

    fn depth_scene(&mut self, width: u32, height: u32, tris: &[(ScreenTriangle, [u16; 3])]) -> (Vec<u32>, Vec<u16>) {
        self.others.depth_scene(width, height, tris)
    }

    fn perspective(&mut self, width: u32, height: u32, triangle: &PerspectiveTriangle) -> Vec<Option<[f64; 2]>> {
        self.others.perspective(width, height, triangle)
    }

    fn clip_triangles(&mut self, width: u32, height: u32, tris: &[ClipTriangle], hit: &mut dyn FnMut(usize, u32, u32)) {
        self.others.clip_triangles(width, height, tris, hit);
    }

    fn line(&mut self, width: u32, height: u32, ends: [[i32; 2]; 2], hit: &mut dyn FnMut(u32, u32)) {
        self.others.line(width, height, ends, hit);
    }

    fn point(&mut self, width: u32, height: u32, center: [i32; 2], side: u32, hit: &mut dyn FnMut(u32, u32)) {
        self.others.point(width, height, center, side, hit);
    }
}
