//! A model of a user's own, as the benchmark draws it: the words that it is handed over in, from host to firmware, and
//! its frames.
//!
//! | words | |
//! |---|---|
//! | [`MAGIC`] | |
//! | near, far | planes of the camera, 16.16 |
//! | 12 | rows of the transform to eye space, 16.16 |
//! | 3 × 2 | vertices and triangles of the three meshes; 0 where there is none |
//!
//! Each mesh follows, its parts padded to words: positions (three numbers of 16 bits, in fractions of the cube from -1
//! to 1), normals (2.14) unless flat, texture coordinates (16.16) if textured, indices, face normals (2.14) if flat.

#[cfg(not(target_os = "none"))]
pub mod read;

use zstrip::bytemuck::{AnyBitPattern, cast_slice};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::light::{Matte, Sun, Sunlit};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::prelude::*;
use zstrip::shader::{Flat, Gouraud, Textured};
use zstrip::target::{Stats, Strip, WithDepth, WithRecords};
use zstrip::texture::Tile;

pub const WIDTH: usize = 320;
pub const HEIGHT: usize = 240;
/// Degrees from the lower to the upper edge of the screen.
pub const FIELD_OF_VIEW: u16 = 60;
pub const SCREEN: Size = Size::new(WIDTH as u32, HEIGHT as u32);
/// Dark blue; no shaded model has it.
pub const BACKGROUND: Rgb565 = Rgb565::new(0, 0, 9);
/// First word of the data.
pub const MAGIC: u32 = u32::from_le_bytes(*b"OBJ1");
/// Vertices and triangles of a mesh, at most.
pub const MOST: usize = u16::MAX as usize;
/// Words of the data, at most: three meshes as large as can be.
#[cfg(target_os = "none")]
pub const MOST_WORDS: usize = 1 << 21;
/// Words of records for any model: two words per vertex, four of varyings, three per triangle, and the lists.
pub const RECORDS: usize = 9 * MOST + 4096;

/// Ways to draw a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Nothing: what it costs to clear colours and depths.
    Empty,
    Flat,
    Gouraud,
    Textured,
    Lit,
}

pub const WAYS: [(&str, Way); 5] = [
    ("empty", Way::Empty),
    ("flat", Way::Flat),
    ("gouraud", Way::Gouraud),
    ("textured", Way::Textured),
    ("textured_lit", Way::Lit),
];

/// A model: its meshes, and its place.
pub struct Model<'a> {
    flat: Mesh<'a>,
    smooth: Mesh<'a>,
    textured: Option<Mesh<'a>>,
    camera: Projective,
    surface: Sunlit,
    white: Sunlit,
}

/// Words that are left to be read.
struct Words<'a>(&'a [u32]);

impl<'a> Words<'a> {
    fn next(&mut self) -> Option<u32> {
        let (first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(*first)
    }

    /// Takes elements that begin at a word.
    fn take<T: AnyBitPattern>(&mut self, count: usize) -> Option<&'a [T]> {
        let bytes = count * size_of::<T>();
        let (part, rest) = self.0.split_at_checked(bytes.div_ceil(4))?;
        self.0 = rest;
        Some(cast_slice(cast_slice::<u32, u8>(part).get(..bytes)?))
    }
}

