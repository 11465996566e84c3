//! A scatter plot in space: three clouds of points in a box of grids, with axes, and the points' shadows on the floor.
//!
//! ```text
//! cargo run --release --example scatter -- --help
//! ```
mod host;
mod scenes;

use host::program::{Demo, Drawing, Shot, show};
use scenes::Draw;
use std::process::ExitCode;
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888};
use zstrip::math::{Affine, Angle16, Pixels, Projective, Scalar, Vec3};
use zstrip::mesh::{LineTopology, Lines, Points, Positions, Vertices};
use zstrip::shader::{Flat, Gouraud};
use zstrip::span::{Compare, DepthState};
use zstrip::target::WithDepth;
use zstrip::{Framebuffer, Scene, Smooth, State, Thick, Thin};

/// Points of a cloud.
const CLOUD: usize = 160;
const CLOUDS: [([i32; 3], [i32; 3], [u8; 3]); 3] = [
    ([-400, -200, 300], [260, 200, 220], [255, 120, 90]),
    ([350, 300, -250], [200, 260, 240], [90, 200, 255]),
    ([200, -450, 400], [320, 120, 160], [250, 220, 90]),
];
/// Lines of a grid in each direction.
const GRID: i32 = 8;

/// The points, their shadows on the floor, and their colours.
struct Scatter {
    points: Vec<Vec3>,
    shadows: Vec<Vec3>,
    colors: Vec<[u8; 3]>,
}

/// Returns a number of about a normal distribution with a deviation of 1000: the sum of four random numbers.
fn bell(state: &mut u32) -> i32 {
    (0..4).fold(0, |sum, _| {
        *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        sum + (*state >> 16) as i32 % 1732 - 866
    })
}

impl Scatter {
    fn new() -> Self {
        let mut state = 7;
        let (mut points, mut colors) = (Vec::new(), Vec::new());
        for (center, spread, color) in CLOUDS {
            for _ in 0..CLOUD {
                let place = [0, 1, 2].map(|k| (center[k] + bell(&mut state) * spread[k] / 1000).clamp(-970, 970));
                points.push(Vec3::from_milli(place[0], place[1], place[2]));
                colors.push(color);
            }
        }
        let shadows = points.iter().map(|p| Vec3::new(p.x, -Scalar::ONE, p.z)).collect();
        Self { points, shadows, colors }
    }
}

/// The plot of one frame.
struct Plot<'s> {
    data: &'s Scatter,
    mvp: Projective,
    /// The planes at the back, as seen in this frame.
    grid: Vec<Vec3>,
    axes: Vec<Vec3>,
    /// A line from each point to its shadow, where the mode shows them, and the colours of its ends.
    stems: Vec<Vec3>,
    stem_colors: Vec<[u8; 3]>,
    size: i32,
}

