//! A program that shows a demo, strip by strip as on a small display: in a window with keys, or as a PNG file where
//! there is no display.

use super::Picture;
use super::options::{Settings, arguments, help};
use crate::scenes::Draw;
use minifb::{Key, KeyRepeat, Scale, Window, WindowOptions};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};
use zstrip::Renderer;
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::frame::{RamBudget, RendererError};
use zstrip::math::Angle16;
use zstrip::target::{DepthChoice, Stats, Strip, StripPixels, WithDepth, WithOcclusion, WithRecords};
use zstrip::target::{WithoutDepth, occlusion_len};

/// Lends a renderer its depth buffer, if it is to have one.
pub trait Depth: DepthChoice + Sized {
    fn lend<'b, P: PixelFormat>(
        renderer: Renderer<'b, P>,
        depth: &'b mut [u16],
    ) -> Result<Renderer<'b, P, Self>, RendererError>;
}

impl Depth for WithDepth {
    fn lend<'b, P: PixelFormat>(
        renderer: Renderer<'b, P>,
        depth: &'b mut [u16],
    ) -> Result<Renderer<'b, P, Self>, RendererError> {
        renderer.with_depth(depth)
    }
}

impl Depth for WithOcclusion {
    fn lend<'b, P: PixelFormat>(
        renderer: Renderer<'b, P>,
        depth: &'b mut [u16],
    ) -> Result<Renderer<'b, P, Self>, RendererError> {
        renderer.with_depth(depth)?.with_occlusion()
    }
}

impl Depth for WithoutDepth {
    fn lend<'b, P: PixelFormat>(
        renderer: Renderer<'b, P>,
        _: &'b mut [u16],
    ) -> Result<Renderer<'b, P, Self>, RendererError> {
        Ok(renderer)
    }
}

/// A frame of a demo, ready to be drawn.
pub type Drawing<'d, P, Z> = Box<dyn for<'p> Draw<Strip<'p, P, Z, WithRecords>> + 'd>;

/// The frame that is to be made.
pub struct Shot {
    pub number: u32,
    pub screen: Size,
    pub mode: usize,
}

impl Shot {
    /// Returns the angle of the frame: each frame adds 1/512 of a turn.
    pub fn turn(&self) -> Angle16 {
        Angle16(self.number.wrapping_mul(128) as u16)
    }
}

/// A demo to be shown.
pub trait Demo<Z: Depth = WithDepth> {
    /// The format of its strips.
    type Format: PixelFormat;

    /// Its name, and that of its picture.
    const NAME: &'static str;
    /// What it shows, in a sentence.
    const ABOUT: &'static str;
    const BACKGROUND: <Self::Format as PixelFormat>::Color;
    /// Names of its modes, where there are several.
    const MODES: &'static [&'static str] = &[];
    /// The mode to begin with.
    const FIRST: usize = 0;
    /// Words of records where the command line gives no number: enough for most demos.
    const RECORDS: usize = if Z::DEPTH { 16 * 1024 } else { 0 };
    /// The help for the keys of [`key`](Self::key), a line for each.
    const KEYS: &'static str = "";

    /// Handles a key that is held down.
    fn key(&mut self, _key: Key) {}

    /// Makes matrices, shaders and lights of one frame, in memory of the demo's own if need be. The renderer then draws
    /// the frame once or twice per strip.
    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Self::Format, Z>;
}

/// The choices of the keys; the height of the screen is the tallest strip.
const STRIP_ROWS: [u16; 7] = [1, 2, 4, 7, 8, 16, 40];
const RECORDS: [usize; 5] = [0, 100, 1000, 16 * 1024, 64 * 1024];
const DIGITS: [Key; 9] =
    [Key::Key1, Key::Key2, Key::Key3, Key::Key4, Key::Key5, Key::Key6, Key::Key7, Key::Key8, Key::Key9];

/// Draws a frame through strips, as a display would get it.
fn render<D: Demo<Z>, Z: Depth>(
    demo: &mut D,
    settings: &Settings,
    picture: &mut Picture,
) -> Result<Stats, Box<dyn Error>> {
    let (width, rows) = (usize::from(settings.size.0), usize::from(settings.strip_rows.min(settings.size.1)));
    let pixels = width * rows;
    let coarse = if Z::OCCLUDES { occlusion_len(width, rows) } else { 0 };
    let depths = if Z::DEPTH { pixels + coarse } else { 0 };
    let mut color = vec![bytemuck::Zeroable::zeroed(); pixels];
    let (mut depth, mut records) = (vec![0; depths], vec![0; settings.records]);
    let (width, height) = settings.size;
    let screen = Size::new(width.into(), height.into());
    let renderer = Renderer::<D::Format>::new(screen)?;
    let mut renderer = <Z as Depth>::lend(renderer, &mut depth)?.with_records(&mut records);
    let to_picture = |strip: &StripPixels<'_, D::Format>| {
        picture.put(strip);
        Ok::<(), std::convert::Infallible>(())
    };
    let drawing = demo.frame(&Shot { number: settings.frame, screen, mode: settings.mode });
    Ok(renderer.frame_to(to_picture, &mut color, D::BACKGROUND, |scene| drawing.draw(scene))?)
}

