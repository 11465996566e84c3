//! Frames of extreme scenes: any matrices, positions, states, strokes, varyings and areas, under every shader of the
//! crate.

use super::{Extreme, Table};
use crate::reference::rng::Rng;
use zstrip::color::{Dither, Dithered, PixelFormat, Rgb332, Rgb565Be, Rgba8888};
use zstrip::embedded_graphics_core::draw_target::DrawTarget;
use zstrip::embedded_graphics_core::geometry::{Dimensions, OriginDimensions, Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{BinaryColor, Gray8, Rgb565, Rgb888, RgbColor};
use zstrip::embedded_graphics_core::primitives::Rectangle;
use zstrip::embedded_graphics_core::{Drawable, Pixel};
use zstrip::frame::{FrameError, FrameView, Renderer};
use zstrip::light::{DirectionalLight, Lighting, LitMaterial, Material, PointLight, Viewer};
use zstrip::math::{Scalar, Vec3};
use zstrip::mesh::{Bounds, LineTopology, Lines, Mesh, MeshData, Points, Positions, Topology, Vertices};
use zstrip::scene::{Canvas, Cull, Dashed, Scene, ScreenPoint, Smooth, State, Thick, Thin, Winding};
use zstrip::shader::{
    Add, AddAlpha, Alpha, AlphaTest, Blend, DepthOnly, Flat, FogCurve, FogTable, Fogged, Gouraud, Matcap, Multiply,
    Opacity, Phong, PhongNear, Replace, ScreenDoor, Textured,
};
use zstrip::span::{Compare, DepthBias, DepthState, Shader};
use zstrip::target::{DitheredDisplay, Framebuffer};
use zstrip::texture::{Bilinear, Clamp, Image, Mirror, Rgb888Texel, Tile, WithAlpha};
use zstrip::vertex::{DepthRange, DepthScale, Perspective, Viewport};

const WIDTH: u32 = 37;
const HEIGHT: u32 = 19;
const SCREEN: Size = Size::new(WIDTH, HEIGHT);

static TEXELS: [[u16; 4]; 4] = [[0x1234; 4]; 4];
static TILE: Tile<'static, 4, 4> = Tile::new(&TEXELS);
static LEVELS: [Tile<'static, 4, 4>; 1] = [TILE];
static MIST: FogTable = match FogTable::perspective(
    Scalar::ONE,
    Scalar::from_bits(100 << 16),
    FogCurve::Exponential { density: Scalar::from_bits(6000) },
) {
    Ok(table) => table,
    Err(_) => panic!("near and far"),
};

fn depth_state(rng: &mut Rng) -> DepthState {
    use Compare::*;
    let compare = rng.pick(&[Never, Less, Equal, LessEqual, Greater, NotEqual, GreaterEqual, Always]);
    DepthState { compare, write: rng.one_in(2) }
}

fn state(rng: &mut Rng) -> State {
    let depth_scale = match rng.below(3) {
        0 => DepthScale::Uniform { far: rng.scalar() },
        _ => DepthScale::Perspective,
    };
    State {
        cull: rng.pick(&[Cull::None, Cull::Back, Cull::Front]),
        front: rng.pick(&[Winding::Clockwise, Winding::CounterClockwise]),
        depth: if rng.one_in(2) { DepthState::LESS } else { depth_state(rng) },
        bias: DepthBias { constant: rng.short(), slope: rng.scalar() },
        range: rng.pick(&[DepthRange::Clip, DepthRange::ClampFar, DepthRange::Clamp]),
        depth_scale,
    }
}

fn rectangle(rng: &mut Rng) -> Rectangle {
    let side = |rng: &mut Rng| if rng.one_in(2) { rng.bits() as u32 } else { rng.below(40) as u32 };
    let corner = |rng: &mut Rng| if rng.one_in(2) { rng.bits() } else { rng.between(-20, 40) };
    Rectangle::new(Point::new(corner(rng), corner(rng)), Size::new(side(rng), side(rng)))
}

/// Makes a point on the screen, or far away from it.
fn point(rng: &mut Rng) -> ScreenPoint {
    if rng.one_in(2) {
        return ScreenPoint::new(rng.pixels(), rng.pixels());
    }
    ScreenPoint::corner(rng.between(-10, 50) as i16, rng.between(-10, 30) as i16)
}

fn material<const D: usize, const P: usize>(rng: &mut Rng) -> LitMaterial<D, P> {
    let lighting = Lighting {
        ambient: Rgb888::WHITE,
        directional: core::array::from_fn(|_| DirectionalLight::new(rng.vector(), Rgb888::WHITE)),
        points: core::array::from_fn(|_| PointLight::new(rng.vector(), Rgb888::WHITE, rng.scalar())),
        viewer: if rng.one_in(2) { Viewer::At(rng.vector()) } else { Viewer::Toward(rng.vector()) },
    };
    let material = Material::glossy(Rgb888::WHITE, Rgb888::WHITE, rng.bits() as u8).two_sided();
    let bounds = Bounds { center: rng.vector(), half: rng.vector() };
    lighting.on(if rng.one_in(2) { material.vertex_colors() } else { material }, &rng.affine(), &bounds)
}

/// How much is compiled for a format. Code for lines, points and polygons is the same for all formats but for the loops
/// over pixels, which a few shaders reach.
trait Kind: PixelFormat {
    /// Set if every shader is drawn in every way. Elsewhere, every shader draws meshes, and some draw the rest.
    const ALL: bool = false;
}

impl Kind for Rgb565 {
    const ALL: bool = true;
}
impl Kind for Dithered<Rgb565Be> {}
impl Kind for Dithered<Rgb332> {}
impl Kind for Gray8 {}
impl Kind for Rgb888 {}
impl Kind for Rgba8888 {}

/// A use of a shader: whatever takes one, takes it.
trait With<F: Framebuffer> {
    fn with<S: Shader<F::Format>>(&mut self, shader: &S, varyings: fn(&mut Rng) -> S::Varyings);
}

/// Calls `to` with each of the ready-made shaders.
fn shader<F: Framebuffer>(rng: &mut Rng, to: &mut impl With<F>) {
    let colors: fn(&mut Rng) -> [i32; 3] = |rng| rng.triple();
    let coordinates: fn(&mut Rng) -> Perspective<2, 3> = |rng| Perspective::new([rng.bits(), rng.bits()], []);
    let gouraud = Gouraud::vertex_colors();
    match rng.below(22) {
        0 => to.with(&Flat::vertex_colors(), |_| []),
        1 => to.with(&Flat::new(material::<2, 1>(rng)), |_| []),
        2 => to.with(&gouraud, colors),
        3 => to.with(&Gouraud::new(material::<1, 2>(rng)), colors),
        4 => to.with(&Phong::new(material::<2, 0>(rng)), colors),
        5 => to.with(&PhongNear::new(material::<1, 1>(rng)), |rng| {
            let ([a, b, c], [d, e, f]) = (rng.triple(), rng.triple());
            [a, b, c, d, e, f]
        }),
        6 => to.with(&Textured::new(&TILE), coordinates),
        7 => to.with(&Textured::new(&TILE).wrap(Clamp).filter(Bilinear), coordinates),
        8 => to.with(&Textured::new(&TILE).wrap(Mirror), coordinates),
        9 => to.with(&Textured::mipmapped(&LEVELS).expect("one level"), coordinates),
        10 => {
            let image = Image::new(&[9; 90], Size::new(6, 5), Rgb888Texel).expect("three bytes for each texel");
            let texture = WithAlpha::new(image, &[0x7F; 15]).expect("half a byte for each texel");
            to.with(&Blend::new(Textured::new(&texture).filter(Bilinear), Alpha), coordinates);
        }
        11 => to.with(&Textured::new(&TILE).lit(material::<1, 1>(rng)), |rng| {
            Perspective::new([rng.bits(), rng.bits()], rng.triple())
        }),
        12 => {
            let picture = [[[1, 2, 3]; 8]; 8];
            let matcap = Matcap::<Rgb888, 8>::new(&picture, &rng.affine());
            to.with(&matcap, |rng| [rng.bits(), rng.bits()]);
        }
        13 => to.with(&DepthOnly, |_| []),
        14 => to.with(&Fogged::new(gouraud, &MIST, Rgb888::RED), colors),
        15 => to.with(&AlphaTest::new(gouraud, rng.bits() as u8), colors),
        16 => to.with(&ScreenDoor::new(gouraud, rng.bits() as u8), colors),
        17 => to.with(&Blend::new(gouraud, Opacity(rng.bits() as u8)), colors),
        18 => to.with(&Blend::new(gouraud, Add), colors),
        19 => to.with(&Blend::new(gouraud, AddAlpha), colors),
        20 => to.with(&Blend::new(Flat::unlit(Rgb888::RED), Multiply), |_| []),
        _ => to.with(&Blend::new(gouraud, Replace), colors),
    }
}

/// Calls `to` with a shader of each kind: without varyings, with them, textured, and blending.
fn few_shaders<F: Framebuffer>(rng: &mut Rng, to: &mut impl With<F>) {
    match rng.below(4) {
        0 => to.with(&Flat::vertex_colors(), |_| []),
        1 => to.with(&Gouraud::vertex_colors(), |rng| rng.triple()),
        2 => to.with(&Textured::new(&TILE).filter(Bilinear), |rng| Perspective::new([rng.bits(), rng.bits()], [])),
        _ => to.with(&Blend::new(Gouraud::vertex_colors(), Opacity(rng.bits() as u8)), |rng| rng.triple()),
    }
}

/// Lines or points under any matrix and state.
struct DrawLines<'d, 's, 'a, F> {
    scene: &'s mut Scene<'a, F>,
    lines: &'d Lines<'d>,
    points: &'d Points<'d>,
    rng: Rng,
}

impl<F: Framebuffer> With<F> for DrawLines<'_, '_, '_, F> {
    fn with<S: Shader<F::Format>>(&mut self, shader: &S, _: fn(&mut Rng) -> S::Varyings) {
        let Self { scene, lines, points, rng } = self;
        let (mvp, size, state) = (rng.projective(), rng.pixels(), state(rng));
        match rng.below(6) {
            0 => scene.draw_points_with(state, points, &mvp, shader, size),
            1 | 2 => scene.draw_lines_with(state, lines, &mvp, shader, &Thin),
            3 => scene.draw_lines_with(state, lines, &mvp, shader, &Dashed(rng.bits() as u32)),
            4 => scene.draw_lines_with(state, lines, &mvp, shader, &Thick::new(size)),
            _ => scene.draw_lines_with(state, lines, &mvp, shader, &Smooth::new(size)),
        }
    }
}

