//! What is made of a trained tree: learned thresholds, tests under other circumstances, example trials.

use super::bench::{Nets64, Tree64, inputs64, most};
use super::persistence::members;
use super::stems::short;
use super::trees::{home, only_group, reach};
use bytemuck::Zeroable;
use skilltree::backend::cpu::CpuBackend;
use skilltree::backend::{Backend, Cohort, Stop, Test};
use skilltree::config::plan::Plan;
use skilltree::kernels::evaluate::STATE_ACHIEVED;
use skilltree::layout::{Episode, LESSON_HEADER, RECORD_WORDS, VALUE_WORD};
use skilltree::learn::lesson::ENDED;
use skilltree::run_folder::weights::read_weights;
use skilltree::run_folder::{Provenance, RunFolder, Sums};
use skilltree::train::batch::{pretrain, train};
use skilltree::train::batch_group::BatchGroup;
use skilltree::train::result::LearnerResult;
use skilltree::train::run::{Options, run};
use skilltree::train::trajectories::trajectories;
use tempfile::TempDir;

fn number(plan: &Plan, name: &str) -> usize {
    plan.arms[0].skills.iter().position(|skill| skill.name == name).expect("a skill of this name")
}

/// All that the plan's only arm leaves, and its learners' memory.
fn trained(plan: &Plan, group: &BatchGroup) -> (Vec<LearnerResult>, Cohort) {
    let mut backend = CpuBackend::new(2, None).expect("threads");
    let ids = group.learners(plan);
    let stems = pretrain(plan, group, &ids, None, &mut backend, &mut ()).expect("the CPU does not fail");
    let stem_of = |id| stems.iter().find(|stem| stem.id == id);
    let results = train(plan, group, &ids, &stem_of, None, &mut backend, &mut ()).expect("the CPU does not fail");
    let memory = backend.memory().expect("memory").clone();
    (results, memory)
}

// Thresholds.

/// Best value of a skill at each step of the later half of its remembered trials, and whether the trial succeeded.
fn seen(plan: &Plan, cohort: &Cohort, learner: usize, skill: usize) -> Vec<(f64, bool)> {
    let (own, shape) = (&plan.arms[0].skills[skill], &cohort.shared.skills[skill]);
    let nets = Nets64::of(&cohort.nets[learner * cohort.nets_stride..][..cohort.nets_stride], shape);
    let memory = &cohort.lessons[learner * cohort.lessons_stride + shape.memory_offset as usize..];
    let kept = own.params.trials.min(own.params.replay_capacity);
    let latest = (0..own.params.trials).rev().take(kept.div_ceil(2) as usize);
    let mut seen = Vec::new();
    for trial in latest {
        let slot = trial % own.params.replay_capacity;
        let lesson = &memory[(slot * shape.lesson_stride) as usize..][..shape.lesson_stride as usize];
        for record in lesson[LESSON_HEADER..].chunks(shape.record_words as usize).take(lesson[0] as usize) {
            seen.push((most(nets.values(&inputs64(own, 2, record))), lesson[1] == ENDED));
        }
    }
    seen
}

/// The value at which success has this probability, by searches that need no derivatives of the curve: the best offset
/// for a slope by bisection, the best slope by thirds. The same pull towards a flat curve.
fn direct(seen: &[(f64, bool)], probability: f64) -> f64 {
    let pull = 1.0e-3;
    let best_offset = |slope: f64| {
        let (mut low, mut high) = (-400.0, 400.0);
        for _ in 0..60 {
            let offset: f64 = (low + high) / 2.0;
            let p = |value: f64| 1.0 / (1.0 + (-(offset + slope * value)).exp());
            let excess: f64 = seen.iter().map(|(value, success)| f64::from(u8::from(*success)) - p(*value)).sum();
            if excess - pull * offset > 0.0 { low = offset } else { high = offset }
        }
        (low + high) / 2.0
    };
    let loss = |slope: f64| {
        let offset = best_offset(slope);
        let one = |(value, success): &(f64, bool)| {
            let odds = offset + slope * value;
            (1.0 + (if *success { -odds } else { odds }).exp()).ln()
        };
        seen.iter().map(one).sum::<f64>() + 0.5 * pull * (offset * offset + slope * slope)
    };
    let (mut low, mut high) = (-200.0, 200.0);
    for _ in 0..70 {
        let (one, two) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if loss(one) < loss(two) { high = two } else { low = one }
    }
    let slope = (low + high) / 2.0;
    if slope <= 0.0 {
        return 1.0;
    }
    (((probability / (1.0 - probability)).ln() - best_offset(slope)) / slope).clamp(-1.0, 1.0)
}

