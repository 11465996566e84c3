//! What the tests share: frames as whole pictures, random scenes, and numbers as f64.

pub mod accuracy;
pub mod area;
pub mod outlines;

use crate::reference::rng::Rng;
use crate::reference::scenes::clip_soup;
use zstrip::Scene;
use zstrip::color::PixelFormat;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::frame::{FramebufferRenderer, Renderer};
use zstrip::internals::{ClipVertex, Outcode, Transform, clip_triangle, project, weighted};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, Positions};
use zstrip::target::{DepthChoice, RecordsChoice, WithDepth, WithRecords, WithSamples, WithoutRecords};
use zstrip::target::{FrameSlice, Stats, Strip, StripPixels};
use zstrip::vertex::{DepthRange, ScreenVertex, Viewport};

/// Draws a frame into strips of `rows` rows with `records` words of records, and puts it together.
///
/// Panics if a strip comes out of order or with the wrong size.
pub fn strips<P: PixelFormat>(
    (width, height): (u16, u16),
    rows: usize,
    records: usize,
    background: P::Color,
    draw: impl FnMut(&mut Scene<'_, Strip<'_, P, WithDepth, WithRecords>>),
) -> (Vec<P::Raw>, Stats) {
    let pixels = usize::from(width) * rows;
    // Old contents must not matter.
    let mut color = vec![P::pack([0xA5; 3]); pixels];
    let mut depth = vec![0x1234; pixels];
    let mut records = vec![0xDEAD_BEEF; records];
    let renderer = Renderer::<P>::new(Size::new(u32::from(width), u32::from(height)))
        .expect("a renderer")
        .with_depth(&mut depth)
        .expect("a renderer");
    let renderer = renderer.with_records(&mut records);
    collect(renderer, &mut color, background, draw)
}

/// The same by a renderer that knows no records.
pub fn unrecorded_strips<P: PixelFormat>(
    (width, height): (u16, u16),
    rows: usize,
    background: P::Color,
    draw: impl FnMut(&mut Scene<'_, Strip<'_, P, WithDepth, WithoutRecords>>),
) -> (Vec<P::Raw>, Stats) {
    let pixels = usize::from(width) * rows;
    let (mut color, mut depth) = (vec![P::pack([0xA5; 3]); pixels], vec![0x1234; pixels]);
    let renderer = Renderer::new(Size::new(u32::from(width), u32::from(height))).expect("a renderer");
    let renderer = renderer.with_depth(&mut depth).expect("a renderer");
    collect(renderer, &mut color, background, draw)
}

/// The same with `N` samples per pixel. Also returns the colours of samples 1 and up, and all depths, as the last strip
/// left them.
#[allow(clippy::type_complexity)]
pub fn sampled_strips<P: PixelFormat, const N: usize>(
    (width, height): (u16, u16),
    rows: usize,
    records: usize,
    background: P::Color,
    draw: impl FnMut(&mut Scene<'_, Strip<'_, P, WithSamples<N>, WithRecords>>),
) -> (Vec<P::Raw>, Vec<P::Raw>, Vec<u16>, Stats)
where
    WithSamples<N>: DepthChoice,
{
    let pixels = usize::from(width) * rows;
    let mut color = vec![P::pack([0xA5; 3]); pixels];
    let (mut samples, mut depth) = (vec![P::pack([0x5A; 3]); (N - 1) * pixels], vec![0x1234; N * pixels]);
    let mut records = vec![0xDEAD_BEEF; records];
    let renderer = Renderer::<P>::new(Size::new(u32::from(width), u32::from(height)))
        .and_then(|renderer| renderer.with_samples::<N>(&mut depth, &mut samples))
        .expect("a renderer");
    let (picture, stats) = collect(renderer.with_records(&mut records), &mut color, background, draw);
    (picture, samples, depth, stats)
}

