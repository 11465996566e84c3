//! What finding the pixels of triangles takes by each traversal: firmware that counts. `ci/traversals` runs it and
//! prints what it takes.
//!
//! It prints, for each run, `size how/samples ticks triangles hash pixels`. How is a traversal; ticks are those of
//! SysTick (instructions on RISC-V). A hash of the pixels follows, which is equal for all traversals, and the
//! pixels of a triangle, on average.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "firmware/count.rs"]
mod count;
#[cfg(target_os = "none")]
mod firmware;
#[cfg(target_os = "none")]
#[path = "firmware/ticks.rs"]
mod ticks;

#[cfg(target_os = "none")]
mod counting {
    use super::count;
    use core::hint::black_box;
    use core::ops::Range;
    use semihosting::println;
    use zstrip::internals::{PixelRect, blocks, bounding_box, covered_samples, moves, signed_area, spans};
    use zstrip::vertex::ScreenVertex;

    const COUNT: usize = 64;
    const CLIP: PixelRect = PixelRect { x: 0..320, y: 0..240 };
    /// Sides of the squares that corners are in, in pixels. The last triangles cover the screen.
    const SIZES: [(&str, i32); 5] = [("tiny", 4), ("small", 8), ("medium", 38), ("large", 120), ("screen", 0)];

    type Triangle = [ScreenVertex; 3];

    /// Random triangles that have an area, in a square on the screen.
    fn triangles(side: i32) -> [Triangle; COUNT] {
        let mut state = 1_u32;
        let mut below = |end: i32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((u64::from(state) * end as u64) >> 32) as i32
        };
        [(); COUNT].map(|()| {
            if side == 0 {
                let at = [[-400, -300], [1100, -200], [-300, 1000]];
                return at.map(|[x, y]| ScreenVertex::new(256 * x + below(9999), 256 * y + below(9999), 0));
            }
            let at = [below(256 * (320 - side)), below(256 * (240 - side))];
            loop {
                let v = [(); 3].map(|()| ScreenVertex::new(at[0] + below(256 * side), at[1] + below(256 * side), 0));
                // A quarter of the square at least: no slivers.
                if signed_area(&v[0], &v[1], &v[2]).unsigned_abs() >= (128 * side as u64).pow(2) {
                    return v;
                }
            }
        })
    }

    /// Adds up pixels so that the order of runs does not matter.
    fn add(sum: &mut u32, y: i32, x: Range<i32>) {
        let places = (x.start + x.end - 1) * (x.end - x.start);
        *sum = sum.wrapping_add((places as u32).wrapping_mul(2 * y as u32 + 1));
    }

    fn by_scanline(v: &Triangle, sum: &mut u32) {
        spans(v, signed_area(&v[0], &v[1], &v[2]), &CLIP, |y, x| add(sum, y, x));
    }

    fn by_bounding_box(v: &Triangle, sum: &mut u32) {
        bounding_box(v, signed_area(&v[0], &v[1], &v[2]), &CLIP, |y, x| add(sum, y, x));
    }

    fn by_blocks(v: &Triangle, sum: &mut u32) {
        blocks(v, signed_area(&v[0], &v[1], &v[2]), &CLIP, |block| {
            for (y, bits) in (block.y..).zip(block.rows) {
                if bits != 0 {
                    // A triangle's pixels in a row are next to each other.
                    let start = bits.trailing_zeros();
                    let end = start + (bits >> start).trailing_ones();
                    add(sum, y, block.x + start as i32..block.x + end as i32);
                }
            }
        });
    }

    fn samples_by_scanline(v: &Triangle, sum: &mut u32) {
        let area = signed_area(&v[0], &v[1], &v[2]);
        for (x, y) in moves(4) {
            let moved = v.each_ref().map(|v| ScreenVertex { x: v.x + x, y: v.y + y, z: v.z });
            spans(&moved, area, &CLIP, |y, x| add(sum, y, x));
        }
    }

    fn samples_by_bounding_box(v: &Triangle, sum: &mut u32) {
        covered_samples(v, signed_area(&v[0], &v[1], &v[2]), 4, &CLIP, |x, y, covered| {
            let count = [0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4][usize::from(covered & 15)];
            *sum = sum.wrapping_add((2 * x as u32).wrapping_mul(2 * y as u32 + 1).wrapping_mul(count));
        });
    }

    fn report(size: &str, how: &str, triangles: &[Triangle; COUNT], walk: fn(&Triangle, &mut u32)) {
        let mut sum = 0;
        let ticks = count::ticks_of(|| {
            for v in black_box(triangles) {
                walk(v, &mut sum);
            }
        });
        let mut pixels = 0;
        for v in triangles {
            spans(v, signed_area(&v[0], &v[1], &v[2]), &CLIP, |_, x| pixels += x.len());
        }
        println!("{size} {how} {ticks} {COUNT} {sum:08x} {}", pixels / COUNT);
    }

    pub fn run() {
        if !count::start() {
            return;
        }
        for (size, side) in SIZES {
            let triangles = triangles(side);
            report(size, "scanline/1", &triangles, by_scanline);
            report(size, "box/1", &triangles, by_bounding_box);
            report(size, "blocks/1", &triangles, by_blocks);
            report(size, "scanline/4", &triangles, samples_by_scanline);
            report(size, "box/4", &triangles, samples_by_bounding_box);
        }
    }
}

#[cfg(target_os = "none")]
use counting::run;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this example is firmware: ci/traversals builds it");
}
