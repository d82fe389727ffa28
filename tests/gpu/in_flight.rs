//! Dispatches follow one another without a gap, are timed one by one, and leave the same bytes however many are in
//! flight.

use super::adapter::{gpu, opened};
use super::work::{END, TREE, cpu};
use skilltree::backend::gpu::in_flight::IN_FLIGHT;
use skilltree::backend::gpu::{GpuBackend, GpuOptions};
use skilltree::backend::{Backend, Test, parity};
use skilltree::layout::Robot;
use skilltree::train::observation::{SILENT, robot_at};
use skilltree::train::parity::train;
use skilltree::world::Pose;
use std::time::Instant;

fn open(iterations: u32, in_flight: Option<usize>) -> GpuBackend {
    let options = GpuOptions { iterations: Some(iterations), shard: Some(3), in_flight, ..GpuOptions::default() };
    opened(&options)
}

fn robots() -> Vec<Robot> {
    let pose = |number: u32| Pose { x: 40.0 + (number % 32) as f32, y: 60.0, heading: number as f32 };
    (0..4096).map(|number| robot_at(pose(number), &SILENT, 0, number)).collect()
}

/// A piece of work for each kernel; each takes several dispatches.
fn advance(gpu: &mut GpuBackend) {
    gpu.load(TREE.cohorts()[0].clone()).expect("it fits");
    while !gpu.advance(END).expect("it runs").iter().all(|state| END.holds(state)) {}
}

fn evaluate(gpu: &mut GpuBackend) {
    gpu.load(TREE.cohorts()[0].clone()).expect("it fits");
    gpu.evaluate(Test { skill: 6, number: 3, episodes: 40 }).expect("it runs");
}

fn step(gpu: &mut GpuBackend) {
    gpu.step(&TREE.cohorts()[0].shared, &mut robots(), 6).expect("it runs");
}

#[test]
fn the_next_dispatch_is_submitted_before_the_one_before_is_waited_for() {
    let _alone = gpu();
    for limit in [1, IN_FLIGHT] {
        let mut gpu = open(2, Some(limit));
        for work in [advance, evaluate, step] {
            gpu.traffic().most = 0;
            work(&mut gpu);
            assert_eq!(gpu.traffic().most, limit);
        }
    }
    assert_eq!(IN_FLIGHT, 2);
}

#[test]
fn dispatches_are_timed_one_by_one() {
    let _alone = gpu();
    let mut gpu = open(1, None);
    for work in [evaluate, step] {
        work(&mut gpu);
        let (before, begun) = (gpu.traffic().spent, Instant::now());
        work(&mut gpu);
        let (spent, wall) = (gpu.traffic().spent - before, begun.elapsed());
        assert_eq!(gpu.traffic().most, IN_FLIGHT);
        // From their submission on they would add up to nearly twice the time that passed.
        assert!(spent <= wall && 10 * spent >= wall, "{spent:?} of {wall:?}");
    }
}

#[test]
fn no_number_in_flight_changes_a_byte() {
    let _alone = gpu();
    let cohort = &TREE.cohorts()[0];
    let mut cpu = cpu();
    let expected = train(cohort.clone(), &mut cpu).expect("it runs");
    let mut moved = robots();
    cpu.step(&cohort.shared, &mut moved, 6).expect("it runs");
    for (iterations, in_flight) in [(3, 1), (7, 2), (50, 5)] {
        let mut gpu = open(iterations, Some(in_flight));
        let found = train(cohort.clone(), &mut gpu).expect("it runs");
        assert_eq!(expected.difference(&found), None, "{iterations} iterations, {in_flight} in flight");
        let mut robots = robots();
        gpu.step(&cohort.shared, &mut robots, 6).expect("it runs");
        assert_eq!(parity::step(&moved, &robots), None, "{iterations} iterations, {in_flight} in flight");
    }
}
