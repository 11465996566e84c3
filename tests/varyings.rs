//! Perspective-correct varyings of every primitive against one model in f64, in one strip and in many, with records and
//! without.

use crate::reference::homogeneous;
use crate::reference::interpolation::{Corner, Line, on_triangle};
use crate::reference::rng::Rng;
use crate::support::{apply, matrix, strips, unrecorded_strips, whole};
use std::cell::RefCell;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, GrayColor, Rgb565, Rgb888, RgbColor};
use zstrip::math::{Angle16, Pixels, Projective, Scalar, Vec3};
use zstrip::mesh::{LineTopology, Lines, Mesh, MeshData, Points, Positions, Vertices};
use zstrip::shader::{Blend, Flat, Opacity, ScreenDoor, Textured};
use zstrip::span::{DepthState, Fragment, Shader};
use zstrip::target::{FrameSlice, Framebuffer};
use zstrip::texture::{Clamp, Gray8Texel, Image, Tile};
use zstrip::vertex::{Perspective, VertexRef, VertexShader};
use zstrip::{Canvas, Cull, Dashed, Scene, ScreenPoint, Smooth, State, Stroke, Thick, Thin};

const SCREEN: (u16, u16) = (64, 48);
const SIZE: Size = Size::new(SCREEN.0 as u32, SCREEN.1 as u32);
const ALL: State = State { cull: Cull::None, depth: DepthState::OFF, ..State::DEFAULT };

/// Units of a texel in the varyings: as many as fit 256 texels into 28 bits.
const TEXEL: f64 = 1_048_576.0;

/// Largest error of a value in texels, of 256: that of [`Perspective`].
const TOLERANCE: f64 = 1.0 / 16.0;

/// Displacement in px that is allowed besides, in x and in y: positions are snapped to 1/256 px.
const DISPLACED: f64 = 1.0 / 256.0;

/// A camera of 60° between planes at 0.1 and 50.
fn camera() -> Projective {
    let (near, far) = (Scalar::from_num(0.1), Scalar::from_num(50));
    Projective::perspective(Angle16::from_degrees(60), SIZE, near, far).expect("a camera")
}

/// A pixel, and the two coordinates there, in [`TEXEL`]s.
type Hit = ((i32, i32), [i32; 2]);

/// Reports the coordinates of each fragment. They are those of the vertices by number.
struct Probe<'a> {
    values: &'a [[i32; 2]],
    hits: RefCell<Vec<Hit>>,
}

impl VertexShader for Probe<'_> {
    type Varyings = Perspective<2, 3>;

    fn vertex(&self, vertex: &VertexRef<'_>) -> Perspective<2, 3> {
        Perspective::new(self.values[vertex.index()], [])
    }
}

impl Shader<Gray8> for Probe<'_> {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, Perspective<2, 3>>) -> Option<u8> {
        self.hits.borrow_mut().push((fragment.position, fragment.varyings.corrected()));
        Some(255)
    }
}

/// A stroke by its name, because a [`Stroke`] cannot be an object.
#[derive(Clone, Copy, Debug)]
enum Style {
    Thin,
    Dashed,
    /// Width in 1/256 px.
    Thick(i32),
    Smooth(i32),
}

const PATTERN: Dashed = Dashed(0xB7E5_D39D);

fn thick(width: i32) -> Thick {
    Thick::new(Pixels::from_bits(width))
}

fn smooth(width: i32) -> Smooth {
    Smooth::new(Pixels::from_bits(width))
}

/// A way to draw points of space, or of the screen.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Triangle,
    Line(Style),
    /// Sides in 1/256 px.
    Point(i32),
    Polygon,
    CanvasLine(Style),
}

/// One primitive with its coordinates.
#[derive(Clone, Debug)]
struct Case {
    kind: Kind,
    /// Positions in space; on a canvas, positions in px as x and y.
    positions: Vec<Vec3>,
    /// Coordinates in [`TEXEL`]s.
    values: Vec<[i32; 2]>,
}

