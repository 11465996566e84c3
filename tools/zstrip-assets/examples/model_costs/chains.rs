//! Models at rest whose draws have nodes above them: what placing takes for each of these.

use super::{Show, panel};
use zstrip_assets::preview::Container;
use zstrip_assets::{Import, Mesh, Node, Transform, Vertices, WriteOptions, write};

/// Nodes of a model, by the number of the one above; the first is a root.
#[derive(Clone, Copy)]
struct Tree {
    nodes: usize,
    /// Nodes below each; 1 makes a chain.
    branches: usize,
    /// Draws of the last nodes, one for each.
    draws: usize,
    is_scaled: bool,
}

const fn tree(nodes: usize, branches: usize, draws: usize) -> Tree {
    Tree { nodes, branches, draws, is_scaled: false }
}

/// Chains of 2 to 24 nodes, with a draw at their end or with several, then trees.
const TREES: [Tree; 15] = [
    tree(2, 1, 1),
    tree(3, 1, 1),
    tree(5, 1, 1),
    tree(9, 1, 1),
    tree(24, 1, 1),
    Tree { is_scaled: true, ..tree(2, 1, 1) },
    Tree { is_scaled: true, ..tree(5, 1, 1) },
    tree(3, 1, 3),
    tree(8, 1, 4),
    tree(20, 1, 20),
    Tree { is_scaled: true, ..tree(8, 1, 8) },
    tree(2, 2, 2),
    tree(9, 8, 8),
    tree(15, 2, 8),
    tree(40, 3, 40),
];

impl Tree {
    fn import(self) -> Import {
        let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
        let vertices =
            Vertices { positions: corners.to_vec(), normals: vec![[0.0, 0.0, 1.0]; 4], ..Vertices::default() };
        let mesh = Mesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
        let node = |k: usize| {
            let (sin, cos) = (0.2 + 0.1 * k as f32).sin_cos();
            let scale = if self.is_scaled { [1.1, 0.9, 1.05] } else { [1.0; 3] };
            Node {
                parent: k.checked_sub(1).map(|k| k / self.branches),
                transform: Transform::Parts { translation: [0.1, 0.2, -0.1], rotation: [0.0, sin, 0.0, cos], scale },
                meshes: if k + self.draws >= self.nodes { vec![0] } else { vec![] },
                ..Node::default()
            }
        };
        Import { nodes: (0..self.nodes).map(node).collect(), meshes: vec![mesh], ..Import::default() }
    }
}

/// Returns all models at rest with nodes above draws.
pub fn shows() -> Result<Vec<Show>, String> {
    let show = |(number, tree): (usize, Tree)| {
        let name = format!("tree {number}");
        let written = write(&tree.import(), &WriteOptions::default()).map_err(|error| format!("{name}: {error}"))?;
        Ok(Show { name, container: Container::new(&written.bytes), panels: vec![panel(240, 30)] })
    };
    TREES.into_iter().enumerate().map(show).collect()
}
