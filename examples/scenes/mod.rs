//! Scenes that the examples, the firmware and the tests share: the same geometry, and so the same picture, everywhere.
//!
//! All meshes are constants, computed by the compiler with the crate's own integer sine, and live in flash. Those that take
//! it long are behind functions, with constants of their own: they are computed for the programs that draw them.
#![allow(dead_code)] // each program uses its part
#![allow(long_running_const_eval)] // a landscape is computed

pub mod dashboard;
pub mod formats;
pub mod horizon;
pub mod kept;
pub mod labels;
pub mod landscape;
pub mod light;
pub mod overlay;
pub mod polygons;
pub mod pot;
pub mod soup;
pub mod textured;
pub mod tiles;
pub mod torus;
pub mod water;
pub mod wires;

use kept::kept;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
use zstrip::frame::Renderer;
use zstrip::light::{Material, Matte, Sun, Sunlit};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::shader::{Flat, Gouraud};
use zstrip::span::Shader;
use zstrip::target::{Stats, Strip};
use zstrip::target::{WithDepth, WithRecords};
use zstrip::{Cull, Framebuffer, Scene, State};

/// Something to draw.
#[derive(Clone, Copy)]
pub struct SceneInfo {
    /// Its name on the command line and in reports.
    pub name: &'static str,
    /// Draws it, turned by an angle, on a screen of some size.
    pub draw: fn(&mut Scene<'_, Strip<'_, Rgb565, WithDepth, WithRecords>>, Angle16),
}

/// Scenes of plain meshes, which the flash of a small chip holds, too; the first two are a torus flat and Gouraud shaded.
const PLAIN: [SceneInfo; 11] = [
    SceneInfo { name: "torus_flat", draw: |scene, turn| torus_flat(scene, turn) },
    SceneInfo { name: "torus_gouraud", draw: |scene, turn| torus_gouraud(scene, turn) },
    SceneInfo { name: "room", draw: |scene, turn| room(scene, turn) },
    SceneInfo { name: "intersections", draw: |scene, turn| intersections(scene, turn) },
    SceneInfo { name: "soup", draw: |scene, turn| soup(scene, turn) },
    SceneInfo { name: "far", draw: |scene, turn| far(scene, turn) },
    SceneInfo { name: "near", draw: |scene, turn| near(scene, turn) },
    SceneInfo { name: "tiny", draw: |scene, turn| tiny(scene, turn) },
    SceneInfo { name: "cycle", draw: |scene, turn| cycle(scene, turn) },
    SceneInfo { name: "slivers", draw: |scene, turn| slivers(scene, turn) },
    SceneInfo { name: "field", draw: |scene, turn| field(scene, turn) },
];

/// All the others.
const OTHERS: &[SceneInfo] = if cfg!(any(small_ram = "bare", small_ram = "records")) { &[] } else { MANY };
const MANY: &[SceneInfo] = &[
    SceneInfo { name: "wires", draw: |scene, turn| wires::wires(scene, turn) },
    SceneInfo {
        name: "crates",
        draw: |scene, turn| textured::crates(scene, turn, textured::Look { bilinear: true, mips: true }),
    },
    SceneInfo { name: "close", draw: |scene, turn| textured::close(scene, turn) },
    SceneInfo { name: "water", draw: |scene, turn| water::water(scene, turn, 1) },
    SceneInfo { name: "horizon", draw: |scene, turn| horizon::horizon(scene, turn + turn, turn + Angle16(2000)) },
    SceneInfo { name: "overlay", draw: |scene, turn| overlay::draw(scene, turn) },
    // Text and shapes of embedded-graphics can panic: they stay out of the image that proves that nothing else can.
    #[cfg(not(proof = "all"))]
    SceneInfo { name: "dashboard", draw: |scene, turn| dashboard::draw(scene, turn) },
    #[cfg(not(proof = "all"))]
    SceneInfo { name: "labels", draw: |scene, turn| labels::draw(scene, turn) },
    SceneInfo { name: "phong", draw: |scene, turn| light::phong(scene, turn, light::Shading::PerFragmentNear) },
    SceneInfo { name: "fog", draw: |scene, turn| light::fog(scene, turn, light::Mist::Squared) },
    SceneInfo { name: "glass", draw: |scene, turn| light::glass(scene, turn) },
];

