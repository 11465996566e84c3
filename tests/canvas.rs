//! Shapes on the screen's plane: coverage, colours, scissor, depth; and that strips do not matter.

use crate::reference::exact;
use crate::reference::rng::Rng;
use crate::support::{difference, strips, whole};
use std::cell::RefCell;
use zstrip::color::{Dithered, PixelFormat, Rgb332};
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565, Rgb888, RgbColor};
use zstrip::embedded_graphics_core::primitives::Rectangle;
use zstrip::frame::FramebufferRenderer;
use zstrip::internals::{Line, PixelRect};
use zstrip::math::Pixels;
use zstrip::shader::{Alpha, AlphaTest, Blend, Gouraud, Multiply, Opacity, ScreenDoor};
use zstrip::span::{Compare, DepthState, Fragment, Shader};
use zstrip::target::{FrameSlice, Framebuffer};
use zstrip::vertex::{VertexRef, VertexShader};
use zstrip::{Canvas, Dashed, Scene, ScreenPoint, Smooth, Thick, Thin};

const SCREEN: (u16, u16) = (64, 48);
const EVERYWHERE: PixelRect = PixelRect { x: 0..SCREEN.0 as i32, y: 0..SCREEN.1 as i32 };

fn point(rng: &mut Rng) -> ScreenPoint {
    let far = rng.pick(&[20_000, 20_000, 20_000, 200_000, 40_000_000]);
    ScreenPoint::new(Pixels::from_bits(rng.between(-far / 8, far)), Pixels::from_bits(rng.between(-far / 8, far)))
}

fn color(rng: &mut Rng) -> Rgb888 {
    let [r, g, b] = [(); 3].map(|()| rng.below(256) as u8);
    Rgb888::new(r, g, b)
}

/// Some of everything, at random.
fn draw_any<F: Framebuffer>(scene: &mut Scene<'_, F>, seed: u64) {
    let rng = &mut Rng::new(seed);
    let mut canvas = scene.canvas();
    for _ in 0..60 {
        let points = [(); 5].map(|()| point(rng));
        let corners = points.map(|p| (p, color(rng)));
        match rng.below(10) {
            0 => canvas.polygon(&points[..3], color(rng)),
            1 => canvas.gradient(&corners[..4]),
            2 => canvas.line(points[0], points[1], color(rng)),
            3 => canvas.gradient_line(corners[0], corners[1], &Thick::new(Pixels::from_bits(rng.below(3000) as i32))),
            4 => canvas.gradient_line(corners[0], corners[1], &Smooth::new(Pixels::from_bits(rng.below(3000) as i32))),
            5 => canvas.outline(&points, color(rng), &Dashed(rng.next_u64() as u32)),
            6 => canvas.point(points[0], Pixels::from_bits(rng.below(3000) as i32), color(rng)),
            7 => {
                let corner = Point::new(rng.between(-20, 60), rng.between(-20, 60));
                let area = Rectangle::new(corner, Size::new(rng.below(40) as u32, rng.below(40) as u32));
                canvas.set_scissor((!rng.one_in(3)).then_some(&area));
            }
            8 => canvas.rectangle(&Rectangle::new(Point::new(rng.between(-9, 60), 5), Size::new(7, 9)), color(rng)),
            _ => canvas.set_depth(rng.next_u64() as u16, rng.pick(&[DepthState::LESS, DepthState::OFF])),
        }
    }
}

#[test]
fn strips_do_not_matter() {
    for seed in 0..60 {
        let (expected, ..) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| draw_any(scene, seed));
        assert!(expected.iter().any(|pixel| *pixel != 0));
        for (rows, records) in [(1, 0), (7, 100), (16, 0), (48, 100)] {
            let (picture, _) = strips::<Rgb565>(SCREEN, rows, records, Rgb565::BLACK, |scene| draw_any(scene, seed));
            assert_eq!(difference(&picture, &expected, SCREEN.0), None, "seed {seed}, {rows} rows");
        }
    }
}

/// Counts how often each pixel is drawn.
struct Count<'a>(RefCell<&'a mut Vec<(i32, i32)>>);

impl VertexShader for Count<'_> {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }
}

impl Shader<Gray8> for Count<'_> {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<u8> {
        self.0.borrow_mut().push(fragment.position);
        Some(255)
    }
}

fn hits(draw: impl Fn(&mut Canvas<'_, '_, FrameSlice<'_, Gray8>>, &Count<'_>)) -> Vec<(i32, i32)> {
    let mut pixels = Vec::new();
    let shader = Count(RefCell::new(&mut pixels));
    whole::<Gray8>(SCREEN, Gray8::new(0), |scene| draw(&mut scene.canvas(), &shader));
    pixels.sort_unstable();
    pixels
}

