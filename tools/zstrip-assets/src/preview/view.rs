//! A window in which a model turns and plays its clips, exactly as firmware draws it; and files of that.

use super::command::{Settings, settings};
use super::picture::write_whole;
use super::{Container, Format, Picture, PreviewError, Stage, Step};
use gif::{Encoder, Frame, Repeat};
use minifb::{Key, KeyRepeat, Scale, Window, WindowOptions};
use std::path::{Path, PathBuf};
use std::time::Instant;
use zstrip::math::Angle16;
use zstrip::target::Stats;

/// The help for [`view`].
pub const VIEW: &str = "\
view MODEL.zstm [options]: a window with the model turning, as firmware draws it

  --screen, --rows, --format, --zoom: as for check
  --png FILE        writes a picture instead of opening a window
  --gif FILE        writes a turn that repeats; clips play in it
  --clip NAME       clip to begin with (the first one)
  --turn DEGREES    angle to begin with (0)
  --time MS         time in the clip to begin with (0)

keys in the window
  Space             pause
  Left, Right       turn
  Up, Down          higher and lower strips
  plus, minus       larger and smaller
  C                 next clip
  F                 next format of pixels
  comma, period     a frame back or forth
  Esc               quit";

/// Milliseconds of a turn, and of a frame of a file.
const TURN: u64 = 6000;
const FRAME: u64 = 50;
/// Heights of strips that keys choose; the height of the screen is the last one.
const ROWS: [u32; 6] = [1, 4, 8, 16, 32, 64];

/// The picture in a window, as keys change it.
struct Show {
    settings: Settings,
    clip: usize,
    /// Milliseconds since the start.
    time: u64,
    /// Added to the turn that follows from the time.
    angle: Angle16,
    paused: bool,
}

impl Show {
    /// Returns the frame at the show's time.
    fn step(&self, stage: &Stage<'_>) -> Step {
        let turn = (65_536 * (self.time % TURN) / TURN) as u16;
        let milliseconds = |duration: u32| (self.time % u64::from(duration.max(1))) as u32;
        Step {
            turn: Angle16(turn.wrapping_add(self.angle.0)),
            motion: stage.model().clip(self.clip).map(|clip| clip.looped(milliseconds(clip.duration()))),
        }
    }

    /// Changes the show by a key. `clips` is the number of clips.
    fn press(&mut self, key: Key, clips: usize) {
        let panel = &mut self.settings.panel;
        match key {
            Key::Space => self.paused = !self.paused,
            Key::Left => self.angle.0 = self.angle.0.wrapping_sub(1024),
            Key::Right => self.angle.0 = self.angle.0.wrapping_add(1024),
            Key::Up => {
                let next = ROWS.into_iter().find(|rows| *rows > panel.rows).unwrap_or(panel.height);
                panel.rows = next.min(panel.height);
            }
            Key::Down => {
                panel.rows = ROWS.into_iter().rev().find(|rows| *rows < panel.rows).unwrap_or(panel.rows);
            }
            Key::Equal | Key::NumPadPlus => panel.zoom = (panel.zoom + panel.zoom / 8 + 1).min(10_000),
            Key::Minus | Key::NumPadMinus => panel.zoom = (panel.zoom - panel.zoom / 8).max(8),
            Key::C => self.clip = (self.clip + 1) % clips.max(1),
            Key::F => {
                let at = Format::ALL.iter().position(|(format, ..)| *format == self.settings.format).unwrap_or(0);
                self.settings.format = Format::ALL[(at + 1) % Format::ALL.len()].0;
            }
            Key::Comma => self.time = self.time.saturating_sub(FRAME),
            Key::Period => self.time += FRAME,
            _ => {}
        }
    }

    /// Returns settings and statistics in a line.
    fn describe(&self, stage: &Stage<'_>, stats: &Stats) -> String {
        let Settings { file, panel, format } = &self.settings;
        let clip = stage.model().clip(self.clip).map_or(String::new(), |clip| format!(" {}", clip.name()));
        let format = Format::ALL.iter().find(|(known, ..)| known == format).map_or("", |(_, name, _)| name);
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let ((width, height), rows) = ((panel.width, panel.height), panel.rows);
        let Stats { vertices, triangles, drawn, .. } = stats;
        format!(
            "{name}{clip} {width}x{height} {format} | {rows} rows | {vertices} vertices, {triangles} triangles, {drawn} drawn"
        )
    }
}

/// Runs `view`.
///
/// # Errors
///
/// If the command line is wrong, the file is no container, there is no display, or a file cannot be written.
pub fn view(parser: &mut lexopt::Parser) -> Result<(), PreviewError> {
    let (mut png, mut gif, mut clip, mut turn, mut time) = (None, None, None, 0_u16, 0);
    let settings = settings(parser, &mut |name, parser| {
        match name {
            "png" => png = Some(PathBuf::from(parser.value()?)),
            "gif" => gif = Some(PathBuf::from(parser.value()?)),
            "clip" => clip = Some(lexopt::ValueExt::string(parser.value()?)?),
            "turn" => turn = lexopt::ValueExt::parse(&parser.value()?)?,
            "time" => time = lexopt::ValueExt::parse(&parser.value()?)?,
            _ => return Ok(false),
        }
        Ok(true)
    })?;
    let container = Container::read(&settings.file)?;
    let stage = Stage::new(&container, settings.panel, settings.format)?;
    let clips: Vec<_> = stage.model().clips().map(|clip| clip.name().to_owned()).collect();
    let clip = match clip {
        None => 0,
        Some(name) => clips.iter().position(|known| *known == name).ok_or_else(|| {
            PreviewError::Usage(format!("--clip {name}: the model has {} clips: {}", clips.len(), clips.join(", ")))
        })?,
    };
    // The turn is given, whatever the time is.
    let passed = (65_536 * (time % TURN) / TURN) as u16;
    let angle = Angle16((65_536 * u32::from(turn % 360) / 360) as u16);
    let show = Show { settings, clip, time, angle: Angle16(angle.0.wrapping_sub(passed)), paused: false };
    if let Some(path) = &png {
        let (picture, stats) = stage.picture(&show.step(&stage))?;
        picture.write_png(path)?;
        println!("{}\nwrote {}", show.describe(&stage, &stats), path.display());
    }
    if let Some(path) = &gif {
        let frames = write_gif(&stage, &show, path)?;
        println!("wrote {}: {frames} frames", path.display());
    }
    if png.is_none() && gif.is_none() { play(&container, show, clips.len()) } else { Ok(()) }
}

