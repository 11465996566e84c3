//! Where nodes and vertices are, at rest and in clips, in 64-bit floats.

use crate::geometry::{IDENTITY, Matrix, Vector, determinant, matrix, point, times, trs};
use crate::model::{Animation, Bounds, Channel, Import, Interpolation, Mesh, Path, Transform};

/// The places of everything at a time.
#[derive(Clone, Debug)]
pub(crate) struct Posed {
    /// The matrices of all nodes to the model.
    pub world: Vec<Matrix>,
    /// Weights of morph targets, by node.
    pub weights: Vec<Vec<f64>>,
}

impl Import {
    /// Returns the box around the model in its pose without animation, or none if it has no vertices.
    pub fn bounds(&self) -> Option<Bounds> {
        let posed = self.pose(None);
        let points = self.nodes.iter().enumerate().flat_map(|(number, node)| {
            let joints = node.skin.map(|skin| self.joint_matrices(skin, &posed.world));
            let posed = &posed;
            node.meshes.iter().flat_map(move |mesh| {
                let mesh = &self.meshes[*mesh];
                let joints = joints.clone();
                (0..mesh.vertices.len())
                    .map(move |v| posed.vertex(number, mesh, v, joints.as_deref()).map(|x| x as f32))
            })
        });
        Bounds::around(points)
    }

    /// Returns the pose of a clip at a time in seconds, or that at rest.
    pub(crate) fn pose(&self, at: Option<(&Animation, f64)>) -> Posed {
        let mut locals: Vec<_> = self.nodes.iter().map(|node| Local::of(&node.transform)).collect();
        let mut weights: Vec<Vec<f64>> =
            self.nodes.iter().map(|node| node.weights.iter().map(|w| f64::from(*w)).collect()).collect();
        if let Some((animation, time)) = at {
            for channel in &animation.channels {
                let value = sample(channel, time);
                let vector = || std::array::from_fn(|k| value.get(k).copied().unwrap_or(0.0));
                match (channel.path, &mut locals[channel.node]) {
                    (Path::Translation, Local::Parts(translation, ..)) => *translation = vector(),
                    (Path::Rotation, Local::Parts(_, rotation, _)) => {
                        *rotation = std::array::from_fn(|k| value.get(k).copied().unwrap_or(0.0));
                    }
                    (Path::Scale, Local::Parts(.., scale)) => *scale = vector(),
                    (Path::Weights, _) => weights[channel.node] = value,
                    (_, Local::Matrix(_)) => {}
                }
            }
        }
        let mut world: Vec<Matrix> = Vec::with_capacity(self.nodes.len());
        for (node, local) in self.nodes.iter().zip(locals) {
            let parent = node.parent.map_or(IDENTITY, |parent| world[parent]);
            let own = match local {
                Local::Parts(translation, rotation, scale) => trs(translation, rotation, scale),
                Local::Matrix(matrix) => matrix,
            };
            world.push(times(&parent, &own));
        }
        Posed { world, weights }
    }

    /// Returns the matrices of a skin's joints, from the mesh to the model.
    pub(crate) fn joint_matrices(&self, skin: usize, world: &[Matrix]) -> Vec<Matrix> {
        let skin = &self.skins[skin];
        let matrices = skin.joints.iter().zip(&skin.inverse_binds);
        matrices.map(|(joint, bind)| times(&world[*joint], &bind.map(|column| column.map(f64::from)))).collect()
    }

    /// The number of nodes that mirror the meshes they show.
    pub(crate) fn mirrored(&self) -> usize {
        let shows = |number: &usize| !self.nodes[*number].meshes.is_empty() && self.nodes[*number].skin.is_none();
        let world = self.pose(None).world;
        (0..self.nodes.len()).filter(shows).filter(|number| determinant(&world[*number]) < 0.0).count()
    }
}

impl Posed {
    /// Returns where a vertex of a mesh is that a node shows.
    pub(crate) fn vertex(&self, node: usize, mesh: &Mesh, v: usize, joints: Option<&[Matrix]>) -> Vector {
        point(&self.matrix(node, mesh, v, joints), self.morphed(node, mesh, v))
    }

    /// Returns the direction of a vertex's normal in the model, of any length.
    pub(crate) fn normal(&self, node: usize, mesh: &Mesh, v: usize, joints: Option<&[Matrix]>) -> Vector {
        let n = self.morphed_normal(node, mesh, v);
        let m = self.matrix(node, mesh, v, joints);
        std::array::from_fn(|row| (0..3).map(|k| m[k][row] * n[k]).sum())
    }

