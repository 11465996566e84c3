//! An instrument cluster of smooth shapes: dials with rings, ticks and turned numbers, needles at any angle, a plot and
//! dashes. No depth is needed.

use super::Draw;
use core::cell::RefCell;
use embedded_graphics::mono_font::{MonoTextStyle, ascii};
use embedded_graphics::prelude::*;
use embedded_graphics::text::{Alignment, Baseline, Text, TextStyleBuilder};
use zstrip::embedded_graphics_core::pixelcolor::{BinaryColor, Rgb888};
use zstrip::math::{Angle16, Pixels, Scalar};
use zstrip::scene::ShapeBuffer;
use zstrip::shader::{Alpha, Blend, Flat, Opacity};
use zstrip::shape::{
    Cap, Circle, CurvePath, Ellipse, Join, LinearGradient, Path, PathStep, Polyline, RadialGradient, Ramp, Ring,
    RoundedRectangle, Sprite, Stencil, Tinted,
};
use zstrip::texture::Bilinear;
use zstrip::{Canvas, Framebuffer, Scene, ScreenPoint};

const BACK: [Rgb888; 2] = [Rgb888::new(34, 40, 50), Rgb888::new(10, 12, 16)];
const FACE: [Rgb888; 2] = [Rgb888::new(30, 36, 46), Rgb888::new(8, 10, 14)];
const RIM: [Rgb888; 3] = [Rgb888::new(190, 200, 210), Rgb888::new(60, 66, 74), Rgb888::new(130, 138, 148)];
const TEXT: Rgb888 = Rgb888::new(220, 228, 236);
const DIM: Rgb888 = Rgb888::new(96, 106, 120);
const GREEN: Rgb888 = Rgb888::new(64, 208, 112);
const AMBER: Rgb888 = Rgb888::new(248, 176, 48);
const RED: Rgb888 = Rgb888::new(240, 64, 56);
const BLUE: Rgb888 = Rgb888::new(64, 168, 248);

/// Size of a number in the stencil that it is drawn from.
const LABEL: Size = Size::new(18, 10);
const LABEL_BYTES: usize = 18 * 10;
/// Numbers of a dial.
const LABELS: usize = 9;
/// Words for shapes: 40 edges.
const WORDS: usize = ShapeBuffer::words(320, 40);

/// The instruments on a screen of 320×240.
pub struct Gauges {
    turn: Angle16,
    labels: [[u8; LABEL_BYTES]; 2 * LABELS],
    titles: [[u8; 8 * LABEL_BYTES / 3]; 2],
    back: Ramp<32>,
    face: Ramp<32>,
    rim: Ramp<32>,
    /// Memory of the shapes; each strip's drawing takes it in turn.
    words: RefCell<[u32; WORDS]>,
}

/// `size` sin(k turn), in 1/256.
fn wave(turn: Angle16, k: u16, size: i32) -> i32 {
    (Angle16(turn.0.wrapping_mul(k)).sin().to_bits() * size) >> 8
}

/// Pixels from 256ths of them.
fn px(bits: i32) -> Pixels {
    Pixels::from_bits(bits)
}

/// Returns the point at a radius, in 256ths of a pixel, in a direction, clockwise from the right.
fn around(center: ScreenPoint, angle: Angle16, radius: i32) -> ScreenPoint {
    let at = |v: Scalar| px(((i64::from(v.to_bits()) * i64::from(radius)) >> 16) as i32);
    ScreenPoint::new(center.x() + at(angle.cos()), center.y() + at(angle.sin()))
}

/// Draws text in the middle of a stencil.
fn write(bytes: &mut [u8], size: Size, text: &str) {
    let style = TextStyleBuilder::new().alignment(Alignment::Center).baseline(Baseline::Top).build();
    if let Ok(mut stencil) = Stencil::new(bytes, size) {
        let font = MonoTextStyle::new(&ascii::FONT_6X10, BinaryColor::On);
        let Ok(_) = Text::with_text_style(text, Point::new(size.width as i32 / 2, 0), font, style).draw(&mut stencil);
    }
}

