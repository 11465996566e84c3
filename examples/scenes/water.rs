//! Water: waves by a vertex shader, a crate that floats on them.

use super::{Draw, LIGHT, camera, draw_apart, textured};
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::light::{Matte, Sunlit};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
use zstrip::shader::{LitTexture, Textured};
use zstrip::span::{Fragment, Shader};
use zstrip::texture::Tile;
use zstrip::vertex::{VertexRef, VertexShader};
use zstrip::{Framebuffer, Scene, State};

/// Squares each way, of 1/4 each.
const SQUARES: usize = 32;
const POINTS: usize = (SQUARES + 1) * (SQUARES + 1);

type Grid = ([Vec3; POINTS], [u16; 4 * SQUARES * SQUARES]);

static GRID: Grid = {
    let (mut points, mut quads) = ([Vec3::ZERO; POINTS], [0; 4 * SQUARES * SQUARES]);
    let mut k = 0;
    while k < POINTS {
        let (x, z) = ((k % (SQUARES + 1)) as i32 - SQUARES as i32 / 2, (k / (SQUARES + 1)) as i32 - SQUARES as i32 / 2);
        points[k] = Vec3::from_bits([x << 14, 0, z << 14]);
        k += 1;
    }
    let mut k = 0;
    while k < SQUARES * SQUARES {
        let first = (k / SQUARES * (SQUARES + 1) + k % SQUARES) as u16;
        let below = first + SQUARES as u16 + 1;
        (quads[4 * k], quads[4 * k + 1], quads[4 * k + 2], quads[4 * k + 3]) = (below, below + 1, first + 1, first);
        k += 1;
    }
    (points, quads)
};

/// A level surface; the shader makes the waves.
pub static SURFACE: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    indices: Some(&GRID.1),
    ..MeshData::new(Positions::Exact(&GRID.0))
});

/// Two waves that cross: how far one has come, and how high they are.
#[derive(Clone, Copy, Debug)]
pub struct Water {
    pub time: Angle16,
    /// Height of a wave, 16.16.
    pub height: i32,
}

impl Water {
    /// Height and slopes (along x, along z) at a place, 16.16.
    fn wave(self, x: i32, z: i32) -> (i32, i32, i32) {
        // Angles of the waves: turns of 2 and 3 units, to directions of their own.
        let first = Angle16((x / 2 + z / 5) as u16) + self.time + self.time;
        let second = Angle16((z / 3 - x / 6) as u16) + self.time + self.time + self.time;
        let times = |a: Scalar, height: i32| ((i64::from(a.to_bits()) * i64::from(height)) >> 16) as i32;
        // Slopes: 2π times height over wave length.
        let (up, also) = (times(first.cos(), self.height), times(second.cos(), self.height));
        (
            times(first.sin(), self.height) + times(second.sin(), self.height / 2),
            up * 22 / 7 - also * 11 / 21,
            up * 44 / 35 + also * 22 / 21,
        )
    }
}

impl VertexShader for Water {
    /// The light that comes back, and the share of the sky that is mirrored: 8.16.
    type Varyings = [i32; 2];

    const DISPLACES: bool = true;

    fn displace(&self, corner: &VertexRef<'_>) -> Vec3 {
        let [x, y, z] = corner.position().to_bits();
        Vec3::from_bits([x, y + self.wave(x, z).0, z])
    }

    fn vertex(&self, corner: &VertexRef<'_>) -> [i32; 2] {
        let [x, _, z] = corner.position().to_bits();
        let (height, along_x, along_z) = self.wave(x, z);
        // The light comes from the right and from the front: slopes that face it are bright.
        let lit = (130 << 16) - along_x * 160 + along_z * 130 + height * 220;
        let sky = (110 << 16) + along_z * 260;
        [lit.clamp(0, 255 << 16), sky.clamp(0, 255 << 16)]
    }
}

impl<P: PixelFormat> Shader<P> for Water {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, [i32; 2]>) -> Option<P::Raw> {
        let [lit, sky] = fragment.varyings.map(|c| (c >> 16).clamp(0, 255));
        // Glints where it is brightest.
        let glint = (lit - 215).max(0) * 5;
        let channel = |base: i32, share: i32| (base * lit / 256 + sky * share / 256 + glint).clamp(0, 255) as u8;
        Some(P::pack([channel(20, 60), channel(130, 100), channel(200, 130)]))
    }
}

/// Water, and a crate on it that goes up and down with the waves and leans with their slopes.
pub struct Sea {
    water: Water,
    /// World → clip space.
    surface: Projective,
    /// Object space of the crate → clip space.
    crate_mvp: Projective,
    wood: LitTexture<'static, Tile<'static, 32, 32>, Sunlit>,
}

impl Sea {
    /// Makes water with waves of a height in tenths.
    pub fn new(screen: Size, time: Angle16, tenths: i32) -> Self {
        let water = Water { time, height: tenths * 6554 };
        let surface = camera(screen, Scalar::from_bits(1 << 14), Scalar::from_bits(16 << 16))
            * (Affine::rotation_x(Angle16::from_degrees(24)) * Affine::translation(Vec3::from_milli(0, -1400, -3000)));
        let model = crate_model(water);
        Self {
            water,
            surface,
            crate_mvp: surface * model,
            wood: Textured::new(&textured::WOODEN).lit(LIGHT.on(&Matte::WHITE, &model)),
        }
    }
}

/// Returns where the crate is.
fn crate_model(water: Water) -> Affine {
    let (height, along_x, along_z) = water.wave(0, 0);
    let leaning =
        Affine::rotation_z(Angle16((along_x / 8) as u16)) * Affine::rotation_x(Angle16((along_z / -8) as u16));
    Affine::translation(Vec3::from_bits([0, height + (1 << 14), 0]))
        * leaning
        * Affine::rotation_y(Angle16::from_degrees(30))
}

impl<F: Framebuffer> Draw<F> for Sea {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        draw_apart(scene, State::DEFAULT, &SURFACE, &self.surface, &self.water);
        draw_apart(scene, State::DEFAULT, &textured::CRATE, &self.crate_mvp, &self.wood);
    }
}
