//! Constructors and functions on numbers, with any numbers: no panic, results in range, and those of a model where
//! there is a simple one. Functions that say *Panics* in their documentation are left out.

use crate::Hash;
use crate::source::Source;
use zstrip::color::{Dither, PixelFormat, Rgb332, Rgb565Be, Rgba8888};
use zstrip::embedded_graphics_core::geometry::{Point, Size};
use zstrip::embedded_graphics_core::pixelcolor::{BinaryColor, Gray2, Gray4, Gray8, Rgb565, Rgb888};
use zstrip::frame::{FramebufferRenderer, RamBudget, Renderer};
use zstrip::internals::{ClipVertex, Line, Outcode, PixelRect, project, signed_area, square};
use zstrip::light::LitColor;
use zstrip::math::{Affine, Angle16, DepthPrecision, Pixels, Projective, Scalar, Vec3};
use zstrip::mesh::{
    Bounds, BoundsNode, LineTopology, Lines, Mesh, MeshData, Points, Positions, Topology, Vertices, edges, view_depth,
};
use zstrip::shader::{FogCurve, FogTable};
use zstrip::target::{FrameSlice, records_len};
use zstrip::vertex::{Perspective, ScreenVertex, SortScratch, Varyings, Viewport, painters_order};
use zstrip::{ScreenPoint, Smooth, Thick};

pub fn run(input: &[u8]) -> u64 {
    let mut source = Source::new(input);
    let mut hash = Hash::default();
    match source.below(24) {
        0 => vectors(&mut source, &mut hash),
        1 => affines(&mut source, &mut hash),
        2 => inverses(&mut source, &mut hash),
        3 => lenses(&mut source, &mut hash),
        4 => compositions(&mut source, &mut hash),
        5 => precisions(&mut source, &mut hash),
        6 => fog(&mut source, &mut hash),
        7 => viewports(&mut source, &mut hash),
        8 => budgets(&mut source, &mut hash),
        9 => angles(&mut source, &mut hash),
        10 => formats(&mut source, &mut hash),
        11 => dithers(&mut source, &mut hash),
        12 | 13 => meshes(&mut source, &mut hash),
        14 => lines(&mut source, &mut hash),
        15 => screen_points(&mut source, &mut hash),
        16 => clip_vertices(&mut source, &mut hash),
        17 => varyings(&mut source, &mut hash),
        18 => orders(&mut source, &mut hash),
        19 => renderers(&mut source, &mut hash),
        20 => lights(&mut source, &mut hash),
        21 => pixel_lines(&mut source, &mut hash),
        22 => areas(&mut source, &mut hash),
        _ => colors(&mut source, &mut hash),
    }
    hash.0
}

impl Hash {
    fn ints(&mut self, values: &[i32]) {
        values.iter().for_each(|v| self.add(*v as u64));
    }
}

fn clamped(value: i128) -> i32 {
    value.clamp(i32::MIN.into(), i32::MAX.into()) as i32
}

fn vectors(source: &mut Source<'_>, hash: &mut Hash) {
    let (a, b, factor) = (source.vector(), source.vector(), source.scalar());
    let (p, q) = (a.to_bits().map(i128::from), b.to_bits().map(i128::from));
    for (k, sum) in (a + b).to_bits().into_iter().enumerate() {
        assert_eq!(sum, clamped(p[k] + q[k]), "{a:?} + {b:?}");
    }
    for (k, difference) in (a - b).to_bits().into_iter().enumerate() {
        assert_eq!(difference, clamped(p[k] - q[k]), "{a:?} - {b:?}");
    }
    let dot = p.iter().zip(q).map(|(p, q)| p * q).sum::<i128>();
    let found = i128::from(a.dot(b).to_bits());
    let near = (dot >> 16).clamp(i32::MIN.into(), i32::MAX.into());
    assert!((found - near).abs() <= 1, "the dot product of {a:?} and {b:?} is {found}, not {near}");
    let square = p.iter().map(|p| p * p).sum::<i128>();
    let length = i128::from(a.length().to_bits());
    let within = |l: i128| l < 0 || l * l <= square;
    assert!(
        length == i128::from(i32::MAX) || (within(length - 1) && !within(length + 2)),
        "the length of {a:?}: {length}"
    );
    if let Some(unit) = a.normalized() {
        let found = unit.to_bits().map(|c| f64::from(c) / 65_536.0);
        let norm = (square as f64).sqrt();
        for (found, p) in found.into_iter().zip(p) {
            assert!((found - p as f64 / norm).abs() < 2.0 / 65_536.0, "{a:?} normalized is {found:?}");
        }
        hash.ints(&unit.to_bits());
    } else {
        assert_eq!(a, Vec3::ZERO);
    }
    hash.ints(&(-a).to_bits());
    hash.ints(&a.cross(b).to_bits());
    hash.ints(&(a * factor).to_bits());
    if factor != Scalar::ZERO {
        hash.ints(&(a / factor).to_bits());
    }
    hash.ints(&[length as i32, found as i32]);
}

