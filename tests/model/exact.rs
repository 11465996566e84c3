//! Poses in double precision, from the numbers that a container holds.

use super::builder::Builder;
use zstrip::model::container::{Channel, Interpolation, NONE, Path};

pub type Matrix = [[f64; 4]; 3];

/// A transform as translation, rotation and scale.
#[derive(Clone, Copy, Debug)]
pub struct Local {
    pub translation: [f64; 3],
    pub rotation: [f64; 4],
    pub scale: [f64; 3],
}

/// A clip at a time: the number of the clip, and the part of its duration that has gone by.
pub type At = (usize, f64);

pub fn fixed(c: i32) -> f64 {
    f64::from(c) / 65_536.0
}

fn unit<const N: usize>(v: [f64; N]) -> [f64; N] {
    let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
    v.map(|c| c / length)
}

fn times(a: &Matrix, b: &Matrix) -> Matrix {
    core::array::from_fn(|i| {
        core::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum::<f64>() + if j == 3 { a[i][3] } else { 0.0 })
    })
}

pub fn apply(m: &Matrix, p: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3])
}

impl Local {
    fn matrix(&self) -> Matrix {
        let [x, y, z, w] = unit(self.rotation);
        let rows = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ];
        core::array::from_fn(|i| {
            let [a, b, c] = core::array::from_fn(|j| rows[i][j] * self.scale[j]);
            [a, b, c, self.translation[i]]
        })
    }
}

/// Spherical interpolation on the shorter arc.
fn slerp(a: [f64; 4], b: [f64; 4], t: f64) -> [f64; 4] {
    let (a, mut b) = (unit(a), unit(b));
    let mut cosine: f64 = (0..4).map(|k| a[k] * b[k]).sum();
    if cosine < 0.0 {
        b = b.map(|c| -c);
        cosine = -cosine;
    }
    let angle = cosine.min(1.0).acos();
    let [p, q] = if angle < 1e-9 { [1.0 - t, t] } else { [((1.0 - t) * angle).sin(), (t * angle).sin()] };
    unit(core::array::from_fn(|k| p * a[k] + q * b[k]))
}

fn mix<const N: usize>(a: [f64; N], b: [f64; N], t: f64) -> [f64; N] {
    core::array::from_fn(|k| a[k] + (b[k] - a[k]) * t)
}

/// The values of a channel, as they are stored.
fn sample<const N: usize>(channel: &Channel, times: &[u16], keys: &[i16], at: f64) -> [f64; N] {
    let tick = at * 65_535.0;
    let after = times.iter().position(|time| f64::from(*time) > tick).unwrap_or(times.len());
    let value = |key: usize, part: usize| -> [f64; N] {
        let stride = if channel.interpolation == Interpolation::Cubic as u8 { 3 * key + part } else { key };
        core::array::from_fn(|n| f64::from(keys[stride * N + n]))
    };
    if after == 0 || after == times.len() || channel.interpolation == Interpolation::Step as u8 {
        return value(after.saturating_sub(1), 1);
    }
    let (from, to) = (f64::from(times[after - 1]), f64::from(times[after]));
    let t = (tick - from) / (to - from);
    let (a, b) = (value(after - 1, 1), value(after, 1));
    if channel.interpolation == Interpolation::Linear as u8 {
        if channel.path == Path::Rotation as u8 {
            let [p, q] = [a, b].map(|q| core::array::from_fn(|k| q[k]));
            let found = slerp(p, q, t);
            return core::array::from_fn(|k| found[k]);
        }
        return mix(a, b, t);
    }
    let (out, into) = (value(after - 1, 2), value(after, 0));
    let rise = t * t * (3.0 - 2.0 * t);
    core::array::from_fn(|k| {
        a[k] + (b[k] - a[k]) * rise + out[k] * t * (1.0 - t) * (1.0 - t) - into[k] * t * t * (1.0 - t)
    })
}

/// A pose of a model: the matrices of its nodes, and the weights of its morph targets.
pub struct ExactPose {
    pub nodes: Vec<Matrix>,
    pub weights: Vec<f64>,
}

