//! Traits that a user implements, implemented wrongly: textures without texels, framebuffers with rows of any length,
//! varyings and words that are not what they say, spans that shaders hand on after changing them. Pictures may be
//! wrong.

use super::{Extreme, Table};
use crate::reference::rng::Rng;
use zstrip::color::{Dither, DitherWords, Ditherable, Dithered, PixelFormat};
use zstrip::embedded_graphics_core::draw_target::DrawTarget;
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{BinaryColor, Gray8, GrayColor, Rgb565, Rgb888, RgbColor};
use zstrip::embedded_graphics_core::primitives::Rectangle;
use zstrip::frame::{FramebufferRenderer, Renderer};
use zstrip::light::LitColor;
use zstrip::math::{Pixels, Projective, Scalar, Vec3};
use zstrip::mesh::{LineTopology, Lines, Mesh, MeshData, Points, Positions, Topology, Vertices};
use zstrip::scene::{Cull, Scene, ScreenPoint, Smooth, State, Thick, Thin};
use zstrip::shader::{Blend, BlendMode, DepthOnly, Flat, Gouraud, Surface, Textured};
use zstrip::span::{Corrected, DepthTest, Fragment, Primitive, Shader, Span, SpanOf, TriangleSetup};
use zstrip::target::{Depthless, Framebuffer, PackedFormat, Packer, PackerError, Strip, WithDepth, WithRecords};
use zstrip::texture::{
    Bilinear, Clamp, Filter, Gray8Texel, Image, Mirror, Nearest, Repeat, Texture, Tile, WithAlpha, Wrap,
};
use zstrip::vertex::{DepthRange, Face, Perspective, Varyings, VertexRef, VertexShader, Wrapper};

static CORNERS: [[Scalar; 4]; 5] = {
    const fn at(x: i32, y: i32, z: i32, w: i32) -> [Scalar; 4] {
        [Scalar::from_bits(x), Scalar::from_bits(y), Scalar::from_bits(z), Scalar::from_bits(w)]
    }
    [
        at(-65_000, 65_000, 100, 65_536),
        at(-60_000, -50_000, 30_000, 40_000),
        at(65_000, -65_000, 40_000, 80_000),
        at(70_000, 50_000, 65_000, 65_536),
        at(9_000_000, 7, -3000, -65_536),
    ]
};
static UVS: [[Scalar; 2]; 5] =
    [[Scalar::MIN; 2], [Scalar::MAX; 2], [Scalar::ZERO; 2], [Scalar::ONE; 2], [Scalar::MAX; 2]];
static MESH: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Fan,
    uvs: Some(&UVS),
    ..MeshData::new(Positions::Homogeneous(&CORNERS))
});

const BOTH_SIDES: State = State { cull: Cull::None, ..State::DEFAULT };

/// Draws a mesh, lines and points with a shader.
fn draw_with<F: Framebuffer, S: Shader<F::Format>>(scene: &mut Scene<'_, F>, shader: &S) {
    let vertices = Vertices { uvs: Some(&UVS), ..Vertices::new(Positions::Homogeneous(&CORNERS)) };
    let lines = Lines::new(vertices, LineTopology::Loop, None).expect("five vertices");
    let points = Points::new(vertices).expect("five vertices");
    let clamped = State { range: DepthRange::Clamp, ..BOTH_SIDES };
    scene.draw_with(BOTH_SIDES, &MESH, &Projective::IDENTITY, shader);
    scene.draw_with(clamped, &MESH, &Projective::IDENTITY, shader);
    scene.draw_lines_with(BOTH_SIDES, &lines, &Projective::IDENTITY, shader, &Thin);
    scene.draw_lines_with(clamped, &lines, &Projective::IDENTITY, shader, &Thick::px(3));
    scene.draw_lines_with(BOTH_SIDES, &lines, &Projective::IDENTITY, shader, &Smooth::px(2));
    scene.draw_points_with(BOTH_SIDES, &points, &Projective::IDENTITY, shader, Pixels::from_num(3));
}

