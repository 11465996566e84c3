//! Where the parts of a model are in a frame, and how they look there: matrices, light, levels of detail. All of it is
//! computed once per frame, outside of the closure that draws.

use super::camera::Camera;
use super::container::{AlphaMode, Cluster, Material as MaterialItem, NONE, NONE_LONG, Part};
use super::error::MemoryError;
use super::posed::PosedPart;
use super::read::{MATRIX_WORDS, Model, bounds_of};
use super::shader::{Light, PartSurface};
use super::transform::{Local, from_words};
use crate::light::Material;
use crate::math::{Affine, Projective, Vec3};
use crate::mesh::{Bounds, BoundsNode, sort_back_to_front, view_depth};
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
    /// The eye in object space, for parts with clusters and a camera with perspective.
    pub(super) eye: Option<Vec3>,
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
}

impl<'a> Model<'a> {
    /// Places the model at rest in a frame: `world` takes it to the world, where the camera and the light are.
    ///
    /// Call it once per frame, outside of the closure that draws: it takes some thousand instructions per draw. The
    /// places are as many as the model's [`draws`](Self::draws).
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
        let depth = |place: &Option<Place<L::Surface>>| match place {
            Some(place) => view_depth(&place.mvp, &self.bounds_in(pose, place.part)),
            None => i64::MAX,
        };
        sort_back_to_front(places.get_mut(end..).unwrap_or_default(), depth);
        Ok(Placed { model: *self, pose, places, nodes: &[] })
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

    /// Returns the transform of a node at rest: those of the nodes above it, one after the other.
    fn at_rest(&self, number: usize) -> Affine {
        let mut transform = Affine::IDENTITY;
        let mut next = self.nodes.get(number);
        // A parent has a lower number, so this ends.
        while let Some(node) = next {
            transform = Local::of(node).matrix() * transform;
            next = if node.parent == NONE { None } else { self.nodes.get(usize::from(node.parent)) };
        }
        transform
    }

    fn material_of(&self, part: &Part) -> Option<&'a MaterialItem> {
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
    /// The node that was placed last, [`NONE`] for parts with a skin, with its transform and its matrix.
    last: Option<(usize, Affine, Projective)>,
}

