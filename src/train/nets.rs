//! A learner's nets: their weights in a row, as parts keep them, and by name, as files hold them.

use super::allocate::Shape;
use super::result::LearnerResult;
use crate::config::plan::{ArmPlan, Plan};
use crate::layout::{LANES, SkillShape};
use crate::run_folder::RecordError;
use crate::run_folder::weights::{NetWeights, SkillWeights, write_weights};
use std::collections::BTreeMap;

/// The weights of a learner's nets, without what the optimiser keeps beside them.
pub(super) fn pack(nets: &[f32], skills: &[SkillShape]) -> Vec<f32> {
    places(skills).flat_map(|(at, slab)| &nets[at..at + slab]).copied().collect()
}

/// A learner's nets from their weights; what the optimiser keeps is 0.
pub fn unpack(weights: &[f32], skills: &[SkillShape], stride: usize) -> Vec<f32> {
    let mut nets = vec![0.0; stride];
    let mut rest = weights;
    for (at, slab) in places(skills) {
        let (own, others) = rest.split_at(slab.min(rest.len()));
        nets[at..at + own.len()].copy_from_slice(own);
        rest = others;
    }
    nets
}

/// Number of the weights of a learner's nets.
pub(super) fn weight_count(skills: &[SkillShape]) -> usize {
    places(skills).map(|(_, slab)| slab).sum()
}

/// First word and size of the weights of every net. A mirror image has none of its own.
fn places(skills: &[SkillShape]) -> impl Iterator<Item = (usize, usize)> {
    skills.iter().filter(|skill| skill.mirrored == 0).flat_map(|skill| {
        let slab = skill.rows as usize * LANES;
        (0..skill.nets as usize).map(move |net| (skill.net_offset(net as u32), slab))
    })
}

/// Path and bytes of the file with all nets of a learner.
pub(super) fn file(plan: &Plan, shape: &Shape, result: &LearnerResult) -> Result<(String, Vec<u8>), RecordError> {
    let arm = &plan.arms[result.id.arm];
    let nets = unpack(&result.weights, &shape.skills, shape.nets_stride);
    let mut skills = Vec::new();
    for (skill, own) in arm.skills.iter().zip(&shape.skills) {
        // A mirror image has no nets of its own, nor has what the planner decides.
        if skill.mirror.is_some() || skill.oracle {
            continue;
        }
        let hidden = skill.params.hidden as usize;
        let inputs = own.inputs as usize;
        let outputs = own.outputs as usize;
        let mut written = Vec::new();
        for (number, child) in skill.children.iter().enumerate() {
            let (net, output) = if own.nets == 1 { (0, number) } else { (number, 0) };
            let rows = &nets[own.net_offset(net as u32)..].as_chunks::<LANES>().0[..own.rows as usize];
            written.push(NetWeights {
                child: arm.name_of(*child).to_owned(),
                inputs,
                hidden,
                w1: (0..hidden).flat_map(|unit| (0..inputs).map(move |input| rows[input][unit])).collect(),
                b1: rows[inputs][..hidden].to_vec(),
                w2: rows[inputs + 1 + output][..hidden].to_vec(),
                b2: rows[inputs + 1 + outputs][output],
            });
        }
        skills.push(SkillWeights { skill: skill.name.clone(), nets: written });
    }
    let mut metadata = BTreeMap::from([
        ("arm".to_owned(), arm.name.clone()),
        ("seed".to_owned(), result.id.seed.to_string()),
        ("run_seed".to_owned(), plan.run_seed.to_string()),
        ("activation".to_owned(), "tanh".to_owned()),
        ("transitions".to_owned(), result.updates.to_string()),
        ("thresholds".to_owned(), thresholds(arm, result)),
    ]);
    let mut name = arm.name.clone();
    if let Some(sweep) = &plan.sweep {
        name = format!("{name}-p{}", arm.point);
        metadata.insert("point".to_owned(), arm.point.to_string());
        metadata.insert("values".to_owned(), sweep.describe(arm.point as usize));
    }
    let path = format!("skills/{name}-{}.safetensors", result.id.seed);
    Ok((path, write_weights(&skills, &metadata)?))
}

/// The root's thresholds as `child=value`, with commas between; empty for a root without any.
fn thresholds(arm: &ArmPlan, result: &LearnerResult) -> String {
    let Some(root) = arm.skills.last() else { return String::new() };
    let own = root.children.iter().zip(&root.applicable).zip(&result.thresholds);
    // Only skills have thresholds.
    let text =
        own.filter_map(|((child, threshold), value)| threshold.map(|_| format!("{}={value}", arm.name_of(*child))));
    text.collect::<Vec<_>>().join(",")
}
