//! The Applicability Rule and the Persistence Rule against a plain reference: sets of numbers, no bits. It is written
//! from what the paper's section VI.B says in words (only applicable skills count; a skill goes on until its goal is
//! achieved or another skill becomes applicable that was not) and from the meaning of the keys that are ours.

use super::super::oracle::Written;
use super::super::random::random;
use bytemuck::Zeroable;
use skilltree::env::workgroup::Workgroup;
use skilltree::kernels::plain::PLAIN;
use skilltree::layout::{HyperParams, MAX_SKILLS, NO_CHILD, SKILL_CODE, SkillShape};
use skilltree::train::observation::floor_only;
use std::collections::BTreeSet;

pub(crate) type Set = BTreeSet<usize>;

/// The rules of a skill.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rules {
    pub(crate) persist: bool,
    pub(crate) applicability: bool,
    pub(crate) interrupt: bool,
    /// Steps without any event after which the choice is open again.
    pub(crate) patience: Option<u32>,
}

/// Something to choose.
#[derive(Debug, Clone)]
pub(crate) enum Choice {
    /// An action, by its code. It ends by itself.
    Action(u32),
    /// A skill, and the events that achieve its goal.
    Skill(Set),
}

/// A skill that chooses, and what it is doing.
#[derive(Debug, Clone)]
pub(crate) struct Chooser {
    pub(crate) choices: Vec<Choice>,
    pub(crate) rules: Rules,
    /// The child that runs, and for how many steps since it was freely chosen.
    pub(crate) running: Option<(usize, u32)>,
    /// What was applicable when it was last asked.
    pub(crate) before: Set,
}

/// Why a choice is free.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Reason {
    Unbound,
    Idle,
    Action,
    Achieved,
    Fresh,
    Lost,
    Late,
}

impl Chooser {
    /// What a free choice is made among.
    pub(crate) fn candidates(&self, applicable: &Set, blocked: Option<u32>) -> Set {
        let pushes = |child: &usize| match self.choices[*child] {
            Choice::Action(code) => Some(code) == blocked && self.choices.len() > 1,
            Choice::Skill(_) => false,
        };
        let all: Set = (0..self.choices.len()).filter(|child| !pushes(child)).collect();
        let suited: Set = all.intersection(applicable).copied().collect();
        if self.rules.applicability && !suited.is_empty() { suited } else { all }
    }

    /// Reasons for which the choice is free; none where the running child goes on.
    pub(crate) fn reasons(&self, applicable: &Set, happened: &Set) -> Vec<Reason> {
        let mut reasons = Vec::new();
        if !self.rules.persist {
            reasons.push(Reason::Unbound);
        }
        let Some((child, steps)) = self.running else {
            reasons.push(Reason::Idle);
            return reasons;
        };
        match &self.choices[child] {
            Choice::Action(_) => reasons.push(Reason::Action),
            Choice::Skill(goals) if !goals.is_disjoint(happened) => reasons.push(Reason::Achieved),
            Choice::Skill(_) => {}
        }
        if applicable.iter().any(|other| *other != child && !self.before.contains(other)) {
            reasons.push(Reason::Fresh);
        }
        if self.rules.interrupt && !applicable.contains(&child) {
            reasons.push(Reason::Lost);
        }
        if self.rules.patience.is_some_and(|patience| steps >= patience) {
            reasons.push(Reason::Late);
        }
        reasons
    }

    /// Takes a child for the next step.
    pub(crate) fn take(&mut self, child: usize, free: bool, applicable: Set) {
        let steps = if free { 0 } else { self.running.map_or(0, |(_, steps)| steps) };
        self.running = Some((child, steps + 1));
        self.before = applicable;
    }
}

pub(crate) fn bits(set: &Set) -> u32 {
    set.iter().fold(0, |bits, child| bits | 1 << child)
}

/// The children or events whose bits are set.
pub(crate) fn members(bits: u32) -> Set {
    (0..32).filter(|bit| bits >> bit & 1 == 1).collect()
}

/// A chooser and the product's words for it. Skills are numbered from 1 to 7; number 0 is the chooser's own.
fn made_up(next: &mut impl FnMut() -> f64) -> (Chooser, Vec<SkillShape>, HyperParams) {
    let mut skills = vec![SkillShape::zeroed(); 8];
    let mut params = HyperParams::zeroed();
    let rules = Rules {
        persist: next() < 0.85,
        applicability: next() < 0.7,
        interrupt: next() < 0.4,
        patience: [None, None, Some(1), Some(2), Some(5), Some(30), Some(255)][(next() * 7.0) as usize],
    };
    let count = 1 + (next() * 8.0) as usize;
    let share = [0.0, 0.5, 1.0, 1.0][(next() * 4.0) as usize];
    let mut choices = Vec::new();
    let (mut below, mut actions) = (Vec::from_iter(1..8_usize), Vec::from_iter(0..6_u32));
    for child in 0..count {
        if next() < share && !below.is_empty() || actions.is_empty() {
            let number = below.remove((next() * below.len() as f64) as usize);
            let goals = members((next() * 32.0) as u32 & (next() * 32.0) as u32);
            skills[number].ends = bits(&goals);
            skills[0].child[child] = (SKILL_CODE + number) as u32;
            choices.push(Choice::Skill(goals));
        } else {
            let code = actions.remove((next() * actions.len() as f64) as usize);
            skills[0].child[child] = code;
            choices.push(Choice::Action(code));
        }
    }
    skills[0].children = count as u32;
    params.applicability = u32::from(rules.applicability);
    // Another skill may have been blocked, which does not bind one that masks nothing.
    params.mask_blocked = u32::from(next() < 0.8);
    params.interrupt = u32::from(rules.interrupt);
    params.child_timeout = rules.patience.unwrap_or(0);
    (Chooser { choices, rules, running: None, before: Set::new() }, skills, params)
}

