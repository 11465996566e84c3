//! Packs texture coordinates: those of a part come in; numbers of 16 or 8 bits go out, with their step and offset.

use super::options::UvSize;
use super::quantize::fixed;
use super::report::WriteError;

/// Packed texture coordinates.
pub(super) struct Uvs {
    pub stored: Vec<[u16; 2]>,
    pub offset: [i32; 2],
    pub shift: u8,
    pub bits: u8,
}

impl Default for Uvs {
    fn default() -> Self {
        Self { stored: Vec::new(), offset: [0; 2], shift: 0, bits: 16 }
    }
}

impl Uvs {
    /// Packs coordinates. Their whole part is left out as far as it is common to all, because textures repeat.
    ///
    /// A coordinate is off by half a step at most, and the largest one by a whole step at most.
    pub fn of(uvs: &[[f32; 2]], size: UvSize, name: &str) -> Result<Self, WriteError> {
        if uvs.is_empty() {
            return Ok(Self::default());
        }
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for uv in uvs {
            for k in 0..2 {
                let c = f64::from(uv[k]);
                if !c.is_finite() {
                    return Err(WriteError::NotFinite { place: format!("a texture coordinate of {name}") });
                }
                (low[k], high[k]) = (low[k].min(c), high[k].max(c));
            }
        }
        let whole = low.map(f64::floor);
        let mut offset = [0; 2];
        let mut range: f64 = 0.0;
        for k in 0..2 {
            let place = || format!("the range of texture coordinates of {name}");
            offset[k] = fixed(low[k] - whole[k], place)?;
            range = range.max(high[k] - whole[k] - f64::from(offset[k]) / 65_536.0);
            fixed(range, place)?;
        }
        let numbers = |shift: u32, most: f64| -> Vec<[u16; 2]> {
            let step = f64::from(1 << shift);
            let number = |uv: &[f32; 2], k: usize| {
                let c = (f64::from(uv[k]) - whole[k]) * 65_536.0 - f64::from(offset[k]);
                (c / step).round().clamp(0.0, most) as u16
            };
            uvs.iter().map(|uv| [number(uv, 0), number(uv, 1)]).collect()
        };
        // The smallest step with which the largest coordinate is at most one step beyond the last number.
        let shift_for =
            |count: f64| (0..15).find(|shift| range * 65_536.0 <= count * f64::from(1 << shift)).unwrap_or(15);
        let shift = shift_for(65_536.0);
        let stored = numbers(shift, 65_535.0);
        let found = Self { stored, offset, shift: shift as u8, bits: 16 };
        let small_shift = shift_for(256.0);
        let small = Self { stored: numbers(small_shift, 255.0), offset, shift: small_shift as u8, bits: 8 };
        let value = |uvs: &Self, v: usize, k: usize| f64::from(uvs.stored[v][k]) * f64::from(1 << uvs.shift);
        let exact = || {
            // Any step may hold all of them, the smallest one that has the range and the larger ones.
            (small_shift..=15).find_map(|shift| {
                let small = Self { stored: numbers(shift, 255.0), offset, shift: shift as u8, bits: 8 };
                let is_exact = (0..uvs.len()).all(|v| {
                    (0..2).all(|k| {
                        let c = (f64::from(uvs[v][k]) - whole[k]) * 65_536.0 - f64::from(offset[k]);
                        (value(&small, v, k) - c).abs() <= 0.5
                    })
                });
                is_exact.then_some(small)
            })
        };
        Ok(match size {
            UvSize::Bits8 => small,
            UvSize::Bits16 => found,
            UvSize::Fitting => exact().unwrap_or(found),
        })
    }
}
