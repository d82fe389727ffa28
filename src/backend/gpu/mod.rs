//! The GPU backend: the kernels on any adapter of Vulkan, Metal or DX12.
//!
//! Learners stay in the device's memory. The host only says how far to go, one dispatch ahead, waits, with a deadline,
//! and looks at the states now and then. A function here that does not say when it returns an error does so where the
//! device fails.

pub mod adapter;
pub mod arithmetic_check;
pub mod conformance;
pub mod device;
pub mod dispatch_size;
pub mod in_flight;
pub mod loop_limit;
pub mod pipeline;
mod pipeline_cache;
mod run_evaluation;
mod shards;
pub mod source;
pub mod spirv;
pub mod workgroup_weights;

use super::{Backend, BackendError, Cohort, Stop, Test, fresh, nothing_loaded};
use crate::env::workgroup::CohortData;
use crate::layout::{Dispatch, Episode, LearnerState, Robot, TRIAL_WORDS};
use bytemuck::Zeroable;
use conformance::{Verdict, examine};
use device::Device;
use dispatch_size::{Share, ceiling, iteration_turns, step_turns};
use in_flight::{Flight, IN_FLIGHT, Rounds, Traffic};
use pipeline_cache::Stage;
use run_evaluation::finish;
use shards::{Common, Shard};
use source::{EVALUATE, Kernel, STEP, TRAIN};
use std::ops::Range;
use std::time::{Duration, Instant};
use wgpu::BufferUsages;
use workgroup_weights::{holders, wanted};

/// Work of one call of [`Backend::advance`].
const TURN: Duration = Duration::from_millis(500);
/// Most bytes of test results on the device at a time.
const RESULTS: u64 = 64 << 20;

/// What the user asked of the GPU.
#[derive(Debug, Clone, Default)]
pub struct GpuOptions {
    /// Part of the adapter's name, `--adapter NAME`.
    pub adapter: Option<String>,
    /// Quanta of every dispatch, `--iterations N`; else as many as take some 50 ms.
    pub iterations: Option<u32>,
    /// Most learners in one set of buffers; else as many as fit. No result depends on it.
    pub shard: Option<usize>,
    /// Most dispatches in flight; else [`IN_FLIGHT`]. No result depends on it.
    pub in_flight: Option<usize>,
    /// Most words of a workgroup's memory that hold weights in replay; else as many as there is room for. No result
    /// depends on it.
    pub held: Option<u32>,
}

/// Executes the kernels on an adapter.
#[derive(Debug)]
pub struct GpuBackend {
    device: Device,
    verdict: Verdict,
    advance: Stage,
    evaluate: Stage,
    step: Stage,
    traffic: Traffic,
    shard: usize,
    held: u32,
    loaded: Option<Loaded>,
}

/// A cohort on the device and its copy on the host, which lags behind.
#[derive(Debug)]
struct Loaded {
    cohort: Cohort,
    common: Common,
    shards: Vec<Shard>,
    bindings: Vec<wgpu::BindGroup>,
    dispatch: wgpu::Buffer,
    rounds: Rounds,
}

impl GpuBackend {
    /// What `--backend gpu` asks for: the adapter of that name, else a real GPU, else a software one.
    ///
    /// # Errors
    /// Where there is none, or it cannot be opened or answers no questions.
    pub fn new(options: &GpuOptions) -> Result<Self, BackendError> {
        Self::on(&adapter::choose(options.adapter.as_deref(), true)?, options)
    }

    /// What `--backend auto` asks for: a real GPU, or the one named, that is exact.
    ///
    /// # Errors
    /// Why there is none, for the user to read; the CPU should be used then.
    pub fn exact(options: &GpuOptions) -> Result<Self, BackendError> {
        let found = Self::on(&adapter::choose(options.adapter.as_deref(), false)?, options)?;
        match &found.verdict.reason {
            Some(reason) if !found.verdict.exact => Err(BackendError::Unavailable {
                message: format!("the adapter `{}` is not exact: {reason}", found.device.info.name),
                hint: "`--backend gpu` uses it all the same; its results are then not those of the CPU".to_owned(),
            }),
            _ => Ok(found),
        }
    }

    /// Opens an adapter and examines it.
    ///
    /// # Errors
    /// Where it cannot be opened or fails.
    pub fn on(adapter: &wgpu::Adapter, options: &GpuOptions) -> Result<Self, BackendError> {
        let device = Device::open(adapter)?;
        let verdict = examine(&device)?;
        let stage = |kernel| Stage::new(kernel, options.iterations);
        Ok(Self {
            device,
            verdict,
            advance: stage(TRAIN),
            evaluate: stage(EVALUATE),
            step: stage(STEP),
            traffic: Traffic::new(options.in_flight.unwrap_or(IN_FLIGHT)),
            shard: options.shard.unwrap_or(usize::MAX).max(1),
            held: options.held.unwrap_or(u32::MAX),
            loaded: None,
        })
    }

