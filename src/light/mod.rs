//! Lights and materials, in a mesh's own space.

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
