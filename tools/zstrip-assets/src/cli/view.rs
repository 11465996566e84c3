//! `view`: a window in which a model turns and plays its clips, exactly as firmware draws it; and files of that.

use super::animation::write_gif;
use super::arguments::{self, A_COUNT, A_WHOLE, Conversion, PANEL_OPTIONS, Screen, number};
use super::failure::Failure;
use super::{help, source};
use lexopt::{Parser, ValueExt};
use minifb::{Key, KeyRepeat, Scale, Window, WindowOptions};
use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;
use zstrip::math::Angle16;
use zstrip::target::Stats;
use zstrip_assets::preview::{Format, Picture, Stage, Step};

const VIEW: &str = "\
zstrip-assets view FILE [options]: shows the model turning in a window, as firmware draws it

  --png FILE              writes a picture instead of opening a window
  --gif FILE              writes a whole turn, in which the clip plays, instead of opening a window
  --clip NAME             clip to begin with, also as a number from 0 on [default: the first one]
  --turn DEGREES          angle to begin with, a whole number [default: 0]
  --time MS               time in the clip to begin with, in milliseconds [default: 0]

Keys in the window:
  Space                   pause
  Left, Right             turn
  Up, Down                higher and lower strips
  plus, minus             larger and smaller
  C                       next clip
  F                       next format of pixels
  comma, period           a frame back or forth
  Esc                     quit
";

/// Milliseconds of a turn, and of a frame of a file.
pub const TURN: u32 = 6000;
pub const FRAME: u32 = 50;
/// Heights of strips that keys choose; the height of the screen is the last one.
const ROWS: [u32; 6] = [1, 4, 8, 16, 32, 64];

/// The picture in a window, as keys change it.
#[derive(Clone)]
pub struct Show {
    pub name: String,
    pub screen: Screen,
    pub clip: usize,
    /// The angle at the start.
    pub angle: Angle16,
    /// Milliseconds in the clip at the start.
    pub time: u32,
    /// Milliseconds since the start; keys go back before it.
    pub passed: i64,
    pub paused: bool,
}

impl Show {
    /// Returns the show at another time.
    pub fn at(&self, passed: i64) -> Self {
        Self { passed, ..self.clone() }
    }

    /// Returns the frame at the show's time.
    pub fn step(&self, stage: &Stage<'_>) -> Step {
        let turned = 65_536 * self.passed.rem_euclid(TURN.into()) / i64::from(TURN);
        let at = |duration: u32| {
            let duration = i64::from(duration.max(1));
            ((i64::from(self.time) % duration + self.passed.rem_euclid(duration)) % duration) as u32
        };
        Step {
            turn: Angle16(self.angle.0.wrapping_add(turned as u16)),
            motion: stage.model().clip(self.clip).map(|clip| clip.looped(at(clip.duration()))),
        }
    }

    /// Changes the show by a key. `clips` is the number of clips.
    fn press(&mut self, key: Key, clips: usize) {
        let panel = &mut self.screen.panel;
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
                let at = Format::ALL.iter().position(|(format, ..)| *format == self.screen.format).unwrap_or(0);
                self.screen.format = Format::ALL[(at + 1) % Format::ALL.len()].0;
            }
            Key::Comma => self.passed = self.passed.wrapping_sub(FRAME.into()),
            Key::Period => self.passed = self.passed.wrapping_add(FRAME.into()),
            _ => {}
        }
    }

    /// Returns settings and statistics in a line.
    fn describe(&self, stage: &Stage<'_>, stats: &Stats) -> String {
        let Self { name, screen: Screen { panel, format, .. }, .. } = self;
        let clip =
            stage.model().clip(self.clip).map_or(String::new(), |clip| format!(" {}", clip.name().escape_debug()));
        let format = Format::ALL.iter().find(|(known, ..)| known == format).map_or("", |(_, name, _)| name);
        let ((width, height), rows) = ((panel.width, panel.height), panel.rows);
        let Stats { vertices, triangles, drawn, .. } = stats;
        format!(
            "{name}{clip} {width}x{height} {format} | {rows} rows | {vertices} vertices, {triangles} triangles, {drawn} drawn"
        )
    }
}

