//! Demonstrations: the bank of taught lessons, and the planner's own tests.

use super::value_iteration::Planner;
use crate::backend::cpu::CPU;
use crate::config::plan::SkillPlan;
use crate::env::reset::{start_pose, start_region};
use crate::env::workgroup::{CohortData, Workgroup};
use crate::layout::{
    ELEMENTARY_STEP_WORDS, HyperParams, LESSON_HEADER_WORDS, LessonHeader, NO_CHILD, SkillShape, TERMINATED, TRUNCATED,
};
use crate::math::rng::{Purpose, Stream, draw};
use crate::policy::persistence::Choices;
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
    /// What opens the lesson.
    pub fn header(&self) -> LessonHeader {
        bytemuck::pod_read_unaligned(bytemuck::cast_slice(&self.lesson[..LESSON_HEADER_WORDS]))
    }

    /// Steps taken.
    pub fn steps(&self) -> u32 {
        self.header().steps
    }

    /// Whether the goal was achieved.
    pub fn achieved(&self) -> bool {
        self.header().end == TERMINATED
    }

    /// Sum of the rewards.
    pub fn reward(&self) -> f32 {
        self.header().reward
    }

    /// Collisions.
    pub fn collisions(&self) -> u32 {
        self.header().collisions
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
        let mut lesson = vec![0; self.plan.lesson_stride as usize];
        let mut group = Workgroup {
            skills: std::slice::from_ref(self.plan),
            lessons: &mut lesson,
            ..Workgroup::new(self.shared, std::slice::from_ref(self.params), &CPU.hot)
        };
        let words = self.plan.record_words as usize;
        let all = (1 << self.plan.children) - 1;
        let free = Choices { applicable: all, offered: all, allowed: all, decision: 1 };
        group.reset(start);
        loop {
            let step = group.agent.step;
            (group.forms.draw_step)(&mut group, self.stream(trial, step, Purpose::Teacher));
            group.observe_and_score(0);
            if step > 0 {
                group.write_outcome(words, 0, step as usize - 1, group.agent.events, group.agent.earned);
            }
            if words > ELEMENTARY_STEP_WORDS {
                group.write_high_level(0);
            }
            let achieved = group.skill_events(0) & self.plan.ends != 0;
            if achieved || step >= self.params.max_steps {
                group.set_choice(NO_CHILD, free);
                group.write_step(words, 0, step as usize);
                let end = if achieved { TERMINATED } else { TRUNCATED };
                group.write_header(0, step, end, group.agent.reward, group.agent.collisions);
                let returned = group.agent.returned;
                return Demonstration { start, lesson, returned };
            }
            let pose = Pose { x: group.agent.x, y: group.agent.y, heading: group.agent.heading };
            let child = self.planner.choose(self.shared, group.agent.origin, pose) as u32;
            group.set_choice(child, free);
            group.write_step(words, 0, step as usize);
            group.apply_action(0, self.plan.child[child as usize]);
        }
    }
}

/// What a teacher knows of an arm's numbers, those of the robot and of the task, with the run's own key.
pub fn teacher_params(params: &HyperParams) -> HyperParams {
    HyperParams {
        run_seed: params.run_seed,
        learner_seed: u32::MAX,
        noise: params.noise,
        light_decay: params.light_decay,
        door_decay: params.door_decay,
        range_decay: params.range_decay,
        beside_near: params.beside_near,
        beside_far: params.beside_far,
        gamma: params.gamma,
        max_steps: params.max_steps,
        reward: params.reward,
        ..HyperParams::zeroed()
    }
}
