//! The benchmarks' inputs and results for programs in other languages: the same work, to be done and checked there.
//!
//! [`export`] writes three files into a folder. `simulate.safetensors` holds robots, a floor, the action of every
//! robot at every step, the noise of every step, and what our robots read after each step. `replay.safetensors` holds
//! taught lessons, the initial nets of learners, their hyper-parameters, and our weights after one pass over the
//! lessons and after all of them. `README.md` names every tensor with its shape, type, unit and meaning, and states
//! the formulas; it is made from the same table as the files.
//!
//! Numbers that are no tensors stand in both files' metadata as JSON under the key `skilltree`.

mod replay;
mod robot_steps;
mod tensor;

use super::{BenchError, make_folder, write_file};
use safetensors::tensor::TensorView;
use serde_json::{Map, Value};
use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::Path;
use tensor::ExportTensor;

/// Learners of `replay.safetensors`, unless told otherwise.
pub const LEARNERS: u32 = 256;

/// Writes the files into `folder`, which is made if it is not there.
///
/// # Errors
/// Where a file cannot be written, or two executors leave different bytes.
pub fn export(folder: &Path, learners: u32) -> Result<(), BenchError> {
    make_folder(folder)?;
    let (walk, numbers) = robot_steps::robot_steps()?;
    write(&folder.join("simulate.safetensors"), &walk, &numbers)?;
    let (replay, params) = replay::replay(learners)?;
    write(&folder.join("replay.safetensors"), &replay, &params)?;
    let readme = include_str!("README.md")
        .replace("{simulate}", &table(&walk, &numbers))
        .replace("{replay}", &table(&replay, &params));
    write_file(&folder.join("README.md"), readme.as_bytes())
}

/// Writes one file. The metadata has one entry: with several, their order would change from run to run.
fn write(path: &Path, tensors: &[ExportTensor], numbers: &Map<String, Value>) -> Result<(), BenchError> {
    let failed = |message: String| BenchError::Tensors { path: path.to_owned(), message };
    let mut views = Vec::with_capacity(tensors.len());
    for tensor in tensors {
        let view = TensorView::new(tensor.dtype, tensor.shape.clone(), &tensor.bytes);
        views.push((tensor.name, view.map_err(|error| failed(format!("`{}`: {error}", tensor.name)))?));
    }
    let metadata = HashMap::from([("skilltree".to_owned(), Value::Object(numbers.clone()).to_string())]);
    let bytes = safetensors::serialize(views, Some(metadata)).map_err(|error| failed(error.to_string()))?;
    write_file(path, &bytes)
}

/// The tensors and numbers of a file, for the README.
fn table(tensors: &[ExportTensor], numbers: &Map<String, Value>) -> String {
    let mut text = String::from("| tensor | shape | type | unit | meaning |\n|---|---|---|---|---|\n");
    for ExportTensor { name, dtype, shape, unit, meaning, .. } in tensors {
        let _ = writeln!(text, "| `{name}` | {shape:?} | {dtype:?} | {unit} | {meaning} |");
    }
    text.push_str("\nMetadata, JSON under the key `skilltree`:\n\n");
    for (name, value) in numbers {
        let _ = writeln!(text, "- `{name}` = {value}");
    }
    text
}