fn affines(source: &mut Source<'_>, hash: &mut Hash) {
    let (a, b, p) = (source.affine(), source.affine(), source.vector());
    hash.ints((a * b).to_rows().as_flattened());
    hash.ints(a.inverse_rigid().to_rows().as_flattened());
    hash.ints(&(a * p).to_bits());
    hash.ints(&a.transform_vector(p).to_bits());
    if let Ok(camera) = Affine::look_at(source.vector(), source.vector(), source.vector()) {
        // A rotation, within rounding: products of two rows within 2⁻¹⁴ of 0, lengths within 2⁻¹³ of 1.
        let rows = camera.to_rows();
        for (k, row) in rows.iter().enumerate() {
            let next = &rows[(k + 1) % 3];
            let product = |other: &[i32; 4]| (0..3).map(|c| i64::from(row[c]) * i64::from(other[c])).sum::<i64>();
            let (skew, stretch) = (product(next), product(row) - (1 << 32));
            assert!(skew.abs() <= 1 << 18 && stretch.abs() <= 1 << 20, "{camera:?}");
        }
        hash.ints(camera.to_rows().as_flattened());
    }
    hash.ints(Affine::rotation(p, source.angle()).to_rows().as_flattened());
    let (translation, rows) = (a.transform_point(Vec3::ZERO), a.to_rows());
    assert_eq!(translation.to_bits(), [rows[0][3], rows[1][3], rows[2][3]]);
}

fn inverses(source: &mut Source<'_>, hash: &mut Hash) {
    if let Some(inverse) = source.affine().inverse() {
        hash.ints(inverse.to_rows().as_flattened());
    }
    if let Some(inverse) = source.projective().inverse() {
        inverse.to_rows().as_flattened().iter().for_each(|entry| hash.add(*entry as u64));
    }
}

fn lenses(source: &mut Source<'_>, hash: &mut Hash) {
    let (angle, near, far) = (source.angle(), source.scalar(), source.scalar());
    let size = Size::new(source.size(), source.size());
    if let Ok(lens) = Projective::perspective(angle, size, near, far) {
        assert!(near > 0 && near < far && size.width > 0 && size.height > 0, "{near} {far} {size:?}");
        lens.to_rows().as_flattened().iter().for_each(|entry| hash.add(*entry as u64));
    }
    if let Ok(lens) = Projective::orthographic((near, far), (source.scalar(), source.scalar()), (near, far)) {
        assert!(near < far, "{near} {far}");
        lens.to_rows().as_flattened().iter().for_each(|entry| hash.add(*entry as u64));
    }
}

fn compositions(source: &mut Source<'_>, hash: &mut Hash) {
    let (a, b, model) = (source.projective(), source.projective(), source.affine());
    for product in [a * b, a * model] {
        product.to_rows().as_flattened().iter().for_each(|entry| hash.add(*entry as u64));
    }
    assert_eq!(a * model, a.compose_affine(&model));
    for c in a.transform_point(source.vector()) {
        hash.add(c.to_bits() as u64);
    }
    for at in [(0, 0), (3, 3), (4, 0), (usize::MAX, 2)] {
        hash.add(a.entry(at.0, at.1).map_or(1, |entry| entry.to_bits() as u64));
    }
    let bounds = Bounds { center: source.vector(), half: source.vector() };
    hash.add(view_depth(&a, &bounds) as u64);
}

