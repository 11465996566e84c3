//! A program around something to draw: options, a window with keys, or a picture where there is no display.

use super::host::Picture;
use minifb::{Key, KeyRepeat, Scale, Window, WindowOptions};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::output::{RamBudget, Stats, Strip, StripPixels};
use zstrip::{Buffers, Renderer, Scene};

/// What is shown.
pub trait Demo {
    /// Its name, that of the picture, too.
    const NAME: &'static str;
    /// A sentence about it.
    const ABOUT: &'static str;
    /// Names of its modes, which the key M goes through.
    const MODES: &'static [&'static str];
    /// What other keys do, a line each; empty if there are none.
    const KEYS: &'static str;
    const BACKGROUND: Rgb565;

    /// A key is held down.
    fn key(&mut self, key: Key) {
        let _ = key;
    }

    /// Called before each frame, with the screen's size.
    fn prepare(&mut self, frame: u32, screen: (u16, u16));

    /// Draws the frame that was prepared; called for each strip.
    fn draw(&self, scene: &mut Scene<'_, Strip<'_, Rgb565>>, mode: usize);
}

struct Settings {
    png: Option<PathBuf>,
    strip_rows: u16,
    records: usize,
    frame: u32,
    mode: usize,
    size: (u16, u16),
}

fn help<D: Demo>() -> String {
    format!(
        "\
{}. Without a display it is written to {name}.png.

usage: {name} [options]
  --png FILE        write a picture instead of opening a window
  --mode N          {} (0)
  --strip-rows N    rows of a strip (16)
  --records N       words of records, of 4 bytes (8192)
  --frame N         number of the first frame (0)
  --size WxH        pixels of the screen (320x240)

keys in the window
  M                 next mode
{}  Up, Down          higher and lower strips
  Space             pause
  Esc               quit",
        D::ABOUT,
        D::MODES.iter().enumerate().map(|(k, mode)| format!("{k}: {mode}")).collect::<Vec<_>>().join(", "),
        D::KEYS,
        name = D::NAME,
    )
}

/// The settings, or `None` if help was asked for.
fn arguments<D: Demo>() -> Result<Option<Settings>, Box<dyn Error>> {
    use lexopt::prelude::*;
    let mut settings = Settings { png: None, strip_rows: 16, records: 8192, frame: 0, mode: 0, size: (320, 240) };
    let mut parser = lexopt::Parser::from_env();
    while let Some(argument) = parser.next()? {
        match argument {
            Long("png") => settings.png = Some(parser.value()?.into()),
            Long("mode") => settings.mode = parser.value()?.parse()?,
            Long("strip-rows") => settings.strip_rows = parser.value()?.parse()?,
            Long("records") => settings.records = parser.value()?.parse()?,
            Long("frame") => settings.frame = parser.value()?.parse()?,
            Long("size") => {
                settings.size = parser.value()?.parse_with(|text| {
                    let parsed = text.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
                    parsed.ok_or("a size is like 320x240")
                })?;
            }
            Long("help") | Short('h') => return Ok(None),
            _ => return Err(argument.unexpected().into()),
        }
    }
    if settings.strip_rows == 0 || settings.mode >= D::MODES.len() || settings.records > 1 << 28 {
        return Err("a strip has rows, records take less than 1 GiB, and there are not that many modes".into());
    }
    Ok(Some(settings))
}

/// Draws a frame through strips, as a display would get it.
fn render<D: Demo>(demo: &D, settings: &Settings, picture: &mut Picture) -> Result<Stats, Box<dyn Error>> {
    let pixels = usize::from(settings.size.0) * usize::from(settings.strip_rows.min(settings.size.1));
    let (mut color, mut depth, mut records) = (vec![0; pixels], vec![0; pixels], vec![0; settings.records]);
    let buffers = Buffers { color: &mut color, depth: &mut depth, records: &mut records };
    let mut renderer = Renderer::<Rgb565>::new(settings.size, buffers)?;
    let to_picture = |strip: &StripPixels<'_, Rgb565>| {
        picture.put(strip);
        Ok::<(), std::convert::Infallible>(())
    };
    Ok(renderer.frame_to(to_picture, D::BACKGROUND, |scene| demo.draw(scene, settings.mode))?)
}