/// Draws a mesh and smooth lines with a shader.
fn draw_some_with<F: Framebuffer, S: Shader<F::Format>>(scene: &mut Scene<'_, F>, shader: &S) {
    let vertices = Vertices { uvs: Some(&UVS), ..Vertices::new(Positions::Homogeneous(&CORNERS)) };
    let lines = Lines::new(vertices, LineTopology::Loop, None).expect("five vertices");
    for range in [DepthRange::Clip, DepthRange::Clamp] {
        scene.draw_with(State { range, ..BOTH_SIDES }, &MESH, &Projective::IDENTITY, shader);
    }
    scene.draw_lines_with(BOTH_SIDES, &lines, &Projective::IDENTITY, shader, &Smooth::px(2));
}

/// The strips of a frame with a depth buffer and records.
type RecordedStrip<'s, P> = Strip<'s, P, WithDepth, WithRecords>;

/// Draws frames with each number of records and each strip height.
fn recorded<P: PixelFormat>(
    table: &mut Table,
    name: &'static str,
    draw: &mut dyn FnMut(&mut Scene<'_, RecordedStrip<'_, P>>),
) {
    for records in [0, 30, 1000] {
        for rows in [1, 16] {
            table.case(name, (records, rows), || {
                let mut color = vec![P::pack([0; 3]); 24 * rows];
                let (mut depth, mut records) = (vec![0; 24 * rows], vec![0; records]);
                let renderer = Renderer::<P>::new(Size::new(24, 16)).expect("a screen");
                let renderer = renderer.with_depth(&mut depth).expect("a strip");
                let mut renderer = renderer.with_records(&mut records);
                let mut frame = renderer.begin(Rgb888::BLACK);
                while let Ok(Some(_)) = frame.next_strip(&mut color, &mut *draw) {}
            });
        }
    }
}

/// Draws frames of a mesh and of smooth lines with a shader. The other primitives are the same for all shaders and
/// formats but for the loops over pixels.
fn meshes_with<P: PixelFormat, S: Shader<P>>(table: &mut Table, name: &'static str, shader: &S) {
    recorded::<P>(table, name, &mut |scene| draw_some_with(scene, shader));
}

/// Draws frames of all kinds of primitives with a shader: with records, and by a renderer without records and depths.
fn frames_with<P: PixelFormat, S: Shader<P>>(table: &mut Table, name: &'static str, shader: &S) {
    recorded::<P>(table, name, &mut |scene| draw_with(scene, shader));
    for rows in [1, 16] {
        table.case(name, rows, || {
            let mut color = vec![P::pack([0; 3]); 24 * rows];
            let mut renderer = Renderer::<P>::new(Size::new(24, 16)).expect("a screen");
            let mut frame = renderer.begin(Rgb888::BLACK);
            while let Ok(Some(_)) = frame.next_strip(&mut color, |scene| draw_with(scene, shader)) {}
        });
    }
}

/// A texture of any size, which is not that of its texels: there are none.
struct NoTexels(Size);

impl Texture for NoTexels {
    fn size(&self) -> Size {
        self.0
    }

    fn rgba(&self, x: u32, y: u32) -> [u8; 4] {
        [x as u8, y as u8, 3, x as u8]
    }

    fn pixel<P: PixelFormat>(&self, x: u32, y: u32) -> Option<P::Raw> {
        Some(P::pack([x as u8, y as u8, 3]))
    }
}

/// A rule for borders that leaves the texture.
#[derive(Clone, Copy)]
struct Beyond;

impl Wrap for Beyond {
    fn fraction(coordinate: i32) -> u32 {
        coordinate as u32
    }

    fn texel(number: i32, _: u32) -> u32 {
        !(number as u32)
    }
}

