//! A torus with the axes of its space and with names in that space: text is hidden by what is in front of it.

use super::kept::{Kept, kept_list};
use super::{Draw, LIGHT, TORUS_COLOR, camera, torus};
use embedded_graphics::mono_font::{MonoTextStyle, MonoTextStyleBuilder, ascii};
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{Circle, Line, PrimitiveStyle};
use embedded_graphics::text::{Alignment, Baseline, Text, TextStyle, TextStyleBuilder};
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
use zstrip::light::{Material, Sunlit};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
use zstrip::shader::{Flat, Gouraud};
use zstrip::{Framebuffer, Scene};

const P: i16 = i16::MAX;
const S: i16 = P / 64;
const H: i16 = P / 24;
const N: i16 = P / 8 * 7;

/// An arrow along x from 0 to 1: a shaft with a square profile, closed at its foot, and a pyramid.
#[rustfmt::skip]
static ARROW: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    indices: Some(&[
        0, 1, 2, 3, 0, 4, 5, 1, 1, 5, 6, 2, 2, 6, 7, 3, 3, 7, 4, 0,
        8, 9, 10, 11, 8, 12, 12, 9, 9, 12, 12, 10, 10, 12, 12, 11, 11, 12, 12, 8,
    ]),
    ..MeshData::new(Positions::Quantized {
        points: &[
            [0, S, S], [0, S, -S], [0, -S, -S], [0, -S, S], [N, S, S], [N, S, -S], [N, -S, -S], [N, -S, S],
            [N, H, H], [N, H, -H], [N, -H, -H], [N, -H, H], [P, 0, 0],
        ],
        scale: Scalar::ONE,
        offset: Vec3::ZERO,
    })
});

const LENGTH: i32 = 1700;

const fn at(x: i32, y: i32, z: i32) -> Vec3 {
    Vec3::from_milli(x, y, z)
}

/// Returns the axes: name and where it is written, rotation from x, colour.
fn axes() -> [(&'static str, Vec3, Affine, Rgb888); 3] {
    let quarter = Angle16::from_degrees(90);
    [
        ("x", at(LENGTH + 150, 0, 0), Affine::IDENTITY, Rgb888::new(230, 70, 60)),
        ("y", at(0, LENGTH + 150, 0), Affine::rotation_z(quarter), Rgb888::new(90, 200, 80)),
        ("z", at(0, 0, LENGTH + 150), Affine::rotation_y(-quarter), Rgb888::new(90, 140, 250)),
    ]
}

/// The torus, its axes, and names.
pub struct Labels {
    mvp: Projective,
    glaze: Gouraud<Sunlit>,
    /// Matrix and shader of each arrow.
    arrows: Kept<[(Projective, Flat<Sunlit>)]>,
}

impl Labels {
    pub fn new(screen: Size, turn: Angle16) -> Self {
        let model = Affine::translation(at(0, -150, -3900))
            * Affine::rotation_x(Angle16::from_degrees(32))
            * Affine::rotation_y(turn + Angle16::from_degrees(35));
        let mvp = camera(screen, Scalar::ONE, Scalar::ONE * 12) * model;
        let grow = Affine::scale(Scalar::from_bits((LENGTH << 16) / 1000));
        let axes = axes();
        let arrows = kept_list(axes.len(), |k| {
            let (_, _, rotation, color) = axes[k];
            let local = rotation * grow;
            (mvp * local, Flat::new(LIGHT.on(&Material::matte(color), &(model * local))))
        });
        Self { mvp, glaze: Gouraud::new(LIGHT.on(&Material::matte(TORUS_COLOR), &model)), arrows }
    }
}

impl<F: Framebuffer<Format = Rgb565>> Draw<F> for Labels {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        let Self { mvp, glaze, arrows } = self;
        scene.draw(&torus::MESH, mvp, glaze);
        for (mvp, shader) in &**arrows {
            scene.draw(&ARROW, mvp, shader);
        }

        let middle = TextStyleBuilder::new().alignment(Alignment::Center).baseline(Baseline::Middle).build();
        for (name, tip, _, color) in axes() {
            let style = MonoTextStyle::new(&ascii::FONT_10X20, color.into());
            label(scene, mvp, tip, &Text::with_text_style(name, Point::zero(), style, middle));
        }
        // Hours around the ring.
        let style = MonoTextStyleBuilder::new().font(&ascii::FONT_7X13_BOLD).text_color(Rgb565::WHITE).build();
        for (k, hour) in ["12", "1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11"].into_iter().enumerate() {
            let angle = Angle16((k * 65_536 / 12) as u16);
            let ring = |v: i32| Scalar::from_bits((v * 3) >> 1);
            let [sine, cosine] = [angle.sin(), angle.cos()].map(Scalar::to_bits);
            let point = Vec3::new(ring(sine), Scalar::from_bits(1 << 14), ring(-cosine));
            label(scene, mvp, point, &Text::with_text_style(hour, Point::zero(), style, middle));
        }
        note(scene, mvp, style);
    }
}

/// Draws text in the world: centred on a point, at its depth.
fn label<F: Framebuffer<Format = Rgb565>>(
    scene: &mut Scene<'_, F>,
    mvp: &Projective,
    point: Vec3,
    text: &Text<'_, MonoTextStyle<'_, Rgb565>>,
) {
    if let Some(place) = scene.project(point, mvp) {
        scene.at_depth(place.z).draw(&text.translate(place.pixel()));
    }
}

/// Draws a note on top of all, with a line to a point of the torus.
fn note<F: Framebuffer<Format = Rgb565>>(scene: &mut Scene<'_, F>, mvp: &Projective, style: MonoTextStyle<'_, Rgb565>) {
    let top_left: TextStyle = TextStyleBuilder::new().baseline(Baseline::Top).build();
    let text = Text::with_text_style("inner rim", Point::new(12, 12), style, top_left);
    let point = scene.project(at(600, 0, 0), mvp);
    let mut overlay = scene.overlay();
    if let Some(place) = point {
        let line = Line::new(Point::new(79, 18), place.pixel());
        overlay.draw(&line.into_styled(PrimitiveStyle::with_stroke(Rgb565::new(20, 40, 20), 1)));
        overlay.draw(&Circle::with_center(place.pixel(), 5).into_styled(PrimitiveStyle::with_fill(Rgb565::WHITE)));
    }
    overlay.draw(&text);
}
