// Kernel `advance`: moves a learner on by a number of quanta. A quantum is one trial step, one replayed
// transition, or one change of phase.
//
// The learner is a state machine whose whole state is in its cursor, so it makes no difference how often
// it is interrupted. Every lane keeps the same copy of the cursor.

@group(0) @binding(0) var<uniform> dispatch: Dispatch;
@group(0) @binding(1) var<uniform> world: WorldPlan;
@group(0) @binding(2) var<storage, read> atlas: array<u32>;
@group(0) @binding(3) var<storage, read> skills: array<SkillPlan>;
@group(0) @binding(4) var<storage, read> bank: array<u32>;
@group(0) @binding(5) var<storage, read> settings: array<Settings>;
@group(0) @binding(6) var<storage, read_write> cursors: array<Cursor>;
@group(0) @binding(7) var<storage, read_write> nets: array<f32>;
@group(0) @binding(8) var<storage, read_write> lessons: array<u32>;
@group(0) @binding(9) var<storage, read_write> rows: array<u32>;

// Words of `held`. The host sets it from what the device has and what the cohort's skills take.
override HELD: u32 = 1u;

// The weights of the skill in training from the first replayed transition on, until the learner leaves replay: rows are
// packed by the lanes in use. The array is not zeroed; no word is read before `hold` has written it.
var<workgroup> held: array<f32, HELD>;
var<private> holding: bool;

var<private> cursor: Cursor;
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
    let skill = cursor.skill;
    let units = lanes_of(settings[s].hidden);
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
        let skill = cursor.skill;
        let units = lanes_of(settings[settings_base + skill].hidden);
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
    let beyond = cursor.skill > dispatch.stop_skill && cursor.phase <= PHASE_START;
    let reached = cursor.skill == dispatch.stop_skill
        && cursor.phase == PHASE_START
        && cursor.trial >= dispatch.stop_trial;
    return beyond || reached || cursor.phase >= PHASE_DONE;
}

fn conclude(lane: u32, base: u32) {
    let_go(lane, base);
    // What the last update spoiled is replayed too late: tests come first, and the next skill builds on it.
    cursor.phase = select(PHASE_FAILED, PHASE_START, sound_weights(lane, base));
}

fn teach(lane: u32, s: u32, base: u32) {
    let begun = cursor.replay;
    let finished = cursor.replay_left == 0u && cursor.replay_open == 0u;
    if finished && begun >= settings[s].taught_passes * settings[s].lessons {
        conclude(lane, base);
    } else {
        if finished {
            let number = begun % settings[s].lessons;
            let lesson = taught_lesson(s, number);
            // Every other pass.
            begin_replay(s, lesson, 1u, (begun / settings[s].lessons) & 1u);
            if begun < settings[s].lessons {
                let steps = lesson_word(0u);
                let end = lesson_word(1u);
                let reward = bitcast<f32>(lesson_word(2u));
                let collisions = lesson_word(3u);
                cursor.actions += steps;
                write_row(lane, number, steps, reward, end, collisions, 1u);
            }
        }
        hold(lane, s, base);
        replay_step(lane, s, base);
    }
}

fn start(s: u32) {
    if cursor.trial >= settings[s].trials {
        cursor.skill += 1u;
        cursor.trial = 0u;
        cursor.remembered = 0u;
        cursor.replay = 0u;
        cursor.phase = select(PHASE_DONE, PHASE_TEACH, cursor.skill < dispatch.skills);
    } else {
        let skill = cursor.skill;
        let key = vec2<u32>(settings[s].run_seed, settings[s].learner_seed);
        let stream = Stream(key, skill, cursor.trial, 0u, PURPOSE_START);
        let words = draw(stream, 0u);
        let region = start_region(skill, words.x);
        let pose = start_pose(skills[skill].start_offset[region], skills[skill].start_count[region], words);
        place(pose);
        cursor.phase = PHASE_ACT;
    }
}

fn act(lane: u32, s: u32, base: u32) {
    let root = cursor.skill;
    let words = skills[root].record_words;
    let slot = cursor.remembered % settings[s].memory;
    let lesson = lessons_base + skills[root].memory_offset + slot * skills[root].lesson_stride;
    let step = agent.step;
    let key = vec2<u32>(settings[s].run_seed, settings[s].learner_seed);
    let stream = Stream(key, root, cursor.trial, step, PURPOSE_STEP);
    roll(lane, stream);
    sense(lane, s);
    if step > 0u {
        write_outcome(lane, words, lesson, step - 1u, agent.events, agent.earned);
    }
    let achieved = (agent.events & skills[root].ends) != 0u;
    watch(lane, base, root);
    think(lane, base, root);
    let persist = settings[s].persist_training == 1u;
    let found = options(root, persist);
    if achieved || step >= settings[s].max_steps {
        let end = select(CUT, ENDED, achieved);
        note(lane, NO_CHILD, found);
        write_record(lane, words, lesson, step);
        write_header(lane, lesson, step, end, agent.reward, agent.collisions);
        write_row(lane, cursor.trial, step, agent.reward, end, agent.collisions, 0u);
        cursor.remembered += 1u;
        cursor.replay = 0u;
        cursor.phase = PHASE_REPLAY;
    } else {
        let heat = sharpness(s, cursor.trial);
        let child = choose(lane, s, skills[root].children, found.allowed, heat, false, dice[DICE_CHOICE].x);
        note(lane, child, found);
        write_record(lane, words, lesson, step);
        commit(root, child, found);
        let action = descend(lane, base, root, child);
        execute(lane, s, action);
        cursor.actions += 1u;
    }
}

fn replay(lane: u32, s: u32, base: u32) {
    let begun = cursor.replay;
    let taught = select(0u, settings[s].taught_replays, settings[s].lessons > 0u);
    let finished = cursor.replay_left == 0u && cursor.replay_open == 0u;
    if finished && begun >= taught + settings[s].replays {
        cursor.trial += 1u;
        conclude(lane, base);
    } else {
        if finished {
            let key = vec2<u32>(settings[s].run_seed, settings[s].learner_seed);
            let stream = Stream(key, cursor.skill, cursor.trial, begun, PURPOSE_REPLAY);
            let words = draw(stream, 0u);
            let word = words.x;
            let mirrored = words.y & 1u;
            if begun < taught {
                let lesson = taught_lesson(s, below(word, settings[s].lessons));
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
    cursor = cursors[learner];
    agent = cursor.agent;
    settings_base = learner * dispatch.skills;
    rows_base = learner * dispatch.rows_stride;
    lessons_base = learner * dispatch.lessons_stride;
    let base = learner * dispatch.nets_stride;
    for (var quantum = 0u; quantum < dispatch.quanta; quantum++) {
        if stopped() {
            break;
        }
        let s = settings_base + cursor.skill;
        if cursor.phase == PHASE_TEACH {
            teach(lane, s, base);
        } else if cursor.phase == PHASE_START {
            start(s);
        } else if cursor.phase == PHASE_ACT {
            act(lane, s, base);
        } else {
            replay(lane, s, base);
        }
    }
    let_go(lane, base);
    cursor.agent = agent;
    if lane == 0u {
        cursors[learner] = cursor;
    }
}
