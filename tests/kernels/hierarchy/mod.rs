//! Trees of skills, against what is not the product: rules as sets, recursions in f64, geometry by distance fields,
//! logistic fits by another method, and learners that train alone.

mod afterwards;
mod beside_walls;
mod choices;
mod compass_sonar;
mod memories;
mod mirrors;
mod persistence;
mod planned;
mod pretraining;
mod region_goals;
mod remembered_trials;
mod shared_nets;
mod stopped_runs;
mod targets;
mod targets_by_definition;
mod targets_by_hand;
mod three_levels;
mod thresholds;
