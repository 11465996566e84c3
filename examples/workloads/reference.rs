//! The workloads drawn in double precision, as they are specified: the pictures that the library's are compared with.
//!
//! Coverage by edge functions at pixel centres with the top-left rule, depth 1 / z per pixel, colours
//! perspective-correct and cut to RGB565.

use super::{FOCAL, HEIGHT, WIDTH, Workload, spot};

/// Position in view space and colour.
#[derive(Clone, Copy)]
struct Vertex {
    position: [f64; 3],
    color: [f64; 3],
}

/// A picture: red, green, blue of 8 bits before they are cut, `None` where nothing was drawn.
pub struct Picture {
    pub colors: Vec<Option<[f64; 3]>>,
    inv_z: Vec<f64>,
    width: usize,
    /// Pixels per unit of x / z.
    focal: f64,
}

/// Draws a workload.
pub fn draw(workload: Workload) -> Picture {
    let width = workload.width();
    let focal = if width == WIDTH { FOCAL } else { spot::FOCAL };
    let (colors, inv_z) = (vec![None; width * HEIGHT], vec![0.0; width * HEIGHT]);
    let mut picture = Picture { colors, inv_z, width, focal };
    match workload {
        Workload::Empty | Workload::EmptySpot => {}
        Workload::Quad | Workload::FlatQuad | Workload::OwnFlatQuad => picture.quad(|_| super::QUAD_COLOR),
        Workload::GouraudQuad | Workload::OwnGouraudQuad => picture.quad(|k| super::QUAD_COLORS[k]),
        Workload::TexturedQuad => picture.tilted(),
        Workload::FlatTorus => picture.torus(|triangle, _| super::TORUS_FACE_NORMALS[triangle]),
        Workload::GouraudTorus => picture.torus(|_, vertex| super::TORUS_NORMALS[vertex]),
        Workload::Tiny => picture.tiny(),
        Workload::TexturedSpot => picture.textured_spot(),
        Workload::FlatSpot => {
            picture.spot(|face, _| spot::COLOR.map(|c| f64::from(c) * spot::brightness(spot::FACE_NORMALS[face])));
        }
    }
    picture
}

impl Picture {
    fn quad(&mut self, color: impl Fn(usize) -> [u8; 3]) {
        for corners in super::QUAD_INDICES.chunks(3) {
            self.triangle(&[0, 1, 2].map(|c: usize| {
                let k = usize::from(corners[c]);
                Vertex { position: super::QUAD_POSITIONS[k], color: color(k).map(f64::from) }
            }));
        }
    }

    /// Texture coordinates take the place of colours until all is drawn.
    fn tilted(&mut self) {
        for corners in super::QUAD_INDICES.chunks(3) {
            self.triangle(&[0, 1, 2].map(|c: usize| {
                let k = usize::from(corners[c]);
                let [u, v] = super::TILTED_UVS[k].map(f64::from);
                Vertex { position: super::TILTED_POSITIONS[k], color: [u, v, 0.0] }
            }));
        }
        for color in self.colors.iter_mut().flatten() {
            let [x, y] = [color[0], color[1]].map(|c| ((c * super::TEXELS as f64) as usize) % super::TEXELS);
            let raw = super::TEXELS_565[y][x];
            *color = [raw >> 11 << 3, (raw >> 5 & 63) << 2, (raw & 31) << 3].map(f64::from);
        }
    }

    fn torus(&mut self, normal: impl Fn(usize, usize) -> [f64; 3]) {
        let positions = super::TORUS_POSITIONS;
        // The light in object space: the transposed rotation.
        let light = [0, 1, 2].map(|i: usize| (0..3).map(|k| super::ROTATION[k][i] * super::LIGHT[k]).sum::<f64>());
        for (triangle, corners) in super::TORUS_INDICES.chunks(3).enumerate() {
            self.triangle(&[0, 1, 2].map(|c: usize| {
                let k = usize::from(corners[c]);
                let [x, y, z] = super::ROTATION.map(|row| super::numbers::dot(row, positions[k]));
                let lit = super::AMBIENT + super::DIFFUSE * super::numbers::dot(normal(triangle, k), light).max(0.0);
                Vertex { position: [x, y, z + super::DISTANCE], color: super::TORUS_COLOR.map(|c| f64::from(c) * lit) }
            }));
        }
    }

