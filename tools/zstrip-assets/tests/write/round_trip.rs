//! What was written is what was read, within the stated errors.

use zstrip::bytemuck::{Pod, pod_collect_to_vec, pod_read_unaligned};
use zstrip::model::container::{
    Cluster, Header, Material as MaterialItem, Part, SectionKind, Texture as TextureItem, TextureFormat,
};
use zstrip_assets::{
    AlphaMode, Animation, Errors, Import, Interpolation, Material, Options, Path, TextureKind, Transform, UvSize, Wrap,
    WriteNote, WriteOptions, Written, write, write_rust,
};

use crate::figures::{animated, channel, image, of_mesh, sphere, textured};
use crate::support::{Folder, Random};

fn written(import: &Import) -> Written {
    written_with(import, &WriteOptions::default())
}

fn written_with(import: &Import, options: &WriteOptions) -> Written {
    write(import, options).unwrap_or_else(|error| panic!("{error}"))
}

fn section<T: Pod>(written: &Written, kind: SectionKind) -> Vec<T> {
    let header: Header = pod_read_unaligned(&written.bytes[..size_of::<Header>()]);
    let section = header.table[kind as usize];
    let bytes = &written.bytes[section.offset as usize..][..section.count as usize * size_of::<T>()];
    pod_collect_to_vec(bytes)
}

#[test]
fn attributes_are_within_half_a_step() {
    for radius in [0.2, 1.0, 777.0] {
        let mut mesh = sphere(24, 16, radius);
        let count = mesh.vertices.len();
        mesh.vertices.colors = (0..count).map(|k| [k as f32 / count as f32, 0.3, 1.0, 1.0]).collect();
        let options = WriteOptions { mips: false, ..WriteOptions::default() };
        let report = written_with(&textured(mesh, image(), AlphaMode::Opaque), &options).report;
        let errors = report.errors;
        assert!(errors.position_steps <= 0.5 + 1e-6, "{report}");
        assert!(errors.position <= 0.87 * radius / 32_700.0 + 1e-5, "{report}");
        assert!(errors.normal < 0.95 && errors.normal > 0.0, "{report}");
        assert!(errors.uv <= 1.0 / 65_536.0 && errors.color <= 0.5 + 1e-3, "{report}");
        assert_eq!((errors.texel, report.triangles, report.draws), (0.0, 768, 1));
        assert!(report.notes.is_empty(), "{report}");
    }
}

#[test]
fn poses_are_those_of_the_import() {
    for morphs in [false, true] {
        let exact = written_with(&animated(morphs), &WriteOptions { key_error: 0.0, ..WriteOptions::default() });
        let errors = exact.report.errors;
        // The size is 3 units. Weights are 256ths, and the rest pose has no other error than that.
        assert!(errors.rest < 3.0 / 256.0 && errors.pose < 0.02, "{}", exact.report);
        assert!(errors.pose_normal < 3.0 && errors.posed_vertices > 2000, "{}", exact.report);
        assert_eq!(exact.report.clips[0].2, exact.report.clips[0].3);
        assert!(exact.report.pose_words > 12 * 7, "{}", exact.report);
    }
}

#[test]
fn keys_on_a_line_are_left_out() {
    let mut import = animated(false);
    let times: Vec<f32> = (0..2000).map(|k| k as f32 / 500.0).collect();
    // A corner at 1 s, and a channel that does nothing.
    let bent: Vec<f32> = times.iter().flat_map(|t| [t.min(1.0), 0.0, 0.0]).collect();
    let still: Vec<f32> = times.iter().flat_map(|_| [0.0, 0.0, 0.0, 1.0]).collect();
    import.animations = vec![Animation {
        name: "line".to_owned(),
        channels: vec![
            channel(1, Path::Translation, Interpolation::Linear, &times, &bent),
            channel(2, Path::Rotation, Interpolation::Linear, &times, &still),
        ],
    }];
    let report = written(&import).report;
    let (_, duration, before, after) = &report.clips[0];
    assert_eq!((*duration, *before), (3998, 4000));
    // Every 512th key stays, the corner, and the end.
    assert!(*after <= 7, "{after} keys");
    assert!(report.errors.pose < 0.01, "{report}");
}

