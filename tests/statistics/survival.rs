//! Kaplan and Meier's estimate against published tables and lifelines 0.30.3.

use crate::close;
use skilltree::report::statistics::{SurvivalCurve, TimeToEvent};

/// Weeks of remission of leukaemia (Freireich et al. 1963), as every textbook works them: 6-mercaptopurine.
const TREATED: [(u32, bool); 21] = [
    (6, true),
    (6, true),
    (6, true),
    (6, false),
    (7, true),
    (9, false),
    (10, true),
    (10, false),
    (11, false),
    (13, true),
    (16, true),
    (17, false),
    (19, false),
    (20, false),
    (22, true),
    (23, true),
    (25, false),
    (32, false),
    (32, false),
    (34, false),
    (35, false),
];
/// The same, placebo: nobody is censored.
const PLACEBO: [u32; 21] = [1, 1, 2, 2, 3, 4, 4, 5, 5, 8, 8, 8, 8, 11, 11, 12, 12, 15, 17, 22, 23];

fn survival(seen: &[(u32, bool)]) -> SurvivalCurve {
    let seen = seen.iter().map(|&(time, reached)| TimeToEvent { time: f64::from(time), reached });
    SurvivalCurve::new(&seen.collect::<Vec<_>>())
}

#[test]
fn remission_under_treatment_is_as_published() {
    let curve = survival(&TREATED);
    assert_eq!((curve.count, curve.reached, curve.end), (21, 9, 35.0));
    // Time, at risk, events, share and Greenwood's error as in Cox and Oakes (1984) and Collett (2003), table 2.2; the
    // log-log interval from lifelines: KaplanMeierFitter().fit(times, reached).confidence_interval_.
    let published = [
        (6.0, 21, 3, 0.857142857142857, 0.0764, 0.6197179552659838, 0.9515517476469969),
        (7.0, 17, 1, 0.8067226890756299, 0.0869, 0.5631465646222333, 0.9228090192028802),
        (10.0, 15, 1, 0.7529411764705878, 0.0963, 0.5031995107999564, 0.8893618351692651),
        (13.0, 12, 1, 0.6901960784313722, 0.1068, 0.4316102224861839, 0.8490659633494505),
        (16.0, 11, 1, 0.6274509803921566, 0.1141, 0.36751085598750194, 0.8049121894718411),
        (22.0, 7, 1, 0.5378151260504199, 0.1282, 0.26777893676713493, 0.7467907176353943),
        (23.0, 6, 1, 0.44817927170868327, 0.1346, 0.18805200595923233, 0.6801426284952412),
    ];
    assert_eq!(curve.steps.len(), published.len());
    for (step, (time, at_risk, events, share, error, low, high)) in curve.steps.iter().zip(published) {
        assert_eq!((step.time, step.at_risk, step.events), (time, at_risk, events));
        close(step.share.value, share, 1e-12);
        close(step.error, error, 5.1e-5);
        close(step.share.low, low, 1e-12);
        close(step.share.high, high, 1e-12);
    }
    assert_eq!((curve.quantile(0.5), curve.quantile_interval(0.5)), (Some(23.0), (Some(13.0), None)));
    assert_eq!((curve.quantile(0.25), curve.quantile_interval(0.25)), (Some(13.0), (Some(6.0), Some(22.0))));
    assert_eq!(curve.quantile(0.75), None);
}

#[test]
fn remission_under_placebo_is_as_published() {
    let curve = survival(&PLACEBO.map(|time| (time, true)));
    assert_eq!((curve.quantile(0.5), curve.quantile_interval(0.5)), (Some(8.0), (Some(4.0), Some(11.0))));
    let at = |time: f64| *curve.steps.iter().find(|step| step.time == time).unwrap();
    for (time, share, low, high) in [
        (8.0, 0.3809523809523809, 0.1830665488203943, 0.5777886777458309),
        (22.0, 0.047619047619047616, 0.003324463042531178, 0.1970449056989461),
    ] {
        close(at(time).share.value, share, 1e-12);
        close(at(time).share.low, low, 1e-12);
        close(at(time).share.high, high, 1e-12);
    }
    let last = curve.steps.last().unwrap();
    assert_eq!((last.share.value, last.error, last.share.low, last.share.high), (0.0, 0.0, 0.0, at(22.0).share.high));
}

/// Nobody leaves early: the curve is the share of learners that are not there yet.
#[test]
fn without_early_censoring_the_curve_is_a_plain_share() {
    let curve = survival(&[(10, true), (20, true), (20, true), (50, false), (50, false)]);
    let steps: Vec<_> = curve.steps.iter().map(|step| (step.time, step.at_risk)).collect();
    assert_eq!(steps, [(10.0, 5), (20.0, 4)]);
    close(curve.steps[0].share.value, 0.8, 1e-12);
    close(curve.steps[1].share.value, 0.4, 1e-12);
    // 0.6 got there in the end, so 0.7 never did, and exactly 0.6 by 20.
    assert_eq!((curve.quantile(0.6), curve.quantile(0.7), curve.quantile(0.2)), (Some(20.0), None, Some(10.0)));
}

#[test]
fn nobody_there_is_a_flat_curve() {
    let curve = survival(&[(50, false); 3]);
    assert!(curve.steps.is_empty() && curve.quantile(0.5).is_none());
    assert_eq!((curve.count, curve.reached, curve.end), (3, 0, 50.0));
    assert_eq!(survival(&[]).end, 0.0);
}
