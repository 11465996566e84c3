//! What embedded-graphics draws into strips is what it draws into a framebuffer of its own.

use crate::reference::rng::Rng;
use crate::support::strips;
use embedded_graphics::Drawable;
use embedded_graphics::framebuffer::Framebuffer as Full;
use embedded_graphics::geometry::{AnchorPoint, AngleUnit};
use embedded_graphics::image::{GetPixel, Image, ImageDrawableExt, ImageRaw, ImageRawBE};
use embedded_graphics::mono_font::{MonoTextStyle, MonoTextStyleBuilder, ascii};
use embedded_graphics::pixelcolor::{Bgr565, BinaryColor, Gray8, Rgb565, Rgb888, WebColors, raw::LittleEndian};
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::*;
use embedded_graphics::text::{Alignment, Baseline, Text, TextStyleBuilder};
use zstrip::color::{Dithered, PixelFormat, Rgb332, Rgb565Be};
use zstrip::frame::{FramebufferRenderer, Renderer};
use zstrip::span::{DepthOff, DepthState};
use zstrip::target::{FrameSlice, Overlay, StripPixels};
use zstrip::target::{WithDepth, WithRecords};

const WIDTH: usize = 96;
const HEIGHT: usize = 70;
const SCREEN: (u16, u16) = (WIDTH as u16, HEIGHT as u16);

/// Takes drawables one by one: as they are, or with what is off the strip left out first.
trait Put<C: PixelColor> {
    fn put<T: Drawable<Color = C> + Dimensions>(&mut self, drawable: &T);
    /// What only a target can be asked for.
    fn target(&mut self) -> &mut impl DrawTarget<Color = C, Error = core::convert::Infallible>;
}

struct AsItIs<'t, D>(&'t mut D);

impl<D: DrawTarget<Error = core::convert::Infallible>> Put<D::Color> for AsItIs<'_, D> {
    fn put<T: Drawable<Color = D::Color> + Dimensions>(&mut self, drawable: &T) {
        let Ok(_) = drawable.draw(self.0);
    }
    fn target(&mut self) -> &mut impl DrawTarget<Color = D::Color, Error = core::convert::Infallible> {
        self.0
    }
}

struct Cut<'t, 'c, F>(&'t mut Overlay<'c, F, DepthOff>);

impl<F: zstrip::Framebuffer> Put<<F::Format as PixelFormat>::Color> for Cut<'_, '_, F> {
    fn put<T: Drawable<Color = <F::Format as PixelFormat>::Color> + Dimensions>(&mut self, drawable: &T) {
        self.0.draw(drawable);
    }
    fn target(
        &mut self,
    ) -> &mut impl DrawTarget<Color = <F::Format as PixelFormat>::Color, Error = core::convert::Infallible> {
        self.0
    }
}

/// An image of 24 × 19 pixels.
fn image_bytes() -> Vec<u8> {
    (0..24 * 19).flat_map(|k: u32| [(k % 24 * 10) as u8, (k / 24 * 13) as u8, (k * 37 % 256) as u8]).collect()
}

