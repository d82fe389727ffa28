//! Choosing the best of several candidates that were tried on the same seeds, and how sure the choice is.

use super::estimate::{Estimate, TABLE_RESAMPLES, mean, paired_difference};
use crate::report::bootstrap_rng::resample;
use rayon::prelude::*;

/// Sums of the same values in another order may differ by this much.
const ROUNDING: f64 = 1e-9;

/// What the seeds say about which candidate is best.
#[derive(Debug, Clone, PartialEq)]
pub struct Selection {
    /// The candidate with the highest mean; the first one of equals.
    pub best: usize,
    pub means: Vec<f64>,
    /// For each candidate the mean of best minus candidate over pairs of the same seed.
    pub behind: Vec<Estimate>,
    /// Share of resamples in which each candidate has the highest mean; equals share theirs.
    pub chosen: Vec<f64>,
    /// Mean of the candidate that a resample chooses, over the seeds that are not in the resample, averaged over
    /// resamples: what a choice brings on seeds that had no part in it. The best candidate's own mean promises too much,
    /// as it was chosen for being high. NaN for a single seed.
    pub out_of_bag: f64,
}

impl Selection {
    /// Whether the seeds cannot tell a candidate from the best: the interval of the difference holds 0.
    pub fn indistinguishable(&self, candidate: usize) -> bool {
        candidate == self.best || self.behind[candidate].low <= ROUNDING
    }

    /// Candidates that the seeds cannot tell from the best, itself among them.
    pub fn undecided(&self) -> usize {
        (0..self.means.len()).filter(|&candidate| self.indistinguishable(candidate)).count()
    }
}

/// Compares candidates by [`TABLE_RESAMPLES`] resamples of the seeds, each of which all candidates share. A candidate
/// holds one value per seed, seeds in the same order for all. None without candidates or seeds, or if a candidate lacks
/// seeds.
pub fn select(candidates: &[&[f64]]) -> Option<Selection> {
    let seeds = candidates.first()?.len();
    if seeds == 0 || candidates.iter().any(|values| values.len() != seeds) {
        return None;
    }
    let means: Vec<f64> = candidates.iter().map(|values| mean(values)).collect();
    let best = first_highest(&means);
    let (chosen, out_of_bag) = choices(candidates, seeds);
    let behind = candidates.par_iter().map(|values| paired_difference(candidates[best], values)).collect();
    Some(Selection { best, means, behind, chosen, out_of_bag })
}

fn first_highest(means: &[f64]) -> usize {
    (0..means.len()).reduce(|best, i| if means[i] > means[best] { i } else { best }).unwrap_or(0)
}

fn weighted_sum(values: &[f64], times: &[u32]) -> f64 {
    values.iter().zip(times).map(|(value, &times)| value * f64::from(times)).sum()
}

/// How often each candidate is chosen, and the mean of the chosen ones outside the resamples.
fn choices(candidates: &[&[f64]], seeds: usize) -> (Vec<f64>, f64) {
    let mut chosen = vec![0.0; candidates.len()];
    let (mut outside, mut counted) = (0.0, 0_usize);
    let mut sums = vec![0.0; candidates.len()];
    resample(seeds, TABLE_RESAMPLES, |times| {
        for (sum, values) in sums.iter_mut().zip(candidates) {
            *sum = weighted_sum(values, times);
        }
        let highest = sums.iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b));
        let tied: Vec<usize> = (0..sums.len()).filter(|&i| highest - sums[i] <= ROUNDING).collect();
        let left: Vec<usize> = (0..seeds).filter(|&seed| times[seed] == 0).collect();
        for &i in &tied {
            chosen[i] += 1.0 / tied.len() as f64;
            outside +=
                left.iter().map(|&seed| candidates[i][seed]).sum::<f64>() / (left.len().max(1) * tied.len()) as f64;
        }
        counted += usize::from(!left.is_empty());
    });
    let chosen = chosen.into_iter().map(|times| times / TABLE_RESAMPLES as f64).collect();
    (chosen, if counted == 0 { f64::NAN } else { outside / counted as f64 })
}
