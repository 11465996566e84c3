//! Scenes of a few large polygons.

use zstrip::math::{Angle16, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};

type Rgb = [u8; 3];

const fn at(x: i32, y: i32, z: i32) -> Vec3 {
    Vec3::from_milli(x, y, z)
}

const fn colored(
    positions: &'static [Vec3],
    indices: &'static [u16],
    colors: &'static [Rgb],
    topology: Topology,
) -> Mesh<'static> {
    Mesh::constant(MeshData {
        topology,
        indices: Some(indices),
        colors: Some(colors),
        ..MeshData::new(Positions::Exact(positions))
    })
}

/// Walls and ceiling of a box seen from inside, 4 × 2 × 4, each in a colour of its own that is darker near the floor.
pub static ROOM: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    colors: Some(&wall_colors()),
    ..MeshData::new(Positions::Exact(&[
        // -z, +x, +z, -x: lower left, lower right, upper right, upper left, as seen from inside.
        at(-2000, -1000, -2000),
        at(2000, -1000, -2000),
        at(2000, 1000, -2000),
        at(-2000, 1000, -2000),
        at(2000, -1000, -2000),
        at(2000, -1000, 2000),
        at(2000, 1000, 2000),
        at(2000, 1000, -2000),
        at(2000, -1000, 2000),
        at(-2000, -1000, 2000),
        at(-2000, 1000, 2000),
        at(2000, 1000, 2000),
        at(-2000, -1000, 2000),
        at(-2000, -1000, -2000),
        at(-2000, 1000, -2000),
        at(-2000, 1000, 2000),
        // The ceiling.
        at(-2000, 1000, -2000),
        at(2000, 1000, -2000),
        at(2000, 1000, 2000),
        at(-2000, 1000, 2000),
    ]))
});

const fn wall_colors() -> [Rgb; 20] {
    let walls = [[196, 96, 80], [90, 120, 190], [180, 150, 80], [90, 160, 110], [225, 222, 210]];
    let mut colors = [[0; 3]; 20];
    let mut k = 0;
    while k < 20 {
        let [r, g, b] = walls[k / 4];
        // The two lower corners of a wall: five eighths as bright.
        let eighths = if k < 16 && k % 4 < 2 { 5 } else { 8 };
        colors[k] = [(r * eighths / 8) as u8, (g * eighths / 8) as u8, (b * eighths / 8) as u8];
        k += 1;
    }
    colors
}

const TILES: usize = 8;

const fn floor_positions() -> [Vec3; (TILES + 1) * (TILES + 1)] {
    let mut points = [Vec3::ZERO; (TILES + 1) * (TILES + 1)];
    let mut k = 0;
    while k < points.len() {
        let (i, j) = ((k % (TILES + 1)) as i32, (k / (TILES + 1)) as i32);
        points[k] = at(4000 * i / TILES as i32 - 2000, -1000, 4000 * j / TILES as i32 - 2000);
        k += 1;
    }
    points
}

/// The colour of a tile is that of its first corner, which no other tile begins with.
const fn floor_colors() -> [Rgb; (TILES + 1) * (TILES + 1)] {
    let mut colors = [[245, 238, 220]; (TILES + 1) * (TILES + 1)];
    let mut k = 0;
    while k < colors.len() {
        if (k % (TILES + 1) + k / (TILES + 1)) & 1 == 0 {
            colors[k] = [110, 84, 70];
        }
        k += 1;
    }
    colors
}

const fn floor_indices() -> [u16; 4 * TILES * TILES] {
    let mut indices = [0; 4 * TILES * TILES];
    let mut tile = 0;
    while tile < TILES * TILES {
        let first = tile % TILES + (TILES + 1) * (tile / TILES);
        let corners = [first, first + TILES + 1, first + TILES + 2, first + 1];
        let mut k = 0;
        while k < 4 {
            indices[4 * tile + k] = corners[k] as u16;
            k += 1;
        }
        tile += 1;
    }
    indices
}

/// The floor of the room: 8 × 8 tiles, to be drawn flat.
pub static FLOOR: Mesh<'static> = colored(&floor_positions(), &floor_indices(), &floor_colors(), Topology::Quads);

/// The outside of a column, 0.5 × 2 × 0.5.
pub static PILLAR: Mesh<'static> = colored(
    &[
        at(-250, -1000, -250),
        at(250, -1000, -250),
        at(250, -1000, 250),
        at(-250, -1000, 250),
        at(-250, 1000, -250),
        at(250, 1000, -250),
        at(250, 1000, 250),
        at(-250, 1000, 250),
    ],
    &[0, 4, 5, 1, 1, 5, 6, 2, 2, 6, 7, 3, 3, 7, 4, 0],
    &[[220, 220, 210]; 8],
    Topology::Quads,
);

/// Three squares, one in each coordinate plane.
pub static CROSSING: Mesh<'static> = colored(
    &[
        at(-1000, -1000, 0),
        at(1000, -1000, 0),
        at(1000, 1000, 0),
        at(-1000, 1000, 0),
        at(0, -1000, -1000),
        at(0, 1000, -1000),
        at(0, 1000, 1000),
        at(0, -1000, 1000),
        at(-1000, 0, -1000),
        at(-1000, 0, 1000),
        at(1000, 0, 1000),
        at(1000, 0, -1000),
    ],
    &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11],
    &[
        [230, 70, 60],
        [230, 70, 60],
        [230, 70, 60],
        [230, 70, 60],
        [70, 200, 80],
        [70, 200, 80],
        [70, 200, 80],
        [70, 200, 80],
        [80, 110, 240],
        [80, 110, 240],
        [80, 110, 240],
        [80, 110, 240],
    ],
    Topology::Quads,
);

