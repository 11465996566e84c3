//! The state of small triangles that is carried on from strip to strip: the picture is the same as without, whatever
//! the shader, the format, the height of strips and the room for states; and triangles are set up once.

use crate::reference::rng::Rng;
use core::cell::Cell;
use core::fmt::Debug;
use zstrip::color::{Dithered, PixelFormat};
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565, Rgb888};
use zstrip::light::Unlit;
use zstrip::math::{Projective, Scalar};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::prelude::*;
use zstrip::shader::{Blend, Flat, Gouraud, Opacity, Textured};
use zstrip::span::{DepthBias, DepthState, Fragment, Shader, TriangleSetup};
use zstrip::target::{DepthChoice, RecordsChoice, Strip, records_len};
use zstrip::texture::Tile;
use zstrip::vertex::{Perspective, VertexRef, VertexShader, Viewport};

/// Width and height of the screen.
const SIDE: usize = 64;
const SCREEN: Size = Size::new(SIDE as u32, SIDE as u32);

static TEXELS: [[u16; 16]; 16] = {
    let mut texels = [[0; 16]; 16];
    let mut k = 0;
    while k < 256 {
        texels[k / 16][k % 16] = (k * 257) as u16;
        k += 1;
    }
    texels
};
static TILE: Tile<'static, 16, 16> = Tile::new(&TEXELS);

/// A mesh of random triangles.
struct Soup {
    corners: Vec<[Scalar; 4]>,
    colors: Vec<[u8; 3]>,
    uvs: Vec<[Scalar; 2]>,
}

impl Soup {
    /// Triangles of up to `size` / 256 px; whole, half and odd coordinates. Unless all are `easy`, some are steep or
    /// reach out of the screen.
    fn new(rng: &mut Rng, count: usize, size: i32, easy: bool) -> Self {
        let mut soup = Self { corners: Vec::new(), colors: Vec::new(), uvs: Vec::new() };
        for k in 0..count {
            let border = if easy { size / 2 } else { 0 };
            let middle = [(); 2].map(|()| rng.between(border, 256 * SIDE as i32 - border));
            let (grid, z) = ([1, 128, 256][k % 3], rng.between(0, 65_535));
            for _ in 0..3 {
                let at = middle.map(|c| (c + rng.between(-size / 2, size / 2)) / grid * grid);
                // 1 / 32 of the cube per pixel, 8 units of 16.16 per 1/256 px.
                let [x, y] = at.map(|c| Scalar::from_bits(8 * c - 65_536));
                let depth = if !easy && k % 5 == 0 { rng.between(0, 65_535) } else { z + rng.between(-300, 300) };
                soup.corners.push([x, y, Scalar::from_bits(depth.clamp(0, 65_535)), Scalar::ONE]);
                soup.colors.push([0; 3].map(|_: u8| rng.between(0, 255) as u8));
                soup.uvs.push([0; 2].map(|_: i32| Scalar::from_bits(rng.between(-20_000, 20_000))));
            }
        }
        soup
    }

    fn mesh(&self) -> Mesh<'_> {
        let data = MeshData::new(Positions::Homogeneous(&self.corners));
        Mesh::new(MeshData { colors: Some(&self.colors), uvs: Some(&self.uvs), ..data }).expect("a mesh")
    }
}

/// A frame in strips, as high as the buffer.
fn picture<P: PixelFormat, D: DepthChoice, R: RecordsChoice>(
    renderer: &mut Renderer<'_, P, D, R>,
    strip: &mut [P::Raw],
    mut draw: impl FnMut(&mut Scene<'_, Strip<'_, P, D, R>>),
) -> Vec<P::Raw> {
    let (mut frame, mut pixels) = (renderer.begin(Rgb888::new(9, 99, 199)), Vec::new());
    while let Some(strip) = frame.next_strip(strip, &mut draw).expect("the same scene each time") {
        pixels.extend_from_slice(strip.pixels());
    }
    pixels
}

/// Words beside those that triangles and vertices take: none, a state or two, many.
const ROOM: [usize; 4] = [0, 30, 200, 20_000];

