//! A pose: the transforms of all nodes, and the vertices that joints and morph targets move, in memory that the caller
//! lends.
//!
//! ```text
//! | transforms of nodes | weights | transforms of joints | posed part: box, positions, normals | next posed part ...
//! ```
//!
//! Vertices are posed once per frame and kept as quantized positions. A shader that moves vertices would be asked for
//! each of them twice in a frame with records, and once per strip and triangle without; and it would take the transform
//! of 64 bits, and no bounds. So the memory saves time in every kind of frame.

use super::camera::Camera;
use super::container::NONE;
use super::error::MemoryError;
use super::keys::{Motion, Track};
use super::place::{Place, Placed};
use super::posed::PosedPart;
use super::read::{MATRIX_WORDS, Model, items, pose_words};
use super::shader::Light;
use super::skin::Joints;
use super::transform::{Local, ONE, compose, from_words, rows, to_words};
use crate::math::{Affine, Scalar};
use crate::mesh::{Mesh, MeshData};

/// A pose of a model.
///
/// ```
/// use zstrip::model::{MemoryError, Model, Pose};
///
/// fn walk(file: &[u8], memory: &mut [u32], milliseconds: u32) -> Result<(), MemoryError> {
///     let Ok(model) = Model::from_bytes(file) else { return Ok(()) };
///     let mut pose = model.pose(memory)?; // Pose::words(file) of them
///     if let Some(clip) = model.clip_named("walk") {
///         pose.play(clip.looped(milliseconds));
///     }
///     Ok(())
/// }
/// ```
#[derive(Debug)]
pub struct Pose<'p> {
    model: Model<'p>,
    words: &'p mut [u32],
}

impl<'a> Model<'a> {
    /// Returns a pose in memory of [`Pose::words`] words, at rest.
    ///
    /// # Errors
    /// If there are fewer words.
    pub fn pose<'p>(&self, memory: &'p mut [u32]) -> Result<Pose<'p>, MemoryError>
    where
        'a: 'p,
    {
        let (found, needed) = (memory.len(), self.header.pose_words as usize);
        let Some((words, _)) = memory.split_at_mut_checked(needed) else {
            return Err(MemoryError::Pose { found, needed });
        };
        let mut pose = Pose { model: *self, words };
        pose.rest();
        Ok(pose)
    }
}

impl Pose<'_> {
    /// Returns the number of words that a pose of the model in these bytes takes: for the size of an array in a
    /// constant. [`Model::from_bytes`] checks it.
    #[must_use]
    pub const fn words(bytes: &[u8]) -> usize {
        pose_words(bytes)
    }

    /// Takes the pose at rest.
    pub fn rest(&mut self) {
        self.set(None, None);
    }

    /// Takes the pose of a clip at a time. Nodes that the clip does not move are at rest.
    pub fn play(&mut self, motion: Motion) {
        self.set(Some(motion), None);
    }

    /// Takes a pose between those of two clips: `weight`, from 0 to 1, of the second one.
    pub fn blend(&mut self, from: Motion, to: Motion, weight: Scalar) {
        let weight = weight.to_bits().clamp(0, 1 << 16) >> 2;
        self.set(Some(from), Some((to, weight)));
    }

    /// Returns the transform of a node: for a hat on a head. `None` past the last node.
    #[must_use]
    pub fn node(&self, number: usize) -> Option<Affine> {
        if number >= self.model.nodes.len() {
            return None;
        }
        self.words.get(MATRIX_WORDS * number..)?.first_chunk().map(from_words)
    }

    /// Returns the mesh of a part in this pose, as [`Model::mesh`] does at rest. Normals are those of the pose.
    #[must_use]
    pub fn mesh(&self, part: usize) -> Option<Mesh<'_>> {
        let part = self.model.parts.get(part)?;
        let Some(posed) = PosedPart::of(self.words, part) else { return Some(self.model.mesh_of(part)) };
        let (data, bounds) = (self.model.mesh_data(part), posed.bounds());
        let data = MeshData { positions: posed.positions(), normals: posed.normals(), bounds: Some(bounds), ..data };
        Some(Mesh::of_checked(data, bounds, part.triangles as u16))
    }

    /// Places the pose in a frame, as [`Model::place`] places a model at rest.
    ///
    /// # Errors
    /// If there are fewer places than draws.
    pub fn place<'p, L: Light>(
        &'p self,
        world: &Affine,
        camera: &Camera,
        light: &L,
        places: &'p mut [Option<Place<L::Surface>>],
    ) -> Result<Placed<'p, L::Surface>, MemoryError> {
        self.model.place_pose(self.words, world, camera, light, places)
    }

    fn set(&mut self, from: Option<Motion>, to: Option<(Motion, i32)>) {
        let model = self.model;
        let (nodes, rest) = self.words.split_at_mut_checked(MATRIX_WORDS * model.nodes.len()).unwrap_or_default();
        let mut from = from.map(|motion| Track::new(&model, motion));
        let mut to = to.map(|(motion, weight)| (Track::new(&model, motion), weight));
        set_nodes(&model, nodes, &mut from, &mut to);
        let (weights, rest) = rest.split_at_mut_checked(model.header.weights as usize).unwrap_or_default();
        set_weights(&model, weights, &mut from, &mut to);
        let most = model.skins.iter().map(|skin| skin.joints as usize).max().unwrap_or(0);
        let (joints, mut rest) = rest.split_at_mut_checked(MATRIX_WORDS * most).unwrap_or_default();
        let mut joints = Joints::new(joints);
        for part in model.parts.iter().filter(|part| part.is_posed()) {
            let Some((words, after)) = core::mem::take(&mut rest).split_at_mut_checked(part.posed_words()) else {
                return;
            };
            rest = after;
            let weights = items(weights, part.first_weight, part.targets.into());
            if part.skin != NONE {
                joints.set(&model, part, nodes);
            }
            joints.pose(&model, part, weights, words);
        }
    }
}

fn set_nodes(model: &Model<'_>, words: &mut [u32], from: &mut Option<Track<'_>>, to: &mut Option<(Track<'_>, i32)>) {
    for (number, node) in model.nodes.iter().enumerate() {
        let mut local = Local::of(node);
        let rest = local;
        if let Some(track) = from {
            track.apply(number, &mut local);
        }
        if let Some((track, weight)) = to {
            let mut other = rest;
            track.apply(number, &mut other);
            local = local.mixed(&other, *weight);
        }
        // Those of the parents are before it.
        let Some((before, rest)) = words.split_at_mut_checked(MATRIX_WORDS * number) else { return };
        let Some(to) = rest.first_chunk_mut() else { return };
        let parent = before.get(MATRIX_WORDS * usize::from(node.parent)..).and_then(|rest| rest.first_chunk());
        match parent {
            Some(parent) => compose(rows(parent), &local.matrix().to_rows(), to),
            None => to_words(&local.matrix(), to),
        }
    }
}

fn set_weights(model: &Model<'_>, words: &mut [u32], from: &mut Option<Track<'_>>, to: &mut Option<(Track<'_>, i32)>) {
    let rest = items(model.keys, model.header.rest_weights, words.len());
    for (number, (word, rest)) in words.iter_mut().zip(rest).enumerate() {
        let rest = i32::from(*rest);
        let mut weight = from.as_mut().and_then(|track| track.weight(number)).unwrap_or(rest);
        if let Some((track, factor)) = to {
            let other = track.weight(number).unwrap_or(rest);
            // Weights have 15 bits and a sign.
            weight += ((other - weight) * *factor + ONE / 2) >> 14;
        }
        *word = weight as u32;
    }
}
