//! Kernel `advance`: moves a learner on by a number of iterations. A iteration is one trial step, one replayed
//! transition, or one change of phase.
//!
//! The learner is a state machine whose whole state is in its [`LearnerState`](crate::layout::LearnerState), so
//! it makes no difference how often it is interrupted. Twin: `shaders/kernels/train.wgsl`.

use crate::env::observe::DRAW_CHOICE;
use crate::env::reset::{start_pose, start_region};
use crate::env::workgroup::{Learner, Scratch};
use crate::layout::Dispatch;
use crate::layout::phase::{PHASE_ACT, PHASE_DONE, PHASE_FAILED, PHASE_REPLAY, PHASE_START, PHASE_TEACH};
use crate::learn::lesson::{CUT, ENDED, note, write_header, write_outcome, write_record, write_row};
use crate::learn::td_lambda::{begin_replay, lesson_word, recent_lesson, replay_step, sound_weights, taught_lesson};
use crate::math::rng::{Purpose, Stream, below, draw, draw_step};
use crate::policy::hierarchy::{descend, execute, place, sense, think, watch};
use crate::policy::persistence::{commit, options};
use crate::policy::select::{NO_CHILD, choose, inverse_temperature};

/// Whether the learner is past the point at which this dispatch stops.
#[inline(always)]
fn stopped(learner: &Learner<'_>, dispatch: &Dispatch) -> bool {
    let state = &learner.state;
    let beyond = state.skill > dispatch.stop_skill && state.phase <= PHASE_START;
    let reached =
        state.skill == dispatch.stop_skill && state.phase == PHASE_START && state.trial >= dispatch.stop_trial;
    beyond || reached || state.phase >= PHASE_DONE
}

/// Waits for the next trial, unless a weight is spoiled.
#[inline(always)]
fn conclude(learner: &mut Learner<'_>, base: u32) {
    // What the last update spoiled is replayed too late: tests come first, and the next skill builds on it.
    learner.state.phase = if sound_weights(learner, base) { PHASE_START } else { PHASE_FAILED };
}

/// Learns from the taught lessons, pass after pass, and lists them as trials.
#[inline(always)]
fn teach(learner: &mut Learner<'_>, scratch: &mut Scratch, base: u32) {
    let params = &learner.params[learner.state.skill as usize];
    let begun = learner.state.replay;
    let finished = learner.state.replay_left == 0 && learner.state.replay_open == 0;
    if finished && begun >= params.pretrain_epochs * params.lessons {
        conclude(learner, base);
    } else {
        if finished {
            let number = begun % params.lessons;
            let lesson = taught_lesson(learner, number);
            // Every other pass.
            begin_replay(learner, lesson, 1, (begun / params.lessons) & 1);
            if begun < params.lessons {
                let steps = lesson_word(learner, 0);
                let end = lesson_word(learner, 1);
                let reward = f32::from_bits(lesson_word(learner, 2));
                let collisions = lesson_word(learner, 3);
                learner.state.actions += steps;
                write_row(learner.rows, learner.state, number, steps, reward, end, collisions, 1);
            }
        }
        replay_step(learner, scratch, base);
    }
}

/// Begins the next trial, or the next skill after the last one.
#[inline(always)]
fn start(learner: &mut Learner<'_>, dispatch: &Dispatch) {
    let params = &learner.params[learner.state.skill as usize];
    if learner.state.trial >= params.trials {
        learner.state.skill += 1;
        learner.state.trial = 0;
        learner.state.remembered = 0;
        learner.state.replay = 0;
        learner.state.phase = if learner.state.skill < dispatch.skills { PHASE_TEACH } else { PHASE_DONE };
    } else {
        let skill = &learner.shared.skills[learner.state.skill as usize];
        let stream = Stream {
            key: [params.run_seed, params.learner_seed],
            skill: learner.state.skill,
            trial: learner.state.trial,
            step: 0,
            purpose: Purpose::Start as u32,
        };
        let words = draw(stream, 0);
        let region = start_region(skill, words[0]) as usize;
        let pose = start_pose(&learner.shared.tables, skill.start_offset[region], skill.start_count[region], words);
        place(&mut learner.state.agent, learner.shared, pose);
        learner.state.phase = PHASE_ACT;
    }
}

