//! The one place that calls every stage, in order: here the frame's calls, in `assembly` stages 2 to 7 (2 and 5 to 7 in `scan`, for
//! all shaders alike), in `triangle` the rest; `lines` and `stroke` do the same for lines and points, `canvas` for what is given
//! on the screen.
//!
//! A frame is drawn by a closure that calls [`Scene::draw`]. The closure runs in one of three phases: it *records* a band
//! of strips (stages 1 to 7), it *replays* the records of one strip (stages 8 to 11), or, where the records are too
//! small even for one strip, it draws that strip *directly* (all stages at once).

mod assembly;
mod canvas;
mod lines;
mod overlay;
mod scan;
mod stroke;
mod triangle;

use crate::fragment::{DepthBias, DepthState, Shader};
use crate::geometry::{
    Bounds, BoundsNode, DepthRange, DepthScale, MAX_DISTANCES, Mesh, Positions, Transform, Varyings, View, Viewport,
};
use crate::math::Projective;
use crate::output::{Framebuffer, Records, Stats, StripRows, TriangleRecord, Triangles, VERTEX_WORDS};
use crate::raster::PixelRect;
use assembly::Assembly;
pub use canvas::{Canvas, ScreenPoint};
use core::ops::Range;
pub use stroke::{Dashed, Smooth, Stroke, Thick, Thin};
use triangle::{Chosen, Painter};

/// Which faces are not drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Cull {
    /// Those that show their back.
    #[default]
    Back,
    /// Those that show their front.
    Front,
    /// Every face is drawn.
    None,
}

/// Which way the corners of a front face go round on the screen, with y up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Winding {
    /// Against the clock.
    #[default]
    CounterClockwise,
    /// With the clock: for meshes made that way, and for mirrored models.
    Clockwise,
}

/// How a draw is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct State {
    /// Which faces are left out.
    pub cull: Cull,
    /// Which faces are front faces.
    pub front: Winding,
    /// The depth test.
    pub depth: DepthState,
    /// What happens before the near and beyond the far plane.
    pub range: DepthRange,
    /// What is added to depth.
    pub bias: DepthBias,
    /// How depth grows with distance.
    pub depth_scale: DepthScale,
}

impl State {
    /// The default, for constants: back faces culled, nearer fragments win, clipped at the near and the far plane.
    pub const DEFAULT: Self = Self {
        cull: Cull::Back,
        front: Winding::CounterClockwise,
        depth: DepthState::LESS,
        range: DepthRange::Clip,
        bias: DepthBias::NONE,
        depth_scale: DepthScale::Perspective,
    };
}

/// What the closure's calls do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Phase {
    Record,
    Replay,
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

/// What a frame is drawn through; see [`Renderer::frame`](crate::Renderer::frame).
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

/// Vertices of a mesh up to which it is not worth a test of its bounds.
const FEW_VERTICES: usize = 4;

impl<'a, F: Framebuffer> Scene<'a, F> {
    /// Draws a mesh: back faces culled, nearer fragments win, clipped at the near and the far plane.
    ///
    /// `mvp` takes object space to clip space: camera · view · model.
    pub fn draw<S: Shader<F::Format>>(&mut self, mesh: &Mesh<'_>, mvp: &Projective, shader: &S) {
        self.draw_by(&State::DEFAULT, &const { Chosen::DEFAULT }, mesh, mvp, shader);
    }

    /// Draws a mesh by other rules.
    ///
    /// A program links the loops for the depth tests that may be asked for: where the state is a constant, its own.
    #[inline]
    pub fn draw_with<S: Shader<F::Format>>(&mut self, state: State, mesh: &Mesh<'_>, mvp: &Projective, shader: &S) {
        self.draw_by(&state, &Chosen::of(&state), mesh, mvp, shader);
    }

    // In its caller: a call less that is on the stack of everything below.
    #[inline(always)]
    fn draw_by<S: Shader<F::Format>>(
        &mut self,
        state: &State,
        chosen: &Chosen<F, S>,
        mesh: &Mesh<'_>,
        mvp: &Projective,
        shader: &S,
    ) {
        const {
            assert!(S::WORDS <= <S::Varyings as Varyings>::LEN, "a vertex needs no more words than varyings");
            assert!(S::WORDS <= 253, "a vertex has at most 253 words of varyings");
            assert!(S::ZERO_BITS == 0 || S::Varyings::PERSPECTIVE == 0, "perspective takes all bits of varyings");
            assert!(S::CLIP_DISTANCES + S::CULL_DISTANCES <= MAX_DISTANCES, "at most 4 clip and cull distances");
            assert!(S::ZERO_BITS <= 16, "at most 16 bits of varyings are known to be zero");
        };
        let stride = S::WORDS + VERTEX_WORDS;
        if F::RECORDS && self.phase == Phase::Replay {
            let print = fingerprint(state, mesh, mvp, &self.viewport, stride);
            if self.find_draw(print, mesh.vertex_count(), stride) {
                self.replay(state, chosen, shader);
            }
        } else {
            self.assemble(state, chosen, mesh, mvp, shader, stride);
        }
    }

