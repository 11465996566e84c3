//! Things to draw: vertices, textures, lights and matrices, from bytes; and every shader, by a number.

use crate::source::Source;
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
use zstrip::light::{DirectionalLight, Lighting, LitMaterial, Material, Matte, PointLight, Sun, Sunlit, Viewer};
use zstrip::math::{Affine, Pixels, Scalar, Vec3};
use zstrip::mesh::{Bounds, LineTopology, Lines, Mesh, MeshData, Points, Positions, Topology, Vertices as VertexData};
use zstrip::shader::{FogCurve, FogTable};
use zstrip::span::{Compare, DepthBias, DepthState, Fragment, Shader};
use zstrip::texture::{Image, PaletteTexel, Rgb565Texel, Rgb888Texel, Tile, WithAlpha};
use zstrip::vertex::{DepthRange, DepthScale, Face, Perspective, VertexRef, VertexShader};
use zstrip::{Cull, State, Winding};

/// Vertices in all three formats, and indices for them.
#[derive(Default)]
pub struct Pool {
    kind: u8,
    quantized: Vec<[i16; 3]>,
    exact: Vec<Vec3>,
    homogeneous: Vec<[Scalar; 4]>,
    scale: Scalar,
    offset: Vec3,
    normals: Vec<[i16; 3]>,
    colors: Vec<[u8; 3]>,
    uvs: Vec<[Scalar; 2]>,
    indices: Vec<u16>,
    topology: u8,
    attributes: u8,
    faces: Vec<[i16; 3]>,
}

impl Pool {
    pub fn new(source: &mut Source<'_>) -> Self {
        let mut pool = Self { kind: source.below(3) as u8, ..Self::default() };
        pool.topology = source.u8();
        pool.attributes = source.u8();
        let count = 1 + source.below(9);
        let mut clip = Vec::new();
        for _ in 0..count {
            match pool.kind {
                0 => pool
                    .quantized
                    .push(core::array::from_fn(|_| source.pick(&[0, 1, -1, i16::MAX, i16::MIN]) ^ source.u16() as i16)),
                1 => pool.exact.push(if source.flag() { source.vector() } else { source.modest_vector() }),
                _ => {
                    let vertex = source.clip_vertex(&clip);
                    clip.push(vertex);
                    pool.homogeneous.push(vertex.map(Scalar::from_bits));
                }
            }
            let word = source.u32();
            let [r, g, b, n] = word.to_le_bytes();
            pool.colors.push([r, g, b]);
            // Unit vectors along an axis or between two, 2.14, and wrong ones.
            pool.normals.push(
                [
                    [1 << 14, 0, 0],
                    [0, -1 << 14, 0],
                    [0, 0, 1 << 14],
                    [11585, 11585, 0],
                    [9459, -9459, 9459],
                    [0; 3],
                    [i16::MIN; 3],
                    [i16::MAX, i16::MIN, i16::MAX],
                ][usize::from(n & 7)],
            );
            pool.uvs.push([source.modest(), if source.flag() { source.modest() } else { source.scalar() }]);
        }
        pool.scale = Scalar::from_bits(source.int().saturating_abs().max(1));
        pool.offset = source.modest_vector();
        let length = source.below(28);
        pool.indices.extend((0..length).map(|_| source.below(count) as u16));
        pool.faces = vec![[0, 0, 1 << 14]; 32];
        pool
    }

    fn positions(&self) -> Positions<'_> {
        match self.kind {
            0 => Positions::Quantized { points: &self.quantized, scale: self.scale, offset: self.offset },
            1 => Positions::Exact(&self.exact),
            _ => Positions::Homogeneous(&self.homogeneous),
        }
    }

    /// The mesh, if the slices make one.
    pub fn mesh(&self) -> Option<Mesh<'_>> {
        let topology = [Topology::Triangles, Topology::Strip, Topology::Fan, Topology::Quads];
        let topology = topology[usize::from(self.topology & 3)];
        let units = match topology {
            Topology::Triangles => self.indices.len() / 3 * 3,
            Topology::Quads => self.indices.len() / 4 * 4,
            _ if self.indices.len() < 3 => 0,
            _ => self.indices.len(),
        };
        let indices = (self.topology & 4 == 0).then_some(&self.indices[..units]);
        let mut data = MeshData {
            topology,
            indices,
            normals: (self.attributes & 1 == 0).then_some(&self.normals[..]),
            colors: (self.attributes & 2 == 0).then_some(&self.colors[..]),
            uvs: (self.attributes & 4 == 0).then_some(&self.uvs[..]),
            ..MeshData::new(self.positions())
        };
        let plain = Mesh::new(data).ok()?;
        if self.attributes & 8 != 0 {
            data.face_normals = Some(self.faces.get(..plain.triangle_count())?);
        }
        Mesh::new(data).ok()
    }

    fn vertices(&self) -> VertexData<'_> {
        VertexData {
            normals: (self.attributes & 1 == 0).then_some(&self.normals[..]),
            colors: (self.attributes & 2 == 0).then_some(&self.colors[..]),
            uvs: (self.attributes & 4 == 0).then_some(&self.uvs[..]),
            ..VertexData::new(self.positions())
        }
    }

    pub fn lines(&self) -> Option<Lines<'_>> {
        let topology = [LineTopology::Pairs, LineTopology::Strip, LineTopology::Loop][usize::from(self.topology % 3)];
        let indices = (self.topology & 4 == 0).then_some(&self.indices[..self.indices.len() / 2 * 2]);
        Lines::new(self.vertices(), topology, indices).ok()
    }

    pub fn points(&self) -> Option<Points<'_>> {
        Points::new(self.vertices()).ok()
    }
}

