//! From WGSL to SPIR-V words that keep the written order of every float operation.
//!
//! WGSL allows a compiler to fuse and re-associate. SPIR-V's `NoContraction` decoration forbids it, and
//! no WGSL text can ask for it, so the decoration is put on every float result here.

use super::source::Kernel;
use naga::back::spv;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use std::borrow::Cow;

/// SPIR-V opcodes that this pass knows by number (SPIR-V specification, section 3).
mod op {
    pub(super) const DECORATE: u32 = 71;
    /// The first type declaration ends the annotations.
    pub(super) const TYPES: std::ops::RangeInclusive<u32> = 19..=39;
    /// Float negation, addition, subtraction, multiplication, division, remainders and products.
    pub(super) const FLOAT: [u32; 14] = [127, 129, 131, 133, 136, 140, 141, 142, 143, 144, 145, 146, 147, 148];
}

/// Code of the decoration.
const NO_CONTRACTION: u32 = 42;
/// Words before the first instruction.
const HEADER: usize = 5;

/// A parsed and validated kernel.
#[derive(Debug)]
pub struct Checked {
    /// The whole module, one entry point.
    pub module: naga::Module,
    /// What validation found out about it.
    pub info: ModuleInfo,
}

/// Parses and validates a kernel's WGSL.
///
/// # Errors
/// What naga has to say about the text, with the place.
pub fn check(wgsl: &str) -> Result<Checked, String> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|error| error.emit_to_string(wgsl))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|error| error.emit_to_string(wgsl))?;
    Ok(Checked { module, info })
}

/// SPIR-V of a checked kernel: indices bounded, workgroup memory zeroed, every float result decorated.
///
/// # Errors
/// Where naga cannot express the module.
pub fn compile(checked: &Checked, kernel: &Kernel) -> Result<Vec<u32>, String> {
    Ok(decorate(&plain(checked, kernel)?))
}

/// SPIR-V as naga writes it.
fn plain(checked: &Checked, kernel: &Kernel) -> Result<Vec<u32>, String> {
    let options = spv::Options {
        lang_version: (1, 3),
        flags: spv::WriterFlags::empty(),
        // Without a map, naga keeps the numbers in the text.
        fake_missing_bindings: true,
        bounds_check_policies: BoundsCheckPolicies {
            index: BoundsCheckPolicy::Restrict,
            buffer: BoundsCheckPolicy::Restrict,
            image_load: BoundsCheckPolicy::Restrict,
            binding_array: BoundsCheckPolicy::Restrict,
        },
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::Polyfill,
        // Every loop of a kernel counts up to a bound: the extra counter would only cost time.
        force_loop_bounding: false,
        ..spv::Options::default()
    };
    let entry = spv::PipelineOptions { shader_stage: naga::ShaderStage::Compute, entry_point: kernel.name.to_owned() };
    let constants = naga::back::PipelineConstants::default();
    let (module, info): (Cow<'_, _>, Cow<'_, _>) =
        naga::back::pipeline_constants::process_overrides(&checked.module, &checked.info, None, &constants)
            .map_err(|error| error.to_string())?;
    spv::write_vec(&module, &info, &options, Some(&entry)).map_err(|error| error.to_string())
}

/// Opcode, first word and length of every instruction.
fn instructions(words: &[u32]) -> impl Iterator<Item = (u32, usize, usize)> + '_ {
    let mut at = HEADER;
    std::iter::from_fn(move || {
        let first = *words.get(at)?;
        let start = at;
        let length = ((first >> 16) as usize).max(1);
        at += length;
        Some((first & 0xffff, start, length))
    })
}

/// Puts `NoContraction` on the result of every float operation.
pub fn decorate(words: &[u32]) -> Vec<u32> {
    let mut decorations = Vec::new();
    for (opcode, start, length) in instructions(words) {
        if op::FLOAT.contains(&opcode) && length > 2 {
            decorations.extend([3 << 16 | op::DECORATE, words[start + 2], NO_CONTRACTION]);
        }
    }
    let types = instructions(words).find(|(opcode, ..)| op::TYPES.contains(opcode));
    let place = types.map_or(words.len(), |(_, start, _)| start);
    [&words[..place], &decorations, &words[place..]].concat()
}

#[cfg(test)]
mod tests {
    use super::super::source::{ADVANCE, KERNELS};
    use super::*;

    fn count(words: &[u32], wanted: impl Fn(u32, &[u32]) -> bool) -> usize {
        instructions(words).filter(|(opcode, start, length)| wanted(*opcode, &words[*start..start + length])).count()
    }

    fn is_decoration(opcode: u32, words: &[u32]) -> bool {
        opcode == op::DECORATE && words[2] == NO_CONTRACTION
    }

    #[test]
    fn every_float_result_of_every_kernel_is_decorated_once() {
        for kernel in KERNELS {
            let checked = check(&kernel.wgsl()).expect(kernel.name);
            let before = plain(&checked, kernel).expect(kernel.name);
            let after = compile(&checked, kernel).expect(kernel.name);
            let floats = count(&before, |opcode, _| op::FLOAT.contains(&opcode));
            assert_eq!(count(&before, is_decoration), 0, "{}", kernel.name);
            assert_eq!(count(&after, is_decoration), floats, "{}", kernel.name);
            assert_eq!(after.len(), before.len() + 3 * floats, "{}", kernel.name);
        }
        let advance = compile(&check(&ADVANCE.wgsl()).expect("valid"), &ADVANCE).expect("expressible");
        assert!(count(&advance, is_decoration) > 100);
    }

    #[test]
    fn decorations_stand_before_the_first_type_and_nothing_else_moves() {
        let checked = check(&ADVANCE.wgsl()).expect("valid");
        let before = plain(&checked, &ADVANCE).expect("expressible");
        let after = decorate(&before);
        let mut types_seen = false;
        for (opcode, ..) in instructions(&after) {
            types_seen |= op::TYPES.contains(&opcode);
            assert!(!(types_seen && opcode == op::DECORATE));
        }
        let kept: Vec<u32> = instructions(&after)
            .map(|(opcode, start, length)| (opcode, &after[start..start + length]))
            .filter(|(opcode, words)| !is_decoration(*opcode, words))
            .flat_map(|(_, words)| words.iter().copied())
            .collect();
        assert_eq!(kept, before[HEADER..]);
    }
}
