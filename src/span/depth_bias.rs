//! Depth bias: draws triangles a little nearer or farther than they are, so that a decal does not fight with the
//! surface that it lies on.

use crate::math::Scalar;
use core::ops::Range;

/// Number of steps that is added to the depths of a draw's triangles. Negative numbers draw nearer.
///
/// Decals and outlines on a surface want about `DepthBias { constant: -1, slope: -Scalar::ONE }`. The reason: two
/// coplanar triangles with different vertices differ in their interpolated depths, by one step and by the change of
/// depth within a pixel.
///
/// Biased depths stay in 0..=65,535. Where a bias would move a triangle out of that range, the triangle gets the
/// largest bias that does not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DepthBias {
    /// Steps that are added to every triangle.
    pub constant: i16,
    /// Factor by which the triangle's slope is multiplied; the product is added too. The slope is the number of steps
    /// by which depth changes from a pixel to its neighbour in x or in y, whichever is more: small for faces towards
    /// the viewer, large for faces seen edge-on.
    pub slope: Scalar,
}

#[cfg(feature = "defmt")]
impl defmt::Format for DepthBias {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}", defmt::Debug2Format(self));
    }
}

impl DepthBias {
    /// No bias.
    pub const NONE: Self = Self { constant: 0, slope: Scalar::ZERO };

    /// Returns whether the bias adds nothing.
    pub(crate) fn is_none(self) -> bool {
        self == Self::NONE
    }

    /// Computes the steps to add to a triangle whose depths are in `depths`, both ends included, and change by `dz_dx`
    /// and `dz_dy` per pixel, 16.16.
    ///
    /// # Format
    /// The changes are modulo 2³², and those of a sliver may not fit. But between two pixels of a triangle depth
    /// changes by no more than between its vertices, so the extent of `depths` bounds the change. Products are 32 by 32
    /// bits, rounded to nearest. The result plus any depth in `depths` is in 0..=65,535.
    #[inline(never)]
    pub(crate) fn steps(self, depths: Range<u16>, dz_dx: i32, dz_dy: i32) -> i32 {
        let range = u32::from(depths.end - depths.start) << 16;
        let change = dz_dx.unsigned_abs().max(dz_dy.unsigned_abs()).min(range);
        let slope = (i64::from(self.slope.to_bits()) * i64::from(change) + (1 << 31)) >> 32;
        let steps = i64::from(self.constant) + slope;
        steps.max(-i64::from(depths.start)).min(65_535 - i64::from(depths.end)) as i32
    }
}

/// [`DepthBias::steps`], as a hook of states that may have a bias.
pub(crate) type BiasSteps = fn(DepthBias, Range<u16>, i32, i32) -> i32;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;

    /// Computes the bias by its definition, in floating point, before it is kept in range.
    fn exact(bias: DepthBias, depths: Range<u16>, dx: i32, dy: i32) -> f64 {
        let change = f64::from(dx).abs().max(f64::from(dy).abs()) / 65_536.0;
        let change = change.min(f64::from(depths.end - depths.start));
        f64::from(bias.constant) + f64::from(bias.slope.to_bits()) / 65_536.0 * change
    }

    #[test]
    fn bias_is_the_rounded_definition_and_keeps_depths_in_range() {
        let mut rng = Rng::new(11);
        let mut next = |bits: u32| (rng.next_u64() >> (64 - bits)) as i32;
        for case in 0..100_000 {
            let (a, b) = (next(16) as u16, next(16) as u16);
            let depths = a.min(b)..a.max(b);
            let constant = (next(16) >> (case % 16)) as i16;
            let slope = Scalar::from_bits(next(32) >> (case % 31));
            let bias = DepthBias { constant, slope };
            let (dx, dy) = (next(32) >> (case % 29), next(32) >> (case % 31));
            let steps = bias.steps(depths.clone(), dx, dy);
            let (low, high) = (i32::from(depths.start) + steps, i32::from(depths.end) + steps);
            assert!(low >= 0 && high <= 65_535, "case {case}: {depths:?} becomes {low}..={high}");
            let exact = exact(bias, depths, dx, dy);
            let expected = exact.clamp(-f64::from(a.min(b)), 65_535.0 - f64::from(a.max(b)));
            assert!((f64::from(steps) - expected).abs() <= 0.500_001, "case {case}: {steps}, {exact}");
        }
    }

    #[test]
    fn bias_stops_at_the_ends_of_depth() {
        let bias = |constant| DepthBias { constant, slope: Scalar::ZERO };
        assert_eq!(bias(-10).steps(3..900, 1 << 16, 0), -3);
        assert_eq!(bias(-10).steps(0..0, 0, 0), 0);
        assert_eq!(bias(i16::MIN).steps(65_535..65_535, 0, 0), -32_768);
        assert_eq!(bias(10).steps(65_530..65_533, 0, 0), 2);
        assert_eq!(bias(i16::MAX).steps(0..65_535, i32::MIN, i32::MAX), 0);
        let steep = DepthBias { constant: -1, slope: -Scalar::ONE };
        assert_eq!(steep.steps(1000..1040, 8 << 16, -(12 << 16)), -13);
        // A sliver's gradient may be anything, so the extent of its depths limits it.
        assert_eq!(steep.steps(1000..1040, i32::MIN, 5), -41);
    }
}
