//! The GPU backend against the CPU's, byte by byte, on whatever adapter this machine has.
//!
//! A machine without any adapter fails these tests: install software Vulkan (mesa-vulkan-drivers). Nothing
//! here is skipped.

use bytemuck::Zeroable;
use skilltree::backend::cpu::CpuBackend;
use skilltree::backend::gpu::conformance::{ask, compare, examine, questions};
use skilltree::backend::gpu::device::Device;
use skilltree::backend::gpu::pipeline::Pipeline;
use skilltree::backend::gpu::source::KERNELS;
use skilltree::backend::gpu::{GpuBackend, GpuOptions, adapter};
use skilltree::backend::{Backend, BackendError, Cohort, Stop, Test};
use skilltree::config::plan::Plan;
use skilltree::config::{Overrides, load};
use skilltree::experiment::group::{Group, groups};
use skilltree::learner::layout::{PHASE_DONE, Robot};
use skilltree::math::rng::philox;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Drivers are tested one user at a time.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

fn alone() -> MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

fn gpu(quanta: Option<u32>) -> GpuBackend {
    GpuBackend::new(&GpuOptions { quanta, ..GpuOptions::default() }).expect("an adapter, if only a software one")
}

fn docking(seeds: &str) -> (Plan, Group) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/docking.toml");
    let set = ["skill.dock.trials=3", "teacher.bank=16", "teacher.episodes=1", "learning.taught_passes=1"];
    let mut set: Vec<String> = set.map(str::to_owned).to_vec();
    set.extend(["learning.replays=4".to_owned(), "learning.memory=3".to_owned(), "evaluate.at=[0]".to_owned()]);
    set.push("arm.taught-sgd.learning.memory=2".to_owned());
    set.push("arm.untaught-sgd.learning.memory=2".to_owned());
    let plan = load(&path, &Overrides { set, seeds: Some(seeds.to_owned()) }).expect("the config is good");
    let group = groups(&plan).expect("the experiment can be set up").remove(0);
    (plan, group)
}

/// The cohort after training, with a test halfway and one at the end.
fn trained(backend: &mut dyn Backend, cohort: Cohort) -> (Cohort, Vec<u8>) {
    let mut tests = Vec::new();
    backend.load(cohort).expect("it fits");
    for trial in [0, 2, 3] {
        let stop = Stop { skill: 0, trial };
        while !backend.advance(stop).expect("it runs").iter().all(|cursor| stop.holds(cursor)) {}
        let episodes = backend.evaluate(Test { skill: 0, number: trial, episodes: 7 }).expect("it runs");
        tests.extend_from_slice(bytemuck::cast_slice(&episodes));
    }
    let done = Stop { skill: u32::MAX, trial: u32::MAX };
    while !backend.advance(done).expect("it runs").iter().all(|cursor| done.holds(cursor)) {}
    (backend.memory().expect("it runs").clone(), tests)
}

