//! Reads glTF and GLB: extensions, buffers, then materials, the hierarchy, meshes, skins and animations.
//!
//! The `gltf` crate parses and validates the document; everything here works on its JSON, because its wrappers trust
//! what validation does not look at.

mod accessor;
mod animation;
mod material;
mod mesh;
mod scene;

use gltf::json;
use gltf::json::mesh::Semantic;
use gltf::json::validation::Checked;

use crate::draft::{Context, Scene};
use crate::error::{Error, Kind, Place};
use crate::report::Note;
use accessor::{Buffers, place};

/// Extensions that are read.
const KNOWN: [&str; 3] = ["KHR_materials_unlit", "KHR_mesh_quantization", "KHR_texture_transform"];

/// Bytes of a GLB header.
const GLB_HEADER: usize = 12;

pub(crate) fn read(bytes: &[u8], context: &mut Context) -> Result<Scene, Error> {
    check_size(bytes, context)?;
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice_without_validation(bytes).map_err(|error| {
        // Of a file of another kind, the parser says only that its first byte is wrong.
        let is_gltf = bytes.starts_with(b"glTF") || bytes.trim_ascii_start().starts_with(b"{");
        let error = if is_gltf { text(&error) } else { "neither GLB nor the JSON of glTF".to_owned() };
        context.error(Place::File, Kind::Syntax, format!("{error}; export it again"))
    })?;
    let mut json = document.into_json();
    check_extensions(&mut json, context)?;
    check_positions(&json, context)?;
    // Only now, because validation knows less extensions than this module.
    let json = match gltf::Document::from_json(json) {
        Ok(document) => document.into_json(),
        Err(gltf::Error::Validation(errors)) => {
            let (path, error) = errors
                .first()
                .map_or((String::new(), "invalid".to_owned()), |(path, error)| (path.to_string(), error.to_string()));
            let message = format!("{error} ({} such errors in all); export the file again", errors.len());
            return Err(context.error(Place::Json(path), Kind::Syntax, message));
        }
        Err(error) => return Err(context.error(Place::File, Kind::Syntax, text(&error))),
    };
    let buffers = read_buffers(&json, blob, context)?;
    let mut scene = Scene::default();
    scene.import.materials = material::read(&json, &buffers, context)?;
    let numbers = scene::read(&json, &buffers, &mut scene, context)?;
    animation::read(&json, &buffers, &numbers, &mut scene, context)?;
    for (count, what) in [(json.cameras.len(), "camera"), (json.scenes.len().saturating_sub(1), "other scene")] {
        (0..count).for_each(|_| context.ignore(what));
    }
    Ok(scene)
}

/// An error of the `gltf` crate in one line.
fn text(error: &gltf::Error) -> String {
    error.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Checks sizes that the parser trusts, and bounds how many values it may make.
fn check_size(bytes: &[u8], context: &Context) -> Result<(), Error> {
    if bytes.starts_with(b"glTF") {
        let length = bytes.get(8..GLB_HEADER).and_then(|rest| rest.first_chunk()).map(|b| u32::from_le_bytes(*b));
        let found = bytes.len();
        let message = match length {
            Some(length) if (GLB_HEADER..=found).contains(&(length as usize)) => None,
            Some(length) => Some(format!("the header says {length} bytes, and the file has {found}; export it again")),
            None => Some(format!("{found} bytes, where a GLB has {GLB_HEADER} at least; export it again")),
        };
        if let Some(message) = message {
            return Err(context.error(Place::Byte(8.min(found)), Kind::Syntax, message));
        }
    }
    // Values in JSON are between brackets and commas. In binary data, as many bytes look like them as chance has it.
    let json = match bytes.get(GLB_HEADER..GLB_HEADER + 4).and_then(|rest| rest.first_chunk()) {
        Some(length) if bytes.starts_with(b"glTF") => {
            let end = (GLB_HEADER + 8).saturating_add(u32::from_le_bytes(*length) as usize);
            &bytes[(GLB_HEADER + 8).min(bytes.len())..end.min(bytes.len())]
        }
        _ => bytes,
    };
    let values = json.iter().filter(|byte| b"[{,".contains(byte)).count() as u64;
    let most = context.options.limits.json_values;
    if values > most {
        let message = format!("{values} values of JSON, where {most} are the limit");
        return Err(context.error(Place::File, Kind::Limit, message));
    }
    Ok(())
}

/// Refuses extensions that are required and not known; reports those that are not known.
fn check_extensions(json: &mut json::Root, context: &mut Context) -> Result<(), Error> {
    let is_known = |name: &String| KNOWN.contains(&&name[..]);
    if let Some((k, name)) = json.extensions_required.iter().enumerate().find(|(_, name)| !is_known(name)) {
        let advice = if name.contains("compression") { "without compression" } else { "without it" };
        let message = format!("extension {name} is required, and not read; export the file {advice}");
        return Err(context.error(place("extensionsRequired", k), Kind::Unsupported, message));
    }
    json.extensions_required.clear();
    let mut unknown: Vec<_> = json.extensions_used.iter().filter(|name| !is_known(name)).cloned().collect();
    unknown.sort();
    unknown.dedup();
    for name in unknown {
        context.report.add(Note::ExtensionIgnored { name });
    }
    Ok(())
}

/// Checks the accessors of positions, at which validation panics where they do not exist.
fn check_positions(json: &json::Root, context: &Context) -> Result<(), Error> {
    for (m, mesh) in json.meshes.iter().enumerate() {
        for (k, primitive) in mesh.primitives.iter().enumerate() {
            let index = primitive.attributes.get(&Checked::Valid(Semantic::Positions)).map(|index| index.value());
            if let Some(index) = index.filter(|index| *index >= json.accessors.len()) {
                let at = Place::Json(format!("meshes[{m}].primitives[{k}].attributes[\"POSITION\"]"));
                let message = format!("accessor {index}, where there are {}", json.accessors.len());
                return Err(context.error(at, Kind::Index, message));
            }
        }
    }
    Ok(())
}

fn read_buffers(json: &json::Root, blob: Option<Vec<u8>>, context: &mut Context) -> Result<Buffers, Error> {
    let mut blob = blob;
    let mut buffers = Vec::new();
    for (k, buffer) in json.buffers.iter().enumerate() {
        let at = place("buffers", k);
        let bytes = match &buffer.uri {
            Some(uri) => context.files.read_uri(uri, at.clone())?,
            None => match blob.take().filter(|_| k == 0) {
                Some(blob) => blob,
                None => return Err(context.error(at, Kind::Missing, "no URI, and no binary part of a GLB file")),
            },
        };
        if (bytes.len() as u64) < buffer.byte_length.0 {
            let message = format!("{} bytes, where {} are needed; export it again", bytes.len(), buffer.byte_length.0);
            return Err(context.error(at, Kind::Missing, message));
        }
        buffers.push(bytes);
    }
    Ok(Buffers(buffers))
}
