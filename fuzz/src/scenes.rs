//! Whole scenes: all draws, states, shaders and formats. A strip is a framebuffer: the bytes are the same in strips of
//! any height, with any records or none, by any renderer, and when the frame is drawn again.

use crate::source::Source;
use crate::things::{self, Kit, Pool};
use crate::{Hash, with_format_shader, with_shader};
use core::fmt::Debug;
use embedded_graphics::mono_font::{MonoTextStyleBuilder, ascii::FONT_4X6};
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{Circle, Line, PrimitiveStyleBuilder, Rectangle, Triangle};
use embedded_graphics::text::Text;
use zstrip::color::{Dithered, PixelFormat, Rgb332, Rgb565Be, Rgba8888};
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565, Rgb888};
use zstrip::frame::{FramebufferRenderer, Renderer};
use zstrip::math::{Pixels, Projective};
use zstrip::mesh::Positions;
use zstrip::shader::{Fogged, Gouraud, Phong, Textured};
use zstrip::span::{DepthState, Shader};
use zstrip::target::{DepthChoice, FrameSlice, RecordsChoice, Strip, StripPixels, occlusion_len};
use zstrip::vertex::Viewport;
use zstrip::{Dashed, Framebuffer, Scene, ScreenPoint, Smooth, State, Thick, Thin};

/// How much of a scene is compiled for a format.
pub trait Kind: PixelFormat {
    /// Set if every shader is.
    const ALL: bool = false;
}

impl Kind for Rgb565Be {
    const ALL: bool = true;
}
impl Kind for Rgb565 {}
impl Kind for Gray8 {}
impl Kind for Rgb888 {}
impl Kind for Dithered<Rgb565> {}
impl Kind for Rgba8888 {}
impl Kind for Rgb332 {}

/// One step of a scene.
enum Step {
    Mesh { pool: usize, shader: usize, state: State, mvp: Projective },
    Lines { pool: usize, shader: usize, state: State, mvp: Projective, stroke: u8, width: Pixels },
    Points { pool: usize, shader: usize, state: State, mvp: Projective, size: Pixels },
    Canvas { z: u16, depth: DepthState, what: u8, at: [ScreenPoint; 4], size: Pixels, scissor: Option<Rectangle> },
    Overlay { kind: u8, z: u16, depth: DepthState, what: u8, at: [ScreenPoint; 4] },
    Viewport(Viewport),
    Only { pool: usize, mvp: Projective },
}

/// A scene, decoded once and drawn as often as a frame asks for it.
pub struct Plan {
    pub screen: (u16, u16),
    pub background: Rgb888,
    pools: Vec<Pool>,
    kit: Kit,
    steps: Vec<Step>,
}

fn points(source: &mut Source<'_>) -> [ScreenPoint; 4] {
    let mut last = [0; 2];
    core::array::from_fn(|_| {
        last = last.map(|c| source.coordinate(c));
        ScreenPoint::new(Pixels::from_bits(last[0]), Pixels::from_bits(last[1]))
    })
}

impl Plan {
    pub fn new(source: &mut Source<'_>) -> Self {
        let screen = (1 + source.below(24) as u16, 1 + source.below(20) as u16);
        let background = things::color(source);
        let kit = Kit::new(source);
        let pools: Vec<_> = (0..1 + source.below(2)).map(|_| Pool::new(source)).collect();
        let count = pools.len();
        let steps = (0..1 + source.below(4)).map(|_| Step::new(source, count)).collect();
        Self { screen, background, pools, kit, steps }
    }

    pub fn size(&self) -> Size {
        Size::new(self.screen.0.into(), self.screen.1.into())
    }

    pub fn pixels(&self) -> usize {
        usize::from(self.screen.0) * usize::from(self.screen.1)
    }

    pub fn draw<F: Framebuffer<Format: Kind>>(&self, scene: &mut Scene<'_, F>) {
        self.steps.iter().for_each(|step| step.draw(scene, self));
    }
}

