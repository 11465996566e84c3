//! Targets for embedded-graphics: drawings at one depth, viewports, and coordinates at the ends of 32 bits.

use crate::reference::rng::Rng;
use crate::support::{difference, strips, whole};
use embedded_graphics::mono_font::{MonoTextStyleBuilder, ascii};
use embedded_graphics::prelude::*;
use embedded_graphics::text::Text;
use zstrip::embedded_graphics_core::image::ImageDrawable;
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565};
use zstrip::embedded_graphics_core::primitives::Rectangle;
use zstrip::span::{Compare, DepthState};
use zstrip::vertex::Viewport;
use zstrip::{Framebuffer, Scene, ScreenPoint};

const SCREEN: (u16, u16) = (48, 24);

#[test]
fn what_is_drawn_second_at_one_depth_covers_what_was_drawn_first() {
    let style = MonoTextStyleBuilder::new()
        .font(&ascii::FONT_10X20)
        .text_color(Rgb565::YELLOW)
        .background_color(Rgb565::BLUE)
        .underline_with_color(Rgb565::RED)
        .strikethrough()
        .build();
    let panel = Rectangle::new(Point::new(1, 1), Size::new(40, 22));
    for z in [0, 1000, 65_535] {
        macro_rules! label {
            ($target:expr) => {{
                let mut target = $target;
                let Ok(()) = target.fill_solid(&panel, Rgb565::GREEN);
                let Ok(_) = Text::new("gjp", Point::new(4, 15), style).draw(&mut target);
            }};
        }
        let (expected, ..) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| label!(scene.overlay()));
        assert!([Rgb565::RED, Rgb565::YELLOW, Rgb565::BLUE].iter().all(|c| expected.contains(&c.into_storage())));
        let (found, depth, _) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| label!(scene.at_depth(z)));
        assert_eq!(difference(&found, &expected, SCREEN.0), None, "at depth {z}");
        assert_eq!(depth[usize::from(SCREEN.0) * 5 + 5], z);
        for rows in [1, 7] {
            let (found, _) = strips::<Rgb565>(SCREEN, rows, 50, Rgb565::BLACK, |scene| label!(scene.at_depth(z)));
            assert_eq!(difference(&found, &expected, SCREEN.0), None, "at depth {z}, {rows} rows");
        }
    }
    // What is nearer stays, and what was nearer than the stored depth keeps its own.
    let (found, depth, _) = whole::<Gray8>((4, 1), Gray8::new(0), |scene| {
        for (x, z, value) in [(0, 500, 10), (1, 501, 20), (2, 499, 30)] {
            let Ok(()) = scene.at_depth(z).draw_iter([Pixel(Point::new(x, 0), Gray8::new(value))]);
        }
        let Ok(()) = scene.at_depth(500).fill_solid(&Rectangle::new(Point::zero(), Size::new(4, 1)), Gray8::new(99));
    });
    assert_eq!((found, depth), (vec![99, 99, 30, 99], vec![500, 500, 499, 500]));
}

#[test]
fn what_is_drawn_second_on_a_canvas_at_one_depth_covers_what_was_drawn_first() {
    fn shapes<F: Framebuffer<Format = Rgb565>>(scene: &mut Scene<'_, F>, z: Option<u16>) {
        let mut canvas = match z {
            Some(z) => scene.canvas_at(z),
            None => scene.canvas(),
        };
        canvas.rectangle(&Rectangle::new(Point::new(2, 2), Size::new(30, 18)), Rgb565::GREEN);
        canvas.polygon(&[(4, 4), (30, 6), (20, 20)].map(|(x, y)| ScreenPoint::corner(x, y)), Rgb565::BLUE);
        canvas.line(ScreenPoint::center(0, 0), ScreenPoint::center(40, 20), Rgb565::RED);
        canvas.point(ScreenPoint::corner(12, 10), zstrip::math::Pixels::from_num(4), Rgb565::WHITE);
    }
    let (expected, ..) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| shapes(scene, None));
    let (found, ..) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| shapes(scene, Some(700)));
    assert_eq!(difference(&found, &expected, SCREEN.0), None);
}

