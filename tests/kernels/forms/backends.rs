//! Whole cohorts on the reference backend and on the CPU.

use super::super::work::{DOCKING, FIVE, GROWN, TREE, cpu, on_host, optimisers, reference, some};
use super::beside;
use skilltree::backend::host::{HostBackend, HostForms};
use skilltree::backend::parity::{self, Difference};
use skilltree::backend::reference::REFERENCE;
use skilltree::backend::{Backend, Test};
use skilltree::env::workgroup::HotForms;
use skilltree::kernels::plain::PLAIN;
use skilltree::layout::{Boltzmann, Episode, Moved, PHASE_DONE};
use skilltree::train::parity::train;

#[test]
fn docking_and_given_actions_are_the_same() {
    let expected = DOCKING.run(&mut reference()).expect("it runs");
    let found = DOCKING.run(&mut cpu()).expect("it runs");
    assert_eq!(expected.difference(&found), None);
    assert!(expected.cohorts()[0].states.iter().all(|state| state.phase == PHASE_DONE && state.updates > 50));
}

/// Shared nets, a skill in a mirror, the planner's table, tests of every skill.
#[test]
fn trees_are_the_same() {
    assert_eq!(GROWN.difference(&TREE.run(&mut reference()).expect("it runs")), None);
    let skills = &GROWN.cohorts()[0].shared.skills;
    assert!(skills[2].mirrored == 1 && skills[4].planned > 0 && skills[5].outputs == 3);
}

#[test]
fn every_optimiser_and_size_of_net_is_the_same() {
    for hidden in ["learning.hidden=16", "learning.hidden=32"] {
        for shared_net in ["learning.shared_net=true", "learning.shared_net=false"] {
            let after = on_host(&optimisers(&[hidden, shared_net]));
            assert!(after.cohorts()[0].states.iter().all(|state| state.updates > 20), "{hidden} {shared_net}");
        }
    }
}

/// The plain twins with a fault each: one bit of what a hot function takes or leaves.
static FAULTY: [HostForms; 8] = [
    with_fault(
        "draw_step",
        HotForms {
            draw_step: |group, stream| {
                group.random.draw_step(stream);
                group.random.x[7] ^= 1 << 15;
            },
            ..PLAIN
        },
    ),
    with_fault(
        "observe",
        HotForms {
            observe: |group, x, y, heading, bumpers, noise| {
                group.observe(x, y, heading, bumpers, noise);
                group.record.observation.sonar[5] ^= 1 << 24;
            },
            ..PLAIN
        },
    ),
    with_fault(
        "move_body",
        HotForms {
            move_body: |group, x, y, heading, action, slip| {
                let moved = group.move_body(x, y, heading, action, slip);
                Moved { heading: beside(moved.heading), ..moved }
            },
            ..PLAIN
        },
    ),
    with_fault(
        "encode",
        HotForms {
            encode: |group, skill, mirrored| {
                group.encode(skill, mirrored);
                group.inputs[2] = beside(group.inputs[2]);
            },
            ..PLAIN
        },
    ),
    with_fault(
        "forward",
        HotForms {
            forward: |group, skill| {
                group.forward(skill);
                group.q[2] = beside(group.q[2]);
            },
            ..PLAIN
        },
    ),
    with_fault(
        "boltzmann",
        HotForms {
            boltzmann: |group, children, allowed, inverse_temperature| {
                let found = group.boltzmann(children, allowed, inverse_temperature);
                Boltzmann { best: beside(found.best), ..found }
            },
            ..PLAIN
        },
    ),
    with_fault(
        "backward",
        HotForms {
            backward: |group, skill, child, delta, rate| group.backward(skill, child, beside(delta), rate),
            ..PLAIN
        },
    ),
    HostForms {
        kind: "step",
        step: |robots, shared, iterations| {
            (REFERENCE.step)(robots, shared, iterations);
            robots[0].heading = beside(robots[0].heading);
        },
        ..REFERENCE
    },
];

const fn with_fault(kind: &'static str, hot: HotForms) -> HostForms {
    HostForms { kind, hot, ..REFERENCE }
}

fn faulty(kind: &str) -> HostBackend {
    let forms = FAULTY.iter().find(|forms| forms.kind == kind).expect("a fault of this name");
    HostBackend::new(forms, 0, None).expect("threads")
}

#[test]
fn one_bit_in_any_hot_function_is_named() {
    let differs = |kind: &str| -> Difference {
        let found = train(some(&DOCKING.cohorts()[0], 0..5), &mut faulty(kind)).expect("it runs");
        parity::advance(&FIVE.cohorts()[0], &found.cohorts()[0]).unwrap_or_else(|| panic!("`{kind}` is not found out"))
    };
    for kind in ["draw_step", "observe", "move_body", "encode", "forward", "boltzmann", "backward"] {
        let found = differs(kind);
        assert_eq!((found.kernel, found.learner, found.finite), ("train", 0, true), "{kind}: {found}");
        assert_ne!(found.left, found.right);
    }
}

#[test]
fn one_bit_in_a_test_or_a_robot_is_named() {
    let tested = |backend: &mut HostBackend| -> Vec<Episode> {
        backend.load(FIVE.cohorts()[0].clone()).expect("it fits");
        backend.evaluate(Test { skill: 0, number: 9, episodes: 7 }).expect("it runs")
    };
    let expected = tested(&mut reference());
    assert_eq!(parity::evaluate(&expected, &tested(&mut cpu()), 7), None);
    let found = parity::evaluate(&expected, &tested(&mut faulty("move_body")), 7).expect("a difference");
    assert_eq!((found.kernel, found.field.as_str()), ("evaluate", "test trial 0, agent.x"), "{found}");
    let walked = |backend: &mut HostBackend| DOCKING.walk(backend).expect("it runs");
    let found = walked(&mut reference()).difference(&walked(&mut faulty("step"))).expect("a difference");
    assert_eq!((found.kernel, found.learner), ("step", 0), "{found}");
    assert!(found.field.starts_with("heading, in action 1 "), "{found}");
}
