//! What a model's own stages take: its pose, its places, and what its packed vertices take beside those of the tables.

use super::super::Stage;
use super::super::turntable::Step;
use zstrip::model::container::{
    Channel, Clip, Influence, Material, NONE, Node, Part, Path, SectionKind, Skin, Target, Texture,
};

/// The costs: those, none below 0, whose sums come nearest to what `ci/costs` counted of models that it makes up.
const COSTS: &str = include_str!("../../../../../benches/pose_costs.csv");

/// Columns of the file, and their number.
///
/// | column | |
/// |---|---|
/// | `place` | a draw that is placed: its matrix and its light |
/// | `above` | a node above one with draws, at rest: a chain of nodes counts each of them once per node below it |
/// | `level` | such a draw with a texture of several levels, or with coarser parts |
/// | `node` | a node of a pose |
/// | `channel` | a channel of the clip that is played |
/// | `moved` | a node that such channels move |
/// | `joint` | a joint of a skin |
/// | `rigid` | a vertex of one joint |
/// | `blended` | a vertex of several joints |
/// | `third` | beside `blended`, a vertex of three or four joints: the library sums four matrices then, and not two |
/// | `morphed` | a vertex of a part with morph targets that has no joints |
/// | `skin_morphed` | beside the costs of its joints, a vertex of a part with morph targets and joints |
/// | `delta` | a vertex that a target moves |
pub const NAMES: [&str; COLUMNS] = [
    "place",
    "above",
    "level",
    "node",
    "channel",
    "moved",
    "joint",
    "rigid",
    "blended",
    "third",
    "morphed",
    "skin_morphed",
    "delta",
];
pub const COLUMNS: usize = 13;
const PLACE: usize = 0;
const ABOVE: usize = 1;
const LEVEL: usize = 2;
/// The first column of a pose.
pub const NODE: usize = 3;
const CHANNEL: usize = 4;
const MOVED: usize = 5;
const JOINT: usize = 6;
const RIGID: usize = 7;
const BLENDED: usize = 8;
const THIRD: usize = 9;
const MORPHED: usize = 10;
const SKIN_MORPHED: usize = 11;
const DELTA: usize = 12;

/// Costs, or numbers of things that cost, by column.
pub type PoseTerms = [f64; COLUMNS];

/// Returns the costs on a core, and the largest error in percent.
pub fn costs(core: &str, unit: &str) -> Option<(PoseTerms, f64)> {
    let start = format!("{core},{unit},");
    let line = COSTS.lines().find_map(|line| line.strip_prefix(&start))?;
    let numbers = line.split(',').map(|cell| cell.parse().ok()).collect::<Option<Vec<f64>>>()?;
    let (terms, error) = numbers.split_first_chunk()?;
    Some((*terms, *error.first()?))
}

/// Counts what posing and placing takes in a frame; nothing is posed at rest.
pub fn count(stage: &Stage<'_>, step: &Step, clip: u32) -> PoseTerms {
    let mut terms = [0.0; COLUMNS];
    terms[PLACE] = f64::from(stage.header().draws);
    let (parts, materials) = (stage.items::<Part>(SectionKind::Parts), stage.items::<Material>(SectionKind::Materials));
    let textures = stage.items::<Texture>(SectionKind::Textures);
    for part in stage.nodes_parts().filter_map(|number| parts.get(number)) {
        let material = materials.get(usize::from(part.material));
        let texture = material.and_then(|material| textures.get(usize::from(material.texture)));
        terms[LEVEL] += f64::from(u8::from(part.coarser != NONE || texture.is_some_and(|texture| texture.levels > 1)));
    }
    let nodes = stage.items::<Node>(SectionKind::Nodes);
    if step.motion.is_none() {
        terms[ABOVE] = nodes_above(nodes);
        return terms;
    }
    terms[NODE] = nodes.len() as f64;
    let clips = stage.items::<Clip>(SectionKind::Clips);
    if let Some(clip) = clips.get(clip as usize) {
        let channels = stage.items::<Channel>(SectionKind::Channels).iter().skip(clip.first_channel as usize);
        let moving = channels.take(clip.channels as usize).filter(|channel| channel.path != Path::Weights as u8);
        // Channels are in the order of their nodes.
        let mut nodes: Vec<_> = moving.map(|channel| channel.target).collect();
        nodes.dedup();
        (terms[CHANNEL], terms[MOVED]) = (clip.channels.into(), nodes.len() as f64);
    }
    let targets = stage.items::<Target>(SectionKind::Targets);
    let influences = stage.items::<Influence>(SectionKind::Influences);
    let mut last = NONE;
    for part in parts {
        let (vertices, first) = (part.vertices as usize, part.first_target as usize);
        let moved = targets.iter().skip(first).take(part.targets.into());
        terms[DELTA] += moved.map(|target| f64::from(target.vertices)).sum::<f64>();
        if part.targets > 0 {
            terms[if part.skin == NONE { MORPHED } else { SKIN_MORPHED }] += vertices as f64;
        }
        if part.skin == NONE {
            continue;
        }
        // Parts of one skin that follow each other share its joints.
        if part.skin != last {
            let skin = stage.items::<Skin>(SectionKind::Skins).get(usize::from(part.skin));
            terms[JOINT] += skin.map_or(0.0, |skin| skin.joints.into());
            last = part.skin;
        }
        for influence in influences.iter().skip(part.first_influence as usize).take(vertices) {
            let others = influence.weights.iter().filter(|weight| **weight > 0).count();
            if others == 0 {
                terms[RIGID] += 1.0;
            } else {
                terms[BLENDED] += 1.0;
                terms[THIRD] += f64::from(u8::from(others > 1));
            }
        }
    }
    terms
}

/// Returns the number of nodes above nodes with draws, counted once for each of these.
fn nodes_above(nodes: &[Node]) -> f64 {
    let (mut depths, mut sum) = (Vec::with_capacity(nodes.len()), 0.0);
    for node in nodes {
        // A parent has a lower number.
        let depth = depths.get(usize::from(node.parent)).map_or(0.0, |depth| depth + 1.0);
        depths.push(depth);
        if node.parts > 0 {
            sum += depth;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_cores_have_costs() {
        for (core, unit) in [
            ("m0+", "instructions"),
            ("m0+", "cycles"),
            ("m4", "instructions"),
            ("m4", "cycles"),
            ("rv32imc", "instructions"),
        ] {
            let (terms, error) = costs(core, unit).expect("a line of all columns");
            assert!(terms[PLACE] > 1000.0 && terms.iter().all(|cost| *cost >= 0.0) && error > 0.0, "{core} {unit}");
        }
    }

    #[test]
    fn nodes_above_draws_are_counted() {
        let node = |parent, parts| Node { parent, parts, ..zstrip::bytemuck::Zeroable::zeroed() };
        let tree = [node(NONE, 0), node(0, 1), node(1, 3), node(0, 0), node(NONE, 2), node(2, 1)];
        assert_eq!(nodes_above(&tree), 1.0 + 2.0 + 3.0);
        assert_eq!(nodes_above(&[]), 0.0);
    }
}
