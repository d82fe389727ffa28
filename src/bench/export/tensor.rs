//! What the exported files consist of.

use safetensors::tensor::Dtype;
use serde_json::{Map, Value};

/// Robots of `simulate.safetensors`.
pub(super) const ROBOTS: u32 = 4096;
/// Steps of each.
pub(super) const STEPS: u32 = 16;
/// Passes over each learner's lessons.
pub(super) const PASSES: u32 = 30;

/// Name, unit and meaning of a tensor.
pub(super) type TensorText = (&'static str, &'static str, &'static str);

/// One tensor with its line in the README.
pub(super) struct ExportTensor {
    pub(super) name: &'static str,
    pub(super) dtype: Dtype,
    pub(super) shape: Vec<usize>,
    pub(super) unit: &'static str,
    pub(super) meaning: &'static str,
    pub(super) bytes: Vec<u8>,
}

impl ExportTensor {
    pub(super) fn new<T: bytemuck::Pod>(
        (name, unit, meaning): TensorText,
        dtype: Dtype,
        shape: &[usize],
        values: &[T],
    ) -> Self {
        Self { name, dtype, shape: shape.to_vec(), unit, meaning, bytes: bytemuck::cast_slice(values).to_vec() }
    }

    pub(super) fn floats(words: TensorText, shape: &[usize], values: &[f32]) -> Self {
        Self::new(words, Dtype::F32, shape, values)
    }

    pub(super) fn codes(words: TensorText, shape: &[usize], values: &[i32]) -> Self {
        Self::new(words, Dtype::I32, shape, values)
    }
}

/// The entries of a JSON object.
pub(super) fn object(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(map) => map,
        _ => Map::new(),
    }
}
