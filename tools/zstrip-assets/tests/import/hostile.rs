//! Files that lie: each must give an import or an error, never a panic, and never take more than the limits allow.

use std::panic::{AssertUnwindSafe, catch_unwind};

use serde_json::json;
use zstrip_assets::{Kind, Limits, Note, Options, import};

use crate::support::{Document, Folder, Random, png};

/// A glTF document with a bit of everything.
fn rich_document() -> Document {
    let mut document = Document::triangle();
    let image = document.view(&png(2, 2));
    document.push("images", json!({ "bufferView": image, "mimeType": "image/png" }));
    document.push("samplers", json!({ "wrapS": 33071 }));
    document.push("textures", json!({ "source": 0, "sampler": 0 }));
    document.push("materials", json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }));
    let uvs = document.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    let joints = document.bytes("VEC4", 3, &[0, 1, 0, 0].repeat(3), false);
    let weights = document.floats("VEC4", &[0.5, 0.5, 0.0, 0.0].repeat(3));
    let indices = document.bytes("SCALAR", 3, &[0, 1, 2], false);
    for (name, accessor) in [("TEXCOORD_0", uvs), ("JOINTS_0", joints), ("WEIGHTS_0", weights)] {
        document.attribute(name, accessor);
    }
    let morph = document.floats("VEC3", &[0.25; 9]);
    let (at, values) = (document.view(&[1]), document.view(&[0; 12]));
    document.json["accessors"][morph]["sparse"] = json!({
        "count": 1, "indices": { "bufferView": at, "componentType": 5121 }, "values": { "bufferView": values }
    });
    let primitive = document.primitive();
    primitive["indices"] = json!(indices);
    primitive["material"] = json!(0);
    primitive["targets"] = json!([{ "POSITION": morph }]);
    document.push("nodes", json!({ "children": [2] }));
    document.push("nodes", json!({ "translation": [0, 1, 0] }));
    let binds: Vec<f32> = (0..32).map(|k| if k % 5 == 0 { 1.0 } else { 0.0 }).collect();
    let binds = document.floats("MAT4", &binds);
    document.push("skins", json!({ "joints": [1, 2], "inverseBindMatrices": binds }));
    document.json["nodes"][0]["skin"] = json!(0);
    let times = document.floats("SCALAR", &[0.0, 1.0]);
    let keys = document.floats("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0]);
    document.push(
        "animations",
        json!({
            "samplers": [{ "input": times, "output": keys }],
            "channels": [{ "sampler": 0, "target": { "node": 2, "path": "rotation" } }]
        }),
    );
    document
}

/// One small file of each kind.
fn samples() -> Vec<(&'static str, Vec<u8>)> {
    let obj = "mtllib a.mtl\nv 0 0 0 1 0 0\nv 2 0 0\nv 2 2 0\nv 1 1 0\nv 0 2 0\nvt 0 0\nvt 1 1\nvn 0 0 1\nusemtl a\n\
               s 1\nf 1/1/1 2/2/1 3/1/1 -2/1/1 -1/2/1\nf 1 2 3\n";
    let stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
               endsolid a\n";
    let document = rich_document();
    let mut json = document.json.clone();
    json["buffers"] = json!([{ "byteLength": document.bytes.len(), "uri": "a.bin" }]);
    vec![
        ("a.obj", obj.into()),
        ("a.mtl", "newmtl a\nKd 1 0 0.5\nd 0.5\nillum 1\nmap_Kd -clamp on a.png\n".into()),
        ("text.stl", stl.into()),
        ("binary.stl", crate::stl::binary(b"a", [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0], 1)),
        ("text.ply", crate::ply::square("ascii")),
        ("little.ply", crate::ply::square("binary_little_endian")),
        ("big.ply", crate::ply::square("binary_big_endian")),
        ("a.glb", document.glb()),
        ("a.gltf", json.to_string().into()),
        ("a.bin", document.bytes),
        ("a.png", png(2, 2)),
    ]
}

/// The model to import when a file of the folder is changed.
fn model_of(name: &str) -> &str {
    match name {
        "a.mtl" | "a.png" => "a.obj",
        "a.bin" => "a.gltf",
        _ => name,
    }
}

