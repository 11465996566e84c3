//! One triangle against the model in integers: which pixels it covers, and their depths.

use crate::Hash;
use crate::reference::exact;
use crate::source::{LIMIT, Source};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb888, RgbColor};
use zstrip::frame::FramebufferRenderer;
use zstrip::internals::{PixelRect, blocks, bounding_box, signed_area, spans};
use zstrip::math::{Projective, Scalar};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::shader::Flat;
use zstrip::span::{Compare, DepthState};
use zstrip::target::FrameSlice;
use zstrip::vertex::ScreenVertex;
use zstrip::{Cull, State};

type Triangle = [[i32; 2]; 3];

pub fn run(input: &[u8]) -> u64 {
    let mut source = Source::new(input);
    let mut hash = Hash::default();
    let drawn = source.flag();
    let mut triangle = [[0; 2]; 3];
    for k in 0..3 {
        let base = triangle[if k == 0 { 0 } else { k - 1 }];
        triangle[k] = [source.coordinate(base[0]), source.coordinate(base[1])];
    }
    if drawn {
        let z = match source.below(3) {
            0 => [source.u16(); 3],
            1 => core::array::from_fn(|_| source.pick(&[0, 1, 32_767, 32_768, 65_534, 65_535])),
            _ => core::array::from_fn(|_| source.u16()),
        };
        draw(triangle, z, &mut hash);
    } else {
        // A window at a corner, at the middle of a side, or anywhere.
        let (a, b) = (triangle[source.below(3)], triangle[source.below(3)]);
        let window = core::array::from_fn(|k| match source.below(4) {
            0 => a[k],
            1 => (a[k] + b[k]) / 2,
            2 => a[k] + ((i64::from(b[k]) - i64::from(a[k])) * i64::from(source.u16()) >> 16) as i32,
            _ => source.coordinate(a[k]),
        });
        rasterize(triangle, window, &mut hash);
    }
    hash.0
}

const WINDOW: i32 = 6;

/// The rasterizer's traversals alone, in a window of 6×6 pixels about a point.
fn rasterize(triangle: Triangle, window: [i32; 2], hash: &mut Hash) {
    let v = triangle.map(|[x, y]| ScreenVertex::new(x, y, 0));
    let [left, top] = window.map(|c| (c >> 8) - WINDOW / 2);
    let clip = PixelRect { x: left..left + WINDOW, y: top..top + WINDOW };
    let area = signed_area(&v[0], &v[1], &v[2]);
    let tri = exact::widen(triangle);
    assert_eq!(i128::from(area), exact::area2(tri), "the area of {triangle:?}");
    if area == 0 {
        return;
    }
    let mut rows = [0_u8; WINDOW as usize];
    spans(&v, area, &clip, |y, columns| {
        assert!(clip.y.contains(&y) && columns.start >= left && columns.end <= left + WINDOW && !columns.is_empty());
        for x in columns {
            let (row, bit) = (&mut rows[(y - top) as usize], 1 << (x - left));
            assert!(*row & bit == 0, "{triangle:?} covers pixel ({x}, {y}) twice");
            *row |= bit;
        }
    });
    let mut by_edge_functions = [0_u8; WINDOW as usize];
    bounding_box(&v, area, &clip, |y, columns| {
        columns.for_each(|x| by_edge_functions[(y - top) as usize] |= 1 << (x - left));
    });
    assert_eq!(by_edge_functions, rows, "{triangle:?}, pixels from {left}, {top}, over the bounding box");
    let mut by_blocks = [0_u8; WINDOW as usize];
    blocks(&v, area, &clip, |block| {
        for (y, bits) in (block.y..).zip(block.rows).filter(|(_, bits)| *bits != 0) {
            let bits = u32::from(bits) << 8 >> (8 + left - block.x);
            by_blocks[(y - top) as usize] |= bits as u8;
        }
    });
    assert_eq!(by_blocks, rows, "{triangle:?}, pixels from {left}, {top}, by blocks");
    for (y, row) in (top..).zip(rows) {
        let expected = (0..WINDOW)
            .map(|k| u8::from(exact::covers(tri, i64::from(left + k), y.into())) << k)
            .fold(0, |all, bit| all | bit);
        assert_eq!(row, expected, "row {y} of {triangle:?}, pixels from {left}, lowest bit first");
        hash.add(row.into());
    }
}

const SIDE: usize = 8;

/// The whole pipeline, on a screen of 8×8 pixels.
fn draw(triangle: Triangle, z: [u16; 3], hash: &mut Hash) {
    // x = (X / 128 / SIDE - 1) w, with y down; w is 1, so positions and depths come out as they are here.
    let clip = |c: i32| Scalar::from_bits(((i64::from(c) - 128 * SIDE as i64) * 65_536 / (128 * SIDE as i64)) as i32);
    let vertices: [[Scalar; 4]; 3] = core::array::from_fn(|k| {
        let [x, y] = triangle[k];
        let z = (i64::from(z[k]) * 65_536 + 32_767) / 65_535;
        [clip(x), -clip(y), Scalar::from_bits(z as i32), Scalar::ONE]
    });
    // The guard band cuts what is farther away, and cut corners are rounded.
    let inside = triangle.as_flattened().iter().all(|c| c.abs() < LIMIT - 256 * SIDE as i32);
    let mesh = Mesh::new(MeshData::new(Positions::Homogeneous(&vertices))).expect("a triangle");
    let (mut pixels, mut depths, mut records) = ([7; SIDE * SIDE], [7; SIDE * SIDE], [7; 40]);
    let screen = Size::new(SIDE as u32, SIDE as u32);
    let mut frame = FrameSlice::<Gray8>::new(&mut pixels, screen).expect("a framebuffer");
    let mut renderer = FramebufferRenderer::new(screen)
        .expect("a renderer")
        .with_depth(&mut depths)
        .expect("depths of the whole screen")
        .with_records(&mut records);
    let depth = DepthState { compare: Compare::Always, write: true };
    let (state, shader) = (State { cull: Cull::None, depth, ..State::DEFAULT }, Flat::unlit(Rgb888::WHITE));
    renderer
        .frame(&mut frame, Rgb888::BLACK, |scene| scene.draw_with(state, &mesh, &Projective::IDENTITY, &shader))
        .expect("the same scene");
    hash.bytes(&pixels);
    depths.iter().for_each(|z| hash.add((*z).into()));
    if !inside {
        return;
    }
    let tri = exact::widen(triangle);
    let (least, most) = (z[0].min(z[1]).min(z[2]), z[0].max(z[1]).max(z[2]));
    for (k, (color, depth)) in pixels.into_iter().zip(depths).enumerate() {
        let (x, y) = ((k % SIDE) as i64, (k / SIDE) as i64);
        let case = (triangle, z, x, y);
        let covered = exact::covers(tri, x, y);
        assert_eq!(color, if covered { 255 } else { 0 }, "the colour at {case:?}");
        if !covered {
            assert_eq!(depth, u16::MAX, "the depth at {case:?}");
            continue;
        }
        assert!((least..=most).contains(&depth), "depth {depth} at {case:?} is not between the corners'");
        let (n, d) = exact::depth_at(tri, z.map(i64::from), x, y);
        let error = i128::from(depth) * d - n;
        assert!(error.abs() <= d, "depth {depth} at {case:?}, exactly {n} / {d}");
    }
}
