//! Bytes → numbers of the kinds that break rasterizers. A byte says which kind a number is of, so that a changed byte
//! changes one number, and extremes, ties and shared coordinates are frequent. Past the end, all bytes are 0.

use arbitrary::Unstructured;
use zstrip::math::{Affine, Angle16, Projective, Scalar, Vec3};

/// Largest coordinate on the screen, in 24.8 px.
pub const LIMIT: i32 = (1 << 23) - 1;

const EXTREMES: [i32; 16] = [
    0,
    1,
    -1,
    i32::MAX,
    i32::MIN,
    i32::MAX - 1,
    i32::MIN + 1,
    1 << 16,
    -(1 << 16),
    (1 << 16) - 1,
    0x7FFF,
    -0x8000,
    0xFFFF,
    1 << 30,
    -(1 << 30),
    131_071,
];

pub struct Source<'a>(Unstructured<'a>);

impl<'a> Source<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self(Unstructured::new(bytes))
    }

    fn bits<const N: usize>(&mut self) -> [u8; N] {
        let mut bytes = [0; N];
        // Short input is filled up with zeros, so there is no error.
        let _ = self.0.fill_buffer(&mut bytes);
        bytes
    }

    /// The bytes that are left.
    pub fn rest(&mut self) -> &'a [u8] {
        let left = self.0.len();
        self.0.bytes(left).unwrap_or_default()
    }

    /// Some of the bytes that are left.
    pub fn slice(&mut self, most: usize) -> &'a [u8] {
        let left = self.0.len().min(most);
        self.0.bytes(left).unwrap_or_default()
    }

    pub fn u8(&mut self) -> u8 {
        self.bits::<1>()[0]
    }

    pub fn u16(&mut self) -> u16 {
        u16::from_le_bytes(self.bits())
    }

    pub fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.bits())
    }

    pub fn u64(&mut self) -> u64 {
        u64::from_le_bytes(self.bits())
    }

    pub fn flag(&mut self) -> bool {
        self.u8() & 1 != 0
    }

    /// A number below `bound`, which is 1 to 256, from one byte.
    pub fn below(&mut self, bound: usize) -> usize {
        usize::from(self.u8()) % bound
    }

    pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    /// Any number: small, extreme, beside a power of two, or of any magnitude.
    pub fn int(&mut self) -> i32 {
        let kind = self.u8();
        let more = u32::from(kind >> 3);
        match kind & 7 {
            0 => more as i32 - 16,
            1 => EXTREMES[more as usize % 16],
            2 => i32::from(self.u16() as i16),
            3 => (1_i32 << more).wrapping_add(i32::from(self.u8() as i8 >> 5)),
            4 => (1_i32 << more).wrapping_neg().wrapping_add(i32::from(self.u8() as i8 >> 5)),
            5 => i32::from(self.u16() as i16) << 8,
            _ => self.u32() as i32 >> more,
        }
    }

    /// Any number of 64 bits.
    pub fn long(&mut self) -> i64 {
        match self.below(4) {
            0 => self.int().into(),
            1 => i64::from(self.int()) << 32,
            2 => [i64::MIN, i64::MAX, i64::MIN + 1, -1, 1 << 32, -(1 << 32), 1 << 62, -(1 << 62)][self.below(8)],
            _ => self.u64() as i64 >> self.below(64),
        }
    }

    /// Any size: small ones, and those near the ends of 16 and 32 bits and of the machine's words.
    pub fn size(&mut self) -> u32 {
        match self.below(4) {
            0 => self.u8().into(),
            1 => self.u16().into(),
            _ => self.int() as u32,
        }
    }

    pub fn scalar(&mut self) -> Scalar {
        Scalar::from_bits(self.int())
    }

    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.scalar(), self.scalar(), self.scalar())
    }

    /// Any number of a size that is met in models.
    pub fn modest(&mut self) -> Scalar {
        Scalar::from_bits(i32::from(self.u16() as i16) << self.below(8))
    }

    pub fn modest_vector(&mut self) -> Vec3 {
        Vec3::new(self.modest(), self.modest(), self.modest())
    }

    pub fn angle(&mut self) -> Angle16 {
        Angle16(self.u16())
    }

    /// A transform of a model: none, rigid, scaled, mirrored, or any.
    pub fn affine(&mut self) -> Affine {
        match self.below(8) {
            0 | 1 => Affine::IDENTITY,
            2 => Affine::translation(self.modest_vector()),
            3 => Affine::rotation(self.modest_vector(), self.angle()),
            4 => Affine::translation(self.modest_vector()) * Affine::rotation_y(self.angle()),
            5 => Affine::scale_axes(self.modest_vector()) * Affine::rotation_x(self.angle()),
            6 => Affine::scale(self.scalar()),
            _ => Affine::from_rows(self.vector(), self.vector(), self.vector(), self.vector()),
        }
    }

    /// A matrix: none, a camera before a model, a tilted one, or any.
    pub fn projective(&mut self) -> Projective {
        use zstrip::embedded_graphics_core::geometry::Size;
        match self.below(8) {
            0 | 1 => Projective::IDENTITY,
            2 => Projective::from(self.affine()),
            3..=5 => {
                let angle = Angle16(self.u16() >> 1);
                let (near, far) = (self.scalar(), self.scalar());
                let lens = Projective::perspective(angle, Size::new(4, 3), near, far)
                    .or_else(|_| Projective::perspective(angle, Size::new(4, 3), Scalar::ONE, Scalar::ONE * 50))
                    .unwrap_or(Projective::IDENTITY);
                lens * self.affine()
            }
            6 => {
                let mut rows = Projective::IDENTITY.to_rows();
                for _ in 0..3 {
                    rows[self.below(4)][self.below(4)] = i64::from(self.int()) << 16;
                }
                Projective::from_rows(rows)
            }
            _ => {
                let mut rows = [[0; 4]; 4];
                rows.as_flattened_mut().iter_mut().for_each(|entry| *entry = self.long());
                Projective::from_rows(rows)
            }
        }
    }

    /// A coordinate on the screen in 24.8 px: at `base`, on a grid about it, nearby, on a small screen, or far away.
    /// Never beyond ±32,767 px.
    pub fn coordinate(&mut self, base: i32) -> i32 {
        let kind = self.u8();
        let more = i32::from(kind >> 3);
        let c = match kind & 7 {
            0 => base,
            1 => base + (more - 16) * 128,
            2 => base + more - 16,
            3 => base + i32::from(self.u16() as i16),
            4 => i32::from(self.u16() & 0xFFF),
            5 => self.u32() as i32 >> (8 + more % 16),
            6 => [LIMIT, -LIMIT, LIMIT & !127, -(LIMIT & !127), 0, 256 * 16, 128, -128][more as usize & 7],
            _ => i32::from(self.u8()) * 64 - 4096,
        };
        c.clamp(-LIMIT, LIMIT)
    }

    /// A vertex of clip space, raw 16.16: inside of the view volume, far to the sides, in front of the near plane,
    /// beyond the far plane, behind the eye, at w = 0, a corner of `before`, or anything.
    pub fn clip_vertex(&mut self, before: &[[i32; 4]]) -> [i32; 4] {
        let kind = self.u8();
        let w = i32::from(self.u16() | 1) << (kind >> 4);
        // A fraction of w: exactly 0, ±1, ±1/2 or anything between.
        let mut part = |reach: i32| {
            let f = self.u8() as i8;
            match f {
                -128..=-125 | 125..=127 => i64::from(w) * i64::from(f.signum()),
                _ => (i64::from(w) * i64::from(f) * i64::from(reach)) >> 6,
            }
            .clamp(i32::MIN.into(), i32::MAX.into()) as i32
        };
        match kind & 15 {
            0..=3 => [part(1), part(1), part(1).unsigned_abs() as i32, w],
            4 => [part(100), part(100), part(1).unsigned_abs() as i32, w],
            5 => [part(2000), part(1), part(1), w],
            6 => [part(1), part(1), part(1).saturating_neg(), w],
            7 => [part(1), part(1), part(3), w],
            8 => [part(2), part(2), part(2), -w],
            9 => [part(1), part(1), part(1), 0],
            10 => [self.int(), self.int(), self.int(), self.int()],
            11 => before.last().copied().unwrap_or_default(),
            12 => before.first().copied().unwrap_or([0; 4]),
            13 => {
                // Halfway between the last two.
                let [.., a, b] = before else { return [0; 4] };
                core::array::from_fn(|k| a[k] / 2 + b[k] / 2)
            }
            14 => [part(1), part(1), 0, w],
            _ => [part(1), part(1), w, w],
        }
    }
}
