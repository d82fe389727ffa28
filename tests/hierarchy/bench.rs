//! What these tests share: small configs, one learner's memory without a backend, and nets in f64.

#[path = "../support/made_up.rs"]
mod observations;

pub(crate) use observations::made_up;

use skilltree::config::plan::{Child, Input, Plan, SkillPlan, Threshold};
use skilltree::config::{Overrides, load};
use skilltree::env::segments::SegmentGrid;
use skilltree::env::workgroup::{CohortData, Learner, Scratch};
use skilltree::layout::{
    BASE_WORDS, HyperParams, LANES, LearnerState, MEMORY_WORD, RECORD_WORDS, SkillShape, VALUE_WORD,
};
use skilltree::qnet::forward::net_of;
use skilltree::train::allocate::Shape;
use std::path::Path;

/// A config of the small world.
pub(crate) fn plan_with(text: &str, set: &[&str]) -> Plan {
    plan_in("small", text, set)
}

/// A config that lies in a folder of its own, in one of the tests' worlds.
pub(crate) fn plan_in(name: &str, text: &str, set: &[&str]) -> Plan {
    let world = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/support/{name}.toml"));
    let folder = tempfile::tempdir().expect("a folder for the config");
    let path = folder.path().join("small.toml");
    std::fs::write(&path, format!("world = {world:?}\n{text}")).expect("the config is written");
    let set = set.iter().map(|argument| (*argument).to_owned()).collect();
    load(&path, &Overrides { set, ..Overrides::default() }).unwrap_or_else(|error| panic!("{error}"))
}

/// Four skills and one above them, for tests of single steps.
pub(crate) const TREE: &str = r#"
    title = "four skills and one above"
    seeds = "0"
    root = "top"
    [evaluate]
    at = []
    episodes = 1
    [teacher]
    eval_episodes = 1
    [learning]
    init_range = 0.4
    [skill.dock]
    inputs = ["sonar(60)", "light", "bumpers"]
    reward = { docked = 100, collision = -10 }
    goal = ["docked"]
    [skill.door]
    inputs = ["sonar(60)", "sonar-far", "bumpers"]
    reward = { passed-door = 100, collision = -10 }
    goal = ["passed-door"]
    [skill.right]
    inputs = ["sonar(30)", "bumpers"]
    reward = { beside-right = 8, collision = -10 }
    [skill.left]
    mirror = "right"
    [skill.top]
    children = ["dock", "door", "right", "left"]
    inputs = ["sonar-far", "bumpers", "running"]
    applicable = { dock = 0.25, door = 0.5 }
    reward = { docked = 100 }
    goal = ["docked"]
    max_steps = 200
"#;

/// A small repeatable stream of numbers in 0..1: of these tests, not the product's.
pub(crate) fn random(mut state: u64) -> impl FnMut() -> f64 {
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// One learner of a plan's first arm, without a bank, and its memory.
pub(crate) struct Bench {
    pub(crate) plan: Plan,
    pub(crate) shared: CohortData,
    pub(crate) params: Vec<HyperParams>,
    pub(crate) state: LearnerState,
    pub(crate) nets: Vec<f32>,
    pub(crate) lessons: Vec<u32>,
}

impl Bench {
    pub(crate) fn new(text: &str, set: &[&str]) -> Self {
        let plan = plan_with(text, set);
        let shape = Shape::new(plan.world(), &[&plan.arms[0]]).expect("the skills fit");
        let (params, state, nets) = shape.learner(&plan.arms[0], plan.run_seed, 0);
        let floor = SegmentGrid::new(&shape.tables.plan, &shape.tables.words);
        let lessons = vec![0; shape.lessons_stride];
        let shared = CohortData { floor, skills: shape.skills, tables: shape.tables.words, bank: vec![0] };
        Self { plan, shared, params, state, nets, lessons }
    }

    pub(crate) fn learner(&mut self) -> Learner<'_> {
        Learner {
            shared: &self.shared,
            params: &self.params,
            state: &mut self.state,
            nets: &mut self.nets,
            lessons: &mut self.lessons,
            rows: &mut [],
        }
    }

    /// Number of the skill of this name.
    pub(crate) fn skill(&self, name: &str) -> usize {
        self.plan.arms[0].skills.iter().position(|skill| skill.name == name).expect("a skill of this name")
    }
}

/// Scratch memory with a record's words.
pub(crate) fn scratch_of(words: &[u32]) -> Scratch {
    let mut record = [0; RECORD_WORDS];
    record[..words.len()].copy_from_slice(words);
    Scratch { record, ..Scratch::default() }
}

/// The 24 readings of a record.
pub(crate) fn readings(record: &[u32]) -> [f64; 24] {
    let bytes: Vec<u8> = record[..6].iter().flat_map(|word| word.to_le_bytes()).collect();
    std::array::from_fn(|ray| f64::from(bytes[ray]))
}

/// The nets of one skill in f64: rows of 32 weights, as the module's documentation lays them out.
#[derive(Clone)]
pub(crate) struct Nets64 {
    pub(crate) nets: Vec<Vec<f64>>,
    outputs: usize,
}

