//! The words of every buffer that a kernel touches, written once.
//!
//! Each struct is declared here for Rust and, from the same lines, for WGSL: [`super::prelude`] is the text that
//! opens every shader. All fields are 32 bits wide, so both languages give them the same offsets.

use bytemuck::{Pod, Zeroable};

constants! {
    /// Invocations of a workgroup; elements of every lane array.
    LANES = 32;
    /// Sonar and light bearings, 15 degrees apart.
    RAYS = 24;
    /// Most children of a skill.
    MAX_CHILDREN = 8;
    /// Most inputs of a net.
    MAX_INPUTS = 64;
    /// Most rows of weights of a net, in whole lane arrays: inputs, outputs and two of biases.
    MAX_ROWS = 96;
    /// Most input groups of a skill.
    MAX_GROUPS = 12;
    /// Most segments of a world.
    MAX_SEGMENTS = 256;
    /// Most rooms of a world.
    MAX_ROOMS = 16;
    /// Most doors of a world.
    MAX_DOORS = 16;
    /// Most start regions of a skill.
    MAX_STARTS = 4;
    /// Most skills of a learner.
    MAX_SKILLS = 8;
    /// Most skills between the root of a tree and an action, the root counted.
    MAX_DEPTH = 6;
    /// Code of a skill's first skill as a child; lower codes are actions.
    SKILL_CODE = 16;
    /// Words of one recorded step of a skill over actions.
    BASE_WORDS = 10;
    /// Words of one recorded step of a skill over skills.
    RECORD_WORDS = 25;
    /// Word of a record at which the memories stand.
    MEMORY_WORD = 11;
    /// Memories.
    MEMORIES = 6;
    /// Word of a record at which the children's values stand.
    VALUE_WORD = 17;
    /// Words that open a lesson: its steps, how it ended, its reward, its collisions.
    LESSON_HEADER = 4;
    /// Kinds of events that a reward can name.
    EVENTS = 5;
    /// Words of one row of the trial table.
    ROW_WORDS = 8;
    /// Entries of a sonar coding table.
    SONAR_CODES = 128;
}

