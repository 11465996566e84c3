//! Blending, discarding and fog against exact formulas.

use crate::support;
use crate::support::{difference, strips, whole};
use zstrip::color::{PixelFormat, Rgb565Be, Rgba8888};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565, Rgb888, RgbColor, WebColors};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
use zstrip::shader::{
    Add, AddAlpha, Alpha, AlphaTest, Blend, BlendMode, Flat, FogCurve, FogTable, Fogged, Gouraud, Multiply, Opacity,
    Replace, ScreenDoor, Textured,
};
use zstrip::span::{DepthState, Fragment, Shader};
use zstrip::texture::{Image, Rgb888Texel, WithAlpha};
use zstrip::vertex::{VertexRef, VertexShader};
use zstrip::{Cull, State};

#[test]
fn alpha_additive_and_multiply_round_exactly_for_all_values() {
    for s in 0..=255_u8 {
        for t in 0..=255_u8 {
            let there = [t; 3];
            for alpha in 0..=255_u8 {
                let source = [s, s, s, alpha];
                let [a, s, t] = [u32::from(alpha), u32::from(s), u32::from(t)];
                // To nearest: twice the numerator plus the divisor over twice the divisor.
                let nearest = |n: u32| ((2 * n + 255) / 510) as u8;
                let blended: [u8; 3] = BlendMode::<Rgb888>::blend(&Alpha, source, there);
                assert_eq!(blended, [nearest(s * a + t * (255 - a)); 3], "{source:?} over {there:?}");
                let added: [u8; 3] = BlendMode::<Rgb888>::blend(&AddAlpha, source, there);
                assert_eq!(added, [nearest(s * a).saturating_add(t as u8); 3], "{source:?} and {there:?}");
            }
            let (a, b) = (u32::from(s), u32::from(t));
            let multiplied: [u8; 3] = BlendMode::<Rgb888>::blend(&Multiply, [s, s, s, 7], there);
            assert_eq!(multiplied, [((2 * a * b + 255) / 510) as u8; 3]);
            assert_eq!(BlendMode::<Rgb888>::blend(&Add, [s; 3], there), [s.saturating_add(t); 3]);
            assert_eq!(BlendMode::<Rgb888>::blend(&Replace, [s; 3], there), [s; 3]);
        }
    }
}

/// All pairs of values of a channel of 565, in all three channels at once.
fn pairs() -> impl Iterator<Item = (u16, u16)> {
    (0..64 * 64_u16).map(|k| {
        let (a, b) = (k / 64, k % 64);
        let all = |v: u16| (v & 31) << 11 | v << 5 | (v.reverse_bits() >> 11);
        (all(a), all(b))
    })
}

fn parts(raw: u16) -> [u32; 3] {
    [raw >> 11, raw >> 5 & 63, raw & 31].map(u32::from)
}

#[test]
fn pixels_of_565_mix_and_add_as_their_channels_would_for_all_values() {
    let mut worst = 0.0_f64;
    for (a, b) in pairs() {
        for weight in 0..=256_u32 {
            let mixed = parts(Rgb565::mix(a, b, weight));
            let thirty_seconds = (weight + 4) / 8;
            for ((m, a), b) in mixed.into_iter().zip(parts(a)).zip(parts(b)) {
                assert_eq!(m, (a * thirty_seconds + b * (32 - thirty_seconds) + 16) / 32, "{a}, {b}, {weight}");
                let exact = (f64::from(a) * f64::from(weight) + f64::from(b) * f64::from(256 - weight)) / 256.0;
                worst = worst.max((f64::from(m) - exact).abs());
            }
            assert_eq!(Rgb565Be::mix(a.to_be(), b.to_be(), weight), Rgb565::mix(a, b, weight).to_be());
        }
        let full = [31, 63, 31];
        let sum = parts(Rgb565::add(a, b));
        for (((s, a), b), full) in sum.into_iter().zip(parts(a)).zip(parts(b)).zip(full) {
            assert_eq!(s, (a + b).min(full));
        }
        assert_eq!(Rgb565Be::add(a.to_be(), b.to_be()), Rgb565::add(a, b).to_be());
    }
    println!("mixtures of RGB565 are within {worst:.3} steps of a channel of the exact ones");
    assert!(worst < 1.5, "{worst}");
    support::accuracy::check("mixture of two colours in RGB565", worst);
}

#[test]
fn pixels_of_eight_bits_mix_to_nearest_for_all_values() {
    for a in 0..=255_u8 {
        for b in 0..=255_u8 {
            for weight in 0..=256_u32 {
                let exact = ((u32::from(a) * weight + u32::from(b) * (256 - weight) + 128) / 256) as u8;
                assert_eq!(Rgb888::mix([a; 3], [b; 3], weight), [exact; 3]);
                assert_eq!(Rgba8888::mix([a, a, a, 9], [b, b, b, 200], weight), [exact, exact, exact, 9]);
            }
            assert_eq!(Rgb888::add([a; 3], [b; 3]), [a.saturating_add(b); 3]);
            assert_eq!(Gray8::add(a, b), a.saturating_add(b));
        }
    }
}

