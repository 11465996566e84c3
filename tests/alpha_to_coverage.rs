//! Alpha to coverage: a sample shows the fragments whose alpha reaches it, and no others, in any strips.
//!
//! The oracle draws all samples of a pixel alike, by a shader that discards those fragments which do not cover one
//! sample. That sample has to look as it does under alpha to coverage, in colour and in depth.

use crate::reference::rng::Rng;
use crate::samples::{AMPLE, EIGHT, FOUR, SIDE, TWO, Triangles};
use crate::support::{difference, sampled_strips, whole};
use zstrip::color::{PixelFormat, Rgba8888};
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::math::{Angle16, Pixels, Projective, Scalar};
use zstrip::mesh::{LineTopology, Lines, Points};
use zstrip::scene::ShapeBuffer;
use zstrip::shader::{AlphaTest, AlphaToCoverage, FogCurve, FogTable, Fogged, Textured};
use zstrip::shape::{Circle, Sprite};
use zstrip::span::{DepthState, Fragment, Shader, TriangleSetup};
use zstrip::target::{DepthChoice, WithSamples};
use zstrip::texture::{Bilinear, Tile, WithAlpha};
use zstrip::vertex::{Face, Perspective, VertexRef, VertexShader, Wrapper};
use zstrip::{Dashed, Framebuffer, Scene, ScreenPoint, Smooth, State, Stroke, Thick, Thin};

/// Returns a colour with alpha, if the format has it, or without.
fn pixel<P: PixelFormat>(word: u32, position: (i32, i32)) -> P::Raw {
    P::pack_rgba(word.to_le_bytes(), position)
}

/// One colour and one alpha per triangle; alphas of 0 and 255 are among them.
#[derive(Clone, Copy)]
struct PerFace;

impl VertexShader for PerFace {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }

    fn face(&self, face: &Face<'_>) -> u32 {
        let [r, g, b] = face.provoking().color();
        let k = face.index() as u32;
        let alpha = [0, 255, 128, (37 * k) & 255, (91 * k) & 255, (5 * k) & 255, 200, 60][k as usize % 8];
        u32::from_le_bytes([r, g, b, 0]) | alpha << 24
    }
}

impl<P: PixelFormat> Shader<P> for PerFace {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<P::Raw> {
        Some(pixel::<P>(fragment.flat, fragment.position))
    }
}

/// Colour and alpha between vertices: three varyings, the most that are kept in registers.
#[derive(Clone, Copy)]
struct PerVertex;

impl VertexShader for PerVertex {
    type Varyings = [i32; 3];

    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 3] {
        let [r, g, b] = vertex.color().map(|channel| i32::from(channel) << 16);
        [r, g, b]
    }
}

impl<P: PixelFormat> Shader<P> for PerVertex {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, [i32; 3]>) -> Option<P::Raw> {
        let [r, g, alpha] = fragment.varyings.map(|channel| (channel >> 16).clamp(0, 255) as u32);
        Some(pixel::<P>(r | g << 8 | 70 << 16 | alpha << 24, fragment.position))
    }
}

/// Four varyings, one of them perspective-correct; fragments that are discarded, and a set-up.
#[derive(Clone, Copy)]
struct Own;

impl VertexShader for Own {
    type Varyings = Perspective<1, 4>;

    const IS_TOLERANT: bool = true;

    fn vertex(&self, vertex: &VertexRef<'_>) -> Perspective<1, 4> {
        let [u, v] = vertex.uv().map(|c| c.to_bits());
        Perspective::new([u], [v, (u ^ v) & 0xFFFF])
    }
}

impl<P: PixelFormat> Shader<P> for Own {
    const STEP: usize = 8;
    type Setup = u8;

    fn setup(&self, triangle: &TriangleSetup<'_, Perspective<1, 4>>) -> u8 {
        triangle.corners.iter().map(|corner| corner.linear()[0] as u8).fold(0, u8::wrapping_add)
    }

    fn fragment(&self, fragment: &Fragment<'_, Perspective<1, 4>, u8>) -> Option<P::Raw> {
        let ([u], [v, w, ..]) = (fragment.varyings.corrected(), fragment.varyings.linear()) else { return None };
        let [u, v, w] = [u, *v, *w].map(|c| (c >> 8) as u32 & 255);
        (w & 15 != 3).then(|| pixel::<P>(v | w << 8 | u32::from(*fragment.setup) << 16 | u << 24, fragment.position))
    }
}

/// Discards the fragments that do not cover one sample of a pixel.
#[derive(Clone, Copy)]
struct OfSample<S> {
    shader: S,
    number: usize,
    count: usize,
}

