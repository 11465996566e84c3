//! Meshes, textures, fog, buffers, packers, budgets: constructors, and what their results return.

use super::{ENDS, Extreme, Table};
use crate::reference::rng::Rng;
use zstrip::color::{Dither, Rgb565Be, Rgba8888};
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{BinaryColor, Gray2, Gray4, Gray8, Rgb565, Rgb888};
use zstrip::frame::{FramebufferRenderer, RamBudget, Renderer};
use zstrip::math::{Scalar, Vec3};
use zstrip::mesh::{
    Bounds, BoundsNode, LineTopology, Lines, Mesh, MeshData, Points, Positions, Topology, Vertices, edges,
};
use zstrip::scene::{Dashed, ScreenPoint, Smooth, Thick};
use zstrip::shader::{FogCurve, FogTable, Textured};
use zstrip::target::{FrameSlice, Framebuffer, PackedFormat, Packer, Pages, Rows, RowsLowFirst, records_len};
use zstrip::texture::{
    Bilinear, Clamp, Filter, Gray8Texel, Image, Keyed, MaskTexel, Mirror, Nearest, PaletteTexel, Repeat, Rgb565LeTexel,
    Rgb565Texel, Rgb888Texel, TexelFormat, Texture, Tile, WithAlpha, Wrap,
};
use zstrip::vertex::{ScreenVertex, SortScratch, Viewport, painters_order};

const SIZES: [usize; 12] =
    [0, 1, 2, 3, 8, 4096, 65_535, 65_536, usize::MAX / 3, usize::MAX / 3 + 1, usize::MAX / 2 + 1, usize::MAX];

#[test]
fn meshes_take_all_values() {
    let (mut table, mut rng) = (Table::start(), Rng::new(11));
    for round in 0..4000 {
        let (mut quantized, mut exact, mut homogeneous) = ([[0; 3]; 7], [Vec3::ZERO; 7], [[Scalar::ZERO; 4]; 7]);
        quantized.iter_mut().for_each(|p| *p = [rng.short(), rng.short(), rng.short()]);
        exact.iter_mut().for_each(|p| *p = rng.vector());
        homogeneous.iter_mut().for_each(|p| *p = [rng.scalar(), rng.scalar(), rng.scalar(), rng.scalar()]);
        let vertices = rng.below(8) as usize;
        let positions = match round % 3 {
            0 => Positions::Quantized { points: &quantized[..vertices], scale: rng.scalar(), offset: rng.vector() },
            1 => Positions::Exact(&exact[..vertices]),
            _ => Positions::Homogeneous(&homogeneous[..vertices]),
        };
        let mut indices = [0_u16; 24];
        indices.iter_mut().for_each(|k| *k = rng.below(vertices.max(1) as u64) as u16);
        if rng.one_in(50) {
            indices[0] = u16::MAX;
        }
        let indices = &indices[..rng.below(25) as usize];
        let topology = rng.pick(&[Topology::Triangles, Topology::Strip, Topology::Fan, Topology::Quads]);
        let bounds = |rng: &mut Rng| Bounds { center: rng.vector(), half: rng.vector() };
        let nodes: [BoundsNode; 3] = core::array::from_fn(|_| BoundsNode {
            bounds: bounds(&mut rng),
            skip: rng.pick(&[0, 1, 2, 3, 4, u16::MAX]),
            first_triangle: rng.pick(&[0, 1, 2, u16::MAX]),
            triangles: rng.pick(&[0, 1, u16::MAX]),
        });
        let data = MeshData {
            topology,
            indices: rng.one_in(2).then_some(indices),
            bounds: rng.one_in(3).then(|| bounds(&mut rng)),
            hierarchy: rng.one_in(4).then_some(&nodes[..]),
            ..MeshData::new(positions)
        };
        let Some(Ok(mesh)) = table.case("Mesh::new", data, || Mesh::new(data)) else { continue };
        for n in SIZES {
            let triangle = table.case("Mesh::triangle", (mesh.data(), n), || mesh.triangle(n)).flatten();
            assert_eq!(triangle.is_some(), n < mesh.triangle_count(), "{n} of {mesh:?}");
            table.case("Mesh::position", (mesh.data(), n), || mesh.position(n));
        }
        let mut room = [[0; 2]; 72];
        let places = rng.below(73) as usize;
        let found = table.case("edges", data, || edges(&mesh, &mut room[..places]).map(|edges| edges.to_vec()));
        if let Some(Ok(found)) = found {
            table.case("Lines::of_mesh", data, || Lines::of_mesh(&mesh, &found).map(|lines| lines.count()));
            // Edges of a mesh with more vertices.
            table.case("Lines::of_mesh", data, || Lines::of_mesh(&mesh, &[[0, u16::MAX]]).is_err());
        }
        let viewport = Viewport::new(Point::new(-8192, 8192), Size::new(4096, 4096)).expect("the largest viewport");
        let mvp = rng.projective();
        let (mut memory, mut order) = ([SortScratch::default(); 24], [0; 72]);
        let (room, places) = (rng.below(25) as usize, rng.below(73) as usize);
        table.case("painters_order", (data, mvp), || {
            painters_order(&mesh, &mvp, &viewport, &mut memory[..room], &mut order[..places]).is_ok()
        });
        let line_topology = rng.pick(&[LineTopology::Pairs, LineTopology::Strip, LineTopology::Loop]);
        let vertices = Vertices { bounds: data.bounds, ..Vertices::new(positions) };
        table.case("Points::new", vertices, || Points::new(vertices).is_ok());
        if let Some(Ok(lines)) =
            table.case("Lines::new", vertices, || Lines::new(vertices, line_topology, data.indices))
        {
            for n in SIZES {
                let line = table.case("Lines::line", (lines, n), || lines.line(n)).flatten();
                assert_eq!(line.is_some(), n < lines.count(), "{n} of {lines:?}");
            }
        }
    }
    table.finish();
}

