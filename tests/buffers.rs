//! Colour buffers are the caller's: strips of any length in buffers of any length, errors that lose nothing, frames
//! that are given up.

use crate::reference::rng::Rng;
use crate::scenes::{Draw, Room};
use crate::support::{Soup, difference, strips};
use core::cell::RefCell;
use zstrip::color::Rgb565Be;
use zstrip::embedded_graphics_core::Pixel;
use zstrip::embedded_graphics_core::draw_target::DrawTarget;
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor, WebColors};
use zstrip::embedded_graphics_core::primitives::{PointsIter, Rectangle};
use zstrip::frame::{Frame, FrameError, FramebufferRenderer, RamBudget, Renderer};
use zstrip::math::{Angle16, Pixels, Projective};
use zstrip::shader::Gouraud;
use zstrip::target::{DepthChoice, Depthless, FrameSlice, RecordsChoice, WithDepth, WithRecords};
use zstrip::vertex::Viewport;
use zstrip::{Cull, Framebuffer, Scene, ScreenPoint, Smooth, State, Thick, Thin};

const SCREEN: (u16, u16) = (80, 60);
const SIZE: Size = Size::new(80, 60);
const WIDTH: usize = 80;
const RECORDS: [usize; 3] = [0, 700, 40_000];

fn room(scene: &mut Scene<'_, impl Framebuffer<Format = Rgb565>>, turn: Angle16) {
    Room::new(SIZE, turn).draw(scene);
}

fn expected(turn: Angle16) -> Vec<u16> {
    strips::<Rgb565>(SCREEN, 60, 40_000, Rgb565::CSS_NAVY, |scene| room(scene, turn)).0
}

