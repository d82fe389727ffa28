//! Who chooses how in a test: the root greedily and by the rules, the skills below it by their odds, baselines at random
//! or in order.

use super::super::configs::{SILENT, TREE, plan_with};
use super::super::learner::{FORMS, Learner};
use super::super::nets64::{Tree64, most};
use super::super::random::random;
use super::persistence::{Choice, Chooser, Rules, Set, members};
use bytemuck::Zeroable;
use glam::Vec2;
use skilltree::backend::cpu::CPU;
use skilltree::config::plan::{Child, Threshold};
use skilltree::env::workgroup::{HotForms, Nets, Workgroup};
use skilltree::layout::{Agent, Dispatch, EPISODE_RUNNING, Episode, NO_CHILD, Step};
use skilltree::math::rng::Stream;
use skilltree::world::Pose;
use std::collections::BTreeMap;

impl Learner {
    fn tree(&self) -> Tree64<'_> {
        let rooms = self.plan.world().rooms.len();
        Tree64::new(&self.plan.arms[0].skills, rooms, &self.shared.skills, &self.nets)
    }

    fn pose(&self, next: &mut impl FnMut() -> f64) -> Pose {
        let world = self.plan.world();
        loop {
            let at = Vec2::new(next() as f32 * world.size.x, next() as f32 * world.size.y);
            let heading = (next() * 360.0) as f32;
            if world.is_free(at) && world.room_of(at).is_some() {
                return Pose { x: at.x, y: at.y, heading };
            }
        }
    }

    fn root(&self) -> usize {
        self.shared.skills.len() - 1
    }

    /// A test of the root that is about to take its first step from a pose.
    fn begun(&self, pose: Pose) -> Episode {
        let agent = self.seen(|group| {
            group.reset(pose);
            group.agent
        });
        Episode { state: EPISODE_RUNNING, agent, ..Episode::zeroed() }
    }

    /// One more step of a test.
    fn step(&self, forms: &HotForms, episode: &mut Episode, number: u32) {
        let dispatch = Dispatch { iterations: 1, test_skill: self.root() as u32, test_number: 7, ..Dispatch::zeroed() };
        let nets = Nets::Read(&self.nets);
        Workgroup { dispatch, nets, ..Workgroup::new(&self.shared, &self.params, forms) }.evaluate(episode, number);
    }

    /// What a robot without noise senses, whatever the random.
    fn look(&self, agent: &Agent) -> Step {
        self.seen(|group| {
            group.agent = *agent;
            let stream = Stream { key: [0, 0], skill: 0, trial: 0, step: 0, purpose: 0 };
            (group.forms.draw_step)(group, stream);
            group.observe_and_score(self.root() as u32);
            group.record
        })
    }

    /// Children of a skill whose worth exceeds their threshold, or none where that is too close to tell.
    fn applicable(&self, skill: usize, worths: &[f64]) -> Option<Set> {
        let mut set = Set::new();
        for (child, threshold) in self.plan.arms[0].skills[skill].applicable.iter().enumerate() {
            let least = match threshold {
                Some(Threshold::Fixed(least)) => f64::from(*least),
                _ => -2.0,
            };
            if (worths[child] - least).abs() < 1.0e-4 {
                return None;
            }
            if worths[child] > least {
                set.insert(child);
            }
        }
        Some(set)
    }
}

/// Odds of a Boltzmann choice.
fn odds(values: &[f64], inverse_temperature: f64) -> Vec<f64> {
    let total: f64 = values.iter().map(|q| (inverse_temperature * q).exp()).sum();
    values.iter().map(|q| (inverse_temperature * q).exp() / total).collect()
}

/// Counts against probabilities: within five standard deviations each.
fn close(what: &str, counts: &BTreeMap<Vec<usize>, u32>, expected: &BTreeMap<Vec<usize>, f64>, draws: u32) {
    assert!(counts.keys().all(|key| expected.contains_key(key)), "{what}: {counts:?} for {expected:?}");
    for (key, p) in expected {
        let found = f64::from(counts.get(key).copied().unwrap_or(0));
        let mean = p * f64::from(draws);
        let gap = 5.0 * (mean * (1.0 - p)).sqrt() + 2.0;
        assert!((found - mean).abs() < gap, "{what}: {key:?} {found} times, {mean} expected");
    }
}

/// The greatest of a set's values, or none where another one is too close.
fn greedy(values: &[f64], among: &Set) -> Option<usize> {
    let best = most(among.iter().map(|child| values[*child]));
    let close: Vec<usize> = among.iter().copied().filter(|child| best - values[*child] < 1.0e-4).collect();
    (close.len() == 1).then(|| close[0])
}

