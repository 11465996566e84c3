//! Where the parts of a model are in a frame, and how they look there: matrices, light, levels of detail. All of it is
//! computed once per frame, outside of the closure that draws.

use super::camera::Camera;
use super::container::{AlphaMode, Material as MaterialItem, NONE, NONE_LONG, Part};
use super::determinant::is_mirrored;
use super::error::MemoryError;
use super::posed::PosedPart;
use super::read::{MATRIX_WORDS, Model, bounds_of};
use super::shader::{Light, PartSurface};
use super::transform::{Local, from_words};
use crate::light::Material;
use crate::math::{Affine, Projective, Vec3};
use crate::mesh::{Bounds, BoundsNode, view_depth};
use core::cmp::Reverse;
use embedded_graphics_core::pixelcolor::Rgb888;

/// A draw of a model in a frame: a part, its matrix and its surface. A frame's places are lent to
/// [`Model::place`] as `[None; N]`.
#[derive(Clone, Copy, Debug)]
pub struct Place<S> {
    pub(super) mvp: Projective,
    pub(super) surface: PartSurface<S>,
    pub(super) part: u16,
    /// Level of the texture.
    pub(super) level: u8,
    /// Set if the transform turns front faces round.
    pub(super) mirrored: bool,
    /// The node whose transform the part has, or [`NONE`].
    pub(super) node: u16,
    /// Depth of a blended part.
    depth: i64,
    /// Nodes of the part's clusters: the first, and their number. 0 if all of the part is drawn.
    pub(super) nodes: (u32, u16),
}

/// A model, or a pose of it, that is ready to be drawn: see [`Model::place`].
#[derive(Debug)]
pub struct Placed<'p, S> {
    pub(super) model: Model<'p>,
    /// The memory of the pose; empty without one.
    pub(super) pose: &'p [u32],
    /// Opaque draws, then blended ones from back to front.
    pub(super) places: &'p mut [Option<Place<S>>],
    pub(super) nodes: &'p [BoundsNode],
    /// The transforms to the world and to the eye, if the camera has an eye.
    pub(super) to_eye: Option<[Affine; 2]>,
}

impl<'a> Model<'a> {
    /// Places the model at rest in a frame: `world` takes it to the world, where the camera and the light are.
    ///
    /// Call it once per frame, outside of the closure that draws: it takes some 20,000 instructions per draw on a
    /// Cortex-M0+, and some 3,000 more for each node above that of the draw. A pose keeps the transforms of nodes
    /// instead, and so places deep trees in less time. The places are as many as the model's [`draws`](Self::draws).
    ///
    /// # Errors
    /// If there are fewer places than draws.
    pub fn place<'p, L: Light>(
        &'p self,
        world: &Affine,
        camera: &Camera,
        light: &L,
        places: &'p mut [Option<Place<L::Surface>>],
    ) -> Result<Placed<'p, L::Surface>, MemoryError> {
        self.place_pose(&[], world, camera, light, places)
    }

    /// Places a pose, or the model at rest if there are no words.
    pub(super) fn place_pose<'p, L: Light>(
        &self,
        pose: &'p [u32],
        world: &Affine,
        camera: &Camera,
        light: &L,
        places: &'p mut [Option<Place<L::Surface>>],
    ) -> Result<Placed<'p, L::Surface>, MemoryError>
    where
        'a: 'p,
    {
        let needed = self.header.draws as usize;
        let found = places.len();
        let Some(places) = places.get_mut(..needed) else { return Err(MemoryError::Places { found, needed }) };
        let mut placing = Placing { model: self, pose, world, camera, light, last: None };
        // Opaque parts from the front of the list on, blended ones from its end.
        let (mut first, mut end) = (0, needed);
        for (number, node) in self.nodes.iter().enumerate() {
            for part in node.first_part..node.first_part.saturating_add(node.parts) {
                let Some(place) = placing.place(number, part) else { continue };
                let blends = place.1;
                end -= usize::from(blends);
                if let Some(to) = places.get_mut(if blends { end } else { first }) {
                    *to = Some(place.0);
                }
                first += usize::from(!blends);
            }
        }
        if let Some(between) = places.get_mut(first..end) {
            between.fill(None);
        }
        // Parts of one depth in an order of their own, because the sort is not stable.
        let order = |place: &Place<L::Surface>| (Reverse(place.depth), place.node, place.part);
        sort_by_heap(places.get_mut(end..).unwrap_or_default(), |place| place.as_ref().map(order));
        let to_eye = if camera.has_eye() { Some([*world, camera.view]) } else { None };
        Ok(Placed { model: *self, pose, places, nodes: &[], to_eye })
    }

    /// Returns the box of a part as it is drawn.
    fn bounds_in(&self, pose: &[u32], number: u16) -> Bounds {
        match self.parts.get(usize::from(number)) {
            Some(part) => match PosedPart::of(pose, part) {
                Some(posed) => posed.bounds(),
                None => bounds_of(part.center, part.half),
            },
            None => bounds_of([0; 3], [0; 3]),
        }
    }

    /// Returns the transform of a node: that of the pose, if there is one.
    pub(super) fn transform(&self, pose: &[u32], node: usize) -> Affine {
        let words = pose.get(MATRIX_WORDS * node..).and_then(|rest| rest.first_chunk());
        words.map_or_else(|| self.at_rest(node), from_words)
    }

    /// Returns the transform of a node at rest: those of the nodes above it, one after the other.
    fn at_rest(&self, number: usize) -> Affine {
        let Some(mut node) = self.nodes.get(number) else { return Affine::IDENTITY };
        let mut transform = Local::of(node).matrix();
        // There is no node of the number NONE. A parent has a lower number, so this ends.
        while let Some(parent) = self.nodes.get(usize::from(node.parent)) {
            transform = Local::of(parent).matrix() * transform;
            node = parent;
        }
        transform
    }

    pub(super) fn material_of(&self, part: &Part) -> Option<&'a MaterialItem> {
        self.materials.get(usize::from(part.material))
    }
}

