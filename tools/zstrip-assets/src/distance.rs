//! The distance between two surfaces of triangles: a bound that no point of either of them is beyond.
//!
//! The distance of a point of one surface is that to the nearest point of the other one. The largest of these, both
//! ways, is Hausdorff's. It is found by branch and bound: a triangle is divided until no part of any can be farther
//! away than a point that was looked at, to within [`SLACK`] and [`SLACK_OF_SIZE`]. Parts are bounded by the distances
//! of their corners to one triangle of the other surface: a distance from a convex thing is a convex function, so the
//! largest one is at a corner.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::geometry::{Vector, cross, dot};

/// The part by which the bound may be above the distance.
const SLACK: f64 = 0.02;

/// The part of the size by which the bound may be above the distance besides: a sixth of a pixel of 320.
const SLACK_OF_SIZE: f64 = 5e-4;

/// The most parts that are looked at. Beyond, the bound is what it is then, which is above the distance.
const MOST_PARTS: usize = 400_000;

/// Triangles of a leaf of the tree.
const LEAF: usize = 4;

pub(crate) type Triangle = [Vector; 3];

/// Returns a bound of the distance between two surfaces: at least the distance, and mostly little more. 0 if one
/// of them has no triangles.
pub(crate) fn between(a: &[Triangle], b: &[Triangle]) -> f64 {
    if a.is_empty() || b.is_empty() {
        return 0.0;
    }
    one_way(a, &Tree::new(b)).max(one_way(b, &Tree::new(a)))
}

/// A part of a triangle, and a bound of its distance.
struct Part {
    bound: f64,
    corners: Triangle,
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for Part {}
impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

/// Returns a bound of the distance of the points of triangles from a surface.
fn one_way(from: &[Triangle], to: &Tree) -> f64 {
    let Node { low, high, .. } = to.nodes[0];
    let slack = SLACK_OF_SIZE * (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    // The largest distance of a point that was looked at.
    let mut least: f64 = 0.0;
    let mut parts = BinaryHeap::new();
    let part = |corners: Triangle, least: &mut f64| {
        let near = corners.map(|corner| to.nearest(corner));
        near.iter().for_each(|(distance, _)| *least = least.max(*distance));
        let farthest = |triangle: usize| {
            let triangle = &to.triangles[triangle];
            corners.iter().map(|corner| distance(*corner, triangle)).fold(0.0, f64::max)
        };
        let bound = near.iter().map(|(_, triangle)| farthest(*triangle)).fold(f64::INFINITY, f64::min);
        // No point is farther from a corner than the longest side, so neither is it from what is near the corner.
        let longest = (0..3).map(|k| length(sub(corners[k], corners[(k + 1) % 3]))).fold(0.0, f64::max);
        let bound = near.iter().map(|(distance, _)| distance + longest).fold(bound, f64::min);
        Part { bound, corners }
    };
    for corners in from {
        let part = part(*corners, &mut least);
        parts.push(part);
    }
    for _ in 0..MOST_PARTS {
        let Some(Part { bound, corners: [a, b, c] }) = parts.pop() else { break };
        if bound <= least * (1.0 + SLACK) + slack {
            return bound.max(least);
        }
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        for corners in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            let part = part(corners, &mut least);
            parts.push(part);
        }
    }
    parts.peek().map_or(least, |part| part.bound.max(least))
}

fn sub(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|k| a[k] - b[k])
}

fn length(v: Vector) -> f64 {
    dot(v, v).sqrt()
}

fn middle(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|k| (a[k] + b[k]) / 2.0)
}

/// Returns the distance of a point from a triangle.
pub(crate) fn distance(p: Vector, triangle: &Triangle) -> f64 {
    length(sub(p, nearest_point(p, triangle)))
}

/// Returns the point of a triangle that is nearest to a point (Ericson 2005, "Real-Time Collision Detection", 5.1.5).
pub(crate) fn nearest_point(p: Vector, [a, b, c]: &Triangle) -> Vector {
    let [b1, c1] = weights(p, [*a, *b, *c]);
    std::array::from_fn(|k| a[k] + b1 * (b[k] - a[k]) + c1 * (c[k] - a[k]))
}