/// Draws a scene by a shader in one strip, and in strips with the state of triangles carried on.
fn same<P: PixelFormat<Raw: PartialEq + Debug>, S: Shader<P>>(
    case: &str,
    soup: &Soup,
    state: State,
    shader: &S,
) -> usize {
    let (mesh, count) = (&soup.mesh(), soup.corners.len());
    let viewports = [Viewport::full(SCREEN), Viewport::new(Point::new(-3, 5), Size::new(60, 50))];
    let viewport = viewports[count % 2].expect("a viewport");
    // Two draws share the words.
    let half = Projective::from_affine(&Affine::scale(Scalar::from_num(0.5)));
    let mut color = vec![P::pack([0; 3]); SIDE * SIDE];
    let mut depth = vec![0; SIDE * SIDE];
    let renderer = Renderer::<P>::new(SCREEN).expect("a renderer").with_depth(&mut depth).expect("depths");
    let mut plain = renderer.with_records(&mut []);
    let expected = picture(&mut plain, &mut color, |scene| {
        scene.set_viewport(viewport);
        scene.draw_with(state, mesh, &Projective::IDENTITY, shader);
        scene.draw_with(state, mesh, &half, &Flat::vertex_colors());
    });
    for (k, rows) in [1, 2, 3, 4, 7, 16].into_iter().enumerate() {
        let strips = SIDE.div_ceil(rows);
        let words = records_len(strips, 2, 2 * count, S::WORDS.max(1), 2 * count / 3);
        let mut records = vec![0xDEAD_BEEF; words + ROOM[(k + count) % 4]];
        let renderer = Renderer::<P>::new(SCREEN).expect("a renderer").with_depth(&mut depth).expect("depths");
        let mut carrying = renderer.with_records(&mut records).with_carried_state();
        for frame in 0..2 {
            let found = picture(&mut carrying, &mut color[..SIDE * rows], |scene| {
                scene.set_viewport(viewport);
                scene.draw_with(state, mesh, &Projective::IDENTITY, shader);
                scene.draw_with(state, mesh, &half, &Flat::vertex_colors());
            });
            let differing = found.iter().zip(&expected).filter(|(a, b)| a != b).count();
            assert!(found == expected, "{case}: {differing} px differ in strips of {rows} rows, frame {frame}");
        }
    }
    expected.iter().filter(|pixel| **pixel != expected[0]).count()
}

/// Three varyings that are linear on the screen, by `fragment`; counts the triangles that are set up.
struct Own<'c>(&'c Cell<usize>);

impl VertexShader for Own<'_> {
    type Varyings = [i32; 3];

    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 3] {
        vertex.color().map(|c| i32::from(c) * 0xFF00 + 0x4000)
    }
}

impl<P: PixelFormat> Shader<P> for Own<'_> {
    type Setup = ();

    fn setup(&self, _: &TriangleSetup<'_, [i32; 3]>) {
        self.0.set(self.0.get() + 1);
    }

    fn fragment(&self, fragment: &Fragment<'_, [i32; 3]>) -> Option<P::Raw> {
        let [r, g, b] = fragment.varyings.map(|c| (c >> 16) as u8);
        Some(P::pack(if fragment.side == zstrip::vertex::Side::Back { [b, r, g] } else { [r, g, b] }))
    }
}

/// Perspective-correct varyings, by `fragment`.
struct OwnTexture;

impl VertexShader for OwnTexture {
    type Varyings = Perspective<2, 6>;

    const IS_TOLERANT: bool = true;

    fn tolerance(&self) -> u32 {
        64
    }

    fn vertex(&self, vertex: &VertexRef<'_>) -> Perspective<2, 6> {
        Perspective::new(vertex.uv().map(|c| c.to_bits()), vertex.color().map(|c| i32::from(c) << 16))
    }
}

impl<P: PixelFormat> Shader<P> for OwnTexture {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, Perspective<2, 6>>) -> Option<P::Raw> {
        let ([u, v], linear) = (fragment.varyings.corrected(), fragment.varyings.linear());
        let [r, g, b] = [linear[0], linear[1], linear[2]];
        let part = |c: i32, uv: i32| ((c >> 17) + (uv >> 9 & 0x7F)).clamp(0, 255) as u8;
        Some(P::pack([part(r, u), part(g, v), part(b, u + v)]))
    }
}

