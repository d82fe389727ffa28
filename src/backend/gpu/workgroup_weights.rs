//! How many words of a workgroup's memory hold weights while a learner replays: `HELD` of kernel `train`.
//!
//! No more than the largest skill that fits, as memory that a workgroup takes keeps others from running beside it.

use super::device::{Device, is_software};
use crate::backend::Cohort;
use crate::layout::{HyperParams, SkillShape};
use crate::qnet::forward::lanes_used;
use naga::{AddressSpace, Module};

/// Name of the override.
pub const HELD: &str = "HELD_WORDS";
/// Workgroups that must stay side by side on a multiprocessor. An H200 shares the limit of one workgroup among all that are
/// resident: weights that take it all leave one warp there, which replays at 0.4 times the speed of weights not held.
const RESIDENT: u32 = 8;
/// Bytes that no variable's alignment exceeds.
const ALIGNMENT: u32 = 16;

/// Words that a skill's weights take where they are held.
fn words(plan: &SkillShape, params: &HyperParams) -> u32 {
    plan.nets * plan.rows * lanes_used(params.hidden) as u32
}

/// Words that each skill of each learner takes, with the skill's number; none where it is not trained.
fn trained(cohort: &Cohort) -> impl Iterator<Item = (usize, u32)> {
    let skills = cohort.params.chunks(cohort.skills.max(1)).flat_map(|own| own.iter().enumerate());
    let trained = skills.filter(|(_, params)| params.trials > 0 || params.pretrain_epochs * params.lessons > 0);
    trained.map(|(skill, params)| (skill, words(&cohort.shared.skills[skill], params)))
}

/// What may be held: words that a skill of the cohort takes, ascending.
pub fn wanted(cohort: &Cohort) -> Vec<u32> {
    let mut wanted: Vec<u32> = trained(cohort).map(|(_, words)| words).collect();
    wanted.sort_unstable();
    wanted.dedup();
    wanted
}

/// Bits of the skills that some learner holds in `held` words.
pub fn holders(cohort: &Cohort, held: u32) -> u32 {
    trained(cohort).filter(|(_, words)| *words <= held).fold(0, |bits, (skill, _)| bits | 1 << skill)
}

/// The most words of those wanted that the device has beside the kernel's other workgroup memory, at least one.
///
/// # Errors
/// What naga has to say about a type without a size.
pub fn held(device: &Device, module: &Module, wanted: &[u32]) -> Result<u32, String> {
    // Where the driver takes no SPIR-V, one invocation zeroes the memory, and nobody has seen how long that takes.
    let limit = if device.passthrough { device.device.limits().max_compute_workgroup_storage_size } else { 0 };
    let resident = if is_software(&device.info) { 1 } else { RESIDENT };
    Ok(fitting(limit / resident, shared_bytes(module)?, wanted))
}

/// The most words of those wanted that `limit` bytes hold beside `taken`, at least one.
fn fitting(limit: u32, taken: u32, wanted: &[u32]) -> u32 {
    let room = limit.saturating_sub(taken) / size_of::<f32>() as u32;
    wanted.iter().copied().filter(|words| *words <= room).max().unwrap_or(1)
}

/// Bytes of a module's workgroup memory, with overrides as in the text.
///
/// # Errors
/// What naga has to say about a type without a size.
pub fn shared_bytes(module: &Module) -> Result<u32, String> {
    let mut layouter = naga::proc::Layouter::default();
    layouter.update(module.to_ctx()).map_err(|error| error.to_string())?;
    let shared = module.global_variables.iter().filter(|(_, variable)| variable.space == AddressSpace::WorkGroup);
    Ok(shared.map(|(_, variable)| layouter[variable.ty].size.next_multiple_of(ALIGNMENT)).sum())
}

#[cfg(test)]
mod tests {
    use super::super::source::TRAIN;
    use super::super::spirv::check;
    use super::*;

    #[test]
    fn every_device_has_room_for_a_word_and_larger_ones_for_more() {
        let taken = shared_bytes(&check(&TRAIN.wgsl()).expect("valid").module).expect("sizes");
        // Nets of docking: one for all actions; six of 16 units; six of 32.
        let wanted = [1_920, 5_280, 10_560];
        for (limit, held) in [(0, 1), (16 << 10, 1_920), (32 << 10, 5_280), (48 << 10, 10_560)] {
            assert_eq!(fitting(limit, taken, &wanted), held);
            assert!(limit == 0 || taken + 4 * held <= limit, "{taken} bytes beside {held} words of {limit} bytes");
        }
        assert_eq!(fitting(48 << 10, taken, &[]), 1);
        assert!(taken > 4_000, "{taken}");
    }
}
