//! What the CPU twins work on: one learner's slices of the cohort's buffers, and the scratch memory that
//! a workgroup has.

use super::layout::{Cursor, LANES, MAX_CHILDREN, MAX_INPUTS, MAX_ROWS, MAX_SKILLS, RECORD_WORDS, Settings, SkillPlan};
use crate::math::lanes::Lanes;
use crate::robot::floor::Floor;

/// Read-only memory that all learners of a cohort share.
#[derive(Debug, Clone)]
pub struct Shared {
    /// The floor plan.
    pub floor: Floor,
    /// Shapes of the skills.
    pub skills: Vec<SkillPlan>,
    /// Culled segment lists, region cells, sonar tables.
    pub atlas: Vec<u32>,
    /// The teacher's lessons.
    pub bank: Vec<u32>,
}

/// One learner's memory.
#[derive(Debug)]
pub struct Learner<'a> {
    /// What all learners share.
    pub shared: &'a Shared,
    /// One record per skill.
    pub settings: &'a [Settings],
    /// Where it stands.
    pub cursor: &'a mut Cursor,
    /// Weights, optimiser moments and clocks of all skills.
    pub nets: &'a mut [f32],
    /// Remembered lessons of all skills.
    pub lessons: &'a mut [u32],
    /// Rows of the trial table.
    pub rows: &'a mut [u32],
}

/// Inputs that are not 0, in order. The CPU's alone: a workgroup looks at each.
#[derive(Debug, Clone)]
pub struct Seen {
    rows: [u32; MAX_INPUTS],
    values: [f32; MAX_INPUTS],
    count: usize,
}

impl Seen {
    /// Lists what is not 0. Without a branch, because which bits of light are set is hard to foretell.
    #[inline(always)]
    pub fn list(&mut self, inputs: &[f32]) {
        self.count = 0;
        for (row, x) in inputs.iter().enumerate() {
            // No more are listed than there were.
            self.rows[self.count % MAX_INPUTS] = row as u32;
            self.values[self.count % MAX_INPUTS] = *x;
            self.count += usize::from(*x != 0.0);
        }
    }

    /// Number and value of each.
    #[inline(always)]
    pub fn iter(&self) -> impl Iterator<Item = (usize, f32)> {
        let count = self.count.min(MAX_INPUTS);
        self.rows[..count].iter().zip(&self.values[..count]).map(|(row, x)| (*row as usize, *x))
    }
}

/// Twin of the shaders' workgroup memory.
#[derive(Debug, Clone)]
pub struct Scratch {
    /// The step being recorded or replayed.
    pub record: [u32; RECORD_WORDS],
    /// Inputs of the nets.
    pub inputs: [f32; MAX_INPUTS],
    /// Those that the nets were last asked about, as a list.
    pub seen: Seen,
    /// Hidden activations of every child's net.
    pub hidden: [Lanes; MAX_CHILDREN],
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
            record: [0; RECORD_WORDS],
            inputs: [0.0; MAX_INPUTS],
            seen: Seen { rows: [0; MAX_INPUTS], values: [0.0; MAX_INPUTS], count: 0 },
            hidden: [[0.0; LANES]; MAX_CHILDREN],
            q: [0.0; MAX_CHILDREN],
            row_factor: [0.0; MAX_ROWS],
            row_pace: [0.0; MAX_ROWS],
            odds: [0.0; MAX_CHILDREN],
            value: [0.0; MAX_SKILLS],
            kept: [0.0; MAX_SKILLS * MAX_CHILDREN],
        }
    }
}