#[test]
fn textures_of_no_texels_and_of_too_many_are_sampled() {
    let (mut table, mut rng) = (Table::start(), Rng::new(201));
    static IMAGE: [u8; 12] = [7; 12];
    let image = Image::new(&IMAGE, Size::new(3, 4), Gray8Texel).expect("12 texels");
    let sizes = [0, 1, 65_535, 65_536, u32::MAX];
    for (width, height) in sizes.into_iter().flat_map(|w| sizes.map(|h| (w, h))) {
        let texture = NoTexels(Size::new(width, height));
        for _ in 0..300 {
            let uv = [rng.bits(), rng.bits()];
            table.case("Bilinear", (width, height, uv), || Bilinear::rgba::<_, Repeat>(&texture, uv));
            table.case("Bilinear", (width, height, uv), || Bilinear::pixel::<Rgb565, _, Mirror>(&texture, uv));
            table.case("Bilinear", (width, height, uv), || Bilinear::pixel::<Rgb888, _, Clamp>(&texture, uv));
            table.case("Bilinear", (width, height, uv), || Bilinear::rgba::<_, Beyond>(&texture, uv));
            table.case("Nearest", (width, height, uv), || Nearest::rgba::<_, Clamp>(&texture, uv));
            table.case("Nearest", (width, height, uv), || Nearest::rgba::<_, Beyond>(&texture, uv));
            table.case("Image beyond", uv, || Bilinear::rgba::<_, Beyond>(&image, uv));
            table.case("Texture::fetch", uv, || texture.fetch::<Rgb565>(uv[0] as u32));
        }
        frames_with::<Rgb565, _>(&mut table, "Textured", &Textured::new(&texture));
        meshes_with::<Rgb565, _>(&mut table, "Textured, bilinear", &Textured::new(&texture).filter(Bilinear));
        meshes_with::<Rgb565, _>(&mut table, "Textured, mirrored", &Textured::new(&texture).wrap(Mirror));
        meshes_with::<Rgb565, _>(&mut table, "Textured, beyond", &Textured::new(&image).wrap(Beyond).filter(Bilinear));
        let half = |size: u32| (size / 2).max(1);
        let levels = [NoTexels(Size::new(width, height)), NoTexels(Size::new(half(width), half(height)))];
        let levels = Textured::mipmapped(&levels).expect("half the size");
        meshes_with::<Rgb565, _>(&mut table, "Textured, mipmapped", &levels);
        let alpha = [0x77; 64];
        table.case("WithAlpha::new", (), || WithAlpha::new(NoTexels(Size::new(width, height)), &alpha).is_ok());
    }
    table.finish();
}

/// A framebuffer whose rows have any length, and which does not say the truth about the order of rows.
struct Ragged {
    pixels: Vec<u16>,
    lengths: [usize; 5],
    joined: bool,
}

impl Framebuffer for Ragged {
    type Format = Rgb565;

    fn row(&mut self, y: u32) -> &mut [u16] {
        let length = self.lengths[y as usize % 5];
        &mut self.pixels[..length]
    }

    fn span(&mut self, y: u32, _: usize, _: usize) -> &mut [u16] {
        self.row(y + 1)
    }

    fn rows(&mut self, first_row: u32, _: usize) -> Option<&mut [u16]> {
        if self.joined { Some(self.row(first_row + 2)) } else { None }
    }
}

