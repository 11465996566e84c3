//! The scene: the data that all stages of a frame share, its phases and draws, and stage 1 of [the
//! pipeline](crate#the-pipeline), bounds.

use super::state::State;
use crate::math::Projective;
use crate::mesh::{Bounds, BoundsNode, Mesh, MeshData, Positions};
use crate::raster::PixelRect;
use crate::span::Sample;
use crate::target::{Framebuffer, Records, Stats, StripRows};
use crate::vertex::{
    DepthRange, DepthScale, MAX_DISTANCES, Planes, ScreenMatrix, Transform, VERTEX_WORDS, Varyings, VertexShader,
    Viewport,
};
use core::ops::Range;
use embedded_graphics_core::geometry::Size;

/// Phases of a frame: the work that one call of the frame's closure does, see [the pipeline](crate#the-pipeline).
///
/// Three things are close to each other and must not be confused:
/// - [`Direct`](Self::Direct) is a phase.
/// - While it lasts, a draw may still keep its vertices, see `Scene::keeps_vertices`.
/// - A framebuffer type with `RECORDS = false` has no other phase, so that code for records is not linked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Phase {
    /// Runs stages 1 to 7 for the strips of a band, and writes the records.
    Record,
    /// Runs stages 8 to 11 for one strip, from the records.
    Replay,
    /// Runs stages 1 to 11 for one strip, without records of triangles.
    Direct,
}

/// The destination of pixels while a strip is drawn.
#[derive(Debug)]
pub(crate) struct Target<'a, F> {
    pub(crate) framebuffer: &'a mut F,
    /// Depths of the strip's rows, one after the other.
    pub(crate) depth: &'a mut [u16],
    /// Rows of the screen that the strip covers.
    pub(crate) rows: Range<i32>,
}

impl<F: Framebuffer> Target<'_, F> {
    /// Returns the sample that is drawn into now.
    #[inline(always)]
    pub(super) fn selected(&mut self) -> Sample {
        Sample::new(self.framebuffer.selected_sample(), F::SAMPLES)
    }

    /// Returns the target of one sample, of rows `width` px wide.
    pub(super) fn sample(&mut self, sample: usize, width: u16) -> Target<'_, F> {
        let Self { framebuffer, depth, rows } = self;
        framebuffer.select_sample(sample);
        // Depths are in the order of samples, too.
        let pixels = usize::from(width).wrapping_mul((rows.end - rows.start) as usize);
        let depth = depth.get_mut(pixels.wrapping_mul(sample)..).unwrap_or_default();
        Target { framebuffer, depth, rows: rows.clone() }
    }
}

/// The object that a frame is drawn through; see [`Renderer::frame`](crate::frame::Renderer::frame).
///
/// A function that draws into scenes of any renderer takes `&mut Scene<'_, impl Framebuffer>`. One that is given a
/// shader, or draws embedded-graphics text, names the format:
///
/// ```
/// use zstrip::{color::PixelFormat, prelude::*, span::Shader};
///
/// fn twice<F: Framebuffer, S: Shader<F::Format>>(scene: &mut Scene<'_, F>, mesh: &Mesh, mvp: &Projective, s: &S) {
///     (0..2).for_each(|_| scene.draw(mesh, mvp, s));
/// }
///
/// fn label<F: Framebuffer<Format: PixelFormat<Color = Rgb565>>>(scene: &mut Scene<'_, F>) {
///     scene.overlay(); // .draw(&Text::new(...))
/// }
///
/// struct Screen<'b> {
///     renderer: Renderer<'b, Rgb565Be, WithDepth, WithRecords>,
///     color: &'b mut [u16],
/// }
/// ```
#[derive(Debug)]
pub struct Scene<'a, F> {
    pub(crate) screen: (u16, u16),
    pub(crate) viewport: Viewport,
    pub(crate) phase: Phase,
    pub(crate) records: Records<'a>,
    pub(crate) strips: &'a StripRows,
    /// Rows of the band that is being recorded, replayed or drawn.
    pub(crate) band: Range<i32>,
    pub(crate) target: Target<'a, F>,
    pub(crate) stats: &'a mut Stats,
    /// Number of the next draw, and number of the first draw that differed from its record.
    pub(crate) draws: u32,
    pub(crate) changed: Option<u32>,
}

