//! Bootstrap intervals: percentile and BCa, seeds resampled within each stratum.

use super::TAIL;
use super::interval::Interval;
use super::location::{Statistic, quantile, sorted};
use crate::report::resample::{Resampler, resample};
use statrs::distribution::{ContinuousCDF, Normal};

/// Percentile bootstrap interval of a statistic of one stratum: seeds are drawn with replacement `resamples` times.
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

/// Percentile bootstrap interval of a statistic of all strata pooled: seeds are drawn within each stratum.
pub fn bootstrap_stratified(strata: &[&[f64]], statistic: Statistic, resamples: usize) -> Interval {
    percentile(&sorted(&outcomes(strata, statistic, resamples)))
}

/// BCa bootstrap interval of a statistic of all strata pooled: the percentile interval, corrected for bias and for a
/// spread that changes with the value.
pub fn bootstrap_bca(strata: &[&[f64]], statistic: Statistic, resamples: usize) -> Interval {
    let pooled = |left_out: Option<(usize, usize)>| {
        let kept =
            strata.iter().enumerate().flat_map(|(s, stratum)| stratum.iter().enumerate().map(move |(i, &v)| (s, i, v)));
        let kept = kept.filter(|&(s, i, _)| Some((s, i)) != left_out).map(|(_, _, value)| value);
        statistic(&sorted(&kept.collect::<Vec<_>>()))
    };
    let jackknife: Vec<Vec<f64>> = strata
        .iter()
        .enumerate()
        .map(|(s, stratum)| (0..stratum.len()).map(|i| pooled(Some((s, i)))).collect())
        .collect();
    bca(&sorted(&outcomes(strata, statistic, resamples)), pooled(None), &jackknife)
}

/// BCa interval from its parts: sorted outcomes of the resamples, the estimate itself, and for each stratum the
/// estimates that leave out one value each (Efron and Tibshirani 1993, section 14.3; for several strata as SciPy).
///
/// Outcomes equal to the estimate count half as below it. Where all values are equal, the interval is that value.
pub fn bca(outcomes: &[f64], estimate: f64, jackknife: &[Vec<f64>]) -> Interval {
    let Ok(normal) = Normal::new(0.0, 1.0) else { return Interval::NONE };
    if outcomes.is_empty() {
        return Interval::NONE;
    }
    let below = outcomes.partition_point(|&outcome| outcome < estimate);
    let up_to = outcomes.partition_point(|&outcome| outcome <= estimate);
    let bias = normal.inverse_cdf((below + up_to) as f64 / (2 * outcomes.len()) as f64);
    let (mut cubes, mut squares) = (0.0, 0.0);
    for left_out in jackknife {
        let count = left_out.len() as f64;
        let centre = left_out.iter().sum::<f64>() / count;
        for value in left_out {
            let influence = (count - 1.0) * (centre - value) / count;
            cubes += influence.powi(3);
            squares += influence * influence;
        }
    }
    // Without influence of any value there is no spread to correct for.
    let acceleration = if squares > 0.0 { cubes / (6.0 * squares.powf(1.5)) } else { 0.0 };
    let end = |tail: f64| {
        let shifted = bias + normal.inverse_cdf(tail);
        quantile(outcomes, normal.cdf(bias + shifted / (1.0 - acceleration * shifted)))
    };
    Interval { low: end(TAIL), high: end(1.0 - TAIL) }
}

/// Percentile bootstrap interval of [`ratio`](super::ratio), one pair per seed.
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
    if count == 0 {
        return Interval::NONE;
    }
    let mut outcomes = Vec::with_capacity(resamples);
    resample(count, resamples, |times| outcomes.push(outcome(times)));
    outcomes.sort_by(f64::total_cmp);
    percentile(&outcomes)
}

/// The middle 95 percent of sorted outcomes.
pub(super) fn percentile(outcomes: &[f64]) -> Interval {
    Interval { low: quantile(outcomes, TAIL), high: quantile(outcomes, 1.0 - TAIL) }
}

/// A statistic of `resamples` samples, each drawn within every stratum.
fn outcomes(strata: &[&[f64]], statistic: Statistic, resamples: usize) -> Vec<f64> {
    if strata.iter().all(|stratum| stratum.is_empty()) {
        return Vec::new();
    }
    let mut values: Vec<(f64, usize, usize)> = Vec::new();
    for (s, stratum) in strata.iter().enumerate() {
        values.extend(sorted(stratum).into_iter().enumerate().map(|(i, value)| (value, s, i)));
    }
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut sample = Vec::with_capacity(values.len());
    let mut draws = Draws::new(strata.iter().map(|stratum| stratum.len()));
    let outcome = |_| {
        let times = draws.next();
        sample.clear();
        for &(value, s, i) in &values {
            sample.extend(std::iter::repeat_n(value, times[s][i] as usize));
        }
        statistic(&sample)
    };
    (0..resamples).map(outcome).collect()
}

/// Draws samples of several strata, each from a stream of its own.
pub(super) struct Draws {
    streams: Vec<Resampler>,
    times: Vec<Vec<u32>>,
}

impl Draws {
    pub(super) fn new(counts: impl Iterator<Item = usize>) -> Self {
        let times: Vec<Vec<u32>> = counts.map(|count| vec![0; count]).collect();
        Self { streams: (0..times.len()).map(|stratum| Resampler::of_stratum(stratum as u32)).collect(), times }
    }

    /// How often each value of each stratum is in the next sample.
    pub(super) fn next(&mut self) -> &[Vec<u32>] {
        for (stream, times) in self.streams.iter_mut().zip(&mut self.times) {
            times.fill(0);
            for _ in 0..times.len() {
                let drawn = stream.index(times.len());
                times[drawn] += 1;
            }
        }
        &self.times
    }
}
