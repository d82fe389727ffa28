//! Learning against what is not the product: plain f64 nets with the standard library's tanh, finite differences, the
//! forward view of TD(lambda), returns computed by hand, exact softmax and exact distributions.

#[path = "support/made_up.rs"]
mod made_up;

use made_up::made_up;
use skilltree::backend::cpu::CpuBackend;
use skilltree::backend::{Backend, Cohort, Stop};
use skilltree::config::{Overrides, load, plan::Plan};
use skilltree::env::segments::SegmentGrid;
use skilltree::env::workgroup::{CohortData, Learner, Scratch};
use skilltree::layout::phase::{PHASE_DONE, PHASE_FAILED};
use skilltree::layout::{BASE_WORDS, HyperParams, LANES, LearnerState, MAX_CHILDREN, RECORD_WORDS};
use skilltree::learn::lesson::{CUT, ENDED};
use skilltree::learn::td_lambda::{begin_replay, recent_lesson, replay_step, taught_lesson};
use skilltree::math::functions::tanh;
use skilltree::policy::features::encode;
use skilltree::policy::select::{NO_CHILD, inverse_temperature, pick, weigh};
use skilltree::qnet::backward::{CLOCK_SECOND, backward};
use skilltree::qnet::forward::{forward, net_of};
use skilltree::train::allocate::Shape;
use skilltree::train::batch_group::groups;
use std::path::Path;

/// A learning rate so small that no Q-value changes, and a power of two, so that what was learned can be read off.
const HARDLY: f32 = 1.0 / (1_u64 << 60) as f32;
/// All six actions.
const ALL: u32 = 0x3f;

fn configs() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/configs"))
}

fn plan(set: &[&str]) -> Plan {
    let set = set.iter().map(|argument| (*argument).to_owned()).collect();
    let overrides = Overrides { set, seeds: Some("0".to_owned()), ..Overrides::default() };
    load(&configs().join("docking.toml"), &overrides).unwrap_or_else(|error| panic!("{error}"))
}

fn random(mut state: u64) -> impl FnMut() -> f64 {
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// One learner of the docking skill, without a bank, and its memory.
struct Bench {
    shared: CohortData,
    params: Vec<HyperParams>,
    state: LearnerState,
    nets: Vec<f32>,
    lessons: Vec<u32>,
    rows: Vec<u32>,
}

impl Bench {
    fn new(set: &[&str]) -> Self {
        let plan = plan(set);
        let shape = Shape::new(plan.world(), &[&plan.arms[0]]).expect("the skill fits");
        let (params, state, nets) = shape.learner(&plan.arms[0], plan.run_seed, 0);
        let floor = SegmentGrid::new(&shape.tables.plan, &shape.tables.words);
        Self {
            shared: CohortData { floor, skills: shape.skills, tables: shape.tables.words, bank: vec![0; 4096] },
            params,
            state,
            nets,
            lessons: vec![0; shape.lessons_stride],
            rows: vec![0; shape.rows_stride],
        }
    }

    fn learner(&mut self) -> Learner<'_> {
        Learner {
            shared: &self.shared,
            params: &self.params,
            state: &mut self.state,
            nets: &mut self.nets,
            lessons: &mut self.lessons,
            rows: &mut self.rows,
        }
    }

    /// Puts a lesson both in the bank and in the memory, at word 0.
    fn keep(&mut self, lesson: &Lesson) {
        let mut words = vec![lesson.steps.len() as u32, lesson.end, 0, 0];
        for step in &lesson.steps {
            let mut record = step.senses;
            record[8] = step.child | step.allowed << 8 | step.allowed << 16 | 1 << 31;
            record[9] = step.reward.to_bits();
            words.extend(record);
        }
        let mut record = lesson.last;
        record[8] = NO_CHILD | ALL << 8 | ALL << 16 | 1 << 31;
        words.extend(record);
        self.lessons[..words.len()].copy_from_slice(&words);
        self.bank_len(words.len());
        self.shared.bank[..words.len()].copy_from_slice(&words);
    }

    fn bank_len(&mut self, words: usize) {
        let length = self.shared.bank.len().max(words);
        self.shared.bank.resize(length, 0);
    }

    /// Replays the kept lesson; the returns of its steps, last first.
    fn replay(&mut self, taught: u32) -> Vec<f32> {
        let mut scratch = Scratch::default();
        let mut learner = self.learner();
        begin_replay(&mut learner, 0, taught, 0);
        let mut returns = Vec::new();
        while learner.state.replay_left > 0 || learner.state.replay_open == 1 {
            let open = learner.state.replay_open == 1;
            replay_step(&mut learner, &mut scratch, 0);
            if !open {
                returns.push(learner.state.next_return);
            }
        }
        returns
    }

    fn rows_of_net(&self) -> usize {
        self.shared.skills[0].rows as usize
    }

    fn net(&self, child: u32) -> usize {
        net_of(&self.shared.skills[0], 0, child) as usize
    }

    fn bias(&self, child: u32) -> f32 {
        self.nets[self.net(child) + (self.rows_of_net() - 1) * LANES]
    }
}

#[derive(Debug, Clone, Copy)]
struct Step {
    senses: [u32; BASE_WORDS],
    child: u32,
    /// Bits of the children that could be chosen.
    allowed: u32,
    reward: f32,
}

#[derive(Debug, Clone)]
struct Lesson {
    steps: Vec<Step>,
    last: [u32; BASE_WORDS],
    end: u32,
}

/// Scratch memory with the record of made-up senses.
fn scratch_of(senses: &[u32; BASE_WORDS]) -> Scratch {
    let mut record = [0; RECORD_WORDS];
    record[..BASE_WORDS].copy_from_slice(senses);
    Scratch { record, ..Scratch::default() }
}

