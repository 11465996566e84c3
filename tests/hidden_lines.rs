//! A wireframe over the surface it outlines: what is visible is drawn without gaps, what is hidden does not shine
//! through.

use crate::reference::exact;
use crate::scenes;
use crate::scenes::{torus, wires};
use crate::support::whole;
use std::cell::RefCell;
use std::collections::BTreeSet;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::internals::{Line, PixelRect, Projected, Transform};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{LineTopology, Lines, Mesh, MeshData, Positions, Topology, Vertices};
use zstrip::shader::{DepthOnly, Flat, Gouraud};
use zstrip::span::{DepthBias, DepthState, Fragment, Shader};
use zstrip::vertex::{Face, ScreenVertex, VertexRef, VertexShader, Viewport};
use zstrip::{State, Thin};

const SCREEN: (u16, u16) = (320, 240);

/// Reports which line draws which pixel.
struct Drawn<'a>(RefCell<&'a mut BTreeSet<(u32, (i32, i32))>>);

impl VertexShader for Drawn<'_> {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }

    fn face(&self, face: &Face<'_>) -> u32 {
        face.index() as u32
    }
}

impl Shader<Rgb565> for Drawn<'_> {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<u16> {
        self.0.borrow_mut().insert((fragment.flat, fragment.position));
        Some(1)
    }
}

fn mvp(turn: Angle16) -> Projective {
    scenes::camera(Size::new(SCREEN.0.into(), SCREEN.1.into()), Scalar::ONE, Scalar::from_num(12))
        * scenes::torus_model(turn)
}

/// A front face on the screen, as the oracle sees it.
struct Seen {
    corners: [u16; 3],
    v: exact::Triangle,
    z: [i64; 3],
}

fn front_faces(v: &[ScreenVertex]) -> Vec<Seen> {
    let triangles = (0..torus::MESH.triangle_count()).filter_map(|n| torus::MESH.triangle(n));
    let seen = triangles.map(|corners| {
        let at = corners.map(|k| v[usize::from(k)]);
        Seen { corners, v: at.map(|p| [p.x.into(), p.y.into()]), z: at.map(|p| p.z.into()) }
    });
    seen.filter(|face| exact::area2(face.v) < 0).collect()
}

/// Samples around a pixel's centre, up to one pixel away, in 1/256 px.
const AROUND: [[i64; 2]; 13] = [
    [0, 0],
    [128, 0],
    [-128, 0],
    [0, 128],
    [0, -128],
    [256, 0],
    [-256, 0],
    [0, 256],
    [0, -256],
    [181, 181],
    [-181, 181],
    [181, -181],
    [-181, -181],
];

