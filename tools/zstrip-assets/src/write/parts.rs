//! Parts: the meshes that nodes show, quantized.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use zstrip::math::{Scalar, Vec3};
use zstrip::mesh::{Mesh as MeshView, MeshData, Positions};
use zstrip::model::container::{Delta, Influence, NONE, NONE_LONG, Part, SectionKind, Target};

use super::clusters::clusters;
use super::options::UvSize;
use super::quantize::{Cube, Extent, MOST, normal_bytes};
use super::report::{WriteError, WriteNote, WriteReport};
use super::sections::Sections;
use super::uvs::Uvs;
use crate::geometry::{Vector, cross, dot};
use crate::model::{Import, Mesh, Vertices};

/// The most vertices, and the most triangles, of a part.
const MOST_ITEMS: usize = 65_535;

/// Triangles of a cluster of a mesh that has none.
pub(super) const CLUSTER: usize = 124;

/// A part, as it was cut out of a mesh of the import.
pub(super) struct Piece {
    /// The mesh in the import.
    pub mesh: usize,
    /// The piece of the next level of detail.
    pub coarser: Option<usize>,
    /// The piece that a level of detail stands for.
    pub finest: Option<usize>,
    /// The first node that shows it.
    pub node: usize,
    /// The numbers of its vertices in the mesh.
    pub numbers: Vec<u32>,
    pub vertices: Vertices,
    pub triangles: Vec<[u16; 3]>,
    /// Numbers of triangles of its clusters.
    pub clusters: Vec<usize>,
    pub skin: Option<usize>,
    pub first_weight: u32,
    /// The least and the largest weight of each morph target, 0 and 1 included.
    pub weights: Vec<[f64; 2]>,
    pub material: usize,
}

impl Piece {
    pub fn is_posed(&self) -> bool {
        self.skin.is_some() || !self.vertices.morphs.is_empty()
    }

    /// Returns the box around a vertex wherever morph targets bring it.
    pub fn reach_of(&self, v: usize) -> Extent {
        let p = self.vertices.positions[v].map(f64::from);
        let (mut low, mut high) = (p, p);
        for (morph, [least, most]) in self.vertices.morphs.iter().zip(&self.weights) {
            for k in 0..3 {
                let d = f64::from(morph.positions[v][k]);
                low[k] += (least * d).min(most * d).min(0.0);
                high[k] += (least * d).max(most * d).max(0.0);
            }
        }
        Extent { low, high }
    }

    /// Returns the box around all vertices wherever morph targets bring them, and the longest move.
    pub fn extent(&self) -> (Extent, f64) {
        let mut extent = Extent::EMPTY;
        (0..self.vertices.len()).for_each(|v| extent.join(&self.reach_of(v)));
        let deltas = self.vertices.morphs.iter().flat_map(|morph| morph.positions.as_flattened());
        (extent, deltas.fold(0.0, |most: f64, d| most.max(f64::from(d.abs()))))
    }
}

/// The pieces of a model, and those of each node.
pub(super) struct Pieces {
    pub list: Vec<Piece>,
    /// The number of those that nodes show. Levels of detail follow.
    pub shown: usize,
    pub of_nodes: Vec<Range<usize>>,
    /// The first weight of morph targets of each node, and their number.
    pub weights: Vec<Range<usize>>,
}

