//! Taught lessons replayed again and again, and backward replay as one would write it without lanes: one net, one
//! hidden unit, one weight at a time.
//!
//! Weights lie as in most programs, input by input within a hidden unit. The order of every sum is the twins', so
//! that results can be compared as bytes.

use super::BenchError;
use crate::backend::{Backend, Cohort, Stop};
use crate::config::plan::Plan;
use crate::env::workgroup::Learner;
use crate::layout::sensors::{GROUP_BUMPERS, GROUP_LIGHT, GROUP_SONAR};
use crate::layout::{HyperParams, LANES, LESSON_HEADER, LearnerState, SkillShape};
use crate::learn::lesson::CUT;
use crate::learn::td_lambda::taught_lesson;
use crate::math::functions::{exponential, flush, reciprocal, reciprocal_sqrt, square_root, tanh};
use crate::qnet::backward::{CLOCK_SECOND, OPTIMISER_ADAM_ROWS, OPTIMISER_SGD};
use crate::qnet::forward::{bits_of, lanes_of, net_of};
use crate::train::batch_group::{Group, groups};
use bytemuck::Zeroable;

/// Learners that learn from their taught lessons, pass after pass.
#[derive(Debug)]
pub struct Drill {
    group: Group,
    cohort: Cohort,
}

impl Drill {
    /// The taught learners of the plan's first arm, one per seed, before their first replay.
    ///
    /// # Errors
    /// Where the teacher fails.
    pub fn new(plan: &Plan) -> Result<Self, BenchError> {
        let group = groups(plan)?.swap_remove(0);
        let cohort = group.cohort(plan, &group.learners(plan));
        Ok(Self { group, cohort })
    }

    /// Shape of the skill that is learned.
    pub fn skill(&self) -> &SkillShape {
        &self.group.shared.skills[0]
    }

    /// The learners' memory before the first replay.
    pub fn cohort(&self) -> &Cohort {
        &self.cohort
    }

    /// How a learner learns.
    pub fn params(&self, learner: usize) -> &HyperParams {
        &self.cohort.params[learner * self.cohort.skills]
    }

    /// Word of the bank at which taught lesson `number` of a learner stands.
    pub fn lesson_of(&self, learner: usize, number: u32) -> usize {
        let mut state: LearnerState = LearnerState::zeroed();
        let params = std::slice::from_ref(self.params(learner));
        let shared = &self.group.shared;
        let learner = Learner { shared, params, state: &mut state, nets: &mut [], lessons: &mut [], rows: &mut [] };
        taught_lesson(&learner, number) as usize
    }

    /// All learners replay on a backend that holds their memory.
    ///
    /// # Errors
    /// Where the backend fails.
    pub fn replay(backend: &mut dyn Backend) -> Result<(), BenchError> {
        let stop = Stop { skill: 0, trial: 0 };
        while !backend.advance(stop)?.iter().all(|state| stop.holds(state)) {}
        Ok(())
    }

    /// The same by the scalar reference, on nets from [`Drill::nets`].
    pub fn replay_scalar(&self, nets: &mut [Nets], passes: u32) {
        let shared = &self.group.shared;
        for (number, nets) in nets.iter_mut().enumerate() {
            let params = self.params(number);
            for _pass in 0..passes {
                for lesson in 0..params.lessons {
                    let at = self.lesson_of(number, lesson);
                    nets.replay(&shared.bank[at..], self.skill(), params, &shared.tables);
                }
            }
        }
    }

    /// Transitions that all learners replay in so many passes.
    pub fn transitions(&self, passes: u32) -> u64 {
        let learners = 0..self.cohort.states.len();
        let lessons =
            learners.flat_map(|learner| (0..self.params(learner).lessons).map(move |number| (learner, number)));
        let steps = lessons.map(|(learner, number)| u64::from(self.group.shared.bank[self.lesson_of(learner, number)]));
        steps.sum::<u64>() * u64::from(passes)
    }

    /// The nets of a cohort of this shape, for the scalar reference.
    pub fn nets(&self, cohort: &Cohort) -> Vec<Nets> {
        let units = lanes_of(self.params(0).hidden);
        cohort.nets.chunks(cohort.nets_stride).map(|words| Nets::from_lanes(words, self.skill(), units)).collect()
    }

    /// Inputs of a step that are not bits, or are set: the mean over the taught lessons.
    pub fn inputs_seen(&self) -> f64 {
        let (shared, skill) = (&self.group.shared, self.skill());
        let lessons = (0..self.cohort.states.len())
            .flat_map(|learner| (0..self.params(learner).lessons).map(move |lesson| self.lesson_of(learner, lesson)));
        let records = lessons.flat_map(|at| {
            let steps = shared.bank[at] as usize;
            shared.bank[at + LESSON_HEADER..].chunks(skill.record_words as usize).take(steps)
        });
        let bits = bits_of(skill);
        let seen = |record: &[u32]| {
            let x = encode(record, skill, &shared.tables);
            x.iter().enumerate().filter(|(input, x)| (bits >> input) & 1 == 0 || **x != 0.0).count()
        };
        let (sum, count) = records.fold((0, 0_usize), |(sum, count), record| (sum + seen(record), count + 1));
        sum as f64 / count.max(1) as f64
    }
}

