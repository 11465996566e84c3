//! Workloads drawn in other ways than the benchmark does: by shaders of a user's own, and in other states. They tell
//! whether a figure is met by a path that only the benchmark takes.

use super::{
    BACKGROUND, Buffers, FaceColors, HEIGHT, IN_VIEW, OF_TORUS, SCREEN, TORUS, TORUS_SURFACE, WIDTH, Workload,
    frame_on, spot, tiny_mesh,
};
use core::convert::Infallible;
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
use zstrip::frame::{Renderer, Supersampled};
use zstrip::math::{Projective, Scalar};
use zstrip::mesh::Mesh;
use zstrip::scene::Cull;
use zstrip::shader::{Blend, Flat, Gouraud, Opacity, Textured};
use zstrip::span::{
    DepthBias, DepthState, DepthTest, Fragment, Shader, SmallResult, SmallTriangle, SpanOf, TriangleSetup,
};
use zstrip::target::{DepthChoice, Stats, Strip, StripPixels, WithRecords, WithSamples};
use zstrip::vertex::{PackedCorners, VertexShader, Wrapper};
use zstrip::{Scene, State};

/// The workloads with prices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Priced {
    W4,
    W5,
    W6,
    W9,
    /// W9 on a surface that is not grey: light in three channels instead of one.
    ColoredW9,
    W10,
    /// Nothing, on the screen of W4 to W6.
    Empty,
    /// Nothing, on the screen of W9 and W10.
    EmptySpot,
}

pub const PRICED: [(&str, Priced); 6] = [
    ("w4", Priced::W4),
    ("w5", Priced::W5),
    ("w6", Priced::W6),
    ("w9", Priced::W9),
    ("w9_coloured", Priced::ColoredW9),
    ("w10", Priced::W10),
];

impl Priced {
    /// Returns the columns of the screen.
    pub const fn width(self) -> usize {
        match self {
            Self::W4 | Self::W5 | Self::W6 | Self::Empty => WIDTH,
            Self::W9 | Self::ColoredW9 | Self::W10 | Self::EmptySpot => spot::SIDE,
        }
    }
}

/// The shader that draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// That of the benchmark.
    Usual,
    /// A wrapper of one's own that passes everything on to it.
    PassedOn,
    /// A wrapper of one's own that colours fragment by fragment.
    OwnFragment,
    /// [`Blend`], opaque.
    Blended,
}

/// The state of the draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Under {
    /// The default.
    Usual,
    /// Fragments at equal depth pass too.
    LessEqual,
    /// Back faces are drawn too.
    AllFaces,
    /// Depth is moved by one step.
    Biased,
}

/// The ways that are counted, the benchmark's first.
pub const WAYS: [(&str, By, Under); 7] = [
    ("usual", By::Usual, Under::Usual),
    ("passed_on", By::PassedOn, Under::Usual),
    ("own_fragment", By::OwnFragment, Under::Usual),
    ("less_equal", By::Usual, Under::LessEqual),
    ("biased", By::Usual, Under::Biased),
    ("all_faces", By::Usual, Under::AllFaces),
    ("blended", By::Blended, Under::Usual),
];

const LESS_EQUAL: State = State { depth: DepthState::LESS_EQUAL, ..State::DEFAULT };
const ALL_FACES: State = State { cull: Cull::None, ..State::DEFAULT };
const BIASED: State = State { bias: DepthBias { constant: 1, slope: Scalar::ZERO }, ..State::DEFAULT };

/// A shader of a user's own around another one: it passes everything on.
struct PassedOn<'s, S>(&'s S);

impl<S: VertexShader> Wrapper for PassedOn<'_, S> {
    type Inner = S;

    #[inline]
    fn inner(&self) -> &S {
        self.0
    }
}

impl<P: PixelFormat, S: Shader<P>> Shader<P> for PassedOn<'_, S> {
    const STEP: usize = S::STEP;
    type Setup = S::Setup;

    #[inline]
    fn setup(&self, triangle: &TriangleSetup<'_, S::Varyings>) -> S::Setup {
        self.0.setup(triangle)
    }

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>) -> Option<P::Raw> {
        self.0.fragment(fragment)
    }

    #[inline]
    fn paint(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>, pixel: &mut P::Raw) -> bool {
        self.0.paint(fragment, pixel)
    }

    #[inline]
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        self.0.span(span, test);
    }

    #[inline]
    fn small<D: DepthTest>(
        &self,
        triangle: SmallTriangle<'_, '_, P, D>,
        corners: &[S::Varyings; 3],
        flat: u32,
    ) -> SmallResult {
        self.0.small(triangle, corners, flat)
    }

    const PACKS_SMALL: bool = S::PACKS_SMALL;

    #[inline]
    fn small_packed<D: DepthTest>(
        &self,
        triangle: SmallTriangle<'_, '_, P, D>,
        corners: &PackedCorners<'_>,
    ) -> SmallResult {
        self.0.small_packed(triangle, corners)
    }
}

/// A shader of a user's own around another one: it has a fragment function, and nothing else that is not required.
struct OwnFragment<'s, S>(&'s S);

