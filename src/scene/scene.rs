//! The scene: what the stages of a frame share; phases, draws and stage 1 of [the pipeline](crate#the-pipeline), bounds.

use super::state::State;
use crate::math::Projective;
use crate::mesh::{Bounds, BoundsNode, Mesh, Positions};
use crate::raster::PixelRect;
use crate::target::{Framebuffer, Records, Stats, StripRows, VERTEX_WORDS};
use crate::vertex::{DepthRange, DepthScale, MAX_DISTANCES, ScreenMatrix, Transform, Varyings, VertexShader, Viewport};
use core::ops::Range;

/// Phases of a frame's closure: what one call of it does, see [the pipeline](crate#the-pipeline).
///
/// Three things are close to each other and not the same. [`Direct`](Self::Direct) is a phase. While it lasts, a draw may
/// still keep its vertices, see `Scene::keeps_vertices`. And a framebuffer type with `RECORDS = false` has no other
/// phase, so that code for records is not linked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Phase {
    /// Stages 1 to 7 for the strips of a band, into the records.
    Record,
    /// Stages 8 to 11 for one strip, from the records.
    Replay,
    /// Stages 1 to 11 for one strip, without records of triangles.
    Direct,
}

/// Where pixels go while a strip is drawn.
#[derive(Debug)]
pub(crate) struct Target<'a, F> {
    pub(crate) framebuffer: &'a mut F,
    /// Depths of the strip's rows, one after the other.
    pub(crate) depth: &'a mut [u16],
    /// Rows of the strip.
    pub(crate) rows: Range<i32>,
}

/// What a frame is drawn through; see [`Renderer::frame`](crate::frame::Renderer::frame).
#[derive(Debug)]
pub struct Scene<'a, F> {
    pub(crate) screen: (u16, u16),
    pub(crate) viewport: Viewport,
    pub(crate) phase: Phase,
    pub(crate) records: Records<'a>,
    pub(crate) strips: &'a StripRows,
    /// Rows of the band that is recorded, replayed or drawn.
    pub(crate) band: Range<i32>,
    pub(crate) target: Target<'a, F>,
    pub(crate) stats: &'a mut Stats,
    /// Number of the next draw, and the first that differed from what was recorded.
    pub(crate) draws: u16,
    pub(crate) changed: Option<u16>,
}

impl<'a, F: Framebuffer> Scene<'a, F> {
    /// Whether something with these bounds may be seen in the part of the screen that is being drawn; what is not can be
    /// left out, with everything inside of it: a hierarchy of objects.
    ///
    /// The answer is the same in all calls of the closure that must draw the same. It counts near and far plane as borders,
    /// whatever [`State::range`] says of what lies beyond them.
    #[inline(never)]
    #[must_use]
    pub fn is_visible(&self, bounds: &Bounds, mvp: &Projective) -> bool {
        let mut screen = ScreenMatrix::EMPTY;
        screen.set_from(mvp, &self.viewport);
        self.sees(&screen, bounds, 0, DepthRange::Clip)
    }

    /// Maps clip space to a part of the screen from here on; nothing outside of it is touched. Each call of the closure
    /// starts with the whole screen.
    pub const fn set_viewport(&mut self, viewport: Viewport) {
        self.viewport = viewport;
    }

    /// Width and height of the screen.
    #[must_use]
    pub const fn screen(&self) -> (u16, u16) {
        self.screen
    }

    /// The pixels that may be drawn, in `rows` of the screen.
    #[inline(never)]
    pub(super) fn clip_rect(&self, rows: &Range<i32>) -> PixelRect {
        let (x, y) = (i32::from(self.viewport.x()), i32::from(self.viewport.y()));
        let viewport =
            PixelRect { x: x..x + i32::from(self.viewport.width()), y: y..y + i32::from(self.viewport.height()) };
        viewport.intersection(&PixelRect { x: 0..i32::from(self.screen.0), y: rows.clone() })
    }

