//! Strokes with every way to blend, to discard and to test depth, against a plain model in two passes.
//!
//! The first pass finds the pixels of a line, each with its coverage and its fragment. The second applies the shader's
//! rule to each of them.

use crate::reference::rng::Rng;
use crate::support::{difference, strips, whole};
use core::fmt::Debug;
use std::cell::RefCell;
use zstrip::color::{Dithered, PixelFormat, Rgb565Be};
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565, Rgb888, RgbColor, WebColors};
use zstrip::math::{Pixels, Projective, Scalar, Vec3};
use zstrip::mesh::{LineTopology, Lines, Mesh, MeshData, Positions, Topology, Vertices};
use zstrip::shader::{
    Add, AddAlpha, Alpha, AlphaTest, Blend, DepthOnly, Flat, FogCurve, FogTable, Fogged, Gouraud, Multiply, Opacity,
    Replace, ScreenDoor,
};
use zstrip::span::{Compare, DepthState, Fragment, Shader};
use zstrip::target::Framebuffer;
use zstrip::vertex::{VertexRef, VertexShader};
use zstrip::{Cull, Dashed, Scene, Smooth, State, Stroke, Thick, Thin};

const SCREEN: (u16, u16) = (32, 24);

/// A fragment of a line, and how much of its pixel the stroke covers, in 1/256.
struct Hit {
    position: (i32, i32),
    depth: u16,
    varyings: [i32; 3],
    coverage: i32,
}

impl Hit {
    fn place(&self) -> usize {
        self.position.1 as usize * usize::from(SCREEN.0) + self.position.0 as usize
    }

    /// Red, green, blue and alpha of the fragment, as [`Source`] has them.
    fn rgba(&self) -> [u8; 4] {
        rgba(&self.varyings, self.position)
    }
}

/// Colours that run along the line, alphas of all kinds.
fn rgba(varyings: &[i32; 3], (x, y): (i32, i32)) -> [u8; 4] {
    let [r, g, b] = varyings.map(|c| (c >> 16) as u8);
    [r, g, b, (91 * x + 37 * y) as u8]
}

/// Colour of an end of a line, 8.16.
fn end(index: usize) -> [i32; 3] {
    [[30, 250, 90], [240, 10, 200]][index].map(|c| c << 16)
}

/// Colours and alphas of fragments by [`rgba`], in any format.
struct Source;

impl VertexShader for Source {
    type Varyings = [i32; 3];

    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 3] {
        end(vertex.index())
    }
}

impl<P: PixelFormat> Shader<P> for Source {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, [i32; 3]>) -> Option<P::Raw> {
        Some(P::pack_rgba(rgba(fragment.varyings, fragment.position), fragment.position))
    }
}

/// A shader of one's own that paints over what is there, keeps or discards it, by the column.
struct Negative;

impl VertexShader for Negative {
    type Varyings = [i32; 3];

    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 3] {
        end(vertex.index())
    }
}

impl<P: PixelFormat> Shader<P> for Negative {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, [i32; 3]>) -> Option<P::Raw> {
        Some(P::pack_rgba(rgba(fragment.varyings, fragment.position), fragment.position))
    }

    fn paint(&self, fragment: &Fragment<'_, [i32; 3]>, pixel: &mut P::Raw) -> bool {
        match fragment.position.0 % 3 {
            0 => return false,
            1 => *pixel = P::pack(P::unpack(*pixel).map(|c| !c)),
            _ => *pixel = P::pack_rgba(rgba(fragment.varyings, fragment.position), fragment.position),
        }
        true
    }
}

static FOG: FogTable = match FogTable::perspective(
    Scalar::ONE,
    Scalar::from_bits(10 << 16),
    FogCurve::Linear { start: Scalar::ONE, end: Scalar::from_bits(5 << 16) },
) {
    Ok(table) => table,
    Err(_) => panic!("near and far"),
};

/// Keeps the fragments.
struct Recorder<'a>(&'a RefCell<Vec<Hit>>);

impl VertexShader for Recorder<'_> {
    type Varyings = [i32; 3];

    fn vertex(&self, vertex: &VertexRef<'_>) -> [i32; 3] {
        end(vertex.index())
    }
}

impl Shader<Gray8> for Recorder<'_> {
    type Setup = ();

    fn fragment(&self, fragment: &Fragment<'_, [i32; 3]>) -> Option<u8> {
        let (position, depth, varyings) = (fragment.position, fragment.depth, *fragment.varyings);
        self.0.borrow_mut().push(Hit { position, depth, varyings, coverage: 0 });
        Some(0)
    }
}

const ALL: State = State { depth: DepthState::OFF, ..State::DEFAULT };

