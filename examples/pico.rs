//! Writes frames of a program of `boards/rp2040` as raw big-endian RGB565, as they go to the panel: `ci/rp2040`
//! compares the board's with them. The programs are `torus`, which stands for `blocking` and `dma`, `model`,
//! `character` and `part`.
//!
//! ```text
//! cargo run --release --example pico -- <program> <frames> <file>
//! ```
#[path = "../boards/rp2040/src/scene.rs"]
mod scene;
#[path = "../boards/rp2040/src/shows.rs"]
mod shows;

use shows::{Going, Turning};
use std::error::Error;
use zstrip::color::Rgb565Be;
use zstrip::embedded_graphics_core::pixelcolor::Rgb888;
use zstrip::target::{Strip, WithDepth, WithRecords};
use zstrip::{Renderer, Scene};

/// A screen whose strip is as tall as it is: the picture must not depend on that.
struct Screen {
    color: Vec<u16>,
    depth: Vec<u16>,
    records: Vec<u32>,
    bytes: Vec<u8>,
}

impl Screen {
    /// Draws a frame.
    fn show(
        &mut self,
        background: impl Into<Rgb888>,
        mut draw: impl FnMut(&mut Scene<'_, Strip<'_, Rgb565Be, WithDepth, WithRecords>>),
    ) -> Result<(), Box<dyn Error>> {
        let renderer = Renderer::<Rgb565Be>::new(scene::SIZE)?;
        let mut renderer = renderer.with_depth(&mut self.depth)?.with_records(&mut self.records);
        let mut frame = renderer.begin(background.into());
        while let Some(strip) = frame.next_strip(&mut self.color, &mut draw)? {
            self.bytes.extend_from_slice(strip.bytes());
        }
        Ok(())
    }

    fn turn(&mut self, mut turning: Turning, frames: u16) -> Result<(), Box<dyn Error>> {
        (0..frames).try_for_each(|_| {
            let frame = turning.next_frame();
            self.show(shows::BACKGROUND, |scene| frame.draw(scene))
        })
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [program, frames, file] = &args[..] else {
        return Err("usage: pico <program> <frames> <file>".into());
    };
    let frames = frames.parse()?;
    let pixels = (scene::SIZE.width * scene::SIZE.height) as usize;
    let (color, depth, records) = (vec![0; pixels], vec![0; pixels], vec![0; 64 * 1024]);
    let mut screen = Screen { color, depth, records, bytes: Vec::new() };
    match &program[..] {
        "torus" => {
            for number in 0..frames {
                let view = scene::View::new(number);
                screen.show(scene::BACKGROUND, |scene| view.draw(scene))?;
            }
        }
        "model" => screen.turn(Turning::cow(), frames)?,
        "part" => screen.turn(Turning::part(), frames)?,
        "character" => {
            let mut going = Going::new(vec![0; Going::WORDS].leak());
            for _ in 0..frames {
                let frame = going.next_frame();
                screen.show(shows::BACKGROUND, |scene| frame.draw(scene))?;
            }
        }
        _ => return Err("the programs are torus, model, character and part".into()),
    }
    std::fs::write(file, screen.bytes)?;
    Ok(())
}
