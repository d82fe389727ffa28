// What an action brought about, and what that earns.

const NOWHERE: u32 = 255u;
const SIDE_FIRST: u32 = 2u;
const SIDE_LAST: u32 = 10u;

fn holds(area: Area, x: f32, y: f32) -> bool {
    return x >= area.x0 && x < area.x1 && y >= area.y0 && y < area.y1;
}

// Events of this region where an action took the robot from (`before_x`, `before_y`) to (`x`, `y`).
fn crossing_events(area: Area, before_x: f32, before_y: f32, x: f32, y: f32) -> u32 {
    let before = holds(area, before_x, before_y);
    let now = holds(area, x, y);
    let inside = select(0u, IN_REGION, now);
    let entered = select(0u, ENTERED_REGION, now && !before);
    let left = select(0u, LEFT_REGION, before && !now);
    return inside | entered | left;
}

fn room_of(x: f32, y: f32) -> u32 {
    var found = NOWHERE;
    for (var room = 0u; room < world.rooms; room++) {
        let inside = holds(world.room[room], x, y);
        found = select(found, room, inside && found == NOWHERE);
    }
    return found;
}

// `PASSED_DOOR` where the robot is in another room than `origin` and clear of every doorway.
fn passed_door(origin: u32, x: f32, y: f32) -> u32 {
    let room = room_of(x, y);
    var clear = true;
    for (var door = 0u; door < world.doors; door++) {
        let inside = holds(world.doorway[door], x, y);
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

// All events that are found from what is observed after an action.
fn observed_events(near: u32, far: u32, action: u32, events: u32) -> u32 {
    return following_wall(near, far, action, events) | seeing_light(events);
}

// `LIT` where some bearing is lit after an action.
fn seeing_light(events: u32) -> u32 {
    let lit = lit_bearings() != 0u && (events & ACTED) == ACTED;
    return select(0u, LIT, lit);
}

fn skill_events(skill: u32) -> u32 {
    var events = agent.events;
    // Where a trial begins nothing has happened yet.
    let regions = select(0u, skills[skill].regions, (events & ACTED) == ACTED);
    for (var region = 0u; region < regions; region++) {
        let area = skills[skill].region[region];
        let crossed = crossing_events(area, agent.before_x, agent.before_y, agent.x, agent.y);
        events |= crossed << (EVENTS + region * REGION_EVENTS);
    }
    return events;
}

fn reward_of(skill: u32, events: u32) -> f32 {
    var sum = 0.0f;
    for (var left = events; left != 0u; left &= left - 1u) {
        sum = sum + params[params_base + skill].reward[countTrailingZeros(left)];
    }
    return sum;
}