impl<'a, F: Framebuffer> Scene<'a, F> {
    /// Returns whether an object with these bounds may be visible in the part of the screen that is being drawn. An
    /// object that is not visible can be left out together with everything inside of it, which culls a tree of objects.
    ///
    /// [`is_visible_with`](Self::is_visible_with) also asks whether the object is hidden by what has been drawn.
    ///
    /// The result is the same in all calls of the closure that must draw the same. The near and the far plane count as
    /// borders, whatever [`State::range`] says about geometry outside of them.
    ///
    /// [`Mesh::bounds`] of [homogeneous](crate::mesh::Positions::Homogeneous) positions ignore their w, and those of a
    /// mesh that a shader moves ignore the shader: such bounds do not tell where the mesh is drawn.
    #[inline(never)]
    #[must_use]
    pub fn is_visible(&self, bounds: &Bounds, mvp: &Projective) -> bool {
        let mut screen = ScreenMatrix::EMPTY;
        screen.set_from(mvp, &self.viewport);
        self.sees(&screen, bounds, 0, DepthRange::Clip)
    }

    /// Maps clip space to a part of the screen from here on. Pixels outside of it are not changed. Each call of the
    /// closure starts with the whole screen.
    pub const fn set_viewport(&mut self, viewport: Viewport) {
        self.viewport = viewport;
    }

    /// Returns the size of the screen.
    #[must_use]
    pub const fn screen(&self) -> Size {
        Size::new(self.screen.0 as u32, self.screen.1 as u32)
    }

    /// Returns the pixels that may be drawn in `rows` of the screen.
    #[inline(never)]
    pub(super) fn clip_rect(&self, rows: &Range<i32>) -> PixelRect {
        let (x, y) = (i32::from(self.viewport.x()), i32::from(self.viewport.y()));
        let viewport =
            PixelRect { x: x..x + i32::from(self.viewport.width()), y: y..y + i32::from(self.viewport.height()) };
        viewport.intersection(&PixelRect { x: 0..i32::from(self.screen.0), y: rows.clone() })
    }

    /// Returns whether bounds may be visible in the band, or up to `reach` px away from it.
    pub(super) fn sees(&self, screen: &ScreenMatrix, bounds: &Bounds, reach: i32, range: DepthRange) -> bool {
        let PixelRect { x, y } = self.clip_rect(&self.band);
        let (x, y) = (x.start - reach..x.end + reach, y.start - reach..y.end + reach);
        screen.sees(bounds, &x, &y, range.clamped())
    }

    /// Sets planes to the sides of the part of the view volume that is seen through the band.
    #[inline(never)]
    pub(super) fn set_planes(&self, planes: &mut Planes, mvp: &Projective, range: DepthRange) {
        let mut screen = ScreenMatrix::EMPTY;
        screen.set_from(mvp, &self.viewport);
        let PixelRect { x, y } = self.clip_rect(&self.band);
        screen.set_planes(planes, &x, &y, range.clamped());
    }

    /// Tests up to 32 nodes of a hierarchy, from `next` on, and moves `next` past them. Returns one bit per node, the
    /// lowest one for the first node, set if the node may be visible. Not inlined, so that the matrix is no longer on
    /// the stack when the nodes are drawn.
    #[inline(never)]
    pub(super) fn visible_nodes(
        &mut self,
        state: &State,
        nodes: &[BoundsNode],
        mvp: &Projective,
        next: &mut usize,
    ) -> u32 {
        let mut screen = ScreenMatrix::EMPTY;
        screen.set_from(mvp, &self.viewport);
        let (first, mut visible) = (*next, 0);
        while let (Some(node), Some(bit)) = (nodes.get(*next), 1_u32.checked_shl((*next - first) as u32)) {
            let seen = self.sees(&screen, &node.bounds, 0, state.range);
            if F::OCCLUDES && seen && self.hides_bounds(state, &screen, &node.bounds) {
                self.stats.culled = self.stats.culled.wrapping_add(1);
                *next = usize::from(node.skip);
            } else if seen {
                visible |= bit;
                *next += 1;
            } else {
                self.stats.culled = self.stats.culled.wrapping_add(1);
                *next = usize::from(node.skip);
            }
        }
        visible
    }