impl<L: Light> Placing<'_, '_, L> {
    /// Returns the draw of a part, and whether it is blended. `None` for a part without triangles.
    #[inline(never)]
    fn place(&mut self, node: usize, number: u16) -> Option<(Place<L::Surface>, bool)> {
        let model = self.model;
        let mut part = model.parts.get(usize::from(number))?;
        let posed = PosedPart::of(self.pose, part).is_some();
        // A skin has the transforms of its joints in its vertices.
        let node = if posed && part.skin != NONE { usize::from(NONE) } else { node };
        let (to_world, mvp) = match self.last {
            Some((last, to_world, mvp)) if last == node => (to_world, mvp),
            _ => {
                let to_world = if node == usize::from(NONE) { *self.world } else { *self.world * self.transform(node) };
                let mvp = self.camera.lens.compose_affine(&(self.camera.view * to_world));
                self.last = Some((node, to_world, mvp));
                (to_world, mvp)
            }
        };
        let mut number = number;
        let material = model.material_of(part)?;
        let texture = model.textures.get(usize::from(material.texture));
        let mut level = 0;
        if part.coarser != NONE || texture.is_some_and(|texture| texture.levels > 1) {
            let pixels = self.pixels_per_unit(&to_world, &bounds_of(part.center, part.half));
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
        let blends = material.alpha_mode == AlphaMode::Blend as u8;
        let bounds = model.bounds_in(self.pose, number);
        let perspective = !matches!(self.camera.lens.to_rows(), [.., [0, 0, 0, _]]);
        let eye = if part.clusters > 0 && perspective {
            (self.camera.view * to_world).inverse().map(|back| back.transform_point(Vec3::ZERO))
        } else {
            None
        };
        let surface = self.surface(part, material, &to_world, &bounds);
        let mirrored = is_mirrored(&to_world);
        Some((Place { mvp, surface, part: number, level, mirrored, eye, nodes: (0, 0) }, blends))
    }

    /// Returns the transform of a node: that of the pose, if there is one.
    fn transform(&self, node: usize) -> Affine {
        let words = self.pose.get(MATRIX_WORDS * node..).and_then(|rest| rest.first_chunk());
        words.map_or_else(|| self.model.at_rest(node), from_words)
    }

    /// Returns the number of pixels, 24.8, that a unit of a mesh takes in the middle of its box.
    fn pixels_per_unit(&self, to_world: &Affine, bounds: &Bounds) -> u64 {
        let pixels = self.camera.pixels_per_unit(to_world.transform_point(bounds.center));
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

/// Returns whether a transform is a mirror: its determinant is negative.
///
/// # Format
/// Products of three numbers of 31 bits: six of them are below 2⁹⁶.
fn is_mirrored(transform: &Affine) -> bool {
    let [x, y, z] = transform.to_rows().map(|[x, y, z, _]| [i128::from(x), i128::from(y), i128::from(z)]);
    let minor = |j: usize, k: usize| y[j] * z[k] - y[k] * z[j];
    x[0] * minor(1, 2) + x[1] * minor(2, 0) + x[2] * minor(0, 1) < 0
}

impl<'p, S> Placed<'p, S> {
    /// Culls the clusters of parts, one by one: those that show their back to the camera here, and those out of view in
    /// each call of the closure that draws. The nodes are lent for that: one for each cluster of a placed part. A part
    /// for which too few are left is drawn as a whole.
    ///
    /// It pays where much of a model is out of view, and in frames without records, where each strip goes over all of
    /// the model otherwise. A model that is in view as a whole, with records, is drawn faster without it: positions are
    /// then transformed in one loop. Parts that a pose moves have no clusters.
    #[must_use]
    pub fn cull_clusters(mut self, nodes: &'p mut [BoundsNode]) -> Self {
        let mut used = 0;
        for place in self.places.iter_mut().flatten() {
            let Some(part) = self.model.parts.get(usize::from(place.part)) else { continue };
            let clusters = self.model.clusters_of(part);
            let Some(room) = nodes.get_mut(used..).and_then(|rest| rest.get_mut(..clusters.len())) else { continue };
            let two_sided = self.model.material_of(part).is_some_and(|m| m.flags & MaterialItem::DOUBLE_SIDED != 0);
            let mut count = 0;
            for cluster in clusters {
                if !two_sided && place.eye.is_some_and(|eye| cluster.shows_back(part, eye)) {
                    continue;
                }
                if let Some(node) = room.get_mut(count) {
                    *node = BoundsNode {
                        bounds: cluster.bounds(part),
                        skip: count as u16 + 1,
                        first_triangle: cluster.first_triangle,
                        triangles: cluster.triangles,
                    };
                    count += 1;
                }
            }
            place.nodes = (used as u32, count as u16);
            if count == 0 && !clusters.is_empty() {
                // Not a single triangle is drawn.
                place.part = NONE;
            }
            used += count;
        }
        self.nodes = nodes;
        self
    }

    /// Returns the matrices of the draws, from object space to clip space, with the numbers of their parts: for draws
    /// of one's own. Opaque draws come first, blended ones follow from back to front.
    pub fn draws(&self) -> impl Iterator<Item = (&Projective, usize)> {
        self.places.iter().flatten().map(|place| (&place.mvp, usize::from(place.part)))
    }
}

impl Cluster {
    /// Returns the box of the cluster, rounded outwards.
    fn bounds(&self, part: &Part) -> Bounds {
        let scale = i64::from(part.scale);
        let along = |q: i16, offset: i32| {
            let at = ((i64::from(q) * scale + (1 << 14)) >> 15) + i64::from(offset);
            at.clamp(i32::MIN.into(), i32::MAX.into()) as i32
        };
        let half = |q: u16| (((i64::from(q) * scale) >> 15) + 2).min(i32::MAX.into()) as i32;
        let ([x, y, z], [ox, oy, oz]) = (self.center, part.offset);
        bounds_of([along(x, ox), along(y, oy), along(z, oz)], self.half.map(half))
    }

    /// Returns whether all triangles show their back to an eye in object space: the rule of the container, with all
    /// lengths multiplied by 127.
    ///
    /// # Format
    /// Distances are cut to 20 bits: their products with the axis are below 2²⁹, and squares are below 2⁵⁸. What is cut
    /// counts against culling.
    fn shows_back(&self, part: &Part, eye: Vec3) -> bool {
        if self.cutoff == i8::MAX {
            return false;
        }
        let Bounds { center, half } = self.bounds(part);
        let (distance, half) = ((center - eye).to_bits(), half.to_bits());
        let all = distance.iter().chain(&half).fold(0, |all, c| all | c.unsigned_abs());
        let shift = 12_u32.saturating_sub(all.leading_zeros());
        let distance = distance.map(|c| i64::from(c >> shift));
        let square = |v: [i64; 3]| v.iter().map(|c| c * c).sum::<i64>();
        let radius = square(half.map(|c| i64::from(c >> shift) + 1)).unsigned_abs().isqrt() as i64 + 1;
        let dot: i64 = distance.iter().zip(&self.axis).map(|(d, a)| d * i64::from(*a)).sum();
        let beyond = dot - 127 * radius - 3 * 127;
        let cutoff = i64::from(self.cutoff.max(0));
        beyond >= 0 && beyond * beyond >= cutoff * cutoff * (square(distance) + 1)
    }
}
