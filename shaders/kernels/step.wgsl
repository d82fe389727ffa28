// Kernel `step`: one robot carries out one given action and senses.
//
// For `probe`, benchmarks and callers that decide for themselves.

@group(0) @binding(0) var<uniform> dispatch: Dispatch;
@group(0) @binding(1) var<uniform> world: WorldUniform;
@group(0) @binding(2) var<storage, read> tables: array<u32>;
@group(0) @binding(3) var<storage, read_write> robots: array<Robot>;

@compute @workgroup_size(LANES)
fn step(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let number = dispatch.first + group.x;
    var robot = robots[number];
    for (var iteration = 0u; iteration < dispatch.iterations; iteration++) {
        let key = vec2<u32>(robot.run_seed, robot.robot_seed);
        draw_step(lane, Stream(key, 0u, 0u, robot.step, PURPOSE_GIVEN));
        if robot.action != NO_ACTION {
            let slip =
                robot.noise.actuator * noise(robot.noise.kind, random[DRAW_ACTUATOR].x, random[DRAW_ACTUATOR].y) + 1.0f;
            let moved = move_body(lane, robot.x, robot.y, robot.heading, robot.action, slip);
            robot.x = moved.x;
            robot.y = moved.y;
            robot.heading = moved.heading;
            robot.bumpers = moved.bumpers;
            robot.events = moved.events;
        }
        observe(lane, robot.x, robot.y, robot.heading, robot.bumpers, robot.noise);
        robot.step += 1u;
    }
    if lane == 0u {
        for (var word = 0u; word < SONAR_WORDS; word++) {
            robot.sensed.sonar[word] = record[OBSERVATION_SONAR + word];
        }
        robot.sensed.light_bumpers = record[OBSERVATION_LIGHT_BUMPERS];
        robot.sensed.compass = bitcast<f32>(record[OBSERVATION_COMPASS]);
        robots[number] = robot;
    }
}
