// Writing lessons and rows of the trial table.
//
// Word 8 of a record: child, from bit 8 the children that were allowed, from bit 16 those among which a free
// choice is made, from bit 24 the events, and bit 31 where the choice was free. Word 9: the reward. Events and
// reward are written one step later, by the look that settles them.

const ENDED: u32 = 1u;
const CUT: u32 = 2u;

fn note(lane: u32, child: u32, options: Options) {
    if lane == 0u {
        record[8] = child | (options.allowed << 8u) | (options.choices << 16u) | (options.decision << DECISION_BIT);
        record[9] = 0u;
    }
    workgroupBarrier();
}

fn write_record(lane: u32, words: u32, lesson: u32, step: u32) {
    let at = lesson + LESSON_HEADER + step * words;
    if lane < words {
        lessons[at + lane] = record[lane];
    }
    // Other lanes replay what this lane wrote.
    storageBarrier();
    workgroupBarrier();
}

// `write_record`, which follows within the same step, makes this known to the other lanes.
fn write_outcome(lane: u32, words: u32, lesson: u32, step: u32, events: u32, earned: f32) {
    let at = lesson + LESSON_HEADER + step * words;
    if lane == 0u {
        lessons[at + 8u] |= events << EVENTS_FROM;
        lessons[at + 9u] = bitcast<u32>(earned);
    }
}

fn write_header(lane: u32, lesson: u32, steps: u32, end: u32, reward: f32, collisions: u32) {
    if lane == 0u {
        lessons[lesson] = steps;
        lessons[lesson + 1u] = end;
        lessons[lesson + 2u] = bitcast<u32>(reward);
        lessons[lesson + 3u] = collisions;
    }
    storageBarrier();
    workgroupBarrier();
}

fn write_row(lane: u32, trial: u32, steps: u32, reward: f32, end: u32, collisions: u32, taught: u32) {
    let at = rows_base + state.rows * ROW_WORDS;
    let success = u32(end == ENDED);
    if lane == 0u {
        rows[at] = state.skill;
        rows[at + 1u] = trial;
        rows[at + 2u] = state.actions;
        rows[at + 3u] = steps;
        rows[at + 4u] = bitcast<u32>(reward);
        rows[at + 5u] = success;
        rows[at + 6u] = collisions;
        rows[at + 7u] = taught;
    }
    state.rows += 1u;
}