#[test]
fn learned_thresholds_are_those_of_a_direct_fit() {
    // Memory for fewer trials than there are, so that slots are used twice.
    let set = [
        "skill.go-home.applicable={ dock = 'learned(0.7)', leave = 'learned' }",
        "skill.go-home.applicability=true",
        "skill.dock.learning={ replay_capacity = 30 }",
        "skill.go-home.trials=12",
        "seeds='0..3'",
    ];
    let plan = home("", &set);
    let group = only_group(&plan);
    let (dock, leave, root) = (number(&plan, "dock"), number(&plan, "leave"), number(&plan, "go-home"));
    let children = &plan.arms[0].skills[root].children;
    assert_eq!(children.len(), 2);

    // As far as the root's first trial, where its thresholds are set.
    let mut backend = CpuBackend::new(2, None).expect("threads");
    backend.load(group.cohort(&plan, &group.learners(&plan))).expect("memory");
    reach(&mut backend, Stop { skill: root as u32, trial: 0 });
    let below = backend.memory().expect("memory").clone();
    let expected: Vec<[f64; 2]> = (0..3)
        .map(|learner| [(leave, 0.5), (dock, 0.7)].map(|(skill, p)| direct(&seen(&plan, &below, learner, skill), p)))
        .collect();
    println!("{expected:?}");

    let (results, memory) = trained(&plan, &group);
    let mut decided = [[0; 2]; 2];
    for (learner, (result, expected)) in results.iter().zip(&expected).enumerate() {
        for (child, expected) in expected.iter().enumerate() {
            let found = result.thresholds[child];
            assert!((f64::from(found) - expected).abs() < 1.0e-3, "learner {learner}: {found} for {expected}");
        }
        // They hold in the root's own trials.
        let nets = &memory.nets[learner * memory.nets_stride..][..memory.nets_stride];
        let tree = Tree64::new(&plan.arms[0].skills, 2, &memory.shared.skills, nets);
        let shape = &memory.shared.skills[root];
        let lessons = &memory.lessons[learner * memory.lessons_stride + shape.memory_offset as usize..];
        for trial in lessons.chunks(shape.lesson_stride as usize).take(12) {
            for record in trial[LESSON_HEADER..].chunks(RECORD_WORDS).take(trial[0] as usize) {
                let applicable = members(record[10] >> 8 & 0xff);
                for (child, threshold) in result.thresholds.iter().enumerate().take(2) {
                    let worth = f32::from_bits(record[VALUE_WORD + child]);
                    assert_eq!(applicable.contains(&child), worth > *threshold);
                    decided[child][usize::from(worth > *threshold)] += 1;
                }
                let worth = f32::from_bits(record[VALUE_WORD + 1]);
                assert!((tree.worths(root, record)[1] - f64::from(worth)).abs() < 2.0e-5);
            }
        }
    }
    println!("{decided:?}");
    assert!(decided[1].iter().all(|count| *count > 20), "{decided:?}");
    assert!(expected.iter().any(|own| own[1] > -1.0 && own[1] < 1.0) && expected[0] != expected[1]);

    // And they stand in the files, to the last digit.
    let parent = TempDir::new().expect("a folder");
    let dir = parent.path().join("run");
    let worlds: Vec<(&str, &str)> = plan.worlds.iter().map(|w| (w.file.as_str(), w.text.as_str())).collect();
    let folder = RunFolder::open(&dir, &plan.resolved, &worlds).expect("a run folder");
    run(&plan, &[group], folder, &mut backend, Options::default(), Provenance::default(), &mut ()).expect("it runs");
    for (seed, result) in results.iter().enumerate() {
        let path = dir.join(format!("skills/base-{seed}.safetensors"));
        let (nets, metadata) = read_weights(&std::fs::read(&path).expect("weights"), &path).expect("weights");
        let expected = format!("leave={},dock={}", result.thresholds[0], result.thresholds[1]);
        assert_eq!(metadata["thresholds"], expected);
        // Every skill's nets but those of the mirror image, child by child.
        let mut names: Vec<&str> = nets.iter().map(|skill| skill.skill.as_str()).collect();
        names.sort_unstable();
        assert_eq!(names, ["dock", "follow-right", "go-home", "leave", "pass-door"]);
    }
}

/// The curve that these tests fit by searching is the one that outcomes were drawn from.
#[test]
fn the_direct_fit_finds_a_known_curve() {
    let mut next = super::bench::random(61);
    let seen: Vec<(f64, bool)> = (0..4000)
        .map(|_| {
            let value = next();
            (value, next() < 1.0 / (1.0 + (3.0 - 8.0 * value).exp()))
        })
        .collect();
    let found = direct(&seen, 0.5);
    assert!((found - 0.375).abs() < 0.03, "{found}");
    assert!(direct(&seen, 0.8) > found + 0.1);
}

// Other circumstances.

fn summed(rooms: &[Sums]) -> Sums {
    rooms.iter().copied().sum()
}

