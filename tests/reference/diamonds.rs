//! The diamond-exit rule by its definition: every pixel's diamond against the line, with symbolic ties.
//!
//! In: end points in 1/256 px, x right, y down. Out: the pixels drawn, in drawing order. Both end points are moved by
//! (-e, -e^2) with an infinitesimal e: numbers are polynomials in e, compared term by term. Nothing is rounded.

/// `n0 + n1 e + n2 e^2`, ordered as e becomes smaller than everything: lexicographically.
type Number = [i128; 3];

fn scaled(n: Number, factor: i128) -> Number {
    n.map(|c| c * factor)
}

/// One border of a diamond as a function along the line: `at(t) = start + t slope`, positive inside.
struct Border {
    start: Number,
    slope: i128,
}

/// The borders of pixel `(px, py)`'s diamond: 128 - (±x ± y) about its centre.
fn borders(a: [i128; 2], b: [i128; 2], px: i128, py: i128) -> [Border; 4] {
    let (x, y) = (a[0] - (256 * px + 128), a[1] - (256 * py + 128));
    [(1, 1), (1, -1), (-1, 1), (-1, -1)].map(|(sx, sy)| Border {
        // x - e and y - e^2.
        start: [128 - sx * x - sy * y, sx, sy],
        slope: -(sx * (b[0] - a[0]) + sy * (b[1] - a[1])),
    })
}

/// Whether the line from `a` to `b` draws the pixel: it meets the open diamond, and does not end in it.
pub fn draws(a: [i32; 2], b: [i32; 2], px: i32, py: i32) -> bool {
    let borders = borders(a.map(i128::from), b.map(i128::from), px.into(), py.into());
    let end = |border: &Border| [border.start[0] + border.slope, border.start[1], border.start[2]];
    if borders.iter().all(|border| end(border) > [0; 3]) {
        return false;
    }
    // t must be above 0 (or at it) and above -start / slope for positive slopes, below 1 and the others, as fractions.
    let (mut low, mut high) = (vec![([0; 3], 1)], vec![([1, 0, 0], 1)]);
    for border in &borders {
        match border.slope.signum() {
            0 if border.start <= [0; 3] => return false,
            0 => {}
            1 => low.push((scaled(border.start, -1), border.slope)),
            _ => high.push((border.start, -border.slope)),
        }
    }
    low.iter().all(|(n, d)| high.iter().all(|(m, e)| scaled(*n, *e) < scaled(*m, *d)))
}

/// All pixels in columns and rows of the line's neighbourhood, in drawing order.
pub fn pixels(a: [i32; 2], b: [i32; 2]) -> Vec<(i32, i32)> {
    let range = |k: usize| (a[k].min(b[k]) >> 8) - 1..=(a[k].max(b[k]) >> 8) + 1;
    let mut found = Vec::new();
    for y in range(1) {
        found.extend(range(0).filter(|&x| draws(a, b, x, y)).map(|x| (x, y)));
    }
    // One pixel for each step along the major axis.
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    found.sort_by_key(|&(x, y)| if dx.abs() >= dy.abs() { x * dx.signum() } else { y * dy.signum() });
    found
}
