//! Targets of random trials against recursions in f64 that are written from the definitions.

use super::super::learner::Learner;
use super::super::nets64::{Nets64, most};
use super::super::observations::made_up;
use super::super::random::random;
use super::persistence::Set;
use super::targets::{Backup, Taken, Trial, learner, replay};
use skilltree::layout::{NO_CHILD, TERMINATED, TRUNCATED};

/// The numbers of one way of learning.
#[derive(Debug, Clone, Copy)]
struct Terms {
    gamma: f64,
    lambda: f64,
    /// Factor on the distance of targets from the best value.
    stretch: f64,
    inverse_temperature: f64,
    /// Least probability of a child that is learned.
    least: f64,
}

/// What one step of a recorded trial gives to the recursions.
struct Seen {
    q: Vec<f64>,
    offered: Set,
    child: usize,
    reward: f64,
    free: bool,
}

impl Seen {
    fn best(&self) -> f64 {
        most(self.offered.iter().map(|child| self.q[*child]))
    }

    /// Probability of the child that ran: 0 where it is not offered.
    fn odds(&self, inverse_temperature: f64) -> f64 {
        if !self.offered.contains(&self.child) {
            return 0.0;
        }
        let weight = |child: usize| (inverse_temperature * self.q[child]).exp();
        weight(self.child) / self.offered.iter().map(|child| weight(*child)).sum::<f64>()
    }
}

/// Targets by their definition, and whether the step is learned, first step first. `after` is the value of what follows
/// the last step.
///
/// A decision's return is the discounted sum of what is earned until the next decision, and there the mixture of the
/// best value and of that decision's own return. Where every step counts as a decision this is TD(lambda). A child that
/// would hardly be chosen is not learned, and its return is not handed on: the best value stands for it.
fn defined(seen: &[Seen], after: f64, at_decisions: bool, terms: Terms) -> Vec<(f64, bool)> {
    let decides = |t: usize| !at_decisions || seen[t].free;
    let mut returns = vec![0.0; seen.len()];
    let mut handed = vec![0.0; seen.len()];
    for t in (0..seen.len()).rev() {
        let next = (t + 1..seen.len()).find(|k| decides(*k)).unwrap_or(seen.len());
        let earned: f64 = (t..next).map(|k| terms.gamma.powi((k - t) as i32) * seen[k].reward).sum();
        let mixed = match seen.get(next) {
            Some(there) => (1.0 - terms.lambda) * there.best() + terms.lambda * handed[next],
            None => after,
        };
        returns[t] = earned + terms.gamma.powi((next - t) as i32) * mixed;
        handed[t] = if seen[t].odds(terms.inverse_temperature) > terms.least { returns[t] } else { seen[t].best() };
    }
    let target = |t: usize| seen[t].best() + terms.stretch * (returns[t] - seen[t].best());
    (0..seen.len()).map(|t| (target(t), seen[t].odds(terms.inverse_temperature) > terms.least)).collect()
}

/// A trial of five to ten steps, and how it looks to some way of learning.
fn trial(next: &mut impl FnMut() -> f64) -> Trial {
    let count = 5 + (next() * 6.0) as usize;
    let mut steps: Vec<Taken> = Vec::new();
    for t in 0..=count {
        let running = steps.last().map(|step| step.child);
        let drawn: Set = (0..4).filter(|_| next() < 0.6).collect();
        let choices = if drawn.is_empty() { (0..4).collect() } else { drawn };
        let free = running.is_none() || next() < 0.4;
        let pick = (next() * choices.len() as f64) as usize;
        let child = match running {
            Some(running) if !free => running,
            _ => choices.iter().copied().nth(pick).expect("a child") as u32,
        };
        let reward = if next() < 0.4 { (next() * 64.0 - 32.0) as f32 } else { 0.0 };
        let running = running.unwrap_or(NO_CHILD);
        let child = if t == count { NO_CHILD } else { child };
        steps.push(Taken { seen: made_up(next), running, child, choices, free, reward });
    }
    let last = steps.pop().expect("steps");
    Trial { steps, last, end: if next() < 0.5 { TERMINATED } else { TRUNCATED } }
}

