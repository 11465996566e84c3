//! Models that move, each by other means: what posing and placing take.

use super::{Show, panel};
use zstrip_assets::preview::Container;
use zstrip_assets::{
    Animation, Channel, Import, Interpolation, Mesh, Morph, Node, Path, Skin, Transform, Vertices, WriteOptions, write,
};

/// What moves a model.
#[derive(Clone, Copy, Default)]
struct Rig {
    /// Columns and rows of a sheet of squares.
    sheet: [usize; 2],
    /// Nodes, which are joints if there are weights; each has a channel of each path.
    nodes: usize,
    rotates: bool,
    moves: bool,
    scales: bool,
    /// Weights of each vertex.
    weights: usize,
    targets: usize,
    /// Keys of a channel.
    keys: usize,
}

const NODES: Rig =
    Rig { sheet: [2, 2], nodes: 1, rotates: true, moves: false, scales: false, weights: 0, targets: 0, keys: 9 };

const RIGS: [Rig; 25] = [
    NODES,
    Rig { nodes: 24, ..NODES },
    Rig { nodes: 24, rotates: false, moves: true, ..NODES },
    Rig { nodes: 24, moves: true, ..NODES },
    Rig { nodes: 60, moves: true, scales: true, keys: 3, ..NODES },
    Rig { nodes: 60, keys: 40, ..NODES },
    Rig { sheet: [12, 10], nodes: 8, weights: 1, ..NODES },
    Rig { sheet: [30, 20], nodes: 8, weights: 1, ..NODES },
    Rig { sheet: [12, 10], nodes: 24, weights: 1, ..NODES },
    Rig { sheet: [12, 10], nodes: 8, weights: 2, ..NODES },
    Rig { sheet: [30, 20], nodes: 20, weights: 2, moves: true, ..NODES },
    Rig { sheet: [30, 20], nodes: 8, weights: 3, ..NODES },
    Rig { sheet: [50, 40], nodes: 19, weights: 3, ..NODES },
    Rig { sheet: [30, 20], nodes: 8, weights: 4, ..NODES },
    Rig { sheet: [50, 40], nodes: 30, weights: 4, keys: 20, ..NODES },
    Rig { sheet: [12, 10], targets: 1, ..NODES },
    Rig { sheet: [30, 20], targets: 1, ..NODES },
    Rig { sheet: [30, 20], targets: 3, ..NODES },
    Rig { sheet: [20, 20], targets: 6, ..NODES },
    Rig { sheet: [30, 20], nodes: 8, weights: 2, targets: 2, ..NODES },
    Rig { sheet: [30, 20], nodes: 8, weights: 1, targets: 1, ..NODES },
    Rig { sheet: [20, 20], nodes: 8, weights: 3, targets: 4, ..NODES },
    Rig { sheet: [40, 20], nodes: 12, weights: 1, targets: 6, ..NODES },
    Rig { sheet: [4, 4], nodes: 40, weights: 1, moves: true, ..NODES },
    Rig { sheet: [40, 40], nodes: 3, weights: 1, ..NODES },
];

