//! The kinds of work, each done from the same start by every executor, and what it leaves to be compared.

use super::BenchError;
use super::clock::{Span, timed};
use super::cost::{self, Cost};
use super::executor::{Executor, Kind};
use super::limits::Limit;
use super::replay::{Drill, Nets};
use super::simulate::Walk;
use super::workload::{self, DOCKING};
use crate::backend::{Cohort, Test};
use crate::config::plan::Plan;
use crate::layout::HyperParams;
use crate::math::rng::BATCH;
use crate::qnet::backward::{OPTIMISER_ADAM_ROWS, OPTIMISER_SGD};
use crate::qnet::forward::lanes_of;
use crate::train::batch::train;
use crate::train::batch_group::{Group, LearnerId, groups};
use glam::Vec2;

/// A piece of work done once.
#[derive(Debug)]
pub struct Done {
    /// How many units.
    pub units: u64,
    /// How long it took.
    pub span: Span,
    /// What must be the same whoever did it.
    pub words: Vec<u32>,
}

/// A kind of work.
pub trait Task {
    /// One word or two, as results name it.
    fn name(&self) -> &'static str;
    /// What a unit is.
    fn about(&self) -> String;
    /// What a unit costs, and the limits that it is held against: arithmetic, and the way to the nets.
    fn cost(&self) -> Option<(Cost, Limit, Option<Limit>)>;
    /// Does the work of one sample; none where this executor cannot, or would take too long.
    ///
    /// # Errors
    /// Where the executor fails.
    fn run(&self, executor: &mut Executor, sample: u32) -> Result<Option<Done>, BenchError>;
}

/// How much of everything.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
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

impl Size {
    /// Enough for cores, and not too much for a scalar reference and for software adapters.
    pub const HOST: Self = Self { robots: 4096, rounds: 24, learners: 64, passes: 4, episodes: 1 };
    /// Enough to fill a graphics card.
    pub const DEVICE: Self = Self { robots: 65_536, rounds: 8, learners: 4096, passes: 2, episodes: 2 };
    /// Only to see that everything works.
    pub const TINY: Self = Self { robots: 64, rounds: 2, learners: 2, passes: 1, episodes: 1 };
}

/// Kernel `step`.
#[derive(Debug)]
pub struct RobotSteps {
    walk: Walk,
    rounds: u32,
    times: u32,
}

impl RobotSteps {
    /// Robots that carry out each given action `times` times before the next is given.
    ///
    /// # Errors
    /// Where the built-in config cannot be read.
    pub fn new(size: Size, times: u32) -> Result<Self, BenchError> {
        let plan = workload::plan(DOCKING, &["arms=[\"taught-adam\"]"], 1)?;
        Ok(Self { walk: Walk::new(&plan, size.robots), rounds: size.rounds.div_ceil(times), times })
    }
}

impl Task for RobotSteps {
    fn name(&self) -> &'static str {
        if self.times == 1 { "robot-steps" } else { "robot-steps-held" }
    }

    fn about(&self) -> String {
        let held = match self.times {
            1 => "each action given by the host".to_owned(),
            times => format!("each action carried out {times} times"),
        };
        format!(
            "one action of a robot: noise, contact, 24 ranges, light, compass; {} robots, {held}",
            self.walk.robots.len()
        )
    }

    fn cost(&self) -> Option<(Cost, Limit, Option<Limit>)> {
        let Walk { shared, robots, .. } = &self.walk;
        let light = robots.first().map_or(0.0, |robot| robot.noise.light);
        let places = robots.iter().map(|robot| (robot.x, robot.y));
        Some((cost::step(&shared.floor, light, places, 1.0 / 3.0, BATCH), Limit::CompareSelect, None))
    }

    fn run(&self, executor: &mut Executor, sample: u32) -> Result<Option<Done>, BenchError> {
        let mut walk = self.walk.clone();
        // Who decides takes its own time.
        let actions = walk.actions(sample * self.rounds..(sample + 1) * self.rounds);
        let (_, span) = timed(|| match executor.backend() {
            Some(backend) => walk.advance(backend, &actions, self.times),
            None => {
                walk.advance_scalar(&actions, self.times);
                Ok(())
            }
        })?;
        let units = walk.robots.len() as u64 * u64::from(self.rounds * self.times);
        Ok(Some(Done { units, span, words: walk.words().to_vec() }))
    }
}

/// How weights are updated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// Adam.
    Adam,
    /// Adam with one second moment for each row of weights.
    AdamRows,
    /// The same for nets of 16 hidden units, which take half of the lanes.
    Few,
    /// Plain gradient descent.
    Sgd,
}

