//! The benchmark's workloads, W1 to W6, W9 and W10, and how each is drawn.
//!
//! The geometry is stated in a left-handed view space: x right, y up, z forward, F = 120 / tan 30° px,
//! screen x = 160 + F x / z, screen y = 120 - F y / z, front faces counter-clockwise on the screen. Here a camera looks
//! along -z, so z changes its sign on the way into it; that mirrors space and camera together, and so nothing on the
//! screen, windings included.
//!
//! The compiler computes all of it, in `f64`: programs contain integers only.
#![allow(dead_code)] // each program uses its part
#![allow(long_running_const_eval)] // 30,000 vertices are made

pub mod price;
#[cfg(not(target_os = "none"))]
pub mod reference;
pub mod spot;

use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
use zstrip::frame::{Renderer, RendererError};
use zstrip::light::{Matte, Sun, Sunlit};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::shader::{Flat, Gouraud, Textured};
use zstrip::span::{DepthState, DepthTest, Fragment, Shader, SmallResult, SmallTriangle, SpanOf};
use zstrip::target::RecordsChoice;
use zstrip::target::WithDepth;
use zstrip::target::{Stats, Strip};
use zstrip::texture::Tile;
use zstrip::vertex::{Face, VertexRef, VertexShader};
use zstrip::{Scene, State};

pub const WIDTH: usize = 320;
pub const HEIGHT: usize = 240;
/// Cyan, which no picture has.
pub const BACKGROUND: Rgb565 = Rgb565::new(0, 63, 31);

/// Pixels per unit of x / z: 120 / tan 30°.
pub const FOCAL: f64 = 120.0 * root(3.0);

const NEAR: Scalar = Scalar::ONE;
const FAR: Scalar = Scalar::from_bits(16 << 16);

/// What to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Workload {
    /// Nothing: what it costs to clear colours and depths and to hand out the strips.
    Empty,
    /// A quad that covers the screen, one colour, no depth.
    Quad,
    /// The same quad, depth test and write, Gouraud colours.
    GouraudQuad,
    /// The same quad in one colour, depth test and write.
    FlatQuad,
    /// The same again, by a shader of one's own.
    OwnFlatQuad,
    /// The quad in Gouraud colours, by a shader of one's own.
    OwnGouraudQuad,
    /// A quad tilted by 60°, with a texture of 64 x 64 texels, perspective-correct; depth test and write.
    TexturedQuad,
    /// A torus of 1,024 triangles, flat.
    FlatTorus,
    /// The same torus, lit at its vertices.
    GouraudTorus,
    /// 10,000 triangles of about 2 px, one colour each.
    Tiny,
    /// Nothing, on the screen of the next two.
    EmptySpot,
    /// A cow of 5,856 triangles, textured under light.
    TexturedSpot,
    /// The same cow, flat.
    FlatSpot,
}

/// The memory of a frame.
pub struct Buffers<'b> {
    pub color: &'b mut [u16],
    pub depth: &'b mut [u16],
    pub records: &'b mut [u32],
}

impl Workload {
    /// Returns the columns of the screen; all have [`HEIGHT`] rows.
    pub const fn width(self) -> usize {
        match self {
            Self::EmptySpot | Self::TexturedSpot | Self::FlatSpot => spot::SIDE,
            _ => WIDTH,
        }
    }
}

/// Draws a frame of a workload; the strip is as high as the buffers.
pub fn draw(workload: Workload, buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    match workload {
        Workload::Empty => frame(buffers, &mut sink, &mut |_| {}),
        Workload::Quad => quad(buffers, sink),
        Workload::GouraudQuad => gouraud_quad(buffers, sink),
        Workload::FlatQuad => flat_quad(buffers, sink),
        Workload::OwnFlatQuad => own_flat_quad(buffers, sink),
        Workload::OwnGouraudQuad => own_gouraud_quad(buffers, sink),
        Workload::TexturedQuad => textured_quad(buffers, sink),
        Workload::FlatTorus => flat_torus(buffers, sink),
        Workload::GouraudTorus => gouraud_torus(buffers, sink),
        Workload::Tiny => tiny(buffers, sink),
        Workload::EmptySpot => spot::empty(buffers, sink),
        Workload::TexturedSpot => spot::textured(buffers, sink),
        Workload::FlatSpot => spot::flat(buffers, sink),
    }
}