/// Returns a line's fragments in order, with their coverage: from white on black and from black on white, which are
/// rounded in opposite directions.
fn hits(line: &Lines<'_>, stroke: &impl Stroke) -> Vec<Hit> {
    let hits = RefCell::new(Vec::new());
    whole::<Gray8>(SCREEN, Gray8::new(0), |scene| {
        scene.draw_lines_with(ALL, line, &Projective::IDENTITY, &Recorder(&hits), stroke);
    });
    let drawn = |color: Rgb888, background: u8| {
        let (picture, ..) = whole::<Gray8>(SCREEN, Gray8::new(background), |scene| {
            scene.draw_lines_with(ALL, line, &Projective::IDENTITY, &Flat::unlit(color), stroke);
        });
        picture
    };
    let (white, black) = (drawn(Rgb888::WHITE, 0), drawn(Rgb888::BLACK, 255));
    let mut hits = hits.into_inner();
    for hit in &mut hits {
        let pair = (white[hit.place()], black[hit.place()]);
        let is_covered = |coverage: i32| pair == (mix(0, 255, coverage), mix(255, 0, coverage));
        // A pixel that is not covered has no fragment, so no depth is written there.
        hit.coverage = (1..=256).find(|coverage| is_covered(*coverage)).expect("a coverage that yields this pixel");
    }
    hits
}

/// A channel covered by `coverage` / 256 with another one, to nearest.
fn mix(under: u8, over: u8, coverage: i32) -> u8 {
    let (under, over) = (i32::from(under), i32::from(over));
    (under + (((over - under) * coverage + 128) >> 8)) as u8
}

/// A square over the whole screen, with a colour in each corner, its depth 1/4 on the left and 3/4 on the right.
fn backdrop<F: Framebuffer>(scene: &mut Scene<'_, F>) {
    let corners = [(-1, -1, 250), (1, -1, 750), (1, 1, 750), (-1, 1, 250)];
    let corners = corners.map(|(x, y, z)| Vec3::from_milli(1000 * x, 1000 * y, z));
    let colors = [[255, 0, 40], [0, 255, 80], [20, 30, 255], [255, 255, 255]];
    let square =
        MeshData { topology: Topology::Quads, colors: Some(&colors), ..MeshData::new(Positions::Exact(&corners)) };
    let square = Mesh::new(square).expect("a square");
    let state = State { cull: Cull::None, ..State::DEFAULT };
    scene.draw_with(state, &square, &Projective::IDENTITY, &Gouraud::vertex_colors());
}

fn passes(compare: Compare, depth: u16, there: u16) -> bool {
    match compare {
        Compare::Never => false,
        Compare::Less => depth < there,
        Compare::Equal => depth == there,
        Compare::LessEqual => depth <= there,
        Compare::Greater => depth > there,
        Compare::NotEqual => depth != there,
        Compare::GreaterEqual => depth >= there,
        Compare::Always => true,
    }
}

/// Depth tests: all shortcuts the crate has, and others.
const TESTS: [DepthState; 6] = [
    DepthState::LESS,
    DepthState::TEST,
    DepthState::OFF,
    DepthState { compare: Compare::Always, write: true },
    DepthState { compare: Compare::GreaterEqual, write: true },
    DepthState { compare: Compare::Greater, write: false },
];

/// A few random lines in one stroke, and the fragments that they have.
struct Strokes<K> {
    stroke: K,
    ends: Vec<[Vec3; 2]>,
    hits: Vec<Hit>,
}

impl<K: Stroke + Debug> Strokes<K> {
    fn new(stroke: K) -> Self {
        let mut rng = Rng::new(5);
        let mut end = || {
            let [x, y] = [(); 2].map(|()| rng.between(-1300, 1300));
            Vec3::from_milli(x, y, rng.between(0, 1000))
        };
        let ends: Vec<_> = (0..6).map(|_| [end(), end()]).collect();
        let hits: Vec<_> = ends.iter().flat_map(|ends| hits(&line(ends), &stroke)).collect();
        assert!(hits.len() > 40, "{stroke:?}: {} pixels", hits.len());
        Self { stroke, ends, hits }
    }

    /// Draws the lines over the backdrop.
    fn draw<F: Framebuffer>(&self, scene: &mut Scene<'_, F>, depth: DepthState, shader: &impl Shader<F::Format>) {
        backdrop(scene);
        let state = State { depth, ..State::DEFAULT };
        for ends in &self.ends {
            scene.draw_lines_with(state, &line(ends), &Projective::IDENTITY, shader, &self.stroke);
        }
    }

