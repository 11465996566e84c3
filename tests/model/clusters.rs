//! Clusters: what they cull is out of sight.

use super::builder::Builder;
use super::figures::clustered;
use crate::reference::rng::Rng;
use crate::support::{difference, strips};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::light::Sun;
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::BoundsNode;
use zstrip::model::{Camera, Model};

#[test]
fn culled_clusters_change_no_pixel() {
    let container = clustered().build();
    let model = Model::from_bytes(container.bytes()).expect("a model");
    let sun = Sun::new(Vec3::from_ints(4, 7, 6), Rgb888::WHITE, Rgb888::BLUE);
    let screen = (96, 72);
    let (mut fewer, mut hidden) = (0, 0);
    for turn in 0..24_i16 {
        let around = Angle16(2700) * i32::from(turn);
        let direction = Vec3::new(around.sin(), Scalar::from_num(0.3), around.cos());
        let size = Size::new(96, 72);
        let mut camera =
            Camera::framing(&model.bounds(), Angle16::from_degrees(50), size, direction).expect("a camera");
        if turn % 2 == 1 {
            // Close up, beside it.
            camera.view = Affine::translation(Vec3::from_milli(1200, 300, 1500)) * camera.view;
        }
        // Also mirrored.
        let world = if turn % 3 == 2 { Affine::scale_axes(Vec3::from_ints(-1, 1, 1)) } else { Affine::IDENTITY };
        let (mut places, mut others) = ([None; 1], [None; 1]);
        let plain = model.place(&world, &camera, &sun, &mut places).expect("enough places");
        let (expected, all) = strips::<Rgb565>(screen, 8, 20_000, Rgb565::BLACK, |scene| plain.draw(scene));
        let mut nodes = [BoundsNode::EMPTY; 36];
        let placed = model.place(&world, &camera, &sun, &mut others).expect("enough places").cull_clusters(&mut nodes);
        let (found, some) = strips::<Rgb565>(screen, 8, 20_000, Rgb565::BLACK, |scene| placed.draw(scene));
        assert_eq!(difference(&found, &expected, screen.0), None, "turn {turn}");
        assert!(some.triangles <= all.triangles);
        fewer += usize::from(some.triangles < all.triangles);
        hidden += all.triangles - some.triangles;
    }
    println!("{fewer} of 24 views with culled clusters, {hidden} triangles in all");
    assert!(fewer >= 20, "only {fewer} of 24 views");
}

/// The clustered tube with its first column of quads alone: one cluster, whose triangles look along z.
fn one_cluster() -> Builder {
    let mut builder = clustered();
    let part = &mut builder.parts[0];
    part.clusters.truncate(1);
    part.triangles.truncate(part.clusters[0].triangles.into());
    builder
}

fn camera_from(model: &Model<'_>, direction: Vec3) -> Camera {
    let (angle, screen) = (Angle16::from_degrees(50), Size::new(96, 72));
    Camera::framing(&model.bounds(), angle, screen, direction).expect("a camera")
}

#[test]
fn a_part_without_visible_clusters_is_no_draw() {
    let container = one_cluster().build();
    let model = Model::from_bytes(container.bytes()).expect("a model");
    let sun = Sun::new(Vec3::from_ints(4, 7, 6), Rgb888::WHITE, Rgb888::BLUE);
    let mut places = [None; 1];
    for (direction, draws) in [(Vec3::Z, 1), (-Vec3::Z, 0)] {
        let camera = camera_from(&model, direction);
        let placed = model.place(&Affine::IDENTITY, &camera, &sun, &mut places).expect("enough places");
        let mut nodes = [BoundsNode::EMPTY; 1];
        let placed = placed.cull_clusters(&mut nodes);
        let parts: Vec<_> = placed.draws().map(|(_, part)| part).collect();
        assert_eq!(parts, vec![0; draws], "from {direction:?}");
    }
}

