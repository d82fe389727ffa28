//! The summary that the terminal shows: one line per arm at an early test and at the last.

use super::statistics::{TABLE_RESAMPLES, bootstrap, mean, share_below};
use super::summary::{Score, Summary};
use std::fmt::Write as _;

/// Besides the last test, the early one nearest to this number of training trials is shown.
pub(super) const EARLY_TRIALS: u32 = 150;

/// Greedy success per skill and arm, with intervals over seeds, and the warnings.
pub fn table(summary: &Summary) -> String {
    let mut text = String::new();
    for skill in &summary.skills {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "\n{}: greedy test trials; mean over seeds [95 % bootstrap interval]", skill.name);
        let _ = writeln!(
            text,
            "  {:<20} {:>6} {:>6}  {:<23} {:>6} {:>13}",
            "arm", "trials", "seeds", "success", "steps", "seeds < 50 %"
        );
        for series in &skill.series {
            let (early, last) = (series.nearest(EARLY_TRIALS), series.last());
            let cells = if early.trials == last.trials { vec![last] } else { vec![early, last] };
            for cell in cells {
                let success = cell.values(Score::success);
                let interval = bootstrap(&success, mean, TABLE_RESAMPLES);
                let percent = |share: f64| 100.0 * share;
                let range = format!(
                    "{:5.1} % [{:.1}, {:.1}]",
                    percent(mean(&success)),
                    percent(interval.low),
                    percent(interval.high)
                );
                let steps = mean(&cell.values(Score::steps_per_trial));
                let failing = format!("{:.0} %", percent(share_below(&success, 0.5)));
                let (label, trials, seeds) = (&series.label, cell.trials, success.len());
                let _ = writeln!(text, "  {label:<20} {trials:>6} {seeds:>6}  {range:<23} {steps:>6.1} {failing:>13}");
            }
        }
        if let Some(planner) = &skill.planner {
            let (success, steps) = (100.0 * planner.success(), planner.steps_per_trial());
            let range = format!("{success:5.1} %");
            let _ = writeln!(text, "  {:<20} {:>6} {:>6}  {range:<23} {steps:>6.1}", "planner (bound)", "", "");
        }
    }
    for warning in &summary.warnings {
        let _ = writeln!(text, "note: {warning}");
    }
    text.push('\n');
    text
}