    /// Stage 1, bounds, of a draw of any kind: enters it into the records, or prepares to draw it directly, unless its
    /// bounds are out of view. Returns whether there is anything to draw.
    ///
    /// Makes the transform of the vertex stage in `transform`, if one is given.
    #[inline(never)]
    pub(super) fn begin_draw(&mut self, draw: &Draw<'_>, transform: Option<&mut Transform>) -> bool {
        self.count_draw();
        let recording = self.is_recording();
        if self.overflowed() {
            return false;
        }
        let mut screen = ScreenMatrix::EMPTY;
        screen.set_from(draw.mvp, &self.viewport);
        let culled = draw.is_tested() && !self.sees(&screen, draw.mesh.bounds(), draw.reach(), draw.state.range);
        if recording {
            // A draw that is out of view leaves a header without vertices.
            let vertices = if culled { 0 } else { draw.mesh.vertex_count() };
            self.records.begin_draw(fingerprint(draw, &self.viewport), vertices, draw.stride);
            if self.overflowed() {
                return false;
            }
        }
        if culled {
            self.stats.culled = self.stats.culled.wrapping_add(1);
            self.end_draw();
            return false;
        }
        if F::OCCLUDES && !recording {
            if self.hides_draw(draw, &screen) {
                return false;
            }
            self.note_test(draw.state.depth);
        }
        if F::RECORDS && !recording {
            self.records.keep_vertices(draw.mesh.vertex_count(), draw.stride);
        }
        if let Some(transform) = transform {
            draw.set_transform(&screen, transform);
        }
        true
    }

    pub(super) fn end_draw(&mut self) {
        if self.is_recording() {
            if F::OCCLUDES {
                self.records.keep_extent();
            }
            self.records.end_draw();
        }
    }

    /// Returns [`samples`] of lines or points, for the fingerprint of their draw; 0 if draws need none, because nothing
    /// is recorded.
    pub(super) fn samples(&self, mesh: &Mesh<'_>, count: usize, primitive: impl Fn(usize) -> Option<[u16; 3]>) -> u32 {
        if F::RECORDS && self.phase != Phase::Direct { samples(mesh, count, primitive) } else { 0 }
    }

    pub(super) fn is_recording(&self) -> bool {
        F::RECORDS && self.phase == Phase::Record
    }

    /// Returns whether the records are full, so that recording more is in vain.
    pub(crate) fn overflowed(&self) -> bool {
        F::RECORDS && self.records.overflowed()
    }

    /// Returns whether the results of the vertex stage are kept during the current draw. While a band is recorded or
    /// replayed, they are in its records. While a strip is drawn directly, they are in the words that are lent for
    /// records, if all vertices of the draw fit.
    pub(super) fn keeps_vertices(&self) -> bool {
        F::RECORDS && self.records.keeps_vertices()
    }

    /// Finds the records of a draw in the strip that is replayed. Returns `false` if the records are those of a
    /// different draw: then the closure has drawn two different things.
    #[inline(never)]
    pub(super) fn find_draw(&mut self, draw: &Draw<'_>) -> bool {
        let print = fingerprint(draw, &self.viewport);
        let number = self.count_draw();
        let found = self.changed.is_none() && self.records.replay_draw(print, draw.mesh.vertex_count(), draw.stride);
        if F::OCCLUDES {
            self.note_test(draw.state.depth);
        }
        if !found {
            self.changed = self.changed.or(Some(number));
        }
        found
    }

    pub(super) fn count_draw(&mut self) -> u32 {
        let draw = self.draws;
        self.draws = draw.saturating_add(1);
        self.stats.draws = self.stats.draws.wrapping_add(1);
        draw
    }
}

/// Kinds of primitives, with the numbers that tell draws of one mesh apart.
#[derive(Clone, Copy, Debug)]
pub(super) enum Primitives {
    Triangles,
    Lines {
        /// Largest distance from a line, in pixels, that its stroke may cover.
        reach: i32,
        /// See [`Scene::samples`].
        samples: u32,
    },
    Points {
        reach: i32,
        samples: u32,
    },
}