/// Calls `test` with a renderer whose depth buffer holds `rows` rows, for each number of records.
fn with_renderers(rows: usize, mut test: impl FnMut(&mut Renderer<'_, Rgb565, WithDepth, WithRecords>, &str)) {
    for records in RECORDS {
        let (mut depth, mut words) = (vec![9; WIDTH * rows], vec![9; records]);
        let renderer = Renderer::new(SIZE).expect("a renderer").with_depth(&mut depth).expect("a row");
        test(&mut renderer.with_records(&mut words), &format!("{records} records"));
    }
}

/// The rest of a frame, each strip in a buffer of old pixels with `spare` more than the first one.
fn rest<D: DepthChoice, R: RecordsChoice>(
    frame: &mut Frame<'_, '_, Rgb565, D, R>,
    rows: usize,
    spare: usize,
    turn: Angle16,
) -> Vec<u16> {
    let mut picture = Vec::new();
    let mut next_row = None;
    let mut buffer = vec![0x5A5A; WIDTH * rows + spare];
    while let Some(strip) = frame.next_strip(&mut buffer, |scene| room(scene, turn)).expect("a strip") {
        let area = strip.area();
        assert_eq!((area.top_left.x, area.top_left.y), (0, next_row.unwrap_or(area.top_left.y)));
        next_row = Some(area.top_left.y + area.size.height as i32);
        assert_eq!(strip.pixels().len(), (area.size.width * area.size.height) as usize);
        let length = strip.bytes().len();
        assert_eq!(strip.colors().count() * 2, length);
        picture.extend_from_slice(strip.into_pixels());
    }
    picture
}

#[test]
fn last_strip_has_exactly_its_rows() {
    for rows in [1, 7, 16, 59, 60] {
        with_renderers(rows, |renderer, what| {
            let mut buffer = vec![0x5A5A; WIDTH * rows];
            let mut frame = renderer.begin(Rgb565::CSS_NAVY);
            let mut heights = Vec::new();
            while let Some(strip) = frame.next_strip(&mut buffer, |scene| room(scene, Angle16(0))).expect("a strip") {
                let height = strip.area().size.height as usize;
                assert_eq!(strip.into_bytes().len(), WIDTH * height * 2);
                heights.push(height);
            }
            let (last, whole) = heights.split_last().expect("a strip");
            assert!(whole.iter().all(|height| *height == rows), "{what}: {heights:?}");
            assert_eq!(*last, 60 - rows * whole.len(), "{what}");
        });
    }
}

#[test]
fn buffer_that_is_handed_over_comes_back_for_as_long_as_it_was_lent() {
    let (a, b): (&'static mut [u16], &'static mut [u16]) = (vec![1; WIDTH * 16].leak(), vec![2; WIDTH * 16].leak());
    let mut renderer = Renderer::<Rgb565>::new(SIZE).expect("a renderer");
    let mut frame = renderer.begin(Rgb888::RED);
    let sent = frame.next_strip(a, |_| ()).expect("a strip").expect("one of four");
    let drawn = frame.next_strip(b, |_| ()).expect("a strip").expect("one of four");
    let pixels: &'static mut [u16] = sent.into_pixels();
    let bytes: &'static mut [u8] = drawn.into_bytes();
    assert_eq!((pixels.len(), bytes.len()), (WIDTH * 16, WIDTH * 16 * 2));
    assert!(pixels.iter().all(|pixel| *pixel == 0xF800));
    assert!(bytes.chunks(2).all(|pixel| *pixel == 0xF800_u16.to_ne_bytes()));
}

/// The loop of a program with DMA: the buffer that is free is lent, and moves into the transfer when the strip is
/// drawn.
#[test]
fn static_buffers_outlast_frames_whether_they_end_or_fail() {
    const ROWS: usize = RamBudget::even_rows(60, 16) as usize;
    let (mut free, mut busy): (&'static mut [u16], &'static mut [u16]) =
        (vec![1; WIDTH * ROWS].leak(), vec![2; WIDTH * ROWS].leak());
    with_renderers(ROWS, |renderer, what| {
        for turn in [0, 1000, 2000].map(Angle16) {
            let mut frame = renderer.begin(Rgb565::CSS_NAVY);
            let mut picture = Vec::new();
            let mut calls = 0;
            let error = loop {
                let drawn = frame.next_strip(&mut *free, |scene| {
                    calls += 1;
                    room(scene, if turn == Angle16(1000) && calls == 3 { Angle16(7) } else { turn });
                });
                match drawn {
                    Ok(Some(_)) => core::mem::swap(&mut free, &mut busy),
                    Ok(None) => break None,
                    Err(error) => break Some(error),
                }
                // What is sent is a whole buffer.
                picture.extend_from_slice(busy);
            };
            assert_eq!((free.len(), busy.len()), (WIDTH * ROWS, WIDTH * ROWS));
            match error {
                // Without records each call stands for itself, and no change is seen.
                None if turn == Angle16(1000) => assert!(what.starts_with("0 "), "{what}"),
                None => assert_eq!(difference(&picture, &expected(turn), 80), None, "{what}, {turn:?}"),
                Some(error) => assert_eq!(error, FrameError::SceneChanged { draw: 0 }, "{what}, {turn:?}"),
            }
        }
    });
}

#[test]
fn buffers_of_different_lengths_hold_the_same_frame() {
    // The first one decides the height; longer ones do not change it, and the last strip needs no more than its own
    // rows.
    with_renderers(16, |renderer, what| {
        let mut frame = renderer.begin(Rgb565::CSS_NAVY);
        let mut picture = Vec::new();
        for (k, length) in [WIDTH * 7 + 79, WIDTH * 60, WIDTH * 7].into_iter().cycle().take(8).enumerate() {
            let mut buffer = vec![0x5A5A; length];
            let strip = frame.next_strip(&mut buffer, |scene| room(scene, Angle16(0)));
            let strip = strip.expect("a strip").expect("one of nine");
            assert_eq!(strip.area().size.height, 7, "{what}, strip {k}");
            picture.extend_from_slice(strip.pixels());
            assert!(buffer[WIDTH * 7..].iter().all(|pixel| *pixel == 0x5A5A), "{what}: written behind the strip");
        }
        let mut buffer = [0x5A5A; WIDTH * 4];
        let strip = frame.next_strip(&mut buffer, |scene| room(scene, Angle16(0)));
        picture.extend_from_slice(strip.expect("a strip").expect("the last one").pixels());
        assert_eq!(difference(&picture, &expected(Angle16(0)), 80), None, "{what}");
        assert!(frame.next_strip(&mut [], |_| panic!("called")).expect("no error").is_none());

        // The next frame has strips of another height: that of its own first buffer, or of the depth buffer.
        for (rows, height) in [(3, 3), (60, 16), (12, 12)] {
            let mut frame = renderer.begin(Rgb565::CSS_NAVY);
            let found = rest(&mut frame, rows, 0, Angle16(9));
            assert_eq!(frame.stats().strips as usize, 60_usize.div_ceil(height), "{what}");
            assert_eq!(difference(&found, &expected(Angle16(9)), 80), None, "{what}, {rows} rows");
        }
    });
}

#[test]
fn short_buffers_are_refused_and_nothing_is_lost() {
    with_renderers(16, |renderer, what| {
        let mut frame = renderer.begin(Rgb565::CSS_NAVY);
        for pixels in [0, 1, WIDTH - 1] {
            let error = frame.next_strip(&mut vec![0; pixels], |_| panic!("called")).expect_err("not one row");
            assert_eq!(error, FrameError::BufferTooShort { pixels, needed: WIDTH }, "{what}");
            assert_eq!(error.to_string(), format!("colour buffer of {pixels} pixels, 80 are needed"));
        }
        let mut buffer = vec![0; WIDTH * 16];
        let strip = frame.next_strip(&mut buffer, |scene| room(scene, Angle16(0)));
        let mut picture = strip.expect("a strip").expect("one of four").into_pixels().to_vec();
        for pixels in [0, WIDTH, WIDTH * 16 - 1] {
            let error = frame.next_strip(&mut vec![0; pixels], |_| panic!("called")).expect_err("shorter than a strip");
            assert_eq!(error, FrameError::BufferTooShort { pixels, needed: WIDTH * 16 }, "{what}");
        }
        picture.extend(rest(&mut frame, 16, 3, Angle16(0)));
        assert_eq!(frame.stats().strips, 4);
        assert_eq!(difference(&picture, &expected(Angle16(0)), 80), None, "{what}");
    });
    // The loops of the renderer's own hand the error on.
    let mut renderer = Renderer::<Rgb565>::new(SIZE).expect("a renderer");
    let sink = |_: &zstrip::target::StripPixels<'_, Rgb565>| Err("called");
    let error = renderer.frame_to(sink, &mut [0; WIDTH - 1], Rgb888::BLACK, |_| panic!("called"));
    assert_eq!(error, Err(FrameError::BufferTooShort { pixels: WIDTH - 1, needed: WIDTH }));
}

#[test]
fn frame_that_is_given_up_leaves_no_trace_in_the_next() {
    for given_up_after in 0..5 {
        with_renderers(16, |renderer, what| {
            let mut buffer = vec![0; WIDTH * 16];
            let mut frame = renderer.begin(Rgb565::RED);
            for _ in 0..given_up_after {
                frame.next_strip(&mut buffer, |scene| room(scene, Angle16(300))).expect("a strip");
            }
            // Strips of another height, so that no band of the old frame fits.
            let found = rest(&mut renderer.begin(Rgb565::CSS_NAVY), 9, 0, Angle16(0));
            assert_eq!(difference(&found, &expected(Angle16(0)), 80), None, "{what}, after {given_up_after} strips");
        });
    }
}

#[test]
fn frame_after_an_error_is_like_any_other() {
    with_renderers(16, |renderer, what| {
        let mut buffer = vec![0; WIDTH * 16];
        let mut frame = renderer.begin(Rgb565::RED);
        let mut calls = 0;
        let error = loop {
            let drawn = frame.next_strip(&mut buffer, |scene| {
                calls += 1;
                room(scene, Angle16(300 * u16::from(calls < 4)));
            });
            match drawn {
                Ok(Some(_)) => {}
                Ok(None) => break None,
                Err(error) => break Some(error),
            }
        };
        // Without records each call stands for itself, and no change is seen.
        if !what.starts_with("0 ") {
            assert_eq!(error, Some(FrameError::SceneChanged { draw: 0 }), "{what}");
        }
        assert!(frame.next_strip(&mut buffer, |_| panic!("called")).expect("no error").is_none(), "{what}");
        let found = rest(&mut renderer.begin(Rgb565::CSS_NAVY), 16, 0, Angle16(0));
        assert_eq!(difference(&found, &expected(Angle16(0)), 80), None, "{what}");
    });
}

#[test]
fn background_of_any_colour_type_is_that_of_the_format() {
    let mut renderer = Renderer::<Rgb565Be>::new(Size::new(2, 1)).expect("a renderer");
    let mut pixels = |background: Rgb888| {
        let mut buffer = [0; 2];
        let mut frame = renderer.begin(background);
        frame.next_strip(&mut buffer, |_| ()).expect("a strip").expect("the only one").pixels().to_vec()
    };
    assert_eq!(pixels(Rgb888::new(0xFF, 0x07, 0x08)), [0xF821_u16.to_be(); 2]);
    // Every colour of 5 or 6 bits a channel comes back from 8 bits as it was.
    for value in 0..=u16::MAX {
        let color = Rgb565::from(zstrip::embedded_graphics_core::pixelcolor::raw::RawU16::new(value));
        let [r, g, b] = [Rgb888::from(color).r(), Rgb888::from(color).g(), Rgb888::from(color).b()];
        assert_eq!(<Rgb565 as zstrip::color::PixelFormat>::pack([r, g, b]), value);
    }
}

#[test]
fn framebuffer_is_drawn_over_or_cleared() {
    let mut renderer = FramebufferRenderer::new(Size::new(4, 2)).expect("a renderer");
    let mut pixels = [7; 8];
    fn slice(pixels: &mut [u16]) -> Depthless<FrameSlice<'_, Rgb565>> {
        Depthless(FrameSlice::new(pixels, Size::new(4, 2)).expect("a framebuffer"))
    }
    renderer.frame_over(&mut slice(&mut pixels), |_| ()).expect("a frame");
    assert_eq!(pixels, [7; 8]);
    renderer.frame(&mut slice(&mut pixels), Rgb888::WHITE, |_| ()).expect("a frame");
    assert_eq!(pixels, [0xFFFF; 8]);
}

