//! Numbers, angles, vectors, matrices, colours and lights.

use super::{ENDS, Extreme, Table};
use crate::reference::rng::Rng;
use zstrip::color::{Bgr565Be, Dither, Dithered, Levels, PixelFormat, Rgb332, Rgb565Be, Rgba8888};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{
    Bgr565, Bgr888, BinaryColor, Gray2, Gray4, Gray8, GrayColor, Rgb565, Rgb666, Rgb888, RgbColor,
};
use zstrip::light::{DirectionalLight, Lighting, LitColor, Material, Matte, PointLight, Sun, Viewer};
use zstrip::math::{Affine, Angle16, DepthPrecision, Projective, Vec3};
use zstrip::mesh::{Bounds, sort_back_to_front, view_depth};
use zstrip::shader::Gouraud;

#[test]
fn vectors_and_angles_take_all_values() {
    let mut table = Table::start();
    let mut rng = Rng::new(1);
    for _ in 0..20_000 {
        let (a, b, s, angle, n) = (rng.vector(), rng.vector(), rng.scalar(), rng.angle(), rng.bits());
        table.case("Vec3 operators", (a, b, s), || [a + b, a - b, -a, a * s, a / s]);
        table.case("Vec3 assignments", (a, b, s), || {
            let mut v = a;
            v += b;
            v -= a;
            v *= s;
            v /= s;
            v
        });
        table.case("Vec3 products", (a, b), || (a.dot(b), a.cross(b)));
        let length = table.case("Vec3::length", a, || (a.length(), a.normalized()));
        if let Some((length, Some(unit))) = length {
            assert!(length.to_bits() >= 0, "{a:?}: {length}");
            let one = unit.to_bits().map(|c| (f64::from(c) / 65_536.0).powi(2)).iter().sum::<f64>();
            assert!((one - 1.0).abs() < 1e-3, "{a:?}: {unit:?}");
        }
        table.case("Vec3::from_milli", n, || Vec3::from_milli(n, i32::MIN, i32::MAX));
        table.case("Angle16 operators", (angle, n), || [angle + angle, angle - angle, -angle, angle * n]);
        table.case("Angle16 / n", (angle, n), || angle / n);
        table.case("Angle16 functions", (angle, n), || {
            (angle.sin(), angle.cos(), angle.to_degrees(), Angle16::from_degrees(n), format!("{angle} {angle:?}"))
        });
        table.case("Angle16::from_degrees_fixed", s, || Angle16::from_degrees_fixed(s));
    }
    table.finish();
}

#[test]
fn matrices_take_all_values() {
    let mut table = Table::start();
    let mut rng = Rng::new(2);
    for _ in 0..10_000 {
        let (a, b, v, w, s, angle) =
            (rng.affine(), rng.affine(), rng.vector(), rng.vector(), rng.scalar(), rng.angle());
        table.case("Affine makers", (v, s, angle), || {
            [Affine::translation(v), Affine::scale(s), Affine::scale_axes(v), Affine::rotation(v, angle)]
        });
        table.case("Affine turns", angle, || {
            [Affine::rotation_x(angle), Affine::rotation_y(angle), Affine::rotation_z(angle)]
        });
        table.case("Affine::look_at", (v, w), || Affine::look_at(v, w, Vec3::Y * s).is_ok());
        table.case("Affine products", (a, b), || (a.compose(&b), a * b, a * v, a.transform_vector(v)));
        table.case("Affine::inverse", a, || (a.inverse(), a.inverse_rigid()));
        let (p, q) = (rng.projective(), rng.projective());
        table.case("Projective products", (p, q), || (p.compose(&q), p * q, p * a, p.transform_point(v)));
        table.case("Projective::inverse", p, || p.inverse());
        table.case("Projective::entry", p, || [p.entry(0, 3), p.entry(4, 0), p.entry(usize::MAX, usize::MAX)]);
        let (size, near, far) = (Size::new(rng.size(), rng.size()), rng.scalar(), rng.scalar());
        table.case("Projective::perspective", (angle, size, near, far), || {
            Projective::perspective(angle, size, near, far).is_ok()
        });
        table.case("Projective::orthographic", (v, w), || {
            Projective::orthographic((v.x, v.y), (v.z, w.x), (w.y, w.z)).is_ok()
        });
        if let Some(Ok(precision)) = table.case("DepthPrecision::new", (near, far), || DepthPrecision::new(near, far)) {
            let depth = rng.bits() as u16;
            table.case("DepthPrecision", (precision, s, depth), || {
                (precision.depth(s), precision.distance(depth), precision.bin(s), precision.uniform_bin())
            });
        }
        table.case("DepthPrecision::near_for", (far, s, near), || DepthPrecision::near_for(far, s, near).is_ok());
        let bounds = Bounds { center: v, half: w };
        table.case("view_depth", (p, bounds), || view_depth(&p, &bounds));
    }
    table.case("sort_back_to_front", (), || {
        let mut order = [i64::MIN, i64::MAX, 0, i64::MIN];
        sort_back_to_front(&mut order, |depth| *depth);
        let n = std::cell::Cell::new(0);
        // Depths that differ from call to call.
        sort_back_to_front(&mut [0; 50], |_| {
            n.set((n.get() * 5 + 1) % 17);
            n.get()
        });
    });
    table.finish();
}