#[test]
fn an_opacity_of_nothing_and_of_all_changes_nothing_and_all() {
    for (a, b) in pairs() {
        assert_eq!(BlendMode::<Rgb565>::blend(&Opacity(255), a, b), a);
        assert_eq!(BlendMode::<Rgb565>::blend(&Opacity(0), a, b), b);
    }
    assert_eq!(BlendMode::<Rgb888>::blend(&Opacity(255), [1, 2, 250], [9, 8, 7]), [1, 2, 250]);
    assert_eq!(BlendMode::<Rgb888>::blend(&Opacity(0), [1, 2, 250], [9, 8, 7]), [9, 8, 7]);
}

const SCREEN: (u16, u16) = (40, 24);

static CORNERS: [Vec3; 4] = [
    Vec3::from_milli(-1000, -1000, 250),
    Vec3::from_milli(1000, -1000, 250),
    Vec3::from_milli(1000, 1000, 750),
    Vec3::from_milli(-1000, 1000, 750),
];
static COLORS: [[u8; 3]; 4] = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]];
static SQUARE: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    colors: Some(&COLORS),
    ..MeshData::new(Positions::Exact(&CORNERS))
});

/// Alpha that grows from the left to the right, by 6 a pixel.
struct Ramp([u8; 3]);

impl VertexShader for Ramp {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }
}

impl Shader<Rgba8888> for Ramp {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, [i32; 0]>) -> Option<[u8; 4]> {
        let [r, g, b] = self.0;
        Some([r, g, b, (fragment.position.0 * 6) as u8])
    }
}

const TEST: State = State { depth: DepthState::TEST, cull: Cull::None, ..State::DEFAULT };

#[test]
fn blended_draws_see_what_is_there_and_leave_depth() {
    let color = [200, 100, 50];
    let (opaque, depth, _) = whole::<Rgb888>(SCREEN, Rgb888::CSS_DARK_SLATE_BLUE, |scene| {
        scene.draw(&SQUARE, &Projective::IDENTITY, &Gouraud::vertex_colors());
    });
    // Depth runs from 1/4 at the bottom to 3/4 at the top; nearer by 1/8 everything passes, farther by 1/8 nothing
    // does.
    for (offset, passes) in [(-125, true), (125, false)] {
        let nearer = Projective::from(Affine::translation(Vec3::from_milli(0, 0, offset)));
        let (picture, after, _) = whole::<Rgb888>(SCREEN, Rgb888::CSS_DARK_SLATE_BLUE, |scene| {
            scene.draw(&SQUARE, &Projective::IDENTITY, &Gouraud::vertex_colors());
            scene.draw_with(TEST, &SQUARE, &nearer, &Blend::new(Ramp(color), Alpha));
        });
        assert_eq!(after, depth);
        for (k, (now, before)) in picture.iter().zip(&opaque).enumerate() {
            let alpha = f64::from((k % usize::from(SCREEN.0)) as u8 * 6) / 255.0;
            for ((now, before), color) in now.iter().zip(before).zip(color) {
                let exact = if passes {
                    f64::from(color) * alpha + f64::from(*before) * (1.0 - alpha)
                } else {
                    f64::from(*before)
                };
                assert!((f64::from(*now) - exact).abs() <= 0.5 + 1e-9, "pixel {k}: {now} instead of {exact}");
            }
        }
    }
}

/// A floor that fills the screen, twice as far away at the upper side; columns of a texture run away from the viewer.
static FLOOR: Mesh<'static> = {
    const fn corner(x: i32, y: i32, w: i32) -> [Scalar; 4] {
        [
            Scalar::from_bits((x * w) << 16),
            Scalar::from_bits((y * w) << 16),
            Scalar::from_bits(w << 15),
            Scalar::from_bits(w << 16),
        ]
    }
    const CORNERS: [[Scalar; 4]; 4] = [corner(-1, -1, 1), corner(1, -1, 1), corner(1, 1, 2), corner(-1, 1, 2)];
    Mesh::constant(MeshData {
        topology: Topology::Quads,
        uvs: Some(&[
            [Scalar::ZERO, Scalar::ZERO],
            [Scalar::ONE, Scalar::ZERO],
            [Scalar::from_bits(3 << 15), Scalar::ZERO],
            [Scalar::from_bits(-1 << 15), Scalar::ZERO],
        ]),
        ..MeshData::new(Positions::Homogeneous(&CORNERS))
    })
};

