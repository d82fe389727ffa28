//! Backward replay with TD(lambda) (paper, section I).
//!
//! From the last step to the first: u_t = r_t + gamma [(1 - lambda) max_k Q(x_{t+1}, k) + lambda u_{t+1}], the
//! bracket 0 at a goal. A step whose action the current policy would hardly take is not learned, and cuts
//! the chain: there max Q stands for u. The form is recalled from Lin's other papers, so it is our choice.
//!
//! A skill over skills may learn at its decisions only: between them rewards are summed with their discount, and
//! lambda mixes at decisions.

use crate::env::workgroup::{Learner, Scratch};
pub use crate::layout::choices::{BACKUP_DECISIONS, BACKUP_STEPS};
use crate::layout::phase::PHASE_FAILED;
use crate::layout::{LANES, LESSON_HEADER, SkillShape};
use crate::learn::lesson::CUT;
use crate::math::functions::{exponential, is_number, ln};
use crate::math::reduce::lanes_or;
use crate::math::rng::{Purpose, Stream, below, draw, unit};
use crate::policy::features::encode;
use crate::policy::select::{inverse_temperature, weigh};
use crate::qnet::backward::{backward, learning_rate};
use crate::qnet::forward::{forward, net_of};

/// Word of the bank at which the learner's taught lesson `number` stands: one lesson drawn from each of
/// `lessons` equal strata of the bank.
#[inline(always)]
pub fn taught_lesson(learner: &Learner<'_>, number: u32) -> u32 {
    let params = &learner.params[learner.state.skill as usize];
    let skill = &learner.shared.skills[learner.state.skill as usize];
    let stream = Stream {
        key: [params.run_seed, params.learner_seed],
        skill: learner.state.skill,
        trial: number,
        step: 0,
        purpose: Purpose::Lesson as u32,
    };
    let stratum = skill.bank_lessons / params.lessons;
    let index = number * stratum + below(draw(stream, 0)[0], stratum);
    skill.bank_offset + index * skill.lesson_stride
}

/// Word of the memory at which a remembered lesson stands, its age drawn from an exponential
/// distribution of mean `replay_mean_age`, cut off at the oldest.
#[inline(always)]
pub fn recent_lesson(learner: &Learner<'_>, word: u32) -> u32 {
    let params = &learner.params[learner.state.skill as usize];
    let skill = &learner.shared.skills[learner.state.skill as usize];
    let kept = if learner.state.remembered < params.replay_capacity {
        learner.state.remembered
    } else {
        params.replay_capacity
    };
    // The host sends the negative inverse of the mean age: kernels do not divide.
    let whole = 1.0 - exponential(params.replay_age_decay * kept as f32);
    let depth = -ln(1.0 - unit(word) * whole) * params.replay_mean_age;
    let drawn = depth as u32;
    let age = if drawn < kept { drawn } else { kept - 1 };
    let slot = (learner.state.remembered - 1 - age) % params.replay_capacity;
    skill.memory_offset + slot * skill.lesson_stride
}

/// One word of the lesson in replay.
#[inline(always)]
pub fn lesson_word(learner: &Learner<'_>, offset: u32) -> u32 {
    let at = (learner.state.replay_lesson + offset) as usize;
    if learner.state.replay_taught == 1 { learner.shared.bank[at] } else { learner.lessons[at] }
}

/// Opens the replay of the lesson at word `lesson` of the bank (`taught` 1) or of the memory; `mirrored` 1 for what
/// would have happened to the mirror image of the robot in the mirror image of the world.
#[inline(always)]
pub fn begin_replay(learner: &mut Learner<'_>, lesson: u32, taught: u32, mirrored: u32) {
    let params = &learner.params[learner.state.skill as usize];
    learner.state.replay_lesson = lesson;
    learner.state.replay_taught = taught;
    learner.state.replay_mirrored = mirrored * params.mirror_replays;
    let steps = lesson_word(learner, 0);
    let end = lesson_word(learner, 1);
    learner.state.replay += 1;
    learner.state.replay_left = steps;
    learner.state.replay_open = u32::from(end == CUT && params.timeout_terminal == 0);
    learner.state.next_best = 0.0;
    learner.state.next_return = 0.0;
}

/// Fetches step `step` of the lesson in replay into the record.
#[inline(always)]
pub fn load_record(learner: &Learner<'_>, scratch: &mut Scratch, step: u32) {
    let words = learner.shared.skills[learner.state.skill as usize].record_words;
    let offset = LESSON_HEADER as u32 + step * words;
    let at = (learner.state.replay_lesson + offset) as usize;
    let source: &[u32] = if learner.state.replay_taught == 1 { &learner.shared.bank } else { learner.lessons };
    scratch.record[..words as usize].copy_from_slice(&source[at..at + words as usize]);
}

