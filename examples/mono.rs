//! A turning torus on a panel of 128×64 pixels that are on or off, like an SSD1306: in a window, or in a PNG file where
//! there is no display. The picture is made from the bytes that the panel would get.
//!
//! ```text
//! cargo run --release --example mono -- --help
//! ```
mod host;
mod scenes;

use minifb::{Key, KeyRepeat, Window, WindowOptions};
use scenes::{Draw, Room};
use std::convert::Infallible;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use zstrip::color::Dither;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{BinaryColor, Gray8};
use zstrip::frame::{RamBudget, Renderer};
use zstrip::light::{Matte, Sunlit};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::shader::Gouraud;
use zstrip::target::{Packer, Pages, Strip, StripPixels, WithDepth, WithRecords};
use zstrip::{Framebuffer, Scene};

const HELP: &str = "\
A turning torus on a monochrome panel of 128x64 pixels. Without a display it is written to mono.png.

usage: mono [options]
  --png FILE        write a picture instead of opening a window
  --strip-rows N    rows of a strip, a multiple of 8 (8)
  --dither NAME     nearest, bayer4, bayer8, bright4, bright8 (bayer8)
  --scene NAME      torus, room (torus)
  --frame N         number of the first frame, 512 make a turn (0)

keys in the window
  Up, Down          higher and lower strips
  D                 next dithering
  S                 next scene
  Space             pause
  Esc               quit";

const SIZE: (u16, u16) = (128, 64);
/// Dots of the picture per pixel of the panel, each way.
const ZOOM: usize = 5;

const DITHERS: [(&str, Dither<BinaryColor>); 5] = [
    ("nearest", Dither::NEAREST),
    ("bayer4", Dither::BAYER_4),
    ("bayer8", Dither::BAYER_8),
    ("bright4", Dither::BRIGHT_4),
    ("bright8", Dither::BRIGHT_8),
];
const SCENES: [&str; 2] = ["torus", "room"];

struct Settings {
    png: Option<PathBuf>,
    strip_rows: u16,
    dither: usize,
    scene: usize,
    frame: u32,
}

/// Returns the settings, or `None` if help was asked for.
fn arguments() -> Result<Option<Settings>, Box<dyn Error>> {
    use lexopt::prelude::*;
    let mut settings = Settings { png: None, strip_rows: 8, dither: 2, scene: 0, frame: 0 };
    let mut parser = lexopt::Parser::from_env();
    while let Some(argument) = parser.next()? {
        match argument {
            Long("png") => settings.png = Some(parser.value()?.into()),
            Long("strip-rows") => settings.strip_rows = parser.value()?.parse()?,
            Long("dither") => {
                settings.dither = parser.value()?.parse_with(|name| place(&DITHERS.map(|d| d.0), name))?
            }
            Long("scene") => settings.scene = parser.value()?.parse_with(|name| place(&SCENES, name))?,
            Long("frame") => settings.frame = parser.value()?.parse()?,
            Long("help") | Short('h') => return Ok(None),
            _ => return Err(argument.unexpected().into()),
        }
    }
    Ok(Some(settings))
}

fn place(names: &[&str], name: &str) -> Result<usize, String> {
    names.iter().position(|known| *known == name).ok_or_else(|| format!("one of {}", names.join(", ")))
}

/// Draws a frame and packs it. Returns the bytes that the panel would get, one page after the other.
fn frame(settings: &Settings, number: u32) -> Result<Vec<u8>, Box<dyn Error>> {
    let pixels = usize::from(SIZE.0) * usize::from(settings.strip_rows.min(SIZE.1));
    let (mut color, mut depth, mut records) = (vec![0; pixels], vec![0; pixels], vec![0; 4096]);
    let screen = Size::new(SIZE.0.into(), SIZE.1.into());
    let renderer = Renderer::<Gray8>::new(screen)?.with_depth(&mut depth)?;
    let mut renderer = renderer.with_records(&mut records);
    let mut bytes = vec![0; pixels / 8];
    let (_, dither) = DITHERS[settings.dither];
    let mut packer = Packer::<Pages>::new(screen, settings.strip_rows.into(), dither, &mut bytes)?;
    let mut sent = Vec::new();
    let to_panel = |strip: &StripPixels<'_, Gray8>| {
        sent.extend_from_slice(packer.pack(strip));
        Ok::<(), Infallible>(())
    };
    let turn = Angle16(number.wrapping_mul(128) as u16);
    let drawing: Drawing = match settings.scene {
        0 => Box::new(NearTorus::new(screen, turn)),
        _ => Box::new(Room::new(screen, turn)),
    };
    renderer.frame_to(to_panel, &mut color, Gray8::new(0), |scene| drawing.draw(scene))?;
    Ok(sent)
}

