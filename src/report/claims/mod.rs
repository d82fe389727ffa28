//! The paper's claims, each judged by a fixed rule from what a run holds.
//!
//! Arms are known by their names; a claim whose arms a run lacks is not tested there. Every arm counts with its root
//! skill, unless a skill is named.
//!
//! | arm | what it is | claims |
//! |---|---|---|
//! | `hierarchical` | the main arm: skills, and a learned skill above them | 2 (without `docking-taught`), 3, 6 to 13 |
//! | `monolithic` | one Q-function over actions, the paper's reward | 4, 5, 6, 11 |
//! | `monolithic-penalty` | the same, punished for collisions | 6, 11 |
//! | `monolithic-...` | any other arm without skills below its root | 11 |
//! | `docking-untaught`, `docking-taught` | the root is `dock`, without lessons and with them | 1; 2 |
//! | `no-persistence` | without the Persistence Rule | 9 |
//! | `low-thresholds`, `high-thresholds`, `learned-thresholds` | thresholds that should make no difference | 10 |
//! | `excluding-thresholds` | thresholds so high that they rule out the best skill | 10 |
//! | `td0` | lambda = 0 | 12 |
//!
//! Claim 3 reads the main arm's skills `pass-door` and `follow-right`, claim 2 its `dock` where there is no arm
//! `docking-taught`. Rooms are the paper's `A`, `B` and `C`. Claim 13 reads all alterations but `noise-*` and
//! `*-hard`. Other arms (`persistence-in-training`, `literal`, `no-applicability`, `fixed-arbitration`,
//! `random-skill`, `planner-skills`, ...) stand in the tables of their skills.

mod elementary;
mod equal_cost;
mod evidence;
mod hierarchy;
mod judge;
mod single;
mod verdict;

pub use judge::judge;
pub use verdict::{Claim, ClaimVerdict};