impl<'a> Model<'a> {
    /// Reads a model. Texture coordinates are put into `uvs`. `None` if something is wrong with the data.
    pub fn new(words: &'a [u32], uvs: &'a mut [[Scalar; 2]]) -> Option<Self> {
        let mut words = Words(words);
        if words.next()? != MAGIC {
            return None;
        }
        let [near, far] = [words.next()?, words.next()?].map(|word| Scalar::from_bits(word as i32));
        let rows: &[[i32; 4]] = words.take(3)?;
        let &[[ax, ay, az, x], [bx, by, bz, y], [cx, cy, cz, z]] = rows else { return None };
        let model = Affine::from_rows(
            Vec3::from_bits([ax, ay, az]),
            Vec3::from_bits([bx, by, bz]),
            Vec3::from_bits([cx, cy, cz]),
            Vec3::from_bits([x, y, z]),
        );
        let sizes: &[[u32; 2]] = words.take(3)?;
        let &[flat, smooth, textured] = sizes else { return None };
        let flat = {
            let [vertices, triangles] = flat.map(|n| n as usize);
            let points = words.take(vertices)?;
            let indices: &[u16] = words.take(3 * triangles)?;
            let face_normals = Some(words.take(triangles)?);
            Mesh::new(MeshData { indices: Some(indices), face_normals, ..MeshData::new(positions(points)) }).ok()?
        };
        let smooth = {
            let [vertices, triangles] = smooth.map(|n| n as usize);
            let (points, normals) = (words.take(vertices)?, Some(words.take(vertices)?));
            let indices: &[u16] = words.take(3 * triangles)?;
            Mesh::new(MeshData { indices: Some(indices), normals, ..MeshData::new(positions(points)) }).ok()?
        };
        let textured = match textured.map(|n| n as usize) {
            [0, _] => None,
            [vertices, triangles] => {
                let (points, normals) = (words.take(vertices)?, Some(words.take(vertices)?));
                let bits: &[[i32; 2]] = words.take(vertices)?;
                let uvs = uvs.get_mut(..vertices)?;
                for (uv, bits) in uvs.iter_mut().zip(bits) {
                    *uv = bits.map(Scalar::from_bits);
                }
                let indices: &[u16] = words.take(3 * triangles)?;
                let data = MeshData { indices: Some(indices), normals, ..MeshData::new(positions(points)) };
                Some(Mesh::new(MeshData { uvs: Some(uvs), ..data }).ok()?)
            }
        };
        let camera = Projective::perspective(Angle16::from_degrees(FIELD_OF_VIEW.into()), SCREEN, near, far).ok()?;
        let sun = Sun::from_channels(Vec3::from_milli(400, 700, 600), [204; 3], [51; 3]);
        Some(Self {
            flat,
            smooth,
            textured,
            camera: camera.compose_affine(&model),
            surface: sun.on(&Matte::from_channels([255, 160, 64]), &model),
            white: sun.on(&Matte::WHITE, &model),
        })
    }

    /// Returns whether the model can be drawn in a way.
    pub fn has(&self, way: Way) -> bool {
        !matches!(way, Way::Textured | Way::Lit) || self.textured.is_some()
    }

    /// Draws a frame; the strip is as high as the buffers.
    pub fn draw(&self, way: Way, buffers: Buffers<'_>, sink: &mut dyn FnMut(&[u16])) -> Stats {
        let camera = &self.camera;
        match (way, &self.textured) {
            (Way::Flat, _) => {
                let shader = Flat::new(self.surface);
                frame(buffers, sink, &mut |scene| scene.draw(&self.flat, camera, &shader))
            }
            (Way::Gouraud, _) => {
                let shader = Gouraud::new(self.surface);
                frame(buffers, sink, &mut |scene| scene.draw(&self.smooth, camera, &shader))
            }
            (Way::Textured, Some(mesh)) => {
                let shader = Textured::new(&CHECKERS);
                frame(buffers, sink, &mut |scene| scene.draw(mesh, camera, &shader))
            }
            (Way::Lit, Some(mesh)) => {
                let shader = Textured::new(&CHECKERS).lit(self.white);
                frame(buffers, sink, &mut |scene| scene.draw(mesh, camera, &shader))
            }
            _ => frame(buffers, sink, &mut |_| {}),
        }
    }
}

fn positions(points: &[[i16; 3]]) -> Positions<'_> {
    Positions::Quantized { points, scale: Scalar::ONE, offset: Vec3::ZERO }
}

/// The memory of a frame.
pub struct Buffers<'b> {
    pub color: &'b mut [u16],
    pub depth: &'b mut [u16],
    pub records: &'b mut [u32],
}

/// The closure of a frame, called through a pointer.
type DrawScene<'d> = dyn FnMut(&mut Scene<'_, Strip<'_, Rgb565, WithDepth, WithRecords>>) + 'd;

/// One function for all ways, as a program has that shows several things.
#[inline(never)]
fn frame(buffers: Buffers<'_>, sink: &mut dyn FnMut(&[u16]), draw: &mut DrawScene<'_>) -> Stats {
    let Buffers { color, depth, records } = buffers;
    let Ok(renderer) = Renderer::new(SCREEN).and_then(|renderer| renderer.with_depth(depth)) else {
        return Stats::default();
    };
    let mut renderer = renderer.with_records(records);
    let mut frame = renderer.begin(BACKGROUND);
    while let Ok(Some(strip)) = frame.next_strip(color, &mut *draw) {
        sink(strip.pixels());
    }
    frame.stats()
}

const TEXELS: usize = 64;

/// Eight by eight fields, grey and white.
static CHECKERS: Tile<'static, TEXELS, TEXELS> = {
    const ROWS: [[u16; TEXELS]; TEXELS] = {
        let mut texels = [[0xFFFF; TEXELS]; TEXELS];
        let mut k = 0;
        while k < TEXELS * TEXELS {
            let (u, v) = (k % TEXELS, k / TEXELS);
            if (u / 8 + v / 8) % 2 == 1 {
                texels[v][u] = 0x8410;
            }
            k += 1;
        }
        texels
    };
    Tile::new(&ROWS)
};