/// All scenes that there is room for.
pub const SCENES: &[SceneInfo] = &{
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

// What is on the stack while something is drawn is there in addition to all that drawing takes. So matrices and materials are
// made in functions that are never inlined, what they are made of is gone when they are used, and they are kept elsewhere.

/// A call that is not inlined: its result is made where it is to be.
#[inline(never)]
fn in_place<T>(make: impl FnOnce() -> T) -> T {
    make()
}

/// A camera with a vertical field of view of 60 degrees.
#[inline(never)]
pub fn camera(screen: Size, near: Scalar, far: Scalar) -> Projective {
    Projective::perspective(Angle16::from_degrees(60), screen, near, far).unwrap_or(Projective::IDENTITY)
}

/// Object space → clip space: the camera of most scenes, and what it is multiplied by.
#[inline(never)]
fn seen(screen: Size, times: impl FnOnce(Projective) -> Projective) -> Projective {
    times(camera(screen, Scalar::ONE, Scalar::from_bits(12 << 16)))
}

/// White light from the upper right, behind the viewer, beside a dim ambient one; in eye space.
pub const LIGHT: Sun = Sun::from_channels(Vec3::from_milli(400, 700, 600), [217; 3], [38; 3]);

/// Colours of the vertices under [`LIGHT`].
pub const LIT_COLORS: Sunlit = LIGHT.on(&Matte::WHITE.vertex_colors(), &Affine::IDENTITY);

/// Colours of the mesh under [`LIGHT`], as they are in flat triangles, and without any light.
static LIT: Flat<Sunlit> = Flat::new(LIT_COLORS);
static UNLIT: Gouraud = Gouraud::vertex_colors();

/// Where the torus is: tumbling, since a turn about its axis would not show.
pub fn torus_model(turn: Angle16) -> Affine {
    Affine::translation(Vec3::from_ints(0, 0, -3))
        * Affine::rotation_x(Angle16::from_degrees(40))
        * Affine::rotation_y(turn)
        * Affine::rotation_z(turn)
}

/// Draws the torus with a shader made for its surface, of a colour under [`LIGHT`].
pub fn torus_with<F: Framebuffer, S: Shader<F::Format>>(
    scene: &mut Scene<'_, F>,
    turn: Angle16,
    color: Rgb888,
    shader: impl FnOnce(Sunlit) -> S,
) {
    let mvp = kept(|| seen(scene.screen(), |camera| camera * torus_model(turn)));
    scene.draw(&torus::MESH, &mvp, &in_place(|| shader(LIGHT.on(&Material::matte(color), &torus_model(turn)))));
}

/// Orange.
pub const TORUS_COLOR: Rgb888 = Rgb888::new(255, 160, 64);

pub fn torus_flat<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    torus_with(scene, turn, TORUS_COLOR, Flat::new);
}

pub fn torus_gouraud<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    torus_with(scene, turn, TORUS_COLOR, Gouraud::new);
}

/// Camera of the room: in a corner of it, with walls that pass through the near plane and far outside of the view. It
/// looks to and fro, by 40 degrees.
#[inline(never)]
pub fn room_camera(screen: Size, turn: Angle16) -> Projective {
    let eye = Vec3::from_milli(-1500, 300, 1500);
    let sway = Angle16((turn.sin().to_bits() / 9) as u16);
    let view = Affine::rotation_y(sway + Angle16::from_degrees(40)) * Affine::translation(-eye);
    camera(screen, Scalar::from_bits(1 << 13), Scalar::from_bits(16 << 16)) * view
}

/// Takes what a model matrix brings into the room to clip space.
#[inline(never)]
fn in_room(screen: Size, turn: Angle16, model: impl FnOnce() -> Affine) -> Projective {
    room_camera(screen, turn) * model()
}

/// A room seen from inside, with a chequered floor, a pillar and a torus of half its size.
pub fn room<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    walls(scene, turn);
    pillar(scene, turn);
    ring(scene, turn);
}

#[inline(never)]
fn walls<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    let mvp = kept(|| room_camera(scene.screen(), turn));
    scene.draw(&polygons::ROOM, &mvp, &UNLIT);
    scene.draw(&polygons::FLOOR, &mvp, &LIT);
}

#[inline(never)]
fn pillar<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    let mvp = kept(|| in_room(scene.screen(), turn, || Affine::translation(Vec3::from_milli(800, 0, -600))));
    scene.draw(&polygons::PILLAR, &mvp, &LIT);
}

#[inline(never)]
fn ring<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    let model = || Affine::translation(Vec3::from_milli(-600, -250, -700)) * Affine::rotation_x(turn + turn + turn);
    let mvp = kept(|| in_room(scene.screen(), turn, || model() * Affine::scale(Scalar::from_bits(1 << 15))));
    let shader = kept(|| Gouraud::new(LIGHT.on(&Material::matte(Rgb888::new(90, 200, 120)), &model())));
    scene.draw(&torus::MESH, &mvp, &*shader);
}

