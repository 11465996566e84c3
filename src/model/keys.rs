//! Keys of animation: values of nodes and weights at a time.

use super::container::{Channel, Clip as ClipItem, Interpolation, Path, Timeline};
use super::read::{Model, bounds_of, items};
use super::transform::{Local, ONE, arc, clamped};
use crate::math::mul_wide;
use crate::mesh::Bounds;

/// A clip of animation of a model.
#[derive(Clone, Copy, Debug)]
pub struct Clip<'a> {
    number: usize,
    item: &'a ClipItem,
    name: &'a [u8],
}

/// A clip at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Motion {
    clip: usize,
    /// Ticks, 16.16.
    tick: u32,
}

impl<'a> Model<'a> {
    /// Returns the clips of the model.
    pub fn clips(&self) -> impl Iterator<Item = Clip<'a>> {
        let model = *self;
        let clip = move |(number, item): (usize, &'a ClipItem)| Clip {
            number,
            item,
            name: model.name(item.name, item.name_length as usize),
        };
        self.clips.iter().enumerate().map(clip)
    }

    /// Returns the clip of a number.
    #[must_use]
    pub fn clip(&self, number: usize) -> Option<Clip<'a>> {
        self.clips().nth(number)
    }

    /// Returns the clip of a name.
    #[must_use]
    pub fn clip_named(&self, name: &str) -> Option<Clip<'a>> {
        self.clips().find(|clip| clip.name == name.as_bytes())
    }
}

impl<'a> Clip<'a> {
    /// Returns the name; empty if it is no UTF-8.
    #[must_use]
    pub fn name(&self) -> &'a str {
        core::str::from_utf8(self.name).unwrap_or_default()
    }

    /// Returns the duration in milliseconds.
    #[must_use]
    pub const fn duration(&self) -> u32 {
        self.item.duration
    }

    /// Returns the box around the model in all poses of the clip.
    #[must_use]
    pub const fn bounds(&self) -> Bounds {
        bounds_of(self.item.center, self.item.half)
    }

    /// Returns the clip after so many milliseconds, if it begins anew whenever it ends.
    #[must_use]
    pub fn looped(&self, milliseconds: u32) -> Motion {
        self.once(milliseconds.checked_rem(self.item.duration).unwrap_or(0))
    }

    /// Returns the clip after so many milliseconds; past its end, it stays as it ends.
    #[must_use]
    pub fn once(&self, milliseconds: u32) -> Motion {
        let duration = u64::from(self.item.duration.max(1));
        // At most 65,535 · 2¹⁶, from a product below 2⁶⁴.
        let tick = u64::from(milliseconds).min(duration) * (0xFFFF << 16) / duration;
        Motion { clip: self.number, tick: tick as u32 }
    }
}

/// A place between keys.
#[derive(Clone, Copy, Debug)]
struct Between {
    /// The key before.
    key: usize,
    /// Part of the way to the next key, 2.14; 0 from the last key on.
    factor: i32,
}

/// Returns the keys around a tick, 16.16.
fn between(times: &[u16], tick: u32) -> Between {
    let after = times.partition_point(|time| u32::from(*time) << 16 <= tick);
    let Some(key) = after.checked_sub(1) else { return Between { key: 0, factor: 0 } };
    let factor = match (times.get(key), times.get(after)) {
        (Some(from), Some(to)) => {
            let since = tick.wrapping_sub(u32::from(*from) << 16) >> 2;
            since.checked_div(u32::from(to.wrapping_sub(*from))).unwrap_or(0) as i32
        }
        _ => 0,
    };
    Between { key, factor }
}

/// Keys of a channel around a time.
#[derive(Clone, Copy)]
struct KeyPair<'a> {
    keys: &'a [i16],
    interpolation: Interpolation,
    /// Numbers of a value.
    numbers: usize,
    at: Between,
}

