//! Numbers as figures, the page and the terminal print them, and the templates' filters of the same names.

use super::statistics::{Estimate, SurvivalCurve};
use minijinja::value::{Object, Value};
use minijinja::{Environment, Error, ErrorKind};
use std::sync::Arc;

/// A number for people: thousands apart, no needless digits.
pub fn number(value: f64) -> String {
    if value.abs() < 1000.0 {
        let text = format!("{value:.3}");
        return text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    let digits = format!("{:.0}", value.abs());
    let mut text = String::from(if value < 0.0 { "-" } else { "" });
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i) % 3 == 0 {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// `1 seed`, `7 seeds`.
pub fn seeds(count: usize) -> String {
    if count == 1 { "1 seed".into() } else { format!("{} seeds", number(count as f64)) }
}

/// A limit in percent, without needless digits.
pub fn limit(share: f64) -> String {
    format!("{}%", number(100.0 * share))
}

/// `0.123` as `12.3%`.
pub fn percent(share: f64) -> String {
    format!("{:.1}%", 100.0 * share)
}

/// A share with its interval: `12.3% [10.1, 14.5]`.
pub fn share(estimate: Estimate) -> String {
    let Estimate { value, low, high } = estimate;
    format!("{} [{:.1}, {:.1}]", percent(value), 100.0 * low, 100.0 * high)
}

/// A difference of two shares in percentage points, with signs.
pub fn points(estimate: Estimate) -> String {
    // Adding 0 makes of a rounded -0 a 0.
    let points = |share: f64| (1000.0 * share).round() / 10.0 + 0.0;
    format!("{:+.1} [{:+.1}, {:+.1}]", points(estimate.value), points(estimate.low), points(estimate.high))
}

/// A value with its interval.
pub fn fixed(estimate: Estimate, digits: usize) -> String {
    format!("{:.digits$} [{:.digits$}, {:.digits$}]", estimate.value, estimate.low, estimate.high)
}

/// A difference with its interval.
pub fn signed(estimate: Estimate, digits: usize) -> String {
    format!("{:+.digits$} [{:+.digits$}, {:+.digits$}]", estimate.value, estimate.low, estimate.high)
}

/// Trials by which a share of the learners got there; more than all trials if fewer ever did.
pub fn trials_by(seen: &SurvivalCurve, time: Option<f64>) -> String {
    time.map_or_else(|| format!("more than {}", number(seen.end)), number)
}

/// Trials by which half of the learners got there, with interval: `240 [200, more than 300]`.
pub fn median_trials(seen: &SurvivalCurve) -> String {
    let (low, high) = seen.quantile_interval(0.5);
    if low.is_none() {
        return trials_by(seen, None);
    }
    let [median, low, high] = [seen.quantile(0.5), low, high].map(|time| trials_by(seen, time));
    format!("{median} [{low}, {high}]")
}

/// A name as part of a file name: what could mislead a file system becomes `-`.
pub fn file_word(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || matches!(c, '-' | '_' | '+') { c } else { '-' }).collect()
}

/// Templates see an estimate's parts.
impl Object for Estimate {
    fn get_value(self: &Arc<Self>, key: &Value) -> Option<Value> {
        match key.as_str()? {
            "value" => Some(self.value.into()),
            "low" => Some(self.low.into()),
            "high" => Some(self.high.into()),
            _ => None,
        }
    }
}

impl From<Estimate> for Value {
    fn from(estimate: Estimate) -> Self {
        Self::from_object(estimate)
    }
}

/// Formats a number by one function and an estimate by another one.
fn either(
    value: &Value,
    bare: impl Fn(f64) -> String,
    with_interval: impl Fn(Estimate) -> String,
) -> Result<String, Error> {
    match value.downcast_object_ref::<Estimate>() {
        Some(estimate) if estimate.value.is_nan() => Ok("no tests".to_owned()),
        Some(estimate) => Ok(with_interval(*estimate)),
        None => match f64::try_from(value.clone()) {
            Ok(number) if number.is_nan() => Ok("no tests".to_owned()),
            Ok(number) => Ok(bare(number)),
            Err(_) => Err(Error::new(ErrorKind::InvalidOperation, format!("`{value}` is no number"))),
        },
    }
}

/// Text in which names stand between backticks, as HTML.
fn code(text: &str) -> Value {
    let plain = |part: &str| part.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let part =
        |(i, part): (usize, &str)| if i % 2 == 1 { format!("<code>{}</code>", plain(part)) } else { plain(part) };
    Value::from_safe_string(text.split('`').enumerate().map(part).collect())
}

fn as_percent(value: &Value) -> Result<String, Error> {
    either(value, percent, share)
}

fn as_points(value: &Value) -> Result<String, Error> {
    either(value, |bare| points(Estimate::exact(bare)), points)
}

fn as_fixed(value: &Value, digits: usize) -> Result<String, Error> {
    either(value, |bare| format!("{bare:.digits$}"), |estimate| fixed(estimate, digits))
}

fn as_signed(value: &Value, digits: usize) -> Result<String, Error> {
    either(value, |bare| format!("{bare:+.digits$}"), |estimate| signed(estimate, digits))
}

/// Gives templates the filters; `measured(success)` and `difference(success)` are for what is success of one skill and
/// return of another.
pub fn add_filters(environment: &mut Environment<'_>) {
    environment.add_filter("percent", as_percent);
    environment.add_filter("points", as_points);
    environment.add_filter("fixed", as_fixed);
    environment.add_filter("signed", as_signed);
    environment.add_filter("measured", |value: &Value, success: bool| match success {
        true => as_percent(value),
        false => as_fixed(value, 2),
    });
    environment.add_filter("difference", |value: &Value, success: bool| match success {
        true => as_points(value),
        false => as_signed(value, 2),
    });
    environment.add_filter("number", number);
    environment.add_filter("limit", limit);
    environment.add_filter("seeds", seeds);
    environment.add_filter("code", code);
}
