//! Claims on the hierarchy, its two rules, its learning, its cost and altered worlds: sections I, VI and VII.

use super::evidence::{ClaimVerdict, Evidence, Finding, Lead, at};
use crate::report::comparison::{Comparison, MAIN, median_actions, within};
use crate::report::format::{limit, number, percent, points, share};
use crate::report::statistics::{mean, mean_of};
use crate::report::summary::{Score, Series};
use crate::report::transfer::differences;

/// Arms whose thresholds should make no difference, and the one whose thresholds should.
const UNCRITICAL: [&str; 3] = ["low-thresholds", "high-thresholds", "learned-thresholds"];
const EXCLUDING: &str = "excluding-thresholds";

pub(super) fn early(run: &Evidence<'_>) -> Result<Finding, String> {
    let (trials, good_from_a, good_from_c) = (20, 0.9, 0.7);
    let test = at(run.root(MAIN)?, trials)?;
    let (a, c) = (run.success_from(test, "A")?, run.success_from(test, "C")?);
    Ok(Finding {
        figures: vec![format!("{} from A", share(a)), format!("{} from C, after {} trials", share(c), test.trials)],
        seeds: test.scores.len(),
        verdict: ClaimVerdict::of(&[a.value >= good_from_a, c.value >= good_from_c]),
        rule: format!(
            "After {trials} trials: holds from a mean success of {} from A and {} from C on, partly if only one of the \
             two.",
            limit(good_from_a),
            limit(good_from_c)
        ),
    })
}

pub(super) fn nearly_optimal(run: &Evidence<'_>) -> Result<Finding, String> {
    // Of the planner's success.
    let (trials, nearly) = (60, 0.85);
    let test = at(run.root(MAIN)?, trials)?;
    let skill = run.summary.arm(MAIN).and_then(|arm| run.summary.skill(&arm.root));
    let bound = skill.and_then(|skill| skill.bound(MAIN)).filter(|bound| bound.score.successes > 0);
    let bound = bound.ok_or("The planner has no tests to compare with.")?;
    let (overall, whole) = (mean_of(&test.values(Score::success)), bound.score.success());
    let near = overall.value >= nearly * whole;
    let mut everywhere = near;
    let mut figures =
        vec![format!("after {} trials {} of the planner's success", test.trials, share(overall.over(whole)))];
    for (name, planner) in run.summary.rooms.iter().zip(&bound.rooms).filter(|(_, planner)| planner.successes > 0) {
        let success = run.success_from(test, name)?;
        figures.push(format!("{} from {name}", share(success.over(planner.success()))));
        everywhere &= success.value >= nearly * planner.success();
    }
    Ok(Finding {
        figures,
        seeds: test.scores.len(),
        verdict: ClaimVerdict::surely(everywhere, near),
        rule: format!(
            "After {trials} trials: holds if success is at least {} of the planner's from every room, partly if only \
             over all rooms.",
            limit(nearly)
        ),
    })
}

pub(super) fn persistence(run: &Evidence<'_>) -> Result<Finding, String> {
    let poor = 0.25;
    let loss = run.main_minus("no-persistence")?;
    Ok(Finding {
        figures: vec![format!("`{MAIN}` minus `no-persistence`: {}", loss.words())],
        seeds: loss.seeds,
        verdict: ClaimVerdict::surely(loss.by.low > 0.0 && loss.by.value >= poor, loss.by.low > 0.0),
        rule: format!(
            "Last tests, same seeds: holds if `no-persistence` achieves at least {} less than `{MAIN}` and the \
             interval lies above 0, partly if it only lies above 0.",
            limit(poor)
        ),
    })
}

