//! What is made of a trained tree: tests under other circumstances, and example trials.

use super::super::configs::{SILENT, file, number};
use super::pretraining::short;
use super::three_levels::only_group;
use super::thresholds::trained;
use bytemuck::Zeroable;
use skilltree::backend::cpu::cpu_backend;
use skilltree::backend::{Backend, Test};
use skilltree::env::workgroup::{Nets, Workgroup};
use skilltree::kernels::plain::PLAIN;
use skilltree::layout::{Dispatch, EPISODE_RUNNING, EPISODE_TERMINATED, Episode};
use skilltree::policy::applicability::run_child;
use skilltree::run_folder::Sums;
use skilltree::train::trajectories::trajectories;
use tempfile::TempDir;

fn summed(rooms: &[Sums]) -> Sums {
    rooms.iter().fold(Sums::default(), |mut sum, room| {
        sum += *room;
        sum
    })
}

#[test]
fn alterations_test_what_was_learned_elsewhere() {
    let plain = std::fs::read_to_string(file("tests/support/easy.toml")).expect("a world");
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
        let mut backend = cpu_backend(2, None).expect("threads");
        backend.load(there).expect("memory");
        let tests = backend.evaluate(Test { skill: root as u32, number: 8, episodes: 30 }).expect("tests");
        let own = &tests[learner * 30..][..30];
        let found = summed(&last(3).0.rooms);
        assert_eq!(found.successes as usize, own.iter().filter(|episode| episode.state == EPISODE_TERMINATED).count());
        assert_eq!(found.steps, own.iter().map(|episode| episode.agent.step).sum::<u32>());
        assert_eq!(found.collisions, own.iter().map(|episode| episode.agent.collisions).sum::<u32>());
    }
}

#[test]
fn example_trials_are_tests_from_named_places() {
    let plan = short("", &[SILENT, "seeds='3..5'", "skill.go-home.applicable={ dock = 'learned' }"]);
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
    let dispatch = Dispatch { iterations: 1, test_skill: root as u32, test_number: 0xff_ffff, ..Dispatch::zeroed() };
    let group = Workgroup::new(&memory.shared, params, &PLAIN);
    let mut group = Workgroup { dispatch, nets: Nets::Read(nets), ..group };
    group.reset(*start);
    let mut episode = Episode { state: EPISODE_RUNNING, agent: group.agent, ..Episode::zeroed() };
    let mut expected = Vec::new();
    while episode.state == EPISODE_RUNNING {
        let before = episode.agent;
        group.evaluate(&mut episode, 0);
        expected.push((before.x, before.y, before.heading, run_child(episode.agent.run[root])));
    }
    let points: Vec<_> = example.points.iter().map(|p| (p.x, p.y, p.heading, p.child)).collect();
    assert_eq!(points, expected);
    assert_eq!(example.achieved, episode.state == EPISODE_TERMINATED);
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
