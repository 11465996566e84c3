//! 2-D drawing among meshes without fonts and shapes: areas and pixels of embedded-graphics-core, at depths and on top.

use super::{Draw, Torus};
use zstrip::embedded_graphics_core::draw_target::DrawTarget;
use zstrip::embedded_graphics_core::geometry::{Dimensions, Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{PixelColor, Rgb565, Rgb888};
use zstrip::embedded_graphics_core::primitives::{PointsIter, Rectangle};
use zstrip::embedded_graphics_core::{Drawable, Pixel};
use zstrip::light::Sunlit;
use zstrip::math::{Angle16, Projective, Vec3};
use zstrip::shader::Gouraud;
use zstrip::span::{Compare, DepthState};
use zstrip::{Framebuffer, Scene};

/// A square of 16 × 16 pixels around a point.
struct Marker<C> {
    center: Point,
    color: C,
    /// Every other pixel, or a frame with a filled middle.
    stippled: bool,
}

impl<C> Dimensions for Marker<C> {
    fn bounding_box(&self) -> Rectangle {
        Rectangle::new(self.center - Point::new(8, 8), Size::new(16, 16))
    }
}

impl<C: PixelColor> Drawable for Marker<C> {
    type Color = C;
    type Output = ();

    fn draw<D: DrawTarget<Color = C>>(&self, target: &mut D) -> Result<(), D::Error> {
        let area = self.bounding_box();
        if self.stippled {
            let stipple = area.points().filter(|at| (at.x ^ at.y) & 1 == 0);
            return target.draw_iter(stipple.map(|at| Pixel(at, self.color)));
        }
        target.fill_solid(&Rectangle::new(area.top_left, Size::new(16, 3)), self.color)?;
        target.fill_solid(&Rectangle::new(area.top_left + Point::new(4, 6), Size::new(8, 10)), self.color)
    }
}

/// A turning torus with markers around it, some of them behind it, and a ramp of colours below.
pub struct Markers(Torus<Gouraud<Sunlit>>);

impl Markers {
    pub fn new(screen: Size, turn: Angle16) -> Self {
        Self(Torus::new(screen, turn, Rgb888::new(200, 90, 160), Gouraud::new))
    }
}

impl<F: Framebuffer<Format = Rgb565>> Draw<F> for Markers {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        let Self(torus) = self;
        (0..13).for_each(|k| marker(scene, &torus.mvp, k));
        torus.draw(scene);
        (13..24).for_each(|k| marker(scene, &torus.mvp, k));
        ramp(scene);
    }
}

#[inline(never)]
fn marker<F: Framebuffer<Format = Rgb565>>(scene: &mut Scene<'_, F>, mvp: &Projective, k: u16) {
    let angle = Angle16(k * 2731);
    let [x, y] = [angle.sin(), angle.cos()].map(|v| v.to_bits() / 64 * 104);
    let Some(place) = scene.project(Vec3::from_bits([x, 0, y]), mvp) else { return };
    let color = Rgb565::new(8 + k as u8, 60 - 2 * k as u8, 28);
    let marker = Marker { center: place.pixel(), color, stippled: k.is_multiple_of(3) };
    match k % 4 {
        0 => scene.overlay().draw(&marker),
        1 => {
            let state = DepthState { compare: Compare::GreaterEqual, write: false };
            scene.at_depth_with(place.z, state).draw(&marker);
        }
        _ => scene.at_depth(place.z).draw(&marker),
    }
}

#[inline(never)]
fn ramp<F: Framebuffer<Format = Rgb565>>(scene: &mut Scene<'_, F>) {
    let ramp = Rectangle::new(Point::new(-20, 226), Size::new(360, 24));
    let colors = (0..360 * 24).map(|k: u32| Rgb565::new((k % 360 / 12) as u8, (k / 360 * 2) as u8, 9));
    let Ok(()) = scene.at_depth(0x8000).fill_contiguous(&ramp, colors);
}