/// Cuts meshes into pieces. Nodes that show the same meshes share pieces, unless morph targets move them.
pub(super) fn pieces(import: &Import, report: &mut WriteReport) -> Result<Pieces, WriteError> {
    let mut pieces = Pieces { list: Vec::new(), shown: 0, of_nodes: Vec::new(), weights: Vec::new() };
    let mut known = HashMap::new();
    let mut weights = 0;
    for (k, node) in import.nodes.iter().enumerate() {
        let targets = node.meshes.iter().map(|mesh| import.meshes[*mesh].vertices.morphs.len()).max().unwrap_or(0);
        let own = weights..weights + targets;
        weights += targets;
        let key = (&node.meshes, node.skin, if targets > 0 { Some(k) } else { None });
        let range = match known.get(&key) {
            Some(range) => Range::clone(range),
            None => {
                let first = pieces.list.len();
                for mesh in &node.meshes {
                    let before = pieces.list.len();
                    cut(import, *mesh, k, own.start, &mut pieces.list);
                    let parts = pieces.list.len() - before;
                    if parts > 1 {
                        report.notes.push(WriteNote::Divided { mesh: *mesh, parts });
                    }
                }
                known.insert(key, first..pieces.list.len());
                first..pieces.list.len()
            }
        };
        pieces.of_nodes.push(range);
        pieces.weights.push(own);
    }
    pieces.shown = pieces.list.len();
    add_levels(import, &mut pieces.list, report);
    let draws = pieces.of_nodes.iter().map(ExactSizeIterator::len).sum();
    for (what, found) in [("parts", pieces.list.len()), ("draws", draws), ("weights of morph targets", weights)] {
        if found > MOST_ITEMS {
            return Err(WriteError::TooMany { what, found, most: MOST_ITEMS });
        }
    }
    Ok(pieces)
}

/// Adds the levels of detail of pieces that are whole meshes and that nothing moves.
fn add_levels(import: &Import, list: &mut Vec<Piece>, report: &mut WriteReport) {
    let mut known: HashMap<usize, Option<usize>> = HashMap::new();
    let mut left_out = HashSet::new();
    let mut number = 0;
    while let Some(piece) = list.get(number) {
        if let Some(coarser) = import.meshes[piece.mesh].coarser {
            let is_whole = piece.triangles.len() == import.meshes[piece.mesh].triangles.len();
            let (mesh, node, is_posed) = (piece.mesh, piece.node, piece.is_posed());
            let finest = piece.finest.unwrap_or(number);
            let level = if is_posed || !is_whole {
                None
            } else {
                *known.entry(coarser).or_insert_with(|| {
                    let mut cut_up = Vec::new();
                    cut(import, coarser, node, 0, &mut cut_up);
                    let level = cut_up.pop().filter(|level| cut_up.is_empty() && !level.is_posed())?;
                    list.push(Piece { finest: Some(finest), ..level });
                    Some(list.len() - 1)
                })
            };
            if level.is_none() {
                left_out.insert(mesh);
            }
            list[number].coarser = level;
        }
        number += 1;
    }
    report.note(left_out.len(), |meshes| WriteNote::NoLevels { meshes });
}

/// Cuts a mesh between its clusters where a part has too many vertices or triangles.
fn cut(import: &Import, number: usize, node: usize, first_weight: usize, to: &mut Vec<Piece>) {
    let mesh = &import.meshes[number];
    let mut clusters: Vec<_> = mesh.clusters.iter().map(|cluster| cluster.count).collect();
    if clusters.is_empty() {
        clusters = mesh.triangles.chunks(CLUSTER).map(<[_]>::len).collect();
    }
    let (mut first, mut end, mut own) = (0, 0, Vec::new());
    let mut used = HashSet::new();
    for count in clusters {
        let triangles = &mesh.triangles[end..end + count];
        let fresh: HashSet<_> = triangles.as_flattened().iter().filter(|v| !used.contains(*v)).copied().collect();
        if used.len() + fresh.len() > MOST_ITEMS || end + count - first > MOST_ITEMS {
            to.push(piece(import, number, node, first_weight, first..end, std::mem::take(&mut own)));
            first = end;
            used = triangles.as_flattened().iter().copied().collect();
        } else {
            used.extend(fresh);
        }
        own.push(count);
        end += count;
    }
    if end > first {
        to.push(piece(import, number, node, first_weight, first..end, own));
    }
}

