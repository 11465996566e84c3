//! Models of a user's own, as `ci/bench MODEL.obj` takes them: what is read, and what is said of files that are not.

#[path = "../examples/obj/mod.rs"]
#[allow(dead_code)] // examples/obj_bench.rs uses all of it
mod obj;

use obj::{Buffers, HEIGHT, MOST, Model, RECORDS, WIDTH, Way, read};
use std::fmt::Write;
use std::path::PathBuf;
use zstrip::embedded_graphics_core::pixelcolor::IntoStorage;
use zstrip::math::Scalar;

/// Writes a file, and returns its path.
fn file(name: &str, text: &[u8]) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, text).expect("a file");
    path
}

fn error(name: &str, text: &[u8]) -> String {
    let path = file(name, text);
    let error = read::read(&path).expect_err("no model");
    error.strip_prefix(&format!("{}: ", path.display())).expect("the name comes first").to_owned()
}

/// A grid of one by `count` squares, side by side.
fn squares(count: usize) -> String {
    let mut text = String::new();
    for k in 0..count {
        let at = 4 * k + 1;
        for (x, y) in [(k, 0), (k + 1, 0), (k + 1, 1), (k, 1)] {
            writeln!(text, "v {}.{} {y} 0", 2 * x, x % 7).expect("a string");
        }
        writeln!(text, "f {} {} {} {}", at, at + 1, at + 2, at + 3).expect("a string");
    }
    text
}

/// Triangles drawn and pixels covered in one strip; pictures in strips of 16 rows are compared.
fn drawn(words: &[u32], way: Way) -> (u32, usize) {
    let mut uvs = vec![[Scalar::ZERO; 2]; MOST];
    let model = Model::new(words, &mut uvs).expect("a model");
    let mut records = vec![0; RECORDS];
    let mut frame = |rows: usize| {
        let (mut color, mut depth) = (vec![0; WIDTH * rows], vec![0; WIDTH * rows]);
        let mut picture = Vec::new();
        let buffers = Buffers { color: &mut color, depth: &mut depth, records: &mut records };
        let stats = model.draw(way, buffers, &mut |strip| picture.extend_from_slice(strip));
        (stats.drawn, picture)
    };
    let (drawn, picture) = frame(HEIGHT);
    assert!(picture == frame(16).1, "strips show another picture");
    (drawn, picture.iter().filter(|pixel| **pixel != obj::BACKGROUND.into_storage()).count())
}

#[test]
fn polygons_are_cut_into_triangles_and_fill_the_screen() {
    let text = "v 10 10 5\nv 30 10 5\nv 40 20 5\nv 30 30 5\nv 10 30 5\nvt 0 0\nvt 4 0\nvt 4 4\nvt 2 4\nvt 0 4\n\
                f 1/1 2/2 3/3 4/4 5/5\n";
    let words = read::read(&file("pentagon.obj", text.as_bytes())).expect("a model");
    for way in [Way::Flat, Way::Gouraud, Way::Textured, Way::Lit] {
        let (drawn, pixels) = drawn(&words, way);
        assert_eq!(drawn, 3, "{way:?}");
        assert!(pixels > 20_000, "{way:?}: {pixels} px");
    }
}

#[test]
fn a_model_without_texture_coordinates_is_not_textured() {
    let path = file("triangle.obj", b"mtllib no.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl none\nf 1 2 3\n");
    let words = read::read(&path).expect("a model");
    let mut uvs = vec![[Scalar::ZERO; 2]; MOST];
    let model = Model::new(&words, &mut uvs).expect("a model");
    let has = [Way::Flat, Way::Gouraud, Way::Textured, Way::Lit].map(|way| model.has(way));
    assert_eq!(has, [true, true, false, false]);
}

#[test]
fn files_that_are_no_models_are_errors() {
    let missing = read::read("/nowhere/no.obj".as_ref());
    assert_eq!(missing, Err("/nowhere/no.obj: there is no such file".to_owned()));
    assert_eq!(error("empty.obj", b""), "the file is empty");
    assert_eq!(error("faceless.obj", b"v 0 0 0\n"), "there are no faces in it: is it a Wavefront OBJ file?");
    assert_eq!(error("point.obj", b"v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n"), "all of its points are one");
    assert_eq!(error("nan.obj", b"v NaN 2 3\nv 1 0 3\nv 1 2 3\nf 1 2 3\n"), "a coordinate is not a finite number");
    assert!(error("far.obj", b"v 0 0 0\nf 1 2 3\n").ends_with("is it a Wavefront OBJ file?"));
    assert!(error("binary.obj", b"glTF\xFF\xFE\x00\x01").ends_with("is it a Wavefront OBJ file?"));
}

#[test]
fn models_that_are_too_large_are_told_so() {
    assert_eq!(
        error("triangles.obj", squares(32_768).as_bytes()),
        "65536 triangles; a mesh has at most 65535: split the model, or reduce it"
    );
    // Each square has corners of its own, as their coordinates differ.
    let text: String = (0..65_535).fold("v 0 0 0\n".to_owned(), |mut text, k| {
        let height = k + 1;
        write!(text, "v 1 {height} 0\nv 2 {height} {k}\nf 1 {} {}\n", 2 * k + 2, 2 * k + 3).expect("a string");
        text
    });
    assert_eq!(
        error("vertices.obj", text.as_bytes()),
        "131071 vertices (positions); a mesh has at most 65535: split the model, or reduce it"
    );
}