/// A set of children, or that of their mirror images.
#[inline(always)]
pub fn reflected(skill: &SkillShape, children: u32, mirrored: bool) -> u32 {
    let mut bits = 0;
    for child in 0..skill.children {
        let image = if mirrored { skill.mirror_child[child as usize] } else { child };
        bits |= ((children >> child) & 1) << image;
    }
    bits
}

/// A target inside the range that a net can give.
#[inline(always)]
pub fn bounded(aim: f32, limit: f32) -> f32 {
    let low = if aim > -limit { aim } else { -limit };
    if low < limit { low } else { limit }
}

/// Whether a step between two decisions is learned from too.
#[inline(always)]
pub fn inner_drawn(learner: &Learner<'_>, step: u32) -> bool {
    let params = &learner.params[learner.state.skill as usize];
    let stream = Stream {
        key: [params.run_seed, params.learner_seed],
        skill: learner.state.skill,
        trial: learner.state.trial,
        step: learner.state.replay,
        purpose: Purpose::Inner as u32,
    };
    unit(draw(stream, step)[0]) < params.intra_skill_share
}

/// What the Q-value of the step at word `at` of the lesson in replay should be, given what follows it.
#[inline(always)]
pub fn aimed(learner: &Learner<'_>, at: u32) -> f32 {
    let params = &learner.params[learner.state.skill as usize];
    let reward = f32::from_bits(lesson_word(learner, at + 9)) * params.value_scale;
    let future = (1.0 - params.lambda) * learner.state.next_best + params.lambda * learner.state.next_return;
    bounded(reward + params.gamma * future, params.target_clip)
}

/// Learns from the next step of the lesson in replay, last step first.
#[inline(always)]
pub fn replay_step(learner: &mut Learner<'_>, scratch: &mut Scratch, base: u32) {
    let params = &learner.params[learner.state.skill as usize];
    let skill = &learner.shared.skills[learner.state.skill as usize];
    let open = learner.state.replay_open == 1;
    let step = if open { learner.state.replay_left } else { learner.state.replay_left - 1 };
    let at = LESSON_HEADER as u32 + step * skill.record_words;
    let marks = lesson_word(learner, at + 8);
    let aim = aimed(learner, at);
    let inner = params.backup == BACKUP_DECISIONS && (marks >> 31) == 0 && !open;
    if inner && !inner_drawn(learner, step) {
        learner.state.next_best = aim;
        learner.state.next_return = aim;
        learner.state.replay_left = step;
    } else {
        let mirrored = learner.state.replay_mirrored == 1;
        let done = marks & 0xff;
        let choices = (marks >> 16) & 0xff;
        let offered = if params.backup == BACKUP_STEPS { choices } else { (marks >> 8) & 0xff };
        let allowed = reflected(skill, offered, mirrored);
        load_record(learner, scratch, step);
        encode(learner.shared, scratch, skill, mirrored);
        forward(learner.nets, scratch, skill, params, base);
        let outlook = weigh(scratch, skill.children, allowed, inverse_temperature(params, learner.state.trial));
        if open {
            learner.state.replay_open = 0;
            learner.state.next_best = outlook.best;
            learner.state.next_return = outlook.best;
        } else {
            let child = if mirrored { skill.mirror_child[done as usize] } else { done };
            let taught = params.taught_as_policy == 1 && learner.state.replay_taught == 1;
            let policy = taught || scratch.odds[child as usize] > params.policy_threshold * outlook.total;
            let stretched = outlook.best + params.advantage_scale * (aim - outlook.best);
            let plain = params.advantage_scale == 1.0;
            let goal = if plain { aim } else { bounded(stretched, params.target_clip) };
            let delta = goal - scratch.q[child as usize];
            // Of all children: one that is never chosen again would not be found out otherwise.
            let mut sound = is_number(delta);
            for other in 0..skill.children as usize {
                sound = sound && is_number(scratch.q[other]);
            }
            if !sound {
                // The place in the lesson stays: by it the transition is found.
                learner.state.phase = PHASE_FAILED;
            } else {
                if policy {
                    let pace = learning_rate(params, learner.state.trial);
                    backward(learner.nets, scratch, skill, params, base, child, delta, pace);
                    learner.state.updates += 1;
                }
                learner.state.next_best = if inner { aim } else { outlook.best };
                learner.state.next_return = if policy || inner { aim } else { outlook.best };
                learner.state.replay_left = step;
            }
        }
    }
}

/// Whether all weights of the skill in training are numbers.
#[inline(always)]
pub fn sound_weights(learner: &Learner<'_>, base: u32) -> bool {
    let skill = &learner.shared.skills[learner.state.skill as usize];
    let mut wild = [0; LANES];
    for number in 0..skill.nets {
        let net = net_of(skill, base, number) as usize;
        for row in 0..skill.rows as usize {
            for lane in 0..LANES {
                wild[lane] |= u32::from(!is_number(learner.nets[net + row * LANES + lane]));
            }
        }
    }
    lanes_or(&wild) == 0
}
