//! Materials under lights against the same equations in double precision.

use crate::reference::rng::Rng;
use crate::support;
use crate::support::{accuracy, strips, whole};
use core::cell::Cell;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::light::{DirectionalLight, Lighting, LitColor, Material, Matte, PointLight, Sun, Unlit, Viewer};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
use zstrip::shader::{Flat, Gouraud, Matcap, Phong, PhongNear, Surface, Textured};
use zstrip::span::{Fragment, Shader};
use zstrip::texture::Tile;
use zstrip::vertex::{VertexRef, VertexShader};
use zstrip::{Cull, State};

type V = [f64; 3];

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn plus(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn times(a: V, s: f64) -> V {
    a.map(|c| c * s)
}

fn unit(a: V) -> V {
    let length = dot(a, a).sqrt();
    if length == 0.0 { a } else { times(a, 1.0 / length) }
}

fn float(v: Vec3) -> V {
    v.to_bits().map(|c| f64::from(c) / 65_536.0)
}

fn apply(m: &Affine, v: V, w: f64) -> V {
    m.to_rows().map(|r| {
        (f64::from(r[0]) * v[0] + f64::from(r[1]) * v[1] + f64::from(r[2]) * v[2] + f64::from(r[3]) * w) / 65_536.0
    })
}

/// The numbers of a material.
#[derive(Clone, Copy)]
struct Paint {
    ambient: [u8; 3],
    diffuse: [u8; 3],
    specular: [u8; 3],
    shininess: u8,
    vertex_colors: bool,
}

impl Paint {
    fn material(&self) -> Material {
        let material = Material::glossy(rgb(self.diffuse), rgb(self.specular), self.shininess);
        let material = material.with_ambient(rgb(self.ambient));
        if self.vertex_colors { material.vertex_colors() } else { material }
    }
}

fn rgb([r, g, b]: [u8; 3]) -> Rgb888 {
    Rgb888::new(r, g, b)
}

/// Colour of a point with a normal, both in the lights' space, and how far its light is from going on or off with n ·
/// l.
fn reference<const D: usize, const P: usize>(
    lighting: &Lighting<D, P>,
    material: &Paint,
    normal: V,
    position: V,
    color: [u8; 3],
) -> (V, f64) {
    let level = |c: [u8; 3]| c.map(|c| f64::from(c) / 255.0);
    let of_light = |c: Rgb888| level([c.r(), c.g(), c.b()]);
    let product = |a: V, b: V| [a[0] * b[0], a[1] * b[1], a[2] * b[2]];
    let toward = match lighting.viewer {
        Viewer::Toward(direction) => unit(float(direction)),
        Viewer::At(eye) => unit(minus(float(eye), position)),
    };
    let mut body = product(level(material.ambient), of_light(lighting.ambient));
    let mut shine = [0.0; 3];
    let mut edge = 1.0_f64;
    let mut light = |direction: V, fade: f64, light: V| {
        let facing = dot(normal, direction);
        if fade > 0.0 && material.shininess > 0 {
            edge = edge.min(facing.abs());
        }
        if facing > 0.0 {
            body = plus(body, times(product(level(material.diffuse), light), facing * fade));
            if material.shininess > 0 {
                let half = unit(plus(direction, toward));
                let power = dot(normal, half).max(0.0).powi(i32::from(material.shininess));
                shine = plus(shine, times(product(level(material.specular), light), power * fade));
            }
        }
    };
    for l in &lighting.directional {
        light(unit(float(l.direction)), 1.0, of_light(l.color));
    }
    for l in &lighting.points {
        let to = minus(float(l.position), position);
        let left = (1.0 - dot(to, to) / f64::from(l.range).powi(2)).max(0.0);
        light(unit(to), left * left, of_light(l.color));
    }
    if material.vertex_colors {
        body = product(body, level(color));
    }
    (plus(body, shine).map(|c| (255.0 * c).min(255.0)), edge)
}

/// Worst and mean errors.
#[derive(Default)]
struct Errors {
    worst: f64,
    sum: f64,
    count: u32,
}

impl Errors {
    fn add(&mut self, found: V, exact: V) -> f64 {
        let off = found.iter().zip(exact).fold(0.0, |worst: f64, (f, e)| worst.max((f - e).abs()));
        for (f, e) in found.iter().zip(exact) {
            self.sum += (f - e).abs();
            self.count += 1;
        }
        self.worst = self.worst.max(off);
        off
    }

    fn check(&self, what: &str, worst: f64, mean: f64) {
        let found = self.sum / f64::from(self.count.max(1));
        println!("{what}: worst {:.3}, mean {found:.4} of 255 over {} channels", self.worst, self.count);
        assert!(self.count > 0 && self.worst <= worst && found <= mean, "{what}: more than {worst}, {mean}");
    }
}

fn word(rng: &mut Rng) -> u32 {
    (rng.next_u64() >> 32) as u32
}

fn random_vector(rng: &mut Rng, reach: f64) -> V {
    let mut one = || (f64::from(word(rng)) / 2f64.powi(31) - 1.0) * reach;
    [one(), one(), one()]
}

fn fixed(v: V) -> Vec3 {
    Vec3::from_bits(v.map(|c| (c * 65_536.0).round() as i32))
}

fn random_color(rng: &mut Rng) -> [u8; 3] {
    let [a, b, c, _] = word(rng).to_le_bytes();
    [a, b, c]
}

fn quantized(v: V) -> [i16; 3] {
    unit(v).map(|c| (c * 16_384.0).round() as i16)
}

/// A mesh in a cube of some half side about some centre.
fn cube(center: V, half: f64) -> [Vec3; 3] {
    [fixed(minus(center, [half; 3])), fixed(plus(center, [half; 3])), fixed(center)]
}

#[test]
fn sampled_normals_are_lit_as_in_double_precision() {
    let seed = 0x11c7;
    let mut rng = Rng::new(seed);
    let mut worst = [[0.0_f64; 2]; 2];
    for (scale, what) in [(1.0, "models of scale 1"), (0.125, "models of scale 1/8"), (30.0, "models of scale 30")] {
        for shininess in [0, 1, 5, 32, 128] {
            let (mut far, mut near) = (Errors::default(), Errors::default());
            let mut skipped = 0;
            for _ in 0..60 {
                let model = Affine::translation(fixed(random_vector(&mut rng, 20.0)))
                    * Affine::rotation(fixed(random_vector(&mut rng, 1.0)), Angle16(word(&mut rng) as u16))
                    * Affine::scale(Scalar::from_num(scale));
                let corners = cube(random_vector(&mut rng, 5.0), 1.5);
                let mesh = Mesh::new(MeshData::new(Positions::Exact(&corners))).expect("a mesh");
                let middle = apply(&model, float(mesh.bounds().center), 1.0);
                let mut directional = || DirectionalLight {
                    direction: fixed(random_vector(&mut rng, 9.0)),
                    color: rgb(random_color(&mut rng).map(|c| c / 2)),
                };
                let directional = [directional(), directional()];
                let mut point = || PointLight {
                    position: fixed(plus(middle, random_vector(&mut rng, 4.0 * scale))),
                    color: rgb(random_color(&mut rng).map(|c| c / 2)),
                    range: Scalar::from_num(3.0 * scale) + Scalar::from_bits((word(&mut rng) >> 14) as i32),
                };
                let points = [point(), point()];
                let eye = plus(middle, times(unit(random_vector(&mut rng, 1.0)), 6.0 * scale));
                let lighting =
                    Lighting { ambient: Rgb888::new(40, 30, 20), directional, points, viewer: Viewer::At(fixed(eye)) };
                let distant = Lighting { points: [], viewer: Viewer::Toward(fixed(eye)), ..without_points(&lighting) };
                let material = Paint {
                    ambient: random_color(&mut rng),
                    diffuse: random_color(&mut rng),
                    specular: random_color(&mut rng),
                    shininess,
                    vertex_colors: word(&mut rng) & 1 != 0,
                };
                let (lit, lit_far) = (
                    lighting.on(material.material(), &model, mesh.bounds()),
                    distant.on(material.material(), &model, mesh.bounds()),
                );
                for _ in 0..200 {
                    let p = fixed(plus(float(mesh.bounds().center), random_vector(&mut rng, 1.5)));
                    let color = random_color(&mut rng);
                    let n = quantized(random_vector(&mut rng, 1.0));
                    let normal = unit(apply(&model, n.map(f64::from), 0.0));
                    let position = apply(&model, float(p), 1.0);
                    let n = n.map(i32::from);

                    let float_of = |c: [i32; 3]| c.map(|c| f64::from(c) / 256.0);
                    let (exact, edge) = reference(&distant, &material, normal, position, color);
                    if edge > 1.0 / 2048.0 {
                        far.add(float_of(lit_far.shade_distant(&n, color).to_bits()), exact);
                    }
                    let (exact, edge) = reference(&lighting, &material, normal, position, color);
                    if edge > 1.0 / 512.0 {
                        near.add(float_of(lit.shade_at(&n, &lit.local(p), color).to_bits()), exact);
                    } else {
                        skipped += 1;
                    }
                }
            }
            assert!(skipped < 1000, "{skipped}");
            if let Some(row) = [0, 128].iter().position(|s| *s == shininess) {
                worst[row] = [worst[row][0].max(far.worst), worst[row][1].max(near.worst)];
            }
            let s = f64::from(shininess);
            // Matrices of 16.16 scale by an eighth not quite evenly: 1/8192 off.
            let uneven = if scale < 1.0 { 0.5 } else { 0.0 };
            far.check(
                &format!("seed {seed:#x}, {what}, far, shininess {shininess}"),
                0.2 + uneven + 0.02 * s,
                0.1 + 0.003 * s,
            );
            near.check(
                &format!("seed {seed:#x}, {what}, near, shininess {shininess}"),
                0.5 + uneven + 0.02 * s,
                0.15 + 0.003 * s,
            );
        }
    }
    accuracy::check("light of far lamps, matte", worst[0][0]);
    accuracy::check("light of near lamps, matte", worst[0][1]);
    accuracy::check("light of far lamps, shininess 128", worst[1][0]);
    accuracy::check("light of near lamps, shininess 128", worst[1][1]);
}

fn without_points<const D: usize, const P: usize>(lighting: &Lighting<D, P>) -> Lighting<D, 0> {
    let Lighting { ambient, directional, viewer, .. } = *lighting;
    Lighting { ambient, directional, points: [], viewer }
}

const SCREEN: (u16, u16) = (96, 64);

/// A curved square before an orthographic camera: corners in clip space, normals that lean outwards.
static CORNERS: [Vec3; 4] = [
    Vec3::from_milli(-1000, -1000, 100),
    Vec3::from_milli(1000, -1000, 300),
    Vec3::from_milli(1000, 1000, 600),
    Vec3::from_milli(-1000, 1000, 400),
];

fn square<'a>(normals: &'a [[i16; 3]; 4], colors: &'a [[u8; 3]; 4]) -> Mesh<'a> {
    Mesh::new(MeshData {
        topology: Topology::Quads,
        normals: Some(normals),
        colors: Some(colors),
        ..MeshData::new(Positions::Exact(&CORNERS))
    })
    .expect("a mesh")
}

const BOTH: State = State { cull: Cull::None, ..State::DEFAULT };

fn normals() -> [[i16; 3]; 4] {
    [[-0.7, -0.6, 1.0], [0.8, -0.5, 0.9], [0.6, 0.7, 1.2], [-0.5, 0.4, 0.8]].map(quantized)
}

const COLORS: [[u8; 3]; 4] = [[255, 255, 255], [200, 10, 100], [20, 240, 90], [130, 140, 250]];

fn lighting() -> Lighting<1, 1> {
    Lighting {
        ambient: Rgb888::new(30, 30, 40),
        directional: [DirectionalLight::new(Vec3::from_milli(400, 700, 900), Rgb888::new(200, 190, 170))],
        points: [PointLight::new(Vec3::from_milli(-300, 200, 1200), Rgb888::new(120, 160, 255), Scalar::from_num(2.5))],
        viewer: Viewer::Toward(Vec3::Z),
    }
}

/// Draws the square and compares each pixel with what `exact` says for the triangle's corners and its barycentric
/// weights.
fn compare(
    what: &str,
    shader: &impl Shader<Rgb888>,
    mesh: &Mesh<'_>,
    exact: impl Fn([usize; 3], V) -> V,
    bounds: (f64, f64),
) {
    let (picture, _, _) =
        whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| scene.draw_with(BOTH, mesh, &Projective::IDENTITY, shader));
    let mut errors = Errors::default();
    let (width, height) = (f64::from(SCREEN.0), f64::from(SCREEN.1));
    for (k, pixel) in picture.iter().enumerate() {
        let (column, row) = ((k % usize::from(SCREEN.0)) as f64 + 0.5, (k / usize::from(SCREEN.0)) as f64 + 0.5);
        let (u, v) = (column / width, 1.0 - row / height);
        // Triangles (0, 1, 2) and (0, 2, 3): below and above the diagonal.
        let (corners, weights) =
            if v < u { ([0, 1, 2], [1.0 - u, u - v, v]) } else { ([0, 2, 3], [1.0 - v, u, v - u]) };
        if (u - v).abs() > 1e-9 {
            errors.add(pixel.map(f64::from), exact(corners, weights));
        }
    }
    errors.check(what, bounds.0, bounds.1);
}