/// One of everything: text, images, shapes; also across the borders of the screen, outside of it, and on top of each
/// other.
fn everything<C: PixelColor + From<Rgb888>>(to: &mut impl Put<C>) {
    let color = |c: Rgb888| C::from(c);
    let bytes = image_bytes();
    let image = ImageRawBE::<Rgb888>::new(&bytes, 24);

    // Shapes.
    let both = PrimitiveStyleBuilder::new()
        .stroke_color(color(Rgb888::CSS_ORANGE))
        .fill_color(color(Rgb888::CSS_NAVY))
        .stroke_width(3)
        .build();
    for alignment in [StrokeAlignment::Inside, StrokeAlignment::Center, StrokeAlignment::Outside] {
        let style = PrimitiveStyleBuilder::from(&both).stroke_alignment(alignment).build();
        let at = Point::new(alignment as i32 * 30 - 9, -8);
        to.put(&Circle::new(at, 26).into_styled(style));
        to.put(&Rectangle::new(at + Point::new(3, 40), Size::new(21, 11)).into_styled(style));
    }
    let thin = PrimitiveStyle::with_stroke(color(Rgb888::CSS_LIME), 1);
    let thick = PrimitiveStyle::with_stroke(color(Rgb888::CSS_HOT_PINK), 5);
    to.put(&Line::new(Point::new(-20, 3), Point::new(120, 66)).into_styled(thin));
    to.put(&Line::new(Point::new(90, -15), Point::new(4, 90)).into_styled(thick));
    to.put(&Triangle::new(Point::new(50, 20), Point::new(110, 50), Point::new(60, 75)).into_styled(both));
    to.put(&Ellipse::new(Point::new(60, 50), Size::new(50, 14)).into_styled(both));
    to.put(&Arc::new(Point::new(20, 20), 40, 30.0.deg(), 250.0.deg()).into_styled(thick));
    to.put(&Sector::new(Point::new(-6, 44), 38, -60.0.deg(), 130.0.deg()).into_styled(both));
    let corners = CornerRadii::new(Size::new(7, 4));
    let rectangle = Rectangle::new(Point::new(70, 5), Size::new(40, 30));
    to.put(&RoundedRectangle::new(rectangle, corners).into_styled(both));
    let points = [Point::new(3, 60), Point::new(30, 30), Point::new(45, 65), Point::new(93, 10), Point::new(99, 71)];
    to.put(&Polyline::new(&points).into_styled(PrimitiveStyle::with_stroke(color(Rgb888::CSS_CYAN), 4)));
    to.put(&Circle::new(Point::new(300, 300), 20).into_styled(both));
    to.put(&Circle::new(Point::new(-100, 10), 20).into_styled(both));

    // Text.
    let small = MonoTextStyle::new(&ascii::FONT_6X10, color(Rgb888::WHITE));
    to.put(&Text::new("clipped at the right border", Point::new(10, 20), small));
    to.put(&Text::new("at the left", Point::new(-20, 32), small));
    to.put(&Text::with_baseline("off the top", Point::new(5, -4), small, Baseline::Top));
    let styled = MonoTextStyleBuilder::new()
        .font(&ascii::FONT_10X20)
        .text_color(color(Rgb888::YELLOW))
        .background_color(color(Rgb888::CSS_DARK_RED))
        .underline_with_color(color(Rgb888::GREEN))
        .strikethrough()
        .build();
    let centered = TextStyleBuilder::new().alignment(Alignment::Center).baseline(Baseline::Middle).build();
    let underlined = Text::with_text_style("two\nlines", Point::new(50, 40), styled, centered);
    // Its bounding box ends at the underline, its background below.
    let Ok(_) = underlined.draw(to.target());
    to.put(&Text::with_alignment("ends here", Point::new(96, 69), small, Alignment::Right));

    // Images.
    let mut converted = to.target().color_converted();
    let Ok(()) = Image::new(&image, Point::new(-5, 55)).draw(&mut converted);
    let Ok(()) = Image::new(&image, Point::new(80, -9)).draw(&mut converted);
    let sub = image.sub_image(&Rectangle::new(Point::new(3, 5), Size::new(11, 9)));
    let Ok(()) = Image::new(&sub, Point::new(40, 12)).draw(&mut converted);
    let Ok(()) =
        Image::with_center(&sub.sub_image(&Rectangle::new(Point::new(2, 2), Size::new(5, 5))), Point::new(9, 9))
            .draw(&mut converted);

    // Targets made of the target.
    let part = Rectangle::new(Point::new(20, 25), Size::new(30, 17));
    let Ok(()) = Circle::new(Point::new(15, 20), 40).into_styled(both).draw(&mut to.target().clipped(&part));
    let mut cropped = to.target().cropped(&part);
    let Ok(()) = cropped.clear(color(Rgb888::CSS_DARK_OLIVE_GREEN));
    let anchor = cropped.bounding_box().anchor_point(AnchorPoint::BottomRight);
    let Ok(_) = Text::with_alignment("crop", anchor, small, Alignment::Right).draw(&mut cropped);
    let mut moved = to.target().translated(Point::new(-13, 41));
    let Ok(()) = Rectangle::new(Point::new(30, 5), Size::new(9, 40)).into_styled(both).draw(&mut moved);
}

