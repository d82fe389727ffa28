//! `skilltree` trains thousands of small simulated robots at once, each learning its own tree of skills by
//! reinforcement, on any GPU or on the CPU, and gets the same bytes on both. It reproduces Long-Ji Lin,
//! "Hierarchical Learning of Robot Skills by Reinforcement" (1993).
//!
//! # One learner is one workgroup of 32 lanes
//!
//! A learner is one independent run: its robot, its nets, its lessons, its random stream, its numbers. On a
//! GPU a workgroup of 32 invocations owns it; on the CPU one thread does, and the lanes are the elements of
//! a 32-wide array. Lanes are sonar rays, then wall segments, then hidden units. Learners never wait for one
//! another and never share a sum, so learner k alone leaves the same bytes as learner k among thousands.
//!
//! A learner is a state machine whose whole state is in its [`learner::layout::LearnerState`]. Kernel [`advance`]
//! moves it on by at most *n* iterations (one trial step, or one replayed transition), so a dispatch can be as
//! short as a watchdog wants it. Kernel [`mod@evaluate`] runs greedy tests with the nets read-only, and
//! kernel [`mod@step`] lets a robot carry out given actions.
//!
//! The host keeps two dispatches in flight ([`backend::gpu::flight`]) and looks at the states once in several. While a
//! learner replays, kernel [`advance`] holds the weights of the skill in training in its workgroup's memory where they
//! fit ([`backend::gpu::held`]); the CPU's twin works on a copy that stays in the cache. What either is worth on a graphics
//! card has not been measured.
//!
//! # A skill tree is data
//!
//! A skill is a Q-function over children, and a child is an action or a skill with a lower number: nothing else
//! tells the levels apart. One step of a robot ([`skill::act`]) looks, asks the skills that some applicability
//! depends on, children first ([`skill::act::watch`]), lets the root choose among what applicability and persistence
//! allow ([`skill::persist`]), and goes down to an action ([`skill::act::descend`]). What an action earned is settled
//! by the next look, for some rewards depend on what is seen. A recorded step keeps what was allowed and whether the
//! choice was free, so that [`lesson::replay`] can learn from every step or from decisions alone. The same functions
//! serve training and tests.
//!
//! Skills are learned in order, children before parents. Arms of an experiment that differ in their root alone share
//! the rest: it is trained once for each seed, and each arm goes on from a copy ([`experiment::train`]), with the bytes
//! of a learner that trained alone.
//!
//! # A sweep is more arms
//!
//! A sweep lays values over the config of each arm: every arm at every point is an arm of its own in the plan, with its
//! number in the tables' column `point` ([`record::sweep`]). Nothing after the config stage knows more of it. Learners of
//! several arms and points train in one cohort where their skills differ in numbers alone ([`experiment::cohorts`]).
//!
//! # Runs that are stopped
//!
//! Cohorts train one after another, and each is committed as *parts* before the next begins. In between, the learners'
//! memory is saved in a *checkpoint* every minute and when a signal asks for it ([`experiment::checkpoint`]): as a
//! learner's whole position is in its memory, going on is training as ever, without the tests that it has taken. Parts
//! and checkpoints belong to one version of the program and one plan. At the end the tables and nets are written part
//! by part ([`experiment::files`]), so that the memory taken does not grow with the number of learners.
//!
//! A learner in which a number stops being finite is frozen by the kernel. The host finds the transition from what the
//! learner's memory holds ([`mod@experiment::failure`]), lists it in `failures.json`, and leaves it in every table.
//!
//! # Twins
//!
//! Every `shaders/PATH.wgsl` has its CPU twin at `src/PATH.rs`: same functions, same statements in the same
//! order, same comments on why. Both languages share one memory layout, [`learner::layout`], from which the
//! WGSL constants and structs are emitted. Results are built from IEEE f32 `+ - *`, comparisons and integers
//! alone ([`math`]), random numbers are counters ([`math::rng`]), and on Vulkan the SPIR-V is decorated so
//! that no compiler fuses or re-associates. Hence CPU and GPU agree to the byte, and tests compare bytes;
//! [`backend::parity`] names the first word that differs, and `skilltree devices --parity` asks any adapter.
//!
//! A twin may go about it in the CPU's way as long as no sum changes its order: nets or robots side by side, a list of what
//! is not 0 where a workgroup looks at everything, numbers by value so that the compiler keeps them in lanes. Nets of up to 16
//! hidden units take half of the lanes in both languages ([`qnet::forward::lanes_of`]).
//!
//! # Modules, in the order in which they may use one another
//!
//! | stage | modules |
//! |---|---|
//! | what the user wrote, checked | [`config`] |
//! | the floor plan | [`world`] |
//! | kernels and their memory | [`math`], [`robot`] (simulate), [`qnet`] (approximate), [`skill`] (decide), [`lesson`] (learn), [`mod@advance`], [`mod@evaluate`], [`mod@step`], [`learner`] |
//! | who demonstrates | [`teacher`] |
//! | who executes the kernels | [`backend`] |
//! | run folders | [`record`] |
//! | arms x points x seeds -> cohorts -> results | [`experiment`] |
//! | statistics, figures, the page | [`report`], which reads run folders only |
//! | rates beside the machine's limits | [`mod@bench`] |
//! | commands | [`cli`] |
//!
//! Tests enforce the twins and the direction.
//!
//! # Where this differs from the first design, and why
//!
//! - The teacher has its own module behind the kernels instead of a place in `world`: it moves the robot
//!   with the kernels' twins, so that it plans for exactly what happens.
//! - A learner waits before a test until the host has run it: [`mod@evaluate`] takes a workgroup per learner
//!   *and* test trial, which fills a device far better than one learner's trials in sequence would.
//! - All learners of a cohort are in one world: its floor plan lies in a uniform buffer, where one load
//!   serves all lanes.
//! - `record` stands before `experiment`, which commits cohorts through it.
//! - `skill` stands behind `qnet`: a skill over skills asks nets before it chooses.
//! - Memories of a trial (traces of light and doors, means of ranges) belong to the robot and not to a skill: all
//!   skills of a tree may take them as inputs.
//! - Thresholds are learned on the host, between two skills, from nets and lessons that the device hands over once:
//!   one implementation serves every backend.
//!
//! # From Rust
//!
//! What is re-exported here is the public interface: an [`Experiment`] is loaded from files or memory, a [`Backend`] is opened, the experiment
//! runs into a folder, and its [`FinishedRun`] and report are read. `examples/train.rs` does so in some twenty lines. The
//! modules are public for the program, tests and examples alone; their names may change with any version.

#[doc(hidden)]
pub mod backend;
#[doc(hidden)]
pub mod bench;
#[doc(hidden)]
pub mod cli;
#[doc(hidden)]
pub mod config;
#[doc(hidden)]
pub mod env;
#[doc(hidden)]
pub mod experiment;
#[doc(hidden)]
pub mod kernels;
#[doc(hidden)]
pub mod layout;
#[doc(hidden)]
pub mod learn;
#[doc(hidden)]
pub mod math;
#[doc(hidden)]
pub mod policy;
#[doc(hidden)]
pub mod qnet;
#[cfg(feature = "report")]
pub mod report;
#[doc(hidden)]
pub mod run_folder;
#[doc(hidden)]
pub mod teacher;
#[doc(hidden)]
pub mod toml;
#[doc(hidden)]
pub mod train;
#[doc(hidden)]
pub mod world;

pub use backend::open::{BackendChoice, BackendOptions, open_backend};
pub use backend::{Backend, BackendError};
pub use config::{ConfigError, Files, MemoryFiles, Overrides};
pub use experiment::{Experiment, ExperimentError, Progress};
pub use run_folder::{FinishedRun, RecordError};