fn interpolated(corners: [usize; 3], weights: V, of: impl Fn(usize) -> V) -> V {
    plus(plus(times(of(corners[0]), weights[0]), times(of(corners[1]), weights[1])), times(of(corners[2]), weights[2]))
}

#[test]
fn pictures_are_those_of_double_precision() {
    let normals = normals();
    let mesh = square(&normals, &COLORS);
    let lighting = lighting();
    for (vertex_colors, shininess) in [(false, 0), (true, 20), (false, 64)] {
        let color = [200, 120, 60];
        let material = Paint { ambient: color, diffuse: color, specular: [90; 3], shininess, vertex_colors };
        let lit = lighting.on(material.material(), &Affine::IDENTITY, mesh.bounds());
        let normal = |k: usize| normals[k].map(|c| f64::from(c) / 16_384.0);
        let position = |k: usize| float(CORNERS[k]);
        let s = f64::from(shininess);

        let per_face = |corners: [usize; 3], _: V| {
            let [a, b, c] = corners.map(position);
            let (p, q) = (minus(b, a), minus(c, a));
            let n = unit([p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]);
            reference(&lighting, &material, n, interpolated(corners, [1.0 / 3.0; 3], position), COLORS[corners[0]]).0
        };
        let name = |frequency: &str| format!("{frequency}, shininess {shininess}");
        compare(&name("per face"), &Flat::new(lit), &mesh, per_face, (1.0 + 0.02 * s, 0.6));

        let per_vertex = |corners: [usize; 3], weights: V| {
            interpolated(corners, weights, |k| reference(&lighting, &material, normal(k), position(k), COLORS[k]).0)
        };
        compare(&name("per vertex"), &Gouraud::new(lit), &mesh, per_vertex, (1.5 + 0.02 * s, 0.5));

        let at = |lighting: &Lighting<1, 1>, corners: [usize; 3], weights: V| {
            let n = unit(interpolated(corners, weights, normal));
            reference(lighting, &material, n, interpolated(corners, weights, position), COLORS[corners[0]]).0
        };
        let near = |corners, weights| at(&lighting, corners, weights);
        compare(&name("per fragment, near"), &PhongNear::new(lit), &mesh, near, (1.2 + 0.04 * s, 0.4));
        let close = Lighting { viewer: Viewer::At(Vec3::from_milli(200, -300, 2000)), ..lighting };
        let lit_close = close.on(material.material(), &Affine::IDENTITY, mesh.bounds());
        let near = |corners, weights| at(&close, corners, weights);
        let shader = PhongNear::new(lit_close);
        compare(&name("per fragment, viewer near"), &shader, &mesh, near, (1.2 + 0.04 * s, 0.4));

        let distant = without_points(&lighting);
        let far = |corners, weights| {
            let n = unit(interpolated(corners, weights, normal));
            reference(&distant, &material, n, [0.0; 3], COLORS[corners[0]]).0
        };
        let lit = distant.on(material.material(), &Affine::IDENTITY, mesh.bounds());
        compare(&name("per fragment"), &Phong::new(lit), &mesh, far, (0.8 + 0.04 * s, 0.4));
    }
}

