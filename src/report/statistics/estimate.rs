//! Where values lie: means, quantiles and shares; and their 95 percent intervals: the percentile bootstrap over seeds,
//! and Wilson's interval of a rate.

use crate::report::bootstrap_rng::resample;

/// Resamples behind every interval in a table.
pub const TABLE_RESAMPLES: usize = 10_000;
/// Resamples behind every band in a figure.
pub const BAND_RESAMPLES: usize = 2_000;
/// Share of the distribution below and above the interval.
const TAIL: f64 = 0.025;
/// 97.5 percent point of the normal distribution.
pub(super) const Z: f64 = 1.959_963_984_540_054;

/// A statistic of values sorted in ascending order.
pub type Statistic = fn(&[f64]) -> f64;

/// Arithmetic mean.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Interquartile mean: cut `floor(n / 4)` values from each end, then average (as rliable 1.2.0, Agarwal et al. 2021).
/// Values must be sorted in ascending order.
pub fn interquartile_mean(sorted: &[f64]) -> f64 {
    let cut = sorted.len() / 4;
    mean(&sorted[cut..sorted.len() - cut])
}

/// The values in ascending order.
pub fn sorted(values: &[f64]) -> Vec<f64> {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values
}

/// Quantile of sorted values with linear interpolation, `share` in 0 to 1 (NumPy's default).
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let position = share.clamp(0.0, 1.0) * last as f64;
    let below = position.floor() as usize;
    let above = (below + 1).min(last);
    sorted[below] + (sorted[above] - sorted[below]) * (position - below as f64)
}

/// Sum of the first numbers over the sum of the second ones.
pub fn ratio(pairs: &[(f64, f64)]) -> f64 {
    let sum = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>();
    sum(|pair| pair.0) / sum(|pair| pair.1)
}

/// Share of values below a limit.
pub fn share_below(values: &[f64], limit: f64) -> f64 {
    values.iter().filter(|&&value| value < limit).count() as f64 / values.len() as f64
}

/// A value and the ends of its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

impl Estimate {
    /// What no values say.
    pub const NONE: Self = Self { value: f64::NAN, low: f64::NAN, high: f64::NAN };

    /// A value without uncertainty.
    pub fn exact(value: f64) -> Self {
        Self { value, low: value, high: value }
    }

    /// Whether the interval holds a value, ends included.
    pub fn covers(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// The same, in units of a positive number.
    pub fn over(self, unit: f64) -> Self {
        Self { value: self.value / unit, low: self.low / unit, high: self.high / unit }
    }
}

impl std::ops::Neg for Estimate {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, low: -self.high, high: -self.low }
    }
}

/// A statistic of some values with its percentile bootstrap interval: seeds are drawn with replacement `resamples` times.
pub fn bootstrap(values: &[f64], statistic: Statistic, resamples: usize) -> Estimate {
    if values.is_empty() {
        return Estimate::NONE;
    }
    let values = sorted(values);
    let mut sample = Vec::with_capacity(values.len());
    resampled(statistic(&values), values.len(), resamples, |times| {
        // Counting how often each value is drawn gives the sample in order, without sorting it.
        sample.clear();
        for (&value, &times) in values.iter().zip(times) {
            sample.extend(std::iter::repeat_n(value, times as usize));
        }
        statistic(&sample)
    })
}

/// The mean of some values, as tables show it.
pub fn mean_of(values: &[f64]) -> Estimate {
    bootstrap(values, mean, TABLE_RESAMPLES)
}

/// Mean of `a - b` over pairs of the same seed. Extra values of the longer side are ignored.
pub fn paired_difference(a: &[f64], b: &[f64]) -> Estimate {
    mean_of(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>())
}

/// The [`ratio`] of one pair per seed.
pub fn ratio_of(pairs: &[(f64, f64)], resamples: usize) -> Estimate {
    resampled(ratio(pairs), pairs.len(), resamples, |times| {
        let weighted =
            pairs.iter().zip(times).map(|(pair, &times)| (pair.0 * f64::from(times), pair.1 * f64::from(times)));
        let (over, under) = weighted.fold((0.0, 0.0), |sums, pair| (sums.0 + pair.0, sums.1 + pair.1));
        over / under
    })
}

/// A value with the middle 95 percent of an outcome over resamples, told how often each of `count` seeds is drawn.
fn resampled(value: f64, count: usize, resamples: usize, mut outcome: impl FnMut(&[u32]) -> f64) -> Estimate {
    if count == 0 {
        return Estimate::NONE;
    }
    let mut outcomes = Vec::with_capacity(resamples);
    resample(count, resamples, |times| outcomes.push(outcome(times)));
    outcomes.sort_by(f64::total_cmp);
    Estimate { value, low: quantile(&outcomes, TAIL), high: quantile(&outcomes, 1.0 - TAIL) }
}

/// A rate with Wilson's interval. It takes every trial as independent; trials of one learner are not.
pub fn wilson(successes: u64, trials: u64) -> Estimate {
    if trials == 0 {
        return Estimate::NONE;
    }
    let n = trials as f64;
    let rate = successes as f64 / n;
    let scale = 1.0 + Z * Z / n;
    let centre = rate + Z * Z / (2.0 * n);
    let half = Z * (rate * (1.0 - rate) / n + Z * Z / (4.0 * n * n)).sqrt();
    Estimate { value: rate, low: ((centre - half) / scale).max(0.0), high: ((centre + half) / scale).min(1.0) }
}
