//! Textures that do not repeat: their coordinates are brought to those that look the same where the texture repeats.
//!
//! Containers repeat textures, because the way to go on beyond a texture is a type in the library. A triangle that lies
//! in one tile of the texture, or beyond one of its clamped sides, looks the same with coordinates within 0 to 1. They
//! stay half a texel away from the sides, so that no rounding shows the texel at the opposite side.

use super::parts::Piece;
use super::report::{WriteNote, WriteReport};
use crate::model::{Import, Wrap};

/// Brings the coordinates of pieces into their textures. Those of pieces with triangles that cross a side repeat, and
/// are reported. Levels of detail are handled as the piece that they stand for.
pub(super) fn unwrap(pieces: &mut [Piece], import: &Import, sizes: &[Option<[u32; 2]>], report: &mut WriteReport) {
    let mut crosses: Vec<[bool; 2]> = Vec::with_capacity(pieces.len());
    for number in 0..pieces.len() {
        let piece = &mut pieces[number];
        crosses.push([false; 2]);
        let Some(Some(size)) = sizes.get(piece.material) else { continue };
        let material = &import.materials[piece.material];
        let (Some(texture), false) = (material.texture, piece.vertices.uvs.is_empty()) else { continue };
        let mut range = [[f32::INFINITY, f32::NEG_INFINITY]; 2];
        for uv in &piece.vertices.uvs {
            for (range, c) in range.iter_mut().zip(uv) {
                *range = [range[0].min(*c), range[1].max(*c)];
            }
        }
        for axis in 0..2 {
            let (wrap, half) = (texture.wrap[axis], 0.5 / f64::from(size[axis]));
            let at = |v: &u16| f64::from(piece.vertices.uvs[usize::from(*v)][axis]);
            crosses[number][axis] = match piece.finest {
                Some(finest) => crosses[finest][axis],
                None => piece.triangles.iter().any(|triangle| {
                    let low = triangle.iter().map(at).fold(f64::INFINITY, f64::min);
                    let high = triangle.iter().map(at).fold(f64::NEG_INFINITY, f64::max);
                    crosses_side(wrap, low, high, half)
                }),
            };
            if !crosses[number][axis] {
                piece.vertices.uvs.iter_mut().for_each(|uv| uv[axis] = inside(wrap, uv[axis], half));
            }
        }
        if piece.finest.is_none() && crosses[number] != [false; 2] {
            let wrap = [0, 1].map(|k| if crosses[number][k] { texture.wrap[k] } else { Wrap::Repeat });
            let (material, name) = (piece.material, material.name.clone());
            report.notes.push(WriteNote::Wrapped { material, name, wrap, range });
        }
    }
}

/// Returns whether a triangle is on both sides of a border of the texture, by more than half a texel on each.
fn crosses_side(wrap: Wrap, low: f64, high: f64, half: f64) -> bool {
    let is_across = |side: f64| low < side - half && high > side + half;
    match wrap {
        Wrap::Repeat => false,
        Wrap::Clamp => is_across(0.0) || is_across(1.0),
        // The first side above the least coordinate, and the next one.
        Wrap::Mirror => is_across((low + half).floor() + 1.0) || is_across((low + half).floor()),
    }
}

/// Returns the coordinate within the texture that shows the same texel.
fn inside(wrap: Wrap, c: f32, half: f64) -> f32 {
    let exact = f64::from(c);
    let folded = match wrap {
        Wrap::Repeat => return c,
        Wrap::Clamp => exact,
        // A wave of length 2 that goes up and down.
        Wrap::Mirror => 1.0 - (exact.rem_euclid(2.0) - 1.0).abs(),
    };
    folded.clamp(half, 1.0 - half) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The texel of a texture of `size` texels that a coordinate shows.
    fn texel(wrap: Wrap, c: f64, size: i64) -> i64 {
        let k = (c * size as f64).floor() as i64;
        match wrap {
            Wrap::Repeat => k.rem_euclid(size),
            Wrap::Clamp => k.clamp(0, size - 1),
            Wrap::Mirror => {
                let k = k.rem_euclid(2 * size);
                k.min(2 * size - 1 - k)
            }
        }
    }

    #[test]
    fn coordinates_within_the_texture_show_the_same_texels() {
        for wrap in [Wrap::Clamp, Wrap::Mirror, Wrap::Repeat] {
            for size in [1, 2, 8, 256] {
                // Middles of texels, at four tiles and more on both sides.
                for k in -5 * size..5 * size {
                    let c = (k as f64 + 0.5) / size as f64;
                    let found = f64::from(inside(wrap, c as f32, 0.5 / size as f64));
                    assert_eq!(texel(Wrap::Repeat, found, size), texel(wrap, c, size), "{wrap:?} {size} {c}: {found}");
                }
                if wrap != Wrap::Repeat {
                    for side in [-2.0, -1.0, 0.0, 1.0, 2.0] {
                        let half = 0.5 / size as f64;
                        let found = f64::from(inside(wrap, side, half));
                        assert!((half..=1.0 - half).contains(&found), "{wrap:?} {size} {side}: {found}");
                    }
                }
            }
        }
    }

    #[test]
    fn triangles_that_show_both_sides_of_a_border_are_found() {
        for (wrap, low, high, crosses) in [
            (Wrap::Repeat, -3.0, 3.0, false),
            (Wrap::Clamp, 0.0, 1.0, false),
            (Wrap::Clamp, -0.004, 1.004, false),
            (Wrap::Clamp, -3.0, -0.5, false),
            (Wrap::Clamp, 1.0, 9.0, false),
            (Wrap::Clamp, -0.5, 0.5, true),
            (Wrap::Clamp, 0.9, 1.1, true),
            (Wrap::Mirror, 0.0, 1.0, false),
            (Wrap::Mirror, -1.0, 0.0, false),
            (Wrap::Mirror, 2.0, 3.0, false),
            (Wrap::Mirror, 1.998, 3.002, false),
            (Wrap::Mirror, 0.5, 1.5, true),
            (Wrap::Mirror, -0.5, 0.5, true),
            (Wrap::Mirror, 0.0, 2.0, true),
        ] {
            assert_eq!(crosses_side(wrap, low, high, 0.5 / 64.0), crosses, "{wrap:?} {low} {high}");
        }
    }
}
