//! Grids of quads that differ in one thing each: the size and shape of their triangles, how vertices are shared, how
//! many triangles show their back, and how many draws they are drawn by. What a frame of each takes tells what a draw,
//! a vertex, a triangle, a row and a pixel take.

use core::array::from_fn;
use zstrip::Renderer;
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::Rgb888;
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::target::{Stats, Strip, StripPixels, WithDepth, WithRecords};
use zstrip::{Scene, State};

pub const WIDTH: usize = 320;
pub const HEIGHT: usize = 240;
pub const SCREEN: Size = Size::new(WIDTH as u32, HEIGHT as u32);
/// Rows of a strip.
pub const ROWS: [usize; 2] = [HEIGHT, 16];

/// How the triangles of a grid have their vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Corners {
    /// Quads share their corners.
    Shared,
    /// Each triangle has three vertices of its own.
    Own,
    /// As `Shared`, and every other quad shows its back.
    Turned,
}

/// A grid of quads of two triangles.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// Sides of a quad in pixels, before it is turned and tilted.
    quad: [i32; 2],
    corners: Corners,
    /// Columns and rows of quads.
    size: [i32; 2],
    draws: usize,
}

/// Sides of quads. The triangles of the first seven are small, up to 60 × 25 px.
const QUADS: [[i32; 2]; 12] =
    [[3, 3], [5, 5], [8, 8], [12, 12], [18, 16], [40, 6], [5, 18], [30, 34], [60, 40], [100, 80], [10, 60], [110, 20]];
const WAYS: [Corners; 3] = [Corners::Shared, Corners::Own, Corners::Turned];
const MOST_DRAWS: usize = 12;

pub const GRIDS: usize = QUADS.len() * WAYS.len() + 2;

/// Returns a grid by its number.
pub fn grid(number: usize) -> Grid {
    let fill = |[width, height]: [i32; 2]| [(250 / width).clamp(1, 30), (170 / height).clamp(1, 24)];
    match (QUADS.get(number / WAYS.len()), WAYS.get(number % WAYS.len())) {
        (Some(quad), Some(corners)) => Grid { quad: *quad, corners: *corners, size: fill(*quad), draws: 1 },
        // Small meshes, many draws.
        _ if number + 1 < GRIDS => Grid { quad: [6, 6], corners: Corners::Shared, size: [3, 3], draws: MOST_DRAWS },
        _ => Grid { quad: [8, 8], corners: Corners::Own, size: [2, 2], draws: MOST_DRAWS },
    }
}

const MOST_VERTICES: usize = 6 * 30 * 24;
const MOST_TRIANGLES: usize = 2 * 30 * 24;

/// The memory of the meshes.
pub struct Parts {
    points: [[i16; 3]; MOST_VERTICES],
    normals: [[i16; 3]; MOST_VERTICES],
    uvs: [[Scalar; 2]; MOST_VERTICES],
    colors: [[u8; 3]; MOST_VERTICES],
    indices: [u16; 3 * MOST_TRIANGLES],
    face_normals: [[i16; 3]; MOST_TRIANGLES],
    vertices: usize,
    triangles: usize,
}

/// Distance of the grid's middle from the eye.
const DISTANCE: i32 = 4;
/// 1 / 32,768 of the cube of positions, of half side 4, per pixel at that distance: 32,768 / 207.8.
const PER_PIXEL: i32 = 158;

impl Parts {
    pub const NEW: Self = Self {
        points: [[0; 3]; _],
        normals: [[0; 3]; _],
        uvs: [[Scalar::ZERO; 2]; _],
        colors: [[0; 3]; _],
        indices: [0; _],
        face_normals: [[0; 3]; _],
        vertices: 0,
        triangles: 0,
    };

