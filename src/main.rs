//! The `skilltree` program: parse, run, print the error, exit code.

use clap::Parser;
use skilltree::cli::Cli;
use std::process::ExitCode;

fn main() -> ExitCode {
    match skilltree::cli::run(Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::from(failure.code())
        }
    }
}