#[test]
fn framebuffers_of_rows_of_any_length_are_drawn_into() {
    let (mut table, mut rng) = (Table::start(), Rng::new(202));
    for _ in 0..400 {
        let lengths: [usize; 5] = core::array::from_fn(|_| rng.pick(&[0, 1, 5, 23, 24, 25, 100, 384, 1000]));
        let joined = rng.one_in(2);
        let records = rng.pick(&[0, 100, 1000]);
        table.case("a ragged framebuffer", (lengths, joined, records), || {
            let (mut depth, mut records) = (vec![0; 24 * rng.pick(&[1, 5, 16])], vec![0; records]);
            let mut target = Ragged { pixels: vec![0; 1000], lengths, joined };
            let renderer = FramebufferRenderer::new(Size::new(24, 16)).expect("a screen");
            let mut renderer = renderer.with_depth(&mut depth).expect("a row").with_records(&mut records);
            let area = Rectangle::new(Point::new(-3, -2), Size::new(20, 9));
            let everything = |scene: &mut Scene<'_, Ragged>| {
                draw_with(scene, &Flat::unlit(Rgb888::RED));
                draw_with(scene, &Gouraud::vertex_colors());
                draw_with(scene, &Colored::<5>);
                scene.overlay().fill_solid(&area, Rgb565::RED).expect("no error");
                // More colours than there is time to pass over.
                scene.overlay().fill_contiguous(&area, core::iter::repeat_with(|| Rgb565::RED)).expect("no error");
                scene.at_depth(700).clear(Rgb565::BLUE).expect("no error");
                scene.canvas().rectangle(&area, Rgb888::GREEN);
                let [a, b, c] = [(1, 1), (23, 4), (3, 15)].map(|(x, y)| ScreenPoint::corner(x, y));
                scene.canvas().polygon(&[a, b, c], Rgb888::GREEN);
                scene.canvas().line_with(a, b, Rgb888::GREEN, &Smooth::px(4));
            };
            renderer.frame(&mut target, Rgb888::BLACK, everything).expect("the scene is one");
            let mut depthless = Depthless(target);
            let mut renderer = FramebufferRenderer::new(Size::new(24, 16)).expect("a screen");
            let draw = |scene: &mut Scene<'_, Depthless<Ragged>>| draw_with(scene, &Gouraud::vertex_colors());
            renderer.frame(&mut depthless, Rgb888::BLACK, draw).expect("the scene is one");
        });
    }
    table.finish();
}

/// A shader of extreme values everywhere, with `N` varyings.
struct Colored<const N: usize>;

impl<const N: usize> VertexShader for Colored<N> {
    type Varyings = [i32; N];

    const DISPLACES: bool = true;
    const CLIP_DISTANCES: usize = 2;
    const CULL_DISTANCES: usize = 2;

    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; N] {
        [[i32::MIN, i32::MAX, 0, -1, 1 << 30][vertex.index() % 5]; N]
    }

    fn displace(&self, vertex: &VertexRef<'_>) -> Vec3 {
        Vec3::from_bits([[i32::MIN, i32::MAX, 0, -50_000, 40_000][vertex.index() % 5]; 3])
    }

    fn distances(&self, vertex: &VertexRef<'_>) -> [i32; 4] {
        [[i32::MIN; 4], [i32::MAX; 4], [0; 4], [-1; 4], [i32::MAX; 4]][vertex.index() % 5]
    }

    fn face(&self, face: &Face<'_>) -> u32 {
        face.corners().iter().fold(face.index() as u32, |sum, corner| sum ^ corner.uv()[0].to_bits() as u32)
    }
}

impl<P: PixelFormat, const N: usize> Shader<P> for Colored<N> {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, [i32; N]>) -> Option<P::Raw> {
        let c = fragment.varyings.first().copied().unwrap_or(0);
        (c & 1 == 0).then(|| P::pack_at([c as u8; 3], fragment.position))
    }
}

/// Varyings that hold another number of values than they say, and perspective that may not be there.
#[derive(Clone, Copy)]
struct Liar<const SAYS: usize, const CORRECTED: usize>([i32; 4]);

impl<const S: usize, const C: usize> AsRef<[i32]> for Liar<S, C> {
    fn as_ref(&self) -> &[i32] {
        &self.0[..if self.0[0] & 1 == 0 { 1 } else { 3 }]
    }
}

impl<const S: usize, const C: usize> AsMut<[i32]> for Liar<S, C> {
    fn as_mut(&mut self) -> &mut [i32] {
        &mut self.0
    }
}

impl<const SAYS: usize, const CORRECTED: usize> Varyings for Liar<SAYS, CORRECTED> {
    const LEN: usize = SAYS;
    const ZERO: Self = Self([i32::MIN; 4]);
    const PERSPECTIVE: usize = CORRECTED;
    type PerspectiveSetup = <Perspective<2, 3> as Varyings>::PerspectiveSetup;
}

struct Lying<const SAYS: usize, const CORRECTED: usize>;

impl<const SAYS: usize, const CORRECTED: usize> VertexShader for Lying<SAYS, CORRECTED> {
    type Varyings = Liar<SAYS, CORRECTED>;

