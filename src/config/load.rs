//! From a config file and what the command line adds to a [`Plan`].
//!
//! Layers, each over the one before: defaults, the config that the file extends, the file, `--set`, an arm's own table
//! (into which `--set arm.NAME.key=value` goes first), and the values at a point of the sweep. Within a skill,
//! `skill.NAME.learning` lies over `learning`, also over an arm's: what names the skill is more specific.

use super::arm::ArmReader;
use super::keys::{self, KeyRow};
use super::plan::{Evaluate, Plan};
use super::unused_keys::UnusedKeys;
use super::worlds::Worlds;
use super::{arms, renamed, seeds, set, sweep, transfer};
use crate::layout::params::MAX_TRIALS;
use crate::toml::document::{Node, SWEEP, SourceSpan, Value};
use crate::toml::error::ConfigError;
use crate::toml::printer;
use crate::toml::reader::{Item, TableReader};
use crate::toml::{Files, OsFiles};
use std::path::Path;

/// What the command line changes in a config; there, these are options. A later `--set` wins over an earlier one. One on a
/// base key wins over the file's base key, but an arm's own override of that key, being more specific, still holds in that
/// arm. `--seeds` wins over `--set`, and `--arm` over the key `arms`.
#[derive(Debug, Clone, Default, PartialEq, Eq, clap::Args)]
pub struct Overrides {
    /// Seeds, instead of the config's: `0..7` (7 left out), `5`, `1,2,5..9`.
    #[arg(long, value_name = "SEEDS")]
    pub seeds: Option<String>,
    /// Runs this arm only; may be given several times.
    #[arg(long = "arm", value_name = "ARM")]
    pub arms: Vec<String>,
    /// Runs this point of the sweep only, counted from 0 as in the tables; may be given several times.
    #[arg(long = "point", value_name = "N")]
    pub points: Vec<u32>,
    /// Sets a key of the config, such as `learning.learning_rate=0.01`; may be given several times.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

impl Overrides {
    /// Lays all of it over a config.
    fn apply(&self, tree: &mut Node) -> Result<(), ConfigError> {
        for argument in &self.set {
            set::apply(tree, argument)?;
        }
        let typed = |value: Value, argument: String| Node { value, origin: SourceSpan::Argument(argument) };
        if let Some(text) = &self.seeds {
            tree.put(keys::SEEDS.name(), Node::text(text, &seeds::argument(text)));
        }
        if !self.arms.is_empty() {
            let arms = self.arms.iter().map(|arm| typed(Value::Text(arm.clone()), format!("--arm {arm}")));
            tree.put(keys::ARMS.name(), typed(Value::List(arms.collect()), "--arm".to_owned()));
        }
        if !self.points.is_empty() {
            let point = |point: &u32| typed(Value::Integer(i64::from(*point)), format!("--point {point}"));
            let points = typed(Value::List(self.points.iter().map(point).collect()), "--point".to_owned());
            if tree.get(SWEEP).is_none() {
                tree.put(SWEEP, Node::empty(points.origin.clone()));
            }
            if let Some(sweep) = tree.get_mut(SWEEP) {
                sweep.put(keys::SWEEP_ONLY.name(), points);
            }
        }
        Ok(())
    }
}

/// Reads a config file, the world files that it names, and the command line's changes.
///
/// # Errors
/// Where a file cannot be read, or something in it or on the command line is wrong: the place, and what would be right.
pub fn load(path: &Path, overrides: &Overrides) -> Result<Plan, ConfigError> {
    load_from(&OsFiles, path, overrides)
}

/// The same from any source of files, such as [`crate::config::MemoryFiles`].
///
/// # Errors
/// As those of [`load`].
pub fn load_from(files: &dyn Files, path: &Path, overrides: &Overrides) -> Result<Plan, ConfigError> {
    let mut tree = read(files, path)?;
    overrides.apply(&mut tree)?;
    renamed::refuse(&tree)?;
    let mut take = |key: &str| tree.remove(key).map(|entry| entry.node);
    let (own, transferred, swept) = (take("arm"), take("transfer"), take(SWEEP));
    let mut base = defaults(&tree)?;
    base.merge(tree);

    let root = Item::root(&base).table()?;
    let name = match root.optional(keys::NAME) {
        Some(item) => item.short_name()?.to_owned(),
        None => path.file_stem().map_or_else(|| "config".to_owned(), |stem| stem.to_string_lossy().into_owned()),
    };
    let mut worlds = Worlds::new(files, path);
    worlds.place(&root.required(keys::WORLD, "\"worlds/office.toml\"")?)?;
    let evaluate = evaluate(&root)?;
    let run_seed = root.word(&keys::SEED)?;
    let sweep = sweep::read(swept.as_ref(), &base, run_seed)?;
    let mut reader = ArmReader { eval_at: &evaluate.at, worlds, unused: UnusedKeys::default() };
    let arms = arms::read(&mut reader, (&base, &root), own.as_ref(), sweep.as_ref())?;
    let ArmReader { mut worlds, unused, .. } = reader;
    unused.finish()?;
    let alterations = match &transferred {
        Some(transferred) => transfer::read(transferred, &base, arms.base.iter().chain(&arms.run), &mut worlds)?,
        None => Vec::new(),
    };
    let title = root.value(&keys::TITLE)?.text()?.to_owned();
    let seeds = seeds::read(&root.value(&keys::SEEDS)?)?;
    root.finish()?;
    let sweep = sweep.map(|sweep| sweep.plan(&mut worlds)).transpose()?;

    base.put(keys::NAME.name(), Node::text(&name, &base.origin));
    for (key, group) in [(SWEEP, swept), ("arm", own), ("transfer", transferred)] {
        if let Some(group) = group {
            base.put(key, group);
        }
    }
    worlds.rename(&mut base, false);
    let comment = "# Resolved by skilltree: defaults, config file and command line together.";
    let resolved = format!("{comment}\n{}", printer::document(&base));
    let (worlds, arms) = (worlds.placed, arms.run);
    Ok(Plan { name, title, run_seed, seeds, worlds, arms, sweep, alterations, evaluate, resolved })
}

/// A config's tree, laid over that of the config that it extends.
fn read(files: &dyn Files, path: &Path) -> Result<Node, ConfigError> {
    let text = |path: &Path| files.read(path).map_err(|error| ConfigError::unreadable(path, "config file", &error));
    let mut tree = Node::parse(&text(path)?, path)?;
    let Some(entry) = tree.remove(keys::EXTENDS.name()) else { return Ok(tree) };
    let item = Item { name: keys::EXTENDS.name().to_owned(), node: &entry.node };
    let name = item.text()?;
    if Path::new(name).components().count() != 1 {
        // Its world is named by a path that starts from its own folder.
        return Err(item.error(format!("`{name}` lies in another folder"), "name a config beside this one"));
    }
    let beside = path.with_file_name(name);
    let found = text(&beside).map_err(|error| item.error(error.message(), "name a config beside this one"))?;
    let mut base = Node::parse(&found, &beside)?;
    if base.get(keys::EXTENDS.name()).is_some() {
        return Err(item.error(format!("`{name}` itself extends another config"), "name that one instead"));
    }
    for own in [keys::NAME.name(), keys::TITLE.name()] {
        base.remove(own);
    }
    base.merge(tree);
    Ok(base)
}

/// The tree of all defaults, with one table for each skill of the file, in its order.
fn defaults(tree: &Node) -> Result<Node, ConfigError> {
    let mut out = Node::empty(SourceSpan::Default("the whole config"));
    for key in keys::all() {
        let Some(text) = key.default else { continue };
        let parts: Vec<&str> = key.path.split('.').collect();
        match parts[..] {
            ["skill", _, last] => {
                for name in tree.names("skill") {
                    out.merge(default(key, text, &["skill", name, last])?);
                }
            }
            _ => out.merge(default(key, text, &parts)?),
        }
    }
    Ok(out)
}

fn default(key: &KeyRow, text: &str, path: &[&str]) -> Result<Node, ConfigError> {
    let origin = SourceSpan::Default(key.path);
    // A test reads every default; a broken one is still reported and not a panic.
    let broken = || origin.error(format!("`{text}` is not TOML"), "please report this");
    Ok(Node::parse_value(text, &origin)?.ok_or_else(broken)?.under(path))
}

fn evaluate(root: &TableReader<'_>) -> Result<Evaluate, ConfigError> {
    let table = root.required("evaluate", "{}")?.table()?;
    let at = table.value(&keys::EVALUATE_AT)?.ascending(MAX_TRIALS)?;
    let evaluate = Evaluate { at, episodes: table.word(&keys::EVALUATE_EPISODES)? };
    table.finish()?;
    Ok(evaluate)
}
