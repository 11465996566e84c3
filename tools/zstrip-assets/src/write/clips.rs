//! Clips: channels of keys, with as few keys as the error allows, quantized.

use std::collections::HashMap;
use std::ops::Range;

use bytemuck::Zeroable;
use zstrip::model::container::{
    Channel as ChannelItem, Clip, Interpolation as InterpolationItem, Path as PathItem, SectionKind, Timeline,
};

use super::options::WriteOptions;
use super::quantize::{Extent, MOST, fixed, float};
use super::report::{WriteError, WriteNote, WriteReport};
use super::sections::Sections;
use crate::model::{Animation, Channel, Import, Interpolation, Path, Transform};
use crate::pose::{mix, sample, slerp};

/// The last tick of a clip.
const LAST_TICK: f64 = 65_535.0;

/// Keys that are looked at together when some are left out: it bounds the time, which grows with their square.
const CHUNK: usize = 512;

/// Pieces that the time between two keys is cut into where a curve cannot be kept.
const PIECES: usize = 16;

/// Keys of a channel, in ticks.
struct Track {
    times: Vec<u16>,
    /// One value per key, three of them for cubic keys: tangents are those of the whole time between keys.
    values: Vec<Vec<f64>>,
    interpolation: Interpolation,
}

/// The model that clips move.
pub(super) struct Moved<'a> {
    pub import: &'a Import,
    /// Its largest side.
    pub size: f64,
    /// Numbers of nodes in the container.
    pub nodes: &'a [u16],
    /// Weights of morph targets of each node.
    pub weights: &'a [Range<usize>],
}

/// Writes all clips. `bounds` is asked for the box of each.
pub(super) fn clips(
    moved: &Moved<'_>,
    options: &WriteOptions,
    bounds: impl Fn(&Animation) -> Extent,
    to: &mut Sections,
    report: &mut WriteReport,
) -> Result<(), WriteError> {
    let Moved { import, size, nodes, weights } = *moved;
    let mut timelines: HashMap<Vec<u16>, u32> = HashMap::new();
    let [mut merged, mut cut, mut limited, mut dropped] = [0; 4];
    for (k, animation) in import.animations.iter().enumerate() {
        let first_channel = to.count(SectionKind::Channels);
        let duration = f64::from(animation.duration()).max(0.0);
        let mut channels: Vec<&Channel> = animation.channels.iter().collect();
        channels.sort_by_key(|channel| (channel.path == Path::Weights, nodes[channel.node], channel.path as u8));
        let (mut before, mut after) = (0, 0);
        for channel in channels {
            let node = &import.nodes[channel.node];
            let width = channel.width();
            let expected = match channel.path {
                Path::Translation | Path::Scale => 3,
                Path::Rotation => 4,
                Path::Weights => weights[channel.node].len(),
            };
            let is_matrix = matches!(node.transform, Transform::Matrix(_)) && channel.path != Path::Weights;
            if channel.times.is_empty() || width == 0 || width != expected || is_matrix {
                dropped += 1;
                continue;
            }
            before += channel.times.len();
            let place = format!("animations[{k}] {:?} of nodes[{}]", channel.path, channel.node);
            if channel.times.iter().chain(&channel.values).any(|x| !x.is_finite()) {
                return Err(WriteError::NotFinite { place });
            }
            let mut track = Track::of(channel, duration, &mut merged, &mut cut);
            track.reduce(channel.path, tolerance(channel.path, options.key_error, size));
            if track.is_at_rest(channel, import, tolerance(channel.path, options.key_error, size)) {
                continue;
            }
            after += track.times.len();
            let count = track.times.len() as u32;
            let timeline = *timelines.entry(track.times.clone()).or_insert_with(|| {
                let first_time = to.add(SectionKind::Times, &track.times);
                to.add(SectionKind::Timelines, &[Timeline { first_time, times: count }])
            });
            let (item, keys) = track.quantized(channel.path, &place, &mut limited)?;
            let first_key = to.add(SectionKind::Keys, &keys);
            let (target, of_target) = match channel.path {
                Path::Weights => (weights[channel.node].start as u16, width as u16),
                _ => (nodes[channel.node], 0),
            };
            to.add(SectionKind::Channels, &[ChannelItem { timeline, first_key, target, weights: of_target, ..item }]);
        }
        let (center, half) = bounds(animation).rounded(&format!("the box of animations[{k}]"))?;
        let milliseconds = milliseconds(animation);
        let item = Clip {
            first_channel,
            channels: to.count(SectionKind::Channels) - first_channel,
            duration: milliseconds,
            name: to.add(SectionKind::Bytes, animation.name.as_bytes()),
            name_length: animation.name.len() as u32,
            center,
            half,
        };
        to.add(SectionKind::Clips, &[item]);
        report.clips.push((animation.name.clone(), milliseconds, before, after));
    }
    report.note(merged, |keys| WriteNote::KeysMerged { keys });
    report.note(cut, |channels| WriteNote::CurvesCut { channels });
    report.note(limited, |weights| WriteNote::WeightsLimited { weights });
    report.note(dropped, |channels| WriteNote::ChannelsDropped { channels });
    Ok(())
}

