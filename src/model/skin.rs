//! Vertices in, posed vertices out: morph targets move them first, then joints.
//!
//! A joint's matrix takes fractions of the part's cube to fractions of a cube that fits the pose. That cube is known
//! before any vertex is: a posed vertex is a mean of the places to which its joints would bring it, and each of them is
//! in the box that the joint makes of the box around all of its vertices.

use super::container::{Delta, Influence, NONE, Part, Target};
use super::normal::{decode_normal, octahedral};
use super::read::{MATRIX_WORDS, Model, POSED_HEAD, items, vector_words};
use super::transform::{from_words, to_words};
use crate::math::{Affine, Vec3, unit_vector_of_any_length};

/// The joints of a skin in the memory of a pose, and the cube of the posed vertices.
pub(super) struct Joints<'w> {
    words: &'w mut [u32],
    /// The skin that the words are for.
    skin: u16,
    cube: Cube,
}

/// A cube that posed vertices are quantized in, and the box around them, 16.16.
#[derive(Clone, Copy, Default)]
struct Cube {
    /// The distance that the fraction 32,768 stands for: 2^`log_scale`.
    log_scale: u32,
    center: [i32; 3],
    half: [i32; 3],
}

/// A joint's matrix for vertices: three rows of m and t. Row · q is Σ m q + t, in 2⁻¹⁶ of a fraction.
///
/// # Format
/// |m| ≤ 2¹⁶. The result is below 2³¹ for every vertex that the joint moves, because the cube holds it. So it does not
/// matter that t and the sums wrap.
type Rows = [u32; MATRIX_WORDS];

/// Returns the rows times a vector.
#[inline(always)]
fn point(rows: &Rows, [x, y, z]: [i32; 3]) -> [i32; 3] {
    let [a, b, c, s, d, e, f, t, g, h, i, u] = *rows;
    let sum = |m: [u32; 3], t: u32| {
        let [a, b, c] = m.map(|m| m as i32);
        a.wrapping_mul(x).wrapping_add(b.wrapping_mul(y)).wrapping_add(c.wrapping_mul(z)).wrapping_add(t as i32)
    };
    [sum([a, b, c], s), sum([d, e, f], t), sum([g, h, i], u)]
}

/// Returns the matrix times a direction whose components are below 2¹⁰: the result is below 2²⁸.
#[inline(always)]
fn direction(rows: &Rows, v: [i32; 3]) -> [i32; 3] {
    let [a, b, c, _, d, e, f, _, g, h, i, _] = *rows;
    point(&[a, b, c, 0, d, e, f, 0, g, h, i, 0], v)
}