/// Kernel `advance`, replaying taught lessons.
#[derive(Debug)]
pub struct Replay {
    name: &'static str,
    drill: Drill,
    passes: u32,
}

impl Replay {
    /// Learners of docking as shipped, by one of the rules.
    ///
    /// # Errors
    /// Where the built-in config cannot be read or its teacher fails.
    pub fn new(size: Size, rule: Rule) -> Result<Self, BenchError> {
        let (name, arm, optimiser, hidden) = match rule {
            Rule::Adam => ("transitions-adam", "taught-adam", "adam", 32),
            Rule::AdamRows => ("transitions-adam-rows", "taught-adam", "adam-rows", 32),
            Rule::Few => ("transitions-few", "taught-adam", "adam-rows", 16),
            Rule::Sgd => ("transitions-sgd", "taught-sgd", "sgd", 32),
        };
        let hidden = format!("learning.hidden={hidden}");
        let optimiser = format!("arm.{arm}.learning.optimiser=\"{optimiser}\"");
        let arms = format!("arms=[\"{arm}\"]");
        let passes = format!("arm.{arm}.learning.pretrain_epochs={}", size.passes);
        let plan = workload::plan(
            DOCKING,
            &[&arms, &passes, &optimiser, &hidden, "teacher.eval_episodes=1", "skill.dock.trials=0"],
            size.learners,
        )?;
        Ok(Self { name, drill: Drill::new(&plan)?, passes: size.passes })
    }
}

impl Task for Replay {
    fn name(&self) -> &'static str {
        self.name
    }

    fn about(&self) -> String {
        let rule = match self.drill.params(0).optimiser {
            OPTIMISER_SGD => "gradient descent",
            OPTIMISER_ADAM_ROWS => "Adam with one second moment a row",
            _ => "Adam",
        };
        let skill = self.drill.skill();
        format!(
            "one replayed transition: {} nets of {}-{}-1 forwards, one backwards, {rule}; {} learners",
            skill.nets,
            skill.inputs,
            self.drill.params(0).hidden,
            self.drill.cohort().states.len()
        )
    }

    fn cost(&self) -> Option<(Cost, Limit, Option<Limit>)> {
        let HyperParams { hidden, optimiser, .. } = *self.drill.params(0);
        let cost = cost::transition(self.drill.skill(), lanes_of(hidden), self.drill.inputs_seen(), optimiser);
        Some((cost, Limit::MultiplyAdd, Some(Limit::FarUpdate)))
    }

    fn run(&self, executor: &mut Executor, _sample: u32) -> Result<Option<Done>, BenchError> {
        let mut nets = Vec::new();
        let span = match executor.backend() {
            Some(backend) => {
                backend.load(self.drill.cohort().clone())?;
                let (_, span) = timed(|| Drill::replay(backend))?;
                nets.extend(self.drill.nets(backend.memory()?));
                span
            }
            None => {
                nets.extend(self.drill.nets(self.drill.cohort()));
                let replay = || {
                    self.drill.replay_scalar(&mut nets, self.passes);
                    Ok(())
                };
                timed(replay)?.1
            }
        };
        let words = nets.iter().flat_map(Nets::weights).map(f32::to_bits).collect();
        Ok(Some(Done { units: self.drill.transitions(self.passes), span, words }))
    }
}

/// The paper's hierarchy: four skills and one above them.
#[derive(Debug)]
pub struct Hierarchy {
    plan: Plan,
    group: Group,
}

impl Hierarchy {
    /// The arm `hierarchical` of a shipped config with some keys set, with as many seeds as `learners`.
    ///
    /// # Errors
    /// Where the built-in config cannot be read or its teacher fails.
    pub fn new(config: &str, set: &[&str], learners: u32) -> Result<Self, BenchError> {
        let set = [&["arms=[\"hierarchical\"]", "teacher.eval_episodes=1"], set].concat();
        let plan = workload::plan(config, &set, learners)?;
        let group = groups(&plan)?.swap_remove(0);
        Ok(Self { plan, group })
    }

    fn ids(&self, learners: u32) -> Vec<LearnerId> {
        self.group.learners(&self.plan).into_iter().take(learners as usize).collect()
    }
}

/// Kernel `evaluate`: the tree decides on every step, with the nets as they begin.
#[derive(Debug)]
pub struct Decisions<'a> {
    hierarchy: &'a Hierarchy,
    cohort: Cohort,
    episodes: u32,
}

