//! Levels of detail: smaller, within their errors, and chosen by size on the screen.

use std::fmt::Write;

use zstrip::bytemuck::{cast_slice, pod_collect_to_vec, pod_read_unaligned};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::Rgb888;
use zstrip::light::Sun;
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::model::container::{Header, NONE, Part, SectionKind};
use zstrip::model::{Camera, Model};
use zstrip_assets::{Import, Mesh, Note, Options, WriteOptions, write};

use crate::figures::sphere;
use crate::support::read_with;

/// Imports a mesh that is a file, with levels of detail.
fn with_levels(mesh: &Mesh, more: &str, options: &Options) -> (Import, zstrip_assets::Report) {
    let mut text = String::new();
    let of = &mesh.vertices;
    for ((p, n), uv) in of.positions.iter().zip(&of.normals).zip(&of.uvs) {
        writeln!(text, "v {} {} {}\nvn {} {} {}\nvt {} {}", p[0], p[1], p[2], n[0], n[1], n[2], uv[0], 1.0 - uv[1])
            .expect("text");
    }
    for t in &mesh.triangles {
        let corner = |k: usize| format!("{0}/{0}/{0}", t[k] + 1);
        writeln!(text, "f {} {} {}", corner(0), corner(1), corner(2)).expect("text");
    }
    read_with("mesh.obj", text + more, options).expect("a model")
}

fn options(lods: usize) -> Options {
    Options { lods, ..Options::default() }
}

/// Returns a mesh and its levels, the finest first.
fn chain(import: &Import) -> Vec<&Mesh> {
    let mut chain = vec![&import.meshes[import.nodes[0].meshes[0]]];
    while let Some(coarser) = chain[chain.len() - 1].coarser {
        chain.push(&import.meshes[coarser]);
    }
    chain
}

/// Returns the distance of a point from the nearest of a mesh's triangles, each looked at in many points.
fn sampled_distance(p: [f64; 3], mesh: &Mesh) -> f64 {
    let mut least = f64::INFINITY;
    for t in &mesh.triangles {
        let corners = t.map(|v| mesh.vertices.positions[v as usize].map(f64::from));
        for i in 0..=8 {
            for j in 0..=8 - i {
                let (s, t) = (f64::from(i) / 8.0, f64::from(j) / 8.0);
                let [a, b, c] = corners;
                let square = (0..3).map(|k| (a[k] + s * (b[k] - a[k]) + t * (c[k] - a[k]) - p[k]).powi(2)).sum::<f64>();
                least = least.min(square);
            }
        }
    }
    least.sqrt()
}

#[test]
fn levels_get_smaller_and_their_errors_are_true() {
    let (model, report) = with_levels(&sphere(32, 20, 2.0), "", &options(3));
    let chain = chain(&model);
    assert_eq!(chain.len(), 4, "{report}");
    assert_eq!((report.after.meshes, report.after.triangles), (1, 1280), "levels are not counted");
    assert_eq!(chain[0].error, 0.0);
    for (finer, coarser) in chain.iter().zip(&chain[1..]) {
        let (few, many) = (coarser.triangles.len(), finer.triangles.len());
        assert!(few * 10 <= many * 6 && few * 10 >= many * 4, "{few} of {many}");
        assert!(coarser.error >= finer.error && coarser.error > 0.0, "{} after {}", coarser.error, finer.error);
        // Middles of the level's triangles, and vertices of the mesh.
        let middles = coarser.triangles.iter().map(|t| {
            let corners = t.map(|v| coarser.vertices.positions[v as usize].map(f64::from));
            std::array::from_fn(|k| corners.iter().map(|p| p[k]).sum::<f64>() / 3.0)
        });
        let away = middles.step_by(3).map(|p| sampled_distance(p, chain[0])).fold(0.0, f64::max);
        let points = chain[0].vertices.positions.iter().step_by(3).map(|p| p.map(f64::from));
        let back = points.map(|p| sampled_distance(p, coarser)).fold(0.0, f64::max);
        // Samples of the mesh's triangles, of 0.4 units, are 0.05 apart, so the distance to them is above by up to
        // 0.01 at this curvature; a level's triangles are larger.
        let sampled = away.max(back);
        println!("{few} triangles: error {}, sampled {away} and {back}", coarser.error);
        assert!(coarser.error > 0.7 * sampled && coarser.error < 8.0 * sampled + 0.01, "{} {sampled}", coarser.error);
        assert!(coarser.clusters.iter().map(|cluster| cluster.count).sum::<usize>() == few);
    }
}

fn container(model: &Import) -> (Vec<u32>, usize) {
    let written = write(model, &WriteOptions::default()).expect("a container");
    let mut bytes = written.bytes.clone();
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    (pod_collect_to_vec(&bytes), written.bytes.len())
}