#[test]
fn the_root_is_greedy_and_its_children_are_not() {
    let mut next = random(51);
    let mut first = BTreeMap::<usize, u32>::new();
    for heat in ["0.0", "2.5", "30.0"] {
        let set = format!("skill.top.learning.child_inverse_temperature={heat}");
        let learner = Learner::new(plan_with(TREE, &[SILENT, &set]));
        let (tree, root) = (learner.tree(), learner.skill("top"));
        for _ in 0..8 {
            let pose = learner.pose(&mut next);
            let mut record = learner.look(&learner.begun(pose).agent);
            // Nothing runs yet.
            record.high_level = NO_CHILD;
            let values = tree.values(root, &record);
            let Some(applicable) = learner.applicable(root, &tree.worths(root, &record)) else { continue };
            let Some(best) = greedy(&values, &applicable) else { continue };
            *first.entry(best).or_default() += 1;
            let below = match learner.plan.arms[0].skills[root].children[best] {
                Child::Skill(below) => below,
                Child::Action(_) => panic!("a root over skills"),
            };
            let own = tree.values(below, &record);
            let expected = odds(&own, heat.parse().expect("a number"));
            let codes = learner.shared.skills[below].child;
            let expected = expected.iter().enumerate().map(|(child, p)| (vec![best, codes[child] as usize], *p));
            let mut counts = BTreeMap::new();
            let draws = 3000;
            for number in 0..draws {
                let mut episode = learner.begun(pose);
                learner.step(&CPU.hot, &mut episode, number);
                let agent = &episode.agent;
                let taken = vec![(agent.run[root] & 0xff) as usize, agent.action as usize];
                assert_eq!(learner.shared.skills[below].child[(agent.run[below] & 0xff) as usize], agent.action);
                *counts.entry(taken).or_default() += 1;
            }
            close(&format!("1/T {heat} at {pose:?}"), &counts, &expected.collect(), draws);
        }
    }
    assert!(first.len() >= 3 && first.values().sum::<u32>() > 18, "{first:?}");
}

/// Three levels: what the middle one and the lowest one draw has nothing to do with one another.
const DEEP: &str = r#"
    [skill.leave]
    children = ["door", "right", "dock"]
    inputs = ["sonar-far", "running"]
    reward = { passed-door = 100 }
    [skill.home]
    children = ["leave", "left"]
    inputs = ["bumpers"]
    reward = { docked = 100 }
    goal = ["docked"]
"#;

#[test]
fn every_level_draws_for_itself() {
    let mut next = random(52);
    let text = format!("{TREE}{DEEP}");
    for (heat, choice) in [("0.0", "learned"), ("3.0", "learned"), ("3.0", "random"), ("3.0", "fixed-priority")] {
        let set = [
            SILENT.to_owned(),
            "root=home".to_owned(),
            format!("skill.home.learning.child_inverse_temperature={heat}"),
            format!("skill.leave.policy={choice}"),
            // The root's own order decides: it always takes `leave`.
            "skill.home.policy=fixed-priority".to_owned(),
        ];
        let learner = Learner::new(plan_with(&text, &set.each_ref().map(String::as_str)));
        let (tree, home, leave) = (learner.tree(), learner.skill("home"), learner.skill("leave"));
        for _ in 0..4 {
            let pose = learner.pose(&mut next);
            let mut record = learner.look(&learner.begun(pose).agent);
            record.high_level = NO_CHILD;
            let heat: f64 = heat.parse().expect("a number");
            let middle = match choice {
                "learned" => odds(&tree.values(leave, &record), heat),
                "random" => vec![1.0 / 3.0; 3],
                _ => vec![1.0, 0.0, 0.0],
            };
            let mut expected = BTreeMap::new();
            for (child, name) in ["door", "right", "dock"].into_iter().enumerate() {
                let below = learner.skill(name);
                for (number, p) in odds(&tree.values(below, &record), heat).into_iter().enumerate() {
                    let code = learner.shared.skills[below].child[number] as usize;
                    expected.insert(vec![child, code], middle[child] * p);
                }
            }
            let (mut counts, draws) = (BTreeMap::new(), 5000);
            for number in 0..draws {
                let mut episode = learner.begun(pose);
                learner.step(&CPU.hot, &mut episode, number);
                let agent = &episode.agent;
                assert_eq!(agent.run[home] & 0xff, 0);
                let chosen = (agent.run[leave] & 0xff) as usize;
                *counts.entry(vec![chosen, agent.action as usize]).or_default() += 1;
                // Who was not asked does not run.
                for (child, name) in ["door", "right", "dock"].into_iter().enumerate() {
                    assert_eq!(agent.run[learner.skill(name)] == NO_CHILD, child != chosen);
                }
                assert_eq!(agent.run[learner.skill("left")], NO_CHILD);
            }
            close(&format!("{choice} {heat} {pose:?}"), &counts, &expected, draws);
        }
    }
}