/// A mesh under any matrix and state.
struct DrawMesh<'d, 's, 'a, F> {
    scene: &'s mut Scene<'a, F>,
    mesh: &'d Mesh<'d>,
    rng: Rng,
}

impl<F: Framebuffer> With<F> for DrawMesh<'_, '_, '_, F> {
    fn with<S: Shader<F::Format>>(&mut self, shader: &S, _: fn(&mut Rng) -> S::Varyings) {
        let Self { scene, mesh, rng } = self;
        let (mvp, state) = (rng.projective(), state(rng));
        if rng.one_in(3) { scene.draw(mesh, &mvp, shader) } else { scene.draw_with(state, mesh, &mvp, shader) }
    }
}

/// A polygon with any varyings.
struct Polygon<'c, 's, 'a, F> {
    canvas: Canvas<'s, 'a, F>,
    rng: &'c mut Rng,
}

impl<F: Framebuffer> With<F> for Polygon<'_, '_, '_, F> {
    fn with<S: Shader<F::Format>>(&mut self, shader: &S, varyings: fn(&mut Rng) -> S::Varyings) {
        let Self { canvas, rng } = self;
        let corners: [_; 4] = core::array::from_fn(|_| (point(rng), varyings(rng)));
        canvas.polygon_with(&corners, shader, rng.bits() as u32);
        let at = |x, y| ScreenPoint::corner(x, y);
        let places = [at(0, 0), at(30, 0), at(30, 15), at(0, 15)];
        // The same values at all corners, and different ones.
        canvas.polygon_with(&places.map(|at| (at, corners[0].1)), shader, 0);
        let mut all = corners.iter();
        canvas.polygon_with(&places.map(|at| (at, all.next().map_or(corners[0].1, |c| c.1))), shader, 0);
    }
}

