//! Perspective-correct values of triangles and of lines, in f64 and straight from clip space: nothing is clipped,
//! divided or snapped.
//!
//! In: corners in [screen position times w](super::homogeneous::Viewport::screen_position), each with a value. Out: the
//! value of the surface, or of the line, that is seen at a place of the screen.
//!
//! ```text
//! triangle   Σ βᵢ (Xᵢ, Yᵢ, wᵢ) = w (px, py, 1), Σ βᵢ = 1        value = Σ βᵢ vᵢ
//! line       a + t (b - a) is at the place s along d:            value = v_a + t (v_b - v_a)
//!            d · (X, Y) - s w = 0, which is linear in t
//! ```
//! Both values are linear in space, which is what perspective-correct means.

/// A corner: x w, y w, w in px, and its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    pub at: [f64; 3],
    pub value: f64,
}

impl Corner {
    /// Returns the position on the screen; only for w > 0.
    pub fn on_screen(&self) -> [f64; 2] {
        let [x, y, w] = self.at;
        [x / w, y / w]
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns the value of the plane of a triangle that is seen at a point of the screen.
pub fn on_triangle(corners: &[Corner; 3], [x, y]: [f64; 2]) -> f64 {
    let weight = |k: usize| {
        let [a, b, c] = cross(corners[(k + 1) % 3].at, corners[(k + 2) % 3].at);
        a * x + b * y + c
    };
    let weights = [weight(0), weight(1), weight(2)];
    let sum: f64 = weights.iter().sum();
    (0..3).map(|k| weights[k] * corners[k].value).sum::<f64>() / sum
}

/// A line from the first corner to the second one, both of them anywhere, and the part of it that is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    pub ends: [Corner; 2],
}

impl Line {
    /// Returns the point at `t` of the way from end to end in space.
    pub fn at(&self, t: f64) -> Corner {
        let [a, b] = self.ends;
        let mix = |a: f64, b: f64| a + t * (b - a);
        Corner { at: [0, 1, 2].map(|k| mix(a.at[k], b.at[k])), value: mix(a.value, b.value) }
    }

    /// Returns the value at the point whose place along a direction of the screen is `place`.
    pub fn value(&self, direction: [f64; 2], place: f64) -> f64 {
        let [a, b] = self.ends.map(|end| {
            let [x, y, w] = end.at;
            direction[0] * x + direction[1] * y - place * w
        });
        self.at(a / (a - b)).value
    }
}