fn folder() -> Folder {
    samples().into_iter().fold(Folder::new(), |folder, (name, bytes)| folder.with(name, bytes))
}

/// Limits under which a file of a few KB cannot take more than a few MB.
fn options() -> Options {
    let limits = Limits { numbers: 1 << 16, texels: 1 << 16, ..Limits::default() };
    Options { limits, weld_distance: 0.01, max_triangles: Some(1), ..Options::default() }
}

/// Imports with a changed file; returns whether it was accepted.
fn survives(folder: &Folder, name: &str, bytes: &[u8], case: &str) -> bool {
    std::fs::write(folder.path(name), bytes).expect("a file");
    let model = folder.path(model_of(name));
    let result = catch_unwind(AssertUnwindSafe(|| import(&model, &options())));
    match result {
        Ok(Ok((import, report))) => {
            assert!(import.meshes.iter().all(|mesh| {
                let count = mesh.vertices.len() as u32;
                mesh.vertices.positions.iter().flatten().all(|x| x.is_finite())
                    && mesh.triangles.iter().flatten().all(|v| *v < count)
            }));
            assert!(!report.to_string().is_empty());
            true
        }
        Ok(Err(error)) => {
            assert!(!error.to_string().is_empty());
            false
        }
        Err(_) => panic!("{name}, {case}: a panic"),
    }
}

#[test]
fn the_samples_are_good() {
    let folder = folder();
    for (name, bytes) in samples() {
        assert!(survives(&folder, name, &bytes, "unchanged"), "{name}");
    }
    let (import, report) = import(&folder.path("a.gltf"), &Options::default()).expect("a model");
    assert_eq!((import.images.len(), import.skins.len(), import.animations.len()), (1, 1, 1), "{report}");
}

#[test]
fn truncated_files_never_panic() {
    for (name, bytes) in samples() {
        let folder = folder();
        let accepted = (0..bytes.len()).filter(|end| survives(&folder, name, &bytes[..*end], &format!("{end} bytes")));
        let accepted = accepted.count();
        // A model that lost its end is no model, but text may end anywhere, and materials are not needed.
        if ["binary.stl", "little.ply", "big.ply", "a.glb", "a.bin"].contains(&name) {
            assert_eq!(accepted, 0, "{name}");
        }
    }
}

#[test]
fn flipped_bytes_never_panic() {
    let number = |name| std::env::var(name).ok().and_then(|number| number.parse().ok());
    let (seed, rounds) = (number("SEED").unwrap_or(1), number("ROUNDS").unwrap_or(300));
    println!("SEED={seed} ROUNDS={rounds}");
    for (name, bytes) in samples() {
        let folder = folder();
        let mut random = Random(seed);
        for round in 0..rounds {
            let mut changed = bytes.clone();
            for _ in 0..1 + random.below(3) {
                let at = random.below(changed.len());
                changed[at] = match random.below(4) {
                    0 => random.bits() as u8,
                    1 => changed[at] ^ 1 << random.below(8),
                    2 => b"0123456789-.e \n[]{},\"/"[random.below(22)],
                    _ => [0, 1, 0x7F, 0x80, 0xFF][random.below(5)],
                };
            }
            survives(&folder, name, &changed, &format!("seed {seed}, round {round}"));
        }
    }
}

/// Random words of a format reach further than random bytes.
#[test]
fn random_obj_lines_never_panic() {
    let words =
        ["v", "vn", "vt", "f", "s", "usemtl", "g", "0", "1", "-1", "2/2/2", "3", "-3//1", "1e38", "-1e38", "1e-45"];
    let mut random = Random(3);
    let folder = folder();
    for round in 0..500 {
        let mut text = String::from("v 0 0 0\nv 1 0 0\nv 1 1 1e-30\nvt 0 0\nvt 1 1\nvn 0 0 1\nvn 0 0 0\n");
        for _ in 0..20 {
            text += words[random.below(7)];
            for _ in 0..random.below(6) {
                text += " ";
                text += words[7 + random.below(9)];
            }
            text += "\n";
        }
        survives(&folder, "a.obj", text.as_bytes(), &format!("round {round}: {text}"));
    }
}

