//! Scenes of light: materials under several lights, a landscape in fog, glass and sparks.

use super::kept::{Kept, kept, kept_list};
use super::{Draw, UNLIT, draw_apart, landscape, pot, tiles};
use zstrip::color::{PixelFormat, Rgba8888};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::Rgb888;
use zstrip::light::{DirectionalLight, Lighting, LitMaterial, Material, Matte, PointLight, Sun, Sunlit, Viewer};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology, sort_back_to_front, view_depth};
use zstrip::shader::{
    Add, AddAlpha, Blend, Flat, FogCurve, FogTable, Fogged, Gouraud, Matcap, Multiply, Opacity, PhongNear,
};
use zstrip::span::{DepthState, Fragment, Shader};
use zstrip::vertex::{VertexRef, VertexShader};
use zstrip::{Cull, Framebuffer, Scene, State};

const BOTH_SIDES: State = State { cull: Cull::None, ..State::DEFAULT };

/// Returns the transform to eye space of an eye that looks at `target`.
const fn look(eye: Vec3, target: Vec3) -> Affine {
    match Affine::look_at(eye, target, Vec3::Y) {
        Ok(view) => view,
        Err(_) => Affine::IDENTITY,
    }
}

/// Returns a camera with a vertical field of view of 45 degrees.
#[inline(never)]
fn camera(screen: Size, near: Scalar, far: Scalar) -> Projective {
    Projective::perspective(Angle16::from_degrees(45), screen, near, far).unwrap_or(Projective::IDENTITY)
}

/// Returns the camera for things that are a few units away.
fn close_camera(screen: Size) -> Projective {
    camera(screen, Scalar::ONE, Scalar::from_bits(16 << 16))
}

/// Returns a point on a circle about the y axis, radius and height in thousandths.
fn on_circle(angle: Angle16, radius: i32, height: i32) -> Vec3 {
    let along = |s: Scalar| (i64::from(s.to_bits()) * i64::from(radius) / 65_536) as i32;
    Vec3::from_milli(along(angle.cos()), height, along(angle.sin()))
}

/// World → eye space by night.
static BY_NIGHT: Affine = look(Vec3::from_milli(0, 1750, 4300), Vec3::from_milli(120, 180, 0));

/// A glazed pot on a tiled table, under the moon and two lamps.
pub struct Night<S> {
    // These are dropped in this order: the one that was made last is first.
    glaze: Kept<S>,
    wood: Kept<PhongNear<1, 2>>,
    table: Projective,
    pot: Projective,
}

impl<S> Night<S> {
    /// Makes the scene with a shader for the pot: of [`glaze`], of [`sunlit_glaze`], or [`copper`].
    pub fn new(screen: Size, turn: Angle16, glaze: impl FnOnce() -> S) -> Self {
        let camera = close_camera(screen);
        let wood = kept(|| wood(turn));
        Self { glaze: kept(glaze), wood, table: camera * table_model(&BY_NIGHT), pot: camera * pot_model(turn) }
    }
}

impl<F: Framebuffer, S: Shader<F::Format>> Draw<F> for Night<S> {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        draw_backdrop(scene, &NIGHT);
        draw_apart(scene, State::DEFAULT, &tiles::MESH, &self.table, &*self.wood);
        draw_apart(scene, BOTH_SIDES, pot::mesh(), &self.pot, &*self.glaze);
    }
}

// Each shader is made in a function that is not inlined: its temporaries leave the stack before the next one is made.

/// Returns the shader of the table by night.
#[inline(never)]
fn wood(turn: Angle16) -> PhongNear<1, 2> {
    let wood = Material::glossy(Rgb888::new(215, 205, 195), Rgb888::new(90, 90, 90), 32);
    PhongNear::new(night(turn).on(wood.vertex_colors(), &table_model(&BY_NIGHT), tiles::MESH.bounds()))
}

/// Returns the moon and the lamps, in eye space.
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

/// Returns where the glazed pot is, in eye space.
fn pot_model(turn: Angle16) -> Affine {
    BY_NIGHT * Affine::rotation_y(turn + Angle16::from_degrees(-25))
}

/// Returns the material of the pot.
fn glazed() -> Material {
    Material::glossy(Rgb888::new(200, 60, 50), Rgb888::new(230, 220, 210), 64).two_sided()
}

/// Returns the glaze under the night's lights.
#[inline(never)]
pub fn glaze(turn: Angle16) -> LitMaterial<1, 2> {
    night(turn).on(glazed(), &pot_model(turn), pot::mesh().bounds())
}