    /// Records a draw, or draws it directly.
    #[inline(never)]
    fn assemble<S: Shader<F::Format>>(
        &mut self,
        state: &State,
        chosen: &Chosen<F, S>,
        mesh: &Mesh<'_>,
        mvp: &Projective,
        shader: &S,
        stride: usize,
    ) {
        // 1. Culling of whole meshes.
        let mut transform = Transform::default();
        if self.begin_draw(state, mesh, mvp, stride, S::DISPLACES, &mut transform) {
            if let Some(scale) = chosen.depth_scale {
                scale(&mut transform, state.depth_scale);
            }
            let clip = self.clip_rect(&self.band);
            let culling = state.culling();
            let mut assembly =
                Assembly { scene: self, state, chosen, mesh, shader, transform: &transform, culling, clip };
            match mesh.data().hierarchy {
                Some(nodes) if !S::DISPLACES => assembly.parts(nodes, mvp),
                _ => {
                    if F::RECORDS {
                        assembly.shade_all();
                    }
                    assembly.triangles(0..mesh.triangle_count());
                }
            }
            self.end_draw();
        }
    }

    /// Whether something with these bounds may be seen in the part of the screen that is being drawn; what is not can be
    /// left out, with everything inside of it: a hierarchy of objects.
    ///
    /// The answer is the same in all calls of the closure that must draw the same. It counts near and far plane as borders,
    /// whatever [`State::range`] says of what lies beyond them.
    #[inline(never)]
    pub fn is_visible(&self, bounds: &Bounds, mvp: &Projective) -> bool {
        let mut view = View::EMPTY;
        view.fold(mvp, &self.viewport);
        self.sees(&view, bounds, DepthRange::Clip)
    }

    /// Maps clip space to a part of the screen from here on; nothing outside of it is touched. Each call of the closure
    /// starts with the whole screen.
    pub const fn set_viewport(&mut self, viewport: Viewport) {
        self.viewport = viewport;
    }

    /// Width and height of the screen.
    pub const fn screen(&self) -> (u16, u16) {
        self.screen
    }

    /// The pixels that may be drawn, in `rows` of the screen.
    #[inline(never)]
    fn clip_rect(&self, rows: &Range<i32>) -> PixelRect {
        let (x, y) = (i32::from(self.viewport.x()), i32::from(self.viewport.y()));
        let viewport =
            PixelRect { x: x..x + i32::from(self.viewport.width()), y: y..y + i32::from(self.viewport.height()) };
        viewport.intersection(&PixelRect { x: 0..i32::from(self.screen.0), y: rows.clone() })
    }

    /// Whether something may be seen in the band.
    fn sees(&self, view: &View, bounds: &Bounds, range: DepthRange) -> bool {
        let rect = self.clip_rect(&self.band);
        view.sees(&bounds.aabb, &rect.x, &rect.y, range.clamped())
    }

    /// Which of 32 nodes of a hierarchy can be seen, from `next` on, a bit each, the lowest for the first; `next` moves on behind
    /// them. In a function of its own, so that what it takes has left the stack when they are drawn.
    #[inline(never)]
    fn visible_nodes(&mut self, state: &State, nodes: &[BoundsNode], mvp: &Projective, next: &mut usize) -> u32 {
        let mut view = View::EMPTY;
        view.fold(mvp, &self.viewport);
        let (first, mut visible) = (*next, 0);
        while let (Some(node), Some(bit)) = (nodes.get(*next), 1_u32.checked_shl((*next - first) as u32)) {
            if self.sees(&view, &node.bounds, state.range) {
                visible |= bit;
                *next += 1;
            } else {
                self.stats.culled = self.stats.culled.wrapping_add(1);
                *next = usize::from(node.skip);
            }
        }
        visible
    }