#[test]
fn targets_are_those_of_the_definitions() {
    let mut next = random(3);
    let (mut learned, mut refused, mut skipped, mut drawn, mut cuts) = (0, 0, 0, 0, 0);
    let mut learners: Vec<(Learner, Vec<f32>)> = (0..6)
        .map(|number| {
            let learner = learner(Backup::ALL[number % 3], number % 2 == 1);
            let fresh = learner.nets.clone();
            (learner, fresh)
        })
        .collect();
    for round in 0..360 {
        let backup = Backup::ALL[round % 3];
        let (learner, fresh) = &mut learners[round % 6];
        let root = learner.skill("top");
        // Other weights each time; those that are not in use stay 0.
        learner.nets = fresh.iter().map(|w| if *w == 0.0 { 0.0 } else { (next() - 0.5) as f32 }).collect();
        let trial = trial(&mut next);
        let terms = Terms {
            gamma: [0.9, 0.99, 1.0][round / 3 % 3],
            lambda: [0.0, 0.3, 0.6, 0.95, 1.0][round / 9 % 5],
            stretch: [1.0, 1.0, 4.0][round / 6 % 3],
            inverse_temperature: 6.0,
            least: [0.0, 0.02, 0.1][round / 18 % 3],
        };
        let intra_skill_share: f64 = [0.0, 1.0, 0.5][round / 54 % 3];
        let params = &mut learner.params[root];
        (params.gamma, params.lambda) = (terms.gamma as f32, terms.lambda as f32);
        (params.advantage_scale, params.target_clip) = (terms.stretch as f32, 1.0e6);
        (params.inverse_temperature_start, params.inverse_temperature_slope) = (terms.inverse_temperature as f32, 0.0);
        (params.policy_threshold, params.intra_skill_share) = (terms.least as f32, intra_skill_share as f32);
        params.timeout_terminal = u32::from(round % 5 == 0);
        learner.state.trial = round as u32;

        let nets = Nets64::of(&learner.nets, &learner.shared.skills[root]);
        let offered = |step: &Taken| if backup == Backup::Steps { step.choices.clone() } else { step.allowed() };
        let seen: Vec<Seen> = trial
            .steps
            .iter()
            .map(|step| Seen {
                q: nets.values(&step.inputs(4)),
                offered: offered(step),
                child: step.child as usize,
                reward: f64::from(step.reward) / 64.0,
                free: step.free,
            })
            .collect();
        let ends = trial.end == TERMINATED || round % 5 == 0;
        let last = nets.values(&trial.last.inputs(4));
        let after = if ends { 0.0 } else { most(offered(&trial.last).iter().map(|child| last[*child])) };
        cuts += u32::from(!ends);
        if seen.iter().any(|seen| (seen.odds(terms.inverse_temperature) - terms.least).abs() < 1.0e-4) {
            continue;
        }
        let expected = defined(&seen, after, backup == Backup::Decisions, terms);
        let found = replay(learner, &trial);
        for (t, (found, (target, policy))) in found.iter().zip(&expected).enumerate() {
            let says = || format!("round {round} {backup:?} {terms:?} step {t}: {found:?} for {target} {policy}");
            let inner = backup == Backup::Decisions && !seen[t].free;
            match found {
                Some(found) => {
                    assert!((found - target).abs() < 2.0e-5 * (1.0 + target.abs()), "{}", says());
                    assert!(*policy && !(inner && intra_skill_share == 0.0), "{}", says());
                    learned += 1;
                    drawn += u32::from(inner && intra_skill_share == 0.5);
                }
                None => {
                    assert!(!policy || (inner && intra_skill_share < 1.0), "{}", says());
                    refused += u32::from(!policy);
                    skipped += u32::from(inner && intra_skill_share == 0.5);
                }
            }
        }
    }
    println!("{learned} {refused} {skipped} {drawn} {cuts}");
    assert!(learned > 1200 && refused > 30 && cuts > 100);
    // Of the steps between decisions about as many are learned from as the share says.
    let share = f64::from(drawn) / f64::from(drawn + skipped);
    assert!(drawn + skipped > 100 && (share - 0.5).abs() < 0.18, "{share} of {}", drawn + skipped);
}