/// A draw as stages 1 and 2 see it: one description for triangles, lines and points, whatever the shader is.
#[derive(Debug)]
pub(super) struct Draw<'d> {
    pub(super) state: &'d State,
    /// The mesh, or the vertices of lines or points as a mesh without triangles.
    pub(super) mesh: &'d Mesh<'d>,
    pub(super) mvp: &'d Projective,
    primitives: Primitives,
    /// Number of words per vertex in the records.
    stride: usize,
    /// Hash of the shader's and the stroke's types, see [`types`].
    types: u32,
    /// Set if the shader moves vertices.
    displaced: bool,
    /// Set if the shader has cull distances.
    pub(super) has_cull_distances: bool,
    /// Set if any varying is perspective-correct.
    pub(super) is_perspective: bool,
    /// Sets the depth scale of the state. `None` if it is known at compile time that the state has no depth scale to
    /// set.
    depth_scale: Option<fn(&mut Transform, DepthScale)>,
}

/// Number of vertices up to which a mesh's bounds are not tested, because the test takes as long as a few vertices.
const FEW_VERTICES: usize = 4;

impl<'d> Draw<'d> {
    /// Describes a draw by a shader and, for lines, by a stroke.
    #[inline(always)]
    pub(super) fn new<S: VertexShader, K>(
        state: &'d State,
        depth_scale: Option<fn(&mut Transform, DepthScale)>,
        mesh: &'d Mesh<'d>,
        mvp: &'d Projective,
        primitives: Primitives,
    ) -> Self {
        check::<S>();
        let (stride, types) = (S::WORDS + VERTEX_WORDS, types::<S, K>());
        let (displaced, has_cull_distances) = (S::DISPLACES, S::CULL_DISTANCES > 0);
        let is_perspective = S::Varyings::PERSPECTIVE > 0;
        Self { state, mesh, mvp, primitives, stride, types, displaced, has_cull_distances, is_perspective, depth_scale }
    }

    /// Returns whether the mesh's bounds, and those of its hierarchy, tell where it is drawn.
    fn is_bounded(&self) -> bool {
        !self.displaced && !matches!(self.mesh.data().positions, Positions::Homogeneous(_))
    }

    /// Returns the hierarchy that parts of the mesh can be culled by.
    pub(super) fn hierarchy(&self) -> Option<&'d [BoundsNode]> {
        if self.is_bounded() { self.mesh.data().hierarchy } else { None }
    }

    /// Returns whether the draw is one of triangles, and its mesh's bounds can be tested.
    pub(super) fn is_filled(&self) -> bool {
        matches!(self.primitives, Primitives::Triangles) && self.is_tested()
    }

    /// Returns whether the mesh's bounds can be tested, and are worth it.
    fn is_tested(&self) -> bool {
        self.mesh.vertex_count() > FEW_VERTICES && self.is_bounded()
    }

    /// Returns the largest distance from its vertices, in pixels, that a primitive may cover.
    fn reach(&self) -> i32 {
        match self.primitives {
            Primitives::Triangles => 0,
            Primitives::Lines { reach, .. } | Primitives::Points { reach, .. } => reach,
        }
    }

    /// Makes the transform of the vertex stage, with the depth scale.
    pub(super) fn set_transform(&self, screen: &ScreenMatrix, transform: &mut Transform) {
        transform.set_from(screen, self.mesh, self.displaced);
        if let Some(scale) = self.depth_scale {
            scale(transform, self.state.depth_scale);
        }
    }
}

/// Checks the constants of a shader, while the program is compiled. Every way into a draw comes through here: meshes,
/// lines and points by [`Draw::new`], and shapes of a canvas by `Scene::painter`.
#[inline(always)]
pub(super) const fn check<S: VertexShader>() {
    const {
        assert!(S::WORDS <= <S::Varyings as Varyings>::LEN, "a vertex needs no more words than varyings");
        assert!(S::WORDS <= 253, "a vertex has at most 253 words of varyings");
        assert!(S::ZERO_BITS == 0 || S::Varyings::PERSPECTIVE == 0, "perspective takes all bits of varyings");
        assert!(S::CLIP_DISTANCES + S::CULL_DISTANCES <= MAX_DISTANCES, "at most 4 clip and cull distances");
        assert!(S::ZERO_BITS <= 16, "at most 16 bits of varyings are known to be zero");
        assert!(S::Varyings::PERSPECTIVE <= S::Varyings::LEN.saturating_sub(1), "1 / w takes the last varying");
    };
}

