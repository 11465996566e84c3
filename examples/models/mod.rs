//! Models from containers, as the examples and `boards/rp2040` show them. The containers beside this file are made by
//! `tools/zstrip-assets`, from the sources in its `examples/gallery`.
#![allow(dead_code)] // each program uses its part

use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
use zstrip::light::{Sun, Sunlit};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Bounds, LineTopology, Lines, Positions, Vertices};
use zstrip::model::{Camera, Clip, Model, Place, Placed, Pose};
use zstrip::shader::Flat;
use zstrip::{Framebuffer, Scene, Thin, include_model};

/// Spot the cow, by Keenan Crane: a palette of 256 colours.
pub static SPOT: &[u8] = include_model!("spot.zstm");
/// The Utah teapot, by Martin Newell.
pub static TEAPOT: &[u8] = include_model!("teapot.zstm");
/// A figure of 13 joints, with the clips stand, walk and run.
pub static FIGURE: &[u8] = include_model!("figure.zstm");
/// A part from CAD, smooth up to a crease angle of 30 degrees.
pub static FLANGE: &[u8] = include_model!("flange.zstm");
/// That part with a normal for each face.
pub static FLANGE_FACES: &[u8] = include_model!("flange_faces.zstm");

/// The colour where nothing is drawn.
pub const BACKGROUND: Rgb565 = Rgb565::new(3, 8, 6);

const FIELD_OF_VIEW: u16 = 35;

/// Returns the light: it comes from above, from behind the viewer.
fn sun() -> Sun {
    Sun::from_channels(Vec3::from_ints(4, 7, 6), [200; 3], [64; 3])
}

/// Returns a camera that has a box on the screen while it turns around its upright axis.
#[inline(never)]
fn camera(bounds: &Bounds, screen: Size, towards_viewer: Vec3) -> Option<Camera> {
    let [x, y, z] = bounds.half.to_bits().map(|c| u64::from(c.unsigned_abs()));
    // The corners of the turned box are on a circle, and a box that wide would be larger than models are.
    let radius = ((x * x + z * z).isqrt() * 5 / 6).min(i32::MAX as u64) as i32;
    let half = Vec3::from_bits([radius, y as i32, radius]);
    let angle = Angle16::from_degrees(FIELD_OF_VIEW.into());
    Camera::framing(&Bounds { center: bounds.center, half }, angle, screen, towards_viewer).ok()
}

/// A model of one part, on a turntable.
pub struct Still {
    model: Model<'static>,
    places: [Option<Place<Sunlit>>; 1],
}

impl Still {
    /// Checks a container, once. `None` if its bytes are wrong, or if it has several parts.
    pub fn new(file: &'static [u8]) -> Option<Self> {
        let model = Model::from_bytes(file).ok().filter(|_| Model::draws(file) <= 1)?;
        Some(Self { model, places: [None] })
    }

    /// Places the model in a frame, outside of the closure that draws.
    pub fn place(&mut self, screen: Size, towards_viewer: Vec3, turn: Angle16) -> Option<Placed<'_, Sunlit>> {
        let bounds = self.model.bounds();
        let camera = camera(&bounds, screen, towards_viewer)?;
        let to_axis = Affine::translation(-bounds.center);
        let world = Affine::translation(bounds.center) * Affine::rotation_y(turn) * to_axis;
        self.model.place(&world, &camera, &sun(), &mut self.places).ok()
    }
}

/// The way of a figure: how it moves, and how far it has come.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// 0 to stand, 1 to walk, 2 to run, or between.
    pub pace: Scalar,
    milliseconds: u32,
    /// A part of two steps, of 2³².
    phase: u32,
    /// Metres, 16.16, up to the distance of two lines on the ground.
    ground: u32,
}

/// Two steps take a second when walking, and 0.7 seconds when running; they are 1.5 and 2.4 metres long.
const STEPS_PER_SECOND: [i64; 3] = [1 << 16, 1 << 16, 93_623];
const METRES_PER_SECOND: [i64; 3] = [0, 98_304, 224_000];
/// Distance of the lines on the ground, 16.16: half a metre.
const LINES_APART: u32 = 1 << 15;

impl Way {
    /// Returns the beginning of a way.
    pub const fn at(pace: Scalar) -> Self {
        Self { pace, milliseconds: 0, phase: 0, ground: 0 }
    }

    /// Returns the time on the way.
    pub const fn milliseconds(&self) -> u32 {
        self.milliseconds
    }

    /// Returns the part of two steps that is behind it, of 2³².
    pub const fn phase(&self) -> u32 {
        self.phase
    }

