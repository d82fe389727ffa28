//! The paper's claims, each judged by a fixed rule from what a run holds.
//!
//! Arms are known by their names; a claim whose arms a run lacks is not tested there. Every arm counts with its root
//! skill, unless a skill is named.
//!
//! | arm | what it is | claims |
//! |---|---|---|
//! | `hierarchical` | the main arm: skills, and a learned skill above them | 2 (without `docking-taught`), 3, 6 to 13 |
//! | `monolithic` | one Q-function over actions, the paper's reward | 4, 5, 6, 11 |
//! | `monolithic-penalty` | the same, punished for collisions | 6, 11 |
//! | `monolithic-...` | any other arm without skills below its root | 11 |
//! | `docking-untaught`, `docking-taught` | the root is `dock`, without lessons and with them | 1; 2 |
//! | `no-persistence` | without the Persistence Rule | 9 |
//! | `low-thresholds`, `high-thresholds`, `learned-thresholds` | thresholds that should make no difference | 10 |
//! | `excluding-thresholds` | thresholds so high that they rule out the best skill | 10 |
//! | `td0` | lambda = 0 | 12 |
//!
//! Claim 3 reads the main arm's skills `pass-door` and `follow-right`, claim 2 its `dock` where there is no arm
//! `docking-taught`. Rooms are the paper's `A`, `B` and `C`. Claim 13 reads all alterations but `noise-*` and
//! `*-hard`. Other arms (`persistence-in-training`, `literal`, `no-applicability`, `fixed-arbitration`,
//! `random-skill`, `planner-skills`, ...) stand in the tables of their skills.

mod elementary;
mod hierarchy;
mod single;
mod transfer;

use super::comparison::MAIN;
use super::numbers::{percent_range, percent_with, points_with};
use super::statistics::{Interval, TABLE_RESAMPLES, bootstrap, mean, paired_difference};
use super::summary::{Cell, Score, Series, Summary, paired};
use super::training::Training;
use rayon::prelude::*;

/// What became of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// As the paper says.
    Holds,
    /// In part, as the rule says.
    Partly,
    /// Not as the paper says.
    DoesNotHold,
    /// The run lacks what the rule needs.
    NotTested,
}

impl Verdict {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Partly => "partly",
            Self::DoesNotHold => "does not hold",
            Self::NotTested => "not tested here",
        }
    }

    /// Holds if everything is as claimed, partly if something is.
    fn of(as_claimed: &[bool]) -> Self {
        match as_claimed.iter().filter(|claimed| **claimed).count() {
            0 => Self::DoesNotHold,
            count if count == as_claimed.len() => Self::Holds,
            _ => Self::Partly,
        }
    }

    /// Holds from one limit on, partly from a lower one on.
    fn from_limits(value: f64, holds: f64, partly: f64) -> Self {
        match value {
            value if value >= holds => Self::Holds,
            value if value >= partly => Self::Partly,
            _ => Self::DoesNotHold,
        }
    }
}

/// A claim and its verdict.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    /// In the order of the paper.
    pub number: usize,
    /// What it is about, in two or three words.
    pub title: &'static str,
    /// The claim in our words.
    pub says: &'static str,
    /// What the run says; empty if it says nothing.
    pub figures: Vec<String>,
    /// Seeds behind the figures.
    pub seeds: usize,
    /// What became of it.
    pub verdict: Verdict,
    /// The rule, or what is missing.
    pub why: String,
}

/// What a rule finds.
struct Found {
    figures: Vec<String>,
    seeds: usize,
    verdict: Verdict,
}

