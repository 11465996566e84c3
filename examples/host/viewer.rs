//! The examples' window: scenes drawn strip by strip as on a small display, with keys for what a frame is given; a PNG where
//! there is no display.

use super::Picture;
use crate::scenes::{self, SCENES};
use minifb::{Key, KeyRepeat, Scale, Window, WindowOptions};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::math::Angle;
use zstrip::output::{RamBudget, Stats, StripPixels};
use zstrip::{Buffers, Renderer};

const OPTIONS: &str = "
options
  --png FILE        write a picture instead of opening a window
  --strip-rows N    rows of a strip (16)
  --records N       words of records, of 4 bytes; 0 is allowed (16384, or 0 where nothing is 3-D)
  --frame N         number of the first frame, 512 make a turn (0)
  --size WxH        pixels of the screen (320x240)
  --scene NAME      what to draw, where there is a choice
  --help            this text, and the scenes' names

keys in the window
  Up, Down          higher and lower strips
  Right, Left       more and fewer records
  S                 next scene, where there are several
  Space             pause
  Esc               quit";

/// What an example shows.
pub struct Program {
    /// The example's name, and that of its picture.
    pub name: &'static str,
    /// What it shows, in a sentence or two.
    pub about: &'static str,
    /// Its scene, or the first one.
    pub scene: &'static str,
    /// Whether all other scenes can be chosen.
    pub all: bool,
    /// Whether frames have a depth buffer.
    pub depth: bool,
}

/// What the keys choose from; the height of the screen is the tallest strip.
const STRIP_ROWS: [u16; 7] = [1, 2, 4, 7, 8, 16, 40];
const RECORDS: [usize; 4] = [0, 100, 1000, AMPLE];
/// Enough for every scene.
const AMPLE: usize = 16 * 1024;

struct Settings {
    program: &'static Program,
    png: Option<PathBuf>,
    strip_rows: u16,
    records: usize,
    frame: u32,
    scene: usize,
    size: (u16, u16),
}

/// The settings, or `None` if help was asked for.
fn arguments(program: &'static Program) -> Result<Option<Settings>, Box<dyn Error>> {
    use lexopt::prelude::*;
    let scene = scene_named(program.scene)?;
    let records = if program.depth { AMPLE } else { 0 };
    let mut settings = Settings { program, png: None, strip_rows: 16, records, frame: 0, scene, size: (320, 240) };
    let mut parser = lexopt::Parser::from_env();
    while let Some(argument) = parser.next()? {
        match argument {
            Long("png") => settings.png = Some(parser.value()?.into()),
            Long("strip-rows") => settings.strip_rows = parser.value()?.parse()?,
            Long("records") => settings.records = parser.value()?.parse()?,
            Long("frame") => settings.frame = parser.value()?.parse()?,
            Long("scene") if program.all => settings.scene = parser.value()?.parse_with(scene_named)?,
            Long("size") => settings.size = parser.value()?.parse_with(size)?,
            Long("help") | Short('h') => return Ok(None),
            _ => return Err(argument.unexpected().into()),
        }
    }
    if settings.strip_rows == 0 {
        return Err("a strip has at least one row".into());
    }
    if settings.records > 1 << 28 {
        return Err("more than 1 GiB of records".into());
    }
    Ok(Some(settings))
}

fn names() -> String {
    SCENES.iter().map(|scene| scene.name).collect::<Vec<_>>().join(", ")
}

fn scene_named(name: &str) -> Result<usize, String> {
    let found = SCENES.iter().position(|scene| scene.name == name);
    found.ok_or_else(|| format!("the scenes are {}", names()))
}

/// A size like `320x240`.
pub fn size(text: &str) -> Result<(u16, u16), String> {
    let parsed = text.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    parsed.ok_or_else(|| "a size is like 320x240".into())
}

/// Bytes lent to the renderer.
fn ram(settings: &Settings) -> usize {
    let rows = settings.strip_rows.min(settings.size.1);
    let budget = RamBudget::new::<Rgb565>(settings.size.0, rows).with_record_words(settings.records);
    if settings.program.depth { budget.total() } else { budget.without_depth().total() }
}

/// Draws a frame of the scene through strips, as a display would get it.
fn render(settings: &Settings, frame: u32, picture: &mut Picture) -> Result<Stats, Box<dyn Error>> {
    let pixels = usize::from(settings.size.0) * usize::from(settings.strip_rows.min(settings.size.1));
    let depths = if settings.program.depth { pixels } else { 0 };
    let (mut color, mut depth, mut records) = (vec![0; pixels], vec![0; depths], vec![0; settings.records]);
    let buffers = Buffers { color: &mut color, depth: &mut depth, records: &mut records };
    let mut renderer = Renderer::<Rgb565>::new(settings.size, buffers)?;
    let to_picture = |strip: &StripPixels<'_, Rgb565>| {
        picture.put(strip);
        Ok::<(), std::convert::Infallible>(())
    };
    let turn = Angle(frame.wrapping_mul(128) as u16);
    Ok(renderer.frame_to(to_picture, scenes::BACKGROUND, |scene| {
        (SCENES[settings.scene].draw)(scene, turn);
    })?)
}

