//! Measures 2-D drawing: embedded-graphics draws into its own framebuffer of the whole screen, and into strips.
//! `ci/bench-2d` runs it on a Cortex-M0+ and a Cortex-M4 and prints the table.
//!
//! It prints `name pixels` and SysTick's ticks for each way to draw, and names the ways whose pictures differ.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod firmware;
#[cfg(target_os = "none")]
#[path = "firmware/ticks.rs"]
mod ticks;

#[cfg(target_os = "none")]
mod counting {
    use super::ticks;
    use core::convert::Infallible;
    use core::hint::black_box;
    use cortex_m::peripheral::Peripherals;
    use embedded_graphics::framebuffer::{Framebuffer, buffer_size};
    use embedded_graphics::image::{Image, ImageRawLE};
    use embedded_graphics::mono_font::{MonoTextStyle, MonoTextStyleBuilder, ascii};
    use embedded_graphics::pixelcolor::Rgb565;
    use embedded_graphics::pixelcolor::raw::{LittleEndian, RawU16};
    use embedded_graphics::prelude::*;
    use embedded_graphics::primitives::{Circle, Line, PrimitiveStyle, Rectangle};
    use embedded_graphics::text::{Baseline, Text};
    use semihosting::println;
    use zstrip::Scene;
    use zstrip::frame::{Renderer, RendererError};
    use zstrip::span::DepthTest;
    use zstrip::target::{DepthChoice, Overlay, RecordsChoice, Strip, StripPixels};

    const WIDTH: usize = 320;
    const HEIGHT: usize = 240;
    type Full = Framebuffer<Rgb565, RawU16, LittleEndian, WIDTH, HEIGHT, { buffer_size::<Rgb565>(WIDTH, HEIGHT) }>;

    /// Takes drawables: a framebuffer draws all of them; an overlay skips those outside of the strip, and draws an
    /// image's part.
    trait Put {
        fn put<T: Drawable<Color = Rgb565> + Dimensions>(&mut self, drawable: &T);
        fn put_image<T: ImageDrawable<Color = Rgb565>>(&mut self, image: &T, top_left: Point);
    }

    impl Put for Full {
        fn put<T: Drawable<Color = Rgb565> + Dimensions>(&mut self, drawable: &T) {
            let Ok(_) = drawable.draw(self);
        }
        fn put_image<T: ImageDrawable<Color = Rgb565>>(&mut self, image: &T, top_left: Point) {
            let Ok(()) = Image::new(image, top_left).draw(self);
        }
    }

    impl<Z: DepthTest, D: DepthChoice, R: RecordsChoice> Put for Overlay<'_, Strip<'_, Rgb565, D, R>, Z> {
        fn put<T: Drawable<Color = Rgb565> + Dimensions>(&mut self, drawable: &T) {
            self.draw(drawable);
        }
        fn put_image<T: ImageDrawable<Color = Rgb565>>(&mut self, image: &T, top_left: Point) {
            self.draw_image(image, top_left);
        }
    }

    static LINE: &str = "The quick brown fox jumps over the lazy dog 012345678";
    static IMAGE: [u8; 64 * 64 * 2] = [0x5A; 64 * 64 * 2];

    /// A name, the pixels that are decided upon, and the drawing.
    macro_rules! drawings {
        ($with:ident) => {
            $with!("nothing", 0, |_| ());
            // 30 areas of 100 × 60 pixels.
            $with!("fill", 30 * 100 * 60, |to| for k in 0..30 {
                let area = Rectangle::new(Point::new(20 + 6 * k, 3 * k), Size::new(100, 60));
                to.put(&area.into_styled(PrimitiveStyle::with_fill(Rgb565::new(k as u8, 30, 9))));
            });
            // 24 lines of 53 characters.
            $with!("text", 24 * 53 * 60, |to| for k in 0..24 {
                let style = MonoTextStyle::new(&ascii::FONT_6X10, Rgb565::WHITE);
                to.put(&Text::with_baseline(LINE, Point::new(1, 10 * k), style, Baseline::Top));
            });
            $with!("text on a colour", 24 * 53 * 60, |to| for k in 0..24 {
                let style = MonoTextStyleBuilder::new()
                    .font(&ascii::FONT_6X10)
                    .text_color(Rgb565::WHITE)
                    .background_color(Rgb565::BLUE)
                    .build();
                to.put(&Text::with_baseline(LINE, Point::new(1, 10 * k), style, Baseline::Top));
            });
            $with!("image", 15 * 64 * 64, |to| for k in 0..15 {
                let image = ImageRawLE::<Rgb565>::new(&IMAGE, 64);
                to.put(&Image::new(&image, Point::new(k % 5 * 64, k / 5 * 64 + 9)));
            });
            $with!("image, its part", 15 * 64 * 64, |to| for k in 0..15 {
                to.put_image(&ImageRawLE::<Rgb565>::new(&IMAGE, 64), Point::new(k % 5 * 64, k / 5 * 64 + 9));
            });
            // π 50² pixels each.
            $with!("circle", 12 * 7854, |to| for k in 0..12 {
                let circle = Circle::new(Point::new(k % 4 * 70, k / 4 * 65), 100);
                to.put(&circle.into_styled(PrimitiveStyle::with_fill(Rgb565::new(20, 5 * k as u8, 9))));
            });
            $with!("line", 40 * 200, |to| for k in 0..40 {
                let line = Line::new(Point::new(7 * k, 20), Point::new(300 - 7 * k, 219));
                to.put(&line.into_styled(PrimitiveStyle::with_stroke(Rgb565::GREEN, 1)));
            });
        };
    }

