//! The six actions: noisy turns in place and noisy travel that stops at contact.

use super::workgroup::Workgroup;
use crate::layout::Moved;
use crate::layout::actions::{ACTION_TURN, ACTIONS};
pub use crate::layout::actions::{BACKWARD, FORWARD, NO_ACTION};
pub use crate::layout::events::{ACTED, BESIDE_LEFT, BESIDE_RIGHT, COLLISION, DOCKED, LIT, PASSED_DOOR};
use crate::math::functions::{sin_cos, wrap_degrees};

/// Degrees that an action turns, without noise.
#[inline(always)]
pub fn turn_of(action: u32) -> f32 {
    let known = action < ACTIONS as u32;
    let row = if known { action } else { 0 };
    if known { ACTION_TURN[row as usize] } else { 0.0 }
}

/// Heading after an action whose length is off by the factor `slip`, degrees.
#[inline(always)]
pub fn heading_after(heading: f32, action: u32, slip: f32) -> f32 {
    wrap_degrees(heading + turn_of(action) * slip)
}

impl Workgroup<'_> {
    /// Carries out an action whose length is off by the factor `slip`.
    pub fn move_body(&self, x: f32, y: f32, heading: f32, action: u32, slip: f32) -> Moved {
        let after = heading_after(heading, action, slip);
        let turn = sin_cos(after);
        let mut moved = Moved { x, y, heading: after, bumpers: 0, events: 0 };
        if action == FORWARD || action == BACKWARD {
            let ux = if action == FORWARD { turn.1 } else { -turn.1 };
            let uy = if action == FORWARD { turn.0 } else { -turn.0 };
            let wanted = 12.0 * slip;
            let reach = if wanted > 0.0 { wanted } else { 0.0 };
            let travel = self.sweep_disc(x, y, ux, uy, reach);
            moved.x = x + ux * travel.distance;
            moved.y = y + uy * travel.distance;
            let docked = travel.connected && action == FORWARD;
            let stopped = if travel.blocked { COLLISION } else { 0 };
            moved.events = if docked { DOCKED } else { stopped };
        }
        moved.bumpers = self.touching_bumpers(moved.x, moved.y, turn.1, turn.0);
        moved
    }
}
