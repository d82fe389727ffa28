//! What made a learner diverge: the transition and the weight at which a number stopped being finite.
//!
//! Kernels only freeze such a learner where it is. Its lessons and nets are as they were then, so the host finds the
//! transition by the state and computes its Q-values and its target once more, with the kernels' twins.

use super::batch_group::LearnerId;
use crate::backend::Cohort;
use crate::backend::cpu::CPU;
use crate::config::plan::{ArmPlan, Plan};
use crate::env::workgroup::{Nets, Workgroup};
use crate::layout::{LANES, LESSON_HEADER_WORDS, PHASE_FAILED, SkillShape};
use crate::learn::lesson::choice_child;
use crate::math::functions::is_number;
use crate::run_folder::failures::{Divergence, Number, Transition, Weight};

/// Where a learner of the cohort has diverged, if it has.
pub fn divergence_of(plan: &Plan, cohort: &Cohort, index: usize, id: LearnerId) -> Option<Divergence> {
    let state = cohort.states[index];
    if state.phase != PHASE_FAILED {
        return None;
    }
    let arm = &plan.arms[id.arm];
    let number = state.skill as usize;
    // After the last step of a lesson nothing is left of it: then a weight was found, else a Q-value.
    let found_in_step = state.replay_left > 0;
    let what = if found_in_step {
        "a Q-value of a replayed step is not finite"
    } else {
        "a weight is not finite after the last replayed step"
    };
    Some(Divergence {
        arm: arm.name.clone(),
        point: arm.point,
        seed: id.seed,
        skill: arm.skills[number].name.clone(),
        trial: state.trial,
        what: what.to_owned(),
        transition: (state.replay > 0).then(|| transition(arm, cohort, index)),
        weight: wild_weight(arm, cohort, index),
    })
}

/// The step in replay, or the last one that was.
fn transition(arm: &ArmPlan, cohort: &Cohort, index: usize) -> Transition {
    let state = cohort.states[index];
    let number = state.skill as usize;
    let skill = &cohort.shared.skills[number];
    let nets = &cohort.nets[index * cohort.nets_stride..][..cohort.nets_stride];
    let mut lessons = cohort.lessons[index * cohort.lessons_stride..][..cohort.lessons_stride].to_vec();
    let params = &cohort.params[index * cohort.skills..][..cohort.skills];
    let mut group = Workgroup {
        state,
        nets: Nets::Read(nets),
        lessons: &mut lessons,
        ..Workgroup::new(&cohort.shared, params, &CPU.hot)
    };
    let step = state.replay_left.saturating_sub(1);
    let mirrored = state.replay_mirrored == 1;
    let taught = state.replay_taught == 1;
    group.load_step(step as usize);
    group.encode(state.skill, mirrored);
    (group.forms.forward)(&mut group, state.skill);
    let target = group.td_target(LESSON_HEADER_WORDS + (step * skill.record_words) as usize);
    let first = if taught { skill.bank_offset } else { skill.memory_offset };
    let place = (state.replay_lesson - first) / skill.lesson_stride;
    let done = choice_child(group.record.choice) as usize;
    let child = if mirrored { skill.mirror_child[done] as usize } else { done };
    Transition {
        taught,
        lesson: if taught { place } else { trial_in(place, state.remembered, params[number].replay_capacity) },
        mirrored,
        step,
        child: arm.name_of(arm.skills[number].children[child]).to_owned(),
        record: bytemuck::cast_slice(std::slice::from_ref(&group.record))[..skill.record_words as usize].to_vec(),
        inputs: group.inputs[..skill.inputs as usize].iter().map(|value| Number(*value)).collect(),
        q: group.q[..skill.children as usize].iter().map(|value| Number(*value)).collect(),
        target: Number(target),
    }
}

/// The trial whose lesson stands in a slot of a memory of so many, after so many trials.
fn trial_in(slot: u32, remembered: u32, memory: u32) -> u32 {
    let latest = remembered.saturating_sub(1);
    latest - (latest % memory + memory - slot) % memory
}

/// The first weight of the skill in training that is not finite.
fn wild_weight(arm: &ArmPlan, cohort: &Cohort, index: usize) -> Option<Weight> {
    let number = cohort.states[index].skill as usize;
    let skill = &cohort.shared.skills[number];
    let base = index * cohort.nets_stride;
    let nets = &cohort.nets[base..base + cohort.nets_stride];
    (0..skill.nets).find_map(|net| {
        let first = skill.net_offset(net);
        let weights = &nets[first..first + skill.rows as usize * LANES];
        let place = weights.iter().position(|weight| !is_number(*weight))?;
        Some(named(arm, number, skill, net as usize, (place / LANES, place % LANES), weights[place]))
    })
}

/// A weight by the name that it has in the learner's file.
fn named(
    arm: &ArmPlan,
    number: usize,
    skill: &SkillShape,
    net: usize,
    (row, lane): (usize, usize),
    value: f32,
) -> Weight {
    let inputs = skill.inputs as usize;
    let outputs = skill.outputs as usize;
    let unit = lane as u32;
    // A net of its own for each child, or an output of one net.
    let (child, layer, index) = if row < inputs {
        (net, "0.weight", vec![unit, row as u32])
    } else if row == inputs {
        (net, "0.bias", vec![unit])
    } else if row <= inputs + outputs {
        (net + row - inputs - 1, "2.weight", vec![0, unit])
    } else {
        (net + lane.min(outputs - 1), "2.bias", vec![0])
    };
    let own = &arm.skills[number];
    let child = own.children.get(child).map_or("?", |child| arm.name_of(*child));
    Weight { tensor: format!("{}.q.{child}.{layer}", own.name), index, value: Number(value) }
}

#[cfg(test)]
mod tests {
    use super::trial_in;

    #[test]
    fn a_slot_holds_the_latest_trial_that_was_written_there() {
        for memory in 1..6 {
            for remembered in 1..20 {
                let mut slots = vec![None; memory as usize];
                for trial in 0..remembered {
                    slots[(trial % memory) as usize] = Some(trial);
                }
                for (slot, trial) in slots.iter().enumerate().filter_map(|(slot, trial)| Some((slot, (*trial)?))) {
                    assert_eq!(trial_in(slot as u32, remembered, memory), trial, "{slot} {remembered} {memory}");
                }
            }
        }
    }
}
