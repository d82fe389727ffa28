//! From rows of sums to one number per seed.

mod cautions;
mod collect;
mod diverged;
mod scores;

pub use cautions::cautions;
pub use collect::summarise;
pub use scores::{ArmSummary, PlannerBound, Score, SeedScores, Series, SkillSummary, Summary, TransferTest, paired};
