//! Measures what the command-line program cannot: each kernel at several numbers of learners, with and without weights
//! in workgroup memory, time on the device apart from time on the host, and which shape of arithmetic differs. One JSON
//! object a line on stdout; exit code 1 where bytes differ.
//!
//! ```text
//! card shapes
//! card parity CONFIG LEARNERS default,not-held,one-in-flight,one-quantum
//! card steps ROBOTS,... ITERATIONS,...
//! card replay LEARNERS,... adam-32,rows-32,rows-16 cpu,held,not-held TRANSITIONS SECONDS
//! card learners LEARNERS,... PART SECONDS
//! ```

use skilltree::backend::Cohort;
use skilltree::backend::cpu::cpu_backend;
use skilltree::backend::gpu::conformance::{QUESTIONS, ShapeDifference, ask, differences, questions};
use skilltree::backend::gpu::{GpuBackend, GpuOptions, adapter, device::Device};
use skilltree::backend::host::HostBackend;
use skilltree::backend::parity;
use skilltree::bench::benchmarks::UpdateRule;
use skilltree::bench::embedded_configs::{ONE_POINT, THRESHOLDS, embedded_plan};
use skilltree::bench::robot_walk::RobotWalk;
use skilltree::bench::taught_replay::TaughtReplay;
use skilltree::train::batch::train;
use skilltree::train::batch_group::groups;
use skilltree::train::callbacks::{Callbacks, Interrupted, Signal};
use skilltree::train::parity::Work;
use skilltree::train::result::LearnerResult;
use skilltree::{Backend, Experiment, Overrides};
use std::time::{Duration, Instant};

fn gpu(held: Option<u32>, in_flight: Option<usize>, iterations: Option<u32>) -> GpuBackend {
    let options = GpuOptions { held, in_flight, iterations, ..GpuOptions::default() };
    GpuBackend::new(&options).unwrap_or_else(|error| panic!("no GPU backend: {error}"))
}

fn cpu() -> HostBackend {
    cpu_backend(0, None).unwrap_or_else(|error| panic!("no CPU backend: {error}"))
}

/// Functions and shapes of which some answer differs from Rust's.
fn shapes() -> bool {
    let (_instance, found) = adapter::adapters();
    let mut equal = true;
    for adapter in &found {
        let name = adapter.get_info().name;
        let device = Device::open(adapter).unwrap_or_else(|error| panic!("{error}"));
        let questions = questions(QUESTIONS);
        let answers = ask(&device, &questions).unwrap_or_else(|error| panic!("{error}"));
        for ShapeDifference { name: shape, count, wanted, found, .. } in differences(&questions, &answers) {
            equal = false;
            println!(
                "{{\"what\":\"shape\",\"adapter\":{name:?},\"shape\":{shape:?},\"differing\":{count},\"of\":{},\"wanted\":\"{wanted:#010x}\",\"found\":\"{found:#010x}\"}}",
                questions.len()
            );
        }
        println!("{{\"what\":\"shapes\",\"adapter\":{name:?},\"equal\":{equal}}}");
    }
    equal
}

