//! Scenes of light: materials under several lights, a landscape in fog, glass and sparks.

use super::kept::kept;
use super::{UNLIT, landscape, pot, tiles};
use zstrip::color::{PixelFormat, Rgba8888};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::Rgb888;
use zstrip::light::{DirectionalLight, Lighting, LitMaterial, Material, Matte, PointLight, Sun, Sunlit, Viewer};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology, sort_back_to_front, view_depth};
use zstrip::shader::{
    AddAlpha, Blend, Flat, FogCurve, FogTable, Fogged, Gouraud, Matcap, Multiply, Opacity, Phong, PhongNear,
};
use zstrip::span::{DepthState, Fragment, Shader};
use zstrip::vertex::{VertexRef, VertexShader};
use zstrip::{Cull, Framebuffer, Scene, State};

/// How the pot is shaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shading {
    PerFace,
    PerVertex,
    PerFragment,
    /// With point lights close by.
    PerFragmentNear,
    Matcap,
}

const BOTH_SIDES: State = State { cull: Cull::None, ..State::DEFAULT };

// Out of line, as in `super`: what matrices, lights and materials are made of is not on the stack while something is drawn.

/// The transform to eye space of an eye that looks at `target`.
const fn look(eye: Vec3, target: Vec3) -> Affine {
    match Affine::look_at(eye, target, Vec3::Y) {
        Ok(view) => view,
        Err(_) => Affine::IDENTITY,
    }
}

/// The numbers of a camera's matrix that are not always the same: a quarter of the matrix.
#[derive(Clone, Copy)]
struct Lens {
    x: i64,
    y: i64,
    z: [i64; 2],
}

impl Lens {
    #[inline(never)]
    fn new(screen: Size, near: Scalar, far: Scalar) -> Self {
        let camera =
            Projective::perspective(Angle16::from_degrees(45), screen, near, far).unwrap_or(Projective::IDENTITY);
        let [[x, ..], [_, y, ..], [.., z, w], _] = camera.to_rows();
        Self { x, y, z: [z, w] }
    }

    /// For things that are a few units away.
    fn close(screen: Size) -> Self {
        Self::new(screen, Scalar::ONE, Scalar::from_bits(16 << 16))
    }

    /// Eye space → clip space.
    fn camera(&self) -> Projective {
        let [z, w] = self.z;
        Projective::from_rows([[self.x, 0, 0, 0], [0, self.y, 0, 0], [0, 0, z, w], [0, 0, -1 << 32, 0]])
    }

    /// Takes what a matrix brings to eye space to clip space.
    #[inline(never)]
    fn seen(&self, model: impl FnOnce() -> Affine) -> Projective {
        self.camera().compose_affine(&model())
    }
}

/// A point on a circle about the y axis, radius and height in thousandths.
fn on_circle(angle: Angle16, radius: i32, height: i32) -> Vec3 {
    let along = |s: Scalar| (i64::from(s.to_bits()) * i64::from(radius) / 65_536) as i32;
    Vec3::from_milli(along(angle.cos()), height, along(angle.sin()))
}

/// World → eye space by night.
static BY_NIGHT: Affine = look(Vec3::from_milli(0, 1750, 4300), Vec3::from_milli(120, 180, 0));

/// A glazed pot on a tiled table, under the moon and two lamps.
pub fn phong<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16, shading: Shading) {
    draw_backdrop(scene, &NIGHT);
    table(scene, &BY_NIGHT, || {
        let wood = Material::glossy(Rgb888::new(215, 205, 195), Rgb888::new(90, 90, 90), 32);
        night(turn).on(&wood.vertex_colors(), &table_model(&BY_NIGHT), tiles::MESH.bounds())
    });
    match shading {
        Shading::PerFace => pot(scene, turn, || Flat::new(glaze(turn))),
        Shading::PerVertex => pot(scene, turn, || Gouraud::new(glaze(turn))),
        Shading::PerFragment => pot(scene, turn, || Phong::new(sunlit_glaze(turn))),
        Shading::PerFragmentNear => pot(scene, turn, || PhongNear::new(glaze(turn))),
        Shading::Matcap => pot(scene, turn, || Matcap::<Rgb888, 64>::new(ball(), &pot_model(turn))),
    }
}

