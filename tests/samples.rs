//! Several samples per pixel: each sample is a picture of its own, whose triangles are moved; and a pixel is the mean
//! of its samples, in any strips.

use crate::reference::rng::Rng;
use crate::scenes;
use crate::scenes::{Draw, dashboard, labels, light, textured, water, wires};
use crate::support::{difference, sampled_strips, whole};
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::embedded_graphics_core::primitives::Rectangle;
use zstrip::frame::{Renderer, RendererError};
use zstrip::light::Unlit;
use zstrip::math::{Angle16, Pixels, Projective, Scalar};
use zstrip::mesh::{LineTopology, Lines, Mesh, MeshData, Points, Positions, Vertices};
use zstrip::shader::{Blend, Flat, Gouraud, Opacity, Textured};
use zstrip::span::{DepthState, Fragment, Shader};
use zstrip::target::{DepthChoice, Strip, WithRecords, WithSamples};
use zstrip::texture::{Bilinear, Tile};
use zstrip::vertex::{Perspective, VertexRef, VertexShader};
use zstrip::{Cull, Scene, ScreenPoint, State, Thick, Thin};

const SCREEN: (u16, u16) = (160, 120);
pub const SIDE: u16 = 128;
pub const AMPLE: usize = 60_000;

/// Places of the samples, in 1/256 px from the pixel's corner: those of Direct3D's and Vulkan's specifications.
pub const TWO: [[i32; 2]; 2] = [[192, 192], [64, 64]];
pub const FOUR: [[i32; 2]; 4] = [[96, 32], [224, 96], [32, 160], [160, 224]];
pub const EIGHT: [[i32; 2]; 8] =
    [[144, 80], [112, 176], [208, 144], [80, 48], [48, 208], [16, 112], [176, 240], [240, 16]];

/// Corners of triangles on a screen of 128 × 128 px: x and y in 1/256 px, and a depth.
pub struct Triangles {
    corners: Vec<[i32; 3]>,
    colors: Vec<[u8; 3]>,
    uvs: Vec<[Scalar; 2]>,
}

impl Triangles {
    /// Random ones of up to `size` / 256 px.
    pub fn new(rng: &mut Rng, count: usize, size: i32) -> Self {
        let mut corners = vec![];
        for k in 0..count {
            let middle = [(); 2].map(|()| rng.between(-2000, 256 * i32::from(SIDE) + 2000));
            let (grid, z) = ([1, 16, 128, 256][k % 4], rng.between(0, 65_535));
            for _ in 0..3 {
                let [x, y] = middle.map(|c| (c + rng.between(-size / 2, size / 2)) / grid * grid);
                let steep = if k % 5 == 0 { 60_000 } else { 500 };
                corners.push([x, y, (z + rng.between(-steep, steep)).clamp(0, 65_535)]);
            }
        }
        let colors = corners.iter().map(|_| [0; 3].map(|_: u8| rng.between(1, 255) as u8)).collect();
        let uvs = corners.iter().map(|_| [0; 2].map(|_: i32| Scalar::from_bits(rng.between(0, 65_536)))).collect();
        Self { corners, colors, uvs }
    }

    /// Vertices that are projected to exactly these places, moved by some 1/256 px.
    pub fn moved(&self, [right, down]: [i32; 2]) -> Vec<[Scalar; 4]> {
        let on_screen = |[x, y, z]: &[i32; 3]| {
            [4 * (x + right) - 65_536, 65_536 - 4 * (y + down), *z, 65_536].map(Scalar::from_bits)
        };
        self.corners.iter().map(on_screen).collect()
    }

    /// Returns the vertices with `corners` as their places.
    pub fn vertices<'t>(&'t self, corners: &'t [[Scalar; 4]]) -> Vertices<'t> {
        Vertices { colors: Some(&self.colors), uvs: Some(&self.uvs), ..Vertices::new(Positions::Homogeneous(corners)) }
    }