#[test]
fn alterations_test_what_was_learned_elsewhere() {
    let plain =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/support/easy.toml")).expect("a world");
    let folder = TempDir::new().expect("a folder");
    // The charger in the other room.
    let moved = folder.path().join("moved.toml");
    std::fs::write(&moved, plain.replace("[0, 30, 20, 70]", "[136, 30, 156, 70]")).expect("a file");
    let text = format!(
        "[transfer.same]\nnoise = {{}}\n[transfer.loud]\nnoise = {{ sonar = 0.5, compass = 90.0, kind = 'uniform' }}\n\
         [transfer.moved]\nworld = {moved:?}\nnoise = {{ light = 0.0 }}\n"
    );
    let plan = short(&text, &["evaluate.episodes=30", "seeds='0..2'"]);
    let group = only_group(&plan);
    let (results, memory) = trained(&plan, &group);
    let root = number(&plan, "go-home");
    for (learner, result) in results.iter().enumerate() {
        let last = |variant: u32| {
            let tests: Vec<_> = result.tests.iter().filter(|test| test.variant == variant).collect();
            (*tests.last().expect("a test"), tests.len())
        };
        let (home, tests) = last(0);
        // Every skill twice and the root at 0, 3 and 8 trials; below it those that have trials.
        assert_eq!((home.skill as usize, home.trials), (root, 8), "{tests} tests");
        for variant in 1..4 {
            let (test, count) = last(variant);
            assert_eq!((count, test.skill as usize, test.trials, test.actions), (1, root, 8, home.actions));
            assert_eq!(summed(&test.rooms).episodes, 30);
        }
        // Nothing altered: the same random give the same trials.
        assert_eq!(last(1).0.rooms, home.rooms);
        assert_ne!(last(2).0.rooms, home.rooms);
        // In the moved world: what the learner does there when it is put there.
        let mut there = memory.clone();
        there.shared.clone_from(&group.altered[2]);
        let noise = plan.alterations[2].noise.expect("noise");
        let own = plan.arms[0].noise;
        assert_eq!((noise.light, noise.sonar, noise.kind), (0.0, own.sonar, own.kind));
        for params in &mut there.params {
            params.noise.light = 0.0;
        }
        let mut backend = CpuBackend::new(2, None).expect("threads");
        backend.load(there).expect("memory");
        let tests = backend.evaluate(Test { skill: root as u32, number: 8, episodes: 30 }).expect("tests");
        let own = &tests[learner * 30..][..30];
        let found = summed(&last(3).0.rooms);
        assert_eq!(found.successes as usize, own.iter().filter(|episode| episode.state == STATE_ACHIEVED).count());
        assert_eq!(found.steps, own.iter().map(|episode| episode.agent.step).sum::<u32>());
        assert_eq!(found.collisions, own.iter().map(|episode| episode.agent.collisions).sum::<u32>());
    }
}

// Example trials.

#[test]
fn example_trials_are_tests_from_named_places() {
    let silent = "robot.noise={ actuator = 0.0, sonar = 0.0, light = 0.0, compass = 0.0 }";
    let plan = short("", &[silent, "seeds='3..5'", "skill.go-home.applicable={ dock = 'learned' }"]);
    let group = only_group(&plan);
    let (results, memory) = trained(&plan, &group);
    let found = trajectories(&plan, &group, &results[0]);
    let places = &plan.world().places;
    assert_eq!((found.len(), places.len()), (1, 1));
    let example = &found[0];
    let (name, start) = &places[0];
    assert_eq!(
        (example.arm.as_str(), example.seed, example.skill.as_str(), &example.place),
        ("base", 3, "go-home", name)
    );
    assert_eq!(
        (example.children.as_slice(), example.world.as_str()),
        (&["leave".to_owned(), "dock".to_owned()][..], "world.toml")
    );

    // The same trial, step by step, from the learner's memory.
    let (params, nets) = (&memory.params[..memory.skills], &memory.nets[..memory.nets_stride]);
    let root = memory.skills - 1;
    let mut episode = Episode { state: 1, ..Episode::zeroed() };
    skilltree::policy::hierarchy::place(&mut episode.agent, &memory.shared, *start);
    let dispatch = skilltree::layout::Dispatch {
        iterations: 1,
        test_skill: root as u32,
        test_number: 0xff_ffff,
        ..Zeroable::zeroed()
    };
    let mut expected = Vec::new();
    while episode.state == 1 {
        let before = episode.agent;
        skilltree::kernels::evaluate::evaluate(&mut episode, &memory.shared, params, nets, &dispatch, 0);
        expected.push((before.x, before.y, before.heading, episode.agent.run[root] & 0xff));
    }
    let points: Vec<_> = example.points.iter().map(|p| (p.x, p.y, p.heading, p.child)).collect();
    assert_eq!(points, expected);
    assert_eq!(example.achieved, episode.state == STATE_ACHIEVED);
    assert_eq!(points[0], (start.x, start.y, start.heading, points[0].3));
    // Without noise a step is a turn by 15 or 60 degrees, or a move by 12 inches unless something stops it.
    for (one, two) in points.iter().zip(&points[1..]) {
        let way = (two.0 - one.0).hypot(two.1 - one.1);
        let turn = ((two.2 - one.2 + 540.0).rem_euclid(360.0) - 180.0).abs();
        let moved = turn == 0.0 && way < 12.001;
        assert!(
            moved || (way == 0.0 && [15.0, 60.0].iter().any(|size| (turn - size).abs() < 1.0e-3)),
            "{one:?} {two:?}"
        );
    }
}
