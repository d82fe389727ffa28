//! Figures of each skill and of the world.

use super::curves::{self, Curve, Figure, MOST_CURVES, MOST_SMALL, Point};
use super::numbers::{number, seeds};
use super::stairs::{self, Stair, Staircase};
use super::statistics::{BAND_RESAMPLES, bootstrap, mean, performance_profile, profile_band};
use super::summary::{Cell, Score, Series, Skill, Summary};
use super::{floor, trace};
use crate::run_folder::{PlaceReading, Trajectory};
use crate::world::World;
use rayon::prelude::*;

/// A figure as it goes into a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// File name without its ending.
    pub name: String,
    /// Where on the page it stands.
    pub section: Section,
    /// The SVG document.
    pub svg: String,
}

/// A part of the page that has figures.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Section {
    /// The sweep of the arm of this name.
    Sweep(String),
    /// The paper's Figure 2, with its seven seeds.
    Paper,
    /// The same, with all seeds.
    All,
    /// Learning curves over trials and over actions.
    Budget,
    /// Success by starting room.
    Rooms,
    /// Example trials.
    Trajectories,
    /// Floor plans of alterations and of arms elsewhere.
    Elsewhere,
    /// The skill of this name.
    Skill(String),
    /// The floor plan and the sensors.
    World,
}

/// What a curve is drawn from.
pub(super) struct Measure {
    pub(super) file: &'static str,
    pub(super) heading: &'static str,
    pub(super) subtitle: &'static str,
    pub(super) y_title: &'static str,
    pub(super) percent: bool,
    pub(super) against_actions: bool,
    pub(super) value: fn(&Score) -> f64,
}

pub(super) const SUCCESS: Measure = Measure {
    file: "learning",
    heading: "success against training trials",
    subtitle: "Share of greedy test trials that ended as achieved.",
    y_title: "test trials achieved",
    percent: true,
    against_actions: false,
    value: Score::success,
};

const ENDING: [Measure; 3] = [
    SUCCESS,
    Measure {
        file: "steps",
        heading: "steps of a test trial against training trials",
        subtitle: "Mean primitive steps of a greedy test trial; failed trials count with their step limit.",
        y_title: "steps per test trial",
        percent: false,
        against_actions: false,
        value: Score::steps_per_trial,
    },
    Measure {
        file: "actions",
        heading: "success against executed actions",
        subtitle: "Share of greedy test trials that ended as achieved. Actions: in teaching and for child skills too.",
        against_actions: true,
        ..SUCCESS
    },
];

/// Of skills that never end, as following a wall: trials are as long as their limit, and none is achieved.
const UNENDING: [Measure; 1] = [Measure {
    file: "return",
    heading: "return of a test trial against training trials",
    subtitle: "Mean discounted return of a greedy test trial, in the config's units of reward.",
    y_title: "return per test trial",
    percent: false,
    against_actions: false,
    value: Score::return_per_trial,
}];

/// Limits of a performance profile.
const PROFILE_LIMITS: u32 = 100;

/// Curves of every skill that was tested more than once.
pub fn learning(summary: &Summary) -> Vec<Drawing> {
    let curved = |skill: &&Skill| skill.series.iter().any(|series| series.cells.len() > 1);
    let measures = |skill: &Skill| if skill.never_ends() { &UNENDING[..] } else { &ENDING };
    let skills = summary.skills.iter().filter(curved);
    let figures: Vec<_> = skills
        .flat_map(|skill| {
            let profile = (!skill.never_ends()).then_some((skill, None));
            measures(skill).iter().map(move |measure| (skill, Some(measure))).chain(profile)
        })
        .collect();
    let drawing = |(skill, measure): (&Skill, Option<&Measure>)| match measure {
        Some(measure) => draw(skill, measure),
        None => profile(skill),
    };
    figures.into_par_iter().map(drawing).collect()
}

/// How the seeds of each arm differ: the performance profile of their last tests.
fn profile(skill: &Skill) -> Drawing {
    let all = skill.distinct();
    let limits: Vec<f64> = (0..PROFILE_LIMITS).map(|i| f64::from(i) / f64::from(PROFILE_LIMITS)).collect();
    let shown: Vec<_> = all.iter().take(MOST_SMALL).collect();
    let curve = |(series, copies): &&(&Series, Vec<&str>)| {
        let success = series.last().values(Score::success);
        let strata = [success.as_slice()];
        let shares = performance_profile(&strata, &limits);
        let bands = profile_band(&strata, &limits, BAND_RESAMPLES);
        let stairs = limits.iter().zip(shares).zip(bands).map(|((&x, y), band)| Stair { x, y, band });
        Staircase { label: with_copies(series, copies), stairs: stairs.collect(), end: 1.0 }
    };
    let mut notes = vec![
        format!("{}. Bands: 95% percentile bootstrap", seeds_of(&skill.series)),
        format!("interval ({} resamples of seeds).", number(BAND_RESAMPLES as f64)),
    ];
    if all.len() > MOST_SMALL {
        notes.push(format!("The first {MOST_SMALL} of {} series.", all.len()));
    }
    let figure = stairs::Figure {
        title: format!("{}: performance profile", skill.name),
        subtitle: "Share of seeds whose success at the last test exceeds x.".into(),
        notes,
        x_title: "success at the last test".into(),
        y_title: "seeds above".into(),
        x_range: (0.0, 1.0),
        x_percent: true,
        curves: shown.iter().map(curve).collect(),
    };
    Drawing {
        name: format!("profile-{}", file_word(&skill.name)),
        section: Section::Skill(skill.name.clone()),
        svg: stairs::draw(&figure),
    }
}

