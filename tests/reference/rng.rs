//! A seeded random number generator: the same seed gives the same scenes on every machine.
//!
//! A test that panics prints the seed of each [`Rng`] in use, and that number alone reproduces the failure.
//! The crate's own tests use this file as well.

/// Splitmix64: one 64-bit counter, scrambled. Every seed is a good seed.
///
/// # Source
/// Steele, Lea & Flood 2014, "Fast Splittable Pseudorandom Number Generators".
#[derive(Clone, Debug)]
pub struct Rng {
    seed: u64,
    state: u64,
}

impl Rng {
    /// Starts the sequence that belongs to `seed`.
    pub fn new(seed: u64) -> Self {
        Self { seed, state: seed }
    }

    /// The seed this generator was made from, to be printed when a test fails.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Returns 32 random bits.
    pub fn next_u32(&mut self) -> u32 {
        (self.next_u64() >> 32) as u32
    }

    /// Returns a random integer of `bits` bits, one of them its sign.
    ///
    /// # Panics
    /// If `bits` is not in 1..=64.
    pub fn signed_bits(&mut self, bits: u32) -> i64 {
        assert!((1..=64).contains(&bits), "{bits} bits");
        self.next_u64() as i64 >> (64 - bits)
    }

    /// The next 64 random bits.
    pub fn next_u64(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in `0..bound`, by the upper half of a 128-bit product.
    ///
    /// # Panics
    /// If `bound` is zero.
    pub fn below(&mut self, bound: u64) -> u64 {
        assert!(bound > 0, "an empty range has no number in it");
        ((u128::from(self.next_u64()) * u128::from(bound)) >> 64) as u64
    }

    /// A number in `low..=high`.
    ///
    /// # Panics
    /// If `low > high`.
    pub fn between(&mut self, low: i32, high: i32) -> i32 {
        assert!(low <= high, "{low}..={high} is empty");
        let count = (i64::from(high) - i64::from(low) + 1) as u64;
        (i64::from(low) + self.below(count) as i64) as i32
    }

    /// True once in `n` times on average.
    pub fn one_in(&mut self, n: u64) -> bool {
        self.below(n) == 0
    }

    /// One element of `items`.
    ///
    /// # Panics
    /// If `items` is empty.
    pub fn pick<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.below(items.len() as u64) as usize]
    }

    /// A number of either sign whose magnitude is spread over all powers of two up to `2^bits`.
    ///
    /// # Panics
    /// If `bits > 31`.
    pub fn any_magnitude(&mut self, bits: u32) -> i32 {
        assert!(bits <= 31, "more than an i32 holds");
        let limit = 1i64 << self.below(u64::from(bits) + 1);
        let value = self.below(2 * limit as u64 + 1) as i64 - limit;
        value.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
    }

    /// A number in `0.0..1.0` with 53 random bits, for the f64 references.
    pub fn unit(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Prints the seed if the test panics.
impl Drop for Rng {
    fn drop(&mut self) {
        if std::thread::panicking() {
            std::eprintln!("random numbers from seed {:#x}", self.seed);
        }
    }
}
