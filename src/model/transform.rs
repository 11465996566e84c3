//! Transforms of nodes: translation, rotation and scale, and the matrices that they make.

use super::container::Node;
use crate::math::{Affine, Vec3, inverse_sqrt, leading_zeros, mul_high_signed, mul_wide, reciprocal};

/// A node's own transform: scale, then rotation, then translation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Local {
    /// 16.16.
    pub(super) translation: [i32; 3],
    /// A quaternion x, y, z, w, each within ±32,767.
    pub(super) rotation: [i32; 4],
    /// 16.16.
    pub(super) scale: [i32; 3],
}

/// The number 1 of factors, weights between values, and cosines: 2.14.
pub(super) const ONE: i32 = 1 << 14;

impl Local {
    /// Returns the transform of a node at rest.
    pub(super) fn of(node: &Node) -> Self {
        let [x, y, z, w] = node.rotation;
        let rotation = [clamped(x.into()), clamped(y.into()), clamped(z.into()), clamped(w.into())];
        Self { translation: node.translation, rotation, scale: node.scale }
    }

    /// Returns the transform between this one and another one, `factor`, in 2.14, of the way.
    pub(super) fn mixed(&self, other: &Self, factor: i32) -> Self {
        let mix = |a: i32, b: i32| {
            let between = ((i64::from(b) - i64::from(a)) * i64::from(factor) + (1 << 13)) >> 14;
            (i64::from(a) + between) as i32
        };
        let vector = |a: &[i32; 3], b: &[i32; 3]| [mix(a[0], b[0]), mix(a[1], b[1]), mix(a[2], b[2])];
        Self {
            translation: vector(&self.translation, &other.translation),
            rotation: arc(&unit(&self.rotation), &unit(&other.rotation), factor),
            scale: vector(&self.scale, &other.scale),
        }
    }

    /// Returns the matrix of the transform.
    pub(super) fn matrix(&self) -> Affine {
        let mut rows = rotation_rows(&self.rotation);
        if self.scale != [1 << 16; 3] {
            let times = |entry: i32, factor: i32| {
                let product = (mul_wide(entry, factor) + (1 << 15)) >> 16;
                product.clamp(i32::MIN.into(), i32::MAX.into()) as i32
            };
            let [x, y, z] = self.scale;
            rows = rows.map(|[a, b, c]| [times(a, x), times(b, y), times(c, z)]);
        }
        let [x, y, z] = rows;
        Affine::from_rows(Vec3::from_bits(x), Vec3::from_bits(y), Vec3::from_bits(z), Vec3::from_bits(self.translation))
    }
}

/// Returns a component of a quaternion whose square has 30 bits.
pub(super) fn clamped(component: i32) -> i32 {
    component.clamp(-0x7FFF, 0x7FFF)
}

/// Returns the quaternion of length 32,767 in the direction of one of any length; zero for zero.
///
/// # Format
/// The square of the length is moved up by an even number of bits, to 2³⁰..2³². Components are off by less than 3.
#[inline(never)]
fn unit(&[x, y, z, w]: &[i32; 4]) -> [i32; 4] {
    let [xx, yy, zz, ww] = [x * x, y * y, z * z, w * w];
    let n = (xx as u32).wrapping_add(yy as u32).wrapping_add(zz as u32).wrapping_add(ww as u32);
    let half = leading_zeros(n) >> 1;
    if half >= 16 {
        return [0; 4];
    }
    // 2²³ / √(n / 2¹⁶): at most 2¹⁶. Products with components, which are at most √n, are below 2³².
    let factor = inverse_sqrt(n << (2 * half) >> 16) as i32 >> 1;
    [x, y, z, w].map(|c| clamped(((c << half) * factor + (1 << 14)) >> 15))
}

/// Returns the rows of the rotation by a quaternion of any length, 16.16; those of the identity for zero.
///
/// # Format
/// Components are at most 32,767, so that n, the sum of their squares, is below 2³². Each entry is 2 p / n, where p is
/// a sum of products that is at most n / 2. With n and p moved up until n has 32 bits, p / n is a product with the
/// reciprocal, which is within 2⁻²⁹. Entries are within 2⁻¹⁶ of the exact ones.
///
/// # Source
/// The product q v q⁻¹, without a square root.
#[inline(never)]
pub(super) fn rotation_rows(&[x, y, z, w]: &[i32; 4]) -> [[i32; 3]; 3] {
    let [xx, yy, zz, ww] = [x * x, y * y, z * z, w * w];
    let n = (xx as u32).wrapping_add(yy as u32).wrapping_add(zz as u32).wrapping_add(ww as u32);
    if n == 0 {
        return [[1 << 16, 0, 0], [0, 1 << 16, 0], [0, 0, 1 << 16]];
    }
    let zeros = leading_zeros(n);
    let inverse = reciprocal(n << zeros);
    // (p << zeros) 2⁶³ / (n << zeros) / 2³² = 2³¹ p / n.
    let entry = |p: i32| (mul_high_signed(p, inverse) + (1 << 13)) >> 14;
    let twice = |p: i32| entry(p << zeros);
    let once = |p: i32| entry(if zeros == 0 { p >> 1 } else { p << (zeros - 1) });
    [
        [once((ww + xx) - (yy + zz)), twice(x * y - z * w), twice(x * z + y * w)],
        [twice(x * y + z * w), once((ww + yy) - (xx + zz)), twice(y * z - x * w)],
        [twice(x * z - y * w), twice(y * z + x * w), once((ww + zz) - (xx + yy))],
    ]
}