    pub fn draw<F: zstrip::Framebuffer>(
        &self,
        scene: &mut Scene<'_, F>,
        corners: &[[Scalar; 4]],
        depth: DepthState,
        shader: &impl Shader<F::Format>,
    ) {
        let data = MeshData {
            colors: Some(&self.colors),
            uvs: Some(&self.uvs),
            ..MeshData::new(Positions::Homogeneous(corners))
        };
        let state = State { cull: Cull::None, depth, ..State::DEFAULT };
        scene.draw_with(state, &Mesh::new(data).expect("a mesh"), &Projective::IDENTITY, shader);
    }
}

/// Compares the samples of random triangles with pictures of moved ones.
fn assert_samples_are_pictures<const N: usize>(places: [[i32; 2]; N])
where
    WithSamples<N>: DepthChoice,
{
    let seed = 7 + N as u64;
    let mut rng = Rng::new(seed);
    let shader = Flat::vertex_colors();
    let side = usize::from(SIDE);
    let mut partly = 0;
    for size in [300, 900, 3000, 6300, 14_000, 40_000] {
        let triangles = Triangles::new(&mut rng, 80, size);
        for depth in [DepthState::LESS, DepthState::LESS_EQUAL, DepthState::OFF] {
            let corners = triangles.moved([0, 0]);
            let (means, samples, depths, _) =
                sampled_strips::<Rgb565, N>((SIDE, SIDE), side, AMPLE, Rgb565::BLACK, |s| {
                    triangles.draw(s, &corners, depth, &shader);
                });
            let mut sums = vec![[0_u32; 3]; means.len()];
            for (sample, [x, y]) in places.into_iter().enumerate() {
                let case = format!("seed {seed}, {size}/256 px, {depth:?}, sample {sample} of {N}");
                let moved = triangles.moved([128 - x, 128 - y]);
                let (colors, expected, _) = whole::<Rgb565>((SIDE, SIDE), Rgb565::BLACK, |s| {
                    triangles.draw(s, &moved, depth, &shader);
                });
                let all = side * side;
                if sample > 0 {
                    let found = difference(&samples[(sample - 1) * all..sample * all], &colors, SIDE);
                    assert_eq!(found, None, "{case}");
                }
                assert_eq!(difference(&depths[sample * all..(sample + 1) * all], &expected, SIDE), None, "{case}");
                for (sum, color) in sums.iter_mut().zip(&colors) {
                    let levels = [color >> 11, color >> 5 & 63, color & 31];
                    (0..3).for_each(|k| sum[k] += u32::from(levels[k]));
                }
                partly += usize::from(sample > 0) * colors.iter().zip(&means).filter(|(a, b)| a != b).count();
            }
            let n = N as u32;
            let levels = sums.iter().map(|sum| sum.map(|c| ((c + n / 2) / n) as u16));
            let expected: Vec<_> = levels.map(|[r, g, b]| r << 11 | g << 5 | b).collect();
            assert_eq!(difference(&means, &expected, SIDE), None, "seed {seed}, {size}/256 px, {depth:?}, means");
        }
    }
    assert!(partly > 10_000, "only {partly} samples differ from their pixel");
}

#[test]
fn two_samples_are_pictures_of_moved_triangles() {
    assert_samples_are_pictures(TWO);
}

#[test]
fn four_samples_are_pictures_of_moved_triangles() {
    assert_samples_are_pictures(FOUR);
}

#[test]
fn eight_samples_are_pictures_of_moved_triangles() {
    assert_samples_are_pictures(EIGHT);
}

type Sampled<'p, const N: usize> = Strip<'p, Rgb565, WithSamples<N>, WithRecords>;

