// Writing lessons and rows of the trial table.
//
// Word 8 of a record: child, then from bit 8 the masked child, from bit 16 the events. Word 9: the reward.

const ENDED: u32 = 1u;
const CUT: u32 = 2u;

fn note(lane: u32, child: u32, masked: u32, events: u32, reward: f32) {
    if lane == 0u {
        record[8] = child | (masked << 8u) | (events << 16u);
        record[9] = bitcast<u32>(reward);
    }
    workgroupBarrier();
}

fn write_record(lane: u32, lesson: u32, step: u32) {
    let at = lesson + LESSON_HEADER + step * RECORD_WORDS;
    if lane < RECORD_WORDS {
        lessons[at + lane] = record[lane];
    }
    // Other lanes replay what this lane wrote.
    storageBarrier();
    workgroupBarrier();
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
    let at = rows_base + cursor.rows * ROW_WORDS;
    let success = u32(end == ENDED);
    if lane == 0u {
        rows[at] = cursor.skill;
        rows[at + 1u] = trial;
        rows[at + 2u] = cursor.actions;
        rows[at + 3u] = steps;
        rows[at + 4u] = bitcast<u32>(reward);
        rows[at + 5u] = success;
        rows[at + 6u] = collisions;
        rows[at + 7u] = taught;
    }
    cursor.rows += 1u;
}