/// One hidden unit's weights, or one of their moments: inputs, then the bias.
type Unit = Vec<f32>;

/// Weights, mean gradients, or mean squared gradients of one net.
#[derive(Debug, Clone)]
struct Slab {
    units: Vec<Unit>,
    output: Vec<f32>,
    bias: f32,
}

/// The net of one child and its Adam state.
#[derive(Debug, Clone)]
struct Net {
    weights: Slab,
    means: Slab,
    squares: Slab,
    /// Second moment of each row of weights, for the rule that has no others.
    rows: Vec<f32>,
    first: f32,
    second: f32,
}

/// The nets of one skill.
#[derive(Debug, Clone)]
pub struct Nets {
    nets: Vec<Net>,
    inputs: usize,
}

impl Nets {
    /// Copies a learner's nets, of so many units, out of the lanes' layout.
    pub fn from_lanes(words: &[f32], skill: &SkillShape, units: usize) -> Self {
        let inputs = skill.inputs as usize;
        let slab_words = skill.rows as usize * LANES;
        let slab = |at: usize| {
            let rows = words[at..at + slab_words].as_chunks::<LANES>().0;
            Slab {
                units: (0..units).map(|unit| (0..=inputs).map(|row| rows[row][unit]).collect()).collect(),
                output: rows[inputs + 1][..units].to_vec(),
                bias: rows[inputs + 2][0],
            }
        };
        let nets = (0..skill.children)
            .map(|child| {
                let at = net_of(skill, 0, child) as usize;
                let clock = (skill.clock_offset + child) as usize;
                Net {
                    weights: slab(at),
                    means: slab(at + slab_words),
                    squares: slab(at + 2 * slab_words),
                    rows: words[at + 2 * slab_words..][..inputs + 3].to_vec(),
                    first: words[clock],
                    second: words[clock + CLOCK_SECOND as usize],
                }
            })
            .collect();
        Self { nets, inputs }
    }

    /// All weights, child by child: unit by unit the inputs' weights and the bias, then the output's weights and its
    /// bias.
    pub fn weights(&self) -> Vec<f32> {
        let of = |slab: &Slab| {
            let units = slab.units.iter().flatten().copied();
            units.chain(slab.output.iter().copied()).chain([slab.bias]).collect::<Vec<_>>()
        };
        self.nets.iter().flat_map(|net| of(&net.weights)).collect()
    }

    /// Learns from a taught lesson backwards.
    pub fn replay(&mut self, lesson: &[u32], skill: &SkillShape, params: &HyperParams, tables: &[u32]) {
        let steps = lesson[0] as usize;
        let (mut next_best, mut next_return) = (0.0, 0.0);
        let open = lesson[1] == CUT && params.timeout_terminal == 0;
        for step in (0..if open { steps + 1 } else { steps }).rev() {
            let at = LESSON_HEADER + step * skill.record_words as usize;
            let record = &lesson[at..at + skill.record_words as usize];
            let x = encode(record, skill, tables);
            let hidden: Vec<Vec<f32>> = self.nets.iter().map(|net| self.hidden(net, &x)).collect();
            let q: Vec<f32> = self.nets.iter().zip(&hidden).map(|(net, hidden)| output(net, hidden)).collect();
            let best = q.iter().copied().fold(-2.0, f32::max);
            // The filter's odds are part of the work, though taught steps pass whatever they are.
            let odds: f32 = q.iter().map(|value| exponential(params.inverse_temperature_start * (value - best))).sum();
            std::hint::black_box(odds);
            if step == steps {
                (next_best, next_return) = (best, best);
                continue;
            }
            let child = (record[8] & 0xff) as usize;
            let future = (1.0 - params.lambda) * next_best + params.lambda * next_return;
            let aim = f32::from_bits(record[9]) * params.value_scale + params.gamma * future;
            let goal = aim.max(-params.target_clip).min(params.target_clip);
            self.learn(child, &x, &hidden[child], q[child], goal - q[child], params);
            (next_best, next_return) = (best, goal);
        }
    }

    fn hidden(&self, net: &Net, x: &[f32]) -> Vec<f32> {
        let unit = |unit: &Unit| {
            let mut sum = unit[self.inputs];
            for (weight, x) in unit[..self.inputs].iter().zip(x) {
                sum += weight * x;
            }
            tanh(sum)
        };
        net.weights.units.iter().map(unit).collect()
    }

