//! Kernel `advance`: moves a learner on by a number of quanta. A quantum is one trial step, one replayed
//! transition, or one change of phase.
//!
//! The learner is a state machine whose whole state is in its [`Cursor`](crate::learner::layout::Cursor), so
//! it makes no difference how often it is interrupted. Twin: `shaders/advance.wgsl`.

use crate::learner::layout::Dispatch;
use crate::learner::memory::{Learner, Scratch};
use crate::learner::phase::{PHASE_ACT, PHASE_DONE, PHASE_FAILED, PHASE_REPLAY, PHASE_START, PHASE_TEACH};
use crate::lesson::record::{CUT, ENDED, note, write_header, write_outcome, write_record, write_row};
use crate::lesson::replay::{begin_replay, lesson_word, recent_lesson, replay_step, sound_weights, taught_lesson};
use crate::math::rng::{Purpose, Stream, below, draw, roll};
use crate::skill::act::{descend, execute, place, sense, think, watch};
use crate::skill::choose::{NO_CHILD, choose, sharpness};
use crate::skill::observe::DICE_CHOICE;
use crate::skill::persist::{commit, options};
use crate::skill::start::{start_pose, start_region};

/// Whether the learner is past the point at which this dispatch stops.
#[inline(always)]
fn stopped(learner: &Learner<'_>, dispatch: &Dispatch) -> bool {
    let cursor = &learner.cursor;
    let beyond = cursor.skill > dispatch.stop_skill && cursor.phase <= PHASE_START;
    let reached =
        cursor.skill == dispatch.stop_skill && cursor.phase == PHASE_START && cursor.trial >= dispatch.stop_trial;
    beyond || reached || cursor.phase >= PHASE_DONE
}

/// Waits for the next trial, unless a weight is spoiled.
#[inline(always)]
fn conclude(learner: &mut Learner<'_>, base: u32) {
    // What the last update spoiled is replayed too late: tests come first, and the next skill builds on it.
    learner.cursor.phase = if sound_weights(learner, base) { PHASE_START } else { PHASE_FAILED };
}

/// Learns from the taught lessons, pass after pass, and lists them as trials.
#[inline(always)]
fn teach(learner: &mut Learner<'_>, scratch: &mut Scratch, base: u32) {
    let settings = &learner.settings[learner.cursor.skill as usize];
    let begun = learner.cursor.replay;
    let finished = learner.cursor.replay_left == 0 && learner.cursor.replay_open == 0;
    if finished && begun >= settings.taught_passes * settings.lessons {
        conclude(learner, base);
    } else {
        if finished {
            let number = begun % settings.lessons;
            let lesson = taught_lesson(learner, number);
            // Every other pass.
            begin_replay(learner, lesson, 1, (begun / settings.lessons) & 1);
            if begun < settings.lessons {
                let steps = lesson_word(learner, 0);
                let end = lesson_word(learner, 1);
                let reward = f32::from_bits(lesson_word(learner, 2));
                let collisions = lesson_word(learner, 3);
                learner.cursor.actions += steps;
                write_row(learner.rows, learner.cursor, number, steps, reward, end, collisions, 1);
            }
        }
        replay_step(learner, scratch, base);
    }
}

/// Begins the next trial, or the next skill after the last one.
#[inline(always)]
fn start(learner: &mut Learner<'_>, dispatch: &Dispatch) {
    let settings = &learner.settings[learner.cursor.skill as usize];
    if learner.cursor.trial >= settings.trials {
        learner.cursor.skill += 1;
        learner.cursor.trial = 0;
        learner.cursor.remembered = 0;
        learner.cursor.replay = 0;
        learner.cursor.phase = if learner.cursor.skill < dispatch.skills { PHASE_TEACH } else { PHASE_DONE };
    } else {
        let skill = &learner.shared.skills[learner.cursor.skill as usize];
        let stream = Stream {
            key: [settings.run_seed, settings.learner_seed],
            skill: learner.cursor.skill,
            trial: learner.cursor.trial,
            step: 0,
            purpose: Purpose::Start as u32,
        };
        let words = draw(stream, 0);
        let region = start_region(skill, words[0]) as usize;
        let pose = start_pose(&learner.shared.atlas, skill.start_offset[region], skill.start_count[region], words);
        place(&mut learner.cursor.agent, learner.shared, pose);
        learner.cursor.phase = PHASE_ACT;
    }
}

