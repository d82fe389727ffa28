//! Lessons as a learner's memory and the teacher's bank hold them, taken apart.

use skilltree::backend::Cohort;
use skilltree::layout::{LESSON_HEADER_WORDS, LessonHeader, STEP_WORDS, Step};

/// A recorded trial.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Lesson {
    pub(crate) header: LessonHeader,
    /// The steps, and last the observation that closed the trial.
    pub(crate) records: Vec<Step>,
}

impl Lesson {
    /// The lesson at the beginning of some words, of which each step takes `step_words`.
    pub(crate) fn read(words: &[u32], step_words: u32) -> Self {
        let (header, steps) = words.split_at(LESSON_HEADER_WORDS);
        let header: LessonHeader = bytemuck::pod_read_unaligned(bytemuck::cast_slice(header));
        let records = steps.chunks(step_words as usize).take(header.steps as usize + 1).map(step_of).collect();
        Self { header, records }
    }
}

/// A step from its recorded words; those that are not recorded are 0.
pub(crate) fn step_of(words: &[u32]) -> Step {
    let mut all = [0; STEP_WORDS];
    all[..words.len()].copy_from_slice(words);
    bytemuck::cast(all)
}

/// The trials of a skill that a learner remembers, by slot.
pub(crate) fn remembered(cohort: &Cohort, learner: usize, skill: usize) -> Vec<Lesson> {
    let shape = &cohort.shared.skills[skill];
    let params = &cohort.params[learner * cohort.skills + skill];
    let lessons = &cohort.lessons[learner * cohort.lessons_stride..][..cohort.lessons_stride];
    let slots = lessons[shape.memory_offset as usize..].chunks(shape.lesson_stride as usize);
    let kept = params.trials.min(params.replay_capacity) as usize;
    slots.take(kept).map(|slot| Lesson::read(slot, shape.record_words)).collect()
}
