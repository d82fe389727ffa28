//! Skills whose goals and rewards are about regions, in whole runs of the shipped kernels. What a skill earned tells
//! where the robot was, and that must agree with when its children ended.

use super::super::configs::{number, plan_in};
use super::super::lessons::remembered;
use super::three_levels::{learned, only_group};
use skilltree::layout::{EPISODE_TERMINATED, TERMINATED};

const TREE: &str = r#"
    title = "regions"
    seeds = "0..3"
    root = "top"
    [evaluate]
    at = [0]
    episodes = 10
    [teacher]
    lessons = 8
    eval_episodes = 10
    [learning]
    inverse_temperature_start = 1.0
    inverse_temperature_end = 2.0
    replays = 5
    replay_capacity = 60
    [skill.leave]
    inputs = ["sonar(60)", "bumpers"]
    reward = { "left(room:A)" = 100, step = -1 }
    starts = "room:A"
    eval_starts = "room:A"
    goal = ["left(room:A)"]
    lessons = 4
    trials = 60
    [skill.stay]
    inputs = ["sonar(60)", "light"]
    reward = { "in(room:A)" = 1, lit = 16 }
    starts = "room:A"
    eval_starts = "room:A"
    goal = ["in(room:A)"]
    trials = 10
    [skill.top]
    children = ["leave", "stay"]
    inputs = ["sonar-far", "running"]
    reward = { "entered(room:B)" = 8, "in(room:A)" = 1, "left(room:A)" = 4, step = 32 }
    starts = "anywhere"
    eval_starts = "room:A"
    goal = ["entered(room:B)"]
    max_steps = 50
    interrupt = false
    child_timeout = 0
    trials = 40
"#;

#[test]
fn children_end_where_their_regions_say() {
    let plan = plan_in("easy", TREE, &[]);
    let group = only_group(&plan);
    let (cohort, tests) = learned(&plan, &group);
    let (mut left, mut kept, mut stayed, mut entered) = (0, 0, 0, 0);
    for learner in 0..3 {
        // A return is told by the number of steps and how it ended.
        for trial in remembered(&cohort, learner, number(&plan, "leave")) {
            let bonus = if trial.header.end == TERMINATED { 100.0 } else { 0.0 };
            assert_eq!(trial.header.reward, bonus - trial.header.steps as f32);
        }
        for trial in remembered(&cohort, learner, number(&plan, "stay")) {
            // The first step from room A leaves it or ends the trial, whichever way; lit is what the sensor says.
            for pair in trial.records.windows(2) {
                let lit = if pair[1].observation.light_bumpers & 0x00ff_ffff == 0 { 0.0 } else { 16.0 };
                assert!(pair[0].reward == lit || pair[0].reward == lit + 1.0, "{:?}", pair[0]);
            }
            let last = trial.records[trial.header.steps as usize - 1].reward;
            assert_eq!(trial.header.end == TERMINATED, last as u32 & 1 == 1);
        }
        for trial in remembered(&cohort, learner, number(&plan, "top")) {
            for (step, pair) in trial.records[..=trial.header.steps as usize].windows(2).enumerate() {
                let paid = pair[0].reward as u32;
                assert_eq!(paid & !15, 32, "every step is paid");
                let [in_a, left_a, entered_b] = [1, 4, 8].map(|bit| paid & bit == bit);
                assert!(!(in_a && (left_a || entered_b)), "it is in room A or has left it");
                let last = step + 1 == trial.header.steps as usize;
                assert_eq!(entered_b, last && trial.header.end == TERMINATED);
                let ended = if pair[0].choice & 0xff == 0 { left_a } else { in_a };
                assert_eq!(pair[1].choice >> 31 == 1, ended, "step {step}: {paid}");
                *(if pair[0].choice & 0xff == 1 {
                    &mut stayed
                } else if ended {
                    &mut left
                } else {
                    &mut kept
                }) += 1;
                entered += u32::from(entered_b);
            }
        }
    }
    println!("{left} {kept} {stayed} {entered}");
    assert!(left > 20 && kept > 200 && stayed > 200 && entered > 20, "{left} {kept} {stayed} {entered}");
    // With the few lessons that it has, it leaves the room more often than not.
    let [_, after] = &tests[number(&plan, "leave")];
    assert!(after.iter().filter(|episode| episode.state == EPISODE_TERMINATED).count() > after.len() / 2);
}