/// Draws a list of shapes, the same for each call with one generator.
fn shapes<F: Framebuffer<Format: Kind>>(scene: &mut Scene<'_, F>, mut rng: Rng) {
    let colour = Rgb888::new(rng.bits() as u8, 77, 200);
    let z = rng.bits() as u16;
    let mut canvas = match rng.below(3) {
        0 => scene.canvas(),
        1 => scene.canvas_at(z),
        _ => scene.canvas_with(z, depth_state(&mut rng)),
    };
    if rng.one_in(3) {
        canvas.set_scissor(Some(&rectangle(&mut rng)));
    }
    if rng.one_in(3) {
        canvas.set_depth(z, depth_state(&mut rng));
    }
    let points: [ScreenPoint; 4] = core::array::from_fn(|_| point(&mut rng));
    let [a, b, c, d] = points;
    let size = rng.pixels();
    canvas.rectangle(&rectangle(&mut rng), colour);
    canvas.point(a, size, colour);
    canvas.polygon(&points[..rng.below(5) as usize], colour);
    canvas.gradient(&[(a, colour), (b, Rgb888::WHITE), (c, Rgb888::BLACK)]);
    canvas.line(a, b, colour);
    canvas.line_with(c, d, colour, &Dashed(rng.bits() as u32));
    canvas.line_with(a, d, colour, &Thick::new(size));
    canvas.line_with(b, d, colour, &Smooth::new(size));
    canvas.gradient_line((a, colour), (c, Rgb888::WHITE), &Smooth::new(size));
    canvas.gradient_line((b, colour), (c, Rgb888::WHITE), &Thin);
    canvas.polyline(&points[..rng.below(5) as usize], colour, &Thick::new(size));
    canvas.outline(&points[..rng.below(5) as usize], colour, &Thin);
    let mut polygon = Polygon { canvas, rng: &mut rng };
    let mut choice = Rng::new(polygon.rng.next_u64());
    if F::Format::ALL {
        shader(&mut choice, &mut polygon);
    } else {
        few_shaders(&mut choice, &mut polygon);
    }
}

