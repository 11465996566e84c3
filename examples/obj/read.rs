//! Reads OBJ files, frames them, and writes the words that firmware draws them from.

use super::{FIELD_OF_VIEW, HEIGHT, MAGIC, MOST, WIDTH};
use std::collections::HashMap;
use std::hash::Hash;
use std::io::ErrorKind;
use std::path::Path;

/// Part of the screen, from its middle to an edge, that the model reaches at most.
const REACH: f64 = 0.95;
/// Turns about y and then about x, in radians.
const YAW: f64 = 0.5;
const PITCH: f64 = 0.35;

type Vector = [f64; 3];

/// Corner of a triangle: numbers of its position, its normal and its texture coordinates.
type Corner = [u32; 3];

/// A file's triangles, as they are.
#[derive(Default)]
struct Triangles {
    positions: Vec<Vector>,
    normals: Vec<Vector>,
    uvs: Vec<[f64; 2]>,
    corners: Vec<[Corner; 3]>,
    /// Set if all corners have them.
    has_normals: bool,
    has_uvs: bool,
}

/// Reads a file, and returns the words of the model.
pub fn read(path: &Path) -> Result<Vec<u32>, String> {
    let name = path.display();
    let triangles = triangles(path).map_err(|error| format!("{name}: {error}"))?;
    words(&triangles).map_err(|error| format!("{name}: {error}"))
}

/// Numbers things in the order in which they come first.
struct Numbers<K>(HashMap<K, u32>);

impl<K: Hash + Eq> Numbers<K> {
    fn number(&mut self, key: K) -> (u32, bool) {
        let next = self.0.len() as u32;
        let number = *self.0.entry(key).or_insert(next);
        (number, number == next)
    }
}

fn triangles(path: &Path) -> Result<Triangles, String> {
    let text = std::fs::read(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => "there is no such file".to_owned(),
        _ => error.to_string(),
    })?;
    if text.is_empty() {
        return Err("the file is empty".to_owned());
    }
    let options =
        tobj::LoadOptions { triangulate: true, ignore_points: true, ignore_lines: true, ..Default::default() };
    // Colours come from the benchmark: files of materials are not read.
    let no_materials = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut text.as_slice(), &options, no_materials)
        .map_err(|error| format!("{error}: is it a Wavefront OBJ file?"))?;

    let mut all = Triangles { has_normals: true, has_uvs: true, ..Triangles::default() };
    let (mut positions, mut uvs) = (Numbers(HashMap::new()), Numbers(HashMap::new()));
    let mut normals = Numbers(HashMap::new());
    for tobj::Model { mesh, .. } in models {
        let corners = mesh.indices.len();
        let has_normals = corners == mesh.normal_indices.len();
        let has_uvs = corners == mesh.texcoord_indices.len();
        all.has_normals &= has_normals;
        all.has_uvs &= has_uvs;
        // Equal positions are one, wherever they stand in the file.
        let corner = |k: usize| -> Corner {
            let at = |values: &[f32], index: u32, part: usize| values[index as usize * part..][..part].to_vec();
            let v: Vector = at(&mesh.positions, mesh.indices[k], 3).try_into_f64();
            let (position, is_new) = positions.number(v.map(f64::to_bits));
            if is_new {
                all.positions.push(v);
            }
            let mut corner = [position, 0, 0];
            if has_normals {
                let v: Vector = at(&mesh.normals, mesh.normal_indices[k], 3).try_into_f64();
                let (normal, is_new) = normals.number(v.map(f64::to_bits));
                if is_new {
                    all.normals.push(v);
                }
                corner[1] = normal;
            }
            if has_uvs {
                let v: [f64; 2] = at(&mesh.texcoords, mesh.texcoord_indices[k], 2).try_into_f64();
                let (uv, is_new) = uvs.number(v.map(f64::to_bits));
                if is_new {
                    all.uvs.push(v);
                }
                corner[2] = uv;
            }
            corner
        };
        let corners: Vec<_> = (0..corners).map(corner).collect();
        all.corners.extend(corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]));
    }
    if all.corners.is_empty() {
        return Err("there are no faces in it: is it a Wavefront OBJ file?".to_owned());
    }
    let numbers = all.positions.iter().chain(&all.normals).flatten().chain(all.uvs.iter().flatten());
    if numbers.into_iter().any(|x| !x.is_finite()) {
        return Err("a coordinate is not a finite number".to_owned());
    }
    Ok(all)
}

/// Conversion of a few floats.
trait ToDoubles<const N: usize> {
    fn try_into_f64(self) -> [f64; N];
}

impl<const N: usize> ToDoubles<N> for Vec<f32> {
    fn try_into_f64(self) -> [f64; N] {
        // -0.0 becomes 0.0: both are one position.
        std::array::from_fn(|k| f64::from(self[k]) + 0.0)
    }
}

