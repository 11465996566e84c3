//! Packed strips: the bytes that panels want, the same at every strip height.

use crate::reference;
use crate::scenes::{Draw, Torus};
use crate::support;
use core::convert::Infallible;
use embedded_graphics_core::Pixel;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{OriginDimensions, Size};
use embedded_graphics_core::pixelcolor::{BinaryColor, Gray2, Gray4, Gray8, Rgb565, Rgb888, WebColors};
use zstrip::color::{Dither, Levels, PixelFormat};
use zstrip::frame::Renderer;
use zstrip::math::{Angle16, Projective, Scalar};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::shader::{Flat, Gouraud};
use zstrip::target::{DitheredDisplay, PackedFormat, Packer, PackerError, Pages, Rows, RowsLowFirst, StripPixels};
use zstrip::{Cull, Framebuffer, Scene, State, embedded_graphics_core};

/// Draws the torus in strips of `rows` rows and hands them, packed, to `sink` with their first row.
fn torus<P: PixelFormat, F: PackedFormat>(
    screen: (u16, u16),
    rows: u16,
    dither: Dither<F::Color>,
    background: P::Color,
    mut sink: impl FnMut(usize, &[u8]),
) {
    let pixels = usize::from(screen.0) * usize::from(rows);
    let (mut color, mut depth, mut records) = (vec![P::pack([9; 3]); pixels], vec![0; pixels], vec![0; 20_000]);
    let renderer = Renderer::<P>::new(Size::new(screen.0.into(), screen.1.into()))
        .expect("a renderer")
        .with_depth(&mut depth)
        .expect("a renderer");
    let mut renderer = renderer.with_records(&mut records);
    let mut bytes = vec![0x5A; F::bytes(screen.0, rows)];
    let mut packer = Packer::<F>::new(Size::new(screen.0.into(), screen.1.into()), rows.into(), dither, &mut bytes)
        .expect("a packer");
    let to_sink = |strip: &StripPixels<'_, P>| {
        sink(strip.area().top_left.y as usize, packer.pack(strip));
        Ok::<(), Infallible>(())
    };
    let torus = Torus::gouraud(Size::new(screen.0.into(), screen.1.into()), Angle16(4000));
    renderer.frame_to(to_sink, &mut color, background, |scene| torus.draw(scene)).expect("a frame");
}

/// Greys of the same frame, pixel by pixel.
fn greys(screen: (u16, u16)) -> Vec<u8> {
    let torus = Torus::gouraud(Size::new(screen.0.into(), screen.1.into()), Angle16(4000));
    let rows = usize::from(screen.1);
    let (picture, _) = support::strips::<Gray8>(screen, rows, 20_000, Gray8::new(70), |scene| torus.draw(scene));
    picture
}

/// Bit by bit: which bits of which byte hold pixel (x, y), and what must be there.
fn check<F: PackedFormat>(dither: Dither<F::Color>, place: impl Fn(usize, usize, usize) -> (usize, u32)) {
    // Widths that fill the bytes, and others; heights that fill pages, and others.
    for screen in [(128, 64), (61, 45), (3, 9), (10, 20)] {
        let (width, height) = (usize::from(screen.0), usize::from(screen.1));
        let mut expected = vec![0; F::bytes(screen.0, screen.1)];
        for (k, grey) in greys(screen).into_iter().enumerate() {
            let (x, y) = (k % width, k / width);
            let (byte, shift) = place(width, x, y);
            expected[byte] |= dither.level(grey, (x as i32, y as i32)) << shift;
        }
        let rows = (F::ROWS..=64).step_by(usize::from(F::ROWS)).filter(|rows| *rows < screen.1);
        for rows in rows.chain([screen.1]) {
            let mut packed = Vec::new();
            torus::<Gray8, F>(screen, rows, dither, Gray8::new(70), |y, bytes| {
                assert_eq!(packed.len(), F::bytes(screen.0, y as u16));
                packed.extend_from_slice(bytes);
            });
            assert!(packed == expected, "{width}x{height} in strips of {rows} rows");
        }
    }
}

#[test]
fn pages_hold_eight_rows_a_byte_with_the_lowest_bit_on_top() {
    check::<Pages>(Dither::BAYER_8, |width, x, y| (y / 8 * width + x, y as u32 % 8));
}

