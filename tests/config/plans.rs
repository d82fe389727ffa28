//! What the tests of configs share: files in a folder of their own, and plans compared.

use skilltree::config::plan::Plan;
use skilltree::config::{ConfigError, Overrides, Place, load};
use std::path::PathBuf;

/// What `--set` says.
pub(crate) fn with(set: &[&str]) -> Overrides {
    Overrides { set: set.iter().map(|&text| text.to_owned()).collect(), ..Overrides::default() }
}

/// Loads the first of these files.
pub(crate) fn attempt_files(files: &[(&str, &str)]) -> (Result<Plan, ConfigError>, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(path, text).expect("a file");
    }
    let path = folder.path().join(files[0].0);
    (load(&path, &Overrides::default()), path)
}

/// Sees that each of these settings is refused: words of the message and of the hint, and the place.
pub(crate) fn each_is_refused(cases: &[(&str, &str, &str)], refused: impl Fn(&str) -> ConfigError) {
    for (set, message, hint) in cases {
        let error = refused(set);
        println!("{error}\n");
        assert!(error.message().contains(message) && error.hint().contains(hint), "{set}\n{error}");
        assert_eq!(error.place(), &Place::Argument(format!("--set {set}")), "{error}");
    }
}

fn same(a: &Plan, b: &Plan) {
    assert_eq!(a.name, b.name);
    assert_eq!(a.title, b.title);
    assert_eq!((a.run_seed, &a.seeds), (b.run_seed, &b.seeds));
    let files = |plan: &Plan| plan.worlds.iter().map(|w| (w.file.clone(), w.text.clone())).collect::<Vec<_>>();
    assert_eq!(files(a), files(b));
    assert!(a.worlds.iter().zip(&b.worlds).all(|(a, b)| a.world == b.world));
    assert_eq!((&a.arms, &a.alterations), (&b.arms, &b.alterations));
    assert_eq!((&a.evaluate, &a.sweep), (&b.evaluate, &b.sweep));
    assert_eq!(a.resolved, b.resolved);
}

/// Reads a plan as its run folder would give it, and compares.
pub(crate) fn read_again(plan: &Plan) {
    let mut files = vec![("config.toml", plan.resolved.as_str())];
    files.extend(plan.worlds.iter().map(|world| (world.file.as_str(), world.text.as_str())));
    let again = attempt_files(&files).0.unwrap_or_else(|error| panic!("{error}\n{}", plan.resolved));
    same(plan, &again);
}

pub(crate) const FILE: &str = "\
title = 'test'
world = 'world.toml'
[learning]
learning_rate = 0.01
[skill.dock]
inputs = ['sonar', 'bumpers']
reward = { docked = 100 }
starts = 'anywhere'
goal = ['docked']
[arm.one]
[arm.two]
learning.gamma = 0.5
";
pub(crate) const WORLD: &str = "\
size = [200, 200]
rooms = [{ name = 'A', box = [0, 0, 200, 200] }]
charger = { box = [0, 0, 24, 24] }
light = { at = [12, 12], range = 100 }
places = { L1 = [100, 100, 0] }
regions = [{ name = 'sliver', box = [0, 50, 10, 200] }]
";

pub(crate) fn attempt(config: &str, world: &str) -> (Result<Plan, ConfigError>, PathBuf) {
    attempt_files(&[("config.toml", config), ("world.toml", world)])
}
