//! Performance profiles: how many learners exceed each score.

use super::bootstrap::{Draws, percentile};
use super::interval::Interval;
use super::location::{mean, sorted};

/// Share of runs with a score above each limit (strictly), averaged over strata.
pub fn performance_profile(strata: &[&[f64]], limits: &[f64]) -> Vec<f64> {
    let above = |limit: f64| {
        let share =
            |stratum: &&[f64]| stratum.iter().filter(|score| **score > limit).count() as f64 / stratum.len() as f64;
        mean(&strata.iter().map(share).collect::<Vec<_>>())
    };
    limits.iter().map(|&limit| above(limit)).collect()
}

/// Percentile bootstrap intervals of [`performance_profile`], one for each limit by itself.
pub fn profile_band(strata: &[&[f64]], limits: &[f64], resamples: usize) -> Vec<Interval> {
    if strata.is_empty() || strata.iter().any(|stratum| stratum.is_empty()) {
        return vec![Interval::NONE; limits.len()];
    }
    let strata: Vec<Vec<f64>> = strata.iter().map(|stratum| sorted(stratum)).collect();
    // Place of the first score above each limit.
    let first: Vec<Vec<usize>> = strata
        .iter()
        .map(|stratum| limits.iter().map(|limit| stratum.partition_point(|score| score <= limit)).collect())
        .collect();
    let mut outcomes = vec![Vec::with_capacity(resamples); limits.len()];
    let mut draws = Draws::new(strata.iter().map(Vec::len));
    let mut above = Vec::new();
    for _ in 0..resamples {
        let mut shares = vec![0.0; limits.len()];
        for (times, first) in draws.next().iter().zip(&first) {
            // Draws from each place on.
            above.clear();
            above.resize(times.len() + 1, 0_u32);
            for i in (0..times.len()).rev() {
                above[i] = above[i + 1] + times[i];
            }
            for (share, &first) in shares.iter_mut().zip(first) {
                *share += f64::from(above[first]) / times.len() as f64;
            }
        }
        for (outcomes, share) in outcomes.iter_mut().zip(shares) {
            outcomes.push(share / strata.len() as f64);
        }
    }
    outcomes.iter().map(|outcomes| percentile(&sorted(outcomes))).collect()
}
