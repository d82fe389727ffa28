//! Trains one cohort: to each test point in turn, and tests there.
//!
//! Arms that differ in nothing below their roots share those skills: a [`Stem`] is trained once, and every arm's
//! learner goes on from a copy. Its bytes are those of a learner that trained alone, for the random numbers come from
//! seeds and counters that the arms have in common.

use super::group::{Group, LearnerId};
use super::result::{LearnerResult, RoomSums, TestResult};
use super::thresholds::{Fit, fit};
use crate::backend::{Backend, BackendError, Cohort, Stop, Test};
use crate::config::plan::{Child, Plan, Threshold};
use crate::evaluate::STATE_ACHIEVED;
use crate::learner::layout::{Cursor, Episode, LANES, ROW_WORDS, SkillPlan};
use crate::learner::phase::PHASE_FAILED;
use crate::world::World;
use glam::Vec2;
use std::ops::Range;

/// Told how far a cohort is: trials finished by all its learners together.
pub type Progress<'a> = &'a mut dyn FnMut(u64);

/// A learner that has learned everything below the root.
#[derive(Debug, Clone)]
pub struct Stem {
    seed: u32,
    cursor: Cursor,
    nets: Vec<f32>,
    rows: Vec<u32>,
    tests: Vec<TestResult>,
    /// Of each skill below the root that has trials: how success goes with its value.
    fits: Vec<Option<Fit>>,
}

/// Trains the skills below the root of `arm`, for each seed.
///
/// # Errors
/// Where the backend fails.
pub fn train_stem(
    plan: &Plan,
    group: &Group,
    (arm, seeds): (usize, &[u32]),
    backend: &mut dyn Backend,
    progress: Progress<'_>,
) -> Result<Vec<Stem>, BackendError> {
    let ids: Vec<LearnerId> = seeds.iter().map(|seed| LearnerId { arm, seed: *seed }).collect();
    let mut results: Vec<LearnerResult> = ids.iter().map(|id| LearnerResult::new(*id)).collect();
    let root = group.shape.skills.len() - 1;
    backend.load(group.cohort(plan, &ids))?;
    climb(plan, group, &mut results, backend, 0..root, progress)?;
    reach(backend, Stop { skill: root as u32, trial: 0 }, &mut |_| {})?;
    let cohort = backend.memory()?;
    let prefix = group.shape.skills[root].nets_offset as usize;
    let stems = results.into_iter().enumerate().map(|(index, result)| Stem {
        seed: result.id.seed,
        cursor: cohort.cursors[index],
        nets: cohort.nets[index * cohort.nets_stride..][..prefix].to_vec(),
        rows: rows_of(cohort, index).to_vec(),
        tests: result.tests,
        fits: (0..root).map(|skill| learned(plan, arm, skill).then(|| fit(cohort, index, skill))).collect(),
    });
    Ok(stems.collect())
}

/// Whether some threshold may be learned of this skill.
fn learned(plan: &Plan, arm: usize, skill: usize) -> bool {
    let skill = &plan.arms[arm].skills[skill];
    skill.trials > 0 && !skill.planned && skill.mirror.is_none() && skill.ends != 0
}

/// Trains and tests the learners, from their stems where they have one, and hands back all that they leave.
///
/// # Errors
/// Where the backend fails.
pub fn train(
    plan: &Plan,
    group: &Group,
    learners: &[LearnerId],
    stems: &[Stem],
    backend: &mut dyn Backend,
    progress: Progress<'_>,
) -> Result<Vec<LearnerResult>, BackendError> {
    let mut results: Vec<LearnerResult> = learners.iter().map(|id| LearnerResult::new(*id)).collect();
    let skills = group.shape.skills.len();
    let mut cohort = group.cohort(plan, learners);
    let mut first = 0;
    for (index, result) in results.iter_mut().enumerate() {
        if let Some(stem) = stems.iter().find(|stem| stem.seed == result.id.seed) {
            graft(plan, &mut cohort, index, result, stem);
            first = skills - 1;
        }
    }
    backend.load(cohort)?;
    climb(plan, group, &mut results, backend, first..skills, progress)?;
    // The last trial of the last skill is behind every learner: let them close.
    reach(backend, Stop { skill: u32::MAX, trial: u32::MAX }, &mut |_| {})?;
    let cohort = backend.memory()?;
    for (index, result) in results.iter_mut().enumerate() {
        let cursor = &cohort.cursors[index];
        let nets = &cohort.nets[index * cohort.nets_stride..][..cohort.nets_stride];
        result.rows = rows_of(cohort, index).to_vec();
        result.weights = pack(nets, &group.shape.skills);
        result.thresholds = cohort.settings[(index + 1) * skills - 1].threshold.to_vec();
        result.failed = cursor.phase == PHASE_FAILED;
        result.updates = cursor.updates;
    }
    // The planner's tables are of the world that it knows.
    let planned = cohort.shared.skills.iter().any(|skill| skill.planned > 0);
    if !plan.alterations.is_empty() && !planned {
        let trained = without_lessons(cohort);
        alter(plan, group, trained, &mut results, backend)?;
    }
    Ok(results)
}

