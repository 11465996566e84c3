//! Cameras that frame a model, levels of detail and of textures, the order of draws.

use super::builder::node;
use super::figures::{many_parts, textured, tube_part};
use crate::reference::rng::Rng;
use crate::support::{apply, difference, matrix, strips};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::light::Sun;
use zstrip::math::{Affine, Angle16, ProjectionError, Vec3};
use zstrip::mesh::Bounds;
use zstrip::model::container::{AlphaMode, Node};
use zstrip::model::{Camera, Model};

fn sun() -> Sun {
    Sun::new(Vec3::from_ints(4, 7, 6), Rgb888::WHITE, Rgb888::BLUE)
}

#[test]
fn a_framed_box_reaches_the_border_of_the_screen() {
    for (width, height) in [(240, 320), (320, 240), (100, 30)] {
        for direction in [Vec3::Z, Vec3::from_ints(2, 1, 3), Vec3::Y, Vec3::from_ints(-1, -5, 2)] {
            for half in [[1, 1, 1], [40, 3, 9], [0, 7, 0], [300, 200, 100]] {
                let [x, y, z] = half;
                let (center, half) = (Vec3::from_ints(5, -3, 20), Vec3::from_ints(x, y, z));
                let bounds = Bounds { center, half };
                let camera = Camera::framing(&bounds, Angle16::from_degrees(40), Size::new(width, height), direction);
                let camera = camera.expect("a camera");
                let m = matrix(&(camera.lens * camera.view));
                let mut reach = 0.0_f64;
                for corner in 0..8 {
                    let side = |bit: u32, c: i16| f64::from(c) * if corner >> bit & 1 == 0 { 1.0 } else { -1.0 };
                    let p = [5.0 + side(0, x), -3.0 + side(1, y), 20.0 + side(2, z), 1.0];
                    let [x, y, z, w] = apply(&m, p);
                    assert!(w > 0.0 && z > 0.0 && z < w, "{bounds:?} from {direction:?}: {z} of {w}");
                    reach = reach.max(x.abs() / w).max(y.abs() / w);
                }
                let is_line = [x, z] == [0, 0] && direction == Vec3::Y;
                assert!(reach < 1.01 && (reach > 0.99 || is_line), "{bounds:?} from {direction:?}: {reach}");
            }
        }
    }
    let bounds = Bounds { center: Vec3::ZERO, half: Vec3::X };
    assert!(Camera::framing(&bounds, Angle16::from_degrees(40), Size::new(8, 8), Vec3::ZERO).is_err());
    assert!(Camera::framing(&bounds, Angle16::ZERO, Size::new(8, 8), Vec3::Z).is_err());
}

#[test]
fn boxes_that_no_camera_can_show_are_errors() {
    let screen = Size::new(240, 320);
    let framing = |center: [i16; 3], half: [i16; 3], direction: Vec3| {
        let [[a, b, c], [x, y, z]] = [center, half];
        let bounds = Bounds { center: Vec3::from_ints(a, b, c), half: Vec3::from_ints(x, y, z) };
        Camera::framing(&bounds, Angle16::from_degrees(40), screen, direction)
    };
    // On an upright screen, the camera is 8000 · 4/3 / tan 20° + 8000 units away, and the far plane 1.5 times as far as
    // the back of the box: 67,959, but for the rounding of the turn.
    let error = framing([0; 3], [8000; 3], Vec3::Z).expect_err("far");
    assert_eq!(error.to_string(), "the camera that shows the box needs numbers up to 67958, must be below 32768");
    // The middle is 30,000 · √3 units away, along the view.
    assert!(matches!(
        framing([30_000; 3], [1; 3], Vec3::from_ints(1, 1, 1)),
        Err(ProjectionError::BoxOutOfRange { .. })
    ));
    let directions = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::from_ints(1, 1, 1), Vec3::from_ints(-5, 2, -1)];
    let (mut rng, mut shown) = (Rng::new(4), 0);
    for k in 0..3000 {
        let mut numbers = |bits: u32| core::array::from_fn(|_| rng.signed_bits(1 + k % bits) as i16);
        let (center, half): ([i16; 3], [i16; 3]) = (numbers(15), numbers(14));
        let half = half.map(i16::abs);
        let Ok(camera) = framing(center, half, directions[k as usize % 5]) else { continue };
        shown += 1;
        let m = matrix(&(camera.lens * camera.view));
        for corner in 0..8 {
            let side = |k: usize| if corner >> k & 1 == 0 { half[k] } else { -half[k] };
            let p: [f64; 3] = core::array::from_fn(|k| f64::from(center[k]) + f64::from(side(k)));
            let [x, y, z, w] = apply(&m, [p[0], p[1], p[2], 1.0]);
            let is_inside = x.abs() < 1.01 * w && y.abs() < 1.01 * w && 0.0 <= z && z <= w;
            assert!(is_inside || half == [0; 3], "{center:?} {half:?}: {x} {y} {z} {w}");
        }
    }
    for half in [9000, 15_000, i16::MAX] {
        assert!(framing([0; 3], [half; 3], Vec3::Z).is_err(), "{half}");
    }
    println!("{shown} of 3000 boxes shown");
    assert!((1000..3000).contains(&shown), "{shown}");
}

