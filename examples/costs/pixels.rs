//! A pixel of each material, blend mode and kind of fog: frames whose screen one square fills. A new row is a line in
//! [`ROWS`].

use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
use zstrip::light::{DirectionalLight, Lighting, LitMaterial, Material, Matte, PointLight, Sun, Sunlit, Viewer};
use zstrip::math::{Affine, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
use zstrip::shader::{
    Add, AddAlpha, Alpha, AlphaTest, Blend, Flat, FogCurve, FogTable, Fogged, Gouraud, Matcap, Multiply, Opacity,
    Phong, PhongNear, ScreenDoor, Textured,
};
use zstrip::span::{DepthState, Shader};
use zstrip::target::{Strip, WithDepth, WithRecords};
use zstrip::texture::{Bilinear, Clamp, Image, Mirror, PaletteTexel, Rgb888Texel, TexelFormat, Tile};
use zstrip::{Scene, State};

type S<'s, 'a, 'p> = &'s mut Scene<'a, Strip<'p, Rgb565, WithDepth, WithRecords>>;

/// Name of a row, and what is drawn for it.
pub type Row = (&'static str, fn(S<'_, '_, '_>));

pub const ROWS: &[Row] = &[
    ("nothing", |_| {}),
    ("`Flat`", |s| square(s, &flat())),
    ("`Gouraud`", |s| square(s, &GOURAUD)),
    ("`Matcap`", |s| square(s, &Matcap::<Rgb565, 64>::new(&BALL, &Affine::IDENTITY))),
    ("`Textured`, nearest, repeated, w constant", |s| square(s, &Textured::new(&TILE))),
    ("the same in perspective", |s| floor(s, &Textured::new(&TILE))),
    ("mirrored", |s| floor(s, &Textured::new(&TILE).wrap(Mirror))),
    ("clamped", |s| floor(s, &Textured::new(&TILE).wrap(Clamp))),
    ("bilinear", |s| floor(s, &Textured::new(&TILE).filter(Bilinear))),
    ("nearest, RGB888", |s| image(s, Rgb888Texel, |s, t| floor(s, &Textured::new(t)))),
    ("bilinear, RGB888", |s| image(s, Rgb888Texel, |s, t| floor(s, &Textured::new(t).filter(Bilinear)))),
    ("nearest, palette of 8 bits", |s| {
        image(s, PaletteTexel::<8>(&[[200, 100, 50]; 256]), |s, t| floor(s, &Textured::new(t)));
    }),
    ("nearest, lit", |s| floor(s, &Textured::new(&TILE).lit(light()))),
    ("bilinear, lit", |s| floor(s, &Textured::new(&TILE).filter(Bilinear).lit(light()))),
    ("`Blend` of it, nearest, `Opacity`", |s| floor(s, &Blend::new(Textured::new(&TILE), Opacity(100)))),
    ("`Phong`, 1 directional light, matte", |s| square(s, &far::<1>(0))),
    ("the same, 2 directional lights", |s| square(s, &far::<2>(0))),
    ("1 directional light, glossy, shininess 32", |s| square(s, &far::<1>(32))),
    ("the same, shininess 255", |s| square(s, &far::<1>(255))),
    ("`PhongNear`, 1 point light, matte", |s| square(s, &near(0, Viewer::Toward(Vec3::Z)))),
    ("the same, glossy, shininess 32", |s| square(s, &near(32, Viewer::Toward(Vec3::Z)))),
    ("the same, viewer near", |s| square(s, &near(32, Viewer::At(Vec3::from_ints(0, 0, 3))))),
    ("`Blend` of `Flat`, `Opacity`", |s| glass(s, &Blend::new(flat(), Opacity(100)))),
    ("`Blend` of `Gouraud`, `Opacity`", |s| glass(s, &Blend::new(GOURAUD, Opacity(100)))),
    ("the same, `Alpha`", |s| glass(s, &Blend::new(GOURAUD, Alpha))),
    ("the same, `Add`", |s| glass(s, &Blend::new(GOURAUD, Add))),
    ("the same, `AddAlpha`", |s| glass(s, &Blend::new(GOURAUD, AddAlpha))),
    ("the same, `Multiply`", |s| glass(s, &Blend::new(GOURAUD, Multiply))),
    ("`AlphaTest` of `Gouraud`", |s| square(s, &AlphaTest::new(GOURAUD, 128))),
    ("`ScreenDoor` of `Gouraud`, half of the pixels", |s| square(s, &ScreenDoor::new(GOURAUD, 8))),
    ("`Fogged` `Flat`", |s| square(s, &Fogged::new(flat(), &MIST, Rgb888::new(200, 200, 200)))),
    ("`Fogged` `Gouraud`", |s| square(s, &Fogged::new(GOURAUD, &MIST, Rgb888::new(200, 200, 200)))),
];

const GOURAUD: Gouraud = Gouraud::vertex_colors();

fn flat() -> Flat {
    Flat::unlit(Rgb888::new(200, 100, 50))
}

