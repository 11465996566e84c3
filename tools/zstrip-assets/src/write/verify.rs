//! Reads a container back by the library, and compares it with the import in 64-bit floats.

use std::ops::Range;

use bytemuck::{Pod, pod_collect_to_vec, pod_read_unaligned};
use zstrip::mesh::{Mesh as MeshView, Positions};
use zstrip::model::container::{Header, NONE_LONG, Part, SectionKind};
use zstrip::model::{Model, decode_normal};

use super::clips::milliseconds;
use super::parts::{Piece, Pieces};
use super::quantize::{degrees, float};
use super::report::{Errors, WriteError};
use crate::geometry::{Vector, dot};
use crate::model::{Animation, Import};

/// Times of a clip that poses are compared at, the end included.
const TIMES: u32 = 16;

/// The most vertices that are compared in poses.
const MOST_VERTICES: usize = 8_000_000;

/// Compares all numbers of a container with those of the import, and notes the largest differences.
pub(super) fn verify(
    bytes: &[u8],
    import: &Import,
    pieces: &Pieces,
    nodes: &[u16],
    textures: &[Option<[u32; 2]>],
    errors: &mut Errors,
) -> Result<(), WriteError> {
    let refused = |error: &dyn std::fmt::Display| WriteError::ReadBack(error.to_string());
    // Words begin at multiples of 4.
    let padded = [bytes, &vec![0; bytes.len().next_multiple_of(4) - bytes.len()]].concat();
    let words: Vec<u32> = pod_collect_to_vec(&padded);
    let container = &bytemuck::cast_slice::<u32, u8>(&words)[..bytes.len()];
    let model = Model::from_bytes(container).map_err(|error| refused(&error))?;
    let file = File { bytes, header: pod_read_unaligned(&bytes[..size_of::<Header>()]) };
    let parts: Vec<Part> = file.section(SectionKind::Parts);
    for (number, (piece, part)) in pieces.list.iter().zip(&parts).enumerate() {
        let Some(mesh) = model.mesh(number) else { return Err(refused(&format!("no part {number}"))) };
        compare_part(&file, piece, part, &mesh, textures.get(piece.material).copied().flatten(), errors)?;
    }
    let mut memory = vec![0; pose_words(&file)];
    let mut pose = model.pose(&mut memory).map_err(|error| refused(&error))?;
    let mut worst = [0.0; 2];
    compare_pose(&pose, import, pieces, nodes, None, &mut worst, errors);
    errors.rest = worst[0];
    let mut worst = [0.0; 2];
    let is_posed = pieces.list.iter().any(Piece::is_posed);
    for (animation, clip) in import.animations.iter().zip(model.clips()) {
        for step in 0..=TIMES {
            if errors.posed_vertices > MOST_VERTICES {
                break;
            }
            let duration = milliseconds(animation);
            // A time of whole milliseconds, which is that of the library.
            let at = (u64::from(duration) * u64::from(step) / u64::from(TIMES)) as u32;
            pose.play(clip.once(at));
            let time = f64::from(at) / f64::from(duration) * f64::from(animation.duration());
            compare_pose(&pose, import, pieces, nodes, Some((animation, time)), &mut worst, errors);
        }
    }
    errors.pose = worst[0];
    errors.pose_normal = if is_posed { worst[1] } else { 0.0 };
    Ok(())
}

fn pose_words(file: &File<'_>) -> usize {
    file.header.pose_words as usize
}

/// The sections of a container, copied.
struct File<'a> {
    bytes: &'a [u8],
    header: Header,
}

impl File<'_> {
    fn section<T: Pod>(&self, kind: SectionKind) -> Vec<T> {
        let section = self.header.table[kind as usize];
        self.items(kind, 0, section.count as usize)
    }

    fn items<T: Pod>(&self, kind: SectionKind, first: u32, count: usize) -> Vec<T> {
        let begin = self.header.table[kind as usize].offset as usize + first as usize * size_of::<T>();
        pod_collect_to_vec(&self.bytes[begin..begin + count * size_of::<T>()])
    }
}

/// Returns a position of a mesh.
fn position(mesh: &MeshView<'_>, v: usize) -> Vector {
    match mesh.data().positions {
        Positions::Quantized { points, scale, offset } => {
            let step = float(scale.to_bits()) / 32_768.0;
            let offset = offset.to_bits();
            std::array::from_fn(|k| float(offset[k]) + f64::from(points[v][k]) * step)
        }
        // The library makes no others of containers.
        _ => mesh.position(v).to_bits().map(float),
    }
}

fn length(a: Vector, b: Vector) -> f64 {
    let apart: Vector = std::array::from_fn(|k| a[k] - b[k]);
    dot(apart, apart).sqrt()
}

