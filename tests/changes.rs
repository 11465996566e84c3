//! A scene that changes between two calls of a frame's closure: noticed wherever it would give garbage, and never a
//! panic. An equal scene that is built anew in each call is no change.

use core::convert::Infallible;
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::frame::{FrameError, Renderer};
use zstrip::math::{Pixels, Projective, Scalar, Vec3};
use zstrip::mesh::{LineTopology, Lines, Mesh, MeshData, Points, Positions, Topology, Vertices};
use zstrip::shader::{DepthOnly, Flat, Gouraud};
use zstrip::span::{Fragment, Shader};
use zstrip::target::{Stats, Strip, StripPixels, WithDepth, WithRecords};
use zstrip::vertex::{Perspective, VertexRef, VertexShader};
use zstrip::{Dashed, Scene, Thick, Thin};

type Strips<'a, 's> = Scene<'a, Strip<'s, Rgb565, WithDepth, WithRecords>>;

/// Draws a frame of 16 × 16 px in strips of 2 rows. `draw` gets the number of the call, from 0: call 0 records.
fn frame(records: usize, mut draw: impl FnMut(&mut Strips<'_, '_>, u32)) -> Result<Stats, FrameError> {
    let (mut color, mut depth, mut records) = (vec![0; 16 * 2], vec![0; 16 * 2], vec![0; records]);
    let renderer = Renderer::<Rgb565>::new(Size::new(16, 16)).expect("a renderer").with_depth(&mut depth);
    let mut renderer = renderer.expect("a renderer").with_records(&mut records);
    let sink = |_: &StripPixels<'_, Rgb565>| Ok::<(), Infallible>(());
    let mut call = 0;
    let result = renderer.frame_to(sink, &mut color, Rgb565::BLACK, |scene| {
        draw(scene, call);
        call += 1;
    });
    result.map_err(|error| match error {
        FrameError::SceneChanged { draw } => FrameError::SceneChanged { draw },
        other => panic!("{other}"),
    })
}

/// Asserts that a frame whose second draw changes, from the third call on, is an error, whatever it changes to.
fn is_noticed(what: &str, mut draw: impl FnMut(&mut Strips<'_, '_>, bool)) {
    let first = Mesh::new(MeshData::new(Positions::Exact(&SQUARE[..3]))).expect("a triangle");
    let result = frame(5000, |scene, call| {
        scene.draw(&first, &Projective::IDENTITY, &Flat::unlit(Rgb888::BLUE));
        draw(scene, call >= 2);
    });
    assert_eq!(result, Err(FrameError::SceneChanged { draw: 1 }), "{what}");
}

const SQUARE: [Vec3; 6] = [
    Vec3::from_ints(-1, -1, 0),
    Vec3::from_ints(1, -1, 0),
    Vec3::from_ints(1, 1, 0),
    Vec3::from_ints(-1, 1, 0),
    Vec3::from_ints(0, 1, 0),
    Vec3::from_ints(1, 0, 0),
];

/// Shaders of one shape, by what one of them does with its words: `Correct` has 1 / w in its last word, the others have
/// numbers of their own.
macro_rules! shaders {
    ($($name:ident: $varyings:ty = $value:expr;)*) => { $(
        #[derive(Clone, Copy)]
        struct $name;

        impl VertexShader for $name {
            type Varyings = $varyings;

            fn vertex(&self, vertex: &VertexRef<'_>) -> $varyings {
                let [x, y, _] = vertex.position().to_bits();
                let value: fn(i32, i32) -> $varyings = $value;
                value(x, y)
            }
        }

        impl<P: PixelFormat> Shader<P> for $name {
            type Setup = ();

            fn fragment(&self, fragment: &Fragment<'_, $varyings, ()>) -> Option<P::Raw> {
                let sum = fragment.varyings.as_ref().iter().fold(0_i32, |sum, v| sum.wrapping_add(*v));
                Some(P::pack([(sum >> 12) as u8; 3]))
            }
        }
    )* };
}

shaders! {
    Correct: Perspective<2, 3> = |x, y| Perspective::new([x, y], []);
    Zeros: [i32; 3] = |_, _| [0; 3];
    Ones: [i32; 3] = |_, _| [-1; 3];
    Places: [i32; 3] = |x, y| [x, y, x];
}

