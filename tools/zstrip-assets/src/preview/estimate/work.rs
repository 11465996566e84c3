//! What there is to do in a frame: the library draws it by shaders that count their calls.

#[path = "../../../../../examples/costs/calls.rs"]
mod calls;

use super::super::turntable::Step;
use super::super::{PreviewError, Stage};
use super::costs::{DRAW, LARGE, SHADED, SMALL, STRIP, TERMS, TRIANGLE, VERTEX};
use calls::{BySize, Calls, LitTextureCalls};
use zstrip::embedded_graphics_core::pixelcolor::Gray8;
use zstrip::math::Projective;
use zstrip::mesh::Mesh;
use zstrip::model::container::{self, AlphaMode, NONE_LONG, Part, SectionKind, Texture, TextureFormat};
use zstrip::scene::{Cull, State, Winding};
use zstrip::target::Stats;

/// A material of the table of models.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Material {
    /// Colours of faces.
    Flat,
    /// Colours of vertices.
    Gouraud,
    /// Colours of vertices, blended.
    Blended,
    /// A texture of RGB565.
    Textured,
    /// A palette of 256 colours.
    Palette,
    /// A palette of up to 16 colours, with several texels in a byte.
    PackedPalette,
    /// A grey texture.
    Gray,
    /// A texture of one bit per texel, that is there or not.
    Masked,
    /// A texture of RGB565 with alpha, that is there or not.
    Cutout,
    /// A palette with alpha, that is there or not.
    CutoutPalette,
    /// A texture of RGB565 with alpha, blended.
    Glass,
    /// A palette with alpha, blended.
    GlassPalette,
}

impl Material {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::Flat,
        Self::Gouraud,
        Self::Blended,
        Self::Textured,
        Self::Palette,
        Self::PackedPalette,
        Self::Gray,
        Self::Masked,
        Self::Cutout,
        Self::CutoutPalette,
        Self::Glass,
        Self::GlassPalette,
    ];

    /// Returns the name in the table.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Gouraud => "gouraud",
            Self::Blended => "blended",
            Self::Textured => "textured",
            Self::Palette => "palette",
            Self::PackedPalette => "packed_palette",
            Self::Gray => "gray",
            Self::Masked => "masked",
            Self::Cutout => "cutout",
            Self::CutoutPalette => "cutout_palette",
            Self::Glass => "glass",
            Self::GlassPalette => "glass_palette",
        }
    }

    /// Returns the nearest material of the table of formats.
    pub const fn in_formats(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Gouraud => "gouraud",
            Self::Blended => "blended",
            _ => "lit_textured",
        }
    }

    /// Returns the words of varyings of a vertex in records.
    pub const fn words(self) -> usize {
        match self {
            Self::Flat => 0,
            Self::Gouraud | Self::Blended => 2,
            _ => 4,
        }
    }

    /// Returns the material of a texture's format and an alpha mode, and whether the table has that of another format.
    const fn of_texture(format: Option<TextureFormat>, mode: AlphaMode) -> (Self, bool) {
        match (mode, format) {
            (AlphaMode::Opaque, Some(TextureFormat::Rgb565)) => (Self::Textured, false),
            (AlphaMode::Opaque, Some(TextureFormat::Palette8)) => (Self::Palette, false),
            (AlphaMode::Opaque, Some(TextureFormat::Gray8)) => (Self::Gray, false),
            (AlphaMode::Opaque, Some(TextureFormat::Mask)) => (Self::PackedPalette, true),
            (AlphaMode::Opaque, _) => (Self::PackedPalette, false),
            (AlphaMode::Mask, Some(TextureFormat::Mask)) => (Self::Masked, false),
            (AlphaMode::Mask, Some(TextureFormat::Rgb565)) => (Self::Cutout, false),
            (AlphaMode::Mask, Some(TextureFormat::Palette8)) => (Self::CutoutPalette, false),
            (AlphaMode::Mask, _) => (Self::CutoutPalette, true),
            (AlphaMode::Blend, Some(TextureFormat::Rgb565)) => (Self::Glass, false),
            (AlphaMode::Blend, Some(TextureFormat::Palette8)) => (Self::GlassPalette, false),
            (AlphaMode::Blend, _) => (Self::GlassPalette, true),
        }
    }
}

