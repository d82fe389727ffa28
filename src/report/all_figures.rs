//! All figures of the page.

use super::comparison::Comparison;
use super::error::ReportError;
use super::figure::Figure;
use super::results::RunResults;
use super::{figure2, floor_plan, learning_curves, rooms, sweep, trajectory_plot};
use crate::run_folder::{FinishedRun, PlaceReading, Trajectory, folder};
use crate::world::{World, load};
use std::collections::BTreeMap;

/// Arms whose example trials are drawn.
const ARMS: usize = 2;

/// Draws everything that a run has figures for, in the order of the page.
///
/// # Errors
/// If a file of the run is damaged or, as a floor plan, of another version of skilltree.
pub fn draw(run: &FinishedRun, results: &RunResults) -> Result<Vec<Figure>, ReportError> {
    let worlds = worlds(run)?;
    let mut figures = results.swept.as_ref().map_or_else(Vec::new, sweep::draw);
    if let Some(comparison) = Comparison::new(&results.summary) {
        figures.extend(figure2::draw(&comparison, &results.trainings));
        figures.extend(figure2::equal_cost(&comparison));
        figures.extend(rooms::draw(&comparison, &rooms::of(&comparison, &results.summary.rooms)));
        let leaders: Vec<&str> = comparison.leaders().map(|series| series.arm.as_str()).collect();
        let trajectories: Vec<Trajectory> = run.json()?.unwrap_or_default();
        let shown = chosen(&trajectories, &leaders)
            .into_iter()
            .filter_map(|trajectory| Some(trajectory_plot::draw(worlds.get(&trajectory.world)?, trajectory)));
        figures.extend(shown);
    }
    figures.extend(learning_curves::draw(&results.summary));
    let readings: Vec<PlaceReading> = run.json()?.unwrap_or_default();
    for (file, world) in &worlds {
        match file == folder::WORLD {
            true => figures.extend(floor_plan::draw_all(world, &readings)),
            false => figures.push(floor_plan::draw_elsewhere(world, file)),
        }
    }
    Ok(figures)
}

/// The trials of the arms that lead the comparison, or of the first ones where those have none.
fn chosen<'a>(trajectories: &'a [Trajectory], leaders: &[&str]) -> Vec<&'a Trajectory> {
    let mut arms: Vec<&str> = Vec::new();
    for trajectory in trajectories {
        if !arms.contains(&trajectory.arm.as_str()) {
            arms.push(&trajectory.arm);
        }
    }
    arms.sort_by_key(|arm| leaders.iter().position(|leader| leader == arm).unwrap_or(leaders.len()));
    arms.truncate(ARMS);
    let of_arm = |arm: &&str| trajectories.iter().filter(|trajectory| trajectory.arm == *arm).collect::<Vec<_>>();
    arms.iter().flat_map(of_arm).collect()
}

/// The floor plans that a run holds, by file: the config's own, and those of other arms and alterations.
fn worlds(run: &FinishedRun) -> Result<BTreeMap<String, World>, ReportError> {
    let mut worlds = BTreeMap::new();
    let is_world = |file: &&String| *file == folder::WORLD || file.starts_with("worlds/");
    for file in run.manifest().files.keys().filter(is_world) {
        let text = run.text(file)?.unwrap_or_default();
        worlds.insert(file.clone(), load::parse(&text, &run.dir().join(file))?);
    }
    Ok(worlds)
}
