//! Alpha to coverage: alpha becomes a number of covered samples.

use crate::color::{PixelFormat, Rgba8888};
use crate::span::{AtSample, DepthTest, Fragment, Sample, Shader, SpanOf, TriangleSetup, draw_fragments};
use crate::vertex::{VertexShader, Wrapper};

/// Draws fragments to a part of a pixel's samples: alpha / 255 of them, 255 = opaque. Leaves, fences and letters get
/// smooth edges inside of triangles, too, with a renderer [with samples](crate::frame::Renderer::with_samples).
///
/// The pixel that is there is not read, and samples that alpha leaves out keep their colour and their depth. So the
/// order of draws is free, and depth is written as by opaque draws. Alpha and the pixel's place on the screen decide
/// which samples are covered; [`Sample::is_covered`] tells how. Two surfaces of the same alpha cover the same samples,
/// so the nearer one hides the farther one where both are; [`Blend`](crate::shader::Blend) mixes them.
///
/// With one sample per pixel, and so under [`Supersampled`](crate::frame::Supersampled), this shader draws the
/// fragments whose alpha is at least 128, as [`AlphaTest`](crate::shader::AlphaTest) does. It has to be the outermost
/// of nested shaders, `AlphaToCoverage<Fogged<..>>`: inside of others, it draws as with one sample.
///
/// ```
/// use zstrip::prelude::*;
/// use zstrip::shader::{AlphaToCoverage, Textured};
/// use zstrip::texture::{Bilinear, Tile, WithAlpha};
///
/// // One white texel, whose alpha is 8 of 15.
/// let pane = WithAlpha::new(Tile::new(&[[0xFFFF]]), &[0x80])?;
/// let shader = AlphaToCoverage::new(Textured::new(&pane).filter(Bilinear));
///
/// // A square that fills the screen.
/// let at = |x, y| [x, y, 0, 1].map(|c| Scalar::from_bits(c << 16));
/// let corners = [at(-1, 1), at(-1, -1), at(1, -1), at(1, 1)];
/// let uvs = [[0, 0], [0, 1], [1, 1], [1, 0]].map(|uv| uv.map(|c| Scalar::from_bits(c << 16)));
/// let data = MeshData { uvs: Some(&uvs), ..MeshData::new(Positions::Homogeneous(&corners)) };
/// let square = Mesh::new(MeshData { topology: Topology::Fan, ..data })?;
///
/// let (mut color, mut samples, mut depth) = ([0; 16 * 16], [0; 3 * 16 * 16], [0; 4 * 16 * 16]);
/// let renderer = Renderer::<Rgb565>::new(Size::new(16, 16))?;
/// let mut renderer = renderer.with_samples::<4>(&mut depth, &mut samples)?;
/// let mut frame = renderer.begin(Rgb888::BLACK);
/// while frame.next_strip(&mut color, |scene| scene.draw(&square, &Projective::IDENTITY, &shader))?.is_some() {}
///
/// // 8 / 15 of 16 samples are 9 to nearest: of each 2×2 pixels, one has three white samples, and the others have two.
/// assert_eq!([color[0], color[1]], [Rgb565::pack([191; 3]), Rgb565::pack([128; 3])]);
/// assert_eq!([color[16], color[17]], [Rgb565::pack([128; 3]); 2]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AlphaToCoverage<S> {
    shader: S,
}

impl<S> AlphaToCoverage<S> {
    /// Wraps a shader.
    #[must_use]
    pub const fn new(shader: S) -> Self {
        Self { shader }
    }
}

impl<S: VertexShader> Wrapper for AlphaToCoverage<S> {
    type Inner = S;

    #[inline(always)]
    fn inner(&self) -> &S {
        &self.shader
    }
}

impl<P: PixelFormat, S: Shader<Rgba8888>> Shader<P> for AlphaToCoverage<S> {
    const STEP: usize = S::STEP;
    type Setup = S::Setup;

    #[inline(always)]
    fn setup(&self, triangle: &TriangleSetup<'_, S::Varyings>) -> S::Setup {
        self.shader.setup(triangle)
    }

    /// Returns the colour of a fragment that covers the pixel's only sample.
    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>) -> Option<P::Raw> {
        let mut pixel = P::pack([0; 3]);
        Shader::<P>::paint_at(self, Sample::ONLY, fragment, &mut pixel).then_some(pixel)
    }

    #[inline]
    fn paint_at(&self, sample: Sample, fragment: &Fragment<'_, S::Varyings, S::Setup>, pixel: &mut P::Raw) -> bool {
        let Some([r, g, b, alpha]) = self.shader.fragment(fragment) else { return false };
        let is_covered = sample.is_covered(alpha, fragment.position);
        if is_covered {
            *pixel = P::pack_at([r, g, b], fragment.position);
        }
        is_covered
    }

    #[inline]
    fn span_at<D: DepthTest>(&self, sample: Sample, span: SpanOf<'_, P, Self, D>, test: D) {
        draw_fragments::<P, _, D>(&AtSample { shader: self, sample }, span, test);
    }
}
