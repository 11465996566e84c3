//! Containers as bytes: what is accepted is drawn, and everything else is an error; nothing panics.

use super::builder::{Builder, Container, PartLists, material};
use super::figures::{animated, clustered, many_parts, textured};
use crate::reference::rng::Rng;
use crate::support::strips;
use zstrip::bytemuck::{Pod, bytes_of, pod_read_unaligned};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::light::Sun;
use zstrip::math::{Affine, Angle16, Scalar, Vec3};
use zstrip::mesh::BoundsNode;
use zstrip::model::container::{
    Channel, Clip, Cluster, Delta, Header, Influence, Joint, Material, Node, Part, Section, SectionKind, Skin, Target,
    Texture, Timeline,
};
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
fn fuzzing_begins_with_whole_containers() {
    // Ten bytes say how the model is drawn.
    for input in [
        &include_bytes!("../../fuzz/corpus/models/7612a63bc1de")[..],
        &include_bytes!("../../fuzz/corpus/models/bdd9bc58041e")[..],
    ] {
        let container = Container::of(&input[10..]);
        let model = Model::from_bytes(container.bytes()).expect("a model");
        assert_eq!((Model::draws(container.bytes()), model.clips().count()), (1, 1));
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
            // Honest about its length, it ends within the last section, or within the bytes that fill it up.
            if length >= size_of::<Header>() {
                let mut shorter = bytes[..length].to_vec();
                shorter[8..12].copy_from_slice(&(length as u32).to_le_bytes());
                let shorter = Container::of(&shorter);
                let found = Model::from_bytes(shorter.bytes());
                let header: Header = pod_read_unaligned(&bytes[..size_of::<Header>()]);
                let Section { offset, count } = header.table[SectionKind::Bytes as usize];
                if length < (offset + count) as usize {
                    let error = found.expect_err(name);
                    assert!(matches!(error, ModelError::Section { .. }), "{name}, {length}: {error}");
                } else {
                    draw(&found.expect("a model"), shorter.bytes());
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

/// Returns the text of the error in the bytes of a model after a change.
fn error_of(builder: &Builder, change: impl Fn(&mut [u8])) -> String {
    let mut bytes = builder.clone().build().bytes().to_vec();
    change(&mut bytes);
    Model::from_bytes(Container::of(&bytes).bytes()).expect_err("a mistake").to_string()
}

/// Returns the text of the error in a model after a change of an item. Structures that stand in a section are items.
fn error_in<T: Pod>(builder: &Builder, kind: SectionKind, number: usize, change: impl Fn(&mut T)) -> String {
    error_of(builder, |bytes| {
        let row = size_of::<Header>() - 8 * SectionKind::COUNT + 8 * kind as usize;
        let first = u32::from_le_bytes(bytes[row..row + 4].try_into().expect("four bytes")) as usize;
        let at = first + number * size_of::<T>();
        let mut item: T = pod_read_unaligned(&bytes[at..at + size_of::<T>()]);
        change(&mut item);
        bytes[at..at + size_of::<T>()].copy_from_slice(bytes_of(&item));
    })
}

/// The same for the header.
fn error_in_header(builder: &Builder, change: impl Fn(&mut Header)) -> String {
    error_of(builder, |bytes| {
        let mut header: Header = pod_read_unaligned(&bytes[..size_of::<Header>()]);
        change(&mut header);
        bytes[..size_of::<Header>()].copy_from_slice(bytes_of(&header));
    })
}

#[test]
fn errors_of_the_header_name_what_is_wrong() {
    let model = textured();
    let container = model.clone().build();
    let bytes = container.bytes();
    let misaligned: Vec<u8> = [0].iter().chain(bytes).copied().collect();
    let found = Model::from_bytes(&Container::of(&misaligned).bytes()[1..]).expect_err("misaligned");
    assert_eq!(found, ModelError::Misaligned { past: 1 });
    let short = |length: usize| Model::from_bytes(&bytes[..length]).expect_err("too short").to_string();
    assert_eq!(short(7), "7 bytes, but the container has at least 228");
    assert_eq!(short(300), format!("300 bytes, but the container has at least {}", bytes.len()));
    let error = |change: &dyn Fn(&mut Header)| error_in_header(&model, change);
    assert_eq!(error(&|h| h.magic[0] = b'z'), "the bytes begin with [122, 83, 84, 77], a container with b\"ZSTM\"");
    assert_eq!(error(&|h| h.version = 9), "version 9 of the container, must be 1: write it anew");
    assert_eq!(error(&|h| h.sections = 21), "the header: sections is 21, must be 22");
    assert_eq!(error(&|h| h.length = 5), "the header: length is 5, must be in 228..=4294967295");
    assert_eq!(error(&|h| h.draws = 2), "the header: draws is 2, must be 1");
    assert_eq!(error(&|h| h.half[1] = -3), "the header: half is -3, must be in 0..=2147483647");
    assert_eq!(error(&|h| h.weights = u32::MAX), "the header: weights is 4294967295, must be in 0..=65535");
    assert_eq!(
        error(&|h| (h.weights, h.rest_weights) = (3, 1)),
        "the header: rest_weights is 1, and 3 from there on end past the last of 0"
    );
    assert_eq!(error(&|h| h.pose_words = 11), "the header: pose_words is 11, must be 12");
    let length = bytes.len();
    for (offset, count) in [(230, 1), (224, 1), (228, 1 << 20), (u32::MAX - 3, 1), (228, u32::MAX)] {
        assert_eq!(
            error(&|h| h.table[SectionKind::Nodes as usize] = Section { offset, count }),
            format!(
                "section Nodes: {count} items from byte {offset} on must begin at a multiple of 4 after the header, and \
                 end by byte {length}"
            )
        );
    }
}

#[test]
fn errors_of_nodes_and_materials_name_what_is_wrong() {
    let model = textured();
    let node = |change: &dyn Fn(&mut Node)| error_in(&model, SectionKind::Nodes, 0, change);
    assert_eq!(node(&|n| n.parent = 0), "Nodes, item 0: parent is 0, must be 65535");
    assert_eq!(
        node(&|n| n.first_part = 1),
        "Nodes, item 0: first_part is 1, and 1 from there on end past the last of 1"
    );
    assert_eq!(node(&|n| n.parts = 9), "Nodes, item 0: first_part is 0, and 9 from there on end past the last of 1");
    let parent = |number| error_in(&many_parts(), SectionKind::Nodes, number, |n: &mut Node| n.parent = 5);
    assert_eq!(parent(5), "Nodes, item 5: parent is 5, must be in 0..=4");
    assert_eq!(parent(1), "Nodes, item 1: parent is 5, must be 0");

    let material = |change: &dyn Fn(&mut Material)| error_in(&model, SectionKind::Materials, 0, change);
    assert_eq!(material(&|m| m.texture = 1), "Materials, item 0: texture is 1, must be 0");
    assert_eq!(material(&|m| m.alpha_mode = 3), "Materials, item 0: alpha_mode is 3, must be in 0..=2");
    let mut plain = textured();
    plain.textures.clear();
    assert_eq!(error_of(&plain, |_| ()), "Materials, item 0: texture is 0, must be 65535");
    let texture = |change: &dyn Fn(&mut Texture)| error_in(&model, SectionKind::Textures, 0, change);
    assert_eq!(texture(&|t| t.height = 0), "Textures, item 0: the smaller side is 0, must be in 1..=65535");
    assert_eq!(texture(&|t| t.levels = 17), "Textures, item 0: levels is 17, must be in 1..=16");
    assert_eq!(texture(&|t| t.format = 7), "Textures, item 0: format is 7, must be in 0..=6");
    assert_eq!(texture(&|t| t.texels = 1), "Textures, item 0: texels modulo 2 is 1, must be 0");
    // 2 · (16² + 8² + 4²) bytes.
    assert_eq!(
        texture(&|t| t.texels = 2),
        "Textures, item 0: texels is 2, and 672 from there on end past the last of 672"
    );
    assert_eq!(
        texture(&|t| (t.palette, t.colors) = (600, 50)),
        "Textures, item 0: palette is 600, and 150 from there on end past the last of 672"
    );
    // Levels of 16, 8 and 4 columns, of half a byte each.
    assert_eq!(
        texture(&|t| t.alpha = 600),
        "Textures, item 0: alpha is 600, and 168 from there on end past the last of 672"
    );
}

#[test]
fn errors_of_parts_name_what_is_wrong() {
    let model = textured();
    let part = |change: &dyn Fn(&mut Part)| error_in(&model, SectionKind::Parts, 0, change);
    let past = |field: &str, first: u32, count: u32, length: u32| {
        format!("Parts, item 0: {field} is {first}, and {count} from there on end past the last of {length}")
    };
    assert_eq!(part(&|p| p.first_vertex = 1), "Parts, item 0: first_vertex is 1, must be 0");
    assert_eq!(part(&|p| p.vertices = 170), past("first_vertex", 0, 170, 169));
    assert_eq!(part(&|p| p.vertices = 1 << 16), "Parts, item 0: vertices is 65536, must be in 0..=65535");
    assert_eq!(part(&|p| p.triangles = 289), past("first_index", 0, 867, 864));
    assert_eq!(part(&|p| p.clusters = 1), past("first_cluster", 0, 1, 0));
    assert_eq!(part(&|p| p.targets = 1), past("first_target", 0, 1, 0));
    assert_eq!(part(&|p| p.material = 1), "Parts, item 0: material is 1, must be 0");
    assert_eq!(part(&|p| p.uv_shift = 16), "Parts, item 0: uv_shift is 16, must be in 0..=15");
    assert_eq!(part(&|p| p.uv_bits = 9), "Parts, item 0: uv_bits is 9, must be 16");
    assert_eq!(part(&|p| p.first_normal = 5), past("first_normal", 5, 169, 169));
    assert_eq!(part(&|p| p.first_color = 0), past("first_color", 0, 169, 0));
    assert_eq!(part(&|p| p.first_uv = u32::MAX - 1), past("first_uv", u32::MAX - 1, 169, 169));
    assert_eq!(part(&|p| p.coarser = 1), "Parts, item 0: coarser is 1, must be 65535");
    assert_eq!(part(&|p| p.first_weight = 1), past("first_weight", 1, 0, 0));
    assert_eq!(part(&|p| p.pose = 12), "Parts, item 0: pose is 12, must be 4294967295");
    assert_eq!(part(&|p| (p.skin, p.pose) = (0, 12)), "Parts, item 0: skin is 0, but no number is allowed here");
    assert_eq!(part(&|p| p.scale = 0), "part 0: scale 0 of the positions, must be above 0");
    let mut bare = textured();
    bare.materials.clear();
    assert_eq!(error_of(&bare, |_| ()), "Parts, item 0: material is 0, but no number is allowed here");
    let coarser = |to| error_in(&many_parts(), SectionKind::Parts, 2, |part: &mut Part| part.coarser = to);
    assert_eq!(coarser(2), format!("Parts, item 2: coarser is 2, must be in 3..={}", many_parts().parts.len() - 1));
    let mut wrong = textured();
    wrong.parts[0].item.coarser = 77;
    assert_eq!(error_of(&wrong, |_| ()), "Parts, item 0: coarser is 77, must be 65535");
    let index = error_in(&model, SectionKind::Indices, 0, |index: &mut u16| *index = 1792);
    assert_eq!(index, "part 0: index 1792 at position 0 is out of range: there are 169 vertices");

    let cluster = |number, change: &dyn Fn(&mut Cluster)| error_in(&clustered(), SectionKind::Clusters, number, change);
    assert_eq!(cluster(1, &|c| c.first_triangle = 3), "Clusters, item 1: first_triangle is 3, must be 8");
    assert_eq!(cluster(1, &|c| c.triangles = 0), "Clusters, item 1: triangles is 0, must be in 1..=65535");
    assert_eq!(
        cluster(35, &|c| c.triangles = 9),
        "Clusters, item 35: first_triangle is 280, and 9 from there on end past the last of 288"
    );
    assert_eq!(cluster(35, &|c| c.triangles = 7), "Parts, item 0: triangles in clusters is 287, must be 288");
    let outside = cluster(2, &|c| c.half[1] = 10);
    assert!(outside.starts_with("the box of item 2 of Clusters does not hold vertex "), "{outside}");
    assert!(outside.ends_with(" of part 0"), "{outside}");
}

#[test]
fn errors_of_skins_and_targets_name_what_is_wrong() {
    let model = animated(true);
    let part = |change: &dyn Fn(&mut Part)| error_in(&model, SectionKind::Parts, 0, change);
    // Five nodes, four joints, a weight.
    assert_eq!(part(&|p| p.pose = 0), "Parts, item 0: pose is 0, must be 109");
    assert_eq!(part(&|p| p.skin = 1), "Parts, item 0: skin is 1, must be 0");
    assert_eq!(part(&|p| p.coarser = 0), "Parts, item 0: coarser is 0, must be 65535");
    assert_eq!(
        part(&|p| p.first_influence = 1),
        "Parts, item 0: first_influence is 1, and 169 from there on end past the last of 169"
    );
    assert_eq!(
        part(&|p| p.first_weight = 1),
        "Parts, item 0: first_weight is 1, and 1 from there on end past the last of 1"
    );
    let skin = |change: &dyn Fn(&mut Skin)| error_in(&model, SectionKind::Skins, 0, change);
    assert_eq!(skin(&|s| s.first_joint = 1), "Skins, item 0: first_joint is 1, must be 0");
    assert_eq!(skin(&|s| s.joints = 257), "Skins, item 0: joints is 257, must be in 1..=256");
    assert_eq!(skin(&|s| s.joints = 3), "the header: number of joints is 4, must be 3");
    let joint = |change: &dyn Fn(&mut Joint)| error_in(&model, SectionKind::Joints, 1, change);
    assert_eq!(joint(&|j| j.node = 5), "Joints, item 1: node is 5, must be in 0..=4");
    assert_eq!(joint(&|j| j.used = 0), "Joints, item 1: used is 0, must be 1");
    let rigid = error_in(&animated(false), SectionKind::Joints, 0, |joint: &mut Joint| joint.half[0] = 0);
    assert!(rigid.starts_with("the box of item 0 of Joints does not hold vertex "), "{rigid}");
    let influence =
        |weights| error_in(&model, SectionKind::Influences, 7, |influence: &mut Influence| influence.weights = weights);
    assert_eq!(influence([129, 0, 0]), "Influences, item 7: second weight is 129, must be in 0..=128");
    assert_eq!(influence([20, 21, 0]), "Influences, item 7: third weight is 21, must be in 0..=20");
    assert_eq!(influence([120, 17, 0]), "Influences, item 7: third weight is 17, must be in 0..=16");
    assert_eq!(influence([80, 60, 61]), "Influences, item 7: fourth weight is 61, must be in 0..=36");
    let other = error_in(&model, SectionKind::Influences, 7, |influence: &mut Influence| influence.joints[0] = 4);
    assert_eq!(other, "Influences, item 7: joint is 4, must be in 0..=3");
    let target = |change: &dyn Fn(&mut Target)| error_in(&model, SectionKind::Targets, 0, change);
    assert_eq!(target(&|t| t.first_delta = 2), "Targets, item 0: first_delta is 2, must be 0");
    assert_eq!(
        target(&|t| t.vertices = 66),
        "Targets, item 0: first_delta is 0, and 66 from there on end past the last of 65"
    );
    assert_eq!(
        target(&|t| t.first_vertex = 120),
        "Targets, item 0: first_vertex is 120, and 65 from there on end past the last of 169"
    );
}

#[test]
fn errors_of_clips_name_what_is_wrong() {
    let model = animated(true);
    let (clips, channels) = (&model.clips, model.clips.iter().map(|clip| clip.channels.len()).sum::<usize>());
    let [moving, all] = [clips[0].channels.len(), channels];
    let clip = |change: &dyn Fn(&mut Clip)| error_in(&model, SectionKind::Clips, 1, change);
    assert_eq!(
        clip(&|c| c.first_channel += 1),
        format!("Clips, item 1: first_channel is {}, must be {moving}", moving + 1)
    );
    assert_eq!(
        clip(&|c| c.channels = 100),
        format!("Clips, item 1: first_channel is {moving}, and 100 from there on end past the last of {all}")
    );
    assert_eq!(clip(&|c| c.duration = 0), "Clips, item 1: duration is 0, must be in 1..=4294967295");
    assert_eq!(clip(&|c| c.half[2] = -1), "Clips, item 1: half is -1, must be in 0..=2147483647");
    let length = model.bytes.len() + "bendwave".len();
    assert!(
        clip(&|c| c.name = 5000).contains(&format!("name is 5000, and 4 from there on end past the last of {length}"))
    );
    let line = |change: &dyn Fn(&mut Timeline)| error_in(&model, SectionKind::Timelines, 1, change);
    assert_eq!(line(&|l| l.first_time = 3), "Timelines, item 1: first_time is 3, must be 4");
    assert_eq!(line(&|l| l.times = 0), "Timelines, item 1: times is 0, must be in 1..=65536");
    let time = |number, to| error_in(&model, SectionKind::Times, number, |time: &mut u16| *time = to);
    assert_eq!(time(2, 20_000), "Times, item 2: time is 20000, must be in 20001..=65535");
    assert_eq!(time(2, u16::MAX), "Times, item 3: time is 65535, but no number is allowed here");
    let channel = |number, change: &dyn Fn(&mut Channel)| error_in(&model, SectionKind::Channels, number, change);
    assert_eq!(channel(0, &|c| c.path = 4), "Channels, item 0: path is 4, must be in 0..=3");
    assert_eq!(channel(0, &|c| c.interpolation = 3), "Channels, item 0: interpolation is 3, must be in 0..=2");
    let lines = all - 1;
    assert_eq!(
        channel(0, &|c| c.timeline = 1000),
        format!("Channels, item 0: timeline is 1000, must be in 0..={lines}")
    );
    assert_eq!(channel(0, &|c| c.weights = 1), "Channels, item 0: weights is 1, must be 0");
    assert_eq!(channel(0, &|c| c.target = 5), "Channels, item 0: target is 5, must be in 0..=4");
    // The channel before is that of node 1.
    assert_eq!(channel(1, &|c| c.target = 0), "Channels, item 1: target is 0, must be in 1..=4");
    let past = channel(0, &|c| c.first_key = 10_000);
    assert!(
        past.starts_with("Channels, item 0: first_key is 10000, and 16 from there on end past the last of "),
        "{past}"
    );
    // The last channel of the first clip is that of the weights.
    assert_eq!(
        channel(moving - 1, &|c| c.weights = 2),
        format!("Channels, item {}: target is 0, and 2 from there on end past the last of 1", moving - 1)
    );
    let mut unsorted = model.clone();
    unsorted.clips[0].channels.rotate_right(1);
    assert_eq!(error_of(&unsorted, |_| ()), "Channels, item 1: path is 1, must be 3");
}

#[test]
fn weights_of_a_broken_header_do_not_overflow() {
    // The sum of all words of a pose wraps past 2³² if the number of weights is not looked at first.
    let model = animated(false);
    for weights in [u32::MAX, u32::MAX - 107, 1 << 31, 1 << 16] {
        let error = error_in_header(&model, |header| header.weights = weights);
        assert_eq!(error, format!("the header: weights is {weights}, must be in 0..=65535"));
    }
}

#[test]
fn checks_take_time_in_proportion_to_posed_parts() {
    // Parts without vertices: a pose keeps ten words for each.
    let mut builder = Builder::default();
    builder.materials.push(material());
    builder.weights.push(0);
    let mut part = PartLists::new(1 << 16, [0; 3], vec![], vec![]);
    part.targets.push((0, vec![]));
    builder.parts = vec![part; 60_000];
    let container = builder.build();
    assert_eq!(Pose::words(container.bytes()), 1 + 10 * 60_000);
    // A sum for each part over all parts before it would be 1.8 billion additions: minutes in a debug build.
    let start = std::time::Instant::now();
    Model::from_bytes(container.bytes()).expect("a model");
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
}

#[test]
fn the_document_has_the_sizes_and_places_of_all_structures() {
    use core::mem::offset_of;
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