/// Draws with one shader, then with another one that has as many words.
#[test]
fn another_shader_is_noticed_and_does_not_panic() {
    let square = MeshData { topology: Topology::Fan, ..MeshData::new(Positions::Exact(&SQUARE[..4])) };
    let square = Mesh::new(square).expect("a square");
    let lines = Lines::new(Vertices::new(Positions::Exact(&SQUARE)), LineTopology::Loop, None).expect("lines");
    let points = Points::new(Vertices::new(Positions::Exact(&SQUARE))).expect("points");
    let mvp = Projective::IDENTITY;
    macro_rules! swap {
        ($($from:expr => $to:expr;)*) => { $(
            let what = stringify!($from, $to);
            is_noticed(what, |scene, other| {
                if other { scene.draw(&square, &mvp, &$to) } else { scene.draw(&square, &mvp, &$from) }
            });
            is_noticed(what, |scene, other| match other {
                false => scene.draw_lines(&lines, &mvp, &$from, &Thick::px(3)),
                true => scene.draw_lines(&lines, &mvp, &$to, &Thick::px(3)),
            });
            is_noticed(what, |scene, other| match other {
                false => scene.draw_points(&points, &mvp, &$from, Pixels::from_num(3)),
                true => scene.draw_points(&points, &mvp, &$to, Pixels::from_num(3)),
            });
        )* };
    }
    swap! {
        Zeros => Correct;
        Ones => Correct;
        Places => Correct;
        Correct => Places;
        Zeros => Ones;
        Flat::unlit(Rgb888::RED) => DepthOnly;
        Gouraud::vertex_colors() => Flat::unlit(Rgb888::RED);
    }
}

#[test]
fn another_topology_or_mesh_of_the_same_size_is_noticed() {
    let shader = Flat::unlit(Rgb888::RED);
    let plain = MeshData::new(Positions::Exact(&SQUARE));
    let colors = [[1, 2, 3]; 6];
    let normals = [[0; 3]; 6];
    let uvs = [[Scalar::ONE; 2]; 6];
    let quantized = [[-16384, -16384, 0], [16384, -16384, 0], [16384, 16384, 0], [-16384, 16384, 0], [0; 3], [0; 3]];
    let quantized = Positions::Quantized { points: &quantized, scale: Scalar::from_num(2), offset: Vec3::ZERO };
    let mut moved = SQUARE;
    moved[0] = Vec3::from_bits([-65_536, -65_535, 0]);
    // Four triangles each, from six numbers or from twelve.
    let long: [u16; 12] = [0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5];
    let mut other = long;
    other[6..9].copy_from_slice(&[5, 3, 4]);
    let fan = MeshData { topology: Topology::Fan, ..plain };
    let list = MeshData { indices: Some(&long), ..plain };
    let changes = [
        ("fan, strip", fan, MeshData { topology: Topology::Strip, ..plain }),
        ("fan, list", fan, list),
        ("other indices", list, MeshData { indices: Some(&other), ..plain }),
        (
            "other order",
            MeshData { indices: Some(&[0, 1, 2]), ..plain },
            MeshData { indices: Some(&[1, 2, 0]), ..plain },
        ),
        ("with indices", plain, MeshData { indices: Some(&[0, 1, 2, 3, 4, 5]), ..plain }),
        ("a vertex has moved", plain, MeshData { positions: Positions::Exact(&moved), ..plain }),
        ("quantized", plain, MeshData { positions: quantized, ..plain }),
        ("colours", plain, MeshData { colors: Some(&colors), ..plain }),
        ("normals", plain, MeshData { normals: Some(&normals), ..plain }),
        ("normals of faces", plain, MeshData { face_normals: Some(&normals[..2]), ..plain }),
        ("texture coordinates", plain, MeshData { uvs: Some(&uvs), ..plain }),
    ];
    for (what, from, to) in changes {
        let (from, to) = (Mesh::new(from).expect("a mesh"), Mesh::new(to).expect("a mesh"));
        assert!(what == "with indices" || from.triangle_count() == to.triangle_count(), "{what}");
        is_noticed(what, |scene, other| scene.draw(if other { &to } else { &from }, &Projective::IDENTITY, &shader));
        is_noticed(what, |scene, other| scene.draw(if other { &from } else { &to }, &Projective::IDENTITY, &shader));
    }
    let vertices = Vertices::new(Positions::Exact(&SQUARE));
    let lines = |topology, indices| Lines::new(vertices, topology, indices).expect("lines");
    let pairs = lines(LineTopology::Pairs, Some(&[0, 1, 2, 3, 4, 5]));
    for (what, from, to) in [
        ("a strip, pairs", lines(LineTopology::Strip, Some(&[0, 1, 2, 3])), pairs),
        ("a loop, pairs", lines(LineTopology::Loop, Some(&[0, 1, 2])), pairs),
        ("other pairs", lines(LineTopology::Pairs, Some(&[0, 1, 5, 3, 4, 5])), pairs),
    ] {
        assert_eq!(from.count(), to.count(), "{what}");
        is_noticed(what, |scene, other| {
            scene.draw_lines(if other { &to } else { &from }, &Projective::IDENTITY, &shader, &Thin);
        });
    }
    // Kinds of primitives, strokes, sizes of points.
    let points = Points::new(vertices).expect("points");
    let mvp = Projective::IDENTITY;
    is_noticed("points instead of lines", |scene, other| match other {
        false => scene.draw_lines(&pairs, &mvp, &shader, &Thin),
        true => scene.draw_points(&points, &mvp, &shader, Pixels::ONE),
    });
    is_noticed("another stroke", |scene, other| match other {
        false => scene.draw_lines(&pairs, &mvp, &shader, &Thin),
        true => scene.draw_lines(&pairs, &mvp, &shader, &Dashed::EVEN),
    });
    is_noticed("larger points", |scene, other| {
        scene.draw_points(&points, &mvp, &shader, Pixels::from_num(if other { 9 } else { 3 }));
    });
}

