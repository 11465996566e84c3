//! One scene in all pixel formats and ditherings, side by side in a picture; as firmware, what they cost.
//!
//! ```text
//! cargo run --release --example formats -- --png formats.png
//! ci/formats
//! ```
//! The firmware prints `name pixels ticks` for each run: SysTick's, one in five instructions under QEMU's `-icount`.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[allow(dead_code)]
mod firmware;
#[cfg(not(target_os = "none"))]
mod host;
mod scenes;
#[cfg(target_os = "none")]
#[path = "firmware/ticks.rs"]
mod ticks;

use core::convert::Infallible;
use scenes::Draw;
use zstrip::color::{Dither, Dithered, PixelFormat, Rgb332};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{BinaryColor, Gray2, Gray4, Gray8, Rgb565, Rgb888};
use zstrip::frame::Renderer;
use zstrip::math::Angle16;
use zstrip::target::{Packer, Rows, StripPixels};

#[cfg(target_os = "none")]
mod counting {
    use super::*;
    use core::hint::black_box;
    use cortex_m::peripheral::Peripherals;
    use scenes::Torus;
    use semihosting::println;
    use zstrip::color::{Bgr565Be, Rgb565Be};
    use zstrip::math::{Projective, Scalar};
    use zstrip::mesh::{Mesh, MeshData, Positions};
    use zstrip::shader::Gouraud;
    use zstrip::span::DepthState;
    use zstrip::target::{PackedFormat, Pages, RowsLowFirst};
    use zstrip::{Cull, State};

    const SCREEN: Size = Size::new(320, 240);
    const PIXELS: usize = 320 * 240;

    struct Memory {
        color: [u32; PIXELS],
        depth: [u16; PIXELS],
        records: [u32; 100],
        packed: [u8; PIXELS / 2],
    }

    static mut MEMORY: Memory = Memory { color: [0; _], depth: [0; _], records: [0; _], packed: [0; _] };

    /// Counts a run.
    #[inline(never)]
    fn count(name: &str, mut run: impl FnMut()) {
        let start = ticks::now();
        run();
        let ticks = ticks::now().wrapping_sub(start);
        println!("{name} {PIXELS} {ticks}");
    }

    /// Packs a strip of all pixels.
    fn pack<F: PackedFormat>(name: &str, memory: &mut Memory, dither: Dither<F::Color>) {
        let Memory { color, depth, records, packed } = memory;
        let color: &mut [u8] = bytemuck::cast_slice_mut(color);
        let color = &mut color[..PIXELS];
        let renderer = Renderer::<Gray8>::new(SCREEN).expect("rows fit").with_depth(depth).expect("rows fit");
        let mut renderer = renderer.with_records(records);
        let mut packer = Packer::<F>::new(SCREEN, SCREEN.height, dither, packed).expect("strips fit");
        let torus = Torus::gouraud(SCREEN, Angle16(0));
        let mut frame = renderer.begin(Gray8::new(99));
        while let Some(strip) = frame.next_strip(color, |scene| torus.draw(scene)).expect("the same scene") {
            count(name, || {
                black_box(packer.pack(&strip));
            });
        }
    }

