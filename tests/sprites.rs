//! Gradients and sprites: their colours against those of f64, span loops against single pixels, text, billboards.

use crate::reference::rng::Rng;
use crate::support::{difference, strips, whole};
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
use embedded_graphics::text::{Baseline, Text};
use embedded_graphics::{Drawable, Pixel};
use zstrip::color::Dithered;
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{BinaryColor, Gray8, Rgb565, Rgb888, RgbColor, WebColors};
use zstrip::embedded_graphics_core::primitives::Rectangle;
use zstrip::math::{Affine, Angle16, Pixels, Projective, Scalar, Vec3};
use zstrip::scene::{Outline, ShapeBuffer};
use zstrip::shader::{Alpha, Blend, Gouraud};
use zstrip::shape::{Circle, LinearGradient, RadialGradient, Ramp, RoundedRectangle, Sprite, Stencil};
use zstrip::span::{DepthState, Shader};
use zstrip::target::Framebuffer;
use zstrip::texture::{Bilinear, Image, Keyed, Nearest, Rgb888Texel, Texture};
use zstrip::{Scene, ScreenPoint};

const SCREEN: (u16, u16) = (64, 48);

fn px(bits: i32) -> Pixels {
    Pixels::from_bits(bits)
}

fn at(x: i32, y: i32) -> ScreenPoint {
    ScreenPoint::new(px(x), px(y))
}

/// All of the screen.
fn everything() -> RoundedRectangle {
    RoundedRectangle::new(ScreenPoint::corner(0, 0), ScreenPoint::corner(64, 48))
}

/// A picture of a shape on grey.
fn drawn(shape: &impl Outline, shader: &impl Shader<Rgb888>) -> Vec<[u8; 3]> {
    let mut words = vec![0; ShapeBuffer::words(64, 64)];
    let mut buffer = ShapeBuffer::new(&mut words, 64).expect("enough words");
    whole::<Rgb888>(SCREEN, Rgb888::CSS_GRAY, |scene| scene.canvas().fill_with(shape, shader, 0, &mut buffer)).0
}

/// The same picture, drawn a column at a time, so that each span has one pixel.
fn drawn_in_columns(shape: &impl Outline, shader: &impl Shader<Rgb888>) -> Vec<[u8; 3]> {
    let mut words = vec![0; ShapeBuffer::words(64, 64)];
    let mut buffer = ShapeBuffer::new(&mut words, 64).expect("enough words");
    whole::<Rgb888>(SCREEN, Rgb888::CSS_GRAY, |scene| {
        for x in 0..64 {
            let mut canvas = scene.canvas();
            canvas.set_scissor(Some(&Rectangle::new(Point::new(x, 0), Size::new(1, 48))));
            canvas.fill_with(shape, shader, 0, &mut buffer);
        }
    })
    .0
}

/// A ramp whose red is the number of the colour.
fn numbers() -> Ramp<256> {
    Ramp::new(&[(0, Rgb888::new(0, 9, 9)), (255, Rgb888::new(255, 9, 9))])
}

#[test]
fn ramps_go_through_their_stops() {
    let ramp = Ramp::<256>::new(&[(10, Rgb888::RED), (100, Rgb888::BLUE), (100, Rgb888::GREEN), (200, Rgb888::BLACK)]);
    let line = LinearGradient::new(&ramp, at(0, 0), at(64 * 256, 0));
    let picture = drawn(&everything(), &line);
    assert_eq!(picture[0], [255, 0, 0]);
    assert_eq!(picture[63], [0, 0, 0]);
    // Half-way between red and blue, and just behind the border between blue and green.
    assert!(picture[13][0].abs_diff(picture[13][2]) < 12, "{:?}", picture[13]);
    assert!(picture[25][1] > 240 && picture[24][2] > 240, "{:?}", &picture[24..26]);
}