#[test]
fn even_rows_divide_the_height_and_no_more_do() {
    for height in 1..=240 {
        for most in 1..=250 {
            let rows = RamBudget::even_rows(height, most);
            assert!(rows <= most && height % rows == 0, "{height} rows, at most {most}: {rows}");
            assert!(
                (rows + 1..=most.min(height)).all(|more| height % more != 0),
                "{height} rows, at most {most}: {rows}"
            );
        }
    }
    assert_eq!([RamBudget::even_rows(0, 9), RamBudget::even_rows(9, 0)], [0, 0]);
}

/// A framebuffer of one's own, with rows of different lengths, and fewer of them than the screen has.
struct Ragged(Vec<Vec<u16>>);

impl Framebuffer for Ragged {
    type Format = Rgb565;

    fn row(&mut self, y: u32) -> &mut [u16] {
        self.0.get_mut(y as usize).map(Vec::as_mut_slice).unwrap_or_default()
    }
}

/// Draws the room, lines of each stroke, shapes, and what embedded-graphics draws.
fn everything<F: Framebuffer<Format = Rgb565>>(scene: &mut Scene<'_, F>) {
    room(scene, Angle16::from_degrees(30));
    let mut canvas = scene.canvas();
    let (a, b) = (ScreenPoint::center(-5, 3), ScreenPoint::center(90, 55));
    canvas.line(a, b, Rgb888::CSS_LIME);
    canvas.line_with(b, ScreenPoint::center(3, 50), Rgb888::CSS_GOLD, &Thick::px(4));
    canvas.line_with(ScreenPoint::center(70, 2), a, Rgb888::CSS_PINK, &Smooth::px(3));
    canvas.point(ScreenPoint::corner(60, 40), zstrip::math::Pixels::from_num(30), Rgb888::CSS_TEAL);
    canvas.polygon(&[a, b, ScreenPoint::center(79, 0)], Rgb888::CSS_PURPLE);
    let all = Rectangle::new(Point::new(20, 20), Size::new(70, 9));
    let Ok(()) = scene.overlay().fill_solid(&all, Rgb565::CSS_TOMATO);
    let Ok(()) = scene.at_depth(7).fill_contiguous(
        &Rectangle::new(Point::new(30, 35), Size::new(50, 25)),
        (0..1250).map(|k: u16| Rgb565::new(k as u8 & 31, 9, 1)),
    );
    let Ok(()) = scene.overlay().draw_iter(all.points().map(|at| Pixel(at + Point::new(0, 30), Rgb565::CSS_TAN)));
}

