//! Exact areas of paths in pixels, in f64: the plane is cut at vertices and crossings into slabs, in which no two edges
//! cross, and the integral of each trapezoid over each pixel is computed as a formula.

/// A contour, in pixels.
pub type Contour = Vec<[f64; 2]>;

#[derive(Clone, Copy)]
struct Edge {
    top: [f64; 2],
    bottom: [f64; 2],
    winding: i32,
}

impl Edge {
    fn at(&self, y: f64) -> f64 {
        let part = (y - self.top[1]) / (self.bottom[1] - self.top[1]);
        self.top[0] + (self.bottom[0] - self.top[0]) * part
    }
}

/// The integral of `u`, clamped to 0..=1, up to `u`.
fn integral(u: f64) -> f64 {
    if u <= 0.0 {
        0.0
    } else if u < 1.0 {
        u * u / 2.0
    } else {
        u - 0.5
    }
}

/// The mean of a linear function from `a` to `b`, clamped to 0..=1.
fn mean(a: f64, b: f64) -> f64 {
    if (a - b).abs() < 1e-9 { ((a + b) / 2.0).clamp(0.0, 1.0) } else { (integral(b) - integral(a)) / (b - a) }
}

/// The covered part of each pixel of a picture.
pub fn areas(contours: &[Contour], even_odd: bool, (width, height): (usize, usize)) -> Vec<f64> {
    let mut edges = Vec::new();
    for contour in contours {
        for (k, from) in contour.iter().enumerate() {
            let to = contour[(k + 1) % contour.len()];
            if from[1] < to[1] {
                edges.push(Edge { top: *from, bottom: to, winding: 1 });
            } else if from[1] > to[1] {
                edges.push(Edge { top: to, bottom: *from, winding: -1 });
            }
        }
    }
    let mut found = vec![0.0; width * height];
    for y in 0..height {
        let (top, bottom) = (y as f64, y as f64 + 1.0);
        let row: Vec<_> = edges.iter().filter(|edge| edge.top[1] < bottom && edge.bottom[1] > top).collect();
        let mut cuts = vec![top, bottom];
        for (k, a) in row.iter().enumerate() {
            cuts.extend([a.top[1], a.bottom[1]]);
            for b in &row[..k] {
                let (from, to) = (a.top[1].max(b.top[1]).max(top), a.bottom[1].min(b.bottom[1]).min(bottom));
                if from < to {
                    let (before, after) = (a.at(from) - b.at(from), a.at(to) - b.at(to));
                    if before * after < 0.0 {
                        cuts.push(from + (to - from) * before / (before - after));
                    }
                }
            }
        }
        cuts.retain(|cut| (top..=bottom).contains(cut));
        cuts.sort_by(f64::total_cmp);
        for slab in cuts.windows(2) {
            let (from, to) = (slab[0], slab[1]);
            if to - from < 1e-12 {
                continue;
            }
            let middle = (from + to) / 2.0;
            let mut order: Vec<_> = row.iter().filter(|e| e.top[1] <= middle && e.bottom[1] > middle).collect();
            order.sort_by(|a, b| a.at(middle).total_cmp(&b.at(middle)));
            let inside = |winding: i32| if even_odd { winding & 1 != 0 } else { winding != 0 };
            let mut winding = 0;
            for edge in order {
                let before = inside(winding);
                winding += edge.winding;
                if inside(winding) != before {
                    let sign = if before { -1.0 } else { 1.0 };
                    for x in 0..width {
                        let right = x as f64 + 1.0;
                        let part = mean(right - edge.at(from), right - edge.at(to));
                        found[y * width + x] += sign * part * (to - from);
                    }
                }
            }
        }
    }
    found
}

/// The worst and the mean difference between covered parts of 255ths and exact ones; the mean is over pixels that are
/// covered in part.
pub fn compare(found: &[u8], exact: &[f64]) -> (f64, f64, usize) {
    let (mut worst, mut sum, mut count, mut at) = (0_f64, 0.0, 0, 0);
    for (k, (found, exact)) in found.iter().zip(exact).enumerate() {
        let error = (f64::from(*found) / 255.0 - exact).abs();
        if error > worst {
            (worst, at) = (error, k);
        }
        if *exact > 1e-6 && *exact < 1.0 - 1e-6 {
            sum += error;
            count += 1;
        }
    }
    (worst, sum / f64::from(count.max(1)), at)
}
