//! The scenes that the examples, the firmware and the tests share, so that all of them draw equal pictures.
//!
//! A scene is a struct. Its constructor makes matrices, shaders and lights for one frame, outside of the closure that
//! draws. [`Draw::draw`] only draws: a renderer calls the closure once or twice per strip.
//!
//! All meshes are constants in flash, computed by the compiler with the crate's own integer sine. A mesh that takes the
//! compiler long is behind a function, so that only the programs that draw it wait for it.
#![allow(dead_code)] // each program uses its part
#![allow(long_running_const_eval)] // a landscape is computed

pub mod dashboard;
pub mod formats;
pub mod gauges;
pub mod horizon;
pub mod kept;
pub mod labels;
pub mod landscape;
pub mod leaves;
pub mod light;
pub mod overlay;
pub mod polygons;
pub mod pot;
pub mod shapes;
pub mod soup;
pub mod street;
pub mod textured;
pub mod tiles;
pub mod torus;
pub mod water;
pub mod wires;

use kept::{Kept, kept_drawing};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
use zstrip::frame::Renderer;
use zstrip::light::{Material, Matte, Sun, Sunlit};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::Mesh;
use zstrip::model::Placed;
use zstrip::shader::{Flat, Gouraud, PhongNear, Surface};
use zstrip::span::Shader;
use zstrip::target::{Stats, Strip};
use zstrip::target::{WithDepth, WithRecords};
use zstrip::texture::Bilinear;
use zstrip::{Cull, Framebuffer, Scene, State};

/// Draws what was made for a frame.
pub trait Draw<F: Framebuffer> {
    /// Draws the scene; called for every strip.
    fn draw(&self, scene: &mut Scene<'_, F>);
}

impl<F: Framebuffer, S: Surface + Copy> Draw<F> for Placed<'_, S> {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        Placed::draw(self, scene);
    }
}

/// Draws a mesh in a function of its own, which gives its stack back before the next mesh is drawn. Draws that are
/// inlined into one function hold the stack of all of them at once.
#[inline(never)]
fn draw_apart<F: Framebuffer, S: Shader<F::Format>>(
    scene: &mut Scene<'_, F>,
    state: State,
    mesh: &Mesh<'_>,
    mvp: &Projective,
    shader: &S,
) {
    scene.draw_with(state, mesh, mvp, shader);
}

/// The strips that [`frame`] draws into.
pub type Target<'p> = Strip<'p, Rgb565, WithDepth, WithRecords>;

/// A scene, ready to be drawn.
pub type Drawing = dyn for<'p> Draw<Target<'p>>;

/// A scene by its name.
#[derive(Clone, Copy)]
pub struct SceneInfo {
    /// Its name on the command line and in reports.
    pub name: &'static str,
    /// Makes the scene of one frame for a screen of a size, turned by an angle.
    pub make: fn(Size, Angle16) -> Kept<Drawing>,
}

/// Scenes of plain meshes, for the flash of a small chip as well; the first two are a torus, flat and Gouraud shaded.
const PLAIN: [SceneInfo; 11] = [
    SceneInfo { name: "torus_flat", make: |screen, turn| kept_drawing(|| Torus::flat(screen, turn)) },
    SceneInfo { name: "torus_gouraud", make: |screen, turn| kept_drawing(|| Torus::gouraud(screen, turn)) },
    SceneInfo { name: "room", make: |screen, turn| kept_drawing(|| Room::new(screen, turn)) },
    SceneInfo { name: "intersections", make: |screen, turn| kept_drawing(|| Intersections::new(screen, turn)) },
    SceneInfo { name: "soup", make: |screen, turn| kept_drawing(|| Soup::new(screen, turn)) },
    SceneInfo { name: "far", make: |screen, turn| kept_drawing(|| Far::new(screen, turn)) },
    SceneInfo { name: "near", make: |_, turn| kept_drawing(|| Near::new(turn)) },
    SceneInfo { name: "tiny", make: |screen, turn| kept_drawing(|| Tiny::new(screen, turn)) },
    SceneInfo { name: "cycle", make: |screen, turn| kept_drawing(|| Cycle::new(screen, turn)) },
    SceneInfo { name: "slivers", make: |screen, turn| kept_drawing(|| Slivers::new(screen, turn)) },
    SceneInfo { name: "field", make: |screen, turn| kept_drawing(|| Field::new(screen, turn)) },
];

