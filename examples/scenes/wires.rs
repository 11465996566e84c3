//! Lines and points in space: a wireframe with its hidden lines removed, axes, a cloud of points.

use super::{Draw, Rgb888, torus, torus_model, usual_camera};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::math::{Angle16, Pixels, Projective, Scalar, Vec3};
use zstrip::mesh::{LineTopology, Lines, Points, Positions, Vertices};
use zstrip::shader::{DepthOnly, Flat, Gouraud};
use zstrip::span::{Compare, DepthBias, DepthState};
use zstrip::{Dashed, Framebuffer, Scene, Smooth, State, Thick, Thin};

/// Three axes from the origin, as long as the torus is wide.
pub static AXES: Lines<'static> = Lines::constant(
    Vertices {
        colors: Some(&[[90, 20, 20], [255, 60, 60], [20, 90, 20], [60, 255, 60], [30, 40, 110], [80, 120, 255]]),
        ..Vertices::new(Positions::Exact(&[
            Vec3::from_milli(-1600, 0, 0),
            Vec3::from_milli(1600, 0, 0),
            Vec3::from_milli(0, -1600, 0),
            Vec3::from_milli(0, 1600, 0),
            Vec3::from_milli(0, 0, -1600),
            Vec3::from_milli(0, 0, 1600),
        ]))
    },
    LineTopology::Pairs,
    None,
);

/// How many points there are.
const POINTS: usize = 60;

/// A spiral around the torus.
const fn spiral() -> [Vec3; POINTS] {
    let mut points = [Vec3::ZERO; POINTS];
    let mut k = 0;
    while k < POINTS {
        let around = Angle16((k * 65_536 / POINTS) as u16);
        let across = Angle16((7 * k * 65_536 / POINTS) as u16);
        let ring = 65_536 + (across.cos().to_bits() as i64 * 3) / 5;
        let (x, z) = (around.cos().to_bits() as i64 * ring, around.sin().to_bits() as i64 * ring);
        points[k] = Vec3::from_bits([(x >> 16) as i32, across.sin().to_bits() / 5 * 3, (z >> 16) as i32]);
        k += 1;
    }
    points
}

/// The points of a spiral around the torus.
pub static SPIRAL: Points<'static> = Points::constant(Vertices::new(Positions::Exact(&SPIRAL_POINTS)));
static SPIRAL_POINTS: [Vec3; POINTS] = spiral();

/// A line through them.
static THREAD: Lines<'static> =
    Lines::constant(Vertices::new(Positions::Exact(&SPIRAL_POINTS)), LineTopology::Loop, None);

/// Surfaces are pushed back, by a step and by what their depth changes over a pixel, so that lines on them are seen.
pub const BEHIND_LINES: State = State { bias: DepthBias { constant: 1, slope: Scalar::ONE }, ..State::DEFAULT };

/// Lines that lie behind something.
const HIDDEN: State = State { depth: DepthState { compare: Compare::Greater, write: false }, ..State::DEFAULT };

/// The torus as a wireframe, with hidden lines removed, its axes, and points around it.
pub struct Wires(Projective);

impl Wires {
    pub fn new(screen: Size, turn: Angle16) -> Self {
        Self(usual_camera(screen) * torus_model(turn))
    }
}

impl<F: Framebuffer> Draw<F> for Wires {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        let Self(mvp) = self;
        // Depths first: they hide the lines at the back.
        scene.draw_with(BEHIND_LINES, &torus::MESH, mvp, &DepthOnly);
        scene.draw_lines(torus::lines(), mvp, &Flat::unlit(Rgb888::new(150, 220, 255)), &Thin);
        scene.draw_lines(&AXES, mvp, &Gouraud::vertex_colors(), &Thick::px(2));
        scene.draw_lines_with(HIDDEN, &AXES, mvp, &Flat::vertex_colors(), &Dashed::EVEN);
        scene.draw_points(&SPIRAL, mvp, &Flat::unlit(Rgb888::new(255, 200, 60)), Pixels::from_num(3));
        let blended = State { depth: DepthState { compare: Compare::Less, write: false }, ..State::DEFAULT };
        scene.draw_lines_with(blended, &THREAD, mvp, &Flat::unlit(Rgb888::new(255, 120, 60)), &Smooth::px(1));
    }
}
