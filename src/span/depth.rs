//! The depth test, and the loops that test the depths of a run in front of its colours.
//!
//! The plain loop:
//!
//! ```text
//! for each depth of the run:
//!     if z >> 16 does not pass: stop
//!     store z >> 16
//!     z += dz_dx
//! ```
//! The departures from it:
//!
//! 1. **Unrolled by hand**, 16 times or by 8, 4, 2 and 1: at `opt-level = "s"` a loop stays a loop, and its counter takes a register
//!    and three instructions per pixel.
//! 2. **Out of line on small cores**, where the registers are its own. What tests and colours in one loop keeps a part of its values
//!    on the stack there: two passes took W2, a Gouraud quad, from 25.4 to 19.3 instructions per pixel.

use crate::math::SMALL_CORE;

/// Comparison of a fragment's depth with the stored one that lets it be drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Compare {
    /// Nothing passes.
    Never,
    /// Nearer passes.
    #[default]
    Less,
    /// The same depth passes.
    Equal,
    /// Nearer or the same passes.
    LessEqual,
    /// Farther passes.
    Greater,
    /// Any other depth passes.
    NotEqual,
    /// Farther or the same passes.
    GreaterEqual,
    /// Everything passes.
    Always,
}

/// Depth test of a draw, and its write mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DepthState {
    /// The test.
    pub compare: Compare,
    /// A fragment that passes leaves its depth.
    pub write: bool,
}

impl DepthState {
    /// Nearer fragments pass and leave their depth.
    pub const LESS: Self = Self { compare: Compare::Less, write: true };
    /// Nearer fragments pass and leave depth as it is: for transparent things.
    pub const TEST: Self = Self { compare: Compare::Less, write: false };
    /// Depth is neither tested nor written: the painter's way.
    pub const OFF: Self = Self { compare: Compare::Always, write: false };
}

impl Default for DepthState {
    fn default() -> Self {
        Self::LESS
    }
}

/// Stored depths as the pixel loops see them. Depth tests implement it, and nothing else can.
pub trait DepthStorage<Z>: Copy {
    /// Returns the stored depths; or as many of `nothing`, where depth plays no part, so that the same loops do without a depth
    /// buffer.
    fn slots<'d>(depths: &'d mut [u16], nothing: &'d mut [()]) -> &'d mut [Z];

    /// Returns the test as a value, and depths as numbers, where depth plays a part: for long loops, of which three copies cost
    /// more than the test does.
    fn as_dyn(self, stored: &mut [Z]) -> Option<(DepthDyn, &mut [u16])>;
}

/// A depth test as the pixel loops see it: a type, so that each loop is compiled for its own.
pub trait DepthTest: DepthStorage<<Self as DepthTest>::Depth> {
    /// Depth plays a part; where it does not, neither `passes` nor `write` has to be called.
    const ENABLED: bool;

    /// Stored depth of a pixel: `u16`, or `()` where depth plays no part.
    type Depth: Copy;

    /// Compares `z` with the stored depth.
    fn passes(self, z: u16, stored: Self::Depth) -> bool;

    /// Leaves the depth of a fragment that passed, and was not discarded, if depths are written.
    fn write(self, z: u16, stored: &mut Self::Depth);
}

/// [`DepthState::LESS`].
#[derive(Clone, Copy, Debug)]
pub struct DepthLess;

impl DepthTest for DepthLess {
    const ENABLED: bool = true;

    type Depth = u16;

    #[inline(always)]
    fn passes(self, z: u16, stored: u16) -> bool {
        z < stored
    }

    #[inline(always)]
    fn write(self, z: u16, stored: &mut u16) {
        *stored = z;
    }
}

impl DepthStorage<u16> for DepthLess {
    #[inline(always)]
    fn slots<'d>(depths: &'d mut [u16], _: &'d mut [()]) -> &'d mut [u16] {
        depths
    }

    #[inline(always)]
    fn as_dyn(self, stored: &mut [u16]) -> Option<(DepthDyn, &mut [u16])> {
        Some((DepthDyn::new(DepthState::LESS), stored))
    }
}

/// [`DepthState::OFF`].
#[derive(Clone, Copy, Debug)]
pub struct DepthOff;

