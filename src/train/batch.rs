//! Trains one cohort, from nothing, from what was learned below the roots, or from where it was saved.
//!
//! Arms that differ in nothing below their roots share those skills: a [`Pretrained`] learner is trained once, and every
//! arm's learner goes on from a copy. Its bytes are those of a learner that trained alone, for the random numbers come from
//! seeds and counters that the arms have in common.

use super::batch_group::{BatchGroup, LearnerId};
use super::callbacks::{Callbacks, Interrupted};
use super::checkpoint::CohortState;
use super::divergence::divergence_of;
use super::nets::pack;
use super::pretraining::Pretrained;
use super::result::LearnerResult;
use super::thresholds::fit;
use super::train_loop::{Evaluation, TrainLoop};
use crate::backend::{Backend, Cohort, Stop};
use crate::config::plan::{Child, Plan, Threshold};
use crate::layout::{PHASE_FAILED, TRIAL_WORDS};
use crate::run_folder::Divergence;

/// Trains the skills below the roots of some learners, or goes on with them from where they were saved.
pub fn pretrain(
    plan: &Plan,
    group: &BatchGroup,
    learners: &[LearnerId],
    saved: Option<CohortState<'_>>,
    backend: &mut dyn Backend,
    callbacks: &mut dyn Callbacks,
) -> Result<Vec<Pretrained>, Interrupted> {
    let root = group.shape.skills.len() - 1;
    let mut cohort = group.cohort(plan, learners);
    let results = match saved {
        Some(state) => state.restore(&mut cohort),
        None => learners.iter().map(|id| LearnerResult::new(*id)).collect(),
    };
    backend.load(cohort)?;
    let mut training = TrainLoop::new(plan, group, backend, callbacks, results);
    training.train(0..root)?;
    training.reach(Stop { skill: root as u32, trial: 0 })?;
    let TrainLoop { backend, results, .. } = training;
    let cohort = backend.memory()?;
    let prefix = group.shape.skills[root].nets_offset as usize;
    let pretrained = results.into_iter().enumerate().map(|(index, result)| {
        let divergence = divergence_of(plan, cohort, index, result.id);
        let learned = |skill: usize| divergence.is_none() && learned(plan, result.id.arm, skill);
        Pretrained {
            id: result.id,
            state: cohort.states[index],
            nets: cohort.nets[index * cohort.nets_stride..][..prefix].to_vec(),
            rows: rows_of(cohort, index).to_vec(),
            tests: result.tests,
            fits: (0..root).map(|skill| learned(skill).then(|| fit(cohort, index, skill))).collect(),
            divergence,
        }
    });
    Ok(pretrained.collect())
}

/// Whether some threshold may be learned of this skill.
fn learned(plan: &Plan, arm: usize, skill: usize) -> bool {
    let skill = &plan.arms[arm].skills[skill];
    skill.params.trials > 0 && !skill.oracle && skill.mirror.is_none() && skill.goal != 0
}

/// Trains and tests the learners, from their pretrained ones where they have them or from where they were saved, and hands
/// back all that they leave. Of the learners of one call all are pretrained, or none.
pub fn train<'a>(
    plan: &Plan,
    group: &BatchGroup,
    learners: &[LearnerId],
    pretrained: &dyn Fn(LearnerId) -> Option<&'a Pretrained>,
    saved: Option<CohortState<'_>>,
    backend: &mut dyn Backend,
    callbacks: &mut dyn Callbacks,
) -> Result<Vec<LearnerResult>, Interrupted> {
    let mut results: Vec<LearnerResult> = learners.iter().map(|id| LearnerResult::new(*id)).collect();
    let skills = group.shape.skills.len();
    let mut cohort = group.cohort(plan, learners);
    let mut first = 0;
    for (index, result) in results.iter_mut().enumerate() {
        if let Some(from) = pretrained(result.id) {
            go_on(plan, &mut cohort, index, result, from);
            first = skills - 1;
        }
    }
    let trained = saved.as_ref().is_some_and(|state| state.trained);
    if let Some(state) = saved {
        results = state.restore(&mut cohort);
    }
    // The planner's tables are of the world that it knows.
    let altered = !plan.alterations.is_empty() && cohort.shared.skills.iter().all(|skill| skill.planned == 0);
    let mut training = TrainLoop::new(plan, group, backend, callbacks, results);
    if trained {
        alter(&mut training, &without_lessons(&cohort))?;
        return Ok(training.results);
    }
    training.backend.load(cohort)?;
    training.train(first..skills)?;
    // The last trial of the last skill is behind every learner: let them close.
    training.reach(Stop { skill: u32::MAX, trial: u32::MAX })?;
    let cohort = training.backend.memory()?;
    for (index, result) in training.results.iter_mut().enumerate() {
        close(plan, group, cohort, index, result);
    }
    if altered {
        let trained = without_lessons(cohort);
        alter(&mut training, &trained)?;
    }
    Ok(training.results)
}