static CORNERS: [Vec3; 4] = [
    Vec3::from_milli(-1000, -1000, 250),
    Vec3::from_milli(1000, -1000, 250),
    Vec3::from_milli(1000, 1000, 750),
    Vec3::from_milli(-1000, 1000, 750),
];
static SQUARE: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    normals: Some(&[[-6553, -6553, 13_503], [6553, -6553, 13_503], [6553, 6553, 13_503], [-6553, 6553, 13_503]]),
    colors: Some(&[[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]]),
    ..MeshData::new(Positions::Exact(&CORNERS))
});

/// The same square, its upper side twice as far away.
static FLOOR: Mesh<'static> = {
    const fn corner(x: i32, y: i32, w: i32) -> [Scalar; 4] {
        let half = Scalar::from_bits(w << 15);
        [Scalar::from_bits((x * w) << 16), Scalar::from_bits((y * w) << 16), half, Scalar::from_bits(w << 16)]
    }
    const CORNERS: [[Scalar; 4]; 4] = [corner(-1, -1, 1), corner(1, -1, 1), corner(1, 1, 2), corner(-1, 1, 2)];
    const fn at(u: i32, v: i32) -> [Scalar; 2] {
        [Scalar::from_bits(u << 16), Scalar::from_bits(v << 16)]
    }
    Mesh::constant(MeshData {
        topology: Topology::Quads,
        normals: Some(&[[0, 0, 16_384]; 4]),
        uvs: Some(&[at(0, 4), at(4, 4), at(6, 0), at(-2, 0)]),
        ..MeshData::new(Positions::Homogeneous(&CORNERS))
    })
};

static TEXELS: [[u16; 64]; 64] = [[0x1234; 64]; 64];
static TILE: Tile<'static, 64, 64> = Tile::new(&TEXELS);
static BYTES: [u8; 3 * 64 * 64] = [77; 3 * 64 * 64];

fn floor(scene: S<'_, '_, '_>, shader: &impl Shader<Rgb565>) {
    scene.draw(&FLOOR, &Projective::IDENTITY, shader);
}

/// Draws with a texture of 64 x 64 texels.
fn image<T: TexelFormat>(scene: S<'_, '_, '_>, format: T, draw: impl FnOnce(S<'_, '_, '_>, &Image<'_, T>)) {
    let bytes = BYTES.get(..64 * 64 * T::BITS / 8).unwrap_or_default();
    if let Ok(image) = Image::new(bytes, Size::new(64, 64), format) {
        draw(scene, &image);
    }
}

fn light() -> Sunlit {
    let sun = Sun::new(Vec3::from_ints(1, 2, 4), Rgb888::new(220, 220, 200), Rgb888::new(30, 30, 30));
    sun.on(&Matte::WHITE, &Affine::IDENTITY)
}

static BALL: [[u16; 64]; 64] = [[0x1234; 64]; 64];

static MIST: FogTable = match FogTable::perspective(
    Scalar::ONE,
    Scalar::from_bits(20 << 16),
    FogCurve::Exponential { density: Scalar::from_bits(1 << 13) },
) {
    Ok(table) => table,
    Err(_) => panic!("near and far"),
};

fn square(scene: S<'_, '_, '_>, shader: &impl Shader<Rgb565>) {
    scene.draw(&SQUARE, &Projective::IDENTITY, shader);
}

/// Tested against depth, without leaving it.
fn glass(scene: S<'_, '_, '_>, shader: &impl Shader<Rgb565>) {
    let state = State { depth: DepthState::TEST, ..State::DEFAULT };
    scene.draw_with(state, &SQUARE, &Projective::IDENTITY, shader);
}

fn material(shininess: u8) -> Material {
    Material::glossy(Rgb888::new(200, 100, 50), Rgb888::new(250, 250, 250), shininess)
}

const SUN: DirectionalLight =
    DirectionalLight { direction: Vec3::from_ints(1, 2, 4), color: Rgb888::new(220, 220, 200) };

fn on<const D: usize, const P: usize>(lighting: Lighting<D, P>, shininess: u8) -> LitMaterial<D, P> {
    lighting.on(material(shininess), &Affine::IDENTITY, SQUARE.bounds())
}

fn far<const D: usize>(shininess: u8) -> Phong<D> {
    let lighting = Lighting {
        ambient: Rgb888::new(30, 30, 30),
        directional: [SUN; D],
        points: [],
        viewer: Viewer::Toward(Vec3::Z),
    };
    Phong::new(on(lighting, shininess))
}

fn near(shininess: u8, viewer: Viewer) -> PhongNear<0, 1> {
    let lamp = PointLight {
        position: Vec3::from_ints(0, 0, 2),
        color: Rgb888::new(220, 220, 200),
        range: Scalar::from_bits(5 << 16),
    };
    let lighting = Lighting { ambient: Rgb888::new(30, 30, 30), directional: [], points: [lamp], viewer };
    PhongNear::new(on(lighting, shininess))
}
