//! How much work one dispatch is given: short enough for watchdogs, desktops and drivers that cut loops.

use super::loop_limit::SAFE_TURNS;
use crate::env::events::{SIDE_FIRST, SIDE_LAST};
use crate::env::workgroup::CohortData;
use crate::layout::sensors::{GROUP_APPLICABLE, GROUP_VALUES};
use crate::layout::{
    ELEMENTARY_STEP_WORDS, EVENTS, LANES, MAX_CHILDREN, REGION_EVENTS, SKILL_CODE, SkillShape, WorldUniform,
};
use std::time::Duration;

/// Duration that dispatches aim at.
const AIM: Duration = Duration::from_millis(50);
/// A dispatch that took longer than this is followed by one far shorter.
const CAP: Duration = Duration::from_millis(250);
/// Workgroup-iterations of the first dispatch, which no device takes long for.
const FIRST: u64 = 1024;
/// Most workgroups along one axis of a dispatch (WebGPU's limit).
pub const GROUPS: u32 = 65_535;

/// Chooses iterations and workgroups of the next dispatch from how long the last ones took.
#[derive(Debug, Clone)]
pub struct Governor {
    fixed: Option<u32>,
    ceiling: u32,
    work: u64,
}

/// Size of a dispatch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Share {
    /// Workgroups.
    pub groups: u32,
    /// Iterations of each.
    pub iterations: u32,
}

impl Share {
    /// Iterations of all workgroups.
    pub fn work(self) -> u64 {
        u64::from(self.groups) * u64::from(self.iterations)
    }
}

impl Governor {
    /// A governor that uses `fixed` iterations if given, and never more than `ceiling`.
    pub fn new(fixed: Option<u32>, ceiling: u32) -> Self {
        Self { fixed, ceiling: ceiling.max(1), work: FIRST }
    }

    /// Lowers or lifts the ceiling, as another world or tree of skills asks for.
    pub fn set_ceiling(&mut self, ceiling: u32) {
        self.ceiling = ceiling.max(1);
    }

    /// The next dispatch over `waiting` workgroups: all of them with as many iterations as fit, or a part of
    /// them with one iteration each.
    pub fn share(&self, waiting: u32) -> Share {
        let waiting = waiting.clamp(1, GROUPS);
        let groups = u64::from(waiting).min(self.work.max(1)) as u32;
        let iterations = (self.work / u64::from(groups)).clamp(1, u64::from(self.ceiling)) as u32;
        Share { groups, iterations: self.fixed.map_or(iterations, |fixed| fixed.clamp(1, self.ceiling)) }
    }

    /// Learns from a dispatch. `busy` says whether most of its workgroups had work to the end: one that was
    /// over early says nothing about how long a full one would take. Work grows to twice what was done and not what
    /// is allowed by now, as others of the same size may have ended since. True where it grew by more than times vary.
    pub fn took(&mut self, share: Share, elapsed: Duration, busy: bool) -> bool {
        let (before, done) = (self.work, share.work());
        let seconds = elapsed.as_secs_f64().max(1.0e-4);
        let fits = (done as f64 * AIM.as_secs_f64() / seconds) as u64;
        if elapsed > CAP {
            self.work = (fits / 2).max(1);
        } else if fits < self.work {
            // A small remainder takes the time of any dispatch, however short.
            if elapsed > AIM || 2 * done >= self.work {
                self.work = fits.max(1);
            }
        } else if busy {
            self.work = fits.min(done.saturating_mul(2)).max(self.work);
        }
        2 * self.work > 3 * before
    }
}

/// Most iterations of a dispatch that keep every invocation below [`SAFE_TURNS`] loop turns in all, where the
/// driver ends loops after a number of turns.
pub fn ceiling(budget: Option<u32>, turns: u32) -> u32 {
    if budget.is_some() { (SAFE_TURNS / turns.max(1)).max(1) } else { u32::MAX }
}

/// Loop turns of one invocation in one robot step of the shaders under `robot/` and `env/observe`: ten
/// rounds of random numbers, the cell's segment list, and three walks over the segments, 32 at a time.
pub fn step_turns(shared: &CohortData) -> u32 {
    let walk = shared.floor.plan.segments.div_ceil(LANES as u32);
    DRAW + turns(longest_list(&shared.floor.plan, &shared.tables), 0) + 3 * turns(walk, 0)
}

