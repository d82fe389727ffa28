//! What a skill over skills learns from a recorded trial: targets by hand, and against recursions in f64 that are
//! written from the definitions.

use super::bench::{Bench, Nets64, TREE, made_up, most, random, readings, scratch_of};
use super::persistence::{Set, bits};
use skilltree::layout::{BASE_WORDS, LANES, RECORD_WORDS};
use skilltree::learn::lesson::{CUT, ENDED};
use skilltree::learn::td_lambda::{begin_replay, replay_step};
use skilltree::qnet::forward::net_of;

/// A learning rate so small that no weight changes, and a power of two, so that what was learned can be read off the
/// optimiser's velocities.
const HARDLY: f32 = 1.0 / (1_u64 << 60) as f32;
const NOBODY: u32 = 255;

/// One step of a trial.
#[derive(Debug, Clone)]
struct Step {
    senses: [u32; BASE_WORDS],
    /// The child that ran before.
    running: u32,
    child: usize,
    /// What a free choice would be made among.
    choices: Set,
    /// Whether it was free. If not, only the child that runs was allowed.
    free: bool,
    reward: f32,
}

/// A recorded trial. The last observation has no child and no reward.
#[derive(Debug, Clone)]
struct Trial {
    steps: Vec<Step>,
    last: Step,
    end: u32,
}

impl Step {
    fn allowed(&self) -> Set {
        // After the last step the child that ran would go on.
        let own = if self.child == NOBODY as usize { self.running as usize } else { self.child };
        if self.free { self.choices.clone() } else { [own].into() }
    }

    fn words(&self) -> [u32; RECORD_WORDS] {
        let mut words = [0; RECORD_WORDS];
        words[..BASE_WORDS].copy_from_slice(&self.senses);
        let free = u32::from(self.free) << 31;
        words[8] = self.child as u32 | bits(&self.allowed()) << 8 | bits(&self.choices) << 16 | free;
        words[9] = self.reward.to_bits();
        words[BASE_WORDS] = self.running;
        words
    }

    /// The nets' inputs, from the definitions: sonar-far, bumpers, running.
    fn inputs(&self, children: usize) -> Vec<f64> {
        let sonar = readings(&self.senses).map(|reading| 2.0 * reading / 127.0 - 1.0);
        let bumpers = (0..4).map(|side| f64::from(self.senses[6] >> (24 + side) & 1));
        let running = (0..children).map(|child| f64::from(u8::from(self.running as usize == child)));
        sonar.into_iter().chain(bumpers).chain(running).collect()
    }
}

/// How a trial is learned from.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Backup {
    Steps,
    Persistent,
    Decisions,
}

impl Backup {
    const ALL: [Self; 3] = [Self::Steps, Self::Persistent, Self::Decisions];

    fn name(self) -> &'static str {
        ["steps", "persistent", "decisions"][self as usize]
    }
}

/// A learner that only learns the root, and has its velocities at 0.
fn bench(backup: Backup, shared_net: bool, more: &[&str]) -> Bench {
    let own = [
        format!("skill.top.learning.backup={:?}", backup.name()),
        format!("skill.top.learning.shared_net={shared_net}"),
    ];
    let mut set: Vec<&str> = own.iter().map(String::as_str).collect();
    set.extend([
        "skill.top.learning.optimiser=sgd",
        "skill.top.learning.learning_rate=0.5",
        "skill.top.learning.momentum=0.0",
    ]);
    set.extend(more);
    let mut bench = Bench::new(TREE, &set);
    let root = bench.skill("top");
    let params = &mut bench.params[root];
    (params.learning_rate, params.learning_rate_fall, params.beta1) = (HARDLY, 0.0, 0.0);
    params.value_scale = 1.0 / 64.0;
    bench.state.skill = root as u32;
    bench
}

/// What one step of a replay taught: the child's new target, or nothing.
type Taught = Option<f64>;

