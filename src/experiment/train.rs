//! Trains one cohort: to each test point in turn, and tests there.

use super::group::{Group, LearnerId};
use super::result::{LearnerResult, RoomSums, TestResult};
use crate::backend::{Backend, BackendError, Stop, Test};
use crate::config::plan::Plan;
use crate::evaluate::STATE_ACHIEVED;
use crate::learner::layout::{Cursor, Episode, ROW_WORDS};
use crate::learner::phase::PHASE_FAILED;
use glam::Vec2;

/// Told how far a cohort is: trials finished by all its learners together.
pub type Progress<'a> = &'a mut dyn FnMut(u64);

/// Trains and tests the learners, and hands back all that they leave.
///
/// # Errors
/// Where the backend fails.
pub fn train(
    plan: &Plan,
    group: &Group,
    learners: &[LearnerId],
    backend: &mut dyn Backend,
    progress: Progress<'_>,
) -> Result<Vec<LearnerResult>, BackendError> {
    let mut results: Vec<LearnerResult> = learners.iter().map(|id| LearnerResult::new(*id)).collect();
    backend.load(group.cohort(plan, learners))?;
    for skill in 0..group.shape.skills.len() {
        for point in test_points(plan, group, skill) {
            let stop = Stop { skill: skill as u32, trial: point };
            let cursors = reach(backend, stop, &mut |cursors| {
                progress(learners.iter().zip(cursors).map(|(id, cursor)| trials_of(plan, *id, cursor)).sum());
            })?;
            let wanted = |id: &LearnerId| tested_at(plan, *id, skill, point);
            if plan.evaluate.episodes == 0 || !learners.iter().any(wanted) {
                continue;
            }
            let test = Test { skill: skill as u32, number: point, episodes: plan.evaluate.episodes };
            let episodes = backend.evaluate(test)?;
            for (index, _) in learners.iter().enumerate().filter(|(_, id)| wanted(id)) {
                let count = plan.evaluate.episodes as usize;
                let own = &episodes[index * count..(index + 1) * count];
                let actions = cursors[index].actions;
                let rooms = sums(plan, own);
                results[index].tests.push(TestResult { skill: skill as u32, trials: point, actions, rooms });
            }
        }
    }
    // The last trial of the last skill is behind every learner: let them close.
    reach(backend, Stop { skill: u32::MAX, trial: u32::MAX }, &mut |_| {})?;
    let cohort = backend.memory()?;
    for (index, result) in results.iter_mut().enumerate() {
        let cursor = &cohort.cursors[index];
        let rows = &cohort.rows[index * cohort.rows_stride..][..cursor.rows as usize * ROW_WORDS];
        result.rows = rows.to_vec();
        result.nets = cohort.nets[index * cohort.nets_stride..][..cohort.nets_stride].to_vec();
        result.failed = cursor.phase == PHASE_FAILED;
        result.updates = cursor.updates;
    }
    Ok(results)
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

/// Numbers of trials after which some learner of the group is tested in a skill, ascending.
fn test_points(plan: &Plan, group: &Group, skill: usize) -> Vec<u32> {
    let mut points = Vec::new();
    for arm in &group.arms {
        let trials = plan.arms[*arm].skills[skill].trials;
        points.extend(plan.evaluate.at.iter().copied().filter(|point| *point <= trials));
        points.push(trials);
    }
    points.sort_unstable();
    points.dedup();
    points
}

fn tested_at(plan: &Plan, id: LearnerId, skill: usize, point: u32) -> bool {
    let trials = plan.arms[id.arm].skills[skill].trials;
    point == trials || (point < trials && plan.evaluate.at.contains(&point))
}

/// Trials that a learner has finished, over all skills.
fn trials_of(plan: &Plan, id: LearnerId, cursor: &Cursor) -> u64 {
    let skills = &plan.arms[id.arm].skills;
    let before: u32 = skills.iter().take(cursor.skill as usize).map(|skill| skill.trials).sum();
    u64::from(before + cursor.trial)
}

/// Sums of a learner's test trials by the room in which they began; one entry per room of the world.
fn sums(plan: &Plan, episodes: &[Episode]) -> Vec<RoomSums> {
    let mut rooms = vec![RoomSums::default(); plan.world.rooms.len() + 1];
    for episode in episodes {
        let start = Vec2::new(episode.start_x, episode.start_y);
        let room = plan.world.room_of(start).unwrap_or(plan.world.rooms.len());
        rooms[room].add(episode.step, episode.state == STATE_ACHIEVED, f64::from(episode.reward), episode.collisions);
    }
    rooms
}
