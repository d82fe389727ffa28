//! Kernel `evaluate`: moves a greedy test trial on by a number of steps. The nets are read only.
//!
//! Every test of a learner begins from the same starts; the noise differs from test to test. Twin:
//! `shaders/kernels/evaluate.wgsl`.

use crate::env::observe::DRAW_CHOICE;
use crate::env::reset::start_pose;
use crate::env::workgroup::{CohortData, Scratch};
use crate::layout::{Dispatch, Episode, HyperParams};
use crate::math::rng::{Purpose, Stream, draw, draw_step};
use crate::policy::hierarchy::{descend, execute, place, sense, think, watch};
use crate::policy::persistence::{commit, options};
use crate::policy::select::choose;

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
fn begin(episode: &mut Episode, shared: &CohortData, params: &HyperParams, dispatch: &Dispatch, number: u32) {
    let skill = &shared.skills[dispatch.test_skill as usize];
    let stream = Stream {
        key: [params.run_seed, params.learner_seed],
        skill: dispatch.test_skill,
        trial: number,
        step: 0,
        purpose: Purpose::TestStart as u32,
    };
    let pose = start_pose(&shared.tables, skill.tests_offset, skill.tests_count, draw(stream, 0));
    place(&mut episode.agent, shared, pose);
    episode.state = STATE_RUNNING;
    episode.start_x = pose.x;
    episode.start_y = pose.y;
}

/// Moves test trial `number` of one learner on by at most `dispatch.iterations` steps. `params` are the learner's, one
/// record per skill.
#[inline(always)]
pub fn evaluate(
    episode: &mut Episode,
    shared: &CohortData,
    params: &[HyperParams],
    nets: &[f32],
    dispatch: &Dispatch,
    number: u32,
) {
    let mut scratch = Scratch::default();
    let root = dispatch.test_skill;
    let skill = &shared.skills[root as usize];
    let own = &params[root as usize];
    let base = 0;
    if episode.state == STATE_FRESH {
        begin(episode, shared, own, dispatch, number);
    }
    for _quantum in 0..dispatch.iterations {
        if episode.state != STATE_RUNNING {
            break;
        }
        let stream = Stream {
            key: [own.run_seed, own.learner_seed],
            skill: root | dispatch.test_number << 8,
            trial: number,
            step: episode.agent.step,
            purpose: Purpose::Test as u32,
        };
        let random = draw_step(stream);
        sense(&mut episode.agent, shared, &mut scratch, own, &random);
        let achieved = (episode.agent.events & skill.ends) != 0;
        if achieved || episode.agent.step >= own.max_steps {
            episode.state = if achieved { STATE_ACHIEVED } else { STATE_CUT };
        } else {
            watch(&episode.agent, shared, &mut scratch, params, nets, base, root);
            think(&episode.agent, shared, &mut scratch, params, nets, base, root);
            let persist = own.persist_tests == 1;
            let found = options(&episode.agent, &scratch, &shared.skills, own, root, persist);
            let child = choose(&mut scratch, own, skill.children, found.allowed, 1.0, true, random.x[DRAW_CHOICE]);
            commit(&mut episode.agent, root, child, found);
            let agent = &mut episode.agent;
            let action = descend(agent, shared, &mut scratch, params, nets, base, root, child, &random);
            execute(agent, shared, own, action, &random);
        }
    }
}