#[test]
fn allowed_sets_and_decisions_are_those_of_the_rules() {
    let mut next = random(1);
    let room = floor_only(&Written::room(100.0, 100.0).world());
    let mut seen = std::collections::BTreeMap::<Reason, u32>::new();
    let (mut held, mut long, mut fallen_back, mut blocked_out, mut kept_on) = (0, 0, 0, 0, 0);
    for round in 0..600 {
        let (mut chooser, skills, params) = made_up(&mut next);
        let high = chooser.choices.iter().any(|choice| matches!(choice, Choice::Skill(_)));
        let params = [params];
        let mut group = Workgroup { skills: &skills, ..Workgroup::new(&room, &params, &PLAIN) };
        group.agent.run = [NO_CHILD; MAX_SKILLS];
        // Some worlds are calm, so that skills run for long.
        let (change, event) = [(0.5, 0.3), (0.05, 0.02), (0.0, 0.0)][round % 3];
        let mut applicable = members((next() * 256.0) as u32);
        for step in 0..320 {
            applicable = if next() < change { members((next() * 256.0) as u32) } else { applicable };
            let mut own: Set = applicable.iter().copied().filter(|child| *child < chooser.choices.len()).collect();
            // Actions have no threshold: they always are applicable.
            own.extend((0..chooser.choices.len()).filter(|c| matches!(chooser.choices[*c], Choice::Action(_))));
            let happened = if next() < event { members((next() * 32.0) as u32) } else { Set::new() };
            let blocked = if next() < 0.3 { Some((next() * 6.0) as u32) } else { None };
            group.agent.events = bits(&happened);
            group.agent.blocked = blocked.unwrap_or(255);
            // A record of actions alone has no such word: what stands there is of another skill.
            let word = if high { bits(&own) << 8 } else { (next() * 16_777_216.0) as u32 };
            group.record.high_level = word | (next() * 256.0) as u32;
            let found = group.action_mask(0, chooser.rules.persist);

            let candidates = chooser.candidates(&own, blocked.filter(|_| params[0].mask_blocked == 1));
            let reasons = chooser.reasons(&own, &happened);
            let running = chooser.running.map(|(child, _)| child);
            let allowed = if reasons.is_empty() { running.into_iter().collect() } else { candidates.clone() };
            let says = || format!("round {round} step {step}: {chooser:?} {own:?} {happened:?} {blocked:?}");
            // Where the running child may not be left, a step is learned with it, applicable or not.
            let offered: Set =
                if reasons.is_empty() { candidates.union(&allowed).copied().collect() } else { candidates.clone() };
            kept_on += u32::from(offered.len() > candidates.len());
            assert_eq!(members(found.offered), offered, "{}", says());
            assert_eq!(members(found.allowed), allowed, "{}", says());
            assert_eq!(found.decision == 1, !reasons.is_empty(), "{}", says());
            assert_eq!(members(found.applicable), own, "{}", says());

            // Each reason by itself.
            if let [only] = reasons.as_slice() {
                *seen.entry(*only).or_default() += 1;
            }
            held += u32::from(reasons.is_empty());
            long += u32::from(chooser.running.is_some_and(|(_, steps)| steps > 255) && reasons.is_empty());
            fallen_back += u32::from(chooser.rules.applicability && own.is_empty());
            blocked_out += u32::from(candidates.len() < own.len() && chooser.rules.applicability);
            let pick = (next() * allowed.len() as f64) as usize;
            let child = allowed.iter().copied().nth(pick).expect("something is allowed");
            if change > 0.0 && next() < 0.02 {
                // Its parent asks another one: it no longer runs.
                group.stop_unasked(1, 0);
                chooser.running = None;
                chooser.before = Set::new();
            } else {
                group.commit(0, child as u32, found);
                group.stop_unasked(1, 1);
                chooser.take(child, !reasons.is_empty(), own);
            }
        }
    }
    println!("{seen:?} {held} {long} {fallen_back} {blocked_out}");
    for reason in [Reason::Unbound, Reason::Idle, Reason::Action, Reason::Achieved, Reason::Fresh, Reason::Lost] {
        assert!(seen.get(&reason).is_some_and(|count| *count > 100), "{reason:?}: {seen:?}");
    }
    assert!(seen.get(&Reason::Late).is_some_and(|count| *count > 100), "{seen:?}");
    assert!(held > 10_000 && long > 500 && fallen_back > 500 && blocked_out > 500 && kept_on > 500, "{kept_on}");
}

/// Skills that are not asked stop; those that are, and the ones above the root, are left alone.
#[test]
fn only_what_is_asked_goes_on_running() {
    let room = floor_only(&Written::room(100.0, 100.0).world());
    let mut group = Workgroup::new(&room, &[], &PLAIN);
    for asked in 0..256_u32 {
        for root in 0..8 {
            let before = std::array::from_fn(|n| 3 | (n as u32) << 8 | 5 << 16);
            group.agent.run = before;
            group.stop_unasked(root, asked);
            for n in 0..8 {
                let kept = n >= root as usize || members(asked).contains(&n);
                assert_eq!(group.agent.run[n], if kept { before[n] } else { NO_CHILD }, "{asked:b} below {root}: {n}");
            }
        }
    }
}
