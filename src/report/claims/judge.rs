//! Judges all claims.

use super::evidence::{ClaimRule, Evidence};
use super::verdict::{Claim, ClaimVerdict, Finding};
use super::{elementary, equal_cost, hierarchy, single};
use crate::report::comparison::MAIN;
use crate::report::summary::Summary;
use crate::report::training::TrainingCurve;
use rayon::prelude::*;

const RULES: [&ClaimRule; 13] = [
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
    &equal_cost::EQUAL_BUDGET,
    &hierarchy::TD_LAMBDA,
    &equal_cost::ALTERED,
];

/// Judges all claims. A run without the main arm shows only those that it tests.
pub fn judge(summary: &Summary, trainings: &[TrainingCurve]) -> Vec<Claim> {
    let evidence = Evidence { summary, trainings };
    let judged = RULES.par_iter().enumerate().map(|(index, rule)| {
        let (found, why) = match (rule.judge)(&evidence) {
            Ok(found) => (found, (rule.rule)()),
            Err(lacking) => (Finding { figures: Vec::new(), seeds: 0, verdict: ClaimVerdict::NotTested }, lacking),
        };
        let Finding { figures, seeds, verdict } = found;
        Claim { number: index + 1, title: rule.title, says: rule.says, figures, seeds, verdict, why }
    });
    let mut claims: Vec<Claim> = judged.collect();
    if summary.arm(MAIN).is_none() {
        claims.retain(|claim| claim.verdict != ClaimVerdict::NotTested);
    }
    claims
}
