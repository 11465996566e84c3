//! Textures in perspective: wooden crates on a tiled floor, behind a fence of holes.

use super::kept::{Kept, kept_list};
use super::{Draw, LIGHT, camera, draw_apart};
use zstrip::embedded_graphics_core::geometry::Size;
use zstrip::light::{Matte, NORMAL_ONE, Sunlit};
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};
use zstrip::mesh::{Mesh, MeshData, Positions, Topology};
use zstrip::shader::{LitTexture, Mipmapped, Textured};
use zstrip::texture::{Filter, Image, MaskTexel, Repeat, Rgb565Texel, Tile};
use zstrip::{Cull, Framebuffer, Scene, State};

/// Sides of the crate's texture.
const WOOD: usize = 32;

const fn rgb565(r: usize, g: usize, b: usize) -> u16 {
    ((r >> 3) << 11 | (g >> 2) << 5 | b >> 3) as u16
}

/// Returns a number that looks random.
const fn noise(x: usize, y: usize) -> usize {
    let n = (x as u32).wrapping_mul(1_103_515_245).wrapping_add((y as u32).wrapping_mul(12_345_677));
    ((n ^ n >> 13).wrapping_mul(1_274_126_177) >> 24) as usize
}

/// Planks in a frame, with nails.
static WOOD_TEXELS: [[u16; WOOD]; WOOD] = {
    let mut texels = [[0; WOOD]; WOOD];
    let mut k = 0;
    while k < WOOD * WOOD {
        let (x, y) = (k % WOOD, k / WOOD);
        let (across, down) = (if x < WOOD / 2 { x } else { WOOD - 1 - x }, if y < WOOD / 2 { y } else { WOOD - 1 - y });
        let frame = across < 4 || down < 4;
        // Along the grain it changes little: boards of the frame run along its sides.
        let grain = if frame && across < down { noise(x, y / 7) } else { noise(x / 7 + 50, y) };
        let gap = across == 4 || down == 4 || (!frame && y % 6 == 5);
        let nail = (across == 2 || across == 1) && (down == 2 || down == 1);
        let light = if gap { 50 } else { 150 + grain / 4 - if frame { 0 } else { 25 } };
        texels[y][x] = if nail { rgb565(70, 70, 80) } else { rgb565(light, light * 11 / 16, light * 6 / 16) };
        k += 1;
    }
    texels
};

pub static WOODEN: Tile<'static, WOOD, WOOD> = Tile::new(&WOOD_TEXELS);

/// Corners of a crate's faces, as an axis along u, one along v and the way out.
const SIDES: [[[i32; 3]; 3]; 6] = [
    [[1, 0, 0], [0, -1, 0], [0, 0, 1]],
    [[0, 0, -1], [0, -1, 0], [1, 0, 0]],
    [[-1, 0, 0], [0, -1, 0], [0, 0, -1]],
    [[0, 0, 1], [0, -1, 0], [-1, 0, 0]],
    [[1, 0, 0], [0, 0, 1], [0, 1, 0]],
    [[1, 0, 0], [0, 0, -1], [0, -1, 0]],
];

struct Box {
    points: [Vec3; 24],
    uvs: [[Scalar; 2]; 24],
    normals: [[i16; 3]; 24],
}

static BOX: Box = {
    let (mut points, mut uvs) = ([Vec3::ZERO; 24], [[Scalar::ZERO; 2]; 24]);
    let mut normals = [[0; 3]; 24];
    let mut k = 0;
    while k < 24 {
        let [u, v, out] = SIDES[k / 4];
        // Lower left, lower right, upper right, upper left.
        let [right, down] = [[0, 1], [1, 1], [1, 0], [0, 0]][k % 4];
        let mut bits = [0; 3];
        let mut axis = 0;
        while axis < 3 {
            bits[axis] = (out[axis] + (2 * right - 1) * u[axis] + (2 * down - 1) * v[axis]) << 15;
            normals[k][axis] = out[axis] as i16 * NORMAL_ONE;
            axis += 1;
        }
        points[k] = Vec3::from_bits(bits);
        uvs[k] = [Scalar::from_bits(right << 16), Scalar::from_bits(down << 16)];
        k += 1;
    }
    Box { points, uvs, normals }
};

/// A cube with sides of 1, and the whole texture on each of them.
pub static CRATE: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    uvs: Some(&BOX.uvs),
    normals: Some(&BOX.normals),
    ..MeshData::new(Positions::Exact(&BOX.points))
});

/// Sides of the floor's texture, and of the smaller ones.
const TILES: usize = 64;
const LEVELS: usize = 5;

/// Big-endian texels of all levels, one after the other: 64 x 64, 32 x 32, .., 4 x 4.
const FLOOR_BYTES: usize = 2 * (64 * 64 + 32 * 32 + 16 * 16 + 8 * 8 + 4 * 4);