/// The work of a draw.
#[derive(Clone, Copy, Debug)]
pub struct DrawWork {
    pub material: Material,
    /// In the order of the table's columns.
    pub terms: [f64; TERMS],
    /// Set if the tables do not have the material itself, but the one that is nearest to it.
    pub is_like: bool,
    /// Set if triangles of the frame are clipped, whose clipping the tables do not have.
    pub clips: bool,
}

/// A counter of a draw.
enum Counter<'u> {
    Plain(Calls),
    Textured(LitTextureCalls<'u>),
}

impl Counter<'_> {
    const fn calls(&self) -> &Calls {
        match self {
            Self::Plain(calls) => calls,
            Self::Textured(textured) => &textured.calls,
        }
    }
}

/// A draw as it is counted.
struct Counted<'d> {
    mesh: Mesh<'d>,
    mvp: Projective,
    state: State,
    material: Material,
    is_like: bool,
    texels: Option<u32>,
    uvs: &'d [[i32; 2]],
}

impl<'d> Counted<'d> {
    fn counter(&self) -> Counter<'d> {
        match self.texels {
            Some(side) => Counter::Textured(LitTextureCalls::new(side).with_uvs(self.uvs)),
            None => Counter::Plain(Calls::default()),
        }
    }
}

/// Counts the work of each draw of a frame.
pub fn count(stage: &Stage<'_>, step: &Step) -> Result<Vec<DrawWork>, PreviewError> {
    let parts = stage.items::<Part>(SectionKind::Parts);
    let uvs: Vec<_> = parts.iter().map(|part| uvs_of(stage, part)).collect();
    stage.posed(step, |placed, mesh_of| {
        let upright = determinant(&stage.table.camera.lens) > 0.0;
        let draws: Vec<_> = placed
            .draws()
            .filter_map(|(mvp, number)| {
                let (part, mesh) = (parts.get(number)?, mesh_of(number)?);
                Some(counted(stage, part, &uvs[number], mesh, *mvp, upright))
            })
            .collect();
        let all: Vec<_> = draws.iter().collect();
        // A triangle is set up once for each strip, so a single strip tells how many there are.
        let ((once, stats), (strips, _)) =
            (frame(stage, stage.panel.height, &all)?, frame(stage, stage.panel.rows, &all)?);
        let mut works = vec![];
        for ((draw, once), strips) in draws.iter().zip(&once).zip(&strips) {
            let is_seen = stats.culled == 0 || frame(stage, stage.panel.height, &[draw])?.1.culled == 0;
            let clips = stats.clipped > 0;
            works.push(DrawWork { clips, ..work(draw, once.calls(), strips.calls(), is_seen) });
        }
        Ok(works)
    })?
}

/// Draws a frame by shaders that count.
fn frame<'d>(stage: &Stage<'_>, rows: u32, draws: &[&Counted<'d>]) -> Result<(Vec<Counter<'d>>, Stats), PreviewError> {
    let counters: Vec<_> = draws.iter().map(|draw| draw.counter()).collect();
    let stats = stage.frame::<Gray8>(rows, &mut |_, _| {}, &mut |scene| {
        for (draw, counter) in draws.iter().zip(&counters) {
            let Counted { mesh, mvp, state, .. } = draw;
            match counter {
                Counter::Plain(calls) => scene.draw_with(*state, mesh, mvp, &BySize(calls)),
                Counter::Textured(calls) => scene.draw_with(*state, mesh, mvp, &BySize(calls)),
            }
        }
    })?;
    Ok((counters, stats))
}