impl KeyPair<'_> {
    /// Returns number `n` of part `part` of a key: 0 and 2 are the tangents of a cubic key, 1 is its value.
    fn number(&self, key: usize, part: usize, n: usize) -> i32 {
        let value = match self.interpolation {
            Interpolation::Cubic => 3 * key + part,
            Interpolation::Linear | Interpolation::Step => key,
        };
        self.keys.get(value * self.numbers + n).copied().unwrap_or(0).into()
    }

    /// Returns number `n` of the value, times 2¹⁴.
    ///
    /// # Format
    /// Linear: 2¹⁵ · 2¹⁴, and a difference below 2¹⁶ times at most 2¹⁴. Cubic: the weights of the values are in 0..=1,
    /// those of the tangents at most 4/27, so the sum is below 1.3 · 2²⁹.
    fn value(&self, n: usize) -> i32 {
        let Between { key, factor: t } = self.at;
        let from = self.number(key, 1, n);
        if t == 0 || self.interpolation == Interpolation::Step {
            return from << 14;
        }
        let to = self.number(key + 1, 1, n);
        if self.interpolation == Interpolation::Linear {
            return (from << 14) + (to - from) * t;
        }
        let times = |a: i32, b: i32| (a * b + (1 << 13)) >> 14;
        let (t2, s) = (times(t, t), ONE - t);
        let s2 = times(s, s);
        // 3 t² - 2 t³, t (1 - t)², t² (1 - t).
        let (rise, leave, arrive) = (times(t2, 3 * ONE - 2 * t), times(t, s2), times(t2, s));
        let (out, into) = (self.number(key, 2, n), self.number(key + 1, 0, n));
        (from << 14) + (to - from) * rise + out * leave - into * arrive
    }

    /// Returns the rotation.
    fn rotation(&self) -> [i32; 4] {
        if self.interpolation == Interpolation::Linear && self.at.factor != 0 {
            let quaternion = |key| [0, 1, 2, 3].map(|n| clamped(self.number(key, 1, n)));
            return arc(&quaternion(self.at.key), &quaternion(self.at.key + 1), self.at.factor);
        }
        // Curves may leave the range of their keys, so half of it counts.
        [0, 1, 2, 3].map(|n| clamped((self.value(n) + (1 << 14)) >> 15))
    }

    /// Returns a translation or scale, 16.16, saturated.
    fn vector(&self, channel: &Channel) -> [i32; 3] {
        let along = |n: usize| {
            let moved = (mul_wide(self.value(n), channel.scale) + (1 << 28)) >> 29;
            let offset = channel.offset.get(n).copied().unwrap_or(0);
            (moved + i64::from(offset)).clamp(i32::MIN.into(), i32::MAX.into()) as i32
        };
        [along(0), along(1), along(2)]
    }
}

/// The channels of a clip at a time, on the way through the nodes in their order.
pub(super) struct Track<'a> {
    model: Model<'a>,
    /// Channels of nodes that are still to come, and of weights.
    channels: &'a [Channel],
    tick: u32,
    /// The timeline that was looked at last: channels often share one.
    last: Option<(u32, Between)>,
}

impl<'a> Track<'a> {
    pub(super) fn new(model: &Model<'a>, motion: Motion) -> Self {
        let channels = match model.clips.get(motion.clip) {
            Some(clip) => items(model.channels, clip.first_channel, clip.channels as usize),
            None => &[],
        };
        Self { model: *model, channels, tick: motion.tick, last: None }
    }