/// Loop turns of one invocation in the dearest iteration: a trial step that runs the nets of all watched skills, of the
/// root and of the skills on the way down to an action, or a replayed transition, which runs the nets forwards and one
/// of them backwards. `holders` are the bits of the skills whose weights lie in workgroup memory then: it may be the
/// first transition of a dispatch and the last one.
pub fn iteration_turns(shared: &CohortData, holders: u32) -> u32 {
    let act = (0..shared.skills.len()).map(|root| act_turns(shared, root)).max().unwrap_or(0);
    let replay = shared.skills.iter().enumerate().map(|(skill, plan)| {
        let held = (holders >> skill) & 1 == 1;
        replay_turns(plan) + if held { 2 * turns(plan.nets, turns(plan.rows, 0)) } else { 0 }
    });
    1 + act.max(replay.max().unwrap_or(0))
}

/// Random numbers of one draw.
const DRAW: u32 = turns(10, 0);

/// A loop of `rounds`, each of which costs `each` beside its own turn. Where it ends is one more.
const fn turns(rounds: u32, each: u32) -> u32 {
    rounds * (each + 1) + 1
}

/// A trial step of skill `root`: it senses, asks the skills, chooses, moves and notes what that brought about.
fn act_turns(shared: &CohortData, root: usize) -> u32 {
    let world = &shared.floor.plan;
    let plan = &shared.skills[root];
    let rooms = turns(world.rooms, 0);
    let paid = EVENTS as u32 + plan.regions * REGION_EVENTS as u32;
    // Regions are asked for the reward and for the goal.
    let score = turns(paid, 0) + 2 * turns(plan.regions, 0);
    let sense = step_turns(shared) + turns((SIDE_LAST - SIDE_FIRST) as u32 + 1, 0) + score;
    let watched = shared.skills[..root].iter().enumerate().filter(|(n, _)| (plan.watched >> n) & 1 == 1);
    let watch = watched.map(|(_, plan)| think_turns(plan, world) + turns(plan.children, 0)).sum::<u32>();
    let choose = think_turns(plan, world) + choice_turns(plan) + child_goal_turns(shared, plan);
    let execute = rooms + turns(world.doors, 0) + rooms;
    sense
        + turns(root as u32, 0)
        + watch
        + choose
        + 1
        + way_turns(shared, plan, plan.watched)
        + turns(root as u32, 0)
        + execute
}

/// Numbers of the skills among a skill's children.
fn child_skills(plan: &SkillShape) -> impl Iterator<Item = u32> {
    plan.child[..plan.children as usize].iter().filter_map(|code| code.checked_sub(SKILL_CODE as u32))
}

/// The dearest way from a skill that has chosen down to an action.
fn way_turns(shared: &CohortData, plan: &SkillShape, watched: u32) -> u32 {
    let turns = child_skills(plan).map(|n| {
        let below = &shared.skills[n as usize];
        let known = (watched >> n) & 1 == 1;
        let think =
            if known { extend_turns(below, &shared.floor.plan) } else { think_turns(below, &shared.floor.plan) };
        1 + think + choice_turns(below) + child_goal_turns(shared, below) + way_turns(shared, below, watched)
    });
    turns.max().unwrap_or(0)
}

/// Whether the child that is being carried out has achieved its goal.
fn child_goal_turns(shared: &CohortData, plan: &SkillShape) -> u32 {
    child_skills(plan).map(|n| turns(shared.skills[n as usize].regions, 0)).max().unwrap_or(0)
}

/// A transition of skill `plan`: the draws of the lesson, of its number and of the step, the children in the mirror,
/// and the nets both ways. Looking through the weights after the last one takes fewer turns.
fn replay_turns(plan: &SkillShape) -> u32 {
    3 * DRAW + turns(plan.children, 0) + nets_turns(plan) + choice_turns(plan) + turns(plan.rows, 0)
}

/// Completing the record of a skill over skills.
fn extend_turns(plan: &SkillShape, world: &WorldUniform) -> u32 {
    let high = plan.record_words > ELEMENTARY_STEP_WORDS as u32;
    if high { turns(plan.children, 0) + turns(world.rooms, 0) } else { 0 }
}