fn precisions(source: &mut Source<'_>, hash: &mut Hash) {
    let (near, far, distance, bin) = (source.scalar(), source.scalar(), source.scalar(), source.scalar());
    if let Ok(precision) = DepthPrecision::new(near, far) {
        assert!(near > 0 && near < far);
        let depth = precision.depth(distance);
        let back = precision.distance(depth);
        assert!(distance < near || distance > far || (near..=far).contains(&back), "{near} {far} {depth} {back}");
        hash.ints(&[depth.into(), back.to_bits()]);
        hash.add(precision.bin(distance).to_bits() as u64);
        hash.add(precision.uniform_bin().to_bits() as u64);
    }
    if let Ok(near) = DepthPrecision::near_for(far, distance, bin) {
        assert!(near > 0 && near <= distance, "near {near}, distance {distance}");
        hash.ints(&[near.to_bits()]);
    }
}

fn fog(source: &mut Source<'_>, hash: &mut Hash) {
    let (near, far) = (source.scalar(), source.scalar());
    let curve = match source.below(3) {
        0 => FogCurve::Linear { start: source.scalar(), end: source.scalar() },
        1 => FogCurve::Exponential { density: source.scalar() },
        _ => FogCurve::ExponentialSquared { density: source.scalar() },
    };
    let z = source.u16();
    let made =
        if source.flag() { FogTable::perspective(near, far, curve) } else { FogTable::orthographic(near, far, curve) };
    if let Ok(table) = made {
        assert!(near < far);
        let (here, behind) = (table.transmittance(z), table.transmittance(z.saturating_add(700)));
        // Negative densities make no fog of a decreasing kind.
        hash.ints(&[here.into(), behind.into()]);
    }
}

fn viewports(source: &mut Source<'_>, hash: &mut Hash) {
    let (corner, size) = (Point::new(source.int(), source.int()), Size::new(source.size(), source.size()));
    match Viewport::new(corner, size) {
        Ok(viewport) => {
            assert_eq!((viewport.top_left(), viewport.size()), (corner, size));
            assert!(size.width <= 4096 && size.height <= 4096 && corner.x.abs() <= 8192 && corner.y.abs() <= 8192);
            hash.add(1);
        }
        Err(error) => assert!(
            size.width == 0
                || size.height == 0
                || size.width > 4096
                || size.height > 4096
                || corner.x.unsigned_abs() > 8192
                || corner.y.unsigned_abs() > 8192,
            "{error:?}"
        ),
    }
}

/// Sizes that no machine's words hold may saturate; they do not wrap.
fn budgets(source: &mut Source<'_>, hash: &mut Hash) {
    let (width, rows, height) = (source.size(), source.size(), source.size());
    let [draws, vertices, varyings, triangles] = core::array::from_fn(|_| source.size() as usize);
    let budget = RamBudget::new::<Rgb888>(width, rows);
    let pixels = u128::from(width) * u128::from(rows);
    let fits = |bytes: u128| usize::try_from(bytes).unwrap_or(usize::MAX);
    assert_eq!(budget.color, fits(3 * pixels), "{width} x {rows}");
    assert_eq!(budget.depth, fits(2 * pixels), "{width} x {rows}");
    let budget = budget.with_records(draws, height, vertices, varyings, triangles);
    assert!(budget.total() >= budget.color && budget.total() >= budget.records);
    assert!(records_len(height as usize, draws, vertices, varyings, triangles) >= triangles);
    let even = RamBudget::even_rows(height % 5000, rows);
    assert!(even <= rows.max(1) && (even == 0 || (height % 5000).is_multiple_of(even)), "{height} {rows}: {even}");
    hash.add(even.into());
}

