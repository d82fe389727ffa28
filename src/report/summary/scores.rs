//! Scores of learners by skill, arm, sweep point, test and seed.

use crate::run_folder::Divergence;
use std::collections::BTreeMap;

/// One score per room, by training trials (or by variant) and seed.
pub(super) type ScoresByTest = BTreeMap<u32, BTreeMap<u32, Vec<Score>>>;
/// Skill, arm and sweep point.
pub(super) type SeriesKey = (u32, u32, u32);

/// Trials of one learner, summed: those of a test, or successive ones in training.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Score {
    pub seed: u32,
    /// Primitive actions executed up to the test.
    pub actions: u32,
    pub episodes: u64,
    /// Trials that ended as achieved.
    pub successes: u64,
    pub steps: u64,
    /// Steps with contact.
    pub collisions: u64,
    /// Sum of rewards.
    pub reward: f64,
    /// Sum of rewards, discounted from the start of each trial.
    pub returned: f64,
    /// Sum over trials of reward per step of the trial; in training alone.
    pub ratios: f64,
}

impl Score {
    /// Share of trials that ended as achieved. Episodes are never 0 in a summary.
    pub fn success(&self) -> f64 {
        self.successes as f64 / self.episodes as f64
    }

    /// Mean steps of a trial, failed ones counted with their step limit.
    pub fn steps_per_trial(&self) -> f64 {
        self.steps as f64 / self.episodes as f64
    }

    /// Collisions per primitive step, 0 if there was no step.
    pub fn collisions_per_step(&self) -> f64 {
        self.collisions as f64 / self.steps.max(1) as f64
    }

    /// Reward per primitive step: the y axis of the paper's Figure 2.
    pub fn reward_per_step(&self) -> f64 {
        self.reward / self.steps.max(1) as f64
    }

    /// Mean discounted return of a trial.
    pub fn return_per_trial(&self) -> f64 {
        self.returned / self.episodes as f64
    }

    /// What the mean reward per step of all trials together is made from.
    pub fn reward_and_steps(&self) -> (f64, f64) {
        (self.reward, self.steps as f64)
    }

    /// What the mean of each trial's own reward per step is made from.
    pub fn ratios_and_trials(&self) -> (f64, f64) {
        (self.ratios, self.episodes as f64)
    }

    /// What the mean rate of collisions is made from.
    pub fn collisions_and_steps(&self) -> (f64, f64) {
        (self.collisions as f64, self.steps as f64)
    }

    pub(in crate::report) fn add(&mut self, other: &Self) {
        self.seed = other.seed;
        self.actions = self.actions.max(other.actions);
        self.episodes += other.episodes;
        self.successes += other.successes;
        self.steps += other.steps;
        self.collisions += other.collisions;
        self.reward += other.reward;
        self.returned += other.returned;
        self.ratios += other.ratios;
    }
}

/// All seeds of one series after the same number of training trials.
#[derive(Debug, Clone, PartialEq)]
pub struct SeedScores {
    /// Training trials of the skill.
    pub trials: u32,
    /// One score per seed over all starting rooms, by ascending seed.
    pub scores: Vec<Score>,
    /// The same for each of the summary's rooms; seeds without a test from there are left out.
    pub rooms: Vec<Vec<Score>>,
}

impl SeedScores {
    /// One number per seed.
    pub fn values(&self, of: fn(&Score) -> f64) -> Vec<f64> {
        self.scores.iter().map(of).collect()
    }
}

/// Tests of one series after its last trial, in an altered world or with other noise, without training there.
#[derive(Debug, Clone, PartialEq)]
pub struct TransferTest {
    /// The alteration's name.
    pub variant: String,
    /// One score per seed, by ascending seed.
    pub scores: Vec<Score>,
}

/// One skill of one arm at one sweep point, through training.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    pub arm: String,
    pub point: u32,
    /// The arm's name, with the sweep point if there are several.
    pub label: String,
    /// Tests with all of the series' seeds, by ascending trials. At least one.
    pub tests: Vec<SeedScores>,
    /// Tests elsewhere, in the order of the rows.
    pub transfer: Vec<TransferTest>,
}

impl Series {
    /// The last test: the finished skill.
    pub fn last(&self) -> &SeedScores {
        &self.tests[self.tests.len() - 1]
    }

    /// The test nearest to a number of trials; the earlier one of two.
    pub fn nearest(&self, trials: u32) -> &SeedScores {
        self.tests.iter().min_by_key(|test| test.trials.abs_diff(trials)).unwrap_or_else(|| self.last())
    }

