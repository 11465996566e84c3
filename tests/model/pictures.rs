//! Pictures of models beside those of draws by hand, and in every way to draw a frame.

use super::builder::Builder;
use super::figures::{SCALE, animated, many_parts, textured};
use super::support::{difference, strips, unrecorded_strips, whole};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::light::{DirectionalLight, Lighting, Material, Matte, Sun};
use zstrip::math::{Affine, Angle16, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::model::{Camera, Model, Pose, decode_normal};
use zstrip::shader::{Gouraud, Textured};
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
            normals: Some(&self.normals),
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