impl Case {
    fn draw<F: Framebuffer<Format = Gray8>>(&self, scene: &mut Scene<'_, F>, probe: &Probe<'_>) {
        let (camera, vertices) = (camera(), Vertices::new(Positions::Exact(&self.positions)));
        match self.kind {
            Kind::Triangle => {
                let mesh = Mesh::new(MeshData::new(Positions::Exact(&self.positions))).expect("a triangle");
                scene.draw_with(ALL, &mesh, &camera, probe);
            }
            Kind::Line(style) => {
                let line = Lines::new(vertices, LineTopology::Pairs, None).expect("a line");
                match style {
                    Style::Thin => scene.draw_lines_with(ALL, &line, &camera, probe, &Thin),
                    Style::Dashed => scene.draw_lines_with(ALL, &line, &camera, probe, &PATTERN),
                    Style::Thick(width) => scene.draw_lines_with(ALL, &line, &camera, probe, &thick(width)),
                    Style::Smooth(width) => scene.draw_lines_with(ALL, &line, &camera, probe, &smooth(width)),
                }
            }
            Kind::Point(size) => {
                let points = Points::new(vertices).expect("points");
                scene.draw_points_with(ALL, &points, &camera, probe, Pixels::from_bits(size));
            }
            Kind::Polygon => {
                let corners: Vec<_> = self.on_canvas().collect();
                scene.canvas().polygon_with(&corners, probe, 0);
            }
            Kind::CanvasLine(style) => {
                let mut ends = self.on_canvas();
                let ends = [(); 2].map(|()| ends.next().expect("two ends"));
                match style {
                    Style::Thin => scene.canvas().shaded_line(&ends, probe, 0, &Thin),
                    Style::Dashed => scene.canvas().shaded_line(&ends, probe, 0, &PATTERN),
                    Style::Thick(width) => scene.canvas().shaded_line(&ends, probe, 0, &thick(width)),
                    Style::Smooth(width) => scene.canvas().shaded_line(&ends, probe, 0, &smooth(width)),
                }
            }
        }
    }

    /// Returns the corners on the screen's plane. What they hold for 1 / w must not matter.
    fn on_canvas(&self) -> impl Iterator<Item = (ScreenPoint, Perspective<2, 3>)> {
        self.positions.iter().zip(&self.values).enumerate().map(|(k, (position, value))| {
            let [x, y, _] = position.to_bits().map(|c| Pixels::from_bits(c >> 8));
            let mut varyings = Perspective::new(*value, []);
            varyings.as_mut()[2] = [0, 17, -1, i32::MIN][k % 4];
            (ScreenPoint::new(x, y), varyings)
        })
    }

    /// Draws the primitive in several ways, which must give equal fragments; returns them.
    fn hits(&self) -> Vec<Hit> {
        let probe = || Probe { values: &self.values, hits: RefCell::default() };
        let sorted = |probe: Probe<'_>| {
            let mut hits = probe.hits.into_inner();
            hits.sort_unstable();
            hits
        };
        let first = probe();
        whole::<Gray8>(SCREEN, Gray8::BLACK, |scene| self.draw(scene, &first));
        let first = sorted(first);
        for (rows, records) in [(48, 0), (7, 1000), (1, 1000)] {
            let again = probe();
            strips::<Gray8>(SCREEN, rows, records, Gray8::BLACK, |scene| self.draw(scene, &again));
            assert_eq!(sorted(again), first, "{self:?}, {rows} rows, {records} words of records");
        }
        let again = probe();
        unrecorded_strips::<Gray8>(SCREEN, 7, Gray8::BLACK, |scene| self.draw(scene, &again));
        assert_eq!(sorted(again), first, "{self:?}, a renderer without records");
        first
    }

    /// Returns the corners with one of the two coordinates, in texels.
    fn corners(&self, which: usize) -> Vec<Corner> {
        let viewport = homogeneous::Viewport::new(SIZE.width, SIZE.height);
        let camera = matrix(&camera());
        let corner = |(position, value): (&Vec3, &[i32; 2])| {
            let [x, y, z] = position.to_bits().map(|c| f64::from(c) / 65_536.0);
            let at = match self.kind {
                Kind::Polygon | Kind::CanvasLine(_) => [x, y, 1.0],
                _ => viewport.screen_position(apply(&camera, [x, y, z, 1.0])),
            };
            Corner { at, value: f64::from(value[which]) / TEXEL }
        };
        self.positions.iter().zip(&self.values).map(corner).collect()
    }

    /// Returns the model of one of the two coordinates.
    fn model(&self, which: usize) -> Model {
        let corners = self.corners(which);
        let ends = match self.kind {
            Kind::Line(_) => {
                let line = Line { ends: [corners[0], corners[1]] };
                self.visible().map(|t| line.at(t).on_screen())
            }
            Kind::CanvasLine(_) => [corners[0].on_screen(), corners[1].on_screen()],
            _ => [[0.0; 2]; 2],
        };
        Model { kind: self.kind, corners, ends }
    }

    /// Returns the part of a line that is seen, as two ways along it in space: between the near and the far plane, and
    /// not more than 32,767 px out of the view.
    fn visible(&self) -> [f64; 2] {
        let camera = matrix(&camera());
        let ends = [0, 1].map(|k| {
            let [x, y, z] = self.positions[k].to_bits().map(|c| f64::from(c) / 65_536.0);
            apply(&camera, [x, y, z, 1.0])
        });
        let mut part = [0.0_f64, 1.0_f64];
        let planes: [fn([f64; 4]) -> f64; 6] = [
            |v| v[2],
            |v| v[3] - v[2],
            |v| BAND[0] * v[3] - v[0],
            |v| BAND[0] * v[3] + v[0],
            |v| BAND[1] * v[3] - v[1],
            |v| BAND[1] * v[3] + v[1],
        ];
        for plane in planes {
            let [a, b] = ends.map(plane);
            match (a < 0.0, b < 0.0) {
                (true, false) => part[0] = part[0].max(a / (a - b)),
                (false, true) => part[1] = part[1].min(a / (a - b)),
                _ => {}
            }
        }
        part
    }

    /// Compares all fragments with the model; returns their number, and the largest error in texels beside the
    /// displacement by `by` px that the rounding of positions may cause.
    fn check(&self, by: f64, tolerance: f64) -> (usize, f64) {
        let hits = self.hits();
        let mut worst = 0_f64;
        for which in 0..2 {
            let model = self.model(which);
            for (pixel, found) in &hits {
                let [low, high] = model.values(*pixel, by);
                let found = f64::from(found[which]) / TEXEL;
                let error = (low - found).max(found - high).max(0.0);
                worst = worst.max(error);
                assert!(error <= tolerance, "{self:?}: {pixel:?} has {found}, exact {low} to {high} texels");
            }
        }
        (hits.len(), worst)
    }
}

