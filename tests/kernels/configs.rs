//! Small configs.

use skilltree::config::plan::Plan;
use skilltree::config::{Overrides, load};
use std::path::{Path, PathBuf};

/// For `--set`: no noise at all.
pub(crate) const SILENT: &str = "robot.noise={ actuator = 0.0, sonar = 0.0, light = 0.0, compass = 0.0 }";

/// A file of the project.
pub(crate) fn file(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn overrides(set: &[&str]) -> Overrides {
    Overrides { set: set.iter().map(|&argument| argument.to_owned()).collect(), ..Overrides::default() }
}

/// A config of the project with some keys set.
pub(crate) fn shipped(path: &str, set: &[&str]) -> Plan {
    load(&file(path), &overrides(set)).unwrap_or_else(|error| panic!("{error}"))
}

/// A config that lies in a folder of its own.
pub(crate) fn written(text: &str, set: &[&str]) -> Plan {
    let folder = tempfile::tempdir().expect("a folder for the config");
    let path = folder.path().join("written.toml");
    std::fs::write(&path, text).expect("the config is written");
    load(&path, &overrides(set)).unwrap_or_else(|error| panic!("{error}"))
}

/// A config in one of the tests' worlds.
pub(crate) fn plan_in(world: &str, text: &str, set: &[&str]) -> Plan {
    written(&format!("world = {:?}\n{text}", file(&format!("tests/support/{world}.toml"))), set)
}

/// A config in the small world.
pub(crate) fn plan_with(text: &str, set: &[&str]) -> Plan {
    plan_in("small", text, set)
}

/// Number of the skill of this name in the first arm.
pub(crate) fn number(plan: &Plan, name: &str) -> usize {
    plan.arms[0].skills.iter().position(|skill| skill.name == name).expect("a skill of this name")
}

/// Four skills and one above them, for tests of single steps.
pub(crate) const TREE: &str = r#"
    title = "four skills and one above"
    seeds = "0"
    root = "top"
    [evaluate]
    at = []
    episodes = 1
    [teacher]
    eval_episodes = 1
    [learning]
    init_range = 0.4
    [skill.dock]
    inputs = ["sonar(60)", "light", "bumpers"]
    reward = { docked = 100, collision = -10 }
    goal = ["docked"]
    [skill.door]
    inputs = ["sonar(60)", "sonar-far", "bumpers"]
    reward = { passed-door = 100, collision = -10 }
    goal = ["passed-door"]
    [skill.right]
    inputs = ["sonar(30)", "bumpers"]
    reward = { beside-right = 8, collision = -10 }
    [skill.left]
    mirror = "right"
    [skill.top]
    children = ["dock", "door", "right", "left"]
    inputs = ["sonar-far", "bumpers", "running"]
    applicable = { dock = 0.25, door = 0.5 }
    reward = { docked = 100 }
    goal = ["docked"]
    max_steps = 200
"#;
