//! The random draws of the bootstrap: seeded, so that a report comes out the same every time.

use crate::math::rng::philox;
use rand::{RngExt, TryRng};
use std::collections::BTreeMap;
use std::convert::Infallible;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// Any number would do; it is fixed so that reports can be compared byte by byte.
const SEED: u32 = 1993;
/// Draws that are kept for one number of values; 32 MiB.
const KEPT: usize = 1 << 23;

/// Draws by number of values and of samples.
type Drawn = BTreeMap<(usize, usize), Arc<Vec<u32>>>;

/// All intervals over as many seeds draw alike, and a report has hundreds of them.
static DRAWN: LazyLock<Mutex<Drawn>> = LazyLock::new(Mutex::default);

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
    let mut draws = Resampler::new(SEED);
    let mut times = vec![0_u32; count];
    for _ in 0..samples {
        times.fill(0);
        for _ in 0..count {
            times[draws.index(count)] += 1;
        }
        each(&times);
    }
}

/// Draws indices uniformly and without bias. Nothing in an experiment depends on it.
#[derive(Debug, Clone)]
pub struct Resampler {
    words: Words,
}

/// The words of one Philox stream, for `rand`'s distributions.
#[derive(Debug, Clone)]
struct Words {
    seed: u32,
    /// Strata draw independently of one another.
    stratum: u32,
    /// Number of the next block of four words.
    block: u64,
    words: [u32; 4],
    /// Words of the block that are not used yet.
    left: usize,
}

impl Resampler {
    /// The same seed gives the same draws.
    pub fn new(seed: u32) -> Self {
        Self { words: Words { seed, stratum: 0, block: 0, words: [0; 4], left: 0 } }
    }

    /// The stream of one of several strata; the first one's is that of [`resample`].
    pub fn of_stratum(stratum: u32) -> Self {
        Self { words: Words { stratum, ..Self::new(SEED).words } }
    }

    /// Uniform in `0..count`; 0 if `count` is 0.
    pub fn index(&mut self, count: usize) -> usize {
        if count == 0 { 0 } else { self.words.random_range(0..count) }
    }
}

impl TryRng for Words {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        if self.left == 0 {
            self.words = philox([self.block as u32, (self.block >> 32) as u32, 0, 0], [self.seed, self.stratum]);
            self.block += 1;
            self.left = 4;
        }
        self.left -= 1;
        Ok(self.words[3 - self.left])
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        let low = u64::from(self.try_next_u32()?);
        Ok(low | u64::from(self.try_next_u32()?) << 32)
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        for chunk in bytes.chunks_mut(4) {
            let word = self.try_next_u32()?.to_le_bytes();
            chunk.copy_from_slice(&word[..chunk.len()]);
        }
        Ok(())
    }
}