#[test]
fn gradients_are_those_of_f64() {
    let (mut rng, ramp) = (Rng::new(1), numbers());
    let mut worst = [0_f64; 2];
    for case in 0..300 {
        let far = [20_000, 20_000, 2_000_000][case % 3];
        let mut point = || [rng.between(-far / 3, far), rng.between(-far / 3, far)];
        let (a, b) = (point(), point());
        let line = LinearGradient::new(&ramp, at(a[0], a[1]), at(b[0], b[1]));
        let radius = rng.between(256, far);
        let radial = RadialGradient::new(&ramp, at(a[0], a[1]), px(radius));
        let pictures = [drawn(&everything(), &line), drawn(&everything(), &radial)];
        let way = [f64::from(b[0] - a[0]), f64::from(b[1] - a[1])];
        for (k, picture) in pictures.iter().enumerate() {
            for (n, found) in picture.iter().enumerate() {
                let from = [
                    (n % 64) as f64 * 256.0 + 128.0 - f64::from(a[0]),
                    (n / 64) as f64 * 256.0 + 128.0 - f64::from(a[1]),
                ];
                let exact = if k == 0 {
                    (from[0] * way[0] + from[1] * way[1]) / (way[0] * way[0] + way[1] * way[1])
                } else {
                    from[0].hypot(from[1]) / f64::from(radius)
                };
                // In colours: from the first one's beginning to the last one's end.
                let exact = (exact * 256.0).clamp(0.0, 255.999);
                let found = f64::from(found[0]);
                worst[k] = worst[k].max((found - exact).max(exact - found - 1.0));
            }
        }
        if case % 10 == 0 {
            let columns = [drawn_in_columns(&everything(), &line), drawn_in_columns(&everything(), &radial)];
            assert_eq!(difference(&columns[0], &pictures[0], 64), None, "case {case}");
            assert_eq!(difference(&columns[1], &pictures[1], 64), None, "case {case}");
        }
    }
    println!("off by up to {:.4} of 256 colours along lines, {:.4} around points", worst[0], worst[1]);
    assert!(worst[0] < 0.01 && worst[1] < 0.3, "{worst:?}");
}

/// An image whose texels tell their column and row.
fn texels(width: u32, height: u32) -> Vec<u8> {
    (0..width * height).flat_map(|k| [(k % width) as u8, (k / width) as u8, 200]).collect()
}

#[test]
fn sprites_show_the_texels_of_f64() {
    let mut rng = Rng::new(4);
    let (mut count, mut worst) = (0, 0_f64);
    for case in 0..300 {
        let size = [(1, 1), (7, 5), (64, 33), (200, 120)][case % 4];
        let bytes = texels(size.0, size.1);
        let image = Image::new(&bytes, Size::new(size.0, size.1), Rgb888Texel).expect("an image");
        let place = [rng.between(0, 64 * 256), rng.between(0, 48 * 256)];
        let pivot = [rng.between(0, 256 * size.0 as i32), rng.between(0, 256 * size.1 as i32)];
        let angle = Angle16(rng.next_u64() as u16);
        let scale =
            [rng.between(10_000, 400_000), rng.between(10_000, 400_000)].map(|s| if rng.one_in(4) { -s } else { s });
        let sprite = Sprite::new(&image)
            .at(at(place[0], place[1]))
            .about(px(pivot[0]), px(pivot[1]))
            .turned(angle)
            .stretched(Scalar::from_bits(scale[0]), Scalar::from_bits(scale[1]));
        let picture = drawn(&sprite, &sprite);
        if case % 10 == 0 {
            // Beyond the image, the texels at its borders are shown.
            let columns = drawn_in_columns(&everything(), &sprite);
            assert_eq!(difference(&columns, &drawn(&everything(), &sprite), 64), None, "case {case}");
        }
        let (sine, cosine) = (f64::from(angle.0) / 65_536.0 * core::f64::consts::TAU).sin_cos();
        for (n, found) in picture.iter().enumerate() {
            let x = (n % 64) as f64 + 0.5 - f64::from(place[0]) / 256.0;
            let y = (n / 64) as f64 + 0.5 - f64::from(place[1]) / 256.0;
            let scale = scale.map(|s| f64::from(s) / 65_536.0);
            let u = (x * cosine + y * sine) / scale[0] + f64::from(pivot[0]) / 256.0;
            let v = (y * cosine - x * sine) / scale[1] + f64::from(pivot[1]) / 256.0;
            // Distance from the image's borders, in pixels.
            let edge =
                (u.min(f64::from(size.0) - u) * scale[0].abs()).min(v.min(f64::from(size.1) - v) * scale[1].abs());
            if edge < -1.0 {
                assert_eq!(*found, [128; 3], "case {case}: outside of the image");
            }
            if edge > 1.0 {
                let off = |found: u8, exact: f64| (f64::from(found) - exact).max(exact - f64::from(found) - 1.0);
                worst = worst.max(off(found[0], u)).max(off(found[1], v));
                count += 1;
            }
        }
    }
    println!("{count} texels, off by up to {worst:.4}");
    assert!(count > 50_000 && worst < 1.0 / 64.0, "{count}, {worst}");
}

