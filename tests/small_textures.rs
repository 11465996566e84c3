//! Small triangles with a texture, under light or not, against perspective-correct coordinates and light in double
//! precision; and the same pixels however they are drawn.

use crate::reference::rng::Rng;
use crate::support::accuracy;
use core::cell::Cell;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
use zstrip::frame::FramebufferRenderer;
use zstrip::light::Unlit;
use zstrip::math::{Projective, Scalar};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::prelude::*;
use zstrip::shader::{Blend, Gouraud, Replace, Textured};
use zstrip::span::{DepthState, Fragment, Shader, TriangleSetup};
use zstrip::target::Framebuffer;
use zstrip::texture::{Clamp, Image, Mirror, Rgb565Texel, Texture, Tile};
use zstrip::vertex::{Perspective, VertexShader, Wrapper};

/// Width and height of the screen.
const SIDE: usize = 128;
/// Sides of the texture.
const COLUMNS: usize = 128;
const ROWS: usize = 256;

/// Texels that are their own numbers; the background is none of them.
static NUMBERS: [[u16; COLUMNS]; ROWS] = {
    let mut texels = [[0; COLUMNS]; ROWS];
    let mut k = 0;
    while k < COLUMNS * ROWS {
        texels[k / COLUMNS][k % COLUMNS] = k as u16;
        k += 1;
    }
    texels
};
static TILE: Tile<'static, COLUMNS, ROWS> = Tile::new(&NUMBERS);
static WHITE: Tile<'static, 1, 1> = Tile::new(&[[0xFFFF]]);
const BACKGROUND: u16 = 0xFFFF;

/// A corner: its place on the screen in px, w, coordinates in 16.16 and its colour.
#[derive(Clone, Copy, Debug)]
struct Corner {
    at: [f64; 2],
    position: [Scalar; 4],
    w: f64,
    uv: [i32; 2],
    color: [u8; 3],
}

/// Returns a triangle of up to `size` / 256 px, exactly on the grid of 1/256 px, whose w differs by up to `spread`
/// percent.
fn triangle(rng: &mut Rng, size: i32, spread: i32, reach: i32) -> [Corner; 3] {
    let middle = [rng.between(0, 256 * SIDE as i32), rng.between(0, 256 * SIDE as i32)];
    let grid = [1, 1, 128, 256][rng.between(0, 3) as usize];
    let (w, origin) = (rng.between(400, 1000), [rng.between(-70_000, 70_000), rng.between(-70_000, 70_000)]);
    [(); 3].map(|()| {
        // 1 / 64 of the cube per pixel, 4 units of 16.16 per 1/256 px; w in quarters.
        let at = middle.map(|c| (c + rng.between(-size / 2, size / 2)) / grid * grid);
        let w = w + w * rng.between(0, spread) / 100;
        let [x, y] = [4 * at[0] - 65_536, 65_536 - 4 * at[1]];
        let position = [x / 4 * w, y / 4 * w, 0, w << 14].map(Scalar::from_bits);
        let uv = origin.map(|c| c + rng.between(-reach, reach));
        let color = [0; 3].map(|_: u8| rng.between(0, 255) as u8);
        Corner { at: at.map(|c| f64::from(c) / 256.0), position, w: f64::from(w) / 4.0, uv, color }
    })
}

/// Shares of three corners at a pixel's centre: on the screen, and in space.
fn shares(corners: &[Corner; 3], x: usize, y: usize) -> [[f64; 3]; 2] {
    let p = [x as f64 + 0.5, y as f64 + 0.5];
    let cross = |a: [f64; 2], b: [f64; 2]| (a[0] - p[0]) * (b[1] - p[1]) - (b[0] - p[0]) * (a[1] - p[1]);
    let on_screen = [0, 1, 2].map(|k| cross(corners[(k + 1) % 3].at, corners[(k + 2) % 3].at));
    let in_space = [0, 1, 2].map(|k| on_screen[k] / corners[k].w);
    [on_screen, in_space].map(|weights| weights.map(|weight| weight / weights.iter().sum::<f64>()))
}

/// A way to draw a frame.
#[derive(Clone, Copy, Debug)]
enum Way {
    /// In strips of some rows, with that many words of records.
    Strips { rows: usize, records: usize },
    /// Into a framebuffer whose rows do not lie one after the other.
    Rows { records: usize },
}

const WAYS: [Way; 5] = [
    Way::Strips { rows: SIDE, records: 500 },
    Way::Strips { rows: SIDE, records: 0 },
    Way::Strips { rows: 8, records: 500 },
    Way::Strips { rows: 8, records: 0 },
    Way::Rows { records: 500 },
];

