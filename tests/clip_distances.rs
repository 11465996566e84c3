//! Clip and cull distances: planes of a shader's own.

use crate::reference::rng::Rng;
use crate::support::{strips, vector};
use std::cell::RefCell;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::shader::{Blend, Replace, ScreenDoor};
use zstrip::span::{DepthState, Fragment, Shader};
use zstrip::vertex::{Perspective, VertexRef, VertexShader};
use zstrip::{Cull, State};

const SCREEN: (u16, u16) = (64, 64);
const ANY: State = State { cull: Cull::None, depth: DepthState::OFF, ..State::DEFAULT };

/// Keeps what is above some planes in object space; counts pixels, and keeps the least distance it sees.
struct Cut<const CLIP: usize> {
    planes: Vec<(Vec3, i32)>,
    seen: RefCell<Vec<(u32, [i32; 2])>>,
}

impl<const CLIP: usize> Cut<CLIP> {
    fn new(planes: &[(Vec3, i32)]) -> Self {
        Self { planes: planes.to_vec(), seen: RefCell::new(vec![(0, [0; 2]); 64 * 64]) }
    }

    fn distances_at(&self, corner: &VertexRef<'_>) -> [i32; 4] {
        let mut distances = [0; 4];
        for (distance, (normal, offset)) in distances.iter_mut().zip(&self.planes) {
            let dot = |a: [i32; 3], b: [i32; 3]| (0..3).map(|k| (i64::from(a[k]) * i64::from(b[k])) >> 16).sum::<i64>();
            *distance = dot(normal.to_bits(), corner.position().to_bits()) as i32 + offset;
        }
        distances
    }
}

impl<const CLIP: usize> VertexShader for Cut<CLIP> {
    type Varyings = Perspective<2, 3>;

    const CLIP_DISTANCES: usize = CLIP;

    fn vertex(&self, corner: &VertexRef<'_>) -> Perspective<2, 3> {
        let [a, b, ..] = self.distances_at(corner);
        Perspective::new([a, b], [])
    }

    fn distances(&self, corner: &VertexRef<'_>) -> [i32; 4] {
        self.distances_at(corner)
    }
}

impl<const CLIP: usize> Shader<Rgb565> for Cut<CLIP> {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, Perspective<2, 3>>) -> Option<u16> {
        let (x, y) = fragment.position;
        let seen = &mut self.seen.borrow_mut()[(y * 64 + x) as usize];
        *seen = (seen.0 + 1, fragment.varyings.corrected());
        Some(0xFFFF)
    }
}

fn camera() -> Projective {
    let lens = Projective::perspective(
        Angle16::from_degrees(60),
        Size::new(SCREEN.0.into(), SCREEN.1.into()),
        Scalar::from_num(0.5),
        Scalar::from_num(50),
    );
    lens.expect("a camera") * Affine::translation(Vec3::from_ints(0, 0, -3))
}

/// A random fan of six triangles, some of which reach behind the eye.
fn fan(rng: &mut Rng) -> [Vec3; 7] {
    let mut rim = [Vec3::ZERO; 7];
    for (k, corner) in rim.iter_mut().enumerate().skip(1) {
        let turn = Angle16::from_degrees(60 * k as i32);
        let toward = Affine::rotation_z(turn).transform_vector(Vec3::from_ints(2, 0, 0));
        *corner = toward + vector(rng, 2.0);
    }
    rim
}

static FAN: [u16; 18] = [0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0, 5, 6, 0, 6, 1];

