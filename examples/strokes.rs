//! Measures lines: `ci/strokes` builds this as firmware, counts ticks, and prints the table.
//!
//! Draws 48 lines in all directions, none over another, with each stroke, of full length and of half of it: that tells
//! the cost of a line from that of a pixel. Prints `name lines pixels ticks`, with SysTick's ticks over a frame, which
//! two instructions mark for a counting plugin; pixels are those that are not background. Then a wireframe of the
//! torus, its hidden lines removed, in one strip and in 15. On the host it prints these lines without ticks.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod firmware;
mod scenes;

#[cfg(target_os = "none")]
use semihosting::println;

use scenes::wires;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::frame::Renderer;
use zstrip::math::{Angle16, Pixels, Projective, Scalar, Vec3};
use zstrip::mesh::{LineTopology, Lines, Positions, Vertices};
use zstrip::shader::{DepthOnly, Flat, Gouraud};
use zstrip::target::Strip;
use zstrip::target::{WithDepth, WithRecords};
use zstrip::{Dashed, Scene, ScreenPoint, Smooth, Stroke, Thick, Thin};

const WIDTH: usize = 320;
const HEIGHT: usize = 240;
/// Columns and rows of cells of 40 px, with a line in each.
const CELLS: (usize, usize) = (8, 6);
const LINES: usize = CELLS.0 * CELLS.1;

type Target<'a> = Strip<'a, Rgb565, WithDepth, WithRecords>;
type Drawing = fn(&mut Scene<'_, Target<'_>>, &Input<'_>);

/// The lines and matrices that are made before a frame.
struct Input<'e> {
    screen: &'e [[ScreenPoint; 2]; LINES],
    lines: Lines<'e>,
    torus: Projective,
}

/// The ends of the lines, on the screen and in clip space.
struct Ends {
    screen: [[ScreenPoint; 2]; LINES],
    space: [[i16; 3]; 2 * LINES],
    colors: [[u8; 3]; 2 * LINES],
}

impl Ends {
    /// Lines of a length, in px.
    fn new(length: i32) -> Self {
        let mut ends = Self {
            screen: [[ScreenPoint::default(); 2]; LINES],
            space: [[0; 3]; 2 * LINES],
            colors: [[255; 3]; 2 * LINES],
        };
        for k in 0..LINES {
            let angle = Angle16((k * 65_536 / LINES) as u16);
            let center = ((k % CELLS.0 * 40 + 20) as i32 * 256, (k / CELLS.0 * 40 + 20) as i32 * 256);
            let half = ((angle.cos().to_bits() * length) >> 9, (angle.sin().to_bits() * length) >> 9);
            for (end, sign) in [(0, -1), (1, 1)] {
                let (x, y) = (center.0 + sign * half.0 + 37, center.1 + sign * half.1 + 91);
                ends.screen[k][end] = ScreenPoint::new(Pixels::from_bits(x), Pixels::from_bits(y));
                // 256 · 160 units are half the width.
                let z = 20_000 + 300 * (k as i32) + 5000 * sign;
                ends.space[2 * k + end] =
                    [((x - 40_960) * 4 / 5) as i16, ((30_720 - y) * 16 / 15) as i16, (z / 2) as i16];
                ends.colors[2 * k + end] = [60 + 3 * k as u8, 255 - 90 * end as u8, 130];
            }
        }
        ends
    }

    fn input(&self) -> Option<Input<'_>> {
        let positions = Positions::Quantized { points: &self.space, scale: Scalar::ONE, offset: Vec3::ZERO };
        let data = Vertices { colors: Some(&self.colors), ..Vertices::new(positions) };
        let camera = scenes::camera(Size::new(WIDTH as u32, HEIGHT as u32), Scalar::ONE, Scalar::from_bits(12 << 16));
        let torus = camera * scenes::torus_model(Angle16(5000));
        Some(Input { screen: &self.screen, lines: Lines::new(data, LineTopology::Pairs, None).ok()?, torus })
    }
}

fn on_canvas<K: Stroke>(scene: &mut Scene<'_, Target<'_>>, input: &Input<'_>, stroke: &K) {
    let mut canvas = scene.canvas();
    for [a, b] in input.screen {
        canvas.line_with(*a, *b, Rgb888::WHITE, stroke);
    }
}

fn flat(scene: &mut Scene<'_, Target<'_>>, input: &Input<'_>) {
    scene.draw_lines(&input.lines, &Projective::IDENTITY, &Flat::unlit(Rgb888::WHITE), &Thin);
}

