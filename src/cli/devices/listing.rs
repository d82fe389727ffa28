//! What `skilltree devices` says.

use serde::Serialize;

/// What is known of all adapters.
#[derive(Debug, Serialize)]
pub(super) struct DeviceList {
    pub(super) adapters: Vec<AdapterReport>,
    /// Why there is none.
    pub(super) none: Option<String>,
}

/// What is known of one adapter.
#[derive(Debug, Serialize)]
pub(super) struct AdapterReport {
    pub(super) name: String,
    pub(super) backend: String,
    pub(super) driver: String,
    pub(super) kind: String,
    pub(super) software: bool,
    pub(super) max_buffer_bytes: u64,
    pub(super) max_binding_bytes: u64,
    pub(super) max_storage_buffers: u32,
    pub(super) takes_spirv: bool,
    pub(super) exact: bool,
    /// Functions and shapes of which each answer was compared.
    #[serde(skip)]
    pub(super) compared: String,
    /// The first difference, or what failed.
    pub(super) reason: Option<String>,
    pub(super) subnormals_kept: Option<bool>,
    pub(super) loop_budget: Option<u32>,
}
