//! `failures.json`: learners in which a number stopped being finite, each with its first bad transition.
//!
//! A run without such learners has no such file.

use super::json::JsonFile;
use serde::{Deserialize, Serialize};

/// A learner that diverged and was frozen: where it happened.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Divergence {
    /// The arm's name.
    pub arm: String,
    /// Sweep point, counted from 0.
    pub point: u32,
    /// The learner's seed.
    pub seed: u32,
    /// The skill in training.
    pub skill: String,
    /// Trials of it finished.
    pub trial: u32,
    /// What was found, in words.
    pub what: String,
    /// The transition being learned when it was found, or the last one before.
    pub transition: Option<Transition>,
    /// The first weight of the skill that is not finite, if any is.
    pub weight: Option<Weight>,
}

/// A replayed step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Transition {
    /// Whether the lesson is a taught one.
    pub taught: bool,
    /// Which lesson: its number in the teacher's bank, or the trial in which it was experienced.
    pub lesson: u32,
    /// Whether it was seen in a mirror.
    pub mirrored: bool,
    /// The step in the lesson, counted from 0.
    pub step: u32,
    /// The child that was chosen, or its mirror image.
    pub child: String,
    /// The recorded step, word by word.
    pub record: Vec<u32>,
    /// Inputs of the nets.
    pub inputs: Vec<Number>,
    /// Q-value of every child, in the skill's order.
    pub q: Vec<Number>,
    /// What the chosen child's Q-value should become.
    pub target: Number,
}

/// One weight of a learner, named as in its safetensors file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Weight {
    /// The tensor, such as `dock.q.move+12.0.weight`.
    pub tensor: String,
    /// Index into the tensor.
    pub index: Vec<u32>,
    /// The weight.
    pub value: Number,
}

/// An f32 that need not be finite: JSON has no word for those that are not, so they are strings.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(into = "Form", try_from = "Form")]
pub struct Number(pub f32);

impl PartialEq for Number {
    fn eq(&self, other: &Self) -> bool {
        // NaN is NaN here, whatever its payload.
        self.0 == other.0 || (self.0.is_nan() && other.0.is_nan())
    }
}

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Form {
    Finite(f32),
    Word(String),
}

impl From<Number> for Form {
    fn from(number: Number) -> Self {
        let value = number.0;
        if value.is_finite() { Self::Finite(value) } else { Self::Word(value.to_string()) }
    }
}

impl TryFrom<Form> for Number {
    type Error = String;

    fn try_from(form: Form) -> Result<Self, String> {
        match form {
            Form::Finite(value) => Ok(Self(value)),
            Form::Word(word) => match word.parse::<f32>() {
                Ok(value) if !value.is_finite() => Ok(Self(value)),
                _ => Err(format!("`{word}` is no number")),
            },
        }
    }
}

impl JsonFile for Vec<Divergence> {
    const NAME: &'static str = "failures.json";
    const PRETTY: bool = true;
}
