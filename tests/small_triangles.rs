//! Small triangles have a way of their own where they are drawn from records. Flat ones that are drawn without records
//! take the way of large ones: both give the same pixels and depths, on both sides of the border between small and
//! large. Gouraud's small triangles have one way only: their pictures are the same with and without records, in any
//! strips.

use crate::reference::rng::Rng;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
use zstrip::light::Unlit;
use zstrip::math::{Projective, Scalar};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::prelude::*;
use zstrip::shader::{Blend, Flat, Gouraud, Replace, Textured};
use zstrip::span::{Compare, DepthState, Shader};
use zstrip::texture::Tile;

const SIDE: usize = 128;

/// Colours and depths of a frame in strips of `rows`, with or without records.
fn picture(rows: usize, records: usize, mesh: &Mesh<'_>, depth: DepthState, gouraud: bool) -> (Vec<u16>, Vec<u16>) {
    if gouraud {
        draw(rows, records, mesh, depth, &Gouraud::vertex_colors())
    } else {
        draw(rows, records, mesh, depth, &Flat::vertex_colors())
    }
}

fn draw(
    rows: usize,
    records: usize,
    mesh: &Mesh<'_>,
    depth: DepthState,
    shader: &impl Shader<Rgb565>,
) -> (Vec<u16>, Vec<u16>) {
    let (mut colors, mut depths) = (Vec::new(), Vec::new());
    let mut strip = vec![0; SIDE * rows];
    let mut words = vec![0; records];
    let mut stored = vec![u16::MAX; SIDE * rows];
    for first in (0..SIDE).step_by(rows) {
        // Depths are read where the frame left them, strip by strip: a frame per strip, stopped there.
        let renderer = Renderer::<Rgb565>::new(Size::new(SIDE as u32, SIDE as u32)).expect("a size");
        let renderer = renderer.with_depth(&mut stored).expect("depths");
        let mut renderer = renderer.with_records(&mut words);
        let mut frame = renderer.begin(Rgb888::new(0, 0, 0));
        for _ in 0..=first / rows {
            let state = State { cull: Cull::None, depth, ..State::default() };
            let drawn = frame.next_strip(&mut strip, |scene| {
                scene.draw_with(state, mesh, &Projective::IDENTITY, shader);
            });
            assert!(drawn.expect("no error").is_some());
        }
        drop(frame);
        colors.extend_from_slice(&strip);
        depths.extend_from_slice(&stored);
    }
    (colors, depths)
}

/// Random triangles of up to `size` / 256 px in x and in y; whole, half and odd coordinates.
fn triangles(rng: &mut Rng, count: usize, size: i32) -> (Vec<[Scalar; 4]>, Vec<[u8; 3]>) {
    let (mut corners, mut colors) = (Vec::new(), Vec::new());
    for k in 0..count {
        let middle = [rng.between(0, 256 * SIDE as i32), rng.between(0, 256 * SIDE as i32)];
        let grid = [1, 128, 256][k % 3];
        let steep = k % 5 == 0;
        let z = rng.between(0, 65_535);
        for _ in 0..3 {
            let at = middle.map(|c| (c + rng.between(-size / 2, size / 2)) / grid * grid);
            // 1 / 64 of the cube per pixel, 4 units of 16.16 per 1 / 256 px.
            let [x, y] = at.map(|c| Scalar::from_bits(4 * c - 65_536));
            let depth = if steep { rng.between(0, 65_535) } else { (z + rng.between(-300, 300)).clamp(0, 65_535) };
            corners.push([x, y, Scalar::from_bits(2 * depth - 65_536), Scalar::ONE]);
            colors.push([0; 3].map(|_: u8| rng.between(0, 255) as u8));
        }
    }
    (corners, colors)
}

#[test]
fn both_ways_draw_the_same_pixels_and_depths() {
    let seed = 5;
    let mut rng = Rng::new(seed);
    let tests = [
        DepthState::LESS,
        DepthState { compare: Compare::GreaterEqual, write: true },
        DepthState { compare: Compare::LessEqual, write: false },
        DepthState::OFF,
    ];
    let mut drawn = 0;
    // Up to 60 px, or up to 25 px, a triangle is small.
    for (case, size) in [300, 700, 2000, 5500, 6300, 6500, 7000, 15_200, 15_500, 30_000].into_iter().enumerate() {
        let (corners, colors) = triangles(&mut rng, 60, size);
        let data = MeshData { colors: Some(&colors), ..MeshData::new(Positions::Homogeneous(&corners)) };
        let mesh = Mesh::new(data).expect("a mesh");
        for (k, depth) in tests.into_iter().enumerate() {
            for gouraud in [false, true] {
                let with_records = picture(SIDE, 20_000, &mesh, depth, gouraud);
                drawn += with_records.0.iter().filter(|color| **color != 0).count();
                for (rows, records) in [(SIDE, 0), (16, 20_000), (32, 0)] {
                    if rows == SIDE || case % 4 == k {
                        let other = picture(rows, records, &mesh, depth, gouraud);
                        assert!(
                            with_records == other,
                            "seed {seed}, {size}/256 px, {depth:?}, Gouraud {gouraud}, strips of {rows}, {records} words"
                        );
                    }
                }
            }
        }
    }
    assert!(drawn > 100_000, "{drawn} px");
}

/// Under a texture with light, and under shaders around it, tall triangles are small, too. They cover the pixels that
/// flat ones cover, at the same depths.
#[test]
fn tall_triangles_cover_the_same_pixels_at_the_same_depths() {
    static WHITE: Tile<'static, 1, 1> = Tile::new(&[[0xFFFF]]);
    let seed = 6;
    let mut rng = Rng::new(seed);
    let mut drawn = 0;
    for size in [6300, 6500, 9000, 12_000, 15_200, 15_500] {
        let (mut corners, mut colors) = triangles(&mut rng, 60, size);
        // Narrow ones, among others: both extents together are at most 85 px.
        for corner in corners.chunks_exact_mut(6).flat_map(|two| two.iter_mut().take(3)) {
            corner[0] = Scalar::from_bits(corner[0].to_bits() / 4);
        }
        colors.fill([255; 3]);
        let uvs = vec![[Scalar::ZERO; 2]; corners.len()];
        let data =
            MeshData { colors: Some(&colors), uvs: Some(&uvs), ..MeshData::new(Positions::Homogeneous(&corners)) };
        let mesh = Mesh::new(data).expect("a mesh");
        let flat = draw(SIDE, 20_000, &mesh, DepthState::LESS, &Flat::vertex_colors());
        let lit = Textured::new(&WHITE).lit(Unlit::vertex_colors());
        for (rows, records) in [(SIDE, 20_000), (SIDE, 0), (16, 20_000), (4, 20_000), (32, 0)] {
            let textured = draw(rows, records, &mesh, DepthState::LESS, &lit);
            assert!(flat == textured, "seed {seed}, {size}/256 px, strips of {rows}, {records} words");
            let wrapped = draw(rows, records, &mesh, DepthState::LESS, &Blend::new(lit, Replace));
            assert!(flat == wrapped, "wrapped, seed {seed}, {size}/256 px, strips of {rows}, {records} words");
        }
        drawn += flat.0.iter().filter(|color| **color != 0).count();
    }
    assert!(drawn > 10_000, "{drawn} px");
}
