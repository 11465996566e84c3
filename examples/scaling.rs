//! Measures how the cost of a frame grows: firmware that draws a torus of 128, 512 and 2,048 triangles on two screens,
//! in strips of seven heights, with four amounts of memory for records, and counts. `ci/scaling` runs it and prints the
//! tables. Where records hold no triangles, it draws the torus once more as a mesh with a hierarchy of bounds, in eight
//! parts.
//!
//! It prints, for each frame, `width height rows triangles room bytes ticks walks hash`: bytes of strip and records,
//! SysTick's ticks over the frame without those that its sink takes for the hash of the picture, and how often the
//! scene was walked. Frames of 0 triangles cost only clearing and handing out strips. Where `room` is `size`, all
//! records fit, and screens of six sizes show the torus of 512 triangles.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod firmware;
#[cfg(target_os = "none")]
#[path = "firmware/ticks.rs"]
mod ticks;

/// Tori of radii 1 and 0.4 about the axis y, in as many quads as vertices.
#[cfg(target_os = "none")]
mod tori {
    use zstrip::math::{Angle16, Scalar, Vec3};
    use zstrip::mesh::{Bounds, BoundsNode, Mesh, MeshData, Positions, Topology};

    /// Parts of a torus, each a leaf of its hierarchy: eighths of the way around the axis.
    const PARTS: usize = 8;

    struct Torus<const VERTICES: usize> {
        points: [[i16; 3]; VERTICES],
        normals: [[i16; 3]; VERTICES],
        quads: [[u16; 4]; VERTICES],
    }

    /// The coordinate of 32,768 in the positions: 1.4 in 16.16.
    const SCALE: i64 = 91_750;

    /// Sine and cosine of step `k` of `n`, 16.16.
    const fn unit(k: usize, n: usize) -> (i64, i64) {
        let angle = Angle16((k * 65_536 / n) as u16);
        (angle.sin().to_bits() as i64, angle.cos().to_bits() as i64)
    }

    /// A 16.32 coordinate as a fraction of [`SCALE`]; only 1.4 itself is out of range, by one.
    const fn fraction(v: i64) -> i16 {
        let q = (v / 2 + SCALE / 2).div_euclid(SCALE);
        if q > i16::MAX as i64 { i16::MAX } else { q as i16 }
    }

    impl<const VERTICES: usize> Torus<VERTICES> {
        /// As many steps around the axis as across the ring.
        const fn new() -> Self {
            let steps = VERTICES.isqrt();
            let mut torus = Self { points: [[0; 3]; VERTICES], normals: [[0; 3]; VERTICES], quads: [[0; 4]; VERTICES] };
            let mut k = 0;
            while k < VERTICES {
                let (i, j) = (k / steps, k % steps);
                let ((su, cu), (sv, cv)) = (unit(i, steps), unit(j, steps));
                // Distance from the axis in 16.32; 26,214 is 0.4.
                let ring = (1 << 32) + 26_214 * cv;
                torus.points[k] = [fraction(ring / 65_536 * cu), fraction(26_214 * sv), fraction(ring / 65_536 * su)];
                torus.normals[k] = [((cv * cu) >> 18) as i16, (sv >> 2) as i16, ((cv * su) >> 18) as i16];
                let (right, up) = ((i + 1) % steps * steps, (j + 1) % steps);
                torus.quads[k] = [k as u16, (i * steps + up) as u16, (right + up) as u16, (right + j) as u16];
                k += 1;
            }
            torus
        }

        const fn mesh(&'static self, hierarchy: Option<&'static [BoundsNode]>) -> Mesh<'static> {
            Mesh::constant(MeshData {
                topology: Topology::Quads,
                indices: Some(self.quads.as_flattened()),
                normals: Some(&self.normals),
                hierarchy,
                ..MeshData::new(positions(&self.points))
            })
        }

        const fn parts(&self) -> [BoundsNode; PARTS] {
            let bounds = self.bounds(0);
            let mut nodes = [BoundsNode { bounds, skip: 0, first_triangle: 0, triangles: 0 }; PARTS];
            let triangles = 2 * VERTICES / PARTS;
            let mut k = 0;
            while k < PARTS {
                let first_triangle = (k * triangles) as u16;
                let bounds = self.bounds(k);
                nodes[k] = BoundsNode { bounds, skip: k as u16 + 1, first_triangle, triangles: triangles as u16 };
                k += 1;
            }
            nodes
        }