/// Rows that are no slice of one another.
struct Apart(Vec<Vec<u16>>);

impl Framebuffer for Apart {
    type Format = Rgb565;

    fn row(&mut self, y: u32) -> &mut [u16] {
        &mut self.0[y as usize]
    }
}

fn picture(way: Way, corners: &[Corner; 3], shader: &impl Shader<Rgb565>) -> Vec<u16> {
    let (positions, uvs) = (corners.map(|c| c.position), corners.map(|c| c.uv.map(Scalar::from_bits)));
    let colors = corners.map(|c| c.color);
    let data = MeshData::new(Positions::Homogeneous(&positions));
    let mesh = Mesh::new(MeshData { uvs: Some(&uvs), colors: Some(&colors), ..data }).expect("a mesh");
    let state = State { cull: Cull::None, depth: DepthState::LESS, ..State::default() };
    let (size, white) = (Size::new(SIDE as u32, SIDE as u32), Rgb888::new(255, 255, 255));
    match way {
        Way::Strips { rows, records } => {
            let (mut strip, mut depth, mut words) = (vec![0; SIDE * rows], vec![0; SIDE * rows], vec![0; records]);
            let renderer = Renderer::<Rgb565>::new(size).expect("a size").with_depth(&mut depth).expect("depths");
            let mut renderer = renderer.with_records(&mut words);
            let (mut frame, mut pixels) = (renderer.begin(white), Vec::new());
            while let Some(strip) = frame
                .next_strip(&mut strip, |scene| scene.draw_with(state, &mesh, &Projective::IDENTITY, shader))
                .expect("the same scene each time")
            {
                pixels.extend_from_slice(strip.pixels());
            }
            pixels
        }
        Way::Rows { records } => {
            let mut rows = Apart(vec![vec![BACKGROUND; SIDE]; SIDE]);
            let (mut depth, mut words) = (vec![0; SIDE * SIDE], vec![0; records]);
            let renderer = FramebufferRenderer::new(size).expect("a size").with_depth(&mut depth).expect("depths");
            let draw = |scene: &mut zstrip::Scene<'_, _>| {
                scene.draw_with(state, &mesh, &Projective::IDENTITY, shader);
            };
            renderer.with_records(&mut words).frame_over(&mut rows, draw).expect("the same scene each time");
            rows.0.concat()
        }
    }
}

/// Returns the picture of a triangle, which is the same in all ways.
fn same_in_all_ways(case: &str, corners: &[Corner; 3], shader: &impl Shader<Rgb565>) -> Vec<u16> {
    let first = picture(WAYS[0], corners, shader);
    for way in &WAYS[1..] {
        assert!(picture(*way, corners, shader) == first, "{case}: {way:?} {corners:?}");
    }
    first
}

/// Sizes of triangles in 1/256 px, on both sides of the border between small and large ones.
const SIZES: [i32; 6] = [300, 900, 2500, 6300, 6700, 15_400];

/// Draws random triangles of these sizes by a shader of [`TILE`], and by the same with a shader around it. Returns by
/// how much the texels that are shown are off at most, in texels, and the number of pixels.
fn texels_off(seed: u64, sizes: &[i32], plain: &impl Shader<Rgb565>, blended: &impl Shader<Rgb565>) -> (f64, usize) {
    let mut rng = Rng::new(seed);
    let (mut worst, mut seen) = (0_f64, 0);
    for case in 0..3000 {
        let (size, spread) = (sizes[case % sizes.len()], [0, 2, 10, 60][case / 6 % 4]);
        // Up to 1/8, 1/2 or 3/2 of the texture.
        let corners = triangle(&mut rng, size, spread, [4096, 16_384, 49_152][case / 24 % 3]);
        let name = format!("seed {seed}, case {case}");
        let pixels = match case % 10 {
            0 => same_in_all_ways(&name, &corners, plain),
            5 => same_in_all_ways(&name, &corners, blended),
            1 | 2 => picture(WAYS[case / 10 % 2], &corners, blended),
            _ => picture(WAYS[case % 2], &corners, plain),
        };
        for (k, pixel) in pixels.into_iter().enumerate().filter(|(_, pixel)| *pixel != BACKGROUND) {
            let [_, shares] = shares(&corners, k % SIDE, k / SIDE);
            let texel = [usize::from(pixel) % COLUMNS, usize::from(pixel) / COLUMNS];
            for (axis, sides) in [COLUMNS as f64, ROWS as f64].into_iter().enumerate() {
                let exact: f64 = (0..3).map(|k| shares[k] * f64::from(corners[k].uv[axis])).sum::<f64>() / 65_536.0;
                // The distance of the exact place from the texel that is shown, in texels.
                let from_middle = (exact * sides - texel[axis] as f64 - 0.5).rem_euclid(sides);
                let off = from_middle.min(sides - from_middle) - 0.5;
                worst = worst.max(off);
                assert!(off < 1.0, "{name}: {off} texels at {k}, {corners:?}");
            }
            seen += 1;
        }
    }
    println!("seed {seed}: {seen} px");
    (worst, seen)
}