#[expect(clippy::redundant_closure, reason = "the function itself is not general enough")]
#[test]
fn rows_that_are_shorter_than_the_screen_get_their_own_pixels_and_no_others() {
    let expected = strips::<Rgb565>(SCREEN, 60, 40_000, Rgb565::CSS_NAVY, |scene| everything(scene)).0;
    let mut rng = Rng::new(51);
    for rows in [1, 7, 60] {
        for case in 0..8 {
            let height = rng.between(1, 64) as usize;
            let narrow = rng.between(1, 80) as usize;
            // Every fourth framebuffer has one width; others have rows of any length, some longer than the screen.
            let length = |rng: &mut Rng| if case % 4 == 0 { narrow } else { rng.between(0, 90) as usize };
            let mut ragged = Ragged((0..height).map(|_| vec![0x5A5A; length(&mut rng)]).collect());
            let (mut depth, mut words) = (vec![9; WIDTH * rows], vec![9; 700]);
            let renderer = FramebufferRenderer::new(SIZE).expect("a renderer").with_depth(&mut depth).expect("a row");
            let mut renderer = renderer.with_records(&mut words);
            renderer.frame(&mut ragged, Rgb888::CSS_NAVY, |scene| everything(scene)).expect("a frame");
            for (y, row) in ragged.0.iter().enumerate() {
                for (x, pixel) in row.iter().enumerate() {
                    let inside = x < WIDTH && y < usize::from(SCREEN.1);
                    let right = if inside { expected[y * WIDTH + x] } else { 0x5A5A };
                    assert_eq!(*pixel, right, "seed {}: ({x}, {y}), case {case}, {rows} rows", rng.seed());
                }
            }
        }
    }
}