pub const COMPARES: [Compare; 8] = [
    Compare::Less,
    Compare::LessEqual,
    Compare::Always,
    Compare::Greater,
    Compare::GreaterEqual,
    Compare::Equal,
    Compare::NotEqual,
    Compare::Never,
];

pub fn depth_state(source: &mut Source<'_>) -> DepthState {
    match source.below(4) {
        0 | 1 => DepthState::LESS,
        2 => DepthState::OFF,
        _ => DepthState { compare: source.pick(&COMPARES), write: source.flag() },
    }
}

/// Any state; the default one often.
pub fn state(source: &mut Source<'_>) -> State {
    if source.below(4) == 0 {
        return State { cull: Cull::None, ..State::DEFAULT };
    }
    State {
        cull: source.pick(&[Cull::None, Cull::Back, Cull::Front]),
        front: source.pick(&[Winding::CounterClockwise, Winding::Clockwise]),
        depth: depth_state(source),
        range: source.pick(&[DepthRange::Clip, DepthRange::ClampFar, DepthRange::Clamp]),
        bias: match source.below(3) {
            0 => DepthBias::NONE,
            _ => DepthBias { constant: source.int() as i16, slope: source.scalar() },
        },
        depth_scale: match source.below(3) {
            0 => DepthScale::Uniform { far: source.scalar() },
            _ => DepthScale::Perspective,
        },
    }
}

pub fn color(source: &mut Source<'_>) -> Rgb888 {
    let [r, g, b, _] = source.u32().to_le_bytes();
    Rgb888::new(r, g, b)
}

pub fn width(source: &mut Source<'_>) -> Pixels {
    match source.below(4) {
        0 => Pixels::from_bits(source.int()),
        _ => Pixels::from_bits(i32::from(source.u16() & 0xFFF)),
    }
}

/// What shaders need, made once per input.
pub struct Kit {
    pub color: Rgb888,
    pub byte: u8,
    pub model: Affine,
    pub sunlit: Sunlit,
    pub lit: LitMaterial<1, 0>,
    pub near: LitMaterial<1, 1>,
    pub fog: &'static FogTable,
    pub distances: [i32; 4],
}

static FOGS: [FogTable; 3] = [
    fog(FogCurve::Linear { start: Scalar::ONE, end: Scalar::from_bits(9 << 16) }),
    fog(FogCurve::Exponential { density: Scalar::from_bits(1 << 14) }),
    fog(FogCurve::ExponentialSquared { density: Scalar::from_bits(1 << 14) }),
];

const fn fog(curve: FogCurve) -> FogTable {
    match FogTable::perspective(Scalar::ONE, Scalar::from_bits(10 << 16), curve) {
        Ok(table) => table,
        Err(_) => panic!("near is before far"),
    }
}

const BOUNDS: Bounds = Bounds { center: Vec3::ZERO, half: Vec3::from_ints(2, 2, 2) };

impl Kit {
    pub fn new(source: &mut Source<'_>) -> Self {
        let (color, byte, model) = (self::color(source), source.u8(), source.affine());
        let (direction, other, ambient) = (source.modest_vector(), self::color(source), self::color(source));
        let matte = if byte & 1 == 0 { Matte::new(color) } else { Matte::WHITE.vertex_colors() };
        let glossy = Material::glossy(color, other, byte);
        let glossy = if byte & 2 == 0 { glossy } else { glossy.two_sided() };
        let sun = DirectionalLight::new(direction, other);
        let lamp = PointLight::new(source.modest_vector(), ambient, source.scalar());
        let viewer = if byte & 4 == 0 { Viewer::Toward(source.modest_vector()) } else { Viewer::At(source.vector()) };
        let lighting = Lighting { ambient, directional: [sun], points: [lamp], viewer };
        Self {
            color,
            byte,
            model,
            sunlit: Sun::new(direction, other, ambient).on(&matte, &model),
            lit: Lighting::directional(ambient, [sun]).on(glossy, &model, &BOUNDS),
            near: lighting.on(glossy, &model, &BOUNDS),
            fog: &FOGS[usize::from(byte % 3)],
            distances: core::array::from_fn(|_| source.int()),
        }
    }
}

