//! The keys of `teacher`.

use super::keys;
use super::plan::TeacherPlan;
use crate::toml::error::ConfigError;
use crate::toml::reader::{Item, KeyedTable};

/// Reads a complete `teacher` table.
pub(super) fn read(item: &Item<'_>) -> Result<TeacherPlan, ConfigError> {
    let section = KeyedTable(item.table()?);
    let teacher = TeacherPlan {
        lessons: section.word(&keys::TEACHER_LESSONS)?,
        discount: section.number(&keys::TEACHER_DISCOUNT)?,
        backward_cost: section.number(&keys::TEACHER_BACKWARD_COST)?,
        collision_cost: section.number(&keys::TEACHER_COLLISION_COST)?,
        eval_episodes: section.word(&keys::TEACHER_EVAL_EPISODES)?,
    };
    section.0.finish()?;
    Ok(teacher)
}