/// Three planks along the sides of a triangle, each tilted so that one end is over its neighbour and one below.
pub static CYCLE: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    colors: Some(&CYCLE_COLORS),
    ..MeshData::new(Positions::Exact(&CYCLE_POSITIONS))
});

static CYCLE_POSITIONS: [Vec3; 12] = planks();
static CYCLE_COLORS: [Rgb; 12] = {
    let mut colors = [[0; 3]; 12];
    let mut k = 0;
    while k < 12 {
        let shade = 150 + 90 * (k as u8 & 1);
        colors[k] = match k / 4 {
            0 => [shade, 60, 40],
            1 => [50, shade, 60],
            _ => [60, 80, shade],
        };
        k += 1;
    }
    colors
};

const fn planks() -> [Vec3; 12] {
    let mut points = [Vec3::ZERO; 12];
    let mut k = 0;
    while k < 12 {
        let turn = Angle16::from_degrees(120 * (k as i32 / 4));
        let (s, c) = (turn.sin().to_bits() as i64, turn.cos().to_bits() as i64);
        // A plank at y = -0.5 from x = -1.3 to 1.3, its right end nearer.
        let (x, y, z) = match k % 4 {
            0 => (-1300, -650, -300),
            1 => (1300, -650, 300),
            2 => (1300, -350, 300),
            _ => (-1300, -350, -300),
        };
        points[k] = at(((x * c - y * s) >> 16) as i32, ((x * s + y * c) >> 16) as i32, z);
        k += 1;
    }
    points
}

const SIDE: usize = 9;

const fn grid_positions(x0: i32, y0: i32) -> [Vec3; SIDE * SIDE] {
    let mut points = [Vec3::ZERO; SIDE * SIDE];
    let mut k = 0;
    while k < SIDE * SIDE {
        let (i, j) = ((k % SIDE) as i32, (k / SIDE) as i32);
        // A little uneven, so that no edge is straight through.
        points[k] = at(x0 + 130 * i + 37 * (j % 3), y0 + 110 * j + 29 * (i % 4), 40 * ((i + j) % 5));
        k += 1;
    }
    points
}

const fn speckled<const N: usize>() -> [Rgb; N] {
    let mut colors = [[0; 3]; N];
    let mut k = 0;
    while k < N {
        colors[k] = [(60 + 47 * k % 190) as u8, (70 + 83 * k % 180) as u8, (80 + 131 * k % 170) as u8];
        k += 1;
    }
    colors
}

const fn grid_indices() -> [u16; 6 * (SIDE - 1) * (SIDE - 1)] {
    let mut indices = [0; 6 * (SIDE - 1) * (SIDE - 1)];
    let mut quad = 0;
    while quad < (SIDE - 1) * (SIDE - 1) {
        let a = quad % (SIDE - 1) + SIDE * (quad / (SIDE - 1));
        let corners = [a, a + 1, a + SIDE, a + 1, a + SIDE + 1, a + SIDE];
        let mut k = 0;
        while k < 6 {
            indices[6 * quad + k] = corners[k] as u16;
            k += 1;
        }
        quad += 1;
    }
    indices
}

/// An indexed list of triangles.
pub static GRID: Mesh<'static> =
    colored(&grid_positions(-1500, 100), &grid_indices(), &speckled::<{ SIDE * SIDE }>(), Topology::Triangles);

const STRIP_LENGTH: usize = 24;

const fn strip_positions() -> [Vec3; STRIP_LENGTH] {
    let mut points = [Vec3::ZERO; STRIP_LENGTH];
    let mut k = 0;
    while k < STRIP_LENGTH {
        let angle = Angle16((k as u16 / 2) * 5461);
        let radius = if k % 2 == 0 { 300 } else { 560 };
        let x = (angle.cos().to_bits() as i64 * radius) >> 16;
        let y = (angle.sin().to_bits() as i64 * radius) >> 16;
        points[k] = at(700 + x as i32, 600 + y as i32, 20 * k as i32);
        k += 1;
    }
    points
}

/// A strip, not indexed: a ring with a gap.
pub static STRIP: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Strip,
    colors: Some(&speckled::<STRIP_LENGTH>()),
    ..MeshData::new(Positions::Exact(&strip_positions()))
});

const FAN_LENGTH: usize = 18;

const fn fan_positions() -> [Vec3; FAN_LENGTH] {
    let mut points = [at(-900, -600, 200); FAN_LENGTH];
    let mut k = 1;
    while k < FAN_LENGTH {
        let angle = Angle16(((k - 1) * 4096) as u16);
        let radius = if k % 2 == 0 { 520 } else { 380 };
        let x = (angle.cos().to_bits() as i64 * radius) >> 16;
        let y = (angle.sin().to_bits() as i64 * radius) >> 16;
        points[k] = at(-900 + x as i32, -600 + y as i32, 0);
        k += 1;
    }
    points
}

/// A fan, not indexed: a star.
pub static FAN: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Fan,
    colors: Some(&speckled::<FAN_LENGTH>()),
    ..MeshData::new(Positions::Exact(&fan_positions()))
});

/// Quads, indexed.
pub static QUADS: Mesh<'static> = colored(
    &[
        at(300, -900, 0),
        at(700, -950, 100),
        at(1200, -850, 0),
        at(250, -500, 50),
        at(750, -450, 0),
        at(1250, -520, 90),
        at(350, -120, 0),
        at(720, -150, 120),
        at(1180, -80, 0),
    ],
    &[0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 7, 6, 4, 5, 8, 7],
    &speckled::<9>(),
    Topology::Quads,
);
