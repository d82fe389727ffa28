//! Time to an event where some learners never get there: Kaplan and Meier's estimate.

use super::estimate::{Estimate, Z};

/// How long one learner was watched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeToEvent {
    /// When it got there, or how long it was watched in vain.
    pub time: f64,
    /// Whether it got there. If not, it is censored: it would have needed more than this time.
    pub reached: bool,
}

/// The curve at a time at which at least one learner got there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurvivalStep {
    pub time: f64,
    /// Learners that were still watched and had not got there before.
    pub at_risk: usize,
    /// Learners that got there now.
    pub events: usize,
    /// Share of learners that have not got there by now, this time included. Its log-log interval (Kalbfleisch and
    /// Prentice) never leaves 0 to 1. Where everybody got there the formula has no value; the lower end is then 0 and
    /// the upper end stays where it was.
    pub share: Estimate,
    /// Standard error of the share, by Greenwood's formula.
    pub error: f64,
}

/// Kaplan and Meier's estimate.
#[derive(Debug, Clone, PartialEq)]
pub struct SurvivalCurve {
    /// By ascending time. Before the first step the share is 1.
    pub steps: Vec<SurvivalStep>,
    pub count: usize,
    pub reached: usize,
    /// The longest time that any learner was watched: the curve ends there. 0 for none.
    pub end: f64,
}

impl SurvivalCurve {
    /// The estimate. A learner that is censored when others get there counts as still watched then.
    pub fn new(observations: &[TimeToEvent]) -> Self {
        let mut times: Vec<f64> = observations.iter().filter(|seen| seen.reached).map(|seen| seen.time).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        let (mut share, mut greenwood) = (Estimate::exact(1.0), 0.0);
        let mut steps = Vec::with_capacity(times.len());
        for time in times {
            let at_risk = observations.iter().filter(|seen| seen.time >= time).count();
            let events = observations.iter().filter(|seen| seen.reached && seen.time == time).count();
            let left = at_risk - events;
            let value = share.value * left as f64 / at_risk as f64;
            greenwood += events as f64 / (at_risk as f64 * left as f64);
            // The logarithm is negative, so the plus sign gives the upper end.
            let spread = Z * greenwood.sqrt() / value.ln();
            let (low, high) = match left {
                0 => (0.0, share.high),
                _ => (value.powf((-spread).exp()), value.powf(spread.exp())),
            };
            share = Estimate { value, low, high };
            let error = if left == 0 { 0.0 } else { value * greenwood.sqrt() };
            steps.push(SurvivalStep { time, at_risk, events, share, error });
        }
        Self {
            steps,
            count: observations.len(),
            reached: observations.iter().filter(|seen| seen.reached).count(),
            end: observations.iter().map(|seen| seen.time).fold(0.0, f64::max),
        }
    }

    /// The first time by which at least this share of the learners got there; none if fewer ever did.
    pub fn quantile(&self, share: f64) -> Option<f64> {
        self.first(share, |step| step.share.value)
    }

    /// Interval of [`SurvivalCurve::quantile`] (Brookmeyer and Crowley): the times at which the band's lower and upper
    /// ends pass the share. None for an end beyond the last step.
    pub fn quantile_interval(&self, share: f64) -> (Option<f64>, Option<f64>) {
        (self.first(share, |step| step.share.low), self.first(share, |step| step.share.high))
    }

    fn first(&self, share: f64, of: fn(&SurvivalStep) -> f64) -> Option<f64> {
        // A share such as 0.9 and its rest are not exact in binary.
        self.steps.iter().find(|step| of(step) <= 1.0 - share + 1e-12).map(|step| step.time)
    }
}
