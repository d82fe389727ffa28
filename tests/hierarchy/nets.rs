//! Nets with an output for each child: values and gradients against f64, differences and the formulas of the papers.

use super::bench::{Bench, Nets64, TREE, made_up, random, readings, scratch_of};
use skilltree::layout::LANES;
use skilltree::policy::features::encode;
use skilltree::qnet::backward::backward;
use skilltree::qnet::forward::{forward, net_of};

/// A root whose four children share one net of 20 hidden units, and its inputs for made-up senses.
fn shared_net(optimiser: &[&str]) -> (Bench, usize) {
    let mut set = vec!["skill.top.learning.shared_net=true", "skill.top.learning.hidden=20"];
    set.extend(["skill.top.inputs=['sonar-far', 'bumpers']", "skill.top.applicable={}"]);
    set.extend(optimiser);
    let bench = Bench::new(TREE, &set);
    let root = bench.skill("top");
    let skill = &bench.shared.skills[root];
    assert_eq!((skill.nets, skill.outputs, skill.inputs, skill.rows), (1, 4, 28, 28 + 1 + 4 + 1));
    (bench, root)
}

/// The weights of the one net that are in use: hidden unit, or output for the last row.
fn used(row: usize, lane: usize) -> bool {
    if row == 33 { lane < 4 } else { lane < 20 }
}

/// Values of the bench's net for made-up senses, with the inputs, left in `scratch` for the backward pass.
fn look(bench: &Bench, root: usize, next: &mut impl FnMut() -> f64) -> (skilltree::env::workgroup::Scratch, Vec<f64>) {
    let record = made_up(next);
    let mut scratch = scratch_of(&record);
    encode(&bench.shared, &mut scratch, &bench.shared.skills[root], false);
    forward(&bench.nets, &mut scratch, &bench.shared.skills[root], &bench.params[root], 0);
    let sonar = readings(&record).map(|reading| 2.0 * reading / 127.0 - 1.0);
    let bumpers = (0..4).map(|side| f64::from(record[6] >> (24 + side) & 1));
    (scratch, sonar.into_iter().chain(bumpers).collect())
}

/// Slope of 0.5 (goal - Q)^2 for one output, by central differences in f64.
fn differences(net: &Nets64, x: &[f64], child: usize, goal: f64) -> Vec<f64> {
    let step = 1.0e-5;
    let mut moved = net.clone();
    let mut loss_at = |i: usize, weight: f64| {
        let kept = moved.nets[0][i];
        moved.nets[0][i] = weight;
        let loss = 0.5 * (goal - moved.values(x)[child]).powi(2);
        moved.nets[0][i] = kept;
        loss
    };
    let slope = |(i, w): (usize, &f64)| (loss_at(i, w + step) - loss_at(i, w - step)) / (2.0 * step);
    net.nets[0].iter().enumerate().map(slope).collect()
}

fn norm(values: impl Iterator<Item = f64>) -> f64 {
    values.map(|v| v * v).sum::<f64>().sqrt()
}

#[test]
fn values_of_shared_nets_match_f64() {
    let (mut bench, root) = shared_net(&[]);
    let mut next = random(4);
    let mut spread = 0.0_f64;
    for _ in 0..200 {
        let (scratch, x) = look(&bench, root, &mut next);
        let exact = Nets64::of(&bench.nets, &bench.shared.skills[root]).values(&x);
        assert_eq!(exact.len(), 4);
        for (child, exact) in exact.iter().enumerate() {
            let found = f64::from(scratch.q[child]);
            assert!((found - exact).abs() < 1.0e-5, "child {child}: {found} for {exact}");
            spread = spread.max(exact.abs());
        }
        bench.nets.iter_mut().step_by(7).for_each(|w| *w = -*w);
    }
    assert!(spread > 0.3, "{spread}");
}

