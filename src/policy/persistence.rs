//! Which children are applicable, and which may be chosen now: the Applicability Rule and the Persistence Rule
//! (paper, section VI.B).

use crate::env::events::room_of;
use crate::env::memory::recall;
use crate::env::motion::NO_ACTION;
use crate::env::workgroup::Scratch;
pub use crate::layout::params::ALWAYS;
use crate::layout::{Agent, BASE_WORDS, HyperParams, MAX_CHILDREN, SKILL_CODE, SkillShape, VALUE_WORD, WorldUniform};
use crate::policy::select::NO_CHILD;

/// State of a skill that does not run: none of its children does.
pub const IDLE: u32 = NO_CHILD;

/// What a skill may choose at one step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Applicable children.
    pub applicable: u32,
    /// What a free choice is made among; where the running child may not be left, that child as well.
    pub choices: u32,
    /// What may be chosen now.
    pub allowed: u32,
    /// 1 where the choice is free.
    pub decision: u32,
}

/// Completes the record with what only skills over skills are given: the running child, the applicable ones, the
/// room, the memories, the children's values.
#[inline(always)]
pub fn extend(
    agent: &Agent,
    world: &WorldUniform,
    scratch: &mut Scratch,
    plan: &SkillShape,
    params: &HyperParams,
    n: u32,
) {
    let mut applicable = 0;
    for child in 0..plan.children {
        let code = plan.child[child as usize];
        let known = code >= SKILL_CODE as u32 && ((plan.thresholded >> child) & 1) == 1;
        let worth = if known { scratch.value[(code as usize) - SKILL_CODE] } else { 0.0 };
        let above = !known || worth > params.threshold[child as usize];
        applicable |= if above { 1 << child } else { 0 };
        scratch.record[VALUE_WORD + child as usize] = worth.to_bits();
    }
    for child in plan.children as usize..MAX_CHILDREN {
        scratch.record[VALUE_WORD + child] = 0;
    }
    let running = agent.run[n as usize] & 0xff;
    scratch.record[BASE_WORDS] = running | applicable << 8 | room_of(world, agent.x, agent.y) << 16;
    recall(agent, scratch);
}

/// What skill `n` may choose. For a skill over actions that is every action, or every action but a blocked one.
#[inline(always)]
pub fn options(
    agent: &Agent,
    scratch: &Scratch,
    skills: &[SkillShape],
    params: &HyperParams,
    n: u32,
    persist: bool,
) -> Options {
    let plan = &skills[n as usize];
    let all = (1 << plan.children) - 1;
    let mut open = 0;
    let mut actions = 0;
    for child in 0..plan.children {
        let code = plan.child[child as usize];
        // A lone child is always available.
        let masked = params.mask_blocked == 1 && code == agent.blocked;
        let free = !masked || plan.children == 1;
        open |= if free { 1 << child } else { 0 };
        actions |= if code < SKILL_CODE as u32 { 1 << child } else { 0 };
    }
    let high = actions != all;
    let applicable = if high { (scratch.record[BASE_WORDS] >> 8) & 0xff } else { all };
    let suited = if params.applicability == 1 { applicable & open } else { open };
    let choices = if suited != 0 { suited } else { open };
    let run = agent.run[n as usize];
    let running = run & 0xff;
    let since = (run >> 8) & 0xff;
    let before = (run >> 16) & 0xff;
    let own = if running < MAX_CHILDREN as u32 { 1 << running } else { 0 };
    let code = if own != 0 { plan.child[running as usize] } else { NO_ACTION };
    // An action ends by itself; a skill ends where its goal is achieved.
    let skill = own != 0 && code >= SKILL_CODE as u32;
    let ends = if skill { skills[(code as usize) - SKILL_CODE].ends } else { 0 };
    let achieved = (agent.events & ends) != 0;
    let fresh = (applicable & !before & !own) != 0;
    let lost = params.interrupt == 1 && (applicable & own) == 0;
    let late = params.child_timeout > 0 && since >= params.child_timeout;
    let free = !persist || !skill || achieved || fresh || lost || late;
    // What runs on is an alternative, even where it is no longer applicable: the step is learned with it.
    let offered = if free { choices } else { choices | own };
    Options { applicable, choices: offered, allowed: if free { choices } else { own }, decision: u32::from(free) }
}

/// Notes that skill `n` has chosen `child`.
#[inline(always)]
pub fn commit(agent: &mut Agent, n: u32, child: u32, options: Options) {
    let since = (agent.run[n as usize] >> 8) & 0xff;
    let counted = if options.decision == 1 { 1 } else { since + 1 };
    let held = if counted < 255 { counted } else { 255 };
    agent.run[n as usize] = child | held << 8 | options.applicable << 16;
}

/// Skills that were not asked at this step no longer run.
#[inline(always)]
pub fn rest(agent: &mut Agent, root: u32, asked: u32) {
    for n in 0..root {
        agent.run[n as usize] = if ((asked >> n) & 1) == 1 { agent.run[n as usize] } else { IDLE };
    }
}