#[cfg(feature = "micromath")]
#[test]
fn floats_of_all_bits_are_converted_or_refused() {
    use zstrip::micromath::Quaternion;
    use zstrip::micromath::vector::F32x3;
    let (mut table, mut rng) = (Table::start(), Rng::new(6));
    for _ in 0..100_000 {
        let mut float = || f32::from_bits(if rng.one_in(3) { rng.bits() as u32 } else { rng.next_u32() });
        let [x, y, z, w] = [float(), float(), float(), float()];
        table.case("Vec3::try_from", (x, y, z), || Vec3::try_from(F32x3 { x, y, z }).is_ok());
        table.case("Affine::try_from a quaternion", (x, y, z, w), || {
            Affine::try_from(Quaternion::new(w, x, y, z)).is_ok()
        });
        table.case("Affine::try_from rows", (x, y, z, w), || Affine::try_from([[x, y, z, w]; 3]).is_ok());
        table.case("Projective::try_from rows", (x, y, z, w), || Projective::try_from([[x, y, z, w]; 4]).is_ok());
    }
    table.finish();
}

fn formats_of<P: PixelFormat>(table: &mut Table, rng: &mut Rng)
where
    P::Raw: std::fmt::Debug,
{
    for _ in 0..2000 {
        let [r, g, b, a] = (rng.bits() as u32).to_le_bytes();
        let (word, weight, raw) = (rng.bits() as u32, rng.bits() as u32, rng.bits() as u16);
        let position = (rng.bits(), rng.bits());
        let (p, q) = (P::pack([r, g, b]), P::pack([b, a, r]));
        table.case("PixelFormat::mix", (p, q, weight), || P::mix(p, q, weight));
        table.case("PixelFormat conversions", (p, q), || {
            (P::add(p, q), P::unpack(p), P::luma(p), P::from_luma(a), P::from_rgb565(raw))
        });
        table.case("PixelFormat colours", p, || P::from_color(P::to_color(p)));
        table.case("PixelFormat::pack_at", ([r, g, b, a], position), || {
            (P::pack_at([r, g, b], position), P::pack_rgba([r, g, b, a], position), P::dither(position)[0])
        });
        table.case("PixelFormat::from_packed", (word, weight), || {
            (P::from_packed(word, P::packed_mask()), P::from_packed(word, weight))
        });
    }
}

#[test]
fn pixel_formats_take_all_values() {
    let (mut table, mut rng) = (Table::start(), Rng::new(3));
    formats_of::<Rgb565>(&mut table, &mut rng);
    formats_of::<Rgb565Be>(&mut table, &mut rng);
    formats_of::<Bgr565>(&mut table, &mut rng);
    formats_of::<Bgr565Be>(&mut table, &mut rng);
    formats_of::<Rgb332>(&mut table, &mut rng);
    formats_of::<Rgb666>(&mut table, &mut rng);
    formats_of::<Rgb888>(&mut table, &mut rng);
    formats_of::<Bgr888>(&mut table, &mut rng);
    formats_of::<Gray8>(&mut table, &mut rng);
    formats_of::<Rgba8888>(&mut table, &mut rng);
    formats_of::<Dithered<Rgb565>>(&mut table, &mut rng);
    formats_of::<Dithered<Bgr565Be>>(&mut table, &mut rng);
    formats_of::<Dithered<Rgb332>>(&mut table, &mut rng);
    table.finish();
}