/// An image of one colour that draws itself in two calls.
struct Stamp;

impl OriginDimensions for Stamp {
    fn size(&self) -> Size {
        Size::new(13, 9)
    }
}

impl ImageDrawable for Stamp {
    type Color = Rgb565;

    fn draw<D: DrawTarget<Color = Rgb565>>(&self, target: &mut D) -> Result<(), D::Error> {
        self.draw_sub_image(target, &Rectangle::new(Point::zero(), self.size()))
    }

    fn draw_sub_image<D: DrawTarget<Color = Rgb565>>(&self, target: &mut D, area: &Rectangle) -> Result<(), D::Error> {
        target.fill_solid(&Rectangle::new(Point::zero(), area.size), Rgb565::CYAN)?;
        target.draw_iter([Pixel(Point::new(-area.top_left.x, -area.top_left.y), Rgb565::RED)])
    }
}

/// Draws with every call that a target has.
fn every_call<F>(scene: &mut Scene<'_, F>, seed: u64)
where
    F: Framebuffer<Format = Rgb565>,
{
    let rng = &mut Rng::new(seed);
    for k in 0..30 {
        let color = Rgb565::from(embedded_graphics::pixelcolor::raw::RawU16::new(rng.next_u64() as u16 | 1));
        let at = Point::new(rng.between(-20, 50), rng.between(-10, 25));
        let area = Rectangle::new(at, Size::new(rng.below(30) as u32, rng.below(20) as u32));
        let colors: Vec<_> = (0..600).map(|k: u16| Rgb565::new(k as u8 & 31, (k >> 5) as u8, 1)).collect();
        macro_rules! call {
            ($target:expr) => {{
                let mut target = $target;
                let Ok(()) =
                    match rng.below(if k == 0 { 6 } else { 5 }) {
                        0 => target.fill_solid(&area, color),
                        1 => target.fill_contiguous(&area, colors.iter().copied()),
                        2 => target.draw_iter(area.points().map(|at| Pixel(at, color))),
                        3 => Ok(target
                            .draw(&area.into_styled(embedded_graphics::primitives::PrimitiveStyle::with_fill(color)))),
                        4 => Ok(target.draw_image(&Stamp, at)),
                        _ => target.clear(color),
                    };
            }};
        }
        match rng.below(3) {
            0 => call!(scene.overlay()),
            1 => call!(scene.at_depth(60_000 - 100 * k)),
            _ => call!(scene.at_depth_with(60_000, DepthState { compare: Compare::Always, write: true })),
        }
    }
}

#[test]
fn nothing_is_drawn_outside_of_the_viewport() {
    let mut rng = Rng::new(71);
    let mut cut = 0;
    for case in 0..300 {
        let corner = Point::new(rng.between(-60, 60), rng.between(-30, 30));
        let size = Size::new(rng.between(1, 70) as u32, rng.between(1, 40) as u32);
        let viewport = Viewport::new(corner, size).expect("a viewport");
        let inside = Rectangle::new(corner, size);
        let (all, depths, _) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| every_call(scene, case));
        let at = |k: usize| Point::new((k % usize::from(SCREEN.0)) as i32, (k / usize::from(SCREEN.0)) as i32);
        let (mut expected, mut expected_depths) = (all, depths);
        for k in 0..expected.len() {
            if !inside.contains(at(k)) {
                cut += usize::from(expected[k] != 0);
                (expected[k], expected_depths[k]) = (0, 65_535);
            }
        }
        let case_name = format!("case {case}, viewport {corner:?} {size:?}");
        let (found, depths, _) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| {
            scene.set_viewport(viewport);
            every_call(scene, case);
        });
        assert_eq!(difference(&found, &expected, SCREEN.0), None, "{case_name}");
        assert_eq!(difference(&depths, &expected_depths, SCREEN.0), None, "{case_name}, depths");
        let (found, _) = strips::<Rgb565>(SCREEN, 5, 20, Rgb565::BLACK, |scene| {
            scene.set_viewport(viewport);
            every_call(scene, case);
        });
        assert_eq!(difference(&found, &expected, SCREEN.0), None, "{case_name}, strips");
    }
    assert!(cut > 10_000, "only {cut} pixels lay outside");
}

