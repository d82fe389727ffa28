//! Values and gradients of the nets, and the optimisers.

use super::super::learner::Learner;
use super::super::nets64::{Nets64, norm};
use super::super::observations::made_up;
use super::super::random::random;
use super::{ALL, Trial, docking, free_step, inputs_of};
use skilltree::layout::{LANES, TERMINATED};
use skilltree::qnet::optimiser::adam::BETA2_POWER;

/// Compares row by row and as a whole, relative to the size of what is expected. Returns the rows compared.
fn compare(what: &str, found: &[f64], expected: &[f64], share: f64) -> usize {
    let gap = |a: &[f64], b: &[f64]| norm(a.iter().zip(b).map(|(a, b)| a - b));
    let size_of = |values: &[f64]| norm(values.iter().copied());
    let whole = gap(found, expected) / size_of(expected);
    assert!(whole <= share, "{what}: {whole}");
    let mut compared = 0;
    for (row, (found, expected)) in found.chunks(LANES).zip(expected.chunks(LANES)).enumerate() {
        let size = size_of(expected);
        if size == 0.0 {
            assert_eq!(size_of(found), 0.0, "{what}: row {row}");
        } else {
            assert!(gap(found, expected) <= share * size, "{what}: row {row}: {}", gap(found, expected) / size);
            compared += 1;
        }
    }
    compared
}
/// The nets of the only skill in f64.
fn nets64(learner: &Learner) -> Nets64 {
    Nets64::of(&learner.nets, &learner.shared.skills[0])
}

#[test]
fn q_values_match_plain_f64_nets() {
    for (init, hidden) in [("0.1", "32"), ("0.5", "20"), ("1.5", "1"), ("2.0", "32")] {
        let set = [format!("learning.init_range={init}"), format!("learning.hidden={hidden}")];
        let mut learner = docking(&[&set[0], &set[1]]);
        let mut next = random(3);
        let mut spread = 0.0_f64;
        for _ in 0..200 {
            let made = made_up(&mut next);
            let (inputs, q) = learner.seen(|group| {
                group.record.observation = made;
                group.encode(0, false);
                (group.forms.forward)(group, 0);
                (group.inputs, group.q)
            });
            let x = inputs_of(&made);
            for (i, (found, exact)) in inputs.iter().zip(&x).enumerate() {
                assert!((f64::from(*found) - exact).abs() < 1.0e-6, "input {i}: {found} for {exact}");
            }
            for (exact, found) in nets64(&learner).values(&x).iter().zip(q) {
                assert!((f64::from(found) - exact).abs() <= 1.0e-5, "init {init}: {found} for {exact}");
                spread = spread.max(exact.abs());
            }
            // Other weights each time, biases and all.
            learner.nets.iter_mut().step_by(7).for_each(|w| *w = -*w);
        }
        assert!(spread > 0.05, "{spread}");
        // No two inputs, nor any of the weights, are taken for each other: the net is not symmetric in them.
        let lone = learner.nets.iter().filter(|w| **w != 0.0).count();
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
        let mut learner = docking(&set);
        learner.params[0].learning_rate = 256.0;
        learner.params[0].beta1 = 0.0;
        let step = free_step(made_up(&mut next), child, ALL, reward);
        learner.keep(&Trial { steps: vec![step], last: made_up(&mut next), end: TERMINATED });
        let before = learner.nets.clone();
        let net = nets64(&learner);
        let returns = learner.replay(1);
        assert_eq!(returns, [reward * learner.params[0].value_scale]);
        let x = inputs_of(&step.observation);
        let mut expected = net.slopes(&x, child as usize, f64::from(returns[0]));
        let (first, words) = (learner.net(0, child), learner.tensor(0));
        let change = |i: usize| f64::from(learner.nets[first + i]) - f64::from(before[first + i]);
        let found: Vec<f64> = (0..words).map(|i| -change(i) / 256.0).collect();
        // The output bias stands in the first word of its row; the rest of it, and lanes without a unit, keep out.
        for (i, found) in found.iter().enumerate() {
            let used = i % LANES < hidden && i <= words - LANES;
            assert!(used || *found == 0.0, "word {i} is not in use and changed");
        }
        expected[words - LANES + 1..].fill(0.0);
        (0..words).filter(|i| i % LANES >= hidden).for_each(|i| expected[i] = 0.0);
        // Differences of f64 are good to some 1e-11; a slope of zero is exact.
        (0..52).filter(|i| x[*i] == 0.0).for_each(|i| expected[i * LANES..(i + 1) * LANES].fill(0.0));
        let rows = compare(&format!("child {child}"), &found, &expected, 1.0e-3);
        assert!(rows > 30, "{rows} rows compared");
        for other in (0..6).filter(|other| *other != child) {
            let range = learner.net(0, other)..learner.net(0, other) + 3 * words;
            let bits = |nets: &[f32]| nets[range.clone()].iter().map(|w| w.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&before), bits(&learner.nets), "child {other} learned from child {child}'s step");
        }
    }
}

