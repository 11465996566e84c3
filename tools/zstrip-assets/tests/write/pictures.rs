//! The picture of a container beside that of the import, drawn by the float reference without a clipper.

use zstrip::bytemuck::{cast_slice, pod_collect_to_vec};
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};
use zstrip::frame::FramebufferRenderer;
use zstrip::light::Sun;
use zstrip::math::{Affine, Angle16, Vec3};
use zstrip::model::{Camera, Model};
use zstrip::target::FrameSlice;
use zstrip_assets::{AlphaMode, Import, Wrap, WriteNote, WriteOptions, Written, write};

use crate::figures::{image, sphere, textured};
use crate::reference::frame::{Cull, Frame};
use crate::reference::homogeneous::{self, Vertex, Viewport};

const SIZE: Size = Size::new(160, 120);
const BRIGHT: f64 = 200.0 / 255.0;
const DIM: f64 = 50.0 / 255.0;

/// Draws a container, and returns colours of 0 to 1 and the camera.
fn drawn(bytes: &[u8]) -> (Vec<[f64; 3]>, Camera) {
    let mut padded = bytes.to_vec();
    padded.resize(bytes.len().next_multiple_of(4), 0);
    let words: Vec<u32> = pod_collect_to_vec(&padded);
    let model = Model::from_bytes(cast_slice(&words)).expect("a model");
    let camera = Camera::framing(&model.bounds(), Angle16::from_degrees(40), SIZE, Vec3::from_ints(2, 1, 3));
    let camera = camera.expect("a camera");
    let gray = |part: f64| Rgb888::new((part * 255.0) as u8, (part * 255.0) as u8, (part * 255.0) as u8);
    let sun = Sun::new(Vec3::from_ints(0, 3, 4), gray(BRIGHT), gray(DIM));
    let mut places = [None; 4];
    let placed = model.place(&Affine::IDENTITY, &camera, &sun, &mut places).expect("places");
    let pixels = (SIZE.width * SIZE.height) as usize;
    let (mut color, mut depth) = (vec![<Rgb888 as PixelFormat>::pack([0; 3]); pixels], vec![0; pixels]);
    let mut frame = FrameSlice::<Rgb888>::new(&mut color, SIZE).expect("a framebuffer");
    let mut renderer = FramebufferRenderer::new(SIZE).expect("a renderer").with_depth(&mut depth).expect("depth");
    renderer.frame(&mut frame, Rgb888::BLACK, |scene| placed.draw(scene)).expect("a frame");
    let unpacked = color.iter().map(|raw| {
        let color = <Rgb888 as PixelFormat>::to_color(*raw);
        [color.r(), color.g(), color.b()].map(|c| f64::from(c) / 255.0)
    });
    (unpacked.collect(), camera)
}

/// Draws the import itself: texels by its texture coordinates, light by its normals. Pixels that are nearer than `near`
/// texels to the border of a texel get no colour.
fn reference(import: &Import, camera: &Camera, near: f64) -> Frame {
    let mut frame = Frame::new(SIZE.width, SIZE.height, [0.0; 3]);
    let viewport = Viewport::new(SIZE.width, SIZE.height);
    let rows = camera.lens.compose_affine(&camera.view).to_rows().map(|row| row.map(|c| c as f64 / 4_294_967_296.0));
    let (mesh, image) = (&import.meshes[0], &import.images[0]);
    for (number, triangle) in mesh.triangles.iter().enumerate() {
        let corners = triangle.map(|v| {
            let v = v as usize;
            let [x, y, z] = mesh.vertices.positions[v].map(f64::from);
            let n = mesh.vertices.normals[v].map(f64::from);
            let lit = DIM + BRIGHT * (0.6 * n[1] + 0.8 * n[2]).max(0.0);
            let light = if import.materials[0].unlit { 1.0 } else { lit };
            let [s, t] = mesh.vertices.uvs[v].map(f64::from);
            let position = rows.map(|[a, b, c, d]| a * x + b * y + c * z + d);
            Vertex { position, attributes: [s, t, light.min(1.0)] }
        });
        homogeneous::draw(&mut frame, &viewport, Cull::Back, &corners, number as u32 + 1, |sample| {
            let [s, t, _] = sample.perspective;
            let place = [s * f64::from(image.width), t * f64::from(image.height)];
            if place.iter().any(|c| (c - c.round()).abs() < near) {
                return [f64::NAN; 3];
            }
            // Beyond its sides, the texture goes on as the import says. The container has to show that by other means.
            let wrap = import.materials[0].texture.expect("a texture").wrap;
            let [x, y] = [0, 1].map(|k| match wrap[k] {
                Wrap::Repeat => place[k].floor().rem_euclid(8.0) as usize,
                Wrap::Clamp => place[k].floor().clamp(0.0, 7.0) as usize,
                Wrap::Mirror => {
                    let texel = place[k].floor().rem_euclid(16.0);
                    texel.min(15.0 - texel) as usize
                }
            });
            let texel = &image.texels[4 * (y * 8 + x)..];
            std::array::from_fn(|k| f64::from(texel[k]) / 255.0 * sample.linear[2])
        });
    }
    frame
}

#[test]
fn a_container_looks_like_the_model_that_was_read() {
    let import = textured(sphere(24, 16, 1.3), image(), AlphaMode::Opaque);
    compare(&import, &written(&import), 0.02, 3000);
}

fn written(import: &Import) -> Written {
    write(import, &WriteOptions { mips: false, ..WriteOptions::default() }).expect("a container")
}

#[test]
fn a_clamped_texture_goes_on_with_its_border_within_triangles() {
    let mut import = textured(sphere(8, 6, 1.3), image(), AlphaMode::Opaque);
    // Light would be that of more vertices than the import has.
    import.materials[0].unlit = true;
    import.materials[0].texture.as_mut().expect("a texture").wrap = [Wrap::Clamp; 2];
    // No vertex is nearer than half a texel to a side, so triangles that are not cut keep their coordinates.
    import.meshes[0].vertices.uvs.iter_mut().for_each(|[u, v]| (*u, *v) = (2.1 * *u - 0.4, 2.1 * *v - 0.5));
    let written = written(&import);
    let notes = &written.report.notes[..];
    assert!(matches!(notes, [WriteNote::Cut { triangles: 20.., .. }]), "{}", written.report);
    // Where triangles are this large, the library is within a sixteenth of a texel.
    compare(&import, &written, 0.0625 + 0.02, 2500);
}

/// Compares the picture of a container with that of the import.
fn compare(import: &Import, written: &Written, near: f64, least: usize) {
    let (found, camera) = drawn(&written.bytes);
    let expected = reference(import, &camera, near);
    let (mut compared, mut worst) = (0, 0.0_f64);
    for (index, found) in found.iter().enumerate() {
        // Positions are off by 1/100 px at most, and the colours of two neighbours by a level or two.
        let color = expected.color[index];
        if !expected.is_clear_cut(index, 0.02, 1e-4) || color[0].is_nan() {
            continue;
        }
        compared += usize::from(expected.id[index] > 0);
        let off = found.iter().zip(color).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        worst = worst.max(off);
        let (x, y) = (index % SIZE.width as usize, index / SIZE.width as usize);
        assert!(off < 5.0 / 255.0, "pixel ({x}, {y}) is {found:?}, expected {color:?}");
    }
    println!("{compared} pixels of the model compared, off by {:.2} of 255", worst * 255.0);
    assert!(compared > least, "{compared}");
}