    /// Returns a normal after morph targets.
    pub(crate) fn morphed_normal(&self, node: usize, mesh: &Mesh, v: usize) -> Vector {
        let mut n = mesh.vertices.normals[v].map(f64::from);
        for (morph, weight) in mesh.vertices.morphs.iter().zip(&self.weights[node]) {
            if let Some(delta) = morph.normals.get(v) {
                n = std::array::from_fn(|k| n[k] + weight * f64::from(delta[k]));
            }
        }
        n
    }

    /// Returns a position after morph targets.
    pub(crate) fn morphed(&self, node: usize, mesh: &Mesh, v: usize) -> Vector {
        let mut p = mesh.vertices.positions[v].map(f64::from);
        for (morph, weight) in mesh.vertices.morphs.iter().zip(&self.weights[node]) {
            if let Some(delta) = morph.positions.get(v) {
                p = std::array::from_fn(|k| p[k] + weight * f64::from(delta[k]));
            }
        }
        p
    }

    /// The matrix of a vertex: that of the node, or the mean of those of its joints.
    fn matrix(&self, node: usize, mesh: &Mesh, v: usize, joints: Option<&[Matrix]>) -> Matrix {
        let (Some(joints), Some(numbers)) = (joints, mesh.vertices.joints.get(v)) else { return self.world[node] };
        let mut mean = [[0.0; 4]; 4];
        for (joint, weight) in numbers.iter().zip(&mesh.vertices.weights[v]) {
            let of_joint = &joints[usize::from(*joint)];
            for (to, from) in mean.as_flattened_mut().iter_mut().zip(of_joint.as_flattened()) {
                *to += f64::from(*weight) * from;
            }
        }
        mean
    }
}

enum Local {
    Parts(Vector, [f64; 4], Vector),
    Matrix(Matrix),
}

impl Local {
    fn of(transform: &Transform) -> Self {
        match transform {
            Transform::Parts { translation, rotation, scale } => {
                Self::Parts(translation.map(f64::from), rotation.map(f64::from), scale.map(f64::from))
            }
            Transform::Matrix(_) => Self::Matrix(matrix(transform)),
        }
    }
}

/// Returns the value of a channel at a time, as the glTF standard defines it.
pub(crate) fn sample(channel: &Channel, time: f64) -> Vec<f64> {
    let width = channel.width();
    let part = |key: usize, part: usize| -> Vec<f64> {
        let value = if channel.interpolation == Interpolation::Cubic { 3 * key + part } else { key };
        channel.values[value * width..][..width].iter().map(|x| f64::from(*x)).collect()
    };
    let after = channel.times.partition_point(|t| f64::from(*t) <= time);
    let is_step = channel.interpolation == Interpolation::Step;
    if after == 0 || after == channel.times.len() || is_step {
        return part(after.saturating_sub(1), 1);
    }
    let (from, to) = (f64::from(channel.times[after - 1]), f64::from(channel.times[after]));
    let (t, a, b) = ((time - from) / (to - from), part(after - 1, 1), part(after, 1));
    let is_rotation = channel.path == Path::Rotation;
    if channel.interpolation == Interpolation::Linear {
        return if is_rotation { slerp(&a, &b, t) } else { mix(&a, &b, t) };
    }
    let (out, into) = (part(after - 1, 2), part(after, 0));
    let rise = t * t * (3.0 - 2.0 * t);
    let curve = |k: usize| {
        let (leave, arrive) = (out[k] * (to - from), into[k] * (to - from));
        a[k] + (b[k] - a[k]) * rise + leave * t * (1.0 - t) * (1.0 - t) - arrive * t * t * (1.0 - t)
    };
    (0..width).map(curve).collect()
}

pub(crate) fn mix(a: &[f64], b: &[f64], t: f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + (b - a) * t).collect()
}

/// Returns the unit quaternion on the shorter arc from one to the other.
pub(crate) fn slerp(a: &[f64], b: &[f64], t: f64) -> Vec<f64> {
    let cosine: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    let sign = if cosine < 0.0 { -1.0 } else { 1.0 };
    let angle = cosine.abs().min(1.0).acos();
    let [p, q] = if angle < 1e-6 { [1.0 - t, t] } else { [((1.0 - t) * angle).sin(), (t * angle).sin()] };
    let sum: Vec<f64> = a.iter().zip(b).map(|(a, b)| p * a + sign * q * b).collect();
    let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
    sum.into_iter().map(|x| x / length).collect()
}
