//! The numbers that rliable 1.2.0 gives for the scores in `beta.txt`.

use crate::close;
use skilltree::report::statistics::{
    bootstrap, bootstrap_bca, bootstrap_probability, bootstrap_stratified, interquartile_mean, mean, optimality_gap,
    performance_profile, probability_of_improvement, profile_band, quantile, ratio, share_below, sorted,
};

const BETA: &str = include_str!("beta.txt");

/// Scores of an arm: for each of three tasks, those of seven runs.
pub(crate) fn arm(name: &str) -> [Vec<f64>; 3] {
    let mut tasks = [const { Vec::new() }; 3];
    for line in BETA.lines().filter_map(|line| line.strip_prefix(name)?.strip_prefix(' ')) {
        let scores: Vec<f64> = line.split(' ').map(|score| score.parse().unwrap()).collect();
        assert_eq!(scores.len(), 3);
        tasks.iter_mut().zip(scores).for_each(|(task, score)| task.push(score));
    }
    assert!(tasks.iter().all(|task| task.len() == 7));
    tasks
}

fn pooled(tasks: &[Vec<f64>; 3]) -> Vec<f64> {
    sorted(&tasks.concat())
}

fn strata(tasks: &[Vec<f64>; 3]) -> [&[f64]; 3] {
    [&tasks[0], &tasks[1], &tasks[2]]
}

#[test]
fn point_estimates_are_rliables() {
    let (a, b) = (arm("A"), arm("B"));
    close(interquartile_mean(&pooled(&a)), 0.5539610020880037, 1e-12);
    close(mean(&pooled(&a)), 0.5341286037678591, 1e-12);
    close(interquartile_mean(&sorted(&a[0])), 0.4657092961871217, 1e-12);
    let tasks: Vec<(&[f64], &[f64])> = a.iter().zip(&b).map(|(a, b)| (a.as_slice(), b.as_slice())).collect();
    close(probability_of_improvement(&tasks), 0.5918367346938775, 1e-12);
    let turned: Vec<_> = tasks.iter().map(|(a, b)| (*b, *a)).collect();
    close(probability_of_improvement(&turned), 1.0 - 0.5918367346938775, 1e-12);
    close(optimality_gap(&pooled(&a), 1.0), 0.4658713962321409, 1e-12);
    // A target that some scores exceed.
    close(optimality_gap(&pooled(&a), 0.7), 0.19606130175888747, 1e-12);
    let profile = performance_profile(&strata(&a), &[0.2, 0.4, 0.5, 0.6, 0.8]);
    for (share, above) in profile.iter().zip([18.0, 17.0, 13.0, 10.0, 2.0]) {
        close(*share, above / 21.0, 1e-12);
    }
    // A score that equals the limit is not above it, and a tie is half a win.
    assert_eq!(performance_profile(&[&[0.5, 1.0]], &[0.5, 1.0]), [0.5, 0.0]);
    assert_eq!(probability_of_improvement(&[(&[0.5], &[0.5, 0.4])]), 0.75);
}

/// NumPy, 400,000 resamples within each task; for the probability 60,000. The widths are three Monte-Carlo errors of
/// ours at the number of resamples used here, with at least as much for theirs.
#[test]
fn stratified_intervals_are_numpys() {
    let (a, b) = (arm("A"), arm("B"));
    let interval = bootstrap_stratified(&strata(&a), mean, 50_000);
    close(interval.low, 0.43431136, 0.003);
    close(interval.high, 0.63179117, 0.003);
    let interval = bootstrap_stratified(&strata(&a), interquartile_mean, 50_000);
    close(interval.low, 0.43862836, 0.004);
    close(interval.high, 0.65649943, 0.003);
    let tasks: Vec<(&[f64], &[f64])> = a.iter().zip(&b).map(|(a, b)| (a.as_slice(), b.as_slice())).collect();
    let interval = bootstrap_probability(&tasks, 50_000);
    close(interval.low, 0.42857143, 0.007);
    close(interval.high, 0.75510204, 0.007);
    // scipy.stats.bootstrap((A[:,0], A[:,1], A[:,2]), statistic of all pooled, n_resamples=60000, method="BCa")
    let interval = bootstrap_bca(&strata(&a), mean, 50_000);
    close(interval.low, 0.43117586, 0.003);
    close(interval.high, 0.62843917, 0.003);
    let interval = bootstrap_bca(&strata(&a), interquartile_mean, 50_000);
    close(interval.low, 0.44216632, 0.004);
    close(interval.high, 0.65946391, 0.004);
}

/// NumPy on the first task. The mean: a million resamples. The interquartile mean of 7 values takes few values, so the
/// ends are those whose exact distribution function (all 1,716 resamples, weighted) is within three Monte-Carlo errors.
#[test]
fn percentile_intervals_of_one_task_are_numpys() {
    let column = &arm("A")[0];
    let interval = bootstrap(column, mean, 50_000);
    close(interval.low, 0.24587364, 0.003);
    close(interval.high, 0.63973337, 0.003);
    let interval = bootstrap(column, interquartile_mean, 50_000);
    assert!((0.2006..=0.2142).contains(&interval.low), "{interval:?}");
    assert!((0.6741..=0.6792).contains(&interval.high), "{interval:?}");
    assert_eq!(bootstrap(column, mean, 1000), bootstrap(column, mean, 1000));
    assert_eq!(bootstrap_stratified(&[column], mean, 1000), bootstrap(column, mean, 1000));
}

/// Of 7 scores, 3 are above one half: resamples are binomial, with quantiles 1/7 and 6/7.
#[test]
fn bands_of_profiles_are_binomial() {
    let column = &arm("A")[0];
    let band = profile_band(&[column], &[0.0, 0.5, 1.0], 20_000);
    assert_eq!((band[0].low, band[0].high, band[2].low, band[2].high), (1.0, 1.0, 0.0, 0.0));
    close(band[1].low, 1.0 / 7.0, 1e-12);
    close(band[1].high, 6.0 / 7.0, 1e-12);
    // Two tasks of which one is certain: the share moves half as far.
    let band = profile_band(&[column, &[0.9, 0.8]], &[0.5], 20_000);
    close(band[0].low, 4.0 / 7.0, 1e-12);
    close(band[0].high, 13.0 / 14.0, 1e-12);
}

#[test]
fn quantiles_and_shares_are_numpys() {
    close(quantile(&[1.0, 2.0, 4.0, 8.0], 0.4), 2.4, 1e-12);
    close(share_below(&[0.4, 0.5, 0.6, 0.1], 0.5), 0.5, 0.0);
    close(ratio(&[(1.0, 2.0), (3.0, 2.0)]), 1.0, 0.0);
}

#[test]
fn no_values_give_no_numbers() {
    let nothing: &[f64] = &[];
    for interval in [
        bootstrap(nothing, mean, 10),
        bootstrap_stratified(&[nothing], mean, 10),
        bootstrap_bca(&[nothing], mean, 10),
        bootstrap_probability(&[(nothing, &[1.0])], 10),
        profile_band(&[nothing], &[0.5], 10)[0],
    ] {
        assert!(interval.low.is_nan() && interval.high.is_nan(), "{interval:?}");
    }
    assert!(mean(nothing).is_nan() && optimality_gap(nothing, 1.0).is_nan());
}
