//! Varyings: the values that are interpolated over a triangle. They are linear on the screen or, perspective-correct,
//! linear in space.
//!
//! ```text
//! linear on the screen:     v = Σ bᵢ vᵢ                          bᵢ: a pixel's barycentric coordinates on the screen
//! linear in space:          v = Σ bᵢ vᵢ/wᵢ  /  Σ bᵢ/wᵢ
//! ```
//! Plain arrays are interpolated linearly on the screen. [`Perspective`] divides some of its values by w. The data that
//! this takes per triangle is kept in its [`PerspectiveSetup`], which is `()` for arrays.

use core::fmt::Debug;

/// Values that are interpolated over a triangle: `[i32; N]`, in any fixed-point format that suits the shader, or
/// [`Perspective`].
///
/// Values may differ by less than 2³¹ over the triangle. Values that are linear on the screen are within 2¹³ of their
/// exact value, plus 2 per pixel on a small triangle. So values that have to be smooth need some 16 fractional bits.
pub trait Varyings: Copy + AsRef<[i32]> + AsMut<[i32]> {
    /// Number of values.
    const LEN: usize;
    /// Varyings that are all zero.
    const ZERO: Self;
    /// Number of values, counted from the first, that are perspective-correct. If there are any, the last value is not
    /// the shader's: the pipeline keeps 1 / w there.
    const PERSPECTIVE: usize = 0;
    /// Data per triangle that the fragment stage needs to correct perspective-correct values.
    type PerspectiveSetup: PerspectiveSetup;

    /// Adds `change`, modulo 2³².
    #[inline]
    fn step(&mut self, change: &Self) {
        for (value, change) in self.as_mut().iter_mut().zip(change.as_ref()) {
            *value = value.wrapping_add(*change);
        }
    }

    /// Adds `pixels` times `change`, modulo 2³².
    #[inline]
    fn advance(&mut self, change: &Self, pixels: i32) {
        for (value, change) in self.as_mut().iter_mut().zip(change.as_ref()) {
            *value = value.wrapping_add(change.wrapping_mul(pixels));
        }
    }

    /// Puts 1 / w into its place, the last value, if any value is perspective-correct.
    #[inline]
    fn set_inverse_w(&mut self, inverse_w: u32) {
        if let (true, [.., last]) = (Self::PERSPECTIVE > 0, self.as_mut()) {
            *last = inverse_w as i32;
        }
    }
}

impl<const N: usize> Varyings for [i32; N] {
    const LEN: usize = N;
    const ZERO: Self = [0; N];
    type PerspectiveSetup = ();

    #[inline(always)]
    fn step(&mut self, change: &Self) {
        step(self, change);
    }

    #[inline(always)]
    fn advance(&mut self, change: &Self, pixels: i32) {
        advance(self, change, pixels);
    }
}

/// The largest number of values that are kept in registers. If there are more, functions that are not inlined change
/// them in memory: otherwise the loops around would hold copies of the values, and of their changes, on the stack.
pub(crate) const MAX_IN_REGISTERS: usize = 3;

/// Adds `changes`, modulo 2³².
#[inline(always)]
fn step<const N: usize>(values: &mut [i32; N], changes: &[i32; N]) {
    if N > MAX_IN_REGISTERS { step_outlined(values, changes) } else { advance_inlined(values, changes, 1) }
}

/// Adds `pixels` times `changes`, modulo 2³².
#[inline(always)]
fn advance<const N: usize>(values: &mut [i32; N], changes: &[i32; N], pixels: i32) {
    if N > MAX_IN_REGISTERS {
        advance_outlined(values, changes, pixels)
    } else {
        advance_inlined(values, changes, pixels)
    }
}

#[inline(never)]
fn step_outlined<const N: usize>(values: &mut [i32; N], changes: &[i32; N]) {
    advance_inlined(values, changes, 1);
}