#[test]
fn steep_curves_and_large_weights_are_reported() {
    let mut import = animated(true);
    let half = 0.5_f32.sqrt();
    import.animations[0].channels = vec![
        channel(
            2,
            Path::Rotation,
            Interpolation::Cubic,
            &[0.0, 1.0],
            &[0., 0., 0., 0., 0., 0., 0., 1., 4., 0., 0., 0., 3., 0., 0., 0., half, 0., 0., half, 0., 0., 0., 0.],
        ),
        channel(0, Path::Weights, Interpolation::Step, &[0.0, 0.5], &[0.0, 0.0, 3.0, 0.0]),
        channel(0, Path::Translation, Interpolation::Step, &[0.5, 0.500_000_1], &[0.0; 6]),
    ];
    let report = written(&import).report;
    for note in [WriteNote::CurvesCut { channels: 1 }, WriteNote::WeightsLimited { weights: 1 }] {
        assert!(report.notes.contains(&note), "{note} is missing in\n{report}");
    }
}

#[test]
fn meshes_of_many_vertices_and_triangles_become_parts() {
    // 90,601 vertices: the importer splits it.
    let mut text = String::new();
    let side = 301;
    for k in 0..side * side {
        let (x, y) = (k % side, k / side);
        text += &format!("v {x} {y} {}\n", (x * y) % 7);
    }
    for k in (0..side * (side - 1)).filter(|k| k % side + 1 < side) {
        text += &format!("f {} {} {} {}\n", k + 1, k + 2, k + side + 2, k + side + 1);
    }
    let folder = Folder::new().with("grid.obj", text);
    let (import, _) = folder.import("grid.obj", &Options::default()).expect("a grid");
    let report = written(&import).report;
    assert_eq!(report.triangles, 2 * 300 * 300);
    assert!(report.parts >= 3, "{report}");
    assert!(report.errors.position_steps <= 0.5 + 1e-6, "{report}");
    // 65,026 vertices in one mesh, but 129,032 triangles.
    let report = written(&of_mesh(sphere(253, 255, 2.0))).report;
    assert_eq!((report.triangles, report.parts), (2 * 253 * 255, 2), "{report}");
    assert!(report.notes.contains(&WriteNote::Divided { mesh: 0, parts: 2 }), "{report}");
}

#[test]
fn alpha_is_written_where_a_material_has_it() {
    let mut transparent = image();
    (0..64).for_each(|k| transparent.texels[4 * k + 3] = (k * 4) as u8);
    let mut import = textured(sphere(8, 8, 1.0), transparent, AlphaMode::Mask { cutoff: 0.25 });
    import.materials[0].color = [1.0, 1.0, 1.0, 0.5];
    let opaque = Material { alpha: AlphaMode::Opaque, ..import.materials[0].clone() };
    import.materials.push(opaque);
    import.meshes.push(import.meshes[0].clone());
    import.meshes[1].material = Some(1);
    import.nodes[0].meshes.push(1);
    let found = written(&import);
    let textures: Vec<TextureItem> = section(&found, SectionKind::Textures);
    assert_eq!(textures.iter().map(|t| t.alpha == u32::MAX).collect::<Vec<_>>(), [false, true]);
    let materials: Vec<MaterialItem> = section(&found, SectionKind::Materials);
    // A cutoff of 0.25, where the material halves alpha, is one of 0.5.
    assert_eq!(materials.iter().map(|m| (m.alpha_mode, m.cutoff)).collect::<Vec<_>>(), [(1, 128), (0, 0)]);
    let bytes: Vec<u8> = section(&found, SectionKind::Bytes);
    let alpha = &bytes[textures[0].alpha as usize..];
    // Texels 0 to 3, 4 bits each: 0, 4, 8 and 12 of 255 are 0, 0, 0 and 1 of 15.
    assert_eq!(alpha[..2], [0x00, 0x01]);
    assert_eq!(alpha[31], 0xFF);
}

