//! Positions of vertices on the screen, packed into two words: the form in which they are kept from the vertex stage
//! on.

use super::project::{Projected, ScreenVertex};

/// Words of a vertex's position in the records, which come before its varyings.
pub(crate) const VERTEX_WORDS: usize = 2;

/// A position of a vertex on the screen, in two words: x in the upper 24 bits of the first, y in those of the second;
/// below x the high byte of z, below y the low byte.
///
/// A vertex that is not on the screen has an x that no vertex on the screen has. The low byte of that word is its
/// outcode, or a mark that it is not shaded yet: [`UNSHADED`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PackedVertex(pub(crate) [u32; 2]);

const OFF_SCREEN: u32 = 0x8000_0000;
const UNSHADED: u32 = OFF_SCREEN | 0x80;

impl PackedVertex {
    /// Packs a vertex on the screen, or one that has to be clipped and so cannot be projected.
    #[inline]
    pub(crate) const fn new(placed: &Projected) -> Self {
        match placed {
            Projected::OnScreen(v) => {
                Self([(v.x as u32) << 8 | (v.z >> 8) as u32, (v.y as u32) << 8 | (v.z & 0xFF) as u32])
            }
            Projected::NeedsClip(code) => Self([OFF_SCREEN | code.0 as u32, 0]),
        }
    }

    /// A vertex that is not shaded yet.
    pub(crate) const NONE: Self = Self([UNSHADED, 0]);

    /// Words of a vertex that is not shaded yet.
    pub(crate) const NONE_WORDS: [u32; 2] = Self::NONE.0;

    /// Makes a packed vertex of its words.
    #[inline]
    pub(crate) const fn of(words: [u32; 2]) -> Self {
        Self(words)
    }

    #[inline]
    pub(crate) const fn is_unshaded(self) -> bool {
        self.0[0] == UNSHADED
    }

    #[inline]
    pub(crate) const fn is_on_screen(self) -> bool {
        self.0[0] >> 8 != OFF_SCREEN >> 8
    }

    /// Returns the outcode of a vertex that is not on the screen, 0 for one that is.
    pub(crate) const fn outcode(self) -> u8 {
        if self.is_on_screen() { 0 } else { self.0[0] as u8 }
    }

    /// Returns the two words.
    #[inline]
    pub(crate) const fn words(self) -> [u32; 2] {
        self.0
    }

    /// Limit of first words, taken as signed: a first word below it belongs to a vertex that is not on the screen.
    /// The second word of a vertex on the screen begins with its y.
    pub(crate) const LEAST_X: i32 = (OFF_SCREEN as i32) + 0x100;

    /// Returns the position of a vertex on the screen.
    #[inline]
    pub(crate) const fn screen(self) -> ScreenVertex {
        let [a, b] = self.0;
        ScreenVertex::new(a as i32 >> 8, b as i32 >> 8, ((a & 0xFF) << 8 | (b & 0xFF)) as u16)
    }

    /// Returns x, 24.8.
    #[inline(always)]
    pub(crate) const fn x(&self) -> i32 {
        self.0[0] as i32 >> 8
    }

    /// Returns y, 24.8.
    #[inline(always)]
    pub(crate) const fn y(&self) -> i32 {
        self.0[1] as i32 >> 8
    }

    /// Returns the depth.
    #[inline(always)]
    pub(crate) const fn z(&self) -> i32 {
        ((self.0[0] & 0xFF) << 8 | (self.0[1] & 0xFF)) as i32
    }
}

/// Packs vertices on the screen.
#[inline(never)]
pub(crate) fn pack(v: &[ScreenVertex; 3], words: &mut [[u32; 2]; 3]) {
    for (words, v) in words.iter_mut().zip(v) {
        *words = PackedVertex::new(&Projected::OnScreen(*v)).words();
    }
}
