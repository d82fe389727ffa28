//! Random words eight draws at a time: one vector of 64-bit products holds them all.

use crate::env::workgroup::Workgroup;
use crate::layout::LANES;
use crate::math::rng::Stream;

/// Draws of which one vector of 64-bit products holds all.
pub const BATCH: usize = 8;
/// Draws of a step that [`draw_step`] makes at once. The light's are left for when the light is seen.
const EAGER: usize = 2 * BATCH;

/// Draw number `draw` of a stream.
///
/// Words stand in 64 bits, so that one product gives both of its halves; what the upper 32 hold besides is cut off
/// before it is used.
#[inline(always)]
fn draw(stream: Stream, draw: u32) -> [u32; 4] {
    const LOW: u64 = 0xffff_ffff;
    let mut c = [stream.trial, stream.step, (stream.purpose << 16) | draw, stream.skill].map(u64::from);
    let mut k = stream.key;
    for _round in 0..10 {
        let product0 = 0xd251_1f53_u64 * (c[0] & LOW);
        let product1 = 0xcd9e_8d57_u64 * (c[2] & LOW);
        c = [(product1 >> 32) ^ c[1] ^ u64::from(k[0]), product1, (product0 >> 32) ^ c[3] ^ u64::from(k[1]), product0];
        k = [k[0].wrapping_add(0x9e37_79b9), k[1].wrapping_add(0xbb67_ae85)];
    }
    c.map(|word| word as u32)
}

/// Draws number `first` to `first` + 7 of a stream: word `w` of draw `first` + `i` is `[w][i]`.
#[inline(always)]
pub fn draws(stream: Stream, first: u32) -> [[u32; BATCH]; 4] {
    let mut words = [[0; BATCH]; 4];
    for i in 0..BATCH {
        let drawn = draw(stream, first + i as u32);
        words[0][i] = drawn[0];
        words[1][i] = drawn[1];
        words[2][i] = drawn[2];
        words[3][i] = drawn[3];
    }
    words
}

/// Draws the random words of a primitive step, but those of the light.
#[inline(always)]
pub fn draw_step(group: &mut Workgroup<'_>, stream: Stream) {
    let random = &mut group.random;
    random.stream = stream;
    for first in (0..EAGER).step_by(BATCH) {
        let [x, y, z, w] = draws(stream, first as u32);
        random.x[first..first + BATCH].copy_from_slice(&x);
        random.y[first..first + BATCH].copy_from_slice(&y);
        random.z[first..first + BATCH].copy_from_slice(&z);
        random.w[first..first + BATCH].copy_from_slice(&w);
    }
}

/// Bearings that share a word of their draws.
const ABREAST: usize = 6;

/// Element of a bearing, 0 to 23, in an array that has one for each: six in each half of a vector, and two stay free.
/// That is how the words of [`draws`] lie, so that nothing is moved to meet them.
pub const fn place_of(bearing: usize) -> usize {
    bearing / ABREAST * BATCH + bearing % ABREAST
}

/// A word for each of 24 bearings, from six draws: bearing `b` has word `b` / 6 of draw `b` % 6. It stands at
/// [`place_of`] the bearing.
#[inline(always)]
pub fn bearing_words(x: &[u32], y: &[u32], z: &[u32], w: &[u32]) -> [u32; LANES] {
    let mut words = [0; LANES];
    for (block, drawn) in words.chunks_exact_mut(BATCH).zip([x, y, z, w]) {
        block.copy_from_slice(&drawn[..BATCH]);
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{self, Purpose, StepRandom};

    #[test]
    fn draws_are_those_of_the_plain_form() {
        let stream = Stream { key: [1, 2], skill: 3, trial: 4, step: 5, purpose: Purpose::Step as u32 };
        let mut random = StepRandom::default();
        random.draw_step(stream);
        for first in [0_u32, 16] {
            let [x, y, z, w] = draws(stream, first);
            for i in 0..BATCH {
                assert_eq!([x[i], y[i], z[i], w[i]], rng::draw(stream, first + i as u32));
            }
            let words = bearing_words(&x, &y, &z, &w);
            for bearing in 0..24 {
                assert_eq!(words[place_of(bearing)], random.bearing_word(first as usize, bearing));
            }
        }
    }
}
