//! Workloads W9 and W10: Spot the cow, 5,856 small triangles, on a screen of 240 × 240 px; with a texture under light,
//! and in one colour per face.
//!
//! The model is by Keenan Crane, who released it into the public domain. `ci/spot.py` made `spot.bin` of it, and
//! describes it. The space is right-handed: x right, y up, the camera at 0 looks along -z.

use super::numbers::{dot, nearest, normalized, quantities, root, sin_cos, vector};
use super::{Buffers, frame_on};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::light::{Matte, Sun, Sunlit};
use zstrip::math::{Affine, Angle16, Projective, Scalar};
use zstrip::mesh::{Mesh, MeshData};
use zstrip::shader::{Flat, Textured};
use zstrip::target::Stats;
use zstrip::texture::Tile;

pub const SIDE: usize = 240;
/// Pixels per unit of x / -z: 120 / tan 22.5°.
pub const FOCAL: f64 = 120.0 / (root(2.0) - 1.0);
pub const DISTANCE: f64 = 3.25;
pub const SHIFT: f64 = -0.125;
/// Turns about y, then about x.
const YAW: f64 = 0.59375;
const PITCH: f64 = 0.03125;
/// Towards the light, in eye space.
pub const LIGHT: [f64; 3] = normalized([0.4, 0.7, 0.6]);
pub const AMBIENT: f64 = 0.2;
pub const DIFFUSE: f64 = 0.8;
pub const COLOR: [u8; 3] = [255, 160, 64];

const DATA: &[u8] = include_bytes!("spot.bin");
pub const POSITIONS: usize = 2930;
pub const VERTICES: usize = 3225;
pub const FACES: usize = 5856;
pub const TEXELS: usize = 256;
pub const HALF: f64 = 1.125;

// Numbers of 16 bits that come before a part of the data.
const NORMALS_AT: usize = 3 * POSITIONS;
const VERTICES_AT: usize = NORMALS_AT + 3 * POSITIONS;
const FACES_AT: usize = VERTICES_AT + 5 * VERTICES;
const FACE_NORMALS_AT: usize = FACES_AT + 3 * FACES;
const TEXELS_AT: usize = FACE_NORMALS_AT + 3 * FACES;

const fn number(at: usize) -> u16 {
    u16::from_le_bytes([DATA[2 * at], DATA[2 * at + 1]])
}

const fn long(at: usize) -> i32 {
    (number(at) as u32 | (number(at + 1) as u32) << 16) as i32
}

const fn triples<const N: usize>(at: usize) -> [[i16; 3]; N] {
    let mut triples = [[0; 3]; N];
    let mut k = 0;
    while k < N {
        let at = at + 3 * k;
        triples[k] = [number(at) as i16, number(at + 1) as i16, number(at + 2) as i16];
        k += 1;
    }
    triples
}

/// Positions, welded over the seams of the texture.
pub static POINTS: [[i16; 3]; POSITIONS] = triples(0);
pub static NORMALS: [[i16; 3]; POSITIONS] = triples(NORMALS_AT);
pub static FACE_NORMALS: [[i16; 3]; FACES] = triples(FACE_NORMALS_AT);

/// Numbers of the positions of vertices.
pub static POSITION_OF: [u16; VERTICES] = {
    let mut positions = [0; VERTICES];
    let mut k = 0;
    while k < VERTICES {
        positions[k] = number(VERTICES_AT + 5 * k);
        k += 1;
    }
    positions
};

pub static UVS: [[Scalar; 2]; VERTICES] = {
    let mut uvs = [[Scalar::ZERO; 2]; VERTICES];
    let mut k = 0;
    while k < VERTICES {
        let at = VERTICES_AT + 5 * k;
        uvs[k] = [Scalar::from_bits(long(at + 1)), Scalar::from_bits(long(at + 3))];
        k += 1;
    }
    uvs
};

pub static INDICES: [u16; 3 * FACES] = {
    let mut indices = [0; 3 * FACES];
    let mut k = 0;
    while k < 3 * FACES {
        indices[k] = number(FACES_AT + k);
        k += 1;
    }
    indices
};

static WELDED_INDICES: [u16; 3 * FACES] = {
    let mut indices = [0; 3 * FACES];
    let mut k = 0;
    while k < 3 * FACES {
        indices[k] = POSITION_OF[INDICES[k] as usize];
        k += 1;
    }
    indices
};