    /// What the conformance check found.
    pub fn verdict(&self) -> &Verdict {
        &self.verdict
    }

    /// The adapter in use.
    pub fn info(&self) -> &wgpu::AdapterInfo {
        &self.device.info
    }

    /// Executes another text instead of the shipped kernel of its name, from the next load on: for tests that
    /// break a kernel on purpose. The verdict stays that of the shipped arithmetic.
    #[doc(hidden)]
    pub fn replace(&mut self, kernel: Kernel) {
        self.loaded = None;
        for stage in [&mut self.advance, &mut self.evaluate, &mut self.step] {
            stage.replace(kernel);
        }
    }

    /// What was in flight so far, for tests of the overlap.
    #[doc(hidden)]
    pub fn traffic(&mut self) -> &mut Traffic {
        &mut self.traffic
    }

    /// Words of a workgroup's memory that hold weights of the cohort.
    #[doc(hidden)]
    pub fn held(&self) -> u32 {
        self.advance.held()
    }

    fn uniform(&self, kernel: &'static str) -> Result<wgpu::Buffer, BackendError> {
        self.device.buffer(kernel, size_of::<Dispatch>() as u64, BufferUsages::UNIFORM)
    }
}

impl Backend for GpuBackend {
    fn describe(&self) -> String {
        let info = &self.device.info;
        let exact = if self.verdict.exact { "exact" } else { "not exact" };
        format!("gpu ({}, {}, {exact})", info.name, info.backend)
    }