fn piece(
    import: &Import,
    number: usize,
    node: usize,
    first_weight: usize,
    range: Range<usize>,
    clusters: Vec<usize>,
) -> Piece {
    let mesh = &import.meshes[number];
    // Vertices stand in the order in which triangles use them, so the vertex stage goes over them once.
    let (mut numbers, mut places) = (Vec::new(), HashMap::new());
    let mut place = |v: u32| {
        *places.entry(v).or_insert_with(|| {
            numbers.push(v);
            (numbers.len() - 1) as u16
        })
    };
    let triangles = mesh.triangles[range].iter().map(|t| t.map(&mut place)).collect();
    let skin = import.nodes[node].skin.filter(|_| !mesh.vertices.joints.is_empty());
    Piece {
        mesh: number,
        coarser: None,
        finest: None,
        node,
        vertices: mesh.vertices.select(&numbers),
        numbers,
        triangles,
        clusters,
        skin,
        first_weight: first_weight as u32,
        weights: weight_ranges(import, node, mesh),
        material: mesh.material.unwrap_or(import.materials.len()),
    }
}

/// Returns the least and the largest weight of each morph target, of 0, 1, the node and all clips.
fn weight_ranges(import: &Import, node: usize, mesh: &Mesh) -> Vec<[f64; 2]> {
    let mut ranges = vec![[0.0_f64, 1.0]; mesh.vertices.morphs.len()];
    let channels = import.animations.iter().flat_map(|animation| &animation.channels);
    let channels = channels.filter(|channel| channel.node == node && channel.path == crate::model::Path::Weights);
    let of_clips = channels.flat_map(|channel| channel.values.chunks(channel.width().max(1)));
    for weights in std::iter::once(&import.nodes[node].weights[..]).chain(of_clips) {
        for ([least, most], weight) in ranges.iter_mut().zip(weights) {
            let weight = f64::from(*weight).clamp(-2.0, 2.0);
            (*least, *most) = (least.min(weight), most.max(weight));
        }
    }
    ranges
}

/// Everything that parts need to know of the rest.
pub(super) struct Around<'a> {
    pub import: &'a Import,
    pub uvs: UvSize,
    /// The cubes of skins, and the new numbers of their joints.
    pub skins: &'a [(Cube, Vec<u16>)],
    /// Columns and rows of each material's texture.
    pub textures: &'a [Option<[u32; 2]>],
    /// The texels per unit of length of each piece.
    pub texel_sizes: &'a [f64],
    pub pieces: &'a [Piece],
}

