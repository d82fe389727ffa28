//! The random draws of the bootstrap: seeded, so that a report comes out the same every time.

/// Draws indices uniformly and without bias (SplitMix64, rejection). Nothing in an experiment depends on it.
#[derive(Debug, Clone)]
pub struct Resampler(u64);

impl Resampler {
    /// The same seed gives the same draws.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Uniform in `0..count`; 0 if `count` is 0.
    pub fn index(&mut self, count: usize) -> usize {
        let count = count as u64;
        // Multiply and keep the high half; the few low halves that would favour some indices are drawn again.
        let unfair = count.wrapping_neg().checked_rem(count).unwrap_or(0);
        loop {
            let wide = u128::from(self.next()) * u128::from(count);
            if wide as u64 >= unfair {
                return (wide >> 64) as usize;
            }
        }
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
}
