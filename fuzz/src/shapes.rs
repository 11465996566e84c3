//! Shapes with smooth edges, gradients and sprites: anywhere, of any size, with little memory. They are the same in any
//! strips.

use crate::Hash;
use crate::scenes::{assert_alike, strip_rows};
use crate::source::Source;
use core::convert::Infallible;
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::embedded_graphics_core::primitives::Rectangle;
use zstrip::frame::Renderer;
use zstrip::math::{Angle16, Pixels, Scalar};
use zstrip::scene::ShapeBuffer;
use zstrip::shader::{Alpha, Blend, Flat, Opacity};
use zstrip::shape::{
    Cap, Circle, CurvePath, Ellipse, FillRule, Join, LinearGradient, Path, PathStep, Polyline, RadialGradient, Ramp,
    Ring, RoundedRectangle, Sprite,
};
use zstrip::span::DepthState;
use zstrip::target::StripPixels;
use zstrip::texture::{Bilinear, Tile};
use zstrip::{Canvas, Framebuffer, ScreenPoint};

static TILE: Tile<'static, 4, 4> =
    Tile::new(&[[0xF800, 0x07E0, 0x001F, 0xFFFF], [1, 2, 3, 4], [500, 600, 700, 800], [0x8410, 0, 0x8410, 0]]);

/// A shape of one kind, with all that any kind takes.
#[derive(Debug)]
struct Thing {
    kind: u8,
    points: Vec<ScreenPoint>,
    sizes: [Pixels; 3],
    angle: Angle16,
    sweep: i32,
    pattern: Vec<Pixels>,
    flags: u8,
    color: Rgb888,
    z: u16,
}

impl Thing {
    fn new(source: &mut Source<'_>) -> Self {
        let kind = source.u8();
        let mut last = [0; 2];
        let points = 1 + source.below(8);
        let points = (0..points).map(|_| {
            // One of four shapes may lie anywhere, the others near the screen.
            last = last.map(|c| source.coordinate(c));
            let [x, y] = if kind & 0xC0 == 0 { last } else { last.map(|c| c % 12_000) };
            ScreenPoint::new(Pixels::from_bits(x), Pixels::from_bits(y))
        });
        let points = points.collect();
        let mut size = || {
            let size = source.coordinate(0);
            Pixels::from_bits(if kind & 0x30 == 0 { size } else { size % 6000 })
        };
        let sizes = [size(), size(), size()];
        let pattern = source.below(4);
        Self {
            kind,
            points,
            sizes,
            angle: Angle16(source.u16()),
            sweep: source.u32() as i32 >> source.below(16),
            // Dashes take their time where they are very short.
            pattern: (0..pattern).map(|_| Pixels::from_bits(i32::from(source.u16()) + 512)).collect(),
            flags: source.u8(),
            color: Rgb888::new(source.u8(), source.u8(), source.u8()),
            z: source.u16(),
        }
    }

