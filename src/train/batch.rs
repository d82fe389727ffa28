//! Trains one cohort, from nothing, from stems, or from where it was saved.
//!
//! Arms that differ in nothing below their roots share those skills: a [`Stem`] is trained once, and every arm's
//! learner goes on from a copy. Its bytes are those of a learner that trained alone, for the random numbers come from
//! seeds and counters that the arms have in common.

use super::batch_group::{Group, LearnerId};
use super::cohort_state::Standing;
use super::divergence::failure_of;
use super::result::{LearnerResult, TestResult};
use super::thresholds::{Fit, fit};
use super::train_loop::{Climb, Halt, Keeper, Taker};
use crate::backend::{Backend, Cohort, Stop};
use crate::config::plan::{Child, Plan, Threshold};
use crate::layout::{LANES, LearnerState, TRIAL_WORDS, SkillShape, PHASE_FAILED};
use crate::run_folder::Failure;

/// A learner that has learned everything below the root.
#[derive(Debug, Clone, PartialEq)]
pub struct Stem {
    /// Its seed, and the first of the arms that go on from it.
    pub id: LearnerId,
    pub(super) state: LearnerState,
    pub(super) nets: Vec<f32>,
    pub(super) rows: Vec<u32>,
    pub(super) tests: Vec<TestResult>,
    /// Of each skill below the root that has trials: how success goes with its value.
    pub(super) fits: Vec<Option<Fit>>,
    pub(super) failure: Option<Failure>,
}

/// Trains the skills below the roots of some learners, or goes on with them from where they were saved.
///
/// # Errors
/// Where the backend fails, or the keeper ends it.
pub fn train_stem(
    plan: &Plan,
    group: &Group,
    learners: &[LearnerId],
    saved: Option<Standing>,
    backend: &mut dyn Backend,
    keeper: &mut dyn Keeper,
) -> Result<Vec<Stem>, Halt> {
    let root = group.shape.skills.len() - 1;
    let mut cohort = group.cohort(plan, learners);
    let results = match saved {
        Some(standing) => standing.restore(&mut cohort),
        None => learners.iter().map(|id| LearnerResult::new(*id)).collect(),
    };
    backend.load(cohort)?;
    let mut climb = Climb::new(plan, group, backend, keeper, results);
    climb.climb(0..root)?;
    climb.reach(Stop { skill: root as u32, trial: 0 })?;
    let Climb { backend, results, .. } = climb;
    let cohort = backend.memory()?;
    let prefix = group.shape.skills[root].nets_offset as usize;
    let stems = results.into_iter().enumerate().map(|(index, result)| {
        let failure = failure_of(plan, cohort, index, result.id);
        let learned = |skill: usize| failure.is_none() && learned(plan, result.id.arm, skill);
        Stem {
            id: result.id,
            state: cohort.states[index],
            nets: cohort.nets[index * cohort.nets_stride..][..prefix].to_vec(),
            rows: rows_of(cohort, index).to_vec(),
            tests: result.tests,
            fits: (0..root).map(|skill| learned(skill).then(|| fit(cohort, index, skill))).collect(),
            failure,
        }
    });
    Ok(stems.collect())
}

/// Whether some threshold may be learned of this skill.
fn learned(plan: &Plan, arm: usize, skill: usize) -> bool {
    let skill = &plan.arms[arm].skills[skill];
    skill.trials > 0 && !skill.planned && skill.mirror.is_none() && skill.ends != 0
}

/// Trains and tests the learners, from their stems where they have one or from where they were saved, and hands back
/// all that they leave. Learners of one call have all a stem, or none of them has.
///
/// # Errors
/// Where the backend fails, or the keeper ends it.
pub fn train<'stems>(
    plan: &Plan,
    group: &Group,
    learners: &[LearnerId],
    stem_of: &dyn Fn(LearnerId) -> Option<&'stems Stem>,
    saved: Option<Standing>,
    backend: &mut dyn Backend,
    keeper: &mut dyn Keeper,
) -> Result<Vec<LearnerResult>, Halt> {
    let mut results: Vec<LearnerResult> = learners.iter().map(|id| LearnerResult::new(*id)).collect();
    let skills = group.shape.skills.len();
    let mut cohort = group.cohort(plan, learners);
    let mut first = 0;
    for (index, result) in results.iter_mut().enumerate() {
        if let Some(stem) = stem_of(result.id) {
            graft(plan, &mut cohort, index, result, stem);
            first = skills - 1;
        }
    }
    let trained = saved.as_ref().is_some_and(|standing| standing.trained);
    if let Some(standing) = saved {
        results = standing.restore(&mut cohort);
    }
    // The planner's tables are of the world that it knows.
    let altered = !plan.alterations.is_empty() && cohort.shared.skills.iter().all(|skill| skill.planned == 0);
    let mut climb = Climb::new(plan, group, backend, keeper, results);
    if trained {
        alter(&mut climb, &without_lessons(&cohort))?;
        return Ok(climb.results);
    }
    climb.backend.load(cohort)?;
    climb.climb(first..skills)?;
    // The last trial of the last skill is behind every learner: let them close.
    climb.reach(Stop { skill: u32::MAX, trial: u32::MAX })?;
    let cohort = climb.backend.memory()?;
    for (index, result) in climb.results.iter_mut().enumerate() {
        close(plan, group, cohort, index, result);
    }
    if altered {
        let trained = without_lessons(cohort);
        alter(&mut climb, &trained)?;
    }
    Ok(climb.results)
}

