//! Without a depth buffer, every depth test passes: the picture is that of draws with the test switched off.

use crate::reference::rng::Rng;
use crate::scenes;
use crate::scenes::{Draw, Intersections};
use crate::support::{Soup, difference, strips};
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565, Rgb888, RgbColor, WebColors};
use zstrip::embedded_graphics_core::primitives::Rectangle;
use zstrip::frame::{FramebufferRenderer, RamBudget, Renderer};
use zstrip::math::{Affine, Angle16, Pixels, Projective, Scalar, Vec3};
use zstrip::mesh::{LineTopology, Lines, Mesh, MeshData, Points, Vertices};
use zstrip::shader::{Flat, Gouraud};
use zstrip::span::{DepthState, Shader};
use zstrip::target::{Depthless, FrameSlice, Strip, StripPixels};
use zstrip::target::{WithRecords, WithoutDepth};
use zstrip::{Cull, Dashed, Framebuffer, Scene, ScreenPoint, Smooth, State, Thin};

const SCREEN: (u16, u16) = (77, 50);

/// Draws a frame into strips of `rows` rows without a depth buffer.
fn without_depth<P: PixelFormat>(
    rows: usize,
    records: usize,
    background: P::Color,
    draw: impl FnMut(&mut Scene<'_, Strip<'_, P, WithoutDepth, WithRecords>>),
) -> Vec<P::Raw> {
    let mut color = vec![P::pack([0x5A; 3]); usize::from(SCREEN.0) * rows];
    let mut records = vec![0; records];
    let screen = Size::new(SCREEN.0.into(), SCREEN.1.into());
    let mut renderer = Renderer::<P>::new(screen).expect("a renderer").with_records(&mut records);
    assert_eq!(renderer.strip_rows(color.len()) as usize, rows.min(usize::from(SCREEN.1)), "colours alone decide");
    let mut picture = Vec::new();
    let sink = |strip: &StripPixels<'_, P>| {
        picture.extend_from_slice(strip.pixels());
        Ok::<(), core::convert::Infallible>(())
    };
    renderer.frame_to(sink, &mut color, background, draw).expect("the same scene in each call");
    picture
}

fn draw<F: Framebuffer>(scene: &mut Scene<'_, F>, mesh: &Mesh<'_>, depth: DepthState)
where
    Gouraud: Shader<F::Format>,
    Flat: Shader<F::Format>,
{
    let state = State { cull: Cull::None, depth, ..State::DEFAULT };
    let mvp = &Projective::IDENTITY;
    scene.draw_with(state, mesh, mvp, &Gouraud::vertex_colors());
    let turned = Projective::from(Affine::rotation_z(Angle16(9999)));
    scene.draw_with(state, mesh, &turned, &Flat::unlit(Rgb888::CSS_CORAL));
    let turned = Projective::from(Affine::rotation_z(Angle16(40_000)));
    scene.draw_with(state, mesh, &turned, &Gouraud::vertex_colors());
    // Lines, points and shapes on the screen.
    let MeshData { positions, normals, colors, uvs, .. } = *mesh.data();
    let data = Vertices { positions, normals, colors, uvs, bounds: None };
    let lines = Lines::new(data, LineTopology::Strip, None).expect("vertices are lines");
    scene.draw_lines_with(state, &lines, mvp, &Gouraud::vertex_colors(), &Thin);
    scene.draw_lines_with(state, &lines, mvp, &Flat::unlit(Rgb888::CSS_TEAL), &Dashed(0xF0F0_3333));
    scene.draw_lines_with(state, &lines, &turned, &Flat::unlit(Rgb888::CSS_GOLD), &Smooth::px(2));
    let points = Points::new(data).expect("vertices are points");
    scene.draw_points_with(state, &points, &turned, &Gouraud::vertex_colors(), Pixels::from_bits(700));
    let mut canvas = scene.canvas();
    canvas.set_depth(9000, depth);
    canvas.rectangle(&Rectangle::new(Point::new(50, 3), Size::new(9, 40)), Rgb888::CSS_PLUM);
    canvas.line(ScreenPoint::center(-3, 40), ScreenPoint::center(70, 9), Rgb888::WHITE);
    canvas.polygon(&[(4, 30), (20, 32), (9, 49)].map(|(x, y)| ScreenPoint::corner(x, y)), Rgb888::CSS_PERU);
}