/// Only every other pixel, some of them outside, in no order.
fn sprinkle<D: DrawTarget<Error = core::convert::Infallible>>(target: &mut D, colors: &[D::Color]) {
    let mut rng = Rng::new(5);
    let mut pixel = || {
        let at = Point::new(rng.between(-20, 120), rng.between(-20, 90));
        Pixel(at, colors[rng.below(colors.len() as u64) as usize])
    };
    let Ok(()) = target.draw_iter(core::iter::repeat_with(&mut pixel).take(900));
    let far = [i32::MIN, -1, 0, i32::MAX].map(|v| [Point::new(v, 5), Point::new(5, v), Point::new(v, v)]);
    let Ok(()) = target.draw_iter(far.into_iter().flatten().map(|at| Pixel(at, colors[0])));
}

type FullScreen<C> = Full<C, <C as PixelColor>::Raw, LittleEndian, WIDTH, HEIGHT, { WIDTH * HEIGHT * 4 }>;

/// The pictures in strips, of every height and with various records, against the one in embedded-graphics' framebuffer.
macro_rules! check {
    ($format:ty, $color:ty, $draw:expr, $cut:expr) => {{
        let mut full = FullScreen::<$color>::new();
        let background = <$color>::from(Rgb888::new(30, 20, 60));
        let Ok(()) = full.clear(background);
        $draw(&mut full);
        let at = |k: usize| full.pixel(Point::new((k % WIDTH) as i32, (k / WIDTH) as i32)).expect("a pixel");
        let drawn = (0..WIDTH * HEIGHT).filter(|k| at(*k) != background).count();
        assert!(drawn > 300, "only {drawn} pixels are drawn");
        let check = |picture: &[<$format as PixelFormat>::Raw], what: &str| {
            for (k, raw) in picture.iter().enumerate() {
                let found = <$format as PixelFormat>::to_color(*raw);
                // As the format can show it.
                let expected = <$format as PixelFormat>::to_color(<$format as PixelFormat>::from_color(at(k)));
                assert_eq!(found, expected, "{}: pixel ({}, {}), {what}", stringify!($format), k % WIDTH, k / WIDTH);
            }
        };
        for rows in [1, 2, 5, 16, HEIGHT] {
            for records in [0, 200] {
                let what = format!("{rows} rows, {records} records");
                let (picture, _) =
                    strips::<$format>(SCREEN, rows, records, background, |scene| $draw(&mut scene.overlay()));
                check(&picture, &what);
                let (picture, stats) =
                    strips::<$format>(SCREEN, rows, records, background, |scene| $cut(&mut scene.overlay()));
                check(&picture, &format!("{what}, cut"));
                assert_eq!((stats.draws, stats.drawn), (0, 0), "nothing of it is counted");
            }
            // Without a depth buffer, where an overlay at a depth is an overlay.
            let mut color = vec![Default::default(); WIDTH * rows];
            let mut renderer =
                Renderer::<$format>::new(Size::new(SCREEN.0.into(), SCREEN.1.into())).expect("a renderer");
            for z in [None, Some(65_535)] {
                let mut picture = Vec::new();
                let sink = |strip: &StripPixels<'_, $format>| {
                    picture.extend_from_slice(strip.pixels());
                    Ok::<(), core::convert::Infallible>(())
                };
                renderer
                    .frame_to(sink, &mut color, background, |scene| match z {
                        None => $draw(&mut scene.overlay()),
                        Some(z) => $draw(&mut scene.at_depth(z)),
                    })
                    .expect("a frame");
                check(&picture, &format!("{rows} rows, no depth, {z:?}"));
            }
        }
        let mut pixels = vec![Default::default(); (WIDTH + 7) * HEIGHT];
        let mut slice =
            FrameSlice::<$format>::with_stride(&mut pixels, Size::new(WIDTH as u32, HEIGHT as u32), WIDTH + 7)
                .expect("a framebuffer");
        let mut depth = vec![0; WIDTH * 9];
        let mut renderer = FramebufferRenderer::new(Size::new(SCREEN.0.into(), SCREEN.1.into()))
            .expect("a renderer")
            .with_depth(&mut depth)
            .expect("a renderer");
        renderer.frame(&mut slice, background, |scene| $draw(&mut scene.overlay())).expect("a frame");
        let packed: Vec<_> = pixels.chunks(WIDTH + 7).flat_map(|row| &row[..WIDTH]).copied().collect();
        check(&packed, "in a framebuffer with a stride");
    }};
}