#[test]
fn rows_hold_the_leftmost_pixel_in_the_highest_bits() {
    fn place(bits: usize) -> impl Fn(usize, usize, usize) -> (usize, u32) {
        move |width, x, y| {
            let (row, bit) = ((width * bits).div_ceil(8), x * bits);
            (y * row + bit / 8, (8 - bits - bit % 8) as u32)
        }
    }
    check::<Rows<BinaryColor>>(Dither::BAYER_4, place(1));
    check::<Rows<Gray2>>(Dither::BAYER_8, place(2));
    check::<Rows<Gray4>>(Dither::<Gray4>::BAYER_8.on_linear_panel(), place(4));
}

#[test]
fn rows_low_first_hold_the_leftmost_pixel_in_the_lowest_bits() {
    fn place(bits: usize) -> impl Fn(usize, usize, usize) -> (usize, u32) {
        move |width, x, y| ((y * (width * bits).div_ceil(8)) + x * bits / 8, (x * bits % 8) as u32)
    }
    check::<RowsLowFirst<BinaryColor>>(Dither::NEAREST, place(1));
    check::<RowsLowFirst<Gray2>>(Dither::BAYER_4, place(2));
    check::<RowsLowFirst<Gray4>>(Dither::BAYER_8, place(4));
}

/// A display of pixels, for whatever colour.
struct Panel<C> {
    size: Size,
    pixels: Vec<Option<C>>,
}

impl<C: Copy> OriginDimensions for Panel<C> {
    fn size(&self) -> Size {
        self.size
    }
}

impl<C: Levels> DrawTarget for Panel<C> {
    type Color = C;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<C>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(point, color) in pixels {
            let place = &mut self.pixels[point.y as usize * self.size.width as usize + point.x as usize];
            assert!(place.is_none(), "{point:?} is drawn twice");
            *place = Some(color);
        }
        Ok(())
    }
}

fn check_display<C: Levels + PartialEq + core::fmt::Debug>(dither: Dither<C>) {
    let screen = (61, 45);
    for rows in [1, 7, 45] {
        let pixels = usize::from(screen.0) * rows;
        let (mut color, mut depth) = (vec![0; pixels], vec![0; pixels]);
        let renderer = Renderer::<Gray8>::new(Size::new(screen.0.into(), screen.1.into()))
            .expect("a renderer")
            .with_depth(&mut depth)
            .expect("a renderer");
        let mut records = [0; 20_000];
        let mut renderer = renderer.with_records(&mut records);
        let mut panel = Panel { size: Size::new(61, 45), pixels: vec![None; 61 * 45] };
        let sink = DitheredDisplay::new(&mut panel, dither);
        let torus = Torus::gouraud(Size::new(61, 45), Angle16(4000));
        renderer
            .frame_to(sink, &mut color, Gray8::new(70), |scene| torus.draw(scene))
            .expect("the same scene in each call");
        for (k, grey) in greys(screen).into_iter().enumerate() {
            let expected = dither.color(grey, (k as i32 % 61, k as i32 / 61));
            assert_eq!(panel.pixels[k], Some(expected), "pixel {k} in strips of {rows} rows");
        }
    }
}

#[test]
fn displays_of_few_levels_get_the_same_pixels_as_bytes() {
    check_display::<BinaryColor>(Dither::BAYER_8);
    check_display::<Gray2>(Dither::BAYER_4);
    check_display::<Gray4>(Dither::BAYER_8);
}

#[test]
fn colours_are_packed_by_their_luma() {
    fn bytes<P: PixelFormat>(background: P::Color, rows: u16) -> Vec<u8> {
        let mut bytes = Vec::new();
        torus::<P, Pages>((128, 64), rows, Dither::BAYER_8, background, |_, packed| bytes.extend_from_slice(packed));
        bytes
    }
    let grey = bytes::<Gray8>(Gray8::new(70), 64);
    let differ =
        |other: Vec<u8>| -> u32 { grey.iter().zip(&other).map(|(a, b): (&u8, &u8)| (*a ^ *b).count_ones()).sum() };
    // Grey strips interpolate luma, and round it; RGB565 has lost bits.
    let (full, of_565) =
        (differ(bytes::<Rgb888>(Rgb888::new(70, 70, 70), 64)), differ(bytes::<Rgb565>(Rgb565::new(8, 17, 8), 8)));
    assert!(full < 128 * 64 / 100, "{full} pixels of RGB888 differ");
    assert!(of_565 < 128 * 64 / 20, "{of_565} pixels of RGB565 differ");
}

