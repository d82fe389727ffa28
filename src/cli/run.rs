//! `skilltree run`: trains, evaluates, records, reports.

use super::console::{print, tell};
use super::error::{CliError, exit_codes};
use super::progress::RunProgress;
use super::signals::Signals;
use super::{preview, report};
use crate::backend::open::BackendOptions;
use crate::config::Overrides;
use crate::experiment::Experiment;
use crate::run_folder::file_system::{FileSystem, OsFileSystem};
use crate::run_folder::{State, folder, tables};
use crate::train::batch_group::groups;
use crate::train::run::Options;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Trains, tests, records and reports an experiment. The same command again continues where an interrupted
/// run stopped, or says that the run is complete.
#[derive(Debug, clap::Args)]
#[command(after_help = concat!(
    "Examples:\n",
    "  skilltree run configs/quick.toml\n",
    "  skilltree run configs/docking.toml --seeds 0..256 --out runs/docking-256\n",
    "  skilltree run configs/docking.toml --set 'arms=[\"taught-adam\"]'\n",
    "  skilltree run configs/docking.toml --set learning.learning_rate=0.01 --out runs/fast\n",
    "  skilltree run configs/thresholds.toml --dry-run\n",
    "  skilltree run configs/sweep.toml --arm taught-adam --point 3 --seeds 1 --out runs/one\n\n",
    "No choice of backend, threads, cohort, iterations or checkpoints changes a byte of the results. A run can be stopped at ",
    "any time: Ctrl-C and SIGTERM save everything first, and the same command goes on. After a crash it goes on from the ",
    "last checkpoint.\n\n",
    exit_codes!()
))]
pub(super) struct RunArguments {
    /// The experiment: a TOML file.
    config: PathBuf,
    #[command(flatten)]
    overrides: Overrides,
    #[command(flatten)]
    backend: BackendOptions,
    /// Learners that train together and are saved together; chosen to suit the backend if not given.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    cohort: Option<u32>,
    /// Only says what would be run, what it would take and how long; writes nothing.
    #[arg(long)]
    dry_run: bool,
    /// Seconds between two checkpoints of the learners in training: what a crash may cost. Saving takes a tenth of the
    /// time at most, so that they may be further apart.
    #[arg(long, value_name = "SECONDS", default_value = "60", value_parser = seconds)]
    checkpoint: Duration,
    /// The run folder; `runs/NAME` if not given, with the config's name.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(super) fn run(arguments: &RunArguments) -> Result<(), CliError> {
    let experiment = Experiment::load(&arguments.config, &arguments.overrides)?;
    let plan = experiment.plan();
    let out = arguments.out.clone().unwrap_or_else(|| Path::new("runs").join(&plan.name));
    // A folder that is there is looked at first. A new one is made last: what is refused leaves nothing behind.
    let there = if arguments.dry_run || is_new(&out) { None } else { Some(experiment.open_folder(&out)?) };
    if there.as_ref().is_some_and(|folder| folder.state() == State::Complete) {
        drop(there);
        tell(&format!("{} is complete: nothing is left to run", out.display()));
        return conclude(&out);
    }
    let mut backend = arguments.backend.open(&mut |reason| {
        let reason = reason.to_string();
        tell(&format!("no exact GPU, so the CPU it is: {}", reason.lines().next().unwrap_or_default()));
    })?;
    let groups = groups(plan)?;
    let options =
        Options { cohort: arguments.cohort.map(|cohort| cohort as usize), checkpoint: Some(arguments.checkpoint) };
    let forecast = preview::show(plan, &groups, backend.as_mut(), options)?;
    tell(&format!("folder:   {}", out.display()));
    if arguments.dry_run {
        tell("nothing was run or written (--dry-run)");
        return Ok(());
    }
    let run_folder = match there {
        Some(folder) => folder,
        None => experiment.open_folder(&out)?,
    };
    if run_folder.state() == State::Partial {
        tell("          continued: what is finished there is kept");
    }
    let started = Instant::now();
    let signals = Signals::listen().map_err(CliError::Signals)?;
    let mut progress = RunProgress::new(forecast.learners, experiment.trials(), signals);
    let outcome = experiment.train(&groups, run_folder, backend.as_mut(), options, &mut progress);
    progress.finish();
    // From here on a signal ends the program: a report is soon made again.
    drop(progress);
    outcome?;
    tell(&format!("trained and tested in {:.1} s", started.elapsed().as_secs_f64()));
    conclude(&out)
}

/// Seconds, such as `60` or `0.5`.
fn seconds(text: &str) -> Result<Duration, String> {
    let seconds: f64 = text.parse().map_err(|_| format!("`{text}` is no number of seconds, such as 60 or 0.5"))?;
    match Duration::try_from_secs_f64(seconds) {
        Ok(duration) if (0.01..=86_400.0).contains(&seconds) => Ok(duration),
        _ => Err("from 0.01 to 86400 seconds are possible".to_owned()),
    }
}

/// Whether nothing is there yet: no folder, or an empty one.
fn is_new(out: &Path) -> bool {
    match OsFileSystem.list(out) {
        Ok(names) => names.is_empty(),
        Err(error) => error.kind() == ErrorKind::NotFound,
    }
}

/// Makes the report of a complete run and says where everything is.
fn conclude(out: &Path) -> Result<(), CliError> {
    let page = report::conclude(out)?;
    let mut lines = vec![
        ("tables:  ", tables::TRIALS),
        ("         ", tables::EVALUATIONS),
        ("nets:    ", "skills"),
        ("config:  ", folder::CONFIG),
    ];
    lines.extend(page.map(|page| ("report:  ", page)));
    let lines = lines.into_iter().map(|(label, name)| format!("{label}{}\n", out.join(name).display()));
    print(&lines.collect::<String>())
}