fn describe<D: Demo>(settings: &Settings, stats: &Stats) -> String {
    let rows = settings.strip_rows.min(settings.size.1);
    let ram = RamBudget::new::<Rgb565>(settings.size.0, rows).with_record_words(settings.records).total();
    format!(
        "{}, {} | {}x{} in strips of {rows} rows, {ram} bytes | {} lines, {} points, {} triangles",
        D::NAME,
        D::MODES[settings.mode],
        settings.size.0,
        settings.size.1,
        stats.lines,
        stats.points,
        stats.triangles,
    )
}

fn picture<D: Demo>(demo: &mut D, settings: &Settings, path: &Path) -> Result<(), Box<dyn Error>> {
    let mut picture = Picture::new(settings.size);
    demo.prepare(settings.frame, settings.size);
    let stats = render(demo, settings, &mut picture)?;
    picture.write_png(path)?;
    println!("{}", describe::<D>(settings, &stats));
    println!("wrote {}", path.display());
    Ok(())
}

/// The window, or why there is none.
fn open(name: &str, size: (u16, u16)) -> Result<Window, String> {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if cfg!(target_os = "linux") && !is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY") {
        return Err("neither DISPLAY nor WAYLAND_DISPLAY is set".into());
    }
    let scale = if size.0 <= 640 { Scale::X2 } else { Scale::X1 };
    let options = WindowOptions { scale, ..WindowOptions::default() };
    Window::new(name, size.0.into(), size.1.into(), options).map_err(|error| error.to_string())
}

/// Runs until the window is closed.
fn play<D: Demo>(demo: &mut D, window: &mut Window, mut settings: Settings) -> Result<(), Box<dyn Error>> {
    window.set_target_fps(60);
    let mut picture = Picture::new(settings.size);
    let (mut frame, mut paused) = (settings.frame, false);
    while window.is_open() && !window.is_key_down(Key::Escape) {
        demo.prepare(frame, settings.size);
        let stats = render(demo, &settings, &mut picture)?;
        window.update_with_buffer(&picture.to_0rgb(), settings.size.0.into(), settings.size.1.into())?;
        window.set_title(&describe::<D>(&settings, &stats));
        frame = frame.wrapping_add(u32::from(!paused));
        window.get_keys().into_iter().for_each(|key| demo.key(key));
        for key in window.get_keys_pressed(KeyRepeat::No) {
            match key {
                Key::M => settings.mode = (settings.mode + 1) % D::MODES.len(),
                Key::Up => settings.strip_rows = (2 * settings.strip_rows).min(settings.size.1),
                Key::Down => settings.strip_rows = (settings.strip_rows / 2).max(1),
                Key::Space => paused = !paused,
                _ => {}
            }
        }
    }
    Ok(())
}

fn run<D: Demo>(mut demo: D) -> Result<(), Box<dyn Error>> {
    let Some(settings) = arguments::<D>()? else {
        println!("{}", help::<D>());
        return Ok(());
    };
    if let Some(path) = &settings.png {
        return picture(&mut demo, &settings, path);
    }
    match open(D::NAME, settings.size) {
        Ok(mut window) => play(&mut demo, &mut window, settings),
        Err(reason) => {
            println!("no window ({reason}): writing a picture instead");
            picture(&mut demo, &settings, &PathBuf::from(format!("{}.png", D::NAME)))
        }
    }
}

/// The program.
pub fn main<D: Demo>(demo: D) -> ExitCode {
    match run(demo) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}: {error}", D::NAME);
            ExitCode::from(2)
        }
    }
}
