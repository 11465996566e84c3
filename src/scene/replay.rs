//! Triangles from the records → stages 8 to 11 of [the pipeline](crate#the-pipeline). They come in with the numbers of
//! their vertices; small ones are drawn from the words that the vertex stage left, large ones by the painter.

use super::painter::{Painter, RasterHooks};
use super::scan::BoxTest;
use super::scene::{Scene, Target};
use super::small_rows::{Raw, SmallRows};
use super::state::State;
use crate::raster::PixelRect;
use crate::span::{BiasSteps, DepthTest, LeftState, Shader, SmallResult, SmallTarget, SmallTriangle, face_of, goes_on};
use crate::target::{DrawTriangles, Framebuffer, TriangleRecord, Triangles};
use crate::vertex::{MAX_IN_REGISTERS, PackedCorners, PackedVertex, ScreenVertex, Varyings, VertexShader};

/// Draws triangles from the records with a shader.
pub(super) trait RecordDrawer<F: Framebuffer> {
    /// Returns whether any triangle may be small.
    fn fits(&self) -> bool;

    /// Draws a triangle, if it is small.
    fn small(
        &mut self,
        target: &mut SmallTarget<'_, Raw<F>>,
        triangles: &Triangles<'_>,
        record: &TriangleRecord,
        v: [&[u32; 2]; 3],
    ) -> SmallResult;

    /// Goes on with a small triangle from the strip above.
    fn go_on(&mut self, target: &mut SmallTarget<'_, Raw<F>>, state: &mut [u32]);

    /// Draws a triangle with these vertices. `refused` says that [`small`](Self::small) has just found it to be large.
    fn single(
        &mut self,
        place: Place<'_, '_, F>,
        triangles: &Triangles<'_>,
        record: &TriangleRecord,
        v: &[ScreenVertex; 3],
        refused: bool,
    );
}

/// A place that triangles are drawn to: its pixels, the size of the screen, and the pixels that may be drawn.
pub(super) type Place<'p, 't, F> = (&'p mut Target<'t, F>, (u16, u16), &'p PixelRect);

/// The [`RecordDrawer`] of a shader under a depth test.
pub(super) struct ShaderDrawer<'p, F: Framebuffer, S: Shader<F::Format>, D> {
    pub(super) state: &'p State,
    pub(super) hooks: &'p RasterHooks<F, S>,
    pub(super) shader: &'p S,
    pub(super) test: D,
    pub(super) varyings: [S::Varyings; 3],
}

impl<F: Framebuffer, S: Shader<F::Format>, D: DepthTest> RecordDrawer<F> for ShaderDrawer<'_, F, S, D> {
    fn fits(&self) -> bool {
        fits::<F, S>()
    }

    fn small(
        &mut self,
        target: &mut SmallTarget<'_, Raw<F>>,
        triangles: &Triangles<'_>,
        record: &TriangleRecord,
        v: [&[u32; 2]; 3],
    ) -> SmallResult {
        let triangle = SmallTriangle { target, v, state: None, test: self.test };
        if S::PACKS_SMALL {
            self.shader.small_packed(triangle, &triangles.packed_corners::<S>(record.corners))
        } else if fits::<F, S>() {
            load::<S>(triangles, record, &mut self.varyings);
            self.shader.small(triangle, &self.varyings, record.face)
        } else {
            SmallResult::Large
        }
    }

    fn go_on(&mut self, target: &mut SmallTarget<'_, Raw<F>>, state: &mut [u32]) {
        let face = face_of(state);
        let v = [&PackedVertex::NONE_WORDS; 3];
        let triangle = SmallTriangle { target, v, state: Some(state), test: self.test };
        if S::PACKS_SMALL {
            self.shader.small_packed(triangle, &PackedCorners::NONE);
        } else if fits::<F, S>() {
            self.shader.small(triangle, &self.varyings, face);
        }
    }

    fn single(
        &mut self,
        (target, screen, clip): Place<'_, '_, F>,
        triangles: &Triangles<'_>,
        record: &TriangleRecord,
        v: &[ScreenVertex; 3],
        refused: bool,
    ) {
        if !refused || S::PACKS_SMALL {
            load_outlined::<S>(triangles, record, &mut self.varyings);
        }
        let Self { state, hooks, shader, .. } = *self;
        Painter { target, screen, clip, state, hooks, shader }.turned(v, &self.varyings, record.face, refused);
    }
}

/// Returns whether triangles of a shader may be small. With more varyings, or perspective-correct ones, those take far
/// longer than the rest of a triangle does, unless the shader is tolerant or has a way of its own.
pub(super) const fn fits<F: Framebuffer, S: Shader<F::Format>>() -> bool {
    let is_planar = S::IS_TOLERANT && S::Varyings::PERSPECTIVE > 0 && size_of::<S::Setup>() == 0;
    S::PACKS_SMALL || is_planar || S::Varyings::LEN <= MAX_IN_REGISTERS && S::Varyings::PERSPECTIVE == 0
}

/// Reads the varyings of a recorded triangle, out of line.
#[inline(never)]
fn load_outlined<S: VertexShader>(triangles: &Triangles<'_>, record: &TriangleRecord, to: &mut [S::Varyings; 3]) {
    for (to, index) in to.iter_mut().zip(&record.corners) {
        triangles.varyings::<S>(*index, to);
    }
}

