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

var<private> episode: Episode;

fn weights_offset(skill: u32, units: u32, net: u32) -> u32 {
    return net_offset(skill, net);
}

fn row_stride(units: u32) -> u32 {
    return LANES;
}

fn weight(at: u32) -> f32 {
    return nets[at];
}

fn test_stream(skill: u32, number: u32, step: u32, purpose: u32) -> Stream {
    let s = params_base + dispatch.test_skill;
    return Stream(vec2<u32>(params[s].run_seed, params[s].learner_seed), skill, number, step, purpose);
}

// Puts the robot at the start of test trial `number`.
fn begin(number: u32) {
    let skill = dispatch.test_skill;
    let words = draw(test_stream(skill, number, 0u, PURPOSE_TEST_START), 0u);
    let pose = start_pose(skills[skill].tests_offset, skills[skill].tests_count, words);
    reset(pose);
    episode.state = EPISODE_RUNNING;
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
    nets_base = learner * dispatch.nets_stride;
    let root = dispatch.test_skill;
    let s = params_base + root;
    if episode.state == EPISODE_FRESH {
        begin(number);
    }
    for (var iteration = 0u; iteration < dispatch.iterations; iteration++) {
        if episode.state != EPISODE_RUNNING {
            break;
        }
        draw_step(lane, test_stream(root | (dispatch.test_number << 8u), number, agent.step, PURPOSE_TEST));
        observe_and_score(lane, root);
        let achieved = (skill_events(root) & skills[root].ends) != 0u;
        if achieved || agent.step >= params[s].max_steps {
            episode.state = select(EPISODE_TRUNCATED, EPISODE_TERMINATED, achieved);
        } else {
            value_children(lane, root);
            q_values(lane, root);
            let choices = action_mask(root, params[s].persist_tests == 1u);
            let child = choose(lane, root, choices.allowed, 1.0f, true, random[DRAW_CHOICE].x);
            commit(root, child, choices);
            let action = descend_to_action(lane, root, child);
            apply_action(lane, root, action);
        }
    }
    episode.agent = agent;
    if lane == 0u {
        episodes[slot] = episode;
    }
}