#[test]
fn matcaps_show_the_texel_of_the_normal() {
    let normals = normals();
    let mesh = square(&normals, &COLORS);
    // A smooth picture, so that a place that is off shows as a small error.
    let mut picture = [[[0_u8; 3]; 64]; 64];
    for (y, row) in picture.iter_mut().enumerate() {
        for (x, texel) in row.iter_mut().enumerate() {
            *texel = [(4 * x) as u8, (4 * y) as u8, 77];
        }
    }
    let turn = Affine::rotation_z(Angle16::from_degrees(30)) * Affine::scale(Scalar::from_num(0.01));
    let shader = Matcap::<Rgb888, 64>::new(&picture, &turn);
    let exact = |corners: [usize; 3], weights: V| {
        let n = interpolated(corners, weights, |k| apply(&turn, normals[k].map(|c| f64::from(c) / 163.84), 0.0));
        // Halfway through the texel that is 4 wide.
        [128.0 + 128.0 * n[0] - 2.0, 128.0 - 128.0 * n[1] - 2.0, 77.0]
    };
    compare("matcap", &shader, &mesh, exact, (2.7, 1.0));

    // Normals that lie in the screen's plane reach the picture's edge and no farther.
    let edge = [[16_384, 0, 0], [0, 16_384, 0], [-16_384, 0, 0], [0, -16_384, 0]];
    let mesh = square(&edge, &COLORS);
    let shader = Matcap::<Rgb888, 64>::new(&picture, &Affine::IDENTITY);
    let exact = |corners: [usize; 3], weights: V| {
        let n = interpolated(corners, weights, |k| edge[k].map(|c| f64::from(c) / 16_384.0));
        [128.0 + 127.5 * n[0] - 2.0, 128.0 - 127.5 * n[1] - 2.0, 77.0]
    };
    compare("matcap at its edge", &shader, &mesh, exact, (3.0, 1.2));
}