#[test]
fn sprites_that_are_not_turned_are_their_images() {
    let bytes: Vec<u8> = (0..20 * 15 * 3).map(|k| (k * 37 % 251) as u8).collect();
    let image = Image::new(&bytes, Size::new(20, 15), Rgb888Texel).expect("an image");
    for turn in 0..4 {
        let placed = Sprite::new(&image).turned(Angle16::from_degrees(90 * turn));
        // The middle of 20 × 15 texels is at a corner in x, and in the middle of a pixel in y.
        let placed = if turn % 2 == 0 {
            placed.at(at(30 * 256, 25 * 256 + 128))
        } else {
            placed.at(at(30 * 256 + 128, 25 * 256))
        };
        let pictures = [drawn(&placed, &placed), drawn(&placed.filter(Bilinear), &placed.filter(Bilinear))];
        for (k, picture) in pictures.iter().enumerate() {
            for y in 0..15 {
                for x in 0..20 {
                    // From the middle, in half pixels.
                    let (dx, dy) = (2 * x - 19, 2 * y - 14);
                    let (dx, dy) = [(dx, dy), (-dy, dx), (-dx, -dy), (dy, -dx)][turn as usize];
                    let middle = if turn % 2 == 0 { (59, 50) } else { (60, 49) };
                    let (px, py) = ((dx + middle.0) / 2, (dy + middle.1) / 2);
                    let [r, g, b, _] = image.rgba(x as u32, y as u32);
                    let found = picture[(py * 64 + px) as usize];
                    // Weights of the neighbours are rounded.
                    let near =
                        found.iter().zip([r, g, b]).all(|(found, exact)| found.abs_diff(exact) <= u8::from(k == 1));
                    assert!(near, "turn {turn}, texel ({x}, {y}): {found:?}, {:?}", [r, g, b]);
                }
            }
        }
    }
}

#[test]
fn bilinear_sprites_are_those_of_f64() {
    let mut rng = Rng::new(6);
    let mut worst = 0_f64;
    for _ in 0..60 {
        let bytes: Vec<u8> = (0..16 * 12 * 3).map(|_| rng.next_u64() as u8).collect();
        let image = Image::new(&bytes, Size::new(16, 12), Rgb888Texel).expect("an image");
        let angle = Angle16(rng.next_u64() as u16);
        let scale = rng.between(100_000, 400_000);
        let sprite = Sprite::new(&image)
            .at(at(32 * 256, 24 * 256))
            .turned(angle)
            .scaled(Scalar::from_bits(scale))
            .filter(Bilinear);
        let picture = drawn(&sprite, &sprite);
        let (sine, cosine) = (f64::from(angle.0) / 65_536.0 * core::f64::consts::TAU).sin_cos();
        let s = f64::from(scale) / 65_536.0;
        for (n, found) in picture.iter().enumerate() {
            let (x, y) = ((n % 64) as f64 - 31.5, (n / 64) as f64 - 23.5);
            let (u, v) = ((x * cosine + y * sine) / s + 8.0, (y * cosine - x * sine) / s + 6.0);
            if u < 1.0 || v < 1.0 || u > 15.0 || v > 11.0 {
                continue;
            }
            let (left, top) = ((u - 0.5).floor(), (v - 0.5).floor());
            let (tx, ty) = (u - 0.5 - left, v - 0.5 - top);
            for (channel, found) in found.iter().enumerate() {
                let at = |dx: f64, dy: f64| f64::from(image.rgba((left + dx) as u32, (top + dy) as u32)[channel]);
                let row = |dy: f64| at(0.0, dy) * (1.0 - tx) + at(1.0, dy) * tx;
                let exact = row(0.0) * (1.0 - ty) + row(1.0) * ty;
                worst = worst.max((f64::from(*found) - exact).abs());
            }
        }
    }
    println!("bilinear channels are off by up to {worst:.2}");
    assert!(worst < 3.0, "{worst}");
}

