//! Arms that can train in one cohort: their skills agree in all but numbers, and one teacher serves them.

use crate::backend::Cohort;
use crate::config::plan::{ArmPlan, Plan, SkillPlan, Threshold};
use crate::env::segments::SegmentGrid;
use crate::env::workgroup::CohortData;
use crate::layout::{ELEMENTARY_STEP_WORDS, HyperParams, SkillShape};
use crate::teacher::demonstrations::{Demonstration, Teacher, TeacherError, teacher_params};
use crate::teacher::grid::PITCH;
use crate::teacher::value_iteration::{Planner, Terms};
use crate::train::allocate::{Shape, ShapeError};
use serde::{Deserialize, Serialize};
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

/// One learner of the experiment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct LearnerId {
    /// Index of the arm in the plan.
    pub arm: usize,
    /// The learner's seed.
    pub seed: u32,
}

/// Arms with one shape and one teacher, and what they share.
#[derive(Debug)]
pub struct BatchGroup {
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
pub fn groups(plan: &Plan) -> Result<Vec<BatchGroup>, SetupError> {
    let mut planners = Planners::default();
    classes(&plan.arms, |arm| structure(plan, arm))
        .into_iter()
        .map(|arms| BatchGroup::new(plan, arms, &mut planners))
        .collect()
}

/// The group that an arm belongs to.
pub fn group_of(groups: &[BatchGroup], arm: usize) -> &BatchGroup {
    &groups[group_index(groups, arm)]
}

/// Index of the group that an arm belongs to.
pub fn group_index(groups: &[BatchGroup], arm: usize) -> usize {
    groups.iter().position(|group| group.arms.binary_search(&arm).is_ok()).unwrap_or(0)
}

/// Sorts arms into classes with one key each, in the order in which each class shows up first: their indices.
pub(super) fn classes(arms: &[ArmPlan], key: impl Fn(&ArmPlan) -> String) -> Vec<Vec<usize>> {
    let mut classes: Vec<Vec<usize>> = Vec::new();
    let mut known: HashMap<String, usize> = HashMap::new();
    for (index, arm) in arms.iter().enumerate() {
        let class = *known.entry(key(arm)).or_insert(classes.len());
        if class == classes.len() {
            classes.push(Vec::new());
        }
        classes[class].push(index);
    }
    classes
}

/// Text that is equal for arms that differ in nothing but numbers of single learners, which the teacher does not see: all
/// of the arm with these numbers made the same, so that whatever is new in an arm counts until it is made so here.
pub(super) fn structure(plan: &Plan, arm: &ArmPlan) -> String {
    let any = &plan.arms[0].skills[0];
    let bare = |skill: &SkillPlan| {
        let applicable = skill.applicable.iter().map(|threshold| threshold.map(|_| Threshold::Fixed(0.0))).collect();
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
            ..any.params
        };
        SkillPlan { params, applicable, eval_at: Vec::new(), ..skill.clone() }
    };
    let skills: Vec<SkillPlan> = arm.skills.iter().map(bare).collect();
    format!("{:?}", ArmPlan { name: String::new(), point: 0, skills, ..arm.clone() })
}

/// Planners, and which of their tests have been made, by the text of the task: arms share most tasks.
#[derive(Debug, Default)]
struct Planners {
    known: HashMap<String, Rc<Planner>>,
    tested: HashSet<String>,
}

impl BatchGroup {
    fn new(plan: &Plan, arms: Vec<usize>, planners: &mut Planners) -> Result<Self, SetupError> {
        let members: Vec<&ArmPlan> = arms.iter().map(|arm| &plan.arms[*arm]).collect();
        let first = members[0];
        let world = plan.world_of(first);
        let (shape, mut shared) = lay_out(&members, world)?;
        let mut bounds = Vec::new();
        let (params, ..) = shape.learner(first, plan.run_seed, 0);
        for (number, skill) in first.skills.iter().enumerate() {
            let taught = members.iter().any(|arm| arm.skills[number].params.lessons > 0);
            let terms = terms_of(first);
            let task = format!("{:?}", (first.world, &terms, skill.params.reward, skill.goal, skill.actions()));
            // A mirror image has nothing of its own to plan.
            if skill.mirror.is_some() {
                bounds.push(None);
                continue;
            }
            let make = || Rc::new(Planner::new(world, &shared, skill, &terms));
            let planner = Rc::clone(planners.known.entry(task.clone()).or_insert_with(make));
            let driven = driven(&shared.skills[number], skill);
            let teacher = Teacher {
                shared: &shared,
                planner: &planner,
                plan: &driven,
                params: &teacher_params(&params[number]),
                number: number as u32,
            };
            let bank = if taught { teacher.bank(skill, first.teacher.lessons)? } else { Vec::new() };
            let test = format!("{:?}", (task, &skill.eval_starts, skill.params.max_steps, first.teacher.eval_episodes));
            bounds.push(planners.tested.insert(test).then(|| teacher.tests(first.teacher.eval_episodes)));
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

/// A skill's shape as the planner drives it: over actions.
fn driven(plan: &SkillShape, skill: &SkillPlan) -> SkillShape {
    let mut driven = *plan;
    if skill.is_high() {
        let actions = skill.actions();
        driven.children = actions.len() as u32;
        driven.record_words = ELEMENTARY_STEP_WORDS as u32;
        driven.thresholded = 0;
        for (code, action) in driven.child.iter_mut().zip(actions) {
            *code = action as u32;
        }
    }
    driven
}
