//! Intervals from formulas against SciPy, and BCa against SciPy on all resamples there are.

use crate::close;
use crate::golden::arm;
use skilltree::report::resample::Resampler;
use skilltree::report::statistics::{
    Interval, Statistic, bca, bootstrap, bootstrap_bca, interquartile_mean, mean, paired_difference, sorted, student_t,
    wilson,
};

fn equal(interval: Interval, low: f64, high: f64, tolerance: f64) {
    close(interval.low, low, tolerance);
    close(interval.high, high, tolerance);
}

/// scipy.stats.ttest_1samp(values, 0).confidence_interval(0.95), and scipy.stats.t.ppf(0.975, n - 1).
#[test]
fn students_interval_is_scipys() {
    equal(student_t(&arm("A")[0]), 0.18348685443934243, 0.7164467470069726, 1e-9);
    equal(student_t(&arm("B")[2]), 0.31323063637767323, 0.7770382788156859, 1e-9);
    for (count, quantile) in [
        (2, 12.706204736174694),
        (3, 4.302652729749462),
        (5, 2.7764451051977934),
        (7, 2.4469118511449786),
        (10, 2.262157162798205),
        (30, 2.045229642132703),
        (256, 1.9693105698498752),
    ] {
        // Values whose mean is 0 and whose standard error is 1.
        let size = f64::sqrt(f64::from(count - 1));
        let spread = if count % 2 == 0 { size } else { f64::sqrt(f64::from(count)) };
        let mut values: Vec<f64> = (0..count).map(|i| if i % 2 == 0 { spread } else { -spread }).collect();
        if count % 2 == 1 {
            values[0] = 0.0;
        }
        let error = (values.iter().map(|v| v * v).sum::<f64>() / f64::from(count - 1) / f64::from(count)).sqrt();
        equal(student_t(&values), -quantile * error, quantile * error, 1e-8 * quantile);
    }
    assert!(student_t(&[1.0]).low.is_nan() && student_t(&[]).high.is_nan());
}

/// statsmodels.stats.proportion.proportion_confint(successes, trials, method="wilson").
#[test]
fn wilsons_interval_is_statsmodels() {
    equal(wilson(0, 10), 0.0, 0.2775327998628892, 1e-12);
    equal(wilson(81, 263), 0.2552885198782742, 0.36620957698280004, 1e-12);
    equal(wilson(15, 148), 0.06238639953073628, 0.16048724172330803, 1e-12);
    assert!(wilson(0, 0).low.is_nan());
}

/// A statistic of every sample that can be drawn with replacement, sorted.
fn exhaustive(values: &[f64], statistic: Statistic) -> Vec<f64> {
    let count = values.len();
    let sample = |number: usize| {
        let mut rest = number;
        let drawn = (0..count).map(|_| {
            let value = values[rest % count];
            rest /= count;
            value
        });
        statistic(&sorted(&drawn.collect::<Vec<_>>()))
    };
    sorted(&(0..count.pow(count as u32)).map(sample).collect::<Vec<_>>())
}

fn jackknife(values: &[f64], statistic: Statistic) -> Vec<f64> {
    let without = |left_out: usize| {
        let mut kept = values.to_vec();
        kept.remove(left_out);
        statistic(&sorted(&kept))
    };
    (0..values.len()).map(without).collect()
}

/// scipy.stats.bootstrap(..., n_resamples=0, bootstrap_result=BootstrapResult(all resamples), method="BCa"), with
/// every resample sorted: otherwise rounding decides which of them equal the estimate.
#[test]
fn bca_is_scipys() {
    let exact = |values: &[f64], statistic: Statistic| {
        bca(&exhaustive(values, statistic), statistic(&sorted(values)), &[jackknife(values, statistic)])
    };
    let column = &arm("A")[0][..5];
    equal(exact(column, mean), 0.2042617865801079, 0.6969658045041589, 1e-9);
    equal(exact(column, interquartile_mean), 0.17753508190138145, 0.7635401895621708, 1e-9);
    let skewed = [0.02, 0.05, 0.05, 0.1, 0.9, 1.0];
    equal(exact(&skewed, mean), 0.053333333333333344, 0.7916666666666666, 1e-9);
    equal(exact(&skewed, interquartile_mean), 0.0425, 0.9, 1e-9);
}

#[test]
fn values_without_spread_have_an_interval_without_width() {
    for interval in [bootstrap(&[0.7; 6], mean, 100), bootstrap_bca(&[&[0.7; 6]], mean, 100), student_t(&[0.75; 6])] {
        close(interval.low, interval.high, 1e-12);
        close(interval.low, 0.72, 0.031);
    }
}

#[test]
fn a_paired_interval_knows_that_seeds_are_shared() {
    let a: Vec<f64> = (0..20).map(|i| f64::from(i) / 20.0).collect();
    let b: Vec<f64> = a.iter().enumerate().map(|(i, a)| a - 0.1 + 0.02 * (i % 3) as f64).collect();
    let (difference, interval) = paired_difference(&a, &b, 2_000);
    // Seven of each remainder, but six of the last one.
    close(difference, (20.0 * 0.1 - 0.02 * (7.0 + 2.0 * 6.0)) / 20.0, 1e-12);
    assert!(interval.high - interval.low < 0.02 && interval.low > 0.07, "{interval:?}");
    // Each arm by itself would not tell.
    assert!(bootstrap(&a, mean, 2_000).low < mean(&b));
    let (none, interval) = paired_difference(&a, &a, 100);
    assert_eq!((none, interval.low, interval.high), (0.0, 0.0, 0.0));
}

#[test]
fn resampled_indices_are_uniform() {
    for mut draws in [Resampler::new(7), Resampler::of_stratum(3)] {
        let mut counts = [0_u32; 7];
        for _ in 0..70_000 {
            counts[draws.index(7)] += 1;
        }
        let squares: f64 = counts.iter().map(|&count| (f64::from(count) - 10_000.0).powi(2) / 10_000.0).sum();
        assert!(squares < 22.5, "chi-squared {squares} with 6 degrees of freedom: {counts:?}");
    }
    assert_eq!(Resampler::new(7).index(0), 0);
}

/// Of two strata, the draws of one say nothing about those of the other.
#[test]
fn strata_are_resampled_independently() {
    let (mut first, mut second) = (Resampler::of_stratum(0), Resampler::of_stratum(1));
    let mut table = [[0_u32; 4]; 4];
    for _ in 0..64_000 {
        table[first.index(4)][second.index(4)] += 1;
    }
    let squares: f64 = table.iter().flatten().map(|&count| (f64::from(count) - 4_000.0).powi(2) / 4_000.0).sum();
    assert!(squares < 37.7, "chi-squared {squares} with 15 degrees of freedom: {table:?}");
}
