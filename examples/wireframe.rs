//! A machine part as a drawing: its edges and outlines, hidden lines removed or dashed, strip by strip.
//!
//! ```text
//! cargo run --release --example wireframe -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use scenes::Draw;
use scenes::wires::BEHIND_LINES;
use std::process::ExitCode;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
use zstrip::light::{Material, Sun, Sunlit};
use zstrip::math::{Affine, Angle16, Pixels, Projective, Scalar, Vec3};
use zstrip::mesh::{Lines, Mesh, MeshData, Positions, Topology, edges};
use zstrip::shader::{DepthOnly, Flat};
use zstrip::span::{Compare, DepthState};
use zstrip::target::WithDepth;
use zstrip::{Dashed, Framebuffer, Scene, Smooth, State, Thin};

/// Corners of the polygons that stand for circles.
const ROUND: usize = 48;

/// The part: quads, some edges of which are not drawn, as the surface goes on smoothly there.
#[derive(Default)]
struct Part {
    points: Vec<Vec3>,
    quads: Vec<u16>,
    /// Edges to be drawn.
    sharp: Vec<[u16; 2]>,
    /// Edges between two quads that are drawn only where they are an outline, with the quads' normals.
    smooth: Vec<([u16; 2], [Vec3; 2])>,
}

impl Part {
    fn point(&mut self, x: i32, y: i32, z: i32) -> u16 {
        self.points.push(Vec3::from_milli(x, y, z));
        self.points.len() as u16 - 1
    }

    /// A convex prism along z from its outline, counter-clockwise seen from +z.
    fn prism(&mut self, outline: &[[i32; 2]], z: [i32; 2]) {
        let rings = z.map(|z| outline.iter().map(|p| self.point(p[0], p[1], z)).collect::<Vec<_>>());
        let n = outline.len();
        for k in 0..n {
            let [a, b, c, d] = [rings[0][k], rings[0][(k + 1) % n], rings[1][(k + 1) % n], rings[1][k]];
            self.quads.extend([a, b, c, d]);
            self.sharp.extend([[a, b], [d, c], [a, d]]);
        }
        for k in (1..n - 1).step_by(2) {
            let next = (k + 2).min(n - 1);
            self.quads.extend([rings[1][0], rings[1][k], rings[1][k + 1], rings[1][next]]);
            self.quads.extend([rings[0][0], rings[0][next], rings[0][k + 1], rings[0][k]]);
        }
    }

    /// A tube along y, with a ring on top of it: from `low` to `high`, of two radii.
    fn tube(&mut self, (x, z): (i32, i32), (low, high): (i32, i32), (inner, outer): (i32, i32)) {
        let angle = |k: usize| Angle16((k % ROUND * 65_536 / ROUND) as u16);
        let on = |c: Scalar, r: i32| ((i64::from(c.to_bits()) * i64::from(r)) >> 16) as i32;
        let mut ring = |y: i32, r: i32| -> Vec<u16> {
            (0..ROUND).map(|k| self.point(x + on(angle(k).cos(), r), y, z - on(angle(k).sin(), r))).collect()
        };
        let [low_in, low_out, high_in, high_out] =
            [ring(low, inner), ring(low, outer), ring(high, inner), ring(high, outer)];
        for k in 0..ROUND {
            let next = (k + 1) % ROUND;
            self.quads.extend([low_out[k], low_out[next], high_out[next], high_out[k]]);
            self.quads.extend([low_in[next], low_in[k], high_in[k], high_in[next]]);
            self.quads.extend([high_out[k], high_out[next], high_in[next], high_in[k]]);
            self.sharp.extend([&high_out, &high_in, &low_out].map(|ring| [ring[k], ring[next]]));
            // The middles of the quads to either side of edge k.
            let normal = |quad: usize, sign: i32| {
                let half = Angle16((32_768 / ROUND) as u16);
                let middle = angle(quad) + half;
                Vec3::new(middle.cos(), Scalar::ZERO, -middle.sin()) * Scalar::from_num(sign)
            };
            let before = (k + ROUND - 1) % ROUND;
            self.smooth.push(([low_out[k], high_out[k]], [normal(before, 1), normal(k, 1)]));
            self.smooth.push(([low_in[k], high_in[k]], [normal(before, -1), normal(k, -1)]));
        }
    }

    /// A bracket with a boss, two ribs and an eye.
    fn bracket() -> Self {
        let mut part = Self::default();
        part.prism(&[[-1500, -900], [1500, -900], [1500, -600], [-1500, -600]], [-800, 800]);
        part.tube((450, 0), (-600, 350), (330, 560));
        part.prism(&[[-1500, -600], [-1200, -600], [-1200, 900], [-1500, 900]], [-800, 800]);
        part.prism(&[[-1200, -600], [-350, -600], [-1200, 600]], [300, 440]);
        part.prism(&[[-1200, -600], [-350, -600], [-1200, 600]], [-440, -300]);
        part
    }