/// Returns the duration of a clip in milliseconds.
pub(super) fn milliseconds(animation: &Animation) -> u32 {
    (f64::from(animation.duration()) * 1000.0).round().clamp(1.0, f64::from(u32::MAX)) as u32
}

/// Returns the error that a key may have: a distance, an angle in radians, or a factor.
fn tolerance(path: Path, error: f64, size: f64) -> f64 {
    if path == Path::Translation { error * size } else { error }
}

/// Returns how far two values are apart: a distance, or twice the angle between quaternions, or the largest difference.
fn distance(path: Path, a: &[f64], b: &[f64]) -> f64 {
    let apart = |sign: f64| a.iter().zip(b).map(|(a, b)| (a - sign * b).powi(2)).sum::<f64>().sqrt();
    match path {
        Path::Translation => apart(1.0),
        // The chord between unit quaternions is about half the angle of the rotation between them.
        Path::Rotation => 2.0 * apart(1.0).min(apart(-1.0)),
        Path::Scale | Path::Weights => a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max),
    }
}

impl Track {
    fn of(channel: &Channel, duration: f64, merged: &mut usize, cut: &mut usize) -> Self {
        let width = channel.width();
        let tick = |time: f64| {
            if duration > 0.0 { (time.max(0.0) / duration * LAST_TICK).round().min(LAST_TICK) } else { 0.0 }
        };
        let seconds = |k: usize| f64::from(channel.times[k]);
        let is_cubic = channel.interpolation == Interpolation::Cubic;
        let mut track = Self { times: Vec::new(), values: Vec::new(), interpolation: channel.interpolation };
        if is_cubic && is_steep(channel) {
            *cut += 1;
            track.interpolation = Interpolation::Linear;
            for k in 0..channel.times.len() {
                let next = if k + 1 < channel.times.len() { seconds(k + 1) } else { seconds(k) };
                let pieces = if next > seconds(k) { PIECES } else { 1 };
                for piece in 0..pieces {
                    let time = seconds(k) + (next - seconds(k)) * piece as f64 / pieces as f64;
                    track.push(tick(time) as u16, vec![sample(channel, time)]);
                }
            }
            return track;
        }
        for k in 0..channel.times.len() {
            let part = |part: usize, factor: f64| -> Vec<f64> {
                let value = if is_cubic { 3 * k + part } else { k };
                channel.values[value * width..][..width].iter().map(|x| f64::from(*x) * factor).collect()
            };
            let value = if is_cubic {
                let since = if k > 0 { seconds(k) - seconds(k - 1) } else { 0.0 };
                let until = if k + 1 < channel.times.len() { seconds(k + 1) - seconds(k) } else { 0.0 };
                vec![part(0, since), part(1, 1.0), part(2, until)]
            } else {
                vec![part(0, 1.0)]
            };
            *merged += usize::from(track.push(tick(seconds(k)) as u16, value));
        }
        track
    }

    /// Appends a key, and returns whether it took the place of one at that time: the later key counts from there on.
    fn push(&mut self, time: u16, value: Vec<Vec<f64>>) -> bool {
        let is_same = self.times.last() == Some(&time);
        if is_same {
            self.times.pop();
            self.values.truncate(self.values.len() - value.len());
        }
        self.times.push(time);
        self.values.extend(value);
        is_same
    }

    /// Leaves out keys that the others give within an error.
    fn reduce(&mut self, path: Path, tolerance: f64) {
        if tolerance <= 0.0 || self.interpolation == Interpolation::Cubic {
            return;
        }
        let mut keep = vec![false; self.times.len()];
        keep[0] = true;
        if self.interpolation == Interpolation::Step {
            let mut last = 0;
            for (k, keep) in keep.iter_mut().enumerate().skip(1) {
                if distance(path, &self.values[last], &self.values[k]) > tolerance {
                    (*keep, last) = (true, k);
                }
            }
        } else {
            // Douglas and Peucker: the key that is farthest off the line between two kept ones is kept, until none is
            // off by more.
            let last = self.times.len() - 1;
            let mut spans: Vec<_> = (0..last).step_by(CHUNK).map(|first| (first, (first + CHUNK).min(last))).collect();
            while let Some((from, to)) = spans.pop() {
                (keep[from], keep[to]) = (true, true);
                let off = |k: &usize| distance(path, &self.values[*k], &self.between(path, from, to, *k));
                let Some(worst) = (from + 1..to).max_by(|a, b| off(a).total_cmp(&off(b))) else { continue };
                if off(&worst) > tolerance {
                    spans.extend([(from, worst), (worst, to)]);
                }
            }
            let is_constant = self.values.iter().all(|value| distance(path, value, &self.values[0]) <= tolerance);
            if is_constant {
                keep[1..].fill(false);
            }
        }
        let mut kept = keep.iter();
        self.times.retain(|_| *kept.next().unwrap_or(&false));
        let mut kept = keep.iter();
        self.values.retain(|_| *kept.next().unwrap_or(&false));
    }

