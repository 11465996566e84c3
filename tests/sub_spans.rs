//! Textures in perspective: coordinates at each pixel and every 2 to 32 of them, against f64; and that a texel is where
//! it is however its triangle is cut.

use crate::reference::rng::Rng;
use crate::support;
use std::cell::RefCell;
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::frame::FramebufferRenderer;
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
use zstrip::shader::{Blend, Replace, Textured};
use zstrip::span::{Fragment, Shader};
use zstrip::texture::{Image, Rgb565Texel, Tile};
use zstrip::vertex::{DepthRange, Perspective, ScreenVertex, VertexRef, VertexShader, Viewport};
use zstrip::{Cull, Framebuffer, State};

/// Its half is odd, so that a viewport of half the width begins between two multiples of a step.
const WIDTH: usize = 300;
const HEIGHT: usize = 240;
const SCREEN: Size = Size::new(WIDTH as u32, HEIGHT as u32);

/// A rectangle from -1 to 1 in x and y, with one texture over it.
const POINTS: [Vec3; 4] = [
    Vec3::from_milli(-1000, 1000, 0),
    Vec3::from_milli(-1000, -1000, 0),
    Vec3::from_milli(1000, -1000, 0),
    Vec3::from_milli(1000, 1000, 0),
];
const ONE: Scalar = Scalar::ONE;
const UVS: [[Scalar; 2]; 4] = [[Scalar::ZERO; 2], [Scalar::ZERO, ONE], [ONE; 2], [ONE, Scalar::ZERO]];
static WALL: Mesh<'static> =
    Mesh::constant(MeshData { topology: Topology::Quads, uvs: Some(&UVS), ..MeshData::new(Positions::Exact(&POINTS)) });

/// Texels in a texture's side.
const TEXELS: f64 = 256.0;

const BOTH_SIDES: State = State { cull: Cull::None, ..State::DEFAULT };

/// Where coordinates in 16.16 are written, by pixel.
type Coordinates = Vec<Option<[i32; 2]>>;

/// Reports coordinates that are divided every `STEP` columns.
struct Report<'a, const STEP: usize>(RefCell<&'a mut Coordinates>);

impl<const STEP: usize> VertexShader for Report<'_, STEP> {
    type Varyings = Perspective<2, 3>;

    fn vertex(&self, corner: &VertexRef<'_>) -> Perspective<2, 3> {
        Perspective::new(corner.uv().map(Scalar::to_bits), [])
    }
}

impl<const STEP: usize> Shader<Rgb565> for Report<'_, STEP> {
    type Setup = ();

    const STEP: usize = STEP;

    fn fragment(&self, fragment: &Fragment<'_, Perspective<2, 3>>) -> Option<u16> {
        let (x, y) = fragment.position;
        self.0.borrow_mut()[y as usize * WIDTH + x as usize] = Some(fragment.varyings.corrected());
        None
    }
}

/// Rows that may be shorter than the screen's.
struct Rows {
    pixels: Vec<u16>,
    width: usize,
}

impl Framebuffer for Rows {
    type Format = Rgb565;

    fn row(&mut self, y: u32) -> &mut [u16] {
        self.pixels.chunks_mut(self.width).nth(y as usize).unwrap_or_default()
    }
}

/// The part of the frame that is drawn, and how.
#[derive(Clone, Copy)]
struct Cut {
    viewport: Viewport,
    /// Length of the framebuffer's rows.
    width: usize,
    strip: usize,
    records: usize,
}

fn whole() -> Cut {
    let viewport = Viewport::new(Point::zero(), SCREEN).expect("a viewport");
    Cut { viewport, width: WIDTH, strip: HEIGHT, records: 2000 }
}

/// Draws the wall, and returns the pixels.
fn drawn(mvp: &Projective, cut: Cut, shader: &impl Shader<Rgb565>) -> Vec<u16> {
    drawn_mesh(&WALL, mvp, cut, shader)
}

fn drawn_mesh(mesh: &Mesh<'_>, mvp: &Projective, cut: Cut, shader: &impl Shader<Rgb565>) -> Vec<u16> {
    let mut rows = Rows { pixels: vec![0; cut.width * HEIGHT], width: cut.width };
    let (mut depth, mut records) = (vec![0; WIDTH * cut.strip], vec![0; cut.records]);
    let renderer = FramebufferRenderer::new(SCREEN).expect("a renderer").with_depth(&mut depth).expect("a renderer");
    let draw = |scene: &mut zstrip::Scene<'_, _>| {
        scene.set_viewport(cut.viewport);
        scene.draw_with(BOTH_SIDES, mesh, mvp, shader);
    };
    renderer.with_records(&mut records).frame_over(&mut rows, draw).expect("the same scene each time");
    rows.pixels
}

