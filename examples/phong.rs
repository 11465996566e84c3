//! A glazed pot under the moon and two lamps, shaded in five ways.
//!
//! ```text
//! cargo run --release --example phong -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, show};
use scenes::light::{Shading, phong};
use zstrip::Scene;
use zstrip::color::Dithered;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
use zstrip::math::Angle16;
use zstrip::target::Strip;
use zstrip::target::{WithDepth, WithRecords};

const SHADINGS: [Shading; 5] =
    [Shading::PerFragmentNear, Shading::PerVertex, Shading::PerFace, Shading::PerFragment, Shading::Matcap];

struct Phong;

impl Demo for Phong {
    type Format = Dithered<Rgb565>;
    const NAME: &'static str = "phong";
    const ABOUT: &'static str = "A glazed pot under the moon and two lamps, shaded in five ways.";
    const BACKGROUND: Rgb565 = Rgb565::BLACK;
    const MODES: &'static [&'static str] = &["fragment", "vertex", "face", "sun", "matcap"];

    fn draw(&self, scene: &mut Scene<'_, Strip<'_, Self::Format, WithDepth, WithRecords>>, turn: Angle16, mode: usize) {
        phong(scene, turn, SHADINGS[mode]);
    }
}

fn main() -> std::process::ExitCode {
    show(Phong)
}
