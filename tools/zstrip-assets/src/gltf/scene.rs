//! The hierarchy of glTF: nodes, each after its parent, the meshes that they show, and skins.

use std::ops::Range;

use gltf::json::Root;
use gltf::json::accessor::Type;

use super::accessor::{Buffers, place};
use super::mesh;
use crate::draft::{Context, Scene};
use crate::error::{Error, Kind, Place};
use crate::geometry::unit_quaternion;
use crate::model::{Node, Skin, Transform};
use crate::report::Note;

/// Numbers that a node takes at least.
const NODE_NUMBERS: u64 = 32;

/// Reads nodes, skins, and the meshes that the default scene shows.
///
/// Returns the numbers of nodes in the import, by their numbers in the file.
pub(super) fn read(
    json: &Root,
    buffers: &Buffers,
    scene: &mut Scene,
    context: &mut Context,
) -> Result<Vec<usize>, Error> {
    context.take_numbers(json.nodes.len() as u64 * NODE_NUMBERS, || Place::Json("nodes".to_owned()))?;
    let (order, parents) = order(json, context)?;
    let shown = shown(json, &order, &parents);
    let hidden = shown.iter().zip(&json.nodes).filter(|(shown, node)| !**shown && node.mesh.is_some());
    hidden.for_each(|_| context.ignore("node that the scene does not show"));

    let mut numbers = vec![0; order.len()];
    order.iter().enumerate().for_each(|(k, node)| numbers[*node] = k);
    // The drafts of each mesh that was read so far.
    let mut drafts: Vec<Option<Range<usize>>> = vec![None; json.meshes.len()];
    for &k in &order {
        let node = &json.nodes[k];
        let mut meshes = Vec::new();
        let mut weights = node.weights.clone().unwrap_or_default();
        if !weights.iter().all(|weight| weight.is_finite()) {
            return Err(context.error(place("nodes", k), Kind::NonFinite, "weights that are not finite"));
        }
        if let Some(number) = node.mesh.filter(|_| shown[k]).map(|mesh| mesh.value()) {
            let Range { start, end } = match &drafts[number] {
                Some(known) => known.clone(),
                None => {
                    let first = scene.drafts.len();
                    scene.drafts.extend(mesh::read(json, number, buffers, context)?);
                    first..scene.drafts.len()
                }
            };
            drafts[number] = Some(start..end);
            let targets = scene.drafts[start..end].iter().map(|draft| draft.vertices.morphs.len()).max().unwrap_or(0);
            context.take_numbers((2 * (end - start) + targets) as u64, || place("nodes", k))?;
            meshes = (start..end).collect();
            if weights.is_empty() {
                let of_mesh = json.meshes[number].weights.iter().flatten();
                weights = of_mesh.take(targets).copied().collect();
            }
            weights.resize(targets, 0.0);
            weights.shrink_to_fit();
        }
        scene.import.nodes.push(Node {
            name: node.name.clone().unwrap_or_default(),
            parent: parents[k].map(|parent| numbers[parent]),
            transform: transform(json, k, context)?,
            skin: node.skin.filter(|_| !meshes.is_empty()).map(|skin| skin.value()),
            meshes,
            weights,
        });
    }
    skins(json, buffers, &numbers, scene, context)?;
    Ok(numbers)
}

/// Numbers of nodes, each after its parent, and the parents of all.
fn order(json: &Root, context: &Context) -> Result<(Vec<usize>, Vec<Option<usize>>), Error> {
    let count = json.nodes.len();
    let mut parents = vec![None; count];
    for (k, node) in json.nodes.iter().enumerate() {
        for child in node.children.iter().flatten().map(|child| child.value()) {
            if let Some(other) = parents[child].replace(k) {
                let message = format!("it has two parents, nodes {other} and {k}; export the file again");
                return Err(context.error(place("nodes", child), Kind::Hierarchy, message));
            }
        }
    }
    let mut order: Vec<usize> = (0..count).filter(|k| parents[*k].is_none()).collect();
    let mut next = 0;
    while let Some(k) = order.get(next).copied() {
        order.extend(json.nodes[k].children.iter().flatten().map(|child| child.value()));
        next += 1;
    }
    if order.len() < count {
        let mut reached = vec![false; count];
        order.iter().for_each(|k| reached[*k] = true);
        let lost = reached.iter().position(|reached| !reached).unwrap_or(0);
        let message = "it is its own ancestor, or below such a node; export the file again";
        return Err(context.error(place("nodes", lost), Kind::Hierarchy, message));
    }
    Ok((order, parents))
}

