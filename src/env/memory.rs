//! What the robot remembers within a trial: enough to tell rooms apart that look alike, from its own sensors.
//!
//! All of it is our choice: the paper's high-level inputs are "abstract information derived from the low-level
//! sensory inputs".

use super::motion::PASSED_DOOR;
use super::sonar::{INVERSE_LIMIT, READINGS_PER_DEGREE};
use super::workgroup::Workgroup;
use crate::layout::RAYS;
use crate::math::functions::{flush, sin_cos};

impl Workgroup<'_> {
    /// Reading of the record that looks along the compass's direction `quarter` x 90 degrees, inches.
    pub fn range_toward(&self, quarter: usize) -> f32 {
        let turned = (self.record.observation.compass_degrees() * READINGS_PER_DEGREE + 0.5) as usize;
        let ray = (6 * quarter + 2 * RAYS - turned) % RAYS;
        self.record.observation.sonar_inches(ray) as f32
    }

    /// Takes the record into the robot's memory.
    pub fn remember(&mut self, skill: u32) {
        let s = skill as usize;
        let across = (self.range_toward(0) + self.range_toward(2)) * INVERSE_LIMIT - 1.0;
        let along = (self.range_toward(1) + self.range_toward(3)) * INVERSE_LIMIT - 1.0;
        // The first reading stands for the past that there is not.
        let past = if self.agent.step == 0 { 0.0 } else { self.params[s].range_decay };
        self.agent.east_west = flush(past * self.agent.east_west + (1.0 - past) * across);
        self.agent.north_south = flush(past * self.agent.north_south + (1.0 - past) * along);
        let lit = self.record.observation.lit_bearings() != 0;
        self.agent.light = if lit { 1.0 } else { flush(self.agent.light * self.params[s].light_decay) };
        let passed = (self.agent.events & PASSED_DOOR) != 0;
        let turn = sin_cos(self.record.observation.compass_degrees());
        self.agent.door = if passed { 1.0 } else { flush(self.agent.door * self.params[s].door_decay) };
        self.agent.door_cosine =
            if passed { turn.1 } else { flush(self.agent.door_cosine * self.params[s].door_decay) };
        self.agent.door_sine = if passed { turn.0 } else { flush(self.agent.door_sine * self.params[s].door_decay) };
    }

    /// Writes the memories into the record.
    pub fn recall(&mut self) {
        self.record.east_west = self.agent.east_west;
        self.record.north_south = self.agent.north_south;
        self.record.light_trace = self.agent.light;
        self.record.door_trace = self.agent.door;
        self.record.door_cosine = self.agent.door_cosine;
        self.record.door_sine = self.agent.door_sine;
    }
}
