//! Thresholds that are learned from what the skills below remember.

use super::super::configs::number;
use super::super::lessons::remembered;
use super::super::nets64::{Nets64, Tree64, inputs64, most};
use super::super::random::random;
use super::persistence::members;
use super::three_levels::{home, only_group, reach};
use skilltree::backend::cpu::cpu_backend;
use skilltree::backend::{Backend, Cohort, Stop};
use skilltree::config::plan::Plan;
use skilltree::layout::TERMINATED;
use skilltree::run_folder::weights::read_weights;
use skilltree::run_folder::{Provenance, RunFolder};
use skilltree::train::batch::{pretrain, train};
use skilltree::train::batch_group::BatchGroup;
use skilltree::train::result::LearnerResult;
use skilltree::train::run::{Options, run};
use tempfile::TempDir;

/// All that the plan's only arm leaves, and its learners' memory.
pub(super) fn trained(plan: &Plan, group: &BatchGroup) -> (Vec<LearnerResult>, Cohort) {
    let mut backend = cpu_backend(2, None).expect("threads");
    let ids = group.learners(plan);
    let below = pretrain(plan, group, &ids, None, &mut backend, &mut ()).expect("the CPU does not fail");
    let pretrained = |id| below.iter().find(|learner| learner.id == id);
    let results = train(plan, group, &ids, &pretrained, None, &mut backend, &mut ()).expect("the CPU does not fail");
    let memory = backend.memory().expect("memory").clone();
    (results, memory)
}

/// Best value of a skill at each step of the later half of its remembered trials, and whether the trial succeeded.
fn seen(plan: &Plan, cohort: &Cohort, learner: usize, skill: usize) -> Vec<(f64, bool)> {
    let (own, shape) = (&plan.arms[0].skills[skill], &cohort.shared.skills[skill]);
    let nets = Nets64::of(&cohort.nets[learner * cohort.nets_stride..][..cohort.nets_stride], shape);
    let lessons = remembered(cohort, learner, skill);
    let kept = own.params.trials.min(own.params.replay_capacity);
    let latest = (0..own.params.trials).rev().take(kept.div_ceil(2) as usize);
    let mut seen = Vec::new();
    for trial in latest {
        let lesson = &lessons[(trial % own.params.replay_capacity) as usize];
        for step in lesson.steps() {
            seen.push((most(nets.values(&inputs64(own, 2, step))), lesson.header.end == TERMINATED));
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
    let mut backend = cpu_backend(2, None).expect("threads");
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
        let trials = remembered(&memory, learner, root);
        assert_eq!(trials.len(), 12);
        for trial in &trials {
            for record in trial.steps() {
                let applicable = members(record.high_level >> 8 & 0xff);
                for (child, threshold) in result.thresholds.iter().enumerate().take(2) {
                    let worth = record.value[child];
                    assert_eq!(applicable.contains(&child), worth > *threshold);
                    decided[child][usize::from(worth > *threshold)] += 1;
                }
                let worth = record.value[1];
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
    let mut next = random(61);
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
