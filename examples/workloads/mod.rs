//! The benchmark's workloads, W1 to W6, W9 and W10, and how each is drawn.
//!
//! The geometry is stated in a left-handed view space: x right, y up, z forward, F = 120 / tan 30° px,
//! screen x = 160 + F x / z, screen y = 120 - F y / z, front faces counter-clockwise on the screen. Here a camera looks
//! along -z, so z changes its sign on the way into it; that mirrors space and camera together, and so nothing on the
//! screen, windings included.
//!
//! The compiler computes all of it, in `f64`: programs contain integers only.
#![allow(dead_code)] // each program uses its part
#![allow(long_running_const_eval)] // 30,000 vertices are made

mod numbers;
pub mod price;
mod quads;
#[cfg(not(target_os = "none"))]
pub mod reference;
mod shaders;
pub mod spot;
mod tiny;
mod torus;

use numbers::{nearest, root, vector};
pub use quads::*;
use shaders::{FaceColors, OwnFlat, OwnGouraud};
pub use tiny::*;
pub use torus::*;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
use zstrip::frame::{Renderer, RendererError};
use zstrip::light::{Matte, Sun, Sunlit};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::shader::{Flat, Gouraud, Textured};
use zstrip::span::DepthState;
use zstrip::target::RecordsChoice;
use zstrip::target::WithDepth;
use zstrip::target::{Stats, Strip};
use zstrip::{Scene, State};

pub const WIDTH: usize = 320;
pub const HEIGHT: usize = 240;
/// Cyan, which no picture has.
pub const BACKGROUND: Rgb565 = Rgb565::new(0, 63, 31);

/// Pixels per unit of x / z: 120 / tan 30°.
pub const FOCAL: f64 = 120.0 * root(3.0);

const NEAR: Scalar = Scalar::ONE;
const FAR: Scalar = Scalar::from_bits(16 << 16);

/// What to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Workload {
    /// Nothing: what it costs to clear colours and depths and to hand out the strips.
    Empty,
    /// A quad that covers the screen, one colour, no depth.
    Quad,
    /// The same quad, depth test and write, Gouraud colours.
    GouraudQuad,
    /// The same quad in one colour, depth test and write.
    FlatQuad,
    /// The same again, by a shader of one's own.
    OwnFlatQuad,
    /// The quad in Gouraud colours, by a shader of one's own.
    OwnGouraudQuad,
    /// A quad tilted by 60°, with a texture of 64 x 64 texels, perspective-correct; depth test and write.
    TexturedQuad,
    /// A torus of 1,024 triangles, flat.
    FlatTorus,
    /// The same torus, lit at its vertices.
    GouraudTorus,
    /// 10,000 triangles of about 2 px, one colour each.
    Tiny,
    /// Nothing, on the screen of the next two.
    EmptySpot,
    /// A cow of 5,856 triangles, textured under light.
    TexturedSpot,
    /// The same cow, flat.
    FlatSpot,
}

/// The memory of a frame.
pub struct Buffers<'b> {
    pub color: &'b mut [u16],
    pub depth: &'b mut [u16],
    pub records: &'b mut [u32],
}

impl Workload {
    /// Returns the columns of the screen; all have [`HEIGHT`] rows.
    pub const fn width(self) -> usize {
        match self {
            Self::EmptySpot | Self::TexturedSpot | Self::FlatSpot => spot::SIDE,
            _ => WIDTH,
        }
    }
}

/// Draws a frame of a workload; the strip is as high as the buffers.
pub fn draw(workload: Workload, buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    match workload {
        Workload::Empty => frame(buffers, &mut sink, &mut |_| {}),
        Workload::Quad => quad(buffers, sink),
        Workload::GouraudQuad => gouraud_quad(buffers, sink),
        Workload::FlatQuad => flat_quad(buffers, sink),
        Workload::OwnFlatQuad => own_flat_quad(buffers, sink),
        Workload::OwnGouraudQuad => own_gouraud_quad(buffers, sink),
        Workload::TexturedQuad => textured_quad(buffers, sink),
        Workload::FlatTorus => flat_torus(buffers, sink),
        Workload::GouraudTorus => gouraud_torus(buffers, sink),
        Workload::Tiny => tiny(buffers, sink),
        Workload::EmptySpot => spot::empty(buffers, sink),
        Workload::TexturedSpot => spot::textured(buffers, sink),
        Workload::FlatSpot => spot::flat(buffers, sink),
    }
}

const SCREEN: Size = Size::new(WIDTH as u32, HEIGHT as u32);

/// What renderers have beside depths.
#[cfg(not(carries))]
type Lent = zstrip::target::WithRecords;
#[cfg(carries)]
type Lent = zstrip::target::WithCarriedState;

/// The closure of a frame, called through a pointer.
type DrawScene<'d> = dyn FnMut(&mut Scene<'_, Strip<'_, Rgb565, WithDepth, Lent>>) + 'd;

#[inline(always)]
fn frame(buffers: Buffers<'_>, sink: &mut dyn FnMut(&[u16]), draw: &mut DrawScene<'_>) -> Stats {
    frame_on(SCREEN, buffers, sink, draw)
}

