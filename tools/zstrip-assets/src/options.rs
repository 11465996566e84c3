//! Choices of the caller, and limits of what a file may ask for.

use std::path::PathBuf;

/// Choices for [`import`](crate::import()).
///
/// ```
/// use zstrip_assets::{Normals, Options, UpAxis};
///
/// let options = Options { up: Some(UpAxis::Z), normals: Normals::Smooth, ..Options::default() };
/// assert_eq!(options.crease_angle, 50.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The axis of the file that points up. `None` takes the custom of the format: z for STL, y for all others.
    pub up: Option<UpAxis>,
    /// A factor of all lengths, above 0.
    pub scale: f64,
    /// The point of the model that comes to the origin.
    pub center: Center,
    /// The side of triangles that is the front.
    pub winding: Winding,
    /// The origin of normals.
    pub normals: Normals,
    /// The largest angle, in degrees, between two faces whose common edge looks smooth. It counts where normals are
    /// made.
    pub crease_angle: f64,
    /// Vertices up to this distance from each other, in units of the file, are moved together. 0 leaves all where they
    /// are.
    pub weld_distance: f64,
    /// A budget of triangles for the whole model. Models of more are simplified.
    pub max_triangles: Option<usize>,
    /// Levels of detail that are made of each mesh, beside the mesh itself: 0 to 15. `zstrip::model::Model::place` then
    /// chooses the coarsest one whose error is below a pixel.
    pub lods: usize,
    /// The part of a level's triangles that the next level has: 0.05 to 0.9.
    pub lod_ratio: f64,
    /// The most vertices of a mesh; models of more are split. 3 to 65,535.
    pub max_vertices: usize,
    /// The most vertices of a cluster: 3 to 255.
    pub cluster_vertices: usize,
    /// The most triangles of a cluster: a multiple of 4, up to 512.
    pub cluster_triangles: usize,
    /// An image for all materials that have no texture, as for OBJ files without MTL. It may lie anywhere.
    pub texture: Option<PathBuf>,
    /// Limits of what a file may ask for.
    pub limits: Limits,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            up: None,
            scale: 1.0,
            center: Center::Keep,
            winding: Winding::Keep,
            normals: Normals::Keep,
            crease_angle: 50.0,
            weld_distance: 0.0,
            max_triangles: None,
            lods: 0,
            lod_ratio: 0.5,
            max_vertices: 65_535,
            cluster_vertices: 64,
            cluster_triangles: 124,
            texture: None,
            limits: Limits::default(),
        }
    }
}

impl Options {
    /// Returns the option that is out of its range, in words.
    pub(crate) fn fault(&self) -> Option<String> {
        let wrong = |name: &str, found: String, needed: &str| Some(format!("{name} is {found}, and must be {needed}"));
        if !(self.scale.is_finite() && self.scale > 0.0) {
            wrong("the scale", self.scale.to_string(), "above 0 and finite")
        } else if !(0.0..=180.0).contains(&self.crease_angle) {
            wrong("the crease angle", self.crease_angle.to_string(), "0 to 180 degrees")
        } else if !(self.weld_distance.is_finite() && self.weld_distance >= 0.0) {
            wrong("the weld distance", self.weld_distance.to_string(), "0 or above, and finite")
        } else if !(3..=65_535).contains(&self.max_vertices) {
            wrong("the most vertices of a mesh", self.max_vertices.to_string(), "3 to 65535")
        } else if !(3..=255).contains(&self.cluster_vertices) {
            wrong("the most vertices of a cluster", self.cluster_vertices.to_string(), "3 to 255")
        } else if !(4..=512).contains(&self.cluster_triangles) || !self.cluster_triangles.is_multiple_of(4) {
            wrong("the most triangles of a cluster", self.cluster_triangles.to_string(), "a multiple of 4, 4 to 512")
        } else if self.lods > 15 {
            wrong("the number of levels of detail", self.lods.to_string(), "0 to 15")
        } else if !(0.05..=0.9).contains(&self.lod_ratio) {
            wrong("the ratio of levels of detail", self.lod_ratio.to_string(), "0.05 to 0.9")
        } else if self.max_triangles == Some(0) {
            wrong("the budget of triangles", "0".to_owned(), "1 or more")
        } else {
            None
        }
    }
}

/// An axis that points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UpAxis {
    /// y, as in zstrip and glTF.
    Y,
    /// z, as in CAD and Blender. The model is turned so that it stands on its feet.
    Z,
}

/// The point of a model that comes to the origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Center {
    /// The origin of the file: nothing moves.
    Keep,
    /// The middle of its bounding box comes to the origin.
    Middle,
    /// The middle of the bottom of its bounding box comes to the origin.
    Ground,
}

/// The side of triangles that is the front.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Winding {
    /// Corners go counter-clockwise in the file.
    Keep,
    /// Corners go clockwise in the file; all triangles are turned over.
    Flip,
    /// Triangles whose normals in the file point to their back are turned over.
    FromNormals,
}

/// The origin of normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Normals {
    /// From the file. Missing ones are made, smooth up to the crease angle or as smoothing groups say.
    Keep,
    /// Made anew, smooth up to the crease angle.
    Smooth,
    /// Made anew, one for each face.
    Flat,
}

/// Limits of what a file may ask for. They are checked before memory is taken.
///
/// Reading takes at most `8 * file_bytes + 64 * numbers + 300 * json_values + 4 * texels` bytes of memory. For files
/// that are small beside their limits, it takes about 30 times their size.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of all files together: the model, its buffers, materials and images.
    pub file_bytes: u64,
    /// Numbers of all vertices, indices and keys, up to 2^31. A vertex with a normal has 6.
    pub numbers: u64,
    /// Values of a glTF document: brackets and commas.
    pub json_values: u64,
    /// Texels per row or column of an image.
    pub image_side: u32,
    /// Texels of all images together.
    pub texels: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { file_bytes: 256 << 20, numbers: 64 << 20, json_values: 2 << 20, image_side: 8192, texels: 64 << 20 }
    }
}
