//! Sprites: an image, turned and scaled about a point of it; on the canvas, and in space, facing the viewer.

use super::arc::{direction, times};
use super::round::{pixels, place};
use crate::color::PixelFormat;
use crate::math::{Angle16, Pixels, Projective, Scalar, Vec3, divide, isqrt, mul_high};
use crate::scene::{Canvas, Outline, Pen, Place, Scene, ScreenPoint, ShapeBuffer};
use crate::span::{DepthState, DepthTest, Fragment, Shader, Span, SpanOf, draw_fragments};
use crate::target::Framebuffer;
use crate::texture::{Clamp, Filter, Nearest, OPAQUE, Texture};
use crate::vertex::{VertexRef, VertexShader};
use core::marker::PhantomData;
use core::num::NonZeroU32;
use embedded_graphics_core::geometry::{Point, Size};
use embedded_graphics_core::primitives::Rectangle;

/// An image that is turned and scaled about a point of it, its pivot, which is put to a place on the screen. Its edges
/// are smooth.
///
/// It is a shape and the shader to fill it with: [`Canvas::sprite`] draws it. Texels that are transparent, such as
/// those of a [`Keyed`](crate::texture::Keyed) colour, are left out. For alpha, fill the sprite with a
/// [`Blend`](crate::shader::Blend) of it.
///
/// Sides are up to 32,767 texels. A sprite is off by less than 1/64 texel in each direction where it is at most 512 px
/// wide.
///
/// ```
/// use zstrip::ScreenPoint;
/// use zstrip::math::{Angle16, Scalar};
/// use zstrip::shape::Sprite;
/// use zstrip::texture::{Bilinear, Tile};
/// static TILE: Tile<'static, 2, 2> = Tile::new(&[[0xFFFF, 0], [0, 0xFFFF]]);
/// let sprite = Sprite::new(&TILE).filter(Bilinear);
/// let turned = sprite.at(ScreenPoint::corner(100, 80)).turned(Angle16::from_degrees(30)).scaled(Scalar::from_num(8));
/// // canvas.sprite(&turned, &mut buffer);
/// # let _ = turned;
/// ```
#[derive(Debug, PartialEq)]
pub struct Sprite<'a, T, F = Nearest> {
    texture: &'a T,
    center: ScreenPoint,
    /// The pivot, in 16.16 texels.
    pivot: [i32; 2],
    angle: Angle16,
    scale: [Scalar; 2],
    /// Texel at the centre of the pixel that holds the sprite's place, in 16.16, and its changes per pixel to the right
    /// and down.
    texel: [i32; 2],
    right: [i32; 2],
    down: [i32; 2],
    /// 1 / sides, 0.32.
    inverse: [u32; 2],
    filter: PhantomData<F>,
}

impl<T, F> Clone for Sprite<'_, T, F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T, F> Copy for Sprite<'_, T, F> {}

/// Sides of an image, at most 32,767.
fn sides<T: Texture>(texture: &T) -> [i32; 2] {
    let Size { width, height } = texture.size();
    [width, height].map(|side| side.min(32_767) as i32)
}

impl<'a, T: Texture> Sprite<'a, T> {
    /// Makes a sprite of an image, neither turned nor scaled, about its middle, in the screen's top left corner.
    #[must_use]
    pub fn new(texture: &'a T) -> Self {
        let inverse = |side: i32| match NonZeroU32::new(side as u32) {
            // Rounded up, so that the quotient of a multiple is exact. A side of 1 has no such number.
            Some(side) if side.get() > 1 => divide((1 << 32) + u64::from(side.get()) - 1, side).0,
            _ => u32::MAX,
        };
        let sprite = Self {
            texture,
            center: ScreenPoint::corner(0, 0),
            pivot: sides(texture).map(|side| side << 15),
            angle: Angle16::ZERO,
            scale: [Scalar::ONE; 2],
            texel: [0; 2],
            right: [0; 2],
            down: [0; 2],
            inverse: sides(texture).map(inverse),
            filter: PhantomData,
        };
        sprite.placed()
    }
}

impl<'a, T: Texture, F> Sprite<'a, T, F> {
    /// Returns the sprite with its pivot at a place.
    #[must_use]
    pub fn at(self, place: ScreenPoint) -> Self {
        Self { center: place, ..self }.placed()
    }

