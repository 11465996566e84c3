//! PLY: text, and binary of both byte orders.

use zstrip_assets::{Kind, Note, Options, Place};

use crate::support::{Folder, corners, has, only_mesh, png, read};

const PROPERTIES: &str = "element vertex 4\nproperty float x\nproperty double y\nproperty short z\n\
                          property uchar red\nproperty uchar green\nproperty uchar blue\n\
                          element face 1\nproperty list uchar int vertex_indices\nend_header\n";

/// A square with colours, in text or in binary.
pub fn square(format: &str) -> Vec<u8> {
    let mut bytes = format!("ply\nformat {format} 1.0\ncomment made by a test\n{PROPERTIES}").into_bytes();
    let corners = [(0.0f32, 0.0f64, 7i16), (1.0, 0.0, 7), (1.0, 1.0, 7), (0.0, 1.0, 7)];
    for (x, y, z) in corners {
        match format {
            "ascii" => bytes.extend(format!("{x} {y} {z} 255 0 51\n").into_bytes()),
            "binary_little_endian" => {
                bytes.extend(x.to_le_bytes().iter().chain(&y.to_le_bytes()).chain(&z.to_le_bytes()));
                bytes.extend([255, 0, 51]);
            }
            _ => {
                bytes.extend(x.to_be_bytes().iter().chain(&y.to_be_bytes()).chain(&z.to_be_bytes()));
                bytes.extend([255, 0, 51]);
            }
        }
    }
    match format {
        "ascii" => bytes.extend(b"4 0 1 2 3\n"),
        "binary_little_endian" => bytes.extend([4].into_iter().chain((0..4i32).flat_map(i32::to_le_bytes))),
        _ => bytes.extend([4].into_iter().chain((0..4i32).flat_map(i32::to_be_bytes))),
    }
    bytes
}

#[test]
fn text_and_both_byte_orders_give_the_same() {
    let (text, _) = read("a.ply", square("ascii")).expect("a square");
    let mesh = only_mesh(&text);
    assert_eq!((mesh.triangles.len(), mesh.vertices.len()), (2, 4));
    assert!(mesh.vertices.colors.iter().all(|color| *color == [1.0, 0.0, 0.2, 1.0]));
    for format in ["binary_little_endian", "binary_big_endian"] {
        let (import, _) = read("a.ply", square(format)).expect("a square");
        assert_eq!(import, text, "{format}");
    }
}

#[test]
fn corners_may_have_texture_coordinates_of_their_own() {
    let text = "ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement face 2\n\
                property list uchar uint vertex_index\nproperty list uchar float texcoord\n\
                element vertex 4\nproperty float x\nproperty float y\nproperty float z\nend_header\n\
                3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0.5 0 1 1 0 1\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    let folder = Folder::new().with("a.ply", text).with("a.png", png(2, 2));
    let (import, _) = folder.import("a.ply", &Options::default()).expect("a square");
    let mesh = only_mesh(&import);
    // Vertex 0 has two texture coordinates, vertex 2 one.
    assert_eq!(mesh.vertices.len(), 5);
    let at = |p: [f32; 3]| mesh.vertices.positions.iter().position(|q| *q == p).expect("a vertex");
    assert_eq!(mesh.vertices.uvs[at([1.0, 0.0, 0.0])], [1.0, 1.0]);
    assert_eq!(mesh.vertices.uvs[at([0.0, 1.0, 0.0])], [0.0, 0.0]);
    assert_eq!(import.materials[0].texture.expect("a texture").image, 0);
}

#[test]
fn strips_turn_every_second_triangle() {
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
                0 0 0\n1 0 0\n0 1 0\n1 1 0\n9 0 1 2 3 -1 2 1 3 -1\n";
    let (import, report) = read("a.ply", text).expect("a strip");
    assert!(has(&report, &Note::Duplicate { triangles: 1 }), "{report}");
    let mesh = only_mesh(&import);
    assert_eq!(corners(mesh).len(), 2);
    assert!(mesh.vertices.normals.iter().all(|normal| *normal == [0.0, 0.0, 1.0]));
}

