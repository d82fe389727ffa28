//! Claims on the hierarchy, its two rules and its learning: sections I, VI and VII.

use super::evidence::{ClaimRule, at};
use super::verdict::{ClaimVerdict, Finding};
use crate::report::comparison::MAIN;
use crate::report::format::{limit, share};
use crate::report::statistics::mean_of;
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

pub(super) const EARLY: ClaimRule = ClaimRule {
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
        let test = at(evidence.root(MAIN)?, EARLY_TRIALS)?;
        let a = mean_of(&evidence.success_from(test, "A")?);
        let c = mean_of(&evidence.success_from(test, "C")?);
        Ok(Finding {
            figures: vec![format!("{} from A", share(a)), format!("{} from C, after {} trials", share(c), test.trials)],
            seeds: test.scores.len(),
            verdict: ClaimVerdict::of(&[a.value >= EARLY_A, c.value >= EARLY_C]),
        })
    },
};

pub(super) const NEARLY_OPTIMAL: ClaimRule = ClaimRule {
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
        let test = at(series, LATE_TRIALS)?;
        let skill = evidence.summary.arm(MAIN).and_then(|arm| evidence.summary.skill(&arm.root));
        let bound = skill.and_then(|skill| skill.bound(MAIN)).filter(|bound| bound.score.successes > 0);
        let bound = bound.ok_or("The planner has no tests to compare with.")?;
        let of_planner = |values: &[f64], whole: f64| {
            let success = mean_of(values);
            (share(success.over(whole)), success.value >= NEARLY * whole)
        };
        let (overall, near) = of_planner(&test.values(Score::success), bound.score.success());
        let mut figures = vec![format!("after {} trials {overall} of the planner's success", test.trials)];
        let mut everywhere = true;
        for (room, planner) in bound.rooms.iter().enumerate().filter(|(_, planner)| planner.successes > 0) {
            let name = &evidence.summary.rooms[room];
            let (text, near) = of_planner(&evidence.success_from(test, name)?, planner.success());
            figures.push(format!("{text} from {name}"));
            everywhere &= near;
        }
        Ok(Finding { figures, seeds: test.scores.len(), verdict: ClaimVerdict::surely(near && everywhere, near) })
    },
};

pub(super) const PERSISTENCE: ClaimRule = ClaimRule {
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
        Ok(Finding {
            figures: vec![format!("`{MAIN}` minus `no-persistence`: {}", loss.words())],
            seeds: loss.seeds,
            verdict: ClaimVerdict::surely(loss.by.low > 0.0 && loss.by.value >= POOR, loss.by.low > 0.0),
        })
    },
};

pub(super) const THRESHOLDS: ClaimRule = ClaimRule {
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
            there.iter().map(|(arm, lead)| format!("`{MAIN}` minus `{arm}`: {}", lead.words())).collect();
        let excluded = evidence.main_minus(EXCLUDING).ok();
        figures.extend(excluded.iter().map(|lead| format!("minus `{EXCLUDING}`: {}", lead.words())));
        let same = there.iter().all(|(_, lead)| lead.by.value.abs() <= SAME);
        let worse = excluded.is_some_and(|lead| lead.by.low > 0.0);
        Ok(Finding { figures, seeds: first.seeds, verdict: ClaimVerdict::of(&[same, worse]) })
    },
};

pub(super) const TD_LAMBDA: ClaimRule = ClaimRule {
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
        let figures = vec![format!("`{MAIN}` minus `td0`: {}", lead.words())];
        Ok(Finding { figures, seeds: lead.seeds, verdict: lead.verdict() })
    },
};
