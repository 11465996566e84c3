//! A lit cube, one frame of it, drawn in strips of 16 rows straight into a PNG file.
use std::io::Write;
use zstrip::Renderer;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, RgbColor, WebColors};
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

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut color, mut depth, mut records) = ([[0; 3]; 320 * 16], [0; 320 * 16], [0; 256]);
    let renderer = Renderer::<Rgb888>::new(Size::new(320, 240))?;
    let mut renderer = renderer.with_depth(&mut depth)?.with_records(&mut records);

    let camera =
        Projective::perspective(Angle16::from_degrees(45), Size::new(320, 240), Scalar::ONE, Scalar::from_num(20))?;
    let view = Affine::look_at(Vec3::from_ints(2, 3, 4), Vec3::ZERO, Vec3::Y)?;
    let sun = Sun::new(Vec3::from_ints(1, 3, 2), Rgb888::CSS_DARK_GRAY, Rgb888::CSS_DIM_GRAY);
    // Made here: the closure is called for each strip.
    let (mvp, shader) = (camera * view, Flat::new(sun.on(&Material::matte(Rgb888::CSS_ORANGE), &Affine::IDENTITY)));

    let mut png = png::Encoder::new(std::fs::File::create("hello.png")?, 320, 240);
    png.set_color(png::ColorType::Rgb);
    let mut png = png.write_header()?.into_stream_writer()?;
    let to_png = |strip: &StripPixels<Rgb888>| png.write_all(strip.bytes());
    renderer.frame_to(to_png, &mut color, Rgb888::BLACK, |scene| scene.draw(&CUBE, &mvp, &shader))?;
    Ok(png.finish()?)
}
