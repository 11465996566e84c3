//! A scene with one sample per pixel, with four, and with 2 × 2 pixels for one, side by side.
//!
//! ```text
//! cargo run --release --example smooth -- --mode room --png smooth.png
//! ```
mod host;
mod scenes;

use core::convert::Infallible;
use host::program::{Demo, Drawing, Shot, show};
use scenes::leaves::Leaves;
use scenes::{Draw, Room, Torus};
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::draw_target::DrawTarget;
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::embedded_graphics_core::primitives::Rectangle;
use zstrip::frame::{Renderer, RendererError, Supersampled};
use zstrip::math::Angle16;
use zstrip::target::{DepthChoice, StripPixels, WithSamples, WithoutDepth};
use zstrip::{Framebuffer, Scene};

/// Rows of a strip of each picture.
const ROWS: usize = 4;
const GAP: u32 = 2;

/// A scene for any renderer.
enum Subject {
    Torus(Torus<zstrip::shader::Gouraud<zstrip::light::Sunlit>>),
    Room(Box<Room>),
    Leaves(Leaves),
}

impl Subject {
    fn new(mode: usize, screen: Size, turn: Angle16) -> Self {
        match mode {
            0 => Self::Torus(Torus::gouraud(screen, turn)),
            1 => Self::Room(Box::new(Room::new(screen, turn))),
            _ => Self::Leaves(Leaves::new(screen, turn)),
        }
    }
}

impl<F: Framebuffer<Format = Rgb565>> Draw<F> for Subject {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        match self {
            Self::Torus(torus) => torus.draw(scene),
            Self::Room(room) => room.draw(scene),
            Self::Leaves(leaves) => leaves.draw(scene),
        }
    }
}

/// Returns a sink that adds strips to a picture.
fn to(picture: &mut Vec<u16>) -> impl FnMut(&StripPixels<'_, Rgb565>) -> Result<(), Infallible> {
    |strip| {
        picture.extend_from_slice(strip.pixels());
        Ok(())
    }
}

/// Returns the pixels of a picture with `N` samples per pixel.
fn sampled<const N: usize>(subject: &Subject, size: Size) -> Result<Vec<u16>, RendererError>
where
    WithSamples<N>: DepthChoice,
{
    let pixels = size.width as usize * ROWS;
    let (mut color, mut samples, mut depth) = (vec![0; pixels], vec![0; (N - 1) * pixels], vec![0; N * pixels]);
    let (mut records, mut picture) = (vec![0; 16 * 1024], vec![]);
    let renderer = Renderer::<Rgb565>::new(size)?.with_samples::<N>(&mut depth, &mut samples)?;
    let drawn =
        renderer
            .with_records(&mut records)
            .frame_to(to(&mut picture), &mut color, scenes::BACKGROUND, |scene| subject.draw(scene));
    drawn.expect("one scene, and a sink that takes all strips");
    Ok(picture)
}

/// Returns the pixels of a picture with 2 × 2 pixels for one.
fn supersampled(subject: &Subject, size: Size) -> Result<Vec<u16>, RendererError> {
    let pixels = 4 * size.width as usize * ROWS;
    let (mut color, mut depth) = (vec![0; pixels], vec![0; pixels]);
    let (mut records, mut picture) = (vec![0; 16 * 1024], vec![]);
    let fine = Renderer::<Rgb565>::new(size * 2)?.with_depth(&mut depth)?.with_records(&mut records);
    let drawn =
        Supersampled::<_, _, _, 2>::new(fine)?
            .frame_to(to(&mut picture), &mut color, scenes::BACKGROUND, |scene| subject.draw(scene));
    drawn.expect("one scene, and a sink that takes all strips");
    Ok(picture)
}

/// Pictures beside each other.
struct Sheet {
    pictures: [Vec<u16>; 3],
    size: Size,
}

impl<F: Framebuffer<Format = Rgb565>> Draw<F> for Sheet {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        let mut overlay = scene.overlay();
        for (k, picture) in (0..).zip(&self.pictures) {
            let area = Rectangle::new(Point::new(k * (self.size.width + GAP) as i32, 0), self.size);
            let Ok(()) = overlay.fill_contiguous(&area, picture.iter().map(|raw| Rgb565::to_color(*raw)));
        }
    }
}

struct Smooth;

impl Demo<WithoutDepth> for Smooth {
    type Format = Rgb565;
    const NAME: &'static str = "smooth";
    const ABOUT: &'static str = "A scene with one sample per pixel, with four, and with 2 × 2 pixels for one.";
    const BACKGROUND: Rgb565 = Rgb565::new(31, 63, 31);
    const MODES: &'static [&'static str] = &["torus", "room", "leaves"];

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Rgb565, WithoutDepth> {
        let size = Size::new((shot.screen.width.saturating_sub(2 * GAP) / 3).max(1), shot.screen.height);
        let subject = |size| Subject::new(shot.mode, size, shot.turn());
        let one = subject(size);
        let pictures = [sampled::<1>(&one, size), sampled::<4>(&one, size), supersampled(&one, size)];
        Box::new(Sheet { pictures: pictures.map(|picture| picture.expect("buffers of whole rows")), size })
    }
}

fn main() -> std::process::ExitCode {
    show(Smooth)
}
