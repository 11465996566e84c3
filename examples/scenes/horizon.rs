//! An artificial horizon: an instrument drawn on the screen's plane.

use super::{Draw, Rgb888};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::math::{Angle16, Pixels, Scalar};
use zstrip::{Canvas, Framebuffer, Scene, ScreenPoint, Smooth};

const SKY: [Rgb888; 2] = [Rgb888::new(24, 72, 160), Rgb888::new(120, 184, 240)];
const GROUND: [Rgb888; 2] = [Rgb888::new(168, 112, 56), Rgb888::new(64, 40, 24)];
const WHITE: Rgb888 = Rgb888::new(248, 252, 248);
const YELLOW: Rgb888 = Rgb888::new(255, 208, 32);
const PANEL: Rgb888 = Rgb888::new(36, 40, 44);
const RIM: Rgb888 = Rgb888::new(100, 108, 116);

/// The plane of the instrument, about its middle.
#[derive(Clone, Copy)]
struct Dial {
    /// Middle and radius, 24.8 px.
    center: (i32, i32),
    radius: i32,
    /// How far everything is moved down before the turn, in 1/4096 of the radius.
    down: i32,
    /// Sine and cosine of the angle it is turned by, with the clock, 16.16.
    turn: (i32, i32),
}

impl Dial {
    fn turned(self, angle: Angle16) -> Self {
        Self { turn: (angle.sin().to_bits(), angle.cos().to_bits()), ..self }
    }

    /// A point x to the right and y down, in 1/256 of the radius.
    fn at(&self, x: i32, y: i32) -> ScreenPoint {
        let (sin, cos) = (i64::from(self.turn.0), i64::from(self.turn.1));
        let (x, y) = (i64::from(16 * x), i64::from(16 * y + self.down));
        let place = |v: i64| ((v * i64::from(self.radius) + (1 << 27)) >> 28) as i32;
        ScreenPoint::new(
            Pixels::from_bits(self.center.0 + place(x * cos - y * sin)),
            Pixels::from_bits(self.center.1 + place(x * sin + y * cos)),
        )
    }
}

/// The instrument in the middle of the screen.
pub struct Horizon {
    dial: Dial,
    /// Sky and ground: moved by the pitch, then turned by the roll.
    world: Dial,
    roll: Angle16,
}

impl Horizon {
    pub fn new(Size { width, height }: Size, pitch: Angle16, roll: Angle16) -> Self {
        let dial = Dial {
            center: (width as i32 * 128, height as i32 * 128),
            radius: width.min(height) as i32 * 116,
            down: 0,
            turn: (0, 1 << 16),
        };
        // The radius is 40 degrees: 9 radii make a turn.
        let world = Dial { down: (i32::from(pitch.0 as i16) * 9) >> 4, ..dial }.turned(-roll);
        Self { dial, world, roll }
    }
}

impl<F: Framebuffer> Draw<F> for Horizon {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        let mut canvas = scene.canvas();
        backdrop(&mut canvas, &self.world);
        ladder(&mut canvas, &self.world);
        bezel(&mut canvas, &self.dial);
        scale(&mut canvas, &self.dial, self.roll);
        pointers(&mut canvas, &self.dial, self.roll);
        wings(&mut canvas, &self.dial);
    }
}

/// The angles of roll.
#[inline(never)]
fn scale<F: Framebuffer>(canvas: &mut Canvas<'_, '_, F>, dial: &Dial, roll: Angle16) {
    for tens in [-60, -45, -30, -20, -10, 10, 20, 30, 45, 60] {
        let mark = dial.turned(Angle16::from_degrees(tens) - roll);
        let length = if tens % 30 == 0 { 30 } else { 16 };
        canvas.line_with(mark.at(0, -214), mark.at(0, -214 - length), WHITE, &Smooth::new(Pixels::from_bits(500)));
    }
}

