//! Perspective-correct varyings against exact rationals: at each pixel, and every 4 to 32 of them.

mod reference;
mod support;

use reference::conformance::PerspectiveTriangle;
use reference::conformance::records::Table;
use reference::exact;
use reference::rng::Rng;
use reference::subject::Subject;

const SIDE: u32 = 128;

/// The largest and the mean error over the pixels of a triangle, and how many there are.
#[derive(Clone, Copy, Debug, Default)]
struct Error {
    worst: f64,
    sum: f64,
    pixels: usize,
}

impl Error {
    fn add(&mut self, error: f64) {
        self.worst = self.worst.max(error);
        self.sum += error;
        self.pixels += 1;
    }
}

/// Compares every pixel with the exact value.
fn compare<const STEP: usize>(triangle: &PerspectiveTriangle, total: &mut Error) {
    let tri = exact::widen(triangle.v);
    let got = Subject::default().coordinates::<STEP>((SIDE, SIDE), triangle);
    let width = SIDE as usize;
    for (index, values) in got.iter().enumerate() {
        let (x, y) = (index % width, index / width);
        assert_eq!(values.is_some(), exact::covers(tri, x as i64, y as i64), "({x}, {y}) of {triangle:?}");
        let Some(values) = values else { continue };
        for (value, at_vertices) in values.iter().zip([triangle.u, triangle.t]) {
            let w = triangle.w.map(i64::from);
            let at = exact::center(x as i64, y as i64);
            let (num, den) = exact::perspective_at(tri, w, at_vertices.map(i64::from), at);
            total.add((value - num as f64 / den as f64).abs());
        }
    }
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
        for (step, compare, worst) in [
            (1, compare::<1> as fn(&PerspectiveTriangle, &mut Error), 1.0 / 16.0),
            (4, compare::<4>, 2.0),
            (8, compare::<8>, 2.0),
            (16, compare::<16>, 16.0),
            (32, compare::<32>, 48.0),
        ] {
            let mut total = Error::default();
            for triangle in triangles {
                compare(triangle, &mut total);
            }
            let mean = total.sum / total.pixels as f64;
            println!("{name}, every {step}: worst {:.4}, mean {mean:.5}", total.worst);
            assert!(total.worst <= worst, "{name}, every {step}: {total:?}");
        }
    }
}
