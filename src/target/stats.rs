//! Counters of every stage of a frame.

/// Counters of a frame. Work that is repeated for another band or strip is counted again. Counters wrap at 2³².
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
// The alignment makes the compiler clear the counters by the routine that it already links for 64-bit numbers.
#[repr(align(8))]
pub struct Stats {
    /// Calls of the closure that draws.
    pub walks: u32,
    /// Calls that were given up because the records were full, to be repeated for fewer strips.
    pub overflows: u32,
    /// Strips that were drawn without records.
    pub direct_strips: u32,
    /// Strips handed out.
    pub strips: u32,
    /// Draws that were processed.
    pub draws: u32,
    /// Draws, or nodes of a hierarchy, whose bounds are all outside of the view. Bounds of meshes of up to four
    /// vertices are not tested. With [`Renderer::with_occlusion`](crate::frame::Renderer::with_occlusion), also those
    /// that are hidden, once for each strip that they are left out of.
    pub culled: u32,
    /// Vertices shaded.
    pub vertices: u32,
    /// Triangles taken in.
    pub triangles: u32,
    /// Lines taken in, once for each strip.
    pub lines: u32,
    /// Points taken in, once for each strip.
    pub points: u32,
    /// Triangles culled by their winding.
    pub back_facing: u32,
    /// Triangles without area on the screen.
    pub degenerate: u32,
    /// Triangles that are all outside of the view, or of the strips at hand; lines outside of the view, and lines to be
    /// cut that are outside of the strip.
    pub outside: u32,
    /// Triangles that cover no pixel centre.
    pub empty: u32,
    /// Triangles and lines cut by the near or far plane or the guard band.
    pub clipped: u32,
    /// Triangles that went on to be drawn; a clipped one may become several.
    pub drawn: u32,
}