/// A scene, ready to be drawn in greys.
type Drawing = Box<dyn for<'p> Draw<Strip<'p, Gray8, WithDepth, WithRecords>>>;

/// The torus nearer and in white, for a panel without greys.
struct NearTorus {
    mvp: Projective,
    shader: Gouraud<Sunlit>,
}

impl NearTorus {
    fn new(screen: Size, turn: Angle16) -> Self {
        let nearer = Affine::translation(Vec3::from_milli(0, 0, 500)) * scenes::torus_model(turn);
        let camera = scenes::camera(screen, Scalar::from_bits(1 << 15), Scalar::from_bits(12 << 16));
        Self { mvp: camera * nearer, shader: Gouraud::new(scenes::LIGHT.on(&Matte::WHITE, &nearer)) }
    }
}

impl<F: Framebuffer> Draw<F> for NearTorus {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        scene.draw(&scenes::torus::MESH, &self.mvp, &self.shader);
    }
}

/// Returns the panel's picture, enlarged: rows of dots that are on or off.
fn dots(pages: &[u8]) -> Vec<bool> {
    let (width, height) = (usize::from(SIZE.0), usize::from(SIZE.1));
    let lit = |x: usize, y: usize| pages[y / 8 * width + x] >> (y % 8) & 1 == 1;
    (0..height * ZOOM).flat_map(|y| (0..width * ZOOM).map(move |x| lit(x / ZOOM, y / ZOOM))).collect()
}

fn size() -> (usize, usize) {
    (usize::from(SIZE.0) * ZOOM, usize::from(SIZE.1) * ZOOM)
}

fn describe(settings: &Settings) -> String {
    let ram = RamBudget::new::<Gray8>(SIZE.0.into(), settings.strip_rows.min(SIZE.1).into());
    let packed = ram.color / 8;
    let (name, _) = DITHERS[settings.dither];
    format!(
        "{}, {name}, strips of {} rows: {} bytes",
        SCENES[settings.scene],
        settings.strip_rows,
        ram.total() + packed
    )
}

fn picture(settings: &Settings, path: &Path) -> Result<(), Box<dyn Error>> {
    let dots = dots(&frame(settings, settings.frame)?);
    let bytes: Vec<u8> = dots.iter().flat_map(|lit| if *lit { [220, 240, 255] } else { [8, 12, 20] }).collect();
    host::write_png(path, (size().0 as u16, size().1 as u16), &bytes)?;
    println!("{}\nwrote {}", describe(settings), path.display());
    Ok(())
}

/// Opens the window, or returns why there is none.
fn open() -> Result<Window, String> {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if cfg!(target_os = "linux") && !is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY") {
        return Err("neither DISPLAY nor WAYLAND_DISPLAY is set".into());
    }
    Window::new("zstrip", size().0, size().1, WindowOptions::default()).map_err(|error| error.to_string())
}

/// Runs until the window is closed.
fn turn(window: &mut Window, mut settings: Settings) -> Result<(), Box<dyn Error>> {
    window.set_target_fps(60);
    let (mut number, mut paused) = (settings.frame, false);
    while window.is_open() && !window.is_key_down(Key::Escape) {
        let dots = dots(&frame(&settings, number)?);
        let colors: Vec<u32> = dots.iter().map(|lit| if *lit { 0xDC_F0FF } else { 0x08_0C14 }).collect();
        window.update_with_buffer(&colors, size().0, size().1)?;
        number = number.wrapping_add(u32::from(!paused));
        for key in window.get_keys_pressed(KeyRepeat::No) {
            match key {
                Key::Up => settings.strip_rows = (settings.strip_rows * 2).min(64),
                Key::Down => settings.strip_rows = (settings.strip_rows / 2).max(8),
                Key::D => settings.dither = (settings.dither + 1) % DITHERS.len(),
                Key::S => settings.scene = (settings.scene + 1) % SCENES.len(),
                Key::Space => paused = !paused,
                _ => {}
            }
        }
        window.set_title(&describe(&settings));
    }
    Ok(())
}

fn run() -> Result<(), Box<dyn Error>> {
    let Some(settings) = arguments()? else {
        println!("{HELP}");
        return Ok(());
    };
    if let Some(path) = &settings.png {
        return picture(&settings, path);
    }
    match open() {
        Ok(mut window) => turn(&mut window, settings),
        Err(reason) => {
            println!("no window ({reason}): writing a picture instead");
            picture(&settings, Path::new("mono.png"))
        }
    }
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("mono: {error}");
            ExitCode::from(2)
        }
    }
}
