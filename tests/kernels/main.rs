//! The kernels on the CPU, without any graphics adapter. `physics`, `learning`, `teacher` and `hierarchy` compare them
//! with what is not the product: geometry by distance fields, nets in f64, rules as sets, values by hand. `forms`
//! compares the plain twins with the CPU's tuned forms, byte by byte.

mod configs;
mod forms;
mod hierarchy;
mod learner;
mod learning;
#[path = "../support/lessons.rs"]
mod lessons;
mod nets64;
mod observations;
mod oracle;
mod physics;
mod random;
#[path = "../support/rewards.rs"]
mod rewards;
mod teacher;
#[path = "../support/work.rs"]
mod work;