impl Step {
    fn new(source: &mut Source<'_>, pools: usize) -> Self {
        let kind = source.u8();
        let pool = usize::from(kind >> 4) % pools;
        let (shader, state, mvp) = (source.below(things::SHADERS), things::state(source), source.projective());
        match kind & 15 {
            0..=5 => Self::Mesh { pool, shader, state, mvp },
            6 | 7 => Self::Lines { pool, shader, state, mvp, stroke: source.u8(), width: things::width(source) },
            8 => Self::Points { pool, shader, state, mvp, size: things::width(source) },
            9..=11 => Self::Canvas {
                z: source.u16(),
                depth: things::depth_state(source),
                what: source.u8(),
                at: points(source),
                size: things::width(source),
                scissor: source.flag().then(|| {
                    let corner = Point::new(source.int() >> 24, source.int() >> 24);
                    Rectangle::new(corner, Size::new(source.size(), source.size()))
                }),
            },
            12 | 13 => Self::Overlay {
                kind: source.u8(),
                z: source.u16(),
                depth: things::depth_state(source),
                what: source.u8(),
                at: points(source),
            },
            14 => {
                let corner = Point::new(source.int() >> 16, source.int() >> 16);
                let size = Size::new(1 + u32::from(source.u8()), 1 + u32::from(source.u16() & 0xFFF));
                Viewport::new(corner, size).map_or(Self::Mesh { pool, shader, state, mvp }, Self::Viewport)
            }
            _ => Self::Only { pool, mvp },
        }
    }

    fn draw<F: Framebuffer<Format: Kind>>(&self, scene: &mut Scene<'_, F>, plan: &Plan) {
        let kit = &plan.kit;
        match self {
            Self::Mesh { pool, shader, state, mvp } => {
                let Some(mesh) = plan.pools[*pool].mesh() else { return };
                if <F::Format as Kind>::ALL {
                    with_shader!(*shader, kit, |shader| scene.draw_with(*state, &mesh, mvp, shader));
                } else {
                    with_format_shader!(*shader, kit, |shader| scene.draw_with(*state, &mesh, mvp, shader));
                }
            }
            Self::Lines { pool, shader, state, mvp, stroke, width } => {
                let Some(lines) = plan.pools[*pool].lines() else { return };
                let (pattern, state) = (Dashed(u32::from(*stroke) * 0x0101_0101), *state);
                let (gouraud, tile) = (Gouraud::vertex_colors(), things::tile());
                let textured = Textured::new(&tile);
                match (stroke & 3, shader & 1) {
                    (0, 0) => scene.draw_lines_with(state, &lines, mvp, &gouraud, &Thin),
                    (0, _) => scene.draw_lines_with(state, &lines, mvp, &textured, &Thin),
                    (1, _) => scene.draw_lines_with(state, &lines, mvp, &gouraud, &pattern),
                    (2, _) => scene.draw_lines_with(state, &lines, mvp, &textured, &Thick::new(*width)),
                    _ => scene.draw_lines_with(state, &lines, mvp, &gouraud, &Smooth::new(*width)),
                }
            }
            Self::Points { pool, shader, state, mvp, size } => {
                let Some(points) = plan.pools[*pool].points() else { return };
                let tile = things::tile();
                match shader & 1 {
                    0 => scene.draw_points_with(*state, &points, mvp, &Gouraud::vertex_colors(), *size),
                    _ => scene.draw_points_with(*state, &points, mvp, &Textured::new(&tile), *size),
                }
            }
            Self::Canvas { z, depth, what, at, size, scissor } => {
                canvas(scene, kit, (*z, *depth), *what, at, *size, scissor.as_ref());
            }
            Self::Overlay { kind, z, depth, what, at } => match kind % 3 {
                0 => flat::<F::Format, _>(&mut scene.overlay(), *what, at),
                1 => flat::<F::Format, _>(&mut scene.at_depth(*z), *what, at),
                _ => flat::<F::Format, _>(&mut scene.at_depth_with(*z, *depth), *what, at),
            },
            Self::Viewport(viewport) => scene.set_viewport(*viewport),
            Self::Only { pool, mvp } => {
                let Some(mesh) = plan.pools[*pool].mesh() else { return };
                let center = mesh.bounds().center;
                // Bounds of homogeneous positions ignore w, and do not tell where the mesh is drawn.
                if matches!(mesh.data().positions, Positions::Homogeneous(_)) || scene.is_visible(mesh.bounds(), mvp) {
                    scene.draw(&mesh, mvp, &Gouraud::vertex_colors());
                }
                if let Some(vertex) = scene.project(center, mvp) {
                    let _ = scene.unproject(vertex.into(), vertex.z, mvp);
                    scene.canvas_at(vertex.z).point(vertex.into(), Pixels::from_num(3), kit.color);
                }
            }
        }
    }
}