#[test]
fn parts_far_away_are_coarser_ones() {
    let mut builder = textured();
    // The second part can stand for the first one where a tenth of a unit is less than a pixel.
    builder.parts[0].item.coarser = 1;
    let mut coarse = tube_part();
    coarse.triangles.truncate(100);
    coarse.item.error = 6554;
    builder.parts.push(coarse);
    let container = builder.build();
    let model = Model::from_bytes(container.bytes()).expect("a model");
    let screen = Size::new(100, 100);
    let camera = Camera::framing(&model.bounds(), Angle16::from_degrees(53), screen, Vec3::Z).expect("a camera");
    let mut places = [None; 1];
    let mut part = |distance: i16| {
        let world = Affine::translation(Vec3::from_ints(0, 0, -distance));
        let placed = model.place(&world, &camera, &sun(), &mut places).expect("enough places");
        let (_, part) = placed.draws().next().expect("a draw");
        part
    };
    // At distance d, a pixel is d / 100 units: the camera is 3 units away.
    assert_eq!([0, 4, 6, 9, 50].map(&mut part), [0, 0, 0, 1, 1]);
}

#[test]
fn textures_far_away_are_smaller_ones() {
    let mut builder = textured();
    builder.parts[0].item.texels_per_unit = 120 << 8;
    let container = builder.clone().build();
    let model = Model::from_bytes(container.bytes()).expect("a model");
    let screen = Size::new(100, 100);
    let camera = Camera::framing(&model.bounds(), Angle16::from_degrees(53), screen, Vec3::Z).expect("a camera");
    let picture = |model: &Model<'_>| {
        let mut places = [None; 1];
        let placed = model.place(&Affine::IDENTITY, &camera, &sun(), &mut places).expect("enough places");
        strips::<Rgb565>((100, 100), 100, 0, Rgb565::BLACK, |scene| placed.draw(scene)).0
    };
    let found = picture(&model);
    // A pixel is 1/33 unit: texels of 1/120 and 1/60 are too small, those of 1/30 are the nearest. That is the third
    // level.
    let texture = &mut builder.textures[0];
    (texture.width, texture.height, texture.levels) = (4, 4, 1);
    texture.texels += 2 * (256 + 64);
    let container = builder.build();
    let third = Model::from_bytes(container.bytes()).expect("a model");
    assert_eq!(difference(&found, &picture(&third), 100), None);
}

#[test]
fn blended_parts_come_last_from_back_to_front() {
    let container = many_parts().build();
    let model = Model::from_bytes(container.bytes()).expect("a model");
    let screen = Size::new(100, 100);
    let camera = Camera::framing(&model.bounds(), Angle16::from_degrees(53), screen, Vec3::Z).expect("a camera");
    let mut places = vec![None; Model::draws(container.bytes())];
    let placed = model.place(&Affine::IDENTITY, &camera, &sun(), &mut places).expect("enough places");
    let parts: Vec<usize> = placed.draws().map(|(_, part)| part).collect();
    assert_eq!(parts.len(), 14);
    // Textures number 2 and 5 are blended, and the fourth and sixth part without a texture.
    let mut blended = parts[10..].to_vec();
    blended.sort_unstable();
    assert_eq!(blended, [2, 5, 11, 13]);
    let depth = |place: usize| {
        let (mvp, part) = placed.draws().nth(place).expect("a draw");
        zstrip::mesh::view_depth(mvp, model.mesh(part).expect("a part").bounds())
    };
    assert!((10..13).all(|place| depth(place) >= depth(place + 1)));
    let error = model.place(&Affine::IDENTITY, &camera, &sun(), &mut [None; 3]).expect_err("too few places");
    assert_eq!(error.to_string(), "3 places, but the model has 14 draws");
}

#[test]
fn many_blended_draws_are_sorted_in_a_short_time() {
    let mut builder = textured();
    builder.materials[0].alpha_mode = AlphaMode::Blend as u8;
    let mut rng = Rng::new(3);
    builder.nodes = (0..20_000)
        .map(|_| Node { translation: [0, 0, rng.below(50) as i32 * -(1 << 16)], parts: 1, ..node() })
        .collect();
    let z: Vec<i32> = builder.nodes.iter().map(|node| node.translation[2]).collect();
    let container = builder.build();
    let model = Model::from_bytes(container.bytes()).expect("a model");
    let screen = Size::new(100, 100);
    let camera = Camera::framing(&model.bounds(), Angle16::from_degrees(53), screen, Vec3::Z).expect("a camera");
    let mut places = vec![None; z.len()];
    // Comparing all with all would be 100 million comparisons, each of which some hundred instructions.
    let start = std::time::Instant::now();
    let placed = model.place(&Affine::IDENTITY, &camera, &sun(), &mut places).expect("enough places");
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
    let depths: Vec<i64> = placed
        .draws()
        .map(|(mvp, part)| zstrip::mesh::view_depth(mvp, model.mesh(part).expect("a part").bounds()))
        .collect();
    assert_eq!(depths.len(), z.len());
    assert!(depths.is_sorted_by(|a, b| a >= b) && depths.first() > depths.last());
}

#[test]
fn nodes_are_found_by_name() {
    let mut builder = many_parts();
    for (number, name) in [(2, "hat"), (5, "h\u{e4}nd"), (6, "hat")] {
        let (first, length) = builder.name(name);
        (builder.nodes[number].name, builder.nodes[number].name_length) = (first, length);
    }
    let container = builder.build();
    let model = Model::from_bytes(container.bytes()).expect("a model");
    let found = ["hat", "h\u{e4}nd", "", "ha", "hats", "Hat"].map(|name| model.node_named(name));
    assert_eq!(found, [Some(2), Some(5), Some(0), None, None, None]);
}
