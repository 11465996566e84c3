//! Supersampling: a pixel is the mean of N × N pixels of a finer screen, in any strips.

use crate::scenes;
use crate::support;
use crate::support::difference;
use zstrip::color::{Mean, MeanOfCodes, MeanOfLight, PixelFormat};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Gray8, Rgb565, Rgb888};
use zstrip::frame::{FrameError, Renderer, RendererError, Supersampled};
use zstrip::math::Angle16;
use zstrip::target::{WithDepth, WithRecords};

const SIZE: Size = Size::new(96, 72);

/// Draws a scene with N × N pixels for one, in strips of `rows` rows of the display.
fn smooth<const N: usize>(name: &str, rows: usize, mean: impl Mean) -> Vec<u16> {
    let fine = SIZE * N as u32;
    let info = scenes::SCENES.iter().find(|info| info.name == name).expect("a scene");
    let drawing = (info.make)(fine, Angle16(7777));
    let pixels = fine.width as usize * rows * N;
    let (mut color, mut depth, mut records) = (vec![0x5A5A; pixels], vec![7; pixels], vec![0; 60_000]);
    let renderer = Renderer::<Rgb565>::new(fine).and_then(|renderer| renderer.with_depth(&mut depth));
    let renderer = renderer.expect("a renderer").with_records(&mut records);
    let mut renderer =
        Supersampled::<'_, Rgb565, WithDepth, WithRecords, N>::new(renderer).expect("multiples").with_mean(mean);
    assert_eq!(renderer.screen(), SIZE);
    let mut picture = vec![];
    let mut frame = renderer.begin(scenes::BACKGROUND);
    while let Some(strip) = frame.next_strip(&mut color, |scene| drawing.draw(scene)).expect("one scene") {
        assert_eq!(strip.area().top_left.y as usize * SIZE.width as usize, picture.len());
        assert_eq!((strip.area().size.width * strip.area().size.height) as usize, strip.pixels().len());
        picture.extend_from_slice(strip.pixels());
    }
    picture
}

/// Returns the numbers of the channels in a pixel.
fn levels(pixel: u16) -> [f64; 3] {
    [pixel >> 11, pixel >> 5 & 63, pixel & 31].map(f64::from)
}

/// The same by an ordinary frame and means in double precision: of levels, or of light as codes of 8 bits.
fn expected<const N: usize>(name: &str, light: bool) -> Vec<[f64; 3]> {
    let fine = (SIZE.width as u16 * N as u16, SIZE.height as u16 * N as u16);
    let info = scenes::SCENES.iter().find(|info| info.name == name).expect("a scene");
    let drawing = (info.make)(SIZE * N as u32, Angle16(7777));
    let (picture, _) = support::strips::<Rgb565>(fine, 16, 60_000, scenes::BACKGROUND, |scene| drawing.draw(scene));
    let to_light = |code: f64| {
        let c = code / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    };
    let to_code =
        |light: f64| 255.0 * if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
    let mut means = vec![];
    for (y, x) in (0..SIZE.height as usize).flat_map(|y| (0..SIZE.width as usize).map(move |x| (y, x))) {
        let mut sum = [0.0; 3];
        for (j, i) in (0..N).flat_map(|j| (0..N).map(move |i| (j, i))) {
            let pixel = picture[(y * N + j) * usize::from(fine.0) + x * N + i];
            let channels = Rgb565::unpack(pixel).map(|code| to_light(code.into()));
            for (sum, channel) in sum.iter_mut().zip(if light { channels } else { levels(pixel) }) {
                *sum += channel;
            }
        }
        means.push(sum.map(|sum| sum / (N * N) as f64).map(|mean| if light { to_code(mean) } else { mean }));
    }
    means
}

fn check<const N: usize>(name: &str) {
    let codes = smooth::<N>(name, SIZE.height as usize, MeanOfCodes);
    let light = smooth::<N>(name, SIZE.height as usize, MeanOfLight);
    for (picture, is_light) in [(&codes, false), (&light, true)] {
        let expected = expected::<N>(name, is_light);
        let mut differ = 0;
        for (k, (pixel, expected)) in picture.iter().zip(expected).enumerate() {
            for (channel, (level, exact)) in levels(*pixel).into_iter().zip(expected).enumerate() {
                // The mean of codes is rounded to nearest; that of light is a code of 8 bits, whose lower bits are cut.
                let packed = |code: f64| levels(Rgb565::pack([code.round().clamp(0.0, 255.0) as u8; 3]))[channel];
                let is_right = match is_light {
                    false => (level - exact).abs() <= 0.5,
                    true => [packed(exact - 0.51), packed(exact + 0.51)].contains(&level),
                };
                assert!(is_right, "{name}, {N}, light {is_light}, pixel {k}: {level}, exactly {exact}");
            }
            differ += usize::from(codes[k] != light[k]);
        }
        assert!(differ > 50, "{name}, {N}: {differ} px tell the two means apart");
    }
    for rows in [1, 5, 16] {
        let found = difference(&smooth::<N>(name, rows, MeanOfCodes), &codes, SIZE.width as u16);
        assert_eq!(found, None, "{name}, {N}, strips of {rows} rows");
    }
}

#[test]
fn pixels_are_means_of_finer_pixels() {
    check::<2>("torus_gouraud");
    check::<3>("torus_flat");
    check::<4>("room");
    check::<2>("crates");
    check::<2>("wires");
    check::<3>("labels");
}

#[test]
fn wrong_sizes_are_errors() {
    let fine = |width, height| Renderer::<Gray8>::new(Size::new(width, height)).expect("a renderer");
    let by_2 = |width, height| Supersampled::<_, _, _, 2>::new(fine(width, height)).map(|renderer| renderer.screen());
    assert_eq!(by_2(64, 48), Ok(Size::new(32, 24)));
    let not = |screen, scale| Err(RendererError::NotAMultiple { screen, scale });
    assert_eq!(by_2(63, 48), not(Size::new(63, 48), 2));
    assert_eq!(by_2(64, 47), not(Size::new(64, 47), 2));
    let mut depth = [0; 2 * 60];
    let few = fine(60, 60).with_depth(&mut depth).expect("two rows");
    let found = Supersampled::<_, _, _, 3>::new(few).map(|renderer| renderer.screen());
    assert_eq!(found, Err(RendererError::DepthTooShort { pixels: 120, needed: 180 }));
    let mut renderer = Supersampled::<_, _, _, 3>::new(fine(60, 60)).expect("a renderer");
    let mut frame = renderer.begin(Rgb888::new(0, 0, 0));
    let short = frame.next_strip(&mut [0; 179], |_| {}).map(|_| ());
    assert_eq!(short, Err(FrameError::BufferTooShort { pixels: 179, needed: 180 }));
}
