//! Claims on the hierarchy, its two rules and its learning: sections I, VI and VII.

use super::{Estimate, Found, MAIN, Rule, Verdict, at};
use crate::report::numbers::limit;
use crate::report::summary::Score;

/// The paper's early moment, and success from rooms A and C that is good then.
const EARLY_TRIALS: u32 = 20;
const EARLY_A: f64 = 0.9;
const EARLY_C: f64 = 0.7;
/// The paper's late moment, and the share of the planner's success that is nearly optimal.
const LATE_TRIALS: u32 = 60;
const NEARLY: f64 = 0.85;
/// A loss that makes an arm poor.
const POOR: f64 = 0.25;
/// A difference that makes none.
const SAME: f64 = 0.1;
/// Arms whose thresholds should make no difference, and the one whose thresholds should.
const UNCRITICAL: [&str; 3] = ["low-thresholds", "high-thresholds", "learned-thresholds"];
const EXCLUDING: &str = "excluding-thresholds";

pub(super) const EARLY: Rule = Rule {
    title: "tree, 20 trials",
    says: "Within 20 trials, the hierarchy connects from most places in rooms A and C.",
    rule: || {
        format!(
            "After {EARLY_TRIALS} trials: holds from a mean success of {} from A and {} from C on, partly if only one \
             of the two.",
            limit(EARLY_A),
            limit(EARLY_C)
        )
    },
    judge: |evidence| {
        let cell = at(evidence.root(MAIN)?, EARLY_TRIALS)?;
        let a = Estimate::new(&evidence.success_from(cell, "A")?);
        let c = Estimate::new(&evidence.success_from(cell, "C")?);
        Ok(Found {
            figures: vec![
                format!("{} from A", a.share()),
                format!("{} from C, after {} trials", c.share(), cell.trials),
            ],
            seeds: cell.scores.len(),
            verdict: Verdict::of(&[a.mean >= EARLY_A, c.mean >= EARLY_C]),
        })
    },
};

pub(super) const NEARLY_OPTIMAL: Rule = Rule {
    title: "tree, 60 trials",
    says: "Within 60 trials, it is nearly optimal from everywhere.",
    rule: || {
        format!(
            "After {LATE_TRIALS} trials: holds if success is at least {} of the planner's from every room, partly if \
             only over all rooms.",
            limit(NEARLY)
        )
    },
    judge: |evidence| {
        let series = evidence.root(MAIN)?;
        let cell = at(series, LATE_TRIALS)?;
        let skill = evidence.summary.arm(MAIN).and_then(|arm| evidence.summary.skill(&arm.root));
        let bound = skill.and_then(|skill| skill.bound(MAIN)).filter(|bound| bound.score.successes > 0);
        let bound = bound.ok_or("The planner has no tests to compare with.")?;
        let share = |values: &[f64], whole: f64| {
            let success = Estimate::new(values);
            (success.of_whole(whole), success.mean >= NEARLY * whole)
        };
        let (overall, near) = share(&cell.values(Score::success), bound.score.success());
        let mut figures = vec![format!("after {} trials {overall} of the planner's success", cell.trials)];
        let mut everywhere = true;
        for (room, planner) in bound.rooms.iter().enumerate().filter(|(_, planner)| planner.successes > 0) {
            let name = &evidence.summary.rooms[room];
            let (text, near) = share(&evidence.success_from(cell, name)?, planner.success());
            figures.push(format!("{text} from {name}"));
            everywhere &= near;
        }
        let verdict = match near {
            true if everywhere => Verdict::Holds,
            true => Verdict::Partly,
            false => Verdict::DoesNotHold,
        };
        Ok(Found { figures, seeds: cell.scores.len(), verdict })
    },
};

pub(super) const PERSISTENCE: Rule = Rule {
    title: "persistence",
    says: "Without the Persistence Rule, performance is poor.",
    rule: || {
        format!(
            "Last tests, same seeds: holds if `no-persistence` achieves at least {} less than `{MAIN}` and the \
             interval lies above 0, partly if it only lies above 0.",
            limit(POOR)
        )
    },
    judge: |evidence| {
        let loss = evidence.main_minus("no-persistence")?;
        let verdict = if loss.interval.low > 0.0 {
            if loss.mean >= POOR { Verdict::Holds } else { Verdict::Partly }
        } else {
            Verdict::DoesNotHold
        };
        Ok(Found {
            figures: vec![format!("`{MAIN}` minus `no-persistence`: {}", loss.points())],
            seeds: loss.seeds,
            verdict,
        })
    },
};

pub(super) const THRESHOLDS: Rule = Rule {
    title: "thresholds",
    says: "Thresholds of applicability are not critical, unless they are so high that they rule out the best skill.",
    rule: || {
        format!(
            "Last tests, same seeds: holds if each of {} that is there differs from `{MAIN}` by at most {}, and \
             `{EXCLUDING}` achieves less with an interval above 0; partly if only one of the two, or the second is not \
             there.",
            UNCRITICAL.map(|arm| format!("`{arm}`")).join(", "),
            limit(SAME)
        )
    },
    judge: |evidence| {
        let there: Vec<_> = UNCRITICAL.iter().filter_map(|arm| Some((arm, evidence.main_minus(arm).ok()?))).collect();
        let Some((_, first)) = there.first() else {
            return Err(format!("There is none of the arms {}.", UNCRITICAL.map(|arm| format!("`{arm}`")).join(", ")));
        };
        let mut figures: Vec<String> =
            there.iter().map(|(arm, lead)| format!("`{MAIN}` minus `{arm}`: {}", lead.points())).collect();
        let excluded = evidence.main_minus(EXCLUDING).ok();
        figures.extend(excluded.iter().map(|lead| format!("minus `{EXCLUDING}`: {}", lead.points())));
        let same = there.iter().all(|(_, lead)| lead.mean.abs() <= SAME);
        let worse = excluded.is_some_and(|lead| lead.interval.low > 0.0);
        Ok(Found { figures, seeds: first.seeds, verdict: Verdict::of(&[same, worse]) })
    },
};

pub(super) const TD_LAMBDA: Rule = Rule {
    title: "TD(lambda)",
    says: "TD(lambda > 0) is more effective than TD(0).",
    rule: || {
        format!(
            "Last tests, same seeds: holds if `td0` achieves less than `{MAIN}` with an interval above 0, partly if \
             only the mean is."
        )
    },
    judge: |evidence| {
        let lead = evidence.main_minus("td0")?;
        let figures = vec![format!("`{MAIN}` minus `td0`: {}", lead.points())];
        Ok(Found { figures, seeds: lead.seeds, verdict: super::lead(&lead) })
    },
};
