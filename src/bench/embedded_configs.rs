//! The shipped configs that benchmarks are cut from, built in, so that the command works anywhere.

use super::BenchError;
use crate::config::plan::Plan;
use crate::config::{MemoryFiles, Overrides, load_from};
use std::path::Path;

/// The shipped files that benchmarks need.
const FILES: [(&str, &str); 4] = [
    (DOCKING, include_str!("../../configs/docking.toml")),
    (HIERARCHY, include_str!("../../configs/lin1993.toml")),
    (THRESHOLDS, include_str!("../../configs/thresholds.toml")),
    ("worlds/office.toml", include_str!("../../configs/worlds/office.toml")),
];

/// Docking by itself: the smallest experiment.
pub const DOCKING: &str = "docking.toml";
/// The whole paper.
pub const HIERARCHY: &str = "lin1993.toml";
/// The same with the cheaper learner of large sweeps.
pub const THRESHOLDS: &str = "thresholds.toml";
/// The point of that sweep that has the thresholds of [`HIERARCHY`].
pub const ONE_POINT: [&str; 2] =
    ["sweep.skill.recharge.applicable.dock=[0.15]", "sweep.skill.recharge.applicable.pass-door=[0.4]"];

/// A shipped config with some keys set (`key=value`), and seeds from 0 to below `seeds`.
///
/// # Errors
/// Where a key has no such value.
pub fn embedded_plan(config: &str, set: &[&str], seeds: u32) -> Result<Plan, BenchError> {
    let set = set.iter().map(|text| (*text).to_owned()).collect();
    let overrides = Overrides { set, seeds: Some(format!("0..{seeds}")), ..Overrides::default() };
    Ok(load_from(&MemoryFiles::from_iter(FILES), Path::new(config), &overrides)?)
}
