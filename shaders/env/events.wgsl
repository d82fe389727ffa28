// What an action brought about, and what that earns.

const NOWHERE: u32 = 255u;
const SIDE_FIRST: u32 = 2u;
const SIDE_LAST: u32 = 10u;

fn room_of(x: f32, y: f32) -> u32 {
    var found = NOWHERE;
    for (var room = 0u; room < world.rooms; room++) {
        let area = world.room[room];
        let inside = x >= area.x0 && x < area.x1 && y >= area.y0 && y < area.y1;
        found = select(found, room, inside && found == NOWHERE);
    }
    return found;
}

// `PASSED_DOOR` where the robot is in another room than `origin` and clear of every doorway.
fn passed_door(origin: u32, x: f32, y: f32) -> u32 {
    let room = room_of(x, y);
    var clear = true;
    for (var door = 0u; door < world.doors; door++) {
        let way = world.doorway[door];
        let inside = x >= way.x0 && x < way.x1 && y >= way.y0 && y < way.y1;
        clear = clear && !inside;
    }
    let passed = clear && room != NOWHERE && origin != NOWHERE && room != origin;
    return select(0u, PASSED_DOOR, passed);
}

// `BESIDE_RIGHT` and `BESIDE_LEFT` where a forward move that was not blocked ended with the nearest reading of
// that side between `near` and `far` inches.
fn following_wall(near: u32, far: u32, action: u32, events: u32) -> u32 {
    var left = 255u;
    var right = 255u;
    for (var ray = SIDE_FIRST; ray <= SIDE_LAST; ray++) {
        let reading = sonar_inches(ray);
        let other = sonar_inches(RAYS - ray);
        left = select(left, reading, reading < left);
        right = select(right, other, other < right);
    }
    // The charger stops a move as a wall does: who pushes against it does not follow a wall.
    let went = action == FORWARD && (events & (COLLISION | DOCKED)) == 0u;
    let on_left = select(0u, BESIDE_LEFT, went && left >= near && left <= far);
    let on_right = select(0u, BESIDE_RIGHT, went && right >= near && right <= far);
    return on_left | on_right;
}

fn reward_of(skill: u32, events: u32) -> f32 {
    var sum = 0.0f;
    for (var event = 0u; event < EVENTS; event++) {
        let amount = params[params_base + skill].reward[event];
        sum = sum + select(0.0f, amount, ((events >> event) & 1u) == 1u);
    }
    return sum;
}