#[test]
fn two_sided_materials_light_their_backs() {
    let colors = COLORS;
    let front = normals();
    let back = front.map(|n| n.map(|c| -c));
    let one = Material::glossy(Rgb888::new(200, 120, 60), Rgb888::WHITE, 16);
    let two = one.two_sided();
    let lighting = lighting();
    let picture = |mesh: &Mesh<'_>, material: &Material, frequency: usize, flip: bool| {
        let lit = lighting.on(material, &Affine::IDENTITY, mesh.bounds());
        let far = without_points(&lighting).on(material, &Affine::IDENTITY, mesh.bounds());
        let state =
            State { front: if flip { zstrip::Winding::Clockwise } else { zstrip::Winding::CounterClockwise }, ..BOTH };
        whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| match frequency {
            0 => scene.draw_with(state, mesh, &Projective::IDENTITY, &Gouraud::new(lit)),
            1 => scene.draw_with(state, mesh, &Projective::IDENTITY, &Phong::new(far)),
            _ => scene.draw_with(state, mesh, &Projective::IDENTITY, &PhongNear::new(lit)),
        })
        .0
    };
    for frequency in 0..3 {
        let lit = picture(&square(&front, &colors), &one, frequency, false);
        // Normals that point away, on faces that show their back: turned round, all is as it was.
        let turned = picture(&square(&back, &colors), &two, frequency, true);
        let off = |other: &[[u8; 3]]| {
            let channels = lit.iter().flatten().zip(other.iter().flatten());
            channels.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(255)
        };
        // Normals are rounded upwards on either side.
        assert!(off(&turned) <= 1, "frequency {frequency}: {}", off(&turned));
        assert!(off(&picture(&square(&back, &colors), &one, frequency, true)) > 50, "frequency {frequency}");
    }
}

