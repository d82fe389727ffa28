//! Configs: what the shipped files say, trees, sweeps, the reference of keys, and a good message for every mistake.

mod events;
mod mistakes;
mod plans;
mod reference;
#[path = "../support/rewards.rs"]
mod rewards;
mod shipped;
mod sweep;
mod tree_mistakes;
mod trees;
