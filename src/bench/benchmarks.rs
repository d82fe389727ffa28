//! The kinds of work, each done from the same start by every executor, and what it leaves to be compared.

use super::BenchError;
use super::embedded_configs::{DOCKING, embedded_plan};
use super::executor::{Executor, ExecutorKind};
use super::robot_walk::RobotWalk;
use super::taught_replay::TaughtReplay;
use super::timing::{Elapsed, timed};
use crate::backend::{Cohort, Test};
use crate::config::plan::Plan;
use crate::layout::choices::{OPTIMISER_ADAM, OPTIMISER_SGD};
use crate::train::batch::train;
use crate::train::batch_group::{BatchGroup, LearnerId, groups};

/// A piece of work done once.
#[derive(Debug)]
pub struct Measurement {
    /// How many units.
    pub units: u64,
    /// How long it took.
    pub elapsed: Elapsed,
    /// What must be the same whoever did it.
    pub words: Vec<u32>,
}

/// A kind of work.
pub trait Benchmark {
    /// Its name in the results.
    fn name(&self) -> &'static str;
    /// What a unit is.
    fn about(&self) -> String;
    /// Does the work of one sample; none where this executor would take too long.
    ///
    /// # Errors
    /// Where the executor fails.
    fn run(&self, executor: &mut Executor, sample: u32) -> Result<Option<Measurement>, BenchError>;
}

/// How much of everything.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BenchSizes {
    /// Robots under random actions.
    pub robots: u32,
    /// Actions of each.
    pub rounds: u32,
    /// Learners that replay, or are tested.
    pub learners: u32,
    /// Passes over their ten lessons.
    pub passes: u32,
    /// Test trials of each.
    pub episodes: u32,
}

impl BenchSizes {
    /// Enough for cores, and not too much for plain twins and software adapters.
    pub const CPU: Self = Self { robots: 4096, rounds: 24, learners: 64, passes: 4, episodes: 1 };
    /// Enough to fill a graphics card.
    pub const CARD: Self = Self { robots: 65_536, rounds: 8, learners: 4096, passes: 2, episodes: 2 };
    /// Only to see that everything works.
    pub const TINY: Self = Self { robots: 64, rounds: 2, learners: 2, passes: 1, episodes: 1 };
}

/// Kernel `step`.
#[derive(Debug)]
pub struct RobotSteps {
    walk: RobotWalk,
    rounds: u32,
    times: u32,
}

impl RobotSteps {
    /// Robots that carry out each given action `times` times before the next is given.
    ///
    /// # Errors
    /// Where the built-in config cannot be read.
    pub fn new(sizes: BenchSizes, times: u32) -> Result<Self, BenchError> {
        let plan = embedded_plan(DOCKING, &["arms=[\"taught-adam\"]"], 1)?;
        Ok(Self { walk: RobotWalk::new(&plan, sizes.robots), rounds: sizes.rounds.div_ceil(times), times })
    }
}

impl Benchmark for RobotSteps {
    fn name(&self) -> &'static str {
        if self.times == 1 { "robot-steps" } else { "robot-steps-held" }
    }

    fn about(&self) -> String {
        let given = match self.times {
            1 => "each action given by the host".to_owned(),
            times => format!("each action carried out {times} times"),
        };
        let robots = self.walk.robots.len();
        format!("one action of a robot: noise, contact, 24 ranges, light, compass; {robots} robots, {given}")
    }

    fn run(&self, executor: &mut Executor, sample: u32) -> Result<Option<Measurement>, BenchError> {
        let mut walk = self.walk.clone();
        // Drawing the actions is not timed.
        let actions = walk.actions(sample * self.rounds..(sample + 1) * self.rounds);
        let (_, elapsed) = timed(|| Ok(walk.advance(executor.backend.as_mut(), &actions, self.times)?))?;
        let units = walk.robots.len() as u64 * u64::from(self.rounds * self.times);
        Ok(Some(Measurement { units, elapsed, words: walk.words().to_vec() }))
    }
}

/// How weights are updated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UpdateRule {
    name: &'static str,
    about: &'static str,
    arm: &'static str,
    optimiser: &'static str,
    hidden: u32,
}