fn compare_part(
    file: &File<'_>,
    piece: &Piece,
    part: &Part,
    mesh: &MeshView<'_>,
    texture: Option<[u32; 2]>,
    errors: &mut Errors,
) -> Result<(), WriteError> {
    let (vertices, count) = (&piece.vertices, part.vertices as usize);
    let step = float(part.scale) / 32_768.0;
    for (v, p) in vertices.positions.iter().enumerate() {
        let (found, p) = (position(mesh, v), p.map(f64::from));
        errors.position = errors.position.max(length(found, p));
        let worst = (0..3).map(|k| (found[k] - p[k]).abs()).fold(0.0, f64::max);
        errors.position_steps = errors.position_steps.max(worst / step);
    }
    for (t, triangle) in piece.triangles.iter().enumerate() {
        if mesh.triangle(t) != Some(*triangle) {
            return Err(WriteError::ReadBack(format!("triangle {t} is {:?}", mesh.triangle(t))));
        }
    }
    if part.first_normal != NONE_LONG {
        let normals: Vec<[i8; 2]> = file.items(SectionKind::Normals, part.first_normal, count);
        for (stored, n) in normals.into_iter().zip(&vertices.normals) {
            let found = decode_normal(stored).map(f64::from);
            errors.normal = errors.normal.max(degrees(found, n.map(f64::from)));
        }
    }
    if part.first_uv != NONE_LONG {
        let stored: Vec<[u16; 2]> = if part.uv_bits == 8 {
            let small: Vec<[u8; 2]> = file.items(SectionKind::SmallUvs, part.first_uv, count);
            small.into_iter().map(|uv| uv.map(u16::from)).collect()
        } else {
            file.items(SectionKind::Uvs, part.first_uv, count)
        };
        let size = texture.unwrap_or([1; 2]);
        let least = |k: usize| vertices.uvs.iter().map(|uv| uv[k]).fold(f32::INFINITY, f32::min);
        // Whole textures are left out.
        let whole = [0, 1].map(|k| (float(part.uv_offset[k]) - f64::from(least(k))).round());
        for (stored, uv) in stored.into_iter().zip(&vertices.uvs) {
            for k in 0..2 {
                let found = float(part.uv_offset[k]) + f64::from(u32::from(stored[k]) << part.uv_shift) / 65_536.0;
                let off = (found - f64::from(uv[k]) - whole[k]).abs();
                errors.uv = errors.uv.max(off);
                errors.uv_texels = errors.uv_texels.max(off * f64::from(size[k]));
            }
        }
    }
    let white = [[255; 3]];
    let stored = mesh.data().colors.unwrap_or(&white);
    for (v, color) in vertices.colors.iter().enumerate() {
        let found = stored[v.min(stored.len() - 1)];
        for k in 0..3 {
            errors.color = errors.color.max((f64::from(found[k]) - 255.0 * f64::from(color[k].clamp(0.0, 1.0))).abs());
        }
    }
    Ok(())
}

/// Compares a pose, and notes the largest distance and the largest angle.
fn compare_pose(
    pose: &zstrip::model::Pose<'_>,
    import: &Import,
    pieces: &Pieces,
    nodes: &[u16],
    at: Option<(&Animation, f64)>,
    worst: &mut [f64; 2],
    errors: &mut Errors,
) {
    let exact = import.pose(at);
    for (number, range) in pieces.of_nodes.iter().enumerate() {
        let Some(to_model) = pose.node(nodes[number].into()) else { continue };
        let rows = to_model.to_rows().map(|row| row.map(float));
        let place = |p: Vector| rows.map(|[x, y, z, t]| x * p[0] + y * p[1] + z * p[2] + t);
        for part in Range::clone(range) {
            let (piece, Some(found)) = (&pieces.list[part], pose.mesh(part)) else { continue };
            let joints = piece.skin.map(|skin| import.joint_matrices(skin, &exact.world));
            let mesh = &import.meshes[piece.mesh];
            for (v, number_in_mesh) in piece.numbers.iter().enumerate() {
                let original = *number_in_mesh as usize;
                let expected = exact.vertex(number, mesh, original, joints.as_deref());
                let p = position(&found, v);
                let p = if piece.skin.is_some() { p } else { place(p) };
                worst[0] = worst[0].max(length(p, expected));
                if let Some(normals) = found.data().normals.filter(|_| piece.is_posed()) {
                    let normal = match piece.skin {
                        Some(_) => exact.normal(number, mesh, original, joints.as_deref()),
                        None => exact.morphed_normal(number, mesh, original),
                    };
                    worst[1] = worst[1].max(degrees(normals[v].map(f64::from), normal));
                }
            }
            errors.posed_vertices += if at.is_some() { piece.numbers.len() } else { 0 };
        }
    }
}