    fn keys_of(&mut self, channel: &Channel, numbers: usize) -> KeyPair<'a> {
        let at = match self.last {
            Some((timeline, at)) if timeline == channel.timeline => at,
            _ => {
                let line = self.model.timelines.get(channel.timeline as usize).copied();
                let Timeline { first_time, times } = line.unwrap_or(Timeline { first_time: 0, times: 0 });
                let at = between(items(self.model.times, first_time, times as usize), self.tick);
                self.last = Some((channel.timeline, at));
                at
            }
        };
        let keys = self.model.keys.get(channel.first_key as usize..).unwrap_or_default();
        let interpolation = Interpolation::of(channel.interpolation).unwrap_or(Interpolation::Step);
        KeyPair { keys, interpolation, numbers, at }
    }

    /// Changes the transform of a node by its channels. Nodes come in their order.
    pub(super) fn apply(&mut self, node: usize, local: &mut Local) {
        while let Some((channel, rest)) = self.channels.split_first() {
            if usize::from(channel.target) != node {
                return;
            }
            match Path::of(channel.path) {
                Some(Path::Translation) => local.translation = self.keys_of(channel, 3).vector(channel),
                Some(Path::Rotation) => local.rotation = self.keys_of(channel, 4).rotation(),
                Some(Path::Scale) => local.scale = self.keys_of(channel, 3).vector(channel),
                Some(Path::Weights) | None => return,
            }
            self.channels = rest;
        }
    }

    /// Returns a weight of a morph target, 2.14; `None` if no channel changes it. All nodes have come before.
    pub(super) fn weight(&mut self, number: usize) -> Option<i32> {
        let channels = self.channels;
        let place = |channel: &Channel| number.checked_sub(channel.target.into());
        let mut found = channels.iter().filter_map(|channel| Some((channel, place(channel)?)));
        let (channel, n) = found.find(|(channel, n)| *n < usize::from(channel.weights))?;
        let weight = (self.keys_of(channel, channel.weights.into()).value(n) + (1 << 13)) >> 14;
        Some(weight.clamp(-0x7FFF, 0x7FFF))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Rng;
    use std::println;

    #[test]
    fn places_between_keys_are_those_of_a_search() {
        let times = [0, 10, 11, 4000, 65_535];
        for tick in [0, 1, 10 << 16, (10 << 16) + 1, 11 << 16, 3999 << 16, 4000 << 16, 65_534 << 16, 65_535 << 16] {
            let at = between(&times, tick);
            let exact = f64::from(tick) / 65_536.0;
            let key = (0..5).rev().find(|k| f64::from(times[*k]) <= exact).expect("a key");
            assert_eq!(at.key, key, "{tick}");
            let factor = if key == 4 {
                0.0
            } else {
                (exact - f64::from(times[key])) / (f64::from(times[key + 1]) - f64::from(times[key]))
            };
            assert!((f64::from(at.factor) / 16_384.0 - factor).abs() < 1.0 / 16_384.0, "{tick}");
        }
        // Before the first key, and without keys.
        assert_eq!(between(&[5, 9], 0).key, 0);
        assert_eq!(between(&[], 7).key, 0);
    }

    #[test]
    fn values_are_those_of_their_curves() {
        let mut rng = Rng::new(5);
        let mut worst = [0.0_f64; 3];
        for _ in 0..50_000 {
            let keys: [i16; 6] = core::array::from_fn(|_| rng.next_u64() as i16);
            let factor = rng.below(ONE as u64) as i32;
            let t = f64::from(factor) / f64::from(ONE);
            let f = keys.map(f64::from);
            let curves = [
                (Interpolation::Linear, f[0] + (f[1] - f[0]) * t),
                (Interpolation::Step, f[0]),
                (
                    Interpolation::Cubic,
                    f[1] * (1.0 - t * t * (3.0 - 2.0 * t))
                        + f[4] * t * t * (3.0 - 2.0 * t)
                        + f[2] * t * (1.0 - t) * (1.0 - t)
                        - f[3] * t * t * (1.0 - t),
                ),
            ];
            for (worst, (interpolation, exact)) in worst.iter_mut().zip(curves) {
                let pair = KeyPair { keys: &keys, interpolation, numbers: 1, at: Between { key: 0, factor } };
                *worst = worst.max((f64::from(pair.value(0)) / 16_384.0 - exact).abs());
            }
        }
        println!("worst value off by {worst:.3?} of a key's steps: linear, step, cubic");
        assert!(worst[0] == 0.0 && worst[1] == 0.0, "{worst:?}");
        // The weights of the curve are within 2⁻¹⁴ or two of them, of values of 15 bits.
        assert!(worst[2] < 12.0, "{worst:?}");
    }
}