    /// Returns whether something may be seen in the band, or up to `reach` px away from it.
    fn sees(&self, screen: &ScreenMatrix, bounds: &Bounds, reach: i32, range: DepthRange) -> bool {
        let PixelRect { x, y } = self.clip_rect(&self.band);
        let (x, y) = (x.start - reach..x.end + reach, y.start - reach..y.end + reach);
        screen.sees(bounds, &x, &y, range.clamped())
    }

    /// Which of 32 nodes of a hierarchy can be seen, from `next` on, a bit each, the lowest for the first; `next` moves on behind
    /// them. In a function of its own, so that what it takes has left the stack when they are drawn.
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
            if self.sees(&screen, &node.bounds, 0, state.range) {
                visible |= bit;
                *next += 1;
            } else {
                self.stats.culled = self.stats.culled.wrapping_add(1);
                *next = usize::from(node.skip);
            }
        }
        visible
    }

    /// Stage 1, bounds, of a draw of any kind: enters it into the records, or prepares to draw it directly, unless its bounds are out
    /// of view. Returns whether there is anything to do.
    ///
    /// Makes the transform of the vertex stage in `transform`, where one is wanted.
    #[inline(never)]
    pub(super) fn begin_draw(&mut self, draw: &Draw<'_>, transform: Option<&mut Transform>) -> bool {
        self.count_draw();
        let recording = self.is_recording();
        if self.overflowed() {
            return false;
        }
        let mut screen = ScreenMatrix::EMPTY;
        screen.set_from(draw.mvp, &self.viewport);
        let culled = draw.is_bounded() && !self.sees(&screen, draw.mesh.bounds(), draw.reach(), draw.state.range);
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
            self.records.end_draw();
        }
    }

    pub(super) fn is_recording(&self) -> bool {
        F::RECORDS && self.phase == Phase::Record
    }

    /// Whether the records are full, so that a walk is in vain.
    pub(crate) fn overflowed(&self) -> bool {
        F::RECORDS && self.records.overflowed()
    }

    /// Returns whether the results of the vertex stage are kept for the time of the current draw: in the records of a band, or,
    /// in a strip that is drawn directly, in the words that are lent for records, if all vertices of the draw fit.
    pub(super) fn keeps_vertices(&self) -> bool {
        F::RECORDS && self.records.keeps_vertices()
    }

    /// Finds the records of a draw in the strip that is replayed. Returns `false` if the records are those of another draw:
    /// then the closure has drawn two different things.
    #[inline(never)]
    pub(super) fn find_draw(&mut self, draw: &Draw<'_>) -> bool {
        let print = fingerprint(draw, &self.viewport);
        let number = self.count_draw();
        let found = self.changed.is_none() && self.records.replay_draw(print, draw.mesh.vertex_count(), draw.stride);
        if !found {
            self.changed = self.changed.or(Some(number));
        }
        found
    }

    pub(super) fn count_draw(&mut self) -> u16 {
        let draw = self.draws;
        self.draws = draw.saturating_add(1);
        self.stats.draws = self.stats.draws.wrapping_add(1);
        draw
    }
}

/// Kinds of primitives, and what else tells draws of one mesh apart.
#[derive(Clone, Copy, Debug)]
pub(super) enum Primitives {
    Triangles,
    Lines {
        count: usize,
        /// How many pixels around a line its stroke may cover.
        reach: i32,
    },
    Points {
        reach: i32,
    },
}

/// A draw as stages 1 and 2 see it: one description for triangles, lines and points, whatever the shader.
#[derive(Debug)]
pub(super) struct Draw<'d> {
    pub(super) state: &'d State,
    /// The mesh; of lines and points, their vertices as a mesh without triangles.
    pub(super) mesh: &'d Mesh<'d>,
    pub(super) mvp: &'d Projective,
    primitives: Primitives,
    /// Words of a vertex in the records.
    stride: usize,
    /// How many varyings the shader has.
    varyings: usize,
    /// Whether the shader moves vertices.
    displaced: bool,
    /// Sets the depth scale of the state, unless the state is known not to have one.
    depth_scale: Option<fn(&mut Transform, DepthScale)>,
}

/// Mesh vertices up to which it is not worth a test of the bounds, which takes as long as a few vertices do.
const FEW_VERTICES: usize = 4;

