//! Where two backends' results first differ.
//!
//! Words are compared as bits. A number that is not finite counts as a difference even where both sides hold
//! it, but for learners that have failed on both. The first difference is that of the first learner, and
//! within a learner that of the first field: the state's in the order of their declaration, then nets,
//! lessons and rows, word by word.

use super::{Cohort, UNWRITTEN};
use crate::layout::{Episode, LANES, LESSON_HEADER_WORDS, PHASE_FAILED, Robot, SkillShape, TrialRecord, layout_of};
use crate::qnet::optimiser::adam::BETA2_POWER;
use std::fmt;

/// What a net's three slabs hold: the weights, and what the optimiser keeps of each.
const SLABS: [&str; 3] = ["", "first moment of the ", "second moment of the "];

/// The first word in which two results differ.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    /// Kernel that left the word.
    pub kernel: &'static str,
    /// Learner, or robot of kernel `step`, that it belongs to.
    pub learner: usize,
    /// What the word holds.
    pub field: String,
    /// The word on the left side.
    pub left: u32,
    /// The word on the right side.
    pub right: u32,
    /// False where a side is not a finite number but should be; the sides may then be equal.
    pub finite: bool,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kernel, learner, field, left, right, finite } = self;
        let who = if *kernel == "step" { "robot" } else { "learner" };
        let finite = if *finite { "" } else { ", not finite" };
        write!(f, "kernel {kernel}, {who} {learner}: {field}: {left:#010x} against {right:#010x}{finite}")
    }
}

/// What a word holds, and whether that is an f32.
type WordField = (String, bool);

