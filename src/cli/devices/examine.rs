//! What is known of each adapter of this machine.

use super::listing::{AdapterReport, DeviceList};
use crate::backend::gpu::adapter::{adapters, choose};
use crate::backend::gpu::arithmetic_check::ANSWER_WORDS;
use crate::backend::gpu::conformance::{QUESTIONS, Verdict, examine};
use crate::backend::gpu::device::{Device, is_software, takes_spirv};

/// Examines every adapter.
pub(super) fn devices() -> DeviceList {
    let (_instance, found) = adapters();
    let entries: Vec<AdapterReport> = found.iter().map(report).collect();
    let none = if entries.is_empty() { choose(None, true).err().map(|error| error.to_string()) } else { None };
    DeviceList { adapters: entries, none }
}

fn report(adapter: &wgpu::Adapter) -> AdapterReport {
    let (info, limits) = (adapter.get_info(), adapter.limits());
    let examined = Device::open(adapter).and_then(|device| examine(&device));
    let (verdict, failure) = match examined {
        Ok(verdict) => (Some(verdict), None),
        Err(error) => (None, error.to_string().lines().next().map(str::to_owned)),
    };
    let of = |get: fn(&Verdict) -> Option<String>| verdict.as_ref().and_then(get);
    AdapterReport {
        driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
        backend: info.backend.to_string(),
        kind: kind(info.device_type).to_owned(),
        software: is_software(&info),
        name: info.name,
        max_buffer_bytes: limits.max_buffer_size,
        max_binding_bytes: limits.max_storage_buffer_binding_size,
        max_storage_buffers: limits.max_storage_buffers_per_shader_stage,
        takes_spirv: takes_spirv(adapter),
        exact: verdict.as_ref().is_some_and(|verdict| verdict.exact),
        compared: format!("{} functions and shapes, {QUESTIONS} inputs each", ANSWER_WORDS - 1),
        reason: failure.or_else(|| of(|verdict| verdict.reason.clone())),
        subnormals_kept: verdict.as_ref().map(|verdict| verdict.subnormals),
        loop_budget: verdict.as_ref().and_then(|verdict| verdict.loop_budget),
    }
}

fn kind(kind: wgpu::DeviceType) -> &'static str {
    match kind {
        wgpu::DeviceType::DiscreteGpu => "graphics card",
        wgpu::DeviceType::IntegratedGpu => "graphics within the CPU",
        wgpu::DeviceType::VirtualGpu => "virtual graphics card",
        wgpu::DeviceType::Cpu => "software, on the CPU",
        wgpu::DeviceType::Other => "of unknown type",
    }
}
