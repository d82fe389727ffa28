// Backward replay with TD(lambda) (paper, section I).
//
// From the last step to the first: u_t = r_t + gamma [(1 - lambda) max_k Q(x_{t+1}, k) + lambda u_{t+1}], the
// bracket 0 at a goal. A step whose action the current policy would hardly take is not learned, and cuts
// the chain: there max Q stands for u. The form is recalled from Lin's other papers, so it is our choice.
//
// A skill over skills may learn at its decisions only: between them rewards are summed with their discount, and
// lambda mixes at decisions.

const BACKUP_STEPS: u32 = 0u;
const BACKUP_DECISIONS: u32 = 2u;

fn taught_lesson(s: u32, number: u32) -> u32 {
    let skill = cursor.skill;
    let key = vec2<u32>(settings[s].run_seed, settings[s].learner_seed);
    let stream = Stream(key, cursor.skill, number, 0u, PURPOSE_LESSON);
    let stratum = skills[skill].bank_lessons / settings[s].lessons;
    let index = number * stratum + below(draw(stream, 0u).x, stratum);
    return skills[skill].bank_offset + index * skills[skill].lesson_stride;
}

fn recent_lesson(s: u32, word: u32) -> u32 {
    let skill = cursor.skill;
    let kept = select(settings[s].memory, cursor.remembered, cursor.remembered < settings[s].memory);
    // The host sends the negative inverse of the mean age: kernels do not divide.
    let whole = 1.0f - exponential(settings[s].age_decay * f32(kept));
    let depth = -ln(1.0f - unit(word) * whole) * settings[s].mean_age;
    let drawn = u32(depth);
    let age = select(kept - 1u, drawn, drawn < kept);
    let slot = (cursor.remembered - 1u - age) % settings[s].memory;
    return skills[skill].memory_offset + slot * skills[skill].lesson_stride;
}

fn lesson_word(offset: u32) -> u32 {
    let at = cursor.replay_lesson + offset;
    if cursor.replay_taught == 1u {
        return bank[at];
    }
    return lessons[lessons_base + at];
}

fn begin_replay(s: u32, lesson: u32, taught: u32, mirrored: u32) {
    cursor.replay_lesson = lesson;
    cursor.replay_taught = taught;
    cursor.replay_mirrored = mirrored * settings[s].mirror_replays;
    let steps = lesson_word(0u);
    let end = lesson_word(1u);
    cursor.replay += 1u;
    cursor.replay_left = steps;
    cursor.replay_open = u32(end == CUT && settings[s].timeout_terminal == 0u);
    cursor.next_best = 0.0f;
    cursor.next_return = 0.0f;
}

fn load_record(lane: u32, step: u32) {
    let words = skills[cursor.skill].record_words;
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
    let key = vec2<u32>(settings[s].run_seed, settings[s].learner_seed);
    let stream = Stream(key, cursor.skill, cursor.trial, cursor.replay, PURPOSE_INNER);
    return unit(draw(stream, step).x) < settings[s].inner_share;
}

fn aimed(s: u32, at: u32) -> f32 {
    let reward = bitcast<f32>(lesson_word(at + 9u)) * settings[s].value_scale;
    let future = (1.0f - settings[s].lambda) * cursor.next_best + settings[s].lambda * cursor.next_return;
    return bounded(reward + settings[s].gamma * future, settings[s].target_limit);
}

fn replay_step(lane: u32, s: u32, base: u32) {
    let skill = cursor.skill;
    let open = cursor.replay_open == 1u;
    let step = select(cursor.replay_left - 1u, cursor.replay_left, open);
    let at = LESSON_HEADER + step * skills[skill].record_words;
    let marks = lesson_word(at + 8u);
    let aim = aimed(s, at);
    let inner = settings[s].backup == BACKUP_DECISIONS && (marks >> 31u) == 0u && !open;
    if inner && !inner_drawn(s, step) {
        cursor.next_best = aim;
        cursor.next_return = aim;
        cursor.replay_left = step;
    } else {
        let mirrored = cursor.replay_mirrored == 1u;
        let done = marks & 0xffu;
        let choices = (marks >> 16u) & 0xffu;
        let offered = select((marks >> 8u) & 0xffu, choices, settings[s].backup == BACKUP_STEPS);
        let allowed = reflected(skill, offered, mirrored);
        load_record(lane, step);
        encode(lane, skill, mirrored);
        forward(lane, skill, s, base);
        let outlook = weigh(lane, skills[skill].children, allowed, sharpness(s, cursor.trial));
        if open {
            cursor.replay_open = 0u;
            cursor.next_best = outlook.best;
            cursor.next_return = outlook.best;
        } else {
            let child = select(done, skills[skill].mirror_child[done], mirrored);
            let taught = settings[s].taught_always == 1u && cursor.replay_taught == 1u;
            let policy = taught || odds[child] > settings[s].policy_threshold * outlook.total;
            let stretched = outlook.best + settings[s].advantage_scale * (aim - outlook.best);
            let plain = settings[s].advantage_scale == 1.0f;
            let goal = select(bounded(stretched, settings[s].target_limit), aim, plain);
            let delta = goal - q[child];
            // Of all children: one that is never chosen again would not be found out otherwise.
            var sound = is_number(delta);
            for (var other = 0u; other < skills[skill].children; other++) {
                sound = sound && is_number(q[other]);
            }
            if !sound {
                // The place in the lesson stays: by it the transition is found.
                cursor.phase = PHASE_FAILED;
            } else {
                if policy {
                    let pace = learning_rate(s, cursor.trial);
                    backward(lane, skill, s, base, child, delta, pace);
                    cursor.updates += 1u;
                }
                cursor.next_best = select(outlook.best, aim, inner);
                cursor.next_return = select(outlook.best, aim, policy || inner);
                cursor.replay_left = step;
            }
        }
    }
}

fn sound_weights(lane: u32, base: u32) -> bool {
    let skill = cursor.skill;
    var wild = 0u;
    for (var number = 0u; number < skills[skill].nets; number++) {
        let net = net_of(skill, base, number);
        for (var row = 0u; row < skills[skill].rows; row++) {
            wild |= u32(!is_number(nets[net + row * LANES + lane]));
        }
    }
    return lanes_or(lane, wild) == 0u;
}