#[test]
fn visible_edges_have_no_gaps_and_hidden_ones_do_not_shine_through() {
    let viewport = Viewport::full(Size::new(SCREEN.0.into(), SCREEN.1.into())).expect("a viewport");
    let screen = PixelRect { x: 0..i32::from(SCREEN.0), y: 0..i32::from(SCREEN.1) };
    let (mut visible, mut hidden, mut unsure) = (0, 0, 0);
    for turn in [Angle16(1234), Angle16(20_000), Angle16(50_000)] {
        let mvp = mvp(turn);
        let mut drawn = BTreeSet::new();
        let shader = Drawn(RefCell::new(&mut drawn));
        whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| {
            scene.draw_with(wires::BEHIND_LINES, &torus::MESH, &mvp, &DepthOnly);
            // Without depths of their own, so that lines do not hide each other.
            let state = State { depth: DepthState { write: false, ..DepthState::LESS }, ..State::DEFAULT };
            scene.draw_lines_with(state, torus::lines(), &mvp, &shader, &Thin);
        });
        let transform = Transform::new(&mvp, &viewport, torus::lines().vertices(), false);
        let place = |k| match transform.project_vertex(&torus::lines().vertices().data().positions, k) {
            Projected::OnScreen(v) => v,
            Projected::NeedsClip(code) => panic!("{code:?}"),
        };
        let v: Vec<_> = (0..torus::lines().vertices().vertex_count()).map(place).collect();
        let faces = front_faces(&v);
        for number in 0..torus::lines().count() {
            let [i, j] = torus::lines().line(number).expect("a line");
            let (a, b) = (v[usize::from(i)], v[usize::from(j)]);
            let line = Line::new((a.x, a.y), (b.x, b.y));
            // Those that could cover a sample near the line.
            let reach = |k: usize| {
                let (from, to) = [(a.x, b.x), (a.y, b.y)][k];
                i64::from(from.min(to)) - 512..=i64::from(from.max(to)) + 512
            };
            let near = |face: &&Seen| {
                (0..2).all(|k| {
                    let along = face.v.iter().map(|p| p[k]);
                    along.clone().max() >= Some(*reach(k).start()) && along.min() <= Some(*reach(k).end())
                })
            };
            let faces: Vec<_> = faces.iter().filter(near).collect();
            let is_side = |face: &&&Seen| face.corners.contains(&i) && face.corners.contains(&j);
            let touches = |face: &Seen| face.corners.contains(&i) || face.corners.contains(&j);
            let faces_viewer = faces.iter().any(|face| is_side(&face));
            for (k, (x, y)) in line.pixels(&screen).1.enumerate() {
                let part = ((f64::from(line.lead()) + 256.0 * k as f64) / f64::from(line.length())).max(0.0);
                let z = f64::from(a.z) + part * (f64::from(b.z) - f64::from(a.z));
                let [cx, cy] = exact::center(x.into(), y.into());
                // Depths of the faces at a sample.
                let depths = |offset: [i64; 2]| {
                    let at = [cx + offset[0], cy + offset[1]];
                    let covering = faces.iter().filter(move |face| exact::covers_at(face.v, at));
                    covering.map(move |face| (*face, exact::to_f64(exact::affine_at(face.v, face.z, at))))
                };
                let clear = |offset: &[i64; 2]| depths(*offset).all(|(face, depth)| is_side(&&face) || depth >= z);
                let blocked =
                    |offset: &[i64; 2]| depths(*offset).any(|(face, depth)| !touches(face) && depth < z - 8.0);
                let is_drawn = drawn.contains(&(number as u32, (x, y)));
                let case = format!("{turn:?}, line {number} from {a:?} to {b:?}, pixel ({x}, {y}), depth {z}");
                if faces_viewer && AROUND.iter().all(clear) {
                    assert!(is_drawn, "gap: {case}");
                    visible += 1;
                } else if AROUND.iter().all(blocked) {
                    assert!(!is_drawn, "shines through: {case}");
                    hidden += 1;
                } else {
                    unsure += 1;
                }
            }
        }
    }
    println!("{visible} pixels visible, {hidden} hidden, {unsure} near a silhouette or a corner");
    assert!(visible > 5000 && hidden > 5000 && unsure < visible + hidden);
}

#[test]
fn lines_may_be_pulled_forward_instead() {
    // The bias of lines themselves, over a surface drawn as it is: a line in the plane of a face towards the viewer is
    // seen with one step, and not without.
    let corners = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]];
    let corners = corners.map(|[x, y, z]| Vec3::from_ints(x, y, z));
    let data = MeshData::new(Positions::Exact(&corners));
    let quad = MeshData { topology: Topology::Quads, ..data };
    let quad = Mesh::new(quad).expect("a mesh");
    let indices = Some(&[0_u16, 2][..]);

    let diagonal = Lines::new(Vertices::new(Positions::Exact(&corners)), LineTopology::Pairs, indices).expect("a line");
    let camera = scenes::camera(Size::new(SCREEN.0.into(), SCREEN.1.into()), Scalar::ONE, Scalar::from_num(12));
    let mvp = camera * Affine::translation(Vec3::from_ints(0, 0, -3));
    let red = |constant: i16| {
        let bias = DepthBias { constant, ..DepthBias::NONE };
        let state = State { bias, ..State::DEFAULT };
        let (picture, ..) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| {
            scene.draw(&quad, &mvp, &Gouraud::vertex_colors());
            scene.draw_lines_with(state, &diagonal, &mvp, &Flat::unlit(Rgb888::RED), &Thin);
        });
        picture.iter().filter(|pixel| **pixel == 0xF800).count()
    };
    let all = red(-1);
    // The first pixel belongs to the line, but not to the face.
    assert_eq!((red(0), red(-20)), (1, all));
    assert!(all > 100, "{all}");
}
