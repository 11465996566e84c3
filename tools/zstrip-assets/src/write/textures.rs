//! Textures: images in the formats of the container.

use std::collections::HashMap;

use color_quant::NeuQuant;
use image::imageops::{FilterType, resize};
use image::{ImageBuffer, Rgba};
use zstrip::model::container::{NONE_LONG, SectionKind, Texture, TextureFormat};

use super::options::{TextureKind, WriteOptions};
use super::report::{WriteError, WriteNote, WriteReport};
use super::sections::Sections;
use crate::model::{AlphaMode, Image, Import};

/// Columns, rows and texels, red, green, blue and alpha of 0 to 255.
struct Level {
    size: [u32; 2],
    texels: Vec<[u8; 4]>,
}

/// Textures of materials: numbers in the container, and sizes.
pub(super) struct Textures {
    pub numbers: Vec<Option<u16>>,
    pub sizes: Vec<Option<[u32; 2]>>,
}

/// Writes the images that materials use, each once, or twice if only some of its materials have alpha.
pub(super) fn textures(
    import: &Import,
    options: &WriteOptions,
    to: &mut Sections,
    report: &mut WriteReport,
) -> Result<Textures, WriteError> {
    let mut known: HashMap<(usize, bool), (u16, [u32; 2])> = HashMap::new();
    let mut found = Textures { numbers: Vec::new(), sizes: Vec::new() };
    for material in &import.materials {
        let texture = match material.texture {
            Some(texture) => {
                let image = &import.images[texture.image];
                let has_alpha = image.texels.chunks_exact(4).any(|texel| texel[3] < 255);
                let key = (texture.image, has_alpha && material.alpha != AlphaMode::Opaque);
                let entry = match known.get(&key) {
                    Some(entry) => *entry,
                    None => {
                        let number = known.len();
                        if number >= usize::from(u16::MAX) {
                            return Err(WriteError::TooMany { what: "textures", found: number + 1, most: 65_535 });
                        }
                        let entry = (number as u16, write(image, key.1, options, to, report));
                        known.insert(key, entry);
                        entry
                    }
                };
                Some(entry)
            }
            None => None,
        };
        found.numbers.push(texture.map(|(number, _)| number));
        found.sizes.push(texture.map(|(_, size)| size));
    }
    Ok(found)
}

/// Returns the power of two nearest to a length, at most the largest one up to `most`.
fn power_of_two(length: u32, most: u32) -> u32 {
    let above = length.next_power_of_two();
    let nearest = if above - length > length - above / 2 { above / 2 } else { above };
    nearest.min(1 << most.ilog2()).max(1)
}

fn write(image: &Image, alpha: bool, options: &WriteOptions, to: &mut Sections, report: &mut WriteReport) -> [u32; 2] {
    let from = [image.width, image.height];
    // Both sides shrink alike, as far as powers of two do.
    let longest = image.width.max(image.height);
    let shrunk = |side: u32| match longest > options.max_texture {
        true => (u64::from(side) * u64::from(options.max_texture) / u64::from(longest)).max(1) as u32,
        false => side,
    };
    let size = from.map(|side| power_of_two(shrunk(side), options.max_texture));
    if size != from {
        report.notes.push(WriteNote::Resized { image: image.name.clone(), from, to: size });
    }
    let texels = image.texels.as_chunks::<4>().0.to_vec();
    let mut levels = vec![resized(&Level { size: from, texels }, size)];
    while options.mips && levels.len() < 16 {
        let last = &levels[levels.len() - 1];
        if last.size[0] * last.size[1] <= 16 {
            break;
        }
        let half = last.size.map(|side| (side / 2).max(1));
        levels.push(resized(last, half));
    }
    let encoder = Encoder::new(&levels, options.textures, &image.name, report);
    let mut data = Vec::new();
    for level in &levels {
        encoder.encode(level, &mut data, &mut report.errors.texel);
    }
    let texels = to.add_even(&data);
    let palette = to.add(SectionKind::Bytes, encoder.palette.as_flattened());
    let mut alpha_bytes = Vec::new();
    if alpha {
        for level in &levels {
            let fifteenth = |texel: &[u8; 4]| ((u32::from(texel[3]) * 15 + 127) / 255) as u8;
            pack(level, 4, fifteenth, &mut alpha_bytes);
        }
    }
    let item = Texture {
        width: size[0] as u16,
        height: size[1] as u16,
        format: encoder.format as u8,
        levels: levels.len() as u8,
        colors: encoder.palette.len() as u16,
        texels,
        palette,
        alpha: if alpha { to.add(SectionKind::Bytes, &alpha_bytes) } else { NONE_LONG },
    };
    report.texture_bytes += data.len() + 3 * encoder.palette.len() + alpha_bytes.len();
    to.add(SectionKind::Textures, &[item]);
    size
}

