//! From clip space to pixels without a clipper: 2-D homogeneous rasterization in f64.
//!
//! In: clip-space vertices (any w, also zero and negative) with attributes. Out: per pixel, whether the visible part of
//! the triangle covers its centre, and depth and attributes there. As nothing is clipped, divided or snapped, this
//! agrees with a clipping rasterizer everywhere except within its rounding of an edge; [`Sample::margin`] says how far
//! away that is.
//!
//! ```text
//! P[i] = (X, Y, w)           vertex in screen space, before the divide
//! e[i] = P[i+1] x P[i+2]     edge opposite to vertex i: a line (a, b, c), value a*px + b*py + c
//! det  = P[0] . e[0]         its sign is the facing; e[i] is multiplied by it, so that inside is positive
//! b[i] = e[i] / |det|        then sum(b[i] * P[i]) = (px, py, 1)
//!
//! 1/w   = sum(b[i])          so b >= 0 implies w > 0
//! z/w   = sum(b[i] * z[i])   0 <= z/w <= 1 are two more lines: near and far, per pixel
//! u     = sum(b[i] * u[i]) / sum(b[i])
//! ```
//!
//! # Source
//! Olano & Greer 1997, "Triangle Scan Conversion using 2D Homogeneous Coordinates".

pub use super::frame::{Cull, Frame};

/// A clip-space vertex with `K` attributes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex<const K: usize> {
    /// x, y, z, w; visible where w > 0 and 0 <= z <= w.
    pub position: [f64; 4],
    pub attributes: [f64; K],
}

/// Where clip space lands on screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewport {
    pub x: f64,
    pub y: f64,
    pub width: f64,
    pub height: f64,
    /// False: y = w is the top row, as in a right-handed pipeline. True: y = w is the bottom row.
    pub clip_y_down: bool,
}

impl Viewport {
    /// A viewport from (0, 0), with clip-space y up.
    pub fn new(width: u32, height: u32) -> Self {
        Self { x: 0.0, y: 0.0, width: width.into(), height: height.into(), clip_y_down: false }
    }

    /// Screen position times w, and w.
    pub fn screen_position(&self, [x, y, _, w]: [f64; 4]) -> [f64; 3] {
        let y = if self.clip_y_down { y } else { -y };
        [(x + w) * (self.width / 2.0) + self.x * w, (y + w) * (self.height / 2.0) + self.y * w, w]
    }
}

/// What one triangle is at one pixel centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<const K: usize> {
    pub x: u32,
    pub y: u32,
    pub covered: bool,
    /// Counter-clockwise on screen (y up).
    pub front: bool,
    /// Distance in px by which the decision on `covered` is safe; never more than the true distance.
    pub margin: f64,
    /// The same for the second nearest border. The visible part of the triangle is narrow where this is small too.
    pub second_margin: f64,
    /// z/w.
    pub depth: f64,
    pub inv_w: f64,
    /// Attributes, linear in space: a/w over 1/w.
    pub perspective: [f64; K],
    /// Attributes, linear on screen. What a renderer without a clipper interpolates; only for triangles with all w > 0.
    pub linear: [f64; K],
}

/// An affine function of the pixel position, with a bound of its rounding error.
#[derive(Clone, Copy)]
struct Line {
    coefficients: [f64; 3],
    /// Sums of the magnitudes that went into each coefficient.
    magnitudes: [f64; 3],
}

impl Line {
    /// More than the relative error of any sum of products built here.
    const ROUNDING: f64 = 16.0 * f64::EPSILON;

    fn through(p: [f64; 3], q: [f64; 3]) -> Self {
        let minor = |i: usize, j: usize| (p[i] * q[j] - p[j] * q[i], (p[i] * q[j]).abs() + (p[j] * q[i]).abs());
        let minors = [minor(1, 2), minor(2, 0), minor(0, 1)];
        Self { coefficients: minors.map(|m| m.0), magnitudes: minors.map(|m| m.1) }
    }

    /// `constant + sum(factors[i] * lines[i])`.
    fn sum(lines: &[Line; 3], factors: [f64; 3], constant: f64) -> Self {
        let mut result = Self { coefficients: [0.0, 0.0, constant], magnitudes: [0.0, 0.0, constant.abs()] };
        for (line, factor) in lines.iter().zip(factors) {
            for i in 0..3 {
                result.coefficients[i] += factor * line.coefficients[i];
                result.magnitudes[i] += factor.abs() * line.magnitudes[i];
            }
        }
        result
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        let [a, b, c] = self.coefficients;
        a * x + b * y + c
    }

    /// Top-left rule: true if the half-plane owns the points of its border.
    fn owns_border(&self) -> bool {
        let [a, b, _] = self.coefficients;
        a > 0.0 || (a == 0.0 && b > 0.0)
    }