#[test]
fn limits_hold() {
    let limited = |name: &str, limits: Limits| import(&folder().path(name), &Options { limits, ..Options::default() });
    let of = Limits::default;
    for (name, limits) in [
        ("a.obj", Limits { file_bytes: 10, ..of() }),
        ("a.obj", Limits { numbers: 10, ..of() }),
        ("text.stl", Limits { numbers: 10, ..of() }),
        ("binary.stl", Limits { numbers: 10, ..of() }),
        ("text.ply", Limits { numbers: 10, ..of() }),
        ("little.ply", Limits { numbers: 10, ..of() }),
        ("a.glb", Limits { numbers: 10, ..of() }),
        ("a.glb", Limits { json_values: 10, ..of() }),
    ] {
        let error = limited(name, limits.clone()).expect_err(name);
        assert_eq!(error.kind, Kind::Limit, "{name}, {limits:?}: {error}");
    }
    for limits in [Limits { image_side: 1, ..of() }, Limits { texels: 3, ..of() }] {
        let (import, report) = limited("a.glb", limits).expect("a model without its texture");
        assert_eq!(import.materials[0].texture, None);
        let is_missing = |note: &Note| matches!(note, Note::TextureMissing { reason } if reason.contains("limit"));
        assert!(report.notes.iter().any(is_missing), "{report}");
    }
}

#[test]
fn an_accessor_that_many_primitives_share_counts_each_time() {
    let mut document = Document::triangle();
    let primitive = document.primitive().clone();
    document.json["meshes"][0]["primitives"] = json!(vec![primitive; 2000]);
    let folder = Folder::new().with("a.glb", document.glb());
    let limits = Limits { numbers: 9_000, ..Limits::default() };
    let error = folder.import("a.glb", &Options { limits, ..Options::default() }).expect_err("too many");
    assert_eq!(error.kind, Kind::Limit);
}

/// Bytes of notes, which many missing things must not make of a long list each.
fn note_bytes(report: &zstrip_assets::Report) -> usize {
    report.notes.iter().map(|note| note.to_string().len()).sum()
}

#[test]
fn many_missing_materials_take_no_more_memory_than_their_names() {
    let mut text = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    for k in 0..500 {
        text += &format!("mtllib {k}{}\nusemtl {k}\nf 1 2 3\n", "x".repeat(100));
    }
    let folder = Folder::new().with("a.obj", &text);
    let (_, report) = folder.import("a.obj", &Options::default()).expect("triangles");
    let mut of_material = report.notes.iter().filter_map(|note| match note {
        Note::MaterialMissing { reason } if reason.starts_with("\"7\" is in none of the files") => Some(reason),
        _ => None,
    });
    let reason = of_material.next_back().expect("a note");
    assert!(reason.ends_with("and 496 more"), "{reason}");
    assert!(note_bytes(&report) < 10 * text.len(), "{} of {}", note_bytes(&report), text.len());
}

#[test]
fn one_long_name_in_many_places_is_cut() {
    let mut document = Document::triangle();
    document.push("images", json!({ "uri": format!("{}.png", "x".repeat(200)), "name": "x".repeat(50_000) }));
    document.push("textures", json!({ "source": 0 }));
    let material = json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } });
    document.json["materials"] = json!(vec![material; 100]);
    let folder = Folder::new().with("a.glb", document.glb()).with(&format!("{}.png", "x".repeat(200)), "no image");
    let (_, report) = folder.import("a.glb", &Options::default()).expect("a triangle");
    let count = report.notes.iter().filter(|note| matches!(note, Note::TextureMissing { .. })).count();
    assert_eq!(count, 100);
    assert!(note_bytes(&report) < 100_000, "{}", note_bytes(&report));
}

