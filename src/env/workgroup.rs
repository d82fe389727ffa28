//! The memory of a workgroup: what the shaders' module-scope variables are, the twins have as fields of one struct.

use super::segments::SegmentGrid;
use crate::layout::{
    Agent, Boltzmann, Dispatch, HyperParams, LANES, LearnerState, MAX_CHILDREN, MAX_INPUTS, MAX_ROWS, MAX_SKILLS,
    Moved, Noise, SkillShape, Step, TrialRecord, WorldUniform,
};
use crate::math::reduce::{Lanes, Partials};
use crate::math::rng::{StepRandom, Stream};
use bytemuck::Zeroable;
use std::ops::Deref;

/// Read-only memory that all learners of a cohort share.
#[derive(Debug, Clone)]
pub struct CohortData {
    /// The floor plan.
    pub floor: SegmentGrid,
    /// Shapes of the skills.
    pub skills: Vec<SkillShape>,
    /// Lookup tables: segment lists, region cells, sonar encodings, planners' tables.
    pub tables: Vec<u32>,
    /// The teacher's lessons.
    pub bank: Vec<u32>,
}

/// A learner's nets: moved in training, only read in tests.
#[derive(Debug)]
pub enum Nets<'a> {
    /// In training.
    Trained(&'a mut [f32]),
    /// In a test.
    Read(&'a [f32]),
}

impl Deref for Nets<'_> {
    type Target = [f32];

    #[inline(always)]
    fn deref(&self) -> &[f32] {
        match self {
            Nets::Trained(words) => words,
            Nets::Read(words) => words,
        }
    }
}

impl Nets<'_> {
    /// The words, to be written; none of them in a test.
    #[inline(always)]
    pub fn trained(&mut self) -> &mut [f32] {
        match self {
            Nets::Trained(words) => words,
            Nets::Read(_) => &mut [],
        }
    }
}

/// The functions that take most of the time. A backend may have forms of its own that leave the same bytes.
#[derive(Debug, Clone, Copy)]
pub struct HotForms {
    /// [`StepRandom::draw_step`].
    pub draw_step: fn(&mut Workgroup<'_>, Stream),
    /// [`Workgroup::observe`].
    pub observe: fn(&mut Workgroup<'_>, x: f32, y: f32, heading: f32, bumpers: u32, noise: Noise),
    /// [`Workgroup::move_body`].
    pub move_body: fn(&Workgroup<'_>, x: f32, y: f32, heading: f32, action: u32, slip: f32) -> Moved,
    /// `Workgroup::encode`.
    pub encode: fn(&mut Workgroup<'_>, skill: u32, mirrored: bool),
    /// `Workgroup::forward`.
    pub forward: fn(&mut Workgroup<'_>, skill: u32),
    /// `Workgroup::boltzmann`.
    pub boltzmann: fn(&mut Workgroup<'_>, children: u32, allowed: u32, inverse_temperature: f32) -> Boltzmann,
    /// `Workgroup::backward`.
    pub backward: fn(&mut Workgroup<'_>, skill: u32, child: u32, delta: f32, step_size: f32),
}

/// A workgroup at work on one learner or robot. Its slices begin where the learner's part of a buffer does, so that the
/// shaders' base offsets have no counterpart; lanes are the elements of arrays.
#[derive(Debug)]
pub struct Workgroup<'a> {
    /// How the hot functions are executed.
    pub forms: &'a HotForms,
    /// What the host asks for.
    pub dispatch: Dispatch,
    /// The floor plan.
    pub world: &'a WorldUniform,
    /// The floor plan as lists for the lanes of a CPU; the plain twins do not look at it.
    pub floor: &'a SegmentGrid,
    /// Lookup tables.
    pub tables: &'a [u32],
    /// Shapes of the skills.
    pub skills: &'a [SkillShape],
    /// The teacher's lessons.
    pub bank: &'a [u32],
    /// Hyper-parameters of each skill.
    pub params: &'a [HyperParams],
    /// Weights, optimiser moments and clocks of all skills.
    pub nets: Nets<'a>,
    /// Remembered lessons of all skills.
    pub lessons: &'a mut [u32],
    /// The trial table.
    pub rows: &'a mut [TrialRecord],

    /// Where the learner stands.
    pub state: LearnerState,
    /// The robot, between the kernel's reading of it and its writing it back.
    pub agent: Agent,
    /// Whether `held_weights` holds those of the skill in training.
    pub weights_held: bool,

    /// Hidden activations of every net.
    pub hidden: [Lanes; MAX_CHILDREN],
    /// What sums over lanes are made of.
    pub partials: Partials,
    /// The step being recorded or replayed.
    pub record: Step,
    /// The random words of a primitive step.
    pub random: StepRandom,
    /// Readings of the sonar.
    pub readings: [u32; LANES],
    /// Ends of the segments at which rays are being cast.
    pub ends: [[f32; 4]; LANES],
    /// The closeness that these have straight ahead.
    pub slopes: [[f32; 2]; LANES],
    /// Inputs of the nets.
    pub inputs: [f32; MAX_INPUTS],
    /// Q-value of every child.
    pub q: [f32; MAX_CHILDREN],
    /// Boltzmann weight of every child, 0 where it is not available.
    pub weights: [f32; MAX_CHILDREN],
    /// What the gradient of each row of weights has in common.
    pub row_factor: [f32; MAX_ROWS],
    /// How far each row of weights moves along its mean gradient.
    pub row_step_size: [f32; MAX_ROWS],
    /// Greatest Q-value of each skill that some applicability depends on.
    pub best_value: [f32; MAX_SKILLS],
    /// All Q-values of each such skill.
    pub kept_q: [[f32; MAX_CHILDREN]; MAX_SKILLS],
    /// Weights of the skill in training; a CPU's cache serves as well, so that it has room for none.
    pub held_weights: Vec<f32>,
}

impl<'a> Workgroup<'a> {
    /// A workgroup for learners with these hyper-parameters, one record per skill, without nets, lessons and rows.
    pub fn new(shared: &'a CohortData, params: &'a [HyperParams], forms: &'a HotForms) -> Self {
        Self {
            forms,
            dispatch: Dispatch::zeroed(),
            world: &shared.floor.plan,
            floor: &shared.floor,
            tables: &shared.tables,
            skills: &shared.skills,
            bank: &shared.bank,
            params,
            nets: Nets::Read(&[]),
            lessons: &mut [],
            rows: &mut [],
            state: LearnerState::zeroed(),
            agent: Agent::zeroed(),
            weights_held: false,
            hidden: [[0.0; LANES]; MAX_CHILDREN],
            partials: [[0.0; LANES]; MAX_CHILDREN],
            record: Step::zeroed(),
            random: StepRandom::default(),
            readings: [0; LANES],
            ends: [[0.0; 4]; LANES],
            slopes: [[0.0; 2]; LANES],
            inputs: [0.0; MAX_INPUTS],
            q: [0.0; MAX_CHILDREN],
            weights: [0.0; MAX_CHILDREN],
            row_factor: [0.0; MAX_ROWS],
            row_step_size: [0.0; MAX_ROWS],
            best_value: [0.0; MAX_SKILLS],
            kept_q: [[0.0; MAX_CHILDREN]; MAX_SKILLS],
            held_weights: Vec::new(),
        }
    }
}
