//! Every key of a config file: what it means, what it may be, and what it is if nobody sets it.
//!
//! Numbers, flags and choices that a learner's memory holds have their rows in [`crate::layout::params`]; all other keys
//! have theirs here. [`all`] has both.

use crate::layout::params::{HyperParams, MAX_TRIALS, Noise};
pub use crate::layout::schema::{Allowed, Bounds, DefaultSource, KeyRow};
use Allowed::{Choice, Flag, Number, Other, Whole};

macro_rules! keys {
    ($($name:ident = $path:literal, $default:expr, $allowed:expr, $source:ident, $doc:literal;)*) => {
        $(
            #[doc = concat!("`", $path, "`: ", $doc)]
            pub const $name: KeyRow = KeyRow {
                path: $path, default: $default, allowed: $allowed, source: DefaultSource::$source, doc: $doc,
            };
        )*
        const OTHERS: &[KeyRow] = &[$($name),*];
    };
}

/// All keys: those of a robot and of learning first, skills and what follows from them last.
pub fn all() -> impl Iterator<Item = &'static KeyRow> {
    let own = |row: &&KeyRow| !row.path.starts_with("skill.") && !row.path.starts_with("transfer.");
    let numbers = || Noise::rows().chain(HyperParams::rows()).map(|row| &row.key);
    let (first, last) = (OTHERS.iter().filter(own), OTHERS.iter().filter(move |row| !own(row)));
    first.chain(numbers()).chain(last)
}

/// Whether some key's path begins with this part.
pub fn is_group(first: &str) -> bool {
    all().any(|key| key.path.split('.').next() == Some(first))
}

const TEXT: &[&str] = &["string"];
const LIST: &[&str] = &["array"];
const TABLE: &[&str] = &["object"];

