//! Traversals by edge functions, over the bounding box and by blocks, against the scanline one and the definition:
//! the same pixels, for all triangles of the conformance files and for random ones.

use crate::reference::conformance::check_file;
use crate::reference::exact;
use crate::reference::rng::Rng;
use crate::reference::traversed::{Traversal, Traversed, WALKS};
use std::path::PathBuf;
use zstrip::internals::{PixelRect, covered_samples, moves, signed_area, spans};
use zstrip::vertex::ScreenVertex;

/// Coordinates are within ±32,767 px.
const FAR: i32 = 32_767 << 8;

/// Pixels of a window of up to 64 columns, a word per row.
type Rows = Vec<u64>;

fn found(walk: Traversal, v: &[ScreenVertex; 3], clip: &PixelRect) -> Rows {
    let mut rows = vec![0_u64; clip.y.len()];
    walk(v, signed_area(&v[0], &v[1], &v[2]), clip, &mut |y, columns| {
        assert!(clip.y.contains(&y) && clip.x.start <= columns.start && columns.end <= clip.x.end, "{y} {columns:?}");
        assert!(columns.start < columns.end, "{y} {columns:?}");
        let (row, first) = (&mut rows[(y - clip.y.start) as usize], columns.start - clip.x.start);
        let bits = (!0_u64 >> (64 - columns.len())) << first;
        assert_eq!(*row & bits, 0, "{v:?}: pixels of row {y} twice");
        *row |= bits;
    });
    rows
}

/// Makes a triangle of one of many kinds near a window of 64×48 px: tiny, small, large and huge ones, slivers, ones
/// without area, on a grid of whole or half pixels, and off the window.
fn triangle(rng: &mut Rng, case: u32) -> [ScreenVertex; 3] {
    let size = [200, 700, 3000, 20_000, 30_720, 31_000, 200_000, FAR][case as usize % 8];
    let grid = [1, 1, 128, 256][case as usize / 8 % 4];
    let at = match rng.below(4) {
        0 if case.is_multiple_of(4) => [rng.between(-FAR / 4, FAR / 4), rng.between(-FAR / 4, FAR / 4)],
        _ => [rng.between(-500, 64 * 256 + 500), rng.between(-500, 48 * 256 + 500)],
    };
    let snapped = |c: i32| c.clamp(-FAR, FAR) / grid * grid;
    let point = |rng: &mut Rng| at.map(|c| snapped(c.saturating_add(rng.between(-size, size))));
    let [a, mut b, mut c] = [point(rng), point(rng), point(rng)];
    match rng.below(8) {
        // Without area: a corner twice, or all three on a line.
        0 => b = a,
        1 => c = [0, 1].map(|k| snapped(2 * b[k] - a[k])),
        // Slivers: a corner next to another one, or next to the opposite side.
        2 => b = a.map(|c| snapped(c + rng.between(-2, 2))),
        3 => c = [0, 1].map(|k| snapped((a[k] + b[k]) / 2 + rng.between(-3, 3))),
        // With a level side, or an upright one.
        4 => b[1] = a[1],
        5 => b[0] = a[0],
        _ => {}
    }
    [a, b, c].map(|[x, y]| ScreenVertex::new(x, y, 0))
}

/// Fewer cases where nothing is optimized.
const fn scaled(all: u32) -> u32 {
    if cfg!(debug_assertions) { all / 50 } else { all }
}

#[test]
fn a_million_random_triangles_have_the_pixels_of_the_scanline_traversal() {
    let seed = 41;
    let mut rng = Rng::new(seed);
    let (mut pixels, mut empty) = (0, 0);
    let all = scaled(1_000_000);
    for case in 0..all {
        let v = triangle(&mut rng, case);
        let rows = [1, 7, 8, 48, 48][case as usize % 5];
        let columns = [64, 9, 64][case as usize / 5 % 3];
        // Next to a corner or to the middle of the triangle, near the origin.
        let middle = |a: i32, b: i32, c: i32| [a, (a / 4 + b / 2 + c / 4)][case as usize / 15 % 2] >> 8;
        let left = middle(v[0].x, v[1].x, v[2].x).clamp(-3, 63) - rng.between(0, columns);
        let top = middle(v[0].y, v[1].y, v[2].y).clamp(-3, 47) - rng.between(0, rows);
        let clip = PixelRect { x: left..left + columns, y: top..top + rows };
        let expected = found(WALKS[0].1, &v, &clip);
        for (name, walk) in WALKS.into_iter().skip(1) {
            assert_eq!(found(walk, &v, &clip), expected, "{name}, seed {seed}, case {case}: {v:?} in {clip:?}");
        }
        let count: u32 = expected.iter().map(|row| row.count_ones()).sum();
        pixels += count;
        empty += u32::from(count == 0);
    }
    println!("seed {seed}: {all} triangles, {empty} without a pixel in their window, {pixels} pixels");
    assert!(empty < all * 7 / 8 && pixels > 10 * all, "{empty} empty, {pixels} pixels");
}

