//! A learner's nets as safetensors, named so that PyTorch loads them.
//!
//! The net of child `move+12` in skill `dock` is `torch.nn.Sequential(Linear(I, H), Tanh(), Linear(H, 1), Tanh())`;
//! its tensors are `dock.q.move+12.0.weight` (H by I), `.0.bias` (H), `.2.weight` (1 by H) and `.2.bias` (1).

use super::RecordError;
use safetensors::tensor::{Dtype, SafeTensors, TensorView};
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// Key of the file metadata. Its value is JSON with the caller's entries: safetensors keeps metadata in a hash map,
/// whose order changes from run to run, so more than one entry would make the bytes differ.
const METADATA_KEY: &str = "skilltree";

/// The net of one child: `tanh(w2 tanh(w1 x + b1) + b2)`.
#[derive(Debug, Clone, PartialEq)]
pub struct NetWeights {
    /// Name of the child whose value the net gives.
    pub child: String,
    /// Number of inputs.
    pub inputs: usize,
    /// Number of hidden units.
    pub hidden: usize,
    /// First layer, `[hidden][inputs]`.
    pub w1: Vec<f32>,
    /// First layer's biases, `[hidden]`.
    pub b1: Vec<f32>,
    /// Second layer, `[1][hidden]`.
    pub w2: Vec<f32>,
    /// Second layer's bias.
    pub b2: f32,
}

/// The nets of one skill.
#[derive(Debug, Clone, PartialEq)]
pub struct SkillWeights {
    /// Name of the skill.
    pub skill: String,
    /// One net per child. In files they are ordered by name.
    pub nets: Vec<NetWeights>,
}

/// Bytes of a safetensors file with all skills of one learner; the same for the same weights and metadata. A learner
/// that diverged is written as it is, so that it can be looked into; reading it back is an error.
///
/// # Errors
/// [`RecordError::Invalid`] if a net's sizes disagree or a name comes twice.
pub fn write_weights(skills: &[SkillWeights], metadata: &BTreeMap<String, String>) -> Result<Vec<u8>, RecordError> {
    let mut tensors: BTreeMap<String, (Vec<usize>, Vec<u8>)> = BTreeMap::new();
    for skill in skills {
        for net in &skill.nets {
            let name = format!("{}.q.{}", skill.skill, net.child);
            let problem = |text: &str| Err(RecordError::invalid(&name, text));
            if net.w1.len() != net.inputs * net.hidden || net.b1.len() != net.hidden || net.w2.len() != net.hidden {
                return problem("the net's sizes disagree");
            }
            let layers = [
                ("0.weight", vec![net.hidden, net.inputs], net.w1.as_slice()),
                ("0.bias", vec![net.hidden], &net.b1),
                ("2.weight", vec![1, net.hidden], &net.w2),
                ("2.bias", vec![1], std::slice::from_ref(&net.b2)),
            ];
            for (layer, shape, values) in layers {
                let bytes = values.iter().flat_map(|value| value.to_le_bytes()).collect();
                if tensors.insert(format!("{name}.{layer}"), (shape, bytes)).is_some() {
                    return problem("the net comes twice");
                }
            }
        }
    }
    let entries = serde_json::to_string(metadata).map_err(invalid)?;
    let views = tensors.iter().map(|(name, (shape, bytes))| {
        Ok((name.as_str(), TensorView::new(Dtype::F32, shape.clone(), bytes).map_err(invalid)?))
    });
    let views = views.collect::<Result<Vec<_>, RecordError>>()?;
    safetensors::serialize(views, Some(HashMap::from([(METADATA_KEY.to_owned(), entries)]))).map_err(invalid)
}

fn invalid(error: impl std::error::Error) -> RecordError {
    RecordError::invalid("weights", error.to_string())
}

/// Reads back what [`write_weights`] wrote: skills and nets ordered by name, and the metadata. `path` is only for
/// messages.
///
/// # Errors
/// [`RecordError::Damaged`] for anything else, weights that are not finite among them.
pub fn read_weights(bytes: &[u8], path: &Path) -> Result<(Vec<SkillWeights>, BTreeMap<String, String>), RecordError> {
    let damaged = |problem: String| RecordError::damaged(path, problem);
    let (_, header) = SafeTensors::read_metadata(bytes).map_err(|error| damaged(error.to_string()))?;
    let tensors = SafeTensors::deserialize(bytes).map_err(|error| damaged(error.to_string()))?;
    let entries = header.metadata().as_ref().and_then(|entries| entries.get(METADATA_KEY));
    let entries = entries.ok_or_else(|| damaged(format!("no metadata entry `{METADATA_KEY}`")))?;
    let metadata = serde_json::from_str(entries).map_err(|error| damaged(error.to_string()))?;
    let mut nets: BTreeMap<(&str, &str), BTreeMap<&str, TensorView<'_>>> = BTreeMap::new();
    for (name, tensor) in tensors.iter() {
        let (skill, child, layer) = split_name(name).ok_or_else(|| damaged(format!("unknown tensor `{name}`")))?;
        nets.entry((skill, child)).or_default().insert(layer, tensor);
    }
    let mut skills: Vec<SkillWeights> = Vec::new();
    for ((skill, child), layers) in &nets {
        let net = net_of(child, layers).map_err(|problem| damaged(format!("net `{skill}.q.{child}`: {problem}")))?;
        match skills.last_mut().filter(|last| last.skill == *skill) {
            Some(last) => last.nets.push(net),
            None => skills.push(SkillWeights { skill: (*skill).into(), nets: vec![net] }),
        }
    }
    Ok((skills, metadata))
}

/// `dock.q.move+12.0.weight` is skill `dock`, child `move+12`, layer `0.weight`.
fn split_name(name: &str) -> Option<(&str, &str, &str)> {
    let (skill, rest) = name.split_once(".q.")?;
    let layer = ["0.weight", "0.bias", "2.weight", "2.bias"].into_iter().find(|layer| rest.ends_with(layer))?;
    Some((skill, rest.strip_suffix(layer)?.strip_suffix('.')?, layer))
}

fn net_of(child: &str, layers: &BTreeMap<&str, TensorView<'_>>) -> Result<NetWeights, String> {
    let layer = |name: &str| layers.get(name).ok_or_else(|| format!("no `{name}`"));
    let [hidden, inputs] = layer("0.weight")?.shape() else { return Err("`0.weight` is not a matrix".into()) };
    let values = |name: &str, shape: &[usize]| -> Result<Vec<f32>, String> {
        let tensor = layer(name)?;
        if tensor.dtype() != Dtype::F32 || tensor.shape() != shape {
            return Err(format!("`{name}` is not an F32 tensor of shape {shape:?}"));
        }
        let (numbers, _) = tensor.data().as_chunks::<4>();
        let numbers: Vec<f32> = numbers.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
        if numbers.iter().all(|number| number.is_finite()) {
            Ok(numbers)
        } else {
            Err(format!("`{name}` is not finite"))
        }
    };
    Ok(NetWeights {
        child: child.into(),
        inputs: *inputs,
        hidden: *hidden,
        w1: values("0.weight", &[*hidden, *inputs])?,
        b1: values("0.bias", &[*hidden])?,
        w2: values("2.weight", &[1, *hidden])?,
        b2: values("2.bias", &[1])?.into_iter().next().ok_or("`2.bias` is empty")?,
    })
}
