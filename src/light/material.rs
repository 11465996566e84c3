//! What a surface does to light.

use embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};

/// How a surface reflects: the colours of ambient, diffuse and specular light, and how sharp its highlights are.
///
/// ```
/// use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, RgbColor, WebColors};
/// use zstrip::light::Material;
/// let glazed = Material { two_sided: true, ..Material::glossy(Rgb888::CSS_TEAL, Rgb888::WHITE, 64) };
/// # let _ = glazed;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Material {
    /// Colour under ambient light.
    pub ambient: [u8; 3],
    /// Colour under directional and point lights.
    pub diffuse: [u8; 3],
    /// Colour of highlights; black for none.
    pub specular: [u8; 3],
    /// Exponent of the highlights, 1 to 255: the higher, the smaller; powers of two are cheapest. 0 for none.
    pub shininess: u8,
    /// Whether normals of faces that show their back are turned round.
    pub two_sided: bool,
    /// Whether the mesh's colours take part: ambient and diffuse colours are multiplied by them.
    pub vertex_colors: bool,
}

impl Material {
    /// A dull surface.
    pub fn matte(color: impl Into<Rgb888>) -> Self {
        let color: Rgb888 = color.into();
        let color = [color.r(), color.g(), color.b()];
        Self { ambient: color, diffuse: color, specular: [0; 3], shininess: 0, two_sided: false, vertex_colors: false }
    }

    /// A surface with highlights of a colour and an exponent.
    pub fn glossy(color: impl Into<Rgb888>, highlight: impl Into<Rgb888>, shininess: u8) -> Self {
        let highlight: Rgb888 = highlight.into();
        Self { specular: [highlight.r(), highlight.g(), highlight.b()], shininess, ..Self::matte(color) }
    }
}
