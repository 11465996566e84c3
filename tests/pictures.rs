//! Small pictures that a person can check by eye, each drawn in several strip heights and with several amounts of
//! records.
//!
//! | character | pixel |
//! |---|---|
//! | `.` | background, black |
//! | `R` `G` `B` `Y` `C` `M` | a full colour |
//! | `0` to `9` | grey, a tenth of white each |
//! | `#` | white |
//! | `?` | any other colour |
//!
//! In pictures of [`hits`], a digit says how often a pixel was drawn.

use crate::support::strips;
use embedded_graphics::geometry::Point;
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_4X6};
use embedded_graphics::text::Text;
use std::fmt::Write;
use zstrip::color::Dither;
use zstrip::embedded_graphics_core::Drawable;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{BinaryColor, Gray8, Rgb888, RgbColor};
use zstrip::math::{Affine, Angle16, Pixels, Projective, Scalar, Vec3};
use zstrip::mesh::{LineTopology, Lines, Mesh, MeshData, Points, Positions, Topology, Vertices};
use zstrip::shader::{Add, Blend, Flat, Gouraud, Textured};
use zstrip::span::DepthState;
use zstrip::target::{Strip, WithDepth, WithRecords};
use zstrip::texture::Tile;
use zstrip::{Cull, Dashed, Scene, ScreenPoint, Smooth, State, Thick, Thin};

/// Strip heights and words of records that each picture is drawn with.
const ARRANGEMENTS: [(usize, usize); 6] = [(1, 0), (1, 1000), (3, 1000), (4, 0), (4, 20), (64, 1000)];

/// Returns the character that stands for a pixel.
fn character(rgb: [u8; 3]) -> char {
    match rgb {
        [0, 0, 0] => '.',
        [255, 0, 0] => 'R',
        [0, 255, 0] => 'G',
        [0, 0, 255] => 'B',
        [255, 255, 0] => 'Y',
        [0, 255, 255] => 'C',
        [255, 0, 255] => 'M',
        [255, 255, 255] => '#',
        [r, g, b] if r == g && g == b => char::from(b'0' + ((u16::from(r) * 10 + 127) / 255).min(9) as u8),
        _ => '?',
    }
}

/// Draws a picture in each arrangement of strips and compares its characters with `expected`, row by row.
///
/// On a failure it prints both pictures side by side, and which pixels are too many or too few.
#[track_caller]
fn assert_pattern(expected: &[&str], draw: impl Fn(&mut Scene<'_, Strip<'_, Rgb888, WithDepth, WithRecords>>)) {
    let (width, height) = (expected[0].len(), expected.len());
    assert!(expected.iter().all(|row| row.len() == width), "the rows of a pattern are equally long");
    for (rows, records) in ARRANGEMENTS {
        let screen = (width as u16, height as u16);
        let (picture, _) = strips::<Rgb888>(screen, rows.min(height), records, Rgb888::BLACK, &draw);
        let found: Vec<String> = picture.chunks(width).map(|row| row.iter().map(|p| character(*p)).collect()).collect();
        if found == expected {
            continue;
        }
        let mut report =
            format!("in strips of {rows} rows, {records} words of records\n{:width$}   found\n", "expected");
        let (mut missing, mut surplus, mut other) = (0, 0, 0);
        for (e, f) in expected.iter().zip(&found) {
            let differs: String = e.chars().zip(f.chars()).map(|(e, f)| if e == f { ' ' } else { '^' }).collect();
            for (e, f) in e.chars().zip(f.chars()).filter(|(e, f)| e != f) {
                *(if f == '.' || f < e && e.is_ascii_digit() {
                    &mut missing
                } else if e == '.' || e.is_ascii_digit() {
                    &mut surplus
                } else {
                    &mut other
                }) += 1;
            }
            writeln!(report, "{e}   {f}   {differs}").expect("a string");
        }
        panic!("{report}{missing} pixels are missing or too dark, {surplus} are too many or overdrawn, {other} differ");
    }
}

/// Adds a tenth of white wherever it draws: a pixel shows how often it was drawn.
fn hits() -> Blend<Flat, Add> {
    Blend::new(Flat::unlit(Rgb888::new(25, 25, 25)), Add)
}

/// Both sides of triangles, whatever their depth.
const FLAT: State = State { depth: DepthState::OFF, cull: Cull::None, ..State::DEFAULT };

/// Both sides of triangles.
const BOTH_SIDES: State = State { cull: Cull::None, ..State::DEFAULT };

