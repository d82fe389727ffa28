//! Lists of seeds, as typed.

use crate::toml::document::Value;
use crate::toml::error::{ConfigError, Place};
use crate::toml::reader::Item;

/// Most seeds of one run. Each is a learner per arm.
const MAX_SEEDS: usize = 1 << 20;
const SHAPE: &str = "write ranges such as 0..7 (7 left out), 0..=6, 5 or 1,2,5..9";

/// Reads `0..7`, `0..=6`, `5` or `1,2,5..9`, as given to `--seeds`: ascending, without repeats.
pub fn parse_seeds(text: &str) -> Result<Vec<u32>, ConfigError> {
    ranges(text).map_err(|(message, hint)| ConfigError::new(Place::Argument(argument(text)), message, hint))
}

/// How the option looks on the command line.
pub(super) fn argument(text: &str) -> String {
    format!("--seeds {text}")
}

/// Reads the value of the key `seeds`: text as above, or a list of whole numbers.
pub(super) fn read(item: &Item<'_>) -> Result<Vec<u32>, ConfigError> {
    let at = |(message, hint): (String, String)| item.error(message, hint);
    match &item.node.value {
        Value::Text(text) => ranges(text).map_err(at),
        Value::Integer(_) => Ok(vec![item.whole(0, u32::MAX)?]),
        Value::List(_) => {
            let seeds = item.items()?.iter().map(|seed| seed.whole(0, u32::MAX)).collect::<Result<_, _>>()?;
            distinct(seeds).map_err(at)
        }
        _ => Err(item.error(format!("`seeds` must be text or a list, not {}", item.node.kind()), SHAPE)),
    }
}

fn ranges(text: &str) -> Result<Vec<u32>, (String, String)> {
    let number = |part: &str| -> Result<u32, (String, String)> {
        let wrong = || (format!("`{}` is not a seed", part.trim()), format!("{SHAPE}; seeds are 0 to {}", u32::MAX));
        if part.trim().starts_with('+') { Err(wrong()) } else { part.trim().parse().map_err(|_| wrong()) }
    };
    let mut seeds = Vec::new();
    for part in text.split(',') {
        let (first, last) = match part.split_once("..") {
            None => (u64::from(number(part)?), u64::from(number(part)?) + 1),
            Some((first, last)) => match last.strip_prefix('=') {
                Some(last) => (u64::from(number(first)?), u64::from(number(last)?) + 1),
                None => (u64::from(number(first)?), u64::from(number(last)?)),
            },
        };
        if last <= first {
            let hint = "the end is left out, as in 0..7 for 0 to 6, and must come after the start";
            return Err((format!("the range `{}` holds no seed", part.trim()), hint.to_owned()));
        }
        if last - first > (MAX_SEEDS - seeds.len()) as u64 {
            return Err((format!("`{text}` holds too many seeds"), format!("at most {MAX_SEEDS} are possible")));
        }
        // Both ends stem from u32; the loop stops before `last`.
        seeds.extend((first..last).map(|seed| seed as u32));
    }
    distinct(seeds)
}

fn distinct(mut seeds: Vec<u32>) -> Result<Vec<u32>, (String, String)> {
    seeds.sort_unstable();
    if let Some(pair) = seeds.windows(2).find(|pair| pair[0] == pair[1]) {
        let hint = "the same seed gives the same learner; name each once";
        return Err((format!("the seed {} is there twice", pair[0]), hint.to_owned()));
    }
    if seeds.is_empty() {
        return Err(("there are no seeds".to_owned(), SHAPE.to_owned()));
    }
    Ok(seeds)
}
