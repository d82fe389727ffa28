//! CPU and GPU leave the same bytes, and a kernel that is broken on purpose is found out and named.
//!
//! A machine without any adapter fails these tests: install software Vulkan (mesa-vulkan-drivers). Nothing
//! here is skipped.
#![cfg(feature = "gpu")]

use bytemuck::Zeroable;
use skilltree::backend::cpu::CpuBackend;
use skilltree::backend::gpu::dispatch_size::quantum_turns;
use skilltree::backend::gpu::source::{ADVANCE, EVALUATE, Kernel, Part, STEP};
use skilltree::backend::gpu::workgroup_weights::holders;
use skilltree::backend::gpu::{GpuBackend, GpuOptions};
use skilltree::backend::parity::{self, Difference, UNWRITTEN};
use skilltree::backend::{Backend, Cohort, Stop, Test};
use skilltree::cli::CliError;
use skilltree::config::{Overrides, load};
use skilltree::layout::phase::{PHASE_DONE, PHASE_FAILED};
use skilltree::layout::{Episode, LESSON_HEADER, LearnerState, RECORD_WORDS, Robot};
use skilltree::train::observation::{SILENT, robot_at};
use skilltree::train::parity::{Sample, Work, train};
use skilltree::world::Pose;
use std::mem::offset_of;
use std::path::Path;
use std::process::Command;
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

/// Words of a state.
const CURSOR_WORDS: usize = size_of::<LearnerState>() / 4;

static GPU: LazyLock<Mutex<GpuBackend>> =
    LazyLock::new(|| Mutex::new(GpuBackend::new(&GpuOptions::default()).expect("an adapter, if only a software one")));

/// Learners of every arm, so both optimisers, taught and untaught.
static WORK: LazyLock<Work> = LazyLock::new(|| {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/docking.toml");
    let plan = load(&path, &Overrides::default()).expect("the config is good");
    Work::new(&plan, 6).expect("the experiment can be set up")
});

/// Two learners of each of four arms, over a tree of three levels.
static TREE: LazyLock<Work> = LazyLock::new(|| {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/support/tree.toml");
    let plan = load(&path, &Overrides::default()).expect("the config is good");
    Work::new(&plan, 8).expect("the experiment can be set up")
});

/// What the CPU leaves of them.
static GROWN: LazyLock<Sample> = LazyLock::new(|| TREE.run(&mut cpu()).expect("it runs"));

/// What the CPU leaves of the first five learners.
static FIVE: LazyLock<Sample> = LazyLock::new(|| train(few(0..5), &mut cpu()).expect("it runs"));

fn gpu() -> MutexGuard<'static, GpuBackend> {
    GPU.lock().unwrap_or_else(PoisonError::into_inner)
}

fn cpu() -> CpuBackend {
    CpuBackend::new(0, None).expect("threads")
}

/// Some of the work's learners, before training.
fn few(range: std::ops::Range<usize>) -> Cohort {
    let all = &WORK.cohorts()[0];
    let part = |stride: usize| range.start * stride..range.end * stride;
    Cohort {
        shared: all.shared.clone(),
        params: all.params[part(all.skills)].to_vec(),
        states: all.states[range.clone()].to_vec(),
        nets: all.nets[part(all.nets_stride)].to_vec(),
        lessons: all.lessons[part(all.lessons_stride)].to_vec(),
        rows: all.rows[part(all.rows_stride)].to_vec(),
        ..*all
    }
}

