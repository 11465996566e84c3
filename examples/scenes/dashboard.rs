//! Instruments drawn by embedded-graphics alone: gauges, a plot, bars, text and an image. No depth is needed.
//!
//! Angles come from the crate's integer sine, as embedded-graphics' own arcs compute in floats.

use super::Draw;
use embedded_graphics::image::{Image, ImageRawLE};
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle, ascii};
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::*;
use embedded_graphics::text::{Alignment, Baseline, Text, TextStyle, TextStyleBuilder};
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::math::Angle16;
use zstrip::span::DepthOff;
use zstrip::target::Overlay;
use zstrip::{Framebuffer, Scene};

type On<'c, F> = Overlay<'c, F, DepthOff>;

const BACK: Rgb565 = Rgb565::new(1, 3, 3);
const BAR: Rgb565 = Rgb565::new(3, 9, 8);
const DIM: Rgb565 = Rgb565::new(9, 20, 11);
const TEXT: Rgb565 = Rgb565::new(27, 56, 28);
const GREEN: Rgb565 = Rgb565::new(6, 50, 12);
const AMBER: Rgb565 = Rgb565::new(30, 42, 4);
const RED: Rgb565 = Rgb565::new(30, 14, 8);
const BLUE: Rgb565 = Rgb565::new(8, 40, 30);

/// The instruments on a screen of 320×240.
pub struct Dashboard {
    /// The time that they show.
    turn: Angle16,
    speed: i32,
    power: i32,
}

impl Dashboard {
    pub fn new(turn: Angle16) -> Self {
        let speed = 118 + wave(turn, 1, 60) + wave(turn, 5, 14);
        let power = 47 + wave(turn + Angle16(9000), 2, 38);
        Self { turn, speed, power }
    }
}

impl<F: Framebuffer<Format = Rgb565>> Draw<F> for Dashboard {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        let overlay = &mut scene.overlay();
        let Ok(()) = overlay.clear(BACK);
        header(overlay, self.turn);
        gauge(overlay, Point::new(74, 100), "km/h", self.speed, 200);
        gauge(overlay, Point::new(246, 100), "kW", self.power, 100);
        let weather = ImageRawLE::<Rgb565>::new(const { &picture() }, WEATHER_SIZE as u32);
        overlay.draw(&Image::new(&weather, Point::new(140, 34)));
        label(overlay, Point::new(160, 84), &ascii::FONT_6X10, DIM_TEXT, Alignment::Center, "19 C");
        plot(overlay, Rectangle::new(Point::new(10, 176), Size::new(186, 54)), self.turn);
        for (k, (name, color)) in [("cell", GREEN), ("coil", AMBER), ("oil", BLUE)].into_iter().enumerate() {
            let share = 50 + wave(self.turn + Angle16(k as u16 * 20_000), 1 + k as u16, 45);
            bar(overlay, Point::new(206, 178 + 18 * k as i32), name, share, color);
        }
    }
}

const DIM_TEXT: Rgb565 = Rgb565::new(19, 40, 20);

/// `size` sin(k turn).
fn wave(turn: Angle16, k: u16, size: i32) -> i32 {
    (Angle16(turn.0.wrapping_mul(k)).sin().to_bits() * size) >> 16
}

/// Returns the point at `radius` from `center` in a direction, clockwise from the top; in half pixels, so that needles
/// are round.
fn around(center: Point, angle: Angle16, radius: i32) -> Point {
    let at = |v: i32| (v * radius + (1 << 15)) >> 16;
    center + Point::new(at(angle.sin().to_bits()), -at(angle.cos().to_bits()))
}

fn label<F: Framebuffer<Format = Rgb565>>(
    overlay: &mut On<'_, F>,
    at: Point,
    font: &MonoFont<'_>,
    color: Rgb565,
    alignment: Alignment,
    text: &str,
) {
    let style: TextStyle = TextStyleBuilder::new().alignment(alignment).baseline(Baseline::Middle).build();
    overlay.draw(&Text::with_text_style(text, at, MonoTextStyle::new(font, color), style));
}

