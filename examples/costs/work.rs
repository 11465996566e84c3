//! Counts what there is to do in a frame: by the library's own counters, and by a shader that counts its calls.

use super::grids::{self, GRIDS, Memory, Parts, ROWS, WIDTH};
use super::materials::TEXELS;
use super::workloads::Buffers;
use super::workloads::price::{self, Priced};
use super::workloads::spot;
use std::cell::Cell;
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565};
use zstrip::span::{DepthTest, Fragment, Shader, SmallResult, SmallTriangle, SpanOf, TriangleSetup};
use zstrip::vertex::{Perspective, VertexRef, VertexShader, Wrapper};

/// Things that cost, in the order of [`TERMS`].
pub type Work = [f64; TERMS.len()];

/// A draw; a vertex that is shaded; a triangle that is looked at; one that is drawn, small or large; a row of one; a
/// pixel of one; a strip more that a triangle reaches into.
pub const TERMS: [&str; 10] = [
    "draw",
    "vertex",
    "triangle",
    "small_drawn",
    "small_row",
    "small_pixel",
    "large_drawn",
    "large_row",
    "large_pixel",
    "strip",
];
const SMALL: usize = 3;
pub const LARGE: usize = 6;
pub const STRIP: usize = 9;

/// Draws nothing, and counts triangles, rows and pixels.
#[derive(Default)]
struct Calls {
    /// Of small and of large triangles.
    counts: [[Cell<u32>; 3]; 2],
    is_small: Cell<bool>,
}

impl Calls {
    fn add(&self, what: usize, count: usize) {
        let cell = &self.counts[usize::from(!self.is_small.get())][what];
        cell.set(cell.get() + count as u32);
    }
}

impl VertexShader for Calls {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }
}

impl<P: PixelFormat> Shader<P> for Calls {
    type Setup = ();

    fn setup(&self, _: &TriangleSetup<'_, [i32; 0]>) {
        self.add(0, 1);
    }

    fn fragment(&self, _: &Fragment<'_, [i32; 0]>) -> Option<P::Raw> {
        None
    }

    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, _: D) {
        self.add(1, 1);
        self.add(2, span.color.len());
    }
}

/// Counts as [`Calls`] does, with texture coordinates: perspective decides, too, which triangles are small.
struct TexturedCalls {
    calls: Calls,
    /// A sixteenth of a texel.
    tolerance: u32,
    row: Cell<i32>,
}

impl TexturedCalls {
    fn new(side: u32) -> Self {
        Self { calls: Calls::default(), tolerance: 4096 / side, row: Cell::new(0) }
    }
}

impl VertexShader for TexturedCalls {
    type Varyings = Perspective<2, 3>;

    const IS_TOLERANT: bool = true;

    fn tolerance(&self) -> u32 {
        self.tolerance
    }

    fn vertex(&self, vertex: &VertexRef<'_>) -> Perspective<2, 3> {
        Perspective::new(vertex.uv().map(|c| c.to_bits()), [])
    }
}

impl<P: PixelFormat> Shader<P> for TexturedCalls {
    type Setup = ();

    /// Small triangles are not set up.
    fn setup(&self, _: &TriangleSetup<'_, Perspective<2, 3>>) {
        self.calls.add(0, 1);
    }

    /// Fragments of small triangles.
    fn fragment(&self, fragment: &Fragment<'_, Perspective<2, 3>>) -> Option<P::Raw> {
        let (_, y) = fragment.position;
        self.calls.add(1, usize::from(self.row.replace(y) != y));
        self.calls.add(2, 1);
        None
    }

    /// Spans of large triangles.
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, _: D) {
        self.calls.add(1, 1);
        self.calls.add(2, span.color.len());
    }
}

/// A shader that counts.
trait Counter: Shader<Gray8, Setup = ()> + Shader<Rgb565, Setup = ()> {
    fn calls(&self) -> &Calls;

    /// A small triangle begins.
    fn begin(&self) {
        self.calls().is_small.set(true);
    }

    /// A small triangle has ended.
    fn end(&self, result: SmallResult) {
        let _ = result;
        self.calls().is_small.set(false);
    }
}

impl Counter for Calls {
    fn calls(&self) -> &Calls {
        self
    }
}

impl Counter for TexturedCalls {
    fn calls(&self) -> &Calls {
        &self.calls
    }

    fn begin(&self) {
        self.row.set(i32::MIN);
        self.calls.is_small.set(true);
    }

    fn end(&self, result: SmallResult) {
        self.calls.add(0, usize::from(result == SmallResult::Drawn));
        self.calls.is_small.set(false);
    }
}

