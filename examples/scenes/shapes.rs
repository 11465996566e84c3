//! Shapes with smooth edges of all kinds, as they would stand in a drawing: stars by both fill rules, dashes, joins,
//! gradients, a turned sprite and a billboard.

use super::{Draw, torus_model, usual_camera};
use core::cell::RefCell;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, WebColors};
use zstrip::math::{Angle16, Pixels, Projective, Scalar, Vec3};
use zstrip::scene::ShapeBuffer;
use zstrip::shader::{Blend, Flat, Opacity};
use zstrip::shape::{
    Cap, Circle, Ellipse, FillRule, Join, LinearGradient, Path, Polyline, RadialGradient, Ramp, Ring, RoundedRectangle,
    Sprite,
};
use zstrip::texture::{Bilinear, Tile};
use zstrip::{Canvas, Framebuffer, Scene, ScreenPoint};

/// Words of a buffer that not all rows fit at once.
const WORDS: usize = ShapeBuffer::words(320, 24);

/// A chequered tile.
static TILE: Tile<'static, 8, 8> = Tile::new(&TEXELS);
static TEXELS: [[u16; 8]; 8] = {
    let mut texels = [[0xFFE0; 8]; 8];
    let mut k = 0;
    while k < 64 {
        if k / 8 % 2 != k % 2 {
            texels[k / 8][k % 8] = 0x001F + 0x0841 * (k / 8) as u16;
        }
        k += 1;
    }
    texels
};

/// Shapes on a screen of 320×240.
pub struct Shapes {
    turn: Angle16,
    mvp: Projective,
    ramp: Ramp<16>,
    words: RefCell<[u32; WORDS]>,
}

fn px(bits: i32) -> Pixels {
    Pixels::from_bits(bits)
}

/// The point at a radius in 256ths of a pixel, clockwise from the right.
fn around((x, y): (i32, i32), angle: Angle16, radius: i32) -> ScreenPoint {
    let at = |c: i32, v: Scalar| px(256 * c + ((i64::from(v.to_bits()) * i64::from(radius)) >> 16) as i32);
    ScreenPoint::new(at(x, angle.cos()), at(y, angle.sin()))
}

impl Shapes {
    pub fn new(screen: Size, turn: Angle16) -> Self {
        let ramp = Ramp::new(&[(0, Rgb888::CSS_GOLD), (130, Rgb888::CSS_CRIMSON), (255, Rgb888::CSS_INDIGO)]);
        let mvp = usual_camera(screen) * torus_model(turn);
        Self { turn, mvp, ramp, words: RefCell::new([0; WORDS]) }
    }
}

impl<F: Framebuffer> Draw<F> for Shapes {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        let Ok(mut words) = self.words.try_borrow_mut() else { return };
        let Ok(mut buffer) = ShapeBuffer::new(&mut *words, 320) else { return };
        let mut canvas = scene.canvas();
        self.stars(&mut canvas, &mut buffer);
        self.round(&mut canvas, &mut buffer);
        self.lines(&mut canvas, &mut buffer);
        self.sprites(&mut canvas, &mut buffer);
        self.billboard(scene, &mut buffer);
    }
}

impl Shapes {
    #[inline(never)]
    fn billboard<F: Framebuffer>(&self, scene: &mut Scene<'_, F>, buffer: &mut ShapeBuffer<'_>) {
        let sprite = Sprite::new(&TILE).turned(self.turn);
        scene.billboard(&sprite, Vec3::from_milli(900, -300, 300), Scalar::ONE >> 1, &self.mvp, buffer);
    }

    /// Stars that cross themselves, by both rules.
    #[inline(never)]
    fn stars<F: Framebuffer>(&self, canvas: &mut Canvas<'_, '_, F>, buffer: &mut ShapeBuffer<'_>) {
        for (x, rule) in [(50, FillRule::NonZero), (140, FillRule::EvenOdd)] {
            let mut star = [ScreenPoint::default(); 7];
            for (k, corner) in star.iter_mut().enumerate() {
                *corner = around((x, 50), self.turn + Angle16((k as u32 * 3 * 65_536 / 7) as u16), 43 * 256 + 99);
            }
            canvas.fill(&Path::new(&[&star]).with_rule(rule), Rgb888::CSS_TURQUOISE, buffer);
        }
    }

