//! Which skills an arm trains, and in what order: the tree below its root, children before parents.

use super::children;
use super::keys;
use super::plan::{Action, Child};
use crate::layout::{MAX_DEPTH, MAX_SKILLS};
use crate::toml::document::Value;
use crate::toml::error::{ConfigError, suggest};
use crate::toml::reader::{Item, TableReader, is_name};

/// What a skill is made of. Skills are numbered by their places in the file.
#[derive(Debug)]
pub(super) struct Link<'a> {
    pub(super) name: &'a str,
    /// Its complete table.
    pub(super) item: Item<'a>,
    /// What it chooses among, and where that is written; empty if it is mirrored.
    pub(super) children: Vec<(Child, Item<'a>)>,
    /// The skill that it is the mirror image of, and where that is written.
    pub(super) mirror: Option<(usize, Item<'a>)>,
}

impl Link<'_> {
    /// Skills among the children.
    pub(super) fn skills(&self) -> impl Iterator<Item = (usize, &Item<'_>)> {
        self.children.iter().filter_map(|(child, item)| match child {
            Child::Skill(skill) => Some((*skill, item)),
            Child::Action(_) => None,
        })
    }

    /// Skills that must be there before this one.
    fn needs(&self) -> impl Iterator<Item = usize> {
        self.skills().map(|(skill, _)| skill).chain(self.mirror.iter().map(|(skill, _)| *skill))
    }
}

/// Reads what each skill of the table `skill` is made of.
pub(super) fn links<'a>(table: &TableReader<'a>) -> Result<Vec<Link<'a>>, ConfigError> {
    let all = table.all();
    let names: Vec<&str> = all.iter().map(|(entry, _)| entry.key.as_str()).collect();
    let mut links = Vec::with_capacity(all.len());
    for (entry, item) in all {
        let name = entry.key.as_str();
        if !is_name(name) {
            let message = format!("`{name}` cannot be the name of a skill");
            return Err(entry.origin.error(message, "use letters, digits, `-` and `_` only"));
        }
        if Action::ALL.iter().any(|action| action.name() == name) {
            let message = format!("`{name}` cannot be the name of a skill: it is an action");
            return Err(entry.origin.error(message, "choose another name"));
        }
        let section = item.table()?;
        let mirror = mirror(section.value(&keys::SKILL_MIRROR)?, &names)?;
        let children = match mirror {
            Some(_) => Vec::new(),
            None => children::read(&section.value(&keys::SKILL_CHILDREN)?, &names)?,
        };
        links.push(Link { name, item, children, mirror });
    }
    for (number, link) in links.iter().enumerate() {
        let Some((source, item)) = &link.mirror else { continue };
        let problem = match &links[*source] {
            _ if *source == number => "it is the same skill",
            source if source.mirror.is_some() => "it is a mirror image itself",
            source if source.skills().next().is_some() => "it chooses among skills",
            _ => continue,
        };
        let message = format!("`{}` cannot be the mirror image of `{}`: {problem}", link.name, links[*source].name);
        return Err(item.error(message, "name a skill over actions that has keys of its own, or write mirror = false"));
    }
    Ok(links)
}

fn mirror<'a>(item: Item<'a>, names: &[&str]) -> Result<Option<(usize, Item<'a>)>, ConfigError> {
    match item.node.value {
        Value::Flag(false) => Ok(None),
        Value::Text(_) => Ok(Some((item.choice("skills", names)?, item))),
        _ => {
            let message = format!("`{}` must be the name of a skill, or false", item.name);
            Err(item.error(message, format!("{}, or write mirror = false", suggest("", "skills", names))))
        }
    }
}

/// The skill at the top: the one that is named, or else the last one that no other one is made of.
pub(super) fn root(named: Option<&Item<'_>>, links: &[Link<'_>]) -> Result<usize, ConfigError> {
    let names: Vec<&str> = links.iter().map(|link| link.name).collect();
    if let Some(named) = named {
        return named.choice("skills", &names);
    }
    let used = |skill: usize| links.iter().any(|link| link.needs().any(|needed| needed == skill));
    Ok((0..links.len()).rev().find(|skill| !used(*skill)).unwrap_or(links.len() - 1))
}

/// The skills of the root's tree: children before parents, mirrored ones before their images, otherwise in the
/// order of the file. The root comes last.
pub(super) fn order(links: &[Link<'_>], root: usize) -> Result<Vec<usize>, ConfigError> {
    let mut tree = vec![root];
    let mut seen = 0;
    while let Some(&skill) = tree.get(seen) {
        for needed in links[skill].needs() {
            if !tree.contains(&needed) {
                tree.push(needed);
            }
        }
        seen += 1;
    }
    let top = &links[root];
    if tree.len() > MAX_SKILLS {
        let hint = format!("at most {MAX_SKILLS} fit; name another root, or drop children");
        return Err(top.item.error(format!("the tree of `{}` has {} skills", top.name, tree.len()), hint));
    }
    tree.sort_unstable();
    let mut order: Vec<usize> = Vec::with_capacity(tree.len());
    let mut depths = vec![0; links.len()];
    while order.len() < tree.len() {
        let ready =
            |skill: &usize| !order.contains(skill) && links[*skill].needs().all(|needed| order.contains(&needed));
        let Some(next) = tree.iter().copied().find(ready) else { return Err(cycle(links, &order, root)) };
        depths[next] = 1 + links[next].skills().map(|(child, _)| depths[child]).max().unwrap_or(0);
        order.push(next);
    }
    if depths[root] > MAX_DEPTH {
        let hint = format!("at most {MAX_DEPTH} may lie one above the other; drop a level");
        return Err(top.item.error(format!("the tree of `{}` is {} skills deep", top.name, depths[root]), hint));
    }
    Ok(order)
}

/// Names the cycle that keeps the root out of the order: whatever is out has a child that is, so one comes back.
fn cycle(links: &[Link<'_>], order: &[usize], root: usize) -> ConfigError {
    let (mut path, mut at, mut back) = (vec![root], &links[root].item, None);
    while back.is_none()
        && let Some((child, item)) = links[path[path.len() - 1]].skills().find(|(child, _)| !order.contains(child))
    {
        back = path.iter().position(|skill| *skill == child);
        path.push(child);
        at = item;
    }
    let names: Vec<&str> = path[back.unwrap_or(0)..].iter().map(|skill| links[*skill].name).collect();
    let message = format!("`{}` is made of itself: {}", names[0], names.join(" > "));
    at.error(message, "a skill may not be among its own children, nor among theirs; drop one")
}