/// Returns an image of another size. Colours count by their alpha, so that invisible ones do not show at borders.
fn resized(level: &Level, size: [u32; 2]) -> Level {
    if level.size == size {
        return Level { size, texels: level.texels.clone() };
    }
    let has_alpha = level.texels.iter().any(|texel| texel[3] < 255);
    let factor = |a: u8| if has_alpha { f32::from(a) / 255.0 } else { 1.0 };
    let times = |[r, g, b, a]: &[u8; 4]| {
        let f = factor(*a) / 255.0;
        [f32::from(*r) * f, f32::from(*g) * f, f32::from(*b) * f, f32::from(*a) / 255.0]
    };
    let values: Vec<f32> = level.texels.iter().flat_map(times).collect();
    let Some(image) = ImageBuffer::<Rgba<f32>, _>::from_raw(level.size[0], level.size[1], values) else {
        unreachable!("an image has its number of texels, which was checked")
    };
    let shrunk = resize(&image, size[0], size[1], FilterType::Triangle);
    let byte = |c: f32| (c * 255.0).round().clamp(0.0, 255.0) as u8;
    let texel = |Rgba([r, g, b, a]): &Rgba<f32>| {
        let f = if has_alpha && *a > 0.0 { 1.0 / a } else { 1.0 };
        [byte(r * f), byte(g * f), byte(b * f), byte(*a)]
    };
    Level { size, texels: shrunk.pixels().map(texel).collect() }
}

/// Appends numbers of a few bits: the upper bits of a byte come first, and rows begin at whole bytes.
fn pack(level: &Level, bits: usize, number: impl Fn(&[u8; 4]) -> u8, to: &mut Vec<u8>) {
    for row in level.texels.chunks_exact(level.size[0] as usize) {
        for texels in row.chunks(8 / bits) {
            let byte =
                texels.iter().enumerate().fold(0, |byte, (k, texel)| byte | number(texel) << (8 - bits * (k + 1)));
            to.push(byte);
        }
    }
}

/// A format, and the palette of all levels.
struct Encoder {
    format: TextureFormat,
    palette: Vec<[u8; 3]>,
    /// Numbers of the colours that occur.
    numbers: HashMap<[u8; 3], u8>,
}

impl Encoder {
    fn new(levels: &[Level], kind: TextureKind, name: &str, report: &mut WriteReport) -> Self {
        let plain = |format| Self { format, palette: Vec::new(), numbers: HashMap::new() };
        let most = match kind {
            TextureKind::Rgb565 => return plain(TextureFormat::Rgb565),
            TextureKind::Gray => return plain(TextureFormat::Gray8),
            TextureKind::Mask => return plain(TextureFormat::Mask),
            TextureKind::Palette => 256,
            TextureKind::Palette16 => 16,
        };
        // Colours of the first level, in the order in which they come.
        let mut colors: Vec<[u8; 3]> = Vec::new();
        let mut numbers: HashMap<[u8; 3], u8> = HashMap::new();
        let mut count = 0;
        for [r, g, b, _] in &levels[0].texels {
            numbers.entry([*r, *g, *b]).or_insert_with(|| {
                colors.push([*r, *g, *b]);
                count += 1;
                0
            });
        }
        let palette = if count <= most {
            colors
        } else {
            // The network begins with at least 64 colours; fewer are found among those.
            let rgba: Vec<u8> = levels[0].texels.iter().flat_map(|[r, g, b, _]| [*r, *g, *b, 255]).collect();
            let network = NeuQuant::new(1, most.max(64), &rgba).color_map_rgb();
            let palette = refined(&levels[0], network.as_chunks::<3>().0, most);
            report.notes.push(WriteNote::Quantized { image: name.to_owned(), colors: count, palette: most });
            palette
        };
        let format = match palette.len() {
            0..=2 => TextureFormat::Palette1,
            3..=4 => TextureFormat::Palette2,
            5..=16 => TextureFormat::Palette4,
            _ => TextureFormat::Palette8,
        };
        let mut numbers = HashMap::new();
        for [r, g, b, _] in levels.iter().flat_map(|level| &level.texels) {
            let color = [*r, *g, *b];
            numbers.entry(color).or_insert_with(|| nearest(&palette, color) as u8);
        }
        Self { format, palette, numbers }
    }

