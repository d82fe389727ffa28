//! From a plan to the memory of a cohort: every derived size is computed here, once.

use crate::config::plan::{ArmPlan, Child, Input, SkillPlan};
use crate::layout::sensors::{GROUP_SONAR, GROUP_SONAR_COMPASS};
use crate::layout::{
    ELEMENTARY_STEP_WORDS, HyperParams, LANES, LESSON_HEADER_WORDS, LearnerState, MAX_CHILDREN, MAX_GROUPS, MAX_INPUTS,
    MAX_ROWS, MAX_SKILLS, MAX_STARTS, SKILL_CODE, SONAR_CODES, STEP_WORDS, SkillShape, TRIAL_WORDS,
};
use crate::qnet::init::init;
use crate::world::World;
use crate::world::tables::Tables;
use bytemuck::Zeroable;

/// Sizes and shared words of the learners of some arms that agree in everything but numbers.
#[derive(Debug, Clone)]
pub struct Shape {
    /// One per skill; the bank's offsets are still to be filled in.
    pub skills: Vec<SkillShape>,
    /// Segment lists, region cells and sonar tables.
    pub tables: Tables,
    /// Words of one learner's nets.
    pub nets_stride: usize,
    /// Words of one learner's lessons.
    pub lessons_stride: usize,
    /// Words of one learner's rows.
    pub rows_stride: usize,
}

/// Why a plan cannot be laid out: a limit of the layout or a region without free space.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("skill `{skill}`: {message}\nhint: {hint}")]
pub struct ShapeError {
    /// The skill's name.
    pub skill: String,
    /// What does not fit.
    pub message: String,
    /// What the user can do.
    pub hint: String,
}

impl Shape {
    /// Lays out the memory of `arms`, which must have equal skills but for their numbers.
    ///
    /// # Errors
    /// Where a skill exceeds a limit of the layout, or starts in a region without free space.
    pub fn new(world: &World, arms: &[&ArmPlan]) -> Result<Self, ShapeError> {
        let mut shape =
            Self { skills: Vec::new(), tables: Tables::new(world), nets_stride: 0, lessons_stride: 0, rows_stride: 0 };
        for (number, skill) in arms[0].skills.iter().enumerate() {
            let siblings = || arms.iter().map(|arm| &arm.skills[number]);
            let most = |size: fn(&SkillPlan) -> u32| siblings().map(size).max().unwrap_or(0);
            let mut plan = plan_of(skill, world, &mut shape.tables)?;
            plan.watched = watched(&arms[0].skills, number);
            plan.lesson_stride = lesson_stride(most(|skill| skill.params.max_steps), plan.record_words);
            plan.memory_offset = shape.lessons_stride as u32;
            match skill.mirror {
                Some(source) => {
                    plan.nets_offset = shape.skills[source].nets_offset;
                    plan.clock_offset = shape.skills[source].clock_offset;
                }
                None => {
                    plan.nets_offset = shape.nets_stride as u32;
                    plan.clock_offset = plan.net_offset(plan.nets) as u32;
                    shape.nets_stride = plan.clock_offset as usize + LANES;
                }
            }
            // What is never tried is never remembered.
            if most(|skill| skill.params.trials) > 0 {
                shape.lessons_stride +=
                    most(|skill| skill.params.replay_capacity) as usize * plan.lesson_stride as usize;
            }
            shape.rows_stride += most(|skill| skill.params.trials + skill.params.lessons) as usize * TRIAL_WORDS;
            shape.skills.push(plan);
        }
        // Every net can be read as one of `MAX_ROWS` rows: the last one too.
        let ends = shape.skills.iter().map(|plan| plan.net_offset(plan.nets.max(1) - 1) + MAX_ROWS * LANES);
        shape.nets_stride = ends.fold(shape.nets_stride, usize::max);
        // No buffer may be empty, even where nothing is trained.
        shape.lessons_stride = shape.lessons_stride.max(1);
        shape.rows_stride = shape.rows_stride.max(TRIAL_WORDS);
        Ok(shape)
    }

    /// Bytes of memory that one learner takes.
    pub fn bytes_per_learner(&self) -> usize {
        let words = self.nets_stride + self.lessons_stride + self.rows_stride;
        words * 4 + size_of::<LearnerState>() + self.skills.len() * size_of::<HyperParams>()
    }

    /// A learner's params for each skill, its state before the first iteration, and its initial nets.
    pub fn learner(&self, arm: &ArmPlan, run_seed: u32, seed: u32) -> (Vec<HyperParams>, LearnerState, Vec<f32>) {
        let mut nets = vec![0.0; self.nets_stride];
        let own = |skill: &SkillPlan| HyperParams { run_seed, learner_seed: seed, ..skill.params };
        let params: Vec<HyperParams> = arm.skills.iter().map(own).collect();
        for (number, plan) in self.skills.iter().enumerate().filter(|(number, _)| arm.skills[*number].mirror.is_none())
        {
            init(&mut nets, plan, number as u32, &params[number]);
        }
        (params, LearnerState::zeroed(), nets)
    }
}

/// Words of a lesson of at most `max_steps` steps of `record_words` each.
pub fn lesson_stride(max_steps: u32, record_words: u32) -> u32 {
    LESSON_HEADER_WORDS as u32 + (max_steps + 1) * record_words
}

