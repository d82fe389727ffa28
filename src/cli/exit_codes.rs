//! What exit codes mean, in words.

/// The last line of every help text.
macro_rules! exit_codes {
    () => {
        "Exit codes: 0 done; 2 wrong usage or config; 75 give the same command again; 1 anything else."
    };
}
pub(super) use exit_codes;
