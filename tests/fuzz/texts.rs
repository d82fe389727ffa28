//! What users write: configs, command lines, worlds.

use super::campaign::campaign;
use super::{mutate, somewhere};
use skilltree::config::{Overrides, load};
use skilltree::world;
use std::cell::Cell;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// TOML files below a folder of the repository.
fn found(folder: &str) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = Vec::new();
    let mut open = vec![root().join(folder)];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|ending| ending == "toml") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

fn texts(paths: &[PathBuf]) -> Vec<Vec<u8>> {
    paths.iter().map(|path| fs::read(path).unwrap()).collect()
}

/// A copy of all that is shipped, where configs find their worlds and the configs that they extend.
fn desk() -> TempDir {
    let desk = TempDir::new().unwrap();
    for path in found("configs") {
        let to = desk.path().join(path.strip_prefix(root()).unwrap());
        fs::create_dir_all(to.parent().unwrap()).unwrap();
        fs::copy(path, to).unwrap();
    }
    for small in ["small.toml", "easy.toml", "tree.toml"] {
        fs::copy(root().join("tests/support").join(small), desk.path().join("configs/worlds").join(small)).unwrap();
    }
    desk
}

/// A config that is accepted must be accepted again from its run folder, and mean the same.
fn again(desk: &Path, path: &Path, overrides: &Overrides) -> Result<bool, String> {
    let Ok(plan) = load(path, overrides) else { return Ok(false) };
    let folder = desk.join("again");
    fs::create_dir_all(folder.join("worlds")).unwrap();
    for world in &plan.worlds {
        fs::write(folder.join(&world.file), &world.text).unwrap();
    }
    let config = folder.join("config.toml");
    fs::write(&config, &plan.resolved).unwrap();
    match load(&config, &Overrides::default()) {
        Err(error) => Err(format!("refuses its own text: {}", error.message())),
        Ok(second) if second.resolved != plan.resolved || second.arms != plan.arms => {
            Err("means something else in its run folder".to_owned())
        }
        Ok(_) => Ok(true),
    }
}

/// A config, as it stands or as the one that another extends.
#[test]
fn configs() {
    let desk = desk();
    let mut seeds = texts(&found("configs"));
    seeds.retain(|seed| String::from_utf8_lossy(seed).contains("title"));
    seeds.extend(texts(&[root().join("tests/support/tree.toml")]));
    let folder = desk.path().join("configs");
    let (own, child) = (folder.join("mutated.toml"), folder.join("child.toml"));
    fs::write(&child, "extends = \"mutated.toml\"\ntitle = \"A child\"\n[evaluate]\nat = [0, 7]\n").unwrap();
    let turn = Cell::new(0_u32);
    campaign(
        "configs",
        |random| mutate::text(random, &seeds),
        |input| {
            fs::write(&own, input).unwrap();
            turn.set(turn.get() + 1);
            let path = if turn.get().is_multiple_of(4) { &child } else { &own };
            again(desk.path(), path, &Overrides::default())
        },
    )
    .conclude("configs");
}

/// `--seeds` on the first line, one `--set` on each other.
#[test]
fn command_lines() {
    let desk = desk();
    let config = desk.path().join("configs/docking.toml");
    let small = "world=worlds/small.toml";
    let seeds = [
        "0..7\nlearning.learning_rate=0.01\nskill.dock.trials=6\narms=['taught-adam']",
        "1,2,5..9\narm.taught-sgd.learning.learning_rate=0.1\nevaluate.at=[0, 3]",
        "0..=4294967295\nskill.dock.starts={ light-area = 0.8, anywhere = 0.2 }\nlearning.optimiser=sgd",
        "4294967295\nskill.dock.inputs=['sonar(60)', 'light']\nskill.dock.reward={ docked = 100 }",
        "3\nrobot.noise={ kind = 'uniform', sonar = 0.1 }\ntitle=\"words\"\nseed=7",
    ];
    let seeds: Vec<Vec<u8>> = seeds.iter().map(|seed| seed.as_bytes().to_vec()).collect();
    campaign(
        "command_lines",
        |random| mutate::text(random, &seeds),
        |input| {
            let text = String::from_utf8_lossy(input);
            let mut lines = text.lines().map(str::to_owned);
            let seeds = lines.next();
            let set: Vec<String> = std::iter::once(small.to_owned()).chain(lines).collect();
            again(desk.path(), &config, &Overrides { set, seeds, ..Overrides::default() })
        },
    )
    .conclude("command_lines");
}

#[test]
fn worlds() {
    let mut seeds = texts(&found("configs/worlds"));
    seeds.extend(texts(&[root().join("tests/support/small.toml")]));
    campaign(
        "worlds",
        |random| mutate::text(random, &seeds),
        |input| {
            let Ok(text) = std::str::from_utf8(input) else { return Ok(false) };
            Ok(world::load::parse(text, somewhere()).is_ok())
        },
    )
    .conclude("worlds");
}
