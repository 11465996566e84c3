//! Writes an import as a container of the library, reads it back, and compares.

mod check;
mod clips;
mod clusters;
mod cut;
mod nodes;
mod options;
mod parts;
mod quantize;
mod report;
mod sections;
mod skins;
mod textures;
mod uvs;
mod verify;
mod wraps;

use bytemuck::Zeroable;
use zstrip::model::container::{AlphaMode as Mode, Header, Material as MaterialItem, NONE, Node, SectionKind};

pub use options::{TextureKind, UvSize, WriteOptions};
pub use report::{Errors, LevelReport, WriteError, WriteNote, WriteReport, Written};
#[cfg(feature = "cli")]
pub(crate) use sections::SECTION_NAMES;

use crate::model::{AlphaMode, Animation, Import, Material};
use crate::pose::Posed;
use parts::{Around, Pieces};
use quantize::Extent;
use sections::Sections;

/// Vertices that are posed, all together, to find the boxes of clips.
const POSED_VERTICES: usize = 50_000_000;

/// Writes a model as a container, which `zstrip::model::Model` reads. The container is read back, and compared with the
/// import.
///
/// ```
/// use zstrip_assets::{Import, Mesh, Node, Vertices, WriteOptions, write};
///
/// let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let vertices = Vertices { positions, ..Vertices::default() };
/// let mesh = Mesh { vertices, triangles: vec![[0, 1, 2]], ..Mesh::default() };
/// let node = Node { meshes: vec![0], ..Node::default() };
/// let import = Import { nodes: vec![node], meshes: vec![mesh], ..Import::default() };
/// let written = write(&import, &WriteOptions::default())?;
/// assert!(written.report.errors.position_steps <= 0.5);
/// # Ok::<(), zstrip_assets::WriteError>(())
/// ```
///
/// # Errors
///
/// The import has numbers or items beyond those of the container, or is inconsistent; or an option is out of its range.
pub fn write(import: &Import, options: &WriteOptions) -> Result<Written, WriteError> {
    if let Some(fault) = options.fault() {
        return Err(WriteError::Options(fault));
    }
    check::check(import)?;
    let mut to = Sections::default();
    let mut report = WriteReport::default();
    let nodes = nodes::nodes(import, &mut to, &mut report)?;
    let textures = textures::textures(import, options, &mut to, &mut report)?;
    for (material, texture) in import.materials.iter().zip(&textures.numbers) {
        to.add(SectionKind::Materials, &[material_item(material, *texture)]);
    }
    if import.meshes.iter().any(|mesh| mesh.material.is_none()) {
        to.add(SectionKind::Materials, &[material_item(&Material::default(), None)]);
    }
    let materials = to.count(SectionKind::Materials) as usize;
    if materials > usize::from(NONE) {
        return Err(WriteError::TooMany { what: "materials", found: materials, most: NONE.into() });
    }

    let import = &*cut::cut(import, &textures.sizes, &mut report);
    let mut pieces = parts::pieces(import, &mut report)?;
    wraps::unwrap(&mut pieces.list, import, &textures.sizes, &mut report);
    let skins = skins::skins(import, &pieces.list, &mut report)?;
    let rest = import.pose(None);
    let (rest_box, size) = extent(import, &rest);
    report.note(usize::from(size > 0.0 && size < 0.125), |_| {
        let factor = 10_f64.powi((4.0 / size).log10().round() as i32);
        WriteNote::Small { size, factor }
    });
    let texel_sizes = texel_sizes(import, &pieces, &rest, &textures.sizes);
    let around = Around {
        import,
        uvs: options.uvs,
        skins: &skins,
        textures: &textures.sizes,
        texel_sizes: &texel_sizes,
        pieces: &pieces.list,
    };
    let weights = pieces.weights.last().map_or(0, |range| range.end);
    let joints = skins.iter().map(|(_, numbers)| numbers.iter().filter(|n| **n != u16::MAX).count()).max();
    let mut pose_words = (12 * (nodes.items.len() + joints.unwrap_or(0)) + weights) as u32;
    let mut written = Vec::new();
    for (number, piece) in pieces.list.iter().enumerate() {
        written.push(parts::part(piece, number, &around, &mut pose_words, &mut to, &mut report)?);
    }
    skins::write(import, &pieces.list, &written, &skins, &nodes.numbers, &mut to)?;
    report.note(pieces.list.iter().filter(|piece| piece.is_posed()).count(), |parts| WriteNote::NoClusters { parts });
    let bounds = |animation: &Animation| clip_extent(import, animation);
    let moved = clips::Moved { import, size, nodes: &nodes.numbers, weights: &pieces.weights };
    clips::clips(&moved, options, bounds, &mut to, &mut report)?;

    let weights_at_rest: Vec<i16> = import
        .nodes
        .iter()
        .zip(&pieces.weights)
        .flat_map(|(node, range)| (0..range.len()).map(|k| node.weights.get(k).copied().unwrap_or(0.0)))
        .map(|w| (f64::from(w) * 16_384.0).round().clamp(-32_767.0, 32_767.0) as i16)
        .collect();
    let rest_weights = to.add(SectionKind::Keys, &weights_at_rest);
    let mut draws = 0;
    let mut items = nodes.items;
    for (number, range) in nodes.numbers.iter().zip(&pieces.of_nodes) {
        let node: &mut Node = &mut items[usize::from(*number)];
        (node.first_part, node.parts) = (range.start as u16, range.len() as u16);
        draws += range.len();
    }
    to.add(SectionKind::Nodes, &items);
    let (center, half) = rest_box.rounded("the box of the model")?;
    let header = Header {
        draws: draws as u32,
        pose_words,
        weights: weights as u32,
        rest_weights,
        center,
        half,
        ..Header::zeroed()
    };
    let bytes = to.container(header)?;
    report.bytes = bytes.len();
    report.sections = to.sizes();
    (report.draws, report.pose_words) = (draws, pose_words as usize);
    report.parts = pieces.list.len();
    let shown = &pieces.list[..pieces.shown];
    report.vertices = shown.iter().map(|piece| piece.vertices.len()).sum();
    report.triangles = shown.iter().map(|piece| piece.triangles.len()).sum();
    report.levels = levels(import, &pieces.list);
    let mut notes = Vec::new();
    report.notes.drain(..).for_each(|note| merge(&mut notes, note));
    report.notes = notes;
    verify::verify(&bytes, import, &pieces, &nodes.numbers, &textures.sizes, &mut report.errors)?;
    Ok(Written { bytes, report })
}

