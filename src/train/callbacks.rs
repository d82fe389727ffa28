//! What is told, asked and saved while learners train.

use super::checkpoint::CohortState;
use crate::backend::BackendError;
use crate::run_folder::{Divergence, RecordError};
use std::path::Path;

/// What training should do next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Signal {
    /// Go on.
    Continue,
    /// Save everything, and go on.
    Save,
    /// Save everything, and end.
    Stop,
}

/// Told how training goes, and asked whether it should go on. All methods but the first have nothing to do.
pub trait Callbacks {
    /// So many trials are finished, of all learners together; in a run, those of an earlier start included.
    fn progress(&mut self, trials: u64) -> Signal;

    /// Saves what is needed to go on from here. A run does so by itself.
    fn save(&mut self, _cohort: CohortState<'_>) -> Result<(), RecordError> {
        Ok(())
    }

    /// A cohort's results are on disk; so many learners are now.
    fn committed(&mut self, _learners: usize) {}

    /// A learner was frozen because a number stopped being finite.
    fn diverged(&mut self, _divergence: &Divergence) {}

    /// A checkpoint could not be used, and where it is now.
    fn set_aside(&mut self, _why: &RecordError, _now: &Path) {}
}

/// Lets training go on to its end.
impl Callbacks for () {
    fn progress(&mut self, _trials: u64) -> Signal {
        Signal::Continue
    }
}

/// Why a cohort has not come to its end.
#[derive(Debug, thiserror::Error)]
pub enum Interrupted {
    /// The device failed.
    #[error(transparent)]
    Backend(#[from] BackendError),
    /// What was to be saved could not be.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// It was told to, and is saved.
    #[error("stopped and saved")]
    Stopped,
}