/// Numbered colours, as many as an area has pixels. Passing over them takes one step.
struct Numbered {
    next: u128,
    count: u128,
}

/// The colour of a number: never black.
fn numbered(number: u128) -> Gray8 {
    Gray8::new((number.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32) as u8 | 1)
}

impl Iterator for Numbered {
    type Item = Gray8;

    fn next(&mut self) -> Option<Gray8> {
        self.nth(0)
    }

    fn nth(&mut self, n: usize) -> Option<Gray8> {
        let number = self.next.saturating_add(n as u128);
        self.next = number.saturating_add(1);
        (number < self.count).then(|| numbered(number))
    }
}

/// An image that has the number of a pixel for its colour, and asks for all of it in one call.
struct Huge(Size);

impl OriginDimensions for Huge {
    fn size(&self) -> Size {
        self.0
    }
}

impl ImageDrawable for Huge {
    type Color = Gray8;

    fn draw<D: DrawTarget<Color = Gray8>>(&self, target: &mut D) -> Result<(), D::Error> {
        let count = u128::from(self.0.width) * u128::from(self.0.height);
        target.fill_contiguous(&Rectangle::new(Point::zero(), self.0), Numbered { next: 0, count })
    }

    fn draw_sub_image<D: DrawTarget<Color = Gray8>>(&self, target: &mut D, area: &Rectangle) -> Result<(), D::Error> {
        let (top_left, width) = (area.top_left, u128::from(self.0.width));
        let sum = |a: i32, b: i32| (i64::from(a) + i64::from(b)) as u128;
        let number = |at: Point| sum(at.y, top_left.y) * width + sum(at.x, top_left.x);
        let here = Rectangle::new(Point::zero(), area.size);
        target.draw_iter(here.points().map(|at| Pixel(at, numbered(number(at)))))
    }
}

