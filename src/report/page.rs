//! The HTML page: numbers turned into text, then put into the template.

use super::claims::{Claim, Verdict};
use super::comparison::Comparison;
use super::figures::{Drawing, Section, with_copies};
use super::numbers::{number, percent, percent_range, percent_with, points_with, with};
use super::results::Results;
use super::statistics::{
    Observation, Survival, TABLE_RESAMPLES, bootstrap, bootstrap_bca, bootstrap_probability, interquartile_mean, mean,
    optimality_gap, paired_difference, probability_of_improvement, share_below, sorted, student_t, wilson,
};
use super::summary::{Bound, Cell, Score, Series, Skill, Summary, paired};
use super::text::EARLY_TRIALS;
use super::{ReportError, alterations, figure2, rooms, sweep};
use crate::run_folder::FinishedRun;
use minijinja::{AutoEscape, Environment, UndefinedBehavior, Value, context};
use rayon::prelude::*;
use std::path::PathBuf;

/// Success that counts as having learned, in the table of trials to criterion.
const CRITERION: f64 = 0.8;

/// Renders the page.
///
/// # Errors
/// [`ReportError::Page`] if the template and this code disagree.
pub fn render(run: &FinishedRun, results: &Results, figures: &[Drawing]) -> Result<String, ReportError> {
    fill(run, results, figures).map_err(|error| ReportError::Page(format!("{error:#}")))
}

fn fill(run: &FinishedRun, results: &Results, figures: &[Drawing]) -> Result<String, minijinja::Error> {
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    // A name that the template misspells is an error, not an empty cell.
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.add_template("page", include_str!("page.html"))?;
    environment.add_template("sweep", include_str!("sweep/part.html"))?;
    let provenance = &run.manifest().provenance;
    let config: toml::Table = run.config().parse().unwrap_or_default();
    let note = |(name, note): (&String, &String)| context! { name => name.as_str(), text => note.as_str() };
    let of = |section: &Section| -> Vec<Value> {
        figures.iter().filter(|figure| figure.section == *section).map(figure_part).collect()
    };
    let summary = &results.summary;
    let comparison = Comparison::new(summary);
    let mut skills: Vec<&Skill> = summary.skills.iter().collect();
    let first = comparison.as_ref().map(|comparison| comparison.skill.name.as_str());
    skills.sort_by_key(|skill| first != Some(&skill.name));
    let skills = skills.into_iter().map(|skill| skill_part(skill, of(&Section::Skill(skill.name.clone()))));
    environment.get_template("page")?.render(context! {
        title => config.get("title").and_then(toml::Value::as_str).unwrap_or("skilltree report"),
        folder => folder_name(run).display().to_string(),
        config => run.config(),
        backend => provenance.backend.as_str(),
        adapter => provenance.adapter.as_deref(),
        version => provenance.version.as_str(),
        commit => provenance.commit.as_deref(),
        started => provenance.started.as_deref(),
        finished => provenance.finished.as_deref(),
        notes => provenance.notes.iter().map(note).collect::<Vec<_>>(),
        seeds => seed_list(&provenance.seeds),
        warnings => summary.cautions(),
        sweep => results.swept.as_ref().map(|swept| sweep::part(swept, figures, figure_part, &folder_name(run))),
        claims => results.claims.iter().map(claim_row).collect::<Vec<_>>(),
        comparison => comparison.as_ref().map(|comparison| comparison_part(comparison, results, &of)),
        trials => of(&Section::Trajectories),
        alterations => alterations_part(summary, &config, of(&Section::Elsewhere)),
        skills => skills.collect::<Vec<_>>(),
        floor => of(&Section::World),
        criterion => format!("{:.0}%", 100.0 * CRITERION),
        resamples => number(TABLE_RESAMPLES as f64),
    })
}

/// The last part of the run folder's path.
fn folder_name(run: &FinishedRun) -> PathBuf {
    // A path such as `.` has no name of its own.
    let whole = std::path::absolute(run.dir()).unwrap_or_else(|_| run.dir().to_owned());
    whole.file_name().map_or_else(|| run.dir().to_owned(), PathBuf::from)
}