#[test]
fn fog_is_refused_or_thickens_with_the_distance() {
    let (mut table, mut rng) = (Table::start(), Rng::new(12));
    let density = |rng: &mut Rng| if rng.one_in(2) { rng.scalar() } else { Scalar::from_bits(rng.any_magnitude(20)) };
    let mut made = 0;
    for round in 0..6000 {
        let (near, far) = (rng.scalar(), rng.scalar());
        let curve = match round % 3 {
            0 => FogCurve::Linear { start: rng.scalar(), end: rng.scalar() },
            1 => FogCurve::Exponential { density: density(&mut rng) },
            _ => FogCurve::ExponentialSquared { density: density(&mut rng) },
        };
        for perspective in [true, false] {
            let fog = table.case("FogTable", (near, far, curve, perspective), || match perspective {
                true => FogTable::perspective(near, far, curve),
                false => FogTable::orthographic(near, far, curve),
            });
            let Some(fog) = fog else { continue };
            let nonsense = match curve {
                FogCurve::Linear { start, end } => start > end,
                FogCurve::Exponential { density } | FogCurve::ExponentialSquared { density } => density < 0,
            };
            let planes = near < far && (near > 0 || !perspective);
            assert_eq!(fog.is_ok(), planes && !nonsense, "{near} {far} {curve:?} {perspective}");
            if let Ok(fog) = fog {
                made += 1;
                let mut before = 255;
                for depth in (0..=u16::MAX).step_by(257) {
                    let left = fog.transmittance(depth);
                    assert!(left <= before, "{near} {far} {curve:?}: {left} at {depth}, {before} before");
                    before = left;
                }
            }
        }
    }
    println!("{made} tables");
    assert!(made > 1000);
    table.finish();
}

