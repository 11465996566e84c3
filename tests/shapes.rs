//! Shapes with smooth edges: the covered part of each pixel against exact areas, strips, memory, and all that is
//! degenerate.

mod reference;
mod support;

use reference::rng::Rng;
use support::area::{Contour, areas, compare};
use support::{difference, strips, whole};
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565, Rgb888, RgbColor};
use zstrip::embedded_graphics_core::primitives::Rectangle;
use zstrip::math::Pixels;
use zstrip::scene::{Outline, ShapeBuffer};
use zstrip::shape::{FillRule, Path};
use zstrip::span::DepthState;
use zstrip::target::Framebuffer;
use zstrip::{Scene, ScreenPoint};

const SCREEN: (u16, u16) = (64, 48);

/// Bound of the error of a covered part.
const BOUND: f64 = 1.0 / 128.0;

type Bits = [i32; 2];

fn points(contours: &[Vec<Bits>]) -> Vec<Vec<ScreenPoint>> {
    let point = |p: &Bits| ScreenPoint::new(Pixels::from_bits(p[0]), Pixels::from_bits(p[1]));
    contours.iter().map(|contour| contour.iter().map(point).collect()).collect()
}

fn in_pixels(contours: &[Vec<Bits>]) -> Vec<Contour> {
    contours.iter().map(|contour| contour.iter().map(|p| p.map(|c| f64::from(c) / 256.0)).collect()).collect()
}

/// A picture of the covered parts, white on black.
fn drawn(shape: &impl Outline, edges: usize, width: u16) -> Vec<u8> {
    let mut words = vec![0xDEAD_BEEF; ShapeBuffer::words(width, edges)];
    let mut buffer = ShapeBuffer::new(&mut words, width).expect("enough words");
    whole::<Gray8>(SCREEN, Gray8::new(0), |scene| scene.canvas().fill(shape, Rgb888::WHITE, &mut buffer)).0
}

/// Random contours of one of many kinds.
fn contours(rng: &mut Rng) -> Vec<Vec<Bits>> {
    let any = |rng: &mut Rng| [rng.between(-2000, 18_000), rng.between(-2000, 14_000)];
    let kind = rng.below(9);
    let count = 1 + rng.below(3) as usize;
    (0..count)
        .map(|_| {
            let corners = match kind {
                0 => 3,
                1 => 4,
                2 => 3 + rng.below(20) as usize,
                _ => 3 + rng.below(6) as usize,
            };
            let middle = any(rng);
            let mut corner = || match kind {
                // On a grid, so that edges and corners coincide.
                3 => any(rng).map(|c| c / 128 * 128),
                4 => any(rng).map(|c| c / 1024 * 1024),
                // In few pixels.
                5 => middle.map(|c| c + rng.between(-300, 300)),
                // Flat.
                6 => [rng.between(-2000, 18_000), middle[1] + rng.between(-90, 90)],
                // Steep.
                7 => [middle[0] + rng.between(-90, 90), rng.between(-2000, 14_000)],
                // Far off.
                8 => [rng.between(-9_000_000, 9_000_000), rng.between(-9_000_000, 9_000_000)],
                _ => any(rng),
            };
            (0..corners).map(|_| corner()).collect()
        })
        .collect()
}

#[test]
fn covered_parts_are_exact_areas() {
    let mut rng = Rng::new(1);
    let (mut worst, mut sum, mut count) = ([0_f64; 2], 0.0, 0);
    for case in 0..200 {
        let bits = contours(&mut rng);
        let points = points(&bits);
        let slices: Vec<_> = points.iter().map(Vec::as_slice).collect();
        let exact = [false, true].map(|even_odd| areas(&in_pixels(&bits), even_odd, (64, 48)));
        // With room for all edges, and for very few of them.
        for (k, edges) in [200, 4 + rng.below(6) as usize].into_iter().enumerate() {
            for (rule, exact) in [FillRule::NonZero, FillRule::EvenOdd].into_iter().zip(&exact) {
                let found = drawn(&Path::new(&slices).with_rule(rule), edges, 64);
                let (error, mean, at) = compare(&found, exact);
                assert!(
                    error <= BOUND,
                    "case {case}, {rule:?}, {edges} edges: pixel ({}, {}) is {}, exactly {}: {bits:?}",
                    at % 64,
                    at / 64,
                    f64::from(found[at]) / 255.0,
                    exact[at]
                );
                worst[k] = worst[k].max(error);
                (sum, count) = (sum + mean, count + 1);
            }
        }
    }
    println!(
        "worst error 1/{:.0}, with few edges 1/{:.0}; mean 1/{:.0}",
        1.0 / worst[0],
        1.0 / worst[1],
        f64::from(count) / sum
    );
}

/// Some of all kinds of paths, with all kinds of memory.
fn draw_any<F: Framebuffer>(scene: &mut Scene<'_, F>, seed: u64, words: &mut [u32]) {
    let rng = &mut Rng::new(seed);
    let mut buffer = ShapeBuffer::new(words, 64).expect("enough words");
    let mut canvas = scene.canvas();
    for _ in 0..20 {
        let points = points(&contours(rng));
        let slices: Vec<_> = points.iter().map(Vec::as_slice).collect();
        let [r, g, b] = [(); 3].map(|()| rng.below(256) as u8);
        canvas.fill(
            &Path::new(&slices).with_rule(rng.pick(&[FillRule::NonZero, FillRule::EvenOdd])),
            Rgb888::new(r, g, b),
            &mut buffer,
        );
        if rng.one_in(4) {
            let corner = Point::new(rng.between(-20, 60), rng.between(-20, 60));
            let area = Rectangle::new(corner, Size::new(rng.below(40) as u32, rng.below(40) as u32));
            canvas.set_scissor((!rng.one_in(3)).then_some(&area));
        }
        canvas.set_depth(rng.next_u64() as u16, rng.pick(&[DepthState::LESS, DepthState::OFF, DepthState::LESS_EQUAL]));
    }
}

#[test]
fn strips_do_not_matter() {
    for seed in 0..16 {
        for edges in [5, 100] {
            let mut words = vec![0; ShapeBuffer::words(64, edges)];
            let (expected, ..) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| draw_any(scene, seed, &mut words));
            assert!(expected.iter().any(|pixel| *pixel != 0));
            for (rows, records) in [(1, 0), (7, 100), (16, 0), (48, 100)] {
                let (picture, _) =
                    strips::<Rgb565>(SCREEN, rows, records, Rgb565::BLACK, |scene| draw_any(scene, seed, &mut words));
                assert_eq!(difference(&picture, &expected, SCREEN.0), None, "seed {seed}, {rows} rows");
            }
        }
    }
}