#[test]
fn shipped_kernels_leave_the_bytes_of_the_cpu() {
    let expected = WORK.run(&mut cpu()).expect("it runs");
    let found = WORK.run(&mut *gpu()).expect("it runs");
    assert_eq!(expected.difference(&found), None);
    let (before, after) = (&WORK.cohorts()[0], &expected.cohorts()[0]);
    assert!(after.states.iter().all(|state| state.phase == PHASE_DONE && state.updates > 50));
    let differs = |a: &[u32], b: &[u32]| a != b;
    assert!(differs(&before.lessons, &after.lessons) && differs(&before.rows, &after.rows));
    assert!(before.nets != after.nets && before.states != after.states);
    assert!(expected.robots().iter().flatten().any(|robot| robot.events & 2 != 0), "nobody bumped into anything");
    assert!(expected.robots().iter().flatten().all(|robot| robot.events != UNWRITTEN));
    assert!(expected.bytes() > 1 << 20);

    // How often the learners are interrupted, and beside whom they train, changes nothing.
    let cut = GpuOptions { iterations: Some(7), shard: Some(4), ..GpuOptions::default() };
    let interrupted = WORK.run(&mut GpuBackend::new(&cut).expect("an adapter")).expect("it runs");
    assert_eq!(expected.difference(&interrupted), None);
    let single = train(few(3..4), &mut *gpu()).expect("it runs");
    let five = &FIVE.cohorts()[0];
    assert_eq!(single.cohorts()[0].states[0], five.states[3]);
    assert!(single.cohorts()[0].nets[..] == five.nets[3 * five.nets_stride..4 * five.nets_stride]);
}

/// All records of the remembered trials of a skill over skills; the last one of each only closes the trial.
fn records(cohort: &Cohort, skill: usize) -> Vec<&[u32]> {
    let plan = &cohort.shared.skills[skill];
    let slots = cohort.lessons.chunks(cohort.lessons_stride).flat_map(|own| {
        let memory = cohort.params[skill].replay_capacity as usize * plan.lesson_stride as usize;
        own[plan.memory_offset as usize..][..memory].chunks(plan.lesson_stride as usize)
    });
    slots.flat_map(|slot| slot[LESSON_HEADER..].chunks(RECORD_WORDS).take(slot[0] as usize + 1)).collect()
}

#[test]
fn trees_of_skills_leave_the_bytes_of_the_cpu() {
    assert_eq!(GROWN.difference(&TREE.run(&mut *gpu()).expect("it runs")), None);
    let cut = GpuOptions { iterations: Some(5), shard: Some(3), ..GpuOptions::default() };
    let interrupted = train(TREE.cohorts()[0].clone(), &mut GpuBackend::new(&cut).expect("an adapter"));
    let (interrupted, after) = (interrupted.expect("it runs"), &GROWN.cohorts()[0]);
    assert_eq!(parity::advance(after, &interrupted.cohorts()[0]), None);
    assert!(after.states.iter().all(|state| state.phase == PHASE_DONE));

    // The work reached what it is there for.
    let skills = &after.shared.skills;
    assert_eq!(skills.iter().map(|plan| plan.record_words).collect::<Vec<_>>(), [10, 10, 10, 10, 10, 25, 25]);
    assert_eq!(skills.iter().map(|plan| plan.mirrored).collect::<Vec<_>>(), [0, 0, 1, 0, 0, 0, 0]);
    assert!(skills[4].planned > 0 && skills[5].outputs == 3 && skills[6].watched == 0b10_1111);
    let mut events = 0;
    for (skill, children, valued) in [(5, 3, 3), (6, 4, 2)] {
        let records = records(after, skill);
        let some = |what: &str, holds: &dyn Fn(&[u32]) -> bool| {
            assert!(records.iter().any(|record| holds(record)), "skill {skill}: {what} never happened");
        };
        (0..children).for_each(|child| some(&format!("child {child}"), &|record| record[8] & 0xff == child));
        some("keeping to a child", &|record| record[8] >> 31 == 0);
        some("a child that is not applicable", &|record| (record[10] >> 8) & 0xff != (1 << children) - 1);
        for word in 11..17 + valued {
            some(&format!("word {word}"), &|record| record[word] != 0);
        }
        events |= records.iter().fold(0, |seen, record| seen | (record[8] >> 24) & 0x1f);
    }
    assert_eq!(events | 1, 0b1_1111, "all events but docking");
}

/// The kernel with the turns of all its loops counted where the updates stood: the most of any dispatch.
fn counting(kernel: Kernel) -> Kernel {
    const TURN: &str = "turned += 1u;\n";
    let part = |part: &Part| {
        assert!(!part.text.contains("while ") && !part.text.contains("loop {"), "{}", part.path);
        // Once for each turn, and once for the test that ends the loop.
        let line = |line: &str| {
            if line.trim_start().starts_with("for (") { format!("{TURN}{line}\n{TURN}") } else { format!("{line}\n") }
        };
        let mut text: String = part.text.lines().map(line).collect();
        if part.path == "kernels/train.wgsl" {
            let from = "states[learner] = state;";
            let to = "state.updates = max(states[learner].updates, turned);";
            text = text.replace(from, &format!("{to}\n{from}")) + "var<private> turned: u32;\n";
        }
        Part { path: part.path, text: text.leak() }
    };
    Kernel { parts: kernel.parts.iter().map(part).collect::<Vec<_>>().leak(), ..kernel }
}

