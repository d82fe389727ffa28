//! From learners' results to the files of a run folder.

use super::batch::unpack;
use super::batch_group::{Group, LearnerId};
use super::committed::Parts;
use super::observation;
use super::pretraining::group_of;
use super::result::{LearnerResult, RoomSums};
use super::run::{Observer, RunError};
use super::trajectories::trajectories;
use crate::backend::Backend;
use crate::config::plan::Plan;
use crate::layout::{LANES, ROW_WORDS};
use crate::qnet::forward::net_of;
use crate::run_folder::failures::{self, write_failures};
use crate::run_folder::sweep::{self, write_sweep};
use crate::run_folder::tables::{EVALUATIONS, EvaluationRow, Names, PLANNER, TRAINED, TRIALS, TableWriter, TrialRow};
use crate::run_folder::trajectories::{self, write_trajectories};
use crate::run_folder::weights::{NetWeights, SkillWeights, write_weights};
use crate::run_folder::{Provenance, RecordError, RunFolder, sensor_readings};
use crate::world::World;
use glam::Vec2;
use std::collections::BTreeMap;

/// Room of a test that starts in none.
const NO_ROOM: &str = "none";

/// A row without its key and its sums.
const BLANK: EvaluationRow = EvaluationRow {
    arm: 0,
    point: 0,
    seed: 0,
    skill: 0,
    trials: 0,
    actions: 0,
    variant: 0,
    room: 0,
    episodes: 0,
    successes: 0,
    steps: 0,
    reward: 0.0,
    returned: 0.0,
    collisions: 0,
};

/// Writes the results of an experiment, all of whose learners are finished, and the manifest: one learner after
/// another, so that the memory it takes does not grow with their number. What it did before it was stopped or killed
/// does no harm: the parts stay until the manifest is there.
///
/// # Errors
/// Where the folder or the device fails, or the observer stops it.
pub fn finish(
    plan: &Plan,
    groups: &[Group],
    folder: &RunFolder,
    parts: &mut Parts,
    backend: &mut dyn Backend,
    observer: &mut dyn Observer,
    provenance: impl FnOnce(usize) -> Provenance,
) -> Result<(), RunError> {
    let results = Results { plan, groups };
    let names = results.names();
    let arms = results.arm_indices();
    let mut finishing = folder.finishing()?;
    let file = finishing.begin(TRIALS)?;
    let mut trials = TableWriter::trials(&folder.dir().join(TRIALS), &names, file)?;
    let file = finishing.begin(EVALUATIONS)?;
    let mut evaluations = TableWriter::evaluations(&folder.dir().join(EVALUATIONS), &names, file)?;
    let (mut failures, mut examples) = (Vec::new(), Vec::new());
    let learners = plan.arms.len() * plan.seeds.len();
    for (arm, index) in arms.iter().enumerate() {
        let skills = results.skill_indices(&names, arm);
        for seed in &plan.seeds {
            if observer.stop() {
                return Err(RunError::Stopped { dir: folder.dir().into(), finished: learners, learners });
            }
            let id = LearnerId { arm, seed: *seed };
            let Some(result) = parts.result(folder, id)? else {
                let problem = format!("the results of arm `{}`, seed {seed}, are gone", plan.arms[arm].name);
                let hint = "give the same command again: these learners are trained anew";
                return Err(RecordError::Damaged { path: folder.dir().join("parts"), problem, hint }.into());
            };
            results.trial_rows(result, *index, &skills).try_for_each(|row| trials.push(row))?;
            results.evaluation_rows(result, *index, &skills, &names).try_for_each(|row| evaluations.push(row))?;
            let (name, nets) = results.weights(result)?;
            finishing.add(&name, &nets)?;
            failures.extend(result.failure.clone());
            if seed == &plan.seeds[0] && !plan.continues(arm) && result.failure.is_none() {
                examples.extend(trajectories(plan, group_of(groups, arm), result));
            }
        }
    }
    results.bound_rows(&names).into_iter().try_for_each(|row| evaluations.push(row))?;
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
    groups: &'a [Group],
}

