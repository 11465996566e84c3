//! A turning cube in a window, in one file to copy: Esc ends it. Needs a display.
//!
//! ```text
//! cargo run --release --example window
//! ```
use minifb::{Key, Scale, Window, WindowOptions};
use std::convert::Infallible;
use zstrip::Renderer;
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor, WebColors};
use zstrip::light::{Material, Sun};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
use zstrip::shader::Flat;
use zstrip::target::StripPixels;

#[rustfmt::skip]
static CUBE: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    indices: Some(&[0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7]),
    ..MeshData::new(Positions::Exact(&[
        Vec3::from_ints(-1, -1, -1), Vec3::from_ints(1, -1, -1), Vec3::from_ints(1, 1, -1), Vec3::from_ints(-1, 1, -1),
        Vec3::from_ints(-1, -1, 1), Vec3::from_ints(1, -1, 1), Vec3::from_ints(1, 1, 1), Vec3::from_ints(-1, 1, 1),
    ]))
});

const SCREEN: Size = Size::new(320, 240);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let options = WindowOptions { scale: Scale::X2, ..WindowOptions::default() };
    let mut window = Window::new("zstrip", SCREEN.width as usize, SCREEN.height as usize, options)?;
    window.set_target_fps(60);

    let (mut color, mut depth, mut records) = ([0; 320 * 16], [0; 320 * 16], [0; 256]);
    let mut renderer = Renderer::<Rgb565>::new(SCREEN)?.with_depth(&mut depth)?.with_records(&mut records);

    let camera = Projective::perspective(Angle16::from_degrees(45), SCREEN, Scalar::ONE, Scalar::from_num(20))?;
    let view = Affine::look_at(Vec3::from_ints(2, 3, 4), Vec3::ZERO, Vec3::Y)?;
    let sun = Sun::new(Vec3::from_ints(1, 3, 2), Rgb888::CSS_DARK_GRAY, Rgb888::CSS_DIM_GRAY);
    let orange = Material::matte(Rgb888::CSS_ORANGE);

    let mut turn = Angle16(0);
    while window.is_open() && !window.is_key_down(Key::Escape) {
        turn = Angle16(turn.0.wrapping_add(256));
        // Made once per frame, outside of the closure: the closure is called for each strip.
        let model = Affine::rotation_y(turn);
        let (mvp, shader) = (camera * (view * model), Flat::new(sun.on(&orange, &model)));

        let mut picture = Vec::new();
        let to_picture = |strip: &StripPixels<'_, Rgb565>| {
            picture.extend(strip.pixels().iter().map(|pixel| {
                let [r, g, b] = Rgb565::unpack(*pixel);
                u32::from_be_bytes([0, r, g, b])
            }));
            Ok::<(), Infallible>(())
        };
        renderer.frame_to(to_picture, &mut color, Rgb565::BLACK, |scene| scene.draw(&CUBE, &mvp, &shader))?;
        window.update_with_buffer(&picture, SCREEN.width as usize, SCREEN.height as usize)?;
    }
    Ok(())
}
