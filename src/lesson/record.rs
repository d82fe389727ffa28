//! Writing lessons and rows of the trial table.
//!
//! Word 8 of a record: child, then from bit 8 the masked child, from bit 16 the events. Word 9: the reward.

use crate::learner::layout::{Cursor, LESSON_HEADER, RECORD_WORDS, ROW_WORDS};

/// The goal was achieved.
pub const ENDED: u32 = 1;
/// The step limit cut the trial.
pub const CUT: u32 = 2;

/// Notes in word 8 and 9 of the record what was done and what it earned.
#[inline(always)]
pub fn note(record: &mut [u32; RECORD_WORDS], child: u32, masked: u32, events: u32, reward: f32) {
    record[8] = child | masked << 8 | events << 16;
    record[9] = reward.to_bits();
}

/// Stores the record as step `step` of the lesson at word `lesson`.
#[inline(always)]
pub fn write_record(lessons: &mut [u32], record: &[u32; RECORD_WORDS], lesson: u32, step: u32) {
    let at = lesson as usize + LESSON_HEADER + step as usize * RECORD_WORDS;
    lessons[at..at + RECORD_WORDS].copy_from_slice(record);
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
    cursor: &mut Cursor,
    trial: u32,
    steps: u32,
    reward: f32,
    end: u32,
    collisions: u32,
    taught: u32,
) {
    let at = cursor.rows as usize * ROW_WORDS;
    let success = u32::from(end == ENDED);
    let row = [cursor.skill, trial, cursor.actions, steps, reward.to_bits(), success, collisions, taught];
    rows[at..at + ROW_WORDS].copy_from_slice(&row);
    cursor.rows += 1;
}