    fn kind(&self) -> &'static str {
        "gpu"
    }

    fn adapter(&self) -> Option<String> {
        Some(self.device.info.name.clone())
    }

    fn cohort_size(&self, bytes_per_learner: usize) -> Result<usize, BackendError> {
        // Cohorts are cut into shards, so no buffer's limit counts here, only memory.
        shards::fitting(&self.device, bytes_per_learner)
    }

    fn load(&mut self, cohort: Cohort) -> Result<(), BackendError> {
        // The old cohort's memory is free before the new one's is taken.
        self.loaded = None;
        self.advance.wanted = wanted(&cohort).into_iter().filter(|words| *words <= self.held).collect();
        let dispatch = self.uniform(TRAIN.name)?;
        let (pipeline, governor) = self.advance.ready(&self.device)?;
        let turns = iteration_turns(&cohort.shared, holders(&cohort, pipeline.held()));
        let most = ceiling(self.verdict.loop_budget, turns);
        governor.set_ceiling(most);
        self.evaluate.governor.set_ceiling(most);
        let common = Common::new(&self.device, TRAIN.name, &cohort.shared)?;
        let shards = shards::upload(&self.device, &cohort, self.shard)?;
        let bindings = shards
            .iter()
            .map(|shard| {
                let Common { world, tables, skills, bank } = &common;
                let Shard { params, states, nets, lessons, rows, .. } = shard;
                let buffers = [&dispatch, world, tables, skills, bank, params, states, nets, lessons, rows];
                pipeline.bind(&self.device, &buffers)
            })
            .collect();
        self.device.sound(TRAIN.name)?;
        self.loaded = Some(Loaded { cohort, common, shards, bindings, dispatch, rounds: Rounds::default() });
        Ok(())
    }

    fn advance(&mut self, stop: Stop) -> Result<&[LearnerState], BackendError> {
        let loaded = self.loaded.as_mut().ok_or_else(nothing_loaded)?;
        let Loaded { cohort, shards, bindings, dispatch: uniform, rounds, .. } = loaded;
        let begun = Instant::now();
        loop {
            let waiting = count_waiting(&cohort.states, stop);
            if waiting == 0 || begun.elapsed() >= TURN {
                break;
            }
            let stage = self.advance.ready(&self.device)?;
            let mut flight = Flight::new(&self.device, stage, uniform, &mut self.traffic);
            for _round in 0..rounds.count() {
                for (shard, binding) in shards.iter().zip(&*bindings) {
                    let learners = shard.learners.len() as u32;
                    let mut first = 0;
                    while first < learners {
                        let share = flight.share(learners - first);
                        let dispatch = Dispatch {
                            iterations: share.iterations,
                            stop_skill: stop.skill,
                            stop_trial: stop.trial,
                            first,
                            ..of(cohort, learners)
                        };
                        flight.send(binding, &dispatch, share, (share.groups, 1))?;
                        first += share.groups;
                    }
                }
                if begun.elapsed() >= TURN {
                    break;
                }
            }
            flight.land()?;
            for shard in &*shards {
                shard.read_cursors(&self.device, cohort)?;
            }
            let busy = 2 * count_waiting(&cohort.states, stop) >= waiting && 2 * waiting >= cohort.states.len();
            rounds.looked(busy, flight.learn(busy));
        }
        Ok(&cohort.states)
    }

    fn learners(&self) -> usize {
        self.loaded.as_ref().map_or(0, |loaded| loaded.cohort.states.len())
    }

    fn evaluate_some(&mut self, test: Test, wanted: Range<usize>) -> Result<Vec<Episode>, BackendError> {
        let loaded = self.loaded.as_ref().ok_or_else(nothing_loaded)?;
        let (pipeline, governor) = self.evaluate.ready(&self.device)?;
        let Loaded { cohort, common, shards, dispatch: uniform, .. } = loaded;
        let mut episodes = fresh(wanted.len() * test.episodes as usize);
        if episodes.is_empty() {
            return Ok(episodes);
        }
        // One test trial of a learner is a workgroup; the dispatch has a row of them per learner.
        if test.episodes > dispatch_size::GROUPS {
            let message = format!("{} test trials at a time, {} are possible", test.episodes, dispatch_size::GROUPS);
            return Err(BackendError::TooLarge { learners: wanted.len(), message });
        }
        let one = u64::from(test.episodes) * size_of::<Episode>() as u64;
        let room = (RESULTS / one).max(1) as usize;
        let results = self.device.buffer(
            EVALUATE.name,
            one * room.min(wanted.len()) as u64,
            BufferUsages::STORAGE | BufferUsages::COPY_SRC,
        )?;
        for shard in shards {
            let asked = wanted.start.max(shard.learners.start)..wanted.end.min(shard.learners.end);
            if asked.is_empty() {
                continue;
            }
            let binding = pipeline.bind(
                &self.device,
                &[uniform, &common.world, &common.tables, &common.skills, &shard.params, &shard.nets, &results],
            );
            let mut first = asked.start;
            while first < asked.end {
                let share = governor.share((asked.end - first) as u32 * test.episodes);
                let count = (share.groups / test.episodes).max(1) as usize;
                let count = count.min(room).min(asked.end - first);
                let from = (first - wanted.start) * test.episodes as usize;
                let part = &mut episodes[from..from + count * test.episodes as usize];
                let dispatch = Dispatch {
                    first: (first - shard.learners.start) as u32,
                    episodes: test.episodes,
                    test_skill: test.skill,
                    test_number: test.number,
                    ..of(cohort, shard.learners.len() as u32)
                };
                let flight = Flight::new(&self.device, (pipeline, governor), uniform, &mut self.traffic);
                finish(&self.device, flight, (&binding, &results), dispatch, part)?;
                first += count;
            }
        }
        Ok(episodes)
    }

    fn memory(&mut self) -> Result<&Cohort, BackendError> {
        let loaded = self.loaded.as_mut().ok_or_else(nothing_loaded)?;
        for shard in &loaded.shards {
            shard.read(&self.device, &mut loaded.cohort)?;
        }
        Ok(&loaded.cohort)
    }

    fn step(&mut self, shared: &CohortData, robots: &mut [Robot], iterations: u32) -> Result<(), BackendError> {
        let uniform = self.uniform(STEP.name)?;
        let common = Common::new(&self.device, STEP.name, shared)?;
        let most = ceiling(self.verdict.loop_budget, step_turns(shared));
        self.step.governor.set_ceiling(most);
        let (pipeline, governor) = self.step.ready(&self.device)?;
        for robots in robots.chunks_mut(dispatch_size::GROUPS as usize) {
            let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
            let buffer = self.device.filled(STEP.name, bytemuck::cast_slice(robots), 0, usage)?;
            let binding = pipeline.bind(&self.device, &[&uniform, &common.world, &common.tables, &buffer]);
            let mut flight = Flight::new(&self.device, (pipeline, governor), &uniform, &mut self.traffic);
            let mut first = 0;
            while first < robots.len() as u32 {
                let groups = flight.share(robots.len() as u32 - first).groups;
                let mut left = iterations;
                while left > 0 {
                    let share = Share { groups, iterations: flight.share(groups).iterations.min(left) };
                    let dispatch = Dispatch { iterations: share.iterations, first, ..Dispatch::zeroed() };
                    flight.send(&binding, &dispatch, share, (groups, 1))?;
                    // Robots have work to the end.
                    flight.learn(true);
                    left -= share.iterations;
                }
                first += groups;
            }
            flight.land()?;
            flight.learn(true);
            self.device.download(STEP.name, &buffer, bytemuck::cast_slice_mut(robots))?;
        }
        Ok(())
    }
}

/// The part of a dispatch that the cohort's shape decides.
fn of(cohort: &Cohort, learners: u32) -> Dispatch {
    Dispatch {
        skills: cohort.skills as u32,
        nets_stride: cohort.nets_stride as u32,
        lessons_stride: cohort.lessons_stride as u32,
        rows_stride: (cohort.rows_stride / TRIAL_WORDS) as u32,
        learners,
        ..Dispatch::zeroed()
    }
}

fn count_waiting(states: &[LearnerState], stop: Stop) -> usize {
    states.iter().filter(|state| !stop.holds(state)).count()
}