/// The floor plan and the sensors at its places.
pub fn floor(world: &World, places: &[PlaceReading]) -> Vec<Drawing> {
    let mut drawings =
        vec![Drawing { name: "world".into(), section: Section::World, svg: floor::draw_world(world, floor::LARGE) }];
    for reading in places {
        let place = &reading.place;
        drawings.push(Drawing {
            name: format!("sonar-{}", file_word(place)),
            section: Section::World,
            svg: floor::draw_sonar(world, reading),
        });
        drawings.push(Drawing {
            name: format!("light-{}", file_word(place)),
            section: Section::World,
            svg: floor::draw_light(world, reading),
        });
    }
    drawings
}

/// Another floor plan of the run.
pub fn elsewhere(world: &World, file: &str) -> Drawing {
    let name = file.trim_start_matches("worlds/").trim_end_matches(".toml");
    let name = format!("world-{}", file_word(name));
    Drawing { name, section: Section::Elsewhere, svg: floor::draw_world(world, floor::SMALL) }
}

/// An example trial.
pub fn way(trajectory: &Trajectory, world: &World) -> Drawing {
    let name = format!("trial-{}-{}", file_word(&trajectory.arm), file_word(&trajectory.place));
    Drawing { name, section: Section::Trajectories, svg: trace::draw(world, trajectory) }
}

fn draw(skill: &Skill, measure: &Measure) -> Drawing {
    let all = skill.distinct();
    let mut notes = vec![seeds_note(&skill.series)];
    if all.len() > MOST_CURVES {
        notes.push(format!("The first {MOST_CURVES} of {} series; the table holds all.", all.len()));
    } else if measure.against_actions {
        notes.push("A point lies at the mean number of actions over seeds.".into());
    } else if all.iter().any(|(_, copies)| !copies.is_empty()) {
        notes.push("+ a number: so many other arms have the same numbers: they learned the skill together.".into());
    }
    let curves = all
        .iter()
        .take(MOST_CURVES)
        .map(|(series, copies)| Curve { label: with_copies(series, copies), ..curve(series, measure) });
    let figure = Figure {
        title: format!("{}: {}", skill.name, measure.heading),
        subtitle: measure.subtitle.into(),
        notes,
        x_title: if measure.against_actions { "executed actions" } else { "training trials" }.into(),
        y_title: measure.y_title.into(),
        percent: measure.percent,
        bound: skill.bounds.first().map(|bound| ("planner (bound)".into(), (measure.value)(&bound.score))),
        curves: curves.collect(),
        small: false,
        ends: None,
    };
    Drawing {
        name: format!("{}-{}", measure.file, file_word(&skill.name)),
        section: Section::Skill(skill.name.clone()),
        svg: curves::draw(&figure),
    }
}

/// A series' label, with the number of arms that have its numbers too.
pub(super) fn with_copies(series: &Series, copies: &[&str]) -> String {
    if copies.is_empty() { series.label.clone() } else { format!("{} +{}", series.label, copies.len()) }
}

pub(super) fn curve(series: &Series, measure: &Measure) -> Curve {
    let point = |cell: &Cell| {
        let values = cell.values(measure.value);
        let actions = mean(&cell.values(|score| f64::from(score.actions)));
        Point {
            x: if measure.against_actions { actions } else { f64::from(cell.trials) },
            y: mean(&values),
            band: bootstrap(&values, mean, BAND_RESAMPLES),
        }
    };
    Curve { label: series.label.clone(), points: series.cells.iter().map(point).collect() }
}

/// `n = 32 seeds per arm`.
fn seeds_of(series: &[Series]) -> String {
    let counts = || series.iter().map(|series| series.last().scores.len());
    let (least, most) = (counts().min().unwrap_or(0), counts().max().unwrap_or(0));
    if least == most { format!("n = {} per arm", seeds(most)) } else { format!("n = {least} to {most} seeds per arm") }
}

/// Says how many seeds there are and what the bands mean.
fn seeds_note(series: &[Series]) -> String {
    format!(
        "Lines: mean over {}. Bands: 95% percentile bootstrap interval of the mean ({} resamples of seeds).",
        seeds_of(series),
        number(BAND_RESAMPLES as f64)
    )
}

/// A name as part of a file name: what could mislead a file system becomes `-`.
pub(super) fn file_word(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || matches!(c, '-' | '_' | '+') { c } else { '-' }).collect()
}