const SCREEN: Size = Size::new(WIDTH as u32, HEIGHT as u32);

/// What renderers have beside depths.
#[cfg(not(carries))]
type Lent = zstrip::target::WithRecords;
#[cfg(carries)]
type Lent = zstrip::target::WithCarriedState;

/// The closure of a frame, called through a pointer.
type DrawScene<'d> = dyn FnMut(&mut Scene<'_, Strip<'_, Rgb565, WithDepth, Lent>>) + 'd;

#[inline(always)]
fn frame(buffers: Buffers<'_>, sink: &mut dyn FnMut(&[u16]), draw: &mut DrawScene<'_>) -> Stats {
    frame_on(SCREEN, buffers, sink, draw)
}

/// One function for all workloads, as a program has that shows several things.
#[inline(never)]
fn frame_on(screen: Size, buffers: Buffers<'_>, sink: &mut dyn FnMut(&[u16]), draw: &mut DrawScene<'_>) -> Stats {
    let Buffers { color, depth, records } = buffers;
    let renderer = Renderer::new(screen).and_then(|renderer| renderer.with_depth(depth));
    let renderer = renderer.map(|renderer| renderer.with_records(records));
    #[cfg(carries)]
    let renderer = renderer.map(|renderer| renderer.with_carried_state());
    frame_by(renderer, color, sink, draw)
}

/// Buffers that do not hold a row draw nothing.
fn frame_by<R: RecordsChoice>(
    mut renderer: Result<Renderer<'_, Rgb565, WithDepth, R>, RendererError>,
    color: &mut [u16],
    mut sink: impl FnMut(&[u16]),
    mut draw: impl FnMut(&mut Scene<'_, Strip<'_, Rgb565, WithDepth, R>>),
) -> Stats {
    let Ok(renderer) = &mut renderer else { return Stats::default() };
    let mut frame = renderer.begin(BACKGROUND);
    while let Ok(Some(strip)) = frame.next_strip(color, &mut draw) {
        sink(strip.pixels());
    }
    frame.stats()
}

#[inline(never)]
pub fn quad(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    const OVER: State = State { depth: DepthState::OFF, ..State::DEFAULT };
    let [r, g, b] = QUAD_COLOR;
    let shader = Flat::unlit(Rgb888::new(r, g, b));
    frame(buffers, &mut sink, &mut |scene| scene.draw_with(OVER, &QUAD, &IN_VIEW, &shader))
}

#[inline(never)]
pub fn gouraud_quad(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    frame(buffers, &mut sink, &mut |scene| scene.draw(&QUAD, &IN_VIEW, &Gouraud::vertex_colors()))
}

#[inline(never)]
pub fn flat_quad(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    let [r, g, b] = QUAD_COLOR;
    frame(buffers, &mut sink, &mut |scene| scene.draw(&QUAD, &IN_VIEW, &Flat::unlit(Rgb888::new(r, g, b))))
}

#[inline(never)]
pub fn own_flat_quad(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    frame(buffers, &mut sink, &mut |scene| scene.draw(&QUAD, &IN_VIEW, &OwnFlat))
}

#[inline(never)]
pub fn own_gouraud_quad(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    frame(buffers, &mut sink, &mut |scene| scene.draw(&QUAD, &IN_VIEW, &OwnGouraud))
}

#[inline(never)]
pub fn textured_quad(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    frame(buffers, &mut sink, &mut |scene| scene.draw(&TILTED, &IN_VIEW, &Textured::new(&TEXTURE)))
}

#[inline(never)]
pub fn flat_torus(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    let shader = Flat::new(TORUS_SURFACE);
    frame(buffers, &mut sink, &mut |scene| scene.draw(&TORUS, &OF_TORUS, &shader))
}

