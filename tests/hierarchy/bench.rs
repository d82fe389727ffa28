//! What these tests share: small configs, one learner's memory without a backend, and nets in f64.

use skilltree::config::plan::Plan;
use skilltree::config::{Overrides, load};
use skilltree::learner::build::Shape;
use skilltree::learner::layout::{BASE_WORDS, Cursor, LANES, RECORD_WORDS, Settings, SkillPlan};
use skilltree::learner::memory::{Learner, Scratch, Shared};
use skilltree::qnet::forward::net_of;
use skilltree::robot::floor::Floor;
use std::path::Path;

/// A config that lies in a folder of its own; its world is the small one.
pub(crate) fn plan_with(text: &str, set: &[&str]) -> Plan {
    let world = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/support/small.toml");
    let folder = tempfile::tempdir().expect("a folder for the config");
    let path = folder.path().join("small.toml");
    std::fs::write(&path, format!("world = {world:?}\n{text}")).expect("the config is written");
    let set = set.iter().map(|argument| (*argument).to_owned()).collect();
    load(&path, &Overrides { set, seeds: None }).unwrap_or_else(|error| panic!("{error}"))
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
    episodes = 1
    [learning]
    init = 0.4
    [skill.dock]
    inputs = ["sonar(60)", "light", "bumpers"]
    reward = { docked = 100, collision = -10 }
    ends = ["docked"]
    [skill.door]
    inputs = ["sonar(60)", "sonar-far", "bumpers"]
    reward = { passed-door = 100, collision = -10 }
    ends = ["passed-door"]
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
    ends = ["docked"]
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
    pub(crate) shared: Shared,
    pub(crate) settings: Vec<Settings>,
    pub(crate) cursor: Cursor,
    pub(crate) nets: Vec<f32>,
    pub(crate) lessons: Vec<u32>,
}

impl Bench {
    pub(crate) fn new(text: &str, set: &[&str]) -> Self {
        let plan = plan_with(text, set);
        let shape = Shape::new(plan.world(), &[&plan.arms[0]]).expect("the skills fit");
        let (settings, cursor, nets) = shape.learner(&plan.arms[0], plan.run_seed, 0);
        let floor = Floor::new(&shape.atlas.plan);
        let lessons = vec![0; shape.lessons_stride];
        let shared = Shared { floor, skills: shape.skills, atlas: shape.atlas.words, bank: vec![0] };
        Self { plan, shared, settings, cursor, nets, lessons }
    }

    pub(crate) fn learner(&mut self) -> Learner<'_> {
        Learner {
            shared: &self.shared,
            settings: &self.settings,
            cursor: &mut self.cursor,
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

/// Senses of a made-up observation: the first words of a record.
pub(crate) fn made_up(next: &mut impl FnMut() -> f64) -> [u32; BASE_WORDS] {
    let mut record = [0; BASE_WORDS];
    for ray in 0..24 {
        record[ray / 4] |= ((next() * 128.0) as u32) << (8 * (ray % 4));
    }
    record[6] = (next() * 268_435_456.0) as u32;
    record[7] = ((next() * 360.0) as f32).to_bits();
    record
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
    pub(crate) fn of(words: &[f32], skill: &SkillPlan) -> Self {
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
