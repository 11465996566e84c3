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
    /// Those of [`Projective::perspective`]: the angle is not in 0..180°, the screen has no pixel, or the box is beyond
    /// the range of numbers. [`ProjectionError::DegenerateView`] if `towards_viewer` is zero.
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
        // Differences of coordinates are below 2³³; what does not fit 16.16 is an error of the lens.
        let scalar = |bits: i64| Scalar::from_bits(bits.clamp(0, i32::MAX.into()) as i32);
        let far = distance - farthest;
        let near = scalar(((distance - nearest) / 2).max(far >> 8).max(1));
        let lens = Projective::perspective(field_of_view, screen, near, scalar(far + far / 2 + 1))?;
        let view = Affine::translation(Vec3::from_bits([0, 0, -scalar(distance).to_bits()]))
            * turn
            * Affine::translation(-bounds.center);
        Ok(Self { lens, view, screen })
    }

    /// Returns the number of pixels, 24.8, that a unit of length takes at a point of the world; the largest number at
    /// the eye and behind it.
    pub(super) fn pixels_per_unit(&self, point: Vec3) -> u32 {
        let [.., w] = self.lens.compose_affine(&self.view).transform_point(point);
        let [_, [_, y, ..], ..] = self.lens.to_rows();
        // Half the height of the screen is one unit of y / w. 32.32 / 32.32, with eight bits more.
        let pixels = (i128::from(y.unsigned_abs()) * i128::from(self.screen.height / 2)) << 8;
        pixels.checked_div(i128::from(w.to_bits().max(1))).map_or(u32::MAX, |p| p.min(u32::MAX.into()) as u32)
    }
}
