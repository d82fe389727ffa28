//! The 32 lanes of a learner: arrays in Rust, the invocations of a workgroup in WGSL.

use crate::layout::{LANES, MAX_CHILDREN};

/// One f32 for each lane.
pub type Lanes = [f32; LANES];

/// One value per lane for each child: what the nets' outputs are summed from.
pub type Partials = [Lanes; MAX_CHILDREN];

/// Sums over the first `lanes` lanes, a power of two, for each of the first `children`, by the fixed tree 16, 8, 4, 2,
/// 1. Element 0 of each holds the sum afterwards.
#[inline(always)]
pub fn lanes_sums(partials: &mut Partials, children: u32, lanes: usize) {
    let mut width = lanes / 2;
    while width > 0 {
        for child in 0..children as usize {
            for lane in 0..width {
                partials[child][lane] += partials[child][lane + width];
            }
        }
        width /= 2;
    }
}

/// Least of the lanes' values, none of which may be negative: their bits are compared as integers.
#[inline(always)]
pub fn lanes_min<const N: usize>(values: &[f32; N]) -> f32 {
    let mut lanes_bits = 0x7f80_0000;
    for value in values {
        lanes_bits = lanes_bits.min(value.to_bits());
    }
    f32::from_bits(lanes_bits)
}

/// Bits set in any lane.
#[inline(always)]
pub fn lanes_or<const N: usize>(values: &[u32; N]) -> u32 {
    let mut lanes_bits = 0;
    for value in values {
        lanes_bits |= value;
    }
    lanes_bits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reductions_match_plain_ones() {
        let values: Lanes = std::array::from_fn(|i| ((i * 7) % 32) as f32 + 0.5);
        let mut partials = [values; MAX_CHILDREN];
        lanes_sums(&mut partials, 2, LANES);
        assert_eq!((partials[0][0], partials[1][0], partials[2][0]), (512.0, 512.0, 0.5));
        lanes_sums(&mut partials, 3, 4);
        assert_eq!(partials[2][0], 0.5 + 7.5 + 14.5 + 21.5);
        assert_eq!(lanes_min(&values), 0.5);
        assert_eq!(lanes_or(&std::array::from_fn::<u32, LANES, _>(|i| 1 << i)), !0);
    }

    /// The order is part of the contract: another order gives other bits on this input.
    #[test]
    fn the_sum_follows_the_tree() {
        let sum_of = |pairs: &[(usize, f32)]| {
            let mut partials = [[0.0; LANES]; MAX_CHILDREN];
            for (lane, value) in pairs {
                partials[0][*lane] = *value;
            }
            lanes_sums(&mut partials, 1, LANES);
            partials[0][0]
        };
        assert_eq!(sum_of(&[(0, 1.0e8), (1, 1.0), (16, -1.0e8)]), 1.0);
        assert_eq!(sum_of(&[(0, 1.0e8), (1, 1.0), (17, -1.0e8)]), 0.0);
    }
}