shared! {
    /// One straight piece of anything solid.
    struct Segment {
        /// Start, inches.
        ax: f32,
        /// Start, inches.
        ay: f32,
        /// End, inches.
        bx: f32,
        /// End, inches.
        by: f32,
        /// Unit vector along the segment.
        tx: f32,
        /// Unit vector along the segment.
        ty: f32,
        /// Length, inches.
        length: f32,
        /// 1 where the segment is the charger's.
        charger: u32,
    }

    /// A rectangle, inches.
    struct Area {
        /// Left.
        x0: f32,
        /// Bottom.
        y0: f32,
        /// Right.
        x1: f32,
        /// Top.
        y1: f32,
    }

    /// The floor plan, in a uniform buffer: one load serves all lanes.
    struct WorldUniform {
        /// Segments in use.
        segments: u32,
        /// Rooms in use.
        rooms: u32,
        /// Doorways in use.
        doors: u32,
        /// 1 where there is a light.
        lit: u32,
        /// Light position, inches.
        light_x: f32,
        /// Light position, inches.
        light_y: f32,
        /// Square of the light's range, square inches.
        light_range2: f32,
        /// Cosine of the docking tolerance.
        dock_cosine: f32,
        /// Cells of the culled segment lists in a row.
        cell_columns: u32,
        /// Rows of cells.
        cell_rows: u32,
        /// Word of the tables at which the cells' list starts stand.
        cell_starts: u32,
        /// Word of the tables at which the starts of the cells' lists of what can hide the light stand.
        sight_starts: u32,
        /// The segments.
        segment: [Segment; MAX_SEGMENTS],
        /// The rooms.
        room: [Area; MAX_ROOMS],
        /// The boxes round the doorways, in which a robot has not yet passed them.
        doorway: [Area; MAX_DOORS],
    }

    /// Noise of a robot, as passed to the functions that need it.
    struct Noise {
        /// Distribution of every term: 0 bell, 1 flat.
        kind: u32,
        /// Relative, turns and travel.
        actuator: f32,
        /// Relative, sonar ranges.
        sonar: f32,
        /// Relative, brightness.
        light: f32,
        /// Degrees, compass.
        compass: f32,
    }

    /// A skill's shape: the same for every learner of a cohort.
    struct SkillShape {
        /// Inputs of each net.
        inputs: u32,
        /// Rows of 32 weights of each net: one per input, hidden biases, weights of each output, output biases.
        rows: u32,
        /// Children, and Q-values.
        children: u32,
        /// Nets: one per child, or one for all.
        nets: u32,
        /// Outputs of each net: one, or one per child.
        outputs: u32,
        /// Input groups in use.
        groups: u32,
        /// Word of a learner's nets at which the skill's first net stands.
        nets_offset: u32,
        /// Word of a learner's nets at which the optimiser's clocks stand.
        clock_offset: u32,
        /// Words of one recorded step.
        record_words: u32,
        /// Words of one lesson slot.
        lesson_stride: u32,
        /// Word of a learner's lessons at which the skill's memory stands.
        memory_offset: u32,
        /// Word of the bank at which the skill's taught lessons stand.
        bank_offset: u32,
        /// Taught lessons in the bank.
        bank_lessons: u32,
        /// Start regions in use.
        starts: u32,
        /// Word of the tables at which the cells of the test region stand.
        tests_offset: u32,
        /// Cells of the test region.
        tests_count: u32,
        /// Events that end a trial as achieved.
        ends: u32,
        /// Bits of the skills below this one, of any depth, that somebody's applicability depends on.
        watched: u32,
        /// Bits of the children that have an applicability threshold.
        thresholded: u32,
        /// 1 where the nets belong to another skill and see the world in a mirror.
        mirrored: u32,
        /// Word of the tables at which the planner's table stands that decides instead of the nets, or 0.
        planned: u32,
        /// Kind of each input group: one of the `GROUP` codes of `policy/features`.
        group_kind: [u32; MAX_GROUPS],
        /// First input of each group.
        group_first: [u32; MAX_GROUPS],
        /// Inputs of each group.
        group_width: [u32; MAX_GROUPS],
        /// Word of the tables at which a sonar group's table stands.
        group_table: [u32; MAX_GROUPS],
        /// Which of the first 32 inputs are bits: those of light and bumpers.
        bits_low: u32,
        /// Which of the others are.
        bits_high: u32,
        /// The child that is each child's mirror image.
        mirror_child: [u32; MAX_CHILDREN],
        /// Code of each child: an action, or `SKILL_CODE` and the skill's number.
        child: [u32; MAX_CHILDREN],
        /// Share of the trials that start in this region or an earlier one.
        start_share: [f32; MAX_STARTS],
        /// Word of the tables at which the region's cells stand.
        start_offset: [u32; MAX_STARTS],
        /// Cells of the region.
        start_count: [u32; MAX_STARTS],
    }

    /// How one learner learns one skill: every number that an arm or a sweep can vary.
    struct HyperParams {
        /// Key shared by the run.
        run_seed: u32,
        /// Key of the learner.
        learner_seed: u32,
        /// Distribution of all noise: 0 bell, 1 flat.
        noise_kind: u32,
        /// Relative, turns and travel.
        noise_actuator: f32,
        /// Relative, sonar ranges.
        noise_sonar: f32,
        /// Relative, brightness.
        noise_light: f32,
        /// Degrees, compass.
        noise_compass: f32,
        /// Hidden units in use.
        hidden: u32,
        /// 1 / `hidden`.
        unit_share: f32,
        /// Initial weights lie in plus or minus this.
        init: f32,
        /// Discount factor.
        gamma: f32,
        /// Share of the observed return in the target.
        lambda: f32,
        /// 0 gradient descent with momentum, 1 Adam, 2 Adam with one second moment for each row of weights.
        optimiser: u32,
        /// Learning rate at the first trial.
        rate: f32,
        /// Share of it that each trial takes away.
        rate_fall: f32,
        /// Trials over which it falls.
        rate_trials: u32,
        /// Momentum, or Adam's decay of the mean gradient.
        beta1: f32,
        /// Adam's decay of the mean squared gradient.
        beta2: f32,
        /// Square of Adam's epsilon, added under the root.
        epsilon2: f32,
        /// 1 / the reward that is learned as Q = 1.
        value_scale: f32,
        /// Targets are clipped to plus or minus this.
        target_limit: f32,
        /// Inverse temperature at the first trial.
        inverse_temperature_start: f32,
        /// Its rise per trial.
        inverse_temperature_slope: f32,
        /// Trials over which it rises.
        inverse_temperature_trials: u32,
        /// Least probability of a policy action.
        policy_threshold: f32,
        /// Remembered lessons replayed after each trial.
        replays: u32,
        /// Lessons remembered.
        memory: u32,
        /// Mean age of replayed lessons.
        mean_age: f32,
        /// -1 / `mean_age`.
        age_decay: f32,
        /// Passes over each taught lesson before the first trial.
        taught_passes: u32,
        /// Taught lessons replayed after each trial.
        taught_replays: u32,
        /// 1 where taught steps are policy actions whatever their probability.
        taught_always: u32,
        /// 1 where the step limit ends a trial with value 0.
        timeout_terminal: u32,
        /// 1 where a blocked action is not available on the next step.
        mask_blocked: u32,
        /// 1 where half of the replayed lessons are seen in a mirror.
        mirror_replays: u32,
        /// Taught lessons given.
        lessons: u32,
        /// Training trials.
        trials: u32,
        /// Step limit of a trial.
        max_steps: u32,
        /// 0 by the learned values, 1 at random, 2 the first allowed.
        choice: u32,
        /// 1 where the chosen child is kept in training.
        persist_training: u32,
        /// 1 where it is kept in tests.
        persist_tests: u32,
        /// 1 where only applicable children are chosen.
        applicability: u32,
        /// 1 where a running child that is no longer applicable may be left.
        interrupt: u32,
        /// Steps after which the choice is open again, 0 for never.
        decision_steps: u32,
        /// Inverse temperature of the skills below this one.
        child_inverse_temperature: f32,
        /// What is learned from: 0 all steps, 1 all steps as persistence allows, 2 decisions.
        backup: u32,
        /// Factor on the distance of targets from the greatest value.
        advantage_scale: f32,
        /// Share of the steps between decisions that are learned from too.
        inner_share: f32,
        /// What each step leaves of the trace of light.
        light_trace: f32,
        /// What each step leaves of the trace of a door.
        door_trace: f32,
        /// Weight of the past in the means of ranges.
        range_mean: f32,
        /// Least reading beside a wall, inches.
        beside_near: u32,
        /// Greatest reading beside a wall, inches.
        beside_far: u32,
        /// Value above which each child is applicable; `ALWAYS` where it always is.
        threshold: [f32; MAX_CHILDREN],
        /// Amount paid for each event.
        reward: [f32; EVENTS],
    }

    /// A robot in a trial: its body, what it remembers, and what it is doing.
    struct Agent {
        /// Inches.
        x: f32,
        /// Inches.
        y: f32,
        /// Degrees.
        heading: f32,
        /// Touching bumpers.
        bumpers: u32,
        /// Steps of the trial taken.
        step: u32,
        /// Room that it was in when the trial began or a door was last passed.
        origin: u32,
        /// Action not available on the next step, or `NO_ACTION`.
        blocked: u32,
        /// 1 where the skill that acts does not repeat what was blocked.
        masks: u32,
        /// Last action, or `NO_ACTION`.
        action: u32,
        /// Events of the last action.
        events: u32,
        /// Reward of the last action.
        earned: f32,
        /// Reward of the trial so far.
        reward: f32,
        /// Discounted reward of the trial so far.
        returned: f32,
        /// Discount of the next reward.
        discount: f32,
        /// Collisions of the trial so far.
        collisions: u32,
        /// Running mean of the ranges east and west, -1 to 1.
        east_west: f32,
        /// Running mean of the ranges north and south, -1 to 1.
        north_south: f32,
        /// Trace of having seen the light.
        light: f32,
        /// Trace of having passed a door.
        door: f32,
        /// The same times the cosine of the compass at the door.
        door_cosine: f32,
        /// The same times its sine.
        door_sine: f32,
        /// Of each skill: the child that runs (`NO_CHILD` where none does), from bit 8 the steps since it was
        /// chosen, from bit 16 the children that were applicable.
        run: [u32; MAX_SKILLS],
    }

    /// Where a learner stands: all that changes from one iteration to the next, but nets and lessons.
    struct LearnerState {
        /// One of the `PHASE` codes.
        phase: u32,
        /// Skill in training.
        skill: u32,
        /// Trials of it finished.
        trial: u32,
        /// Primitive actions executed so far, taught ones included.
        actions: u32,
        /// Lessons remembered so far, forgotten ones included.
        remembered: u32,
        /// Replays of this phase begun so far.
        replay: u32,
        /// 1 where the lesson in replay is a taught one.
        replay_taught: u32,
        /// 1 where it is seen in a mirror.
        replay_mirrored: u32,
        /// Word of the bank or of the memory at which the lesson in replay stands.
        replay_lesson: u32,
        /// Steps of the lesson in replay that are still to be learned; 0 where none is.
        replay_left: u32,
        /// Greatest Q-value after the step to be learned.
        next_best: f32,
        /// Return after the step to be learned.
        next_return: f32,
        /// Rows of the trial table written.
        rows: u32,
        /// Transitions learned from so far.
        updates: u32,
        /// 1 where the observation that ends the lesson in replay is still to be valued.
        replay_open: u32,
        /// The robot in its trial.
        agent: Agent,
    }

    /// A test trial.
    struct Episode {
        /// 0 not begun, 1 running, 2 achieved, 3 cut.
        state: u32,
        /// Where it began, inches.
        start_x: f32,
        /// Where it began, inches.
        start_y: f32,
        /// The robot.
        agent: Agent,
    }

    /// A robot under given actions.
    struct Robot {
        /// Inches.
        x: f32,
        /// Inches.
        y: f32,
        /// Degrees.
        heading: f32,
        /// Touching bumpers.
        bumpers: u32,
        /// Action to carry out, or `NO_ACTION` to sense only.
        action: u32,
        /// Events of the action.
        events: u32,
        /// Steps taken, which picks the random numbers.
        step: u32,
        /// Key shared by the run.
        run_seed: u32,
        /// Key of the robot.
        robot_seed: u32,
        /// Distribution of all noise: 0 bell, 1 flat.
        noise_kind: u32,
        /// Relative, turns and travel.
        noise_actuator: f32,
        /// Relative, sonar ranges.
        noise_sonar: f32,
        /// Relative, brightness.
        noise_light: f32,
        /// Degrees, compass.
        noise_compass: f32,
        /// What it senses after the action: the first words of a record.
        record: [u32; BASE_WORDS],
    }

    /// What the host tells one dispatch.
    struct Dispatch {
        /// Most iterations of each learner, episode or robot.
        iterations: u32,
        /// Learners stop before the first trial beyond this skill and trial.
        stop_skill: u32,
        /// See `stop_skill`.
        stop_trial: u32,
        /// Skills of each learner.
        skills: u32,
        /// Words of one learner's nets.
        nets_stride: u32,
        /// Words of one learner's lessons.
        lessons_stride: u32,
        /// Words of one learner's trial rows.
        rows_stride: u32,
        /// Learners, or robots, in the buffers.
        learners: u32,
        /// Episodes of each learner.
        episodes: u32,
        /// Skill under test.
        test_skill: u32,
        /// Test trials: the counter that keeps the tests' random numbers apart.
        test_number: u32,
        /// First learner of this dispatch.
        first: u32,
    }
}
