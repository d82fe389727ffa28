// Kernel `advance`: moves a learner on by a number of iterations. A iteration is one trial step, one replayed
// transition, or one change of phase.
//
// The learner is a state machine whose whole state is in its state, so it makes no difference how often
// it is interrupted. Every lane keeps the same copy of the state.

@group(0) @binding(0) var<uniform> dispatch: Dispatch;
@group(0) @binding(1) var<uniform> world: WorldUniform;
@group(0) @binding(2) var<storage, read> tables: array<u32>;
@group(0) @binding(3) var<storage, read> skills: array<SkillShape>;
@group(0) @binding(4) var<storage, read> bank: array<u32>;
@group(0) @binding(5) var<storage, read> params: array<HyperParams>;
@group(0) @binding(6) var<storage, read_write> states: array<LearnerState>;
@group(0) @binding(7) var<storage, read_write> nets: array<f32>;
@group(0) @binding(8) var<storage, read_write> lessons: array<u32>;
@group(0) @binding(9) var<storage, read_write> rows: array<u32>;

// Words of `held`. The host sets it from what the device has and what the cohort's skills take.
override HELD: u32 = 1u;

// The weights of the skill in training from the first replayed transition on, until the learner leaves replay: rows are
// packed by the lanes in use. The array is not zeroed; no word is read before `hold` has written it.
var<workgroup> held: array<f32, HELD>;
var<private> holding: bool;

var<private> state: LearnerState;
var<private> rows_base: u32;
var<private> lessons_base: u32;

fn weights_of(skill: u32, units: u32, base: u32, net: u32) -> u32 {
    return select(net_of(skill, base, net), net * skills[skill].rows * units, holding);
}

fn stride_of(units: u32) -> u32 {
    return select(LANES, units, holding);
}

fn weight(at: u32) -> f32 {
    if holding {
        return held[at];
    }
    return nets[at];
}

fn put_weight(at: u32, value: f32) {
    if holding {
        held[at] = value;
    } else {
        nets[at] = value;
    }
}

fn hold(lane: u32, s: u32, base: u32) {
    let skill = state.skill;
    let units = lanes_of(params[s].hidden);
    let rows = skills[skill].rows;
    if !holding && skills[skill].nets * rows * units <= HELD {
        for (var number = 0u; number < skills[skill].nets; number++) {
            let net = net_of(skill, base, number);
            for (var row = 0u; row < rows; row++) {
                if lane < units {
                    held[(number * rows + row) * units + lane] = nets[net + row * LANES + lane];
                }
            }
        }
        holding = true;
        workgroupBarrier();
    }
}

fn let_go(lane: u32, base: u32) {
    if holding {
        let skill = state.skill;
        let units = lanes_of(params[params_base + skill].hidden);
        let rows = skills[skill].rows;
        for (var number = 0u; number < skills[skill].nets; number++) {
            let net = net_of(skill, base, number);
            for (var row = 0u; row < rows; row++) {
                if lane < units {
                    nets[net + row * LANES + lane] = held[(number * rows + row) * units + lane];
                }
            }
        }
        holding = false;
        storageBarrier();
        workgroupBarrier();
    }
}

fn stopped() -> bool {
    let beyond = state.skill > dispatch.stop_skill && state.phase <= PHASE_START;
    let reached = state.skill == dispatch.stop_skill
        && state.phase == PHASE_START
        && state.trial >= dispatch.stop_trial;
    return beyond || reached || state.phase >= PHASE_DONE;
}

fn conclude(lane: u32, base: u32) {
    let_go(lane, base);
    // What the last update spoiled is replayed too late: tests come first, and the next skill builds on it.
    state.phase = select(PHASE_FAILED, PHASE_START, sound_weights(lane, base));
}

fn teach(lane: u32, s: u32, base: u32) {
    let begun = state.replay;
    let finished = state.replay_left == 0u && state.replay_open == 0u;
    if finished && begun >= params[s].pretrain_epochs * params[s].lessons {
        conclude(lane, base);
    } else {
        if finished {
            let number = begun % params[s].lessons;
            let lesson = taught_lesson(s, number);
            // Every other pass.
            begin_replay(s, lesson, 1u, (begun / params[s].lessons) & 1u);
            if begun < params[s].lessons {
                let steps = lesson_word(0u);
                let end = lesson_word(1u);
                let reward = bitcast<f32>(lesson_word(2u));
                let collisions = lesson_word(3u);
                state.actions += steps;
                write_row(lane, number, steps, reward, end, collisions, 1u);
            }
        }
        hold(lane, s, base);
        replay_step(lane, s, base);
    }
}