impl UpdateRule {
    /// Those that are measured.
    pub const ALL: [Self; 4] = [
        Self { name: "transitions-adam", about: "Adam", arm: "taught-adam", optimiser: "adam", hidden: 32 },
        Self {
            name: "transitions-adam-rows",
            about: "Adam with one second moment a row",
            arm: "taught-adam",
            optimiser: "adam-rows",
            hidden: 32,
        },
        // Nets of 16 hidden units take half of the lanes.
        Self {
            name: "transitions-few",
            about: "Adam with one second moment a row",
            arm: "taught-adam",
            optimiser: "adam-rows",
            hidden: 16,
        },
        Self { name: "transitions-sgd", about: "gradient descent", arm: "taught-sgd", optimiser: "sgd", hidden: 32 },
    ];

    /// Learners of docking that replay `passes` times over their lessons by this rule, and then stop.
    ///
    /// # Errors
    /// Where the built-in config cannot be read.
    pub fn plan(&self, learners: u32, passes: u32) -> Result<Plan, BenchError> {
        let Self { arm, optimiser, hidden, .. } = self;
        let set = [
            format!("arms=[\"{arm}\"]"),
            format!("arm.{arm}.learning.pretrain_epochs={passes}"),
            format!("arm.{arm}.learning.optimiser=\"{optimiser}\""),
            format!("learning.hidden={hidden}"),
            "teacher.eval_episodes=1".to_owned(),
            "skill.dock.trials=0".to_owned(),
        ];
        embedded_plan(DOCKING, &set.each_ref().map(String::as_str), learners)
    }
}

/// Kernel `advance`, replaying taught lessons.
#[derive(Debug)]
pub struct Transitions {
    rule: UpdateRule,
    replay: TaughtReplay,
    passes: u32,
}

impl Transitions {
    /// Learners of docking as shipped, by one of the rules.
    ///
    /// # Errors
    /// Where the built-in config cannot be read or its teacher fails.
    pub fn new(sizes: BenchSizes, rule: UpdateRule) -> Result<Self, BenchError> {
        let replay = TaughtReplay::new(&rule.plan(sizes.learners, sizes.passes)?)?;
        Ok(Self { rule, replay, passes: sizes.passes })
    }
}

impl Benchmark for Transitions {
    fn name(&self) -> &'static str {
        self.rule.name
    }

    fn about(&self) -> String {
        let (skill, UpdateRule { hidden, about, .. }) = (self.replay.skill(), self.rule);
        let learners = self.replay.cohort.states.len();
        let (nets, inputs) = (skill.nets, skill.inputs);
        format!(
            "one replayed transition: {nets} nets of {inputs}-{hidden}-1 forwards, one backwards, {about}; {learners} learners"
        )
    }

    fn run(&self, executor: &mut Executor, _sample: u32) -> Result<Option<Measurement>, BenchError> {
        let backend = executor.backend.as_mut();
        backend.load(self.replay.cohort.clone())?;
        let (_, elapsed) = timed(|| Ok(TaughtReplay::replay(backend)?))?;
        let words = backend.memory()?.nets.iter().map(|word| word.to_bits()).collect();
        Ok(Some(Measurement { units: self.replay.transitions() * u64::from(self.passes), elapsed, words }))
    }
}

/// Learners of the paper's hierarchy: four skills and one above them.
#[derive(Debug)]
pub struct HierarchyLearners {
    plan: Plan,
    group: BatchGroup,
}

impl HierarchyLearners {
    /// The arm `hierarchical` of a shipped config with some keys set, with as many seeds as `learners`.
    ///
    /// # Errors
    /// Where the built-in config cannot be read or its teacher fails.
    pub fn new(config: &str, set: &[&str], learners: u32) -> Result<Self, BenchError> {
        let set = [&["arms=[\"hierarchical\"]", "teacher.eval_episodes=1"], set].concat();
        let plan = embedded_plan(config, &set, learners)?;
        let group = groups(&plan)?.swap_remove(0);
        Ok(Self { plan, group })
    }