#[test]
fn textures_are_blended_by_their_alpha_in_perspective_too() {
    const COLOR: [u8; 3] = [200, 100, 50];
    let bytes = COLOR.repeat(4);
    let image = Image::new(&bytes, Size::new(4, 1), Rgb888Texel).expect("an image");
    let texture = WithAlpha::new(image, &[0x05, 0xAF]).expect("as many alphas");
    let (picture, ..) = whole::<Rgb888>(SCREEN, Rgb888::CSS_DARK_SLATE_BLUE, |scene| {
        scene.draw(&FLOOR, &Projective::IDENTITY, &Blend::new(Textured::new(&texture), Alpha));
    });
    let there = [Rgb888::CSS_DARK_SLATE_BLUE.r(), Rgb888::CSS_DARK_SLATE_BLUE.g(), Rgb888::CSS_DARK_SLATE_BLUE.b()];
    let mut sure = 0;
    for (k, pixel) in picture.iter().enumerate() {
        let (x, y) = (k % usize::from(SCREEN.0), k / usize::from(SCREEN.0));
        // 1 / w falls from 1 at the lower side to 1/2.
        let inv_w = 1.0 - 0.5 * (23.5 - y as f64) / 24.0;
        let column = (((x as f64 + 0.5) / 20.0 - 1.0) / inv_w + 1.0) * 2.0;
        if (column - column.round()).abs() > 0.02 {
            let alpha = [0, 5, 10, 15][column.rem_euclid(4.0) as usize] * 17;
            let [r, g, b] = COLOR;
            assert_eq!(*pixel, BlendMode::<Rgb888>::blend(&Alpha, [r, g, b, alpha], there), "pixel {x}, {y}");
            sure += 1;
        }
    }
    assert!(sure > 800, "{sure}");
}

#[test]
fn the_alpha_test_draws_what_is_opaque_enough() {
    let (picture, depth, _) = whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| {
        scene.draw(&SQUARE, &Projective::IDENTITY, &AlphaTest::new(Ramp([1, 2, 3]), 120));
    });
    for (k, (pixel, depth)) in picture.iter().zip(depth).enumerate() {
        let drawn = k % usize::from(SCREEN.0) >= 20;
        assert_eq!((*pixel, depth != 65_535), (if drawn { [1, 2, 3] } else { [0; 3] }, drawn), "pixel {k}");
    }
}

#[test]
fn the_screen_door_stays_where_the_screen_is() {
    for opacity in 0..=16_u8 {
        let draw = |x: i32| {
            let moved = Projective::from(Affine::translation(Vec3::from_milli(x, 0, 0)));
            let shader = ScreenDoor::new(Flat::unlit(Rgb888::WHITE), opacity);
            whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| scene.draw(&SQUARE, &moved, &shader)).0
        };
        // 1.05 is 21 pixels, which 4 does not divide.
        let (here, moved) = (draw(0), draw(1050));
        let drawn = here.iter().filter(|pixel| **pixel == [255; 3]).count();
        assert_eq!(drawn, usize::from(opacity) * here.len() / 16);
        for (k, (a, b)) in here.iter().zip(&moved).enumerate() {
            let covered = k % usize::from(SCREEN.0) >= 21;
            assert_eq!(*b, if covered { *a } else { [0; 3] }, "opacity {opacity}, pixel {k}");
        }
    }
}

/// Exact amount that fog leaves, 1 = all.
fn left(curve: FogCurve, distance: f64) -> f64 {
    match curve {
        FogCurve::Linear { start, end } => {
            ((f64::from(end) - distance) / (f64::from(end) - f64::from(start))).clamp(0.0, 1.0)
        }
        FogCurve::Exponential { density } => (-f64::from(density) * distance).exp(),
        FogCurve::ExponentialSquared { density } => (-(f64::from(density) * distance).powi(2)).exp(),
    }
}