fn start(s: u32) {
    if state.trial >= params[s].trials {
        state.skill += 1u;
        state.trial = 0u;
        state.remembered = 0u;
        state.replay = 0u;
        state.phase = select(PHASE_DONE, PHASE_TEACH, state.skill < dispatch.skills);
    } else {
        let skill = state.skill;
        let key = vec2<u32>(params[s].run_seed, params[s].learner_seed);
        let stream = Stream(key, skill, state.trial, 0u, PURPOSE_START);
        let words = draw(stream, 0u);
        let region = start_region(skill, words.x);
        let pose = start_pose(skills[skill].start_offset[region], skills[skill].start_count[region], words);
        place(pose);
        state.phase = PHASE_ACT;
    }
}

fn act(lane: u32, s: u32, base: u32) {
    let root = state.skill;
    let words = skills[root].record_words;
    let slot = state.remembered % params[s].replay_capacity;
    let lesson = lessons_base + skills[root].memory_offset + slot * skills[root].lesson_stride;
    let step = agent.step;
    let key = vec2<u32>(params[s].run_seed, params[s].learner_seed);
    let stream = Stream(key, root, state.trial, step, PURPOSE_STEP);
    draw_step(lane, stream);
    sense(lane, s);
    if step > 0u {
        write_outcome(lane, words, lesson, step - 1u, agent.events, agent.earned);
    }
    let achieved = (agent.events & skills[root].ends) != 0u;
    watch(lane, base, root);
    think(lane, base, root);
    let persist = params[s].persist_training == 1u;
    let found = options(root, persist);
    if achieved || step >= params[s].max_steps {
        let end = select(CUT, ENDED, achieved);
        note(lane, NO_CHILD, found);
        write_record(lane, words, lesson, step);
        write_header(lane, lesson, step, end, agent.reward, agent.collisions);
        write_row(lane, state.trial, step, agent.reward, end, agent.collisions, 0u);
        state.remembered += 1u;
        state.replay = 0u;
        state.phase = PHASE_REPLAY;
    } else {
        let heat = inverse_temperature(s, state.trial);
        let child = choose(lane, s, skills[root].children, found.allowed, heat, false, random[DRAW_CHOICE].x);
        note(lane, child, found);
        write_record(lane, words, lesson, step);
        commit(root, child, found);
        let action = descend(lane, base, root, child);
        execute(lane, s, action);
        state.actions += 1u;
    }
}

fn replay(lane: u32, s: u32, base: u32) {
    let begun = state.replay;
    let taught = select(0u, params[s].taught_replays, params[s].lessons > 0u);
    let finished = state.replay_left == 0u && state.replay_open == 0u;
    if finished && begun >= taught + params[s].replays {
        state.trial += 1u;
        conclude(lane, base);
    } else {
        if finished {
            let key = vec2<u32>(params[s].run_seed, params[s].learner_seed);
            let stream = Stream(key, state.skill, state.trial, begun, PURPOSE_REPLAY);
            let words = draw(stream, 0u);
            let word = words.x;
            let mirrored = words.y & 1u;
            if begun < taught {
                let lesson = taught_lesson(s, below(word, params[s].lessons));
                begin_replay(s, lesson, 1u, mirrored);
            } else {
                let lesson = recent_lesson(s, word);
                begin_replay(s, lesson, 0u, mirrored);
            }
        }
        hold(lane, s, base);
        replay_step(lane, s, base);
    }
}

@compute @workgroup_size(LANES)
fn advance(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let learner = dispatch.first + group.x;
    state = states[learner];
    agent = state.agent;
    params_base = learner * dispatch.skills;
    rows_base = learner * dispatch.rows_stride;
    lessons_base = learner * dispatch.lessons_stride;
    let base = learner * dispatch.nets_stride;
    for (var iteration = 0u; iteration < dispatch.iterations; iteration++) {
        if stopped() {
            break;
        }
        let s = params_base + state.skill;
        if state.phase == PHASE_TEACH {
            teach(lane, s, base);
        } else if state.phase == PHASE_START {
            start(s);
        } else if state.phase == PHASE_ACT {
            act(lane, s, base);
        } else {
            replay(lane, s, base);
        }
    }
    let_go(lane, base);
    state.agent = agent;
    if lane == 0u {
        states[learner] = state;
    }
}