/// Red, green and blue of the floor: four slabs with joints.
const fn slab(x: usize, y: usize) -> [usize; 3] {
    let half = TILES / 2;
    let joint = x % half < 2 || y % half < 2;
    let dark = (x / half + y / half).is_multiple_of(2);
    let spots = noise(x / 2 + 9, y / 2) / 8;
    match (joint, dark) {
        (true, _) => [60, 60, 64],
        (false, true) => [90 + spots, 100 + spots, 116 + spots],
        (false, false) => [168 + spots, 170 + spots, 160 + spots],
    }
}

const fn floor_bytes() -> [u8; FLOOR_BYTES] {
    let mut bytes = [0; FLOOR_BYTES];
    let mut at = 0;
    let mut level = 0;
    while level < LEVELS {
        let (side, texels) = (TILES >> level, 1 << level);
        let mut k = 0;
        while k < side * side {
            // The mean of the texels that it stands for.
            let mut sum = [0; 3];
            let mut n = 0;
            while n < texels * texels {
                let [r, g, b] = slab(k % side * texels + n % texels, k / side * texels + n / texels);
                sum = [sum[0] + r, sum[1] + g, sum[2] + b];
                n += 1;
            }
            let [high, low] = rgb565(sum[0] / n, sum[1] / n, sum[2] / n).to_be_bytes();
            (bytes[at], bytes[at + 1]) = (high, low);
            at += 2;
            k += 1;
        }
        level += 1;
    }
    bytes
}

type Level = Image<'static, Rgb565Texel>;

/// The floor's mip chain.
pub fn floor_levels() -> &'static [Level; LEVELS] {
    const {
        let bytes: &'static [u8; FLOOR_BYTES] = const { &floor_bytes() };
        let mut levels = [level(bytes, 0, 64); LEVELS];
        let (mut at, mut side, mut k) = (0, TILES, 0);
        while k < LEVELS {
            levels[k] = level(bytes, at, side);
            at += 2 * side * side;
            side /= 2;
            k += 1;
        }
        &{ levels }
    }
}

const fn level(bytes: &'static [u8; FLOOR_BYTES], at: usize, side: usize) -> Level {
    let (_, rest) = bytes.split_at(at);
    let (bytes, _) = rest.split_at(2 * side * side);
    match Image::new(bytes, Size::new(side as u32, side as u32), Rgb565Texel) {
        Ok(image) => image,
        Err(_) => panic!("a level has another size"),
    }
}

/// Squares of the floor, each way; one is 2 x 2 and shows the texture twice each way.
const SQUARES: usize = 8;
const FLOOR_POINTS: usize = (SQUARES + 1) * (SQUARES + 1);

const fn floor_points() -> ([Vec3; FLOOR_POINTS], [[Scalar; 2]; FLOOR_POINTS], [u16; 4 * SQUARES * SQUARES]) {
    let (mut points, mut uvs) = ([Vec3::ZERO; FLOOR_POINTS], [[Scalar::ZERO; 2]; FLOOR_POINTS]);
    let mut k = 0;
    while k < FLOOR_POINTS {
        let (x, z) = ((k % (SQUARES + 1)) as i32 - SQUARES as i32 / 2, (k / (SQUARES + 1)) as i32 - SQUARES as i32 / 2);
        points[k] = Vec3::from_ints(2 * x as i16, 0, 2 * z as i16);
        uvs[k] = [Scalar::from_bits(x << 17), Scalar::from_bits(z << 17)];
        k += 1;
    }
    let mut quads = [0; 4 * SQUARES * SQUARES];
    let mut k = 0;
    while k < SQUARES * SQUARES {
        let first = (k / SQUARES * (SQUARES + 1) + k % SQUARES) as u16;
        let below = first + SQUARES as u16 + 1;
        (quads[4 * k], quads[4 * k + 1], quads[4 * k + 2], quads[4 * k + 3]) = (below, below + 1, first + 1, first);
        k += 1;
    }
    (points, uvs, quads)
}

static FLOOR_DATA: ([Vec3; FLOOR_POINTS], [[Scalar; 2]; FLOOR_POINTS], [u16; 4 * SQUARES * SQUARES]) = floor_points();

pub static GROUND: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    indices: Some(&FLOOR_DATA.2),
    uvs: Some(&FLOOR_DATA.1),
    ..MeshData::new(Positions::Exact(&FLOOR_DATA.0))
});

/// A mesh of wire: 16 x 16 texels of one bit.
static WIRE: [u8; 32] = {
    let mut bytes = [0; 32];
    let mut y = 0;
    while y < 16 {
        let diagonals = 0xC003_u32 << y | 0xC003_u32 >> (16 - y) | 0xC003_u32 << (16 - y) | 0xC003_u32 >> y;
        let row = diagonals as u16;
        (bytes[2 * y], bytes[2 * y + 1]) = ((row >> 8) as u8, row as u8);
        y += 1;
    }
    bytes
};

