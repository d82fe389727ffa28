//! `cargo bench --bench kernels`: robot-steps and replayed transitions per CPU-second, the lanes beside a scalar
//! reference that does the same work on the same inputs.
//!
//! The results are compared as bytes before anything is timed. One thread each; the two are timed in turn,
//! and medians are printed.

mod learn;
mod simulate;

use bytemuck::cast_slice;
use skilltree::backend::cpu::CpuBackend;
use skilltree::backend::{Backend, Cohort, Stop};
use skilltree::config::{Overrides, load};
use skilltree::experiment::group::{Group, groups};
use skilltree::experiment::senses::{floor_only, robot_at};
use skilltree::learner::layout::{Robot, Settings};
use skilltree::learner::memory::Shared;
use skilltree::lesson::replay::taught_lesson;
use skilltree::math::rng::{below, philox};
use skilltree::skill::start::start_pose;
use std::path::Path;
use std::time::Instant;

const ROBOTS: usize = 4096;
const SAMPLES: usize = 7;
/// Calls of one timing.
const ROUNDS: u32 = 40;
/// Learners that replay; their nets together exceed every cache, as in a run.
const LEARNERS: usize = 64;
/// Passes over ten lessons in one timing.
const PASSES: u32 = 30;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let set = vec![
        "arms=[\"taught-adam\"]".to_owned(),
        "teacher.episodes=1".to_owned(),
        format!("learning.taught_passes={PASSES}"),
    ];
    let seeds = Some(format!("0..{LEARNERS}"));
    let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/docking.toml");
    let plan = load(&config, &Overrides { set, seeds, ..Overrides::default() })?;
    let group = groups(&plan)?.swap_remove(0);
    let mut backend = CpuBackend::new(1, Some(u32::MAX))?;
    println!("{}, {SAMPLES} samples in turn, medians", backend.describe());

    let shared = floor_only(plan.world());
    let mut lanes = robots(&group.shared, &plan.arms[0].noise);
    let mut scalar = lanes.clone();
    let mut walk = 0;
    let mut times = (Vec::new(), Vec::new());
    for _sample in 0..SAMPLES {
        times.0.push(timed(|| simulate_lanes(&mut backend, &shared, &mut lanes, walk))?);
        times.1.push(timed(|| simulate_scalar(&shared, &mut scalar, walk))?);
        walk += ROUNDS;
        same("robots", cast_slice(&lanes), cast_slice(&scalar))?;
    }
    show("robot-steps", f64::from(ROUNDS) * ROBOTS as f64, times);

    let cohort = group.cohort(&plan, &group.learners(&plan));
    let mut times = (Vec::new(), Vec::new());
    let mut transitions = 0;
    for _sample in 0..SAMPLES {
        let mut nets = reference_nets(&group, &cohort);
        backend.load(cohort.clone())?;
        times.0.push(timed(|| {
            backend.advance(Stop { skill: 0, trial: 0 })?;
            Ok(())
        })?);
        times.1.push(timed(|| {
            transitions = replay_scalar(&group, &cohort, &mut nets);
            Ok(())
        })?);
        let ours = reference_nets(&group, backend.memory()?);
        let bits = |nets: &[learn::Nets]| nets.iter().flat_map(learn::Nets::bits).collect::<Vec<_>>();
        same("nets", &bits(&ours), &bits(&nets))?;
    }
    show("replayed transitions", transitions as f64, times);
    Ok(())
}

/// Robots spread over the floor.
fn robots(shared: &Shared, noise: &skilltree::config::plan::Noise) -> Vec<Robot> {
    let skill = &shared.skills[0];
    let anywhere = skill.starts as usize - 1;
    let (offset, count) = (skill.start_offset[anywhere], skill.start_count[anywhere]);
    let pose = |number: u32| start_pose(&shared.atlas, offset, count, philox([number, 0, 0, 0], [1, 1]));
    (0..ROBOTS as u32).map(|number| robot_at(pose(number), noise, 1993, number)).collect()
}

/// The action of a robot at a step: any of the six.
fn action(number: usize, step: u32) -> u32 {
    below(philox([number as u32, step, 0, 0], [2, 2])[0], 6)
}

