//! Random scenes in integers, for property tests: clip-space soups with every unpleasant vertex, screen
//! triangles, slivers and depth-tested heaps. [`meshes`](super::meshes) has those that share vertices.
//!
//! Clip coordinates are raw 16.16 numbers, screen coordinates are 1/256 px, y down. All randomness comes from the
//! [`Rng`] the caller passes, so the seed is the scene.

use super::rng::Rng;

/// x, y, z, w as raw 16.16 numbers, clip-space y up.
pub type ClipVertex = [i32; 4];

/// What is special about a clip-space triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClipKind {
    /// Inside the view volume, at most a few px.
    Tiny,
    /// Inside the view volume, of any size.
    Visible,
    /// In front of the eye, far beyond the sides of the view volume.
    Huge,
    /// One or two vertices behind the near plane, w positive or negative.
    CrossingNear,
    /// One or two vertices beyond the far plane.
    CrossingFar,
    /// All vertices behind the eye.
    BehindEye,
    /// A vertex with w exactly 0, its other coordinates anything.
    ZeroW,
    /// A vertex (0, 0, 0, 0).
    Origin,
    /// Coordinates of any magnitude, many of them 0, ±1, or the ends of the i32 range.
    Extreme,
    /// Two equal vertices, or three on a line.
    Degenerate,
}

impl ClipKind {
    pub const ALL: [ClipKind; 10] = [
        ClipKind::Tiny,
        ClipKind::Visible,
        ClipKind::Huge,
        ClipKind::CrossingNear,
        ClipKind::CrossingFar,
        ClipKind::BehindEye,
        ClipKind::ZeroW,
        ClipKind::Origin,
        ClipKind::Extreme,
        ClipKind::Degenerate,
    ];
}

/// A vertex with `|x|, |y| <= spread * w / 16` and 0 <= z <= w, w from 1/16 to 128.
fn vertex_in_front(rng: &mut Rng, spread: i32) -> ClipVertex {
    let shift = rng.below(11) as u32;
    let w = rng.between(1 << 12, 1 << 13) << shift;
    let side = (i64::from(w) * i64::from(spread) / 16).min(1 << 30) as i32;
    [rng.between(-side, side), rng.between(-side, side), rng.between(0, w), w]
}

/// A number that breaks careless arithmetic.
fn extreme(rng: &mut Rng) -> i32 {
    match rng.below(4) {
        0 => rng.pick(&[0, 1, -1, i32::MIN, i32::MIN + 1, i32::MAX, i32::MAX - 1, 1 << 16, -(1 << 16)]),
        _ => rng.any_magnitude(31),
    }
}

/// One clip-space triangle of the given kind.
pub fn clip_triangle(rng: &mut Rng, kind: ClipKind) -> [ClipVertex; 3] {
    let mut tri = [(); 3].map(|()| vertex_in_front(rng, 16));
    let which = rng.below(3) as usize;
    match kind {
        ClipKind::Visible => {}
        ClipKind::Tiny => {
            let [x, y, z, w] = tri[0];
            // About 1/100 of the view volume: a px or two on the small screens of the tests.
            let step = w / 100;
            let mut near = || [x + rng.between(-step, step), y + rng.between(-step, step), z, w];
            tri = [tri[0], near(), near()];
        }
        ClipKind::Huge => tri = [(); 3].map(|()| vertex_in_front(rng, 16 * 1000)),
        ClipKind::CrossingNear => {
            for i in [which, (which + rng.below(2) as usize) % 3] {
                let w = rng.between(-(1 << 20), 1 << 16);
                tri[i][2] = rng.between(-(1 << 20), -1);
                tri[i][3] = w;
            }
        }
        ClipKind::CrossingFar => {
            for i in [which, (which + rng.below(2) as usize) % 3] {
                tri[i][2] = tri[i][3] + rng.between(1, 1 << 20);
            }
        }
        ClipKind::BehindEye => tri = tri.map(|[x, y, z, w]| [x, y, -z, -w]),
        ClipKind::ZeroW => {
            tri[which] = [(); 4].map(|()| rng.any_magnitude(24));
            tri[which][3] = 0;
        }
        ClipKind::Origin => tri[which] = [0; 4],
        ClipKind::Extreme => tri = [(); 3].map(|()| [(); 4].map(|()| extreme(rng))),
        ClipKind::Degenerate => {
            let next = tri[(which + 1) % 3];
            let last = tri[(which + 2) % 3];
            // Equal, or the exact middle: halves are integers because both ends are made even.
            tri[which] = next;
            if rng.one_in(2) {
                let even = [next, last].map(|v| v.map(|c| c & !1));
                tri[(which + 1) % 3] = even[0];
                tri[(which + 2) % 3] = even[1];
                tri[which] = std::array::from_fn(|i| even[0][i] / 2 + even[1][i] / 2);
            }
        }
    }
    tri
}

/// `count` clip-space triangles of all kinds.
pub fn clip_soup(rng: &mut Rng, count: usize) -> Vec<[ClipVertex; 3]> {
    let triangle = |_| {
        let kind = rng.pick(&ClipKind::ALL);
        clip_triangle(rng, kind)
    };
    (0..count).map(triangle).collect()
}

/// A screen-space triangle of any size and position about a `width` x `height` viewport, within ±32,767 px.
///
/// Half of them lie on the grid of pixel centres and corners, where ties are.
pub fn screen_triangle(rng: &mut Rng, width: u32, height: u32) -> [[i32; 2]; 3] {
    let reach = rng.between(1, 23);
    let grid = rng.pick(&[1, 16, 128, 128]);
    let center = [width, height].map(|size| rng.between(0, 256 * size as i32));
    let limit = 32_767 * 256;
    [(); 3].map(|()| {
        center.map(|c| {
            let offset = rng.between(-(1 << reach), 1 << reach);
            ((c + offset) / grid * grid).clamp(-limit / grid * grid, limit / grid * grid)
        })
    })
}

/// A triangle about 1/16 px to a px thin, across a `width` x `height` viewport.
pub fn sliver(rng: &mut Rng, width: u32, height: u32) -> [[i32; 2]; 3] {
    let [w, h] = [width, height].map(|size| 256 * size as i32);
    let mut point = || [rng.between(-w / 8, w + w / 8), rng.between(-h / 8, h + h / 8)];
    let (a, b) = (point(), point());
    let c = [b[0] + rng.between(-128, 128), b[1] + rng.between(-128, 128)];
    [a, b, c]
}

/// Triangles with depth codes in draw order, overlapping and crossing each other.
pub fn depth_soup(rng: &mut Rng, count: usize, width: u32, height: u32) -> Vec<([[i32; 2]; 3], [u16; 3])> {
    let triangle = |_| {
        let tri = screen_triangle(rng, width, height);
        let z = match rng.below(3) {
            0 => [rng.between(0, 65535) as u16; 3],
            1 => [(); 3].map(|()| rng.pick(&[0, 32768, 65534, 65535])),
            _ => [(); 3].map(|()| rng.between(0, 65535) as u16),
        };
        (tri, z)
    };
    (0..count).map(triangle).collect()
}
