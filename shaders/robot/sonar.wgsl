// The rotating sonar: 24 single rays from the centre, 0 to 127 inches (paper, section III).
//
// Lanes are rays. A ray crosses a segment where its two ends lie on different sides of the ray; the
// distance is a ratio, and ratios are compared by cross-multiplying, so that one reciprocal is enough.

const SONAR_LIMIT: f32 = 127.0f;
const CELLS_PER_INCH: f32 = 0.083333336f;

fn rays(lane: u32, cosine: f32, sine: f32) -> vec2<f32> {
    let ray = sin_cos(f32(lane) * 15.0f);
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

fn ranges(x: f32, y: f32, ux: f32, uy: f32) -> f32 {
    let column = min(u32(x * CELLS_PER_INCH), world.cell_columns - 1u);
    let row = min(u32(y * CELLS_PER_INCH), world.cell_rows - 1u);
    let cell = world.cell_starts + row * world.cell_columns + column;
    let first = atlas[cell];
    let end = atlas[cell + 1u];
    var best_over = SONAR_LIMIT;
    var best_under = 1.0f;
    for (var entry = first; entry < end; entry++) {
        let i = atlas[entry];
        let ax = world.segment[i].ax - x;
        let ay = world.segment[i].ay - y;
        let bx = world.segment[i].bx - x;
        let by = world.segment[i].by - y;
        let dx = world.segment[i].bx - world.segment[i].ax;
        let dy = world.segment[i].by - world.segment[i].ay;
        let at = crossing(ax, ay, bx, by, dx, dy, ux, uy);
        let hit = at.x >= 0.0f && at.x * best_under < best_over * at.y;
        best_over = select(best_over, at.x, hit);
        best_under = select(best_under, at.y, hit);
    }
    return best_over * reciprocal(best_under);
}

fn reading(range: f32, error: f32) -> u32 {
    let noisy = range * error;
    let low = select(0.0f, noisy, noisy > 0.0f);
    let bounded = select(SONAR_LIMIT, low, low < SONAR_LIMIT);
    return u32(bounded + 0.5f);
}