    /// Returns the sprite with another pivot: a position in the image, in texels from its top left corner.
    #[must_use]
    pub fn about(self, x: Pixels, y: Pixels) -> Self {
        let texels = |c: Pixels| c.to_bits().saturating_mul(256);
        Self { pivot: [texels(x), texels(y)], ..self }.placed()
    }

    /// Returns the sprite turned clockwise.
    #[must_use]
    pub fn turned(self, angle: Angle16) -> Self {
        Self { angle, ..self }.placed()
    }

    /// Returns the sprite with texels of a size in pixels; negative ones turn the image upside down.
    #[must_use]
    pub fn scaled(self, scale: Scalar) -> Self {
        self.stretched(scale, scale)
    }

    /// Returns the sprite with texels of a width and a height in pixels; negative ones mirror the image. At less than
    /// 1/256 px nothing is drawn.
    #[must_use]
    pub fn stretched(self, x: Scalar, y: Scalar) -> Self {
        Self { scale: [x, y], ..self }.placed()
    }

    /// Returns the sprite with another filter.
    #[must_use]
    pub fn filter<G: Filter>(self, _: G) -> Sprite<'a, T, G> {
        let Self { texture, center, pivot, angle, scale, texel, right, down, inverse, .. } = self;
        Sprite { texture, center, pivot, angle, scale, texel, right, down, inverse, filter: PhantomData }
    }

    /// Returns whether there is nothing to draw.
    fn is_empty(&self) -> bool {
        self.scale.iter().any(|scale| scale.to_bits().unsigned_abs() < 256)
    }

    /// Computes the texels per pixel.
    ///
    /// # Format
    /// A texel is at least 1/256 px, so changes are at most 256 texels, 2²⁴ in 16.16.
    fn placed(self) -> Self {
        if self.is_empty() {
            return self;
        }
        let [cosine, sine] = direction(self.angle);
        // 1 / scale, in 16.16.
        let inverse = self.scale.map(|scale| {
            let (quotient, _) = divide(1 << 32, NonZeroU32::MIN.saturating_add(scale.to_bits().unsigned_abs() - 1));
            if scale.to_bits() < 0 { -i64::from(quotient) } else { i64::from(quotient) }
        });
        // 16.16 times 2.30, rounded.
        let per = |inverse: i64, factor: i32| ((inverse * i64::from(factor) + (1 << 29)) >> 30) as i32;
        let right = [per(inverse[0], cosine), per(inverse[1], -sine)];
        let down = [per(inverse[0], sine), per(inverse[1], cosine)];
        let texel = [0, 1].map(|axis: usize| {
            let (pivot, right, down) =
                if axis == 0 { (self.pivot[0], right[0], down[0]) } else { (self.pivot[1], right[1], down[1]) };
            // From the place to the centre of its pixel, 24.8: up to half a pixel.
            let to = |c: Pixels| i64::from(128 - (c.to_bits() & 255));
            let way = i64::from(right) * to(self.center.x()) + i64::from(down) * to(self.center.y());
            pivot.wrapping_add((way >> 8) as i32)
        });
        Self { texel, right, down, ..self }
    }

    /// Returns the texel at the centre of a pixel, 16.16, modulo 2³².
    #[inline]
    fn texel(&self, (x, y): (i32, i32)) -> [i32; 2] {
        let from = Point::from(self.center);
        let (x, y) = (x.wrapping_sub(from.x), y.wrapping_sub(from.y));
        let at = |texel: i32, right: i32, down: i32| {
            texel.wrapping_add(right.wrapping_mul(x)).wrapping_add(down.wrapping_mul(y))
        };
        [at(self.texel[0], self.right[0], self.down[0]), at(self.texel[1], self.right[1], self.down[1])]
    }

    /// Returns the place on the screen of a corner of the image.
    fn corner(&self, right: bool, lower: bool) -> Place {
        let [width, height] = sides(self.texture);
        let way = |far: bool, side: i32, pivot: i32, scale: Scalar| {
            let texels = if far { i64::from(side) << 16 } else { 0 } - i64::from(pivot);
            // 16.16 texels, below 2³², times 16.16.
            (texels * i64::from(scale.to_bits())) >> 16
        };
        let x = way(right, width, self.pivot[0], self.scale[0]);
        let y = way(lower, height, self.pivot[1], self.scale[1]);
        let [cosine, sine] = direction(self.angle);
        let [left, top] = place(self.center);
        [left + times(x, cosine) - times(y, sine), top + times(x, sine) + times(y, cosine)]
    }

    fn corners(&self) -> [Place; 4] {
        [(false, false), (true, false), (true, true), (false, true)].map(|(right, lower)| self.corner(right, lower))
    }
}

