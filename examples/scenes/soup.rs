//! Random triangles, from fixed seeds.

use zstrip::math::{Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions};

/// A linear congruential generator that the compiler can run.
#[derive(Clone, Copy)]
struct Random(u32);

impl Random {
    /// The next state, and a number in `low..high`.
    const fn next(self, low: i32, high: i32) -> (Self, i32) {
        let state = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let span = (high - low) as u64;
        (Self(state), low + (((state >> 8) as u64 * span) >> 24) as i32)
    }

    const fn vector(self, low: [i32; 3], high: [i32; 3]) -> (Self, [i32; 3]) {
        let (random, x) = self.next(low[0], high[0]);
        let (random, y) = random.next(low[1], high[1]);
        let (random, z) = random.next(low[2], high[2]);
        (random, [x, y, z])
    }
}

const fn colors<const N: usize>(seed: u32) -> [[u8; 3]; N] {
    let mut colors = [[0; 3]; N];
    let mut random = Random(seed);
    let mut k = 0;
    while k < N {
        let (next, rgb) = random.vector([40; 3], [256; 3]);
        colors[k] = [rgb[0] as u8, rgb[1] as u8, rgb[2] as u8];
        random = next;
        k += 1;
    }
    colors
}

/// Triangles about random centres in a box, with corners up to `size` away; thousandths.
const fn around<const N: usize>(seed: u32, low: [i32; 3], high: [i32; 3], sizes: [i32; 2]) -> [Vec3; N] {
    let mut points = [Vec3::ZERO; N];
    let mut random = Random(seed);
    let mut k = 0;
    while k + 2 < N {
        let (next, centre) = random.vector(low, high);
        let (next, size) = next.next(sizes[0], sizes[1]);
        random = next;
        let mut corner = 0;
        while corner < 3 {
            let (next, d) = random.vector([-size; 3], [size; 3]);
            random = next;
            points[k + corner] = Vec3::from_milli(centre[0] + d[0], centre[1] + d[1], centre[2] + d[2]);
            corner += 1;
        }
        k += 3;
    }
    points
}

const fn list(positions: &'static [Vec3], colors: &'static [[u8; 3]]) -> Mesh<'static> {
    Mesh::constant(MeshData { colors: Some(colors), ..MeshData::new(Positions::Exact(positions)) })
}

const SOUP_CORNERS: usize = 3 * 120;

/// Triangles of all sizes in a cube around the eye.
pub static SOUP: Mesh<'static> =
    list(&around::<SOUP_CORNERS>(1, [-5000; 3], [5000; 3], [100, 4000]), &colors::<SOUP_CORNERS>(2));

const FAR_CORNERS: usize = 3 * 40;

/// Triangles near a plane, corners up to 130 units away where 2.3 are seen: 13,000 px.
pub static FAR: Mesh<'static> = list(&flat_giants(), &colors::<FAR_CORNERS>(4));

const fn flat_giants() -> [Vec3; FAR_CORNERS] {
    let mut points = [Vec3::ZERO; FAR_CORNERS];
    let mut random = Random(3);
    let mut k = 0;
    while k < FAR_CORNERS {
        // One corner in three close by.
        let reach = if k % 3 == 0 { 2500 } else { 130_000 };
        let (next, p) = random.vector([-reach, -reach, -900], [reach, reach, 900]);
        random = next;
        points[k] = Vec3::from_milli(p[0], p[1], p[2]);
        k += 1;
    }
    points
}

const TINY_CORNERS: usize = 3 * 1500;

/// Triangles of about 2 px: 0.04 units at distance 4.
pub fn tiny() -> &'static Mesh<'static> {
    const {
        let corners = const { &around::<TINY_CORNERS>(5, [-2900, -2200, -1000], [2900, 2200, 1000], [10, 40]) };
        &list(corners, const { &colors::<TINY_CORNERS>(6) })
    }
}

const SLIVER_CORNERS: usize = 3 * 100;

const fn needles() -> [Vec3; SLIVER_CORNERS] {
    let mut points = [Vec3::ZERO; SLIVER_CORNERS];
    let mut random = Random(7);
    let mut k = 0;
    while k < SLIVER_CORNERS {
        let (next, a) = random.vector([-2200, -1600, -500], [2200, 1600, 500]);
        let (next, b) = next.vector([-2200, -1600, -500], [2200, 1600, 500]);
        let (next, d) = next.vector([-12; 3], [12; 3]);
        random = next;
        points[k] = Vec3::from_milli(a[0], a[1], a[2]);
        points[k + 1] = Vec3::from_milli(b[0], b[1], b[2]);
        points[k + 2] = Vec3::from_milli(b[0] + d[0], b[1] + d[1], b[2] + d[2]);
        k += 3;
    }
    points
}

/// Needles: a few thousandths thick.
pub static SLIVERS: Mesh<'static> = list(&needles(), &colors::<SLIVER_CORNERS>(8));

const NEAR_CORNERS: usize = 3 * 60;

/// Clip coordinates: w from -4 to 4, z = w - 1/4, x and y to ±6; every sixth vertex has w = 0 or is all zero.
const fn clip_space() -> [[Scalar; 4]; NEAR_CORNERS] {
    let mut points = [[Scalar::ZERO; 4]; NEAR_CORNERS];
    let mut random = Random(9);
    let mut k = 0;
    while k < NEAR_CORNERS {
        let (next, xy) = random.vector([-6 << 16, -6 << 16, 0], [6 << 16, 6 << 16, 1]);
        let (next, w) = next.next(-4 << 16, 4 << 16);
        random = next;
        let w = if k % 6 == 5 { 0 } else { w };
        if k % 12 != 11 {
            points[k] = [
                Scalar::from_bits(xy[0]),
                Scalar::from_bits(xy[1]),
                Scalar::from_bits(w - (1 << 14)),
                Scalar::from_bits(w),
            ];
        }
        k += 1;
    }
    points
}

/// Triangles that the near plane cuts, or that reach behind the eye.
pub static NEAR: Mesh<'static> = Mesh::constant(MeshData {
    colors: Some(&colors::<NEAR_CORNERS>(10)),
    ..MeshData::new(Positions::Homogeneous(&clip_space()))
});
