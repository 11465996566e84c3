//! STL of both kinds.

use zstrip_assets::{Kind, Note, Options, Place, UpAxis, Winding};

use crate::support::{corners, has, only_mesh, read, read_with, sorted_corners};

const FACET: &str = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

fn y_up() -> Options {
    Options { up: Some(UpAxis::Y), ..Options::default() }
}

/// A binary file of one triangle.
pub fn binary(header: &[u8], corners: [f32; 9], count: u32) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, 0);
    bytes.extend(count.to_le_bytes());
    bytes.extend([0.0, 0.0, 1.0].iter().chain(&corners).flat_map(|x: &f32| x.to_le_bytes()));
    bytes.extend([0, 0]);
    bytes
}

#[test]
fn both_kinds_give_the_same() {
    let options = y_up();
    let (text, _) = read_with("a.stl", format!("solid part\n{FACET}endsolid part\n"), &options).expect("a triangle");
    let expected = corners(only_mesh(&text));
    for header in [&b"binary"[..], b"solid part", b"solid part\n facet"] {
        let bytes = binary(header, [0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0, 0.0], 1);
        let (import, _) = read_with("a.stl", bytes, &options).expect("a triangle");
        assert_eq!(corners(only_mesh(&import)), expected, "{header:?}");
    }
}

#[test]
fn text_may_be_in_capitals_without_a_name_and_in_several_solids() {
    let text = format!("\nSOLID\n{}ENDSOLID\n\nsolid b\n{}endsolid\n", FACET.to_uppercase(), FACET.replace('2', "3"));
    let (import, report) = read_with("a.stl", text.replace('\n', "\r\n"), &y_up()).expect("two triangles");
    assert_eq!(only_mesh(&import).triangles.len(), 2, "{report}");
}

#[test]
fn z_points_up_unless_told_otherwise() {
    let (import, _) = read("a.stl", format!("solid\n{FACET}endsolid\n")).expect("a triangle");
    let expected = [[[0.0, 0.0, -1.0], [0.0, 0.0, 0.0], [2.0, 0.0, 0.0]]];
    assert_eq!(sorted_corners(only_mesh(&import)), expected);
    assert!(only_mesh(&import).vertices.normals.iter().all(|normal| *normal == [0.0, 1.0, 0.0]));
}

#[test]
fn errors_say_line_or_byte() {
    for (text, line, kind) in [
        (format!("solid\n{}", FACET.replace("vertex 2 0 0", "vertex 2 0")), 5, Kind::Syntax),
        (format!("solid\n{}", FACET.replace("vertex 2 0 0", "vertex 2 0 inf")), 5, Kind::NonFinite),
        (format!("solid\n{FACET}"), 8, Kind::Syntax),
        (format!("solid\n{FACET}endsolid\nmore\n"), 10, Kind::Syntax),
        (format!("solid\n{FACET}{}", "facet normal 0 0\n"), 9, Kind::Syntax),
    ] {
        let error = read("a.stl", &text).expect_err(&text);
        assert_eq!((&error.place, error.kind), (&Place::Line(line), kind), "{text}: {error}");
    }
    let error = read("a.stl", binary(b"", [f32::NAN; 9], 1)).expect_err("a corner");
    assert_eq!((error.place, error.kind), (Place::Byte(84), Kind::NonFinite));
    let error = read("a.stl", binary(b"", [0.0; 9], u32::MAX)).expect_err("a size");
    assert_eq!((error.place.clone(), error.kind), (Place::Byte(80), Kind::Syntax));
    assert!(error.message.contains("214748364834") && error.message.contains("134"), "{error}");
    assert_eq!(read("a.stl", "so").expect_err("a size").kind, Kind::Syntax);
    assert_eq!(read("a.stl", "solid\nendsolid\n").expect_err("no triangle").kind, Kind::Empty);
}

#[test]
fn normals_of_the_file_tell_the_front() {
    let text = format!("solid\n{}endsolid\n", FACET.replace("0 0 1\n", "0 0 -1\n"));
    let (kept, report) = read_with("a.stl", &text, &y_up()).expect("a triangle");
    assert!(has(&report, &Note::Opposed { triangles: 1 }), "{report}");
    let options = Options { winding: Winding::FromNormals, ..y_up() };
    let (turned, report) = read_with("a.stl", &text, &options).expect("a triangle");
    assert!(has(&report, &Note::Flipped { triangles: 1 }), "{report}");
    assert_eq!(only_mesh(&kept).vertices.normals[0], [0.0, 0.0, 1.0]);
    assert_eq!(only_mesh(&turned).vertices.normals[0], [0.0, 0.0, -1.0]);
}