/// Returns for each node whether the default scene shows it. Without a scene, all are shown.
fn shown(json: &Root, order: &[usize], parents: &[Option<usize>]) -> Vec<bool> {
    let scene = json.scene.map_or(0, |scene| scene.value());
    let Some(scene) = json.scenes.get(scene) else { return vec![true; order.len()] };
    let mut shown = vec![false; order.len()];
    scene.nodes.iter().for_each(|node| shown[node.value()] = true);
    for &k in order {
        shown[k] |= parents[k].is_some_and(|parent| shown[parent]);
    }
    shown
}

fn transform(json: &Root, k: usize, context: &mut Context) -> Result<Transform, Error> {
    let node = &json.nodes[k];
    let infinite = |context: &Context| {
        context.error(place("nodes", k), Kind::NonFinite, "a transform that is not finite; export the file again")
    };
    if let Some(m) = node.matrix {
        if !m.iter().all(|x| x.is_finite()) {
            return Err(infinite(context));
        }
        return Ok(Transform::Matrix(std::array::from_fn(|column| std::array::from_fn(|row| m[4 * column + row]))));
    }
    let translation = node.translation.unwrap_or([0.0; 3]);
    let scale = node.scale.unwrap_or([1.0; 3]);
    let rotation = node.rotation.map_or([0.0, 0.0, 0.0, 1.0], |rotation| rotation.0);
    if !translation.iter().chain(&scale).chain(&rotation).all(|x| x.is_finite()) {
        return Err(infinite(context));
    }
    let (rotation, is_changed) = unit_quaternion(rotation);
    context.report.add(Note::RotationsNormalized { rotations: usize::from(is_changed) });
    Ok(Transform::Parts { translation, rotation, scale })
}

fn skins(
    json: &Root,
    buffers: &Buffers,
    numbers: &[usize],
    scene: &mut Scene,
    context: &mut Context,
) -> Result<(), Error> {
    for (k, skin) in json.skins.iter().enumerate() {
        let count = skin.joints.len();
        let fail = |context: &Context, kind, message: String| Err(context.error(place("skins", k), kind, message));
        if count == 0 {
            return fail(context, Kind::Missing, "a skin without joints".to_owned());
        }
        let identity = std::array::from_fn(|column| std::array::from_fn(|row| if row == column { 1.0 } else { 0.0 }));
        let mut inverse_binds = vec![identity; count];
        context.take_numbers(count as u64 * 16, || place("skins", k))?;
        if let Some(accessor) = skin.inverse_bind_matrices {
            let matrices = buffers.numbers(json, accessor.value(), &[Type::Mat4], context)?;
            if matrices.count < count {
                let message = format!("{} inverse bind matrices, where there are {count} joints", matrices.count);
                return fail(context, Kind::Missing, message);
            }
            let columns = |m: [f32; 16]| std::array::from_fn(|k| [m[4 * k], m[4 * k + 1], m[4 * k + 2], m[4 * k + 3]]);
            inverse_binds = matrices.arrays::<16>().into_iter().take(count).map(columns).collect();
        }
        let joints = skin.joints.iter().map(|joint| numbers[joint.value()]).collect();
        scene.import.skins.push(Skin { name: skin.name.clone().unwrap_or_default(), joints, inverse_binds });
    }
    for (k, node) in scene.import.nodes.iter().enumerate() {
        let Some(skin) = node.skin else { continue };
        let count = scene.import.skins[skin].joints.len();
        for draft in node.meshes.iter().map(|mesh| &scene.drafts[*mesh]) {
            let found = draft.vertices.joints.iter().flatten().max();
            if let Some(joint) = found.filter(|joint| usize::from(**joint) >= count) {
                let message = format!("a vertex of mesh {:?} follows joint {joint} of {count}", draft.name);
                let number = numbers.iter().position(|number| *number == k).unwrap_or(0);
                return Err(context.error(place("nodes", number), Kind::Index, message));
            }
        }
    }
    Ok(())
}