/// Meshes are told apart by their contents and not by their addresses: a closure may build them anew.
#[test]
fn equal_meshes_at_other_addresses_are_no_change() {
    let mut kept = Vec::new();
    for records in [0, 60, 5000] {
        let result = frame(records, |scene, _| {
            let points = SQUARE.to_vec();
            let mesh = Mesh::new(MeshData { topology: Topology::Fan, ..MeshData::new(Positions::Exact(&points)) });
            scene.draw(&mesh.expect("a mesh"), &Projective::IDENTITY, &Gouraud::vertex_colors());
            let lines = Lines::new(Vertices::new(Positions::Exact(&points)), LineTopology::Loop, None);
            scene.draw_lines(&lines.expect("lines"), &Projective::IDENTITY, &Flat::unlit(Rgb888::RED), &Thick::px(2));
            // The next call's points cannot lie where these do.
            kept.push(points);
        });
        assert!(result.is_ok(), "{records} records: {result:?}");
    }
    let mut places: Vec<_> = kept.iter().map(|points| points.as_ptr()).collect();
    places.sort();
    places.dedup();
    assert_eq!(places.len(), kept.len(), "each call had an address of its own");
}

#[test]
fn draws_are_counted_beyond_65_535() {
    let nothing = Mesh::new(MeshData::new(Positions::Exact(&[]))).expect("an empty mesh");
    for (first, later, differs) in [(70_000, 69_000, 69_000), (69_999, 70_000, 69_999), (65_536, 65_537, 65_536)] {
        let result = frame(300_000, |scene, call| {
            for _ in 0..if call < 2 { first } else { later } {
                scene.draw(&nothing, &Projective::IDENTITY, &Flat::unlit(Rgb888::RED));
            }
        });
        assert_eq!(result, Err(FrameError::SceneChanged { draw: differs }), "{first} draws, then {later}");
    }
    let result = frame(300_000, |scene, _| {
        (0..70_000).for_each(|_| scene.draw(&nothing, &Projective::IDENTITY, &Flat::unlit(Rgb888::RED)));
    });
    assert_eq!(result.map(|stats| (stats.draws, stats.walks)), Ok((9 * 70_000, 9)));
}