    /// Round shapes, with gradients and blended.
    #[inline(never)]
    fn round<F: Framebuffer>(&self, canvas: &mut Canvas<'_, '_, F>, buffer: &mut ShapeBuffer<'_>) {
        let center = ScreenPoint::new(px(230 * 256 + 40), px(50 * 256 + 200));
        let light = RadialGradient::new(&self.ramp, around((222, 40), self.turn, 900), px(50 * 256));
        canvas.fill_with(&Circle::new(center, px(41 * 256 + 30)), &light, 0, buffer);
        let glass = Blend::new(Flat::unlit(Rgb888::CSS_LIGHT_CYAN), Opacity(140));
        canvas.fill_with(&Ellipse::new(center, px(60 * 256), px(9 * 256 + 128)), &glass, 0, buffer);
        let ring = Ring::new(ScreenPoint::corner(285, 100), px(28 * 256), px(21 * 256));
        canvas.fill(&ring.part(self.turn, -40_000).with_round_ends(), Rgb888::CSS_ORANGE, buffer);
        canvas.fill(
            &Ring::pie(ScreenPoint::corner(285, 100), px(17 * 256), self.turn, 50_000),
            Rgb888::CSS_TOMATO,
            buffer,
        );
        let card = RoundedRectangle::new(ScreenPoint::corner(8, 110), around((120, 160), self.turn, 500));
        let slope = LinearGradient::new(&self.ramp, ScreenPoint::corner(20, 110), around((90, 160), self.turn, 2000));
        canvas.fill_with(&card.with_radius(px(11 * 256)), &slope, 0, buffer);
    }

    /// Lines in all joins and caps, and dashes.
    #[inline(never)]
    fn lines<F: Framebuffer>(&self, canvas: &mut Canvas<'_, '_, F>, buffer: &mut ShapeBuffer<'_>) {
        let kinds = [(Join::Miter, Cap::Butt), (Join::Round, Cap::Round), (Join::Bevel, Cap::Square)];
        for (k, (join, cap)) in (0..).zip(kinds) {
            let mut points = [ScreenPoint::default(); 5];
            for (n, point) in points.iter_mut().enumerate() {
                let turn = self.turn + Angle16((n * 20_000) as u16);
                *point = around((20 + 50 * k + 20 * n as i32 / 2, 205), turn, 20 * 256);
            }
            let line = Polyline::new(&points, px(1100)).with_join(join).with_cap(cap);
            canvas.fill(&line, Rgb888::CSS_SEA_GREEN, buffer);
        }
        let mut square = [ScreenPoint::default(); 4];
        for (k, corner) in square.iter_mut().enumerate() {
            *corner = around((170, 140), Angle16((k * 16_384) as u16 + 5000), 38 * 256);
        }
        let pattern = [px(2000), px(1500), px(1), px(1500)];
        let dashes = Polyline::new(&square, px(900)).closed().with_cap(Cap::Round);
        let dashes = dashes.with_dashes(&pattern, px(i32::from(self.turn.0)));
        canvas.fill(&dashes, Rgb888::CSS_WHITE, buffer);
    }

    /// A tile, turned and stretched, by both filters.
    #[inline(never)]
    fn sprites<F: Framebuffer>(&self, canvas: &mut Canvas<'_, '_, F>, buffer: &mut ShapeBuffer<'_>) {
        let sprite =
            Sprite::new(&TILE).turned(self.turn).stretched(Scalar::from_bits(300_000), Scalar::from_bits(200_000));
        canvas.sprite(&sprite.at(around((220, 140), self.turn, 300)), buffer);
        canvas.sprite(&sprite.filter(Bilinear).at(around((205, 200), self.turn, 300)), buffer);
    }
}