impl DepthTest for DepthOff {
    const ENABLED: bool = false;

    type Depth = ();

    #[inline(always)]
    fn passes(self, _: u16, (): ()) -> bool {
        true
    }

    #[inline(always)]
    fn write(self, _: u16, (): &mut ()) {}
}

impl DepthStorage<()> for DepthOff {
    #[inline(always)]
    fn slots<'d>(_: &'d mut [u16], nothing: &'d mut [()]) -> &'d mut [()] {
        nothing
    }

    #[inline(always)]
    fn as_dyn(self, _: &mut [()]) -> Option<(DepthDyn, &mut [u16])> {
        None
    }
}

/// Any test: that the difference of a depth and the stored one is in a range.
///
/// # Format
/// Differences are in -65,535..=65,535. Modulo 2³² even all numbers but 0 are a range.
#[derive(Clone, Copy, Debug)]
pub struct DepthDyn {
    lowest: i32,
    count: u32,
    write: bool,
}

impl DepthDyn {
    /// From its description.
    #[must_use]
    pub const fn new(state: DepthState) -> Self {
        let (lowest, count) = match state.compare {
            Compare::Never => (0, 0),
            Compare::Less => (-65_535, 65_535),
            Compare::Equal => (0, 1),
            Compare::LessEqual => (-65_535, 65_536),
            Compare::Greater => (1, 65_535),
            Compare::NotEqual => (1, u32::MAX),
            Compare::GreaterEqual => (0, 65_536),
            Compare::Always => (i32::MIN, u32::MAX),
        };
        Self { lowest, count, write: state.write }
    }
}

impl DepthTest for DepthDyn {
    const ENABLED: bool = true;

    type Depth = u16;

    #[inline(always)]
    fn passes(self, z: u16, stored: u16) -> bool {
        let difference = i32::from(z) - i32::from(stored);
        (difference.wrapping_sub(self.lowest) as u32) < self.count
    }

    #[inline(always)]
    fn write(self, z: u16, stored: &mut u16) {
        if self.write {
            *stored = z;
        }
    }
}

impl DepthStorage<u16> for DepthDyn {
    #[inline(always)]
    fn slots<'d>(depths: &'d mut [u16], _: &'d mut [()]) -> &'d mut [u16] {
        depths
    }

    #[inline(always)]
    fn as_dyn(self, stored: &mut [u16]) -> Option<(DepthDyn, &mut [u16])> {
        Some((self, stored))
    }
}

/// Pixels that [`count_passing_prefix`] tests.
pub(crate) const RUN: usize = 16;

/// Tests the depths of a run from `z` on, up to the first that does not pass, and writes those that do. Returns how many pass.
///
/// Most runs pass, or fail, as a whole. Where all pass, two loops, this one and another for colours, are shorter than one for
/// both, as each has all of its values in registers.
#[inline(always)]
pub(crate) fn count_passing_prefix<D: DepthTest>(test: D, depths: &mut [D::Depth; RUN], z: u32, dz_dx: i32) -> usize {
    if !D::ENABLED {
        RUN
    } else if SMALL_CORE {
        count_passing_prefix_outlined(test, depths, z, dz_dx)
    } else {
        count_passing_prefix_inlined(test, depths, z, dz_dx)
    }
}

/// Out of line, where its registers are its own.
#[inline(never)]
fn count_passing_prefix_outlined<D: DepthTest>(test: D, depths: &mut [D::Depth; RUN], z: u32, dz_dx: i32) -> usize {
    count_passing_prefix_inlined(test, depths, z, dz_dx)
}

#[inline(always)]
fn count_passing_prefix_inlined<D: DepthTest>(test: D, depths: &mut [D::Depth; RUN], mut z: u32, dz_dx: i32) -> usize {
    // Spelled out: at `opt-level = "s"` a loop would stay a loop.
    macro_rules! test {
        ($($count:literal $depth:ident)*) => {
            let [$($depth),*] = depths;
            $(
                let near = (z >> 16) as u16;
                if !test.passes(near, *$depth) {
                    return $count;
                }
                test.write(near, $depth);
                z = z.wrapping_add_signed(dz_dx);
            )*
        };
    }
    test!(0 a 1 b 2 c 3 d 4 e 5 f 6 g 7 h 8 i 9 j 10 k 11 l 12 m 13 n 14 o 15 p);
    let _ = z;
    RUN
}