#[test]
fn keyed_texels_are_left_out_and_alpha_is_blended() {
    let bytes = [255, 0, 255, 10, 20, 30, 10, 20, 30, 255, 0, 255];
    let key = Keyed { format: Rgb888Texel, key: 0xFF_00FF };
    let image = Image::new(&bytes, Size::new(2, 2), key).expect("an image");
    let sprite = Sprite::new(&image).at(at(32 * 256, 24 * 256)).scaled(Scalar::from_num(10));
    let picture = drawn(&sprite, &sprite);
    assert_eq!([picture[20 * 64 + 28], picture[20 * 64 + 36]], [[128; 3], [10, 20, 30]]);
    let mut bytes = [128; 100];
    let mut stencil = Stencil::new(&mut bytes, Size::new(10, 10)).expect("a stencil");
    let Ok(()) = Pixel(Point::new(5, 5), BinaryColor::On).draw(&mut stencil);
    let tinted = stencil.tinted(Rgb888::WHITE);
    let sprite = Sprite::new(&tinted).at(at(32 * 256, 24 * 256)).filter(Bilinear).scaled(Scalar::from_num(2));
    let picture = drawn(&sprite, &Blend::new(sprite, Alpha));
    assert_eq!(picture[24 * 64 + 20], [128; 3]);
    // The texel's middle is a corner that four pixels share: each of them has 9/16 of it.
    let mixed = 128.0 + 127.0 * 9.0 / 16.0;
    assert!((f64::from(picture[24 * 64 + 32][0]) - mixed).abs() < 2.0, "{:?}", picture[24 * 64 + 32]);
}

#[test]
fn text_in_a_stencil_is_text() {
    let draw = |text: &str, target: &mut _| {
        let style = MonoTextStyle::new(&FONT_6X10, BinaryColor::On);
        let Ok(_) = Text::with_baseline(text, Point::zero(), style, Baseline::Top).draw(target);
    };
    let mut bytes = [0; 42 * 10];
    let mut stencil = Stencil::new(&mut bytes, Size::new(42, 10)).expect("a stencil");
    draw("Speed 7", &mut stencil);
    let text = stencil.tinted(Rgb888::WHITE);
    let sprite = Sprite::new(&text).about(Pixels::ZERO, Pixels::ZERO).at(ScreenPoint::corner(9, 20));
    let picture = drawn(&sprite, &sprite);
    let expected = whole::<Rgb888>(SCREEN, Rgb888::CSS_GRAY, |scene| {
        let style = MonoTextStyle::new(&FONT_6X10, Rgb888::WHITE);
        let Ok(_) = Text::with_baseline("Speed 7", Point::new(9, 20), style, Baseline::Top).draw(&mut scene.overlay());
    });
    assert_eq!(difference(&picture, &expected.0, 64), None);
    assert!(picture.iter().filter(|pixel| **pixel == [255; 3]).count() > 60);
    let error = Stencil::new(&mut [0; 5], Size::new(2, 3)).map(|_| ()).unwrap_err();
    assert_eq!(error.to_string(), "5 bytes, but the size takes 6");
}

