//! Trees of three levels that learn from end to end, on the CPU, in the easy world.

use super::bench::{Tree64, most, plan_in};
use super::persistence::{Choice, Chooser, Reason, Rules, Set, members};
use bytemuck::Zeroable;
use skilltree::backend::cpu::CpuBackend;
use skilltree::backend::{Backend, Cohort, Stop, Test};
use skilltree::config::plan::{Child, Plan, SkillPlan, Threshold};
use skilltree::kernels::evaluate::{STATE_ACHIEVED, evaluate};
use skilltree::layout::phase::{PHASE_DONE, PHASE_REPLAY, PHASE_TEACH};
use skilltree::layout::{Dispatch, Episode, LANES, LESSON_HEADER, RECORD_WORDS, ROW_WORDS, VALUE_WORD};
use skilltree::learn::lesson::ENDED;
use skilltree::policy::persistence::IDLE;
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

/// The point beyond every skill.
pub(crate) const DONE: Stop = Stop { skill: u32::MAX, trial: u32::MAX };

pub(crate) fn only_group(plan: &Plan) -> BatchGroup {
    let mut groups = groups(plan).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(groups.len(), 1);
    groups.remove(0)
}

pub(crate) fn reach(backend: &mut CpuBackend, stop: Stop) {
    while !backend.advance(stop).expect("the CPU advances").iter().all(|state| stop.holds(state)) {}
}

/// A cohort that has learned everything, and its tests of each skill before the first trial and after the last.
fn learned(plan: &Plan, group: &BatchGroup) -> (Cohort, Vec<[Vec<Episode>; 2]>) {
    let mut backend = CpuBackend::new(2, None).expect("threads");
    backend.load(group.cohort(plan, &group.learners(plan))).expect("memory");
    let mut tests = Vec::new();
    for (number, skill) in (0..).zip(&plan.arms[0].skills) {
        tests.push([0, skill.params.trials].map(|trial| {
            reach(&mut backend, Stop { skill: number, trial });
            backend.evaluate(Test { skill: number, number: trial, episodes: 40 }).expect("tests")
        }));
    }
    reach(&mut backend, DONE);
    (backend.memory().expect("memory").clone(), tests)
}

fn number(plan: &Plan, name: &str) -> usize {
    plan.arms[0].skills.iter().position(|skill| skill.name == name).expect("a skill of this name")
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
        let rows = &cohort.rows[learner * cohort.rows_stride..][..state.rows as usize * ROW_WORDS];
        let mut expected = Vec::new();
        for (number, skill) in (0..).zip(&plan.arms[0].skills) {
            expected.extend((0..skill.params.lessons).map(|trial| (number, trial, 1)));
            expected.extend((0..skill.params.trials).map(|trial| (number, trial, 0)));
        }
        let found: Vec<(u32, u32, u32)> = rows.chunks(ROW_WORDS).map(|row| (row[0], row[1], row[7])).collect();
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
    let achieved = |tests: &[Episode]| tests.iter().filter(|episode| episode.state == STATE_ACHIEVED).count();
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
    let mut backend = CpuBackend::new(2, None).expect("threads");
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
        while episode.state < STATE_ACHIEVED {
            let before = episode.agent.step;
            evaluate(&mut episode, &cohort.shared, params, nets, &dispatch, number);
            let agent = &episode.agent;
            if agent.step == before {
                continue;
            }
            // From the root down to the action.
            let (mut at, mut chain) = (home, Vec::new());
            let action = loop {
                chain.push(at);
                match plan.arms[0].skills[at].children[(agent.run[at] & 0xff) as usize] {
                    Child::Skill(below) => at = below,
                    Child::Action(action) => break action,
                }
            };
            assert_eq!(agent.action, action as u32);
            for other in (0..6).filter(|other| !chain.contains(other)) {
                assert_eq!(agent.run[other], IDLE, "{chain:?}: {other} runs");
            }
            *chains.entry(chain).or_default() += 1;
        }
        assert_eq!(episode.state == STATE_ACHIEVED, episode.agent.events & 1 == 1);
    }
    println!("{chains:?}");
    let expected = [vec![home, dock], vec![home, leave, door], vec![home, leave, right], vec![home, leave, left]];
    assert_eq!(chains.len(), expected.len());
    assert!(expected.iter().all(|chain| chains.get(chain).is_some_and(|steps| *steps > 20)), "{chains:?}");
}

