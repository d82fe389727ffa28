//! The kinds of work, each done from the same start by every executor, and what it leaves to be compared. Where an error
//! is returned, the built-in config cannot be read or its teacher fails.

use super::BenchError;
use super::embedded_configs::{DOCKING, embedded_plan};
use super::executor::{Executor, ExecutorKind};
use super::robot_walk::RobotWalk;
use super::taught_replay::TaughtReplay;
use super::timing::{Elapsed, timed};
use crate::backend::Test;
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

/// Does the work of one sample; none where this executor would take too long.
type BenchRun<'a> = dyn Fn(&mut Executor, u32) -> Result<Option<Measurement>, BenchError> + 'a;

/// A kind of work.
pub struct Benchmark<'a> {
    /// Its name in the results.
    pub name: &'static str,
    /// What a unit is.
    pub about: String,
    /// Does it.
    pub run: Box<BenchRun<'a>>,
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

/// Kernel `step`: robots that carry out each given action `times` times before the next is given.
pub fn robot_steps(sizes: BenchSizes, times: u32) -> Result<Benchmark<'static>, BenchError> {
    let walk = RobotWalk::new(sizes.robots)?;
    let rounds = sizes.rounds.div_ceil(times);
    let (name, given) = match times {
        1 => ("robot-steps", "each action given by the host".to_owned()),
        _ => ("robot-steps-held", format!("each action carried out {times} times")),
    };
    let about = format!(
        "one action of a robot: noise, contact, 24 ranges, light, compass; {} robots, {given}",
        walk.robots.len()
    );
    let run = move |executor: &mut Executor, sample: u32| {
        let mut walk = walk.clone();
        // Drawing the actions is not timed.
        let actions = walk.actions(sample * rounds..(sample + 1) * rounds);
        let (done, elapsed) = timed(|| walk.advance(executor.backend.as_mut(), &actions, times));
        done?;
        let units = walk.robots.len() as u64 * u64::from(rounds * times);
        Ok(Some(Measurement { units, elapsed, words: walk.words().to_vec() }))
    };
    Ok(Benchmark { name, about, run: Box::new(run) })
}

/// How weights are updated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UpdateRule {
    name: &'static str,
    arm: &'static str,
    optimiser: &'static str,
    about: &'static str,
    hidden: u32,
}

impl UpdateRule {
    /// Those that are measured.
    pub const ALL: [Self; 4] = [
        Self::new("transitions-adam", "taught-adam", "adam", ADAM, 32),
        Self::new("transitions-adam-rows", "taught-adam", "adam-rows", ADAM_ROWS, 32),
        // Nets of 16 hidden units take half of the lanes.
        Self::new("transitions-few", "taught-adam", "adam-rows", ADAM_ROWS, 16),
        Self::new("transitions-sgd", "taught-sgd", "sgd", SGD, 32),
    ];

    const fn new(
        name: &'static str,
        arm: &'static str,
        optimiser: &'static str,
        about: &'static str,
        hidden: u32,
    ) -> Self {
        Self { name, arm, optimiser, about, hidden }
    }

    /// Learners of docking that replay `passes` times over their lessons by this rule, and then stop.
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

const ADAM: &str = "Adam";
const ADAM_ROWS: &str = "Adam with one second moment a row";
const SGD: &str = "gradient descent";

/// Kernel `train`: learners of docking as shipped that replay taught lessons by one of the rules.
pub fn transitions(sizes: BenchSizes, rule: UpdateRule) -> Result<Benchmark<'static>, BenchError> {
    let replay = TaughtReplay::new(&rule.plan(sizes.learners, sizes.passes)?)?;
    let UpdateRule { name, hidden, about, .. } = rule;
    let (nets, inputs, learners) = (replay.skill().nets, replay.skill().inputs, replay.cohort.states.len());
    let about = format!(
        "one replayed transition: {nets} nets of {inputs}-{hidden}-1 forwards, one backwards, {about}; {learners} learners"
    );
    let units = replay.transitions() * u64::from(sizes.passes);
    let run = move |executor: &mut Executor, _sample: u32| {
        let backend = executor.backend.as_mut();
        backend.load(replay.cohort.clone())?;
        let (done, elapsed) = timed(|| TaughtReplay::replay(backend));
        done?;
        let words = backend.memory()?.nets.iter().map(|word| word.to_bits()).collect();
        Ok(Some(Measurement { units, elapsed, words }))
    };
    Ok(Benchmark { name, about, run: Box::new(run) })
}

