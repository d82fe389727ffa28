//! Claims on elementary skills: section V.

use super::evidence::{ClaimRule, at};
use super::verdict::{ClaimVerdict, Finding};
use crate::report::comparison::MAIN;
use crate::report::format::{limit, number, share};
use crate::report::statistics::{mean_of, sorted};
use crate::report::summary::Score;

/// Success that counts as having learned a skill.
const LEARNED: f64 = 0.8;
/// Seeds below this have not learned to dock.
const FAILED: f64 = 0.5;
/// Shares of untaught robots that fail, between which the paper's 2 of 7 is met.
const FAILING: (f64, f64) = (0.1, 0.6);
/// Trials of untaught docking.
const UNTAUGHT_TRIALS: u32 = 300;
/// Trials with lessons.
const TAUGHT_TRIALS: u32 = 150;
/// Success that is very good, and good.
const VERY_GOOD: f64 = 0.9;
const GOOD: f64 = 0.75;
/// Share of the planner's return that is good wall following.
const FOLLOWING: f64 = 0.74;

pub(super) const UNTAUGHT: ClaimRule = ClaimRule {
    title: "docking untaught",
    says: "Without lessons, some robots never learn to dock within 300 trials, and the others need most of them.",
    rule: || {
        format!(
            "Holds if {} to {} of the seeds achieve less than {} of their tests after {UNTAUGHT_TRIALS} trials, and \
             the median of the other seeds needs at least {TAUGHT_TRIALS} trials to {}; partly if only one of the two.",
            limit(FAILING.0),
            limit(FAILING.1),
            limit(FAILED),
            limit(LEARNED),
        )
    },
    judge: |evidence| {
        let series = evidence.root("docking-untaught")?;
        let success = at(series, UNTAUGHT_TRIALS)?.values(Score::success);
        let fails = |&success: &f64| f64::from(u8::from(success < FAILED));
        let failing = mean_of(&success.iter().map(fails).collect::<Vec<_>>());
        let learners = success.iter().zip(series.trials_to(LEARNED)).filter(|(success, _)| **success >= FAILED);
        // A seed that never got there needed more than all others.
        let trials: Vec<f64> = learners.map(|(_, trials)| trials.map_or(f64::INFINITY, f64::from)).collect();
        let median = upper_median(&trials);
        let needs = match median {
            median if median.is_nan() => "no other seeds".to_owned(),
            median if median.is_infinite() => {
                format!("the others' median needs more than {} trials", series.last().trials)
            }
            median => format!("the others' median needs {} trials", number(median)),
        };
        let in_range = (FAILING.0..=FAILING.1).contains(&failing.value);
        Ok(Finding {
            figures: vec![format!("{} of seeds fail", share(failing)), needs],
            seeds: success.len(),
            verdict: ClaimVerdict::of(&[in_range, median >= f64::from(TAUGHT_TRIALS)]),
        })
    },
};

/// The middle value, or the upper one of two; NaN for none. No mean of two, as values may be infinite.
fn upper_median(values: &[f64]) -> f64 {
    sorted(values).get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

pub(super) const TAUGHT: ClaimRule = ClaimRule {
    title: "docking taught",
    says: "With 10 lessons, docking is learned very well, generally within 150 trials.",
    rule: || {
        format!(
            "Holds from a mean success of {} after {TAUGHT_TRIALS} trials on, partly from {} on.",
            limit(VERY_GOOD),
            limit(GOOD)
        )
    },
    judge: |evidence| {
        let series = evidence.root("docking-taught").or_else(|_| evidence.skill(MAIN, "dock"))?;
        let test = at(series, TAUGHT_TRIALS)?;
        let success = mean_of(&test.values(Score::success));
        Ok(Finding {
            figures: vec![format!("{} achieved after {} trials", share(success), test.trials)],
            seeds: test.scores.len(),
            verdict: ClaimVerdict::from_limits(success.value, VERY_GOOD, GOOD),
        })
    },
};

pub(super) const OTHER_SKILLS: ClaimRule = ClaimRule {
    title: "doors and walls",
    says: "With lessons, passing doors and following walls are learned effectively too.",
    rule: || {
        format!(
            "Holds from a mean success of `pass-door` of {} on, with a return of `follow-right` of at least {} of the \
             planner's; partly if only one of the two.",
            limit(VERY_GOOD),
            limit(FOLLOWING)
        )
    },
    judge: |evidence| {
        let doors = evidence.skill(MAIN, "pass-door")?.last();
        let passing = mean_of(&doors.values(Score::success));
        let following = mean_of(&evidence.skill(MAIN, "follow-right")?.last().values(Score::return_per_trial));
        let bound = evidence.summary.skill("follow-right").and_then(|skill| skill.bound(MAIN));
        let bound = bound.map(|bound| bound.score.return_per_trial()).filter(|bound| *bound > 0.0);
        let bound = bound.ok_or("The planner has no return of `follow-right` to compare with.")?;
        Ok(Finding {
            figures: vec![
                format!("{} of doors passed", share(passing)),
                format!("{} of the planner's return along walls", share(following.over(bound))),
            ],
            seeds: doors.scores.len(),
            verdict: ClaimVerdict::of(&[passing.value >= VERY_GOOD, following.value >= FOLLOWING * bound]),
        })
    },
};
