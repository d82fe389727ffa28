//! Who chooses how in a test: the root greedily and by the rules, the skills below it by their odds, baselines at random
//! or in order.

use super::bench::{Bench, TREE, Tree64, most};
use super::oracle::stream;
use super::persistence::{Choice, Chooser, Rules, Set};
use bytemuck::Zeroable;
use glam::Vec2;
use skilltree::config::plan::{Child, Threshold};
use skilltree::env::workgroup::Scratch;
use skilltree::kernels::evaluate::{STATE_RUNNING, evaluate};
use skilltree::layout::{Agent, Dispatch, Episode, RECORD_WORDS};
use skilltree::math::rng::{Stream, draw_step};
use skilltree::policy::hierarchy::{place, sense};
use skilltree::policy::persistence::IDLE;
use skilltree::world::Pose;
use std::collections::BTreeMap;

const SILENT: &str = "robot.noise={ actuator = 0.0, sonar = 0.0, light = 0.0, compass = 0.0 }";

impl Bench {
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

    /// A test of the root that is about to take its first step from a pose.
    fn begun(&self, pose: Pose) -> Episode {
        let mut episode = Episode { state: STATE_RUNNING, ..Episode::zeroed() };
        place(&mut episode.agent, &self.shared, pose);
        episode
    }

    fn step(&self, episode: &mut Episode, number: u32) {
        let root = self.shared.skills.len() as u32 - 1;
        let dispatch = Dispatch { iterations: 1, test_skill: root, test_number: 7, ..Dispatch::zeroed() };
        evaluate(episode, &self.shared, &self.params, &self.nets, &dispatch, number);
    }