keys! {
    NAME = "name", None, Other(TEXT, "letters, digits, - and _"), Ours, "Names the run folder; the file's stem if left out.";
    TITLE = "title", Some("''"), Other(TEXT, "text"), Ours, "One line that says what the experiment is for.";
    WORLD = "world", None, Other(TEXT, "a path"), Ours, "The world file, relative to the config file; required.";
    ROOT = "root", None, Other(TEXT, "the name of a skill"), Ours, "The skill at the top: only its tree is trained; if left out, the last skill that no other one is made of.";
    SEED = "seed", Some("1993"), Whole(0, u32::MAX), Ours, "Key of what all learners share: the teacher's lessons and the planner's trials.";
    SEEDS = "seeds", Some("'0..7'"), Other(&["string", "integer", "array"], "ranges such as '0..7', '0..=6', '5' or '1,2,5..9', or a list of whole numbers"), Paper, "One learner per arm and seed; the paper has 7 runs.";
    EXTENDS = "extends", None, Other(TEXT, "the name of a config in the same folder"), Ours, "Config over which this one is laid: all of that one but its name and title.";
    ARMS = "arms", None, Other(LIST, "a list of arms"), Ours, "The arms that are run; all if left out.";
    ARM_EXTENDS = "arm.*.extends", None, Other(TEXT, "the name of an arm"), Ours, "Arm over which this one is laid. Besides, an arm takes world, root, learning, skill, robot and teacher, laid over the config's own.";

    SWEEP_DESIGN = "sweep.design", None, Choice(&["grid", "random"]), Ours, "How the points of a sweep lie: all combinations of values, or drawn at random with the config's seed; grid if left out. Every other key of `sweep` is one of world, root, learning, skill, robot or teacher, with a list of values or a range { from, to, steps, scale }.";
    SWEEP_POINTS = "sweep.points", None, Whole(1, 65_536), Ours, "Number of points of a random sweep; required there.";
    SWEEP_ONLY = "sweep.only", None, Other(LIST, "a list of whole numbers"), Ours, "The points that are run, counted from 0; all if left out.";

    EVALUATE_AT = "evaluate.at", Some("[0, 25, 50, 75, 100, 150, 200, 250, 300]"), Other(LIST, "ascending whole numbers"), Ours, "Trials of a skill after which it is tested; it always is after its last one.";
    EVALUATE_EPISODES = "evaluate.episodes", Some("100"), Whole(1, 10_000), Ours, "Greedy test trials each time.";
    TEACHER_LESSONS = "teacher.lessons", Some("256"), Whole(1, MAX_TRIALS), Ours, "Lessons demonstrated for each skill; learners draw theirs from them.";
    TEACHER_DISCOUNT = "teacher.discount", Some("0.95"), Number(Bounds::inside(0.0, 1.0)), Ours, "Discount factor of the planner, its own, so that arms that differ in theirs share a teacher.";
    TEACHER_BACKWARD_COST = "teacher.backward_cost", Some("5.0"), Number(Bounds::between(0.0, 1000.0)), Ours, "What the demonstrator puts on backing up, in units of reward, so that it drives as a person would.";
    TEACHER_COLLISION_COST = "teacher.collision_cost", Some("2.0"), Number(Bounds::between(0.0, 1000.0)), Ours, "What the planner puts on collisions besides the skill's own reward, in units of reward.";
    TEACHER_EVAL_EPISODES = "teacher.eval_episodes", Some("1000"), Whole(1, MAX_TRIALS), Ours, "Test trials of the planner itself, the bound that reports show.";

    SKILL_MIRROR = "skill.*.mirror", Some("false"), Other(&["string", "boolean"], "the name of a skill, or false"), Ours, "This skill is the mirror image of that one, from which it has everything; its other keys, but eval_at, are then not used.";
    SKILL_INPUTS = "skill.*.inputs", None, Other(LIST, "a list of inputs"), Ours, "What the nets see, in order; required. sonar is sonar(60), with the decay in inches.";
    SKILL_CHILDREN = "skill.*.children", Some("['turn+15', 'turn-15', 'turn+60', 'turn-60', 'move+12', 'move-12']"), Other(LIST, "a list of actions and skills"), Paper, "What the skill chooses among; degrees counter-clockwise, inches forward.";
    SKILL_APPLICABLE = "skill.*.applicable", Some("{}"), Other(TABLE, "{ child = threshold } with numbers between -1 and 1, learned, or learned(PROBABILITY)"), Ours, "The value of its best child, in units of reward_scale, from which a skill among the children is applicable; learned is where success has probability 0.5. Those left out always are.";
    SKILL_PERSISTENCE = "skill.*.persistence", Some("true"), Other(&["boolean", "string"], "true, false or training"), Paper, "Whether a chosen child is kept to, and not in tests if training.";
    SKILL_ORACLE = "skill.*.oracle", Some("false"), Flag, Ours, "The planner, which knows floor plan and pose, stands in for the nets of a skill over actions; lessons and trials are then not used. Privileged.";
    SKILL_REWARD = "skill.*.reward", None, Other(TABLE, "{ event = amount }"), Ours, "Paid for events (see `skilltree keys events`); 0 for those left out; required. step = -1 is a cost of every step.";
    SKILL_STARTS = "skill.*.starts", Some("'anywhere'"), Other(&["string", "object"], "a region, or { region = share } with shares that sum to 1"), Paper, "Where training trials start.";
    SKILL_EVAL_STARTS = "skill.*.eval_starts", Some("'anywhere'"), Other(TEXT, "a region"), Ours, "Where test trials start.";
    SKILL_EVAL_AT = "skill.*.eval_at", None, Other(LIST, "ascending whole numbers"), Ours, "Trials after which the skill is tested; as evaluate.at if left out.";
    SKILL_GOAL = "skill.*.goal", Some("[]"), Other(LIST, "a list of events"), Ours, "Events (see `skilltree keys events`) that end a trial as achieved.";

    TRANSFER_WORLD = "transfer.*.world", None, Other(TEXT, "a path"), Ours, "The world file in which learned roots are tested once more, without training; the config's own if left out.";
    TRANSFER_NOISE = "transfer.*.noise", None, Other(TABLE, "a table as robot.noise"), Ours, "The noise with which they are, laid over robot.noise; each arm's own if left out.";
}

/// Amount paid for an event.
pub const AMOUNT: Bounds = Bounds::between(-1e6, 1e6);
/// Share of trials that start in a region.
pub const START_SHARE: Bounds = Bounds::above(0.0, 1.0);
/// Value from which a child is applicable, set by hand.
pub const THRESHOLD: Bounds = Bounds::between(-1.0, 1.0);
/// Probability of success at a learned threshold.
pub const PROBABILITY: Bounds = Bounds::inside(0.0, 1.0);
/// The same of `learned` without a number. Ours.
pub const PROBABILITY_DEFAULT: f32 = 0.5;
/// Decay of the near sonar coding, inches.
pub const SONAR_SCALE: Bounds = Bounds::between(1.0, 1000.0);