/// Strips have no coordinates of their corners, and lists may be longer or shorter than polygons.
#[test]
fn texture_coordinates_of_some_corners_do_not_hinder_the_others() {
    let vertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float u\n\
                    property float v\n";
    let faces = "element face 2\nproperty list uchar uint vertex_index\nproperty list uchar float texcoord\n";
    let strips = "element tristrips 1\nproperty list int int vertex_indices\n";
    let (vertex_lines, strip_lines) = ("0 0 0 0.25 0\n1 0 0 0.25 0\n1 1 0 0.25 0\n0 1 0 0.25 0\n", "4 3 2 1 -1\n");
    for texcoord in ["1 0.5", "2 0.5 0.75", "7 0.5 0.75 0.5 0.75 0.5 0.75 0.5", "8 0.5 0.75 0 0 0 0 0 0"] {
        let face_lines = format!("3 0 1 2 {texcoord}\n3 0 2 3 0\n");
        for (elements, lines) in [
            (format!("{faces}{strips}"), format!("{face_lines}{strip_lines}")),
            (format!("{strips}{faces}"), format!("{strip_lines}{face_lines}")),
        ] {
            let text = format!("ply\nformat ascii 1.0\n{vertices}{elements}end_header\n{vertex_lines}{lines}");
            let (import, _) = read("a.ply", text).expect("three triangles");
            let mesh = only_mesh(&import);
            assert_eq!((mesh.triangles.len(), mesh.vertices.uvs.len()), (3, mesh.vertices.len()));
            let at = |p: [f32; 3], uv: [f32; 2]| {
                mesh.vertices.positions.iter().zip(&mesh.vertices.uvs).any(|(q, found)| (*q, *found) == (p, uv))
            };
            assert!(at([0.0, 1.0, 0.0], [0.25, 1.0]), "those of the vertex: {texcoord}");
            assert_eq!(at([0.0, 0.0, 0.0], [0.5, 0.25]), texcoord != "1 0.5", "those of the corner: {texcoord}");
        }
    }
}

#[test]
fn errors_name_the_face_that_is_wrong() {
    let header = |format: &str, faces: usize, strips: usize| {
        format!(
            "ply\nformat {format} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             element face {faces}\nproperty list uchar ushort vertex_indices\n\
             element tristrips {strips}\nproperty list int int vertex_indices\nend_header\n"
        )
    };
    let text = format!("{}0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n4 0 1 2 0\n3 2 1 9\n", header("ascii", 3, 0));
    let error = read("a.ply", &text).expect_err("a face");
    assert_eq!((error.place, error.kind), (Place::Line(text.lines().count()), Kind::Index));
    let text = format!("{}0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n4 0 1 2 -3\n", header("ascii", 0, 2));
    let error = read("a.ply", &text).expect_err("a strip");
    assert_eq!((error.place, error.kind), (Place::Line(text.lines().count()), Kind::Index));
    for format in ["binary_little_endian", "binary_big_endian"] {
        let mut bytes = header(format, 3, 0).into_bytes();
        bytes.extend([0; 36]);
        for corners in [&[0_u16, 1, 2][..], &[0, 1, 2, 0], &[2, 1, 9]] {
            bytes.push(corners.len() as u8);
            let big = format.contains("big");
            bytes.extend(corners.iter().flat_map(|c| if big { c.to_be_bytes() } else { c.to_le_bytes() }));
        }
        let error = read("a.ply", &bytes).expect_err("a face");
        assert_eq!((error.place, error.kind), (Place::Byte(bytes.len() - 7), Kind::Index), "{format}");
    }
}

#[test]
fn errors_say_line_or_byte() {
    let text = String::from_utf8(square("ascii")).expect("text");
    let first = text.lines().position(|line| line == "end_header").expect("a header") + 2;
    let wrong = |from: &str, to: &str| read("a.ply", text.replacen(from, to, 1)).expect_err(to);
    let error = wrong("1 1 7", "1 one 7");
    assert_eq!((&error.place, error.kind), (&Place::Line(first + 2), Kind::Syntax), "{error}");
    let error = wrong("1 1 7", "nan 1 7");
    assert_eq!((&error.place, error.kind), (&Place::Line(first + 2), Kind::Syntax), "{error}");
    let error = wrong("1 1 7", "1e99 1 7");
    assert_eq!((&error.place, error.kind), (&Place::Line(first + 2), Kind::NonFinite), "{error}");
    let error = wrong("4 0 1 2 3", "4 0 1 2 4");
    assert_eq!((&error.place, error.kind), (&Place::Line(first + 4), Kind::Index), "{error}");
    assert!(error.message.contains("vertex 4") && error.message.contains("4 vertices"), "{error}");
    assert_eq!(wrong("4 0 1 2 3", "4 0 1 2 -3").kind, Kind::Index);
    assert_eq!(wrong("property float x", "property float q").kind, Kind::Missing);
    assert_eq!(wrong("ascii", "text").kind, Kind::Syntax);
    assert_eq!(wrong("vertex 4", "vertex 4000000000").kind, Kind::Syntax);
    assert_eq!(wrong("element face", "element empty 4000000000\nelement face").kind, Kind::Syntax);

    let bytes = square("binary_little_endian");
    let body = bytes.len() - 17 - 4 * 17;
    let mut wrong = bytes.clone();
    wrong[body + 17..body + 21].copy_from_slice(&f32::INFINITY.to_le_bytes());
    let error = read("a.ply", wrong).expect_err("a position");
    assert_eq!((error.place, error.kind), (Place::Byte(body + 17), Kind::NonFinite));
    let error = read("a.ply", &bytes[..bytes.len() - 1]).expect_err("an end");
    assert_eq!((error.place, error.kind), (Place::Byte(bytes.len() - 1), Kind::Syntax));
}
