//! Square roots without a divider.

/// Returns the square root, rounded down.
///
/// It is found bit by bit. This is less code than `u32::isqrt`, whose table and divisions small programs need not
/// link.
pub const fn isqrt(square: u32) -> u32 {
    let (mut rest, mut root, mut bit) = (square, 0, 1 << 30);
    while bit != 0 {
        // `step` is the amount by which (root + bit)² exceeds root². All of it is shifted up by the number of bits
        // still to come.
        let step = root + bit;
        root >>= 1;
        if rest >= step {
            rest -= step;
            root += bit;
        }
        bit >>= 2;
    }
    root
}

#[cfg(test)]
mod tests {
    use super::isqrt;

    #[test]
    fn roots_are_those_of_the_standard_library() {
        let around =
            (0..=u32::from(u16::MAX)).flat_map(|root| [(root * root).wrapping_sub(1), root * root, root * root + 1]);
        for square in around.chain([u32::MAX, 3 << 30]) {
            assert_eq!(isqrt(square), square.isqrt(), "{square}");
        }
    }
}