fn collect<P: PixelFormat, D: DepthChoice, R: RecordsChoice>(
    mut renderer: Renderer<'_, P, D, R>,
    color: &mut [P::Raw],
    background: P::Color,
    draw: impl FnMut(&mut Scene<'_, Strip<'_, P, D, R>>),
) -> (Vec<P::Raw>, Stats) {
    let Size { width, height } = renderer.screen();
    let mut picture = Vec::new();
    let sink = |strip: &StripPixels<'_, P>| {
        let area = strip.area();
        assert_eq!(area.top_left.x, 0);
        assert_eq!(area.top_left.y as usize * width as usize, picture.len());
        assert_eq!((area.size.width * area.size.height) as usize, strip.pixels().len());
        picture.extend_from_slice(strip.pixels());
        Ok::<(), core::convert::Infallible>(())
    };
    let stats = renderer.frame_to(sink, color, background, draw).expect("the same scene in each call");
    assert_eq!(picture.len(), (width * height) as usize);
    (picture, stats)
}

/// Draws a frame at once, and also returns its depths.
pub fn whole<P: PixelFormat>(
    (width, height): (u16, u16),
    background: P::Color,
    draw: impl FnMut(&mut Scene<'_, FrameSlice<'_, P>>),
) -> (Vec<P::Raw>, Vec<u16>, Stats) {
    let pixels = usize::from(width) * usize::from(height);
    let mut color = vec![P::pack([0xA5; 3]); pixels];
    let mut depth = vec![0x1234; pixels];
    let mut records = vec![0xDEAD_BEEF; 1 << 17];
    let mut frame =
        FrameSlice::<P>::new(&mut color, Size::new(u32::from(width), u32::from(height))).expect("a framebuffer");
    let mut renderer = FramebufferRenderer::new(Size::new(u32::from(width), u32::from(height)))
        .expect("a renderer")
        .with_depth(&mut depth)
        .expect("a renderer")
        .with_records(&mut records);
    let stats = renderer.frame(&mut frame, background, draw).expect("the same scene in each call");
    (color, depth, stats)
}

/// Where two pictures differ first, and in how many pixels.
pub fn difference<T: PartialEq + core::fmt::Debug>(a: &[T], b: &[T], width: u16) -> Option<String> {
    assert_eq!(a.len(), b.len());
    let mut places = (0..a.len()).filter(|&i| a[i] != b[i]);
    let first = places.next()?;
    let (x, y) = (first % usize::from(width), first / usize::from(width));
    let more = places.count();
    Some(format!("pixel ({x}, {y}) is {:?}, expected {:?}; {more} more differ", a[first], b[first]))
}

/// A random soup of clip-space triangles of every unpleasant kind, with colours.
pub struct Soup {
    pub positions: Vec<[Scalar; 4]>,
    pub colors: Vec<[u8; 3]>,
}

impl Soup {
    pub fn new(rng: &mut Rng, triangles: usize) -> Self {
        let soup = clip_soup(rng, triangles);
        let positions: Vec<_> = soup.iter().flatten().map(|v| v.map(Scalar::from_bits)).collect();
        let colors = positions.iter().map(|_| [(); 3].map(|()| rng.below(256) as u8)).collect();
        Self { positions, colors }
    }

    pub fn mesh(&self) -> Mesh<'_> {
        Mesh::new(zstrip::mesh::MeshData {
            colors: Some(&self.colors),
            ..zstrip::mesh::MeshData::new(Positions::Homogeneous(&self.positions))
        })
        .expect("a soup is a mesh")
    }
}

/// A 16.16 number in ±`limit`.
pub fn scalar(rng: &mut Rng, limit: f64) -> Scalar {
    Scalar::from_bits(((2.0 * rng.unit() - 1.0) * limit * 65_536.0) as i32)
}

/// A vector with components in ±`limit`.
pub fn vector(rng: &mut Rng, limit: f64) -> Vec3 {
    Vec3::new(scalar(rng, limit), scalar(rng, limit), scalar(rng, limit))
}

/// Any angle.
pub fn angle(rng: &mut Rng) -> Angle16 {
    Angle16(rng.next_u64() as u16)
}

/// A rotation about any axis, then a translation by up to `reach` an axis.
pub fn rigid(rng: &mut Rng, reach: f64) -> Affine {
    let axis = vector(rng, 1.0);
    let turn = angle(rng);
    Affine::translation(vector(rng, reach)) * Affine::rotation(axis, turn)
}