#[test]
fn texels_of_small_triangles_are_within_a_sixteenth() {
    let exact = Textured::new(&TILE).step::<1>();
    let (worst, seen) = texels_off(12, &SIZES, &exact, &Blend::new(exact, Replace));
    accuracy::check("coordinate in a texture of 128 × 256 texels, small triangles", worst);
    assert!(seen > 100_000, "{seen} px");
}

/// At the usual step, texels of a triangle that is drawn as small ones are may move further. Those of narrow ones that
/// are not are exact.
#[test]
fn texels_of_small_triangles_are_within_half_of_one_at_steps() {
    let usual = Textured::new(&TILE);
    let (worst, seen) = texels_off(17, &[300, 900, 1400, 1900], &usual, &Blend::new(usual, Replace));
    accuracy::check("the same at the usual step of 16", worst);
    assert!(seen > 5_000, "{seen} px");
    // A bound that is never come near to would say nothing.
    assert!(worst > 0.1, "{worst} texels");
}

#[test]
fn light_on_small_triangles_is_within_a_level_of_the_format() {
    let seed = 13;
    let mut rng = Rng::new(seed);
    let (mut worst, mut seen) = (0_f64, 0);
    for case in 0..1500 {
        let mut corners = triangle(&mut rng, SIZES[case % 6], 5, 100);
        if case % 3 == 0 {
            // Grey light takes a shorter way.
            for corner in &mut corners {
                corner.color = [corner.color[0]; 3];
            }
        }
        let name = format!("seed {seed}, case {case}");
        let shader = Textured::new(&WHITE).lit(Unlit::vertex_colors());
        let black = picture(WAYS[0], &corners, &Textured::new(&Tile::new(&[[0]])));
        let blended = Blend::new(shader, Replace);
        let pixels = match case % 10 {
            0 => same_in_all_ways(&name, &corners, &shader),
            5 => same_in_all_ways(&name, &corners, &blended),
            1 | 2 => picture(WAYS[case / 10 % 2], &corners, &blended),
            _ => picture(WAYS[case % 2], &corners, &shader),
        };
        for (k, pixel) in pixels.into_iter().enumerate().filter(|(k, _)| black[*k] == 0) {
            let [shares, _] = shares(&corners, k % SIDE, k / SIDE);
            let found = [f64::from(pixel >> 11), f64::from(pixel >> 5 & 63), f64::from(pixel & 31)];
            for (channel, step) in [8.0, 4.0, 8.0].into_iter().enumerate() {
                let exact: f64 = (0..3).map(|k| shares[k] * f64::from(corners[k].color[channel])).sum();
                // Surplus bits are cut, which takes up to one level.
                let over = found[channel] - exact / step;
                worst = worst.max(over).max(-over - 1.0);
                assert!((-2.0..1.0).contains(&over), "{name}: {over} levels at {k}, {corners:?}");
            }
            seen += 1;
        }
    }
    println!("seed {seed}: {seen} px");
    accuracy::check("light on a texture in RGB565, before bits are cut", worst);
    assert!(seen > 50_000, "{seen} px");
}

