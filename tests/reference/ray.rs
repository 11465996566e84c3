//! Image-order ray caster in f64: for every pixel, what does the ray through its centre meet first?
//!
//! In: a camera, [triangles](Triangle) and [quadrics](Quadric). Out: the nearest hit of a ray, or a whole [`Frame`] in
//! the same depth convention as the rasterizers. There is no matrix and no projection on the way.

pub use super::camera::{Camera, Lens, Ray, Vec3, cross, dot, normalize, sub};
pub use super::frame::{Cull, Frame};
pub use super::surface::{Quadric, Triangle};

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    pub t: f64,
    pub id: u32,
    /// Unit normal on the side the ray comes from.
    pub normal: Vec3,
    pub point: Vec3,
    /// The ray meets the front (counter-clockwise corners, or the outside of a quadric).
    pub front: bool,
}

/// A distant light and what there is without it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    pub ambient: f64,
    pub diffuse: f64,
    /// Unit vector towards the light.
    pub direction: Vec3,
}

impl Light {
    /// Lambert's cosine law on a surface of colour `color`.
    pub fn shade(&self, color: Vec3, normal: Vec3) -> Vec3 {
        let brightness = self.ambient + self.diffuse * dot(normal, self.direction).max(0.0);
        color.map(|c| c * brightness)
    }
}

/// Everything there is to see. Ids are the caller's, from 1.
#[derive(Clone, Debug)]
pub struct Scene {
    pub triangles: Vec<Triangle>,
    pub quadrics: Vec<Quadric>,
    pub light: Light,
    pub background: Vec3,
    pub cull: Cull,
}

impl Scene {
    /// The nearest hit of `ray` within `near..=far`, and the colour of what it hit.
    ///
    /// Of two hits at the same distance the first in the scene wins, triangles before quadrics.
    pub fn nearest(&self, ray: &Ray, near: f64, far: f64) -> Option<(Hit, Vec3)> {
        self.hits(ray, near, far).reduce(|best, other| if other.0.t < best.0.t { other } else { best })
    }

    /// All hits of `ray` on faces that are not culled, in the order of the scene.
    fn hits(&self, ray: &Ray, near: f64, far: f64) -> impl Iterator<Item = (Hit, Vec3)> {
        let triangles = self.triangles.iter();
        let triangles = triangles.filter_map(move |s| s.hit(ray, near, far).map(|h| (h, s.color)));
        let quadrics = self.quadrics.iter();
        let quadrics = quadrics.flat_map(move |s| s.hits(ray, near, far).map(|h| (h, s.color)));
        triangles.chain(quadrics).filter(|(hit, _)| !self.cull.drops(hit.front))
    }

    /// Casts a ray through the centre of every pixel.
    pub fn render(&self, camera: &Camera, width: u32, height: u32) -> Frame {
        let size = (width, height);
        let mut frame = Frame::new(width, height, self.background);
        for y in 0..height {
            for x in 0..width {
                let index = frame.index(x, y);
                let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
                let ray = camera.ray(size, x, y);
                for (hit, color) in self.hits(&ray, camera.near, camera.far) {
                    let color = self.light.shade(color, hit.normal);
                    frame.offer(index, camera.depth(hit.t), color, hit.id);
                }
                let visible = |triangle: &&Triangle| !self.cull.drops(triangle.faces(camera));
                for triangle in self.triangles.iter().filter(visible) {
                    frame.note_margin(index, triangle.margin(camera, size, x, y));
                }
                for quadric in &self.quadrics {
                    frame.note_margin(index, quadric.margin(camera, size, x, y));
                }
            }
        }
        frame
    }
}
