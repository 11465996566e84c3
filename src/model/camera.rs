//! A camera: a lens, a place, and a screen that it is seen on.

use crate::math::{Affine, Angle16, ProjectionError, Projective, Scalar, Vec3};
use crate::mesh::Bounds;
use embedded_graphics_core::geometry::Size;

/// A lens and a view, and the size of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Camera {
    /// Eye space to clip space.
    pub lens: Projective,
    /// World space to eye space.
    pub view: Affine,
    /// The screen, or the viewport that is drawn in.
    pub screen: Size,
}

impl Camera {
    /// Returns the camera from a direction that shows a whole box as large as it can: the nearest one on the line
    /// through the middle of the box from which no corner of it is off the screen.
    ///
    /// `towards_viewer` is the direction from the box to the camera, of any length. `field_of_view` is the vertical
    /// opening angle. The near and the far plane leave room for a model that moves: the near plane is half way to the
    /// box.
    ///
    /// ```
    /// use zstrip::math::{Scalar, Vec3};
    /// use zstrip::{model::Camera, prelude::*};
    /// # let bounds = *Mesh::constant(MeshData::new(Positions::Exact(&[Vec3::X, Vec3::Y, Vec3::Z]))).bounds();
    /// let from_the_right = Vec3::from_ints(3, 1, 2);
    /// let camera = Camera::framing(&bounds, Angle16::from_degrees(40), Size::new(240, 320), from_the_right)?;
    /// # let _ = camera;
    /// # Ok::<(), zstrip::math::ProjectionError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Projective::perspective`]: the angle is not in 0..180°, or the screen has no pixel.
    /// [`ProjectionError::BoxOutOfRange`] if the far plane, or the box as the camera sees it, is beyond the range of
    /// numbers. [`ProjectionError::DegenerateView`] if `towards_viewer` is zero.
    pub fn framing(
        bounds: &Bounds,
        field_of_view: Angle16,
        screen: Size,
        towards_viewer: Vec3,
    ) -> Result<Self, ProjectionError> {
        let looking = |up| Affine::look_at(towards_viewer, Vec3::ZERO, up);
        let turned = looking(Vec3::Y).or_else(|_| looking(Vec3::Z))?;
        let [x, y, z] = turned.to_rows().map(|[x, y, z, _]| Vec3::from_bits([x, y, z]));
        let turn = Affine::from_rows(x, y, z, Vec3::ZERO);
        // Where the middle of the box is after the turn, exactly.
        let [cx, cy, cz] = bounds.center.to_bits();
        let turned = [x, y, z].map(|row| {
            let [x, y, z] = row.to_bits().map(i128::from);
            ((x * i128::from(cx) + y * i128::from(cy) + z * i128::from(cz) + (1 << 15)) >> 16) as i64
        });
        let half = Angle16(field_of_view.0 / 2);
        // The distance that a corner must have from the eye is what it is off the axis, over the tangent of half the
        // angle.
        let (sin, cos) = (half.sin_q30(), half.cos_q30());
        let (width, height) = (i64::from(screen.width.clamp(1, 0xFFFF)), i64::from(screen.height.clamp(1, 0xFFFF)));
        let up = |c: i32| i128::from(c.unsigned_abs()) * i128::from(cos);
        let [mut distance, mut nearest, mut farthest] = [0_i64, i64::MIN, i64::MAX];
        for corner in 0..8 {
            let [hx, hy, hz] = bounds.half.to_bits();
            let side = |h: i32, bit: u32| if corner >> bit & 1 == 0 { h } else { h.saturating_neg() };
            let offset = Vec3::from_bits([side(hx, 0), side(hy, 1), side(hz, 2)]);
            let [x, y, z] = turn.transform_vector(offset).to_bits();
            let away = up(y).max(up(x) * i128::from(height) / i128::from(width)).checked_div(i128::from(sin));
            let z = i64::from(z);
            distance = distance.max(away.unwrap_or(0).min(1 << 40) as i64 + z);
            (nearest, farthest) = (nearest.max(z), farthest.min(z));
        }
        // A box without size across the view is seen from some distance.
        let distance = distance.max(nearest + (nearest - farthest) / 8 + 2);
        // Differences of coordinates are below 2³³, distances at most 2⁴⁰ and some.
        let far = distance - farthest;
        let near = ((distance - nearest) / 2).max(far >> 8).max(1);
        let far = far + far / 2 + 1;
        let [x_moved, y_moved, z_moved] = turned.map(|c| -c);
        let z_moved = z_moved - distance;
        let reach = x_moved.abs().max(y_moved.abs()).max(z_moved.abs()).max(far);
        if reach > i64::from(i32::MAX) {
            return Err(ProjectionError::BoxOutOfRange { reach: reach >> 16 });
        }
        let scalar = |bits: i64| Scalar::from_bits(bits as i32);
        let lens = Projective::perspective(field_of_view, screen, scalar(near), scalar(far))?;
        let view = Affine::from_rows(x, y, z, Vec3::new(scalar(x_moved), scalar(y_moved), scalar(z_moved)));
        Ok(Self { lens, view, screen })
    }

