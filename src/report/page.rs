//! The HTML page and the summary for a terminal: numbers by name, which the templates put into words.

use super::claims::Claim;
use super::comparison::Comparison;
use super::format::{add_filters, median_trials, trials_by};
use super::learning_curves::with_copies;
use super::results::{ReportError, RunResults};
use super::statistics::{
    SurvivalCurve, TABLE_RESAMPLES, TimeToEvent, bootstrap, interquartile_mean, mean, mean_of, paired_difference,
    share_below, wilson,
};
use super::summary::{PlannerBound, Score, SeedScores, Series, SkillSummary, cautions, paired};
use super::{figure2, rooms, sweep, training, transfer};
use crate::run_folder::FinishedRun;
use minijinja::syntax::SyntaxConfig;
use minijinja::{Environment, UndefinedBehavior, Value, context};
use rayon::prelude::*;
use std::path::PathBuf;

/// Besides the last test, tables show the early one nearest to this number of training trials.
const EARLY_TRIALS: u32 = 150;
/// Success that counts as having learned, in the table of trials to criterion.
const CRITERION: f64 = 0.8;

const TEMPLATES: [(&str, &str); 4] = [
    ("page.html", include_str!("templates/page.html")),
    ("sweep.html", include_str!("templates/sweep.html")),
    ("macros.html", include_str!("templates/macros.html")),
    ("terminal.txt", include_str!("templates/terminal.txt")),
];

/// A figure on the page.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnFigure {
    /// File name without its ending.
    pub name: String,
    pub section: &'static str,
    /// The skill or the sweep's arm that the section is about, if it is about one.
    pub about: String,
    /// The SVG document.
    pub svg: String,
}

/// Renders the page and the summary for a terminal.
///
/// # Errors
/// [`ReportError::Page`] if a template and this code disagree.
pub fn render(
    run: &FinishedRun,
    results: &RunResults,
    figures: &[DrawnFigure],
) -> Result<(String, String), ReportError> {
    let mut environment = Environment::new();
    // A name that a template misspells is an error, not an empty cell.
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_syntax(SyntaxConfig::builder().trim_blocks(true).keep_trailing_newline(true).build()?);
    add_filters(&mut environment);
    let figures = figures.to_vec();
    environment.add_function("figures", move |section: &str, about: Option<&str>| -> Vec<Value> {
        let there = figures.iter().filter(|figure| (figure.section, &*figure.about) == (section, about.unwrap_or("")));
        // Inline SVG needs no namespace, and the page then names no address at all.
        let svg = |figure: &DrawnFigure| figure.svg.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
        there.map(|figure| context! { name => &figure.name, svg => svg(figure) }).collect()
    });
    for (name, text) in TEMPLATES {
        environment.add_template(name, text)?;
    }
    let context = context(run, results);
    Ok((
        environment.get_template("page.html")?.render(&context)?,
        environment.get_template("terminal.txt")?.render(&context)?,
    ))
}

fn context(run: &FinishedRun, results: &RunResults) -> Value {
    let provenance = &run.manifest().provenance;
    let config: toml::Table = run.config().parse().unwrap_or_default();
    let summary = &results.summary;
    let comparison = Comparison::new(summary);
    let mut skills: Vec<&SkillSummary> = summary.skills.iter().collect();
    let first = comparison.as_ref().map(|comparison| comparison.skill.name.as_str());
    skills.sort_by_key(|skill| first != Some(&skill.name));
    let elsewhere = transfer::series(summary);
    let (main, others) = elsewhere.split_at(elsewhere.len().min(1));
    context! {
        title => config.get("title").and_then(toml::Value::as_str).unwrap_or("skilltree report"),
        folder => folder_name(run).display().to_string(),
        config => run.config(),
        backend => &provenance.backend,
        adapter => &provenance.adapter,
        version => &provenance.version,
        commit => &provenance.commit,
        started => &provenance.started,
        finished => &provenance.finished,
        notes => Value::from_pairs(&provenance.notes),
        seeds => seed_list(&provenance.seeds),
        warnings => cautions(summary),
        sweep => results.swept.as_ref().map(|swept| sweep::context(swept, &folder_name(run), run.dir())),
        claims => results.claims.iter().map(claim_row).collect::<Vec<_>>(),
        comparison => comparison.as_ref().map(|comparison| comparison_part(comparison, results)),
        transfer => transfer::table(main),
        transfer_others => transfer::table(others),
        alterations => transfer::meanings(&config),
        skills => skills.into_iter().map(skill_part).collect::<Vec<_>>(),
        criterion => CRITERION,
        resamples => TABLE_RESAMPLES,
    }
}

/// The last part of the run folder's path.
fn folder_name(run: &FinishedRun) -> PathBuf {
    // A path such as `.` has no name of its own.
    let whole = std::path::absolute(run.dir()).unwrap_or_else(|_| run.dir().to_owned());
    whole.file_name().map_or_else(|| run.dir().to_owned(), PathBuf::from)
}

fn claim_row(claim: &Claim) -> Value {
    context! {
        number => claim.number,
        title => claim.title,
        says => claim.says,
        figures => &claim.figures,
        seeds => claim.seeds,
        verdict => claim.verdict.words(),
        why => &claim.why,
    }
}

