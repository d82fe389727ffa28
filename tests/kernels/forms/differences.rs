//! Every word in which two results differ has its name, and the first difference is the one that is reported.

use super::super::work::{FIVE, GROWN};
use bytemuck::Zeroable;
use skilltree::backend::{Cohort, parity};
use skilltree::layout::{Episode, LearnerState, PHASE_FAILED, Robot};
use std::mem::offset_of;

/// Words of a state.
const STATE_WORDS: usize = size_of::<LearnerState>() / 4;

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
        let says = format!("kernel train, learner 3: {field}: {:#010x} against {:#010x}", found.left, found.right);
        assert_eq!((found.to_string(), found.left), (says, found.right ^ 1));
    };
    flip(&mut other.rows, at(cohort.rows_stride, 12));
    says(&other, "rows word 12 (row 1, reward)");
    let lesson = (plan.lesson_stride + 4 + 2 * 10 + 7) as usize;
    flip(&mut other.lessons, at(cohort.lessons_stride, lesson));
    says(&other, &format!("lessons word {lesson} (skill 0, slot 1, step 2, observation.compass)"));
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
        flip(bytemuck::cast_slice_mut(&mut other.states), 3 * STATE_WORDS + offset / 4);
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
        (0, 1, 3, "observation.sonar 3"),
        (0, 1, 7, "observation.compass"),
        (5, 0, 8, "choice"),
        (6, 2, 10, "high_level"),
        (6, 0, 16, "door_sine"),
        (6, 1, 17, "value 0"),
    ] {
        let plan = &skills[skill];
        let at = (plan.memory_offset + 4 + step * plan.record_words) as usize + word;
        let text = format!("lessons word {at} (skill {skill}, slot 0, step {step}, {name})");
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
    let says = "kernel train, learner 1: nets word 40 (skill 0, child 0, weight of input 1, unit 8): \
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
    robots[1].sensed.compass = f32::NAN;
    let found = parity::step(&robots, &robots).expect("a difference");
    let says = "kernel step, robot 1: sensed.compass: 0x7fc00000 against 0x7fc00000, not finite";
    assert_eq!(found.to_string(), says);
    assert!(parity::evaluate(&episodes[..3], &episodes, 3).is_some() && parity::step(&robots[..1], &robots).is_some());
}