impl<S: VertexShader> Wrapper for OwnFragment<'_, S> {
    type Inner = S;

    #[inline]
    fn inner(&self) -> &S {
        self.0
    }
}

impl<P: PixelFormat, S: Shader<P>> Shader<P> for OwnFragment<'_, S> {
    const STEP: usize = S::STEP;
    type Setup = S::Setup;

    #[inline]
    fn setup(&self, triangle: &TriangleSetup<'_, S::Varyings>) -> S::Setup {
        self.0.setup(triangle)
    }

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>) -> Option<P::Raw> {
        self.0.fragment(fragment)
    }
}

/// A frame's subject: the usual shader's draw of a mesh.
struct Subject<'a, S> {
    screen: Size,
    mesh: &'a Mesh<'a>,
    matrix: &'a Projective,
    shader: S,
}

/// Draws a frame of a workload in one of these ways.
pub fn draw(workload: Priced, by: By, under: Under, buffers: Buffers<'_>, sink: &mut dyn FnMut(&[u16])) -> Stats {
    match workload {
        Priced::W4 => torus(Flat::new(TORUS_SURFACE)).draw(by, under, buffers, sink),
        Priced::W5 => torus(Gouraud::new(TORUS_SURFACE)).draw(by, under, buffers, sink),
        Priced::W6 => {
            let shader = FaceColors(Flat::unlit(Rgb888::new(0, 0, 0)));
            Subject { screen: SCREEN, mesh: tiny_mesh(), matrix: &IN_VIEW, shader }.draw(by, under, buffers, sink)
        }
        Priced::W9 | Priced::ColoredW9 => {
            let color = if workload == Priced::W9 { [255; 3] } else { spot::COLOR };
            let shader = Textured::new(&spot::TEXTURE).lit(spot::under_light(color));
            cow(&spot::TEXTURED, shader).draw(by, under, buffers, sink)
        }
        Priced::W10 => {
            let shader = Flat::new(const { spot::under_light(spot::COLOR) });
            cow(&spot::PLAIN, shader).draw(by, under, buffers, sink)
        }
        Priced::Empty => super::draw(Workload::Empty, buffers, sink),
        Priced::EmptySpot => super::draw(Workload::EmptySpot, buffers, sink),
    }
}

/// Draws a frame of a workload by another shader.
pub fn draw_by(
    workload: Priced,
    shader: &impl Shader<Rgb565>,
    buffers: Buffers<'_>,
    sink: &mut dyn FnMut(&[u16]),
) -> Stats {
    match workload {
        Priced::W4 | Priced::W5 => torus(()).frame(shader, buffers, sink),
        Priced::W6 => {
            Subject { screen: SCREEN, mesh: tiny_mesh(), matrix: &IN_VIEW, shader: () }.frame(shader, buffers, sink)
        }
        Priced::W9 | Priced::ColoredW9 => cow(&spot::TEXTURED, ()).frame(shader, buffers, sink),
        Priced::W10 => cow(&spot::PLAIN, ()).frame(shader, buffers, sink),
        Priced::Empty | Priced::EmptySpot => draw(workload, By::Usual, Under::Usual, buffers, sink),
    }
}

/// Memory of a frame with several samples per pixel: colours, those of further samples, depths and records.
pub type SampledBuffers<'b> = (&'b mut [u16], &'b mut [u16], &'b mut [u16], &'b mut [u32]);

/// Draws a frame of a workload with `N` samples per pixel.
pub fn with_samples<const N: usize>(
    workload: Priced,
    buffers: SampledBuffers<'_>,
    sink: &mut dyn FnMut(&[u16]),
) -> Stats
where
    WithSamples<N>: DepthChoice,
{
    match workload {
        Priced::W4 => torus(Flat::new(TORUS_SURFACE)).sampled::<N>(buffers, sink),
        Priced::W5 => torus(Gouraud::new(TORUS_SURFACE)).sampled::<N>(buffers, sink),
        Priced::W9 => cow(&spot::TEXTURED, Textured::new(&spot::TEXTURE).lit(spot::under_light([255; 3])))
            .sampled::<N>(buffers, sink),
        Priced::W10 => {
            cow(&spot::PLAIN, Flat::new(const { spot::under_light(spot::COLOR) })).sampled::<N>(buffers, sink)
        }
        _ => sampled_frame::<N>(workload, buffers, sink, |_| {}),
    }
}

