//! Data of an imported model: meshes, materials, images, nodes, skins and animations, all in floats.

/// A model as it was read: plain data, ready to be quantized.
///
/// y points up, and the front of a triangle is where its corners go counter-clockwise. Texture coordinates are those of
/// zstrip: u to the right, v down, 1 is the whole texture. Colours are sRGB encoded, 0 to 1, as zstrip mixes them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Import {
    /// Nodes, each after its parent.
    pub nodes: Vec<Node>,
    /// Meshes, each with one material and 65,535 vertices at most.
    pub meshes: Vec<Mesh>,
    /// Materials, as meshes number them.
    pub materials: Vec<Material>,
    /// Images, as textures number them.
    pub images: Vec<Image>,
    /// Skins, as nodes number them.
    pub skins: Vec<Skin>,
    /// Clips of animation.
    pub animations: Vec<Animation>,
}

/// A place in the hierarchy, and the meshes that are drawn there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Node {
    /// The name in the file, or nothing.
    pub name: String,
    /// The number of the parent, which is less than the node's own.
    pub parent: Option<usize>,
    /// The place relative to the parent.
    pub transform: Transform,
    /// Meshes that are drawn here. A mesh of a file is several of them where it has several materials or was split.
    pub meshes: Vec<usize>,
    /// The skin of these meshes. Their vertices then follow its joints, and not this node.
    pub skin: Option<usize>,
    /// Weights of the meshes' morph targets.
    pub weights: Vec<f32>,
}

/// A place relative to a parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transform {
    /// Scaled, then turned, then moved. The quaternion is x, y, z, w, and has length 1.
    Parts {
        /// The way to move.
        translation: [f32; 3],
        /// The rotation as a unit quaternion: x, y, z, w.
        rotation: [f32; 4],
        /// The factor of each axis.
        scale: [f32; 3],
    },
    /// A matrix of four columns; the last row is 0, 0, 0, 1.
    Matrix([[f32; 4]; 4]),
}

impl Default for Transform {
    fn default() -> Self {
        Self::Parts { translation: [0.0; 3], rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] }
    }
}

/// Vertices as one list per attribute. A list is empty where the file has no such attribute.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vertices {
    /// Positions: one per vertex.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates: u to the right, v down.
    pub uvs: Vec<[f32; 2]>,
    /// Red, green, blue and alpha, sRGB encoded, 0 to 1.
    pub colors: Vec<[f32; 4]>,
    /// Numbers of joints in the skin, the one of the largest weight first.
    pub joints: Vec<[u16; 4]>,
    /// Weights of these joints: from large to small, with the sum 1.
    pub weights: Vec<[f32; 4]>,
    /// Morph targets.
    pub morphs: Vec<Morph>,
}

/// A morph target: what it adds to each vertex at weight 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Morph {
    /// Differences of positions: one per vertex.
    pub positions: Vec<[f32; 3]>,
    /// Differences of normals, or none.
    pub normals: Vec<[f32; 3]>,
}

/// Triangles with one material.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The name in the file, or nothing.
    pub name: String,
    /// The material, or none: white.
    pub material: Option<usize>,
    /// The vertices, in the order in which triangles first use them.
    pub vertices: Vertices,
    /// Three numbers of vertices per triangle, in the order of clusters.
    pub triangles: Vec<[u32; 3]>,
    /// Consecutive runs of triangles, which together are all of them.
    pub clusters: Vec<Cluster>,
    /// A mesh of a higher number that can stand for this one where it is small on the screen: its next level of detail.
    /// No node shows it.
    pub coarser: Option<usize>,
    /// Of a level of detail: a bound of the distance between it and the mesh that it stands for, in units of the mesh.
    /// It grows from level to level.
    pub error: f64,
}

/// A run of triangles that lie close to each other, with bounds to cull it as a whole.
///
/// Bounds are those of the pose without animation.
#[derive(Clone, Debug, PartialEq)]
pub struct Cluster {
    /// The first triangle.
    pub first: usize,
    /// The number of triangles.
    pub count: usize,
    /// The number of vertices that its triangles use.
    pub vertices: usize,
    /// The smallest box around it.
    pub bounds: Bounds,
    /// A cone that holds the normals of all its triangles, or none where they point into too many directions.
    pub cone: Option<Cone>,
}

/// A cone of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// The unit vector in the middle.
    pub axis: [f32; 3],
    /// The cosine of the largest angle between the axis and a normal of a triangle; it is above 0, and rounded down.
    pub cosine: f32,
}