/// Writes a part, and returns its positions.
pub(super) fn part(
    piece: &Piece,
    number: usize,
    around: &Around<'_>,
    pose_words: &mut u32,
    to: &mut Sections,
    report: &mut WriteReport,
) -> Result<(Vec<[i16; 3]>, Vec<Influence>), WriteError> {
    let (vertices, name) = (&piece.vertices, format!("meshes[{}]", piece.mesh));
    let cube = match piece.skin {
        Some(skin) => around.skins[skin].0,
        None => {
            let (extent, longest) = piece.extent();
            Cube::around(&extent, longest, &format!("the size of {name}"))?
        }
    };
    let points: Vec<_> = vertices.positions.iter().map(|p| cube.point(p.map(f64::from))).collect();
    let positions = Positions::Quantized {
        points: &points,
        scale: Scalar::from_bits(cube.scale),
        offset: Vec3::from_bits(cube.offset),
    };
    let indices = piece.triangles.as_flattened();
    let view = MeshView::new(MeshData { indices: Some(indices), ..MeshData::new(positions) });
    let bounds = *view.map_err(|error| WriteError::ReadBack(error.to_string()))?.bounds();

    let material = around.import.materials.get(piece.material);
    let is_textured = around.textures.get(piece.material).is_some_and(Option::is_some);
    let is_unlit = material.is_some_and(|material| material.unlit);
    let normals: Vec<_> = vertices.normals.iter().map(|n| normal_bytes(n.map(f64::from))).collect();
    // A texture without light needs no normals. Without a texture, they choose the shader that mixes colours.
    let normals = if is_unlit && is_textured && piece.vertices.morphs.is_empty() { Vec::new() } else { normals };
    let byte = |c: f32| (f64::from(c) * 255.0).round().clamp(0.0, 255.0) as u8;
    let mut colors: Vec<_> = vertices.colors.iter().map(|[r, g, b, _]| [*r, *g, *b].map(byte)).collect();
    if colors.iter().all(|color| *color == [255; 3]) {
        colors.clear();
    }
    report.note(vertices.colors.iter().filter(|[.., a]| byte(*a) < 255).count(), |vertices| WriteNote::VertexAlpha {
        vertices,
    });
    let uvs = if is_textured { Uvs::of(&vertices.uvs, around.uvs, &name)? } else { Uvs::default() };
    report.note(usize::from(!is_textured && !vertices.uvs.is_empty()), |parts| WriteNote::UnusedUvs { parts });
    report.note(usize::from(is_textured && vertices.uvs.is_empty()), |parts| WriteNote::MissingUvs { parts });

    let influences = match piece.skin {
        Some(skin) => influences(vertices, &around.skins[skin].1),
        None => Vec::new(),
    };
    let first_target = to.count(SectionKind::Targets);
    vertices.morphs.iter().for_each(|morph| target(morph, &cube, to));
    let is_posed = piece.is_posed();
    let first_cluster = to.count(SectionKind::Clusters);
    if !is_posed {
        let clusters = clusters(piece, &points);
        to.add(SectionKind::Clusters, &clusters);
    }
    let pose = if is_posed { *pose_words } else { NONE_LONG };
    if is_posed {
        let vectors = 3 * points.len().div_ceil(2) as u32;
        *pose_words += 10 + if normals.is_empty() { vectors } else { 2 * vectors };
    }
    let item = Part {
        first_vertex: to.add(SectionKind::Points, &points),
        vertices: points.len() as u32,
        first_index: to.add(SectionKind::Indices, indices),
        triangles: piece.triangles.len() as u32,
        first_normal: to.add_some(SectionKind::Normals, &normals),
        first_color: to.add_some(SectionKind::Colors, &colors),
        first_uv: if uvs.bits == 8 {
            to.add_some(SectionKind::SmallUvs, &uvs.stored.iter().map(|uv| uv.map(|c| c as u8)).collect::<Vec<_>>())
        } else {
            to.add_some(SectionKind::Uvs, &uvs.stored)
        },
        first_influence: to.add(SectionKind::Influences, &influences),
        first_cluster,
        first_target,
        first_weight: if vertices.morphs.is_empty() { 0 } else { piece.first_weight },
        pose,
        scale: cube.scale,
        offset: cube.offset,
        center: bounds.center.to_bits(),
        half: bounds.half.to_bits(),
        uv_offset: uvs.offset,
        texels_per_unit: (around.texel_sizes[number] * 256.0).clamp(0.0, f64::from(u32::MAX)) as u32,
        error: error_of(piece, &cube, around)?,
        clusters: (to.count(SectionKind::Clusters) - first_cluster) as u16,
        targets: vertices.morphs.len() as u16,
        material: piece.material as u16,
        skin: piece.skin.map_or(NONE, |skin| skin as u16),
        coarser: piece.coarser.map_or(NONE, |coarser| coarser as u16),
        uv_shift: uvs.shift,
        uv_bits: uvs.bits,
    };
    to.add(SectionKind::Parts, &[item]);
    Ok((points, influences))
}

/// Returns the error of a level of detail, 16.16, rounded up, with what positions lose: half a step along each axis, of
/// the level's and of the finest part's.
fn error_of(piece: &Piece, cube: &Cube, around: &Around<'_>) -> Result<u32, WriteError> {
    let Some(finest) = piece.finest else { return Ok(0) };
    let (extent, longest) = around.pieces[finest].extent();
    let of_finest = Cube::around(&extent, longest, "the size of a mesh")?;
    let step = |cube: &Cube| f64::from(cube.scale) / 65_536.0 / 32_768.0;
    let lost = (step(cube) + step(&of_finest)) / 2.0 * 3.0_f64.sqrt();
    let error = around.import.meshes[piece.mesh].error + lost;
    Ok((error * 65_536.0).ceil().min(f64::from(u32::MAX)) as u32)
}