/// Learners of the paper's hierarchy: four skills and one above them.
#[derive(Debug)]
pub struct HierarchyLearners {
    plan: Plan,
    group: BatchGroup,
}

impl HierarchyLearners {
    /// The arm `hierarchical` of a shipped config with some keys set, with as many seeds as `learners`.
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
pub fn decisions(hierarchy: &HierarchyLearners, sizes: BenchSizes) -> Benchmark<'static> {
    let mut cohort = hierarchy.group.cohort(&hierarchy.plan, &hierarchy.ids(sizes.learners));
    // Tests read nets only.
    (cohort.lessons_stride, cohort.rows_stride) = (1, 1);
    cohort.lessons = vec![0; cohort.states.len()];
    cohort.rows = vec![0; cohort.states.len()];
    let episodes = sizes.episodes;
    let about = format!(
        "one step of a robot whose tree of {} skills decides: sense, ask the children, choose, act; {} learners x {} trials",
        cohort.skills,
        cohort.states.len(),
        episodes
    );
    let run = move |executor: &mut Executor, number: u32| {
        let backend = executor.backend.as_mut();
        backend.load(cohort.clone())?;
        let test = Test { skill: cohort.skills as u32 - 1, number, episodes };
        let (episodes, elapsed) = timed(|| backend.evaluate(test));
        let episodes = episodes?;
        let units = episodes.iter().map(|episode| u64::from(episode.agent.step)).sum();
        Ok(Some(Measurement { units, elapsed, words: bytemuck::cast_slice(&episodes).to_vec() }))
    };
    Benchmark { name: "decisions", about, run: Box::new(run) }
}

/// Whole trainings of the hierarchy, tests and all: `on_cpu` learners on the CPU, `on_card` on a graphics card. The other
/// executors would take too long.
pub fn whole_learners<'a>(
    name: &'static str,
    learners: &'a HierarchyLearners,
    on_cpu: u32,
    on_card: u32,
) -> Benchmark<'a> {
    let HierarchyLearners { plan, group } = learners;
    let skills = &plan.arms[0].skills;
    let trials: u32 = skills.iter().map(|skill| skill.params.trials).sum();
    let learning = &skills[skills.len() - 1].params;
    let rule = match learning.optimiser {
        OPTIMISER_SGD => SGD,
        OPTIMISER_ADAM => ADAM,
        _ => ADAM_ROWS,
    };
    let about = format!(
        "one learner from its first lesson to its last test: {} skills, {trials} trials, {} hidden units, {rule}",
        skills.len(),
        learning.hidden
    );
    // A card trains more of them, of which the first are also trained on the CPU.
    let common = if on_card == 0 { on_cpu } else { on_cpu.min(on_card) } as usize;
    let run = move |executor: &mut Executor, _sample: u32| {
        let count = match executor.info.kind {
            ExecutorKind::Cpu => on_cpu,
            ExecutorKind::Gpu => on_card,
            ExecutorKind::Reference | ExecutorKind::SoftwareGpu => return Ok(None),
        };
        let (ids, backend) = (learners.ids(count), executor.backend.as_mut());
        let (results, elapsed) = timed(|| train(plan, group, &ids, &|_| None, None, backend, &mut ()));
        let results = results?;
        let words = results.iter().take(common).flat_map(|result| &result.weights).map(|weight| weight.to_bits());
        Ok(Some(Measurement { units: results.len() as u64, elapsed, words: words.collect() }))
    };
    Benchmark { name, about, run: Box::new(run) }
}