#[test]
fn polygons_are_exact_and_neighbours_share_their_edges() {
    let mut rng = Rng::new(31);
    for _ in 0..200 {
        let grid = rng.pick(&[1, 64, 128]);
        let bits: Vec<_> = (0..4).map(|_| [(); 2].map(|()| rng.between(-2000, 16_000) / grid * grid)).collect();
        let corners = |k: [usize; 3]| {
            k.map(|k| (ScreenPoint::new(Pixels::from_bits(bits[k][0]), Pixels::from_bits(bits[k][1])), []))
        };
        let found = hits(|canvas, shader| canvas.polygon_with(&corners([0, 1, 2]), shader, 0));
        let triangle = exact::widen([bits[0], bits[1], bits[2]]);
        let mut expected = Vec::new();
        exact::for_each_pixel(triangle, SCREEN.0.into(), SCREEN.1.into(), |x, y| expected.push((x as i32, y as i32)));
        expected.sort_unstable();
        assert_eq!(found, expected, "seed {}: {bits:?}", rng.seed());
        // A convex quad in two triangles, and as a fan.
        let across = |a: usize, b: usize, c: usize| exact::area2(exact::widen([bits[a], bits[b], bits[c]])).signum();
        if across(0, 1, 2) == across(0, 2, 3) && across(1, 2, 3) == across(1, 3, 0) {
            let two = hits(|canvas, shader| {
                canvas.polygon_with(&corners([0, 1, 3]), shader, 0);
                canvas.polygon_with(&corners([1, 2, 3]), shader, 0);
            });
            let fan: Vec<_> =
                bits.iter().map(|p| (ScreenPoint::new(Pixels::from_bits(p[0]), Pixels::from_bits(p[1])), [])).collect();
            let fan = hits(|canvas, shader| canvas.polygon_with(&fan, shader, 0));
            assert_eq!(two, fan, "seed {}: {bits:?}", rng.seed());
            assert!(fan.windows(2).all(|pair| pair[0] != pair[1]), "a pixel twice: {bits:?}");
        }
    }
}

#[test]
fn gradients_are_planes_of_colour() {
    let mut rng = Rng::new(32);
    let mut worst = 0_f64;
    for _ in 0..100 {
        let bits = [(); 3].map(|()| [(); 2].map(|()| rng.between(0, 12_000)));
        let colors = [(); 3].map(|()| color(&mut rng));
        let corners = [0, 1, 2]
            .map(|k| (ScreenPoint::new(Pixels::from_bits(bits[k][0]), Pixels::from_bits(bits[k][1])), colors[k]));
        let (picture, ..) = whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| scene.canvas().gradient(&corners));
        exact::for_each_pixel(exact::widen(bits), SCREEN.0.into(), SCREEN.1.into(), |x, y| {
            let channel = |of: fn(&Rgb888) -> u8| {
                let values = [0, 1, 2].map(|k| i64::from(of(&colors[k])));
                exact::to_f64(exact::affine_at(exact::widen(bits), values, exact::center(x.into(), y.into())))
            };
            let expected = [channel(Rgb888::r), channel(Rgb888::g), channel(Rgb888::b)];
            let found = picture[(y * u32::from(SCREEN.0) + x) as usize];
            for (found, expected) in found.iter().zip(expected) {
                worst = worst.max((f64::from(*found) - expected).abs());
            }
        });
    }
    assert!(worst <= 1.0, "{worst}");
    println!("worst error {worst} of 255");
}

#[test]
fn lines_are_those_of_the_rule_and_outlines_close() {
    let mut rng = Rng::new(33);
    for _ in 0..100 {
        let points: Vec<_> = (0..4).map(|_| point(&mut rng)).collect();
        let draw = |closed: bool| {
            let (picture, ..) = whole::<Gray8>(SCREEN, Gray8::new(0), |scene| {
                let mut canvas = scene.canvas();
                match closed {
                    true => canvas.outline(&points, Rgb888::WHITE, &Thin),
                    false => canvas.polyline(&points, Rgb888::WHITE, &Thin),
                }
            });
            picture
        };
        for closed in [false, true] {
            let mut expected = vec![0; 64 * 48];
            for k in 0..if closed { 4 } else { 3 } {
                let [a, b] = [points[k], points[(k + 1) % 4]].map(|p| (p.x().to_bits(), p.y().to_bits()));
                for (x, y) in Line::new(a, b).pixels(&EVERYWHERE).1 {
                    expected[(y * 64 + x) as usize] = 255;
                }
            }
            assert_eq!(draw(closed), expected, "seed {}: {points:?}", rng.seed());
        }
    }
}

/// A small picture as text.
fn ascii(width: u16, pixels: &[u8]) -> String {
    let row = |row: &[u8]| row.iter().map(|p| if *p > 0 { '#' } else { '.' }).collect::<String>();
    pixels.chunks(width.into()).map(row).collect::<Vec<_>>().join("\n")
}

