//! A tiled floor: 16 × 16 tiles of half a unit, whose first corners have their colours.

use zstrip::light::NORMAL_ONE;
use zstrip::math::{Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};

const TILES: usize = 16;
const ROW: usize = TILES + 1;
const VERTICES: usize = ROW * ROW;

const fn positions() -> [[i16; 3]; VERTICES] {
    let mut points = [[0; 3]; VERTICES];
    let mut k = 0;
    while k < VERTICES {
        let (x, z) = ((k % ROW) as i32 - 8, (k / ROW) as i32 - 8);
        points[k] = [(x * 4095) as i16, 0, (z * 4095) as i16];
        k += 1;
    }
    points
}

const fn colors() -> [[u8; 3]; VERTICES] {
    let mut colors = [[0; 3]; VERTICES];
    let mut k = 0;
    while k < VERTICES {
        colors[k] = if (k % ROW + k / ROW) & 1 == 0 { [235, 225, 205] } else { [105, 85, 80] };
        k += 1;
    }
    colors
}

const fn indices() -> [u16; 4 * TILES * TILES] {
    let mut indices = [0; 4 * TILES * TILES];
    let mut k = 0;
    while k < TILES * TILES {
        let first = k / TILES * ROW + k % TILES;
        indices[4 * k] = first as u16;
        indices[4 * k + 1] = (first + ROW) as u16;
        indices[4 * k + 2] = (first + ROW + 1) as u16;
        indices[4 * k + 3] = (first + 1) as u16;
        k += 1;
    }
    indices
}

static POSITIONS: [[i16; 3]; VERTICES] = positions();
static NORMALS: [[i16; 3]; VERTICES] = [[0, NORMAL_ONE, 0]; VERTICES];
static COLORS: [[u8; 3]; VERTICES] = colors();
static INDICES: [u16; 4 * TILES * TILES] = indices();

pub static MESH: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    indices: Some(&INDICES),
    normals: Some(&NORMALS),
    colors: Some(&COLORS),
    ..MeshData::new(Positions::Quantized { points: &POSITIONS, scale: Scalar::from_bits(4 << 16), offset: Vec3::ZERO })
});
