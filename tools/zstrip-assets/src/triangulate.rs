//! Divides polygons into triangles.
//!
//! In: the corners of a polygon in space, nearly in one plane, concave or not. Out: triangles of the same winding that
//! cover it. All corners are in use, also those in the middle of a straight side: a neighbour may have a corner there,
//! and without one here, pixels could show through between the two.

use earcut::Earcut;
use earcut::utils3d::project3d_to_2d;

use crate::report::{Note, Report};

/// The most corners of a polygon; the time that it takes grows with their square in the worst case.
pub(crate) const MOST_CORNERS: usize = 10_000;

/// Divides polygons, and counts them.
#[derive(Default)]
pub struct Triangulator {
    earcut: Earcut<f64>,
    flat: Vec<[f64; 2]>,
    ears: Vec<u32>,
    polygons: usize,
    crossed: usize,
}

impl Triangulator {
    /// Divides a polygon; triangles number its corners.
    ///
    /// A polygon that crosses itself, or has no plane, is divided as a fan. One of less than three corners has no
    /// triangles.
    pub fn divide(&mut self, corners: &[[f32; 3]]) -> Vec<[u32; 3]> {
        let count = corners.len() as u32;
        match count {
            0..3 => return Vec::new(),
            3 => return vec![[0, 1, 2]],
            _ => self.polygons += 1,
        }
        self.ears_of(corners).unwrap_or_else(|| {
            self.crossed += 1;
            (2..count).map(|k| [0, k - 1, k]).collect()
        })
    }

    fn ears_of(&mut self, corners: &[[f32; 3]]) -> Option<Vec<[u32; 3]>> {
        // In units of the polygon's size and from one of its corners, so that no number is too large or too small.
        let size = corners.iter().flatten().zip(corners[0].iter().cycle());
        let size = size.fold(0.0, |size: f64, (x, from)| size.max((f64::from(*x) - f64::from(*from)).abs()));
        if size == 0.0 {
            return None;
        }
        let unit = |k: usize, x: f32| (f64::from(x) - f64::from(corners[0][k])) / size;
        let solid: Vec<[f64; 3]> = corners.iter().map(|p| std::array::from_fn(|k| unit(k, p[k]))).collect();
        if !project3d_to_2d(&solid, solid.len(), &mut self.flat) {
            return None;
        }
        self.earcut.earcut_slice(&self.flat, &[], &mut self.ears);
        let mut triangles: Vec<[u32; 3]> = self.ears.as_chunks::<3>().0.to_vec();

        let flat = &self.flat;
        let ring = (0..flat.len()).map(|k| flat[k]).zip((1..=flat.len()).map(|k| flat[k % flat.len()]));
        let area: f64 = ring.map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
        let mut covered = 0.0;
        for triangle in &mut triangles {
            let [a, b, c] = triangle.map(|k| flat[k as usize]);
            let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            if (twice < 0.0) != (area < 0.0) {
                triangle.swap(1, 2);
            }
            covered += twice.abs();
        }
        if (covered - area.abs()).abs() > 1e-6 * area.abs() {
            return None;
        }
        insert_left_out(&mut triangles, flat.len()).then_some(triangles)
    }

    /// Reports how many polygons were divided.
    pub(crate) fn report(&self, report: &mut Report) {
        report.add(Note::Triangulated { polygons: self.polygons });
        report.add(Note::Crossed { polygons: self.crossed });
    }
}

/// Gives corners that no triangle uses to the triangle at their side of the polygon; returns whether all find one.
fn insert_left_out(triangles: &mut Vec<[u32; 3]>, count: usize) -> bool {
    let mut used = vec![false; count];
    triangles.iter().flatten().for_each(|k| used[*k as usize] = true);
    let Some(first) = used.iter().position(|used| *used) else { return false };
    let mut before = first;
    let mut left_out = Vec::new();
    for k in (first + 1..=first + count).map(|k| k % count) {
        if !used[k] {
            left_out.push(k as u32);
            continue;
        }
        if !left_out.is_empty() {
            let (a, b) = (before as u32, k as u32);
            let side = |t: &[u32; 3]| (0..3).find(|s| t[*s] == a && t[(*s + 1) % 3] == b);
            let Some((at, s)) = triangles.iter().enumerate().find_map(|(at, t)| Some((at, side(t)?))) else {
                return false;
            };
            let apex = triangles[at][(s + 2) % 3];
            triangles[at] = [a, left_out[0], apex];
            let ends = left_out[1..].iter().copied().chain([b]);
            triangles.extend(left_out.iter().zip(ends).map(|(from, to)| [*from, to, apex]));
            left_out.clear();
        }
        before = k;
    }
    true
}