/// Reads the varyings of a recorded triangle. In place, because arrays of varyings would be copied when they are
/// returned.
#[inline(always)]
fn load<S: VertexShader>(triangles: &Triangles<'_>, record: &TriangleRecord, [a, b, c]: &mut [S::Varyings; 3]) {
    let [i, j, k] = record.corners;
    triangles.varyings::<S>(i, a);
    triangles.varyings::<S>(j, b);
    triangles.varyings::<S>(k, c);
}

/// Draws the small ones of the triangles that it is handed.
struct SmallDrawer<'p, 't, 'd, F: Framebuffer> {
    place: &'p mut Option<SmallTarget<'t, Raw<F>>>,
    drawer: &'p mut (dyn RecordDrawer<F> + 'd),
}

impl<F: Framebuffer> DrawTriangles for SmallDrawer<'_, '_, '_, F> {
    const CARRIES: bool = F::CARRIES;

    #[inline(always)]
    fn draw(&mut self, triangles: &Triangles<'_>, record: &TriangleRecord, v: [&[u32; 2]; 3]) -> SmallResult {
        match self.place {
            Some(place) => self.drawer.small(place, triangles, record, v),
            None => SmallResult::Large,
        }
    }

    #[inline(always)]
    fn take_state(&mut self) -> &[u32] {
        match self.place.as_mut().and_then(|place| place.state.as_mut()) {
            Some(left) => left.words.get(..core::mem::take(&mut left.length)).unwrap_or_default(),
            None => &[],
        }
    }

    #[inline(always)]
    fn go_on(&mut self, state: &mut [u32]) -> Option<bool> {
        let place = self.place.as_mut().filter(|place| place.state.is_some())?;
        self.drawer.go_on(place, state);
        Some(goes_on(state))
    }
}

impl<F: Framebuffer> Scene<'_, F> {
    /// Draws triangles of this draw in the current strip: stages 8 to 11. These are the recorded ones of the strip, or
    /// those that wait to be drawn at once, which are taken out of the records. This code is compiled once, for all
    /// shaders.
    #[inline(never)]
    pub(super) fn replay(
        &mut self,
        state: &State,
        bias: Option<BiasSteps>,
        waiting: bool,
        drawer: &mut dyn RecordDrawer<F>,
    ) {
        if F::OCCLUDES && !waiting && self.records.has_triangles() && self.hides_recorded(state) {
            let end = Triangles::end_of(self.target.rows.end, F::SAMPLES);
            return if F::CARRIES {
                self.records.triangles().skip_each::<true>(end);
            } else {
                self.records.triangles().skip_each::<false>(end);
            };
        }
        let clip = &self.clip_rect(&self.target.rows);
        let (target, screen) = (&mut self.target, self.screen);
        let rows = &SmallRows::new(screen, clip, state, bias.map(|bias| (bias, state.bias)));
        let mut triangles = self.records.triangles();
        let mut test = BoxTest::new(clip);
        let mut record = TriangleRecord::default();
        if waiting {
            triangles.begin_waiting();
        }
        loop {
            let left_out = if waiting { Some(&mut test.left_out) } else { None };
            let (found, refused) = small_ones(target, rows, &mut triangles, &mut record, left_out, drawer);
            if !found {
                break;
            }
            if !waiting || test.first_row::<F>(triangles.positions_of(record.corners)).is_some() {
                large_one((target, screen, clip), &triangles, &record, refused, drawer);
            }
        }
        if waiting {
            test.finish(self.stats, triangles.count().into());
            triangles.clear();
        }
    }
}

/// Draws small triangles until one is large, and leaves that one in `record`. Without `left_out`, these are the
/// recorded triangles of the strip. With `left_out`, these are the triangles that wait to be drawn at once, and it
/// counts those that are empty and those that are outside. Returns whether there is a large one, and whether it was
/// tried as a small one.
///
/// Out of line, so that its stack is free again when the large one is drawn.
#[inline(never)]
fn small_ones<F: Framebuffer>(
    target: &mut Target<'_, F>,
    rows: &SmallRows<'_>,
    triangles: &mut Triangles<'_>,
    record: &mut TriangleRecord,
    left_out: Option<&mut [u32; 2]>,
    drawer: &mut dyn RecordDrawer<F>,
) -> (bool, bool) {
    let end = Triangles::end_of(target.rows.end, F::SAMPLES);
    // States are carried on if the rows of the next strip follow those that are drawn here.
    let carries = F::CARRIES && left_out.is_none() && rows.end() == target.rows.end;
    let mut state = LeftState::NONE;
    let state = if carries { Some(&mut state) } else { None };
    let mut place = if drawer.fits() { rows.place(target, None, state) } else { None };
    let refused = place.is_some();
    let draw = &mut SmallDrawer { place: &mut place, drawer };
    let found = match left_out {
        Some(left_out) => triangles.waiting_each(record, left_out, draw),
        None => triangles.replay_each(end, record, draw),
    };
    (found, refused)
}

/// Draws a triangle that [`small_ones`] has not drawn; `refused` says whether it was tried there. Out of line, so that
/// its stack is not below small ones.
#[inline(never)]
fn large_one<F: Framebuffer>(
    place: Place<'_, '_, F>,
    triangles: &Triangles<'_>,
    record: &TriangleRecord,
    refused: bool,
    drawer: &mut dyn RecordDrawer<F>,
) {
    let mut v = [ScreenVertex::new(0, 0, 0); 3];
    triangles.vertices_of(record, &mut v);
    drawer.single(place, triangles, record, &v, refused);
}