/// Puts a stem into learner `index` of a cohort that is still to begin.
fn graft(plan: &Plan, cohort: &mut Cohort, index: usize, result: &mut LearnerResult, stem: &Stem) {
    cohort.cursors[index] = stem.cursor;
    cohort.nets[index * cohort.nets_stride..][..stem.nets.len()].copy_from_slice(&stem.nets);
    cohort.rows[index * cohort.rows_stride..][..stem.rows.len()].copy_from_slice(&stem.rows);
    result.tests.clone_from(&stem.tests);
    let root = &plan.arms[result.id.arm].skills[cohort.skills - 1];
    let settings = &mut cohort.settings[(index + 1) * cohort.skills - 1];
    for (child, threshold) in root.applicable.iter().enumerate() {
        let Child::Skill(skill) = root.children[child] else { continue };
        if let (Some(Threshold::Learned(probability)), Some(fit)) = (threshold, stem.fits[skill]) {
            settings.threshold[child] = fit.threshold(*probability);
        }
    }
}

/// Brings all learners through the trials of some skills, with every test on the way.
fn climb(
    plan: &Plan,
    group: &Group,
    results: &mut [LearnerResult],
    backend: &mut dyn Backend,
    skills: Range<usize>,
    progress: Progress<'_>,
) -> Result<(), BackendError> {
    let ids: Vec<LearnerId> = results.iter().map(|result| result.id).collect();
    for skill in skills {
        for point in test_points(plan, &ids, skill) {
            let stop = Stop { skill: skill as u32, trial: point };
            let cursors = reach(backend, stop, &mut |cursors| {
                progress(ids.iter().zip(cursors).map(|(id, cursor)| trials_of(plan, *id, cursor)).sum());
            })?;
            let wanted = |id: &LearnerId| tested_at(plan, *id, skill, point);
            if plan.evaluate.episodes == 0 || !ids.iter().any(wanted) {
                continue;
            }
            let test = Test { skill: skill as u32, number: point, episodes: plan.evaluate.episodes };
            let episodes = backend.evaluate(test)?;
            for (index, _) in ids.iter().enumerate().filter(|(_, id)| wanted(id)) {
                let count = plan.evaluate.episodes as usize;
                let own = &episodes[index * count..(index + 1) * count];
                let actions = cursors[index].actions;
                let rooms = sums(plan.world_of(&plan.arms[group.arms[0]]), own);
                results[index].tests.push(TestResult {
                    skill: skill as u32,
                    trials: point,
                    actions,
                    variant: 0,
                    rooms,
                });
            }
        }
    }
    Ok(())
}

/// Tests what was learned under each of the plan's alterations.
fn alter(
    plan: &Plan,
    group: &Group,
    trained: Cohort,
    results: &mut [LearnerResult],
    backend: &mut dyn Backend,
) -> Result<(), BackendError> {
    let root = group.shape.skills.len() - 1;
    for (number, (alteration, shared)) in plan.alterations.iter().zip(&group.altered).enumerate() {
        let mut cohort = trained.clone();
        cohort.shared.clone_from(shared);
        for settings in &mut cohort.settings {
            let Some(noise) = alteration.noise else { continue };
            settings.noise_kind = noise.kind as u32;
            settings.noise_actuator = noise.actuator;
            settings.noise_sonar = noise.sonar;
            settings.noise_light = noise.light;
            settings.noise_compass = noise.compass;
        }
        backend.load(cohort)?;
        // The same number as the last test in the world of training: the same dice, as far as they go.
        let trials = plan.arms[results[0].id.arm].skills[root].trials;
        let count = plan.evaluate.episodes as usize;
        let episodes = backend.evaluate(Test { skill: root as u32, number: trials, episodes: count as u32 })?;
        for (index, result) in results.iter_mut().enumerate() {
            let world = alteration.world.unwrap_or(plan.arms[result.id.arm].world);
            let rooms = sums(&plan.worlds[world].world, &episodes[index * count..(index + 1) * count]);
            let (actions, variant) = (trained.cursors[index].actions, number as u32 + 1);
            result.tests.push(TestResult { skill: root as u32, trials, actions, variant, rooms });
        }
    }
    Ok(())
}

