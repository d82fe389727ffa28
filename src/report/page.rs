//! The HTML page: numbers turned into text, then put into the template.

use super::ReportError;
use super::axes::number;
use super::figures::Drawing;
use super::statistics::{
    FEW_SEEDS, Interval, TABLE_RESAMPLES, bootstrap, interquartile_mean, mean, paired_difference, share_below, sorted,
    wilson,
};
use super::summary::{Cell, Score, Series, Skill, Summary};
use crate::record::FinishedRun;
use minijinja::{AutoEscape, Environment, UndefinedBehavior, Value, context};

/// Besides the last test, the tables show the one nearest to this number of training trials: learners differ most
/// while they still learn.
const EARLY_TRIALS: u32 = 150;

/// Renders the page.
///
/// # Errors
/// [`ReportError::Page`] if the template and this code disagree.
pub fn render(run: &FinishedRun, summary: &Summary, figures: &[Drawing]) -> Result<String, ReportError> {
    fill(run, summary, figures).map_err(|error| ReportError::Page(format!("{error:#}")))
}

fn fill(run: &FinishedRun, summary: &Summary, figures: &[Drawing]) -> Result<String, minijinja::Error> {
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    // A name that the template misspells is an error, not an empty cell.
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.add_template("page", include_str!("page.html"))?;
    let provenance = &run.manifest().provenance;
    let note = |(name, note): (&String, &String)| context! { name => name.as_str(), text => note.as_str() };
    let of = |skill: Option<&str>| -> Vec<Value> {
        figures.iter().filter(|figure| figure.skill.as_deref() == skill).map(figure_part).collect()
    };
    let skills = summary.skills.iter().map(|skill| skill_part(skill, of(Some(&skill.name))));
    environment.get_template("page")?.render(context! {
        title => title(run),
        folder => run.dir().file_name().map(|name| name.to_string_lossy().into_owned()),
        config => run.config(),
        backend => provenance.backend.as_str(),
        adapter => provenance.adapter.as_deref(),
        version => provenance.version.as_str(),
        commit => provenance.commit.as_deref(),
        started => provenance.started.as_deref(),
        finished => provenance.finished.as_deref(),
        notes => provenance.notes.iter().map(note).collect::<Vec<_>>(),
        seeds => seed_list(&provenance.seeds),
        warnings => warnings(summary),
        skills => skills.collect::<Vec<_>>(),
        floor => of(None),
        resamples => number(TABLE_RESAMPLES as f64),
    })
}

fn skill_part(skill: &Skill, figures: Vec<Value>) -> Value {
    let rows = skill
        .series
        .iter()
        .flat_map(|series| moments(series).into_iter().map(|cell| row(&series.label, cell)).collect::<Vec<_>>());
    let differences = skill
        .series
        .split_first()
        .map_or_else(Vec::new, |(first, others)| others.iter().flat_map(|other| differences(first, other)).collect());
    context! {
        name => skill.name.as_str(),
        rows => rows.collect::<Vec<_>>(),
        planner => skill.planner.as_ref().map(planner),
        differences => differences,
        figures => figures,
    }
}

/// The tests that tables show: an early one and the last.
fn moments(series: &Series) -> Vec<&Cell> {
    let (early, last) = (series.nearest(EARLY_TRIALS), series.last());
    if early.trials == last.trials { vec![last] } else { vec![early, last] }
}

/// A row of a skill's table.
fn row(label: &str, cell: &Cell) -> Value {
    let success = cell.values(Score::success);
    let steps = cell.values(Score::steps_per_trial);
    let total = |of: fn(&Score) -> u64| cell.scores.iter().map(of).sum::<u64>();
    context! {
        arm => label,
        trials => cell.trials,
        seeds => cell.scores.len(),
        actions => number(mean(&cell.values(|score| f64::from(score.actions))).round()),
        success => percent_with(mean(&success), bootstrap(&success, mean, TABLE_RESAMPLES)),
        middle => percent_with(
            interquartile_mean(&sorted(&success)),
            bootstrap(&success, interquartile_mean, TABLE_RESAMPLES),
        ),
        wilson => percent_range(wilson(total(|score| score.successes), total(|score| score.episodes))),
        failing => percent(share_below(&success, 0.5)),
        steps => with(mean(&steps), bootstrap(&steps, mean, TABLE_RESAMPLES), 1),
        collisions => format!("{:.4}", mean(&cell.values(Score::collisions_per_step))),
    }
}