const fn of_vertices(of_positions: &[[i16; 3]; POSITIONS]) -> [[i16; 3]; VERTICES] {
    let mut triples = [[0; 3]; VERTICES];
    let mut k = 0;
    while k < VERTICES {
        triples[k] = of_positions[POSITION_OF[k] as usize];
        k += 1;
    }
    triples
}

pub static TEXELS_565: [[u16; TEXELS]; TEXELS] = {
    let mut texels = [[0; TEXELS]; TEXELS];
    let mut k = 0;
    while k < TEXELS * TEXELS {
        texels[k / TEXELS][k % TEXELS] = number(TEXELS_AT + k);
        k += 1;
    }
    texels
};

pub(super) static TEXTURE: Tile<'static, TEXELS, TEXELS> = Tile::new(&TEXELS_565);

pub(super) static TEXTURED: Mesh<'static> = Mesh::constant(MeshData {
    indices: Some(&INDICES),
    normals: Some(&of_vertices(&NORMALS)),
    uvs: Some(&UVS),
    ..MeshData::new(quantities(&of_vertices(&POINTS), [0.0; 3], HALF))
});

pub(super) static PLAIN: Mesh<'static> = Mesh::constant(MeshData {
    indices: Some(&WELDED_INDICES),
    face_normals: Some(&FACE_NORMALS),
    ..MeshData::new(quantities(&POINTS, [0.0; 3], HALF))
});

/// The rows of the rotation about x · the rotation about y.
pub const ROTATION: [[f64; 3]; 3] = {
    let (sy, cy) = sin_cos(2.0 * core::f64::consts::PI * YAW);
    let (sx, cx) = sin_cos(2.0 * core::f64::consts::PI * PITCH);
    [[cy, 0.0, sy], [sx * sy, cx, -sx * cy], [-cx * sy, sx, cx * cy]]
};

const MODEL: Affine = {
    let [x, y, z] = ROTATION;
    Affine::from_rows(vector(x), vector(y), vector(z), vector([0.0, SHIFT, -DISTANCE]))
};

pub(super) const SCREEN: Size = Size::new(SIDE as u32, SIDE as u32);

pub(super) const MATRIX: Projective = {
    match Projective::perspective(Angle16::from_degrees(45), SCREEN, Scalar::ONE, Scalar::from_bits(16 << 16)) {
        Ok(camera) => camera.compose_affine(&MODEL),
        Err(_) => panic!("not a camera"),
    }
};

pub(super) const fn under_light(color: [u8; 3]) -> Sunlit {
    let [ambient, diffuse] = [nearest(AMBIENT * 255.0) as u8, nearest(DIFFUSE * 255.0) as u8];
    Sun::from_channels(vector(LIGHT), [diffuse; 3], [ambient; 3]).on(&Matte::from_channels(color), &MODEL)
}

/// Returns the brightness of a normal of 2.14 in object space.
pub fn brightness(normal: [i16; 3]) -> f64 {
    let normal = normal.map(|c| f64::from(c) / 16_384.0);
    let turned = ROTATION.map(|row| dot(row, normal));
    AMBIENT + DIFFUSE * dot(turned, LIGHT).max(0.0)
}

/// Returns a position in eye space.
pub fn in_eye_space(point: [i16; 3]) -> [f64; 3] {
    let point = point.map(|c| f64::from(c) / 32_768.0 * HALF);
    let [x, y, z] = ROTATION.map(|row| dot(row, point));
    [x, y + SHIFT, z - DISTANCE]
}

#[inline(never)]
pub fn empty(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    frame_on(SCREEN, buffers, &mut sink, &mut |_| {})
}

#[inline(never)]
pub fn textured(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    let shader = Textured::new(&TEXTURE).lit(const { under_light([255; 3]) });
    frame_on(SCREEN, buffers, &mut sink, &mut |scene| scene.draw(&TEXTURED, &MATRIX, &shader))
}

#[inline(never)]
pub fn flat(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    let shader = Flat::new(const { under_light(COLOR) });
    frame_on(SCREEN, buffers, &mut sink, &mut |scene| scene.draw(&PLAIN, &MATRIX, &shader))
}