/// The matrix in f64.
pub fn matrix(m: &Projective) -> [[f64; 4]; 4] {
    m.to_rows().map(|row| row.map(|v| v as f64 / 2f64.powi(32)))
}

/// `m p`.
pub fn apply(m: &[[f64; 4]; 4], p: [f64; 4]) -> [f64; 4] {
    core::array::from_fn(|i| (0..4).map(|j| m[i][j] * p[j]).sum())
}

/// Homogeneous position of a mesh vertex, exactly as the mesh's numbers say.
pub fn position(positions: &Positions<'_>, index: usize) -> [f64; 4] {
    match positions {
        Positions::Quantized { points, scale, offset } => {
            let (s, o) = (scale.to_num::<f64>(), offset.to_bits().map(|v| f64::from(v) / 65_536.0));
            let q = points[index].map(|v| f64::from(v) / 32_768.0);
            [o[0] + s * q[0], o[1] + s * q[1], o[2] + s * q[2], 1.0]
        }
        Positions::Exact(points) => {
            let p = points[index].to_bits().map(|v| f64::from(v) / 65_536.0);
            [p[0], p[1], p[2], 1.0]
        }
        Positions::Homogeneous(points) => points[index].map(|v| v.to_num::<f64>()),
    }
}

/// Screen position in px, y down, and z / w, of clip coordinates with y up.
pub fn on_screen(viewport: &Viewport, [x, y, z, w]: [f64; 4]) -> [f64; 3] {
    let (width, height) = (f64::from(viewport.size().width), f64::from(viewport.size().height));
    [
        f64::from(viewport.top_left().x) + (x / w + 1.0) * width / 2.0,
        f64::from(viewport.top_left().y) + (1.0 - y / w) * height / 2.0,
        z / w,
    ]
}

/// Corners on the screen, with what is interpolated.
pub type SnappedTriangle<const K: usize> = [(ScreenVertex, [i32; K]); 3];

/// The triangles of a mesh as the rasterizer gets them: transformed, clipped, projected and snapped, with `varyings` of
/// their vertices, and the number each had in the mesh.
pub fn snapped<const K: usize>(
    mesh: &Mesh<'_>,
    mvp: &Projective,
    viewport: &Viewport,
    range: DepthRange,
    varyings: impl Fn(usize) -> [i32; K],
) -> Vec<(SnappedTriangle<K>, usize)> {
    let positions = &mesh.data().positions;
    let transform = Transform::new(mvp, viewport, mesh, false);
    let mut triangles = Vec::new();
    for number in 0..mesh.triangle_count() {
        let corners = mesh.triangle(number).expect("a triangle").map(usize::from);
        let vertices: [(ClipVertex, [i32; K]); 3] = corners.map(|k| (transform.vertex(positions, k), varyings(k)));
        let codes = vertices.map(|v| Outcode::of(&v.0).0);
        let clamped = match range {
            DepthRange::Clip => 0,
            DepthRange::ClampFar => Outcode::FAR,
            DepthRange::Clamp => Outcode::FAR | Outcode::NEAR,
        };
        if codes[0] & codes[1] & codes[2] & !clamped != 0 {
            continue;
        }
        let all = Outcode(codes[0] | codes[1] | codes[2]);
        let mut fan = |placed: Vec<(ScreenVertex, [i32; K])>| {
            for k in 2..placed.len() {
                triangles.push(([placed[0], placed[k - 1], placed[k]], number));
            }
        };
        let placed = |(v, varyings): &(ClipVertex, [i32; K])| Some((project(v)?, *varyings));
        if all.0 == 0 {
            fan(vertices.iter().filter_map(placed).collect());
        } else {
            for part in [zstrip::internals::DepthSlab::Inside].into_iter().chain(range.clamped_slabs(all)) {
                let mut corners = Vec::new();
                let varyings = vertices.map(|v| v.1);
                clip_triangle(vertices.map(|v| v.0), all, part, |corner| {
                    corners.extend(placed(&(corner.vertex, weighted(&corner.weights, &varyings))));
                });
                fan(corners);
            }
        }
    }
    triangles
}
