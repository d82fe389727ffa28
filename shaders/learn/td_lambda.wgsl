// Backward replay with TD(lambda) (paper, section I).
//
// From the last step to the first: u_t = r_t + gamma [(1 - lambda) max_k Q(x_{t+1}, k) + lambda u_{t+1}], the
// bracket 0 at a goal. A step whose action the current policy would hardly take is not learned, and cuts
// the chain: there max Q stands for u. The form is recalled from Lin's other papers, so it is our choice.
//
// A skill over skills may learn at its decisions only: between them rewards are summed with their discount, and
// lambda mixes at decisions.

fn learner_stream(trial: u32, step: u32, purpose: u32) -> Stream {
    let s = params_base + state.skill;
    return Stream(vec2<u32>(params[s].run_seed, params[s].learner_seed), state.skill, trial, step, purpose);
}

// Word of the bank at which the learner's taught lesson `number` stands: one lesson drawn from each of
// `lessons` equal strata of the bank.
fn taught_lesson(number: u32) -> u32 {
    let skill = state.skill;
    let stratum = skills[skill].bank_lessons / params[params_base + skill].lessons;
    let word = draw(learner_stream(number, 0u, PURPOSE_LESSON), 0u).x;
    let index = number * stratum + below(word, stratum);
    return skills[skill].bank_offset + index * skills[skill].lesson_stride;
}

// Word of the memory at which a remembered lesson stands, its age drawn from an exponential
// distribution of mean `replay_mean_age`, cut off at the oldest.
fn recent_lesson(word: u32) -> u32 {
    let skill = state.skill;
    let s = params_base + skill;
    let kept = select(params[s].replay_capacity, state.remembered, state.remembered < params[s].replay_capacity);
    // The host sends the negative inverse of the mean age: kernels do not divide.
    let whole = 1.0f - exponential(params[s].replay_age_decay * f32(kept));
    let depth = -ln(1.0f - unit(word) * whole) * params[s].replay_mean_age;
    let drawn = u32(depth);
    let age = select(kept - 1u, drawn, drawn < kept);
    let slot = (state.remembered - 1u - age) % params[s].replay_capacity;
    return skills[skill].memory_offset + slot * skills[skill].lesson_stride;
}

fn lesson_word(offset: u32) -> u32 {
    let at = state.replay_lesson + offset;
    if state.replay_taught == 1u {
        return bank[at];
    }
    return lessons[lessons_base + at];
}

// Opens the replay of the lesson at word `lesson` of the bank (`taught` 1) or of the memory; `mirrored` 1 for what
// would have happened to the mirror image of the robot in the mirror image of the world.
fn begin_replay(lesson: u32, taught: u32, mirrored: u32) {
    let s = params_base + state.skill;
    state.replay_lesson = lesson;
    state.replay_taught = taught;
    state.replay_mirrored = mirrored * params[s].mirror_replays;
    let steps = lesson_word(LESSON_STEPS);
    let end = lesson_word(LESSON_END);
    state.replay += 1u;
    state.replay_left = steps;
    state.replay_open = u32(end == TRUNCATED && params[s].timeout_terminal == 0u);
    state.next_best = 0.0f;
    state.next_return = 0.0f;
}

fn load_step(lane: u32, step: u32) {
    let words = skills[state.skill].record_words;
    let at = LESSON_HEADER_WORDS + step * words;
    workgroupBarrier();
    if lane < words {
        record[lane] = lesson_word(at + lane);
    }
    workgroupBarrier();
}

fn mirror_mask(skill: u32, children: u32, mirrored: bool) -> u32 {
    var bits = 0u;
    for (var child = 0u; child < skills[skill].children; child++) {
        let image = select(child, skills[skill].mirror_child[child], mirrored);
        bits |= ((children >> child) & 1u) << image;
    }
    return bits;
}

fn clip(target_value: f32, limit: f32) -> f32 {
    let low = select(-limit, target_value, target_value > -limit);
    return select(limit, low, low < limit);
}

fn learn_between_decisions(step: u32) -> bool {
    let word = draw(learner_stream(state.trial, state.replay, PURPOSE_INNER), step).x;
    return unit(word) < params[params_base + state.skill].intra_skill_share;
}

// What the Q-value of the step at word `at` of the lesson in replay should be, given what follows it.
fn td_target(at: u32) -> f32 {
    let s = params_base + state.skill;
    let reward = bitcast<f32>(lesson_word(at + STEP_REWARD)) * params[s].value_scale;
    let future = (1.0f - params[s].lambda) * state.next_best + params[s].lambda * state.next_return;
    return clip(reward + params[s].gamma * future, params[s].target_clip);
}

fn replay_step(lane: u32) {
    let skill = state.skill;
    let s = params_base + skill;
    let open = state.replay_open == 1u;
    let step = select(state.replay_left - 1u, state.replay_left, open);
    let at = LESSON_HEADER_WORDS + step * skills[skill].record_words;
    let choice = lesson_word(at + STEP_CHOICE);
    let target_value = td_target(at);
    let inner = params[s].backup == BACKUP_DECISIONS && !choice_is_free(choice) && !open;
    if inner && !learn_between_decisions(step) {
        state.next_best = target_value;
        state.next_return = target_value;
        state.replay_left = step;
    } else {
        let mirrored = state.replay_mirrored == 1u;
        let done = choice_child(choice);
        let available = select(choice_allowed(choice), choice_offered(choice), params[s].backup == BACKUP_STEPS);
        let allowed = mirror_mask(skill, available, mirrored);
        load_step(lane, step);
        encode(lane, skill, mirrored);
        forward(lane, skill);
        let found = boltzmann(lane, skills[skill].children, allowed, inverse_temperature(skill, state.trial));
        if open {
            state.replay_open = 0u;
            state.next_best = found.best;
            state.next_return = found.best;
        } else {
            let child = select(done, skills[skill].mirror_child[done], mirrored);
            let taught = params[s].taught_as_policy == 1u && state.replay_taught == 1u;
            let policy = taught || weights[child] > params[s].policy_threshold * found.total;
            let stretched = found.best + params[s].advantage_scale * (target_value - found.best);
            let plain = params[s].advantage_scale == 1.0f;
            let aim = select(clip(stretched, params[s].target_clip), target_value, plain);
            let delta = aim - q[child];
            // Of all children: one that is never chosen again would not be found out otherwise.
            var sound = is_number(delta);
            for (var other = 0u; other < skills[skill].children; other++) {
                sound = sound && is_number(q[other]);
            }
            if !sound {
                // The place in the lesson stays: by it the transition is found.
                state.phase = PHASE_FAILED;
            } else {
                if policy {
                    backward(lane, skill, child, delta, learning_rate(skill, state.trial));
                    state.updates += 1u;
                }
                state.next_best = select(found.best, target_value, inner);
                state.next_return = select(found.best, target_value, policy || inner);
                state.replay_left = step;
            }
        }
    }
}

// Whether all weights of the skill in training are numbers.
fn weights_are_finite(lane: u32) -> bool {
    let skill = state.skill;
    var wild = 0u;
    for (var number = 0u; number < skills[skill].nets; number++) {
        let net = net_offset(skill, number);
        for (var row = 0u; row < skills[skill].rows; row++) {
            wild |= u32(!is_number(nets[net + row * LANES + lane]));
        }
    }
    return lanes_or(lane, wild) == 0u;
}