/// Writes a turn that repeats without a jump, and returns the number of frames. A clip plays as often as it fits.
fn write_gif(stage: &Stage<'_>, show: &Show, path: &Path) -> Result<u64, PreviewError> {
    let fault = |error: gif::EncodingError| PreviewError::Image(path.to_owned(), error.to_string());
    let duration = stage.model().clip(show.clip).map_or(TURN, |clip| clip.duration().into());
    let rounds = ((TURN + duration / 2) / duration).max(1);
    let frames = (rounds * duration / FRAME).clamp(1, MOST_FRAMES);
    let mut file = Vec::new();
    let (width, height) = (stage.panel.width as u16, stage.panel.height as u16);
    {
        let mut encoder = Encoder::new(&mut file, width, height, &[]).map_err(fault)?;
        encoder.set_repeat(Repeat::Infinite).map_err(fault)?;
        for k in 0..frames {
            let turn = Angle16((65_536 * k / frames) as u16);
            let at = (rounds * duration * k / frames % duration) as u32;
            let motion = stage.model().clip(show.clip).map(|clip| clip.looped(at));
            let (picture, _) = stage.picture(&Step { turn: Angle16(turn.0.wrapping_add(show.angle.0)), motion })?;
            let mut frame = Frame::from_rgb_speed(width, height, picture.pixels().as_flattened(), SPEED);
            frame.delay = (FRAME / 10) as u16;
            encoder.write_frame(&frame).map_err(fault)?;
        }
    }
    write_whole(path, &file)?;
    Ok(frames)
}

/// Frames of a file, at most.
const MOST_FRAMES: u64 = 240;
/// The speed of choosing colours, from 1, the best, to 30.
const SPEED: i32 = 10;

/// Opens a window, or returns why there is none.
fn open((width, height): (u32, u32)) -> Result<Window, PreviewError> {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if cfg!(target_os = "linux") && !is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY") {
        return Err(PreviewError::Window("neither DISPLAY nor WAYLAND_DISPLAY is set".to_owned()));
    }
    let options = WindowOptions { scale: if width <= 640 { Scale::X2 } else { Scale::X1 }, ..WindowOptions::default() };
    Window::new("zstrip", width as usize, height as usize, options)
        .map_err(|error| PreviewError::Window(error.to_string()))
}

/// Runs until the window is closed.
fn play(container: &Container, mut show: Show, clips: usize) -> Result<(), PreviewError> {
    let panel = show.settings.panel;
    let mut window = open((panel.width, panel.height))?;
    window.set_target_fps(60);
    let mut before = Instant::now();
    while window.is_open() && !window.is_key_down(Key::Escape) {
        let stage = Stage::new(container, show.settings.panel, show.settings.format)?;
        let (picture, stats) = stage.picture(&show.step(&stage))?;
        let (width, height) = picture.size();
        window
            .update_with_buffer(&to_0rgb(&picture), width as usize, height as usize)
            .map_err(|error| PreviewError::Window(error.to_string()))?;
        window.set_title(&show.describe(&stage, &stats));
        let passed = before.elapsed().as_millis() as u64;
        before = Instant::now();
        show.time += if show.paused { 0 } else { passed };
        window.get_keys_pressed(KeyRepeat::Yes).into_iter().for_each(|key| show.press(key, clips));
    }
    Ok(())
}

/// Returns a picture as windows take it.
fn to_0rgb(picture: &Picture) -> Vec<u32> {
    picture.pixels().iter().map(|[r, g, b]| u32::from_be_bytes([0, *r, *g, *b])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preview::Panel;

    fn show() -> Show {
        let panel = Panel { width: 48, height: 64, rows: 16, zoom: 100 };
        let settings = Settings { file: PathBuf::from("model.zstm"), panel, format: Format::Rgb565 };
        Show { settings, clip: 0, time: 0, angle: Angle16(0), paused: false }
    }

    #[test]
    fn keys_keep_the_panel_within_what_a_stage_takes() {
        let mut show = show();
        for key in [Key::Up, Key::Down, Key::Equal, Key::Minus, Key::F, Key::C, Key::Comma, Key::Left] {
            for _ in 0..100 {
                show.press(key, 3);
                let Panel { height, rows, zoom, .. } = show.settings.panel;
                assert!((1..=height).contains(&rows) && (1..=10_000).contains(&zoom) && show.clip < 3, "{key:?}");
            }
        }
        assert_eq!(show.settings.panel.rows, 1, "down after up");
        assert_eq!(show.settings.format, Format::Rgb565, "a hundred times five formats");
        assert_eq!(show.clip, 1, "a hundred times three clips");
        show.press(Key::Space, 3);
        assert!(show.paused);
    }
}