    /// Appends a level, and notes how far its texels are off.
    fn encode(&self, level: &Level, to: &mut Vec<u8>, worst: &mut f64) {
        let mut compare = |texel: &[u8; 4], found: [u8; 3]| {
            for (a, b) in texel.iter().zip(found) {
                *worst = worst.max(f64::from(a.abs_diff(b)));
            }
        };
        match self.format {
            TextureFormat::Rgb565 => {
                for texel in &level.texels {
                    let part = |k: usize, most: u32| (u32::from(texel[k]) * most + 127) / 255;
                    let [r, g, b] = [part(0, 31), part(1, 63), part(2, 31)];
                    to.extend(((r << 11 | g << 5 | b) as u16).to_le_bytes());
                    compare(texel, [r << 3 | r >> 2, g << 2 | g >> 4, b << 3 | b >> 2].map(|c| c as u8));
                }
            }
            TextureFormat::Gray8 => {
                for texel in &level.texels {
                    let [r, g, b, _] = texel.map(u32::from);
                    let gray = ((r * 299 + g * 587 + b * 114 + 500) / 1000) as u8;
                    to.push(gray);
                    compare(texel, [gray; 3]);
                }
            }
            TextureFormat::Mask => pack(level, 1, |texel| u8::from(texel[3] >= 128), to),
            format => {
                let number = |[r, g, b, _]: &[u8; 4]| self.numbers.get(&[*r, *g, *b]).copied().unwrap_or(0);
                pack(level, format.bits(), number, to);
                level.texels.iter().for_each(|texel| compare(texel, self.palette[usize::from(number(texel))]));
            }
        }
    }
}

fn nearest(palette: &[[u8; 3]], color: [u8; 3]) -> usize {
    let distance = |other: &[u8; 3]| other.iter().zip(color).map(|(a, b)| u32::from(a.abs_diff(b)).pow(2)).sum::<u32>();
    (0..palette.len()).min_by_key(|k| distance(&palette[*k])).unwrap_or(0)
}

/// Brings colours to the means of the texels that are nearest to them, a few times; of more colours than there may be,
/// those of the fewest texels go first.
fn refined(level: &Level, colors: &[[u8; 3]], most: usize) -> Vec<[u8; 3]> {
    let mut counts: HashMap<[u8; 3], u64> = HashMap::new();
    for [r, g, b, _] in &level.texels {
        *counts.entry([*r, *g, *b]).or_default() += 1;
    }
    let mut counts: Vec<_> = counts.into_iter().collect();
    counts.sort_unstable();
    let mut palette = colors.to_vec();
    for round in 0..4 {
        let mut sums = vec![[0_u64; 4]; palette.len()];
        for (color, count) in &counts {
            let sum = &mut sums[nearest(&palette, *color)];
            (0..3).for_each(|k| sum[k] += count * u64::from(color[k]));
            sum[3] += count;
        }
        if round == 0 {
            sums.sort_unstable_by_key(|sum| std::cmp::Reverse(sum[3]));
            sums.truncate(most);
        }
        sums.retain(|sum| sum[3] > 0);
        palette = sums.iter().map(|[r, g, b, n]| [r, g, b].map(|c| ((c + n / 2) / n) as u8)).collect();
    }
    palette
}
