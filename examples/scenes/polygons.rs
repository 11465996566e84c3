//! Scenes of a few large polygons.

use zstrip::geometry::{Mesh, MeshData, Positions, Topology};
use zstrip::math::{Angle, Vec3};

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

/// The inside of a box, 4 × 2 × 4: corners 0 to 3 below, 4 to 7 above.
pub static ROOM: Mesh<'static> = colored(
    &[
        at(-2000, -1000, -2000),
        at(2000, -1000, -2000),
        at(2000, -1000, 2000),
        at(-2000, -1000, 2000),
        at(-2000, 1000, -2000),
        at(2000, 1000, -2000),
        at(2000, 1000, 2000),
        at(-2000, 1000, 2000),
    ],
    &[0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7],
    &[
        [200, 60, 60],
        [60, 160, 60],
        [70, 70, 200],
        [180, 170, 60],
        [230, 150, 140],
        [150, 220, 150],
        [150, 160, 240],
        [240, 235, 190],
    ],
    Topology::Quads,
);

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

const CYCLE_POSITIONS: [Vec3; 12] = planks();
const CYCLE_COLORS: [Rgb; 12] = {
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
        let turn = Angle::from_degrees(120 * (k as i32 / 4));
        let (s, c) = (turn.sin().to_bits() as i64, turn.cos().to_bits() as i64);
        // A plank at y = -0.5 from x = -1.3 to 1.3, its right end nearer.
        let (x, y, z) = match k % 4 {
            0 => (-1300, -650, -300),
            1 => (1300, -650, 300),
            2 => (1300, -350, 300),
            _ => (-1300, -350, -300),
        };
        points[k] = at(((x * c - y * s) >> 16) as i32, ((x * s + y * c) >> 16) as i32, z as i32);
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
        points[k] = at(
            x0 + 130 * i + 37 * (j % 3),
            y0 + 110 * j + 29 * (i % 4),
            40 * ((i + j) % 5),
        );
        k += 1;
    }
    points
}

const fn speckled<const N: usize>() -> [Rgb; N] {
    let mut colors = [[0; 3]; N];
    let mut k = 0;
    while k < N {
        colors[k] = [
            (60 + 47 * k % 190) as u8,
            (70 + 83 * k % 180) as u8,
            (80 + 131 * k % 170) as u8,
        ];
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
pub static GRID: Mesh<'static> = colored(
    &grid_positions(-1500, 100),
    &grid_indices(),
    &speckled::<{ SIDE * SIDE }>(),
    Topology::Triangles,
);

const STRIP_LENGTH: usize = 24;

const fn strip_positions() -> [Vec3; STRIP_LENGTH] {
    let mut points = [Vec3::ZERO; STRIP_LENGTH];
    let mut k = 0;
    while k < STRIP_LENGTH {
        let angle = Angle((k as u16 / 2) * 5461);
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
        let angle = Angle(((k - 1) * 4096) as u16);
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
