//! The plain loop over the pixels of a span, and the one comparison of all faster loops with it. For tests only.

use super::depth::DepthTest;
use crate::math::random::Rng;
use core::fmt::Debug;
use std::vec::Vec;

/// Draws a span pixel by pixel. `pixel` returns the colour of the k-th pixel, or `None` if its fragment is discarded.
pub(super) fn draw<R, D: DepthTest>(
    test: D,
    color: &mut [R],
    depth: &mut [D::Depth],
    mut z: u32,
    dz_dx: i32,
    pixel: impl Fn(usize) -> Option<R>,
) {
    for (k, (color, stored)) in color.iter_mut().zip(depth).enumerate() {
        let depth = (z >> 16) as u16;
        if test.passes(depth, *stored) {
            if let Some(pixel) = pixel(k) {
                test.write(depth, stored);
                *color = pixel;
            }
        }
        z = z.wrapping_add_signed(dz_dx);
    }
}

/// A loop that is compared with the plain one: its name, and a function that draws over colours and stored depths.
pub(super) type Variant<'v, R, Z> = (&'v str, &'v mut dyn FnMut(&mut [R], &mut [Z]));

/// Span that is drawn over `background`. Its depth at the first pixel is `z`, and changes by `dz_dx` per pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Case<R> {
    pub length: usize,
    pub z: u32,
    pub dz_dx: i32,
    pub background: R,
}

/// Panics unless all variants leave the colours and depths that the plain loop leaves. The stored depths are random:
/// all, most or few of the pixels are in front of them.
pub(super) fn compare<R: Copy + PartialEq + Debug, D: DepthTest<Depth: PartialEq + Debug>>(
    test: D,
    case: Case<R>,
    rng: &mut Rng,
    stored: impl Fn(u16) -> D::Depth,
    pixel: impl Fn(usize) -> Option<R>,
    variants: &mut [Variant<'_, R, D::Depth>],
) {
    let Case { length, z, dz_dx, background } = case;
    let hidden = [0, 1, 5, 13][rng.below(4) as usize];
    let depths: Vec<D::Depth> =
        (0..length).map(|k| stored(if rng.below(16) < hidden { 100 } else { 60_000 - k as u16 % 9 })).collect();
    #[expect(clippy::type_complexity, reason = "used once")]
    let run = |draw: &mut dyn FnMut(&mut [R], &mut [D::Depth])| {
        let (mut color, mut depth) = (std::vec![background; length], depths.clone());
        draw(&mut color, &mut depth);
        (color, depth)
    };
    let expected = run(&mut |color, depth| draw(test, color, depth, z, dz_dx, &pixel));
    for (name, variant) in variants {
        let found = run(variant);
        assert!(found == expected, "{name}, {length} pixels from depth {z}, {dz_dx}:\n{found:?}\n{expected:?}");
    }
}
