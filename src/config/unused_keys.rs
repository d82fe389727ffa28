//! Keys that only another optimiser reads.

use crate::layout::HyperParams;
use crate::layout::choices::OPTIMISER_SGD;
use crate::toml::document::Node;
use crate::toml::error::ConfigError;
use crate::toml::reader::{Item, KeyedTable};
use std::sync::Arc;

/// Keys of an optimiser, and whether that is sgd.
const KEYS: [(&str, bool); 4] =
    [("learning.momentum", true), ("learning.beta1", false), ("learning.beta2", false), ("learning.epsilon", false)];

/// Keys that only the other optimiser reads, as found: an arm may leave them alone, but not all arms.
#[derive(Debug, Default)]
pub(super) struct UnusedKeys(Vec<(String, Node, bool)>);

impl UnusedKeys {
    /// Notes which keys of a complete `learning` table its optimiser reads.
    pub(super) fn note(&mut self, section: &KeyedTable<'_>, optimiser: u32) -> Result<(), ConfigError> {
        for row in HyperParams::rows() {
            let Some((_, sgd)) = KEYS.iter().find(|(path, _)| *path == row.key.path) else { continue };
            let Some(item) = section.0.optional(row.key.name()) else { continue };
            // A key that repeats its default does no harm; a resolved config is full of them.
            let default = row.key.default.and_then(|text| text.parse().ok()).map(f32::to_bits);
            let same = default == Some(section.word(&row.key)?);
            self.add(item, same || *sgd == (optimiser == OPTIMISER_SGD));
        }
        Ok(())
    }

    fn add(&mut self, item: Item<'_>, used: bool) {
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
        let Some((name, node, _)) = self.0.into_iter().find(|(_, _, used)| !used) else { return Ok(()) };
        let sgd = KEYS.iter().any(|(key, sgd)| *sgd && key.ends_with(name.rsplit('.').next().unwrap_or(&name)));
        let needed = if sgd { "sgd" } else { "adam" };
        let message = format!("`{name}` has no effect: nothing that it applies to uses {needed}");
        Err(node.origin.error(message, format!("remove it, or set `optimiser = \"{needed}\"`")))
    }
}
