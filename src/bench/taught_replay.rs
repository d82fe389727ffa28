//! Learners of one skill that replay their taught lessons again and again.

use super::BenchError;
use crate::backend::{Backend, BackendError, Cohort, Stop};
use crate::config::plan::Plan;
use crate::env::workgroup::Workgroup;
use crate::kernels::plain::PLAIN;
use crate::layout::{HyperParams, SkillShape};
use crate::train::batch_group::groups;

/// The learners' memory before their first replay.
#[derive(Debug)]
pub struct TaughtReplay {
    /// All of it.
    pub cohort: Cohort,
}

impl TaughtReplay {
    /// The taught learners of the plan's first arm, one per seed.
    ///
    /// # Errors
    /// Where the teacher fails.
    pub fn new(plan: &Plan) -> Result<Self, BenchError> {
        let group = groups(plan)?.swap_remove(0);
        Ok(Self { cohort: group.cohort(plan, &group.learners(plan)) })
    }

    /// Shape of the skill that is learned.
    pub fn skill(&self) -> &SkillShape {
        &self.cohort.shared.skills[0]
    }

    /// How a learner learns.
    pub fn params(&self, learner: usize) -> &HyperParams {
        &self.cohort.params[learner * self.cohort.skills]
    }

    /// Word of the bank at which taught lesson `number` of a learner stands.
    pub fn lesson_offset(&self, learner: usize, number: u32) -> usize {
        let params = std::slice::from_ref(self.params(learner));
        Workgroup::new(&self.cohort.shared, params, &PLAIN).taught_lesson(number) as usize
    }

    /// Transitions that all learners replay in one pass over their lessons.
    pub fn transitions(&self) -> u64 {
        let learners = 0..self.cohort.states.len();
        let lessons =
            learners.flat_map(|learner| (0..self.params(learner).lessons).map(move |lesson| (learner, lesson)));
        lessons.map(|(learner, lesson)| u64::from(self.cohort.shared.bank[self.lesson_offset(learner, lesson)])).sum()
    }

    /// The learners replay all passes on a backend that has loaded their memory.
    ///
    /// # Errors
    /// Where the backend fails.
    pub fn replay(backend: &mut dyn Backend) -> Result<(), BackendError> {
        let stop = Stop { skill: 0, trial: 0 };
        while !backend.advance(stop)?.iter().all(|state| stop.holds(state)) {}
        Ok(())
    }
}