/// Returns the glaze under a sun where the moon is.
pub fn sunlit_glaze(turn: Angle16) -> LitMaterial<1, 0> {
    let Lighting { ambient, directional: [moon], .. } = night(turn);
    let sun = DirectionalLight { color: Rgb888::new(235, 225, 210), ..moon };
    let lighting = Lighting { ambient, directional: [sun], points: [], viewer: Viewer::Toward(Vec3::Z) };
    lighting.on(glazed(), &pot_model(turn), pot::mesh().bounds())
}

/// Returns a shader that mirrors a picture: the pot looks like polished copper.
pub fn copper(turn: Angle16) -> Matcap<'static, Rgb888, 64> {
    Matcap::new(ball(), &pot_model(turn))
}

/// Returns a picture of a ball of polished copper in front of a horizon.
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

/// The distances where a linear fog starts, and where it hides everything.
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
pub struct Fog {
    /// Of the ground and of the lake.
    mvp: Projective,
    hills: Fogged<'static, Gouraud<Sunlit>>,
    /// A matrix for each tree.
    trees: Kept<[Projective]>,
    pines: Fogged<'static, Flat<Sunlit>>,
    lake: Blend<Fogged<'static, Flat>, Opacity>,
}

impl Fog {
    pub fn new(screen: Size, turn: Angle16, mist: Mist) -> Self {
        let table = mist.table();
        let mvp = camera(screen, MIST_NEAR, MIST_FAR) * flight(turn);
        let places = landscape::trees();
        let water = Fogged::new(Flat::unlit(Rgb888::new(96, 130, 158)), table, MORNING);
        Self {
            mvp,
            hills: Fogged::new(Gouraud::new(SUN), table, MORNING),
            trees: kept_list(places.len(), |k| mvp * Affine::translation(places[k])),
            pines: Fogged::new(Flat::new(SUN), table, MORNING),
            lake: Blend::new(water, Opacity(165)),
        }
    }
}

impl<F: Framebuffer> Draw<F> for Fog {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        draw_backdrop(scene, &SKY);
        draw_apart(scene, State::DEFAULT, landscape::ground(), &self.mvp, &self.hills);
        for mvp in &*self.trees {
            draw_apart(scene, State::DEFAULT, &landscape::PINE, mvp, &self.pines);
        }
        draw_apart(scene, GLASS, &landscape::LAKE, &self.mvp, &self.lake);
    }
}

/// Returns the transform from world space to the bird's eye space.
#[inline(never)]
fn flight(turn: Angle16) -> Affine {
    let [x, _, z] = on_circle(turn + Angle16::from_degrees(76), 8200, 0).to_bits().map(|c| c / 66);
    // Above what is below, and above the hills on the way to the middle.
    let ground = (4..=8).fold(900, |highest, k| landscape::height(x * k / 8, z * k / 8).max(highest));
    let eye = Vec3::from_milli(x, ground + 1400, z);
    look(eye, on_circle(turn + Angle16::from_degrees(176), 3300, 700))
}

/// Makes a mesh that covers the screen: a colour at its top, another from `horizon` (in thousandths from -1000 to 1000)
/// down, and between them a gradient.
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

/// Draws a backdrop, behind all else.
fn draw_backdrop<F: Framebuffer>(scene: &mut Scene<'_, F>, mesh: &Mesh<'_>) {
    static SCREEN: Projective = Projective::IDENTITY;
    let state = State { depth: DepthState::OFF, cull: Cull::None, ..State::DEFAULT };
    draw_apart(scene, state, mesh, &SCREEN, &UNLIT);
}

/// The state of transparent things: tested against depth, seen from both sides, leaving no depth.
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
pub struct Glass {
    // These are dropped in this order: the one that was made last is first.
    /// Highlights that no transparency dims.
    gloss: Kept<Blend<PhongNear<1, 1>, Add>>,
    body: Kept<Blend<Gouraud<LitMaterial<1, 1>>, Opacity>>,
    cloth: Kept<PhongNear<1, 1>>,
    sparks: Kept<[(Projective, Blend<Ember, AddAlpha>)]>,
    panes: Kept<[(Projective, Blend<Flat, Multiply>)]>,
    table: Projective,
    pot: Projective,
    /// Panes, and the pot as number 4, from back to front.
    order: [u16; 5],
}

