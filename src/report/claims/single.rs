//! Claims on the single Q-function: section VII, non-hierarchical learning.

use super::{Estimate, Found, MAIN, Rule, Verdict, difference};
use crate::report::comparison::SINGLE;
use crate::report::numbers::{limit, percent_with};
use crate::report::statistics::TABLE_RESAMPLES;
use crate::report::summary::Score;
use crate::report::training::{self, Tally, pooled};

/// The arm that is punished for collisions.
const PENALTY: &str = "monolithic-penalty";
/// Success below this is failure.
const FAILS: f64 = 0.5;
/// Collisions per step.
const OFTEN: f64 = 0.05;
/// Success below this is poor.
const POOR: f64 = 0.8;

pub(super) const FAILS_FROM_AFAR: Rule = Rule {
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
        let cell = evidence.root(SINGLE)?.last();
        let rooms = ["B", "C"].map(|room| evidence.success_from(cell, room).map(|values| Estimate::new(&values)));
        let [b, c] = rooms;
        let (b, c) = (b?, c?);
        Ok(Found {
            figures: vec![
                format!("{} from B", b.share()),
                format!("{} from C, after {} trials", c.share(), cell.trials),
            ],
            seeds: cell.scores.len(),
            verdict: Verdict::of(&[b.interval.high < FAILS, c.interval.high < FAILS]),
        })
    },
};

pub(super) const COLLIDES: Rule = Rule {
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
        let training = training::of(evidence.trainings, series);
        let training = training.ok_or_else(|| format!("There are no training trials of `{SINGLE}`."))?;
        let tallies = training.tallies(0);
        let (rate, interval) = pooled(&tallies, Tally::collisions_and_steps, TABLE_RESAMPLES);
        Ok(Found {
            figures: vec![format!("{} of steps collide", percent_with(rate, interval))],
            seeds: tallies.len(),
            verdict: match interval.low > OFTEN {
                true => Verdict::Holds,
                false if rate > OFTEN => Verdict::Partly,
                false => Verdict::DoesNotHold,
            },
        })
    },
};

pub(super) const PUNISHED: Rule = Rule {
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
        let success = Estimate::new(&punished.values(Score::success));
        let gain = difference(&punished.scores, &single.scores)?;
        let lead = difference(&evidence.root(MAIN)?.last().scores, &punished.scores)?;
        let poor = success.mean < POOR && lead.mean > 0.0;
        Ok(Found {
            figures: vec![
                format!("{} achieved", success.share()),
                format!("minus `{SINGLE}`: {}", gain.points()),
                format!("`{MAIN}` minus it: {}", lead.points()),
            ],
            seeds: success.seeds,
            verdict: match poor {
                true if gain.mean > 0.0 => Verdict::Holds,
                true => Verdict::Partly,
                false => Verdict::DoesNotHold,
            },
        })
    },
};