/// The same by a renderer that knows no records.
#[inline(never)]
pub fn flat_torus_without_records(color: &mut [u16], depth: &mut [u16], sink: impl FnMut(&[u16])) {
    let shader = Flat::new(TORUS_SURFACE);
    let renderer = Renderer::new(SCREEN).and_then(|renderer| renderer.with_depth(depth));
    frame_by(renderer, color, sink, |scene| scene.draw(&TORUS, &OF_TORUS, &shader));
}

#[inline(never)]
pub fn gouraud_torus(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    let shader = Gouraud::new(TORUS_SURFACE);
    frame(buffers, &mut sink, &mut |scene| scene.draw(&TORUS, &OF_TORUS, &shader))
}

#[inline(never)]
pub fn tiny(buffers: Buffers<'_>, mut sink: impl FnMut(&[u16])) -> Stats {
    let shader = FaceColors(Flat::unlit(Rgb888::new(0, 0, 0)));
    frame(buffers, &mut sink, &mut |scene| scene.draw(tiny_mesh(), &IN_VIEW, &shader))
}

/// The compiler makes it: 128-bit arithmetic stays out of the firmware.
const CAMERA: Projective = {
    match Projective::perspective(Angle16::from_degrees(60), Size::new(WIDTH as u32, HEIGHT as u32), NEAR, FAR) {
        Ok(camera) => camera,
        Err(_) => panic!("not a camera"),
    }
};

/// Where workloads are that are given in the camera's own space, and the torus.
const IN_VIEW: Projective = CAMERA.compose_affine(&MIRROR);
const OF_TORUS: Projective = CAMERA.compose_affine(&MODEL);

/// The torus under its light.
const TORUS_SURFACE: Sunlit = {
    let [ambient, diffuse] = [nearest(AMBIENT * 255.0) as u8, nearest(DIFFUSE * 255.0) as u8];
    let direction = vector([LIGHT[0], LIGHT[1], -LIGHT[2]]);
    Sun::from_channels(direction, [diffuse; 3], [ambient; 3]).on(&Matte::from_channels(TORUS_COLOR), &MODEL)
};

fn torus_color() -> Rgb888 {
    let [r, g, b] = TORUS_COLOR;
    Rgb888::new(r, g, b)
}

/// Colours of the provoking vertices as they are: a shader as a user would write it, on top of [`Flat`]'s pixel loop.
struct FaceColors(Flat);

impl VertexShader for FaceColors {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }

    #[inline]
    fn face(&self, face: &Face<'_>) -> u32 {
        let [r, g, b] = face.provoking().color();
        u32::from_be_bytes([0, r, g, b])
    }
}

impl<P: PixelFormat> Shader<P> for FaceColors {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<P::Raw> {
        Shader::<P>::fragment(&self.0, fragment)
    }

    #[inline(always)]
    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        Shader::<P>::span(&self.0, span, test);
    }

    #[inline(always)]
    fn small<D: DepthTest>(
        &self,
        triangle: SmallTriangle<'_, '_, P, D>,
        corners: &[[i32; 0]; 3],
        flat: u32,
    ) -> SmallResult {
        Shader::<P>::small(&self.0, triangle, corners, flat)
    }
}

/// One colour, as a user would write it: fragment by fragment.
struct OwnFlat;

impl VertexShader for OwnFlat {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }

    fn face(&self, _: &Face<'_>) -> u32 {
        let [r, g, b] = QUAD_COLOR;
        u32::from_be_bytes([0, r, g, b])
    }
}

impl<P: PixelFormat> Shader<P> for OwnFlat {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<P::Raw> {
        let [_, r, g, b] = fragment.flat.to_be_bytes();
        Some(P::pack([r, g, b]))
    }
}

/// Interpolated colours, as a user would write them.
struct OwnGouraud;

impl VertexShader for OwnGouraud {
    type Varyings = [i32; 3];

    fn vertex(&self, corner: &VertexRef<'_>) -> [i32; 3] {
        // 8.16, and a little away from both ends, for the gradients' errors.
        corner.color().map(|c| i32::from(c) * 0xFF00 + 0x4000)
    }
}

impl<P: PixelFormat> Shader<P> for OwnGouraud {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 3]>) -> Option<P::Raw> {
        let [r, g, b] = fragment.varyings;
        Some(P::pack([(r >> 16) as u8, (g >> 16) as u8, (b >> 16) as u8]))
    }
}

