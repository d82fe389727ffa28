//! Backward replay with TD(lambda) (paper, section I).
//!
//! From the last step to the first: u_t = r_t + gamma [(1 - lambda) max_k Q(x_{t+1}, k) + lambda u_{t+1}], the
//! bracket 0 at a goal. A step whose action the current policy would hardly take is not learned, and cuts
//! the chain: there max Q stands for u. The form is recalled from Lin's other papers, so it is our choice.
//!
//! A skill over skills may learn at its decisions only: between them rewards are summed with their discount, and
//! lambda mixes at decisions.

use super::lesson::{
    LESSON_END, LESSON_STEPS, STEP_CHOICE, STEP_REWARD, choice_allowed, choice_child, choice_is_free, choice_offered,
};
use crate::env::workgroup::Workgroup;
use crate::layout::choices::{BACKUP_DECISIONS, BACKUP_STEPS};
use crate::layout::{LANES, LESSON_HEADER_WORDS, PHASE_FAILED, SkillShape, TRUNCATED};
use crate::math::functions::{exponential, is_number, ln};
use crate::math::reduce::lanes_or;
use crate::math::rng::{Purpose, Stream, below, draw, unit};

/// A target inside the range that a net can give.
#[inline(always)]
pub fn clip(target_value: f32, limit: f32) -> f32 {
    let low = if target_value > -limit { target_value } else { -limit };
    if low < limit { low } else { limit }
}

/// A set of a skill's children, or that of their mirror images.
pub fn mirror_mask(skill: &SkillShape, children: u32, mirrored: bool) -> u32 {
    let mut bits = 0;
    for child in 0..skill.children {
        let image = if mirrored { skill.mirror_child[child as usize] } else { child };
        bits |= ((children >> child) & 1) << image;
    }
    bits
}

