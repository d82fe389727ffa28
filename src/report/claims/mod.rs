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

mod evidence;
mod hierarchy;
mod single_skills;

pub use evidence::ClaimVerdict;

use super::comparison::MAIN;
use super::summary::Summary;
use super::training::TrainingCurve;
use evidence::{Evidence, Finding};
use rayon::prelude::*;

/// What finds out about a claim, or says what the run lacks for it.
type Judge = fn(&Evidence<'_>) -> Result<Finding, String>;

/// In the order of the paper: what a claim is about, the claim in our words, and its judge.
const CLAIMS: [(&str, &str, Judge); 13] = [
    (
        "docking untaught",
        "Without lessons, some robots never learn to dock within 300 trials, and the others need most of them.",
        single_skills::docking_untaught,
    ),
    (
        "docking taught",
        "With 10 lessons, docking is learned very well, generally within 150 trials.",
        single_skills::docking_taught,
    ),
    (
        "doors and walls",
        "With lessons, passing doors and following walls are learned effectively too.",
        single_skills::doors_and_walls,
    ),
    (
        "single, far rooms",
        "After 300 trials a single Q-function generally fails from rooms B and C.",
        single_skills::far_rooms,
    ),
    ("single, collisions", "It collides on more than 5% of its steps.", single_skills::collisions),
    (
        "single, punished",
        "Punishing collisions makes it slightly better, but it still performs poorly.",
        single_skills::punished,
    ),
    (
        "tree, 20 trials",
        "Within 20 trials, the hierarchy connects from most places in rooms A and C.",
        hierarchy::early,
    ),
    ("tree, 60 trials", "Within 60 trials, it is nearly optimal from everywhere.", hierarchy::nearly_optimal),
    ("persistence", "Without the Persistence Rule, performance is poor.", hierarchy::persistence),
    (
        "thresholds",
        "Thresholds of applicability are not critical, unless they are so high that they rule out the best skill.",
        hierarchy::thresholds,
    ),
    ("equal cost", "At a similar cost in actions, hierarchical learning is superior.", hierarchy::equal_cost),
    ("TD(lambda)", "TD(lambda > 0) is more effective than TD(0).", hierarchy::td_lambda),
    (
        "altered worlds",
        "What was learned adapts to small unexpected changes of the world without further training.",
        hierarchy::altered_worlds,
    ),
];

/// A claim and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    /// In the order of the paper, from 1.
    pub number: usize,
    /// What it is about, in two or three words.
    pub title: &'static str,
    pub says: &'static str,
    /// What the run says; empty if it says nothing.
    pub figures: Vec<String>,
    pub seeds: usize,
    pub verdict: ClaimVerdict,
    /// The rule, or what is missing.
    pub why: String,
}

/// Judges all claims. A run without the main arm shows only those that it tests.
pub fn judge(summary: &Summary, trainings: &[TrainingCurve]) -> Vec<Claim> {
    let run = Evidence { summary, trainings };
    let claim = |(index, &(title, says, judge)): (usize, &(_, _, Judge))| {
        let nothing = |why| Finding { figures: Vec::new(), seeds: 0, verdict: ClaimVerdict::NotTested, rule: why };
        let Finding { figures, seeds, verdict, rule: why } = judge(&run).unwrap_or_else(nothing);
        Claim { number: index + 1, title, says, figures, seeds, verdict, why }
    };
    let mut claims: Vec<Claim> = CLAIMS.par_iter().enumerate().map(claim).collect();
    if summary.arm(MAIN).is_none() {
        claims.retain(|claim| claim.verdict != ClaimVerdict::NotTested);
    }
    claims
}
