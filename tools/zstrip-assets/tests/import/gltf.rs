//! glTF and GLB.

use serde_json::json;
use zstrip_assets::{AlphaMode, Center, Interpolation, Kind, Note, Options, Path, Place, Transform, UpAxis, Wrap};

use crate::support::{Document, Folder, corners, has, only_mesh, png, sorted_corners};

#[test]
fn buffers_may_be_embedded_beside_the_file_or_in_it() {
    let document = Document::triangle();
    let (expected, _) = document.import().expect("a triangle");
    let encoded = {
        use base64::Engine;
        base64::engine::general_purpose::STANDARD.encode(&document.bytes)
    };
    for uri in [format!("data:application/octet-stream;base64,{encoded}"), "my%20buffer.bin".to_owned()] {
        let mut json = document.json.clone();
        json["buffers"] = json!([{ "byteLength": document.bytes.len(), "uri": uri }]);
        let folder = Folder::new().with("a.gltf", json.to_string()).with("my buffer.bin", &document.bytes);
        let (import, _) = folder.import("a.gltf", &Options::default()).expect("a triangle");
        assert_eq!(import, expected, "{uri}");
    }
}

#[test]
fn missing_and_short_buffers_are_errors() {
    let document = Document::triangle();
    let wrong = |buffer: serde_json::Value| {
        let mut json = document.json.clone();
        json["buffers"] = json!([buffer]);
        let folder = Folder::new().with("a.gltf", json.to_string()).with("short.bin", [0; 4]);
        folder.import("a.gltf", &Options::default()).expect_err("a buffer")
    };
    let place = Place::Json("buffers[0]".to_owned());
    for (buffer, kind) in [
        (json!({ "byteLength": 36 }), Kind::Missing),
        (json!({ "byteLength": 36, "uri": "no.bin" }), Kind::Missing),
        (json!({ "byteLength": 36, "uri": "short.bin" }), Kind::Missing),
        (json!({ "byteLength": 36, "uri": "../short.bin" }), Kind::OutsideFolder),
        (json!({ "byteLength": 36, "uri": "%2e%2e/short.bin" }), Kind::OutsideFolder),
        (json!({ "byteLength": 36, "uri": "/etc/passwd" }), Kind::OutsideFolder),
        (json!({ "byteLength": 36, "uri": "file:///etc/passwd" }), Kind::OutsideFolder),
        (json!({ "byteLength": 36, "uri": "data:;base64,!" }), Kind::Syntax),
        (json!({ "byteLength": 36, "uri": "data:text/plain,a" }), Kind::Unsupported),
    ] {
        let error = wrong(buffer.clone());
        assert_eq!((&error.place, error.kind), (&place, kind), "{buffer}: {error}");
    }
}