/// The inputs that the record's words stand for, from the definition of the coding in the config's documentation.
fn inputs_of(record: &[u32]) -> Vec<f64> {
    let bytes: Vec<u8> = record[..6].iter().flat_map(|word| word.to_le_bytes()).collect();
    let sonar = bytes.iter().map(|d| 2.0 * (-(f64::from(*d) - 12.0) / 60.0).exp() - 1.0);
    let bits = (0..28).map(|bit| f64::from(record[6] >> bit & 1));
    sonar.chain(bits).collect()
}

/// A net in f64: rows of 32 weights, as the module's documentation lays them out.
#[derive(Clone)]
struct Net(Vec<f64>);

impl Net {
    fn of(bench: &Bench, child: u32) -> Self {
        let first = bench.net(child);
        Self(bench.nets[first..first + bench.rows_of_net() * LANES].iter().map(|w| f64::from(*w)).collect())
    }

    fn hidden(&self, x: &[f64]) -> Vec<f64> {
        let sum = |unit: usize| x.iter().enumerate().map(|(i, x)| self.0[i * LANES + unit] * x).sum::<f64>();
        (0..LANES).map(|unit| (sum(unit) + self.0[x.len() * LANES + unit]).tanh()).collect()
    }

    fn value(&self, x: &[f64]) -> f64 {
        let out = &self.0[(x.len() + 1) * LANES..];
        let sum: f64 = self.hidden(x).iter().zip(out).map(|(h, w)| h * w).sum();
        (sum + out[LANES]).tanh()
    }