    /// Returns the value at key `k` on the way between two other keys.
    fn between(&self, path: Path, from: usize, to: usize, k: usize) -> Vec<f64> {
        let time = |k: usize| f64::from(self.times[k]);
        let t = (time(k) - time(from)) / (time(to) - time(from));
        let (a, b) = (&self.values[from], &self.values[to]);
        if path == Path::Rotation { slerp(a, b, t) } else { mix(a, b, t) }
    }

    /// Returns whether the track has the value of the node at rest all the time.
    fn is_at_rest(&self, channel: &Channel, import: &Import, tolerance: f64) -> bool {
        let node = &import.nodes[channel.node];
        let rest: Vec<f32> = match (channel.path, &node.transform) {
            (Path::Weights, _) => node.weights.clone(),
            (Path::Translation, Transform::Parts { translation, .. }) => translation.to_vec(),
            (Path::Rotation, Transform::Parts { rotation, .. }) => rotation.to_vec(),
            (Path::Scale, Transform::Parts { scale, .. }) => scale.to_vec(),
            (_, Transform::Matrix(_)) => return false,
        };
        let rest: Vec<f64> = rest.into_iter().map(f64::from).collect();
        let is_near = |value: &Vec<f64>| value.len() == rest.len() && distance(channel.path, value, &rest) <= tolerance;
        self.interpolation != Interpolation::Cubic && self.values.iter().all(is_near)
    }

    /// Returns the keys as 16-bit numbers, and a channel with what they mean.
    fn quantized(&self, path: Path, place: &str, limited: &mut usize) -> Result<(ChannelItem, Vec<i16>), WriteError> {
        let is_cubic = self.interpolation == Interpolation::Cubic;
        let is_value = |k: usize| !is_cubic || k % 3 == 1;
        let mut item = ChannelItem {
            path: match path {
                Path::Translation => PathItem::Translation,
                Path::Rotation => PathItem::Rotation,
                Path::Scale => PathItem::Scale,
                Path::Weights => PathItem::Weights,
            } as u8,
            interpolation: match self.interpolation {
                Interpolation::Linear => InterpolationItem::Linear,
                Interpolation::Step => InterpolationItem::Step,
                Interpolation::Cubic => InterpolationItem::Cubic,
            } as u8,
            ..ChannelItem::zeroed()
        };
        let short = |x: f64| x.round().clamp(-32_767.0, 32_767.0) as i16;
        let values = self.values.iter().enumerate();
        let keys = match path {
            Path::Rotation => values
                .flat_map(|(k, q)| {
                    let length = q.iter().map(|c| c * c).sum::<f64>().sqrt();
                    let factor = if is_value(k) && length > 0.0 { 32_767.0 / length } else { 32_767.0 };
                    q.iter().map(move |c| short(c * factor)).collect::<Vec<_>>()
                })
                .collect(),
            Path::Weights => {
                let mut key = |w: &f64| {
                    *limited += usize::from((w * 16_384.0).abs() > 32_768.0);
                    short(w * 16_384.0)
                };
                self.values.iter().flatten().map(&mut key).collect()
            }
            Path::Translation | Path::Scale => {
                let mut extent = Extent::EMPTY;
                let vector = |v: &Vec<f64>| [v[0], v[1], v[2]];
                values.clone().filter(|(k, _)| is_value(*k)).for_each(|(_, v)| extent.add(vector(v)));
                let (offset, half) = extent.rounded(place)?;
                let tangents = values.clone().filter(|(k, _)| !is_value(*k)).flat_map(|(_, v)| v);
                let steepest = tangents.fold(0.0, |most: f64, x| most.max(x.abs()));
                if steepest > MOST {
                    return Err(WriteError::Range { place: place.to_owned(), found: steepest, most: MOST });
                }
                let reach = f64::from(half.into_iter().max().unwrap_or(0)).max(steepest * 65_536.0);
                item.offset = offset;
                item.scale = (reach * 32_768.0 / 32_767.0).ceil().clamp(1.0, f64::from(i32::MAX)) as i32;
                let step = float(item.scale) / 32_768.0;
                let key = |(k, v): (usize, &Vec<f64>)| -> Vec<i16> {
                    let from = |n: usize| if is_value(k) { float(offset[n]) } else { 0.0 };
                    (0..3).map(|n| short((v[n] - from(n)) / step)).collect()
                };
                values.flat_map(key).collect()
            }
        };
        fixed(float(item.scale), || place.to_owned())?;
        Ok((item, keys))
    }
}

/// Returns whether tangents of rotations or weights are beyond the numbers of keys.
fn is_steep(channel: &Channel) -> bool {
    let most = match channel.path {
        Path::Rotation => 1.0,
        Path::Weights => 2.0,
        Path::Translation | Path::Scale => return false,
    };
    let width = channel.width();
    channel.times.windows(2).enumerate().any(|(k, pair)| {
        let [leave, arrive] = [3 * k + 2, 3 * k + 3].map(|value| &channel.values[value * width..][..width]);
        leave.iter().chain(arrive).any(|x| f64::from(*x * (pair[1] - pair[0])).abs() > most)
    })
}
