use super::*;
use crate::model::{Morph, Texture};
use crate::write::wraps::inside;

/// Numbers that look random: xorshift.
struct Random(u64);

impl Random {
    fn next(&mut self, below: u64) -> u64 {
        for shift in [13, -7, 17] {
            self.0 ^= if shift > 0 { self.0 << shift } else { self.0 >> -shift };
        }
        (self.0 >> 16) % below
    }

    fn part(&mut self) -> f64 {
        (self.next(1 << 24) as f64 + 0.5) / f64::from(1 << 24)
    }
}

const SIZE: [u32; 2] = [64, 32];
const HALF: [f64; 2] = [0.5 / 64.0, 0.5 / 32.0];

/// Returns a sheet of squares in x and y, whose triangles have coordinates of their own at each seam: multiples of a
/// quarter, plus `shift`.
fn sheet(random: &mut Random, side: u32, shift: f32) -> Mesh {
    let mut mesh = Mesh::default();
    let mut random_uv = || [0; 2].map(|_| random.next(13) as f32 / 4.0 - 1.0 + shift);
    let row = side + 1;
    for k in 0..row * row {
        mesh.vertices.positions.push([(k % row) as f32, (k / row) as f32, 0.0]);
        mesh.vertices.uvs.push(random_uv());
        mesh.vertices.normals.push([0.0, 0.0, 1.0]);
    }
    for k in 0..side * side {
        let mut corners = [0, 1, row + 1, row].map(|step| k / side * row + k % side + step);
        // Every third square is behind a seam.
        if k % 3 == 0 {
            for corner in &mut corners {
                let v = &mut mesh.vertices;
                v.positions.push(v.positions[*corner as usize]);
                v.normals.push([0.0, 0.0, 1.0]);
                v.uvs.push(random_uv());
                *corner = v.positions.len() as u32 - 1;
            }
        }
        let [a, b, c, d] = corners;
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    }
    mesh
}

