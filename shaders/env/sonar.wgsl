// The rotating sonar: 24 single rays from the centre, 0 to 127 inches (paper, section III).
//
// Lanes are the segments of the cell's list, then rays. A ray and the opposite one are on the same line; the line
// crosses a segment where its two ends lie on different sides of it. Of all crossings the closest counts: closeness,
// 1 / distance, is linear in the direction of the ray, and all that depends on the segment alone is worked out once.

const READINGS_PER_DEGREE: f32 = 0.06666667f;
const SONAR_LIMIT: f32 = 127.0f;
const INVERSE_LIMIT: f32 = 0.007874016f;
const SLIVER: f32 = 1.0e-4f;
const LINES: u32 = RAYS / 2u;

// The segments of which rays are being cast at: their ends, and the closeness that they have straight ahead.
var<workgroup> ends: array<vec4<f32>, LANES>;
var<workgroup> slopes: array<vec2<f32>, LANES>;

// Direction of the lane's line: of its ray, or of the opposite one from ray 12 on.
fn line_direction(lane: u32, cosine: f32, sine: f32) -> vec2<f32> {
    let ray = sin_cos(f32(lane % LINES) * 15.0f);
    let ux = cosine * ray.y - sine * ray.x;
    let uy = sine * ray.y + cosine * ray.x;
    return vec2<f32>(ux, uy);
}

// Where a line from the origin along (`ux`, `uy`) crosses a segment from (`ax`, `ay`) to (`bx`, `by`), whose
// direction is (`dx`, `dy`): the distance is `over` / `under`, in lengths of (`ux`, `uy`). `over` is negative
// where the line does not cross.
fn crossing(ax: f32, ay: f32, bx: f32, by: f32, dx: f32, dy: f32, ux: f32, uy: f32) -> vec2<f32> {
    // Sides come from the ends alone, so a ray cannot slip between two segments that share one.
    let side_a = ax * uy - ay * ux;
    let side_b = bx * uy - by * ux;
    let crosses = (side_a > 0.0f) != (side_b > 0.0f);
    let over = ax * dy - ay * dx;
    let under = ux * dy - uy * dx;
    let over_signed = select(over, -over, under < 0.0f);
    return vec2<f32>(select(-1.0f, over_signed, crosses), abs(under));
}

fn ranges(lane: u32, x: f32, y: f32, ux: f32, uy: f32) -> f32 {
    let column = min(u32(x * CELLS_PER_INCH), world.cell_columns - 1u);
    let row = min(u32(y * CELLS_PER_INCH), world.cell_rows - 1u);
    let cell = world.cell_starts + row * world.cell_columns + column;
    let first = tables[cell];
    let end = tables[cell + 1u];
    var closest = INVERSE_LIMIT;
    for (var block = first; block < end; block += LANES) {
        workgroupBarrier();
        if block + lane < end {
            let i = tables[block + lane];
            let ax = world.segment[i].ax - x;
            let ay = world.segment[i].ay - y;
            let bx = world.segment[i].bx - x;
            let by = world.segment[i].by - y;
            let dx = world.segment[i].bx - world.segment[i].ax;
            let dy = world.segment[i].by - world.segment[i].ay;
            let over = ax * dy - ay * dx;
            let least = SLIVER * world.segment[i].length;
            let held = select(least, abs(over), abs(over) > least);
            let inverse = reciprocal(held);
            let signed = select(inverse, -inverse, over < 0.0f);
            ends[lane] = vec4<f32>(ax, ay, bx, by);
            slopes[lane] = vec2<f32>(dy * signed, dx * signed);
        }
        workgroupBarrier();
        for (var n = 0u; n < min(end - block, LANES); n++) {
            let side_a = ends[n].x * uy > ends[n].y * ux;
            let side_b = ends[n].z * uy > ends[n].w * ux;
            let closeness = ux * slopes[n].x - uy * slopes[n].y;
            let facing = select(closeness, -closeness, lane >= LINES);
            let seen = select(0.0f, facing, side_a != side_b);
            closest = select(closest, seen, seen > closest);
        }
    }
    return reciprocal(closest);
}

fn sonar_reading(range: f32, error: f32) -> u32 {
    let noisy = range * error;
    let low = select(0.0f, noisy, noisy > 0.0f);
    let bounded = select(SONAR_LIMIT, low, low < SONAR_LIMIT);
    // Beyond 2^23 f32 holds whole numbers only: the sum is rounded to one, which its lowest bits then are.
    return bitcast<u32>(bounded + 8388608.0f) & 0x7fu;
}
