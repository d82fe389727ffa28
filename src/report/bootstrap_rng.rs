//! The random draws of the bootstrap: seeded, so that a report comes out the same every time.

use crate::math::rng::philox;
use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// Any number would do; it is fixed so that reports can be compared byte by byte.
const SEED: u32 = 1993;
/// Draws that are kept for one number of values; 32 MiB.
const KEPT: usize = 1 << 23;

/// All intervals over as many seeds draw alike, and a report has hundreds of them: draws by number of values and of
/// samples.
static DRAWN: LazyLock<Mutex<BTreeMap<(usize, usize), Arc<Vec<u32>>>>> = LazyLock::new(Mutex::default);

/// Tells, for each of `samples` samples with replacement, how often each of `count` values is in it.
pub fn resample(count: usize, samples: usize, mut each: impl FnMut(&[u32])) {
    if count * samples > KEPT {
        return draw(count, samples, each);
    }
    let mut drawn = DRAWN.lock().unwrap_or_else(PoisonError::into_inner);
    let entry = drawn.entry((count, samples)).or_insert_with(|| {
        let mut times = Vec::with_capacity(count * samples);
        draw(count, samples, |sample| times.extend_from_slice(sample));
        Arc::new(times)
    });
    let times = Arc::clone(entry);
    drop(drawn);
    times.chunks_exact(count.max(1)).for_each(&mut each);
}

fn draw(count: usize, samples: usize, mut each: impl FnMut(&[u32])) {
    let mut random = BootstrapRng::new(SEED);
    let mut times = vec![0_u32; count];
    for _ in 0..samples {
        times.fill(0);
        for _ in 0..count {
            times[random.index(count)] += 1;
        }
        each(&times);
    }
}

/// Draws indices uniformly and without bias. Nothing in an experiment depends on it.
#[derive(Debug, Clone)]
pub struct BootstrapRng {
    seed: u32,
    /// Number of the next block of four words.
    block: u64,
    words: [u32; 4],
    /// Words of the block that are not used yet.
    left: usize,
}

impl BootstrapRng {
    /// The same seed gives the same draws.
    pub fn new(seed: u32) -> Self {
        Self { seed, block: 0, words: [0; 4], left: 0 }
    }

    /// Uniform in `0..count`; 0 if `count` is 0. At most 2^32 values.
    pub fn index(&mut self, count: usize) -> usize {
        let count = count as u32;
        if count == 0 {
            return 0;
        }
        // Lemire (2019): the high word of a product, where low words that some results would have too often are redrawn.
        loop {
            let product = u64::from(self.word()) * u64::from(count);
            if product as u32 >= count.wrapping_neg() % count {
                return (product >> 32) as usize;
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