    fn draw<F: Framebuffer>(&self, canvas: &mut Canvas<'_, '_, F>, ramp: &Ramp<8>, buffer: &mut ShapeBuffer<'_>) {
        let (Self { sizes: [a, b, c], color, flags, .. }, at) = (self, self.points[0]);
        let to = *self.points.last().unwrap_or(&at);
        canvas.set_depth(self.z, if flags & 1 == 0 { DepthState::OFF } else { DepthState::LESS });
        match self.kind & 15 {
            0 => canvas.fill(&Circle::new(at, *a), *color, buffer),
            1 => {
                let angle = if flags & 2 == 0 { self.angle } else { Angle16::ZERO };
                canvas.fill(&Ellipse::new(at, *a, *b).turned(angle), *color, buffer);
            }
            2 => canvas.fill(&Ring::new(at, *a, *b), *color, buffer),
            3 => canvas.fill(&Ring::new(at, *a, *b).part(self.angle, self.sweep), *color, buffer),
            4 => canvas.fill(&Ring::new(at, *a, *b).part(self.angle, self.sweep).with_round_ends(), *color, buffer),
            5 => canvas.fill(&RoundedRectangle::new(at, to).with_radii(*a, *b), *color, buffer),
            6 => canvas.fill_with(&Circle::new(at, *a), &LinearGradient::new(ramp, at, to), 0, buffer),
            7 => canvas.fill_with(&Circle::new(at, *a), &RadialGradient::new(ramp, to, *b), 0, buffer),
            8 => canvas.fill_with(&Circle::new(at, *a), &Blend::new(Flat::unlit(*color), Opacity(*flags)), 0, buffer),
            9 | 10 => {
                let scale = [b, c].map(|size| Scalar::from_bits(size.to_bits()));
                let sprite = Sprite::new(&TILE).at(at).turned(self.angle).about(*a, *a).stretched(scale[0], scale[1]);
                match flags >> 1 & 3 {
                    0 => canvas.sprite(&sprite, buffer),
                    1 => canvas.sprite(&sprite.filter(Bilinear), buffer),
                    _ => canvas.fill_with(&sprite, &Blend::new(sprite.filter(Bilinear), Alpha), 0, buffer),
                }
            }
            11..=13 => {
                let join = [Join::Miter, Join::Round, Join::Bevel][usize::from(flags >> 1 & 3) % 3];
                let cap = [Cap::Butt, Cap::Round, Cap::Square][usize::from(flags >> 3 & 3) % 3];
                // Up to 24 px wide: each dash of a wider line may reach the screen.
                let line = Polyline::new(&self.points, Pixels::from_bits(a.to_bits() % 6000))
                    .with_join(join)
                    .with_cap(cap)
                    .with_miter_limit(*flags);
                let line = line.with_dashes(&self.pattern, *b);
                canvas.fill(&if flags & 0x80 == 0 { line } else { line.closed() }, *color, buffer);
            }
            14 => {
                // Steps of all kinds in turn, as long as there are points for them.
                let steps: Vec<_> = (self.points.chunks(1 + usize::from(flags >> 4 & 3) % 3).enumerate())
                    .map(|(k, points)| match (points, k) {
                        (&[first, second, to], _) => PathStep::Cubic(first, second, to),
                        (&[control, to], _) => PathStep::Quad(control, to),
                        (&[to], 0) => PathStep::Move(to),
                        (points, _) => PathStep::Line(points[0]),
                    })
                    .collect();
                let path = CurvePath::new(&steps);
                let scale = Scalar::from_bits(b.to_bits());
                let path = if flags & 4 == 0 { path.at(*self.points.last().unwrap_or(&at)) } else { path };
                let path = if flags & 8 == 0 { path.turned(self.angle).scaled(scale) } else { path };
                canvas.fill(&path, *color, buffer);
            }
            _ => {
                let (first, second) = self.points.split_at(self.points.len() / 2);
                let rule = if flags & 2 == 0 { FillRule::NonZero } else { FillRule::EvenOdd };
                canvas.fill(&Path::new(&[first, second]).with_rule(rule), *color, buffer);
            }
        }
    }
}

pub fn run(input: &[u8]) -> u64 {
    let mut source = Source::new(input);
    let screen = (1 + source.below(40) as u16, 1 + source.below(30) as u16);
    let (rows, edges) = (strip_rows(source.u8(), screen.1), 4 + source.below(60));
    // Narrower than the screen, too.
    let width = 1 + source.below(usize::from(screen.0)) as u16;
    let scissor = Rectangle::new(
        Point::new(source.coordinate(0), source.coordinate(0)),
        Size::new(u32::from(source.u8()), u32::from(source.u8())),
    );
    let has_scissor = source.below(4) == 0;
    let things: Vec<_> = (0..1 + source.below(5)).map(|_| Thing::new(&mut source)).collect();
    let ramp = Ramp::new(&[(0, Rgb888::RED), (100, Rgb888::BLUE), (255, Rgb888::WHITE)]);
    let pixels = usize::from(screen.0) * usize::from(screen.1);
    let (mut color, mut depth) = (vec![0xA5A5; pixels], vec![0x1234; pixels]);
    let mut words = vec![0xDEAD_BEEF; ShapeBuffer::words(width, edges)];
    let mut picture = |rows: usize| {
        let size = Size::new(screen.0.into(), screen.1.into());
        let renderer = Renderer::<Rgb565>::new(size).expect("a renderer");
        let mut renderer = renderer.with_depth(&mut depth).expect("depths");
        let mut found = Vec::with_capacity(pixels);
        let sink = |strip: &StripPixels<'_, Rgb565>| {
            found.extend_from_slice(strip.pixels());
            Ok::<(), Infallible>(())
        };
        let color = &mut color[..usize::from(screen.0) * rows];
        let frame = renderer.frame_to(sink, color, Rgb565::BLACK, |scene| {
            let mut buffer = ShapeBuffer::new(&mut words, width).expect("enough words");
            let mut canvas = scene.canvas();
            canvas.set_scissor(has_scissor.then_some(&scissor));
            for thing in &things {
                thing.draw(&mut canvas, &ramp, &mut buffer);
            }
        });
        frame.expect("the same scene");
        found
    };
    let (expected, found) = (picture(usize::from(screen.1)), picture(rows));
    assert_alike(&found, &expected, screen, &(rows, edges, width, &things));
    let mut hash = Hash::default();
    found.iter().for_each(|pixel| hash.bytes(&pixel.to_le_bytes()));
    hash.0
}
