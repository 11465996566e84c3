//! A strip is a framebuffer: whatever the strip height and however many records there are, the bytes are the same.

use crate::reference::rng::Rng;
use crate::scenes;
use crate::support::{Soup, difference, strips, unrecorded_strips};
use proptest::prelude::*;
use zstrip::color::{PixelFormat, Rgb565Be};
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565, Rgb888, RgbColor, WebColors};
use zstrip::frame::{FramebufferRenderer, Renderer};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::shader::{Flat, Gouraud};
use zstrip::span::{DepthBias, DepthState};
use zstrip::target::{FrameSlice, Framebuffer, Stats, records_len};
use zstrip::vertex::{DepthScale, Viewport};
use zstrip::{Cull, Scene, State};

const SCREEN: (u16, u16) = (320, 240);
const AMPLE: usize = 40_000;
const BOTH_SIDES: State = State { cull: Cull::None, ..State::DEFAULT };

/// Makes a scene by its name.
fn made(name: &str, (width, height): (u16, u16), turn: Angle16) -> Box<scenes::Drawing> {
    let info = scenes::SCENES.iter().find(|info| info.name == name);
    (info.unwrap_or_else(|| panic!("no scene {name}")).make)(Size::new(width.into(), height.into()), turn)
}

/// The frame in one strip must be what it is in others; some of it must not be background.
fn assert_strips_do_not_matter(name: &str, turn: Angle16, heights: &[usize], capacities: &[usize]) {
    let drawing = made(name, SCREEN, turn);
    let (expected, _) = strips::<Rgb565>(SCREEN, 240, AMPLE, scenes::BACKGROUND, |s| drawing.draw(s));
    let background = Rgb565::from_color(scenes::BACKGROUND);
    let drawn = expected.iter().filter(|p| **p != background).count();
    assert!(drawn > 500, "{name}: only {drawn} pixels are drawn");
    for (&rows, &records) in heights.iter().flat_map(|h| capacities.iter().map(move |c| (h, c))) {
        let (picture, stats) = strips::<Rgb565>(SCREEN, rows, records, scenes::BACKGROUND, |s| drawing.draw(s));
        let found = difference(&picture, &expected, SCREEN.0);
        assert_eq!(found, None, "{name} at {turn:?}, strips of {rows} rows, {records} records");
        assert_eq!(stats.strips as usize, 240_usize.div_ceil(rows));
        match records {
            // A frame of one strip is drawn directly, too.
            _ if records == 0 || rows == 240 => assert_eq!(stats.direct_strips, stats.strips, "{name}: {stats:?}"),
            AMPLE => assert_eq!((stats.overflows, stats.direct_strips), (0, 0), "{name}: {stats:?}"),
            _ => {}
        }
    }
}

const HEIGHTS: [usize; 4] = [1, 7, 16, 240];
const CAPACITIES: [usize; 3] = [0, 100, AMPLE];

#[test]
fn torus_in_flat_shading_is_the_same_in_any_strips() {
    assert_strips_do_not_matter("torus_flat", Angle16(1234), &HEIGHTS, &CAPACITIES);
}

#[test]
fn torus_in_gouraud_shading_is_the_same_in_any_strips() {
    assert_strips_do_not_matter("torus_gouraud", Angle16(50_000), &HEIGHTS, &CAPACITIES);
}

#[test]
fn room_is_the_same_in_any_strips() {
    assert_strips_do_not_matter("room", Angle16(0), &HEIGHTS, &CAPACITIES);
    assert_strips_do_not_matter("room", Angle16(20_000), &[16], &[0, 1000, AMPLE]);
}

#[test]
fn every_other_scene_is_the_same_in_any_strips() {
    for info in &scenes::SCENES[3..] {
        // A row at a time, without records, thousands of triangles: too slow to be tested for every scene.
        assert_strips_do_not_matter(info.name, Angle16(7777), &[7, 16], &[100, AMPLE]);
        assert_strips_do_not_matter(info.name, Angle16(7777), &[60], &[0]);
        assert_strips_do_not_matter(info.name, Angle16(7777), &[1, 240], &[AMPLE]);
    }
}

