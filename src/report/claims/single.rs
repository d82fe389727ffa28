//! Claims on the single Q-function: section VII, non-hierarchical learning.

use super::evidence::{ClaimRule, Lead};
use super::verdict::{ClaimVerdict, Finding};
use crate::report::comparison::{MAIN, SINGLE};
use crate::report::format::{limit, share};
use crate::report::statistics::{TABLE_RESAMPLES, mean_of};
use crate::report::summary::Score;
use crate::report::training::{TrialSums, of_series, pooled};

/// The arm that is punished for collisions.
const PENALTY: &str = "monolithic-penalty";
/// Success below this is failure.
const FAILS: f64 = 0.5;
/// Collisions per step.
const OFTEN: f64 = 0.05;
/// Success below this is poor.
const POOR: f64 = 0.8;

pub(super) const FAILS_FROM_AFAR: ClaimRule = ClaimRule {
    title: "single, far rooms",
    says: "After 300 trials a single Q-function generally fails from rooms B and C.",
    rule: || {
        format!(
            "Holds if the success of `{SINGLE}` at its last test is below {}, the interval's upper end counted, from B \
             and from C; partly if only from one.",
            limit(FAILS)
        )
    },
    judge: |evidence| {
        let test = evidence.root(SINGLE)?.last();
        let rooms = ["B", "C"].map(|room| evidence.success_from(test, room).map(|values| mean_of(&values)));
        let [b, c] = rooms;
        let (b, c) = (b?, c?);
        Ok(Finding {
            figures: vec![format!("{} from B", share(b)), format!("{} from C, after {} trials", share(c), test.trials)],
            seeds: test.scores.len(),
            verdict: ClaimVerdict::of(&[b.high < FAILS, c.high < FAILS]),
        })
    },
};

pub(super) const COLLIDES: ClaimRule = ClaimRule {
    title: "single, collisions",
    says: "It collides on more than 5% of its steps.",
    rule: || {
        format!(
            "Collisions over steps of all training trials of `{SINGLE}`: holds if the interval lies above {}, partly \
             if only the mean does.",
            limit(OFTEN)
        )
    },
    judge: |evidence| {
        let series = evidence.root(SINGLE)?;
        let training = of_series(evidence.trainings, series);
        let training = training.ok_or_else(|| format!("There are no training trials of `{SINGLE}`."))?;
        let sums = training.sums_by_seed(0);
        let rate = pooled(&sums, TrialSums::collisions_and_steps, TABLE_RESAMPLES);
        Ok(Finding {
            figures: vec![format!("{} of steps collide", share(rate))],
            seeds: sums.len(),
            verdict: ClaimVerdict::surely(rate.low > OFTEN, rate.value > OFTEN),
        })
    },
};

pub(super) const PUNISHED: ClaimRule = ClaimRule {
    title: "single, punished",
    says: "Punishing collisions makes it slightly better, but it still performs poorly.",
    rule: || {
        format!(
            "Last tests: holds if `{PENALTY}` achieves more than `{SINGLE}` on the same seeds, less than {}, and less \
             than `{MAIN}`; partly if poor as that, but not better.",
            limit(POOR)
        )
    },
    judge: |evidence| {
        let (punished, single) = (evidence.root(PENALTY)?.last(), evidence.root(SINGLE)?.last());
        let success = mean_of(&punished.values(Score::success));
        let gain = Lead::new(&punished.scores, &single.scores)?;
        let lead = Lead::new(&evidence.root(MAIN)?.last().scores, &punished.scores)?;
        let poor = success.value < POOR && lead.by.value > 0.0;
        Ok(Finding {
            figures: vec![
                format!("{} achieved", share(success)),
                format!("minus `{SINGLE}`: {}", gain.words()),
                format!("`{MAIN}` minus it: {}", lead.words()),
            ],
            seeds: punished.scores.len(),
            verdict: ClaimVerdict::surely(poor && gain.by.value > 0.0, poor),
        })
    },
};