fn claim_row(claim: &Claim) -> Value {
    let class = match claim.verdict {
        Verdict::Holds => "holds",
        Verdict::Partly => "partly",
        Verdict::DoesNotHold => "fails",
        Verdict::NotTested => "untested",
    };
    context! {
        number => claim.number,
        says => claim.says,
        figures => claim.figures.iter().map(|figure| with_code(figure)).collect::<Vec<_>>(),
        seeds => claim.seeds,
        verdict => claim.verdict.words(),
        class => class,
        why => with_code(&claim.why),
    }
}

/// Text in which names stand between backticks, as HTML.
fn with_code(text: &str) -> Value {
    let plain = |part: &str| part.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let part =
        |(i, part): (usize, &str)| if i % 2 == 1 { format!("<code>{}</code>", plain(part)) } else { plain(part) };
    Value::from_safe_string(text.split('`').enumerate().map(part).collect())
}

fn comparison_part(comparison: &Comparison<'_>, results: &Results, of: &impl Fn(&Section) -> Vec<Value>) -> Value {
    let shown = rooms::of(comparison, &results.summary.rooms);
    let bound = comparison.skill.bound(&comparison.hierarchical[0].arm);
    context! {
        skill => comparison.skill.name.as_str(),
        paper => of(&Section::Paper),
        all => of(&Section::All),
        window => super::training::WINDOW,
        few => figure2::PAPER_SEEDS,
        averages => figure2::averages(comparison, &results.trainings),
        budget => of(&Section::Budget),
        rooms => shown.iter().map(|(_, name)| (*name).to_owned()).collect::<Vec<_>>(),
        by_room => rooms::table(comparison, &shown),
        bound => bound.map(|bound| rooms::bound(bound, &shown)),
        overall => bound.map(|bound| percent(bound.score.success())),
        room_figures => of(&Section::Rooms),
    }
}

fn alterations_part(summary: &Summary, config: &toml::Table, figures: Vec<Value>) -> Value {
    let series = alterations::series(summary);
    let (main, others) = series.split_at(series.len().min(1));
    let meaning = |(name, text): (String, String)| context! { name => name, text => text };
    context! {
        main => alterations::table(main),
        others => alterations::table(others),
        meanings => alterations::meanings(config).into_iter().map(meaning).collect::<Vec<_>>(),
        figures => figures,
    }
}

fn skill_part(skill: &Skill, figures: Vec<Value>) -> Value {
    let distinct = skill.distinct();
    let rows = distinct.par_iter().flat_map_iter(|(series, copies)| {
        let label = with_copies(series, copies);
        moments(series).into_iter().map(move |cell| row(&label, cell))
    });
    let differences = distinct.split_first().map_or_else(Vec::new, |((first, _), others)| {
        others.par_iter().flat_map_iter(|(other, _)| differences(first, other)).collect()
    });
    let copies = distinct.iter().filter(|(_, copies)| !copies.is_empty());
    let trained = distinct.iter().filter(|(series, _)| series.last().trials > 0);
    let bounds = skill.bounds.iter();
    context! {
        name => skill.name.as_str(),
        rows => rows.collect::<Vec<_>>(),
        copies => copies.map(|(series, copies)| context! {
            arm => with_copies(series, copies),
            others => copies.join(", "),
        }).collect::<Vec<_>>(),
        bounds => bounds.map(|bound| planner(bound, skill.never_ends())).collect::<Vec<_>>(),
        differences => differences,
        ends => !skill.never_ends(),
        intervals => distinct
            .par_iter()
            .map(|(series, copies)| interval_row(series, copies, skill.bound(&series.arm)))
            .collect::<Vec<_>>(),
        bounded => !skill.bounds.is_empty(),
        criterion => trained.map(|(series, copies)| criterion_row(series, copies)).collect::<Vec<_>>(),
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
    let returned = cell.values(Score::return_per_trial);
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
        returned => with(mean(&returned), bootstrap(&returned, mean, TABLE_RESAMPLES), 2),
    }
}