/// Returns the weights of the second and the third corner at the point of a triangle that is nearest to a point.
pub(crate) fn weights(p: Vector, [a, b, c]: Triangle) -> [f64; 2] {
    let (ab, ac, ap) = (sub(b, a), sub(c, a), sub(p, a));
    let normal = cross(ab, ac);
    if dot(normal, normal) <= 1e-20 * dot(ab, ab) * dot(ac, ac) {
        // Without an area: the nearest point of its longest side.
        let sides = [(a, b, [0.0, 0.0], [1.0, 0.0]), (a, c, [0.0, 0.0], [0.0, 1.0]), (b, c, [1.0, 0.0], [0.0, 1.0])];
        let size = |(p, q, ..): &(Vector, Vector, [f64; 2], [f64; 2])| length(sub(*q, *p));
        let [first, rest @ ..] = sides;
        let (from, to, w, x) =
            rest.into_iter().fold(first, |most, side| if size(&side) > size(&most) { side } else { most });
        let along = sub(to, from);
        let square = dot(along, along);
        let t = if square > 0.0 { (dot(sub(p, from), along) / square).clamp(0.0, 1.0) } else { 0.0 };
        return [0, 1].map(|k| w[k] + t * (x[k] - w[k]));
    }
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [0.0, 0.0];
    }
    let bp = sub(p, b);
    let (d3, d4) = (dot(ab, bp), dot(ac, bp));
    if d3 >= 0.0 && d4 <= d3 {
        return [1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return [d1 / (d1 - d3), 0.0];
    }
    let cp = sub(p, c);
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return [0.0, d2 / (d2 - d6)];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [1.0 - w, w];
    }
    [vb / (va + vb + vc), vc / (va + vb + vc)]
}

/// A node of the tree: a box, and either a run of triangles or two nodes below it.
#[derive(Clone, Copy)]
struct Node {
    low: Vector,
    high: Vector,
    first: usize,
    count: usize,
    /// The second node below; the first one follows the node itself.
    second: usize,
}

/// Triangles in a tree of boxes.
pub(crate) struct Tree {
    pub triangles: Vec<Triangle>,
    /// Numbers of triangles, as nodes have them.
    order: Vec<usize>,
    nodes: Vec<Node>,
}

impl Tree {
    pub fn new(triangles: &[Triangle]) -> Self {
        let order = (0..triangles.len()).collect();
        let mut tree = Self { triangles: triangles.to_vec(), order, nodes: Vec::new() };
        tree.divide(0, triangles.len());
        tree
    }

    /// Adds a node for a run of triangles, and those below it. It is as deep as the logarithm of their number.
    fn divide(&mut self, first: usize, count: usize) {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for corner in self.order[first..first + count].iter().flat_map(|t| &self.triangles[*t]) {
            low = std::array::from_fn(|k| low[k].min(corner[k]));
            high = std::array::from_fn(|k| high[k].max(corner[k]));
        }
        let number = self.nodes.len();
        self.nodes.push(Node { low, high, first, count, second: 0 });
        if count <= LEAF {
            return;
        }
        let size = sub(high, low);
        let axis = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(0);
        let triangles = &self.triangles;
        let at = |t: &usize| triangles[*t].iter().map(|corner| corner[axis]).sum::<f64>();
        let half = count / 2;
        self.order[first..first + count].select_nth_unstable_by(half, |a, b| at(a).total_cmp(&at(b)));
        self.divide(first, half);
        self.nodes[number].second = self.nodes.len();
        self.divide(first + half, count - half);
    }

    /// Returns the distance of the nearest triangle, and its number.
    pub fn nearest(&self, p: Vector) -> (f64, usize) {
        let mut best = (f64::INFINITY, 0);
        self.visit(p, &mut |most, triangle| {
            let distance = distance(p, &self.triangles[triangle]);
            if distance < most {
                best = (distance, triangle);
            }
            most.min(distance)
        });
        best
    }

