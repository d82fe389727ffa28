//! What the CPU twins work on: one learner's slices of the cohort's buffers, and the scratch memory that
//! a workgroup has.

use crate::env::segments::SegmentGrid;
use crate::layout::{
    HyperParams, LANES, LearnerState, MAX_CHILDREN, MAX_INPUTS, MAX_ROWS, MAX_SKILLS, RECORD_WORDS, SkillShape,
};
use crate::math::reduce::{Lanes, Partials};

/// Read-only memory that all learners of a cohort share.
#[derive(Debug, Clone)]
pub struct CohortData {
    /// The floor plan.
    pub floor: SegmentGrid,
    /// Shapes of the skills.
    pub skills: Vec<SkillShape>,
    /// Culled segment lists, region cells, sonar tables.
    pub tables: Vec<u32>,
    /// The teacher's lessons.
    pub bank: Vec<u32>,
}

/// One learner's memory.
#[derive(Debug)]
pub struct Learner<'a> {
    /// What all learners share.
    pub shared: &'a CohortData,
    /// One record per skill.
    pub params: &'a [HyperParams],
    /// Where it stands.
    pub state: &'a mut LearnerState,
    /// Weights, optimiser moments and clocks of all skills.
    pub nets: &'a mut [f32],
    /// Remembered lessons of all skills.
    pub lessons: &'a mut [u32],
    /// Rows of the trial table.
    pub rows: &'a mut [u32],
}

/// Twin of the shaders' workgroup memory. Lane arrays come first and lie as the machine's own vectors do.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub struct Scratch {
    /// Hidden activations of every child's net.
    pub hidden: [Lanes; MAX_CHILDREN],
    /// What sums over lanes are made of.
    pub partials: Partials,
    /// The step being recorded or replayed.
    pub record: [u32; RECORD_WORDS],
    /// Inputs of the nets.
    pub inputs: [f32; MAX_INPUTS],
    /// Which of the inputs are bits that are set. The CPU's alone: a workgroup looks at each.
    pub set: u64,
    /// Q-value of every child.
    pub q: [f32; MAX_CHILDREN],
    /// What the gradient of each row of weights has in common.
    pub row_factor: [f32; MAX_ROWS],
    /// How far each row of weights moves along its mean gradient.
    pub row_pace: [f32; MAX_ROWS],
    /// Boltzmann weight of every child, 0 where it is not available.
    pub odds: [f32; MAX_CHILDREN],
    /// Greatest Q-value of each watched skill.
    pub value: [f32; MAX_SKILLS],
    /// All Q-values of each watched skill.
    pub kept: [f32; MAX_SKILLS * MAX_CHILDREN],
}

impl Default for Scratch {
    fn default() -> Self {
        Self {
            hidden: [[0.0; LANES]; MAX_CHILDREN],
            partials: [[0.0; LANES]; MAX_CHILDREN],
            record: [0; RECORD_WORDS],
            inputs: [0.0; MAX_INPUTS],
            set: 0,
            q: [0.0; MAX_CHILDREN],
            row_factor: [0.0; MAX_ROWS],
            row_pace: [0.0; MAX_ROWS],
            odds: [0.0; MAX_CHILDREN],
            value: [0.0; MAX_SKILLS],
            kept: [0.0; MAX_SKILLS * MAX_CHILDREN],
        }
    }
}