#[test]
fn no_quantum_takes_more_turns_than_the_governor_counts() {
    let _alone = gpu();
    let single = GpuOptions { iterations: Some(1), ..GpuOptions::default() };
    let mut gpu = GpuBackend::new(&single).expect("an adapter");
    gpu.replace(counting(ADVANCE));
    let stop = Stop { skill: u32::MAX, trial: u32::MAX };
    let mut most = |cohort: &Cohort| {
        gpu.load(cohort.clone()).expect("it fits");
        while !gpu.advance(stop).expect("it runs").iter().all(|state| stop.holds(state)) {}
        let states = gpu.advance(stop).expect("it runs");
        (states.iter().map(|state| state.updates).max().expect("learners"), gpu.held())
    };
    // Nets of 16 units lie in workgroup memory while they are replayed: that makes the dearest iteration.
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/docking.toml");
    let set = vec!["learning.hidden=16".to_owned()];
    let lean = load(&path, &Overrides { set, ..Overrides::default() }).expect("the config is good");
    let lean = Work::new(&lean, 6).expect("the experiment can be set up");
    for (cohort, replayed) in [(&TREE.cohorts()[0], false), (&lean.cohorts()[0], true)] {
        let (seen, held) = most(cohort);
        let holders = holders(cohort, held);
        let counted = quantum_turns(&cohort.shared, holders);
        assert!(seen <= counted && 5 * seen > 4 * counted, "{seen} turns of {counted}");
        assert_eq!(counted > quantum_turns(&cohort.shared, 0), replayed, "{holders:b}");
    }
}