/// One shape or line on the canvas.
pub fn canvas<F: Framebuffer>(
    scene: &mut Scene<'_, F>,
    kit: &Kit,
    (z, depth): (u16, DepthState),
    what: u8,
    at: &[ScreenPoint; 4],
    size: Pixels,
    scissor: Option<&Rectangle>,
) {
    let mut canvas = scene.canvas_with(z, depth);
    canvas.set_scissor(scissor);
    let (color, [a, b, ..]) = (kit.color, *at);
    let corners = &at[..3 + usize::from(what & 1)];
    let other = Rgb888::new(kit.byte, 200, 7);
    let pattern = Dashed(u32::from(kit.byte) * 0x0101_0101);
    match what >> 1 & 15 {
        0 => canvas.polygon(corners, color),
        1 => canvas.gradient(&at.map(|at| (at, if at == a { color } else { other }))),
        2 => canvas.line(a, b, color),
        3 => canvas.line_with(a, b, color, &pattern),
        4 => canvas.line_with(a, b, color, &Thick::new(size)),
        5 => canvas.line_with(a, b, color, &Smooth::new(size)),
        6 => canvas.gradient_line((a, color), (b, other), &Smooth::new(size)),
        7 => canvas.gradient_line((a, color), (b, other), &Thin),
        8 => canvas.polyline(at, color, &Thick::new(size)),
        9 => canvas.outline(at, color, &Thin),
        10 => canvas.point(a, size, color),
        11 => {
            let corner = Point::from(a);
            canvas.rectangle(&Rectangle::new(corner, Size::new(kit.distances[0] as u32, kit.byte.into())), color);
        }
        12 => polygon(&mut canvas, corners, &Gouraud::vertex_colors(), kit),
        13 => polygon(&mut canvas, corners, &Textured::new(&things::tile()), kit),
        14 => polygon(&mut canvas, corners, &Phong::new(kit.lit), kit),
        _ => {
            let tile = things::tile();
            let inner = Textured::new(&tile).lit(kit.sunlit);
            let shader = Fogged::new(inner, kit.fog, other);
            polygon(&mut canvas, corners, &shader, kit);
        }
    }
}

/// A polygon whose corners have any varyings.
fn polygon<F: Framebuffer, S: Shader<F::Format>>(
    canvas: &mut zstrip::Canvas<'_, '_, F>,
    corners: &[ScreenPoint],
    shader: &S,
    kit: &Kit,
) {
    use zstrip::vertex::Varyings;
    let varyings = |k: usize| {
        let mut varyings = S::Varyings::ZERO;
        for (value, j) in varyings.as_mut().iter_mut().zip(0..) {
            // The same at all corners, or others.
            *value = kit.distances[(k * usize::from(kit.byte & 1) + j) % 4];
        }
        varyings
    };
    let mut given = [(corners[0], varyings(0)); 4];
    for (k, (to, corner)) in given.iter_mut().zip(corners).enumerate() {
        *to = (*corner, varyings(k));
    }
    canvas.polygon_with(&given[..corners.len()], shader, kit.distances[3] as u32);
}

/// Text and shapes of embedded-graphics.
fn flat<P: PixelFormat, T: DrawTarget<Color = P::Color, Error = core::convert::Infallible>>(
    target: &mut T,
    what: u8,
    at: &[ScreenPoint; 4],
) {
    let color = |k: u8| P::to_color(P::pack([k, 255 - k, what]));
    // Shapes that are far larger than the screen take embedded-graphics too long.
    let [a, b, c, d] = at.map(|at| Point::from(at)).map(|p| Point::new(p.x.clamp(-99, 99), p.y.clamp(-99, 99)));
    let style =
        PrimitiveStyleBuilder::new().stroke_color(color(9)).stroke_width(u32::from(what >> 5)).fill_color(color(99));
    let style = style.build();
    let Ok(()) = match what & 7 {
        0 | 1 => {
            let style = MonoTextStyleBuilder::new().font(&FONT_4X6).text_color(color(200)).background_color(color(3));
            let style = if what & 8 == 0 { style.underline() } else { style };
            Text::new("aB", a, style.build()).draw(target).map(|_| ())
        }
        2 => Circle::with_center(a, b.x.unsigned_abs() % 40).into_styled(style).draw(target),
        3 => Rectangle::with_corners(a, b).into_styled(style).draw(target),
        4 => Line::new(a, b).into_styled(style).draw(target),
        5 => Triangle::new(a, b, c).into_styled(style).draw(target),
        6 => {
            let colors = (0..u32::from(what)).map(|k| color(k as u8));
            target.fill_contiguous(&Rectangle::new(a, Size::new(d.x.unsigned_abs(), d.y.unsigned_abs())), colors)
        }
        _ => target.fill_solid(&Rectangle::new(d, Size::new(u32::MAX, c.y as u32)), color(50)),
    };
}