impl Joints<'_> {
    pub(super) const fn new(words: &mut [u32]) -> Joints<'_> {
        Joints { words, skin: NONE, cube: Cube { log_scale: 0, center: [0; 3], half: [0; 3] } }
    }

    /// Makes the matrices of a part's skin from the transforms of nodes, unless they are there already.
    pub(super) fn set(&mut self, model: &Model<'_>, part: &Part, nodes: &[u32]) {
        if self.skin == part.skin {
            return;
        }
        self.skin = part.skin;
        let (joints, _) = model.joints_of(part);
        // The matrices, the box around what they make of the boxes of joints, and the largest entry.
        let (mut low, mut high, mut widest) = ([i64::MAX; 3], [i64::MIN; 3], 0);
        for (joint, words) in joints.iter().zip(matrices(self.words)) {
            let node = nodes.get(MATRIX_WORDS * usize::from(joint.node)..).and_then(|rest| rest.first_chunk());
            let transform = node.map_or(Affine::IDENTITY, from_words);
            let [x, y, z] = joint.inverse_bind.map(|[x, y, z, _]| Vec3::from_bits([x, y, z]));
            let bind = joint.inverse_bind.map(|[.., t]| t);
            let matrix = transform * Affine::from_rows(x, y, z, Vec3::from_bits(bind));
            to_words(&matrix, words);
            if joint.used == 0 {
                continue;
            }
            for ((row, low), high) in matrix.to_rows().iter().zip(&mut low).zip(&mut high) {
                let [entries @ .., t] = row;
                let (mut middle, mut reach) = (i64::from(*t), 0);
                for ((entry, center), half) in entries.iter().zip(&joint.center).zip(&joint.half) {
                    widest |= entry.unsigned_abs();
                    middle += (i64::from(*entry) * i64::from(*center)) >> 15;
                    reach += ((i64::from(entry.unsigned_abs()) * i64::from(*half)) >> 15) + 2;
                }
                (*low, *high) = ((*low).min(middle - reach), (*high).max(middle + reach));
            }
        }
        self.cube = Cube::around(low, high, widest);
        for words in matrices(self.words).iter_mut().take(joints.len()) {
            self.cube.fit(words);
        }
    }

    /// Poses the vertices of a part into words: by joints, if it has a skin, after morph targets.
    pub(super) fn pose(&self, model: &Model<'_>, part: &Part, weights: &[u32], words: &mut [u32]) {
        let vertices = part.vertices as usize;
        let Some((head, rest)) = words.split_first_chunk_mut::<POSED_HEAD>() else { return };
        let Some((points, normals)) = rest.split_at_mut_checked(vector_words(vertices)) else { return };
        let (points, normals) = (vectors_mut(points, vertices), vectors_mut(normals, vertices));
        let from = items(model.points, part.first_vertex, vertices);
        let from_normals = items(model.normals, part.first_normal, vertices);
        let influences = items(model.influences, part.first_influence, vertices);
        let targets = items(model.targets, part.first_target, part.targets.into());
        let morph = Morph { targets, weights, deltas: model.deltas };
        let cube = if part.skin == NONE {
            for (k, (to, from)) in points.iter_mut().zip(from).enumerate() {
                let [x, y, z] = morph.point(k, *from);
                *to = [x as i16, y as i16, z as i16];
            }
            for (k, (to, from)) in normals.iter_mut().zip(from_normals).enumerate() {
                *to = unit(morph.normal(k, *from));
            }
            box_around(part, points)
        } else {
            if targets.is_empty() {
                for ((to, from), influence) in points.iter_mut().zip(from).zip(influences) {
                    *to = self.skinned(influence, from.map(i32::from));
                }
                for ((to, from), influence) in normals.iter_mut().zip(from_normals).zip(influences) {
                    *to = self.turned(influence, octahedral(*from));
                }
            } else {
                for (k, ((to, from), influence)) in points.iter_mut().zip(from).zip(influences).enumerate() {
                    *to = self.skinned(influence, morph.point(k, *from));
                }
                for (k, ((to, from), influence)) in normals.iter_mut().zip(from_normals).zip(influences).enumerate() {
                    // Ten bits, with the sign.
                    *to = self.turned(influence, morph.normal(k, *from).map(|c| (c >> 6).clamp(-511, 511)));
                }
            }
            (1 << self.cube.log_scale, self.cube.center, self.cube.center, self.cube.half)
        };
        let (scale, [x, y, z], [a, b, c], [d, e, f]) = cube;
        *head = [scale, x, y, z, a, b, c, d, e, f].map(|word| word as u32);
    }

    /// Returns the matrix of a joint.
    #[inline(always)]
    fn rows(&self, joint: u8) -> &Rows {
        let words = self.words.get(MATRIX_WORDS * usize::from(joint)..).and_then(|rest| rest.first_chunk());
        words.unwrap_or(&[0; MATRIX_WORDS])
    }

    /// Returns the position of a vertex that its joints move.
    ///
    /// # Format
    /// Of each joint, 2⁻⁸ of a fraction count: the sum of their products with weights that sum up to 256 is below 2³¹.
    #[inline(always)]
    fn skinned(&self, influence: &Influence, from: [i32; 3]) -> [i16; 3] {
        let [first, others @ ..] = influence.joints;
        let mut sum = point(self.rows(first), from);
        if influence.weights[0] != 0 {
            self.blend(&mut sum, 8, others, influence.weights, |rows| point(rows, from));
        }
        // Rounded; within 16 bits by the cube.
        let [x, y, z] = sum;
        let short = |c: i32| (c.wrapping_add(1 << 15) >> 16) as i16;
        [short(x), short(y), short(z)]
    }

    /// Returns the unit normal, 2.14, of a vertex that its joints turn, from one of any length below 2¹⁰.
    #[inline(always)]
    fn turned(&self, influence: &Influence, from: [i32; 3]) -> [i16; 3] {
        let [first, others @ ..] = influence.joints;
        let mut sum = direction(self.rows(first), from);
        if influence.weights[0] != 0 {
            self.blend(&mut sum, 5, others, influence.weights, |rows| direction(rows, from));
        }
        unit(sum)
    }

    /// Replaces what the first joint makes of a vector by the mean of what all joints make of it. `cut` bits of it are
    /// lost, so that products with weights of 256ths fit.
    #[inline(never)]
    fn blend(&self, sum: &mut [i32; 3], cut: u32, joints: [u8; 3], weights: [u8; 3], make: impl Fn(&Rows) -> [i32; 3]) {
        let left = weights.iter().fold(256, |left, weight| left - i32::from(*weight));
        // Below 2³¹ by the cube; bad boxes of joints make them wrap.
        let mut all = sum.map(|c| (c >> cut).wrapping_mul(left));
        for (joint, weight) in joints.into_iter().zip(weights) {
            if weight == 0 {
                break;
            }
            for (all, c) in all.iter_mut().zip(make(self.rows(joint))) {
                *all = all.wrapping_add((c >> cut).wrapping_mul(weight.into()));
            }
        }
        *sum = all.map(|c| (c >> 8) << cut);
    }
}

