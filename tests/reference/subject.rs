//! The crate itself behind the checker's trait: triangles, lines and points are draws of a scene, in one strip or many,
//! recorded or drawn directly.
//!
//! Screen positions become homogeneous vertices with w = 1 that project to exactly the same 1/256 px: the viewports of
//! the data are powers of two.

use super::conformance::{ClipTriangle, PerspectiveTriangle, Rasterizer, ScreenTriangle};
use std::cell::RefCell;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565, Rgb888, RgbColor};
use zstrip::frame::{FramebufferRenderer, Renderer};
use zstrip::math::{Pixels, Projective, Scalar};
use zstrip::mesh::{LineTopology, Lines, Mesh, MeshData, Points, Positions, Vertices};
use zstrip::shader::Flat;
use zstrip::span::{DepthState, DepthTest, Fragment, Shader, SpanOf};
use zstrip::target::FrameSlice;
use zstrip::vertex::{Face, Perspective, VertexRef, VertexShader};
use zstrip::{Cull, Scene, State, Thin};

/// Nothing is culled, and depths do not matter.
const ALL: State = State { cull: Cull::None, depth: DepthState::OFF, ..State::DEFAULT };

/// Draws with zstrip; strips of `strip_rows` rows, and `records` words of records.
pub struct Subject {
    pub strip_rows: usize,
    pub records: usize,
}

impl Default for Subject {
    fn default() -> Self {
        Self { strip_rows: usize::MAX, records: 100_000 }
    }
}

/// Reports each pixel that is reached, with the number of its triangle.
struct Reached<'a>(RefCell<&'a mut dyn FnMut(usize, u32, u32)>);

impl VertexShader for Reached<'_> {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }

    fn face(&self, face: &Face<'_>) -> u32 {
        face.index() as u32
    }
}

impl Shader<Rgb565> for Reached<'_> {
    type Setup = ();

    fn fragment(&self, _: &Fragment<'_, [i32; 0]>) -> Option<u16> {
        Some(1)
    }

    fn span<D: DepthTest>(&self, span: SpanOf<'_, Rgb565, Self, D>, _: D) {
        let ((x, y), face) = (span.position, span.primitive.flat);
        for (k, color) in span.color.iter_mut().enumerate() {
            *color = 1;
            (self.0.borrow_mut())(face as usize, x as u32 + k as u32, y as u32);
        }
    }
}

/// Colours pixels with the number of the triangle, from 1.
struct Numbered;

impl VertexShader for Numbered {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }

    fn face(&self, face: &Face<'_>) -> u32 {
        face.index() as u32 + 1
    }
}

impl Shader<Rgb565> for Numbered {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<u16> {
        Some(fragment.flat as u16)
    }
}

/// Where coordinates are reported: pixel, u and t in 1/2^16.
type Report<'a> = RefCell<&'a mut dyn FnMut((i32, i32), [i32; 2])>;

/// Reports perspective-correct coordinates, one reciprocal every `STEP` pixels.
struct Coordinates<'a, const STEP: usize> {
    triangle: &'a PerspectiveTriangle,
    report: Report<'a>,
}

impl<const STEP: usize> VertexShader for Coordinates<'_, STEP> {
    type Varyings = Perspective<2, 3>;

    fn vertex(&self, corner: &VertexRef<'_>) -> Perspective<2, 3> {
        let k = corner.index();
        Perspective::new([self.triangle.u[k] << 16, self.triangle.t[k] << 16], [])
    }
}

impl<const STEP: usize> Shader<Rgb565> for Coordinates<'_, STEP> {
    type Setup = ();

    const STEP: usize = STEP;

    fn fragment(&self, fragment: &Fragment<'_, Perspective<2, 3>>) -> Option<u16> {
        (self.report.borrow_mut())(fragment.position, fragment.varyings.corrected());
        None
    }
}

/// y down, as in the data; the pipeline's clip space has y up.
fn y_down() -> Projective {
    let one = 1_i64 << 32;
    Projective::from_rows([[one, 0, 0, 0], [0, -one, 0, 0], [0, 0, one, 0], [0, 0, 0, one]])
}

