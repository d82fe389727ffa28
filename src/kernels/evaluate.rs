//! Kernel `evaluate`: moves a greedy test trial on by a number of steps. The nets are read only.
//!
//! Every test of a learner begins from the same starts; the noise differs from test to test.

use crate::env::observe::DRAW_CHOICE;
use crate::env::reset::start_pose;
use crate::env::workgroup::Workgroup;
use crate::layout::{EPISODE_FRESH, EPISODE_RUNNING, EPISODE_TERMINATED, EPISODE_TRUNCATED, Episode};
use crate::math::rng::{Purpose, Stream, draw};

impl Workgroup<'_> {
    /// A stream of the random numbers of a test.
    fn test_stream(&self, skill: u32, number: u32, step: u32, purpose: Purpose) -> Stream {
        let s = self.dispatch.test_skill as usize;
        let key = [self.params[s].run_seed, self.params[s].learner_seed];
        Stream { key, skill, trial: number, step, purpose: purpose as u32 }
    }

    /// Puts the robot at the start of test trial `number`.
    fn begin(&mut self, episode: &mut Episode, number: u32) {
        let skill = self.dispatch.test_skill as usize;
        let words = draw(self.test_stream(skill as u32, number, 0, Purpose::TestStart), 0);
        let pose = start_pose(self.tables, self.skills[skill].tests_offset, self.skills[skill].tests_count, words);
        self.reset(pose);
        episode.state = EPISODE_RUNNING;
        episode.start_x = pose.x;
        episode.start_y = pose.y;
    }

    /// Moves test trial `number` of the learner on by at most `dispatch.iterations` steps.
    pub fn evaluate(&mut self, episodes: &mut Episode, number: u32) {
        let mut episode = *episodes;
        self.agent = episode.agent;
        let root = self.dispatch.test_skill;
        let s = root as usize;
        if episode.state == EPISODE_FRESH {
            self.begin(&mut episode, number);
        }
        for _iteration in 0..self.dispatch.iterations {
            if episode.state != EPISODE_RUNNING {
                break;
            }
            let stream =
                self.test_stream(root | (self.dispatch.test_number << 8), number, self.agent.step, Purpose::Test);
            (self.forms.draw_step)(self, stream);
            self.observe_and_score(root);
            let achieved = (self.skill_events(root) & self.skills[s].ends) != 0;
            if achieved || self.agent.step >= self.params[s].max_steps {
                episode.state = if achieved { EPISODE_TERMINATED } else { EPISODE_TRUNCATED };
            } else {
                self.value_children(root);
                self.q_values(root);
                let choices = self.action_mask(root, self.params[s].persist_tests == 1);
                let child = self.choose(root, choices.allowed, 1.0, true, self.random.x[DRAW_CHOICE]);
                self.commit(root, child, choices);
                let action = self.descend_to_action(root, child);
                self.apply_action(root, action);
            }
        }
        episode.agent = self.agent;
        *episodes = episode;
    }
}
