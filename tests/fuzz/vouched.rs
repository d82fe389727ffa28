//! A complete run whose manifest vouches for nonsense: rows that no experiment leaves, and texts that fit their readers.

use super::campaign::campaign;
use super::memory::Memory;
use super::within::folder;
use super::{file, files, mutate, somewhere};
use skilltree::report::{self, ReportError};
use skilltree::run_folder::file_system::FileSystem;
use skilltree::run_folder::manifest::FileDigest;
use skilltree::run_folder::tables::{parse_evaluations, parse_trials, write_table};
use skilltree::run_folder::{FinishedRun, Manifest};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// Files whose nonsense a report may see.
const TEXTS: [&str; 4] = ["places.json", "trajectories.json", "world.toml", "config.toml"];

/// An edge, a small number, or as it was.
fn altered(random: &mut mutate::StepRandom, value: &mut u32) {
    match random.below(6) {
        0 => *value = *random.pick(&mutate::EDGES),
        1 => *value = random.below(8) as u32,
        2 => *value = value.wrapping_add(1),
        _ => {}
    }
}

fn amount(random: &mut mutate::StepRandom, value: &mut f64) {
    if random.below(4) == 0 {
        *value = *random.pick(&[0.0, -0.0, 1.0, -1e300, 1e300, f64::INFINITY, f64::NAN, f64::MIN_POSITIVE]);
    }
}

/// Another name now and then, one that no row has among them.
fn renamed(random: &mut mutate::StepRandom, name: &mut String) {
    let words = ["", "planner", "trained", "none", "dock", "räume", "<b>&\"", "recharge", "hierarchical", "A\nB\u{0}"];
    if random.below(4) == 0 {
        (*random.pick(&words)).clone_into(name);
    }
}

fn nonsense(random: &mut mutate::StepRandom) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = files().clone();
    let mut changed: Vec<(&str, Vec<u8>)> = Vec::new();
    if random.below(4) > 0 {
        let (_, mut rows) = parse_evaluations(file("evaluations.parquet"), somewhere()).unwrap();
        let copies: Vec<_> = (0..random.below(30)).map(|_| random.pick(&rows).clone()).collect();
        rows.extend(copies);
        rows.truncate(random.below(rows.len() + 1));
        for row in &mut rows {
            let names = [&mut row.arm, &mut row.skill, &mut row.variant, &mut row.room];
            names.into_iter().for_each(|name| renamed(random, name));
            let fields = [&mut row.point, &mut row.seed, &mut row.trials, &mut row.actions];
            let sums = [&mut row.episodes, &mut row.successes, &mut row.steps, &mut row.collisions];
            fields.into_iter().chain(sums).for_each(|field| altered(random, field));
            amount(random, &mut row.reward);
            amount(random, &mut row.r#return);
        }
        changed.push(("evaluations.parquet", write_table(&rows).unwrap()));
    }
    if random.below(2) > 0 {
        let (_, mut rows) = parse_trials(file("trials.parquet"), somewhere()).unwrap();
        rows.truncate(random.below(rows.len() + 1));
        for row in &mut rows {
            [&mut row.arm, &mut row.skill].into_iter().for_each(|name| renamed(random, name));
            let fields = [&mut row.seed, &mut row.trial, &mut row.actions, &mut row.steps, &mut row.collisions];
            fields.into_iter().for_each(|field| altered(random, field));
            let mut reward = f64::from(row.reward);
            amount(random, &mut reward);
            row.reward = reward as f32;
        }
        changed.push(("trials.parquet", write_table(&rows).unwrap()));
    }
    if random.below(2) > 0 {
        let name = *random.pick(&TEXTS);
        changed.push((name, mutate::text(random, &[file(name)])));
    }
    let path = folder().join("manifest.json");
    let mut manifest = Manifest::parse(&files[&path], &path).unwrap();
    for (name, bytes) in changed {
        manifest.files.insert(name.to_owned(), FileDigest::of(&bytes));
        files.insert(folder().join(name), bytes);
    }
    manifest.provenance.seeds.iter_mut().for_each(|seed| altered(random, seed));
    files.insert(path, manifest.to_bytes().unwrap());
    files
}

/// The whole report.
#[test]
fn reports() {
    let make = |random: &mut mutate::StepRandom| random.draw_step().to_le_bytes().to_vec();
    let read = |input: &[u8]| {
        let mut random = mutate::StepRandom::new(u64::from_le_bytes(input.try_into().unwrap()));
        let disk: Arc<dyn FileSystem> = Arc::new(Memory::of(&nonsense(&mut random)));
        let Ok(run) = FinishedRun::read_on(disk, &folder()) else { return Ok(false) };
        match report::render(&run) {
            Ok(_) => {}
            Err(error @ ReportError::Page(_)) => return Err(format!("no page: {error}")),
            Err(_) => return Ok(false),
        }
        Ok(true)
    };
    campaign("reports", make, read).conclude("reports");
}
