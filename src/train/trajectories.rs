//! Example trajectories: what the first seed's learner of each arm does from the world's named places.

use super::batch::unpack;
use super::batch_group::BatchGroup;
use super::result::LearnerResult;
use crate::backend::cpu::CPU;
use crate::config::plan::Plan;
use crate::env::workgroup::{Nets, Workgroup};
use crate::layout::{Dispatch, EPISODE_RUNNING, EPISODE_TERMINATED, Episode};
use crate::policy::applicability::run_child;
use crate::run_folder::{Trajectory, TrajectoryPoint};
use bytemuck::Zeroable;

/// Keeps the examples' random numbers apart from those of tests.
const NUMBER: u32 = 0xff_ffff;

/// Greedy trials of a learner's root from every named place of its world. Made on the host by the kernel's twin: the same
/// for every backend.
pub fn trajectories(plan: &Plan, group: &BatchGroup, result: &LearnerResult) -> Vec<Trajectory> {
    let mut out = Vec::new();
    let own = &plan.arms[result.id.arm];
    let root = group.shape.skills.len() - 1;
    let nets = unpack(&result.weights, &group.shape.skills, group.shape.nets_stride);
    let (mut params, ..) = group.shape.learner(own, plan.run_seed, result.id.seed);
    params[root].threshold.copy_from_slice(&result.thresholds);
    let skill = &own.skills[root];
    for (number, (place_name, pose)) in plan.world_of(own).places.iter().enumerate() {
        let mut workgroup = Workgroup {
            dispatch: Dispatch { iterations: 1, test_skill: root as u32, test_number: NUMBER, ..Dispatch::zeroed() },
            nets: Nets::Read(&nets),
            ..Workgroup::new(&group.shared, &params, &CPU.hot)
        };
        workgroup.reset(*pose);
        let mut episode = Episode { state: EPISODE_RUNNING, agent: workgroup.agent, ..Episode::zeroed() };
        let mut points = Vec::new();
        while episode.state == EPISODE_RUNNING {
            let (x, y, heading) = (episode.agent.x, episode.agent.y, episode.agent.heading);
            workgroup.evaluate(&mut episode, number as u32);
            points.push(TrajectoryPoint { x, y, heading, child: run_child(episode.agent.run[root]) });
        }
        out.push(Trajectory {
            arm: own.name.clone(),
            seed: result.id.seed,
            skill: skill.name.clone(),
            place: place_name.clone(),
            world: plan.worlds[own.world].file.clone(),
            children: skill.children.iter().map(|child| own.name_of(*child).to_owned()).collect(),
            achieved: episode.state == EPISODE_TERMINATED,
            points,
        });
    }
    out
}
