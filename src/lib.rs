//! `skilltree` trains thousands of small simulated robots at once, each learning its own tree of skills by
//! reinforcement, on any GPU or on the CPU, and gets the same bytes on both. It reproduces Long-Ji Lin,
//! "Hierarchical Learning of Robot Skills by Reinforcement" (1993).
//!
//! # Words
//!
//! | word | meaning |
//! |---|---|
//! | skill | a Q-function over *children*, and what defines its task: inputs, reward, starting region, goal, step limit. In other papers an option |
//! | child | what a skill chooses among: an action or another skill |
//! | applicable | a child whose own best Q-value exceeds the threshold set for it |
//! | persistence | a chosen child is kept to until its goal is achieved or another child becomes applicable |
//! | decision | a step at which a skill over skills may choose again |
//! | trial, step | an episode of training or of a test; one primitive action in it |
//! | lesson | an episode in the replay memory, taught or experienced |
//! | teacher | a planner that demonstrates, and that stands in every report as the bound |
//! | learner | one independent run: robot, nets, lessons, random stream, hyper-parameters |
//! | arm | one experimental condition; at each point of a sweep it is an arm of its own |
//! | cohort | the learners that fit a device together |
//! | twin | the Rust function that says the same as a shader's, statement for statement |
//!
//! # One learner is one workgroup of 32 lanes
//!
//! On a GPU a workgroup of 32 invocations owns a learner; on the CPU one thread does, and the lanes are the elements of
//! arrays. Lanes are sonar rays, then wall segments, then hidden units. Learners never wait for one another and never
//! share a sum, so learner k alone leaves the same bytes as learner k among thousands.
//!
//! A learner is a state machine whose whole state is in its [`layout::LearnerState`]. Kernel [`kernels::train`] moves it
//! on by at most *n* iterations (a trial step, or a replayed transition), so that a dispatch can be as short as a
//! watchdog wants it. Kernel [`kernels::evaluate`] runs greedy tests with the nets read-only, and kernel
//! [`mod@kernels::step`] lets robots carry out given actions.
//!
//! # Three forms, one truth
//!
//! - The **plain twin** of `shaders/PATH.wgsl` stands at `src/PATH.rs` and reads as the shader does. The shaders'
//!   module-scope variables are the fields of one struct, [`env::workgroup::Workgroup`], and their functions its methods.
//!   The plain twins are a backend of their own, `--backend reference`. A test compares names, comments and statements.
//! - The **shader**: both languages share one memory layout, [`layout`], from which the constants and structs of WGSL are
//!   emitted.
//! - The **tuned forms** of the functions that take the time ([`env::workgroup::HotForms`]: draws, observation, motion,
//!   encoding, forward, odds, backward) and of kernel `step` are compiled for each instruction set. Encoding and odds are the
//!   plain twins; the others stand in [`backend::cpu::lanes`] and may be as clever as they like. All else runs the plain
//!   twins there too.
//!
//! Results are built from IEEE f32 `+ - *`, comparisons and integers alone ([`math`]), random numbers are counters
//! ([`math::rng`]), and on Vulkan the SPIR-V is decorated so that no compiler fuses or re-associates. Hence all forms
//! agree to the byte, and tests compare bytes; [`backend::parity`] names the first word that differs, and `skilltree
//! devices --parity` asks any adapter.
//!
//! # A skill tree is data
//!
//! One step of a robot observes and settles what the last action earned ([`mod@env::step`]), asks the skills that some
//! applicability depends on, children first, lets the root choose among what applicability and persistence allow
//! ([`policy::persistence`]), and goes down to an action ([`policy::hierarchy`]). A recorded [`layout::Step`] keeps what
//! was allowed and whether the choice was free, so that [`learn::td_lambda`] can learn from every step or from decisions
//! alone. The same functions serve training and tests.
//!
//! Skills are learned in order, children before parents. Arms that differ in their root alone share the rest: it is
//! trained once for each seed, and each arm goes on from a copy ([`train::pretraining`]), with the bytes of a learner that
//! trained alone.
//!
//! # Runs that are stopped
//!
//! Cohorts train one after another, and each is committed as *parts* before the next begins. In between, the learners'
//! memory is saved in a *checkpoint* every minute and when a signal asks for it ([`train::checkpoint`]): as a learner's
//! whole position is in its memory, going on is training as ever, without the tests that it has taken. Parts and
//! checkpoints belong to one version of the program and one plan. At the end the tables and nets are written part by part
//! ([`train::write_results`]), so that the memory taken does not grow with the number of learners. A learner in which a
//! number stops being finite is frozen by the kernel; the host finds the transition ([`train::divergence`]), lists it in
//! `failures.json`, and leaves the learner in every table.
//!
//! # Rooms, in the order in which they may use one another
//!
//! | room | what happens there |
//! |---|---|
//! | [`layout`] | ground floor: every word that a kernel touches, written once; a row for each action, event, sensor and hyper-parameter |
//! | [`mod@toml`] | TOML with the place of every value |
//! | [`math`] | arithmetic that gives the same bits everywhere |
//! | [`world`] | floor plan -> segments, regions, lookup tables |
//! | [`config`] | what the user wrote -> a checked plan |
//! | [`env`] | SIMULATE: body, sensors, events |
//! | [`qnet`] | APPROXIMATE: nets and optimisers |
//! | [`policy`] | DECIDE: features, applicability, persistence, choice |
//! | [`learn`] | LEARN: lessons, TD(lambda) |
//! | [`kernels`] | what is dispatched |
//! | [`backend`] | who executes: reference, cpu, gpu |
//! | [`teacher`] | value iteration, demonstrations |
//! | [`run_folder`] | what a run leaves on disk |
//! | [`train`] | arms x points x seeds -> cohorts -> results |
//! | `report` | statistics, figures, the page; reads run folders only |
//! | [`mod@bench`] | rates, checked first |
//! | [`mod@experiment`] | the facade: load, run, read |
//! | [`cli`] | commands |
//!
//! A test computes this order from the imports and knows no exceptions; within a room no circle of files is allowed.
//!
//! # How to add
//!
//! - **a sensor**, as a new reading for nets from what the robot senses: a row in `layout/sensors.rs`; a branch in the pair
//!   `policy/features` (`encode` or `scalar_feature`). What is remembered between steps also takes a field of
//!   `layout::Agent` or `layout::Step` and a line in the pair `env/memory`.
//! - **an action**: a row in `layout/actions.rs`; a turn needs no more. A move other than forward and backward takes its
//!   case in the pair `env/motion` and in `backend/cpu/lanes/contact.rs`.
//! - **a reward event**: a row in `layout/events.rs`, which also says whether the sensors tell of it; where it is found,
//!   in the pair `env/events` (`observed_events` or `crossing_events`): the planner asks the same functions.
//! - **a hyper-parameter**: a row in `layout/params.rs`, which makes the key, its reader, its reference page, the learner's
//!   record and the field in WGSL; its use in a kernel pair.
//! - **an optimiser**: a word in `layout/choices.rs`, a pair in `qnet/optimiser/`, its name and its call in the pair
//!   `qnet/optimiser/mod`; `config/unused_keys.rs` where it takes other numbers than Adam. A form for the lanes of a CPU is a
//!   branch in `backend/cpu/lanes/optimiser.rs`, and optional.
//! - **a statistic**: a function in a file of `report/statistics/`, a field in `report/page.rs`, a column in its template.
//! - **a number measured in trials**: a field of `layout::Agent`, its sum in the pair `env/step`; a field of
//!   `run_folder::Sums` and its column; where sums are taken of tests and of the planner's (`train/train_loop.rs`,
//!   `train/write_results.rs`). What a report shows of it is a field of its `Score`, and a statistic.
//!
//! # Where this differs from the first design, and why
//!
//! - The teacher stands behind the backends: it moves the robot with the CPU's tuned forms, so that it plans for exactly
//!   what happens, and quickly.
//! - The twins are methods of one struct that is not generic: the hot functions are a table of pointers. So the state
//!   machine is compiled once, and only the tuned forms for each instruction set.
//! - A learner waits before a test until the host has run it: kernel `evaluate` takes a workgroup per learner *and* test
//!   trial, which fills a device far better than one learner's trials in sequence would.
//! - All learners of a cohort are in one world: its floor plan lies in a uniform buffer, where one load serves all lanes.
//! - `env/segments.rs` stands among the kernels, though no shader has it: lists of segments are data of the cohort, which
//!   the CPU wants as arrays.
//! - Memories of a trial (traces of light and doors, means of ranges) belong to the robot and not to a skill: all skills of
//!   a tree may take them as inputs.
//! - Events of regions are not recorded: which regions a skill's reward and goal name is the skill's own affair, so they
//!   are found anew for every skill that asks, from where the robot was and is.
//! - Thresholds are learned on the host, between two skills, from nets and lessons that the device hands over once: one
//!   implementation serves every backend.
//!
//! # From Rust
//!
//! What is re-exported here is the public interface: an [`Experiment`] is loaded from files or memory, a [`Backend`] is
//! opened, the experiment runs into a folder, and its [`FinishedRun`] and report are read. `examples/train.rs` does so in
//! some twenty lines. The modules are public for the program, tests and examples alone; their names may change with any
//! version.

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
pub use run_folder::{EvaluationRow, FinishedRun, Names, RecordError, TrialRow};
