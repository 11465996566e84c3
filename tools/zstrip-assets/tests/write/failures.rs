//! Models that cannot be written: errors that say what was found and what is needed, and never a panic.

use serde_json::json;
use zstrip_assets::{Options, Skin, WriteError, WriteNote, WriteOptions, write};

use crate::figures::{animated, image, of_mesh, sphere, textured};
use crate::support::{Document, Random, read_with};

fn error(import: &zstrip_assets::Import) -> String {
    write(import, &WriteOptions::default()).expect_err("an error").to_string()
}

#[test]
fn numbers_out_of_range_are_errors() {
    let found = error(&of_mesh(sphere(8, 8, 100_000.0)));
    assert!(found.contains("32767 is the most; scale the model by"), "{found}");
    let mut import = of_mesh(sphere(8, 8, 1.0));
    import.meshes[0].vertices.positions[3][1] = f32::NAN;
    assert_eq!(error(&import), "a number of meshes[0] is not a finite number; export the model anew");
    let mut import = of_mesh(sphere(8, 8, 1.0));
    import.meshes[0].triangles[5][0] = 99;
    assert_eq!(error(&import), "meshes[0], vertex of a triangle is 99, and there are 81");
    let mut import = of_mesh(sphere(8, 8, 1.0));
    import.nodes[0].parent = Some(0);
    assert_eq!(error(&import), "nodes[0], parent is 0, and there are 0");
    let mut import = textured(sphere(8, 8, 1.0), image(), zstrip_assets::AlphaMode::Blend);
    import.meshes[0].vertices.uvs[0][0] = 1e9;
    assert!(error(&import).starts_with("the range of texture coordinates of meshes[0] is"), "{}", error(&import));
    import.images[0].texels.pop();
    assert_eq!(error(&import), "images[0], bytes has 255 items, and needs 256");
    let options = WriteOptions { max_texture: 0, ..WriteOptions::default() };
    assert!(matches!(write(&of_mesh(sphere(8, 8, 1.0)), &options), Err(WriteError::Options(_))));
}

#[test]
fn images_without_texels_and_of_more_bytes_than_fit_are_errors() {
    let sized = |width, height, bytes: usize| {
        let mut import = textured(sphere(8, 8, 1.0), image(), zstrip_assets::AlphaMode::Opaque);
        import.images[0] = zstrip_assets::Image { name: String::new(), width, height, texels: vec![0; bytes] };
        error(&import)
    };
    assert_eq!(sized(0, 5, 0), "images[0] has 0×5 texels, and needs one column and one row at least");
    assert_eq!(sized(5, 0, 20), "images[0] has 5×0 texels, and needs one column and one row at least");
    // 2^64 bytes and more.
    assert_eq!(sized(1 << 31, 1 << 31, 4), format!("images[0], bytes has 4 items, and needs {}", usize::MAX));
    assert_eq!(sized(u32::MAX, u32::MAX, 0), format!("images[0], bytes has 0 items, and needs {}", usize::MAX));
}

#[test]
fn vertices_without_weights_follow_the_first_joint() {
    let mut import = animated(false);
    let vertices = &mut import.meshes[0].vertices;
    vertices.joints.iter_mut().for_each(|joints| *joints = [2, 2, 2, 2]);
    vertices.weights.fill([0.0; 4]);
    let report = write(&import, &WriteOptions::default()).expect("a container").report;
    assert!(report.notes.contains(&WriteNote::UnusedJoints { joints: 2 }), "{report}");
    // Beside vertices that follow the second joint.
    let vertices = &mut import.meshes[0].vertices;
    vertices.weights[..20].fill([0.0, 1.0, 0.0, 0.0]);
    vertices.weights[20] = [-1.0, 0.0, 0.0, 0.0];
    let report = write(&import, &WriteOptions::default()).expect("a container").report;
    assert!(report.notes.contains(&WriteNote::UnusedJoints { joints: 1 }), "{report}");
}

#[test]
fn as_many_joints_as_numbers_have_are_counted() {
    let mut import = animated(false);
    let Skin { joints, inverse_binds, .. } = &mut import.skins[0];
    joints.resize(65_536, joints[0]);
    inverse_binds.resize(65_536, inverse_binds[0]);
    let mesh = &mut import.meshes[0];
    *mesh = sphere(256, 255, 1.0);
    let count = mesh.vertices.len();
    mesh.vertices.joints = (0..count).map(|k| [k as u16, 0, 0, 0]).collect();
    mesh.vertices.weights = vec![[1.0, 0.0, 0.0, 0.0]; count];
    assert_eq!(error(&import), "65536 joints of a skin, and 256 are the most; divide or simplify the model");
}