/// The sample of `devices --parity` with one option after another: no result may depend on any.
fn parity(config: &str, learners: usize, variants: &str) -> bool {
    let experiment = Experiment::load(config, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
    let work = Work::new(experiment.plan(), learners).unwrap_or_else(|error| panic!("{error}"));
    let expected = work.run(&mut cpu()).unwrap_or_else(|error| panic!("{error}"));
    let mut equal = true;
    for (name, held, in_flight, quanta) in [
        ("default", None, None, None),
        ("not-held", Some(1), None, None),
        ("one-in-flight", None, Some(1), None),
        ("one-quantum", Some(1), None, Some(1)),
    ] {
        if !variants.split(',').any(|wanted| wanted == name) {
            continue;
        }
        let begun = Instant::now();
        let found = work.run(&mut gpu(held, in_flight, quanta));
        let (same, text) = match found {
            Ok(sample) => match expected.difference(&sample) {
                None => (true, format!("equal, {} bytes", expected.bytes())),
                Some(difference) => (false, difference.to_string()),
            },
            Err(error) => (false, error.to_string()),
        };
        equal &= same;
        println!(
            "{{\"what\":\"parity\",\"config\":{config:?},\"variant\":{name:?},\"equal\":{same},\"text\":{text:?},\"seconds\":{:.2}}}",
            begun.elapsed().as_secs_f64()
        );
    }
    equal
}

/// Kernel `step`: steps a second on the wall and on the device.
fn steps(robots: &[u32], quanta: &[u32]) {
    let mut device = gpu(None, None, None);
    for count in robots {
        for each in quanta {
            let mut walk = RobotWalk::new(*count).unwrap_or_else(|error| panic!("{error}"));
            let actions = walk.actions(0..4);
            let mut best = (0.0_f64, 0.0_f64);
            for _ in 0..3 {
                let (before, begun) = (device.traffic().spent, Instant::now());
                walk.advance(&mut device, &actions, *each).unwrap_or_else(|error| panic!("{error}"));
                let wall = begun.elapsed().as_secs_f64();
                let on_device = (device.traffic().spent - before).as_secs_f64();
                let done = f64::from(*count) * f64::from(*each) * actions.len() as f64;
                best = (best.0.max(done / wall), best.1.max(done / on_device));
            }
            println!(
                "{{\"what\":\"step\",\"robots\":{count},\"quanta\":{each},\"steps_per_s\":{:.4e},\"on_device\":{:.4e}}}",
                best.0, best.1
            );
        }
    }
}

/// Kernel `train`, replay alone.
fn replay(learners: &[u32], rules: &str, variants: &str, transitions: u64, deadline: Instant) -> bool {
    let mut equal = true;
    // One device each, so that a kernel is compiled once for each number of words held.
    let (mut holding, mut plain) = (None, None);
    for (name, rule) in ["adam-32", "rows-32", "rows-16"].into_iter().zip(UpdateRule::ALL) {
        if !rules.split(',').any(|wanted| wanted == name) {
            continue;
        }
        for count in learners {
            let passes = (transitions / (u64::from(*count) * 110)).clamp(2, 200);
            let plan = rule.plan(*count, passes as u32).unwrap_or_else(|error| panic!("{error}"));
            let taught = TaughtReplay::new(&plan).unwrap_or_else(|error| panic!("{error}"));
            let units = taught.transitions() * passes;
            let mut expected: Option<Cohort> = None;
            for variant in variants.split(',') {
                if Instant::now() > deadline {
                    println!(
                        "{{\"what\":\"replay\",\"rule\":{name:?},\"learners\":{count},\"who\":{variant:?},\"left_out\":\"no time\"}}"
                    );
                    continue;
                }
                let (mut on_device, mut first) = (None, 0.0);
                let (wall, loaded, held, found) = if variant == "cpu" {
                    let mut backend = cpu();
                    let (wall, loaded) = drilled(&taught, &mut backend);
                    (wall, loaded, 0, backend.memory().cloned())
                } else {
                    let backend = match variant {
                        "not-held" => plain.get_or_insert_with(|| gpu(Some(1), None, None)),
                        _ => holding.get_or_insert_with(|| gpu(None, None, None)),
                    };
                    // The governor finds its size in the first round, and the driver compiles.
                    let begun = Instant::now();
                    drilled(&taught, backend);
                    first = begun.elapsed().as_secs_f64();
                    let before = backend.traffic().spent;
                    let (wall, loaded) = drilled(&taught, backend);
                    on_device = Some((backend.traffic().spent - before).as_secs_f64());
                    let held = backend.held();
                    (wall, loaded, held, backend.memory().cloned())
                };
                let found = found.unwrap_or_else(|error| panic!("{error}"));
                let same = match &expected {
                    None => None,
                    Some(expected) => parity::advance(expected, &found).map_or(Some(true), |difference| {
                        eprintln!("{name}, {count} learners, {variant}: {difference}");
                        Some(false)
                    }),
                };
                equal &= same != Some(false);
                println!(
                    "{{\"what\":\"replay\",\"rule\":{name:?},\"learners\":{count},\"who\":{variant:?},\"held\":{held},\"transitions\":{units},\"per_s\":{:.4e},\"on_device\":{:.4e},\"load_s\":{loaded:.3},\"first_s\":{first:.2},\"same_as_first\":{}}}",
                    units as f64 / wall,
                    on_device.map_or(0.0, |seconds| units as f64 / seconds),
                    same.map_or("null".to_owned(), |same| same.to_string())
                );
                expected.get_or_insert(found);
            }
        }
    }
    equal
}

fn drilled(taught: &TaughtReplay, backend: &mut dyn Backend) -> (f64, f64) {
    let begun = Instant::now();
    backend.load(taught.cohort.clone()).unwrap_or_else(|error| panic!("{error}"));
    let loaded = begun.elapsed().as_secs_f64();
    let begun = Instant::now();
    TaughtReplay::replay(backend).unwrap_or_else(|error| panic!("{error}"));
    (begun.elapsed().as_secs_f64(), loaded)
}

/// Ends training when its time is over.
struct Limit(Instant, u64);

impl Callbacks for Limit {
    fn progress(&mut self, trials: u64) -> Signal {
        self.1 = trials;
        if Instant::now() > self.0 { Signal::Stop } else { Signal::Continue }
    }
}

/// Whole learners of the lean config with a share of their trials, so that it ends in time.
fn learners(counts: &[u32], part: u32, seconds: u64) {
    let mut card = None;
    for who in ["gpu", "cpu"] {
        for count in counts {
            // The CPU's rate hardly depends on how many there are.
            if who == "cpu" && *count != counts[0] {
                continue;
            }
            let trials = |whole: u32| (whole / part).max(1);
            let set = [
                "arms=[\"hierarchical\"]".to_owned(),
                "teacher.eval_episodes=1".to_owned(),
                "evaluate.episodes=8".to_owned(),
                "evaluate.at=[0]".to_owned(),
                "skill.recharge.eval_at=[0]".to_owned(),
                format!("skill.dock.trials={}", trials(300)),
                format!("skill.pass-door.trials={}", trials(450)),
                format!("skill.follow-right.trials={}", trials(350)),
                format!("skill.recharge.trials={}", trials(200)),
                ONE_POINT[0].to_owned(),
                ONE_POINT[1].to_owned(),
            ];
            let set: Vec<&str> = set.iter().map(String::as_str).collect();
            let plan = embedded_plan(THRESHOLDS, &set, *count).unwrap_or_else(|error| panic!("{error}"));
            let group = groups(&plan).unwrap_or_else(|error| panic!("{error}")).swap_remove(0);
            let ids = group.learners(&plan);
            let mut cores = cpu();
            let backend: &mut dyn Backend =
                if who == "gpu" { card.get_or_insert_with(|| gpu(None, None, None)) } else { &mut cores };
            let begun = Instant::now();
            let mut limit = Limit(begun + Duration::from_secs(seconds), 0);
            let done = train(&plan, &group, &ids, &|_| None, None, backend, &mut limit);
            let wall = begun.elapsed().as_secs_f64();
            let (updates, actions, ended) = match &done {
                Ok(results) => {
                    let actions =
                        |result: &LearnerResult| result.rows.chunks(8).map(|row| u64::from(row[2])).max().unwrap_or(0);
                    (
                        results.iter().map(|result| u64::from(result.updates)).sum::<u64>(),
                        results.iter().map(actions).sum(),
                        true,
                    )
                }
                Err(Interrupted::Stopped) => (0, 0, false),
                Err(error) => panic!("{error}"),
            };
            println!(
                "{{\"what\":\"learners\",\"who\":{who:?},\"learners\":{count},\"part\":{part},\"ended\":{ended},\"seconds\":{wall:.2},\"trials\":{},\"updates\":{updates},\"actions\":{actions},\"whole_learners_per_s\":{:.3e}}}",
                limit.1,
                if ended { f64::from(*count) / f64::from(part) / wall } else { 0.0 }
            );
        }
    }
}

fn numbers(text: &str) -> Vec<u32> {
    text.split(',').map(|text| text.parse().unwrap_or_else(|_| panic!("`{text}` is no number"))).collect()
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let of = |place: usize| args.get(place).unwrap_or_else(|| panic!("argument {place} is missing")).as_str();
    let number = |place: usize| of(place).parse::<u64>().unwrap_or_else(|_| panic!("argument {place} is no number"));
    let equal = match of(1) {
        "shapes" => shapes(),
        "parity" => parity(of(2), number(3) as usize, of(4)),
        "steps" => {
            steps(&numbers(of(2)), &numbers(of(3)));
            true
        }
        "replay" => {
            let deadline = Instant::now() + Duration::from_secs(number(6));
            replay(&numbers(of(2)), of(3), of(4), number(5), deadline)
        }
        "learners" => {
            learners(&numbers(of(2)), number(3) as u32, number(4));
            true
        }
        other => panic!("`{other}` is not known: shapes, parity, steps, replay, learners"),
    };
    std::process::exit(i32::from(!equal));
}