        /// Returns the bounds of a part: of its vertices, and those where the next part begins.
        const fn bounds(&self, part: usize) -> Bounds {
            let mut points = [[0; 3]; VERTICES];
            let (first, mut k) = (part * VERTICES / PARTS, 0);
            let length = VERTICES / PARTS + VERTICES.isqrt();
            while k < length {
                points[k] = self.points[(first + k) % VERTICES];
                k += 1;
            }
            let (points, _) = points.split_at(length);
            *Mesh::constant(MeshData { topology: Topology::Strip, ..MeshData::new(positions(points)) }).bounds()
        }
    }

    const fn positions(points: &[[i16; 3]]) -> Positions<'_> {
        Positions::Quantized { points, scale: Scalar::from_bits(SCALE as i32), offset: Vec3::ZERO }
    }

    static SMALL: Torus<64> = Torus::new();
    static MIDDLE: Torus<256> = Torus::new();
    static LARGE: Torus<1024> = Torus::new();

    /// Of 128, 512 and 2,048 triangles: plain, and with a hierarchy.
    pub static TORI: [[Mesh<'static>; 2]; 3] = [
        [SMALL.mesh(None), SMALL.mesh(Some(&const { SMALL.parts() }))],
        [MIDDLE.mesh(None), MIDDLE.mesh(Some(&const { MIDDLE.parts() }))],
        [LARGE.mesh(None), LARGE.mesh(Some(&const { LARGE.parts() }))],
    ];
}

#[cfg(target_os = "none")]
mod counting {
    use super::ticks;
    use super::tori::TORI;
    use core::convert::Infallible;
    use cortex_m::peripheral::Peripherals;
    use semihosting::println;
    use zstrip::Renderer;
    use zstrip::embedded_graphics_core::geometry::Size;
    use zstrip::embedded_graphics_core::pixelcolor::{Rgb565, Rgb888, RgbColor};
    use zstrip::frame::RamBudget;
    use zstrip::light::{Material, Sun};
    use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
    use zstrip::mesh::Mesh;
    use zstrip::shader::Gouraud;
    use zstrip::target::{Stats, StripPixels, records_len};

    const PIXELS: usize = 480 * 360;

    /// Those of the largest torus, should all of its triangles be visible.
    const WORDS: usize = records_len(64, 1, 1024, VARYING_WORDS, 2048);

    /// Of Gouraud shading.
    const VARYING_WORDS: usize = 1;

    struct Memory {
        color: [u16; PIXELS],
        depth: [u16; PIXELS],
        records: [u32; WORDS],
    }

    static mut MEMORY: Memory = Memory { color: [0; _], depth: [0; _], records: [0; _] };

    /// Width, height, and the heights of strips.
    const SCREENS: [(u16, u16, [u16; 7]); 2] =
        [(160, 128, [128, 64, 32, 16, 8, 4, 2]), (320, 240, [240, 120, 60, 30, 16, 8, 4])];

    /// Screens of the torus of 512 triangles, all in the shape of 4 to 3.
    const SIZES: [(u16, u16); 6] = [(96, 72), (128, 96), (160, 120), (240, 180), (320, 240), (480, 360)];

    /// The amounts of memory for records.
    #[derive(Clone, Copy)]
    enum Room {
        /// None: vertices are shaded for each triangle, in each strip.
        None,
        /// For the vertices: they are shaded once a strip.
        Vertices,
        /// For the vertices and a third of the visible triangles: records overflow, and the screen is drawn in bands.
        Third,
        /// For the vertices and all visible triangles.
        All,
    }

    const ROOMS: [(&str, Room); 4] =
        [("none", Room::None), ("vertices", Room::Vertices), ("third", Room::Third), ("all", Room::All)];

    impl Room {
        fn words(self, strips: usize, mesh: &Mesh<'_>, visible: usize) -> usize {
            let vertices = mesh.vertex_count();
            match self {
                Self::None => 0,
                Self::Vertices => records_len(0, 0, vertices, VARYING_WORDS, 0),
                Self::Third => records_len(strips, 1, vertices, VARYING_WORDS, visible / 3),
                Self::All => records_len(strips, 1, vertices, VARYING_WORDS, visible),
            }
        }
    }

