//! Triangles in clip space against 2-D homogeneous rasterization, which does not clip: in every depth range, for one
//! triangle, and for two that share an edge.

use crate::Hash;
use crate::reference::homogeneous::{Vertex, Viewport, for_each_sample};
use crate::source::Source;
use core::cell::Cell;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::Gray8;
use zstrip::frame::FramebufferRenderer;
use zstrip::math::{Projective, Scalar};
use zstrip::mesh::{Mesh, MeshData, Positions};
use zstrip::span::{DepthState, DepthTest, Fragment, Shader, SpanOf};
use zstrip::target::{Depthless, FrameSlice};
use zstrip::vertex::{DepthRange, VertexRef, VertexShader};
use zstrip::{Cull, State};

const SIDE: usize = 6;

/// Distance from an edge, in px, up to which either decision is right: corners are rounded to 1/256 px, and those of a
/// cut triangle once more.
const MARGIN: f64 = 1.0 / 50.0;
/// Triangles of the fan that is left of a triangle between the near and the far plane.
const FAN: u8 = 3;
/// 1 / w from which on a pixel may be missing: there, w is below one half of the last bit of a coordinate. The transform
/// cuts where it is 1/8 of that bit.
const LARGEST_INVERSE_W: f64 = 2.0 * 65_536.0;

/// Counts how often each pixel is drawn.
struct Count<'c>(&'c [Cell<u8>; SIDE * SIDE]);

impl VertexShader for Count<'_> {
    type Varyings = [i32; 0];

    fn vertex(&self, _: &VertexRef<'_>) -> [i32; 0] {
        []
    }
}

impl Shader<Gray8> for Count<'_> {
    type Setup = ();

    fn fragment(&self, _: &Fragment<'_, [i32; 0]>) -> Option<u8> {
        None
    }

    fn span<D: DepthTest>(&self, span: SpanOf<'_, Gray8, Self, D>, _: D) {
        let (x, y) = span.position;
        for k in 0..span.color.len() {
            let count = &self.0[y as usize * SIDE + x as usize + k];
            count.set(count.get() + 1);
        }
    }
}

pub fn run(input: &[u8]) -> u64 {
    let mut source = Source::new(input);
    let options = source.u8();
    let range = [DepthRange::Clip, DepthRange::Clip, DepthRange::ClampFar, DepthRange::Clamp][usize::from(options & 3)];
    let pair = options & 4 != 0;
    let cull = [Cull::None, Cull::None, Cull::Back, Cull::Front][usize::from(options >> 3 & 3)];
    // Direct, recorded, and recorded with too little room.
    let words = [0, 200, 30, 60][usize::from(options >> 5 & 3)];
    let mut v = [[0; 4]; 3];
    for k in 0..3 {
        let (before, rest) = v.split_at_mut(k);
        rest[0] = source.clip_vertex(before);
    }
    let [a, b, c] = v;
    let mut vertices = [a, b, c, b, a, c];
    let mut count = 3;
    if pair {
        // The fourth corner of a parallelogram, whose triangles share the edge from a to b.
        let halved = [a, b, c].map(|v| v.map(|c| c / 4));
        let [a, b, c] = halved;
        vertices = [a, b, c, b, a, core::array::from_fn(|k| a[k] + b[k] - c[k])];
        count = 6;
    }
    check(&vertices[..count], range, cull, words)
}