fn angles(source: &mut Source<'_>, hash: &mut Hash) {
    let (angle, degrees, times) = (source.angle(), source.int(), source.int());
    let (sin, cos) = (angle.sin().to_bits(), angle.cos().to_bits());
    let exact = f64::from(angle.0) / 65_536.0 * core::f64::consts::TAU;
    assert!((f64::from(sin) / 65_536.0 - exact.sin()).abs() < 2.0 / 65_536.0, "sin {angle:?}");
    assert!((f64::from(cos) / 65_536.0 - exact.cos()).abs() < 2.0 / 65_536.0, "cos {angle:?}");
    let turned = Angle16::from_degrees(degrees);
    let exact = (i64::from(degrees) * 65_536).rem_euclid(360 * 65_536) as f64 / 360.0;
    let error = (f64::from(turned.0) - exact).abs();
    assert!(error <= 1.0 || error >= 65_535.0, "{degrees} degrees are {turned:?}");
    hash.ints(&[sin, cos, turned.0.into(), (angle * times).0.into(), angle.to_degrees().to_bits()]);
    hash.ints(&[Angle16::from_degrees_fixed(source.scalar()).0.into(), (-angle + turned - angle).0.into()]);
    if times != 0 {
        hash.add((angle / times).0.into());
    }
}

fn format<P: PixelFormat>(source: &mut Source<'_>, hash: &mut Hash) {
    let (a, b): ([u8; 3], [u8; 3]) = ([source.u8(), source.u8(), source.u8()], [source.u8(), source.u8(), source.u8()]);
    let (x, y, weight) = (source.int(), source.int(), u32::from(source.u8()) + u32::from(source.flag()));
    let (p, q) = (P::pack(a), P::pack(b));
    hash.bytes(zstrip::bytemuck::bytes_of(&P::mix(p, q, weight.min(256))));
    hash.bytes(zstrip::bytemuck::bytes_of(&P::add(p, q)));
    hash.bytes(zstrip::bytemuck::bytes_of(&P::pack_at(a, (x, y))));
    hash.bytes(zstrip::bytemuck::bytes_of(&P::pack_rgba([a[0], a[1], a[2], b[0]], (x, y))));
    hash.bytes(zstrip::bytemuck::bytes_of(&P::from_rgb565(x as u16)));
    hash.bytes(zstrip::bytemuck::bytes_of(&P::from_color(P::to_color(q))));
    hash.add(P::luma(p).into());
    // What a pixel unpacks to packs to the same pixel, and a mix of a pixel with itself is this pixel.
    let again = P::pack(P::unpack(p));
    assert_eq!(zstrip::bytemuck::bytes_of(&again), zstrip::bytemuck::bytes_of(&p));
    assert_eq!(zstrip::bytemuck::bytes_of(&P::mix(p, p, weight.min(256))), zstrip::bytemuck::bytes_of(&p));
}

fn formats(source: &mut Source<'_>, hash: &mut Hash) {
    match source.below(6) {
        0 => format::<Rgb565>(source, hash),
        1 => format::<Rgb565Be>(source, hash),
        2 => format::<Rgb888>(source, hash),
        3 => format::<Gray8>(source, hash),
        4 => format::<Rgb332>(source, hash),
        _ => format::<Rgba8888>(source, hash),
    }
}

fn dithers(source: &mut Source<'_>, hash: &mut Hash) {
    let (grey, at) = (source.u8(), (source.int(), source.int()));
    for dither in [Dither::<BinaryColor>::NEAREST, Dither::BAYER_4, Dither::BAYER_8, Dither::BRIGHT_4] {
        let level = dither.level(grey, at);
        assert!(level <= 1 && dither.level(0, at) == 0 && dither.level(255, at) == 1);
        hash.add(level.into());
    }
    for dither in
        [Dither::<Gray2>::NEAREST, Dither::BAYER_4, Dither::BAYER_8, Dither::<Gray2>::BAYER_8.on_linear_panel()]
    {
        assert!(dither.level(grey, at) <= 3 && dither.level(255, at) == 3);
        hash.add(dither.level(grey, at).into());
    }
    for dither in
        [Dither::<Gray4>::NEAREST, Dither::BAYER_4, Dither::BAYER_8, Dither::<Gray4>::BAYER_8.on_linear_panel()]
    {
        assert!(dither.level(grey, at) <= 15 && dither.level(255, at) == 15);
        hash.add(dither.level(grey, at).into());
    }
}

