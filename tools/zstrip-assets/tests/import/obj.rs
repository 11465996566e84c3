//! OBJ and MTL.

use std::path::Path;

use image::ImageFormat;
use zstrip_assets::{AlphaMode, Kind, Note, Options, Place, Progress, Winding, Wrap, import_with_progress};

use crate::support::{Folder, corners, has, only_mesh, picture, png, read, read_with, sorted_corners};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn obj(faces: &str) -> String {
    format!("{SQUARE}{faces}")
}

#[test]
fn negative_indices_count_from_the_last_vertex() {
    let (forward, _) = read("a.obj", obj("f 1 2 3")).expect("a triangle");
    let (backward, _) = read("a.obj", obj("f -4 -3 -2\nv 9 9 9")).expect("a triangle");
    assert_eq!(corners(only_mesh(&forward)), corners(only_mesh(&backward)));
}

#[test]
fn v_points_down() {
    let (import, _) = read("a.obj", obj("vt 0 0\nvt 1 0\nvt 1 0.75\nf 1/1 2/2 3/3")).expect("a triangle");
    let vertices = &only_mesh(&import).vertices;
    for (position, uv) in vertices.positions.iter().zip(&vertices.uvs) {
        assert_eq!(*uv, [position[0], 1.0 - 0.75 * position[1]]);
    }
}