/// Adds a word to a hash: FNV-1a over words instead of bytes.
#[inline]
const fn step(hash: u32, word: u32) -> u32 {
    (hash ^ word).wrapping_mul(0x0100_0193).rotate_left(11)
}

const EMPTY_HASH: u32 = 0x811C_9DC5;

/// Returns a hash of a shader's shape, of its type and of a stroke's type. Records that one shader wrote are garbage to
/// another one: so the number of words, and the meaning of each, are part of a draw's fingerprint.
///
/// Types are told apart by their names: their lengths, and up to 160 bytes of them. A `TypeId` would ask for types
/// without borrowed data, and addresses of functions may differ from use to use. The compiler knows the names, and
/// makes one constant of all this. It does so only of steps that stand one by one, so there is no loop; a loop would
/// link the names.
#[inline(always)]
fn types<S: VertexShader, K>() -> u32 {
    let shape = const {
        let words = step(EMPTY_HASH, (S::WORDS | <S::Varyings as Varyings>::LEN << 8) as u32);
        let words = step(words, S::Varyings::PERSPECTIVE as u32 | S::ZERO_BITS << 16);
        step(words, (S::CLIP_DISTANCES | S::CULL_DISTANCES << 4) as u32 | (S::DISPLACES as u32) << 8)
    };
    name_hash::<K>(name_hash::<S>(shape))
}

/// Adds the name of a type to a hash.
#[inline(always)]
fn name_hash<T>(hash: u32) -> u32 {
    let name = core::any::type_name::<T>().as_bytes();
    let word = |at: usize| match name.get(at..) {
        Some([a, b, c, d, ..]) => u32::from_le_bytes([*a, *b, *c, *d]),
        _ => 0,
    };
    // Four words from the beginning, from the middle, ... The last one ends with the name.
    let four = |hash, at: usize| step(step(step(step(hash, word(at)), word(at + 4)), word(at + 8)), word(at + 12));
    let hash = four(four(four(step(hash, name.len() as u32), 0), 16), 32);
    let hash = four(four(four(hash, 48), 64), 80);
    let hash = four(four(hash, 96), 112);
    four(four(hash, name.len().saturating_sub(32)), name.len().saturating_sub(16))
}

/// Returns a word that differs, almost surely, between draws that would not leave equal records, or would not draw them
/// alike.
///
/// The contents of a mesh are too many to look at in each strip. Its addresses would tell meshes apart, but also equal
/// meshes that the closure builds anew in each call. So a few numbers stand for the mesh: its sizes, its bounds, and
/// its first, middle and last primitive, each with the position of a corner.
#[inline(never)]
fn fingerprint(draw: &Draw<'_>, viewport: &Viewport) -> u32 {
    let Draw { state, mesh, mvp, primitives, .. } = draw;
    let ([ax, ay, az], [bx, by, bz]) = (mesh.bounds().center.to_bits(), mesh.bounds().half.to_bits());
    let (kind, samples) = match *primitives {
        Primitives::Triangles => (0, samples(mesh, mesh.triangle_count(), |n| mesh.any_triangle(n))),
        Primitives::Lines { reach, samples } => (1 | reach << 2, samples),
        Primitives::Points { reach, samples } => (2 | reach << 2, samples),
    };
    let rest = [
        viewport.x() as u32 ^ (viewport.y() as u32) << 16,
        u32::from(viewport.width()) | u32::from(viewport.height()) << 16,
        mesh.vertex_count() as u32 ^ samples,
        kind as u32,
        ax as u32,
        ay as u32,
        az as u32,
        bx as u32,
        by as u32,
        bz as u32,
        draw.types,
        slices(mesh.data()) | (state.cull as u32) << 16 | (state.range as u32) << 24,
        state.depth.compare as u32 | u32::from(state.depth.write) << 8 | (state.front as u32) << 9,
        (state.bias.constant as u32) << 16 ^ state.bias.slope.to_bits() as u32,
        match state.depth_scale {
            DepthScale::Perspective => 0,
            DepthScale::Uniform { far } => far.to_bits() as u32,
        },
    ];
    let entries = mvp.rows().as_flattened().iter();
    let hash = entries.fold(EMPTY_HASH, |hash, entry| step(step(hash, *entry as u32), (*entry >> 32) as u32));
    rest.iter().fold(hash, |hash, word| step(hash, *word))
}

