//! The `skilltree` program: parse, run, print the error, exit code.

use clap::Parser;
use skilltree::cli::{Cli, tell};
use std::process::ExitCode;

fn main() -> ExitCode {
    // Mesa's device-select layer complains on stderr wherever there is no desktop session, and it only sorts
    // adapters, which this program does itself.
    // SAFETY: no other thread runs yet.
    unsafe { std::env::set_var("NODEVICE_SELECT", "1") };
    match skilltree::cli::run(Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            tell(&format!("error: {failure}"));
            ExitCode::from(failure.code())
        }
    }
}
