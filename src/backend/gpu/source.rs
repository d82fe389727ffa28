//! The text of every shipped kernel: its files, opened by the shared constants and structs.

use crate::layout::prelude::prelude;
use crate::layout::shader::parts;
use crate::qnet::optimiser;

pub use crate::layout::shader::Part;

/// One kernel. Its entry point bears its name.
#[derive(Debug, Clone, Copy)]
pub struct Kernel {
    /// One word: file, entry point and label.
    pub name: &'static str,
    /// Lists of files: its own first, which declares the bindings, then everything it calls.
    pub parts: &'static [&'static [Part]],
}

impl Kernel {
    /// Its files.
    pub fn files(&self) -> impl Iterator<Item = &'static Part> {
        self.parts.iter().copied().flatten()
    }

    /// The complete WGSL text.
    pub fn wgsl(&self) -> String {
        let mut text = prelude();
        for part in self.files() {
            text.push_str(part.text);
        }
        text
    }
}

/// Arithmetic.
const MATH: &[Part] = parts!["math/rng.wgsl", "math/functions.wgsl", "math/reduce.wgsl"];
/// A body that moves and senses.
const BODY: &[Part] = parts![
    "env/motion.wgsl",
    "env/contact.wgsl",
    "env/sonar.wgsl",
    "env/light.wgsl",
    "env/observation.wgsl",
    "env/observe.wgsl",
];
/// A robot in a trial, and what decides for it.
const TRIAL: &[Part] = parts![
    "env/reset.wgsl",
    "env/memory.wgsl",
    "env/events.wgsl",
    "env/step.wgsl",
    "policy/features.wgsl",
    "policy/applicability.wgsl",
    "policy/persistence.wgsl",
    "policy/select.wgsl",
    "policy/planner_table.wgsl",
    "policy/hierarchy.wgsl",
    "qnet/forward.wgsl",
];
/// Learning from trials.
const LEARNING: &[Part] = parts![
    "qnet/weights.wgsl",
    "qnet/gradient.wgsl",
    "qnet/backward.wgsl",
    "learn/lesson.wgsl",
    "learn/td_lambda.wgsl",
];

/// Moves learners on.
pub const TRAIN: Kernel =
    Kernel { name: "train", parts: &[parts!["kernels/train.wgsl"], MATH, BODY, TRIAL, LEARNING, optimiser::PARTS] };

/// Runs test trials.
pub const EVALUATE: Kernel = Kernel { name: "evaluate", parts: &[parts!["kernels/evaluate.wgsl"], MATH, BODY, TRIAL] };

/// Moves robots under given actions.
pub const STEP: Kernel = Kernel { name: "step", parts: &[parts!["kernels/step.wgsl"], MATH, BODY] };

/// Asks an adapter for the bits of the shipped arithmetic.
pub const ARITHMETIC_CHECK: Kernel =
    Kernel { name: "arithmetic_check", parts: &[parts!["backend/gpu/arithmetic_check.wgsl"], MATH] };

/// Counts how many turns a loop really takes.
pub const LOOP_LIMIT: Kernel = Kernel { name: "loop_limit", parts: &[parts!["backend/gpu/loop_limit.wgsl"]] };

/// Every shipped kernel.
pub const KERNELS: &[Kernel] = &[TRAIN, EVALUATE, STEP, ARITHMETIC_CHECK, LOOP_LIMIT];
