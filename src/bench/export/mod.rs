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
use std::path::Path;

/// Learners of `replay.safetensors`, unless told otherwise.
pub const LEARNERS: u32 = 256;

/// Writes the files into `folder`, which is made if it is not there.
///
/// # Errors
/// Where a file cannot be written, or two executors leave different bytes.
pub fn export(folder: &Path, learners: u32) -> Result<(), BenchError> {
    make_folder(folder)?;
    let simulate = robot_steps::robot_steps()?;
    simulate.write(&folder.join("simulate.safetensors"))?;
    let replay = replay::replay(learners)?;
    replay.write(&folder.join("replay.safetensors"))?;
    let readme =
        include_str!("README.md").replace("{simulate}", &simulate.table()).replace("{replay}", &replay.table());
    write_file(&folder.join("README.md"), readme.as_bytes())
}
