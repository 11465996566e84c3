//! Material captures: a picture of a lit ball, from which a surface takes the colour of its normal.

use crate::color::PixelFormat;
use crate::light::{NormalMatrix, turned};
use crate::math::{Affine, Vec3};
use crate::span::{Fragment, Shader};
use crate::vertex::{VertexRef, VertexShader};

/// Shades by a picture of a ball in eye space, `N` × `N` pixels of format `T`. The surface looks as lit as the ball
/// does, of any material and under any light, for one look-up per fragment.
///
/// Rows go from the top down; `N` is a power of two. Normals are interpolated linearly on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matcap<'a, T: PixelFormat, const N: usize> {
    picture: &'a [[T::Raw; N]; N],
    /// Directions to the right and down in eye space, seen from object space, 2.14; from eye space if normals are
    /// brought there.
    right: [i32; 3],
    down: [i32; 3],
    normals: Option<NormalMatrix>,
}

impl<'a, T: PixelFormat, const N: usize> Matcap<'a, T, N> {
    /// Returns the shader of a picture for a mesh that `model` (which may be any transform) brings into eye space.
    #[must_use]
    pub fn new(picture: &'a [[T::Raw; N]; N], model: &Affine) -> Self {
        const { assert!(N.is_power_of_two() && N <= 4096, "the side of a matcap is a power of two, up to 4096") };
        let normals = NormalMatrix::new(model);
        let [x, y, _] = if normals.is_some() { Affine::IDENTITY.to_rows() } else { model.to_rows() };
        let unit = |row: [i32; 4], sign: i32| {
            let row = Vec3::from_bits([row[0], row[1], row[2]]).normalized().unwrap_or(Vec3::ZERO);
            row.to_bits().map(|c| sign * ((c + 2) >> 2))
        };
        Self { picture, right: unit(x, 1), down: unit(y, -1), normals }
    }
}

/// Converts a normal's component along an axis (2.14) to a place in the picture: 0 to 1, 2.30. A 512th is left out at
/// either end, so that rounding does not lead out of the picture.
#[inline]
fn place(normal: [i16; 3], axis: [i32; 3]) -> i32 {
    let [x, y, z] = normal.map(i32::from);
    let dot = x.wrapping_mul(axis[0]).wrapping_add(y.wrapping_mul(axis[1])).wrapping_add(z.wrapping_mul(axis[2]));
    // 4.28, between -1 and 1, half of it; rounded to 14 bits.
    let dot = dot.clamp(-(1 << 28), 1 << 28);
    ((dot - (dot >> 8)).wrapping_mul(2) + (1 << 29) + (1 << 15)) & !0xFFFF
}

impl<T: PixelFormat, const N: usize> VertexShader for Matcap<'_, T, N> {
    /// Column and row, 2.30.
    type Varyings = [i32; 2];

    const WORDS: usize = 1;
    const ZERO_BITS: u32 = 16;

    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 2] {
        let normal = turned(&self.normals, vertex.normal());
        [place(normal, self.right), place(normal, self.down)]
    }

    #[inline]
    fn store(place: &[i32; 2], words: &mut [u32]) {
        if let [word] = words {
            *word = (place[0] as u32 & 0xFFFF_0000) | (place[1] as u32 >> 16);
        }
    }

    #[inline]
    fn load(words: &[u32]) -> [i32; 2] {
        let word = words.first().copied().unwrap_or(0);
        [(word & 0xFFFF_0000) as i32, (word << 16) as i32]
    }
}

impl<P: PixelFormat, T: PixelFormat, const N: usize> Shader<P> for Matcap<'_, T, N> {
    type Setup = ();

    #[inline]
    fn fragment(&self, fragment: &Fragment<'_, [i32; 2]>) -> Option<P::Raw> {
        let [u, v] = *fragment.varyings;
        // N is a power of two, so the mask keeps any place in the picture.
        let along = |place: i32| (place as usize >> (30 - N.trailing_zeros())) & (N - 1);
        let texel = self.picture.get(along(v)).and_then(|row| row.get(along(u)))?;
        Some(P::pack_at(T::unpack(*texel), fragment.position))
    }
}