/// Where roll is zero, and what points to the scale.
#[inline(never)]
fn pointers<F: Framebuffer>(canvas: &mut Canvas<'_, '_, F>, dial: &Dial, roll: Angle16) {
    let zero = dial.turned(-roll);
    canvas.polygon(&[zero.at(0, -214), zero.at(-14, -240), zero.at(14, -240)], WHITE);
    canvas.polygon(&[dial.at(0, -210), dial.at(13, -184), dial.at(-13, -184)], YELLOW);
}

/// The aircraft.
#[inline(never)]
fn wings<F: Framebuffer>(canvas: &mut Canvas<'_, '_, F>, dial: &Dial) {
    for side in [-1, 1] {
        let wing = [dial.at(side * 110, 0), dial.at(side * 44, 0), dial.at(side * 44, 20)];
        canvas.polyline(&wing, Rgb888::new(16, 16, 16), &Smooth::new(Pixels::from_bits(1500)));
        canvas.polyline(&wing, YELLOW, &Smooth::new(Pixels::from_bits(900)));
    }
    canvas.point(dial.at(0, 0), Pixels::from_bits(1400), Rgb888::new(16, 16, 16));
    canvas.point(dial.at(0, 0), Pixels::from_bits(900), YELLOW);
}

/// Sky and ground, each from the horizon to far away.
#[inline(never)]
fn backdrop<F: Framebuffer>(canvas: &mut Canvas<'_, '_, F>, world: &Dial) {
    for (side, [far, near]) in [(-1, SKY), (1, [GROUND[1], GROUND[0]])] {
        let (away, end) = (side * 300, side * 2000);
        canvas.gradient(&[
            (world.at(-900, 0), near),
            (world.at(900, 0), near),
            (world.at(900, away), far),
            (world.at(-900, away), far),
        ]);
        canvas.polygon(&[world.at(-900, away), world.at(900, away), world.at(900, end), world.at(-900, end)], far);
    }
    canvas.line_with(world.at(-400, 0), world.at(400, 0), WHITE, &Smooth::new(Pixels::from_bits(450)));
}

/// A line every 5 degrees of pitch.
#[inline(never)]
fn ladder<F: Framebuffer>(canvas: &mut Canvas<'_, '_, F>, world: &Dial) {
    for fives in (-18..=18_i32).filter(|fives| *fives != 0) {
        let y = -32 * fives;
        if (y + world.down / 16).abs() > 176 {
            continue;
        }
        let half = if fives % 2 == 0 { 64 } else { 28 };
        canvas.line_with(world.at(-half, y), world.at(half, y), WHITE, &Smooth::new(Pixels::from_bits(400)));
        if fives % 2 == 0 {
            // The ends point to the horizon.
            let hook = if fives > 0 { 12 } else { -12 };
            for side in [-half, half] {
                canvas.line_with(
                    world.at(side, y),
                    world.at(side, y + hook),
                    WHITE,
                    &Smooth::new(Pixels::from_bits(400)),
                );
            }
        }
    }
}

/// The panel around the dial, and its rim.
#[inline(never)]
fn bezel<F: Framebuffer>(canvas: &mut Canvas<'_, '_, F>, dial: &Dial) {
    const SIDES: u16 = 48;
    let step = |k: u16| {
        let angle = Angle16((u32::from(k % SIDES) * 65_536 / u32::from(SIDES)) as u16);
        let on = |c: Scalar, radius: i32| (c.to_bits() * radius + (1 << 15)) >> 16;
        move |radius: i32| (on(angle.cos(), radius), on(angle.sin(), radius))
    };
    let at = |p: (i32, i32)| dial.at(p.0, p.1);
    for k in 0..SIDES {
        let (a, b) = (step(k), step(k + 1));
        canvas.polygon(&[at(a(256)), at(b(256)), at(b(900)), at(a(900))], PANEL);
        canvas.line_with(at(a(256)), at(b(256)), RIM, &Smooth::new(Pixels::from_bits(900)));
    }
}
