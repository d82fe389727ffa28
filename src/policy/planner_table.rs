//! The planner in a skill's place: privileged, for it knows floor plan and pose. A baseline.
//!
//! Its table in the tables: columns, rows, rooms of origin, 1 / pitch, then one word for each origin, row, column
//! and heading: the value, with the child's number in its lowest three bits.

use crate::env::sonar::READINGS_PER_DEGREE;
use crate::env::workgroup::{CohortData, Scratch};
use crate::layout::{Agent, SkillShape};

/// Words before the first entry.
pub const TABLE_HEADER: u32 = 4;
/// Headings of the table.
pub const TABLE_HEADINGS: u32 = 24;
/// How far below the best child's value the others stand, which a choice at any usual temperature respects.
pub const TABLE_GAP: f32 = 1.0;

/// Q-values from the table's entry nearest to the robot.
#[inline(always)]
pub fn consult(agent: &Agent, shared: &CohortData, scratch: &mut Scratch, plan: &SkillShape) {
    let table = plan.planned as usize;
    let columns = shared.tables[table];
    let rows = shared.tables[table + 1];
    let origins = shared.tables[table + 2];
    let inverse = f32::from_bits(shared.tables[table + 3]);
    let column = ((agent.x * inverse + 0.5) as u32).min(columns - 1);
    let row = ((agent.y * inverse + 0.5) as u32).min(rows - 1);
    let heading = ((agent.heading * READINGS_PER_DEGREE + 0.5) as u32) % TABLE_HEADINGS;
    // Who began in no room has the first one's table, as with the planner.
    let origin = if agent.origin < origins { agent.origin } else { 0 };
    let entry = ((origin * rows + row) * columns + column) * TABLE_HEADINGS + heading;
    let word = shared.tables[table + (TABLE_HEADER + entry) as usize];
    let best = f32::from_bits(word & 0xffff_fff8);
    for child in 0..plan.children {
        scratch.q[child as usize] = if child == (word & 7) { best } else { best - TABLE_GAP };
    }
}