    fn ids(&self, learners: u32) -> Vec<LearnerId> {
        self.group.learners(&self.plan).into_iter().take(learners as usize).collect()
    }
}

/// Kernel `evaluate`: the tree decides on every step, with the nets as they begin.
#[derive(Debug)]
pub struct Decisions {
    cohort: Cohort,
    episodes: u32,
}

impl Decisions {
    /// Test trials of learners that have not learned yet.
    pub fn new(hierarchy: &HierarchyLearners, sizes: BenchSizes) -> Self {
        let mut cohort = hierarchy.group.cohort(&hierarchy.plan, &hierarchy.ids(sizes.learners));
        // Tests read nets only.
        (cohort.lessons_stride, cohort.rows_stride) = (1, 1);
        cohort.lessons = vec![0; cohort.states.len()];
        cohort.rows = vec![0; cohort.states.len()];
        Self { cohort, episodes: sizes.episodes }
    }
}

impl Benchmark for Decisions {
    fn name(&self) -> &'static str {
        "decisions"
    }

    fn about(&self) -> String {
        format!(
            "one step of a robot whose tree of {} skills decides: sense, ask the children, choose, act; {} learners x {} trials",
            self.cohort.skills,
            self.cohort.states.len(),
            self.episodes
        )
    }

    fn run(&self, executor: &mut Executor, sample: u32) -> Result<Option<Measurement>, BenchError> {
        let backend = executor.backend.as_mut();
        backend.load(self.cohort.clone())?;
        let test = Test { skill: self.cohort.skills as u32 - 1, number: sample, episodes: self.episodes };
        let (episodes, elapsed) = timed(|| Ok(backend.evaluate(test)?))?;
        let units = episodes.iter().map(|episode| u64::from(episode.agent.step)).sum();
        Ok(Some(Measurement { units, elapsed, words: bytemuck::cast_slice(&episodes).to_vec() }))
    }
}

/// Whole trainings of the hierarchy, tests and all.
#[derive(Debug)]
pub struct WholeLearners<'a> {
    name: &'static str,
    learners: &'a HierarchyLearners,
    on_cpu: u32,
    on_card: u32,
}

impl<'a> WholeLearners<'a> {
    /// `on_cpu` learners on the CPU, `on_card` on a graphics card; the others would take too long.
    pub fn new(name: &'static str, learners: &'a HierarchyLearners, on_cpu: u32, on_card: u32) -> Self {
        Self { name, learners, on_cpu, on_card }
    }
}

impl Benchmark for WholeLearners<'_> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn about(&self) -> String {
        let skills = &self.learners.plan.arms[0].skills;
        let trials: u32 = skills.iter().map(|skill| skill.params.trials).sum();
        let learning = &skills[skills.len() - 1].params;
        let rule = match learning.optimiser {
            OPTIMISER_SGD => "gradient descent",
            OPTIMISER_ADAM => "Adam",
            _ => "Adam with one second moment a row",
        };
        format!(
            "one learner from its first lesson to its last test: {} skills, {trials} trials, {} hidden units, {rule}",
            skills.len(),
            learning.hidden
        )
    }

    fn run(&self, executor: &mut Executor, _sample: u32) -> Result<Option<Measurement>, BenchError> {
        let count = match executor.info.kind {
            ExecutorKind::Cpu => self.on_cpu,
            ExecutorKind::Gpu => self.on_card,
            ExecutorKind::Reference | ExecutorKind::SoftwareGpu => return Ok(None),
        };
        let HierarchyLearners { plan, group } = self.learners;
        let (ids, backend) = (self.learners.ids(count), executor.backend.as_mut());
        let (results, elapsed) = timed(|| Ok(train(plan, group, &ids, &|_| None, None, backend, &mut ())?))?;
        // A card trains more of them, of which the first are also trained on the CPU.
        let common = if self.on_card == 0 { self.on_cpu } else { self.on_cpu.min(self.on_card) } as usize;
        let words = results.iter().take(common).flat_map(|result| &result.weights).map(|weight| weight.to_bits());
        Ok(Some(Measurement { units: results.len() as u64, elapsed, words: words.collect() }))
    }
}