/// Path of a part of a kernel, a statement in it, and what stands there instead.
type Fault = (&'static str, &'static str, &'static str);

/// The shipped kernel with faults, each put where its statement stands once.
fn broken(kernel: Kernel, faults: &[Fault]) -> Kernel {
    let mut parts = kernel.parts.to_vec();
    for (path, from, to) in faults {
        let part = parts.iter_mut().find(|part| part.path == *path).expect("a part of the kernel");
        assert_eq!(part.text.matches(from).count(), 1, "`{from}` must stand in {path} once");
        *part = Part { path: part.path, text: part.text.replace(from, to).leak() };
    }
    Kernel { parts: parts.leak(), ..kernel }
}

/// What a broken kernel does, with the shipped one put back.
fn with<T>(kernel: Kernel, shipped: Kernel, act: impl FnOnce(&mut GpuBackend) -> T) -> T {
    let mut gpu = gpu();
    gpu.replace(kernel);
    let found = act(&mut gpu);
    gpu.replace(shipped);
    found
}

/// First differences of all learners: each is healed once it is named, until nothing differs any more.
fn all(mut difference: impl FnMut(Option<usize>) -> Option<Difference>) -> Vec<Difference> {
    let mut found: Vec<Difference> = Vec::new();
    while let Some(next) = difference(found.last().map(|last| last.learner)) {
        assert!(found.last().is_none_or(|last| last.learner < next.learner), "{next}");
        found.push(next);
    }
    found
}

/// One kernel with a fault for each of four learners: compiling one takes software adapters seconds.
#[test]
fn faults_of_advance_are_named() {
    let kernel = broken(
        ADVANCE,
        &[
            // One last place in one lane.
            (
                "qnet/forward.wgsl",
                "activation = tanh(sum);",
                "activation = tanh(sum);
                if lane == 5u && base == 2u * dispatch.nets_stride {
                    activation = bitcast<f32>(bitcast<u32>(activation) + 1u);
                }",
            ),
            // A word that is never written: zeroes would hide it.
            (
                "learn/lesson.wgsl",
                "rows[at + 7u] = taught;",
                "if rows_base != dispatch.rows_stride { rows[at + 7u] = taught; }",
            ),
            // Two learners that swap their memory.
            (
                "kernels/train.wgsl",
                "rows_base = learner * dispatch.rows_stride;",
                "rows_base = select(learner, 7u - learner, learner >= 3u) * dispatch.rows_stride;",
            ),
        ],
    );
    let expected = &FIVE.cohorts()[0];
    let mut found = with(kernel, ADVANCE, |gpu| train(few(0..5), gpu)).expect("it runs").cohorts()[0].clone();
    let all = all(|healed| {
        if let Some(learner) = healed {
            let part = |stride: usize| learner * stride..(learner + 1) * stride;
            let (nets, lessons, rows) = (part(found.nets_stride), part(found.lessons_stride), part(found.rows_stride));
            found.states[learner] = expected.states[learner];
            found.nets[nets.clone()].copy_from_slice(&expected.nets[nets]);
            found.lessons[lessons.clone()].copy_from_slice(&expected.lessons[lessons]);
            found.rows[rows.clone()].copy_from_slice(&expected.rows[rows]);
        }
        parity::advance(expected, &found)
    });
    assert_eq!(
        all.iter().map(|found| (found.kernel, found.learner)).collect::<Vec<_>>(),
        [1, 2, 3, 4].map(|k| ("advance", k))
    );
    assert_eq!((all[0].field.as_str(), all[0].right), ("rows word 7 (row 0, taught)", UNWRITTEN));
    let says = all[1].to_string();
    assert!(all[1].finite && all[1].left != all[1].right, "{says}");
    assert!(["learner 2: state ", "learner 2: nets word "].iter().any(|field| says.contains(field)), "{says}");
    assert!(all[2..].iter().all(|found| found.field.starts_with("rows word ")), "{all:?}");
}

/// The same for tests of trained learners.
#[test]
fn faults_of_evaluate_are_named() {
    let kernel = broken(
        EVALUATE,
        &[
            (
                "kernels/evaluate.wgsl",
                "execute(lane, s, action);",
                "execute(lane, s, action);
                if lane == 0u && learner == 2u && number == 5u && agent.step == 1u {
                    agent.x = bitcast<f32>(bitcast<u32>(agent.x) + 1u);
                }",
            ),
            (
                "kernels/evaluate.wgsl",
                "episode.start_y = pose.y;",
                "if s != dispatch.skills { episode.start_y = pose.y; }",
            ),
            (
                "kernels/evaluate.wgsl",
                "let base = learner * dispatch.nets_stride;",
                "let base = select(learner, 7u - learner, learner >= 3u) * dispatch.nets_stride;",
            ),
        ],
    );
    let test = |backend: &mut dyn Backend| {
        backend.load(FIVE.cohorts()[0].clone()).expect("it fits");
        backend.evaluate(Test { skill: 0, number: 9, episodes: 7 }).expect("it runs")
    };
    let (expected, mut found) = (test(&mut cpu()), with(kernel, EVALUATE, |gpu| test(gpu)));
    let all = all(|healed| {
        let own = healed.map_or(0..0, |learner| 7 * learner..7 * learner + 7);
        found[own.clone()].copy_from_slice(&expected[own]);
        parity::evaluate(&expected, &found, 7)
    });
    assert_eq!(
        all.iter().map(|found| (found.kernel, found.learner)).collect::<Vec<_>>(),
        [1, 2, 3, 4].map(|k| ("evaluate", k))
    );
    let says = "kernel evaluate, learner 1: test trial 0, start_y: ";
    assert!(all[0].to_string().starts_with(says) && all[0].right == UNWRITTEN, "{}", all[0]);
    assert!(all[1].field.starts_with("test trial 5, "), "{}", all[1]);
}

/// Robots stand so near to where a reading changes that one of them reads another inch.
#[test]
fn one_last_place_in_one_ray_of_the_sonar_is_named() {
    let kernel = broken(
        STEP,
        &[(
            "env/observe.wgsl",
            "reading(range, error)",
            "reading(select(range, bitcast<f32>(bitcast<u32>(range) + 1u), lane == 0u), error)",
        )],
    );
    let x = |place: u32| f32::from_bits(24.5_f32.to_bits() - 32 + place);
    let robots: Vec<Robot> =
        (0..64).map(|place| robot_at(Pose { x: x(place), y: 200.0, heading: 180.0 }, &SILENT, 0, 0)).collect();
    let shared = &WORK.cohorts()[0].shared;
    let (mut expected, mut found) = (robots.clone(), robots);
    cpu().step(shared, &mut expected, 1).expect("it runs");
    let ahead = |robot: &Robot| robot.record[0] & 0xff;
    let edge = expected.iter().rposition(|robot| ahead(robot) == 24).expect("one that reads 24 inches");
    with(kernel, STEP, |gpu| gpu.step(shared, &mut found, 1)).expect("it runs");
    let found = parity::step(&expected, &found).expect("a difference");
    assert_eq!((found.kernel, found.learner), ("step", edge), "{found}");
    assert_eq!((found.left & 0xff, found.right & 0xff), (24, 25), "{found}");
    assert_eq!(found.field, "record word 0 (sonar 0 to 3)");
}

/// Every part of a learner's memory has its name, and the first difference is the one that is reported.
#[test]
fn differences_are_named_in_order() {
    let cohort = FIVE.cohorts()[0].clone();
    let plan = cohort.shared.skills[0];
    let mut other = cohort.clone();
    let flip = |words: &mut [u32], at: usize| words[at] ^= 1;
    let at = |stride: usize, word: usize| 3 * stride + word;
    let says = |other: &Cohort, field: &str| {
        let found = parity::advance(&cohort, other).expect("a difference");
        let says = format!("kernel advance, learner 3: {field}: {:#010x} against {:#010x}", found.left, found.right);
        assert_eq!((found.to_string(), found.left), (says, found.right ^ 1));
    };
    flip(&mut other.rows, at(cohort.rows_stride, 12));
    says(&other, "rows word 12 (row 1, reward)");
    let lesson = (plan.lesson_stride + 4 + 2 * 10 + 7) as usize;
    flip(&mut other.lessons, at(cohort.lessons_stride, lesson));
    says(&other, &format!("lessons word {lesson} (skill 0, slot 1, step 2, record word 7 (compass))"));
    let header = plan.lesson_stride as usize + 1;
    flip(&mut other.lessons, at(cohort.lessons_stride, header));
    says(&other, &format!("lessons word {header} (skill 0, slot 1, end)"));
    let nets = |other: &mut Cohort, word: usize| flip(bytemuck::cast_slice_mut(&mut other.nets), word);
    let rows = plan.rows as usize;
    // Half a row stays free between two nets.
    let weight =
        |child: usize, slab: usize, row: usize, unit: usize| ((child * 3 + slab) * rows + row) * 32 + child * 16 + unit;
    let inputs = plan.inputs as usize;
    for (word, text) in [
        (plan.clock_offset as usize + 18, "child 2, clock of second moments".to_owned()),
        (plan.clock_offset as usize + 2, "child 2, clock of first moments".to_owned()),
        (weight(5, 2, inputs, 31), "child 5, second moment of the hidden bias, unit 31".to_owned()),
        (weight(4, 1, inputs + 2, 0), "child 4, first moment of the output bias, unit 0".to_owned()),
        (weight(2, 0, inputs + 1, 6), "child 2, output weight, unit 6".to_owned()),
        (weight(2, 0, 17, 5), "child 2, weight of input 17, unit 5".to_owned()),
        (weight(2, 0, 0, 0) - 1, "between nets".to_owned()),
    ] {
        nets(&mut other, at(cohort.nets_stride, word));
        says(&other, &format!("nets word {word} (skill 0, {text})"));
    }
    for (offset, text) in [
        (offset_of!(LearnerState, agent.run) + 8, "state agent.run 2"),
        (offset_of!(LearnerState, agent.heading), "state agent.heading"),
        (offset_of!(LearnerState, updates), "state updates"),
    ] {
        flip(bytemuck::cast_slice_mut(&mut other.states), 3 * CURSOR_WORDS + offset / 4);
        says(&other, text);
    }
    other.states.truncate(3);
    let found = parity::advance(&cohort, &other).expect("a difference");
    assert_eq!((found.field.as_str(), found.left, found.right), ("number of learners", 5, 3));
}

/// The same for what only trees have: records of their own length, nets with several outputs, mirror images.
#[test]
fn differences_in_trees_are_named() {
    let cohort = &GROWN.cohorts()[0];
    let skills = &cohort.shared.skills;
    let says = |part: fn(&mut Cohort) -> &mut [u32], word: usize, text: &str| {
        let mut other = cohort.clone();
        part(&mut other)[word] ^= 1;
        let found = parity::advance(cohort, &other).expect("a difference");
        assert_eq!((found.learner, found.field.as_str()), (0, text));
    };
    fn lessons(cohort: &mut Cohort) -> &mut [u32] {
        &mut cohort.lessons
    }
    fn nets(cohort: &mut Cohort) -> &mut [u32] {
        bytemuck::cast_slice_mut(&mut cohort.nets)
    }
    for (skill, step, word, name) in [
        (0, 1, 7, "compass"),
        (5, 0, 8, "choice and events"),
        (6, 2, 10, "running, applicable and room"),
        (6, 0, 16, "sine of that door"),
        (6, 1, 17, "value of child 0"),
    ] {
        let plan = &skills[skill];
        let at = (plan.memory_offset + 4 + step * plan.record_words) as usize + word;
        let text = format!("lessons word {at} (skill {skill}, slot 0, step {step}, record word {word} ({name}))");
        says(lessons, at, &text);
    }
    let (right, dock) = (&skills[1], &skills[3]);
    assert_eq!((skills[2].nets_offset, dock.outputs), (right.nets_offset, 6));
    let word = right.nets_offset as usize;
    says(nets, word, &format!("nets word {word} (skill 1, child 0, weight of input 0, unit 0)"));
    let row = |row: u32| (dock.nets_offset + row * 32) as usize;
    for (word, text) in [
        (row(dock.inputs) + 3, "hidden bias, unit 3"),
        (row(dock.inputs + 1), "output weight of child 0, unit 0"),
        (row(dock.inputs + 6) + 31, "output weight of child 5, unit 31"),
        (row(dock.inputs + 7) + 2, "output bias, unit 2"),
        (row(dock.rows + dock.inputs + 7) + 2, "first moment of the output bias, unit 2"),
        (dock.clock_offset as usize + 16, "clock of second moments"),
    ] {
        says(nets, word, &format!("nets word {word} (skill 3, all children, {text})"));
    }
}

#[test]
fn a_number_that_is_not_finite_is_a_difference_on_both_sides_too() {
    let mut cohort = FIVE.cohorts()[0].clone();
    assert_eq!(parity::advance(&cohort, &cohort), None);
    let word = cohort.nets_stride + 40;
    cohort.nets[word] = f32::NAN;
    let found = parity::advance(&cohort, &cohort).expect("a difference");
    let says = "kernel advance, learner 1: nets word 40 (skill 0, child 0, weight of input 1, unit 8): \
                0x7fc00000 against 0x7fc00000, not finite";
    assert_eq!(found.to_string(), says);
    // A learner that has failed may hold anything, but the same on both sides.
    cohort.states[1].phase = PHASE_FAILED;
    assert_eq!(parity::advance(&cohort, &cohort), None);
    let mut other = cohort.clone();
    other.nets[word] = f32::INFINITY;
    assert_eq!(parity::advance(&cohort, &other).map(|found| found.finite), Some(true));
    let mut episodes = vec![Episode::zeroed(); 6];
    episodes[4].agent.reward = f32::NEG_INFINITY;
    let found = parity::evaluate(&episodes, &episodes, 3).expect("a difference");
    assert_eq!((found.learner, found.field.as_str(), found.finite), (1, "test trial 1, agent.reward", false));
    let mut robots = vec![Robot::zeroed(); 2];
    robots[1].events = u32::MAX;
    assert_eq!(parity::step(&robots, &robots), None);
    robots[1].record[7] = f32::NAN.to_bits();
    let found = parity::step(&robots, &robots).expect("a difference");
    let says = "kernel step, robot 1: record word 7 (compass): 0x7fc00000 against 0x7fc00000, not finite";
    assert_eq!(found.to_string(), says);
    assert!(parity::evaluate(&episodes[..3], &episodes, 3).is_some() && parity::step(&robots[..1], &robots).is_some());
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
