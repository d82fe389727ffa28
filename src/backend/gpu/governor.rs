//! How much work one dispatch is given: short enough for watchdogs, desktops and drivers that cut loops.

use super::canary::SAFE_TURNS;
use crate::learner::layout::{LANES, MAX_CHILDREN, RECORD_WORDS, SkillPlan, WorldPlan};
use crate::learner::memory::Shared;
use std::time::Duration;

/// Duration that dispatches aim at.
const AIM: Duration = Duration::from_millis(50);
/// A dispatch that took longer than this is followed by one far shorter.
const CAP: Duration = Duration::from_millis(250);
/// Workgroup-quanta of the first dispatch, which no device takes long for.
const FIRST: u64 = 1024;
/// Most workgroups along one axis of a dispatch (WebGPU's limit).
pub const GROUPS: u32 = 65_535;

/// Chooses quanta and workgroups of the next dispatch from how long the last ones took.
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
    /// Quanta of each.
    pub quanta: u32,
}

impl Governor {
    /// A governor that uses `fixed` quanta if given, and never more than `ceiling`.
    pub fn new(fixed: Option<u32>, ceiling: u32) -> Self {
        Self { fixed, ceiling: ceiling.max(1), work: FIRST }
    }

    /// Lowers or lifts the ceiling, as another world or tree of skills asks for.
    pub fn set_ceiling(&mut self, ceiling: u32) {
        self.ceiling = ceiling.max(1);
    }

    /// The next dispatch over `waiting` workgroups: all of them with as many quanta as fit, or a part of
    /// them with one quantum each.
    pub fn share(&self, waiting: u32) -> Share {
        let waiting = waiting.clamp(1, GROUPS);
        let groups = u64::from(waiting).min(self.work.max(1)) as u32;
        let quanta = (self.work / u64::from(groups)).clamp(1, u64::from(self.ceiling)) as u32;
        Share { groups, quanta: self.fixed.map_or(quanta, |fixed| fixed.clamp(1, self.ceiling)) }
    }

    /// Learns from a dispatch. `busy` says whether most of its workgroups had work to the end: one that was
    /// over early says nothing about how long a full one would take.
    pub fn took(&mut self, share: Share, elapsed: Duration, busy: bool) {
        let done = u64::from(share.groups) * u64::from(share.quanta);
        let seconds = elapsed.as_secs_f64().max(1.0e-4);
        let fits = (done as f64 * AIM.as_secs_f64() / seconds) as u64;
        if elapsed > CAP {
            self.work = (fits / 2).max(1);
        } else if fits < self.work {
            self.work = fits.max(1);
        } else if busy {
            self.work = fits.min(self.work.saturating_mul(2));
        }
    }
}

/// Most quanta of a dispatch that keep every invocation below [`SAFE_TURNS`] loop turns in all, where the
/// driver ends loops after a number of turns.
pub fn ceiling(budget: Option<u32>, turns: u32) -> u32 {
    if budget.is_some() { (SAFE_TURNS / turns.max(1)).max(1) } else { u32::MAX }
}

/// Loop turns of one invocation in one robot step of the shaders under `robot/` and `skill/observe`: ten
/// rounds of random numbers, the cell's segment list, and three walks over the segments, 32 at a time.
pub fn step_turns(shared: &Shared) -> u32 {
    let walk = shared.floor.plan.segments.div_ceil(LANES as u32);
    10 + longest_list(&shared.floor.plan, &shared.atlas) + 3 * walk
}

/// Loop turns of one invocation in the dearest quantum: the last step of a trial, which senses twice, or a
/// replayed transition, which runs the nets forwards and one of them backwards.
pub fn quantum_turns(shared: &Shared) -> u32 {
    let plan = &shared.floor.plan;
    let nets = shared.skills.iter().map(decision_turns).max().unwrap_or(0);
    let rows = shared.skills.iter().map(|skill| skill.rows).max().unwrap_or(0);
    let act = 2 * step_turns(shared) + 2 * (plan.rooms + plan.doors) + 8;
    let replay = rows + 20 + RECORD_WORDS as u32;
    nets + act.max(replay)
}

/// Encoding, all nets forwards, five rounds of sums over the lanes, and the choice.
fn decision_turns(skill: &SkillPlan) -> u32 {
    let forward = skill.children * (skill.inputs + 1) + 5 * (skill.children + 1);
    skill.groups + forward + skill.children + 2 * MAX_CHILDREN as u32
}

fn longest_list(plan: &WorldPlan, atlas: &[u32]) -> u32 {
    let first = plan.cell_starts as usize;
    let cells = (plan.cell_columns as usize) * (plan.cell_rows as usize);
    let starts = atlas.get(first..=first + cells).unwrap_or(&[]);
    starts.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).max().unwrap_or(plan.segments)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settle(seconds_per_quantum: f64, groups: u32, ceiling: u32) -> (Share, f64) {
        let mut governor = Governor::new(None, ceiling);
        let mut longest = 0.0_f64;
        for _ in 0..60 {
            let share = governor.share(groups);
            let seconds = f64::from(share.groups) * f64::from(share.quanta) * seconds_per_quantum;
            longest = longest.max(seconds);
            governor.took(share, Duration::from_secs_f64(seconds), true);
        }
        (governor.share(groups), longest)
    }

    #[test]
    fn dispatches_approach_the_aim_from_below() {
        for (cost, groups) in [(1.0e-9, 65_535), (1.0e-6, 4096), (3.0e-5, 4096), (3.0e-5, 60_000)] {
            let (share, longest) = settle(cost, groups, u32::MAX);
            let seconds = f64::from(share.groups) * f64::from(share.quanta) * cost;
            assert!(seconds > 0.02 && seconds <= 0.06, "{cost}: {seconds}");
            assert!(longest <= 0.25, "{cost}: {longest}");
        }
    }

    #[test]
    fn the_ceiling_and_a_fixed_number_hold() {
        let (share, _) = settle(1.0e-9, 64, 71);
        assert_eq!(share, Share { groups: 64, quanta: 71 });
        assert_eq!(Governor::new(Some(16), 71).share(8).quanta, 16);
        assert_eq!(Governor::new(Some(1600), 71).share(8).quanta, 71);
        assert_eq!(ceiling(None, 400), u32::MAX);
        assert_eq!(ceiling(Some(65_535), 400), 75);
        assert_eq!(ceiling(Some(65_535), 90_000), 1);
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