/// Returns the weights of a triangle's corners at a point in x and y.
fn weights(mesh: &Mesh, triangle: [u32; 3], [x, y]: [f64; 2]) -> [f64; 3] {
    let [a, b, c] = triangle.map(|v| mesh.vertices.positions[v as usize].map(f64::from));
    let turn = |p: [f64; 3], q: [f64; 3]| (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
    let parts = [turn(b, c), turn(c, a), turn(a, b)];
    let all: f64 = parts.iter().sum();
    parts.map(|part| part / all)
}

/// Returns coordinates in a triangle, of vertices whose coordinates pass through `change`.
fn uv_in(mesh: &Mesh, triangle: [u32; 3], weights: [f64; 3], change: impl Fn([f32; 2]) -> [f32; 2]) -> [f64; 2] {
    let uvs = triangle.map(|v| change(mesh.vertices.uvs[v as usize]).map(f64::from));
    [0, 1].map(|k| (0..3).map(|v| uvs[v][k] * weights[v]).sum())
}

/// Returns the triangles of a mesh that hold a point clearly.
fn holding(mesh: &Mesh, point: [f64; 2]) -> Vec<([u32; 3], [f64; 3])> {
    let of = mesh.triangles.iter().map(|triangle| (*triangle, weights(mesh, *triangle, point)));
    of.filter(|(_, weights)| weights.iter().all(|weight| *weight > 1e-5)).collect()
}

#[test]
fn cut_triangles_show_the_texels_of_the_texture_as_it_goes_on() {
    let seed = 20_250_611;
    println!("seed {seed}");
    let mut random = Random(seed);
    let (mut compared, mut worst) = (0, [[0.0_f64; 2]; 2]);
    for (wrap, shift) in [(Wrap::Clamp, 0.0), (Wrap::Clamp, 0.1), (Wrap::Mirror, 0.0), (Wrap::Mirror, 0.1)] {
        let axes = Axes { wrap: [wrap; 2], half: HALF };
        let mesh = sheet(&mut random, 6, shift);
        let (after, cut, into) = cut_mesh(&mesh, &axes).expect("triangles to cut");
        assert!(cut > 30 && into > 2 * cut, "{wrap:?}: {cut} became {into}");
        for _ in 0..20_000 {
            let point = [0; 2].map(|_| 6.0 * random.part());
            let ([(old, at)], [(new, at_new)]) = (&holding(&mesh, point)[..], &holding(&after, point)[..]) else {
                // On a side.
                continue;
            };
            compared += 1;
            let exact = uv_in(&mesh, *old, *at, |uv| uv);
            let change = |uv: [f32; 2]| [0, 1].map(|k| inside(wrap, uv[k], HALF[k]));
            let found = uv_in(&after, *new, *at_new, change);
            for k in 0..2 {
                let folded = match wrap {
                    Wrap::Mirror => 1.0 - (exact[k].rem_euclid(2.0) - 1.0).abs(),
                    _ => exact[k].clamp(HALF[k], 1.0 - HALF[k]),
                };
                let off = (found[k] - folded).abs() * f64::from(SIZE[k]);
                let of = &mut worst[usize::from(wrap == Wrap::Mirror)][usize::from(shift > 0.0)];
                *of = of.max(off);
                // A corner at a side moves by half a texel. Clamped triangles have no others where they are cut.
                let bound = if wrap == Wrap::Clamp && shift > 0.0 { 1e-3 } else { 0.501 };
                assert!(off < bound, "{wrap:?} {shift} {point:?}: {found:?}, and not {exact:?}");
            }
        }
    }
    println!("{compared} points, worst in texels {worst:?}");
    assert!(compared > 79_000, "{compared}");
}

/// Returns the number of times that a side of triangles goes from one place to another.
fn sides(mesh: &Mesh) -> HashMap<[Place; 2], usize> {
    let place = |v: u32| mesh.vertices.positions[v as usize].map(|x| (x + 0.0).to_bits());
    let mut sides = HashMap::new();
    for triangle in &mesh.triangles {
        (0..3).for_each(|k| *sides.entry([place(triangle[k]), place(triangle[(k + 1) % 3])]).or_default() += 1);
    }
    sides
}

#[test]
fn no_corner_lies_in_the_side_of_another_triangle() {
    let mut random = Random(77);
    for wrap in [[Wrap::Clamp; 2], [Wrap::Mirror; 2], [Wrap::Clamp, Wrap::Mirror], [Wrap::Repeat, Wrap::Clamp]] {
        for shift in [0.0, 0.1, 0.003] {
            let mesh = sheet(&mut random, 5, shift);
            let (after, ..) = cut_mesh(&mesh, &Axes { wrap, half: HALF }).expect("triangles to cut");
            let sides = sides(&after);
            for ([from, to], count) in &sides {
                let is_border = (0..2).any(|k| from[k] == to[k] && [0.0_f32, 5.0].contains(&f32::from_bits(from[k])));
                let back = sides.get(&[*to, *from]).copied().unwrap_or(0);
                let expected = if is_border { 0 } else { 1 };
                assert_eq!(
                    (*count, back),
                    (1, expected),
                    "{wrap:?} {shift}: {:?}",
                    [from, to].map(|p| p.map(f32::from_bits))
                );
            }
            let area: f64 = after
                .triangles
                .iter()
                .map(|t| {
                    let [a, b, c] = t.map(|v| after.vertices.positions[v as usize].map(f64::from));
                    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
                })
                .inspect(|area| assert!(*area > 0.0))
                .sum();
            assert!((area - 50.0).abs() < 1e-4, "{area}");
        }
    }
}

#[test]
fn clusters_keep_their_triangles_and_stay_small() {
    let mut mesh = sheet(&mut Random(3), 8, 0.1);
    let bounds = crate::model::Bounds { min: [0.0; 3], max: [8.0; 3] };
    let cluster = |(first, count)| Cluster { first, count, vertices: 0, bounds, cone: None };
    mesh.clusters = [(0, 100), (100, 28)].map(cluster).to_vec();
    let before = mesh.clone();
    let (after, ..) = cut_mesh(&mesh, &Axes { wrap: [Wrap::Mirror; 2], half: HALF }).expect("triangles to cut");
    let mut first = 0;
    for cluster in &after.clusters {
        assert!(cluster.first == first && cluster.count <= CLUSTER && cluster.vertices > 2, "{cluster:?}");
        first += cluster.count;
    }
    assert_eq!(first, after.triangles.len());
    // Triangles of the last old cluster are the last ones.
    let is_in =
        |point| !holding(&Mesh { triangles: before.triangles[100..].to_vec(), ..before.clone() }, point).is_empty();
    let middle = |t: &[u32; 3]| {
        [0, 1].map(|k| t.iter().map(|v| f64::from(after.vertices.positions[*v as usize][k])).sum::<f64>() / 3.0)
    };
    let flags: Vec<_> = after.triangles.iter().map(|t| is_in(middle(t))).collect();
    let start = flags.iter().position(|is_last| *is_last).expect("triangles of the last cluster");
    assert!(flags[start..].iter().all(|is_last| *is_last));
    assert!(after.clusters.iter().any(|cluster| cluster.first == start));
}

#[test]
fn all_attributes_of_new_vertices_are_between_those_of_the_old_ones() {
    let mut mesh = Mesh { triangles: vec![[0, 1, 2]], ..Mesh::default() };
    let v = &mut mesh.vertices;
    v.positions = vec![[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    v.uvs = vec![[-1.0 + HALF[0] as f32, 0.5], [1.0 + HALF[0] as f32, 0.5], [-1.0 + HALF[0] as f32, 0.6]];
    v.normals = vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    v.colors = vec![[0.0, 0.2, 1.0, 1.0], [1.0, 0.4, 0.0, 0.5], [0.0; 4]];
    v.joints = vec![[3, 5, 0, 0], [5, 7, 8, 9], [1, 0, 0, 0]];
    v.weights = vec![[0.6, 0.4, 0.0, 0.0], [0.4, 0.3, 0.2, 0.1], [1.0, 0.0, 0.0, 0.0]];
    v.morphs =
        vec![Morph { positions: vec![[1.0; 3], [3.0; 3], [0.0; 3]], normals: vec![[0.5; 3], [0.1; 3], [0.0; 3]] }];
    let axes = Axes { wrap: [Wrap::Clamp, Wrap::Repeat], half: HALF };
    let (after, ..) = cut_mesh(&mesh, &axes).expect("a triangle to cut");
    // u = half a texel is in the middle of the first side and of the longest one.
    let v = &after.vertices;
    let middle = v.positions.iter().position(|p| *p == [2.0, 0.0, 0.0]).expect("the middle of the first side");
    assert!((v.uvs[middle][0] - HALF[0] as f32).abs() < 1e-6 && v.uvs[middle][1] == 0.5);
    let root = 0.5_f32.sqrt();
    assert!(v.normals[middle].iter().zip([root, root, 0.0]).all(|(a, b)| (a - b).abs() < 1e-6));
    assert!(v.colors[middle].iter().zip([0.5, 0.3, 0.5, 0.75]).all(|(a, b)| (a - b).abs() < 1e-6));
    assert_eq!(v.morphs[0].positions[middle], [2.0; 3]);
    assert!(v.morphs[0].normals[middle].iter().all(|c| (c - 0.3).abs() < 1e-6));
    // Joints 5, 3, 7 and 8 of the five; the sum of their weights is 1 again.
    assert_eq!(v.joints[middle], [5, 3, 7, 8]);
    let expected = [0.4, 0.3, 0.15, 0.1].map(|w| w / 0.95);
    assert!(v.weights[middle].iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{:?}", v.weights[middle]);
    for list in [v.normals.len(), v.uvs.len(), v.colors.len(), v.joints.len(), v.weights.len()] {
        assert_eq!(list, v.positions.len());
    }
}

#[test]
fn meshes_that_would_grow_too_large_stay_as_they_are() {
    let mut mesh = sheet(&mut Random(5), 2, 0.0);
    mesh.vertices.uvs[4] = [200.0, 0.0];
    let axes = |wrap| Axes { wrap: [wrap; 2], half: HALF };
    assert!(cut_mesh(&mesh, &axes(Wrap::Mirror)).is_none());
    // Clamped, it has two sides.
    assert!(cut_mesh(&mesh, &axes(Wrap::Clamp)).is_some());
    // Within the sides of each triangle, but 33 × 33 parts of each.
    let mut mesh = sheet(&mut Random(6), 40, 0.0);
    for (k, uv) in mesh.vertices.uvs.iter_mut().enumerate() {
        *uv = [if k % 2 == 0 { 0.0 } else { 31.0 }, if k % 3 == 0 { 0.0 } else { 31.0 }];
    }
    assert!(cut_mesh(&mesh, &axes(Wrap::Mirror)).is_none());
    for uv in [[f32::NAN; 2], [f32::INFINITY; 2], [1e30, -1e30], [f32::MAX, f32::MIN]] {
        mesh.vertices.uvs[0] = uv;
        _ = cut_mesh(&mesh, &axes(Wrap::Clamp));
        assert!(cut_mesh(&mesh, &axes(Wrap::Mirror)).is_none());
    }
}

#[test]
fn any_numbers_give_triangles_of_vertices_that_are_there() {
    let seed = 4_711;
    println!("seed {seed}");
    let mut random = Random(seed);
    let (mut cut, mut left) = (0, 0);
    for round in 0..400 {
        let mut mesh = sheet(&mut random, 3, 0.1);
        for _ in 0..1 + random.next(4) {
            let v = random.next(16) as usize;
            // Any bits for coordinates, and any finite number for positions, equal ones among them.
            let any = f32::from_bits(random.next(1 << 32) as u32);
            match random.next(4) {
                0 => mesh.vertices.uvs[v][round % 2] = any,
                1 => mesh.vertices.uvs[v][round % 2] = (any % 40.0).round(),
                2 if any.is_finite() => mesh.vertices.positions[v][round % 3] = any,
                _ => mesh.vertices.positions[v] = mesh.vertices.positions[random.next(16) as usize],
            }
        }
        for wrap in [Wrap::Clamp, Wrap::Mirror] {
            let Some((after, ..)) = cut_mesh(&mesh, &Axes { wrap: [wrap; 2], half: HALF }) else {
                left += 1;
                continue;
            };
            cut += 1;
            let count = after.vertices.positions.len() as u32;
            assert!(after.triangles.as_flattened().iter().all(|v| *v < count), "{round}");
            assert!(after.vertices.positions.as_flattened().iter().all(|x| x.is_finite()), "{round}");
            assert!(after.triangles.len() >= mesh.triangles.len() && after.triangles.len() < 12_000, "{round}");
        }
    }
    println!("{cut} cut, {left} left");
    assert!(cut > 400 && left > 20, "{cut} cut, {left} left");
}

#[test]
fn meshes_without_a_side_that_is_crossed_are_not_copied() {
    let texture = |wrap| Some(Texture { image: 0, wrap, nearest: false });
    let material = |wrap| crate::model::Material { texture: texture(wrap), ..Default::default() };
    let mut inner = sheet(&mut Random(9), 3, 0.0);
    inner.vertices.uvs.iter_mut().for_each(|uv| *uv = uv.map(|c| c.clamp(0.0, 1.0)));
    let outer = Mesh { material: Some(1), ..sheet(&mut Random(9), 3, 0.0) };
    let mut import = Import {
        meshes: vec![Mesh { material: Some(0), ..inner }, outer, sheet(&mut Random(9), 3, 0.0)],
        materials: vec![material([Wrap::Clamp; 2]), material([Wrap::Repeat; 2])],
        ..Import::default()
    };
    let mut report = WriteReport::default();
    let sizes = [Some(SIZE); 2];
    assert!(matches!(cut(&import, &sizes, &mut report), Cow::Borrowed(_)) && report.notes.is_empty());
    import.materials[1] = material([Wrap::Repeat, Wrap::Mirror]);
    let after = cut(&import, &sizes, &mut report);
    assert_eq!([0, 2].map(|k| after.meshes[k] == import.meshes[k]), [true; 2]);
    let [WriteNote::Cut { material: 1, triangles, into, .. }] = report.notes[..] else { panic!("{:?}", report.notes) };
    assert_eq!(after.meshes[1].triangles.len(), import.meshes[1].triangles.len() - triangles + into);
    let text = report.notes[0].to_string();
    assert!(text.ends_with("at the sides of its texture") && text.starts_with("material 1 \"\": "), "{text}");
}
