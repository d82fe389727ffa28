//! Arms that can train in one cohort: their skills agree in all but numbers, and one teacher serves them.

use super::fingerprint::{classes, of_tasks};
use crate::backend::Cohort;
use crate::config::plan::{Action, ArmPlan, Event, Plan, SkillPlan};
use crate::env::segments::SegmentGrid;
use crate::env::workgroup::CohortData;
use crate::layout::{BASE_WORDS, HyperParams, SkillShape};
use crate::teacher::demonstrations::{Demonstration, Teacher, TeacherError, teacher_params};
use crate::teacher::value_iteration::{PITCH, Planner, Terms};
use crate::train::allocate::{Shape, ShapeError};
use std::rc::Rc;

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
    /// Indices of the arms in the plan, ascending.
    pub arms: Vec<usize>,
    /// Sizes and shapes.
    pub shape: Shape,
    /// The floor, the shapes, and the bank of lessons.
    pub shared: CohortData,
    /// The same in the world of each of the plan's alterations; no lessons.
    pub altered: Vec<CohortData>,
    /// The planner's own test trials of each skill; none where an earlier group has them.
    pub bounds: Vec<Option<Vec<Demonstration>>>,
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
    let arm = |index: usize| &plan.arms[index];
    let members = classes(plan.arms.len(), |index| of_tasks(arm(index)), |a, b| alike(arm(a), arm(b)));
    let mut solved = Solved::default();
    members.into_iter().map(|arms| Group::new(plan, arms, &mut solved)).collect()
}

/// Whether two arms differ in nothing but per-learner numbers that the teacher does not see.
pub(super) fn alike(a: &ArmPlan, b: &ArmPlan) -> bool {
    let bare = |skill: &SkillPlan, like: &SkillPlan| {
        let own = &skill.params;
        let params = HyperParams {
            noise: own.noise,
            light_decay: own.light_decay,
            door_decay: own.door_decay,
            range_decay: own.range_decay,
            beside_near: own.beside_near,
            beside_far: own.beside_far,
            shared_net: own.shared_net,
            max_steps: own.max_steps,
            reward: own.reward,
            ..like.params
        };
        let mut bare = SkillPlan { params, eval_at: like.eval_at.clone(), ..skill.clone() };
        for (own, other) in bare.applicable.iter_mut().zip(&like.applicable) {
            *own = if own.is_some() && other.is_some() { *other } else { *own };
        }
        bare
    };
    (a.world, a.noise, a.teacher) == (b.world, b.noise, b.teacher)
        && a.skills.len() == b.skills.len()
        && a.skills.iter().zip(&b.skills).all(|(a, b)| *a == bare(b, a))
}

/// A task as the planner sees it.
#[derive(Debug, Clone, PartialEq)]
struct Task {
    world: usize,
    terms: Terms,
    reward: [f32; Event::ALL.len()],
    ends: u32,
    actions: Vec<Action>,
}

/// Planners, and which of their tests have been made: arms share most tasks.
#[derive(Debug, Default)]
struct Solved {
    planners: Vec<(Task, Rc<Planner>)>,
    tested: Vec<(Task, String, u32, u32)>,
}

impl Solved {
    fn planner(&mut self, task: &Task, make: impl FnOnce() -> Planner) -> Rc<Planner> {
        if let Some((_, planner)) = self.planners.iter().find(|(known, _)| known == task) {
            return Rc::clone(planner);
        }
        let planner = Rc::new(make());
        self.planners.push((task.clone(), Rc::clone(&planner)));
        planner
    }

    /// Whether these tests are still to be made; from now on they are not.
    fn claim(&mut self, task: &Task, skill: &SkillPlan, episodes: u32) -> bool {
        let test = (task.clone(), skill.eval_starts.clone(), skill.params.max_steps, episodes);
        let open = !self.tested.contains(&test);
        if open {
            self.tested.push(test);
        }
        open
    }
}

