//! Targets of a trial of seven steps, by hand.

use super::super::learner::Learner;
use super::super::observations::made_up;
use super::super::random::random;
use super::targets::{Backup, Taken, Taught, Trial, learner, replay};
use skilltree::layout::{LANES, NO_CHILD, TERMINATED, TRUNCATED};

/// A learner with the same Q-values everywhere: 0.5, 0.25, -0.25 and 0.
fn constant(backup: Backup, shared_net: bool) -> Learner {
    let mut learner = learner(backup, shared_net);
    learner.nets.iter_mut().for_each(|w| *w = 0.0);
    let root = learner.skill("top");
    let skill = learner.shared.skills[root];
    for (child, worth) in [0.5_f32, 0.25, -0.25, 0.0].into_iter().enumerate() {
        let net = if shared_net { 0 } else { child };
        let biases = skill.net_offset(net as u32) + (skill.rows as usize - 1) * LANES;
        learner.nets[biases + child - net] = worth.atanh();
    }
    let params = &mut learner.params[root];
    (params.gamma, params.lambda, params.target_clip) = (0.5, 0.5, 0.875);
    (params.policy_threshold, params.inverse_temperature_start, params.inverse_temperature_slope) = (0.0, 4.0, 0.0);
    (params.intra_skill_share, params.timeout_terminal) = (0.0, 0);
    learner
}

/// Seven steps: children 1 1 2 2 2 0 0, freely chosen at steps 0, 2 and 5; rewards of -1/4 at step 1, 1/2 at step 3 and
/// 3/4 at step 6.
fn seven(end: u32) -> Trial {
    let mut next = random(2);
    let mut step = |running: u32, child: u32, choices: &[usize], free: bool, reward: f32| Taken {
        seen: made_up(&mut next),
        running,
        child,
        choices: choices.iter().copied().collect(),
        free,
        reward: reward * 64.0,
    };
    let steps = vec![
        step(NO_CHILD, 1, &[1, 2, 3], true, 0.0),
        step(1, 1, &[1, 2, 3], false, -0.25),
        step(1, 2, &[0, 1, 2, 3], true, 0.0),
        step(2, 2, &[0, 1, 2, 3], false, 0.5),
        step(2, 2, &[1, 2], false, 0.0),
        step(2, 0, &[0, 3], true, 0.0),
        step(0, 0, &[0, 3], false, 0.75),
    ];
    let last = step(0, NO_CHILD, &[1, 3], false, 0.0);
    Trial { steps, last, end }
}

fn check(what: &str, found: &[Taught], expected: &[Taught]) {
    assert_eq!(found.len(), expected.len());
    for (step, (found, expected)) in found.iter().zip(expected).enumerate() {
        let same = match (found, expected) {
            (Some(found), Some(expected)) => (found - expected).abs() < 1.0e-6,
            (found, expected) => found == expected,
        };
        assert!(same, "{what}, step {step}: {found:?} for {expected:?}");
    }
}

