// Counter-based random numbers: Philox4x32-10 (Salmon et al., SC 2011).
//
// A draw is a pure function of (run seed, learner seed, trial, step, purpose, draw). Nothing is stored,
// so no draw depends on where, when or beside whom a learner runs.

struct Stream {
    key: vec2<u32>,
    skill: u32,
    trial: u32,
    step: u32,
    purpose: u32,
}

// WGSL has no 64-bit product: four 16-bit ones.
fn mul_high(a: u32, b: u32) -> u32 {
    let al = a & 0xffffu;
    let ah = a >> 16u;
    let bl = b & 0xffffu;
    let bh = b >> 16u;
    let low = al * bl;
    let cross = ah * bl + (low >> 16u);
    let middle = al * bh + (cross & 0xffffu);
    return ah * bh + (cross >> 16u) + (middle >> 16u);
}

fn philox(counter: vec4<u32>, key: vec2<u32>) -> vec4<u32> {
    var c = counter;
    var k = key;
    for (var round = 0u; round < 10u; round++) {
        let high0 = mul_high(0xd2511f53u, c.x);
        let low0 = 0xd2511f53u * c.x;
        let high1 = mul_high(0xcd9e8d57u, c.z);
        let low1 = 0xcd9e8d57u * c.z;
        c = vec4<u32>(high1 ^ c.y ^ k.x, low1, high0 ^ c.w ^ k.y, low0);
        k = k + vec2<u32>(0x9e3779b9u, 0xbb67ae85u);
    }
    return c;
}

fn draw(stream: Stream, draw: u32) -> vec4<u32> {
    return philox(vec4<u32>(stream.trial, stream.step, (stream.purpose << 16u) | draw, stream.skill), stream.key);
}

// The random words of one primitive step: entry `i` holds draw number `i`. Rays share the first six draws, a word
// each, and so do the light's bearings theirs. The rest is named in `env/observe`.
var<workgroup> random: array<vec4<u32>, LANES>;

fn draw_step(lane: u32, stream: Stream) {
    workgroupBarrier();
    random[lane] = draw(stream, lane);
    workgroupBarrier();
}

// The word of bearing `b`, whose six draws begin with number `first`: word `b` / 6 of draw `b` % 6.
fn bearing_word(first: u32, b: u32) -> u32 {
    return random[first + b % 6u][b / 6u];
}

fn unit(word: u32) -> f32 {
    return f32(word >> 8u) * 5.9604645e-8f;
}

fn below(word: u32, n: u32) -> u32 {
    return mul_high(word, n);
}

fn noise(kind: u32, first: u32, second: u32) -> f32 {
    let sum = (first & 0xffffu) + (first >> 16u) + (second & 0xffffu) + (second >> 16u);
    let bell = f32(i32(sum) - 131070) * 2.64290e-5f;
    let flat = f32(i32(first & 0xffffu) * 2 - 65535) * 1.5259022e-5f;
    return select(flat, bell, kind == 0u);
}

// `noise` from one word, on a coarser grid: four 8-bit uniforms summed, or 16 bits.
fn coarse_noise(kind: u32, word: u32) -> f32 {
    let pairs = (word & 0x00ff00ffu) + ((word >> 8u) & 0x00ff00ffu);
    let sum = (pairs & 0xffffu) + (pairs >> 16u);
    let bell = f32(i32(sum) - 510) * 6.765875e-3f;
    let flat = f32(i32(word & 0xffffu) * 2 - 65535) * 1.5259022e-5f;
    return select(flat, bell, kind == 0u);
}
