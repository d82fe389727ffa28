// Kernel `train`: moves a learner on by a number of iterations. An iteration is one trial step, one replayed
// transition, or one change of phase.
//
// The learner is a state machine whose whole state is in its `LearnerState`, so it makes no difference how often it is
// interrupted. Every lane keeps the same copy of the state.

@group(0) @binding(0) var<uniform> dispatch: Dispatch;
@group(0) @binding(1) var<uniform> world: WorldUniform;
@group(0) @binding(2) var<storage, read> tables: array<u32>;
@group(0) @binding(3) var<storage, read> skills: array<SkillShape>;
@group(0) @binding(4) var<storage, read> bank: array<u32>;
@group(0) @binding(5) var<storage, read> params: array<HyperParams>;
@group(0) @binding(6) var<storage, read_write> states: array<LearnerState>;
@group(0) @binding(7) var<storage, read_write> nets: array<f32>;
@group(0) @binding(8) var<storage, read_write> lessons: array<u32>;
@group(0) @binding(9) var<storage, read_write> rows: array<TrialRecord>;

var<private> state: LearnerState;
var<private> rows_base: u32;
var<private> lessons_base: u32;

// Whether the learner is past the point at which this dispatch stops.
fn stopped() -> bool {
    let beyond = state.skill > dispatch.stop_skill && state.phase <= PHASE_START;
    let reached = state.skill == dispatch.stop_skill
        && state.phase == PHASE_START
        && state.trial >= dispatch.stop_trial;
    return beyond || reached || state.phase >= PHASE_DONE;
}

// Waits for the next trial, unless a weight is spoiled.
fn conclude(lane: u32) {
    release_weights(lane);
    // What the last update spoiled is replayed too late: tests come first, and the next skill builds on it.
    state.phase = select(PHASE_FAILED, PHASE_START, weights_are_finite(lane));
}

// Learns from the taught lessons, pass after pass, and lists them as trials.
fn teach(lane: u32) {
    let s = params_base + state.skill;
    let begun = state.replay;
    let finished = state.replay_left == 0u && state.replay_open == 0u;
    if finished && begun >= params[s].pretrain_epochs * params[s].lessons {
        conclude(lane);
    } else {
        if finished {
            let number = begun % params[s].lessons;
            let lesson = taught_lesson(number);
            // Every other pass.
            begin_replay(lesson, 1u, (begun / params[s].lessons) & 1u);
            if begun < params[s].lessons {
                let steps = lesson_word(LESSON_STEPS);
                let end = lesson_word(LESSON_END);
                let reward = bitcast<f32>(lesson_word(LESSON_REWARD));
                let collisions = lesson_word(LESSON_COLLISIONS);
                state.actions += steps;
                write_row(lane, number, steps, reward, end, collisions, 1u);
            }
        }
        hold_weights(lane);
        replay_step(lane);
    }
}

// Begins the next trial, or the next skill after the last one.
fn start() {
    if state.trial >= params[params_base + state.skill].trials {
        state.skill += 1u;
        state.trial = 0u;
        state.remembered = 0u;
        state.replay = 0u;
        state.phase = select(PHASE_DONE, PHASE_TEACH, state.skill < dispatch.skills);
    } else {
        let skill = state.skill;
        let words = draw(learner_stream(state.trial, 0u, PURPOSE_START), 0u);
        let region = start_region(skill, words.x);
        let pose = start_pose(skills[skill].start_offset[region], skills[skill].start_count[region], words);
        reset(pose);
        state.phase = PHASE_ACT;
    }
}

// Observes, and closes the trial where it is over, or else takes one step of it and records it.
fn act(lane: u32) {
    let root = state.skill;
    let s = params_base + root;
    let words = skills[root].record_words;
    let slot = state.remembered % params[s].replay_capacity;
    let lesson = lessons_base + skills[root].memory_offset + slot * skills[root].lesson_stride;
    let step = agent.step;
    draw_step(lane, learner_stream(state.trial, step, PURPOSE_STEP));
    observe_and_score(lane, root);
    if step > 0u {
        write_outcome(lane, words, lesson, step - 1u, agent.events, agent.earned);
    }
    let achieved = (skill_events(root) & skills[root].ends) != 0u;
    value_children(lane, root);
    q_values(lane, root);
    let choices = action_mask(root, params[s].persist_training == 1u);
    if achieved || step >= params[s].max_steps {
        let end = select(TRUNCATED, TERMINATED, achieved);
        set_choice(lane, NO_CHILD, choices);
        write_step(lane, words, lesson, step);
        write_header(lane, lesson, step, end, agent.reward, agent.collisions);
        write_row(lane, state.trial, step, agent.reward, end, agent.collisions, 0u);
        state.remembered += 1u;
        state.replay = 0u;
        state.phase = PHASE_REPLAY;
    } else {
        let word = random[DRAW_CHOICE].x;
        let child = choose(lane, root, choices.allowed, inverse_temperature(root, state.trial), false, word);
        set_choice(lane, child, choices);
        write_step(lane, words, lesson, step);
        commit(root, child, choices);
        let action = descend_to_action(lane, root, child);
        apply_action(lane, root, action);
        state.actions += 1u;
    }
}

// Replays one transition: taught lessons first, then remembered ones.
fn replay(lane: u32) {
    let s = params_base + state.skill;
    let begun = state.replay;
    let taught = select(0u, params[s].taught_replays, params[s].lessons > 0u);
    let finished = state.replay_left == 0u && state.replay_open == 0u;
    if finished && begun >= taught + params[s].replays {
        state.trial += 1u;
        conclude(lane);
    } else {
        if finished {
            let words = draw(learner_stream(state.trial, begun, PURPOSE_REPLAY), 0u);
            let word = words.x;
            let mirrored = words.y & 1u;
            if begun < taught {
                let lesson = taught_lesson(below(word, params[s].lessons));
                begin_replay(lesson, 1u, mirrored);
            } else {
                let lesson = recent_lesson(word);
                begin_replay(lesson, 0u, mirrored);
            }
        }
        hold_weights(lane);
        replay_step(lane);
    }
}

@compute @workgroup_size(LANES)
fn train(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let learner = dispatch.first + group.x;
    state = states[learner];
    agent = state.agent;
    params_base = learner * dispatch.skills;
    nets_base = learner * dispatch.nets_stride;
    lessons_base = learner * dispatch.lessons_stride;
    rows_base = learner * dispatch.rows_stride;
    for (var iteration = 0u; iteration < dispatch.iterations; iteration++) {
        if stopped() {
            break;
        }
        if state.phase == PHASE_TEACH {
            teach(lane);
        } else if state.phase == PHASE_START {
            start();
        } else if state.phase == PHASE_ACT {
            act(lane);
        } else {
            replay(lane);
        }
    }
    release_weights(lane);
    state.agent = agent;
    if lane == 0u {
        states[learner] = state;
    }
}