    /// Makes a grid's mesh.
    pub fn build(&mut self, grid: &Grid) -> Option<Mesh<'_>> {
        let [columns, rows] = grid.size;
        (self.vertices, self.triangles) = (0, 0);
        if grid.corners != Corners::Own {
            for k in 0..(columns + 1) * (rows + 1) {
                self.vertex(grid, k % (columns + 1), k / (columns + 1));
            }
        }
        for k in 0..columns * rows {
            let (x, y) = (k % columns, k / columns);
            // Counter-clockwise, y up.
            let mut corners = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)];
            if grid.corners == Corners::Turned && (x + y) % 2 == 1 {
                corners.reverse();
            }
            let [a, b, c, d] = corners;
            for triangle in [[a, b, c], [c, d, a]] {
                let numbers = triangle.map(|(x, y)| {
                    if grid.corners == Corners::Own { self.vertex(grid, x, y) } else { (y * (columns + 1) + x) as u16 }
                });
                self.indices.get_mut(3 * self.triangles..)?.get_mut(..3)?.copy_from_slice(&numbers);
                *self.face_normals.get_mut(self.triangles)? = normal(k);
                self.triangles += 1;
            }
        }
        let points = self.points.get(..self.vertices)?;
        let positions = Positions::Quantized { points, scale: Scalar::from_bits(4 << 16), offset: Vec3::ZERO };
        Mesh::new(MeshData {
            indices: self.indices.get(..3 * self.triangles),
            normals: self.normals.get(..self.vertices),
            face_normals: self.face_normals.get(..self.triangles),
            uvs: self.uvs.get(..self.vertices),
            colors: self.colors.get(..self.vertices),
            ..MeshData::new(positions)
        })
        .ok()
    }

    /// Adds a corner of the grid, and returns its number.
    fn vertex(&mut self, grid: &Grid, column: i32, row: i32) -> u16 {
        let at = self.vertices;
        // The middle is in the middle. Corners are off the grid by up to a quarter of a side.
        let place = |k: i32, axis: usize, jitter: i32| {
            let side = PER_PIXEL * grid.quad[axis];
            (side * k - side * grid.size[axis] / 2 + side * (jitter % 17 - 8) / 32) as i16
        };
        let k = 31 * row + column;
        if let Some(point) = self.points.get_mut(at) {
            *point = [place(column, 0, 7 * k), place(row, 1, 5 * k), 0];
        }
        if let Some(of) = self.normals.get_mut(at) {
            *of = normal(k);
        }
        if let Some(uv) = self.uvs.get_mut(at) {
            // A texel per pixel, of 64 of them.
            *uv = [column * grid.quad[0], row * grid.quad[1]].map(|texels| Scalar::from_bits(texels << 10));
        }
        if let Some(color) = self.colors.get_mut(at) {
            *color = from_fn(|c| (k * [37, 59, 83][c]) as u8);
        }
        self.vertices += 1;
        at as u16
    }
}

/// A normal of 2.14 that looks about towards the viewer.
fn normal(k: i32) -> [i16; 3] {
    let [x, y] = [37 * k % 64 - 32, 59 * k % 64 - 32].map(|c| 160 * c);
    [x as i16, y as i16, 14_700]
}

/// The places of the draws.
pub fn places(draws: usize) -> [Projective; MOST_DRAWS] {
    let far = Scalar::from_bits(16 << 16);
    let camera = Projective::perspective(Angle16::from_degrees(60), SCREEN, Scalar::ONE, far).unwrap_or_default();
    let turned = Affine::rotation_x(Angle16::from_degrees(-25)) * Affine::rotation_z(Angle16::from_degrees(9));
    from_fn(|k| {
        let (column, row) = (k as i32 % 4, k as i32 / 4);
        let [x, y] = if draws > 1 { [500 * column - 750, 500 * row - 500] } else { [0, 0] };
        camera.compose_affine(&(Affine::translation(Vec3::from_milli(x, y, -1000 * DISTANCE)) * turned))
    })
}

/// Memory that a frame is drawn in.
pub struct Memory<'m, P: PixelFormat> {
    pub color: &'m mut [P::Raw],
    pub depth: &'m mut [u16],
    pub records: &'m mut [u32],
}

/// The closure of a frame, called through a pointer.
type DrawScene<'d, P> = dyn FnMut(&mut Scene<'_, Strip<'_, P, WithDepth, WithRecords>>) + 'd;

/// Draws a frame in strips as high as the memory.
#[inline(never)]
pub fn frame<P: PixelFormat>(
    memory: Memory<'_, P>,
    sink: &mut dyn FnMut(&StripPixels<'_, P>),
    draw: &mut DrawScene<'_, P>,
) -> Stats {
    let Memory { color, depth, records } = memory;
    let Ok(renderer) = Renderer::<P>::new(SCREEN).and_then(|renderer| renderer.with_depth(depth)) else {
        return Stats::default();
    };
    let mut renderer = renderer.with_records(records);
    let mut frame = renderer.begin(Rgb888::new(0, 0, 60));
    while let Ok(Some(strip)) = frame.next_strip(color, &mut *draw) {
        sink(&strip);
    }
    frame.stats()
}

/// Draws a mesh in each place, by a shader.
#[inline(always)]
pub fn draw_by<P: PixelFormat>(
    memory: Memory<'_, P>,
    sink: &mut dyn FnMut(&StripPixels<'_, P>),
    shader: &impl zstrip::span::Shader<P>,
    mesh: &Mesh<'_>,
    places: &[Projective],
) -> Stats {
    frame(memory, sink, &mut |scene| {
        for place in places {
            scene.draw_with(State::DEFAULT, mesh, place, shader);
        }
    })
}

impl Grid {
    pub const fn draws(&self) -> usize {
        self.draws
    }
}
