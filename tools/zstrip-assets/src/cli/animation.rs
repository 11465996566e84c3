//! Pictures that move: a turn of a model as a GIF file.

use super::failure::Failure;
use super::view::{FRAME, Show, TURN};
use gif::{Encoder, Frame, Repeat};
use std::path::Path;
use zstrip::math::Angle16;
use zstrip_assets::preview::{Stage, Step};
use zstrip_assets::save;

/// Frames of a file, at most. Longer clips get fewer frames per second, and keep their speed.
const MOST_FRAMES: u64 = 240;
/// Pixels of all frames of a file together, at most, so that its size stays bounded.
const MOST_PIXELS: u64 = 1 << 28;
/// The speed of choosing colours, from 1, the best, to 30.
const SPEED: i32 = 10;

/// The frames of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Timing {
    /// Milliseconds of all frames.
    total: u64,
    frames: u64,
}

impl Timing {
    /// Returns the frames of a turn, in which a clip of `duration` milliseconds plays a whole number of times.
    fn of(duration: Option<u32>) -> Self {
        let duration = u64::from(duration.unwrap_or(TURN).max(1));
        let rounds = ((u64::from(TURN) + duration / 2) / duration).max(1);
        let total = rounds * duration;
        Self { total, frames: (total / u64::from(FRAME)).clamp(1, MOST_FRAMES) }
    }

    /// Returns the start of a frame in milliseconds.
    const fn start(self, frame: u64) -> u64 {
        self.total * frame / self.frames
    }

    /// Returns how long a frame is shown, in hundredths of a second. The sum over all frames is the whole.
    fn delay(self, frame: u64) -> u16 {
        u16::try_from(self.start(frame + 1) / 10 - self.start(frame) / 10).unwrap_or(u16::MAX)
    }
}

/// Writes a turn that repeats without a jump, from the show's angle and time on, and returns the number of frames.
pub fn write_gif(stage: &Stage<'_>, show: &Show, path: &Path) -> Result<u64, Failure> {
    let clip = stage.model().clip(show.clip);
    let timing = Timing::of(clip.map(|clip| clip.duration()));
    let (file, frames) = (encode(stage, show, timing)?, timing.frames);
    save(path, &file).map_err(|error| Failure::Failed(format!("{}: {error}", path.display())))?;
    Ok(frames)
}

fn encode(stage: &Stage<'_>, show: &Show, timing: Timing) -> Result<Vec<u8>, Failure> {
    let fault = |error: gif::EncodingError| Failure::Failed(format!("the GIF file: {error}"));
    let size = stage.panel().screen();
    let pixels = u64::from(size.width) * u64::from(size.height) * timing.frames;
    if pixels > MOST_PIXELS {
        return Err(Failure::Usage(format!(
            "{} frames have {pixels} pixels together, where {MOST_PIXELS} are the most: choose a smaller --screen",
            timing.frames
        )));
    }
    let (width, height) = (size.width as u16, size.height as u16);
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, width, height, &[]).map_err(fault)?;
    encoder.set_repeat(Repeat::Infinite).map_err(fault)?;
    for k in 0..timing.frames {
        let turned = Angle16((65_536 * k / timing.frames) as u16);
        let Step { motion, .. } = show.at(timing.start(k) as i64).step(stage);
        let step = Step { turn: Angle16(show.angle.0.wrapping_add(turned.0)), motion };
        let (picture, _) = stage.picture(&step)?;
        let mut frame = Frame::from_rgb_speed(width, height, picture.pixels().as_flattened(), SPEED);
        frame.delay = timing.delay(k);
        encoder.write_frame(&frame).map_err(fault)?;
    }
    drop(encoder);
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delays_add_up_to_the_length_of_the_clip() {
        for duration in [None, Some(0), Some(1), Some(33), Some(708), Some(6000), Some(47_123), Some(600_000)] {
            let timing = Timing::of(duration);
            let sum: u64 = (0..timing.frames).map(|k| u64::from(timing.delay(k))).sum();
            assert_eq!(sum, timing.total / 10, "{duration:?}: {timing:?}");
            assert_eq!(timing.total % u64::from(duration.unwrap_or(TURN).max(1)), 0, "{duration:?}: {timing:?}");
            assert!((1..=MOST_FRAMES).contains(&timing.frames), "{duration:?}: {timing:?}");
        }
    }
}