/// A frame that parts are placed in.
struct Placing<'f, 'm, L> {
    model: &'f Model<'m>,
    pose: &'f [u32],
    world: &'f Affine,
    camera: &'f Camera,
    light: &'f L,
    /// The node that was placed last, [`NONE`] for parts with a skin, with its transform and its matrix, and whether it
    /// is a mirror.
    last: Option<(usize, Affine, Projective, bool)>,
}

impl<L: Light> Placing<'_, '_, L> {
    /// Returns the draw of a part, and whether it is blended. `None` for a part without triangles, and for one whose
    /// alpha is below the cutoff everywhere.
    #[inline(never)]
    fn place(&mut self, node: usize, number: u16) -> Option<(Place<L::Surface>, bool)> {
        let model = self.model;
        let mut part = model.parts.get(usize::from(number))?;
        let posed = PosedPart::of(self.pose, part).is_some();
        // A skin has the transforms of its joints in its vertices.
        let node = if posed && part.skin != NONE { usize::from(NONE) } else { node };
        let (to_world, mvp, mirrored) = match self.last {
            Some((last, to_world, mvp, mirrored)) if last == node => (to_world, mvp, mirrored),
            _ => {
                let to_world = if node == usize::from(NONE) {
                    *self.world
                } else {
                    *self.world * model.transform(self.pose, node)
                };
                let mvp = self.camera.lens.compose_affine(&(self.camera.view * to_world));
                let mirrored = is_mirrored(&to_world);
                self.last = Some((node, to_world, mvp, mirrored));
                (to_world, mvp, mirrored)
            }
        };
        let mut number = number;
        let material = model.material_of(part)?;
        let texture = model.textures.get(usize::from(material.texture));
        let mut level = 0;
        if part.coarser != NONE || texture.is_some_and(|texture| texture.levels > 1) {
            let pixels = self.pixels_per_unit(&to_world, &mvp, &bounds_of(part.center, part.half));
            // 16.16 · 24.8: a pixel is 2²⁴.
            while let Some(coarser) = model.parts.get(usize::from(part.coarser)) {
                if u64::from(coarser.error).saturating_mul(pixels) > 1 << 24 {
                    break;
                }
                (number, part) = (part.coarser, coarser);
            }
            let mut texels = u64::from(part.texels_per_unit);
            while texels > pixels + pixels / 2 && level < 15 {
                (texels, level) = (texels >> 1, level + 1);
            }
        }
        if part.triangles == 0 {
            return None;
        }
        let material = model.material_of(part)?;
        // Without a texture, alpha is the same everywhere.
        let [.., alpha] = material.color;
        let masked = material.alpha_mode == AlphaMode::Mask as u8 && material.texture == NONE;
        if masked && alpha < material.cutoff {
            return None;
        }
        let blends = material.alpha_mode == AlphaMode::Blend as u8;
        let bounds = model.bounds_in(self.pose, number);
        let surface = self.surface(part, material, &to_world, &bounds);
        let (node, depth) = (node as u16, if blends { view_depth(&mvp, &bounds) } else { 0 });
        Some((Place { mvp, surface, part: number, level, mirrored, node, depth, nodes: (0, 0) }, blends))
    }