// The numbers: `const` code has arithmetic, but neither roots nor sines.

/// Square root, by Newton's method.
const fn root(x: f64) -> f64 {
    let mut r = if x < 1.0 { 1.0 } else { x };
    let mut k = 0;
    while k < 64 {
        r = (r + x / r) / 2.0;
        k += 1;
    }
    r
}

/// Sine and cosine for |x| ≤ 2π, by their series: errors below 1e-13.
const fn sin_cos(x: f64) -> (f64, f64) {
    let (mut sin, mut cos) = (0.0, 0.0);
    let mut term = 1.0;
    let mut k = 0;
    while k < 40 {
        match k % 4 {
            0 => cos += term,
            1 => sin += term,
            2 => cos -= term,
            _ => sin -= term,
        }
        k += 1;
        term = term * x / k as f64;
    }
    (sin, cos)
}

const fn nearest(x: f64) -> i64 {
    (if x < 0.0 { x - 0.5 } else { x + 0.5 }) as i64
}

const fn vector(v: [f64; 3]) -> Vec3 {
    Vec3::from_bits([nearest(v[0] * 65_536.0) as i32, nearest(v[1] * 65_536.0) as i32, nearest(v[2] * 65_536.0) as i32])
}

/// A point as fractions of a cube: its middle, and half its side.
const fn quantized(v: [f64; 3], middle: [f64; 3], half: f64) -> [i16; 3] {
    [
        nearest((v[0] - middle[0]) / half * 32_768.0) as i16,
        nearest((v[1] - middle[1]) / half * 32_768.0) as i16,
        nearest((v[2] - middle[2]) / half * 32_768.0) as i16,
    ]
}

const fn quantities<'a>(points: &'a [[i16; 3]], middle: [f64; 3], half: f64) -> Positions<'a> {
    Positions::Quantized { points, scale: Scalar::from_bits(nearest(half * 65_536.0) as i32), offset: vector(middle) }
}

const fn normal(n: [f64; 3]) -> [i16; 3] {
    [nearest(n[0] * 16_384.0) as i16, nearest(n[1] * 16_384.0) as i16, nearest(n[2] * 16_384.0) as i16]
}

const fn normalized(v: [f64; 3]) -> [f64; 3] {
    let length = root(dot(v, v));
    [v[0] / length, v[1] / length, v[2] / length]
}

const fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

const fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

const fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// View space as the workloads have it → view space as the camera has it.
const MIRROR: Affine = Affine::from_rows(Vec3::X, Vec3::Y, Vec3::from_ints(0, 0, -1), Vec3::ZERO);

// The quad, at z = 2, from edge to edge of the screen: top left, top right, bottom left, bottom right.

const QUAD_X: f64 = 160.0 / FOCAL * 2.0;
const QUAD_Y: f64 = 120.0 / FOCAL * 2.0;
pub const QUAD_POSITIONS: [[f64; 3]; 4] =
    [[-QUAD_X, QUAD_Y, 2.0], [QUAD_X, QUAD_Y, 2.0], [-QUAD_X, -QUAD_Y, 2.0], [QUAD_X, -QUAD_Y, 2.0]];
pub const QUAD_INDICES: [u16; 6] = [0, 2, 1, 1, 2, 3];
pub const QUAD_COLORS: [[u8; 3]; 4] = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]];
/// Orange, when it has one colour.
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

// A quad of 2 x 3, its top turned away by 60°: top left, top right, bottom left, bottom right.

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

/// Sides of the texture.
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

// The torus: axis y, radii 1 and 0.4, 32 x 16 quads, turned by RX and then RY, three units away.

const AROUND: usize = 32;
const ACROSS: usize = 16;
const VERTICES: usize = AROUND * ACROSS;
pub const TRIANGLES: usize = 2 * VERTICES;

const RX: f64 = 0.7;
const RY: f64 = 0.5;
pub const DISTANCE: f64 = 3.0;

/// The rows of ry(0.5) · rx(0.7).
pub const ROTATION: [[f64; 3]; 3] = {
    let (sx, cx) = sin_cos(RX);
    let (sy, cy) = sin_cos(RY);
    [[cy, sy * sx, sy * cx], [0.0, cx, -sx], [-sy, cy * sx, cy * cx]]
};