/// Does as [`count_passing_prefix`] for up to a run, and returns how many depths are not tested yet.
#[inline(always)]
pub(crate) fn untested_tail<D: DepthTest>(test: D, depths: &mut [D::Depth], z: u32, dz_dx: i32) -> usize {
    match <&mut [D::Depth; RUN]>::try_from(&mut *depths) {
        Ok(run) => RUN - count_passing_prefix(test, run, z, dz_dx),
        Err(_) => untested_short_tail(test, depths, z, dz_dx),
    }
}

/// Does as [`untested_tail`] for fewer depths than a run has.
#[inline(always)]
pub(super) fn untested_short_tail<D: DepthTest>(test: D, depths: &mut [D::Depth], z: u32, dz_dx: i32) -> usize {
    if D::ENABLED { untested_short_tail_outlined(test, depths, z, dz_dx) } else { 0 }
}

/// Out of line, where its registers are its own.
#[inline(never)]
fn untested_short_tail_outlined<D: DepthTest>(test: D, mut depths: &mut [D::Depth], mut z: u32, dz_dx: i32) -> usize {
    // Spelled out: at `opt-level = "s"` a loop would stay a loop.
    macro_rules! test {
        ($($left:literal $depth:ident)*) => {
            let Some(([$($depth),*], rest)) = core::mem::take(&mut depths).split_first_chunk_mut() else { return 0 };
            depths = rest;
            $(
                let near = (z >> 16) as u16;
                if !test.passes(near, *$depth) {
                    return depths.len() + $left;
                }
                test.write(near, $depth);
                z = z.wrapping_add_signed(dz_dx);
            )*
        };
    }
    if depths.len() >= 8 {
        test!(8 a 7 b 6 c 5 d 4 e 3 f 2 g 1 h);
    }
    if depths.len() >= 4 {
        test!(4 a 3 b 2 c 1 d);
    }
    if depths.len() >= 2 {
        test!(2 a 1 b);
    }
    if depths.is_empty() {
        // 0, where it is at hand.
        return depths.len();
    }
    test!(1 a);
    let _ = (depths, z);
    0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;

    #[test]
    fn few_depths_are_tested_one_by_one() {
        let mut rng = Rng::new(1);
        for case in 0..4000 {
            let mut random = || rng.next_u32();
            let (length, z, dz_dx) = (case % (RUN + 1), random() >> 1, random() as i32 >> 12);
            let mut expected = [(); RUN].map(|()| if random() % 16 < 1 { 0 } else { u16::MAX });
            let mut found = expected;
            let mut left = length;
            for (k, depth) in expected[..length].iter_mut().enumerate() {
                let near = (z.wrapping_add_signed(dz_dx * k as i32) >> 16) as u16;
                if near >= *depth {
                    break;
                }
                (*depth, left) = (near, left - 1);
            }
            assert_eq!(super::untested_tail(DepthLess, &mut found[..length], z, dz_dx), left, "{case}");
            assert_eq!(found, expected, "{case}");
        }
    }

    #[test]
    fn all_tests_compare_as_they_say() {
        use Compare::*;
        let depths = [0, 1, 2, 0x7FFF, 0x8000, 0xFFFE, 0xFFFF_u16];
        for (z, stored) in depths.iter().flat_map(|z| depths.iter().map(move |stored| (*z, *stored))) {
            let expected = [false, z < stored, z == stored, z <= stored, z > stored, z != stored, z >= stored, true];
            let compares = [Never, Less, Equal, LessEqual, Greater, NotEqual, GreaterEqual, Always];
            for (compare, expected) in compares.into_iter().zip(expected) {
                let test = DepthDyn::new(DepthState { compare, write: false });
                assert_eq!(test.passes(z, stored), expected, "{z} {compare:?} {stored}");
            }
            let less = DepthLess.as_dyn(&mut []).map(|(test, _)| test.passes(z, stored));
            assert_eq!(less, Some(DepthLess.passes(z, stored)));
        }
    }
}
