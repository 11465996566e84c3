//! A torus: radii 1 and 0.4, 32 × 16 quads, axis y.

use zstrip::math::{Angle16, Scalar, Vec3};
use zstrip::mesh::{Lines, Mesh, MeshData, Positions, Topology, edges};

const AROUND: usize = 32;
const ACROSS: usize = 16;
const VERTICES: usize = AROUND * ACROSS;
const TRIANGLES: usize = 2 * VERTICES;

/// The coordinate of 32,768 in the positions: 1.4 in 16.16.
const SCALE: i64 = 91_750;

/// Sine and cosine of step `k` of `n`, 16.16.
const fn unit(k: usize, n: usize) -> (i64, i64) {
    let angle = Angle16((k * 65_536 / n) as u16);
    (angle.sin().to_bits() as i64, angle.cos().to_bits() as i64)
}

const fn positions() -> [[i16; 3]; VERTICES] {
    let mut points = [[0; 3]; VERTICES];
    let mut k = 0;
    while k < VERTICES {
        let (su, cu) = unit(k / ACROSS, AROUND);
        let (sv, cv) = unit(k % ACROSS, ACROSS);
        // Distance from the axis in 16.32.
        let ring = (1 << 32) + 26_214 * cv;
        points[k] = [fraction(ring / 65_536 * cu), fraction(26_214 * sv), fraction(ring / 65_536 * su)];
        k += 1;
    }
    points
}

/// A 16.32 coordinate as a fraction of [`SCALE`].
const fn fraction(v: i64) -> i16 {
    let q = (v / 2 + SCALE / 2).div_euclid(SCALE);
    // Only x = 1.4 itself is out of range, by one.
    if q > i16::MAX as i64 { i16::MAX } else { q as i16 }
}

const fn normals() -> [[i16; 3]; VERTICES] {
    let mut normals = [[0; 3]; VERTICES];
    let mut k = 0;
    while k < VERTICES {
        let (su, cu) = unit(k / ACROSS, AROUND);
        let (sv, cv) = unit(k % ACROSS, ACROSS);
        normals[k] = [((cv * cu) >> 18) as i16, (sv >> 2) as i16, ((cv * su) >> 18) as i16];
        k += 1;
    }
    normals
}

const fn indices() -> [u16; 3 * TRIANGLES] {
    let mut indices = [0; 3 * TRIANGLES];
    let mut quad = 0;
    while quad < VERTICES {
        let (i, j) = (quad / ACROSS, quad % ACROSS);
        let (right, up) = ((i + 1) % AROUND, (j + 1) % ACROSS);
        let [a, b, c, d] = [i * ACROSS + j, right * ACROSS + j, right * ACROSS + up, i * ACROSS + up];
        let corners = [a, c, b, a, d, c];
        let mut k = 0;
        while k < 6 {
            indices[6 * quad + k] = corners[k] as u16;
            k += 1;
        }
        quad += 1;
    }
    indices
}

/// Returns the torus without diagonals: corners of quads, counter-clockwise.
const fn quads() -> [u16; 4 * VERTICES] {
    let mut corners = [0; 4 * VERTICES];
    let mut quad = 0;
    while quad < VERTICES {
        // a, c, b and a, d, c.
        let k = 6 * quad;
        let quad_corners = [INDICES[k], INDICES[k + 4], INDICES[k + 1], INDICES[k + 2]];
        let mut corner = 0;
        while corner < 4 {
            corners[4 * quad + corner] = quad_corners[corner];
            corner += 1;
        }
        quad += 1;
    }
    corners
}

const fn find_edges() -> [[u16; 2]; 2 * VERTICES] {
    let mut found = [[0; 2]; 2 * VERTICES];
    let mut room = [[0; 2]; 4 * VERTICES];
    match edges(quad_mesh(), &mut room) {
        Ok(edges) => {
            assert!(edges.len() == found.len(), "each vertex has four edges, each edge two");
            found.copy_from_slice(edges);
        }
        Err(_) => panic!("more edges than sides"),
    }
    found
}

/// Unit normals of the faces, from the vertices' positions.
const fn face_normals() -> [[i16; 3]; TRIANGLES] {
    let mut normals = [[0; 3]; TRIANGLES];
    let mut k = 0;
    while k < TRIANGLES {
        let a = point(INDICES[3 * k]);
        let ab = minus(point(INDICES[3 * k + 1]), a);
        let ac = minus(point(INDICES[3 * k + 2]), a);
        // Edges are short: a product of two is below 2²⁸.
        let n = Vec3::from_bits([
            ab[1] * ac[2] - ab[2] * ac[1],
            ab[2] * ac[0] - ab[0] * ac[2],
            ab[0] * ac[1] - ab[1] * ac[0],
        ]);
        if let Some(unit) = n.normalized() {
            let u = unit.to_bits();
            normals[k] = [(u[0] >> 2) as i16, (u[1] >> 2) as i16, (u[2] >> 2) as i16];
        }
        k += 1;
    }
    normals
}

const fn point(index: u16) -> [i32; 3] {
    let p = POSITIONS[index as usize];
    [p[0] as i32, p[1] as i32, p[2] as i32]
}

const fn minus(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

static POSITIONS: [[i16; 3]; VERTICES] = positions();
static NORMALS: [[i16; 3]; VERTICES] = normals();
static INDICES: [u16; 3 * TRIANGLES] = indices();
static FACE_NORMALS: [[i16; 3]; TRIANGLES] = face_normals();

pub static MESH: Mesh<'static> = Mesh::constant(MeshData {
    indices: Some(&INDICES),
    normals: Some(&NORMALS),
    face_normals: Some(&FACE_NORMALS),
    ..MeshData::new(Positions::Quantized {
        points: &POSITIONS,
        scale: Scalar::from_bits(SCALE as i32),
        offset: Vec3::ZERO,
    })
});

/// The torus as quads.
const fn quad_mesh() -> &'static Mesh<'static> {
    const {
        &Mesh::constant(MeshData {
            topology: Topology::Quads,
            indices: Some(const { &quads() }),
            normals: Some(&NORMALS),
            ..MeshData::new(Positions::Quantized {
                points: &POSITIONS,
                scale: Scalar::from_bits(SCALE as i32),
                offset: Vec3::ZERO,
            })
        })
    }
}

/// Its edges, each once.
pub fn lines() -> &'static Lines<'static> {
    const {
        &match Lines::of_mesh(quad_mesh(), const { &find_edges() }) {
            Ok(lines) => lines,
            Err(_) => panic!("edges of another mesh"),
        }
    }
}
