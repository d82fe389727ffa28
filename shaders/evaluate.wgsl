// Kernel `evaluate`: moves a greedy test trial on by a number of steps. The nets are read only.
//
// Every test of a learner begins from the same starts; the noise differs from test to test.

@group(0) @binding(0) var<uniform> dispatch: Dispatch;
@group(0) @binding(1) var<uniform> world: WorldPlan;
@group(0) @binding(2) var<storage, read> atlas: array<u32>;
@group(0) @binding(3) var<storage, read> skills: array<SkillPlan>;
@group(0) @binding(4) var<storage, read> settings: array<Settings>;
@group(0) @binding(5) var<storage, read> nets: array<f32>;
@group(0) @binding(6) var<storage, read_write> episodes: array<Episode>;

const STATE_FRESH: u32 = 0u;
const STATE_RUNNING: u32 = 1u;
const STATE_ACHIEVED: u32 = 2u;
const STATE_CUT: u32 = 3u;

var<private> episode: Episode;

fn begin(s: u32, number: u32) {
    let skill = dispatch.test_skill;
    let key = vec2<u32>(settings[s].run_seed, settings[s].learner_seed);
    let stream = Stream(key, dispatch.test_skill, number, 0u, PURPOSE_TEST_START);
    let pose = start_pose(skills[skill].tests_offset, skills[skill].tests_count, draw(stream, 0u));
    episode.x = pose.x;
    episode.y = pose.y;
    episode.heading = pose.heading;
    episode.bumpers = 0u;
    episode.step = 0u;
    episode.masked = NO_ACTION;
    episode.origin = room_of(pose.x, pose.y);
    episode.state = STATE_RUNNING;
    episode.reward = 0.0f;
    episode.collisions = 0u;
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
    let skill = dispatch.test_skill;
    let s = learner * dispatch.skills + skill;
    let terms = noise_of(s);
    let base = learner * dispatch.nets_stride;
    if episode.state == STATE_FRESH {
        begin(s, number);
    }
    for (var quantum = 0u; quantum < dispatch.quanta; quantum++) {
        if episode.state != STATE_RUNNING {
            break;
        }
        let key = vec2<u32>(settings[s].run_seed, settings[s].learner_seed);
        let stream = Stream(key, skill | (dispatch.test_number << 8u), number, episode.step, PURPOSE_TEST);
        roll(lane, stream);
        observe(lane, episode.x, episode.y, episode.heading, episode.bumpers, terms);
        encode(lane, skill);
        forward(lane, skill, base);
        let outlook = weigh(lane, skills[skill].children, episode.masked, 1.0f);
        let child = outlook.greedy;
        let slip = terms.actuator * noise(terms.kind, dice[DICE_ACTUATOR].x, dice[DICE_ACTUATOR].y) + 1.0f;
        let action = skills[skill].action[child];
        let moved = move_body(lane, episode.x, episode.y, episode.heading, action, slip);
        let events = moved.events | passed_door(episode.origin, moved.x, moved.y);
        let hit = (events & COLLISION) == COLLISION;
        episode.x = moved.x;
        episode.y = moved.y;
        episode.heading = moved.heading;
        episode.bumpers = moved.bumpers;
        episode.masked = select(NO_ACTION, child, hit && settings[s].mask_blocked == 1u);
        episode.step += 1u;
        episode.reward = episode.reward + reward_of(s, events);
        episode.collisions += u32(hit);
        let achieved = (events & skills[skill].ends) != 0u;
        let cut = select(STATE_RUNNING, STATE_CUT, episode.step >= settings[s].max_steps);
        episode.state = select(cut, STATE_ACHIEVED, achieved);
    }
    if lane == 0u {
        episodes[slot] = episode;
    }
}
