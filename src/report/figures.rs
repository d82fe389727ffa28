//! Which figures a report has, and what each shows.

use super::curves::{self, Curve, Figure, MOST_CURVES, Point};
use super::floor;
use super::statistics::{BAND_RESAMPLES, bootstrap, mean};
use super::summary::{Cell, Score, Series, Skill, Summary};
use crate::record::PlaceReading;
use crate::world::World;

/// A figure as it goes into a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// File name without its ending.
    pub name: String,
    /// The skill that it is about, or none for the world.
    pub skill: Option<String>,
    /// The SVG document.
    pub svg: String,
}

/// What a curve is drawn from.
struct Measure {
    file: &'static str,
    heading: &'static str,
    subtitle: &'static str,
    y_title: &'static str,
    percent: bool,
    against_actions: bool,
    value: fn(&Score) -> f64,
}

const MEASURES: [Measure; 3] = [
    Measure {
        file: "learning",
        heading: "success against training trials",
        subtitle: "Share of greedy test trials that ended as achieved.",
        y_title: "test trials achieved",
        percent: true,
        against_actions: false,
        value: Score::success,
    },
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
        y_title: "test trials achieved",
        percent: true,
        against_actions: true,
        value: Score::success,
    },
];

/// All figures of curves.
pub fn learning(summary: &Summary) -> Vec<Drawing> {
    let trained = summary.skills.iter().filter(|skill| !skill.series.is_empty());
    trained.flat_map(|skill| MEASURES.iter().map(|measure| draw(skill, measure))).collect()
}

/// The floor plan and the sensors at its places.
pub fn floor(world: &World, places: &[PlaceReading]) -> Vec<Drawing> {
    let mut drawings = vec![Drawing { name: "world".into(), skill: None, svg: floor::draw_world(world) }];
    for reading in places {
        let place = &reading.place;
        drawings.push(Drawing {
            name: format!("sonar-{}", file_word(place)),
            skill: None,
            svg: floor::draw_sonar(world, reading),
        });
        drawings.push(Drawing {
            name: format!("light-{}", file_word(place)),
            skill: None,
            svg: floor::draw_light(world, reading),
        });
    }
    drawings
}

fn draw(skill: &Skill, measure: &Measure) -> Drawing {
    let mut notes = vec![seeds_note(skill)];
    if skill.series.len() > MOST_CURVES {
        notes.push(format!("The first {MOST_CURVES} of {} series; the table holds all.", skill.series.len()));
    } else if measure.against_actions {
        notes.push("A point lies at the mean number of actions over seeds.".into());
    }
    let shown = &skill.series[..skill.series.len().min(MOST_CURVES)];
    let figure = Figure {
        title: format!("{}: {}", skill.name, measure.heading),
        subtitle: measure.subtitle.into(),
        notes,
        x_title: if measure.against_actions { "executed actions" } else { "training trials" }.into(),
        y_title: measure.y_title.into(),
        percent: measure.percent,
        bound: skill.planner.as_ref().map(|score| ("planner (bound)".into(), (measure.value)(score))),
        curves: shown.iter().map(|series| curve(series, measure)).collect(),
    };
    Drawing {
        name: format!("{}-{}", measure.file, file_word(&skill.name)),
        skill: Some(skill.name.clone()),
        svg: curves::draw(&figure),
    }
}

fn curve(series: &Series, measure: &Measure) -> Curve {
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

/// Says how many seeds there are and what the bands mean.
fn seeds_note(skill: &Skill) -> String {
    let counts = || skill.series.iter().map(|series| series.last().scores.len());
    let (least, most) = (counts().min().unwrap_or(0), counts().max().unwrap_or(0));
    let seeds = if least == most { format!("n = {most} seeds") } else { format!("n = {least} to {most} seeds") };
    format!(
        "Lines: mean over {seeds} per arm. Bands: 95% percentile bootstrap interval of the mean ({} resamples of seeds).",
        super::axes::number(BAND_RESAMPLES as f64)
    )
}

/// A name as part of a file name: what could mislead a file system becomes `-`.
fn file_word(name: &str) -> String {
    name.chars().map(|c| if c.is_alphanumeric() || matches!(c, '-' | '_' | '+') { c } else { '-' }).collect()
}