    /// Draws the lines with each depth test and compares colours and depths with the model; returns what differs.
    ///
    /// `rule` makes a new pixel of a fragment and the pixel that is there, or discards the fragment.
    fn compare<P: PixelFormat<Raw: PartialEq + Debug>>(
        &self,
        name: &str,
        shader: &impl Shader<P>,
        rule: impl Fn(&Hit, P::Raw) -> Option<P::Raw>,
    ) -> Vec<String> {
        let mut wrong = Vec::new();
        let black = || P::to_color(P::pack([0; 3]));
        #[expect(clippy::redundant_closure, reason = "the function itself is not general enough in its lifetimes")]
        let (there_colors, there_depths, _) = whole::<P>(SCREEN, black(), |scene| backdrop(scene));
        for test in TESTS {
            let (mut colors, mut depths) = (there_colors.clone(), there_depths.clone());
            for hit in &self.hits {
                let (color, depth) = (&mut colors[hit.place()], &mut depths[hit.place()]);
                if !passes(test.compare, hit.depth, *depth) {
                    continue;
                }
                let Some(new) = rule(hit, *color) else { continue };
                let (under, over) = (P::unpack(*color), P::unpack(new));
                *color = P::pack([0, 1, 2].map(|k: usize| mix(under[k], over[k], hit.coverage)));
                if test.write {
                    *depth = hit.depth;
                }
            }
            let (found, found_depths, _) = whole::<P>(SCREEN, black(), |scene| self.draw(scene, test, shader));
            let parts = if test != DepthState::LESS && test != DepthState::OFF {
                found.clone()
            } else {
                strips::<P>(SCREEN, 5, 1000, black(), |scene| self.draw(scene, test, shader)).0
            };
            for (what, difference) in [
                ("colours", difference(&found, &colors, SCREEN.0)),
                ("depths", difference(&found_depths, &depths, SCREEN.0)),
                ("strips", difference(&parts, &found, SCREEN.0)),
            ] {
                let case = format!("{name}, {:?}, {}, {test:?}, {what}", self.stroke, core::any::type_name::<P>());
                wrong.extend(difference.map(|difference| format!("{case}: {difference}")));
            }
        }
        wrong
    }

    /// Whatever makes its own pixel, without regard for the one that is there.
    fn opaque<P: PixelFormat<Raw: PartialEq + Debug>>(&self) -> Vec<String> {
        [
            self.compare::<P>("no wrapper", &Source, |hit, _| Some(opaque::<P>(hit))),
            self.compare::<P>("Replace", &Blend::new(Source, Replace), |hit, _| Some(opaque::<P>(hit))),
            self.compare::<P>("AlphaTest", &AlphaTest::new(Source, 100), |hit, _| {
                (hit.rgba()[3] >= 100).then(|| opaque::<P>(hit))
            }),
            self.compare::<P>("Fogged", &Fogged::new(Source, &FOG, Rgb888::CSS_TEAL), |hit, _| {
                let left = u32::from(FOG.transmittance(hit.depth));
                Some(P::mix(opaque::<P>(hit), P::pack([0, 128, 128]), left + (left >> 7)))
            }),
            self.compare::<P>("a shader of one's own", &Negative, |hit, there| match hit.position.0 % 3 {
                0 => None,
                1 => Some(P::pack(P::unpack(there).map(|c| !c))),
                _ => Some(opaque::<P>(hit)),
            }),
            self.compare::<P>("ScreenDoor", &ScreenDoor::new(Source, 7), |hit, _| {
                (order(hit.position) < 7).then(|| opaque::<P>(hit))
            }),
        ]
        .concat()
    }

    /// Depth alone.
    fn depth_only<P: PixelFormat<Raw: PartialEq + Debug>>(&self) -> Vec<String> {
        self.compare::<P>("DepthOnly", &DepthOnly, |_, there| Some(there))
    }

    /// Whatever makes a new pixel of the one that is there.
    fn blended<P: PixelFormat<Raw: PartialEq + Debug>>(&self) -> Vec<String> {
        let tested = AlphaTest::new(Source, 100);
        [
            self.compare::<P>("Opacity", &Blend::new(Source, Opacity(90)), |hit, there| {
                Some(P::mix(opaque::<P>(hit), there, 90))
            }),
            self.compare::<P>("Alpha", &Blend::new(Source, Alpha), |hit, there| {
                Some(channels::<P>(hit, there, |s, a, t| by_255(s * a + t * (255 - a))))
            }),
            self.compare::<P>("Add", &Blend::new(Source, Add), |hit, there| Some(P::add(opaque::<P>(hit), there))),
            self.compare::<P>("AddAlpha", &Blend::new(Source, AddAlpha), |hit, there| {
                Some(channels::<P>(hit, there, |s, a, t| by_255(s * a).saturating_add(t as u8)))
            }),
            self.compare::<P>("Multiply", &Blend::new(Source, Multiply), |hit, there| {
                Some(channels::<P>(hit, there, |s, _, t| by_255(s * t)))
            }),
            self.compare::<P>("AlphaTest in Opacity", &Blend::new(tested, Opacity(90)), |hit, there| {
                (hit.rgba()[3] >= 100).then(|| P::mix(opaque::<P>(hit), there, 90))
            }),
        ]
        .concat()
    }

