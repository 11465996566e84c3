//! The torus: axis y, radii 1 and 0.4, 32 x 16 quads, turned by RX and then RY, three units away.

use super::numbers::{cross, dot, minus, normal, normalized, quantities, quantized, sin_cos, vector};
use zstrip::math::Affine;
use zstrip::mesh::{Mesh, MeshData};

const AROUND: usize = 32;
const ACROSS: usize = 16;
const VERTICES: usize = AROUND * ACROSS;
pub const TRIANGLES: usize = 2 * VERTICES;

const RX: f64 = 0.7;
const RY: f64 = 0.5;
pub const DISTANCE: f64 = 3.0;

/// The rows of ry(0.5) · rx(0.7).
pub const ROTATION: [[f64; 3]; 3] = {
    let (sx, cx) = sin_cos(RX);
    let (sy, cy) = sin_cos(RY);
    [[cy, sy * sx, sy * cx], [0.0, cx, -sx], [-sy, cy * sx, cy * cx]]
};

/// Direction towards the light, in the workloads' view space.
pub const LIGHT: [f64; 3] = normalized([0.4, 0.7, -0.6]);
pub const AMBIENT: f64 = 0.15;
pub const DIFFUSE: f64 = 0.85;
pub const TORUS_COLOR: [u8; 3] = [255, 160, 64];

/// Object space → view space as the camera has it.
pub const MODEL: Affine = {
    let [x, y, [zx, zy, zz]] = ROTATION;
    Affine::from_rows(vector(x), vector(y), vector([-zx, -zy, -zz]), vector([0.0, 0.0, -DISTANCE]))
};

static TORUS_VERTICES: [[[f64; 3]; VERTICES]; 2] = torus();
static TORUS_FACES: ([u16; 3 * TRIANGLES], [[f64; 3]; TRIANGLES]) = torus_faces();
pub static TORUS_POSITIONS: &[[f64; 3]; VERTICES] = &TORUS_VERTICES[0];
pub static TORUS_NORMALS: &[[f64; 3]; VERTICES] = &TORUS_VERTICES[1];
pub static TORUS_INDICES: &[u16; 3 * TRIANGLES] = &TORUS_FACES.0;
/// Unit normals of the triangles, which point outwards.
pub static TORUS_FACE_NORMALS: &[[f64; 3]; TRIANGLES] = &TORUS_FACES.1;

/// Returns sine and cosine of each of `N` steps of a whole turn.
const fn circle<const N: usize>() -> [(f64, f64); N] {
    let mut circle = [(0.0, 0.0); N];
    let turn = 2.0 * core::f64::consts::PI;
    let mut k = 0;
    while k < N {
        circle[k] = sin_cos(turn * k as f64 / N as f64);
        k += 1;
    }
    circle
}

/// Returns positions and normals of the vertices.
const fn torus() -> [[[f64; 3]; VERTICES]; 2] {
    let mut positions = [[0.0; 3]; VERTICES];
    let mut normals = [[0.0; 3]; VERTICES];
    let (around, across) = (circle::<AROUND>(), circle::<ACROSS>());
    let mut k = 0;
    while k < VERTICES {
        let (su, cu) = around[k / ACROSS];
        let (sv, cv) = across[k % ACROSS];
        let ring = 1.0 + 0.4 * cv;
        positions[k] = [ring * cu, 0.4 * sv, ring * su];
        normals[k] = [cv * cu, sv, cv * su];
        k += 1;
    }
    [positions, normals]
}

/// Returns indices and face normals. The cross product of a front face's edges points inwards, as space is left-handed.
const fn torus_faces() -> ([u16; 3 * TRIANGLES], [[f64; 3]; TRIANGLES]) {
    let mut indices = [0; 3 * TRIANGLES];
    let mut normals = [[0.0; 3]; TRIANGLES];
    let mut triangle = 0;
    while triangle < TRIANGLES {
        let (i, j) = (triangle / 2 / ACROSS, triangle / 2 % ACROSS);
        let (i1, j1) = ((i + 1) % AROUND, (j + 1) % ACROSS);
        let a = i * ACROSS + j;
        let c = i1 * ACROSS + j1;
        let corners = if triangle % 2 == 0 { [a, i1 * ACROSS + j, c] } else { [a, c, i * ACROSS + j1] };
        let p = [TORUS_POSITIONS[corners[0]], TORUS_POSITIONS[corners[1]], TORUS_POSITIONS[corners[2]]];
        let n = normalized(cross(minus(p[1], p[0]), minus(p[2], p[0])));
        let inwards =
            dot(n, TORUS_NORMALS[corners[0]]) + dot(n, TORUS_NORMALS[corners[1]]) + dot(n, TORUS_NORMALS[corners[2]])
                <= 0.0;
        let (second, third) = if inwards { (1, 2) } else { (2, 1) };
        indices[3 * triangle] = corners[0] as u16;
        indices[3 * triangle + 1] = corners[second] as u16;
        indices[3 * triangle + 2] = corners[third] as u16;
        normals[triangle] = if inwards { [-n[0], -n[1], -n[2]] } else { n };
        triangle += 1;
    }
    (indices, normals)
}

const TORUS_HALF: f64 = 1.40625;

static TORUS_POINTS: [[i16; 3]; VERTICES] = {
    let mut points = [[0; 3]; VERTICES];
    let mut k = 0;
    while k < VERTICES {
        points[k] = quantized(TORUS_POSITIONS[k], [0.0; 3], TORUS_HALF);
        k += 1;
    }
    points
};

const fn to_normals<const N: usize>(normals: &[[f64; 3]; N]) -> [[i16; 3]; N] {
    let mut short = [[0; 3]; N];
    let mut k = 0;
    while k < N {
        short[k] = normal(normals[k]);
        k += 1;
    }
    short
}

pub static TORUS: Mesh<'static> = Mesh::constant(MeshData {
    indices: Some(TORUS_INDICES),
    normals: Some(&to_normals(TORUS_NORMALS)),
    face_normals: Some(&to_normals(TORUS_FACE_NORMALS)),
    ..MeshData::new(quantities(&TORUS_POINTS, [0.0; 3], TORUS_HALF))
});