/// Meshes of a few vertices with any slices: what is accepted has all its indices in range.
fn meshes(source: &mut Source<'_>, hash: &mut Hash) {
    let (count, length) = (source.below(7), source.below(13));
    let points: [Vec3; 6] = core::array::from_fn(|k| if k < count { source.vector() } else { Vec3::ZERO });
    let indices: [u16; 12] = core::array::from_fn(|k| if k < length { source.u8().into() } else { 0 });
    let indices = &indices.map(|k| if k < 250 { k % 7 } else { u16::MAX })[..length];
    let topology = source.pick(&[Topology::Triangles, Topology::Strip, Topology::Fan, Topology::Quads]);
    let options = source.u8();
    let bounds = Bounds { center: source.vector(), half: source.vector() };
    let nodes: [BoundsNode; 3] = core::array::from_fn(|_| BoundsNode {
        bounds: if options & 64 == 0 { bounds } else { Bounds { center: source.vector(), half: source.vector() } },
        skip: source.below(5) as u16,
        first_triangle: source.below(5) as u16,
        triangles: source.below(5) as u16,
    });
    let data = MeshData {
        topology,
        indices: (options & 1 == 0).then_some(indices),
        normals: (options & 2 != 0).then_some(&[[0; 3]; 6][..6 - usize::from(options >> 7)]),
        bounds: (options & 4 != 0).then_some(bounds),
        hierarchy: (options & 8 != 0).then_some(&nodes[..source.below(4)]),
        ..MeshData::new(Positions::Exact(&points[..count]))
    };
    let Ok(mesh) = Mesh::new(data) else { return };
    let mut found = 0;
    while let Some(corners) = mesh.triangle(found) {
        assert!(corners.iter().all(|k| usize::from(*k) < count), "{corners:?} of {count}");
        found += 1;
    }
    assert_eq!(found, mesh.triangle_count());
    let bounds = mesh.bounds();
    for vertex in 0..count {
        let p = mesh.position(vertex).to_bits();
        for ((p, center), half) in p.into_iter().zip(bounds.center.to_bits()).zip(bounds.half.to_bits()) {
            assert!(half >= 0 || options & 4 != 0, "{bounds:?}");
            // Half of all 32-bit numbers is one more than fits. Bounds that are given may be one unit too narrow.
            let reach = u64::from(half.unsigned_abs()) + u64::from(half == i32::MAX || options & 4 != 0);
            assert!(i64::from(p).abs_diff(center.into()) <= reach, "{p} is not in {bounds:?}");
        }
    }
    if let Some(nodes) = mesh.data().hierarchy {
        // Each triangle is in one leaf, and boxes have no negative size.
        for triangle in 0..mesh.triangle_count() {
            let holds = |node: &&BoundsNode| {
                (node.first_triangle..node.first_triangle + node.triangles).contains(&(triangle as u16))
            };
            assert_eq!(nodes.iter().filter(holds).count(), 1, "triangle {triangle} in {nodes:?}");
        }
        assert!(nodes.iter().all(|node| node.bounds.half.to_bits().iter().all(|half| *half >= 0)), "{nodes:?}");
    }
    let mut room = [[0; 2]; 30];
    if let Ok(edges) = edges(&mesh, &mut room[..source.below(31)]) {
        assert!(edges.iter().flatten().all(|k| usize::from(*k) < count));
        hash.add(edges.len() as u64);
    }
    hash.add(found as u64);
    hash.ints(&bounds.half.to_bits());
}