/// Towards the light, in the workloads' view space.
pub const LIGHT: [f64; 3] = normalized([0.4, 0.7, -0.6]);
pub const AMBIENT: f64 = 0.15;
pub const DIFFUSE: f64 = 0.85;
pub const TORUS_COLOR: [u8; 3] = [255, 160, 64];

/// Object space → view space as the camera has it.
const MODEL: Affine = {
    let [x, y, [zx, zy, zz]] = ROTATION;
    Affine::from_rows(vector(x), vector(y), vector([-zx, -zy, -zz]), vector([0.0, 0.0, -DISTANCE]))
};

static TORUS_VERTICES: [[[f64; 3]; VERTICES]; 2] = torus();
static TORUS_FACES: ([u16; 3 * TRIANGLES], [[f64; 3]; TRIANGLES]) = torus_faces();
pub static TORUS_POSITIONS: &[[f64; 3]; VERTICES] = &TORUS_VERTICES[0];
pub static TORUS_NORMALS: &[[f64; 3]; VERTICES] = &TORUS_VERTICES[1];
pub static TORUS_INDICES: &[u16; 3 * TRIANGLES] = &TORUS_FACES.0;
/// Pointing outwards.
pub static TORUS_FACE_NORMALS: &[[f64; 3]; TRIANGLES] = &TORUS_FACES.1;

/// Sines and cosines of so many steps of a turn.
const fn circle<const N: usize>() -> [(f64, f64); N] {
    let mut circle = [(0.0, 0.0); N];
    let turn = 2.0 * core::f64::consts::PI;
    let mut k = 0;
    while k < N {
        circle[k] = sin_cos(turn * k as f64 / N as f64);
        k += 1;
    }
    circle
}

/// Positions and normals.
const fn torus() -> [[[f64; 3]; VERTICES]; 2] {
    let mut positions = [[0.0; 3]; VERTICES];
    let mut normals = [[0.0; 3]; VERTICES];
    let (around, across) = (circle::<AROUND>(), circle::<ACROSS>());
    let mut k = 0;
    while k < VERTICES {
        let (su, cu) = around[k / ACROSS];
        let (sv, cv) = across[k % ACROSS];
        let ring = 1.0 + 0.4 * cv;
        positions[k] = [ring * cu, 0.4 * sv, ring * su];
        normals[k] = [cv * cu, sv, cv * su];
        k += 1;
    }
    [positions, normals]
}

/// Indices and face normals: the cross product of a front face's edges points inwards, as space is left-handed.
const fn torus_faces() -> ([u16; 3 * TRIANGLES], [[f64; 3]; TRIANGLES]) {
    let mut indices = [0; 3 * TRIANGLES];
    let mut normals = [[0.0; 3]; TRIANGLES];
    let mut triangle = 0;
    while triangle < TRIANGLES {
        let (i, j) = (triangle / 2 / ACROSS, triangle / 2 % ACROSS);
        let (i1, j1) = ((i + 1) % AROUND, (j + 1) % ACROSS);
        let a = i * ACROSS + j;
        let c = i1 * ACROSS + j1;
        let corners = if triangle % 2 == 0 { [a, i1 * ACROSS + j, c] } else { [a, c, i * ACROSS + j1] };
        let p = [TORUS_POSITIONS[corners[0]], TORUS_POSITIONS[corners[1]], TORUS_POSITIONS[corners[2]]];
        let n = normalized(cross(minus(p[1], p[0]), minus(p[2], p[0])));
        let inwards =
            dot(n, TORUS_NORMALS[corners[0]]) + dot(n, TORUS_NORMALS[corners[1]]) + dot(n, TORUS_NORMALS[corners[2]])
                <= 0.0;
        let (second, third) = if inwards { (1, 2) } else { (2, 1) };
        indices[3 * triangle] = corners[0] as u16;
        indices[3 * triangle + 1] = corners[second] as u16;
        indices[3 * triangle + 2] = corners[third] as u16;
        normals[triangle] = if inwards { [-n[0], -n[1], -n[2]] } else { n };
        triangle += 1;
    }
    (indices, normals)
}

