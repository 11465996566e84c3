//! The depth test, and the loops that test the depths of a run before its pixels are coloured. Each loop takes the
//! stored depths and the depth at the first pixel. It stores the depths that pass, and returns how many do, or how many
//! are left.
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
//! 1. **Unrolled by hand**, 16 times or by 8, 4, 2 and 1: at `opt-level = "s"` a loop stays a loop, and its counter
//!    takes a register and three instructions per pixel.
//! 2. **Out of line on small cores**, so that the loop has all registers for itself. A loop that tests and colours at
//!    once keeps some of its values on the stack there. Two passes took W2, a Gouraud quad, from 25.4 to 19.3
//!    instructions per pixel.

use crate::math::SMALL_CORE;

/// Comparison of a fragment's depth with the stored depth. A fragment that passes is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Compare {
    /// Nothing passes.
    Never,
    /// Nearer fragments pass.
    #[default]
    Less,
    /// Fragments of equal depth pass.
    Equal,
    /// Nearer fragments and those of equal depth pass.
    LessEqual,
    /// Farther fragments pass.
    Greater,
    /// Fragments of any other depth pass.
    NotEqual,
    /// Farther fragments and those of equal depth pass.
    GreaterEqual,
    /// Every fragment passes.
    Always,
}

/// Depth test of a draw, and its write mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DepthState {
    /// Comparison that a fragment has to pass.
    pub compare: Compare,
    /// Set if a fragment that passes stores its depth.
    pub write: bool,
}

impl DepthState {
    /// Nearer fragments pass and store their depth.
    pub const LESS: Self = Self { compare: Compare::Less, write: true };
    /// Fragments that nothing is nearer than pass and store their depth: for things that cover others at one depth.
    pub const LESS_EQUAL: Self = Self { compare: Compare::LessEqual, write: true };
    /// Nearer fragments pass and leave the stored depth as it is: for transparent things.
    pub const TEST: Self = Self { compare: Compare::Less, write: false };
    /// Depth is neither tested nor stored: later draws cover earlier ones.
    pub const OFF: Self = Self { compare: Compare::Always, write: false };
}

impl Default for DepthState {
    fn default() -> Self {
        Self::LESS
    }
}

/// Stored depths as the pixel loops see them. The depth tests implement this trait, and nothing else can.
pub trait DepthStorage<Z>: Copy {
    /// Returns the stored depths. Where depth plays no part, returns `nothing` instead, so that one loop serves
    /// programs with and without a depth buffer.
    fn slots<'d>(depths: &'d mut [u16], nothing: &'d mut [()]) -> &'d mut [Z];

    /// Returns the test as a value, and the stored depths as numbers; `None` where depth plays no part. Long loops are
    /// compiled for this form only: a copy for each of three tests would cost more than the test by value does.
    fn as_dyn(self, stored: &mut [Z]) -> Option<(DepthDyn, &mut [u16])>;
}

/// A depth test as the pixel loops see it. Each test is a type, so that each loop is compiled for it.
pub trait DepthTest: DepthStorage<<Self as DepthTest>::Depth> {
    /// Set if depth plays a part. If it does not, callers may leave out `passes` and `write`.
    const ENABLED: bool;

    /// Set if small triangles that go on in the next strip leave their state, see [`Carrying`].
    const CARRIES: bool = false;

    /// Set if pixels have several samples, see [`Sampled`].
    const SAMPLED: bool = false;

    /// Stored depth of a pixel: `u16`, or `()` where depth plays no part.
    type Depth: Copy;

    /// Returns whether `z` passes against the stored depth.
    fn passes(self, z: u16, stored: Self::Depth) -> bool;

    /// Stores the depth of a fragment that passed and was not discarded, if the test stores depths.
    fn write(self, z: u16, stored: &mut Self::Depth);
}

macro_rules! storing_test {
    ($name:ident, $comparison:tt, $state:ident) => {
        #[doc = concat!("The test of [`DepthState::", stringify!($state), "`].")]
        #[derive(Clone, Copy, Debug)]
        pub struct $name;

        impl DepthTest for $name {
            const ENABLED: bool = true;

            type Depth = u16;

            #[inline(always)]
            fn passes(self, z: u16, stored: u16) -> bool {
                z $comparison stored
            }

            #[inline(always)]
            fn write(self, z: u16, stored: &mut u16) {
                *stored = z;
            }
        }

        impl DepthStorage<u16> for $name {
            #[inline(always)]
            fn slots<'d>(depths: &'d mut [u16], _: &'d mut [()]) -> &'d mut [u16] {
                depths
            }

            #[inline(always)]
            fn as_dyn(self, stored: &mut [u16]) -> Option<(DepthDyn, &mut [u16])> {
                Some((DepthDyn::new(DepthState::$state), stored))
            }
        }
    };
}

storing_test!(DepthLess, <, LESS);
storing_test!(DepthLessEqual, <=, LESS_EQUAL);

/// A depth test of small triangles that leave their state for the next strip. As this is said by a type, programs that
/// carry no state on link nothing of it.
#[derive(Clone, Copy, Debug)]
pub struct Carrying<D>(pub D);

/// A depth test of small triangles in pixels of several samples. As this is said by a type, programs without such
/// pixels link nothing of it.
#[derive(Clone, Copy, Debug)]
pub struct Sampled<D>(pub D);