fn lines(source: &mut Source<'_>, hash: &mut Hash) {
    let (count, length) = (source.below(6), source.below(9));
    let points: [Vec3; 5] = core::array::from_fn(|_| source.vector());
    let indices: [u16; 8] = core::array::from_fn(|_| source.below(6) as u16);
    let topology = source.pick(&[LineTopology::Pairs, LineTopology::Strip, LineTopology::Loop]);
    let vertices = Vertices::new(Positions::Exact(&points[..count]));
    let indices = source.flag().then_some(&indices[..length]);
    if let Ok(lines) = Lines::new(vertices, topology, indices) {
        let mut found = 0;
        while let Some(ends) = lines.line(found) {
            assert!(ends.iter().all(|k| usize::from(*k) < count), "{ends:?} of {count}");
            found += 1;
        }
        assert_eq!(found, lines.count());
        hash.add(found as u64);
    }
    assert_eq!(Points::new(vertices).map(|points| points.vertices().vertex_count()), Ok(count));
}

fn screen_points(source: &mut Source<'_>, hash: &mut Hash) {
    let (x, y) = (source.int(), source.int());
    for point in [
        ScreenPoint::new(Pixels::from_bits(x), Pixels::from_bits(y)),
        ScreenPoint::corner(x as i16, y as i16),
        ScreenPoint::center(x as i16, y as i16),
        ScreenPoint::from(Point::new(x, y)),
    ] {
        hash.ints(&[point.x().to_bits(), point.y().to_bits()]);
        let back = Point::from(point);
        hash.ints(&[back.x, back.y]);
    }
    let _ = (Thick::new(Pixels::from_bits(x)), Smooth::new(Pixels::from_bits(y)));
}

fn clip_vertices(source: &mut Source<'_>, hash: &mut Hash) {
    // Clip space has 55 bits and a sign.
    let [x, y, z, w] = core::array::from_fn(|_| source.long() >> 8);
    let vertex = ClipVertex { x, y, z, w };
    let code = Outcode::of(&vertex).0;
    assert_eq!(code & Outcode::NEAR != 0, z < 0, "{vertex:?}");
    assert_eq!(code & Outcode::FAR != 0, z > w, "{vertex:?}");
    if let Some(v) = project(&vertex) {
        assert!(w > 0 && v.x.abs() < 1 << 23 && v.y.abs() < 1 << 23, "{vertex:?} is at {v:?}");
        hash.ints(&[v.x, v.y, v.z.into()]);
    }
    hash.add(code.into());
}

fn varyings(source: &mut Source<'_>, hash: &mut Hash) {
    let (u, v, s, pixels) = (source.int(), source.int(), source.int(), source.int());
    let mut varyings = Perspective::<2, 4>::new([u, v], [s]);
    assert_eq!(varyings.corrected(), [u, v]);
    varyings.step(&varyings.clone());
    varyings.advance(&varyings.clone(), pixels);
    varyings.set_inverse_w(pixels as u32);
    hash.ints(varyings.as_ref());
    let mut plain = [u, v, s];
    plain.advance(&[v, s, u], pixels);
    plain.step(&[v, s, u]);
    hash.ints(&plain);
}

fn orders(source: &mut Source<'_>, hash: &mut Hash) {
    let points: [Vec3; 6] = core::array::from_fn(|_| source.modest_vector());
    let indices: [u16; 12] = core::array::from_fn(|_| source.below(6) as u16);
    let data = MeshData { indices: Some(&indices), ..MeshData::new(Positions::Exact(&points)) };
    let mesh = Mesh::new(data).expect("four triangles");
    let viewport = Viewport::full(Size::new(64, 48)).expect("a viewport");
    let (mut scratch, mut sorted) = ([SortScratch::default(); 5], [9; 15]);
    let (places, room) = (source.below(6), source.below(16));
    let report = painters_order(&mesh, &source.projective(), &viewport, &mut scratch[..places], &mut sorted[..room]);
    if let Ok(report) = report {
        assert_eq!(report.indices, 12);
        let corners = |all: &[u16]| {
            let mut all: Vec<_> = all.chunks(3).map(<[u16]>::to_vec).collect();
            all.sort();
            all
        };
        assert_eq!(corners(&sorted[..12]), corners(&indices));
        sorted.iter().for_each(|k| hash.add((*k).into()));
    }
}