/// The exact values of a primitive.
struct Model {
    kind: Kind,
    corners: Vec<Corner>,
    /// Ends on the screen of the part of a line that is seen.
    ends: [[f64; 2]; 2],
}

impl Model {
    /// Returns the exact values at a pixel that is displaced by `by` px in any direction: the least and the greatest.
    fn values(&self, (x, y): (i32, i32), by: f64) -> [f64; 2] {
        let by = by * self.turning();
        let pixel = [f64::from(x) + 0.5, f64::from(y) + 0.5];
        let around = [[0.0, 0.0], [by, 0.0], [-by, 0.0], [0.0, by], [0.0, -by]];
        let around = around.map(|d| [pixel[0] + d[0], pixel[1] + d[1]]);
        let mut values = Vec::new();
        match self.kind {
            Kind::Point(_) => values.push(self.corners[0].value),
            Kind::Triangle | Kind::Polygon => {
                let corners = [self.corners[0], self.corners[1], self.corners[2]];
                values.extend(around.map(|at| on_triangle(&corners, at)));
            }
            Kind::Line(style) | Kind::CanvasLine(style) => {
                values.extend(around.into_iter().flat_map(|at| self.on_stroke(style, at)));
            }
        }
        values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(*v), high.max(*v)])
    }

    /// Returns the way from end to end of a line on the screen.
    fn way(&self) -> [f64; 2] {
        [0, 1].map(|k| self.ends[1][k] - self.ends[0][k])
    }

    /// Returns by how much the displacement of ends grows at the sides of a stroke: a short line turns with its ends.
    fn turning(&self) -> f64 {
        let (Kind::Line(style) | Kind::CanvasLine(style)) = self.kind else { return 1.0 };
        let (Style::Thick(width) | Style::Smooth(width)) = style else { return 1.0 };
        let [x, y] = self.way();
        1.0 + (f64::from(width) / 512.0 + 1.0) / x.hypot(y)
    }

    /// Returns the values that a stroke may have at a point of the screen.
    fn on_stroke(&self, style: Style, at: [f64; 2]) -> Vec<f64> {
        let line = Line { ends: [self.corners[0], self.corners[1]] };
        let (ends, way) = (self.ends, self.way());
        let length = way[0].hypot(way[1]);
        let place = |direction: [f64; 2], p: [f64; 2]| direction[0] * p[0] + direction[1] * p[1];
        // Values go on from the first end to the second one.
        let between = |direction: [f64; 2], at: f64| {
            let ends = ends.map(|end| place(direction, end));
            at.clamp(ends[0].min(ends[1]), ends[0].max(ends[1]))
        };
        match style {
            Style::Thin | Style::Dashed => {
                // Along the longer axis; along either axis where their lengths are equal but for rounding.
                let axis = |k: usize| if k == 0 { [1.0, 0.0] } else { [0.0, 1.0] };
                let is_longer = |k: &usize| way[*k].abs() > way[1 - *k].abs() - 0.02;
                let axes = [0, 1].into_iter().filter(is_longer).map(axis);
                axes.map(|axis| line.value(axis, between(axis, place(axis, at)))).collect()
            }
            Style::Thick(_) | Style::Smooth(_) => {
                let direction = way.map(|c| c / length);
                let mut along = place(direction, at);
                if let Style::Smooth(_) = style {
                    // Stretched by 130/256 px beyond both ends.
                    let (start, more) = (place(direction, ends[0]), 130.0 / 256.0);
                    along = start + (along - start + more) * length / (length + 2.0 * more);
                }
                vec![line.value(direction, along)]
            }
        }
    }
}