#[test]
fn texture_coordinates_take_8_bits_where_those_are_exact() {
    let mut mesh = sphere(8, 8, 1.0);
    let part = |written: &Written| section::<Part>(written, SectionKind::Parts)[0];
    let make = |mesh: &zstrip_assets::Mesh, uvs| {
        let options = WriteOptions { uvs, ..WriteOptions::default() };
        written_with(&textured(mesh.clone(), image(), AlphaMode::Opaque), &options)
    };
    // Eighths.
    let found = make(&mesh, UvSize::Fitting);
    assert_eq!((part(&found).uv_bits, found.report.errors.uv), (8, 0.0));
    mesh.vertices.uvs.iter_mut().for_each(|uv| uv[0] = uv[0] * 0.77 + 7.1);
    let found = make(&mesh, UvSize::Fitting);
    assert_eq!(part(&found).uv_bits, 16);
    assert!(found.report.errors.uv <= 1.0 / 65_536.0 + 1e-7, "{}", found.report);
    let found = make(&mesh, UvSize::Bits8);
    assert_eq!(part(&found).uv_bits, 8);
    assert!((0.0005..1.0 / 256.0 + 1e-7).contains(&found.report.errors.uv), "{}", found.report);
    // Ten times around.
    mesh.vertices.uvs.iter_mut().for_each(|uv| uv[0] = uv[0] * 10.0 - 33.0);
    let found = make(&mesh, UvSize::Fitting);
    assert!(found.report.errors.uv <= 0.5 / 4096.0, "{}", found.report);
}

/// Red, green, blue of the texels of a level, as docs/container.md defines them; a mask's bits are 0 and 255.
fn texels(written: &Written, level: u8) -> Vec<[u8; 3]> {
    let texture = section::<TextureItem>(written, SectionKind::Textures)[0];
    let bytes: Vec<u8> = section(written, SectionKind::Bytes);
    let format = TextureFormat::of(texture.format).expect("a format");
    let size = |level: u8| ((texture.width >> level).max(1), (texture.height >> level).max(1));
    let (width, height) = size(level);
    let before: u64 = (0..level).map(|level| format.bytes(size(level).0, size(level).1)).sum();
    let first = before as usize + texture.texels as usize;
    let bits = [16, 8, 4, 2, 1, 8, 1][usize::from(texture.format)];
    let of_row = (usize::from(width) * bits).div_ceil(8);
    let places = (0..usize::from(height)).flat_map(|y| (0..usize::from(width)).map(move |x| (x, y)));
    let texel = |(x, y): (usize, usize)| {
        let row = &bytes[first + y * of_row..][..of_row];
        if bits == 16 {
            let raw = u16::from_le_bytes([row[2 * x], row[2 * x + 1]]);
            let part = |from: u16, most: u16| (f64::from(raw >> from & most) * 255.0 / f64::from(most)).round() as u8;
            return [part(11, 31), part(5, 63), part(0, 31)];
        }
        let number = row[x * bits / 8] >> (8 - bits - x * bits % 8) & (0xFF >> (8 - bits));
        match texture.format {
            5 => [number; 3],
            6 => [255 * number; 3],
            _ => bytes[texture.palette as usize + 3 * usize::from(number)..][..3].try_into().expect("a colour"),
        }
    };
    places.map(texel).collect()
}

/// Returns the largest difference of a channel, and the mean one.
fn differences(found: &[[u8; 3]], expected: &[[f64; 3]]) -> (f64, f64) {
    assert_eq!(found.len(), expected.len());
    let channels = found.as_flattened().iter().zip(expected.as_flattened());
    let off: Vec<f64> = channels.map(|(a, b)| (f64::from(*a) - b).abs()).collect();
    (off.iter().copied().fold(0.0, f64::max), off.iter().sum::<f64>() / off.len() as f64)
}

