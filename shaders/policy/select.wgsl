// Boltzmann exploration over the allowed children, and the greedy choice (paper, section V: "the robot
// chose actions randomly, but preferred to choose actions having high utilities").
//
// Sets of children are bits: bit c stands for child c.

// Boltzmann weight of every child, 0 where it is not available.
var<workgroup> weights: array<f32, MAX_CHILDREN>;

fn inverse_temperature(skill: u32, trial: u32) -> f32 {
    let s = params_base + skill;
    let risen = select(params[s].inverse_temperature_trials, trial, trial < params[s].inverse_temperature_trials);
    return params[s].inverse_temperature_slope * f32(risen) + params[s].inverse_temperature_start;
}

fn boltzmann(lane: u32, children: u32, allowed: u32, inverse_temperature: f32) -> Boltzmann {
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
        weights[lane] = select(0.0f, weight, available);
    }
    workgroupBarrier();
    var total = weights[0];
    for (var child = 1u; child < MAX_CHILDREN; child++) {
        total = total + weights[child];
    }
    return Boltzmann(best, greedy, total);
}

fn sample(found: Boltzmann, word: u32) -> u32 {
    let mark = unit(word) * found.total;
    var sum = 0.0f;
    var chosen = found.greedy;
    var open = true;
    for (var child = 0u; child < MAX_CHILDREN; child++) {
        sum = sum + weights[child];
        let here = open && mark < sum;
        chosen = select(chosen, child, here);
        open = open && !here;
    }
    return chosen;
}

fn choose(lane: u32, skill: u32, allowed: u32, inverse_temperature: f32, greedy: bool, word: u32) -> u32 {
    let choice = params[params_base + skill].policy;
    let even = choice != POLICY_LEARNED;
    let found = boltzmann(lane, skills[skill].children, allowed, select(inverse_temperature, 0.0f, even));
    let drawn = sample(found, word);
    let first = countTrailingZeros(allowed);
    let learned = select(drawn, found.greedy, greedy);
    let other = select(first, drawn, choice == POLICY_RANDOM);
    return select(learned, other, even);
}
