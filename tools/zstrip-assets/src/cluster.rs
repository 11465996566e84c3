//! Groups triangles into clusters, orders them, and splits meshes that have too many vertices.

use meshopt::VertexDataAdapter;

use crate::geometry::{Vector, dot, face_normal, unit};
use crate::model::{Bounds, Cluster, Cone, Mesh, Vertices};
use crate::options::Options;
use crate::weld::compact;

/// The weight of triangles' directions, beside that of their distances, when they are grouped.
const CONE_WEIGHT: f32 = 0.5;

/// The most triangles around a vertex for which the best order is looked for.
const MOST_USES: u32 = 512;

/// Returns the triangles of each cluster.
pub(crate) fn group(unit_positions: &[[f32; 3]], triangles: &[[u32; 3]], options: &Options) -> Vec<Vec<[u32; 3]>> {
    let bytes = meshopt::typed_to_bytes(unit_positions);
    let vertices = match VertexDataAdapter::new(bytes, size_of::<[f32; 3]>(), 0) {
        Ok(vertices) if !triangles.is_empty() => vertices,
        _ => return Vec::new(),
    };
    let most = options.cluster_vertices.min(options.max_vertices);
    let meshlets = if is_crowded(triangles, unit_positions.len()) {
        meshopt::build_meshlets_scan(triangles.as_flattened(), unit_positions.len(), most, options.cluster_triangles)
    } else {
        let indices = meshopt::optimize_vertex_cache(triangles.as_flattened(), unit_positions.len());
        meshopt::build_meshlets(&indices, &vertices, most, options.cluster_triangles, CONE_WEIGHT)
    };
    let triangles = |meshlet: meshopt::Meshlet| {
        let local = meshlet.triangles.as_chunks::<3>().0.iter();
        local.map(|t| t.map(|k| meshlet.vertices[usize::from(k)])).collect()
    };
    meshlets.iter().map(triangles).collect()
}

/// Returns whether a vertex is in so many triangles that meshopt would look at their pairs for minutes. Their order in
/// the file has to do then.
fn is_crowded(triangles: &[[u32; 3]], count: usize) -> bool {
    let mut uses = vec![0u32; count];
    triangles.iter().flatten().for_each(|v| uses[*v as usize] += 1);
    uses.into_iter().any(|uses| uses > MOST_USES)
}

/// Puts clusters into meshes of at most `max_vertices` vertices.
pub(crate) fn split(vertices: &Vertices, clusters: &[Vec<[u32; 3]>], max_vertices: usize) -> Vec<Mesh> {
    let mut meshes = Vec::new();
    // The mesh in which a vertex was last seen, counted from 1.
    let mut seen = vec![0; vertices.len()];
    let (mut first, mut used) = (0, 0);
    for (k, cluster) in clusters.iter().enumerate() {
        let number = meshes.len() + 1;
        let mut fresh = distinct(cluster);
        fresh.retain(|v| seen[*v as usize] != number);
        if used + fresh.len() > max_vertices {
            meshes.push(mesh(vertices, &clusters[first..k]));
            (first, used) = (k, 0);
            fresh = distinct(cluster);
        }
        let number = meshes.len() + 1;
        fresh.iter().for_each(|v| seen[*v as usize] = number);
        used += fresh.len();
    }
    if first < clusters.len() {
        meshes.push(mesh(vertices, &clusters[first..]));
    }
    meshes
}

/// The vertices of triangles, each once.
fn distinct(triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut vertices = triangles.as_flattened().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

fn mesh(vertices: &Vertices, clusters: &[Vec<[u32; 3]>]) -> Mesh {
    let mut mesh = Mesh::default();
    for triangles in clusters {
        let corners = |t: &[u32; 3]| t.map(|v| vertices.positions[v as usize]);
        let nowhere = Bounds { min: [0.0; 3], max: [0.0; 3] };
        mesh.clusters.push(Cluster {
            first: mesh.triangles.len(),
            count: triangles.len(),
            vertices: distinct(triangles).len(),
            bounds: Bounds::around(triangles.iter().flat_map(corners)).unwrap_or(nowhere),
            cone: cone(&triangles.iter().filter_map(|t| face_normal(corners(t))).collect::<Vec<_>>()),
        });
        mesh.triangles.extend(triangles);
    }
    let all: Vec<u32> = (0..vertices.len() as u32).collect();
    mesh.vertices = compact(vertices, &mut mesh.triangles, &all);
    mesh
}

/// Steps of the search for the narrowest cone; the k-th one moves the axis by 1 / k.
const CONE_STEPS: u32 = 24;

/// A narrow cone that holds unit vectors: the middle of a small ball around them (Bădoiu and Clarkson 2003).
fn cone(normals: &[Vector]) -> Option<Cone> {
    let sum = normals.iter().fold([0.0; 3], |sum: Vector, n| std::array::from_fn(|k| sum[k] + n[k]));
    let mut middle = unit(sum)?;
    for step in 2..CONE_STEPS {
        let distance = |n: &Vector| -dot(middle, *n);
        let farthest = normals.iter().max_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        middle = std::array::from_fn(|k| middle[k] + (farthest[k] - middle[k]) / f64::from(step));
    }
    let axis = unit(middle)?.map(|x| x as f32);
    let least = normals.iter().map(|n| dot(axis.map(f64::from), *n)).fold(1.0, f64::min);
    // The axis is not quite of length 1, and the cosine is rounded: 1e-6 covers both.
    let cosine = (least - 1e-6) as f32;
    (cosine > 0.0).then_some(Cone { axis, cosine })
}