/// A point of an icon, 256 units high.
const fn icon(x: i32, y: i32) -> ScreenPoint {
    ScreenPoint::new(Pixels::from_bits(x << 8), Pixels::from_bits(y << 8))
}

/// A leaf with its stem, and a drop, in curves around their middle.
static LEAF: [PathStep; 6] = [
    PathStep::Move(icon(0, -128)),
    PathStep::Cubic(icon(90, -80), icon(110, 30), icon(10, 74)),
    PathStep::Line(icon(10, 128)),
    PathStep::Line(icon(-10, 128)),
    PathStep::Line(icon(-10, 74)),
    PathStep::Cubic(icon(-110, 30), icon(-90, -80), icon(0, -128)),
];
static DROP: [PathStep; 5] = [
    PathStep::Move(icon(0, -128)),
    PathStep::Quad(icon(20, -70), icon(56, -20)),
    PathStep::Cubic(icon(120, 70), icon(60, 128), icon(0, 128)),
    PathStep::Cubic(icon(-60, 128), icon(-120, 70), icon(-56, -20)),
    PathStep::Quad(icon(-20, -70), icon(0, -128)),
];

/// Size of the stencil of a title.
const TITLE: Size = Size::new(48, 10);

impl Gauges {
    /// Makes the instruments at a time; they go round once per turn.
    pub fn new(turn: Angle16) -> Self {
        let mut labels = [[0; LABEL_BYTES]; 2 * LABELS];
        let texts =
            ["0", "20", "40", "60", "80", "100", "120", "140", "160", "0", "1", "2", "3", "4", "5", "6", "7", "8"];
        for (label, text) in labels.iter_mut().zip(texts) {
            write(label, LABEL, text);
        }
        let mut titles = [[0; 480]; 2];
        for (title, text) in titles.iter_mut().zip(["km/h", "rpm 1000"]) {
            write(title, TITLE, text);
        }
        Self {
            turn,
            labels,
            titles,
            back: Ramp::new(&[(0, BACK[0]), (255, BACK[1])]),
            face: Ramp::new(&[(0, FACE[0]), (200, FACE[0]), (255, FACE[1])]),
            rim: Ramp::new(&[(0, RIM[0]), (150, RIM[1]), (255, RIM[2])]),
            words: RefCell::new([0; WORDS]),
        }
    }
}

/// A canvas and the memory of its shapes.
struct Panel<'c, 'a, 'b, 'm, F> {
    canvas: Canvas<'c, 'a, F>,
    buffer: &'b mut ShapeBuffer<'m>,
}

impl<F: Framebuffer> Draw<F> for Gauges {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        let Ok(mut words) = self.words.try_borrow_mut() else { return };
        let Ok(mut buffer) = ShapeBuffer::new(&mut *words, 320) else { return };
        let mut panel = Panel { canvas: scene.canvas(), buffer: &mut buffer };
        let all = RoundedRectangle::new(ScreenPoint::corner(0, 0), ScreenPoint::corner(320, 240));
        let back = LinearGradient::new(&self.back, ScreenPoint::corner(0, 0), ScreenPoint::corner(60, 240));
        panel.canvas.fill_with(&all, &back, 0, panel.buffer);
        // From 0 to 256 · 256.
        let share = |k: u16, phase: u16| 32_768 + wave(self.turn + Angle16(phase), k, 110) + wave(self.turn, 7 * k, 4);
        self.dial(&mut panel, ScreenPoint::corner(79, 90), 0, share(1, 50_000), GREEN);
        self.dial(&mut panel, ScreenPoint::corner(241, 90), 1, share(2, 40_000), BLUE);
        self.plot(&mut panel);
        for (k, color) in [GREEN, AMBER, BLUE].into_iter().enumerate() {
            let center = ScreenPoint::corner(208 + 42 * k as i16, 208);
            Self::small(&mut panel, center, share(1 + k as u16, 20_000 * k as u16), color);
        }
    }
}

/// Angle at which dials begin, and their sweep: 270 degrees, open below.
const START: Angle16 = Angle16::from_degrees(135);
const SWEEP: i32 = Ring::degrees(270);

