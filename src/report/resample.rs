//! The random draws of the bootstrap: seeded, so that a report comes out the same every time.

use crate::math::rng::philox;

/// Draws indices uniformly and without bias. Nothing in an experiment depends on it.
#[derive(Debug, Clone)]
pub struct Resampler {
    seed: u32,
    /// Number of the next block of four words.
    block: u64,
    words: [u32; 4],
    /// Words of the block that are not used yet.
    left: usize,
}

impl Resampler {
    /// The same seed gives the same draws.
    pub fn new(seed: u32) -> Self {
        Self { seed, block: 0, words: [0; 4], left: 0 }
    }

    /// Uniform in `0..count`; 0 if `count` is 0. Counts above `u32::MAX` are taken as that.
    pub fn index(&mut self, count: usize) -> usize {
        let count = u32::try_from(count).unwrap_or(u32::MAX);
        // Multiply and keep the high half; the few low halves that would favour some indices are drawn again.
        let unfair = count.wrapping_neg().checked_rem(count).unwrap_or(0);
        loop {
            let wide = u64::from(self.word()) * u64::from(count);
            if wide as u32 >= unfair {
                return (wide >> 32) as usize;
            }
        }
    }

    fn word(&mut self) -> u32 {
        if self.left == 0 {
            self.words = philox([self.block as u32, (self.block >> 32) as u32, 0, 0], [self.seed, 0]);
            self.block += 1;
            self.left = 4;
        }
        self.left -= 1;
        self.words[3 - self.left]
    }
}
