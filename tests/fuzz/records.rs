//! Files of run folders, each given to its reader as if no hash had been checked.

use super::campaign::campaign;
use super::within::folder;
use super::{experiment, file, files, mutate, somewhere};
use crate::memory::Memory;
use skilltree::backend::cpu::CpuBackend;
use skilltree::experiment::checkpoint::Checkpoint;
use skilltree::experiment::result::{LearnerResult, decode, encode};
use skilltree::experiment::run::RunError;
use skilltree::experiment::train::train;
use skilltree::record::disk::Disk;
use skilltree::record::failures::read_failures;
use skilltree::record::manifest::Manifest;
use skilltree::record::places::read_places;
use skilltree::record::sweep::read_sweep;
use skilltree::record::tables::{parse_evaluations, parse_trials};
use skilltree::record::trajectories::read_trajectories;
use skilltree::record::weights::read_weights;
use std::path::PathBuf;
use std::sync::Arc;

/// What the learners of the tiny experiment leave.
fn results() -> Vec<LearnerResult> {
    let experiment = experiment();
    let group = &experiment.groups[0];
    let mut backend = CpuBackend::new(1, None).unwrap();
    let ids = group.learners(&experiment.plan);
    train(&experiment.plan, group, &ids, &|_| None, None, &mut backend, &mut ()).unwrap()
}

/// The content of a part: what is read is written back as it was.
#[test]
fn parts() {
    let seeds = [encode(&results()), encode(&results()[..1]), encode(&[])];
    let read = |input: &[u8]| match decode(input) {
        Ok(results) if encode(&results) != input => Err("is not what was read".to_owned()),
        other => Ok(other.is_ok()),
    };
    campaign("parts", |dice| mutate::bytes(dice, &seeds), read).conclude("parts");
}

/// A part whose frame vouches for nonsense: whoever goes on from there refuses it, or takes what can be taken.
#[test]
fn vouched_parts() {
    let seeds = [encode(&results()), encode(&results()[..1])];
    let experiment = experiment();
    let read = |input: &[u8]| {
        let disk: Arc<dyn Disk> = Arc::new(Memory::default());
        let mut run = experiment.open(&disk, &folder()).unwrap();
        run.commit_part("2-of-2_arm0-seed0_arm0-seed1", input).unwrap();
        drop(run);
        Ok(experiment.run(&disk, &folder()).is_ok())
    };
    campaign("vouched_parts", |dice| mutate::bytes(dice, &seeds), read).conclude("vouched_parts");
}

/// The content of a checkpoint, as if its frame vouched for it.
#[test]
fn checkpoints() {
    let experiment = experiment();
    let disk: Arc<dyn Disk> = Arc::new(Memory::default());
    assert!(matches!(experiment.stop(&disk, &folder()), Err(RunError::Stopped { .. })));
    let seed = experiment.open(&disk, &folder()).unwrap().read_checkpoint().unwrap();
    let seeds = [seed.expect("a checkpoint")];
    let read = |input: &[u8]| Ok(Checkpoint::read(input, &experiment.plan, &experiment.groups).is_ok());
    campaign("checkpoints", |dice| mutate::bytes(dice, &seeds), read).conclude("checkpoints");
}

#[test]
fn tables() {
    let (trials, tests) = (file("trials.parquet"), file("evaluations.parquet"));
    let seeds = [trials, tests];
    let read = |input: &[u8]| {
        let trials = parse_trials(input.to_vec(), somewhere()).is_ok();
        Ok(trials | parse_evaluations(input.to_vec(), somewhere()).is_ok())
    };
    campaign("tables", |dice| mutate::bytes(dice, &seeds), read).conclude("tables");
}

#[test]
fn weights() {
    let seeds = [file("skills/taught-adam-0.safetensors"), file("skills/taught-adam-1.safetensors")];
    // The header is text behind eight bytes of length: half of the inputs have another text with the right length.
    let header = |seed: &[u8]| 8 + u64::from_le_bytes(seed[..8].try_into().unwrap()) as usize;
    let texts: Vec<Vec<u8>> = seeds.iter().map(|seed| seed[8..header(seed)].to_vec()).collect();
    let make = |dice: &mut mutate::Dice| {
        if dice.below(2) == 0 {
            return mutate::bytes(dice, &seeds);
        }
        let text = mutate::text(dice, &texts);
        let length = (text.len() as u64).to_le_bytes();
        [&length[..], &text, &seeds[0][header(&seeds[0])..]].concat()
    };
    campaign("weights", make, |input| Ok(read_weights(input, somewhere()).is_ok())).conclude("weights");
}

/// The JSON files of a run folder: each reader sees all of them.
#[test]
fn json() {
    let sweep = r#"{"axes":[{"key":"skill.dock.max_steps","label":"steps","scale":"linear","values":[5,10]},
        {"key":"world","label":"world","scale":"list","values":["a","b"]}],
        "points":[[5,"a"],[5,"b"],[10,"a"]],"design":"grid"}"#;
    assert!(read_sweep(sweep.as_bytes(), somewhere()).is_ok());
    let transition = r#"{"taught":true,"lesson":3,"mirrored":false,"step":2,"child":"move+12","record":[1,2],
        "inputs":[0.5],"q":[0.25,"NaN"],"target":"inf"}"#;
    let failures = format!(
        r#"[{{"arm":"a","point":0,"seed":1,"skill":"dock","trial":7,"what":"w","transition":{transition},"weight":null}}]"#
    );
    assert!(read_failures(failures.as_bytes(), somewhere()).is_ok());
    let mut seeds = ["manifest.json", "places.json", "trajectories.json"].map(file).to_vec();
    seeds.extend([sweep.as_bytes().to_vec(), failures.into_bytes()]);
    let read = |input: &[u8]| {
        let manifest = Manifest::parse(input, somewhere()).is_ok();
        let places = read_places(input, somewhere()).is_ok();
        let sweep = read_sweep(input, somewhere()).is_ok();
        let failures = read_failures(input, somewhere()).is_ok();
        Ok(manifest | places | sweep | failures | read_trajectories(input, somewhere()).is_ok())
    };
    campaign("json", |dice| mutate::text(dice, &seeds), read).conclude("json");
}

/// A run folder in which files were lost, altered or mixed up: opening it, and going on, is refused or works.
#[test]
fn folders() {
    let names: Vec<&PathBuf> = files().keys().collect();
    let contents: Vec<Vec<u8>> = files().values().cloned().collect();
    let experiment = experiment();
    let make = |dice: &mut mutate::Dice| dice.roll().to_le_bytes().to_vec();
    let read = |input: &[u8]| {
        let mut dice = mutate::Dice::new(u64::from_le_bytes(input.try_into().unwrap()));
        let mut files = files().clone();
        if dice.below(2) == 0 {
            files.remove(&folder().join("manifest.json"));
        }
        for _ in 0..=dice.below(3) {
            let name = (*dice.pick(&names)).clone();
            match dice.below(4) {
                0 => drop(files.remove(&name)),
                1 => drop(files.insert(name, mutate::bytes(&mut dice, &contents))),
                2 => drop(
                    files.insert(folder().join("parts/arm0-seed0_arm0-seed0"), mutate::bytes(&mut dice, &contents)),
                ),
                _ => drop(files.insert(folder().join(".x.7.skilltree-tmp"), Vec::new())),
            }
        }
        let memory = Arc::new(Memory::of(&files));
        let disk: Arc<dyn Disk> = memory.clone();
        Ok(experiment.run(&disk, &folder()).is_ok())
    };
    campaign("folders", make, read).conclude("folders");
}
