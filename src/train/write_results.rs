//! From learners' results to the files of a run folder.

use super::batch::unpack;
use super::batch_group::{BatchGroup, LearnerId, group_of};
use super::callbacks::{Callbacks, Interrupted, Signal};
use super::committed::Parts;
use super::observation;
use super::result::LearnerResult;
use super::schedule::trials_of;
use super::trajectories::trajectories;
use crate::backend::Backend;
use crate::config::plan::Plan;
use crate::layout::{LANES, TRIAL_WORDS};
use crate::run_folder::failures::{self, write_failures};
use crate::run_folder::sweep::{self, write_sweep};
use crate::run_folder::tables::{EVALUATIONS, NO_ROOM, PLANNER, TRAINED, TRIALS, TableWriter};
use crate::run_folder::trajectories::{self, write_trajectories};
use crate::run_folder::weights::{NetWeights, SkillWeights, write_weights};
use crate::run_folder::{EvaluationRow, Provenance, RecordError, RunFolder, Sums, TrialRow, sensor_readings};
use crate::world::World;
use glam::Vec2;
use std::collections::BTreeMap;

/// Writes the results of an experiment, all of whose learners are finished, and the manifest: one learner after
/// another, so that the memory it takes does not grow with their number. What it did before it was stopped or killed
/// does no harm: the parts stay until the manifest is there.
///
/// # Errors
/// Where the folder or the device fails, or the callbacks stop it.
pub fn finish(
    plan: &Plan,
    groups: &[BatchGroup],
    folder: &RunFolder,
    parts: &mut Parts,
    backend: &mut dyn Backend,
    callbacks: &mut dyn Callbacks,
    provenance: impl FnOnce(usize) -> Provenance,
) -> Result<(), Interrupted> {
    let results = Results { plan, groups };
    let mut finishing = folder.finishing()?;
    let file = finishing.begin(TRIALS)?;
    let mut trials = TableWriter::new(&folder.dir().join(TRIALS), file)?;
    let file = finishing.begin(EVALUATIONS)?;
    let mut evaluations = TableWriter::new(&folder.dir().join(EVALUATIONS), file)?;
    let (mut failures, mut examples) = (Vec::new(), Vec::new());
    let all = plan.arms.iter().map(trials_of).sum::<u64>() * plan.seeds.len() as u64;
    for arm in 0..plan.arms.len() {
        for seed in &plan.seeds {
            if callbacks.progress(all) == Signal::Stop {
                return Err(Interrupted::Stopped);
            }
            let id = LearnerId { arm, seed: *seed };
            let Some(result) = parts.result(folder, id)? else {
                let problem = format!("the results of arm `{}`, seed {seed}, are gone", plan.arms[arm].name);
                let hint = "give the same command again: these learners are trained anew";
                return Err(RecordError::Damaged { path: folder.dir().join("parts"), problem, hint }.into());
            };
            results.trial_rows(result).try_for_each(|row| trials.push(row))?;
            results.evaluation_rows(result).try_for_each(|row| evaluations.push(row))?;
            let (name, nets) = results.weights(result)?;
            finishing.add(&name, &nets)?;
            failures.extend(result.divergence.clone());
            if seed == &plan.seeds[0] && !plan.continues(arm) && result.divergence.is_none() {
                examples.extend(trajectories(plan, group_of(groups, arm), result));
            }
        }
    }
    results.bound_rows().into_iter().try_for_each(|row| evaluations.push(row))?;
    finishing.end(TRIALS, trials.finish()?)?;
    finishing.end(EVALUATIONS, evaluations.finish()?)?;
    finishing
        .add(sensor_readings::FILE, &sensor_readings::write_places(&observation::places(plan.world(), backend)?)?)?;
    finishing.add(trajectories::FILE, &write_trajectories(&examples)?)?;
    if let Some(sweep) = &plan.sweep {
        finishing.add(sweep::FILE, &write_sweep(sweep)?)?;
    }
    if !failures.is_empty() {
        finishing.add(failures::FILE, &write_failures(&failures)?)?;
    }
    finishing.complete(provenance(failures.len()))?;
    Ok(())
}

/// What the rows and the nets of an experiment are called.
struct Results<'a> {
    plan: &'a Plan,
    groups: &'a [BatchGroup],
}