#[test]
fn drawing_in_strips_is_the_drawing_in_a_framebuffer() {
    macro_rules! everything {
        ($format:ty, $color:ty) => {
            check!($format, $color, |t: &mut _| everything::<$color>(&mut AsItIs(t)), |c: &mut _| everything::<$color>(
                &mut Cut(c)
            ))
        };
    }
    everything!(Rgb565, Rgb565);
    everything!(Rgb565Be, Rgb565);
    everything!(Rgb888, Rgb888);
    everything!(Gray8, Gray8);
    everything!(Bgr565, Bgr565);
    everything!(Rgb332, Rgb888);
    everything!(Dithered<Rgb565Be>, Rgb565);
}

#[test]
fn images_are_drawn_by_the_part_in_the_strip() {
    let bytes = image_bytes();
    let raw = ImageRawBE::<Rgb888>::new(&bytes, 24);
    let sub = raw.sub_image(&Rectangle::new(Point::new(5, 3), Size::new(13, 11)));
    let bits = ImageRaw::<BinaryColor>::new(&bytes, 21);
    let places: Vec<_> = {
        let mut rng = Rng::new(8);
        let near = (0..25).map(|_| Point::new(rng.between(-30, 100), rng.between(-30, 75)));
        near.chain([Point::new(i32::MIN, 0), Point::new(3, i32::MAX), Point::new(i32::MAX, i32::MIN)]).collect()
    };
    for (rows, deep) in [(1, false), (7, false), (16, true), (HEIGHT, false)] {
        let mut full = FullScreen::<Rgb565>::new();
        let (picture, _) = strips::<Rgb565>(SCREEN, rows, 0, Rgb565::BLACK, |scene| {
            for (k, at) in places.iter().enumerate() {
                // Nearer and nearer, so that the last one shows at a depth, too.
                let mut overlay =
                    scene.at_depth_with(1000 - k as u16, if deep { DepthState::LESS } else { DepthState::OFF });
                match k % 3 {
                    0 => overlay.draw_image(&raw, *at),
                    1 => overlay.draw_image(&sub, *at),
                    _ => overlay.draw_image(&bits, *at),
                }
            }
        });
        for (k, at) in places.iter().take(25).enumerate() {
            let Ok(()) = match k % 3 {
                0 => Image::new(&raw, *at).draw(&mut full.color_converted()),
                1 => Image::new(&sub, *at).draw(&mut full.color_converted()),
                _ => Image::new(&bits, *at).draw(&mut full.color_converted()),
            };
        }
        for (k, raw) in picture.iter().enumerate() {
            let at = Point::new((k % WIDTH) as i32, (k / WIDTH) as i32);
            assert_eq!(Some(Rgb565::to_color(*raw)), full.pixel(at), "{at:?}, {rows} rows, deep: {deep}");
        }
        assert!(picture.iter().filter(|p| **p != 0).count() > 1000, "{rows} rows: the picture is empty");
    }
}

#[test]
fn pixels_in_no_order_and_far_away_are_those_in_a_framebuffer() {
    let colors = [Rgb565::CSS_TAN, Rgb565::CSS_TEAL, Rgb565::WHITE];
    let plain = |overlay: &mut Overlay<'_, zstrip::target::Strip<'_, Rgb565, WithDepth, WithRecords>, _>| {
        sprinkle(overlay, &colors)
    };
    check!(Rgb565, Rgb565, |target: &mut _| sprinkle(target, &colors), plain);
}