impl Group {
    fn new(plan: &Plan, arms: Vec<usize>, solved: &mut Solved) -> Result<Self, SetupError> {
        let members: Vec<&ArmPlan> = arms.iter().map(|arm| &plan.arms[*arm]).collect();
        let first = members[0];
        let world = plan.world_of(first);
        let (shape, mut shared) = lay_out(&members, world)?;
        let mut bounds = Vec::new();
        let (params, ..) = shape.learner(first, plan.run_seed, 0);
        for (number, skill) in first.skills.iter().enumerate() {
            let taught = members.iter().any(|arm| arm.skills[number].params.lessons > 0);
            let task = task_of(first, skill);
            // A mirror image has nothing of its own to plan.
            if skill.mirror.is_some() {
                bounds.push(None);
                continue;
            }
            let planner = solved.planner(&task, || Planner::new(world, &shared, skill, &task.terms));
            let driven = driven(&shared.skills[number], skill);
            let teacher = Teacher {
                shared: &shared,
                planner: &planner,
                plan: &driven,
                params: &teacher_params(&params[number]),
                number: number as u32,
            };
            let bank = if taught { teacher.bank(skill, first.teacher.lessons)? } else { Vec::new() };
            bounds.push(
                solved
                    .claim(&task, skill, first.teacher.eval_episodes)
                    .then(|| teacher.tests(first.teacher.eval_episodes)),
            );
            let table = skill.oracle.then(|| planner.table(&shared, params[number].value_scale));
            let own = &mut shared.skills[number];
            own.bank_offset = shared.bank.len() as u32;
            own.bank_lessons = if taught { first.teacher.lessons } else { 0 };
            if let Some(table) = table {
                own.planned = shared.tables.len() as u32;
                shared.tables.extend(table);
            }
            shared.bank.extend(bank);
        }
        // No buffer may be empty, even where nobody is taught.
        if shared.bank.is_empty() {
            shared.bank.push(0);
        }
        let mut altered = Vec::new();
        for alteration in &plan.alterations {
            let (_, mut other) = lay_out(&members, &plan.worlds[alteration.world.unwrap_or(first.world)].world)?;
            other.bank.push(0);
            altered.push(other);
        }
        Ok(Self { arms, shape, shared, altered, bounds })
    }

    /// The group's learners, arm by arm.
    pub fn learners(&self, plan: &Plan) -> Vec<LearnerId> {
        let of_arm =
            |arm: &usize| plan.seeds.iter().map(|seed| LearnerId { arm: *arm, seed: *seed }).collect::<Vec<_>>();
        self.arms.iter().flat_map(of_arm).collect()
    }

    /// The memory of some of the group's learners before their first iteration.
    pub fn cohort(&self, plan: &Plan, learners: &[LearnerId]) -> Cohort {
        let mut cohort = Cohort {
            shared: self.shared.clone(),
            skills: self.shape.skills.len(),
            params: Vec::new(),
            states: Vec::new(),
            nets_stride: self.shape.nets_stride,
            nets: Vec::with_capacity(learners.len() * self.shape.nets_stride),
            lessons_stride: self.shape.lessons_stride,
            lessons: vec![0; learners.len() * self.shape.lessons_stride],
            rows_stride: self.shape.rows_stride,
            rows: vec![0; learners.len() * self.shape.rows_stride],
        };
        for id in learners {
            let (params, state, nets) = self.shape.learner(&plan.arms[id.arm], plan.run_seed, id.seed);
            cohort.params.extend(params);
            cohort.states.push(state);
            cohort.nets.extend(nets);
        }
        cohort
    }
}

fn lay_out(members: &[&ArmPlan], world: &crate::world::World) -> Result<(Shape, CohortData), ShapeError> {
    let mut shape = Shape::new(world, members)?;
    let shared = CohortData {
        floor: SegmentGrid::new(&shape.tables.plan, &shape.tables.words),
        skills: shape.skills.clone(),
        tables: std::mem::take(&mut shape.tables.words),
        bank: Vec::new(),
    };
    Ok((shape, shared))
}

/// What the teacher plans an arm's skills with.
pub fn terms_of(arm: &ArmPlan) -> Terms {
    Terms {
        noise: arm.noise,
        beside: arm.skills.last().map_or((0, 0), |root| (root.params.beside_near, root.params.beside_far)),
        discount: arm.teacher.discount,
        backward_cost: arm.teacher.backward_cost,
        collision_cost: arm.teacher.collision_cost,
        pitch: PITCH,
    }
}

fn task_of(arm: &ArmPlan, skill: &SkillPlan) -> Task {
    let terms = terms_of(arm);
    Task { world: arm.world, terms, reward: skill.params.reward, ends: skill.goal, actions: skill.actions() }
}

/// A skill's shape as the planner drives it: over actions.
fn driven(plan: &SkillShape, skill: &SkillPlan) -> SkillShape {
    let mut driven = *plan;
    if skill.is_high() {
        let actions = skill.actions();
        driven.children = actions.len() as u32;
        driven.record_words = BASE_WORDS as u32;
        driven.thresholded = 0;
        for (code, action) in driven.child.iter_mut().zip(actions) {
            *code = action as u32;
        }
    }
    driven
}