/// Light changes by whole ranges within a pixel there, and the first pixel of the bounding box is far away.
#[test]
fn light_on_slivers_is_that_of_their_corners_in_any_strips() {
    let seed = 15;
    let mut rng = Rng::new(seed);
    let shader = Textured::new(&WHITE).lit(Unlit::vertex_colors());
    let mut seen = 0;
    for case in 0..4000 {
        let name = format!("seed {seed}, case {case}");
        // From the top right to the bottom left, and two corners that are up to 1/8 px apart.
        let at = [rng.between(60, 100), rng.between(4, 90)].map(|c| c * 256 + rng.between(0, 255));
        let end = [at[0] - rng.between(256, 58 * 256), at[1] + rng.between(256, 24 * 256)];
        let other = end.map(|c| c + rng.between(-32, 32));
        let mut k = 0;
        let corners = [at, end, other].map(|at| {
            let color = [0; 3].map(|_: u8| [0, 255, rng.between(0, 255) as u8][(rng.between(0, 2) + k) as usize % 3]);
            k += 1;
            let position = [4 * at[0] - 65_536, 65_536 - 4 * at[1], 0, 1 << 16].map(Scalar::from_bits);
            Corner { at: at.map(|c| f64::from(c) / 256.0), position, w: 1.0, uv: [0; 2], color }
        });
        // The colours of a texture's light, or without a texture.
        let drawn = |way| match case / 2 % 2 {
            0 => picture(way, &corners, &shader),
            _ => picture(way, &corners, &Gouraud::vertex_colors()),
        };
        let first = drawn(WAYS[case % 2]);
        for way in [Way::Strips { rows: 8, records: 500 }, Way::Strips { rows: 5, records: 0 }] {
            assert!(drawn(way) == first, "{name}: {way:?} {corners:?}");
        }
        let black = picture(WAYS[0], &corners, &Textured::new(&Tile::new(&[[0]])));
        for (k, pixel) in first.into_iter().enumerate().filter(|(k, _)| black[*k] == 0) {
            let [shares, _] = shares(&corners, k % SIDE, k / SIDE);
            let found = [f64::from(pixel >> 11), f64::from(pixel >> 5 & 63), f64::from(pixel & 31)];
            for (channel, step) in [8.0, 4.0, 8.0].into_iter().enumerate() {
                let exact: f64 = (0..3).map(|k| shares[k] * f64::from(corners[k].color[channel])).sum();
                let over = found[channel] - exact / step;
                assert!((-1.25..0.25).contains(&over), "{name}: {over} levels at {k}, {corners:?}");
            }
            seen += 1;
        }
    }
    assert!(seen > 2000, "{seen} px");
}

/// A left edge along which u is 0 begins with the first column of the texture, not with the last one.
#[test]
fn edges_do_not_show_texels_of_the_other_side() {
    let seed = 16;
    let mut rng = Rng::new(seed);
    static HALVES: [[u16; 64]; 1] = {
        let mut texels = [[1; 64]; 1];
        let mut k = 32;
        while k < 64 {
            texels[0][k] = 2;
            k += 1;
        }
        texels
    };
    let tile = Tile::new(&HALVES);
    let (mut other, mut seen) = (0, 0);
    for case in 0..3000 {
        let corners = [0, 1, 2].map(|k: usize| {
            // Centres of pixels: many others lie on the edge.
            let at = [rng.between(1, 55), rng.between(1, 24)].map(|c| c * 256 + 128);
            let position = [4 * at[0] - 65_536, 65_536 - 4 * at[1], 0, 1 << 16].map(Scalar::from_bits);
            let uv = [if k == case % 3 { 26_000 } else { 0 }, 0];
            Corner { at: at.map(|c| f64::from(c) / 256.0), position, w: 1.0, uv, color: [0; 3] }
        });
        for pixel in picture(WAYS[case % 2], &corners, &Textured::new(&tile)) {
            (other, seen) = (other + u32::from(pixel == 2), seen + u32::from(pixel == 1));
        }
    }
    println!("seed {seed}: {other} of {seen} px");
    assert!(other == 0 && seen > 100_000, "{other} of {seen} px");
}

/// A canvas takes varyings from its caller.
#[test]
fn light_beyond_its_range_is_full_light_or_none_on_a_canvas() {
    let shader = Textured::new(&WHITE).lit(Unlit::vertex_colors());
    let size = Size::new(SIDE as u32, SIDE as u32);
    for (light, expected) in
        [(255 << 16, 0xFFFF), (256 << 16, 0xFFFF), (1 << 30, 0xFFFF), (0, 0), (-1, 0), (-1 << 30, 0)]
    {
        // A small triangle and a large one.
        for reach in [20, 100] {
            let mut pixels = vec![0; SIDE * SIDE];
            let mut renderer = Renderer::<Rgb565>::new(size).expect("a size");
            let mut frame = renderer.begin(Rgb888::new(0, 0, 255));
            let strip = frame.next_strip(&mut pixels, |scene| {
                let corners = [(0, 0), (0, reach), (reach, 0)].map(|(x, y)| zstrip::ScreenPoint::center(x, y));
                let varyings = Perspective::new([0; 2], [light; 3]);
                scene.canvas().polygon_with(&corners.map(|corner| (corner, varyings)), &shader, 0);
            });
            let strip = strip.expect("a strip").expect("a strip");
            assert_eq!(strip.pixels()[SIDE + 1], expected, "{light} on {reach} px");
        }
    }
}

