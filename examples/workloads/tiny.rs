//! Tiny right triangles with legs of 2 px on a jittered grid, at distances from 4 to 8.

use super::FOCAL;
use super::numbers::{quantities, quantized};
use zstrip::mesh::{Mesh, MeshData};

pub const TINY_TRIANGLES: usize = 10_000;
/// State of the random numbers before the first triangle.
pub const TINY_SEED: u32 = 12_345;

/// Returns a random number from 0 to 1 and the next state, by a linear congruential generator.
const fn random(state: u32) -> (f64, u32) {
    let state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    ((state >> 8) as f64 / 16_777_216.0, state)
}

/// Returns the corners and the colour of triangle `k`, and the generator's next state.
pub const fn tiny_triangle(k: usize, state: u32) -> ([[f64; 3]; 3], [u8; 3], u32) {
    let (right, state) = random(state);
    let (down, state) = random(state);
    let (away, state) = random(state);
    let (r, state) = random(state);
    let (g, state) = random(state);
    let (b, state) = random(state);
    let x = 0.02 + (k % 100) as f64 * 3.17 + right * 1.1;
    let y = 0.02 + (k / 100) as f64 * 2.37 + down * 0.3;
    let z = 4.0 + 4.0 * away;
    let screen = if k % 2 == 1 {
        [(x, y), (x, y + 2.0), (x + 2.0, y)]
    } else {
        [(x + 2.0, y), (x, y + 2.0), (x + 2.0, y + 2.0)]
    };
    let mut corners = [[0.0; 3]; 3];
    let mut c = 0;
    while c < 3 {
        let (sx, sy) = screen[c];
        corners[c] = [(sx - 160.0) * z / FOCAL, (120.0 - sy) * z / FOCAL, z];
        c += 1;
    }
    let color = [128 + (r * 127.0) as u8, 128 + (g * 127.0) as u8, 128 + (b * 127.0) as u8];
    (corners, color, state)
}

const TINY_MIDDLE: [f64; 3] = [0.0, 0.0, 6.0];
const TINY_HALF: f64 = 6.25;

type Tiny = ([[i16; 3]; 3 * TINY_TRIANGLES], [[u8; 3]; 3 * TINY_TRIANGLES]);

const fn tiny_corners() -> Tiny {
    let mut points = [[0; 3]; 3 * TINY_TRIANGLES];
    let mut colors = [[0; 3]; 3 * TINY_TRIANGLES];
    let mut state = TINY_SEED;
    let mut k = 0;
    while k < TINY_TRIANGLES {
        let (corners, color, next) = tiny_triangle(k, state);
        state = next;
        let mut c = 0;
        while c < 3 {
            points[3 * k + c] = quantized(corners[c], TINY_MIDDLE, TINY_HALF);
            colors[3 * k + c] = color;
            c += 1;
        }
        k += 1;
    }
    (points, colors)
}

/// Returns the mesh. The compiler computes it in programs that draw it only, because 30,000 vertices take a while.
pub fn tiny_mesh() -> &'static Mesh<'static> {
    const {
        let (points, colors) = const { &tiny_corners() };
        &Mesh::constant(MeshData { colors: Some(colors), ..MeshData::new(quantities(points, TINY_MIDDLE, TINY_HALF)) })
    }
}
