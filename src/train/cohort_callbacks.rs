//! What a run does while one of its cohorts is in training: it passes on how far the whole run is, and saves the cohort.

use super::callbacks::{Callbacks, Signal};
use super::checkpoint::{Checkpoint, CohortState};
use super::codec;
use super::pretraining::Pretraining;
use crate::run_folder::{RecordError, RunFolder};
use std::borrow::Cow;
use std::time::{Duration, Instant};

/// Time between two checkpoints if none is given.
pub const INTERVAL: Duration = Duration::from_secs(60);
/// Saving takes at most one part in so many of the time.
const SHARE: u32 = 10;

/// When the next checkpoint is due.
#[derive(Debug)]
pub(super) struct SaveTimer {
    interval: Duration,
    due: Instant,
}

impl SaveTimer {
    /// The first is due an interval from now.
    pub(super) fn new(interval: Duration) -> Self {
        Self { interval, due: Instant::now() + interval }
    }
}

/// Looks after a cohort of a run.
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

    fn save(&mut self, cohort: CohortState<'_>) -> Result<(), RecordError> {
        let begun = Instant::now();
        let checkpoint = Checkpoint { pretraining: Cow::Borrowed(self.pretraining), cohort };
        self.folder.write_checkpoint(&mut |out| codec::write(&checkpoint, out))?;
        self.timer.due = Instant::now() + self.timer.interval.max(begun.elapsed() * (SHARE - 1));
        Ok(())
    }
}
