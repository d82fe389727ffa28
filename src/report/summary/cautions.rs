//! What the reader of a report must mind.

use super::scores::Summary;
use crate::run_folder::Divergence;

/// Warnings that a reader will read; a sweep may have one per point.
const MOST_WARNINGS: usize = 12;
/// Learners that the warning of diverged ones names.
const MOST_NAMED: usize = 5;
/// Intervals over fewer seeds than this are too narrow to trust (simulated coverage is below 92 percent).
const FEW_SEEDS: usize = 10;

/// Gaps in the data, learners that diverged, and too few seeds.
pub fn cautions(summary: &Summary) -> Vec<String> {
    let mut cautions: Vec<String> = summary.warnings.iter().take(MOST_WARNINGS).cloned().collect();
    if summary.warnings.len() > MOST_WARNINGS {
        cautions.push(format!("And {} more of this kind.", summary.warnings.len() - MOST_WARNINGS));
    }
    cautions.extend(diverged(&summary.diverged));
    let series = summary.skills.iter().flat_map(|skill| &skill.series);
    if let Some(few) = series.map(|series| series.last().scores.len()).min().filter(|&count| count < FEW_SEEDS) {
        cautions.push(format!(
            "Only {few} seeds: bootstrap intervals over fewer than {FEW_SEEDS} seeds are too narrow (with 7, a nominal \
             95% interval holds the truth in 81 to 87% of cases). Run at least 30 seeds before drawing conclusions."
        ));
    }
    if summary.skills.is_empty() {
        cautions.push("The run holds no tests.".into());
    }
    cautions
}

/// Names the learners that diverged, if there are any.
fn diverged(diverged: &[Divergence]) -> Option<String> {
    let name = |learner: &Divergence| {
        let Divergence { arm, point, seed, skill, trial, .. } = learner;
        format!("{arm}, point {point}, seed {seed} in trial {trial} of {skill}")
    };
    let named: Vec<String> = diverged.iter().take(MOST_NAMED).map(name).collect();
    let more = diverged.len().saturating_sub(MOST_NAMED);
    let more = if more > 0 { format!("; and {more} more") } else { String::new() };
    let count = if diverged.len() == 1 { "1 learner".to_owned() } else { format!("{} learners", diverged.len()) };
    (!named.is_empty()).then(|| {
        format!(
            "{count} diverged, as a number stopped being finite ({}{more}). All later tests of such a learner count as \
             failed; curves of training hold its trials up to then.",
            named.join("; ")
        )
    })
}
