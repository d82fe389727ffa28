//! What a skill over skills learns from a recorded trial: trials made up, replayed, and the targets read off.

use super::super::configs::{TREE, plan_with};
use super::super::learner::{Learner, lesson_words};
use super::super::nets64::Nets64;
use super::super::observations::{bumpers, readings};
use super::persistence::{Set, bits};
use bytemuck::Zeroable;
use skilltree::layout::{LANES, NO_CHILD, Observation, STEP_WORDS, Step};

/// A learning rate so small that no weight changes, and a power of two, so that what was learned can be read off the
/// optimiser's velocities.
const HARDLY: f32 = 1.0 / (1_u64 << 60) as f32;

/// One step of a trial.
#[derive(Debug, Clone)]
pub(super) struct Taken {
    pub(super) seen: Observation,
    /// The child that ran before.
    pub(super) running: u32,
    pub(super) child: u32,
    /// What a free choice would be made among.
    pub(super) choices: Set,
    /// Whether it was free. If not, only the child that runs was allowed.
    pub(super) free: bool,
    pub(super) reward: f32,
}

/// A recorded trial. The last observation has no child and no reward.
#[derive(Debug, Clone)]
pub(super) struct Trial {
    pub(super) steps: Vec<Taken>,
    pub(super) last: Taken,
    pub(super) end: u32,
}

impl Taken {
    pub(super) fn allowed(&self) -> Set {
        // After the last step the child that ran would go on.
        let own = if self.child == NO_CHILD { self.running } else { self.child };
        if self.free { self.choices.clone() } else { [own as usize].into() }
    }

    fn record(&self) -> Step {
        let free = u32::from(self.free) << 31;
        Step {
            observation: self.seen,
            choice: self.child | bits(&self.allowed()) << 8 | bits(&self.choices) << 16 | free,
            reward: self.reward,
            high_level: self.running,
            ..Step::zeroed()
        }
    }

    /// The nets' inputs, from the definitions: sonar-far, bumpers, running.
    pub(super) fn inputs(&self, children: u32) -> Vec<f64> {
        let sonar = readings(&self.seen).map(|reading| 2.0 * reading / 127.0 - 1.0);
        let running = (0..children).map(|child| f64::from(u8::from(self.running == child)));
        sonar.into_iter().chain(bumpers(&self.seen)).chain(running).collect()
    }
}

/// How a trial is learned from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Backup {
    Steps,
    Persistent,
    Decisions,
}

impl Backup {
    pub(super) const ALL: [Self; 3] = [Self::Steps, Self::Persistent, Self::Decisions];

    fn name(self) -> &'static str {
        ["steps", "persistent", "decisions"][self as usize]
    }
}

/// A learner that only learns the root, and has its velocities at 0.
pub(super) fn learner(backup: Backup, shared_net: bool) -> Learner {
    let own = [
        format!("skill.top.learning.backup={:?}", backup.name()),
        format!("skill.top.learning.shared_net={shared_net}"),
    ];
    let mut set: Vec<&str> = own.iter().map(String::as_str).collect();
    set.extend([
        "skill.top.learning.optimiser=sgd",
        "skill.top.learning.learning_rate=0.5",
        "skill.top.learning.momentum=0.0",
    ]);
    let mut learner = Learner::new(plan_with(TREE, &set));
    let root = learner.skill("top");
    let params = &mut learner.params[root];
    (params.learning_rate, params.learning_rate_fall, params.beta1) = (HARDLY, 0.0, 0.0);
    params.value_scale = 1.0 / 64.0;
    learner.state.skill = root as u32;
    learner
}

/// What one step of a replay taught: the child's new target, or nothing.
pub(super) type Taught = Option<f64>;

/// Replays a trial; what each of its steps taught, first step first.
#[track_caller]
pub(super) fn replay(learner: &mut Learner, trial: &Trial) -> Vec<Taught> {
    let root = learner.state.skill as usize;
    let skill = learner.shared.skills[root];
    assert_eq!(skill.record_words as usize, STEP_WORDS);
    let records: Vec<Step> = trial.steps.iter().chain([&trial.last]).map(Taken::record).collect();
    let words = lesson_words(&skill, trial.end, &records);
    let lesson = skill.memory_offset;
    learner.lessons[lesson as usize..][..words.len()].copy_from_slice(&words);
    let before = learner.nets.clone();
    let mut found = learner.act(|group| {
        group.begin_replay(lesson, 0, 0);
        let mut found = Vec::new();
        for step in trial.steps.iter().rev() {
            let child = step.child as usize;
            let net = if skill.nets == 1 { 0 } else { child };
            // The velocity of the output bias, which stands in the last row.
            let at = skill.net_offset(net as u32) + (2 * skill.rows as usize - 1) * LANES + child - net;
            group.nets.trained()[at] = 0.0;
            let updates = group.state.updates;
            if group.state.replay_open == 1 {
                group.replay_step();
                assert_eq!(group.state.updates, updates, "nothing is done after the last step");
            }
            group.replay_step();
            let learned = group.state.updates - updates;
            // The slope of the output bias: the target's distance times the slope of the output.
            let slope = f64::from(group.nets[at]) / f64::from(HARDLY);
            let q = f64::from(group.q[child]);
            found.push((learned == 1).then(|| q + slope / (1.0 - q * q)));
            assert!(learned == 1 || slope == 0.0);
        }
        assert_eq!((group.state.replay_left, group.state.replay_open), (0, 0));
        found
    });
    // No weight has moved, so every target was made from the same values.
    let weights = |nets: &[f32]| Nets64::of(nets, &skill).nets;
    for (now, then) in weights(&learner.nets).iter().flatten().zip(weights(&before).iter().flatten()) {
        assert!((now - then).abs() < 1.0e-15);
    }
    found.reverse();
    found
}