/// Returns the joints and weights of vertices. Weights are 256ths, and what rounding leaves goes to the largest.
fn influences(vertices: &Vertices, joints: &[u16]) -> Vec<Influence> {
    let influence = |(numbers, weights): (&[u16; 4], &[f32; 4])| {
        let mut parts: Vec<(u16, f64)> = numbers.iter().copied().zip(weights.iter().map(|w| f64::from(*w))).collect();
        parts.sort_by(|a, b| b.1.total_cmp(&a.1));
        // Downwards from what is left, so that none is above the one before.
        let mut stored = [0; 3];
        let mut before = 255;
        for (to, (_, weight)) in stored.iter_mut().zip(&parts[1..]) {
            *to = ((weight * 256.0).round().clamp(0.0, 255.0) as i32).min(before);
            before = *to;
        }
        // The first one has what is left, and must not be below the second one.
        while 256 - stored.iter().sum::<i32>() < stored[0] {
            let last = (0..3).rev().find(|k| stored[*k] > 0).unwrap_or(0);
            stored[last] -= 1;
        }
        // Without weights, a vertex follows the first joint.
        let first = if parts[0].1 > 0.0 { parts[0].0 } else { 0 };
        let number = |k: usize| match k {
            0 => joints[usize::from(first)] as u8,
            _ if stored[k - 1] > 0 => joints[usize::from(parts[k].0)] as u8,
            _ => 0,
        };
        Influence { joints: [number(0), number(1), number(2), number(3)], weights: stored.map(|w| w as u8), zero: 0 }
    };
    vertices.joints.iter().zip(&vertices.weights).map(influence).collect()
}

/// Writes a morph target: its vertices from the first to the last that moves.
fn target(morph: &crate::model::Morph, cube: &Cube, to: &mut Sections) {
    let deltas: Vec<_> = (0..morph.positions.len())
        .map(|v| {
            let normal = morph.normals.get(v).copied().unwrap_or_default();
            Delta {
                point: cube.delta(morph.positions[v].map(f64::from)),
                normal: normal.map(|c| (f64::from(c) * 64.0).round().clamp(-127.0, 127.0) as i8),
                zero: 0,
            }
        })
        .collect();
    let moves = |delta: &Delta| delta.point != [0; 3] || delta.normal != [0; 3];
    let first = deltas.iter().position(moves).unwrap_or(0);
    let end = deltas.iter().rposition(moves).map_or(first, |last| last + 1);
    let first_delta = to.add(SectionKind::Deltas, &deltas[first..end]);
    let vertices = (end - first) as u16;
    to.add(SectionKind::Targets, &[Target { first_delta, first_vertex: first as u16, vertices }]);
}

/// Returns how many texels of a texture a unit of length takes; 0 if that is not known. The number is the mean of all
/// triangles that show more than a line of texels: triangles beyond a clamped side do not count.
pub(super) fn texels_per_unit(piece: &Piece, at: impl Fn(usize) -> Vector, size: [u32; 2]) -> f64 {
    if piece.vertices.uvs.is_empty() {
        return 0.0;
    }
    let (mut texels, mut area) = (0.0, 0.0);
    for corners in &piece.triangles {
        let [a, b, c] = corners.map(|v| at(usize::from(v)));
        let side = |p: Vector| std::array::from_fn(|k| p[k] - a[k]);
        let normal = cross(side(b), side(c));
        let [a, b, c] = corners.map(|v| piece.vertices.uvs[usize::from(v)].map(f64::from));
        let shown = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
        if shown > 0.0 {
            (texels, area) = (texels + shown, area + dot(normal, normal).sqrt());
        }
    }
    let per_area = texels * f64::from(size[0]) * f64::from(size[1]) / area;
    if per_area.is_finite() { per_area.sqrt().min(MOST * 512.0) } else { 0.0 }
}
