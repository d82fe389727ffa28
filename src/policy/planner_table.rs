//! The planner in a skill's place: privileged, for it knows floor plan and pose. A baseline.
//!
//! It stands in the lookup tables: columns, rows, rooms of origin, 1 / pitch, then one word for each origin, row, column
//! and heading: the value, with the child's number in its lowest three bits.

use crate::env::sonar::READINGS_PER_DEGREE;
use crate::env::workgroup::Workgroup;

/// Words before the first entry.
pub const TABLE_HEADER: u32 = 4;
/// Headings of the table.
pub const TABLE_HEADINGS: u32 = 24;
/// How far below the best child's value the others stand, which a choice at any usual temperature respects.
pub const TABLE_GAP: f32 = 1.0;

impl Workgroup<'_> {
    /// Q-values of skill `n` from the table's entry nearest to the robot.
    pub fn planned_values(&mut self, n: u32) {
        let table = self.skills[n as usize].planned;
        let columns = self.tables[table as usize];
        let rows = self.tables[table as usize + 1];
        let origins = self.tables[table as usize + 2];
        let inverse = f32::from_bits(self.tables[table as usize + 3]);
        let column = ((self.agent.x * inverse + 0.5) as u32).min(columns - 1);
        let row = ((self.agent.y * inverse + 0.5) as u32).min(rows - 1);
        let heading = ((self.agent.heading * READINGS_PER_DEGREE + 0.5) as u32) % TABLE_HEADINGS;
        // Who began in no room has the first one's table, as with the planner.
        let origin = if self.agent.origin < origins { self.agent.origin } else { 0 };
        let entry = ((origin * rows + row) * columns + column) * TABLE_HEADINGS + heading;
        let word = self.tables[(table + TABLE_HEADER + entry) as usize];
        let best = f32::from_bits(word & 0xffff_fff8);
        for lane in 0..self.skills[n as usize].children {
            self.q[lane as usize] = if lane == (word & 7) { best } else { best - TABLE_GAP };
        }
    }
}
