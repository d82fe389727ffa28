//! Trees of three levels that learn from end to end, on the CPU, in the easy world.

use super::super::configs::{number, plan_in};
use super::super::work::END;
use bytemuck::Zeroable;
use skilltree::backend::cpu::{CPU, cpu_backend};
use skilltree::backend::{Backend, Cohort, Stop, Test};
use skilltree::config::plan::{Child, Plan};
use skilltree::env::workgroup::{Nets, Workgroup};
use skilltree::layout::{
    Dispatch, EPISODE_TERMINATED, Episode, LANES, NO_CHILD, PHASE_DONE, PHASE_REPLAY, PHASE_TEACH, TrialRecord,
};
use skilltree::policy::applicability::run_child;
use skilltree::train::batch_group::{BatchGroup, groups};
use std::collections::BTreeMap;

/// Home is docked to the charger; from the other room the way there leads through the door.
const HOME: &str = r#"
    title = "three levels"
    seeds = "0..4"
    root = "go-home"
    [evaluate]
    at = [0]
    episodes = 40
    [teacher]
    lessons = 32
    discount = 0.85
    eval_episodes = 20
    [learning]
    replays = 20
    pretrain_epochs = 20
    taught_replays = 2
    inverse_temperature_trials = 30
    learning_rate_trials = 60
    learning_rate_end_share = 0.3
    child_inverse_temperature = 40.0
    [skill.dock]
    inputs = ["sonar(60)", "light", "bumpers"]
    reward = { docked = 100, collision = -10 }
    starts = { light-area = 0.8, anywhere = 0.2 }
    eval_starts = "light-area"
    goal = ["docked"]
    lessons = 10
    trials = 60
    [skill.pass-door]
    inputs = ["sonar(60)", "sonar-far", "bumpers"]
    reward = { passed-door = 100, collision = -10 }
    starts = "near-doors"
    eval_starts = "near-doors"
    goal = ["passed-door"]
    lessons = 10
    trials = 60
    [skill.follow-right]
    inputs = ["sonar(30)", "bumpers"]
    reward = { beside-right = 8, collision = -10 }
    lessons = 10
    trials = 20
    learning = { timeout_terminal = false }
    [skill.follow-left]
    mirror = "follow-right"
    [skill.leave]
    children = ["pass-door", "follow-right", "follow-left"]
    inputs = ["values", "applicable", "sonar-far", "bumpers", "running"]
    applicable = { pass-door = 0.3 }
    reward = { passed-door = 100 }
    starts = "room:B"
    eval_starts = "room:B"
    goal = ["passed-door"]
    max_steps = 60
    trials = 20
    [skill.go-home]
    children = ["leave", "dock"]
    inputs = ["values", "applicable", "lit", "running", "light-trace", "door-trace", "range-means", "room"]
    applicable = { dock = 0.25 }
    applicability = false
    child_timeout = 10
    reward = { docked = 100 }
    starts = { "room:B" = 0.7, anywhere = 0.3 }
    eval_starts = "room:B"
    goal = ["docked"]
    max_steps = 80
    trials = 40
    [skill.leave.learning]
    gamma = 0.98
    lambda = 0.6
    [skill.go-home.learning]
    gamma = 0.98
    lambda = 0.6
    learning_rate = 0.005
    learning_rate_end_share = 1.0
    replays = 60
    inverse_temperature_start = 8.0
    inverse_temperature_end = 40.0
    timeout_terminal = false
"#;

/// The three levels, with some arms.
pub(crate) fn home(arms: &str, set: &[&str]) -> Plan {
    plan_in("easy", &format!("{HOME}{arms}"), set)
}

pub(crate) fn only_group(plan: &Plan) -> BatchGroup {
    let mut groups = groups(plan).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(groups.len(), 1);
    groups.remove(0)
}

pub(crate) fn reach(backend: &mut dyn Backend, stop: Stop) {
    while !backend.advance(stop).expect("the CPU advances").iter().all(|state| stop.holds(state)) {}
}

