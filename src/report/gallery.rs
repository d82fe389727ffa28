//! All figures of the page.

use super::ReportError;
use super::comparison::Comparison;
use super::figures::{self, Drawing};
use super::results::Results;
use super::{figure2, rooms, sweep};
use crate::run_folder::{FinishedRun, RecordError, Trajectory, folder, sensor_readings, trajectories};
use crate::world::{World, load};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;

/// Arms whose example trials are drawn.
const ARMS: usize = 2;

/// Draws everything that a run has figures for, in the order of the page.
///
/// # Errors
/// If a file of the run is damaged or, as a floor plan, of another version of skilltree.
pub fn draw(run: &FinishedRun, results: &Results) -> Result<Vec<Drawing>, ReportError> {
    let worlds = worlds(run)?;
    let mut drawings = results.swept.as_ref().map_or_else(Vec::new, sweep::draw);
    if let Some(comparison) = Comparison::new(&results.summary) {
        drawings.extend(figure2::draw(&comparison, &results.trainings));
        drawings.extend(figure2::budget(&comparison));
        drawings.extend(rooms::draw(&comparison, &rooms::of(&comparison, &results.summary.rooms)));
        let leaders: Vec<&str> = comparison.leaders().map(|series| series.arm.as_str()).collect();
        let trajectories = read(run, trajectories::FILE, trajectories::read_trajectories)?;
        let shown: Vec<_> = chosen(&trajectories, &leaders)
            .into_iter()
            .filter_map(|trajectory| Some((trajectory, worlds.get(&trajectory.world)?)))
            .collect();
        drawings.par_extend(shown.into_par_iter().map(|(trajectory, world)| figures::way(trajectory, world)));
    }
    drawings.extend(figures::learning(&results.summary));
    let readings = read(run, sensor_readings::FILE, sensor_readings::read_places)?;
    for (file, world) in &worlds {
        drawings.extend(match file == folder::WORLD {
            true => figures::floor(world, &readings),
            false => vec![figures::elsewhere(world, file)],
        });
    }
    Ok(drawings)
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
    let mut chosen: Vec<&Trajectory> =
        trajectories.iter().filter(|trajectory| arms.contains(&trajectory.arm.as_str())).collect();
    chosen.sort_by_key(|trajectory| arms.iter().position(|arm| *arm == trajectory.arm));
    chosen
}

/// The content of a result file that a run may lack.
fn read<T>(
    run: &FinishedRun,
    file: &str,
    parse: impl Fn(&[u8], &Path) -> Result<Vec<T>, RecordError>,
) -> Result<Vec<T>, ReportError> {
    let Some(bytes) = run.content(file)? else { return Ok(Vec::new()) };
    Ok(parse(&bytes, &run.dir().join(file))?)
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