/// Replays a trial; what each of its steps taught, first step first.
fn replay(bench: &mut Bench, trial: &Trial) -> Vec<Taught> {
    let root = bench.state.skill as usize;
    let skill = bench.shared.skills[root];
    assert_eq!(skill.record_words as usize, RECORD_WORDS);
    let mut words = vec![trial.steps.len() as u32, trial.end, 0, 0];
    trial.steps.iter().chain([&trial.last]).for_each(|step| words.extend(step.words()));
    let lesson = skill.memory_offset as usize;
    bench.lessons[lesson..lesson + words.len()].copy_from_slice(&words);
    let (before, mut found) = (bench.nets.clone(), Vec::new());
    let mut scratch = scratch_of(&[]);
    begin_replay(&mut bench.learner(), lesson as u32, 0, 0);
    for step in trial.steps.iter().rev() {
        let velocity = |child: usize| {
            let net = if skill.nets == 1 { 0 } else { child };
            let slab = net_of(&skill, 0, net as u32) as usize + skill.rows as usize * LANES;
            // The last row holds the output biases.
            slab + (skill.rows as usize - 1) * LANES + child - net
        };
        let at = velocity(step.child);
        bench.nets[at] = 0.0;
        let updates = bench.state.updates;
        if bench.state.replay_open == 1 {
            replay_step(&mut bench.learner(), &mut scratch, 0);
            assert_eq!(bench.state.updates, updates, "nothing is done after the last step");
        }
        replay_step(&mut bench.learner(), &mut scratch, 0);
        let learned = bench.state.updates - updates;
        // The slope of the output bias: the target's distance times the slope of the output.
        let slope = f64::from(bench.nets[at]) / f64::from(HARDLY);
        let q = f64::from(scratch.q[step.child]);
        found.push((learned == 1).then(|| q + slope / (1.0 - q * q)));
        assert!(learned == 1 || slope == 0.0);
    }
    assert_eq!((bench.state.replay_left, bench.state.replay_open), (0, 0));
    // No weight has moved, so every target was made from the same values.
    let weights = |nets: &[f32]| Nets64::of(nets, &skill).nets;
    for (now, then) in weights(&bench.nets).iter().flatten().zip(weights(&before).iter().flatten()) {
        assert!((now - then).abs() < 1.0e-15);
    }
    found.reverse();
    found
}

// By hand.

/// A learner with the same Q-values everywhere: 0.5, 0.25, -0.25 and 0.
fn constant(backup: Backup, shared_net: bool) -> Bench {
    let mut bench = bench(backup, shared_net, &[]);
    bench.nets.iter_mut().for_each(|w| *w = 0.0);
    let root = bench.skill("top");
    let skill = bench.shared.skills[root];
    for (child, worth) in [0.5_f32, 0.25, -0.25, 0.0].into_iter().enumerate() {
        let net = if shared_net { 0 } else { child };
        let biases = net_of(&skill, 0, net as u32) as usize + (skill.rows as usize - 1) * LANES;
        bench.nets[biases + child - net] = worth.atanh();
    }
    let params = &mut bench.params[root];
    (params.gamma, params.lambda, params.target_clip) = (0.5, 0.5, 0.875);
    (params.policy_threshold, params.inverse_temperature_start, params.inverse_temperature_slope) = (0.0, 4.0, 0.0);
    (params.intra_skill_share, params.timeout_terminal) = (0.0, 0);
    bench
}

