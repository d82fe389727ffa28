//! What became of a claim.

/// What became of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClaimVerdict {
    /// As the paper says.
    Holds,
    /// In part, as the rule says.
    Partly,
    /// Not as the paper says.
    DoesNotHold,
    /// The run lacks what the rule needs.
    NotTested,
}

impl ClaimVerdict {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Partly => "partly",
            Self::DoesNotHold => "does not hold",
            Self::NotTested => "not tested here",
        }
    }

    /// Holds if everything is as claimed, partly if something is.
    pub(super) fn of(as_claimed: &[bool]) -> Self {
        match as_claimed.iter().filter(|claimed| **claimed).count() {
            0 => Self::DoesNotHold,
            count if count == as_claimed.len() => Self::Holds,
            _ => Self::Partly,
        }
    }

    /// Holds if all of an interval is, partly if only the value is.
    pub(super) fn surely(surely: bool, probably: bool) -> Self {
        match surely {
            true => Self::Holds,
            false if probably => Self::Partly,
            false => Self::DoesNotHold,
        }
    }

    /// Holds from one limit on, partly from a lower one on.
    pub(super) fn from_limits(value: f64, holds: f64, partly: f64) -> Self {
        match value {
            value if value >= holds => Self::Holds,
            value if value >= partly => Self::Partly,
            _ => Self::DoesNotHold,
        }
    }
}

/// A claim and its verdict.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    /// In the order of the paper.
    pub number: usize,
    /// What it is about, in two or three words.
    pub title: &'static str,
    /// The claim in our words.
    pub says: &'static str,
    /// What the run says; empty if it says nothing.
    pub figures: Vec<String>,
    /// Seeds behind the figures.
    pub seeds: usize,
    /// What became of it.
    pub verdict: ClaimVerdict,
    /// The rule, or what is missing.
    pub why: String,
}

/// What a rule finds.
pub(super) struct Finding {
    pub(super) figures: Vec<String>,
    pub(super) seeds: usize,
    pub(super) verdict: ClaimVerdict,
}
