//! Claims on equal cost and on altered worlds: section VII.

use super::evidence::{ClaimRule, Lead};
use super::verdict::{ClaimVerdict, Finding};
use crate::report::comparison::{Comparison, MAIN, median_actions, within};
use crate::report::format::{limit, number, percent, points};
use crate::report::statistics::{mean, mean_of};
use crate::report::summary::{Score, Series};
use crate::report::transfer::differences;

/// Losses of success under alterations that are small, and moderate.
const SMALL: f64 = 0.1;
const MODERATE: f64 = 0.2;

pub(super) const EQUAL_BUDGET: ClaimRule = ClaimRule {
    title: "equal cost",
    says: "At a similar cost in actions, hierarchical learning is superior.",
    rule: || {
        format!(
            "Success of `{MAIN}` minus that of the best monolithic arm, same seeds, each at its last test within the \
             smaller of the two arms' median numbers of actions (teaching and child skills counted; a seed without a \
             test by then achieves nothing): holds if the interval lies above 0, partly if only the mean does."
        )
    },
    judge: |evidence| {
        let main = evidence.root(MAIN)?;
        let comparison = Comparison::new(evidence.summary).ok_or("There is no hierarchical arm.")?;
        let at_budget = |other: &&Series| {
            let budget = median_actions(main).min(median_actions(other));
            (budget, within(main, budget), within(other, budget))
        };
        let success = |scores: &[Score]| mean(&scores.iter().map(Score::success).collect::<Vec<_>>());
        let all = comparison.monolithic.iter().map(|other| (other, at_budget(other)));
        let best = all.max_by(|(_, a), (_, b)| success(&a.2).total_cmp(&success(&b.2)));
        let (other, (budget, own, others)) = best.ok_or("There is no arm without skills below its root.")?;
        let gain = Lead::new(&own, &others)?;
        let figures = vec![
            format!("`{MAIN}` minus `{}`: {}", other.label, gain.words()),
            format!("within {} actions", number(budget.floor())),
            format!("{} against {}", percent(success(&own)), percent(success(&others))),
        ];
        Ok(Finding { figures, seeds: gain.seeds, verdict: gain.verdict() })
    },
};

pub(super) const ALTERED: ClaimRule = ClaimRule {
    title: "altered worlds",
    says: "What was learned adapts to small unexpected changes of the world without further training.",
    rule: || {
        format!(
            "Loss of success of `{MAIN}`, averaged over all alterations but `noise-*` and `*-hard`, same seeds: holds \
             up to {}, partly up to {}.",
            limit(SMALL),
            limit(MODERATE)
        )
    },
    judge: |evidence| {
        let series = evidence.root(MAIN)?;
        let small = |name: &str| !name.starts_with("noise-") && !name.ends_with("-hard");
        let elsewhere: Vec<_> = series.transfer.iter().filter(|test| small(&test.variant)).collect();
        let changes: Vec<Vec<f64>> = elsewhere.iter().map(|test| differences(series, test)).collect();
        let seeds = changes.iter().map(Vec::len).min().filter(|seeds| *seeds > 0);
        let seeds = seeds.ok_or("There are no tests of it in slightly altered worlds.")?;
        let of_seed = |seed: usize| mean(&changes.iter().map(|change| change[seed]).collect::<Vec<_>>());
        let change = mean_of(&(0..seeds).map(of_seed).collect::<Vec<_>>());
        let names: Vec<String> = elsewhere.iter().map(|test| test.variant.clone()).collect();
        Ok(Finding {
            figures: vec![
                format!("altered minus as trained: {} points", points(change)),
                format!("over {}", names.join(", ")),
            ],
            seeds,
            verdict: ClaimVerdict::from_limits(change.value, -SMALL, -MODERATE),
        })
    },
};