/// Implements a test that is another one, with a constant set that says what is done beside it.
macro_rules! marked_test {
    ($name:ident, $mark:ident) => {
        impl<D: DepthTest> DepthTest for $name<D> {
            const ENABLED: bool = D::ENABLED;

            const $mark: bool = true;

            type Depth = D::Depth;

            #[inline(always)]
            fn passes(self, z: u16, stored: D::Depth) -> bool {
                self.0.passes(z, stored)
            }

            #[inline(always)]
            fn write(self, z: u16, stored: &mut D::Depth) {
                self.0.write(z, stored);
            }
        }

        impl<D: DepthTest> DepthStorage<D::Depth> for $name<D> {
            #[inline(always)]
            fn slots<'d>(depths: &'d mut [u16], nothing: &'d mut [()]) -> &'d mut [D::Depth] {
                D::slots(depths, nothing)
            }

            #[inline(always)]
            fn as_dyn(self, stored: &mut [D::Depth]) -> Option<(DepthDyn, &mut [u16])> {
                self.0.as_dyn(stored)
            }
        }
    };
}

marked_test!(Carrying, CARRIES);
marked_test!(Sampled, SAMPLED);

/// The test of [`DepthState::OFF`].
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

/// Any test, as a range: a fragment passes if its depth minus the stored depth lies in the range.
///
/// # Format
/// Differences are in -65,535..=65,535. The range is modulo 2³², so that all numbers but 0 are a range too.
#[derive(Clone, Copy, Debug)]
pub struct DepthDyn {
    lowest: i32,
    count: u32,
    write: bool,
}

impl DepthDyn {
    /// Creates the test that a state describes.
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

/// Number of pixels in a run, whose depths [`count_passing_prefix`] tests.
pub(crate) const RUN: usize = 16;

/// Tests the depths of a run, from `z` on, up to the first one that does not pass. Stores the depths that pass, and
/// returns their number.
///
/// Most runs pass, or fail, as a whole. Where all pixels pass, two loops, this one and one for colours, take fewer
/// instructions than a single loop, because each has all of its values in registers.
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

/// Does as [`count_passing_prefix`], out of line, so that its loop has all registers for itself.
#[inline(never)]
fn count_passing_prefix_outlined<D: DepthTest>(test: D, depths: &mut [D::Depth; RUN], z: u32, dz_dx: i32) -> usize {
    count_passing_prefix_inlined(test, depths, z, dz_dx)
}

#[inline(always)]
fn count_passing_prefix_inlined<D: DepthTest>(test: D, depths: &mut [D::Depth; RUN], mut z: u32, dz_dx: i32) -> usize {
    // Unrolled by hand: at `opt-level = "s"` a loop would stay a loop.
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

/// Does as [`count_passing_prefix`] for fewer depths than a run has, but returns the number of depths that are left,
/// beginning with the first one that does not pass.
#[inline(always)]
pub(super) fn untested_short_tail<D: DepthTest>(test: D, depths: &mut [D::Depth], z: u32, dz_dx: i32) -> usize {
    if D::ENABLED { untested_short_tail_outlined(test, depths, z, dz_dx) } else { 0 }
}

/// Does as [`untested_short_tail`], out of line, so that its loop has all registers for itself.
#[inline(never)]
fn untested_short_tail_outlined<D: DepthTest>(test: D, mut depths: &mut [D::Depth], mut z: u32, dz_dx: i32) -> usize {
    // Unrolled by hand: at `opt-level = "s"` a loop would stay a loop.
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
        // The length is 0 here, and already in a register.
        return depths.len();
    }
    test!(1 a);
    let _ = (depths, z);
    0
}

#[cfg(test)]
mod tests {
    use super::super::naive;
    use super::*;
    use crate::math::random::Rng;

    #[test]
    fn a_tested_prefix_and_the_plain_loop_draw_what_the_plain_loop_draws() {
        let mut rng = Rng::new(1);
        for case in 0..4000 {
            let (z, dz_dx) = ((rng.below(40_000) as u32 + 1000) << 16, rng.next_u32() as i32 >> 12);
            let case = naive::Case { length: case % (RUN + 1), z, dz_dx, background: 0_u8 };
            naive::compare(
                DepthLess,
                case,
                &mut rng,
                |depth| depth,
                |_| Some(7),
                &mut [("a tested prefix", &mut |color, depth| {
                    let passed = match <&mut [u16; RUN]>::try_from(&mut *depth) {
                        Ok(run) => count_passing_prefix(DepthLess, run, z, dz_dx),
                        Err(_) => depth.len() - untested_short_tail(DepthLess, depth, z, dz_dx),
                    };
                    let (prefix, color) = color.split_at_mut(passed);
                    prefix.fill(7);
                    let z = z.wrapping_add_signed(dz_dx.wrapping_mul(passed as i32));
                    naive::draw(DepthLess, color, &mut depth[passed..], z, dz_dx, |_| Some(7));
                })],
            );
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
            let less_equal = DepthLessEqual.as_dyn(&mut []).map(|(test, _)| test.passes(z, stored));
            assert_eq!((less_equal, z <= stored), (Some(z <= stored), DepthLessEqual.passes(z, stored)));
        }
    }
}
