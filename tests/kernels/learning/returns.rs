//! Returns and targets of TD(lambda).

use super::super::learner::Learner;
use super::super::nets64::{Nets64, most};
use super::super::observations::made_up;
use super::super::random::random;
use super::{ALL, HARDLY, Trial, docking, free_step, inputs_of};
use skilltree::layout::{LANES, Observation, TERMINATED, TRUNCATED};
use skilltree::math::functions::tanh;

/// A learner whose Q-values are exact: with the front bumper child 0 is worth 0.5 and child 1 -0.5, with the left one
/// child 2 is worth 0.1875, all else 0. Gamma is 0.5 and a reward of 64 counts 1.
fn exact(lambda: f32) -> Learner {
    let mut learner = docking(&["learning.optimiser=\"sgd\"", "learning.momentum=0.0"]);
    learner.nets.iter_mut().for_each(|w| *w = 0.0);
    let skill = learner.shared.skills[0];
    // A weight of 40 makes a hidden unit a copy of a bumper's bit.
    let copy = tanh(40.0);
    assert!(copy > 0.999_999 && tanh(0.0) == 0.0);
    for (child, bumper, worth) in [(0, 0, 0.5), (1, 0, -0.5), (2, 1, 0.1875_f32)] {
        let near = worth.atanh();
        let candidates = (-200..200).map(|i| f32::from_bits(near.to_bits().wrapping_add_signed(i)));
        let weight = candidates.into_iter().find(|w| tanh(copy * *w) == worth).expect("some weight gives this value");
        let net = skill.net_offset(child);
        learner.nets[net + (48 + bumper) * LANES + bumper] = 40.0;
        learner.nets[net + (skill.inputs as usize + 1) * LANES + bumper] = weight;
    }
    let params = &mut learner.params[0];
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
    learner
}

const NONE: u32 = 0;
const FRONT: u32 = 1;
const LEFT: u32 = 2;

/// Five steps: nothing, front, left, nothing, front; then left. The greatest Q-values are 0, 0.5, 0.1875, 0, 0.5; 0.1875.
fn five_steps(end: u32, last_reward: f32) -> Trial {
    let mut next = random(8);
    let mut at = |bumpers: u32| {
        let made = made_up(&mut next);
        Observation { light_bumpers: made.light_bumpers & 0x00ff_ffff | bumpers << 24, ..made }
    };
    let mut step = |bumpers, child, reward| free_step(at(bumpers), child, ALL, reward);
    let steps = vec![
        step(NONE, 3, 0.0),
        step(FRONT, 0, -8.0),
        step(LEFT, 4, 0.0),
        step(NONE, 5, 0.0),
        step(FRONT, 1, last_reward),
    ];
    Trial { steps, last: at(LEFT), end }
}

/// What one replay of the five steps must leave: the returns, first step first, and whether each step is learned.
fn expect(learner: &mut Learner, trial: &Trial, taught: u32, returns: [f32; 5], learned: [bool; 5], what: &str) {
    learner.keep(trial);
    let mut found = learner.replay(taught);
    found.reverse();
    // A bias that has moved by `HARDLY` shows where a value is 0.
    let near = |found: f32, exact: f32| if exact == 0.0 { found.abs() < 1.0e-17 } else { found == exact };
    assert!(found.iter().zip(returns).all(|(found, exact)| near(*found, exact)), "{what}: {found:?}, not {returns:?}");
    // Q of the child of each step, in its state.
    let values = [0.0, 0.5, 0.0, 0.0, -0.5];
    for (step, value) in values.iter().enumerate() {
        let child = trial.steps[step].choice & 0xff;
        // The output bias is 0, its slope is the error times (1 - Q^2): exact.
        let error = (returns[step] - value) * (1.0 - value * value);
        let expected = if learned[step] { error } else { 0.0 };
        assert!(near(learner.bias(child) / HARDLY, expected), "{what}: step {step}");
    }
    let learned = learned.iter().filter(|learned| **learned).count() as u32;
    assert_eq!((learner.bias(2), learner.state.updates), (0.0, learned), "{what}");
}

#[test]
fn five_step_returns_are_the_ones_computed_by_hand() {
    let all = [true; 5];
    let goal = five_steps(TERMINATED, 48.0);
    let cut = five_steps(TRUNCATED, 48.0);
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
        expect(&mut clipped, &five_steps(TERMINATED, 48.0 * sign), 0, returns, all, "clipped");
    }
}