impl Cube {
    /// Returns a cube that holds a box, and whose matrices have no entry above 1.
    ///
    /// # Format
    /// The cube is larger than the box by 1/1,024 and some, so that rounding stays inside. It is at most 2¹⁴ units
    /// wide to each side.
    fn around(low: [i64; 3], high: [i64; 3], widest: u32) -> Self {
        let mut cube = Self::default();
        let mut reach = i64::from(widest).max(1 << 4);
        for (((low, high), center), half) in low.iter().zip(&high).zip(&mut cube.center).zip(&mut cube.half) {
            if low > high {
                continue;
            }
            let middle = ((low + high) >> 1).clamp(i32::MIN.into(), i32::MAX.into());
            *center = middle as i32;
            let most = (high - middle).max(middle - low);
            *half = most.clamp(0, i32::MAX.into()) as i32;
            reach = reach.max(most + (most >> 10) + 4);
        }
        // The next power of two that is not below.
        cube.log_scale = (64 - (reach - 1).leading_zeros()).min(30);
        cube
    }

    /// Makes the rows of [`Rows`] from those of a matrix.
    fn fit(&self, words: &mut Rows) {
        for (row, center) in words.chunks_exact_mut(4).zip(self.center) {
            if let [x, y, z, t] = row {
                for entry in [x, y, z] {
                    // 2¹⁶ of the entry / 2^log_scale, rounded.
                    *entry = ((((i64::from(*entry as i32) << 17) >> self.log_scale) + 1) >> 1) as u32;
                }
                *t = (*t as i32).wrapping_sub(center).wrapping_shl(31 - self.log_scale) as u32;
            }
        }
    }
}

/// Returns words as matrices.
fn matrices(words: &mut [u32]) -> &mut [Rows] {
    let whole = words.len() / MATRIX_WORDS * MATRIX_WORDS;
    bytemuck::try_cast_slice_mut(words.get_mut(..whole).unwrap_or_default()).unwrap_or_default()
}