/// Draws through embedded-graphics targets.
fn overlays<F: Framebuffer>(scene: &mut Scene<'_, F>, mut rng: Rng)
where
    <F::Format as PixelFormat>::Color: From<Rgb888>,
{
    let colour: <F::Format as PixelFormat>::Color = Rgb888::GREEN.into();
    for _ in 0..4 {
        let (area, z, depth) = (rectangle(&mut rng), rng.bits() as u16, depth_state(&mut rng));
        let at = Point::new(rng.bits(), rng.bits());
        let mut overlay = scene.at_depth_with(z, depth);
        let _ = overlay.is_visible(&area);
        overlay.fill_solid(&area, colour).expect("no error");
        // As many colours as a screen has: filling takes no more of them than there are.
        overlay.fill_contiguous(&area, core::iter::repeat_n(colour, 1000)).expect("no error");
        overlay.draw_iter([Pixel(at, colour), Pixel(Point::new(3, 3), colour)]).expect("no error");
        scene.overlay().clear(colour).expect("no error");
        scene.at_depth(z).fill_solid(&area, colour).expect("no error");
    }
}

/// Questions that a scene answers.
fn questions<F: Framebuffer>(scene: &mut Scene<'_, F>, rng: &mut Rng) {
    let (mvp, position) = (rng.projective(), rng.vector());
    let bounds = Bounds { center: rng.vector(), half: rng.vector() };
    let _ = scene.is_visible(&bounds, &mvp);
    let state = state(rng);
    if let Some(vertex) = scene.project_with(state, position, &mvp) {
        let _ = scene.unproject(vertex.into(), vertex.z, &mvp);
    }
    let _ = (scene.project(position, &mvp), scene.unproject(point(rng), rng.bits() as u16, &mvp));
    let corner = Point::new(rng.between(-8192, 8192), rng.between(-8192, 8192));
    let corner = if rng.one_in(2) { corner } else { Point::new(rng.between(-40, 40), 2) };
    let size = Size::new(1 + rng.below(4096) as u32, 1 + rng.below(4096) as u32);
    if rng.one_in(2) {
        scene.set_viewport(Viewport::new(corner, size).expect("within the limits"));
    }
}

/// Draws two things, the same for each call with one seed.
fn draw_all<F: Framebuffer<Format: Kind>>(
    scene: &mut Scene<'_, F>,
    seed: u64,
    mesh: &Mesh<'_>,
    lines: &Lines<'_>,
    points: &Points<'_>,
) where
    <F::Format as PixelFormat>::Color: From<Rgb888>,
{
    let mut rng = Rng::new(seed);
    for _ in 0..2 {
        let own = Rng::new(rng.next_u64());
        match rng.below(8) {
            0 => questions(scene, &mut rng),
            1 => overlays(scene, own),
            2 | 3 => shapes(scene, own),
            4 | 5 => shader(&mut rng, &mut DrawMesh { scene, mesh, rng: own }),
            _ => {
                let mut lines = DrawLines { scene, lines, points, rng: own };
                if F::Format::ALL { shader(&mut rng, &mut lines) } else { few_shaders(&mut rng, &mut lines) }
            }
        }
    }
}

fn frames<P: Kind>(seed: u64, rounds: u32)
where
    P::Color: From<Rgb888>,
{
    let (mut table, mut rng) = (Table::start(), Rng::new(seed));
    for _ in 0..rounds {
        let (mut quantized, mut exact, mut homogeneous) = ([[0; 3]; 6], [Vec3::ZERO; 6], [[Scalar::ZERO; 4]; 6]);
        quantized.iter_mut().for_each(|p| *p = [rng.short(), rng.short(), rng.short()]);
        exact.iter_mut().for_each(|p| *p = rng.vector());
        homogeneous.iter_mut().for_each(|p| *p = [rng.scalar(), rng.scalar(), rng.scalar(), rng.scalar()]);
        if rng.one_in(2) {
            // On the screen of an identity matrix, or near it.
            let near = |rng: &mut Rng| Scalar::from_bits(rng.between(-100_000, 100_000));
            exact.iter_mut().for_each(|p| *p = Vec3::new(near(&mut rng), near(&mut rng), near(&mut rng)));
            homogeneous.iter_mut().for_each(|p| *p = [(); 4].map(|()| near(&mut rng)));
        }
        let scale = Scalar::from_bits((rng.bits() & i32::MAX).max(1));
        let positions = match rng.below(3) {
            0 => Positions::Quantized { points: &quantized, scale, offset: rng.vector() },
            1 => Positions::Exact(&exact),
            _ => Positions::Homogeneous(&homogeneous),
        };
        let normals: [[i16; 3]; 6] = core::array::from_fn(|_| [rng.short(), rng.short(), rng.short()]);
        let uvs: [[Scalar; 2]; 6] = core::array::from_fn(|_| [rng.scalar(), rng.scalar()]);
        let colors = [[255, 0, 128]; 6];
        let given = rng.one_in(2);
        let vertices = Vertices {
            normals: given.then_some(&normals[..]),
            uvs: given.then_some(&uvs[..]),
            colors: given.then_some(&colors[..]),
            ..Vertices::new(positions)
        };
        let data = MeshData {
            topology: rng.pick(&[Topology::Triangles, Topology::Strip, Topology::Fan]),
            normals: vertices.normals,
            uvs: vertices.uvs,
            colors: vertices.colors,
            ..MeshData::new(positions)
        };
        let mesh = Mesh::new(data).expect("six vertices");
        let lines = Lines::new(vertices, LineTopology::Loop, None).expect("six vertices");
        let points = Points::new(vertices).expect("six vertices");
        let scene_seed = rng.next_u64();
        let records = rng.pick(&[0, 1, 7, 60, 400, 5000]);
        let rows = rng.pick(&[1, 2, 5, HEIGHT as usize]);
        table.case("frame", (scene_seed, records, rows, data), || {
            let mut color = vec![P::pack([0; 3]); WIDTH as usize * rows];
            let (mut depth, mut records) = (vec![0; WIDTH as usize * rows], vec![0; records]);
            let renderer = Renderer::<P>::new(SCREEN).expect("a screen").with_depth(&mut depth).expect("a strip");
            let mut renderer = renderer.with_records(&mut records);
            let mut frame = renderer.begin(Rgb888::BLACK);
            while frame
                .next_strip(&mut color, |scene| draw_all(scene, scene_seed, &mesh, &lines, &points))
                .expect("the scene is one")
                .is_some()
            {}
            frame.stats()
        });
    }
    table.finish();
}

#[test]
fn frames_of_16_bits_take_all_scenes() {
    frames::<Rgb565>(101, 2000);
}

#[test]
fn dithered_frames_take_all_scenes() {
    frames::<Dithered<Rgb565Be>>(102, 800);
}

#[test]
fn frames_of_8_bits_take_all_scenes() {
    frames::<Dithered<Rgb332>>(103, 800);
}

#[test]
fn grey_frames_take_all_scenes() {
    frames::<Gray8>(104, 800);
}

#[test]
fn frames_of_three_and_of_four_bytes_take_all_scenes() {
    frames::<Rgb888>(105, 600);
    frames::<Rgba8888>(106, 600);
}

#[test]
fn polygon_of_a_lit_shader_ends_for_normals_whose_squares_wrap() {
    let (mut table, mut rng) = (Table::start(), Rng::new(107));
    let phong = Phong::new(material::<1, 0>(&mut rng));
    for varyings in [[i32::MIN, 0, 0], [-131_071 << 14, 0, 0], [1 << 30, 0, 0], [i32::MIN; 3]] {
        table.case("Canvas::polygon_with", varyings, || {
            let mut color = [0; 16 * 16];
            let mut renderer = Renderer::<Rgb565>::new(Size::new(16, 16)).expect("a screen");
            let corners = [(0, 0), (16, 0), (0, 16)].map(|(x, y)| (ScreenPoint::corner(x, y), varyings));
            let mut frame = renderer.begin(Rgb888::BLACK);
            let strip = frame.next_strip(&mut color, |scene| scene.canvas().polygon_with(&corners, &phong, !0));
            assert!(strip.expect("a strip").is_some());
        });
    }
    table.finish();
}

/// Ends no frame but by an error: whatever the closure draws from call to call, and however long the buffers are.
#[test]
fn scenes_and_buffers_that_change_within_a_frame_give_errors_or_pictures() {
    let (mut table, mut rng) = (Table::start(), Rng::new(108));
    let corners: [[Scalar; 4]; 6] = core::array::from_fn(|_| {
        let near = |rng: &mut Rng| Scalar::from_bits(rng.between(-100_000, 100_000));
        [near(&mut rng), near(&mut rng), near(&mut rng), Scalar::from_bits(rng.between(20_000, 90_000))]
    });
    let vertices = Vertices::new(Positions::Homogeneous(&corners));
    let mesh = Mesh::new(MeshData { topology: Topology::Fan, ..MeshData::new(vertices.positions) });
    let mesh = mesh.expect("six vertices");
    let lines = Lines::new(vertices, LineTopology::Strip, None).expect("six vertices");
    let points = Points::new(vertices).expect("six vertices");
    let (mut changed, mut short, mut whole) = (0, 0, 0);
    for _ in 0..1500 {
        let (seed, words, rows) = (rng.next_u64(), rng.pick(&[0, 60, 400, 5000]), rng.pick(&[1, 2, 5, 19]));
        let (kinds, lengths) = (1 + rng.below(3), rng.one_in(2));
        table.case("a frame of changes", (seed, words, rows, kinds), || {
            let mut color = vec![0; WIDTH as usize * rows];
            let (mut depth, mut records) = (vec![0; WIDTH as usize * rows], vec![0; words]);
            let renderer = Renderer::<Rgb565>::new(SCREEN).expect("a screen").with_depth(&mut depth).expect("a strip");
            let mut renderer = renderer.with_records(&mut records);
            let mut rng = Rng::new(seed);
            for _ in 0..3 {
                let mut frame = renderer.begin(Rgb888::BLACK);
                loop {
                    let length =
                        if lengths && rng.one_in(4) { rng.below(color.len() as u64 + 1) as usize } else { color.len() };
                    let draw_seed = rng.next_u64();
                    let mut calls = 0;
                    let strip = frame.next_strip(&mut color[..length], |scene| {
                        calls += 1;
                        draw_all(scene, seed ^ (draw_seed.wrapping_add(calls) % kinds), &mesh, &lines, &points);
                    });
                    match strip {
                        Ok(Some(_)) => whole += 1,
                        Ok(None) => break,
                        Err(FrameError::SceneChanged { .. }) => changed += 1,
                        Err(_) => short += 1,
                    }
                    // Some frames are dropped.
                    if rng.one_in(40) {
                        break;
                    }
                }
            }
        });
    }
    println!("{whole} strips, {changed} changes, {short} short buffers");
    assert!(whole > 1000 && changed > 100 && short > 100, "{whole} {changed} {short}");
    table.finish();
}

/// A display that forgets what it is sent, or fails.
struct Sieve(bool);

impl OriginDimensions for Sieve {
    fn size(&self) -> Size {
        Size::new(u32::MAX, u32::MAX)
    }
}

impl DrawTarget for Sieve {
    type Color = Rgb565;
    type Error = ();

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(&mut self, pixels: I) -> Result<(), ()> {
        let _ = pixels.into_iter().count();
        if self.0 { Err(()) } else { Ok(()) }
    }
}

#[test]
fn frames_are_sent_to_any_place_of_a_display() {
    let (mut table, mut rng) = (Table::start(), Rng::new(109));
    for round in 0..400 {
        let (at, mut display) = (Point::new(rng.bits(), rng.bits()), Sieve(round % 5 == 0));
        table.case("Renderer::frame_at", at, || {
            let mut color = [0; 16 * 3];
            let mut renderer = Renderer::<Rgb565>::new(Size::new(16, 8)).expect("a screen");
            let _ = renderer.frame_at(&mut display, at, &mut color, Rgb888::RED, |_| ());
            let view = FrameView::new(&mut renderer, &mut color, at, Rgb888::RED, |_| ());
            assert_eq!(view.bounding_box().top_left, at);
            let _ = view.draw(&mut display);
            let _ = FrameView::new(&mut renderer, &mut [], at, Rgb888::RED, |_| ()).draw(&mut display);
        });
        let dither = Dither::<BinaryColor>::BAYER_8;
        table.case("DitheredDisplay", at, || {
            let mut panel = Panel;
            let mut renderer = Renderer::<Gray8>::new(Size::new(16, 8)).expect("a screen");
            renderer.frame_to(DitheredDisplay::new(&mut panel, dither), &mut [0; 16 * 3], Rgb888::RED, |_| ()).is_ok()
        });
    }
    table.finish();
}

/// A panel of two colours.
struct Panel;

impl OriginDimensions for Panel {
    fn size(&self) -> Size {
        Size::new(16, 8)
    }
}

impl DrawTarget for Panel {
    type Color = BinaryColor;
    type Error = core::convert::Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<BinaryColor>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
        let _ = pixels.into_iter().count();
        Ok(())
    }
}