/// Colours of a surface at vertices that have these normals.
fn at_vertices(surface: &impl Surface, normals: &[[i16; 3]; 4]) -> [LitColor; 4] {
    /// A shader that keeps what it is told. Without varyings, vertices would not be asked for.
    struct Seen<'a, S>(&'a S, Cell<[LitColor; 4]>, Cell<u32>);

    impl<S: Surface> VertexShader for Seen<'_, S> {
        type Varyings = [i32; 1];

        fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 1] {
            let mut all = self.1.get();
            all[vertex.index()] = self.0.vertex(vertex);
            self.1.set(all);
            self.2.set(self.2.get() + 1);
            [0]
        }
    }

    impl<S: Surface> Shader<Rgb888> for Seen<'_, S> {
        type Setup = ();

        fn fragment(&self, _: &Fragment<'_, [i32; 1]>) -> Option<[u8; 3]> {
            None
        }
    }

    let seen = Seen(surface, Cell::default(), Cell::default());
    let mesh = square(normals, &COLORS);
    whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| scene.draw_with(BOTH, &mesh, &Projective::IDENTITY, &seen));
    assert!(seen.2.get() >= 4, "only {} vertices were asked for", seen.2.get());
    seen.1.get()
}

#[test]
fn lights_of_models_scaled_far_down_keep_their_direction() {
    for scale in [1.0, 0.1, 0.01, 0.002] {
        for degrees in (0..360).step_by(7) {
            let turn =
                Affine::rotation_y(Angle16::from_degrees(degrees)) * Affine::rotation_x(Angle16::from_degrees(31));
            let model = turn * Affine::scale(Scalar::from_num(scale));
            let sun = Sun::new(Vec3::from_ints(4, 7, 6), Rgb888::WHITE, Rgb888::BLACK);
            let (small, exact) = (sun.on(&Matte::WHITE, &model), sun.on(&Matte::WHITE, &turn));
            let normals = [[16_384, 0, 0], [0, 16_384, 0], [0, 0, 16_384], [9459, 9459, 9459]];
            for (small, exact) in at_vertices(&small, &normals).into_iter().zip(at_vertices(&exact, &normals)) {
                // Rows of a model scaled by 0.002 have 131 steps.
                let allowed = if scale < 0.01 { 7 * 128 } else { 256 };
                let off = small.to_bits()[0].abs_diff(exact.to_bits()[0]);
                assert!(off <= allowed, "scale {scale}, {degrees} degrees: off by {off} / 256");
            }
        }
    }
}

/// A model with its columns' lengths in any ratio up to 16, sheared, mirrored or flattened at times.
fn uneven_model(rng: &mut Rng) -> Affine {
    let mut factor = || Scalar::from_num(2f64.powf(4.0 * rng.unit() - 2.0) * if rng.one_in(4) { -1.0 } else { 1.0 });
    let scale = Affine::scale_axes(Vec3::new(factor(), factor(), factor()));
    let mut turn = || Affine::rotation(fixed(random_vector(rng, 1.0)), Angle16(word(rng) as u16));
    Affine::translation(Vec3::from_ints(1, -2, 3)) * turn() * scale * turn()
}

/// The normal in the lights' space, and the rate at which the model shortens it: 1 for the longest.
fn turned_normal(model: &Affine, n: [i16; 3]) -> (V, f64) {
    let m = model.to_rows().map(|row| row.map(|c| f64::from(c) / 65_536.0));
    let cross =
        |a: [f64; 4], b: [f64; 4]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let cofactors = [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])];
    let determinant = dot([m[0][0], m[0][1], m[0][2]], cofactors[0]);
    let turned = cofactors.map(|row| dot(row, n.map(f64::from)) / 16_384.0 * determinant.signum());
    let widest = cofactors.iter().flatten().fold(0.0, |widest: f64, c| widest.max(c.abs()));
    (unit(turned), dot(turned, turned).sqrt() / widest)
}

