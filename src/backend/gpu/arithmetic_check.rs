//! Kernel `probe`: the bits of the shipped arithmetic at given inputs, to be compared with Rust's.
//!
//! A question is 12 words, an answer 48. The shapes are those that compilers are known to fuse or to
//! re-associate; each changes its bits on a good part of the inputs where that happens. Twin:
//! `shaders/backend/gpu/arithmetic_check.wgsl`.

use crate::layout::{LANES, MAX_CHILDREN};
use crate::math::functions::{
    exponential, flush, ln, reciprocal, reciprocal_sqrt, sin_cos, square_root, tanh, wrap_degrees,
};
use crate::math::reduce::{Partials, lanes_min, lanes_or, lanes_sums};
use crate::math::rng::{below, mul_high, noise, philox, unit};

/// Words of a question.
pub const QUESTION_WORDS: usize = 12;
/// Words of an answer.
pub const ANSWER_WORDS: usize = 48;

/// One question.
pub type Question = [u32; QUESTION_WORDS];
/// One answer.
pub type Answer = [u32; ANSWER_WORDS];

/// What each word of an answer holds.
pub const NAMES: [&str; ANSWER_WORDS] = [
    "flush",
    "exponential",
    "ln",
    "reciprocal",
    "reciprocal_sqrt",
    "square_root",
    "square_root of any sign",
    "tanh",
    "sine",
    "cosine",
    "wrap_degrees",
    "philox, word 0",
    "philox, word 1",
    "philox, word 2",
    "philox, word 3",
    "mul_high",
    "below",
    "unit",
    "noise, bell",
    "noise, flat",
    "f32 of u32",
    "f32 of i32",
    "u32 of f32",
    "i32 of f32",
    "-a",
    "a*b + c",
    "c - a*b",
    "(a - c1) + c2",
    "(c1 - a) + c2",
    "(c1 + a*b) + c2",
    "(a*c1)*c2",
    "((a*c1)*b)*c2",
    "(a*b)*c1",
    "(a + c) + 1",
    "(c*(a*a) + a) + 1",
    "(a + b) - a",
    "(a + big) - big",
    "a*b + a*c",
    "(1 - d)*a + d*b",
    "a + (c + 1)",
    "a*(b*c1)",
    "sums and products in a loop",
    "a product of vectors",
    "lanes_min",
    "lanes_or",
    "lanes_sums",
    "lanes_sums of squares",
    SUBNORMAL,
];

/// Name of the one answer that may differ: what stands between 0 and 1.2e-38 is flushed where it is stored,
/// so devices need not agree on it.
pub const SUBNORMAL: &str = "a subnormal product";

fn put(answer: &mut Answer, place: usize, value: f32) {
    answer[place] = value.to_bits();
}

fn functions(answer: &mut Answer, x: f32, p: f32, angle: f32, tiny: f32) {
    put(answer, 0, flush(tiny));
    put(answer, 1, exponential(x));
    put(answer, 2, ln(p));
    put(answer, 3, reciprocal(p));
    put(answer, 4, reciprocal_sqrt(p));
    put(answer, 5, square_root(p));
    put(answer, 6, square_root(x));
    put(answer, 7, tanh(x));
    let turn = sin_cos(angle);
    put(answer, 8, turn.0);
    put(answer, 9, turn.1);
    put(answer, 10, wrap_degrees(angle - 360.0));
}

fn integers(answer: &mut Answer, words: [u32; 4], key: [u32; 2]) {
    let block = philox(words, key);
    answer[11..15].copy_from_slice(&block);
    answer[15] = mul_high(words[0], words[1]);
    answer[16] = below(words[2], 1000);
    put(answer, 17, unit(words[3]));
    put(answer, 18, noise(0, words[0], words[1]));
    put(answer, 19, noise(1, words[0], words[1]));
    put(answer, 20, words[0] as f32);
    put(answer, 21, words[1] as i32 as f32);
}

fn conversions(answer: &mut Answer, x: f32, a: f32) {
    answer[22] = (x.abs() * 1000.0) as u32;
    answer[23] = (x * 1000.0) as i32 as u32;
    put(answer, 24, if x < 0.0 { -a } else { a });
}

fn shapes(answer: &mut Answer, a: f32, b: f32, c: f32, d: f32) {
    put(answer, 25, a * b + c);
    put(answer, 26, c - a * b);
    put(answer, 27, (a - 1.1) + 0.3);
    put(answer, 28, (1.1 - a) + 0.3);
    put(answer, 29, (1.1 + a * b) + 0.3);
    put(answer, 30, (a * 1.1) * 0.7);
    put(answer, 31, ((a * 1.1) * b) * 0.7);
    put(answer, 32, (a * b) * 0.7);
    put(answer, 33, (a + c) + 1.0);
    put(answer, 34, (c * (a * a) + a) + 1.0);
    put(answer, 35, (a + b) - a);
    put(answer, 36, (a + 12_582_912.0) - 12_582_912.0);
    put(answer, 37, a * b + a * c);
    put(answer, 38, (1.0 - d) * a + d * b);
    put(answer, 39, a + (c + 1.0));
    put(answer, 40, a * (b * 0.7));
    let mut sum = a;
    for _turn in 0..8 {
        sum += b * c;
        sum *= d;
    }
    put(answer, 41, sum);
    put(answer, 42, dot_of([a, b, c], [d, a, b]));
}

fn dot_of(u: [f32; 3], v: [f32; 3]) -> f32 {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
}

fn lanes(answers: &mut [Answer; LANES], x: &[f32; LANES], words: &[u32; LANES]) {
    let least = lanes_min(&std::array::from_fn::<_, LANES, _>(|lane| x[lane].abs()));
    let bits = lanes_or(&std::array::from_fn::<_, LANES, _>(|lane| words[lane] & (1 << lane)));
    let mut partials: Partials = [[0.0; LANES]; MAX_CHILDREN];
    partials[0] = *x;
    partials[1] = x.map(|x| x * x);
    lanes_sums(&mut partials, 2, LANES);
    for answer in answers {
        put(answer, 43, least);
        answer[44] = bits;
        put(answer, 45, partials[0][0]);
        put(answer, 46, partials[1][0]);
    }
}

/// Answers the questions of one workgroup.
pub fn arithmetic_check(questions: &[Question; LANES]) -> [Answer; LANES] {
    let mut answers = [[0; ANSWER_WORDS]; LANES];
    for (answer, question) in answers.iter_mut().zip(questions) {
        let [x, p, angle, tiny, a, b, c, d] = std::array::from_fn(|word| f32::from_bits(question[word]));
        let words = [question[8], question[9], question[10], question[11]];
        functions(answer, x, p, angle, tiny);
        integers(answer, words, [words[2], words[3]]);
        conversions(answer, x, a);
        shapes(answer, a, b, c, d);
        put(answer, 47, tiny * d);
    }
    let x = std::array::from_fn(|lane| f32::from_bits(questions[lane][0]));
    lanes(&mut answers, &x, &std::array::from_fn(|lane| questions[lane][8]));
    answers
}