/// Decimal digits of a number below 1000, right-aligned.
fn digits(number: i32, text: &mut [u8; 3]) -> &str {
    let mut rest = number.clamp(0, 999) as u32;
    let mut first = 2;
    for (k, digit) in text.iter_mut().enumerate().rev() {
        *digit = b'0' + (rest % 10) as u8;
        rest /= 10;
        if *digit != b'0' {
            first = first.min(k);
        }
    }
    text.get(first..).and_then(|digits| core::str::from_utf8(digits).ok()).unwrap_or("")
}

fn header<F: Framebuffer<Format = Rgb565>>(overlay: &mut On<'_, F>, turn: Angle16) {
    let Ok(()) = overlay.fill_solid(&Rectangle::new(Point::zero(), Size::new(320, 22)), BAR);
    label(overlay, Point::new(8, 11), &ascii::FONT_7X13_BOLD, TEXT, Alignment::Left, "zstrip dashboard");
    let minutes = (i32::from(turn.0) * 90) >> 16;
    let (mut hours, mut text) = ([0; 3], [0; 3]);
    let hours = digits(10 + minutes / 60, &mut hours);
    label(overlay, Point::new(288, 11), &ascii::FONT_7X13, TEXT, Alignment::Right, hours);
    label(overlay, Point::new(292, 10), &ascii::FONT_7X13, TEXT, Alignment::Center, ":");
    let text = digits(100 + minutes % 60, &mut text).get(1..).unwrap_or("");
    label(overlay, Point::new(310, 11), &ascii::FONT_7X13, TEXT, Alignment::Right, text);
}

/// A round instrument: 270 degrees from its lower left to its lower right.
fn gauge<F: Framebuffer<Format = Rgb565>>(overlay: &mut On<'_, F>, center: Point, unit: &str, value: i32, full: u16) {
    const RADIUS: i32 = 64;
    let style = PrimitiveStyleBuilder::new().fill_color(BAR).stroke_color(DIM).stroke_width(3).build();
    overlay.draw(&Circle::with_center(center, 2 * RADIUS as u32 + 1).into_styled(style));
    let angle = |tenths: i32| Angle16::from_degrees(-135 + 27 * tenths);
    for tenth in 0..=10 {
        let color = [GREEN, AMBER, RED][usize::from(tenth > 6) + usize::from(tenth > 8)];
        let (from, to) = (around(center, angle(tenth), RADIUS - 12), around(center, angle(tenth), RADIUS - 5));
        overlay.draw(&Line::new(from, to).into_styled(PrimitiveStyle::with_stroke(color, 3)));
        if tenth % 2 == 0 {
            let mut text = [0; 3];
            let text = digits(tenth * i32::from(full) / 10, &mut text);
            let at = around(center, angle(tenth), RADIUS - 23);
            label(overlay, at, &ascii::FONT_6X10, DIM_TEXT, Alignment::Center, text);
        }
    }
    let mut text = [0; 3];
    let text = digits(value, &mut text);
    label(overlay, center + Point::new(0, 36), &ascii::FONT_10X20, TEXT, Alignment::Center, text);
    label(overlay, center + Point::new(0, 52), &ascii::FONT_6X10, DIM_TEXT, Alignment::Center, unit);
    // 270 degrees are three quarters of 65,536.
    let share = (value.clamp(0, i32::from(full)) << 16) / i32::from(full.max(1));
    let needle = Angle16::from_degrees(-135) + Angle16((share * 3 / 4) as u16);
    let quarter = Angle16::from_degrees(90);
    let tip = around(center, needle, RADIUS - 14);
    let (left, right) = (around(center, needle + quarter, 4), around(center, needle - quarter, 4));
    overlay.draw(&Triangle::new(tip, left, right).into_styled(PrimitiveStyle::with_fill(RED)));
    overlay.draw(&Circle::with_center(center, 13).into_styled(PrimitiveStyle::with_fill(TEXT)));
    overlay.draw(&Circle::with_center(center, 7).into_styled(PrimitiveStyle::with_fill(BAR)));
}

