//! The drawing of a model: the shader of each part is chosen, and an ordinary draw follows.

use super::container::{AlphaMode, Material, NONE_LONG, Part};
use super::place::{Place, Placed};
use super::posed::PosedPart;
use super::read::{Model, bounds_of, items};
use super::shader::{PackedSurface, PackedUvs, Unpacked, Uvs};
use super::texels::LevelTexels;
use crate::mesh::{Bounds, BoundsNode, Mesh, MeshData};
use crate::scene::{Cull, Scene, State, Winding};
use crate::shader::{Alpha, AlphaTest, Blend, Flat, Gouraud, Opacity, Surface, Textured};
use crate::span::{DepthState, Shader};
use crate::target::Framebuffer;

impl<S: Surface + Copy> Placed<'_, S> {
    /// Draws the model: opaque parts first, then blended ones from back to front.
    ///
    /// | part | shader |
    /// |---|---|
    /// | without texture and normals | [`Flat`] |
    /// | without texture | [`Gouraud`] |
    /// | with a texture | [`Textured::lit`] |
    /// | with [`AlphaMode::Mask`] | [`AlphaTest`] of that |
    /// | with [`AlphaMode::Blend`] | [`Blend`] of that by [`Alpha`], without texture by [`Opacity`] |
    ///
    /// Alpha is that of the texture times that of the material. [`AlphaMode::Opaque`] ignores both.
    ///
    /// A program links all of them, because the bytes of a model decide.
    /// [`draw_opaque`](Self::draw_opaque) links less.
    pub fn draw<F: Framebuffer>(&self, scene: &mut Scene<'_, F>) {
        for place in self.places.iter().flatten() {
            let Some(draw) = self.draw_of(place) else { continue };
            if draw.is_plain() {
                draw.opaque(scene);
            } else {
                draw.any(scene);
            }
        }
    }

    /// Draws the parts that are opaque and without texture, or with a texture of RGB565, and no others. A program that
    /// draws such models alone links only their shaders.
    pub fn draw_opaque<F: Framebuffer>(&self, scene: &mut Scene<'_, F>) {
        for place in self.places.iter().flatten() {
            if let Some(draw) = self.draw_of(place).filter(PartDraw::is_plain) {
                draw.opaque(scene);
            }
        }
    }

    /// Returns all that a draw takes.
    #[inline(never)]
    fn draw_of<'s>(&'s self, place: &'s Place<S>) -> Option<PartDraw<'s, S>> {
        let model = &self.model;
        let part = model.parts.get(usize::from(place.part))?;
        let material = model.materials.get(usize::from(part.material))?;
        let texels = match model.textures.get(usize::from(material.texture)) {
            Some(texture) => {
                let with_alpha = material.alpha_mode != AlphaMode::Opaque as u8;
                Some(model.level(texture, place.level, with_alpha)?)
            }
            None => None,
        };
        let (first, count) = place.nodes;
        let nodes = items(self.nodes, first, count.into());
        let mut data = model.mesh_data(part);
        let mut bounds = bounds_of(part.center, part.half);
        let posed = PosedPart::of(self.pose, part);
        if let Some(posed) = &posed {
            bounds = posed.bounds();
            data = MeshData { positions: posed.positions(), normals: posed.normals(), ..data };
        }
        let packed = if posed.is_some() || !part.has_normals() { NONE_LONG } else { part.first_normal };
        Some(PartDraw {
            place,
            material,
            texels,
            mesh: mesh(data, nodes, bounds, part),
            surface: PackedSurface { surface: place.surface, normals: some_items(model.normals, packed, part) },
            uvs: uvs(model, part),
            has_normals: part.has_normals(),
        })
    }
}

/// Makes a mesh of slices that were checked with the model.
fn mesh<'s>(data: MeshData<'s>, nodes: &'s [BoundsNode], bounds: Bounds, part: &Part) -> Mesh<'s> {
    let hierarchy = if nodes.is_empty() { None } else { Some(nodes) };
    Mesh::of_checked(MeshData { hierarchy, bounds: Some(bounds), ..data }, bounds, part.triangles as u16)
}