/// Draws the wall, and returns the coordinates at each pixel.
fn coordinates<const STEP: usize>(mvp: &Projective, cut: Cut) -> Coordinates {
    let mut found = vec![None; WIDTH * HEIGHT];
    drawn(mvp, cut, &Report::<STEP>(RefCell::new(&mut found)));
    found
}

/// Half the width that the camera sees at distance 1, and half the height.
const LENS: [f64; 2] = [0.725, 0.58];

/// The matrix of a camera whose picture is `zoom` times as wide.
fn camera(zoom: f64, near: f64) -> Projective {
    let far = 100.0;
    let entry = |value: f64| (value * 2_f64.powi(32)) as i64;
    let mut rows = [[0; 4]; 4];
    (rows[0][0], rows[1][1]) = (entry(zoom / LENS[0]), entry(1.0 / LENS[1]));
    (rows[2][2], rows[2][3], rows[3][2]) = (entry(-far / (far - near)), entry(-far * near / (far - near)), entry(-1.0));
    Projective::from_rows(rows)
}

/// Places the wall, turned away by an angle, with its middle at x and at a distance.
fn placed(degrees: i32, [x, distance]: [f64; 2]) -> Affine {
    let place = Vec3::from_bits([x, 0.0, -distance].map(|c| (c * 65_536.0) as i32));
    Affine::translation(place) * Affine::rotation_y(Angle16::from_degrees(degrees))
}

/// The exact coordinates at a pixel's centre, in texels, from the corners on the screen as the rasterizer gets them.
fn exact(mvp: &Projective) -> impl Fn(usize, usize) -> [f64; 2] {
    let matrix = support::matrix(mvp);
    let corner = |k: usize| [UVS[k][0].to_bits(), UVS[k][1].to_bits(), k as i32];
    let triangles = support::snapped(&WALL, mvp, &whole().viewport, DepthRange::Clip, corner);
    let triangles: Vec<_> = triangles
        .into_iter()
        .map(|(corners, _)| {
            corners.map(|(v, [u, t, k]): (ScreenVertex, [i32; 3])| {
                let position = support::position(&WALL.data().positions, k as usize);
                let w = support::apply(&matrix, position)[3];
                (
                    [f64::from(v.x) / 256.0, f64::from(v.y) / 256.0],
                    1.0 / w,
                    [u, t].map(|c| f64::from(c) / 65_536.0 * TEXELS),
                )
            })
        })
        .collect();
    move |x, y| {
        let p = [x as f64 + 0.5, y as f64 + 0.5];
        let cross =
            |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let weights =
            |[a, b, c]: [[f64; 2]; 3]| [cross(b, c, p), cross(c, a, p), cross(a, b, p)].map(|w| w / cross(a, b, c));
        let inside = |t: &&[([f64; 2], f64, [f64; 2]); 3]| weights(t.map(|v| v.0)).into_iter().fold(1.0, f64::min);
        let triangle = triangles.iter().max_by(|a, b| inside(a).total_cmp(&inside(b))).expect("triangles");
        let b = weights(triangle.map(|v| v.0));
        let q: f64 = (0..3).map(|k| b[k] * triangle[k].1).sum();
        [0, 1].map(|c| (0..3).map(|k| b[k] * triangle[k].1 * triangle[k].2[c]).sum::<f64>() / q)
    }
}

/// Places of a wall so that it is before the viewer as a whole.
fn places(rng: &mut Rng, count: usize) -> Vec<[f64; 2]> {
    (0..count).map(|_| [rng.unit() * 0.6 - 0.8, 1.3 + rng.unit() * 1.2]).collect()
}

/// The worst errors in texels over the pixels of walls, for steps of 1, 4, 8, 16 and 32.
fn worst(degrees: i32, places: &[[f64; 2]]) -> [f64; 5] {
    let mut worst = [0_f64; 5];
    for place in places {
        let mvp = camera(1.0, 0.05) * placed(degrees, *place);
        let found = [
            coordinates::<1>(&mvp, whole()),
            coordinates::<4>(&mvp, whole()),
            coordinates::<8>(&mvp, whole()),
            coordinates::<16>(&mvp, whole()),
            coordinates::<32>(&mvp, whole()),
        ];
        let (exact, mut seen) = (exact(&mvp), 0);
        for k in (0..WIDTH * HEIGHT).filter(|k| found[0][*k].is_some()) {
            seen += 1;
            let exact = exact(k % WIDTH, k / WIDTH);
            for (worst, found) in worst.iter_mut().zip(&found) {
                let found = found[k].expect("the same pixels for all steps");
                for (found, exact) in found.iter().zip(exact) {
                    *worst = worst.max((f64::from(*found) / 65_536.0 * TEXELS - exact).abs());
                }
            }
        }
        assert!(seen > 100, "{degrees}°, {place:?}: {seen} pixels");
    }
    worst
}

