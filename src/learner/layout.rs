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
    /// Most input groups of a skill.
    MAX_GROUPS = 8;
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
    /// Words of one recorded step.
    RECORD_WORDS = 10;
    /// Words that open a lesson: its steps, how it ended, its reward, its collisions.
    LESSON_HEADER = 4;
    /// Kinds of events that a reward can name.
    EVENTS = 3;
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
    struct WorldPlan {
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
        /// Word of the atlas at which the cells' list starts stand.
        cell_starts: u32,
        /// Keeps the arrays on 16 bytes.
        padding: u32,
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
    struct SkillPlan {
        /// Inputs of each net.
        inputs: u32,
        /// Rows of 32 weights of each net: one per input, hidden biases, output weights, output bias.
        rows: u32,
        /// Nets: one per child.
        children: u32,
        /// Input groups in use.
        groups: u32,
        /// Word of a learner's nets at which the skill's first net stands.
        nets_offset: u32,
        /// Word of a learner's nets at which the optimiser's clocks stand.
        clock_offset: u32,
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
        /// Word of the atlas at which the cells of the test region stand.
        tests_offset: u32,
        /// Cells of the test region.
        tests_count: u32,
        /// Events that end a trial as achieved.
        ends: u32,
        /// Kind of each input group: 0 table of the sonar reading, 1 light, 2 bumpers, 3 compass.
        group_kind: [u32; MAX_GROUPS],
        /// First input of each group.
        group_first: [u32; MAX_GROUPS],
        /// Word of the atlas at which a sonar group's table stands.
        group_table: [u32; MAX_GROUPS],
        /// Action code of each child.
        action: [u32; MAX_CHILDREN],
        /// Share of the trials that start in this region or an earlier one.
        start_share: [f32; MAX_STARTS],
        /// Word of the atlas at which the region's cells stand.
        start_offset: [u32; MAX_STARTS],
        /// Cells of the region.
        start_count: [u32; MAX_STARTS],
    }

    /// How one learner learns one skill: every number that an arm or a sweep can vary.
    struct Settings {
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
        /// Initial weights lie in plus or minus this.
        init: f32,
        /// Discount factor.
        gamma: f32,
        /// Share of the observed return in the target.
        lambda: f32,
        /// 0 gradient descent with momentum, 1 Adam.
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
        sharpness_start: f32,
        /// Its rise per trial.
        sharpness_slope: f32,
        /// Trials over which it rises.
        sharpness_trials: u32,
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
        /// Taught lessons given.
        lessons: u32,
        /// Training trials.
        trials: u32,
        /// Step limit of a trial.
        max_steps: u32,
        /// Amount paid for each event.
        reward: [f32; EVENTS],
    }

    /// Where a learner stands: all that changes from one quantum to the next, but nets and lessons.
    struct Cursor {
        /// One of the `PHASE` codes.
        phase: u32,
        /// Skill in training.
        skill: u32,
        /// Trials of it finished.
        trial: u32,
        /// Steps of the trial taken.
        step: u32,
        /// Inches.
        x: f32,
        /// Inches.
        y: f32,
        /// Degrees.
        heading: f32,
        /// Touching bumpers.
        bumpers: u32,
        /// Child masked on the next step, or `NO_ACTION`.
        masked: u32,
        /// Room in which the trial began.
        origin: u32,
        /// Primitive actions executed so far, taught ones included.
        actions: u32,
        /// Reward of the trial so far.
        reward: f32,
        /// Collisions of the trial so far.
        collisions: u32,
        /// Lessons remembered so far, forgotten ones included.
        remembered: u32,
        /// Replays of this phase begun so far.
        replay: u32,
        /// 1 where the lesson in replay is a taught one.
        replay_taught: u32,
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
    }

    /// A test trial.
    struct Episode {
        /// Inches.
        x: f32,
        /// Inches.
        y: f32,
        /// Degrees.
        heading: f32,
        /// Touching bumpers.
        bumpers: u32,
        /// Steps taken.
        step: u32,
        /// Child masked on the next step, or `NO_ACTION`.
        masked: u32,
        /// Room in which the trial began.
        origin: u32,
        /// 0 not begun, 1 running, 2 achieved, 3 cut.
        state: u32,
        /// Reward so far.
        reward: f32,
        /// Collisions so far.
        collisions: u32,
        /// Where it began, inches.
        start_x: f32,
        /// Where it began, inches.
        start_y: f32,
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
        record: [u32; RECORD_WORDS],
    }

    /// What the host tells one dispatch.
    struct Dispatch {
        /// Most quanta of each learner, episode or robot.
        quanta: u32,
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
