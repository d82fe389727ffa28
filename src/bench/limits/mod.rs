//! What one core of this machine can do at most, measured beside the work: arithmetic in registers, and the way to
//! and from caches and memory.
//!
//! Arithmetic is counted in lane-operations: one operation on one f32. A multiplication and an addition are two, as
//! the numerical contract forbids to fuse them; a comparison and the selection by its result are two.

mod probes;
mod vector;

use super::BenchError;
use super::clock::timed;
use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};
use vector::Instructions;

/// A limit of one core.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Limit {
    /// Multiplications, each followed by an addition, not fused; lane-operations per second.
    MultiplyAdd,
    /// Comparisons, each followed by a selection; lane-operations per second.
    CompareSelect,
    /// Reading 16 KiB again and again; bytes per second.
    NearRead,
    /// Reading and writing 16 KiB again and again; bytes read and bytes written per second.
    NearUpdate,
    /// Reading 256 KiB.
    FarRead,
    /// Reading and writing 256 KiB.
    FarUpdate,
    /// Reading 128 MiB.
    MemoryRead,
    /// Reading and writing 128 MiB.
    MemoryUpdate,
}

impl Limit {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::MultiplyAdd,
        Self::CompareSelect,
        Self::NearRead,
        Self::NearUpdate,
        Self::FarRead,
        Self::FarUpdate,
        Self::MemoryRead,
        Self::MemoryUpdate,
    ];

    /// What people read.
    pub fn text(self) -> &'static str {
        match self {
            Self::MultiplyAdd => "multiply, then add",
            Self::CompareSelect => "compare, then select",
            Self::NearRead => "read 16 KiB",
            Self::NearUpdate => "read and write 16 KiB",
            Self::FarRead => "read 256 KiB",
            Self::FarUpdate => "read and write 256 KiB",
            Self::MemoryRead => "read 128 MiB",
            Self::MemoryUpdate => "read and write 128 MiB",
        }
    }

    /// What its rate counts.
    pub fn unit(self) -> &'static str {
        match self {
            Self::MultiplyAdd | Self::CompareSelect => "lane-operations/s",
            _ => "bytes/s",
        }
    }
}

/// Measures limits; keeps the memory that it needs for that.
#[derive(Debug)]
pub struct Meter {
    instructions: Vec<Instructions>,
    memory: Vec<Line>,
}

/// As much as caches move at a time. Registers that cross its bounds would cost twice.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C, align(64))]
struct Line([f32; 16]);

/// f32 of the three sizes.
const NEAR: usize = 4 << 10;
const FAR: usize = 64 << 10;
const ALL: usize = 32 << 20;

impl Default for Meter {
    fn default() -> Self {
        Self { instructions: Instructions::all(), memory: vec![Line([1.0; 16]); ALL / 16] }
    }
}

impl Meter {
    /// One measurement of some 10 ms: operations or bytes per CPU-second of one thread, by the fastest of the machine's
    /// instruction sets.
    ///
    /// # Errors
    /// Those of timing.
    pub fn rate(&mut self, limit: Limit) -> Result<f64, BenchError> {
        let mut best = 0.0_f64;
        for number in 0..self.instructions.len() {
            best = best.max(self.measure(limit, self.instructions[number])?);
        }
        Ok(best)
    }

    fn measure(&mut self, limit: Limit, instructions: Instructions) -> Result<f64, BenchError> {
        let memory: &mut [f32] = bytemuck::cast_slice_mut(&mut self.memory);
        let (count, span) = timed(|| {
            Ok(match limit {
                Limit::MultiplyAdd => probes::run_multiply_add(instructions, 1 << 19),
                Limit::CompareSelect => probes::run_compare_select(instructions, 1 << 18),
                Limit::NearRead => probes::run_read(instructions, &memory[..NEAR], 1 << 15),
                Limit::NearUpdate => probes::run_update(instructions, &mut memory[..NEAR], 1 << 15),
                Limit::FarRead => probes::run_read(instructions, &memory[..FAR], 1 << 11),
                Limit::FarUpdate => probes::run_update(instructions, &mut memory[..FAR], 1 << 11),
                Limit::MemoryRead => probes::run_read(instructions, memory, 1),
                Limit::MemoryUpdate => probes::run_update(instructions, memory, 1),
            })
        })?;
        Ok(count as f64 / span.cpu)
    }
}
