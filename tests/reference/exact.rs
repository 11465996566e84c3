//! Exact coverage, depth and attributes of one triangle: the definition, in integers.
//!
//! In: vertices in 1/256 px, x right, y down. Out: yes or no per sample, and values as fractions of two `i128`. Nothing
//! is rounded, stepped or bounded by a box here that a reader could not check against the formulas on paper.
//!
//! # Format
//! Coordinates may use 32 bits (±2^31 units) and integer attributes 32 bits: areas stay below 2^66 and numerators below
//! 2^100. [`perspective_at`] multiplies by two more factors and wants each w below 2^24.

/// A position in 1/256 px.
pub type Point = [i64; 2];

/// Three vertices in either winding.
pub type Triangle = [Point; 3];

/// The centre of pixel `(px, py)`.
pub fn center(px: i64, py: i64) -> Point {
    [256 * px + 128, 256 * py + 128]
}

/// Widens vertices from the 24.8 numbers a rasterizer holds.
pub fn widen(v: [[i32; 2]; 3]) -> Triangle {
    v.map(|p| p.map(i64::from))
}

/// Signed edge function of `a -> b` at `p`: twice the area of `a b p` in 1/65536 px².
///
/// Positive if `a b p` is clockwise on screen (y down).
pub fn edge(a: Point, b: Point, p: Point) -> i128 {
    let [ax, ay] = a.map(i128::from);
    let [bx, by] = b.map(i128::from);
    let [px, py] = p.map(i128::from);
    (bx - ax) * (py - ay) - (by - ay) * (px - ax)
}

/// Twice the signed area of `tri`; positive if it is clockwise on screen, which is a back face.
pub fn area2(tri: Triangle) -> i128 {
    edge(tri[0], tri[1], tri[2])
}

/// True if the pixel centre `(px, py)` is covered; see [`covers_at`].
pub fn covers(tri: Triangle, px: i64, py: i64) -> bool {
    covers_at(tri, center(px, py))
}

/// Places of the four samples of a pixel, in 1/256 px from its top left corner.
pub const STANDARD_SAMPLES: [Point; 4] = [[96, 32], [224, 96], [32, 160], [160, 224]];

/// True if `sample` is inside `tri`, or on an edge that owns its points.
///
/// ```text
///     a ───top───> b        Walking clockwise on screen, the inside is on the right hand:
///      ^          /         a top edge goes right (dy = 0, dx > 0),
///    left     right         a left edge goes up (dy < 0).
///        \    v             Those two own their points; right and bottom edges do not.
///          c
/// ```
/// The winding does not matter, and a triangle of zero area covers nothing.
pub fn covers_at(tri: Triangle, sample: Point) -> bool {
    let [a, b, c] = match area2(tri).signum() {
        0 => return false,
        1 => tri,
        _ => [tri[0], tri[2], tri[1]],
    };
    [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let owns_points = dy < 0 || (dy == 0 && dx > 0);
        match edge(from, to, sample).signum() {
            0 => owns_points,
            sign => sign > 0,
        }
    })
}

/// Calls `hit(x, y)` once for every covered pixel of a `width` x `height` viewport, row by row.
pub fn for_each_pixel(tri: Triangle, width: u32, height: u32, mut hit: impl FnMut(u32, u32)) {
    // Rows and columns outside the bounding box hold no sample of the triangle; `+ 1` only makes the box larger.
    let range = |axis: usize, size: u32| {
        let low = tri.iter().map(|p| p[axis]).min().unwrap_or(0);
        let high = tri.iter().map(|p| p[axis]).max().unwrap_or(0);
        let end = high.div_euclid(256) + 1;
        low.div_euclid(256).clamp(0, size.into())..end.clamp(0, size.into())
    };
    for y in range(1, height) {
        for x in range(0, width) {
            if covers(tri, x, y) {
                hit(x as u32, y as u32);
            }
        }
    }
}

/// Barycentric weights of `sample` and their sum: `weight[i] / sum` belongs to vertex `i`.
///
/// The sum is positive; weights are negative outside the triangle.
///
/// # Panics
/// If the triangle has no area.
pub fn barycentric_at(tri: Triangle, sample: Point) -> ([i128; 3], i128) {
    let area = area2(tri);
    assert!(area != 0, "a triangle without area has no plane");
    let weight = |i: usize| edge(tri[(i + 1) % 3], tri[(i + 2) % 3], sample) * area.signum();
    ([weight(0), weight(1), weight(2)], area.abs())
}

/// Value at `sample` of the plane through `values` at the vertices, as `(numerator, denominator)`, denominator
/// positive.
///
/// # Panics
/// If the triangle has no area.
pub fn affine_at(tri: Triangle, values: [i64; 3], sample: Point) -> (i128, i128) {
    let (weights, sum) = barycentric_at(tri, sample);
    let numerator = (0..3).map(|i| weights[i] * i128::from(values[i])).sum();
    (numerator, sum)
}

/// Depth plane at the centre of pixel `(px, py)`, as `(numerator, denominator)`, denominator positive.
///
/// # Panics
/// If the triangle has no area.
pub fn depth_at(tri: Triangle, z: [i64; 3], px: i64, py: i64) -> (i128, i128) {
    affine_at(tri, z, center(px, py))
}

/// [`depth_at`], rounded to the nearest integer, halves up.
///
/// # Panics
/// If the triangle has no area.
pub fn depth_rounded(tri: Triangle, z: [i64; 3], px: i64, py: i64) -> i64 {
    round_half_up(depth_at(tri, z, px, py))
}

/// Nearest integer of `numerator / denominator`, halves towards +infinity. The denominator must be positive.
pub fn round_half_up((numerator, denominator): (i128, i128)) -> i64 {
    (2 * numerator + denominator).div_euclid(2 * denominator) as i64
}

/// Perspective-correct value at `sample`: `sum(b u / w) / sum(b / w)` with screen barycentrics `b`, as a fraction.
///
/// The denominator is positive wherever `sample` is inside the triangle.
///
/// # Panics
/// If the triangle has no area, or a w is not in `1..2^24`.
pub fn perspective_at(tri: Triangle, w: [i64; 3], u: [i64; 3], sample: Point) -> (i128, i128) {
    assert!(w.iter().all(|w| (1..1 << 24).contains(w)), "w in 1..2^24");
    let (weights, _) = barycentric_at(tri, sample);
    // b / w without the division: multiply everything by w0 w1 w2.
    let over_w = |i: usize| weights[i] * i128::from(w[(i + 1) % 3]) * i128::from(w[(i + 2) % 3]);
    let numerator = (0..3).map(|i| over_w(i) * i128::from(u[i])).sum();
    (numerator, (0..3).map(over_w).sum())
}

/// A fraction as the nearest f64 or its neighbour, for comparison with approximate results.
pub fn to_f64((numerator, denominator): (i128, i128)) -> f64 {
    numerator as f64 / denominator as f64
}