    fn vertex(&self, vertex: &VertexRef<'_>) -> Self::Varyings {
        let n = vertex.index() as i32;
        Liar([i32::MAX - n, n << 29, i32::MIN + n, 5 * n])
    }

    fn store(varyings: &Self::Varyings, words: &mut [u32]) {
        words.fill(!(varyings.0[1] as u32));
    }
}

impl<P: PixelFormat, const S: usize, const C: usize> Shader<P> for Lying<S, C> {
    const STEP: usize = 8;
    type Setup = i32;

    fn setup(&self, triangle: &TriangleSetup<'_, Liar<S, C>>) -> i32 {
        triangle.corners.iter().fold(0, |sum: i32, corner| sum.wrapping_add(corner.0[0]))
    }

    fn fragment(&self, fragment: &Fragment<'_, Liar<S, C>, i32>) -> Option<P::Raw> {
        Some(P::pack([*fragment.setup as u8, fragment.varyings.0[1] as u8, 7]))
    }
}

/// Coordinates whose 1 / w is any number.
struct AnyW(i32);

impl VertexShader for AnyW {
    type Varyings = Perspective<2, 3>;

    fn vertex(&self, vertex: &VertexRef<'_>) -> Perspective<2, 3> {
        Perspective::new(vertex.uv().map(Scalar::to_bits), [])
    }

    fn store(varyings: &Perspective<2, 3>, words: &mut [u32]) {
        for (word, value) in words.iter_mut().zip(varyings.as_ref()) {
            *word = *value as u32;
        }
    }

    fn load(words: &[u32]) -> Perspective<2, 3> {
        let mut varyings = Perspective::new([words[0] as i32, words[1] as i32], []);
        varyings.set_inverse_w((words[2] as i32).wrapping_mul(ANY_W) as u32);
        varyings
    }
}

/// A factor that makes another number of each 1 / w, and 0 of some.
const ANY_W: i32 = 1 << 27;

impl<P: PixelFormat> Shader<P> for AnyW {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, Perspective<2, 3>>) -> Option<P::Raw> {
        let [u, v] = fragment.varyings.corrected();
        Some(P::pack([u as u8, v as u8, self.0 as u8]))
    }

    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, _: D) {
        // Any numbers in the planes, and any way along them.
        for n in [i32::MIN, -1, 0, 1, self.0, i32::MAX] {
            let mut primitive: Primitive<Perspective<2, 3>> = *span.primitive;
            for (place, value) in primitive.at_origin.as_mut().iter_mut().zip([n, !n, 0]) {
                *place = value;
            }
            let mut corrected = Corrected::new(&primitive, (n, self.0));
            for way in [i32::MAX, n, 0, i32::MIN] {
                corrected.advance(way);
                let [u, v] = corrected.varyings().corrected();
                if let Some(pixel) = span.color.first() {
                    let _ = (u, v, pixel, primitive.at((n, way)));
                }
            }
        }
    }
}

/// A shader that changes spans before it hands them on.
struct Mangled<S>(S, u32);

impl<S: VertexShader> Wrapper for Mangled<S> {
    type Inner = S;

    fn inner(&self) -> &S {
        &self.0
    }
}

impl<P: PixelFormat, S: Shader<P>> Shader<P> for Mangled<S> {
    const STEP: usize = S::STEP;
    type Setup = S::Setup;

    fn setup(&self, triangle: &TriangleSetup<'_, S::Varyings>) -> S::Setup {
        self.0.setup(triangle)
    }

    fn fragment(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>) -> Option<P::Raw> {
        let position = (i32::MAX, i32::MIN);
        self.0.fragment(&Fragment { position, depth: 0, flat: !fragment.flat, ..*fragment })
    }

