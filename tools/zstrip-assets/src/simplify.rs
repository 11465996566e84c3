//! Reduces the number of triangles.

use meshopt::{SimplifyOptions, VertexDataAdapter};

/// Returns the triangles that are left, near `target` of them, and how far the surface moved, as a part of the mesh's
/// size.
///
/// Vertices stay where they are; some are not used any more. Seams of texture coordinates stay too, so a mesh with many
/// of them may keep more triangles than the target. It is then simplified across seams, and loses parts that are
/// small.
///
/// Vertices that are locked stay in use.
pub(crate) fn simplify(
    unit_positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
    locks: &[bool],
    target: usize,
) -> (Vec<[u32; 3]>, f32) {
    let bytes = meshopt::typed_to_bytes(unit_positions);
    let Ok(vertices) = VertexDataAdapter::new(bytes, size_of::<[f32; 3]>(), 0) else {
        return (triangles.to_vec(), 0.0);
    };
    let attempt = |options| {
        let mut error = 0.0;
        let corners = triangles.as_flattened();
        let left = meshopt::simplify_with_locks(corners, &vertices, locks, 3 * target, 1.0, options, Some(&mut error));
        (left.as_chunks::<3>().0.to_vec(), error)
    };
    let kept = attempt(SimplifyOptions::None);
    if kept.0.len() <= target {
        return kept;
    }
    let crossing = attempt(SimplifyOptions::Permissive | SimplifyOptions::Prune);
    if crossing.0.is_empty() || crossing.0.len() >= kept.0.len() { kept } else { crossing }
}
