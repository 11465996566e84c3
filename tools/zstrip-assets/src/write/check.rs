//! Checks that an import is consistent: importers make such, and programs may make others.

use super::report::WriteError;
use crate::model::{Import, Interpolation};

/// Returns the first mistake: a number of another item that is that of none, or a list that is too short.
pub(super) fn check(import: &Import) -> Result<(), WriteError> {
    let index = |place: String, found: usize, count: usize| {
        if found < count { Ok(()) } else { Err(WriteError::Index { place, found, count }) }
    };
    let length = |place: String, found: usize, needed: usize| {
        if found == needed { Ok(()) } else { Err(WriteError::Count { place, found, needed }) }
    };
    for (k, node) in import.nodes.iter().enumerate() {
        if let Some(parent) = node.parent {
            index(format!("nodes[{k}], parent"), parent, k)?;
        }
        for mesh in &node.meshes {
            index(format!("nodes[{k}], mesh"), *mesh, import.meshes.len())?;
        }
        if let Some(skin) = node.skin {
            index(format!("nodes[{k}], skin"), skin, import.skins.len())?;
        }
    }
    for (k, skin) in import.skins.iter().enumerate() {
        if skin.joints.is_empty() {
            return Err(WriteError::Count { place: format!("skins[{k}], joints"), found: 0, needed: 1 });
        }
        length(format!("skins[{k}], inverse bind matrices"), skin.inverse_binds.len(), skin.joints.len())?;
        for joint in &skin.joints {
            index(format!("skins[{k}], joint"), *joint, import.nodes.len())?;
        }
    }
    for (k, material) in import.materials.iter().enumerate() {
        if let Some(texture) = material.texture {
            index(format!("materials[{k}], image"), texture.image, import.images.len())?;
        }
    }
    for (k, image) in import.images.iter().enumerate() {
        let size = [image.width, image.height];
        if size.contains(&0) {
            return Err(WriteError::EmptyImage { place: format!("images[{k}]"), size });
        }
        let bytes = 4 * u128::from(image.width) * u128::from(image.height);
        length(format!("images[{k}], bytes"), image.texels.len(), usize::try_from(bytes).unwrap_or(usize::MAX))?;
    }
    for (k, animation) in import.animations.iter().enumerate() {
        for channel in &animation.channels {
            index(format!("animations[{k}], node"), channel.node, import.nodes.len())?;
            let parts = if channel.interpolation == Interpolation::Cubic { 3 } else { 1 };
            let needed = channel.width() * parts * channel.times.len();
            length(format!("animations[{k}], values of nodes[{}]", channel.node), channel.values.len(), needed)?;
        }
    }
    for (k, mesh) in import.meshes.iter().enumerate() {
        let vertices = &mesh.vertices;
        let count = vertices.positions.len();
        if let Some(material) = mesh.material {
            index(format!("meshes[{k}], material"), material, import.materials.len())?;
        }
        if let Some(coarser) = mesh.coarser {
            index(format!("meshes[{k}], coarser mesh"), coarser, import.meshes.len())?;
            let place = format!("meshes[{k}], coarser mesh");
            if coarser <= k {
                return Err(WriteError::Order { place, found: coarser, least: k + 1 });
            }
            let (finer, error) = (mesh.error, import.meshes[coarser].error);
            if !error.is_finite() || error < finer {
                return Err(WriteError::LevelError { mesh: coarser, found: error, least: finer });
            }
        }
        for v in mesh.triangles.as_flattened() {
            index(format!("meshes[{k}], vertex of a triangle"), *v as usize, count)?;
        }
        let of_clusters = mesh.clusters.iter().fold(0, |sum: usize, cluster| sum.saturating_add(cluster.count));
        if !mesh.clusters.is_empty() {
            length(format!("meshes[{k}], triangles in clusters"), of_clusters, mesh.triangles.len())?;
        }
        if vertices.joints.is_empty() != vertices.weights.is_empty() {
            length(format!("meshes[{k}], weights"), vertices.weights.len(), vertices.joints.len())?;
        }
        let lists = [
            ("normals", vertices.normals.len()),
            ("texture coordinates", vertices.uvs.len()),
            ("colours", vertices.colors.len()),
            ("joints", vertices.joints.len()),
            ("weights", vertices.weights.len()),
        ];
        let morphs = vertices.morphs.iter().map(|morph| ("normals of a morph target", morph.normals.len()));
        for (name, found) in lists.into_iter().chain(morphs).filter(|(_, found)| *found > 0) {
            length(format!("meshes[{k}], {name}"), found, count)?;
        }
        for morph in &vertices.morphs {
            length(format!("meshes[{k}], positions of a morph target"), morph.positions.len(), count)?;
        }
        let numbers = vertices.positions.as_flattened().iter().chain(vertices.normals.as_flattened());
        let moves = vertices.morphs.iter().flat_map(|morph| morph.positions.iter().chain(&morph.normals).flatten());
        let weights = vertices.weights.as_flattened();
        if numbers.chain(moves).chain(weights).any(|x| !x.is_finite()) {
            return Err(WriteError::NotFinite { place: format!("a number of meshes[{k}]") });
        }
        for node in import.nodes.iter().filter(|node| node.meshes.contains(&k)) {
            if let Some(skin) = node.skin {
                let joints = import.skins[skin].joints.len();
                for joint in vertices.joints.as_flattened() {
                    index(format!("meshes[{k}], joint"), usize::from(*joint), joints)?;
                }
            }
        }
    }
    Ok(())
}
