//! What the exported files consist of.

use crate::bench::{BenchError, write_file};
use safetensors::tensor::{Dtype, TensorView};
use serde_json::Value;
use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::Path;

/// What a tensor may hold.
pub(super) trait TensorElement: bytemuck::Pod {
    const DTYPE: Dtype;
}

impl TensorElement for f32 {
    const DTYPE: Dtype = Dtype::F32;
}

impl TensorElement for i32 {
    const DTYPE: Dtype = Dtype::I32;
}

impl TensorElement for u32 {
    const DTYPE: Dtype = Dtype::U32;
}

impl TensorElement for u8 {
    const DTYPE: Dtype = Dtype::U8;
}

/// One tensor with its line in the README.
struct ExportTensor {
    name: String,
    dtype: Dtype,
    shape: Vec<usize>,
    unit: &'static str,
    meaning: &'static str,
    bytes: Vec<u8>,
}

/// The tensors of a file, and the numbers that are none.
#[derive(Default)]
pub(super) struct ExportTensors {
    tensors: Vec<ExportTensor>,
    pub(super) numbers: Value,
}

impl ExportTensors {
    pub(super) fn add<T: TensorElement>(
        &mut self,
        name: &str,
        unit: &'static str,
        meaning: &'static str,
        shape: &[usize],
        values: &[T],
    ) {
        let (name, shape, bytes) = (name.to_owned(), shape.to_vec(), bytemuck::cast_slice(values).to_vec());
        self.tensors.push(ExportTensor { name, dtype: T::DTYPE, shape, unit, meaning, bytes });
    }

    /// Writes the file. The metadata has one entry: with several, their order would change from run to run.
    pub(super) fn write(&self, path: &Path) -> Result<(), BenchError> {
        let failed = |message: String| BenchError::Tensors { path: path.to_owned(), message };
        let mut views = Vec::with_capacity(self.tensors.len());
        for tensor in &self.tensors {
            let view = TensorView::new(tensor.dtype, tensor.shape.clone(), &tensor.bytes);
            views.push((&tensor.name, view.map_err(|error| failed(format!("`{}`: {error}", tensor.name)))?));
        }
        let metadata = HashMap::from([("skilltree".to_owned(), self.numbers.to_string())]);
        let bytes = safetensors::serialize(views, Some(metadata)).map_err(|error| failed(error.to_string()))?;
        write_file(path, &bytes)
    }

    /// The tensors and numbers, for the README.
    pub(super) fn table(&self) -> String {
        let mut text = String::from("| tensor | shape | type | unit | meaning |\n|---|---|---|---|---|\n");
        for ExportTensor { name, dtype, shape, unit, meaning, .. } in &self.tensors {
            let _ = writeln!(text, "| `{name}` | {shape:?} | {dtype:?} | {unit} | {meaning} |");
        }
        text.push_str("\nMetadata, JSON under the key `skilltree`:\n\n");
        for (name, value) in self.numbers.as_object().into_iter().flatten() {
            let _ = writeln!(text, "- `{name}` = {value}");
        }
        text
    }
}
