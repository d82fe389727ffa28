// Writing lessons and rows of the trial table.
//
// The choice of a step is one word: the child, from bit 8 the children that were allowed, from bit 16 those among which
// a free choice is made, from bit 24 the events, and bit 31 where the choice was free. Events and reward are written one
// step later, by the observation that settles them.

fn choice_word(child: u32, choices: Choices) -> u32 {
    return child | (choices.allowed << 8u) | (choices.offered << 16u) | (choices.decision << DECISION_BIT);
}

fn choice_child(word: u32) -> u32 {
    return word & 0xffu;
}

fn choice_allowed(word: u32) -> u32 {
    return (word >> 8u) & 0xffu;
}

fn choice_offered(word: u32) -> u32 {
    return (word >> 16u) & 0xffu;
}

fn choice_is_free(word: u32) -> bool {
    return (word >> DECISION_BIT) != 0u;
}

fn set_choice(lane: u32, child: u32, choices: Choices) {
    if lane == 0u {
        record[STEP_CHOICE] = choice_word(child, choices);
        record[STEP_REWARD] = 0u;
    }
    workgroupBarrier();
}

fn write_step(lane: u32, words: u32, lesson: u32, step: u32) {
    let at = lesson + LESSON_HEADER_WORDS + step * words;
    if lane < words {
        lessons[at + lane] = record[lane];
    }
    // Other lanes replay what this lane wrote.
    storageBarrier();
    workgroupBarrier();
}

// `write_step`, which follows within the same step, makes this known to the other lanes.
fn write_outcome(lane: u32, words: u32, lesson: u32, step: u32, events: u32, earned: f32) {
    let at = lesson + LESSON_HEADER_WORDS + step * words;
    if lane == 0u {
        lessons[at + STEP_CHOICE] |= (events & RECORDED_EVENTS) << EVENTS_FROM;
        lessons[at + STEP_REWARD] = bitcast<u32>(earned);
    }
}

fn write_header(lane: u32, lesson: u32, steps: u32, end: u32, reward: f32, collisions: u32) {
    if lane == 0u {
        lessons[lesson + LESSON_STEPS] = steps;
        lessons[lesson + LESSON_END] = end;
        lessons[lesson + LESSON_REWARD] = bitcast<u32>(reward);
        lessons[lesson + LESSON_COLLISIONS] = collisions;
    }
    storageBarrier();
    workgroupBarrier();
}

fn write_row(lane: u32, trial: u32, steps: u32, reward: f32, end: u32, collisions: u32, taught: u32) {
    let success = u32(end == TERMINATED);
    if lane == 0u {
        rows[rows_base + state.rows] =
            TrialRecord(state.skill, trial, state.actions, steps, reward, success, collisions, taught);
    }
    state.rows += 1u;
}
