//! The summary that the terminal shows: one line per arm at an early test and at the last, and one per claim.

use super::claims::Claim;
use super::comparison::Comparison;
use super::figures::with_copies;
use super::rooms;
use super::statistics::{TABLE_RESAMPLES, bootstrap, mean, share_below};
use super::summary::{Cell, Score, Skill, Summary};
use std::fmt::Write as _;

/// Besides the last test, the early one nearest to this number of training trials is shown.
pub(super) const EARLY_TRIALS: u32 = 150;

/// Greedy success per skill and arm, with intervals over seeds, by room, the claims, and the warnings.
pub fn table(summary: &Summary, claims: &[Claim]) -> String {
    let mut text = String::new();
    for skill in &summary.skills {
        text.push_str(&skill_lines(skill));
    }
    if let Some(comparison) = Comparison::new(summary) {
        text.push_str(&room_lines(&comparison, &summary.rooms));
    }
    if !claims.is_empty() {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "\nThe paper's claims, as this run judges them; the rules are in the report");
    }
    for claim in claims {
        let figures = if claim.figures.is_empty() { claim.why.clone() } else { claim.figures.join("; ") };
        let (number, title, verdict) = (claim.number, claim.title, claim.verdict.words());
        let _ = writeln!(text, "  {number:>2} {title:<18} {verdict:<15} {}", figures.replace('`', ""));
    }
    for warning in summary.cautions() {
        let _ = writeln!(text, "note: {warning}");
    }
    text.push('\n');
    text
}

fn skill_lines(skill: &Skill) -> String {
    let mut text = String::new();
    let _ =
        writeln!(text, "\n{}: greedy test trials; mean over seeds [95 % percentile bootstrap interval]", skill.name);
    let shown = if skill.never_ends() { "return" } else { "success" };
    let (last, arm) = (if skill.never_ends() { "" } else { "seeds < 50 %" }, "arm");
    let _ = writeln!(text, "  {arm:<24} {:>6} {:>6}  {shown:<23} {:>6} {last:>13}", "trials", "seeds", "steps");
    for (series, copies) in skill.distinct() {
        let (early, last) = (series.nearest(EARLY_TRIALS), series.last());
        let cells = if early.trials == last.trials { vec![last] } else { vec![early, last] };
        for cell in cells {
            let (label, trials, seeds) = (with_copies(series, &copies), cell.trials, cell.scores.len());
            let steps = mean(&cell.values(Score::steps_per_trial));
            let (range, failing) = match skill.never_ends() {
                true => (returns(cell), String::new()),
                false => {
                    let success = cell.values(Score::success);
                    (share(&success), format!("{:.0} %", 100.0 * share_below(&success, 0.5)))
                }
            };
            let _ = writeln!(text, "  {label:<24} {trials:>6} {seeds:>6}  {range:<23} {steps:>6.1} {failing:>13}");
        }
    }
    for bound in &skill.bounds {
        let score = &bound.score;
        let range = match skill.never_ends() {
            true => format!("{:6.2}", score.return_per_trial()),
            false => format!("{:5.1} %", 100.0 * score.success()),
        };
        let label = bound.arm.as_ref().map_or("planner (bound)".to_owned(), |arm| format!("planner for {arm}"));
        let steps = score.steps_per_trial();
        let _ = writeln!(text, "  {label:<24} {:>6} {:>6}  {range:<23} {steps:>6.1}", "", "");
    }
    text
}

fn room_lines(comparison: &Comparison<'_>, names: &[String]) -> String {
    let mut text = String::new();
    let shown = rooms::of(comparison, names);
    let _ = writeln!(text, "\n{}: success by starting room, after the last trial", comparison.skill.name);
    for series in comparison.leaders() {
        let cell = series.last();
        let rates = shown.iter().filter(|(room, _)| !cell.rooms[*room].is_empty());
        let rates = rates.map(|(room, name)| format!("{name} {}", share(&rooms::success(cell, *room)).trim_start()));
        let _ = writeln!(text, "  {:<24} {}", series.label, rates.collect::<Vec<_>>().join("   "));
    }
    if let Some(bound) = comparison.skill.bound(&comparison.hierarchical[0].arm) {
        let rates =
            shown.iter().map(|&(room, name)| (name, &bound.rooms[room])).filter(|(_, score)| score.episodes > 0);
        let rates = rates.map(|(name, score)| format!("{name} {:.1} %", 100.0 * score.success()));
        let _ = writeln!(text, "  {:<24} {}", "planner (bound)", rates.collect::<Vec<_>>().join("   "));
    }
    text
}

fn share(success: &[f64]) -> String {
    let interval = bootstrap(success, mean, TABLE_RESAMPLES);
    format!("{:5.1} % [{:.1}, {:.1}]", 100.0 * mean(success), 100.0 * interval.low, 100.0 * interval.high)
}

fn returns(cell: &Cell) -> String {
    let values = cell.values(Score::return_per_trial);
    let interval = bootstrap(&values, mean, TABLE_RESAMPLES);
    format!("{:6.2} [{:.2}, {:.2}]", mean(&values), interval.low, interval.high)
}