/// The first words of a learner's memory of a skill: its trials, oldest slot first.
fn trials(cohort: &Cohort, learner: usize, skill: usize) -> Vec<&[u32]> {
    let plan = &cohort.shared.skills[skill];
    let params = &cohort.params[learner * cohort.skills + skill];
    let lessons = &cohort.lessons[learner * cohort.lessons_stride..][..cohort.lessons_stride];
    let slots = lessons[plan.memory_offset as usize..].chunks(plan.lesson_stride as usize);
    slots.take(params.trials.min(params.replay_capacity) as usize).collect()
}

/// Every remembered trial of both skills over skills, word by word: what the rules allow, what was applicable, what the
/// children were worth, what was earned.
#[test]
fn remembered_trials_follow_the_rules() {
    let rules = [
        &["skill.leave.interrupt=false", "skill.go-home.persistence=true"][..],
        &["skill.leave.child_timeout=4", "skill.go-home.applicability=true", "skill.leave.persistence='training'"],
        &["skill.leave.persistence=false", "skill.go-home.child_timeout=0"],
    ];
    let mut reasons_seen = BTreeMap::<Reason, u32>::new();
    let (mut steps, mut held, mut applied, mut idle_worths) = (0, 0, 0, 0);
    for set in rules {
        // The root knows both children's worth.
        let more = ["seeds='0..2'", "skill.go-home.applicable={ leave = 0.5, dock = 0.25 }"];
        let plan = home("", &[&more, set].concat());
        let group = only_group(&plan);
        let (cohort, _) = learned(&plan, &group);
        let skills = &plan.arms[0].skills;
        for learner in 0..2 {
            let nets = &cohort.nets[learner * cohort.nets_stride..][..cohort.nets_stride];
            let tree = Tree64::new(skills, 2, &cohort.shared.skills, nets);
            for name in ["leave", "go-home"] {
                let (number, params) = (number(&plan, name), &skills[number(&plan, name)]);
                for trial in trials(&cohort, learner, number) {
                    let records: Vec<&[u32]> =
                        trial[LESSON_HEADER..].chunks(RECORD_WORDS).take(trial[0] as usize + 1).collect();
                    let goal = |child: &Child| match child {
                        Child::Skill(below) => Choice::Skill(members(skills[*below].goal)),
                        Child::Action(action) => Choice::Action(*action as u32),
                    };
                    let own = &params.params;
                    let rules = Rules {
                        persist: own.persist_training == 1,
                        applicability: own.applicability == 1,
                        interrupt: own.interrupt == 1,
                        patience: (own.child_timeout > 0).then_some(own.child_timeout),
                    };
                    let choices = params.children.iter().map(goal).collect();
                    let mut chooser = Chooser { choices, rules, running: None, before: Set::new() };
                    let (mut happened, mut earned) = (Set::new(), 0.0);
                    for (step, record) in records.iter().enumerate() {
                        let says = || format!("{name}, learner {learner}, step {step}: {chooser:?}");
                        let worths = tree.worths(number, record);
                        let applicable = members(record[10] >> 8 & 0xff);
                        for (child, threshold) in params.applicable.iter().enumerate() {
                            let (word, below) = (f32::from_bits(record[VALUE_WORD + child]), &params.children[child]);
                            let over = *below == Child::Skill(super::trees::number(&plan, "leave"));
                            // What a skill over skills is worth depends on what it is doing.
                            let known = !over || chooser.running.is_none_or(|(running, _)| running != child);
                            let worth = if over { idle_worth(&tree, skills, record) } else { worths[child] };
                            match threshold {
                                Some(Threshold::Fixed(least)) => {
                                    if known {
                                        assert!((f64::from(word) - worth).abs() < 2.0e-5, "{}: {word} {worth}", says());
                                    }
                                    assert_eq!(applicable.contains(&child), word > *least, "{}", says());
                                    idle_worths += u32::from(over && known);
                                }
                                _ => assert!(word == 0.0 && applicable.contains(&child), "{}", says()),
                            }
                        }
                        let running = chooser.running.map_or(255, |(child, _)| child as u32);
                        assert_eq!(record[10] & 0xff, running, "{}", says());
                        let candidates = chooser.candidates(&applicable, None);
                        let reasons = chooser.reasons(&applicable, &happened);
                        let allowed = if reasons.is_empty() { [running as usize].into() } else { candidates.clone() };
                        let offered: Set = if reasons.is_empty() {
                            candidates.union(&allowed).copied().collect()
                        } else {
                            candidates.clone()
                        };
                        let word = record[8];
                        assert_eq!(members(word >> 8 & 0xff), allowed, "{}", says());
                        assert_eq!(members(word >> 16 & 0xff), offered, "{}", says());
                        assert_eq!(word >> 31 == 1, !reasons.is_empty(), "{}", says());
                        if step == trial[0] as usize {
                            assert_eq!((word & 0xff, word >> 24 & 0x7f, record[9]), (255, 0, 0));
                            break;
                        }
                        happened = members(word >> 24 & 0x7f);
                        let pay: f32 = happened.iter().map(|event| params.params.reward[*event]).sum();
                        assert_eq!(f32::from_bits(record[9]), pay, "{}", says());
                        earned += pay;
                        let ended = happened.iter().any(|event| params.goal >> event & 1 == 1);
                        assert_eq!(ended, step + 1 == trial[0] as usize && trial[1] == ENDED, "{}", says());
                        let child = (word & 0xff) as usize;
                        assert!(allowed.contains(&child), "{}", says());
                        if let [only] = reasons.as_slice() {
                            *reasons_seen.entry(*only).or_default() += 1;
                        }
                        steps += 1;
                        held += u32::from(reasons.is_empty());
                        applied += u32::from(candidates.len() < params.children.len());
                        chooser.take(child, !reasons.is_empty(), applicable);
                    }
                    assert_eq!(f32::from_bits(trial[2]), earned);
                    assert!(trial[1] == ENDED || trial[0] == params.params.max_steps);
                }
            }
        }
    }
    println!("{steps} {held} {applied} {idle_worths} {reasons_seen:?}");
    assert!(steps > 2000 && held > 500 && applied > 100 && idle_worths > 200);
    for reason in [Reason::Unbound, Reason::Idle, Reason::Achieved, Reason::Fresh, Reason::Lost, Reason::Late] {
        assert!(reasons_seen.contains_key(&reason), "{reason:?}: {reasons_seen:?}");
    }
}