#[test]
fn textures_have_the_format_that_is_asked_for() {
    let mut odd = image();
    (odd.width, odd.height) = (16, 4);
    // Alpha that only a mask shows, of any value.
    (0..64).for_each(|k| odd.texels[4 * k + 3] = (k * 37 % 256) as u8);
    let of_image = |texel: fn([f64; 4]) -> [f64; 3]| -> Vec<[f64; 3]> {
        odd.texels.as_chunks::<4>().0.iter().map(|rgba| texel(rgba.map(f64::from))).collect()
    };
    let plain = of_image(|[r, g, b, _]| [r, g, b]);
    let gray = of_image(|[r, g, b, _]| [0.299 * r + 0.587 * g + 0.114 * b; 3]);
    let mask = of_image(|[.., a]| [if a >= 128.0 { 255.0 } else { 0.0 }; 3]);
    for (kind, format, colors, expected, rounding, worst) in [
        (TextureKind::Rgb565, 0, 0, &plain, 0.0, 0.0),
        (TextureKind::Palette, 2, 8, &plain, 0.0, 0.0),
        // The worst is blue in grey.
        (TextureKind::Gray, 5, 0, &gray, 0.5, 226.0),
        (TextureKind::Mask, 6, 0, &mask, 0.0, 0.0),
    ] {
        let options = WriteOptions { textures: kind, mips: false, ..WriteOptions::default() };
        let found = written_with(&textured(sphere(8, 8, 1.0), odd.clone(), AlphaMode::Opaque), &options);
        let texture = section::<TextureItem>(&found, SectionKind::Textures)[0];
        assert_eq!((texture.width, texture.height, texture.levels), (16, 4, 1));
        assert_eq!((texture.format, texture.colors), (format, colors), "{kind:?}");
        assert!(differences(&texels(&found, 0), expected).0 <= rounding, "{kind:?}");
        assert_eq!(found.report.errors.texel, worst, "{kind:?}");
    }
}

#[test]
fn large_textures_are_shrunk_to_a_palette() {
    // 100 × 60 texels of 6000 colours, at most 64 per side: 64 × 32, and levels down to 4 × 2.
    let rgba = (0..6000).flat_map(|k| [(k % 100 * 2) as u8, (k / 100 * 4) as u8, (k % 7) as u8, 255]).collect();
    let large = zstrip_assets::Image { name: "large".to_owned(), width: 100, height: 60, texels: rgba };
    for (textures, format, most, mean) in
        [(TextureKind::Palette, 1, 16.0, 4.0), (TextureKind::Palette16, 2, 60.0, 12.0)]
    {
        let options = WriteOptions { textures, max_texture: 64, ..WriteOptions::default() };
        let found = written_with(&textured(sphere(8, 8, 1.0), large.clone(), AlphaMode::Opaque), &options);
        let texture = section::<TextureItem>(&found, SectionKind::Textures)[0];
        assert_eq!((texture.width, texture.height, texture.levels, texture.format), (64, 32, 5, format));
        for level in 0..3 {
            // Red grows to the right and green downwards; blue is 3 in the mean.
            let [columns, rows] = [64 >> level, 32 >> level];
            let middle = |k: usize, count: usize, of: f64| (k as f64 + 0.5) * of / count as f64 - 0.5;
            let expected: Vec<_> = (0..columns * rows)
                .map(|k| [2.0 * middle(k % columns, columns, 100.0), 4.0 * middle(k / columns, rows, 60.0), 3.0])
                .collect();
            let (worst, found) = differences(&texels(&found, level), &expected);
            assert!(worst < most && found < mean, "{textures:?} level {level}: {worst} {found}");
        }
        assert!((1.0..most).contains(&found.report.errors.texel), "{}", found.report);
        let resized = WriteNote::Resized { image: "large".to_owned(), from: [100, 60], to: [64, 32] };
        assert!(found.report.notes.contains(&resized), "{}", found.report);
    }
}

