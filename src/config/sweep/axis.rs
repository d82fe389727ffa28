//! One axis: a key, and the values that it takes.

use super::allowed_keys::{allowed, is_inner};
use crate::config::keys::Allowed;
use crate::config::plan::Scale;
use crate::toml::document::{KeyValue, Node, SourceSpan, Value};
use crate::toml::error::ConfigError;
use crate::toml::reader::Item;

/// Most points of a sweep, and most values of an axis.
pub(super) const MAX_POINTS: usize = 1 << 16;
const SHAPE: &str = "write [a, b, c], or { from = a, to = b, steps = n }, with scale = \"log\" if wanted";
/// Digits that computed values are rounded to: 0.1 + 2 * 0.1 is written as 0.3, and f32 holds no more than 8.
const DIGITS: usize = 9;

/// A key of the config that differs between points.
#[derive(Debug)]
pub(super) struct AxisSource<'a> {
    /// Dotted path.
    pub(super) key: String,
    /// Its parts.
    pub(super) path: Vec<String>,
    pub(super) label: String,
    pub(super) scale: Scale,
    /// The distinct values; none yet where they are still to be drawn.
    pub(super) values: Vec<Node>,
    /// The range from which they are to be drawn.
    pub(super) range: Option<Range>,
    /// Where it is written.
    pub(super) item: Item<'a>,
}

/// From where to where an axis reaches.
#[derive(Debug, Clone, Copy)]
pub(super) struct Range {
    from: f64,
    to: f64,
    log: bool,
    whole: bool,
}

/// Finds the axes at and below an entry whose table has the path `above`.
pub(super) fn collect<'a>(
    entry: &'a KeyValue,
    item: &Item<'a>,
    above: &[&str],
    skills: &[&str],
    axes: &mut Vec<AxisSource<'a>>,
) -> Result<(), ConfigError> {
    let mut path = above.to_vec();
    path.push(&entry.key);
    if matches!(item.node.value, Value::Table(_)) && is_inner(&path) && !item.node.is_axis() {
        for (entry, item) in item.table()?.all() {
            collect(entry, &item, &path, skills, axes)?;
        }
        return Ok(());
    }
    let allowed = allowed(&path, skills, &entry.origin)?;
    axes.push(read(path.iter().map(|part| (*part).to_owned()).collect(), item, allowed)?);
    Ok(())
}

fn read<'a>(path: Vec<String>, item: &Item<'a>, allowed: Allowed) -> Result<AxisSource<'a>, ConfigError> {
    let key = path.join(".");
    let mut axis = AxisSource {
        label: key.clone(),
        key,
        path,
        scale: Scale::List,
        values: Vec::new(),
        range: None,
        item: item.clone(),
    };
    match &item.node.value {
        Value::List(_) => axis.values = listed(item)?,
        Value::Table(_) => axis.spread(item, allowed)?,
        _ => {
            let message = format!("`{}` must be values, not {}", item.name, item.node.kind());
            return Err(item.error(message, SHAPE));
        }
    }
    Ok(axis)
}

