//! Nets in f64 with the standard library's tanh, and their slopes by differences.

use super::observations::{bit, bumpers, readings, reflected, sees_light};
use skilltree::config::plan::{Child, Input, SkillPlan, Threshold};
use skilltree::layout::{LANES, SkillShape, Step};

/// The nets of one skill: rows of 32 weights, as the module's documentation lays them out.
#[derive(Debug, Clone)]
pub(crate) struct Nets64 {
    pub(crate) nets: Vec<Vec<f64>>,
    outputs: usize,
}

impl Nets64 {
    pub(crate) fn of(words: &[f32], skill: &SkillShape) -> Self {
        let net = |number: u32| {
            let first = skill.net_offset(number);
            words[first..first + skill.rows as usize * LANES].iter().map(|w| f64::from(*w)).collect()
        };
        Self { nets: (0..skill.nets).map(net).collect(), outputs: skill.outputs as usize }
    }

    /// Q-values of all children.
    pub(crate) fn values(&self, x: &[f64]) -> Vec<f64> {
        self.nets.iter().flat_map(|net| self.outputs_of(net, x)).collect()
    }

    fn outputs_of(&self, net: &[f64], x: &[f64]) -> Vec<f64> {
        let rows: Vec<&[f64]> = net.chunks(LANES).collect();
        let sum = |unit: usize| x.iter().zip(&rows).map(|(x, row)| x * row[unit]).sum::<f64>() + rows[x.len()][unit];
        let hidden: Vec<f64> = (0..LANES).map(|unit| sum(unit).tanh()).collect();
        let biases = rows[x.len() + 1 + self.outputs];
        let output = |number: usize| {
            let weights = rows[x.len() + 1 + number];
            (hidden.iter().zip(weights).map(|(h, w)| h * w).sum::<f64>() + biases[number]).tanh()
        };
        (0..self.outputs).map(output).collect()
    }

    /// The net that gives a child's value.
    pub(crate) fn net_of(&self, child: usize) -> usize {
        if self.nets.len() == 1 { 0 } else { child }
    }

    /// Slope of 0.5 (goal - Q)^2 along each weight of the child's net, by central differences.
    pub(crate) fn slopes(&self, x: &[f64], child: usize, goal: f64) -> Vec<f64> {
        let step = 1.0e-5;
        let number = self.net_of(child);
        let mut net = self.nets[number].clone();
        let mut loss_at = |i: usize, weight: f64| {
            let kept = net[i];
            net[i] = weight;
            let loss = 0.5 * (goal - self.outputs_of(&net, x)[child - number]).powi(2);
            net[i] = kept;
            loss
        };
        let slope = |(i, w): (usize, &f64)| (loss_at(i, w + step) - loss_at(i, w - step)) / (2.0 * step);
        self.nets[number].iter().enumerate().map(slope).collect()
    }
}

/// Length of a vector.
pub(crate) fn norm(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Greatest of some values.
pub(crate) fn most(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

/// What a skill's nets are given for a recorded step, from what the config's documentation says of its inputs.
pub(crate) fn inputs64(skill: &SkillPlan, rooms: usize, step: &Step) -> Vec<f64> {
    let seen = &step.observation;
    let (sonar, compass) = (readings(seen), f64::from(seen.compass));
    let near = |reading: f64, scale: f32| 2.0 * (-(reading - 12.0) / f64::from(scale)).exp() - 1.0;
    let known: Vec<usize> = (0..skill.children.len()).filter(|child| skill.applicable[*child].is_some()).collect();
    let one_of = |count: usize, own: u32| (0..count).map(|n| f64::from(u8::from(n == own as usize))).collect();
    let group = |input: &Input| -> Vec<f64> {
        match input {
            Input::Sonar { scale } => sonar.map(|reading| near(reading, *scale)).to_vec(),
            Input::SonarFar => sonar.map(|reading| 2.0 * reading / 127.0 - 1.0).to_vec(),
            Input::SonarCompass { scale } => {
                let share = |bearing: usize, ray: usize| {
                    let off = (15.0 * (bearing as f64 - ray as f64) - compass + 900.0).rem_euclid(360.0) - 180.0;
                    (1.0 - off.abs() / 15.0).max(0.0)
                };
                let value = |bearing| (0..24).map(|ray| share(bearing, ray) * near(sonar[ray], *scale)).sum();
                (0..24).map(value).collect()
            }
            Input::Light => (0..24).map(|ray| bit(seen.light_bumpers, ray)).collect(),
            Input::Bumpers => bumpers(seen).to_vec(),
            Input::Compass => vec![compass.to_radians().cos(), compass.to_radians().sin()],
            Input::Compass2 => vec![(2.0 * compass).to_radians().cos(), (2.0 * compass).to_radians().sin()],
            Input::Lit => vec![f64::from(u8::from(sees_light(seen)))],
            Input::Values => known.iter().map(|child| f64::from(step.value[*child])).collect(),
            Input::Applicable => known.iter().map(|child| bit(step.high_level, 8 + child)).collect(),
            Input::Running => one_of(skill.children.len(), step.high_level & 0xff),
            Input::LightTrace => vec![f64::from(step.light_trace)],
            Input::DoorTrace => [step.door_trace, step.door_cosine, step.door_sine].map(f64::from).to_vec(),
            Input::RangeMeans => [step.east_west, step.north_south].map(f64::from).to_vec(),
            Input::Room => one_of(rooms, step.high_level >> 16 & 0xff),
        }
    };
    skill.inputs.iter().flat_map(group).collect()
}

/// The skills of one learner.
pub(crate) struct Tree64<'a> {
    skills: &'a [SkillPlan],
    nets: Vec<Nets64>,
    rooms: usize,
}

impl<'a> Tree64<'a> {
    pub(crate) fn new(skills: &'a [SkillPlan], rooms: usize, shapes: &[SkillShape], nets: &[f32]) -> Self {
        Self { skills, nets: shapes.iter().map(|shape| Nets64::of(nets, shape)).collect(), rooms }
    }

    /// Q-values of a skill for a recorded step.
    pub(crate) fn values(&self, skill: usize, step: &Step) -> Vec<f64> {
        let own = &self.skills[skill];
        let image = Step { observation: reflected(&step.observation), ..*step };
        let seen = if own.mirror.is_some() { &image } else { step };
        self.nets[skill].values(&inputs64(own, self.rooms, seen))
    }

    /// What a skill's children are worth, 0 for those without a threshold.
    pub(crate) fn worths(&self, skill: usize, step: &Step) -> Vec<f64> {
        let worth = |(child, threshold): (&Child, &Option<Threshold>)| match (child, threshold) {
            (Child::Skill(below), Some(_)) => most(self.values(*below, step)),
            _ => 0.0,
        };
        self.skills[skill].children.iter().zip(&self.skills[skill].applicable).map(worth).collect()
    }
}