/// Notes what a learner leaves after its last trial, or where it failed.
fn close(plan: &Plan, group: &Group, cohort: &Cohort, index: usize, result: &mut LearnerResult) {
    let nets = &cohort.nets[index * cohort.nets_stride..][..cohort.nets_stride];
    result.rows = rows_of(cohort, index).to_vec();
    result.weights = pack(nets, &group.shape.skills);
    result.thresholds = cohort.params[(index + 1) * cohort.skills - 1].threshold.to_vec();
    result.updates = cohort.states[index].updates;
    // One that failed in its stem has its lesson no longer.
    if result.failure.is_none() {
        result.failure = failure_of(plan, cohort, index, result.id);
    }
}

/// Puts a stem into learner `index` of a cohort that is still to begin.
fn graft(plan: &Plan, cohort: &mut Cohort, index: usize, result: &mut LearnerResult, stem: &Stem) {
    cohort.states[index] = stem.state;
    cohort.nets[index * cohort.nets_stride..][..stem.nets.len()].copy_from_slice(&stem.nets);
    cohort.rows[index * cohort.rows_stride..][..stem.rows.len()].copy_from_slice(&stem.rows);
    result.tests.clone_from(&stem.tests);
    let arm = &plan.arms[result.id.arm];
    let own = |failure: Failure| Failure { arm: arm.name.clone(), point: arm.point, ..failure };
    result.failure = stem.failure.clone().map(own);
    let root = &arm.skills[cohort.skills - 1];
    let params = &mut cohort.params[(index + 1) * cohort.skills - 1];
    for (child, threshold) in root.applicable.iter().enumerate() {
        let Child::Skill(skill) = root.children[child] else { continue };
        if let (Some(Threshold::Learned(probability)), Some(fit)) = (threshold, stem.fits[skill]) {
            params.threshold[child] = fit.threshold(*probability);
        }
    }
}

/// Tests what was learned under each of the plan's alterations.
fn alter(climb: &mut Climb<'_>, trained: &Cohort) -> Result<(), Halt> {
    let (plan, group) = (climb.plan, climb.group);
    let root = group.shape.skills.len() - 1;
    let arm = &plan.arms[group.arms[0]];
    let wanted: Vec<bool> = trained.states.iter().map(|state| state.phase != PHASE_FAILED).collect();
    for (number, (alteration, shared)) in plan.alterations.iter().zip(&group.altered).enumerate() {
        let mut cohort = trained.clone();
        cohort.shared.clone_from(shared);
        for params in &mut cohort.params {
            let Some(noise) = alteration.noise else { continue };
            params.noise = noise.into();
        }
        climb.backend.load(cohort)?;
        let taker = Taker {
            skill: root as u32,
            // The same number as the last test in the world of training: the same random, as far as they go.
            trials: plan.arms[climb.results[0].id.arm].skills[root].trials,
            variant: number as u32 + 1,
            world: &plan.worlds[alteration.world.unwrap_or(arm.world)].world,
        };
        climb.test(&taker, &wanted, &trained.states, Some(trained))?;
    }
    Ok(())
}

/// What tests need of a cohort: lessons are most of its memory, and only training reads them.
fn without_lessons(cohort: &Cohort) -> Cohort {
    let learners = cohort.states.len();
    Cohort {
        shared: cohort.shared.clone(),
        skills: cohort.skills,
        params: cohort.params.clone(),
        states: cohort.states.clone(),
        nets_stride: cohort.nets_stride,
        nets: cohort.nets.clone(),
        lessons_stride: 1,
        lessons: vec![0; learners],
        rows_stride: TRIAL_WORDS,
        rows: vec![0; learners * TRIAL_WORDS],
    }
}

fn rows_of(cohort: &Cohort, learner: usize) -> &[u32] {
    &cohort.rows[learner * cohort.rows_stride..][..cohort.states[learner].rows as usize * TRIAL_WORDS]
}

/// The weights of a learner's nets, without what the optimiser keeps beside them.
fn pack(nets: &[f32], skills: &[SkillShape]) -> Vec<f32> {
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