    /// Returns the number of pixels, 24.8, that a unit of length takes at a w, 32.32; the largest number at the eye and
    /// behind it.
    pub(super) fn pixels_per_unit(&self, w: i64) -> u32 {
        let [_, [_, y, ..], ..] = self.lens.to_rows();
        let (y, height) = (y.unsigned_abs(), u64::from(self.screen.height.min(0xFFFF)));
        // Half the height of the screen is one unit of y / w. 32.32 / 32.32, with eight bits more: y · height · 2⁷ / w.
        // Room for 16 + 7 bits: y and w are cut by as much.
        let cut = 23_u32.saturating_sub(y.leading_zeros());
        let pixels = (((y >> cut) * height) << 7).checked_div(w.max(1).unsigned_abs() >> cut);
        pixels.map_or(u32::MAX, |pixels| pixels.min(u32::MAX.into()) as u32)
    }

    /// Returns whether the lens has an eye at the origin, as those of [`Projective::perspective`] have: x, y and w are
    /// 0 there, and w is not the same everywhere.
    pub(super) fn has_eye(&self) -> bool {
        matches!(self.lens.to_rows(), [[.., 0], [.., 0], _, [a, b, c, 0]] if a | b | c != 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;

    #[test]
    fn pixels_of_a_unit_are_those_of_real_numbers() {
        let mut rng = Rng::new(2);
        for height in [1, 2, 3, 63, 135, 240, 321, 0xFFFF] {
            for degrees in [1, 40, 90, 170] {
                let (angle, screen) = (Angle16::from_degrees(degrees), Size::new(100, height));
                let lens = Projective::perspective(angle, screen, Scalar::ONE, Scalar::from_num(100)).expect("a lens");
                let camera = Camera { lens, view: Affine::IDENTITY, screen };
                let half_angle = f64::from(angle.0) / 65_536.0 * core::f64::consts::PI;
                for _ in 0..200 {
                    let w = (1 << 28) + (rng.next_u64() >> (17 + rng.below(16))) as i64;
                    let exact = f64::from(height) / 2.0 / half_angle.tan() / (w as f64 / 65_536.0 / 65_536.0);
                    let found = f64::from(camera.pixels_per_unit(w)) / 256.0;
                    let limit = f64::from(u32::MAX) / 256.0;
                    let is_near = (found - exact.min(limit)).abs() <= exact * 1e-5 + 1.0 / 256.0;
                    assert!(is_near, "{found}, not {exact}: {height} rows, {degrees} degrees, {w}");
                }
                assert_eq!([i64::MIN, -1, 0].map(|w| camera.pixels_per_unit(w)), [u32::MAX; 3]);
            }
        }
    }

    #[test]
    fn lenses_of_perspective_have_an_eye() {
        let screen = Size::new(4, 3);
        let lens = Projective::perspective(Angle16::from_degrees(50), screen, Scalar::ONE, Scalar::from_num(9));
        let lens = lens.expect("a lens");
        let flat = Projective::from_affine(&Affine::scale(Scalar::from_num(0.1)));
        let beside = lens * Affine::translation(Vec3::X);
        let eyes = [lens, flat, beside].map(|lens| Camera { lens, view: Affine::IDENTITY, screen }.has_eye());
        assert_eq!(eyes, [true, false, false]);
    }
}