impl<S: VertexShader> Wrapper for OfSample<S> {
    type Inner = S;

    fn inner(&self) -> &S {
        &self.shader
    }
}

impl<P: PixelFormat, S: Shader<Rgba8888>> Shader<P> for OfSample<S> {
    const STEP: usize = S::STEP;
    type Setup = S::Setup;

    fn setup(&self, triangle: &TriangleSetup<'_, S::Varyings>) -> S::Setup {
        self.shader.setup(triangle)
    }

    fn fragment(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>) -> Option<P::Raw> {
        let [r, g, b, alpha] = self.shader.fragment(fragment)?;
        // The first sample and the last one, then the others: those of four samples.
        let rank = if self.count == 4 { [0.0, 2.0, 3.0, 1.0][self.number] } else { self.number as f64 };
        let (x, y) = fragment.position;
        let step = match (x & 1, y & 1) {
            (0, 0) => 0.0,
            (1, 0) => 2.0,
            (0, 1) => 3.0,
            _ => 1.0,
        };
        let threshold = (rank + (step + 0.5) / 4.0) / self.count as f64;
        (f64::from(alpha) / 255.0 > threshold).then(|| P::pack_at([r, g, b], fragment.position))
    }
}

/// Compares the samples of random triangles with pictures of moved ones, whose pixels have one sample.
fn assert_samples_are_pictures<const N: usize>(places: [[i32; 2]; N])
where
    WithSamples<N>: DepthChoice,
{
    let seed = 70 + N as u64;
    let mut rng = Rng::new(seed);
    let (side, mut left_out) = (usize::from(SIDE), 0);
    for size in [300, 900, 3000, 6300, 14_000, 40_000] {
        let triangles = Triangles::new(&mut rng, 80, size);
        for depth in [DepthState::LESS, DepthState::LESS_EQUAL, DepthState::TEST, DepthState::OFF] {
            let corners = triangles.moved([0, 0]);
            let draw = |rows, records| {
                sampled_strips::<Rgb565, N>((SIDE, SIDE), rows, records, Rgb565::BLACK, |scene| {
                    triangles.draw(scene, &corners, depth, &AlphaToCoverage::new(PerFace));
                })
            };
            let (means, samples, depths, _) = draw(side, AMPLE);
            let case = format!("seed {seed}, {size}/256 px, {depth:?}");
            for (rows, records) in [(1, AMPLE), (7, 700), (30, 0)] {
                let found = difference(&draw(rows, records).0, &means, SIDE);
                assert_eq!(found, None, "{case}, strips of {rows} rows, {records} words");
            }
            let mut sums = vec![[0_u32; 3]; means.len()];
            for (number, [x, y]) in places.into_iter().enumerate() {
                let case = format!("{case}, sample {number} of {N}");
                let moved = triangles.moved([128 - x, 128 - y]);
                let (colors, expected, _) = whole::<Rgb565>((SIDE, SIDE), Rgb565::BLACK, |scene| {
                    triangles.draw(scene, &moved, depth, &OfSample { shader: PerFace, number, count: N });
                });
                let all = side * side;
                if number > 0 {
                    let found = difference(&samples[(number - 1) * all..number * all], &colors, SIDE);
                    assert_eq!(found, None, "{case}");
                }
                let found = &depths[number * all..(number + 1) * all];
                assert_eq!(difference(found, &expected, SIDE), None, "{case}, depths");
                let first = &depths[..all];
                left_out += found.iter().zip(first).filter(|(depth, first)| depth > first).count();
                for (sum, color) in sums.iter_mut().zip(&colors) {
                    let levels = [color >> 11, color >> 5 & 63, color & 31];
                    (0..3).for_each(|k| sum[k] += u32::from(levels[k]));
                }
            }
            let n = N as u32;
            let levels = sums.iter().map(|sum| sum.map(|c| ((c + n / 2) / n) as u16));
            let expected: Vec<_> = levels.map(|[r, g, b]| r << 11 | g << 5 | b).collect();
            assert_eq!(difference(&means, &expected, SIDE), None, "{case}, means");
        }
    }
    assert!(left_out > 2000, "only {left_out} samples are left out that the first one is not");
}

#[test]
fn two_samples_are_pictures_of_what_covers_them() {
    assert_samples_are_pictures(TWO);
}

#[test]
fn four_samples_are_pictures_of_what_covers_them() {
    assert_samples_are_pictures(FOUR);
}

#[test]
fn eight_samples_are_pictures_of_what_covers_them() {
    assert_samples_are_pictures(EIGHT);
}

