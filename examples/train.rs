//! Trains four docking robots and says how often each docks: `cargo run --release --example train`.

use skilltree::{BackendChoice, Experiment, Overrides, open_backend};
use std::ops::ControlFlow;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let overrides = Overrides { seeds: Some("0..4".into()), arms: vec!["taught-adam".into()], ..Overrides::default() };
    let experiment = Experiment::load("configs/docking.toml", &overrides)?;
    let mut backend = open_backend(BackendChoice::Auto)?;
    println!("{} learners on {}", experiment.learners(), backend.describe());
    let run = experiment.run("runs/example", backend.as_mut(), |progress| {
        eprint!("\r{} of {} trials", progress.finished, progress.trials);
        ControlFlow::Continue(())
    })?;
    eprintln!();
    let (_, rows) = run.evaluations()?;
    let last = rows.iter().map(|row| row.trials).max().unwrap_or(0);
    for seed in 0..4 {
        let own = rows.iter().filter(|row| row.seed == seed && row.trials == last);
        let (docked, trials) = own.fold((0, 0), |sum, row| (sum.0 + row.successes, sum.1 + row.episodes));
        println!("seed {seed}: docked in {docked} of {trials} test trials");
    }
    Ok(())
}
