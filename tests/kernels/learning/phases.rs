//! The state machine of a learner: whoever interrupts it, beside whomever it trains, and where its numbers end.

use super::super::configs::{file, written};
use super::super::work::END;
use skilltree::backend::cpu::CPU;
use skilltree::backend::host::{HostBackend, HostForms};
use skilltree::backend::reference::REFERENCE;
use skilltree::backend::{Backend, Cohort, Stop, parity};
use skilltree::config::plan::Plan;
use skilltree::layout::{LANES, PHASE_DONE, PHASE_FAILED, TrialRecord};
use skilltree::train::batch_group::groups;

/// A config of two skills, one of them above the other, whose learners need every phase, and little time.
fn small() -> Plan {
    let office = file("configs/worlds/office.toml");
    let text = format!(
        r#"
        title = "small"
        world = {office:?}
        seeds = "0..4"
        [evaluate]
        at = []
        episodes = 1
        [teacher]
        lessons = 8
        eval_episodes = 1
        [learning]
        replays = 4
        replay_capacity = 3
        pretrain_epochs = 2
        taught_replays = 2
        [skill.dock]
        inputs = ["sonar(60)", "light", "bumpers"]
        children = ["turn+15", "turn-15", "turn+60", "turn-60", "move+12", "move-12"]
        reward = {{ docked = 100, collision = -10 }}
        starts = {{ light-area = 1.0 }}
        eval_starts = "light-area"
        goal = ["docked"]
        max_steps = 25
        lessons = 2
        trials = 6
        [skill.wander]
        inputs = ["sonar-far", "compass"]
        children = ["turn+15", "dock", "move+12"]
        reward = {{ docked = 50, collision = -20 }}
        starts = {{ anywhere = 1.0 }}
        eval_starts = "anywhere"
        goal = ["docked"]
        max_steps = 12
        lessons = 0
        trials = 4
        [arm.only]
        [arm.open.learning]
        timeout_terminal = false
        mask_blocked = false
        optimiser = "sgd"
        learning_rate = 0.05
        "#
    );
    written(&text, &[])
}

fn cohort() -> Cohort {
    let plan = small();
    let groups = groups(&plan).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(groups.len(), 1);
    let learners = groups[0].learners(&plan);
    groups[0].cohort(&plan, &learners)
}

fn run(cohort: &Cohort, threads: usize, iterations: u32, stops: &[Stop]) -> Cohort {
    run_in(&CPU, cohort, threads, iterations, stops)
}

fn run_in(forms: &'static HostForms, cohort: &Cohort, threads: usize, iterations: u32, stops: &[Stop]) -> Cohort {
    let mut backend = HostBackend::new(forms, threads, Some(iterations)).expect("threads");
    backend.load(cohort.clone()).expect("memory");
    for stop in stops {
        while !backend.advance(*stop).expect("the CPU advances").iter().all(|state| stop.holds(state)) {}
    }
    backend.memory().expect("memory").clone()
}

/// Every byte that learners leave.
fn bytes(cohort: &Cohort, learner: usize) -> Vec<u8> {
    let nets = &cohort.nets[learner * cohort.nets_stride..][..cohort.nets_stride];
    let lessons = &cohort.lessons[learner * cohort.lessons_stride..][..cohort.lessons_stride];
    let rows = &cohort.rows[learner * cohort.rows_stride..][..cohort.rows_stride];
    let state = bytemuck::bytes_of(&cohort.states[learner]);
    [state, bytemuck::cast_slice(nets), bytemuck::cast_slice(lessons), bytemuck::cast_slice(rows)].concat()
}