/// How a claim is judged.
struct Rule {
    title: &'static str,
    says: &'static str,
    /// When the claim holds, and when it does in part.
    rule: fn() -> String,
    /// The finding, or what the run lacks for it.
    judge: fn(&Evidence<'_>) -> Result<Found, String>,
}

const RULES: [&Rule; 13] = [
    &elementary::UNTAUGHT,
    &elementary::TAUGHT,
    &elementary::OTHER_SKILLS,
    &single::FAILS_FROM_AFAR,
    &single::COLLIDES,
    &single::PUNISHED,
    &hierarchy::EARLY,
    &hierarchy::NEARLY_OPTIMAL,
    &hierarchy::PERSISTENCE,
    &hierarchy::THRESHOLDS,
    &transfer::EQUAL_BUDGET,
    &hierarchy::TD_LAMBDA,
    &transfer::ALTERED,
];

/// Judges all claims. A run without the main arm shows only those that it tests.
pub fn judge(summary: &Summary, trainings: &[Training]) -> Vec<Claim> {
    let evidence = Evidence { summary, trainings };
    let judged = RULES.par_iter().enumerate().map(|(index, rule)| {
        let (found, why) = match (rule.judge)(&evidence) {
            Ok(found) => (found, (rule.rule)()),
            Err(lacking) => (Found { figures: Vec::new(), seeds: 0, verdict: Verdict::NotTested }, lacking),
        };
        let Found { figures, seeds, verdict } = found;
        Claim { number: index + 1, title: rule.title, says: rule.says, figures, seeds, verdict, why }
    });
    let mut claims: Vec<Claim> = judged.collect();
    if summary.arm(MAIN).is_none() {
        claims.retain(|claim| claim.verdict != Verdict::NotTested);
    }
    claims
}

/// What rules look at.
struct Evidence<'a> {
    summary: &'a Summary,
    trainings: &'a [Training],
}

impl<'a> Evidence<'a> {
    /// The root skill of an arm.
    fn root(&self, arm: &str) -> Result<&'a Series, String> {
        let known = self.summary.arm(arm).ok_or_else(|| format!("There is no arm `{arm}`."))?;
        self.skill(arm, &known.root)
    }

    /// A skill of an arm.
    fn skill(&self, arm: &str, skill: &str) -> Result<&'a Series, String> {
        let lacking = || format!("There is no arm `{arm}` with a tested skill `{skill}`.");
        self.summary.series(arm, skill).ok_or_else(lacking)
    }

    /// Success of every seed that was tested from a room.
    fn success_from(&self, cell: &Cell, room: &str) -> Result<Vec<f64>, String> {
        let index = self.summary.room(room).filter(|&room| !cell.rooms[room].is_empty());
        let index = index.ok_or_else(|| format!("There are no tests from room {room}."))?;
        Ok(super::rooms::success(cell, index))
    }

    /// Mean over seeds of what the main arm has more than another one, at their last tests.
    fn main_minus(&self, arm: &str) -> Result<Estimate, String> {
        let (main, other) = (self.root(MAIN)?, self.root(arm)?);
        difference(&main.last().scores, &other.last().scores)
    }
}

/// The test near a number of trials.
fn at(series: &Series, trials: u32) -> Result<&Cell, String> {
    series.near(trials).ok_or_else(|| format!("The arm `{}` has no test near {trials} trials.", series.arm))
}

/// A mean over seeds.
#[derive(Debug, Clone, Copy)]
struct Estimate {
    mean: f64,
    interval: Interval,
    seeds: usize,
}

impl Estimate {
    fn new(values: &[f64]) -> Self {
        Self { mean: mean(values), interval: bootstrap(values, mean, TABLE_RESAMPLES), seeds: values.len() }
    }

    /// As a share.
    fn share(&self) -> String {
        percent_with(self.mean, self.interval)
    }

    /// As a difference of shares.
    fn points(&self) -> String {
        format!("{} points", points_with(self.mean, self.interval))
    }

    /// As a share of something else's, of which `whole` is the mean.
    fn of_whole(&self, whole: f64) -> String {
        let share = |value: f64| value / whole;
        let interval = Interval { low: share(self.interval.low), high: share(self.interval.high) };
        format!("{:.1}% {}", 100.0 * share(self.mean), percent_range(interval))
    }
}

/// Success of `a` minus success of `b`, on the same seeds.
fn difference(a: &[Score], b: &[Score]) -> Result<Estimate, String> {
    let (a, b) = paired(a, b, Score::success);
    if a.is_empty() {
        return Err("The arms have no seed in common.".into());
    }
    let (mean, interval) = paired_difference(&a, &b, TABLE_RESAMPLES);
    Ok(Estimate { mean, interval, seeds: a.len() })
}

/// Holds if a lead is certain, partly if it is there.
fn lead(lead: &Estimate) -> Verdict {
    match lead.interval.low > 0.0 {
        true => Verdict::Holds,
        false if lead.mean > 0.0 => Verdict::Partly,
        false => Verdict::DoesNotHold,
    }
}