/// Notes what a learner leaves after its last trial, or where it failed.
fn close(plan: &Plan, group: &BatchGroup, cohort: &Cohort, index: usize, result: &mut LearnerResult) {
    let nets = &cohort.nets[index * cohort.nets_stride..][..cohort.nets_stride];
    result.rows = rows_of(cohort, index).to_vec();
    result.weights = pack(nets, &group.shape.skills);
    result.thresholds = cohort.params[(index + 1) * cohort.skills - 1].threshold.to_vec();
    result.updates = cohort.states[index].updates;
    // One that diverged below its root has its lesson no longer.
    if result.divergence.is_none() {
        result.divergence = divergence_of(plan, cohort, index, result.id);
    }
}

/// Makes learner `index` of a cohort that is still to begin a copy of a pretrained one.
fn go_on(plan: &Plan, cohort: &mut Cohort, index: usize, result: &mut LearnerResult, from: &Pretrained) {
    cohort.states[index] = from.state;
    cohort.nets[index * cohort.nets_stride..][..from.nets.len()].copy_from_slice(&from.nets);
    cohort.rows[index * cohort.rows_stride..][..from.rows.len()].copy_from_slice(&from.rows);
    result.tests.clone_from(&from.tests);
    let arm = &plan.arms[result.id.arm];
    let own = |divergence: Divergence| Divergence { arm: arm.name.clone(), point: arm.point, ..divergence };
    result.divergence = from.divergence.clone().map(own);
    let root = &arm.skills[cohort.skills - 1];
    let params = &mut cohort.params[(index + 1) * cohort.skills - 1];
    for (child, threshold) in root.applicable.iter().enumerate() {
        let Child::Skill(skill) = root.children[child] else { continue };
        if let (Some(Threshold::Learned(probability)), Some(fit)) = (threshold, from.fits[skill]) {
            params.threshold[child] = fit.threshold(*probability);
        }
    }
}

/// Tests what was learned under each of the plan's alterations.
fn alter(training: &mut TrainLoop<'_>, trained: &Cohort) -> Result<(), Interrupted> {
    let (plan, group) = (training.plan, training.group);
    let root = group.shape.skills.len() - 1;
    let wanted: Vec<bool> = trained.states.iter().map(|state| state.phase != PHASE_FAILED).collect();
    for (number, (alteration, shared)) in plan.alterations.iter().zip(&group.altered).enumerate() {
        let mut cohort = trained.clone();
        cohort.shared.clone_from(shared);
        for params in &mut cohort.params {
            let Some(noise) = alteration.noise else { continue };
            params.noise = noise;
        }
        training.backend.load(cohort)?;
        let test = Evaluation {
            skill: root as u32,
            // The same number as the last test in the world of training: the same random, as far as they go.
            trials: plan.arms[training.results[0].id.arm].skills[root].params.trials,
            variant: number as u32 + 1,
        };
        training.evaluate(&test, &wanted, &trained.states, Some(trained))?;
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