fn all_shaders<P: PixelFormat<Raw: PartialEq + Debug>>(format: &str) {
    let seed = 11;
    let mut rng = Rng::new(seed);
    let test = DepthState { write: false, ..DepthState::LESS };
    let bias = DepthBias { constant: -40, slope: Scalar::from_num(2) };
    let states = [
        State { cull: Cull::None, ..State::default() },
        State { depth: DepthState::LESS_EQUAL, bias, ..State::default() },
        State { cull: Cull::Front, depth: test, ..State::default() },
        State { cull: Cull::None, depth: DepthState::OFF, ..State::default() },
    ];
    let mut drawn = 0;
    for (case, size) in [200, 900, 2500, 6000, 6500, 15_000].into_iter().enumerate() {
        let soup = Soup::new(&mut rng, 20 + case, size, false);
        for (k, state) in states.into_iter().enumerate() {
            let case = |shader: &str| format!("{format}, {shader}, seed {seed}, {size}/256 px, state {k}");
            let count = Cell::new(0);
            drawn += same::<P, _>(&case("flat"), &soup, state, &Flat::vertex_colors());
            same::<P, _>(&case("Gouraud"), &soup, state, &Gouraud::vertex_colors());
            same::<P, _>(&case("textured"), &soup, state, &Textured::new(&TILE));
            same::<P, _>(&case("lit"), &soup, state, &Textured::new(&TILE).lit(Unlit::vertex_colors()));
            same::<P, _>(&case("blended"), &soup, state, &Blend::new(Gouraud::vertex_colors(), Opacity(100)));
            same::<P, _>(&case("own"), &soup, state, &Own(&count));
            same::<P, _>(&case("own texture"), &soup, state, &OwnTexture);
        }
    }
    assert!(drawn > 8_000, "{drawn} px");
}

#[test]
fn pictures_are_the_same_in_rgb565() {
    all_shaders::<Rgb565>("Rgb565");
}

#[test]
fn pictures_are_the_same_in_gray8() {
    all_shaders::<Gray8>("Gray8");
}

#[test]
fn pictures_are_the_same_dithered() {
    all_shaders::<Dithered<Rgb565>>("Dithered<Rgb565>");
}

/// With room, each triangle is set up once, however many strips it touches, and the picture is that of one strip;
/// without, once per strip.
#[test]
fn triangles_are_set_up_once() {
    let soup = Soup::new(&mut Rng::new(3), 60, 4000, true);
    let (mesh, mut color, mut depth) = (soup.mesh(), vec![0; SIDE * SIDE], vec![0; SIDE * SIDE]);
    let state = State { cull: Cull::None, ..State::default() };
    let renderer = Renderer::<Rgb565>::new(SCREEN).expect("a renderer").with_depth(&mut depth).expect("depths");
    let expected = picture(&mut renderer.with_records(&mut []), &mut color, |scene| {
        scene.draw_with(state, &mesh, &Projective::IDENTITY, &Own(&Cell::new(0)));
    });
    let mut times = [0; 2];
    for (times, room) in times.iter_mut().zip([20_000, 0]) {
        let count = Cell::new(0);
        let mut records = vec![0; records_len(SIDE / 2, 1, 180, 3, 60) + room];
        let renderer = Renderer::<Rgb565>::new(SCREEN).expect("a renderer").with_depth(&mut depth).expect("depths");
        let mut renderer = renderer.with_records(&mut records).with_carried_state();
        let found = picture(&mut renderer, &mut color[..SIDE * 2], |scene| {
            scene.draw_with(state, &mesh, &Projective::IDENTITY, &Own(&count));
        });
        assert!(found == expected, "another picture with {room} words of room");
        *times = count.get();
    }
    let [with_room, without] = times;
    assert!(with_room <= 60 && without > 3 * 60, "set up {with_room} times with room, {without} times without");
}