#[test]
fn nodes_that_are_lent_anew_replace_those_before() {
    let container = clustered().build();
    let model = Model::from_bytes(container.bytes()).expect("a model");
    let sun = Sun::new(Vec3::from_ints(4, 7, 6), Rgb888::WHITE, Rgb888::BLUE);
    let camera = camera_from(&model, Vec3::from_ints(2, 1, 3));
    let (mut places, mut others) = ([None; 1], [None; 1]);
    let plain = model.place(&Affine::IDENTITY, &camera, &sun, &mut places).expect("enough places");
    let (expected, _) = strips::<Rgb565>((96, 72), 8, 20_000, Rgb565::BLACK, |scene| plain.draw(scene));
    let placed = model.place(&Affine::IDENTITY, &camera, &sun, &mut others).expect("enough places");
    // The second list is too short for the part, so that all of it is drawn.
    let (mut nodes, mut few) = ([BoundsNode::EMPTY; 36], [BoundsNode::EMPTY; 3]);
    let placed = placed.cull_clusters(&mut nodes).cull_clusters(&mut few);
    let (found, _) = strips::<Rgb565>((96, 72), 8, 20_000, Rgb565::BLACK, |scene| placed.draw(scene));
    assert_eq!(difference(&found, &expected, 96), None);
}

#[test]
fn clusters_at_the_ends_of_numbers_are_not_culled_by_mistake() {
    let sun = Sun::new(Vec3::from_ints(4, 7, 6), Rgb888::WHITE, Rgb888::BLUE);
    let screen = Size::new(96, 72);
    let lens =
        Projective::perspective(Angle16::from_degrees(40), screen, Scalar::from_num(20), Scalar::from_num(32_000));
    let lens = lens.expect("a lens");
    let (mut rng, mut seen, mut fewer) = (Rng::new(9), 0, 0);
    for round in 0..400_usize {
        // A tube of some thousand units to each side, at a quarter of its size, far to one side of the origin; the eye
        // is far to the other side. So they are farther from each other than numbers reach.
        let mut builder = clustered();
        let side = if round % 2 == 0 { 1 } else { -1 };
        let mut offset: [i32; 3] = core::array::from_fn(|_| (rng.signed_bits(17) as i32 % 28_000) << 16);
        offset[round % 3] = (side * 28_000) << 16;
        (builder.parts[0].item.offset, builder.parts[0].item.scale) = (offset, 4000 << 16);
        let container = builder.build();
        let model = Model::from_bytes(container.bytes()).expect("a model");
        let world = Affine::scale(Scalar::from_num(0.25));
        let target = world.transform_point(Vec3::from_bits(offset));
        let mut eye = core::array::from_fn(|_| (rng.signed_bits(15) as i32 % 8000) << 16);
        eye[round % 3] = (-side * 8000) << 16;
        let eye = Vec3::from_bits(eye);
        let Ok(view) = Affine::look_at(eye, target, Vec3::Y) else { continue };
        let camera = Camera { lens, view, screen };
        let (mut places, mut others, mut nodes) = ([None; 1], [None; 1], [BoundsNode::EMPTY; 36]);
        let plain = model.place(&world, &camera, &sun, &mut places).expect("enough places");
        let (expected, all) = strips::<Rgb565>((96, 72), 24, 20_000, Rgb565::BLACK, |scene| plain.draw(scene));
        let placed = model.place(&world, &camera, &sun, &mut others).expect("enough places").cull_clusters(&mut nodes);
        let (found, some) = strips::<Rgb565>((96, 72), 24, 20_000, Rgb565::BLACK, |scene| placed.draw(scene));
        assert_eq!(difference(&found, &expected, 96), None, "round {round}, seed 9: {offset:?} from {eye:?}");
        seen += usize::from(all.drawn > 20);
        fewer += usize::from(some.triangles < all.triangles);
    }
    println!("{seen} of 400 tubes seen, {fewer} of them with culled clusters");
    assert!(seen > 200 && fewer > 200, "{seen} {fewer}");
}