/// A framebuffer whose rows do not lie one after the other. It notes which of them are asked for.
struct Watched<'l> {
    pixels: Vec<u16>,
    asked: &'l RefCell<Vec<u32>>,
}

impl Framebuffer for Watched<'_> {
    type Format = Rgb565;

    fn row(&mut self, y: u32) -> &mut [u16] {
        self.asked.borrow_mut().push(y);
        self.pixels.chunks_mut(WIDTH).nth(y as usize).unwrap_or_default()
    }
}

/// Draws thick lines with gradients, polygons and meshes that reach beyond the screen on all sides, and `everything`.
fn beyond<F: Framebuffer<Format = Rgb565>>(scene: &mut Scene<'_, F>, rng: &mut Rng) {
    everything(scene);
    let ends: Vec<_> = (0..40).map(|_| [rng.between(-30, 110), rng.between(-30, 90)].map(|v| v as i16)).collect();
    let ends = || ends.iter().map(|[x, y]| ScreenPoint::center(*x, *y));
    let colors = [Rgb888::CSS_ORANGE, Rgb888::CSS_INDIGO, Rgb888::CSS_AZURE];
    let mut canvas = scene.canvas();
    for (from, to) in ends().zip(ends().skip(1)) {
        canvas.gradient_line((from, colors[0]), (to, colors[1]), &Thick::px(7));
        canvas.gradient_line((to, colors[1]), (from, colors[2]), &Smooth::px(4));
        canvas.gradient_line((to, colors[1]), (from, colors[2]), &Thin);
        // Short ones.
        let near = |offset| Pixels::from_num(0.8 * f64::from(offset));
        let beside = ScreenPoint::new(from.x() + near(5), from.y() + near(4));
        canvas.gradient_line((from, colors[0]), (beside, colors[1]), &Thick::px(3));
        let below = ScreenPoint::new(from.x() - near(4), from.y() + near(9));
        canvas.gradient(&[(from, colors[0]), (beside, colors[1]), (below, colors[2])]);
        canvas.polygon(&[from, below, beside], colors[1]);
    }
    let corners: Vec<_> = ends().zip(colors.into_iter().cycle()).collect();
    canvas.set_scissor(Some(&Rectangle::new(Point::new(-9, 22), Size::new(60, 23))));
    corners.windows(3).for_each(|corners| canvas.gradient(corners));
    let soup = Soup::new(&mut rng.clone(), 60);
    scene.draw_with(State { cull: Cull::None, ..State::DEFAULT }, &soup.mesh(), &Projective::IDENTITY, &{
        Gouraud::vertex_colors()
    });
    scene.set_viewport(Viewport::new(Point::new(5, 31), Size::new(40, 20)).expect("a viewport"));
    room(scene, Angle16::from_degrees(200));
}

