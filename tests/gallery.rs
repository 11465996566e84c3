//! The models of the examples: each is read and drawn, in strips as in one piece.

#[path = "../examples/models/mod.rs"]
mod models;

use crate::support::strips;
use models::{FLANGE, FLANGE_FACES, SPOT, Still, TEAPOT, Walker, Way};
use zstrip::Scene;
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::Rgb565;
use zstrip::math::{Angle16, Scalar, Vec3};
use zstrip::target::{Strip, WithDepth, WithRecords};

const SCREEN: (u16, u16) = (120, 120);
const SIZE: Size = Size::new(120, 120);

/// Draws a frame in strips of 16 rows and in one, and returns it, with the number of pixels that are drawn.
fn picture(
    name: &str,
    draw: impl Fn(&mut Scene<'_, Strip<'_, Rgb565, WithDepth, WithRecords>>),
) -> (Vec<<Rgb565 as PixelFormat>::Raw>, usize) {
    let (whole, _) = strips::<Rgb565>(SCREEN, 120, 0, models::BACKGROUND, &draw);
    for records in [0, 32 * 1024] {
        let (picture, _) = strips::<Rgb565>(SCREEN, 16, records, models::BACKGROUND, &draw);
        assert!(picture == whole, "{name}: strips with {records} words of records differ");
    }
    let drawn = whole.iter().filter(|pixel| **pixel != Rgb565::from_color(models::BACKGROUND)).count();
    (whole, drawn)
}

#[test]
fn still_models_are_drawn() {
    for (name, file) in [("spot", SPOT), ("teapot", TEAPOT), ("flange", FLANGE), ("flange_faces", FLANGE_FACES)] {
        let mut still = Still::new(file).expect(name);
        let placed = still.place(SIZE, Vec3::from_ints(0, 1, 3), Angle16::from_degrees(30)).expect(name);
        let (_, drawn) = picture(name, |scene| placed.draw(scene));
        assert!((1500..9000).contains(&drawn), "{name}: {drawn} pixels of {}", 120 * 120);
    }
}

#[test]
fn figure_moves_at_each_pace_and_in_time() {
    let mut walker = Walker::new(vec![0; Walker::WORDS].leak()).expect("a figure");
    let mut seen = Vec::new();
    for pace in [0.0, 0.5, 1.0, 1.5, 2.0] {
        let mut way = Way::at(Scalar::from_num(pace));
        for milliseconds in [0, 330] {
            way.advance(milliseconds);
            let walking = walker.place(SIZE, &way, Angle16::from_degrees(60)).expect("places");
            let (pixels, drawn) = picture("figure", |scene| walking.draw(scene));
            assert!((1000..6000).contains(&drawn), "pace {pace}: {drawn} pixels of {}", 120 * 120);
            assert!(!seen.contains(&pixels), "pace {pace} after {milliseconds} ms looks like another frame");
            seen.push(pixels);
        }
    }
}

#[test]
fn way_does_not_depend_on_the_number_of_frames() {
    for (pace, steps) in [(0.0, 1.0), (1.0, 1.0), (1.5, 1.214), (2.0, 1.429)] {
        let way = Way::at(Scalar::from_num(pace));
        let [mut one, mut many] = [way; 2];
        one.advance(400);
        (0..25).for_each(|_| many.advance(16));
        let part = |way: &Way| f64::from(way.phase()) / f64::from(1 << 16) / f64::from(1 << 16);
        assert!((part(&one) - 0.4 * steps).abs() < 1e-3, "pace {pace}: {} of two steps", part(&one));
        assert!((part(&one) - part(&many)).abs() < 1e-3, "pace {pace}: {} and {}", part(&one), part(&many));
    }
}