impl AxisSource<'_> {
    /// Reads `{ values = [...] }` or `{ from, to, steps, scale }`, either with a label.
    fn spread(&mut self, item: &Item<'_>, allowed: Allowed) -> Result<(), ConfigError> {
        let table = item.table()?;
        if let Some(label) = table.optional("label") {
            self.label = label.text()?.to_owned();
        }
        if let Some(values) = table.optional("values") {
            self.values = listed(&values)?;
            return table.finish();
        }
        let whole = match allowed {
            Allowed::Whole(..) => true,
            Allowed::Number(_) => false,
            _ => {
                let message = format!("`{}` takes no range: it is {allowed}", self.key);
                return Err(item.error(message, "list the values: [a, b, c]"));
            }
        };
        let end = |name: &str| {
            let end = table.required(name, "0.1")?;
            match allowed {
                Allowed::Whole(low, high) => end.whole(low, high).map(f64::from),
                Allowed::Number(bounds) => end.double(bounds),
                _ => Ok(0.0),
            }
        };
        let (from, to) = (end("from")?, end("to")?);
        if from >= to {
            let message = format!("`{}` reaches from {from} to {to}", item.name);
            return Err(item.error(message, "`from` must be less than `to`"));
        }
        let scale = table.optional("scale").map(|scale| scale.choice("scales", &["linear", "log"])).transpose()?;
        let log = scale == Some(1);
        if log && from <= 0.0 {
            let hint = "a logarithmic axis begins above 0; raise `from`, or drop `scale`";
            return Err(item.error(format!("`{}` begins at {from}", item.name), hint));
        }
        let steps = table.optional("steps").map(|steps| steps.whole(2, MAX_POINTS as u32)).transpose()?;
        table.finish()?;
        let range = Range { from, to, log, whole };
        self.scale = if log { Scale::Log } else { Scale::Linear };
        self.range = Some(range);
        if let Some(steps) = steps {
            let share = |step| f64::from(step) / f64::from(steps - 1);
            self.values = (0..steps).map(|step| range.value(share(step), item.origin())).collect();
            if let Some(pair) = self.values.windows(2).find(|pair| same(&pair[0], &pair[1])) {
                let message = format!("`{}` takes the value {} twice", item.name, shown(&pair[0]));
                return Err(item.error(message, "take fewer steps"));
            }
        }
        Ok(())
    }
}

impl Range {
    /// The value at a share of the way, 0 to 1.
    pub(super) fn value(&self, share: f64, origin: &SourceSpan) -> Node {
        let Self { from, to, log, whole } = *self;
        // The library's functions give the same bits on every host.
        let exact = if log {
            libm::exp(libm::log(from) + (libm::log(to) - libm::log(from)) * share)
        } else {
            from + (to - from) * share
        };
        let value = if whole {
            Value::Integer(exact.clamp(from, to).round() as i64)
        } else {
            Value::Float(rounded(exact).clamp(from, to))
        };
        Node { value, origin: origin.clone() }
    }
}

/// A number to few enough digits that it can be read.
fn rounded(value: f64) -> f64 {
    format!("{value:.0$e}", DIGITS - 1).parse().unwrap_or(value)
}

/// The values of a list: numbers, words, true and false.
fn listed(item: &Item<'_>) -> Result<Vec<Node>, ConfigError> {
    let mut values: Vec<Node> = Vec::new();
    for one in item.items()? {
        if matches!(one.node.value, Value::List(_) | Value::Table(_)) {
            let message = format!("`{}` is {}, which cannot be a value on an axis", one.name, one.node.kind());
            return Err(one.error(message, "use numbers, words, true or false; give arms for anything else"));
        }
        if values.iter().any(|value| same(value, one.node)) {
            return Err(one.error(format!("the value {} is there twice", shown(one.node)), "name each once"));
        }
        values.push(one.node.clone());
    }
    if values.is_empty() {
        return Err(item.error(format!("`{}` is empty", item.name), SHAPE));
    }
    if values.len() > MAX_POINTS {
        return Err(
            item.error(format!("`{}` has {} values", item.name, values.len()), format!("at most {MAX_POINTS} fit"))
        );
    }
    Ok(values)
}

/// Whether two values are the same to a reader of the config.
pub(super) fn same(a: &Node, b: &Node) -> bool {
    match (&a.value, &b.value) {
        (Value::Text(a), Value::Text(b)) => a == b,
        (Value::Flag(a), Value::Flag(b)) => a == b,
        _ => number(a).is_some() && number(a) == number(b),
    }
}

/// A value as a number, if it is one.
pub(super) fn number(node: &Node) -> Option<f64> {
    match node.value {
        Value::Float(value) => Some(value),
        Value::Integer(value) => Some(value as f64),
        _ => None,
    }
}

fn shown(node: &Node) -> String {
    match &node.value {
        Value::Text(text) => format!("`{text}`"),
        Value::Flag(flag) => flag.to_string(),
        _ => number(node).map_or_else(String::new, |number| number.to_string()),
    }
}
