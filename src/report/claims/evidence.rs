//! What claims are judged from, and what is found.

use crate::report::comparison::MAIN;
use crate::report::format::points;
use crate::report::rooms;
use crate::report::statistics::{Estimate, mean_of, paired_difference};
use crate::report::summary::{Score, SeedScores, Series, Summary, paired};
use crate::report::training::TrainingCurve;

/// What became of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClaimVerdict {
    /// As the paper says.
    Holds,
    /// In part, as the rule says.
    Partly,
    /// Not as the paper says.
    DoesNotHold,
    /// The run lacks what the rule needs.
    NotTested,
}

impl ClaimVerdict {
    /// As the page prints it.
    pub(in crate::report) fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Partly => "partly",
            Self::DoesNotHold => "does not hold",
            Self::NotTested => "not tested here",
        }
    }

    /// Holds if everything is as claimed, partly if something is.
    pub(super) fn of(as_claimed: &[bool]) -> Self {
        Self::surely(as_claimed.iter().all(|claimed| *claimed), as_claimed.contains(&true))
    }

    /// Holds if all of an interval is as claimed, partly if only the value is.
    pub(super) fn surely(surely: bool, probably: bool) -> Self {
        match (surely, probably) {
            (true, _) => Self::Holds,
            (false, true) => Self::Partly,
            (false, false) => Self::DoesNotHold,
        }
    }

    /// Holds from one limit on, partly from a lower one on.
    pub(super) fn from_limits(value: f64, holds: f64, partly: f64) -> Self {
        Self::surely(value >= holds, value >= partly)
    }
}

/// What a run says of a claim.
pub(super) struct Finding {
    /// Numbers in words.
    pub(super) figures: Vec<String>,
    /// Seeds behind them.
    pub(super) seeds: usize,
    pub(super) verdict: ClaimVerdict,
    /// When the claim holds, and when it does in part.
    pub(super) rule: String,
}

/// What a run holds.
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

    /// Mean success over the seeds that were tested from a room.
    pub(super) fn success_from(&self, test: &SeedScores, room: &str) -> Result<Estimate, String> {
        let index = self.summary.room(room).filter(|&room| !test.rooms[room].is_empty());
        let index = index.ok_or_else(|| format!("There are no tests from room {room}."))?;
        Ok(mean_of(&rooms::success(test, index)))
    }

    /// What the main arm has more than another one, at their last tests.
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