/// Q-values.
fn think_turns(plan: &SkillShape, world: &WorldUniform) -> u32 {
    extend_turns(plan, world) + if plan.planned > 0 { 0 } else { nets_turns(plan) }
}

/// Encoding, all nets forwards, and five rounds of sums over the lanes.
fn nets_turns(plan: &SkillShape) -> u32 {
    let walks = |kind: &&u32| **kind == GROUP_VALUES || **kind == GROUP_APPLICABLE;
    let walks = plan.group_kind[..plan.groups as usize].iter().filter(walks).count() as u32;
    let encode = turns(plan.groups, 0) + walks * turns(plan.children, 0);
    let forward = turns(plan.nets, turns(plan.inputs, 0) + turns(plan.outputs, 0));
    encode + forward + turns(5, turns(plan.children, 0))
}

/// What may be chosen, and what is: the options, the greatest value, the odds and their sum.
fn choice_turns(plan: &SkillShape) -> u32 {
    2 * turns(plan.children, 0) + 2 * turns(MAX_CHILDREN as u32, 0)
}

fn longest_list(plan: &WorldUniform, tables: &[u32]) -> u32 {
    let first = plan.cell_starts as usize;
    let cells = (plan.cell_columns as usize) * (plan.cell_rows as usize);
    let starts = tables.get(first..=first + cells).unwrap_or(&[]);
    starts.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).max().unwrap_or(plan.segments)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settle(seconds_per_iteration: f64, groups: u32, ceiling: u32) -> (Share, f64) {
        let mut governor = Governor::new(None, ceiling);
        let mut longest = 0.0_f64;
        for _ in 0..60 {
            let share = governor.share(groups);
            let seconds = f64::from(share.groups) * f64::from(share.iterations) * seconds_per_iteration;
            longest = longest.max(seconds);
            governor.took(share, Duration::from_secs_f64(seconds), true);
        }
        (governor.share(groups), longest)
    }

    #[test]
    fn dispatches_approach_the_aim_from_below() {
        for (cost, groups) in [(1.0e-9, 65_535), (1.0e-6, 4096), (3.0e-5, 4096), (3.0e-5, 60_000)] {
            let (share, longest) = settle(cost, groups, u32::MAX);
            let seconds = f64::from(share.groups) * f64::from(share.iterations) * cost;
            assert!(seconds > 0.02 && seconds <= 0.06, "{cost}: {seconds}");
            assert!(longest <= 0.25, "{cost}: {longest}");
        }
    }

    #[test]
    fn the_ceiling_and_a_fixed_number_hold() {
        let (share, _) = settle(1.0e-9, 64, 71);
        assert_eq!(share, Share { groups: 64, iterations: 71 });
        assert_eq!(Governor::new(Some(16), 71).share(8).iterations, 16);
        assert_eq!(Governor::new(Some(1600), 71).share(8).iterations, 71);
        assert_eq!(ceiling(None, 400), u32::MAX);
        assert_eq!(ceiling(Some(65_535), 400), 75);
        assert_eq!(ceiling(Some(65_535), 90_000), 1);
    }

    /// Several in flight have the size that was right for the first of them: each must not double it again.
    #[test]
    fn dispatches_of_one_size_let_the_next_grow_once() {
        let mut governor = Governor::new(None, u32::MAX);
        let share = governor.share(64);
        for _ in 0..5 {
            governor.took(share, Duration::from_micros(200), true);
        }
        assert_eq!(governor.share(64).work(), 2 * share.work());
        // A remainder, a shard's last learners say, takes nothing back.
        governor.took(Share { groups: 3, iterations: 1 }, Duration::from_micros(200), true);
        assert_eq!(governor.share(64).work(), 2 * share.work());
    }

    #[test]
    fn an_idle_dispatch_teaches_nothing_but_a_slow_one_does() {
        let mut governor = Governor::new(None, 100);
        let before = governor.share(4096);
        governor.took(before, Duration::from_micros(300), false);
        assert_eq!(governor.share(4096), before);
        governor.took(before, Duration::from_secs(2), false);
        assert!(governor.share(4096).groups < before.groups);
    }
}