/// Looks, and closes the trial where it is over, or else takes one step of it and records it.
#[inline(always)]
fn act(learner: &mut Learner<'_>, scratch: &mut Scratch, base: u32, lessons_base: u32) {
    let root = learner.state.skill;
    let params = &learner.params[root as usize];
    let skill = &learner.shared.skills[root as usize];
    let words = skill.record_words;
    let slot = learner.state.remembered % params.replay_capacity;
    let lesson = lessons_base + skill.memory_offset + slot * skill.lesson_stride;
    let step = learner.state.agent.step;
    let stream = Stream {
        key: [params.run_seed, params.learner_seed],
        skill: root,
        trial: learner.state.trial,
        step,
        purpose: Purpose::Step as u32,
    };
    let random = draw_step(stream);
    sense(&mut learner.state.agent, learner.shared, scratch, params, &random);
    if step > 0 {
        let (events, earned) = (learner.state.agent.events, learner.state.agent.earned);
        write_outcome(learner.lessons, words, lesson, step - 1, events, earned);
    }
    let achieved = (learner.state.agent.events & skill.ends) != 0;
    watch(&learner.state.agent, learner.shared, scratch, learner.params, learner.nets, base, root);
    think(&learner.state.agent, learner.shared, scratch, learner.params, learner.nets, base, root);
    let persist = params.persist_training == 1;
    let found = options(&learner.state.agent, scratch, &learner.shared.skills, params, root, persist);
    if achieved || step >= params.max_steps {
        let end = if achieved { ENDED } else { CUT };
        note(&mut scratch.record, NO_CHILD, found);
        write_record(learner.lessons, &scratch.record, words, lesson, step);
        let (earned, hits) = (learner.state.agent.reward, learner.state.agent.collisions);
        write_header(learner.lessons, lesson, step, end, earned, hits);
        let trial = learner.state.trial;
        write_row(learner.rows, learner.state, trial, step, earned, end, hits, 0);
        learner.state.remembered += 1;
        learner.state.replay = 0;
        learner.state.phase = PHASE_REPLAY;
    } else {
        let heat = inverse_temperature(params, learner.state.trial);
        let child = choose(scratch, params, skill.children, found.allowed, heat, false, random.x[DRAW_CHOICE]);
        note(&mut scratch.record, child, found);
        write_record(learner.lessons, &scratch.record, words, lesson, step);
        let agent = &mut learner.state.agent;
        commit(agent, root, child, found);
        let action = descend(agent, learner.shared, scratch, learner.params, learner.nets, base, root, child, &random);
        execute(agent, learner.shared, params, action, &random);
        learner.state.actions += 1;
    }
}

/// Replays one transition: taught lessons first, then remembered ones.
#[inline(always)]
fn replay(learner: &mut Learner<'_>, scratch: &mut Scratch, base: u32) {
    let params = &learner.params[learner.state.skill as usize];
    let begun = learner.state.replay;
    let taught = if params.lessons > 0 { params.taught_replays } else { 0 };
    let finished = learner.state.replay_left == 0 && learner.state.replay_open == 0;
    if finished && begun >= taught + params.replays {
        learner.state.trial += 1;
        conclude(learner, base);
    } else {
        if finished {
            let stream = Stream {
                key: [params.run_seed, params.learner_seed],
                skill: learner.state.skill,
                trial: learner.state.trial,
                step: begun,
                purpose: Purpose::Replay as u32,
            };
            let words = draw(stream, 0);
            let word = words[0];
            let mirrored = words[1] & 1;
            if begun < taught {
                let lesson = taught_lesson(learner, below(word, params.lessons));
                begin_replay(learner, lesson, 1, mirrored);
            } else {
                let lesson = recent_lesson(learner, word);
                begin_replay(learner, lesson, 0, mirrored);
            }
        }
        replay_step(learner, scratch, base);
    }
}

/// Moves one learner on by at most `dispatch.iterations`. Its slices of the buffers begin at word 0.
#[inline(always)]
pub fn advance(learner: &mut Learner<'_>, dispatch: &Dispatch) {
    let mut scratch = Scratch::default();
    let base = 0;
    let lessons_base = 0;
    for _quantum in 0..dispatch.iterations {
        if stopped(learner, dispatch) {
            break;
        }
        match learner.state.phase {
            PHASE_TEACH => teach(learner, &mut scratch, base),
            PHASE_START => start(learner, dispatch),
            PHASE_ACT => act(learner, &mut scratch, base, lessons_base),
            _ => replay(learner, &mut scratch, base),
        }
    }
}