fn check<P: PixelFormat>(background: P::Color)
where
    P::Raw: PartialEq + std::fmt::Debug,
    Gouraud: Shader<P>,
    Flat: Shader<P>,
{
    let mut varied = 0;
    for seed in 0..20 {
        let mut rng = Rng::new(seed);
        let soup = Soup::new(&mut rng, 12);
        let mesh = soup.mesh();
        let (expected, _) = strips::<P>(SCREEN, 50, 20_000, background, |s| draw(s, &mesh, DepthState::OFF));
        for (rows, records) in [(50, 20_000), (50, 0), (7, 20_000), (7, 300), (1, 0)] {
            for depth in [DepthState::OFF, DepthState::LESS] {
                let picture = without_depth::<P>(rows, records, background, |s| draw(s, &mesh, depth));
                let found = difference(&picture, &expected, SCREEN.0);
                assert_eq!(found, None, "seed {seed}, {rows} rows, {records} records, {depth:?}");
            }
            if records == 0 {
                let mut color = vec![P::pack([0x5A; 3]); usize::from(SCREEN.0) * rows];
                let mut renderer = Renderer::<P>::new(Size::new(SCREEN.0.into(), SCREEN.1.into())).expect("a renderer");
                let mut picture = Vec::new();
                let sink = |strip: &StripPixels<'_, P>| {
                    picture.extend_from_slice(strip.pixels());
                    Ok::<(), core::convert::Infallible>(())
                };
                renderer.frame_to(sink, &mut color, background, |s| draw(s, &mesh, DepthState::LESS)).expect("a frame");
                let found = difference(&picture, &expected, SCREEN.0);
                assert_eq!(found, None, "seed {seed}, {rows} rows, colours only");
            }
        }
        varied += usize::from(expected.iter().any(|p| *p != expected[0]));
    }
    assert!(varied > 15, "only {varied} pictures show more than one colour");
}

#[test]
fn frame_without_depth_buffer_is_the_frame_without_depth_tests() {
    check::<Rgb565>(Rgb565::BLUE);
    check::<Gray8>(Gray8::new(40));
}

#[test]
fn framebuffer_needs_no_depth_either() {
    let soup = Soup::new(&mut Rng::new(3), 12);
    let mesh = soup.mesh();
    let (expected, _) = strips::<Rgb565>(SCREEN, 50, 20_000, Rgb565::BLUE, |s| draw(s, &mesh, DepthState::OFF));
    let mut pixels = vec![0; 77 * 50];
    let mut framebuffer = Depthless(FrameSlice::<Rgb565>::new(&mut pixels, Size::new(77, 50)).expect("a framebuffer"));
    let mut renderer = FramebufferRenderer::new(Size::new(SCREEN.0.into(), SCREEN.1.into())).expect("a renderer");
    let stats = renderer.frame(&mut framebuffer, Rgb565::BLUE, |s| draw(s, &mesh, DepthState::LESS));
    assert_eq!(stats.expect("the same scene").strips, 1, "nothing limits the strip");
    assert_eq!(difference(&pixels, &expected, SCREEN.0), None);
}

/// A body that is convex, but for its open ends.
fn pillar<F: Framebuffer>(scene: &mut Scene<'_, F>)
where
    Flat: Shader<F::Format>,
{
    let mvp = scenes::camera(Size::new(SCREEN.0.into(), SCREEN.1.into()), Scalar::ONE, Scalar::ONE * 20)
        * (Affine::translation(Vec3::from_ints(0, 0, -3)) * Affine::rotation_y(Angle16(5000)));
    scene.draw(&scenes::polygons::PILLAR, &mvp, &Flat::new(scenes::LIT_COLORS));
}

#[test]
fn convex_body_needs_no_depth() {
    // Squares through one another do need depth.
    let squares = Intersections::new(Size::new(SCREEN.0.into(), SCREEN.1.into()), Angle16(9000));
    let (deep, _) = strips::<Rgb565>(SCREEN, 50, 20_000, scenes::BACKGROUND, |s| squares.draw(s));
    let flat = without_depth::<Rgb565>(50, 20_000, scenes::BACKGROUND, |s| squares.draw(s));
    assert_ne!(difference(&flat, &deep, SCREEN.0), None);
    let (deep, _) = strips::<Rgb565>(SCREEN, 50, 20_000, scenes::BACKGROUND, |s| {
        pillar(s);
    });
    let flat = without_depth::<Rgb565>(9, 20_000, scenes::BACKGROUND, |s| {
        pillar(s);
    });
    assert_eq!(difference(&flat, &deep, SCREEN.0), None);
    assert!(deep.iter().any(|p| *p != deep[0]), "an empty picture");
}

#[test]
fn budget_without_depth_is_that_of_the_colours() {
    const RAM: RamBudget = RamBudget::new::<Rgb565>(320, 16).without_depth();
    assert_eq!(RAM.total(), 320 * 16 * 2);
}