    /// The mesh and the size of a frame.
    struct Shot<'a> {
        screen: (u16, u16),
        camera: &'a Projective,
        mesh: Option<&'a Mesh<'a>>,
    }

    /// A frame's ticks without those of the sink, the hash of its picture, and its counters.
    struct Cost {
        ticks: u32,
        hash: u32,
        stats: Stats,
    }

    impl Shot<'_> {
        #[inline(never)]
        fn count(&self, memory: &mut Memory, rows: u16, words: usize) -> Cost {
            let (mut ticks, mut hash) = (0_u32, 0x811C_9DC5_u32);
            let pixels = usize::from(self.screen.0) * usize::from(rows);
            let renderer = Renderer::<Rgb565>::new(Size::new(self.screen.0.into(), self.screen.1.into()))
                .expect("the buffers hold a row")
                .with_depth(&mut memory.depth[..pixels])
                .expect("the buffers hold a row");
            let mut renderer = renderer.with_records(&mut memory.records[..words]);
            // FNV-1a over pixels.
            let sink = |strip: &StripPixels<'_, Rgb565>| {
                let start = ticks::now();
                for &pixel in strip.pixels() {
                    hash = (hash ^ u32::from(pixel)).wrapping_mul(0x0100_0193);
                }
                ticks = ticks.wrapping_sub(ticks::now().wrapping_sub(start));
                Ok::<(), Infallible>(())
            };
            let model = Affine::translation(Vec3::from_ints(0, 0, -3))
                * Affine::rotation_y(Angle16::from_degrees(29))
                * Affine::rotation_x(Angle16::from_degrees(40));
            let sun = Sun::from_channels(Vec3::from_ints(2, 4, 3), [215; 3], [40; 3]);
            let (mvp, shader) =
                (*self.camera * model, Gouraud::new(sun.on(&Material::matte(Rgb888::new(255, 160, 64)), &model)));
            let start = ticks::now();
            let stats = renderer.frame_to(sink, &mut memory.color[..pixels], Rgb565::BLACK, |scene| {
                if let Some(mesh) = self.mesh {
                    scene.draw(mesh, &mvp, &shader);
                }
            });
            let end = ticks::now();
            let stats = stats.expect("the closure draws the same each time");
            Cost { ticks: ticks.wrapping_add(end.wrapping_sub(start)), hash, stats }
        }

        fn report(&self, memory: &mut Memory, rows: u16, room: &str, words: usize) {
            let Cost { ticks, hash, stats } = self.count(memory, rows, words);
            let ((width, height), triangles) = (self.screen, self.mesh.map_or(0, Mesh::triangle_count));
            let bytes = RamBudget::new::<Rgb565>(width.into(), rows.into()).with_record_words(words).total();
            let walks = stats.walks;
            println!("{width} {height} {rows} {triangles} {room} {bytes} {ticks} {walks} {hash:08x}");
        }
    }

    fn camera((width, height): (u16, u16)) -> Projective {
        let (screen, far) = (Size::new(width.into(), height.into()), Scalar::from_bits(16 << 16));
        Projective::perspective(Angle16::from_degrees(60), screen, Scalar::ONE, far).expect("near is before far")
    }

    pub fn run() {
        let memory = &raw mut MEMORY;
        // SAFETY: `run` is called once; this is the only reference.
        let memory = unsafe { &mut *memory };
        let mut peripherals = Peripherals::take().expect("nobody has taken them");
        ticks::start(&mut peripherals.SYST);
        for (width, height, heights) in SCREENS {
            let screen = (width, height);
            let camera = &camera(screen);
            for rows in heights {
                Shot { screen, camera, mesh: None }.report(memory, rows, "none", 0);
            }
            for [mesh, parts] in &TORI {
                let shot = Shot { screen, camera, mesh: Some(mesh) };
                let in_parts = Shot { mesh: Some(parts), ..shot };
                let visible = shot.count(memory, height, 0).stats.drawn as usize;
                for rows in heights {
                    let strips = usize::from(height.div_ceil(rows));
                    in_parts.report(memory, rows, "parts", 0);
                    in_parts.report(memory, rows, "vertices-parts", Room::Vertices.words(strips, parts, visible));
                    for (name, room) in ROOMS {
                        shot.report(memory, rows, name, room.words(strips, mesh, visible));
                    }
                }
            }
        }
        let [_, [mesh, _], _] = &TORI;
        for screen in SIZES {
            let camera = &camera(screen);
            let shot = Shot { screen, camera, mesh: Some(mesh) };
            let visible = shot.count(memory, screen.1, 0).stats.drawn as usize;
            for rows in [screen.1, 16] {
                let words = Room::All.words(usize::from(screen.1.div_ceil(rows)), mesh, visible);
                shot.report(memory, rows, "size", words);
                Shot { mesh: None, ..shot }.report(memory, rows, "size", 0);
            }
        }
    }
}

#[cfg(target_os = "none")]
use counting::run;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this example is firmware: ci/scaling builds it");
}
