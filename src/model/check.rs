//! Checks a model: every number that the frame path relies on, once.

use super::container::{AlphaMode, Channel, Interpolation, NONE, NONE_LONG, Part, Path, SectionKind, TextureFormat};
use super::error::ModelError;
use super::range::{below, exactly, in_range, number_or_none, within};
use super::read::{MATRIX_WORDS, Model, items};
use crate::mesh::Mesh;

impl Model<'_> {
    /// Returns the first mistake.
    pub(super) fn check(&self) -> Result<(), ModelError> {
        let [x, y, z] = self.header.half;
        in_range(None, 0, "half", x.min(y).min(z).into(), 0..=i64::from(i32::MAX))?;
        // Others add the number of weights to numbers of their own.
        in_range(None, 0, "weights", self.header.weights.into(), 0..=0xFFFF)?;
        let (first, count) = (self.header.rest_weights, self.header.weights.into());
        within(None, 0, "rest_weights", first, count, self.keys.len())?;
        self.check_nodes()?;
        self.check_materials()?;
        self.check_skins()?;
        let pose_words = self.check_parts()?;
        self.check_clips()?;
        in_range(None, 0, "pose_words", self.header.pose_words.into(), exactly(pose_words))
    }

    fn check_nodes(&self) -> Result<(), ModelError> {
        let mut draws = 0;
        for (k, node) in self.nodes.iter().enumerate() {
            let kind = Some(SectionKind::Nodes);
            number_or_none(kind, k, "parent", node.parent, 0..=k as i64 - 1)?;
            within(kind, k, "first_part", node.first_part.into(), node.parts.into(), self.parts.len())?;
            within(kind, k, "name", node.name, node.name_length.into(), self.bytes.len())?;
            draws += i64::from(node.parts);
        }
        in_range(None, 0, "number of nodes", self.nodes.len() as i64, 0..=i64::from(NONE))?;
        in_range(None, 0, "draws", self.header.draws.into(), exactly(draws as u64))?;
        in_range(None, 0, "draws", draws, 0..=0xFFFF)
    }

    fn check_materials(&self) -> Result<(), ModelError> {
        for (k, material) in self.materials.iter().enumerate() {
            let kind = Some(SectionKind::Materials);
            number_or_none(kind, k, "texture", material.texture, below(self.textures.len()))?;
            if AlphaMode::of(material.alpha_mode).is_none() {
                in_range(kind, k, "alpha_mode", material.alpha_mode.into(), 0..=2)?;
            }
        }
        for (k, texture) in self.textures.iter().enumerate() {
            let kind = Some(SectionKind::Textures);
            let least = texture.width.min(texture.height);
            in_range(kind, k, "the smaller side", least.into(), 1..=0xFFFF)?;
            in_range(kind, k, "levels", texture.levels.into(), 1..=16)?;
            let Some(format) = TextureFormat::of(texture.format) else {
                return in_range(kind, k, "format", texture.format.into(), 0..=6);
            };
            if format == TextureFormat::Rgb565 {
                in_range(kind, k, "texels modulo 2", (texture.texels & 1).into(), 0..=0)?;
            }
            let past = |format| texture.bytes_before(format, texture.levels);
            within(kind, k, "texels", texture.texels, past(format), self.bytes.len())?;
            within(kind, k, "palette", texture.palette, 3 * u64::from(texture.colors), self.bytes.len())?;
            if texture.alpha != NONE_LONG {
                within(kind, k, "alpha", texture.alpha, past(TextureFormat::Palette4), self.bytes.len())?;
            }
        }
        Ok(())
    }

    fn check_skins(&self) -> Result<(), ModelError> {
        let mut first = 0;
        for (k, skin) in self.skins.iter().enumerate() {
            let kind = Some(SectionKind::Skins);
            in_range(kind, k, "first_joint", skin.first_joint.into(), exactly(first))?;
            in_range(kind, k, "joints", skin.joints.into(), 1..=256)?;
            first += u64::from(skin.joints);
        }
        in_range(None, 0, "number of joints", self.joints.len() as i64, exactly(first))?;
        for (k, joint) in self.joints.iter().enumerate() {
            in_range(Some(SectionKind::Joints), k, "node", joint.node.into(), below(self.nodes.len()))?;
        }
        Ok(())
    }

    /// Checks parts, and returns the number of words of a pose.
    ///
    /// # Format
    /// Sums of numbers of at most 32 bits, each of an item that is there: below 2⁶⁴.
    fn check_parts(&self) -> Result<u64, ModelError> {
        let mut words = self.words_before_parts();
        // Where the next part begins: vertices, indices, clusters, targets, deltas.
        let [mut vertex, mut index, mut cluster, mut target, mut delta] = [0_u64; 5];
        in_range(None, 0, "number of parts", self.parts.len() as i64, 0..=i64::from(NONE))?;
        for (k, part) in self.parts.iter().enumerate() {
            let kind = Some(SectionKind::Parts);
            in_range(kind, k, "vertices", part.vertices.into(), 0..=0xFFFF)?;
            in_range(kind, k, "triangles", part.triangles.into(), 0..=0xFFFF)?;
            in_range(kind, k, "first_vertex", part.first_vertex.into(), exactly(vertex))?;
            in_range(kind, k, "first_index", part.first_index.into(), exactly(index))?;
            in_range(kind, k, "first_cluster", part.first_cluster.into(), exactly(cluster))?;
            in_range(kind, k, "first_target", part.first_target.into(), exactly(target))?;
            let vertices = u64::from(part.vertices);
            vertex += vertices;
            index += 3 * u64::from(part.triangles);
            cluster += u64::from(part.clusters);
            target += u64::from(part.targets);
            within(kind, k, "first_vertex", part.first_vertex, vertices, self.points.len())?;
            within(kind, k, "first_index", part.first_index, 3 * u64::from(part.triangles), self.indices.len())?;
            within(kind, k, "first_cluster", part.first_cluster, part.clusters.into(), self.clusters.len())?;
            within(kind, k, "first_target", part.first_target, part.targets.into(), self.targets.len())?;
            in_range(kind, k, "material", part.material.into(), below(self.materials.len()))?;
            in_range(kind, k, "uv_shift", part.uv_shift.into(), 0..=15)?;
            if part.uv_bits != 8 {
                in_range(kind, k, "uv_bits", part.uv_bits.into(), 16..=16)?;
            }
            let uvs = if part.uv_bits == 8 { self.small_uvs.len() } else { self.uvs.len() };
            for (field, first, length) in [
                ("first_normal", part.first_normal, self.normals.len()),
                ("first_color", part.first_color, self.colors.len()),
                ("first_uv", part.first_uv, uvs),
            ] {
                if first != NONE_LONG {
                    within(kind, k, field, first, vertices, length)?;
                }
            }
            number_or_none(kind, k, "coarser", part.coarser, k as i64 + 1..=self.parts.len() as i64 - 1)?;
            within(kind, k, "first_weight", part.first_weight, part.targets.into(), self.header.weights as usize)?;
            let pose = if part.is_posed() { words } else { NONE_LONG.into() };
            in_range(kind, k, "pose", part.pose.into(), exactly(pose))?;
            if part.is_posed() {
                words += part.posed_words() as u64;
                in_range(kind, k, "clusters", part.clusters.into(), 0..=0)?;
                in_range(kind, k, "coarser", part.coarser.into(), exactly(NONE.into()))?;
            }
            Mesh::new(self.mesh_data(part)).map_err(|error| ModelError::Mesh { part: k, error })?;
            self.check_clusters(k, part)?;
            self.check_influences(k, part)?;
            for (n, item) in items(self.targets, part.first_target, part.targets.into()).iter().enumerate() {
                let (kind, n) = (Some(SectionKind::Targets), part.first_target as usize + n);
                in_range(kind, n, "first_delta", item.first_delta.into(), exactly(delta))?;
                delta += u64::from(item.vertices);
                within(kind, n, "first_delta", item.first_delta, item.vertices.into(), self.deltas.len())?;
                let (first, moved) = (item.first_vertex.into(), item.vertices.into());
                within(kind, n, "first_vertex", first, moved, part.vertices as usize)?;
            }
        }
        Ok(words)
    }

    fn check_clusters(&self, number: usize, part: &Part) -> Result<(), ModelError> {
        let (clusters, mut expected) = (self.clusters_of(part), 0);
        for (k, cluster) in clusters.iter().enumerate() {
            let k = part.first_cluster as usize + k;
            let kind = Some(SectionKind::Clusters);
            in_range(kind, k, "first_triangle", cluster.first_triangle.into(), exactly(expected))?;
            in_range(kind, k, "triangles", cluster.triangles.into(), 1..=0xFFFF)?;
            let (first, count) = (cluster.first_triangle.into(), cluster.triangles.into());
            within(kind, k, "first_triangle", first, count, part.triangles as usize)?;
            expected += u64::from(cluster.triangles);
            let first = part.first_index.saturating_add(3 * u32::from(cluster.first_triangle));
            for index in items(self.indices, first, 3 * usize::from(cluster.triangles)) {
                let vertex = usize::from(*index);
                if !self.holds(&cluster.center, &cluster.half, part, vertex) {
                    return Err(ModelError::Outside { section: SectionKind::Clusters, item: k, part: number, vertex });
                }
            }
        }
        if clusters.is_empty() {
            return Ok(());
        }
        let all = exactly(part.triangles.into());
        in_range(Some(SectionKind::Parts), number, "triangles in clusters", expected as i64, all)
    }

    fn check_influences(&self, number: usize, part: &Part) -> Result<(), ModelError> {
        if part.skin == NONE {
            return Ok(());
        }
        let kind = Some(SectionKind::Parts);
        in_range(kind, number, "skin", part.skin.into(), below(self.skins.len()))?;
        let (first, vertices) = (part.first_influence, part.vertices);
        within(kind, number, "first_influence", first, vertices.into(), self.influences.len())?;
        let (joints, first_joint) = self.joints_of(part);
        for (vertex, influence) in items(self.influences, first, vertices as usize).iter().enumerate() {
            let kind = Some(SectionKind::Influences);
            let item = first as usize + vertex;
            let [b, c, d] = influence.weights.map(i64::from);
            // The weights fall, and the first one, which is what is left, is not below the second one.
            in_range(kind, item, "second weight", b, 0..=128)?;
            in_range(kind, item, "third weight", c, 0..=b.min(256 - 2 * b))?;
            in_range(kind, item, "fourth weight", d, 0..=c.min(256 - 2 * b - c))?;
            for (joint, weight) in influence.joints.iter().zip([1, b, c, d]) {
                if weight == 0 {
                    continue;
                }
                in_range(kind, item, "joint", (*joint).into(), below(joints.len()))?;
                let Some(joint_of) = joints.get(usize::from(*joint)) else { continue };
                let k = first_joint + usize::from(*joint);
                in_range(Some(SectionKind::Joints), k, "used", joint_of.used.into(), 1..=1)?;
                // Morph targets move a vertex before its joints do, so the box cannot be checked against them here.
                if part.targets == 0 && !self.holds(&joint_of.center, &joint_of.half, part, vertex) {
                    return Err(ModelError::Outside { section: SectionKind::Joints, item: k, part: number, vertex });
                }
            }
        }
        Ok(())
    }

    fn check_clips(&self) -> Result<(), ModelError> {
        let mut first = 0;
        for (k, line) in self.timelines.iter().enumerate() {
            let kind = Some(SectionKind::Timelines);
            in_range(kind, k, "first_time", line.first_time.into(), exactly(first))?;
            in_range(kind, k, "times", line.times.into(), 1..=0x1_0000)?;
            first += u64::from(line.times);
            within(kind, k, "first_time", line.first_time, line.times.into(), self.times.len())?;
            let times = items(self.times, line.first_time, line.times as usize);
            for (n, pair) in times.windows(2).enumerate() {
                if let [a, b] = pair {
                    let item = line.first_time as usize + n + 1;
                    in_range(Some(SectionKind::Times), item, "time", (*b).into(), i64::from(*a) + 1..=0xFFFF)?;
                }
            }
        }
        let mut first = 0;
        for (k, clip) in self.clips.iter().enumerate() {
            let kind = Some(SectionKind::Clips);
            in_range(kind, k, "first_channel", clip.first_channel.into(), exactly(first))?;
            first += u64::from(clip.channels);
            within(kind, k, "first_channel", clip.first_channel, clip.channels.into(), self.channels.len())?;
            in_range(kind, k, "duration", clip.duration.into(), 1..=i64::from(u32::MAX))?;
            within(kind, k, "name", clip.name, clip.name_length.into(), self.bytes.len())?;
            let [x, y, z] = clip.half;
            in_range(kind, k, "half", x.min(y).min(z).into(), 0..=i64::from(i32::MAX))?;
            let channels = items(self.channels, clip.first_channel, clip.channels as usize);
            let mut before = Some(0);
            for (n, channel) in channels.iter().enumerate() {
                before = self.check_channel(clip.first_channel as usize + n, channel, before)?;
            }
        }
        Ok(())
    }

    /// Checks a channel after one that moves the node `before`, or after one of weights if that is `None`. Returns the
    /// node that the channel moves itself; `None` for weights.
    fn check_channel(&self, number: usize, channel: &Channel, before: Option<u16>) -> Result<Option<u16>, ModelError> {
        let kind = Some(SectionKind::Channels);
        let path = in_range(kind, number, "path", channel.path.into(), 0..=3).map(|()| Path::of(channel.path))?;
        in_range(kind, number, "interpolation", channel.interpolation.into(), 0..=2)?;
        in_range(kind, number, "timeline", channel.timeline.into(), below(self.timelines.len()))?;
        let values = Interpolation::of(channel.interpolation).map_or(0, Interpolation::values);
        let (numbers, weights) = match path {
            Some(Path::Weights) => (u64::from(channel.weights), channel.weights),
            Some(Path::Rotation) => (4, 0),
            _ => (3, 0),
        };
        in_range(kind, number, "weights", channel.weights.into(), exactly(weights.into()))?;
        let node = match (path, before) {
            // Weights stand in any order.
            (Some(Path::Weights), _) => {
                let all = self.header.weights as usize;
                within(kind, number, "target", channel.target.into(), weights.into(), all)?;
                None
            }
            // After weights, there are weights only.
            (_, None) => return in_range(kind, number, "path", channel.path.into(), 3..=3).map(|()| None),
            (_, Some(before)) => {
                let nodes = i64::from(before)..=self.nodes.len() as i64 - 1;
                in_range(kind, number, "target", channel.target.into(), nodes)?;
                Some(channel.target)
            }
        };
        let keys = self.timelines.get(channel.timeline as usize).map_or(0, |line| u64::from(line.times));
        within(kind, number, "first_key", channel.first_key, keys * numbers * values as u64, self.keys.len())?;
        Ok(node)
    }

    /// Returns the number of words of a pose before those of posed parts: below 2²², as weights are below 2¹⁶.
    fn words_before_parts(&self) -> u64 {
        let most = self.skins.iter().map(|skin| skin.joints as usize).max().unwrap_or(0);
        (MATRIX_WORDS * (self.nodes.len() + most) + self.header.weights as usize) as u64
    }

    /// Returns whether a box holds a vertex of a part.
    fn holds(&self, center: &[i16; 3], half: &[u16; 3], part: &Part, vertex: usize) -> bool {
        let points = items(self.points, part.first_vertex, part.vertices as usize);
        let Some(point) = points.get(vertex) else { return false };
        point.iter().zip(center).zip(half).all(|((p, c), h)| p.abs_diff(*c) <= *h)
    }
}
