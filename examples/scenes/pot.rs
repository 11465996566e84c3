//! A pot with a lid, a spout and a handle: surfaces of revolution and tubes along Bézier curves, with smooth normals.

use zstrip::math::{Angle16, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};

/// A point or a vector of a plane, 16.16.
type Flat = [i64; 2];

/// A cubic curve by its control points, in thousandths.
type Curve = [Flat; 4];

/// Radius and height, from the knob of the lid down to the middle of the base.
const PROFILE: [Curve; 6] = [
    [[0, 1330], [190, 1330], [10, 1150], [100, 1080]],
    [[100, 1080], [180, 1010], [660, 1020], [690, 890]],
    [[690, 890], [690, 970], [790, 970], [800, 880]],
    [[800, 880], [930, 620], [1050, 350], [1050, 80]],
    [[1050, 80], [1050, -250], [800, -440], [720, -490]],
    [[720, -490], [700, -540], [400, -540], [0, -540]],
];
const SPOUT: Curve = [[620, -160], [1480, -60], [1230, 560], [1720, 840]];
const HANDLE: Curve = [[-930, 580], [-1900, 800], [-1800, -380], [-920, -220]];

/// Rings a curve of the profile, and vertices a ring, of each part.
const RINGS: usize = 5;
const AROUND: usize = 24;
const SPOUT_RINGS: usize = 9;
const SPOUT_AROUND: usize = 12;
const HANDLE_RINGS: usize = 13;
const HANDLE_AROUND: usize = 10;

const BODY_VERTICES: usize = PROFILE.len() * RINGS * AROUND;
const SPOUT_VERTICES: usize = SPOUT_RINGS * SPOUT_AROUND;
const VERTICES: usize = BODY_VERTICES + SPOUT_VERTICES + HANDLE_RINGS * HANDLE_AROUND;
const QUADS: usize =
    PROFILE.len() * (RINGS - 1) * AROUND + (SPOUT_RINGS - 1) * SPOUT_AROUND + (HANDLE_RINGS - 1) * HANDLE_AROUND;

/// Half of the size that 16 bits stand for, 16.16.
const SCALE: i32 = 2 << 16;

/// Height of the table under the pot.
pub const TABLE: i32 = -540;

/// Point and unit tangent of a curve at `k` of `n`.
const fn curve(c: &Curve, k: usize, n: usize) -> (Flat, Flat) {
    let (t, s) = (((k << 16) / n) as i64, (((n - k) << 16) / n) as i64);
    let (mut point, mut tangent) = ([0; 2], [0; 2]);
    let mut axis = 0;
    while axis < 2 {
        let p = [c[0][axis], c[1][axis], c[2][axis], c[3][axis]];
        let cubic = s * s / 65_536 * s / 65_536 * p[0]
            + 3 * (s * s / 65_536 * t / 65_536) * p[1]
            + 3 * (s * t / 65_536 * t / 65_536) * p[2]
            + t * t / 65_536 * t / 65_536 * p[3];
        point[axis] = cubic / 1000;
        let slope =
            s * s / 65_536 * (p[1] - p[0]) + 2 * (s * t / 65_536) * (p[2] - p[1]) + t * t / 65_536 * (p[3] - p[2]);
        tangent[axis] = slope / 1000;
        axis += 1;
    }
    match Vec3::from_bits([tangent[0] as i32, tangent[1] as i32, 0]).normalized() {
        Some(unit) => (point, [unit.to_bits()[0] as i64, unit.to_bits()[1] as i64]),
        None => (point, [0; 2]),
    }
}

/// Sine and cosine of step `k` of `n`, 16.16.
const fn circle(k: usize, n: usize) -> (i64, i64) {
    let angle = Angle16((k * 65_536 / n) as u16);
    (angle.sin().to_bits() as i64, angle.cos().to_bits() as i64)
}

struct Vertices {
    positions: [[i16; 3]; VERTICES],
    normals: [[i16; 3]; VERTICES],
}

