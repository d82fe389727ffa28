//! A kernel ready to run: its layout is read from the checked module, never guessed by the driver.

use super::device::Device;
use super::source::Kernel;
use super::spirv::{check, compile};
use super::workgroup_weights::{HELD, held};
use crate::backend::BackendError;
use naga::back::PipelineConstants;

/// A compute pipeline and the layout of its one bind group.
#[derive(Debug)]
pub struct Pipeline {
    kernel: Kernel,
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    held: u32,
}

impl Pipeline {
    /// Compiles a kernel for a device, with workgroup memory for the largest of some numbers of weights that fits.
    ///
    /// # Errors
    /// Where the driver refuses it.
    pub fn new(device: &Device, kernel: Kernel, wanted: &[u32]) -> Result<Self, BackendError> {
        let failed = |message: String| BackendError::Device { kernel: kernel.name, message };
        let wgsl = kernel.wgsl();
        let checked = check(&wgsl).map_err(failed)?;
        let entries = entries(&checked.module).map_err(failed)?;
        let held = held(device, &checked.module, wanted).map_err(failed)?;
        let scope = device.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let layout = device
            .device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(kernel.name), entries: &entries });
        let pipeline_layout = device.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(kernel.name),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let module = if device.passthrough {
            let overridden = checked.module.overrides.iter().any(|(_, value)| value.name.as_deref() == Some(HELD));
            let overrides: PipelineConstants =
                overridden.then(|| (HELD.to_owned(), f64::from(held))).into_iter().collect();
            let words = compile(&checked, &kernel, &overrides).map_err(failed)?;
            let entry_points = vec![wgpu::PassthroughShaderEntryPoint {
                name: kernel.name.into(),
                workgroup_size: (crate::layout::LANES as u32, 1, 1),
            }];
            let descriptor = wgpu::ShaderModuleDescriptorPassthrough {
                label: Some(kernel.name),
                entry_points: entry_points.into(),
                spirv: Some(words.into()),
                ..Default::default()
            };
            // SAFETY: naga validated the module and wrote these words with bounded indices and zeroed
            // workgroup memory, but for the array `held` of `train`, whose words are written before they are
            // read; all loops count up to a bound; the layout was made from the same module.
            unsafe { device.device.create_shader_module_passthrough(descriptor) }
        } else {
            device.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(kernel.name),
                source: wgpu::ShaderSource::Wgsl(wgsl.into()),
            })
        };
        let pipeline = device.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(kernel.name),
            layout: Some(&pipeline_layout),
            module: &module,
            entry_point: Some(kernel.name),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        if let Some(error) = pollster::block_on(scope.pop()) {
            return Err(failed(error.to_string()));
        }
        device.sound(kernel.name)?;
        Ok(Self { kernel, pipeline, layout, held })
    }

    /// Words of workgroup memory that hold weights.
    pub fn held(&self) -> u32 {
        self.held
    }

    /// Binds buffers in the order of the kernel's bindings.
    pub fn bind(&self, device: &Device, buffers: &[&wgpu::Buffer]) -> wgpu::BindGroup {
        let entries: Vec<_> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.kernel.name),
            layout: &self.layout,
            entries: &entries,
        })
    }

    /// The kernel's name.
    pub fn name(&self) -> &'static str {
        self.kernel.name
    }

    /// Dispatches workgroups along both axes. It is done when the submission is.
    pub fn submit(&self, device: &Device, bind_group: &wgpu::BindGroup, (x, y): (u32, u32)) -> wgpu::SubmissionIndex {
        let mut encoder = device.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let descriptor = wgpu::ComputePassDescriptor { label: Some(self.kernel.name), timestamp_writes: None };
        let mut pass = encoder.begin_compute_pass(&descriptor);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, bind_group, &[]);
        pass.dispatch_workgroups(x, y, 1);
        drop(pass);
        device.queue.submit([encoder.finish()])
    }
}

/// The entries of the module's bind group, by binding number.
fn entries(module: &naga::Module) -> Result<Vec<wgpu::BindGroupLayoutEntry>, String> {
    let mut entries = Vec::new();
    for (_, global) in module.global_variables.iter() {
        let Some(binding) = &global.binding else { continue };
        let ty = match global.space {
            naga::AddressSpace::Uniform => wgpu::BufferBindingType::Uniform,
            naga::AddressSpace::Storage { access } => {
                wgpu::BufferBindingType::Storage { read_only: !access.contains(naga::StorageAccess::STORE) }
            }
            space => return Err(format!("a binding in {space:?} is not a buffer")),
        };
        if binding.group != 0 {
            return Err(format!("a kernel has one bind group, not group {}", binding.group));
        }
        entries.push(wgpu::BindGroupLayoutEntry {
            binding: binding.binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
            count: None,
        });
    }
    entries.sort_by_key(|entry| entry.binding);
    Ok(entries)
}
