//! Poses beside those in double precision.

use super::builder::Builder;
use super::exact::{At, ExactPose, fixed};
use super::figures::{add_target, animated, textured};
use crate::support::accuracy::check;
use crate::support::position;
use zstrip::math::Scalar;
use zstrip::model::{Model, Motion, Pose};

/// The worst errors of a pose: nodes in units, positions in 32,768ths of the cube that holds the model, normals in
/// degrees.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    node: f64,
    position: f64,
    normal: f64,
}

impl Worst {
    fn add(&mut self, builder: &Builder, pose: &Pose<'_>, exact: &ExactPose) {
        for (number, matrix) in exact.nodes.iter().enumerate() {
            let found = pose.node(number).expect("a node").to_rows();
            for (found, exact) in found.as_flattened().iter().zip(matrix.as_flattened()) {
                self.node = self.node.max((fixed(*found) - exact).abs());
            }
        }
        let mesh = pose.mesh(0).expect("a part");
        let (bounds, normals) = (mesh.bounds(), mesh.data().normals.expect("normals"));
        for (vertex, normal_found) in normals.iter().enumerate() {
            let [x, y, z, _] = position(&mesh.data().positions, vertex);
            let (at, normal) = exact.vertex(builder, vertex);
            for (k, (found, exact)) in [x, y, z].into_iter().zip(at).enumerate() {
                self.position = self.position.max((found - exact).abs() / 2.5 * 32_768.0);
                let (center, half) = (fixed(bounds.center.to_bits()[k]), fixed(bounds.half.to_bits()[k]));
                assert!((found - center).abs() <= half + 1e-4, "vertex {vertex} is outside of the bounds");
            }
            let found = normal_found.map(f64::from);
            let length = found.iter().map(|c| c * c).sum::<f64>().sqrt();
            assert!((length - 16_384.0).abs() < 4.0, "the normal of vertex {vertex} has the length {length}");
            let off: f64 = (0..3).map(|k| (found[k] / length - normal[k]).powi(2)).sum();
            self.normal = self.normal.max(off.sqrt().to_degrees());
        }
    }
}

/// Compares poses of two clips, and those between them, over their time.
fn worst_of(builder: &Builder) -> Worst {
    let container = builder.clone().build();
    let model = Model::from_bytes(container.bytes()).expect("a model");
    let mut memory = vec![0xA5A5_A5A5; Pose::words(container.bytes())];
    let mut pose = model.pose(&mut memory).expect("enough words");
    let mut worst = Worst::default();
    worst.add(builder, &pose, &ExactPose::new(builder, None, None));
    let clips: Vec<_> = model.clips().collect();
    let at = |clip: usize, ms: u32| -> (Motion, At) {
        (clips[clip].once(ms), (clip, f64::from(ms) / f64::from(clips[clip].duration())))
    };
    for step in 0..40 {
        let (bend, exact_bend) = at(0, step * 30);
        let (wave, exact_wave) = at(1, step * 22);
        pose.play(bend);
        worst.add(builder, &pose, &ExactPose::new(builder, Some(exact_bend), None));
        pose.play(wave);
        worst.add(builder, &pose, &ExactPose::new(builder, Some(exact_wave), None));
        let weight = Scalar::from_bits(step as i32 * 1638);
        pose.blend(bend, wave, weight);
        let exact =
            ExactPose::new(builder, Some(exact_bend), Some((exact_wave, f64::from(weight.to_bits()) / 65_536.0)));
        worst.add(builder, &pose, &exact);
    }
    worst
}

#[test]
fn posed_vertices_are_those_of_their_joints() {
    let (joints, both) = (worst_of(&animated(false)), worst_of(&animated(true)));
    check("entry of the matrix of a posed node", joints.node.max(both.node) * 65_536.0);
    check("position of a vertex that joints move", joints.position.max(both.position));
    // The cube is as high as a screen of 320 px.
    check("the same on a screen of 320 px", joints.position.max(both.position) * 160.0 / 32_768.0);
    check("normal of a vertex that joints turn", joints.normal);
    check("normal of a vertex that morph targets and joints turn", both.normal);
}

#[test]
fn morphed_vertices_are_those_of_their_targets() {
    let (mut builder, mut worst) = (textured(), Worst::default());
    for weight in [-16_384, 0, 5000, 16_384] {
        builder.weights.clear();
        builder.parts[0].targets.clear();
        add_target(&mut builder);
        builder.weights[0] = weight;
        let container = builder.clone().build();
        let model = Model::from_bytes(container.bytes()).expect("a model");
        let mut memory = vec![0; Pose::words(container.bytes())];
        let pose = model.pose(&mut memory).expect("enough words");
        worst.add(&builder, &pose, &ExactPose::new(&builder, None, None));
    }
    check("position of a vertex that morph targets move", worst.position);
    check("normal of a vertex that morph targets turn", worst.normal);
}

#[test]
fn clips_end_or_begin_anew() {
    let container = animated(true).build();
    let model = Model::from_bytes(container.bytes()).expect("a model");
    let clip = model.clip_named("bend").expect("a clip");
    assert_eq!((clip.name(), clip.duration()), ("bend", 1200));
    assert_eq!(clip.looped(1200), clip.once(0));
    assert_eq!(clip.looped(2500), clip.once(100));
    assert_eq!(clip.once(u32::MAX), clip.once(1200));
    assert_ne!(clip.once(1199), clip.once(1200));
    assert!(model.clip_named("bends").is_none() && model.clip(2).is_none());
    // Words beyond those of the pose are left alone, and fewer are an error.
    let needed = Pose::words(container.bytes());
    let mut memory = vec![7; needed + 5];
    let mut pose = model.pose(&mut memory).expect("enough words");
    pose.play(clip.once(500));
    let _ = pose;
    assert_eq!(memory[needed..], [7; 5]);
    let error = model.pose(&mut memory[1..needed]).expect_err("a word is missing");
    assert_eq!(error.to_string(), format!("{} words for a pose, but the model takes {needed}", needed - 1));
}
