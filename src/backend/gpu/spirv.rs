//! From WGSL to SPIR-V words that keep the written order of every float operation.
//!
//! WGSL allows a compiler to fuse and re-associate. SPIR-V's `NoContraction` decoration forbids it, and
//! no WGSL text can ask for it, so the decoration is put on every float result here.

use super::source::Kernel;
use naga::back::{PipelineConstants, spv};
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

/// SPIR-V opcodes that this pass knows by number (SPIR-V specification, section 3).
mod op {
    pub(super) const CONSTANT_NULL: u32 = 46;
    pub(super) const VARIABLE: u32 = 59;
    pub(super) const STORE: u32 = 62;
    pub(super) const DECORATE: u32 = 71;
    /// The first type declaration ends the annotations.
    pub(super) const TYPES: std::ops::RangeInclusive<u32> = 19..=39;
    /// Float negation, addition, subtraction, multiplication, division, remainders and products.
    pub(super) const FLOAT: [u32; 14] = [127, 129, 131, 133, 136, 140, 141, 142, 143, 144, 145, 146, 147, 148];
}

/// Code of the decoration.
const NO_CONTRACTION: u32 = 42;
/// Code of the storage class of workgroup memory.
const WORKGROUP: u32 = 4;
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

/// SPIR-V of a checked kernel: indices bounded, workgroup memory zeroed but for arrays whose length is an override,
/// every float result decorated.
///
/// # Errors
/// Where naga cannot express the module.
pub fn compile(checked: &Checked, kernel: &Kernel, overrides: &PipelineConstants) -> Result<Vec<u32>, String> {
    let (module, info) =
        naga::back::pipeline_constants::process_overrides(&checked.module, &checked.info, None, overrides)
            .map_err(|error| error.to_string())?;
    let words = plain(&module, &info, kernel)?;
    Ok(decorate(&unzeroed(&words, &module, &info)))
}

