//! Tables made by hand.

use skilltree::report::claims::{ClaimVerdict, judge};
use skilltree::report::summary::{Summary, summarise};
use skilltree::report::training::{self, TrainingCurve};
use skilltree::run_folder::{EvaluationRow, Names, TrialRow};

/// Trials and actions before a test, and per room: name, test trials, successes.
pub(crate) type Test<'a> = (u32, u32, &'a [(&'a str, u32, u32)]);

/// Rows with the names that they use.
#[derive(Default)]
pub(crate) struct HandMadeTables {
    pub(crate) names: Names,
    pub(crate) tests: Vec<EvaluationRow>,
    pub(crate) trials: Vec<TrialRow>,
}

/// A name, which is now known.
fn noted(names: &mut Vec<String>, name: &str) -> String {
    if !names.iter().any(|known| known == name) {
        names.push(name.to_owned());
    }
    name.to_owned()
}

impl HandMadeTables {
    /// The rows of one test of one seed; a success pays 100 and takes 50 steps, a failure takes 200.
    pub(crate) fn variant(&mut self, (arm, skill, variant): (&str, &str, &str), seed: u32, test: Test<'_>) {
        let (trials, actions, rooms) = test;
        for &(room, episodes, successes) in rooms {
            self.tests.push(EvaluationRow {
                arm: noted(&mut self.names.arms, arm),
                point: 0,
                seed,
                skill: noted(&mut self.names.skills, skill),
                trials,
                actions,
                variant: noted(&mut self.names.variants, variant),
                room: noted(&mut self.names.rooms, room),
                episodes,
                successes,
                steps: 50 * successes + 200 * (episodes - successes),
                reward: 100.0 * f64::from(successes),
                r#return: f64::from(successes),
                collisions: 0,
            });
        }
    }

    /// A test as trained.
    pub(crate) fn test(&mut self, arm: &str, skill: &str, seed: u32, test: Test<'_>) {
        self.variant((arm, skill, "trained"), seed, test);
    }

    /// The same tests of an arm's root for some seeds, after a test of another skill if the arm is to be a tree.
    pub(crate) fn arm(&mut self, arm: &str, tree: bool, seeds: u32, tests: &[Test<'_>]) {
        for seed in 0..seeds {
            if tree {
                self.test(arm, "dock", seed, (1, 10, &[("A", 10, 9)]));
            }
            for &test in tests {
                self.test(arm, "recharge", seed, test);
            }
        }
    }

    /// A training trial: steps, reward and collisions.
    pub(crate) fn trial(&mut self, arm: &str, skill: &str, seed: u32, trial: u32, outcome: (u32, f32, u32)) {
        let (steps, reward, collisions) = outcome;
        self.trials.push(TrialRow {
            arm: noted(&mut self.names.arms, arm),
            point: 0,
            seed,
            skill: noted(&mut self.names.skills, skill),
            trial,
            actions: 0,
            steps,
            reward,
            success: reward > 0.0,
            collisions,
            taught: false,
        });
    }

    pub(crate) fn summary(&self) -> Summary {
        let mut seeds: Vec<u32> = self.tests.iter().map(|row| row.seed).collect();
        seeds.sort_unstable();
        seeds.dedup();
        summarise(&self.names, &self.tests, &seeds, &[])
    }

    pub(crate) fn trainings(&self) -> Vec<TrainingCurve> {
        training::summarise(&self.summary(), &self.names, &self.trials)
    }

    /// What becomes of a claim.
    pub(crate) fn verdict(&self, number: usize) -> ClaimVerdict {
        let claims = judge(&self.summary(), &self.trainings());
        claims.iter().find(|claim| claim.number == number).map_or(ClaimVerdict::NotTested, |claim| claim.verdict)
    }
}