/// Looks, and closes the trial where it is over, or else takes one step of it and records it.
#[inline(always)]
fn act(learner: &mut Learner<'_>, scratch: &mut Scratch, base: u32, lessons_base: u32) {
    let root = learner.cursor.skill;
    let settings = &learner.settings[root as usize];
    let skill = &learner.shared.skills[root as usize];
    let words = skill.record_words;
    let slot = learner.cursor.remembered % settings.memory;
    let lesson = lessons_base + skill.memory_offset + slot * skill.lesson_stride;
    let step = learner.cursor.agent.step;
    let stream = Stream {
        key: [settings.run_seed, settings.learner_seed],
        skill: root,
        trial: learner.cursor.trial,
        step,
        purpose: Purpose::Step as u32,
    };
    let dice = roll(stream);
    sense(&mut learner.cursor.agent, learner.shared, scratch, settings, &dice);
    if step > 0 {
        let (events, earned) = (learner.cursor.agent.events, learner.cursor.agent.earned);
        write_outcome(learner.lessons, words, lesson, step - 1, events, earned);
    }
    let achieved = (learner.cursor.agent.events & skill.ends) != 0;
    watch(&learner.cursor.agent, learner.shared, scratch, learner.settings, learner.nets, base, root);
    think(&learner.cursor.agent, learner.shared, scratch, learner.settings, learner.nets, base, root);
    let persist = settings.persist_training == 1;
    let found = options(&learner.cursor.agent, scratch, &learner.shared.skills, settings, root, persist);
    if achieved || step >= settings.max_steps {
        let end = if achieved { ENDED } else { CUT };
        note(&mut scratch.record, NO_CHILD, found);
        write_record(learner.lessons, &scratch.record, words, lesson, step);
        let (earned, hits) = (learner.cursor.agent.reward, learner.cursor.agent.collisions);
        write_header(learner.lessons, lesson, step, end, earned, hits);
        let trial = learner.cursor.trial;
        write_row(learner.rows, learner.cursor, trial, step, earned, end, hits, 0);
        learner.cursor.remembered += 1;
        learner.cursor.replay = 0;
        learner.cursor.phase = PHASE_REPLAY;
    } else {
        let heat = sharpness(settings, learner.cursor.trial);
        let child = choose(scratch, settings, skill.children, found.allowed, heat, false, dice.x[DICE_CHOICE]);
        note(&mut scratch.record, child, found);
        write_record(learner.lessons, &scratch.record, words, lesson, step);
        let agent = &mut learner.cursor.agent;
        commit(agent, root, child, found);
        let action = descend(agent, learner.shared, scratch, learner.settings, learner.nets, base, root, child, &dice);
        execute(agent, learner.shared, settings, action, &dice);
        learner.cursor.actions += 1;
    }
}

/// Replays one transition: taught lessons first, then remembered ones.
#[inline(always)]
fn replay(learner: &mut Learner<'_>, scratch: &mut Scratch, base: u32) {
    let settings = &learner.settings[learner.cursor.skill as usize];
    let begun = learner.cursor.replay;
    let taught = if settings.lessons > 0 { settings.taught_replays } else { 0 };
    let finished = learner.cursor.replay_left == 0 && learner.cursor.replay_open == 0;
    if finished && begun >= taught + settings.replays {
        learner.cursor.trial += 1;
        conclude(learner, base);
    } else {
        if finished {
            let stream = Stream {
                key: [settings.run_seed, settings.learner_seed],
                skill: learner.cursor.skill,
                trial: learner.cursor.trial,
                step: begun,
                purpose: Purpose::Replay as u32,
            };
            let words = draw(stream, 0);
            let word = words[0];
            let mirrored = words[1] & 1;
            if begun < taught {
                let lesson = taught_lesson(learner, below(word, settings.lessons));
                begin_replay(learner, lesson, 1, mirrored);
            } else {
                let lesson = recent_lesson(learner, word);
                begin_replay(learner, lesson, 0, mirrored);
            }
        }
        replay_step(learner, scratch, base);
    }
}

/// Moves one learner on by at most `dispatch.quanta`. Its slices of the buffers begin at word 0.
#[inline(always)]
pub fn advance(learner: &mut Learner<'_>, dispatch: &Dispatch) {
    let mut scratch = Scratch::default();
    let base = 0;
    let lessons_base = 0;
    for _quantum in 0..dispatch.quanta {
        if stopped(learner, dispatch) {
            break;
        }
        match learner.cursor.phase {
            PHASE_TEACH => teach(learner, &mut scratch, base),
            PHASE_START => start(learner, dispatch),
            PHASE_ACT => act(learner, &mut scratch, base, lessons_base),
            _ => replay(learner, &mut scratch, base),
        }
    }
}