const fn ramp() -> [[u16; 8]; 4] {
    let mut texels = [[0; 8]; 4];
    let mut k = 0;
    while k < 32 {
        texels[k / 8][k % 8] = (k as u16).wrapping_mul(0x0843) ^ 0x1234;
        k += 1;
    }
    texels
}
static TEXELS: [[u16; 8]; 4] = ramp();
static BYTES: [u8; 96] = {
    let mut bytes = [0; 96];
    let mut k = 0;
    while k < 96 {
        bytes[k] = (k as u8).wrapping_mul(37) ^ 0x5A;
        k += 1;
    }
    bytes
};
static PALETTE: [[u8; 3]; 3] = [[255, 0, 0], [0, 255, 9], [1, 2, 255]];

pub fn tile() -> Tile<'static, 8, 4> {
    Tile::new(&TEXELS)
}

/// The levels of a mipmap: 8×4, 4×2, 2×1.
pub fn levels() -> [Image<'static, Rgb565Texel>; 3] {
    [(8, 4), (4, 2), (2, 1)]
        .map(|(w, h)| Image::new(&BYTES[..(2 * w * h) as usize], Size::new(w, h), Rgb565Texel).expect("an image"))
}

pub fn image() -> Image<'static, Rgb888Texel> {
    Image::new(&BYTES[..3 * 5 * 3], Size::new(5, 3), Rgb888Texel).expect("an image")
}

pub fn indexed() -> Image<'static, PaletteTexel<'static, 2>> {
    Image::new(&BYTES[..14], Size::new(7, 7), PaletteTexel(&PALETTE)).expect("an image")
}

pub fn leaf() -> WithAlpha<'static, Tile<'static, 8, 4>> {
    WithAlpha::new(tile(), &BYTES[..16]).expect("a texture")
}

pub static SPHERE: [[Rgb565Raw; 4]; 4] =
    [[1, 2, 3, 0x0FF0], [0xFFFF, 4, 5, 6], [7, 8, 9, 10], [0x8000, 11, 12, 0xF81F]];
pub type Rgb565Raw = <Rgb565 as zstrip::color::PixelFormat>::Raw;

/// Displaces vertices, cuts by two distances and leaves out by one; shows a perspective-correct value and a linear one.
pub struct Moving<'k>(pub &'k Kit);

impl VertexShader for Moving<'_> {
    type Varyings = Perspective<1, 3>;

    const DISPLACES: bool = true;
    const CLIP_DISTANCES: usize = 2;
    const CULL_DISTANCES: usize = 1;

    fn vertex(&self, vertex: &VertexRef<'_>) -> Perspective<1, 3> {
        let [r, g, _] = vertex.color();
        Perspective::new([i32::from(r) << 20], [i32::from(g) << 16])
    }

    fn displace(&self, vertex: &VertexRef<'_>) -> Vec3 {
        vertex.position() + Vec3::from_bits([i32::from(self.0.byte) << 4; 3])
    }

    fn distances(&self, vertex: &VertexRef<'_>) -> [i32; 4] {
        let [r, g, b] = vertex.color().map(|c| i32::from(c) - 64);
        let [p, q, s, _] = self.0.distances;
        [p.wrapping_mul(r), q.wrapping_add(g << 8), s.wrapping_mul(b), 0]
    }

    fn face(&self, face: &Face<'_>) -> u32 {
        face.index() as u32
    }
}

impl<P: PixelFormat> Shader<P> for Moving<'_> {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, Perspective<1, 3>>) -> Option<P::Raw> {
        let [value] = fragment.varyings.corrected();
        let linear = fragment.varyings.linear().first().copied().unwrap_or_default();
        (fragment.flat % 5 != 4).then(|| P::pack([(value >> 20) as u8, (linear >> 16) as u8, fragment.flat as u8]))
    }
}

/// Number of shaders in [`with_shader`].
pub const SHADERS: usize = 25;

