//! Step plots: performance profiles, and shares of learners that have not reached a criterion yet.

use super::figure::axis::PlotAxis;
use super::figure::curves::{Curve, CurvePoint};
use super::figure::{Figure, PlotArea};
use super::statistics::{BAND_RESAMPLES, Estimate, SurvivalCurve, bootstrap, mean, wilson};

/// Limits of a performance profile.
const LIMITS: u32 = 50;
/// Share of the trials by which a survival curve is drawn on, so that the step at the last test shows.
const BEYOND: f64 = 0.04;

/// A small figure of shares over success.
pub fn profile_axes(y_title: &str) -> Figure {
    Figure { x: PlotAxis::linear("success at the last test", (0.0, 1.0), true), ..shares(y_title) }
}

/// A small figure of shares over training trials, up to a number of them.
pub fn survival_axes(y_title: &str, trials: f64) -> Figure {
    Figure { x: PlotAxis::linear("training trials", (0.0, (1.0 + BEYOND) * trials), false), ..shares(y_title) }
}

fn shares(y_title: &str) -> Figure {
    let y = PlotAxis::linear(y_title, (0.0, 1.0), true).with_grid();
    Figure { y, area: PlotArea::SMALL, ..Figure::default() }
}

/// Share of seeds with more than each success, with Wilson's interval: seeds are independent.
pub fn seed_profile(label: String, success: &[f64]) -> Curve {
    profile(label, |limit| {
        let above = success.iter().filter(|success| **success > limit).count();
        wilson(above as u64, success.len() as u64)
    })
}

/// Share of learners with more than each success, of several learners with each seed. Seeds are resampled with all of
/// their learners.
pub fn learner_profile(label: String, success_by_seed: &[Vec<f64>]) -> Curve {
    profile(label, |limit| {
        let share = |of_seed: &Vec<f64>| {
            of_seed.iter().filter(|success| **success > limit).count() as f64 / of_seed.len() as f64
        };
        bootstrap(&success_by_seed.iter().map(share).collect::<Vec<_>>(), mean, BAND_RESAMPLES)
    })
}

fn profile(label: String, above: impl Fn(f64) -> Estimate) -> Curve {
    let limits = (0..LIMITS).map(|i| f64::from(i) / f64::from(LIMITS));
    let points = limits.map(|x| CurvePoint { x, y: above(x) }).collect();
    Curve { label, points, steps_until: Some(1.0) }
}

/// Share of learners that are not there yet, in a figure up to a number of trials.
pub fn survival(label: &str, seen: &SurvivalCurve, trials: f64) -> Curve {
    let points = seen.steps.iter().map(|step| CurvePoint { x: step.time, y: step.share }).collect();
    let label = format!("{label} ({} of {})", seen.reached, seen.count);
    Curve { label, points, steps_until: Some(seen.end + BEYOND * trials) }
}