impl Workgroup<'_> {
    /// A stream of the learner's random numbers for the skill in training.
    pub fn learner_stream(&self, trial: u32, step: u32, purpose: Purpose) -> Stream {
        let s = self.state.skill as usize;
        let key = [self.params[s].run_seed, self.params[s].learner_seed];
        Stream { key, skill: self.state.skill, trial, step, purpose: purpose as u32 }
    }

    /// Word of the bank at which the learner's taught lesson `number` stands: one lesson drawn from each of
    /// `lessons` equal strata of the bank.
    pub fn taught_lesson(&self, number: u32) -> u32 {
        let skill = self.state.skill as usize;
        let stratum = self.skills[skill].bank_lessons / self.params[skill].lessons;
        let word = draw(self.learner_stream(number, 0, Purpose::Lesson), 0)[0];
        let index = number * stratum + below(word, stratum);
        self.skills[skill].bank_offset + index * self.skills[skill].lesson_stride
    }

    /// Word of the memory at which a remembered lesson stands, its age drawn from an exponential
    /// distribution of mean `replay_mean_age`, cut off at the oldest.
    pub fn recent_lesson(&self, word: u32) -> u32 {
        let skill = self.state.skill as usize;
        let s = skill;
        let kept = if self.state.remembered < self.params[s].replay_capacity {
            self.state.remembered
        } else {
            self.params[s].replay_capacity
        };
        // The host sends the negative inverse of the mean age: kernels do not divide.
        let whole = 1.0 - exponential(self.params[s].replay_age_decay * kept as f32);
        let depth = -ln(1.0 - unit(word) * whole) * self.params[s].replay_mean_age;
        let drawn = depth as u32;
        let age = if drawn < kept { drawn } else { kept - 1 };
        let slot = (self.state.remembered - 1 - age) % self.params[s].replay_capacity;
        self.skills[skill].memory_offset + slot * self.skills[skill].lesson_stride
    }

    /// One word of the lesson in replay.
    pub fn lesson_word(&self, offset: usize) -> u32 {
        let at = self.state.replay_lesson as usize + offset;
        if self.state.replay_taught == 1 {
            return self.bank[at];
        }
        self.lessons[at]
    }

    /// Opens the replay of the lesson at word `lesson` of the bank (`taught` 1) or of the memory; `mirrored` 1 for what
    /// would have happened to the mirror image of the robot in the mirror image of the world.
    pub fn begin_replay(&mut self, lesson: u32, taught: u32, mirrored: u32) {
        let s = self.state.skill as usize;
        self.state.replay_lesson = lesson;
        self.state.replay_taught = taught;
        self.state.replay_mirrored = mirrored * self.params[s].mirror_replays;
        let steps = self.lesson_word(LESSON_STEPS);
        let end = self.lesson_word(LESSON_END);
        self.state.replay += 1;
        self.state.replay_left = steps;
        self.state.replay_open = u32::from(end == TRUNCATED && self.params[s].timeout_terminal == 0);
        self.state.next_best = 0.0;
        self.state.next_return = 0.0;
    }

    /// Fetches step `step` of the lesson in replay into the record.
    pub fn load_step(&mut self, step: usize) {
        let words = self.skills[self.state.skill as usize].record_words as usize;
        let at = LESSON_HEADER_WORDS + step * words;
        let lesson = self.state.replay_lesson as usize;
        let source = if self.state.replay_taught == 1 { self.bank } else { &*self.lessons };
        bytemuck::cast_slice_mut(std::slice::from_mut(&mut self.record))[..words]
            .copy_from_slice(&source[lesson + at..lesson + at + words]);
    }

    /// Whether a step between two decisions is learned from too.
    pub fn learn_between_decisions(&self, step: u32) -> bool {
        let word = draw(self.learner_stream(self.state.trial, self.state.replay, Purpose::Inner), step)[0];
        unit(word) < self.params[self.state.skill as usize].intra_skill_share
    }

    /// What the Q-value of the step at word `at` of the lesson in replay should be, given what follows it.
    pub fn td_target(&self, at: usize) -> f32 {
        let s = self.state.skill as usize;
        let reward = f32::from_bits(self.lesson_word(at + STEP_REWARD)) * self.params[s].value_scale;
        let future =
            (1.0 - self.params[s].lambda) * self.state.next_best + self.params[s].lambda * self.state.next_return;
        clip(reward + self.params[s].gamma * future, self.params[s].target_clip)
    }

    /// Learns from the next step of the lesson in replay, last step first.
    pub fn replay_step(&mut self) {
        let skill = self.state.skill;
        let s = skill as usize;
        let open = self.state.replay_open == 1;
        let step = if open { self.state.replay_left } else { self.state.replay_left - 1 };
        let at = LESSON_HEADER_WORDS + (step * self.skills[s].record_words) as usize;
        let choice = self.lesson_word(at + STEP_CHOICE);
        let target_value = self.td_target(at);
        let inner = self.params[s].backup == BACKUP_DECISIONS && !choice_is_free(choice) && !open;
        if inner && !self.learn_between_decisions(step) {
            self.state.next_best = target_value;
            self.state.next_return = target_value;
            self.state.replay_left = step;
        } else {
            let mirrored = self.state.replay_mirrored == 1;
            let done = choice_child(choice);
            let available =
                if self.params[s].backup == BACKUP_STEPS { choice_offered(choice) } else { choice_allowed(choice) };
            let allowed = mirror_mask(&self.skills[s], available, mirrored);
            self.load_step(step as usize);
            (self.forms.encode)(self, skill, mirrored);
            (self.forms.forward)(self, skill);
            let inverse_temperature = self.inverse_temperature(skill, self.state.trial);
            let found = (self.forms.boltzmann)(self, self.skills[s].children, allowed, inverse_temperature);
            if open {
                self.state.replay_open = 0;
                self.state.next_best = found.best;
                self.state.next_return = found.best;
            } else {
                let child = if mirrored { self.skills[s].mirror_child[done as usize] } else { done };
                let taught = self.params[s].taught_as_policy == 1 && self.state.replay_taught == 1;
                let policy = taught || self.weights[child as usize] > self.params[s].policy_threshold * found.total;
                let stretched = found.best + self.params[s].advantage_scale * (target_value - found.best);
                let plain = self.params[s].advantage_scale == 1.0;
                let aim = if plain { target_value } else { clip(stretched, self.params[s].target_clip) };
                let delta = aim - self.q[child as usize];
                // Of all children: one that is never chosen again would not be found out otherwise.
                let mut sound = is_number(delta);
                for other in 0..self.skills[s].children as usize {
                    sound = sound && is_number(self.q[other]);
                }
                if !sound {
                    // The place in the lesson stays: by it the transition is found.
                    self.state.phase = PHASE_FAILED;
                } else {
                    if policy {
                        (self.forms.backward)(self, skill, child, delta, self.learning_rate(skill, self.state.trial));
                        self.state.updates += 1;
                    }
                    self.state.next_best = if inner { target_value } else { found.best };
                    self.state.next_return = if policy || inner { target_value } else { found.best };
                    self.state.replay_left = step;
                }
            }
        }
    }

    /// Whether all weights of the skill in training are numbers.
    pub fn weights_are_finite(&self) -> bool {
        let skill = self.state.skill as usize;
        let mut wild = [0; LANES];
        for number in 0..self.skills[skill].nets {
            let net = self.skills[skill].net_offset(number);
            for row in 0..self.skills[skill].rows as usize {
                for lane in 0..LANES {
                    wild[lane] |= u32::from(!is_number(self.nets[net + row * LANES + lane]));
                }
            }
        }
        lanes_or(&wild) == 0
    }
}