    fn mesh(&self) -> Mesh<'_> {
        let data = MeshData::new(Positions::Exact(&self.points));
        Mesh::new(MeshData { topology: Topology::Quads, indices: Some(&self.quads), ..data }).expect("a part")
    }
}

/// The part, and all edges of its quads.
struct Wireframe {
    part: Part,
    all: Vec<[u16; 2]>,
}

impl Wireframe {
    fn new() -> Self {
        let part = Part::bracket();
        let mut room = vec![[0; 2]; part.quads.len()];
        let all = edges(&part.mesh(), &mut room).expect("a place for each side").to_vec();
        Self { part, all }
    }

    /// Returns the edges that are drawn from a place of the eye: sharp ones, and outlines.
    fn seen_from(&self, eye: Vec3) -> Vec<[u16; 2]> {
        let mut seen = self.part.sharp.clone();
        for (edge, normals) in &self.part.smooth {
            let to_eye = eye - self.part.points[usize::from(edge[0])];
            // An edge is an outline if one of its quads faces the eye, and the other does not.
            let [a, b] = normals.map(|normal| normal.dot(to_eye) > Scalar::ZERO);
            if a != b {
                seen.push(*edge);
            }
        }
        seen
    }
}

/// The drawing of one frame.
struct Sheet<'p> {
    mode: usize,
    mesh: Mesh<'p>,
    edges: Vec<[u16; 2]>,
    mvp: Projective,
    shaded: Flat<Sunlit>,
}

impl Demo for Wireframe {
    type Format = Rgb565;
    const NAME: &'static str = "wireframe";
    const ABOUT: &'static str = "A machine part as a drawing.";
    const MODES: &'static [&'static str] = &["dashed", "removed", "shaded", "all"];
    const BACKGROUND: Rgb565 = Rgb565::new(2, 8, 8);

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Rgb565, WithDepth> {
        let turn = Angle16(shot.number.wrapping_mul(96) as u16) + Angle16::from_degrees(-35);
        let model = Affine::translation(Vec3::from_milli(0, 150, -6000))
            * Affine::rotation_x(Angle16::from_degrees(28))
            * Affine::rotation_y(turn);
        let camera = Projective::perspective(Angle16::from_degrees(32), shot.screen, Scalar::ONE, Scalar::from_num(12));
        let sun = Sun::from_channels(Vec3::from_ints(2, 4, 3), [190, 200, 205], [50, 50, 55]);
        let eye = model.inverse_rigid().transform_point(Vec3::ZERO);
        Box::new(Sheet {
            mode: shot.mode,
            mesh: self.part.mesh(),
            edges: if shot.mode == 3 { self.all.clone() } else { self.seen_from(eye) },
            mvp: camera.expect("a camera") * model,
            shaded: Flat::new(sun.on(&Material::matte(Rgb888::new(120, 150, 170)), &model)),
        })
    }
}

impl<F: Framebuffer> Draw<F> for Sheet<'_> {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        let Self { mesh, mvp, .. } = self;
        let Ok(lines) = Lines::of_mesh(mesh, &self.edges) else { return };
        let white = Flat::unlit(Rgb888::new(214, 236, 244));
        match self.mode {
            2 => {
                scene.draw_with(BEHIND_LINES, mesh, mvp, &self.shaded);
                let ink = Flat::unlit(Rgb888::new(8, 16, 24));
                let blended = DepthState { compare: Compare::Less, write: false };
                let state = State { depth: blended, ..State::DEFAULT };
                scene.draw_lines_with(state, &lines, mvp, &ink, &Smooth::new(Pixels::from_bits(360)));
            }
            3 => scene.draw_lines(&lines, mvp, &white, &Thin),
            mode => {
                scene.draw_with(BEHIND_LINES, mesh, mvp, &DepthOnly);
                if mode == 0 {
                    let hidden = DepthState { compare: Compare::GreaterEqual, write: false };
                    let state = State { depth: hidden, ..State::DEFAULT };
                    let dim = Flat::unlit(Rgb888::new(70, 100, 116));
                    scene.draw_lines_with(state, &lines, mvp, &dim, &Dashed::EVEN);
                }
                scene.draw_lines(&lines, mvp, &white, &Thin);
            }
        }
    }
}

fn main() -> ExitCode {
    show(Wireframe::new())
}