fn comparison_part(comparison: &Comparison<'_>, results: &RunResults) -> Value {
    let shown = rooms::of(comparison, &results.summary.rooms);
    let bound = comparison.skill.bound(&comparison.hierarchical[0].arm);
    context! {
        skill => &comparison.skill.name,
        leaders => comparison.leaders().map(|series| series.label.clone()).collect::<Vec<_>>(),
        window => training::WINDOW,
        few => figure2::PAPER_SEEDS,
        averages => figure2::averages(comparison, &results.trainings),
        rooms => shown.iter().map(|(_, name)| Value::from(*name)).collect::<Vec<_>>(),
        from_rooms => shown.iter().map(|(_, name)| format!("from {name}")).collect::<Vec<_>>(),
        by_room => rooms::table(comparison, &shown),
        bound => bound.map(|bound| rooms::bound(bound, &shown)),
        overall => bound.map(|bound| bound.score.success()),
    }
}

fn skill_part(skill: &SkillSummary) -> Value {
    let distinct = skill.distinct();
    let rows = distinct.par_iter().flat_map_iter(|(series, copies)| {
        let label = with_copies(series, copies);
        moments(series).into_iter().map(move |test| row(&label, test))
    });
    let differences = distinct.split_first().map_or_else(Vec::new, |((first, _), others)| {
        others.par_iter().flat_map_iter(|(other, _)| differences(first, other)).collect()
    });
    let copies = distinct.iter().filter(|(_, copies)| !copies.is_empty());
    let copies = copies.map(|(series, copies)| {
        context! { arm => with_copies(series, copies), others => copies.iter().copied().map(Value::from).collect::<Vec<_>>() }
    });
    let trained = distinct.iter().filter(|(series, _)| series.last().trials > 0);
    context! {
        name => &skill.name,
        ends => !skill.never_ends(),
        rows => rows.collect::<Vec<_>>(),
        copies => copies.collect::<Vec<_>>(),
        bounds => skill.bounds.iter().map(bound_row).collect::<Vec<_>>(),
        differences => differences,
        criterion => trained.map(|(series, copies)| criterion_row(series, copies)).collect::<Vec<_>>(),
    }
}

/// The tests that tables show: an early one and the last.
fn moments(series: &Series) -> Vec<&SeedScores> {
    let (early, last) = (series.nearest(EARLY_TRIALS), series.last());
    if early.trials == last.trials { vec![last] } else { vec![early, last] }
}

/// A row of a skill's table.
fn row(label: &str, test: &SeedScores) -> Value {
    let success = test.values(Score::success);
    let total = |of: fn(&Score) -> u64| test.scores.iter().map(of).sum::<u64>();
    context! {
        arm => label,
        trials => test.trials,
        seeds => test.scores.len(),
        actions => mean(&test.values(|score| f64::from(score.actions))).round(),
        success => mean_of(&success),
        middle => bootstrap(&success, interquartile_mean, TABLE_RESAMPLES),
        pooled => wilson(total(|score| score.successes), total(|score| score.episodes)),
        failing => share_below(&success, 0.5),
        steps => mean_of(&test.values(Score::steps_per_trial)),
        collisions => mean(&test.values(Score::collisions_per_step)),
        returned => mean_of(&test.values(Score::return_per_trial)),
    }
}

/// A row of a skill's table of trials to criterion.
fn criterion_row(series: &Series, copies: &[&str]) -> Value {
    let end = f64::from(series.last().trials);
    let seen = |trials: Option<u32>| TimeToEvent { time: trials.map_or(end, f64::from), reached: trials.is_some() };
    let seen = SurvivalCurve::new(&series.trials_to(CRITERION).into_iter().map(seen).collect::<Vec<_>>());
    context! {
        arm => with_copies(series, copies),
        reached => format!("{} of {}", seen.reached, seen.count),
        quarter => trials_by(&seen, seen.quantile(0.25)),
        median => median_trials(&seen),
        three_quarters => trials_by(&seen, seen.quantile(0.75)),
    }
}

/// Differences to the first arm on the seeds that both have: at their last tests, and at an early one that both have.
fn differences(first: &Series, other: &Series) -> Vec<Value> {
    let early = other.nearest(EARLY_TRIALS);
    let same = first.tests.iter().find(|test| test.trials == early.trials);
    let early = same.filter(|_| early.trials != other.last().trials).map(|same| (same, early));
    let difference = |(a, b): (&SeedScores, &SeedScores)| {
        let of = |value: fn(&Score) -> f64| {
            let (a, b) = paired(&a.scores, &b.scores, value);
            (paired_difference(&a, &b), a.len())
        };
        let ((success, pairs), (steps, _)) = (of(Score::success), of(Score::steps_per_trial));
        context! {
            arms => format!("{} minus {}", first.label, other.label),
            trials => if a.trials == b.trials { a.trials.to_string() } else { format!("{}, {}", a.trials, b.trials) },
            pairs => pairs,
            success => success,
            steps => steps,
        }
    };
    early.into_iter().chain([(first.last(), other.last())]).map(difference).collect()
}

/// What the planner itself achieves.
fn bound_row(bound: &PlannerBound) -> Value {
    let score = &bound.score;
    context! {
        arm => &bound.arm,
        success => wilson(score.successes, score.episodes),
        episodes => score.episodes as f64,
        steps => score.steps_per_trial(),
        returned => score.return_per_trial(),
    }
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