#[test]
fn light_is_right_on_models_of_any_scale() {
    let seed = 0x5ca1e;
    let mut rng = Rng::new(seed);
    let (mut sun_errors, mut lamp_errors) = (Errors::default(), Errors::default());
    let mut worst_normal = 0.0_f64;
    for case in 0..300 {
        let model = if case == 0 { Affine::scale_axes(Vec3::from_ints(4, 1, 1)) } else { uneven_model(&mut rng) };
        let normals = [(); 4].map(|()| quantized(random_vector(&mut rng, 1.0)));
        let direction = fixed(random_vector(&mut rng, 9.0));
        let sun = Sun::new(direction, Rgb888::WHITE, Rgb888::BLACK).on(&Matte::WHITE, &model);
        let middle = apply(&model, [0.0, 0.0, 0.35], 1.0);
        let lighting = Lighting {
            ambient: Rgb888::new(30, 20, 10),
            directional: [DirectionalLight::new(direction, Rgb888::new(90, 120, 100))],
            points: [PointLight::new(
                fixed(plus(middle, random_vector(&mut rng, 6.0))),
                Rgb888::new(100, 90, 120),
                Scalar::from_num(9),
            )],
            viewer: Viewer::At(fixed(plus(middle, times(unit(random_vector(&mut rng, 1.0)), 12.0)))),
        };
        let paint = Paint {
            ambient: [200; 3],
            diffuse: [250, 200, 150],
            specular: [90; 3],
            shininess: 8,
            vertex_colors: false,
        };
        let mesh = square(&normals, &COLORS);
        let lit = lighting.on(paint.material(), &model, mesh.bounds());
        let found = [at_vertices(&sun, &normals), at_vertices(&lit, &normals)].map(|all| all.map(|c| c.to_bits()));
        for k in 0..4 {
            let (normal, length) = turned_normal(&model, normals[k]);
            // Entries of the normals' matrix are within 2⁻¹⁴ of the widest one.
            if length < 1.0 / 8.0 {
                continue;
            }
            for (found, exact) in lit.turned(normals[k]).into_iter().zip(normal) {
                // A model that turned out to be even takes normals as they are.
                if lit.turned(normals[k]) != normals[k] {
                    worst_normal = worst_normal.max((f64::from(found) - 16_384.0 * exact).abs());
                }
            }
            let float_of = |c: [i32; 3]| c.map(|c| f64::from(c) / 256.0);
            let lambert = 255.0 * dot(normal, unit(float(direction))).max(0.0);
            let off = sun_errors.add(float_of(found[0][k]), [lambert; 3]);
            assert!(off < 1.0, "seed {seed:#x} case {case}, sun: off by {off} of 255, {model:?} {:?}", normals[k]);
            let position = apply(&model, float(CORNERS[k]), 1.0);
            let (exact, edge) = reference(&lighting, &paint, normal, position, [0; 3]);
            if edge > 1.0 / 128.0 {
                let off = lamp_errors.add(float_of(found[1][k]), exact);
                assert!(
                    off < 2.0,
                    "seed {seed:#x} case {case}, lamps: off by {off} of 255, {model:?} {:?}",
                    normals[k]
                );
            }
        }
    }
    sun_errors.check("uneven models, sun", 1.0, 0.2);
    lamp_errors.check("uneven models, lamps", 2.0, 0.3);
    accuracy::check("light of a sun, uneven model", sun_errors.worst);
    accuracy::check("light of lamps, uneven model, shininess 8", lamp_errors.worst);
    accuracy::check("component of a normal, uneven model", worst_normal);
}

#[test]
fn shaders_per_face_and_per_fragment_are_right_on_models_of_any_scale() {
    let mut picture = [[[0_u8; 3]; 64]; 64];
    for (y, row) in picture.iter_mut().enumerate() {
        for (x, texel) in row.iter_mut().enumerate() {
            *texel = [(4 * x) as u8, (4 * y) as u8, 77];
        }
    }
    let model = Affine::rotation_y(Angle16::from_degrees(20)) * Affine::scale_axes(Vec3::from_milli(4000, 1000, 2000));
    // Nearly flat, so that interpolating a turned normal is turning an interpolated one.
    let normals = [[-0.20, -0.15, 1.0], [-0.16, -0.15, 1.0], [-0.16, -0.12, 1.0], [-0.20, -0.12, 1.0]].map(quantized);
    let mesh = square(&normals, &COLORS);
    let exact_normal =
        |corners: [usize; 3], weights: V| unit(interpolated(corners, weights, |k| turned_normal(&model, normals[k]).0));
    let matcap = Matcap::<Rgb888, 64>::new(&picture, &model);
    compare(
        "matcap, uneven",
        &matcap,
        &mesh,
        |corners, weights| {
            let n = exact_normal(corners, weights);
            [128.0 + 128.0 * n[0] - 2.0, 128.0 - 128.0 * n[1] - 2.0, 77.0]
        },
        (2.7, 1.2),
    );
    let direction = Vec3::from_milli(-500, -400, 900);
    let lighting = Lighting::directional(Rgb888::BLACK, [DirectionalLight::new(direction, Rgb888::WHITE)]);
    let shades = |corners: [usize; 3], weights: V| {
        [255.0 * dot(exact_normal(corners, weights), unit(float(direction))).max(0.0); 3]
    };
    let lit = lighting.on(Material::matte(Rgb888::WHITE), &model, mesh.bounds());
    compare("Phong, uneven", &Phong::new(lit), &mesh, shades, (1.6, 0.7));
    compare("PhongNear, uneven", &PhongNear::new(lit), &mesh, shades, (1.6, 0.7));
    let sun = Sun::new(direction, Rgb888::WHITE, Rgb888::BLACK).on(&Matte::WHITE, &model);
    compare("Gouraud, uneven", &Gouraud::new(sun), &mesh, shades, (1.6, 0.7));
    // The square's two faces have normals of their own.
    let faces = |corners: [usize; 3], _: V| {
        let [a, b, c] = corners.map(|k| float(CORNERS[k]));
        let (p, q) = (minus(b, a), minus(c, a));
        let cross = unit([p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]);
        [255.0 * dot(turned_normal(&model, quantized(cross)).0, unit(float(direction))).max(0.0); 3]
    };
    compare("Flat, uneven", &Flat::new(sun), &mesh, faces, (1.0, 0.7));
    compare("Flat under lamps, uneven", &Flat::new(lit), &mesh, faces, (1.0, 0.7));
}