/// A box along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The corner of least x, y and z.
    pub min: [f32; 3],
    /// The corner of greatest x, y and z.
    pub max: [f32; 3],
}

impl Bounds {
    /// Returns the smallest box around points, or none where there are none.
    pub fn around(points: impl IntoIterator<Item = [f32; 3]>) -> Option<Self> {
        points.into_iter().fold(None, |bounds: Option<Self>, p| {
            let Self { min, max } = bounds.unwrap_or(Self { min: p, max: p });
            Some(Self {
                min: std::array::from_fn(|k| min[k].min(p[k])),
                max: std::array::from_fn(|k| max[k].max(p[k])),
            })
        })
    }

    /// Returns the lengths of its edges along x, y and z.
    pub fn size(&self) -> [f32; 3] {
        std::array::from_fn(|k| self.max[k] - self.min[k])
    }
}

/// The look of triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name in the file, or nothing.
    pub name: String,
    /// Red, green, blue and alpha, sRGB encoded. They are factors of the texture and of vertex colours.
    pub color: [f32; 4],
    /// The texture of the base colour.
    pub texture: Option<Texture>,
    /// The meaning of alpha.
    pub alpha: AlphaMode,
    /// True where back faces are drawn too.
    pub double_sided: bool,
    /// True where light does not matter.
    pub unlit: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            color: [1.0; 4],
            texture: None,
            alpha: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
        }
    }
}

/// A reference to an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Texture {
    /// The number of the image.
    pub image: usize,
    /// The way to go on beyond the image, to the right and down.
    pub wrap: [Wrap; 2],
    /// True where texels are shown as squares, and false where they are filtered.
    pub nearest: bool,
}

/// The way in which a texture goes on beyond its image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The image is repeated.
    #[default]
    Repeat,
    /// Every second image is mirrored.
    Mirror,
    /// The texels at the border go on.
    Clamp,
}

/// The meaning of alpha.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored.
    Opaque,
    /// Texels with an alpha below the cutoff are left out.
    Mask {
        /// The least alpha that is drawn.
        cutoff: f32,
    },
    /// Alpha blends with what lies behind.
    Blend,
}

/// A decoded image.
#[derive(Clone, PartialEq, Eq)]
pub struct Image {
    /// The file, or the name in the glTF document, or nothing.
    pub name: String,
    /// Texels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue and alpha of each texel, from the left to the right, from the top to the bottom.
    pub texels: Vec<u8>,
}

impl std::fmt::Debug for Image {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Image {{ {:?}, {}×{} }}", self.name, self.width, self.height)
    }
}

/// Joints that meshes follow.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skin {
    /// The name in the file, or nothing.
    pub name: String,
    /// Numbers of nodes.
    pub joints: Vec<usize>,
    /// For each joint, the four columns of the matrix from the mesh to the joint in the pose of binding.
    pub inverse_binds: Vec<[[f32; 4]; 4]>,
}

/// A clip: channels that move nodes together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Animation {
    /// The name in the file, or nothing.
    pub name: String,
    /// The channels, each for another node or path.
    pub channels: Vec<Channel>,
}

impl Animation {
    /// Returns the time of the last key, in seconds.
    pub fn duration(&self) -> f32 {
        self.channels.iter().filter_map(|channel| channel.times.last()).fold(0.0, |end, time| end.max(*time))
    }
}

/// Keys of one property of one node.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// The number of the node.
    pub node: usize,
    /// The property.
    pub path: Path,
    /// The way from key to key.
    pub interpolation: Interpolation,
    /// Times of keys in seconds, each later than the one before.
    pub times: Vec<f32>,
    /// Values of keys: [`width`](Self::width) numbers for each. Cubic keys have three times as many: the tangent before
    /// the key, the value, the tangent after it.
    pub values: Vec<f32>,
}

impl Channel {
    /// Returns how many numbers a value has: 3, or 4 for rotations, or one per morph target.
    pub fn width(&self) -> usize {
        let per_key = if self.interpolation == Interpolation::Cubic { 3 } else { 1 };
        self.values.len().checked_div(self.times.len() * per_key).unwrap_or(0)
    }
}

/// The property that a channel moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Path {
    /// Three numbers.
    Translation,
    /// A unit quaternion: x, y, z, w.
    Rotation,
    /// Three factors.
    Scale,
    /// A weight for each morph target.
    Weights,
}

/// The way from key to key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Straight, and along the arc for rotations.
    Linear,
    /// A value holds until the next key.
    Step,
    /// A cubic Hermite spline.
    Cubic,
}
