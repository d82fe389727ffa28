//! Applicability thresholds learned from a skill's own training trials (paper, section VI.B: "a proper threshold
//! could be learned").
//!
//! A logistic curve is fitted to whether a trial achieved its goal, against the best Q-value at each of its steps as
//! the trained nets see it. The threshold is the value at which the curve reaches the wanted probability. Our choice.
//! It costs no action. Done on the host, once for all backends, with a library's exponential, so that every host
//! finds the same bits.

use crate::backend::Cohort;
use crate::backend::cpu::CPU;
use crate::env::workgroup::{Nets, Workgroup};
use crate::layout::{HyperParams, LearnerState, TERMINATED};
use crate::learn::lesson::{LESSON_END, LESSON_STEPS};
use bytemuck::Zeroable;
use serde::{Deserialize, Serialize};

/// Newton steps of a fit; it has settled long before.
const ROUNDS: u32 = 50;
/// Smallest share of a Newton step that is tried.
const SMALLEST: f64 = 1.0e-6;
/// Weight of the pull towards a flat curve: keeps a fit finite where values part success from failure cleanly.
const RIDGE: f64 = 1.0e-3;

/// Log odds of success, as a line over the best Q-value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// At value 0.
    pub offset: f64,
    /// Per unit of value.
    pub slope: f64,
}

impl Fit {
    /// The curve through what was seen: best Q-value, and whether the trial achieved its goal.
    pub fn new(seen: &[(f64, bool)]) -> Self {
        let mut fit = Self { offset: 0.0, slope: 0.0 };
        let mut likelihood = fit.likelihood(seen);
        for _round in 0..ROUNDS {
            let (offset, slope) = fit.newton(seen);
            // A full step may overshoot where values part success from failure cleanly.
            let mut share = 1.0;
            let mut next = fit;
            let mut better = false;
            while !better && share > SMALLEST {
                next = Self { offset: fit.offset + share * offset, slope: fit.slope + share * slope };
                better = next.likelihood(seen) > likelihood;
                share *= 0.5;
            }
            if !better {
                break;
            }
            fit = next;
            likelihood = fit.likelihood(seen);
        }
        fit
    }

    fn probability(&self, value: f64) -> f64 {
        1.0 / (1.0 + libm::exp(-(self.offset + self.slope * value)))
    }

    /// Log likelihood of what was seen, less the pull.
    fn likelihood(&self, seen: &[(f64, bool)]) -> f64 {
        let one = |(value, success): &(f64, bool)| {
            let odds = self.offset + self.slope * value;
            let lost = if *success { -odds } else { odds };
            // ln(1 + e^x) without overflow.
            -(lost.max(0.0) + libm::log1p(libm::exp(-lost.abs())))
        };
        seen.iter().map(one).sum::<f64>() - 0.5 * RIDGE * (self.offset * self.offset + self.slope * self.slope)
    }

    /// Newton's step from here.
    fn newton(&self, seen: &[(f64, bool)]) -> (f64, f64) {
        let (mut g0, mut g1) = (-RIDGE * self.offset, -RIDGE * self.slope);
        let (mut h00, mut h01, mut h11) = (RIDGE, 0.0, RIDGE);
        for (value, success) in seen {
            let p = self.probability(*value);
            let error = f64::from(u8::from(*success)) - p;
            let weight = p * (1.0 - p);
            g0 += error;
            g1 += error * value;
            h00 += weight;
            h01 += weight * value;
            h11 += weight * value * value;
        }
        // The pull keeps this above zero.
        let determinant = h00 * h11 - h01 * h01;
        ((h11 * g0 - h01 * g1) / determinant, (h00 * g1 - h01 * g0) / determinant)
    }

    /// The best Q-value from which on success is at least this probable; never, for a skill whose value says nothing.
    pub fn threshold(&self, probability: f32) -> f32 {
        if self.slope <= 0.0 {
            return 1.0;
        }
        let odds = libm::log(f64::from(probability) / (1.0 - f64::from(probability)));
        (((odds - self.offset) / self.slope) as f32).clamp(-1.0, 1.0)
    }
}

/// What a learner's nets say of the later half of the trials that it remembers of a skill.
pub fn fit(cohort: &Cohort, learner: usize, skill: usize) -> Fit {
    let plan = &cohort.shared.skills[skill];
    let params = &cohort.params[learner * cohort.skills..][..cohort.skills];
    let nets = &cohort.nets[learner * cohort.nets_stride..][..cohort.nets_stride];
    let mut lessons = cohort.lessons[learner * cohort.lessons_stride..][..cohort.lessons_stride].to_vec();
    let HyperParams { trials, replay_capacity, .. } = params[skill];
    let kept = trials.min(replay_capacity);
    let mut group = Workgroup {
        nets: Nets::Read(nets),
        lessons: &mut lessons,
        state: LearnerState { skill: skill as u32, ..LearnerState::zeroed() },
        ..Workgroup::new(&cohort.shared, params, &CPU.hot)
    };
    let mut seen = Vec::new();
    for age in 0..kept.div_ceil(2) {
        let slot = (trials - 1 - age) % replay_capacity;
        group.state.replay_lesson = plan.memory_offset + slot * plan.lesson_stride;
        let achieved = group.lesson_word(LESSON_END) == TERMINATED;
        for step in 0..group.lesson_word(LESSON_STEPS) {
            group.load_step(step as usize);
            group.encode(skill as u32, false);
            (group.forms.forward)(&mut group, skill as u32);
            let best = group.q[..plan.children as usize].iter().copied().fold(f32::NEG_INFINITY, f32::max);
            seen.push((f64::from(best), achieved));
        }
    }
    Fit::new(&seen)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The fit recovers the curve that outcomes were drawn from.
    #[test]
    fn a_known_curve_is_found() {
        let seen: Vec<(f64, bool)> = (0..40_000_u32)
            .map(|i| {
                let words = crate::math::rng::philox([i, 0, 0, 0], [5, 6]);
                let value = f64::from(words[0]) / f64::from(u32::MAX);
                let p = 1.0 / (1.0 + (-(-3.0 + 8.0 * value)).exp());
                (value, f64::from(words[1]) / f64::from(u32::MAX) < p)
            })
            .collect();
        let fit = Fit::new(&seen);
        assert!((fit.offset + 3.0).abs() < 0.15 && (fit.slope - 8.0).abs() < 0.3, "{fit:?}");
        assert!((fit.threshold(0.5) - 0.375).abs() < 0.01);
        assert!(fit.threshold(0.8) > fit.threshold(0.5));
    }

    #[test]
    fn parted_and_constant_outcomes_stay_finite() {
        let parted: Vec<(f64, bool)> = (0..100).map(|i| (f64::from(i) / 100.0, i >= 50)).collect();
        let found = Fit::new(&parted).threshold(0.5);
        assert!((found - 0.495).abs() < 0.02, "{found}");
        for success in [false, true] {
            let all: Vec<(f64, bool)> = (0..100).map(|i| (f64::from(i) / 100.0, success)).collect();
            assert!(Fit::new(&all).threshold(0.5).is_finite());
        }
    }
}
