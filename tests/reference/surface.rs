//! What the ray caster of [`ray`](super::ray) can hit: triangles and quadrics.
//!
//! In: a ray, or a pixel of a camera. Out: hits, and the distance in px by which hit or miss was decided.
//!
//! # Source
//! Möller & Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection".

use super::camera::{Camera, Lens, Ray, Vec3, cross, dot, normalize, sub};
use super::ray::Hit;

/// A triangle; its front is where the corners run counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    pub corners: [Vec3; 3],
    pub color: Vec3,
    pub id: u32,
}

impl Triangle {
    /// Möller–Trumbore before its divisions: `(det, u * det, v * det, t * det)`, each affine in the pixel position.
    fn scaled(&self, ray: &Ray) -> [f64; 4] {
        let [a, b, c] = self.corners;
        let (ab, ac) = (sub(b, a), sub(c, a));
        let p = cross(ray.direction, ac);
        let s = sub(ray.origin, a);
        let q = cross(s, ab);
        [dot(ab, p), dot(s, p), dot(ray.direction, q), dot(ac, q)]
    }

    /// The hit within `near..=far`, or `None`.
    pub fn hit(&self, ray: &Ray, near: f64, far: f64) -> Option<Hit> {
        let [det, u, v, t] = self.scaled(ray);
        if det == 0.0 {
            return None;
        }
        let (u, v, t) = (u / det, v / det, t / det);
        let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
        (inside && (near..=far).contains(&t)).then(|| {
            let [a, b, c] = self.corners;
            let normal = normalize(cross(sub(b, a), sub(c, a)));
            let front = dot(normal, ray.direction) < 0.0;
            let normal = if front { normal } else { normal.map(|n| -n) };
            Hit { t, id: self.id, normal, point: ray.at(t), front }
        })
    }

    /// True if the camera sees the front, of any part of the triangle that it sees.
    pub fn faces(&self, camera: &Camera) -> bool {
        let [a, b, c] = self.corners;
        let normal = cross(sub(b, a), sub(c, a));
        match camera.lens {
            Lens::Perspective { .. } => dot(normal, sub(a, camera.eye)) < 0.0,
            Lens::Orthographic { .. } => dot(normal, camera.forward) < 0.0,
        }
    }

    /// Distance in px by which hit or miss at `(x, y)` is decided: to the nearest edge or near or far cut if it is a
    /// hit, to the one most violated if it is a miss.
    pub fn margin(&self, camera: &Camera, size: (u32, u32), x: f64, y: f64) -> f64 {
        let decisions = |x, y| {
            let [det, u, v, t] = self.scaled(&camera.ray(size, x, y));
            // The sign that det has where the triangle is in front of the camera.
            let sign = match camera.lens {
                Lens::Perspective { .. } => t.signum(),
                Lens::Orthographic { .. } => det.signum(),
            };
            [u, v, det - u - v, t - camera.near * det, camera.far * det - t].map(|d| d * sign)
        };
        let (here, right, below) = (decisions(x, y), decisions(x + 1.0, y), decisions(x, y + 1.0));
        let distance = |i: usize| here[i] / (right[i] - here[i]).hypot(below[i] - here[i]);
        (0..5).map(distance).fold(f64::INFINITY, f64::min).abs()
    }
}

/// The surface of all points p with `(p, 1)ᵀ q (p, 1) = 0`, negative inside, cut off at a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadric {
    /// Symmetric.
    pub q: [[f64; 4]; 4],
    /// Lowest and highest corner of the box.
    pub bounds: [Vec3; 2],
    pub color: Vec3,
    pub id: u32,
}

impl Quadric {
    /// `((p - center) / radii)² = 1`; an infinite radius leaves that axis out, which makes a cylinder.
    pub fn ellipsoid(center: Vec3, radii: Vec3, color: Vec3, id: u32) -> Self {
        let mut q = [[0.0; 4]; 4];
        q[3][3] = -1.0;
        for axis in 0..3 {
            let scale = 1.0 / (radii[axis] * radii[axis]);
            q[axis][axis] = scale;
            q[axis][3] = -scale * center[axis];
            q[3][axis] = -scale * center[axis];
            q[3][3] += scale * center[axis] * center[axis];
        }
        let bounds = [[f64::NEG_INFINITY; 3], [f64::INFINITY; 3]];
        Self { q, bounds, color, id }
    }

