//! The keys of `robot`: noise, what a robot remembers, and what counts as beside a wall.

use super::keys;
use super::plan::{Noise, NoiseKind, Robot};
use crate::toml::error::ConfigError;
use crate::toml::reader::{Item, Section};

/// Reads a complete `robot` table.
pub(super) fn read(item: &Item<'_>) -> Result<(Noise, Robot), ConfigError> {
    let table = item.table()?;
    let noise = noise(&table.required("noise", "{}")?)?;
    let memory = Section(table.required("memory", "{}")?.table()?);
    let beside = Section(table.required("beside", "{}")?.table()?);
    table.finish()?;
    let robot = Robot {
        light_trace: memory.number(&keys::MEMORY_LIGHT)?,
        door_trace: memory.number(&keys::MEMORY_DOORS)?,
        range_mean: memory.number(&keys::MEMORY_RANGES)?,
        beside_near: beside.number(&keys::BESIDE_NEAR)?,
        beside_far: beside.number(&keys::BESIDE_FAR)?,
    };
    if robot.beside_near >= robot.beside_far {
        let near = beside.required(&keys::BESIDE_NEAR, "15.0")?;
        let far = beside.required(&keys::BESIDE_FAR, "30.0")?;
        let message = format!(
            "`{}` is {}, which is not less than `{}`, {}",
            near.name, robot.beside_near, far.name, robot.beside_far
        );
        // The complaint belongs to the one that somebody wrote.
        let written = if near.origin().is_default() { far } else { near };
        return Err(written.error(message, "the band beside a wall reaches from near to far: give near < far"));
    }
    memory.0.finish()?;
    beside.0.finish()?;
    Ok((noise, robot))
}

/// Reads a complete table of noise.
pub(super) fn noise(item: &Item<'_>) -> Result<Noise, ConfigError> {
    let section = Section(item.table()?);
    let kind = if section.choice(&keys::NOISE_KIND)? == 0 { NoiseKind::Gaussian } else { NoiseKind::Uniform };
    let noise = Noise {
        kind,
        actuator: section.number(&keys::NOISE_ACTUATOR)?,
        sonar: section.number(&keys::NOISE_SONAR)?,
        light: section.number(&keys::NOISE_LIGHT)?,
        compass: section.number(&keys::NOISE_COMPASS)?,
    };
    section.0.finish()?;
    Ok(noise)
}