/// Four by one and a half, the wire in squares of 1/4.
pub static FENCE: Mesh<'static> = Mesh::constant(MeshData {
    topology: Topology::Quads,
    uvs: Some(&[
        [Scalar::ZERO, Scalar::from_bits(6 << 16)],
        [Scalar::from_bits(16 << 16), Scalar::from_bits(6 << 16)],
        [Scalar::from_bits(16 << 16), Scalar::ZERO],
        [Scalar::ZERO, Scalar::ZERO],
    ]),
    ..MeshData::new(Positions::Exact(&[
        Vec3::from_milli(-2000, 0, 0),
        Vec3::from_milli(2000, 0, 0),
        Vec3::from_milli(2000, 1500, 0),
        Vec3::from_milli(-2000, 1500, 0),
    ]))
});

/// The fence's texture.
static WIRE_IMAGE: Image<'static, MaskTexel> = match Image::new(&WIRE, Size::new(16, 16), MaskTexel([150, 160, 170])) {
    Ok(image) => image,
    Err(_) => panic!("the wire has another size"),
};

/// Which levels of the floor's texture are used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Levels {
    /// The mip chain.
    All,
    /// The largest one alone.
    First,
}

/// Returns the matrix from world space to eye space, around the crates.
fn around(turn: Angle16) -> Affine {
    Affine::rotation_x(Angle16::from_degrees(16))
        * Affine::translation(Vec3::from_milli(0, -1500, -3800))
        * Affine::rotation_y(turn)
}

/// Where the crates are, in thousandths, and how they are turned, in degrees.
const CRATES: [[i32; 4]; 3] = [[-700, 500, 0, 20], [650, 500, -400, -35], [-100, 1500, -150, 50]];

/// A crate: its matrix from object space to clip space, and its wood under the light.
struct Crate<G> {
    mvp: Projective,
    wood: LitTexture<'static, Tile<'static, WOOD, WOOD>, Sunlit, Repeat, G>,
}

/// Crates on a floor, with a fence behind them.
pub struct Crates<G> {
    floor: Projective,
    /// `None` if its levels had other sizes than a mip chain has: firmware that panics nowhere draws no ground then.
    ground: Option<Textured<'static, Level, Repeat, G, Mipmapped>>,
    crates: Kept<[Crate<G>]>,
    fence: Projective,
}

impl<G: Filter> Crates<G> {
    pub fn new(screen: Size, turn: Angle16, filter: G, levels: Levels) -> Self {
        let camera = camera(screen, Scalar::from_bits(1 << 14), Scalar::from_bits(24 << 16));
        let view = around(turn);
        let all = floor_levels();
        let ground = Textured::mipmapped(if levels == Levels::All { all } else { &all[..1] });
        let floor = camera * view;
        Self {
            floor,
            ground: ground.ok().map(|ground| ground.wrap(Repeat).filter(filter)),
            crates: kept_list(CRATES.len(), |k| {
                let [x, y, z, degrees] = CRATES[k];
                let place = Affine::translation(Vec3::from_milli(x, y, z));
                let model = view * place * Affine::rotation_y(Angle16::from_degrees(degrees));
                let wood = Textured::new(&WOODEN).filter(filter).lit(LIGHT.on(&Matte::WHITE, &model));
                Crate { mvp: camera * model, wood }
            }),
            fence: floor * Affine::translation(Vec3::from_milli(0, 0, 1300)),
        }
    }
}

impl<F: Framebuffer, G: Filter> Draw<F> for Crates<G> {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        if let Some(ground) = &self.ground {
            draw_apart(scene, State::DEFAULT, &GROUND, &self.floor, ground);
        }
        for Crate { mvp, wood } in &*self.crates {
            draw_apart(scene, State::DEFAULT, &CRATE, mvp, wood);
        }
        let both_sides = State { cull: Cull::None, ..State::DEFAULT };
        draw_apart(scene, both_sides, &FENCE, &self.fence, &Textured::new(&WIRE_IMAGE));
    }
}

/// A crate so close that perspective is strong, partly in front of the near plane.
pub struct Close(Projective);

impl Close {
    pub fn new(screen: Size, turn: Angle16) -> Self {
        let model = Affine::translation(Vec3::from_milli(0, 0, -1250))
            * Affine::rotation_x(Angle16::from_degrees(25))
            * Affine::rotation_y(turn);
        Self(camera(screen, Scalar::from_bits(1 << 12), Scalar::from_bits(8 << 16)) * model)
    }
}

impl<F: Framebuffer> Draw<F> for Close {
    fn draw(&self, scene: &mut Scene<'_, F>) {
        draw_apart(scene, State::DEFAULT, &CRATE, &self.0, &Textured::new(&WOODEN));
    }
}