/// Morph targets and their weights.
struct Morph<'m> {
    targets: &'m [Target],
    weights: &'m [u32],
    deltas: &'m [Delta],
}

impl Morph<'_> {
    /// Calls `add` with the weight and the delta of each target that moves a vertex.
    #[inline(always)]
    fn each(&self, vertex: usize, mut add: impl FnMut(i32, &Delta)) {
        for (target, weight) in self.targets.iter().zip(self.weights) {
            let place = vertex.wrapping_sub(target.first_vertex.into());
            if *weight == 0 || place >= usize::from(target.vertices) {
                continue;
            }
            if let Some(delta) = self.deltas.get(target.first_delta as usize + place) {
                add(*weight as i32, delta);
            }
        }
    }

    /// Returns a position that the targets move, saturated at the part's cube.
    ///
    /// # Format
    /// Weights and deltas have 15 bits and a sign. Each product is cut to halves of a fraction, at most 2¹⁷. Sums of
    /// more than 16,384 such products wrap.
    #[inline(never)]
    fn point(&self, vertex: usize, from: [i16; 3]) -> [i32; 3] {
        let mut sum = from.map(|c| i32::from(c) << 1);
        self.each(vertex, |weight, delta| {
            for (sum, d) in sum.iter_mut().zip(delta.point) {
                *sum = sum.wrapping_add((weight * i32::from(d)) >> 13);
            }
        });
        sum.map(|c| (c.wrapping_add(1) >> 1).clamp(i16::MIN.into(), i16::MAX.into()))
    }

    /// Returns a normal that the targets move, 2.14, of any length up to 2.
    #[inline(never)]
    fn normal(&self, vertex: usize, from: [i8; 2]) -> [i32; 3] {
        let mut sum = decode_normal(from).map(i32::from);
        self.each(vertex, |weight, delta| {
            for (sum, d) in sum.iter_mut().zip(delta.normal) {
                *sum = sum.wrapping_add((weight * i32::from(d)) >> 6);
            }
        });
        sum.map(|c| c.clamp(-0x7FFF, 0x7FFF))
    }
}

/// Returns the unit vector, 2.14, in a direction.
#[inline(always)]
fn unit(v: [i32; 3]) -> [i16; 3] {
    let [x, y, z] = unit_vector_of_any_length(v);
    [x as i16, y as i16, z as i16]
}

/// Returns scale, offset, middle and half size for points of a part in its own cube.
fn box_around(part: &Part, points: &[[i16; 3]]) -> (i32, [i32; 3], [i32; 3], [i32; 3]) {
    let Some(first) = points.first() else { return (part.scale, part.offset, part.offset, [0; 3]) };
    let (mut low, mut high) = (*first, *first);
    for point in points {
        for ((c, low), high) in point.iter().zip(&mut low).zip(&mut high) {
            (*low, *high) = ((*low).min(*c), (*high).max(*c));
        }
    }
    let (mut center, mut half) = (part.offset, [0; 3]);
    for ((low, high), (center, half)) in low.iter().zip(high).zip(center.iter_mut().zip(&mut half)) {
        let at = |q: i16| (i64::from(q) * i64::from(part.scale)) >> 15;
        let (from, to) = (at(*low), at(high) + 1);
        let middle = (from + to) >> 1;
        *center = (i64::from(*center) + middle).clamp(i32::MIN.into(), i32::MAX.into()) as i32;
        *half = (to - middle + 1).clamp(0, i32::MAX.into()) as i32;
    }
    (part.scale, part.offset, center, half)
}

/// Returns words as vectors of three numbers of 16 bits; none if there are too few words.
fn vectors_mut(words: &mut [u32], count: usize) -> &mut [[i16; 3]] {
    let halves: &mut [i16] = bytemuck::try_cast_slice_mut(words).unwrap_or_default();
    let halves = halves.get_mut(..3 * count).unwrap_or_default();
    bytemuck::try_cast_slice_mut(halves).unwrap_or_default()
}
