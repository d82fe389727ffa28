//! The arms of a config at the points of its sweep.

use super::{AxisSource, SweepSource};
use crate::config::arm::ArmReader;
use crate::config::plan::{ArmPlan, Child};
use crate::toml::document::{Node, Value};
use crate::toml::error::{ConfigError, suggest};
use std::collections::HashSet;

/// An arm without the sweep, and its complete config.
pub(in crate::config) struct Base<'a> {
    pub(in crate::config) arm: &'a ArmPlan,
    pub(in crate::config) tree: Node,
    /// Whether it is chosen. The others show what an axis is for where one arm is run alone.
    pub(in crate::config) run: bool,
}

/// Reads each arm at its points. An arm that an axis does not concern is the same at many points, and is run at the
/// first of them alone.
pub(in crate::config) fn at_points(
    reader: &mut ArmReader<'_>,
    mut bases: Vec<Base<'_>>,
    sweep: &SweepSource<'_>,
) -> Result<Vec<ArmPlan>, ConfigError> {
    for axis in &sweep.axes {
        if !bases.iter().any(|base| is_concerned(base.arm, &base.tree, axis, sweep)) {
            return Err(axis.item.error(format!("no arm has `{}`", axis.key), hint(axis, &bases)));
        }
    }
    let mut arms = Vec::new();
    for Base { arm, tree, .. } in bases.iter_mut().filter(|base| base.run) {
        let own: Vec<usize> =
            (0..sweep.axes.len()).filter(|axis| is_concerned(arm, tree, &sweep.axes[*axis], sweep)).collect();
        let mut seen = HashSet::new();
        for (number, point) in sweep.points.iter().enumerate() {
            let new =
                own.len() == sweep.axes.len() || seen.insert(own.iter().map(|axis| point[*axis]).collect::<Vec<_>>());
            if new && sweep.only.binary_search(&number).is_ok() {
                lay(tree, sweep, point);
                arms.push(reader.read((&arm.name, number as u32), tree)?);
            }
        }
    }
    if let ([], Some(point)) = (&arms[..], sweep.only.first()) {
        let message = format!("point {point} changes no arm that is run");
        let hint = "these arms do not have all the axes: run the first point with the same values on those they have";
        return Err(sweep.item.error(message, hint));
    }
    bases.sort_by_key(|base| !base.run);
    for (number, axis) in sweep.axes.iter().enumerate().filter(|(_, axis)| axis.values.len() > 1) {
        if !changes(reader, &mut bases, sweep, number)? {
            let message = format!("`{}` changes nothing in any arm", axis.key);
            let hint = "nothing uses it, as momentum where the optimiser is adam; or all skills have their own: name the \
                        skill, as in skill.dock.learning.learning_rate";
            return Err(axis.item.error(message, hint));
        }
    }
    Ok(arms)
}

/// Whether at some point another value on one axis makes another arm.
fn changes(
    reader: &mut ArmReader<'_>,
    bases: &mut [Base<'_>],
    sweep: &SweepSource<'_>,
    axis: usize,
) -> Result<bool, ConfigError> {
    for point in &sweep.points {
        let mut other = point.clone();
        other[axis] = (point[axis] + 1) % sweep.axes[axis].values.len();
        for Base { tree, run, .. } in &mut *bases {
            let mut at = |point: &[usize]| {
                lay(tree, sweep, point);
                reader.read(("", 0), tree)
            };
            match (at(point), at(&other)) {
                (Ok(one), Ok(another)) if one != another => return Ok(true),
                (Err(error), _) | (_, Err(error)) if *run => return Err(error),
                // An arm that is not run need not suit the points.
                _ => {}
            }
        }
    }
    Ok(false)
}

/// Whether an arm has the key of an axis.
fn is_concerned(arm: &ArmPlan, tree: &Node, axis: &AxisSource<'_>, sweep: &SweepSource<'_>) -> bool {
    let [first, skill, ..] = &axis.path[..] else { return true };
    // Another root may have other skills below it.
    let trained = first != "skill"
        || sweep.axes.iter().any(|axis| axis.key == "root")
        || arm.skills.iter().any(|own| own.name == *skill);
    trained && has(tree, &axis.path)
}

fn hint(axis: &AxisSource<'_>, bases: &[Base<'_>]) -> String {
    let skill = axis.path.get(1).map_or("", String::as_str);
    let own = bases.iter().find_map(|base| base.arm.skills.iter().find(|own| own.name == skill).map(|own| (base, own)));
    match (own, axis.path.last()) {
        (Some((base, own)), Some(child)) if own.is_high() => {
            let skills = own.children.iter().filter(|child| matches!(child, Child::Skill(_)));
            let names: Vec<&str> = skills.map(|child| base.arm.name_of(*child)).collect();
            suggest(child, "skills among the children", &names)
        }
        (Some(_), _) => format!("`{skill}` chooses among actions, which have no threshold"),
        (None, _) => format!("`{skill}` is not in the tree of any root; choose other arms, or drop the axis"),
    }
}

/// Lays a point over a tree: every other key stays, also beside a member of an inline table.
fn lay(tree: &mut Node, sweep: &SweepSource<'_>, point: &[usize]) {
    for (axis, value) in sweep.axes.iter().zip(point) {
        if has(tree, &axis.path) {
            put(tree, &axis.path, &axis.values[*value]);
        }
    }
}

/// Whether the key makes sense in this arm: only a child has a threshold.
fn has(tree: &Node, path: &[String]) -> bool {
    let [_, skill, table, child] = path else { return true };
    let children = tree.get("skill").and_then(|skills| skills.get(skill)).and_then(|skill| skill.get("children"));
    match children.map(|children| &children.value) {
        Some(Value::List(children)) if table == "applicable" => {
            children.iter().any(|node| matches!(&node.value, Value::Text(name) if name == child))
        }
        _ => true,
    }
}

fn put(tree: &mut Node, path: &[String], value: &Node) {
    let [first, rest @ ..] = path else { return tree.clone_from(value) };
    if !matches!(tree.value, Value::Table(_)) {
        *tree = Node::empty(value.origin.clone());
    }
    if tree.get(first).is_none() {
        tree.put(first, Node::empty(value.origin.clone()));
    }
    if let Some(node) = tree.get_mut(first) {
        put(node, rest, value);
    }
}
