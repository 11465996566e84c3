//! Triangles of any shader: the planes of their varyings, a part of stage 8 of [the pipeline](crate#the-pipeline), and
//! the brush that draws small ones by the shader's spans.

use super::brush::{Brush, BrushRows, SmallResult, SmallTriangle};
use super::carried::{load_varyings, save_varyings, words_of};
use super::depth::DepthTest;
use super::planar::PlanarBrush;
use super::sample::Sample;
use super::shader::{Shader, SpanOf};
use super::span::{Primitive, Span, TriangleSetup, shift};
use crate::color::PixelFormat;
use crate::raster::{Gradients, ShortPlanes, homogenize, straighten, widen};
use crate::vertex::{PackedVertex, ScreenVertex, Side, Varyings};
use core::marker::PhantomData;

impl<P: PixelFormat, D: DepthTest> SmallTriangle<'_, '_, P, D> {
    /// Draws the triangle by the spans of a shader, if it is small.
    #[inline(always)]
    pub(crate) fn draw_spans<S: Shader<P> + ?Sized>(
        self,
        shader: &S,
        corners: &[S::Varyings; 3],
        flat: u32,
    ) -> SmallResult {
        let (screen, clockwise_fronts) = (self.target.screen, self.target.clockwise_fronts);
        let (v, format) = (self.v, PhantomData);
        if S::Varyings::PERSPECTIVE > 0 {
            self.draw(&PlanarBrush { shader, corners, flat, clockwise_fronts, format })
        } else {
            self.draw(&ShaderBrush { shader, corners, flat, v, screen, clockwise_fronts, format })
        }
    }
}

/// Draws by the spans of any shader.
struct ShaderBrush<'s, P: PixelFormat, S: Shader<P> + ?Sized> {
    shader: &'s S,
    corners: &'s [S::Varyings; 3],
    flat: u32,
    v: [&'s [u32; 2]; 3],
    screen: (u16, u16),
    clockwise_fronts: bool,
    format: PhantomData<P>,
}

/// The spans of a [`ShaderBrush`].
struct ShaderRows<'s, P: PixelFormat, S: Shader<P> + ?Sized> {
    shader: &'s S,
    primitive: Primitive<S::Varyings, S::Setup>,
    /// The first column, and the row.
    place: (i32, i32),
}

impl<'s, P: PixelFormat, D: DepthTest, S: Shader<P> + ?Sized> Brush<P, D> for ShaderBrush<'s, P, S> {
    const PLANES: bool = false;
    // A shader's set-up is for the centres of pixels.
    const SHIFTS: bool = size_of::<S::Setup>() == 0;

    type Rows = ShaderRows<'s, P, S>;

    #[inline(always)]
    fn set_up(
        &self,
        planes: &ShortPlanes,
        swapped: bool,
        place: (i32, i32),
        dz_dx: i32,
    ) -> Option<ShaderRows<'s, P, S>> {
        let side = if swapped == self.clockwise_fronts { Side::Front } else { Side::Back };
        let mut primitive = Primitive::constant(S::Varyings::ZERO, self.flat, side, S::Setup::default());
        primitive.dz_dx = dz_dx;
        let (b, c) = (planes.b, planes.c);
        let area = i64::from(b.1 * c.0 - b.0 * c.1);
        if S::Varyings::LEN > 0 {
            interpolate_packed(self.shader, self.v, self.screen, self.corners, &mut primitive);
        } else {
            let first = PackedVertex(*self.v[0]);
            let first = [first.x(), first.y()];
            set_up_shader(self.shader, first, self.corners, area.unsigned_abs(), &mut primitive);
        }
        Some(ShaderRows { shader: self.shader, primitive, place })
    }

    fn resume(&self, words: &[u32], place: (i32, i32)) -> ShaderRows<'s, P, S> {
        let mut primitive = Primitive::constant(S::Varyings::ZERO, self.flat, Side::Front, S::Setup::default());
        if let Some(([side, dz_dx], words)) = words.split_first_chunk() {
            if *side != 0 {
                primitive.side = Side::Back;
            }
            primitive.dz_dx = *dz_dx as i32;
            load_varyings([&mut primitive.at_origin, &mut primitive.d_dx, &mut primitive.d_dy], words);
        }
        ShaderRows { shader: self.shader, primitive, place }
    }
}

