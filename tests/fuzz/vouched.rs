//! A complete run whose manifest vouches for nonsense: rows that no experiment leaves, and texts that fit their readers.

use super::campaign::campaign;
use super::memory::Memory;
use super::within::folder;
use super::{file, files, mutate, somewhere};
use skilltree::record::disk::Disk;
use skilltree::record::manifest::FileDigest;
use skilltree::record::tables::{parse_evaluations, parse_trials, write_evaluations, write_trials};
use skilltree::record::{FinishedRun, Manifest, Names};
use skilltree::report::{gallery, page, results::Results, text};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// Files whose nonsense a report may see.
const TEXTS: [&str; 4] = ["places.json", "trajectories.json", "world.toml", "config.toml"];

/// An edge, a small number, or as it was.
fn altered(dice: &mut mutate::Dice, value: &mut u32) {
    match dice.below(6) {
        0 => *value = *dice.pick(&mutate::EDGES),
        1 => *value = dice.below(8) as u32,
        2 => *value = value.wrapping_add(1),
        _ => {}
    }
}

fn amount(dice: &mut mutate::Dice, value: &mut f64) {
    if dice.below(4) == 0 {
        *value = *dice.pick(&[0.0, -0.0, 1.0, -1e300, 1e300, f64::INFINITY, f64::NAN, f64::MIN_POSITIVE]);
    }
}

fn renamed(dice: &mut mutate::Dice, names: &mut Names) {
    let Names { arms, skills, variants, rooms } = names;
    for list in [arms, skills, variants, rooms] {
        let words =
            ["", "planner", "trained", "none", "dock", "räume", "<b>&\"", "recharge", "hierarchical", "A\nB\u{0}"];
        for name in list.iter_mut() {
            if dice.below(6) == 0 {
                (*dice.pick(&words)).clone_into(name);
            }
        }
        // More than the file had, so that rows may name them.
        list.extend((0..dice.below(4)).map(|_| (*dice.pick(&words)).to_owned()));
    }
}

fn nonsense(dice: &mut mutate::Dice) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = files().clone();
    let mut changed: Vec<(&str, Vec<u8>)> = Vec::new();
    if dice.below(4) > 0 {
        let (mut names, mut rows) = parse_evaluations(file("evaluations.parquet"), somewhere()).unwrap();
        renamed(dice, &mut names);
        let copies: Vec<_> = (0..dice.below(30)).map(|_| *dice.pick(&rows)).collect();
        rows.extend(copies);
        rows.truncate(dice.below(rows.len() + 1));
        for row in &mut rows {
            let chosen = |dice: &mut mutate::Dice, list: &[String]| dice.below(list.len()) as u32;
            row.arm = chosen(dice, &names.arms);
            row.skill = chosen(dice, &names.skills);
            row.variant = chosen(dice, &names.variants);
            row.room = chosen(dice, &names.rooms);
            let fields = [&mut row.point, &mut row.seed, &mut row.trials, &mut row.actions];
            let sums = [&mut row.episodes, &mut row.successes, &mut row.steps, &mut row.collisions];
            fields.into_iter().chain(sums).for_each(|field| altered(dice, field));
            amount(dice, &mut row.reward);
            amount(dice, &mut row.returned);
        }
        changed.push(("evaluations.parquet", write_evaluations(&rows, &names).unwrap()));
    }
    if dice.below(2) > 0 {
        let (mut names, mut rows) = parse_trials(file("trials.parquet"), somewhere()).unwrap();
        renamed(dice, &mut names);
        rows.truncate(dice.below(rows.len() + 1));
        for row in &mut rows {
            (row.arm, row.skill) = (dice.below(names.arms.len()) as u32, dice.below(names.skills.len()) as u32);
            let fields = [&mut row.seed, &mut row.trial, &mut row.actions, &mut row.steps, &mut row.collisions];
            fields.into_iter().for_each(|field| altered(dice, field));
            let mut reward = f64::from(row.reward);
            amount(dice, &mut reward);
            row.reward = reward as f32;
        }
        changed.push(("trials.parquet", write_trials(&rows, &names).unwrap()));
    }
    if dice.below(2) > 0 {
        let name = *dice.pick(&TEXTS);
        changed.push((name, mutate::text(dice, &[file(name)])));
    }
    let path = folder().join("manifest.json");
    let mut manifest = Manifest::parse(&files[&path], &path).unwrap();
    for (name, bytes) in changed {
        manifest.files.insert(name.to_owned(), FileDigest::of(&bytes));
        files.insert(folder().join(name), bytes);
    }
    manifest.provenance.seeds.iter_mut().for_each(|seed| altered(dice, seed));
    files.insert(path, manifest.to_bytes().unwrap());
    files
}

/// The whole report, but for turning figures into pixels.
#[test]
fn reports() {
    let make = |dice: &mut mutate::Dice| dice.roll().to_le_bytes().to_vec();
    let read = |input: &[u8]| {
        let mut dice = mutate::Dice::new(u64::from_le_bytes(input.try_into().unwrap()));
        let disk: Arc<dyn Disk> = Arc::new(Memory::of(&nonsense(&mut dice)));
        let Ok(run) = FinishedRun::read_on(disk, &folder()) else { return Ok(false) };
        let Ok(results) = Results::read(&run) else { return Ok(false) };
        let Ok(drawings) = gallery::draw(&run, &results) else { return Ok(false) };
        text::table(&results.summary, &results.claims);
        page::render(&run, &results, &drawings).map_err(|error| format!("no page: {error}"))?;
        Ok(true)
    };
    campaign("reports", make, read).conclude("reports");
}