fn differences(a: &Cohort, b: &Cohort) -> Vec<(&'static str, usize)> {
    let words = |cohort: &Cohort| -> [(&'static str, Vec<u32>); 4] {
        [
            ("cursors", bytemuck::cast_slice(&cohort.cursors).to_vec()),
            ("nets", bytemuck::cast_slice(&cohort.nets).to_vec()),
            ("lessons", cohort.lessons.clone()),
            ("rows", cohort.rows.clone()),
        ]
    };
    let count = |a: &[u32], b: &[u32]| a.iter().zip(b).filter(|(a, b)| a != b).count() + a.len().abs_diff(b.len());
    let pairs = words(a).into_iter().zip(words(b));
    pairs.map(|((name, a), (_, b))| (name, count(&a, &b))).filter(|(_, differing)| *differing > 0).collect()
}

/// Training and tests with both optimisers, taught and untaught, learner by learner to the last byte.
#[test]
fn training_leaves_the_same_bytes_on_both_backends() {
    let _alone = alone();
    let (plan, group) = docking("0..3");
    let learners = group.learners(&plan);
    let cohort = group.cohort(&plan, &learners);
    let mut cpu = CpuBackend::new(0, None).expect("threads");
    let mut gpu = gpu(None);
    assert!(gpu.verdict().exact, "{:?}", gpu.verdict());
    let (on_cpu, cpu_tests) = trained(&mut cpu, cohort.clone());
    let (on_gpu, gpu_tests) = trained(&mut gpu, cohort.clone());
    assert!(on_cpu.cursors.iter().all(|cursor| cursor.phase == PHASE_DONE && cursor.updates > 50));
    assert_eq!(differences(&on_cpu, &on_gpu), []);
    assert_eq!(cpu_tests, gpu_tests);
    assert!(differences(&on_cpu, &cohort).len() == 4, "training must have changed every buffer");

    // How often the learners are interrupted, and beside whom they train, changes nothing.
    let cut = GpuOptions { quanta: Some(3), shard: Some(4), ..GpuOptions::default() };
    let mut cut = GpuBackend::new(&cut).expect("an adapter");
    let (interrupted, tests) = trained(&mut cut, cohort);
    assert_eq!(differences(&on_cpu, &interrupted), []);
    assert_eq!(cpu_tests, tests);
    let (single, _) = trained(&mut gpu, group.cohort(&plan, &learners[3..4]));
    assert_eq!(single.cursors[0], on_cpu.cursors[3]);
    assert_eq!(single.nets, on_cpu.nets[3 * on_cpu.nets_stride..4 * on_cpu.nets_stride]);
}

/// A hand-made change of one net's last place is found by the comparison.
#[test]
fn one_last_place_in_one_weight_is_seen() {
    let _alone = alone();
    let (plan, group) = docking("0");
    let learners = group.learners(&plan);
    let cohort = group.cohort(&plan, &learners[..1]);
    let mut changed = cohort.clone();
    changed.nets[40] = f32::from_bits(changed.nets[40].to_bits() ^ 1);
    let (on_cpu, _) = trained(&mut CpuBackend::new(1, None).expect("a thread"), changed);
    let (on_gpu, _) = trained(&mut gpu(None), cohort);
    assert!(differences(&on_cpu, &on_gpu).iter().any(|(name, _)| *name == "nets"));
}

fn robots(count: u32) -> Vec<Robot> {
    (0..count)
        .map(|number| {
            let words = philox([number, 0, 0, 0], [11, 22]);
            Robot {
                x: 200.0 + (words[0] % 120) as f32,
                y: 60.0 + (words[1] % 240) as f32,
                heading: (words[2] % 360) as f32,
                noise_kind: number & 1,
                noise_actuator: 0.08,
                noise_sonar: 0.1,
                noise_light: 0.1,
                noise_compass: 2.865,
                run_seed: 5,
                robot_seed: number,
                ..Robot::zeroed()
            }
        })
        .collect()
}

/// 512 robots take 50 random actions each; every sensor of every step is compared.
#[test]
fn robots_under_given_actions_are_the_same_on_both_backends() {
    let _alone = alone();
    let (_, group) = docking("0");
    let mut cpu = CpuBackend::new(0, None).expect("threads");
    let mut gpu = gpu(None);
    let (mut on_cpu, mut on_gpu) = (robots(512), robots(512));
    let mut events = 0;
    for step in 0..50 {
        for (number, (a, b)) in on_cpu.iter_mut().zip(&mut on_gpu).enumerate() {
            a.action = philox([number as u32, step, 1, 0], [33, 44])[0] % 6;
            b.action = a.action;
            b.record = [u32::MAX; 10];
            a.record[8..].copy_from_slice(&[u32::MAX; 2]);
        }
        cpu.step(&group.shared, &mut on_cpu, 1 + step % 2).expect("it runs");
        gpu.step(&group.shared, &mut on_gpu, 1 + step % 2).expect("it runs");
        assert_eq!(bytemuck::cast_slice::<_, u32>(&on_cpu), bytemuck::cast_slice::<_, u32>(&on_gpu), "step {step}");
        events |= on_cpu.iter().fold(0, |all, robot| all | robot.events);
    }
    assert_ne!(events & 2, 0, "nobody bumped into anything");
}

/// The conformance check compares what it says: a flipped last bit of any answer is named.
#[test]
fn one_last_place_in_one_lane_is_not_exact() {
    let _alone = alone();
    let device = Device::open(&adapter::choose(None, true).expect("an adapter")).expect("it opens");
    let questions = questions(1024);
    let answers = ask(&device, &questions).expect("it runs");
    assert!(compare(&questions, &answers).exact);
    for (word, name) in [(1, "exponential"), (14, "philox"), (25, "a*b + c"), (45, "lanes_sums")] {
        let mut wrong = answers.clone();
        wrong[777][word] ^= 1;
        let verdict = compare(&questions, &wrong);
        let reason = verdict.reason.expect("a reason");
        assert!(!verdict.exact && reason.contains(name) && reason.contains("input 777"), "{reason}");
    }
    let unwritten = vec![[u32::MAX; 48]; 1024];
    assert!(!compare(&questions, &unwritten).exact);
}

/// llvmpipe ends loops after 65,535 turns; the check must notice, and dispatches must stay below.
#[test]
fn the_loop_budget_of_software_adapters_is_seen() {
    let _alone = alone();
    let gpu = gpu(None);
    if gpu.info().name.contains("llvmpipe") {
        assert_eq!(gpu.verdict().loop_budget, Some(65_535));
    }
    assert!(gpu.describe().contains("exact"));
}

/// An adapter that does not exist is refused with what was found and what to do.
#[test]
fn a_wrong_name_is_refused_with_a_hint() {
    let _alone = alone();
    let options = GpuOptions { adapter: Some("no such card".to_owned()), ..GpuOptions::default() };
    let error = GpuBackend::new(&options).expect_err("no such adapter");
    let BackendError::Unavailable { message, hint } = error else { panic!("{error}") };
    assert!(message.contains("`no such card`") && message.contains("found `"), "{message}");
    assert!(hint.contains("mesa-vulkan-drivers") && hint.contains("--backend cpu"), "{hint}");
}

/// Metal and DX12 take the WGSL as it is. Every kernel compiles that way too, and is never called exact.
#[test]
fn kernels_compile_without_passthrough_but_are_not_exact() {
    let _alone = alone();
    let adapter = adapter::choose(None, true).expect("an adapter");
    let device = Device::open_as(&adapter, false).expect("it opens");
    for kernel in KERNELS {
        Pipeline::new(&device, *kernel).unwrap_or_else(|error| panic!("{}: {error}", kernel.name));
    }
    let verdict = examine(&device).expect("it runs");
    assert!(!verdict.exact && verdict.reason.is_some());
    // llvmpipe re-associates what is not decorated: the shapes of the check must show it.
    if device.info.name.contains("llvmpipe") {
        let questions = questions(4096);
        let reason = compare(&questions, &ask(&device, &questions).expect("it runs")).reason;
        assert!(reason.is_some_and(|reason| reason.contains("differs on")));
    }
}

/// A lost device is an error that says so, not a panic and not a hang.
#[test]
fn a_lost_device_is_an_error() {
    let _alone = alone();
    let device = Device::open(&adapter::choose(None, true).expect("an adapter")).expect("it opens");
    device.device.destroy();
    let error = ask(&device, &questions(32)).expect_err("the device is lost");
    assert!(matches!(error, BackendError::Device { kernel: "probe", .. }), "{error}");
}
