//! What random numbers are for.

/// What a random number is for. The purpose is part of the counter, so streams never meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Purpose {
    /// Everything in one primitive step of training: the draw is the lane.
    Step = 1,
    /// Everything in one primitive step of a test.
    Test = 2,
    /// Where a training trial starts.
    Start = 3,
    /// Where a test trial starts.
    TestStart = 4,
    /// Which lesson is replayed.
    Replay = 5,
    /// Initial weights.
    Init = 6,
    /// Which lessons of the bank a learner is given.
    Lesson = 7,
    /// Steps under given actions: `probe` and the planner's demonstrations.
    Given = 8,
    /// One primitive step of the teacher.
    Teacher = 9,
    /// Where a demonstration starts.
    TeacherStart = 10,
    /// Resampling in statistics; never used by a kernel.
    Statistics = 11,
    /// Which steps between decisions are learned from.
    Inner = 12,
    /// Points of a sweep; never used by a kernel.
    Sweep = 13,
}

/// Name and code of every purpose that a shader names.
pub const PURPOSES: &[(&str, Purpose)] = &[
    ("PURPOSE_STEP", Purpose::Step),
    ("PURPOSE_TEST", Purpose::Test),
    ("PURPOSE_START", Purpose::Start),
    ("PURPOSE_TEST_START", Purpose::TestStart),
    ("PURPOSE_REPLAY", Purpose::Replay),
    ("PURPOSE_INIT", Purpose::Init),
    ("PURPOSE_LESSON", Purpose::Lesson),
    ("PURPOSE_GIVEN", Purpose::Given),
    ("PURPOSE_INNER", Purpose::Inner),
];
