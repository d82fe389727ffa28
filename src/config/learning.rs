//! The keys of `learning`, for one skill of one arm.

use super::keys;
use super::plan::{Backup, Learning, Optimiser};
use crate::toml::document::Node;
use crate::toml::error::ConfigError;
use crate::toml::reader::{Item, Section};
use std::sync::Arc;

/// Keys that only the other optimiser reads, as found: an arm may leave them alone, but not all arms.
#[derive(Debug, Default)]
pub(super) struct Idle(Vec<(String, Node, bool)>);

impl Idle {
    fn note(&mut self, item: Option<Item<'_>>, used: bool) {
        let Some(item) = item else { return };
        let same = |node: &Node| {
            Arc::ptr_eq(&node.origin.source, &item.origin().source) && node.origin.span == item.origin().span
        };
        match self.0.iter_mut().find(|(name, node, _)| *name == item.name && same(node)) {
            Some((_, _, once)) => *once |= used,
            None => self.0.push((item.name, item.node.clone(), used)),
        }
    }

    /// Refuses keys that somebody wrote and no skill of any arm uses.
    pub(super) fn finish(self) -> Result<(), ConfigError> {
        match self.0.into_iter().find(|(_, _, used)| !used) {
            None => Ok(()),
            Some((name, node, _)) => {
                let needed = if name.ends_with(keys::MOMENTUM.name()) { "sgd" } else { "adam" };
                let message = format!("`{name}` has no effect: nothing that it applies to uses {needed}");
                Err(node.origin.error(message, format!("remove it, or set `optimiser = \"{needed}\"`")))
            }
        }
    }
}

/// Reads a complete `learning` table.
pub(super) fn read(item: &Item<'_>, idle: &mut Idle) -> Result<Learning, ConfigError> {
    let section = Section(item.table()?);
    let optimiser = section.choice(&keys::OPTIMISER)?;
    let sgd = optimiser == 1;
    for (key, used) in [(keys::BETA1, !sgd), (keys::BETA2, !sgd), (keys::EPSILON, !sgd), (keys::MOMENTUM, sgd)] {
        // A key that repeats its default does no harm; a resolved config is full of them.
        let default = key.default.and_then(|text| text.parse().ok());
        let same = Some(f64::from(section.number(&key)?)) == default.map(|value: f64| f64::from(value as f32));
        idle.note(section.0.optional(key.name()), used || same);
    }
    let rate = section.number(&keys::RATE)?;
    let unset = section.0.optional(keys::RATE.name()).is_none_or(|item| item.origin().is_default());
    if sgd && unset {
        let chosen = section.required(&keys::OPTIMISER, "\"sgd\"")?;
        return Err(chosen.error("sgd has no default rate", "add `rate = 0.15` beside it"));
    }
    let momentum = section.number(&keys::MOMENTUM)?;
    let (beta1, beta2) = (section.number(&keys::BETA1)?, section.number(&keys::BETA2)?);
    let epsilon = section.number(&keys::EPSILON)?;
    let learning = Learning {
        hidden: section.whole(&keys::HIDDEN)?,
        init: section.number(&keys::INIT)?,
        gamma: section.number(&keys::GAMMA)?,
        lambda: section.number(&keys::LAMBDA)?,
        optimiser: if sgd {
            Optimiser::Sgd { rate, momentum }
        } else {
            Optimiser::Adam { rows: optimiser == 2, rate, beta1, beta2, epsilon }
        },
        rate_end_share: section.number(&keys::RATE_END_SHARE)?,
        rate_trials: section.whole(&keys::RATE_TRIALS)?,
        reward_scale: section.number(&keys::REWARD_SCALE)?,
        target_limit: section.number(&keys::TARGET_LIMIT)?,
        inverse_temperature_start: section.number(&keys::HEAT_START)?,
        inverse_temperature_end: section.number(&keys::HEAT_END)?,
        inverse_temperature_trials: section.whole(&keys::HEAT_TRIALS)?,
        policy_threshold: section.number(&keys::POLICY_THRESHOLD)?,
        replays: section.whole(&keys::REPLAYS)?,
        memory: section.whole(&keys::MEMORY)?,
        mean_age: section.number(&keys::MEAN_AGE)?,
        taught_passes: section.whole(&keys::TAUGHT_PASSES)?,
        taught_replays: section.whole(&keys::TAUGHT_REPLAYS)?,
        taught_always: section.flag(&keys::TAUGHT_ALWAYS)?,
        timeout_terminal: section.flag(&keys::TIMEOUT_TERMINAL)?,
        mirror_replays: section.flag(&keys::MIRROR_REPLAYS)?,
        mask_blocked: section.flag(&keys::MASK_BLOCKED)?,
        shared_net: section.flag(&keys::SHARED_NET)?,
        backup: match section.choice(&keys::BACKUP)? {
            0 => Backup::Steps,
            1 => Backup::Persistent,
            _ => Backup::Decisions,
        },
        advantage_scale: section.number(&keys::ADVANTAGE_SCALE)?,
        inner_share: section.number(&keys::INNER_SHARE)?,
        child_inverse_temperature: section.number(&keys::CHILD_HEAT)?,
    };
    section.0.finish()?;
    Ok(learning)
}