/// Draws a frame in strips, and puts it together.
pub fn strips<P: Kind, D: DepthChoice, R: RecordsChoice>(
    renderer: &mut Renderer<'_, P, D, R>,
    buffer: &mut [P::Raw],
    plan: &Plan,
) -> Vec<P::Raw> {
    let mut picture = Vec::with_capacity(plan.pixels());
    let sink = |strip: &StripPixels<'_, P>| {
        picture.extend_from_slice(strip.pixels());
        Ok::<(), core::convert::Infallible>(())
    };
    renderer
        .frame_to(sink, buffer, plan.background, |scene: &mut Scene<'_, Strip<'_, P, D, R>>| plan.draw(scene))
        .expect("the same scene in each call");
    assert_eq!(picture.len(), plan.pixels());
    picture
}

pub fn assert_alike<T: PartialEq + Debug>(found: &[T], expected: &[T], screen: (u16, u16), how: &dyn Debug) {
    if let Some(at) = (0..expected.len()).find(|&k| found[k] != expected[k]) {
        let more = (at + 1..expected.len()).filter(|&k| found[k] != expected[k]).count();
        let width = usize::from(screen.0);
        let (x, y) = (at % width, at / width);
        panic!(
            "pixel ({x}, {y}) of {:?} is {:?}, expected {:?}; {more} more differ: {how:?}",
            screen, found[at], expected[at]
        );
    }
}

/// Rows of a strip, for a screen of this height: any number for a quarter of all bytes. The others ask for four strips
/// at most, as every strip takes a walk through the scene.
pub fn strip_rows(byte: u8, height: u16) -> usize {
    let height = usize::from(height);
    let least = if byte >> 6 == 0 { 1 } else { height.div_ceil(4) };
    least + usize::from(byte & 63) % (height + 1 - least)
}

/// How a frame is drawn once more.
#[derive(Clone, Copy, Debug)]
struct Way {
    rows: usize,
    words: usize,
    renderer: u8,
}

/// Draws with depth and records in one strip, and then in another way.
fn check<P: Kind<Raw: PartialEq + Debug>>(plan: &Plan, way: Way) -> u64 {
    let (pixels, width) = (plan.pixels(), usize::from(plan.screen.0));
    let (mut color, mut depth) = (vec![P::pack([0xA5; 3]); pixels], vec![0x1234; pixels]);
    let (mut records, mut few) = (vec![0xDEAD_BEEF; 3000], vec![0xDEAD_BEEF; way.words]);
    let renderer = Renderer::<P>::new(plan.size()).expect("a renderer");
    let mut renderer = renderer.with_depth(&mut depth).expect("depths").with_records(&mut records);
    let expected = strips(&mut renderer, &mut color, plan);
    let renderer = Renderer::<P>::new(plan.size()).expect("a renderer").with_depth(&mut depth).expect("depths");
    let mut renderer = renderer.with_records(&mut few);
    let found = strips(&mut renderer, &mut color[..width * way.rows], plan);
    assert_alike(&found, &expected, plan.screen, &way);
    if way.renderer & 4 != 0 {
        // Whether states of triangles are carried on, and for how many there is room, does not show.
        let words = if way.renderer & 8 != 0 { &mut records } else { &mut few };
        let renderer = Renderer::<P>::new(plan.size()).expect("a renderer").with_depth(&mut depth).expect("depths");
        let mut carrying = renderer.with_records(words).with_carried_state();
        let found = strips(&mut carrying, &mut color[..width * way.rows], plan);
        assert_alike(&found, &expected, plan.screen, &("carried", way));
    } else if way.renderer & 1 != 0 {
        let again = strips(&mut renderer, &mut color[..width * way.rows], plan);
        assert_alike(&again, &expected, plan.screen, &("again", way));
    }
    let mut hash = Hash::default();
    hash.bytes(zstrip::bytemuck::cast_slice(&expected));
    hash.0
}

