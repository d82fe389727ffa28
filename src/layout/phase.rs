//! The states of a learner.

/// Learning from the taught lessons before the first trial.
pub const PHASE_TEACH: u32 = 0;
/// About to begin a trial; where learners wait for a test.
pub const PHASE_START: u32 = 1;
/// In a trial.
pub const PHASE_ACT: u32 = 2;
/// Replaying after a trial.
pub const PHASE_REPLAY: u32 = 3;
/// All skills trained.
pub const PHASE_DONE: u32 = 4;
/// Frozen: a number stopped being finite.
pub const PHASE_FAILED: u32 = 5;
/// Name and code of every phase.
pub const PHASES: &[(&str, u32)] = &[
    ("PHASE_TEACH", PHASE_TEACH),
    ("PHASE_START", PHASE_START),
    ("PHASE_ACT", PHASE_ACT),
    ("PHASE_REPLAY", PHASE_REPLAY),
    ("PHASE_DONE", PHASE_DONE),
    ("PHASE_FAILED", PHASE_FAILED),
];