fn words(model: &Triangles) -> Result<Vec<u32>, String> {
    let triangles = model.corners.len();
    if triangles > MOST {
        return Err(format!("{triangles} triangles; a mesh has at most {MOST}: split the model, or reduce it"));
    }
    let (middle, half) = cube(&model.positions);
    if half == 0.0 {
        return Err("all of its points are one".to_owned());
    }
    let points: Vec<Vector> = model.positions.iter().map(|p| scaled(minus(*p, middle), 1.0 / half)).collect();
    let face_normals: Vec<Vector> = model.corners.iter().map(|corners| normal(&points, corners)).collect();
    let mut smooth: Vec<Vector> = vec![[0.0; 3]; points.len()];
    for (corners, n) in model.corners.iter().zip(&face_normals) {
        for [position, ..] in corners {
            let sum = &mut smooth[*position as usize];
            *sum = [0, 1, 2].map(|k| sum[k] + n[k]);
        }
    }
    let normal_of = |&[position, normal, _]: &Corner| {
        if model.has_normals { model.normals[normal as usize] } else { smooth[position as usize] }
    };

    let turned: Vec<Vector> = points.iter().map(|p| rotated(*p)).collect();
    let distance = distance(&turned);
    let deepest = turned.iter().fold(0.0_f64, |most, [_, _, z]| most.max(z.abs())) + 0.01;
    let mut words = vec![MAGIC, fixed(distance - deepest), fixed(distance + deepest)];
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(rotated);
    for k in 0..3 {
        words.extend([x[k], y[k], z[k], if k == 2 { -distance } else { 0.0 }].map(fixed));
    }

    let mut meshes = vec![Welded::new(&model.corners, |[position, ..]| [position, 0, 0])];
    meshes.push(Welded::new(&model.corners, |[position, normal, _]| [position, normal, 0]));
    if model.has_uvs {
        meshes.push(Welded::new(&model.corners, |corner| corner));
    }
    for k in 0..3 {
        let vertices = meshes.get(k).map_or(0, |mesh| mesh.vertices.len());
        if vertices > MOST {
            let what = ["positions", "pairs of a position and a normal", "positions with texture coordinates"][k];
            return Err(format!(
                "{vertices} vertices ({what}); a mesh has at most {MOST}: split the model, or reduce it"
            ));
        }
        words.extend([vertices as u32, if vertices > 0 { triangles as u32 } else { 0 }]);
    }
    for (k, mesh) in meshes.iter().enumerate() {
        halves(&mut words, mesh.vertices.iter().flat_map(|c| quantized(points[c[0] as usize])));
        if k > 0 {
            halves(&mut words, mesh.vertices.iter().flat_map(|c| unit(normal_of(c))));
        }
        if k == 2 {
            words.extend(mesh.vertices.iter().flat_map(|c| {
                let [u, v] = model.uvs[c[2] as usize];
                [fixed(u), fixed(1.0 - v)]
            }));
        }
        halves(&mut words, mesh.indices.iter().copied());
        if k == 0 {
            halves(&mut words, face_normals.iter().flat_map(|n| unit(*n)));
        }
    }
    Ok(words)
}

/// A mesh whose vertices are the different corners, as far as they count.
struct Welded {
    vertices: Vec<Corner>,
    indices: Vec<u16>,
}

impl Welded {
    fn new(corners: &[[Corner; 3]], key: impl Fn(Corner) -> Corner) -> Self {
        let mut numbers = Numbers(HashMap::new());
        let (mut vertices, mut indices) = (Vec::new(), Vec::new());
        for corner in corners.as_flattened() {
            let (number, is_new) = numbers.number(key(*corner));
            if is_new {
                vertices.push(*corner);
            }
            // Too many of them are an error of the caller's.
            indices.push(number as u16);
        }
        Self { vertices, indices }
    }
}

/// Returns the middle of the bounding box and half of its longest side.
fn cube(points: &[Vector]) -> (Vector, f64) {
    let end = |k: usize, pick: fn(f64, f64) -> f64| points.iter().map(|p| p[k]).reduce(pick).unwrap_or(0.0);
    let (low, high) = ([0, 1, 2].map(|k| end(k, f64::min)), [0, 1, 2].map(|k| end(k, f64::max)));
    let half = minus(high, low).into_iter().fold(0.0, f64::max) / 2.0;
    ([0, 1, 2].map(|k| (low[k] + high[k]) / 2.0), half)
}

/// Returns the least distance at which the model is on the screen and does not reach the eye.
fn distance(turned: &[Vector]) -> f64 {
    let up = (f64::from(FIELD_OF_VIEW) / 2.0).to_radians().tan() * REACH;
    let across = up * WIDTH as f64 / HEIGHT as f64;
    turned.iter().fold(0.0_f64, |most, [x, y, z]| {
        let here = (x.abs() / across).max(y.abs() / up).max(0.25) + z;
        most.max(here)
    })
}

/// Turns a point or a direction.
fn rotated([x, y, z]: Vector) -> Vector {
    let ((sy, cy), (sx, cx)) = (YAW.sin_cos(), PITCH.sin_cos());
    let (x, z) = (cy * x + sy * z, cy * z - sy * x);
    [x, cx * y - sx * z, sx * y + cx * z]
}

fn minus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn scaled(v: Vector, by: f64) -> Vector {
    v.map(|c| c * by)
}

/// Returns the normal of a triangle that goes round against the clock, twice as long as its area.
fn normal(points: &[Vector], corners: &[Corner; 3]) -> Vector {
    let [a, b, c] = corners.map(|[position, ..]| points[position as usize]);
    let (u, v) = (minus(b, a), minus(c, a));
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// Returns a direction in 2.14; zero for a vector without length.
fn unit(v: Vector) -> [u16; 3] {
    let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
    if length == 0.0 { [0; 3] } else { v.map(|c| (c / length * 16_384.0).round() as i16 as u16) }
}

fn quantized(v: Vector) -> [u16; 3] {
    v.map(|c| (c * 32_768.0).round() as i16 as u16)
}

/// Returns a number in 16.16, cut to its range.
fn fixed(x: f64) -> u32 {
    (x * 65_536.0).round() as i32 as u32
}

/// Appends numbers of 16 bits, padded to words.
fn halves(words: &mut Vec<u32>, numbers: impl Iterator<Item = u16>) {
    let numbers: Vec<u16> = numbers.collect();
    let pair = |pair: &[u16]| u32::from(pair[0]) | u32::from(pair.get(1).copied().unwrap_or(0)) << 16;
    words.extend(numbers.chunks(2).map(pair));
}
