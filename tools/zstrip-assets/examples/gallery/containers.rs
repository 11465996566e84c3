//! The containers of the gallery: their sources, and the options that they are converted with.

use super::{figure, flange};
use std::error::Error;
use std::path::{Path, PathBuf};
use zstrip_assets::{Material, Normals, Options, TextureKind, WriteOptions, Written, import, write};

/// The names of the containers.
pub const NAMES: [&str; 5] = ["spot", "teapot", "figure", "flange", "flange_faces"];

/// The path of a container that is checked in.
pub fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/models").join(name).with_extension("zstm")
}

/// Converts the source of a container. Sources that the project makes are written into a folder before.
pub fn convert(name: &str, made: &Path) -> Result<Written, Box<dyn Error>> {
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/gallery");
    let options = Options::default();
    let write_options = WriteOptions { textures: TextureKind::Palette, max_texture: 128, ..WriteOptions::default() };
    let (path, options, color) = match name {
        "spot" => {
            let options = Options { texture: Some(kept.join("spot_texture.png")), ..options };
            (kept.join("spot.obj"), options, None)
        }
        "teapot" => (kept.join("teapot.obj"), options, Some([0.62, 0.74, 0.80, 1.0])),
        "figure" => {
            let path = made.join("figure.glb");
            std::fs::write(&path, figure::glb())?;
            (path, options, None)
        }
        _ => {
            let path = made.join("flange.stl");
            std::fs::write(&path, flange::stl())?;
            // Millimetres become tenths of a metre. Steps of round faces are below 25 degrees, chamfers have 45.
            let normals = if name == "flange" { Normals::Smooth } else { Normals::Flat };
            let options = Options { scale: 0.01, crease_angle: 30.0, normals, ..options };
            (path, options, Some([0.72, 0.75, 0.78, 1.0]))
        }
    };
    let (mut model, _) = import(&path, &options)?;
    if let Some(color) = color {
        model.materials = vec![Material { color, ..Material::default() }];
        model.meshes.iter_mut().for_each(|mesh| mesh.material = Some(0));
    }
    Ok(write(&model, &write_options)?)
}
