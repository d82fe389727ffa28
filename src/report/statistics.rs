//! Means, intervals and rates over seeds. Values are one number per seed; all functions give NaN for no values.

use super::resample::resample;

/// Resamples behind every interval in a table.
pub const TABLE_RESAMPLES: usize = 10_000;
/// Resamples behind every band in a figure.
pub const BAND_RESAMPLES: usize = 2_000;
/// Intervals over fewer seeds than this are too narrow to trust (simulated coverage is below 92 percent).
pub const FEW_SEEDS: usize = 10;
/// Share of the distribution below and above a 95 percent interval.
const TAIL: f64 = 0.025;
/// 97.5 percent point of the normal distribution.
const Z: f64 = 1.959_963_984_540_054;

/// A 95 percent interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// A statistic of values sorted in ascending order.
pub type Statistic = fn(&[f64]) -> f64;

/// Arithmetic mean.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Interquartile mean as rliable defines it: cut `floor(n / 4)` values from each end, then average. Values must be
/// sorted in ascending order.
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

/// Percentile bootstrap interval: seeds are drawn with replacement `resamples` times. The same values
/// always give the same interval.
pub fn bootstrap(values: &[f64], statistic: Statistic, resamples: usize) -> Interval {
    let values = sorted(values);
    let mut sample = Vec::with_capacity(values.len());
    resampled(values.len(), resamples, |times| {
        // Counting how often each value is drawn gives the sample in order, without sorting it.
        sample.clear();
        for (&value, &times) in values.iter().zip(times) {
            sample.extend(std::iter::repeat_n(value, times as usize));
        }
        statistic(&sample)
    })
}

/// Sum of the first numbers over the sum of the second ones.
pub fn ratio(pairs: &[(f64, f64)]) -> f64 {
    let sum = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>();
    sum(|pair| pair.0) / sum(|pair| pair.1)
}

/// Percentile bootstrap interval of [`ratio`], one pair per seed.
pub fn bootstrap_ratio(pairs: &[(f64, f64)], resamples: usize) -> Interval {
    resampled(pairs.len(), resamples, |times| {
        let weighted =
            pairs.iter().zip(times).map(|(pair, &times)| (pair.0 * f64::from(times), pair.1 * f64::from(times)));
        let (over, under) = weighted.fold((0.0, 0.0), |sums, pair| (sums.0 + pair.0, sums.1 + pair.1));
        over / under
    })
}

/// Interval of an outcome over resamples, told how often each of `count` seeds is drawn.
fn resampled(count: usize, resamples: usize, mut outcome: impl FnMut(&[u32]) -> f64) -> Interval {
    if count == 0 || resamples == 0 {
        return Interval { low: f64::NAN, high: f64::NAN };
    }
    let mut outcomes = Vec::with_capacity(resamples);
    resample(count, resamples, |times| outcomes.push(outcome(times)));
    outcomes.sort_by(f64::total_cmp);
    Interval { low: quantile(&outcomes, TAIL), high: quantile(&outcomes, 1.0 - TAIL) }
}

/// Mean of `a - b` over pairs of the same seed, with its bootstrap interval. Extra values of the longer side are ignored.
pub fn paired_difference(a: &[f64], b: &[f64], resamples: usize) -> (f64, Interval) {
    let differences: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    (mean(&differences), bootstrap(&differences, mean, resamples))
}

/// Wilson interval of a rate. It takes every trial as independent; trials of one learner are not.
pub fn wilson(successes: u64, trials: u64) -> Interval {
    if trials == 0 {
        return Interval { low: f64::NAN, high: f64::NAN };
    }
    let n = trials as f64;
    let rate = successes as f64 / n;
    let scale = 1.0 + Z * Z / n;
    let centre = rate + Z * Z / (2.0 * n);
    let half = Z * (rate * (1.0 - rate) / n + Z * Z / (4.0 * n * n)).sqrt();
    Interval { low: ((centre - half) / scale).max(0.0), high: ((centre + half) / scale).min(1.0) }
}

/// Share of values below a limit.
pub fn share_below(values: &[f64], limit: f64) -> f64 {
    values.iter().filter(|&&value| value < limit).count() as f64 / values.len() as f64
}