fn renderers(source: &mut Source<'_>, hash: &mut Hash) {
    let (size, pixels) = (Size::new(source.size(), source.size()), source.below(80));
    let (mut depth, mut color, stride) = ([0; 79], [0; 79], source.size() as usize);
    let legal = (1..=4096).contains(&size.width) && (1..=4096).contains(&size.height);
    let renderer = Renderer::<Gray8>::new(size);
    assert_eq!(renderer.is_ok(), legal, "{size:?}");
    if let Ok(renderer) = renderer {
        let rows = renderer.strip_rows(usize::MAX);
        assert_eq!(rows, size.height);
        let with = renderer.with_depth(&mut depth[..pixels.min(79)]);
        assert_eq!(with.is_ok(), pixels.min(79) >= size.width as usize);
        hash.add(with.map_or(0, |with| with.strip_rows(40)).into());
    }
    assert_eq!(FramebufferRenderer::new(size).is_ok(), legal);
    let needed = match u128::from(size.height) {
        0 => 0,
        height => (height - 1) * stride as u128 + u128::from(size.width),
    };
    let slice = FrameSlice::<Gray8>::with_stride(&mut color, size, stride);
    assert!(slice.is_err() || (needed <= 79 && stride >= size.width as usize), "{size:?} in rows of {stride}");
    hash.add(slice.is_ok().into());
    hash.add(FrameSlice::<Gray8>::new(&mut color, size).is_ok().into());
}

fn lights(source: &mut Source<'_>, hash: &mut Hash) {
    let kit = crate::things::Kit::new(source);
    let color = LitColor::new([source.int(), source.int(), source.int()]);
    assert!(color.to_bits().iter().all(|c| *c >= 0), "{color:?}");
    hash.ints(&color.to_bits());
    hash.ints(&kit.distances);
}

/// A thin line in a window: at most one pixel per step along its longer axis, all of them in the window.
fn pixel_lines(source: &mut Source<'_>, hash: &mut Hash) {
    let a = [source.coordinate(0), source.coordinate(0)];
    let b = [source.coordinate(a[0]), source.coordinate(a[1])];
    let line = Line::new((a[0], a[1]), (b[0], b[1]));
    let [left, top] = [source.coordinate(a[0]) >> 8, source.coordinate(b[1]) >> 8];
    let window = PixelRect { x: left..left + 8, y: top..top + 8 };
    let (_, pixels) = line.pixels(&window);
    assert!(pixels.len() <= 8);
    for (x, y) in pixels {
        assert!(window.x.contains(&x) && window.y.contains(&y), "({x}, {y}) of {a:?} to {b:?} is not in {window:?}");
        assert!(crate::reference::diamonds::draws(a, b, x, y), "({x}, {y}) is not of {a:?} to {b:?}");
        hash.ints(&[x, y]);
    }
}

fn areas(source: &mut Source<'_>, hash: &mut Hash) {
    let v: [ScreenVertex; 3] =
        core::array::from_fn(|_| ScreenVertex::new(source.coordinate(0), source.coordinate(0), 0));
    let [a, b, c] = &v;
    let area = signed_area(a, b, c);
    let exact = crate::reference::exact::area2(v.each_ref().map(|v| [v.x.into(), v.y.into()]));
    assert_eq!(i128::from(area), exact, "{v:?}");
    let (at, side) = ((source.coordinate(0), source.coordinate(0)), source.u32() & 0xF_FFFF);
    let square = square(at, side);
    assert!(square.x.start <= square.x.end && square.y.start <= square.y.end);
    hash.ints(&[square.x.start, square.x.end, square.y.start, square.y.end]);
}

fn colors(source: &mut Source<'_>, hash: &mut Hash) {
    let [r, g, b] = [source.u8(), source.u8(), source.u8()];
    let color = Rgb888::new(r, g, b);
    assert_eq!(Rgb888::from(LitColor::from(color)), color);
    let state = zstrip::span::DepthBias { constant: source.int() as i16, slope: source.scalar() };
    hash.add(u64::from(r) << 8 | u64::from(state == zstrip::span::DepthBias::NONE));
}
