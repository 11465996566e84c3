//! A wireframe with smooth edges: a geodesic dome of thick smooth lines in space, which hide each other by their
//! depths, around a solid cube. Discs at the ends of lines make their joints round.
//!
//! ```text
//! cargo run --release --example smooth_wires -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use minifb::Key;
use scenes::Draw;
use scenes::wires::BEHIND_LINES;
use std::cell::RefCell;
use std::process::ExitCode;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
use zstrip::light::{Material, Sun, Sunlit};
use zstrip::math::{Affine, Angle16, Pixels, Projective, Scalar, Vec3};
use zstrip::mesh::{Lines, Mesh, MeshData, Positions, Topology, edges};
use zstrip::scene::ShapeBuffer;
use zstrip::shader::{DepthOnly, Flat};
use zstrip::shape::Circle;
use zstrip::span::DepthState;
use zstrip::target::WithDepth;
use zstrip::{Framebuffer, Scene, ScreenPoint, Smooth, State};

/// Words for the discs: as wide as the widest screen.
const WORDS: usize = ShapeBuffer::words(1024, 32);

/// The dome: an icosahedron whose triangles are cut into four, blown up to a sphere; and the width of its lines.
struct Dome {
    points: Vec<Vec3>,
    triangles: Vec<u16>,
    edges: Vec<[u16; 2]>,
    width: i32,
    words: RefCell<Vec<u32>>,
}

/// Corners of a cube, and its sides.
const CUBE: [Vec3; 8] = {
    let mut corners = [Vec3::ZERO; 8];
    let mut k = 0;
    while k < 8 {
        corners[k as usize] = Vec3::from_milli(side_of(k, 0), side_of(k, 1), side_of(k, 2));
        k += 1;
    }
    corners
};

const fn side_of(k: i32, bit: i32) -> i32 {
    420 * (2 * (k >> bit & 1) - 1)
}

const SIDES: [u16; 24] = [0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6];

impl Dome {
    fn new() -> Self {
        let golden = (1.0 + 5_f64.sqrt()) / 2.0;
        let mut places: Vec<[f64; 3]> = Vec::new();
        for (a, b) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
            places.extend([[0.0, a, b], [a, b, 0.0], [b, 0.0, a]]);
        }
        // Triples of corners that are 2 apart, each once, counter-clockwise as seen from outside.
        let distance = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
        let mut triangles = Vec::new();
        for i in 0..12 {
            for j in i + 1..12 {
                for k in j + 1..12 {
                    let (a, b, c) = (places[i], places[j], places[k]);
                    if [distance(&a, &b), distance(&b, &c), distance(&a, &c)].iter().all(|d| (d - 2.0).abs() < 0.1) {
                        let volume = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                            + a[2] * (b[0] * c[1] - b[1] * c[0]);
                        triangles.push(if volume > 0.0 { [i, j, k] } else { [i, k, j] });
                    }
                }
            }
        }
        let mut middle = |a: usize, b: usize| {
            let place: [f64; 3] = core::array::from_fn(|k| (places[a][k] + places[b][k]) / 2.0);
            places.iter().position(|other| distance(other, &place) < 1e-6).unwrap_or_else(|| {
                places.push(place);
                places.len() - 1
            })
        };
        let cut: Vec<[usize; 3]> = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
            })
            .collect();
        let unit = |place: &[f64; 3]| {
            let length = distance(place, &[0.0; 3]);
            let [x, y, z] = place.map(|c| Scalar::from_num(c / length));
            Vec3::new(x, y, z)
        };
        let points: Vec<_> = places.iter().map(unit).collect();
        let triangles: Vec<u16> = cut.concat().iter().map(|k| *k as u16).collect();
        let data = MeshData { indices: Some(&triangles), ..MeshData::new(Positions::Exact(&points)) };
        let mut room = vec![[0; 2]; triangles.len()];
        let edges = edges(&Mesh::new(data).expect("a dome"), &mut room).expect("a place for each side").to_vec();
        Self { points, triangles, edges, width: 700, words: RefCell::new(vec![0; WORDS]) }
    }
}

/// The drawing of one frame.
struct Sheet<'d> {
    mode: usize,
    dome: &'d Dome,
    mvp: Projective,
    shaded: Flat<Sunlit>,
}

impl Demo for Dome {
    type Format = Rgb565;
    const NAME: &'static str = "smooth_wires";
    const ABOUT: &'static str = "Thick smooth lines in space.";
    const MODES: &'static [&'static str] = &["open", "solid", "bare"];
    const KEYS: &'static str = "  W, S              lines grow wider and thinner\n";
    const BACKGROUND: Rgb565 = Rgb565::new(2, 6, 6);

    fn key(&mut self, key: Key) {
        let change = match key {
            Key::W => 16,
            Key::S => -16,
            _ => 0,
        };
        self.width = (self.width + change).clamp(64, 4096);
    }

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Rgb565, WithDepth> {
        let turn = Angle16(shot.number.wrapping_mul(64) as u16);
        let model = Affine::translation(Vec3::from_milli(0, 0, -3600))
            * Affine::rotation_x(Angle16::from_degrees(20))
            * Affine::rotation_y(turn);
        let camera = Projective::perspective(Angle16::from_degrees(36), shot.screen, Scalar::ONE, Scalar::from_num(8));
        let sun = Sun::from_channels(Vec3::from_ints(2, 4, 3), [210, 190, 150], [60, 55, 60]);
        Box::new(Sheet {
            mode: shot.mode,
            dome: self,
            mvp: camera.expect("a camera") * model,
            shaded: Flat::new(sun.on(&Material::matte(Rgb888::new(220, 130, 60)), &model)),
        })
    }
}

impl<F: Framebuffer> Draw<F> for Sheet<'_> {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        let Self { mode, dome, mvp, shaded } = self;
        let data = MeshData { indices: Some(&dome.triangles), ..MeshData::new(Positions::Exact(&dome.points)) };
        let Ok(mesh) = Mesh::new(data) else { return };
        let Ok(lines) = Lines::of_mesh(&mesh, &dome.edges) else { return };
        match mode {
            0 => {
                let sides = MeshData {
                    topology: Topology::Quads,
                    indices: Some(&SIDES),
                    ..MeshData::new(Positions::Exact(&CUBE))
                };
                if let Ok(cube) = Mesh::new(sides) {
                    scene.draw(&cube, mvp, shaded);
                }
            }
            // Faces are pushed back by as much as their depth changes over half of a line's width, and a pixel more.
            1 => {
                let mut state = BEHIND_LINES;
                state.bias.slope = Scalar::from_bits(((dome.width / 2 + 256) << 8).max(1 << 16));
                scene.draw_with(state, &mesh, mvp, &DepthOnly);
            }
            _ => {}
        }
        let color = Rgb888::new(150, 214, 255);
        let state = State { depth: DepthState::TEST, ..State::DEFAULT };
        scene.draw_lines_with(state, &lines, mvp, &Flat::unlit(color), &Smooth::new(Pixels::from_bits(dome.width)));
        // Joints, a little in front of the lines that meet there.
        let Ok(mut words) = dome.words.try_borrow_mut() else { return };
        let Ok(mut buffer) = ShapeBuffer::new(&mut words, 1024) else { return };
        for point in &dome.points {
            if let Some(vertex) = scene.project(*point, mvp) {
                let joint = Circle::new(ScreenPoint::from(vertex), Pixels::from_bits(dome.width / 2));
                scene.canvas_with(vertex.z, DepthState::TEST).fill(&joint, color, &mut buffer);
            }
        }
    }
}

fn main() -> ExitCode {
    show(Dome::new())
}