#[test]
fn seven_steps_by_hand() {
    let all = |targets: [f64; 7]| targets.map(Some).to_vec();
    for shared_net in [false, true] {
        // Every step, the best over what could be chosen freely. Best values: 1/4 1/4 1/2 1/2 1/4 1/2 1/2.
        //   u6 = 3/4
        //   u5 = 1/2 (1/2 1/2 + 1/2 3/4) = 5/16, u4 = 1/2 (1/4 + 5/32) = 13/64, u3 = 1/2 + 1/2 (1/8 + 13/128),
        //   u2 = 1/2 (1/4 + u3/2), u1 = -1/4 + 1/2 (1/4 + u2/2), u0 = 1/2 (1/8 + u1/2).
        let u3 = 0.5 + 0.5 * (0.125 + 13.0 / 128.0);
        let u2 = 0.5 * (0.25 + u3 / 2.0);
        let u1 = -0.25 + 0.5 * (0.25 + u2 / 2.0);
        let u0 = 0.5 * (0.125 + u1 / 2.0);
        let steps = [u0, u1, u2, u3, 13.0 / 64.0, 5.0 / 16.0, 0.75];
        check("steps", &replay(&mut constant(Backup::Steps, shared_net), &seven(TERMINATED)), &all(steps));

        // The same targets twice as far from the best value; the returns themselves stay.
        let mut learner = constant(Backup::Steps, shared_net);
        let root = learner.skill("top");
        learner.params[root].advantage_scale = 2.0;
        let best = [0.25, 0.25, 0.5, 0.5, 0.25, 0.5, 0.5];
        let far: [f64; 7] = std::array::from_fn(|t| (best[t] + 2.0 * (steps[t] - best[t])).clamp(-0.875, 0.875));
        // The last one would be 1 and is clipped.
        assert_eq!(far[6], 0.875);
        check("steps, scaled", &replay(&mut learner, &seven(TERMINATED)), &all(far));

        // What persistence allows, between decisions the child that runs: 1/4 | 1/4 | 1/2 | -1/4 -1/4 | 1/2 | 1/2.
        let v4 = 0.5 * (0.25 + 5.0 / 32.0);
        let v3 = 0.5 + 0.5 * (-0.125 + v4 / 2.0);
        let v2 = 0.5 * (-0.125 + v3 / 2.0);
        let v1 = -0.25 + 0.5 * (0.25 + v2 / 2.0);
        let v0 = 0.5 * (0.125 + v1 / 2.0);
        let persistent = [v0, v1, v2, v3, v4, 5.0 / 16.0, 0.75];
        check(
            "persistent",
            &replay(&mut constant(Backup::Persistent, shared_net), &seven(TERMINATED)),
            &all(persistent),
        );

        // At decisions: 5 earns 0 + 3/4 discounted once; 2 earns 1/2 discounted once, and three steps later the mixture
        // of the best value and the return there; 0 earns -1/4 discounted once, and so on two steps later.
        let w5 = 3.0 / 8.0;
        let w2 = 0.25 + 0.125 * (0.5 * 0.5 + 0.5 * w5);
        let w0 = -0.125 + 0.25 * (0.5 * 0.5 + 0.5 * w2);
        let only = [Some(w0), None, Some(w2), None, None, Some(w5), None];
        check("decisions", &replay(&mut constant(Backup::Decisions, shared_net), &seven(TERMINATED)), &only);

        // Those between are learned with what remains from there on.
        let mut learner = constant(Backup::Decisions, shared_net);
        learner.params[root].intra_skill_share = 1.0;
        let mixed5 = 0.5 * 0.5 + 0.5 * w5;
        let inner = [w0, -0.25 + 0.5 * (0.25 + 0.5 * w2), w2, 0.5 + 0.25 * mixed5, 0.5 * mixed5, w5, 0.75];
        check("decisions, all steps", &replay(&mut learner, &seven(TERMINATED)), &all(inner));

        // Cut: what persistence allows after the last step is to go on with child 0, worth 1/2; a free choice would be
        // among children 1 and 3, worth 1/4.
        let cut = |backup| replay(&mut constant(backup, shared_net), &seven(TRUNCATED));
        assert!((cut(Backup::Steps)[6].expect("learned") - 0.875).abs() < 1.0e-6);
        // 3/4 + 1/2 1/2 is beyond the limit, and it is the clipped return that is handed on.
        assert!((cut(Backup::Persistent)[6].expect("learned") - 0.875).abs() < 1.0e-6);
        let decided = cut(Backup::Decisions)[5].expect("learned");
        assert!((decided - 0.5 * 0.875).abs() < 1.0e-6, "{decided}");
        let mut wide = constant(Backup::Steps, shared_net);
        wide.params[root].target_clip = 4.0;
        let beyond = replay(&mut wide, &seven(TRUNCATED))[6].expect("learned");
        assert!((beyond - (0.75 + 0.5 * 0.25)).abs() < 1.0e-6, "{beyond}");
        let mut wide = constant(Backup::Persistent, shared_net);
        wide.params[root].target_clip = 4.0;
        let beyond = replay(&mut wide, &seven(TRUNCATED))[6].expect("learned");
        assert!((beyond - 1.0).abs() < 1.0e-6, "{beyond}");
        let mut terminal = constant(Backup::Decisions, shared_net);
        terminal.params[root].timeout_terminal = 1;
        check("decisions, terminal", &replay(&mut terminal, &seven(TRUNCATED)), &only);
    }
}

/// Which steps between decisions are learned from changes from replay to replay and from trial to trial.
#[test]
fn steps_between_decisions_are_drawn_anew() {
    let mut learner = constant(Backup::Decisions, false);
    let root = learner.skill("top");
    let mut counts = [0_u32; 7];
    let mut patterns = std::collections::BTreeSet::new();
    learner.params[root].intra_skill_share = 0.25;
    for number in 0..1200 {
        (learner.state.trial, learner.state.replay) = (number / 40, number % 40);
        let found = replay(&mut learner, &seven(TERMINATED));
        patterns.insert(found.iter().map(Option::is_some).collect::<Vec<bool>>());
        found.iter().enumerate().for_each(|(t, found)| counts[t] += u32::from(found.is_some()));
    }
    for (t, count) in counts.iter().enumerate() {
        // Four standard errors of a share of 0.25.
        let expected = if [0, 2, 5].contains(&t) { *count == 1200 } else { (f64::from(*count) - 300.0).abs() < 60.0 };
        assert!(expected, "step {t}: {count}");
    }
    assert_eq!(patterns.len(), 16);
}