    /// Slope of 0.5 (goal - Q)^2, by central differences.
    fn differences(&self, x: &[f64], goal: f64) -> Vec<f64> {
        let step = 1.0e-5;
        let loss = |net: &Self| 0.5 * (goal - net.value(x)).powi(2);
        let mut moved = self.clone();
        (0..self.0.len())
            .map(|i| {
                moved.0[i] = self.0[i] + step;
                let above = loss(&moved);
                moved.0[i] = self.0[i] - step;
                let below = loss(&moved);
                moved.0[i] = self.0[i];
                (above - below) / (2.0 * step)
            })
            .collect()
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Compares row by row and as a whole, relative to the size of what is expected. Returns the rows compared.
fn compare(what: &str, found: &[f64], expected: &[f64], share: f64) -> usize {
    let gap = |a: &[f64], b: &[f64]| norm(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>());
    let whole = gap(found, expected) / norm(expected);
    assert!(whole <= share, "{what}: {whole}");
    let mut compared = 0;
    for (row, (found, expected)) in found.chunks(LANES).zip(expected.chunks(LANES)).enumerate() {
        let size = norm(expected);
        if size == 0.0 {
            assert_eq!(norm(found), 0.0, "{what}: row {row}");
        } else {
            assert!(gap(found, expected) <= share * size, "{what}: row {row}: {}", gap(found, expected) / size);
            compared += 1;
        }
    }
    compared
}

#[test]
fn q_values_match_plain_f64_nets() {
    for (init, hidden) in [("0.1", "32"), ("0.5", "20"), ("1.5", "1"), ("2.0", "32")] {
        let set = [format!("learning.init_range={init}"), format!("learning.hidden={hidden}")];
        let mut bench = Bench::new(&[&set[0], &set[1]]);
        let mut next = random(3);
        let mut spread = 0.0_f64;
        for _ in 0..200 {
            let mut scratch = scratch_of(&made_up(&mut next));
            encode(&bench.shared, &mut scratch, &bench.shared.skills[0], false);
            forward(&bench.nets, &mut scratch, &bench.shared.skills[0], &bench.params[0], 0);
            let x = inputs_of(&scratch.record);
            for (i, (found, exact)) in scratch.inputs.iter().zip(&x).enumerate() {
                assert!((f64::from(*found) - exact).abs() < 1.0e-6, "input {i}: {found} for {exact}");
            }
            for child in 0..6 {
                let exact = Net::of(&bench, child).value(&x);
                let found = f64::from(scratch.q[child as usize]);
                assert!((found - exact).abs() <= 1.0e-5, "init {init}: {found} for {exact}");
                spread = spread.max(exact.abs());
            }
            // Other weights each time, biases and all.
            bench.nets.iter_mut().step_by(7).for_each(|w| *w = -*w);
        }
        assert!(spread > 0.05, "{spread}");
        // No two inputs, nor any of the weights, are taken for each other: the net is not symmetric in them.
        let lone = bench.nets.iter().filter(|w| **w != 0.0).count();
        assert!(lone > 6 * 52, "{lone}");
    }
}

#[test]
fn one_replayed_transition_descends_the_gradient() {
    // A large rate, because the change of a weight is exact only next to what it is added to.
    let mut next = random(4);
    for (child, reward) in [(0, 90.0), (1, -70.0), (2, 20.0), (3, 0.0), (4, -99.0), (5, 60.0)] {
        let hidden = if child % 2 == 0 { 20 } else { 12 };
        let units = format!("learning.hidden={hidden}");
        let set = ["learning.optimiser=\"sgd\"", "learning.momentum=0.0", &units, "learning.init_range=0.3"];
        let mut bench = Bench::new(&set);
        bench.params[0].learning_rate = 256.0;
        bench.params[0].beta1 = 0.0;
        let step = Step { senses: made_up(&mut next), child, allowed: ALL, reward };
        bench.keep(&Lesson { steps: vec![step], last: made_up(&mut next), end: ENDED });
        let before = bench.nets.clone();
        let net = Net::of(&bench, child);
        let returns = bench.replay(1);
        assert_eq!(returns, [reward * bench.params[0].value_scale]);
        let slopes = net.differences(&inputs_of(&step.senses), f64::from(returns[0]));
        let (first, words) = (bench.net(child), bench.rows_of_net() * LANES);
        let change = |i: usize| f64::from(bench.nets[first + i]) - f64::from(before[first + i]);
        let found: Vec<f64> = (0..words).map(|i| -change(i) / 256.0).collect();
        // The output bias stands in the first word of its row; the rest of it, and lanes without a unit, keep out.
        for (i, found) in found.iter().enumerate() {
            let used = i % LANES < hidden && i <= words - LANES;
            assert!(used || *found == 0.0, "word {i} is not in use and changed");
        }
        let mut expected = slopes;
        expected[words - LANES + 1..].fill(0.0);
        (0..words).filter(|i| i % LANES >= hidden).for_each(|i| expected[i] = 0.0);
        // Differences of f64 are good to some 1e-11; a slope of zero is exact.
        let x = inputs_of(&step.senses);
        (0..52).filter(|i| x[*i] == 0.0).for_each(|i| expected[i * LANES..(i + 1) * LANES].fill(0.0));
        let rows = compare(&format!("child {child}"), &found, &expected, 1.0e-3);
        assert!(rows > 30, "{rows} rows compared");
        for other in (0..6).filter(|other| *other != child) {
            let range = bench.net(other)..bench.net(other) + 3 * words;
            let bits = |nets: &[f32]| nets[range.clone()].iter().map(|w| w.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&before), bits(&bench.nets), "child {other} learned from child {child}'s step");
        }
    }
}

#[test]
fn momentum_carries_the_last_change_on() {
    let mut bench = Bench::new(&["learning.optimiser=\"sgd\"", "learning.momentum=0.5", "learning.init_range=0.3"]);
    bench.params[0].learning_rate = 0.25;
    bench.params[0].beta1 = 0.5;
    let mut next = random(5);
    let skill = bench.shared.skills[0];
    let mut scratch = scratch_of(&made_up(&mut next));
    encode(&bench.shared, &mut scratch, &skill, false);
    forward(&bench.nets, &mut scratch, &skill, &bench.params[0], 0);
    let start = Net::of(&bench, 2);
    backward(&mut bench.nets, &mut scratch, &skill, &bench.params[0], 0, 2, 0.5, bench.params[0].learning_rate);
    let one = Net::of(&bench, 2);
    // Nothing new to learn: only the momentum moves the weights, half as far.
    backward(&mut bench.nets, &mut scratch, &skill, &bench.params[0], 0, 2, 0.0, bench.params[0].learning_rate);
    let two = Net::of(&bench, 2);
    let moved = |a: &Net, b: &Net| a.0.iter().zip(&b.0).map(|(a, b)| b - a).collect::<Vec<f64>>();
    let first = moved(&start, &one);
    let halved: Vec<f64> = first.iter().map(|d| d * 0.5).collect();
    assert!(norm(&first) > 0.01);
    let gap: Vec<f64> = moved(&one, &two).iter().zip(&halved).map(|(a, b)| a - b).collect();
    assert!(norm(&gap) < 1.0e-5 * norm(&halved), "{}", norm(&gap));
}

#[test]
fn adam_follows_the_papers_formula() {
    adam_follows_the_formula("adam", "32", "1e-8", "0.0015");
    adam_follows_the_formula("adam", "12", "1e-8", "0.0015");
    // An epsilon as large as the gradients: a higher rate keeps the changes above the weights' last places.
    adam_follows_the_formula("adam", "32", "1e-3", "0.05");
}

/// The same with the mean of the squared gradient over the weights of one input, as Adam-mini has it over its blocks.
#[test]
fn adam_of_rows_follows_the_formula_with_the_mean_square_of_each_row() {
    adam_follows_the_formula("adam-rows", "32", "1e-8", "0.0015");
    adam_follows_the_formula("adam-rows", "12", "1e-8", "0.0015");
    adam_follows_the_formula("adam-rows", "32", "1e-3", "0.05");
}

fn adam_follows_the_formula(optimiser: &str, hidden: &str, epsilon: &str, rate: &str) {
    let (of_optimiser, of_hidden) = (format!("learning.optimiser={optimiser}"), format!("learning.hidden={hidden}"));
    let (of_epsilon, of_rate) = (format!("learning.epsilon={epsilon}"), format!("learning.learning_rate={rate}"));
    let mut bench = Bench::new(&[&of_optimiser, &of_hidden, "learning.init_range=0.3", &of_epsilon, &of_rate]);
    let (epsilon, given): (f32, f32) = (epsilon.parse().expect("a number"), rate.parse().expect("a number"));
    let params = bench.params[0];
    let (rate, beta1, beta2) = (f64::from(params.learning_rate), f64::from(params.beta1), f64::from(params.beta2));
    let epsilon2 = f64::from(params.epsilon2);
    assert_eq!((rate, beta1, beta2), (f64::from(given), f64::from(0.9_f32), f64::from(0.999_f32)));
    assert_eq!(epsilon2, f64::from(epsilon * epsilon));
    let mut next = random(6);
    let child = 3;
    let mut net = Net::of(&bench, child);
    let start = net.clone();
    let others = bench.nets.clone();
    let (mut mean, mut square) = (vec![0.0; net.0.len()], vec![0.0; net.0.len()]);
    for time in 1..=3 {
        let reward = [80.0, -50.0, 30.0][time - 1];
        let step = Step { senses: made_up(&mut next), child, allowed: ALL, reward };
        bench.keep(&Lesson { steps: vec![step], last: step.senses, end: ENDED });
        let returns = bench.replay(1);
        // Kingma and Ba, algorithm 1, with the bias corrections in the rate (end of their section 2).
        let slopes = net.differences(&inputs_of(&step.senses), f64::from(returns[0]));
        let t = time as i32;
        let corrected = rate * (1.0 - beta2.powi(t)).sqrt() / (1.0 - beta1.powi(t));
        for (i, slope) in slopes.iter().enumerate() {
            mean[i] = beta1 * mean[i] + (1.0 - beta1) * slope;
            let row = &slopes[i / LANES * LANES..slopes.len().min((i / LANES + 1) * LANES)];
            // The last row has a single weight, the output's bias.
            let weights = if i / LANES + 1 == bench.rows_of_net() { 1 } else { params.hidden };
            let own = slope * slope;
            let of_row = row.iter().map(|slope| slope * slope).sum::<f64>() / f64::from(weights);
            let squared = if optimiser == "adam" { own } else { of_row };
            square[i] = beta2 * square[i] + (1.0 - beta2) * squared;
            net.0[i] -= corrected * mean[i] / (square[i] + epsilon2).sqrt();
        }
        let moved = |to: &Net| to.0.iter().zip(&start.0).map(|(to, from)| to - from).collect::<Vec<f64>>();
        let found = moved(&Net::of(&bench, child));
        let mut expected = moved(&net);
        let last = expected.len() - LANES + 1;
        expected[last..].fill(0.0);
        let rows = compare(&format!("after {time} steps"), &found, &expected, 1.0e-3);
        assert!(rows > 30, "{rows} rows compared");
        let clock = bench.shared.skills[0].clock_offset as usize;
        let clocks = |child: usize| (bench.nets[clock + child], bench.nets[clock + CLOCK_SECOND as usize + child]);
        let (first, second) = clocks(child as usize);
        assert!((f64::from(first) - beta1.powi(t)).abs() < 1.0e-6);
        assert!((f64::from(second) - beta2.powi(t)).abs() < 1.0e-6);
        assert_eq!(clocks(4), (1.0, 1.0));
    }
    for other in (0..6).filter(|other| *other != child) {
        let range = bench.net(other)..bench.net(other) + 3 * net.0.len();
        assert!(bench.nets[range.clone()] == others[range], "child {other} changed");
    }
}

// TD(lambda).

/// A learner whose Q-values are exact: with the front bumper child 0 is worth 0.5 and child 1 -0.5, with the left one
/// child 2 is worth 0.1875, all else 0. Gamma is 0.5 and a reward of 64 counts 1.
fn exact(lambda: f32) -> Bench {
    let mut bench = Bench::new(&["learning.optimiser=\"sgd\"", "learning.momentum=0.0"]);
    bench.nets.iter_mut().for_each(|w| *w = 0.0);
    let skill = bench.shared.skills[0];
    // A weight of 40 makes a hidden unit a copy of a bumper's bit.
    let copy = tanh(40.0);
    assert!(copy > 0.999_999 && tanh(0.0) == 0.0);
    for (child, bumper, worth) in [(0, 0, 0.5), (1, 0, -0.5), (2, 1, 0.1875_f32)] {
        let near = worth.atanh();
        let candidates = (-200..200).map(|i| f32::from_bits(near.to_bits().wrapping_add_signed(i)));
        let weight = candidates.into_iter().find(|w| tanh(copy * *w) == worth).expect("some weight gives this value");
        let net = net_of(&skill, 0, child) as usize;
        bench.nets[net + (48 + bumper) * LANES + bumper] = 40.0;
        bench.nets[net + (skill.inputs as usize + 1) * LANES + bumper] = weight;
    }
    let params = &mut bench.params[0];
    params.learning_rate = HARDLY;
    params.beta1 = 0.0;
    params.gamma = 0.5;
    params.lambda = lambda;
    params.value_scale = 1.0 / 64.0;
    params.target_clip = 0.875;
    params.policy_threshold = 0.0;
    params.inverse_temperature_start = 20.0;
    params.taught_as_policy = 0;
    params.timeout_terminal = 0;
    bench
}

const NONE: u32 = 0;
const FRONT: u32 = 1;
const LEFT: u32 = 2;

/// Five steps: nothing, front, left, nothing, front; then left. The greatest Q-values are 0, 0.5, 0.1875, 0, 0.5; 0.1875.
fn five_steps(end: u32, last_reward: f32) -> Lesson {
    let mut next = random(8);
    let mut at = |bumpers: u32| {
        let mut record = made_up(&mut next);
        record[6] = record[6] & 0x00ff_ffff | bumpers << 24;
        record
    };
    let mut step = |bumpers, child, reward| Step { senses: at(bumpers), child, allowed: ALL, reward };
    let steps = vec![
        step(NONE, 3, 0.0),
        step(FRONT, 0, -8.0),
        step(LEFT, 4, 0.0),
        step(NONE, 5, 0.0),
        step(FRONT, 1, last_reward),
    ];
    Lesson { steps, last: at(LEFT), end }
}

/// What one replay of the five steps must leave: the returns, first step first, and whether each step is learned.
fn expect(bench: &mut Bench, lesson: &Lesson, taught: u32, returns: [f32; 5], learned: [bool; 5], what: &str) {
    bench.keep(lesson);
    let mut found = bench.replay(taught);
    found.reverse();
    // A bias that has moved by `HARDLY` shows where a value is 0.
    let near = |found: f32, exact: f32| if exact == 0.0 { found.abs() < 1.0e-17 } else { found == exact };
    assert!(found.iter().zip(returns).all(|(found, exact)| near(*found, exact)), "{what}: {found:?}, not {returns:?}");
    // Q of the child of each step, in its state.
    let values = [0.0, 0.5, 0.0, 0.0, -0.5];
    for (step, value) in values.iter().enumerate() {
        let child = lesson.steps[step].child;
        // The output bias is 0, its slope is the error times (1 - Q^2): exact.
        let error = (returns[step] - value) * (1.0 - value * value);
        let expected = if learned[step] { error } else { 0.0 };
        assert!(near(bench.bias(child) / HARDLY, expected), "{what}: step {step}");
    }
    let learned = learned.iter().filter(|learned| **learned).count() as u32;
    assert_eq!((bench.bias(2), bench.state.updates), (0.0, learned), "{what}");
}

#[test]
fn five_step_returns_are_the_ones_computed_by_hand() {
    let all = [true; 5];
    let goal = five_steps(ENDED, 48.0);
    let cut = five_steps(CUT, 48.0);
    // The last step earns 0.75 and the bracket is 0: the goal.
    expect(&mut exact(0.0), &goal, 0, [0.25, -0.03125, 0.0, 0.25, 0.75], all, "lambda 0");
    let half = [113.0 / 1024.0, -0.05859375, 0.078125, 0.3125, 0.75];
    expect(&mut exact(0.5), &goal, 0, half, all, "lambda 0.5");
    let full = [-0.015625, -0.03125, 0.1875, 0.375, 0.75];
    expect(&mut exact(1.0), &goal, 0, full, all, "lambda 1");
    expect(&mut exact(1.0), &goal, 1, full, all, "lambda 1, taught");
    // Cut: the last observation's best value, 0.1875, stands for what would have followed.
    let half_cut = [907.0 / 8192.0, -117.0 / 2048.0, 0.083984375, 0.3359375, 0.84375];
    expect(&mut exact(0.5), &cut, 0, half_cut, all, "lambda 0.5, cut");
    let full_cut = [-0.009765625, -0.01953125, 0.2109375, 0.421875, 0.84375];
    expect(&mut exact(1.0), &cut, 0, full_cut, all, "lambda 1, cut");
    // Cut, and a cut counts as an end.
    let mut terminal = exact(0.5);
    terminal.params[0].timeout_terminal = 1;
    expect(&mut terminal, &cut, 0, half, all, "lambda 0.5, cut, terminal");
    // Targets are clipped, and it is the clipped one that is handed on.
    for (limit, sign) in [(0.5, 1.0_f32), (0.5, -1.0)] {
        let mut clipped = exact(1.0);
        clipped.params[0].target_clip = limit;
        let tail = [-0.03125_f32, -0.0625, 0.125, 0.25, 0.5].map(|u| u * sign);
        // With a loss at the end: -0.5, -0.25, -0.125, -0.125 - 0.0625, half of that.
        let loss = [-0.09375, -0.1875, -0.125, -0.25, -0.5];
        let returns = if sign > 0.0 { tail } else { loss };
        expect(&mut clipped, &five_steps(ENDED, 48.0 * sign), 0, returns, all, "clipped");
    }
}

#[test]
fn steps_that_are_no_policy_cut_the_chain() {
    // In front of a wall child 1 is chosen once in e^20 times: its step is not learned, and the best value, 0.5,
    // stands for its return.
    let goal = five_steps(ENDED, 48.0);
    let but_last = [true, true, true, true, false];
    let mut bench = exact(1.0);
    bench.params[0].policy_threshold = 1.0e-5;
    expect(&mut bench, &goal, 0, [-0.03125, -0.0625, 0.125, 0.25, 0.5], but_last, "lambda 1");
    let mut bench = exact(0.5);
    bench.params[0].policy_threshold = 1.0e-5;
    expect(&mut bench, &goal, 0, [0.109375, -0.0625, 0.0625, 0.25, 0.5], but_last, "lambda 0.5");
    // A higher threshold also refuses step 2: child 4 at 0 beside child 2 at 0.1875, e^-3.75. Its best
    // value is 0.1875.
    let mut bench = exact(1.0);
    bench.params[0].policy_threshold = 0.03;
    let returns = [-0.015625, -0.03125, 0.1875, 0.25, 0.5];
    expect(&mut bench, &goal, 0, returns, [true, true, false, true, false], "threshold 0.03");
    // Taught steps count whatever their probability, if so configured, and only they do.
    let all = [true; 5];
    let full = [-0.015625, -0.03125, 0.1875, 0.375, 0.75];
    for (taught, learned, returns) in [(1, all, full), (0, [true, true, false, true, false], returns)] {
        let mut bench = exact(1.0);
        bench.params[0].policy_threshold = 0.03;
        bench.params[0].taught_as_policy = 1;
        expect(&mut bench, &goal, taught, returns, learned, "taught always");
    }
    // A masked child is not what the best value is about: without child 0 the best in front of the wall is 0.
    let mut masked = goal;
    masked.steps[4].allowed = ALL & !1;
    let returns = [111.0 / 1024.0, -0.06640625, 0.046875, 0.1875, 0.75];
    expect(&mut exact(0.5), &masked, 0, returns, all, "masked");
}

/// TD(lambda) as its books define it, forwards: every return is a mixture of n-step returns.
#[test]
fn returns_of_random_lessons_match_the_forward_view() {
    let mut next = random(9);
    let (mut steps, mut cuts, mut refused) = (0, 0, 0);
    for round in 0..300 {
        let lambda: f64 = [0.0, 0.3, 0.8, 0.95, 1.0][round % 5];
        let gamma: f64 = [0.9, 0.95, 1.0][round % 3];
        let mut bench = Bench::new(&["learning.optimiser=\"sgd\"", "learning.init_range=0.4"]);
        let params = &mut bench.params[0];
        (params.learning_rate, params.beta1) = (HARDLY, 0.0);
        (params.lambda, params.gamma) = (lambda as f32, gamma as f32);
        (params.target_clip, params.policy_threshold, params.inverse_temperature_start) = (1.0e6, 0.05, 5.0);
        (params.taught_as_policy, params.timeout_terminal) = (0, u32::from(round % 7 == 0));
        let terminal = params.timeout_terminal == 1;
        let count = 1 + (next() * 30.0) as usize;
        let step = |next: &mut dyn FnMut() -> f64| Step {
            senses: made_up(&mut || next()),
            child: (next() * 6.0) as u32,
            allowed: ALL,
            reward: if next() < 0.3 { (next() * 200.0 - 100.0) as f32 } else { 0.0 },
        };
        let taken = (0..count).map(|_| step(&mut next)).collect();
        let end = if next() < 0.5 { ENDED } else { CUT };
        let lesson = Lesson { steps: taken, last: made_up(&mut next), end };

        let nets: Vec<Net> = (0..6).map(|child| Net::of(&bench, child)).collect();
        let values =
            |record: &[u32; BASE_WORDS]| nets.iter().map(|net| net.value(&inputs_of(record))).collect::<Vec<f64>>();
        let all: Vec<Vec<f64>> = lesson.steps.iter().map(|step| values(&step.senses)).collect();
        let best = |q: &[f64]| q.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut peaks: Vec<f64> = all.iter().map(|q| best(q)).collect();
        peaks.push(if end == ENDED || terminal { 0.0 } else { best(&values(&lesson.last)) });
        let odds = |t: usize| {
            let weights: Vec<f64> = all[t].iter().map(|q| (5.0 * q).exp()).collect();
            weights[lesson.steps[t].child as usize] / weights.iter().sum::<f64>()
        };
        if (0..count).any(|t| (odds(t) - 0.05).abs() < 1.0e-4) {
            continue;
        }
        let policy: Vec<bool> = (0..count).map(|t| odds(t) > 0.05).collect();
        let forwards = |t: usize| {
            let reach = (t + 1..count).find(|k| !policy[*k]).unwrap_or(count) - t;
            let ahead = |n: usize| {
                let paid = (0..n).map(|i| gamma.powi(i as i32) * f64::from(lesson.steps[t + i].reward) / 100.0);
                paid.sum::<f64>() + gamma.powi(n as i32) * peaks[t + n]
            };
            let mixed = (1..reach).map(|n| (1.0 - lambda) * lambda.powi(n as i32 - 1) * ahead(n)).sum::<f64>();
            mixed + lambda.powi(reach as i32 - 1) * ahead(reach)
        };
        bench.keep(&lesson);
        let mut found = bench.replay(0);
        found.reverse();
        for t in 0..count {
            let expected = if policy[t] { forwards(t) } else { peaks[t] };
            let error = (f64::from(found[t]) - expected).abs();
            assert!(error < 1.0e-5 * (1.0 + expected.abs()), "round {round} step {t}: {} for {expected}", found[t]);
        }
        steps += count;
        cuts += usize::from(end == CUT && !terminal);
        refused += policy.iter().filter(|policy| !**policy).count();
        assert_eq!(bench.state.updates as usize, policy.iter().filter(|policy| **policy).count());
    }
    assert!(steps > 3000 && cuts > 80 && refused > 100, "{steps} {cuts} {refused}");
}

// Which lessons.

#[test]
fn replayed_lessons_have_exponential_ages_cut_at_the_oldest() {
    for (memory, mean, remembered) in
        [(300, 100.0, 1), (300, 100.0, 2), (300, 100.0, 150), (50, 10.0, 50), (50, 10.0, 173), (40, 500.0, 99)]
    {
        let set = [format!("learning.replay_capacity={memory}"), format!("learning.replay_mean_age={mean:?}")];
        let mut bench = Bench::new(&[&set[0], &set[1]]);
        bench.state.remembered = remembered;
        let stride = bench.shared.skills[0].lesson_stride;
        let kept = remembered.min(memory);
        let learner = bench.learner();
        // Every random word of an even grid: the shares are exact to one part in the grid.
        let grid = 1_u32 << 18;
        let mut counts = vec![0_u32; kept as usize];
        for i in 0..grid {
            let word = i << 14 | 1 << 13;
            let slot = recent_lesson(&learner, word) / stride;
            let age = (0..kept).find(|age| (remembered - 1 - age) % memory == slot).expect("a lesson that is kept");
            counts[age as usize] += 1;
        }
        let weight = |age: u32| (-f64::from(age) / mean).exp() - (-f64::from(age + 1) / mean).exp();
        let total = 1.0 - (-f64::from(kept) / mean).exp();
        for (age, count) in counts.iter().enumerate() {
            let share = f64::from(*count) / f64::from(grid);
            let expected = weight(age as u32) / total;
            // ln and exponential err by 1e-6 at most, which shifts the borders of an age by 1e-6 of the mean.
            assert!((share - expected).abs() < 2.0e-5, "{memory} {mean} {remembered}: age {age}: {share} {expected}");
        }
    }
}

#[test]
fn taught_lessons_are_distinct_one_from_each_stratum() {
    let mut bench = Bench::new(&["skill.dock.lessons=10"]);
    bench.shared.skills[0].bank_offset = 77;
    bench.shared.skills[0].bank_lessons = 256;
    let stride = bench.shared.skills[0].lesson_stride;
    let mut counts = [0_u32; 25];
    for seed in 0..2000 {
        bench.params[0].learner_seed = seed;
        let learner = bench.learner();
        for number in 0..10 {
            let word = taught_lesson(&learner, number) - 77;
            assert_eq!(word % stride, 0);
            let index = word / stride;
            assert!((number * 25..number * 25 + 25).contains(&index), "lesson {number}: {index}");
            counts[(index - number * 25) as usize] += 1;
        }
    }
    // Chi-square with 24 degrees of freedom: 60 is exceeded once in 15,000 times.
    let chi: f64 = counts.iter().map(|count| (f64::from(*count) - 800.0).powi(2) / 800.0).sum();
    assert!(chi < 60.0, "{chi}: {counts:?}");
}

// Choice.

#[test]
fn children_are_chosen_as_often_as_the_softmax_says() {
    let mut next = random(10);
    for round in 0..60 {
        let children = 1 + round % 8;
        // Any set of children but none; bits beyond the last child mean nothing.
        let drawn = (next() * 256.0) as u32;
        let all = (1 << children) - 1;
        let allowed = if drawn & all == 0 { !0 } else { drawn };
        let sharp = (next() * 30.0) as f32;
        // The children beyond the last would win if they counted.
        let q = std::array::from_fn(|i| if (i as u32) < children { (next() * 1.8 - 0.9) as f32 } else { 0.99 });
        let mut scratch = Scratch { q, ..Scratch::default() };
        let outlook = weigh(&mut scratch, children, allowed, sharp);
        let open = |child: u32| child < children && allowed >> child & 1 == 1;
        let weight = |child: u32| {
            if open(child) { (f64::from(sharp) * f64::from(scratch.q[child as usize])).exp() } else { 0.0 }
        };
        let total: f64 = (0..8).map(weight).sum();
        let grid = 1_u32 << 16;
        let mut counts = [0_u32; MAX_CHILDREN];
        for i in 0..grid {
            counts[pick(&scratch, outlook, i << 16 | 1 << 15) as usize] += 1;
        }
        for child in 0..8 {
            let share = f64::from(counts[child as usize]) / f64::from(grid);
            assert!((share - weight(child) / total).abs() < 3.0e-5, "round {round}: child {child}: {share}");
            assert!(open(child) || counts[child as usize] == 0, "round {round}: child {child} is not available");
        }
        let best = (0..children).filter(|c| open(*c)).max_by(|a, b| weight(*a).total_cmp(&weight(*b)));
        assert_eq!(Some(outlook.greedy), best);
        assert_eq!(outlook.best, scratch.q[outlook.greedy as usize]);
    }
    // Of equals the first; if that is not allowed, the next.
    let mut scratch = Scratch { q: [0.25; MAX_CHILDREN], ..Scratch::default() };
    assert_eq!(weigh(&mut scratch, 6, ALL, 1.0).greedy, 0);
    assert_eq!(weigh(&mut scratch, 6, ALL & !1, 1.0).greedy, 1);
    scratch.q[3] = 0.5;
    scratch.q[5] = 0.5;
    assert_eq!(weigh(&mut scratch, 6, ALL, 1.0).greedy, 3);
    assert_eq!(weigh(&mut scratch, 6, ALL & !8, 1.0).greedy, 5);
    // The largest random word picks an available child too.
    let outlook = weigh(&mut scratch, 6, ALL, 1.0);
    assert_eq!(pick(&scratch, outlook, u32::MAX), 5);
}

#[test]
fn inverse_temperature_rises_linearly_and_stays() {
    let bench = Bench::new(&[]);
    for (trial, expected) in [(0, 20.0), (75, 70.0), (150, 120.0), (151, 120.0), (4_000_000_000, 120.0)] {
        assert!((f64::from(inverse_temperature(&bench.params[0], trial)) - expected).abs() < 1.0e-4, "trial {trial}");
    }
}

// The state machine.

/// A config of two skills, one of them above the other, whose learners need every phase, and little time.
fn small() -> Plan {
    let office = configs().join("worlds/office.toml");
    let text = format!(
        r#"
        title = "small"
        world = {office:?}
        seeds = "0..4"
        [evaluate]
        at = []
        episodes = 1
        [teacher]
        lessons = 8
        eval_episodes = 1
        [learning]
        replays = 4
        replay_capacity = 3
        pretrain_epochs = 2
        taught_replays = 2
        [skill.dock]
        inputs = ["sonar(60)", "light", "bumpers"]
        children = ["turn+15", "turn-15", "turn+60", "turn-60", "move+12", "move-12"]
        reward = {{ docked = 100, collision = -10 }}
        starts = {{ light-area = 1.0 }}
        eval_starts = "light-area"
        goal = ["docked"]
        max_steps = 25
        lessons = 2
        trials = 6
        [skill.wander]
        inputs = ["sonar-far", "compass"]
        children = ["turn+15", "dock", "move+12"]
        reward = {{ docked = 50, collision = -20 }}
        starts = {{ anywhere = 1.0 }}
        eval_starts = "anywhere"
        goal = ["docked"]
        max_steps = 12
        lessons = 0
        trials = 4
        [arm.only]
        [arm.open.learning]
        timeout_terminal = false
        mask_blocked = false
        optimiser = "sgd"
        learning_rate = 0.05
        "#
    );
    let folder = tempfile::tempdir().expect("a folder for the config");
    let path = folder.path().join("small.toml");
    std::fs::write(&path, text).expect("the config is written");
    load(&path, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn cohort() -> Cohort {
    let plan = small();
    let groups = groups(&plan).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(groups.len(), 1);
    let learners = groups[0].learners(&plan);
    groups[0].cohort(&plan, &learners)
}

fn run(cohort: &Cohort, threads: usize, iterations: u32, stops: &[Stop]) -> Cohort {
    let mut backend = CpuBackend::new(threads, Some(iterations)).expect("threads");
    backend.load(cohort.clone()).expect("memory");
    for stop in stops {
        while !backend.advance(*stop).expect("the CPU advances").iter().all(|state| stop.holds(state)) {}
    }
    backend.memory().expect("memory").clone()
}

const DONE: Stop = Stop { skill: u32::MAX, trial: u32::MAX };

/// Every byte that learners leave.
fn bytes(cohort: &Cohort, learner: usize) -> Vec<u8> {
    let nets = &cohort.nets[learner * cohort.nets_stride..][..cohort.nets_stride];
    let lessons = &cohort.lessons[learner * cohort.lessons_stride..][..cohort.lessons_stride];
    let rows = &cohort.rows[learner * cohort.rows_stride..][..cohort.rows_stride];
    let state = bytemuck::bytes_of(&cohort.states[learner]);
    [state, bytemuck::cast_slice(nets), bytemuck::cast_slice(lessons), bytemuck::cast_slice(rows)].concat()
}

#[test]
fn interruptions_and_company_change_no_byte() {
    let start = cohort();
    let learners = start.states.len();
    assert_eq!(learners, 8);
    let whole = run(&start, 1, u32::MAX, &[DONE]);
    assert!(whole.states.iter().all(|state| state.phase == PHASE_DONE && state.updates > 50));
    assert!((0..learners).all(|learner| bytes(&whole, learner) != bytes(&start, learner)));
    let points = [(0, 0), (0, 3), (1, 0), (1, 2)].map(|(skill, trial)| Stop { skill, trial });
    let stops = [points.as_slice(), &[DONE]].concat();
    for (threads, iterations, stops) in [(1, 1, &[DONE][..]), (2, 7, &[DONE]), (2, 1000, &stops), (1, 3, &stops)] {
        let parts = run(&start, threads, iterations, stops);
        for learner in 0..learners {
            assert!(
                bytes(&parts, learner) == bytes(&whole, learner),
                "{iterations} iterations: learner {learner} differs"
            );
        }
    }
    // Alone, as among others.
    for learner in [0, 5] {
        let part = |words: &[f32], stride: usize| words[learner * stride..(learner + 1) * stride].to_vec();
        let alone = Cohort {
            params: start.params[learner * start.skills..][..start.skills].to_vec(),
            states: vec![start.states[learner]],
            nets: part(&start.nets, start.nets_stride),
            lessons: vec![0; start.lessons_stride],
            rows: vec![0; start.rows_stride],
            ..start.clone()
        };
        assert!(bytes(&run(&alone, 1, 50, &[DONE]), 0) == bytes(&whole, learner), "learner {learner} alone");
    }
}

#[test]
fn the_trial_table_adds_up() {
    let start = cohort();
    let done = run(&start, 2, 1000, &[DONE]);
    for (learner, state) in done.states.iter().enumerate() {
        let rows = &done.rows[learner * done.rows_stride..][..state.rows as usize * 8];
        let mut actions = 0;
        let list: Vec<(u32, u32, u32)> = rows
            .chunks(8)
            .map(|row| {
                let [skill, trial, so_far, steps, reward, success, collisions, taught] =
                    row.try_into().unwrap_or([0; 8]);
                actions += steps;
                assert_eq!(so_far, actions);
                let (pay, hit) = if skill == 0 { (100.0, -10.0) } else { (50.0, -20.0) };
                assert_eq!(f32::from_bits(reward), pay * success as f32 + hit * collisions as f32);
                assert!(steps >= 1 && steps <= if skill == 0 { 25 } else { 12 });
                assert!(success == 1 || steps == if skill == 0 { 25 } else { 12 });
                (skill, trial, taught)
            })
            .collect();
        let taught = (0..2).map(|trial| (0, trial, 1));
        let own = (0..6).map(|trial| (0, trial, 0)).chain((0..4).map(|trial| (1, trial, 0)));
        assert_eq!(list, taught.chain(own).collect::<Vec<_>>(), "learner {learner}");
    }
}

#[test]
fn a_learner_whose_weights_stop_being_numbers_freezes_alone() {
    let start = cohort();
    let clean = run(&start, 2, 1000, &[DONE]);
    let skill = start.shared.skills[0];
    let rows = skill.rows as usize;
    // One weight of one child's net: of an input, a hidden bias, an output weight, the output bias.
    for (learner, child, row, poison) in [
        (1, 4, 0, f32::NAN),
        (2, 4, rows - 3, f32::NAN),
        (3, 2, rows - 2, f32::INFINITY),
        (6, 5, rows - 1, f32::NAN),
        (7, 1, rows - 1, f32::NEG_INFINITY),
    ] {
        let mut sick = start.clone();
        let word = learner * sick.nets_stride + net_of(&skill, 0, child) as usize + row * LANES;
        sick.nets[word] = poison;
        let after = run(&sick, 2, 1000, &[DONE]);
        let state = &after.states[learner];
        assert_eq!(state.phase, PHASE_FAILED, "learner {learner}: {poison} in row {row} of child {child}");
        for other in (0..8).filter(|other| *other != learner) {
            assert!(bytes(&after, other) == bytes(&clean, other), "learner {other} suffers from {learner}");
        }
        // It stays as it is.
        let again = run(&after, 1, 1000, &[DONE]);
        assert!(bytes(&again, learner) == bytes(&after, learner));
    }
}
