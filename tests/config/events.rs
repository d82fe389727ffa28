//! Rewards and goals about the light, regions and single steps: what they are read as, and their mistakes.

use super::plans::{attempt_files, each_is_refused, read_again};
use super::shipped::refused;
use super::trees::{FAMILY, FLAT, family, relatives, skill};
use skilltree::config::plan::{Event, RegionEvent};
use skilltree::layout::SKILL_EVENTS;

#[test]
fn mistakes_in_events_name_the_way_out() {
    let cases = [
        ("skill.dock.reward={left=1}", "`left` is not one of the events", "left(room:A)"),
        ("skill.dock.reward={'left(room:D)'=1}", "no room or rectangle `room:D`", "`room:A`"),
        ("skill.dock.reward={'left()'=1}", "no room or rectangle ``", "`room:A`"),
        ("skill.dock.reward={'left(room:A'=1}", "`left(room:A` is not one of the events", "left(REGION)"),
        ("skill.dock.reward={'lft(room:A)'=1}", "`lft(room:A)` is not one of the events", "left(REGION)"),
        ("skill.dock.reward={'in(light-area)'=1}", "no room or rectangle `light-area`", "`room:A`"),
        ("skill.dock.reward={'in(anywhere)'=1}", "no room or rectangle `anywhere`", "`room:A`"),
        ("skill.dock.reward={'in(room:A)'=true}", "must be a number", "between"),
        ("skill.dock.reward={stp=-1}", "`stp` is not one of the events", "did you mean `step`"),
        ("skill.dock.goal=['entered(room:b)']", "no room or rectangle `room:b`", "did you mean `room:B`"),
        ("skill.dock.goal=['in(room:A)', 'in(room:A)']", "`in(room:A)` is there twice", "once"),
        ("skill.dock.goal=['in(room:A)', 'in( room:A )']", "`in( room:A )` is there twice", "once"),
    ];
    each_is_refused(&cases, |set| refused(&[set]));
}

#[test]
fn a_skill_names_four_regions_at_most() {
    let areas = |names: &str| {
        let boxes = names.chars().map(|name| format!("{{ name = '{name}', box = [0, 0, 50, 50] }}"));
        format!("{FLAT}regions = [{}]\n", boxes.collect::<Vec<_>>().join(", "))
    };
    let config = "world = 'world.toml'\n[skill.roam]\ninputs = ['sonar']\n\
        reward = { 'in(a)' = 1, 'left(b)' = 2, 'entered(room:B)' = 3, 'in(c)' = 4 }\ngoal = ['left(a)', 'REGION']\n";
    let load = |region: &str| {
        attempt_files(&[("config.toml", &config.replace("REGION", region)), ("world.toml", &areas("abcd"))]).0
    };
    let plan = load("entered(c)").unwrap_or_else(|error| panic!("{error}"));
    let roam = &plan.arms[0].skills[0];
    // The goal is read first.
    assert_eq!(roam.regions, ["a", "c", "b", "room:B"]);
    let mut reward = [0.0; SKILL_EVENTS];
    reward[RegionEvent::In.number(0)] = 1.0;
    reward[RegionEvent::Left.number(2)] = 2.0;
    reward[RegionEvent::Entered.number(3)] = 3.0;
    reward[RegionEvent::In.number(1)] = 4.0;
    assert_eq!(roam.params.reward, reward);
    assert_eq!(roam.goal, 1 << RegionEvent::Left.number(0) | 1 << RegionEvent::Entered.number(1));
    read_again(&plan);
    let error = load("in(d)").expect_err("five regions");
    println!("{error}");
    assert!(error.message().contains("one region more than the events of a skill can name"), "{error}");
    assert!(error.hint().contains("at most 4"), "{error}");
}

#[test]
fn lit_needs_a_light() {
    let config = "world = 'world.toml'\n[skill.roam]\ninputs = ['sonar']\nreward = { lit = 1 }\n";
    let dark = FLAT.replace("light = ", "# light = ");
    let error = attempt_files(&[("config.toml", config), ("world.toml", &dark)]).0.expect_err("no light");
    assert!(error.message().contains("`lit` cannot happen: the world `world` has no light"), "{error}");
    assert!(error.hint().contains("add light"), "{error}");
}

#[test]
fn what_happens_in_a_region_is_its_own_mirror_image() {
    let paid = "{ beside-right = 3, beside-left = -2, collision = -1 }";
    let more = "{ beside-right = 3, step = -1, lit = 2, 'in(room:B)' = 5 }";
    let text = FAMILY.replace(paid, more).replace("'passed-door']\nstarts", "'left(room:A)', 'lit']\nstarts");
    let plan = family(&text, &[]).0.unwrap_or_else(|error| panic!("{error}"));
    let (right, left) = (skill(&plan, "full", "right"), skill(&plan, "full", "left"));
    let mut reward = right.params.reward;
    reward.swap(Event::BesideRight as usize, Event::BesideLeft as usize);
    assert_eq!((left.params.reward, &left.regions), (reward, &right.regions));
    assert_eq!(reward[Event::BesideLeft as usize], 3.0);
    assert_eq!(left.goal ^ right.goal, Event::BesideRight.bit() | Event::BesideLeft.bit());
    assert_ne!(left.goal & 1 << RegionEvent::Left.number(0), 0);
    read_again(&plan);
}

#[test]
fn altered_worlds_need_the_regions_of_the_root() {
    let text = FAMILY.replace("[0, 20, 60]", "[0, 20, 60]\ngoal = ['in(nook)']");
    let nook = "regions = [{ name = 'nook', box = [120, 120, 200, 200] }]\n";
    let files = |altered: &str| {
        let world = |more: &str, name: &str| format!("name = '{name}'\n{FLAT}{more}");
        let (flat, easy, other) = (world(nook, "flat"), world(nook, "easy"), world(altered, "other"));
        let files = [
            ("config.toml", text.as_str()),
            ("worlds/flat.toml", &flat),
            ("worlds/easy.toml", &easy),
            ("other/easy.toml", &other),
        ];
        attempt_files(&files).0
    };
    assert!(files(nook).is_ok());
    let error = files("").expect_err("no nook");
    println!("{error}");
    assert!(error.message().contains("the world `other` has no room or rectangle `nook`"), "{error}");
    assert!(error.hint().contains("`recharge`"), "{error}");
    // What only the skills below the root are about is not asked for.
    assert!(relatives(&["skill.explore.reward={ 'left(room:A)' = 1 }"]).arms.len() == 3);
}
