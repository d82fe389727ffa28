//! Learning curves of each skill.

use super::figure::curves::{Curve, CurvePoint, axes};
use super::figure::{Figure, PlotArea};
use super::format::{file_word, number, seeds};
use super::statistics::{BAND_RESAMPLES, bootstrap, mean};
use super::step_plot;
use super::summary::{Score, SeedScores, Series, SkillSummary, Summary};
use rayon::prelude::*;

/// What a curve shows.
#[derive(Debug, Clone, Copy)]
pub struct CurveMeasure {
    /// The first word of the figure's file name.
    pub file: &'static str,
    /// What follows the skill in the figure's heading.
    pub heading: &'static str,
    pub subtitle: &'static str,
    pub y_title: &'static str,
    /// Whether values are shares.
    pub percent: bool,
    /// Whether x is executed actions, or else training trials.
    pub against_actions: bool,
    /// The value of a test.
    pub value: fn(&Score) -> f64,
}

/// Success against training trials.
pub const SUCCESS: CurveMeasure = CurveMeasure {
    file: "learning",
    heading: "success against training trials",
    subtitle: "Share of greedy test trials that ended as achieved.",
    y_title: "test trials achieved",
    percent: true,
    against_actions: false,
    value: Score::success,
};

const ENDING: [CurveMeasure; 3] = [
    SUCCESS,
    CurveMeasure {
        file: "steps",
        heading: "steps of a test trial against training trials",
        subtitle: "Mean primitive steps of a greedy test trial; failed trials count with their step limit.",
        y_title: "steps per test trial",
        percent: false,
        value: Score::steps_per_trial,
        ..SUCCESS
    },
    CurveMeasure {
        file: "actions",
        heading: "success against executed actions",
        subtitle: "Share of greedy test trials that ended as achieved. Actions: in teaching and for child skills too.",
        against_actions: true,
        ..SUCCESS
    },
];

/// Of skills that never end, as following a wall: trials are as long as their limit, and none is achieved.
const UNENDING: [CurveMeasure; 1] = [CurveMeasure {
    file: "return",
    heading: "return of a test trial against training trials",
    subtitle: "Mean discounted return of a greedy test trial, in the config's units of reward.",
    y_title: "return per test trial",
    percent: false,
    against_actions: false,
    value: Score::return_per_trial,
}];

impl CurveMeasure {
    pub fn x_title(&self) -> &'static str {
        if self.against_actions { "executed actions" } else { "training trials" }
    }

    /// The curve of a series: a point lies at the mean number of actions over seeds, or at the number of trials.
    pub fn curve(&self, series: &Series, label: String) -> Curve {
        let point = |test: &SeedScores| {
            let actions = || mean(&test.values(|score| f64::from(score.actions)));
            let x = if self.against_actions { actions() } else { f64::from(test.trials) };
            CurvePoint { x, y: bootstrap(&test.values(self.value), mean, BAND_RESAMPLES) }
        };
        Curve::new(label, series.tests.iter().map(point).collect())
    }
}

/// A series' label, with the number of arms that have its numbers too.
pub fn with_copies(series: &Series, copies: &[&str]) -> String {
    if copies.is_empty() { series.label.clone() } else { format!("{} +{}", series.label, copies.len()) }
}

/// Figures of every skill that was tested more than once.
pub fn draw(summary: &Summary) -> Vec<Figure> {
    let figures = |skill: &SkillSummary| {
        let measures = if skill.never_ends() { &UNENDING[..] } else { &ENDING };
        let mut figures: Vec<Figure> = measures.par_iter().map(|measure| curves_of(skill, measure)).collect();
        if !skill.never_ends() {
            figures.push(profile(skill));
        }
        figures
    };
    let curved = |skill: &&SkillSummary| skill.series.iter().any(|series| series.tests.len() > 1);
    summary.skills.par_iter().filter(curved).flat_map_iter(figures).collect()
}

fn curves_of(skill: &SkillSummary, measure: &CurveMeasure) -> Figure {
    let (all, area) = (skill.distinct(), PlotArea::LARGE);
    let mut notes = vec![format!(
        "Lines: mean over {}. Bands: 95% percentile bootstrap interval of the mean ({} resamples of seeds).",
        seeds_of(&skill.series),
        number(BAND_RESAMPLES as f64)
    )];
    if all.len() > area.most_curves() {
        notes.push(format!("The first {} of {} series; the table holds all.", area.most_curves(), all.len()));
    } else if measure.against_actions {
        notes.push("A point lies at the mean number of actions over seeds.".into());
    } else if all.iter().any(|(_, copies)| !copies.is_empty()) {
        notes.push("+ a number: so many other arms have the same numbers: they learned the skill together.".into());
    }
    let shown = all.iter().take(area.most_curves());
    let curves: Vec<Curve> = shown.map(|(series, copies)| measure.curve(series, with_copies(series, copies))).collect();
    let bound = skill.bounds.first().map(|bound| (measure.value)(&bound.score));
    let (x, y) = axes(&curves, bound, (measure.x_title(), measure.y_title), measure.percent);
    let figure = Figure {
        name: format!("{}-{}", measure.file, file_word(&skill.name)),
        section: "skill",
        about: skill.name.clone(),
        title: format!("{}: {}", skill.name, measure.heading),
        subtitle: measure.subtitle.into(),
        area,
        x,
        y,
        notes,
        ..Figure::default()
    };
    figure.with_curves(&curves, bound)
}

/// How the seeds of each arm differ: the performance profile of their last tests.
fn profile(skill: &SkillSummary) -> Figure {
    let (all, most) = (skill.distinct(), PlotArea::SMALL.most_curves());
    let curve = |(series, copies): &(&Series, Vec<&str>)| {
        step_plot::seed_profile(with_copies(series, copies), &series.last().values(Score::success))
    };
    let mut notes = vec![format!("{}. Bands: 95% Wilson interval of the share of seeds.", seeds_of(&skill.series))];
    if all.len() > most {
        notes.push(format!("The first {most} of {} series.", all.len()));
    }
    let figure = Figure {
        name: format!("profile-{}", file_word(&skill.name)),
        section: "skill",
        about: skill.name.clone(),
        title: format!("{}: performance profile", skill.name),
        subtitle: "Share of seeds whose success at the last test exceeds x.".into(),
        notes,
        ..step_plot::profile_axes("seeds above")
    };
    figure.with_curves(&all.iter().take(most).map(curve).collect::<Vec<_>>(), None)
}

/// `n = 32 seeds per arm`.
fn seeds_of(series: &[Series]) -> String {
    let counts = || series.iter().map(|series| series.last().scores.len());
    let (least, most) = (counts().min().unwrap_or(0), counts().max().unwrap_or(0));
    if least == most { format!("n = {} per arm", seeds(most)) } else { format!("n = {least} to {most} seeds per arm") }
}