impl Gauges {
    /// A large dial, with a needle at a share of 65,536.
    #[inline(never)]
    fn dial<F: Framebuffer>(
        &self,
        panel: &mut Panel<'_, '_, '_, '_, F>,
        center: ScreenPoint,
        number: usize,
        share: i32,
        color: Rgb888,
    ) {
        let Panel { canvas, buffer } = panel;
        // Bezel and face.
        let rim = LinearGradient::new(
            &self.rim,
            around(center, Angle16::from_degrees(230), 80 * 256),
            around(center, Angle16::from_degrees(50), 80 * 256),
        );
        canvas.fill_with(&Ring::new(center, px(76 * 256 + 128), px(71 * 256)), &rim, 0, buffer);
        let face = RadialGradient::new(&self.face, center, px(72 * 256));
        canvas.fill_with(&Circle::new(center, px(71 * 256 + 64)), &face, 0, buffer);
        // The way that the needle has come, as a band with round ends, and the last part in red.
        let band = Ring::new(center, px(67 * 256), px(63 * 256));
        canvas.fill(&band.part(START, SWEEP), Rgb888::new(40, 48, 58), buffer);
        canvas.fill(&band.part(START + Angle16((SWEEP * 7 / 8) as u16), SWEEP / 8), RED, buffer);
        let way = ((SWEEP >> 4) * (share >> 4)) >> 8;
        canvas.fill(&band.part(START, way).with_round_ends(), color, buffer);
        Self::icon(panel, around(center, Angle16::from_degrees(90), 58 * 256), number, color);
        self.scale(panel, center, number);
        self.needle(panel, center, START + Angle16(way as u16));
    }

    /// Ticks, and numbers that stand along the scale.
    #[inline(never)]
    fn scale<F: Framebuffer>(
        &self,
        Panel { canvas, buffer }: &mut Panel<'_, '_, '_, '_, F>,
        center: ScreenPoint,
        number: usize,
    ) {
        for tick in 0..=40 {
            let angle = START + Angle16((SWEEP * tick / 40) as u16);
            let (inner, width, color) = if tick % 5 == 0 { (54, 640, TEXT) } else { (57, 300, DIM) };
            let ends = [around(center, angle, inner * 256), around(center, angle, 61 * 256)];
            canvas.fill(&Polyline::new(&ends, px(width)), color, buffer);
        }
        let labels = self.labels.iter().skip(LABELS * number).take(LABELS);
        for (k, label) in labels.enumerate() {
            let angle = START + Angle16((SWEEP * k as i32 / 8) as u16);
            let Ok(text) = Tinted::new(label, LABEL, TEXT) else { continue };
            let sprite = Sprite::new(&text).filter(Bilinear).at(around(center, angle, 45 * 256));
            let sprite = sprite.turned(angle + Angle16::from_degrees(90));
            canvas.fill_with(&sprite, &Blend::new(sprite, Alpha), 0, buffer);
        }
        let Some(Ok(title)) = self.titles.get(number).map(|title| Tinted::new(title, TITLE, DIM)) else { return };
        let sprite = Sprite::new(&title).filter(Bilinear).at(around(center, Angle16::from_degrees(90), 38 * 256));
        canvas.fill_with(&sprite, &Blend::new(sprite, Alpha), 0, buffer);
    }

    /// A turned leaf, or a drop with a highlight.
    #[inline(never)]
    fn icon<F: Framebuffer>(
        Panel { canvas, buffer }: &mut Panel<'_, '_, '_, '_, F>,
        at: ScreenPoint,
        number: usize,
        color: Rgb888,
    ) {
        let scale = Scalar::from_bits(16 << 8);
        if number == 0 {
            let leaf = CurvePath::new(&LEAF).at(at).scaled(scale).turned(Angle16::from_degrees(40));
            return canvas.fill(&leaf, color, buffer);
        }
        canvas.fill(&CurvePath::new(&DROP).at(at).scaled(scale), color, buffer);
        let middle = ScreenPoint::new(at.x() - px(500), at.y() + px(800));
        let highlight = Ellipse::new(middle, px(200), px(560)).turned(Angle16::from_degrees(-20));
        canvas.fill(&highlight, TEXT, buffer);
    }

