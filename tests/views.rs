//! A 3-D view as a rectangle among what other code draws.

use crate::reference::rng::Rng;
use crate::support::{Soup, strips};
use core::cell::Cell;
use core::convert::Infallible;
use embedded_graphics::framebuffer::{Framebuffer as Full, buffer_size};
use embedded_graphics::image::GetPixel;
use embedded_graphics::pixelcolor::raw::{LittleEndian, RawU16};
use embedded_graphics::pixelcolor::{Rgb565, WebColors};
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{Circle, PrimitiveStyle, Rectangle};
use zstrip::color::{PixelFormat, Rgb565Be};
use zstrip::frame::{FrameError, FrameView};
use zstrip::math::Projective;
use zstrip::mesh::Mesh;
use zstrip::shader::Gouraud;
use zstrip::{Cull, Framebuffer, Renderer, Scene, State};

const DISPLAY: (i32, i32) = (90, 60);
const VIEW: (u16, u16) = (40, 33);
type Display = Full<Rgb565, RawU16, LittleEndian, 90, 60, { buffer_size::<Rgb565>(90, 60) }>;

/// A display with something on it.
fn display() -> Display {
    let mut display = Display::new();
    let style = PrimitiveStyle::with_fill(Rgb565::CSS_SEA_GREEN);
    let Ok(()) = display.clear(Rgb565::CSS_BEIGE);
    let Ok(()) = Circle::new(Point::new(20, 5), 50).into_styled(style).draw(&mut display);
    display
}

fn draw<F: Framebuffer>(scene: &mut Scene<'_, F>, mesh: &Mesh<'_>)
where
    Gouraud: zstrip::span::Shader<F::Format>,
{
    let state = State { cull: Cull::None, ..State::DEFAULT };
    scene.draw_with(state, mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
}

/// The display must show the view at `at` and nothing new around it.
fn assert_pasted(shown: &Display, view: &[u16], at: Point, what: &str) {
    let before = display();
    for y in 0..DISPLAY.1 {
        for x in 0..DISPLAY.0 {
            let Point { x: dx, y: dy } = Point::new(x, y) - at;
            let inside = (0..i32::from(VIEW.0)).contains(&dx) && (0..i32::from(VIEW.1)).contains(&dy);
            let expected = if inside {
                Rgb565::to_color(view[(dy * i32::from(VIEW.0) + dx) as usize])
            } else {
                before.pixel(Point::new(x, y)).expect("a pixel")
            };
            assert_eq!(shown.pixel(Point::new(x, y)), Some(expected), "({x}, {y}), view at {at:?}, {what}");
        }
    }
}

fn soup() -> Soup {
    Soup::new(&mut Rng::new(11), 14)
}

const PLACES: [Point; 6] = [
    Point::zero(),
    Point::new(13, 9),
    Point::new(50, 27),
    Point::new(-15, -20),
    Point::new(70, 44),
    Point::new(200, 3),
];

#[test]
fn view_shows_the_frame_wherever_it_is() {
    let soup = soup();
    let mesh = soup.mesh();
    let (expected, _) = strips::<Rgb565>(VIEW, 33, 9_000, Rgb565::CSS_NAVY, |s| draw(s, &mesh));
    assert!(expected.iter().any(|p| *p != expected[0]), "an empty picture");
    for (rows, records) in [(33, 9_000), (8, 9_000), (5, 0)] {
        let (color, depth) = (&mut vec![0; 40 * rows], &mut vec![0; 40 * rows]);
        let renderer = Renderer::<Rgb565Be>::new(Size::new(VIEW.0.into(), VIEW.1.into()))
            .expect("a renderer")
            .with_depth(depth)
            .expect("a renderer");
        let mut records_of_view = vec![0; records];
        let mut renderer = renderer.with_records(&mut records_of_view);
        for at in PLACES {
            let what = format!("{rows} rows, {records} records");
            let mut shown = display();
            let stats =
                renderer.frame_at(&mut shown, at, color, Rgb565::CSS_NAVY, |s| draw(s, &mesh)).expect("a frame");
            assert_pasted(&shown, &expected, at, &format!("frame_at, {what}"));

            let view = FrameView::new(&mut renderer, color, at, Rgb565::CSS_NAVY, |s| draw(s, &mesh));
            assert_eq!(view.bounding_box(), Rectangle::new(at, Size::new(40, 33)));
            for again in 0..2 {
                let mut shown = display();
                let Ok(drawn) = view.draw(&mut shown);
                assert_eq!(drawn, Ok(stats));
                assert_pasted(&shown, &expected, at, &format!("a drawable, {what}, {again}"));
            }
            let mut shown = display();
            let Ok(_) = view.draw(&mut shown.translated(Point::new(5, -3)));
            assert_pasted(&shown, &expected, at + Point::new(5, -3), &format!("translated, {what}"));
        }
    }
}

#[test]
fn view_is_drawn_within_another_frame() {
    let soup = soup();
    let mesh = soup.mesh();
    let (expected, _) = strips::<Rgb565>(VIEW, 33, 9_000, Rgb565::CSS_NAVY, |s| draw(s, &mesh));
    for rows in [60, 7, 1] {
        for at in PLACES {
            let mut inner = (vec![0; 40 * 8], vec![0; 40 * 8], vec![0; 3000]);
            let color = &mut inner.0;
            let renderer = Renderer::<Rgb565>::new(Size::new(VIEW.0.into(), VIEW.1.into()))
                .expect("a renderer")
                .with_depth(&mut inner.1)
                .expect("a renderer");
            let mut renderer = renderer.with_records(&mut inner.2);
            let view = FrameView::new(&mut renderer, color, at, Rgb565::CSS_NAVY, |s| draw(s, &mesh));
            let shown = display();
            let (picture, _) = strips::<Rgb565>((90, 60), rows, 50, Rgb565::BLACK, |scene| {
                let all = shown.bounding_box();
                let Ok(()) = scene.overlay().fill_contiguous(&all, all.points().filter_map(|p| shown.pixel(p)));
                scene.overlay().draw(&view);
            });
            let mut found = Display::new();
            let all = found.bounding_box();
            let Ok(()) = found.fill_contiguous(&all, picture.iter().map(|p| Rgb565::to_color(*p)));
            assert_pasted(&found, &expected, at, &format!("in strips of {rows} rows"));
        }
    }
}

/// A display that fails after some strips.
struct Failing(u32);

impl OriginDimensions for Failing {
    fn size(&self) -> Size {
        Size::new(90, 60)
    }
}

impl DrawTarget for Failing {
    type Color = Rgb565;
    type Error = &'static str;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(&mut self, _: I) -> Result<(), Self::Error> {
        self.0 = self.0.checked_sub(1).ok_or("cut off")?;
        Ok(())
    }
}

