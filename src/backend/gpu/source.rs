//! The text of every shipped kernel: an ordered list of parts, opened by the shared constants and structs.

use crate::layout::prelude::prelude;

/// One WGSL file.
#[derive(Debug, Clone, Copy)]
pub struct Part {
    /// Path below `shaders/`; its twin has the same path below `src/`.
    pub path: &'static str,
    /// The file's text.
    pub text: &'static str,
}

macro_rules! part {
    ($path:literal) => {
        Part { path: $path, text: include_str!(concat!("../../../shaders/", $path)) }
    };
}

/// One kernel. Its entry point bears its name.
#[derive(Debug, Clone, Copy)]
pub struct Kernel {
    /// One word: file, entry point and label.
    pub name: &'static str,
    /// Its own file first, which declares the bindings, then everything it calls.
    pub parts: &'static [Part],
}

impl Kernel {
    /// The complete WGSL text.
    pub fn wgsl(&self) -> String {
        let mut text = prelude();
        for part in self.parts {
            text.push_str(part.text);
        }
        text
    }
}

const RNG: Part = part!("math/rng.wgsl");
const FUNCTIONS: Part = part!("math/functions.wgsl");
const LANES: Part = part!("math/reduce.wgsl");
const MOVE: Part = part!("env/motion.wgsl");
const COLLIDE: Part = part!("env/contact.wgsl");
const SONAR: Part = part!("env/sonar.wgsl");
const LIGHT: Part = part!("env/light.wgsl");
const ACT: Part = part!("policy/hierarchy.wgsl");
const OBSERVE: Part = part!("env/observe.wgsl");
const REMEMBER: Part = part!("env/memory.wgsl");
const ENCODE: Part = part!("policy/features.wgsl");
const CONSULT: Part = part!("policy/planner_table.wgsl");
const PERSIST: Part = part!("policy/persistence.wgsl");
const REWARD: Part = part!("env/events.wgsl");
const CHOOSE: Part = part!("policy/select.wgsl");
const START: Part = part!("env/reset.wgsl");
const FORWARD: Part = part!("qnet/forward.wgsl");
const BACKWARD: Part = part!("qnet/backward.wgsl");
const RECORD: Part = part!("learn/lesson.wgsl");
const REPLAY: Part = part!("learn/td_lambda.wgsl");

/// Moves learners on.
pub const ADVANCE: Kernel = Kernel {
    name: "advance",
    parts: &[
        part!("kernels/train.wgsl"),
        RNG,
        FUNCTIONS,
        LANES,
        MOVE,
        COLLIDE,
        SONAR,
        LIGHT,
        ACT,
        OBSERVE,
        REMEMBER,
        ENCODE,
        CONSULT,
        PERSIST,
        REWARD,
        CHOOSE,
        START,
        FORWARD,
        BACKWARD,
        RECORD,
        REPLAY,
    ],
};

/// Runs test trials.
pub const EVALUATE: Kernel = Kernel {
    name: "evaluate",
    parts: &[
        part!("kernels/evaluate.wgsl"),
        RNG,
        FUNCTIONS,
        LANES,
        MOVE,
        COLLIDE,
        SONAR,
        LIGHT,
        ACT,
        OBSERVE,
        REMEMBER,
        ENCODE,
        CONSULT,
        PERSIST,
        REWARD,
        CHOOSE,
        START,
        FORWARD,
    ],
};

/// Moves robots under given actions.
pub const STEP: Kernel = Kernel {
    name: "step",
    parts: &[part!("kernels/step.wgsl"), RNG, FUNCTIONS, LANES, MOVE, COLLIDE, SONAR, LIGHT, OBSERVE],
};

/// Asks an adapter for the bits of the shipped arithmetic.
pub const PROBE: Kernel =
    Kernel { name: "probe", parts: &[part!("backend/gpu/arithmetic_check.wgsl"), RNG, FUNCTIONS, LANES] };

/// Counts how many turns a loop really takes.
pub const CANARY: Kernel = Kernel { name: "canary", parts: &[part!("backend/gpu/loop_limit.wgsl")] };

/// Every shipped kernel.
pub const KERNELS: &[Kernel] = &[ADVANCE, EVALUATE, STEP, PROBE, CANARY];