/// Something that is drawn by a shader.
trait Thing {
    fn draw<F: Framebuffer<Format = Rgb565>, S: Shader<Rgb565>>(&self, scene: &mut Scene<'_, F>, shader: &S);
}

/// Triangles of all sizes, under a depth test.
struct OfTriangles(Triangles, DepthState);

impl Thing for OfTriangles {
    fn draw<F: Framebuffer<Format = Rgb565>, S: Shader<Rgb565>>(&self, scene: &mut Scene<'_, F>, shader: &S) {
        self.0.draw(scene, &self.0.moved([0, 0]), self.1, shader);
    }
}

/// Lines with a stroke, under a depth test.
struct OfLines<'t, K>(&'t Triangles, DepthState, K);

impl<K: Stroke> Thing for OfLines<'_, K> {
    fn draw<F: Framebuffer<Format = Rgb565>, S: Shader<Rgb565>>(&self, scene: &mut Scene<'_, F>, shader: &S) {
        let corners = self.0.moved([0, 0]);
        let vertices = self.0.vertices(&corners);
        let lines = Lines::new(vertices, LineTopology::Strip, None).expect("lines");
        let state = State { depth: self.1, ..State::DEFAULT };
        scene.draw_lines_with(state, &lines, &Projective::IDENTITY, shader, &self.2);
    }
}

/// Points of 5 px, under a depth test.
struct OfPoints<'t>(&'t Triangles, DepthState);

impl Thing for OfPoints<'_> {
    fn draw<F: Framebuffer<Format = Rgb565>, S: Shader<Rgb565>>(&self, scene: &mut Scene<'_, F>, shader: &S) {
        let corners = self.0.moved([0, 0]);
        let points = Points::new(self.0.vertices(&corners)).expect("points");
        let state = State { depth: self.1, ..State::DEFAULT };
        scene.draw_points_with(state, &points, &Projective::IDENTITY, shader, Pixels::from_num(5));
    }
}

/// A disc on the screen, whose rim covers pixels in part.
struct Disc(DepthState);

impl Thing for Disc {
    fn draw<F: Framebuffer<Format = Rgb565>, S: Shader<Rgb565>>(&self, scene: &mut Scene<'_, F>, shader: &S) {
        let mut words = vec![0; ShapeBuffer::words(SIDE, 64)];
        let mut buffer = ShapeBuffer::new(&mut words, SIDE).expect("enough words");
        let disc = Circle::new(ScreenPoint::corner(60, 64), Pixels::from_num(50));
        let mut canvas = scene.canvas_with(3000, self.0);
        canvas.fill_with(&disc, shader, 0x90A0_70FF, &mut buffer);
    }
}

/// Draws one sample after the other by shaders that discard fragments, and compares each with that sample under alpha
/// to coverage. Returns the number of pixels whose colour under alpha to coverage is another one than by such a shader,
/// summed up over the samples.
fn assert_samples_are_those_that_alpha_covers<const N: usize>(
    name: &str,
    thing: &impl Thing,
    shader: impl Shader<Rgba8888> + Copy,
) -> usize
where
    WithSamples<N>: DepthChoice,
{
    let (side, all) = (usize::from(SIDE), usize::from(SIDE) * usize::from(SIDE));
    let background = Rgb565::new(3, 9, 27);
    let covering = AlphaToCoverage::new(shader);
    let draw = |rows, records| {
        sampled_strips::<Rgb565, N>((SIDE, SIDE), rows, records, background, |s| thing.draw(s, &covering))
    };
    let (means, samples, depths, _) = draw(side, AMPLE);
    for (rows, records) in [(1, AMPLE), (7, 700), (30, 0)] {
        let found = difference(&draw(rows, records).0, &means, SIDE);
        assert_eq!(found, None, "{name}, {N} samples, strips of {rows} rows, {records} words");
    }
    let mut differ = 0;
    for number in 0..N {
        let shader = OfSample { shader, number, count: N };
        let (first, others, expected, _) =
            sampled_strips::<Rgb565, N>((SIDE, SIDE), side, AMPLE, background, |s| thing.draw(s, &shader));
        let case = format!("{name}, sample {number} of {N}");
        if number > 0 {
            let own = (number - 1) * all..number * all;
            assert_eq!(difference(&samples[own.clone()], &others[own], SIDE), None, "{case}");
        }
        let own = number * all..(number + 1) * all;
        assert_eq!(difference(&depths[own.clone()], &expected[own], SIDE), None, "{case}, depths");
        differ += first.iter().zip(&means).filter(|(a, b)| a != b).count();
    }
    differ
}