/// All the others.
const OTHERS: &[SceneInfo] = if cfg!(any(small_ram = "bare", small_ram = "records")) { &[] } else { MANY };
const MANY: &[SceneInfo] = &[
    SceneInfo { name: "wires", make: |screen, turn| kept_drawing(|| wires::Wires::new(screen, turn)) },
    SceneInfo {
        name: "crates",
        make: |screen, turn| kept_drawing(|| textured::Crates::new(screen, turn, Bilinear, textured::Levels::All)),
    },
    SceneInfo { name: "close", make: |screen, turn| kept_drawing(|| textured::Close::new(screen, turn)) },
    SceneInfo { name: "water", make: |screen, turn| kept_drawing(|| water::Sea::new(screen, turn, 1)) },
    SceneInfo {
        name: "horizon",
        make: |screen, turn| kept_drawing(|| horizon::Horizon::new(screen, turn + turn, turn + Angle16(2000))),
    },
    // Shapes take more stack than all other scenes, and have an image of their own.
    #[cfg(not(proof = "all"))]
    SHAPES[0],
    SceneInfo { name: "overlay", make: |screen, turn| kept_drawing(|| overlay::Markers::new(screen, turn)) },
    // Text and shapes of embedded-graphics can panic: they stay out of the image that proves that nothing else can.
    #[cfg(not(proof = "all"))]
    SceneInfo { name: "dashboard", make: |_, turn| kept_drawing(|| dashboard::Dashboard::new(turn)) },
    #[cfg(not(proof = "all"))]
    SceneInfo { name: "gauges", make: |_, turn| kept_drawing(|| gauges::Gauges::new(turn)) },
    #[cfg(not(proof = "all"))]
    SceneInfo { name: "labels", make: |screen, turn| kept_drawing(|| labels::Labels::new(screen, turn)) },
    SceneInfo {
        name: "phong",
        make: |screen, turn| kept_drawing(|| light::Night::new(screen, turn, || PhongNear::new(light::glaze(turn)))),
    },
    SceneInfo {
        name: "fog",
        make: |screen, turn| kept_drawing(|| light::Fog::new(screen, turn, light::Mist::Squared)),
    },
    SceneInfo { name: "glass", make: |screen, turn| kept_drawing(|| light::Glass::new(screen, turn)) },
];

const SHAPES: [SceneInfo; 1] =
    [SceneInfo { name: "shapes", make: |screen, turn| kept_drawing(|| shapes::Shapes::new(screen, turn)) }];

/// All scenes that there is room for.
pub const SCENES: &[SceneInfo] = if cfg!(proof = "shapes") { &SHAPES } else { ALL };
const ALL: &[SceneInfo] = &{
    let mut all = [PLAIN[0]; PLAIN.len() + OTHERS.len()];
    let mut k = 1;
    while k < all.len() {
        all[k] = if k < PLAIN.len() { PLAIN[k] } else { OTHERS[k - PLAIN.len()] };
        k += 1;
    }
    all
};

/// Dark blue-grey.
pub const BACKGROUND: Rgb565 = Rgb565::new(3, 7, 3);

/// Returns a camera with a vertical field of view of 60 degrees.
#[inline(never)]
pub fn camera(screen: Size, near: Scalar, far: Scalar) -> Projective {
    Projective::perspective(Angle16::from_degrees(60), screen, near, far).unwrap_or(Projective::IDENTITY)
}

/// Returns the camera of most scenes.
#[inline(never)]
pub fn usual_camera(screen: Size) -> Projective {
    camera(screen, Scalar::ONE, Scalar::from_bits(12 << 16))
}

/// White light from the upper right, behind the viewer, beside a dim ambient one; in eye space.
pub const LIGHT: Sun = Sun::from_channels(Vec3::from_milli(400, 700, 600), [217; 3], [38; 3]);

/// Colours of the vertices under [`LIGHT`].
pub const LIT_COLORS: Sunlit = LIGHT.on(&Matte::WHITE.vertex_colors(), &Affine::IDENTITY);

/// Shaders of the vertices' colours: flat under [`LIGHT`], and interpolated without any light.
static LIT: Flat<Sunlit> = Flat::new(LIT_COLORS);
static UNLIT: Gouraud = Gouraud::vertex_colors();

/// Returns where the torus is: tumbling, since a turn about its axis would not show.
pub fn torus_model(turn: Angle16) -> Affine {
    Affine::translation(Vec3::from_ints(0, 0, -3))
        * Affine::rotation_x(Angle16::from_degrees(40))
        * Affine::rotation_y(turn)
        * Affine::rotation_z(turn)
}

/// The torus, with a shader made for its light.
pub struct Torus<S> {
    mvp: Projective,
    shader: S,
}

impl<S> Torus<S> {
    /// Makes the torus, with a shader made for its surface: a colour under [`LIGHT`].
    pub fn new(screen: Size, turn: Angle16, color: Rgb888, shader: impl FnOnce(Sunlit) -> S) -> Self {
        let model = torus_model(turn);
        Self { mvp: usual_camera(screen) * model, shader: shader(LIGHT.on(&Material::matte(color), &model)) }
    }
}