#[test]
fn interruptions_and_company_change_no_byte() {
    let start = cohort();
    let learners = start.states.len();
    assert_eq!(learners, 8);
    let whole = run(&start, 1, u32::MAX, &[END]);
    assert!(whole.states.iter().all(|state| state.phase == PHASE_DONE && state.updates > 50));
    assert!((0..learners).all(|learner| bytes(&whole, learner) != bytes(&start, learner)));
    assert_eq!(parity::advance(&whole, &run_in(&REFERENCE, &start, 2, u32::MAX, &[END])), None);
    let points = [(0, 0), (0, 3), (1, 0), (1, 2)].map(|(skill, trial)| Stop { skill, trial });
    let stops = [points.as_slice(), &[END]].concat();
    for (threads, iterations, stops) in [(1, 1, &[END][..]), (2, 7, &[END]), (2, 1000, &stops), (1, 3, &stops)] {
        let parts = run(&start, threads, iterations, stops);
        for learner in 0..learners {
            assert!(
                bytes(&parts, learner) == bytes(&whole, learner),
                "{iterations} iterations: learner {learner} differs"
            );
        }
    }
    // Alone, as among others.
    for learner in [0, 5] {
        let part = |words: &[f32], stride: usize| words[learner * stride..(learner + 1) * stride].to_vec();
        let alone = Cohort {
            params: start.params[learner * start.skills..][..start.skills].to_vec(),
            states: vec![start.states[learner]],
            nets: part(&start.nets, start.nets_stride),
            lessons: vec![0; start.lessons_stride],
            rows: vec![0; start.rows_stride],
            ..start.clone()
        };
        assert!(bytes(&run(&alone, 1, 50, &[END]), 0) == bytes(&whole, learner), "learner {learner} alone");
    }
}

#[test]
fn the_trial_table_adds_up() {
    let start = cohort();
    let done = run(&start, 2, 1000, &[END]);
    for (learner, state) in done.states.iter().enumerate() {
        let rows: &[TrialRecord] = bytemuck::cast_slice(&done.rows[learner * done.rows_stride..][..done.rows_stride]);
        let mut actions = 0;
        let list: Vec<(u32, u32, u32)> = rows[..state.rows as usize]
            .iter()
            .map(|row| {
                let TrialRecord { skill, trial, steps, reward, success, collisions, taught, .. } = *row;
                actions += steps;
                assert_eq!(row.actions, actions);
                let (pay, hit) = if skill == 0 { (100.0, -10.0) } else { (50.0, -20.0) };
                assert_eq!(reward, pay * success as f32 + hit * collisions as f32);
                assert!(steps >= 1 && steps <= if skill == 0 { 25 } else { 12 });
                assert!(success == 1 || steps == if skill == 0 { 25 } else { 12 });
                (skill, trial, taught)
            })
            .collect();
        let taught = (0..2).map(|trial| (0, trial, 1));
        let own = (0..6).map(|trial| (0, trial, 0)).chain((0..4).map(|trial| (1, trial, 0)));
        assert_eq!(list, taught.chain(own).collect::<Vec<_>>(), "learner {learner}");
    }
}

#[test]
fn a_learner_whose_weights_stop_being_numbers_freezes_alone() {
    let start = cohort();
    let clean = run(&start, 2, 1000, &[END]);
    let skill = start.shared.skills[0];
    let rows = skill.rows as usize;
    // One weight of one child's net: of an input, a hidden bias, an output weight, the output bias.
    for (learner, child, row, poison) in [
        (1, 4, 0, f32::NAN),
        (2, 4, rows - 3, f32::NAN),
        (3, 2, rows - 2, f32::INFINITY),
        (6, 5, rows - 1, f32::NAN),
        (7, 1, rows - 1, f32::NEG_INFINITY),
    ] {
        let mut sick = start.clone();
        let word = learner * sick.nets_stride + skill.net_offset(child) + row * LANES;
        sick.nets[word] = poison;
        let after = run(&sick, 2, 1000, &[END]);
        let state = &after.states[learner];
        assert_eq!(state.phase, PHASE_FAILED, "learner {learner}: {poison} in row {row} of child {child}");
        for other in (0..8).filter(|other| *other != learner) {
            assert!(bytes(&after, other) == bytes(&clean, other), "learner {other} suffers from {learner}");
        }
        // It stays as it is.
        let again = run(&after, 1, 1000, &[END]);
        assert!(bytes(&again, learner) == bytes(&after, learner));
    }
}
