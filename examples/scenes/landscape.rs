//! A computed landscape: a height field with colours, a lake, and pines.

use zstrip::math::{Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};

/// Cells a side, and half of the side's length.
const CELLS: usize = 56;
const ROW: usize = CELLS + 1;
const VERTICES: usize = ROW * ROW;
const HALF: i32 = 14;

/// A number from 0 to 65,535 for a point of a lattice.
const fn lattice(x: i32, z: i32) -> i64 {
    const LOW: u64 = 0xFFFF_FFFF;
    let mut hash = ((x as u32 as u64 * 0x9E37_79B1) ^ (z as u32 as u64 * 0x85EB_CA77)) & LOW;
    hash = ((hash ^ (hash >> 15)) * 0x2C1B_3C6D) & LOW;
    hash = ((hash ^ (hash >> 12)) * 0x297A_2D39) & LOW;
    (hash >> 16) as i64
}

/// Smooth noise over lattice cells of `size` / 1000, 0 to 65,535.
const fn noise(x: i32, z: i32, size: i32) -> i64 {
    // Rounded down: what is divided is positive.
    let below = 128;
    let (i, j) = ((x + below * size) / size - below, (z + below * size) / size - below);
    let (s, t) = (smooth(x - i * size, size), smooth(z - j * size, size));
    let upper = lattice(i, j) * (65_536 - s) + lattice(i + 1, j) * s;
    let lower = lattice(i, j + 1) * (65_536 - s) + lattice(i + 1, j + 1) * s;
    (upper / 65_536 * (65_536 - t) + lower / 65_536 * t) / 65_536
}

/// 3 t² - 2 t³ for t = x / size, 0.16.
const fn smooth(x: i32, size: i32) -> i64 {
    let t = x as i64 * 65_536 / size as i64;
    t * t / 65_536 * (3 * 65_536 - 2 * t) / 65_536
}

/// Height over a point, all in thousandths; the lake is at 0.
pub const fn height(x: i32, z: i32) -> i32 {
    let hills = noise(x, z, 4300) * 3000 + noise(x + 9000, z, 1900) * 1350 + noise(x, z + 5000, 800) * 420;
    let height = (hills / 65_536) as i32 - 1900;
    // The shores are flat.
    if height < 0 { height / 2 } else { height + height * height / 4000 }
}

/// Coordinates of a vertex, in thousandths.
const fn place(k: usize) -> (i32, i32) {
    let (i, j) = ((k % ROW) as i32, (k / ROW) as i32);
    (i * 2000 * HALF / CELLS as i32 - 1000 * HALF, j * 2000 * HALF / CELLS as i32 - 1000 * HALF)
}

struct Ground {
    positions: [[i16; 3]; VERTICES],
    normals: [[i16; 3]; VERTICES],
    colors: [[u8; 3]; VERTICES],
}

/// Heights of all vertices.
const fn heights() -> [i32; VERTICES] {
    let mut heights = [0; VERTICES];
    let mut k = 0;
    while k < VERTICES {
        let (x, z) = place(k);
        heights[k] = height(x, z);
        k += 1;
    }
    heights
}

/// The height of a vertex, or of the nearest one where the row or column is out of the ground.
const fn vertex_height(heights: &[i32; VERTICES], column: i32, row: i32) -> i32 {
    let last = CELLS as i32;
    let column = if column < 0 { 0 } else { column.saturating_sub((column > last) as i32) };
    let row = if row < 0 { 0 } else { row.saturating_sub((row > last) as i32) };
    heights[row as usize * ROW + column as usize]
}

const fn vertices() -> Ground {
    let heights = heights();
    let mut g = Ground { positions: [[0; 3]; VERTICES], normals: [[0; 3]; VERTICES], colors: [[0; 3]; VERTICES] };
    let mut k = 0;
    while k < VERTICES {
        let (x, z) = place(k);
        let (column, row) = ((k % ROW) as i32, (k / ROW) as i32);
        let y = heights[k];
        // 16 units are 2¹⁵.
        g.positions[k] = [(x * 2048 / 1000) as i16, (y * 2048 / 1000) as i16, (z * 2048 / 1000) as i16];
        // Over two cells of 500.
        let slope = [
            vertex_height(&heights, column - 1, row) - vertex_height(&heights, column + 1, row),
            vertex_height(&heights, column, row - 1) - vertex_height(&heights, column, row + 1),
        ];
        if let Some(n) = Vec3::from_bits([slope[0] << 8, 1000 << 8, slope[1] << 8]).normalized() {
            let n = n.to_bits();
            g.normals[k] = [(n[0] >> 2) as i16, (n[1] >> 2) as i16, (n[2] >> 2) as i16];
        }
        let grain = (noise(x + 3000, z, 400) / 1600) as i32;
        g.colors[k] = color(y, g.normals[k][1] as i32, grain);
        k += 1;
    }
    g
}