/// A cohort that has learned everything, and its tests of each skill before the first trial and after the last.
pub(super) fn learned(plan: &Plan, group: &BatchGroup) -> (Cohort, Vec<[Vec<Episode>; 2]>) {
    let mut backend = cpu_backend(2, None).expect("threads");
    backend.load(group.cohort(plan, &group.learners(plan))).expect("memory");
    let mut tests = Vec::new();
    for (number, skill) in (0..).zip(&plan.arms[0].skills) {
        tests.push([0, skill.params.trials].map(|trial| {
            reach(&mut backend, Stop { skill: number, trial });
            backend.evaluate(Test { skill: number, number: trial, episodes: 40 }).expect("tests")
        }));
    }
    reach(&mut backend, END);
    (backend.memory().expect("memory").clone(), tests)
}

#[test]
fn three_levels_learn_to_go_home() {
    let plan = home("", &[]);
    let group = only_group(&plan);
    let fresh = group.cohort(&plan, &group.learners(&plan));
    let (cohort, tests) = learned(&plan, &group);
    let names: Vec<&str> = plan.arms[0].skills.iter().map(|skill| skill.name.as_str()).collect();
    assert_eq!(names, ["dock", "pass-door", "follow-right", "follow-left", "leave", "go-home"]);
    for (learner, state) in cohort.states.iter().enumerate() {
        assert_eq!(state.phase, PHASE_DONE, "learner {learner}");
        // Every skill has its trials in the table, but the mirror image, which needs none.
        let rows: &[TrialRecord] =
            bytemuck::cast_slice(&cohort.rows[learner * cohort.rows_stride..][..cohort.rows_stride]);
        let mut expected = Vec::new();
        for (number, skill) in (0..).zip(&plan.arms[0].skills) {
            expected.extend((0..skill.params.lessons).map(|trial| (number, trial, 1)));
            expected.extend((0..skill.params.trials).map(|trial| (number, trial, 0)));
        }
        let found: Vec<(u32, u32, u32)> =
            rows[..state.rows as usize].iter().map(|row| (row.skill, row.trial, row.taught)).collect();
        assert_eq!(found, expected, "learner {learner}");
        // Every skill's nets have learned, those of the mirror image being its source's.
        for (name, skill) in names.iter().zip(&cohort.shared.skills) {
            let first = learner * cohort.nets_stride + skill.nets_offset as usize;
            let words = skill.nets as usize * 3 * skill.rows as usize * LANES;
            let changed = fresh.nets[first..first + words].iter().zip(&cohort.nets[first..]).filter(|(a, b)| a != b);
            assert!(changed.count() > words / 4, "learner {learner}: {name}");
        }
        let offset = |name| cohort.shared.skills[number(&plan, name)].nets_offset;
        assert_eq!(offset("follow-left"), offset("follow-right"));
    }
    let achieved = |tests: &[Episode]| tests.iter().filter(|episode| episode.state == EPISODE_TERMINATED).count();
    for (name, [before, after]) in names.iter().zip(&tests) {
        println!("{name}: {} to {} of {}", achieved(before), achieved(after), after.len());
    }
    let [before, after] = tests.last().expect("tests of the root");
    assert_eq!(after.len(), 160);
    assert!(achieved(after) >= 120 && achieved(after) >= achieved(before) + 20);
    // The same starts before and after.
    let start = |episode: &Episode| (episode.start_x, episode.start_y);
    assert!(before.iter().zip(after).all(|(before, after)| start(before) == start(after)));
    // Untrained, the skills below would not bring the robot home at all, whatever the root does.
    let mut backend = cpu_backend(2, None).expect("threads");
    let mut ignorant = cohort.clone();
    let root = ignorant.shared.skills[5].nets_offset as usize;
    for (nets, fresh) in ignorant.nets.chunks_mut(cohort.nets_stride).zip(fresh.nets.chunks(cohort.nets_stride)) {
        nets[..root].copy_from_slice(&fresh[..root]);
    }
    backend.load(ignorant).expect("memory");
    let without = backend.evaluate(Test { skill: 5, number: 40, episodes: 40 }).expect("tests");
    println!("{} with untrained children", achieved(&without));
    assert!(achieved(&without) + 60 < achieved(after));
}