#[test]
fn coordinates_of_textures_that_do_not_repeat_stay_inside_or_are_reported() {
    let mut import = textured(sphere(8, 8, 1.0), image(), AlphaMode::Opaque);
    import.materials[0].texture.as_mut().expect("a texture").wrap = [Wrap::Clamp, Wrap::Mirror];
    import.materials[0].name = "label".to_owned();
    let found = written(&import);
    assert!(found.report.notes.is_empty());
    // Half a texel, of 8 texels, away from the sides.
    let part: Part = section(&found, SectionKind::Parts)[0];
    let stored: Vec<[u16; 2]> = match part.uv_bits {
        8 => section::<[u8; 2]>(&found, SectionKind::SmallUvs).iter().map(|uv| uv.map(u16::from)).collect(),
        _ => section(&found, SectionKind::Uvs),
    };
    let value = |k: usize, c: u16| (part.uv_offset[k] + (i32::from(c) << part.uv_shift)) as f64 / 65_536.0;
    for k in 0..2 {
        let all: Vec<f64> = stored.iter().map(|uv| value(k, uv[k])).collect();
        let (low, high) = (all.iter().copied().fold(9.0, f64::min), all.iter().copied().fold(-9.0, f64::max));
        assert!((low - 0.0625).abs() < 1e-4 && (high - 0.9375).abs() < 1e-4, "{k}: {low} to {high}");
    }
    // In the tile above, v goes the other way.
    import.meshes[0].vertices.uvs.iter_mut().for_each(|uv| uv[1] -= 1.0);
    assert!(written(&import).report.notes.is_empty());
    // One vertex beyond a side: the triangles around it are cut there.
    import.meshes[0].vertices.uvs[3][1] = 1.5;
    let found = written(&import);
    let [WriteNote::Cut { material: 0, triangles, into, .. }] = found.report.notes[..] else {
        panic!("{}", found.report);
    };
    assert_eq!(found.report.triangles, 128 - triangles + into);
    // The three around it, which cross v = 0 and 1, and those beside them.
    assert!((3..=6).contains(&triangles) && into >= 3 * triangles, "{}", found.report);
    // Too many sides to cut it at.
    import.meshes[0].vertices.uvs[3][1] = 150.0;
    let report = written(&import).report;
    let wrap = [Wrap::Repeat, Wrap::Mirror];
    let range = [[0.0, 1.0], [-1.0, 150.0]];
    let note = WriteNote::Wrapped { material: 0, name: "label".to_owned(), wrap, range };
    assert!(report.notes.contains(&note), "{report}");
    assert!(report.to_string().contains("is mirrored along v in the file, where v goes from -1.000 to 150.000"));
}

#[test]
fn texels_per_unit_are_those_within_the_sides_of_a_clamped_texture() {
    let mut import = textured(sphere(16, 16, 1.0), image(), AlphaMode::Opaque);
    let texels = |import: &Import| section::<Part>(&written(import), SectionKind::Parts)[0].texels_per_unit;
    // Three times as many texels on the same sphere, repeated and clamped.
    import.meshes[0].vertices.uvs.iter_mut().for_each(|uv| *uv = uv.map(|c| 3.0 * c - 1.0));
    let repeated = texels(&import);
    import.materials[0].texture.as_mut().expect("a texture").wrap = [Wrap::Clamp; 2];
    let clamped = texels(&import);
    // The middle of the sphere is wider than the mean, and triangles that reach half a texel beyond a side are not cut.
    // With all of the sphere, it would be 0.29.
    let part = f64::from(clamped) / f64::from(repeated);
    assert!((0.6..1.1).contains(&part), "{clamped} of {repeated}");
}

#[test]
fn moved_vertices_on_cuts_follow_their_joints_and_targets() {
    for morphs in [false, true] {
        let mut import = animated(morphs);
        let of = textured(sphere(2, 2, 1.0), image(), AlphaMode::Opaque);
        (import.materials, import.images) = (of.materials, of.images);
        import.materials[0].texture.as_mut().expect("a texture").wrap = [Wrap::Clamp, Wrap::Mirror];
        let mesh = &mut import.meshes[0];
        mesh.material = Some(0);
        mesh.vertices.uvs.iter_mut().for_each(|uv| *uv = uv.map(|c| 2.1 * c - 0.5));
        let found = written(&import);
        assert!(found.report.notes.iter().any(|note| matches!(note, WriteNote::Cut { .. })), "{}", found.report);
        assert!(found.report.vertices > mesh_vertices(&import), "{}", found.report);
        // Those of the sphere as it is, in units: it has 1.5 of them.
        let plain = written(&animated(morphs)).report.errors;
        let Errors { pose, rest, pose_normal, .. } = found.report.errors;
        assert!(pose < 1.2 * plain.pose && rest < 1.2 * plain.rest, "{} {}", found.report, plain.pose);
        assert!(pose_normal < 1.0, "{}", found.report);
    }
}

