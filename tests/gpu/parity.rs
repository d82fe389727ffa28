//! Shaders, CPU and reference leave the same bytes.

use super::adapter::{gpu, opened};
use super::lessons::remembered;
use super::work::{DOCKING, FIVE, GROWN, TREE, cpu, reference, some};
use skilltree::backend::UNWRITTEN;
use skilltree::backend::gpu::GpuOptions;
use skilltree::backend::parity;
use skilltree::cli::CliError;
use skilltree::layout::{ELEMENTARY_STEP_WORDS, PHASE_DONE, STEP_WORDS, Step};
use skilltree::train::parity::train;
use std::process::Command;

#[test]
fn shipped_kernels_leave_the_bytes_of_cpu_and_reference() {
    let expected = DOCKING.run(&mut reference()).expect("it runs");
    assert_eq!(expected.difference(&DOCKING.run(&mut cpu()).expect("it runs")), None);
    let mut gpu = gpu();
    let found = DOCKING.run(&mut *gpu).expect("it runs");
    assert_eq!(expected.difference(&found), None);
    let (before, after) = (&DOCKING.cohorts()[0], &expected.cohorts()[0]);
    assert!(after.states.iter().all(|state| state.phase == PHASE_DONE && state.updates > 50));
    let differs = |a: &[u32], b: &[u32]| a != b;
    assert!(differs(&before.lessons, &after.lessons) && differs(&before.rows, &after.rows));
    assert!(before.nets != after.nets && before.states != after.states);
    assert!(expected.robots().iter().flatten().any(|robot| robot.events & 2 != 0), "nobody bumped into anything");
    assert!(expected.robots().iter().flatten().all(|robot| robot.events != UNWRITTEN));
    assert!(expected.bytes() > 1 << 20);

    // How often the learners are interrupted, and beside whom they train, changes nothing.
    let cut = GpuOptions { iterations: Some(7), shard: Some(4), ..GpuOptions::default() };
    let interrupted = DOCKING.run(&mut opened(&cut)).expect("it runs");
    assert_eq!(expected.difference(&interrupted), None);
    let single = train(some(&DOCKING.cohorts()[0], 3..4), &mut *gpu).expect("it runs");
    let five = &FIVE.cohorts()[0];
    assert_eq!(single.cohorts()[0].states[0], five.states[3]);
    assert!(single.cohorts()[0].nets[..] == five.nets[3 * five.nets_stride..4 * five.nets_stride]);
}

#[test]
fn trees_of_skills_leave_the_bytes_of_cpu_and_reference() {
    let mut gpu = gpu();
    assert_eq!(GROWN.difference(&TREE.run(&mut *gpu).expect("it runs")), None);
    assert_eq!(GROWN.difference(&TREE.run(&mut reference()).expect("it runs")), None);
    let cut = GpuOptions { iterations: Some(5), shard: Some(3), ..GpuOptions::default() };
    let interrupted = train(TREE.cohorts()[0].clone(), &mut opened(&cut));
    let (interrupted, after) = (interrupted.expect("it runs"), &GROWN.cohorts()[0]);
    assert_eq!(parity::advance(after, &interrupted.cohorts()[0]), None);
    assert!(after.states.iter().all(|state| state.phase == PHASE_DONE));

    // The work reached what it is there for.
    let skills = &after.shared.skills;
    let (few, all) = (ELEMENTARY_STEP_WORDS as u32, STEP_WORDS as u32);
    assert_eq!(skills.iter().map(|plan| plan.record_words).collect::<Vec<_>>(), [few, few, few, few, few, all, all]);
    assert_eq!(skills.iter().map(|plan| plan.mirrored).collect::<Vec<_>>(), [0, 0, 1, 0, 0, 0, 0]);
    assert!(skills[4].planned > 0 && skills[5].outputs == 3 && skills[6].watched == 0b10_1111);
    let mut events = 0;
    for (skill, children, valued) in [(5, 3, 3), (6, 4, 2)] {
        let lessons = (0..after.states.len()).flat_map(|learner| remembered(after, learner, skill));
        let records: Vec<Step> = lessons.flat_map(|lesson| lesson.records).collect();
        let some = |what: &str, holds: &dyn Fn(&Step) -> bool| {
            assert!(records.iter().any(holds), "skill {skill}: {what} never happened");
        };
        (0..children).for_each(|child| some(&format!("child {child}"), &|record| record.choice & 0xff == child));
        some("keeping to a child", &|record| record.choice >> 31 == 0);
        some("a child that is not applicable", &|record| (record.high_level >> 8) & 0xff != (1 << children) - 1);
        some("mean ranges", &|record| record.east_west != 0.0 && record.north_south != 0.0);
        some("a trace of light", &|record| record.light_trace != 0.0);
        some("a trace of a door", &|record| record.door_trace != 0.0);
        some("a way through a door", &|record| record.door_cosine != 0.0 && record.door_sine != 0.0);
        (0..valued).for_each(|child| some(&format!("value {child}"), &|record| record.value[child] != 0.0));
        events |= records.iter().fold(0, |seen, record| seen | (record.choice >> 24) & 0x1f);
    }
    assert_eq!(events | 1, 0b1_1111, "all events but docking");
}

#[test]
fn users_can_ask_for_parity() {
    let _alone = gpu();
    let give = |line: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_skilltree"));
        command.current_dir(env!("CARGO_MANIFEST_DIR")).args(line).output().expect("it starts")
    };
    let output = give(&["devices", "--parity", "configs/docking.toml", "--learners", "2"]);
    let text = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{text}{}", String::from_utf8_lossy(&output.stderr));
    assert!(text.contains("\n  parity: equal, 2 learners, "), "{text}");
    assert!(output.stderr.is_empty());
    assert_eq!(CliError::Parity { differing: 1, adapters: 1 }.code(), 1);
    let output = give(&["devices", "--learners", "2"]);
    assert_eq!(output.status.code(), Some(2), "--learners is for --parity alone");
}