/// What a random case draws: a soup in a part of the screen, and then turned, in two shaders, in the whole of it.
fn draw_soup<F: Framebuffer>(scene: &mut Scene<'_, F>, mesh: &Mesh<'_>, state: State, part: Viewport)
where
    Gouraud: zstrip::span::Shader<F::Format>,
    Flat: zstrip::span::Shader<F::Format>,
{
    let screen = scene.screen();
    scene.set_viewport(part);
    scene.draw_with(state, mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
    scene.set_viewport(Viewport::full(screen).expect("the screen is a viewport"));
    let turned = Projective::from(Affine::rotation_z(Angle16(9999)));
    scene.draw_with(BOTH_SIDES, mesh, &turned, &Flat::unlit(Rgb888::CSS_CORAL));
    scene.draw_with(state, mesh, &turned, &Gouraud::vertex_colors());
}

fn random_state(rng: &mut Rng) -> State {
    use zstrip::span::Compare;
    use zstrip::vertex::DepthRange;
    State {
        cull: rng.pick(&[Cull::Back, Cull::Front, Cull::None]),
        depth: DepthState {
            compare: rng.pick(&[Compare::Less, Compare::LessEqual, Compare::Always, Compare::NotEqual, Compare::Less]),
            write: !rng.one_in(4),
        },
        range: rng.pick(&[DepthRange::Clip, DepthRange::ClampFar, DepthRange::Clamp]),
        bias: DepthBias {
            constant: rng.pick(&[0, 0, -5, 700, i16::MIN]),
            slope: Scalar::from_bits(rng.pick(&[0, 0, -90_000, 1 << 20, i32::MIN])),
        },
        depth_scale: rng.pick(&[
            DepthScale::Perspective,
            DepthScale::Uniform { far: Scalar::ONE * 2 },
            DepthScale::Uniform { far: Scalar::DELTA },
        ]),
        ..State::DEFAULT
    }
}

/// A random soup on a random screen, in one strip with ample records, and in other strips with others.
fn check_soup(seed: u64) {
    let mut rng = Rng::new(seed);
    let screen = (rng.between(1, 90) as u16, rng.between(1, 70) as u16);
    let count = rng.between(1, 24) as usize;
    let soup = Soup::new(&mut rng, count);
    let mesh = soup.mesh();
    let state = random_state(&mut rng);
    let corner = [(); 2].map(|()| rng.between(-30, 60) as i16);
    let size = [(); 2].map(|()| rng.between(1, 100) as u16);
    let part = Viewport::new(Point::new(corner[0].into(), corner[1].into()), Size::new(size[0].into(), size[1].into()))
        .expect("a viewport");
    let height = usize::from(screen.1);
    let (expected, _) = strips::<Rgb565>(screen, height, 20_000, Rgb565::BLUE, |s| draw_soup(s, &mesh, state, part));
    let rows = rng.between(1, i32::from(screen.1)) as usize;
    let (picture, _) = unrecorded_strips::<Rgb565>(screen, rows, Rgb565::BLUE, |s| draw_soup(s, &mesh, state, part));
    assert_eq!(difference(&picture, &expected, screen.0), None, "seed {seed}: no records, strips of {rows} rows");
    for _ in 0..3 {
        let rows = rng.between(1, i32::from(screen.1)) as usize;
        let records = rng.pick(&[0, rng_capacity(seed), 20_000]);
        let (picture, stats) =
            strips::<Rgb565>(screen, rows, records, Rgb565::BLUE, |s| draw_soup(s, &mesh, state, part));
        let found = difference(&picture, &expected, screen.0);
        assert_eq!(
            found, None,
            "seed {seed}: {count} triangles, screen {screen:?}, strips of {rows} rows, {records} records, {state:?}: {stats:?}"
        );
    }
}

/// A number of record words that overflows at a place that depends on the seed.
fn rng_capacity(seed: u64) -> usize {
    Rng::new(!seed).between(1, 900) as usize
}

#[test]
fn six_hundred_random_soups_are_the_same_in_any_strips() {
    for seed in 0..600 {
        check_soup(seed);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    /// The same with seeds that proptest draws, and shrinks where there is something to shrink.
    #[test]
    fn random_soups_are_the_same_for_any_height_and_capacity(
        seed in 1_000_000_u64..,
        rows in 1_usize..48,
        records in 0_usize..1500,
        triangles in 1_usize..20,
    ) {
        let screen = (64, 48);
        let soup = Soup::new(&mut Rng::new(seed), triangles);
        let mesh = soup.mesh();
        let draw = |rows, records| strips::<Gray8>(screen, rows, records, Gray8::new(3), |scene| {
            scene.draw_with(BOTH_SIDES, &mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
        }).0;
        prop_assert_eq!(difference(&draw(rows, records), &draw(48, 20_000), 64), None);
    }
}

#[test]
fn framebuffer_and_strips_hold_the_same_pixels() {
    for seed in 5000..5060 {
        let mut rng = Rng::new(seed);
        let (width, height) = (rng.between(1, 80) as u16, rng.between(1, 60) as u16);
        let soup = Soup::new(&mut rng, 12);
        let mesh = soup.mesh();
        let part = Viewport::full(Size::new(width.into(), height.into())).expect("a viewport");
        let state = random_state(&mut rng);
        let (expected, _) =
            strips::<Rgb888>((width, height), 5, 700, Rgb888::GREEN, |s| draw_soup(s, &mesh, state, part));

        // Whole depth, a strip of depth, and rows with a gap between them.
        let stride = usize::from(width) + rng.between(0, 9) as usize;
        for (depth_rows, stride) in [(usize::from(height), usize::from(width)), (3, stride), (1, stride)] {
            let case = format!("seed {seed}: {width}x{height}, stride {stride}, {depth_rows} rows of depth");
            let mut pixels = vec![[7, 7, 7]; stride * usize::from(height)];
            let mut depth = vec![0; depth_rows * usize::from(width)];
            let mut records = vec![0; 900];
            let mut frame =
                FrameSlice::<Rgb888>::with_stride(&mut pixels, Size::new(u32::from(width), u32::from(height)), stride)
                    .expect("a framebuffer");
            let mut renderer = FramebufferRenderer::new(Size::new(u32::from(width), u32::from(height)))
                .expect("a renderer")
                .with_depth(&mut depth)
                .expect("a renderer")
                .with_records(&mut records);
            renderer.frame(&mut frame, Rgb888::GREEN, |s| draw_soup(s, &mesh, state, part)).expect("the same scene");
            let inside: Vec<_> = pixels.chunks(stride).flat_map(|row| &row[..usize::from(width)]).copied().collect();
            assert_eq!(difference(&inside, &expected, width), None, "{case}");
            let gaps = pixels.chunks(stride).flat_map(|row| &row[usize::from(width)..]);
            assert!(gaps.copied().all(|p| p == [7, 7, 7]), "{case}: the gap between rows was written");
        }
    }
}

#[test]
fn framebuffer_without_a_background_is_drawn_over() {
    let triangle = [Vec3::from_ints(-1, -1, 0), Vec3::from_ints(1, -1, 0), Vec3::from_ints(0, 1, 0)];
    let mesh = Mesh::new(MeshData::new(Positions::Exact(&triangle))).expect("a triangle");
    let mut pixels: Vec<u16> = (0..20 * 20).collect();
    let (mut depth, mut records) = (vec![0; 20 * 4], vec![0; 64]);
    let mut frame = FrameSlice::<Rgb565>::new(&mut pixels, Size::new(20, 20)).expect("a framebuffer");
    FramebufferRenderer::new(Size::new(20, 20))
        .expect("a renderer")
        .with_depth(&mut depth)
        .expect("a renderer")
        .with_records(&mut records)
        .frame_over(&mut frame, |scene| scene.draw(&mesh, &Projective::IDENTITY, &Flat::unlit(Rgb888::WHITE)))
        .expect("the same scene");
    let covered = pixels.iter().filter(|p| **p == 0xFFFF).count();
    let kept = (0..400).filter(|&i| pixels[usize::from(i)] == i).count();
    assert!(covered > 150 && covered + kept == 400, "{covered} covered, {kept} kept");
}

/// A framebuffer of the caller's own: columns from right to left.
struct Mirrored {
    rows: Vec<[u16; 32]>,
}

impl Framebuffer for Mirrored {
    type Format = Rgb565Be;

    fn row(&mut self, y: u32) -> &mut [u16] {
        let last = self.rows.len() - 1;
        self.rows.get_mut(last - y as usize).map_or(&mut [], |row| &mut row[..])
    }
}

#[test]
fn framebuffer_of_ones_own_gets_the_rows_it_hands_out() {
    let mut rng = Rng::new(77);
    let soup = Soup::new(&mut rng, 20);
    let mesh = soup.mesh();
    let part = Viewport::full(Size::new(32, 24)).expect("a viewport");
    let (expected, _) =
        strips::<Rgb565Be>((32, 24), 24, 5000, Rgb565::BLACK, |s| draw_soup(s, &mesh, BOTH_SIDES, part));
    let mut frame = Mirrored { rows: vec![[1; 32]; 24] };
    let (mut depth, mut records) = (vec![0; 32 * 5], vec![0; 300]);
    FramebufferRenderer::new(Size::new(32, 24))
        .expect("a renderer")
        .with_depth(&mut depth)
        .expect("a renderer")
        .with_records(&mut records)
        .frame(&mut frame, Rgb565::BLACK, |s| draw_soup(s, &mesh, BOTH_SIDES, part))
        .expect("the same scene");
    let found: Vec<u16> = frame.rows.iter().rev().flatten().copied().collect();
    assert_eq!(difference(&found, &expected, 32), None);
}

#[test]
fn pulled_strips_are_those_that_are_sent() {
    let room = made("room", (80, 60), Angle16(3));
    let (expected, _) = strips::<Rgb565>((80, 60), 60, AMPLE, scenes::BACKGROUND, |s| room.draw(s));
    for records in [0, 700, AMPLE] {
        let (mut color, mut depth, mut records) = (vec![9; 80 * 7], vec![9; 80 * 7], vec![9; records]);
        let renderer =
            Renderer::<Rgb565>::new(Size::new(80, 60)).expect("a renderer").with_depth(&mut depth).expect("a renderer");
        let mut renderer = renderer.with_records(&mut records);

        let mut frame = renderer.begin(scenes::BACKGROUND);
        let mut picture = Vec::new();
        while let Some(strip) = frame.next_strip(&mut color, |s| room.draw(s)).expect("the same scene") {
            picture.extend_from_slice(strip.pixels());
        }
        assert_eq!(frame.stats().strips, 9);
        assert_eq!(difference(&picture, &expected, 80), None);
        assert!(
            frame.next_strip(&mut color, |s| room.draw(s)).expect("no error").is_none(),
            "a finished frame stays finished"
        );
        assert_eq!(frame.stats().strips, 9);

        // Two buffers in turn: while one is drawn, the other, on its way to the display, stays as it was.
        let mut frame = renderer.begin(scenes::BACKGROUND);
        let (mut drawn, mut sent) = (vec![1; 80 * 7], vec![2; 80 * 7]);
        let (mut picture, mut rows) = (Vec::new(), 0);
        while let Some(strip) = frame.next_strip(&mut drawn, |s| room.draw(s)).expect("the same scene") {
            rows = strip.area().size.height as usize;
            assert_eq!(strip.pixels().len(), 80 * rows);
            std::mem::swap(&mut drawn, &mut sent);
            picture.extend_from_slice(&sent[..80 * rows]);
        }
        assert_eq!(rows, 60 % 7);
        assert_eq!(difference(&picture, &expected, 80), None);
    }
}

#[test]
fn frame_that_is_not_finished_does_not_disturb_the_next() {
    let [earlier, later] = [100, 200].map(|turn| made("torus_flat", (64, 64), Angle16(turn)));
    let (mut color, mut depth, mut records) = (vec![0; 64 * 8], vec![0; 64 * 8], vec![0; 3000]);
    let renderer =
        Renderer::<Rgb565>::new(Size::new(64, 64)).expect("a renderer").with_depth(&mut depth).expect("a renderer");
    let mut renderer = renderer.with_records(&mut records);
    let mut frame = renderer.begin(Rgb565::BLACK);
    for _ in 0..3 {
        assert!(frame.next_strip(&mut color, |s| earlier.draw(s)).expect("the same scene").is_some());
    }
    let mut picture = Vec::new();
    let mut frame = renderer.begin(Rgb565::BLACK);
    while let Some(strip) = frame.next_strip(&mut color, |s| later.draw(s)).expect("the same scene") {
        picture.extend_from_slice(strip.pixels());
    }
    let (expected, _) = strips::<Rgb565>((64, 64), 64, AMPLE, Rgb565::BLACK, |s| later.draw(s));
    assert_eq!(difference(&picture, &expected, 64), None);
}

/// A triangle at some depth, as large as the screen.
fn layer(z: i32) -> [Vec3; 3] {
    [(-3_i16, -3_i16), (3, -3), (0, 5)]
        .map(|(x, y)| Vec3::new(x.into(), y.into(), zstrip::math::Scalar::from_bits(z * 256)))
}

#[test]
fn painted_layers_stay_in_the_order_they_were_drawn() {
    let layers: Vec<_> = (0..9).map(|k| layer(20 * (9 - k))).collect();
    let meshes: Vec<_> =
        layers.iter().map(|l| Mesh::new(MeshData::new(Positions::Exact(l))).expect("a mesh")).collect();
    let paint = State { depth: DepthState::OFF, ..BOTH_SIDES };
    for (rows, records) in [(1, 0), (1, 60), (3, 90), (3, 200), (16, 1000)] {
        // Nearest last and nearest first: the last one painted shows either way.
        for backwards in [false, true] {
            let (picture, _) = strips::<Gray8>((16, 16), rows, records, Gray8::new(0), |scene| {
                for k in 0..9_u8 {
                    let which = usize::from(if backwards { 8 - k } else { k });
                    let grey = Rgb888::new(10 * (k + 1), 10 * (k + 1), 10 * (k + 1));
                    scene.draw_with(paint, &meshes[which], &Projective::IDENTITY, &Flat::unlit(grey));
                }
            });
            assert_eq!(picture[8 * 16 + 8], 90, "{rows} rows, {records} records, backwards: {backwards}");
        }
        // With the depth test, the nearest shows.
        let (picture, _) = strips::<Gray8>((16, 16), rows, records, Gray8::new(0), |scene| {
            for k in [4_u8, 8, 0, 2] {
                scene.draw(
                    &meshes[usize::from(k)],
                    &Projective::IDENTITY,
                    &Flat::unlit(Rgb888::new(k + 1, k + 1, k + 1)),
                );
            }
        });
        assert_eq!(picture[8 * 16 + 8], 9, "{rows} rows, {records} records");
    }
}

/// Every capacity around the points where a walk begins to overflow, and where the lists themselves do not fit.
#[test]
fn frame_is_the_same_at_every_capacity_about_the_overflow_points() {
    let screen = (48, 40);
    let field = made("field", screen, Angle16(5));
    let (expected, ample) = strips::<Rgb565>(screen, 40, AMPLE, scenes::BACKGROUND, |s| field.draw(s));
    let records_at = |records| {
        let (picture, stats) = strips::<Rgb565>(screen, 4, records, scenes::BACKGROUND, |s| field.draw(s));
        let found = difference(&picture, &expected, screen.0);
        assert_eq!(found, None, "{records} words of records: {stats:?}");
        stats
    };
    for records in 0..40 {
        records_at(records);
    }
    // Bisect for the first capacity that takes the whole frame in one walk, and for that of a single strip.
    let first_with = |good: fn(&Stats) -> bool| {
        let (mut low, mut high) = (0, AMPLE);
        while low + 1 < high {
            let middle = (low + high) / 2;
            if good(&records_at(middle)) { high = middle } else { low = middle }
        }
        high
    };
    let whole = first_with(|s| s.overflows == 0);
    let no_direct = first_with(|s| s.direct_strips == 0);
    println!("{no_direct} words: no strip is drawn directly; {whole} words: one band");
    assert!(no_direct < whole);
    for records in (whole - 12..whole + 3).chain(no_direct - 12..no_direct + 3) {
        records_at(records);
    }
    // What the const function promises is enough, as nothing is clipped here.
    assert_eq!(ample.clipped, 0);
    let meshes = [&scenes::polygons::GRID, &scenes::polygons::STRIP, &scenes::polygons::FAN, &scenes::polygons::QUADS];
    let vertices = meshes.iter().map(|m| m.vertex_count()).sum();
    let stated = records_len(10, 4, vertices, 1, ample.drawn as usize);
    // Each draw rounds its bits up to whole words; that is stated for the worst sizes.
    assert!((whole..whole + 4).contains(&stated), "records_len says {stated}, but {whole} words are needed");
}

#[test]
fn stats_tell_how_the_frame_was_made() {
    let torus = made("torus_flat", SCREEN, Angle16(0));
    let frame = |rows, records| strips::<Rgb565>(SCREEN, rows, records, scenes::BACKGROUND, |s| torus.draw(s)).1;
    let ample = frame(16, AMPLE);
    assert_eq!((ample.strips, ample.walks, ample.draws), (15, 16, 16), "one walk records, fifteen replay");
    assert_eq!((ample.overflows, ample.direct_strips), (0, 0));
    assert_eq!((ample.triangles, ample.vertices), (1024, 512), "each vertex is shaded once");
    assert_eq!(
        ample.triangles,
        ample.back_facing + ample.degenerate + ample.outside + ample.empty + ample.drawn,
        "each triangle is counted once: {ample:?}"
    );

    let none = frame(16, 0);
    assert_eq!((none.strips, none.walks, none.direct_strips), (15, 15, 15));
    assert!(none.culled > 0, "strips above the torus see nothing of it: {none:?}");

    let few = frame(16, 2000);
    assert_eq!(few.strips, 15);
    assert!(few.overflows > 0 && few.direct_strips == 1, "after two bands of seven, one strip is alone: {few:?}");
    // Each strip is replayed in one walk; the others record, in vain or not.
    assert!(few.walks > 15 + few.overflows && few.walks < 60, "{few:?}");

    let nothing = strips::<Rgb565>(SCREEN, 16, 100, Rgb565::RED, |_| ()).1;
    assert_eq!((nothing.draws, nothing.strips, nothing.drawn), (0, 15, 0));
}
