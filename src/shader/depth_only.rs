//! Depth without colour.

use crate::color::PixelFormat;
use crate::span::{DepthTest, Fragment, Fragments, Shader};
use crate::vertex::{VertexRef, VertexShader};

/// Leaves depths and no colours: what is drawn with it hides what comes after, and shows what was there before. A mesh drawn
/// so hides the lines behind it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DepthOnly;

impl VertexShader for DepthOnly {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }
}

impl<P: PixelFormat> Shader<P> for DepthOnly {
    /// Not called: spans are drawn without fragments.
    fn fragment(&self, _: &Fragment<'_, [i32; 0]>) -> Option<P::Raw> {
        None
    }

    #[inline]
    fn span<D: DepthTest>(&self, _: u32, span: Fragments<'_, P, [i32; 0], D::Depth>, test: D) {
        if !D::ENABLED {
            return;
        }
        let Fragments { depth, mut z, steps, .. } = span;
        for stored in depth {
            let depth = (z >> 16) as u16;
            if test.passes(depth, *stored) {
                test.write(depth, stored);
            }
            z = z.wrapping_add_signed(steps.dz_dx);
        }
    }
}
