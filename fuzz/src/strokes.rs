//! Lines. Thin ones, on the canvas and in space, draw exactly the pixels of the diamond-exit rule; dashed ones draw
//! some of these. Lines in every stroke and with every shader, and polygons, are the same in any strips.

use crate::reference::diamonds;
use crate::scenes::{assert_alike, canvas, strip_rows};
use crate::source::Source;
use crate::things::{self, Kit, Pool};
use crate::{Hash, with_line_shader};
use core::convert::Infallible;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565, Rgb888, RgbColor};
use zstrip::frame::Renderer;
use zstrip::math::{Pixels, Projective, Scalar};
use zstrip::mesh::{LineTopology, Lines, Positions, Vertices};
use zstrip::shader::Flat;
use zstrip::span::DepthState;
use zstrip::target::StripPixels;
use zstrip::{Dashed, Framebuffer, Scene, ScreenPoint, Smooth, State, Thick, Thin};

pub fn run(input: &[u8]) -> u64 {
    let mut source = Source::new(input);
    match source.below(3) {
        0 => exact(&mut source),
        _ => alike(&mut source),
    }
}

const SIDE: usize = 8;

/// A chain of two thin lines on a screen of 8×8 pixels.
fn exact(source: &mut Source<'_>) -> u64 {
    let (in_space, rows, dashes) = (source.flag(), 1 + source.below(SIDE), source.u32() | 1);
    let mut ends = [[0; 2]; 3];
    for k in 0..3 {
        let base = ends[if k == 0 { 0 } else { k - 1 }];
        ends[k] = [source.coordinate(base[0]), source.coordinate(base[1])];
        if in_space {
            // Away from the guard band, which moves ends.
            ends[k] = ends[k].map(|c| c >> 3);
        }
    }
    let screen = Size::new(SIDE as u32, SIDE as u32);
    let mut renderer = Renderer::<Gray8>::new(screen).expect("a renderer");
    let mut buffer = [0; SIDE * SIDE];
    let mut picture = |dashes: u32| {
        let mut pixels = Vec::with_capacity(SIDE * SIDE);
        let sink = |strip: &StripPixels<'_, Gray8>| {
            pixels.extend_from_slice(strip.pixels());
            Ok::<(), Infallible>(())
        };
        let frame = renderer.frame_to(sink, &mut buffer[..SIDE * rows], Rgb888::BLACK, |scene| {
            if in_space {
                chain(scene, ends, dashes);
                return;
            }
            let points = ends.map(|[x, y]| ScreenPoint::new(Pixels::from_bits(x), Pixels::from_bits(y)));
            let mut canvas = scene.canvas();
            match dashes {
                u32::MAX => canvas.polyline(&points, Rgb888::WHITE, &Thin),
                _ => canvas.polyline(&points, Rgb888::WHITE, &Dashed(dashes)),
            }
        });
        frame.expect("the same scene");
        pixels
    };
    let (thin, dashed) = (picture(u32::MAX), picture(dashes));
    for (k, (thin, dashed)) in thin.iter().zip(&dashed).enumerate() {
        let (x, y) = ((k % SIDE) as i32, (k / SIDE) as i32);
        let [a, b, c] = ends;
        let expected = diamonds::draws(a, b, x, y) || diamonds::draws(b, c, x, y);
        assert_eq!(*thin != 0, expected, "pixel ({x}, {y}) of {ends:?}, in space: {in_space}");
        assert!(expected || *dashed == 0, "pixel ({x}, {y}) of {ends:?}, dashed");
    }
    let mut hash = Hash::default();
    hash.bytes(&thin);
    hash.bytes(&dashed);
    hash.0
}