/// How far x / w and y / w of a line may be out of the view until it is cut: ±32,767 px.
const BAND: [f64; 2] = [65_534.0 / SCREEN.0 as f64 - 1.0, 65_534.0 / SCREEN.1 as f64 - 1.0];

/// Random points in space, as far away as `depth` says.
fn points(rng: &mut Rng, count: usize, depth: [f64; 2], spread: f64) -> Vec<Vec3> {
    let mut point = || {
        let z = depth[0] + rng.unit() * (depth[1] - depth[0]);
        let reach = spread * z.abs().max(0.1);
        let [x, y] = [(); 2].map(|()| (2.0 * rng.unit() - 1.0) * reach);
        Vec3::new(Scalar::from_num(x), Scalar::from_num(y), Scalar::from_num(-z))
    };
    (0..count).map(|_| point()).collect()
}

fn values(rng: &mut Rng, count: usize) -> Vec<[i32; 2]> {
    (0..count).map(|_| [(); 2].map(|()| rng.below(1 << 28) as i32)).collect()
}

/// Checks `cases` random cases of a kind, and prints the worst error.
fn check(name: &str, kind: Kind, count: usize, cases: usize, depth: [f64; 2], least: usize) {
    let mut rng = Rng::new(name.bytes().fold(14, |seed: u64, byte| seed.wrapping_mul(31) + u64::from(byte)));
    let (mut fragments, mut worst) = (0, 0_f64);
    for _ in 0..cases {
        let spread = rng.pick(&[0.4, 0.4, 2.0]);
        let far_aside = name.starts_with("aside");
        let positions = match kind {
            Kind::Polygon | Kind::CanvasLine(_) => (0..count)
                .map(|_| {
                    let [x, y] = [(); 2].map(|()| rng.between(-20 * 65_536, 80 * 65_536) & !0xFF);
                    Vec3::from_bits([x, y, 0])
                })
                .collect(),
            _ => {
                let mut positions = points(&mut rng, count, depth, spread);
                if far_aside {
                    positions[0] = points(&mut rng, 1, IN_VIEW, 0.4)[0];
                    positions[1] = points(&mut rng, 1, depth, 3000.0)[0];
                }
                positions
            }
        };
        let case = Case { kind, positions, values: values(&mut rng, count) };
        let (hits, error) = case.check(DISPLACED, TOLERANCE);
        fragments += hits;
        worst = worst.max(error);
    }
    println!("{name}, seed {:#x}: {fragments} fragments, worst error {worst:.5} texels", rng.seed());
    assert!(fragments >= least, "{name}: {fragments} fragments");
}

/// In front of the near plane, and behind the eye, up to far beyond the far plane.
const ANYWHERE: [f64; 2] = [-2.0, 8.0];
const IN_VIEW: [f64; 2] = [0.15, 12.0];
const STYLES: [Style; 6] =
    [Style::Thin, Style::Dashed, Style::Thick(256), Style::Thick(900), Style::Smooth(300), Style::Smooth(1500)];

#[test]
fn triangles_have_the_values_of_space() {
    check("triangles", Kind::Triangle, 3, 60, IN_VIEW, 10_000);
}

#[test]
fn clipped_triangles_have_the_values_of_space() {
    check("triangles with corners behind the eye", Kind::Triangle, 3, 60, ANYWHERE, 8_000);
    check("triangles that reach beyond the far plane", Kind::Triangle, 3, 40, [-5.0, 120.0], 4_000);
}

