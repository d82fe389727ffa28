//! The CPU backend: the twins, one thread per learner at a time, lanes vectorised for this machine.
//!
//! The twins are plain arithmetic without fused operations, so the instruction set they are compiled for
//! changes their speed and not their bytes.

use super::{Backend, BackendError, Cohort, Stop, Test, fresh, memory};
use crate::env::workgroup::{CohortData, Learner};
use crate::kernels::evaluate::{STATE_CUT, STATE_FRESH, evaluate};
use crate::kernels::step::{ABREAST, step};
use crate::kernels::train::advance;
use crate::layout::{Dispatch, Episode, HyperParams, LearnerState, Robot};
use bytemuck::{Pod, Zeroable};
use rayon::prelude::*;
use std::hint::black_box;
use std::ops::Range;

/// Quanta of one learner in a turn: some 10 ms.
const ITERATIONS: u32 = 16_384;

/// Learners for each thread that one call of [`Backend::advance`] moves: some tenths of a second. A number and not a
/// time, for where a machine stands still for a while, none would have moved.
const TURN: usize = 32;

/// Learners that train together: few, so that finished ones are committed early.
const COHORT: usize = 32;

/// Share of the free memory that a cohort may take. The rest is for results, and for others.
const MEMORY_SHARE: f64 = 0.5;

/// Executes the twins on a pool of threads.
#[derive(Debug)]
pub struct CpuBackend {
    pool: rayon::ThreadPool,
    instructions: Instructions,
    iterations: u32,
    cohort: Option<Cohort>,
}

/// Widest vector instructions that the twins are compiled for and this machine has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Instructions {
    Baseline,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Instructions {
    fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512bw")
            {
                return Self::Avx512;
            }
            if is_x86_feature_detected!("avx2") {
                return Self::Avx2;
            }
        }
        Self::Baseline
    }

    fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => "AVX2",
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => "AVX-512",
        }
    }
}

/// Declares a function that runs a twin compiled for each instruction set.
///
/// The vector that nobody reads aligns the function's stack as vectors are. Else what the compiler keeps there lies across
/// two lines of the cache in most processes and not in some: robots step at 3.9 to 6.3 million a second, by chance.
macro_rules! dispatched {
    ($(#[$doc:meta])* $name:ident, $avx2:ident, $avx512:ident = $twin:ident($($argument:ident: $kind:ty),*)) => {
        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2")]
        fn $avx2($($argument: $kind),*) {
            black_box(&Vector::zeroed());
            $twin($($argument),*);
        }

        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw")]
        fn $avx512($($argument: $kind),*) {
            black_box(&Vector::zeroed());
            $twin($($argument),*);
        }

        $(#[$doc])*
        fn $name(instructions: Instructions, $($argument: $kind),*) {
            match instructions {
                Instructions::Baseline => $twin($($argument),*),
                // SAFETY: `Instructions::detect` saw the features on this machine.
                #[cfg(target_arch = "x86_64")]
                Instructions::Avx2 => unsafe { $avx2($($argument),*) },
                // SAFETY: as above.
                #[cfg(target_arch = "x86_64")]
                Instructions::Avx512 => unsafe { $avx512($($argument),*) },
            }
        }
    };
}

dispatched! {
    /// Runs [`advance`].
    run_advance, advance_avx2, advance_avx512 = advance(learner: &mut Learner<'_>, dispatch: &Dispatch)
}

dispatched! {
    /// Runs [`evaluate`].
    run_evaluate, evaluate_avx2, evaluate_avx512 = evaluate(
        episode: &mut Episode,
        shared: &CohortData,
        params: &[HyperParams],
        nets: &[f32],
        dispatch: &Dispatch,
        number: u32
    )
}

dispatched! {
    /// Runs [`step`].
    run_step, step_avx2, step_avx512 = step(robots: &mut [Robot], shared: &CohortData)
}

/// A vector of the widest instructions, as it must lie for no access to touch two lines of the cache.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C, align(64))]
struct Vector([f32; 16]);

/// Where a thread has the nets of the learner that it moves. A cohort's lie as its `Vec` happens to.
#[derive(Debug, Default)]
struct Desk(Vec<Vector>);

impl Desk {
    /// A copy of `nets`.
    fn take(&mut self, nets: &[f32]) -> &mut [f32] {
        self.0.resize(nets.len().div_ceil(16), Vector::zeroed());
        let own = &mut bytemuck::cast_slice_mut(&mut self.0)[..nets.len()];
        own.copy_from_slice(nets);
        own
    }
}

impl CpuBackend {
    /// A backend on `threads` threads (0: one per core) that leaves each learner after `iterations` iterations, if
    /// given.
    ///
    /// # Errors
    /// Where the threads cannot be started.
    pub fn new(threads: usize, iterations: Option<u32>) -> Result<Self, BackendError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| {
            BackendError::Unavailable {
                message: format!("cannot start {threads} threads: {error}"),
                hint: "ask for fewer with `--threads N`".to_owned(),
            }
        })?;
        let instructions = Instructions::detect();
        Ok(Self { pool, instructions, iterations: iterations.unwrap_or(ITERATIONS), cohort: None })
    }

    fn loaded(&self) -> Result<&Cohort, BackendError> {
        self.cohort.as_ref().ok_or_else(nothing_loaded)
    }
}

fn nothing_loaded() -> BackendError {
    BackendError::Device { kernel: "advance", message: "no cohort is loaded".to_owned() }
}

impl Backend for CpuBackend {
    fn describe(&self) -> String {
        let threads = self.pool.current_num_threads();
        let s = if threads == 1 { "" } else { "s" };
        format!("cpu ({threads} thread{s}, {})", self.instructions.name())
    }

    fn kind(&self) -> &'static str {
        "cpu"
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
        let instructions = self.instructions;
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
                .for_each_init(Desk::default, |desk, ((((state, params), nets), lessons), rows)| {
                    // The kernel would leave at once, but its nets would be copied twice for that.
                    if stop.holds(state) {
                        return;
                    }
                    let own = desk.take(nets);
                    let mut learner = Learner { shared, params, state, nets: own, lessons, rows };
                    run_advance(instructions, &mut learner, &dispatch);
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
                debug_assert_eq!(episode.state, STATE_FRESH);
                let shared = &cohort.shared;
                run_evaluate(self.instructions, episode, shared, params, nets, &dispatch, number as u32);
                debug_assert!(episode.state <= STATE_CUT);
            });
        });
        Ok(episodes)
    }

    fn memory(&mut self) -> Result<&Cohort, BackendError> {
        self.loaded()
    }

    fn step(&mut self, shared: &CohortData, robots: &mut [Robot], iterations: u32) -> Result<(), BackendError> {
        let instructions = self.instructions;
        self.pool.install(|| {
            robots.par_chunks_mut(ABREAST).for_each(|robots| {
                for _quantum in 0..iterations {
                    run_step(instructions, robots, shared);
                }
            });
        });
        Ok(())
    }
}
