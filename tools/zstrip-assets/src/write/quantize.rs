//! Numbers of the container from floats.

use super::report::WriteError;
use crate::geometry::{Vector, dot, unit};

/// The largest absolute value of a 16.16 number that is written.
pub(super) const MOST: f64 = 32_767.0;

/// Returns a 16.16 number, rounded.
pub(super) fn fixed(x: f64, place: impl Fn() -> String) -> Result<i32, WriteError> {
    if !x.is_finite() {
        return Err(WriteError::NotFinite { place: place() });
    }
    if x.abs() > MOST {
        return Err(WriteError::Range { place: place(), found: x, most: MOST });
    }
    Ok((x * 65_536.0).round() as i32)
}

/// Returns the number that a 16.16 number stands for.
pub(super) fn float(x: i32) -> f64 {
    f64::from(x) / 65_536.0
}

/// A box that grows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub low: Vector,
    pub high: Vector,
}

impl Extent {
    pub const EMPTY: Self = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };

    pub fn add(&mut self, p: Vector) {
        for ((low, high), c) in self.low.iter_mut().zip(&mut self.high).zip(p) {
            (*low, *high) = (low.min(c), high.max(c));
        }
    }

    pub fn join(&mut self, other: &Self) {
        if other.low[0] <= other.high[0] {
            self.add(other.low);
            self.add(other.high);
        }
    }

    /// Returns the largest of its sides.
    pub fn size(&self) -> f64 {
        (0..3).map(|k| self.high[k] - self.low[k]).fold(0.0, f64::max)
    }

    /// Returns middle and half size, 16.16, rounded outwards.
    pub fn rounded(&self, place: &str) -> Result<([i32; 3], [i32; 3]), WriteError> {
        let (mut center, mut half) = ([0; 3], [0; 3]);
        if self.low[0] > self.high[0] {
            return Ok((center, half));
        }
        for k in 0..3 {
            center[k] = fixed((self.low[k] + self.high[k]) / 2.0, || place.to_owned())?;
            let middle = float(center[k]);
            let reach = (self.high[k] - middle).max(middle - self.low[k]);
            fixed(reach, || place.to_owned())?;
            half[k] = (reach * 65_536.0).ceil() as i32;
        }
        Ok((center, half))
    }
}

/// The cube whose fractions, 1.15, positions are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cube {
    /// 16.16: the distance that 32,768 would stand for.
    pub scale: i32,
    /// 16.16.
    pub offset: [i32; 3],
}

impl Cube {
    /// Returns the smallest cube for a box, and for moves of some length.
    ///
    /// A position in the box is at most 32,767 steps from the middle, so it is off by half a step at most.
    pub fn around(extent: &Extent, longest: f64, place: &str) -> Result<Self, WriteError> {
        let (offset, half) = extent.rounded(place)?;
        let reach = f64::from(half.into_iter().max().unwrap_or(0)).max(longest * 65_536.0);
        let scale = (reach * 32_768.0 / 32_767.0).ceil().max(1.0);
        fixed(scale / 65_536.0, || place.to_owned())?;
        Ok(Self { scale: scale as i32, offset })
    }

    /// Returns the length of a step.
    pub fn step(&self) -> f64 {
        float(self.scale) / 32_768.0
    }

    pub fn point(&self, p: Vector) -> [i16; 3] {
        std::array::from_fn(|k| ((p[k] - float(self.offset[k])) / self.step()).round() as i16)
    }

    /// Returns a difference of positions in steps.
    pub fn delta(&self, d: Vector) -> [i16; 3] {
        d.map(|d| (d / self.step()).round() as i16)
    }
}

/// Returns middle and half size of the box around points, in fractions.
pub(super) fn fraction_box(points: impl Iterator<Item = [i16; 3]>) -> ([i16; 3], [u16; 3]) {
    let (mut low, mut high) = ([i16::MAX; 3], [i16::MIN; 3]);
    for point in points {
        for k in 0..3 {
            (low[k], high[k]) = (low[k].min(point[k]), high[k].max(point[k]));
        }
    }
    if low[0] > high[0] {
        return ([0; 3], [0; 3]);
    }
    let center: [i16; 3] = std::array::from_fn(|k| ((i32::from(low[k]) + i32::from(high[k])) >> 1) as i16);
    (center, std::array::from_fn(|k| center[k].abs_diff(low[k]).max(center[k].abs_diff(high[k]))))
}

/// Returns the direction that two bytes stand for: the definition of the container.
pub(super) fn octahedral(bytes: [i8; 2]) -> Vector {
    let [x, y] = bytes.map(|c| f64::from(c).max(-127.0));
    let z = 127.0 - x.abs() - y.abs();
    let sign = |c: f64| if c < 0.0 { -1.0 } else { 1.0 };
    let p = if z < 0.0 { [(127.0 - y.abs()) * sign(x), (127.0 - x.abs()) * sign(y), z] } else { [x, y, z] };
    unit(p).unwrap_or([0.0, 0.0, 1.0])
}

/// Returns the two bytes nearest to a direction.
pub(super) fn normal_bytes(n: Vector) -> [i8; 2] {
    let Some(n) = unit(n) else { return [0, 0] };
    let sum: f64 = n.iter().map(|c| c.abs()).sum();
    let sign = |c: f64| if c < 0.0 { -1.0 } else { 1.0 };
    let [x, y] = [n[0] / sum, n[1] / sum];
    let [x, y] = if n[2] < 0.0 { [(1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y)] } else { [x, y] };
    let around = |c: f64| [(c * 127.0).floor(), (c * 127.0).ceil()].map(|c| c as i8);
    let candidates = around(x).into_iter().flat_map(|x| around(y).map(|y| [x, y]));
    candidates.max_by(|a, b| dot(octahedral(*a), n).total_cmp(&dot(octahedral(*b), n))).unwrap_or([0, 0])
}

/// Returns the angle between two directions, in degrees.
pub(super) fn degrees(a: Vector, b: Vector) -> f64 {
    let (Some(a), Some(b)) = (unit(a), unit(b)) else { return 0.0 };
    let apart: Vector = std::array::from_fn(|k| a[k] - b[k]);
    2.0 * (dot(apart, apart).sqrt() / 2.0).min(1.0).asin().to_degrees()
}