impl Glass {
    pub fn new(screen: Size, turn: Angle16) -> Self {
        let camera = close_camera(screen);
        let panes = kept_list(PANES.len(), |k| {
            (camera * pane_model(turn, k as u16), Blend::new(Flat::unlit(PANES[k]), Multiply))
        });
        let sparks = kept_list(SPARKS, |k| {
            let age = i32::from(turn.0.wrapping_mul(6).wrapping_add((k * 65_536 / SPARKS) as u16) >> 6);
            let mvp = camera * Affine::translation(BY_DAY * spark(k, age));
            (mvp, Blend::new(Ember { left: 1023 - age }, AddAlpha))
        });
        let pot = camera * glass_model(turn);
        let mut order = [0, 1, 2, 3, 4];
        sort_back_to_front(&mut order, |k| {
            let mvp = panes.get(usize::from(*k)).map_or(&pot, |(mvp, _)| mvp);
            view_depth(mvp, PANE.bounds())
        });
        Self {
            sparks,
            panes,
            cloth: kept(cloth),
            body: kept(|| body(turn)),
            gloss: kept(|| gloss(turn)),
            table: camera * table_model(&BY_DAY),
            pot,
            order,
        }
    }
}

impl<F: Framebuffer> Draw<F> for Glass {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        // 1. What is opaque.
        draw_backdrop(scene, &STUDIO);
        draw_apart(scene, State::DEFAULT, &tiles::MESH, &self.table, &*self.cloth);
        // 2. What is transparent, from back to front.
        for k in self.order {
            if let Some((mvp, color)) = self.panes.get(usize::from(k)) {
                draw_apart(scene, GLASS, &PANE, mvp, color);
                continue;
            }
            // The inner side of the pot, then its outer side.
            for cull in [Cull::Front, Cull::Back] {
                draw_apart(scene, State { cull, ..GLASS }, pot::mesh(), &self.pot, &*self.body);
            }
            draw_apart(scene, State { cull: Cull::Back, ..GLASS }, pot::mesh(), &self.pot, &*self.gloss);
        }
        // 3. What is added.
        for (mvp, ember) in &*self.sparks {
            draw_apart(scene, GLASS, &GLOW, mvp, ember);
        }
    }
}

/// Returns the daylight and the lamp over the pot, in eye space.
fn day() -> Lighting<1, 1> {
    let (sky, lamp) = (Rgb888::new(90, 95, 115), Rgb888::new(255, 200, 120));
    Lighting {
        ambient: Rgb888::new(46, 46, 66),
        directional: [DirectionalLight::new(BY_DAY.transform_vector(Vec3::from_ints(-3, 5, 4)), sky)],
        points: [PointLight::new(BY_DAY * Vec3::from_milli(0, 1300, 0), lamp, Scalar::from_bits(5 << 16))],
        viewer: Viewer::At(Vec3::ZERO),
    }
}

/// Returns the transform from the table to eye space.
fn table_model(view: &Affine) -> Affine {
    *view * Affine::translation(Vec3::from_milli(0, pot::TABLE, 0))
}

/// Returns where a pane is, in eye space.
fn pane_model(turn: Angle16, k: u16) -> Affine {
    let angle = turn + Angle16(k * 16_384);
    BY_DAY * Affine::translation(on_circle(angle, 2100, 210)) * Affine::rotation_y(Angle16(0x4000) - angle)
}

/// Returns where the glass pot is, in eye space.
fn glass_model(turn: Angle16) -> Affine {
    BY_DAY * Affine::rotation_y(turn)
}

/// Returns the shader of the table by day.
#[inline(never)]
fn cloth() -> PhongNear<1, 1> {
    let cloth = Material::matte(Rgb888::new(215, 210, 200));
    PhongNear::new(day().on(cloth.vertex_colors(), &table_model(&BY_DAY), tiles::MESH.bounds()))
}

/// Returns the pot's material under the day's lights.
fn lit_pot(turn: Angle16, material: impl Into<Material>) -> LitMaterial<1, 1> {
    day().on(material, &glass_model(turn), pot::mesh().bounds())
}

/// Returns the glass of the pot.
#[inline(never)]
fn body(turn: Angle16) -> Blend<Gouraud<LitMaterial<1, 1>>, Opacity> {
    let glass = Material::matte(Rgb888::new(150, 205, 200)).two_sided();
    Blend::new(Gouraud::new(lit_pot(turn, glass)), Opacity(70))
}

/// Returns the highlights of the pot.
#[inline(never)]
fn gloss(turn: Angle16) -> Blend<PhongNear<1, 1>, Add> {
    let gloss = Material::glossy(Rgb888::new(0, 0, 0), Rgb888::new(255, 250, 240), 48);
    Blend::new(PhongNear::new(lit_pot(turn, gloss)), Add)
}

/// Returns where a spark is, `age` of 1024 steps after it left the lid: a throw in its own direction.
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