#[test]
fn near_models_are_drawn_as_they_are_and_far_ones_by_coarse_levels() {
    let (imported, _) = with_levels(&sphere(32, 20, 2.0), "", &options(3));
    let (words, length) = container(&imported);
    let bytes = &cast_slice::<u32, u8>(&words)[..length];
    let header: Header = pod_read_unaligned(&bytes[..size_of::<Header>()]);
    let section = header.table[SectionKind::Parts as usize];
    let parts: Vec<Part> = pod_collect_to_vec(&bytes[section.offset as usize..][..section.count as usize * 116]);
    assert_eq!(parts.iter().map(|part| part.coarser).collect::<Vec<_>>(), [1, 2, 3, NONE]);
    for (part, mesh) in parts.iter().zip(chain(&imported)) {
        // In steps of 16.16, with what positions lose.
        let exact = mesh.error * 65_536.0;
        assert!((exact..exact + 40.0).contains(&f64::from(part.error)), "{} {exact}", part.error);
    }
    let model = Model::from_bytes(bytes).expect("a model");
    assert_eq!(Model::draws(bytes), 1);
    let sun = Sun::new(Vec3::Z, Rgb888::new(200, 200, 200), Rgb888::new(50, 50, 50));
    let size = Size::new(240, 320);
    let mut seen = vec![];
    for distance in [6, 12, 25, 50, 100, 200, 400, 800] {
        let lens = Projective::perspective(Angle16::from_degrees(40), size, Scalar::ONE, Scalar::from_num(2000));
        let view = Affine::translation(Vec3::from_ints(0, 0, -distance));
        let camera = Camera { lens: lens.expect("a lens"), view, screen: size };
        let mut places = [None; 1];
        let placed = model.place(&Affine::IDENTITY, &camera, &sun, &mut places).expect("places");
        let part = placed.draws().next().expect("a draw").1;
        // Pixels of a unit at the middle of the model.
        let pixels = 160.0 / 20_f64.to_radians().tan() / f64::from(distance);
        let off = |part: usize| f64::from(parts[part].error) / 65_536.0 * pixels;
        assert!(off(part) <= 1.01, "part {part} at {distance} is off by {} pixels", off(part));
        assert!(part == 3 || off(part + 1) >= 0.99, "part {part} at {distance}: the next is off by {}", off(part + 1));
        seen.push(part);
    }
    println!("{seen:?}");
    assert!(seen.is_sorted() && seen[0] == 0 && seen[7] == 3, "{seen:?}");
}

#[test]
fn borders_between_materials_stay_in_all_levels() {
    // Two halves of a sphere, of two materials.
    let mut mesh = sphere(32, 20, 2.0);
    let half = mesh.triangles.split_off(mesh.triangles.len() / 2);
    let mut more = String::from("usemtl other\n");
    for t in &half {
        writeln!(more, "f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}", t[0] + 1, t[1] + 1, t[2] + 1).expect("text");
    }
    let (model, report) = with_levels(&mesh, &more, &options(2));
    let shown = &model.nodes[0].meshes;
    assert_eq!(shown.len(), 2, "{report}");
    let places = |mesh: &Mesh| mesh.vertices.positions.iter().map(|p| p.map(f32::to_bits)).collect::<Vec<_>>();
    let [a, b] = [&model.meshes[shown[0]], &model.meshes[shown[1]]];
    let border: Vec<_> = places(a).into_iter().filter(|p| places(b).contains(p)).collect();
    assert!(border.len() > 20, "{}", border.len());
    let mut levels = 0;
    for mesh in &model.meshes[2..] {
        let own = places(mesh);
        assert!(border.iter().all(|p| own.contains(p)), "a vertex of the border is gone");
        levels += 1;
    }
    assert!(levels >= 2, "{report}");
}

#[test]
fn meshes_that_cannot_have_levels_are_reported() {
    let (model, report) = with_levels(&sphere(4, 2, 1.0), "", &options(8));
    assert!(model.meshes.len() < 9 && report.notes.iter().any(|note| matches!(note, Note::LevelsEnded { meshes: 1 })));
    assert!(report.to_string().contains("1 mesh with fewer levels"), "{report}");
    let (model, _) = with_levels(&sphere(8, 8, 1.0), "", &options(0));
    assert_eq!(model.meshes.len(), 1);
    for wrong in [Options { lods: 16, ..Options::default() }, Options { lod_ratio: 0.95, ..options(1) }] {
        let found = read_with("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", &wrong);
        assert!(found.is_err(), "{wrong:?}");
    }
}
