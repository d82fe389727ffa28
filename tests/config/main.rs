//! Configs: what the shipped files say, trees, sweeps, the reference of keys, and a good message for every mistake.

mod mistakes;
mod plans;
mod reference;
mod shipped;
mod sweep;
mod tree_mistakes;
mod trees;