    static mut FULL: Full = Full::new();
    static mut COLOR: [u16; WIDTH * HEIGHT] = [0; _];
    static mut DEPTH: [u16; WIDTH * HEIGHT] = [0; _];

    /// Counts the ticks of a closure.
    #[inline(never)]
    fn count(work: impl FnOnce()) -> u32 {
        let start = ticks::now();
        work();
        ticks::now().wrapping_sub(start)
    }

    const SCREEN: Size = Size::new(WIDTH as u32, HEIGHT as u32);

    /// Returns the ticks of a frame in strips, and whether its picture equals the framebuffer's.
    fn strips_of<D: DepthChoice, R: RecordsChoice>(
        renderer: Result<Renderer<'_, Rgb565, D, R>, RendererError>,
        color: &mut [u16],
        full: &Full,
        mut draw: impl FnMut(&mut Scene<'_, Strip<'_, Rgb565, D, R>>),
    ) -> (u32, bool) {
        let mut renderer = renderer.expect("a renderer");
        let (mut ticks, mut equal) = (0, true);
        for check in [false, true] {
            let sink = |strip: &StripPixels<'_, Rgb565>| {
                if check {
                    let start = strip.area().top_left.y as usize * WIDTH * 2;
                    equal &= full.data()[start..start + strip.bytes().len()] == *strip.bytes();
                }
                black_box(strip);
                Ok::<(), Infallible>(())
            };
            let taken = count(|| {
                black_box(renderer.frame_to(sink, color, Rgb565::BLACK, &mut draw).is_ok());
            });
            if !check {
                ticks = taken;
            }
        }
        (ticks, equal)
    }

    pub fn run() {
        let (full, color, depth) = (&raw mut FULL, &raw mut COLOR, &raw mut DEPTH);
        // SAFETY: `run` is called once; these are the only references.
        let (full, color, depth) = unsafe { (&mut *full, &mut *color, &mut *depth) };
        let Some(mut peripherals) = Peripherals::take() else { return };
        ticks::start(&mut peripherals.SYST);
        macro_rules! measure {
            ($name:expr, $pixels:expr, |$to:pat_param| $draw:expr) => {{
                full.data_mut().fill(0);
                let whole = count(|| {
                    let $to = &mut *full;
                    $draw;
                });
                // Strips of 16 rows, a strip of all rows, and strips at a depth.
                let mut strips = [0; 3];
                for (ticks, (rows, deep)) in strips.iter_mut().zip([(16, false), (HEIGHT, false), (16, true)]) {
                    let color = &mut color[..rows * WIDTH];
                    let equal;
                    (*ticks, equal) = if deep {
                        let renderer = Renderer::new(SCREEN).and_then(|it| it.with_depth(&mut depth[..rows * WIDTH]));
                        strips_of(renderer.map(|it| it.with_records(&mut [])), color, full, |scene| {
                            let $to = &mut scene.at_depth(1000);
                            $draw;
                        })
                    } else {
                        strips_of(Renderer::new(SCREEN), color, full, |scene| {
                            let $to = &mut scene.overlay();
                            $draw;
                        })
                    };
                    // At one depth, what is drawn first stays.
                    if !deep && !equal {
                        println!("# {} differs in strips of {rows} rows", $name);
                    }
                }
                println!("{}|{}|{whole}|{}|{}|{}", $name, $pixels, strips[0], strips[1], strips[2]);
            }};
        }
        drawings!(measure);
    }
}

#[cfg(target_os = "none")]
use counting::run;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this example is firmware: ci/bench-2d builds and runs it");
}
