//! Textures that do not repeat: their coordinates are brought to those that look the same where the texture repeats.
//!
//! Containers repeat textures, because the way to go on beyond a texture is a type in the library. A triangle that lies
//! in one tile of the texture, or beyond one of its clamped sides, looks the same with coordinates within 0 to 1. They
//! stay half a texel away from the sides, so that no rounding shows the texel at the opposite side. Triangles that
//! cross a side have been cut there ([`cut`](super::cut)).

use super::parts::Piece;
use super::report::{WriteNote, WriteReport};
use crate::model::{Import, Wrap};

/// Brings the coordinates of pieces into their textures. Those of pieces with triangles that still cross a side repeat,
/// and are reported. Levels of detail repeat where the piece that they stand for does.
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
            let of_finest = piece.finest.is_some_and(|finest| crosses[finest][axis]);
            crosses[number][axis] = of_finest
                || piece.triangles.iter().any(|triangle| {
                    let low = triangle.iter().map(at).fold(f64::INFINITY, f64::min);
                    let high = triangle.iter().map(at).fold(f64::NEG_INFINITY, f64::max);
                    crossed(wrap, low, high, half).next().is_some()
                });
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

/// The most tiles of a mirrored texture that are looked at for a triangle.
const MOST_TILES: f64 = 64.0;

/// Returns the sides of the texture that a triangle crosses: its coordinates, from `low` to `high`, reach beyond the
/// side by more than half a texel in both directions.
///
/// A texture of one texel looks the same everywhere, so nothing crosses its sides.
pub(super) fn crossed(wrap: Wrap, low: f64, high: f64, half: f64) -> impl Iterator<Item = f64> {
    // The first side above the least coordinate, and the number of those that may be crossed.
    let (first, count) = match wrap {
        Wrap::Clamp if half < 0.5 => (0.0, 2),
        // Sides that are not numbers are below no coordinate and above none, so none of them is crossed.
        Wrap::Mirror if half < 0.5 => ((low + half).floor(), (high - low + 2.0).ceil().min(MOST_TILES) as u32),
        _ => (0.0, 0),
    };
    let sides = (0..count).map(move |k| first + f64::from(k));
    sides.filter(move |side| low < side - half && high > side + half)
}

/// Returns the coordinate within the texture that shows the same texel.
pub(super) fn inside(wrap: Wrap, c: f32, half: f64) -> f32 {
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
    fn sides_that_a_triangle_shows_both_sides_of_are_found() {
        for (wrap, low, high, sides) in [
            (Wrap::Repeat, -3.0, 3.0, &[][..]),
            (Wrap::Clamp, 0.0, 1.0, &[]),
            (Wrap::Clamp, -0.004, 1.004, &[]),
            (Wrap::Clamp, -3.0, -0.5, &[]),
            (Wrap::Clamp, 1.0, 9.0, &[]),
            (Wrap::Clamp, -0.5, 0.5, &[0.0]),
            (Wrap::Clamp, 0.9, 1.1, &[1.0]),
            (Wrap::Clamp, -9.0, 9.0, &[0.0, 1.0]),
            (Wrap::Mirror, 0.0, 1.0, &[]),
            (Wrap::Mirror, -1.0, 0.0, &[]),
            (Wrap::Mirror, 2.0, 3.0, &[]),
            (Wrap::Mirror, 1.998, 3.002, &[]),
            (Wrap::Mirror, 0.5, 1.5, &[1.0]),
            (Wrap::Mirror, -0.5, 0.5, &[0.0]),
            (Wrap::Mirror, 0.0, 2.0, &[1.0]),
            (Wrap::Mirror, -2.5, 1.5, &[-2.0, -1.0, 0.0, 1.0]),
            (Wrap::Mirror, 0.999, 3.5, &[2.0, 3.0]),
            (Wrap::Mirror, f64::NAN, 1.0, &[]),
        ] {
            assert_eq!(crossed(wrap, low, high, 0.5 / 64.0).collect::<Vec<_>>(), sides, "{wrap:?} {low} {high}");
            assert_eq!(crossed(wrap, low, high, 0.5).next(), None, "{wrap:?} {low} {high}: one texel");
        }
    }
}
