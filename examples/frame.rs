//! Writes frames of a scene as raw big-endian RGB565, as they go to a panel:
//!
//! ```text
//! cargo run --release --example frame -- <scene> <frames> <turn> <width> <height> <file>
//! ```
//! `turn` is how far the scene turns from frame to frame, 65536 being once around.
mod scenes;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [scene, frames, turn, width, height, file] = &args[..] else {
        return Err("usage: frame <scene> <frames> <turn> <width> <height> <file>".into());
    };
    let index = scenes::SCENES.iter().position(|info| info.name == scene).ok_or("no scene of that name")?;
    let size: [usize; 2] = [width.parse()?, height.parse()?];
    let (frames, turn): (u16, u16) = (frames.parse()?, turn.parse()?);

    // One strip as tall as the screen: the picture must not depend on it.
    let (mut color, mut depth) = (vec![0; size[0] * size[1]], vec![0; size[0] * size[1]]);
    let mut records = vec![0; 64 * 1024];
    let mut bytes = Vec::new();
    for i in 0..frames {
        let angle = i.wrapping_mul(turn);
        scenes::draw(index, angle, size, &mut color, &mut depth, &mut records, |_, strip| {
            bytes.extend(strip.iter().flat_map(|pixel| pixel.to_be_bytes()));
        });
    }
    std::fs::write(file, bytes)?;
    Ok(())
}
