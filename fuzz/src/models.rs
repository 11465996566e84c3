//! Containers of models: some that are right, with changed bytes, and any bytes. What is accepted is drawn, posed and at
//! rest, with clusters and without, in two sizes of strips, to the same picture.

#[path = "../../tests/model/builder.rs"]
#[allow(dead_code, reason = "the target uses only part of the builder")]
mod builder;
#[path = "../../tests/model/figures.rs"]
#[allow(dead_code, reason = "the target uses only part of the figures")]
mod figures;

use crate::Hash;
use crate::source::Source;
use builder::Container;
use std::sync::OnceLock;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
use zstrip::frame::Renderer;
use zstrip::light::{DirectionalLight, Lighting, Sun};
use zstrip::math::{Angle16, Vec3};
use zstrip::mesh::BoundsNode;
use zstrip::model::{Camera, Model, Placed, Pose};
use zstrip::shader::Surface;
use zstrip::target::StripPixels;

/// Draws that are looked at, at most: a few bytes can ask for thousands.
const MOST_DRAWS: usize = 40;
const MOST_WORDS: usize = 1 << 16;
const WIDTH: usize = 20;
const HEIGHT: usize = 14;

fn containers() -> &'static [Container; 5] {
    static CONTAINERS: OnceLock<[Container; 5]> = OnceLock::new();
    CONTAINERS.get_or_init(|| {
        [
            figures::textured(),
            figures::animated(false),
            figures::animated(true),
            figures::many_parts(),
            figures::clustered(),
        ]
        .map(builder::Builder::build)
    })
}

pub fn run(input: &[u8]) -> u64 {
    let mut source = Source::new(input);
    let mut hash = Hash::default();
    let kind = source.below(6);
    let (seen, lit) = (source.vector(), source.flag());
    let (from, to, weight) = (source.u16(), source.u16(), source.scalar());
    let container = match containers().get(kind) {
        Some(container) => {
            let mut bytes = container.bytes().to_vec();
            for _ in 0..source.below(8) {
                // Structures are in the first kilobytes; vertices, texels and keys are many.
                let at = if source.flag() { usize::from(source.u16()) } else { usize::from(source.u16()) % 2048 };
                let at = at % bytes.len();
                if source.flag() {
                    let number = source.int().to_le_bytes();
                    let end = (at + 4).min(bytes.len());
                    bytes[at..end].copy_from_slice(&number[..end - at]);
                } else {
                    bytes[at] = source.u8();
                }
            }
            Container::of(&bytes)
        }
        None => Container::of(source.rest()),
    };
    let bytes = container.bytes();
    let model = match Model::from_bytes(bytes) {
        Ok(model) => model,
        Err(error) => {
            hash.bytes(error.to_string().as_bytes());
            return hash.0;
        }
    };
    let (draws, words) = (Model::draws(bytes), Pose::words(bytes));
    if draws > MOST_DRAWS || words > MOST_WORDS {
        return hash.0;
    }
    let screen = Size::new(WIDTH as u32, HEIGHT as u32);
    let Ok(camera) = Camera::framing(&model.bounds(), Angle16::from_degrees(50), screen, seen) else { return hash.0 };
    let (mut memory, world) = (vec![0; words], source.affine());
    let mut pose = model.pose(&mut memory).expect("enough words");
    let clips: Vec<_> = model.clips().take(3).collect();
    if let [first, .., last] = &clips[..] {
        pose.blend(first.looped(from.into()), last.once(to.into()), weight);
    } else if let [clip] = &clips[..] {
        pose.play(clip.looped(from.into()));
    }
    for node in 0..3 {
        let rows = pose.node(node).map(|transform| transform.to_rows()).unwrap_or_default();
        rows.as_flattened().iter().for_each(|entry| hash.add(*entry as u64));
    }
    let sun = Sun::new(Vec3::from_ints(1, 2, 3), Rgb888::WHITE, Rgb888::BLUE);
    if lit {
        let light = DirectionalLight::new(Vec3::from_ints(1, 2, 3), Rgb888::WHITE);
        let lighting = Lighting::directional(Rgb888::BLUE, [light]);
        let mut places = vec![None; draws];
        look(&pose.place(&world, &camera, &lighting, &mut places).expect("enough places"), &mut hash);
    } else {
        let mut places = vec![None; draws];
        look(&pose.place(&world, &camera, &sun, &mut places).expect("enough places"), &mut hash);
    }
    let (mut places, mut nodes) = (vec![None; draws], [BoundsNode::EMPTY; 40]);
    look(&model.place(&world, &camera, &sun, &mut places).expect("enough places").cull_clusters(&mut nodes), &mut hash);
    hash.0
}

/// Draws a model in two ways, and compares.
fn look<S: Surface + Copy>(placed: &Placed<'_, S>, hash: &mut Hash) {
    let picture = |rows: usize, records: usize| {
        let (mut color, mut depth, mut records) = (vec![0; WIDTH * rows], vec![0; WIDTH * rows], vec![0; records]);
        let renderer = Renderer::<Rgb565>::new(Size::new(WIDTH as u32, HEIGHT as u32)).expect("a renderer");
        let mut renderer = renderer.with_depth(&mut depth).expect("a renderer").with_records(&mut records);
        let mut picture = Vec::new();
        let sink = |strip: &StripPixels<'_, Rgb565>| {
            picture.extend_from_slice(strip.pixels());
            Ok::<(), core::convert::Infallible>(())
        };
        renderer.frame_to(sink, &mut color, Rgb565::BLACK, |scene| placed.draw(scene)).expect("one scene");
        picture
    };
    let found = picture(5, 4000);
    assert_eq!(found, picture(HEIGHT, 0), "strips of 5 rows with records, and one strip without");
    found.iter().for_each(|pixel| hash.add(u64::from(*pixel)));
}
