//! Scenes in formats other than RGB565, dithered ones and strips packed for panels; scenes with smooth edges; and one
//! with hidden draws.

use super::kept::kept;
use super::leaves::Leaves;
use super::street::Street;
use super::{Draw, Room, Torus, in_place};
use zstrip::color::{Dither, Dithered, PixelFormat, Rgb332, Rgb565Be};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Gray2, Gray4, Gray8, Rgb888};
use zstrip::frame::{Renderer, Supersampled};
use zstrip::math::Angle16;
use zstrip::target::{PackedFormat, Packer, Pages, Rows, Strip};
use zstrip::target::{WithDepth, WithOcclusion, WithRecords, WithSamples};

/// The memory of a frame; `color` holds colours and packed strips in any format.
pub struct Memory<'m> {
    pub color: &'m mut [u16],
    pub depth: &'m mut [u16],
    pub records: &'m mut [u32],
}

/// A closure that takes a strip's bytes.
pub type Sink<'s> = dyn FnMut(&[u8]) + 's;

/// A scene in a format.
pub struct FormatInfo {
    /// Its name in reports.
    pub name: &'static str,
    /// Hands each strip's bytes to a sink.
    pub draw: fn(Memory<'_>, &mut Sink<'_>),
}

/// All of them.
pub const FORMATS: &[FormatInfo] = &[
    FormatInfo {
        name: "room_dithered",
        draw: |memory, sink| {
            direct::<Dithered<Rgb565Be>, _>(memory, sink, &*kept(|| Room::new(Size::new(320, 240), Angle16(0))))
        },
    },
    FormatInfo {
        name: "torus_332",
        draw: |memory, sink| {
            direct::<Dithered<Rgb332>, _>(memory, sink, &*kept(|| Torus::gouraud(Size::new(320, 240), Angle16(0))))
        },
    },
    FormatInfo {
        name: "torus_pages",
        draw: |memory, sink| packed::<Pages>(Size::new(80, 64), Dither::BAYER_8, memory, sink),
    },
    FormatInfo {
        name: "torus_gray2",
        draw: |memory, sink| packed::<Rows<Gray2>>(Size::new(317, 240), Dither::BAYER_4, memory, sink),
    },
    FormatInfo {
        name: "torus_gray4",
        draw: |memory, sink| packed::<Rows<Gray4>>(Size::new(317, 240), Dither::BAYER_8, memory, sink),
    },
];

/// Scenes with smooth edges.
pub const SMOOTH: &[FormatInfo] = &[
    FormatInfo {
        name: "torus_samples",
        draw: |memory, sink| sampled(memory, sink, &*kept(|| Torus::gouraud(Size::new(320, 240), Angle16(0)))),
    },
    FormatInfo {
        name: "room_samples",
        draw: |memory, sink| sampled(memory, sink, &*kept(|| Room::new(Size::new(320, 240), Angle16(0)))),
    },
    FormatInfo {
        name: "street_occluded",
        draw: |memory, sink| {
            occluded(memory, sink, &*kept(|| Street::behind_a_wall(Size::new(320, 240), Angle16(5000))));
        },
    },
    FormatInfo {
        name: "torus_2x2",
        draw: |memory, sink| supersampled(memory, sink, &*kept(|| Torus::flat(Size::new(320, 240), Angle16(0)))),
    },
];

/// The scene with textures and several samples per pixel. It has a list of its own, because it takes more stack than
/// the others with samples.
pub const LEAVES: &[FormatInfo] = &[FormatInfo {
    name: "leaves_samples",
    draw: |memory, sink| sampled(memory, sink, &*kept(|| Leaves::new(Size::new(320, 240), Angle16(0)))),
}];

/// Draws 320×240 pixels, and leaves out hidden draws.
fn occluded<S>(Memory { color, depth, records }: Memory<'_>, sink: &mut Sink<'_>, drawing: &S)
where
    S: for<'p> Draw<Strip<'p, Rgb565Be, WithOcclusion, WithRecords>>,
{
    let mut renderer = in_place(|| {
        Renderer::<Rgb565Be>::new(Size::new(320, 240))
            .and_then(|renderer| renderer.with_depth(depth))
            .and_then(Renderer::with_occlusion)
            .map(|renderer| renderer.with_records(records))
    });
    let Ok(renderer) = &mut renderer else { return };
    let mut frame = renderer.begin(Rgb888::new(24, 28, 24));
    while let Ok(Some(strip)) = frame.next_strip(color, |scene| drawing.draw(scene)) {
        sink(strip.bytes());
    }
}