#[test]
fn steps_that_are_no_policy_cut_the_chain() {
    // In front of a wall child 1 is chosen once in e^20 times: its step is not learned, and the best value, 0.5,
    // stands for its return.
    let goal = five_steps(TERMINATED, 48.0);
    let but_last = [true, true, true, true, false];
    let mut learner = exact(1.0);
    learner.params[0].policy_threshold = 1.0e-5;
    expect(&mut learner, &goal, 0, [-0.03125, -0.0625, 0.125, 0.25, 0.5], but_last, "lambda 1");
    let mut learner = exact(0.5);
    learner.params[0].policy_threshold = 1.0e-5;
    expect(&mut learner, &goal, 0, [0.109375, -0.0625, 0.0625, 0.25, 0.5], but_last, "lambda 0.5");
    // A higher threshold also refuses step 2: child 4 at 0 beside child 2 at 0.1875, e^-3.75. Its best
    // value is 0.1875.
    let mut learner = exact(1.0);
    learner.params[0].policy_threshold = 0.03;
    let returns = [-0.015625, -0.03125, 0.1875, 0.25, 0.5];
    expect(&mut learner, &goal, 0, returns, [true, true, false, true, false], "threshold 0.03");
    // Taught steps count whatever their probability, if so configured, and only they do.
    let all = [true; 5];
    let full = [-0.015625, -0.03125, 0.1875, 0.375, 0.75];
    for (taught, learned, returns) in [(1, all, full), (0, [true, true, false, true, false], returns)] {
        let mut learner = exact(1.0);
        learner.params[0].policy_threshold = 0.03;
        learner.params[0].taught_as_policy = 1;
        expect(&mut learner, &goal, taught, returns, learned, "taught always");
    }
    // A masked child is not what the best value is about: without child 0 the best in front of the wall is 0.
    let mut masked = goal;
    masked.steps[4] = free_step(masked.steps[4].observation, 1, ALL & !1, 48.0);
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
        let mut learner = docking(&["learning.optimiser=\"sgd\"", "learning.init_range=0.4"]);
        let params = &mut learner.params[0];
        (params.learning_rate, params.beta1) = (HARDLY, 0.0);
        (params.lambda, params.gamma) = (lambda as f32, gamma as f32);
        (params.target_clip, params.policy_threshold, params.inverse_temperature_start) = (1.0e6, 0.05, 5.0);
        (params.taught_as_policy, params.timeout_terminal) = (0, u32::from(round % 7 == 0));
        let terminal = params.timeout_terminal == 1;
        let count = 1 + (next() * 30.0) as usize;
        let step = |next: &mut dyn FnMut() -> f64| {
            let (made, child) = (made_up(&mut || next()), (next() * 6.0) as u32);
            free_step(made, child, ALL, if next() < 0.3 { (next() * 200.0 - 100.0) as f32 } else { 0.0 })
        };
        let taken = (0..count).map(|_| step(&mut next)).collect();
        let end = if next() < 0.5 { TERMINATED } else { TRUNCATED };
        let trial = Trial { steps: taken, last: made_up(&mut next), end };

        let nets = Nets64::of(&learner.nets, &learner.shared.skills[0]);
        let values = |seen: &Observation| nets.values(&inputs_of(seen));
        let all: Vec<Vec<f64>> = trial.steps.iter().map(|step| values(&step.observation)).collect();
        let best = |q: &[f64]| most(q.iter().copied());
        let mut peaks: Vec<f64> = all.iter().map(|q| best(q)).collect();
        peaks.push(if end == TERMINATED || terminal { 0.0 } else { best(&values(&trial.last)) });
        let odds = |t: usize| {
            let weights: Vec<f64> = all[t].iter().map(|q| (5.0 * q).exp()).collect();
            weights[(trial.steps[t].choice & 0xff) as usize] / weights.iter().sum::<f64>()
        };
        if (0..count).any(|t| (odds(t) - 0.05).abs() < 1.0e-4) {
            continue;
        }
        let policy: Vec<bool> = (0..count).map(|t| odds(t) > 0.05).collect();
        let forwards = |t: usize| {
            let reach = (t + 1..count).find(|k| !policy[*k]).unwrap_or(count) - t;
            let ahead = |n: usize| {
                let paid = (0..n).map(|i| gamma.powi(i as i32) * f64::from(trial.steps[t + i].reward) / 100.0);
                paid.sum::<f64>() + gamma.powi(n as i32) * peaks[t + n]
            };
            let mixed = (1..reach).map(|n| (1.0 - lambda) * lambda.powi(n as i32 - 1) * ahead(n)).sum::<f64>();
            mixed + lambda.powi(reach as i32 - 1) * ahead(reach)
        };
        learner.keep(&trial);
        let mut found = learner.replay(0);
        found.reverse();
        for t in 0..count {
            let expected = if policy[t] { forwards(t) } else { peaks[t] };
            let error = (f64::from(found[t]) - expected).abs();
            assert!(error < 1.0e-5 * (1.0 + expected.abs()), "round {round} step {t}: {} for {expected}", found[t]);
        }
        steps += count;
        cuts += usize::from(end == TRUNCATED && !terminal);
        refused += policy.iter().filter(|policy| !**policy).count();
        assert_eq!(learner.state.updates as usize, policy.iter().filter(|policy| **policy).count());
    }
    assert!(steps > 3000 && cuts > 80 && refused > 100, "{steps} {cuts} {refused}");
}
