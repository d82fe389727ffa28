//! Every trial that skills over skills remember, word by word, against the rules and values in f64.

use super::super::configs::number;
use super::super::lessons::remembered;
use super::super::nets64::{Tree64, most};
use super::persistence::{Choice, Chooser, Reason, Rules, Set, members};
use super::three_levels::{home, learned, only_group};
use skilltree::config::plan::{Child, SkillPlan, Threshold};
use skilltree::layout::{NO_CHILD, Step, TERMINATED};
use std::collections::BTreeMap;

/// Every remembered trial of both skills over skills, word by word: what the rules allow, what was applicable, what the
/// children were worth, what was earned.
#[test]
fn remembered_trials_follow_the_rules() {
    let rules = [
        &["skill.leave.interrupt=false", "skill.go-home.persistence=true"][..],
        &["skill.leave.child_timeout=4", "skill.go-home.applicability=true", "skill.leave.persistence='training'"],
        &["skill.leave.persistence=false", "skill.go-home.child_timeout=0"],
    ];
    let mut reasons_seen = BTreeMap::<Reason, u32>::new();
    let (mut steps, mut held, mut applied, mut idle_worths) = (0, 0, 0, 0);
    for set in rules {
        // The root knows both children's worth.
        let more = ["seeds='0..2'", "skill.go-home.applicable={ leave = 0.5, dock = 0.25 }"];
        let plan = home("", &[&more, set].concat());
        let group = only_group(&plan);
        let (cohort, _) = learned(&plan, &group);
        let skills = &plan.arms[0].skills;
        let leave = number(&plan, "leave");
        for learner in 0..2 {
            let nets = &cohort.nets[learner * cohort.nets_stride..][..cohort.nets_stride];
            let tree = Tree64::new(skills, 2, &cohort.shared.skills, nets);
            for name in ["leave", "go-home"] {
                let (number, own) = (number(&plan, name), &skills[number(&plan, name)]);
                let params = &own.params;
                for trial in remembered(&cohort, learner, number) {
                    let header = trial.header;
                    let goal = |child: &Child| match child {
                        Child::Skill(below) => Choice::Skill(members(skills[*below].goal)),
                        Child::Action(action) => Choice::Action(*action as u32),
                    };
                    let rules = Rules {
                        persist: params.persist_training == 1,
                        applicability: params.applicability == 1,
                        interrupt: params.interrupt == 1,
                        patience: (params.child_timeout > 0).then_some(params.child_timeout),
                    };
                    let choices = own.children.iter().map(goal).collect();
                    let mut chooser = Chooser { choices, rules, running: None, before: Set::new() };
                    let (mut happened, mut earned) = (Set::new(), 0.0);
                    for (step, record) in trial.records.iter().enumerate() {
                        let says = || format!("{name}, learner {learner}, step {step}: {chooser:?}");
                        let worths = tree.worths(number, record);
                        let applicable = members(record.high_level >> 8 & 0xff);
                        for (child, threshold) in own.applicable.iter().enumerate() {
                            let (word, below) = (record.value[child], &own.children[child]);
                            let over = *below == Child::Skill(leave);
                            // What a skill over skills is worth depends on what it is doing.
                            let known = !over || chooser.running.is_none_or(|(running, _)| running != child);
                            let worth = if over { idle_worth(&tree, skills, record) } else { worths[child] };
                            match threshold {
                                Some(Threshold::Fixed(least)) => {
                                    if known {
                                        assert!((f64::from(word) - worth).abs() < 2.0e-5, "{}: {word} {worth}", says());
                                    }
                                    assert_eq!(applicable.contains(&child), word > *least, "{}", says());
                                    idle_worths += u32::from(over && known);
                                }
                                _ => assert!(word == 0.0 && applicable.contains(&child), "{}", says()),
                            }
                        }
                        let running = chooser.running.map_or(NO_CHILD, |(child, _)| child as u32);
                        assert_eq!(record.high_level & 0xff, running, "{}", says());
                        let candidates = chooser.candidates(&applicable, None);
                        let reasons = chooser.reasons(&applicable, &happened);
                        let allowed = if reasons.is_empty() { [running as usize].into() } else { candidates.clone() };
                        let offered: Set = if reasons.is_empty() {
                            candidates.union(&allowed).copied().collect()
                        } else {
                            candidates.clone()
                        };
                        let word = record.choice;
                        assert_eq!(members(word >> 8 & 0xff), allowed, "{}", says());
                        assert_eq!(members(word >> 16 & 0xff), offered, "{}", says());
                        assert_eq!(word >> 31 == 1, !reasons.is_empty(), "{}", says());
                        if step == header.steps as usize {
                            assert_eq!((word & 0xff, word >> 24 & 0x7f, record.reward), (NO_CHILD, 0, 0.0));
                            break;
                        }
                        happened = members(word >> 24 & 0x7f);
                        let pay: f32 = happened.iter().map(|event| params.reward[*event]).sum();
                        assert_eq!(record.reward, pay, "{}", says());
                        earned += pay;
                        let ended = happened.iter().any(|event| own.goal >> event & 1 == 1);
                        assert_eq!(ended, step + 1 == header.steps as usize && header.end == TERMINATED, "{}", says());
                        let child = (word & 0xff) as usize;
                        assert!(allowed.contains(&child), "{}", says());
                        if let [only] = reasons.as_slice() {
                            *reasons_seen.entry(*only).or_default() += 1;
                        }
                        steps += 1;
                        held += u32::from(reasons.is_empty());
                        applied += u32::from(candidates.len() < own.children.len());
                        chooser.take(child, !reasons.is_empty(), applicable);
                    }
                    assert_eq!(header.reward, earned);
                    assert!(header.end == TERMINATED || header.steps == params.max_steps);
                }
            }
        }
    }
    println!("{steps} {held} {applied} {idle_worths} {reasons_seen:?}");
    assert!(steps > 2000 && held > 500 && applied > 100 && idle_worths > 200);
    for reason in [Reason::Unbound, Reason::Idle, Reason::Achieved, Reason::Fresh, Reason::Lost, Reason::Late] {
        assert!(reasons_seen.contains_key(&reason), "{reason:?}: {reasons_seen:?}");
    }
}