/// Seven steps: children 1 1 2 2 2 0 0, freely chosen at steps 0, 2 and 5; rewards of -1/4 at step 1, 1/2 at step 3 and
/// 3/4 at step 6.
fn seven(end: u32) -> Trial {
    let mut next = random(2);
    let mut step = |running: u32, child: usize, choices: &[usize], free: bool, reward: f32| Step {
        senses: made_up(&mut next),
        running,
        child,
        choices: choices.iter().copied().collect(),
        free,
        reward: reward * 64.0,
    };
    let steps = vec![
        step(NOBODY, 1, &[1, 2, 3], true, 0.0),
        step(1, 1, &[1, 2, 3], false, -0.25),
        step(1, 2, &[0, 1, 2, 3], true, 0.0),
        step(2, 2, &[0, 1, 2, 3], false, 0.5),
        step(2, 2, &[1, 2], false, 0.0),
        step(2, 0, &[0, 3], true, 0.0),
        step(0, 0, &[0, 3], false, 0.75),
    ];
    let last = step(0, NOBODY as usize, &[1, 3], false, 0.0);
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
        check("steps", &replay(&mut constant(Backup::Steps, shared_net), &seven(ENDED)), &all(steps));

        // The same targets twice as far from the best value; the returns themselves stay.
        let mut bench = constant(Backup::Steps, shared_net);
        let root = bench.skill("top");
        bench.params[root].advantage_scale = 2.0;
        let best = [0.25, 0.25, 0.5, 0.5, 0.25, 0.5, 0.5];
        let far: [f64; 7] = std::array::from_fn(|t| (best[t] + 2.0 * (steps[t] - best[t])).clamp(-0.875, 0.875));
        // The last one would be 1 and is clipped.
        assert_eq!(far[6], 0.875);
        check("steps, scaled", &replay(&mut bench, &seven(ENDED)), &all(far));

        // What persistence allows, between decisions the child that runs: 1/4 | 1/4 | 1/2 | -1/4 -1/4 | 1/2 | 1/2.
        let v4 = 0.5 * (0.25 + 5.0 / 32.0);
        let v3 = 0.5 + 0.5 * (-0.125 + v4 / 2.0);
        let v2 = 0.5 * (-0.125 + v3 / 2.0);
        let v1 = -0.25 + 0.5 * (0.25 + v2 / 2.0);
        let v0 = 0.5 * (0.125 + v1 / 2.0);
        let persistent = [v0, v1, v2, v3, v4, 5.0 / 16.0, 0.75];
        check("persistent", &replay(&mut constant(Backup::Persistent, shared_net), &seven(ENDED)), &all(persistent));

        // At decisions: 5 earns 0 + 3/4 discounted once; 2 earns 1/2 discounted once, and three steps later the mixture
        // of the best value and the return there; 0 earns -1/4 discounted once, and so on two steps later.
        let w5 = 3.0 / 8.0;
        let w2 = 0.25 + 0.125 * (0.5 * 0.5 + 0.5 * w5);
        let w0 = -0.125 + 0.25 * (0.5 * 0.5 + 0.5 * w2);
        let only = [Some(w0), None, Some(w2), None, None, Some(w5), None];
        check("decisions", &replay(&mut constant(Backup::Decisions, shared_net), &seven(ENDED)), &only);

        // Those between are learned with what remains from there on.
        let mut bench = constant(Backup::Decisions, shared_net);
        bench.params[root].intra_skill_share = 1.0;
        let mixed5 = 0.5 * 0.5 + 0.5 * w5;
        let inner = [w0, -0.25 + 0.5 * (0.25 + 0.5 * w2), w2, 0.5 + 0.25 * mixed5, 0.5 * mixed5, w5, 0.75];
        check("decisions, all steps", &replay(&mut bench, &seven(ENDED)), &all(inner));

        // Cut: what persistence allows after the last step is to go on with child 0, worth 1/2; a free choice would be
        // among children 1 and 3, worth 1/4.
        let cut = |backup| replay(&mut constant(backup, shared_net), &seven(CUT));
        assert!((cut(Backup::Steps)[6].expect("learned") - 0.875).abs() < 1.0e-6);
        // 3/4 + 1/2 1/2 is beyond the limit, and it is the clipped return that is handed on.
        assert!((cut(Backup::Persistent)[6].expect("learned") - 0.875).abs() < 1.0e-6);
        let decided = cut(Backup::Decisions)[5].expect("learned");
        assert!((decided - 0.5 * 0.875).abs() < 1.0e-6, "{decided}");
        let mut wide = constant(Backup::Steps, shared_net);
        wide.params[root].target_clip = 4.0;
        let beyond = replay(&mut wide, &seven(CUT))[6].expect("learned");
        assert!((beyond - (0.75 + 0.5 * 0.25)).abs() < 1.0e-6, "{beyond}");
        let mut wide = constant(Backup::Persistent, shared_net);
        wide.params[root].target_clip = 4.0;
        let beyond = replay(&mut wide, &seven(CUT))[6].expect("learned");
        assert!((beyond - 1.0).abs() < 1.0e-6, "{beyond}");
        let mut terminal = constant(Backup::Decisions, shared_net);
        terminal.params[root].timeout_terminal = 1;
        check("decisions, terminal", &replay(&mut terminal, &seven(CUT)), &only);
    }
}

