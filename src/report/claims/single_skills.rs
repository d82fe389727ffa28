//! Claims on elementary skills, section V, and on the single Q-function without a hierarchy, section VII.

use super::evidence::{ClaimVerdict, Evidence, Finding, Lead, at};
use crate::report::comparison::{MAIN, SINGLE};
use crate::report::format::{limit, number, share};
use crate::report::statistics::{TABLE_RESAMPLES, mean_of, sorted};
use crate::report::summary::Score;
use crate::report::training::{of_series, pooled};

/// Trials with lessons that learn to dock; untaught docking has twice as many.
const TAUGHT_TRIALS: u32 = 150;
/// Success that is very good.
const VERY_GOOD: f64 = 0.9;
/// The arm that is punished for collisions.
const PENALTY: &str = "monolithic-penalty";

pub(super) fn docking_untaught(run: &Evidence<'_>) -> Result<Finding, String> {
    // The paper's 2 of 7 lie between these shares of robots that fail.
    let (least, most) = (0.1, 0.6);
    let (failed, learned, trials) = (0.5, 0.8, 2 * TAUGHT_TRIALS);
    let series = run.root("docking-untaught")?;
    let success = at(series, trials)?.values(Score::success);
    let fails = |&success: &f64| f64::from(u8::from(success < failed));
    let failing = mean_of(&success.iter().map(fails).collect::<Vec<_>>());
    let learners = success.iter().zip(series.trials_to(learned)).filter(|(success, _)| **success >= failed);
    // A seed that never got there needed more than all others. No mean of two middle values: they may be infinite.
    let needed: Vec<f64> = learners.map(|(_, trials)| trials.map_or(f64::INFINITY, f64::from)).collect();
    let median = sorted(&needed).get(needed.len() / 2).copied();
    let needs = match median {
        None => "no other seeds".to_owned(),
        Some(f64::INFINITY) => format!("the others' median needs more than {} trials", series.last().trials),
        Some(median) => format!("the others' median needs {} trials", number(median)),
    };
    let slow = median.is_some_and(|median| median >= f64::from(TAUGHT_TRIALS));
    Ok(Finding {
        figures: vec![format!("{} of seeds fail", share(failing)), needs],
        seeds: success.len(),
        verdict: ClaimVerdict::of(&[(least..=most).contains(&failing.value), slow]),
        rule: format!(
            "Holds if {} to {} of the seeds achieve less than {} of their tests after {trials} trials, and the median \
             of the other seeds needs at least {TAUGHT_TRIALS} trials to {}; partly if only one of the two.",
            limit(least),
            limit(most),
            limit(failed),
            limit(learned),
        ),
    })
}

pub(super) fn docking_taught(run: &Evidence<'_>) -> Result<Finding, String> {
    let good = 0.75;
    let series = run.root("docking-taught").or_else(|_| run.skill(MAIN, "dock"))?;
    let test = at(series, TAUGHT_TRIALS)?;
    let success = mean_of(&test.values(Score::success));
    Ok(Finding {
        figures: vec![format!("{} achieved after {} trials", share(success), test.trials)],
        seeds: test.scores.len(),
        verdict: ClaimVerdict::from_limits(success.value, VERY_GOOD, good),
        rule: format!(
            "Holds from a mean success of {} after {TAUGHT_TRIALS} trials on, partly from {} on.",
            limit(VERY_GOOD),
            limit(good)
        ),
    })
}

pub(super) fn doors_and_walls(run: &Evidence<'_>) -> Result<Finding, String> {
    // Of the planner's return.
    let good_following = 0.74;
    let doors = run.skill(MAIN, "pass-door")?.last();
    let passing = mean_of(&doors.values(Score::success));
    let following = mean_of(&run.skill(MAIN, "follow-right")?.last().values(Score::return_per_trial));
    let bound = run.summary.skill("follow-right").and_then(|skill| skill.bound(MAIN));
    let bound = bound.map(|bound| bound.score.return_per_trial()).filter(|bound| *bound > 0.0);
    let bound = bound.ok_or("The planner has no return of `follow-right` to compare with.")?;
    Ok(Finding {
        figures: vec![
            format!("{} of doors passed", share(passing)),
            format!("{} of the planner's return along walls", share(following.over(bound))),
        ],
        seeds: doors.scores.len(),
        verdict: ClaimVerdict::of(&[passing.value >= VERY_GOOD, following.value >= good_following * bound]),
        rule: format!(
            "Holds from a mean success of `pass-door` of {} on, with a return of `follow-right` of at least {} of the \
             planner's; partly if only one of the two.",
            limit(VERY_GOOD),
            limit(good_following)
        ),
    })
}

pub(super) fn far_rooms(run: &Evidence<'_>) -> Result<Finding, String> {
    let fails = 0.5;
    let test = run.root(SINGLE)?.last();
    let (b, c) = (run.success_from(test, "B")?, run.success_from(test, "C")?);
    Ok(Finding {
        figures: vec![format!("{} from B", share(b)), format!("{} from C, after {} trials", share(c), test.trials)],
        seeds: test.scores.len(),
        verdict: ClaimVerdict::of(&[b.high < fails, c.high < fails]),
        rule: format!(
            "Holds if the success of `{SINGLE}` at its last test is below {}, the interval's upper end counted, from B \
             and from C; partly if only from one.",
            limit(fails)
        ),
    })
}

pub(super) fn collisions(run: &Evidence<'_>) -> Result<Finding, String> {
    let often = 0.05;
    let training = of_series(run.trainings, run.root(SINGLE)?);
    let training = training.ok_or_else(|| format!("There are no training trials of `{SINGLE}`."))?;
    let sums = training.sums_by_seed(0);
    let rate = pooled(&sums, Score::collisions_and_steps, TABLE_RESAMPLES);
    Ok(Finding {
        figures: vec![format!("{} of steps collide", share(rate))],
        seeds: sums.len(),
        verdict: ClaimVerdict::surely(rate.low > often, rate.value > often),
        rule: format!(
            "Collisions over steps of all training trials of `{SINGLE}`: holds if the interval lies above {}, partly \
             if only the mean does.",
            limit(often)
        ),
    })
}

pub(super) fn punished(run: &Evidence<'_>) -> Result<Finding, String> {
    let good = 0.8;
    let (punished, single) = (run.root(PENALTY)?.last(), run.root(SINGLE)?.last());
    let success = mean_of(&punished.values(Score::success));
    let gain = Lead::new(&punished.scores, &single.scores)?;
    let lead = run.main_minus(PENALTY)?;
    let poor = success.value < good && lead.by.value > 0.0;
    Ok(Finding {
        figures: vec![
            format!("{} achieved", share(success)),
            format!("minus `{SINGLE}`: {}", gain.words()),
            format!("`{MAIN}` minus it: {}", lead.words()),
        ],
        seeds: punished.scores.len(),
        verdict: ClaimVerdict::surely(poor && gain.by.value > 0.0, poor),
        rule: format!(
            "Last tests: holds if `{PENALTY}` achieves more than `{SINGLE}` on the same seeds, less than {}, and less \
             than `{MAIN}`; partly if poor as that, but not better.",
            limit(good)
        ),
    })
}
