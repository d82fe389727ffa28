// Kernel `probe`: the bits of the shipped arithmetic at given inputs, to be compared with Rust's.
//
// A question is 12 words, an answer 48. The shapes are those that compilers are known to fuse or to
// re-associate; each changes its bits on a good part of the inputs where that happens.

@group(0) @binding(0) var<storage, read> questions: array<u32>;
@group(0) @binding(1) var<storage, read_write> answers: array<u32>;

const QUESTION_WORDS: u32 = 12u;
const ANSWER_WORDS: u32 = 48u;

var<private> answer_base: u32;

fn put(place: u32, value: f32) {
    answers[answer_base + place] = bitcast<u32>(value);
}

fn functions(x: f32, p: f32, angle: f32, tiny: f32) {
    put(0u, flush(tiny));
    put(1u, exponential(x));
    put(2u, ln(p));
    put(3u, reciprocal(p));
    put(4u, reciprocal_sqrt(p));
    put(5u, square_root(p));
    put(6u, square_root(x));
    put(7u, tanh(x));
    let turn = sin_cos(angle);
    put(8u, turn.x);
    put(9u, turn.y);
    put(10u, wrap_degrees(angle - 360.0f));
}

fn integers(words: vec4<u32>, key: vec2<u32>) {
    let block = philox(words, key);
    answers[answer_base + 11u] = block.x;
    answers[answer_base + 12u] = block.y;
    answers[answer_base + 13u] = block.z;
    answers[answer_base + 14u] = block.w;
    answers[answer_base + 15u] = mul_high(words.x, words.y);
    answers[answer_base + 16u] = below(words.z, 1000u);
    put(17u, unit(words.w));
    put(18u, noise(0u, words.x, words.y));
    put(19u, noise(1u, words.x, words.y));
    put(20u, f32(words.x));
    put(21u, f32(i32(words.y)));
}

fn conversions(x: f32, a: f32) {
    answers[answer_base + 22u] = u32(abs(x) * 1000.0f);
    answers[answer_base + 23u] = bitcast<u32>(i32(x * 1000.0f));
    put(24u, select(a, -a, x < 0.0f));
}

fn shapes(a: f32, b: f32, c: f32, d: f32) {
    put(25u, a * b + c);
    put(26u, c - a * b);
    put(27u, (a - 1.1f) + 0.3f);
    put(28u, (1.1f - a) + 0.3f);
    put(29u, (1.1f + a * b) + 0.3f);
    put(30u, (a * 1.1f) * 0.7f);
    put(31u, ((a * 1.1f) * b) * 0.7f);
    put(32u, (a * b) * 0.7f);
    put(33u, (a + c) + 1.0f);
    put(34u, (c * (a * a) + a) + 1.0f);
    put(35u, (a + b) - a);
    put(36u, (a + 12582912.0f) - 12582912.0f);
    put(37u, a * b + a * c);
    put(38u, (1.0f - d) * a + d * b);
    put(39u, a + (c + 1.0f));
    put(40u, a * (b * 0.7f));
    var sum = a;
    for (var turn = 0u; turn < 8u; turn++) {
        sum = sum + b * c;
        sum = sum * d;
    }
    put(41u, sum);
    put(42u, dot_of(vec3<f32>(a, b, c), vec3<f32>(d, a, b)));
}

fn dot_of(u: vec3<f32>, v: vec3<f32>) -> f32 {
    return u.x * v.x + u.y * v.y + u.z * v.z;
}

fn lanes(lane: u32, x: f32, word: u32) {
    put(43u, lanes_min(lane, abs(x)));
    answers[answer_base + 44u] = lanes_or(lane, word & (1u << lane));
    partials[0][lane] = x;
    partials[1][lane] = x * x;
    lanes_sums(lane, 2u, LANES);
    put(45u, partials[0][0]);
    put(46u, partials[1][0]);
}

@compute @workgroup_size(LANES)
fn arithmetic_check(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = group.x * LANES + lane;
    let at = number * QUESTION_WORDS;
    answer_base = number * ANSWER_WORDS;
    let x = bitcast<f32>(questions[at]);
    let p = bitcast<f32>(questions[at + 1u]);
    let angle = bitcast<f32>(questions[at + 2u]);
    let tiny = bitcast<f32>(questions[at + 3u]);
    let a = bitcast<f32>(questions[at + 4u]);
    let b = bitcast<f32>(questions[at + 5u]);
    let c = bitcast<f32>(questions[at + 6u]);
    let d = bitcast<f32>(questions[at + 7u]);
    let words = vec4<u32>(questions[at + 8u], questions[at + 9u], questions[at + 10u], questions[at + 11u]);
    functions(x, p, angle, tiny);
    integers(words, words.zw);
    conversions(x, a);
    shapes(a, b, c, d);
    lanes(lane, x, words.x);
    put(47u, tiny * d);
}