/// Compares a scene in one strip with the scene in others. Returns its pixels.
fn assert_strips_do_not_matter<const N: usize>(name: &str, drawing: &dyn for<'p> Draw<Sampled<'p, N>>) -> Vec<u16>
where
    WithSamples<N>: DepthChoice,
{
    let draw = |rows, records| {
        sampled_strips::<Rgb565, N>(SCREEN, rows, records, scenes::BACKGROUND, |scene| drawing.draw(scene)).0
    };
    let expected = draw(SCREEN.1.into(), AMPLE);
    for (rows, records) in [(1, AMPLE), (7, AMPLE), (16, 700), (30, 0)] {
        let found = difference(&draw(rows, records), &expected, SCREEN.0);
        assert_eq!(found, None, "{name}, {N} samples, strips of {rows} rows, {records} words of records");
    }
    expected
}

#[test]
fn strips_and_records_do_not_matter() {
    let (screen, turn) = (Size::new(SCREEN.0.into(), SCREEN.1.into()), Angle16(7777));
    assert_strips_do_not_matter::<4>("torus_flat", &scenes::Torus::flat(screen, turn));
    assert_strips_do_not_matter::<2>("torus_gouraud", &scenes::Torus::gouraud(screen, turn));
    assert_strips_do_not_matter::<4>("torus_gouraud", &scenes::Torus::gouraud(screen, turn));
    assert_strips_do_not_matter::<8>("torus_gouraud", &scenes::Torus::gouraud(screen, turn));
    assert_strips_do_not_matter::<4>("room", &scenes::Room::new(screen, turn));
    assert_strips_do_not_matter::<4>("wires", &wires::Wires::new(screen, turn));
    let crates = textured::Crates::new(screen, turn, Bilinear, textured::Levels::All);
    assert_strips_do_not_matter::<4>("crates", &crates);
    assert_strips_do_not_matter::<4>("water", &water::Sea::new(screen, turn, 1));
    assert_strips_do_not_matter::<2>("dashboard", &dashboard::Dashboard::new(turn));
    assert_strips_do_not_matter::<4>("labels", &labels::Labels::new(screen, turn));
    assert_strips_do_not_matter::<4>("fog", &light::Fog::new(screen, turn, light::Mist::Squared));
    assert_strips_do_not_matter::<4>("glass", &light::Glass::new(screen, turn));
}

/// Without an edge, there is nothing to be smooth: a rectangle of whole pixels, text, lines and points.
#[test]
fn what_covers_whole_pixels_looks_as_with_one_sample() {
    fn draw<F: zstrip::Framebuffer<Format = Rgb565>>(scene: &mut Scene<'_, F>) {
        let at = |x: i32, y: i32| [2 * x - 65_536, 2 * y - 65_536, 100, 65_536].map(Scalar::from_bits);
        let ends = [at(3000, 9000), at(50_000, 44_000), at(20_000, 61_000)];
        let vertices = Vertices::new(Positions::Homogeneous(&ends));
        let lines = Lines::new(vertices, LineTopology::Strip, None).expect("lines");
        scene.draw_lines(&lines, &Projective::IDENTITY, &Flat::unlit(Rgb888::YELLOW), &Thin);
        let points = Points::new(vertices).expect("points");
        scene.draw_points(&points, &Projective::IDENTITY, &Flat::unlit(Rgb888::GREEN), Pixels::from_num(5));
        let mut canvas = scene.canvas();
        canvas.rectangle(&Rectangle::new(Point::new(20, 20), Size::new(30, 9)), Rgb888::CYAN);
        canvas.line(ScreenPoint::corner(5, 100), ScreenPoint::corner(90, 110), Rgb888::WHITE);
        use zstrip::embedded_graphics_core::Pixel;
        use zstrip::embedded_graphics_core::draw_target::DrawTarget;
        let mut overlay = scene.at_depth(50);
        let area = Rectangle::new(Point::new(30, 70), Size::new(40, 20));
        overlay.fill_solid(&area, Rgb565::BLUE).expect("cannot fail");
        let dots = (0..60).map(|k| Pixel(Point::new(k * 2, k), Rgb565::MAGENTA));
        overlay.draw_iter(dots).expect("cannot fail");
        let colors = (0..400).map(|k| Rgb565::new(k as u8 & 31, 20, 7));
        overlay.fill_contiguous(&Rectangle::new(Point::new(118, 90), Size::new(20, 20)), colors).expect("cannot fail");
    }
    let (expected, _, _) = whole::<Rgb565>((SIDE, SIDE), Rgb565::BLACK, |scene| {
        draw(scene);
    });
    for rows in [128, 7] {
        let (picture, ..) = sampled_strips::<Rgb565, 4>((SIDE, SIDE), rows, AMPLE, Rgb565::BLACK, |scene| {
            draw(scene);
        });
        assert_eq!(difference(&picture, &expected, SIDE), None, "strips of {rows} rows");
    }
    assert!(expected.iter().filter(|color| **color != 0).count() > 1000);
}