    /// A needle with its shadow, and its hub.
    #[inline(never)]
    fn needle<F: Framebuffer>(
        &self,
        Panel { canvas, buffer }: &mut Panel<'_, '_, '_, '_, F>,
        center: ScreenPoint,
        angle: Angle16,
    ) {
        let needle = |center: ScreenPoint| {
            let side = Angle16::from_degrees(90);
            [
                around(around(center, angle, 58 * 256), angle + side, 100),
                around(around(center, angle, 58 * 256), angle - side, 100),
                around(around(center, angle, -14 * 256), angle - side, 800),
                around(around(center, angle, -14 * 256), angle + side, 800),
            ]
        };
        let below = ScreenPoint::new(center.x() + px(600), center.y() + px(900));
        let shadow = Blend::new(Flat::unlit(Rgb888::new(0, 0, 0)), Opacity(110));
        canvas.fill_with(&Path::new(&[&needle(below)]), &shadow, 0, buffer);
        canvas.fill(&Path::new(&[&needle(center)]), RED, buffer);
        let rim = LinearGradient::new(
            &self.rim,
            around(center, Angle16::from_degrees(230), 9 * 256),
            around(center, Angle16::from_degrees(50), 9 * 256),
        );
        canvas.fill_with(&Circle::new(center, px(9 * 256)), &rim, 0, buffer);
        canvas.fill(&Circle::new(center, px(7 * 256)), FACE[0], buffer);
    }

    /// A plot with round joins over a dashed level.
    #[inline(never)]
    fn plot<F: Framebuffer>(&self, Panel { canvas, buffer }: &mut Panel<'_, '_, '_, '_, F>) {
        let frame = RoundedRectangle::new(ScreenPoint::corner(8, 180), ScreenPoint::corner(178, 234));
        canvas.fill(&frame.with_radius(px(9 * 256)), DIM, buffer);
        let inside = RoundedRectangle::new(
            ScreenPoint::new(px(9 * 256 + 64), px(181 * 256 + 64)),
            ScreenPoint::new(px(177 * 256 - 64), px(233 * 256 - 64)),
        );
        canvas.fill(&inside.with_radius(px(8 * 256)), Rgb888::new(16, 20, 26), buffer);
        let level = [ScreenPoint::new(px(14 * 256), px(207 * 256)), ScreenPoint::new(px(172 * 256), px(207 * 256))];
        let pattern = [px(5 * 256), px(4 * 256)];
        let offset = px(i32::from(self.turn.0) >> 3);
        canvas.fill(&Polyline::new(&level, px(320)).with_dashes(&pattern, offset), AMBER, buffer);
        for (k, color) in [(3, BLUE), (2, GREEN)] {
            let mut points = [ScreenPoint::default(); 33];
            for (n, point) in points.iter_mut().enumerate() {
                let past = Angle16(self.turn.0.wrapping_add((n * 1000) as u16));
                let y = wave(past, k, 14) + wave(past, 5 * k, 4);
                *point = ScreenPoint::new(px(14 * 256 + n as i32 * 1264), px(207 * 256) - px(y));
            }
            let line = Polyline::new(&points, px(560)).with_join(Join::Round).with_cap(Cap::Round);
            canvas.fill(&line, color, buffer);
        }
    }

    /// A small dial: a ring of dashes around a pie.
    #[inline(never)]
    fn small<F: Framebuffer>(
        Panel { canvas, buffer }: &mut Panel<'_, '_, '_, '_, F>,
        center: ScreenPoint,
        share: i32,
        color: Rgb888,
    ) {
        for k in 0..20 {
            let lit = (k << 16) / 20 < share;
            let part = Ring::new(center, px(18 * 256), px(14 * 256))
                .part(START + Angle16((SWEEP * k / 20) as u16), SWEEP / 32);
            canvas.fill(&part, if lit { color } else { Rgb888::new(44, 52, 62) }, buffer);
        }
        canvas.fill(&Ring::pie(center, px(10 * 256), START, ((SWEEP >> 4) * (share >> 4)) >> 8), color, buffer);
    }
}