const BOTH_SIDES: State = State { cull: Cull::None, ..State::DEFAULT };

/// Three squares through one another.
pub fn intersections<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    let mvp = kept(|| {
        seen(scene.screen(), |camera| {
            camera
                * Affine::translation(Vec3::from_ints(0, 0, -3))
                * Affine::rotation_x(Angle16::from_degrees(40))
                * Affine::rotation_y(turn + Angle16::from_degrees(25))
        })
    });
    scene.draw_with(BOTH_SIDES, &polygons::CROSSING, &mvp, &LIT);
}

/// Random triangles of all sizes around the eye.
pub fn soup<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    let mvp = kept(|| seen(scene.screen(), |camera| camera * Affine::rotation_y(turn)));
    scene.draw_with(BOTH_SIDES, &soup::SOUP, &mvp, &UNLIT);
}

/// [`seen`] so far away, turned on the screen.
fn turned_at(screen: Size, distance: i16, turn: Angle16) -> Projective {
    seen(screen, |camera| camera * Affine::translation(Vec3::from_ints(0, 0, -distance)) * Affine::rotation_z(turn))
}

/// Triangles whose vertices are up to 30,000 px outside of the screen.
pub fn far<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    let mvp = kept(|| turned_at(scene.screen(), 4, turn));
    scene.draw_with(BOTH_SIDES, &soup::FAR, &mvp, &UNLIT);
}

/// Triangles in clip space, cut by the near plane or with vertices behind the eye.
pub fn near<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    scene.draw_with(BOTH_SIDES, &soup::NEAR, &kept(|| turned(turn)), &UNLIT);
}

#[inline(never)]
fn turned(turn: Angle16) -> Projective {
    Projective::from(Affine::rotation_z(turn))
}

/// Many triangles of about 2 px.
pub fn tiny<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    let mvp = kept(|| turned_at(scene.screen(), 4, turn));
    scene.draw_with(BOTH_SIDES, soup::tiny(), &mvp, &LIT);
}

/// Three planks that each cover the next one: no order of drawing is right, only depth is.
pub fn cycle<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    let mvp = kept(|| turned_at(scene.screen(), 3, turn));
    scene.draw(&polygons::CYCLE, &mvp, &UNLIT);
}

/// Long triangles thinner than a pixel.
pub fn slivers<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    let mvp = kept(|| turned_at(scene.screen(), 3, turn));
    scene.draw_with(BOTH_SIDES, &soup::SLIVERS, &mvp, &UNLIT);
}

/// A grid, a strip, a fan and quads side by side.
pub fn field<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    let mvp = kept(|| {
        seen(scene.screen(), |camera| {
            camera
                * Affine::translation(Vec3::from_ints(0, 0, -3))
                * Affine::rotation_x(Angle16::from_degrees(-20))
                * Affine::rotation_z(turn)
        })
    });
    for mesh in [&polygons::GRID, &polygons::STRIP, &polygons::FAN, &polygons::QUADS] {
        scene.draw_with(BOTH_SIDES, mesh, &mvp, &UNLIT);
    }
}

/// What a rendered scene was like.
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
    frame([width, height], color, depth, records, |scene| (info.draw)(scene, Angle16(turn)), &mut sink)
}

/// Renders what a closure draws.
pub fn frame(
    [width, height]: [usize; 2],
    color: &mut [u16],
    depth: &mut [u16],
    records: &mut [u32],
    mut draw: impl FnMut(&mut Scene<'_, Strip<'_, Rgb565, WithDepth, WithRecords>>),
    sink: &mut impl FnMut(usize, &[u16]),
) -> Stats {
    let screen = Size::new(width as u32, height as u32);
    let mut renderer = in_place(|| {
        Renderer::<Rgb565>::new(screen)
            .and_then(|renderer| renderer.with_depth(depth))
            .map(|renderer| renderer.with_records(records))
    });
    let Ok(renderer) = &mut renderer else { return Stats::default() };
    let mut frame = renderer.begin(BACKGROUND);
    loop {
        match frame.next_strip(color, &mut draw) {
            Ok(Some(strip)) => sink(strip.area().top_left.y as usize, strip.pixels()),
            Ok(None) => return frame.stats(),
            Err(_) => return Stats::default(),
        }
    }
}