/// As [`check`], with other kinds of renderers.
fn check_all<P: Kind<Raw: PartialEq + Debug>>(plan: &Plan, way: Way) -> u64 {
    let hash = check::<P>(plan, way);
    let (pixels, width) = (plan.pixels(), usize::from(plan.screen.0));
    let (mut color, mut depth) = (vec![P::pack([0x5A; 3]); pixels], vec![0x4321; pixels]);
    let mut few = vec![0xDEAD_BEEF; way.words];
    let renderer = Renderer::<P>::new(plan.size()).expect("a renderer");
    let rows = width * way.rows;
    match way.renderer >> 1 & 3 {
        0 => {
            let mut with = renderer.with_depth(&mut depth).expect("depths").with_records(&mut few);
            let expected = strips(&mut with, &mut color[..rows], plan);
            let stride = width + usize::from(way.renderer >> 6);
            let mut pixels = vec![P::pack([7; 3]); stride * usize::from(plan.screen.1)];
            let mut frame = FrameSlice::<P>::with_stride(&mut pixels, plan.size(), stride).expect("a framebuffer");
            FramebufferRenderer::new(plan.size())
                .expect("a renderer")
                .with_depth(&mut depth[..rows])
                .expect("depths")
                .with_records(&mut few)
                .frame(&mut frame, plan.background, |scene| plan.draw(scene))
                .expect("the same scene");
            let found: Vec<_> = pixels.chunks(stride).flat_map(|row| &row[..width]).copied().collect();
            assert_alike(&found, &expected, plan.screen, &("framebuffer", way));
        }
        1 => {
            // Several samples per pixel: in strips, and in one.
            let (mut samples, mut depths) = (vec![P::pack([1; 3]); 3 * pixels], vec![0x4321; 4 * pixels]);
            let mut all = vec![0xDEAD_BEEF; 3000];
            let sampled = renderer.with_samples::<4>(&mut depths, &mut samples).expect("samples");
            let expected = strips(&mut sampled.with_records(&mut all), &mut color, plan);
            let renderer = Renderer::<P>::new(plan.size()).expect("a renderer");
            let (samples, depths) = (&mut samples[..3 * rows], &mut depths[..4 * rows]);
            let sampled = renderer.with_samples::<4>(depths, samples).expect("samples");
            let found = strips(&mut sampled.with_records(&mut few), &mut color[..rows], plan);
            assert_alike(&found, &expected, plan.screen, &("samples", way));
        }
        2 => {
            // Hidden draws are left out, and it does not show.
            let plain = renderer.with_depth(&mut depth).expect("depths");
            let expected = strips(&mut plain.with_records(&mut few), &mut color[..rows], plan);
            let mut depths = vec![0x4321; rows + occlusion_len(width, way.rows)];
            let renderer = Renderer::<P>::new(plan.size()).expect("a renderer").with_depth(&mut depths);
            let occluding = renderer.and_then(Renderer::with_occlusion).expect("depths");
            let found = strips(&mut occluding.with_records(&mut few), &mut color[..rows], plan);
            assert_alike(&found, &expected, plan.screen, &("occlusion", way));
        }
        _ => {
            // Without depths the picture is another one.
            let mut bare = renderer;
            let expected = strips(&mut bare, &mut color, plan);
            let found = strips(&mut bare, &mut color[..rows], plan);
            assert_alike(&found, &expected, plan.screen, &("no depths", way));
        }
    }
    hash
}

pub fn run(input: &[u8]) -> u64 {
    let mut source = Source::new(input);
    let (format, renderer, rows, words) = (source.u8(), source.u8(), source.u8(), source.u16());
    let plan = Plan::new(&mut source);
    let rows = strip_rows(rows, plan.screen.1);
    let way = Way { rows, words: usize::from(words) % 400, renderer };
    match format % 12 {
        0..=3 => check::<Rgb565Be>(&plan, way),
        4 | 5 => check_all::<Rgb565>(&plan, way),
        6 | 7 => check::<Gray8>(&plan, way),
        8 => check::<Rgb888>(&plan, way),
        9 => check::<Dithered<Rgb565>>(&plan, way),
        10 => check::<Rgba8888>(&plan, way),
        _ => check::<Rgb332>(&plan, way),
    }
}