impl<'a> Decisions<'a> {
    /// Test trials of learners that have not learned yet.
    pub fn new(hierarchy: &'a Hierarchy, size: Size) -> Self {
        let mut cohort = hierarchy.group.cohort(&hierarchy.plan, &hierarchy.ids(size.learners));
        // Tests read nets only.
        (cohort.lessons_stride, cohort.rows_stride) = (1, 1);
        cohort.lessons = vec![0; cohort.states.len()];
        cohort.rows = vec![0; cohort.states.len()];
        Self { hierarchy, cohort, episodes: size.episodes }
    }
}

impl Task for Decisions<'_> {
    fn name(&self) -> &'static str {
        "decisions"
    }

    fn about(&self) -> String {
        format!(
            "one step of a robot whose tree of {} skills decides: sense, watch, choose, act; {} learners x {} trials",
            self.cohort.skills,
            self.cohort.states.len(),
            self.episodes
        )
    }

    fn cost(&self) -> Option<(Cost, Limit, Option<Limit>)> {
        let shared = &self.cohort.shared;
        let size = self.hierarchy.plan.world().size;
        let cells = (0..).map(|row| row as f32 * 12.0 + 6.0).take_while(|y| *y < size.y);
        let places = cells
            .flat_map(|y| (0..).map(move |column| (column as f32 * 12.0 + 6.0, y)).take_while(|(x, _)| *x < size.x));
        let places = places.filter(|(x, y)| self.hierarchy.plan.world().is_free(Vec2::new(*x, *y)));
        let light = self.hierarchy.plan.arms[0].noise.light;
        let cost = cost::decision(&shared.floor, light, places, &shared.skills, self.cohort.skills - 1);
        Some((cost, Limit::MultiplyAdd, Some(Limit::FarRead)))
    }

    fn run(&self, executor: &mut Executor, sample: u32) -> Result<Option<Done>, BenchError> {
        let Some(backend) = executor.backend() else { return Ok(None) };
        backend.load(self.cohort.clone())?;
        let skill = self.cohort.skills as u32 - 1;
        let test = Test { skill, number: sample, episodes: self.episodes };
        let (episodes, span) = timed(|| Ok(backend.evaluate(test)?))?;
        let units = episodes.iter().map(|episode| u64::from(episode.agent.step)).sum();
        Ok(Some(Done { units, span, words: bytemuck::cast_slice(&episodes).to_vec() }))
    }
}

/// A whole training of the hierarchy, tests and all.
#[derive(Debug)]
pub struct Learners<'a> {
    name: &'static str,
    hierarchy: &'a Hierarchy,
    host: u32,
    device: u32,
}

impl<'a> Learners<'a> {
    /// `host` learners on the CPU, `device` on a graphics card; software adapters would take too long.
    pub fn new(name: &'static str, hierarchy: &'a Hierarchy, host: u32, device: u32) -> Self {
        Self { name, hierarchy, host, device }
    }
}

impl Task for Learners<'_> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn about(&self) -> String {
        let skills = &self.hierarchy.plan.arms[0].skills;
        let trials: u32 = skills.iter().map(|skill| skill.params.trials).sum();
        let learning = &skills[skills.len() - 1].params;
        let rule = match learning.optimiser {
            OPTIMISER_SGD => "gradient descent",
            OPTIMISER_ADAM_ROWS => "Adam with one second moment a row",
            _ => "Adam",
        };
        format!(
            "one learner from its first lesson to its last test: {} skills, {trials} trials, {} hidden units, {rule}",
            skills.len(),
            learning.hidden
        )
    }

    fn cost(&self) -> Option<(Cost, Limit, Option<Limit>)> {
        None
    }

    fn run(&self, executor: &mut Executor, _sample: u32) -> Result<Option<Done>, BenchError> {
        let count = match executor.about.kind {
            Kind::Cpu => self.host,
            Kind::Gpu => self.device,
            Kind::Scalar | Kind::SoftwareGpu => return Ok(None),
        };
        let Some(backend) = executor.backend() else { return Ok(None) };
        let Hierarchy { plan, group } = self.hierarchy;
        let ids = self.hierarchy.ids(count);
        let (results, span) = timed(|| Ok(train(plan, group, &ids, &|_| None, None, backend, &mut ())?))?;
        // A card trains more of them, of which the first are also trained on the CPU.
        let common = if self.device == 0 { self.host } else { self.host.min(self.device) } as usize;
        let weights = results.iter().take(common).flat_map(|result| &result.weights);
        Ok(Some(Done { units: results.len() as u64, span, words: weights.map(|weight| weight.to_bits()).collect() }))
    }
}
