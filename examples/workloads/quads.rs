//! Quads: one from edge to edge of the screen, and one that is tilted, with its texture.

use super::FOCAL;
use super::numbers::{quantities, quantized, root};
use zstrip::math::Scalar;
use zstrip::mesh::{Mesh, MeshData};
use zstrip::texture::Tile;

// The quad, at z = 2, from edge to edge of the screen: top left, top right, bottom left, bottom right.

const QUAD_X: f64 = 160.0 / FOCAL * 2.0;
const QUAD_Y: f64 = 120.0 / FOCAL * 2.0;
pub const QUAD_POSITIONS: [[f64; 3]; 4] =
    [[-QUAD_X, QUAD_Y, 2.0], [QUAD_X, QUAD_Y, 2.0], [-QUAD_X, -QUAD_Y, 2.0], [QUAD_X, -QUAD_Y, 2.0]];
pub const QUAD_INDICES: [u16; 6] = [0, 2, 1, 1, 2, 3];
pub const QUAD_COLORS: [[u8; 3]; 4] = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]];
/// Orange, for the quad in one colour.
pub const QUAD_COLOR: [u8; 3] = [255, 165, 0];

const QUAD_POINTS: [[i16; 3]; 4] = {
    let mut points = [[0; 3]; 4];
    let mut k = 0;
    while k < 4 {
        points[k] = quantized(QUAD_POSITIONS[k], [0.0, 0.0, 2.0], 2.0);
        k += 1;
    }
    points
};

pub static QUAD: Mesh<'static> = Mesh::constant(MeshData {
    indices: Some(&QUAD_INDICES),
    colors: Some(&QUAD_COLORS),
    ..MeshData::new(quantities(&QUAD_POINTS, [0.0, 0.0, 2.0], 2.0))
});

// The tilted quad, of 2 x 3, its top turned away by 60°: top left, top right, bottom left, bottom right.

const TILTED_MIDDLE: [f64; 3] = [0.0, 0.0, 2.615];
pub const TILTED_POSITIONS: [[f64; 3]; 4] = {
    let (y, z) = (1.5 * 0.5, 1.5 * root(3.0) / 2.0);
    let [_, _, middle] = TILTED_MIDDLE;
    [[-1.0, y, middle + z], [1.0, y, middle + z], [-1.0, -y, middle - z], [1.0, -y, middle - z]]
};
pub const TILTED_UVS: [[i32; 2]; 4] = [[0, 0], [1, 0], [0, 1], [1, 1]];

const TILTED_POINTS: [[i16; 3]; 4] = {
    let mut points = [[0; 3]; 4];
    let mut k = 0;
    while k < 4 {
        points[k] = quantized(TILTED_POSITIONS[k], TILTED_MIDDLE, 2.0);
        k += 1;
    }
    points
};

const TILTED_COORDINATES: [[Scalar; 2]; 4] = {
    let mut coordinates = [[Scalar::ZERO; 2]; 4];
    let mut k = 0;
    while k < 4 {
        let [u, v] = TILTED_UVS[k];
        coordinates[k] = [Scalar::from_bits(u << 16), Scalar::from_bits(v << 16)];
        k += 1;
    }
    coordinates
};

pub static TILTED: Mesh<'static> = Mesh::constant(MeshData {
    indices: Some(&QUAD_INDICES),
    uvs: Some(&TILTED_COORDINATES),
    ..MeshData::new(quantities(&TILTED_POINTS, TILTED_MIDDLE, 2.0))
});

/// Number of texels along each side of the texture.
pub const TEXELS: usize = 64;

/// A chequered gradient with marks in two corners.
pub static TEXELS_565: [[u16; TEXELS]; TEXELS] = {
    let mut texels = [[0; TEXELS]; TEXELS];
    let mut k = 0;
    while k < TEXELS * TEXELS {
        let (u, v) = (k % TEXELS, k / TEXELS);
        let blue = if (u / 8 + v / 8) % 2 == 1 { 255 } else { 40 };
        let [r, g, b] = match (u / 8, v / 8) {
            (0, 0) => [255, 0, 0],
            (7, 0) => [0, 255, 0],
            _ => [64 + 3 * u, 64 + 3 * v, blue],
        };
        texels[v][u] = ((r >> 3) << 11 | (g >> 2) << 5 | b >> 3) as u16;
        k += 1;
    }
    texels
};

pub static TEXTURE: Tile<'static, TEXELS, TEXELS> = Tile::new(&TEXELS_565);
