//! The camera of the ray caster: from a pixel to a ray, from a distance to a depth, and vectors of three f64.
//!
//! There is no matrix on the way. [`Camera::clip_position`] goes the other way, to give a rasterizer the same view.

pub type Vec3 = [f64; 3];

pub fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a + s * b`.
pub fn add_scaled(a: Vec3, s: f64, b: Vec3) -> Vec3 {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

pub fn normalize(a: Vec3) -> Vec3 {
    a.map(|c| c / dot(a, a).sqrt())
}

/// How rays leave the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// From the eye, with the tangent of half the vertical angle of view.
    Perspective { tan_half_fov: f64 },
    /// Parallel, over a window of this half height.
    Orthographic { half_height: f64 },
}

/// A view: three orthonormal directions, a lens and the range of distances seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub eye: Vec3,
    pub right: Vec3,
    pub up: Vec3,
    pub forward: Vec3,
    pub lens: Lens,
    /// Width of the picture divided by its height.
    pub aspect: f64,
    /// Distances along `forward`; what is nearer or farther is not seen, pixel by pixel.
    pub near: f64,
    pub far: f64,
}

/// `origin + t * direction`, where t is the distance along the camera's `forward`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    pub origin: Vec3,
    pub direction: Vec3,
}

impl Ray {
    pub fn at(&self, t: f64) -> Vec3 {
        add_scaled(self.origin, t, self.direction)
    }
}

impl Camera {
    /// A camera at `eye` that looks at `target`, with `up` roughly upwards.
    pub fn look_at(eye: Vec3, target: Vec3, up: Vec3, lens: Lens, aspect: f64) -> Self {
        let forward = normalize(sub(target, eye));
        let right = normalize(cross(forward, up));
        let up = cross(right, forward);
        let (near, far) = (0.1, 100.0);
        Self { eye, right, up, forward, lens, aspect, near, far }
    }

    /// The ray through the screen position `(x, y)` in px of a `width` x `height` picture, y down.
    pub fn ray(&self, (width, height): (u32, u32), x: f64, y: f64) -> Ray {
        let across = (2.0 * x / f64::from(width) - 1.0) * self.aspect;
        let upwards = 1.0 - 2.0 * y / f64::from(height);
        let spread = |from, size| {
            let sideways = add_scaled(from, across * size, self.right);
            add_scaled(sideways, upwards * size, self.up)
        };
        let (origin, direction) = match self.lens {
            Lens::Perspective { tan_half_fov } => (self.eye, spread(self.forward, tan_half_fov)),
            Lens::Orthographic { half_height } => (spread(self.eye, half_height), self.forward),
        };
        Ray { origin, direction }
    }

    /// z/w of a point at distance `t` along `forward`: 0 at `near`, 1 at `far`.
    pub fn depth(&self, t: f64) -> f64 {
        match self.lens {
            Lens::Perspective { .. } => self.far * (t - self.near) / ((self.far - self.near) * t),
            Lens::Orthographic { .. } => (t - self.near) / (self.far - self.near),
        }
    }

    /// Clip-space position of a point, for the rasterizer that is to draw the same view.
    pub fn clip_position(&self, point: Vec3) -> [f64; 4] {
        let from_eye = sub(point, self.eye);
        let (x, y) = (dot(from_eye, self.right), dot(from_eye, self.up));
        let t = dot(from_eye, self.forward);
        let z = (t - self.near) / (self.far - self.near);
        match self.lens {
            Lens::Perspective { tan_half_fov: s } => [x / (s * self.aspect), y / s, self.far * z, t],
            Lens::Orthographic { half_height: s } => [x / (s * self.aspect), y / s, z, 1.0],
        }
    }
}