/// Takes (x, y, z) to the pixel x to the right and y below the corner of a 16×8 screen, z = 0..16 to its depth.
fn pixels() -> Projective {
    let zero = Scalar::ZERO;
    let [width, height] = [16, 8].map(Scalar::from_num);
    let lens = Projective::orthographic((zero, width), (-height, zero), (zero, width)).expect("a camera");
    lens * Affine::scale_axes(Vec3::from_ints(1, -1, -1))
}

#[test]
fn triangle_has_the_pixels_whose_centres_are_inside_or_on_its_left_and_top_edges() {
    // The slanted edge, on the right, runs through pixel centres: they are not drawn. The left edge and the top one do
    // as well: they are.
    let corner = ScreenPoint::center;
    assert_pattern(
        &[".........", ".RRRRRR..", ".RRRRR...", ".RRRR....", ".RRR.....", ".RR......", ".R.......", "........."],
        |scene| scene.canvas().polygon(&[corner(1, 1), corner(7, 1), corner(1, 7)], Rgb888::RED),
    );
}

/// Returns a mesh's positions: x and y in pixels, z from 0 to 16.
fn at<const N: usize>(points: [(i16, i16, i16); N]) -> [Vec3; N] {
    points.map(|(x, y, z)| Vec3::from_ints(x, y, z))
}

#[test]
fn triangles_that_share_edges_leave_no_gap_and_overlap_nowhere() {
    // A fan about (7, 4): all centres of the octagon are drawn once.
    let points =
        at([(7, 4, 8), (7, 0, 8), (12, 1, 8), (15, 4, 8), (11, 7, 8), (7, 8, 8), (2, 6, 8), (0, 4, 8), (3, 1, 8)]);
    let indices: Vec<u16> = (1..9).flat_map(|k| [0, k, k % 8 + 1]).collect();
    let fan =
        Mesh::new(MeshData { indices: Some(&indices), ..MeshData::new(Positions::Exact(&points)) }).expect("a fan");
    assert_pattern(
        &[
            ".....1111.......",
            "..1111111111....",
            ".111111111111...",
            "11111111111111..",
            "11111111111111..",
            ".111111111111...",
            "...111111111....",
            "......111.......",
        ],
        |scene| scene.draw_with(FLAT, &fan, &pixels(), &hits()),
    );
}

#[test]
fn floor_is_clipped_at_the_near_plane() {
    // A path along -z from behind the eye to z = -20, seen from one above: its near part, which has no place on the
    // screen, is gone, and what is left reaches the lower border.
    let corners = [(-1, 2), (1, 2), (1, -20), (-1, -20)].map(|(x, z)| Vec3::from_ints(x, -1, z));
    let path = Mesh::new(MeshData { topology: Topology::Quads, ..MeshData::new(Positions::Exact(&corners)) });
    let path = path.expect("a square");
    let lens = Projective::perspective(Angle16::from_degrees(90), Size::new(16, 8), Scalar::ONE, Scalar::from_num(100));
    let lens = lens.expect("a camera");
    assert_pattern(
        &[
            "................",
            "................",
            "................",
            "................",
            ".......G........",
            "......GGG.......",
            ".....GGGGG......",
            "....GGGGGGG.....",
        ],
        |scene| {
            scene.draw_with(BOTH_SIDES, &path, &lens, &Flat::unlit(Rgb888::GREEN));
        },
    );
}

#[test]
fn nearer_one_of_two_crossing_squares_is_seen() {
    // Red is near on the left and far on the right, blue the other way round, whichever is drawn first.
    let red = at([(1, 1, 2), (1, 7, 2), (15, 7, 14), (15, 1, 14)]);
    let blue = at([(3, 0, 14), (3, 6, 14), (13, 6, 2), (13, 0, 2)]);
    let square =
        |corners| Mesh::new(MeshData { topology: Topology::Quads, ..MeshData::new(Positions::Exact(corners)) });
    let (red, blue) = (square(&red).expect("a square"), square(&blue).expect("a square"));
    for first in [true, false] {
        assert_pattern(
            &[
                "...BBBBBBBBBB...",
                ".RRRRRRRBBBBBRR.",
                ".RRRRRRRBBBBBRR.",
                ".RRRRRRRBBBBBRR.",
                ".RRRRRRRBBBBBRR.",
                ".RRRRRRRBBBBBRR.",
                ".RRRRRRRRRRRRRR.",
                "................",
            ],
            |scene| {
                for second in [false, true] {
                    let (mesh, color) = if first ^ second { (&red, Rgb888::RED) } else { (&blue, Rgb888::BLUE) };
                    scene.draw_with(BOTH_SIDES, mesh, &pixels(), &Flat::unlit(color));
                }
            },
        );
    }
}