fn on_screen([x, y]: [i32; 2], z: u16, width: u32, height: u32) -> [Scalar; 4] {
    // X = (x / w + 1) · 128 width, in 1/256 px.
    let clip = |c: i32, size: u32| {
        let (half, one) = (128 * i64::from(size), 1_i64 << 16);
        let scaled = (i64::from(c) - half) * one;
        assert_eq!(scaled % half, 0, "a viewport of the data is a power of two");
        Scalar::from_bits((scaled / half) as i32)
    };
    let z = (i64::from(z) * 65_536 + 32_767) / 65_535;
    [clip(x, width), clip(y, height), Scalar::from_bits(z as i32), Scalar::ONE]
}

impl Subject {
    fn draw<S: Shader<Rgb565>>(
        &self,
        (width, height): (u32, u32),
        vertices: &[[Scalar; 4]],
        depth_state: DepthState,
        shader: &S,
    ) -> (Vec<u16>, Vec<u16>) {
        let mesh = Mesh::new(MeshData::new(Positions::Homogeneous(vertices))).expect("a mesh");
        let state = State { depth: depth_state, ..ALL };
        self.frame((width, height), |scene| scene.draw_with(state, &mesh, &y_down(), shader))
    }

    /// Draws a frame, and returns its colours and the depths of its last strip.
    fn frame(
        &self,
        (width, height): (u32, u32),
        draw: impl FnMut(&mut Scene<'_, FrameSlice<'_, Rgb565>>),
    ) -> (Vec<u16>, Vec<u16>) {
        let size = Size::new(width, height);
        let mut color = vec![0; (width * height) as usize];
        let mut depth = vec![0; width as usize * self.strip_rows.min(height as usize)];
        let mut records = vec![0; self.records];
        let mut frame = FrameSlice::<Rgb565>::new(&mut color, size).expect("a framebuffer");
        let mut renderer = FramebufferRenderer::new(size)
            .expect("a renderer")
            .with_depth(&mut depth)
            .expect("a renderer")
            .with_records(&mut records);
        renderer.frame_over(&mut frame, draw).expect("the same scene each time");
        (color, depth)
    }

    /// Perspective-correct coordinates by pixel, one reciprocal every `STEP` pixels.
    pub fn coordinates<const STEP: usize>(
        &self,
        (width, height): (u32, u32),
        triangle: &PerspectiveTriangle,
    ) -> Vec<Option<[f64; 2]>> {
        // The largest scale that fits: positions come out exactly, unless w differs a lot.
        let clip = |k: usize, axis: usize, size: u32| {
            let half = 128 * i64::from(size);
            (i64::from(triangle.v[k][axis]) - half) as f64 / half as f64 * f64::from(triangle.w[k])
        };
        let vertices = [0, 1, 2].map(|k| [clip(k, 0, width), clip(k, 1, height), 0.0, f64::from(triangle.w[k])]);
        let largest = vertices.iter().flatten().fold(0.0, |largest: f64, c| largest.max(c.abs()));
        let scale = 2_f64.powi((2_f64.powi(30) / largest).log2().floor() as i32);
        let vertices = vertices.map(|v| v.map(|c| Scalar::from_bits((c * scale).round() as i32)));
        let mut values = vec![None; (width * height) as usize];
        let mut report = |(x, y): (i32, i32), uv: [i32; 2]| {
            values[y as usize * width as usize + x as usize] = Some(uv.map(|c| f64::from(c) / 65_536.0));
        };
        let shader = Coordinates::<STEP> { triangle, report: RefCell::new(&mut report) };
        self.draw((width, height), &vertices, DepthState::OFF, &shader);
        values
    }

    fn reach(&self, size: (u32, u32), vertices: &[[Scalar; 4]], hit: &mut dyn FnMut(usize, u32, u32)) {
        self.draw(size, vertices, DepthState::OFF, &Reached(RefCell::new(hit)));
    }
}

impl Rasterizer for Subject {
    fn triangle(&mut self, width: u32, height: u32, v: ScreenTriangle, hit: &mut dyn FnMut(u32, u32)) {
        let vertices = v.map(|p| on_screen(p, 0, width, height));
        self.reach((width, height), &vertices, &mut |_, x, y| hit(x, y));
    }

