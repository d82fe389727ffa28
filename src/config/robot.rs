//! The keys of `robot`: noise, what a robot remembers, and what counts as beside a wall.

use crate::layout::{HyperParams, Noise};
use crate::toml::error::ConfigError;
use crate::toml::reader::Item;
use bytemuck::Zeroable;

/// Reads a complete `robot` table into the numbers of skills that it concerns; the others are 0.
pub(super) fn read(item: &Item<'_>) -> Result<HyperParams, ConfigError> {
    let table = item.table()?;
    let mut params = HyperParams { noise: noise(&table.required("noise", "{}")?)?, ..HyperParams::zeroed() };
    let memory = table.required("memory", "{}")?.table()?;
    let beside = table.required("beside", "{}")?.table()?;
    table.finish()?;
    memory.fill("robot.memory.", HyperParams::rows(), &mut params)?;
    beside.fill("robot.beside.", HyperParams::rows(), &mut params)?;
    if params.beside_near >= params.beside_far {
        let (near, far) = (beside.required("near", "15")?, beside.required("far", "30")?);
        let message = format!(
            "`{}` is {}, which is not less than `{}`, {}",
            near.name, params.beside_near, far.name, params.beside_far
        );
        // The complaint belongs to the one that somebody wrote.
        let written = if near.origin().is_default() { far } else { near };
        return Err(written.error(message, "the band beside a wall reaches from near to far: give near < far"));
    }
    memory.finish()?;
    beside.finish()?;
    Ok(params)
}

/// Reads a complete table of noise.
pub(super) fn noise(item: &Item<'_>) -> Result<Noise, ConfigError> {
    let section = item.table()?;
    let mut noise = Noise::zeroed();
    section.fill("robot.noise.", Noise::rows(), &mut noise)?;
    section.finish()?;
    Ok(noise)
}
