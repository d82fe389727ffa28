//! `cargo bench`: the same as `skilltree bench`, built in the profile of benchmarks. Words after `--` are its options.

use clap::Parser;
use skilltree::cli::{Cli, tell};
use std::process::ExitCode;

fn main() -> ExitCode {
    // Cargo adds a word of its own.
    let words = std::env::args().skip(1).filter(|word| word != "--bench");
    match skilltree::cli::run(Cli::parse_from(["skilltree".to_owned(), "bench".to_owned()].into_iter().chain(words))) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            tell(&format!("error: {failure}"));
            ExitCode::from(failure.code())
        }
    }
}
