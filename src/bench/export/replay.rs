//! Tensors of `replay.safetensors`.

use super::{PASSES, Tensor, Words, object};
use crate::backend::Backend;
use crate::backend::cpu::CpuBackend;
use crate::bench::replay::{Drill, Nets, encode};
use crate::bench::workload::{self, DOCKING};
use crate::bench::{BenchError, same};
use crate::layout::{BASE_WORDS, LANES, LESSON_HEADER};
use serde_json::{Map, Value, json};

/// The layers of a net as it begins.
const INITIAL: [Words; 4] = [
    ("initial.hidden.weight", "", "before any replay: weight of each input in each hidden unit"),
    ("initial.hidden.bias", "", "before any replay"),
    ("initial.output.weight", "", "before any replay: weight of each hidden unit"),
    ("initial.output.bias", "", "before any replay"),
];
/// The same after one pass.
const ONCE: [Words; 4] = [
    ("once.hidden.weight", "", "after one pass over the lessons"),
    ("once.hidden.bias", "", "after one pass"),
    ("once.output.weight", "", "after one pass"),
    ("once.output.bias", "", "after one pass"),
];
/// The same after all passes.
const EXPECTED: [Words; 4] = [
    ("expected.hidden.weight", "", "after all passes over the lessons"),
    ("expected.hidden.bias", "", "after all passes"),
    ("expected.output.weight", "", "after all passes"),
    ("expected.output.bias", "", "after all passes"),
];

/// What the learners learn from and what becomes of their nets, made by the CPU backend and checked by the reference.
pub(super) fn replay(learners: u32) -> Result<(Vec<Tensor>, Map<String, Value>), BenchError> {
    let passes = format!("learning.pretrain_epochs={PASSES}");
    let set = ["arms=[\"taught-adam\"]", "teacher.eval_episodes=1", "skill.dock.trials=0", &passes];
    let plan = workload::plan(DOCKING, &set, learners)?;
    let drill = Drill::new(&plan)?;
    let (skill, shared, params) = (*drill.skill(), &drill.cohort().shared, *drill.params(0));
    let (bank, steps, inputs) = (skill.bank_lessons as usize, params.max_steps as usize, skill.inputs as usize);
    let (mut length, mut input) = (vec![0; bank], vec![0.0; bank * steps * inputs]);
    let (mut child, mut reward) = (vec![0; bank * steps], vec![0.0; bank * steps]);
    for lesson in 0..bank {
        let at = skill.bank_offset as usize + lesson * skill.lesson_stride as usize;
        let words = &shared.bank[at..at + skill.lesson_stride as usize];
        length[lesson] = words[0] as i32;
        for (step, record) in words[LESSON_HEADER..].as_chunks::<BASE_WORDS>().0[..words[0] as usize].iter().enumerate()
        {
            let row = lesson * steps + step;
            input[row * inputs..(row + 1) * inputs].copy_from_slice(&encode(record, &skill, &shared.tables));
            child[row] = (record[8] & 0xff) as i32;
            reward[row] = f32::from_bits(record[9]) * params.value_scale;
        }
    }
    let given: Vec<i32> = (0..learners as usize)
        .flat_map(|learner| (0..params.lessons).map(move |number| (learner, number)))
        .map(|(learner, number)| drill.lesson_of(learner, number) - skill.bank_offset as usize)
        .map(|word| (word / skill.lesson_stride as usize) as i32)
        .collect();

    let weights = |nets: &[Nets]| nets.iter().flat_map(Nets::weights).collect::<Vec<f32>>();
    let mut nets = drill.nets(drill.cohort());
    let initial = weights(&nets);
    drill.replay_scalar(&mut nets, 1);
    let once = weights(&nets);
    drill.replay_scalar(&mut nets, PASSES - 1);
    let all = weights(&nets);
    let mut backend = CpuBackend::new(0, None)?;
    backend.load(drill.cohort().clone())?;
    Drill::replay(&mut backend)?;
    let ours = weights(&drill.nets(backend.memory()?));
    same("replay", ("cpu", bytemuck::cast_slice(&ours)), ("scalar", bytemuck::cast_slice(&all)))?;

    let (learners, children) = (learners as usize, skill.children as usize);
    let lessons = params.lessons as usize;
    let mut tensors = vec![
        Tensor::codes(("lesson.length", "", "steps of each lesson in the bank"), &[bank], &length),
        Tensor::floats(
            ("lesson.input", "", "encoded observation before each step; 0 beyond the length"),
            &[bank, steps, inputs],
            &input,
        ),
        Tensor::codes(("lesson.child", "", "which child was taken: the net that learns"), &[bank, steps], &child),
        Tensor::floats(("lesson.reward", "Q", "reward of the step, divided by 100"), &[bank, steps], &reward),
        Tensor::codes(("lesson", "", "lessons of each learner, in the order of replay"), &[learners, lessons], &given),
    ];
    let stages = [(INITIAL, initial), (ONCE, once), (EXPECTED, all)];
    for (names, weights) in &stages {
        for (words, (shape, values)) in names.iter().zip(layers(weights, inputs)) {
            tensors.push(Tensor::floats(*words, &[vec![learners, children], shape].concat(), &values));
        }
    }
    let numbers = json!({
        "passes": PASSES,
        "transitions": drill.transitions(PASSES),
        "gamma": params.gamma,
        "lambda": params.lambda,
        "rate": params.learning_rate,
        "beta1": params.beta1,
        "beta2": params.beta2,
        "epsilon2": params.epsilon2,
        "target_clip": params.target_clip,
        "hidden": LANES,
    });
    Ok((tensors, object(numbers)))
}

/// One layer of all nets of all learners: the shape of one net's part, and the values.
type Layer = (Vec<usize>, Vec<f32>);

/// The four layers, from [`Nets::weights`] of all learners.
fn layers(weights: &[f32], inputs: usize) -> [Layer; 4] {
    let unit = inputs + 1;
    let hidden = LANES * unit;
    let nets = || weights.chunks_exact(hidden + LANES + 1);
    let units = || nets().flat_map(|net| net[..hidden].chunks_exact(unit));
    [
        (vec![LANES, inputs], units().flat_map(|unit| &unit[..inputs]).copied().collect()),
        (vec![LANES], units().map(|unit| unit[inputs]).collect()),
        (vec![LANES], nets().flat_map(|net| &net[hidden..hidden + LANES]).copied().collect()),
        (vec![], nets().map(|net| net[hidden + LANES]).collect()),
    ]
}
