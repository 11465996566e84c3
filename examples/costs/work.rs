//! Counts what there is to do in a frame: by the library's own counters, and by a shader that counts its calls.

use super::calls::{BySize, Calls, Counter, LitTextureCalls, TextureCalls};
use super::grids::{self, GRIDS, Memory, Parts, ROWS, WIDTH};
use super::materials::{Kind, TEXELS};
use super::workloads::Buffers;
use super::workloads::price::{self, Priced};
use super::workloads::spot;
use zstrip::embedded_graphics_core::pixelcolor::Gray8;

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

/// Returns the work that each grid of a material is, in strips of these rows.
pub fn of_grids(kind: Kind) -> [[Work; ROWS.len()]; GRIDS] {
    let mut parts = Box::new(Parts::NEW);
    std::array::from_fn(|number| {
        let mut first = None;
        ROWS.map(|rows| match kind {
            Kind::Textured => of_grid(&mut parts, number, rows, &TextureCalls::new(TEXELS), &mut first),
            Kind::LitTextured => of_grid(&mut parts, number, rows, &LitTextureCalls::new(TEXELS), &mut first),
            _ => of_grid(&mut parts, number, rows, &Calls::default(), &mut first),
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
        let (calls, textured) = (Calls::default(), LitTextureCalls::new(spot::TEXELS as u32));
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