fn simulate_lanes(
    backend: &mut CpuBackend,
    shared: &Shared,
    robots: &mut [Robot],
    walk: u32,
) -> Result<(), Box<dyn std::error::Error>> {
    for round in walk..walk + ROUNDS {
        for (number, robot) in robots.iter_mut().enumerate() {
            (robot.action, robot.events) = (action(number, round), 0);
        }
        backend.step(shared, robots, 1)?;
    }
    Ok(())
}

fn simulate_scalar(shared: &Shared, robots: &mut [Robot], walk: u32) -> Result<(), Box<dyn std::error::Error>> {
    for round in walk..walk + ROUNDS {
        for (number, robot) in robots.iter_mut().enumerate() {
            robot.action = action(number, round);
            simulate::step(robot, &shared.floor.plan, &shared.atlas);
        }
    }
    Ok(())
}

fn settings_of(cohort: &Cohort, learner: usize) -> &Settings {
    &cohort.settings[learner * cohort.skills]
}

fn reference_nets(group: &Group, cohort: &Cohort) -> Vec<learn::Nets> {
    let words = cohort.nets.chunks(cohort.nets_stride);
    words.map(|words| learn::Nets::from_lanes(words, &group.shared.skills[0])).collect()
}

fn replay_scalar(group: &Group, cohort: &Cohort, nets: &mut [learn::Nets]) -> u64 {
    let shared = &group.shared;
    let skill = &shared.skills[0];
    let mut transitions = 0;
    for (number, nets) in nets.iter_mut().enumerate() {
        let settings = settings_of(cohort, number);
        for _pass in 0..PASSES {
            for lesson in 0..settings.lessons {
                let at = lesson_of(shared, settings, lesson);
                transitions += nets.replay(&shared.bank[at..], skill, settings, &shared.atlas);
            }
        }
    }
    transitions
}

/// Word of the bank at which a learner's taught lesson stands.
fn lesson_of(shared: &Shared, settings: &Settings, lesson: u32) -> usize {
    use skilltree::learner::layout::Cursor;
    use skilltree::learner::memory::Learner;
    let mut cursor: Cursor = bytemuck::Zeroable::zeroed();
    let settings = std::slice::from_ref(settings);
    let learner = Learner { shared, settings, cursor: &mut cursor, nets: &mut [], lessons: &mut [], rows: &mut [] };
    taught_lesson(&learner, lesson) as usize
}

fn same(what: &str, ours: &[u32], reference: &[u32]) -> Result<(), Box<dyn std::error::Error>> {
    match ours.iter().zip(reference).position(|(a, b)| a != b) {
        None if ours.len() == reference.len() => Ok(()),
        place => Err(format!("{what} differ from the scalar reference at word {place:?}: nothing is timed").into()),
    }
}

/// CPU-seconds of a call; wall time where the system does not tell.
fn timed(call: impl FnOnce() -> Result<(), Box<dyn std::error::Error>>) -> Result<f64, Box<dyn std::error::Error>> {
    let (before, wall) = (cpu_seconds(), Instant::now());
    call()?;
    Ok(match (before, cpu_seconds()) {
        (Some(before), Some(after)) => after - before,
        _ => wall.elapsed().as_secs_f64(),
    })
}

/// CPU time of all threads of this process.
fn cpu_seconds() -> Option<f64> {
    let mut nanoseconds = 0;
    for task in std::fs::read_dir("/proc/self/task").ok()? {
        let text = std::fs::read_to_string(task.ok()?.path().join("schedstat")).ok()?;
        nanoseconds += text.split(' ').next()?.parse::<u64>().ok()?;
    }
    Some(nanoseconds as f64 * 1e-9)
}

fn show(what: &str, count: f64, (mut lanes, mut scalar): (Vec<f64>, Vec<f64>)) {
    let median = |times: &mut Vec<f64>| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    };
    let (lanes, scalar) = (median(&mut lanes), median(&mut scalar));
    println!(
        "{what:<22} lanes {:>7.3} M per CPU-s   scalar reference {:>7.3} M per CPU-s   ratio {:.1}",
        count / lanes * 1e-6,
        count / scalar * 1e-6,
        scalar / lanes
    );
}
