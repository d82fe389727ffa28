//! Lists of seeds, as typed.

use crate::toml::document::{SourceSpan, Value};
use crate::toml::error::ConfigError;
use crate::toml::reader::Item;

/// Most seeds of one run. Each is a learner per arm.
const MAX_SEEDS: usize = 1 << 20;
const SHAPE: &str = "write ranges such as 0..7 (7 left out), 0..=6, 5 or 1,2,5..9";

/// Reads `0..7`, `0..=6`, `5` or `1,2,5..9`, as given to `--seeds`: ascending, without repeats.
pub fn parse_seeds(text: &str) -> Result<Vec<u32>, ConfigError> {
    ranges(text, &argument(text))
}

/// The option on the command line.
pub(super) fn argument(text: &str) -> SourceSpan {
    SourceSpan::Argument(format!("--seeds {text}"))
}

/// Reads the value of the key `seeds`: text as above, or a list of whole numbers.
pub(super) fn read(item: &Item<'_>) -> Result<Vec<u32>, ConfigError> {
    match &item.node.value {
        Value::Text(text) => ranges(text, item.origin()),
        Value::Integer(_) => Ok(vec![item.whole(0, u32::MAX)?]),
        Value::List(_) => {
            let seeds = item.items()?.iter().map(|seed| seed.whole(0, u32::MAX)).collect::<Result<_, _>>()?;
            distinct(seeds, item.origin())
        }
        _ => Err(item.error(format!("`seeds` must be text or a list, not {}", item.node.kind()), SHAPE)),
    }
}

fn ranges(text: &str, origin: &SourceSpan) -> Result<Vec<u32>, ConfigError> {
    let number = |part: &str| -> Result<u64, ConfigError> {
        let part = part.trim();
        // Rust would read `+5`.
        let number = if part.starts_with('+') { None } else { part.parse::<u32>().ok() };
        let wrong = || origin.error(format!("`{part}` is not a seed"), format!("{SHAPE}; seeds are 0 to {}", u32::MAX));
        number.map(u64::from).ok_or_else(wrong)
    };
    let mut seeds = Vec::new();
    for part in text.split(',') {
        let (first, last) = match part.split_once("..") {
            None => (number(part)?, number(part)? + 1),
            Some((first, last)) => match last.strip_prefix('=') {
                Some(last) => (number(first)?, number(last)? + 1),
                None => (number(first)?, number(last)?),
            },
        };
        if last <= first {
            let hint = "the end is left out, as in 0..7 for 0 to 6, and must come after the start";
            return Err(origin.error(format!("the range `{}` holds no seed", part.trim()), hint));
        }
        if last - first > (MAX_SEEDS - seeds.len()) as u64 {
            return Err(
                origin.error(format!("`{text}` holds too many seeds"), format!("at most {MAX_SEEDS} are possible"))
            );
        }
        // Both ends stem from u32; the loop stops before `last`.
        seeds.extend((first..last).map(|seed| seed as u32));
    }
    distinct(seeds, origin)
}

fn distinct(mut seeds: Vec<u32>, origin: &SourceSpan) -> Result<Vec<u32>, ConfigError> {
    seeds.sort_unstable();
    if let Some(pair) = seeds.windows(2).find(|pair| pair[0] == pair[1]) {
        let hint = "the same seed gives the same learner; name each once";
        return Err(origin.error(format!("the seed {} is there twice", pair[0]), hint));
    }
    if seeds.is_empty() {
        return Err(origin.error("there are no seeds", SHAPE));
    }
    Ok(seeds)
}
