//! A pixel in each format, and the packing of a pixel.

#[cfg(target_os = "none")]
pub use counting::count;

/// Names of the formats.
#[cfg(not(target_os = "none"))]
pub const FORMATS: [&str; 9] = [
    "Rgb565",
    "Rgb565Be",
    "Bgr565Be",
    "Rgb332",
    "Rgb888",
    "Gray8",
    "Dithered<Rgb565>",
    "Dithered<Rgb565Be>",
    "Dithered<Rgb332>",
];

/// Names of the packers.
#[cfg(not(target_os = "none"))]
pub const PACKERS: [&str; 5] = [
    "Packer<Pages>",
    "Packer<Rows<BinaryColor>>",
    "Packer<RowsLowFirst<BinaryColor>>",
    "Packer<Rows<Gray2>>",
    "Packer<Rows<Gray4>>",
];

#[cfg(target_os = "none")]
mod counting {
    use crate::count::ticks_of;
    use crate::counting::{Static, lend};
    use crate::grids::{self, HEIGHT, Memory, SCREEN};
    use core::hint::black_box;
    use semihosting::println;
    use zstrip::color::{Bgr565Be, Dither, Dithered, PixelFormat, Rgb332, Rgb565Be};
    use zstrip::embedded_graphics_core::pixelcolor::{BinaryColor, Gray2, Gray4, Gray8, Rgb565, Rgb888};
    use zstrip::math::{Projective, Scalar};
    use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
    use zstrip::shader::Gouraud;
    use zstrip::target::{PackedFormat, Packer, Pages, Rows, RowsLowFirst, StripPixels};
    use zstrip::{Cull, State};

    const EDGE: i32 = 1 << 16;

    const fn corner(x: i32, y: i32) -> [Scalar; 4] {
        [Scalar::from_bits(x), Scalar::from_bits(y), Scalar::from_bits(EDGE / 2), Scalar::from_bits(EDGE)]
    }

    static CORNERS: [[Scalar; 4]; 4] =
        [corner(-EDGE, EDGE), corner(-EDGE, -EDGE), corner(EDGE, EDGE), corner(EDGE, -EDGE)];

    static RECTANGLE: Mesh<'static> = Mesh::constant(MeshData {
        topology: Topology::Strip,
        colors: Some(&[[255, 0, 30], [0, 99, 200], [60, 255, 0], [255, 255, 255]]),
        ..MeshData::new(Positions::Homogeneous(&CORNERS))
    });

    /// Draws a Gouraud shaded rectangle over the screen, with depth.
    fn draw<P: PixelFormat>(name: &str, buffers: &mut Static) {
        let state = State { cull: Cull::None, ..State::DEFAULT };
        for (kind, is_drawn) in [("empty", false), ("format", true)] {
            let ticks = ticks_of(|| {
                grids::frame::<P>(lend(buffers, HEIGHT), &mut |strip| _ = black_box(strip), &mut |scene| {
                    if is_drawn {
                        scene.draw_with(state, &RECTANGLE, &Projective::IDENTITY, &Gouraud::vertex_colors());
                    }
                })
            });
            println!("{kind}/{name} pixels {ticks}");
        }
    }

    /// Packs a strip of all pixels.
    fn pack<F: PackedFormat>(name: &str, buffers: &mut Static, dither: Dither<F::Color>) {
        let Static { color, depth, records, packed } = buffers;
        let mut packer = Packer::<F>::new(SCREEN, SCREEN.height, dither, packed).expect("strips fit");
        let color: &mut [u8] = zstrip::bytemuck::cast_slice_mut(color);
        let memory = Memory::<Gray8> { color: &mut color[..grids::WIDTH * HEIGHT], depth, records };
        let state = State { cull: Cull::None, ..State::DEFAULT };
        let pack = &mut |strip: &StripPixels<'_, Gray8>| {
            let ticks = ticks_of(|| black_box(packer.pack(strip)).len());
            println!("packer/{name} pixels {ticks}");
        };
        grids::frame(memory, pack, &mut |scene| {
            scene.draw_with(state, &RECTANGLE, &Projective::IDENTITY, &Gouraud::vertex_colors());
        });
    }

    /// Prints a line for each format and packer.
    pub fn count(buffers: &mut Static) {
        draw::<Rgb565>("Rgb565", buffers);
        draw::<Rgb565Be>("Rgb565Be", buffers);
        draw::<Bgr565Be>("Bgr565Be", buffers);
        draw::<Rgb332>("Rgb332", buffers);
        draw::<Rgb888>("Rgb888", buffers);
        draw::<Gray8>("Gray8", buffers);
        draw::<Dithered<Rgb565>>("Dithered<Rgb565>", buffers);
        draw::<Dithered<Rgb565Be>>("Dithered<Rgb565Be>", buffers);
        draw::<Dithered<Rgb332>>("Dithered<Rgb332>", buffers);
        pack::<Pages>("Packer<Pages>", buffers, Dither::BAYER_8);
        pack::<Rows<BinaryColor>>("Packer<Rows<BinaryColor>>", buffers, Dither::BAYER_8);
        pack::<RowsLowFirst<BinaryColor>>("Packer<RowsLowFirst<BinaryColor>>", buffers, Dither::BAYER_8);
        pack::<Rows<Gray2>>("Packer<Rows<Gray2>>", buffers, Dither::BAYER_8);
        pack::<Rows<Gray4>>("Packer<Rows<Gray4>>", buffers, Dither::BAYER_8);
    }
}
