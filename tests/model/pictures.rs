//! Pictures of models beside those of draws by hand, and in every way to draw a frame.

use super::builder::{Builder, material};
use super::figures::{SCALE, animated, many_parts, textured};
use crate::support::{difference, strips, unrecorded_strips, whole};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{IntoStorage, Rgb565, Rgb888, RgbColor};
use zstrip::light::{DirectionalLight, Lighting, Material, Matte, Sun};
use zstrip::math::{Affine, Angle16, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::model::container::{AlphaMode, Material as MaterialItem, TextureFormat};
use zstrip::model::{Camera, Model, Pose, decode_normal};
use zstrip::scene::State;
use zstrip::shader::{Blend, Flat, Gouraud, Opacity, Textured};
use zstrip::span::DepthState;
use zstrip::texture::{Image, Rgb565LeTexel};

const SCREEN: (u16, u16) = (120, 90);

fn camera(model: &Model<'_>) -> Camera {
    let screen = Size::new(SCREEN.0.into(), SCREEN.1.into());
    let mut bounds = model.bounds();
    bounds.half = Vec3::from_ints(2, 2, 2);
    Camera::framing(&bounds, Angle16::from_degrees(45), screen, Vec3::from_ints(2, 1, 3)).expect("a camera")
}

fn sun() -> Sun {
    Sun::new(Vec3::from_ints(4, 7, 6), Rgb888::new(220, 210, 200), Rgb888::new(60, 60, 70))
}

fn world() -> Affine {
    Affine::rotation_z(Angle16::from_degrees(20)) * Affine::scale(Scalar::from_num(0.8))
}

/// The slices of a part's mesh, unpacked.
struct Slices {
    normals: Vec<[i16; 3]>,
    uvs: Vec<[Scalar; 2]>,
}

impl Slices {
    fn of(builder: &Builder) -> Self {
        let part = &builder.parts[0];
        let uvs = part.uvs.iter().map(|uv| uv.map(|c| Scalar::from_bits(c.into()))).collect();
        Self { normals: part.normals.iter().map(|n| decode_normal(*n)).collect(), uvs }
    }

    fn mesh<'s>(&'s self, builder: &'s Builder) -> Mesh<'s> {
        let part = &builder.parts[0];
        let positions =
            Positions::Quantized { points: &part.points, scale: Scalar::from_bits(SCALE), offset: Vec3::ZERO };
        Mesh::new(MeshData {
            indices: Some(part.triangles.as_flattened()),
            normals: if self.normals.is_empty() { None } else { Some(&self.normals) },
            colors: if part.colors.is_empty() { None } else { Some(&part.colors) },
            uvs: Some(&self.uvs),
            ..MeshData::new(positions)
        })
        .expect("a mesh")
    }
}

#[test]
fn a_textured_model_is_the_mesh_with_its_shader() {
    let mut builder = textured();
    builder.textures[0].levels = 1;
    let (container, slices) = (builder.clone().build(), Slices::of(&builder));
    let (model, mesh) = (Model::from_bytes(container.bytes()).expect("a model"), slices.mesh(&builder));
    let image = Image::new(&builder.bytes[..512], Size::new(16, 16), Rgb565LeTexel).expect("an image");
    let (camera, world) = (camera(&model), world());
    let mvp = camera.lens * (camera.view * world);
    let lighting = Lighting::directional(
        Rgb888::new(50, 50, 50),
        [DirectionalLight::new(Vec3::from_ints(1, 2, 3), Rgb888::new(200, 190, 180))],
    );
    let mut places = [None; 1];

    let placed = model.place(&world, &camera, &sun(), &mut places).expect("enough places");
    let (found, stats) = strips::<Rgb565>(SCREEN, 8, 20_000, Rgb565::BLACK, |scene| placed.draw(scene));
    let shader = Textured::new(&image).lit(sun().on(&Matte::WHITE, &world));
    let (expected, _) = strips::<Rgb565>(SCREEN, 8, 20_000, Rgb565::BLACK, |scene| scene.draw(&mesh, &mvp, &shader));
    assert!(stats.drawn > 80, "{stats:?}");
    assert_eq!(difference(&found, &expected, SCREEN.0), None, "under a sun");

    let mut places = [None; 1];
    let placed = model.place(&world, &camera, &lighting, &mut places).expect("enough places");
    let (found, _) = strips::<Rgb565>(SCREEN, 8, 20_000, Rgb565::BLACK, |scene| placed.draw(scene));
    let shader = Textured::new(&image).lit(lighting.on(Matte::WHITE, &world, mesh.bounds()));
    let (expected, _) = strips::<Rgb565>(SCREEN, 8, 20_000, Rgb565::BLACK, |scene| scene.draw(&mesh, &mvp, &shader));
    assert_eq!(difference(&found, &expected, SCREEN.0), None, "under lighting");
}

#[test]
fn a_model_of_vertex_colors_is_the_mesh_with_its_shader() {
    let mut builder = textured();
    builder.materials[0].texture = u16::MAX;
    builder.materials[0].color = [250, 200, 240, 255];
    builder.parts[0].colors = (0..169).map(|k| [k as u8, 255 - k as u8, 99]).collect();
    let (container, slices) = (builder.clone().build(), Slices::of(&builder));
    let (model, mesh) = (Model::from_bytes(container.bytes()).expect("a model"), slices.mesh(&builder));
    let (camera, world) = (camera(&model), world());
    let mvp = camera.lens * (camera.view * world);
    let mut places = [None; 1];
    let placed = model.place(&world, &camera, &sun(), &mut places).expect("enough places");
    let (found, _) = strips::<Rgb565>(SCREEN, 30, 0, Rgb565::BLACK, |scene| placed.draw(scene));
    let surface = sun().on(&Material::matte(Rgb888::new(250, 200, 240)).vertex_colors(), &world);
    let shader = Gouraud::new(surface);
    let (expected, _) = strips::<Rgb565>(SCREEN, 30, 0, Rgb565::BLACK, |scene| scene.draw(&mesh, &mvp, &shader));
    assert_eq!(difference(&found, &expected, SCREEN.0), None);
}

#[test]
fn a_posed_model_is_its_mesh_with_the_shader() {
    let builder = animated(true);
    let container = builder.clone().build();
    let model = Model::from_bytes(container.bytes()).expect("a model");
    let mut memory = vec![0; Pose::words(container.bytes())];
    let mut pose = model.pose(&mut memory).expect("enough words");
    pose.play(model.clip_named("bend").expect("a clip").looped(450));
    let (camera, world) = (camera(&model), world());
    let mut places = [None; 1];
    let placed = pose.place(&world, &camera, &sun(), &mut places).expect("enough places");
    let (found, _) = strips::<Rgb565>(SCREEN, 8, 20_000, Rgb565::BLACK, |scene| placed.draw(scene));
    let slices = Slices::of(&builder);
    let posed = pose.mesh(0).expect("a part");
    let mesh = Mesh::new(MeshData { uvs: Some(&slices.uvs), ..*posed.data() }).expect("a mesh");
    let image = Image::new(&builder.bytes[..512], Size::new(16, 16), Rgb565LeTexel).expect("an image");
    let mvp = camera.lens * (camera.view * world);
    let shader = Textured::new(&image).lit(sun().on(&Matte::WHITE, &world));
    let (expected, _) = strips::<Rgb565>(SCREEN, 8, 20_000, Rgb565::BLACK, |scene| scene.draw(&mesh, &mvp, &shader));
    assert_eq!(difference(&found, &expected, SCREEN.0), None);
    // It has moved.
    let mut places = [None; 1];
    let placed = model.place(&world, &camera, &sun(), &mut places).expect("enough places");
    let (rest, _) = strips::<Rgb565>(SCREEN, 8, 20_000, Rgb565::BLACK, |scene| placed.draw(scene));
    assert!(difference(&found, &rest, SCREEN.0).is_some());
}

#[test]
fn every_way_to_draw_a_frame_gives_one_picture() {
    for (name, builder) in [("animated", animated(true)), ("many parts", many_parts())] {
        let container = builder.build();
        let model = Model::from_bytes(container.bytes()).expect("a model");
        let mut memory = vec![0; Pose::words(container.bytes())];
        let mut pose = model.pose(&mut memory).expect("enough words");
        if let Some(clip) = model.clip(1) {
            pose.play(clip.looped(300));
        }
        let mut camera = camera(&model);
        if name == "many parts" {
            camera.view = Affine::translation(Vec3::from_ints(-3, 0, -2)) * camera.view;
        }
        let mut places = vec![None; Model::draws(container.bytes())];
        let placed = pose.place(&world(), &camera, &sun(), &mut places).expect("enough places");
        let (picture, _, stats) = whole::<Rgb565>(SCREEN, Rgb565::BLUE, |scene| placed.draw(scene));
        assert!(stats.drawn > 80, "{name}: {stats:?}");
        for (rows, records) in [(90, 0), (8, 1 << 16), (8, 3000), (7, 0), (1, 1 << 16), (30, 700)] {
            let (found, _) = strips::<Rgb565>(SCREEN, rows, records, Rgb565::BLUE, |scene| placed.draw(scene));
            assert_eq!(difference(&found, &picture, SCREEN.0), None, "{name}, {rows} rows, {records} words");
        }
        let (found, _) = unrecorded_strips::<Rgb565>(SCREEN, 9, Rgb565::BLUE, |scene| placed.draw(scene));
        assert_eq!(difference(&found, &picture, SCREEN.0), None, "{name}, without records");
    }
}

/// Returns the picture of a model at rest before blue.
fn picture(builder: &Builder) -> Vec<u16> {
    let container = builder.clone().build();
    let model = Model::from_bytes(container.bytes()).expect("a model");
    let (camera, mut places) = (camera(&model), vec![None; Model::draws(container.bytes())]);
    let placed = model.place(&world(), &camera, &sun(), &mut places).expect("enough places");
    strips::<Rgb565>(SCREEN, 30, 20_000, Rgb565::BLUE, |scene| placed.draw(scene)).0
}

/// A textured tube with steps of alpha.
fn with_alpha(mode: AlphaMode) -> Builder {
    let mut builder = textured();
    builder.textures[0].levels = 1;
    let alpha: Vec<u8> = (0..16 * 8).map(|k: usize| (k * 37 % 256) as u8).collect();
    builder.textures[0].alpha = builder.data(&alpha);
    builder.materials[0].alpha_mode = mode as u8;
    builder
}

#[test]
fn opaque_parts_ignore_alpha() {
    let mut opaque = with_alpha(AlphaMode::Opaque);
    opaque.materials[0].color[3] = 0;
    let mut plain = opaque.clone();
    plain.textures[0].alpha = u32::MAX;
    let expected = picture(&plain);
    assert!(expected.iter().filter(|pixel| **pixel != Rgb565::BLUE.into_storage()).count() > 500);
    assert_eq!(difference(&picture(&opaque), &expected, SCREEN.0), None, "RGB565");
    // A mask is white all over then, as a palette of white is.
    let format = |format: TextureFormat| {
        let mut builder = plain.clone();
        builder.textures[0].palette = builder.data(&[255; 6]);
        (builder.textures[0].format, builder.textures[0].colors) = (format as u8, 2);
        builder
    };
    let (mask, white) = (picture(&format(TextureFormat::Mask)), picture(&format(TextureFormat::Palette1)));
    assert_eq!(difference(&mask, &white, SCREEN.0), None, "mask");
    // Alpha beside a palette.
    let mut palette = format(TextureFormat::Palette1);
    palette.textures[0].alpha = opaque.textures[0].alpha;
    assert_eq!(difference(&picture(&palette), &white, SCREEN.0), None, "palette");
}

#[test]
fn masks_multiply_alpha_and_compare_it_with_the_cutoff() {
    let with = |alpha: u8, cutoff: u8, is_textured: bool| {
        let mut builder = textured();
        let material = &mut builder.materials[0];
        (material.alpha_mode, material.color[3], material.cutoff) = (AlphaMode::Mask as u8, alpha, cutoff);
        if !is_textured {
            material.texture = u16::MAX;
        }
        picture(&builder)
    };
    let blue = vec![Rgb565::BLUE.into_storage(); usize::from(SCREEN.0) * usize::from(SCREEN.1)];
    for is_textured in [false, true] {
        let all = with(255, 0, is_textured);
        assert!(all != blue);
        for (alpha, cutoff, is_drawn) in
            [(255, 255, true), (254, 255, false), (120, 120, true), (119, 120, false), (1, 1, true), (0, 1, false)]
        {
            let expected = if is_drawn { &all } else { &blue };
            let found = with(alpha, cutoff, is_textured);
            assert_eq!(difference(&found, expected, SCREEN.0), None, "{alpha} {cutoff} textured: {is_textured}");
        }
    }
    // Half of all steps of alpha: the texels of 8/15 and more become those of 4/15 and more, 68 of 255.
    let [mut full, mut half] = [with_alpha(AlphaMode::Mask), with_alpha(AlphaMode::Mask)];
    full.materials[0].cutoff = 128;
    (half.materials[0].color[3], half.materials[0].cutoff) = (128, 67);
    assert_eq!(difference(&picture(&half), &picture(&full), SCREEN.0), None);
}

#[test]
fn blended_parts_without_normals_are_lit_by_their_faces() {
    let mut builder = textured();
    let color = [250, 200, 240, 150];
    builder.materials[0] = MaterialItem { alpha_mode: AlphaMode::Blend as u8, color, ..material() };
    builder.parts[0].normals.clear();
    let (container, slices) = (builder.clone().build(), Slices::of(&builder));
    let (model, mesh) = (Model::from_bytes(container.bytes()).expect("a model"), slices.mesh(&builder));
    let (camera, world) = (camera(&model), world());
    let mvp = camera.lens * (camera.view * world);
    let shader = Blend::new(Flat::new(sun().on(&Matte::new(Rgb888::new(250, 200, 240)), &world)), Opacity(150));
    let state = State { depth: DepthState::TEST, ..State::DEFAULT };
    let (expected, _) =
        strips::<Rgb565>(SCREEN, 30, 20_000, Rgb565::BLUE, |scene| scene.draw_with(state, &mesh, &mvp, &shader));
    assert_eq!(difference(&picture(&builder), &expected, SCREEN.0), None);
}

#[test]
fn opaque_draws_are_those_of_a_model_without_other_parts() {
    let all = many_parts();
    let mut plain = all.clone();
    for (node, part) in plain.nodes.iter_mut().zip(&all.parts) {
        let material = &all.materials[usize::from(part.item.material)];
        let is_rgb565 = all.textures.get(usize::from(material.texture)).is_none_or(|texture| texture.format == 0);
        let is_plain = material.alpha_mode == AlphaMode::Opaque as u8 && is_rgb565;
        node.parts = is_plain.into();
    }
    let (few, parts) = (plain.nodes.iter().filter(|node| node.parts > 0).count(), all.nodes.len());
    assert!(few > 3 && few < parts - 3, "{few} of {parts}");
    let container = all.clone().build();
    let model = Model::from_bytes(container.bytes()).expect("a model");
    let (camera, mut places) = (camera(&model), vec![None; parts]);
    let placed = model.place(&world(), &camera, &sun(), &mut places).expect("enough places");
    let (found, _) = strips::<Rgb565>(SCREEN, 30, 20_000, Rgb565::BLUE, |scene| placed.draw_opaque(scene));
    assert_eq!(difference(&found, &picture(&plain), SCREEN.0), None);
    assert!(difference(&found, &picture(&all), SCREEN.0).is_some());
}