    fn tiny(&mut self) {
        let mut state = super::TINY_SEED;
        for k in 0..super::TINY_TRIANGLES {
            let (corners, color, next) = super::tiny_triangle(k, state);
            state = next;
            self.triangle(&corners.map(|position| Vertex { position, color: color.map(f64::from) }));
        }
    }

    /// Draws the cow in colours of its faces and vertices.
    fn spot(&mut self, color: impl Fn(usize, usize) -> [f64; 3]) {
        for (face, corners) in spot::INDICES.chunks(3).enumerate() {
            self.triangle(&[0, 1, 2].map(|c: usize| {
                let k = usize::from(corners[c]);
                let [x, y, z] = spot::in_eye_space(spot::POINTS[usize::from(spot::POSITION_OF[k])]);
                Vertex { position: [x, y, -z], color: color(face, k) }
            }));
        }
    }

    /// u, v and the light take the place of colours until all is drawn.
    fn textured_spot(&mut self) {
        self.spot(|_, k| {
            let [u, v] = spot::UVS[k].map(|c| f64::from(c.to_bits()) / 65_536.0);
            [u, v, spot::brightness(spot::NORMALS[usize::from(spot::POSITION_OF[k])])]
        });
        for color in self.colors.iter_mut().flatten() {
            let [x, y] =
                [color[0], color[1]].map(|c| (c * spot::TEXELS as f64).floor() as isize as usize % spot::TEXELS);
            let raw = spot::TEXELS_565[y][x];
            let [r, g, b] = [raw >> 11 << 3, (raw >> 5 & 63) << 2, (raw & 31) << 3];
            *color = [r | r >> 5, g | g >> 6, b | b >> 5].map(|c| f64::from(c) * color[2]);
        }
    }

    fn triangle(&mut self, v: &[Vertex; 3]) {
        let (width, focal) = (self.width, self.focal);
        let screen = v.map(|v| {
            let [x, y, z] = v.position;
            [width as f64 / 2.0 + focal * x / z, HEIGHT as f64 / 2.0 - focal * y / z]
        });
        let edge =
            |a: [f64; 2], b: [f64; 2], p: [f64; 2]| (a[0] - p[0]) * (b[1] - p[1]) - (b[0] - p[0]) * (a[1] - p[1]);
        // y points down, so a front face has a negative area.
        let area = edge(screen[0], screen[1], screen[2]);
        if area >= 0.0 {
            return;
        }
        let range = |k: usize, size: usize| {
            let low = screen.iter().fold(f64::MAX, |m, p| m.min(p[k])).floor().max(0.0);
            let high = screen.iter().fold(f64::MIN, |m, p| m.max(p[k])).ceil().max(0.0);
            low as usize..(high as usize).min(size)
        };
        for y in range(1, HEIGHT) {
            for x in range(0, width) {
                let p = [x as f64 + 0.5, y as f64 + 0.5];
                let weights = [0, 1, 2].map(|k| edge(screen[(k + 1) % 3], screen[(k + 2) % 3], p) / area);
                let inside = (0..3).all(|k| {
                    let (a, b) = (screen[(k + 1) % 3], screen[(k + 2) % 3]);
                    // Counter-clockwise: left edges run down, top edges to the left.
                    let (right, down) = (b[0] - a[0], b[1] - a[1]);
                    weights[k] > 0.0 || (weights[k] == 0.0 && (down > 0.0 || (down == 0.0 && right < 0.0)))
                });
                if inside {
                    self.fragment(y * width + x, v, weights);
                }
            }
        }
    }

    fn fragment(&mut self, at: usize, v: &[Vertex; 3], weights: [f64; 3]) {
        let shares = [0, 1, 2].map(|k: usize| weights[k] / v[k].position[2]);
        let inv_z: f64 = shares.iter().sum();
        if inv_z <= self.inv_z[at] {
            return;
        }
        self.inv_z[at] = inv_z;
        self.colors[at] =
            Some([0, 1, 2].map(|m: usize| (0..3).map(|k| shares[k] * v[k].color[m]).sum::<f64>() / inv_z));
    }
}
