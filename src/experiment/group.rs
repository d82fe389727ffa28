//! Arms that can train in one cohort: their skills agree in all but numbers, and one teacher serves them.

use crate::backend::Cohort;
use crate::config::plan::{Arm, Plan, Skill};
use crate::learner::build::{Shape, ShapeError};
use crate::learner::memory::Shared;
use crate::robot::floor::Floor;
use crate::teacher::bank::{Demonstration, Teacher, TeacherError, teacher_settings};
use crate::teacher::planner::{PITCH, Planner};

/// One learner of the experiment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LearnerId {
    /// Index of the arm in the plan.
    pub arm: usize,
    /// The learner's seed.
    pub seed: u32,
}

/// Arms with one shape and one teacher, and what they share.
#[derive(Debug)]
pub struct Group {
    /// Indices of the arms in the plan.
    pub arms: Vec<usize>,
    /// Sizes and shapes.
    pub shape: Shape,
    /// The floor, the shapes, and the bank of lessons.
    pub shared: Shared,
    /// The planner's own test trials of each skill.
    pub bounds: Vec<Vec<Demonstration>>,
}

/// Why an experiment cannot be set up.
#[derive(Debug, thiserror::Error)]
pub enum SetupError {
    /// A skill does not fit the layout or the world.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// A skill cannot be taught.
    #[error(transparent)]
    Teacher(#[from] TeacherError),
}

/// Sorts the plan's arms into groups, plans each group's skills and fills the banks.
///
/// # Errors
/// Where a skill does not fit, or its teacher fails.
pub fn groups(plan: &Plan) -> Result<Vec<Group>, SetupError> {
    let mut members: Vec<Vec<usize>> = Vec::new();
    for (index, arm) in plan.arms.iter().enumerate() {
        match members.iter_mut().find(|group| alike(&plan.arms[group[0]], arm)) {
            Some(group) => group.push(index),
            None => members.push(vec![index]),
        }
    }
    members.into_iter().map(|arms| Group::new(plan, arms)).collect()
}

/// Whether two arms differ in nothing but per-learner numbers that the teacher does not see.
fn alike(a: &Arm, b: &Arm) -> bool {
    let bare = |skill: &Skill, like: &Skill| Skill {
        learning: like.learning.clone(),
        lessons: like.lessons,
        trials: like.trials,
        ..skill.clone()
    };
    a.noise == b.noise
        && a.skills.len() == b.skills.len()
        && a.skills.iter().zip(&b.skills).all(|(a, b)| *a == bare(b, a))
}

impl Group {
    fn new(plan: &Plan, arms: Vec<usize>) -> Result<Self, SetupError> {
        let members: Vec<&Arm> = arms.iter().map(|arm| &plan.arms[*arm]).collect();
        let mut shape = Shape::new(&plan.world, &members)?;
        let floor = Floor::new(&shape.atlas.plan);
        let mut shared = Shared {
            floor,
            skills: shape.skills.clone(),
            atlas: std::mem::take(&mut shape.atlas.words),
            bank: Vec::new(),
        };
        let mut bounds = Vec::new();
        for (number, skill) in members[0].skills.iter().enumerate() {
            let taught = members.iter().any(|arm| arm.skills[number].lessons > 0);
            let (settings, ..) = shape.learner(members[0], plan.run_seed, 0);
            let settings = teacher_settings(&settings[number]);
            let planner = Planner::new(
                &plan.world,
                &shared.floor,
                skill,
                &members[0].noise,
                plan.teacher.discount,
                plan.teacher.backward_cost,
                PITCH,
            );
            let teacher = Teacher {
                shared: &shared,
                planner: &planner,
                plan: &shared.skills[number],
                settings: &settings,
                number: number as u32,
            };
            let bank = if taught { teacher.bank(skill, plan.teacher.bank)? } else { Vec::new() };
            bounds.push(teacher.tests(plan.teacher.episodes));
            shared.skills[number].bank_offset = shared.bank.len() as u32;
            shared.skills[number].bank_lessons = if taught { plan.teacher.bank } else { 0 };
            shared.bank.extend(bank);
        }
        // No buffer may be empty, even where nobody is taught.
        if shared.bank.is_empty() {
            shared.bank.push(0);
        }
        Ok(Self { arms, shape, shared, bounds })
    }

    /// The group's learners, arm by arm.
    pub fn learners(&self, plan: &Plan) -> Vec<LearnerId> {
        let of_arm =
            |arm: &usize| plan.seeds.iter().map(|seed| LearnerId { arm: *arm, seed: *seed }).collect::<Vec<_>>();
        self.arms.iter().flat_map(of_arm).collect()
    }

    /// The memory of some of the group's learners before their first quantum.
    pub fn cohort(&self, plan: &Plan, learners: &[LearnerId]) -> Cohort {
        let mut cohort = Cohort {
            shared: self.shared.clone(),
            skills: self.shape.skills.len(),
            settings: Vec::new(),
            cursors: Vec::new(),
            nets_stride: self.shape.nets_stride,
            nets: Vec::with_capacity(learners.len() * self.shape.nets_stride),
            lessons_stride: self.shape.lessons_stride,
            lessons: vec![0; learners.len() * self.shape.lessons_stride],
            rows_stride: self.shape.rows_stride,
            rows: vec![0; learners.len() * self.shape.rows_stride],
        };
        for id in learners {
            let (settings, cursor, nets) = self.shape.learner(&plan.arms[id.arm], plan.run_seed, id.seed);
            cohort.settings.extend(settings);
            cohort.cursors.push(cursor);
            cohort.nets.extend(nets);
        }
        cohort
    }
}