    /// Draws a Gouraud shaded rectangle over the screen, with depth.
    fn draw<P: PixelFormat>(name: &str, memory: &mut Memory, depth_state: DepthState) {
        const EDGE: i32 = 1 << 16;
        const fn corner(x: i32, y: i32) -> [Scalar; 4] {
            [Scalar::from_bits(x), Scalar::from_bits(y), Scalar::from_bits(EDGE / 2), Scalar::from_bits(EDGE)]
        }
        static CORNERS: [[Scalar; 4]; 4] =
            [corner(-EDGE, EDGE), corner(-EDGE, -EDGE), corner(EDGE, EDGE), corner(EDGE, -EDGE)];
        let colors = [[255, 0, 30], [0, 99, 200], [60, 255, 0], [255, 255, 255]];
        let data = MeshData::new(Positions::Homogeneous(&CORNERS));
        let topology = zstrip::mesh::Topology::Strip;
        let mesh = Mesh::new(MeshData { topology, colors: Some(&colors), ..data }).expect("a mesh");
        let Memory { color, depth, records, .. } = memory;
        let color = &mut bytemuck::cast_slice_mut(&mut color[..PIXELS])[..PIXELS];
        let renderer = Renderer::<P>::new(SCREEN).expect("rows fit").with_depth(depth).expect("rows fit");
        let mut renderer = renderer.with_records(records);
        let state = State { cull: Cull::None, depth: depth_state, ..State::DEFAULT };
        let mut frame = |name: &str, is_drawn: bool| {
            count(name, || {
                let sink = |strip: &StripPixels<'_, P>| {
                    black_box(strip);
                    Ok::<(), Infallible>(())
                };
                let stats = renderer.frame_to(sink, color, Rgb888::new(0, 0, 0), |scene| {
                    if is_drawn {
                        scene.draw_with(state, &mesh, &Projective::IDENTITY, &Gouraud::vertex_colors());
                    }
                });
                black_box(stats).expect("the same scene");
            });
        };
        frame("empty", false);
        frame(name, true);
    }

    pub fn run() {
        let memory = &raw mut MEMORY;
        // SAFETY: `run` is called once; this is the only reference.
        let memory = unsafe { &mut *memory };
        let Some(mut peripherals) = Peripherals::take() else {
            return;
        };
        ticks::start(&mut peripherals.SYST);
        pack::<Pages>("Packer<Pages>", memory, Dither::BAYER_8);
        pack::<Rows<BinaryColor>>("Packer<Rows<BinaryColor>>", memory, Dither::BAYER_8);
        pack::<RowsLowFirst<BinaryColor>>("Packer<RowsLowFirst<BinaryColor>>", memory, Dither::BAYER_8);
        pack::<Rows<Gray2>>("Packer<Rows<Gray2>>", memory, Dither::BAYER_8);
        pack::<Rows<Gray4>>("Packer<Rows<Gray4>>", memory, Dither::BAYER_8);
        draw::<Rgb565>("Rgb565", memory, DepthState::LESS);
        draw::<Rgb565Be>("Rgb565Be", memory, DepthState::LESS);
        draw::<Bgr565Be>("Bgr565Be", memory, DepthState::LESS);
        draw::<Rgb332>("Rgb332", memory, DepthState::LESS);
        draw::<Dithered<Rgb565>>("Dithered<Rgb565>", memory, DepthState::LESS);
        draw::<Dithered<Rgb565Be>>("Dithered<Rgb565Be>", memory, DepthState::LESS);
        draw::<Dithered<Rgb332>>("Dithered<Rgb332>", memory, DepthState::LESS);
        draw::<Gray8>("Gray8", memory, DepthState::LESS);
    }
}

#[cfg(target_os = "none")]
use counting::run;

/// Size of one picture, and of all beside each other.
#[cfg(not(target_os = "none"))]
mod sheet {
    use super::*;
    use scenes::Room;
    use zstrip::color::Levels;

    pub const CELL: (usize, usize) = (160, 120);
    const COLUMNS: usize = 5;
    const GAP: usize = 4;

