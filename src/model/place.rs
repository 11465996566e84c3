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
use crate::math::{Affine, Projective, Vec3, isqrt, mul_long, mul_wide};
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
    node: u16,
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
    to_eye: Option<[Affine; 2]>,
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
    fn transform(&self, pose: &[u32], node: usize) -> Affine {
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

/// Returns the minor a b - c d of a matrix: below 2⁶³.
fn minor(a: i32, b: i32, c: i32, d: i32) -> i64 {
    mul_wide(a, b) - mul_wide(c, d)
}

/// Returns the cofactors of a row of a matrix, of the two other rows in cyclic order.
fn cofactors([a, b, c]: [i32; 3], [d, e, f]: [i32; 3]) -> [i64; 3] {
    [minor(b, f, c, e), minor(c, d, a, f), minor(a, e, b, d)]
}

/// Returns the sum of three products, exactly: below 3 · 2⁹⁴.
fn dot([a, b, c]: [i64; 3], [x, y, z]: [i32; 3]) -> i128 {
    mul_long(a, x) + mul_long(b, y) + mul_long(c, z)
}

/// Returns whether a transform is a mirror: its determinant is negative.
fn is_mirrored(transform: &Affine) -> bool {
    let [x, y, z] = transform.to_rows().map(|[x, y, z, _]| [x, y, z]);
    dot(cofactors(y, z), x) < 0
}

/// Returns the point, raw 16.16, that a transform brings to the origin. `None` if there is no such point, or if it is
/// beyond the range of numbers.
///
/// # Format
/// By Cramer's rule, a coordinate is a quotient of a sum of three products and the determinant, both of at most 96
/// bits. They are cut until the determinant has 32 bits. Coordinates are within 2⁻¹⁵ of the exact ones.
fn origin_of(transform: &Affine) -> Option<[i32; 3]> {
    let rows = transform.to_rows();
    let ([x, y, z], t) = (rows.map(|[x, y, z, _]| [x, y, z]), rows.map(|[.., t]| t));
    let [a, b, c] = [cofactors(y, z), cofactors(z, x), cofactors(x, y)];
    let determinant = dot(a, x);
    let cut = 96_u32.saturating_sub(determinant.unsigned_abs().leading_zeros());
    let divisor = (determinant.unsigned_abs() >> cut) as u64;
    let coordinate = |k: usize| {
        let numerator = dot([a[k], b[k], c[k]], t);
        let quotient = u64::try_from((numerator.unsigned_abs() << 16) >> cut).ok()?.checked_div(divisor)?;
        let quotient = i32::try_from(quotient).ok()?;
        Some(if (numerator < 0) == (determinant < 0) { -quotient } else { quotient })
    };
    Some([coordinate(0)?, coordinate(1)?, coordinate(2)?])
}

impl<'p, S> Placed<'p, S> {
    /// Culls the clusters of parts, one by one: those that show their back to the camera here, and those out of view in
    /// each call of the closure that draws. The nodes are lent for that: one for each cluster of a placed part. A part
    /// for which too few are left is drawn as a whole.
    ///
    /// It pays where much of a model is out of view, and in frames without records, where each strip goes over all of
    /// the model otherwise. A model that is in view as a whole, with records, takes some 2 % more: few clusters show
    /// nothing but their back. The culling takes some 1,200 instructions per cluster on a Cortex-M0+, and the test of
    /// its box 750 per frame with records, 380 per strip without. Parts that a pose moves have no clusters.
    #[must_use]
    pub fn cull_clusters(mut self, nodes: &'p mut [BoundsNode]) -> Self {
        let mut used = 0;
        for to in self.places.iter_mut() {
            let Some(place) = to else { continue };
            place.nodes = (0, 0);
            let Some(part) = self.model.parts.get(usize::from(place.part)) else { continue };
            let clusters = self.model.clusters_of(part);
            let Some(room) = nodes.get_mut(used..).and_then(|rest| rest.get_mut(..clusters.len())) else { continue };
            let two_sided = self.model.material_of(part).is_some_and(|m| m.flags & MaterialItem::DOUBLE_SIDED != 0);
            let eye = match &self.to_eye {
                Some([world, view]) if !clusters.is_empty() && !two_sided => {
                    // As the matrix of the draw was made, so that both round alike.
                    let to_world = *world * self.model.transform(self.pose, place.node.into());
                    origin_of(&(*view * to_world))
                }
                _ => None,
            };
            let mut count = 0;
            for cluster in clusters {
                let exact = cluster.exact_box(part);
                if cluster.cutoff < i8::MAX && eye.is_some_and(|eye| cluster.shows_back(&exact, eye)) {
                    continue;
                }
                if let Some(node) = room.get_mut(count) {
                    *node = BoundsNode {
                        bounds: saturated(exact),
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
                *to = None;
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
    /// Returns the middle of the box and half its size, raw 16.16, rounded outwards.
    ///
    /// # Format
    /// Below 2³³, which is more than [`Bounds`] have.
    #[inline(never)]
    fn exact_box(&self, part: &Part) -> ExactBox {
        let along = |q: i16, offset: i32| ((mul_wide(part.scale, q.into()) + (1 << 14)) >> 15) + i64::from(offset);
        let half = |q: u16| (mul_wide(part.scale, q.into()) >> 15) + 2;
        let ([x, y, z], [ox, oy, oz]) = (self.center, part.offset);
        ([along(x, ox), along(y, oy), along(z, oz)], self.half.map(half))
    }

    /// Returns whether all triangles show their back to an eye in object space, raw 16.16: the rule of the container,
    /// with all lengths multiplied by 127.
    ///
    /// # Format
    /// Distances, below 2³⁴, are cut to 14 bits: their products with the axis are below 2²³, and sums of squares are
    /// below 2³⁰. The distance is off by at most 1 for what is cut, 1 for the middle of the box, and 2 for the eye on
    /// each axis. That is 7 of length, which counts against culling on both sides of the rule.
    #[inline(never)]
    fn shows_back(&self, &([x, y, z], half): &ExactBox, eye: [i32; 3]) -> bool {
        let [ex, ey, ez] = eye.map(i64::from);
        let distance = [x - ex, y - ey, z - ez];
        let all = distance.iter().chain(&half).fold(0, |all, c| all | c.unsigned_abs());
        let shift = 50_u32.saturating_sub(all.leading_zeros());
        let distance = distance.map(|c| (c >> shift) as i32);
        let square = |v: [i32; 3]| v.iter().map(|c| c * c).sum::<i32>();
        let [dx, dy, dz] = distance;
        let [ax, ay, az] = self.axis.map(i32::from);
        let towards = dx * ax + dy * ay + dz * az;
        if towards < 0 {
            return false;
        }
        let radius = isqrt(square(half.map(|c| (c >> shift) as i32 + 1)).unsigned_abs()) as i32 + 1;
        let beyond = towards - 127 * radius - 2 * 7 * 127;
        let cutoff = i32::from(self.cutoff.max(0));
        beyond >= 0 && mul_wide(beyond, beyond) >= mul_wide(cutoff * cutoff, square(distance) + 1)
    }
}

/// The middle of a box and half its size.
type ExactBox = ([i64; 3], [i64; 3]);

/// Returns a box in numbers of bounds, rounded outwards.
fn saturated((exact_center, exact_half): ExactBox) -> Bounds {
    let (mut center, mut half) = ([0; 3], [0; 3]);
    for ((to, half), (c, h)) in center.iter_mut().zip(&mut half).zip(exact_center.into_iter().zip(exact_half)) {
        let saturated = c.clamp(i32::MIN.into(), i32::MAX.into());
        *to = saturated as i32;
        *half = (h + (c - saturated).abs()).min(i32::MAX.into()) as i32;
    }
    bounds_of(center, half)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Scalar;
    use crate::math::random::Rng;

    fn random(rng: &mut Rng, bits: u32, moved: u32) -> Affine {
        let mut vector = |bits| Vec3::from_bits(core::array::from_fn(|_| rng.signed_bits(bits) as i32));
        Affine::from_rows(vector(bits), vector(bits), vector(bits), vector(moved))
    }

    #[test]
    fn the_origin_of_a_transform_is_that_of_its_inverse() {
        let mut rng = Rng::new(4);
        let mut found = 0;
        for case in 0..20_000 {
            let transform = random(&mut rng, 4 + case % 28, 1 + case / 7 % 31);
            let Some(origin) = origin_of(&transform) else { continue };
            let Some(inverse) = transform.inverse() else { continue };
            found += 1;
            let exact = inverse.transform_point(Vec3::ZERO).to_bits();
            let is_near = origin.iter().zip(exact).all(|(a, b)| a.abs_diff(b) <= 2);
            assert!(is_near, "{origin:?}, not {exact:?}: {transform:?}");
        }
        assert!(found > 5000, "{found}");
        assert_eq!(origin_of(&Affine::scale(Scalar::ZERO)), None);
        let far = Affine::translation(Vec3::from_ints(20_000, 0, 0)) * Affine::scale(Scalar::from_num(0.5));
        assert_eq!(origin_of(&far), None);
        let ends = Affine::from_rows(Vec3::X, Vec3::Y, Vec3::Z, Vec3::from_bits([i32::MIN, i32::MAX, 1]));
        assert_eq!(origin_of(&ends), None);
    }

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

    #[test]
    fn mirrors_have_a_negative_determinant() {
        let mut rng = Rng::new(5);
        for case in 0..20_000 {
            let transform = random(&mut rng, 2 + case % 31, 5);
            let [[a, b, c, _], [d, e, f, _], [g, h, i, _]] = transform.to_rows().map(|row| row.map(i128::from));
            let determinant = a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g);
            assert_eq!(is_mirrored(&transform), determinant < 0, "{transform:?}");
        }
        let least = Vec3::from_bits([i32::MIN; 3]);
        assert!(!is_mirrored(&Affine::from_rows(least, least, least, least)));
        assert!(is_mirrored(&Affine::scale(Scalar::MIN)));
    }
}