/// Runs `view`.
pub fn view(parser: &mut Parser) -> Result<String, Failure> {
    let (mut conversion, mut screen) = (Conversion::default(), Screen::default());
    let (mut png, mut gif, mut clip, mut turn, mut time) = (None, None, None, 0_i32, 0_u32);
    let take = &mut |name: &str, parser: &mut Parser| {
        match name {
            "png" => png = Some(PathBuf::from(parser.value()?)),
            "gif" => gif = Some(PathBuf::from(parser.value()?)),
            "clip" => clip = Some(parser.value()?.string()?),
            "turn" => turn = number(name, A_WHOLE, parser)?,
            "time" => time = number(name, A_COUNT, parser)?,
            _ => return Ok(screen.take(name, parser)? || conversion.take(name, parser)?),
        }
        Ok(true)
    };
    let Some(file) = arguments::read(parser, take)? else { return Ok(help(&format!("{VIEW}\n{PANEL_OPTIONS}"))) };
    let outputs = [&png, &gif].into_iter().flatten().map(PathBuf::as_path).collect::<Vec<_>>();
    let (container, _) = source::container(&file, &conversion, &outputs)?;
    let stage = source::stage(&file, &container, &screen)?;
    let clips: Vec<_> = stage.model().clips().map(|clip| clip.name().to_owned()).collect();
    let clip = match clip {
        None => 0,
        Some(name) => clip_of(&clips, &name)?,
    };
    if time > 0 && clips.is_empty() {
        return Err(Failure::Usage("--time: the model has no clips, so no time changes it".to_owned()));
    }
    let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let show = Show { name, screen, clip, angle: Angle16::from_degrees(turn), time, passed: 0, paused: false };
    let mut text = String::new();
    if let Some(path) = &png {
        let (picture, stats) = stage.picture(&show.step(&stage))?;
        picture.write_png(path)?;
        // Writing to a string does not fail.
        _ = writeln!(text, "{}\nwrote {}", show.describe(&stage, &stats), path.display());
    }
    if let Some(path) = &gif {
        let frames = write_gif(&stage, &show, path)?;
        _ = writeln!(text, "wrote {}: {frames} frames", path.display());
    }
    if png.is_none() && gif.is_none() {
        play(stage, show, clips.len())?;
    }
    Ok(text)
}

/// Returns the number of a clip by its name, or by its number where no clip has that name.
fn clip_of(clips: &[String], name: &str) -> Result<usize, Failure> {
    let number = || name.parse().ok().filter(|number| *number < clips.len());
    clips.iter().position(|known| known == name).or_else(number).ok_or_else(|| {
        let names = clips.iter().map(|known| format!("{known:?}")).collect::<Vec<_>>().join(", ");
        let there = if clips.is_empty() { "no clips".to_owned() } else { format!("these: {names}") };
        Failure::Usage(format!("there is no clip {name:?}: the model has {there}"))
    })
}

/// Opens a window, or returns why there is none.
fn open((width, height): (u32, u32)) -> Result<Window, Failure> {
    let fault = |error: &str| Failure::Failed(format!("no window: {error}; --png and --gif write files instead"));
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if cfg!(target_os = "linux") && !is_set("DISPLAY") {
        return Err(fault("DISPLAY is not set"));
    }
    let options = WindowOptions { scale: if width <= 640 { Scale::X2 } else { Scale::X1 }, ..WindowOptions::default() };
    Window::new("zstrip", width as usize, height as usize, options).map_err(|error| fault(&error.to_string()))
}