/// One function for all workloads, as a program has that shows several things.
#[inline(never)]
fn frame_on(screen: Size, buffers: Buffers<'_>, sink: &mut dyn FnMut(&[u16]), draw: &mut DrawScene<'_>) -> Stats {
    let Buffers { color, depth, records } = buffers;
    let renderer = Renderer::new(screen).and_then(|renderer| renderer.with_depth(depth));
    let renderer = renderer.map(|renderer| renderer.with_records(records));
    #[cfg(carries)]
    let renderer = renderer.map(|renderer| renderer.with_carried_state());
    frame_by(renderer, color, sink, draw)
}

/// Buffers that do not hold a row draw nothing.
fn frame_by<R: RecordsChoice>(
    mut renderer: Result<Renderer<'_, Rgb565, WithDepth, R>, RendererError>,
    color: &mut [u16],
    mut sink: impl FnMut(&[u16]),
    mut draw: impl FnMut(&mut Scene<'_, Strip<'_, Rgb565, WithDepth, R>>),
) -> Stats {
    let Ok(renderer) = &mut renderer else { return Stats::default() };
    let mut frame = renderer.begin(BACKGROUND);
    while let Ok(Some(strip)) = frame.next_strip(color, &mut draw) {
        sink(strip.pixels());
    }
    frame.stats()
}

#[inline(never)]
pub fn quad(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    const OVER: State = State { depth: DepthState::OFF, ..State::DEFAULT };
    let [r, g, b] = QUAD_COLOR;
    let shader = Flat::unlit(Rgb888::new(r, g, b));
    frame(buffers, &mut sink, &mut |scene| scene.draw_with(OVER, &QUAD, &IN_VIEW, &shader))
}

#[inline(never)]
pub fn gouraud_quad(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    frame(buffers, &mut sink, &mut |scene| scene.draw(&QUAD, &IN_VIEW, &Gouraud::vertex_colors()))
}

#[inline(never)]
pub fn flat_quad(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    let [r, g, b] = QUAD_COLOR;
    frame(buffers, &mut sink, &mut |scene| scene.draw(&QUAD, &IN_VIEW, &Flat::unlit(Rgb888::new(r, g, b))))
}

#[inline(never)]
pub fn own_flat_quad(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    frame(buffers, &mut sink, &mut |scene| scene.draw(&QUAD, &IN_VIEW, &OwnFlat))
}

#[inline(never)]
pub fn own_gouraud_quad(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    frame(buffers, &mut sink, &mut |scene| scene.draw(&QUAD, &IN_VIEW, &OwnGouraud))
}

#[inline(never)]
pub fn textured_quad(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    frame(buffers, &mut sink, &mut |scene| scene.draw(&TILTED, &IN_VIEW, &Textured::new(&TEXTURE)))
}

#[inline(never)]
pub fn flat_torus(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    let shader = Flat::new(TORUS_SURFACE);
    frame(buffers, &mut sink, &mut |scene| scene.draw(&TORUS, &OF_TORUS, &shader))
}

/// The same by a renderer that knows no records.
#[inline(never)]
pub fn flat_torus_without_records(color: &mut [u16], depth: &mut [u16], sink: impl FnMut(&[u16])) {
    let shader = Flat::new(TORUS_SURFACE);
    let renderer = Renderer::new(SCREEN).and_then(|renderer| renderer.with_depth(depth));
    frame_by(renderer, color, sink, |scene| scene.draw(&TORUS, &OF_TORUS, &shader));
}

#[inline(never)]
pub fn gouraud_torus(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    let shader = Gouraud::new(TORUS_SURFACE);
    frame(buffers, &mut sink, &mut |scene| scene.draw(&TORUS, &OF_TORUS, &shader))
}

#[inline(never)]
pub fn tiny(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    let shader = FaceColors(Flat::unlit(Rgb888::new(0, 0, 0)));
    frame(buffers, &mut sink, &mut |scene| scene.draw(tiny_mesh(), &IN_VIEW, &shader))
}

/// The compiler makes it: 128-bit arithmetic stays out of the firmware.
const CAMERA: Projective = {
    match Projective::perspective(Angle16::from_degrees(60), Size::new(WIDTH as u32, HEIGHT as u32), NEAR, FAR) {
        Ok(camera) => camera,
        Err(_) => panic!("not a camera"),
    }
};

/// Where workloads are that are given in the camera's own space, and the torus.
const IN_VIEW: Projective = CAMERA.compose_affine(&MIRROR);
const OF_TORUS: Projective = CAMERA.compose_affine(&MODEL);

/// The torus under its light.
const TORUS_SURFACE: Sunlit = {
    let [ambient, diffuse] = [nearest(AMBIENT * 255.0) as u8, nearest(DIFFUSE * 255.0) as u8];
    let direction = vector([LIGHT[0], LIGHT[1], -LIGHT[2]]);
    Sun::from_channels(direction, [diffuse; 3], [ambient; 3]).on(&Matte::from_channels(TORUS_COLOR), &MODEL)
};

fn torus_color() -> Rgb888 {
    let [r, g, b] = TORUS_COLOR;
    Rgb888::new(r, g, b)
}

/// View space as the workloads have it → view space as the camera has it.
const MIRROR: Affine = Affine::from_rows(Vec3::X, Vec3::Y, Vec3::from_ints(0, 0, -1), Vec3::ZERO);