/// Baselines at the root, in tests: uniformly among the applicable ones, or the first of them.
#[test]
fn baselines_choose_among_what_is_applicable() {
    let mut next = random(53);
    let mut sizes = Set::new();
    for choice in ["random", "fixed-priority"] {
        let set = format!("skill.top.policy={choice}");
        let learner = Learner::new(plan_with(TREE, &[SILENT, &set]));
        let (tree, root) = (learner.tree(), learner.skill("top"));
        for _ in 0..25 {
            let pose = learner.pose(&mut next);
            let record = learner.look(&learner.begun(pose).agent);
            let Some(applicable) = learner.applicable(root, &tree.worths(root, &record)) else { continue };
            sizes.insert(applicable.len());
            let (mut counts, draws) = (BTreeMap::new(), 1500);
            for number in 0..draws {
                let mut episode = learner.begun(pose);
                learner.step(&CPU.hot, &mut episode, number);
                *counts.entry(vec![(episode.agent.run[root] & 0xff) as usize]).or_default() += 1;
            }
            let first = applicable.first().copied();
            let share = |child: &usize| match choice {
                "random" => 1.0 / applicable.len() as f64,
                _ => f64::from(u8::from(Some(*child) == first)),
            };
            let expected = applicable.iter().map(|child| (vec![*child], share(child))).collect();
            close(&format!("{choice} {pose:?}"), &counts, &expected, draws);
        }
    }
    assert!(sizes.len() >= 2, "{sizes:?}");
}

/// Whole tests, step by step, against the rules and values in f64.
#[test]
fn tests_follow_the_rules_step_by_step() {
    let mut next = random(54);
    let ways = [
        &["skill.top.persistence=true", "skill.top.interrupt=true"][..],
        &["skill.top.persistence=true", "skill.top.interrupt=false", "skill.top.child_timeout=7"],
        &["skill.top.persistence=training"],
        &["skill.top.persistence=true", "skill.top.applicability=false", "skill.top.child_timeout=0"],
    ];
    for way in ways {
        // The children see enough to wander, and the root changes its mind.
        let set = [&[SILENT, "skill.top.learning.child_inverse_temperature=2.0"], way].concat();
        let learner = Learner::new(plan_with(TREE, &set));
        let (tree, root) = (learner.tree(), learner.skill("top"));
        let own = &learner.plan.arms[0].skills[root];
        let goal = |child: &Child| match child {
            Child::Skill(below) => Choice::Skill(members(learner.plan.arms[0].skills[*below].goal)),
            Child::Action(action) => Choice::Action(*action as u32),
        };
        let rules = Rules {
            persist: own.params.persist_tests == 1,
            applicability: own.params.applicability == 1,
            interrupt: own.params.interrupt == 1,
            patience: (own.params.child_timeout > 0).then_some(own.params.child_timeout),
        };
        let (mut held, mut free, mut changes) = (0, 0, 0);
        for number in 0..60 {
            let choices = own.children.iter().map(goal).collect();
            let mut chooser = Chooser { choices, rules, running: None, before: Set::new() };
            let mut episode = learner.begun(learner.pose(&mut next));
            for _step in 0..60 {
                let mut record = learner.look(&episode.agent);
                record.high_level = chooser.running.map_or(NO_CHILD, |(child, _)| child as u32);
                let happened = members(episode.agent.events);
                let Some(applicable) = learner.applicable(root, &tree.worths(root, &record)) else { break };
                let reasons = chooser.reasons(&applicable, &happened);
                let best = greedy(&tree.values(root, &record), &chooser.candidates(&applicable, None));
                let before = episode.agent.step;
                let [plain, tuned] = FORMS.map(|forms| {
                    let mut after = episode;
                    learner.step(forms, &mut after, number);
                    after
                });
                assert_eq!(plain, tuned);
                episode = plain;
                if episode.agent.step == before {
                    break;
                }
                let taken = (episode.agent.run[root] & 0xff) as usize;
                let running = chooser.running.map(|(child, _)| child);
                let expected = if reasons.is_empty() { running } else { best };
                // Two values too close to tell: either may be the greatest.
                let expected = expected.unwrap_or(taken);
                assert_eq!(taken, expected, "{way:?} {number}: {chooser:?} {applicable:?} {happened:?} {reasons:?}");
                held += u32::from(reasons.is_empty());
                free += u32::from(!reasons.is_empty());
                changes += u32::from(running.is_some_and(|running| running != taken));
                chooser.take(taken, !reasons.is_empty(), applicable);
            }
        }
        println!("{way:?}: {held} {free} {changes}");
        assert!(free > 150 && changes > 20 && (held > 300) == rules.persist, "{way:?}: {held} {free} {changes}");
    }
}