#[inline(never)]
fn advance_outlined<const N: usize>(values: &mut [i32; N], changes: &[i32; N], pixels: i32) {
    advance_inlined(values, changes, pixels);
}

/// Adds `pixels` times `changes`, value by value without a loop: at `opt-level = "s"`, a loop would stay a loop, and
/// its values would go through memory.
#[inline(always)]
fn advance_inlined<const N: usize>(values: &mut [i32; N], changes: &[i32; N], pixels: i32) {
    let (values, changes) = (values.as_mut_slice(), changes.as_slice());
    if !matches!(N, 1..=8) {
        for (value, change) in values.iter_mut().zip(changes) {
            *value = value.wrapping_add(change.wrapping_mul(pixels));
        }
        return;
    }
    advance_one(values, changes, pixels, 0);
    advance_one(values, changes, pixels, 1);
    advance_one(values, changes, pixels, 2);
    advance_one(values, changes, pixels, 3);
    advance_one(values, changes, pixels, 4);
    advance_one(values, changes, pixels, 5);
    advance_one(values, changes, pixels, 6);
    advance_one(values, changes, pixels, 7);
}

/// Advances value `k`, if there is one.
#[inline(always)]
fn advance_one(values: &mut [i32], changes: &[i32], pixels: i32, k: usize) {
    if let (Some(value), Some(change)) = (values.get_mut(k), changes.get(k)) {
        *value = value.wrapping_add(change.wrapping_mul(pixels));
    }
}

/// Varyings of which the first `P` are perspective-correct, and the others linear on the screen. `N` is one more than
/// the number of both, because the pipeline keeps 1 / w in the last place.
///
/// Perspective-correct values may differ by less than 2³⁰ over a triangle. They are within 2⁻¹² of the largest
/// difference (and half a unit) of the exact value if each pixel is divided.
///
/// # Sub-spans
///
/// A [`Shader::STEP`](crate::span::Shader::STEP) of more than 1 divides at the columns of the screen that are multiples
/// of it, and takes values as linear in between. Where q = 1 / w, or a value times q, changes by more than an eighth of
/// q from one of these columns to the next, half of the step is taken, and so on. So a value is never off by more than
/// 1/34 of its change over the step: by half a pixel at a step of 16. Triangles that are narrower than some 16 pixels,
/// and values that differ by 2²⁶ or more over the triangle (1,024 repeats of a texture), are divided at each pixel.
///
/// A value depends on the triangle's plane and on the pixel. What cuts the triangle (the screen, a viewport, strips, a
/// framebuffer's short rows) moves nothing. A clip plane moves values by what the rounding of its corners to 1/256 px
/// does, and only within the parts that are that narrow from linear to exact ones.
///
/// The worst error, in texels, of a wall that shows 256 texels and nearly fills a screen of 300 × 240 px, seen at an
/// angle to its normal:
///
/// | step | 0° | 60° | 75° | 85° |
/// |--:|--:|--:|--:|--:|
/// | 1 | 0.01 | 0.02 | 0.02 | 0.02 |
/// | 4 | 0.02 | 0.2 | 0.6 | 1.2 |
/// | 8 | 0.03 | 0.7 | 1.3 | 1.2 |
/// | 16 | 0.05 | 1.2 | 1.3 | 1.2 |
/// | 32 | 0.1 | 1.2 | 1.3 | 1.2 |
///
/// Steps are rounded to whole units per pixel, so values should have some 16 fractional bits.
///
/// ```
/// use zstrip::vertex::Perspective;
/// // Two texture coordinates, and a brightness that is linear on the screen.
/// let varyings = Perspective::<2, 4>::new([1 << 16, 2 << 16], [255 << 16]);
/// assert_eq!(varyings.corrected(), [1 << 16, 2 << 16]);
/// assert_eq!(varyings.linear(), [255 << 16]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Perspective<const P: usize, const N: usize>([i32; N]);

