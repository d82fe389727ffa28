//! The six actions: noisy turns in place and noisy travel that stops at contact.

use super::contact::{bumpers, sweep};
use super::segments::SegmentGrid;
use crate::layout::ACTIONS;
pub use crate::layout::actions::{ACTION_TURN, BACKWARD, FORWARD, NO_ACTION};
pub use crate::layout::events::{BESIDE_LEFT, BESIDE_RIGHT, COLLISION, DOCKED, PASSED_DOOR};
use crate::math::functions::{sin_cos, wrap_degrees};

/// The body after an action.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moved {
    /// Inches.
    pub x: f32,
    /// Inches.
    pub y: f32,
    /// Degrees.
    pub heading: f32,
    /// Touching bumpers: 1 front, 2 left, 4 back, 8 right.
    pub bumpers: u32,
    /// What happened: [`DOCKED`], [`COLLISION`].
    pub events: u32,
}

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

/// Carries out an action whose length is off by the factor `slip`.
#[inline(always)]
pub fn move_body(floor: &SegmentGrid, x: f32, y: f32, heading: f32, action: u32, slip: f32) -> Moved {
    let after = heading_after(heading, action, slip);
    let (sine, cosine) = sin_cos(after);
    go(floor, x, y, after, sine, cosine, action, slip)
}

/// What is left of an action once the robot has its new `heading`, which comes with its sine and cosine.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the twin of a shader function, which has no methods")]
pub fn go(floor: &SegmentGrid, x: f32, y: f32, heading: f32, sine: f32, cosine: f32, action: u32, slip: f32) -> Moved {
    let mut moved = Moved { x, y, heading, bumpers: 0, events: 0 };
    let wanted = 12.0 * slip;
    let reach = if wanted > 0.0 { wanted } else { 0.0 };
    let near = floor.touchable(x, y, reach);
    if action == FORWARD || action == BACKWARD {
        let ux = if action == FORWARD { cosine } else { -cosine };
        let uy = if action == FORWARD { sine } else { -sine };
        let travel = sweep(near, floor.plan.dock_cosine, x, y, ux, uy, reach);
        moved.x = x + ux * travel.distance;
        moved.y = y + uy * travel.distance;
        let docked = travel.connected && action == FORWARD;
        let stopped = if travel.blocked { COLLISION } else { 0 };
        moved.events = if docked { DOCKED } else { stopped };
    }
    moved.bumpers = bumpers(near, moved.x, moved.y, cosine, sine);
    moved
}
