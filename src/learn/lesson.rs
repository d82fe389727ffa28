//! Writing lessons and rows of the trial table.
//!
//! Word 8 of a record: child, from bit 8 the children that were allowed, from bit 16 those among which a free
//! choice is made, from bit 24 the events, and bit 31 where the choice was free. Word 9: the reward. Events and
//! reward are written one step later, by the look that settles them.

use crate::layout::events::DECISION_BIT;
pub use crate::layout::events::EVENTS_FROM;
use crate::layout::{LESSON_HEADER, LearnerState, RECORD_WORDS, ROW_WORDS};
use crate::policy::persistence::Options;

/// The goal was achieved.
pub const ENDED: u32 = 1;
/// The step limit cut the trial.
pub const CUT: u32 = 2;

/// Notes in words 8 and 9 of the record what was chosen, and among what.
#[inline(always)]
pub fn note(record: &mut [u32; RECORD_WORDS], child: u32, options: Options) {
    record[8] = child | options.allowed << 8 | options.choices << 16 | options.decision << DECISION_BIT;
    record[9] = 0;
}

/// Stores the record as step `step` of the lesson at word `lesson`.
#[inline(always)]
pub fn write_record(lessons: &mut [u32], record: &[u32; RECORD_WORDS], words: u32, lesson: u32, step: u32) {
    let at = lesson as usize + LESSON_HEADER + (step * words) as usize;
    lessons[at..at + words as usize].copy_from_slice(&record[..words as usize]);
}

/// Adds what step `step` of the lesson brought about.
#[inline(always)]
pub fn write_outcome(lessons: &mut [u32], words: u32, lesson: u32, step: u32, events: u32, earned: f32) {
    let at = lesson as usize + LESSON_HEADER + (step * words) as usize;
    lessons[at + 8] |= events << EVENTS_FROM;
    lessons[at + 9] = earned.to_bits();
}

/// Completes a lesson.
#[inline(always)]
pub fn write_header(lessons: &mut [u32], lesson: u32, steps: u32, end: u32, reward: f32, collisions: u32) {
    let at = lesson as usize;
    lessons[at] = steps;
    lessons[at + 1] = end;
    lessons[at + 2] = reward.to_bits();
    lessons[at + 3] = collisions;
}

/// Appends a row to the trial table: skill, trial, actions so far, steps, reward, success, collisions, taught.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "one argument per column")]
pub fn write_row(
    rows: &mut [u32],
    state: &mut LearnerState,
    trial: u32,
    steps: u32,
    reward: f32,
    end: u32,
    collisions: u32,
    taught: u32,
) {
    let at = state.rows as usize * ROW_WORDS;
    let success = u32::from(end == ENDED);
    let row = [state.skill, trial, state.actions, steps, reward.to_bits(), success, collisions, taught];
    rows[at..at + ROW_WORDS].copy_from_slice(&row);
    state.rows += 1;
}
