//! A street of houses and trees, seen through the window of a room: nearly all of it is hidden by the wall. Things are
//! drawn from near to far, or the other way round.

use super::kept::{Kept, kept_list};
use super::{Draw, LIGHT, camera, draw_apart, torus};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::Rgb888;
use zstrip::light::{Material, Sunlit};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
use zstrip::shader::Flat;
use zstrip::{Framebuffer, Scene, State};

const fn at(x: i32, y: i32, z: i32) -> Vec3 {
    Vec3::from_milli(x, y, z)
}

/// A wall around a window of a tenth of the picture.
static WALL: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    indices: Some(&[0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7]),
    ..MeshData::new(Positions::Exact(&[
        at(-4000, -3000, 0),
        at(4000, -3000, 0),
        at(4000, 4000, 0),
        at(-4000, 4000, 0),
        at(-1300, -350, 0),
        at(-500, -350, 0),
        at(-500, 450, 0),
        at(-1300, 450, 0),
    ]))
});

/// A house: walls, gables and a roof.
static HOUSE: Mesh<'static> = Mesh::constant(MeshData {
    indices: Some(&[
        0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7, 4, 5, 8, 6, 7, 9, 5, 6, 9, 5, 9, 8, 7,
        4, 8, 7, 8, 9,
    ]),
    ..MeshData::new(Positions::Exact(&[
        at(-1000, 0, 1000),
        at(1000, 0, 1000),
        at(1000, 0, -1000),
        at(-1000, 0, -1000),
        at(-1000, 1500, 1000),
        at(1000, 1500, 1000),
        at(1000, 1500, -1000),
        at(-1000, 1500, -1000),
        at(0, 2500, 1000),
        at(0, 2500, -1000),
    ]))
});

/// Things in a row across the street: two houses and a tree on each side, and another tree in the middle.
const ACROSS: usize = 7;
/// Rows, from near to far.
const ROWS: usize = 7;

/// Colours of houses, of trees and of the wall.
const COLORS: [[u8; 3]; 5] = [[200, 110, 90], [210, 190, 150], [140, 160, 200], [90, 190, 90], [196, 170, 120]];
const TREE: usize = 3;
const ROOM_WALL: usize = 4;

/// The street, from inside of a room or from outside.
pub struct Street {
    shaders: [Flat<Sunlit>; COLORS.len()],
    wall: Option<Projective>,
    things: Kept<[Projective]>,
    /// Set if things are drawn from far to near, so that nothing is hidden by what is drawn before.
    far_first: bool,
}

/// Returns whether a thing is a tree, and not a house.
const fn is_tree(number: usize) -> bool {
    number % ACROSS % 2 == 1
}

impl Street {
    /// Makes the street as the room's window shows it.
    pub fn behind_a_wall(screen: Size, turn: Angle16) -> Self {
        Self::new(screen, turn, true)
    }

    /// Makes the street without the room.
    pub fn open(screen: Size, turn: Angle16) -> Self {
        Self::new(screen, turn, false)
    }

    /// Makes the street without the room, to be drawn from far to near.
    pub fn far_first(screen: Size, turn: Angle16) -> Self {
        Self { far_first: true, ..Self::open(screen, turn) }
    }

    fn new(screen: Size, turn: Angle16, walled: bool) -> Self {
        // It looks to and fro, by 20 degrees.
        let sway = Angle16((turn.sin().to_bits() / 18) as u16);
        let view = Affine::rotation_y(sway) * Affine::translation(at(0, -1300, 0));
        let eye = camera(screen, Scalar::from_bits(1 << 14), Scalar::from_bits(48 << 16)) * view;
        // Trees are upright rings.
        let (upright, size) = (Affine::rotation_x(Angle16::from_degrees(60)), Affine::scale(Scalar::from_bits(39_322)));
        let mut shaders =
            COLORS.map(|[r, g, b]| Flat::new(LIGHT.on(&Material::matte(Rgb888::new(r, g, b)), &Affine::IDENTITY)));
        let [r, g, b] = COLORS[TREE];
        shaders[TREE] = Flat::new(LIGHT.on(&Material::matte(Rgb888::new(r, g, b)), &upright));
        let wall = walled.then(|| eye * Affine::translation(at(0, 1300, -2000)));
        let things = kept_list(ROWS * ACROSS, |k| {
            let place = at(2400 * ((k % ACROSS) as i32 - 3), 0, -6000 - 4000 * (k / ACROSS) as i32);
            if is_tree(k) {
                eye * (Affine::translation(place + at(0, 900, 0)) * upright * size)
            } else {
                eye * Affine::translation(place)
            }
        });
        Self { shaders, wall, things, far_first: false }
    }
}

impl<F: Framebuffer> Draw<F> for Street {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        if let Some(mvp) = &self.wall {
            draw_apart(scene, State::DEFAULT, &WALL, mvp, &self.shaders[ROOM_WALL]);
        }
        let last = self.things.len().saturating_sub(1);
        for step in 0..=last {
            let k = if self.far_first { last - step } else { step };
            let Some(mvp) = self.things.get(k) else { return };
            let (mesh, shader) = if is_tree(k) { (&torus::MESH, TREE) } else { (&HOUSE, k % 3) };
            draw_apart(scene, State::DEFAULT, mesh, mvp, &self.shaders[shader]);
        }
    }
}