    /// Goes on for a time.
    pub fn advance(&mut self, milliseconds: u32) {
        let between = |of: [i64; 3]| {
            let pace = i64::from(self.pace.to_bits().clamp(0, 2 << 16));
            let [from, to] = if pace < 1 << 16 { [of[0], of[1]] } else { [of[1], of[2]] };
            let part = if pace < 1 << 16 { pace } else { pace - (1 << 16) };
            (from + (((to - from) * part) >> 16)) as u64
        };
        let (steps, metres) = (between(STEPS_PER_SECOND), between(METRES_PER_SECOND));
        let time = u64::from(milliseconds);
        self.milliseconds = self.milliseconds.wrapping_add(milliseconds);
        self.phase = self.phase.wrapping_add(((time * steps / 1000) << 16) as u32);
        self.ground = ((u64::from(self.ground) + time * metres / 1000) % u64::from(LINES_APART)) as u32;
    }
}

/// A figure whose clips are blended.
pub struct Walker {
    pose: Pose<'static>,
    /// Clips of the paces 0, 1 and 2.
    clips: [Clip<'static>; 3],
    places: [Option<Place<Sunlit>>; 1],
}

impl Walker {
    /// Words of memory that the pose takes.
    pub const WORDS: usize = Pose::words(FIGURE);

    /// Checks the container, and takes memory for a pose. `None` if it is not enough, or the bytes are wrong.
    pub fn new(memory: &'static mut [u32]) -> Option<Self> {
        let model = Model::from_bytes(FIGURE).ok()?;
        let clips = [model.clip_named("stand")?, model.clip_named("walk")?, model.clip_named("run")?];
        Some(Self { pose: model.pose(memory).ok()?, clips, places: [None] })
    }

    /// Poses and places the figure in a frame, outside of the closure that draws.
    pub fn place(&mut self, screen: Size, way: &Way, turn: Angle16) -> Option<Walking<'_>> {
        let [stand, walk, run] = &self.clips;
        // Walking and running are at the same part of their steps.
        let at = |clip: &Clip<'_>| ((u64::from(clip.duration()) * u64::from(way.phase)) >> 32) as u32;
        let (walking, running) = (walk.looped(at(walk)), run.looped(at(run)));
        if way.pace < Scalar::ONE {
            self.pose.blend(stand.looped(way.milliseconds), walking, way.pace);
        } else {
            self.pose.blend(walking, running, way.pace - Scalar::ONE);
        }
        let world = Affine::rotation_y(turn);
        let room = Bounds { center: Vec3::from_milli(0, 900, 0), half: Vec3::from_milli(350, 900, 350) };
        let camera = camera(&room, screen, Vec3::from_ints(0, 1, 4))?;
        let moved = Affine::translation(Vec3::new(Scalar::ZERO, Scalar::ZERO, -Scalar::from_bits(way.ground as i32)));
        let ground = camera.lens * (camera.view * (world * moved));
        let figure = self.pose.place(&world, &camera, &sun(), &mut self.places).ok()?;
        Some(Walking { figure, ground })
    }
}

/// A figure and the ground that it walks on, in a frame.
pub struct Walking<'p> {
    figure: Placed<'p, Sunlit>,
    ground: Projective,
}

impl Walking<'_> {
    /// Draws the frame; called for every strip.
    pub fn draw(&self, scene: &mut Scene<'_, impl Framebuffer>) {
        scene.draw_lines(&GROUND, &self.ground, &Flat::unlit(Rgb888::new(70, 90, 120)), &Thin);
        self.figure.draw(scene);
    }
}

/// Lines across the way, and two beside it.
const GROUND: Lines<'static> = {
    const fn points() -> [Vec3; 18] {
        let mut points = [Vec3::ZERO; 18];
        let mut k = 0;
        while k < 7 {
            let z = (k as i32 - 3) * 500;
            (points[2 * k], points[2 * k + 1]) = (Vec3::from_milli(-600, 0, z), Vec3::from_milli(600, 0, z));
            k += 1;
        }
        (points[14], points[15]) = (Vec3::from_milli(-600, 0, -1500), Vec3::from_milli(-600, 0, 1500));
        (points[16], points[17]) = (Vec3::from_milli(600, 0, -1500), Vec3::from_milli(600, 0, 1500));
        points
    }
    match Lines::new(Vertices::new(Positions::Exact(const { &points() })), LineTopology::Pairs, None) {
        Ok(lines) => lines,
        Err(_) => panic!("lines have two ends"),
    }
};