impl Rig {
    fn mesh(self) -> Mesh {
        let [columns, rows] = self.sheet;
        let mut vertices = Vertices::default();
        for k in 0..(columns + 1) * (rows + 1) {
            let (x, y) = ((k % (columns + 1)) as f32 / columns as f32, (k / (columns + 1)) as f32 / rows as f32);
            vertices.positions.push([2.0 * x - 1.0, 2.0 * y - 1.0, 0.3 * (7.0 * x * y).sin()]);
            let n = [0.3 * (5.0 * x).sin(), 0.2, 1.0_f32];
            let length = n.iter().map(|c| c * c).sum::<f32>().sqrt();
            vertices.normals.push(n.map(|c| c / length));
            if self.weights > 0 {
                let joint = |j: usize| if j < self.weights { ((k / 3 + j) % self.nodes) as u16 } else { 0 };
                vertices.joints.push([0, 1, 2, 3].map(joint));
                let all: f32 = (0..self.weights).map(|j| (5 - j) as f32).sum();
                let weight = |j: usize| if j < self.weights { (5 - j) as f32 / all } else { 0.0 };
                vertices.weights.push([0, 1, 2, 3].map(weight));
            }
        }
        for target in 0..self.targets {
            let delta = |p: &[f32; 3]| [0.0, 0.1, 0.2 + 0.1 * (p[0] * (target + 1) as f32).sin()];
            let positions = vertices.positions.iter().map(delta).collect();
            let normals = vertices.positions.iter().map(|p| [0.1 * p[1], 0.0, 0.0]).collect();
            vertices.morphs.push(Morph { positions, normals });
        }
        let mut triangles = vec![];
        for k in 0..columns * rows {
            let a = (k / columns * (columns + 1) + k % columns) as u32;
            let (b, c) = (a + 1, a + columns as u32 + 1);
            triangles.extend([[a, b, c + 1], [a, c + 1, c]]);
        }
        Mesh { vertices, triangles, ..Mesh::default() }
    }

    fn channels(self) -> Vec<Channel> {
        let mut channels = vec![];
        let mut add = |node: usize, path: Path, value: &dyn Fn(f32) -> Vec<f32>| {
            // Not straight, so that all keys stay.
            let time = |k: usize| k as f32 / (self.keys - 1) as f32;
            let times: Vec<_> = (0..self.keys).map(time).collect();
            let wave = |k: usize| (k as f32 * 2.1 + node as f32).sin();
            let values = (0..self.keys).flat_map(|k| value(wave(k))).collect();
            channels.push(Channel { node, path, interpolation: Interpolation::Linear, times, values });
        };
        for node in 1..=self.nodes {
            if self.moves {
                add(node, Path::Translation, &|wave| vec![0.1 * wave, 0.1, 0.05 * wave]);
            }
            if self.rotates {
                add(node, Path::Rotation, &|wave| vec![(0.3 * wave).sin(), 0.0, 0.0, (0.3 * wave).cos()]);
            }
            if self.scales {
                add(node, Path::Scale, &|wave| vec![1.0 + 0.1 * wave, 1.0, 1.0 - 0.1 * wave]);
            }
        }
        if self.targets > 0 {
            let targets = self.targets;
            add(0, Path::Weights, &|wave| (0..targets).map(|k| 0.5 + 0.3 * wave + 0.01 * k as f32).collect());
        }
        channels
    }

    fn import(self) -> Import {
        let transform =
            |up: f32| Transform::Parts { translation: [0.0, up, 0.0], rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] };
        let weights = vec![0.5; self.targets];
        let mut nodes = vec![Node { meshes: vec![0], weights, ..Node::default() }];
        // A chain that branches at every fourth node.
        for k in 1..=self.nodes {
            let parent = (k > 1).then(|| if k % 4 == 0 { k / 2 } else { k - 1 });
            nodes.push(Node { parent, transform: transform(0.02), ..Node::default() });
        }
        let mut import = Import { nodes, meshes: vec![self.mesh()], ..Import::default() };
        if self.weights > 0 {
            let mut bind = [[0.0; 4]; 4];
            bind.iter_mut().enumerate().for_each(|(k, column)| column[k] = 1.0);
            let inverse_binds = vec![bind; self.nodes];
            import.skins.push(Skin { name: String::new(), joints: (1..=self.nodes).collect(), inverse_binds });
            import.nodes[0].skin = Some(0);
        }
        import.animations.push(Animation { name: "all".to_owned(), channels: self.channels() });
        import
    }
}

/// Returns all models that move.
pub fn shows() -> Result<Vec<Show>, String> {
    let show = |(number, rig): (usize, Rig)| {
        let name = format!("rig {number}");
        let written = write(&rig.import(), &WriteOptions::default()).map_err(|error| format!("{name}: {error}"))?;
        Ok(Show { name, container: Container::new(&written.bytes), panels: vec![panel(240, 30)] })
    };
    RIGS.into_iter().enumerate().map(show).collect()
}
