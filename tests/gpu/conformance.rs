//! The check of exactness, and adapters that are odd, missing or lost. What the kernels leave is compared in
//! `parity.rs`.

use super::adapter::{gpu, opened};
use skilltree::backend::gpu::conformance::{ask, compare, examine, questions};
use skilltree::backend::gpu::device::Device;
use skilltree::backend::gpu::pipeline::Pipeline;
use skilltree::backend::gpu::source::KERNELS;
use skilltree::backend::gpu::{GpuBackend, GpuOptions, adapter};
use skilltree::backend::{Backend, BackendError};

/// The conformance check compares what it says: a flipped last bit of any answer is named.
#[test]
fn one_last_place_in_one_lane_is_not_exact() {
    let _alone = gpu();
    let device = Device::open(&adapter::choose(None, true).expect("an adapter")).expect("it opens");
    let questions = questions(1024);
    let answers = ask(&device, &questions).expect("it runs");
    assert!(compare(&questions, &answers).exact);
    for (word, name) in [(1, "exponential"), (14, "philox"), (25, "a*b + c"), (45, "lanes_sums")] {
        let mut wrong = answers.clone();
        wrong[777][word] ^= 1;
        let verdict = compare(&questions, &wrong);
        let reason = verdict.reason.expect("a reason");
        assert!(!verdict.exact && reason.contains(name) && reason.contains("input 777"), "{reason}");
    }
    let unwritten = vec![[u32::MAX; 48]; 1024];
    assert!(!compare(&questions, &unwritten).exact);
}

/// llvmpipe ends loops after 65,535 turns; the check must notice, and dispatches must stay below.
#[test]
fn the_loop_budget_of_software_adapters_is_seen() {
    let _alone = gpu();
    let gpu = opened(&GpuOptions::default());
    if gpu.info().name.contains("llvmpipe") {
        assert_eq!(gpu.verdict().loop_budget, Some(65_535));
    }
    assert!(gpu.describe().contains("exact"));
}

/// An adapter that does not exist is refused with what was found and what to do.
#[test]
fn a_wrong_name_is_refused_with_a_hint() {
    let _alone = gpu();
    let options = GpuOptions { adapter: Some("no such card".to_owned()), ..GpuOptions::default() };
    let error = GpuBackend::new(&options).expect_err("no such adapter");
    let BackendError::Unavailable { message, hint } = error else { panic!("{error}") };
    assert!(message.contains("`no such card`") && message.contains("found `"), "{message}");
    assert!(hint.contains("mesa-vulkan-drivers") && hint.contains("--backend cpu"), "{hint}");
}

/// Metal and DX12 take the WGSL as it is. Every kernel compiles that way too, and is never called exact.
#[test]
fn kernels_compile_without_passthrough_but_are_not_exact() {
    let _alone = gpu();
    let adapter = adapter::choose(None, true).expect("an adapter");
    let device = Device::open_as(&adapter, false).expect("it opens");
    for kernel in KERNELS {
        Pipeline::new(&device, *kernel, &[]).unwrap_or_else(|error| panic!("{}: {error}", kernel.name));
    }
    let verdict = examine(&device).expect("it runs");
    assert!(!verdict.exact && verdict.reason.is_some());
    // llvmpipe re-associates what is not decorated: the shapes of the check must show it.
    if device.info.name.contains("llvmpipe") {
        let questions = questions(4096);
        let reason = compare(&questions, &ask(&device, &questions).expect("it runs")).reason;
        assert!(reason.is_some_and(|reason| reason.contains("differs on")));
    }
}

/// A lost device is an error that says so, not a panic and not a hang.
#[test]
fn a_lost_device_is_an_error() {
    let _alone = gpu();
    let device = Device::open(&adapter::choose(None, true).expect("an adapter")).expect("it opens");
    device.device.destroy();
    let error = ask(&device, &questions(32)).expect_err("the device is lost");
    assert!(matches!(error, BackendError::Device { kernel: "arithmetic_check", .. }), "{error}");
    // Whoever comes next hears of it too: other dispatches may have been in flight.
    assert!(device.sound("step").is_err() && device.wait("step", None).is_err());
}
