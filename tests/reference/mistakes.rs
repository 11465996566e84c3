//! Rasterizers that are wrong on purpose: each conformance check must find the mistakes that concern it.

use super::conformance::{ClipTriangle, PerspectiveTriangle, Rasterizer, ScreenTriangle};
use super::exact;
use super::homogeneous::{Vertex, Viewport, for_each_sample};
use super::model::Model;

/// A mistake to make on purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mistake {
    /// Every pixel one column further right.
    ShiftedByOne,
    /// Samples on any edge count.
    AllEdgesOwn,
    /// Right and bottom edges own their samples instead of left and top ones.
    BottomRight,
    /// The first pixel of every triangle is drawn twice.
    TwiceOnce,
    /// One pixel is left out.
    FirstMissing,
    /// Clockwise triangles are culled.
    Culled,
    /// Vertices lose their lowest bits: 4 sub-pixel bits.
    CoarseGrid,
    /// 32-bit products.
    Overflowing,
    /// The farthest fragment wins.
    Greater,
    /// Depth 2 too far.
    DepthOff,
    /// Depth test left out.
    NoDepthTest,
    /// The near plane is ignored; w > 0 is still required.
    NoNearPlane,
    /// Triangles with a vertex behind the near plane are dropped.
    DropsCrossing,
    /// One triangle of a pair is drawn half a pixel to the right.
    SecondShifted,
    /// Lines begin where they end.
    Backward,
    /// Reports a pixel beyond the right border.
    LeavesViewport,
    /// Texture coordinates are linear on the screen.
    NoPerspective,
    /// Texture coordinates are too large by 1/8.
    CoordinatesOff,
    /// All samples are at the pixel's centre.
    CentredSamples,
    /// Draws nothing.
    Nothing,
}

impl Mistake {
    pub const ALL: [Mistake; 20] = [
        Mistake::ShiftedByOne,
        Mistake::AllEdgesOwn,
        Mistake::BottomRight,
        Mistake::TwiceOnce,
        Mistake::FirstMissing,
        Mistake::Culled,
        Mistake::CoarseGrid,
        Mistake::Overflowing,
        Mistake::Greater,
        Mistake::DepthOff,
        Mistake::NoDepthTest,
        Mistake::NoNearPlane,
        Mistake::DropsCrossing,
        Mistake::SecondShifted,
        Mistake::Backward,
        Mistake::LeavesViewport,
        Mistake::NoPerspective,
        Mistake::CoordinatesOff,
        Mistake::CentredSamples,
        Mistake::Nothing,
    ];

    /// Coverage with the mistake in it.
    fn pixels(self, width: u32, height: u32, v: ScreenTriangle) -> Vec<(u32, u32)> {
        let mut pixels = Vec::new();
        let tri = exact::widen(v);
        let area = exact::area2(tri);
        let mirror = |p: [i32; 2], size: u32| 256 * size as i32 - p[0];
        match self {
            Mistake::Nothing => {}
            Mistake::Culled if area > 0 => {}
            Mistake::CoarseGrid => {
                let coarse = exact::widen(v.map(|p| p.map(|c| c & !15)));
                exact::for_each_pixel(coarse, width, height, |x, y| pixels.push((x, y)));
            }
            Mistake::AllEdgesOwn | Mistake::Overflowing => {
                for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
                    let (weights, _) = match area {
                        0 => continue,
                        _ => exact::barycentric_at(tri, exact::center(x.into(), y.into())),
                    };
                    let inside = match self {
                        Mistake::AllEdgesOwn => weights.iter().all(|&w| w >= 0),
                        _ => exact::covers(tri, x.into(), y.into()) && weights.iter().all(|&w| w as i32 >= 0),
                    };
                    if inside {
                        pixels.push((x, y));
                    }
                }
            }
            Mistake::BottomRight => {
                // Seen in a mirror, right is left; and from below, bottom is top.
                let turned = v.map(|p| [mirror(p, width), 256 * height as i32 - p[1]]);
                exact::for_each_pixel(exact::widen(turned), width, height, |x, y| {
                    pixels.push((width - 1 - x, height - 1 - y));
                });
            }
            _ => exact::for_each_pixel(tri, width, height, |x, y| pixels.push((x, y))),
        }
        self.spoil(&mut pixels, width);
        pixels
    }

    /// The mistakes that any list of pixels can have.
    fn spoil(self, pixels: &mut Vec<(u32, u32)>, width: u32) {
        match self {
            Mistake::ShiftedByOne => {
                for pixel in pixels.iter_mut() {
                    pixel.0 += 1;
                }
                pixels.retain(|p| p.0 < width);
            }
            Mistake::TwiceOnce => pixels.extend(pixels.first().copied()),
            Mistake::FirstMissing => {
                pixels.drain(..pixels.len().min(1));
            }
            Mistake::LeavesViewport if !pixels.is_empty() => pixels.push((width, 0)),
            _ => {}
        }
    }
}