#[test]
fn lit_pictures_do_not_depend_on_strips() {
    let normals = normals();
    let mesh = square(&normals, &COLORS);
    let material = Material::glossy(Rgb888::WHITE, Rgb888::WHITE, 30).vertex_colors();
    let lit = lighting().on(material, &Affine::IDENTITY, mesh.bounds());
    let far = without_points(&lighting()).on(material, &Affine::IDENTITY, mesh.bounds());
    // Cut by the side of a perspective camera's near plane too.
    let camera = Projective::perspective(
        Angle16::from_degrees(70),
        Size::new(SCREEN.0.into(), SCREEN.1.into()),
        Scalar::from_num(0.6),
        Scalar::from_num(9),
    );
    let mvp = camera.expect("a camera")
        * Affine::translation(Vec3::from_milli(0, 0, -900))
        * Affine::rotation_y(Angle16::from_degrees(50));
    let texels: [[[u8; 3]; 2]; 2] = [[[10, 20, 30], [200, 20, 30]], [[10, 200, 30], [10, 20, 230]]];
    let draw = |rows: usize, records: usize| {
        strips::<Rgb565>(SCREEN, rows, records, Rgb565::BLACK, |scene| {
            scene.draw_with(BOTH, &mesh, &mvp, &Flat::new(lit));
            scene.draw_with(BOTH, &mesh, &(mvp * Affine::rotation_x(Angle16(3000))), &Gouraud::new(lit));
            scene.draw_with(BOTH, &mesh, &(mvp * Affine::rotation_x(Angle16(6000))), &Phong::new(far));
            scene.draw_with(BOTH, &mesh, &(mvp * Affine::rotation_x(Angle16(9000))), &PhongNear::new(lit));
            let matcap = Matcap::<Rgb888, 2>::new(&texels, &Affine::IDENTITY);
            scene.draw_with(BOTH, &mesh, &(mvp * Affine::rotation_x(Angle16(12_000))), &matcap);
        })
        .0
    };
    let expected = draw(64, 1 << 14);
    for (rows, records) in [(1, 1 << 14), (7, 1 << 14), (7, 0), (16, 90), (64, 0)] {
        assert_eq!(
            support::difference(&draw(rows, records), &expected, SCREEN.0),
            None,
            "{rows} rows, {records} records"
        );
    }
}

/// Draws the square with a texture on a surface, and compares it with the product of both in double precision.
///
/// Texture coordinates go from 0 to 1, and each texel is many pixels wide; pixels at the sides of texels are left out.
fn compare_textured(what: &str, surface: impl Surface, mesh: &Mesh<'_>, exact: impl Fn(usize) -> V) {
    // Levels of RGB565 that are whole numbers of 8 bits, or nearly.
    static TEXELS: [[u16; 2]; 2] = [[0xFFFF, 0xA145], [0x07FF, 0x8410]];
    static CHECKS: Tile<'static, 2, 2> = Tile::new(&TEXELS);
    let texel = |u: f64, v: f64| {
        let raw = u32::from(TEXELS[usize::from(v >= 0.5)][usize::from(u >= 0.5)]);
        let [r, g, b] = [raw >> 11, (raw >> 5) & 63, raw & 31].map(f64::from);
        [r / 31.0, g / 63.0, b / 31.0]
    };
    let shader = Textured::new(&CHECKS).lit(surface);
    let (picture, _, _) =
        whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| scene.draw_with(BOTH, mesh, &Projective::IDENTITY, &shader));
    let mut errors = Errors::default();
    let (width, height) = (f64::from(SCREEN.0), f64::from(SCREEN.1));
    for (k, pixel) in picture.iter().enumerate() {
        let (column, row) = ((k % usize::from(SCREEN.0)) as f64 + 0.5, (k / usize::from(SCREEN.0)) as f64 + 0.5);
        let (u, v) = (column / width, 1.0 - row / height);
        let (corners, weights) =
            if v < u { ([0, 1, 2], [1.0 - u, u - v, v]) } else { ([0, 2, 3], [1.0 - v, u, v - u]) };
        if (u - v).abs() < 1e-9 || (u - 0.5).abs() < 0.02 || (v - 0.5).abs() < 0.02 {
            continue;
        }
        let (light, texel) = (interpolated(corners, weights, &exact), texel(u, 1.0 - v));
        errors.add(pixel.map(f64::from), [light[0] * texel[0], light[1] * texel[1], light[2] * texel[2]]);
    }
    errors.check(what, 2.5, 0.8);
}

