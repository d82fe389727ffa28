//! Demonstrations: the bank of taught lessons, and the planner's own tests.

use super::value_iteration::{Planner, origin_of};
use crate::config::plan::SkillPlan;
use crate::env::reset::{start_pose, start_region};
use crate::env::workgroup::{CohortData, Scratch};
use crate::layout::{Agent, BASE_WORDS, HyperParams, SkillShape};
use crate::learn::lesson::{CUT, ENDED, note, write_header, write_outcome, write_record};
use crate::math::rng::{Purpose, Stream, draw, draw_step};
use crate::policy::hierarchy::{execute, place, sense};
use crate::policy::persistence::{Options, extend};
use crate::policy::select::NO_CHILD;
use crate::world::Pose;
use bytemuck::Zeroable;
use rayon::prelude::*;

/// Demonstrations tried for each lesson wanted, before the teacher gives up.
const TRIES: u32 = 16;
/// Demonstrations made at a time.
const BATCH: u32 = 64;

/// A skill to be taught: its planner and everything that its trials depend on.
#[derive(Debug)]
pub struct Teacher<'a> {
    /// What all learners share: floor, region cells.
    pub shared: &'a CohortData,
    /// The solved task.
    pub planner: &'a Planner,
    /// The skill's shape.
    pub plan: &'a SkillShape,
    /// Noise, rewards and limits of the trials; the seeds are the run's.
    pub params: &'a HyperParams,
    /// Number of the skill, which keeps its random numbers apart.
    pub number: u32,
}

/// One demonstration.
#[derive(Debug, Clone)]
pub struct Demonstration {
    /// Where it began.
    pub start: Pose,
    /// The lesson's words, as they stand in the bank.
    pub lesson: Vec<u32>,
    /// Sum of the rewards, discounted as the skill's learners do.
    pub returned: f32,
}

impl Demonstration {
    /// Steps taken.
    pub fn steps(&self) -> u32 {
        self.lesson[0]
    }

    /// Whether the goal was achieved.
    pub fn achieved(&self) -> bool {
        self.lesson[1] == ENDED
    }

    /// Sum of the rewards.
    pub fn reward(&self) -> f32 {
        f32::from_bits(self.lesson[2])
    }

    /// Collisions.
    pub fn collisions(&self) -> u32 {
        self.lesson[3]
    }
}

/// The teacher could not achieve the skill often enough.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "skill `{skill}`: the teacher achieved it in only {lessons} of {tries} demonstrations, and {wanted} lessons are wanted\nhint: widen `starts`, raise `max_steps`, or lower `teacher.lessons`"
)]
pub struct TeacherError {
    /// The skill's name.
    pub skill: String,
    /// Lessons that succeeded.
    pub lessons: u32,
    /// Demonstrations tried.
    pub tries: u32,
    /// Lessons wanted.
    pub wanted: u32,
}

impl Teacher<'_> {
    /// Words of `wanted` lessons, each a demonstration that achieved the goal (or ran its full length, where
    /// the skill has no end).
    ///
    /// # Errors
    /// Where too few demonstrations succeed.
    pub fn bank(&self, skill: &SkillPlan, wanted: u32) -> Result<Vec<u32>, TeacherError> {
        let mut words = Vec::new();
        let mut lessons = 0;
        let mut tried = 0;
        while lessons < wanted && tried < wanted * TRIES {
            let batch: Vec<Demonstration> = (tried..tried + BATCH)
                .into_par_iter()
                .map(|trial| self.demonstrate(trial, self.training_start(trial)))
                .collect();
            tried += BATCH;
            for demonstration in batch {
                if lessons < wanted && (demonstration.achieved() || self.plan.ends == 0) {
                    words.extend(demonstration.lesson);
                    lessons += 1;
                }
            }
        }
        if lessons < wanted {
            return Err(TeacherError { skill: skill.name.clone(), lessons, tries: tried, wanted });
        }
        Ok(words)
    }

    /// The planner's own test trials, from the region in which the skill is tested.
    pub fn tests(&self, episodes: u32) -> Vec<Demonstration> {
        // Above the bank's numbers, so that no test repeats a lesson.
        let first = 1 << 20;
        (first..first + episodes)
            .into_par_iter()
            .map(|trial| {
                let words = draw(self.stream(trial, 0, Purpose::TeacherStart), 0);
                let pose = start_pose(&self.shared.tables, self.plan.tests_offset, self.plan.tests_count, words);
                self.demonstrate(trial, pose)
            })
            .collect()
    }

    fn stream(&self, trial: u32, step: u32, purpose: Purpose) -> Stream {
        let key = [self.params.run_seed, self.params.learner_seed];
        Stream { key, skill: self.number, trial, step, purpose: purpose as u32 }
    }

    fn training_start(&self, trial: u32) -> Pose {
        let words = draw(self.stream(trial, 0, Purpose::TeacherStart), 0);
        let region = start_region(self.plan, words[0]) as usize;
        start_pose(&self.shared.tables, self.plan.start_offset[region], self.plan.start_count[region], words)
    }

    fn demonstrate(&self, trial: u32, start: Pose) -> Demonstration {
        let mut scratch = Scratch::default();
        let mut agent = Agent::zeroed();
        let mut lesson = vec![0; self.plan.lesson_stride as usize];
        let origin = origin_of(self.shared, start);
        let words = self.plan.record_words;
        let all = (1 << self.plan.children) - 1;
        let free = Options { applicable: all, choices: all, allowed: all, decision: 1 };
        place(&mut agent, self.shared, start);
        loop {
            let step = agent.step;
            let random = draw_step(self.stream(trial, step, Purpose::Teacher));
            sense(&mut agent, self.shared, &mut scratch, self.params, &random);
            if step > 0 {
                write_outcome(&mut lesson, words, 0, step - 1, agent.events, agent.earned);
            }
            if words > BASE_WORDS as u32 {
                let world = &self.shared.floor.plan;
                extend(&agent, world, &mut scratch, self.plan, self.params, self.number);
            }
            let achieved = agent.events & self.plan.ends != 0;
            if achieved || step >= self.params.max_steps {
                note(&mut scratch.record, NO_CHILD, free);
                write_record(&mut lesson, &scratch.record, words, 0, step);
                let end = if achieved { ENDED } else { CUT };
                write_header(&mut lesson, 0, step, end, agent.reward, agent.collisions);
                return Demonstration { start, lesson, returned: agent.returned };
            }
            let pose = Pose { x: agent.x, y: agent.y, heading: agent.heading };
            let child = self.planner.choose(self.shared, origin, pose) as u32;
            note(&mut scratch.record, child, free);
            write_record(&mut lesson, &scratch.record, words, 0, step);
            execute(&mut agent, self.shared, self.params, self.plan.child[child as usize], &random);
        }
    }
}

/// HyperParams under which a teacher demonstrates: an arm's, with the run's own key.
pub fn teacher_params(params: &HyperParams) -> HyperParams {
    HyperParams { learner_seed: u32::MAX, ..*params }
}