fn check(vertices: &[[i32; 4]], range: DepthRange, cull: Cull, words: usize) -> u64 {
    let mut positions = [[Scalar::ZERO; 4]; 6];
    for (to, from) in positions.iter_mut().zip(vertices) {
        *to = from.map(Scalar::from_bits);
    }
    let mesh = Mesh::new(MeshData::new(Positions::Homogeneous(&positions[..vertices.len()]))).expect("triangles");
    let counts = [const { Cell::new(0) }; SIDE * SIDE];
    let (mut pixels, mut records) = ([0; SIDE * SIDE], [7; 200]);
    let screen = Size::new(SIDE as u32, SIDE as u32);
    let mut frame = Depthless(FrameSlice::<Gray8>::new(&mut pixels, screen).expect("a framebuffer"));
    let state = State { cull, depth: DepthState::OFF, range, ..State::DEFAULT };
    FramebufferRenderer::new(screen)
        .expect("a renderer")
        .with_records(&mut records[..words])
        .frame_over(&mut frame, |scene| scene.draw_with(state, &mesh, &Projective::IDENTITY, &Count(&counts)))
        .expect("the same scene");

    let mut hash = Hash::default();
    counts.iter().for_each(|count| hash.add(count.get().into()));
    if !is_precise(vertices) {
        return hash.0;
    }
    let mut sure = [0_u8; SIDE * SIDE];
    let mut maybe = [0_u8; SIDE * SIDE];
    // Set where a triangle is narrower than corners are rounded: its polygon may fold there, so that triangles of its
    // fan overlap, and may lie on the other side of the edge where the two triangles meet.
    let mut is_narrow = [false; SIDE * SIDE];
    let viewport = Viewport::new(SIDE as u32, SIDE as u32);
    for triangle in vertices.chunks_exact(3) {
        let corner = |k: usize| {
            let [x, y, z, w] = triangle[k].map(|c| f64::from(c) / 65_536.0);
            // A z that no plane cuts where none should: far is a long way off, or near and far are both. z / w is
            // below 2³², as z is below 2¹⁵ and 1 / w below `LARGEST_INVERSE_W`.
            let z = match range {
                DepthRange::Clip => z,
                DepthRange::ClampFar => z / (1_u64 << 40) as f64,
                DepthRange::Clamp => w / 2.0,
            };
            Vertex { position: [x, y, z, w], attributes: [] }
        };
        if is_edge_on(triangle) {
            // Rounded corners may make slivers of its parts before, between and beyond the planes.
            maybe.iter_mut().for_each(|maybe| *maybe += FAN);
            is_narrow = [true; SIDE * SIDE];
            continue;
        }
        let triangle = [corner(0), corner(1), corner(2)];
        for_each_sample(&viewport, (SIDE as u32, SIDE as u32), &triangle, |sample| {
            let at = sample.y as usize * SIDE + sample.x as usize;
            let drawn = match cull {
                Cull::None => true,
                Cull::Back => sample.front,
                Cull::Front => !sample.front,
            };
            if sample.margin < MARGIN || sample.inv_w > LARGEST_INVERSE_W {
                let slabs = if range == DepthRange::Clip { 1 } else { 3 };
                let narrow = sample.second_margin < MARGIN;
                maybe[at] += if narrow { FAN * slabs } else { slabs };
                is_narrow[at] |= narrow;
            } else if sample.covered && drawn {
                sure[at] += 1;
            }
        });
    }
    for (at, count) in counts.iter().enumerate() {
        let count = count.get();
        // Where the two triangles meet, one of them draws, and not both.
        let most = if vertices.len() > 3 && range == DepthRange::Clip && !is_narrow[at] {
            (sure[at] + maybe[at]).min(1)
        } else {
            sure[at] + maybe[at]
        };
        assert!(
            (sure[at].min(1)..=most).contains(&count),
            "pixel ({}, {}) is drawn {count} times, at least {}, at most {most}: {vertices:?} {range:?} {cull:?}",
            at % SIDE,
            at / SIDE,
            sure[at],
        );
    }
    hash.0
}

/// Whether a triangle in clip space is seen as a line or a point.
fn is_edge_on(triangle: &[[i32; 4]]) -> bool {
    let [a, b, c] = [0, 1, 2].map(|k| [0, 1, 3].map(|axis| i128::from(triangle[k][axis])));
    let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
    a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1) == 0
}

/// Whether each w is at least 1/1024 of the largest coordinate, or 0: the range for which a precision is stated. The
/// transform has to expect any coordinates of 32 bits, so that it cuts where w is 1/8 of their last bit; corners whose
/// coordinates are a few of these bits would show it.
fn is_precise(vertices: &[[i32; 4]]) -> bool {
    let most = |values: &[i32]| values.iter().fold(0, |most, c| c.unsigned_abs().max(most));
    let least = (most(vertices.as_flattened()) >> 10).max(1 << 10);
    vertices.iter().all(|v| (v[3] == 0 || v[3].unsigned_abs() >= least) && most(v) >= 1 << 10)
}