    pub fn sphere(center: Vec3, radius: f64, color: Vec3, id: u32) -> Self {
        Self::ellipsoid(center, [radius; 3], color, id)
    }

    /// An open cylinder about a vertical axis.
    pub fn cylinder(center: Vec3, radius: f64, half_height: f64, color: Vec3, id: u32) -> Self {
        let mut quadric = Self::ellipsoid(center, [radius, f64::INFINITY, radius], color, id);
        quadric.bounds[0][1] = center[1] - half_height;
        quadric.bounds[1][1] = center[1] + half_height;
        quadric
    }

    fn form(&self, a: [f64; 4], b: [f64; 4]) -> f64 {
        let row = |i: usize| (0..4).map(|j| self.q[i][j] * b[j]).sum::<f64>();
        (0..4).map(|i| a[i] * row(i)).sum()
    }

    /// Coefficients of `a t² + 2 b t + c` along the ray.
    fn polynomial(&self, ray: &Ray) -> (f64, f64, f64) {
        let [x, y, z] = ray.origin;
        let origin = [x, y, z, 1.0];
        let [x, y, z] = ray.direction;
        let direction = [x, y, z, 0.0];
        let a = self.form(direction, direction);
        (a, self.form(origin, direction), self.form(origin, origin))
    }

    /// The two crossings in ascending order, NaN where there is none; computed without cancellation.
    fn crossings(&self, ray: &Ray) -> [f64; 2] {
        let (a, b, c) = self.polynomial(ray);
        let root = (b * b - a * c).sqrt();
        let sum = if b < 0.0 { root - b } else { -root - b };
        let both = if a == 0.0 { [-c / (2.0 * b), f64::NAN] } else { [sum / a, c / sum] };
        if both[0] > both[1] { [both[1], both[0]] } else { both }
    }

    /// Least distance of `point` to the sides of the box, negative outside.
    fn slack(&self, point: Vec3) -> f64 {
        let side = |i: usize| (point[i] - self.bounds[0][i]).min(self.bounds[1][i] - point[i]);
        side(0).min(side(1)).min(side(2))
    }

    /// The hits within `near..=far`, nearest first.
    pub fn hits(&self, ray: &Ray, near: f64, far: f64) -> impl Iterator<Item = Hit> {
        let seen = |t: f64| (near..=far).contains(&t) && self.slack(ray.at(t)) >= 0.0;
        self.crossings(ray).map(|t| seen(t).then(|| self.hit_at(ray, t))).into_iter().flatten()
    }

    fn hit_at(&self, ray: &Ray, t: f64) -> Hit {
        let point = ray.at(t);
        let [x, y, z] = point;
        let outwards = [0, 1, 2].map(|i| {
            let mut axis = [0.0; 4];
            axis[i] = 1.0;
            self.form(axis, [x, y, z, 1.0])
        });
        let normal = normalize(outwards);
        let front = dot(normal, ray.direction) < 0.0;
        let normal = if front { normal } else { normal.map(|n| -n) };
        Hit { t, id: self.id, normal, point, front }
    }

    /// First-order distance in px to the silhouette, and to the rims that the box and the near and far planes cut.
    pub fn margin(&self, camera: &Camera, size: (u32, u32), x: f64, y: f64) -> f64 {
        let discriminant = |x, y| {
            let (a, b, c) = self.polynomial(&camera.ray(size, x, y));
            b * b - a * c
        };
        let rim = |i: usize| {
            move |x, y| {
                let ray = camera.ray(size, x, y);
                let t = self.crossings(&ray)[i];
                self.slack(ray.at(t)).min(t - camera.near).min(camera.far - t)
            }
        };
        distance_px(discriminant, x, y).min(distance_px(rim(0), x, y)).min(distance_px(rim(1), x, y))
    }
}

/// |f| over its slope at `(x, y)`, by central differences; infinite where f is not defined.
fn distance_px(f: impl Fn(f64, f64) -> f64, x: f64, y: f64) -> f64 {
    const H: f64 = 1e-3;
    let slope_x = (f(x + H, y) - f(x - H, y)) / (2.0 * H);
    let slope_y = (f(x, y + H) - f(x, y - H)) / (2.0 * H);
    let distance = f(x, y).abs() / slope_x.hypot(slope_y);
    if distance.is_nan() { f64::INFINITY } else { distance }
}
