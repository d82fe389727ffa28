//! Which children may be chosen now: the Persistence Rule (paper, section VI.B).

use crate::env::motion::NO_ACTION;
use crate::env::workgroup::Workgroup;
use crate::layout::{MAX_CHILDREN, NO_CHILD, SKILL_CODE};
use crate::policy::applicability::{high_level_applicable, run_applicable, run_child, run_steps, run_word};

/// What a skill may choose at one step. Sets of children are bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Choices {
    /// Applicable children.
    pub applicable: u32,
    /// What a free choice is made among; where the running child may not be left, that child as well.
    pub offered: u32,
    /// What may be chosen now.
    pub allowed: u32,
    /// 1 where the choice is free.
    pub decision: u32,
}

impl Workgroup<'_> {
    /// What skill `n` may choose. For a skill over actions that is every action, or every action but a blocked one.
    pub fn action_mask(&self, n: u32, persist: bool) -> Choices {
        let s = n as usize;
        let all = (1 << self.skills[s].children) - 1;
        let mut open = 0;
        let mut actions = 0;
        for child in 0..self.skills[s].children as usize {
            let code = self.skills[s].child[child];
            // A lone child is always available.
            let masked = self.params[s].mask_blocked == 1 && code == self.agent.blocked;
            let free = !masked || self.skills[s].children == 1;
            open |= if free { 1 << child } else { 0 };
            actions |= if code < SKILL_CODE as u32 { 1 << child } else { 0 };
        }
        let high = actions != all;
        let applicable = if high { high_level_applicable(self.record.high_level) } else { all };
        let suited = if self.params[s].applicability == 1 { applicable & open } else { open };
        let choices = if suited != 0 { suited } else { open };
        let running = run_child(self.agent.run[s]);
        let before = run_applicable(self.agent.run[s]);
        let mut own = 0;
        let mut code = NO_ACTION;
        if running < MAX_CHILDREN as u32 {
            own = 1 << running;
            code = self.skills[s].child[running as usize];
        }
        // An action ends by itself; a skill ends where its goal is achieved.
        let skill = own != 0 && code >= SKILL_CODE as u32;
        let mut achieved = false;
        if skill {
            let below = code - SKILL_CODE as u32;
            achieved = (self.skill_events(below) & self.skills[below as usize].ends) != 0;
        }
        let fresh = (applicable & !before & !own) != 0;
        let lost = self.params[s].interrupt == 1 && (applicable & own) == 0;
        let late = self.params[s].child_timeout > 0 && run_steps(self.agent.run[s]) >= self.params[s].child_timeout;
        let free = !persist || !skill || achieved || fresh || lost || late;
        // What runs on is an alternative, even where it is no longer applicable: the step is learned with it.
        let offered = if free { choices } else { choices | own };
        let allowed = if free { choices } else { own };
        Choices { applicable, offered, allowed, decision: u32::from(free) }
    }

    /// Notes that skill `n` has chosen `child`.
    pub fn commit(&mut self, n: u32, child: u32, choices: Choices) {
        let steps = run_steps(self.agent.run[n as usize]);
        let counted = if choices.decision == 1 { 1 } else { steps + 1 };
        let held = if counted < 255 { counted } else { 255 };
        self.agent.run[n as usize] = run_word(child, held, choices.applicable);
    }

    /// Skills that were not asked at this step no longer run.
    pub fn stop_unasked(&mut self, root: u32, asked: u32) {
        for n in 0..root as usize {
            self.agent.run[n] = if ((asked >> n) & 1) == 1 { self.agent.run[n] } else { NO_CHILD };
        }
    }
}