/// Differences to the first arm, at the moments that both have with the same seeds.
fn differences(first: &Series, other: &Series) -> Vec<Value> {
    let pairs = moments(other).into_iter().filter_map(|b| {
        let a = first.cells.iter().find(|cell| cell.trials == b.trials)?;
        let seeds = |cell: &Cell| cell.scores.iter().map(|score| score.seed).collect::<Vec<_>>();
        (seeds(a) == seeds(b)).then_some((a, b))
    });
    let difference = |(a, b): (&Cell, &Cell)| {
        let of = |value: fn(&Score) -> f64| paired_difference(&a.values(value), &b.values(value), TABLE_RESAMPLES);
        let ((success, success_interval), (steps, steps_interval)) = (of(Score::success), of(Score::steps_per_trial));
        context! {
            arms => format!("{} minus {}", first.label, other.label),
            trials => b.trials,
            pairs => b.scores.len(),
            success => format!(
                "{:+.1} [{:+.1}, {:+.1}]",
                100.0 * success,
                100.0 * success_interval.low,
                100.0 * success_interval.high
            ),
            steps => format!("{steps:+.1} [{:+.1}, {:+.1}]", steps_interval.low, steps_interval.high),
        }
    };
    pairs.map(difference).collect()
}

fn planner(score: &Score) -> String {
    format!(
        "The planner, which knows the floor plan and the pose, achieves {} of {} test trials in {:.1} steps on average: \
         a bound for every arm.",
        percent_with(score.success(), wilson(score.successes, score.episodes)),
        number(score.episodes as f64),
        score.steps_per_trial(),
    )
}

fn warnings(summary: &Summary) -> Vec<String> {
    let mut warnings = summary.warnings.clone();
    let cells = summary.skills.iter().flat_map(|skill| &skill.series).map(|series| series.last().scores.len());
    if let Some(few) = cells.min().filter(|&count| count < FEW_SEEDS) {
        warnings.push(format!(
            "Only {few} seeds: bootstrap intervals over fewer than {FEW_SEEDS} seeds are too narrow (with 7, a nominal 95% \
             interval holds the truth in 81 to 87% of cases). Run at least 30 seeds before drawing conclusions."
        ));
    }
    if summary.skills.is_empty() {
        warnings.push("The run holds no tests.".into());
    }
    warnings
}

fn title(run: &FinishedRun) -> String {
    let config: Option<toml::Table> = run.config().parse().ok();
    let title = config.as_ref().and_then(|config| config.get("title")).and_then(toml::Value::as_str);
    title.map_or_else(|| "skilltree report".into(), str::to_owned)
}

/// `0 to 31` for an unbroken range, a list otherwise.
fn seed_list(seeds: &[u32]) -> String {
    let unbroken = seeds.windows(2).all(|pair| pair[1].checked_sub(pair[0]) == Some(1));
    match seeds {
        [] => "none".into(),
        [one] => format!("{one} (1 seed)"),
        [first, .., last] if unbroken => format!("{first} to {last} ({} seeds)", seeds.len()),
        _ => {
            let list: Vec<_> = seeds.iter().map(u32::to_string).collect();
            format!("{} ({} seeds)", list.join(", "), seeds.len())
        }
    }
}

fn figure_part(figure: &Drawing) -> Value {
    // Inline SVG needs no namespace, and the page then names no address at all.
    let svg = figure.svg.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
    context! { name => figure.name.as_str(), svg => svg }
}

fn percent(share: f64) -> String {
    format!("{:.1}%", 100.0 * share)
}

fn percent_range(interval: Interval) -> String {
    format!("[{:.1}, {:.1}]", 100.0 * interval.low, 100.0 * interval.high)
}

fn percent_with(share: f64, interval: Interval) -> String {
    format!("{} {}", percent(share), percent_range(interval))
}

fn with(value: f64, interval: Interval, digits: usize) -> String {
    format!("{value:.digits$} [{:.digits$}, {:.digits$}]", interval.low, interval.high)
}
