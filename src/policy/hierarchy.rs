//! One step of a robot that pursues a skill: it senses, remembers, asks the skills of the tree, and moves.
//!
//! The choice is made anew on every primitive step at every level (paper, section VI.A); persistence decides how
//! free it is.

use crate::env::events::{following_wall, passed_door, reward_of, room_of};
use crate::env::memory::remember;
use crate::env::motion::{COLLISION, NO_ACTION, PASSED_DOOR, move_body};
use crate::env::observe::{DRAW_ACTUATOR, DRAW_CHOICE, observe};
use crate::env::workgroup::{CohortData, Scratch};
use crate::layout::{Agent, BASE_WORDS, HyperParams, MAX_CHILDREN, MAX_DEPTH, MAX_SKILLS, SKILL_CODE};
use crate::math::functions::flush;
use crate::math::rng::{StepRandom, noise};
use crate::policy::features::encode;
use crate::policy::persistence::{IDLE, commit, extend, options, rest};
use crate::policy::planner_table::consult;
use crate::policy::select::choose;
use crate::qnet::forward::forward;
use crate::world::Pose;
use bytemuck::Zeroable;

/// Puts the robot at the start of a trial.
#[inline(always)]
pub fn place(agent: &mut Agent, shared: &CohortData, pose: Pose) {
    *agent = Agent::zeroed();
    agent.x = pose.x;
    agent.y = pose.y;
    agent.heading = pose.heading;
    agent.origin = room_of(&shared.floor.plan, pose.x, pose.y);
    agent.blocked = NO_ACTION;
    agent.action = NO_ACTION;
    agent.discount = 1.0;
    for n in 0..MAX_SKILLS {
        agent.run[n] = IDLE;
    }
}

/// Senses, settles what the last action earned in the terms of the skill pursued, and remembers.
#[inline(always)]
pub fn sense(agent: &mut Agent, shared: &CohortData, scratch: &mut Scratch, params: &HyperParams, random: &StepRandom) {
    let terms = params.noise;
    observe(shared, &mut scratch.record, random, agent.x, agent.y, agent.heading, agent.bumpers, terms);
    agent.events |= following_wall(&scratch.record, params.beside_near, params.beside_far, agent.action, agent.events);
    agent.earned = reward_of(params, agent.events);
    agent.reward += agent.earned;
    agent.returned += agent.discount * agent.earned;
    agent.discount = if agent.step == 0 { 1.0 } else { flush(agent.discount * params.gamma) };
    remember(agent, scratch, params);
}

/// Q-values of skill `n`, from its nets or from the planner's table.
#[inline(always)]
pub fn think(
    agent: &Agent,
    shared: &CohortData,
    scratch: &mut Scratch,
    params: &[HyperParams],
    nets: &[f32],
    base: u32,
    n: u32,
) {
    let plan = &shared.skills[n as usize];
    if plan.record_words > BASE_WORDS as u32 {
        extend(agent, &shared.floor.plan, scratch, plan, &params[n as usize], n);
    }
    if plan.planned > 0 {
        consult(agent, shared, scratch, plan);
    } else {
        encode(shared, scratch, plan, plan.mirrored == 1);
        forward(nets, scratch, plan, &params[n as usize], base);
    }
}

/// Asks the skills below the root whose values somebody's applicability depends on, children first.
#[inline(always)]
pub fn watch(
    agent: &Agent,
    shared: &CohortData,
    scratch: &mut Scratch,
    params: &[HyperParams],
    nets: &[f32],
    base: u32,
    root: u32,
) {
    let watched = shared.skills[root as usize].watched;
    for n in 0..root {
        if ((watched >> n) & 1) == 1 {
            think(agent, shared, scratch, params, nets, base, n);
            let mut best = -2.0;
            for child in 0..shared.skills[n as usize].children as usize {
                let worth = scratch.q[child];
                best = if worth > best { worth } else { best };
                scratch.kept[n as usize * MAX_CHILDREN + child] = worth;
            }
            scratch.value[n as usize] = best;
        }
    }
}

/// Lets the skills below the root choose, down to an action, once the root has chosen `child`.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the twin of a shader function, which has no methods")]
pub fn descend(
    agent: &mut Agent,
    shared: &CohortData,
    scratch: &mut Scratch,
    params: &[HyperParams],
    nets: &[f32],
    base: u32,
    root: u32,
    child: u32,
    random: &StepRandom,
) -> u32 {
    let watched = shared.skills[root as usize].watched;
    let heat = params[root as usize].child_inverse_temperature;
    let mut code = shared.skills[root as usize].child[child as usize];
    let mut asked = 1 << root;
    let mut last = root;
    for depth in 1..MAX_DEPTH {
        if code < SKILL_CODE as u32 {
            break;
        }
        let n = code - SKILL_CODE as u32;
        let plan = &shared.skills[n as usize];
        if ((watched >> n) & 1) == 1 {
            for other in 0..plan.children as usize {
                scratch.q[other] = scratch.kept[n as usize * MAX_CHILDREN + other];
            }
            if plan.record_words > BASE_WORDS as u32 {
                extend(agent, &shared.floor.plan, scratch, plan, &params[n as usize], n);
            }
        } else {
            think(agent, shared, scratch, params, nets, base, n);
        }
        let own = &params[n as usize];
        let found = options(agent, scratch, &shared.skills, own, n, own.persist_tests == 1);
        let word = random.x[DRAW_CHOICE + depth];
        let chosen = choose(scratch, own, plan.children, found.allowed, heat, false, word);
        commit(agent, n, chosen, found);
        code = plan.child[chosen as usize];
        asked |= 1 << n;
        last = n;
    }
    rest(agent, root, asked);
    agent.masks = params[last as usize].mask_blocked;
    code
}

/// Carries out an action; its reward is settled by the next look.
#[inline(always)]
pub fn execute(agent: &mut Agent, shared: &CohortData, params: &HyperParams, action: u32, random: &StepRandom) {
    let terms = params.noise;
    let slip = terms.actuator * noise(terms.kind, random.x[DRAW_ACTUATOR], random.y[DRAW_ACTUATOR]) + 1.0;
    let moved = move_body(&shared.floor, agent.x, agent.y, agent.heading, action, slip);
    let passed = passed_door(&shared.floor.plan, agent.origin, moved.x, moved.y);
    let hit = (moved.events & COLLISION) == COLLISION;
    agent.x = moved.x;
    agent.y = moved.y;
    agent.heading = moved.heading;
    agent.bumpers = moved.bumpers;
    agent.origin = if passed == PASSED_DOOR { room_of(&shared.floor.plan, moved.x, moved.y) } else { agent.origin };
    agent.blocked = if hit && agent.masks == 1 { action } else { NO_ACTION };
    agent.action = action;
    agent.events = moved.events | passed;
    agent.step += 1;
    agent.collisions += u32::from(hit);
}