/// Returns an attribute of a part, if it has it.
fn some_items<'a, T>(all: &'a [T], first: u32, part: &Part) -> Option<&'a [T]> {
    (first != NONE_LONG).then(|| items(all, first, part.vertices as usize))
}

/// Returns the packed texture coordinates of a part.
fn uvs<'a>(model: &Model<'a>, part: &Part) -> PackedUvs<'a> {
    let uvs = if part.uv_bits == 8 {
        some_items(model.small_uvs, part.first_uv, part).map(Uvs::Bytes)
    } else {
        some_items(model.uvs, part.first_uv, part).map(Uvs::Short)
    };
    PackedUvs { uvs: uvs.unwrap_or(Uvs::None), offset: part.uv_offset, shift: part.uv_shift }
}

/// A draw of a part: its mesh, and what its shader is made of.
struct PartDraw<'s, S> {
    place: &'s Place<S>,
    material: &'s Material,
    texels: Option<LevelTexels<'s>>,
    mesh: Mesh<'s>,
    surface: PackedSurface<'s, S>,
    uvs: PackedUvs<'s>,
    has_normals: bool,
}

impl<S: Surface + Copy> PartDraw<'_, S> {
    /// Returns whether the draw is opaque and without texture, or with one of RGB565.
    fn is_plain(&self) -> bool {
        let masked = self.material.alpha_mode == AlphaMode::Mask as u8 && self.texels.is_some();
        self.material.alpha_mode != AlphaMode::Blend as u8
            && !masked
            && matches!(self.texels, None | Some(LevelTexels::Rgb565(_)))
    }

    /// Returns the state of the draw: constant, but for the faces that it leaves out.
    #[inline(always)]
    fn state(&self, depth: DepthState) -> State {
        let cull = if self.material.flags & Material::DOUBLE_SIDED != 0 { Cull::None } else { Cull::Back };
        let front = if self.place.mirrored { Winding::Clockwise } else { Winding::CounterClockwise };
        State { cull, front, depth, ..State::DEFAULT }
    }

    #[inline(always)]
    fn by<F: Framebuffer, T: Shader<F::Format>>(&self, scene: &mut Scene<'_, F>, depth: DepthState, shader: T) {
        scene.draw_clusters(self.state(depth), &self.mesh, &self.place.mvp, &shader);
    }

    /// Returns a textured shader on the part's texture coordinates.
    #[inline(always)]
    fn unpacked<T>(&self, shader: T) -> Unpacked<'_, T> {
        Unpacked { shader, uvs: self.uvs }
    }

    #[inline(never)]
    fn opaque<F: Framebuffer>(&self, scene: &mut Scene<'_, F>) {
        let surface = self.surface;
        match &self.texels {
            Some(LevelTexels::Rgb565(texels)) => {
                self.by(scene, DepthState::LESS, self.unpacked(Textured::new(texels).lit(surface)));
            }
            _ if self.has_normals => self.by(scene, DepthState::LESS, Gouraud::new(surface)),
            _ => self.by(scene, DepthState::LESS, Flat::new(surface)),
        }
    }

    #[inline(never)]
    fn any<F: Framebuffer>(&self, scene: &mut Scene<'_, F>) {
        let surface = self.surface;
        let [.., opacity] = self.material.color;
        let mode = AlphaMode::of(self.material.alpha_mode);
        match &self.texels {
            Some(texels) => {
                let texels = texels.any(if mode == Some(AlphaMode::Opaque) { None } else { Some(opacity) });
                let shader = self.unpacked(Textured::new(&texels).lit(surface));
                match mode {
                    Some(AlphaMode::Mask) => {
                        self.by(scene, DepthState::LESS, AlphaTest::new(shader, self.material.cutoff));
                    }
                    Some(AlphaMode::Blend) => self.by(scene, DepthState::TEST, Blend::new(shader, Alpha)),
                    _ => self.by(scene, DepthState::LESS, shader),
                }
            }
            None if self.has_normals => {
                self.by(scene, DepthState::TEST, Blend::new(Gouraud::new(surface), Opacity(opacity)));
            }
            None => self.by(scene, DepthState::TEST, Blend::new(Flat::new(surface), Opacity(opacity))),
        }
    }
}