/// Orange.
pub const TORUS_COLOR: Rgb888 = Rgb888::new(255, 160, 64);

impl Torus<Flat<Sunlit>> {
    pub fn flat(screen: Size, turn: Angle16) -> Self {
        Self::new(screen, turn, TORUS_COLOR, Flat::new)
    }
}

impl Torus<Gouraud<Sunlit>> {
    pub fn gouraud(screen: Size, turn: Angle16) -> Self {
        Self::new(screen, turn, TORUS_COLOR, Gouraud::new)
    }
}

impl<F: Framebuffer, S: Shader<F::Format>> Draw<F> for Torus<S> {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        scene.draw(&torus::MESH, &self.mvp, &self.shader);
    }
}

/// Returns the camera of the room: in one of its corners, with walls that pass through the near plane and reach far
/// outside of the view. It looks to and fro, by 40 degrees.
#[inline(never)]
pub fn room_camera(screen: Size, turn: Angle16) -> Projective {
    let eye = Vec3::from_milli(-1500, 300, 1500);
    let sway = Angle16((turn.sin().to_bits() / 9) as u16);
    let view = Affine::rotation_y(sway + Angle16::from_degrees(40)) * Affine::translation(-eye);
    camera(screen, Scalar::from_bits(1 << 13), Scalar::from_bits(16 << 16)) * view
}

/// A room seen from inside, with a chequered floor, a pillar and a torus of half its size.
pub struct Room {
    walls: Projective,
    pillar: Projective,
    ring: Projective,
    ring_shader: Gouraud<Sunlit>,
}

impl Room {
    pub fn new(screen: Size, turn: Angle16) -> Self {
        let walls = room_camera(screen, turn);
        let ring = Affine::translation(Vec3::from_milli(-600, -250, -700)) * Affine::rotation_x(turn + turn + turn);
        Self {
            walls,
            pillar: walls * Affine::translation(Vec3::from_milli(800, 0, -600)),
            ring: walls * (ring * Affine::scale(Scalar::from_bits(1 << 15))),
            ring_shader: Gouraud::new(LIGHT.on(&Material::matte(Rgb888::new(90, 200, 120)), &ring)),
        }
    }
}

impl<F: Framebuffer> Draw<F> for Room {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        draw_apart(scene, State::DEFAULT, &polygons::ROOM, &self.walls, &UNLIT);
        draw_apart(scene, State::DEFAULT, &polygons::FLOOR, &self.walls, &LIT);
        draw_apart(scene, State::DEFAULT, &polygons::PILLAR, &self.pillar, &LIT);
        draw_apart(scene, State::DEFAULT, &torus::MESH, &self.ring, &self.ring_shader);
    }
}

const BOTH_SIDES: State = State { cull: Cull::None, ..State::DEFAULT };

/// Three squares through one another.
pub struct Intersections(Projective);

impl Intersections {
    pub fn new(screen: Size, turn: Angle16) -> Self {
        let at = usual_camera(screen) * Affine::translation(Vec3::from_ints(0, 0, -3));
        Self(at * Affine::rotation_x(Angle16::from_degrees(40)) * Affine::rotation_y(turn + Angle16::from_degrees(25)))
    }
}

impl<F: Framebuffer> Draw<F> for Intersections {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        scene.draw_with(BOTH_SIDES, &polygons::CROSSING, &self.0, &LIT);
    }
}

/// Random triangles of all sizes around the eye.
pub struct Soup(Projective);

impl Soup {
    pub fn new(screen: Size, turn: Angle16) -> Self {
        Self(usual_camera(screen) * Affine::rotation_y(turn))
    }
}

impl<F: Framebuffer> Draw<F> for Soup {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        scene.draw_with(BOTH_SIDES, &soup::SOUP, &self.0, &UNLIT);
    }
}

/// Returns the matrix of something that is `distance` away and is turned about the view's direction.
fn turned_at(screen: Size, distance: i16, turn: Angle16) -> Projective {
    usual_camera(screen) * Affine::translation(Vec3::from_ints(0, 0, -distance)) * Affine::rotation_z(turn)
}

/// Triangles whose vertices are up to 30,000 px outside of the screen.
pub struct Far(Projective);

impl Far {
    pub fn new(screen: Size, turn: Angle16) -> Self {
        Self(turned_at(screen, 4, turn))
    }
}

impl<F: Framebuffer> Draw<F> for Far {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        scene.draw_with(BOTH_SIDES, &soup::FAR, &self.0, &UNLIT);
    }
}

/// Triangles in clip space, cut by the near plane or with vertices behind the eye.
pub struct Near(Projective);