#[test]
fn fog_leaves_what_it_should_at_every_depth() {
    let scalar = |v: f64| Scalar::from_num(v);
    let mut worst_of_all = 0.0_f64;
    for (near, far) in [(1.0, 12.0), (0.1, 100.0), (0.02, 50.0), (1.0, 1000.0), (5.0, 20_000.0)] {
        let (n, f) = (f64::from(scalar(near)), f64::from(scalar(far)));
        for (curve, allowed, what) in [
            (FogCurve::Linear { start: scalar(near), end: scalar(far) }, 1.5, "linear"),
            (FogCurve::Linear { start: scalar(0.75 * far), end: scalar(far) }, 1.5, "late linear"),
            (FogCurve::Linear { start: scalar(0.1 * far), end: scalar(0.4 * far) }, 1.5, "early linear"),
            (FogCurve::Exponential { density: scalar(3.0 / far) }, 1.5, "exponential"),
            (FogCurve::ExponentialSquared { density: scalar(2.0 / far) }, 1.5, "squared"),
        ] {
            let table = FogTable::perspective(scalar(near), scalar(far), curve).expect("planes");
            let flat = FogTable::orthographic(scalar(near), scalar(far), curve).expect("planes");
            let (mut worst, mut worst_flat) = (0.0_f64, 0.0_f64);
            for depth in 0..=u16::MAX {
                let z = f64::from(depth) / 65_535.0;
                let exact = 255.0 * left(curve, n * f / (f - z * (f - n)));
                worst = worst.max((f64::from(table.transmittance(depth)) - exact).abs());
                let exact = 255.0 * left(curve, n + z * (f - n));
                worst_flat = worst_flat.max((f64::from(flat.transmittance(depth)) - exact).abs());
            }
            worst_of_all = worst_of_all.max(worst).max(worst_flat);
            println!("{what} fog from {near} to {far}: {worst:.3} of 255, orthographic {worst_flat:.3}");
            assert!(worst <= allowed && worst_flat <= allowed, "{what}: {near}, {far}");
        }
    }
    support::accuracy::check("light that fog leaves", worst_of_all);
    assert!(FogTable::perspective(Scalar::ZERO, Scalar::ONE, FogCurve::Exponential { density: Scalar::ONE }).is_err());
    assert!(FogTable::orthographic(Scalar::ONE, Scalar::ONE, FogCurve::Exponential { density: Scalar::ONE }).is_err());
}

#[test]
fn fog_mixes_colours_by_distance() {
    let (near, far) = (Scalar::ONE, Scalar::from_num(20));
    let camera =
        Projective::perspective(Angle16::from_degrees(60), Size::new(SCREEN.0.into(), SCREEN.1.into()), near, far)
            .expect("a camera");
    let curve = FogCurve::Exponential { density: Scalar::from_num(0.2) };
    let table = FogTable::perspective(near, far, curve).expect("planes");
    let fog = Rgb888::new(180, 190, 200);
    for distance in [2, 5, 9, 15] {
        let mvp = camera
            * Affine::translation(Vec3::from_milli(0, 0, -distance * 1000))
            * Affine::scale_axes(Vec3::from_ints(90, 90, 0));
        let shader = Fogged::new(Flat::unlit(Rgb888::new(250, 20, 60)), &table, fog);
        let (picture, _, _) = whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| scene.draw(&SQUARE, &mvp, &shader));
        let left = left(curve, f64::from(distance));
        for pixel in picture {
            for (channel, (color, fog)) in pixel.into_iter().zip([(250.0, 180.0), (20.0, 190.0), (60.0, 200.0)]) {
                let exact = color * left + fog * (1.0 - left);
                assert!((f64::from(channel) - exact).abs() < 1.7, "at {distance}: {channel} instead of {exact}");
            }
        }
    }
}

#[test]
fn blended_pictures_do_not_depend_on_strips() {
    let table =
        FogTable::orthographic(Scalar::ZERO, Scalar::ONE, FogCurve::Linear { start: Scalar::ZERO, end: Scalar::ONE });
    let table = table.expect("planes");
    let draw = |rows: usize, records: usize| {
        strips::<Rgb565>(SCREEN, rows, records, Rgb565::CSS_DARK_SLATE_BLUE, |scene| {
            let turned = |angle: i32| Projective::from(Affine::rotation_z(Angle16::from_degrees(angle)));
            scene.draw_with(TEST, &SQUARE, &turned(10), &Fogged::new(Gouraud::vertex_colors(), &table, Rgb888::WHITE));
            scene.draw_with(TEST, &SQUARE, &turned(30), &Blend::new(Gouraud::vertex_colors(), Opacity(100)));
            scene.draw_with(TEST, &SQUARE, &turned(50), &Blend::new(Ramp([250, 20, 10]), AddAlpha));
            scene.draw_with(TEST, &SQUARE, &turned(70), &Blend::new(Gouraud::vertex_colors(), Multiply));
            let inner = Fogged::new(Ramp([9, 120, 80]), &table, Rgb888::BLACK);
            scene.draw_with(TEST, &SQUARE, &turned(90), &Blend::new(inner, Alpha));
            scene.draw(&SQUARE, &turned(40), &ScreenDoor::new(Gouraud::vertex_colors(), 5));
            scene.draw_with(TEST, &SQUARE, &turned(120), &Blend::new(AlphaTest::new(Ramp([90, 90, 0]), 100), Add));
        })
        .0
    };
    let expected = draw(24, 1 << 14);
    for (rows, records) in [(1, 1 << 14), (5, 1 << 14), (5, 0), (16, 60), (24, 0)] {
        assert_eq!(difference(&draw(rows, records), &expected, SCREEN.0), None, "{rows} rows, {records} records");
    }
}
