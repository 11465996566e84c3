//! Formats dithered while they are packed, against their undithered colours in 8 bits.

use crate::reference::rng::Rng;
use crate::scenes;
use crate::scenes::{Draw, Room, Torus};
use crate::support::{Soup, difference, strips, whole};
use zstrip::color::{Bgr565Be, Ditherable, Dithered, PixelFormat, Rgb332, Rgb565Be};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Bgr565, Rgb565, Rgb888, RgbColor};
use zstrip::math::{Angle16, Projective, Scalar};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::shader::{Flat, Gouraud};
use zstrip::target::{Strip, WithDepth, WithRecords};
use zstrip::{Cull, State};

const BOTH_SIDES: State = State { cull: Cull::None, ..State::DEFAULT };

/// Light of a channel, 1 for 255.
fn light(channel: f64) -> f64 {
    let c = channel / 255.0;
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// The largest error of a cell's mean over all values of a channel, as a value out of 255 and as light.
fn worst<P: Ditherable>(channel: usize) -> (f64, f64) {
    let (mut value, mut lit) = (0_f64, 0_f64);
    for c in 0..=255_u8 {
        let mut rgb = [255 - c; 3];
        rgb[channel] = c;
        let cell: Vec<f64> = (0..64)
            .map(|k| f64::from(P::unpack(Dithered::<P>::pack_at(rgb, (k % 8 - 24, k / 8 + 40)))[channel]))
            .collect();
        value = value.max((cell.iter().sum::<f64>() / 64.0 - f64::from(c)).abs());
        lit = lit.max((cell.iter().map(|v| light(*v)).sum::<f64>() / 64.0 - light(f64::from(c))).abs());
    }
    (value, lit)
}

/// A scene that strips of dithered pixels are drawn from.
type Drawing = dyn for<'p> Draw<Strip<'p, Dithered<Rgb565Be>, WithDepth, WithRecords>>;

#[test]
fn mean_of_a_cell_is_the_colour() {
    for channel in 0..3 {
        let (value, light) = worst::<Rgb565>(channel);
        assert!(value <= 1.25 && light <= 1.0 / 64.0, "channel {channel}: {value} of 255, light {light}");
        let (value, light) = worst::<Bgr565>(channel);
        assert!(value <= 1.25 && light <= 1.0 / 64.0, "channel {channel}: {value} of 255, light {light}");
        // Two bits of blue are four levels, whose steps are not linear in light.
        let (value, light) = worst::<Rgb332>(channel);
        let bound = if channel == 2 { 0.05 } else { 1.0 / 64.0 };
        assert!(value <= 2.0 && light <= bound, "channel {channel}: {value} of 255, light {light}");
    }
}

/// A rectangle over the whole screen with a colour in each corner.
fn rectangle(colors: [[u8; 3]; 4], mut draw: impl FnMut(&Mesh<'_>)) {
    const EDGE: i32 = 1 << 16;
    let corner = |x: i32, y: i32| [x, y, 0, EDGE].map(Scalar::from_bits);
    let corners = [corner(-EDGE, EDGE), corner(-EDGE, -EDGE), corner(EDGE, -EDGE), corner(EDGE, EDGE)];
    let data = MeshData::new(Positions::Homogeneous(&corners));
    draw(&Mesh::new(MeshData { indices: Some(&[0, 1, 2, 0, 2, 3]), colors: Some(&colors), ..data }).expect("a mesh"));
}

fn check_flat<P: Ditherable<Raw: PartialEq>>(color: Rgb888) {
    rectangle([[0; 3]; 4], |mesh| {
        let (picture, _, _) = whole::<Dithered<P>>((70, 50), P::to_color(P::pack([0; 3])), |scene| {
            scene.draw(mesh, &Projective::IDENTITY, &Flat::unlit(color));
        });
        for (k, pixel) in picture.into_iter().enumerate() {
            let expected = Dithered::<P>::pack_at([color.r(), color.g(), color.b()], (k as i32 % 70, k as i32 / 70));
            assert!(pixel == expected, "pixel {k} in {color:?}");
        }
    });
}

#[test]
fn flat_faces_have_the_pattern_of_the_screen() {
    for color in [Rgb888::new(100, 150, 7), Rgb888::BLACK, Rgb888::WHITE, Rgb888::new(251, 2, 129)] {
        check_flat::<Rgb565>(color);
        check_flat::<Rgb565Be>(color);
        check_flat::<Bgr565Be>(color);
        check_flat::<Rgb332>(color);
    }
}

#[test]
fn black_and_white_have_no_pattern() {
    fn check<P: Ditherable>() {
        for level in [0, 255] {
            rectangle([[level; 3]; 4], |mesh| {
                let (picture, _, _) = whole::<Dithered<P>>((70, 50), P::to_color(P::pack([99; 3])), |scene| {
                    scene.draw(mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
                });
                assert!(picture.into_iter().all(|pixel| P::unpack(pixel) == [level; 3]));
            });
        }
    }
    check::<Rgb565>();
    check::<Rgb565Be>();
    check::<Rgb332>();
}

/// Cells of a ramp, black to white in red, white to black in green, dark to bright in blue, have the mean of the same
/// ramp in 8 bits.
fn check_ramp<P: Ditherable>(bound: f64) {
    let corner = |side: u8, up: u8| [side, 255 - side, up / 2 + 30];
    rectangle([corner(0, 255), corner(0, 0), corner(255, 0), corner(255, 255)], |mesh| {
        let size = (256, 128);
        let (exact, _, _) = whole::<Rgb888>(size, Rgb888::BLACK, |scene| {
            scene.draw(mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
        });
        let (picture, _, _) = whole::<Dithered<P>>(size, P::to_color(P::pack([0; 3])), |scene| {
            scene.draw(mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
        });
        let mut worst = 0_f64;
        for (cell_x, cell_y) in (0..256 / 8).flat_map(|x| (0..128 / 8).map(move |y| (x, y))) {
            let mut sums = [0_i32; 3];
            for place in (0..64).map(|k| (cell_y * 8 + k / 8) * 256 + cell_x * 8 + k % 8) {
                for (sum, (found, exact)) in sums.iter_mut().zip(P::unpack(picture[place]).iter().zip(exact[place])) {
                    *sum += i32::from(*found) - i32::from(exact);
                }
            }
            worst = sums.iter().fold(worst, |worst, sum| worst.max(f64::from(sum.abs()) / 64.0));
        }
        assert!(worst <= bound, "{worst} of 255");
    });
}

#[test]
fn cells_of_a_ramp_have_its_mean() {
    check_ramp::<Rgb565>(1.25);
    check_ramp::<Rgb332>(6.0);
}

/// No pixel is more than a level from its colour, whatever the triangle: no channel runs into its neighbour.
fn check_levels<P: Ditherable>(seed: u64, bound: [u8; 3]) {
    let mut rng = Rng::new(seed);
    let soup = Soup::new(&mut rng, 30);
    let (mesh, size) = (soup.mesh(), (150, 110));
    let (exact, _, _) = whole::<Rgb888>(size, Rgb888::BLACK, |scene| {
        scene.draw_with(BOTH_SIDES, &mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
    });
    let (picture, _, _) = whole::<Dithered<P>>(size, P::to_color(P::pack([0; 3])), |scene| {
        scene.draw_with(BOTH_SIDES, &mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
    });
    for (k, (exact, pixel)) in exact.iter().zip(picture).enumerate() {
        let rgb = P::unpack(pixel);
        let near = (0..3).all(|c| rgb[c].abs_diff(exact[c]) <= bound[c]);
        assert!(near, "seed {seed}, pixel {k}: {rgb:?} for {exact:?}");
    }
}

#[test]
fn no_pixel_is_more_than_a_level_off() {
    // 255/31, 255/63, 255/7, 255/3 and what interpolation and repeated bits may be off.
    for seed in 0..60 {
        check_levels::<Rgb565>(seed, [10, 6, 10]);
        check_levels::<Rgb332>(seed, [38, 38, 87]);
    }
}

#[test]
fn dithered_pictures_are_the_same_in_any_strips() {
    for name in ["torus_flat", "torus_gouraud", "room"] {
        let draw = |rows: usize, records: usize| {
            let background = scenes::BACKGROUND;
            let (screen, turn) = (Size::new(320, 240), Angle16(999));
            let drawing: Box<Drawing> = match name {
                "torus_flat" => Box::new(Torus::flat(screen, turn)),
                "torus_gouraud" => Box::new(Torus::gouraud(screen, turn)),
                _ => Box::new(Room::new(screen, turn)),
            };
            let (picture, _) =
                strips::<Dithered<Rgb565Be>>((320, 240), rows, records, background, |scene| drawing.draw(scene));
            picture
        };
        let expected = draw(240, 40_000);
        for (rows, records) in [(1, 40_000), (7, 100), (16, 40_000), (33, 0)] {
            assert_eq!(difference(&draw(rows, records), &expected, 320), None, "{name} in strips of {rows} rows");
        }
    }
}