/// SPIR-V as naga writes it.
fn plain(module: &naga::Module, info: &ModuleInfo, kernel: &Kernel) -> Result<Vec<u32>, String> {
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
    spv::write_vec(module, info, &options, Some(&entry)).map_err(|error| error.to_string())
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

/// Takes out the zeroing of workgroup arrays whose length is an override. Naga lets one invocation store a constant as
/// long as the array, which drivers unroll word by word; a kernel with such an array writes each word of it before it
/// reads it.
fn unzeroed(words: &[u32], module: &naga::Module, info: &ModuleInfo) -> Vec<u32> {
    // Naga declares the variables that the entry point uses, in their order.
    let entry = info.get_entry_point(0);
    let shared = module
        .global_variables
        .iter()
        .filter(|(handle, variable)| variable.space == naga::AddressSpace::WorkGroup && !entry[*handle].is_empty());
    let declared = instructions(words)
        .filter(|(opcode, start, _)| *opcode == op::VARIABLE && words[start + 3] == WORKGROUP)
        .map(|(_, start, _)| words[start + 2]);
    let sized = |variable: &naga::GlobalVariable| {
        matches!(module.types[variable.ty].inner, naga::TypeInner::Array { size: naga::ArraySize::Pending(_), .. })
    };
    let spared: Vec<u32> =
        shared.zip(declared).filter(|((_, variable), _)| sized(variable)).map(|(_, id)| id).collect();
    let nulls: Vec<u32> = instructions(words)
        .filter(|(opcode, ..)| *opcode == op::CONSTANT_NULL)
        .map(|(_, start, _)| words[start + 2])
        .collect();
    let mut kept = words[..HEADER].to_vec();
    for (opcode, start, length) in instructions(words) {
        let zeroing = opcode == op::STORE && spared.contains(&words[start + 1]) && nulls.contains(&words[start + 2]);
        if !zeroing {
            kept.extend(&words[start..start + length]);
        }
    }
    kept
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
    use super::super::source::{KERNELS, TRAIN};
    use super::*;

    fn count(words: &[u32], wanted: impl Fn(u32, &[u32]) -> bool) -> usize {
        instructions(words).filter(|(opcode, start, length)| wanted(*opcode, &words[*start..start + length])).count()
    }

    fn is_decoration(opcode: u32, words: &[u32]) -> bool {
        opcode == op::DECORATE && words[2] == NO_CONTRACTION
    }

    /// Words held in these tests: a length that no other array has.
    const LENGTH: u32 = 777;

    /// SPIR-V as naga writes it, and as it is compiled.
    fn both(kernel: &Kernel) -> (Vec<u32>, Vec<u32>) {
        let checked = check(&kernel.wgsl()).expect(kernel.name);
        let held = (kernel.name == TRAIN.name).then(|| ("HELD_WORDS".to_owned(), f64::from(LENGTH)));
        let overrides: PipelineConstants = held.into_iter().collect();
        let (module, info) =
            naga::back::pipeline_constants::process_overrides(&checked.module, &checked.info, None, &overrides)
                .expect(kernel.name);
        let before = plain(&module, &info, kernel).expect(kernel.name);
        (before, compile(&checked, kernel, &overrides).expect(kernel.name))
    }

    /// The instruction of this kind whose word `place` is `id`.
    fn find(words: &[u32], wanted: u32, place: usize, id: u32) -> Option<&[u32]> {
        let mut all = instructions(words).map(|(opcode, start, length)| (opcode, &words[start..start + length]));
        all.find(|(opcode, found)| *opcode == wanted && found[place] == id).map(|(_, found)| found)
    }

    /// Workgroup variables that are set to zero at the start.
    fn zeroed(words: &[u32]) -> Vec<u32> {
        let stores = instructions(words).filter(|(opcode, ..)| *opcode == op::STORE);
        stores
            .filter(|(_, start, _)| find(words, op::CONSTANT_NULL, 2, words[start + 2]).is_some())
            .filter_map(|(_, start, _)| find(words, op::VARIABLE, 2, words[start + 1]))
            .filter(|variable| variable[3] == WORKGROUP)
            .map(|variable| variable[2])
            .collect()
    }

    #[test]
    fn all_workgroup_memory_is_zeroed_but_that_of_held_weights() {
        const POINTER: u32 = 32;
        const ARRAY: u32 = 28;
        const CONSTANT: u32 = 43;
        for kernel in KERNELS {
            let (before, after) = both(kernel);
            let shared = count(&before, |opcode, variable| opcode == op::VARIABLE && variable[3] == WORKGROUP);
            let (all, mut spared) = (zeroed(&before), zeroed(&before));
            spared.retain(|variable| !zeroed(&after).contains(variable));
            assert_eq!(all.len(), shared, "{}", kernel.name);
            assert_eq!(spared.len(), usize::from(kernel.name == TRAIN.name), "{}", kernel.name);
            for variable in spared {
                let pointer = find(&after, op::VARIABLE, 2, variable).expect("declared")[1];
                let array = find(&after, POINTER, 1, pointer).expect("a pointer")[3];
                let length = find(&after, ARRAY, 1, array).expect("to an array")[3];
                assert_eq!(find(&after, CONSTANT, 2, length).expect("of a length")[3], LENGTH);
            }
        }
    }

    #[test]
    fn every_float_result_of_every_kernel_is_decorated_once() {
        for kernel in KERNELS {
            let (before, after) = both(kernel);
            let floats = count(&before, |opcode, _| op::FLOAT.contains(&opcode));
            let spared = zeroed(&before).len() - zeroed(&after).len();
            assert_eq!(count(&before, is_decoration), 0, "{}", kernel.name);
            assert_eq!(count(&after, is_decoration), floats, "{}", kernel.name);
            assert_eq!(after.len() + 3 * spared, before.len() + 3 * floats, "{}", kernel.name);
        }
        assert!(count(&both(&TRAIN).1, is_decoration) > 100);
    }

    #[test]
    fn decorations_stand_before_the_first_type_and_nothing_else_moves() {
        let (before, _) = both(&TRAIN);
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
