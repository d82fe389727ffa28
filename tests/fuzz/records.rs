//! Files of run folders, each given to its reader as if no hash had been checked.

use super::campaign::campaign;
use super::within::folder;
use super::{experiment, file, files, mutate, somewhere};
use crate::memory::Memory;
use skilltree::backend::cpu::cpu_backend;
use skilltree::run_folder::file_system::FileSystem;
use skilltree::run_folder::manifest::Manifest;
use skilltree::run_folder::weights::read_weights;
use skilltree::run_folder::{Divergence, JsonFile, PlaceReading, Sweep, Trajectory};
use skilltree::train::batch::train;
use skilltree::train::checkpoint::Checkpoint;
use skilltree::train::codec::{encode, read};
use skilltree::train::result::LearnerResult;
use skilltree::train::run::RunError;
use snap::{read::FrameDecoder, write::FrameEncoder};
use std::io::{Read, Write};
use std::path::PathBuf;
use std::sync::Arc;

/// What the learners of the tiny experiment leave.
fn results() -> Vec<LearnerResult> {
    let experiment = experiment();
    let group = &experiment.groups[0];
    let mut backend = cpu_backend(1, None).unwrap();
    let ids = group.learners(&experiment.plan);
    train(&experiment.plan, group, &ids, &|_| None, None, &mut backend, &mut ()).unwrap()
}

fn bytes(results: &[LearnerResult]) -> Vec<u8> {
    encode(results).unwrap()
}

/// Half of the inputs are altered before they are compressed: checksums hold, and the reader behind them is reached.
fn compressed(random: &mut mutate::StepRandom, seeds: &[Vec<u8>]) -> Vec<u8> {
    if random.below(2) == 0 {
        return mutate::bytes(random, seeds);
    }
    let plain = |seed: &Vec<u8>| {
        let mut plain = Vec::new();
        FrameDecoder::new(&seed[..]).read_to_end(&mut plain).unwrap();
        plain
    };
    let mut compressed = FrameEncoder::new(Vec::new());
    compressed.write_all(&mutate::bytes(random, &seeds.iter().map(plain).collect::<Vec<_>>())).unwrap();
    compressed.into_inner().unwrap()
}

/// The content of a part: what is read is read again when it has been written.
#[test]
fn parts() {
    let seeds = [bytes(&results()), bytes(&results()[..1]), bytes(&[])];
    let decode = read::<Vec<LearnerResult>>;
    let read = |input: &[u8]| match decode(input) {
        // Results with NaN are equal to none: their bytes tell.
        Ok(results) if decode(&bytes(&results)).is_ok_and(|again| bytes(&again) == bytes(&results)) => Ok(true),
        Ok(_) => Err("is not what was read".to_owned()),
        Err(_) => Ok(false),
    };
    campaign("parts", |random| compressed(random, &seeds), read).conclude("parts");
}

/// A part whose frame vouches for nonsense: whoever goes on from there refuses it, or takes what can be taken.
#[test]
fn vouched_parts() {
    let seeds = [bytes(&results()), bytes(&results()[..1])];
    let experiment = experiment();
    let read = |input: &[u8]| {
        let disk: Arc<dyn FileSystem> = Arc::new(Memory::default());
        let mut run = experiment.open(&disk, &folder()).unwrap();
        run.commit_part("2-of-2_arm0-seed0_arm0-seed1", input).unwrap();
        drop(run);
        Ok(experiment.run(&disk, &folder()).is_ok())
    };
    campaign("vouched_parts", |random| compressed(random, &seeds), read).conclude("vouched_parts");
}

/// The content of a checkpoint, as if its frame vouched for it.
#[test]
fn checkpoints() {
    let experiment = experiment();
    let disk: Arc<dyn FileSystem> = Arc::new(Memory::default());
    assert!(matches!(experiment.stop(&disk, &folder()), Err(RunError::Stopped { .. })));
    let seed = experiment.open(&disk, &folder()).unwrap().read_checkpoint().unwrap();
    let seeds = [seed.expect("a checkpoint")];
    let read = |input: &[u8]| Ok(Checkpoint::read(input, &experiment.plan, &experiment.groups).is_ok());
    campaign("checkpoints", |random| compressed(random, &seeds), read).conclude("checkpoints");
}

#[test]
fn weights() {
    let seeds = [file("skills/taught-adam-0.safetensors"), file("skills/taught-adam-1.safetensors")];
    // The header is text behind eight bytes of length: half of the inputs have another text with the right length.
    let header = |seed: &[u8]| 8 + u64::from_le_bytes(seed[..8].try_into().unwrap()) as usize;
    let texts: Vec<Vec<u8>> = seeds.iter().map(|seed| seed[8..header(seed)].to_vec()).collect();
    let make = |random: &mut mutate::StepRandom| {
        if random.below(2) == 0 {
            return mutate::bytes(random, &seeds);
        }
        let text = mutate::text(random, &texts);
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
    assert!(Sweep::parse(sweep.as_bytes(), somewhere()).is_ok());
    let transition = r#"{"taught":true,"lesson":3,"mirrored":false,"step":2,"child":"move+12","record":[1,2],
        "inputs":[0.5],"q":[0.25,"NaN"],"target":"inf"}"#;
    let failures = format!(
        r#"[{{"arm":"a","point":0,"seed":1,"skill":"dock","trial":7,"what":"w","transition":{transition},"weight":null}}]"#
    );
    assert!(Vec::<Divergence>::parse(failures.as_bytes(), somewhere()).is_ok());
    let mut seeds = ["manifest.json", "places.json", "trajectories.json"].map(file).to_vec();
    seeds.extend([sweep.as_bytes().to_vec(), failures.into_bytes()]);
    let read = |input: &[u8]| {
        let manifest = Manifest::parse(input, somewhere()).is_ok();
        let places = Vec::<PlaceReading>::parse(input, somewhere()).is_ok();
        let sweep = Sweep::parse(input, somewhere()).is_ok();
        let failures = Vec::<Divergence>::parse(input, somewhere()).is_ok();
        Ok(manifest | places | sweep | failures | Vec::<Trajectory>::parse(input, somewhere()).is_ok())
    };
    campaign("json", |random| mutate::text(random, &seeds), read).conclude("json");
}

/// A run folder in which files were lost, altered or mixed up: opening it, and going on, is refused or works.
#[test]
fn folders() {
    let names: Vec<&PathBuf> = files().keys().collect();
    let contents: Vec<Vec<u8>> = files().values().cloned().collect();
    let experiment = experiment();
    let make = |random: &mut mutate::StepRandom| random.draw_step().to_le_bytes().to_vec();
    let read = |input: &[u8]| {
        let mut random = mutate::StepRandom::new(u64::from_le_bytes(input.try_into().unwrap()));
        let mut files = files().clone();
        if random.below(2) == 0 {
            files.remove(&folder().join("manifest.json"));
        }
        for _ in 0..=random.below(3) {
            let name = (*random.pick(&names)).clone();
            match random.below(4) {
                0 => drop(files.remove(&name)),
                1 => drop(files.insert(name, mutate::bytes(&mut random, &contents))),
                2 => drop(
                    files.insert(folder().join("parts/arm0-seed0_arm0-seed0"), mutate::bytes(&mut random, &contents)),
                ),
                _ => drop(files.insert(folder().join(".x.7.skilltree-tmp"), Vec::new())),
            }
        }
        let memory = Arc::new(Memory::of(&files));
        let disk: Arc<dyn FileSystem> = memory.clone();
        Ok(experiment.run(&disk, &folder()).is_ok())
    };
    campaign("folders", make, read).conclude("folders");
}
