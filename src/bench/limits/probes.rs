//! The loops that limits are measured with. Each returns how much it did.
//!
//! Enough chains run side by side to hide how long one operation takes, and no more than registers hold beside what
//! the chains meet: there are 32 registers with AVX-512, else 16.

use super::vector::{Instructions, Vector};
use std::hint::black_box;

#[inline(always)]
unsafe fn multiply_add<V: Vector, const CHAINS: usize>(rounds: u64) -> u64 {
    // SAFETY: the caller's promise that the instructions exist.
    unsafe {
        let (factor, term) = (V::splat(black_box(0.999)), V::splat(black_box(0.001)));
        let mut chains = [V::splat(black_box(1.0)); CHAINS];
        for _round in 0..rounds {
            for chain in &mut chains {
                *chain = chain.multiply(factor).add(term);
            }
        }
        for chain in chains {
            black_box(chain.first());
        }
    }
    rounds * (2 * CHAINS * V::LANES) as u64
}

#[inline(always)]
unsafe fn compare_select<V: Vector, const CHAINS: usize>(rounds: u64) -> u64 {
    // SAFETY: the caller's promise that the instructions exist.
    unsafe {
        // What is compared is not what is taken, so that no minimum stands for both.
        let (one, other) = (V::splat(black_box(0.25)), V::splat(black_box(0.75)));
        let mut chains = [V::splat(black_box(0.5)); CHAINS];
        for _round in 0..rounds {
            for chain in &mut chains {
                *chain = chain.select_below(one, other);
            }
            for chain in &mut chains {
                *chain = chain.select_below(other, one);
            }
        }
        for chain in chains {
            black_box(chain.first());
        }
    }
    rounds * (4 * CHAINS * V::LANES) as u64
}

/// Registers read at a time.
const STREAMS: usize = 8;

#[inline(always)]
unsafe fn read<V: Vector>(memory: &[f32], passes: u64) -> u64 {
    let block = STREAMS * V::LANES;
    // SAFETY: the caller's promise that the instructions exist; all places lie in a block of the slice.
    unsafe {
        let mut sums = [V::splat(0.0); STREAMS];
        for _pass in 0..passes {
            for part in black_box(memory).chunks_exact(block) {
                for (stream, sum) in sums.iter_mut().enumerate() {
                    *sum = sum.add(V::load(part.as_ptr().add(stream * V::LANES)));
                }
            }
        }
        for sum in sums {
            black_box(sum.first());
        }
    }
    passes * (memory.len() / block * block * 4) as u64
}

#[inline(always)]
unsafe fn update<V: Vector>(memory: &mut [f32], passes: u64) -> u64 {
    let block = STREAMS * V::LANES;
    // SAFETY: the caller's promise that the instructions exist; all places lie in a block of the slice.
    unsafe {
        let term = V::splat(black_box(1.0e-3));
        for _pass in 0..passes {
            for part in black_box(&mut *memory).chunks_exact_mut(block) {
                for stream in 0..STREAMS {
                    let place = part.as_mut_ptr().add(stream * V::LANES);
                    V::load(place).add(term).store(place);
                }
            }
        }
    }
    2 * passes * (memory.len() / block * block * 4) as u64
}

/// Declares a function that runs a loop on the registers of each instruction set.
macro_rules! widest {
    ($name:ident = $probe:ident($($argument:ident: $kind:ty),*); $($few:literal, $chains:literal, $wide:literal)?) => {
        pub(super) fn $name(instructions: Instructions, $($argument: $kind),*) -> u64 {
            #[cfg(target_arch = "x86_64")]
            mod wide {
                use super::*;

                #[target_feature(enable = "avx2")]
                pub(super) fn avx2($($argument: $kind),*) -> u64 {
                    // SAFETY: this function is compiled for the instructions.
                    unsafe { $probe::<std::arch::x86_64::__m256 $(, $chains)?>($($argument),*) }
                }

                #[target_feature(enable = "avx512f")]
                pub(super) fn avx512($($argument: $kind),*) -> u64 {
                    // SAFETY: as above.
                    unsafe { $probe::<std::arch::x86_64::__m512 $(, $wide)?>($($argument),*) }
                }
            }
            match instructions {
                // SAFETY: arrays need no instructions of their own.
                Instructions::Baseline => unsafe { $probe::<[f32; 4] $(, $few)?>($($argument),*) },
                // SAFETY: `Instructions::all` saw them on this machine.
                #[cfg(target_arch = "x86_64")]
                Instructions::Avx2 => unsafe { wide::avx2($($argument),*) },
                // SAFETY: as above.
                #[cfg(target_arch = "x86_64")]
                Instructions::Avx512 => unsafe { wide::avx512($($argument),*) },
            }
        }
    };
}

widest! { run_multiply_add = multiply_add(rounds: u64); 12, 12, 24 }
widest! { run_compare_select = compare_select(rounds: u64); 8, 12, 24 }
widest! { run_read = read(memory: &[f32], passes: u64); }
widest! { run_update = update(memory: &mut [f32], passes: u64); }