/// The same chain as lines in space, at w = 1.
fn chain<F: Framebuffer>(scene: &mut Scene<'_, F>, ends: [[i32; 2]; 3], dashes: u32) {
    let clip = |c: i32| Scalar::from_bits(((i64::from(c) - 128 * SIDE as i64) * 65_536 / (128 * SIDE as i64)) as i32);
    let vertices = ends.map(|[x, y]| [clip(x), -clip(y), Scalar::ZERO, Scalar::ONE]);
    let lines = Lines::new(Vertices::new(Positions::Homogeneous(&vertices)), LineTopology::Strip, None);
    let (lines, shader) = (lines.expect("a chain"), Flat::unlit(Rgb888::WHITE));
    let state = State { depth: DepthState::OFF, ..State::DEFAULT };
    match dashes {
        u32::MAX => scene.draw_lines_with(state, &lines, &Projective::IDENTITY, &shader, &Thin),
        _ => scene.draw_lines_with(state, &lines, &Projective::IDENTITY, &shader, &Dashed(dashes)),
    }
}

/// Lines in space and a shape on the canvas.
struct Drawing {
    screen: (u16, u16),
    pool: Pool,
    kit: Kit,
    state: State,
    mvp: Projective,
    shader: usize,
    stroke: u8,
    width: Pixels,
    z: u16,
    depth: DepthState,
    what: u8,
    at: [ScreenPoint; 4],
    size: Pixels,
}

impl Drawing {
    fn new(source: &mut Source<'_>) -> Self {
        let mut last = [0; 2];
        Self {
            screen: (1 + source.below(32) as u16, 1 + source.below(24) as u16),
            pool: Pool::new(source),
            kit: Kit::new(source),
            state: things::state(source),
            mvp: source.projective(),
            shader: source.below(6),
            stroke: source.u8(),
            width: things::width(source),
            z: source.u16(),
            depth: things::depth_state(source),
            what: source.u8(),
            at: core::array::from_fn(|_| {
                last = last.map(|c| source.coordinate(c));
                ScreenPoint::new(Pixels::from_bits(last[0]), Pixels::from_bits(last[1]))
            }),
            size: things::width(source),
        }
    }

    fn draw<F: Framebuffer>(&self, scene: &mut Scene<'_, F>) {
        let (kit, state, mvp) = (&self.kit, self.state, &self.mvp);
        if let Some(lines) = self.pool.lines() {
            let pattern = Dashed(u32::from(self.stroke) * 0x0101_0101);
            with_line_shader!(self.shader, kit, |shader| match self.stroke & 3 {
                0 => scene.draw_lines_with(state, &lines, mvp, shader, &Thin),
                1 => scene.draw_lines_with(state, &lines, mvp, shader, &pattern),
                2 => scene.draw_lines_with(state, &lines, mvp, shader, &Thick::new(self.width)),
                _ => scene.draw_lines_with(state, &lines, mvp, shader, &Smooth::new(self.width)),
            });
        }
        canvas(scene, kit, (self.z, self.depth), self.what, &self.at, self.size, None);
    }

    fn picture(&self, rows: usize, words: usize) -> Vec<u16> {
        let (width, height) = (usize::from(self.screen.0), usize::from(self.screen.1));
        let mut picture = Vec::with_capacity(width * height);
        let (mut color, mut depth, mut records) = (vec![7; width * rows], vec![7; width * rows], vec![7; words]);
        let renderer = Renderer::<Rgb565>::new(Size::new(width as u32, height as u32)).expect("a renderer");
        let sink = |strip: &StripPixels<'_, Rgb565>| {
            picture.extend_from_slice(strip.pixels());
            Ok::<(), Infallible>(())
        };
        let mut renderer = renderer.with_depth(&mut depth).expect("depths").with_records(&mut records);
        renderer.frame_to(sink, &mut color, Rgb888::BLUE, |scene| self.draw(scene)).expect("the same scene");
        picture
    }
}

fn alike(source: &mut Source<'_>) -> u64 {
    let (rows, words) = (source.u8(), usize::from(source.u16()) % 300);
    let drawing = Drawing::new(source);
    let rows = strip_rows(rows, drawing.screen.1);
    let expected = drawing.picture(drawing.screen.1.into(), 1000);
    for (rows, words) in [(rows, words), (rows, 0)] {
        assert_alike(&drawing.picture(rows, words), &expected, drawing.screen, &(rows, words));
    }
    let mut hash = Hash::default();
    hash.bytes(zstrip::bytemuck::cast_slice(&expected));
    hash.0
}