fn camera() -> Projective {
    Projective::perspective(Angle16::from_degrees(60), Size::new(64, 48), Scalar::ONE, Scalar::from_num(100))
        .expect("a camera")
}

#[test]
fn billboards_shrink_with_distance_and_hide() {
    let bytes = [255; 8 * 8 * 3];
    let image = Image::new(&bytes, Size::new(8, 8), Rgb888Texel).expect("an image");
    let sprite = Sprite::new(&image);
    let mut words = vec![0; ShapeBuffer::words(64, 64)];
    let mut buffer = ShapeBuffer::new(&mut words, 64).expect("enough words");
    for distance in [2, 5, 20, 90] {
        let mvp = camera()
            * Affine::translation(Vec3::from_ints(0, 0, -distance))
            * Affine::rotation_y(Angle16(9000))
            * Affine::rotation_x(Angle16(5000));
        let mut found = 0.0;
        let (picture, ..) = whole::<Gray8>(SCREEN, Gray8::new(0), |scene| {
            found = scene.pixels_per_unit(Vec3::ZERO, &mvp).expect("in front").to_num::<f64>();
            scene.billboard(&sprite, Vec3::ZERO, Scalar::ONE, &mvp, &mut buffer);
        });
        let exact = 24.0 / (30_f64.to_radians().tan() * f64::from(distance));
        assert!((found / exact - 1.0).abs() < 0.0005, "{distance}: {found} px, exactly {exact}");
        let area: f64 = picture.iter().map(|pixel| f64::from(*pixel) / 255.0).sum();
        assert!(
            (area - exact * exact).abs() < 0.02 * (exact * exact).max(1.0),
            "{distance}: area {area}, exactly {}",
            exact * exact
        );
        // Hidden by what is nearer.
        let (picture, ..) = whole::<Gray8>(SCREEN, Gray8::new(0), |scene| {
            let z = scene.project(Vec3::ZERO, &mvp).expect("in front").z;
            let area = Rectangle::new(Point::zero(), Size::new(64, 48));
            scene.canvas_with(z - 1, DepthState::LESS).rectangle(&area, Rgb888::new(7, 7, 7));
            scene.billboard(&sprite, Vec3::ZERO, Scalar::ONE, &mvp, &mut buffer);
        });
        assert!(picture.iter().all(|pixel| *pixel == 7), "{distance}");
        let behind = camera() * Affine::translation(Vec3::from_ints(0, 0, distance));
        let (picture, ..) = whole::<Gray8>(SCREEN, Gray8::new(0), |scene| {
            scene.billboard(&sprite, Vec3::ZERO, Scalar::ONE, &behind, &mut buffer)
        });
        assert!(picture.iter().all(|pixel| *pixel == 0), "{distance}");
    }
}

/// A shape with varyings: a shader of vertex colours, through its colours at three points.
#[test]
fn shaded_shapes_have_the_planes_of_triangles() {
    let corners = [(4, 3), (60, 9), (20, 45)].map(|(x, y)| ScreenPoint::corner(x, y));
    let colors = [Rgb888::RED, Rgb888::GREEN, Rgb888::BLUE];
    let points: [_; 3] = core::array::from_fn(|k| (corners[k], Gouraud::varyings(colors[k])));
    let mut words = vec![0; ShapeBuffer::words(64, 64)];
    let mut buffer = ShapeBuffer::new(&mut words, 64).expect("enough words");
    let circle = Circle::new(ScreenPoint::corner(27, 20), px(8 * 256));
    let (found, ..) = whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| {
        scene.canvas().fill_shaded(&circle, &points, &Gouraud::vertex_colors(), 0, &mut buffer);
    });
    let (expected, ..) = whole::<Rgb888>(SCREEN, Rgb888::BLACK, |scene| {
        scene.canvas().gradient(&core::array::from_fn::<_, 3, _>(|k| (corners[k], colors[k])));
    });
    let mut inside = 0;
    for (k, (found, expected)) in found.iter().zip(&expected).enumerate() {
        let (x, y) = ((k % 64) as f64 + 0.5 - 27.0, (k / 64) as f64 + 0.5 - 20.0);
        if x.hypot(y) < 7.0 {
            inside += 1;
            for (found, expected) in found.iter().zip(expected) {
                assert!(found.abs_diff(*expected) <= 1, "pixel {k}: {found}, {expected}");
            }
        }
    }
    assert!(inside > 140, "{inside}");
}

