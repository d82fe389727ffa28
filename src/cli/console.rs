//! Results go to standard output, everything else to standard error; neither ever makes the program panic.

use super::error::CliError;
use std::io::{ErrorKind, Write, stderr, stdout};

/// Prints results. A reader that has seen enough, such as `head`, is no error.
pub(super) fn print(text: &str) -> Result<(), CliError> {
    let mut out = stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(CliError::Output(error)),
        _ => Ok(()),
    }
}

/// Tells the user something on a line of its own. There is nobody to tell if that fails.
pub fn tell(text: &str) {
    let _ = writeln!(stderr(), "{text}");
}

/// `1 seed`, `2 seeds`.
pub(super) fn count(number: usize, what: &str) -> String {
    if number == 1 { format!("1 {what}") } else { format!("{number} {what}s") }
}