#[test]
fn random_triangles_have_exactly_their_pixels() {
    let seed = 42;
    let mut rng = Rng::new(seed);
    let mut pixels = 0;
    let clip = PixelRect { x: -5..59, y: -5..43 };
    for case in 0..scaled(20_000) {
        let v = triangle(&mut rng, case);
        let tri = exact::widen(v.map(|v| [v.x, v.y]));
        let rows = clip.y.clone().map(|y| {
            let bit = |(k, x): (usize, i32)| u64::from(exact::covers(tri, x.into(), y.into())) << k;
            clip.x.clone().enumerate().map(bit).fold(0, |all, bit| all | bit)
        });
        let expected: Rows = rows.collect();
        for (name, walk) in WALKS {
            assert_eq!(found(walk, &v, &clip), expected, "{name}, seed {seed}, case {case}: {v:?}");
        }
        pixels += expected.iter().map(|row| row.count_ones()).sum::<u32>();
    }
    assert!(pixels > 10 * scaled(20_000), "{pixels} pixels");
}

/// Strips of any height, one below the other, have the rows of one that is as tall as all of them.
#[test]
fn strips_of_every_height_have_the_pixels_of_one() {
    let seed = 43;
    let mut rng = Rng::new(seed);
    for case in 0..scaled(4000).max(200) {
        let v = triangle(&mut rng, case);
        let whole = found(WALKS[0].1, &v, &PixelRect { x: 0..64, y: 0..48 });
        for (height, (name, walk)) in (1..=48).flat_map(|height| WALKS.map(|walk| (height, walk))) {
            let strips =
                (0..48).step_by(height as usize).map(|top| PixelRect { x: 0..64, y: top..48.min(top + height) });
            let rows: Rows = strips.flat_map(|strip| found(walk, &v, &strip)).collect();
            assert_eq!(rows, whole, "{name}, strips of {height} rows, seed {seed}, case {case}: {v:?}");
        }
    }
}

/// Each sample is covered where the scanline traversal finds the pixel in the triangle that is moved for it.
#[test]
fn covered_samples_are_those_of_moved_triangles() {
    let seed = 44;
    let mut rng = Rng::new(seed);
    let (mut partly, mut whole) = (0, 0);
    let all = scaled(200_000);
    for case in 0..all {
        let v = triangle(&mut rng, case);
        // Moved corners have to stay in range.
        let v = v.map(|v| ScreenVertex::new(v.x.clamp(128 - FAR, FAR - 128), v.y.clamp(128 - FAR, FAR - 128), 0));
        let samples = [1, 2, 4, 8][case as usize % 4];
        let clip =
            PixelRect { x: rng.between(-2, 20)..rng.between(21, 60), y: rng.between(-2, 20)..rng.between(21, 48) };
        let (width, area) = (clip.x.len(), signed_area(&v[0], &v[1], &v[2]));
        let place = |x: i32, y: i32| (y - clip.y.start) as usize * width + (x - clip.x.start) as usize;
        let mut expected = vec![0_u8; width * clip.y.len()];
        for (sample, (right, down)) in moves(samples).iter().enumerate() {
            let moved = v.map(|v| ScreenVertex::new(v.x + right, v.y + down, 0));
            spans(&moved, area, &clip, |y, columns| columns.for_each(|x| expected[place(x, y)] |= 1 << sample));
        }
        let mut masks = vec![0_u8; expected.len()];
        covered_samples(&v, area, samples, &clip, |x, y, covered| {
            assert!(covered != 0 && clip.x.contains(&x) && clip.y.contains(&y) && masks[place(x, y)] == 0);
            masks[place(x, y)] = covered;
        });
        assert_eq!(masks, expected, "{samples} samples, seed {seed}, case {case}: {v:?} in {clip:?}");
        let full = ((1_u32 << samples) - 1) as u8;
        whole += masks.iter().filter(|mask| **mask == full).count();
        partly += masks.iter().filter(|mask| **mask != 0 && **mask != full).count();
    }
    println!("seed {seed}: {all} triangles, {whole} pixels with all samples, {partly} with some");
    assert!(whole > all as usize && partly > all as usize / 2, "{whole}, {partly}");
}

#[test]
fn every_conformance_file_of_triangles_is_right() {
    let sample = || concat!(env!("CARGO_MANIFEST_DIR"), "/tests/conformance").into();
    let folder = std::env::var_os("CONFORMANCE_DIR").map_or_else(sample, PathBuf::from);
    for stem in ["tri_random", "tri_sliver", "tri_special", "tri_far", "tri_bulk_hash", "mesh_once", "msaa4"] {
        for how in WALKS {
            let case = format!("{stem}, {}", how.0);
            let outcome = check_file(&folder.join(format!("{stem}.csv")), &mut Traversed::new(how));
            let outcome = outcome.unwrap_or_else(|error| panic!("{case}: {error}"));
            assert!(outcome.is_right(), "{case}: {outcome:?}");
            println!("{case}: {outcome:?}");
        }
    }
}