/// What `leave` is worth while nobody has asked it for a step: the best of its values, given the worth of `pass-door`.
fn idle_worth(tree: &Tree64<'_>, skills: &[SkillPlan], record: &[u32]) -> f64 {
    let leave = skills.iter().position(|skill| skill.name == "leave").expect("the skill");
    let worths = tree.worths(leave, record);
    let mut own = record.to_vec();
    let applicable = (0..3).filter(|child| skills[leave].applicable[*child].is_none() || worths[*child] > 0.3);
    own[10] = 255 | applicable.fold(0, |bits, child| bits | 1 << (8 + child));
    for (child, worth) in worths.iter().enumerate() {
        own[VALUE_WORD + child] = (*worth as f32).to_bits();
    }
    most(tree.values(leave, &own))
}

/// Baselines that choose at random or in order do so in training too.
#[test]
fn baselines_choose_in_training_too() {
    for choice in ["random", "ordered"] {
        let short = ["skill.dock.trials=4", "skill.pass-door.trials=4", "skill.follow-right.trials=2", "seeds='0..2'"];
        let root = format!("skill.go-home.policy={choice}");
        let plan = home("", &[short.as_slice(), &[&root, "skill.go-home.applicability=true"]].concat());
        let (cohort, _) = learned(&plan, &only_group(&plan));
        let mut counts = BTreeMap::<Vec<usize>, [u32; 2]>::new();
        for learner in 0..2 {
            for trial in trials(&cohort, learner, number(&plan, "go-home")) {
                for record in trial[LESSON_HEADER..].chunks(RECORD_WORDS).take(trial[0] as usize) {
                    let (child, allowed) = ((record[8] & 0xff) as usize, members(record[8] >> 8 & 0xff));
                    counts.entry(allowed.into_iter().collect()).or_default()[child] += 1;
                }
            }
        }
        println!("{choice}: {counts:?}");
        let [first, second] = counts[&vec![0, 1]];
        let total = f64::from(first + second);
        assert!(total > 40.0);
        match choice {
            "random" => assert!((f64::from(first) - total / 2.0).abs() < 2.5 * total.sqrt(), "{counts:?}"),
            _ => assert_eq!(second, 0),
        }
    }
}

/// Every other pass over the lessons and about half of the later replays are seen in a mirror, if so configured.
#[test]
fn half_of_the_replays_are_seen_in_a_mirror() {
    let short = ["seeds='0..2'", "root=pass-door", "skill.pass-door.trials=6", "skill.pass-door.lessons=3"];
    for mirror in [true, false] {
        let set = format!("skill.pass-door.learning.mirror_replays={mirror}");
        let plan = home("", &[short.as_slice(), &["learning.pretrain_epochs=5", &set]].concat());
        let group = only_group(&plan);
        let mut backend = CpuBackend::new(1, Some(1)).expect("threads");
        backend.load(group.cohort(&plan, &group.learners(&plan))).expect("memory");
        let mut later = BTreeMap::<(usize, u32, u32), (u32, u32)>::new();
        while !backend.advance(DONE).expect("the CPU advances").iter().all(|state| DONE.holds(state)) {
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
