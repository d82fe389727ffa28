//! Which combinations of values are points.

use super::axis::{AxisSource, MAX_POINTS, number, same};
use crate::math::rng::{Purpose, Stream, draw};
use crate::toml::document::{Node, SourceSpan};
use crate::toml::error::ConfigError;
use crate::toml::reader::Item;
use std::collections::BTreeSet;

/// Draws after which no new point is expected any more, for each that is wanted.
const PATIENCE: u32 = 64;

/// All combinations, the last axis fastest. An index into the values of each axis.
pub(super) fn grid(axes: &[AxisSource<'_>], origin: &SourceSpan) -> Result<Vec<Vec<usize>>, ConfigError> {
    let mut count = 1_usize;
    for axis in axes {
        if axis.values.is_empty() {
            let message = format!("`{}` has no number of steps", axis.item.name);
            return Err(axis.item.error(message, "add steps = 5, or draw points at random: design = \"random\""));
        }
        count = count.saturating_mul(axis.values.len());
    }
    if count > MAX_POINTS {
        let sizes: Vec<String> = axes.iter().map(|axis| axis.values.len().to_string()).collect();
        let message = format!("the sweep has {} points", sizes.join(" x "));
        return Err(origin.error(message, format!("at most {MAX_POINTS} fit; {OTHERWISE}")));
    }
    let mut points = vec![Vec::new()];
    for axis in axes {
        let longer = |point: &Vec<usize>, value| [&point[..], &[value]].concat();
        points =
            points.iter().flat_map(|point| (0..axis.values.len()).map(move |value| longer(point, value))).collect();
    }
    Ok(points)
}

const OTHERWISE: &str = "take fewer values, or draw some: design = \"random\" and points = 1000";

/// Distinct points drawn at random, each value uniformly from its axis. Gives the axes the values that were drawn.
pub(super) fn random(
    axes: &mut [AxisSource<'_>],
    sweep: &Item<'_>,
    count: Option<&Item<'_>>,
    run_seed: u32,
) -> Result<Vec<Vec<usize>>, ConfigError> {
    let Some(count) = count else {
        return Err(sweep.error("a random sweep has no number of points", "add points = 100 to the table `sweep`"));
    };
    let wanted = count.whole(1, MAX_POINTS as u32)?;
    let mut drawn: Vec<Vec<Node>> = Vec::new();
    let mut seen = BTreeSet::new();
    for attempt in 0..wanted.saturating_mul(PATIENCE) {
        let point: Vec<Node> =
            axes.iter().enumerate().map(|(number, axis)| axis.draw(share(run_seed, attempt, number))).collect();
        if seen.insert(format!("{:?}", point.iter().map(|node| &node.value).collect::<Vec<_>>())) {
            drawn.push(point);
        }
        if drawn.len() == wanted as usize {
            break;
        }
    }
    if drawn.len() < wanted as usize {
        let message = format!("`{}` is {wanted}, and only {} different points were found", count.name, drawn.len());
        return Err(count.error(message, "ask for fewer, or for all combinations: design = \"grid\""));
    }
    for (place, axis) in axes.iter_mut().enumerate() {
        axis.keep(drawn.iter().map(|point| &point[place]));
    }
    let value = |(axis, node): (&AxisSource<'_>, &Node)| axis.index_of(node);
    Ok(drawn.iter().map(|point| axes.iter().zip(point).map(value).collect()).collect())
}

/// Uniform in [0, 1): of the config's seed, the draw and the axis.
fn share(run_seed: u32, attempt: u32, axis: usize) -> f64 {
    let stream =
        Stream { key: [run_seed, 0], skill: axis as u32, trial: attempt, step: 0, purpose: Purpose::Sweep as u32 };
    let words = draw(stream, 0);
    // 53 bits, as many as a double holds.
    (u64::from(words[0]) << 21 | u64::from(words[1]) >> 11) as f64 / (1_u64 << 53) as f64
}

impl AxisSource<'_> {
    fn draw(&self, share: f64) -> Node {
        match self.range {
            Some(range) if self.values.is_empty() => range.value(share, self.item.origin()),
            // The share is below 1.
            _ => self.values[(share * self.values.len() as f64) as usize].clone(),
        }
    }

    fn index_of(&self, node: &Node) -> usize {
        let rank = |node: &Node| number(node).unwrap_or(0.0);
        let found = match self.range {
            Some(_) => self.values.binary_search_by(|value| rank(value).total_cmp(&rank(node))).ok(),
            None => self.values.iter().position(|value| same(value, node)),
        };
        found.unwrap_or(0)
    }

    /// Keeps the values that were drawn: numbers from a range in ascending order, those of a list in its order.
    fn keep<'n>(&mut self, drawn: impl Iterator<Item = &'n Node>) {
        let drawn: Vec<&Node> = drawn.collect();
        if self.values.is_empty() {
            self.values = drawn.into_iter().cloned().collect();
            self.values.sort_by(|a, b| number(a).unwrap_or(0.0).total_cmp(&number(b).unwrap_or(0.0)));
            self.values.dedup_by(|a, b| same(a, b));
        } else {
            self.values.retain(|value| drawn.iter().any(|node| same(node, value)));
        }
    }
}

/// The points to which a run is restricted.
pub(super) fn chosen(only: &Item<'_>, count: usize) -> Result<Vec<usize>, ConfigError> {
    only.chosen("point", "name some, or leave `only` out", |item| {
        let point = item.whole(0, u32::MAX)? as usize;
        if point < count {
            return Ok((point, point.to_string()));
        }
        let hint = match count {
            1 => "there is only point 0: the config has no sweep".to_owned(),
            _ => format!("points are numbered from 0 to {}", count - 1),
        };
        Err(item.error(format!("there is no point {point}"), hint))
    })
}