impl Rasterizer for Mistake {
    fn triangle(&mut self, width: u32, height: u32, v: ScreenTriangle, hit: &mut dyn FnMut(u32, u32)) {
        for (x, y) in self.pixels(width, height, v) {
            hit(x, y);
        }
    }

    fn samples(&mut self, width: u32, height: u32, v: ScreenTriangle, hit: &mut dyn FnMut(usize, u32, u32)) {
        for (sample, place) in exact::STANDARD_SAMPLES.into_iter().enumerate() {
            let place = if *self == Mistake::CentredSamples { [128; 2] } else { place };
            let moved = v.map(|[x, y]| [x + 128 - place[0] as i32, y + 128 - place[1] as i32]);
            for (x, y) in self.pixels(width, height, moved) {
                hit(sample, x, y);
            }
        }
    }

    fn depth_scene(&mut self, width: u32, height: u32, tris: &[(ScreenTriangle, [u16; 3])]) -> (Vec<u32>, Vec<u16>) {
        let count = width as usize * height as usize;
        let (mut winners, mut depths) = (vec![0; count], vec![u16::MAX; count]);
        for (&(v, z), id) in tris.iter().zip(1..) {
            for (x, y) in self.pixels(width, height, v) {
                let exact = exact::depth_rounded(exact::widen(v), z.map(i64::from), x.into(), y.into());
                let off = if *self == Mistake::DepthOff { 2 } else { 0 };
                let depth = (exact + off).clamp(0, 65535) as u16;
                let Some(index) = (x < width).then_some((y * width + x) as usize) else {
                    continue;
                };
                let passes = match self {
                    Mistake::NoDepthTest => true,
                    Mistake::Greater => depths[index] == u16::MAX || depth > depths[index],
                    _ => depth < depths[index],
                };
                if passes {
                    (winners[index], depths[index]) = (id, depth);
                }
            }
        }
        (winners, depths)
    }

    fn perspective(&mut self, width: u32, height: u32, triangle: &PerspectiveTriangle) -> Vec<Option<[f64; 2]>> {
        let w = if *self == Mistake::NoPerspective { [1; 3] } else { triangle.w };
        let exact = Model.perspective(width, height, &PerspectiveTriangle { w, ..*triangle });
        let off = if *self == Mistake::CoordinatesOff { 0.125 } else { 0.0 };
        let mut values = vec![None; exact.len()];
        for (x, y) in self.pixels(width, height, triangle.v) {
            let index = (y * width + x) as usize;
            if let Some(value) = values.get_mut(index) {
                *value = exact[index].map(|uv: [f64; 2]| uv.map(|c| c + off));
            }
        }
        values
    }

    fn clip_triangles(&mut self, width: u32, height: u32, tris: &[ClipTriangle], hit: &mut dyn FnMut(usize, u32, u32)) {
        let viewport = Viewport { clip_y_down: true, ..Viewport::new(width, height) };
        for (index, tri) in tris.iter().enumerate() {
            let mut pixels = Vec::new();
            let mut viewport = viewport;
            let crossing = tri.iter().any(|v| v[2] < 0 || v[3] <= 0);
            match self {
                Mistake::Nothing => continue,
                Mistake::DropsCrossing if crossing => continue,
                Mistake::SecondShifted if index == 1 => viewport.x += 0.5,
                _ => {}
            }
            let vertices = tri.map(|v| {
                let mut position = v.map(f64::from);
                if *self == Mistake::NoNearPlane {
                    position[2] = position[3] / 2.0;
                }
                Vertex { position, attributes: [] }
            });
            for_each_sample(&viewport, (width, height), &vertices, |sample| {
                if sample.covered && (sample.front || *self != Mistake::Culled) {
                    pixels.push((sample.x, sample.y));
                }
            });
            self.spoil(&mut pixels, width);
            for (x, y) in pixels {
                hit(index, x, y);
            }
        }
    }

    fn line(&mut self, width: u32, height: u32, [a, b]: [[i32; 2]; 2], hit: &mut dyn FnMut(u32, u32)) {
        let coarse = |p: [i32; 2]| if *self == Mistake::CoarseGrid { p.map(|c| c & !15) } else { p };
        let ends = if *self == Mistake::Backward { [b, a] } else { [coarse(a), coarse(b)] };
        let mut pixels = Vec::new();
        if *self != Mistake::Nothing {
            Model.line(width, height, ends, &mut |x, y| pixels.push((x, y)));
        }
        self.spoil(&mut pixels, width);
        for (x, y) in pixels {
            hit(x, y);
        }
    }

    fn point(&mut self, width: u32, height: u32, center: [i32; 2], side: u32, hit: &mut dyn FnMut(u32, u32)) {
        // A unit to the right and down: left and top sides lose their points, and right and bottom ones gain them.
        let center = if *self == Mistake::BottomRight { center.map(|c| c + 1) } else { center };
        let mut pixels = Vec::new();
        if *self != Mistake::Nothing {
            Model.point(width, height, center, side, &mut |x, y| pixels.push((x, y)));
        }
        self.spoil(&mut pixels, width);
        for (x, y) in pixels {
            hit(x, y);
        }
    }
}