fn mesh_vertices(import: &Import) -> usize {
    import.meshes.iter().map(|mesh| mesh.vertices.positions.len()).sum()
}

#[test]
fn sheared_nodes_are_two() {
    let mut import = of_mesh(sphere(8, 8, 1.0));
    let shear = [[1.0, 0.2, 0.0, 0.0], [0.7, 1.0, 0.0, 0.0], [0.1, 0.0, -2.0, 0.0], [3.0, 0.0, 1.0, 1.0]];
    import.nodes[0].transform = Transform::Matrix(shear);
    let report = written(&import).report;
    assert!(report.notes.contains(&WriteNote::Sheared { nodes: 1 }), "{report}");
    assert!(report.errors.rest < 0.001, "{report}");
}

#[test]
fn cones_of_clusters_hold_from_every_eye() {
    let import = of_mesh(sphere(40, 30, 1.0));
    let found = written(&import);
    let (clusters, parts) =
        (section::<Cluster>(&found, SectionKind::Clusters), section::<Part>(&found, SectionKind::Parts));
    let points: Vec<[i16; 3]> = section(&found, SectionKind::Points);
    let indices: Vec<u16> = section(&found, SectionKind::Indices);
    assert_eq!(parts[0].clusters as usize, clusters.len());
    let mut random = Random(11);
    let mut culled = 0;
    for _ in 0..300 {
        let eye: [f64; 3] = std::array::from_fn(|_| (random.part() - 0.5) * 200_000.0);
        for cluster in &clusters {
            let towards: [f64; 3] = std::array::from_fn(|k| f64::from(cluster.center[k]) - eye[k]);
            let length = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
            let radius = length(cluster.half.map(f64::from));
            let along: f64 = (0..3).map(|k| towards[k] * f64::from(cluster.axis[k]) / 127.0).sum();
            if cluster.cutoff == 127 || along < f64::from(cluster.cutoff) / 127.0 * length(towards) + radius {
                continue;
            }
            culled += 1;
            let first = 3 * usize::from(cluster.first_triangle);
            for triangle in indices[first..][..3 * usize::from(cluster.triangles)].chunks(3) {
                let [a, b, c] = [0, 1, 2].map(|k| points[usize::from(triangle[k])].map(f64::from));
                let [p, q] = [b, c].map(|p| -> [f64; 3] { std::array::from_fn(|k| p[k] - a[k]) });
                let n = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
                let facing: f64 = (0..3).map(|k| n[k] * (eye[k] - a[k])).sum();
                assert!(facing <= 0.0, "a triangle that faces {eye:?} is culled by {cluster:?}");
            }
        }
    }
    assert!(culled > 300, "{culled} of {}", 300 * clusters.len());
}

#[test]
fn rust_source_names_the_container_and_clips() {
    let (source, written) =
        write_rust(&animated(true), "2 Großer Fox", "fox.zstm", &WriteOptions::default()).expect("a source");
    let words = format!("pub const POSE_WORDS: usize = {};", written.report.pose_words);
    for text in [
        "pub mod model_2_gro_er_fox {",
        "::zstrip::include_model!(\"fox.zstm\")",
        "pub const DRAWS: usize = 1;",
        &words,
        "pub const ALL: usize = 0;",
    ] {
        assert!(source.contains(text), "{text} is missing in\n{source}");
    }
}

#[test]
fn clips_of_one_name_are_told_apart() {
    let mut import = animated(false);
    let clip = import.animations[0].clone();
    let names = ["clip_2", "walk", "walk", "", "Clip_3", "clip_2"];
    import.animations = names.iter().map(|name| Animation { name: (*name).to_owned(), ..clip.clone() }).collect();
    let (source, _) = write_rust(&import, "a", "a.zstm", &WriteOptions::default()).expect("a source");
    let constants: Vec<_> = source.lines().filter_map(|line| line.trim().strip_prefix("pub const ")).skip(2).collect();
    assert_eq!(
        constants,
        [
            "CLIP_2: usize = 0;",
            "WALK: usize = 1;",
            "CLIP_2_: usize = 2;",
            "CLIP_3: usize = 3;",
            "CLIP_4: usize = 4;",
            "CLIP_5: usize = 5;"
        ]
    );
}