    /// The first sample's pixels become the means of all four. So it is what is left of the means without the others.
    fn samples(&mut self, width: u32, height: u32, v: ScreenTriangle, hit: &mut dyn FnMut(usize, u32, u32)) {
        let vertices = v.map(|p| on_screen(p, 0, width, height));
        let mesh = Mesh::new(MeshData::new(Positions::Homogeneous(&vertices))).expect("a mesh");
        assert!(self.strip_rows >= height as usize, "samples are read back from a buffer of the whole screen");
        let pixels = (width * height) as usize;
        let (mut color, mut samples, mut depth) = (vec![0; pixels], vec![0; 3 * pixels], vec![0; 4 * pixels]);
        let mut records = vec![0; self.records];
        let white = Flat::unlit(Rgb888::WHITE);
        let mut renderer = Renderer::<Gray8>::new(Size::new(width, height))
            .and_then(|renderer| renderer.with_samples::<4>(&mut depth, &mut samples))
            .expect("a renderer")
            .with_records(&mut records);
        let mut frame = renderer.begin(Rgb888::BLACK);
        let strip = frame.next_strip(&mut color, |scene| scene.draw_with(ALL, &mesh, &y_down(), &white));
        assert!(strip.expect("one scene").is_some());
        for (k, mean) in color.iter().enumerate() {
            let (x, y) = (k as u32 % width, k as u32 / width);
            let mut rest = (u32::from(*mean) * 4 + 128) / 255;
            for (sample, color) in (1..).zip(samples.iter().skip(k).step_by(pixels)) {
                if *color != 0 {
                    rest -= 1;
                    hit(sample, x, y);
                }
            }
            if rest > 0 {
                hit(0, x, y);
            }
        }
    }

    fn depth_scene(&mut self, width: u32, height: u32, tris: &[(ScreenTriangle, [u16; 3])]) -> (Vec<u32>, Vec<u16>) {
        assert!(self.strip_rows >= height as usize, "depths are read back from a buffer of the whole screen");
        let vertices: Vec<_> =
            tris.iter().flat_map(|(v, z)| [0, 1, 2].map(|k| on_screen(v[k], z[k], width, height))).collect();
        let (winners, depth) = self.draw((width, height), &vertices, DepthState::LESS, &Numbered);
        (winners.into_iter().map(u32::from).collect(), depth)
    }

    fn perspective(&mut self, width: u32, height: u32, triangle: &PerspectiveTriangle) -> Vec<Option<[f64; 2]>> {
        self.coordinates::<1>((width, height), triangle)
    }

    fn clip_triangles(&mut self, width: u32, height: u32, tris: &[ClipTriangle], hit: &mut dyn FnMut(usize, u32, u32)) {
        let vertices: Vec<_> = tris.iter().flatten().map(|v| v.map(Scalar::from_bits)).collect();
        self.reach((width, height), &vertices, hit);
    }

    fn line(&mut self, width: u32, height: u32, ends: [[i32; 2]; 2], hit: &mut dyn FnMut(u32, u32)) {
        let ends = ends.map(|end| on_screen(end, 0, width, height));
        let line = Lines::new(Vertices::new(Positions::Homogeneous(&ends)), LineTopology::Pairs, None).expect("a line");
        let mut hit = |_: usize, x: u32, y: u32| hit(x, y);
        let shader = Reached(RefCell::new(&mut hit));
        self.frame((width, height), |scene| scene.draw_lines_with(ALL, &line, &y_down(), &shader, &Thin));
    }

    fn point(&mut self, width: u32, height: u32, center: [i32; 2], side: u32, hit: &mut dyn FnMut(u32, u32)) {
        let vertices = [on_screen(center, 0, width, height)];
        let point = Points::new(Vertices::new(Positions::Homogeneous(&vertices))).expect("a point");
        let mut hit = |_: usize, x: u32, y: u32| hit(x, y);
        let (shader, side) = (Reached(RefCell::new(&mut hit)), Pixels::from_bits(side as i32));
        self.frame((width, height), |scene| scene.draw_points_with(ALL, &point, &y_down(), &shader, side));
    }
}