/// Thick lines have edges, which become smooth.
#[test]
fn thick_lines_have_smooth_edges() {
    let (picture, ..) = sampled_strips::<Rgb565, 8>((SIDE, SIDE), 16, AMPLE, Rgb565::BLACK, |scene| {
        let (a, b) = (ScreenPoint::corner(5, 9), ScreenPoint::corner(110, 43));
        scene.canvas().line_with(a, b, Rgb888::WHITE, &Thick::px(4));
    });
    let between = picture.iter().filter(|color| **color != 0 && **color != 0xFFFF).count();
    assert!(between > 100, "{between} px are neither black nor white");
}

/// Nothing is drawn outside of a scissor, whose borders lie within strips.
#[test]
fn samples_stay_in_the_scissor() {
    let seed = 5;
    let area = Rectangle::new(Point::new(30, 40), Size::new(50, 30));
    for rows in [128, 7] {
        let (picture, ..) = sampled_strips::<Rgb565, 4>((SIDE, SIDE), rows, AMPLE, Rgb565::BLACK, |scene| {
            let mut rng = Rng::new(seed);
            let mut canvas = scene.canvas();
            canvas.set_scissor(Some(&area));
            for _ in 0..200 {
                let middle = [rng.between(35, 75), rng.between(30, 80)];
                let corners = [(); 3].map(|()| {
                    let [x, y] = middle.map(|c| (c + rng.between(-10, 10)) as i16);
                    (ScreenPoint::corner(x, y), Rgb888::WHITE)
                });
                canvas.gradient(&corners);
            }
        });
        for (k, color) in (0..).zip(&picture).filter(|(_, color)| **color != 0) {
            let place = Point::new(k % i32::from(SIDE), k / i32::from(SIDE));
            assert!(area.contains(place), "strips of {rows} rows, seed {seed}: {color:04x} at {place}");
        }
        let inside = picture.iter().filter(|color| **color != 0).count();
        assert!(inside > 1000, "{inside} px");
    }
}

/// No channel leaves the range of the corners' channels, however steep it is.
#[test]
fn steep_channels_stay_in_range() {
    static WHITE: Tile<'static, 1, 1> = Tile::new(&[[0xFFFF]]);
    let seed = 11;
    let mut rng = Rng::new(seed);
    let mut drawn = 0;
    for size in [60, 150, 300, 900, 3000] {
        let mut triangles = Triangles::new(&mut rng, 900, size);
        triangles.colors.iter_mut().flatten().for_each(|channel| *channel |= 128);
        let corners = triangles.moved([0, 0]);
        for kind in ["Gouraud", "lit"] {
            let (_, samples, ..) = sampled_strips::<Rgb565, 4>((SIDE, SIDE), 128, AMPLE, Rgb565::BLACK, |scene| {
                if kind == "Gouraud" {
                    triangles.draw(scene, &corners, DepthState::OFF, &Gouraud::vertex_colors());
                } else {
                    let shader = Textured::new(&WHITE).lit(Unlit::vertex_colors());
                    triangles.draw(scene, &corners, DepthState::OFF, &shader);
                }
            });
            for color in samples.iter().filter(|color| **color != 0) {
                let channels = [color >> 11, color >> 6 & 31, color & 31];
                let is_bright = channels.iter().all(|channel| *channel >= 15);
                assert!(is_bright, "{kind}, seed {seed}, {size}/256 px: {color:04x}");
                drawn += 1;
            }
        }
    }
    assert!(drawn > 20_000, "{drawn}");
}