/// Draws a frame of a workload with 2 × 2 pixels for one. Colours and depths are those of the finer screen.
pub fn supersampled(
    workload: Priced,
    (color, depth, records): (&mut [u16], &mut [u16], &mut [u32]),
    sink: &mut dyn FnMut(&[u16]),
) -> Stats {
    let screen = Size::new(workload.width() as u32, HEIGHT as u32) * 2;
    let renderer = Renderer::<Rgb565>::new(screen).and_then(|renderer| renderer.with_depth(depth));
    let renderer = renderer.map(|renderer| renderer.with_records(records));
    let Ok(mut renderer) = renderer.and_then(Supersampled::<_, _, _, 2>::new) else { return Stats::default() };
    let sink = |strip: &StripPixels<'_, Rgb565>| {
        sink(strip.pixels());
        Ok::<(), Infallible>(())
    };
    let stats = match workload {
        Priced::W4 => {
            renderer.frame_to(sink, color, BACKGROUND, |s| s.draw(&TORUS, &OF_TORUS, &Flat::new(TORUS_SURFACE)))
        }
        Priced::W5 => {
            renderer.frame_to(sink, color, BACKGROUND, |s| s.draw(&TORUS, &OF_TORUS, &Gouraud::new(TORUS_SURFACE)))
        }
        Priced::W9 => {
            let shader = Textured::new(&spot::TEXTURE).lit(spot::under_light([255; 3]));
            renderer.frame_to(sink, color, BACKGROUND, |s| s.draw(&spot::TEXTURED, &spot::MATRIX, &shader))
        }
        Priced::W10 => {
            let shader = Flat::new(const { spot::under_light(spot::COLOR) });
            renderer.frame_to(sink, color, BACKGROUND, |s| s.draw(&spot::PLAIN, &spot::MATRIX, &shader))
        }
        _ => renderer.frame_to(sink, color, BACKGROUND, |_| {}),
    };
    stats.unwrap_or_default()
}

/// Buffers that do not hold a row draw nothing.
fn sampled_frame<const N: usize>(
    workload: Priced,
    (color, samples, depth, records): SampledBuffers<'_>,
    sink: &mut dyn FnMut(&[u16]),
    mut draw: impl FnMut(&mut Scene<'_, Strip<'_, Rgb565, WithSamples<N>, WithRecords>>),
) -> Stats
where
    WithSamples<N>: DepthChoice,
{
    let screen = Size::new(workload.width() as u32, HEIGHT as u32);
    let renderer = Renderer::<Rgb565>::new(screen).and_then(|renderer| renderer.with_samples::<N>(depth, samples));
    let Ok(renderer) = renderer else { return Stats::default() };
    let mut renderer = renderer.with_records(records);
    let mut frame = renderer.begin(BACKGROUND);
    while let Ok(Some(strip)) = frame.next_strip(color, &mut draw) {
        sink(strip.pixels());
    }
    frame.stats()
}

const fn torus<S>(shader: S) -> Subject<'static, S> {
    Subject { screen: SCREEN, mesh: &TORUS, matrix: &OF_TORUS, shader }
}

const fn cow<S>(mesh: &'static Mesh<'static>, shader: S) -> Subject<'static, S> {
    Subject { screen: spot::SCREEN, mesh, matrix: &spot::MATRIX, shader }
}

impl<S> Subject<'_, S> {
    fn frame(&self, shader: &impl Shader<Rgb565>, buffers: Buffers<'_>, sink: &mut dyn FnMut(&[u16])) -> Stats {
        let &Self { screen, mesh, matrix, .. } = self;
        frame_on(screen, buffers, sink, &mut |scene| scene.draw(mesh, matrix, shader))
    }
}

impl<S: Shader<Rgb565>> Subject<'_, S> {
    fn sampled<const N: usize>(&self, buffers: SampledBuffers<'_>, sink: &mut dyn FnMut(&[u16])) -> Stats
    where
        WithSamples<N>: DepthChoice,
    {
        let &Self { screen, mesh, matrix, ref shader } = self;
        let workload = if screen.width == spot::SCREEN.width { Priced::EmptySpot } else { Priced::Empty };
        sampled_frame::<N>(workload, buffers, sink, |scene| scene.draw(mesh, matrix, shader))
    }

    fn draw(&self, by: By, under: Under, buffers: Buffers<'_>, sink: &mut dyn FnMut(&[u16])) -> Stats {
        match by {
            By::Usual => self.draw_by(&self.shader, under, buffers, sink),
            By::PassedOn => self.draw_by(&PassedOn(&self.shader), under, buffers, sink),
            By::OwnFragment => self.draw_by(&OwnFragment(&self.shader), under, buffers, sink),
            By::Blended => self.draw_by(&Blend::new(PassedOn(&self.shader), Opacity(255)), under, buffers, sink),
        }
    }

    /// Each state is a constant, as in a program that uses it.
    fn draw_by(
        &self,
        shader: &impl Shader<Rgb565>,
        under: Under,
        buffers: Buffers<'_>,
        sink: &mut dyn FnMut(&[u16]),
    ) -> Stats {
        let &Self { screen, mesh, matrix, .. } = self;
        match under {
            Under::Usual => self.frame(shader, buffers, sink),
            Under::LessEqual => {
                frame_on(screen, buffers, sink, &mut |scene| scene.draw_with(LESS_EQUAL, mesh, matrix, shader))
            }
            Under::AllFaces => {
                frame_on(screen, buffers, sink, &mut |scene| scene.draw_with(ALL_FACES, mesh, matrix, shader))
            }
            Under::Biased => {
                frame_on(screen, buffers, sink, &mut |scene| scene.draw_with(BIASED, mesh, matrix, shader))
            }
        }
    }
}
