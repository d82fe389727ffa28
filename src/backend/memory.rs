//! How much memory is free, and how many learners it holds.

use super::BackendError;

/// Bytes of memory that are free on this machine, or less where a control group allows less. Known on Linux only;
/// elsewhere backends rely on their own limits, and allocation may fail.
pub fn free() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("MemAvailable:"))?;
    let kibibytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    let left = allowance().unwrap_or(u64::MAX);
    Some((kibibytes << 10).min(left))
}

/// What the control group of this process (version 2) still allows, if it sets a limit.
fn allowance() -> Option<u64> {
    let number = |name: &str| -> Option<u64> {
        std::fs::read_to_string(format!("/sys/fs/cgroup/{name}")).ok()?.trim().parse().ok()
    };
    Some(number("memory.max")?.saturating_sub(number("memory.current")?))
}

/// Learners that fit a share of the free memory, at most `most`, if each takes `bytes_per_learner`.
///
/// # Errors
/// [`BackendError::NoRoom`] if not even one fits.
pub fn fitting(free: Option<u64>, share: f64, bytes_per_learner: usize, most: usize) -> Result<usize, BackendError> {
    let Some(free) = free else { return Ok(most) };
    let room = (free as f64 * share) as u64;
    match room / bytes_per_learner.max(1) as u64 {
        0 => Err(BackendError::NoRoom { bytes: bytes_per_learner as u64, room }),
        learners => Ok(usize::try_from(learners).unwrap_or(usize::MAX).min(most)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cohort_fits_the_memory_or_is_refused() {
        let fitting = |free, bytes| fitting(free, 0.5, bytes, 32).map_err(|error| error.to_string());
        assert_eq!(fitting(Some(1000), 10), Ok(32));
        assert_eq!(fitting(Some(1000), 100), Ok(5));
        assert_eq!(fitting(Some(1000), 500), Ok(1));
        assert_eq!(fitting(None, usize::MAX), Ok(32));
        let refused = fitting(Some(100 << 20), 51 << 20).expect_err("half of the memory is too little");
        assert!(refused.contains("53.5 MB") && refused.contains("52.4 MB"), "{refused}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn this_machine_has_memory() {
        let free = free().expect("Linux tells");
        assert!((1 << 20..1 << 50).contains(&free), "{free}");
    }
}