impl<T: Texture, F> Outline for Sprite<'_, T, F> {
    fn is_convex(&self) -> bool {
        true
    }

    fn trace(&self, pen: &mut Pen<'_, '_>) {
        if self.is_empty() {
            return;
        }
        let [first, rest @ ..] = self.corners();
        pen.move_to_place(first);
        for corner in rest {
            pen.line_to_place(corner);
        }
    }

    fn bounds(&self) -> Option<Rectangle> {
        let [a, b, c, d] = self.corners();
        let least = |k: fn(Place) -> i64| k(a).min(k(b)).min(k(c)).min(k(d));
        let most = |k: fn(Place) -> i64| k(a).max(k(b)).max(k(c)).max(k(d));
        let far = 32_767 << 16;
        let near = |c: i64| c.clamp(-far, far);
        Some(pixels([near(least(|p| p[0])), near(least(|p| p[1]))], [near(most(|p| p[0])), near(most(|p| p[1]))]))
    }
}

impl<T: Texture, F> VertexShader for Sprite<'_, T, F> {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }
}

impl<T: Texture, F: Filter> Sprite<'_, T, F> {
    /// Returns the pixel at a position in the image.
    #[inline(always)]
    fn pixel<P: PixelFormat>(&self, [u, v]: [i32; 2], position: (i32, i32)) -> Option<P::Raw> {
        let alpha = P::ALPHA || P::DITHER.is_some();
        let [width, height] = sides(self.texture);
        // The centre of a pixel at an edge may be outside of the image.
        let inside = |c: i32, side: i32| c.max(0).min((side << 16).wrapping_sub(1)) as u32;
        let (u, v) = (inside(u, width), inside(v, height));
        if F::NEAREST && !alpha {
            return self.texture.pixel::<P>(u >> 16, v >> 16);
        }
        let rgba = if F::NEAREST {
            self.texture.rgba(u >> 16, v >> 16)
        } else {
            let uv = [mul_high(u, self.inverse[0]) as i32, mul_high(v, self.inverse[1]) as i32];
            if !alpha {
                return F::pixel::<P, T, Clamp>(self.texture, uv);
            }
            F::rgba::<T, Clamp>(self.texture, uv)
        };
        if P::ALPHA || rgba[3] >= OPAQUE { Some(P::pack_rgba(rgba, position)) } else { None }
    }
}

impl<P: PixelFormat, T: Texture, F: Filter> Shader<P> for Sprite<'_, T, F> {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<P::Raw> {
        self.pixel::<P>(self.texel(fragment.position), fragment.position)
    }

    #[inline]
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        let [width, height] = sides(self.texture);
        let length = span.color.len() as i32;
        let ([mut u, mut v], [du, dv]) = (self.texel(span.position), self.right);
        let last = self.texel((span.position.0.wrapping_add(length).wrapping_sub(1), span.position.1));
        // Pixels between two that are inside are inside, too.
        let is_inside = |c: i32, side: i32| c >= 0 && c >> 16 < side;
        let inside =
            is_inside(u, width) & is_inside(v, height) & is_inside(last[0], width) & is_inside(last[1], height);
        if !F::NEAREST || P::DITHER.is_some() || P::ALPHA || !inside {
            return draw_fragments(self, span, test);
        }
        let Span { color, depth, z, .. } = span;
        let near = (z >> 16) as u16;
        for (color, stored) in color.iter_mut().zip(depth) {
            if !D::ENABLED || test.passes(near, *stored) {
                if let Some(pixel) = self.texture.pixel::<P>(u as u32 >> 16, v as u32 >> 16) {
                    test.write(near, stored);
                    *color = pixel;
                }
            }
            u = u.wrapping_add(du);
            v = v.wrapping_add(dv);
        }
    }
}