#[test]
fn dithering_takes_all_values() {
    fn levels_of<C: Levels>(table: &mut Table, dither: Dither<C>, tones: C::Tones) {
        for (x, y) in ENDS.into_iter().flat_map(|x| ENDS.map(|y| (x, y))) {
            for grey in [0, 1, 127, 128, 254, 255] {
                let level = table.case("Dither::level", (grey, x, y), || dither.level(grey, (x, y)));
                assert!(u32::from(level.unwrap_or(0)) < 1 << C::BITS, "{grey} {x} {y}");
                table.case("Dither::color", (grey, x, y), || dither.color(grey, (x, y)));
                table.case("Levels::level", (x, grey), || C::from_level(C::level(tones, x as u32, grey)));
            }
        }
    }
    const RAMP: [u16; 256] = [u16::MAX; 256];
    let mut table = Table::start();
    for dither in [Dither::NEAREST, Dither::BAYER_4, Dither::BAYER_8, Dither::BRIGHT_4, Dither::BRIGHT_8] {
        levels_of::<BinaryColor>(&mut table, dither, ());
    }
    levels_of(&mut table, Dither::<Gray2>::BAYER_8.on_linear_panel(), &RAMP);
    levels_of(&mut table, Dither::<Gray4>::BAYER_4.on_linear_panel(), &RAMP);
    assert_eq!(Gray4::from_level(255).luma(), 15);
    table.finish();
}

#[test]
fn lights_take_all_values() {
    let (mut table, mut rng) = (Table::start(), Rng::new(5));
    for _ in 0..10_000 {
        let (model, v, w, s) = (rng.affine(), rng.vector(), rng.vector(), rng.scalar());
        let bounds = Bounds { center: rng.vector(), half: rng.vector() };
        let sun = table.case("Sun::on", (v, model), || {
            Sun::new(v, Rgb888::WHITE, Rgb888::WHITE).on(&Matte::WHITE.vertex_colors(), &model)
        });
        assert!(sun.is_some());
        let viewer = if rng.one_in(2) { Viewer::At(rng.vector()) } else { Viewer::Toward(rng.vector()) };
        let lighting = Lighting {
            ambient: Rgb888::WHITE,
            directional: [DirectionalLight::new(v, Rgb888::WHITE), DirectionalLight::new(w, Rgb888::WHITE)],
            points: [PointLight::new(v, Rgb888::WHITE, s), PointLight::new(rng.vector(), Rgb888::WHITE, rng.scalar())],
            viewer,
        };
        let material = Material::glossy(Rgb888::WHITE, Rgb888::WHITE, rng.bits() as u8).two_sided();
        let material = if rng.one_in(2) { material.vertex_colors() } else { material };
        let Some(lit) =
            table.case("Lighting::on", (lighting, model, bounds), || lighting.on(material, &model, &bounds))
        else {
            continue;
        };
        let (normal, p, position) = (rng.triple(), rng.triple(), rng.vector());
        table.case("LitMaterial::local", (lit, position), || lit.local(position));
        table.case("LitMaterial::shade_distant", normal, || lit.shade_distant(&normal, [255; 3]));
        table.case("LitMaterial::shade_at", (lit, normal, p), || lit.shade_at(&normal, &p, [255; 3]));
        let near = lit.local(position);
        table.case("LitMaterial::shade_at near", (lit, normal, near), || lit.shade_at(&normal, &near, [255; 3]));
        table.case("LitColor", normal, || Rgb888::from(LitColor::new(normal)));
        table.case("Gouraud::varyings", normal, || Gouraud::varyings(LitColor::new(normal).into()));
    }
    table.finish();
}