/// Shading reads no texel outside of a triangle: each triangle shows its own column of a texture, to its edges.
#[test]
fn texels_come_from_inside_of_the_triangle() {
    static TILE: Tile<'static, 2, 1> = Tile::new(&[[0xF800, 0x07E0]]);
    let seed = 3;
    let mut rng = Rng::new(seed);
    for size in [700, 3000, 9000] {
        let mut triangles = Triangles::new(&mut rng, 60, size);
        for (k, uv) in triangles.uvs.iter_mut().enumerate() {
            // From the left end of the column to its right end, and no farther.
            let u = 32_768 * (k as i32 / 3 % 2) + [100, 32_600, 16_000][k % 3];
            *uv = [Scalar::from_bits(u), Scalar::ZERO];
        }
        let corners = triangles.moved([0, 0]);
        let mut shown = [0; 2];
        for (kind, shown) in shown.iter_mut().enumerate() {
            // The triangles of one column.
            let mut part = Triangles { corners: vec![], colors: vec![], uvs: vec![] };
            for (k, uv) in triangles.uvs.iter().enumerate().filter(|(k, _)| k / 3 % 2 == kind) {
                part.corners.push(triangles.corners[k]);
                part.colors.push(triangles.colors[k]);
                part.uvs.push(*uv);
            }
            let corners = part.moved([0, 0]);
            let (_, samples, ..) = sampled_strips::<Rgb565, 4>((SIDE, SIDE), 128, AMPLE, Rgb565::BLACK, |scene| {
                part.draw(scene, &corners, DepthState::OFF, &Textured::new(&TILE));
            });
            let [own, other] = if kind == 0 { [0xF800, 0x07E0] } else { [0x07E0, 0xF800] };
            let wrong = samples.iter().filter(|color| **color == other).count();
            assert_eq!(wrong, 0, "seed {seed}, {size}/256 px, column {kind}");
            *shown = samples.iter().filter(|color| **color == own).count();
        }
        assert!(corners.len() == 180 && shown.iter().all(|shown| *shown > 20), "{shown:?}");
    }
}

#[test]
fn short_buffers_are_errors_with_both_numbers() {
    let new = |depth: usize, samples: usize| {
        let (mut depth, mut samples) = (vec![0; depth], vec![0; samples]);
        Renderer::<Rgb565>::new(Size::new(100, 50))
            .and_then(|renderer| renderer.with_samples::<4>(&mut depth, &mut samples).map(|_| ()))
    };
    assert_eq!(new(400, 300), Ok(()));
    assert_eq!(new(399, 300), Err(RendererError::DepthTooShort { pixels: 399, needed: 400 }));
    assert_eq!(new(400, 299), Err(RendererError::SamplesTooShort { pixels: 299, needed: 300 }));
}

/// A shader of a program's own, fragment by fragment: four varyings, one of them perspective-correct.
struct Own;

impl VertexShader for Own {
    type Varyings = Perspective<1, 4>;

    const IS_TOLERANT: bool = true;

    fn vertex(&self, vertex: &VertexRef<'_>) -> Perspective<1, 4> {
        let [u, v] = vertex.uv().map(|c| c.to_bits());
        Perspective::new([u], [v, (u ^ v) & 0xFFFF])
    }
}