/// Bounds in texels that the documentation of `Perspective` states, by angle, for steps of 1, 4, 8, 16 and 32.
const STATED: [(i32, [f64; 5]); 4] = [
    (0, [0.01, 0.02, 0.03, 0.05, 0.1]),
    (60, [0.02, 0.2, 0.7, 1.2, 1.2]),
    (75, [0.02, 0.6, 1.3, 1.3, 1.3]),
    (85, [0.02, 1.2, 1.2, 1.2, 1.2]),
];

#[test]
fn texels_are_as_far_off_as_stated_for_each_step_and_angle() {
    let mut rng = Rng::new(8);
    let places = places(&mut rng, 12);
    for (degrees, stated) in STATED {
        let found = worst(degrees, &places);
        println!("{degrees}°: {}", found.map(|texels| format!("{texels:.3}")).join(" | "));
        assert!(found[0] <= 1.0 / 16.0, "{degrees}°: {found:?}");
        for (found, stated) in found.iter().zip(stated) {
            assert!(*found <= stated, "{degrees}°: {found} texels, stated are {stated}");
        }
    }
}

/// Checks that pixels are equal where both pictures have one, and counts them.
fn assert_equal_where_both<T: PartialEq + std::fmt::Debug>(case: &str, a: &[Option<T>], b: &[Option<T>]) {
    let mut both = 0;
    for (k, (a, b)) in a.iter().zip(b).enumerate() {
        if let (Some(a), Some(b)) = (a, b) {
            assert_eq!(a, b, "{case}, at {}, {}", k % WIDTH, k / WIDTH);
            both += 1;
        }
    }
    assert!(both > 1000, "{case}: {both} pixels");
}

/// A viewport of half the width, in the middle, shows the same picture if the camera's is twice as wide.
fn narrow() -> (Cut, f64) {
    let quarter = WIDTH as i32 / 4;
    let viewport =
        Viewport::new(Point::new(quarter, 0), Size::new(WIDTH as u32 / 2, HEIGHT as u32)).expect("a viewport");
    (Cut { viewport, ..whole() }, 2.0)
}

fn cuts_move_no_coordinate<const STEP: usize>(rng: &mut Rng) {
    for degrees in [30, 60, 75, 85] {
        for place in places(rng, 4) {
            let model = placed(degrees, place);
            let expected = coordinates::<STEP>(&(camera(1.0, 0.05) * model), whole());
            let case = format!("every {STEP}, {degrees}°, {place:?}");
            let (cut, zoom) = narrow();
            let found = coordinates::<STEP>(&(camera(zoom, 0.05) * model), cut);
            assert_equal_where_both(&format!("{case}, in a viewport"), &found, &expected);
            for cut in
                [Cut { strip: 7, ..whole() }, Cut { strip: 1, records: 0, ..whole() }, Cut { width: 101, ..whole() }]
            {
                let found = coordinates::<STEP>(&(camera(1.0, 0.05) * model), cut);
                assert_equal_where_both(&format!("{case}, strips and rows"), &found, &expected);
            }
        }
    }
}

#[test]
fn viewports_strips_and_short_rows_move_no_coordinate() {
    let mut rng = Rng::new(9);
    cuts_move_no_coordinate::<4>(&mut rng);
    cuts_move_no_coordinate::<16>(&mut rng);
    cuts_move_no_coordinate::<32>(&mut rng);
}