#[test]
fn pixels_are_drawn_where_no_distance_is_negative_and_once() {
    let (mut cut_away, mut kept) = (0, 0);
    for seed in 0..60 {
        let mut rng = Rng::new(seed);
        let corners = fan(&mut rng);
        let mesh = Mesh::new(MeshData { indices: Some(&FAN), ..MeshData::new(Positions::Exact(&corners)) });
        let mesh = mesh.expect("a mesh");
        let planes = [(vector(&mut rng, 1.0), rng.between(-40_000, 80_000)), (vector(&mut rng, 1.0), 60_000)];
        let (whole, cut) = (Cut::<0>::new(&planes), Cut::<2>::new(&planes));
        let _ = strips::<Rgb565>(SCREEN, 64, 2000, Rgb565::BLACK, |s| s.draw_with(ANY, &mesh, &camera(), &whole));
        let (picture, _) =
            strips::<Rgb565>(SCREEN, 64, 2000, Rgb565::BLACK, |s| s.draw_with(ANY, &mesh, &camera(), &cut));
        let (whole_seen, cut) = (whole.seen.into_inner(), cut.seen.into_inner());
        for (k, (whole, cut)) in whole_seen.iter().zip(&cut).enumerate() {
            // Where the fan does not fold over itself, every pixel has one triangle and one pair of distances.
            if whole.0 != 1 {
                continue;
            }
            let [a, b] = whole.1;
            let case = format!("seed {seed}, pixel ({}, {}): {whole:?} {cut:?}", k % 64, k / 64);
            // New corners are rounded to 1/256 px: what that is in units of distance, the pixels around tell.
            let around = [k.wrapping_sub(1), k + 1, k.wrapping_sub(64), k + 64].map(|k| whole_seen.get(k));
            let mut slopes = around.iter().map(|near| match near {
                Some((1, near)) => Some(near[0].abs_diff(a).max(near[1].abs_diff(b)) as i32),
                _ => None,
            });
            let Some(slope) = slopes.try_fold(0, |most: i32, slope| Some(most.max(slope?))) else { continue };
            let border = slope / 64 + 8;
            if a.min(b) > border {
                assert_eq!(cut.0, 1, "{case}");
                kept += 1;
            } else if a.min(b) < -border {
                assert_eq!(cut.0, 0, "{case}");
                cut_away += 1;
            } else {
                assert!(cut.0 <= 1, "{case}");
            }
        }
        for records in [0, 100] {
            let again = Cut::<2>::new(&planes);
            let (strips, _) =
                strips::<Rgb565>(SCREEN, 7, records, Rgb565::BLACK, |s| s.draw_with(ANY, &mesh, &camera(), &again));
            assert!(strips == picture, "seed {seed}, {records} records");
        }
    }
    assert!(kept > 10_000 && cut_away > 10_000, "{kept} {cut_away}");
}

/// What a shader cuts away must stay away when another is put around it.
#[test]
fn shaders_around_others_keep_their_distances() {
    let mut rng = Rng::new(3);
    let corners = fan(&mut rng);
    let mesh = Mesh::new(MeshData { indices: Some(&FAN), ..MeshData::new(Positions::Exact(&corners)) });
    let mesh = mesh.expect("a mesh");
    fn picture(mesh: &Mesh<'_>, shader: &impl Shader<Rgb565>) -> Vec<u16> {
        strips::<Rgb565>(SCREEN, 64, 2000, Rgb565::BLACK, |s| s.draw_with(ANY, mesh, &camera(), shader)).0
    }
    let planes = [(Vec3::from_ints(1, 0, 0), 0), (Vec3::from_ints(0, 1, 0), 30_000)];
    let cut = picture(&mesh, &Cut::<2>::new(&planes));
    let whole = picture(&mesh, &Cut::<0>::new(&planes));
    let drawn = |picture: &[u16]| picture.iter().filter(|p| **p != 0).count();
    assert!(drawn(&cut) > 100 && drawn(&whole) > drawn(&cut) + 100);
    assert!(picture(&mesh, &Blend::new(Cut::<2>::new(&planes), Replace)) == cut);
    assert!(picture(&mesh, &ScreenDoor::new(Cut::<2>::new(&planes), 16)) == cut);
    let (left, all) = (picture(&mesh, &RightOf(1)), picture(&mesh, &RightOf(i32::MIN / 2)));
    assert!(drawn(&all) > drawn(&left));
    assert!(picture(&mesh, &Blend::new(RightOf(1), Replace)) == left);
}

/// Leaves out triangles that are left of a line altogether.
struct RightOf(i32);

impl VertexShader for RightOf {
    type Varyings = [i32; 0];

    const CULL_DISTANCES: usize = 1;

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }

    fn distances(&self, corner: &VertexRef<'_>) -> [i32; 4] {
        [corner.position().to_bits()[0] - self.0, 0, 0, 0]
    }
}

impl Shader<Rgb565> for RightOf {
    type Setup = ();

    fn fragment(&self, _: &Fragment<'_, [i32; 0]>) -> Option<u16> {
        Some(1)
    }
}

#[test]
fn cull_distances_drop_triangles_as_a_whole() {
    let mut rng = Rng::new(3);
    let corners = fan(&mut rng);
    let mesh = Mesh::new(MeshData { indices: Some(&FAN), ..MeshData::new(Positions::Exact(&corners)) });
    let mesh = mesh.expect("a mesh");
    for line in [-400_000, -65_536, 0, 20_000, 65_536, 400_000] {
        let expected = FAN.chunks(3).filter(|t| t.iter().all(|k| corners[usize::from(*k)].to_bits()[0] < line)).count();
        // Small, and seen whole.
        let identity =
            Projective::from_rows([[1 << 26, 0, 0, 0], [0, 1 << 26, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1 << 32]]);
        let (_, stats) = strips::<Rgb565>(SCREEN, 64, 2000, Rgb565::BLACK, |s| {
            s.draw_with(ANY, &mesh, &identity, &RightOf(line));
        });
        assert_eq!(stats.outside as usize, expected, "line {line}: {stats:?}");
    }
}