/// The moon and the lamps, in eye space.
fn night(turn: Angle16) -> Lighting<1, 2> {
    let lamp = |angle: Angle16, radius: i32, height: i32, color: Rgb888, range: i32| {
        PointLight::new(BY_NIGHT * on_circle(angle, radius, height), color, Scalar::from_bits(range << 16))
    };
    let moon = BY_NIGHT.transform_vector(Vec3::from_ints(-3, 5, 4));
    Lighting {
        ambient: Rgb888::new(34, 34, 52),
        directional: [DirectionalLight::new(moon, Rgb888::new(120, 130, 165))],
        points: [
            lamp(turn + Angle16::from_degrees(50), 1900, 900, Rgb888::new(255, 150, 50), 5),
            lamp(-turn - turn + Angle16::from_degrees(160), 1700, 150, Rgb888::new(40, 130, 255), 4),
        ],
        viewer: Viewer::At(Vec3::ZERO),
    }
}

/// Where the glazed pot is, in eye space.
fn pot_model(turn: Angle16) -> Affine {
    BY_NIGHT * Affine::rotation_y(turn + Angle16::from_degrees(-25))
}

/// What the pot is covered with.
fn glazed() -> Material {
    Material::glossy(Rgb888::new(200, 60, 50), Rgb888::new(230, 220, 210), 64).two_sided()
}

/// The glaze under the night's lights.
fn glaze(turn: Angle16) -> LitMaterial<1, 2> {
    night(turn).on(&glazed(), &pot_model(turn), pot::mesh().bounds())
}

/// The glaze under a sun where the moon is.
fn sunlit_glaze(turn: Angle16) -> LitMaterial<1, 0> {
    let Lighting { ambient, directional: [moon], .. } = night(turn);
    let sun = DirectionalLight { color: Rgb888::new(235, 225, 210), ..moon };
    let lighting = Lighting { ambient, directional: [sun], points: [], viewer: Viewer::Toward(Vec3::Z) };
    lighting.on(&glazed(), &pot_model(turn), pot::mesh().bounds())
}

/// The pot by a shader.
#[inline(never)]
fn pot<F: Framebuffer, S: Shader<F::Format>>(scene: &mut Scene<'_, F>, turn: Angle16, shader: impl FnOnce() -> S) {
    let mvp = kept(|| Lens::close(scene.screen()).seen(|| pot_model(turn)));
    scene.draw_with(BOTH_SIDES, pot::mesh(), &mvp, &*kept(shader));
}

/// A picture of a ball of polished copper in front of a horizon.
fn ball() -> &'static [[[u8; 3]; 64]; 64] {
    const { &picture() }
}

const fn picture() -> [[[u8; 3]; 64]; 64] {
    let mut picture = [[[0; 3]; 64]; 64];
    let mut k = 0;
    while k < 4096 {
        let (x, y) = ((k % 64) as i32 - 32, (k / 64) as i32 - 32);
        let squared = x * x + y * y;
        // The height of the ball over the picture, and how bright a light from the upper left is.
        let z = if squared < 1024 { (1024 - squared).isqrt() } else { 0 };
        let light = -14 * x - 20 * y + 18 * z;
        let glow = if light > 0 { light / 5 } else { 0 };
        let shine = if light > 820 { (light - 820) * 2 } else { 0 };
        // The ground is reflected below, a bright line above it.
        let horizon = if y > 2 && y < 12 { 60 - 6 * (y - 2) } else { 0 };
        let rim = (32 - z) * 2;
        picture[k / 64][k % 64] = [
            capped(30 + glow + shine + horizon + rim),
            capped(14 + glow * 6 / 10 + shine + horizon / 2 + rim),
            capped(12 + glow * 4 / 10 + shine + horizon / 3 + rim * 3 / 2),
        ];
        k += 1;
    }
    picture
}

const fn capped(v: i32) -> u8 {
    if v > 255 { 255 } else { v as u8 }
}

/// Planes of the landscape's camera.
const MIST_NEAR: Scalar = Scalar::from_bits(1 << 14);
const MIST_FAR: Scalar = Scalar::from_bits(28 << 16);

/// Where a linear fog starts, and where nothing is left.
const MIST_START: Scalar = Scalar::from_bits(4 << 16);
const MIST_END: Scalar = Scalar::from_bits(19 << 16);

/// How the fog thickens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mist {
    Squared,
    Exponential,
    Linear,
}

impl Mist {
    fn table(self) -> &'static FogTable {
        match self {
            Self::Squared => const { &mist(FogCurve::ExponentialSquared { density: Scalar::from_bits(5800) }) },
            Self::Exponential => const { &mist(FogCurve::Exponential { density: Scalar::from_bits(3600) }) },
            Self::Linear => const { &mist(FogCurve::Linear { start: MIST_START, end: MIST_END }) },
        }
    }
}

