//! Kernels on a pool of threads of this machine, one learner to a thread at a time.

use super::{Backend, BackendError, Cohort, Stop, Test, fresh, memory, nothing_loaded};
use crate::env::workgroup::{CohortData, HotForms, Nets, Workgroup};
use crate::layout::{Dispatch, Episode, LearnerState, Robot};
use bytemuck::{Pod, Zeroable};
use rayon::prelude::*;
use std::ops::Range;

/// Iterations of one learner in a turn: some 10 ms.
const ITERATIONS: u32 = 16_384;

/// Learners for each thread that one call of [`Backend::advance`] moves: some tenths of a second. A number and not a
/// time, for where a machine stands still for a while, none would have moved.
const TURN: usize = 32;

/// Learners that train together: few, so that finished ones are committed early.
const COHORT: usize = 32;

/// Share of the free memory that a cohort may take. The rest is for results, and for others.
const MEMORY_SHARE: f64 = 0.5;

/// Robots that a thread moves at a time.
const ROBOTS: usize = 16;

/// How a host executes the kernels.
#[derive(Debug, Clone, Copy)]
pub struct HostForms {
    /// `cpu` or `reference`.
    pub kind: &'static str,
    /// What it is compiled for, in words.
    pub instructions: fn() -> &'static str,
    /// The hot functions.
    pub hot: HotForms,
    /// Kernel `step` for up to 16 robots, so many times.
    pub step: fn(&mut [Robot], &CohortData, u32),
}

/// Executes the kernels on a pool of threads.
#[derive(Debug)]
pub struct HostBackend {
    pool: rayon::ThreadPool,
    forms: &'static HostForms,
    iterations: u32,
    cohort: Option<Cohort>,
}

/// A vector of the widest instructions, as it must lie for no access to touch two lines of the cache.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C, align(64))]
pub(super) struct Vector([f32; 16]);

/// Where a thread has the nets of the learner that it moves. A cohort's lie as its `Vec` happens to.
#[derive(Debug, Default)]
struct AlignedNets(Vec<Vector>);

impl AlignedNets {
    /// A copy of `nets`.
    fn take(&mut self, nets: &[f32]) -> &mut [f32] {
        self.0.resize(nets.len().div_ceil(16), Vector::zeroed());
        let own = &mut bytemuck::cast_slice_mut(&mut self.0)[..nets.len()];
        own.copy_from_slice(nets);
        own
    }
}

impl HostBackend {
    /// A backend on `threads` threads (0: one per core) that leaves each learner after `iterations` iterations, if
    /// given.
    ///
    /// # Errors
    /// Where the threads cannot be started.
    pub fn new(forms: &'static HostForms, threads: usize, iterations: Option<u32>) -> Result<Self, BackendError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| {
            BackendError::Unavailable {
                message: format!("cannot start {threads} threads: {error}"),
                hint: "ask for fewer with `--threads N`".to_owned(),
            }
        })?;
        Ok(Self { pool, forms, iterations: iterations.unwrap_or(ITERATIONS), cohort: None })
    }

    fn loaded(&self) -> Result<&Cohort, BackendError> {
        self.cohort.as_ref().ok_or_else(nothing_loaded)
    }
}

impl Backend for HostBackend {
    fn describe(&self) -> String {
        let threads = self.pool.current_num_threads();
        let s = if threads == 1 { "" } else { "s" };
        format!("{} ({threads} thread{s}, {})", self.forms.kind, (self.forms.instructions)())
    }

    fn kind(&self) -> &'static str {
        self.forms.kind
    }

    fn adapter(&self) -> Option<String> {
        None
    }

    fn cohort_size(&self, bytes_per_learner: usize) -> Result<usize, BackendError> {
        let most = COHORT.max(self.pool.current_num_threads() * 4);
        memory::fitting(memory::free(), MEMORY_SHARE, bytes_per_learner, most)
    }

    fn load(&mut self, cohort: Cohort) -> Result<(), BackendError> {
        self.cohort = Some(cohort);
        Ok(())
    }

    fn advance(&mut self, stop: Stop) -> Result<&[LearnerState], BackendError> {
        let forms = self.forms;
        let cohort = self.cohort.as_mut().ok_or_else(nothing_loaded)?;
        let dispatch = Dispatch {
            iterations: self.iterations,
            stop_skill: stop.skill,
            stop_trial: stop.trial,
            skills: cohort.skills as u32,
            ..Dispatch::zeroed()
        };
        let shared = &cohort.shared;
        // The others' turn comes with a later call, when these have reached the stop.
        let turn = TURN * self.pool.current_num_threads();
        let waiting = cohort.states.iter().enumerate().filter(|(_, state)| !stop.holds(state));
        let end = waiting.take(turn).last().map_or(0, |(last, _)| last + 1);
        self.pool.install(|| {
            cohort.states[..end]
                .par_iter_mut()
                .zip(cohort.params.par_chunks(cohort.skills))
                .zip(cohort.nets.par_chunks_mut(cohort.nets_stride))
                .zip(cohort.lessons.par_chunks_mut(cohort.lessons_stride))
                .zip(cohort.rows.par_chunks_mut(cohort.rows_stride))
                .for_each_init(AlignedNets::default, |aligned, ((((state, params), nets), lessons), rows)| {
                    // The kernel would leave at once, but its nets would be copied twice for that.
                    if stop.holds(state) {
                        return;
                    }
                    let own = aligned.take(nets);
                    let mut group = Workgroup {
                        dispatch,
                        nets: Nets::Trained(own),
                        lessons,
                        rows: bytemuck::cast_slice_mut(rows),
                        ..Workgroup::new(shared, params, &forms.hot)
                    };
                    group.train(state);
                    nets.copy_from_slice(own);
                });
        });
        Ok(&cohort.states)
    }

    fn learners(&self) -> usize {
        self.cohort.as_ref().map_or(0, |cohort| cohort.states.len())
    }

    fn evaluate_some(&mut self, test: Test, learners: Range<usize>) -> Result<Vec<Episode>, BackendError> {
        let cohort = self.loaded()?;
        let dispatch = Dispatch {
            iterations: u32::MAX,
            skills: cohort.skills as u32,
            episodes: test.episodes,
            test_skill: test.skill,
            test_number: test.number,
            ..Dispatch::zeroed()
        };
        let count = test.episodes as usize;
        let mut episodes = fresh(learners.len() * count);
        self.pool.install(|| {
            // Episode by episode: few learners keep all threads busy too.
            episodes.par_iter_mut().enumerate().for_each(|(place, episode)| {
                let (learner, number) = (learners.start + place / count, place % count);
                let params = &cohort.params[learner * cohort.skills..][..cohort.skills];
                let nets = &cohort.nets[learner * cohort.nets_stride..][..cohort.nets_stride];
                let group = Workgroup::new(&cohort.shared, params, &self.forms.hot);
                Workgroup { dispatch, nets: Nets::Read(nets), ..group }.evaluate(episode, number as u32);
            });
        });
        Ok(episodes)
    }

    fn memory(&mut self) -> Result<&Cohort, BackendError> {
        self.loaded()
    }

    fn step(&mut self, shared: &CohortData, robots: &mut [Robot], iterations: u32) -> Result<(), BackendError> {
        let step = self.forms.step;
        self.pool.install(|| robots.par_chunks_mut(ROBOTS).for_each(|robots| step(robots, shared, iterations)));
        Ok(())
    }
}
