//! Imports files and prints what was found: `cargo run --example report -- FILE...`.

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use zstrip_assets::{Options, import};

fn main() -> ExitCode {
    let mut code = ExitCode::SUCCESS;
    for file in std::env::args().skip(1) {
        let begin = Instant::now();
        match import(Path::new(&file), &Options::default()) {
            Ok((model, report)) => {
                println!("{file}, in {} ms", begin.elapsed().as_millis());
                print!("{report}");
                for mesh in &model.meshes {
                    let cones = mesh.clusters.iter().filter(|cluster| cluster.cone.is_some()).count();
                    println!(
                        "mesh {:?}: {} vertices, {} triangles in {} clusters, of which {cones} have a cone",
                        mesh.name,
                        mesh.vertices.len(),
                        mesh.triangles.len(),
                        mesh.clusters.len()
                    );
                }
                for material in &model.materials {
                    let texture = material.texture.map(|texture| &model.images[texture.image]);
                    println!("material {:?}: {:?}, {texture:?}", material.name, material.color);
                }
                for animation in &model.animations {
                    let keys: usize = animation.channels.iter().map(|channel| channel.times.len()).sum();
                    let (name, duration) = (&animation.name, animation.duration());
                    println!("clip {name:?}: {duration} s, {} channels, {keys} keys", animation.channels.len());
                }
                println!();
            }
            Err(error) => {
                println!("{error}\n");
                code = ExitCode::FAILURE;
            }
        }
    }
    code
}
