//! The table `sweep`: keys of the config that differ between points, and the values that they take there.
//!
//! An axis is named as its key is everywhere else, and lies over everything, an arm's own table included:
//!
//! ```toml
//! [sweep]
//! learning.gamma = [0.8, 0.9, 0.95]                                      # a list, also of words, flags or worlds
//! robot.noise.sonar = { from = 0.0, to = 0.2, steps = 5 }                # evenly spread, both ends included
//! learning.learning_rate = { from = 1e-4, to = 1e-2, steps = 5, scale = "log" }   # evenly in the logarithm
//! skill.recharge.applicable.dock = { values = [0.1, 0.2], label = "dock threshold" }
//! ```
//!
//! `axis` reads one of them, `allowed_keys` tells which keys may be one, `points` combines them, and `expand` puts their
//! values into the arms' configs.

mod allowed_keys;
mod axis;
pub(super) mod expand;
mod points;

use axis::AxisSource;

use super::keys;
use super::plan;
use super::worlds::Worlds;
use crate::toml::document::{Node, Value};
use crate::toml::error::ConfigError;
use crate::toml::reader::Item;

/// A sweep as read.
#[derive(Debug)]
pub(super) struct SweepSource<'a> {
    /// How the points lie.
    design: plan::Design,
    /// What differs.
    axes: Vec<AxisSource<'a>>,
    /// For each point, an index into the values of each axis.
    pub(super) points: Vec<Vec<usize>>,
    /// The points that are run, ascending.
    pub(super) only: Vec<usize>,
    /// Where it is written.
    pub(super) item: Item<'a>,
}

/// Reads the table `sweep`, if there is one. `base` is the complete config without arms.
pub(super) fn read<'a>(
    node: Option<&'a Node>,
    base: &Node,
    run_seed: u32,
) -> Result<Option<SweepSource<'a>>, ConfigError> {
    let Some(node) = node else { return Ok(None) };
    let item = Item { name: "sweep".to_owned(), node };
    let table = item.table()?;
    let design = match table.optional(keys::SWEEP_DESIGN) {
        Some(item) if item.choice("designs", &["grid", "random"])? == 1 => plan::Design::Random,
        _ => plan::Design::Grid,
    };
    let (count, only) = (table.optional(keys::SWEEP_POINTS), table.optional(keys::SWEEP_ONLY));
    let skills = base.names("skill");
    let mut axes: Vec<AxisSource<'a>> = Vec::new();
    for (entry, item) in table.all() {
        if !keys::all().any(|key| key.path == format!("sweep.{}", entry.key)) {
            axis::collect(entry, &item, &[], &skills, &mut axes)?;
        }
    }
    if let [first, ..] = &axes[..] {
        let points = match (design, count) {
            (plan::Design::Random, count) => points::random(&mut axes, &item, count.as_ref(), run_seed)?,
            (plan::Design::Grid, Some(count)) => {
                let hint = "a grid has all combinations; drop it, or set design = \"random\"";
                return Err(count.error("`sweep.points` is for random designs", hint));
            }
            (plan::Design::Grid, None) => points::grid(&axes, first.item.origin())?,
        };
        let only = match only {
            Some(only) => points::chosen(&only, points.len())?,
            None => (0..points.len()).collect(),
        };
        return Ok(Some(SweepSource { design, axes, points, only, item }));
    }
    match only {
        // `--point 0` is what a run without a sweep does.
        Some(only) if count.is_none() && points::chosen(&only, 1)? == [0] => Ok(None),
        _ => Err(item.error("the sweep has no axis", "name a key and its values, such as learning.gamma = [0.8, 0.9]")),
    }
}

impl SweepSource<'_> {
    /// What the plan and the run folder say of it. Worlds have the names that they have in the folder.
    pub(super) fn plan(&self, worlds: &mut Worlds<'_>) -> Result<plan::Sweep, ConfigError> {
        let mut axes = Vec::new();
        for axis in &self.axes {
            let mut values = Vec::new();
            for node in &axis.values {
                values.push(match &node.value {
                    Value::Text(_) if axis.key == keys::WORLD.name() => {
                        let world = worlds.place(&Item { name: axis.key.clone(), node })?;
                        plan::AxisValue::Text(worlds.placed[world].file.clone())
                    }
                    Value::Text(text) => plan::AxisValue::Text(text.clone()),
                    Value::Flag(flag) => plan::AxisValue::Text(flag.to_string()),
                    // An axis takes neither lists nor tables.
                    _ => plan::AxisValue::Number(axis::number(node).unwrap_or_default()),
                });
            }
            let (key, label, scale) = (axis.key.clone(), axis.label.clone(), axis.scale);
            axes.push(plan::Axis { key, label, scale, values });
        }
        let value = |(axis, value): (&plan::Axis, &usize)| axis.values[*value].clone();
        let points = self.points.iter().map(|point| axes.iter().zip(point).map(value).collect()).collect();
        Ok(plan::Sweep { design: self.design, axes, points })
    }
}