/// Textures of other formats and other rules take the same way, and show the texel of the exact place, or its neighbour
/// if that is less than 1/16 texel away.
#[test]
fn other_textures_are_the_same_in_all_ways() {
    let bytes: Vec<u8> = (0..2 * 24 * 20).map(|k| (k * 37 % 251) as u8).collect();
    let image = Image::new(&bytes, Size::new(24, 20), Rgb565Texel).expect("an image");
    let seed = 14;
    let mut rng = Rng::new(seed);
    let mut seen = 0;
    for case in 0..360 {
        let corners = triangle(&mut rng, SIZES[case % 6], 5, 30_000);
        let name = format!("seed {seed}, case {case}");
        let clamped = same_in_all_ways(&name, &corners, &Textured::new(&image).wrap(Clamp).step::<1>());
        let mirrored = same_in_all_ways(&name, &corners, &Textured::new(&image).wrap(Mirror).step::<1>());
        same_in_all_ways(&name, &corners, &Textured::new(&image).wrap(Mirror).lit(Unlit::vertex_colors()));
        for (k, (clamped, mirrored)) in clamped.into_iter().zip(mirrored).enumerate() {
            if clamped == BACKGROUND {
                continue;
            }
            let [_, shares] = shares(&corners, k % SIDE, k / SIDE);
            let exact = |axis: usize, side: f64| {
                side * (0..3).map(|k| shares[k] * f64::from(corners[k].uv[axis])).sum::<f64>() / 65_536.0
            };
            let near = |axis, side| [-1.0, 1.0].map(|off| (exact(axis, side) + off / 16.0).floor() as i32);
            let (columns, rows) = (near(0, 24.0), near(1, 20.0));
            let is_near = |pixel: u16, texel: fn(i32, i32) -> i32| {
                let shows = |x: i32, y: i32| image.rgb565(texel(x, 24) as u32, texel(y, 20) as u32) == pixel;
                columns.iter().any(|x| rows.iter().any(|y| shows(*x, *y)))
            };
            assert!(is_near(clamped, |c, side| c.clamp(0, side - 1)), "{name}: clamped, {k}, {corners:?}");
            let folded = |c: i32, side: i32| c.rem_euclid(2 * side).min(2 * side - 1 - c.rem_euclid(2 * side));
            assert!(is_near(mirrored, folded), "{name}: mirrored, {k}, {corners:?}");
            seen += 1;
        }
    }
    println!("seed {seed}: {seen} px");
    assert!(seen > 10_000, "{seen} px");
}

/// Passes fragments on, and counts the triangles that are set up: small ones are not.
struct Around<'c, S>(S, &'c Cell<usize>);

impl<S: VertexShader> Wrapper for Around<'_, S> {
    type Inner = S;

    fn inner(&self) -> &S {
        &self.0
    }
}

impl<P: PixelFormat, S: Shader<P>> Shader<P> for Around<'_, S> {
    const STEP: usize = S::STEP;
    type Setup = S::Setup;

    fn setup(&self, triangle: &TriangleSetup<'_, S::Varyings>) -> S::Setup {
        self.1.set(self.1.get() + 1);
        self.0.setup(triangle)
    }

    fn fragment(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>) -> Option<P::Raw> {
        self.0.fragment(fragment)
    }
}

/// A shader around a texture, with light or without, has the short way too: most of its triangles are not set up. The
/// edges of the screen cut the others.
#[test]
fn shaders_around_textures_take_the_way_of_small_triangles() {
    let mut rng = Rng::new(18);
    let (plain, lit) = (Cell::new(0), Cell::new(0));
    let mut seen = 0;
    for _ in 0..200 {
        // Of the same depth at all corners.
        let corners = triangle(&mut rng, 2500, 0, 4096);
        let pixels = picture(WAYS[0], &corners, &Around(Textured::new(&TILE), &plain));
        picture(WAYS[0], &corners, &Around(Textured::new(&TILE).lit(Unlit::vertex_colors()), &lit));
        seen += pixels.iter().filter(|pixel| **pixel != BACKGROUND).count();
    }
    assert!(seen > 1000, "{seen} px");
    assert_eq!(lit.get(), plain.get(), "triangles were set up under light, and without");
    assert!(plain.get() < 50, "{} of 200 triangles were set up", plain.get());
}
