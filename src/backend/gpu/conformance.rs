//! Is this adapter exact? The shipped functions answer the same questions on the adapter and in Rust, and
//! the answers are compared as bits.

use super::arithmetic_check::{ANSWER_WORDS, Answer, NAMES, QUESTION_WORDS, Question, SUBNORMAL, arithmetic_check};
use super::device::Device;
use super::loop_limit::{self, BOUNDS, loop_limit};
use super::pipeline::Pipeline;
use super::source::{ARITHMETIC_CHECK, LOOP_LIMIT};
use crate::backend::BackendError;
use crate::backend::UNWRITTEN;
use crate::layout::LANES;
use crate::math::rng::philox;
use bytemuck::Zeroable;

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
    let counts = count_turns(device)?;
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
///
/// # Errors
/// Where the device fails.
pub fn ask(device: &Device, questions: &[Question]) -> Result<Vec<Answer>, BackendError> {
    let pipeline = Pipeline::new(device, ARITHMETIC_CHECK)?;
    let storage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
    let asked = device.buffer(ARITHMETIC_CHECK.name, size_of_val(questions) as u64, storage)?;
    let mut answers = vec![[UNWRITTEN; ANSWER_WORDS]; questions.len()];
    let answered = device.buffer(ARITHMETIC_CHECK.name, size_of_val(&answers[..]) as u64, storage)?;
    device.upload(ARITHMETIC_CHECK.name, &asked, bytemuck::cast_slice(questions))?;
    device.upload(ARITHMETIC_CHECK.name, &answered, bytemuck::cast_slice(&answers))?;
    let bind_group = pipeline.bind(device, &[&asked, &answered]);
    pipeline.dispatch(device, &bind_group, (questions.len() / LANES) as u32, 1)?;
    device.download(ARITHMETIC_CHECK.name, &answered, bytemuck::cast_slice_mut(&mut answers))?;
    Ok(answers)
}

/// Compares a device's answers with Rust's, bit by bit.
pub fn compare(questions: &[Question], answers: &[Answer]) -> Verdict {
    let mut verdict = Verdict { exact: true, reason: None, subnormals: true, loop_budget: None };
    let mut differing = [0_usize; ANSWER_WORDS];
    let mut first = None;
    for (group, (asked, found)) in
        questions.as_chunks::<LANES>().0.iter().zip(answers.as_chunks::<LANES>().0).enumerate()
    {
        for (lane, (wanted, found)) in arithmetic_check(asked).iter().zip(found).enumerate() {
            for word in 0..ANSWER_WORDS {
                if wanted[word] != found[word] {
                    differing[word] += 1;
                    if NAMES[word] == SUBNORMAL {
                        verdict.subnormals = false;
                    } else {
                        first.get_or_insert((group * LANES + lane, word, wanted[word], found[word]));
                    }
                }
            }
        }
    }
    if let Some((number, word, wanted, found)) = first {
        verdict.exact = false;
        verdict.reason = Some(format!(
            "`{}` differs on {} of {} inputs, first at input {number}: {found:#010x} instead of {wanted:#010x}",
            NAMES[word],
            differing[word],
            questions.len()
        ));
    }
    verdict
}

/// The states that the canary's loops reach on the device.
fn count_turns(device: &Device) -> Result<[u32; 3], BackendError> {
    let pipeline = Pipeline::new(device, LOOP_LIMIT)?;
    let storage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
    let bounds = device.buffer(LOOP_LIMIT.name, size_of_val(&BOUNDS) as u64, storage)?;
    let mut counts = <[u32; 3]>::zeroed();
    let counted = device.buffer(LOOP_LIMIT.name, size_of_val(&counts) as u64, storage)?;
    device.upload(LOOP_LIMIT.name, &bounds, bytemuck::bytes_of(&BOUNDS))?;
    let bind_group = pipeline.bind(device, &[&bounds, &counted]);
    pipeline.dispatch(device, &bind_group, 3, 1)?;
    device.download(LOOP_LIMIT.name, &counted, bytemuck::bytes_of_mut(&mut counts))?;
    Ok(counts)
}