/// Draws 320×240 pixels with four samples each.
fn sampled<S>(Memory { color, depth, records }: Memory<'_>, sink: &mut Sink<'_>, drawing: &S)
where
    S: for<'p> Draw<Strip<'p, Rgb565Be, WithSamples<4>, WithRecords>>,
{
    // A quarter for the strip, the rest for the other samples.
    let Some((color, samples)) = color.split_at_mut_checked(color.len() / 4) else { return };
    let mut renderer = in_place(|| {
        Renderer::<Rgb565Be>::new(Size::new(320, 240))
            .and_then(|renderer| renderer.with_samples::<4>(depth, samples))
            .map(|renderer| renderer.with_records(records))
    });
    let Ok(renderer) = &mut renderer else { return };
    let mut frame = renderer.begin(Rgb888::new(24, 28, 24));
    while let Ok(Some(strip)) = frame.next_strip(color, |scene| drawing.draw(scene)) {
        sink(strip.bytes());
    }
}

/// Draws 160×120 pixels, each of 2×2.
fn supersampled<S>(Memory { color, depth, records }: Memory<'_>, sink: &mut Sink<'_>, drawing: &S)
where
    S: for<'p> Draw<Strip<'p, Rgb565Be, WithDepth, WithRecords>>,
{
    let mut renderer = in_place(|| {
        Renderer::<Rgb565Be>::new(Size::new(320, 240))
            .and_then(|renderer| renderer.with_depth(depth))
            .and_then(|renderer| Supersampled::<_, _, _, 2>::new(renderer.with_records(records)))
    });
    let Ok(renderer) = &mut renderer else { return };
    let mut frame = renderer.begin(Rgb888::new(24, 28, 24));
    while let Ok(Some(strip)) = frame.next_strip(color, |scene| drawing.draw(scene)) {
        sink(strip.bytes());
    }
}

/// Draws 320×240 pixels of a format.
fn direct<P, S>(memory: Memory<'_>, sink: &mut Sink<'_>, drawing: &S)
where
    P: PixelFormat,
    S: for<'p> Draw<Strip<'p, P, WithDepth, WithRecords>>,
{
    let Memory { color, depth, records } = memory;
    let Ok(color) = bytemuck::try_cast_slice_mut(color) else { return };
    let mut renderer = in_place(|| {
        Renderer::<P>::new(Size::new(320, 240))
            .and_then(|renderer| renderer.with_depth(depth))
            .map(|renderer| renderer.with_records(records))
    });
    let Ok(renderer) = &mut renderer else { return };
    let mut frame = renderer.begin(Rgb888::new(24, 28, 24));
    // A frame that fails lacks strips, which shows in its hash.
    while let Ok(Some(strip)) = frame.next_strip(color, |scene| drawing.draw(scene)) {
        sink(strip.bytes());
    }
}

/// Draws the torus in greys and packs them.
fn packed<F: PackedFormat>(screen: Size, dither: Dither<F::Color>, memory: Memory<'_>, sink: &mut Sink<'_>) {
    let Memory { color, depth, records } = memory;
    // Half for greys, half for what they are packed to.
    let bytes: &mut [u8] = bytemuck::cast_slice_mut(color);
    let Some((color, bytes)) = bytes.split_at_mut_checked(bytes.len() / 2) else { return };
    let (width, height) = (screen.width as usize, screen.height as usize);
    let page = usize::from(F::ROWS);
    let rows = (color.len().min(depth.len()) / width / page * page).min(height);
    let (Some(color), Some(depth)) = (color.get_mut(..width * rows), depth.get_mut(..width * rows)) else { return };
    let Ok(renderer) = Renderer::<Gray8>::new(screen).and_then(|renderer| renderer.with_depth(depth)) else { return };
    let mut renderer = renderer.with_records(records);
    let Ok(mut packer) = Packer::<F>::new(screen, rows as u32, dither, bytes) else { return };
    let torus = kept(|| Torus::gouraud(screen, Angle16(0)));
    let mut frame = renderer.begin(Gray8::new(26));
    while let Ok(Some(strip)) = frame.next_strip(color, |scene| torus.draw(scene)) {
        sink(packer.pack(&strip));
    }
}

/// Returns the FNV-1a 64 of a frame's bytes.
pub fn hash(format: &FormatInfo, memory: Memory<'_>) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    (format.draw)(memory, &mut |bytes| {
        for byte in bytes {
            hash = (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
        }
    });
    hash
}
