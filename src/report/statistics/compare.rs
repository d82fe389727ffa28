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
    probability(&tasks.iter().map(Task::new).collect::<Vec<_>>(), &once)
}

/// Percentile bootstrap interval of [`probability_of_improvement`]: seeds are drawn within each arm and task.
pub fn bootstrap_probability(tasks: &[(&[f64], &[f64])], resamples: usize) -> Interval {
    if tasks.iter().any(|(a, b)| a.is_empty() || b.is_empty()) {
        return Interval::NONE;
    }
    let mut draws = Draws::new(tasks.iter().flat_map(|(a, b)| [a.len(), b.len()]));
    let tasks: Vec<Task> = tasks.iter().map(Task::new).collect();
    let outcomes: Vec<f64> = (0..resamples).map(|_| probability(&tasks, draws.next())).collect();
    percentile(&sorted(&outcomes))
}

/// Where the scores of the first arm stand among the sorted ones of the second.
struct Task {
    /// For each score: how many are lower, and how many are not higher.
    places: Vec<(usize, usize)>,
    /// Scores of the second arm.
    others: usize,
}

impl Task {
    fn new((a, b): &(&[f64], &[f64])) -> Self {
        let b = sorted(b);
        let place = |a: &f64| (b.partition_point(|b| b < a), b.partition_point(|b| b <= a));
        Self { places: a.iter().map(place).collect(), others: b.len() }
    }

    /// The probability where each score counts as often as `times` says: the first arm's, then the second's, sorted.
    fn probability(&self, times: &[Vec<u32>]) -> f64 {
        let mut drawn = 0;
        let mut up_to = vec![0];
        up_to.extend(times[1].iter().map(|times| {
            drawn += times;
            drawn
        }));
        let wins = |(&(lower, not_higher), &times): (&(usize, usize), &u32)| {
            f64::from(times) * 0.5 * f64::from(up_to[lower] + up_to[not_higher])
        };
        let wins: f64 = self.places.iter().zip(&times[0]).map(wins).sum();
        wins / (self.places.len() * self.others) as f64
    }
}

fn probability(tasks: &[Task], times: &[Vec<u32>]) -> f64 {
    let each: Vec<f64> = tasks.iter().zip(times.chunks(2)).map(|(task, times)| task.probability(times)).collect();
    mean(&each)
}
