//! The task that a planner solves: what an action does and earns, in the terms of one skill.

use crate::backend::cpu::lanes::contact::body_after;
use crate::backend::cpu::lanes::draws::place_of;
use crate::backend::cpu::lanes::light::{brightness, falloff, light_in_sight};
use crate::backend::cpu::lanes::sonar::{ranges, rays};
use crate::config::plan::{Action, Event, RegionEvent, SkillPlan};
use crate::env::motion::{ACTED, COLLISION, PASSED_DOOR};
use crate::env::sonar::sonar_reading;
use crate::env::workgroup::CohortData;
use crate::layout::{Area, Observation, RAYS, SKILL_EVENTS};
use crate::math::functions::sin_cos;
use crate::world::{Pose, World};
use bytemuck::Zeroable;

/// Bits of the events that the sensors tell of after a forward move.
const TOLD_AHEAD: u32 = Event::told_by_sensors(true);
/// Bits of those that they tell of after any action.
const TOLD_ALWAYS: u32 = Event::told_by_sensors(false);

/// What a skill pays for and where it ends.
#[derive(Debug, Clone)]
pub(super) struct Task {
    pub(super) reward: [f32; SKILL_EVENTS],
    /// Bits of the events that end a trial.
    ends: u32,
    /// Bits of the events that pay or end.
    matters: u32,
    /// Least and greatest reading beside a wall.
    beside: (u32, u32),
    /// The regions of the skill's events.
    regions: Vec<Area>,
    collision_cost: f32,
}

/// What one action does from one pose under one slip of the actuators.
#[derive(Debug, Clone, Copy)]
pub(super) struct Outcome {
    pub(super) pose: Pose,
    /// The room from which the next door counts.
    pub(super) origin: u32,
    pub(super) reward: f32,
    pub(super) ended: bool,
}

impl Task {
    /// `collision_cost` is paid besides the skill's own.
    pub(super) fn new(world: &World, skill: &SkillPlan, beside: (u32, u32), collision_cost: f32) -> Self {
        let reward = skill.params.reward;
        let paid = (0..SKILL_EVENTS).filter(|event| reward[*event] != 0.0).fold(0, |bits, event| bits | 1 << event);
        let area = |region: &String| world.region_area(region).map_or_else(Area::zeroed, Into::into);
        let regions = skill.regions.iter().map(area).collect();
        Self { reward, ends: skill.goal, matters: paid | skill.goal, beside, regions, collision_cost }
    }

    /// Whether this event pays or ends a trial.
    pub(super) fn names(&self, event: Event) -> bool {
        self.matters & event.bit() != 0
    }

    /// Whether a trial may go on after a door that pays: then what a room is worth depends on the others.
    pub(super) fn goes_on_after_doors(&self) -> bool {
        self.names(Event::PassedDoor) && self.ends & PASSED_DOOR == 0
    }

    /// Whether a turn, too, may earn something or end a trial.
    pub(super) fn pays_turns(&self) -> bool {
        let inside = (0..self.regions.len()).map(|region| 1 << RegionEvent::In.number(region));
        self.matters & inside.fold(ACTED | TOLD_ALWAYS, |bits, bit: u32| bits | bit) != 0
    }

    /// What an action does at a pose; the next door counts from room `origin`.
    pub(super) fn outcome(&self, shared: &CohortData, origin: u32, pose: Pose, action: Action, slip: f32) -> Outcome {
        let moved = body_after(&shared.floor, pose.x, pose.y, pose.heading, action as u32, slip);
        let after = Pose { x: moved.x, y: moved.y, heading: moved.heading };
        let mut events = moved.events | shared.floor.plan.passed_door(origin, moved.x, moved.y) | ACTED;
        if self.matters & (if action == Action::Forward { TOLD_AHEAD } else { TOLD_ALWAYS }) != 0 {
            let (near, far) = self.beside;
            let seen = noiseless_observation(shared, after, self.names(Event::Lit));
            events |= seen.observed_events(near, far, action as u32, events);
        }
        for (region, area) in self.regions.iter().enumerate() {
            events |= area.crossing_events(pose.x, pose.y, moved.x, moved.y) << RegionEvent::In.number(region);
        }
        let paid: f32 = (0..SKILL_EVENTS).filter(|i| (events >> i) & 1 == 1).map(|i| self.reward[i]).sum();
        let reward = if events & COLLISION == 0 { paid } else { paid - self.collision_cost };
        let passed = self.goes_on_after_doors() && events & PASSED_DOOR != 0;
        let origin = if passed { shared.floor.plan.room_of(moved.x, moved.y) } else { origin };
        Outcome { pose: after, origin, reward, ended: events & self.ends != 0 }
    }
}

/// What the sonar shows at a pose, and the light where it is asked for, without noise; the other sensors show nothing.
fn noiseless_observation(shared: &CohortData, pose: Pose, light: bool) -> Observation {
    let (floor, Pose { x, y, heading }) = (&shared.floor, pose);
    let (sine, cosine) = sin_cos(heading);
    let (ux, uy) = rays(cosine, sine);
    let range = ranges(floor, x, y, &ux, &uy);
    let mut seen = Observation::zeroed();
    for ray in 0..RAYS {
        seen.sonar[ray / 4] |= sonar_reading(range[place_of(ray)], 1.0) << (8 * (ray % 4));
    }
    let most = if light && floor.plan.lit == 1 { falloff(floor, x, y) } else { 0.0 };
    if most > 1.0 && light_in_sight(floor, x, y) {
        let bright = brightness(floor, most, x, y, &ux, &uy);
        let lit = (0..RAYS).filter(|bearing| bright[place_of(*bearing)] > 1.0);
        seen.light_bumpers = lit.fold(0, |bits, bearing| bits | 1 << bearing);
    }
    seen
}