/// Steps of tests of the root, seen one by one: which skills run below which.
#[test]
fn children_of_children_execute() {
    let plan = home("", &[]);
    let group = only_group(&plan);
    let (cohort, _) = learned(&plan, &group);
    let [dock, door, right, left, leave, home] =
        ["dock", "pass-door", "follow-right", "follow-left", "leave", "go-home"].map(|name| number(&plan, name));
    let mut chains = BTreeMap::<Vec<usize>, u32>::new();
    for number in 0..160 {
        let learner = (number % 4) as usize;
        let nets = &cohort.nets[learner * cohort.nets_stride..][..cohort.nets_stride];
        let params = &cohort.params[learner * cohort.skills..][..cohort.skills];
        let mut episode = Episode::zeroed();
        let dispatch = Dispatch { iterations: 1, test_skill: home as u32, ..Dispatch::zeroed() };
        while episode.state < EPISODE_TERMINATED {
            let before = episode.agent.step;
            let group = Workgroup::new(&cohort.shared, params, &CPU.hot);
            Workgroup { dispatch, nets: Nets::Read(nets), ..group }.evaluate(&mut episode, number);
            let agent = &episode.agent;
            if agent.step == before {
                continue;
            }
            // From the root down to the action.
            let (mut at, mut chain) = (home, Vec::new());
            let action = loop {
                chain.push(at);
                match plan.arms[0].skills[at].children[run_child(agent.run[at]) as usize] {
                    Child::Skill(below) => at = below,
                    Child::Action(action) => break action,
                }
            };
            assert_eq!(agent.action, action as u32);
            for other in (0..6).filter(|other| !chain.contains(other)) {
                assert_eq!(agent.run[other], NO_CHILD, "{chain:?}: {other} runs");
            }
            *chains.entry(chain).or_default() += 1;
        }
        assert_eq!(episode.state == EPISODE_TERMINATED, episode.agent.events & 1 == 1);
    }
    println!("{chains:?}");
    let expected = [vec![home, dock], vec![home, leave, door], vec![home, leave, right], vec![home, leave, left]];
    assert_eq!(chains.len(), expected.len());
    assert!(expected.iter().all(|chain| chains.get(chain).is_some_and(|steps| *steps > 20)), "{chains:?}");
}

/// Every other pass over the lessons and about half of the later replays are seen in a mirror, if so configured.
#[test]
fn half_of_the_replays_are_seen_in_a_mirror() {
    let short = ["seeds='0..2'", "root=pass-door", "skill.pass-door.trials=6", "skill.pass-door.lessons=3"];
    for mirror in [true, false] {
        let set = format!("skill.pass-door.learning.mirror_replays={mirror}");
        let plan = home("", &[short.as_slice(), &["learning.pretrain_epochs=5", &set]].concat());
        let group = only_group(&plan);
        let mut backend = cpu_backend(1, Some(1)).expect("threads");
        backend.load(group.cohort(&plan, &group.learners(&plan))).expect("memory");
        let mut later = BTreeMap::<(usize, u32, u32), (u32, u32)>::new();
        while !backend.advance(END).expect("the CPU advances").iter().all(|state| END.holds(state)) {
            for (learner, state) in backend.memory().expect("memory").states.iter().enumerate() {
                if state.phase == PHASE_TEACH && state.replay > 0 {
                    let pass = (state.replay - 1) / 3;
                    assert_eq!(state.replay_mirrored == 1, mirror && pass % 2 == 1, "replay {}", state.replay);
                } else if state.phase == PHASE_REPLAY && state.replay > 0 {
                    let key = (learner, state.trial, state.replay);
                    later.insert(key, (state.replay_taught, state.replay_mirrored));
                }
            }
        }
        // Two taught ones and twenty of the learner's own after each trial.
        assert_eq!(later.len(), 2 * 6 * 22);
        let seen = |taught: u32| later.values().filter(|(t, m)| *t == taught && *m == 1).count();
        match mirror {
            // Four standard deviations of 240 tosses of a coin, and of 24.
            true => assert!(seen(0).abs_diff(120) < 31 && seen(1).abs_diff(12) < 10, "{} {}", seen(0), seen(1)),
            false => assert_eq!((seen(0), seen(1)), (0, 0)),
        }
    }
}
