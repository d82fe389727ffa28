// Backward replay with TD(lambda) (paper, section I).
//
// From the last step to the first: u_t = r_t + gamma [(1 - lambda) max_k Q(x_{t+1}, k) + lambda u_{t+1}], the
// bracket 0 at a goal. A step whose action the current policy would hardly take is not learned, and cuts
// the chain: there max Q stands for u. The form is recalled from Lin's other papers, so it is our choice.
//
// A skill over skills may learn at its decisions only: between them rewards are summed with their discount, and
// lambda mixes at decisions.

fn taught_lesson(s: u32, number: u32) -> u32 {
    let skill = state.skill;
    let key = vec2<u32>(params[s].run_seed, params[s].learner_seed);
    let stream = Stream(key, state.skill, number, 0u, PURPOSE_LESSON);
    let stratum = skills[skill].bank_lessons / params[s].lessons;
    let index = number * stratum + below(draw(stream, 0u).x, stratum);
    return skills[skill].bank_offset + index * skills[skill].lesson_stride;
}

fn recent_lesson(s: u32, word: u32) -> u32 {
    let skill = state.skill;
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

fn begin_replay(s: u32, lesson: u32, taught: u32, mirrored: u32) {
    state.replay_lesson = lesson;
    state.replay_taught = taught;
    state.replay_mirrored = mirrored * params[s].mirror_replays;
    let steps = lesson_word(0u);
    let end = lesson_word(1u);
    state.replay += 1u;
    state.replay_left = steps;
    state.replay_open = u32(end == CUT && params[s].timeout_terminal == 0u);
    state.next_best = 0.0f;
    state.next_return = 0.0f;
}

fn load_record(lane: u32, step: u32) {
    let words = skills[state.skill].record_words;
    let offset = LESSON_HEADER + step * words;
    workgroupBarrier();
    if lane < words {
        record[lane] = lesson_word(offset + lane);
    }
    workgroupBarrier();
}

fn reflected(skill: u32, children: u32, mirrored: bool) -> u32 {
    var bits = 0u;
    for (var child = 0u; child < skills[skill].children; child++) {
        let image = select(child, skills[skill].mirror_child[child], mirrored);
        bits |= ((children >> child) & 1u) << image;
    }
    return bits;
}

fn bounded(aim: f32, limit: f32) -> f32 {
    let low = select(-limit, aim, aim > -limit);
    return select(limit, low, low < limit);
}

fn inner_drawn(s: u32, step: u32) -> bool {
    let key = vec2<u32>(params[s].run_seed, params[s].learner_seed);
    let stream = Stream(key, state.skill, state.trial, state.replay, PURPOSE_INNER);
    return unit(draw(stream, step).x) < params[s].intra_skill_share;
}

fn aimed(s: u32, at: u32) -> f32 {
    let reward = bitcast<f32>(lesson_word(at + 9u)) * params[s].value_scale;
    let future = (1.0f - params[s].lambda) * state.next_best + params[s].lambda * state.next_return;
    return bounded(reward + params[s].gamma * future, params[s].target_clip);
}

fn replay_step(lane: u32, s: u32, base: u32) {
    let skill = state.skill;
    let open = state.replay_open == 1u;
    let step = select(state.replay_left - 1u, state.replay_left, open);
    let at = LESSON_HEADER + step * skills[skill].record_words;
    let marks = lesson_word(at + 8u);
    let aim = aimed(s, at);
    let inner = params[s].backup == BACKUP_DECISIONS && (marks >> 31u) == 0u && !open;
    if inner && !inner_drawn(s, step) {
        state.next_best = aim;
        state.next_return = aim;
        state.replay_left = step;
    } else {
        let mirrored = state.replay_mirrored == 1u;
        let done = marks & 0xffu;
        let choices = (marks >> 16u) & 0xffu;
        let offered = select((marks >> 8u) & 0xffu, choices, params[s].backup == BACKUP_STEPS);
        let allowed = reflected(skill, offered, mirrored);
        load_record(lane, step);
        encode(lane, skill, mirrored);
        forward(lane, skill, s, base);
        let outlook = weigh(lane, skills[skill].children, allowed, inverse_temperature(s, state.trial));
        if open {
            state.replay_open = 0u;
            state.next_best = outlook.best;
            state.next_return = outlook.best;
        } else {
            let child = select(done, skills[skill].mirror_child[done], mirrored);
            let taught = params[s].taught_as_policy == 1u && state.replay_taught == 1u;
            let policy = taught || odds[child] > params[s].policy_threshold * outlook.total;
            let stretched = outlook.best + params[s].advantage_scale * (aim - outlook.best);
            let plain = params[s].advantage_scale == 1.0f;
            let goal = select(bounded(stretched, params[s].target_clip), aim, plain);
            let delta = goal - q[child];
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
                    let pace = learning_rate(s, state.trial);
                    backward(lane, skill, s, base, child, delta, pace);
                    state.updates += 1u;
                }
                state.next_best = select(outlook.best, aim, inner);
                state.next_return = select(outlook.best, aim, policy || inner);
                state.replay_left = step;
            }
        }
    }
}

fn sound_weights(lane: u32, base: u32) -> bool {
    let skill = state.skill;
    var wild = 0u;
    for (var number = 0u; number < skills[skill].nets; number++) {
        let net = net_of(skill, base, number);
        for (var row = 0u; row < skills[skill].rows; row++) {
            wild |= u32(!is_number(nets[net + row * LANES + lane]));
        }
    }
    return lanes_or(lane, wild) == 0u;
}
