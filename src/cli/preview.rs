//! What a run is going to do and take, told before it begins.

use super::console::{count, tell};
use crate::backend::{Backend, BackendError};
use crate::config::plan::{Design, Plan};
use crate::train::batch_group::BatchGroup;
use crate::train::estimate::{Forecast, forecast, measure, parts_bytes};
use crate::train::run::Options;
use crate::train::schedule::waves;
use std::collections::BTreeSet;
use std::time::Duration;

/// Longest time that measuring the speed may take, but for the device's own preparations.
const MEASURE: Duration = Duration::from_millis(1500);

/// Shows how large a run is and how long it may take, and hands back its size.
pub(super) fn show(
    plan: &Plan,
    groups: &[BatchGroup],
    backend: &mut dyn Backend,
    options: Options,
) -> Result<Forecast, BackendError> {
    tell(if plan.title.is_empty() { &plan.name } else { &plan.title });
    let worlds: Vec<&str> = plan.worlds.iter().map(|placed| placed.world.name.as_str()).collect();
    tell(&format!("world:    {}", worlds.join(", ")));
    if let Some(sweep) = &plan.sweep {
        let axes: Vec<String> =
            sweep.axes.iter().map(|axis| format!("{} ({})", axis.label, count(axis.values.len(), "value"))).collect();
        let drawn = if sweep.design == Design::Random { ", drawn at random" } else { "" };
        tell(&format!("sweep:    {}{drawn}: {}", count(sweep.points.len(), "point"), axes.join(", ")));
    }
    let size = |bytes| options.cohort.map_or_else(|| backend.cohort_size(bytes), Ok);
    let waves = waves(plan, groups, size, |_| false)?;
    let forecast = forecast(plan, groups, &waves);
    tell(&format!("learners: {}", learners(plan, &forecast)));
    tell(&format!(
        "memory:   {} for each learner, {} for {} in {}",
        bytes(forecast.bytes_per_learner as u64),
        bytes(forecast.cohort_bytes),
        count(forecast.largest, "learner"),
        match forecast.cohorts {
            1 => "one cohort".to_owned(),
            cohorts => format!("the largest of {cohorts} cohorts"),
        }
    ));
    let parts = parts_bytes(groups, &waves);
    tell(&format!("disk:     about {}, and {} until the end", bytes(forecast.disk), bytes(parts)));
    tell(&format!("backend:  {}", backend.describe()));
    let speed = measure(plan, groups, &waves, &forecast, backend, MEASURE)?;
    tell(&format!("time:     {} by estimate, from a short trial on this machine", about(forecast.time(speed))));
    Ok(forecast)
}

/// `1568 (1 arm x 49 points x 32 seeds); what is below their roots is learned 32 times`.
fn learners(plan: &Plan, forecast: &Forecast) -> String {
    let arms: BTreeSet<&str> = plan.arms.iter().map(|arm| arm.name.as_str()).collect();
    let points: BTreeSet<u32> = plan.arms.iter().map(|arm| arm.point).collect();
    let mut factors = vec![count(arms.len(), "arm"), count(points.len(), "point"), count(plan.seeds.len(), "seed")];
    if plan.sweep.is_none() {
        factors.remove(1);
    }
    let whole = arms.len() * points.len() == plan.arms.len();
    // An arm without the key of some axis has fewer points.
    let product = if whole { factors.join(" x ") } else { format!("of {}", factors.join(" x ")) };
    let mut text = format!("{} ({product})", forecast.learners);
    if forecast.pretrained > 0 && forecast.pretrained < forecast.learners {
        text += &format!("; everything below the roots is trained {} times", forecast.pretrained);
    }
    text
}

/// `3.4 MB`, in powers of ten.
fn bytes(number: u64) -> String {
    let number = number as f64;
    match number {
        1e9.. => format!("{:.1} GB", number / 1e9),
        1e6.. => format!("{:.1} MB", number / 1e6),
        _ => format!("{:.0} kB", (number / 1e3).ceil()),
    }
}

/// Two digits are more than an estimate has.
fn about(time: Duration) -> String {
    let seconds = time.as_secs_f64();
    match seconds {
        ..1.0 => "under a second".to_owned(),
        ..100.0 => format!("about {seconds:.0} s"),
        ..6000.0 => format!("about {:.0} min", seconds / 60.0),
        _ => format!("about {:.0} h", seconds / 3600.0),
    }
}