/// Runs until the window is closed.
fn play(mut stage: Stage<'_>, mut show: Show, clips: usize) -> Result<(), Failure> {
    let panel = show.screen.panel;
    let mut window = open((panel.width, panel.height))?;
    window.set_target_fps(60);
    let mut before = Instant::now();
    while window.is_open() && !window.is_key_down(Key::Escape) {
        let (picture, stats) = stage.picture(&show.step(&stage))?;
        let (width, height) = picture.size();
        window
            .update_with_buffer(&to_0rgb(&picture), width as usize, height as usize)
            .map_err(|error| Failure::Failed(format!("the window: {error}")))?;
        window.set_title(&show.describe(&stage, &stats));
        let milliseconds = before.elapsed().as_millis() as i64;
        before = Instant::now();
        show.passed = show.passed.wrapping_add(if show.paused { 0 } else { milliseconds });
        for key in window.get_keys_pressed(KeyRepeat::Yes) {
            show.press(key, clips);
            let Screen { panel, format, .. } = show.screen;
            stage = stage.on(panel, format)?;
        }
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
    use crate::cli::made_up;
    use zstrip_assets::preview::{Container, Panel};

    fn show() -> Show {
        let panel = Panel { width: 48, height: 64, rows: 16, zoom: 100 };
        let screen = Screen { panel, ..Screen::default() };
        Show { name: "model".to_owned(), screen, clip: 0, angle: Angle16(0), time: 0, passed: 0, paused: false }
    }

    #[test]
    fn keys_keep_the_panel_within_what_a_stage_takes() {
        let mut show = show();
        for key in [Key::Up, Key::Down, Key::Equal, Key::Minus, Key::F, Key::C, Key::Comma, Key::Left] {
            for _ in 0..100 {
                show.press(key, 3);
                let Panel { height, rows, zoom, .. } = show.screen.panel;
                assert!((1..=height).contains(&rows) && (1..=10_000).contains(&zoom) && show.clip < 3, "{key:?}");
            }
        }
        assert_eq!(show.screen.panel.rows, 1, "down after up");
        assert_eq!(show.screen.format, Format::Rgb565, "a hundred times five formats");
        assert_eq!(show.clip, 1, "a hundred times three clips");
        assert_eq!(show.passed, -5000, "a comma goes back before the start");
        show.press(Key::Space, 3);
        assert!(show.paused);
    }

    #[test]
    fn clips_are_found_by_name_and_by_number() {
        let clips = ["Walk", "", "Walk", "0"].map(str::to_owned);
        for (name, number) in [("Walk", 0), ("", 1), ("2", 2), ("0", 3), ("3", 3)] {
            assert_eq!(clip_of(&clips, name).expect("a clip"), number, "{name:?}");
        }
        // Neither an empty name nor one that moves the cursor disturbs the list.
        let clips = ["", "a\u{1b}[31m"].map(str::to_owned);
        for name in ["2", "-1", "walk", "18446744073709551616"] {
            let error = clip_of(&clips, name).expect_err("no clip").to_string();
            assert!(error.contains(r#"the model has these: "", "a\u{1b}[31m""#), "{error}");
        }
        assert!(clip_of(&[], "0").expect_err("no clip").to_string().contains("no clips"));
    }

    #[test]
    fn clips_play_from_the_time_that_was_given_and_go_round() {
        let container = Container::new(made_up::figures::animated(true).build().bytes());
        let Screen { panel, format, .. } = show().screen;
        let stage = Stage::new(&container, panel, format).expect("a stage");
        let duration = stage.model().clip(0).expect("a clip").duration();
        let at = |time, passed| Show { time, passed, ..show() }.step(&stage).motion.expect("a motion");
        assert_eq!(at(30, 40), at(0, 70));
        assert_eq!(at(30, -40), at(duration - 10, 0));
        assert_eq!(at(duration + 30, 0), at(30, 0));
        // Times at the ends of their range neither stop nor panic.
        for passed in [i64::MIN, i64::MAX] {
            at(u32::MAX, passed);
        }
        let turn = |passed| show().at(passed).step(&stage).turn;
        assert_eq!(turn(1500), Angle16::from_degrees(90));
        assert_eq!(turn(-1500), Angle16::from_degrees(-90));
    }
}
