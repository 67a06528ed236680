//! Numbers for tests that sample, the same for the same seed.

/// A generator of numbers.
pub struct Random(u64);

impl Random {
    /// One that starts from a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next number (splitmix64).
    pub fn draw(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number of a range, both ends included.
    pub fn within(&mut self, (lo, hi): (i32, i32)) -> i32 {
        let size = (i64::from(hi) - i64::from(lo) + 1) as u64;
        (i64::from(lo) + (self.draw() % size) as i64) as i32
    }
}
