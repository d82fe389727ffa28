//! The floor plans that a config names, each read once.

use super::keys;
use super::plan::PlacedWorld;
use crate::toml::Files;
use crate::toml::document::{Node, Value};
use crate::toml::error::ConfigError;
use crate::toml::reader::Item;
use crate::world::{self, World};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// World files read so far.
#[derive(Debug)]
pub(super) struct Worlds<'a> {
    files: &'a dyn Files,
    /// The config file, from whose folder paths start.
    config: &'a Path,
    /// Index of the world that each of these texts names.
    named: BTreeMap<String, usize>,
    /// Where each of them lies, without symbolic links and detours.
    paths: Vec<PathBuf>,
    /// The worlds, in the order in which they were named first.
    pub(super) placed: Vec<PlacedWorld>,
    /// What was found out of the regions of each.
    regions: Vec<RegionCache>,
}

/// Whether regions of a world are empty, as far as it was asked: looking takes long, and sweeps ask thousands of times.
type RegionCache = RefCell<BTreeMap<String, Option<bool>>>;

/// A floor plan against which skills are held.
#[derive(Debug, Clone, Copy)]
pub(super) struct CachedWorld<'a> {
    /// The floor plan.
    pub(super) world: &'a World,
    regions: &'a RegionCache,
}

impl CachedWorld<'_> {
    /// As [`World::region_is_empty`].
    pub(super) fn region_is_empty(&self, name: &str) -> Option<bool> {
        let mut known = self.regions.borrow_mut();
        *known.entry(name.to_owned()).or_insert_with(|| self.world.region_is_empty(name))
    }
}

impl<'a> Worlds<'a> {
    pub(super) fn new(files: &'a dyn Files, config: &'a Path) -> Self {
        Self { files, config, named: BTreeMap::new(), paths: Vec::new(), placed: Vec::new(), regions: Vec::new() }
    }

    /// The floor plan with this index.
    pub(super) fn cached(&self, index: usize) -> CachedWorld<'_> {
        CachedWorld { world: &self.placed[index].world, regions: &self.regions[index] }
    }

    /// Index of the world whose file `item` names; reads the file if it is new.
    pub(super) fn place(&mut self, item: &Item<'_>) -> Result<usize, ConfigError> {
        let name = item.text()?;
        if let Some(index) = self.named.get(name) {
            return Ok(*index);
        }
        let index = self.find(item, name)?;
        self.named.insert(name.to_owned(), index);
        Ok(index)
    }

    fn find(&mut self, item: &Item<'_>, name: &str) -> Result<usize, ConfigError> {
        let path = self.config.parent().unwrap_or(Path::new("")).join(name);
        let real = self.files.identity(&path);
        if let Some(index) = self.paths.iter().position(|known| *known == real) {
            return Ok(index);
        }
        let text = self.files.read(&path).map_err(|error| {
            let error = ConfigError::unreadable(&path, "world file", &error);
            let hint =
                format!("it was looked for at {}; the path starts from the config file's folder", path.display());
            item.error(error.message(), hint)
        })?;
        self.placed.push(PlacedWorld { world: world::parse(&text, &path)?, text, file: self.free_name(&path) });
        self.regions.push(RegionCache::default());
        self.paths.push(real);
        Ok(self.placed.len() - 1)
    }

    /// A name in the run folder that no other world has; the config's own has the same in every folder.
    fn free_name(&self, path: &Path) -> String {
        if self.placed.is_empty() {
            return "world.toml".to_owned();
        }
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        // Run folders take no other characters, and nothing hidden.
        let plain = |c: char| if c.is_ascii_alphanumeric() || ".-_+=".contains(c) { c } else { '-' };
        let stem: String = stem.trim_start_matches('.').chars().map(plain).collect();
        let stem = if stem.is_empty() { "world" } else { stem.as_str() };
        // Some disks do not tell capitals from small letters.
        let taken = |name: &String| self.placed.iter().any(|other| other.file.eq_ignore_ascii_case(name));
        let numbered = (2_usize..).map(|number| format!("worlds/{stem}-{number}.toml"));
        let mut names = std::iter::once(format!("worlds/{stem}.toml")).chain(numbered);
        names.find(|name| !taken(name)).unwrap_or_default()
    }

    /// Gives worlds the names that they have in a run folder, wherever a key `world` names them; `named` tells whether
    /// this is the value of one.
    pub(super) fn rename(&self, node: &mut Node, named: bool) {
        match &mut node.value {
            Value::Table(entries) => entries.iter_mut().for_each(|entry| {
                // An axis may have its values in a table, beside a label.
                let named = entry.key == keys::WORLD.name() || named && entry.key == "values";
                self.rename(&mut entry.node, named);
            }),
            Value::List(items) if named => items.iter_mut().for_each(|item| self.rename(item, true)),
            Value::Text(text) if named => {
                if let Some(index) = self.named.get(text) {
                    text.clone_from(&self.placed[*index].file);
                }
            }
            _ => {}
        }
    }
}
