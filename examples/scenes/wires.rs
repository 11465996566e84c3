//! Lines and points in space: a wireframe with its hidden lines removed, axes, a cloud of points.

use super::{Rgb888, seen, torus, torus_model};
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

/// The torus as a wireframe, with hidden lines removed.
pub fn wires<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    let mvp = seen(scene.screen(), |camera| camera * torus_model(turn));
    torus_lines(scene, &mvp);
    axes(scene, &mvp);
    hidden_axes(scene, &mvp);
    spiral_points(scene, &mvp);
    thread(scene, &mvp);
}

#[inline(never)]
fn torus_lines<F: Framebuffer>(scene: &mut Scene<'_, F>, mvp: &Projective) {
    scene.draw_with(BEHIND_LINES, &torus::MESH, mvp, &DepthOnly);
    scene.draw_lines(torus::lines(), mvp, &Flat::unlit(Rgb888::new(150, 220, 255)), &Thin);
}

#[inline(never)]
fn axes<F: Framebuffer>(scene: &mut Scene<'_, F>, mvp: &Projective) {
    scene.draw_lines_with(State::DEFAULT, &AXES, mvp, &Gouraud::vertex_colors(), &Thick::px(2));
}

#[inline(never)]
fn hidden_axes<F: Framebuffer>(scene: &mut Scene<'_, F>, mvp: &Projective) {
    scene.draw_lines_with(HIDDEN, &AXES, mvp, &Flat::vertex_colors(), &Dashed::EVEN);
}

#[inline(never)]
fn spiral_points<F: Framebuffer>(scene: &mut Scene<'_, F>, mvp: &Projective) {
    scene.draw_points(&SPIRAL, mvp, &Flat::unlit(Rgb888::new(255, 200, 60)), Pixels::from_num(3));
}

#[inline(never)]
fn thread<F: Framebuffer>(scene: &mut Scene<'_, F>, mvp: &Projective) {
    let blended = State { depth: DepthState { compare: Compare::Less, write: false }, ..State::DEFAULT };
    scene.draw_lines_with(blended, &THREAD, mvp, &Flat::unlit(Rgb888::new(255, 120, 60)), &Smooth::px(1));
}
