//! An open device: submit, wait with a deadline, upload and download. Nothing here knows a kernel.

use crate::backend::BackendError;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::time::Duration;

/// A device that has not answered for this long is lost. The first dispatch of a pipeline compiles it.
const DEADLINE: Duration = Duration::from_secs(120);
/// Bytes that travel at a time, so that staging memory stays small.
const CHUNK: u64 = 16 << 20;

/// A device with its queue and its first fault.
#[derive(Debug)]
pub struct Device {
    /// wgpu's device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// What the adapter says of itself.
    pub info: wgpu::AdapterInfo,
    /// Whether it takes SPIR-V as it is, so that the written order of operations is kept.
    pub passthrough: bool,
    fault: Arc<Mutex<Option<String>>>,
}

/// Whether the adapter is a program on the CPU.
pub fn is_software(info: &wgpu::AdapterInfo) -> bool {
    info.device_type == wgpu::DeviceType::Cpu
}

/// Whether the adapter takes SPIR-V as it is. Other backends than Vulkan offer the feature for their own
/// languages, which have no such decoration.
pub fn takes_spirv(adapter: &wgpu::Adapter) -> bool {
    adapter.get_info().backend == wgpu::Backend::Vulkan
        && adapter.features().contains(wgpu::Features::PASSTHROUGH_SHADERS)
}

impl Device {
    /// Opens an adapter with default limits, but for buffers and workgroup memory as large as it offers.
    ///
    /// # Errors
    /// Where the driver refuses.
    pub fn open(adapter: &wgpu::Adapter) -> Result<Self, BackendError> {
        Self::open_as(adapter, takes_spirv(adapter))
    }

    /// Opens an adapter as if it took no SPIR-V where `passthrough` is false, as on Metal and DX12.
    ///
    /// # Errors
    /// Where the driver refuses.
    pub fn open_as(adapter: &wgpu::Adapter, passthrough: bool) -> Result<Self, BackendError> {
        let offered = adapter.limits();
        let required_limits = wgpu::Limits {
            max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
            max_buffer_size: offered.max_buffer_size,
            max_compute_workgroup_storage_size: offered.max_compute_workgroup_storage_size,
            ..wgpu::Limits::default()
        };
        let required_features = if passthrough { wgpu::Features::PASSTHROUGH_SHADERS } else { wgpu::Features::empty() };
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("skilltree"),
            required_features,
            required_limits,
            ..Default::default()
        };
        let info = adapter.get_info();
        let (device, queue) =
            pollster::block_on(adapter.request_device(&descriptor)).map_err(|error| BackendError::Unavailable {
                message: format!("the adapter `{}` cannot be opened: {error}", info.name),
                hint: "choose another with `--adapter NAME`, or use `--backend cpu`".to_owned(),
            })?;
        let fault = Arc::new(Mutex::new(None));
        let (uncaptured, lost) = (Arc::clone(&fault), Arc::clone(&fault));
        device.on_uncaptured_error(Arc::new(move |error| note(&uncaptured, error.to_string())));
        device.set_device_lost_callback(move |reason, message| {
            note(&lost, format!("the device was lost ({reason:?}): {message}"));
        });
        Ok(Self { device, queue, info, passthrough, fault })
    }

    /// An error if the device has reported one since it was opened.
    pub fn sound(&self, kernel: &'static str) -> Result<(), BackendError> {
        let fault = self.fault.lock().unwrap_or_else(PoisonError::into_inner).clone();
        fault.map_or(Ok(()), |message| Err(BackendError::Device { kernel, message }))
    }

    /// Creates a buffer of zeros.
    ///
    /// # Errors
    /// Where the driver has no memory for it.
    pub fn buffer(
        &self,
        kernel: &'static str,
        bytes: u64,
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, BackendError> {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(kernel),
            size: bytes.next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT).max(16),
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.sound(kernel).map(|()| buffer)
    }

    /// Creates a buffer that begins with these bytes and has room for `least`.
    ///
    /// # Errors
    /// Where the driver has no memory for it.
    pub fn filled(
        &self,
        kernel: &'static str,
        bytes: &[u8],
        least: usize,
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, BackendError> {
        let buffer = self.buffer(kernel, bytes.len().max(least) as u64, usage)?;
        self.upload(kernel, &buffer, bytes).map(|()| buffer)
    }

    /// Waits until a submission is done, or all are. What fails here stays a fault of the device: of other
    /// submissions that are on their way nothing is known then.
    ///
    /// # Errors
    /// Where the device fails or does not answer in time.
    pub fn wait(&self, kernel: &'static str, submission: Option<wgpu::SubmissionIndex>) -> Result<(), BackendError> {
        let wait = wgpu::PollType::Wait { submission_index: submission, timeout: Some(DEADLINE) };
        // wgpu panics where the device is lost while it waits; a lost device is an error here.
        let polled = catch_unwind(AssertUnwindSafe(|| self.device.poll(wait)));
        self.sound(kernel)?;
        let message = match polled {
            Ok(Ok(_)) => return Ok(()),
            Ok(Err(wgpu::PollError::Timeout)) => format!("no answer for {} s", DEADLINE.as_secs()),
            Ok(Err(error)) => error.to_string(),
            Err(_) => "the device was lost".to_owned(),
        };
        note(&self.fault, message);
        self.sound(kernel)
    }

    /// Copies bytes to the start of a buffer.
    pub fn upload(&self, kernel: &'static str, buffer: &wgpu::Buffer, bytes: &[u8]) -> Result<(), BackendError> {
        let mut offset = 0;
        for chunk in bytes.chunks(CHUNK as usize) {
            self.queue.write_buffer(buffer, offset, chunk);
            offset += chunk.len() as u64;
            if bytes.len() as u64 > CHUNK {
                let submission = self.queue.submit([]);
                self.wait(kernel, Some(submission))?;
            }
        }
        self.sound(kernel)
    }

    /// Copies the start of a buffer to memory.
    pub fn download(&self, kernel: &'static str, buffer: &wgpu::Buffer, into: &mut [u8]) -> Result<(), BackendError> {
        if into.is_empty() {
            return Ok(());
        }
        let staging = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("staging"),
            size: CHUNK.min(into.len() as u64),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut offset = 0;
        for chunk in into.chunks_mut(CHUNK as usize) {
            let bytes = chunk.len() as u64;
            let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            encoder.copy_buffer_to_buffer(buffer, offset, &staging, 0, bytes);
            self.queue.submit([encoder.finish()]);
            let (sender, answer) = mpsc::channel();
            staging.map_async(wgpu::MapMode::Read, 0..bytes, move |result| drop(sender.send(result)));
            self.wait(kernel, None)?;
            // Only the callback proves that the copy was made: polls have been seen to return early.
            let failed = |message: String| BackendError::Device { kernel, message };
            let answered = answer.try_recv().map_err(|_| failed("the results did not come back".to_owned()))?;
            answered.map_err(|error| failed(error.to_string()))?;
            let view = staging.get_mapped_range(0..bytes).map_err(|error| failed(error.to_string()))?;
            chunk.copy_from_slice(&view);
            drop(view);
            staging.unmap();
            offset += bytes;
        }
        self.sound(kernel)
    }
}

/// Keeps the first fault: later ones tend to follow from it.
fn note(fault: &Mutex<Option<String>>, message: String) {
    fault.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(message);
}