#[test]
fn ignored_lines_of_long_words_are_counted() {
    let word = "x".repeat(60);
    let text = format!("{word}1\n{word}2\n{word}3\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let (_, report) = Folder::new().with("a.obj", text).import("a.obj", &Options::default()).expect("a triangle");
    let is_three = |note: &Note| matches!(note, Note::Ignored { count: 3, .. });
    assert!(report.notes.iter().any(is_three), "{report}");
}

/// What a few bytes of JSON multiply counts against the limit of numbers.
#[test]
fn nodes_names_and_empty_morph_targets_count_each_time() {
    let limits = Limits { numbers: 40_000, ..Limits::default() };
    let refused = |document: &Document, at: &str| {
        let options = Options { limits: limits.clone(), ..Options::default() };
        let folder = Folder::new().with("a.glb", document.glb());
        let error = folder.import("a.glb", &options).expect_err("too many");
        assert_eq!(error.kind, Kind::Limit);
        assert!(error.to_string().contains(at), "{error}");
        folder.import("a.glb", &Options::default()).expect("within the usual limits");
    };
    // 400 nodes that show a mesh of 200 primitives.
    let mut document = Document::triangle();
    let primitive = document.primitive().clone();
    document.json["meshes"][0]["primitives"] = json!(vec![primitive.clone(); 200]);
    document.json["nodes"] = json!(vec![json!({ "mesh": 0 }); 400]);
    document.json["scenes"][0]["nodes"] = json!((0..400).collect::<Vec<_>>());
    refused(&document, "nodes[");
    // A long name, which each of 200 meshes gets.
    let mut document = Document::triangle();
    document.json["meshes"][0]["primitives"] = json!(vec![primitive; 200]);
    document.json["meshes"][0]["name"] = json!("x".repeat(1000));
    refused(&document, "meshes[0].name");
    let mut document = Document::triangle();
    document.primitive()["targets"] = json!(vec![json!({}); 3000]);
    refused(&document, "meshes[0].primitives[0].targets");
}

#[cfg(unix)]
#[test]
fn links_out_of_the_folder_are_not_followed() {
    let outside = Folder::new().with("secret.mtl", "newmtl a\n");
    let folder = Folder::new().with("a.obj", "mtllib link.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    std::os::unix::fs::symlink(outside.path("secret.mtl"), folder.path("link.mtl")).expect("a link");
    let (_, report) = folder.import("a.obj", &Options::default()).expect("a triangle");
    let refused = |note: &Note| matches!(note, Note::MaterialMissing { reason } if reason.contains("leads out"));
    assert!(report.notes.iter().any(refused), "{report}");
}

#[test]
fn folders_and_missing_files_are_errors() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("a.obj")).expect("a folder");
    for name in ["a.obj", "b.obj"] {
        assert_eq!(folder.import(name, &Options::default()).expect_err(name).kind, Kind::Io);
    }
}

#[test]
fn options_out_of_range_are_errors() {
    for options in [
        Options { scale: 0.0, ..Options::default() },
        Options { scale: f64::NAN, ..Options::default() },
        Options { crease_angle: 200.0, ..Options::default() },
        Options { weld_distance: -1.0, ..Options::default() },
        Options { max_vertices: 70_000, ..Options::default() },
        Options { cluster_vertices: 256, ..Options::default() },
        Options { cluster_triangles: 125, ..Options::default() },
        Options { max_triangles: Some(0), ..Options::default() },
    ] {
        assert_eq!(folder().import("a.obj", &options).expect_err("an option").kind, Kind::Options);
    }
    // Whatever else is in range gives a model.
    let limits = Limits {
        file_bytes: u64::MAX,
        numbers: u64::MAX,
        json_values: u64::MAX,
        image_side: u32::MAX,
        texels: u64::MAX,
    };
    let options = Options { max_triangles: Some(usize::MAX), limits, ..Options::default() };
    for name in ["a.obj", "a.glb"] {
        let (import, report) = folder().import(name, &options).expect(name);
        assert_eq!(import.images.len(), 1, "{report}");
    }
    let options = Options { scale: 1e300, ..Options::default() };
    for name in ["a.obj", "a.glb"] {
        assert_eq!(folder().import(name, &options).expect_err(name).kind, Kind::NonFinite);
    }
}
