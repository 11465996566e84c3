//! Writes frames of the scene of `boards/rp2040` as raw big-endian RGB565, as they go to the panel: `ci/rp2040`
//! compares the board's with them.
//!
//! ```text
//! cargo run --release --example pico -- <frames> <file>
//! ```
#[path = "../boards/rp2040/src/scene.rs"]
mod scene;

use zstrip::Renderer;
use zstrip::color::Rgb565Be;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [frames, file] = &args[..] else {
        return Err("usage: pico <frames> <file>".into());
    };
    // One strip as tall as the screen: the picture must not depend on it.
    let pixels = (scene::SIZE.width * scene::SIZE.height) as usize;
    let (mut color, mut depth, mut records) = (vec![0; pixels], vec![0; pixels], vec![0; 64 * 1024]);
    let renderer = Renderer::<Rgb565Be>::new(scene::SIZE)?;
    let mut renderer = renderer.with_depth(&mut depth)?.with_records(&mut records);
    let mut bytes = Vec::new();
    for number in 0..frames.parse()? {
        let view = scene::View::new(number);
        let mut frame = renderer.begin(scene::BACKGROUND);
        while let Some(strip) = frame.next_strip(&mut color, |scene| view.draw(scene))? {
            bytes.extend_from_slice(strip.bytes());
        }
    }
    std::fs::write(file, bytes)?;
    Ok(())
}
