//! One primitive step of a robot in a trial: it observes, which settles what its last action earned, and it acts.

use super::motion::{ACTED, COLLISION, NO_ACTION, PASSED_DOOR};
use super::observe::DRAW_ACTUATOR;
use super::workgroup::Workgroup;
use crate::math::functions::flush;
use crate::math::rng::noise;

impl Workgroup<'_> {
    /// Observes, settles what the last action earned in the terms of a skill, and remembers.
    pub fn observe_and_score(&mut self, skill: u32) {
        let s = skill as usize;
        let (x, y, heading, bumpers) = (self.agent.x, self.agent.y, self.agent.heading, self.agent.bumpers);
        (self.forms.observe)(self, x, y, heading, bumpers, self.params[s].noise);
        let (near, far) = (self.params[s].beside_near, self.params[s].beside_far);
        self.agent.events |= self.record.observation.observed_events(near, far, self.agent.action, self.agent.events);
        self.agent.earned = self.reward_of(skill, self.skill_events(skill));
        self.agent.reward += self.agent.earned;
        self.agent.returned += self.agent.discount * self.agent.earned;
        self.agent.discount =
            if self.agent.step == 0 { 1.0 } else { flush(self.agent.discount * self.params[s].gamma) };
        self.remember(skill);
    }

    /// Carries out an action; its reward is settled by the next observation.
    pub fn apply_action(&mut self, skill: u32, action: u32) {
        let noise_terms = self.params[skill as usize].noise;
        let slip = noise_terms.actuator
            * noise(noise_terms.kind, self.random.x[DRAW_ACTUATOR], self.random.y[DRAW_ACTUATOR])
            + 1.0;
        let moved = (self.forms.move_body)(self, self.agent.x, self.agent.y, self.agent.heading, action, slip);
        let passed = self.world.passed_door(self.agent.origin, moved.x, moved.y);
        let hit = (moved.events & COLLISION) == COLLISION;
        self.agent.before_x = self.agent.x;
        self.agent.before_y = self.agent.y;
        self.agent.x = moved.x;
        self.agent.y = moved.y;
        self.agent.heading = moved.heading;
        self.agent.bumpers = moved.bumpers;
        if passed == PASSED_DOOR {
            self.agent.origin = self.world.room_of(moved.x, moved.y);
        }
        self.agent.blocked = if hit && self.agent.masks == 1 { action } else { NO_ACTION };
        self.agent.action = action;
        self.agent.events = moved.events | passed | ACTED;
        self.agent.step += 1;
        self.agent.collisions += u32::from(hit);
    }
}