const fn mist(curve: FogCurve) -> FogTable {
    match FogTable::perspective(MIST_NEAR, MIST_FAR, curve) {
        Ok(table) => table,
        Err(_) => panic!("near and far"),
    }
}

/// The colour of the fog.
const MORNING: Rgb888 = Rgb888::new(214, 196, 188);

/// The sun behind it, on vertex colours.
const SUN: Sunlit = Sun::from_channels(Vec3::from_milli(-800, 420, 300), [250, 205, 160], [78, 84, 108])
    .on(&Matte::WHITE.vertex_colors(), &Affine::IDENTITY);

/// A hilly landscape with a lake in the morning fog, seen from a bird's round flight.
pub fn fog<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16, mist: Mist) {
    let fog = mist.table();
    draw_backdrop(scene, &SKY);
    let (lens, view) = (kept(|| Lens::new(scene.screen(), MIST_NEAR, MIST_FAR)), kept(|| flight(turn)));
    hills(scene, &lens, &view, fog);
    pines(scene, &lens, &view, fog);
    lake(scene, &lens, &view, fog);
}

/// World → the bird's eye space.
#[inline(never)]
fn flight(turn: Angle16) -> Affine {
    let [x, _, z] = on_circle(turn + Angle16::from_degrees(76), 8200, 0).to_bits().map(|c| c / 66);
    // Above what is below, and above the hills on the way to the middle.
    let ground = (4..=8).fold(900, |highest, k| landscape::height(x * k / 8, z * k / 8).max(highest));
    let eye = Vec3::from_milli(x, ground + 1400, z);
    look(eye, on_circle(turn + Angle16::from_degrees(176), 3300, 700))
}

#[inline(never)]
fn hills<F: Framebuffer>(scene: &mut Scene<'_, F>, lens: &Lens, view: &Affine, fog: &FogTable) {
    let mvp = kept(|| lens.seen(|| *view));
    scene.draw(landscape::ground(), &mvp, &*kept(|| Fogged::new(Gouraud::new(SUN), fog, MORNING)));
}

#[inline(never)]
fn pines<F: Framebuffer>(scene: &mut Scene<'_, F>, lens: &Lens, view: &Affine, fog: &FogTable) {
    let shader = kept(|| Fogged::new(Flat::new(SUN), fog, MORNING));
    for tree in landscape::trees() {
        let mvp = kept(|| lens.seen(|| *view).compose_affine(&Affine::translation(*tree)));
        scene.draw(&landscape::PINE, &mvp, &*shader);
    }
}

#[inline(never)]
fn lake<F: Framebuffer>(scene: &mut Scene<'_, F>, lens: &Lens, view: &Affine, fog: &FogTable) {
    let mvp = kept(|| lens.seen(|| *view));
    let water = Fogged::new(Flat::unlit(Rgb888::new(96, 130, 158)), fog, MORNING);
    scene.draw_with(GLASS, &landscape::LAKE, &mvp, &Blend::new(water, Opacity(165)));
}

/// What covers the screen: a colour at its top, one from `horizon` (in thousandths from -1000 to 1000) down, and between
/// them a gradient.
macro_rules! backdrop {
    ($top:expr, $below:expr, $horizon:expr) => {
        Mesh::constant(MeshData {
            topology: Topology::Strip,
            colors: Some(&[$top, $top, $below, $below, $below, $below]),
            ..MeshData::new(Positions::Exact(&[
                Vec3::from_milli(-1000, 1000, 500),
                Vec3::from_milli(1000, 1000, 500),
                Vec3::from_milli(-1000, $horizon, 500),
                Vec3::from_milli(1000, $horizon, 500),
                Vec3::from_milli(-1000, -1000, 500),
                Vec3::from_milli(1000, -1000, 500),
            ]))
        })
    };
}

static SKY: Mesh<'static> = backdrop!([92, 122, 172], [214, 196, 188], 330);
static NIGHT: Mesh<'static> = backdrop!([6, 8, 22], [44, 34, 66], 180);
static STUDIO: Mesh<'static> = backdrop!([38, 40, 66], [150, 132, 140], 60);