/// Bits of the skills below `root`, at any depth, on whose values some threshold in its tree depends.
fn watched(skills: &[SkillPlan], root: usize) -> u32 {
    let mut below = 1_u32 << root;
    let mut watched = 0;
    for (n, skill) in skills.iter().enumerate().rev().filter(|(n, _)| *n <= root && *n < MAX_SKILLS) {
        if (below >> n) & 1 == 0 {
            continue;
        }
        for (child, threshold) in skill.children.iter().zip(&skill.applicable) {
            let Child::Skill(child) = child else { continue };
            below |= 1 << child;
            watched |= u32::from(threshold.is_some()) << child;
        }
    }
    watched
}

fn plan_of(skill: &SkillPlan, world: &World, tables: &mut Tables) -> Result<SkillShape, ShapeError> {
    let refuse = |message: String, hint: &str| ShapeError { skill: skill.name.clone(), message, hint: hint.to_owned() };
    let rooms = world.rooms.len();
    let inputs = skill.width(rooms);
    if inputs as usize > MAX_INPUTS || skill.inputs.len() > MAX_GROUPS {
        let message = format!("{inputs} inputs in {} groups; {MAX_INPUTS} in {MAX_GROUPS} fit", skill.inputs.len());
        return Err(refuse(message, "name fewer inputs"));
    }
    if skill.children.len() > MAX_CHILDREN || skill.starts.len() > MAX_STARTS {
        let message = format!("at most {MAX_CHILDREN} children and {MAX_STARTS} start regions fit");
        return Err(refuse(message, "name fewer of them"));
    }
    let mut plan = SkillShape::zeroed();
    plan.inputs = inputs;
    plan.children = skill.children.len() as u32;
    (plan.nets, plan.outputs) = if skill.params.shared_net == 1 { (1, plan.children) } else { (plan.children, 1) };
    plan.rows = inputs + plan.outputs + 2;
    plan.record_words = if skill.is_high() || recalls(skill) { STEP_WORDS } else { ELEMENTARY_STEP_WORDS } as u32;
    plan.mirrored = u32::from(skill.mirror.is_some());
    plan.groups = skill.inputs.len() as u32;
    plan.starts = skill.starts.len() as u32;
    plan.ends = skill.goal;
    plan.regions = skill.regions.len() as u32;
    for (area, region) in plan.region.iter_mut().zip(&skill.regions) {
        *area = world.region_area(region).map(Into::into).ok_or_else(|| {
            let message = format!("the world `{}` has no room or rectangle `{region}`", world.name);
            refuse(message, "name another region")
        })?;
    }
    let (mut first, mut bits) = (0, 0_u64);
    for (group, input) in skill.inputs.iter().enumerate() {
        plan.group_first[group] = first;
        plan.group_width[group] = skill.width_of(*input, rooms);
        if input.is_bits() {
            bits |= ((1 << plan.group_width[group]) - 1) << first;
        }
        first += plan.group_width[group];
        plan.group_kind[group] = input.group();
        if plan.group_kind[group] == GROUP_SONAR || plan.group_kind[group] == GROUP_SONAR_COMPASS {
            plan.group_table[group] = tables.add_table(&sonar_table(*input));
        }
    }
    plan.bits_low = bits as u32;
    plan.bits_high = (bits >> 32) as u32;
    for (number, (child, threshold)) in skill.children.iter().zip(&skill.applicable).enumerate() {
        plan.child[number] = match child {
            Child::Action(action) => *action as u32,
            Child::Skill(below) => (SKILL_CODE + below) as u32,
        };
        let image = skill.children.iter().position(|other| *other == child.mirrored());
        plan.mirror_child[number] = image.unwrap_or(number) as u32;
        plan.thresholded |= u32::from(threshold.is_some()) << number;
    }
    let mut cells_of = |region: &str| {
        let cells = world.region_cells(region).unwrap_or_default();
        if cells.is_empty() {
            let message = format!("region `{region}` of world `{}` has no place for a robot", world.name);
            return Err(refuse(message, "name another region, or make room in the world"));
        }
        Ok(tables.add_cells(&cells))
    };
    let mut share = 0.0;
    for (number, (region, part)) in skill.starts.iter().enumerate() {
        share += part;
        plan.start_share[number] = share;
        (plan.start_offset[number], plan.start_count[number]) = cells_of(region)?;
    }
    (plan.tests_offset, plan.tests_count) = cells_of(&skill.eval_starts)?;
    Ok(plan)
}

/// Whether a skill's inputs stand in the second part of a record.
fn recalls(skill: &SkillPlan) -> bool {
    skill.inputs.iter().any(|input| input.is_recalled())
}

/// What a net is given for each sonar reading, 0 to 127 inches.
fn sonar_table(input: Input) -> [f32; SONAR_CODES] {
    std::array::from_fn(|reading| {
        let d = reading as f64;
        let code = match input.scale() {
            Some(scale) => 2.0 * (-(d - 12.0) / f64::from(scale)).exp() - 1.0,
            None => 2.0 * d / 127.0 - 1.0,
        };
        code as f32
    })
}