#[test]
fn momentum_carries_the_last_change_on() {
    let mut learner = docking(&["learning.optimiser=\"sgd\"", "learning.momentum=0.5", "learning.init_range=0.3"]);
    learner.params[0].beta1 = 0.5;
    let made = made_up(&mut random(5));
    let mut after = |deltas: &[f32]| {
        let start = learner.nets.clone();
        learner.act(|group| {
            group.record.observation = made;
            group.encode(0, false);
            (group.forms.forward)(group, 0);
            for delta in deltas {
                (group.forms.backward)(group, 0, 2, *delta, 0.25);
            }
        });
        let found = nets64(&learner).nets[2].clone();
        learner.nets = start;
        found
    };
    // Nothing new to learn at the second time: only the momentum moves the weights, half as far.
    let (start, one, two) = (after(&[]), after(&[0.5]), after(&[0.5, 0.0]));
    let moved = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| b - a).collect::<Vec<f64>>();
    let first = moved(&start, &one);
    let halved: Vec<f64> = first.iter().map(|d| d * 0.5).collect();
    assert!(norm(first) > 0.01);
    let gap = norm(moved(&one, &two).iter().zip(&halved).map(|(a, b)| a - b));
    assert!(gap < 1.0e-5 * norm(halved), "{gap}");
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
    let mut learner = docking(&[&of_optimiser, &of_hidden, "learning.init_range=0.3", &of_epsilon, &of_rate]);
    let (epsilon, given): (f32, f32) = (epsilon.parse().expect("a number"), rate.parse().expect("a number"));
    let params = learner.params[0];
    let (rate, beta1, beta2) = (f64::from(params.learning_rate), f64::from(params.beta1), f64::from(params.beta2));
    let epsilon2 = f64::from(params.epsilon2);
    assert_eq!((rate, beta1, beta2), (f64::from(given), f64::from(0.9_f32), f64::from(0.999_f32)));
    assert_eq!(epsilon2, f64::from(epsilon * epsilon));
    let mut next = random(6);
    let child = 3;
    let mut net = nets64(&learner);
    let start = net.clone();
    let others = learner.nets.clone();
    let words = net.nets[child].len();
    let (mut mean, mut square) = (vec![0.0; words], vec![0.0; words]);
    for time in 1..=3 {
        let reward = [80.0, -50.0, 30.0][time - 1];
        let step = free_step(made_up(&mut next), child as u32, ALL, reward);
        learner.keep(&Trial { steps: vec![step], last: step.observation, end: TERMINATED });
        let returns = learner.replay(1);
        // Kingma and Ba, algorithm 1, with the bias corrections in the rate (end of their section 2).
        let slopes = net.slopes(&inputs_of(&step.observation), child, f64::from(returns[0]));
        let t = time as i32;
        let corrected = rate * (1.0 - beta2.powi(t)).sqrt() / (1.0 - beta1.powi(t));
        for (i, slope) in slopes.iter().enumerate() {
            mean[i] = beta1 * mean[i] + (1.0 - beta1) * slope;
            let row = &slopes[i / LANES * LANES..slopes.len().min((i / LANES + 1) * LANES)];
            // The last row has a single weight, the output's bias.
            let weights = if (i / LANES + 1) * LANES == words { 1 } else { params.hidden };
            let own = slope * slope;
            let of_row = row.iter().map(|slope| slope * slope).sum::<f64>() / f64::from(weights);
            let squared = if optimiser == "adam" { own } else { of_row };
            square[i] = beta2 * square[i] + (1.0 - beta2) * squared;
            net.nets[child][i] -= corrected * mean[i] / (square[i] + epsilon2).sqrt();
        }
        let moved = |to: &Nets64| {
            to.nets[child].iter().zip(&start.nets[child]).map(|(to, from)| to - from).collect::<Vec<f64>>()
        };
        let found = moved(&nets64(&learner));
        let mut expected = moved(&net);
        let last = expected.len() - LANES + 1;
        expected[last..].fill(0.0);
        let rows = compare(&format!("after {time} steps"), &found, &expected, 1.0e-3);
        assert!(rows > 30, "{rows} rows compared");
        let clock = learner.shared.skills[0].clock_offset as usize;
        let clocks = |child: usize| (learner.nets[clock + child], learner.nets[clock + BETA2_POWER + child]);
        let (first, second) = clocks(child);
        assert!((f64::from(first) - beta1.powi(t)).abs() < 1.0e-6);
        assert!((f64::from(second) - beta2.powi(t)).abs() < 1.0e-6);
        assert_eq!(clocks(4), (1.0, 1.0));
    }
    for other in (0..6).filter(|other| *other != child) {
        let first = learner.net(0, other as u32);
        let range = first..first + 3 * words;
        assert!(learner.nets[range.clone()] == others[range], "child {other} changed");
    }
}