/// What `leave` is worth while nobody has asked it for a step: the best of its values, given the worth of `pass-door`.
fn idle_worth(tree: &Tree64<'_>, skills: &[SkillPlan], record: &Step) -> f64 {
    let leave = skills.iter().position(|skill| skill.name == "leave").expect("the skill");
    let worths = tree.worths(leave, record);
    let mut own = *record;
    let applicable = (0..3).filter(|child| skills[leave].applicable[*child].is_none() || worths[*child] > 0.3);
    own.high_level = NO_CHILD | applicable.fold(0, |bits, child| bits | 1 << (8 + child));
    for (child, worth) in worths.iter().enumerate() {
        own.value[child] = *worth as f32;
    }
    most(tree.values(leave, &own))
}

/// Baselines that choose at random or in order do so in training too.
#[test]
fn baselines_choose_in_training_too() {
    for choice in ["random", "fixed-priority"] {
        let short = ["skill.dock.trials=4", "skill.pass-door.trials=4", "skill.follow-right.trials=2", "seeds='0..2'"];
        let root = format!("skill.go-home.policy={choice}");
        let plan = home("", &[short.as_slice(), &[&root, "skill.go-home.applicability=true"]].concat());
        let (cohort, _) = learned(&plan, &only_group(&plan));
        let mut counts = BTreeMap::<Vec<usize>, [u32; 2]>::new();
        for learner in 0..2 {
            for trial in remembered(&cohort, learner, number(&plan, "go-home")) {
                for Step { choice: word, .. } in trial.steps() {
                    let (child, allowed) = ((word & 0xff) as usize, members(word >> 8 & 0xff));
                    counts.entry(allowed.into_iter().collect()).or_default()[child] += 1;
                }
            }
        }
        println!("{choice}: {counts:?}");
        let [first, second] = counts[&vec![0, 1]];
        let total = f64::from(first + second);
        assert!(total > 40.0);
        match choice {
            "random" => assert!((f64::from(first) - total / 2.0).abs() < 2.5 * total.sqrt(), "{counts:?}"),
            _ => assert_eq!(second, 0),
        }
    }
}