fn gouraud(scene: &mut Scene<'_, Target<'_>>, input: &Input<'_>) {
    scene.draw_lines(&input.lines, &Projective::IDENTITY, &Gouraud::vertex_colors(), &Thin);
}

fn torus(scene: &mut Scene<'_, Target<'_>>, input: &Input<'_>) {
    scene.draw_with(wires::BEHIND_LINES, &scenes::torus::MESH, &input.torus, &DepthOnly);
    lines_of_torus(scene, input);
}

fn lines_of_torus(scene: &mut Scene<'_, Target<'_>>, input: &Input<'_>) {
    scene.draw_lines(scenes::torus::lines(), &input.torus, &Flat::unlit(Rgb888::WHITE), &Thin);
}

/// Name, drawing, rows of a strip, lines.
const RUNS: [(&str, Drawing, usize, usize); 13] = [
    ("empty", |_, _| {}, 240, 0),
    ("thin", |scene, input| on_canvas(scene, input, &Thin), 240, LINES),
    ("thin_depth", flat, 240, LINES),
    ("thin_gouraud", gouraud, 240, LINES),
    ("dashed", |scene, input| on_canvas(scene, input, &Dashed(!0)), 240, LINES),
    ("thick_3px", |scene, input| on_canvas(scene, input, &Thick::px(3)), 240, LINES),
    ("smooth_1px", |scene, input| on_canvas(scene, input, &Smooth::px(1)), 240, LINES),
    ("smooth_3px", |scene, input| on_canvas(scene, input, &Smooth::px(3)), 240, LINES),
    ("torus_lines", lines_of_torus, 240, 1024),
    ("torus", torus, 240, 1024),
    ("empty_16", |_, _| {}, 16, 0),
    ("torus_lines_16", lines_of_torus, 16, 1024),
    ("torus_16", torus, 16, 1024),
];

struct Memory {
    color: [u16; WIDTH * HEIGHT],
    depth: [u16; WIDTH * HEIGHT],
    records: [u32; 16 * 1024],
}

static mut MEMORY: Memory = Memory { color: [0; _], depth: [0; _], records: [0; _] };

fn run() {
    let memory = &raw mut MEMORY;
    // SAFETY: `run` is called once; this is the only reference.
    let memory = unsafe { &mut *memory };
    for (name, drawing, rows, lines) in RUNS {
        for (half, length) in [("", 36), ("/2", 18)] {
            if lines != LINES && !half.is_empty() {
                continue;
            }
            let ends = Ends::new(length);
            let Some(input) = ends.input() else { return };
            let mut pixels = 0;
            frame(memory, drawing, rows, &input, |strip| pixels += strip.iter().filter(|pixel| **pixel != 0).count());
            let ticks = ticks(|| frame(memory, drawing, rows, &input, |_| {}));
            println!("{name}{half} {lines} {pixels} {ticks}");
        }
    }
}

#[inline(never)]
fn frame(memory: &mut Memory, drawing: Drawing, rows: usize, input: &Input<'_>, mut sink: impl FnMut(&[u16])) {
    let (color, depth) = (&mut memory.color[..WIDTH * rows], &mut memory.depth[..WIDTH * rows]);
    let screen = Size::new(WIDTH as u32, HEIGHT as u32);
    let Ok(renderer) = Renderer::<Rgb565>::new(screen).and_then(|renderer| renderer.with_depth(depth)) else { return };
    let mut renderer = renderer.with_records(&mut memory.records);
    let mut frame = renderer.begin(Rgb565::BLACK);
    while let Ok(Some(strip)) = frame.next_strip(color, |scene| drawing(scene, input)) {
        sink(strip.pixels());
    }
}

/// SysTick's ticks, of 24 bits, while something runs between the plugin's marks.
#[cfg(target_os = "none")]
fn ticks(run: impl FnOnce()) -> u32 {
    use core::arch::asm;
    use cortex_m::peripheral::{SYST, syst::SystClkSource};
    // SAFETY: nothing else uses the timer.
    let mut timer = unsafe { cortex_m::Peripherals::steal() }.SYST;
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(0x00FF_FFFF);
    timer.clear_current();
    timer.enable_counter();
    let start = SYST::get_current();
    // SAFETY: copies a register to itself.
    unsafe { asm!("mov r10, r10") };
    run();
    // SAFETY: as above.
    unsafe { asm!("mov r11, r11") };
    start.wrapping_sub(SYST::get_current()) & 0x00FF_FFFF
}

#[cfg(not(target_os = "none"))]
fn ticks(run: impl FnOnce()) -> &'static str {
    run();
    "-"
}

#[cfg(not(target_os = "none"))]
fn main() {
    run();
}