/// Tells the shader inside which triangles are small.
struct BySize<'c, C>(&'c C);

impl<C: Counter> Wrapper for BySize<'_, C> {
    type Inner = C;

    fn inner(&self) -> &C {
        self.0
    }
}

impl<P: PixelFormat, C: Counter + Shader<P, Setup = ()>> Shader<P> for BySize<'_, C> {
    type Setup = ();

    fn setup(&self, triangle: &TriangleSetup<'_, C::Varyings>) {
        Shader::<P>::setup(self.0, triangle);
    }

    fn fragment(&self, fragment: &Fragment<'_, C::Varyings>) -> Option<P::Raw> {
        Shader::<P>::fragment(self.0, fragment)
    }

    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        Shader::<P>::span(self.0, span, test);
    }

    fn small<D: DepthTest>(
        &self,
        triangle: SmallTriangle<'_, '_, P, D>,
        corners: &[C::Varyings; 3],
        flat: u32,
    ) -> SmallResult {
        self.0.begin();
        let result = Shader::<P>::small(self.0, triangle, corners, flat);
        self.0.end(result);
        result
    }
}

/// Returns the work of a frame: of its draws, and of what was counted. `first` is the number of triangles that are set
/// up in a single strip.
fn work(draws: usize, vertices: usize, triangles: usize, calls: &Calls, first: &mut Option<f64>) -> Work {
    let mut work: Work = [0.0; _];
    (work[0], work[1], work[2]) = (draws as f64, (vertices * draws) as f64, (triangles * draws) as f64);
    for (at, counts) in [SMALL, LARGE].into_iter().zip(&calls.counts) {
        for (k, count) in counts.iter().enumerate() {
            work[at + k] = count.get().into();
        }
    }
    // A triangle is set up once for each strip.
    let all = work[SMALL] + work[LARGE];
    let first = *first.get_or_insert(all);
    (work[SMALL], work[LARGE]) = (work[SMALL] * first / all, work[LARGE] * first / all);
    work[STRIP] = all - first;
    work
}

/// Returns the work of each grid in strips of these rows; of a texture, or of other materials.
pub fn of_grids(textured: bool) -> [[Work; ROWS.len()]; GRIDS] {
    let mut parts = Box::new(Parts::NEW);
    std::array::from_fn(|number| {
        let mut first = None;
        ROWS.map(|rows| match textured {
            true => of_grid(&mut parts, number, rows, &TexturedCalls::new(TEXELS), &mut first),
            false => of_grid(&mut parts, number, rows, &Calls::default(), &mut first),
        })
    })
}

fn of_grid(parts: &mut Parts, number: usize, rows: usize, counter: &impl Counter, first: &mut Option<f64>) -> Work {
    let grid = grids::grid(number);
    let places = &grids::places(grid.draws())[..grid.draws()];
    let mesh = parts.build(&grid).expect("a mesh");
    let (mut color, mut depth, mut records) = (vec![0; WIDTH * rows], vec![0; WIDTH * rows], vec![0; 96 * 1024]);
    let memory = Memory::<Gray8> { color: &mut color, depth: &mut depth, records: &mut records };
    let stats = grids::draw_by(memory, &mut |_| {}, &BySize(counter), &mesh, places);
    assert_eq!(stats.overflows + stats.clipped + stats.culled, 0, "grid {number}: {stats:?}");
    work(grid.draws(), mesh.vertex_count(), mesh.triangle_count(), counter.calls(), first)
}

/// Returns the work of a workload of the benchmark in strips of these rows.
pub fn of_workload(workload: Priced) -> [Work; ROWS.len()] {
    let mut first = None;
    ROWS.map(|rows| {
        let (calls, textured) = (Calls::default(), TexturedCalls::new(spot::TEXELS as u32));
        let pixels = workload.width() * rows;
        let (mut color, mut depth, mut records) = (vec![0; pixels], vec![0; pixels], vec![0; 96 * 1024]);
        let buffers = Buffers { color: &mut color, depth: &mut depth, records: &mut records };
        let (stats, calls) = match workload {
            Priced::W9 => (price::draw_by(workload, &BySize(&textured), buffers, &mut |_| {}), &textured.calls),
            _ => (price::draw_by(workload, &BySize(&calls), buffers, &mut |_| {}), &calls),
        };
        assert_eq!(stats.overflows, 0, "{workload:?}: {stats:?}");
        work(1, stats.vertices as usize, stats.triangles as usize, calls, &mut first)
    })
}
