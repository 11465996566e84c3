//! An artificial horizon, drawn on the screen's plane with smooth lines and gradients, strip by strip.
//!
//! ```text
//! cargo run --release --example horizon -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use minifb::Key;
use scenes::horizon::Horizon;
use std::process::ExitCode;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::math::Angle16;
use zstrip::target::WithDepth;

/// The attitude of the aircraft, as it is steered: pitch and roll in binary angles.
#[derive(Default)]
struct Steered {
    pitch: i32,
    roll: i32,
}

impl Demo for Steered {
    type Format = Rgb565;
    const NAME: &'static str = "horizon";
    const ABOUT: &'static str = "An artificial horizon.";
    const MODES: &'static [&'static str] = &["wind", "calm"];
    const KEYS: &'static str = "  W, S              nose down and up\n  A, D              roll to the left and right\n";
    const BACKGROUND: Rgb565 = Rgb565::new(4, 10, 5);

    fn key(&mut self, key: Key) {
        let (pitch, roll) = match key {
            Key::W => (-40, 0),
            Key::S => (40, 0),
            Key::A => (0, -80),
            Key::D => (0, 80),
            _ => (0, 0),
        };
        self.pitch = (self.pitch + pitch).clamp(-8192, 8192);
        self.roll += roll;
    }

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Rgb565, WithDepth> {
        let sway = |speed: u32, degrees: i32| {
            let sine = Angle16((shot.number.wrapping_mul(speed)) as u16).sin().to_bits();
            ((i64::from(sine) * i64::from(degrees * 182)) >> 16) as i32
        };
        let wind = if shot.mode == 0 { (sway(160, 9), sway(97, 24) + sway(301, 4)) } else { (0, 0) };
        let (pitch, roll) = (Angle16((self.pitch + wind.0) as u16), Angle16((self.roll + wind.1) as u16));
        Box::new(Horizon::new(shot.screen, pitch, roll))
    }
}

fn main() -> ExitCode {
    show(Steered::default())
}
