//! The scene: a tumbling torus, lit at its vertices.
//!
//! It knows nothing of the board, so a host can draw the picture from this file that the board's picture is compared
//! with.

use zstrip::Framebuffer;
use zstrip::Scene;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, WebColors};
use zstrip::light::{Material, Sun, Sunlit};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
use zstrip::shader::Gouraud;

/// The screen.
pub const SIZE: Size = Size::new(240, 240);

/// The colour where nothing is drawn.
pub const BACKGROUND: Rgb888 = Rgb888::new(24, 28, 24);

/// Angle by which the torus turns from one frame to the next, in 65,536ths of a turn.
pub const TURN: u16 = 1024;

/// The matrix and the shader of a frame.
///
/// They are made once per frame, outside of the closure that draws: the closure is called once or twice per strip, and
/// would make them anew each time.
pub struct View {
    mvp: Projective,
    shader: Gouraud<Sunlit>,
}

impl View {
    /// Makes the view of a frame by its number.
    pub fn new(frame: u16) -> Self {
        let turn = Angle16(frame.wrapping_mul(TURN));
        let model = Affine::translation(Vec3::from_milli(0, 0, -2200))
            * Affine::rotation_x(Angle16::from_degrees(40))
            * Affine::rotation_y(turn)
            * Affine::rotation_z(turn);
        let angle = Angle16::from_degrees(60);
        let camera = Projective::perspective(angle, SIZE, Scalar::from_num(0.5), Scalar::from_num(12));
        let camera = camera.expect("the far plane is behind the near plane");
        let sun = Sun::new(Vec3::from_milli(400, 700, 600), Rgb888::CSS_LIGHT_GRAY, Rgb888::new(38, 38, 38));
        Self { mvp: camera * model, shader: Gouraud::new(sun.on(&Material::matte(Rgb888::CSS_ORANGE), &model)) }
    }

    /// Draws the torus.
    pub fn draw(&self, scene: &mut Scene<'_, impl Framebuffer>) {
        scene.draw(&TORUS, &self.mvp, &self.shader);
    }
}

const AROUND: usize = 32;
const ACROSS: usize = 16;
const VERTICES: usize = AROUND * ACROSS;

/// Radii of the torus in 16.16: 1, and 0.4 for its tube.
const RADIUS: i64 = 1 << 16;
const TUBE: i64 = 26_214;

/// Positions are fractions of its outer radius.
const OUTER: i64 = RADIUS + TUBE;

/// Returns sine and cosine of a part of a whole turn, in 16.16.
const fn unit(part: usize, whole: usize) -> (i64, i64) {
    let angle = Angle16((part * 65_536 / whole) as u16);
    (angle.sin().to_bits() as i64, angle.cos().to_bits() as i64)
}

/// Returns the positions of the vertices, or their normals: both lie on a circle around the middle of the tube, and
/// that middle lies on a circle itself.
const fn points(radius: i64, tube: i64, full: i64) -> [[i16; 3]; VERTICES] {
    let mut points = [[0; 3]; VERTICES];
    let mut k = 0;
    while k < VERTICES {
        let (along, across) = (unit(k / ACROSS, AROUND), unit(k % ACROSS, ACROSS));
        let ring = radius + ((tube * across.1) >> 16);
        let point = [(ring * along.1) >> 16, (tube * across.0) >> 16, (ring * along.0) >> 16];
        let mut axis = 0;
        while axis < 3 {
            points[k][axis] = (point[axis] * i16::MAX as i64 / full) as i16;
            axis += 1;
        }
        k += 1;
    }
    points
}

/// Returns the corners of quads, counter-clockwise as seen from outside.
const fn quads() -> [u16; 4 * VERTICES] {
    let mut quads = [0; 4 * VERTICES];
    let mut k = 0;
    while k < VERTICES {
        let (along, across) = (k / ACROSS, k % ACROSS);
        let (next, up) = ((along + 1) % AROUND * ACROSS, (across + 1) % ACROSS);
        let corners = [k, along * ACROSS + up, next + up, next + across];
        let mut corner = 0;
        while corner < 4 {
            quads[4 * k + corner] = corners[corner] as u16;
            corner += 1;
        }
        k += 1;
    }
    quads
}

static POSITIONS: [[i16; 3]; VERTICES] = points(RADIUS, TUBE, OUTER);
/// Unit vectors in 2.14.
static NORMALS: [[i16; 3]; VERTICES] = points(0, RADIUS, 2 * RADIUS);
static QUADS: [u16; 4 * VERTICES] = quads();

/// The torus, made and checked by the compiler; it stays in flash.
static TORUS: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    indices: Some(&QUADS),
    normals: Some(&NORMALS),
    ..MeshData::new(Positions::Quantized {
        points: &POSITIONS,
        scale: Scalar::from_bits(OUTER as i32),
        offset: Vec3::ZERO,
    })
});