/// Returns a hash of the number of primitives, and of the first, the middle and the last one: their vertices, and the
/// position of one of these.
#[inline]
fn samples(mesh: &Mesh<'_>, count: usize, primitive: impl Fn(usize) -> Option<[u16; 3]>) -> u32 {
    let mut hash = count as u32;
    for number in [0, count >> 1, count.wrapping_sub(1)] {
        let [i, j, k] = primitive(number).unwrap_or_default();
        let [x, y, z, _] = mesh.data().positions.numbers(i.into());
        let corner = step(step(step(hash, x as u32), y as u32), z as u32);
        hash = step(step(corner, u32::from(i) | u32::from(j) << 16), k.into());
    }
    hash
}

/// Returns a number that tells which slices a mesh has, and how they form triangles.
fn slices(data: &MeshData<'_>) -> u32 {
    let positions = match data.positions {
        Positions::Quantized { .. } => 0,
        Positions::Exact(_) => 1,
        Positions::Homogeneous(_) => 2,
    };
    let bit = |is: bool, place: u32| u32::from(is) << place;
    positions
        | (data.topology as u32) << 2
        | bit(data.indices.is_some(), 4)
        | bit(data.normals.is_some(), 5)
        | bit(data.face_normals.is_some(), 6)
        | bit(data.colors.is_some(), 7)
        | bit(data.uvs.is_some(), 8)
}

/// Programs that draw with a shader of too many [`ZERO_BITS`](VertexShader::ZERO_BITS), in every way: none of them
/// compiles. With 16 bits, all of them do.
#[cfg(doctest)]
mod every_way_checks_the_shader {
    macro_rules! program {
        ($fence:literal, $bits:literal, $draw:literal) => {
            concat!(
                "```",
                $fence,
                r"
                use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
                use zstrip::{Framebuffer, Scene, ScreenPoint, Smooth, State, Thin, prelude::*};
                use zstrip::{math::*, mesh::*, span::*, vertex::*};

                struct Coarse;

                impl VertexShader for Coarse {
                    type Varyings = [i32; 1];
                    const ZERO_BITS: u32 = ",
                $bits,
                r";
                    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 1] { [0] }
                }

                impl Shader<Rgb565> for Coarse {
                    type Setup = ();
                    fn fragment(&self, _: &Fragment<'_, [i32; 1], ()>) -> Option<u16> { None }
                }

                let points = [Vec3::ZERO; 6];
                let mesh = Mesh::new(MeshData::new(Positions::Exact(&points))).unwrap();
                let vertices = Vertices::new(Positions::Exact(&points));
                let lines = Lines::new(vertices, LineTopology::Strip, None).unwrap();
                let dots = Points::new(vertices).unwrap();
                let (mvp, shader, mut buffer) = (Projective::IDENTITY, Coarse, [0; 64]);
                let mut renderer = Renderer::<Rgb565>::new(Size::new(8, 8)).unwrap();
                let mut frame = renderer.begin(Rgb888::BLACK);
                frame.next_strip(&mut buffer, |scene| ",
                $draw,
                ").unwrap();\n```"
            )
        };
    }

    macro_rules! ways {
        ($($name:ident: $draw:literal)*) => { $(
            #[doc = program!("compile_fail", "40", $draw)]
            #[doc = program!("", "16", $draw)]
            struct $name;
        )* };
    }

    ways! {
        Draw: "scene.draw(&mesh, &mvp, &shader)"
        DrawWith: "scene.draw_with(State::DEFAULT, &mesh, &mvp, &shader)"
        DrawLines: "scene.draw_lines(&lines, &mvp, &shader, &Thin)"
        DrawSmoothLines: "scene.draw_lines_with(State::DEFAULT, &lines, &mvp, &shader, &Smooth::px(2))"
        DrawPoints: "scene.draw_points(&dots, &mvp, &shader, Pixels::ONE)"
        DrawPointsWith: "scene.draw_points_with(State::DEFAULT, &dots, &mvp, &shader, Pixels::ONE)"
        PolygonWith: "scene.canvas().polygon_with(&[(ScreenPoint::corner(0, 0), [0])], &shader, 0)"
    }
}