// At random.

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
    let mut steps: Vec<Step> = Vec::new();
    for t in 0..=count {
        let running = steps.last().map(|step| step.child);
        let drawn: Set = (0..4).filter(|_| next() < 0.6).collect();
        let choices = if drawn.is_empty() { (0..4).collect() } else { drawn };
        let free = running.is_none() || next() < 0.4;
        let pick = (next() * choices.len() as f64) as usize;
        let child = match running {
            Some(running) if !free => running,
            _ => choices.iter().copied().nth(pick).expect("a child"),
        };
        let reward = if next() < 0.4 { (next() * 64.0 - 32.0) as f32 } else { 0.0 };
        let running = running.map_or(NOBODY, |child| child as u32);
        let child = if t == count { NOBODY as usize } else { child };
        steps.push(Step { senses: made_up(next), running, child, choices, free, reward });
    }
    let last = steps.pop().expect("steps");
    Trial { steps, last, end: if next() < 0.5 { ENDED } else { CUT } }
}

#[test]
fn targets_are_those_of_the_definitions() {
    let mut next = random(3);
    let (mut learned, mut refused, mut skipped, mut drawn, mut cuts) = (0, 0, 0, 0, 0);
    let mut benches: Vec<(Bench, Vec<f32>)> = (0..6)
        .map(|number| {
            let bench = bench(Backup::ALL[number % 3], number % 2 == 1, &[]);
            let fresh = bench.nets.clone();
            (bench, fresh)
        })
        .collect();
    for round in 0..360 {
        let backup = Backup::ALL[round % 3];
        let (bench, fresh) = &mut benches[round % 6];
        let root = bench.skill("top");
        // Other weights each time; those that are not in use stay 0.
        bench.nets = fresh.iter().map(|w| if *w == 0.0 { 0.0 } else { (next() - 0.5) as f32 }).collect();
        let trial = trial(&mut next);
        let terms = Terms {
            gamma: [0.9, 0.99, 1.0][round / 3 % 3],
            lambda: [0.0, 0.3, 0.6, 0.95, 1.0][round / 9 % 5],
            stretch: [1.0, 1.0, 4.0][round / 6 % 3],
            inverse_temperature: 6.0,
            least: [0.0, 0.02, 0.1][round / 18 % 3],
        };
        let intra_skill_share: f64 = [0.0, 1.0, 0.5][round / 54 % 3];
        let params = &mut bench.params[root];
        (params.gamma, params.lambda) = (terms.gamma as f32, terms.lambda as f32);
        (params.advantage_scale, params.target_clip) = (terms.stretch as f32, 1.0e6);
        (params.inverse_temperature_start, params.inverse_temperature_slope) = (terms.inverse_temperature as f32, 0.0);
        (params.policy_threshold, params.intra_skill_share) = (terms.least as f32, intra_skill_share as f32);
        params.timeout_terminal = u32::from(round % 5 == 0);
        bench.state.trial = round as u32;

        let nets = Nets64::of(&bench.nets, &bench.shared.skills[root]);
        let offered = |step: &Step| if backup == Backup::Steps { step.choices.clone() } else { step.allowed() };
        let seen: Vec<Seen> = trial
            .steps
            .iter()
            .map(|step| Seen {
                q: nets.values(&step.inputs(4)),
                offered: offered(step),
                child: step.child,
                reward: f64::from(step.reward) / 64.0,
                free: step.free,
            })
            .collect();
        let ends = trial.end == ENDED || round % 5 == 0;
        let last = nets.values(&trial.last.inputs(4));
        let after = if ends { 0.0 } else { most(offered(&trial.last).iter().map(|child| last[*child])) };
        cuts += u32::from(!ends);
        if seen.iter().any(|seen| (seen.odds(terms.inverse_temperature) - terms.least).abs() < 1.0e-4) {
            continue;
        }
        let expected = defined(&seen, after, backup == Backup::Decisions, terms);
        let found = replay(bench, &trial);
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

/// Which steps between decisions are learned from changes from replay to replay and from trial to trial.
#[test]
fn steps_between_decisions_are_drawn_anew() {
    let mut bench = constant(Backup::Decisions, false);
    let root = bench.skill("top");
    let mut counts = [0_u32; 7];
    let mut patterns = std::collections::BTreeSet::new();
    bench.params[root].intra_skill_share = 0.25;
    for number in 0..1200 {
        (bench.state.trial, bench.state.replay) = (number / 40, number % 40);
        let found = replay(&mut bench, &seven(ENDED));
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
