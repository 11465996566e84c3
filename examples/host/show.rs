//! A program that shows a turning scene: in a window with keys, or as a PNG file where there is no display.

use super::Picture;
use minifb::{Key, KeyRepeat, Scale, Window, WindowOptions};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::math::Angle;
use zstrip::output::{Dithered, Stats, Strip, StripPixels};
use zstrip::{Buffers, Renderer, Scene};

/// What is drawn into.
type Format = Dithered<Rgb565>;

/// One way to draw the scene: its name, and how, for an angle that a frame adds 1/512 of a turn to.
pub struct Variant {
    pub name: &'static str,
    pub draw: fn(&mut Scene<'_, Strip<'_, Format>>, Angle),
}

/// A program.
pub struct Show {
    pub name: &'static str,
    pub about: &'static str,
    pub variants: &'static [Variant],
}

struct Settings {
    png: Option<PathBuf>,
    strip_rows: u16,
    records: usize,
    frame: u32,
    variant: usize,
    size: (u16, u16),
}

impl Show {
    fn names(&self) -> String {
        self.variants.iter().map(|variant| variant.name).collect::<Vec<_>>().join(", ")
    }

    fn help(&self) -> String {
        format!(
            "{about}
Without a display a picture is written to {name}.png.

usage: {name} [options]
  --png FILE        write a picture instead of opening a window
  --variant NAME    how it is drawn: {names}
  --frame N         number of the first frame, 512 make a turn (0)
  --size WxH        pixels of the screen (320x240)
  --strip-rows N    rows of a strip (16)
  --records N       words of records, of 4 bytes; 0 is allowed (65536)
  --help            this text

keys in the window
  1 to {count}            how it is drawn
  Space             pause
  Left, Right       a step back or forth
  Esc               quit",
            about = self.about,
            name = self.name,
            names = self.names(),
            count = self.variants.len(),
        )
    }

    /// The settings, or `None` if help was asked for.
    fn arguments(&self) -> Result<Option<Settings>, Box<dyn Error>> {
        use lexopt::prelude::*;
        let mut settings =
            Settings { png: None, strip_rows: 16, records: 1 << 16, frame: 0, variant: 0, size: (320, 240) };
        let variant = |name: &str| {
            let found = self.variants.iter().position(|variant| variant.name == name);
            found.ok_or_else(|| format!("the variants are {}", self.names()))
        };
        let size = |text: &str| {
            let parsed = text.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
            parsed.ok_or_else(|| "a size is like 320x240".to_string())
        };
        let mut parser = lexopt::Parser::from_env();
        while let Some(argument) = parser.next()? {
            match argument {
                Long("png") => settings.png = Some(parser.value()?.into()),
                Long("strip-rows") => settings.strip_rows = parser.value()?.parse()?,
                Long("records") => settings.records = parser.value()?.parse()?,
                Long("frame") => settings.frame = parser.value()?.parse()?,
                Long("variant") => settings.variant = parser.value()?.parse_with(variant)?,
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

    /// Draws a frame through strips, as a display would get it.
    fn render(&self, settings: &Settings, frame: u32, picture: &mut Picture) -> Result<Stats, Box<dyn Error>> {
        let pixels = usize::from(settings.size.0) * usize::from(settings.strip_rows.min(settings.size.1));
        let (mut color, mut depth, mut records) = (vec![0; pixels], vec![0; pixels], vec![0; settings.records]);
        let buffers = Buffers { color: &mut color, depth: &mut depth, records: &mut records };
        let mut renderer = Renderer::<Format>::new(settings.size, buffers)?;
        let to_picture = |strip: &StripPixels<'_, Format>| {
            picture.put(strip);
            Ok::<(), std::convert::Infallible>(())
        };
        let turn = Angle(frame.wrapping_mul(128) as u16);
        let draw = self.variants[settings.variant].draw;
        Ok(renderer.frame_to(to_picture, Rgb565::new(0, 0, 0), |scene| draw(scene, turn))?)
    }

    fn describe(&self, settings: &Settings, stats: &Stats) -> String {
        format!(
            "{} {} | {} triangles, {} drawn, {} walks",
            self.name, self.variants[settings.variant].name, stats.triangles, stats.drawn, stats.walks,
        )
    }

    fn picture(&self, settings: &Settings, path: &Path) -> Result<(), Box<dyn Error>> {
        let mut picture = Picture::new(settings.size);
        let stats = self.render(settings, settings.frame, &mut picture)?;
        picture.write_png(path)?;
        println!("{}", self.describe(settings, &stats));
        println!("wrote {}", path.display());
        Ok(())
    }

    /// Runs until the window is closed.
    fn turn(&self, window: &mut Window, mut settings: Settings) -> Result<(), Box<dyn Error>> {
        const DIGITS: [Key; 9] =
            [Key::Key1, Key::Key2, Key::Key3, Key::Key4, Key::Key5, Key::Key6, Key::Key7, Key::Key8, Key::Key9];
        window.set_target_fps(60);
        let mut picture = Picture::new(settings.size);
        let (mut frame, mut paused) = (settings.frame, false);
        let (mut since, mut frames, mut drawing) = (Instant::now(), 0, Duration::ZERO);
        while window.is_open() && !window.is_key_down(Key::Escape) {
            let start = Instant::now();
            let stats = self.render(&settings, frame, &mut picture)?;
            drawing += start.elapsed();
            window.update_with_buffer(&picture.to_0rgb(), settings.size.0.into(), settings.size.1.into())?;
            frames += 1;
            frame = frame.wrapping_add(u32::from(!paused));
            for key in window.get_keys_pressed(KeyRepeat::Yes) {
                match key {
                    Key::Space => paused = !paused,
                    Key::Left => frame = frame.wrapping_sub(1),
                    Key::Right => frame = frame.wrapping_add(1),
                    _ => {
                        let digit = DIGITS.iter().position(|digit| *digit == key);
                        settings.variant = digit.filter(|k| *k < self.variants.len()).unwrap_or(settings.variant);
                    }
                }
            }
            let seconds = since.elapsed().as_secs_f64();
            if seconds > 0.5 {
                let (fps, ms) = (f64::from(frames) / seconds, drawing.as_secs_f64() * 1e3 / f64::from(frames));
                window.set_title(&format!("{fps:.0} fps, {ms:.2} ms | {}", self.describe(&settings, &stats)));
                (since, frames, drawing) = (Instant::now(), 0, Duration::ZERO);
            }
        }
        Ok(())
    }

    fn run(&self) -> Result<(), Box<dyn Error>> {
        let Some(settings) = self.arguments()? else {
            println!("{}", self.help());
            return Ok(());
        };
        if let Some(path) = &settings.png {
            return self.picture(&settings, path);
        }
        match open(settings.size) {
            Ok(mut window) => self.turn(&mut window, settings),
            Err(reason) => {
                println!("no window ({reason}): writing a picture instead");
                self.picture(&settings, Path::new(&format!("{}.png", self.name)))
            }
        }
    }

    /// The program.
    pub fn main(&self) -> ExitCode {
        match self.run() {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("{}: {error}", self.name);
                ExitCode::from(2)
            }
        }
    }
}

/// A window, or why there is none.
fn open((width, height): (u16, u16)) -> Result<Window, String> {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if cfg!(target_os = "linux") && !is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY") {
        return Err("neither DISPLAY nor WAYLAND_DISPLAY is set".into());
    }
    let options = WindowOptions { scale: if width <= 640 { Scale::X2 } else { Scale::X1 }, ..WindowOptions::default() };
    Window::new("zstrip", width.into(), height.into(), options).map_err(|error| error.to_string())
}