/// Checks what a texture returns for places in it, beyond it, and through all filters.
fn sample<T: Texture>(table: &mut Table, texture: &T) {
    for (x, y) in ENDS.into_iter().flat_map(|x| ENDS.map(|y| (x, y))) {
        let (u, v) = (x as u32, y as u32);
        table.case("Texture::rgba", (u, v), || (texture.rgba(u, v), texture.rgb565(u, v)));
        table.case("Texture::pixel", (u, v), || texture.pixel::<Rgb565>(u, v));
        table.case("Texture::fetch", (u, v), || texture.fetch::<Rgba8888>(u));
        filter::<T, Repeat>(table, texture, [x, y]);
        filter::<T, Mirror>(table, texture, [x, y]);
        filter::<T, Clamp>(table, texture, [x, y]);
    }
}

fn filter<T: Texture, W: Wrap>(table: &mut Table, texture: &T, uv: [i32; 2]) {
    table.case("Nearest", uv, || Nearest::rgba::<T, W>(texture, uv));
    table.case("Nearest", uv, || Nearest::pixel::<Rgb565, T, W>(texture, uv));
    table.case("Bilinear", uv, || Bilinear::rgba::<T, W>(texture, uv));
    table.case("Bilinear", uv, || Bilinear::pixel::<Rgb888, T, W>(texture, uv));
    table.case("Bilinear", uv, || Bilinear::pixel::<Rgb565, T, W>(texture, uv));
    let size = texture.size();
    table.case("Wrap", (uv, size), || (W::fraction(uv[0]), W::texel(uv[0], size.width), W::texel(uv[1], u32::MAX)));
    table.case("Wrap of nothing", uv, || W::texel(uv[0], 0));
}