#[test]
fn viewports_strips_and_short_rows_change_no_texel() {
    let texels: [[u16; 256]; 256] = std::array::from_fn(|y| std::array::from_fn(|x| (y << 8 | x) as u16 | 1));
    let tile = Tile::new(&texels);
    let shader = Textured::new(&tile);
    let mut rng = Rng::new(10);
    let some = |pixels: Vec<u16>, width: usize| -> Vec<Option<u16>> {
        let pixel = |k: usize| *pixels.get(k / WIDTH * width + k % WIDTH).filter(|_| k % WIDTH < width).unwrap_or(&0);
        (0..WIDTH * HEIGHT).map(|k| Some(pixel(k)).filter(|pixel| *pixel != 0)).collect()
    };
    for degrees in [0, 30, 60, 75, 85] {
        for place in places(&mut rng, 4) {
            let model = placed(degrees, place);
            let expected = some(drawn(&(camera(1.0, 0.05) * model), whole(), &shader), WIDTH);
            let (cut, zoom) = narrow();
            let found = some(drawn(&(camera(zoom, 0.05) * model), cut, &shader), WIDTH);
            assert_equal_where_both(&format!("{degrees}°, {place:?}, in a viewport"), &found, &expected);
            for width in [101, 113] {
                let found = some(drawn(&(camera(1.0, 0.05) * model), Cut { width, ..whole() }, &shader), width);
                assert_equal_where_both(&format!("{degrees}°, {place:?}, rows of {width}"), &found, &expected);
            }
        }
    }
}

/// A near plane cuts the wall into other triangles. Their corners are rounded to 1/256 px, and nothing else moves.
#[test]
fn clipping_moves_no_coordinate() {
    let mut rng = Rng::new(11);
    let mut worst = [0_f64; 2];
    for degrees in [30, 60, 75] {
        for place in places(&mut rng, 12) {
            let model = placed(degrees, place);
            let expected = coordinates::<16>(&(camera(1.0, 0.05) * model), whole());
            let found = coordinates::<16>(&(camera(1.0, place[1] - 0.3) * model), whole());
            let mut both = 0;
            for (k, (found, at)) in found.iter().zip(&expected).enumerate() {
                let (Some(found), Some(at), Some(Some(next))) = (found, at, expected.get(k + 1)) else {
                    continue;
                };
                both += 1;
                // In pixels: one pixel further is one pixel off.
                let texels = f64::from(next[0] - at[0]).abs();
                let off = f64::from(found[0] - at[0]).abs() / texels;
                let down = f64::from(found[1] - at[1]).abs() / texels;
                worst = [worst[0].max(off), worst[1].max(down)];
                assert!(off < 0.25, "{degrees}°, {place:?}, at {}, {}: {off} px", k % WIDTH, k / WIDTH);
            }
            assert!(both > 1000, "{degrees}°, {place:?}: {both} pixels");
        }
    }
    println!("worst: {:.3} px along rows, {:.3} px beside them", worst[0], worst[1]);
}

/// Colours of the levels of a mip chain, none of them 0.
const LEVELS: usize = 7;

/// A floor of two triangles at y = -1.5, with 64 texels per unit.
static FLOOR: Mesh<'static> = {
    const POINTS: [Vec3; 4] = [
        Vec3::from_milli(-20_000, -1500, -20_000),
        Vec3::from_milli(-20_000, -1500, 20_000),
        Vec3::from_milli(20_000, -1500, 20_000),
        Vec3::from_milli(20_000, -1500, -20_000),
    ];
    const FAR: Scalar = Scalar::from_bits(40 << 16);
    const UVS: [[Scalar; 2]; 4] = [[Scalar::ZERO; 2], [Scalar::ZERO, FAR], [FAR; 2], [FAR, Scalar::ZERO]];
    Mesh::constant(MeshData { topology: Topology::Quads, uvs: Some(&UVS), ..MeshData::new(Positions::Exact(&POINTS)) })
};

/// Images of 64 texels and less, each of them filled with the number of its level and one.
fn levels(bytes: &[Vec<u8>]) -> Vec<Image<'_, Rgb565Texel>> {
    let image =
        |(k, bytes): (usize, _)| Image::new(bytes, Size::new_equal(64 >> k as u32), Rgb565Texel).expect("an image");
    bytes.iter().map(Vec::as_slice).enumerate().map(image).collect()
}

fn level_bytes() -> Vec<Vec<u8>> {
    (0..LEVELS).map(|k| [0, k as u8 + 1].repeat(4096 >> (2 * k))).collect()
}

/// The floor's levels, by pixel.
fn floor(zoom: f64, near: f64, turn: i32, cut: Cut, shader: &impl Shader<Rgb565>) -> Vec<Option<u16>> {
    let view = Affine::rotation_x(Angle16::from_degrees(20)) * Affine::rotation_y(Angle16::from_degrees(turn));
    let pixels = drawn_mesh(&FLOOR, &(camera(zoom, near) * view), cut, shader);
    pixels.into_iter().map(|pixel| Some(pixel).filter(|pixel| *pixel != 0)).collect()
}