    fn span<D: DepthTest>(&self, span: SpanOf<'_, P, Self, D>, test: D) {
        let Span { color, depth, z, position, primitive } = span;
        let mut rng = Rng::new(u64::from(self.1) << 32 | u64::from(z));
        let mut other = *primitive;
        if rng.one_in(2) {
            other.dz_dx = rng.bits();
            other.flat = rng.bits() as u32;
            for values in [&mut other.at_origin, &mut other.d_dx, &mut other.d_dy] {
                values.as_mut().iter_mut().for_each(|value| *value = rng.bits());
            }
        }
        let position = if rng.one_in(2) { position } else { (rng.bits(), rng.bits()) };
        let (colors, depths) = (rng.below(color.len() as u64 + 1), rng.below(depth.len() as u64 + 1));
        // More colours than depths, or fewer.
        let (color, depth) =
            if rng.one_in(2) { (&mut color[..colors as usize], depth) } else { (color, &mut depth[..depths as usize]) };
        let z = if rng.one_in(2) { z } else { rng.bits() as u32 };
        self.0.span(Span { color, depth, z, position, primitive: &other }, test);
    }
}

struct Painted;

impl Surface for Painted {
    fn vertex(&self, vertex: &VertexRef<'_>) -> LitColor {
        LitColor::new([i32::MIN, i32::MAX, vertex.index() as i32])
    }
}

struct Inverted;

impl<P: PixelFormat> BlendMode<P> for Inverted {
    type Source = P;

    fn blend(&self, source: P::Raw, there: P::Raw) -> P::Raw {
        P::mix(there, source, u32::MAX)
    }
}

static TEXELS: [[u16; 8]; 4] = [[0x1234; 8]; 4];
static SMALL: Tile<'static, 8, 4> = Tile::new(&TEXELS);

fn mangled_in<P: PixelFormat>(table: &mut Table, seed: u32) {
    meshes_with::<P, _>(table, "Flat, mangled", &Mangled(Flat::new(Painted), seed));
    meshes_with::<P, _>(table, "Gouraud, mangled", &Mangled(Gouraud::new(Painted), seed));
    meshes_with::<P, _>(table, "Textured, mangled", &Mangled(Textured::new(&SMALL), seed));
    meshes_with::<P, _>(table, "Textured, clamped, mangled", &Mangled(Textured::new(&SMALL).wrap(Clamp), seed));
    meshes_with::<P, _>(table, "Textured, lit, mangled", &Mangled(Textured::new(&SMALL).lit(Painted), seed));
    let blend = Blend::new(Gouraud::new(Painted), Inverted);
    meshes_with::<P, _>(table, "Blend, mangled", &Mangled(blend, seed));
    meshes_with::<P, _>(table, "DepthOnly, mangled", &Mangled(DepthOnly, seed));
    meshes_with::<P, _>(table, "a shader of 5 varyings, mangled", &Mangled(Colored::<5>, seed));
}

#[test]
fn spans_that_a_shader_changed_are_drawn() {
    let mut table = Table::start();
    for seed in 0..3 {
        mangled_in::<Rgb565>(&mut table, seed);
        let mangled = Mangled(Textured::new(&SMALL).lit(Painted), seed);
        frames_with::<Rgb565, _>(&mut table, "every primitive, mangled", &mangled);
        mangled_in::<Gray8>(&mut table, seed);
        mangled_in::<Rgb888>(&mut table, seed);
        mangled_in::<Dithered<Rgb565>>(&mut table, seed);
    }
    table.finish();
}

#[test]
fn varyings_that_are_not_what_they_say_are_interpolated() {
    let mut table = Table::start();
    frames_with::<Rgb565, _>(&mut table, "3 varyings", &Colored::<3>);
    frames_with::<Rgb565, _>(&mut table, "12 varyings", &Colored::<12>);
    frames_with::<Rgb565, _>(&mut table, "varyings of no length", &Lying::<0, 0>);
    frames_with::<Rgb565, _>(&mut table, "varyings of another length", &Lying::<2, 0>);
    frames_with::<Rgb565, _>(&mut table, "as much perspective as fits", &Lying::<3, 2>);
    frames_with::<Rgb565, _>(&mut table, "longer than they are", &Lying::<200, 2>);
    for n in [0, 1, -1, i32::MIN, i32::MAX] {
        frames_with::<Rgb565, _>(&mut table, "any 1 / w", &AnyW(n));
        frames_with::<Rgb565, _>(&mut table, "any 1 / w, by fragments", &ByFragments(AnyW(n)));
    }
    table.finish();
}

