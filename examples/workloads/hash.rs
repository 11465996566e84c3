//! A hash of pictures, FNV-1a over pixels: emulated cores print it, and the host's is compared with it.

pub struct Hash(pub u32);

impl Hash {
    pub const NEW: Self = Self(0x811C_9DC5);

    pub fn add(&mut self, pixels: &[u16]) {
        for &pixel in pixels {
            self.0 = (self.0 ^ u32::from(pixel)).wrapping_mul(0x0100_0193);
        }
    }
}
