//! Tensors of `replay.safetensors`.

use super::tensor::ExportTensors;
use crate::backend::Cohort;
use crate::bench::benchmarks::UpdateRule;
use crate::bench::executor::open_cpu;
use crate::bench::taught_replay::TaughtReplay;
use crate::bench::{BenchError, compare};
use crate::env::workgroup::Workgroup;
use crate::kernels::plain::PLAIN;
use crate::layout::{LANES, LearnerState};
use crate::learn::lesson::{LESSON_STEPS, choice_child};
use bytemuck::Zeroable;
use serde_json::json;

/// Passes over each learner's lessons.
const PASSES: u32 = 30;
/// The layers of a net, as most programs name them.
const LAYERS: [&str; 4] = ["hidden.weight", "hidden.bias", "output.weight", "output.bias"];
/// What they are before any replay.
const INITIAL: [&str; 4] = [
    "before any replay: weight of each input in each hidden unit",
    "before any replay",
    "before any replay: weight of each hidden unit",
    "before any replay",
];
/// The same after one pass.
const ONCE: [&str; 4] = ["after one pass over the lessons", "after one pass", "after one pass", "after one pass"];
/// The same after all passes.
const EXPECTED: [&str; 4] =
    ["after all passes over the lessons", "after all passes", "after all passes", "after all passes"];

/// What the learners learn from and what becomes of their nets, the same by every executor on the CPU.
pub(super) fn replay(learners: u32) -> Result<ExportTensors, BenchError> {
    let replay = TaughtReplay::new(&UpdateRule::ALL[0].plan(learners, PASSES)?)?;
    let (skill, shared, params) = (*replay.skill(), &replay.cohort.shared, *replay.params(0));
    let (bank, steps, inputs) = (skill.bank_lessons as usize, params.max_steps as usize, skill.inputs as usize);
    let (mut length, mut input) = (vec![0; bank], vec![0.0; bank * steps * inputs]);
    let (mut child, mut reward) = (vec![0; bank * steps], vec![0.0; bank * steps]);
    for lesson in 0..bank {
        let at = skill.bank_offset as usize + lesson * skill.lesson_stride as usize;
        let mut group = Workgroup {
            state: LearnerState { replay_lesson: at as u32, replay_taught: 1, ..LearnerState::zeroed() },
            ..Workgroup::new(shared, std::slice::from_ref(&params), &PLAIN)
        };
        length[lesson] = group.lesson_word(LESSON_STEPS) as i32;
        for step in 0..length[lesson] as usize {
            group.load_step(step);
            group.encode(0, false);
            let row = lesson * steps + step;
            input[row * inputs..(row + 1) * inputs].copy_from_slice(&group.inputs[..inputs]);
            child[row] = choice_child(group.record.choice) as i32;
            reward[row] = group.record.reward * params.value_scale;
        }
    }
    let given: Vec<i32> = (0..learners as usize)
        .flat_map(|learner| (0..params.lessons).map(move |number| (learner, number)))
        .map(|(learner, number)| replay.lesson_offset(learner, number) - skill.bank_offset as usize)
        .map(|word| (word / skill.lesson_stride as usize) as i32)
        .collect();
    let once = TaughtReplay::new(&UpdateRule::ALL[0].plan(learners, 1)?)?;
    let mut file = ExportTensors::default();
    let lessons = params.lessons as usize;
    file.add("lesson.length", "", "steps of each lesson in the bank", &[bank], &length);
    let meaning = "encoded observation before each step; 0 beyond the length";
    file.add("lesson.input", "", meaning, &[bank, steps, inputs], &input);
    file.add("lesson.child", "", "which child was taken: the net that learns", &[bank, steps], &child);
    file.add("lesson.reward", "Q", "reward of the step, divided by 100", &[bank, steps], &reward);
    let meaning = "lessons of each learner, in the order of replay";
    file.add("lesson", "", meaning, &[learners as usize, lessons], &given);
    let stages = [
        ("initial", INITIAL, nets(&replay.cohort)),
        ("once", ONCE, replayed(&once)?),
        ("expected", EXPECTED, replayed(&replay)?),
    ];
    for (stage, meanings, nets) in &stages {
        for ((layer, meaning), (shape, values)) in LAYERS.iter().zip(meanings).zip(layers(nets, inputs)) {
            let shape = [vec![learners as usize, skill.children as usize], shape].concat();
            file.add(&format!("{stage}.{layer}"), "", meaning, &shape, &values);
        }
    }
    file.numbers = json!({
        "passes": PASSES,
        "transitions": replay.transitions() * u64::from(PASSES),
        "gamma": params.gamma,
        "lambda": params.lambda,
        "rate": params.learning_rate,
        "beta1": params.beta1,
        "beta2": params.beta2,
        "epsilon2": params.epsilon2,
        "target_clip": params.target_clip,
        "hidden": LANES,
    });
    Ok(file)
}

/// The nets after all passes, by every executor on the CPU.
fn replayed(replay: &TaughtReplay) -> Result<Vec<Net>, BenchError> {
    let mut first: Option<Cohort> = None;
    for mut executor in open_cpu()? {
        executor.backend.load(replay.cohort.clone())?;
        TaughtReplay::replay(executor.backend.as_mut())?;
        let found = executor.backend.memory()?;
        let expected = first.get_or_insert_with(|| found.clone());
        let words = bytemuck::cast_slice(&found.nets);
        compare("replay", ("reference", bytemuck::cast_slice(&expected.nets)), (&executor.info.name, words))?;
    }
    Ok(first.as_ref().map(nets).unwrap_or_default())
}

/// Weights of one net, as rows of lanes: one row per input, then the hidden units' biases, the output's weights, and the
/// output's bias in lane 0.
type Net = Vec<[f32; LANES]>;

/// The nets of all learners, child by child.
fn nets(cohort: &Cohort) -> Vec<Net> {
    let skill = &cohort.shared.skills[0];
    let rows =
        |words: &[f32], child: u32| words[skill.net_offset(child)..].as_chunks().0[..skill.rows as usize].to_vec();
    let learners = cohort.nets.chunks(cohort.nets_stride);
    learners.flat_map(|words| (0..skill.children).map(move |child| rows(words, child))).collect()
}

/// One layer of all nets of all learners: the shape of one net's part, and the values.
type Layer = (Vec<usize>, Vec<f32>);

/// The four layers of [`nets`], in the order of most programs.
fn layers(nets: &[Net], inputs: usize) -> [Layer; 4] {
    let unit_inputs =
        |net: &Net| (0..LANES * inputs).map(|place| net[place % inputs][place / inputs]).collect::<Vec<_>>();
    let row = |number: usize| nets.iter().flat_map(|net| net[number]).collect();
    [
        (vec![LANES, inputs], nets.iter().flat_map(unit_inputs).collect()),
        (vec![LANES], row(inputs)),
        (vec![LANES], row(inputs + 1)),
        (vec![], nets.iter().map(|net| net[inputs + 2][0]).collect()),
    ]
}
