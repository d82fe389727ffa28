//! Rewards by the names of their events.

use skilltree::layout::{Event, SKILL_EVENTS};

/// What a skill pays; nothing for the events left out.
pub(crate) fn rewards(paid: &[(Event, f32)]) -> [f32; SKILL_EVENTS] {
    let mut reward = [0.0; SKILL_EVENTS];
    for (event, amount) in paid {
        reward[*event as usize] = *amount;
    }
    reward
}
