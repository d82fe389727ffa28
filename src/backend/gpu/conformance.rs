//! Is this adapter exact? The shipped functions answer the same questions on the adapter and in Rust, and
//! the answers are compared as bits.

use super::arithmetic_check::{ANSWER_WORDS, Answer, NAMES, QUESTION_WORDS, Question, SUBNORMAL, arithmetic_check};
use super::device::Device;
use super::loop_limit::{self, BOUNDS, loop_limit};
use super::pipeline::Pipeline;
use super::source::{ARITHMETIC_CHECK, Kernel, LOOP_LIMIT};
use crate::backend::BackendError;
use crate::backend::UNWRITTEN;
use crate::layout::LANES;
use crate::math::rng::philox;

/// Inputs of each function: enough that every shape known to be fused or re-associated shows it.
pub const QUESTIONS: usize = 1 << 17;

/// What the check found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verdict {
    /// Whether every answer has the same bits as Rust's.
    pub exact: bool,
    /// The first difference, or why nothing was compared.
    pub reason: Option<String>,
    /// Whether subnormal results are kept. They are flushed where they are stored, so this decides nothing.
    pub subnormals: bool,
    /// Turns after which the driver silently ends loops, if it does.
    pub loop_budget: Option<u32>,
}

/// Runs the check on a device.
///
/// # Errors
/// Where the device fails; an adapter that answers wrongly is no error but a verdict.
pub fn examine(device: &Device) -> Result<Verdict, BackendError> {
    let questions = questions(QUESTIONS);
    let answers = ask(device, &questions)?;
    let mut verdict = compare(&questions, &answers);
    let mut counts = [0; 3];
    answer(device, LOOP_LIMIT, bytemuck::bytes_of(&BOUNDS), bytemuck::bytes_of_mut(&mut counts), 3)?;
    let expected = loop_limit(BOUNDS);
    if counts[2] != expected[2] {
        let message = format!("the driver ends loops after fewer than {} turns", loop_limit::SAFE_TURNS);
        return Err(BackendError::Device { kernel: LOOP_LIMIT.name, message });
    }
    if counts != expected {
        verdict.loop_budget = Some(BOUNDS[0] - 1);
    }
    if !device.passthrough {
        verdict.exact = false;
        verdict
            .reason
            .get_or_insert("the backend does not take SPIR-V, so nothing fixes the order of operations".into());
    }
    Ok(verdict)
}

/// The fixed questions: every word a pure function of its place.
pub fn questions(count: usize) -> Vec<Question> {
    (0..count as u32).map(question).collect()
}

fn question(number: u32) -> Question {
    let words: [[u32; 4]; 3] = std::array::from_fn(|draw| philox([number, draw as u32, 0, 0], [0x5eed, 0x7e57]));
    let [w, v, u] = words;
    // Uniform in plus or minus `limit`.
    let spread = |word: u32, limit: f32| (word as i32 as f32) * (limit / 2_147_483_648.0);
    // Any mantissa with an exponent from `low`, one of `span`.
    let scaled = |word: u32, low: u32, span: u32| (word & 0x007f_ffff) | (low + (word >> 23) % span) << 23;
    let (a, b) = (spread(v[0], 4.0), spread(v[1], 4.0));
    // A third operand that nearly cancels the product shows a fused product best.
    let c = if number.is_multiple_of(4) { -(a * b) } else { spread(v[2], 4.0) };
    let angle = (w[2] >> 8) as f32 * (720.0 / 16_777_216.0);
    let mut question = [0; QUESTION_WORDS];
    question[0] = spread(w[0], 70.0).to_bits();
    question[1] = scaled(w[1], 28, 198);
    question[2] = angle.to_bits();
    question[3] = scaled(w[3], 1, 60);
    question[4] = a.to_bits();
    question[5] = b.to_bits();
    question[6] = c.to_bits();
    question[7] = spread(v[3] >> 1, 2.0).to_bits();
    question[8..].copy_from_slice(&u);
    question
}

/// What the device answers.
pub fn ask(device: &Device, questions: &[Question]) -> Result<Vec<Answer>, BackendError> {
    let mut answers = vec![[UNWRITTEN; ANSWER_WORDS]; questions.len()];
    let (asked, answered) = (bytemuck::cast_slice(questions), bytemuck::cast_slice_mut(&mut answers));
    answer(device, ARITHMETIC_CHECK, asked, answered, (questions.len() / LANES) as u32)?;
    Ok(answers)
}

/// Lets `groups` workgroups of a kernel with two buffers turn what is asked into answers.
fn answer(device: &Device, kernel: Kernel, asked: &[u8], answers: &mut [u8], groups: u32) -> Result<(), BackendError> {
    let pipeline = Pipeline::new(device, kernel, &[])?;
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
    let asked = device.filled(kernel.name, asked, 0, usage)?;
    let answered = device.filled(kernel.name, answers, 0, usage)?;
    let submission = pipeline.submit(device, &pipeline.bind(device, &[&asked, &answered]), (groups, 1));
    device.wait(kernel.name, Some(submission))?;
    device.download(kernel.name, &answered, answers)
}

/// One function or shape of which some answers are not Rust's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ShapeDifference {
    /// Its name.
    pub name: &'static str,
    /// How many answers differ.
    pub count: usize,
    /// The first input of those.
    pub input: usize,
    /// Rust's answer there.
    pub wanted: u32,
    /// The device's.
    pub found: u32,
}

/// Compares a device's answers with Rust's, bit by bit: what differs, function by function.
pub fn differences(questions: &[Question], answers: &[Answer]) -> Vec<ShapeDifference> {
    let mut differing = [None::<ShapeDifference>; ANSWER_WORDS];
    let groups = questions.as_chunks::<LANES>().0.iter().flat_map(arithmetic_check);
    for (input, (wanted, found)) in groups.zip(answers).enumerate() {
        for (word, name) in NAMES.into_iter().enumerate() {
            let (wanted, found) = (wanted[word], found[word]);
            if wanted != found {
                let first = ShapeDifference { name, count: 0, input, wanted, found };
                differing[word].get_or_insert(first).count += 1;
            }
        }
    }
    differing.into_iter().flatten().collect()
}

/// What follows from a device's answers.
pub fn compare(questions: &[Question], answers: &[Answer]) -> Verdict {
    let (flushed, wrong): (Vec<_>, Vec<_>) =
        differences(questions, answers).into_iter().partition(|shape| shape.name == SUBNORMAL);
    let reason = wrong.iter().min_by_key(|shape| shape.input).map(|shape| {
        let ShapeDifference { name, count, input, wanted, found } = shape;
        let of = questions.len();
        format!(
            "`{name}` differs on {count} of {of} inputs, first at input {input}: {found:#010x} instead of {wanted:#010x}"
        )
    });
    Verdict { exact: reason.is_none(), reason, subnormals: flushed.is_empty(), loop_budget: None }
}