impl<const P: usize, const N: usize> Perspective<P, N> {
    /// Makes varyings from the perspective-correct values and the linear ones.
    #[inline]
    #[must_use]
    pub const fn new<const L: usize>(corrected: [i32; P], linear: [i32; L]) -> Self {
        const { assert!(P > 0 && P + L + 1 == N, "N is one more than all varyings, for 1 / w") };
        let mut all = [0; N];
        // One by one: at `opt-level = "s"`, a loop would stay a loop, and go through memory.
        let mut k = 0;
        macro_rules! put {
            ($($more:ident)*) => { $(
                let $more = k;
                if $more < N {
                    all[$more] = value::<P, L>(&corrected, &linear, $more);
                }
                k = $more + 1;
            )* };
        }
        put!(a b c d e f g h);
        while k < N {
            all[k] = value::<P, L>(&corrected, &linear, k);
            k += 1;
        }
        Self(all)
    }

    /// Returns the perspective-correct values.
    #[inline]
    #[must_use]
    pub fn corrected(&self) -> [i32; P] {
        self.0.first_chunk().copied().unwrap_or([0; P])
    }

    /// Returns the values that are linear on the screen.
    #[inline]
    #[must_use]
    pub fn linear(&self) -> &[i32] {
        self.0.get(P..N - 1).unwrap_or_default()
    }
}

/// Returns value `k` of the perspective-correct values and the linear ones; 0 beyond them.
#[inline(always)]
const fn value<const P: usize, const L: usize>(corrected: &[i32; P], linear: &[i32; L], k: usize) -> i32 {
    if k < P {
        corrected[k]
    } else if k - P < L {
        linear[k - P]
    } else {
        0
    }
}

impl<const P: usize, const N: usize> AsRef<[i32]> for Perspective<P, N> {
    #[inline]
    fn as_ref(&self) -> &[i32] {
        &self.0
    }
}

impl<const P: usize, const N: usize> AsMut<[i32]> for Perspective<P, N> {
    #[inline]
    fn as_mut(&mut self) -> &mut [i32] {
        &mut self.0
    }
}

impl<const P: usize, const N: usize> Varyings for Perspective<P, N> {
    #[inline(always)]
    fn step(&mut self, change: &Self) {
        step(&mut self.0, &change.0);
    }

    #[inline(always)]
    fn advance(&mut self, change: &Self, pixels: i32) {
        advance(&mut self.0, &change.0, pixels);
    }

    const LEN: usize = N;
    const ZERO: Self = Self([0; N]);
    const PERSPECTIVE: usize = P;
    type PerspectiveSetup = PerspectivePlanes<P>;
}

/// Data about a triangle's perspective that its fragments need to correct varyings. It is computed once per triangle.
pub trait PerspectiveSetup: Copy + Debug {
    /// Setup of a triangle whose varyings are all linear on the screen.
    const NONE: Self;

    /// Returns the amount of perspective to correct.
    fn class(&self) -> PerspectiveClass;

    /// Returns the least q = 1 / w for which varyings may be taken as linear between two columns of the screen that
    /// are the shader's step apart: it has to be reached at both. Half of it does for half the step, and so on.
    /// `u32::MAX` means that varyings are divided at each pixel of this triangle; other values are below 2³¹.
    fn least_straight(&self) -> u32;

    /// Sets what [`least_straight`](Self::least_straight) returns.
    fn set_least_straight(&mut self, q: u32);

    /// Returns the class, the plane of 1 / w in 64 bits, and the planes of perspective-correct varyings; `None` if no
    /// varying is perspective-correct.
    fn parts_mut(&mut self) -> Option<(&mut PerspectiveClass, &mut Plane64, &mut [PerspectivePlane])>;

    /// Returns the planes of perspective-correct varyings.
    fn planes(&self) -> &[PerspectivePlane];

    /// Returns the plane of 1 / w in 64 bits, which is set where the class is [`Planes64`](PerspectiveClass::Planes64).
    fn inverse_w64(&self) -> Plane64;
}

impl PerspectiveSetup for () {
    const NONE: Self = ();

