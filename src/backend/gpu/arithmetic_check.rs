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

/// The answers of one lane.
struct LaneAnswers<'a> {
    answers: &'a mut Answer,
}

impl LaneAnswers<'_> {
    fn put(&mut self, place: usize, value: f32) {
        self.answers[place] = value.to_bits();
    }

    fn functions(&mut self, x: f32, p: f32, angle: f32, tiny: f32) {
        self.put(0, flush(tiny));
        self.put(1, exponential(x));
        self.put(2, ln(p));
        self.put(3, reciprocal(p));
        self.put(4, reciprocal_sqrt(p));
        self.put(5, square_root(p));
        self.put(6, square_root(x));
        self.put(7, tanh(x));
        let turn = sin_cos(angle);
        self.put(8, turn.0);
        self.put(9, turn.1);
        self.put(10, wrap_degrees(angle - 360.0));
    }

    fn integers(&mut self, words: [u32; 4], key: [u32; 2]) {
        let block = philox(words, key);
        self.answers[11] = block[0];
        self.answers[12] = block[1];
        self.answers[13] = block[2];
        self.answers[14] = block[3];
        self.answers[15] = mul_high(words[0], words[1]);
        self.answers[16] = below(words[2], 1000);
        self.put(17, unit(words[3]));
        self.put(18, noise(0, words[0], words[1]));
        self.put(19, noise(1, words[0], words[1]));
        self.put(20, words[0] as f32);
        self.put(21, words[1] as i32 as f32);
    }

    fn conversions(&mut self, x: f32, a: f32) {
        self.answers[22] = (x.abs() * 1000.0) as u32;
        self.answers[23] = (x * 1000.0) as i32 as u32;
        self.put(24, if x < 0.0 { -a } else { a });
    }

    fn shapes(&mut self, a: f32, b: f32, c: f32, d: f32) {
        self.put(25, a * b + c);
        self.put(26, c - a * b);
        self.put(27, (a - 1.1) + 0.3);
        self.put(28, (1.1 - a) + 0.3);
        self.put(29, (1.1 + a * b) + 0.3);
        self.put(30, (a * 1.1) * 0.7);
        self.put(31, ((a * 1.1) * b) * 0.7);
        self.put(32, (a * b) * 0.7);
        self.put(33, (a + c) + 1.0);
        self.put(34, (c * (a * a) + a) + 1.0);
        self.put(35, (a + b) - a);
        self.put(36, (a + 12_582_912.0) - 12_582_912.0);
        self.put(37, a * b + a * c);
        self.put(38, (1.0 - d) * a + d * b);
        self.put(39, a + (c + 1.0));
        self.put(40, a * (b * 0.7));
        let mut sum = a;
        for _turn in 0..8 {
            sum += b * c;
            sum *= d;
        }
        self.put(41, sum);
        self.put(42, dot_of([a, b, c], [d, a, b]));
    }
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
    for answers in answers {
        let mut own = LaneAnswers { answers };
        own.put(43, least);
        own.answers[44] = bits;
        own.put(45, partials[0][0]);
        own.put(46, partials[1][0]);
    }
}

/// Answers the questions of one workgroup.
pub fn arithmetic_check(questions: &[Question; LANES]) -> [Answer; LANES] {
    let mut answers = [[0; ANSWER_WORDS]; LANES];
    for (answer, question) in answers.iter_mut().zip(questions) {
        let [x, p, angle, tiny, a, b, c, d] = std::array::from_fn(|word| f32::from_bits(question[word]));
        let words = [question[8], question[9], question[10], question[11]];
        let mut own = LaneAnswers { answers: answer };
        own.functions(x, p, angle, tiny);
        own.integers(words, [words[2], words[3]]);
        own.conversions(x, a);
        own.shapes(a, b, c, d);
        own.put(47, tiny * d);
    }
    let x = std::array::from_fn(|lane| f32::from_bits(questions[lane][0]));
    lanes(&mut answers, &x, &std::array::from_fn(|lane| questions[lane][8]));
    answers
}
