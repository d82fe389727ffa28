//! The six actions: noisy turns in place and noisy travel that stops at contact.

use super::workgroup::Workgroup;
use crate::layout::Moved;
use crate::math::functions::{sin_cos, wrap_degrees};

/// The charger stopped a forward move within the docking tolerance.
pub const DOCKED: u32 = 1;
/// Contact cut a move short, and it did not dock.
pub const COLLISION: u32 = 2;
/// The centre reached another room than the one before and is clear of the doorway.
pub const PASSED_DOOR: u32 = 4;
/// A forward move ended beside a wall on the right.
pub const BESIDE_RIGHT: u32 = 8;
/// A forward move ended beside a wall on the left.
pub const BESIDE_LEFT: u32 = 16;
/// Code of the forward move.
pub const FORWARD: u32 = 4;
/// Code of the backward move.
pub const BACKWARD: u32 = 5;
/// Code that stands for no action.
pub const NO_ACTION: u32 = 255;

/// Degrees that an action turns, without noise.
#[inline(always)]
pub fn turn_of(action: u32) -> f32 {
    let size = if action < 2 { 15.0 } else { 60.0 };
    let signed = if (action & 1) == 1 { -size } else { size };
    if action < FORWARD { signed } else { 0.0 }
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
