//! Where values lie: means, quantiles and shares.

/// A statistic of values sorted in ascending order.
pub type Statistic = fn(&[f64]) -> f64;

/// Arithmetic mean.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Sample standard deviation, with one degree of freedom taken off. NaN for fewer than two values.
pub fn standard_deviation(values: &[f64]) -> f64 {
    let centre = mean(values);
    let squares: f64 = values.iter().map(|value| (value - centre) * (value - centre)).sum();
    (squares / (values.len() as f64 - 1.0)).sqrt()
}

/// Interquartile mean: cut `floor(n / 4)` values from each end, then average. Values must be sorted in ascending order;
/// those of several tasks are pooled first.
pub fn interquartile_mean(sorted: &[f64]) -> f64 {
    let cut = sorted.len() / 4;
    mean(&sorted[cut..sorted.len() - cut])
}

/// How far scores fall short of a target on average, where what exceeds the target counts as the target.
pub fn optimality_gap(scores: &[f64], target: f64) -> f64 {
    target - scores.iter().map(|score| score.min(target)).sum::<f64>() / scores.len() as f64
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