impl Results<'_> {
    fn names(&self) -> Names {
        let mut names =
            Names { arms: Vec::new(), skills: Vec::new(), variants: vec![TRAINED.to_owned()], rooms: Vec::new() };
        names.variants.extend(self.plan.alterations.iter().map(|alteration| alteration.name.clone()));
        for room in self.plan.worlds.iter().flat_map(|placed| &placed.world.rooms) {
            if !names.rooms.contains(&room.name) {
                names.rooms.push(room.name.clone());
            }
        }
        names.rooms.push(NO_ROOM.to_owned());
        for skill in self.plan.arms.iter().flat_map(|arm| &arm.skills) {
            if !names.skills.contains(&skill.name) {
                names.skills.push(skill.name.clone());
            }
        }
        names.arms = self.plan.arms.iter().map(|arm| arm.name.clone()).collect();
        names.arms.dedup();
        for number in 0..self.groups.len() {
            let name = self.bound_name(number);
            if !names.arms.contains(&name) {
                names.arms.push(name);
            }
        }
        names
    }

    /// The planner's name for a group: each group has its own bound, at its first point.
    fn bound_name(&self, group: usize) -> String {
        let arm = |group: usize| &self.plan.arms[self.groups[group].arms[0]].name;
        if arm(group) == arm(0) { PLANNER.to_owned() } else { format!("{PLANNER}-{}", arm(group)) }
    }

    /// Index of each of the plan's arms in [`Names::arms`], where an arm has one name at all points.
    fn arm_indices(&self) -> Vec<u32> {
        let mut index = 0;
        let each = (0..self.plan.arms.len()).map(|arm| {
            index += u32::from(arm > 0 && !self.plan.continues(arm));
            index
        });
        each.collect()
    }

    /// Index of each of an arm's skills in [`Names::skills`].
    fn skill_indices(&self, names: &Names, arm: usize) -> Vec<u32> {
        (0..self.plan.arms[arm].skills.len()).map(|skill| self.skill_index(names, arm, skill as u32)).collect()
    }

    fn skill_index(&self, names: &Names, arm: usize, skill: u32) -> u32 {
        let name = &self.plan.arms[arm].skills[skill as usize].name;
        names.skills.iter().position(|other| other == name).unwrap_or(0) as u32
    }

    fn trial_rows(&self, result: &LearnerResult, arm: u32, skills: &[u32]) -> impl Iterator<Item = TrialRow> {
        let (point, seed) = (self.plan.arms[result.id.arm].point, result.id.seed);
        result.rows.as_chunks::<ROW_WORDS>().0.iter().map(move |row| {
            let [skill, trial, actions, steps, reward, success, collisions, taught] = *row;
            TrialRow {
                arm,
                point,
                seed,
                skill: skills[skill as usize],
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

    fn evaluation_rows(
        &self,
        result: &LearnerResult,
        arm: u32,
        skills: &[u32],
        names: &Names,
    ) -> impl Iterator<Item = EvaluationRow> {
        let own = &self.plan.arms[result.id.arm];
        result.tests.iter().flat_map(move |test| {
            let row = EvaluationRow {
                arm,
                point: own.point,
                seed: result.id.seed,
                skill: skills[test.skill as usize],
                trials: test.trials,
                actions: test.actions,
                variant: test.variant,
                ..BLANK
            };
            let altered = test.variant.checked_sub(1).and_then(|number| self.plan.alterations[number as usize].world);
            let world = &self.plan.worlds[altered.unwrap_or(own.world)].world;
            by_room(row, world, &test.rooms, names)
        })
    }

    /// The planner's own tests, by name and point.
    fn bound_rows(&self, names: &Names) -> Vec<EvaluationRow> {
        let mut rows = Vec::new();
        for (number, group) in self.groups.iter().enumerate() {
            let world = self.plan.world_of(&self.plan.arms[group.arms[0]]);
            for (skill, tests) in group.bounds.iter().enumerate() {
                let mut rooms = vec![RoomSums::default(); world.rooms.len() + 1];
                for test in tests.iter().flatten() {
                    let start = Vec2::new(test.start.x, test.start.y);
                    rooms[world.room_of(start).unwrap_or(world.rooms.len())].add(&RoomSums {
                        episodes: 1,
                        successes: u32::from(test.achieved()),
                        steps: test.steps(),
                        collisions: test.collisions(),
                        reward: f64::from(test.reward()),
                        returned: f64::from(test.returned),
                    });
                }
                let name = self.bound_name(number);
                let arm = names.arms.iter().position(|known| *known == name).unwrap_or(0) as u32;
                let point = self.plan.arms[group.arms[0]].point;
                let skill = self.skill_index(names, group.arms[0], skill as u32);
                rows.extend(by_room(EvaluationRow { arm, point, skill, ..BLANK }, world, &rooms, names));
            }
        }
        // Groups come in the order of their first arms.
        rows.sort_by_key(|row| (row.arm, row.point, row.seed));
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
                let rows = &nets[net_of(plan, 0, net as u32) as usize..].as_chunks::<LANES>().0[..plan.rows as usize];
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
fn by_room(row: EvaluationRow, world: &World, rooms: &[RoomSums], names: &Names) -> Vec<EvaluationRow> {
    let begun = rooms.iter().enumerate().filter(|(_, sums)| sums.episodes > 0);
    let each = begun.map(|(room, sums)| {
        let name = world.rooms.get(room).map_or(NO_ROOM, |room| &room.name);
        EvaluationRow {
            room: names.rooms.iter().position(|known| known == name).unwrap_or(0) as u32,
            episodes: sums.episodes,
            successes: sums.successes,
            steps: sums.steps,
            collisions: sums.collisions,
            reward: sums.reward,
            returned: sums.returned,
            ..row
        }
    });
    each.collect()
}
