//! How claims are judged, and what rules look at.

use super::verdict::{ClaimVerdict, Finding};
use crate::report::comparison::MAIN;
use crate::report::format::points;
use crate::report::rooms;
use crate::report::statistics::{Estimate, paired_difference};
use crate::report::summary::{Score, SeedScores, Series, Summary, paired};
use crate::report::training::TrainingCurve;

/// How a claim is judged.
pub(super) struct ClaimRule {
    pub(super) title: &'static str,
    pub(super) says: &'static str,
    /// When the claim holds, and when it does in part.
    pub(super) rule: fn() -> String,
    /// The finding, or what the run lacks for it.
    pub(super) judge: fn(&Evidence<'_>) -> Result<Finding, String>,
}

/// What rules look at.
pub(super) struct Evidence<'a> {
    pub(super) summary: &'a Summary,
    pub(super) trainings: &'a [TrainingCurve],
}

impl<'a> Evidence<'a> {
    /// The root skill of an arm.
    pub(super) fn root(&self, arm: &str) -> Result<&'a Series, String> {
        let known = self.summary.arm(arm).ok_or_else(|| format!("There is no arm `{arm}`."))?;
        self.skill(arm, &known.root)
    }

    /// A skill of an arm.
    pub(super) fn skill(&self, arm: &str, skill: &str) -> Result<&'a Series, String> {
        let lacking = || format!("There is no arm `{arm}` with a tested skill `{skill}`.");
        self.summary.series(arm, skill).ok_or_else(lacking)
    }

    /// Success of every seed that was tested from a room.
    pub(super) fn success_from(&self, test: &SeedScores, room: &str) -> Result<Vec<f64>, String> {
        let index = self.summary.room(room).filter(|&room| !test.rooms[room].is_empty());
        let index = index.ok_or_else(|| format!("There are no tests from room {room}."))?;
        Ok(rooms::success(test, index))
    }

    /// Mean over seeds of what the main arm has more than another one, at their last tests.
    pub(super) fn main_minus(&self, arm: &str) -> Result<Lead, String> {
        let (main, other) = (self.root(MAIN)?, self.root(arm)?);
        Lead::new(&main.last().scores, &other.last().scores)
    }
}

/// The test near a number of trials.
pub(super) fn at(series: &Series, trials: u32) -> Result<&SeedScores, String> {
    series.near(trials).ok_or_else(|| format!("The arm `{}` has no test near {trials} trials.", series.arm))
}

/// How much more the seeds of one arm achieve than the same ones of another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lead {
    /// The mean difference of success.
    pub(super) by: Estimate,
    /// Seeds that both arms have.
    pub(super) seeds: usize,
}

impl Lead {
    /// Success of `a` minus success of `b`.
    pub(super) fn new(a: &[Score], b: &[Score]) -> Result<Self, String> {
        let (a, b) = paired(a, b, Score::success);
        if a.is_empty() {
            return Err("The arms have no seed in common.".into());
        }
        Ok(Self { by: paired_difference(&a, &b), seeds: a.len() })
    }

    pub(super) fn words(&self) -> String {
        format!("{} points", points(self.by))
    }

    /// Holds if the lead is certain, partly if it is there.
    pub(super) fn verdict(&self) -> ClaimVerdict {
        ClaimVerdict::surely(self.by.low > 0.0, self.by.value > 0.0)
    }
}
