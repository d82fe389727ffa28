// The six actions: noisy turns in place and noisy travel that stops at contact.

fn turn_of(action: u32) -> f32 {
    let known = action < ACTIONS;
    let row = select(0u, action, known);
    return select(0.0f, ACTION_TURN[row], known);
}

fn heading_after(heading: f32, action: u32, slip: f32) -> f32 {
    return wrap_degrees(heading + turn_of(action) * slip);
}

fn move_body(lane: u32, x: f32, y: f32, heading: f32, action: u32, slip: f32) -> Moved {
    let after = heading_after(heading, action, slip);
    let turn = sin_cos(after);
    var moved = Moved(x, y, after, 0u, 0u);
    if action == FORWARD || action == BACKWARD {
        let ux = select(-turn.y, turn.y, action == FORWARD);
        let uy = select(-turn.x, turn.x, action == FORWARD);
        let wanted = 12.0f * slip;
        let reach = select(0.0f, wanted, wanted > 0.0f);
        let travel = sweep_disc(lane, x, y, ux, uy, reach);
        moved.x = x + ux * travel.distance;
        moved.y = y + uy * travel.distance;
        let docked = travel.connected && action == FORWARD;
        let stopped = select(0u, COLLISION, travel.blocked);
        moved.events = select(stopped, DOCKED, docked);
    }
    moved.bumpers = touching_bumpers(lane, moved.x, moved.y, turn.y, turn.x);
    return moved;
}
