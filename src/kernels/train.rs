//! Kernel `train`: moves a learner on by a number of iterations. An iteration is one trial step, one replayed
//! transition, or one change of phase.
//!
//! The learner is a state machine whose whole state is in its `LearnerState`, so it makes no difference how often it is
//! interrupted. Every lane keeps the same copy of the state.

use crate::env::observe::DRAW_CHOICE;
use crate::env::reset::{start_pose, start_region};
use crate::env::workgroup::Workgroup;
use crate::layout::{
    LearnerState, LessonHeader, NO_CHILD, PHASE_ACT, PHASE_DONE, PHASE_FAILED, PHASE_REPLAY, PHASE_START, PHASE_TEACH,
    TERMINATED, TRUNCATED,
};
use crate::learn::lesson::{LESSON_END, LESSON_STEPS};
use crate::math::rng::{Purpose, below, draw};
use std::mem::offset_of;

/// Word of a lesson that holds its reward.
const LESSON_REWARD: usize = offset_of!(LessonHeader, reward) / 4;
/// Word of a lesson that holds its collisions.
const LESSON_COLLISIONS: usize = offset_of!(LessonHeader, collisions) / 4;

impl Workgroup<'_> {
    /// Whether the learner is past the point at which this dispatch stops.
    fn stopped(&self) -> bool {
        let beyond = self.state.skill > self.dispatch.stop_skill && self.state.phase <= PHASE_START;
        let reached = self.state.skill == self.dispatch.stop_skill
            && self.state.phase == PHASE_START
            && self.state.trial >= self.dispatch.stop_trial;
        beyond || reached || self.state.phase >= PHASE_DONE
    }

    /// Waits for the next trial, unless a weight is spoiled.
    fn conclude(&mut self) {
        self.release_weights();
        // What the last update spoiled is replayed too late: tests come first, and the next skill builds on it.
        self.state.phase = if self.weights_are_finite() { PHASE_START } else { PHASE_FAILED };
    }

    /// Learns from the taught lessons, pass after pass, and lists them as trials.
    fn teach(&mut self) {
        let s = self.state.skill as usize;
        let begun = self.state.replay;
        let finished = self.state.replay_left == 0 && self.state.replay_open == 0;
        if finished && begun >= self.params[s].pretrain_epochs * self.params[s].lessons {
            self.conclude();
        } else {
            if finished {
                let number = begun % self.params[s].lessons;
                let lesson = self.taught_lesson(number);
                // Every other pass.
                self.begin_replay(lesson, 1, (begun / self.params[s].lessons) & 1);
                if begun < self.params[s].lessons {
                    let steps = self.lesson_word(LESSON_STEPS);
                    let end = self.lesson_word(LESSON_END);
                    let reward = f32::from_bits(self.lesson_word(LESSON_REWARD));
                    let collisions = self.lesson_word(LESSON_COLLISIONS);
                    self.state.actions += steps;
                    self.write_row(number, steps, reward, end, collisions, 1);
                }
            }
            self.hold_weights();
            self.replay_step();
        }
    }

    /// Begins the next trial, or the next skill after the last one.
    fn start(&mut self) {
        if self.state.trial >= self.params[self.state.skill as usize].trials {
            self.state.skill += 1;
            self.state.trial = 0;
            self.state.remembered = 0;
            self.state.replay = 0;
            self.state.phase = if self.state.skill < self.dispatch.skills { PHASE_TEACH } else { PHASE_DONE };
        } else {
            let skill = &self.skills[self.state.skill as usize];
            let words = draw(self.learner_stream(self.state.trial, 0, Purpose::Start), 0);
            let region = start_region(skill, words[0]) as usize;
            let pose = start_pose(self.tables, skill.start_offset[region], skill.start_count[region], words);
            self.reset(pose);
            self.state.phase = PHASE_ACT;
        }
    }

    /// Observes, and closes the trial where it is over, or else takes one step of it and records it.
    fn act(&mut self) {
        let root = self.state.skill;
        let s = root as usize;
        let words = self.skills[s].record_words as usize;
        let slot = self.state.remembered % self.params[s].replay_capacity;
        let lesson = (self.skills[s].memory_offset + slot * self.skills[s].lesson_stride) as usize;
        let step = self.agent.step;
        (self.forms.draw_step)(self, self.learner_stream(self.state.trial, step, Purpose::Step));
        self.observe_and_score(root);
        if step > 0 {
            self.write_outcome(words, lesson, step as usize - 1, self.agent.events, self.agent.earned);
        }
        let achieved = (self.skill_events(root) & self.skills[s].ends) != 0;
        self.value_children(root);
        self.q_values(root);
        let choices = self.action_mask(root, self.params[s].persist_training == 1);
        if achieved || step >= self.params[s].max_steps {
            let end = if achieved { TERMINATED } else { TRUNCATED };
            self.set_choice(NO_CHILD, choices);
            self.write_step(words, lesson, step as usize);
            self.write_header(lesson, step, end, self.agent.reward, self.agent.collisions);
            self.write_row(self.state.trial, step, self.agent.reward, end, self.agent.collisions, 0);
            self.state.remembered += 1;
            self.state.replay = 0;
            self.state.phase = PHASE_REPLAY;
        } else {
            let word = self.random.x[DRAW_CHOICE];
            let inverse_temperature = self.inverse_temperature(root, self.state.trial);
            let child = self.choose(root, choices.allowed, inverse_temperature, false, word);
            self.set_choice(child, choices);
            self.write_step(words, lesson, step as usize);
            self.commit(root, child, choices);
            let action = self.descend_to_action(root, child);
            self.apply_action(root, action);
            self.state.actions += 1;
        }
    }

    /// Replays one transition: taught lessons first, then remembered ones.
    fn replay(&mut self) {
        let s = self.state.skill as usize;
        let begun = self.state.replay;
        let taught = if self.params[s].lessons > 0 { self.params[s].taught_replays } else { 0 };
        let finished = self.state.replay_left == 0 && self.state.replay_open == 0;
        if finished && begun >= taught + self.params[s].replays {
            self.state.trial += 1;
            self.conclude();
        } else {
            if finished {
                let words = draw(self.learner_stream(self.state.trial, begun, Purpose::Replay), 0);
                let word = words[0];
                let mirrored = words[1] & 1;
                if begun < taught {
                    let lesson = self.taught_lesson(below(word, self.params[s].lessons));
                    self.begin_replay(lesson, 1, mirrored);
                } else {
                    let lesson = self.recent_lesson(word);
                    self.begin_replay(lesson, 0, mirrored);
                }
            }
            self.hold_weights();
            self.replay_step();
        }
    }

    /// Moves the learner on by at most `dispatch.iterations`.
    pub fn train(&mut self, states: &mut LearnerState) {
        self.state = *states;
        self.agent = self.state.agent;
        for _iteration in 0..self.dispatch.iterations {
            if self.stopped() {
                break;
            }
            if self.state.phase == PHASE_TEACH {
                self.teach();
            } else if self.state.phase == PHASE_START {
                self.start();
            } else if self.state.phase == PHASE_ACT {
                self.act();
            } else {
                self.replay();
            }
        }
        self.release_weights();
        self.state.agent = self.agent;
        *states = self.state;
    }
}
