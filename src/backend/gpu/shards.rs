//! A cohort in device memory: runs of learners, each in its own buffers, as no buffer may be of any size.
//!
//! A learner's numbers do not depend on its place, so neither do they on where the cohort is cut.

use super::device::{Device, is_software};
use crate::backend::{BackendError, Cohort, memory};
use crate::env::workgroup::CohortData;
use crate::layout::{HyperParams, LearnerState, SkillShape, WorldUniform};
use std::ops::Range;
use wgpu::BufferUsages;

/// Label of the buffers that outlive a kernel.
const COHORT: &str = "train";
/// Memory that is taken for granted on a graphics card.
const CARD: u64 = 4 << 30;
/// Share of the host's free memory that a cohort may take.
const HOST_SHARE: f64 = 0.25;
/// Memory that is left to the rest of the machine where the device shares it.
const SPARE: u64 = 512 << 20;

/// Buffers that all learners read.
#[derive(Debug)]
pub(super) struct Common {
    pub(super) world: wgpu::Buffer,
    pub(super) tables: wgpu::Buffer,
    pub(super) skills: wgpu::Buffer,
    pub(super) bank: wgpu::Buffer,
}

impl Common {
    /// Uploads what all learners or robots share.
    ///
    /// # Errors
    /// Where the device has no room.
    pub(super) fn new(device: &Device, kernel: &'static str, shared: &CohortData) -> Result<Self, BackendError> {
        let world: &WorldUniform = &shared.floor.plan;
        let buffer = |bytes: &[u8], least, usage| device.filled(kernel, bytes, least, usage);
        Ok(Self {
            world: buffer(bytemuck::bytes_of(world), 0, BufferUsages::UNIFORM)?,
            tables: buffer(bytemuck::cast_slice(&shared.tables), 4, BufferUsages::STORAGE)?,
            skills: buffer(bytemuck::cast_slice(&shared.skills), size_of::<SkillShape>(), BufferUsages::STORAGE)?,
            bank: buffer(bytemuck::cast_slice(&shared.bank), 4, BufferUsages::STORAGE)?,
        })
    }
}

/// Some learners' buffers.
#[derive(Debug)]
pub(super) struct Shard {
    pub(super) learners: Range<usize>,
    pub(super) params: wgpu::Buffer,
    pub(super) states: wgpu::Buffer,
    pub(super) nets: wgpu::Buffer,
    pub(super) lessons: wgpu::Buffer,
    pub(super) rows: wgpu::Buffer,
}

/// Words of a cohort's vector that belong to some learners.
fn part(learners: &Range<usize>, stride: usize) -> Range<usize> {
    learners.start * stride..learners.end * stride
}

impl Shard {
    fn new(device: &Device, cohort: &Cohort, learners: Range<usize>) -> Result<Self, BackendError> {
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
        let buffer = |bytes: &[u8]| device.filled(COHORT, bytes, 0, usage);
        Ok(Self {
            params: buffer(bytemuck::cast_slice(&cohort.params[part(&learners, cohort.skills)]))?,
            states: buffer(bytemuck::cast_slice(&cohort.states[learners.clone()]))?,
            nets: buffer(bytemuck::cast_slice(&cohort.nets[part(&learners, cohort.nets_stride)]))?,
            lessons: buffer(bytemuck::cast_slice(&cohort.lessons[part(&learners, cohort.lessons_stride)]))?,
            rows: buffer(bytemuck::cast_slice(&cohort.rows[part(&learners, cohort.rows_stride)]))?,
            learners,
        })
    }

    /// Reads the states back.
    pub(super) fn read_cursors(&self, device: &Device, cohort: &mut Cohort) -> Result<(), BackendError> {
        let states = &mut cohort.states[self.learners.clone()];
        device.download(COHORT, &self.states, bytemuck::cast_slice_mut(states))
    }

