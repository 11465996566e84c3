//! A first program, with both preludes imported whole.

use embedded_graphics::mock_display::MockDisplay;
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{Circle, PrimitiveStyle};
use zstrip::prelude::*;

static CORNERS: [Vec3; 4] =
    [Vec3::from_ints(0, 1, 0), Vec3::from_ints(-1, -1, 1), Vec3::from_ints(1, -1, 1), Vec3::from_ints(0, -1, -1)];
static TETRAHEDRON: Mesh<'static> = Mesh::constant(MeshData {
    indices: Some(&[0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2]),
    ..MeshData::new(Positions::Exact(&CORNERS))
});
const SCREEN: Size = Size::new(24, 16);

#[test]
fn a_solid_is_drawn_in_a_few_lines_beside_embedded_graphics() {
    // A display that refuses to be drawn on twice, and outside.
    let mut display = MockDisplay::<Rgb565>::new();
    let (mut color, mut depth) = ([0; 24 * 5], [0; 24 * 5]);
    let mut renderer = Renderer::<Rgb565>::new(SCREEN).unwrap().with_depth(&mut depth).unwrap();
    let lens = Projective::perspective(Angle16::from_degrees(60), SCREEN, Scalar::ONE, Scalar::from_num(9)).unwrap();
    let (mvp, shader) = (lens * Affine::translation(Vec3::from_ints(0, 0, -3)), Flat::unlit(Rgb888::WHITE));
    let sun = Circle::new(Point::new(17, 1), 4).into_styled(PrimitiveStyle::with_fill(Rgb565::GREEN));
    let frame = renderer.frame(&mut display, &mut color, Rgb888::BLACK, |scene| {
        scene.draw(&TETRAHEDRON, &mvp, &shader);
        sun.draw(&mut scene.overlay()).unwrap();
    });
    assert!(frame.unwrap().drawn > 0);
    display.assert_pattern(&[
        "KKKKKKKKKKKKKKKKKKKKKKKK",
        "KKKKKKKKKKKKKKKKKKGGKKKK",
        "KKKKKKKKKKKKKKKKKGGGGKKK",
        "KKKKKKKKKKKKKKKKKGGGGKKK",
        "KKKKKKKKKKKWWKKKKKGGKKKK",
        "KKKKKKKKKKKWWKKKKKKKKKKK",
        "KKKKKKKKKKWWWWKKKKKKKKKK",
        "KKKKKKKKKKWWWWKKKKKKKKKK",
        "KKKKKKKKKWWWWWWKKKKKKKKK",
        "KKKKKKKKWWWWWWWWKKKKKKKK",
        "KKKKKKKKWWWWWWWWKKKKKKKK",
        "KKKKKKKWWWWWWWWWWKKKKKKK",
        "KKKKKKKWWWWWWWWWWKKKKKKK",
        "KKKKKKWWWWWWWWWWWWKKKKKK",
        "KKKKKWWWWWWWWWWWWWWKKKKK",
        "KKKKKKKKKKKKKKKKKKKKKKKK",
    ]);
}

/// Each name of both preludes can be used: a glob import of two items of one name is an error where the name is used.
#[test]
fn both_preludes_have_no_name_in_common_but_for_the_same_item() {
    let theirs = "Angle AngleUnit ContainsPoint ContiguousIteratorExt Dimensions DrawTarget DrawTargetExt Drawable \
        GrayColor ImageDrawable ImageDrawableExt IntoStorage OffsetOutline OriginDimensions Pixel PixelColor \
        PixelIteratorExt Point PointsIter Primitive RawData RgbColor Size ToBytes Transform WebColors";
    let items = include_str!("../src/prelude.rs").split("pub use ").skip(1);
    let ours: Vec<_> = items
        .flat_map(|text| text.split(|c: char| !c.is_alphanumeric()))
        .filter(|word| word.starts_with(char::is_uppercase))
        .collect();
    assert!(ours.contains(&"Mesh") && ours.len() > 25, "{ours:?}");
    let both: Vec<_> = theirs.split_whitespace().filter(|name| ours.contains(name)).collect();
    // Compiles only if they are one item.
    fn same<D: zstrip::prelude::DrawTarget + embedded_graphics::draw_target::DrawTarget>() {}
    same::<MockDisplay<Rgb565>>();
    let _: (Point, Size, Angle) = (zstrip::prelude::Point::zero(), zstrip::prelude::Size::zero(), 90.0.deg());
    assert_eq!(both, ["DrawTarget", "Point", "RgbColor", "Size", "WebColors"]);
    assert_eq!((Rgb888::RED, Rgb888::CSS_RED), (Rgb888::new(255, 0, 0), Rgb888::new(255, 0, 0)));
}
