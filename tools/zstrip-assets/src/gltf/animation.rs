//! Animations of glTF: channels of keys.

use std::collections::HashSet;

use gltf::json::Root;
use gltf::json::accessor::Type;
use gltf::json::animation::{Interpolation as Way, Property};
use gltf::json::validation::Checked;

use super::accessor::Buffers;
use crate::draft::{Context, Scene};
use crate::error::{Error, Kind, Place};
use crate::geometry::unit_quaternion;
use crate::model::{Animation, Channel, Interpolation, Path};
use crate::report::Note;

/// Reads all clips. `numbers` are those of nodes in the import, by their numbers in the file.
pub(super) fn read(
    json: &Root,
    buffers: &Buffers,
    numbers: &[usize],
    scene: &mut Scene,
    context: &mut Context,
) -> Result<(), Error> {
    for (number, animation) in json.animations.iter().enumerate() {
        let mut channels = Vec::new();
        let mut moved = HashSet::new();
        for k in 0..animation.channels.len() {
            let Some(channel) = read_channel(json, (number, k), buffers, (numbers, scene), context)? else { continue };
            if moved.insert((channel.node, channel.path)) {
                channels.push(channel);
            } else {
                context.ignore("channel that moves the same property as another one");
            }
        }
        scene.import.animations.push(Animation { name: animation.name.clone().unwrap_or_default(), channels });
    }
    Ok(())
}

fn read_channel(
    json: &Root,
    (number, k): (usize, usize),
    buffers: &Buffers,
    (numbers, scene): (&[usize], &Scene),
    context: &mut Context,
) -> Result<Option<Channel>, Error> {
    let animation = &json.animations[number];
    let channel = &animation.channels[k];
    let fail = |context: &Context, kind, message: String| {
        Err(context.error(Place::Json(format!("animations[{number}].channels[{k}]")), kind, message))
    };
    let Some(sampler) = animation.samplers.get(channel.sampler.value()) else {
        return fail(context, Kind::Index, format!("sampler {} does not exist", channel.sampler.value()));
    };
    let (Checked::Valid(property), Checked::Valid(way)) = (channel.target.path, sampler.interpolation) else {
        return fail(context, Kind::Syntax, "its path or interpolation is unknown".to_owned());
    };
    // Validation does not look at the targets of channels.
    let Some(&node) = numbers.get(channel.target.node.value()) else {
        let message = format!("node {}, where there are {}", channel.target.node.value(), numbers.len());
        return fail(context, Kind::Index, message);
    };
    let (path, type_, width) = match property {
        Property::Translation => (Path::Translation, Type::Vec3, 3),
        Property::Scale => (Path::Scale, Type::Vec3, 3),
        Property::Rotation => (Path::Rotation, Type::Vec4, 4),
        Property::MorphTargetWeights => (Path::Weights, Type::Scalar, scene.import.nodes[node].weights.len()),
    };
    if width == 0 {
        context.ignore("channel of weights for a node without morph targets");
        return Ok(None);
    }
    let interpolation = match way {
        Way::Linear => Interpolation::Linear,
        Way::Step => Interpolation::Step,
        Way::CubicSpline => Interpolation::Cubic,
    };
    let times = buffers.numbers(json, sampler.input.value(), &[Type::Scalar], context)?.floats();
    let mut values = buffers.numbers(json, sampler.output.value(), &[type_], context)?.floats();
    if let Some(at) = (1..times.len()).find(|at| times[at - 1] >= times[*at]) {
        let message = format!("key {at} is at {} s, which is not after {} s", times[at], times[at - 1]);
        return fail(context, Kind::Syntax, message);
    }
    let per_key = width * if interpolation == Interpolation::Cubic { 3 } else { 1 };
    if times.is_empty() || values.len() != times.len() * per_key {
        let message = format!("{} numbers, where {} keys of {per_key} are needed", values.len(), times.len());
        return fail(context, Kind::Missing, message);
    }
    if path == Path::Rotation {
        let mut changed = 0;
        for (k, value) in values.as_chunks_mut::<4>().0.iter_mut().enumerate() {
            // Tangents of cubic keys are differences, and have any length.
            if interpolation != Interpolation::Cubic || k % 3 == 1 {
                let (unit, is_changed) = unit_quaternion(*value);
                *value = unit;
                changed += usize::from(is_changed);
            }
        }
        context.report.add(Note::RotationsNormalized { rotations: changed });
    }
    Ok(Some(Channel { node, path, interpolation, times, values }))
}
