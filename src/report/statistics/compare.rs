//! Comparisons of two arms.

use super::bootstrap::{Draws, bootstrap, percentile};
use super::interval::Interval;
use super::location::{mean, sorted};

/// Mean of `a - b` over pairs of the same seed, with its percentile bootstrap interval. Extra values of the longer side
/// are ignored.
pub fn paired_difference(a: &[f64], b: &[f64], resamples: usize) -> (f64, Interval) {
    let differences: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    (mean(&differences), bootstrap(&differences, mean, resamples))
}

/// Probability that a run of the first arm scores higher than one of the second, ties one half: Mann and Whitney's
/// `U / (n m)` per task, averaged over tasks. A task holds the scores of both arms.
pub fn probability_of_improvement(tasks: &[(&[f64], &[f64])]) -> f64 {
    let once: Vec<Vec<u32>> = tasks.iter().flat_map(|(a, b)| [vec![1; a.len()], vec![1; b.len()]]).collect();
    weighted_probability(tasks, &once)
}

/// Percentile bootstrap interval of [`probability_of_improvement`]: seeds are drawn within each arm and task.
pub fn bootstrap_probability(tasks: &[(&[f64], &[f64])], resamples: usize) -> Interval {
    if tasks.iter().any(|(a, b)| a.is_empty() || b.is_empty()) {
        return Interval::NONE;
    }
    let mut draws = Draws::new(tasks.iter().flat_map(|(a, b)| [a.len(), b.len()]));
    let outcomes: Vec<f64> = (0..resamples).map(|_| weighted_probability(tasks, draws.next())).collect();
    percentile(&sorted(&outcomes))
}

/// The probability where each score counts as often as `times` says: both arms of the first task, then of the next.
fn weighted_probability(tasks: &[(&[f64], &[f64])], times: &[Vec<u32>]) -> f64 {
    let task = |((a, b), times): (&(&[f64], &[f64]), &[Vec<u32>])| {
        let mut wins = 0.0;
        for (a, &a_times) in a.iter().zip(&times[0]).filter(|(_, times)| **times > 0) {
            for (b, &b_times) in b.iter().zip(&times[1]) {
                let win = if a > b { 1.0 } else if a == b { 0.5 } else { 0.0 };
                wins += f64::from(a_times) * f64::from(b_times) * win;
            }
        }
        wins / (a.len() * b.len()) as f64
    };
    mean(&tasks.iter().zip(times.chunks(2)).map(task).collect::<Vec<_>>())
}
