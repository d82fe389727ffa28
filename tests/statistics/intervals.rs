//! Intervals against statsmodels, against all resamples there are, and of values that are known beforehand.

use crate::close;
use crate::rliable::arm;
use skilltree::report::bootstrap_rng::BootstrapRng;
use skilltree::report::statistics::{
    Estimate, Statistic, bootstrap, interquartile_mean, mean, mean_of, paired_difference, quantile, ratio, ratio_of,
    sorted, wilson,
};

/// statsmodels.stats.proportion.proportion_confint(successes, trials, method="wilson").
#[test]
fn wilsons_interval_is_statsmodels() {
    for (successes, trials, low, high) in [
        (0, 10, 0.0, 0.2775327998628892),
        (81, 263, 0.2552885198782742, 0.36620957698280004),
        (15, 148, 0.06238639953073628, 0.16048724172330803),
    ] {
        let estimate = wilson(successes, trials);
        close(estimate.value, successes as f64 / trials as f64, 1e-15);
        close(estimate.low, low, 1e-12);
        close(estimate.high, high, 1e-12);
    }
    assert!(wilson(0, 0).low.is_nan());
}

/// An outcome of every sample of `count` seeds that can be drawn with replacement, sorted.
fn exhaustive(count: usize, outcome: impl Fn(&[usize]) -> f64) -> Vec<f64> {
    let sample = |mut number: usize| {
        let drawn = (0..count).map(|_| {
            let seed = number % count;
            number /= count;
            seed
        });
        outcome(&drawn.collect::<Vec<_>>())
    };
    sorted(&(0..count.pow(count as u32)).map(sample).collect::<Vec<_>>())
}

/// Share of sorted outcomes below a value.
fn rank(outcomes: &[f64], value: f64) -> f64 {
    outcomes.partition_point(|outcome| *outcome < value) as f64 / outcomes.len() as f64
}

/// Both ends have the right share of all resamples below them, to three errors of 50,000 resamples.
fn is_percentile(estimate: Estimate, outcomes: &[f64]) {
    for (end, tail) in [(estimate.low, 0.025), (estimate.high, 0.975)] {
        let (below, up_to) = (rank(outcomes, end - 1e-9), rank(outcomes, end + 1e-9));
        assert!(below <= tail + 0.0021 && up_to >= tail - 0.0021, "{estimate:?}: {below} to {up_to} below {end}");
    }
}

#[test]
fn intervals_are_percentiles_of_all_resamples() {
    let column = &arm("A")[0][..6];
    for statistic in [mean as Statistic, interquartile_mean] {
        let outcomes = exhaustive(6, |seeds| statistic(&sorted(&seeds.iter().map(|&i| column[i]).collect::<Vec<_>>())));
        let estimate = bootstrap(column, statistic, 50_000);
        close(estimate.value, statistic(&sorted(column)), 1e-12);
        is_percentile(estimate, &outcomes);
    }
    let pairs: Vec<(f64, f64)> = column.iter().zip(&arm("B")[1]).map(|(&a, &b)| (a, b)).collect();
    let outcomes = exhaustive(6, |seeds| ratio(&seeds.iter().map(|&i| pairs[i]).collect::<Vec<_>>()));
    let estimate = ratio_of(&pairs, 50_000);
    close(estimate.value, ratio(&pairs), 1e-12);
    is_percentile(estimate, &outcomes);
    // The check itself: an interval of half the width is none of 95 percent.
    let narrow = Estimate { low: quantile(&outcomes, 0.2), high: quantile(&outcomes, 0.8), ..estimate };
    assert!(std::panic::catch_unwind(|| is_percentile(narrow, &outcomes)).is_err());
}

#[test]
fn values_without_spread_have_an_interval_without_width() {
    let estimate = mean_of(&[0.7; 6]);
    close(estimate.low, 0.7, 1e-12);
    close(estimate.high, 0.7, 1e-12);
}

#[test]
fn a_paired_interval_knows_that_seeds_are_shared() {
    let a: Vec<f64> = (0..20).map(|i| f64::from(i) / 20.0).collect();
    let b: Vec<f64> = a.iter().enumerate().map(|(i, a)| a - 0.1 + 0.02 * (i % 3) as f64).collect();
    let lead = paired_difference(&a, &b);
    // Seven of each remainder, but six of the last one.
    close(lead.value, (20.0 * 0.1 - 0.02 * (7.0 + 2.0 * 6.0)) / 20.0, 1e-12);
    assert!(lead.high - lead.low < 0.02 && lead.low > 0.07, "{lead:?}");
    assert_eq!(-lead, Estimate { value: -lead.value, low: -lead.high, high: -lead.low });
    // Each arm by itself would not tell.
    assert!(mean_of(&a).low < mean(&b));
    let none = paired_difference(&a, &a);
    assert_eq!((none.value, none.low, none.high), (0.0, 0.0, 0.0));
}

#[test]
fn resampled_indices_are_uniform() {
    let mut random = BootstrapRng::new(7);
    let mut counts = [0_u32; 7];
    for _ in 0..70_000 {
        counts[random.index(7)] += 1;
    }
    let squares: f64 = counts.iter().map(|&count| (f64::from(count) - 10_000.0).powi(2) / 10_000.0).sum();
    assert!(squares < 22.5, "chi-squared {squares} with 6 degrees of freedom: {counts:?}");
    assert_eq!(random.index(0), 0);
    // Three quarters of all words: a product without rejection would have some results twice as often as others.
    let count = 3 << 30;
    let low = (0..30_000).filter(|_| random.index(count) % 3 == 0).count();
    assert!((9_750..=10_250).contains(&low), "{low}");
}
