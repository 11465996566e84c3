//! Draws a container as firmware would: `cargo run --example picture -- MODEL.zstm OUT.png [CLIP MILLISECONDS]`.

use std::error::Error;

use zstrip::bytemuck::{cast_slice, pod_collect_to_vec};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::frame::FramebufferRenderer;
use zstrip::math::{Affine, Angle16, Vec3};
use zstrip::model::{Camera, Model, Pose};
use zstrip::target::FrameSlice;

const SCREEN: Size = Size::new(240, 320);
const PIXELS: usize = 240 * 320;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [container, picture, rest @ ..] = &arguments[..] else {
        return Err("MODEL.zstm and OUT.png are missing".into());
    };
    let mut bytes = std::fs::read(container)?;
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let words: Vec<u32> = pod_collect_to_vec(&bytes);
    let bytes = cast_slice(&words);
    let model = Model::from_bytes(bytes)?;
    let mut memory = vec![0; Pose::words(bytes)];
    let mut pose = model.pose(&mut memory)?;
    let mut bounds = model.bounds();
    if let [clip, time] = rest {
        let clip = model.clip_named(clip).or_else(|| model.clip(clip.parse().ok()?)).ok_or("no such clip")?;
        pose.play(clip.looped(time.parse()?));
        bounds = clip.bounds();
    }
    let camera = Camera::framing(&bounds, Angle16::from_degrees(40), SCREEN, Vec3::from_ints(3, 2, 5))?;
    let sun = zstrip::light::Sun::new(Vec3::from_ints(2, 4, 5), Rgb888::new(200, 200, 190), Rgb888::new(70, 70, 80));
    let mut places = vec![None; Model::draws(bytes)];
    let placed = pose.place(&Affine::IDENTITY, &camera, &sun, &mut places)?;
    let (mut color, mut depth) = (vec![0; PIXELS], vec![0; PIXELS]);
    let mut frame = FrameSlice::<Rgb565>::new(&mut color, SCREEN)?;
    let mut renderer = FramebufferRenderer::new(SCREEN)?.with_depth(&mut depth)?;
    renderer.frame(&mut frame, Rgb565::new(4, 10, 8), |scene| placed.draw(scene))?;
    let mut image = image::RgbImage::new(SCREEN.width, SCREEN.height);
    for (pixel, color) in image.pixels_mut().zip(&color) {
        let color = Rgb888::from(Rgb565::new((color >> 11) as u8, (color >> 5 & 63) as u8, (color & 31) as u8));
        pixel.0 = [color.r(), color.g(), color.b()];
    }
    image.save(picture)?;
    println!("{picture}: {} triangles", model.triangle_count());
    Ok(())
}
