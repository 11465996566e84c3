//! An artificial horizon, drawn on the screen's plane with smooth lines and gradients, strip by strip.
//!
//! ```text
//! cargo run --release --example horizon -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, show};
use minifb::Key;
use std::process::ExitCode;
use zstrip::Scene;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::math::Angle16;
use zstrip::target::Strip;
use zstrip::target::{WithDepth, WithRecords};

/// The aircraft's attitude: what is steered, and what the wind adds.
#[derive(Default)]
struct Horizon {
    steered: (i32, i32),
    pitch: Angle16,
    roll: Angle16,
}

impl Demo for Horizon {
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
        self.steered.0 = (self.steered.0 + pitch).clamp(-8192, 8192);
        self.steered.1 += roll;
    }

    fn prepare(&mut self, frame: u32, _: Size) {
        let sway = |speed: u32, degrees: i32| {
            let sine = Angle16((frame.wrapping_mul(speed)) as u16).sin().to_bits();
            ((i64::from(sine) * i64::from(degrees * 182)) >> 16) as i32
        };
        self.pitch = Angle16((self.steered.0 + sway(160, 9)) as u16);
        self.roll = Angle16((self.steered.1 + sway(97, 24) + sway(301, 4)) as u16);
    }

    fn draw(&self, scene: &mut Scene<'_, Strip<'_, Rgb565, WithDepth, WithRecords>>, _turn: Angle16, mode: usize) {
        let steered = (Angle16(self.steered.0 as u16), Angle16(self.steered.1 as u16));
        let (pitch, roll) = if mode == 0 { (self.pitch, self.roll) } else { steered };
        scenes::horizon::horizon(scene, pitch, roll);
    }
}

fn main() -> ExitCode {
    show(Horizon::default())
}