pub(super) fn thresholds(run: &Evidence<'_>) -> Result<Finding, String> {
    let most_difference = 0.1;
    let uncritical = UNCRITICAL.map(|arm| format!("`{arm}`")).join(", ");
    let there: Vec<_> = UNCRITICAL.iter().filter_map(|arm| Some((arm, run.main_minus(arm).ok()?))).collect();
    let (_, first) = there.first().ok_or_else(|| format!("There is none of the arms {uncritical}."))?;
    let excluded = run.main_minus(EXCLUDING).ok();
    let figures = there.iter().map(|(arm, lead)| format!("`{MAIN}` minus `{arm}`: {}", lead.words()));
    let excluding = excluded.iter().map(|lead| format!("minus `{EXCLUDING}`: {}", lead.words()));
    let same = there.iter().all(|(_, lead)| lead.by.value.abs() <= most_difference);
    let worse = excluded.as_ref().is_some_and(|lead| lead.by.low > 0.0);
    Ok(Finding {
        figures: figures.chain(excluding).collect(),
        seeds: first.seeds,
        verdict: ClaimVerdict::of(&[same, worse]),
        rule: format!(
            "Last tests, same seeds: holds if each of {uncritical} that is there differs from `{MAIN}` by at most {}, \
             and `{EXCLUDING}` achieves less with an interval above 0; partly if only one of the two, or the second is \
             not there.",
            limit(most_difference)
        ),
    })
}

pub(super) fn equal_cost(run: &Evidence<'_>) -> Result<Finding, String> {
    let main = run.root(MAIN)?;
    let comparison = Comparison::new(run.summary).ok_or("There is no hierarchical arm.")?;
    let at_budget = |other: &&Series| {
        let budget = median_actions(main).min(median_actions(other));
        (budget, within(main, budget), within(other, budget))
    };
    let success = |scores: &[Score]| mean(&scores.iter().map(Score::success).collect::<Vec<_>>());
    let all = comparison.monolithic.iter().map(|other| (other, at_budget(other)));
    let best = all.max_by(|(_, a), (_, b)| success(&a.2).total_cmp(&success(&b.2)));
    let (other, (budget, own, others)) = best.ok_or("There is no arm without skills below its root.")?;
    let gain = Lead::new(&own, &others)?;
    Ok(Finding {
        figures: vec![
            format!("`{MAIN}` minus `{}`: {}", other.label, gain.words()),
            format!("within {} actions", number(budget.floor())),
            format!("{} against {}", percent(success(&own)), percent(success(&others))),
        ],
        seeds: gain.seeds,
        verdict: gain.verdict(),
        rule: format!(
            "Success of `{MAIN}` minus that of the best monolithic arm, same seeds, each at its last test within the \
             smaller of the two arms' median numbers of actions (teaching and child skills counted; a seed without a \
             test by then achieves nothing): holds if the interval lies above 0, partly if only the mean does."
        ),
    })
}

pub(super) fn td_lambda(run: &Evidence<'_>) -> Result<Finding, String> {
    let lead = run.main_minus("td0")?;
    Ok(Finding {
        figures: vec![format!("`{MAIN}` minus `td0`: {}", lead.words())],
        seeds: lead.seeds,
        verdict: lead.verdict(),
        rule: format!(
            "Last tests, same seeds: holds if `td0` achieves less than `{MAIN}` with an interval above 0, partly if \
             only the mean is."
        ),
    })
}

pub(super) fn altered_worlds(run: &Evidence<'_>) -> Result<Finding, String> {
    let (small, moderate) = (0.1, 0.2);
    let series = run.root(MAIN)?;
    let slight = |name: &str| !name.starts_with("noise-") && !name.ends_with("-hard");
    let elsewhere: Vec<_> = series.transfer.iter().filter(|test| slight(&test.variant)).collect();
    let changes: Vec<Vec<f64>> = elsewhere.iter().map(|test| differences(series, test)).collect();
    let seeds = changes.iter().map(Vec::len).min().filter(|seeds| *seeds > 0);
    let seeds = seeds.ok_or("There are no tests of it in slightly altered worlds.")?;
    let of_seed = |seed: usize| mean(&changes.iter().map(|change| change[seed]).collect::<Vec<_>>());
    let change = mean_of(&(0..seeds).map(of_seed).collect::<Vec<_>>());
    let names: Vec<&str> = elsewhere.iter().map(|test| test.variant.as_str()).collect();
    Ok(Finding {
        figures: vec![
            format!("altered minus as trained: {} points", points(change)),
            format!("over {}", names.join(", ")),
        ],
        seeds,
        verdict: ClaimVerdict::from_limits(change.value, -small, -moderate),
        rule: format!(
            "Loss of success of `{MAIN}`, averaged over all alterations but `noise-*` and `*-hard`, same seeds: holds \
             up to {}, partly up to {}.",
            limit(small),
            limit(moderate)
        ),
    })
}
