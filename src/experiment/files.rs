//! From learners' results to the files of a run folder.

use super::group::{Group, LearnerId};
use super::result::{LearnerResult, RoomSums};
use crate::config::plan::Plan;
use crate::learner::layout::{LANES, ROW_WORDS};
use crate::qnet::forward::net_of;
use crate::record::tables::{
    EVALUATIONS, EvaluationRow, Names, PLANNER, TRIALS, TrialRow, write_evaluations, write_trials,
};
use crate::record::weights::{NetWeights, SkillWeights, write_weights};
use crate::record::{PlaceReading, RecordError, places};
use glam::Vec2;
use std::collections::BTreeMap;

/// All results of an experiment.
#[derive(Debug)]
pub struct Results<'a> {
    /// What was run.
    pub plan: &'a Plan,
    /// Its arms by shape.
    pub groups: &'a [Group],
    /// By arm and seed.
    pub learners: BTreeMap<LearnerId, LearnerResult>,
    /// What the sensors read at the named places.
    pub places: Vec<PlaceReading>,
}

impl Results<'_> {
    /// Paths and bytes of all result files.
    ///
    /// # Errors
    /// Where a table cannot be written.
    pub fn files(&self) -> Result<impl Iterator<Item = (String, Vec<u8>)>, RecordError> {
        let names = self.names();
        let trials = write_trials(&self.trial_rows(&names), &names)?;
        let evaluations = write_evaluations(&self.evaluation_rows(&names), &names)?;
        let tables = [(TRIALS.to_owned(), trials), (EVALUATIONS.to_owned(), evaluations)];
        let readings = (places::FILE.to_owned(), places::write_places(&self.places)?);
        let weights =
            self.learners.values().map(|result| self.weights(result)).collect::<Result<Vec<_>, RecordError>>()?;
        Ok(tables.into_iter().chain([readings]).chain(weights))
    }

    fn names(&self) -> Names {
        let mut names = Names {
            arms: self.plan.arms.iter().map(|arm| arm.name.clone()).collect(),
            skills: Vec::new(),
            rooms: self.plan.world.rooms.iter().map(|room| room.name.clone()).collect(),
        };
        names.rooms.push("none".to_owned());
        for skill in self.plan.arms.iter().flat_map(|arm| &arm.skills) {
            if !names.skills.contains(&skill.name) {
                names.skills.push(skill.name.clone());
            }
        }
        for number in 0..self.groups.len() {
            names.arms.push(self.bound_name(number));
        }
        names
    }

    /// The planner's name for a group: each group has its own bound.
    fn bound_name(&self, group: usize) -> String {
        match group {
            0 => PLANNER.to_owned(),
            _ => format!("{PLANNER}-{}", self.plan.arms[self.groups[group].arms[0]].name),
        }
    }

    fn skill_index(&self, names: &Names, arm: usize, skill: u32) -> u32 {
        let name = &self.plan.arms[arm].skills[skill as usize].name;
        names.skills.iter().position(|other| other == name).unwrap_or(0) as u32
    }

    fn trial_rows(&self, names: &Names) -> Vec<TrialRow> {
        let mut rows = Vec::new();
        for (id, result) in &self.learners {
            for row in result.rows.as_chunks::<ROW_WORDS>().0 {
                let [skill, trial, actions, steps, reward, success, collisions, taught] = *row;
                rows.push(TrialRow {
                    arm: id.arm as u32,
                    point: 0,
                    seed: id.seed,
                    skill: self.skill_index(names, id.arm, skill),
                    trial,
                    actions,
                    steps,
                    reward: f32::from_bits(reward),
                    success: success == 1,
                    collisions,
                    taught: taught == 1,
                });
            }
        }
        rows
    }

    fn evaluation_rows(&self, names: &Names) -> Vec<EvaluationRow> {
        let mut rows = Vec::new();
        let mut push = |mut row: EvaluationRow, rooms: &[RoomSums]| {
            for (room, sums) in rooms.iter().enumerate().filter(|(_, sums)| sums.episodes > 0) {
                row.room = room as u32;
                row.episodes = sums.episodes;
                row.successes = sums.successes;
                row.steps = sums.steps;
                row.collisions = sums.collisions;
                row.reward = sums.reward;
                rows.push(row);
            }
        };
        let blank = EvaluationRow {
            arm: 0,
            point: 0,
            seed: 0,
            skill: 0,
            trials: 0,
            actions: 0,
            room: 0,
            episodes: 0,
            successes: 0,
            steps: 0,
            reward: 0.0,
            collisions: 0,
        };
        for (id, result) in &self.learners {
            for test in &result.tests {
                let row = EvaluationRow {
                    arm: id.arm as u32,
                    seed: id.seed,
                    skill: self.skill_index(names, id.arm, test.skill),
                    trials: test.trials,
                    actions: test.actions,
                    ..blank
                };
                push(row, &test.rooms);
            }
        }
        for (number, group) in self.groups.iter().enumerate() {
            for (skill, tests) in group.bounds.iter().enumerate() {
                let mut rooms = vec![RoomSums::default(); names.rooms.len()];
                for test in tests {
                    let start = Vec2::new(test.start.x, test.start.y);
                    let room = self.plan.world.room_of(start).unwrap_or(names.rooms.len() - 1);
                    rooms[room].add(test.steps(), test.achieved(), f64::from(test.reward()), test.collisions());
                }
                let arm = (self.plan.arms.len() + number) as u32;
                push(
                    EvaluationRow { arm, skill: self.skill_index(names, group.arms[0], skill as u32), ..blank },
                    &rooms,
                );
            }
        }
        rows
    }

    fn weights(&self, result: &LearnerResult) -> Result<(String, Vec<u8>), RecordError> {
        let arm = &self.plan.arms[result.id.arm];
        let shapes = self
            .groups
            .iter()
            .find(|group| group.arms.contains(&result.id.arm))
            .map_or(&[][..], |group| group.shape.skills.as_slice());
        let mut skills = Vec::new();
        for (skill, plan) in arm.skills.iter().zip(shapes) {
            let hidden = skill.learning.hidden as usize;
            let inputs = plan.inputs as usize;
            let mut nets = Vec::new();
            for (child, action) in skill.children.iter().enumerate() {
                let rows = &result.nets[net_of(plan, 0, child as u32) as usize..].as_chunks::<LANES>().0[..inputs + 3];
                nets.push(NetWeights {
                    child: action.name().to_owned(),
                    inputs,
                    hidden,
                    w1: (0..hidden).flat_map(|unit| (0..inputs).map(move |input| rows[input][unit])).collect(),
                    b1: rows[inputs][..hidden].to_vec(),
                    w2: rows[inputs + 1][..hidden].to_vec(),
                    b2: rows[inputs + 2][0],
                });
            }
            skills.push(SkillWeights { skill: skill.name.clone(), nets });
        }
        let metadata = BTreeMap::from([
            ("arm".to_owned(), arm.name.clone()),
            ("seed".to_owned(), result.id.seed.to_string()),
            ("run_seed".to_owned(), self.plan.run_seed.to_string()),
            ("activation".to_owned(), "tanh".to_owned()),
            ("transitions".to_owned(), result.updates.to_string()),
        ]);
        let path = format!("skills/{}-{}.safetensors", arm.name, result.id.seed);
        Ok((path, write_weights(&skills, &metadata)?))
    }
}