/// A shader whose spans are drawn fragment by fragment.
struct ByFragments<S>(S);

impl<S: VertexShader> Wrapper for ByFragments<S> {
    type Inner = S;

    fn inner(&self) -> &S {
        &self.0
    }
}

impl<P: PixelFormat, S: Shader<P>> Shader<P> for ByFragments<S> {
    type Setup = S::Setup;

    fn fragment(&self, fragment: &Fragment<'_, S::Varyings, S::Setup>) -> Option<P::Raw> {
        self.0.fragment(fragment)
    }
}

/// A format of greys that says it dithers to any number of bits.
#[derive(Clone, Copy, Debug)]
struct Odd;

impl PixelFormat for Odd {
    type Raw = u16;
    type Color = Gray8;

    fn pack([r, ..]: [u8; 3]) -> u16 {
        u16::from(r) * 257
    }

    fn unpack(raw: u16) -> [u8; 3] {
        [raw as u8, 255, 0]
    }

    const DITHER: Option<[u32; 3]> = Some([0, 40, u32::MAX]);
    const IS_LUMA: bool = true;
    const PACKED: bool = true;

    fn dither(_: (i32, i32)) -> &'static [u32; 8] {
        &[u32::MAX; 8]
    }

    fn from_color(color: Gray8) -> u16 {
        color.luma().into()
    }

    fn to_color(raw: u16) -> Gray8 {
        Gray8::new(raw as u8)
    }
}

impl Ditherable for Odd {
    const BITS: [u32; 3] = [9, 0, 33];
    const WORDS: &'static DitherWords = &[[u32::MAX; 16]; 8];
}

#[test]
fn formats_that_contradict_themselves_are_drawn_in() {
    let mut table = Table::start();
    mangled_in::<Odd>(&mut table, 3);
    mangled_in::<Dithered<Odd>>(&mut table, 4);
    frames_with::<Odd, _>(&mut table, "an odd format", &Gouraud::new(Painted));
    meshes_with::<Dithered<Odd>, _>(&mut table, "an odd format", &Gouraud::new(Painted));
    meshes_with::<Odd, _>(&mut table, "an odd format", &Flat::new(Painted));
    table.finish();
}

/// A packed format without rows.
#[derive(Debug)]
struct Nowhere;

impl PackedFormat for Nowhere {
    type Color = BinaryColor;
    const ROWS: u16 = 0;

    fn bytes(_: u16, rows: u16) -> usize {
        if rows > 8 { usize::MAX } else { 0 }
    }

    fn pack<P: PixelFormat>(_: &Dither<BinaryColor>, _: &[P::Raw], _: usize, _: i32, _: &mut [u8]) {}
}

#[test]
fn packed_formats_without_rows_are_refused_or_give_nothing() {
    let mut bytes = [0; 4];
    let size = Size::new(8, 16);
    let partial = Packer::<Nowhere>::new(size, 8, Dither::NEAREST, &mut bytes);
    assert!(matches!(partial, Err(PackerError::PartialPages { rows: 8, page: 0 })));
    let long = Packer::<Nowhere>::new(size, 16, Dither::NEAREST, &mut bytes);
    assert!(matches!(long, Err(PackerError::TooShort { bytes: 4, needed: usize::MAX })));
    let mut packer = Packer::<Nowhere>::new(Size::new(8, 8), 8, Dither::NEAREST, &mut bytes).expect("no bytes");
    let mut renderer = Renderer::<Gray8>::new(size).expect("a screen");
    let mut color = [0; 8 * 16];
    let strip = renderer.begin(Rgb888::WHITE).next_strip(&mut color, |_| ()).expect("a strip").expect("a strip");
    // The strip is larger than the packer was made for.
    assert_eq!(packer.pack(&strip), [0; 4]);
}