const TORUS_HALF: f64 = 1.40625;

static TORUS_POINTS: [[i16; 3]; VERTICES] = {
    let mut points = [[0; 3]; VERTICES];
    let mut k = 0;
    while k < VERTICES {
        points[k] = quantized(TORUS_POSITIONS[k], [0.0; 3], TORUS_HALF);
        k += 1;
    }
    points
};

const fn to_normals<const N: usize>(normals: &[[f64; 3]; N]) -> [[i16; 3]; N] {
    let mut short = [[0; 3]; N];
    let mut k = 0;
    while k < N {
        short[k] = normal(normals[k]);
        k += 1;
    }
    short
}

pub static TORUS: Mesh<'static> = Mesh::constant(MeshData {
    indices: Some(TORUS_INDICES),
    normals: Some(&to_normals(TORUS_NORMALS)),
    face_normals: Some(&to_normals(TORUS_FACE_NORMALS)),
    ..MeshData::new(quantities(&TORUS_POINTS, [0.0; 3], TORUS_HALF))
});

// Tiny right triangles with legs of 2 px on a jittered grid, at distances from 4 to 8.

pub const TINY_TRIANGLES: usize = 10_000;
/// State of the random numbers before the first triangle.
pub const TINY_SEED: u32 = 12_345;

/// A random number from 0 to 1, from a linear congruential generator.
const fn random(state: u32) -> (f64, u32) {
    let state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    ((state >> 8) as f64 / 16_777_216.0, state)
}

/// Corners, colour and the generator's next state for triangle `k`.
pub const fn tiny_triangle(k: usize, state: u32) -> ([[f64; 3]; 3], [u8; 3], u32) {
    let (right, state) = random(state);
    let (down, state) = random(state);
    let (away, state) = random(state);
    let (r, state) = random(state);
    let (g, state) = random(state);
    let (b, state) = random(state);
    let x = 0.02 + (k % 100) as f64 * 3.17 + right * 1.1;
    let y = 0.02 + (k / 100) as f64 * 2.37 + down * 0.3;
    let z = 4.0 + 4.0 * away;
    let screen = if k % 2 == 1 {
        [(x, y), (x, y + 2.0), (x + 2.0, y)]
    } else {
        [(x + 2.0, y), (x, y + 2.0), (x + 2.0, y + 2.0)]
    };
    let mut corners = [[0.0; 3]; 3];
    let mut c = 0;
    while c < 3 {
        let (sx, sy) = screen[c];
        corners[c] = [(sx - 160.0) * z / FOCAL, (120.0 - sy) * z / FOCAL, z];
        c += 1;
    }
    let color = [128 + (r * 127.0) as u8, 128 + (g * 127.0) as u8, 128 + (b * 127.0) as u8];
    (corners, color, state)
}

const TINY_MIDDLE: [f64; 3] = [0.0, 0.0, 6.0];
const TINY_HALF: f64 = 6.25;

type Tiny = ([[i16; 3]; 3 * TINY_TRIANGLES], [[u8; 3]; 3 * TINY_TRIANGLES]);

const fn tiny_corners() -> Tiny {
    let mut points = [[0; 3]; 3 * TINY_TRIANGLES];
    let mut colors = [[0; 3]; 3 * TINY_TRIANGLES];
    let mut state = TINY_SEED;
    let mut k = 0;
    while k < TINY_TRIANGLES {
        let (corners, color, next) = tiny_triangle(k, state);
        state = next;
        let mut c = 0;
        while c < 3 {
            points[3 * k + c] = quantized(corners[c], TINY_MIDDLE, TINY_HALF);
            colors[3 * k + c] = color;
            c += 1;
        }
        k += 1;
    }
    (points, colors)
}

/// Computed for programs that draw it: 30,000 vertices take the compiler a while.
fn tiny_mesh() -> &'static Mesh<'static> {
    const {
        let (points, colors) = const { &tiny_corners() };
        &Mesh::constant(MeshData { colors: Some(colors), ..MeshData::new(quantities(points, TINY_MIDDLE, TINY_HALF)) })
    }
}