impl<'d> Draw<'d> {
    /// Describes a draw. All draw calls come through here, so that no shader misses these checks.
    #[inline(always)]
    pub(super) fn new<S: VertexShader>(
        state: &'d State,
        depth_scale: Option<fn(&mut Transform, DepthScale)>,
        mesh: &'d Mesh<'d>,
        mvp: &'d Projective,
        primitives: Primitives,
    ) -> Self {
        const {
            assert!(S::WORDS <= <S::Varyings as Varyings>::LEN, "a vertex needs no more words than varyings");
            assert!(S::WORDS <= 253, "a vertex has at most 253 words of varyings");
            assert!(S::ZERO_BITS == 0 || S::Varyings::PERSPECTIVE == 0, "perspective takes all bits of varyings");
            assert!(S::CLIP_DISTANCES + S::CULL_DISTANCES <= MAX_DISTANCES, "at most 4 clip and cull distances");
            assert!(S::ZERO_BITS <= 16, "at most 16 bits of varyings are known to be zero");
        };
        let (stride, varyings) = (S::WORDS + VERTEX_WORDS, <S::Varyings as Varyings>::LEN);
        Self { state, mesh, mvp, primitives, stride, varyings, displaced: S::DISPLACES, depth_scale }
    }

    /// Returns whether the mesh's bounds say where it is drawn, and are worth a test.
    fn is_bounded(&self) -> bool {
        self.mesh.vertex_count() > FEW_VERTICES
            && !self.displaced
            && !matches!(self.mesh.data().positions, Positions::Homogeneous(_))
    }

    /// Returns how many pixels around its vertices a primitive may cover.
    fn reach(&self) -> i32 {
        match self.primitives {
            Primitives::Triangles => 0,
            Primitives::Lines { reach, .. } | Primitives::Points { reach } => reach,
        }
    }

    /// Makes the transform of the vertex stage, depth scale and all.
    pub(super) fn set_transform(&self, screen: &ScreenMatrix, transform: &mut Transform) {
        transform.set_from(screen, self.mesh, self.displaced);
        if let Some(scale) = self.depth_scale {
            scale(transform, self.state.depth_scale);
        }
    }
}

/// Returns a word that differs, almost surely, between draws that would not leave the same records.
#[inline(never)]
fn fingerprint(draw: &Draw<'_>, viewport: &Viewport) -> u32 {
    let Draw { state, mesh, mvp, primitives, stride, varyings, .. } = draw;
    let ([ax, ay, az], [bx, by, bz]) = (mesh.bounds().center.to_bits(), mesh.bounds().half.to_bits());
    let (kind, count) = match *primitives {
        Primitives::Triangles => (0, mesh.triangle_count()),
        Primitives::Lines { count, reach } => (1 | reach << 2, count),
        Primitives::Points { reach } => (2 | reach << 2, 0),
    };
    let rest = [
        viewport.x() as u32 ^ (viewport.y() as u32) << 16,
        u32::from(viewport.width()) | u32::from(viewport.height()) << 16,
        mesh.vertex_count() as u32 ^ (count as u32).rotate_left(16),
        kind as u32,
        ax as u32,
        ay as u32,
        az as u32,
        bx as u32,
        by as u32,
        bz as u32,
        *stride as u32 | (*varyings as u32) << 8 | (state.cull as u32) << 20 | (state.range as u32) << 24,
        state.depth.compare as u32 | u32::from(state.depth.write) << 8 | (state.front as u32) << 9,
        (state.bias.constant as u32) << 16 ^ state.bias.slope.to_bits() as u32,
        match state.depth_scale {
            DepthScale::Perspective => 0,
            DepthScale::Uniform { far } => far.to_bits() as u32,
        },
    ];
    // FNV-1a over words instead of bytes, two of them at once where there are many.
    let step = |hash: u32, word: u32| (hash ^ word).wrapping_mul(0x0100_0193).rotate_left(11);
    let entries = mvp.rows().as_flattened().iter();
    let hash = entries.fold(0x811C_9DC5, |hash, entry| step(step(hash, *entry as u32), (*entry >> 32) as u32));
    rest.iter().fold(hash, |hash, word| step(hash, *word))
}
