//! The GPU backend: the kernels on any adapter of Vulkan, Metal or DX12.

pub mod adapter;
pub mod canary;
pub mod conformance;
pub mod device;
pub mod pipeline;
pub mod probe;
pub mod source;
pub mod spirv;