impl<F: Framebuffer> Canvas<'_, '_, F> {
    /// Draws a sprite, with smooth edges. Transparent texels are left out.
    pub fn sprite<T: Texture, G: Filter>(&mut self, sprite: &Sprite<'_, T, G>, buffer: &mut ShapeBuffer<'_>) {
        self.fill_with(sprite, sprite, 0, buffer);
    }
}

impl<F: Framebuffer> Scene<'_, F> {
    /// Returns how many pixels a length of 1 takes on the screen, at a point of object space and across the view.
    /// `None` where [`project`](Self::project) has none. The matrix scales all directions alike.
    #[must_use]
    pub fn pixels_per_unit(&self, point: Vec3, mvp: &Projective) -> Option<Scalar> {
        self.project(point, mvp)?;
        let [_, y, _, w] = mvp.rows();
        let [px, py, pz] = point.to_bits();
        // 32.32 times 16.16.
        let product = |entry: i64, c: i32| (i128::from(entry) * i128::from(c)) >> 16;
        let w = product(w[0], px) + product(w[1], py) + product(w[2], pz) + i128::from(w[3]);
        let w = u64::try_from(w).ok()?;
        // Root of the sum of squares, in 15 bits.
        let greatest = y[0].unsigned_abs().max(y[1].unsigned_abs()).max(y[2].unsigned_abs());
        let shift = 49_u32.saturating_sub(greatest.leading_zeros()).min(63);
        let square = |c: i64| {
            let c = (c.unsigned_abs() >> shift) as u32;
            c * c
        };
        let sum = square(y[0]) + square(y[1]) + square(y[2]);
        let root = u64::from(isqrt(sum)) << shift;
        // Half of the viewport's height per unit of clip space; both are brought to 31 bits.
        let down = 33_u32.saturating_sub(root.max(w).leading_zeros());
        let divisor = NonZeroU32::new((w >> down) as u32)?;
        let pixels = ((root >> down) * u64::from(self.viewport.height())) << 15;
        if pixels >> 31 >= u64::from(divisor.get()) {
            return Some(Scalar::MAX);
        }
        Some(Scalar::from_bits(divide(pixels, divisor).0 as i32))
    }

    /// Draws a sprite in space, facing the viewer, behind all that is nearer: its pivot at a point of object space, in
    /// such a size that the image is `height` high there. Its own place and scale do not matter. Pixels take the depth
    /// of the point.
    ///
    /// Draw it after meshes, and from back to front, since its edges are mixed with what is there.
    pub fn billboard<T: Texture, G: Filter>(
        &mut self,
        sprite: &Sprite<'_, T, G>,
        at: Vec3,
        height: Scalar,
        mvp: &Projective,
        buffer: &mut ShapeBuffer<'_>,
    ) {
        let Some((sprite, z)) = self.placed(sprite, at, height, mvp) else { return };
        self.canvas_with(z, DepthState::LESS).sprite(&sprite, buffer);
    }

    /// Returns a sprite as [`billboard`](Self::billboard) places it, and its depth, to fill it in another way: by a
    /// [`Blend`](crate::shader::Blend) on a [`canvas_with`](Self::canvas_with), for example. `None` if its pivot is not
    /// in front of the viewer, or it is too small.
    #[must_use]
    pub fn placed<'a, T: Texture, G: Filter>(
        &self,
        sprite: &Sprite<'a, T, G>,
        at: Vec3,
        height: Scalar,
        mvp: &Projective,
    ) -> Option<(Sprite<'a, T, G>, u16)> {
        let vertex = self.project(at, mvp)?;
        let per_unit = i64::from(self.pixels_per_unit(at, mvp)?.to_bits());
        let [_, rows] = sides(sprite.texture);
        // 16.16 px.
        let pixels = (per_unit * i64::from(height.to_bits().max(0))) >> 16;
        let scale = u64::try_from(pixels).ok()?.min(u64::from(u32::MAX >> 1)) as u32;
        let (scale, _) = divide(scale.into(), NonZeroU32::new(rows as u32)?);
        (scale >= 256).then(|| (sprite.at(vertex.into()).scaled(Scalar::from_bits(scale as i32)), vertex.z))
    }
}
