//! What happens to triangles after they are read, against plain versions of it in 64-bit floats.

use std::collections::BTreeSet;

use zstrip_assets::{Center, Mesh, Normals, Note, Options, UpAxis};

use crate::support::{Random, corners, has, only_mesh, read, read_with, sorted_corners};

type Vector = [f64; 3];

fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(v: Vector) -> Vector {
    v.map(|x| x / dot(v, v).sqrt())
}

fn wide(p: [f32; 3]) -> Vector {
    p.map(f64::from)
}

fn normal_of(triangle: &[[f32; 3]; 3]) -> Vector {
    let [a, b, c] = triangle.map(wide);
    unit(cross(sub(b, a), sub(c, a)))
}

/// Twice the area of a triangle in the plane; above 0 if it goes counter-clockwise.
fn area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// A star-shaped polygon, mostly concave, whose corners go counter-clockwise.
fn star(random: &mut Random, count: usize) -> Vec<[f64; 2]> {
    let corner = |k: usize, random: &mut Random| {
        let angle = std::f64::consts::TAU * (k as f64 + 0.8 * random.part()) / count as f64;
        let radius = 0.1 + random.part();
        [radius * angle.cos(), radius * angle.sin()]
    };
    (0..count).map(|k| corner(k, random)).collect()
}

/// The triangles of a polygon in the plane of x and y, which is tilted before it is imported and laid flat again.
fn divide(polygon: &[[f64; 2]]) -> Vec<[[f64; 2]; 3]> {
    let tilted = polygon.iter().map(|[x, y]| format!("v {} {} {}\n", *x as f32, *y as f32, (2.0 * x - y) as f32));
    let face: String = (1..=polygon.len()).map(|k| format!(" {k}")).collect();
    let (import, _) = read("a.obj", format!("{}f{face}\n", tilted.collect::<String>())).expect("a polygon");
    corners(only_mesh(&import)).iter().map(|t| t.map(|[x, y, _]| [f64::from(x), f64::from(y)])).collect()
}

