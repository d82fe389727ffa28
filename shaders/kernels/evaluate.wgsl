// Kernel `evaluate`: moves a greedy test trial on by a number of steps. The nets are read only.
//
// Every test of a learner begins from the same starts; the noise differs from test to test.

@group(0) @binding(0) var<uniform> dispatch: Dispatch;
@group(0) @binding(1) var<uniform> world: WorldUniform;
@group(0) @binding(2) var<storage, read> tables: array<u32>;
@group(0) @binding(3) var<storage, read> skills: array<SkillShape>;
@group(0) @binding(4) var<storage, read> params: array<HyperParams>;
@group(0) @binding(5) var<storage, read> nets: array<f32>;
@group(0) @binding(6) var<storage, read_write> episodes: array<Episode>;

const STATE_FRESH: u32 = 0u;
const STATE_RUNNING: u32 = 1u;
const STATE_ACHIEVED: u32 = 2u;
const STATE_CUT: u32 = 3u;

var<private> episode: Episode;

fn weights_of(skill: u32, units: u32, base: u32, net: u32) -> u32 {
    return net_of(skill, base, net);
}

fn stride_of(units: u32) -> u32 {
    return LANES;
}

fn weight(at: u32) -> f32 {
    return nets[at];
}

fn begin(s: u32, number: u32) {
    let skill = dispatch.test_skill;
    let key = vec2<u32>(params[s].run_seed, params[s].learner_seed);
    let stream = Stream(key, dispatch.test_skill, number, 0u, PURPOSE_TEST_START);
    let pose = start_pose(skills[skill].tests_offset, skills[skill].tests_count, draw(stream, 0u));
    place(pose);
    episode.state = STATE_RUNNING;
    episode.start_x = pose.x;
    episode.start_y = pose.y;
}

@compute @workgroup_size(LANES)
fn evaluate(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let learner = dispatch.first + group.x;
    let number = group.y;
    // Results stand by the place of the learner in this dispatch: a test is read back part by part.
    let slot = group.x * dispatch.episodes + number;
    episode = episodes[slot];
    agent = episode.agent;
    params_base = learner * dispatch.skills;
    let root = dispatch.test_skill;
    let s = params_base + root;
    let base = learner * dispatch.nets_stride;
    if episode.state == STATE_FRESH {
        begin(s, number);
    }
    for (var iteration = 0u; iteration < dispatch.iterations; iteration++) {
        if episode.state != STATE_RUNNING {
            break;
        }
        let key = vec2<u32>(params[s].run_seed, params[s].learner_seed);
        let stream = Stream(key, root | (dispatch.test_number << 8u), number, agent.step, PURPOSE_TEST);
        draw_step(lane, stream);
        sense(lane, s);
        let achieved = (agent.events & skills[root].ends) != 0u;
        if achieved || agent.step >= params[s].max_steps {
            episode.state = select(STATE_CUT, STATE_ACHIEVED, achieved);
        } else {
            watch(lane, base, root);
            think(lane, base, root);
            let persist = params[s].persist_tests == 1u;
            let found = options(root, persist);
            let child = choose(lane, s, skills[root].children, found.allowed, 1.0f, true, random[DRAW_CHOICE].x);
            commit(root, child, found);
            let action = descend(lane, base, root, child);
            execute(lane, s, action);
        }
    }
    episode.agent = agent;
    if lane == 0u {
        episodes[slot] = episode;
    }
}
