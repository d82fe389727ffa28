//! Sums over lanes by value: a way through memory takes longer than the sum.

use crate::layout::LANES;

/// Sum of the lanes by the tree of [`crate::math::reduce::lanes_sums`].
#[inline(always)]
pub fn lanes_sum<const N: usize>(lanes: &[f32; N]) -> f32 {
    let mut half = [0.0; 16];
    half.copy_from_slice(&lanes[..16]);
    if N == LANES {
        for lane in 0..16 {
            half[lane] += lanes[lane + 16];
        }
    }
    let quarter: [f32; 8] = folded(&half);
    let eighth: [f32; 4] = folded(&quarter);
    let pair: [f32; 2] = folded(&eighth);
    pair[0] + pair[1]
}

/// The upper half of the lanes added to the lower.
#[inline(always)]
fn folded<const N: usize, const HALF: usize>(lanes: &[f32; N]) -> [f32; HALF] {
    let mut half = [0.0; HALF];
    for lane in 0..HALF {
        half[lane] = lanes[lane] + lanes[lane + HALF];
    }
    half
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_by_value_follow_the_tree() {
        let values: [f32; LANES] = std::array::from_fn(|i| ((i * 7) % 32) as f32 + 0.5);
        assert_eq!((lanes_sum(&values), lanes_sum::<16>(values.first_chunk().expect("16 of 32"))), (512.0, 240.0));
        let mut uneven = [0.0; LANES];
        (uneven[0], uneven[1], uneven[16]) = (1.0e8, 1.0, -1.0e8);
        assert_eq!(lanes_sum(&uneven), 1.0);
    }
}