impl ExactPose {
    /// The pose of a clip, or between those of two clips: the second one with a weight.
    pub fn new(builder: &Builder, from: Option<At>, to: Option<(At, f64)>) -> Self {
        let locals = |at: Option<At>| -> (Vec<Local>, Vec<f64>) {
            let mut locals: Vec<Local> = builder
                .nodes
                .iter()
                .map(|node| Local {
                    translation: node.translation.map(fixed),
                    rotation: node.rotation.map(f64::from),
                    scale: node.scale.map(fixed),
                })
                .collect();
            let mut weights: Vec<f64> = builder.weights.iter().map(|w| f64::from(*w) / 16_384.0).collect();
            for (channel, times, keys) in at.iter().flat_map(|(clip, _)| &builder.clips[*clip].channels) {
                let (at, target) = (at.expect("a time").1, usize::from(channel.target));
                let vector = || {
                    let value: [f64; 3] = sample(channel, times, keys, at);
                    core::array::from_fn(|k| fixed(channel.offset[k]) + fixed(channel.scale) * value[k] / 32_768.0)
                };
                match Path::of(channel.path).expect("a path") {
                    Path::Translation => locals[target].translation = vector(),
                    Path::Scale => locals[target].scale = vector(),
                    Path::Rotation => locals[target].rotation = sample(channel, times, keys, at),
                    Path::Weights => weights[target] = sample::<1>(channel, times, keys, at)[0] / 16_384.0,
                }
            }
            (locals, weights)
        };
        let (mut local, mut weights) = locals(from);
        if let Some((at, t)) = to {
            let (other, other_weights) = locals(Some(at));
            for (a, b) in local.iter_mut().zip(other) {
                *a = Local {
                    translation: mix(a.translation, b.translation, t),
                    rotation: slerp(a.rotation, b.rotation, t),
                    scale: mix(a.scale, b.scale, t),
                };
            }
            weights = weights.iter().zip(other_weights).map(|(a, b)| a + (b - a) * t).collect();
        }
        let mut nodes: Vec<Matrix> = vec![];
        for (node, local) in builder.nodes.iter().zip(local) {
            let own = local.matrix();
            nodes.push(if node.parent == NONE { own } else { times(&nodes[usize::from(node.parent)], &own) });
        }
        Self { nodes, weights }
    }

    /// The position and the normal of a vertex of the first part; the normal as it is stored if joints shear it.
    pub fn vertex(&self, builder: &Builder, vertex: usize) -> ([f64; 3], [f64; 3]) {
        let part = &builder.parts[0];
        let mut point = part.points[vertex].map(f64::from);
        let mut normal = decoded(part.normals[vertex]);
        for ((first, deltas), weight) in part.targets.iter().zip(&self.weights) {
            if let Some(delta) = vertex.checked_sub(usize::from(*first)).and_then(|k| deltas.get(k)) {
                point = core::array::from_fn(|k| point[k] + weight * f64::from(delta.point[k]));
                normal = core::array::from_fn(|k| normal[k] + weight * f64::from(delta.normal[k]) / 64.0);
            }
        }
        let place = |q: [f64; 3]| -> [f64; 3] {
            core::array::from_fn(|k| fixed(part.item.offset[k]) + fixed(part.item.scale) * q[k] / 32_768.0)
        };
        let Some(joints) = builder.skins.get(usize::from(part.item.skin)) else {
            return (place(point), unit(normal));
        };
        let influence = part.influences[vertex];
        let others = influence.weights.map(f64::from);
        let first = 256.0 - others.iter().sum::<f64>();
        let (mut at, mut turned) = ([0.0; 3], [0.0; 3]);
        for (joint, weight) in influence.joints.iter().zip([first, others[0], others[1], others[2]]) {
            let joint = &joints[usize::from(*joint)];
            let bind = joint.inverse_bind.map(|row| row.map(fixed));
            let matrix = times(&self.nodes[usize::from(joint.node)], &bind);
            let moved = apply(&matrix, point.map(|c| c / 32_768.0));
            let rotated = matrix.map(|row| row[0] * normal[0] + row[1] * normal[1] + row[2] * normal[2]);
            at = core::array::from_fn(|k| at[k] + weight / 256.0 * moved[k]);
            turned = core::array::from_fn(|k| turned[k] + weight / 256.0 * rotated[k]);
        }
        (at, unit(turned))
    }
}

fn decoded([x, y]: [i8; 2]) -> [f64; 3] {
    let (x, y) = (f64::from(x) / 127.0, f64::from(y) / 127.0);
    let z = 1.0 - x.abs() - y.abs();
    let sign = |c: f64| if c < 0.0 { -1.0 } else { 1.0 };
    let (x, y) = if z < 0.0 { ((1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y)) } else { (x, y) };
    unit([x, y, z])
}
