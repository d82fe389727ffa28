//! Kernel `evaluate`: moves a greedy test trial on by a number of steps. The nets are read only.
//!
//! Every test of a learner begins from the same starts; the noise differs from test to test. Twin:
//! `shaders/evaluate.wgsl`.

use crate::learner::layout::{Dispatch, Episode, Settings};
use crate::learner::memory::{Scratch, Shared};
use crate::math::rng::{Purpose, Stream, draw, noise, roll};
use crate::qnet::forward::forward;
use crate::robot::motion::{COLLISION, NO_ACTION, move_body};
use crate::robot::noise::noise_of;
use crate::skill::choose::weigh;
use crate::skill::encode::encode;
use crate::skill::observe::{DICE_ACTUATOR, observe};
use crate::skill::reward::{passed_door, reward_of, room_of};
use crate::skill::start::start_pose;

/// Not begun.
pub const STATE_FRESH: u32 = 0;
/// Running.
pub const STATE_RUNNING: u32 = 1;
/// Ended with the goal achieved.
pub const STATE_ACHIEVED: u32 = 2;
/// Cut at the step limit.
pub const STATE_CUT: u32 = 3;

/// Puts the robot at the start of test trial `number`.
#[inline(always)]
fn begin(episode: &mut Episode, shared: &Shared, settings: &Settings, dispatch: &Dispatch, number: u32) {
    let skill = &shared.skills[dispatch.test_skill as usize];
    let stream = Stream {
        key: [settings.run_seed, settings.learner_seed],
        skill: dispatch.test_skill,
        trial: number,
        step: 0,
        purpose: Purpose::TestStart as u32,
    };
    let pose = start_pose(&shared.atlas, skill.tests_offset, skill.tests_count, draw(stream, 0));
    episode.x = pose.x;
    episode.y = pose.y;
    episode.heading = pose.heading;
    episode.bumpers = 0;
    episode.step = 0;
    episode.masked = NO_ACTION;
    episode.origin = room_of(&shared.floor.plan, pose.x, pose.y);
    episode.state = STATE_RUNNING;
    episode.reward = 0.0;
    episode.collisions = 0;
    episode.start_x = pose.x;
    episode.start_y = pose.y;
}

/// Moves test trial `number` of one learner on by at most `dispatch.quanta` steps.
#[inline(always)]
pub fn evaluate(
    episode: &mut Episode,
    shared: &Shared,
    settings: &Settings,
    nets: &[f32],
    dispatch: &Dispatch,
    number: u32,
) {
    let mut scratch = Scratch::default();
    let skill = &shared.skills[dispatch.test_skill as usize];
    let terms = noise_of(settings);
    let base = 0;
    if episode.state == STATE_FRESH {
        begin(episode, shared, settings, dispatch, number);
    }
    for _quantum in 0..dispatch.quanta {
        if episode.state != STATE_RUNNING {
            break;
        }
        let stream = Stream {
            key: [settings.run_seed, settings.learner_seed],
            skill: dispatch.test_skill | dispatch.test_number << 8,
            trial: number,
            step: episode.step,
            purpose: Purpose::Test as u32,
        };
        let dice = roll(stream);
        observe(shared, &mut scratch, &dice, episode.x, episode.y, episode.heading, episode.bumpers, terms);
        encode(shared, &mut scratch, skill);
        forward(nets, &mut scratch, skill, base);
        let outlook = weigh(&mut scratch, skill.children, episode.masked, 1.0);
        let child = outlook.greedy;
        let slip = terms.actuator * noise(terms.kind, dice.x[DICE_ACTUATOR], dice.y[DICE_ACTUATOR]) + 1.0;
        let action = skill.action[child as usize];
        let moved = move_body(&shared.floor, episode.x, episode.y, episode.heading, action, slip);
        let events = moved.events | passed_door(&shared.floor.plan, episode.origin, moved.x, moved.y);
        let hit = (events & COLLISION) == COLLISION;
        episode.x = moved.x;
        episode.y = moved.y;
        episode.heading = moved.heading;
        episode.bumpers = moved.bumpers;
        episode.masked = if hit && settings.mask_blocked == 1 { child } else { NO_ACTION };
        episode.step += 1;
        episode.reward += reward_of(settings, events);
        episode.collisions += u32::from(hit);
        let achieved = (events & skill.ends) != 0;
        let cut = if episode.step >= settings.max_steps { STATE_CUT } else { STATE_RUNNING };
        episode.state = if achieved { STATE_ACHIEVED } else { cut };
    }
}
