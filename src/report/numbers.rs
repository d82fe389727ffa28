//! Numbers as the page and the terminal print them.

use super::statistics::Interval;

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

/// `0.123` as `12.3%`.
pub fn percent(share: f64) -> String {
    format!("{:.1}%", 100.0 * share)
}

/// A limit in percent, without needless digits.
pub fn limit(share: f64) -> String {
    format!("{}%", number(100.0 * share))
}

/// An interval of shares, in percent.
pub fn percent_range(interval: Interval) -> String {
    format!("[{:.1}, {:.1}]", 100.0 * interval.low, 100.0 * interval.high)
}

/// A share with its interval.
pub fn percent_with(share: f64, interval: Interval) -> String {
    format!("{} {}", percent(share), percent_range(interval))
}

/// A difference of two shares, in percentage points with signs.
pub fn points_with(difference: f64, interval: Interval) -> String {
    // Adding 0 makes of a rounded -0 a 0.
    let points = |share: f64| (1000.0 * share).round() / 10.0 + 0.0;
    format!("{:+.1} [{:+.1}, {:+.1}]", points(difference), points(interval.low), points(interval.high))
}

/// A value with its interval.
pub fn with(value: f64, interval: Interval, digits: usize) -> String {
    format!("{value:.digits$} [{:.digits$}, {:.digits$}]", interval.low, interval.high)
}

/// `1 seed`, `7 seeds`.
pub fn seeds(count: usize) -> String {
    if count == 1 { "1 seed".into() } else { format!("{} seeds", number(count as f64)) }
}