#[test]
fn colours_of_vertices_may_follow_w() {
    let text = "v 0 0 0 1 0 0\nv 1 0 0 1 0 0.5 2\nv 0 1 0\nf 1 2 3";
    let (import, _) = read("a.obj", text).expect("a triangle");
    let vertices = &only_mesh(&import).vertices;
    let color = |position| {
        let at = vertices.positions.iter().position(|p| *p == position).expect("a vertex");
        vertices.colors[at]
    };
    assert_eq!(color([0.0, 0.0, 0.0]), [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(color([1.0, 0.0, 0.0]), [0.0, 0.5, 1.0, 1.0]);
    assert_eq!(color([0.0, 1.0, 0.0]), [1.0; 4]);
}

#[test]
fn lines_go_on_after_a_backslash_and_errors_count_them() {
    let (import, _) = read("a.obj", obj("f 1 2 \\\n 3 4 # a comment")).expect("a square");
    assert_eq!(only_mesh(&import).triangles.len(), 2);
    let error = read("a.obj", obj("f 1 2 \\\n 3\nf 1 2 9")).expect_err("an index");
    assert_eq!((error.place.clone(), error.kind), (Place::Line(7), Kind::Index));
    let text = error.to_string();
    assert!(text.contains("position 9") && text.contains('4'), "{text}");
}

#[test]
fn errors_say_the_line() {
    for (text, line, kind) in [
        ("v 0 0\n", 1, Kind::Syntax),
        ("\nv 0 0 nan\n", 2, Kind::NonFinite),
        ("v 0 0 1e99\n", 1, Kind::NonFinite),
        ("v 0 0 0\nf 1 1 0\n", 2, Kind::Index),
        ("v 0 0 0\nf 1 1 -2\n", 2, Kind::Index),
        ("v 0 0 0\nf 1/1 1 1\n", 2, Kind::Index),
        ("v 0 0 0\nf 1//1 1 1\n", 2, Kind::Index),
        ("v 0 0 0\nf 1/1/1/1 1 1\n", 2, Kind::Index),
        ("v 0 0 0\nf a b c\n", 2, Kind::Syntax),
        ("vn 0 one 0\n", 1, Kind::Syntax),
        ("v 0 0 0\nf 9223372036854775807 1 -9223372036854775808\n", 2, Kind::Index),
    ] {
        let error = read("a.obj", text).expect_err(text);
        assert_eq!((&error.place, error.kind), (&Place::Line(line), kind), "{text:?}: {error}");
    }
    assert_eq!(read("a.obj", "v 0 0 0\n").expect_err("no face").kind, Kind::Empty);
    assert_eq!(read("a.obj", "").expect_err("no face").kind, Kind::Empty);
    assert_eq!(read("a.obj", b"\xFF\xFEv\0").expect_err("UTF-16").kind, Kind::Syntax);
    assert_eq!(read("a.txt", "v 0 0 0\n").expect_err("a name").kind, Kind::Unsupported);
}

#[test]
fn smoothing_groups_decide_where_normals_are_missing() {
    // Two squares that meet at a right angle, which is beyond the crease angle.
    let squares = |groups: [&str; 2]| {
        let [a, b] = groups;
        format!("{SQUARE}v 1 0 -1\nv 1 1 -1\n{a}\nf 1 2 3 4\n{b}\nf 2 5 6 3\n")
    };
    let count = |groups| {
        let (import, _) = read("a.obj", squares(groups)).expect("squares");
        only_mesh(&import).vertices.len()
    };
    assert_eq!(count(["", ""]), 8);
    assert_eq!(count(["s 1", "s 1"]), 6);
    assert_eq!(count(["s 1", "s 2"]), 8);
    assert_eq!(count(["s off", "s 0"]), 8);
}

#[test]
fn materials_and_their_textures_are_read() {
    let mtl = "newmtl wood\nKd 0.5 0.25 1\nd 0.5\nmap_Kd -s 1 1 1 -clamp on my \\\ntexture.png\n\
               newmtl lamp\nillum 0\nTr 0.25\nmap_Bump x.png\nnewmtl leaf\nmap_Kd sub\\leaf.png\nmap_d sub\\leaf.png\n";
    let text = obj("mtllib my materials.mtl\nusemtl wood\nf 1 2 3\nusemtl lamp\nf 1 3 4\nusemtl leaf\nf 1 2 4\n");
    let folder = Folder::new().with("a.obj", text).with("my materials.mtl", mtl).with("my  texture.png", png(2, 1));
    std::fs::create_dir(folder.path("sub")).expect("a folder");
    let folder = folder.with("sub/leaf.png", png(4, 4));
    let (import, report) = folder.import("a.obj", &Options::default()).expect("a model");
    let [wood, lamp, leaf] = &import.materials[..] else { panic!("{:?}", import.materials) };
    assert_eq!((&wood.name[..], wood.color, wood.alpha), ("wood", [0.5, 0.25, 1.0, 0.5], AlphaMode::Blend));
    let texture = wood.texture.expect("a texture");
    let image = &import.images[texture.image];
    assert_eq!((image.width, image.height, &image.texels[..4]), (2, 1, &[10, 20, 30, 255][..]));
    assert_eq!(texture.wrap, [Wrap::Clamp; 2]);
    assert!(lamp.unlit && lamp.color[3] == 0.75);
    assert_eq!(leaf.alpha, AlphaMode::Mask { cutoff: 0.5 });
    assert_eq!(import.images[leaf.texture.expect("a texture").image].width, 4);
    assert!(has(&report, &Note::Ignored { what: "map_Bump in materials".to_owned(), count: 1 }), "{report}");
}

#[test]
fn alpha_needs_the_image_of_the_colour() {
    let mtl = "newmtl a\nmap_d a.png\nnewmtl b\nmap_Kd a.png\nmap_d b.png\n";
    let obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 3 2\n";
    let folder = Folder::new().with("a.obj", obj).with("a.mtl", mtl).with("a.png", png(2, 2));
    let (import, report) = folder.import("a.obj", &Options::default()).expect("two triangles");
    assert!(import.materials.iter().all(|material| material.alpha == AlphaMode::Opaque));
    for what in ["map_d without map_Kd", "map_d that is not the image of map_Kd"] {
        assert!(has(&report, &Note::Ignored { what: what.to_owned(), count: 1 }), "{report}");
    }
}

#[test]
fn images_are_known_by_their_bytes() {
    for format in [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Bmp] {
        let folder = Folder::new()
            .with("a.obj", obj("mtllib a.mtl\nusemtl a\nf 1 2 3"))
            .with("a.mtl", "newmtl a\nmap_Kd a.img")
            .with("a.img", picture(5, 3, format));
        let (import, _) = folder.import("a.obj", &Options::default()).expect("a triangle");
        let image = &import.images[0];
        assert_eq!((image.width, image.height, image.texels.len()), (5, 3, 60), "{format:?}");
        let texel = [10, 20, 30, 255];
        // JPEG is not exact.
        let near = |(k, value): (usize, &u8)| value.abs_diff(texel[k % 4]) <= 2;
        assert!(image.texels.iter().enumerate().all(near), "{format:?}: {:?}", image.texels);
    }
    let folder = Folder::new()
        .with("a.obj", obj("mtllib a.mtl\nusemtl a\nf 1 2 3"))
        .with("a.mtl", "newmtl a\nmap_Kd a.png")
        .with("a.png", b"GIF89a\x01\0\x01\0\0\0\0");
    let (_, report) = folder.import("a.obj", &Options::default()).expect("a triangle");
    assert!(report.to_string().contains("save it as PNG"), "{report}");
}

#[test]
fn progress_is_told_before_each_mesh() {
    let folder = Folder::new().with("a.obj", obj("f 1 2 3"));
    let mut stages = Vec::new();
    import_with_progress(&folder.path("a.obj"), &Options::default(), &mut |stage| stages.push(stage)).expect("one");
    assert_eq!(stages, [Progress::Reading, Progress::Mesh { number: 1, count: 1 }]);
}

#[test]
fn missing_materials_and_textures_are_reported_and_left_out() {
    let (import, report) = read("a.obj", obj("mtllib no.mtl\nusemtl wood\nf 1 2 3")).expect("a triangle");
    assert_eq!(only_mesh(&import).material, None);
    assert_eq!(report.notes.iter().filter(|note| matches!(note, Note::MaterialMissing { .. })).count(), 2, "{report}");

    for (file, bytes) in [("no.png", None), ("bad.png", Some(b"no image".to_vec())), ("../a.png", None)] {
        let mtl = format!("newmtl wood\nmap_Kd {file}\n");
        let mut folder = Folder::new().with("a.obj", obj("mtllib a.mtl\nusemtl wood\nf 1 2 3")).with("a.mtl", mtl);
        if let Some(bytes) = bytes {
            folder = folder.with(file, bytes);
        }
        let (import, report) = folder.import("a.obj", &Options::default()).expect("a triangle");
        assert_eq!(import.materials[0].texture, None);
        assert!(report.notes.iter().any(|note| matches!(note, Note::TextureMissing { .. })), "{report}");
    }
}

#[test]
fn names_need_not_be_utf8() {
    let text = [SQUARE.as_bytes(), b"o caf\xE9\nusemtl caf\xE9\nf 1 2 3\n"].concat();
    let (_, report) = read("a.obj", text).expect("a triangle");
    assert!(has(&report, &Note::NotUtf8 { lines: 2 }), "{report}");
}

#[test]
fn unknown_lines_are_counted() {
    let (_, report) = read("a.obj", obj("l 1 2\nl 2 3\ncurv 1 2\nf 1 2\nf 1 2 3")).expect("a triangle");
    assert!(has(&report, &Note::Ignored { what: "\"l\" lines".to_owned(), count: 2 }), "{report}");
    assert!(has(&report, &Note::Ignored { what: "\"curv\" lines".to_owned(), count: 1 }), "{report}");
}

#[test]
fn winding_can_be_flipped_or_taken_from_normals() {
    let text = obj("vn 0 0 -1\nf 1//1 2//1 3//1");
    let (kept, report) = read("a.obj", &text).expect("a triangle");
    assert!(has(&report, &Note::Opposed { triangles: 1 }), "{report}");
    for winding in [Winding::Flip, Winding::FromNormals] {
        let options = Options { winding, ..Options::default() };
        let (turned, report) = read_with("a.obj", &text, &options).expect("a triangle");
        assert!(has(&report, &Note::Flipped { triangles: 1 }), "{report}");
        let [a, b, c] = corners(only_mesh(&kept))[0];
        let turned = sorted_corners(only_mesh(&turned));
        assert!([[a, c, b], [c, b, a], [b, a, c]].contains(&turned[0]));
    }
}

/// A second reader must find the same triangles with the same attributes.
#[test]
fn tobj_reads_the_same_corners() {
    let mut text = String::new();
    let mut random = crate::support::Random(7);
    for _ in 0..50 {
        let mut number = || random.part() as f32;
        text += &format!("v {} {} {}\nvt {} {}\n", number(), number(), number(), number(), number());
        text += &format!("vn {} {} {}\n", number() + 0.1, number(), number());
    }
    for _ in 0..100 {
        let mut corner = || format!("{}/{}/{}", 1 + random.below(50), 1 + random.below(50), 1 + random.below(50));
        text += &format!("f {} {} {}\n", corner(), corner(), corner());
    }
    let options = tobj::LoadOptions { single_index: true, triangulate: true, ..tobj::LoadOptions::default() };
    let load = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &options, load).expect("a model");
    let mut theirs = Vec::new();
    for mesh in models.iter().map(|model| &model.mesh) {
        for t in mesh.indices.chunks_exact(3) {
            let corner = |k: u32| {
                let k = k as usize;
                let (p, n, t) = (&mesh.positions[3 * k..], &mesh.normals[3 * k..], &mesh.texcoords[2 * k..]);
                [p[0], p[1], p[2], n[0], n[1], n[2], t[0], 1.0 - t[1]]
            };
            theirs.push([corner(t[0]), corner(t[1]), corner(t[2])]);
        }
    }
    let (import, _) = read("a.obj", &text).expect("a model");
    let (mesh, mut ours) = (only_mesh(&import), Vec::new());
    for t in &mesh.triangles {
        let corner = |v: u32| {
            let (v, of) = (v as usize, &mesh.vertices);
            let ([x, y, z], [a, b, c], [s, t]) = (of.positions[v], of.normals[v], of.uvs[v]);
            [x, y, z, a, b, c, s, t]
        };
        ours.push(t.map(corner));
    }
    // tobj keeps what shows nothing: triangles with a position twice, and copies.
    theirs.retain(|t| t[0][..3] != t[1][..3] && t[1][..3] != t[2][..3] && t[2][..3] != t[0][..3]);
    let sort = |triangles: &mut Vec<[[f32; 8]; 3]>| {
        triangles.iter_mut().for_each(|t| {
            let least = (0..3).min_by(|a, b| t[*a].partial_cmp(&t[*b]).expect("numbers")).expect("a corner");
            t.rotate_left(least);
        });
        triangles.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    };
    sort(&mut ours);
    sort(&mut theirs);
    assert!(ours.len() > 80);
    assert_eq!(ours, theirs);
}