impl Demo for Scatter {
    type Format = Rgb565;
    const NAME: &'static str = "scatter";
    const ABOUT: &'static str = "A scatter plot in space.";
    const MODES: &'static [&'static str] = &["squares", "stems", "large"];
    const BACKGROUND: Rgb565 = Rgb565::new(2, 5, 4);

    fn frame(&mut self, shot: &Shot) -> Drawing<'_, Rgb565, WithDepth> {
        let turn = Angle16(shot.number.wrapping_mul(64) as u16) + Angle16::from_degrees(32);
        let camera = Projective::perspective(Angle16::from_degrees(40), shot.screen, Scalar::ONE, Scalar::from_num(10));
        let view = Affine::translation(Vec3::from_milli(0, 130, -5000))
            * Affine::rotation_x(Angle16::from_degrees(24))
            * Affine::rotation_y(turn);
        // The eye is at +z before the turn: the walls at the back are those on its other side.
        let away = |c: Scalar| if c > Scalar::ZERO { -1000 } else { 1000 };
        let (x, z) = (away(-turn.sin()), away(turn.cos()));
        let (mut grid, mut axes) = (Vec::new(), Vec::new());
        for k in 0..=GRID {
            let c = 2000 * k / GRID - 1000;
            let at = Vec3::from_milli;
            // The floor, the wall of constant x, the wall of constant z.
            grid.extend([at(c, -1000, -1000), at(c, -1000, 1000), at(-1000, -1000, c), at(1000, -1000, c)]);
            grid.extend([at(x, c, -1000), at(x, c, 1000), at(x, -1000, c), at(x, 1000, c)]);
            grid.extend([at(-1000, c, z), at(1000, c, z), at(c, -1000, z), at(c, 1000, z)]);
            // Ticks, where labels may stand.
            axes.extend([at(c, -1000, -z), at(c, -1000, -z - z / 20), at(-x, -1000, c), at(-x - x / 20, -1000, c)]);
            axes.extend([at(-x, c, z), at(-x - x / 20, c, z)]);
        }
        let at = Vec3::from_milli;
        axes.extend([at(-1000, -1000, -z), at(1000, -1000, -z), at(-x, -1000, -1000), at(-x, -1000, 1000)]);
        axes.extend([at(-x, -1000, z), at(-x, 1000, z)]);
        let ends = self.points.iter().zip(&self.shadows).zip(&self.colors).filter(|_| shot.mode == 1);
        let (stems, stem_colors) =
            ends.flat_map(|((point, shadow), color)| [(*point, *color), (*shadow, color.map(|c| c / 4))]).unzip();
        Box::new(Plot {
            data: self,
            mvp: camera.unwrap_or(Projective::IDENTITY) * view,
            grid,
            axes,
            stems,
            stem_colors,
            size: if shot.mode == 2 { 1800 } else { 900 },
        })
    }
}

impl<F: Framebuffer> Draw<F> for Plot<'_> {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        let Self { data, mvp, .. } = self;
        let pairs = |ends| Lines::new(Vertices::new(Positions::Exact(ends)), LineTopology::Pairs, None);
        let (Ok(grid), Ok(axes)) = (pairs(&self.grid), pairs(&self.axes)) else { return };
        let behind = State { depth: DepthState { compare: Compare::Always, write: false }, ..State::DEFAULT };
        let (dim, bright) = (Flat::unlit(Rgb888::new(52, 64, 76)), Flat::unlit(Rgb888::new(190, 200, 210)));
        scene.draw_lines_with(behind, &grid, mvp, &dim, &Smooth::new(Pixels::from_bits(230)));
        scene.draw_lines_with(behind, &axes, mvp, &bright, &Smooth::new(Pixels::from_bits(340)));
        let colors = Some(&data.colors[..]);
        let points = |at| Points::new(Vertices { colors, ..Vertices::new(Positions::Exact(at)) });
        let (Ok(points), Ok(shadows)) = (points(&data.points), points(&data.shadows)) else { return };
        scene.draw_points(&shadows, mvp, &Flat::unlit(Rgb888::new(40, 40, 48)), Pixels::from_bits(600));
        let ends = Vertices { colors: Some(&self.stem_colors), ..Vertices::new(Positions::Exact(&self.stems)) };
        if let Ok(stems) = Lines::new(ends, LineTopology::Pairs, None) {
            scene.draw_lines(&stems, mvp, &Gouraud::vertex_colors(), &Thin);
        }
        // A rim first: the square itself is at its depth.
        let rim = Flat::unlit(Rgb888::new(8, 10, 12));
        scene.draw_points(&points, mvp, &rim, Pixels::from_bits(self.size + 400));
        let inside = State { depth: DepthState { compare: Compare::LessEqual, write: true }, ..State::DEFAULT };
        scene.draw_points_with(inside, &points, mvp, &Flat::vertex_colors(), Pixels::from_bits(self.size));
        // The plot's frame, over all.
        let Size { width, height } = scene.screen();
        let mut canvas = scene.canvas();
        let corner = |x: u32, y: u32| zstrip::ScreenPoint::corner(x as i16, y as i16);
        let frame = [corner(1, 1), corner(width - 1, 1), corner(width - 1, height - 1), corner(1, height - 1)];
        canvas.outline(&frame, Rgb888::new(70, 84, 96), &Thick::px(2));
    }
}

fn main() -> ExitCode {
    show(Scatter::new())
}
