//! Every key of a config file: what it means, what it may be, and what it is if nobody sets it.
//!
//! This is the one place for defaults and ranges; the reader and the resolved config both use it.

pub use crate::toml::schema::{Allowed, Bounds, Key, Source};

macro_rules! keys {
    ($($name:ident = $path:literal, $default:expr, $allowed:expr, $basis:ident, $meaning:literal;)*) => {
        $(
            #[doc = concat!("`", $path, "`: ", $meaning, ".")]
            pub const $name: Key = Key {
                path: $path, default: $default, allowed: $allowed, source: Source::$basis, meaning: $meaning,
            };
        )*
        /// All keys, in the order in which files show them.
        pub const ALL: &[Key] = &[$($name),*];
    };
}

use Allowed::{Choice, Flag, Number, Other, Whole};

/// Most trials of a skill and most lessons in a bank: keeps a learner's tables small.
pub(crate) const MANY: u32 = 100_000;
const SHARE: Allowed = Number(Bounds::between(0.0, 1.0));
const RELATIVE: Allowed = Number(Bounds::between(0.0, 0.5));
const DECAY: Allowed = Number(Bounds::below(0.0, 1.0));
const HEAT: Allowed = Number(Bounds::between(0.0, 10_000.0));
/// Sonar readings are whole inches up to this.
const READING: Allowed = Number(Bounds::between(0.0, 127.0));