/// Luma is interpolated as one quantity: within 1 of that of the channels in 8 bits, which are themselves rounded.
#[test]
fn luma_of_smooth_shading_is_that_of_its_colours() {
    let mut worst = 0_f64;
    for seed in 0..60 {
        let soup = support::Soup::new(&mut reference::rng::Rng::new(seed), 30);
        let (mesh, state) = (soup.mesh(), State { cull: Cull::None, ..State::DEFAULT });
        let (grey, ..) = support::whole::<Gray8>((150, 110), Gray8::new(0), |scene| {
            scene.draw_with(state, &mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
        });
        let (colors, ..) = support::whole::<Rgb888>((150, 110), Rgb888::new(0, 0, 0), |scene| {
            scene.draw_with(state, &mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
        });
        for (place, (grey, [r, g, b])) in grey.into_iter().zip(colors).enumerate() {
            let exact = 0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b);
            let error = (f64::from(grey) - exact).abs();
            assert!(error <= 1.5, "seed {seed}, pixel {place}: {grey}, exactly {exact}");
            worst = worst.max(error);
        }
    }
    assert!(worst > 0.5, "the pictures have no colours");
}

/// A triangle over a screen of 16×12, half white: as the bytes of an SSD1306 draw it, eight rows a byte.
#[test]
fn picture_of_a_triangle_in_pages() {
    const BACK: i32 = 1 << 16;
    let corner = |x: i32, y: i32| [x, y, 0, BACK].map(Scalar::from_bits);
    let corners = [corner(-BACK, BACK), corner(-BACK, -BACK), corner(BACK, -BACK)];
    let mesh = Mesh::new(MeshData::new(Positions::Homogeneous(&corners))).expect("a mesh");
    fn draw<F: Framebuffer<Format = Gray8>>(scene: &mut Scene<'_, F>, mesh: &Mesh<'_>) {
        scene.draw(mesh, &Projective::IDENTITY, &Flat::unlit(Rgb888::CSS_WHITE));
    }
    let (color, depth, records) = (&mut [0; 16 * 8], &mut [0; 16 * 8], &mut [0; 64]);
    let renderer =
        Renderer::<Gray8>::new(Size::new(16, 12)).expect("a renderer").with_depth(depth).expect("a renderer");
    let mut renderer = renderer.with_records(records);
    let mut bytes = [0xFF; 16];
    let mut packer = Packer::<Pages>::new(Size::new(16, 12), 8, Dither::BAYER_8, &mut bytes).expect("a packer");
    let mut rows = vec![String::new(); 16];
    let sink = |strip: &StripPixels<'_, Gray8>| {
        let first = strip.area().top_left.y as usize;
        for byte in packer.pack(strip) {
            for bit in 0..8 {
                rows[first + bit].push(if byte >> bit & 1 == 1 { '#' } else { '.' });
            }
        }
        Ok::<(), Infallible>(())
    };
    // The rest is of grey 188, half of white's light.
    renderer.frame_to(sink, color, Gray8::new(188), |scene| draw(scene, &mesh)).expect("");
    let picture = "\
#.#.#.#.#.#.#.#.
##.#.#.#.#.#.#.#
###.#.#.#.#.#.#.
######.#.#.#.#.#
#######.#.#.#.#.
########.#.#.#.#
#########.#.#.#.
##########.#.#.#
###########.#.#.
##############.#
###############.
################
................
................
................
................
";
    assert_eq!(rows.join("\n") + "\n", picture);
}

#[test]
fn packers_that_cannot_work_are_refused() {
    let refused = |(width, height), rows, bytes: usize| {
        Packer::<Pages>::new(Size::new(width, height), rows, Dither::BAYER_8, &mut vec![0; bytes])
            .expect_err("it cannot work")
    };
    assert_eq!(refused((128, 64), 12, 1024), PackerError::PartialPages { rows: 12, page: 8 });
    assert_eq!(refused((128, 64), 16, 255), PackerError::TooShort { bytes: 255, needed: 256 });
    assert_eq!(refused((128, 60), 64, 1023), PackerError::TooShort { bytes: 1023, needed: 1024 });
    assert_eq!(refused((128, 64), 12, 1024).to_string(), "strips of 12 rows, but 8 rows share a byte");
    assert_eq!(refused((128, 64), 16, 255).to_string(), "buffer of 255 bytes, a packed strip has 256");
    // One strip for the whole screen may end anywhere, and rows may too.
    Packer::<Pages>::new(Size::new(128, 60), 60, Dither::BAYER_8, &mut [0; 1024]).expect("the last page is not full");
    Packer::<Rows<Gray4>>::new(Size::new(127, 60), 7, Dither::BAYER_8, &mut [0; 64 * 7]).expect("rows end bytes");
}
