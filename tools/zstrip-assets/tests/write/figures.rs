//! Models that tests write.

use zstrip_assets::{
    AlphaMode, Animation, Channel, Image, Import, Interpolation, Material, Mesh, Morph, Node, Path, Skin, Texture,
    Transform, Vertices, Wrap,
};

/// A model of one node that shows one mesh.
pub fn of_mesh(mesh: Mesh) -> Import {
    let node = Node { name: "only".to_owned(), meshes: vec![0], ..Node::default() };
    Import { nodes: vec![node], meshes: vec![mesh], ..Import::default() }
}

/// A grid of `columns` × `rows` squares that is bent to a sphere of this radius, with normals and texture coordinates.
pub fn sphere(columns: usize, rows: usize, radius: f64) -> Mesh {
    let mut vertices = Vertices::default();
    for row in 0..=rows {
        for column in 0..=columns {
            let (u, v) = (column as f64 / columns as f64, row as f64 / rows as f64);
            let ((sin, cos), (height, around)) = ((u * std::f64::consts::TAU).sin_cos(), (v * 2.6 + 0.27).sin_cos());
            let n = [height * sin, around, height * cos];
            vertices.positions.push(n.map(|c| (c * radius) as f32));
            vertices.normals.push(n.map(|c| c as f32));
            vertices.uvs.push([u as f32, v as f32]);
        }
    }
    let at = |row: usize, column: usize| (row * (columns + 1) + column) as u32;
    let mut triangles = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let [a, b, c, d] = [at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Mesh { vertices, triangles, ..Mesh::default() }
}

/// An image of 8 × 8 texels of full colours, which RGB565 holds exactly. No two of its quarters are alike, and it is no
/// mirror image of itself.
pub fn image() -> Image {
    let texel = |k: u32| {
        let (x, y) = (k % 8, k / 8);
        let full = |is_full: bool| if is_full { 255 } else { 0 };
        [full((x ^ y) & 1 == 0), full(x < 3), full(y < 5), 255]
    };
    Image { name: "squares".to_owned(), width: 8, height: 8, texels: (0..64).flat_map(texel).collect() }
}

pub fn textured(mesh: Mesh, image: Image, alpha: AlphaMode) -> Import {
    let mut import = of_mesh(mesh);
    let texture = Some(Texture { image: 0, wrap: [Wrap::Repeat; 2], nearest: true });
    import.materials.push(Material { texture, alpha, ..Material::default() });
    import.images.push(image);
    import.meshes[0].material = Some(0);
    import
}

pub fn channel(node: usize, path: Path, interpolation: Interpolation, times: &[f32], values: &[f32]) -> Channel {
    Channel { node, path, interpolation, times: times.to_vec(), values: values.to_vec() }
}

/// A sphere that three joints and two morph targets move, in a clip of all paths and interpolations.
pub fn animated(morphs: bool) -> Import {
    let mut mesh = sphere(12, 10, 1.5);
    let vertices = &mut mesh.vertices;
    for p in &vertices.positions {
        let along = f64::from(p[1] / 1.5 + 1.0);
        let near = |at: f64| (1.0 - (along - at).abs()).max(0.0);
        let mut weights = [(0_u16, near(0.0)), (1, near(1.0)), (2, near(2.0))];
        weights.sort_by(|a, b| b.1.total_cmp(&a.1));
        let sum: f64 = weights.iter().map(|w| w.1).sum();
        vertices.joints.push([weights[0].0, weights[1].0, weights[2].0, 0]);
        vertices.weights.push([weights[0].1, weights[1].1, weights[2].1, 0.0].map(|w| (w / sum) as f32));
    }
    if morphs {
        for (axis, most) in [(0, 0.4), (2, -0.7)] {
            let of = |p: &[f32; 3]| {
                let mut delta = [0.0; 3];
                delta[axis] = if p[1] > 0.2 { most * p[axis] } else { 0.0 };
                delta
            };
            let positions: Vec<_> = vertices.positions.iter().map(of).collect();
            let normals = positions.iter().map(|d| d.map(|c| -0.3 * c)).collect();
            vertices.morphs.push(Morph { positions, normals });
        }
    }
    let mut import = of_mesh(mesh);
    import.nodes[0].skin = Some(0);
    import.nodes[0].weights = if morphs { vec![0.25, 0.0] } else { vec![] };
    let joint = |parent, up: f32| Node {
        parent,
        transform: Transform::Parts { translation: [0.0, up, 0.0], rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] },
        ..Node::default()
    };
    import.nodes.extend([joint(None, -1.5), joint(Some(1), 1.5), joint(Some(2), 1.5)]);
    let bind = |up: f32| {
        let mut columns = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, up, 0.0, 1.0]];
        columns[3][3] = 1.0;
        columns
    };
    let inverse_binds = vec![bind(1.5), bind(0.0), bind(-1.5)];
    import.skins.push(Skin { name: String::new(), joints: vec![1, 2, 3], inverse_binds });
    let half = 0.5_f32.sqrt();
    let (linear, step, cubic) = (Interpolation::Linear, Interpolation::Step, Interpolation::Cubic);
    let mut channels = vec![
        channel(
            2,
            Path::Rotation,
            linear,
            &[0.0, 0.5, 1.3],
            &[0.0, 0.0, 0.0, 1.0, half, 0.0, 0.0, half, 0.0, 0.6, 0.0, 0.8],
        ),
        channel(
            3,
            Path::Translation,
            cubic,
            &[0.0, 1.0],
            &[0.0, 0.0, 0.0, 0.0, 1.5, 0.0, 1.0, 0.5, 0.0, 0.0, 2.0, 0.0, 0.3, 1.8, 0.1, 0.0, 0.0, 0.0],
        ),
        channel(1, Path::Scale, step, &[0.2, 0.9], &[1.0, 1.0, 1.0, 1.2, 0.9, 1.1]),
    ];
    if morphs {
        channels.push(channel(0, Path::Weights, linear, &[0.0, 0.7, 1.2], &[0.0, 0.0, 1.0, -0.5, 0.25, 1.5]));
    }
    import.animations.push(Animation { name: "all".to_owned(), channels });
    import
}