/// Compares these numbers of samples per pixel. Returns the number of pixels that some samples cover and others do not,
/// as [`assert_samples_are_those_that_alpha_covers`] counts them.
fn assert_samples(name: &str, samples: &[usize], thing: &impl Thing, shader: impl Shader<Rgba8888> + Copy) -> usize {
    let by_number = samples.iter().map(|samples| match samples {
        2 => assert_samples_are_those_that_alpha_covers::<2>(name, thing, shader),
        4 => assert_samples_are_those_that_alpha_covers::<4>(name, thing, shader),
        _ => assert_samples_are_those_that_alpha_covers::<8>(name, thing, shader),
    });
    by_number.sum()
}

/// 4 × 4 texels of all alphas of 4 bits.
fn leaf() -> WithAlpha<'static, Tile<'static, 4, 4>> {
    static TILE: Tile<'static, 4, 4> = Tile::new(&[
        [0xF800, 0x07E0, 0x001F, 0xFFFF],
        [0x1234, 0x4321, 0xABCD, 0x7FFF],
        [0xFFE0, 0x07FF, 0xF81F, 0x8410],
        [0x0842, 0xC618, 0x5555, 0xAAAA],
    ]);
    static ALPHAS: [u8; 8] = [0x07, 0xF8, 0x3C, 0x5A, 0xE1, 0x9D, 0x4B, 0x62];
    WithAlpha::new(TILE, &ALPHAS).expect("as many alphas")
}

static FOG: FogTable = match FogTable::perspective(
    Scalar::ONE,
    Scalar::from_bits(100 << 16),
    FogCurve::Linear { start: Scalar::ONE, end: Scalar::from_bits(90 << 16) },
) {
    Ok(table) => table,
    Err(_) => panic!("near and far"),
};

#[test]
fn triangles_of_all_sizes_cover_the_samples_of_their_alpha() {
    let seed = 21;
    let mut rng = Rng::new(seed);
    let image = leaf();
    let mut partly = [0; 5];
    // Small triangles and large ones for each number of samples: tests above draw all sizes with all numbers.
    for (size, samples, depth) in [
        (300, 4, DepthState::LESS),
        (1500, 8, DepthState::LESS),
        (3000, 2, DepthState::OFF),
        (6300, 4, DepthState::LESS_EQUAL),
        (14_000, 8, DepthState::LESS),
        (40_000, 2, DepthState::LESS),
        (40_000, 4, DepthState::TEST),
    ] {
        let things = OfTriangles(Triangles::new(&mut rng, 40, size), depth);
        let case = |name: &str| format!("{name}, seed {seed}, {size}/256 px, {depth:?}");
        let samples = &[samples];
        for (number, found) in [
            assert_samples(&case("per face"), samples, &things, PerFace),
            assert_samples(&case("per vertex"), samples, &things, PerVertex),
            assert_samples(&case("a texture"), samples, &things, Textured::new(&image)),
            assert_samples(&case("a bilinear texture"), samples, &things, Textured::new(&image).filter(Bilinear)),
            assert_samples(&case("a shader of a program's own"), samples, &things, Own),
        ]
        .into_iter()
        .enumerate()
        {
            partly[number] += found;
        }
    }
    assert!(partly.iter().all(|pixels| *pixels > 5_000), "pixels that are covered in part: {partly:?}");
}

#[test]
fn lines_points_and_shapes_cover_the_samples_of_their_alpha() {
    let seed = 22;
    let triangles = &Triangles::new(&mut Rng::new(seed), 30, 20_000);
    let dashed = Dashed(0x5B37_5B37);
    for (samples, depth) in
        [(&[2, 4, 8][..], DepthState::LESS), (&[4], DepthState::LESS_EQUAL), (&[8], DepthState::OFF)]
    {
        let case = |name: &str| format!("{name}, seed {seed}, {depth:?}");
        for partly in [
            assert_samples(&case("thin lines"), samples, &OfLines(triangles, depth, Thin), PerVertex),
            assert_samples(&case("dashed lines"), samples, &OfLines(triangles, depth, dashed), PerVertex),
            assert_samples(&case("thick lines"), samples, &OfLines(triangles, depth, Thick::px(4)), PerVertex),
            assert_samples(&case("smooth lines"), samples, &OfLines(triangles, depth, Smooth::px(3)), PerVertex),
            assert_samples(&case("thin lines of one's own"), samples, &OfLines(triangles, depth, Thin), Own),
            assert_samples(&case("points"), samples, &OfPoints(triangles, depth), PerVertex),
            assert_samples(&case("a disc"), samples, &Disc(depth), PerFace),
        ] {
            assert!(partly > 500, "{depth:?}: only {partly} pixels are covered in part");
        }
    }
}

