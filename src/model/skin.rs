//! Vertices in, posed vertices out: morph targets move them first, then joints.
//!
//! A joint's matrix takes fractions of the part's cube to fractions of a cube that fits the pose. That cube is known
//! before any vertex is: a posed vertex is a mean of the places to which its joints would bring it, and each of them is
//! in the box that the joint makes of the box around all of its vertices.

use super::container::{Delta, Influence, NONE, Part, Target};
use super::normal::{decode_normal, octahedral};
use super::read::{MATRIX_WORDS, Model, POSED_HEAD, items, vector_words};
use super::transform::{compose, rows};
use crate::math::{mul_wide, unit_vector_of_any_length};

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

/// A matrix for vertices, that of a joint or a mean of several: three rows of m and t. Row · q is Σ m q + 2¹¹ t, in
/// 2⁻¹⁶ of a fraction.
///
/// # Format
/// |m| ≤ 2¹⁶ and |t| < 2²³ for joints that move vertices. The result is below 2³¹ for every vertex that the joint moves,
/// because the cube holds it. So it does not matter that sums wrap.
type Rows = [i32; MATRIX_WORDS];

/// Returns the rows times a vector, without t.
#[inline(always)]
fn direction(rows: &Rows, [x, y, z]: [i32; 3]) -> [i32; 3] {
    let [a, b, c, _, d, e, f, _, g, h, i, _] = rows;
    let sum =
        |a: i32, b: i32, c: i32| a.wrapping_mul(x).wrapping_add(b.wrapping_mul(y)).wrapping_add(c.wrapping_mul(z));
    [sum(*a, *b, *c), sum(*d, *e, *f), sum(*g, *h, *i)]
}

/// Returns the place of a position, rounded.
#[inline(always)]
fn point(rows: &Rows, q: [i32; 3]) -> [i16; 3] {
    let [_, _, _, s, _, _, _, t, _, _, _, u] = rows;
    let [x, y, z] = direction(rows, q);
    let short = |c: i32, t: i32| (c.wrapping_add(t << 11).wrapping_add(1 << 15) >> 16) as i16;
    [short(x, *s), short(y, *t), short(z, *u)]
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
            let Some(node) = node else { continue };
            compose(rows(node), &joint.inverse_bind, words);
            if joint.used == 0 {
                continue;
            }
            for ((row, low), high) in rows(words).iter().zip(&mut low).zip(&mut high) {
                let [entries @ .., t] = row;
                let (mut middle, mut reach) = (i64::from(*t), 0);
                for ((entry, center), half) in entries.iter().zip(&joint.center).zip(&joint.half) {
                    widest |= entry.unsigned_abs();
                    middle += mul_wide(*entry, (*center).into()) >> 15;
                    reach += (mul_wide(*entry, (*half).into()).abs() >> 15) + 2;
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
            let mut normals = normals.iter_mut().zip(from_normals);
            let mut mean = [0; MATRIX_WORDS];
            for (k, ((to, from), influence)) in points.iter_mut().zip(from).zip(influences).enumerate() {
                let rows = self.rows_of(influence, &mut mean);
                let still = targets.is_empty();
                *to = point(rows, if still { from.map(i32::from) } else { morph.point(k, *from) });
                if let Some((to, from)) = normals.next() {
                    // Below 2⁹ each, so that sums are below 2²⁷.
                    let normal = if still { octahedral(*from) } else { morph.normal(k, *from).map(|c| c >> 6) };
                    *to = unit(direction(rows, normal));
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
        let rest = self.words.get(MATRIX_WORDS * usize::from(joint)..);
        rest.and_then(|rest| rest.first_chunk::<MATRIX_WORDS>()).map_or(&[0; MATRIX_WORDS], bytemuck::cast_ref)
    }

    /// Returns the matrix of a vertex: that of its joint, or the mean of those of its joints, which is put into `mean`.
    #[inline(always)]
    fn rows_of<'r>(&'r self, influence: &Influence, mean: &'r mut Rows) -> &'r Rows {
        let [first, ..] = influence.joints;
        if influence.weights == [0; 3] {
            return self.rows(first);
        }
        self.blend(influence, mean);
        mean
    }

    /// Computes the mean of the matrices of a vertex's joints.
    ///
    /// # Format
    /// Entries are at most 2²³, and weights are 256ths: products are at most 2³¹. Sums wrap only if the boxes of joints
    /// do not hold their vertices. Entries are rounded.
    #[inline(never)]
    fn blend(&self, influence: &Influence, mean: &mut Rows) {
        let ([a, b, c, d], [second, third, fourth]) =
            (influence.joints.map(|joint| self.rows(joint)), influence.weights);
        let first = influence.weights.iter().fold(256, |left, weight| left - i32::from(*weight));
        let part = |rows: &Rows, weight: i32, k: usize| rows.get(k).map_or(0, |entry| entry.wrapping_mul(weight));
        let two = |k: usize| part(a, first, k).wrapping_add(part(b, second.into(), k)).wrapping_add(1 << 7);
        // Most vertices that follow several joints follow two.
        if third == 0 {
            for (k, to) in mean.iter_mut().enumerate() {
                *to = two(k) >> 8;
            }
            return;
        }
        for (k, to) in mean.iter_mut().enumerate() {
            *to = two(k).wrapping_add(part(c, third.into(), k)).wrapping_add(part(d, fourth.into(), k)) >> 8;
        }
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

    /// Makes [`Rows`] from the rows of a matrix.
    fn fit(&self, words: &mut [u32; MATRIX_WORDS]) {
        for (row, center) in words.chunks_exact_mut(4).zip(self.center) {
            if let [x, y, z, t] = row {
                for entry in [x, y, z] {
                    // 2¹⁶ of the entry / 2^log_scale, rounded.
                    *entry = ((((i64::from(*entry as i32) << 17) >> self.log_scale) + 1) >> 1) as u32;
                }
                // 2⁵ fractions of 2¹⁵.
                let moved = i64::from(*t as i32) - i64::from(center);
                *t = ((((moved << 21) >> self.log_scale) + 1) >> 1) as u32;
            }
        }
    }
}

/// Returns words as matrices.
fn matrices(words: &mut [u32]) -> &mut [[u32; MATRIX_WORDS]] {
    let whole = words.len() / MATRIX_WORDS * MATRIX_WORDS;
    let (words, _) = words.split_at_mut_checked(whole).unwrap_or_default();
    bytemuck::try_cast_slice_mut(words).unwrap_or_default()
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

    /// Returns a normal that the targets move, 2.14, of any length; each component is below 2.
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