/// Returns the quaternion on the shorter arc from `a` to `b`, `factor`, in 2.14, of the way. Both have a length of
/// about 32,767; the result may be shorter.
///
/// # Format
/// Products are at most 2³⁰. For unit quaternions the rotation is within 2⁻⁹ rad of that on the arc at an even pace.
///
/// # Source
/// Kapoulkine, *Approximating slerp*, 2015: a straight line, whose pace is corrected by a polynomial of the cosine of
/// the angle.
#[inline(never)]
pub(super) fn arc(a: &[i32; 4], b: &[i32; 4], factor: i32) -> [i32; 4] {
    let ([ax, ay, az, aw], [bx, by, bz, bw]) = (*a, *b);
    let cosine = ((ax * bx) >> 16) + ((ay * by) >> 16) + ((az * bz) >> 16) + ((aw * bw) >> 16);
    let d = cosine.abs().min(ONE);
    let times = |a: i32, b: i32| (a * b) >> 14;
    let slope = 17_865 + times(d, -53_169 + times(d, 58_269 - times(d, 23_514)));
    let base = 13_894 + times(d, -17_370 + times(d, 3_533));
    let middle = factor - ONE / 2;
    let k = times(slope, times(middle, middle)) + base;
    let factor = factor + times(times(times(factor, middle), factor - ONE), k);
    let between = |from: i32, to: i32| {
        let to = if cosine < 0 { -to } else { to };
        from + (((to - from) * factor + (1 << 13)) >> 14)
    };
    [between(ax, bx), between(ay, by), between(az, bz), between(aw, bw)]
}

/// Returns the transform that was kept in words.
pub(super) fn from_words(words: &[u32; 12]) -> Affine {
    let [a, b, c, x, d, e, f, y, g, h, i, z] = words.map(|word| word as i32);
    let vector = |x, y, z| Vec3::from_bits([x, y, z]);
    Affine::from_rows(vector(a, b, c), vector(d, e, f), vector(g, h, i), vector(x, y, z))
}

/// Keeps a transform in words: `inner`, then `outer`. Takes half the time of [`Affine::compose`] on small cores.
///
/// # Format
/// Entries are rounded to nearest. They wrap where they leave 16.16, instead of saturating.
#[inline(never)]
pub(super) fn compose(outer: &[[i32; 4]; 3], inner: &[[i32; 4]; 3], words: &mut [u32; 12]) {
    let [[xa, ya, za, ta], [xb, yb, zb, tb], [xc, yc, zc, tc]] = *inner;
    for ([a, b, c, t], words) in outer.iter().zip(words.chunks_exact_mut(4)) {
        let entry = |x: i32, y: i32, z: i32| {
            let sum = mul_wide(*a, x).wrapping_add(mul_wide(*b, y)).wrapping_add(mul_wide(*c, z));
            (sum.wrapping_add(1 << 15) >> 16) as u32
        };
        // One by one: a zip of words and numbers is a loop that shaders have too, and would then be compiled apart from
        // them.
        if let [x, y, z, moved] = words {
            (*x, *y, *z) = (entry(xa, xb, xc), entry(ya, yb, yc), entry(za, zb, zc));
            *moved = entry(ta, tb, tc).wrapping_add(*t as u32);
        }
    }
}

/// Returns the rows of a transform that was kept in words.
pub(super) fn rows(words: &[u32; 12]) -> &[[i32; 4]; 3] {
    bytemuck::cast_ref(words)
}

