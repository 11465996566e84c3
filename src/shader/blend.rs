//! Blending: a shader's colour and the pixel that is there make a new pixel.

use crate::color::{PixelFormat, Rgba8888};
use crate::span::{Fragment, Shader, TriangleSetup};
use crate::vertex::{VertexShader, Wrapper};

/// A way to blend pixels of format `P`.
///
/// | mode | colour of a pixel | source |
/// |---|---|---|
/// | [`Replace`] | source | `P` |
/// | [`Opacity`] | source · opacity + there · (1 - opacity) | `P` |
/// | [`Alpha`] | source · alpha + there · (1 - alpha) | [`Rgba8888`] |
/// | [`Add`] | source + there, at most 1 | `P` |
/// | [`AddAlpha`] | source · alpha + there, at most 1 | [`Rgba8888`] |
/// | [`Multiply`] | source · there | [`Rgba8888`] |
///
/// Modes whose source is `P` compute in the format itself, in one word for RGB565. The others compute in 8 bits per
/// channel, exactly rounded, and then cut surplus bits. Nothing is dithered again, so that a pixel to which black is
/// added stays as it is.
pub trait BlendMode<P: PixelFormat> {
    /// Format in which the shader is asked for colours.
    type Source: PixelFormat;

    /// Returns the new pixel.
    fn blend(&self, source: <Self::Source as PixelFormat>::Raw, there: P::Raw) -> P::Raw;
}

/// The shader's colour, as in an opaque draw without [`Blend`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Replace;

impl<P: PixelFormat> BlendMode<P> for Replace {
    type Source = P;

    #[inline(always)]
    fn blend(&self, source: P::Raw, _: P::Raw) -> P::Raw {
        source
    }
}

/// One opacity for the whole draw, 255 = opaque; see [`PixelFormat::mix`] for its steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Opacity(pub u8);

impl<P: PixelFormat> BlendMode<P> for Opacity {
    type Source = P;

    #[inline(always)]
    fn blend(&self, source: P::Raw, there: P::Raw) -> P::Raw {
        P::mix(source, there, u32::from(self.0) + u32::from(self.0 >> 7))
    }
}

/// The shader's own opacity, per fragment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Alpha;

/// Divides by 255, to nearest, for `x` up to 255².
#[inline(always)]
const fn by_255(x: u32) -> u32 {
    let x = x + 128;
    (x + (x >> 8)) >> 8
}

/// Computes three channels from those of two colours.
#[inline(always)]
fn map_channels([r, g, b]: [u8; 3], [s, t, u]: [u8; 3], f: impl Fn(u32, u32) -> u32) -> [u8; 3] {
    let channel = |a: u8, b: u8| f(u32::from(a), u32::from(b)) as u8;
    [channel(r, s), channel(g, t), channel(b, u)]
}

impl<P: PixelFormat> BlendMode<P> for Alpha {
    type Source = Rgba8888;

    #[inline(always)]
    fn blend(&self, source: [u8; 4], there: P::Raw) -> P::Raw {
        let [.., alpha] = source;
        let alpha = u32::from(alpha);
        P::pack(map_channels(Rgba8888::unpack(source), P::unpack(there), |s, t| by_255(s * alpha + t * (255 - alpha))))
    }
}

/// Adds light: sparks, flames, beams. The order of such draws does not matter, except for channels that have reached 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Add;

impl<P: PixelFormat> BlendMode<P> for Add {
    type Source = P;

    #[inline(always)]
    fn blend(&self, source: P::Raw, there: P::Raw) -> P::Raw {
        P::add(source, there)
    }
}

/// Adds the shader's colour times its opacity, as [`Add`] adds the colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AddAlpha;

impl<P: PixelFormat> BlendMode<P> for AddAlpha {
    type Source = Rgba8888;

    #[inline(always)]
    fn blend(&self, source: [u8; 4], there: P::Raw) -> P::Raw {
        let [.., alpha] = source;
        let alpha = u32::from(alpha);
        P::pack(map_channels(Rgba8888::unpack(source), P::unpack(there), |s, t| (by_255(s * alpha) + t).min(255)))
    }
}

/// Multiplies the pixel that is there by the shader's colour: coloured glass, shadows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Multiply;

impl<P: PixelFormat> BlendMode<P> for Multiply {
    type Source = Rgba8888;

    #[inline(always)]
    fn blend(&self, source: [u8; 4], there: P::Raw) -> P::Raw {
        P::pack(map_channels(Rgba8888::unpack(source), P::unpack(there), |s, t| by_255(s * t)))
    }
}

/// A shader whose colours are blended with the pixels that are there.
///
/// It has to be the outermost of nested shaders, `Blend<Fogged<..>>`: inner ones do not see the pixel that is there.
/// Draw transparent things after all others, from back to front (see
/// [`sort_back_to_front`](crate::mesh::sort_back_to_front)), and do not let them write depth
/// ([`DepthState::TEST`](crate::span::DepthState::TEST)).
///
/// ```
/// use zstrip::State;
/// use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, WebColors};
/// use zstrip::shader::{Blend, Flat, Opacity};
/// use zstrip::span::DepthState;
/// let glass = Blend::new(Flat::unlit(Rgb888::CSS_LIGHT_BLUE), Opacity(96));
/// let state = State { depth: DepthState::TEST, ..State::default() };
/// // scene.draw_with(state, &PANE, &mvp, &glass);
/// # let _ = (glass, state);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blend<S, M> {
    shader: S,
    mode: M,
}

impl<S, M> Blend<S, M> {
    /// Wraps a shader and blends its colours by a mode.
    #[must_use]
    pub const fn new(shader: S, mode: M) -> Self {
        Self { shader, mode }
    }
}

impl<S: VertexShader, M> Wrapper for Blend<S, M> {
    type Inner = S;

    #[inline(always)]
    fn inner(&self) -> &S {
        &self.shader
    }
}

impl<P: PixelFormat, M: BlendMode<P>, S: Shader<M::Source>> Shader<P> for Blend<S, M> {
    const STEP: usize = S::STEP;
    type Setup = S::Setup;

    #[inline(always)]
    fn setup(&self, triangle: &TriangleSetup<'_, S::Varyings>) -> S::Setup {
        self.shader.setup(triangle)
    }

    /// Blends the colour with black.
    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>) -> Option<P::Raw> {
        Some(self.mode.blend(self.shader.fragment(fragment)?, P::pack([0; 3])))
    }

    #[inline(always)]
    fn paint(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>, pixel: &mut P::Raw) -> bool {
        match self.shader.fragment(fragment) {
            Some(source) => {
                *pixel = self.mode.blend(source, *pixel);
                true
            }
            None => false,
        }
    }
}