/// The last minutes of something that swings.
fn plot<F: Framebuffer<Format = Rgb565>>(overlay: &mut On<'_, F>, area: Rectangle, turn: Angle16) {
    let frame = PrimitiveStyleBuilder::new().fill_color(BAR).stroke_color(DIM).stroke_width(1).build();
    overlay.draw(&area.into_styled(frame));
    let Point { x: left, y: top } = area.top_left;
    let (width, height) = (area.size.width as i32, area.size.height as i32);
    for k in 1..4 {
        let y = top + height * k / 4;
        let line = Line::new(Point::new(left + 1, y), Point::new(left + width - 2, y));
        overlay.draw(&line.into_styled(PrimitiveStyle::with_stroke(DIM, 1)));
    }
    for (color, k, size) in [(BLUE, 3, 12), (AMBER, 2, 20)] {
        let mut points = [Point::zero(); 45];
        for (n, point) in points.iter_mut().enumerate() {
            let n = n as i32;
            let past = Angle16(turn.0.wrapping_add((n * 800) as u16));
            let y = wave(past, k, size) + wave(past, 7 * k, size / 5);
            *point = Point::new(left + 4 + 4 * n, top + height / 2 - y);
        }
        overlay.draw(&Polyline::new(&points).into_styled(PrimitiveStyle::with_stroke(color, 2)));
    }
}

/// A bar of per cents with its name.
fn bar<F: Framebuffer<Format = Rgb565>>(overlay: &mut On<'_, F>, at: Point, name: &str, share: i32, color: Rgb565) {
    label(overlay, at + Point::new(0, 6), &ascii::FONT_6X10, DIM_TEXT, Alignment::Left, name);
    let corners = CornerRadii::new(Size::new_equal(4));
    let bar = |width: i32, color| {
        let area = Rectangle::new(at + Point::new(30, 1), Size::new(width as u32, 11));
        RoundedRectangle::new(area, corners).into_styled(PrimitiveStyle::with_fill(color))
    };
    overlay.draw(&bar(74, BAR));
    overlay.draw(&bar(8 + share.clamp(0, 100) * 66 / 100, color));
}

const WEATHER_SIZE: usize = 40;

/// The sun behind a cloud, computed by the compiler: each pixel from 16 samples.
const fn picture() -> [u8; WEATHER_SIZE * WEATHER_SIZE * 2] {
    let mut bytes = [0; WEATHER_SIZE * WEATHER_SIZE * 2];
    let mut k = 0;
    while k < WEATHER_SIZE * WEATHER_SIZE {
        let (x, y) = ((k % WEATHER_SIZE * 8) as i32, (k / WEATHER_SIZE * 8) as i32);
        let mut sum = [0; 3];
        let mut sample = 0;
        while sample < 16 {
            let [r, g, b] = weather(x + 1 + sample % 4 * 2, y + 1 + sample / 4 * 2);
            sum = [sum[0] + r, sum[1] + g, sum[2] + b];
            sample += 1;
        }
        let pixel = (sum[0] / 128 * 2048 + sum[1] / 64 * 32 + sum[2] / 128) as u16;
        [bytes[2 * k], bytes[2 * k + 1]] = pixel.to_le_bytes();
        k += 1;
    }
    bytes
}

/// Returns the colour at a place of the weather, in eighths of a pixel.
const fn weather(x: i32, y: i32) -> [i32; 3] {
    const fn within(x: i32, y: i32, center: (i32, i32), radius: i32) -> bool {
        let (dx, dy) = (x - center.0, y - center.1);
        dx * dx + dy * dy < radius * radius
    }
    let cloud = within(x, y, (100, 222), 56) || within(x, y, (165, 192), 72) || within(x, y, (235, 222), 56);
    if (cloud && y < 262) || (x > 100 && x < 235 && y >= 222 && y < 262) {
        // Darker towards its flat bottom.
        let light = 245 - (y - 120) / 3;
        return [light - 14, light - 6, light];
    }
    let sun = (200, 120);
    if within(x, y, sun, 62) {
        return [255, 205, 60];
    }
    // Eight rays: near the axes and the diagonals.
    let (dx, dy) = (x - sun.0, y - sun.1);
    let near = 9;
    let on_ray = dx.abs() < near || dy.abs() < near || (dx - dy).abs() < 13 || (dx + dy).abs() < 13;
    if on_ray && within(x, y, sun, 104) && !within(x, y, sun, 78) {
        return [255, 190, 50];
    }
    // The background of the screen.
    [8, 12, 24]
}