#[test]
fn thin_lines_in_all_octants_leave_the_diamond_of_their_start_and_not_that_of_their_end() {
    // From the middle to a point in each octant: no end is drawn.
    assert_pattern(
        &[
            "...............",
            "....R.....G....",
            ".....R...G.....",
            ".....R...G.....",
            ".G....R.G....R.",
            "..GG..R.G..RR..",
            "....GG.G.RR....",
            "......GGG......",
            "....RR.G.GG....",
            "..RR..G.R..GG..",
            ".R....G.R....G.",
            ".....G...R.....",
            ".....G...R.....",
            "....G.....R....",
            "...............",
        ],
        |scene| {
            let mut canvas = scene.canvas();
            for (x, y) in [(14, 4), (4, 0), (0, 10), (10, 14)] {
                canvas.line(ScreenPoint::center(7, 7), ScreenPoint::center(x, y), Rgb888::RED);
            }
            for (x, y) in [(10, 0), (0, 4), (4, 14), (14, 10)] {
                canvas.line(ScreenPoint::center(7, 7), ScreenPoint::center(x, y), Rgb888::GREEN);
            }
        },
    );
}

#[test]
fn thin_line_strip_draws_the_pixels_of_a_joint_once() {
    let points = at([(1, 1, 8), (14, 1, 8), (14, 6, 8), (2, 6, 8), (2, 3, 8), (11, 3, 8)]);
    let lines = Lines::new(Vertices::new(Positions::Exact(&points)), LineTopology::Strip, None).expect("lines");
    assert_pattern(
        &[
            "................",
            ".11111111111111.",
            "..............1.",
            "..111111111...1.",
            "..1...........1.",
            "..1...........1.",
            "..1111111111111.",
            "................",
        ],
        |scene| scene.draw_lines_with(FLAT, &lines, &half_a_pixel_on(), &hits(), &Thin),
    );
}

/// [`pixels`], half a pixel further: to pixel centres.
fn half_a_pixel_on() -> Projective {
    pixels() * Affine::translation(Vec3::from_milli(500, 500, 0))
}

#[test]
fn dashed_line_begins_with_its_lowest_bit() {
    assert_pattern(
        &["RRRR....RRRR....", "....GGGG....GGGG", "B.B.B.B.B.B.B.B.", "YYY..Y..........", "CCCCCCCC....CCCC"],
        |scene| {
            let mut canvas = scene.canvas();
            let point = ScreenPoint::center;
            canvas.line_with(point(0, 0), point(16, 0), Rgb888::RED, &Dashed::EVEN);
            canvas.line_with(point(15, 1), point(-1, 1), Rgb888::GREEN, &Dashed::EVEN);
            canvas.line_with(point(0, 2), point(16, 2), Rgb888::BLUE, &Dashed::DOTTED);
            canvas.line_with(point(0, 3), point(16, 3), Rgb888::YELLOW, &Dashed(0b0010_0111));
            canvas.line_with(point(-4, 4), point(16, 4), Rgb888::CYAN, &Dashed(0x00FF_0FF3));
        },
    );
}

#[test]
fn thick_line_is_a_rectangle_with_straight_ends() {
    assert_pattern(
        &[
            "...........BBB..",
            ".RRRRRRRR..BBB..",
            ".RRRRRRRR..BBB..",
            "......G....BBB..",
            ".....GGG...BBB..",
            "....GGGGG..BBB..",
            "...GGGGG...BBB..",
            "..GGGGG....BBB..",
            "..GGGG.....BBB..",
            "...GG......BBB..",
        ],
        |scene| {
            let mut canvas = scene.canvas();
            let point = ScreenPoint::corner;
            canvas.line_with(point(1, 2), point(9, 2), Rgb888::RED, &Thick::px(2));
            canvas.line_with(point(3, 9), point(8, 4), Rgb888::GREEN, &Thick::px(3));
            canvas.line_with(point(13, 0), point(13, 10), Rgb888::BLUE, &Thick::px(3));
        },
    );
}