    fn learn(&mut self, child: usize, x: &[f32], hidden: &[f32], value: f32, delta: f32, params: &HyperParams) {
        let net = &mut self.nets[child];
        let error = delta * (1.0 - value * value);
        if params.optimiser == OPTIMISER_SGD {
            net.update(x, hidden, error, |weight, velocity, _, slope| {
                *velocity = flush(params.beta1 * *velocity + params.learning_rate * slope);
                *weight += *velocity;
            });
            return;
        }
        net.first = flush(net.first * params.beta1);
        net.second = flush(net.second * params.beta2);
        let rate = params.learning_rate * square_root(1.0 - net.second) * reciprocal(1.0 - net.first);
        if params.optimiser == OPTIMISER_ADAM_ROWS {
            net.update_rows(x, hidden, error, rate, params);
            return;
        }
        net.update(x, hidden, error, |weight, mean, square, slope| {
            *mean = flush(params.beta1 * *mean + (1.0 - params.beta1) * slope);
            *square = flush(params.beta2 * *square + (1.0 - params.beta2) * (slope * slope));
            *weight += rate * *mean * reciprocal_sqrt(*square + params.epsilon2);
        });
    }
}

impl Net {
    /// Hands every weight with its two moments and its slope to `rule`.
    fn update(&mut self, x: &[f32], hidden: &[f32], error: f32, rule: impl Fn(&mut f32, &mut f32, &mut f32, f32)) {
        let Self { weights, means, squares, .. } = self;
        for (unit, active) in hidden.iter().enumerate() {
            let slope = error * weights.output[unit] * (1.0 - active * active);
            let (w, m, s) = (&mut weights.units[unit], &mut means.units[unit], &mut squares.units[unit]);
            for (input, x) in x.iter().enumerate() {
                rule(&mut w[input], &mut m[input], &mut s[input], slope * x);
            }
            let bias = x.len();
            rule(&mut w[bias], &mut m[bias], &mut s[bias], slope);
            let (w, m, s) = (&mut weights.output[unit], &mut means.output[unit], &mut squares.output[unit]);
            rule(w, m, s, error * active);
        }
        rule(&mut weights.bias, &mut means.bias, &mut squares.bias, error);
    }

    /// Adam with one second moment for each row of weights: of one input, of the hidden biases, of the output.
    fn update_rows(&mut self, x: &[f32], hidden: &[f32], error: f32, rate: f32, params: &HyperParams) {
        let Self { weights, means, rows, .. } = self;
        let slope = |unit: usize| error * weights.output[unit] * (1.0 - hidden[unit] * hidden[unit]);
        let slopes: Vec<f32> = (0..hidden.len()).map(slope).collect();
        let below = mean_square(&slopes, params);
        let above = mean_square(hidden, params);
        // The factor that a row's gradient has in common, and the pace at which the row moves.
        let mut pace = |row: usize, factor: f32, alike: f32| {
            let square = params.beta2 * rows[row] + (1.0 - params.beta2) * (factor * factor * alike);
            rows[row] = flush(square);
            ((1.0 - params.beta1) * factor, rate * reciprocal_sqrt(rows[row] + params.epsilon2))
        };
        let step = |weight: &mut f32, mean: &mut f32, (factor, pace): (f32, f32), own: f32| {
            *mean = flush(params.beta1 * *mean + factor * own);
            *weight += pace * *mean;
        };
        let bias = x.len();
        for (input, factor) in x.iter().copied().chain([1.0]).enumerate() {
            let moves = pace(input, factor, below);
            for unit in 0..hidden.len() {
                step(&mut weights.units[unit][input], &mut means.units[unit][input], moves, slopes[unit]);
            }
        }
        let moves = pace(bias + 1, error, above);
        for unit in 0..hidden.len() {
            step(&mut weights.output[unit], &mut means.output[unit], moves, hidden[unit]);
        }
        step(&mut weights.bias, &mut means.bias, pace(bias + 2, error, 1.0), 1.0);
    }
}

/// Mean over the hidden units of their squared values.
fn mean_square(values: &[f32], params: &HyperParams) -> f32 {
    tree_sum(values.iter().map(|value| value * value).collect()) * params.unit_share
}

/// Sum in the lanes' order.
fn tree_sum(mut sums: Vec<f32>) -> f32 {
    while sums.len() > 1 {
        let half = sums.len() / 2;
        sums = (0..half).map(|lane| sums[lane] + sums[lane + half]).collect();
    }
    sums[0]
}

fn output(net: &Net, hidden: &[f32]) -> f32 {
    let sum = tree_sum(net.weights.output.iter().zip(hidden).map(|(weight, active)| active * weight).collect());
    tanh(sum + net.weights.bias)
}

/// Inputs of the nets from one recorded step.
pub fn encode(record: &[u32], skill: &SkillShape, tables: &[u32]) -> Vec<f32> {
    let mut x = Vec::with_capacity(skill.inputs as usize);
    for group in 0..skill.groups as usize {
        match skill.group_kind[group] {
            GROUP_SONAR => x.extend((0..24).map(|ray| {
                let byte = (record[ray / 4] >> (8 * (ray % 4))) & 0xff;
                f32::from_bits(tables[(skill.group_table[group] + byte) as usize])
            })),
            GROUP_LIGHT => x.extend((0..24).map(|ray| ((record[6] >> ray) & 1) as f32)),
            GROUP_BUMPERS => x.extend((0..4).map(|side| ((record[6] >> (24 + side)) & 1) as f32)),
            other => unreachable!("docking has no input group {other}"),
        }
    }
    x
}
