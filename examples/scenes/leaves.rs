//! Leaves on a sunny ground: cut out of squares by alpha that becomes coverage of samples.

use super::kept::{Kept, kept_list};
use super::textured::{GROUND, floor_levels};
use super::{Draw, camera, draw_apart};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
use zstrip::shader::{AlphaToCoverage, Textured};
use zstrip::texture::{Bilinear, Clamp, Tile, WithAlpha};
use zstrip::{Cull, Framebuffer, Scene, State};

/// Number of texels along each side of the leaf's texture.
const SIDE: usize = 32;

/// Returns how far a texel is inside of the leaf, in halves of a texel: below 0 outside, 18 at most. The blade lies
/// between two arcs, and the stem runs along the middle.
const fn inside(x: usize, y: usize) -> i32 {
    let (x, y) = (2 * x as i32 - 31, 2 * y as i32 - 31);
    // Half of the width at this height: a parabola, with teeth.
    let half = (29 * 29 - (y + 4) * (y + 4)) / 48 + [0, 1, 2, 0][(y + 33) as usize / 2 % 4];
    let blade = half - x.abs();
    let stem = if y > 12 && y < 31 { 2 - x.abs() } else { -9 };
    if blade > stem { blade } else { stem }
}

/// Greens, lighter along the veins.
static GREENS: [[u16; SIDE]; SIDE] = {
    let mut texels = [[0; SIDE]; SIDE];
    let mut k = 0;
    while k < SIDE * SIDE {
        let (x, y) = (k % SIDE, k / SIDE);
        let across = (2 * x as i32 - 31).abs();
        let vein = across < 3 || (y as i32 + across / 3) % 6 == 0;
        let [r, g, b] = if vein { [19, 50, 8] } else { [7, 34 + (x * 5 + y * 3) as u16 % 5, 4] };
        texels[y][x] = r << 11 | g << 5 | b;
        k += 1;
    }
    texels
};

/// Alpha of the leaf, 4 bits per texel: it falls within two texels around the border.
static ALPHAS: [u8; SIDE * SIDE / 2] = {
    let mut bytes = [0; SIDE * SIDE / 2];
    let mut k = 0;
    while k < SIDE * SIDE {
        let ramp = 8 + 6 * inside(k % SIDE, k / SIDE);
        let alpha = if ramp < 0 {
            0
        } else if ramp > 15 {
            15
        } else {
            ramp as u8
        };
        bytes[k / 2] |= alpha << (4 - 4 * (k % 2));
        k += 1;
    }
    bytes
};

/// A square with sides of 1 that stands on the ground, with the whole texture on it.
static SQUARE: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    uvs: Some(&[
        [Scalar::ZERO, Scalar::ONE],
        [Scalar::ONE, Scalar::ONE],
        [Scalar::ONE, Scalar::ZERO],
        [Scalar::ZERO, Scalar::ZERO],
    ]),
    ..MeshData::new(Positions::Exact(&[
        Vec3::from_milli(-500, 0, 0),
        Vec3::from_milli(500, 0, 0),
        Vec3::from_milli(500, 1000, 0),
        Vec3::from_milli(-500, 1000, 0),
    ]))
});

const LEAVES: usize = 40;

/// Leaves around the viewer's point of interest.
pub struct Leaves {
    ground: Projective,
    leaves: Kept<[Projective]>,
}

impl Leaves {
    pub fn new(screen: Size, turn: Angle16) -> Self {
        let camera = camera(screen, Scalar::from_bits(1 << 14), Scalar::from_bits(24 << 16));
        let view = Affine::rotation_x(Angle16::from_degrees(22))
            * Affine::translation(Vec3::from_milli(0, -1500, -3400))
            * Affine::rotation_y(turn);
        let leaf = |k: usize| {
            // Leaves stand along a spiral, each of them turned and inclined in its own way.
            let k = k as i32;
            let around = Angle16::from_degrees(137 * k);
            let place = Affine::rotation_y(around) * Affine::translation(Vec3::from_milli(0, 0, 250 + 45 * k));
            let inclined = Affine::rotation_x(Angle16::from_degrees(-10 - 3 * (k % 9)));
            let turned = Affine::rotation_y(Angle16::from_degrees(71 * k));
            camera * (view * place * turned * inclined * Affine::rotation_z(Angle16::from_degrees(k * 29 % 50 - 25)))
        };
        Self { ground: camera * view, leaves: kept_list(LEAVES, leaf) }
    }
}

impl<F: Framebuffer> Draw<F> for Leaves {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        if let Ok(ground) = Textured::mipmapped(floor_levels()) {
            draw_apart(scene, State::DEFAULT, &GROUND, &self.ground, &ground);
        }
        let Ok(texture) = WithAlpha::new(Tile::new(&GREENS), &ALPHAS) else { return };
        let shader = AlphaToCoverage::new(Textured::new(&texture).wrap(Clamp).filter(Bilinear));
        // Leaves are seen from both sides, and drawn in any order.
        let state = State { cull: Cull::None, ..State::DEFAULT };
        for mvp in &*self.leaves {
            draw_apart(scene, state, &SQUARE, mvp, &shader);
        }
    }
}
