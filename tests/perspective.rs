//! Perspective-correct varyings against exact rationals: at each pixel, and every 4 to 32 of them.

use crate::reference::conformance::PerspectiveTriangle;
use crate::reference::conformance::records::Table;
use crate::reference::exact;
use crate::reference::rng::Rng;
use crate::reference::subject::Subject;
use crate::support;

const SIDE: u32 = 128;

/// The largest and the mean error over the pixels of a triangle, how many there are, and by how much an error is larger
/// than its bound.
#[derive(Clone, Copy, Debug, Default)]
struct Error {
    worst: f64,
    sum: f64,
    pixels: usize,
    beyond: f64,
}

impl Error {
    fn add(&mut self, error: f64, bound: f64) {
        self.worst = self.worst.max(error);
        self.sum += error;
        self.pixels += 1;
        self.beyond = self.beyond.max(error - bound);
    }
}

/// Compares every pixel with the exact value.
fn compare<const STEP: usize>(triangle: &PerspectiveTriangle, total: &mut Error) {
    let tri = exact::widen(triangle.v);
    let got = Subject::default().coordinates::<STEP>((SIDE, SIDE), triangle);
    let width = SIDE as usize;
    let w = triangle.w.map(i64::from);
    for (index, values) in got.iter().enumerate() {
        let (x, y) = (index % width, index / width);
        assert_eq!(values.is_some(), exact::covers(tri, x as i64, y as i64), "({x}, {y}) of {triangle:?}");
        let Some(values) = values else { continue };
        for (value, at_vertices) in values.iter().zip([triangle.u, triangle.t]) {
            let at = |x: usize| {
                let point = exact::center(x as i64, y as i64);
                let (num, den) = exact::perspective_at(tri, w, at_vertices.map(i64::from), point);
                (num as f64 / den as f64, den as f64)
            };
            total.add((value - at(x).0).abs(), TEXEL + change::<STEP>(x, at) / 34.0);
        }
    }
}

/// A sixteenth of a texel: how far a value that is divided at its own pixel may be off.
const TEXEL: f64 = 1.0 / 16.0;

/// Returns the change of a value between the two columns around a pixel, at most `STEP` apart, over which q = 1 / w
/// changes by an eighth at most; 0 if q changes by more even from one column to the next. `at` returns the value and a
/// multiple of q.
fn change<const STEP: usize>(x: usize, at: impl Fn(usize) -> (f64, f64)) -> f64 {
    let mut step = STEP;
    while step > 1 {
        let first = x / step * step;
        let ((a, qa), (b, qb)) = (at(first), at(first + step));
        if qa > 0.0 && qb > 0.0 && (qa - qb).abs() <= qa.max(qb) / 8.0 {
            return (a - b).abs();
        }
        step /= 2;
    }
    0.0
}

/// Triangles as in the conformance data: w differs by up to 2^`octaves`.
fn random(rng: &mut Rng, octaves: f64) -> PerspectiveTriangle {
    let spread = [300.0, 128.0, 30.0][rng.below(3) as usize];
    let (cx, cy) = (rng.unit() * 128.0, rng.unit() * 128.0);
    let mut corner = || [cx, cy].map(|c| ((c + (2.0 * rng.unit() - 1.0) * spread) * 256.0) as i32);
    let v = [corner(), corner(), corner()];
    let mut w = || (65_536.0 * 2_f64.powf((rng.unit() - 0.5) * octaves)) as i32;
    let w = [w(), w(), w()];
    let mut coordinate = || rng.below(256) as i32;
    PerspectiveTriangle { v, w, u: [(); 3].map(|()| coordinate()), t: [(); 3].map(|()| coordinate()) }
}

#[test]
fn every_pixel_is_within_a_sixteenth_of_a_texel_whatever_w_is() {
    let mut worst = 0.0_f64;
    for octaves in [0.5_f64, 2.0, 5.0, 8.0, 11.0] {
        let mut total = Error::default();
        let mut rng = Rng::new(octaves.to_bits());
        for _ in 0..150 {
            compare::<1>(&random(&mut rng, octaves), &mut total);
        }
        let mean = total.sum / total.pixels as f64;
        println!("w up to 2^{octaves}: worst {:.5}, mean {mean:.6} of {} values", total.worst, total.pixels);
        assert!(total.pixels > 50_000, "w up to 2^{octaves}: {total:?}");
        worst = worst.max(total.worst);
    }
    support::accuracy::check("coordinate in a texture of 256 texels, at each pixel", worst);
}

/// Sub-spans over the conformance data and random triangles with w as there. Slivers among them show hundreds of texels
/// in 16 pixels: nothing is off by more than 1/34 of its change from one divided column to the next.
#[test]
fn sub_spans_are_off_by_little_whatever_the_triangle_is() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/conformance/persp.csv");
    let text = std::fs::read_to_string(folder).expect("the data");
    let table = Table::parse(&text, (SIDE, SIDE));
    let data = table.records.iter().map(|record| {
        let [w, u, t] = record.triangle(7).expect("w, u and v");
        PerspectiveTriangle { v: record.triangle(1).expect("a triangle"), w, u, t }
    });
    let data: Vec<_> = data.collect();
    let mut rng = Rng::new(5);
    let random: Vec<_> = (0..100).map(|_| random(&mut rng, 4.0)).collect();
    for (name, triangles) in [("persp.csv", &data), ("random", &random)] {
        for (step, compare) in [
            (1, compare::<1> as fn(&PerspectiveTriangle, &mut Error)),
            (4, compare::<4>),
            (8, compare::<8>),
            (16, compare::<16>),
            (32, compare::<32>),
        ] {
            let mut total = Error::default();
            for triangle in triangles {
                compare(triangle, &mut total);
            }
            let mean = total.sum / total.pixels as f64;
            println!("{name}, every {step}: worst {:.4}, mean {mean:.5}", total.worst);
            assert!(total.pixels > 10_000, "{name}, every {step}: {total:?}");
            assert_eq!(total.beyond, 0.0, "{name}, every {step}: {total:?}");
        }
    }
}