    /// All colours in several formats.
    fn check(&self) {
        let opaque = [
            self.opaque::<Rgb565>(),
            self.opaque::<Rgb565Be>(),
            self.opaque::<Rgb888>(),
            self.opaque::<Gray8>(),
            self.opaque::<Dithered<Rgb565>>(),
        ];
        let blended = [self.blended::<Rgb565>(), self.blended::<Rgb888>(), self.blended::<Gray8>()];
        assert_eq!(opaque.into_iter().chain(blended).flatten().collect::<Vec<_>>(), [""; 0]);
    }
}

/// A single line.
fn line(ends: &[Vec3; 2]) -> Lines<'_> {
    Lines::new(Vertices::new(Positions::Exact(ends)), LineTopology::Pairs, None).expect("a line")
}

/// `x` / 255, to nearest.
fn by_255(x: u32) -> u8 {
    ((2 * x + 255) / 510) as u8
}

/// A new pixel from each channel of the source, its alpha, and the channel that is there.
fn channels<P: PixelFormat>(hit: &Hit, there: P::Raw, rule: impl Fn(u32, u32, u32) -> u8) -> P::Raw {
    let ([r, g, b, alpha], there) = (hit.rgba(), P::unpack(there));
    let channel = |s: u8, t: u8| rule(s.into(), alpha.into(), t.into());
    P::pack([channel(r, there[0]), channel(g, there[1]), channel(b, there[2])])
}

/// The source's colour without its alpha.
fn opaque<P: PixelFormat>(hit: &Hit) -> P::Raw {
    let [r, g, b, _] = hit.rgba();
    P::pack_at([r, g, b], hit.position)
}

/// Bayer's order of a pixel among 16.
fn order((x, y): (i32, i32)) -> u8 {
    let bit = |v: i32, k: u32| (v >> k & 1) as u8;
    [0, 1].iter().fold(0, |order, k| order | (bit(x ^ y, *k) << 1 | bit(y, *k)) << (2 * (1 - k)))
}

#[test]
fn thin_lines_blend_discard_and_test_as_their_pixels_would() {
    Strokes::new(Thin).check();
}

#[test]
fn dashed_lines_blend_discard_and_test_as_their_pixels_would() {
    Strokes::new(Dashed(0x7713_E713)).check();
}

#[test]
fn thick_lines_blend_discard_and_test_as_their_pixels_would() {
    Strokes::new(Thick::new(Pixels::from_bits(700))).check();
}

#[test]
fn smooth_lines_blend_discard_and_test_as_their_pixels_would() {
    Strokes::new(Smooth::new(Pixels::from_bits(100))).check();
    Strokes::new(Smooth::new(Pixels::from_bits(700))).check();
}

#[test]
fn lines_leave_nothing_but_depth() {
    let hard = [
        Strokes::new(Thin).depth_only::<Rgb565>(),
        Strokes::new(Dashed(0x7713_E713)).depth_only::<Rgb565>(),
        Strokes::new(Thick::new(Pixels::from_bits(700))).depth_only::<Rgb565>(),
    ];
    assert_eq!(hard.concat(), [""; 0]);
}

#[test]
fn smooth_lines_leave_nothing_but_depth() {
    assert_eq!(Strokes::new(Smooth::new(Pixels::from_bits(700))).depth_only::<Rgb565>(), [""; 0]);
}

/// White over black shows each 256th of coverage.
#[test]
fn smooth_lines_leave_depth_where_they_cover_something_and_nowhere_else() {
    let mut rng = Rng::new(16);
    let (mut covered, mut faint) = (0, 0);
    for _ in 0..200 {
        let [a, b] = [(); 2].map(|()| Vec3::from_milli(rng.between(-1100, 1100), rng.between(-1100, 1100), 500));
        let width = rng.pick(&[1, 3, 20, 200, 700]);
        let (colors, depths, _) = whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| {
            let (shader, stroke) = (Flat::unlit(Rgb888::WHITE), Smooth::new(Pixels::from_bits(width)));
            scene.draw_lines(&line(&[a, b]), &Projective::IDENTITY, &shader, &stroke);
        });
        for (k, (color, depth)) in colors.iter().zip(depths).enumerate() {
            let case = format!("seed {}: {a:?} {b:?}, width {width}, pixel {k}: {color:?}, {depth}", rng.seed());
            assert_eq!(*color != [0; 3], depth != u16::MAX, "{case}");
            covered += u32::from(color[0] == 255);
            faint += u32::from((1..9).contains(&color[0]));
        }
    }
    assert!(covered > 500 && faint > 500, "{covered} pixels covered, {faint} pixels hardly covered");
}