    #[inline(always)]
    fn class(&self) -> PerspectiveClass {
        PerspectiveClass::Affine
    }

    #[inline(always)]
    fn least_straight(&self) -> u32 {
        u32::MAX
    }

    #[inline(always)]
    fn set_least_straight(&mut self, _: u32) {}

    #[inline(always)]
    fn parts_mut(&mut self) -> Option<(&mut PerspectiveClass, &mut Plane64, &mut [PerspectivePlane])> {
        None
    }

    #[inline(always)]
    fn planes(&self) -> &[PerspectivePlane] {
        &[]
    }

    #[inline(always)]
    fn inverse_w64(&self) -> Plane64 {
        Plane64::ZERO
    }
}

/// Amount of perspective in a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PerspectiveClass {
    /// There is so little perspective that varyings are linear on the screen.
    #[default]
    Affine,
    /// Varyings have to be divided, and planes in 32 bits are exact enough to do so.
    Planes32,
    /// Varyings have to be divided, and this takes planes in 64 bits.
    Planes64,
}

/// A plane with 32 more fractional bits than [`PlaneEquation`](crate::raster::PlaneEquation), modulo 2⁶⁴: its value at
/// the screen's corner, and its changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Plane64 {
    /// The value at the pixel in the screen's top left corner.
    pub base: i64,
    /// Change from one pixel to the next on the right.
    pub dx: i64,
    /// Change from one row to the next.
    pub dy: i64,
}

impl Plane64 {
    /// Zero everywhere.
    pub const ZERO: Self = Self { base: 0, dx: 0, dy: 0 };

    /// Returns the value at a pixel.
    pub(crate) const fn at(&self, (x, y): (i32, i32)) -> i64 {
        self.base.wrapping_add(self.dx.wrapping_mul(x as i64)).wrapping_add(self.dy.wrapping_mul(y as i64))
    }
}

/// A perspective-correct varying on a triangle: its value is `base` + (h >> `shift`), where h is interpolated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PerspectivePlane {
    /// The value at the first vertex.
    pub base: i32,
    /// Number of bits by which differences from `base` are scaled up, so that the largest is in 2²⁷..2²⁸, or in
    /// 2²⁵..2²⁶ where varyings are divided every few columns only.
    pub shift: u32,
    /// The plane of h / w, set where the class is [`Planes64`](PerspectiveClass::Planes64).
    pub wide: Plane64,
}

/// The [`PerspectiveSetup`] for `P` perspective-correct varyings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PerspectivePlanes<const P: usize> {
    class: PerspectiveClass,
    /// Complement of `least_straight`: so all of [`NONE`](PerspectiveSetup::NONE) is zero, and no program links the
    /// copying of a constant for it.
    crooked: u32,
    inverse_w64: Plane64,
    planes: [PerspectivePlane; P],
}

impl<const P: usize> PerspectiveSetup for PerspectivePlanes<P> {
    const NONE: Self = Self {
        class: PerspectiveClass::Affine,
        crooked: 0,
        inverse_w64: Plane64::ZERO,
        planes: [PerspectivePlane { base: 0, shift: 0, wide: Plane64::ZERO }; P],
    };

    #[inline]
    fn class(&self) -> PerspectiveClass {
        self.class
    }

    #[inline]
    fn least_straight(&self) -> u32 {
        !self.crooked
    }

    #[inline]
    fn set_least_straight(&mut self, q: u32) {
        self.crooked = !q;
    }

    #[inline]
    fn parts_mut(&mut self) -> Option<(&mut PerspectiveClass, &mut Plane64, &mut [PerspectivePlane])> {
        Some((&mut self.class, &mut self.inverse_w64, &mut self.planes))
    }

    #[inline]
    fn planes(&self) -> &[PerspectivePlane] {
        &self.planes
    }

    #[inline]
    fn inverse_w64(&self) -> Plane64 {
        self.inverse_w64
    }
}
