//! What a net is given of a recorded step: groups of inputs, one after another.

use crate::env::sonar::READINGS_PER_DEGREE;
use crate::env::workgroup::Workgroup;
use crate::layout::RAYS;
use crate::layout::sensors::{
    GROUP_BUMPERS, GROUP_COMPASS, GROUP_COMPASS2, GROUP_DOOR_TRACE, GROUP_LIGHT, GROUP_LIGHT_TRACE, GROUP_LIT,
    GROUP_RANGE_MEANS, GROUP_ROOM, GROUP_RUNNING, GROUP_SONAR, GROUP_SONAR_COMPASS, GROUP_VALUES,
};
use crate::math::functions::{sin_cos, wrap_degrees};
use crate::policy::applicability::{high_level_applicable, high_level_room, high_level_running};

impl Workgroup<'_> {
    /// Entry of the sonar table at word `table` for one ray of the record.
    #[inline(always)]
    pub fn sonar_feature(&self, table: u32, ray: usize) -> f32 {
        f32::from_bits(self.tables[(table + self.record.observation.sonar_inches(ray)) as usize])
    }

    /// Input `lane` of the groups that are single bits, or numbers handed on: 0 where there is none.
    pub fn scalar_feature(&self, lane: u32, skill: u32, kind: u32) -> f32 {
        let running = high_level_running(self.record.high_level);
        let applicable = high_level_applicable(self.record.high_level);
        let room = high_level_room(self.record.high_level);
        let mut value = 0.0;
        if kind == GROUP_LIT {
            value = if self.record.observation.lit_bearings() != 0 { 1.0 } else { 0.0 };
        } else if kind == GROUP_RUNNING {
            value = if running == lane { 1.0 } else { 0.0 };
        } else if kind == GROUP_ROOM {
            value = if room == lane { 1.0 } else { 0.0 };
        } else if kind == GROUP_RANGE_MEANS {
            value = if lane == 0 { self.record.east_west } else { self.record.north_south };
        } else if kind == GROUP_LIGHT_TRACE {
            value = self.record.light_trace;
        } else if kind == GROUP_DOOR_TRACE {
            let way = if lane == 1 { self.record.door_cosine } else { self.record.door_sine };
            value = if lane == 0 { self.record.door_trace } else { way };
        } else {
            // Of the children that have a threshold, the one that as many stand before as this lane has.
            let mut before = 0;
            for child in 0..self.skills[skill as usize].children {
                let has = ((self.skills[skill as usize].thresholded >> child) & 1) == 1;
                if has && before == lane {
                    let own = self.record.value[child as usize];
                    let bit = if ((applicable >> child) & 1) == 1 { 1.0 } else { 0.0 };
                    value = if kind == GROUP_VALUES { own } else { bit };
                }
                before += u32::from(has);
            }
        }
        value
    }

    /// Turns the record, or what a mirror would show of it, into the inputs of a skill's nets.
    #[inline(always)]
    pub fn encode(&mut self, skill: u32, mirrored: bool) {
        for group in 0..self.skills[skill as usize].groups as usize {
            let kind = self.skills[skill as usize].group_kind[group];
            let first = self.skills[skill as usize].group_first[group] as usize;
            let width = self.skills[skill as usize].group_width[group];
            let table = self.skills[skill as usize].group_table[group];
            if kind == GROUP_SONAR {
                for lane in 0..RAYS {
                    let ray = if mirrored { (RAYS - lane) % RAYS } else { lane };
                    self.inputs[first + lane] = self.sonar_feature(table, ray);
                }
            } else if kind == GROUP_SONAR_COMPASS {
                // Bearing b of the compass lies between the readings that look just before and just after it.
                let turn = self.record.observation.compass_degrees() * READINGS_PER_DEGREE;
                let whole = turn as usize;
                let part = turn - whole as f32;
                for lane in 0..RAYS {
                    let after = (lane + 2 * RAYS - whole) % RAYS;
                    let before = (after + RAYS - 1) % RAYS;
                    let near = self.sonar_feature(table, after);
                    self.inputs[first + lane] = near + part * (self.sonar_feature(table, before) - near);
                }
            } else if kind == GROUP_LIGHT {
                for lane in 0..RAYS {
                    let ray = if mirrored { (RAYS - lane) % RAYS } else { lane };
                    self.inputs[first + lane] = ((self.record.observation.lit_bearings() >> ray) & 1) as f32;
                }
            } else if kind == GROUP_BUMPERS {
                for lane in 0..4 {
                    let side = if mirrored { (4 - lane) % 4 } else { lane };
                    self.inputs[first + lane] = ((self.record.observation.bumper_bits() >> side) & 1) as f32;
                }
            } else if kind == GROUP_COMPASS || kind == GROUP_COMPASS2 {
                let compass = self.record.observation.compass_degrees();
                let angle = if kind == GROUP_COMPASS { compass } else { wrap_degrees(compass * 2.0) };
                let turn = sin_cos(angle);
                self.inputs[first] = turn.1;
                self.inputs[first + 1] = turn.0;
            } else {
                for lane in 0..width {
                    self.inputs[first + lane as usize] = self.scalar_feature(lane, skill, kind);
                }
            }
        }
    }
}