    /// Reads everything back that kernels write.
    pub(super) fn read(&self, device: &Device, cohort: &mut Cohort) -> Result<(), BackendError> {
        self.read_cursors(device, cohort)?;
        let nets = &mut cohort.nets[part(&self.learners, cohort.nets_stride)];
        device.download(COHORT, &self.nets, bytemuck::cast_slice_mut(nets))?;
        let lessons = &mut cohort.lessons[part(&self.learners, cohort.lessons_stride)];
        device.download(COHORT, &self.lessons, bytemuck::cast_slice_mut(lessons))?;
        let rows = &mut cohort.rows[part(&self.learners, cohort.rows_stride)];
        device.download(COHORT, &self.rows, bytemuck::cast_slice_mut(rows))
    }
}

/// Learners that keep a device busy and fit its memory; wgpu does not tell how much a graphics card has.
///
/// # Errors
/// [`BackendError::NoRoom`] if not even one fits.
pub(super) fn fitting(device: &Device, bytes_per_learner: usize) -> Result<usize, BackendError> {
    // A software device's memory is the host's.
    let (most, device) = if is_software(&device.info) { (64, None) } else { (16_384, Some(CARD)) };
    let most = memory::fitting(device, 1.0, bytes_per_learner, most)?;
    // The host keeps a copy.
    memory::fitting(memory::free(), HOST_SHARE, bytes_per_learner, most)
}

/// Cuts a cohort into shards of at most `shard` learners and uploads them.
///
/// # Errors
/// [`BackendError::TooLarge`] where a learner exceeds a buffer, or the cohort the memory.
pub(super) fn upload(device: &Device, cohort: &Cohort, shard: usize) -> Result<Vec<Shard>, BackendError> {
    let learners = cohort.states.len();
    let too_large = |message: String| BackendError::TooLarge { learners, message };
    let limits = device.device.limits();
    let largest = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    for (bytes, what) in [
        (size_of_val(&cohort.shared.bank[..]), "the taught lessons"),
        (size_of_val(&cohort.shared.tables[..]), "the tables"),
    ] {
        if bytes as u64 > largest {
            return Err(too_large(format!("{what} take {bytes} bytes, a buffer holds {largest}")));
        }
    }
    let widest = [
        cohort.skills * size_of::<HyperParams>(),
        size_of::<LearnerState>(),
        4 * cohort.nets_stride,
        4 * cohort.lessons_stride,
        4 * cohort.rows_stride,
    ];
    let widest = widest.into_iter().max().unwrap_or(1).max(1) as u64;
    // Kernels count words in 32 bits, and a dispatch counts workgroups in 16.
    let most = (largest.min(u64::from(u32::MAX)) / widest).min(u64::from(super::dispatch_size::GROUPS)) as usize;
    if most == 0 {
        return Err(BackendError::NoRoom { bytes: widest, room: largest });
    }
    if is_software(&device.info) {
        let needed = bytes(cohort);
        // Software adapters take memory that is not there and fail later, by signal.
        if let Some(free) = memory::free()
            && needed + SPARE > free
        {
            let (needed, free) = (needed >> 20, free >> 20);
            return Err(too_large(format!("they take {needed} MiB, and {free} MiB of memory are free")));
        }
    }
    let most = most.min(shard);
    let scope = device.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let shards = (0..learners.div_ceil(most))
        .map(|shard| Shard::new(device, cohort, shard * most..learners.min((shard + 1) * most)))
        .collect::<Result<Vec<_>, _>>();
    if let Some(error) = pollster::block_on(scope.pop()) {
        return Err(too_large(error.to_string()));
    }
    shards
}

/// Bytes of a cohort on the device.
fn bytes(cohort: &Cohort) -> u64 {
    let words = cohort.nets.len() + cohort.lessons.len() + cohort.rows.len() + cohort.shared.bank.len();
    (4 * words + size_of_val(&cohort.params[..]) + size_of_val(&cohort.states[..])) as u64
}