    /// Returns the number of pixels, 24.8, that a unit of a mesh takes in the middle of its box.
    fn pixels_per_unit(&self, to_world: &Affine, mvp: &Projective, bounds: &Bounds) -> u64 {
        let pixels = self.camera.pixels_per_unit(view_depth(mvp, bounds));
        let length = to_world.transform_vector(Vec3::X).length();
        (u64::from(pixels) * u64::from(length.to_bits().unsigned_abs())) >> 16
    }

    fn surface(&self, part: &Part, item: &MaterialItem, to_world: &Affine, bounds: &Bounds) -> PartSurface<L::Surface> {
        let [r, g, b, _] = item.color;
        let no_normals = part.first_normal == NONE_LONG && item.texture != NONE;
        if item.flags & MaterialItem::UNLIT != 0 || no_normals {
            return PartSurface::Unlit([r, g, b]);
        }
        let [sr, sg, sb] = item.specular;
        let mut material = Material::glossy(Rgb888::new(r, g, b), Rgb888::new(sr, sg, sb), item.shininess);
        if part.first_color != NONE_LONG {
            material = material.vertex_colors();
        }
        if item.flags & MaterialItem::DOUBLE_SIDED != 0 {
            material = material.two_sided();
        }
        PartSurface::Lit(self.light.on_material(&material, to_world, bounds))
    }
}

/// Sorts by a heap, in n log n comparisons at most. It adds 0.3 KB to a program; `sort_unstable_by_key` adds 5 KB.
fn sort_by_heap<T, K: Ord>(items: &mut [T], key: impl Fn(&T) -> K) {
    let length = items.len();
    // The upper steps make a heap, whose root is the greatest item. The lower ones take its root away.
    for step in (0..length + length / 2).rev() {
        let (mut node, end) = if step < length { (0, step) } else { (step - length, length) };
        if step < length {
            swap(items, 0, step);
        }
        let Some(heap) = items.get_mut(..end) else { return };
        loop {
            let child = 2 * node + 1;
            let key_at = |k: usize| heap.get(k).map(&key);
            let greater = child + usize::from(key_at(child + 1) > key_at(child));
            if key_at(greater) <= key_at(node) {
                break;
            }
            swap(heap, node, greater);
            node = greater;
        }
    }
}

fn swap<T>(items: &mut [T], a: usize, b: usize) {
    if let Ok([a, b]) = items.get_disjoint_mut([a, b]) {
        core::mem::swap(a, b);
    }
}

impl<S> Placed<'_, S> {
    /// Returns the matrices of the draws, from object space to clip space, with the numbers of their parts: for draws
    /// of one's own. Opaque draws come first, blended ones follow from back to front.
    pub fn draws(&self) -> impl Iterator<Item = (&Projective, usize)> {
        self.places.iter().flatten().map(|place| (&place.mvp, usize::from(place.part)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;

    #[test]
    fn heaps_sort_as_the_standard_library_does() {
        let mut rng = Rng::new(9);
        for length in 0..70 {
            for spread in [1, 3, 50, 1 << 40] {
                let mut items: std::vec::Vec<_> = (0..length).map(|_| rng.below(spread)).collect();
                let mut expected = items.clone();
                expected.sort_unstable_by_key(|item| Reverse(*item));
                sort_by_heap(&mut items, |item| Reverse(*item));
                assert_eq!(items, expected);
            }
        }
    }
}