/// Some of everything.
fn draw_any<F: Framebuffer>(scene: &mut Scene<'_, F>, seed: u64, words: &mut [u32]) {
    let rng = &mut Rng::new(seed);
    let mut buffer = ShapeBuffer::new(words, 64).expect("enough words");
    let bytes = texels(13, 9);
    let image = Image::new(&bytes, Size::new(13, 9), Rgb888Texel).expect("an image");
    let ramp = numbers();
    let any = |rng: &mut Rng| match rng.below(9) {
        0 => rng.next_u64() as i32,
        1 => rng.pick(&[i32::MIN, i32::MAX, 0]),
        _ => rng.between(-2000, 18_000),
    };
    for _ in 0..20 {
        let circle = Circle::new(at(any(rng), any(rng)), px(any(rng)));
        let (from, to) = (at(any(rng), any(rng)), at(any(rng), any(rng)));
        let mut canvas = scene.canvas_with(rng.next_u64() as u16, rng.pick(&[DepthState::LESS, DepthState::OFF]));
        let sprite = Sprite::new(&image)
            .at(from)
            .about(px(any(rng) / 8), px(any(rng) / 8))
            .turned(Angle16(any(rng) as u16))
            .stretched(Scalar::from_bits(any(rng).saturating_mul(16)), Scalar::from_bits(any(rng).saturating_mul(16)));
        match rng.below(6) {
            0 => canvas.fill_with(&circle, &LinearGradient::new(&ramp, from, to), 0, &mut buffer),
            1 => canvas.fill_with(&circle, &RadialGradient::new(&ramp, from, px(any(rng))), 0, &mut buffer),
            2 => canvas.sprite(&sprite, &mut buffer),
            3 => canvas.sprite(&sprite.filter(Bilinear), &mut buffer),
            4 => canvas.fill_with(&circle, &Blend::new(sprite.filter(Nearest), Alpha), 0, &mut buffer),
            _ => {
                let corners = [from, to, at(any(rng), any(rng))].map(|at| (at, Gouraud::varyings(Rgb888::CSS_CORAL)));
                canvas.fill_shaded(&circle, &corners, &Gouraud::vertex_colors(), 0, &mut buffer);
            }
        }
    }
}

#[test]
fn strips_do_not_matter() {
    for seed in 0..30 {
        let mut words = vec![0; ShapeBuffer::words(64, 30)];
        let (expected, ..) = whole::<Rgb565>(SCREEN, Rgb565::BLACK, |scene| draw_any(scene, seed, &mut words));
        let (dithered, ..) =
            whole::<Dithered<Rgb565>>(SCREEN, Rgb565::BLACK, |scene| draw_any(scene, seed, &mut words));
        for (rows, records) in [(1, 0), (7, 100)] {
            let (picture, _) =
                strips::<Rgb565>(SCREEN, rows, records, Rgb565::BLACK, |scene| draw_any(scene, seed, &mut words));
            assert_eq!(difference(&picture, &expected, SCREEN.0), None, "seed {seed}, {rows} rows");
            let (picture, _) = strips::<Dithered<Rgb565>>(SCREEN, rows, records, Rgb565::BLACK, |scene| {
                draw_any(scene, seed, &mut words)
            });
            assert_eq!(difference(&picture, &dithered, SCREEN.0), None, "seed {seed}, {rows} rows, dithered");
        }
    }
}
