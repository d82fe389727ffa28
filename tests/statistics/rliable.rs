//! The numbers that rliable 1.2.0 and NumPy give for the scores in `beta.txt`.

use crate::close;
use skilltree::report::figure::curves::Curve;
use skilltree::report::statistics::{
    bootstrap, interquartile_mean, mean, mean_of, quantile, ratio, share_below, sorted, wilson,
};
use skilltree::report::step_plot::{learner_profile, seed_profile};

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

#[test]
fn point_estimates_are_rliables() {
    let a = arm("A");
    close(interquartile_mean(&pooled(&a)), 0.5539610020880037, 1e-12);
    close(mean(&pooled(&a)), 0.5341286037678591, 1e-12);
    close(interquartile_mean(&sorted(&a[0])), 0.4657092961871217, 1e-12);
}

/// The share above a limit.
fn above(curve: &Curve, limit: f64) -> skilltree::report::statistics::Estimate {
    curve.points.iter().find(|point| (point.x - limit).abs() < 1e-9).unwrap().y
}

#[test]
fn profiles_are_rliables() {
    let a = arm("A");
    let runs: Vec<Vec<f64>> = (0..7).map(|run| a.iter().map(|task| task[run]).collect()).collect();
    let (tasks, all) = (learner_profile(String::new(), &runs), seed_profile(String::new(), &pooled(&a)));
    for (limit, count) in [(0.2, 18_u32), (0.4, 17), (0.5, 13), (0.6, 10), (0.8, 2)] {
        close(above(&tasks, limit).value, f64::from(count) / 21.0, 1e-12);
        assert_eq!(above(&all, limit), wilson(u64::from(count), 21));
    }
    // A score that equals the limit is not above it.
    let ties = seed_profile(String::new(), &[0.5, 1.0]);
    assert_eq!([0.48, 0.5, 0.98].map(|limit| above(&ties, limit).value), [1.0, 0.5, 0.5]);
}

/// Of 7 scores, 3 are above one half: resamples are binomial, with quantiles 1/7 and 6/7.
#[test]
fn bands_of_profiles_are_binomial() {
    let alone: Vec<Vec<f64>> = arm("A")[0].iter().map(|&score| vec![score]).collect();
    let half = above(&learner_profile(String::new(), &alone), 0.5);
    close(half.low, 1.0 / 7.0, 1e-12);
    close(half.high, 6.0 / 7.0, 1e-12);
    // Two learners with each seed, of which one is certain: the share moves half as far.
    let paired: Vec<Vec<f64>> = alone.iter().map(|scores| vec![scores[0], 0.9]).collect();
    let half = above(&learner_profile(String::new(), &paired), 0.5);
    close(half.low, 4.0 / 7.0, 1e-12);
    close(half.high, 13.0 / 14.0, 1e-12);
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
}

#[test]
fn quantiles_and_shares_are_numpys() {
    close(quantile(&[1.0, 2.0, 4.0, 8.0], 0.4), 2.4, 1e-12);
    close(share_below(&[0.4, 0.5, 0.6, 0.1], 0.5), 0.5, 0.0);
    close(ratio(&[(1.0, 2.0), (3.0, 2.0)]), 1.0, 0.0);
}

#[test]
fn no_values_give_no_numbers() {
    let none = mean_of(&[]);
    assert!(none.value.is_nan() && none.low.is_nan() && none.high.is_nan());
    assert!(mean(&[]).is_nan() && quantile(&[], 0.5).is_nan());
}
