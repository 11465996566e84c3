//! Clusters: what they cull is out of sight.

use super::figures::clustered;
use super::support::{difference, strips};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::light::Sun;
use zstrip::math::{Affine, Angle16, Scalar, Vec3};
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