fn counted<'d>(
    stage: &Stage<'_>,
    part: &Part,
    uvs: &'d [[i32; 2]],
    mesh: Mesh<'d>,
    mvp: Projective,
    upright: bool,
) -> Counted<'d> {
    let of = usize::from(part.material);
    let materials = stage.items::<container::Material>(SectionKind::Materials);
    let item = materials.get(of).copied().unwrap_or(zstrip::bytemuck::Zeroable::zeroed());
    let textures = stage.items::<Texture>(SectionKind::Textures);
    let texture = textures.get(usize::from(item.texture));
    let two_sided = item.flags & container::Material::DOUBLE_SIDED != 0;
    let front = if (determinant(&mvp) > 0.0) == upright { Winding::CounterClockwise } else { Winding::Clockwise };
    let mode = AlphaMode::of(item.alpha_mode).unwrap_or(AlphaMode::Opaque);
    let (material, is_like) = match texture {
        Some(texture) => Material::of_texture(TextureFormat::of(texture.format), mode),
        None if mode == AlphaMode::Blend => (Material::Blended, false),
        None if part.first_normal == NONE_LONG => (Material::Flat, false),
        None => (Material::Gouraud, false),
    };
    Counted {
        mesh,
        mvp,
        state: State { cull: if two_sided { Cull::None } else { Cull::Back }, front, ..State::DEFAULT },
        material,
        is_like,
        texels: texture.map(|texture| u32::from(texture.width.max(texture.height))),
        uvs,
    }
}

/// Returns the work of a draw. Its vertices and triangles are not looked at if its box is not seen.
fn work(draw: &Counted<'_>, once: &Calls, strips: &Calls, is_seen: bool) -> DrawWork {
    let mut terms = [0.0; TERMS];
    terms[DRAW] = 1.0;
    if is_seen {
        terms[VERTEX] = draw.mesh.vertex_count() as f64;
        terms[TRIANGLE] = draw.mesh.triangle_count() as f64;
    }
    for (at, counts) in [SMALL, LARGE].into_iter().zip(&strips.counts) {
        for (k, count) in counts.iter().enumerate() {
            terms[at + k] = count.get().into();
        }
    }
    let first: u32 = once.counts.iter().map(|counts| counts[0].get()).sum();
    let all = terms[SMALL] + terms[LARGE];
    if all > 0.0 {
        let first = f64::from(first).min(all);
        (terms[SMALL], terms[LARGE]) = (terms[SMALL] * first / all, terms[LARGE] * first / all);
        terms[STRIP] = all - first;
    }
    terms[SHADED] =
        if draw.material == Material::Flat { 0.0 } else { f64::from(strips.vertices.get()).min(terms[VERTEX]) };
    DrawWork { material: draw.material, terms, is_like: draw.is_like, clips: false }
}

/// Returns the texture coordinates of a part, 16.16, as the container's rules unpack them.
fn uvs_of(stage: &Stage<'_>, part: &Part) -> Vec<[i32; 2]> {
    if part.first_uv == NONE_LONG {
        return vec![[0; 2]; part.vertices as usize];
    }
    let (first, count) = (part.first_uv as usize, part.vertices as usize);
    let unpacked = |stored: [i32; 2]| {
        let [u, v] = stored.map(|c| c << (part.uv_shift & 15));
        [part.uv_offset[0].wrapping_add(u), part.uv_offset[1].wrapping_add(v)]
    };
    if part.uv_bits == 8 {
        let uvs = stage.items::<[u8; 2]>(SectionKind::SmallUvs);
        uvs.iter().skip(first).take(count).map(|uv| unpacked(uv.map(i32::from))).collect()
    } else {
        let uvs = stage.items::<[u16; 2]>(SectionKind::Uvs);
        uvs.iter().skip(first).take(count).map(|uv| unpacked(uv.map(i32::from))).collect()
    }
}

/// Returns the determinant of the upper left 3 × 3 and the last row: its sign tells whether the matrix is a mirror.
fn determinant(matrix: &Projective) -> f64 {
    let [x, y, _, w] = matrix.to_rows().map(|[x, y, z, _]| [x, y, z].map(|c| c as f64));
    let minor = |j: usize, k: usize| y[j] * w[k] - y[k] * w[j];
    x[0] * minor(1, 2) + x[1] * minor(2, 0) + x[2] * minor(0, 1)
}