/// Rows that are not in the strip, or not on the screen, need not be there: a framebuffer may read them from elsewhere.
#[test]
fn rows_that_are_not_on_the_screen_are_not_asked_for() {
    let asked = RefCell::new(Vec::new());
    let mut rng = Rng::new(76);
    for records in [0, 700, 40_000] {
        for rows in [1, 7, 60] {
            let (mut depth, mut words) = (vec![9; WIDTH * rows], vec![9; records]);
            let renderer = FramebufferRenderer::new(SIZE).expect("a renderer").with_depth(&mut depth).expect("a row");
            let mut renderer = renderer.with_records(&mut words);
            let mut framebuffer = Watched { pixels: vec![0; WIDTH * 60], asked: &asked };
            let scene_rng = rng.clone();
            let (mut calls, what) = (0, format!("seed {}: {records} records, {rows} rows", rng.seed()));
            let draw = |scene: &mut Scene<'_, Watched<'_>>| {
                asked.borrow_mut().clear();
                beyond(scene, &mut scene_rng.clone());
                let asked = asked.borrow();
                let strip = |y: &u32| y / rows as u32;
                let (first, last) = (asked.iter().min(), asked.iter().max());
                assert!(last.is_none_or(|y| *y < 60), "{what}: row {last:?} of 60");
                assert_eq!(first.map(strip), last.map(strip), "{what}: rows {first:?} to {last:?}");
                calls += u32::from(first.is_some());
            };
            renderer.frame(&mut framebuffer, Rgb888::CSS_NAVY, draw).expect("a frame");
            assert_eq!(calls as usize, 60_usize.div_ceil(rows), "{what}");
            let expected = strips::<Rgb565>(SCREEN, 60, 40_000, Rgb565::CSS_NAVY, |scene| {
                beyond(scene, &mut scene_rng.clone());
            });
            assert_eq!(difference(&framebuffer.pixels, &expected.0, SCREEN.0), None, "{what}");
            rng.next_u64();
        }
    }
}
