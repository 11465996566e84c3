//! Where nodes and vertices are without animation.

use crate::geometry::{IDENTITY, Matrix, Vector, determinant, matrix, point, times};
use crate::model::{Bounds, Import};

impl Import {
    /// Returns the box around the model in its pose without animation, or none if it has no vertices.
    pub fn bounds(&self) -> Option<Bounds> {
        let world = self.world();
        let points = self.nodes.iter().enumerate().flat_map(|(number, node)| {
            let joints = node.skin.map(|skin| self.joint_matrices(skin, &world));
            let place = world[number];
            node.meshes.iter().flat_map(move |mesh| {
                let vertices = &self.meshes[*mesh].vertices;
                let joints = joints.clone();
                (0..vertices.len()).map(move |v| {
                    let mut p = vertices.positions[v];
                    for (morph, weight) in vertices.morphs.iter().zip(&node.weights) {
                        p = std::array::from_fn(|k| p[k] + weight * morph.positions[v][k]);
                    }
                    let at = match (&joints, vertices.joints.get(v)) {
                        (Some(joints), Some(numbers)) => skinned(joints, numbers, &vertices.weights[v], p),
                        _ => point(&place, p),
                    };
                    at.map(|x| x as f32)
                })
            })
        });
        Bounds::around(points)
    }

    /// The matrices of all nodes to the model.
    fn world(&self) -> Vec<Matrix> {
        let mut world: Vec<Matrix> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let parent = node.parent.map_or(IDENTITY, |parent| world[parent]);
            world.push(times(&parent, &matrix(&node.transform)));
        }
        world
    }

    fn joint_matrices(&self, skin: usize, world: &[Matrix]) -> Vec<Matrix> {
        let skin = &self.skins[skin];
        let matrices = skin.joints.iter().zip(&skin.inverse_binds);
        matrices.map(|(joint, bind)| times(&world[*joint], &bind.map(|column| column.map(f64::from)))).collect()
    }

    /// The number of nodes that mirror the meshes they show.
    pub(crate) fn mirrored(&self) -> usize {
        let shows = |number: &usize| !self.nodes[*number].meshes.is_empty() && self.nodes[*number].skin.is_none();
        let world = self.world();
        (0..self.nodes.len()).filter(shows).filter(|number| determinant(&world[*number]) < 0.0).count()
    }
}

fn skinned(joints: &[Matrix], numbers: &[u16; 4], weights: &[f32; 4], p: [f32; 3]) -> Vector {
    numbers.iter().zip(weights).fold([0.0; 3], |sum, (joint, weight)| {
        let moved = point(&joints[usize::from(*joint)], p);
        std::array::from_fn(|k| sum[k] + f64::from(*weight) * moved[k])
    })
}
