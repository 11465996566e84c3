//! Containers as bytes: what is accepted is drawn, and everything else is an error; nothing panics.

use super::builder::{Builder, Container};
use super::figures::{animated, clustered, many_parts, textured};
use super::reference::rng::Rng;
use super::support::strips;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::light::Sun;
use zstrip::math::{Affine, Angle16, Scalar, Vec3};
use zstrip::mesh::BoundsNode;
use zstrip::model::container::{Header, SectionKind};
use zstrip::model::{Camera, Model, ModelError, Pose};

fn models() -> [(&'static str, Builder); 5] {
    [
        ("textured", textured()),
        ("animated", animated(false)),
        ("morphed", animated(true)),
        ("many parts", many_parts()),
        ("clustered", clustered()),
    ]
}

/// Draws a model in all ways: at rest, posed, with clusters.
fn draw(model: &Model<'_>, bytes: &[u8]) {
    let (draws, words) = (Model::draws(bytes), Pose::words(bytes));
    if draws > 1000 || words > 1 << 20 {
        return;
    }
    let camera =
        Camera::framing(&model.bounds(), Angle16::from_degrees(50), Size::new(24, 16), Vec3::from_ints(2, 1, 3));
    let Ok(camera) = camera else { return };
    let sun = Sun::new(Vec3::from_ints(1, 2, 3), Rgb888::WHITE, Rgb888::BLUE);
    let (mut places, mut memory) = (vec![None; draws], vec![0; words]);
    let mut nodes = vec![BoundsNode::EMPTY; 200];
    let mut pose = model.pose(&mut memory).expect("enough words");
    let clips: Vec<_> = model.clips().take(2).collect();
    if let [first, .., last] = &clips[..] {
        pose.blend(first.looped(300), last.once(70_000), Scalar::from_num(0.4));
    } else if let [clip] = &clips[..] {
        pose.play(clip.looped(400));
    }
    let world = Affine::rotation_y(Angle16(9000));
    let placed = pose.place(&world, &camera, &sun, &mut places).expect("enough places");
    strips::<Rgb565>((24, 16), 6, 2000, Rgb565::BLACK, |scene| placed.draw(scene));
    let placed = model.place(&world, &camera, &sun, &mut places).expect("enough places").cull_clusters(&mut nodes);
    strips::<Rgb565>((24, 16), 6, 0, Rgb565::BLACK, |scene| placed.draw(scene));
}

#[test]
fn models_are_accepted_and_drawn() {
    for (name, builder) in models() {
        let container = builder.build();
        let model = Model::from_bytes(container.bytes()).unwrap_or_else(|error| panic!("{name}: {error}"));
        println!("{name}: {} bytes", container.bytes().len());
        draw(&model, container.bytes());
    }
}

#[test]
fn truncated_bytes_are_errors() {
    for (name, builder) in models() {
        let container = builder.build();
        let bytes = container.bytes();
        for length in (0..bytes.len()).filter(|n| *n < 600 || n % 61 == 0 || n + 40 > bytes.len()) {
            let error = Model::from_bytes(&bytes[..length]).expect_err(name);
            assert!(matches!(error, ModelError::Short { found, .. } if found == length), "{name}, {length}: {error}");
            // Honest about its length, it ends within a section.
            if length >= size_of::<Header>() {
                let mut shorter = bytes[..length].to_vec();
                shorter[8..12].copy_from_slice(&(length as u32).to_le_bytes());
                let shorter = Container::of(&shorter);
                if let Ok(model) = Model::from_bytes(shorter.bytes()) {
                    draw(&model, shorter.bytes());
                }
            }
        }
    }
}

#[test]
fn changed_bytes_are_errors_or_drawn() {
    let rounds = std::env::var("ROUNDS").ok().and_then(|rounds| rounds.parse().ok()).unwrap_or(400);
    for (name, builder) in models() {
        let container = builder.build();
        let (mut accepted, mut rng) = (0, Rng::new(11));
        for round in 0..rounds {
            let mut bytes = container.bytes().to_vec();
            // Most of the mistakes in the first half, where structures are.
            let reach = if round % 3 == 0 { bytes.len() } else { bytes.len().min(2500) };
            for _ in 0..1 + rng.below(3) {
                let at = rng.below(reach as u64) as usize;
                bytes[at] = match rng.below(4) {
                    0 => rng.next_u32() as u8,
                    1 => bytes[at].wrapping_add(1),
                    2 => 0xFF,
                    _ => bytes[at] ^ 1 << rng.below(8),
                };
            }
            let changed = Container::of(&bytes);
            if let Ok(model) = Model::from_bytes(changed.bytes()) {
                accepted += 1;
                draw(&model, changed.bytes());
            }
        }
        println!("{name}: {accepted} of {rounds} changed containers accepted, seed 11");
        assert!(accepted > 0 && accepted < rounds, "{name}: {accepted} of {rounds}");
    }
}

#[test]
fn errors_name_what_is_wrong() {
    let container = textured().build();
    let bytes = container.bytes();
    let error = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = bytes.to_vec();
        change(&mut bytes);
        Model::from_bytes(Container::of(&bytes).bytes()).expect_err("a mistake").to_string()
    };
    let misaligned: Vec<u8> = [0].iter().chain(bytes).copied().collect();
    let found = Model::from_bytes(&Container::of(&misaligned).bytes()[1..]).expect_err("misaligned");
    assert_eq!(found, ModelError::Misaligned { past: 1 });
    assert_eq!(error(&|b| b[0] = b'z'), "the bytes begin with [122, 83, 84, 77], a container with b\"ZSTM\"");
    assert_eq!(error(&|b| b[4] = 9), "version 9 of the container, must be 1: write it anew");
    assert_eq!(error(&|b| b[12] = 2), "the header: draws is 2, must be 1");
    let place = |kind: SectionKind| {
        let at = size_of::<Header>() - 8 * SectionKind::COUNT + 8 * kind as usize;
        u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes")) as usize
    };
    let (nodes, indices) = (place(SectionKind::Nodes), place(SectionKind::Indices));
    assert_eq!(error(&|b| b[nodes] = 0), "Nodes, item 0: parent is 65280, must be in 0..=-1");
    assert_eq!(
        error(&|b| b[indices + 1] = 7),
        "part 0: index 1792 at position 0 is out of range: there are 169 vertices"
    );
    let table = size_of::<Header>() - 8 * SectionKind::COUNT;
    let message = error(&|b| b[table] += 2);
    assert!(message.contains("section Nodes") && message.contains("do not lie at a multiple of 4"), "{message}");
}

