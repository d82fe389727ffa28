//! Arms that can train in one cohort: their skills agree in all but numbers, and one teacher serves them.

use crate::backend::Cohort;
use crate::config::plan::{ArmPlan, Plan, SkillPlan, TeacherPlan, Threshold};
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
pub fn groups(plan: &Plan) -> Result<Vec<BatchGroup>, SetupError> {
    let mut planners = Planners::default();
    classes(&plan.arms, in_common).into_iter().map(|arms| BatchGroup::new(plan, arms, &mut planners)).collect()
}

/// The group that an arm belongs to.
pub fn group_of(groups: &[BatchGroup], arm: usize) -> &BatchGroup {
    &groups[group_index(groups, arm)]
}

/// Index of the group that an arm belongs to.
pub fn group_index(groups: &[BatchGroup], arm: usize) -> usize {
    groups.iter().position(|group| group.arms.binary_search(&arm).is_ok()).unwrap_or(0)
}

/// Sorts arms into classes that are the same, byte by byte, in what `seen` keeps of them: their indices, in the order in
/// which each class shows up first.
pub(super) fn classes(arms: &[ArmPlan], seen: impl Fn(&ArmPlan) -> ArmPlan) -> Vec<Vec<usize>> {
    let mut classes: Vec<Vec<usize>> = Vec::new();
    let mut known: HashMap<Vec<u8>, usize> = HashMap::new();
    for (index, arm) in arms.iter().enumerate() {
        // By which name and point a learner goes is nothing that it sees.
        let seen = ArmPlan { name: String::new(), point: 0, ..seen(arm) };
        let class = *known.entry(bytes(&seen)).or_insert(classes.len());
        if class == classes.len() {
            classes.push(Vec::new());
        }
        classes[class].push(index);
    }
    classes
}

/// All that a value holds: records as they lie in memory, anything else as serde tells it.
fn bytes(value: &impl Serialize) -> Vec<u8> {
    postcard::to_stdvec(value).expect("memory takes whatever a plan holds")
}

/// An arm without what is a single learner's alone: what the skills' shapes and the teacher are made from.
pub(super) fn in_common(arm: &ArmPlan) -> ArmPlan {
    let mut common = arm.clone();
    for skill in &mut common.skills {
        let own = skill.params;
        skill.params = HyperParams {
            // It discounts nothing but what is told of the planner's own tests.
            gamma: 0.0,
            shared_net: own.shared_net,
            // The planner's table stands in for nets.
            value_scale: if skill.oracle { own.value_scale } else { 0.0 },
            ..teacher_params(&own)
        };
        skill.applicable.iter_mut().flatten().for_each(|threshold| *threshold = Threshold::Fixed(0.0));
        skill.eval_at.clear();
    }
    common
}

/// Planners, and which of their tests have been made, by the bytes of the task: arms share most tasks.
#[derive(Debug, Default)]
struct Planners {
    known: HashMap<Vec<u8>, Rc<Planner>>,
    tested: HashSet<Vec<u8>>,
}

impl BatchGroup {
    fn new(plan: &Plan, arms: Vec<usize>, planners: &mut Planners) -> Result<Self, SetupError> {
        let members: Vec<&ArmPlan> = arms.iter().map(|arm| &plan.arms[*arm]).collect();
        let first = members[0];
        let world = plan.world_of(first);
        let (shape, mut shared) = lay_out(&members, world)?;
        let (terms, TeacherPlan { lessons, eval_episodes, .. }) = (terms_of(first), first.teacher);
        let mut bounds = Vec::new();
        for (number, skill) in first.skills.iter().enumerate() {
            // A mirror image has nothing of its own to plan.
            if skill.mirror.is_some() {
                bounds.push(None);
                continue;
            }
            let own = HyperParams { run_seed: plan.run_seed, ..skill.params };
            let task = bytes(&(first.world, &terms, own.reward, skill.goal, &skill.regions, skill.actions()));
            let make = || Rc::new(Planner::new(world, &shared, skill, &terms));
            let planner = Rc::clone(planners.known.entry(task.clone()).or_insert_with(make));
            let driven = driven(&shared.skills[number], skill);
            let params = teacher_params(&own);
            let teacher =
                Teacher { shared: &shared, planner: &planner, plan: &driven, params: &params, number: number as u32 };
            let test = bytes(&(task, &skill.eval_starts, own.max_steps, eval_episodes));
            bounds.push(planners.tested.insert(test).then(|| teacher.tests(eval_episodes)));
            let taught = members.iter().any(|arm| arm.skills[number].params.lessons > 0);
            let bank = if taught { teacher.bank(skill, lessons)? } else { Vec::new() };
            let table = skill.oracle.then(|| planner.table(&shared, own.value_scale));
            let placed = &mut shared.skills[number];
            placed.bank_offset = shared.bank.len() as u32;
            placed.bank_lessons = if taught { lessons } else { 0 };
            if let Some(table) = table {
                placed.planned = shared.tables.len() as u32;
                shared.tables.extend(table);
            }
            shared.bank.extend(bank);
        }
        // No buffer may be empty, even where nobody is taught.
        if shared.bank.is_empty() {
            shared.bank.push(0);
        }
        let altered = plan.alterations.iter().map(|alteration| {
            let (_, other) = lay_out(&members, &plan.worlds[alteration.world.unwrap_or(first.world)].world)?;
            Ok(CohortData { bank: vec![0], ..other })
        });
        let altered = altered.collect::<Result<_, ShapeError>>()?;
        Ok(Self { arms, shape, shared, altered, bounds })
    }

    /// The group's learners, arm by arm.
    pub fn learners(&self, plan: &Plan) -> Vec<LearnerId> {
        let of_arm = |&arm: &usize| plan.seeds.iter().map(move |&seed| LearnerId { arm, seed });
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
