// Boltzmann exploration over the available children, and the greedy choice (paper, section V: "the robot
// chose actions randomly, but preferred to choose actions having high utilities").

var<workgroup> odds: array<f32, MAX_CHILDREN>;

struct Outlook {
    best: f32,
    greedy: u32,
    total: f32,
}

fn sharpness(s: u32, trial: u32) -> f32 {
    let risen = select(settings[s].sharpness_trials, trial, trial < settings[s].sharpness_trials);
    return settings[s].sharpness_slope * f32(risen) + settings[s].sharpness_start;
}

fn weigh(lane: u32, children: u32, masked: u32, sharpness: f32) -> Outlook {
    var best = -2.0f;
    var greedy = 0u;
    for (var child = 0u; child < children; child++) {
        let value = q[child];
        // A lone child is always available.
        let better = value > best && (child != masked || children == 1u);
        best = select(best, value, better);
        greedy = select(greedy, child, better);
    }
    if lane < MAX_CHILDREN {
        let available = lane < children && (lane != masked || children == 1u);
        let weight = exponential(sharpness * (q[lane] - best));
        odds[lane] = select(0.0f, weight, available);
    }
    workgroupBarrier();
    var total = odds[0];
    for (var child = 1u; child < MAX_CHILDREN; child++) {
        total = total + odds[child];
    }
    return Outlook(best, greedy, total);
}

fn pick(outlook: Outlook, word: u32) -> u32 {
    let mark = unit(word) * outlook.total;
    var sum = 0.0f;
    var chosen = outlook.greedy;
    var open = true;
    for (var child = 0u; child < MAX_CHILDREN; child++) {
        sum = sum + odds[child];
        let here = open && mark < sum;
        chosen = select(chosen, child, here);
        open = open && !here;
    }
    return chosen;
}
