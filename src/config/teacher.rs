//! The keys of `teacher`.

use super::keys;
use super::plan::Teacher;
use crate::toml::error::ConfigError;
use crate::toml::reader::{Item, Section};

/// Reads a complete `teacher` table.
pub(super) fn read(item: &Item<'_>) -> Result<Teacher, ConfigError> {
    let section = Section(item.table()?);
    let teacher = Teacher {
        bank: section.whole(&keys::TEACHER_BANK)?,
        discount: section.number(&keys::TEACHER_DISCOUNT)?,
        backward_cost: section.number(&keys::TEACHER_BACKWARD_COST)?,
        collision_cost: section.number(&keys::TEACHER_COLLISION_COST)?,
        episodes: section.whole(&keys::TEACHER_EPISODES)?,
    };
    section.0.finish()?;
    Ok(teacher)
}
