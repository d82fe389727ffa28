//! Nets, forwards and backwards.

use super::super::configs::shipped;
use super::super::learner::Learner;
use super::super::observations::made_up;
use super::super::random::random;
use super::{beside, compare};
use skilltree::env::workgroup::{HotForms, Nets, Workgroup};
use skilltree::kernels::plain::PLAIN;
use skilltree::layout::Observation;

/// Learners with nets of all sizes and kinds, one for each optimiser.
fn learners() -> Vec<Learner> {
    let mut learners = Vec::new();
    for hidden in ["32", "20", "16", "5"] {
        for shared_net in ["true", "false"] {
            for optimiser in ["sgd", "adam", "adam-rows"] {
                let set = [
                    "arms=['taught-adam']".to_owned(),
                    "seeds='0'".to_owned(),
                    "learning.init_range=0.5".to_owned(),
                    format!("learning.hidden={hidden}"),
                    format!("learning.shared_net={shared_net}"),
                    format!("arm.taught-adam.learning.optimiser='{optimiser}'"),
                ];
                let set: Vec<&str> = set.iter().map(String::as_str).collect();
                learners.push(Learner::new(shipped("configs/docking.toml", &set)));
            }
        }
    }
    learners
}

/// Steps of a net: what is seen, the child that learns, its error and the learning rate.
type Lesson = Vec<(Observation, u32, f32, f32)>;

fn lesson(next: &mut impl FnMut() -> f64) -> Lesson {
    let mut step = || {
        let made = made_up(next);
        // Bumpers and light that are not there leave more inputs out.
        let made = if next() < 0.5 { Observation { light_bumpers: 0, ..made } } else { made };
        (made, (next() * 6.0) as u32, (next() * 4.0 - 2.0) as f32, (next() * 0.1) as f32)
    };
    (0..6).map(|_| step()).collect()
}

/// Inputs, values, hidden units and odds at each step, and the nets after the last one.
fn learned(learner: &Learner, forms: &HotForms, lesson: &Lesson) -> Vec<u32> {
    let mut nets = learner.nets.clone();
    let mut group =
        Workgroup { nets: Nets::Trained(&mut nets), ..Workgroup::new(&learner.shared, &learner.params, forms) };
    let mut words = Vec::new();
    for (observation, child, delta, rate) in lesson {
        group.record.observation = *observation;
        (forms.encode)(&mut group, 0, child % 2 == 1);
        words.extend(group.inputs.map(f32::to_bits));
        (forms.forward)(&mut group, 0);
        words.extend(group.q.map(f32::to_bits));
        let found = (forms.boltzmann)(&mut group, 6, 0b11_0101 | 1 << child, 20.0);
        words.extend([found.best.to_bits(), found.greedy, found.total.to_bits()]);
        words.extend(group.weights.map(f32::to_bits));
        let nets = learner.shared.skills[0].nets as usize;
        words.extend(group.hidden[..nets].iter().flatten().map(|unit| unit.to_bits()));
        (forms.backward)(&mut group, 0, *child, *delta, *rate);
    }
    words.extend(nets.iter().map(|weight| weight.to_bits()));
    words
}

#[test]
fn nets_learn_as_in_the_plain_form() {
    let forward = HotForms {
        forward: |group, skill| {
            group.inputs[7] = beside(group.inputs[7]);
            group.forward(skill);
        },
        ..PLAIN
    };
    let encode = HotForms {
        encode: |group, skill, mirrored| {
            group.encode(skill, mirrored);
            group.inputs[7] = beside(group.inputs[7]);
        },
        ..PLAIN
    };
    let boltzmann = HotForms {
        boltzmann: |group, children, allowed, inverse_temperature| {
            group.boltzmann(children, allowed, beside(inverse_temperature))
        },
        ..PLAIN
    };
    let backward = HotForms {
        backward: |group, skill, child, delta, rate| group.backward(skill, child, beside(delta), rate),
        ..PLAIN
    };
    let mut next = random(74);
    for learner in learners() {
        let lessons: Vec<Lesson> = (0..15).map(|_| lesson(&mut next)).collect();
        for faulty in [&encode, &forward, &boltzmann, &backward] {
            compare(&lessons, faulty, |forms, lesson| learned(&learner, forms, lesson));
        }
    }
}
