//! Registers of the widest kind that this machine has, behind one interface.

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64 as arch;

/// Instruction sets that the limits are measured with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Instructions {
    Baseline,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Instructions {
    /// Those that this machine has.
    pub(super) fn all() -> Vec<Self> {
        let mut all = vec![Self::Baseline];
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx2") {
                all.push(Self::Avx2);
            }
            if is_x86_feature_detected!("avx512f") {
                all.push(Self::Avx512);
            }
        }
        all
    }
}

/// One register of f32.
///
/// # Safety
/// Every function may be called only where the register's instructions exist.
pub(super) trait Vector: Copy {
    /// Elements.
    const LANES: usize;

    unsafe fn splat(value: f32) -> Self;
    unsafe fn multiply(self, other: Self) -> Self;
    unsafe fn add(self, other: Self) -> Self;
    /// `self`, or what one operation makes of `taken` where `candidate` is less than `self`.
    unsafe fn select_below(self, candidate: Self, taken: Self) -> Self;
    /// `from` must be good for reads of `LANES` f32.
    unsafe fn load(from: *const f32) -> Self;
    /// `to` must be good for writes of `LANES` f32.
    unsafe fn store(self, to: *mut f32);
    /// The first element.
    unsafe fn first(self) -> f32;
}

impl Vector for [f32; 4] {
    const LANES: usize = 4;

    #[inline(always)]
    unsafe fn splat(value: f32) -> Self {
        [value; 4]
    }

    #[inline(always)]
    unsafe fn multiply(self, other: Self) -> Self {
        std::array::from_fn(|lane| self[lane] * other[lane])
    }

    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        std::array::from_fn(|lane| self[lane] + other[lane])
    }

    #[inline(always)]
    unsafe fn select_below(self, candidate: Self, taken: Self) -> Self {
        // Bits, so that no compiler makes branches of it.
        std::array::from_fn(|lane| {
            let mask = 0_u32.wrapping_sub(u32::from(candidate[lane] < self[lane]));
            f32::from_bits((taken[lane].to_bits() & mask) | (self[lane].to_bits() & !mask))
        })
    }

    #[inline(always)]
    unsafe fn load(from: *const f32) -> Self {
        // SAFETY: the caller's promise; an array of f32 is aligned as an f32 is.
        unsafe { from.cast::<Self>().read() }
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut f32) {
        // SAFETY: as above.
        unsafe { to.cast::<Self>().write(self) }
    }

    #[inline(always)]
    unsafe fn first(self) -> f32 {
        self[0]
    }
}

#[cfg(target_arch = "x86_64")]
impl Vector for arch::__m256 {
    const LANES: usize = 8;

    #[inline(always)]
    unsafe fn splat(value: f32) -> Self {
        // SAFETY: the caller's promise that the instructions exist; so below.
        unsafe { arch::_mm256_set1_ps(value) }
    }

    #[inline(always)]
    unsafe fn multiply(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        unsafe { arch::_mm256_mul_ps(self, other) }
    }

    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        unsafe { arch::_mm256_add_ps(self, other) }
    }

    #[inline(always)]
    unsafe fn select_below(self, candidate: Self, taken: Self) -> Self {
        // SAFETY: see `splat`.
        unsafe {
            let below = arch::_mm256_cmp_ps::<{ arch::_CMP_LT_OQ }>(candidate, self);
            arch::_mm256_blendv_ps(self, taken, below)
        }
    }

    #[inline(always)]
    unsafe fn load(from: *const f32) -> Self {
        // SAFETY: see `splat`; the caller vouches for the place.
        unsafe { arch::_mm256_loadu_ps(from) }
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut f32) {
        // SAFETY: see `load`.
        unsafe { arch::_mm256_storeu_ps(to, self) }
    }

    #[inline(always)]
    unsafe fn first(self) -> f32 {
        // SAFETY: see `splat`.
        unsafe { arch::_mm256_cvtss_f32(self) }
    }
}

#[cfg(target_arch = "x86_64")]
impl Vector for arch::__m512 {
    const LANES: usize = 16;

    #[inline(always)]
    unsafe fn splat(value: f32) -> Self {
        // SAFETY: the caller's promise that the instructions exist; so below.
        unsafe { arch::_mm512_set1_ps(value) }
    }

    #[inline(always)]
    unsafe fn multiply(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        unsafe { arch::_mm512_mul_ps(self, other) }
    }

    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        // SAFETY: see `splat`.
        unsafe { arch::_mm512_add_ps(self, other) }
    }

    #[inline(always)]
    unsafe fn select_below(self, candidate: Self, taken: Self) -> Self {
        // SAFETY: see `splat`.
        unsafe {
            let below = arch::_mm512_cmp_ps_mask::<{ arch::_CMP_LT_OQ }>(candidate, self);
            // Zen 4 has more room for minima under a mask than for blends.
            arch::_mm512_mask_min_ps(self, below, self, taken)
        }
    }

    #[inline(always)]
    unsafe fn load(from: *const f32) -> Self {
        // SAFETY: see `splat`; the caller vouches for the place.
        unsafe { arch::_mm512_loadu_ps(from) }
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut f32) {
        // SAFETY: see `load`.
        unsafe { arch::_mm512_storeu_ps(to, self) }
    }

    #[inline(always)]
    unsafe fn first(self) -> f32 {
        // SAFETY: see `splat`.
        unsafe { arch::_mm512_cvtss_f32(self) }
    }
}