#[test]
fn smooth_line_covers_its_rim_in_part() {
    assert_pattern(
        &[
            ".............55.",
            ".35555552....55.",
            ".5######5....55.",
            ".35555552....55.",
            "..31............",
            ".179742.........",
            "...0369852......",
            ".......2589630..",
            "..........247971",
            ".............13.",
        ],
        |scene| {
            let mut canvas = scene.canvas();
            let point = ScreenPoint::corner;
            // 2 px high about pixel centres: half of two rows and all of one; its ends are in the middle of pixels.
            canvas.line_with(ScreenPoint::center(1, 2), ScreenPoint::center(8, 2), Rgb888::WHITE, &Smooth::px(2));
            canvas.line_with(point(2, 5), point(15, 9), Rgb888::WHITE, &Smooth::px(1));
            canvas.line_with(point(14, 0), point(14, 4), Rgb888::WHITE, &Smooth::px(1));
        },
    );
}

#[test]
fn points_are_squares_about_their_vertices() {
    let points = at([(2, 2, 4), (5, 2, 4), (9, 4, 4), (11, 6, 2)]);
    let colors = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 0]];
    let data = Vertices { colors: Some(&colors), ..Vertices::new(Positions::Exact(&points)) };
    let points = Points::new(data).expect("points");
    let green = at([(7, 0, 8), (7, 8, 8), (9, 8, 8), (9, 0, 8)]);
    let wall =
        Mesh::new(MeshData { topology: Topology::Quads, ..MeshData::new(Positions::Exact(&green)) }).expect("a wall");
    assert_pattern(
        &[
            "RRRRGGG##.......",
            "RRRRGGG##.......",
            "RRRRGGGBBBB.....",
            "RRRRGGGBBBB.....",
            ".......BBYYYY...",
            ".......BBYYYY...",
            ".......##YYYY...",
            ".......##YYYY...",
        ],
        |scene| {
            scene.draw_with(BOTH_SIDES, &wall, &pixels(), &Flat::unlit(Rgb888::WHITE));
            scene.draw_points_with(
                BOTH_SIDES,
                &points,
                &pixels(),
                &Gouraud::vertex_colors(),
                Pixels::from_bits(4 << 8),
            );
        },
    );
}

#[test]
fn strip_boundaries_do_not_show_in_a_shape() {
    // A ring with edges of all slopes; strips of 1, 3 and 4 rows part it.
    let corner = ScreenPoint::corner;
    assert_pattern(
        &[
            ".......RR.......",
            "......RRRRR.....",
            ".....RRRRRRR....",
            "...RRRRYYYRRRR..",
            "..RRRYY...YYRRR.",
            ".RRRY......YRRR.",
            "RRRRY......YRR..",
            ".RRRY.....YRRR..",
            "..RRRY....YRRR..",
            "..RRRYYYYYYRR...",
            "...RRRRRRRRRR...",
            "....RRRRRRR.....",
            ".....RR.........",
        ],
        |scene| {
            let mut canvas = scene.canvas();
            canvas.polygon(&[corner(8, 0), corner(15, 4), corner(13, 11), corner(5, 13), corner(0, 6)], Rgb888::RED);
            canvas.polygon(&[corner(8, 3), corner(12, 5), corner(10, 10), corner(6, 10), corner(4, 6)], Rgb888::BLACK);
            canvas.outline(
                &[corner(8, 3), corner(12, 5), corner(10, 10), corner(6, 10), corner(4, 6)],
                Rgb888::YELLOW,
                &Thin,
            );
        },
    );
}

#[test]
fn texture_is_a_checkerboard_whose_cells_shrink_with_distance() {
    const RED: u16 = 0xF800;
    const BLUE: u16 = 0x001F;
    static CHECKS: Tile<'static, 2, 2> = Tile::new(&[[RED, BLUE], [BLUE, RED]]);
    let corners = [(-4, 0), (4, 0), (4, -8), (-4, -8)].map(|(x, z)| Vec3::from_ints(x, -1, z));
    let uv = [[0, 0], [2, 0], [2, 2], [0, 2]].map(|uv| uv.map(Scalar::from_num));
    let data = MeshData { topology: Topology::Quads, uvs: Some(&uv), ..MeshData::new(Positions::Exact(&corners)) };
    let floor = Mesh::new(data).expect("a square");
    let lens =
        Projective::perspective(Angle16::from_degrees(90), Size::new(24, 12), Scalar::ONE, Scalar::from_num(100));
    let above = lens.expect("a camera") * Affine::translation(Vec3::from_milli(0, -100, 0));
    assert_pattern(
        &[
            "........................",
            "........................",
            "........................",
            "........................",
            "........................",
            "........................",
            "........................",
            ".......RRBBBRRRBB.......",
            "...BBBBRRRRRBBBBBRRRR...",
            "RRRRRRBBBBBBRRRRRRBBBBBB",
            "RRRRBBBBBBBBRRRRRRRRBBBB",
            "RRBBBBBBBBBBRRRRRRRRRRBB",
        ],
        |scene| {
            scene.draw_with(BOTH_SIDES, &floor, &above, &Textured::new(&CHECKS));
        },
    );
}