    /// Starts recording a draw, or drawing it directly: makes the vertex transform, if there is anything to do.
    #[inline(never)]
    fn begin_draw(
        &mut self,
        state: &State,
        mesh: &Mesh<'_>,
        mvp: &Projective,
        stride: usize,
        displaced: bool,
        transform: &mut Transform,
    ) -> bool {
        self.count_draw();
        let recording = self.is_recording();
        if self.overflowed() {
            return false;
        }
        let mut view = View::EMPTY;
        view.fold(mvp, &self.viewport);
        // A test takes as long as a few vertices do.
        let bounded = mesh.vertex_count() > FEW_VERTICES
            && !displaced
            && !matches!(mesh.data().positions, Positions::Homogeneous(_));
        let culled = bounded && !self.sees(&view, mesh.bounds(), state.range);
        if recording {
            // What is out of view leaves a header without vertices.
            let vertices = if culled { 0 } else { mesh.vertex_count() };
            self.records.begin_draw(fingerprint(state, mesh, mvp, &self.viewport, stride), vertices, stride);
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
            self.records.begin_direct(mesh.vertex_count(), stride);
        }
        transform.fold(&view, mesh, displaced);
        true
    }

    fn end_draw(&mut self) {
        if self.is_recording() {
            self.records.end_draw();
        }
    }

    fn is_recording(&self) -> bool {
        F::RECORDS && self.phase == Phase::Record
    }

    /// Whether the records are full, so that a walk is in vain.
    pub(crate) fn overflowed(&self) -> bool {
        F::RECORDS && self.records.overflowed()
    }

    /// Whether there is a place for each vertex of the current draw.
    fn has_vertices(&self) -> bool {
        F::RECORDS && self.records.has_vertices()
    }

    /// Finds the records of a draw; `false` if they are not those of this one.
    #[inline(never)]
    fn find_draw(&mut self, print: u32, vertices: usize, stride: usize) -> bool {
        let draw = self.count_draw();
        let found = self.changed.is_none() && self.records.replay_draw(print, vertices, stride);
        if !found {
            self.changed = self.changed.or(Some(draw));
        }
        found
    }

    fn count_draw(&mut self) -> u16 {
        let draw = self.draws;
        self.draws = draw.saturating_add(1);
        self.stats.draws = self.stats.draws.wrapping_add(1);
        draw
    }

    /// Draws the recorded triangles of this draw in the current strip.
    #[inline(never)]
    fn replay<S: Shader<F::Format>>(&mut self, state: &State, chosen: &Chosen<F, S>, shader: &S) {
        let end = Triangles::end_of(self.target.rows.end);
        let clip = &self.clip_rect(&self.target.rows);
        let last = self.records.last_triangle();
        let mut triangles = self.records.triangles();
        let mut painter = Painter { target: &mut self.target, screen: self.screen, clip, state, chosen, shader };
        let mut triangle = TriangleRecord::default();
        let mut varyings = [S::Varyings::ZERO; 3];
        while triangles.replay(last, end, &mut triangle) {
            let [i, j, k] = triangle.corners();
            // In place: arrays of them are copied.
            let [a, b, c] = &mut varyings;
            triangles.varyings::<S>(i, a);
            triangles.varyings::<S>(j, b);
            triangles.varyings::<S>(k, c);
            painter.triangle(&triangle.v, &mut varyings, triangle.face);
        }
    }

    /// What to draw triangles with, in the phases that draw.
    fn painter<'p, S: Shader<F::Format>>(
        &'p mut self,
        clip: &'p PixelRect,
        state: &'p State,
        chosen: &'p Chosen<F, S>,
        shader: &'p S,
    ) -> Painter<'p, 'a, F, S> {
        Painter { target: &mut self.target, screen: self.screen, clip, state, chosen, shader }
    }
}

/// A word that differs, almost surely, between draws that would not leave the same records.
#[inline(never)]
fn fingerprint(state: &State, mesh: &Mesh<'_>, mvp: &Projective, viewport: &Viewport, stride: usize) -> u32 {
    let ([ax, ay, az], [bx, by, bz]) = (mesh.bounds().aabb.center.to_bits(), mesh.bounds().aabb.half.to_bits());
    let rest = [
        viewport.x() as u32 ^ (viewport.y() as u32) << 16,
        u32::from(viewport.width()) | u32::from(viewport.height()) << 16,
        mesh.vertex_count() as u32 | (mesh.triangle_count() as u32) << 16,
        ax as u32,
        ay as u32,
        az as u32,
        bx as u32,
        by as u32,
        bz as u32,
        stride as u32 | (state.cull as u32) << 16 | (state.range as u32) << 20 | (state.front as u32) << 24,
        state.depth.compare as u32 | u32::from(state.depth.write) << 8 | (state.bias.constant as u32) << 16,
        state.bias.slope.to_bits() as u32,
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