#[test]
fn areas_at_the_ends_of_32_bits_are_drawn_exactly() {
    const SIDE: i32 = 6;
    let starts = [i32::MIN, i32::MIN + 1, -65_537, -3, 0, 2, SIDE, 65_536, i32::MAX - 1, i32::MAX];
    let sizes = [0, 1, 3, 70_000, (1 << 31) - 1, 1 << 31, (1 << 31) + 1, (1 << 31) + 4, u32::MAX - 1, u32::MAX];
    let mut drawn = 0;
    let mut check = |x: i32, y: i32, size: Size| {
        let area = Rectangle::new(Point::new(x, y), size);
        let count = u128::from(size.width) * u128::from(size.height);
        let expected: Vec<(u8, u8)> = (0..SIDE * SIDE)
            .map(|k| {
                let (dx, dy) = (i128::from(k % SIDE) - i128::from(x), i128::from(k / SIDE) - i128::from(y));
                let inside = dx >= 0 && dy >= 0 && dx < i128::from(size.width) && dy < i128::from(size.height);
                if inside { (numbered((dy * i128::from(size.width) + dx) as u128).luma(), 200) } else { (0, 0) }
            })
            .collect();
        drawn += expected.iter().filter(|e| e.0 > 0).count();
        let picture = |draw: &dyn Fn(&mut Scene<'_, zstrip::target::FrameSlice<'_, Gray8>>)| {
            whole::<Gray8>((SIDE as u16, SIDE as u16), Gray8::new(0), |scene| draw(scene)).0
        };
        let numbers: Vec<u8> = expected.iter().map(|e| e.0).collect();
        let solid: Vec<u8> = expected.iter().map(|e| e.1).collect();
        let name = format!("{area:?}");
        let contiguous = picture(&|scene| {
            let Ok(()) = scene.overlay().fill_contiguous(&area, Numbered { next: 0, count });
        });
        assert_eq!(contiguous, numbers, "fill_contiguous of {name}");
        let deep = picture(&|scene| {
            let Ok(()) = scene.at_depth(9).fill_contiguous(&area, Numbered { next: 0, count });
        });
        assert_eq!(deep, numbers, "fill_contiguous of {name} at a depth");
        let filled = picture(&|scene| {
            let Ok(()) = scene.overlay().fill_solid(&area, Gray8::new(200));
        });
        assert_eq!(filled, solid, "fill_solid of {name}");
        assert_eq!(picture(&|scene| scene.overlay().draw_image(&Huge(size), area.top_left)), numbers, "image {name}");
        let visible = solid.contains(&200);
        let seen = core::cell::Cell::new(false);
        picture(&|scene| seen.set(seen.get() | scene.overlay().is_visible(&area)));
        assert_eq!(seen.get(), visible, "is_visible {name}");
        let canvas = picture(&|scene| scene.canvas().rectangle(&area, Gray8::new(200)));
        assert_eq!(canvas, solid, "a canvas's rectangle {name}");
        let scissor = picture(&|scene| {
            let mut canvas = scene.canvas();
            canvas.set_scissor(Some(&area));
            canvas.rectangle(&Rectangle::new(Point::zero(), Size::new_equal(SIDE as u32)), Gray8::new(200));
        });
        assert_eq!(scissor, solid, "a canvas's scissor {name}");
    };
    for x in starts {
        for width in sizes {
            check(x, 1, Size::new(width, 2));
            check(1, x, Size::new(2, width));
            check(x, i32::MIN, Size::new(width, u32::MAX));
            check(i32::MIN, x, Size::new(u32::MAX, width));
        }
    }
    let mut rng = Rng::new(72);
    for _ in 0..900 {
        let mut side = || {
            let start = if rng.one_in(3) { rng.pick(&starts) } else { rng.any_magnitude(31) };
            // Often the end is near the screen.
            let size = if rng.one_in(3) {
                rng.next_u64() as u32
            } else {
                (rng.between(-2, 8) as i64 - i64::from(start)).clamp(0, u32::MAX.into()) as u32
            };
            (start, size)
        };
        let ((x, width), (y, height)) = (side(), side());
        check(x, y, Size::new(width, height));
    }
    assert!(drawn > 4000, "only {drawn} pixels were drawn");
}

#[test]
fn a_moved_pixel_beyond_32_bits_does_not_come_back_on_the_other_side() {
    /// Draws one pixel and one area at a place that, moved by the image's corner, is beyond 32 bits.
    struct Beyond(Point);
    impl OriginDimensions for Beyond {
        fn size(&self) -> Size {
            Size::new_equal(u32::MAX)
        }
    }
    impl ImageDrawable for Beyond {
        type Color = Gray8;
        fn draw<D: DrawTarget<Color = Gray8>>(&self, target: &mut D) -> Result<(), D::Error> {
            let area = Rectangle::new(self.0, Size::new_equal(2));
            target.draw_iter([Pixel(self.0, Gray8::WHITE)])?;
            target.fill_solid(&area, Gray8::WHITE)?;
            target.fill_contiguous(&area, [Gray8::WHITE; 4])
        }
        fn draw_sub_image<D: DrawTarget<Color = Gray8>>(&self, target: &mut D, _: &Rectangle) -> Result<(), D::Error> {
            self.draw(target)
        }
    }
    let end = Point::new(i32::MIN, i32::MIN);
    let (picture, ..) = whole::<Gray8>((4, 4), Gray8::new(0), |scene| scene.overlay().draw_image(&Beyond(end), end));
    assert_eq!(picture, [0; 16]);
}