#[test]
fn lines_have_the_values_of_space() {
    for style in STYLES {
        check(&format!("lines, {style:?}"), Kind::Line(style), 2, 60, IN_VIEW, 300);
    }
}

#[test]
fn lines_that_are_cut_have_the_values_of_space() {
    for style in STYLES {
        check(&format!("cut lines, {style:?}"), Kind::Line(style), 2, 60, ANYWHERE, 300);
        check(&format!("far lines, {style:?}"), Kind::Line(style), 2, 60, [-5.0, 120.0], 200);
    }
}

/// Lines that leave the view so far aside that they are cut there.
#[test]
fn lines_from_far_aside_have_the_values_of_space() {
    for style in STYLES.into_iter().chain([Style::Thick(20_000)]) {
        check(&format!("aside, {style:?}"), Kind::Line(style), 2, 40, ANYWHERE, 300);
    }
}

#[test]
fn points_have_the_values_of_their_vertices() {
    check("points", Kind::Point(5 * 256), 1, 100, IN_VIEW, 800);
}

#[test]
fn shapes_of_a_canvas_have_values_that_are_linear_on_the_screen() {
    check("polygons", Kind::Polygon, 3, 40, IN_VIEW, 10_000);
    for style in STYLES {
        check(&format!("lines of a canvas, {style:?}"), Kind::CanvasLine(style), 2, 40, IN_VIEW, 300);
    }
}

/// Draws a line in each of the ways of [`Case::hits`], and returns one picture of all of them.
fn picture(
    line: &Lines<'_>,
    mvp: &Projective,
    screen: (u16, u16),
    shader: &impl Shader<Gray8>,
    stroke: &impl Stroke,
) -> Vec<u8> {
    let (first, ..) = whole::<Gray8>(screen, Gray8::BLACK, |s| s.draw_lines_with(ALL, line, mvp, shader, stroke));
    for (rows, records) in [(48, 0), (7, 100), (3, 0), (1, 100)] {
        let draw =
            strips::<Gray8>(screen, rows, records, Gray8::BLACK, |s| s.draw_lines_with(ALL, line, mvp, shader, stroke));
        assert_eq!(draw.0, first, "{rows} rows, {records} words of records");
    }
    let draw =
        unrecorded_strips::<Gray8>(screen, 7, Gray8::BLACK, |s| s.draw_lines_with(ALL, line, mvp, shader, stroke));
    assert_eq!(draw.0, first, "a renderer without records");
    first
}

/// Shows the texels of an image of 256 × 1 texels, whose greys are their numbers, along a line with u from 0 to 1.
fn texels(from: [f64; 3], to: [f64; 3], columns: &[usize], stroke: &impl Stroke) -> Vec<u8> {
    let greys: Vec<u8> = (0..=255).collect();
    let image = Image::new(&greys, Size::new(256, 1), Gray8Texel).expect("an image");
    let ends = [from, to].map(|[x, y, z]| Vec3::new(Scalar::from_num(x), Scalar::from_num(y), Scalar::from_num(z)));
    let uvs = [[Scalar::ZERO; 2], [Scalar::ONE, Scalar::ZERO]];
    let data = Vertices { uvs: Some(&uvs), ..Vertices::new(Positions::Exact(&ends)) };
    let line = Lines::new(data, LineTopology::Pairs, None).expect("a line");
    let shown = picture(&line, &camera(), SCREEN, &Textured::new(&image).wrap(Clamp), stroke);
    columns.iter().map(|x| shown[23 * usize::from(SCREEN.0) + x]).collect()
}

/// Returns the whole texels, of 256, that pixels of columns have on a level line with u from 0 to 1.
fn exact_texels(kind: Kind, from: [f64; 3], to: [f64; 3], columns: &[i32]) -> Vec<i32> {
    let positions = [from, to].map(|p| Vec3::from_bits(p.map(|c| (c * 65_536.0) as i32))).to_vec();
    let case = Case { kind, positions, values: vec![[0; 2], [(1 << 28) - 1, 0]] };
    case.check(DISPLACED, TOLERANCE);
    let hits = case.hits();
    // A thin line between two rows of pixels is in the upper one.
    let row = hits[0].0.1.max(23);
    let at = |x: &i32| hits.iter().find(|(at, _)| at.0 == *x && at.1.max(23) == row).expect("a fragment").1[0] >> 20;
    columns.iter().map(at).collect()
}