/// Evaluates `$body` with one of the shaders, by number; the last one stands for all greater numbers. The shaders are of
/// different types, so the body is compiled for each.
#[macro_export]
macro_rules! one_of {
    (@$left:ident, |$shader:ident| $body:expr; $last:expr $(,)?) => {{
        let _ = $left;
        let $shader = $last;
        $body
    }};
    (@$left:ident, |$shader:ident| $body:expr; $first:expr, $($rest:expr),+ $(,)?) => {
        if $left == 0 {
            let $shader = $first;
            $body
        } else {
            let $left = $left - 1;
            $crate::one_of!(@$left, |$shader| $body; $($rest),+)
        }
    };
    ($number:expr, |$shader:ident| $body:expr; $($shaders:expr),+ $(,)?) => {{
        let left = $number;
        $crate::one_of!(@left, |$shader| $body; $($shaders),+)
    }};
}

/// Evaluates `$body` with `$shader` being a reference to the shader of this number.
#[macro_export]
macro_rules! with_shader {
    ($number:expr, $kit:expr, |$shader:ident| $body:expr) => {{
        use $crate::things;
        use zstrip::shader::*;
        use zstrip::texture::{Bilinear, Clamp, Mirror};
        let kit: &things::Kit = $kit;
        let (tile, image, indexed, leaf) = (things::tile(), things::image(), things::indexed(), things::leaf());
        let levels = things::levels();
        $crate::one_of!($number, |$shader| $body;
            &Flat::unlit(kit.color),
            &Flat::vertex_colors(),
            &Flat::new(kit.sunlit),
            &Gouraud::vertex_colors(),
            &Gouraud::new(kit.near),
            &Textured::new(&tile),
            &Textured::new(&image).wrap(Clamp).filter(Bilinear),
            &Textured::new(&indexed).wrap(Mirror),
            &Textured::mipmapped(&levels).expect("levels"),
            &Textured::new(&tile).lit(kit.sunlit),
            &Phong::new(kit.lit),
            &PhongNear::new(kit.near),
            &Matcap::<zstrip::embedded_graphics_core::pixelcolor::Rgb565, 4>::new(&things::SPHERE, &kit.model),
            &DepthOnly,
            &Fogged::new(Gouraud::new(kit.sunlit), kit.fog, kit.color),
            &Fogged::new(Textured::new(&tile), kit.fog, kit.color),
            &Blend::new(Flat::unlit(kit.color), Opacity(kit.byte)),
            &Blend::new(Textured::new(&leaf).filter(Bilinear), Alpha),
            &Blend::new(Gouraud::vertex_colors(), Add),
            &Blend::new(Textured::new(&leaf), AddAlpha),
            &Blend::new(Gouraud::vertex_colors(), Multiply),
            &AlphaTest::new(Textured::new(&leaf).wrap(Clamp), kit.byte),
            &ScreenDoor::new(Gouraud::new(kit.sunlit), kit.byte),
            &AlphaToCoverage::new(Textured::new(&leaf).filter(Bilinear)),
            &things::Moving(kit),
        )
    }};
}

/// As [`with_shader`], with those shaders whose loops over pixels differ by format: for other formats than the first,
/// since each shader is compiled for each of them.
#[macro_export]
macro_rules! with_format_shader {
    ($number:expr, $kit:expr, |$shader:ident| $body:expr) => {{
        use $crate::things;
        use zstrip::shader::*;
        use zstrip::texture::{Bilinear, Clamp};
        let kit: &things::Kit = $kit;
        let (tile, image, leaf) = (things::tile(), things::image(), things::leaf());
        $crate::one_of!($number % 8, |$shader| $body;
            &Flat::new(kit.sunlit),
            &Gouraud::vertex_colors(),
            &Textured::new(&tile),
            &Textured::new(&image).wrap(Clamp).filter(Bilinear),
            &Fogged::new(Gouraud::new(kit.sunlit), kit.fog, kit.color),
            &Blend::new(Gouraud::vertex_colors(), Opacity(kit.byte)),
            &Blend::new(Textured::new(&leaf), Alpha),
            &AlphaTest::new(Textured::new(&tile).lit(kit.sunlit), kit.byte),
        )
    }};
}

/// Evaluates `$body` with one of the shaders that lines, points and polygons are drawn with.
#[macro_export]
macro_rules! with_line_shader {
    ($number:expr, $kit:expr, |$shader:ident| $body:expr) => {{
        use $crate::things;
        use zstrip::shader::*;
        let kit: &things::Kit = $kit;
        let tile = things::tile();
        $crate::one_of!($number % 6, |$shader| $body;
            &Flat::unlit(kit.color),
            &Gouraud::vertex_colors(),
            &Textured::new(&tile),
            &Blend::new(Gouraud::vertex_colors(), Opacity(kit.byte)),
            &DepthOnly,
            &ScreenDoor::new(Gouraud::vertex_colors(), kit.byte),
        )
    }};
}
