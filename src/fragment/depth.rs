//! The depth test.

/// How a fragment's depth must compare with the stored one to be drawn.
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

/// What to do with depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DepthState {
    /// The test.
    pub compare: Compare,
    /// Whether a fragment that passes leaves its depth.
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

/// A depth test as the pixel loops see it: a type, so that each loop is compiled for its own.
pub trait DepthTest: Copy {
    /// Whether depth plays a part at all; otherwise neither method is called.
    const ENABLED: bool;

    /// Compares `z` with the stored depth.
    fn passes(self, z: u16, stored: u16) -> bool;

    /// Leaves the depth of a fragment that passed, and was not discarded, if depths are written.
    fn write(self, z: u16, stored: &mut u16);

    /// The same test as a value: for loops in which it costs little, but two more copies of the loop much.
    fn any(self) -> AnyDepth;
}

/// [`DepthState::LESS`].
#[derive(Clone, Copy, Debug)]
pub struct LessWrite;

impl DepthTest for LessWrite {
    const ENABLED: bool = true;

    #[inline(always)]
    fn passes(self, z: u16, stored: u16) -> bool {
        z < stored
    }

    #[inline(always)]
    fn write(self, z: u16, stored: &mut u16) {
        *stored = z;
    }

    fn any(self) -> AnyDepth {
        AnyDepth::new(DepthState::LESS)
    }
}

/// [`DepthState::OFF`].
#[derive(Clone, Copy, Debug)]
pub struct NoDepth;

impl DepthTest for NoDepth {
    const ENABLED: bool = false;

    #[inline(always)]
    fn passes(self, _: u16, _: u16) -> bool {
        true
    }

    #[inline(always)]
    fn write(self, _: u16, _: &mut u16) {}

    fn any(self) -> AnyDepth {
        AnyDepth::new(DepthState::OFF)
    }
}

/// Any test: that the difference of a depth and the stored one is in a range.
///
/// # Format
/// Differences are in -65,535..=65,535. Modulo 2³² even all numbers but 0 are a range.
#[derive(Clone, Copy, Debug)]
pub struct AnyDepth {
    lowest: i32,
    count: u32,
    write: bool,
}

impl AnyDepth {
    /// From its description.
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

impl DepthTest for AnyDepth {
    const ENABLED: bool = true;

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

    fn any(self) -> AnyDepth {
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_tests_compare_as_they_say() {
        use Compare::*;
        let depths = [0, 1, 2, 0x7FFF, 0x8000, 0xFFFE, 0xFFFF_u16];
        for (z, stored) in depths.iter().flat_map(|z| depths.iter().map(move |stored| (*z, *stored))) {
            let expected = [false, z < stored, z == stored, z <= stored, z > stored, z != stored, z >= stored, true];
            let compares = [Never, Less, Equal, LessEqual, Greater, NotEqual, GreaterEqual, Always];
            for (compare, expected) in compares.into_iter().zip(expected) {
                let test = AnyDepth::new(DepthState { compare, write: false });
                assert_eq!(test.passes(z, stored), expected, "{z} {compare:?} {stored}");
            }
            assert_eq!(LessWrite.any().passes(z, stored), LessWrite.passes(z, stored));
            assert!(NoDepth.any().passes(z, stored));
        }
    }
}
