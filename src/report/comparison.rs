//! The paper's comparison: arms that learn one task with skills below their roots and without.

use super::statistics::{quantile, sorted};
use super::summary::{Score, Series, SkillSummary, Summary};

/// The arm that stands for the paper's hierarchical learning, where a run has it.
pub const MAIN: &str = "hierarchical";
/// The arm that stands for the paper's single Q-function, where a run has it.
pub const SINGLE: &str = "monolithic";

/// Arms with the same root skill.
#[derive(Debug, Clone)]
pub struct Comparison<'a> {
    pub skill: &'a SkillSummary,
    /// Arms with skills below it: [`MAIN`] first, or else in the order of the rows.
    pub hierarchical: Vec<&'a Series>,
    /// Arms without: [`SINGLE`] first, or else in the order of the rows.
    pub monolithic: Vec<&'a Series>,
}

impl<'a> Comparison<'a> {
    /// None for a run without an arm that has skills below its root.
    pub fn new(summary: &'a Summary) -> Option<Self> {
        let trees = || summary.arms.iter().filter(|arm| arm.hierarchical);
        let main = trees().find(|arm| arm.name == MAIN).or_else(|| trees().next())?;
        let skill = summary.skill(&main.root)?;
        let of = |hierarchical: bool, first: &str| {
            let member = |series: &&Series| {
                let arm = summary.arm(&series.arm);
                arm.is_some_and(|arm| arm.root == skill.name && arm.hierarchical == hierarchical)
            };
            let mut members: Vec<&Series> = skill.series.iter().filter(member).collect();
            members.sort_by_key(|series| series.arm != first);
            members
        };
        let hierarchical = of(true, MAIN);
        (!hierarchical.is_empty()).then(|| Self { skill, hierarchical, monolithic: of(false, SINGLE) })
    }

    /// The first hierarchical and the first monolithic arm.
    pub fn leaders(&self) -> impl Iterator<Item = &'a Series> {
        self.hierarchical.first().into_iter().chain(self.monolithic.first()).copied()
    }
}

/// Median over seeds of all actions that a series took, in teaching and for child skills too.
pub fn median_actions(series: &Series) -> f64 {
    let actions: Vec<f64> = series.last().values(|score| f64::from(score.actions));
    quantile(&sorted(&actions), 0.5)
}

/// Each seed's last test within a budget of actions; a seed that had none by then counts as one that achieves nothing.
pub fn within(series: &Series, budget: f64) -> Vec<Score> {
    let last = |seed: usize| {
        let mut tests = series.tests.iter().map(|test| test.scores[seed]);
        let nothing = Score { seed: series.last().scores[seed].seed, episodes: 1, ..Score::default() };
        tests.rfind(|score| f64::from(score.actions) <= budget).unwrap_or(nothing)
    };
    (0..series.last().scores.len()).map(last).collect()
}