impl Near {
    pub fn new(turn: Angle16) -> Self {
        Self(Projective::from(Affine::rotation_z(turn)))
    }
}

impl<F: Framebuffer> Draw<F> for Near {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        scene.draw_with(BOTH_SIDES, &soup::NEAR, &self.0, &UNLIT);
    }
}

/// Many triangles of about 2 px.
pub struct Tiny(Projective);

impl Tiny {
    pub fn new(screen: Size, turn: Angle16) -> Self {
        Self(turned_at(screen, 4, turn))
    }
}

impl<F: Framebuffer> Draw<F> for Tiny {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        scene.draw_with(BOTH_SIDES, soup::tiny(), &self.0, &LIT);
    }
}

/// Three planks that each cover the next one: no order of drawing is right, only depth is.
pub struct Cycle(Projective);

impl Cycle {
    pub fn new(screen: Size, turn: Angle16) -> Self {
        Self(turned_at(screen, 3, turn))
    }
}

impl<F: Framebuffer> Draw<F> for Cycle {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        scene.draw(&polygons::CYCLE, &self.0, &UNLIT);
    }
}

/// Long triangles thinner than a pixel.
pub struct Slivers(Projective);

impl Slivers {
    pub fn new(screen: Size, turn: Angle16) -> Self {
        Self(turned_at(screen, 3, turn))
    }
}

impl<F: Framebuffer> Draw<F> for Slivers {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        scene.draw_with(BOTH_SIDES, &soup::SLIVERS, &self.0, &UNLIT);
    }
}

/// A grid, a strip, a fan and quads side by side.
pub struct Field(Projective);

impl Field {
    pub fn new(screen: Size, turn: Angle16) -> Self {
        let at = usual_camera(screen) * Affine::translation(Vec3::from_ints(0, 0, -3));
        Self(at * Affine::rotation_x(Angle16::from_degrees(-20)) * Affine::rotation_z(turn))
    }
}

impl<F: Framebuffer> Draw<F> for Field {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        for mesh in [&polygons::GRID, &polygons::STRIP, &polygons::FAN, &polygons::QUADS] {
            scene.draw_with(BOTH_SIDES, mesh, &self.0, &UNLIT);
        }
    }
}

/// The hash and the counters of a frame.
pub struct Report {
    /// FNV-1a 64 of all bytes of the frame, row by row, RGB565 with the low byte first.
    pub hash: u64,
    /// Counters of all stages.
    pub stats: Stats,
}

/// Renders a scene at 320×240 into strips with the lent buffers, and hashes them.
pub fn render(index: usize, color: &mut [u16], depth: &mut [u16], records: &mut [u32]) -> Report {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let stats = draw(index, 0, [320, 240], color, depth, records, |_, strip| {
        for byte in strip.iter().flat_map(|p| p.to_le_bytes()) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        }
    });
    Report { hash, stats }
}

/// Renders a scene, turned by the binary angle `turn`, at any size, and hands each strip to `sink` with its first row,
/// from the top down. Buffers that do not hold a row draw nothing.
pub fn draw(
    index: usize,
    turn: u16,
    [width, height]: [usize; 2],
    color: &mut [u16],
    depth: &mut [u16],
    records: &mut [u32],
    mut sink: impl FnMut(usize, &[u16]),
) -> Stats {
    let Some(info) = SCENES.get(index) else {
        return Stats::default();
    };
    let screen = Size::new(width as u32, height as u32);
    let drawing = (info.make)(screen, Angle16(turn));
    frame(screen, color, depth, records, &*drawing, &mut sink)
}

/// Calls a function that is not inlined, so that its temporaries leave the stack before a frame is drawn.
#[inline(never)]
fn in_place<T>(make: impl FnOnce() -> T) -> T {
    make()
}

/// Renders one frame of a scene.
fn frame(
    screen: Size,
    color: &mut [u16],
    depth: &mut [u16],
    records: &mut [u32],
    drawing: &Drawing,
    sink: &mut impl FnMut(usize, &[u16]),
) -> Stats {
    let mut renderer = in_place(|| {
        Renderer::<Rgb565>::new(screen)
            .and_then(|renderer| renderer.with_depth(depth))
            .map(|renderer| renderer.with_records(records))
    });
    let Ok(renderer) = &mut renderer else { return Stats::default() };
    let mut frame = renderer.begin(BACKGROUND);
    loop {
        match frame.next_strip(color, |scene| drawing.draw(scene)) {
            Ok(Some(strip)) => sink(strip.area().top_left.y as usize, strip.pixels()),
            Ok(None) => return frame.stats(),
            Err(_) => return Stats::default(),
        }
    }
}
