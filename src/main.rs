//! The `skilltree` program: parse, run, print the error, exit code.

use clap::Parser;
use skilltree::cli::{Cli, tell};
use std::process::ExitCode;

fn main() -> ExitCode {
    match skilltree::cli::run(Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            tell(&format!("error: {failure}"));
            ExitCode::from(failure.code())
        }
    }
}
