//! What a skill looks like to a kernel.

use super::events::MAX_REGIONS;
use super::sizes::{MAX_CHILDREN, MAX_GROUPS, MAX_STARTS};
use super::world::Area;
use bytemuck::{Pod, Zeroable};

shared! {
    /// A skill's shape: the same for every learner of a cohort.
    struct SkillShape {
        /// Inputs of each net.
        inputs: u32,
        /// Rows of 32 weights of each net: one per input, hidden biases, weights of each output, output biases.
        rows: u32,
        /// Children, and Q-values.
        children: u32,
        /// Nets: one per child, or one for all.
        nets: u32,
        /// Outputs of each net: one, or one per child.
        outputs: u32,
        /// Input groups in use.
        groups: u32,
        /// Word of a learner's nets at which the skill's first net stands.
        nets_offset: u32,
        /// Word of a learner's nets at which the optimiser's clocks stand.
        clock_offset: u32,
        /// Words of one recorded step.
        record_words: u32,
        /// Words of one lesson slot.
        lesson_stride: u32,
        /// Word of a learner's lessons at which the skill's memory stands.
        memory_offset: u32,
        /// Word of the bank at which the skill's taught lessons stand.
        bank_offset: u32,
        /// Taught lessons in the bank.
        bank_lessons: u32,
        /// Start regions in use.
        starts: u32,
        /// Word of the tables at which the cells of the test region stand.
        tests_offset: u32,
        /// Cells of the test region.
        tests_count: u32,
        /// Events that end a trial as achieved.
        ends: u32,
        /// Regions whose events pay or end a trial.
        regions: u32,
        /// Bits of the skills below this one, of any depth, that somebody's applicability depends on.
        watched: u32,
        /// Bits of the children that have an applicability threshold.
        thresholded: u32,
        /// 1 where the nets belong to another skill and see the world in a mirror.
        mirrored: u32,
        /// Word of the tables at which the planner's table stands that decides instead of the nets, or 0.
        planned: u32,
        /// Kind of each input group: one of the `GROUP` codes of `policy/features`.
        group_kind: [u32; MAX_GROUPS],
        /// First input of each group.
        group_first: [u32; MAX_GROUPS],
        /// Inputs of each group.
        group_width: [u32; MAX_GROUPS],
        /// Word of the tables at which a sonar group's table stands.
        group_table: [u32; MAX_GROUPS],
        /// Which of the first 32 inputs are bits: those of light and bumpers.
        bits_low: u32,
        /// Which of the others are.
        bits_high: u32,
        /// The child that is each child's mirror image.
        mirror_child: [u32; MAX_CHILDREN],
        /// Code of each child: an action, or `SKILL_CODE` and the skill's number.
        child: [u32; MAX_CHILDREN],
        /// Share of the trials that start in this region or an earlier one.
        start_share: [f32; MAX_STARTS],
        /// Word of the tables at which the region's cells stand.
        start_offset: [u32; MAX_STARTS],
        /// Cells of the region.
        start_count: [u32; MAX_STARTS],
        /// The regions whose events pay or end a trial.
        region: [Area; MAX_REGIONS],
    }
}