/// Checks the texels of a line, of 256, at some columns: exactly with a shader that divides at each pixel, and within
/// one of a texture on a thin line, which is divided at each pixel too. Wide lines, which are divided as triangles are,
/// are the same in all strips.
fn check_texels(from: [f64; 3], to: [f64; 3], columns: &[i32], exact: &[i32]) {
    for style in [Style::Thin, Style::Thick(3 * 256)] {
        assert_eq!(exact_texels(Kind::Line(style), from, to, columns), exact, "{style:?}");
    }
    let shown = texels(from, to, &columns.iter().map(|x| *x as usize).collect::<Vec<_>>(), &Thin);
    assert!(shown.iter().zip(exact).all(|(found, exact)| i32::from(*found).abs_diff(*exact) <= 1), "{shown:?}");
    texels(from, to, &[], &Thick::px(3));
    texels(from, to, &[], &Smooth::px(3));
}

#[test]
fn texels_along_a_line_are_those_of_space() {
    check_texels([-0.5, 0.0, -1.0], [2.0, 0.0, -4.0], &[16, 24, 32, 40, 48], &[8, 26, 53, 95, 175]);
}

#[test]
fn texels_along_a_line_from_behind_the_eye_are_those_of_space() {
    check_texels([-0.5, 0.0, 1.0], [1.0, 0.0, -4.0], &[16, 24, 32, 40], &[66, 72, 86, 158]);
}

/// A tile with texels of 1 to 16.
static TILE: Tile<'static, 4, 4> = Tile::new(&[[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12], [13, 14, 15, 16]]);

/// Sixteen colours, from 1 to 16.
const COLORS: [u16; 16] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];

#[test]
fn a_thick_line_without_perspective_shows_the_texels_one_by_one() {
    let uvs = [[Scalar::ZERO; 2], [Scalar::ONE, Scalar::ZERO]];
    let ends = [Vec3::from_ints(-1, 0, 0), Vec3::from_ints(1, 0, 0)];
    let data = Vertices { uvs: Some(&uvs), ..Vertices::new(Positions::Exact(&ends)) };
    let line = Lines::new(data, LineTopology::Pairs, None).expect("a line");
    for records in [100, 0] {
        let (picture, _) = strips::<Rgb565>((8, 4), 4, records, Rgb565::BLACK, |scene| {
            scene.draw_lines(&line, &Projective::IDENTITY, &Textured::new(&TILE), &Thick::px(2));
        });
        assert_eq!(picture[16..24], [1, 1, 2, 2, 3, 3, 4, 4], "{records} words of records");
    }
}

/// Corners of a square from (0, 0) to (`side`, `side`) px, with texture coordinates from 0 to 1.
fn square(side: i16) -> [(ScreenPoint, Perspective<2, 3>); 4] {
    [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(x, y): (i16, i16)| {
        (ScreenPoint::corner(side * x, side * y), Perspective::new([i32::from(x) << 16, i32::from(y) << 16], []))
    })
}

#[test]
fn a_polygon_of_a_canvas_shows_all_of_a_texture() {
    for (rows, records) in [(4, 100), (4, 0), (1, 0)] {
        let (picture, _) = strips::<Rgb565>((4, 4), rows, records, Rgb565::BLACK, |scene| {
            scene.canvas().polygon_with(&square(4), &Textured::new(&TILE), 0);
        });
        assert_eq!(picture, COLORS, "{rows} rows, {records} words of records");
    }
}

#[test]
fn a_polygon_of_a_canvas_has_the_colour_of_its_shader() {
    let corners = square(4).map(|(corner, _)| (corner, []));
    let draw = |draw: &dyn Fn(&mut Canvas<'_, '_, FrameSlice<'_, Rgb888>>)| {
        let (picture, ..) = whole::<Rgb888>((4, 4), Rgb888::BLACK, |scene| draw(&mut scene.canvas()));
        assert!(picture.iter().all(|pixel| *pixel == picture[0]), "{picture:?}");
        picture[0]
    };
    let red = Flat::unlit(Rgb888::RED);
    assert_eq!(draw(&|canvas| canvas.polygon_with(&corners, &red, 0)), [255, 0, 0]);
    let half = Blend::new(ScreenDoor::new(red, 16), Opacity(128));
    assert_eq!(draw(&|canvas| canvas.polygon_with(&corners, &half, 0)), [128, 0, 0]);
    // The colours of a mesh's vertices are no colours of a shape: its face word counts.
    assert_eq!(draw(&|canvas| canvas.polygon_with(&corners, &Flat::vertex_colors(), 0x12_3456)), [0x12, 0x34, 0x56]);
}