/// Keeps a transform in words.
pub(super) fn to_words(transform: &Affine, words: &mut [u32; 12]) {
    *words = bytemuck::cast(transform.to_rows());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;
    use std::println;

    fn random_quaternion(rng: &mut Rng, length: f64) -> [i32; 4] {
        loop {
            let q: [f64; 4] = core::array::from_fn(|_| 2.0 * rng.unit() - 1.0);
            let norm = q.iter().map(|c| c * c).sum::<f64>().sqrt();
            if norm > 0.1 && norm < 1.0 {
                return q.map(|c| (c / norm * length).round() as i32);
            }
        }
    }

    fn exact_rows(q: &[i32; 4]) -> [[f64; 3]; 3] {
        let norm = q.iter().map(|c| f64::from(*c).powi(2)).sum::<f64>().sqrt();
        let [x, y, z, w] = q.map(|c| f64::from(c) / norm);
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ]
    }

    #[test]
    fn rotations_are_those_of_their_quaternions() {
        let mut rng = Rng::new(3);
        let mut worst = 0.0_f64;
        let ends = [[0, 0, 0, 1], [0x7FFF; 4], [-0x7FFF, 0x7FFF, 0x7FFF, -0x7FFF], [0x7FFF, 0, 0, 0], [1, 0, 0, -1]];
        let lengths = [3.0, 100.0, 32_767.0];
        let random = (0..30_000).map(|k| random_quaternion(&mut rng, lengths[k % 3]));
        for q in ends.into_iter().chain(random) {
            for (row, exact) in rotation_rows(&q).iter().zip(exact_rows(&q)) {
                for (entry, exact) in row.iter().zip(exact) {
                    worst = worst.max((f64::from(*entry) - exact * 65_536.0).abs());
                }
            }
        }
        println!("worst entry off by {worst:.3} / 2^16");
        assert!(worst <= 1.0, "{worst}");
        assert_eq!(rotation_rows(&[0; 4]), [[65_536, 0, 0], [0, 65_536, 0], [0, 0, 65_536]]);
    }

    #[test]
    fn transforms_are_composed_as_matrices_are() {
        let mut rng = Rng::new(7);
        for _ in 0..10_000 {
            let mut random = || {
                let mut words = [0; 12];
                words.iter_mut().for_each(|word| *word = rng.signed_bits(22) as i32 as u32);
                words
            };
            let (outer, inner) = (random(), random());
            let mut found = [0; 12];
            compose(rows(&outer), rows(&inner), &mut found);
            assert_eq!(from_words(&found), from_words(&outer) * from_words(&inner));
        }
    }

    #[test]
    fn quaternions_become_longer() {
        let mut rng = Rng::new(6);
        let mut worst = 0.0_f64;
        for k in 0..30_000 {
            let length = [2000.0, 9000.0, 20_000.0, 32_767.0][k % 4];
            let q = random_quaternion(&mut rng, length);
            let norm = q.iter().map(|c| f64::from(*c).powi(2)).sum::<f64>().sqrt();
            for (found, c) in unit(&q).into_iter().zip(q) {
                worst = worst.max((f64::from(found) - 32_767.0 * f64::from(c) / norm).abs());
            }
        }
        println!("worst component off by {worst:.3}");
        assert!(worst < 3.0, "{worst}");
        assert_eq!(unit(&[0; 4]), [0; 4]);
        assert_eq!(unit(&[0, -1, 0, 0]), [0, -0x7FFF, 0, 0]);
        unit(&[-0x7FFF; 4]);
    }

    #[test]
    fn arcs_are_at_an_even_pace() {
        let mut rng = Rng::new(4);
        let mut worst = 0.0_f64;
        for _ in 0..50_000 {
            let (a, b) = (random_quaternion(&mut rng, 32_767.0), random_quaternion(&mut rng, 32_767.0));
            let factor = rng.below(ONE as u64 + 1) as i32;
            let t = f64::from(factor) / f64::from(ONE);
            let unit = |q: [i32; 4]| {
                let norm = q.iter().map(|c| f64::from(*c).powi(2)).sum::<f64>().sqrt();
                q.map(|c| f64::from(c) / norm)
            };
            let (p, mut q) = (unit(a), unit(b));
            let mut cosine: f64 = (0..4).map(|k| p[k] * q[k]).sum();
            if cosine < 0.0 {
                q = q.map(|c| -c);
                cosine = -cosine;
            }
            // At half a turn, one arc is as short as the other.
            if cosine < 0.001 {
                continue;
            }
            let angle = cosine.min(1.0).acos();
            let weights = if angle < 1e-6 { [1.0 - t, t] } else { [((1.0 - t) * angle).sin(), (t * angle).sin()] };
            let sum: [f64; 4] = core::array::from_fn(|k| weights[0] * p[k] + weights[1] * q[k]);
            let norm = sum.iter().map(|c| c * c).sum::<f64>().sqrt();
            let found = unit(arc(&a, &b, factor));
            let dot: f64 = (0..4).map(|k| sum[k] / norm * found[k]).sum();
            worst = worst.max(2.0 * dot.abs().min(1.0).acos());
        }
        println!("worst rotation off by {worst:.6} rad");
        assert!(worst < 2f64.powi(-9), "{worst}");
    }
}