#[test]
fn levels_are_those_of_the_plane_however_it_is_cut() {
    let bytes = level_bytes();
    let images = levels(&bytes);
    let shader = Textured::mipmapped(&images).expect("a mip chain");
    let (cut, zoom) = narrow();
    for turn in [0, 25, 140] {
        let expected = floor(1.0, 0.05, turn, whole(), &shader);
        let case = |name: &str| format!("turned by {turn}°, {name}");
        // Corners that the near plane makes are rounded, which moves a level's border by a pixel at most.
        let clipped = floor(1.0, 3.0, turn, whole(), &shader);
        let pairs = clipped.iter().zip(&expected).filter_map(|(a, b)| Some(((*a)?, (*b)?)));
        let (differ, both) = pairs.fold((0, 0), |(differ, both), (a, b)| (differ + usize::from(a != b), both + 1));
        println!("{}: {differ} of {both} pixels differ", case("clipped"));
        assert!(both > 10_000 && differ * 200 < both, "{}: {differ} of {both}", case("clipped"));
        assert_equal_where_both(&case("in a viewport"), &floor(zoom, 0.05, turn, cut, &shader), &expected);
        let strips = Cut { strip: 7, records: 0, ..whole() };
        assert_equal_where_both(&case("strips"), &floor(1.0, 0.05, turn, strips, &shader), &expected);
        // The loop that goes fragment by fragment.
        let blend = Blend::new(shader, Replace);
        assert_equal_where_both(&case("by fragments"), &floor(1.0, 0.05, turn, whole(), &blend), &expected);
    }
}

/// Straight ahead, z = -1.5 / slope of the ray, and v = z: a row's texels follow from the next row.
#[test]
fn texels_of_a_level_have_the_size_of_pixels() {
    let bytes = level_bytes();
    let images = levels(&bytes);
    let shader = Textured::mipmapped(&images).expect("a mip chain");
    let found = floor(1.0, 0.05, 0, whole(), &shader);
    let mut seen = 0;
    for y in 0..HEIGHT {
        let depth = |y: f64| {
            let up = (1.0 - y / (HEIGHT as f64 / 2.0)) * LENS[1];
            let (sin, cos) = 20_f64.to_radians().sin_cos();
            // The ray (0, up, -1), turned down.
            1.5 * (cos + up * sin) / (sin - up * cos)
        };
        let Some(level) = found[y * WIDTH + WIDTH / 2] else { continue };
        let texels = 64.0 * (depth(y as f64) - depth(y as f64 + 1.0)).abs();
        let exact = texels.log2().clamp(0.0, LEVELS as f64 - 1.0);
        assert!((f64::from(level - 1) - exact).abs() <= 0.65, "row {y}: level {}, not {exact:.2}", level - 1);
        seen += 1;
    }
    assert!(seen > 100, "{seen} rows");
}

/// u from 0 to 9000 over a triangle: more than the fast loops take, so each pixel is divided by itself.
#[test]
fn coordinates_of_thousands_of_repeats_are_exact() {
    const FAR: Scalar = Scalar::from_bits(9000 << 16);
    let uvs = [[Scalar::ZERO; 2], [Scalar::ZERO, FAR], [FAR; 2], [FAR, Scalar::ZERO]];
    let data = MeshData { topology: Topology::Quads, uvs: Some(&uvs), ..MeshData::new(Positions::Exact(&POINTS)) };
    let wall = Mesh::new(data).expect("a mesh");
    // As high as the screen: each pixel is 9000 / 240 repeats.
    let mvp = camera(1.0, 0.05) * placed(0, [0.0, 1.0 / LENS[1]]);
    let mut found = vec![None; WIDTH * HEIGHT];
    drawn_mesh(&wall, &mvp, whole(), &Report::<16>(RefCell::new(&mut found)));
    let mut seen = 0;
    for (k, found) in found.iter().enumerate() {
        let Some([u, v]) = found else { continue };
        let (x, y) = ((k % WIDTH) as f64 + 0.5 - WIDTH as f64 / 2.0, (k / WIDTH) as f64 + 0.5);
        let half = WIDTH as f64 / 2.0 / LENS[0] * LENS[1];
        let exact = [(x / half + 1.0) / 2.0 * 9000.0, y / HEIGHT as f64 * 9000.0];
        for (found, exact) in [u, v].into_iter().zip(exact) {
            // Corners are within 1/256 px.
            assert!(
                (f64::from(*found) / 65_536.0 - exact).abs() < 9000.0 / 240.0 / 128.0,
                "{found} {exact} at {x}, {y}"
            );
        }
        seen += 1;
    }
    assert!(seen > 50_000, "{seen}");
}