    /// The test nearest to a number of trials, if it is within a quarter of it.
    pub fn near(&self, trials: u32) -> Option<&SeedScores> {
        Some(self.nearest(trials)).filter(|test| 4 * test.trials.abs_diff(trials) <= trials)
    }

    /// Per seed, the training trials at the first test with at least this success; none if no test reached it. A seed
    /// without a number is censored, not dropped: it would have needed more than the last test's trials.
    pub fn trials_to(&self, success: f64) -> Vec<Option<u32>> {
        let seeds = 0..self.last().scores.len();
        let first = |seed: usize| self.tests.iter().find(|test| test.scores[seed].success() >= success);
        seeds.map(|seed| first(seed).map(|test| test.trials)).collect()
    }
}

/// The planner's own tests of a skill.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannerBound {
    /// The arm whose task it is; none for the first task of the run.
    pub arm: Option<String>,
    /// Over all starting rooms.
    pub score: Score,
    /// For each of the summary's rooms; no episodes where no test started.
    pub rooms: Vec<Score>,
}

/// All tests of one skill.
#[derive(Debug, Clone, PartialEq)]
pub struct SkillSummary {
    pub name: String,
    /// One series per arm and sweep point, in the order of the rows.
    pub series: Vec<Series>,
    /// The planner's own tests, if the run holds them: more than one where arms differ in the task.
    pub bounds: Vec<PlannerBound>,
}

impl SkillSummary {
    /// The series that differ from all earlier ones, each with the labels of those that do not: arms that have a skill
    /// in common learned it once.
    pub fn distinct(&self) -> Vec<(&Series, Vec<&str>)> {
        let mut distinct: Vec<(&Series, Vec<&str>)> = Vec::new();
        for series in &self.series {
            match distinct.iter_mut().find(|(earlier, _)| earlier.tests == series.tests) {
                Some((_, copies)) => copies.push(&series.label),
                None => distinct.push((series, Vec::new())),
            }
        }
        distinct
    }

    /// The planner's tests of an arm's task.
    pub fn bound(&self, arm: &str) -> Option<&PlannerBound> {
        let own = self.bounds.iter().find(|bound| bound.arm.as_deref() == Some(arm));
        own.or_else(|| self.bounds.iter().find(|bound| bound.arm.is_none())).or(self.bounds.first())
    }

    /// Whether no test ever ended as achieved, not even the planner's: then the return says how good the skill is.
    pub fn never_ends(&self) -> bool {
        let scores = self.series.iter().flat_map(|series| &series.tests).flat_map(|test| &test.scores);
        scores.chain(self.bounds.iter().map(|bound| &bound.score)).all(|score| score.successes == 0)
    }
}

/// What an arm learned.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ArmSummary {
    pub name: String,
    /// The skill at the top of its tree.
    pub root: String,
    /// Whether there are other skills below.
    pub hierarchical: bool,
}

/// Everything that the report computes from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Summary {
    /// Rooms in which tests start, by name.
    pub rooms: Vec<String>,
    /// In the order of the rows; without the planner.
    pub arms: Vec<ArmSummary>,
    /// In the order of the rows.
    pub skills: Vec<SkillSummary>,
    /// Learners of which some number stopped being finite. They have no tests from then on, which count as failed.
    pub diverged: Vec<Divergence>,
    /// What the reader must know about gaps in the data.
    pub warnings: Vec<String>,
}

impl Summary {
    /// A skill of an arm, at the first sweep point.
    pub fn series(&self, arm: &str, skill: &str) -> Option<&Series> {
        self.skill(skill)?.series.iter().find(|series| series.arm == arm)
    }

    /// The same with the first sweep point of each arm alone.
    pub fn first_points(&self) -> Self {
        let mut first = self.clone();
        for skill in &mut first.skills {
            // Points of an arm stand side by side.
            skill.series.dedup_by(|later, earlier| later.arm == earlier.arm);
        }
        first
    }

    pub fn skill(&self, name: &str) -> Option<&SkillSummary> {
        self.skills.iter().find(|skill| skill.name == name)
    }

    pub fn arm(&self, name: &str) -> Option<&ArmSummary> {
        self.arms.iter().find(|arm| arm.name == name)
    }

    /// The place of a room among [`SeedScores::rooms`].
    pub fn room(&self, name: &str) -> Option<usize> {
        self.rooms.iter().position(|room| room == name)
    }
}

/// One number of each of two scores for every seed that both have.
pub fn paired(a: &[Score], b: &[Score], of: fn(&Score) -> f64) -> (Vec<f64>, Vec<f64>) {
    let other = |seed: u32| b.iter().find(|score| score.seed == seed);
    a.iter().filter_map(|score| Some((of(score), of(other(score.seed)?)))).unzip()
}
