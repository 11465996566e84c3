//! A window for a program that draws one thing in several ways, or a picture where there is none.

use crate::host::Picture;
use minifb::{Key, KeyRepeat, Scale, Window, WindowOptions};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::math::Angle;
use zstrip::output::{Stats, Strip, StripPixels};
use zstrip::{Buffers, Renderer, Scene};

/// What is shown.
pub struct Show {
    /// The program's name.
    pub name: &'static str,
    /// What it is, for the help.
    pub about: &'static str,
    /// The ways to draw it; the key M goes to the next.
    pub modes: &'static [&'static str],
    pub background: Rgb565,
    /// Draws it at a time, in one of the ways.
    pub draw: fn(&mut Scene<'_, Strip<'_, Rgb565>>, Angle, usize),
}

const SIZE: (u16, u16) = (320, 240);
const ROWS: usize = 16;
/// Enough for all of what is shown.
const RECORDS: usize = 16 * 1024;

struct Settings {
    png: Option<PathBuf>,
    frame: u32,
    mode: usize,
}

impl Show {
    fn arguments(&self) -> Result<Option<Settings>, Box<dyn Error>> {
        use lexopt::prelude::*;
        let mut settings = Settings { png: None, frame: 0, mode: 0 };
        let mut parser = lexopt::Parser::from_env();
        while let Some(argument) = parser.next()? {
            match argument {
                Long("png") => settings.png = Some(parser.value()?.into()),
                Long("frame") => settings.frame = parser.value()?.parse()?,
                Long("mode") => settings.mode = parser.value()?.parse()?,
                Long("help") | Short('h') => return Ok(None),
                _ => return Err(argument.unexpected().into()),
            }
        }
        if settings.mode >= self.modes.len() {
            return Err(format!("modes are 0 to {}", self.modes.len() - 1).into());
        }
        Ok(Some(settings))
    }

    fn render(&self, frame: u32, mode: usize, picture: &mut Picture) -> Result<Stats, Box<dyn Error>> {
        let pixels = usize::from(SIZE.0) * ROWS;
        let (mut color, mut depth, mut records) = (vec![0; pixels], vec![0; pixels], vec![0; RECORDS]);
        let buffers = Buffers { color: &mut color, depth: &mut depth, records: &mut records };
        let mut renderer = Renderer::<Rgb565>::new(SIZE, buffers)?;
        let to_picture = |strip: &StripPixels<'_, Rgb565>| {
            picture.put(strip);
            Ok::<(), std::convert::Infallible>(())
        };
        let time = Angle(frame.wrapping_mul(128) as u16);
        Ok(renderer.frame_to(to_picture, self.background, |scene| (self.draw)(scene, time, mode))?)
    }

    fn picture(&self, settings: &Settings, path: &Path) -> Result<(), Box<dyn Error>> {
        let mut picture = Picture::new(SIZE);
        let stats = self.render(settings.frame, settings.mode, &mut picture)?;
        picture.write_png(path)?;
        println!("{}: {}; {} triangles drawn", self.name, self.modes[settings.mode], stats.drawn);
        println!("wrote {}", path.display());
        Ok(())
    }

    fn window(&self, mut window: Window, settings: &Settings) -> Result<(), Box<dyn Error>> {
        window.set_target_fps(60);
        let mut picture = Picture::new(SIZE);
        let (mut frame, mut mode, mut paused) = (settings.frame, settings.mode, false);
        while window.is_open() && !window.is_key_down(Key::Escape) {
            self.render(frame, mode, &mut picture)?;
            window.set_title(&format!("{}: {}", self.name, self.modes[mode]));
            window.update_with_buffer(&picture.to_0rgb(), SIZE.0.into(), SIZE.1.into())?;
            frame = frame.wrapping_add(u32::from(!paused));
            for key in window.get_keys_pressed(KeyRepeat::No) {
                match key {
                    Key::M => mode = (mode + 1) % self.modes.len(),
                    Key::Space => paused = !paused,
                    _ => {}
                }
            }
        }
        Ok(())
    }

    fn help(&self) {
        println!("{}", self.about);
        println!("\nusage: {} [--png FILE] [--frame N] [--mode N]", self.name);
        println!("\n  --png FILE   write a picture instead of opening a window");
        println!("  --frame N    number of the first frame, 512 are a turn (0)");
        println!("  --mode N     one of");
        self.modes.iter().enumerate().for_each(|(k, mode)| println!("                 {k}: {mode}"));
        println!("\nkeys in the window: M next mode, Space pause, Esc quit");
    }

    fn try_run(&self) -> Result<(), Box<dyn Error>> {
        let Some(settings) = self.arguments()? else {
            self.help();
            return Ok(());
        };
        if let Some(path) = &settings.png {
            return self.picture(&settings, path);
        }
        let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
        let has_display = !cfg!(target_os = "linux") || is_set("DISPLAY") || is_set("WAYLAND_DISPLAY");
        let options = WindowOptions { scale: Scale::X2, ..WindowOptions::default() };
        let window = has_display.then(|| Window::new(self.name, SIZE.0.into(), SIZE.1.into(), options));
        match window {
            Some(Ok(window)) => self.window(window, &settings),
            Some(Err(error)) => self.instead(&settings, &error.to_string()),
            None => self.instead(&settings, "neither DISPLAY nor WAYLAND_DISPLAY is set"),
        }
    }

    fn instead(&self, settings: &Settings, reason: &str) -> Result<(), Box<dyn Error>> {
        println!("no window ({reason}): writing a picture instead");
        self.picture(settings, Path::new(&format!("{}.png", self.name)))
    }

    /// The program.
    pub fn run(&self) -> ExitCode {
        match self.try_run() {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("{}: {error}", self.name);
                ExitCode::from(2)
            }
        }
    }
}
