//! Observations that no world gave.

use skilltree::layout::BASE_WORDS;

/// Senses of a made-up observation: the first words of a record.
pub(crate) fn made_up(next: &mut impl FnMut() -> f64) -> [u32; BASE_WORDS] {
    let mut record = [0; BASE_WORDS];
    for ray in 0..24 {
        record[ray / 4] |= ((next() * 128.0) as u32) << (8 * (ray % 4));
    }
    record[6] = (next() * 268_435_456.0) as u32;
    record[7] = ((next() * 360.0) as f32).to_bits();
    record
}