/// The first differing word of two equally long slices, described by `place`. Words are `tolerated` that need not be
/// numbers.
fn first(
    (kernel, learner): (&'static str, usize),
    (left, right): (&[u32], &[u32]),
    tolerated: impl Fn(u32, u32) -> bool,
    place: impl Fn(usize) -> WordField,
) -> Option<Difference> {
    left.iter().zip(right).enumerate().find_map(|(word, (&left, &right))| {
        let wild = |bits| !f32::from_bits(bits).is_finite();
        let suspect = (wild(left) || wild(right)) && !tolerated(left, right);
        if left == right && !suspect {
            return None;
        }
        let (field, number) = place(word);
        let finite = !(number && suspect);
        (left != right || !finite).then_some(Difference { kernel, learner, field, left, right, finite })
    })
}

/// A difference in size, which leaves nothing to compare.
pub(crate) fn sizes(kernel: &'static str, learner: usize, what: &str, left: usize, right: usize) -> Option<Difference> {
    let (left, right) = (left as u32, right as u32);
    let field = format!("number of {what}");
    (left != right).then_some(Difference { kernel, learner, field, left, right, finite: true })
}

/// Field of a shared struct that holds its word `word`.
fn field_of(layout: &str, word: usize) -> WordField {
    let fields = layout_of(layout).map_or(&[][..], |layout| layout.fields);
    let Some((name, offset, wgsl)) = fields.iter().rfind(|(_, offset, _)| *offset <= 4 * word) else {
        return (format!("word {word}"), false);
    };
    let within = word - offset / 4;
    if layout_of(wgsl).is_some() {
        prefixed(&format!("{name}."), field_of(wgsl, within))
    } else if wgsl.starts_with("array") {
        (format!("{name} {within}"), wgsl.contains("f32"))
    } else {
        ((*name).to_owned(), *wgsl == "f32")
    }
}

/// Word `word` of a learner's nets. A mirrored skill has none of its own.
fn nets_word(skills: &[SkillShape], word: usize) -> WordField {
    let mut owners = skills.iter().enumerate().filter(|(_, plan)| plan.mirrored == 0);
    let Some((skill, plan)) = owners.rfind(|(_, plan)| plan.nets_offset as usize <= word) else {
        return (format!("nets word {word}"), true);
    };
    let shared = plan.outputs > 1;
    let whose = |net: usize| if shared { "all children".to_owned() } else { format!("child {net}") };
    let text = if let Some(lane) = word.checked_sub(plan.clock_offset as usize) {
        let (order, net) = if lane < BETA2_POWER { ("first", lane) } else { ("second", lane - BETA2_POWER) };
        format!("{}, clock of {order} moments", whose(net))
    } else {
        let start = |net: &u32| plan.net_offset(*net);
        let net = (0..plan.nets).rfind(|net| start(net) <= word).unwrap_or(0);
        let within = word.saturating_sub(start(&net));
        let slab = plan.rows as usize * LANES;
        let Some(kind) = SLABS.get(within / slab) else {
            return (format!("nets word {word} (skill {skill}, between nets)"), true);
        };
        let (row, unit) = (within % slab / LANES, within % LANES);
        let (inputs, last) = (plan.inputs as usize, plan.rows as usize - 1);
        let what = match row {
            row if row < inputs => format!("weight of input {row}"),
            row if row == inputs => "hidden bias".to_owned(),
            row if row == last => "output bias".to_owned(),
            row if shared => format!("output weight of child {}", row - inputs - 1),
            _ => "output weight".to_owned(),
        };
        format!("{}, {kind}{what}, unit {unit}", whose(net as usize))
    };
    (format!("nets word {word} (skill {skill}, {text})"), true)
}

/// Word `word` of a learner's lessons.
fn lessons_word(skills: &[SkillShape], word: usize) -> WordField {
    let Some((skill, plan)) = skills.iter().enumerate().rfind(|(_, plan)| plan.memory_offset as usize <= word) else {
        return (format!("lessons word {word}"), false);
    };
    let within = word - plan.memory_offset as usize;
    let stride = (plan.lesson_stride as usize).max(1);
    let (slot, within) = (within / stride, within % stride);
    let (text, number) = match within.checked_sub(LESSON_HEADER_WORDS) {
        None => field_of("LessonHeader", within),
        Some(within) => {
            let words = plan.record_words as usize;
            let (text, number) = field_of("Step", within % words);
            (format!("step {}, {text}", within / words), number)
        }
    };
    (format!("lessons word {word} (skill {skill}, slot {slot}, {text})"), number)
}

/// Word `word` of a learner's trial table.
fn rows_word(word: usize) -> WordField {
    let words = size_of::<TrialRecord>() / 4;
    let (column, number) = field_of("TrialRecord", word % words);
    (format!("rows word {word} (row {}, {column})", word / words), number)
}

/// The first difference between two cohorts after kernel `train`. Words of lessons and rows that are
/// [`UNWRITTEN`] on both sides are equal.
pub fn advance(left: &Cohort, right: &Cohort) -> Option<Difference> {
    const KERNEL: &str = "train";
    let strides = |cohort: &Cohort| [cohort.skills, cohort.nets_stride, cohort.lessons_stride, cohort.rows_stride];
    let names = ["skills", "words of nets", "words of lessons", "words of rows"];
    let mut strides = names.iter().zip(strides(left)).zip(strides(right));
    if let Some(found) = strides.find_map(|((name, left), right)| sizes(KERNEL, 0, name, left, right)) {
        return Some(found);
    }
    let skills = &left.shared.skills;
    let one = |learner: usize| {
        let failed = [left, right].iter().all(|cohort| cohort.states[learner].phase == PHASE_FAILED);
        let unwritten = |left, right| failed || (left, right) == (UNWRITTEN, UNWRITTEN);
        let part = |stride: usize| learner * stride..(learner + 1) * stride;
        let (nets, lessons, rows) = (part(left.nets_stride), part(left.lessons_stride), part(left.rows_stride));
        let states = (words(&left.states[learner]), words(&right.states[learner]));
        let nets = (bytemuck::cast_slice(&left.nets[nets.clone()]), bytemuck::cast_slice(&right.nets[nets]));
        let lessons = (&left.lessons[lessons.clone()], &right.lessons[lessons]);
        let rows = (&left.rows[rows.clone()], &right.rows[rows]);
        let at = (KERNEL, learner);
        first(at, states, |_, _| failed, |word| prefixed("state ", field_of("LearnerState", word)))
            .or_else(|| first(at, nets, |_, _| failed, |word| nets_word(skills, word)))
            .or_else(|| first(at, lessons, unwritten, |word| lessons_word(skills, word)))
            .or_else(|| first(at, rows, unwritten, rows_word))
    };
    let learners = left.states.len().min(right.states.len());
    let size = || sizes(KERNEL, learners, "learners", left.states.len(), right.states.len());
    (0..learners).find_map(one).or_else(size)
}

/// The first difference between two tests, of which each learner took `episodes_per_learner` trials.
pub fn evaluate(left: &[Episode], right: &[Episode], episodes_per_learner: usize) -> Option<Difference> {
    let each = episodes_per_learner.max(1);
    let one = |(number, (left, right)): (usize, (&Episode, &Episode))| {
        let trial = format!("test trial {}, ", number % each);
        first(
            ("evaluate", number / each),
            (words(left), words(right)),
            |_, _| false,
            |word| prefixed(&trial, field_of("Episode", word)),
        )
    };
    let size = || sizes("evaluate", left.len().min(right.len()) / each, "test trials", left.len(), right.len());
    left.iter().zip(right).enumerate().find_map(one).or_else(size)
}

/// The first difference between robots after kernel `step`.
pub fn step(left: &[Robot], right: &[Robot]) -> Option<Difference> {
    let one = |(number, (left, right)): (usize, (&Robot, &Robot))| {
        first(("step", number), (words(left), words(right)), |_, _| false, |word| field_of("Robot", word))
    };
    let size = || sizes("step", left.len().min(right.len()), "robots", left.len(), right.len());
    left.iter().zip(right).enumerate().find_map(one).or_else(size)
}

fn prefixed(prefix: &str, (field, number): WordField) -> WordField {
    (format!("{prefix}{field}"), number)
}

fn words<T: bytemuck::Pod>(record: &T) -> &[u32] {
    bytemuck::cast_slice(std::slice::from_ref(record))
}