/// Settings and statistics in a line.
fn describe(settings: &Settings, stats: &Stats) -> String {
    format!(
        "{} {}x{} | {} rows, {} records: {} bytes | {} triangles, {} drawn, {} walks, {} overflows",
        SCENES[settings.scene].name,
        settings.size.0,
        settings.size.1,
        settings.strip_rows.min(settings.size.1),
        settings.records,
        ram(settings),
        stats.triangles,
        stats.drawn,
        stats.walks,
        stats.overflows,
    )
}

fn picture(settings: &Settings, path: &Path) -> Result<(), Box<dyn Error>> {
    let mut picture = Picture::new(settings.size);
    let stats = render(settings, settings.frame, &mut picture)?;
    picture.write_png(path)?;
    println!("{}", describe(settings, &stats));
    println!("wrote {}", path.display());
    Ok(())
}

/// A window for a picture of some size, or why there is none.
pub fn open(size: (u16, u16)) -> Result<Window, String> {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if cfg!(target_os = "linux") && !is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY") {
        return Err("neither DISPLAY nor WAYLAND_DISPLAY is set".into());
    }
    let (width, height) = (size.0.into(), size.1.into());
    let options = WindowOptions { scale: if width <= 640 { Scale::X2 } else { Scale::X1 }, ..WindowOptions::default() };
    Window::new("zstrip", width, height, options).map_err(|error| error.to_string())
}

/// The next entry above `value`, or the one below; `value` itself at the ends.
fn neighbour<T: Copy + PartialOrd>(list: impl Iterator<Item = T> + Clone, value: T, up: bool) -> T {
    let next = if up { list.clone().find(|entry| *entry > value) } else { list.filter(|entry| *entry < value).last() };
    next.unwrap_or(value)
}

/// Runs until the window is closed.
fn turn(window: &mut Window, mut settings: Settings) -> Result<(), Box<dyn Error>> {
    window.set_target_fps(60);
    let mut picture = Picture::new(settings.size);
    let (mut frame, mut paused) = (settings.frame, false);
    let (mut since, mut frames, mut drawing) = (Instant::now(), 0, Duration::ZERO);
    while window.is_open() && !window.is_key_down(Key::Escape) {
        let start = Instant::now();
        let stats = render(&settings, frame, &mut picture)?;
        drawing += start.elapsed();
        window.update_with_buffer(&picture.to_0rgb(), settings.size.0.into(), settings.size.1.into())?;
        frames += 1;
        if !paused {
            frame = frame.wrapping_add(1);
        }

        let rows = STRIP_ROWS.into_iter().filter(|rows| *rows < settings.size.1);
        let rows = rows.chain([settings.size.1]);
        let keys = window.get_keys_pressed(KeyRepeat::No);
        for key in &keys {
            match key {
                Key::Up | Key::Down => {
                    settings.strip_rows = neighbour(rows.clone(), settings.strip_rows, *key == Key::Up)
                }
                Key::Left | Key::Right => {
                    settings.records = neighbour(RECORDS.into_iter(), settings.records, *key == Key::Right);
                }
                Key::S if settings.program.all => settings.scene = (settings.scene + 1) % SCENES.len(),
                Key::Space => paused = !paused,
                _ => {}
            }
        }
        let seconds = since.elapsed().as_secs_f64();
        if seconds > 0.5 || !keys.is_empty() {
            let fps = f64::from(frames) / seconds;
            let ms = drawing.as_secs_f64() * 1e3 / f64::from(frames);
            window.set_title(&format!("{fps:.0} fps, {ms:.2} ms | {}", describe(&settings, &stats)));
            (since, frames, drawing) = (Instant::now(), 0, Duration::ZERO);
        }
    }
    Ok(())
}

fn help(program: &Program) {
    let Program { name, about, scene, .. } = program;
    println!("{about} Without a display it is written to {name}.png.\n\nusage: {name} [options]\n{OPTIONS}");
    println!("\nscenes\n  {}", if program.all { names() } else { String::from(*scene) });
}

fn run(program: &'static Program) -> Result<(), Box<dyn Error>> {
    let Some(settings) = arguments(program)? else {
        help(program);
        return Ok(());
    };
    if let Some(path) = &settings.png {
        return picture(&settings, path);
    }
    match open(settings.size) {
        Ok(mut window) => turn(&mut window, settings),
        Err(reason) => {
            println!("no window ({reason}): writing a picture instead");
            picture(&settings, Path::new(&format!("{}.png", program.name)))
        }
    }
}

/// Runs an example.
pub fn show(program: &'static Program) -> ExitCode {
    match run(program) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}: {error}", program.name);
            ExitCode::from(2)
        }
    }
}