#[test]
fn parents_come_before_their_children() {
    let mut document = Document::triangle();
    document.json["nodes"] = json!([
        { "name": "leaf", "mesh": 0, "translation": [1, 2, 3] },
        { "name": "root", "children": [2], "matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 10, 0, 0, 1] },
        { "name": "middle", "children": [0], "rotation": [0, 0, 2, 0] },
        { "name": "hidden", "mesh": 0 },
    ]);
    document.json["scenes"][0]["nodes"] = json!([1]);
    let (import, report) = document.import().expect("a triangle");
    let nodes: Vec<_> = import.nodes.iter().map(|node| (&node.name[..], node.parent)).collect();
    assert_eq!(nodes, [("root", None), ("hidden", None), ("middle", Some(0)), ("leaf", Some(2))]);
    assert_eq!((&import.nodes[3].meshes[..], &import.nodes[1].meshes[..]), (&[0][..], &[][..]));
    let Transform::Matrix(columns) = import.nodes[0].transform else { panic!("{:?}", import.nodes[0]) };
    assert_eq!(columns[3], [10.0, 0.0, 0.0, 1.0]);
    assert!(has(&report, &Note::RotationsNormalized { rotations: 1 }), "{report}");
    // Half a turn around z, twice as large, 10 to the right.
    let bounds = import.bounds().expect("a box");
    assert_eq!((bounds.min, bounds.max), ([6.0, -6.0, 6.0], [8.0, -4.0, 6.0]));
}

#[test]
fn options_put_a_node_above_all_others() {
    let mut document = Document::triangle();
    document.json["skins"] = json!([{ "joints": [0] }]);
    let times = document.floats("SCALAR", &[0.0]);
    let values = document.floats("VEC3", &[0.0; 3]);
    document.json["animations"] = json!([{
        "samplers": [{ "input": times, "output": values }],
        "channels": [{ "sampler": 0, "target": { "node": 0, "path": "translation" } }]
    }]);
    let folder = Folder::new().with("a.glb", document.glb());
    let options = Options { up: Some(UpAxis::Z), scale: 2.0, center: Center::Ground, ..Options::default() };
    let (import, report) = folder.import("a.glb", &options).expect("a triangle");
    assert_eq!((import.nodes.len(), import.nodes[1].parent, &import.nodes[1].meshes[..]), (2, Some(0), &[0][..]));
    assert_eq!((import.skins[0].joints[0], import.animations[0].channels[0].node), (1, 1));
    let bounds = report.bounds.expect("a box");
    let (min, max) = ([-1.0, 0.0, -1.0], [1.0, 0.0, 1.0]);
    let near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(near(bounds.min, min) && near(bounds.max, max), "{bounds:?}");
}

#[test]
fn cycles_and_two_parents_are_errors() {
    for nodes in [
        json!([{ "mesh": 0, "children": [0] }]),
        json!([{ "mesh": 0 }, { "children": [2] }, { "children": [1] }]),
        json!([{ "mesh": 0 }, { "children": [0] }, { "children": [0] }]),
        json!([{ "mesh": 0 }, { "children": [0, 0] }]),
    ] {
        let mut document = Document::triangle();
        document.json["nodes"] = nodes.clone();
        assert_eq!(document.import().expect_err("a hierarchy").kind, Kind::Hierarchy, "{nodes}");
    }
}

#[test]
fn strips_fans_and_indices_make_triangles() {
    for (mode, count) in [(4, 1), (5, 3), (6, 3)] {
        let mut document = Document::new();
        let positions =
            document.floats("VEC3", &[0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.5, 2.0, 0.0, 3.0, 2.5, 0.0, 2.0, 4.0, 0.0]);
        document.attribute("POSITION", positions);
        let fan = mode == 6;
        let indices = document.bytes("SCALAR", 5, if fan { &[0, 1, 3, 4, 2] } else { &[0, 1, 2, 3, 4] }, false);
        document.primitive()["indices"] = json!(indices);
        document.primitive()["mode"] = json!(mode);
        let (import, _) = document.import().expect("triangles");
        let mesh = only_mesh(&import);
        assert_eq!(mesh.triangles.len(), count, "mode {mode}");
        assert!(mesh.vertices.normals.iter().all(|normal| *normal == [0.0, 0.0, 1.0]), "mode {mode}");
    }
    let mut document = Document::triangle();
    let indices = document.bytes("SCALAR", 3, &[0, 1, 3], false);
    document.primitive()["indices"] = json!(indices);
    let error = document.import().expect_err("an index");
    assert_eq!((&error.place, error.kind), (&Place::Json("meshes[0].primitives[0].indices".to_owned()), Kind::Index));
    assert!(error.message.contains("is 3") && error.message.contains("3 vertices"), "{error}");
}

#[test]
fn accessors_may_be_sparse_strided_and_normalized() {
    let mut document = Document::triangle();
    let indices = document.view(&[2]);
    let values = document.view(&[0.0f32, 5.0, 0.0].map(f32::to_le_bytes).concat());
    document.json["accessors"][0]["sparse"] = json!({
        "count": 1, "indices": { "bufferView": indices, "componentType": 5121 }, "values": { "bufferView": values }
    });
    // Colours of three bytes, each in four.
    let colors = document.bytes("VEC3", 3, &[255, 0, 0, 9, 0, 255, 0, 9, 0, 0, 255, 9], true);
    let view = document.json["accessors"][colors]["bufferView"].as_u64().expect("a number") as usize;
    document.json["bufferViews"][view]["byteStride"] = json!(4);
    document.attribute("COLOR_0", colors);
    let (import, _) = document.import().expect("a triangle");
    assert_eq!(sorted_corners(only_mesh(&import))[0][2], [0.0, 5.0, 0.0]);
    let vertices = &only_mesh(&import).vertices;
    for (position, color) in vertices.positions.iter().zip(&vertices.colors) {
        let expected = match position {
            [0.0, 0.0, _] => [1.0, 0.0, 0.0, 1.0],
            [1.0, ..] => [0.0, 1.0, 0.0, 1.0],
            _ => [0.0, 0.0, 1.0, 1.0],
        };
        assert_eq!(*color, expected);
    }

    // Without a base, all values are 0 but those that are listed.
    let mut document = Document::triangle();
    let indices = document.view(&[1, 2]);
    let values = document.view(&[1.0f32, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat());
    let accessor = json!({
        "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1],
        "sparse": {
            "count": 2, "indices": { "bufferView": indices, "componentType": 5121 }, "values": { "bufferView": values }
        }
    });
    let positions = document.push("accessors", accessor);
    document.attribute("POSITION", positions);
    let (import, _) = document.import().expect("a triangle");
    assert_eq!(corners(only_mesh(&import)), corners(only_mesh(&Document::triangle().import().expect("one").0)));
}

#[test]
fn accessors_that_leave_their_view_are_errors() {
    for (field, value) in [
        ("count", json!(4)),
        ("count", json!(u64::MAX)),
        ("byteOffset", json!(4)),
        ("byteOffset", json!(u64::MAX)),
        ("type", json!("VEC4")),
        ("componentType", json!(5120)),
    ] {
        let mut document = Document::triangle();
        document.json["accessors"][0][field] = value.clone();
        // Bytes are a type that positions may have; there are then three small ones.
        if field != "componentType" {
            let error = document.import().expect_err(field);
            assert!(matches!(error.place, Place::Json(_)), "{field} {value}: {error}");
        }
    }
    for (field, value) in [("byteLength", 35), ("byteOffset", 1), ("buffer", 1), ("byteStride", 8)] {
        let mut document = Document::triangle();
        document.json["bufferViews"][0][field] = json!(value);
        assert!(document.import().is_err(), "{field} {value}");
    }
}

#[test]
fn numbers_that_are_not_finite_are_errors() {
    let mut document = Document::triangle();
    document.bytes[12..16].copy_from_slice(&f32::NAN.to_le_bytes());
    let error = document.import().expect_err("a position");
    assert_eq!((&error.place, error.kind), (&Place::Json("accessors[0]".to_owned()), Kind::NonFinite));
    assert!(error.message.contains("element 1"), "{error}");
}

#[test]
fn the_four_largest_weights_stay() {
    let mut document = Document::triangle();
    let joints = [0, 1, 2, 3].repeat(3);
    let more = [4, 0, 0, 0].repeat(3);
    let (a, b) = (document.bytes("VEC4", 3, &joints, false), document.bytes("VEC4", 3, &more, false));
    // The second vertex has no weights, and the third one only one, of a length that is not 1.
    let weights = [0.1, 0.2, 0.3, 0.05, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0];
    let weights = document.floats("VEC4", &weights);
    let others = document.floats("VEC4", &[0.35, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    for (name, accessor) in [("JOINTS_0", a), ("JOINTS_1", b), ("WEIGHTS_0", weights), ("WEIGHTS_1", others)] {
        document.attribute(name, accessor);
    }
    for _ in 0..4 {
        document.push("nodes", json!({}));
    }
    let bind = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 7.0, 8.0, 9.0, 1.0];
    let binds = document.floats("MAT4", &bind.repeat(5));
    document.push("skins", json!({ "joints": [4, 3, 2, 1, 0], "inverseBindMatrices": binds }));
    document.json["nodes"][0]["skin"] = json!(0);
    let (import, report) = document.import().expect("a triangle");
    assert_eq!(import.skins[0].joints, [4, 3, 2, 1, 0]);
    assert_eq!(import.skins[0].inverse_binds[4][3], [7.0, 8.0, 9.0, 1.0]);
    let vertices = &only_mesh(&import).vertices;
    let at = |p: [f32; 3]| vertices.positions.iter().position(|q| *q == p).expect("a vertex");
    let first = at([0.0; 3]);
    assert_eq!(vertices.joints[first], [4, 2, 1, 0]);
    let expected = [0.35, 0.3, 0.2, 0.1].map(|weight: f32| weight / 0.95);
    assert!(vertices.weights[first].iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6));
    for (p, joint) in [([1.0, 0.0, 0.0], 0), ([0.0, 1.0, 0.0], 1)] {
        assert_eq!((vertices.joints[at(p)][0], vertices.weights[at(p)]), (joint, [1.0, 0.0, 0.0, 0.0]));
    }
    assert!(has(&report, &Note::WeightsMissing { vertices: 1 }), "{report}");
    let dropped = report.notes.iter().find_map(|note| match note {
        Note::WeightsDropped { vertices, most } => Some((*vertices, *most)),
        _ => None,
    });
    assert!(dropped.is_some_and(|(vertices, most)| vertices == 1 && (most - 0.05).abs() < 1e-6), "{report}");
    // All joints are where they were bound, but for 7, 8, 9.
    assert_eq!(report.bounds.expect("a box").min, [7.0, 8.0, 9.0]);

    document.json["skins"][0]["joints"] = json!([4, 3]);
    assert_eq!(document.import().expect_err("a joint").kind, Kind::Index);
    document.primitive()["attributes"]["WEIGHTS_1"] = json!(null);
    document.primitive()["attributes"].as_object_mut().expect("attributes").remove("WEIGHTS_1");
    assert_eq!(document.import().expect_err("weights").kind, Kind::Missing);
}

#[test]
fn morph_targets_and_their_weights_are_read() {
    let mut document = Document::triangle();
    let positions = document.floats("VEC3", &[0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let normals = document.floats("VEC3", &[0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    document.primitive()["targets"] = json!([{ "POSITION": positions, "NORMAL": normals }, { "NORMAL": normals }]);
    document.json["meshes"][0]["weights"] = json!([0.5, 0.0]);
    let times = document.floats("SCALAR", &[0.0, 1.0]);
    let values = document.floats("SCALAR", &[0.0, 1.0, 1.0, 0.0]);
    document.json["animations"] = json!([{
        "samplers": [{ "input": times, "output": values, "interpolation": "STEP" }],
        "channels": [{ "sampler": 0, "target": { "node": 0, "path": "weights" } }]
    }]);
    let (import, report) = document.import().expect("a triangle");
    let vertices = &only_mesh(&import).vertices;
    assert_eq!(import.nodes[0].weights, [0.5, 0.0]);
    let at = vertices.positions.iter().position(|p| *p == [0.0; 3]).expect("a vertex");
    assert_eq!((vertices.morphs[0].positions[at], vertices.morphs[0].normals[at]), ([0.0, 0.0, 4.0], [0.0, 1.0, 0.0]));
    assert_eq!(vertices.morphs[1].positions[at], [0.0; 3]);
    assert_eq!(report.bounds.expect("a box").max, [1.0, 1.0, 2.0]);
    let channel = &import.animations[0].channels[0];
    assert_eq!((channel.path, channel.interpolation, channel.width()), (Path::Weights, Interpolation::Step, 2));
}

#[test]
fn a_channel_of_a_node_that_is_not_there_is_an_error() {
    let mut document = Document::triangle();
    let times = document.floats("SCALAR", &[0.0]);
    let values = document.floats("VEC3", &[0.0; 3]);
    document.json["animations"] = json!([{
        "samplers": [{ "input": times, "output": values }],
        "channels": [{ "sampler": 0, "target": { "node": 1, "path": "translation" } }]
    }]);
    let error = document.import().expect_err("a node");
    assert_eq!((&error.kind, &error.message[..]), (&Kind::Index, "node 1, where there are 1"));
}

#[test]
fn animations_are_read_and_checked() {
    let clip = |times: &[f32], values: &[f32], way: &str, path: &str| {
        let mut document = Document::triangle();
        let input = document.floats("SCALAR", times);
        let kind = if path == "rotation" { "VEC4" } else { "VEC3" };
        let output = document.floats(kind, values);
        document.json["animations"] = json!([{
            "name": "walk", "samplers": [{ "input": input, "output": output, "interpolation": way }],
            "channels": [{ "sampler": 0, "target": { "node": 0, "path": path } }]
        }]);
        document.import()
    };
    let (import, _) = clip(&[0.0, 2.5], &[0.0, 0.0, 0.0, 1.0, 2.0, 3.0], "LINEAR", "scale").expect("a clip");
    let animation = &import.animations[0];
    let channel = &animation.channels[0];
    assert_eq!((&animation.name[..], animation.duration(), channel.path), ("walk", 2.5, Path::Scale));
    assert_eq!((channel.width(), &channel.values[3..]), (3, &[1.0, 2.0, 3.0][..]));

    // Tangents keep their length; the value between them is a rotation.
    let keys = [5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 7.0, 0.0, 0.0];
    let (import, report) = clip(&[1.0], &keys, "CUBICSPLINE", "rotation").expect("a clip");
    let channel = &import.animations[0].channels[0];
    assert_eq!((channel.interpolation, channel.width()), (Interpolation::Cubic, 4));
    assert_eq!(channel.values, [5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 7.0, 0.0, 0.0]);
    assert!(has(&report, &Note::RotationsNormalized { rotations: 1 }), "{report}");

    for (times, values, way, kind) in [
        (&[0.0, 0.0][..], &[0.0; 6][..], "LINEAR", Kind::Syntax),
        (&[1.0, 0.0], &[0.0; 6], "LINEAR", Kind::Syntax),
        (&[0.0, 1.0], &[0.0; 3], "LINEAR", Kind::Missing),
        (&[0.0, 1.0], &[0.0; 6], "CUBICSPLINE", Kind::Missing),
        (&[0.0, f32::NAN], &[0.0; 6], "STEP", Kind::NonFinite),
        (&[0.0, 1.0], &[f32::INFINITY; 6], "STEP", Kind::NonFinite),
    ] {
        let error = clip(times, values, way, "translation").expect_err(way);
        assert_eq!(error.kind, kind, "{times:?} {way}: {error}");
    }
}

#[test]
fn materials_are_read() {
    let mut document = Document::triangle();
    let image = document.view(&png(2, 3));
    // The type of the image is its bytes' own, whatever the document says or does not say.
    document.push("images", json!({ "bufferView": image }));
    document.push("samplers", json!({ "wrapS": 33071, "wrapT": 33648, "magFilter": 9728 }));
    document.push("textures", json!({ "source": 0, "sampler": 0 }));
    let half_pi = std::f32::consts::FRAC_PI_2;
    let transform = json!({ "offset": [0.5, 0.25], "rotation": half_pi, "scale": [2, 3], "texCoord": 1 });
    document.push(
        "materials",
        json!({
            "name": "paint", "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.25,
            "pbrMetallicRoughness": {
                "baseColorFactor": [1, 0.21404114, 0, 0.5],
                "baseColorTexture": { "index": 0, "extensions": { "KHR_texture_transform": transform } }
            },
            "extensions": { "KHR_materials_unlit": {} }
        }),
    );
    document.json["extensionsRequired"] = json!(["KHR_texture_transform", "KHR_mesh_quantization"]);
    document.json["extensionsUsed"] =
        json!(["KHR_texture_transform", "KHR_mesh_quantization", "KHR_materials_unlit", "KHR_materials_sheen"]);
    let uvs = document.floats("VEC2", &[1.0, 0.0, 1.0, 0.0, 1.0, 0.0]);
    document.attribute("TEXCOORD_1", uvs);
    document.primitive()["material"] = json!(0);
    let (import, report) = document.import().expect("a triangle");
    let material = &import.materials[0];
    assert_eq!((&material.name[..], material.double_sided, material.unlit), ("paint", true, true));
    assert_eq!(material.alpha, AlphaMode::Mask { cutoff: 0.25 });
    // The factor is linear light, and the result sRGB: 0.214 is half of the way to white.
    assert!((material.color[1] - 0.5).abs() < 1e-5, "{:?}", material.color);
    assert_eq!([material.color[0], material.color[2], material.color[3]], [1.0, 0.0, 0.5]);
    let texture = material.texture.expect("a texture");
    assert_eq!((texture.wrap, texture.nearest), ([Wrap::Clamp, Wrap::Mirror], true));
    assert_eq!((import.images[texture.image].width, import.images[texture.image].height), (2, 3));
    // (1, 0) is scaled to (2, 0), and turned counter-clockwise with v down: to (0, -2).
    let [u, v] = only_mesh(&import).vertices.uvs[0];
    assert!((u - 0.5).abs() < 1e-6 && (v + 1.75).abs() < 1e-6, "{u}, {v}");
    assert!(has(&report, &Note::ExtensionIgnored { name: "KHR_materials_sheen".to_owned() }), "{report}");
}

#[test]
fn required_extensions_must_be_known() {
    let mut document = Document::triangle();
    document.json["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    document.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    let error = document.import().expect_err("an extension");
    assert_eq!(error.kind, Kind::Unsupported);
    assert!(error.message.contains("KHR_draco_mesh_compression") && error.message.contains("without compression"));
}

#[test]
fn positions_must_exist() {
    let mut document = Document::triangle();
    document.attribute("POSITION", 1);
    let error = document.import().expect_err("an accessor");
    assert_eq!(error.kind, Kind::Index);
    assert!(error.to_string().contains("meshes[0].primitives[0].attributes[\"POSITION\"]"), "{error}");
}

#[test]
fn validation_names_the_place() {
    let mut document = Document::triangle();
    document.json["nodes"][0]["mesh"] = json!(7);
    let error = document.import().expect_err("a mesh");
    assert_eq!((error.place, error.kind), (Place::Json("nodes[0].mesh".to_owned()), Kind::Syntax));
    let mut bytes = Document::triangle().glb();
    bytes[8] = 4;
    bytes[9] = 0;
    let error = crate::support::read("a.glb", &bytes).expect_err("a length");
    assert_eq!(error.place, Place::Byte(8));
}

#[test]
fn nodes_that_mirror_are_reported() {
    let mut document = Document::triangle();
    document.json["nodes"][0]["scale"] = json!([-1, 1, 1]);
    let (_, report) = document.import().expect("a triangle");
    assert!(has(&report, &Note::Mirrored { nodes: 1 }), "{report}");
}