/// Returns settings and statistics in a line.
fn describe<D: Demo<Z>, Z: Depth>(settings: &Settings, stats: &Stats) -> String {
    let (width, height) = settings.size;
    let rows = settings.strip_rows.min(height);
    let budget = RamBudget::new::<D::Format>(width.into(), rows.into()).with_record_words(settings.records);
    let ram = if Z::DEPTH { budget } else { budget.without_depth() };
    let mut line = D::NAME.to_string();
    line.extend(D::MODES.get(settings.mode).map(|mode| format!(" {mode}")));
    line += &format!(" {width}x{height} | {rows} rows, {} records: {} bytes |", settings.records, ram.total());
    line += &format!(" {} triangles, {} drawn", stats.triangles, stats.drawn);
    if stats.lines + stats.points > 0 {
        line += &format!(", {} lines, {} points", stats.lines, stats.points);
    }
    line + &format!(", {} walks, {} overflows", stats.walks, stats.overflows)
}

fn picture<D: Demo<Z>, Z: Depth>(demo: &mut D, settings: &Settings, path: &Path) -> Result<(), Box<dyn Error>> {
    let mut picture = Picture::new(settings.size);
    let stats = render(demo, settings, &mut picture)?;
    picture.write_png(path)?;
    println!("{}", describe::<D, Z>(settings, &stats));
    println!("wrote {}", path.display());
    Ok(())
}

/// Opens the window, or returns why there is none.
fn open(name: &str, (width, height): (u16, u16)) -> Result<Window, String> {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if cfg!(target_os = "linux") && !is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY") {
        return Err("neither DISPLAY nor WAYLAND_DISPLAY is set".into());
    }
    let options = WindowOptions { scale: if width <= 640 { Scale::X2 } else { Scale::X1 }, ..WindowOptions::default() };
    Window::new(name, width.into(), height.into(), options).map_err(|error| error.to_string())
}

/// Returns the next entry above `value`, or the one below; `value` itself at the ends.
fn neighbour<T: Copy + PartialOrd>(list: impl Iterator<Item = T> + Clone, value: T, up: bool) -> T {
    let next = if up { list.clone().find(|entry| *entry > value) } else { list.filter(|entry| *entry < value).last() };
    next.unwrap_or(value)
}

/// Changes the settings by a key that was pressed.
fn press<D: Demo<Z>, Z: Depth>(key: Key, settings: &mut Settings, paused: &mut bool) {
    let height = settings.size.1;
    let rows = STRIP_ROWS.into_iter().filter(|rows| *rows < height).chain([height]);
    match key {
        Key::Up | Key::Down => settings.strip_rows = neighbour(rows, settings.strip_rows, key == Key::Up),
        Key::Left | Key::Right => {
            settings.records = neighbour(RECORDS.into_iter(), settings.records, key == Key::Right);
        }
        // S is a second key for it, unless it steers something.
        Key::M | Key::S if key == Key::M || D::KEYS.is_empty() => {
            settings.mode = (settings.mode + 1) % D::MODES.len().max(1);
        }
        Key::Space => *paused = !*paused,
        Key::Comma => settings.frame = settings.frame.wrapping_sub(1),
        Key::Period => settings.frame = settings.frame.wrapping_add(1),
        _ => {
            let digit = DIGITS.iter().position(|digit| *digit == key);
            settings.mode = digit.filter(|mode| *mode < D::MODES.len()).unwrap_or(settings.mode);
        }
    }
}

/// Runs until the window is closed.
fn play<D: Demo<Z>, Z: Depth>(demo: &mut D, window: &mut Window, mut settings: Settings) -> Result<(), Box<dyn Error>> {
    window.set_target_fps(60);
    let mut picture = Picture::new(settings.size);
    let mut paused = false;
    let (mut since, mut frames, mut drawing) = (Instant::now(), 0, Duration::ZERO);
    while window.is_open() && !window.is_key_down(Key::Escape) {
        let start = Instant::now();
        let stats = render(demo, &settings, &mut picture)?;
        drawing += start.elapsed();
        window.update_with_buffer(&picture.to_0rgb(), settings.size.0.into(), settings.size.1.into())?;
        frames += 1;
        let seconds = since.elapsed().as_secs_f64();
        if seconds > 0.5 {
            let (fps, ms) = (f64::from(frames) / seconds, drawing.as_secs_f64() * 1e3 / f64::from(frames));
            window.set_title(&format!("{fps:.0} fps, {ms:.2} ms | {}", describe::<D, Z>(&settings, &stats)));
            (since, frames, drawing) = (Instant::now(), 0, Duration::ZERO);
        }
        settings.frame = settings.frame.wrapping_add(u32::from(!paused));
        window.get_keys().into_iter().for_each(|key| demo.key(key));
        for key in window.get_keys_pressed(KeyRepeat::No) {
            press::<D, Z>(key, &mut settings, &mut paused);
        }
    }
    Ok(())
}

fn run<D: Demo<Z>, Z: Depth>(demo: &mut D) -> Result<(), Box<dyn Error>> {
    let Some(settings) = arguments::<D, Z>()? else {
        println!("{}", help::<D, Z>());
        return Ok(());
    };
    if let Some(path) = &settings.png {
        return picture(demo, &settings, path);
    }
    match open(D::NAME, settings.size) {
        Ok(mut window) => play(demo, &mut window, settings),
        Err(reason) => {
            println!("no window ({reason}): writing a picture instead");
            picture(demo, &settings, &PathBuf::from(format!("{}.png", D::NAME)))
        }
    }
}

/// Runs an example.
pub fn show<D: Demo<Z>, Z: Depth>(mut demo: D) -> ExitCode {
    match run(&mut demo) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}: {error}", D::NAME);
            ExitCode::from(2)
        }
    }
}
