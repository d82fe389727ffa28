//! Which adapter: all that can be seen, and the one that fits what the user asked for.

use super::device::is_software;
use crate::backend::BackendError;

/// How a user without a graphics card can still get a GPU backend, and how to do without.
const HINT: &str = "use `--backend cpu`, or install software Vulkan (Debian, Ubuntu: apt install mesa-vulkan-drivers) \
                    and name it: `--adapter llvmpipe`";

/// Every adapter of the backends that can run kernels.
pub fn adapters() -> (wgpu::Instance, Vec<wgpu::Adapter>) {
    let descriptor = wgpu::InstanceDescriptor {
        backends: wgpu::Backends::PRIMARY,
        // Debug layers would change nothing but speed, and complain on stderr where they are missing.
        flags: wgpu::InstanceFlags::empty(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    };
    let instance = wgpu::Instance::new(descriptor);
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    (instance, adapters)
}

/// The adapter to use: by name where one is given, else a real GPU before a software one.
///
/// # Errors
/// Where nothing fits; the message says what was seen.
pub fn choose(name: Option<&str>, software: bool) -> Result<wgpu::Adapter, BackendError> {
    let (instance, adapters) = adapters();
    let seen = seen(&instance, &adapters);
    let mut fitting: Vec<wgpu::Adapter> = adapters
        .into_iter()
        .filter(|adapter| {
            let info = adapter.get_info();
            match name {
                Some(name) => info.name.to_lowercase().contains(&name.to_lowercase()),
                None => software || !is_software(&info),
            }
        })
        .collect();
    fitting.sort_by_key(|adapter| rank(&adapter.get_info()));
    fitting.into_iter().next().ok_or_else(|| {
        let wanted = match name {
            Some(name) => format!("no adapter's name contains `{name}`"),
            None if software => "no graphics adapter".to_owned(),
            None => "no graphics card".to_owned(),
        };
        BackendError::Unavailable { message: format!("{wanted}: {seen}"), hint: HINT.to_owned() }
    })
}

/// Cards first, then graphics within a CPU, software last; Vulkan, which can be exact, before the others.
fn rank(info: &wgpu::AdapterInfo) -> (u32, u32) {
    let kind = match info.device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    };
    (kind, u32::from(info.backend != wgpu::Backend::Vulkan))
}

/// What was seen: the adapters' names or, where there are none, why each backend has none.
fn seen(instance: &wgpu::Instance, adapters: &[wgpu::Adapter]) -> String {
    if adapters.is_empty() {
        let request = instance.request_adapter(&wgpu::RequestAdapterOptions::default());
        return match pollster::block_on(request) {
            Ok(adapter) => adapter.get_info().name,
            Err(error) => error.to_string(),
        };
    }
    let names: Vec<String> = adapters
        .iter()
        .map(|adapter| {
            let info = adapter.get_info();
            let software = if is_software(&info) { ", software" } else { "" };
            format!("`{}` ({}{software})", info.name, info.backend)
        })
        .collect();
    format!("found {}", names.join(", "))
}
