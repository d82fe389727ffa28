//! Writing lessons and rows of the trial table.
//!
//! The choice of a step is one word: the child, from bit 8 the children that were allowed, from bit 16 those among which
//! a free choice is made, from bit 24 the events, and bit 31 where the choice was free. Events and reward are written one
//! step later, by the observation that settles them.

use crate::env::workgroup::Workgroup;
use crate::layout::events::{DECISION_BIT, EVENTS_FROM, RECORDED_EVENTS};
use crate::layout::{LESSON_HEADER_WORDS, LessonHeader, Step, TERMINATED, TrialRecord};
use crate::policy::persistence::Choices;
use std::mem::offset_of;

/// Word of a step that holds the choice.
pub const STEP_CHOICE: usize = offset_of!(Step, choice) / 4;
/// Word of a step that holds the reward.
pub const STEP_REWARD: usize = offset_of!(Step, reward) / 4;
/// Word of a lesson that holds its number of steps.
pub const LESSON_STEPS: usize = offset_of!(LessonHeader, steps) / 4;
/// Word of a lesson that tells how it ended.
pub const LESSON_END: usize = offset_of!(LessonHeader, end) / 4;

/// Packs what was chosen, and among what.
#[inline(always)]
pub fn choice_word(child: u32, choices: Choices) -> u32 {
    child | (choices.allowed << 8) | (choices.offered << 16) | (choices.decision << DECISION_BIT)
}

/// The child that was chosen.
#[inline(always)]
pub fn choice_child(word: u32) -> u32 {
    word & 0xff
}

/// Bits of the children that were allowed.
#[inline(always)]
pub fn choice_allowed(word: u32) -> u32 {
    (word >> 8) & 0xff
}

/// Bits of the children among which a free choice is made.
#[inline(always)]
pub fn choice_offered(word: u32) -> u32 {
    (word >> 16) & 0xff
}

/// Whether the choice was free.
#[inline(always)]
pub fn choice_is_free(word: u32) -> bool {
    (word >> DECISION_BIT) != 0
}

impl Workgroup<'_> {
    /// Notes in the record what was chosen, and among what.
    pub fn set_choice(&mut self, child: u32, choices: Choices) {
        self.record.choice = choice_word(child, choices);
        self.record.reward = 0.0;
    }

    /// Stores the first `words` words of the record as step `step` of the lesson at word `lesson`.
    pub fn write_step(&mut self, words: usize, lesson: usize, step: usize) {
        let at = lesson + LESSON_HEADER_WORDS + step * words;
        self.lessons[at..at + words]
            .copy_from_slice(&bytemuck::cast_slice(std::slice::from_ref(&self.record))[..words]);
    }

    /// Adds what step `step` of the lesson brought about.
    pub fn write_outcome(&mut self, words: usize, lesson: usize, step: usize, events: u32, earned: f32) {
        let at = lesson + LESSON_HEADER_WORDS + step * words;
        self.lessons[at + STEP_CHOICE] |= (events & RECORDED_EVENTS) << EVENTS_FROM;
        self.lessons[at + STEP_REWARD] = earned.to_bits();
    }

    /// Completes a lesson.
    pub fn write_header(&mut self, lesson: usize, steps: u32, end: u32, reward: f32, collisions: u32) {
        let header = LessonHeader { steps, end, reward, collisions };
        self.lessons[lesson..lesson + LESSON_HEADER_WORDS]
            .copy_from_slice(&bytemuck::cast::<_, [u32; LESSON_HEADER_WORDS]>(header));
    }

    /// Appends a row to the trial table.
    pub fn write_row(&mut self, trial: u32, steps: u32, reward: f32, end: u32, collisions: u32, taught: u32) {
        let success = u32::from(end == TERMINATED);
        let (skill, actions) = (self.state.skill, self.state.actions);
        self.rows[self.state.rows as usize] =
            TrialRecord { skill, trial, actions, steps, reward, success, collisions, taught };
        self.state.rows += 1;
    }
}