#[test]
fn the_document_has_the_sizes_and_places_of_all_structures() {
    use core::mem::offset_of;
    use zstrip::model::container::{
        Channel, Clip, Cluster, Delta, Influence, Joint, Material, Node, Part, Section, Skin, Target, Texture, Timeline,
    };
    let document = include_str!("../../docs/container.md");
    macro_rules! check {
        ($($name:ident: $($field:ident)*;)*) => { $(
            let heading = format!("### `{}`, {} bytes\n", stringify!($name), size_of::<$name>());
            let start = document.find(&heading).unwrap_or_else(|| panic!("{heading}"));
            let chapter = document[start + 3..].split("\n##").next().unwrap_or_default();
            $(
                let at = offset_of!($name, $field);
                let row = chapter.lines().find(|line| line.contains(concat!(" | `", stringify!($field), "` | ")));
                let row = row.unwrap_or_else(|| panic!("{heading}: {}", stringify!($field)));
                assert!(row.starts_with(&format!("| {at} | ")), "{row}: byte {at}");
            )*
        )* };
    }
    check! {
        Section: offset count;
        Header: magic version sections length draws pose_words weights rest_weights center half table;
        Node: parent first_part parts name_length name translation rotation scale;
        Part: first_vertex vertices first_index triangles first_normal first_color first_uv first_influence
            first_cluster first_target first_weight pose scale offset center half uv_offset texels_per_unit error
            clusters targets material skin coarser uv_shift uv_bits;
        Cluster: center half first_triangle triangles axis cutoff;
        Material: color specular shininess texture alpha_mode cutoff flags;
        Texture: width height format levels colors texels palette alpha;
        Skin: first_joint joints;
        Joint: inverse_bind center half node used;
        Influence: joints weights zero;
        Target: first_delta first_vertex vertices;
        Delta: point normal zero;
        Clip: first_channel channels duration name name_length center half;
        Timeline: first_time times;
        Channel: timeline first_key scale offset target weights path interpolation zero;
    }
}
