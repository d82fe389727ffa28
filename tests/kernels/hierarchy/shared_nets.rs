//! Nets with an output for each child: values and gradients against f64, differences and the formulas of the papers.

use super::super::configs::{TREE, plan_with};
use super::super::learner::Learner;
use super::super::nets64::{Nets64, norm};
use super::super::observations::{bumpers, made_up, readings};
use super::super::random::random;
use skilltree::layout::{LANES, MAX_CHILDREN, Observation};

/// A root whose four children share one net of 20 hidden units, and its inputs for made-up senses.
fn shared_net(optimiser: &[&str]) -> (Learner, usize) {
    let mut set = vec!["skill.top.learning.shared_net=true", "skill.top.learning.hidden=20"];
    set.extend(["skill.top.inputs=['sonar-far', 'bumpers']", "skill.top.applicable={}"]);
    set.extend(optimiser);
    let learner = Learner::new(plan_with(TREE, &set));
    let root = learner.skill("top");
    let skill = &learner.shared.skills[root];
    assert_eq!((skill.nets, skill.outputs, skill.inputs, skill.rows), (1, 4, 28, 28 + 1 + 4 + 1));
    (learner, root)
}

/// The weights of the one net that are in use: hidden unit, or output for the last row.
fn used(row: usize, lane: usize) -> bool {
    if row == 33 { lane < 4 } else { lane < 20 }
}

/// Values of the shared net for an observation.
fn values(learner: &Learner, root: usize, made: Observation) -> [f32; MAX_CHILDREN] {
    learner.seen(|group| {
        group.record.observation = made;
        group.encode(root as u32, false);
        (group.forms.forward)(group, root as u32);
        group.q
    })
}

/// The inputs that an observation stands for.
fn inputs(made: &Observation) -> Vec<f64> {
    let sonar = readings(made).map(|reading| 2.0 * reading / 127.0 - 1.0);
    sonar.into_iter().chain(bumpers(made)).collect()
}

/// Moves one output of the shared net by the skill's optimiser; `delta` is the error.
fn move_output(learner: &mut Learner, root: usize, made: Observation, child: usize, delta: f32, rate: f32) {
    learner.act(|group| {
        group.record.observation = made;
        group.encode(root as u32, false);
        (group.forms.forward)(group, root as u32);
        (group.forms.backward)(group, root as u32, child as u32, delta, rate);
    });
}

#[test]
fn values_of_shared_nets_match_f64() {
    let (mut learner, root) = shared_net(&[]);
    let mut next = random(4);
    let mut spread = 0.0_f64;
    for _ in 0..200 {
        let made = made_up(&mut next);
        let q = values(&learner, root, made);
        let exact = Nets64::of(&learner.nets, &learner.shared.skills[root]).values(&inputs(&made));
        assert_eq!(exact.len(), 4);
        for (child, exact) in exact.iter().enumerate() {
            let found = f64::from(q[child]);
            assert!((found - exact).abs() < 1.0e-5, "child {child}: {found} for {exact}");
            spread = spread.max(exact.abs());
        }
        learner.nets.iter_mut().step_by(7).for_each(|w| *w = -*w);
    }
    assert!(spread > 0.3, "{spread}");
}

#[test]
fn one_step_descends_the_gradient_of_one_output() {
    let mut next = random(5);
    for (child, goal) in [(0, 0.9), (1, -0.7), (2, 0.2), (3, -0.95)] {
        let (mut learner, root) = shared_net(&["learning.optimiser=sgd", "learning.learning_rate=0.5"]);
        learner.params[root].beta1 = 0.0;
        let skill = learner.shared.skills[root];
        let made = made_up(&mut next);
        let net = Nets64::of(&learner.nets, &skill);
        let slopes = net.slopes(&inputs(&made), child, goal);
        let delta = goal as f32 - values(&learner, root, made)[child];
        // A large rate, because the change of a weight is exact only next to what it is added to.
        let before = learner.nets.clone();
        move_output(&mut learner, root, made, child, delta, 256.0);
        let after = Nets64::of(&learner.nets, &skill);
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
        let first = skill.net_offset(0);
        assert!(before[..first] == learner.nets[..first]);
    }
}

/// Adam with one clock for the whole net: outputs that a step does not teach have a gradient of 0 in it.
#[test]
fn adam_of_a_shared_net_follows_the_papers_formula() {
    let (mut learner, root) = shared_net(&["learning.learning_rate=0.01", "learning.epsilon=1e-3"]);
    let (beta1, beta2, epsilon, rate) = (0.9_f64, 0.999_f64, 1.0e-3_f64, 0.01_f64);
    let skill = learner.shared.skills[root];
    let mut next = random(6);
    let mut net = Nets64::of(&learner.nets, &skill);
    let start = net.clone();
    let words = net.nets[0].len();
    let (mut mean, mut square) = (vec![0.0; words], vec![0.0; words]);
    for (time, (child, goal)) in [(1, 0.8), (3, -0.6), (1, 0.1), (0, 0.9)].into_iter().enumerate() {
        let made = made_up(&mut next);
        let slopes = net.slopes(&inputs(&made), child, goal);
        let t = time as i32 + 1;
        let corrected = rate * (1.0 - beta2.powi(t)).sqrt() / (1.0 - beta1.powi(t));
        for i in (0..words).filter(|i| used(i / LANES, i % LANES)) {
            mean[i] = beta1 * mean[i] + (1.0 - beta1) * slopes[i];
            square[i] = beta2 * square[i] + (1.0 - beta2) * slopes[i] * slopes[i];
            net.nets[0][i] -= corrected * mean[i] / (square[i] + epsilon * epsilon).sqrt();
        }
        let delta = goal as f32 - values(&learner, root, made)[child];
        move_output(&mut learner, root, made, child, delta, rate as f32);
        let found = Nets64::of(&learner.nets, &skill);
        for row in 0..34 {
            let range = row * LANES..(row + 1) * LANES;
            let moved = norm(range.clone().map(|i| net.nets[0][i] - start.nets[0][i]));
            let gap = norm(range.map(|i| net.nets[0][i] - found.nets[0][i]));
            assert!(gap <= 2.0e-3 * moved + 1.0e-7, "step {t}, row {row}: {gap} beside {moved}");
        }
    }
}