impl Nets64 {
    pub(crate) fn of(words: &[f32], skill: &SkillShape) -> Self {
        let net = |number: u32| {
            let first = net_of(skill, 0, number) as usize;
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
}

/// Greatest of some values.
pub(crate) fn most(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

/// What a skill's nets are given for a record, from what the config's documentation says of its inputs.
pub(crate) fn inputs64(skill: &SkillPlan, rooms: usize, record: &[u32]) -> Vec<f64> {
    let sonar = readings(record);
    let float = |word: usize| f64::from(f32::from_bits(record[word]));
    let bit = |word: u32, at: usize| f64::from(word >> at & 1);
    let near = |reading: f64, scale: f32| 2.0 * (-(reading - 12.0) / f64::from(scale)).exp() - 1.0;
    let known: Vec<usize> = (0..skill.children.len()).filter(|child| skill.applicable[*child].is_some()).collect();
    let group = |input: &Input| -> Vec<f64> {
        match input {
            Input::Sonar { scale } => sonar.map(|reading| near(reading, *scale)).to_vec(),
            Input::SonarFar => sonar.map(|reading| 2.0 * reading / 127.0 - 1.0).to_vec(),
            Input::SonarCompass { scale } => {
                let compass = float(7);
                let share = |bearing: usize, ray: usize| {
                    let off = (15.0 * (bearing as f64 - ray as f64) - compass + 900.0).rem_euclid(360.0) - 180.0;
                    (1.0 - off.abs() / 15.0).max(0.0)
                };
                let value = |bearing| (0..24).map(|ray| share(bearing, ray) * near(sonar[ray], *scale)).sum();
                (0..24).map(value).collect()
            }
            Input::Light => (0..24).map(|ray| bit(record[6], ray)).collect(),
            Input::Bumpers => (0..4).map(|side| bit(record[6], 24 + side)).collect(),
            Input::Compass => vec![float(7).to_radians().cos(), float(7).to_radians().sin()],
            Input::Compass2 => vec![(2.0 * float(7)).to_radians().cos(), (2.0 * float(7)).to_radians().sin()],
            Input::Lit => vec![f64::from(u8::from(record[6] & 0xff_ffff != 0))],
            Input::Values => known.iter().map(|child| float(VALUE_WORD + child)).collect(),
            Input::Applicable => known.iter().map(|child| bit(record[BASE_WORDS], 8 + child)).collect(),
            Input::Running => {
                let running = (record[BASE_WORDS] & 0xff) as usize;
                (0..skill.children.len()).map(|child| f64::from(u8::from(child == running))).collect()
            }
            Input::LightTrace => vec![float(MEMORY_WORD + 2)],
            Input::DoorTrace => (3..6).map(|word| float(MEMORY_WORD + word)).collect(),
            Input::RangeMeans => (0..2).map(|word| float(MEMORY_WORD + word)).collect(),
            Input::Room => {
                let room = (record[BASE_WORDS] >> 16 & 0xff) as usize;
                (0..rooms).map(|own| f64::from(u8::from(own == room))).collect()
            }
        }
    };
    skill.inputs.iter().flat_map(group).collect()
}

/// The record of what the mirror image of a robot would sense.
pub(crate) fn reflected(record: &[u32]) -> [u32; BASE_WORDS] {
    let mut out = [0; BASE_WORDS];
    let byte = |ray: usize| record[ray / 4] >> (8 * (ray % 4)) & 0xff;
    for ray in 0..24 {
        // Straight ahead and straight back stay; the others change sides.
        let other = if ray == 0 { 0 } else { 24 - ray };
        out[ray / 4] |= byte(other) << (8 * (ray % 4));
        out[6] |= (record[6] >> other & 1) << ray;
    }
    for (side, other) in [(0, 0), (1, 3), (2, 2), (3, 1)] {
        out[6] |= (record[6] >> (24 + other) & 1) << (24 + side);
    }
    out[7..].copy_from_slice(&record[7..BASE_WORDS]);
    out
}

/// The skills of one learner, in f64.
pub(crate) struct Tree64<'a> {
    skills: &'a [SkillPlan],
    nets: Vec<Nets64>,
    rooms: usize,
}

impl<'a> Tree64<'a> {
    pub(crate) fn new(skills: &'a [SkillPlan], rooms: usize, plans: &[SkillShape], nets: &[f32]) -> Self {
        Self { skills, nets: plans.iter().map(|plan| Nets64::of(nets, plan)).collect(), rooms }
    }

    /// Q-values of a skill for a record.
    pub(crate) fn values(&self, skill: usize, record: &[u32]) -> Vec<f64> {
        let own = &self.skills[skill];
        let mut seen = record.to_vec();
        if own.mirror.is_some() {
            seen[..BASE_WORDS].copy_from_slice(&reflected(record));
        }
        self.nets[skill].values(&inputs64(own, self.rooms, &seen))
    }

    /// What a skill's children are worth, 0 for those without a threshold.
    pub(crate) fn worths(&self, skill: usize, record: &[u32]) -> Vec<f64> {
        let worth = |(child, threshold): (&Child, &Option<Threshold>)| match (child, threshold) {
            (Child::Skill(below), Some(_)) => most(self.values(*below, record)),
            _ => 0.0,
        };
        self.skills[skill].children.iter().zip(&self.skills[skill].applicable).map(worth).collect()
    }
}