impl Results<'_> {
    fn trial_rows(&self, result: &LearnerResult) -> impl Iterator<Item = TrialRow> {
        let (arm, seed) = (&self.plan.arms[result.id.arm], result.id.seed);
        result.rows.as_chunks::<TRIAL_WORDS>().0.iter().map(move |row| {
            let [skill, trial, actions, steps, reward, success, collisions, taught] = *row;
            TrialRow {
                arm: arm.name.clone(),
                point: arm.point,
                seed,
                skill: arm.skills[skill as usize].name.clone(),
                trial,
                actions,
                steps,
                reward: f32::from_bits(reward),
                success: success == 1,
                collisions,
                taught: taught == 1,
            }
        })
    }

    fn evaluation_rows(&self, result: &LearnerResult) -> impl Iterator<Item = EvaluationRow> {
        let arm = &self.plan.arms[result.id.arm];
        result.tests.iter().flat_map(move |test| {
            let alteration = test.variant.checked_sub(1).map(|number| &self.plan.alterations[number as usize]);
            let row = EvaluationRow {
                arm: arm.name.clone(),
                point: arm.point,
                seed: result.id.seed,
                skill: arm.skills[test.skill as usize].name.clone(),
                trials: test.trials,
                actions: test.actions,
                variant: alteration.map_or(TRAINED, |alteration| &alteration.name).to_owned(),
                ..EvaluationRow::default()
            };
            let world = alteration.and_then(|alteration| alteration.world).unwrap_or(arm.world);
            by_room(row, &self.plan.worlds[world].world, &test.rooms)
        })
    }

    /// The planner's name for a group: each group has its own bound, at its first point.
    fn bound_name(&self, group: usize) -> String {
        let arm = |group: usize| &self.plan.arms[self.groups[group].arms[0]].name;
        if arm(group) == arm(0) { PLANNER.to_owned() } else { format!("{PLANNER}-{}", arm(group)) }
    }

    /// The planner's own tests, by name and point.
    fn bound_rows(&self) -> Vec<EvaluationRow> {
        let names: Vec<String> = (0..self.groups.len()).map(|number| self.bound_name(number)).collect();
        let mut rows = Vec::new();
        for (name, group) in names.iter().zip(self.groups) {
            let arm = &self.plan.arms[group.arms[0]];
            let world = self.plan.world_of(arm);
            for (skill, tests) in arm.skills.iter().zip(&group.bounds) {
                let mut rooms = vec![Sums::default(); world.rooms.len() + 1];
                for test in tests.iter().flatten() {
                    let start = Vec2::new(test.start.x, test.start.y);
                    rooms[world.room_of(start).unwrap_or(world.rooms.len())] += Sums {
                        episodes: 1,
                        successes: u32::from(test.achieved()),
                        steps: test.steps(),
                        collisions: test.collisions(),
                        reward: f64::from(test.reward()),
                        returned: f64::from(test.returned),
                    };
                }
                let row = EvaluationRow {
                    arm: name.clone(),
                    point: arm.point,
                    skill: skill.name.clone(),
                    variant: TRAINED.to_owned(),
                    ..EvaluationRow::default()
                };
                rows.extend(by_room(row, world, &rooms));
            }
        }
        // Groups come in the order of their first arms.
        rows.sort_by_key(|row| (names.iter().position(|name| *name == row.arm), row.point));
        rows
    }

    fn weights(&self, result: &LearnerResult) -> Result<(String, Vec<u8>), RecordError> {
        let arm = &self.plan.arms[result.id.arm];
        let shape = &group_of(self.groups, result.id.arm).shape;
        let nets = unpack(&result.weights, &shape.skills, shape.nets_stride);
        let mut skills = Vec::new();
        for (skill, plan) in arm.skills.iter().zip(&shape.skills) {
            // A mirror image has no nets of its own, nor has what the planner decides.
            if skill.mirror.is_some() || skill.oracle {
                continue;
            }
            let hidden = skill.params.hidden as usize;
            let inputs = plan.inputs as usize;
            let outputs = plan.outputs as usize;
            let mut written = Vec::new();
            for (number, child) in skill.children.iter().enumerate() {
                let (net, output) = if plan.nets == 1 { (0, number) } else { (number, 0) };
                let rows = &nets[plan.net_offset(net as u32)..].as_chunks::<LANES>().0[..plan.rows as usize];
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
            ("run_seed".to_owned(), self.plan.run_seed.to_string()),
            ("activation".to_owned(), "tanh".to_owned()),
            ("transitions".to_owned(), result.updates.to_string()),
            ("thresholds".to_owned(), self.thresholds(result)),
        ]);
        let mut name = arm.name.clone();
        if let Some(sweep) = &self.plan.sweep {
            name = format!("{name}-p{}", arm.point);
            metadata.insert("point".to_owned(), arm.point.to_string());
            metadata.insert("values".to_owned(), sweep.describe(arm.point as usize));
        }
        let path = format!("skills/{name}-{}.safetensors", result.id.seed);
        Ok((path, write_weights(&skills, &metadata)?))
    }

    /// The root's thresholds as `child=value`, with commas between; empty for a root without any.
    fn thresholds(&self, result: &LearnerResult) -> String {
        let arm = &self.plan.arms[result.id.arm];
        let Some(root) = arm.skills.last() else { return String::new() };
        let own = root.children.iter().zip(&root.applicable).zip(&result.thresholds);
        // Only skills have thresholds.
        let text =
            own.filter_map(|((child, threshold), value)| threshold.map(|_| format!("{}={value}", arm.name_of(*child))));
        text.collect::<Vec<_>>().join(",")
    }
}

/// A row for each room of a world in which test trials began.
fn by_room(row: EvaluationRow, world: &World, rooms: &[Sums]) -> Vec<EvaluationRow> {
    let begun = rooms.iter().enumerate().filter(|(_, sums)| sums.episodes > 0);
    let each = begun.map(|(room, sums)| {
        let room = world.rooms.get(room).map_or(NO_ROOM, |room| &room.name).to_owned();
        EvaluationRow { room, ..row.clone() }.with_sums(*sums)
    });
    each.collect()
}