/// Whether a point is in a polygon, by the edges that a ray crosses.
fn is_inside(polygon: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let edges = polygon.iter().zip(polygon.iter().cycle().skip(1));
    let crossed =
        edges.filter(|(a, b)| (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
    crossed.count() % 2 == 1
}

#[test]
fn triangles_cover_a_polygon_once() {
    for seed in 0..40 {
        let mut random = Random(seed);
        let count = 4 + random.below(30);
        let polygon: Vec<[f64; 2]> = star(&mut random, count).iter().map(|p| p.map(|x| f64::from(x as f32))).collect();
        let triangles = divide(&polygon);
        assert_eq!(triangles.len(), polygon.len() - 2, "seed {seed}");
        let areas: Vec<f64> = triangles.iter().map(|[a, b, c]| area(*a, *b, *c)).collect();
        assert!(areas.iter().all(|area| *area > 0.0), "seed {seed}: {areas:?}");
        let whole: f64 = (1..count - 1).map(|k| area(polygon[0], polygon[k], polygon[k + 1])).sum();
        assert!((areas.iter().sum::<f64>() - whole).abs() < 1e-6 * whole, "seed {seed}");
        for _ in 0..300 {
            let point = [2.2 * random.part() - 1.1, 2.2 * random.part() - 1.1];
            let covers = |t: &&[[f64; 2]; 3]| is_inside(&t[..], point);
            let covered = triangles.iter().filter(covers).count();
            assert_eq!(covered, usize::from(is_inside(&polygon, point)), "seed {seed}, {point:?}");
        }
    }
}

#[test]
fn corners_in_the_middle_of_a_side_stay() {
    // A square with a corner in the middle of each side, and two in one of them.
    let square = [(0, 0), (1, 0), (2, 0), (3, 0), (3, 2), (3, 3), (1, 3), (0, 3), (0, 1)];
    let polygon: Vec<[f64; 2]> = square.iter().map(|(x, y)| [f64::from(*x), f64::from(*y)]).collect();
    let triangles = divide(&polygon);
    let sides: BTreeSet<String> =
        triangles.iter().flat_map(|t| (0..3).map(|k| format!("{:?}{:?}", t[k], t[(k + 1) % 3]))).collect();
    for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        assert!(sides.contains(&format!("{a:?}{b:?}")), "no triangle has the side {a:?} to {b:?}: {triangles:?}");
    }
    assert!((triangles.iter().map(|[a, b, c]| area(*a, *b, *c)).sum::<f64>() - 18.0).abs() < 1e-9);
}

#[test]
fn crossed_polygons_are_reported() {
    let text = "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1.5 0\nf 1 2 3 4\n";
    let (_, report) = read("a.obj", text).expect("a bow tie");
    assert!(has(&report, &Note::Crossed { polygons: 1 }), "{report}");
    let (_, report) = read("a.obj", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 3 2 4\n").expect("a square");
    assert!(has(&report, &Note::Triangulated { polygons: 1 }) && !report.to_string().contains("cross"), "{report}");
}

/// A wavy grid of `n` by `n` squares, which goes around a cylinder where `bend` is above 0.
fn grid(n: usize, bend: f32) -> String {
    let mut text = String::new();
    for k in 0..=n * (n + 2) {
        let (x, y) = ((k % (n + 1)) as f32 / n as f32, (k / (n + 1)) as f32 / n as f32);
        text += &format!("v {x} {y} {}\n", bend * (9.0 * x).sin() * (7.0 * y).cos());
    }
    for k in 0..n * n {
        let a = k / n * (n + 1) + k % n + 1;
        text += &format!("f {a} {} {} {}\n", a + 1, a + n + 2, a + n + 1);
    }
    text
}

#[test]
fn vertices_within_the_distance_become_one() {
    let mut random = Random(11);
    let points: Vec<[f32; 3]> = (0..300).map(|_| [0; 3].map(|_| (random.part() * 2.0 - 1.0) as f32)).collect();
    let faces: Vec<[usize; 3]> = (0..200).map(|_| [0; 3].map(|_| random.below(300))).collect();
    let text: String = points.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    let text: String =
        text + &faces.iter().map(|f| format!("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1)).collect::<String>();
    for distance in [0.0, 0.05, 0.2, 0.7] {
        // Only vertices in use count, in the order in which faces use them.
        let mut order: Vec<usize> = Vec::new();
        faces.iter().flatten().for_each(|v| {
            if !order.contains(v) {
                order.push(*v)
            }
        });
        let mut places: Vec<usize> = Vec::new();
        let mut moved = vec![[0.0; 3]; points.len()];
        for v in order {
            let near = |p: &&usize| {
                let d = sub(wide(points[v]), wide(points[**p]));
                dot(d, d) <= distance * distance
            };
            let place = places.iter().find(near).copied();
            moved[v] = points[place.unwrap_or(v)];
            if place.is_none() {
                places.push(v);
            }
        }
        let mut expected: Vec<[[f32; 3]; 3]> = faces.iter().map(|f| f.map(|v| moved[v])).collect();
        expected.retain(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
        let options = Options { weld_distance: distance, normals: Normals::Flat, ..Options::default() };
        let (import, report) = read_with("a.obj", &text, &options).expect("triangles");
        expected.iter_mut().for_each(|t| {
            let least = (0..3).min_by(|a, b| t[*a].partial_cmp(&t[*b]).expect("numbers")).expect("a corner");
            t.rotate_left(least);
        });
        expected.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
        expected.dedup();
        assert_eq!(sorted_corners(only_mesh(&import)), expected, "distance {distance}: {report}");
    }
}

#[test]
fn the_weld_distance_is_in_units_of_the_file() {
    // Two triangles whose common corners are 0.01 apart.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0.01 0\nv 1 1 0\nv 0.01 1 0\nf 1 2 3\nf 4 5 6\n";
    for scale in [0.001, 1.0, 1000.0] {
        for (weld_distance, count) in [(0.02, 4), (0.005, 6)] {
            let options = Options { scale, weld_distance, ..Options::default() };
            let (import, report) = read_with("a.obj", text, &options).expect("two triangles");
            assert_eq!(only_mesh(&import).vertices.len(), count, "{scale}, {weld_distance}: {report}");
        }
    }
}

#[test]
fn equal_vertices_become_one_and_others_stay() {
    // Two triangles that share a side, each with vertices of its own; in the second file, one uv differs.
    let file = |u: f32| {
        format!(
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt {u} 0\nvt 1 1\nvt 0 1\n\
             f 1/1 2/2 3/3\nf 4/4 5/5 6/6\n"
        )
    };
    for (u, count) in [(0.0, 4), (-0.0, 4), (0.5, 5)] {
        let (import, _) = read("a.obj", file(u)).expect("two triangles");
        assert_eq!(only_mesh(&import).vertices.len(), count, "{u}");
    }
}

/// Normals by their definition, for all corners, from all faces.
fn plain_normal(triangles: &[[[f32; 3]; 3]], t: usize, k: usize, crease: f64) -> Vector {
    let mut sum = [0.0; 3];
    for other in triangles {
        for j in (0..3).filter(|j| other[*j] == triangles[t][k]) {
            let (a, b) = (normal_of(other), normal_of(&triangles[t]));
            if dot(a, b).clamp(-1.0, 1.0).acos().to_degrees() <= crease + 1e-4 {
                let p = wide(other[j]);
                let [q, r] = [1, 2].map(|step| unit(sub(wide(other[(j + step) % 3]), p)));
                let angle = dot(q, r).clamp(-1.0, 1.0).acos();
                sum = [0, 1, 2].map(|k| sum[k] + angle * a[k]);
            }
        }
    }
    unit(sum)
}

#[test]
fn normals_are_those_of_the_definition() {
    for crease in [0.0, 15.0, 50.0, 180.0] {
        let options = Options { crease_angle: crease, normals: Normals::Smooth, ..Options::default() };
        let (import, _) = read_with("a.obj", grid(8, 0.3), &options).expect("a grid");
        let mesh = only_mesh(&import);
        let triangles = corners(mesh);
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            for (k, v) in triangle.iter().enumerate() {
                let found = wide(mesh.vertices.normals[*v as usize]);
                let error = sub(found, plain_normal(&triangles, t, k, crease));
                assert!(dot(error, error).sqrt() < 1e-5, "crease {crease}, triangle {t}, corner {k}: {found:?}");
            }
        }
    }
}

#[test]
fn normals_of_the_file_stay_and_missing_ones_are_made() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0.6 0 0.8\nvn 0 0 0\nf 1//1 2//1 3//2\nf 1 3 4\n";
    let (import, report) = read("a.obj", text).expect("a square");
    assert!(has(&report, &Note::NormalsMade { corners: 4 }), "{report}");
    let normals = &only_mesh(&import).vertices.normals;
    assert!(normals.iter().all(|normal| *normal == [0.6, 0.0, 0.8] || *normal == [0.0, 0.0, 1.0]), "{normals:?}");
    assert_eq!(normals.iter().filter(|normal| **normal == [0.6, 0.0, 0.8]).count(), 2);
    let options = Options { normals: Normals::Flat, ..Options::default() };
    let (import, _) = read_with("a.obj", text, &options).expect("a square");
    assert_eq!(only_mesh(&import).vertices.normals, [[0.0, 0.0, 1.0]; 4]);
}

#[test]
fn triangles_that_show_nothing_are_dropped_and_edges_are_counted() {
    // A tetrahedron, a copy of one side, one with a corner twice, one without area, a fin on an edge, and one side that
    // is turned over.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 2 0 0\nv 0 -1 -1\n\
                f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 3 4\nf 2 4 1\nf 1 1 2\nf 1 2 5\nf 1 2 6\n";
    let (import, report) = read("a.obj", text).expect("a tetrahedron");
    assert_eq!(only_mesh(&import).triangles.len(), 5, "{report}");
    assert!(has(&report, &Note::Degenerate { triangles: 2 }), "{report}");
    assert!(has(&report, &Note::Duplicate { triangles: 1 }), "{report}");
    assert!(has(&report, &Note::NonManifold { edges: 1 }), "{report}");
    assert!(has(&report, &Note::OpenEdges { edges: 2 }), "{report}");
    assert!(has(&report, &Note::Inconsistent { edges: 3 }), "{report}");
    let (_, report) =
        read("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n").expect("one");
    assert!(!report.to_string().contains("edges"), "{report}");
}

#[test]
fn options_turn_scale_and_move() {
    let text = "v 1 2 3\nv 3 2 3\nv 1 2 7\nv 100 100 100\nf 1 2 3\n";
    let box_of = |options: &Options| read_with("a.obj", text, options).expect("a triangle").1.bounds.expect("a box");
    let bounds = box_of(&Options { up: Some(UpAxis::Z), scale: 0.5, ..Options::default() });
    assert_eq!((bounds.min, bounds.max), ([0.5, 1.5, -1.0], [1.5, 3.5, -1.0]));
    let bounds = box_of(&Options { center: Center::Middle, ..Options::default() });
    assert_eq!((bounds.min, bounds.max), ([-1.0, 0.0, -2.0], [1.0, 0.0, 2.0]));
    let bounds = box_of(&Options { up: Some(UpAxis::Z), center: Center::Ground, ..Options::default() });
    assert_eq!((bounds.min, bounds.max), ([-1.0, 0.0, 0.0], [1.0, 4.0, 0.0]));
}

/// Checks the sizes, boxes and cones of all clusters.
fn check_clusters(mesh: &Mesh, options: &Options) {
    let triangles = corners(mesh);
    let mut next = 0;
    for cluster in &mesh.clusters {
        assert_eq!(cluster.first, next);
        next += cluster.count;
        let range = cluster.first..next;
        let vertices: BTreeSet<u32> = mesh.triangles[range.clone()].iter().flatten().copied().collect();
        assert!(cluster.count <= options.cluster_triangles && cluster.count > 0);
        assert!(vertices.len() == cluster.vertices && vertices.len() <= options.cluster_vertices);
        for k in 0..3 {
            let xs = || triangles[range.clone()].iter().flatten().map(|p| p[k]);
            assert_eq!(cluster.bounds.min[k], xs().fold(f32::INFINITY, f32::min));
            assert_eq!(cluster.bounds.max[k], xs().fold(f32::NEG_INFINITY, f32::max));
        }
        if let Some(cone) = cluster.cone {
            assert!((dot(wide(cone.axis), wide(cone.axis)).sqrt() - 1.0).abs() < 1e-6 && cone.cosine > 0.0);
            for triangle in &triangles[range] {
                assert!(dot(wide(cone.axis), normal_of(triangle)) >= f64::from(cone.cosine));
            }
        }
    }
    assert_eq!(next, mesh.triangles.len());
}

#[test]
fn clusters_are_bounded_and_their_boxes_and_cones_hold() {
    let text = grid(40, 0.05);
    for (vertices, triangles) in [(64, 124), (255, 512), (3, 4), (20, 16)] {
        let options = Options { cluster_vertices: vertices, cluster_triangles: triangles, ..Options::default() };
        let (import, _) = read_with("a.obj", &text, &options).expect("a grid");
        check_clusters(only_mesh(&import), &options);
        let cones = only_mesh(&import).clusters.iter().filter(|cluster| cluster.cone.is_some()).count();
        assert!(2 * cones > only_mesh(&import).clusters.len(), "{cones} cones");
    }
}

#[test]
fn a_crowded_vertex_takes_no_longer_than_others() {
    let count = 20_000;
    let spoke = |k: usize| (std::f64::consts::TAU * k as f64 / count as f64).sin_cos();
    let rim: String = (0..count).map(|k| format!("v {} {} 0\n", spoke(k).1, spoke(k).0)).collect();
    let faces: String = (0..count).map(|k| format!("f 1 {} {}\n", k + 2, (k + 1) % count + 2)).collect();
    let (import, report) = read("a.obj", format!("v 0 0 1\n{rim}{faces}")).expect("a cone");
    assert!(has(&report, &Note::CrowdedPoints { points: 1 }), "{report}");
    check_clusters(only_mesh(&import), &Options::default());
    let tip = only_mesh(&import).vertices.positions.iter().position(|p| *p == [0.0, 0.0, 1.0]).expect("the tip");
    assert!(only_mesh(&import).vertices.normals[tip][2] > 0.999_999);
}

#[test]
fn vertices_are_in_the_order_of_their_use() {
    let (import, _) = read("a.obj", grid(20, 0.3)).expect("a grid");
    let mesh = only_mesh(&import);
    let mut next = 0;
    for v in mesh.triangles.iter().flatten() {
        assert!(*v <= next);
        next = next.max(v + 1);
    }
    assert_eq!(next as usize, mesh.vertices.len());
}

#[test]
fn large_meshes_are_split_and_lose_nothing() {
    let text = grid(300, 0.3);
    let whole = sorted_corners(only_mesh(&read_with("a.obj", grid(30, 0.3), &Options::default()).expect("a grid").0));
    for (text, most) in [(text, 65_535), (grid(30, 0.3), 100), (grid(30, 0.3), 3)] {
        let options = Options { max_vertices: most, ..Options::default() };
        let (import, report) = read_with("a.obj", &text, &options).expect("a grid");
        assert!(import.meshes.len() > 1 && import.nodes[0].meshes.len() == import.meshes.len(), "{report}");
        assert!(import.meshes.iter().all(|mesh| mesh.vertices.len() <= most));
        import.meshes.iter().for_each(|mesh| check_clusters(mesh, &options));
        assert_eq!(report.before.triangles, report.after.triangles);
        if most < 65_535 {
            let mut parts: Vec<_> = import.meshes.iter().flat_map(sorted_corners).collect();
            parts.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
            assert_eq!(parts, whole);
        }
    }
}

#[test]
fn a_budget_of_triangles_is_kept() {
    for budget in [3000, 500, 60] {
        let options = Options { max_triangles: Some(budget), ..Options::default() };
        let (import, report) = read_with("a.obj", grid(40, 0.1), &options).expect("a grid");
        let mesh = only_mesh(&import);
        assert!(mesh.triangles.len() <= budget && 2 * mesh.triangles.len() > budget, "{report}");
        check_clusters(mesh, &options);
        let error = report.notes.iter().find_map(|note| match note {
            Note::Simplified { from: 3200, error, .. } => Some(*error),
            _ => None,
        });
        // The whole wave is 0.2 high.
        assert!(error.is_some_and(|error| error < 0.2), "{report}");
    }
    // In units of the file, whatever the scale is.
    let error = |scale| {
        let options = Options { max_triangles: Some(200), scale, ..Options::default() };
        let (_, report) = read_with("a.obj", grid(40, 0.1), &options).expect("a grid");
        let error = |note: &Note| if let Note::Simplified { error, .. } = note { Some(*error) } else { None };
        report.notes.iter().find_map(error).expect("a simpler grid")
    };
    assert!(error(1.0) > 0.0 && (error(256.0) / error(1.0) - 1.0).abs() < 1e-3, "{} {}", error(256.0), error(1.0));
    let options = Options { max_triangles: Some(4000), ..Options::default() };
    let (_, report) = read_with("a.obj", grid(40, 0.1), &options).expect("a grid");
    assert_eq!((report.after.triangles, report.to_string().contains("simplified")), (3200, false));
}

/// A wave whose left half has another material than its right half.
fn two_materials(n: usize) -> String {
    let (vertices, faces): (Vec<_>, Vec<_>) =
        grid(n, 0.1).lines().map(str::to_owned).partition(|line| line.starts_with('v'));
    let (left, right): (Vec<_>, Vec<_>) = faces.into_iter().enumerate().partition(|(k, _)| k % n < n / 2);
    let lines = |faces: Vec<(usize, String)>| faces.into_iter().map(|(_, line)| line + "\n").collect::<String>();
    format!("{}\nusemtl left\n{}usemtl right\n{}", vertices.join("\n"), lines(left), lines(right))
}

#[test]
fn materials_that_meet_leave_no_seam() {
    let options = Options { crease_angle: 180.0, ..Options::default() };
    let (import, report) = read_with("a.obj", two_materials(8), &options).expect("a wave");
    assert_eq!(import.meshes.len(), 2);
    assert!(has(&report, &Note::OpenEdges { edges: 32 }), "{report}");
    let normals = |mesh: &Mesh| {
        let on_seam = |v: &usize| mesh.vertices.positions[*v][0] == 0.5;
        let normal =
            |v: usize| (mesh.vertices.positions[v].map(f32::to_bits), mesh.vertices.normals[v].map(f32::to_bits));
        (0..mesh.vertices.len()).filter(on_seam).map(normal).collect::<BTreeSet<_>>()
    };
    assert_eq!(normals(&import.meshes[0]).len(), 9);
    assert_eq!(normals(&import.meshes[0]), normals(&import.meshes[1]));
}

#[test]
fn simplifying_tears_no_gap_between_materials() {
    let options = Options { max_triangles: Some(200), ..Options::default() };
    let (import, report) = read_with("a.obj", two_materials(20), &options).expect("a wave");
    assert!(report.after.triangles < 400 && import.meshes.len() == 2, "{report}");
    let seam = |mesh: &Mesh| {
        let positions = mesh.vertices.positions.iter().filter(|p| p[0] == 0.5);
        positions.map(|p| p.map(f32::to_bits)).collect::<BTreeSet<_>>()
    };
    assert_eq!(seam(&import.meshes[0]).len(), 21);
    assert_eq!(seam(&import.meshes[0]), seam(&import.meshes[1]));
}

#[test]
fn extreme_sizes_are_no_trouble() {
    for scale in ["e-38", "e-20", "e18", "e37"] {
        let text = format!("v 0 0 0\nv 1{scale} 0 0\nv 1{scale} 1{scale} 0\nv 0 1{scale} 1{scale}\nf 1 2 3\nf 1 3 4\n");
        let options = Options { max_triangles: Some(1), ..Options::default() };
        let (import, report) = read_with("a.obj", &text, &Options::default()).expect("two triangles");
        assert_eq!(only_mesh(&import).triangles.len(), 2, "{scale}: {report}");
        assert!(only_mesh(&import).vertices.normals.iter().all(|n| (dot(wide(*n), wide(*n)) - 1.0).abs() < 1e-5));
        read_with("a.obj", &text, &options).expect("a triangle");
    }
}