    /// Calls back with a distance and each triangle whose box is not farther away; the callback returns the distance
    /// from then on.
    pub fn visit(&self, p: Vector, look: &mut dyn FnMut(f64, usize) -> f64) {
        let mut most = f64::INFINITY;
        let mut stack = vec![0];
        let apart = |node: &Node| {
            let outside: Vector = std::array::from_fn(|k| (node.low[k] - p[k]).max(p[k] - node.high[k]).max(0.0));
            length(outside)
        };
        while let Some(number) = stack.pop() {
            let node = &self.nodes[number];
            if apart(node) > most {
                continue;
            }
            if node.second == 0 {
                for triangle in &self.order[node.first..node.first + node.count] {
                    most = look(most, *triangle);
                }
                continue;
            }
            // The nearer one is looked at first.
            let below = [number + 1, node.second];
            let [a, b] = below.map(|k| apart(&self.nodes[k]));
            stack.extend(if a < b { [below[1], below[0]] } else { below });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers from 0 to 1, the same in each run.
    struct Random(u64);

    impl Random {
        fn unit(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        }

        fn point(&mut self) -> Vector {
            std::array::from_fn(|_| self.unit())
        }

        fn triangle(&mut self) -> Triangle {
            let (at, size) = (self.point(), self.unit());
            std::array::from_fn(|_| {
                let p = self.point();
                std::array::from_fn(|k| at[k] + size * p[k])
            })
        }
    }

    /// The distance by many points of the triangle.
    fn sampled(p: Vector, triangle: &Triangle) -> f64 {
        let steps = 200;
        let mut least = f64::INFINITY;
        for i in 0..=steps {
            for j in 0..=steps - i {
                let (u, v) = (f64::from(i) / f64::from(steps), f64::from(j) / f64::from(steps));
                let [a, b, c] = triangle;
                let q = std::array::from_fn(|k| a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]));
                least = least.min(length(sub(p, q)));
            }
        }
        least
    }

    #[test]
    fn distances_of_points_are_those_of_many_points_of_the_triangle() {
        let mut random = Random(1);
        for case in 0..300 {
            let (p, mut triangle) = (random.point(), random.triangle());
            if case % 10 == 0 {
                // Without an area.
                triangle[2] = middle(triangle[0], triangle[1]);
            }
            let (found, expected) = (distance(p, &triangle), sampled(p, &triangle));
            // Samples are up to a hundredth of a side apart.
            assert!(found <= expected + 1e-9 && found > expected - 0.02, "case {case}: {found}, not {expected}");
        }
    }

    #[test]
    fn the_nearest_triangle_is_that_of_all() {
        let mut random = Random(2);
        for count in [1, 4, 5, 30, 300] {
            let triangles: Vec<_> = (0..count).map(|_| random.triangle()).collect();
            let tree = Tree::new(&triangles);
            for _ in 0..200 {
                let p = random.point();
                let expected = triangles.iter().map(|t| distance(p, t)).fold(f64::INFINITY, f64::min);
                let (found, number) = tree.nearest(p);
                assert!((found - expected).abs() < 1e-12, "{count}: {found}, not {expected}");
                assert!((distance(p, &triangles[number]) - expected).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn bounds_are_above_the_distance_of_every_point_and_hardly_higher() {
        let mut random = Random(3);
        for case in 0..40 {
            let surface = |random: &mut Random| (0..1 + case).map(|_| random.triangle()).collect::<Vec<_>>();
            let (a, b) = (surface(&mut random), surface(&mut random));
            let found = between(&a, &b);
            let mut sampled: f64 = 0.0;
            for (from, to) in [(&a, Tree::new(&b)), (&b, Tree::new(&a))] {
                for [p, q, r] in from {
                    for i in 0..=20 {
                        for j in 0..=20 - i {
                            let (u, v) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
                            let at = std::array::from_fn(|k| p[k] + u * (q[k] - p[k]) + v * (r[k] - p[k]));
                            sampled = sampled.max(to.nearest(at).0);
                        }
                    }
                }
            }
            assert!(found >= sampled - 1e-12, "case {case}: {found} is below {sampled}");
            // Between the samples, up to a twentieth of a side of up to 2 units, it may be larger.
            assert!(found <= 1.02 * sampled + 0.06, "case {case}: {found} is above {sampled}");
        }
        // A flat square, divided in two ways, is not apart from itself.
        let [a, b, c, d] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        assert!(between(&[[a, b, c], [a, c, d]], &[[a, b, d], [b, c, d]]) <= SLACK_OF_SIZE);
        // A square 1 / 4 above another one.
        let raised = [a, b, c, d].map(|[x, y, _]| [x, y, 0.25]);
        let found =
            between(&[[a, b, c], [a, c, d]], &[[raised[0], raised[1], raised[2]], [raised[0], raised[2], raised[3]]]);
        assert!((0.25..=0.2556).contains(&found), "{found}");
        assert_eq!(between(&[], &[[a, b, c]]), 0.0);
    }
}