    /// Signed distance in px, brought towards zero by the possible rounding error.
    fn distance(&self, x: f64, y: f64) -> f64 {
        let value = self.at(x, y);
        let [ma, mb, mc] = self.magnitudes.map(|m| m * Self::ROUNDING);
        let sure = (value.abs() - (ma * x.abs() + mb * y.abs() + mc)).max(0.0);
        let slope = (self.coefficients[0].abs() + ma).hypot(self.coefficients[1].abs() + mb);
        match (sure == 0.0, slope == 0.0) {
            (true, _) => 0.0,
            (false, true) => value.signum() * f64::INFINITY,
            (false, false) => value.signum() * sure / slope,
        }
    }
}

/// Evaluates `tri` at the pixel centres of a `width` x `height` target, culled or not, covered or not.
///
/// Pixels that are more than 2 px outside the triangle's bounding box may be left out. A triangle seen exactly edge-on
/// gives no samples.
pub fn for_each_sample<const K: usize>(
    viewport: &Viewport,
    (width, height): (u32, u32),
    tri: &[Vertex<K>; 3],
    mut visit: impl FnMut(&Sample<K>),
) {
    let p = tri.map(|v| viewport.screen_position(v.position));
    let mut edges = [0, 1, 2].map(|i| Line::through(p[(i + 1) % 3], p[(i + 2) % 3]));
    let det: f64 = (0..3).map(|i| p[0][i] * edges[0].coefficients[i]).sum();
    if det == 0.0 || det.is_nan() {
        return;
    }
    for edge in &mut edges {
        edge.coefficients = edge.coefficients.map(|c| c * det.signum());
    }
    let z = tri.map(|v| v.position[2]);
    let near = Line::sum(&edges, z, 0.0);
    let far = Line::sum(&edges, z.map(|z| -z), det.abs());

    let (columns, rows) = bounds(&p, width, height);
    for y in rows {
        for x in columns.clone() {
            let (cx, cy) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
            let inside_edges = edges.iter().all(|e| {
                let value = e.at(cx, cy);
                value > 0.0 || (value == 0.0 && e.owns_border())
            });
            let b = edges.map(|e| e.at(cx, cy) / det.abs());
            let inv_w: f64 = b.iter().sum();
            // Inside a convex region, the nearest border decides; outside, the border that is violated most.
            let lines = [&edges[0], &edges[1], &edges[2], &near, &far];
            let mut distances = lines.map(|line| line.distance(cx, cy));
            distances.sort_by(f64::total_cmp);
            let weighted =
                |weights: [f64; 3], i: usize| -> f64 { (0..3).map(|k| weights[k] * tri[k].attributes[i]).sum() };
            visit(&Sample {
                x,
                y,
                covered: inside_edges && inv_w > 0.0 && near.at(cx, cy) >= 0.0 && far.at(cx, cy) >= 0.0,
                front: det < 0.0,
                margin: distances[0].abs(),
                second_margin: distances[1].abs(),
                depth: near.at(cx, cy) / det.abs(),
                inv_w,
                perspective: std::array::from_fn(|i| weighted(b, i) / inv_w),
                linear: std::array::from_fn(|i| weighted([0, 1, 2].map(|k| b[k] * p[k][2]), i)),
            });
        }
    }
}

/// Columns and rows worth visiting: the bounding box with 2 px around it, or everything if a vertex has w <= 0.
fn bounds(p: &[[f64; 3]; 3], width: u32, height: u32) -> (std::ops::Range<u32>, std::ops::Range<u32>) {
    if p.iter().any(|v| v[2] <= 0.0) {
        return (0..width, 0..height);
    }
    let range = |axis: usize, size: u32| {
        let at = p.map(|v| v[axis] / v[2]);
        let low = at.into_iter().fold(f64::INFINITY, f64::min) - 3.0;
        let high = at.into_iter().fold(f64::NEG_INFINITY, f64::max) + 3.0;
        // Float to integer conversions saturate.
        (low as u32).min(size)..(high as u32).min(size)
    };
    (range(0, width), range(1, height))
}

/// Draws one triangle into `frame` with depth test `Less`; `shade` gives the colour of a covered sample.
pub fn draw<const K: usize>(
    frame: &mut Frame,
    viewport: &Viewport,
    cull: Cull,
    tri: &[Vertex<K>; 3],
    id: u32,
    mut shade: impl FnMut(&Sample<K>) -> [f64; 3],
) {
    let size = (frame.width, frame.height);
    for_each_sample(viewport, size, tri, |sample| {
        if cull.drops(sample.front) {
            return;
        }
        let index = frame.index(sample.x, sample.y);
        frame.note_margin(index, sample.margin);
        if sample.covered {
            frame.offer(index, sample.depth, shade(sample), id);
        }
    });
}
