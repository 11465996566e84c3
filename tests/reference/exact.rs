//! Exact coverage, depth and attributes of one triangle: the definition, in integers.
//!
//! In: vertices in 1/256 px, x right, y down. Out: yes or no per sample, and values as fractions of two `i128`. Nothing is
//! rounded, stepped or bounded by a box here that a reader could not check against the formulas on paper.
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

/// Value at `sample` of the plane through `values` at the vertices, as `(numerator, denominator)`, denominator positive.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(tri: Triangle, width: u32, height: u32) -> String {
        let mut rows = vec![vec!['.'; width as usize]; height as usize];
        for_each_pixel(tri, width, height, |x, y| {
            rows[y as usize][x as usize] = '#';
        });
        let rows: Vec<String> = rows.iter().map(|row| row.iter().collect()).collect();
        rows.join("\n")
    }

    #[test]
    fn top_and_left_edges_own_their_samples() {
        // Corners on the centres of (1,1), (4,1), (1,4): left and top edges count, the diagonal does not.
        let tri = [center(1, 1), center(4, 1), center(1, 4)];
        assert_eq!(picture(tri, 5, 5), ".....\n.###.\n.##..\n.#...\n.....");
        // The other half of the square gets the diagonal; its right and bottom edges are left out.
        let other = [center(4, 1), center(4, 4), center(1, 4)];
        assert_eq!(picture(other, 5, 5), ".....\n.....\n...#.\n..##.\n.....");
    }

    #[test]
    fn winding_and_first_vertex_do_not_matter() {
        let tri = [[130, 128], [1100, 384], [384, 1152]];
        let expected = picture(tri, 6, 6);
        let [a, b, c] = tri;
        for same in [[b, c, a], [c, a, b], [a, c, b], [c, b, a], [b, a, c]] {
            assert_eq!(picture(same, 6, 6), expected, "{same:?}");
        }
    }

    #[test]
    fn zero_area_covers_nothing() {
        assert!(!covers([center(0, 0); 3], 0, 0));
        assert!(!covers([center(0, 0), center(2, 2), center(4, 4)], 1, 1));
    }

    #[test]
    fn box_does_not_lose_pixels() {
        let tri = [[-700, -900], [1700, 300], [200, 1500]];
        let mut found = Vec::new();
        for_each_pixel(tri, 7, 7, |x, y| found.push((x, y)));
        let all = (0..7).flat_map(|y| (0..7).map(move |x| (x, y)));
        let expected: Vec<(u32, u32)> = all.filter(|&(x, y)| covers(tri, x.into(), y.into())).collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn depth_is_the_plane_and_halves_go_up() {
        let tri = [center(0, 0), center(4, 0), center(0, 4)];
        assert_eq!(depth_rounded(tri, [10, 50, 10], 1, 0), 20);
        assert_eq!(depth_rounded(tri, [10, 50, 10], 4, 0), 50);
        // Half way between 0 and 1, and between -1 and 0.
        assert_eq!(depth_rounded(tri, [0, 1, 0], 2, 0), 1);
        assert_eq!(round_half_up((-1, 2)), 0);
        assert_eq!(round_half_up((-3, 2)), -1);
        let [a, b, c] = tri;
        assert_eq!(depth_rounded([a, c, b], [10, 10, 50], 1, 0), 20);
    }

    #[test]
    fn equal_w_makes_perspective_affine() {
        let tri = [[3, 9], [2000, 77], [140, 1777]];
        let at = center(2, 2);
        let (n, d) = perspective_at(tri, [5, 5, 5], [-8, 90, 41], at);
        let (an, ad) = affine_at(tri, [-8, 90, 41], at);
        assert_eq!(n * ad, an * d);
        // Half way on screen between w = 1 and w = 3 is a quarter of the way in space.
        let tri = [[0, 0], [512, 0], [0, 512]];
        let (n, d) = perspective_at(tri, [1, 3, 1], [0, 100, 0], [256, 0]);
        assert_eq!(n, 25 * d);
    }
}