/// Returns the levels of detail of all parts together.
fn levels(import: &Import, pieces: &[parts::Piece]) -> Vec<LevelReport> {
    let mut levels: Vec<LevelReport> = Vec::new();
    for piece in pieces.iter().filter(|piece| piece.finest.is_none()) {
        let (mut coarser, mut number) = (piece.coarser, 0);
        while let Some(level) = coarser.map(|k| &pieces[k]) {
            if levels.len() == number {
                levels.push(LevelReport::default());
            }
            let report = &mut levels[number];
            report.parts += 1;
            report.triangles += level.triangles.len();
            report.vertices += level.vertices.len();
            report.error = report.error.max(import.meshes[level.mesh].error);
            (coarser, number) = (level.coarser, number + 1);
        }
    }
    levels
}

/// Adds a note, or its number to a note of that kind that is there already.
fn merge(notes: &mut Vec<WriteNote>, note: WriteNote) {
    use WriteNote::{MissingUvs, UnusedUvs, VertexAlpha};
    for known in &mut *notes {
        match (known, &note) {
            (VertexAlpha { vertices: sum }, VertexAlpha { vertices: more })
            | (UnusedUvs { parts: sum }, UnusedUvs { parts: more })
            | (MissingUvs { parts: sum }, MissingUvs { parts: more }) => {
                *sum += more;
                return;
            }
            (known, note) if known == note => return,
            _ => {}
        }
    }
    notes.push(note);
}

fn material_item(material: &Material, texture: Option<u16>) -> MaterialItem {
    let byte = |c: f32| (f64::from(c) * 255.0).round().clamp(0.0, 255.0) as u8;
    let alpha = f64::from(material.color[3]);
    // The library compares the texture's alpha alone, so the cutoff takes the factor of the material.
    let cutoff = |cutoff: f32| (f64::from(cutoff) / alpha.max(1e-6) * 255.0).round().clamp(0.0, 255.0) as u8;
    let (mode, cutoff) = match material.alpha {
        AlphaMode::Opaque => (Mode::Opaque, 0),
        AlphaMode::Mask { cutoff: least } => (Mode::Mask, cutoff(least)),
        AlphaMode::Blend => (Mode::Blend, 0),
    };
    let sides = if material.double_sided { MaterialItem::DOUBLE_SIDED } else { 0 };
    let light = if material.unlit { MaterialItem::UNLIT } else { 0 };
    MaterialItem {
        color: material.color.map(byte),
        texture: texture.unwrap_or(NONE),
        alpha_mode: mode as u8,
        cutoff,
        flags: sides | light,
        ..MaterialItem::zeroed()
    }
}

/// Returns the box around a pose of the model, and its largest side.
fn extent(import: &Import, posed: &Posed) -> (Extent, f64) {
    let mut extent = Extent::EMPTY;
    for (number, node) in import.nodes.iter().enumerate() {
        let joints = node.skin.map(|skin| import.joint_matrices(skin, &posed.world));
        for mesh in node.meshes.iter().map(|mesh| &import.meshes[*mesh]) {
            (0..mesh.vertices.len()).for_each(|v| extent.add(posed.vertex(number, mesh, v, joints.as_deref())));
        }
    }
    let size = extent.size();
    (extent, size)
}

/// Returns the box around the poses of a clip, at times that are evenly spread, with some room between them.
fn clip_extent(import: &Import, animation: &Animation) -> Extent {
    let vertices: usize = import.nodes.iter().flat_map(|n| &n.meshes).map(|m| import.meshes[*m].vertices.len()).sum();
    let all = vertices.saturating_mul(import.animations.len()).max(1);
    let steps = (POSED_VERTICES / all).clamp(2, 64);
    let mut sum = Extent::EMPTY;
    for step in 0..=steps {
        let time = f64::from(animation.duration()) * step as f64 / steps as f64;
        sum.join(&extent(import, &import.pose(Some((animation, time)))).0);
    }
    let room = sum.size() / 100.0;
    if room > 0.0 {
        sum.join(&Extent { low: sum.low.map(|c| c - room), high: sum.high.map(|c| c + room) });
    }
    sum
}

/// Returns the texels per unit of length of each piece.
fn texel_sizes(import: &Import, pieces: &Pieces, rest: &Posed, sizes: &[Option<[u32; 2]>]) -> Vec<f64> {
    let size = |piece: &parts::Piece| {
        let Some(Some(size)) = sizes.get(piece.material) else { return 0.0 };
        let mesh = &import.meshes[piece.mesh];
        // Vertices of skins are in the space of the model, all others in that of their node.
        let joints = piece.skin.map(|skin| import.joint_matrices(skin, &rest.world));
        let at = |v: usize| match &joints {
            Some(joints) => rest.vertex(piece.node, mesh, piece.numbers[v] as usize, Some(joints)),
            None => piece.vertices.positions[v].map(f64::from),
        };
        parts::texels_per_unit(piece, at, *size)
    };
    pieces.list.iter().map(size).collect()
}
