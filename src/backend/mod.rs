//! One narrow interface to whatever executes the kernels.
//!
//! Both backends execute the same three kernels on the same memory and, where the adapter is exact, leave
//! the same bytes. `cpu` touches no wgpu and runs where no Vulkan is installed.

pub mod cpu;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod host;
pub mod memory;
pub mod open;
pub mod parity;
pub mod reference;

use crate::env::workgroup::CohortData;
use crate::layout::{EPISODE_FRESH, Episode, HyperParams, LearnerState, PHASE_DONE, PHASE_START, Robot};
use std::ops::Range;

/// All memory of the learners that train together.
#[derive(Debug, Clone)]
pub struct Cohort {
    /// What all learners share.
    pub shared: CohortData,
    /// Skills of each learner.
    pub skills: usize,
    /// One record per learner and skill.
    pub params: Vec<HyperParams>,
    /// One per learner.
    pub states: Vec<LearnerState>,
    /// Words of one learner's nets.
    pub nets_stride: usize,
    /// All learners' nets.
    pub nets: Vec<f32>,
    /// Words of one learner's lessons.
    pub lessons_stride: usize,
    /// All learners' lessons.
    pub lessons: Vec<u32>,
    /// Words of one learner's rows.
    pub rows_stride: usize,
    /// All learners' trial tables.
    pub rows: Vec<u32>,
}

/// The point before which learners stop: the first trial at or beyond `trial` of skill `skill`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stop {
    /// Index of the skill.
    pub skill: u32,
    /// Number of trials of it.
    pub trial: u32,
}

impl Stop {
    /// Whether a learner waits at this point, has finished, or has failed.
    pub fn holds(self, state: &LearnerState) -> bool {
        let beyond = state.skill > self.skill && state.phase <= PHASE_START;
        let reached = state.skill == self.skill && state.phase == PHASE_START && state.trial >= self.trial;
        beyond || reached || state.phase >= PHASE_DONE
    }
}

/// One test of every learner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Test {
    /// Index of the skill.
    pub skill: u32,
    /// Number of the test, which keeps its noise apart from other tests'.
    pub number: u32,
    /// Test trials of each learner.
    pub episodes: u32,
}

/// What outputs hold before a kernel writes them: a NaN that no arithmetic makes.
pub const UNWRITTEN: u32 = 0xffff_ffff;

/// Test trials that have not begun. A field that the kernel leaves unset shows as a NaN.
fn fresh(count: usize) -> Vec<Episode> {
    let unset: Episode = bytemuck::cast([UNWRITTEN; size_of::<Episode>() / 4]);
    vec![Episode { state: EPISODE_FRESH, ..unset }; count]
}

/// What follows where no cohort is loaded.
fn nothing_loaded() -> BackendError {
    BackendError::Device { kernel: "train", message: "no cohort is loaded".to_owned() }
}

/// Executes kernels. A call that does not say when it returns an error does so where the device fails.
pub trait Backend {
    /// What to call it in messages and manifests, such as `cpu, 2 threads`.
    fn describe(&self) -> String;

    /// `cpu` or `gpu`.
    fn kind(&self) -> &'static str;

    /// The adapter's name, if there is one.
    fn adapter(&self) -> Option<String>;

    /// Learners that best train together, given the bytes that one takes. No result depends on it.
    ///
    /// # Errors
    /// [`BackendError::NoRoom`] if not even one fits the memory.
    fn cohort_size(&self, bytes_per_learner: usize) -> Result<usize, BackendError>;

    /// Takes the cohort's memory; everything else works on it until the next load.
    ///
    /// # Errors
    /// Where the device cannot hold it.
    fn load(&mut self, cohort: Cohort) -> Result<(), BackendError>;

    /// Moves every learner that does not hold at `stop` on by a bounded amount of work, about half a
    /// second's in all, and shows where the learners stand.
    fn advance(&mut self, stop: Stop) -> Result<&[LearnerState], BackendError>;

    /// Learners of the cohort, 0 where none is loaded.
    fn learners(&self) -> usize;

    /// Runs a test of some of the learners to its end: their episodes, learner by learner.
    fn evaluate_some(&mut self, test: Test, learners: Range<usize>) -> Result<Vec<Episode>, BackendError>;

    /// Runs a test of all learners.
    fn evaluate(&mut self, test: Test) -> Result<Vec<Episode>, BackendError> {
        self.evaluate_some(test, 0..self.learners())
    }

    /// The cohort's memory as it stands.
    fn memory(&mut self) -> Result<&Cohort, BackendError>;

    /// Lets robots carry out their action `iterations` times each.
    fn step(&mut self, shared: &CohortData, robots: &mut [Robot], iterations: u32) -> Result<(), BackendError>;
}

/// Why a backend could not be had or failed.
#[derive(Debug, thiserror::Error)]
pub enum BackendError {
    /// No adapter fits what was asked for.
    #[error("{message}\nhint: {hint}")]
    Unavailable {
        /// What was looked for and what was found.
        message: String,
        /// What the user can do.
        hint: String,
    },
    /// This program was built without what was asked for.
    #[error(
        "this build of skilltree has no GPU backend\nhint: use `--backend cpu`, or build with the feature `gpu`, which is on by default"
    )]
    NotBuilt,
    /// The cohort does not fit.
    #[error("the device cannot hold {learners} learners: {message}\nhint: use a smaller cohort, `--cohort N`")]
    TooLarge {
        /// Learners in the cohort.
        learners: usize,
        /// Which limit was met.
        message: String,
    },
    /// Not even one learner fits.
    #[error(
        "one learner takes {:.1} MB, and there is room for {:.1} MB\nhint: end other programs, or make learners smaller: \
         fewer lessons in `learning.replay_capacity`, less `max_steps`, fewer skills",
        *bytes as f64 / 1e6,
        *room as f64 / 1e6
    )]
    NoRoom {
        /// What one learner takes.
        bytes: u64,
        /// What there is for a cohort: a share of the free memory, or a limit of the device.
        room: u64,
    },
    /// The device was lost, hung or misbehaved.
    #[error(
        "the device failed in kernel `{kernel}`: {message}\nhint: run the same command again; finished learners are kept"
    )]
    Device {
        /// Kernel that was running.
        kernel: &'static str,
        /// What the driver said.
        message: String,
    },
}
