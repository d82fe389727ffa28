//! Which children are applicable: the Applicability Rule (paper, section VI.B).

use crate::env::workgroup::Workgroup;
use crate::layout::{MAX_CHILDREN, SKILL_CODE};

/// Packs what a skill runs: the child, the steps since it was chosen, and the children that were applicable then.
#[inline(always)]
pub fn run_word(child: u32, steps: u32, applicable: u32) -> u32 {
    child | (steps << 8) | (applicable << 16)
}

/// The child that a skill runs, from its word in the robot's memory.
#[inline(always)]
pub fn run_child(run: u32) -> u32 {
    run & 0xff
}

/// Steps since the running child was chosen, 255 for more.
#[inline(always)]
pub fn run_steps(run: u32) -> u32 {
    (run >> 8) & 0xff
}

/// Children that were applicable at the last step.
#[inline(always)]
pub fn run_applicable(run: u32) -> u32 {
    (run >> 16) & 0xff
}

/// Packs what skills over skills record besides memories and values.
#[inline(always)]
pub fn high_level(running: u32, applicable: u32, room: u32) -> u32 {
    running | (applicable << 8) | (room << 16)
}

/// The running child, or `NO_CHILD`.
#[inline(always)]
pub fn high_level_running(word: u32) -> u32 {
    word & 0xff
}

/// Bits of the applicable children.
#[inline(always)]
pub fn high_level_applicable(word: u32) -> u32 {
    (word >> 8) & 0xff
}

/// The room.
#[inline(always)]
pub fn high_level_room(word: u32) -> u32 {
    (word >> 16) & 0xff
}

impl Workgroup<'_> {
    /// Completes the record with what only skills over skills are given: the running child, the applicable ones, the
    /// room, the children's values, the memories.
    pub fn write_high_level(&mut self, n: u32) {
        let mut applicable = 0;
        for child in 0..self.skills[n as usize].children as usize {
            let code = self.skills[n as usize].child[child] as usize;
            let known = code >= SKILL_CODE && ((self.skills[n as usize].thresholded >> child) & 1) == 1;
            let mut worth = 0.0;
            if known {
                worth = self.best_value[code - SKILL_CODE];
            }
            let above = !known || worth > self.params[n as usize].threshold[child];
            applicable |= if above { 1 << child } else { 0 };
            self.record.value[child] = worth;
        }
        for lane in self.skills[n as usize].children as usize..MAX_CHILDREN {
            self.record.value[lane] = 0.0;
        }
        let room = self.world.room_of(self.agent.x, self.agent.y);
        self.record.high_level = high_level(run_child(self.agent.run[n as usize]), applicable, room);
        self.recall();
    }
}
