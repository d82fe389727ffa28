//! Keys that only another optimiser reads.

use crate::layout::HyperParams;
use crate::layout::choices::OPTIMISER_SGD;
use crate::toml::document::Node;
use crate::toml::error::ConfigError;
use crate::toml::reader::TableReader;
use std::cell::RefCell;

/// Keys of an optimiser, and whether that is sgd.
const KEYS: [(&str, bool); 4] =
    [("learning.momentum", true), ("learning.beta1", false), ("learning.beta2", false), ("learning.epsilon", false)];

/// Keys that only the other optimiser reads, as found: an arm may leave them alone, but not all arms.
#[derive(Debug, Default)]
pub(super) struct UnusedKeys(RefCell<Vec<(String, Node, bool)>>);

impl UnusedKeys {
    /// Notes which keys of a complete `learning` table its optimiser reads.
    pub(super) fn note(&self, section: &TableReader<'_>, optimiser: u32) -> Result<(), ConfigError> {
        for row in HyperParams::rows() {
            let Some((_, sgd)) = KEYS.iter().find(|(path, _)| *path == row.key.path) else { continue };
            let Some(item) = section.optional(row.key) else { continue };
            // A key that repeats its default does no harm; a resolved config is full of them.
            let default = row.key.default.and_then(|text| text.parse().ok()).map(f32::to_bits);
            let same = default == Some(section.word(&row.key)?);
            let used = same || *sgd == (optimiser == OPTIMISER_SGD);
            let mut found = self.0.borrow_mut();
            match found.iter_mut().find(|(name, node, _)| *name == item.name && node.origin == *item.origin()) {
                Some((_, _, once)) => *once |= used,
                None => found.push((item.name, item.node.clone(), used)),
            }
        }
        Ok(())
    }

    /// Refuses keys that somebody wrote and no skill of any arm uses.
    pub(super) fn finish(self) -> Result<(), ConfigError> {
        let Some((name, node, _)) = self.0.into_inner().into_iter().find(|(_, _, used)| !used) else { return Ok(()) };
        let sgd = KEYS.iter().any(|(key, sgd)| *sgd && key.ends_with(name.rsplit('.').next().unwrap_or(&name)));
        let needed = if sgd { "sgd" } else { "adam" };
        let message = format!("`{name}` has no effect: nothing that it applies to uses {needed}");
        Err(node.origin.error(message, format!("remove it, or set `optimiser = \"{needed}\"`")))
    }
}