#[test]
fn joints_that_move_nothing_do_not_count() {
    let mut import = animated(false);
    let [joint, bind] = [import.skins[0].joints[0], 0];
    let Skin { joints, inverse_binds, .. } = &mut import.skins[0];
    joints.resize(400, joint);
    let bind = inverse_binds[bind];
    inverse_binds.resize(400, bind);
    let report = write(&import, &WriteOptions::default()).expect("a container").report;
    assert!(report.notes.contains(&WriteNote::UnusedJoints { joints: 397 }), "{report}");
    let count = import.meshes[0].vertices.len();
    import.meshes[0].vertices = sphere(20, 20, 1.0).vertices;
    import.meshes[0].triangles = sphere(20, 20, 1.0).triangles;
    assert!(count < 300);
    let vertices = &mut import.meshes[0].vertices;
    vertices.joints = (0..441).map(|k| [k as u16 % 300, 0, 0, 0]).collect();
    vertices.weights = vec![[1.0, 0.0, 0.0, 0.0]; 441];
    assert_eq!(error(&import), "300 joints of a skin, and 256 are the most; divide or simplify the model");
}

#[test]
fn small_models_are_told_to_grow() {
    let report = write(&of_mesh(sphere(8, 8, 0.001)), &WriteOptions::default()).expect("a container").report;
    assert!(report.notes.iter().any(|note| matches!(note, WriteNote::Small { factor: 1000.0, .. })), "{report}");
    // The factor is one beside the scale that the model has already.
    let text = report.to_string();
    assert!(text.contains("only 0.0020 units large; a scale 1000 times as large"), "{text}");
    let report = write(&of_mesh(sphere(8, 8, 1e-30)), &WriteOptions::default()).expect("a container").report;
    let text = report.to_string();
    assert!(text.contains("only 2.0e-30 units large; a scale 1e30 times as large"), "{text}");
}

/// Whatever a changed file imports as is written, or refused with an error that is not a mistake of the writer.
#[test]
fn changed_files_are_written_or_refused() {
    let mut document = Document::triangle();
    let normals = document.floats("VEC3", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    document.attribute("NORMAL", normals);
    let joints = document.bytes("VEC4", 3, &[0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0], false);
    document.attribute("JOINTS_0", joints);
    let weights = document.floats("VEC4", &[0.5, 0.5, 0.0, 0.0, 0.9, 0.1, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    document.attribute("WEIGHTS_0", weights);
    let morph = document.floats("VEC3", &[0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    document.primitive()["targets"] = json!([{ "POSITION": morph }]);
    document.json["nodes"] = json!([{ "mesh": 0, "skin": 0, "children": [1] }, { "children": [2] }, {}]);
    document.json["skins"] = json!([{ "joints": [1, 2] }]);
    let times = document.floats("SCALAR", &[0.0, 0.5, 1.0]);
    let turns = document.floats("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.6, 0.0, 0.0, 0.8]);
    let moved = document.floats("SCALAR", &[0.0, 1.0, 0.5]);
    document.json["animations"] = json!([{
        "samplers": [{ "input": times, "output": turns }, { "input": times, "output": moved }],
        "channels": [
            { "sampler": 0, "target": { "node": 1, "path": "rotation" } },
            { "sampler": 1, "target": { "node": 0, "path": "weights" } }
        ]
    }]);
    let file = document.glb();
    let seed = std::env::var("SEED").ok().and_then(|seed| seed.parse().ok()).unwrap_or(5);
    println!("seed {seed}");
    let mut random = Random(seed);
    let (mut written, mut refused) = (0, 0);
    let rounds = std::env::var("ROUNDS").ok().and_then(|n| n.parse().ok()).unwrap_or(1500);
    let first_number = file.len() - document.bytes.len();
    for round in 0..rounds {
        let mut changed = file.clone();
        for _ in 0..=random.below(3) {
            let at = if random.below(4) > 0 {
                first_number + random.below(document.bytes.len())
            } else {
                random.below(file.len())
            };
            changed[at] = random.bits() as u8;
        }
        let Ok((import, _)) = read_with("a.glb", &changed, &Options::default()) else { continue };
        match write(&import, &WriteOptions::default()) {
            Ok(_) => written += 1,
            Err(WriteError::ReadBack(error)) => panic!("seed {seed}, round {round}: {error}"),
            Err(_) => refused += 1,
        }
    }
    println!("{written} written, {refused} refused");
    assert!(written > 100 && refused > 10, "{written} written, {refused} refused");
}
