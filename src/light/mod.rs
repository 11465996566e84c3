//! Lights and materials, in a mesh's own space. A program meets [`Light`] first: one direction and one ambient
//! colour. [`Lighting`] and [`Material`] are for several lights and for highlights.

mod light;
mod lighting;
mod lit_material;
mod local_space;
mod material;

pub use light::{Light, Lit, NORMAL_ONE};
pub use lighting::{DirectionalLight, Lighting, PointLight, Viewer};
pub use lit_material::LitMaterial;
pub use local_space::LocalSpace;
pub use material::Material;
