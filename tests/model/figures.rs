//! Models that tests draw.

use super::builder::{Builder, ClipLists, PartLists, material, node};
use zstrip::bytemuck::Zeroable;
use zstrip::model::container::{
    AlphaMode, Channel, Cluster, Delta, Influence, Interpolation, Joint, Material, Path, Texture, TextureFormat,
};

/// Number of joints of a [`tube`].
pub const JOINTS: usize = 4;
const RINGS: usize = 13;
const AROUND: usize = 12;
/// A fraction of 32,768 is this many units, 16.16: 2.5.
pub const SCALE: i32 = 5 << 15;

/// The two bytes that are nearest to a direction.
pub fn octahedral(n: [f64; 3]) -> [i8; 2] {
    let sum: f64 = n.iter().map(|c| c.abs()).sum();
    let sign = |c: f64| if c < 0.0 { -1.0 } else { 1.0 };
    let (x, y) = (n[0] / sum, n[1] / sum);
    let (x, y) = if n[2] < 0.0 { ((1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y)) } else { (x, y) };
    [(x * 127.0).round() as i8, (y * 127.0).round() as i8]
}

/// A tube along y from -2 to 2, open at its ends: rings of vertices with normals, colours and texture coordinates.
pub fn tube_part() -> PartLists {
    let fraction = |c: f64| (c / 2.5 * 32_768.0).round() as i16;
    let (mut points, mut normals, mut uvs, mut colors) = (vec![], vec![], vec![], vec![]);
    for ring in 0..RINGS {
        let along = ring as f64 / (RINGS - 1) as f64;
        for k in 0..=AROUND {
            let turn = k as f64 / AROUND as f64;
            let (sin, cos) = (turn * core::f64::consts::TAU).sin_cos();
            let radius = 0.6 + 0.2 * (9.0 * along).sin();
            points.push([fraction(radius * sin), fraction(4.0 * along - 2.0), fraction(radius * cos)]);
            normals.push(octahedral([sin, 0.0, cos]));
            uvs.push([turn, 1.0 - along].map(|c| (c * 65_535.0).round() as u16));
            colors.push([(255.0 * along) as u8, 128, (255.0 * turn) as u8]);
        }
    }
    let mut triangles = vec![];
    for ring in 0..RINGS - 1 {
        for k in 0..AROUND {
            let at = |ring: usize, k: usize| (ring * (AROUND + 1) + k) as u16;
            let [a, b, c, d] = [at(ring, k), at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    PartLists { normals, uvs, colors, ..PartLists::new(SCALE, [0; 3], points, triangles) }
}

/// A texture of 16 × 16 texels of RGB565 with three levels.
pub fn texture(builder: &mut Builder) -> Texture {
    let texel = |x: usize, y: usize, side: usize| {
        let (r, g, b) = (31 * x / side, 63 * y / side, if (x ^ y) & 1 == 0 { 31 } else { 8 });
        ((r << 11 | g << 5 | b) as u16).to_le_bytes()
    };
    let data: Vec<u8> = [16, 8, 4]
        .into_iter()
        .flat_map(|side| (0..side * side).flat_map(move |k| texel(k % side, k / side, side)))
        .collect();
    let texels = builder.data(&data);
    let format = TextureFormat::Rgb565 as u8;
    Texture { width: 16, height: 16, format, levels: 3, texels, alpha: u32::MAX, ..Texture::zeroed() }
}

/// A tube of one node, at rest, with a texture.
pub fn textured() -> Builder {
    let mut builder = Builder::default();
    let texture = texture(&mut builder);
    builder.textures.push(texture);
    builder.materials.push(Material { texture: 0, ..material() });
    let mut part = tube_part();
    part.colors.clear();
    builder.parts.push(part);
    builder.nodes.push(zstrip::model::container::Node { parts: 1, ..node() });
    builder
}

fn channel(path: Path, interpolation: Interpolation, target: usize) -> Channel {
    Channel { path: path as u8, interpolation: interpolation as u8, target: target as u16, ..Channel::zeroed() }
}

/// A quaternion of a rotation about z and then about x, in radians.
pub fn quaternion(z: f64, x: f64) -> [i16; 4] {
    let ((sz, cz), (sx, cx)) = ((z / 2.0).sin_cos(), (x / 2.0).sin_cos());
    [sx * cz, -sx * sz, cx * sz, cx * cz].map(|c| (c * 32_767.0).round() as i16)
}

/// The textured tube with joints along its axis, a morph target, and two clips: "bend" by linear, "wave" by cubic and
/// stepped keys.
pub fn animated(morphs: bool) -> Builder {
    let mut builder = textured();
    let part = &mut builder.parts[0];
    part.item.skin = 0;
    // Joints at y = -2, -1, 0, 1; each vertex has the weights of a soft step between them.
    for point in &part.points {
        let along = (f64::from(point[1]) / 32_768.0 * 2.5 + 2.0).clamp(0.0, 3.999);
        let mut weights: Vec<(u8, f64)> =
            (0..JOINTS).map(|j| (j as u8, (1.0 - (along - j as f64 - 0.5).abs() / 1.2).max(0.0).powi(2))).collect();
        weights.sort_by(|a, b| b.1.total_cmp(&a.1));
        let sum: f64 = weights.iter().map(|w| w.1).sum();
        let others: Vec<u8> = weights[1..].iter().map(|w| (w.1 / sum * 256.0).floor() as u8).collect();
        let rigid = others[0] < 40;
        let joints = core::array::from_fn(|k| weights[k].0);
        let weights = if rigid { [0; 3] } else { [others[0], others[1], others[2]] };
        part.influences.push(Influence { joints, weights, zero: 0 });
    }
    let boxes: Vec<_> = (0..JOINTS as u8)
        .map(|joint| {
            let moved = part.points.iter().zip(&part.influences).filter(|(_, influence)| {
                (0..4).any(|k| influence.joints[k] == joint && (k == 0 || influence.weights[k - 1] > 0))
            });
            let (mut low, mut high) = ([i16::MAX; 3], [i16::MIN; 3]);
            for (point, _) in moved {
                for k in 0..3 {
                    (low[k], high[k]) = (low[k].min(point[k]), high[k].max(point[k]));
                }
            }
            let center: [i16; 3] = core::array::from_fn(|k| ((i32::from(low[k]) + i32::from(high[k])) >> 1) as i16);
            // Room for what the morph target adds.
            let half = core::array::from_fn(|k| center[k].abs_diff(low[k]).max(high[k].abs_diff(center[k])) + 4000);
            (center, half)
        })
        .collect();
    builder.nodes[0].parts = 1;
    let mut joints = vec![];
    for (k, (center, half)) in boxes.into_iter().enumerate() {
        let below = if k == 0 { [0, -2 << 16, 0] } else { [0, 1 << 16, 0] };
        builder.nodes.push(zstrip::model::container::Node { parent: k as u16, translation: below, ..node() });
        let inverse_bind = [[SCALE, 0, 0, 0], [0, SCALE, 0, (2 - k as i32) << 16], [0, 0, SCALE, 0]];
        joints.push(Joint { inverse_bind, center, half, node: k as u16 + 1, used: 1 });
    }
    builder.skins.push(joints);
    if morphs {
        add_target(&mut builder);
    }
    let turn = |angles: &[(f64, f64)]| angles.iter().flat_map(|(z, x)| quaternion(*z, *x)).collect::<Vec<i16>>();
    let times = vec![0, 20_000, 40_000, 65_535];
    let mut bend = ClipLists { name: "bend", duration: 1200, channels: vec![] };
    let mut wave = ClipLists { name: "wave", duration: 900, channels: vec![] };
    for joint in 1..=JOINTS {
        let angle = 0.15 * joint as f64;
        let rotation = channel(Path::Rotation, Interpolation::Linear, joint);
        let keys = turn(&[(0.0, 0.0), (angle, 0.3 * angle), (-angle, angle), (0.0, 0.0)]);
        bend.channels.push((rotation, times.clone(), keys));
        // Cubic: tangent, value, tangent.
        let cubic = channel(Path::Rotation, Interpolation::Cubic, joint);
        let value = [quaternion(0.0, 0.0), quaternion(-angle, angle), quaternion(0.0, 0.0)];
        let tangents = [[3000, 0, -2000, 0], [0, 1500, 900, -300], [-700, 200, 100, 0]];
        let keys = (0..3).flat_map(|k| [tangents[k], value[k], tangents[(k + 1) % 3]]).flatten().collect();
        wave.channels.push((cubic, vec![0, 30_000, 65_535], keys));
    }
    let moved =
        Channel { scale: 1 << 16, offset: [0, -2 << 16, 0], ..channel(Path::Translation, Interpolation::Linear, 1) };
    bend.channels.insert(1, (moved, vec![0, 65_535], vec![0, 0, 0, 9000, -3000, 20_000]));
    let sized = Channel { scale: 1 << 16, offset: [1 << 16; 3], ..channel(Path::Scale, Interpolation::Step, 2) };
    wave.channels.insert(2, (sized, vec![0, 50_000], vec![0, 0, 0, 3000, 3000, 3000]));
    if morphs {
        let weights = Channel { weights: 1, ..channel(Path::Weights, Interpolation::Linear, 0) };
        bend.channels.push((weights, vec![0, 30_000, 65_535], vec![0, 1 << 14, 0]));
    }
    builder.clips = vec![bend, wave];
    builder
}

/// Adds a morph target to the first part: a bulge of some rings.
pub fn add_target(builder: &mut Builder) {
    let part = &mut builder.parts[0];
    let first = 4 * (AROUND + 1);
    let deltas = part.points[first..9 * (AROUND + 1)]
        .iter()
        .map(|[x, _, z]| Delta { point: [x / 4, 300, z / 4], normal: [0, 20, -5], zero: 0 })
        .collect();
    part.targets.push((first as u16, deltas));
    builder.weights.push(0);
}

/// A tube of three nodes and many kinds of parts: every texture format, alpha mode, attribute and kind of index.
pub fn many_parts() -> Builder {
    let mut builder = textured();
    let alpha: Vec<u8> = (0..16 * 8).map(|k: usize| (k * 37 % 256) as u8).collect();
    let alpha = builder.data(&alpha);
    builder.textures[0].levels = 1;
    builder.textures.push(Texture { alpha, ..builder.textures[0] });
    let palette = builder.data(&[255, 0, 0, 0, 255, 0, 0, 0, 255, 200, 200, 40]);
    let data: Vec<u8> = (0..256_usize).map(|k| (k * 7 % 5) as u8).collect();
    let texels = builder.data(&data);
    for format in [
        TextureFormat::Palette8,
        TextureFormat::Palette4,
        TextureFormat::Palette2,
        TextureFormat::Palette1,
        TextureFormat::Gray8,
        TextureFormat::Mask,
    ] {
        let colors = if matches!(format, TextureFormat::Gray8 | TextureFormat::Mask) { 0 } else { 4 };
        let texture = Texture {
            width: 16,
            height: 16,
            format: format as u8,
            levels: 1,
            texels,
            palette,
            colors,
            alpha: u32::MAX,
        };
        builder.textures.push(texture);
    }
    builder.materials.clear();
    builder.parts.clear();
    for number in 0..builder.textures.len() as u16 {
        let modes = [AlphaMode::Opaque, AlphaMode::Mask, AlphaMode::Blend];
        let alpha_mode = modes[usize::from(number) % 3] as u8;
        builder.materials.push(Material {
            texture: number,
            alpha_mode,
            cutoff: 100,
            color: [250, 240, 230, 200],
            ..material()
        });
        let mut part = tube_part();
        part.item.material = number;
        if number % 2 == 0 {
            part.colors.clear();
        }
        if number % 4 == 1 {
            part.small_uvs = part.uvs.iter().map(|uv| uv.map(|c| (c >> 8) as u8)).collect();
            part.item.uv_shift = 8;
            part.item.uv_offset = [1 << 14, -(1 << 15)];
        }
        builder.parts.push(part);
    }
    // Without textures: by vertices, by faces, unlit, see-through and seen from both sides, with highlights,
    // see-through by faces.
    for kind in 0..6_u16 {
        let flags = [0, 0, Material::UNLIT, Material::DOUBLE_SIDED, 0, 0][usize::from(kind)];
        let alpha_mode = if kind == 3 || kind == 5 { AlphaMode::Blend } else { AlphaMode::Opaque } as u8;
        let shininess = if kind == 4 { 16 } else { 0 };
        let color = [90, 160, 220, 120];
        let item = Material { color, flags, alpha_mode, shininess, specular: [255; 3], ..material() };
        let mut part = tube_part();
        part.item.material = builder.materials.len() as u16;
        builder.materials.push(item);
        part.uvs.clear();
        if kind == 1 || kind == 5 {
            part.normals.clear();
        }
        builder.parts.push(part);
    }
    builder.nodes = (0..builder.parts.len() as u16)
        .map(|k| zstrip::model::container::Node {
            parent: if k == 0 { u16::MAX } else { k - 1 },
            first_part: k,
            parts: 1,
            translation: [1 << 15, 1 << 13, -(1 << 14)],
            rotation: quaternion(0.1, 0.07),
            scale: [1 << 16, 63_000, -(1 << 16)],
            ..node()
        })
        .collect();
    builder
}

/// The tube with clusters of four quads each, whose cones are those of their normals.
pub fn clustered() -> Builder {
    let mut builder = textured();
    let part = &mut builder.parts[0];
    // Columns of quads, so that normals of a cluster point into one direction.
    let mut triangles = vec![];
    for (k, rings) in (0..AROUND).flat_map(|k| [0..4, 4..8, 8..RINGS - 1].map(|rings| (k, rings))) {
        let first = triangles.len();
        for ring in rings {
            let quad = 2 * (ring * AROUND + k);
            triangles.extend_from_slice(&part.triangles[quad..quad + 2]);
        }
        let (mut low, mut high) = ([i16::MAX; 3], [i16::MIN; 3]);
        for point in triangles[first..].as_flattened().iter().map(|k| part.points[usize::from(*k)]) {
            for k in 0..3 {
                (low[k], high[k]) = (low[k].min(point[k]), high[k].max(point[k]));
            }
        }
        let center: [i16; 3] = core::array::from_fn(|k| ((i32::from(low[k]) + i32::from(high[k])) >> 1) as i16);
        let half = core::array::from_fn(|k| center[k].abs_diff(low[k]).max(high[k].abs_diff(center[k])));
        // The normals of the faces, and the one in their middle.
        let normals: Vec<[f64; 3]> = triangles[first..]
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|k| part.points[usize::from(k)].map(f64::from));
                let (u, v): ([f64; 3], [f64; 3]) =
                    (core::array::from_fn(|k| b[k] - a[k]), core::array::from_fn(|k| c[k] - a[k]));
                let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
                let length = n.iter().map(|c| c * c).sum::<f64>().sqrt();
                n.map(|c| c / length)
            })
            .collect();
        let sum: [f64; 3] = core::array::from_fn(|k| normals.iter().map(|n| n[k]).sum());
        let length = sum.iter().map(|c| c * c).sum::<f64>().sqrt();
        let axis = sum.map(|c| (c / length * 127.0).round() as i8);
        let least =
            normals.iter().map(|n| (0..3).map(|k| n[k] * f64::from(axis[k]) / 127.0).sum::<f64>()).fold(1.0, f64::min);
        let cutoff = if least <= 0.1 { 127 } else { ((1.0 - least * least).sqrt() * 127.0 + 2.0).min(127.0) as i8 };
        part.clusters.push(Cluster {
            center,
            half,
            first_triangle: first as u16,
            triangles: (triangles.len() - first) as u16,
            axis,
            cutoff,
        });
    }
    part.triangles = triangles;
    builder
}
