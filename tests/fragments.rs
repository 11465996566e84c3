//! The programmable fragment stage: what a shader of one's own sees, and what it can do.

use crate::reference::rng::Rng;
use crate::support::{scalar, strips, whole};
use std::cell::RefCell;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
use zstrip::internals::{PixelRect, Projected, Transform, signed_area, spans};
use zstrip::math::{Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::span::{Compare, DepthState, Fragment, Shader};
use zstrip::target::Strip;
use zstrip::target::{WithDepth, WithRecords};
use zstrip::vertex::{Face, Side, Varyings, VertexRef, VertexShader, Viewport};
use zstrip::{Cull, Scene, State, Winding};

const SCREEN: (u16, u16) = (32, 32);

/// Two triangles that fill the view, without projection; the first shows its front, the second its back.
static CORNERS: [Vec3; 4] =
    [Vec3::from_ints(-1, -1, 0), Vec3::from_ints(1, -1, 0), Vec3::from_ints(1, 1, 1), Vec3::from_ints(-1, 1, 1)];
static SQUARE: Mesh<'static> =
    Mesh::constant(MeshData { indices: Some(&[0, 1, 2, 0, 3, 2]), ..MeshData::new(Positions::Exact(&CORNERS)) });

/// As many varyings as there are, in one colour.
struct Varied<const N: usize>;

impl<const N: usize> VertexShader for Varied<N>
where
    [i32; N]: Varyings,
{
    type Varyings = [i32; N];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; N] {
        core::array::from_fn(|k| (k as i32) << 16)
    }
}

impl<const N: usize> Shader<Rgb565> for Varied<N>
where
    [i32; N]: Varyings,
{
    type Setup = ();

    fn fragment(&self, _: &Fragment<'_, [i32; N]>) -> Option<u16> {
        Some(1)
    }
}

/// Rows are walked in one way for few varyings, and in another for many: both cover what [`spans`] says.
/// A closure that draws a scene of strips.
type DrawScene<'d> = dyn Fn(&mut Scene<'_, Strip<'_, Rgb565, WithDepth, WithRecords>>) + 'd;

#[test]
fn every_walk_covers_the_pixels_of_the_rasterizer() {
    let mut rng = Rng::new(77);
    let viewport = Viewport::full(Size::new(SCREEN.0.into(), SCREEN.1.into())).expect("a viewport");
    let mut covered = 0;
    for case in 0..400 {
        let reach = [1.2, 0.3, 5.0][case % 3];
        let points = [(); 3].map(|()| Vec3::new(scalar(&mut rng, reach), scalar(&mut rng, reach), Scalar::ZERO));
        let mesh = Mesh::new(MeshData::new(Positions::Exact(&points))).expect("a triangle");
        let transform = Transform::new(&Projective::IDENTITY, &viewport, &mesh, false);
        let v = points.map(|point| match transform.project_clip_vertex(&transform.point(point)) {
            Projected::OnScreen(vertex) => vertex,
            Projected::NeedsClip(code) => panic!("{point:?} is outside: {code:?}"),
        });
        let mut expected = vec![0; 32 * 32];
        spans(&v, signed_area(&v[0], &v[1], &v[2]), &PixelRect { x: 0..32, y: 0..32 }, |y, x| {
            x.for_each(|x| expected[(32 * y + x) as usize] = 1);
        });
        covered += expected.iter().filter(|pixel| **pixel == 1).count();
        for depth in [DepthState::OFF, DepthState::LESS, DepthState { compare: Compare::LessEqual, write: true }] {
            let state = State { cull: Cull::None, depth, ..State::DEFAULT };
            for rows in [32, 7] {
                let draw = |draw: &DrawScene| strips::<Rgb565>(SCREEN, rows, 200, Rgb565::BLACK, |scene| draw(scene)).0;
                let few = draw(&|scene| scene.draw_with(state, &mesh, &Projective::IDENTITY, &Varied::<1>));
                let many = draw(&|scene| scene.draw_with(state, &mesh, &Projective::IDENTITY, &Varied::<5>));
                assert_eq!(few, expected, "case {case}, {depth:?}, {rows} rows: {v:?}");
                assert_eq!(many, expected, "case {case}, {depth:?}, {rows} rows: {v:?}");
            }
        }
    }
    assert!(covered > 20_000, "{covered} pixels");
}

/// x, y, depth, side and the face's word.
type Seen = (i32, i32, u16, Side, u32);

/// Colours every other pixel, in a chequered pattern, with 1 and discards the others; notes what it has seen.
#[derive(Default)]
struct Chequers(RefCell<Vec<Seen>>);

impl VertexShader for Chequers {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }

    fn face(&self, face: &Face<'_>) -> u32 {
        face.index() as u32 | u32::from(face.side() == Side::Back) << 16
    }
}

impl Shader<Rgb565> for Chequers {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<u16> {
        let (x, y) = fragment.position;
        self.0.borrow_mut().push((x, y, fragment.depth, fragment.side, fragment.flat));
        ((x + y) % 2 == 0).then_some(1)
    }
}

#[test]
fn discarded_fragments_leave_colour_and_depth() {
    let tests = [
        DepthState::LESS,
        DepthState { compare: Compare::LessEqual, write: true },
        DepthState { compare: Compare::Always, write: true },
        DepthState { compare: Compare::Always, write: false },
    ];
    for depth in tests {
        let state = State { cull: Cull::None, depth, ..State::DEFAULT };
        let shader = Chequers::default();
        let (color, z, _) =
            whole::<Rgb565>(SCREEN, Rgb565::BLACK, |s| s.draw_with(state, &SQUARE, &Projective::IDENTITY, &shader));
        for (k, (color, z)) in color.iter().zip(z).enumerate() {
            let (x, y) = (k as i32 % 32, k as i32 / 32);
            let kept = (x + y) % 2 == 0;
            assert_eq!(*color, u16::from(kept), "({x}, {y}) {depth:?}");
            assert_eq!(z != u16::MAX, kept && depth.write, "({x}, {y}) {depth:?}");
        }
    }
}

#[test]
fn fragments_know_where_they_are_and_which_side_is_seen() {
    for front in [Winding::CounterClockwise, Winding::Clockwise] {
        let state = State { cull: Cull::None, front, ..State::DEFAULT };
        let shader = Chequers::default();
        let (_, z, _) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| {
            scene.draw_with(state, &SQUARE, &Projective::IDENTITY, &shader);
        });
        let mut seen = shader.0.into_inner();
        assert_eq!(seen.len(), 32 * 32);
        for &(x, y, depth, side, face) in &seen {
            let is_back = (face & 1 == 1) == (front == Winding::CounterClockwise);
            assert_eq!(face >> 16, u32::from(is_back), "({x}, {y}) {front:?}");
            assert_eq!(side == Side::Back, is_back, "({x}, {y}) {front:?}");
            if (x + y) % 2 == 0 {
                assert_eq!(z[(y * 32 + x) as usize], depth, "({x}, {y})");
            }
        }
        // And the same in strips, with records and without.
        for records in [0, 1000] {
            let shader = Chequers::default();
            let _ = strips::<Rgb565>(SCREEN, 5, records, Rgb565::BLACK, |scene| {
                scene.draw_with(state, &SQUARE, &Projective::IDENTITY, &shader)
            });
            let mut again = shader.0.into_inner();
            let order = |&(x, y, ..): &Seen| (y, x);
            seen.sort_by_key(order);
            again.sort_by_key(order);
            assert!(seen == again, "{records} records");
        }
    }
}
