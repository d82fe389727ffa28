//! What is kept of the learners in training, so that little is lost when a run is stopped.
//!
//! One cohort is in training at a time: the skills that arms share are learned, or some arms' learners go on from them. A
//! learner's whole position is in its memory, so going on is training as ever, without the tests that are taken already.

use super::batch_group::{BatchGroup, LearnerId};
use super::callbacks::{Callbacks, Signal, Snapshot};
use super::codec::{self, PartError, pod};
use super::pretraining::Pretraining;
use super::result::LearnerResult;
use super::validate;
use crate::backend::Cohort;
use crate::config::plan::Plan;
use crate::layout::LearnerState;
use crate::run_folder::{RecordError, RunFolder};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::time::{Duration, Instant};

/// Time between two checkpoints if none is given.
pub const INTERVAL: Duration = Duration::from_secs(60);
/// Saving takes at most one part in so many of the time.
const SHARE: u32 = 10;

/// A cohort as it is saved. Its hyper-parameters and shapes are not kept: they follow from the plan and from what the
/// learners go on from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CohortState<'a> {
    /// The tests taken so far; after training, all that the learners leave.
    pub results: Cow<'a, [LearnerResult]>,
    /// Whether training is over, so that only tests under alterations are to come. Lessons and rows are then not kept.
    pub trained: bool,
    #[serde(with = "pod")]
    pub(super) states: Cow<'a, [LearnerState]>,
    #[serde(with = "pod")]
    pub(super) nets: Cow<'a, [f32]>,
    #[serde(with = "pod")]
    pub(super) lessons: Cow<'a, [u32]>,
    #[serde(with = "pod")]
    pub(super) rows: Cow<'a, [u32]>,
}

impl<'a> CohortState<'a> {
    fn of(snapshot: &Snapshot<'a>) -> Self {
        let Snapshot { results, cohort, trained } = *snapshot;
        let kept = |words: &'a [u32]| Cow::Borrowed(if trained { &words[..0] } else { words });
        Self {
            results: Cow::Borrowed(results),
            trained,
            states: Cow::Borrowed(&cohort.states),
            nets: Cow::Borrowed(&cohort.nets),
            lessons: kept(&cohort.lessons),
            rows: kept(&cohort.rows),
        }
    }

    /// The learners, in their order.
    pub fn learners(&self) -> Vec<LearnerId> {
        self.results.iter().map(|result| result.id).collect()
    }

    /// Puts the learners back into a cohort of the same ones, and hands over what they leave so far.
    pub fn restore(self, cohort: &mut Cohort) -> Vec<LearnerResult> {
        cohort.states = self.states.into_owned();
        cohort.nets = self.nets.into_owned();
        if !self.trained {
            cohort.lessons = self.lessons.into_owned();
            cohort.rows = self.rows.into_owned();
        }
        self.results.into_owned()
    }
}

/// What a checkpoint file holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint<'a> {
    /// The skills that the learners share, or that they are learning to share.
    pub pretraining: Cow<'a, Pretraining>,
    /// How far the cohort in training is.
    pub cohort: CohortState<'a>,
}

impl Checkpoint<'static> {
    /// Reads a checkpoint.
    ///
    /// # Errors
    /// Where the bytes are not those of a cohort of this experiment.
    pub fn read(bytes: &[u8], plan: &Plan, groups: &[BatchGroup]) -> Result<Self, PartError> {
        let checkpoint: Self = codec::read(bytes)?;
        let fits = validate::is_pretraining(plan, groups, &checkpoint.pretraining)
            && validate::is_cohort(plan, groups, &checkpoint.cohort);
        if fits { Ok(checkpoint) } else { Err(PartError) }
    }
}

/// When the next checkpoint is due.
#[derive(Debug)]
pub struct SaveTimer {
    interval: Duration,
    due: Instant,
}

impl SaveTimer {
    /// The first is due an interval from now.
    pub fn new(interval: Duration) -> Self {
        Self { interval, due: Instant::now() + interval }
    }

    fn saved(&mut self, took: Duration) {
        self.due = Instant::now() + self.interval.max(took * (SHARE - 1));
    }
}

/// Looks after a cohort of a run: passes on how far the whole run is, and saves the cohort.
pub(super) struct CohortCallbacks<'a> {
    pub(super) folder: &'a mut RunFolder,
    pub(super) run: &'a mut dyn Callbacks,
    pub(super) timer: &'a mut SaveTimer,
    pub(super) pretraining: &'a Pretraining,
    /// Trials that were finished before.
    pub(super) before: u64,
    /// For how many learners a learner's trials count, as a fraction.
    pub(super) share: (u64, u64),
}

impl Callbacks for CohortCallbacks<'_> {
    fn progress(&mut self, trials: u64) -> Signal {
        match self.run.progress(self.before + trials * self.share.0 / self.share.1.max(1)) {
            Signal::Continue if Instant::now() >= self.timer.due => Signal::Save,
            signal => signal,
        }
    }

    fn save(&mut self, snapshot: &Snapshot<'_>) -> Result<(), RecordError> {
        let begun = Instant::now();
        let pretraining = Cow::Borrowed(self.pretraining);
        let checkpoint = Checkpoint { pretraining, cohort: CohortState::of(snapshot) };
        self.folder.write_checkpoint(&mut |out| codec::write(&checkpoint, out))?;
        self.timer.saved(begun.elapsed());
        Ok(())
    }
}
