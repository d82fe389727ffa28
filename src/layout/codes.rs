//! Numbers that stand for something, in both languages.

codes! {
    /// Stands for no child: none runs, or none was chosen.
    NO_CHILD = 255;

    /// Phase of a learner: learning from the taught lessons before the first trial.
    PHASE_TEACH = 0;
    /// About to begin a trial; where learners wait for a test.
    PHASE_START = 1;
    /// In a trial.
    PHASE_ACT = 2;
    /// Replaying after a trial.
    PHASE_REPLAY = 3;
    /// All skills trained.
    PHASE_DONE = 4;
    /// Frozen: a number stopped being finite.
    PHASE_FAILED = 5;

    /// State of a test trial: not begun.
    EPISODE_FRESH = 0;
    /// Running.
    EPISODE_RUNNING = 1;
    /// Ended with the goal achieved.
    EPISODE_TERMINATED = 2;
    /// Cut at the step limit.
    EPISODE_TRUNCATED = 3;

    /// End of a lesson: the goal was achieved.
    TERMINATED = 1;
    /// End of a lesson: the step limit cut the trial.
    TRUNCATED = 2;
}
