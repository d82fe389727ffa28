//! The whole benchmark, from the options to the [`Report`].

use super::BenchError;
use super::clock::Spread;
use super::executor::{Choice, Executor, Kind, open};
use super::limits::Meter;
use super::measure::Measured;
use super::result::{FORMAT, Origin, Report};
use super::tasks::{Decisions, Hierarchy, Learners, Replay, RobotSteps, Rule, Size, Task};
use super::workload::{HIERARCHY, ONE_POINT, THRESHOLDS};
use std::time::SystemTime;

/// Whole learners that a graphics card trains at a time, unless told otherwise.
const DEVICE_LEARNERS: u32 = 1024;

/// What to measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// On whom.
    pub choice: Choice,
    /// Samples of everything.
    pub samples: u32,
    /// Whole learners to train on each executor; 0 for none. As many as the CPU has cores, and a graphics card room,
    /// if not given.
    pub learners: Option<u32>,
    /// Sizes of the other kinds of work; chosen to suit the executors if not given.
    pub size: Option<Size>,
}

/// Measures everything. `note` is told what is being measured.
///
/// # Errors
/// [`BenchError::Differs`] where two executors leave different bytes; else where one fails.
pub fn run(options: Options, command: &str, note: &mut dyn FnMut(&str)) -> Result<Report, BenchError> {
    let started = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
    let (mut executors, mut left_out) = open(options.choice)?;
    let card = executors.iter().any(|executor| executor.about.kind == Kind::Gpu);
    let size = options.size.unwrap_or(if card { Size::DEVICE } else { Size::HOST });
    let host = options.learners.unwrap_or(std::thread::available_parallelism().map_or(1, |cores| cores.get() as u32));
    let device = options.learners.unwrap_or(if card { DEVICE_LEARNERS } else { 0 });
    let hierarchy = Hierarchy::new(HIERARCHY, &[], size.learners.max(host).max(device))?;
    let lean = if host > 0 { Some(Hierarchy::new(THRESHOLDS, &ONE_POINT, host.max(device))?) } else { None };
    let mut tasks: Vec<Box<dyn Task + '_>> = vec![
        Box::new(RobotSteps::new(size, 1)?),
        Box::new(RobotSteps::new(size, HELD)?),
        Box::new(Replay::new(size, Rule::Adam)?),
        Box::new(Replay::new(size, Rule::AdamRows)?),
        Box::new(Replay::new(size, Rule::Few)?),
        Box::new(Replay::new(size, Rule::Sgd)?),
        Box::new(Decisions::new(&hierarchy, size)),
    ];
    if let Some(lean) = &lean {
        tasks.push(Box::new(Learners::new("learners", &hierarchy, host, device)));
        tasks.push(Box::new(Learners::new("learners-lean", lean, host, device)));
        if executors.iter().any(|executor| executor.about.kind == Kind::SoftwareGpu) {
            left_out.push("learners on software adapters: they would take too long".to_owned());
        }
    }
    if executors.iter().any(|executor| matches!(executor.about.kind, Kind::Gpu | Kind::SoftwareGpu)) {
        left_out.push("limits of GPUs: only those of the CPU are measured".to_owned());
    }
    let measured = measure(&tasks, &mut executors, options.samples, note)?;
    Ok(Report {
        format: FORMAT,
        origin: origin(command, started),
        samples: options.samples,
        executors: executors.into_iter().map(|executor| executor.about).collect(),
        left_out,
        free_cores: Spread::of(measured.free_cores.iter().copied()).filter(|_| cores() > 1),
        limits: measured.limit_rates(),
        tasks: measured.tasks,
    })
}

/// Times that an action is carried out where the host is to be out of the way.
const HELD: u32 = 8;

fn measure(
    tasks: &[Box<dyn Task + '_>],
    executors: &mut [Executor],
    samples: u32,
    note: &mut dyn FnMut(&str),
) -> Result<Measured, BenchError> {
    let mut meter = Meter::default();
    let mut measured = Measured::new();
    for task in tasks {
        note(&format!("{}: {}", task.name(), task.about()));
        measured.add(task.as_ref(), executors, &mut meter, samples)?;
    }
    Ok(measured)
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Where and by what it is measured.
pub fn origin(command: &str, started: String) -> Origin {
    let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpu.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    Origin {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: option_env!("SKILLTREE_COMMIT").map(str::to_owned),
        command: command.to_owned(),
        started,
        cpu: model.map_or_else(|| "unknown CPU".to_owned(), |(_, name)| name.trim().to_owned()),
        cores: cores(),
        system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
    }
}