impl Vertices {
    /// Position and normal, 16.16.
    const fn set(&mut self, k: usize, p: [i64; 3], n: [i64; 3]) {
        let mut axis = 0;
        while axis < 3 {
            self.positions[k][axis] = (p[axis] / 4) as i16;
            self.normals[k][axis] = (n[axis] / 4) as i16;
            axis += 1;
        }
    }

    /// A ring about a curve in the plane of x and y.
    const fn tube(&mut self, first: usize, c: &Curve, at: (usize, usize), around: usize, radius: i64) {
        let (p, t) = curve(c, at.0, at.1);
        let mut k = 0;
        while k < around {
            let (sine, cosine) = circle(k, around);
            let n = [-t[1] * cosine / 65_536, t[0] * cosine / 65_536, sine];
            let place = [p[0] + n[0] * radius / 65_536, p[1] + n[1] * radius / 65_536, n[2] * radius / 65_536];
            self.set(first + k, place, n);
            k += 1;
        }
    }
}

const fn vertices() -> Vertices {
    let mut v = Vertices { positions: [[0; 3]; VERTICES], normals: [[0; 3]; VERTICES] };
    let mut k = 0;
    while k < BODY_VERTICES {
        let (ring, step) = (k / AROUND, k % AROUND);
        let ([r, y], [tr, ty]) = curve(&PROFILE[ring / RINGS], ring % RINGS, RINGS - 1);
        let (sine, cosine) = circle(step, AROUND);
        let normal = [-ty * cosine / 65_536, tr, -ty * sine / 65_536];
        v.set(k, [r * cosine / 65_536, y, r * sine / 65_536], normal);
        k += 1;
    }
    let mut ring = 0;
    while ring < SPOUT_RINGS {
        // From 0.30 to 0.13.
        let radius = 19_660 - (ring * 11_140 / (SPOUT_RINGS - 1)) as i64;
        v.tube(BODY_VERTICES + ring * SPOUT_AROUND, &SPOUT, (ring, SPOUT_RINGS - 1), SPOUT_AROUND, radius);
        ring += 1;
    }
    let first = BODY_VERTICES + SPOUT_VERTICES;
    let mut ring = 0;
    while ring < HANDLE_RINGS {
        v.tube(first + ring * HANDLE_AROUND, &HANDLE, (ring, HANDLE_RINGS - 1), HANDLE_AROUND, 6_200);
        ring += 1;
    }
    v
}

/// Quads between the rings `first` and following, and where the next ones go.
const fn rings(indices: &mut [u16; 4 * QUADS], mut at: usize, first: usize, rings: usize, around: usize) -> usize {
    let mut quad = 0;
    while quad < (rings - 1) * around {
        let (ring, step) = (first + quad / around * around, quad % around);
        let next = (step + 1) % around;
        let corners = [ring + step, ring + next, ring + around + next, ring + around + step];
        let mut k = 0;
        while k < 4 {
            indices[at] = corners[k] as u16;
            at += 1;
            k += 1;
        }
        quad += 1;
    }
    at
}

const fn indices() -> [u16; 4 * QUADS] {
    let mut indices = [0; 4 * QUADS];
    let (mut at, mut part) = (0, 0);
    while part < PROFILE.len() {
        at = rings(&mut indices, at, part * RINGS * AROUND, RINGS, AROUND);
        part += 1;
    }
    at = rings(&mut indices, at, BODY_VERTICES, SPOUT_RINGS, SPOUT_AROUND);
    rings(&mut indices, at, BODY_VERTICES + SPOUT_VERTICES, HANDLE_RINGS, HANDLE_AROUND);
    indices
}

/// The pot, its axis along y; 1.05 is its largest radius.
pub fn mesh() -> &'static Mesh<'static> {
    const {
        let all: &'static Vertices = const { &vertices() };
        &Mesh::constant(MeshData {
            topology: Topology::Quads,
            indices: Some(const { &indices() }),
            normals: Some(&all.normals),
            ..MeshData::new(Positions::Quantized {
                points: &all.positions,
                scale: Scalar::from_bits(SCALE),
                offset: Vec3::ZERO,
            })
        })
    }
}
