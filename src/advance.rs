//! Kernel `advance`: moves a learner on by a number of quanta. A quantum is one trial step, one replayed
//! transition, or one change of phase.
//!
//! The learner is a state machine whose whole state is in its [`Cursor`](crate::learner::layout::Cursor), so
//! it makes no difference how often it is interrupted. Twin: `shaders/advance.wgsl`.

use crate::learner::layout::{Dispatch, RECORD_WORDS};
use crate::learner::memory::{Learner, Scratch};
use crate::learner::phase::{PHASE_ACT, PHASE_DONE, PHASE_REPLAY, PHASE_START, PHASE_TEACH};
use crate::lesson::record::{CUT, ENDED, note, write_header, write_record, write_row};
use crate::lesson::replay::{begin_replay, lesson_word, recent_lesson, replay_step, taught_lesson};
use crate::math::rng::{Purpose, Stream, below, draw, noise, roll};
use crate::qnet::forward::forward;
use crate::robot::motion::{COLLISION, NO_ACTION, move_body};
use crate::robot::noise::noise_of;
use crate::skill::choose::{pick, sharpness, weigh};
use crate::skill::encode::encode;
use crate::skill::observe::{DICE_ACTUATOR, DICE_CHOICE, observe};
use crate::skill::reward::{passed_door, reward_of, room_of};
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

/// Learns from the taught lessons, pass after pass, and lists them as trials.
#[inline(always)]
fn teach(learner: &mut Learner<'_>, scratch: &mut Scratch, base: u32) {
    let settings = &learner.settings[learner.cursor.skill as usize];
    let begun = learner.cursor.replay;
    let finished = learner.cursor.replay_left == 0 && learner.cursor.replay_open == 0;
    if finished && begun >= settings.taught_passes * settings.lessons {
        learner.cursor.phase = PHASE_START;
    } else {
        if finished {
            let number = begun % settings.lessons;
            let lesson = taught_lesson(learner, number);
            begin_replay(learner, lesson, 1);
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
        learner.cursor.x = pose.x;
        learner.cursor.y = pose.y;
        learner.cursor.heading = pose.heading;
        learner.cursor.bumpers = 0;
        learner.cursor.masked = NO_ACTION;
        learner.cursor.origin = room_of(&learner.shared.floor.plan, pose.x, pose.y);
        learner.cursor.step = 0;
        learner.cursor.reward = 0.0;
        learner.cursor.collisions = 0;
        learner.cursor.phase = PHASE_ACT;
    }
}

/// Takes one step of the trial and records it.
#[inline(always)]
fn act(learner: &mut Learner<'_>, scratch: &mut Scratch, base: u32, lessons_base: u32) {
    let settings = &learner.settings[learner.cursor.skill as usize];
    let skill = &learner.shared.skills[learner.cursor.skill as usize];
    let terms = noise_of(settings);
    let mut stream = Stream {
        key: [settings.run_seed, settings.learner_seed],
        skill: learner.cursor.skill,
        trial: learner.cursor.trial,
        step: learner.cursor.step,
        purpose: Purpose::Step as u32,
    };
    let slot = learner.cursor.remembered % settings.memory;
    let lesson = lessons_base + skill.memory_offset + slot * skill.lesson_stride;
    let dice = roll(stream);
    let (x, y, heading, touch) = (learner.cursor.x, learner.cursor.y, learner.cursor.heading, learner.cursor.bumpers);
    observe(learner.shared, scratch, &dice, x, y, heading, touch, terms);
    encode(learner.shared, scratch, skill);
    forward(learner.nets, scratch, skill, base);
    let outlook = weigh(scratch, skill.children, learner.cursor.masked, sharpness(settings, learner.cursor.trial));
    let child = pick(scratch, outlook, dice.x[DICE_CHOICE]);
    let slip = terms.actuator * noise(terms.kind, dice.x[DICE_ACTUATOR], dice.y[DICE_ACTUATOR]) + 1.0;
    let moved = move_body(&learner.shared.floor, x, y, heading, skill.action[child as usize], slip);
    let events = moved.events | passed_door(&learner.shared.floor.plan, learner.cursor.origin, moved.x, moved.y);
    let reward = reward_of(settings, events);
    note(&mut scratch.record, child, learner.cursor.masked, events, reward);
    write_record(learner.lessons, &scratch.record, lesson, learner.cursor.step);
    let hit = (events & COLLISION) == COLLISION;
    learner.cursor.x = moved.x;
    learner.cursor.y = moved.y;
    learner.cursor.heading = moved.heading;
    learner.cursor.bumpers = moved.bumpers;
    learner.cursor.masked = if hit && settings.mask_blocked == 1 { child } else { NO_ACTION };
    learner.cursor.step += 1;
    learner.cursor.actions += 1;
    learner.cursor.reward += reward;
    learner.cursor.collisions += u32::from(hit);
    let achieved = (events & skill.ends) != 0;
    if achieved || learner.cursor.step >= settings.max_steps {
        let end = if achieved { ENDED } else { CUT };
        stream.step = learner.cursor.step;
        let last = roll(stream);
        observe(learner.shared, scratch, &last, moved.x, moved.y, moved.heading, moved.bumpers, terms);
        note(&mut scratch.record, NO_ACTION, learner.cursor.masked, 0, 0.0);
        write_record(learner.lessons, &scratch.record, lesson, learner.cursor.step);
        let (steps, earned, hits) = (learner.cursor.step, learner.cursor.reward, learner.cursor.collisions);
        write_header(learner.lessons, lesson, steps, end, earned, hits);
        let trial = learner.cursor.trial;
        write_row(learner.rows, learner.cursor, trial, steps, earned, end, hits, 0);
        learner.cursor.remembered += 1;
        learner.cursor.replay = 0;
        learner.cursor.phase = PHASE_REPLAY;
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
        learner.cursor.phase = PHASE_START;
    } else {
        if finished {
            let stream = Stream {
                key: [settings.run_seed, settings.learner_seed],
                skill: learner.cursor.skill,
                trial: learner.cursor.trial,
                step: begun,
                purpose: Purpose::Replay as u32,
            };
            let word = draw(stream, 0)[0];
            if begun < taught {
                let lesson = taught_lesson(learner, below(word, settings.lessons));
                begin_replay(learner, lesson, 1);
            } else {
                let lesson = recent_lesson(learner, word);
                begin_replay(learner, lesson, 0);
            }
        }
        replay_step(learner, scratch, base);
    }
}

/// Moves one learner on by at most `dispatch.quanta`. Its slices of the buffers begin at word 0.
#[inline(always)]
pub fn advance(learner: &mut Learner<'_>, dispatch: &Dispatch) {
    const { assert!(RECORD_WORDS >= 10, "word 9 of a record holds the reward") };
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