/// Behind all else.
#[inline(never)]
fn draw_backdrop<F: Framebuffer>(scene: &mut Scene<'_, F>, mesh: &Mesh<'_>) {
    static SCREEN: Projective = Projective::IDENTITY;
    let state = State { depth: DepthState::OFF, cull: Cull::None, ..State::DEFAULT };
    scene.draw_with(state, mesh, &SCREEN, &UNLIT);
}

/// Transparent things: tested against depth, seen from both sides, leaving no depth.
const GLASS: State = State { cull: Cull::None, depth: DepthState::TEST, ..State::DEFAULT };

/// A pane of 1.5 × 1.5 about the origin.
static PANE: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    ..MeshData::new(Positions::Exact(&[
        Vec3::from_milli(-750, -750, 0),
        Vec3::from_milli(750, -750, 0),
        Vec3::from_milli(750, 750, 0),
        Vec3::from_milli(-750, 750, 0),
    ]))
});

/// Coloured panes.
const PANES: [Rgb888; 4] =
    [Rgb888::new(255, 150, 60), Rgb888::new(90, 190, 255), Rgb888::new(120, 230, 110), Rgb888::new(240, 110, 210)];

const SPARKS: usize = 48;

/// World → eye space of the glass.
static BY_DAY: Affine = look(Vec3::from_milli(0, 1500, 4700), Vec3::from_milli(0, 330, 0));

/// A glass pot on a lit table, between coloured panes, and a fountain of sparks.
pub fn glass<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    // 1. What is opaque.
    draw_backdrop(scene, &STUDIO);
    table(scene, &BY_DAY, || {
        let cloth = Material::matte(Rgb888::new(215, 210, 200));
        day().on(&cloth.vertex_colors(), &table_model(&BY_DAY), tiles::MESH.bounds())
    });
    // 2. What is transparent, from back to front.
    for k in back_to_front(scene.screen(), turn) {
        match PANES.get(usize::from(k)) {
            Some(color) => pane(scene, turn, k, *color),
            None => {
                glass_pot(scene, turn);
                shine(scene, turn);
            }
        }
    }
    // 3. What is added.
    sparks(scene, turn);
}

/// Daylight and the lamp over the pot, in eye space.
fn day() -> Lighting<1, 1> {
    let (sky, lamp) = (Rgb888::new(90, 95, 115), Rgb888::new(255, 200, 120));
    Lighting {
        ambient: Rgb888::new(46, 46, 66),
        directional: [DirectionalLight::new(BY_DAY.transform_vector(Vec3::from_ints(-3, 5, 4)), sky)],
        points: [PointLight::new(BY_DAY * Vec3::from_milli(0, 1300, 0), lamp, Scalar::from_bits(5 << 16))],
        viewer: Viewer::At(Vec3::ZERO),
    }
}

/// Object space of the table → eye space.
fn table_model(view: &Affine) -> Affine {
    *view * Affine::translation(Vec3::from_milli(0, pot::TABLE, 0))
}

/// The table, of a material under its lights.
#[inline(never)]
fn table<F: Framebuffer, const P: usize>(
    scene: &mut Scene<'_, F>,
    view: &Affine,
    wood: impl FnOnce() -> LitMaterial<1, P>,
) {
    let mvp = kept(|| Lens::close(scene.screen()).seen(|| table_model(view)));
    scene.draw(&tiles::MESH, &mvp, &*kept(|| PhongNear::new(wood())));
}

/// Where a pane is, or the pot, the last number, in eye space.
fn glass_model(turn: Angle16, k: u16) -> Affine {
    if usize::from(k) == PANES.len() {
        return BY_DAY * Affine::rotation_y(turn);
    }
    let angle = turn + Angle16(k * 16_384);
    BY_DAY * Affine::translation(on_circle(angle, 2100, 210)) * Affine::rotation_y(Angle16(0x4000) - angle)
}

/// The order of the panes and the pot.
#[inline(never)]
fn back_to_front(screen: Size, turn: Angle16) -> [u16; 5] {
    let lens = Lens::close(screen);
    let mut order = [0, 1, 2, 3, 4];
    sort_back_to_front(&mut order, |k| view_depth(&lens.seen(|| glass_model(turn, *k)), PANE.bounds()));
    order
}

#[inline(never)]
fn pane<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16, k: u16, color: Rgb888) {
    let mvp = kept(|| Lens::close(scene.screen()).seen(|| glass_model(turn, k)));
    scene.draw_with(GLASS, &PANE, &mvp, &Blend::new(Flat::unlit(color), Multiply));
}

