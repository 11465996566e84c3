//! Vertices as a whole: their bits, and lists of some of them.

use crate::model::{Morph, Vertices};

impl Vertices {
    /// Returns how many vertices there are.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Returns the vertices of these numbers, in this order.
    pub(crate) fn select(&self, numbers: &[u32]) -> Self {
        fn pick<T: Copy>(list: &[T], numbers: &[u32]) -> Vec<T> {
            if list.is_empty() { Vec::new() } else { numbers.iter().map(|n| list[*n as usize]).collect() }
        }
        let morph = |morph: &Morph| Morph {
            positions: pick(&morph.positions, numbers),
            normals: pick(&morph.normals, numbers),
        };
        Self {
            positions: pick(&self.positions, numbers),
            normals: pick(&self.normals, numbers),
            uvs: pick(&self.uvs, numbers),
            colors: pick(&self.colors, numbers),
            joints: pick(&self.joints, numbers),
            weights: pick(&self.weights, numbers),
            morphs: self.morphs.iter().map(morph).collect(),
        }
    }

    /// The bits that decide how a vertex moves: joints, weights, morph targets, but not its position.
    pub(crate) fn motion_bits(&self, n: usize) -> impl Iterator<Item = u32> {
        let joints = self.joints.get(n).into_iter().flatten().map(|joint| u32::from(*joint));
        let weights = self.weights.get(n).into_iter().flatten().map(|weight| bits(*weight));
        let morphs = self.morphs.iter().filter_map(move |morph| morph.positions.get(n)).flatten();
        joints.chain(weights).chain(morphs.map(|x| bits(*x)))
    }

    /// The bits of all attributes of a vertex.
    pub(crate) fn bits(&self, n: usize) -> impl Iterator<Item = u32> {
        let normals = self.morphs.iter().filter_map(move |morph| morph.normals.get(n)).flatten();
        let look = self.normals.get(n).into_iter().flatten();
        let look = look.chain(self.uvs.get(n).into_iter().flatten());
        let look = look.chain(self.colors.get(n).into_iter().flatten()).chain(normals);
        self.position_bits(n).chain(self.motion_bits(n)).chain(look.map(|x| bits(*x)))
    }

    /// The bits of a vertex's position.
    pub(crate) fn position_bits(&self, n: usize) -> impl Iterator<Item = u32> {
        self.positions[n].into_iter().map(bits)
    }
}

/// The bits of a number, where 0 and -0 are one.
fn bits(x: f32) -> u32 {
    (x + 0.0).to_bits()
}