    /// What a robot without noise senses, whatever the random.
    fn look(&self, agent: &Agent) -> [u32; RECORD_WORDS] {
        let root = self.shared.skills.len() - 1;
        let (mut agent, mut scratch) = (*agent, Scratch::default());
        let random = draw_step(Stream { key: [0, 0], skill: 0, trial: 0, step: 0, purpose: 0 });
        sense(&mut agent, &self.shared, &mut scratch, &self.params[root], &random);
        scratch.record
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
    let mut next = stream(51);
    let mut first = BTreeMap::<usize, u32>::new();
    for heat in ["0.0", "2.5", "30.0"] {
        let set = format!("skill.top.learning.child_inverse_temperature={heat}");
        let bench = Bench::new(TREE, &[SILENT, &set]);
        let (tree, root) = (bench.tree(), bench.skill("top"));
        for _ in 0..8 {
            let pose = bench.pose(&mut next);
            let mut record = bench.look(&bench.begun(pose).agent);
            // Nothing runs yet.
            record[10] = 255;
            let values = tree.values(root, &record);
            let Some(applicable) = bench.applicable(root, &tree.worths(root, &record)) else { continue };
            let Some(best) = greedy(&values, &applicable) else { continue };
            *first.entry(best).or_default() += 1;
            let below = match bench.plan.arms[0].skills[root].children[best] {
                Child::Skill(below) => below,
                Child::Action(_) => panic!("a root over skills"),
            };
            let own = tree.values(below, &record);
            let expected = odds(&own, heat.parse().expect("a number"));
            let codes = bench.shared.skills[below].child;
            let expected = expected.iter().enumerate().map(|(child, p)| (vec![best, codes[child] as usize], *p));
            let mut counts = BTreeMap::new();
            let draws = 3000;
            for number in 0..draws {
                let mut episode = bench.begun(pose);
                bench.step(&mut episode, number);
                let agent = &episode.agent;
                let taken = vec![(agent.run[root] & 0xff) as usize, agent.action as usize];
                assert_eq!(bench.shared.skills[below].child[(agent.run[below] & 0xff) as usize], agent.action);
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
    let mut next = stream(52);
    let text = format!("{TREE}{DEEP}");
    for (heat, choice) in [("0.0", "learned"), ("3.0", "learned"), ("3.0", "random"), ("3.0", "ordered")] {
        let set = [
            SILENT.to_owned(),
            "root=home".to_owned(),
            format!("skill.home.learning.child_inverse_temperature={heat}"),
            format!("skill.leave.policy={choice}"),
            // The root's own order decides: it always takes `leave`.
            "skill.home.policy=fixed-priority".to_owned(),
        ];
        let bench = Bench::new(&text, &set.each_ref().map(String::as_str));
        let (tree, home, leave) = (bench.tree(), bench.skill("home"), bench.skill("leave"));
        for _ in 0..4 {
            let pose = bench.pose(&mut next);
            let mut record = bench.look(&bench.begun(pose).agent);
            record[10] = 255;
            let heat: f64 = heat.parse().expect("a number");
            let middle = match choice {
                "learned" => odds(&tree.values(leave, &record), heat),
                "random" => vec![1.0 / 3.0; 3],
                _ => vec![1.0, 0.0, 0.0],
            };
            let mut expected = BTreeMap::new();
            for (child, name) in ["door", "right", "dock"].into_iter().enumerate() {
                let below = bench.skill(name);
                for (number, p) in odds(&tree.values(below, &record), heat).into_iter().enumerate() {
                    let code = bench.shared.skills[below].child[number] as usize;
                    expected.insert(vec![child, code], middle[child] * p);
                }
            }
            let (mut counts, draws) = (BTreeMap::new(), 5000);
            for number in 0..draws {
                let mut episode = bench.begun(pose);
                bench.step(&mut episode, number);
                let agent = &episode.agent;
                assert_eq!(agent.run[home] & 0xff, 0);
                let chosen = (agent.run[leave] & 0xff) as usize;
                *counts.entry(vec![chosen, agent.action as usize]).or_default() += 1;
                // Who was not asked does not run.
                for (child, name) in ["door", "right", "dock"].into_iter().enumerate() {
                    assert_eq!(agent.run[bench.skill(name)] == IDLE, child != chosen);
                }
                assert_eq!(agent.run[bench.skill("left")], IDLE);
            }
            close(&format!("{choice} {heat} {pose:?}"), &counts, &expected, draws);
        }
    }
}

/// Baselines at the root, in tests: uniformly among the applicable ones, or the first of them.
#[test]
fn baselines_choose_among_what_is_applicable() {
    let mut next = stream(53);
    let mut sizes = Set::new();
    for choice in ["random", "ordered"] {
        let set = format!("skill.top.policy={choice}");
        let bench = Bench::new(TREE, &[SILENT, &set]);
        let (tree, root) = (bench.tree(), bench.skill("top"));
        for _ in 0..25 {
            let pose = bench.pose(&mut next);
            let record = bench.look(&bench.begun(pose).agent);
            let Some(applicable) = bench.applicable(root, &tree.worths(root, &record)) else { continue };
            sizes.insert(applicable.len());
            let (mut counts, draws) = (BTreeMap::new(), 1500);
            for number in 0..draws {
                let mut episode = bench.begun(pose);
                bench.step(&mut episode, number);
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
    let mut next = stream(54);
    let ways = [
        &["skill.top.persistence=true", "skill.top.interrupt=true"][..],
        &["skill.top.persistence=true", "skill.top.interrupt=false", "skill.top.child_timeout=7"],
        &["skill.top.persistence=training"],
        &["skill.top.persistence=true", "skill.top.applicability=false", "skill.top.child_timeout=0"],
    ];
    for way in ways {
        // The children see enough to wander, and the root changes its mind.
        let set = [&[SILENT, "skill.top.learning.child_inverse_temperature=2.0"], way].concat();
        let bench = Bench::new(TREE, &set);
        let (tree, root) = (bench.tree(), bench.skill("top"));
        let own = &bench.plan.arms[0].skills[root];
        let goal = |child: &Child| match child {
            Child::Skill(below) => Choice::Skill(super::persistence::members(bench.plan.arms[0].skills[*below].goal)),
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
            let mut episode = bench.begun(bench.pose(&mut next));
            for _step in 0..60 {
                let mut record = bench.look(&episode.agent);
                record[10] = chooser.running.map_or(255, |(child, _)| child as u32);
                let happened = super::persistence::members(episode.agent.events);
                let Some(applicable) = bench.applicable(root, &tree.worths(root, &record)) else { break };
                let reasons = chooser.reasons(&applicable, &happened);
                let best = greedy(&tree.values(root, &record), &chooser.candidates(&applicable, None));
                let before = episode.agent.step;
                bench.step(&mut episode, number);
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