#[test]
fn shapes_look_as_they_should() {
    let (picture, ..) = whole::<Gray8>((16, 9), Gray8::new(0), |scene| {
        let mut canvas = scene.canvas();
        canvas.rectangle(&Rectangle::new(Point::new(-3, 1), Size::new(5, 3)), Rgb888::WHITE);
        canvas.line(ScreenPoint::center(3, 0), ScreenPoint::center(15, 4), Rgb888::WHITE);
        canvas.point(ScreenPoint::corner(4, 6), Pixels::from_bits(512), Rgb888::WHITE);
        let diamond = [(11, 4), (14, 6), (11, 8), (8, 6)].map(|(x, y)| ScreenPoint::corner(x, y));
        canvas.polygon(&diamond, Rgb888::WHITE);
        canvas.set_scissor(Some(&Rectangle::new(Point::new(0, 8), Size::new(4, 9))));
        canvas.line_with(ScreenPoint::corner(0, 8), ScreenPoint::corner(16, 8), Rgb888::WHITE, &Thick::px(3));
    });
    let expected = "\
...##...........
##...###........
##......###.....
##.........###..
..........##..#.
...##....####...
...##....####...
..........##....
####............";
    assert_eq!(ascii(16, &picture), expected, "\n{}", ascii(16, &picture));
}

#[test]
fn depth_puts_shapes_behind_and_in_front() {
    let near = DepthState { compare: Compare::Less, write: true };
    let area = |x: i32| Rectangle::new(Point::new(x, 0), Size::new(8, 1));
    let (picture, depth, _) = whole::<Gray8>((16, 1), Gray8::new(0), |scene| {
        let mut canvas = scene.canvas();
        canvas.set_depth(1000, near);
        canvas.rectangle(&area(0), Rgb888::new(90, 90, 90));
        canvas.set_depth(2000, near);
        canvas.rectangle(&area(4), Rgb888::WHITE);
        canvas.set_depth(500, near);
        canvas.line(ScreenPoint::center(10, 0), ScreenPoint::center(14, 0), Rgb888::new(180, 180, 180));
    });
    assert_eq!(picture, [[90; 8].as_slice(), &[255; 2], &[180; 4], &[0; 2]].concat());
    assert_eq!(depth, [[1000; 8].as_slice(), &[2000; 2], &[500; 4], &[65_535; 2]].concat());
}

#[test]
fn framebuffers_get_the_same_bytes_with_a_stride_and_a_low_depth_buffer() {
    let (expected, ..) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| draw_any(scene, 5));
    let mut color = vec![0; 80 * 48];
    let mut depth = vec![0; 64 * 5];
    let mut renderer = FramebufferRenderer::new(Size::new(SCREEN.0.into(), SCREEN.1.into()))
        .expect("a renderer")
        .with_depth(&mut depth)
        .expect("a renderer");
    let mut frame = FrameSlice::<Rgb565>::with_stride(&mut color, Size::new(64, 48), 80).expect("a framebuffer");
    renderer.frame(&mut frame, Rgb565::BLACK, |scene| draw_any(scene, 5)).expect("a frame");
    let packed: Vec<_> = color.chunks(80).flat_map(|row| &row[..64]).copied().collect();
    assert_eq!(difference(&packed, &expected, SCREEN.0), None);
}

/// Draws a triangle over the whole screen with a shader whose varyings are out of range, by each depth test that has a
/// loop of its own.
fn draw_out_of_range<P: PixelFormat<Raw: PartialEq>, S: Shader<P>>(shader: &S, varyings: S::Varyings) {
    for depth in [DepthState::OFF, DepthState::LESS, DepthState { compare: Compare::LessEqual, write: false }] {
        whole::<P>((20, 4), P::to_color(P::pack([0; 3])), |scene| {
            let corners = [(0, 0), (20, 0), (20, 4), (0, 4)].map(|(x, y)| (ScreenPoint::corner(x, y), varyings));
            let mut canvas = scene.canvas_with(9, depth);
            canvas.polygon_with(&corners, shader, u32::MAX);
            canvas.shaded_line(&[corners[0], corners[2]], shader, 7, &Thin);
            canvas.shaded_line(&[corners[0], corners[2]], shader, 7, &Smooth::px(3));
        });
    }
}

/// Varyings of a canvas come from the caller, so they may be anything.
#[test]
fn colours_out_of_range_are_some_colour_in_every_format_and_wrapper() {
    fn all<P: PixelFormat<Raw: PartialEq>>(varyings: [i32; 3]) {
        let shader = Gouraud::vertex_colors();
        draw_out_of_range::<P, _>(&shader, varyings);
        draw_out_of_range::<P, _>(&Blend::new(shader, Alpha), varyings);
        draw_out_of_range::<P, _>(&Blend::new(shader, Multiply), varyings);
        draw_out_of_range::<P, _>(&Blend::new(shader, Opacity(77)), varyings);
        draw_out_of_range::<P, _>(&AlphaTest::new(shader, 9), varyings);
        draw_out_of_range::<P, _>(&ScreenDoor::new(shader, 9), varyings);
    }
    let numbers = [i32::MIN, -1, 1 << 24, i32::MAX];
    for varyings in numbers.into_iter().flat_map(|a| numbers.map(|b| [a, b, a ^ b])) {
        all::<Rgb565>(varyings);
        all::<Rgb888>(varyings);
        all::<Gray8>(varyings);
        all::<Rgb332>(varyings);
        all::<Dithered<Rgb565>>(varyings);
    }
}
