//! Shaders as a user would write them.

use super::quads::QUAD_COLOR;
use zstrip::color::PixelFormat;
use zstrip::shader::Flat;
use zstrip::span::{DepthTest, Fragment, Shader, SmallResult, SmallTriangle, SpanOf};
use zstrip::vertex::{Face, VertexRef, VertexShader};

/// Colours of the provoking vertices as they are: a shader as a user would write it, on top of [`Flat`]'s pixel loop.
pub struct FaceColors(pub Flat);

impl VertexShader for FaceColors {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }

    #[inline]
    fn face(&self, face: &Face<'_>) -> u32 {
        let [r, g, b] = face.provoking().color();
        u32::from_be_bytes([0, r, g, b])
    }
}

impl<P: PixelFormat> Shader<P> for FaceColors {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<P::Raw> {
        Shader::<P>::fragment(&self.0, fragment)
    }

    #[inline(always)]
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        Shader::<P>::span(&self.0, span, test);
    }

    #[inline(always)]
    fn small<D: DepthTest>(
        &self,
        triangle: SmallTriangle<'_, '_, P, D>,
        corners: &[[i32; 0]; 3],
        flat: u32,
    ) -> SmallResult {
        Shader::<P>::small(&self.0, triangle, corners, flat)
    }
}

/// One colour, as a user would write it: fragment by fragment.
pub struct OwnFlat;

impl VertexShader for OwnFlat {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }

    fn face(&self, _: &Face<'_>) -> u32 {
        let [r, g, b] = QUAD_COLOR;
        u32::from_be_bytes([0, r, g, b])
    }
}

impl<P: PixelFormat> Shader<P> for OwnFlat {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<P::Raw> {
        let [_, r, g, b] = fragment.flat.to_be_bytes();
        Some(P::pack([r, g, b]))
    }
}

/// Interpolated colours, as a user would write them.
pub struct OwnGouraud;

impl VertexShader for OwnGouraud {
    type Varyings = [i32; 3];

    fn vertex(&self, corner: &VertexRef<'_>) -> [i32; 3] {
        // 8.16, and a little away from both ends, for the gradients' errors.
        corner.color().map(|c| i32::from(c) * 0xFF00 + 0x4000)
    }
}

impl<P: PixelFormat> Shader<P> for OwnGouraud {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 3]>) -> Option<P::Raw> {
        let [r, g, b] = fragment.varyings;
        Some(P::pack([(r >> 16) as u8, (g >> 16) as u8, (b >> 16) as u8]))
    }
}
