//! The materials whose costs are fitted.

use super::grids::{Memory, draw_by};
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::pixelcolor::Rgb888;
use zstrip::light::{DirectionalLight, Lighting, LitMaterial, Material, Matte, Sun, Sunlit, Viewer};
use zstrip::math::{Affine, Projective, Scalar, Vec3};
use zstrip::mesh::Mesh;
use zstrip::shader::{Blend, Flat, FogCurve, FogTable, Fogged, Gouraud, Opacity, Phong, Textured};
use zstrip::target::{Stats, StripPixels};
use zstrip::texture::Tile;

/// A material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Flat,
    Gouraud,
    Textured,
    LitTextured,
    PerFace,
    PerVertex,
    PerFragment,
    Fogged,
    Blended,
}

pub const KINDS: [(&str, Kind); 9] = [
    ("flat", Kind::Flat),
    ("gouraud", Kind::Gouraud),
    ("textured", Kind::Textured),
    ("lit_textured", Kind::LitTextured),
    ("lit_per_face", Kind::PerFace),
    ("lit_per_vertex", Kind::PerVertex),
    ("lit_per_fragment", Kind::PerFragment),
    ("fogged", Kind::Fogged),
    ("blended", Kind::Blended),
];

const SUN: Sun = Sun::from_channels(Vec3::from_ints(1, 2, 4), [220, 220, 200], [30; 3]);
const ORANGE: Sunlit = SUN.on(&Matte::from_channels([255, 160, 64]), &Affine::IDENTITY);
const WHITE: Sunlit = SUN.on(&Matte::from_channels([255; 3]), &Affine::IDENTITY);

/// Sides of the texture.
pub const TEXELS: u32 = 64;
const SIDE: usize = TEXELS as usize;

static PIXELS: [[u16; SIDE]; SIDE] = {
    let mut texels = [[0xFFFF; SIDE]; SIDE];
    let mut k = 0;
    while k < SIDE * SIDE {
        texels[k / SIDE][k % SIDE] = (k * 37) as u16;
        k += 1;
    }
    texels
};
static TILE: Tile<'static, SIDE, SIDE> = Tile::new(&PIXELS);

static MIST: FogTable = match FogTable::perspective(
    Scalar::ONE,
    Scalar::from_bits(16 << 16),
    FogCurve::Exponential { density: Scalar::from_bits(1 << 13) },
) {
    Ok(table) => table,
    Err(_) => panic!("near and far"),
};

/// One directional light and highlights, the viewer far away.
fn glossy(mesh: &Mesh<'_>) -> LitMaterial<1, 0> {
    let sun = DirectionalLight { direction: Vec3::from_ints(1, 2, 4), color: Rgb888::new(220, 220, 200) };
    let lighting =
        Lighting { ambient: Rgb888::new(30, 30, 30), directional: [sun], points: [], viewer: Viewer::Toward(Vec3::Z) };
    let material = Material::glossy(Rgb888::new(200, 100, 50), Rgb888::new(250, 250, 250), 32);
    lighting.on(material, &Affine::IDENTITY, mesh.bounds())
}

impl Kind {
    /// Materials whose work differs, because other triangles of them are small.
    #[cfg(not(target_os = "none"))]
    pub const COUNTED: [Self; 3] = [Self::Flat, Self::Textured, Self::LitTextured];

    /// Returns the number in [`COUNTED`](Self::COUNTED) of the material whose work this one has.
    #[cfg(not(target_os = "none"))]
    pub fn counted(self) -> usize {
        Self::COUNTED.iter().position(|&kind| kind == self).unwrap_or(0)
    }

    /// Draws a mesh in each place.
    pub fn draw<P: PixelFormat>(
        self,
        memory: Memory<'_, P>,
        sink: &mut dyn FnMut(&StripPixels<'_, P>),
        mesh: &Mesh<'_>,
        places: &[Projective],
    ) -> Stats {
        match self {
            Self::Flat => draw_by(memory, sink, &Flat::new(ORANGE), mesh, places),
            Self::Gouraud => draw_by(memory, sink, &Gouraud::new(ORANGE), mesh, places),
            Self::Textured => draw_by(memory, sink, &Textured::new(&TILE), mesh, places),
            Self::LitTextured => draw_by(memory, sink, &Textured::new(&TILE).lit(WHITE), mesh, places),
            Self::PerFace => draw_by(memory, sink, &Flat::new(glossy(mesh)), mesh, places),
            Self::PerVertex => draw_by(memory, sink, &Gouraud::new(glossy(mesh)), mesh, places),
            Self::PerFragment => draw_by(memory, sink, &Phong::new(glossy(mesh)), mesh, places),
            Self::Fogged => {
                let mist = Fogged::new(Gouraud::new(ORANGE), &MIST, Rgb888::new(200, 200, 200));
                draw_by(memory, sink, &mist, mesh, places)
            }
            Self::Blended => draw_by(memory, sink, &Blend::new(Gouraud::new(ORANGE), Opacity(100)), mesh, places),
        }
    }
}
