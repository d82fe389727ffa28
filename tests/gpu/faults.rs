//! A kernel that is broken on purpose is found out and named.

use super::broken::{broken, with};
use super::work::{DOCKING, FIVE, cpu, some};
use skilltree::backend::UNWRITTEN;
use skilltree::backend::gpu::source::{EVALUATE, STEP, TRAIN};
use skilltree::backend::parity::{self, Difference};
use skilltree::backend::{Backend, Test};
use skilltree::layout::Robot;
use skilltree::train::observation::{SILENT, robot_at};
use skilltree::train::parity::train;
use skilltree::world::Pose;

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
fn faults_of_train_are_named() {
    let kernel = broken(
        TRAIN,
        &[
            // One last place in one lane.
            (
                "qnet/forward.wgsl",
                "activation = tanh(sum);",
                "activation = tanh(sum);
                if lane == 5u && nets_base == 2u * dispatch.nets_stride {
                    activation = bitcast<f32>(bitcast<u32>(activation) + 1u);
                }",
            ),
            // A word that is never written: zeroes would hide it.
            (
                "learn/lesson.wgsl",
                "collisions, taught);",
                "collisions,
                    select(taught, rows[rows_base + state.rows].taught, rows_base == dispatch.rows_stride));",
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
    let mut found =
        with(kernel, TRAIN, |gpu| train(some(&DOCKING.cohorts()[0], 0..5), gpu)).expect("it runs").cohorts()[0].clone();
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
        [1, 2, 3, 4].map(|k| ("train", k))
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
                "apply_action(lane, root, action);",
                "apply_action(lane, root, action);
                if lane == 0u && learner == 2u && number == 5u && agent.step == 1u {
                    agent.x = bitcast<f32>(bitcast<u32>(agent.x) + 1u);
                }",
            ),
            (
                "kernels/evaluate.wgsl",
                "episode.start_y = pose.y;",
                "if params_base != dispatch.skills { episode.start_y = pose.y; }",
            ),
            (
                "kernels/evaluate.wgsl",
                "nets_base = learner * dispatch.nets_stride;",
                "nets_base = select(learner, 7u - learner, learner >= 3u) * dispatch.nets_stride;",
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
            "sonar_reading(range, error)",
            "sonar_reading(select(range, bitcast<f32>(bitcast<u32>(range) + 1u), lane == 0u), error)",
        )],
    );
    let x = |place: u32| f32::from_bits(24.5_f32.to_bits() - 32 + place);
    let robots: Vec<Robot> =
        (0..64).map(|place| robot_at(Pose { x: x(place), y: 200.0, heading: 180.0 }, &SILENT, 0, 0)).collect();
    let shared = &DOCKING.cohorts()[0].shared;
    let (mut expected, mut found) = (robots.clone(), robots);
    cpu().step(shared, &mut expected, 1).expect("it runs");
    let ahead = |robot: &Robot| robot.sensed.sonar[0] & 0xff;
    let edge = expected.iter().rposition(|robot| ahead(robot) == 24).expect("one that reads 24 inches");
    with(kernel, STEP, |gpu| gpu.step(shared, &mut found, 1)).expect("it runs");
    let found = parity::step(&expected, &found).expect("a difference");
    assert_eq!((found.kernel, found.learner), ("step", edge), "{found}");
    assert_eq!((found.left & 0xff, found.right & 0xff), (24, 25), "{found}");
    assert_eq!(found.field, "sensed.sonar 0");
}
