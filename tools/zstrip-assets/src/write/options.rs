//! Choices for the writer.

/// Choices for [`write`](crate::write()).
#[derive(Clone, Debug, PartialEq)]
pub struct WriteOptions {
    /// The format of textures.
    pub textures: TextureKind,
    /// The most texels per side of a texture; larger images are shrunk. Sides become powers of two.
    pub max_texture: u32,
    /// True for textures with smaller levels, for models that are far away: a third more bytes.
    pub mips: bool,
    /// The size of texture coordinates.
    pub uvs: UvSize,
    /// The largest distance, as a part of the model's size, by which leaving out a key of an animation may move
    /// something. A rotation may be off by that angle in radians. 0 keeps all keys.
    pub key_error: f64,
}

impl Default for WriteOptions {
    fn default() -> Self {
        Self { textures: TextureKind::Rgb565, max_texture: 256, mips: true, uvs: UvSize::Fitting, key_error: 0.0005 }
    }
}

impl WriteOptions {
    /// Returns the option that is out of its range, in words.
    pub(crate) fn fault(&self) -> Option<String> {
        if !(1..=32_768).contains(&self.max_texture) {
            Some(format!("the size of textures is {}, and must be 1 to 32768", self.max_texture))
        } else if !(0.0..=0.1).contains(&self.key_error) {
            Some(format!("the error of keys is {}, and must be 0 to 0.1", self.key_error))
        } else {
            None
        }
    }
}

/// A format of textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureKind {
    /// Two bytes per texel. It is drawn the fastest.
    Rgb565,
    /// A palette of up to 256 colours, with as few bits per texel as its colours need.
    Palette,
    /// A palette of up to 16 colours: half a byte per texel.
    Palette16,
    /// One byte per texel.
    Gray,
    /// One bit per texel: white, or nothing.
    Mask,
}

/// A size of texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UvSize {
    /// 8 bits where they hold the coordinates exactly, and 16 otherwise.
    Fitting,
    /// 8 bits, whatever is lost.
    Bits8,
    /// 16 bits.
    Bits16,
}
