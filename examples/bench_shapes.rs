//! Measures shapes with smooth edges and sprites: frames of some equal ones, in one strip and in several. `ci/bench-2d`
//! runs it on a Cortex-M0+ and a Cortex-M4 and prints the table.
//!
//! It prints `name way ticks shapes pixels` for each way to draw, with the pixels of a shape, and marks frames for a
//! counting plugin. It names the shapes whose pictures differ in strips.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "firmware/count.rs"]
mod count;
#[cfg(target_os = "none")]
mod firmware;
#[cfg(target_os = "none")]
#[path = "firmware/ticks.rs"]
mod ticks;

#[cfg(target_os = "none")]
mod counting {
    use super::count;
    use core::convert::Infallible;
    use core::hint::black_box;
    use semihosting::println;
    use zstrip::embedded_graphics_core::geometry::Size;
    use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, WebColors};
    use zstrip::frame::{Renderer, RendererError};
    use zstrip::math::{Angle16, Pixels, Scalar};
    use zstrip::scene::ShapeBuffer;
    use zstrip::shader::{Blend, Flat, Opacity};
    use zstrip::shape::{
        Circle, CurvePath, Ellipse, Join, LinearGradient, Path, PathStep, Polyline, RadialGradient, Ramp, Ring,
        RoundedRectangle, Sprite,
    };
    use zstrip::target::{DepthChoice, RecordsChoice, Strip, StripPixels};
    use zstrip::texture::{Bilinear, Image, Rgb565Texel, Texture};
    use zstrip::{Canvas, Framebuffer, Scene, ScreenPoint};

    const WIDTH: usize = 320;
    const HEIGHT: usize = 240;
    const SCREEN: Size = Size::new(WIDTH as u32, HEIGHT as u32);
    const WORDS: usize = ShapeBuffer::words(320, 64);
    /// Equal shapes in a frame.
    const SHAPES: i16 = 12;

    static IMAGE: [u8; 64 * 64 * 2] = [0x5A; 64 * 64 * 2];
    static mut COLOR: [u16; WIDTH * HEIGHT] = [0; _];
    static mut DEPTH: [u16; WIDTH * HEIGHT] = [0; _];
    static mut BUFFER: [u32; WORDS] = [0; _];

    /// Kinds of shapes, and about how many pixels each covers.
    const KINDS: [(&str, u32); 16] = [
        ("nothing", 0),
        ("circle,_radius_40", 5027),
        ("circle,_blended", 5027),
        ("circle,_radial_gradient", 5027),
        ("ring,_40_to_34", 1395),
        ("pie,_radius_40,_120_degrees", 1676),
        ("rounded_rectangle,_70_×_50,_radius_8", 3445),
        ("rectangle,_linear_gradient", 3500),
        ("needle_of_4_corners,_70_px", 175),
        ("star_of_5_corners,_crossing", 1500),
        ("line_of_33_points,_3_px,_round_joins", 250),
        ("line_of_33_points,_3_px,_dashes_of_1_px", 125),
        ("ellipse,_40_by_20,_turned", 2513),
        ("drop_of_4_curves,_70_px_high", 2400),
        ("sprite,_64_×_64,_turned", 4096),
        ("sprite,_bilinear", 4096),
    ];

    static DROP: [PathStep; 5] = [
        PathStep::Move(ScreenPoint::corner(0, -35)),
        PathStep::Quad(ScreenPoint::corner(6, -20), ScreenPoint::corner(16, -6)),
        PathStep::Cubic(ScreenPoint::corner(33, 19), ScreenPoint::corner(17, 35), ScreenPoint::corner(0, 35)),
        PathStep::Cubic(ScreenPoint::corner(-17, 35), ScreenPoint::corner(-33, 19), ScreenPoint::corner(-16, -6)),
        PathStep::Quad(ScreenPoint::corner(-6, -20), ScreenPoint::corner(0, -35)),
    ];

    fn px(bits: i32) -> Pixels {
        Pixels::from_bits(bits)
    }

    /// What is made before the frame.
    struct Things<'i> {
        image: Image<'i, Rgb565Texel>,
        ramp: Ramp<64>,
    }

    /// Draws a shape of one kind, the k-th of its frame.
    fn draw<F: Framebuffer>(
        canvas: &mut Canvas<'_, '_, F>,
        kind: usize,
        k: i16,
        things: &Things<'_>,
        buffer: &mut ShapeBuffer<'_>,
    ) {
        let (x, y) = (40 + k % 4 * 78, 45 + k / 4 * 72);
        // Not on whole pixels.
        let center = ScreenPoint::new(px(i32::from(x) * 256 + 77), px(i32::from(y) * 256 + 191));
        let color = Rgb888::CSS_CORAL;
        let radius = px(40 * 256);
        let angle = Angle16(1234 + 5461 * k as u16);
        let corner = |dx: i32, dy: i32| ScreenPoint::new(center.x() + px(256 * dx), center.y() + px(256 * dy));
        let around = |angle: Angle16, radius: i32| {
            let at = |v: Scalar| px((v.to_bits() * radius) >> 8);
            ScreenPoint::new(center.x() + at(angle.cos()), center.y() + at(angle.sin()))
        };
        let rectangle = RoundedRectangle::new(corner(-35, -25), corner(35, 25));
        match kind {
            1 => canvas.fill(&Circle::new(center, radius), color, buffer),
            2 => {
                canvas.fill_with(&Circle::new(center, radius), &Blend::new(Flat::unlit(color), Opacity(99)), 0, buffer)
            }
            3 => {
                let shader = RadialGradient::new(&things.ramp, center, radius);
                canvas.fill_with(&Circle::new(center, radius), &shader, 0, buffer);
            }
            4 => canvas.fill(&Ring::new(center, radius, px(34 * 256)), color, buffer),
            5 => canvas.fill(&Ring::pie(center, radius, angle, Ring::degrees(120)), color, buffer),
            6 => canvas.fill(&rectangle.with_radius(px(8 * 256)), color, buffer),
            7 => {
                let shader = LinearGradient::new(&things.ramp, corner(-35, -25), corner(20, 25));
                canvas.fill_with(&rectangle, &shader, 0, buffer);
            }
            8 => {
                let side = Angle16::from_degrees(90);
                let tip = around(angle, 58);
                let back = around(angle + Angle16(0x8000), 12);
                let beside = |p: ScreenPoint, angle: Angle16, by: i32| {
                    let at = |v: Scalar| px((v.to_bits() * by) >> 16);
                    ScreenPoint::new(p.x() + at(angle.cos()), p.y() + at(angle.sin()))
                };
                let needle = [
                    beside(tip, angle + side, 100),
                    beside(tip, angle - side, 100),
                    beside(back, angle - side, 540),
                    beside(back, angle + side, 540),
                ];
                canvas.fill(&Path::new(&[&needle]), color, buffer);
            }
            9 => {
                let star: [_; 5] = core::array::from_fn(|n| around(angle + Angle16((n * 26_214) as u16), 40));
                canvas.fill(&Path::new(&[&star]), color, buffer);
            }
            10 | 11 => {
                let points: [_; 33] = core::array::from_fn(|n| {
                    let x = n as i32 * 500 - 8000;
                    let y = (Angle16((n * 5000) as u16 + angle.0).sin().to_bits() * 16) >> 8;
                    ScreenPoint::new(center.x() + px(x), center.y() + px(y))
                });
                let line = Polyline::new(&points, px(3 * 256)).with_join(Join::Round);
                let pattern = [px(256), px(256)];
                canvas.fill(&if kind == 10 { line } else { line.with_dashes(&pattern, px(0)) }, color, buffer);
            }
            12 => canvas.fill(&Ellipse::new(center, radius, px(20 * 256)).turned(angle), color, buffer),
            13 => canvas.fill(&CurvePath::new(&DROP).at(center).turned(angle), color, buffer),
            14 => canvas.sprite(&Sprite::new(&things.image).at(center).turned(angle), buffer),
            15 => sprite(canvas, &things.image, center, angle, buffer),
            _ => {}
        }
    }

    #[inline(never)]
    fn sprite<F: Framebuffer>(
        canvas: &mut Canvas<'_, '_, F>,
        image: &impl Texture,
        center: ScreenPoint,
        angle: Angle16,
        buffer: &mut ShapeBuffer<'_>,
    ) {
        let sprite = Sprite::new(image).at(center).turned(angle).filter(Bilinear);
        canvas.sprite(&sprite, buffer);
    }

    /// Returns the ticks of a frame in strips, and a hash of its picture.
    fn frame<D: DepthChoice, R: RecordsChoice>(
        renderer: Result<Renderer<'_, Rgb565, D, R>, RendererError>,
        color: &mut [u16],
        mut draw: impl FnMut(&mut Scene<'_, Strip<'_, Rgb565, D, R>>),
    ) -> (u32, u32) {
        let mut renderer = renderer.expect("a renderer");
        let (mut ticks, mut hash) = (0, 0_u32);
        for check in [false, true] {
            let sink = |strip: &StripPixels<'_, Rgb565>| {
                if check {
                    hash = strip
                        .pixels()
                        .iter()
                        .fold(hash, |hash, pixel| (hash ^ u32::from(*pixel)).wrapping_mul(0x0100_0193));
                }
                black_box(strip);
                Ok::<(), Infallible>(())
            };
            let draw_frame = || renderer.frame_to(sink, color, Rgb565::CSS_NAVY, &mut draw).is_ok();
            if check {
                black_box(draw_frame());
            } else {
                ticks = count::ticks_of(draw_frame);
            }
        }
        (ticks, hash)
    }

    pub fn run() {
        let (color, depth, words) = (&raw mut COLOR, &raw mut DEPTH, &raw mut BUFFER);
        // SAFETY: `run` is called once; these are the only references.
        let (color, depth, words) = unsafe { (&mut *color, &mut *depth, &mut *words) };
        if !count::start() {
            return;
        }
        let image = Image::new(&IMAGE, Size::new(64, 64), Rgb565Texel).expect("an image");
        let ramp = Ramp::new(&[(0, Rgb888::CSS_GOLD), (255, Rgb888::CSS_DARK_BLUE)]);
        let things = Things { image, ramp };
        for (kind, (name, pixels)) in KINDS.into_iter().enumerate() {
            let mut hashes = [0; 2];
            // A strip of all rows, and strips of 16 rows.
            let mut ticks = [0; 3];
            for (n, rows) in [HEIGHT, 16].into_iter().enumerate() {
                (ticks[n], hashes[n]) = frame(Renderer::new(SCREEN), &mut color[..rows * WIDTH], |scene| {
                    let Ok(mut buffer) = ShapeBuffer::new(words, 320) else { return };
                    for k in 0..SHAPES {
                        draw(&mut scene.canvas(), kind, k, &things, &mut buffer);
                    }
                });
            }
            let renderer = Renderer::new(SCREEN).and_then(|it| it.with_depth(&mut depth[..16 * WIDTH]));
            (ticks[2], _) = frame(renderer, &mut color[..16 * WIDTH], |scene| {
                let Ok(mut buffer) = ShapeBuffer::new(words, 320) else { return };
                for k in 0..SHAPES {
                    draw(&mut scene.canvas_at(1000), kind, k, &things, &mut buffer);
                }
            });
            if hashes[0] != hashes[1] {
                println!("# {name} differs in strips of 16 rows");
            }
            for (way, ticks) in ["one_strip", "16_rows", "16_rows_deep"].into_iter().zip(ticks) {
                println!("{name} {way} {ticks} {SHAPES} {pixels}");
            }
        }
    }
}

#[cfg(target_os = "none")]
use counting::run;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this example is firmware: ci/bench-2d builds and runs it");
}
