//! From learners' results to the files of a run folder.

use super::batch_group::{BatchGroup, LearnerId, group_of};
use super::callbacks::{Callbacks, Interrupted, Signal};
use super::committed::Parts;
use super::nets;
use super::observation;
use super::result::{LearnerResult, by_room, world_of};
use super::trajectories::trajectories;
use crate::backend::Backend;
use crate::config::plan::{ArmPlan, Plan};
use crate::layout::TRIAL_WORDS;
use crate::run_folder::tables::{EVALUATIONS, NO_ROOM, PLANNER, TRAINED, TRIALS, TableWriter};
use crate::run_folder::{EvaluationRow, Provenance, RecordError, RunFolder, Sums, TrialRow};
use crate::world::World;
use glam::Vec2;

/// Writes the results of an experiment, all of whose learners are finished, and the manifest: one learner after
/// another, so that the memory it takes does not grow with their number. What it did before it was stopped or killed
/// does no harm: the parts stay until the manifest is there.
pub fn finish(
    plan: &Plan,
    groups: &[BatchGroup],
    folder: &RunFolder,
    parts: &mut Parts,
    backend: &mut dyn Backend,
    callbacks: &mut dyn Callbacks,
    provenance: impl FnOnce(usize) -> Provenance,
) -> Result<(), Interrupted> {
    let mut files = folder.results()?;
    let file = files.begin(TRIALS)?;
    let mut trials = TableWriter::new(&folder.dir().join(TRIALS), file)?;
    let file = files.begin(EVALUATIONS)?;
    let mut evaluations = TableWriter::new(&folder.dir().join(EVALUATIONS), file)?;
    let (mut failures, mut examples) = (Vec::new(), Vec::new());
    let all = plan.arms.iter().map(ArmPlan::trials).sum::<u64>() * plan.seeds.len() as u64;
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
            trial_rows(plan, result).try_for_each(|row| trials.push(row))?;
            evaluation_rows(plan, result).try_for_each(|row| evaluations.push(row))?;
            let (name, nets) = nets::file(plan, &group_of(groups, arm).shape, result)?;
            files.add(&name, &nets)?;
            failures.extend(result.divergence.clone());
            if seed == &plan.seeds[0] && !plan.continues(arm) && result.divergence.is_none() {
                examples.extend(trajectories(plan, group_of(groups, arm), result));
            }
        }
    }
    bound_rows(plan, groups).into_iter().try_for_each(|row| evaluations.push(row))?;
    files.end(TRIALS, trials.finish()?)?;
    files.end(EVALUATIONS, evaluations.finish()?)?;
    files.add_json(&observation::places(plan.world(), backend)?)?;
    files.add_json(&examples)?;
    if let Some(sweep) = &plan.sweep {
        files.add_json(sweep)?;
    }
    if !failures.is_empty() {
        files.add_json(&failures)?;
    }
    folder.complete(files, provenance(failures.len()))?;
    Ok(())
}

/// A learner's training trials.
fn trial_rows(plan: &Plan, result: &LearnerResult) -> impl Iterator<Item = TrialRow> {
    let (arm, seed) = (&plan.arms[result.id.arm], result.id.seed);
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

/// A learner's tests.
fn evaluation_rows(plan: &Plan, result: &LearnerResult) -> impl Iterator<Item = EvaluationRow> {
    let arm = &plan.arms[result.id.arm];
    result.tests.iter().flat_map(move |test| {
        let alteration = test.variant.checked_sub(1).map(|number| &plan.alterations[number as usize]);
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
        world_of(plan, result.id.arm, test.variant).map_or_else(Vec::new, |world| rows_by_room(row, world, &test.rooms))
    })
}

/// The planner's name for a group: each group has its own bound, at its first point.
fn bound_name(plan: &Plan, groups: &[BatchGroup], group: usize) -> String {
    let arm = |group: usize| &plan.arms[groups[group].arms[0]].name;
    if arm(group) == arm(0) { PLANNER.to_owned() } else { format!("{PLANNER}-{}", arm(group)) }
}

/// The planner's own tests, by name and point.
fn bound_rows(plan: &Plan, groups: &[BatchGroup]) -> Vec<EvaluationRow> {
    let names: Vec<String> = (0..groups.len()).map(|number| bound_name(plan, groups, number)).collect();
    let mut rows = Vec::new();
    for (name, group) in names.iter().zip(groups) {
        let arm = &plan.arms[group.arms[0]];
        let world = plan.world_of(arm);
        for (skill, tests) in arm.skills.iter().zip(&group.bounds) {
            let trials = tests.iter().flatten().map(|test| {
                let sums = Sums {
                    episodes: 1,
                    successes: u32::from(test.achieved()),
                    steps: test.steps(),
                    collisions: test.collisions(),
                    reward: f64::from(test.reward()),
                    returned: f64::from(test.returned),
                };
                (Vec2::new(test.start.x, test.start.y), sums)
            });
            let row = EvaluationRow {
                arm: name.clone(),
                point: arm.point,
                skill: skill.name.clone(),
                variant: TRAINED.to_owned(),
                ..EvaluationRow::default()
            };
            rows.extend(rows_by_room(row, world, &by_room(world, trials)));
        }
    }
    // Groups come in the order of their first arms.
    rows.sort_by_key(|row| (names.iter().position(|name| *name == row.arm), row.point));
    rows
}

/// A row for each room of a world in which test trials began.
fn rows_by_room(row: EvaluationRow, world: &World, rooms: &[Sums]) -> Vec<EvaluationRow> {
    let begun = rooms.iter().enumerate().filter(|(_, sums)| sums.episodes > 0);
    let each = begun.map(|(room, sums)| {
        let room = world.rooms.get(room).map_or(NO_ROOM, |room| &room.name).to_owned();
        EvaluationRow { room, ..row.clone() }.with_sums(*sums)
    });
    each.collect()
}