/// A sprite fills itself, as a shape, in space and on the canvas.
struct OfSprite<'i>(Sprite<'i, WithAlpha<'static, Tile<'static, 4, 4>>, Bilinear>);

impl Thing for OfSprite<'_> {
    fn draw<F: Framebuffer<Format = Rgb565>, S: Shader<Rgb565>>(&self, scene: &mut Scene<'_, F>, shader: &S) {
        let mut words = vec![0; ShapeBuffer::words(SIDE, 64)];
        let mut buffer = ShapeBuffer::new(&mut words, SIDE).expect("enough words");
        scene.canvas().fill_with(&self.0, shader, 0, &mut buffer);
    }
}

#[test]
fn sprites_cover_the_samples_of_their_alpha() {
    let image = leaf();
    let sprite = Sprite::new(&image).filter(Bilinear).at(ScreenPoint::corner(64, 64)).scaled(Scalar::from_num(20));
    let sprite = sprite.turned(Angle16(4000));
    let partly = assert_samples("a sprite", &[2, 4, 8], &OfSprite(sprite), sprite);
    assert!(partly > 500, "only {partly} pixels are covered in part");
}

#[test]
fn one_sample_is_covered_from_one_half_on() {
    let seed = 23;
    let (mut rng, mut drawn) = (Rng::new(seed), 0);
    for size in [900, 6300, 40_000] {
        let triangles = Triangles::new(&mut rng, 80, size);
        let corners = triangles.moved([0, 0]);
        let found = whole::<Rgb565>((SIDE, SIDE), Rgb565::BLACK, |s| {
            triangles.draw(s, &corners, DepthState::LESS, &AlphaToCoverage::new(PerVertex));
        });
        let expected = whole::<Rgb565>((SIDE, SIDE), Rgb565::BLACK, |s| {
            triangles.draw(s, &corners, DepthState::LESS, &AlphaTest::new(PerVertex, 128));
        });
        assert!((&found.0, &found.1) == (&expected.0, &expected.1), "seed {seed}, {size}/256 px");
        let (samples, ..) = sampled_strips::<Rgb565, 1>((SIDE, SIDE), 16, AMPLE, Rgb565::BLACK, |s| {
            triangles.draw(s, &corners, DepthState::LESS, &AlphaToCoverage::new(PerVertex));
        });
        assert_eq!(difference(&samples, &expected.0, SIDE), None, "seed {seed}, {size}/256 px, one of one sample");
        drawn += expected.0.iter().filter(|color| **color != 0).count();
    }
    assert!(drawn > 5000, "only {drawn} px");
}

/// Fog inside of alpha to coverage fogs the colour, and leaves alpha as it is.
#[test]
fn fog_inside_keeps_alpha() {
    let seed = 24;
    let triangles = Triangles::new(&mut Rng::new(seed), 60, 3000);
    let things = OfTriangles(triangles, DepthState::LESS);
    let fogged = Fogged::new(PerVertex, &FOG, Rgb888::new(200, 10, 10));
    let partly = assert_samples(&format!("fog, seed {seed}"), &[2, 4, 8], &things, fogged);
    assert!(partly > 500, "only {partly} pixels are covered in part");
}

/// In the mean, a surface is as opaque as its alpha says.
#[test]
fn coverage_is_alpha_in_the_mean() {
    let mut words = vec![0; ShapeBuffer::words(SIDE, 64)];
    for alpha in (0..=255_u32).step_by(5) {
        let (picture, ..) = sampled_strips::<Rgb888, 4>((SIDE, SIDE), 16, AMPLE, Rgb888::BLACK, |scene| {
            let mut buffer = ShapeBuffer::new(&mut words, SIDE).expect("enough words");
            let square = Circle::new(ScreenPoint::corner(64, 64), Pixels::from_num(200));
            let shader = AlphaToCoverage::new(PerFace);
            scene.canvas().fill_with(&square, &shader, alpha << 24 | 0xFF_FFFF, &mut buffer);
        });
        let all = picture.len() as f64;
        let mean = picture.iter().map(|pixel| f64::from(pixel[0])).sum::<f64>() / all;
        // 16 steps for 256 alphas, and half a level of rounding.
        assert!((mean - f64::from(alpha)).abs() <= 8.5, "alpha {alpha}: {mean}");
    }
}