#[test]
fn one_step_descends_the_gradient_of_one_output() {
    let mut next = random(5);
    for (child, goal) in [(0, 0.9), (1, -0.7), (2, 0.2), (3, -0.95)] {
        let (mut bench, root) = shared_net(&["learning.optimiser=sgd", "learning.learning_rate=0.5"]);
        bench.params[root].beta1 = 0.0;
        let skill = bench.shared.skills[root];
        let (mut scratch, x) = look(&bench, root, &mut next);
        let net = Nets64::of(&bench.nets, &skill);
        let slopes = differences(&net, &x, child, goal);
        let delta = goal as f32 - scratch.q[child];
        // A large rate, because the change of a weight is exact only next to what it is added to.
        let before = bench.nets.clone();
        backward(&mut bench.nets, &mut scratch, &skill, &bench.params[root], 0, child as u32, delta, 256.0);
        let after = Nets64::of(&bench.nets, &skill);
        for (row, (slopes, (now, then))) in
            slopes.chunks(LANES).zip(after.nets[0].chunks(LANES).zip(net.nets[0].chunks(LANES))).enumerate()
        {
            let change = |lane: usize| (now[lane] - then[lane]) / -256.0;
            let expected = |lane: usize| if used(row, lane) { slopes[lane] } else { 0.0 };
            let size = norm((0..LANES).map(expected));
            let gap = norm((0..LANES).map(|lane| change(lane) - expected(lane)));
            assert!(gap <= 1.0e-3 * size + 1.0e-9, "child {child}, row {row}: {gap} beside {size}");
            // Weights and biases of other outputs stay.
            if (29..33).contains(&row) {
                assert_eq!(size > 1.0e-3, row == 29 + child, "child {child}, row {row}");
            }
            assert!((0..LANES).all(|lane| used(row, lane) || change(lane) == 0.0), "row {row}: lanes not in use");
        }
        let biases: Vec<bool> =
            (0..4).map(|lane| after.nets[0][33 * LANES + lane] != net.nets[0][33 * LANES + lane]).collect();
        assert_eq!(biases, (0..4).map(|lane| lane == child).collect::<Vec<bool>>());
        // Other skills' nets are left alone.
        let first = net_of(&skill, 0, 0) as usize;
        assert!(before[..first] == bench.nets[..first]);
    }
}

/// Adam with one clock for the whole net: outputs that a step does not teach have a gradient of 0 in it.
#[test]
fn adam_of_a_shared_net_follows_the_papers_formula() {
    let (mut bench, root) = shared_net(&["learning.learning_rate=0.01", "learning.epsilon=1e-3"]);
    let (beta1, beta2, epsilon, rate) = (0.9_f64, 0.999_f64, 1.0e-3_f64, 0.01_f64);
    let skill = bench.shared.skills[root];
    let mut next = random(6);
    let mut net = Nets64::of(&bench.nets, &skill);
    let start = net.clone();
    let words = net.nets[0].len();
    let (mut mean, mut square) = (vec![0.0; words], vec![0.0; words]);
    for (time, (child, goal)) in [(1, 0.8), (3, -0.6), (1, 0.1), (0, 0.9)].into_iter().enumerate() {
        let (mut scratch, x) = look(&bench, root, &mut next);
        let slopes = differences(&net, &x, child, goal);
        let t = time as i32 + 1;
        let corrected = rate * (1.0 - beta2.powi(t)).sqrt() / (1.0 - beta1.powi(t));
        for i in (0..words).filter(|i| used(i / LANES, i % LANES)) {
            mean[i] = beta1 * mean[i] + (1.0 - beta1) * slopes[i];
            square[i] = beta2 * square[i] + (1.0 - beta2) * slopes[i] * slopes[i];
            net.nets[0][i] -= corrected * mean[i] / (square[i] + epsilon * epsilon).sqrt();
        }
        let delta = goal as f32 - scratch.q[child];
        backward(&mut bench.nets, &mut scratch, &skill, &bench.params[root], 0, child as u32, delta, rate as f32);
        let found = Nets64::of(&bench.nets, &skill);
        for row in 0..34 {
            let range = row * LANES..(row + 1) * LANES;
            let moved = norm(range.clone().map(|i| net.nets[0][i] - start.nets[0][i]));
            let gap = norm(range.map(|i| net.nets[0][i] - found.nets[0][i]));
            assert!(gap <= 2.0e-3 * moved + 1.0e-7, "step {t}, row {row}: {gap} beside {moved}");
        }
    }
}