/// Colour at a height: sand, grass, rock where it is steep, snow; `grain` from 0 to 40.
const fn color(y: i32, up: i32, grain: i32) -> [u8; 3] {
    let [r, g, b] = if y < 60 {
        [180, 160, 115]
    } else if up < 11_000 {
        [128, 112, 98]
    } else if y > 1900 {
        [225, 228, 232]
    } else if y > 1200 {
        [128, 132, 84]
    } else {
        [78, 122, 58]
    };
    [(r + grain / 2) as u8, (g + grain / 2) as u8, (b + grain / 3) as u8]
}

const fn indices() -> [u16; 4 * CELLS * CELLS] {
    let mut indices = [0; 4 * CELLS * CELLS];
    let mut k = 0;
    while k < CELLS * CELLS {
        let first = k / CELLS * ROW + k % CELLS;
        indices[4 * k] = first as u16;
        indices[4 * k + 1] = (first + ROW) as u16;
        indices[4 * k + 2] = (first + ROW + 1) as u16;
        indices[4 * k + 3] = (first + 1) as u16;
        k += 1;
    }
    indices
}

/// The ground.
pub fn ground() -> &'static Mesh<'static> {
    const {
        let all: &'static Ground = const { &vertices() };
        &Mesh::constant(MeshData {
            topology: Topology::Quads,
            indices: Some(const { &indices() }),
            normals: Some(&all.normals),
            colors: Some(&all.colors),
            ..MeshData::new(Positions::Quantized {
                points: &all.positions,
                scale: Scalar::from_bits(16 << 16),
                offset: Vec3::ZERO,
            })
        })
    }
}

/// The water.
pub static LAKE: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    ..MeshData::new(Positions::Exact(&[
        Vec3::from_ints(-HALF as i16, 0, -HALF as i16),
        Vec3::from_ints(-HALF as i16, 0, HALF as i16),
        Vec3::from_ints(HALF as i16, 0, HALF as i16),
        Vec3::from_ints(HALF as i16, 0, -HALF as i16),
    ]))
});

const PINES: usize = 56;

/// Returns the places of the pines: on grass.
pub fn trees() -> &'static [Vec3; PINES] {
    const { &places() }
}

const fn places() -> [Vec3; PINES] {
    let mut trees = [Vec3::ZERO; PINES];
    let (mut tried, mut k) = (0, 0);
    while k < PINES && tried < 1000 {
        let x = (lattice(tried, 11) as i32 - 32_768) * 11 / 32;
        let z = (lattice(tried, 77) as i32 - 32_768) * 11 / 32;
        let y = if noise(x, z, 1700) > 30_000 { height(x, z) } else { 0 };
        if y > 120 && y < 1000 {
            let slope = height(x + 100, z) - height(x - 100, z) + height(x, z + 100) - height(x, z - 100);
            if slope.abs() < 160 {
                trees[k] = Vec3::from_milli(x, y - 30, z);
                k += 1;
            }
        }
        tried += 1;
    }
    trees
}

/// Sides of a pine's cones.
const SIDES: usize = 6;

const fn pine() -> [Vec3; 9 * SIDES] {
    let mut corners = [Vec3::ZERO; 9 * SIDES];
    // Sine and cosine of sixths of a turn, in thousandths.
    let circle = [(0, 1000), (866, 500), (866, -500), (0, -1000), (-866, -500), (-866, 500)];
    let mut k = 0;
    while k < 3 * SIDES {
        let (tier, side) = ((k / SIDES) as i32, k % SIDES);
        let (low, radius) = (60 + 150 * tier, 150 - 35 * tier);
        let ((s, c), (t, d)) = (circle[side], circle[(side + 1) % SIDES]);
        corners[3 * k] = Vec3::from_milli(0, low + 260, 0);
        corners[3 * k + 1] = Vec3::from_milli(radius * s / 1000, low, radius * c / 1000);
        corners[3 * k + 2] = Vec3::from_milli(radius * t / 1000, low, radius * d / 1000);
        k += 1;
    }
    corners
}

static PINE_CORNERS: [Vec3; 9 * SIDES] = pine();

pub static PINE: Mesh<'static> = Mesh::constant(MeshData {
    colors: Some(&[[52, 88, 54]; 9 * SIDES]),
    ..MeshData::new(Positions::Exact(&PINE_CORNERS))
});