#[test]
fn textures_are_multiplied_by_material_vertex_colours_and_light() {
    let normals = normals();
    let (zero, one) = (Scalar::ZERO, Scalar::ONE);
    let uvs = [[zero, one], [one, one], [one, zero], [zero, zero]];
    let mesh = Mesh::new(MeshData { uvs: Some(&uvs), ..*square(&normals, &COLORS).data() }).expect("a mesh");
    let normal = |k: usize| normals[k].map(|c| f64::from(c) / 16_384.0);
    let color = [200, 230, 90];

    // Any lights: highlights are in the product.
    for (shininess, vertex_colors) in [(0, true), (0, false), (16, true)] {
        let paint = Paint { ambient: color, diffuse: color, specular: [90; 3], shininess, vertex_colors };
        let lit = lighting().on(paint.material(), &Affine::IDENTITY, mesh.bounds());
        let exact = |k: usize| reference(&lighting(), &paint, normal(k), float(CORNERS[k]), COLORS[k]).0;
        compare_textured(&format!("lamp, shininess {shininess}, {vertex_colors}"), lit, &mesh, exact);
    }

    // The sun: Lambert's sum of levels, in which 255 is 256 / 256.
    let (sky, shade) = ([210, 200, 170], [40, 45, 60]);
    let direction = Vec3::from_milli(400, 700, 900);
    let sun = Sun::new(direction, rgb(sky), rgb(shade));
    for vertex_colors in [true, false] {
        let matte = if vertex_colors { Matte::new(rgb(color)).vertex_colors() } else { Matte::new(rgb(color)) };
        let exact = |k: usize| {
            let facing = dot(normal(k), unit(float(direction))).max(0.0);
            let channel = |c: usize| {
                let level = |light: [u8; 3]| f64::from(light[c]) / 255.0;
                let vertex = if vertex_colors { level(COLORS[k]) } else { 1.0 };
                (255.0 * level(color) * vertex * (level(shade) + level(sky) * facing)).min(255.0)
            };
            [channel(0), channel(1), channel(2)]
        };
        compare_textured(&format!("sun, {vertex_colors}"), sun.on(&matte, &Affine::IDENTITY), &mesh, exact);
    }

    // No light: colours that are baked into the vertices.
    compare_textured("unlit", Unlit::vertex_colors(), &mesh, |k| COLORS[k].map(f64::from));
    compare_textured("unlit, one colour", Unlit::new(rgb(color)), &mesh, |_| color.map(f64::from));
    // Surfaces of which the compiler does not know the type are surfaces too.
    let surface: &dyn Surface = &Unlit::vertex_colors();
    compare_textured("unlit, behind a reference", surface, &mesh, |k| COLORS[k].map(f64::from));
}

#[test]
fn two_sided_surfaces_light_textures_on_both_sides() {
    let front = normals();
    let back = front.map(|n| n.map(|c| -c));
    let one = Material::from(Material::matte(Rgb888::new(200, 120, 60)));
    let (zero, unit) = (Scalar::ZERO, Scalar::ONE);
    let uvs = [[zero, unit], [unit, unit], [unit, zero], [zero, zero]];
    static WHITE: Tile<'static, 1, 1> = Tile::new(&[[0xFFFF]]);
    let picture = |normals: &[[i16; 3]; 4], material: Material| {
        let mesh = Mesh::new(MeshData { uvs: Some(&uvs), ..*square(normals, &COLORS).data() }).expect("a mesh");
        let shader = Textured::new(&WHITE).lit(lighting().on(material, &Affine::IDENTITY, mesh.bounds()));
        whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| scene.draw_with(BOTH, &mesh, &Projective::IDENTITY, &shader)).0
    };
    let off = |a: &[[u8; 3]], b: &[[u8; 3]]| {
        let channels = a.iter().flatten().zip(b.iter().flatten());
        channels.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(255)
    };
    let lit = picture(&front, one);
    assert!(off(&lit, &picture(&back, one.two_sided())) <= 1);
    assert!(off(&lit, &picture(&back, one)) > 50);
}

#[test]
fn a_surface_without_faces_has_those_of_its_provoking_vertices() {
    /// The number of a vertex as a colour.
    struct Numbered;

    impl Surface for Numbered {
        fn vertex(&self, vertex: &VertexRef<'_>) -> LitColor {
            // Beyond the range: clamped.
            LitColor::new([-5, 1 << 20, (vertex.index() as i32 + 1) << 8])
        }
    }

    let (normals, corners) = (normals(), [2, 0, 1]);
    let mesh = Mesh::new(MeshData {
        topology: Topology::Triangles,
        indices: Some(&corners),
        ..*square(&normals, &COLORS).data()
    })
    .expect("a mesh");
    let shader = Flat::new(Numbered);
    let (picture, _, _) =
        whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| scene.draw_with(BOTH, &mesh, &Projective::IDENTITY, &shader));
    assert!(picture.contains(&[0, 255, 3]) && picture.iter().all(|pixel| [[0; 3], [0, 255, 3]].contains(pixel)));
}