#[test]
fn canvas_polygon_is_cut_by_its_scissor_and_hidden_by_what_is_nearer() {
    use zstrip::embedded_graphics_core::{geometry::Size, primitives::Rectangle};
    let near = at([(6, 2, 4), (6, 6, 4), (10, 6, 4), (10, 2, 4)]);
    let near = Mesh::new(MeshData { topology: Topology::Quads, ..MeshData::new(Positions::Exact(&near)) });
    let near = near.expect("a square");
    let hexagon = [(4, 0), (12, 0), (16, 4), (12, 8), (4, 8), (0, 4)].map(|(x, y)| ScreenPoint::corner(x, y));
    assert_pattern(
        &[
            "...CCCCCCCCC....",
            "..CCCCCCCCCCC...",
            ".CCCCCBBBBCCCC..",
            ".CCCCCBBBBCCCC..",
            ".CCCCCBBBBCCCC..",
            ".CCCCCBBBBCCCC..",
            "..CCCCCCCCCCC...",
            "................",
        ],
        |scene| {
            scene.draw_with(BOTH_SIDES, &near, &pixels(), &Flat::unlit(Rgb888::BLUE));
            let mut canvas = scene.canvas();
            canvas.set_depth(0x8000, DepthState::LESS);
            canvas.set_scissor(Some(&Rectangle::new(Point::new(1, 0), Size::new(13, 7))));
            canvas.polygon(&hexagon, Rgb888::CYAN);
        },
    );
}

#[test]
fn dithering_has_the_order_of_bayer() {
    // Greys with 0, 1/8, 1/4 .. of the light of white, in columns of four.
    let share = |k: usize| [0_u8, 99, 137, 165, 188, 207, 225, 241, 255][k];
    let expected = [
        "....#...#.#.#.#.#.#.###.########",
        ".............#...#.#.#.#.#.###.#",
        "......#.#.#.#.#.#.#.#.##########",
        "...............#.#.#.#.#.#.#.###",
        "....#...#.#.#.#.#.#.###.########",
        ".............#...#.#.#.#.#.###.#",
        "......#.#.#.#.#.#.#.#.##########",
        "...............#.#.#.#.#.#.#.###",
    ];
    let screen = (32, 8);
    let (greys, _) = strips::<Gray8>(screen, 3, 100, Gray8::new(0), |scene| {
        let mut canvas = scene.canvas();
        for k in 0..8 {
            let [left, right] = [4 * k as i16, 4 * k as i16 + 4];
            let corners = [(left, 0), (left, 8), (right, 8), (right, 0)].map(|(x, y)| ScreenPoint::corner(x, y));
            let grey = share(k);
            canvas.polygon(&corners, Rgb888::new(grey, grey, grey));
        }
    });
    let dither = Dither::<BinaryColor>::BAYER_4;
    let level = |k: usize| dither.level(greys[k], (k as i32 % 32, k as i32 / 32));
    let found: Vec<String> =
        (0..8).map(|y| (0..32).map(|x| if level(32 * y + x) == 1 { '#' } else { '.' }).collect()).collect();
    assert_eq!(found, expected, "{found:#?}");
}

#[test]
fn text_lies_over_a_scene_in_every_strip() {
    let wall = at([(0, 3, 8), (0, 8, 8), (16, 8, 8), (16, 3, 8)]);
    let wall = Mesh::new(MeshData { topology: Topology::Quads, ..MeshData::new(Positions::Exact(&wall)) });
    let wall = wall.expect("a wall");
    assert_pattern(
        &[
            "................",
            ".#..#........#..",
            "#.#.##...##.##..",
            "###B#B#B#B#BB#BB",
            "#B#B#B#BB##BB#BB",
            "#B#B##BBBB#B###B",
            "BBBBBBBB##BBBBBB",
            "BBBBBBBBBBBBBBBB",
        ],
        |scene| {
            scene.draw_with(BOTH_SIDES, &wall, &pixels(), &Flat::unlit(Rgb888::BLUE));
            let style = MonoTextStyle::new(&FONT_4X6, Rgb888::WHITE);
            let Ok(_) = Text::new("Abg1", Point::new(0, 5), style).draw(&mut scene.overlay());
        },
    );
}