/// A row of a skill's table of trials to criterion.
fn criterion_row(series: &Series, copies: &[&str]) -> Value {
    let end = series.last().trials;
    let observation = |trials: Option<u32>| match trials {
        Some(trials) => Observation { time: f64::from(trials), reached: true },
        None => Observation { time: f64::from(end), reached: false },
    };
    let seen: Vec<Observation> = series.trials_to(CRITERION).into_iter().map(observation).collect();
    let seen = Survival::new(&seen);
    let trials = |time: Option<f64>| time.map_or_else(|| format!("more than {end}"), number);
    let (low, high) = seen.quantile_interval(0.5);
    context! {
        arm => with_copies(series, copies),
        reached => format!("{} of {}", seen.reached, seen.count),
        quarter => trials(seen.quantile(0.25)),
        median => format!("{} [{}, {}]", trials(seen.quantile(0.5)), trials(low), trials(high)),
        three_quarters => trials(seen.quantile(0.75)),
    }
}

/// A row of a skill's table of other intervals: the last test of an arm.
fn interval_row(series: &Series, copies: &[&str], bound: Option<&Bound>) -> Value {
    let success = series.last().values(Score::success);
    let strata = [success.as_slice()];
    context! {
        arm => with_copies(series, copies),
        seeds => success.len(),
        mean => percent(mean(&success)),
        percentile => percent_range(bootstrap(&success, mean, TABLE_RESAMPLES)),
        bca => percent_range(bootstrap_bca(&strata, mean, TABLE_RESAMPLES)),
        student => percent_range(student_t(&success)),
        middle => percent(interquartile_mean(&sorted(&success))),
        middle_percentile => percent_range(bootstrap(&success, interquartile_mean, TABLE_RESAMPLES)),
        middle_bca => percent_range(bootstrap_bca(&strata, interquartile_mean, TABLE_RESAMPLES)),
        gap => bound.map(|bound| percent(optimality_gap(&success, bound.score.success()))),
    }
}

/// Differences to the first arm on the seeds that both have: at their last tests, and at an early one that both have.
fn differences(first: &Series, other: &Series) -> Vec<Value> {
    let early = other.nearest(EARLY_TRIALS);
    let same = first.cells.iter().find(|cell| cell.trials == early.trials);
    let early = same.filter(|_| early.trials != other.last().trials).map(|same| (same, early));
    let difference = |(a, b): (&Cell, &Cell)| {
        let of = |value: fn(&Score) -> f64| {
            let (a, b) = paired(&a.scores, &b.scores, value);
            (paired_difference(&a, &b, TABLE_RESAMPLES), a.len())
        };
        let ((success, success_interval), pairs) = of(Score::success);
        let ((steps, interval), _) = of(Score::steps_per_trial);
        let (all_a, all_b) = (a.values(Score::success), b.values(Score::success));
        let tasks = [(all_a.as_slice(), all_b.as_slice())];
        context! {
            arms => format!("{} minus {}", first.label, other.label),
            trials => if a.trials == b.trials { a.trials.to_string() } else { format!("{}, {}", a.trials, b.trials) },
            pairs => pairs,
            success => points_with(success, success_interval),
            higher => percent_with(
                probability_of_improvement(&tasks),
                bootstrap_probability(&tasks, TABLE_RESAMPLES),
            ),
            steps => format!("{steps:+.1} [{:+.1}, {:+.1}]", interval.low, interval.high),
        }
    };
    early.into_iter().chain([(first.last(), other.last())]).map(difference).collect()
}

fn planner(bound: &Bound, never_ends: bool) -> String {
    let score = &bound.score;
    let does = match never_ends {
        true => format!("has a return of {:.2}", score.return_per_trial()),
        false => format!(
            "achieves {} of {} test trials in {:.1} steps on average",
            percent_with(score.success(), wilson(score.successes, score.episodes)),
            number(score.episodes as f64),
            score.steps_per_trial(),
        ),
    };
    match &bound.arm {
        None => format!("The planner, which knows the floor plan and the pose, {does}: a bound for every arm."),
        Some(arm) => format!("In the task of the arm {arm}, the planner {does}."),
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

fn figure_part(figure: &Drawing) -> Value {
    // Inline SVG needs no namespace, and the page then names no address at all.
    let svg = figure.svg.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
    context! { name => figure.name.as_str(), svg => svg }
}