impl<P: PixelFormat, D: DepthTest, S: Shader<P> + ?Sized> BrushRows<P, D> for ShaderRows<'_, P, S> {
    // What a shader has set up is of any type, and stays in its strip.
    const WORDS: Option<usize> = if size_of::<S::Setup>() == 0 { words_of::<S::Varyings>(3) } else { None };

    #[inline(never)]
    fn save(&self, _: u32, words: &mut [u32]) {
        let Primitive { side, dz_dx, at_origin, d_dx, d_dy, .. } = &self.primitive;
        if let Some((first, words)) = words.split_first_chunk_mut() {
            *first = [u32::from(*side == Side::Back), *dz_dx as u32];
            save_varyings([at_origin, d_dx, d_dy], words);
        }
    }

    #[inline(always)]
    fn beside(&self, (right, down): (i32, i32)) -> Self {
        let mut primitive = self.primitive;
        shift(&mut primitive.at_origin, (&primitive.d_dx, right), (&primitive.d_dy, down));
        Self { primitive, ..*self }
    }

    #[inline(always)]
    fn next_row(&mut self) {
        self.place.1 += 1;
    }

    #[inline(always)]
    fn span(&self, color: &mut [P::Raw], depth: &mut [D::Depth], z: u32, _: i32, column: i32, test: D) {
        let position = (self.place.0 + column, self.place.1);
        let span: SpanOf<'_, P, S, D> = Span { color, depth, z, position, primitive: &self.primitive };
        self.shader.span(span, test);
    }

    #[inline(always)]
    fn span_at(
        &self,
        sample: Sample,
        color: &mut [P::Raw],
        depth: &mut [D::Depth],
        (z, _): (u32, i32),
        column: i32,
        test: D,
    ) {
        let position = (self.place.0 + column, self.place.1);
        let span: SpanOf<'_, P, S, D> = Span { color, depth, z, position, primitive: &self.primitive };
        self.shader.span_at(sample, span, test);
    }
}

#[inline(never)]
fn interpolate_packed<P: PixelFormat, S: Shader<P> + ?Sized>(
    shader: &S,
    [a, b, c]: [&[u32; 2]; 3],
    screen: (u16, u16),
    corners: &[S::Varyings; 3],
    primitive: &mut Primitive<S::Varyings, S::Setup>,
) {
    let v = [PackedVertex(*a).screen(), PackedVertex(*b).screen(), PackedVertex(*c).screen()];
    let area = crate::vertex::signed_area(&v[0], &v[1], &v[2]);
    let gradients = Gradients::new(&v, area, screen);
    interpolate(shader, &gradients, &v, screen, corners, primitive);
    set_up_shader(shader, [v[0].x, v[0].y], corners, area.unsigned_abs(), primitive);
}

/// Computes the plane equations of a triangle's varyings: a part of stage 8 of [the pipeline](crate#the-pipeline). The
/// base of each plane is its value at the screen's top left corner.
#[inline(always)]
pub(crate) fn interpolate<P: PixelFormat, S: Shader<P> + ?Sized>(
    _: &S,
    gradients: &Gradients,
    v: &[ScreenVertex; 3],
    screen: (u16, u16),
    corners: &[S::Varyings; 3],
    primitive: &mut Primitive<S::Varyings, S::Setup>,
) {
    let mut homogeneous;
    let [a, b, c] = if S::Varyings::PERSPECTIVE > 0 {
        homogeneous = *corners;
        homogenize(&mut homogeneous, v, screen, S::STEP, &mut primitive.perspective);
        homogeneous.each_ref()
    } else {
        corners.each_ref()
    };
    let values = [a.as_ref(), b.as_ref(), c.as_ref()];
    widen(gradients, &values, &mut primitive.perspective);
    let Primitive { at_origin, d_dx, d_dy, perspective, .. } = &mut *primitive;
    let planes = at_origin.as_mut().iter_mut().zip(d_dx.as_mut()).zip(d_dy.as_mut());
    for (k, ((at_origin, dx), dy)) in planes.enumerate() {
        let value = |vertex: &[i32]| vertex.get(k).copied().unwrap_or(0) >> S::ZERO_BITS;
        let plane = gradients.plane([value(values[0]), value(values[1]), value(values[2])], S::ZERO_BITS);
        (*at_origin, *dx, *dy) = (plane.base as i32, plane.dx, plane.dy);
    }
    if S::Varyings::PERSPECTIVE > 0 && S::STEP > 1 {
        straighten(d_dx.as_ref(), S::STEP.trailing_zeros(), perspective);
    }
}

/// Lets the shader set up a triangle, whose first vertex is at `v`, after its planes: the end of stage 8 of [the
/// pipeline](crate#the-pipeline). Out of line, so that its frame is not on the stack while planes are computed; where
/// there is nothing to set up, the call is dropped.
#[inline(never)]
pub(crate) fn set_up_shader<P: PixelFormat, S: Shader<P> + ?Sized>(
    shader: &S,
    v: [i32; 2],
    corners: &[S::Varyings; 3],
    area: u64,
    primitive: &mut Primitive<S::Varyings, S::Setup>,
) {
    let triangle = TriangleSetup::new(primitive, corners.each_ref(), area, (v[0] >> 8, v[1] >> 8));
    primitive.setup = shader.setup(&triangle);
}
