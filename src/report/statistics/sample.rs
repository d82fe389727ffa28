//! Where values lie: means, quantiles and shares.

/// A statistic of values sorted in ascending order.
pub type Statistic = fn(&[f64]) -> f64;

/// Arithmetic mean.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Interquartile mean: cut `floor(n / 4)` values from each end, then average (as rliable 1.2.0, Agarwal et al. 2021).
/// Values must be sorted in ascending order.
pub fn interquartile_mean(sorted: &[f64]) -> f64 {
    let cut = sorted.len() / 4;
    mean(&sorted[cut..sorted.len() - cut])
}

/// The values in ascending order.
pub fn sorted(values: &[f64]) -> Vec<f64> {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values
}

/// Quantile of sorted values with linear interpolation, `share` in 0 to 1 (NumPy's default).
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let position = share.clamp(0.0, 1.0) * last as f64;
    let below = position.floor() as usize;
    let above = (below + 1).min(last);
    sorted[below] + (sorted[above] - sorted[below]) * (position - below as f64)
}

/// Sum of the first numbers over the sum of the second ones.
pub fn ratio(pairs: &[(f64, f64)]) -> f64 {
    let sum = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>();
    sum(|pair| pair.0) / sum(|pair| pair.1)
}

/// Share of values below a limit.
pub fn share_below(values: &[f64], limit: f64) -> f64 {
    values.iter().filter(|&&value| value < limit).count() as f64 / values.len() as f64
}