#[test]
fn what_goes_wrong_in_a_view_is_told_and_the_next_frame_is_right() {
    let soup = soup();
    let mesh = soup.mesh();
    let (expected, _) = strips::<Rgb565>(VIEW, 33, 9_000, Rgb565::CSS_NAVY, |s| draw(s, &mesh));
    let (color, depth) = (&mut vec![0; 40 * 8], &mut vec![0; 40 * 8]);
    let renderer = Renderer::<Rgb565>::new(Size::new(VIEW.0.into(), VIEW.1.into()))
        .expect("a renderer")
        .with_depth(depth)
        .expect("a renderer");
    let mut records = vec![0; 9_000];
    let mut renderer = renderer.with_records(&mut records);
    let draws = Cell::new(0);
    let changing = Cell::new(false);
    let view = FrameView::new(&mut renderer, color, Point::zero(), Rgb565::CSS_NAVY, |s| {
        draws.set(draws.get() + 1);
        draw(s, &mesh);
        if changing.get() && draws.get() == 3 {
            draw(s, &mesh);
        }
    });
    assert_eq!(view.draw(&mut Failing(2)), Err("cut off"), "the display's own error");
    assert!(view.draw(&mut Failing(5)).is_ok_and(|drawn| drawn.is_ok()), "five strips are all there are");
    changing.set(true);
    draws.set(0);
    let found: Result<_, Infallible> = view.draw(&mut display());
    assert_eq!(found, Ok(Err(FrameError::SceneChanged { draw: 1 })), "a second draw in the third call");
    changing.set(false);
    let mut shown = display();
    let Ok(drawn) = view.draw(&mut shown);
    assert!(drawn.is_ok());
    assert_pasted(&shown, &expected, Point::zero(), "after all that");
}
