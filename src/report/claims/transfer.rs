//! Claims on equal cost and on altered worlds: section VII.

use super::{Estimate, Found, MAIN, Rule, Verdict, difference, lead};
use crate::report::alterations::differences;
use crate::report::comparison::{Comparison, median_actions, within};
use crate::report::numbers::{limit, number, percent};
use crate::report::statistics::mean;
use crate::report::summary::{Score, Series};

/// Losses of success under alterations that are small, and moderate.
const SMALL: f64 = 0.1;
const MODERATE: f64 = 0.2;

pub(super) const EQUAL_BUDGET: Rule = Rule {
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
        let gain = difference(&own, &others)?;
        let figures = vec![
            format!("`{MAIN}` minus `{}`: {}", other.label, gain.points()),
            format!("within {} actions", number(budget.floor())),
            format!("{} against {}", percent(success(&own)), percent(success(&others))),
        ];
        Ok(Found { figures, seeds: gain.seeds, verdict: lead(&gain) })
    },
};

pub(super) const ALTERED: Rule = Rule {
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
        let altered: Vec<_> = series.altered.iter().filter(|altered| small(&altered.variant)).collect();
        let changes: Vec<Vec<f64>> = altered.iter().map(|altered| differences(series, altered)).collect();
        let seeds = changes.iter().map(Vec::len).min().filter(|seeds| *seeds > 0);
        let seeds = seeds.ok_or("There are no tests of it in slightly altered worlds.")?;
        let of_seed = |seed: usize| mean(&changes.iter().map(|change| change[seed]).collect::<Vec<_>>());
        let change = Estimate::new(&(0..seeds).map(of_seed).collect::<Vec<_>>());
        let names: Vec<String> = altered.iter().map(|altered| altered.variant.clone()).collect();
        Ok(Found {
            figures: vec![
                format!("altered minus as trained: {}", change.points()),
                format!("over {}", names.join(", ")),
            ],
            seeds,
            verdict: Verdict::from_limits(change.mean, -SMALL, -MODERATE),
        })
    },
};