/// What tests need of a cohort: lessons are most of its memory, and only training reads them.
fn without_lessons(cohort: &Cohort) -> Cohort {
    let learners = cohort.cursors.len();
    Cohort {
        shared: cohort.shared.clone(),
        skills: cohort.skills,
        settings: cohort.settings.clone(),
        cursors: cohort.cursors.clone(),
        nets_stride: cohort.nets_stride,
        nets: cohort.nets.clone(),
        lessons_stride: 1,
        lessons: vec![0; learners],
        rows_stride: 1,
        rows: vec![0; learners],
    }
}

/// Moves all learners on until they hold at `stop`, showing where they stand after every stretch.
fn reach(backend: &mut dyn Backend, stop: Stop, show: &mut dyn FnMut(&[Cursor])) -> Result<Vec<Cursor>, BackendError> {
    let mut last = Vec::new();
    loop {
        let cursors = backend.advance(stop)?;
        show(cursors);
        if cursors.iter().all(|cursor| stop.holds(cursor)) {
            return Ok(cursors.to_vec());
        }
        // Every stretch moves some learner; a device on which none moves has stopped computing.
        if cursors == last {
            let message = "the learners no longer move".to_owned();
            return Err(BackendError::Device { kernel: "advance", message });
        }
        last = cursors.to_vec();
    }
}

/// Numbers of trials after which some of the learners are tested in a skill, ascending.
fn test_points(plan: &Plan, learners: &[LearnerId], skill: usize) -> Vec<u32> {
    let mut points = Vec::new();
    for id in learners {
        let own = &plan.arms[id.arm].skills[skill];
        points.extend(own.tested_at.iter().copied().filter(|point| *point <= own.trials));
        points.push(own.trials);
    }
    points.sort_unstable();
    points.dedup();
    points
}

fn tested_at(plan: &Plan, id: LearnerId, skill: usize, point: u32) -> bool {
    let own = &plan.arms[id.arm].skills[skill];
    point == own.trials || (point < own.trials && own.tested_at.contains(&point))
}

/// Trials that a learner has finished, over all skills.
fn trials_of(plan: &Plan, id: LearnerId, cursor: &Cursor) -> u64 {
    let skills = &plan.arms[id.arm].skills;
    let before: u32 = skills.iter().take(cursor.skill as usize).map(|skill| skill.trials).sum();
    u64::from(before + cursor.trial)
}

fn rows_of(cohort: &Cohort, learner: usize) -> &[u32] {
    &cohort.rows[learner * cohort.rows_stride..][..cohort.cursors[learner].rows as usize * ROW_WORDS]
}

/// Sums of a learner's test trials by the room in which they began; one entry per room of the world.
fn sums(world: &World, episodes: &[Episode]) -> Vec<RoomSums> {
    let mut rooms = vec![RoomSums::default(); world.rooms.len() + 1];
    for episode in episodes {
        let start = Vec2::new(episode.start_x, episode.start_y);
        let agent = &episode.agent;
        rooms[world.room_of(start).unwrap_or(world.rooms.len())].add(&RoomSums {
            episodes: 1,
            successes: u32::from(episode.state == STATE_ACHIEVED),
            steps: agent.step,
            collisions: agent.collisions,
            reward: f64::from(agent.reward),
            returned: f64::from(agent.returned),
        });
    }
    rooms
}

/// The weights of a learner's nets, without what the optimiser keeps beside them.
fn pack(nets: &[f32], skills: &[SkillPlan]) -> Vec<f32> {
    places(skills).flat_map(|(at, slab)| &nets[at..at + slab]).copied().collect()
}

/// A learner's nets from their weights; what the optimiser keeps is 0.
pub fn unpack(weights: &[f32], skills: &[SkillPlan], stride: usize) -> Vec<f32> {
    let mut nets = vec![0.0; stride];
    let mut rest = weights;
    for (at, slab) in places(skills) {
        let (own, others) = rest.split_at(slab.min(rest.len()));
        nets[at..at + own.len()].copy_from_slice(own);
        rest = others;
    }
    nets
}

/// First word and size of the weights of every net. A mirror image has none of its own.
fn places(skills: &[SkillPlan]) -> impl Iterator<Item = (usize, usize)> {
    skills.iter().filter(|skill| skill.mirrored == 0).flat_map(|skill| {
        let slab = skill.rows as usize * LANES;
        (0..skill.nets as usize).map(move |net| (skill.nets_offset as usize + net * 3 * slab, slab))
    })
}
