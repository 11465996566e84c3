//! A model on a turntable: the frames that are counted on emulated cores, estimated on a host, and shown in a window.
//! All of them are made here, so that they are equal.
//!
//! A show has [`TURN`] frames for each clip, or for a model that has none: the model turns once round while the clip
//! plays once.
#![allow(dead_code)] // each program uses its part

use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::Rgb888;
use zstrip::light::Sun;
use zstrip::math::{Affine, Angle16, ProjectionError, Vec3};
use zstrip::mesh::Bounds;
use zstrip::model::{Camera, Model, Motion};

/// Frames of a turn.
pub const TURN: u32 = 12;
/// Dark blue.
pub const BACKGROUND: Rgb888 = Rgb888::new(0, 0, 72);
/// Degrees from the lower to the upper edge of the screen.
const FIELD_OF_VIEW: u16 = 40;

/// Pixels of a strip: the most that the firmware that counts has memory for.
pub const MOST_STRIP: usize = 320 * 320;
/// Draws of a model, the most that it has memory for.
pub const MOST_DRAWS: usize = 256;
/// Words of records that it has.
pub const MOST_RECORDS: usize = 400 * 1024;
/// Clusters of all draws together, the most that it has memory for.
pub const MOST_CLUSTERS: usize = 4096;
/// Words of a pose, the most that it has memory for.
pub const MOST_POSE: usize = 192 * 1024;
/// Words of all shows together, the most that it has memory for.
pub const MOST_WORDS: usize = 1 << 21;

/// First word of a show in the memory of the firmware that counts; the numbers of [`show_head`] and a container follow.
pub const MAGIC: u32 = u32::from_le_bytes(*b"SHOW");
/// Words before the container.
pub const HEAD: usize = 8;

/// The way in which a show is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Way {
    /// Set if each strip goes over all of the model, because nothing is recorded.
    pub directly: bool,
    /// Set if the clusters of parts are culled one by one.
    pub clusters: bool,
}

impl Way {
    /// Returns the way that the last word of a head says.
    #[must_use]
    pub const fn of(word: u32) -> Self {
        Self { directly: word & 1 != 0, clusters: word & 2 != 0 }
    }

    /// Returns the last word of a head.
    #[must_use]
    pub const fn word(self) -> u32 {
        self.directly as u32 | (self.clusters as u32) << 1
    }
}

/// Returns the words before a container of `bytes` bytes; 0 stands for the container of the show before. Of all frames,
/// about `frames` are counted and not drawn again for their hashes; 0 stands for all, with hashes.
#[must_use]
pub const fn show_head(panel: &Panel, bytes: u32, frames: u32, way: Way) -> [u32; HEAD] {
    [MAGIC, panel.width, panel.height, panel.rows, panel.zoom, bytes, frames, way.word()]
}

/// Returns the numbers of the frames of a show of which about `frames` are counted, or all for 0.
pub fn numbers(model: &Model<'_>, frames: u32) -> impl Iterator<Item = u32> + use<> {
    let all = steps(model);
    let stride = all.checked_div(frames).unwrap_or(1).max(1);
    (0..all).step_by(stride as usize)
}

/// A screen, and how it is drawn on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Panel {
    /// Columns of the screen.
    pub width: u32,
    /// Rows of the screen.
    pub height: u32,
    /// Rows of a strip.
    pub rows: u32,
    /// Size of the model in percent of the largest size at which all of a turn is on the screen.
    pub zoom: u32,
}

impl Panel {
    /// Returns the size of the screen.
    #[must_use]
    pub const fn screen(&self) -> Size {
        Size::new(self.width, self.height)
    }
}

/// The camera, the light and the axis of a show.
#[derive(Clone, Copy, Debug)]
pub struct Turntable {
    pub camera: Camera,
    pub sun: Sun,
    center: Vec3,
}

/// A frame of a show.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// The angle that the model is turned by.
    pub turn: Angle16,
    /// The clip's pose, or that at rest.
    pub motion: Option<Motion>,
}

impl Turntable {
    /// Returns a turntable that has all of the model on the screen: in all of its clips, from all sides.
    pub fn new(model: &Model<'_>, panel: &Panel) -> Result<Self, ProjectionError> {
        let all = model.clips().fold(model.bounds(), |all, clip| around(&all, &clip.bounds()));
        let [x, y, z] = all.half.to_bits();
        // Below 2⁶³.
        let radius = (square(x) + square(z)).isqrt();
        let zoomed = |c: u64| (c * 100 / u64::from(panel.zoom.max(1))).clamp(1, i32::MAX as u64) as i32;
        let half = Vec3::from_bits([radius, y.unsigned_abs().into(), radius].map(zoomed));
        let bounds = Bounds { center: all.center, half };
        let angle = Angle16::from_degrees(FIELD_OF_VIEW.into());
        let camera = Camera::framing(&bounds, angle, panel.screen(), Vec3::from_ints(0, 1, 4))?;
        let sun = Sun::from_channels(Vec3::from_ints(4, 7, 6), [200; 3], [70; 3]);
        Ok(Self { camera, sun, center: all.center })
    }

    /// Returns the transform of a turned model.
    pub fn world(&self, turn: Angle16) -> Affine {
        Affine::translation(self.center) * Affine::rotation_y(turn) * Affine::translation(-self.center)
    }
}

/// Returns the number of frames of a show.
pub fn steps(model: &Model<'_>) -> u32 {
    TURN * model.clips().count().max(1) as u32
}

/// Returns a frame of a show.
pub fn step(model: &Model<'_>, number: u32) -> Step {
    let (clip, at) = (number / TURN, number % TURN);
    let time = |duration: u32| (u64::from(duration) * u64::from(at) / u64::from(TURN)) as u32;
    Step {
        turn: Angle16((65_536 * at / TURN) as u16),
        motion: model.clip(clip as usize).map(|clip| clip.once(time(clip.duration()))),
    }
}

fn square(c: i32) -> u64 {
    u64::from(c.unsigned_abs()).pow(2)
}

/// Returns the box around two boxes.
fn around(a: &Bounds, b: &Bounds) -> Bounds {
    let (mut center, mut half) = ([0; 3], [0; 3]);
    let corners = |bounds: &Bounds, k: usize| {
        let (center, half) = (i64::from(bounds.center.to_bits()[k]), i64::from(bounds.half.to_bits()[k]));
        (center - half, center + half)
    };
    for k in 0..3 {
        let ((a_low, a_high), (b_low, b_high)) = (corners(a, k), corners(b, k));
        let (low, high) = (a_low.min(b_low), a_high.max(b_high));
        let middle = ((low + high) >> 1).clamp(i32::MIN.into(), i32::MAX.into());
        (center[k], half[k]) = (middle as i32, (high - middle).clamp(0, i32::MAX.into()) as i32);
    }
    Bounds { center: Vec3::from_bits(center), half: Vec3::from_bits(half) }
}
