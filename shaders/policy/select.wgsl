// Boltzmann exploration over the allowed children, and the greedy choice (paper, section V: "the robot
// chose actions randomly, but preferred to choose actions having high utilities").
//
// Sets of children are bits: bit c stands for child c.

const NO_CHILD: u32 = 255u;

var<workgroup> odds: array<f32, MAX_CHILDREN>;

struct Outlook {
    best: f32,
    greedy: u32,
    total: f32,
}

fn inverse_temperature(s: u32, trial: u32) -> f32 {
    let risen = select(params[s].inverse_temperature_trials, trial, trial < params[s].inverse_temperature_trials);
    return params[s].inverse_temperature_slope * f32(risen) + params[s].inverse_temperature_start;
}

fn weigh(lane: u32, children: u32, allowed: u32, inverse_temperature: f32) -> Outlook {
    var best = -2.0f;
    var greedy = 0u;
    for (var child = 0u; child < children; child++) {
        let value = q[child];
        let better = value > best && ((allowed >> child) & 1u) == 1u;
        best = select(best, value, better);
        greedy = select(greedy, child, better);
    }
    if lane < MAX_CHILDREN {
        let available = lane < children && ((allowed >> lane) & 1u) == 1u;
        let weight = exponential(inverse_temperature * (q[lane] - best));
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

fn choose(lane: u32, s: u32, children: u32, allowed: u32, inverse_temperature: f32, greedy: bool, word: u32) -> u32 {
    let even = params[s].policy != POLICY_LEARNED;
    let outlook = weigh(lane, children, allowed, select(inverse_temperature, 0.0f, even));
    let drawn = pick(outlook, word);
    let first = countTrailingZeros(allowed);
    let learned = select(drawn, outlook.greedy, greedy);
    let other = select(first, drawn, params[s].policy == POLICY_RANDOM);
    return select(learned, other, even);
}
