//! Materials: what surfaces do to light.

use crate::color::channels;
use embedded_graphics_core::pixelcolor::Rgb888;

/// A material without highlights, which any light can be put on, a [`Sun`](crate::light::Sun) too.
///
/// ```
/// use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, WebColors};
/// use zstrip::light::{Material, Matte};
/// let clay = Material::matte(Rgb888::CSS_SIENNA);
/// // In a constant, colours are bytes: red, green, blue.
/// const PAINTED: Matte = Matte::from_channels([255; 3]).vertex_colors();
/// # let _ = (clay, PAINTED);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub struct Matte {
    /// Red, green and blue, as all colours here.
    pub(super) ambient: [u8; 3],
    pub(super) diffuse: [u8; 3],
    pub(super) vertex_colors: bool,
}

impl Matte {
    /// White, as a surface is whose colours are those of a texture or of the vertices.
    pub const WHITE: Self = Self::from_channels([255; 3]);

    /// Returns the material of a colour.
    pub fn new(color: impl Into<Rgb888>) -> Self {
        Self::from_channels(channels(color.into()))
    }

    /// Returns the material of a colour for constants: red, green and blue.
    pub const fn from_channels(color: [u8; 3]) -> Self {
        Self { ambient: color, diffuse: color, vertex_colors: false }
    }

    /// Sets the colour under ambient light; otherwise it is the material's.
    pub fn with_ambient(self, color: impl Into<Rgb888>) -> Self {
        Self { ambient: channels(color.into()), ..self }
    }

    /// Multiplies the material's colour by those of the mesh's vertices.
    pub const fn vertex_colors(self) -> Self {
        Self { vertex_colors: true, ..self }
    }

    /// Turns the normals of faces that show their back, so that both sides are lit. A [`Sun`](crate::light::Sun) cannot
    /// do that, as it does not know the viewer: the result is a [`Material`].
    pub const fn two_sided(self) -> Material {
        Material { matte: self, specular: [0; 3], shininess: 0, two_sided: true }
    }
}

/// A material under any [`Lighting`](crate::light::Lighting): the colours of ambient, diffuse and specular light, and
/// how sharp its highlights are.
///
/// ```
/// use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, RgbColor, WebColors};
/// use zstrip::light::Material;
/// let glazed = Material::glossy(Rgb888::CSS_TEAL, Rgb888::WHITE, 64).two_sided();
/// # let _ = glazed;
/// ```
///
/// A sun has no highlights, so it takes no glossy material:
///
/// ```compile_fail
/// # use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, RgbColor, WebColors};
/// # use zstrip::light::{Material, Sun};
/// # use zstrip::math::{Affine, Vec3};
/// # let sun = Sun::new(Vec3::Y, Rgb888::WHITE, Rgb888::BLACK);
/// sun.on(&Material::glossy(Rgb888::CSS_TEAL, Rgb888::WHITE, 64), &Affine::IDENTITY);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub struct Material {
    pub(super) matte: Matte,
    pub(super) specular: [u8; 3],
    pub(super) shininess: u8,
    pub(super) two_sided: bool,
}

impl Material {
    /// Returns a material without highlights.
    pub fn matte(color: impl Into<Rgb888>) -> Matte {
        Matte::new(color)
    }

    /// Returns a material with highlights of a colour and an exponent of 1 to 255: the higher it is, the smaller they
    /// are. Powers of two are cheapest. An exponent of 0 means no highlights.
    pub fn glossy(color: impl Into<Rgb888>, highlight: impl Into<Rgb888>, shininess: u8) -> Self {
        let specular = channels(highlight.into());
        Self { matte: Matte::new(color), specular, shininess, two_sided: false }
    }

    /// Returns the material without highlights, lit on one side.
    pub const fn body(&self) -> Matte {
        self.matte
    }

    /// Sets the colour under ambient light; otherwise it is the material's.
    pub fn with_ambient(self, color: impl Into<Rgb888>) -> Self {
        Self { matte: self.matte.with_ambient(color), ..self }
    }

    /// Multiplies the material's colour by those of the mesh's vertices; highlights keep their colour.
    pub const fn vertex_colors(self) -> Self {
        Self { matte: self.matte.vertex_colors(), ..self }
    }

    /// Turns the normals of faces that show their back, so that both sides are lit.
    ///
    /// A vertex may belong to faces of both sides. Where light is computed per vertex, its normal is turned towards the
    /// viewer.
    pub const fn two_sided(self) -> Self {
        Self { two_sided: true, ..self }
    }
}

impl From<Matte> for Material {
    fn from(matte: Matte) -> Self {
        Self { matte, specular: [0; 3], shininess: 0, two_sided: false }
    }
}

impl From<&Matte> for Material {
    fn from(matte: &Matte) -> Self {
        Self::from(*matte)
    }
}

impl From<&Self> for Material {
    fn from(material: &Self) -> Self {
        *material
    }
}
