//! Drawn like Gouraud: shaders with colours as varyings look alike in every pixel format, however the format draws them
//! fast.

use crate::reference::rng::Rng;
use crate::support::{Soup, difference, strips};
use core::fmt::Debug;
use zstrip::color::{Bgr565Be, Ditherable, Dithered, PixelFormat, Rgb332, Rgb565Be};
use zstrip::embedded_graphics_core::pixelcolor::{Bgr565, Bgr888, Gray8, Rgb565, Rgb666, Rgb888};
use zstrip::light::{Lighting, Matte};
use zstrip::math::{Affine, Projective};
use zstrip::mesh::Mesh;
use zstrip::shader::Gouraud;
use zstrip::span::{DepthState, Fragment, Shader};
use zstrip::vertex::{VertexRef, VertexShader};
use zstrip::{Cull, State};

const SCREEN: (u16, u16) = (80, 60);

/// How far colours of [`Gouraud`] may be from exact ones, out of 255: vertices are squeezed and kept in 8.2 bits, and
/// steps are rounded.
const NEAR: i32 = 2;

/// A user's shader: the colours of the vertices in 8.16, not squeezed and not packed, fragment by fragment.
struct Plain;

impl VertexShader for Plain {
    type Varyings = [i32; 3];

    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 3] {
        vertex.color().map(|channel| i32::from(channel) << 16)
    }
}

impl<P: PixelFormat> Shader<P> for Plain {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, [i32; 3]>) -> Option<P::Raw> {
        Some(P::pack_at(
            fragment.varyings.map(|channel| ((channel + (1 << 15)) >> 16).clamp(0, 255) as u8),
            fragment.position,
        ))
    }
}

/// Draws triangles of all sizes and shapes.
fn picture<P: PixelFormat>(mesh: &Mesh<'_>, depth: DepthState, shader: &impl Shader<P>) -> Vec<P::Raw> {
    let state = State { cull: Cull::None, depth, ..State::DEFAULT };
    let black = P::to_color(P::pack([0; 3]));
    strips::<P>(SCREEN, 16, 10_000, black, |scene| scene.draw_with(state, mesh, &Projective::IDENTITY, shader)).0
}

/// Runs `check` with meshes, depth tests and what to say when it fails.
fn for_meshes<P>(mut check: impl FnMut(&Mesh<'_>, DepthState, &str)) {
    for seed in 0..4 {
        let mut soup = Soup::new(&mut Rng::new(seed), 20);
        // Full and empty channels, which light leaves as they are to the last bit.
        soup.colors.iter_mut().flatten().for_each(|channel| *channel = if *channel < 128 { 0 } else { 255 });
        for depth in [DepthState::LESS, DepthState::OFF] {
            check(&soup.mesh(), depth, &format!("{}, seed {seed}, {depth:?}", core::any::type_name::<P>()));
        }
    }
}

/// Lit per vertex, by white light from everywhere on a white surface, which leaves the colours of the vertices.
fn check_lit<P: PixelFormat<Raw: PartialEq + Debug>>() {
    let material = Matte::WHITE.vertex_colors();
    let lighting = Lighting::directional(Rgb888::new(255, 255, 255), []);
    for_meshes::<P>(|mesh, depth, case| {
        let lit = Gouraud::new(lighting.on(material, &Affine::IDENTITY, mesh.bounds()));
        let (lit, gouraud) = (picture::<P>(mesh, depth, &lit), picture::<P>(mesh, depth, &Gouraud::vertex_colors()));
        assert_eq!(difference(&lit, &gouraud, SCREEN.0), None, "{case}");
    });
}

/// A user's shader in 8 bits tells the colours: in `P` it must have just them, packed, and Gouraud colours next to
/// them.
fn check_plain<P: PixelFormat<Raw: PartialEq + Debug>>(near: i32) {
    for_meshes::<P>(|mesh, depth, case| {
        let colors = picture::<Rgb888>(mesh, depth, &Plain);
        let (plain, gouraud) =
            (picture::<P>(mesh, depth, &Plain), picture::<P>(mesh, depth, &Gouraud::vertex_colors()));
        let drawn = picture::<Gray8>(mesh, depth, &Everywhere);
        for (k, color) in colors.iter().enumerate().filter(|(k, _)| drawn[*k] != 0) {
            let position = (k as i32 % i32::from(SCREEN.0), k as i32 / i32::from(SCREEN.0));
            assert_eq!(plain[k], P::pack_at(*color, position), "pixel {position:?}, {case}");
            let next =
                |by: i32| P::unpack(P::pack_at(color.map(|c| (i32::from(c) + by).clamp(0, 255) as u8), position));
            let (low, high, found) = (next(-near), next(near), P::unpack(gouraud[k]));
            let is_near = (0..3).all(|channel| (low[channel]..=high[channel]).contains(&found[channel]));
            assert!(is_near, "pixel {position:?} is {found:?}, {color:?} in 8 bits: {low:?} to {high:?}, {case}");
        }
    });
}

fn check<P: PixelFormat<Raw: PartialEq + Debug>>() {
    check_lit::<P>();
    check_plain::<P>(NEAR);
}

/// Marks what is drawn.
struct Everywhere;

impl VertexShader for Everywhere {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }
}

impl Shader<Gray8> for Everywhere {
    type Setup = ();

    fn fragment(&self, _: &Fragment<'_, [i32; 0]>) -> Option<u8> {
        Some(1)
    }
}

#[test]
fn sixteen_bit_formats_look_alike() {
    check::<Rgb565>();
    check::<Bgr565>();
    check::<Rgb565Be>();
    check::<Bgr565Be>();
}

#[test]
fn one_byte_formats_look_alike() {
    check::<Rgb332>();
    check_lit::<Gray8>();
    // One more, as a full channel cannot make up for what rounding takes from another.
    check_plain::<Gray8>(NEAR + 1);
}

#[test]
fn three_byte_formats_look_alike() {
    check::<Rgb888>();
    check::<Bgr888>();
    check::<Rgb666>();
}

#[test]
fn dithered_formats_look_alike() {
    fn dithered<P: Ditherable<Raw: PartialEq + Debug>>() {
        check::<Dithered<P>>();
    }
    dithered::<Rgb565>();
    dithered::<Bgr565>();
    dithered::<Rgb565Be>();
    dithered::<Bgr565Be>();
    dithered::<Rgb332>();
}
