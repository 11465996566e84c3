//! Materials of glTF: base colour, its texture, alpha, sides, and whether they are lit.

use std::borrow::Cow;

use gltf::json::extensions::texture::TextureTransform;
use gltf::json::material::AlphaMode as Mode;
use gltf::json::texture::{Info, MagFilter, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{self, Root};

use super::accessor::{Buffers, place};
use crate::draft::Context;
use crate::error::Error;
use crate::model::{AlphaMode, Material, Texture, Wrap};
use crate::report::Note;

pub(super) fn read(json: &Root, buffers: &Buffers, context: &mut Context) -> Result<Vec<Material>, Error> {
    json.materials.iter().map(|material| read_one(json, material, buffers, context)).collect()
}

fn read_one(
    json: &Root,
    material: &json::Material,
    buffers: &Buffers,
    context: &mut Context,
) -> Result<Material, Error> {
    let base = &material.pbr_metallic_roughness;
    let [r, g, b, a] = base.base_color_factor.0;
    let alpha = match material.alpha_mode {
        Checked::Valid(Mode::Mask) => {
            AlphaMode::Mask { cutoff: material.alpha_cutoff.map_or(0.5, |cutoff| cutoff.0).clamp(0.0, 1.0) }
        }
        Checked::Valid(Mode::Blend) => AlphaMode::Blend,
        Checked::Valid(Mode::Opaque) | Checked::Invalid => AlphaMode::Opaque,
    };
    for (texture, what) in [
        (material.normal_texture.is_some(), "normal texture"),
        (material.occlusion_texture.is_some(), "occlusion texture"),
        (material.emissive_texture.is_some(), "emissive texture"),
        (base.metallic_roughness_texture.is_some(), "metallic-roughness texture"),
    ] {
        if texture {
            context.ignore(what);
        }
    }
    Ok(Material {
        name: material.name.clone().unwrap_or_default(),
        color: [srgb(r), srgb(g), srgb(b), a.clamp(0.0, 1.0)],
        texture: base.base_color_texture.as_ref().and_then(|info| texture(json, info, buffers, context)),
        alpha,
        double_sided: material.double_sided,
        unlit: material.extensions.as_ref().is_some_and(|extensions| extensions.unlit.is_some()),
    })
}

/// The sRGB encoding of linear light from 0 to 1.
///
/// Textures are factors of colours in light. The product of encoded numbers is within a few hundredths of the encoded
/// product, since the encoding is nearly a power.
pub(super) fn srgb(x: f32) -> f32 {
    let x = x.clamp(0.0, 1.0);
    let encoded = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    // Rounding would leave white a little short of 1.
    if x == 1.0 { 1.0 } else { encoded }
}

/// A texture whose image can be read. One whose image cannot is reported: the shape is good without it.
fn texture(json: &Root, info: &Info, buffers: &Buffers, context: &mut Context) -> Option<Texture> {
    let texture = json.textures.get(info.index.value())?;
    let number = texture.source.value();
    let image = match image(json, number, buffers, context) {
        Ok(image) => image,
        Err(reason) => {
            context.report.add(Note::TextureMissing { reason });
            return None;
        }
    };
    let sampler = texture.sampler.and_then(|sampler| json.samplers.get(sampler.value()));
    let wrap = |mode: Checked<WrappingMode>| match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        Checked::Valid(WrappingMode::Repeat) | Checked::Invalid => Wrap::Repeat,
    };
    Some(Texture {
        image,
        wrap: sampler.map_or([Wrap::Repeat; 2], |sampler| [wrap(sampler.wrap_s), wrap(sampler.wrap_t)]),
        nearest: sampler.is_some_and(|sampler| sampler.mag_filter == Some(Checked::Valid(MagFilter::Nearest))),
    })
}

fn image(json: &Root, number: usize, buffers: &Buffers, context: &mut Context) -> Result<usize, String> {
    let Some(image) = json.images.get(number) else {
        return Err("a texture without an image that is read; export it with PNG or JPEG".to_owned());
    };
    let name = image.name.clone().or_else(|| image.uri.clone().filter(|uri| !uri.starts_with("data:")));
    let at = place("images", number);
    let embedded = match image.buffer_view {
        Some(view) => Some(buffers.view(json, view, context).map_err(|error| error.to_string())?),
        None => None,
    };
    let Context { images, files, options, .. } = context;
    let name = name.unwrap_or_else(|| format!("images[{number}]"));
    images.of_file(&number.to_string(), &name, &options.limits, || match (embedded, &image.uri) {
        (Some(bytes), _) => Ok(Cow::Borrowed(bytes)),
        (None, Some(uri)) => files.read_uri(uri, at).map(Cow::Owned).map_err(|error| error.to_string()),
        (None, None) => Err(format!("{name}: neither a URI nor a buffer view")),
    })
}

/// The origin of a material's texture coordinates, and the way in which they are moved.
pub(super) struct Mapping {
    /// The number of the set of coordinates.
    pub set: u32,
    transform: Option<TextureTransform>,
}

impl Mapping {
    /// Returns the mapping of a material's base texture.
    pub fn of(json: &Root, material: Option<usize>) -> Self {
        let material = material.and_then(|number| json.materials.get(number));
        let info = material.and_then(|material| material.pbr_metallic_roughness.base_color_texture.as_ref());
        let transform = info.and_then(|info| info.extensions.as_ref()?.texture_transform.clone());
        let set = transform.as_ref().and_then(|t| t.tex_coord).or(info.map(|info| info.tex_coord));
        Self { set: set.unwrap_or(0), transform }
    }

    /// Returns coordinates that need no transform any more.
    pub fn apply(&self, uv: [f32; 2]) -> [f32; 2] {
        let Some(TextureTransform { offset, rotation, scale, .. }) = &self.transform else { return uv };
        let (sin, cos) = rotation.0.sin_cos();
        let [u, v] = [uv[0] * scale.0[0], uv[1] * scale.0[1]];
        // Counter-clockwise as seen, which is with v down.
        [cos * u + sin * v + offset.0[0], cos * v - sin * u + offset.0[1]]
    }
}