#[inline(never)]
fn sparks<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    let lens = Lens::close(scene.screen());
    for k in 0..SPARKS {
        let age = (turn.0.wrapping_mul(6).wrapping_add((k * 65_536 / SPARKS) as u16)) >> 6;
        let mvp = kept(|| lens.seen(|| Affine::translation(BY_DAY * spark(k, i32::from(age)))));
        let ember = Ember { left: 1023 - i32::from(age) };
        scene.draw_with(GLASS, &GLOW, &mvp, &Blend::new(ember, AddAlpha));
    }
}

/// The pot, of a material under the day's lights.
fn lit_pot(turn: Angle16, material: impl Into<Material>) -> LitMaterial<1, 1> {
    day().on(material, &glass_model(turn, PANES.len() as u16), pot::mesh().bounds())
}

/// Object space of the pot → clip space.
#[inline(never)]
fn pot_seen(screen: Size, turn: Angle16) -> Projective {
    Lens::close(screen).seen(|| glass_model(turn, PANES.len() as u16))
}

/// A pot of glass: its inner side and its outer side.
#[inline(never)]
fn glass_pot<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    let mvp = kept(|| pot_seen(scene.screen(), turn));
    let shader = kept(|| {
        let body = Material::matte(Rgb888::new(150, 205, 200)).two_sided();
        Blend::new(Gouraud::new(lit_pot(turn, &body)), Opacity(70))
    });
    for cull in [Cull::Front, Cull::Back] {
        scene.draw_with(State { cull, ..GLASS }, pot::mesh(), &mvp, &*shader);
    }
}

/// Highlights that no transparency dims.
#[inline(never)]
fn shine<F: Framebuffer>(scene: &mut Scene<'_, F>, turn: Angle16) {
    let mvp = kept(|| pot_seen(scene.screen(), turn));
    let shader = kept(|| {
        let gloss = Material::glossy(Rgb888::new(0, 0, 0), Rgb888::new(255, 250, 240), 48);
        Blend::new(PhongNear::new(lit_pot(turn, &gloss)), zstrip::shader::Add)
    });
    scene.draw_with(State { cull: Cull::Back, ..GLASS }, pot::mesh(), &mvp, &*shader);
}

/// Where a spark is, `age` of 1024 steps after it left the lid: a throw in its own direction.
fn spark(k: usize, age: i32) -> Vec3 {
    let speed = 350 + (k * 37 % 29) as i32 * 55;
    let rise = 1700 + (k * 53 % 31) as i32 * 45;
    // Thousandths: up with `rise`, and down with the square of age.
    let height = 950 + rise * age / 1024 - (2900 * (age * age / 1024)) / 1024;
    on_circle(Angle16((k * 25_033) as u16), speed * age / 1024, height)
}

/// A square of 0.24 about the origin, with its coordinates in it.
static GLOW: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    uvs: Some(&[
        [Scalar::NEG_ONE, Scalar::NEG_ONE],
        [Scalar::ONE, Scalar::NEG_ONE],
        [Scalar::ONE, Scalar::ONE],
        [Scalar::NEG_ONE, Scalar::ONE],
    ]),
    ..MeshData::new(Positions::Exact(&[
        Vec3::from_milli(-120, -120, 0),
        Vec3::from_milli(120, -120, 0),
        Vec3::from_milli(120, 120, 0),
        Vec3::from_milli(-120, 120, 0),
    ]))
});

/// A spark that fades with age and towards its rim: a shader as a user would write it, with an opacity.
struct Ember {
    /// What is left of 1024 steps.
    left: i32,
}

impl VertexShader for Ember {
    /// Place in the square, -1 to 1 in 16.16.
    type Varyings = [i32; 2];

    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 2] {
        vertex.uv().map(Scalar::to_bits)
    }
}

impl Shader<Rgba8888> for Ember {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, [i32; 2]>) -> Option<<Rgba8888 as PixelFormat>::Raw> {
        let [u, v] = fragment.varyings.map(|c| c >> 8);
        // 1 - r², squared: 0.16, 0.8 and 0.8 again.
        let core = (0x1_0000 - u * u - v * v) >> 8;
        if core <= 0 {
            return None;
        }
        let glow = (core * core) >> 8;
        let alpha = (glow * self.left) >> 10;
        Some([
            255,
            (100 + (alpha >> 1)).min(255) as u8,
            (20 + ((alpha * alpha) >> 9)).min(255) as u8,
            alpha.min(255) as u8,
        ])
    }
}
