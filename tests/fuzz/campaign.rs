//! One reader under fire: inputs until the time is over, and what went wrong.
//!
//! `SKILLTREE_FUZZ_SECONDS` is the time for each reader, 2 if not set. Input number N is the same in every run: a
//! finding's number, given as `SKILLTREE_FUZZ_FROM` with a short time, brings it back.

use super::meter::{Execution, executed, watch};
use super::mutate::StepRandom;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// An execution beyond this hangs.
const PATIENCE: Duration = Duration::from_secs(1);
/// An execution beyond this may never end: the process ends and names it. A busy machine is no excuse.
const END_OF_PATIENCE: Duration = Duration::from_secs(600);
/// What a reader may hold beside four times its input.
const MEMORY: usize = 64 << 20;
/// Different findings after which a campaign stops.
const ENOUGH: usize = 20;

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |text| text.parse().unwrap_or_else(|_| panic!("{name}={text}: not a number")))
}

/// How a campaign went.
#[derive(Debug, Default)]
pub(crate) struct Campaign {
    inputs: u64,
    accepted: u64,
    slowest: Duration,
    most: usize,
    /// First number of each kind of finding.
    pub(crate) findings: BTreeMap<String, u64>,
}

impl Campaign {
    /// The end of every test of a reader: it took some inputs, refused others, and nothing was found.
    pub(crate) fn conclude(self, name: &str) {
        let Self { inputs, accepted, slowest, most, findings } = self;
        let slowest = slowest.as_secs_f64() * 1e3;
        let most = most as f64 / 1e6;
        eprintln!(
            "{name}: {inputs} inputs, {accepted} accepted, \
             slowest {slowest:.1} ms, most memory {most:.2} MB, {} findings",
            findings.len()
        );
        assert!(findings.is_empty(), "{name}: {findings:#?}");
        assert!(0 < accepted && accepted < inputs, "{name}: of {inputs} inputs {accepted} were accepted");
    }
}

/// Executes `read` on inputs of `make` until the time is over. `read` says whether it accepted the input, or what is
/// wrong with what it gave.
pub(crate) fn campaign(
    name: &str,
    mut make: impl FnMut(&mut StepRandom) -> Vec<u8>,
    mut read: impl FnMut(&[u8]) -> Result<bool, String>,
) -> Campaign {
    let until = Instant::now() + Duration::from_secs(setting("SKILLTREE_FUZZ_SECONDS", 2));
    let first = setting("SKILLTREE_FUZZ_FROM", 0);
    let (current, over) = (AtomicU64::new(first), AtomicBool::new(false));
    std::thread::scope(|scope| {
        scope.spawn(|| guard(name, &current, &over));
        let mut campaign = Campaign::default();
        for number in first.. {
            if Instant::now() > until || campaign.findings.len() >= ENOUGH {
                break;
            }
            current.store(number, Ordering::Relaxed);
            let input = make(&mut StepRandom::new(number));
            if let Some(finding) = campaign.execute(number, &input, &mut read) {
                if !campaign.findings.contains_key(&finding) {
                    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fuzz-{name}-{number}"));
                    std::fs::write(&file, &input).unwrap();
                    eprintln!("{name}: input {number}, kept as {}: {finding}", file.display());
                }
                campaign.findings.entry(finding).or_insert(number);
            }
        }
        over.store(true, Ordering::Relaxed);
        campaign
    })
}

impl Campaign {
    fn execute(
        &mut self,
        number: u64,
        input: &[u8],
        read: &mut impl FnMut(&[u8]) -> Result<bool, String>,
    ) -> Option<String> {
        let Execution { outcome, bytes, mut time } = watch(number, || read(input));
        self.inputs += 1;
        self.most = self.most.max(bytes);
        let accepted = match outcome {
            Err(panic) => return Some(format!("panic: {panic}")),
            Ok(Err(wrong)) => return Some(wrong),
            Ok(Ok(accepted)) => accepted,
        };
        self.accepted += u64::from(accepted);
        if time > PATIENCE {
            // Once more, now without the time in which the thread waited for its turn.
            let before = executed();
            let again = watch(number, || read(input)).time;
            let busy = executed().zip(before).map_or(again, |(after, before)| after - before);
            time = time.min(again).min(busy);
        }
        self.slowest = self.slowest.max(time);
        if time > PATIENCE {
            return Some(format!("hangs: more than {} s", PATIENCE.as_secs()));
        }
        (bytes > MEMORY + 4 * input.len()).then(|| format!("memory: more than {} MB", MEMORY >> 20))
    }
}

/// Ends the process, with the number of the input, where an execution does not end by itself.
fn guard(name: &str, current: &AtomicU64, over: &AtomicBool) {
    let (mut seen, mut since) = (u64::MAX, Instant::now());
    while !over.load(Ordering::Relaxed) {
        std::thread::sleep(Duration::from_millis(20));
        let number = current.load(Ordering::Relaxed);
        if number != seen {
            (seen, since) = (number, Instant::now());
        } else if since.elapsed() > END_OF_PATIENCE {
            eprintln!("{name}: input {number} does not end");
            std::process::abort();
        }
    }
}