impl Shader<Rgb565> for Own {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, Perspective<1, 4>>) -> Option<u16> {
        let ([u], [v, w, ..]) = (fragment.varyings.corrected(), fragment.varyings.linear()) else { return None };
        Some((u as u16 >> 11) << 11 | (*v as u16 >> 10) << 5 | *w as u16 >> 11 | 1)
    }
}

/// A pixel whose samples are all covered is shaded at its centre. It looks as it does with one sample per pixel, up to
/// some levels of its channels: a word of packed channels is rounded where its span begins.
fn assert_inside_is_as_with_one_sample(name: &str, shader: &impl Shader<Rgb565>, levels: u16) {
    let seed = 17;
    let mut rng = Rng::new(seed);
    let all = usize::from(SIDE) * usize::from(SIDE);
    let mut inside = 0;
    for size in [1200, 4000, 6300, 12_000, 40_000] {
        for case in 0..80 {
            let triangles = Triangles::new(&mut rng, 1, size);
            // With samples beyond a side of the screen, a triangle is large that is small with one sample.
            let side = 256 * i32::from(SIDE);
            let ends = || triangles.corners.iter().map(|[x, ..]| *x);
            let (least, most) = (ends().min().unwrap_or_default(), ends().max().unwrap_or_default());
            if (-127..-15).contains(&least) || (side + 17..side + 129).contains(&most) {
                continue;
            }
            // Under a texture with light, so is a tall one.
            let heights = || triangles.corners.iter().map(|[_, y, _]| *y);
            let height = heights().max().unwrap_or_default() - heights().min().unwrap_or_default();
            if name == "lit" && (6401..=15_360).contains(&height) {
                continue;
            }
            let corners = triangles.moved([0, 0]);
            let (one, _, _) = whole::<Rgb565>((SIDE, SIDE), Rgb565::BLACK, |scene| {
                triangles.draw(scene, &corners, DepthState::LESS, shader);
            });
            let (four, _, depths, _) =
                sampled_strips::<Rgb565, 4>((SIDE, SIDE), SIDE.into(), AMPLE, Rgb565::BLACK, |s| {
                    triangles.draw(s, &corners, DepthState::LESS, shader);
                });
            for (k, (one, four)) in one.iter().zip(&four).enumerate() {
                if depths[k..].iter().step_by(all).all(|depth| *depth < 65_535) {
                    let levels_of = |color: u16| [color >> 11, color >> 5 & 63, color & 31];
                    let is_near = levels_of(*four).iter().zip(levels_of(*one)).all(|(a, b)| a.abs_diff(b) <= levels);
                    let case = format!("{name}, seed {seed}, {size}/256 px, triangle {case}, pixel {k}");
                    assert!(is_near, "{case}: {four:04x} is not {one:04x}");
                    inside += 1;
                }
            }
        }
    }
    assert!(inside > 40_000, "{name}: only {inside} px inside of triangles");
}

#[test]
fn pixels_inside_of_triangles_look_as_with_one_sample() {
    static TILE: Tile<'static, 4, 2> = Tile::new(&[[0xF800, 0x07E0, 0x1F, 0xFFFF], [0x1234, 0x4321, 0xABCD, 0x7FFF]]);
    assert_inside_is_as_with_one_sample("flat", &Flat::vertex_colors(), 0);
    assert_inside_is_as_with_one_sample("Gouraud", &Gouraud::vertex_colors(), 1);
    assert_inside_is_as_with_one_sample("textured", &Textured::new(&TILE), 0);
    assert_inside_is_as_with_one_sample("lit", &Textured::new(&TILE).lit(Unlit::vertex_colors()), 1);
    assert_inside_is_as_with_one_sample("bilinear", &Textured::new(&TILE).filter(Bilinear), 0);
    assert_inside_is_as_with_one_sample("own", &Own, 0);
    assert_inside_is_as_with_one_sample("blended", &Blend::new(Gouraud::vertex_colors(), Opacity(100)), 1);
}