#[test]
fn images_take_all_sizes_and_coordinates() {
    fn images<F: TexelFormat>(table: &mut Table, rng: &mut Rng, format: F) {
        let bytes = vec![0xA5; 3 * 67];
        for _ in 0..600 {
            let (size, length) = (Size::new(rng.size(), rng.size()), rng.below(64) as usize);
            let image = table.case("Image::new", (size, length), || Image::new(&bytes[..length], size, format));
            if let Some(Ok(_)) = image {
                let texels = (u64::from(size.width) * F::BITS as u64).div_ceil(8) * u64::from(size.height);
                assert_eq!(length as u64, texels, "{size:?}");
            }
        }
        for size in [Size::new(1, 1), Size::new(5, 3), Size::new(1, 7), Size::new(9, 1)] {
            let length = (size.width as usize * F::BITS).div_ceil(8) * size.height as usize;
            let image = Image::new(&bytes[..length], size, format).expect("the size fits");
            sample(table, &image);
        }
    }
    let (mut table, mut rng) = (Table::start(), Rng::new(13));
    images(&mut table, &mut rng, Rgb565Texel);
    images(&mut table, &mut rng, Rgb565LeTexel);
    images(&mut table, &mut rng, Rgb888Texel);
    images(&mut table, &mut rng, Gray8Texel);
    images(&mut table, &mut rng, MaskTexel([1, 2, 3]));
    images(&mut table, &mut rng, PaletteTexel::<1>(&[]));
    images(&mut table, &mut rng, PaletteTexel::<2>(&[[1; 3]; 3]));
    images(&mut table, &mut rng, Keyed { format: PaletteTexel::<4>(&[[1; 3]; 3]), key: u32::MAX });
    images(&mut table, &mut rng, PaletteTexel::<8>(&[[1; 3]; 3]));
    let texels = [[7; 8]; 4];
    sample(&mut table, &Tile::new(&texels));
    sample(&mut table, &Tile::new(&[[1]]));
    let alpha = WithAlpha::new(Tile::new(&texels), &[0x7F; 16]).expect("four bits for each of 8 x 4 texels");
    sample(&mut table, &alpha);
    let none: &[Tile<'_, 8, 4>] = &[];
    assert!(Textured::mipmapped(none).is_err());
    table.finish();
}

#[test]
fn no_length_is_short_because_a_product_wrapped() {
    // 65,535 columns of 24 bits and 21,846 rows have 2³² + 65,534 bytes.
    let size = Size::new(65_535, 21_846);
    assert!(Image::new(&[7; 65_534], size, Rgb888Texel).is_err());
    let size = Size::new(65_535, 65_535);
    for length in [0, 1, 65_534, 65_535] {
        let bytes = vec![0; length];
        assert!(Image::new(&bytes, size, Rgb565Texel).is_err(), "{length}");
        assert!(Image::new(&bytes, size, PaletteTexel::<1>(&[])).is_err(), "{length}");
        assert!(Packer::<Rows<Gray4>>::new(size, u32::MAX, Dither::NEAREST, &mut vec![0; length]).is_err());
    }
    // 2³² + 1 pixels.
    let side = 65_537;
    assert!(FrameSlice::<Gray8>::new(&mut [0; 131_073], Size::new(side, 65_536)).is_err());
    let exact = |bytes: u64| usize::try_from(bytes).unwrap_or(usize::MAX);
    for (width, rows) in [(65_535, 65_535), (65_536, 65_536), (u32::MAX, 1), (u32::MAX, u32::MAX), (320, 16)] {
        let pixels = u64::from(width) * u64::from(rows);
        let budget = RamBudget::new::<Rgb888>(width, rows);
        assert_eq!(budget.color, exact(pixels.saturating_mul(3)), "{width} x {rows}");
        assert_eq!(budget.depth, exact(pixels.saturating_mul(2)), "{width} x {rows}");
        assert_eq!(budget.total(), budget.color.saturating_add(budget.depth), "{width} x {rows}");
    }
    assert_eq!(RamBudget::new::<Rgb888>(1, 1).with_record_words(usize::MAX).records, usize::MAX);
    assert_eq!(records_len(1, 2, 3, 4, 5), 1 + 4 * 2 + 2 + (2 + 4) * 3 + 3 * 5);
    assert_eq!(records_len(1, 2, 3, 0, 5), 1 + 4 * 2 + 2 * 3 + 3 * 5);
}

#[test]
fn buffers_and_budgets_take_all_sizes() {
    let (mut table, mut rng) = (Table::start(), Rng::new(14));
    for _ in 0..20_000 {
        let size = Size::new(rng.size(), rng.size());
        let n: [usize; 5] = core::array::from_fn(|_| rng.pick(&SIZES));
        let words = table.case("records_len", n, || records_len(n[0], n[1], n[2], n[3], n[4]));
        let [strips, draws, vertices, varyings, triangles] = n.map(|n| n as u128);
        let marks = if varyings > 0 { (vertices + 31 * draws) / 32 } else { 0 };
        let exact =
            (strips + 4 * draws + 3 * triangles + marks).saturating_add((2 + varyings).saturating_mul(vertices));
        assert_eq!(words, Some(usize::try_from(exact).unwrap_or(usize::MAX)), "{n:?}");
        table.case("RamBudget", (size, n), || {
            let budget =
                RamBudget::new::<Rgb888>(size.width, size.height).with_records(n[0], size.width, n[1], n[2], n[3]);
            [budget.total(), budget.without_depth().total(), budget.with_record_words(n[4]).total()]
        });
        let small = (size.width.min(1 << 16), size.height.min(1 << 16));
        table.case("RamBudget::even_rows", small, || RamBudget::even_rows(small.0, small.1));
        let strip_rows = rng.size();
        table.case("Packer::new", (size, strip_rows), || {
            let bytes = &mut [0; 64];
            [
                Packer::<Pages>::new(size, strip_rows, Dither::BAYER_4, bytes).is_ok(),
                Packer::<Rows<Gray2>>::new(size, strip_rows, Dither::BAYER_4, bytes).is_ok(),
                Packer::<RowsLowFirst<BinaryColor>>::new(size, strip_rows, Dither::BAYER_4, bytes).is_ok(),
            ]
        });
        table.case("FrameSlice", (size, n), || {
            let pixels = &mut [0; 64];
            if let Ok(mut slice) = FrameSlice::<Gray8>::with_stride(&mut pixels[..(n[0] & 63)], size, n[1]) {
                slice.row(rng.size());
                slice.span(rng.size(), n[2], n[3]);
                slice.rows(rng.size(), n[4]);
            }
        });
        let depth_len = n[0] & 0xFFF;
        table.case("Renderer::new", (size, n), || {
            let (mut depth, mut records) = (vec![0; depth_len], vec![0; n[1] & 0xFF]);
            let renderer = Renderer::<Rgb565Be>::new(size).ok()?;
            let rows = (renderer.strip_rows(n[2]), renderer.strip_rows(usize::MAX));
            let deep = renderer.with_depth(&mut depth).ok()?.with_records(&mut records);
            Some((rows, deep.strip_rows(n[3]), deep.screen()))
        });
        table.case("FramebufferRenderer::new", size, || FramebufferRenderer::new(size).is_ok());
        let (at, vertex) = (Point::new(rng.bits(), rng.bits()), ScreenVertex::new(rng.bits(), rng.bits(), u16::MAX));
        table.case("Viewport", (at, size), || {
            (Viewport::new(at, size).map(|v| (v.size(), v.top_left())), Viewport::full(size).is_ok())
        });
        let (x, y, width) = (rng.pixels(), rng.pixels(), rng.pixels());
        table.case("ScreenPoint", (at, vertex, x, y), || {
            let points = [ScreenPoint::from(at), ScreenPoint::from(vertex), ScreenPoint::new(x, y)];
            (points.map(Point::from), vertex.pixel(), ScreenPoint::corner(i16::MIN, i16::MAX))
        });
        table.case("strokes", width, || (Thick::new(width), Smooth::new(width), Thick::px(255), Dashed(!0)));
    }
    table.finish();
}

#[test]
fn even_rows_ends_for_the_largest_numbers() {
    for (height, most, rows) in [(u32::MAX, u32::MAX - 1, 1_431_655_765), (4_294_967_291, u32::MAX - 5, 1), (0, 9, 0)] {
        let start = std::time::Instant::now();
        assert_eq!(RamBudget::even_rows(height, most), rows, "{height} {most}");
        println!("{:?}", start.elapsed());
    }
}

#[test]
fn packed_formats_take_all_sizes() {
    fn packs<F: PackedFormat>(table: &mut Table, rng: &mut Rng, dither: Dither<F::Color>) {
        for _ in 0..4000 {
            let (width, y) = (rng.pick(&SIZES), rng.bits());
            let (pixels, bytes) = (rng.below(65) as usize, rng.below(65) as usize);
            table.case("PackedFormat::pack", (width, y, pixels, bytes), || {
                let mut to = [0; 64];
                F::pack::<Gray8>(&dither, &[200; 64][..pixels], width, y, &mut to[..bytes]);
                F::pack::<Gray8>(&dither, &[200; 64][..pixels], width & 7, y, &mut to[..bytes]);
                to
            });
            let (columns, rows) = (rng.size() as u16, rng.size() as u16);
            table.case("PackedFormat::bytes", (columns, rows), || F::bytes(columns, rows));
        }
    }
    let (mut table, mut rng) = (Table::start(), Rng::new(15));
    packs::<Pages>(&mut table, &mut rng, Dither::BAYER_8);
    packs::<Rows<BinaryColor>>(&mut table, &mut rng, Dither::BAYER_8);
    packs::<Rows<Gray2>>(&mut table, &mut rng, Dither::BAYER_8);
    packs::<Rows<Gray4>>(&mut table, &mut rng, Dither::BAYER_8);
    packs::<RowsLowFirst<Gray4>>(&mut table, &mut rng, Dither::BAYER_8);
    table.finish();
}