    /// The scene in a format, in red, green and blue.
    fn colors<P: PixelFormat>() -> Vec<[u8; 3]> {
        let pixels = CELL.0 * CELL.1;
        let (mut color, mut depth) = (vec![P::pack([0; 3]); pixels], vec![0; pixels]);
        let renderer = Renderer::<P>::new(Size::new(CELL.0 as u32, CELL.1 as u32))
            .expect("rows fit")
            .with_depth(&mut depth)
            .expect("rows fit");
        let mut records = [0; 16_384];
        let mut renderer = renderer.with_records(&mut records);
        let mut picture = Vec::new();
        let sink = |strip: &StripPixels<'_, P>| {
            picture.extend(strip.pixels().iter().map(|raw| P::unpack(*raw)));
            Ok::<(), Infallible>(())
        };
        let room = Room::new(Size::new(CELL.0 as u32, CELL.1 as u32), Angle16(0));
        renderer.frame_to(sink, &mut color, Rgb888::new(24, 28, 24), |scene| room.draw(scene)).expect("a frame");
        picture
    }

    /// The scene in few greys, as a panel shows its bytes.
    fn greys<C: Levels>(dither: Dither<C>) -> Vec<[u8; 3]> {
        let pixels = CELL.0 * CELL.1;
        let (mut color, mut depth) = (vec![0; pixels], vec![0; pixels]);
        let screen = Size::new(CELL.0 as u32, CELL.1 as u32);
        let renderer = Renderer::<Gray8>::new(screen).expect("a screen").with_depth(&mut depth).expect("rows fit");
        let mut records = [0; 16_384];
        let mut renderer = renderer.with_records(&mut records);
        let mut bytes = vec![0; pixels / 2];
        let mut packer = Packer::<Rows<C>>::new(screen, screen.height, dither, &mut bytes).expect("strips fit");
        let mut picture = Vec::new();
        let sink = |strip: &StripPixels<'_, Gray8>| {
            let (bits, white) = (C::BITS, (1_u32 << C::BITS) - 1);
            for byte in packer.pack(strip) {
                let levels = (0..8 / bits).map(|k| u32::from(*byte) >> (8 - bits * (k + 1)) & white);
                picture.extend(levels.map(|level| [(level * 255 / white) as u8; 3]));
            }
            Ok::<(), Infallible>(())
        };
        let room = Room::new(Size::new(CELL.0 as u32, CELL.1 as u32), Angle16(0));
        renderer.frame_to(sink, &mut color, Gray8::new(26), |scene| room.draw(scene)).expect("a frame");
        picture
    }

    /// All pictures, with their names.
    pub fn cells() -> Vec<(&'static str, Vec<[u8; 3]>)> {
        vec![
            ("Rgb888", colors::<Rgb888>()),
            ("Rgb565", colors::<Rgb565>()),
            ("Dithered<Rgb565>", colors::<Dithered<Rgb565>>()),
            ("Rgb332", colors::<Rgb332>()),
            ("Dithered<Rgb332>", colors::<Dithered<Rgb332>>()),
            ("Gray8", colors::<Gray8>()),
            ("Gray4, NEAREST", greys::<Gray4>(Dither::NEAREST)),
            ("Gray4, BAYER_8", greys::<Gray4>(Dither::BAYER_8)),
            ("Gray2, NEAREST", greys::<Gray2>(Dither::NEAREST)),
            ("Gray2, BAYER_8", greys::<Gray2>(Dither::BAYER_8)),
            ("BinaryColor, NEAREST", greys::<BinaryColor>(Dither::NEAREST)),
            ("BinaryColor, BAYER_8", greys::<BinaryColor>(Dither::BAYER_8)),
            ("BinaryColor, BRIGHT_8", greys::<BinaryColor>(Dither::BRIGHT_8)),
            ("Gray2, BAYER_4", greys::<Gray2>(Dither::BAYER_4)),
            ("Gray4, BAYER_4", greys::<Gray4>(Dither::BAYER_4)),
        ]
    }

    /// Rows of pictures, and their size in pixels.
    pub fn assembled(cells: &[Vec<[u8; 3]>]) -> ((u16, u16), Vec<u8>) {
        let (width, height) = (COLUMNS * (CELL.0 + GAP) + GAP, cells.len().div_ceil(COLUMNS) * (CELL.1 + GAP) + GAP);
        let mut bytes = vec![255; width * height * 3];
        for (k, cell) in cells.iter().enumerate() {
            let (left, top) = (GAP + k % COLUMNS * (CELL.0 + GAP), GAP + k / COLUMNS * (CELL.1 + GAP));
            for (y, row) in cell.chunks(CELL.0).enumerate() {
                let start = ((top + y) * width + left) * 3;
                bytes[start..start + CELL.0 * 3].copy_from_slice(row.as_flattened());
            }
        }
        ((width as u16, height as u16), bytes)
    }
}

#[cfg(not(target_os = "none"))]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1);
    let path = match (args.next().as_deref(), args.next()) {
        (None, _) => "formats.png".to_owned(),
        (Some("--png"), Some(path)) => path,
        _ => return Err("usage: formats [--png FILE]".into()),
    };
    let (names, cells): (Vec<_>, Vec<_>) = sheet::cells().into_iter().unzip();
    let (size, bytes) = sheet::assembled(&cells);
    host::write_png(path.as_ref(), size, &bytes)?;
    println!("{}\nwrote {path}", names.join("\n"));
    Ok(())
}
