//! Turns, scales and moves a model as options say.

use crate::draft::{Context, Scene};
use crate::error::{Error, Kind, Place};
use crate::geometry::{Matrix, matrix, point};
use crate::model::{Bounds, Import, Node, Transform};
use crate::options::{Center, UpAxis};

/// The rotation that brings z to y: a quarter around x.
const Z_TO_Y: [f32; 4] = [-std::f32::consts::FRAC_1_SQRT_2, 0.0, 0.0, std::f32::consts::FRAC_1_SQRT_2];

/// The transform that options ask for, without centering.
fn turned(up: UpAxis, scale: f64) -> Transform {
    let rotation = if up == UpAxis::Z { Z_TO_Y } else { [0.0, 0.0, 0.0, 1.0] };
    Transform::Parts { translation: [0.0; 3], rotation, scale: [scale as f32; 3] }
}

/// The way that the box has to go.
fn offset(center: Center, bounds: Option<Bounds>) -> [f32; 3] {
    let Some(Bounds { min, max }) = bounds else { return [0.0; 3] };
    let middle: [f32; 3] = std::array::from_fn(|k| min[k] / 2.0 + max[k] / 2.0);
    match center {
        Center::Keep => [0.0; 3],
        Center::Middle => middle.map(|x| -x),
        Center::Ground => [-middle[0], -min[1], -middle[2]],
    }
}

/// Moves the vertices of a scene without hierarchy.
pub(crate) fn place_vertices(scene: &mut Scene, up: UpAxis, context: &Context) -> Result<(), Error> {
    let options = context.options;
    // Exactly: a quarter turn and nothing else should leave all digits as they are.
    let turn = |[x, y, z]: [f32; 3]| if up == UpAxis::Z { [x, z, -y] } else { [x, y, z] };
    let scaled = |x: f32| if options.scale == 1.0 { x } else { (f64::from(x) * options.scale) as f32 };
    for vertices in scene.drafts.iter_mut().map(|draft| &mut draft.vertices) {
        vertices.positions.iter_mut().for_each(|p| *p = turn(*p).map(scaled));
        vertices.normals.iter_mut().for_each(|n| *n = turn(*n));
    }
    let used = scene
        .drafts
        .iter()
        .flat_map(|draft| draft.triangles.iter().flatten().map(|v| draft.vertices.positions[*v as usize]));
    let offset = offset(options.center, Bounds::around(used));
    for p in scene.drafts.iter_mut().flat_map(|draft| &mut draft.vertices.positions) {
        *p = std::array::from_fn(|k| p[k] + offset[k]);
        if !p.iter().all(|x| x.is_finite()) {
            let message = "a position is not finite after it was scaled and moved; choose a smaller scale";
            return Err(context.error(Place::File, Kind::NonFinite, message));
        }
    }
    Ok(())
}

/// Puts a node above all others, where options ask for a transform.
pub(crate) fn place_nodes(import: &mut Import, up: UpAxis, context: &Context) -> Result<(), Error> {
    let options = context.options;
    if (up, options.center) == (UpAxis::Y, Center::Keep) && options.scale == 1.0 {
        return Ok(());
    }
    for node in &mut import.nodes {
        node.parent = Some(node.parent.map_or(0, |parent| parent + 1));
    }
    import.nodes.insert(0, Node { name: "placed".to_owned(), transform: turned(up, options.scale), ..Node::default() });
    import.skins.iter_mut().flat_map(|skin| &mut skin.joints).for_each(|joint| *joint += 1);
    let channels = import.animations.iter_mut().flat_map(|animation| &mut animation.channels);
    channels.for_each(|channel| channel.node += 1);
    let moved = offset(options.center, import.bounds());
    if let Transform::Parts { translation, .. } = &mut import.nodes[0].transform {
        *translation = moved;
    }
    let top: Matrix = matrix(&import.nodes[0].transform);
    if !point(&top, [1.0; 3]).iter().all(|x| x.is_finite()) {
        let message = "the scale or the place of the model is not finite; choose a smaller scale";
        return Err(context.error(Place::File, Kind::NonFinite, message));
    }
    Ok(())
}