keys! {
    NAME = "name", None, Other("letters, digits, - and _"), Ours, "names the run folder; the file's stem if left out";
    TITLE = "title", Some("''"), Other("text"), Ours, "one line that says what the experiment is for";
    WORLD = "world", None, Other("a path"), Ours, "the world file, relative to the config file; required";
    ROOT = "root", None, Other("the name of a skill"), Ours, "the skill at the top: only its tree is trained; if left out, the last skill that no other one is made of";
    SEED = "seed", Some("1993"), Whole(0, u32::MAX), Ours, "key of what all learners share: the teacher's bank and the planner's trials";
    SEEDS = "seeds", Some("'0..7'"), Other("ranges such as '0..7', '0..=6', '5' or '1,2,5..9', or a list of whole numbers"), Paper, "one learner per arm and seed; the paper has 7 runs";
    EXTENDS = "extends", None, Other("the name of a config in the same folder"), Ours, "config over which this one is laid: all of that one but its name and title";
    ARMS = "arms", None, Other("a list of arms"), Ours, "the arms that are run; all if left out";
    ARM_LIKE = "arm.*.like", None, Other("the name of an arm"), Ours, "arm over which this one is laid";

    SWEEP_DESIGN = "sweep.design", None, Choice(&["grid", "random"]), Ours, "how the points of a sweep lie: all combinations of values, or drawn at random with the config's seed; grid if left out. Every other key of `sweep` is one of world, root, learning, skill, robot or teacher, with a list of values or a range";
    SWEEP_POINTS = "sweep.points", None, Whole(1, 65_536), Ours, "number of points of a random sweep; required there";
    SWEEP_ONLY = "sweep.only", None, Other("a list of whole numbers"), Ours, "the points that are run, counted from 0; all if left out";

    EVALUATE_AT = "evaluate.at", Some("[0, 25, 50, 75, 100, 150, 200, 250, 300]"), Other("ascending whole numbers"), Ours, "trials of a skill after which it is tested; it always is after its last one";
    EVALUATE_EPISODES = "evaluate.episodes", Some("100"), Whole(1, 10_000), Ours, "greedy test trials each time";
    TEACHER_BANK = "teacher.bank", Some("256"), Whole(1, MANY), Ours, "lessons in the bank of each skill; learners draw theirs from it";
    TEACHER_DISCOUNT = "teacher.discount", Some("0.95"), Number(Bounds::inside(0.0, 1.0)), Ours, "discount factor of the planner, its own, so that arms that differ in theirs share a teacher";
    TEACHER_BACKWARD_COST = "teacher.backward_cost", Some("5.0"), Number(Bounds::between(0.0, 1000.0)), Ours, "what the demonstrator puts on backing up, in units of reward, so that it drives as a person would";
    TEACHER_COLLISION_COST = "teacher.collision_cost", Some("2.0"), Number(Bounds::between(0.0, 1000.0)), Ours, "what the planner puts on collisions besides the skill's own reward, in units of reward";
    TEACHER_EPISODES = "teacher.episodes", Some("1000"), Whole(1, MANY), Ours, "test trials of the planner itself";

    NOISE_KIND = "robot.noise.kind", Some("'gaussian'"), Choice(&["gaussian", "uniform"]), Ours, "amounts are standard deviations, or half-widths";
    NOISE_ACTUATOR = "robot.noise.actuator", Some("0.08"), RELATIVE, Paper, "share of each turn and travel";
    NOISE_SONAR = "robot.noise.sonar", Some("0.10"), RELATIVE, Paper, "share of each sonar range";
    NOISE_LIGHT = "robot.noise.light", Some("0.10"), RELATIVE, Paper, "share of each light intensity, before the threshold";
    NOISE_COMPASS = "robot.noise.compass", Some("2.865"), Number(Bounds::between(0.0, 180.0)), Ours, "degrees on the compass; 0.05 rad";

    MEMORY_LIGHT = "robot.memory.light", Some("0.97"), DECAY, Ours, "what is left, after each step, of the trace of having seen the light";
    MEMORY_DOORS = "robot.memory.doors", Some("0.97"), DECAY, Ours, "what is left, after each step, of the trace of having passed a door";
    MEMORY_RANGES = "robot.memory.ranges", Some("0.9"), DECAY, Ours, "weight of the past in the running means of ranges";
    BESIDE_NEAR = "robot.beside.near", Some("15.0"), READING, Ours, "least sonar reading, in inches, at which the nearest thing on one side counts as a wall followed";
    BESIDE_FAR = "robot.beside.far", Some("30.0"), READING, Ours, "greatest such reading, in inches; more than near";

    HIDDEN = "learning.hidden", Some("32"), Whole(1, 32), Ours, "hidden units of each net; one net per child";
    INIT = "learning.init", Some("0.2"), Number(Bounds::above(0.0, 10.0)), Ours, "initial weights are uniform in plus or minus this";
    GAMMA = "learning.gamma", Some("0.9"), SHARE, Ours, "discount factor";
    LAMBDA = "learning.lambda", Some("0.95"), SHARE, Ours, "0 learns from the next value alone, 1 from the observed return";
    OPTIMISER = "learning.optimiser", Some("'adam'"), Choice(&["adam", "sgd", "adam-rows"]), Ours, "weight update rule; adam-rows keeps one second moment for all weights of an input";
    RATE = "learning.rate", Some("0.0015"), Number(Bounds::above(0.0, 10.0)), Ours, "learning rate; the default is for adam, sgd has none";
    RATE_END_SHARE = "learning.rate_end_share", Some("0.1"), SHARE, Ours, "share of the rate that is left at the end of its schedule, 1 for a constant rate";
    RATE_TRIALS = "learning.rate_trials", Some("300"), Whole(1, MANY), Ours, "trials over which the rate falls linearly to that share";
    MOMENTUM = "learning.momentum", Some("0.0"), DECAY, Ours, "momentum of sgd, 0 for none";
    BETA1 = "learning.beta1", Some("0.9"), DECAY, Ours, "decay of adam's mean gradient";
    BETA2 = "learning.beta2", Some("0.999"), DECAY, Ours, "decay of adam's mean squared gradient";
    EPSILON = "learning.epsilon", Some("1e-3"), Number(Bounds::between(1e-12, 1.0)), Ours, "added to the root of adam's mean squared gradient";
    REWARD_SCALE = "learning.reward_scale", Some("100.0"), Number(Bounds::between(1e-3, 1e6)), Ours, "a reward of this size is learned as Q = 1";
    TARGET_LIMIT = "learning.target_limit", Some("0.99"), Number(Bounds::inside(0.0, 1.0)), Ours, "targets are clipped to plus or minus this, inside the net's output range";
    HEAT_START = "learning.inverse_temperature_start", Some("20.0"), HEAT, Ours, "1/T of action choice at the first trial, per Q / reward_scale";
    HEAT_END = "learning.inverse_temperature_end", Some("120.0"), HEAT, Ours, "1/T at the end of the schedule";
    HEAT_TRIALS = "learning.inverse_temperature_trials", Some("150"), Whole(0, MANY), Ours, "trials over which 1/T rises linearly";
    POLICY_THRESHOLD = "learning.policy_threshold", Some("0.05"), DECAY, Ours, "a replayed step is learned only if its action's current probability exceeds this";
    REPLAYS = "learning.replays", Some("60"), Whole(0, 10_000), Ours, "lessons replayed after each trial";
    MEMORY = "learning.memory", Some("300"), Whole(1, 10_000), Ours, "latest lessons that are kept";
    MEAN_AGE = "learning.mean_age", Some("100.0"), Number(Bounds::between(0.1, 1e6)), Ours, "mean age, in lessons, of the replayed ones";
    TAUGHT_PASSES = "learning.taught_passes", Some("20"), Whole(0, 1000), Ours, "passes over each taught lesson before the first trial";
    TAUGHT_REPLAYS = "learning.taught_replays", Some("3"), Whole(0, 1000), Ours, "taught lessons replayed after each trial";
    TAUGHT_ALWAYS = "learning.taught_always", Some("true"), Flag, Ours, "taught steps are learned whatever their action's probability";
    TIMEOUT_TERMINAL = "learning.timeout_terminal", Some("true"), Flag, Ours, "a trial cut at the step limit ends with value 0 (true), or with its last observation's value (false)";
    MIRROR_REPLAYS = "learning.mirror_replays", Some("false"), Flag, Ours, "half of the replayed lessons are seen in a mirror: left and right exchanged";
    MASK_BLOCKED = "learning.mask_blocked", Some("true"), Flag, Ours, "an action that was just blocked is not available on the next step";

    SHARED_NET = "learning.shared_net", Some("false"), Flag, Ours, "one net with an output per child, instead of a net per child";
    BACKUP = "learning.backup", Some("'decisions'"), Choice(&["steps", "persistent", "decisions"]), Ours, "how a skill over skills learns from a trial: from every step, over all applicable children (the paper read literally); from every step, over those that persistence would allow; or at decisions only";
    ADVANTAGE_SCALE = "learning.advantage_scale", Some("1.0"), Number(Bounds::between(1.0, 1000.0)), Ours, "targets are moved this many times as far from the greatest Q-value; 1 leaves them";
    INNER_SHARE = "learning.inner_share", Some("0.1"), SHARE, Ours, "share of the steps between decisions that the backup `decisions` learns from too";
    CHILD_HEAT = "learning.child_inverse_temperature", Some("60.0"), HEAT, Ours, "1/T at which the children, and theirs, choose while this skill is being learned or tested";

    SKILL_MIRROR = "skill.*.mirror", Some("false"), Other("the name of a skill, or false"), Ours, "this skill is the mirror image of that one, from which it has everything; its other keys, but tested_at, are then not used";
    SKILL_INPUTS = "skill.*.inputs", None, Other("a list of sonar, sonar(SCALE), sonar-far, sonar-compass, sonar-compass(SCALE), light, lit, bumpers, compass, compass2, values, applicable, running, light-trace, door-trace, range-means, room"), Ours, "what the nets see, in order; required. sonar is sonar(60), with the decay in inches";
    SKILL_CHILDREN = "skill.*.children", Some("['turn+15', 'turn-15', 'turn+60', 'turn-60', 'move+12', 'move-12']"), Other("a list of actions and skills"), Paper, "what the skill chooses among; degrees counter-clockwise, inches forward";
    SKILL_APPLICABLE = "skill.*.applicable", Some("{}"), Other("{ child = threshold } with numbers between -1 and 1, learned, or learned(PROBABILITY)"), Ours, "the value of its best child, in units of reward_scale, from which a skill among the children is applicable; learned is where success has probability 0.5. Those left out always are";
    SKILL_CHOICE = "skill.*.choice", Some("'learned'"), Choice(&["learned", "random", "ordered"]), Paper, "a child is chosen by the learned Q-values, at random, or as the first one allowed";
    SKILL_PERSISTENCE = "skill.*.persistence", Some("true"), Other("true, false or training"), Paper, "whether a chosen child is kept to, and not in tests if training";
    SKILL_APPLICABILITY = "skill.*.applicability", Some("true"), Flag, Paper, "only applicable children are chosen";
    SKILL_INTERRUPT = "skill.*.interrupt", Some("true"), Flag, Ours, "a running child that stops being applicable may be left";
    SKILL_DECISION_STEPS = "skill.*.decision_steps", Some("30"), Whole(0, 255), Ours, "steps without any event after which the choice is open again, 0 for never";
    SKILL_PLANNED = "skill.*.planned", Some("false"), Flag, Ours, "the planner, which knows floor plan and pose, stands in for the nets of a skill over actions; lessons and trials are then not used. Privileged";
    SKILL_REWARD = "skill.*.reward", None, Other("{ event = amount } for docked, collision, passed-door, beside-right, beside-left"), Ours, "paid for events; 0 for those left out; required";
    SKILL_STARTS = "skill.*.starts", Some("'anywhere'"), Other("a region, or { region = share } with shares that sum to 1"), Paper, "where training trials start";
    SKILL_TESTS = "skill.*.tests", Some("'anywhere'"), Other("a region"), Ours, "where test trials start";
    SKILL_TESTED_AT = "skill.*.tested_at", None, Other("ascending whole numbers"), Ours, "trials after which the skill is tested; as evaluate.at if left out";
    SKILL_ENDS = "skill.*.ends", Some("[]"), Other("a list of events"), Ours, "events that end a trial as achieved";
    SKILL_MAX_STEPS = "skill.*.max_steps", Some("30"), Whole(1, 255), Paper, "primitive steps after which a trial is cut; 30 is the paper's for docking";
    SKILL_LESSONS = "skill.*.lessons", Some("0"), Whole(0, 10_000), Ours, "taught lessons before the first trial; skills over skills have none";
    SKILL_TRIALS = "skill.*.trials", Some("300"), Whole(0, MANY), Paper, "training trials; 300 is the paper's for docking";

    ALTER_WORLD = "alter.*.world", None, Other("a path"), Ours, "the world file in which learned roots are tested once more; the config's own if left out";
    ALTER_NOISE = "alter.*.noise", None, Other("a table as robot.noise"), Ours, "the noise with which they are, laid over robot.noise; each arm's own if left out";
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
