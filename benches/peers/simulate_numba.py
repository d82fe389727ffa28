"""The simulator in numba: loops over robots, rays and the segments near the robot, compiled by njit, one thread.

Segments within the sonar's reach, and within the body's, are listed per cell of the floor beforehand. For each segment
heard, the inner loop goes over the 24 rays without a branch, so that LLVM makes vectors of it.
"""

import math

import numpy as np
from numba import njit

import noise_numba
from workload import RAYS

f32 = np.float32
RADIUS, BUMPER_GAP, FAR, STILL, LIMIT = f32(12), f32(0.4), f32(1e6), f32(1e-7), f32(127)
SHARPNESS, RADIANS, ZERO, HALF, ONE, FULL = f32(14.59025), f32(math.pi / 180), f32(0), f32(0.5), f32(1), f32(360)
TURN = np.array([15, -15, 60, -60, 0, 0], f32)
FORWARD, BACKWARD = 4, 5
# Side of the cells that have their own lists, and how far from a cell a segment can matter: to the sonar, and to a body
# that moves by at most 12 inches and their noise.
CELL, HEARD, TOUCHED = 12, 127.5, 40
COSINES = np.cos(np.arange(RAYS) * 2 * math.pi / RAYS).astype(f32)
SINES = np.sin(np.arange(RAYS) * 2 * math.pi / RAYS).astype(f32)

compiled = njit(fastmath=True, error_model="numpy")


def cells(segment):
    """Columns and rows of cells."""
    return tuple(math.ceil(segment[:, [k, k + 2]].max() / CELL) for k in (0, 1))


def near_lists(segment, limit):
    """Numbers of the segments within `limit` of each cell, padded, and how many they are."""
    columns, rows = cells(segment)
    lists = [
        [number for number, s in enumerate(segment) if apart(s[:4], column * CELL, row * CELL) <= limit]
        for row in range(rows)
        for column in range(columns)
    ]
    padded = np.zeros((len(lists), max(map(len, lists))), np.int64)
    for cell, near in enumerate(lists):
        padded[cell, : len(near)] = near
    return padded, np.array([len(near) for near in lists])


def apart(ends, left, bottom):
    """Distance between a cell and the box round a segment, which is the segment where it is axis-parallel."""
    dx = max(min(ends[0], ends[2]) - (left + CELL), left - max(ends[0], ends[2]), 0)
    dy = max(min(ends[1], ends[3]) - (bottom + CELL), bottom - max(ends[1], ends[3]), 0)
    return math.hypot(dx, dy)


@compiled
def meet(ex, ey, ux, uy):
    """Distance at which the rim meets a point, and how far the centre then is behind it."""
    ahead, across = ex * ux + ey * uy, ex * uy - ey * ux
    chord = RADIUS * RADIUS - across * across
    if chord <= ZERO or ahead <= ZERO:
        return FAR, ZERO
    back = math.sqrt(chord)
    return max(ahead - back, ZERO), back


@compiled
def contact(ax, ay, bx, by, tx, ty, length, x, y, ux, uy):
    """Distance to contact with one segment, and the cosine between the travel and the contact point."""
    wx, wy = x - ax, y - ay
    side, drift = tx * wy - ty * wx, tx * uy - ty * ux
    closing = drift if side < ZERO else -drift
    reach, cosine = FAR, closing
    if closing > STILL:
        gap = max((abs(side) - RADIUS) / closing, ZERO)
        along = tx * wx + ty * wy + (tx * ux + ty * uy) * gap
        if along >= ZERO and along <= length:
            reach = gap
    for ex, ey in ((-wx, -wy), (bx - x, by - y)):
        end, back = meet(ex, ey, ux, uy)
        if end < reach:
            reach, cosine = end, back / RADIUS
    return reach, cosine


@compiled
def sweep(segment, charger, dock_cosine, near, count, x, y, ux, uy, reach):
    """Travel of the disc until contact: distance, whether blocked, whether at the charger."""
    least, plugged = FAR, False
    for entry in range(count):
        number = near[entry]
        ax, ay, bx, by, tx, ty, length = segment[number]
        distance, cosine = contact(ax, ay, bx, by, tx, ty, length, x, y, ux, uy)
        plug = charger[number] and cosine >= dock_cosine
        if distance < least:
            least, plugged = distance, plug
        elif distance == least:
            plugged = plugged or plug
    blocked = least < reach
    return min(least, reach), blocked, blocked and plugged


@compiled
def bumpers(segment, near, count, x, y, cosine, sine):
    """Bits of the bumpers that touch: 1 front, 2 left, 4 back, 8 right."""
    bits = 0
    for entry in range(count):
        ax, ay, _bx, _by, tx, ty, length = segment[near[entry]]
        wx, wy = x - ax, y - ay
        along = min(max(tx * wx + ty * wy, ZERO), length)
        px, py = tx * along - wx, ty * along - wy
        if px * px + py * py < (RADIUS + BUMPER_GAP) * (RADIUS + BUMPER_GAP):
            front, left = px * cosine + py * sine, py * cosine - px * sine
            if abs(front) >= abs(left):
                bits |= 1 if front > ZERO else 4
            else:
                bits |= 2 if left > ZERO else 8
    return bits


@compiled
def ranges(segment, near, count, x, y, ux, uy, best):
    """Distance along every ray to the nearest segment, into `best`."""
    best[:] = LIMIT
    for entry in range(count):
        ax, ay, bx, by, _tx, _ty, _length = segment[near[entry]]
        ax, ay, bx, by = ax - x, ay - y, bx - x, by - y
        dx, dy = bx - ax, by - ay
        over = ax * dy - ay * dx
        for ray in range(RAYS):
            crosses = (ax * uy[ray] - ay * ux[ray] > ZERO) != (bx * uy[ray] - by * ux[ray] > ZERO)
            distance = over / (ux[ray] * dy - uy[ray] * dx)
            best[ray] = distance if crosses & (distance >= ZERO) & (distance < best[ray]) else best[ray]


@compiled
def in_sight(segment, charger, x, y, lx, ly):
    """Whether nothing but the charger stands between the robot and the light."""
    for number in range(len(segment)):
        ax, ay, bx, by, _tx, _ty, _length = segment[number]
        ax, ay, bx, by = ax - x, ay - y, bx - x, by - y
        if not charger[number] and (ax * ly - ay * lx > ZERO) != (bx * ly - by * lx > ZERO):
            dx, dy = bx - ax, by - ay
            distance = (ax * dy - ay * dx) / (lx * dy - ly * dx)
            if distance >= ZERO and distance < ONE:
                return False
    return True


@compiled
def wrap(heading):
    """A heading brought back to [0, 360)."""
    below = heading + FULL if heading < ZERO else heading
    return below - FULL if below >= FULL else below


@compiled
def step(segment, charger, columns, heard, touched, light, range2, dock_cosine, given, drawn, seed, now, before, after):
    """All robots carry out one action each and sense. Noise of the light is drawn where it is seen."""
    action, slip, sonar_noise, light_noise, compass_noise = given
    pose, compass, sonar, lit, bumped, events = after
    ux, uy, best = np.empty(RAYS, f32), np.empty(RAYS, f32), np.empty(RAYS, f32)
    words = np.empty((4, noise_numba.LANES), np.uint32)
    for robot in range(len(action)):
        x, y, heading = before[robot]
        act = action[robot]
        heading = wrap(heading + TURN[act] * slip[robot])
        cosine, sine = math.cos(heading * RADIANS), math.sin(heading * RADIANS)
        events[robot] = 0
        if act == FORWARD or act == BACKWARD:
            cell = int(y) // CELL * columns + int(x) // CELL
            way = ONE if act == FORWARD else -ONE
            wx, wy, reach = way * cosine, way * sine, max(f32(12) * slip[robot], ZERO)
            distance, blocked, plugged = sweep(
                segment, charger, dock_cosine, touched[0][cell], touched[1][cell], x, y, wx, wy, reach
            )
            x, y = x + wx * distance, y + wy * distance
            events[robot] = 1 if plugged and act == FORWARD else 2 if blocked else 0
        pose[robot, 0], pose[robot, 1], pose[robot, 2] = x, y, heading
        compass[robot] = wrap(heading + compass_noise[robot])

        cell = int(y) // CELL * columns + int(x) // CELL
        bumped[robot] = bumpers(segment, touched[0][cell], touched[1][cell], x, y, cosine, sine)
        for ray in range(RAYS):
            ux[ray] = cosine * COSINES[ray] - sine * SINES[ray]
            uy[ray] = sine * COSINES[ray] + cosine * SINES[ray]
        ranges(segment, heard[0][cell], heard[1][cell], x, y, ux, uy, best)
        for ray in range(RAYS):
            sonar[robot, ray] = np.uint8(min(max(best[ray] * sonar_noise[robot, ray], ZERO), LIMIT) + HALF)
        lx, ly = light[0] - x, light[1] - y
        if in_sight(segment, charger, x, y, lx, ly):
            distance2 = max(lx * lx + ly * ly, ONE)
            nearness, falloff = ONE / math.sqrt(distance2), range2 / distance2
            if drawn:
                noise_numba.draw_light(seed[robot], now, words, light_noise[robot])
            for ray in range(RAYS):
                aim = (ux[ray] * lx + uy[ray] * ly) * nearness
                lit[robot, ray] = falloff * math.exp(SHARPNESS * (aim - ONE)) * light_noise[robot, ray] > ONE
        else:
            lit[robot] = False


def prepare(work, drawn):
    """A function that walks all robots through all steps; their noise is drawn on the way, or given beforehand."""
    steps, robots = work.action.shape
    columns, _rows = cells(work.segment)
    heard, touched = near_lists(work.segment, HEARD), near_lists(work.segment, TOUCHED)
    senses = {
        "pose": np.empty((steps, robots, 3), f32),
        "compass": np.empty((steps, robots), f32),
        "sonar": np.empty((steps, robots, RAYS), np.uint8),
        "light": np.empty((steps, robots, RAYS), np.bool_),
        "bumpers": np.empty((steps, robots), np.uint8),
        "events": np.empty((steps, robots), np.uint8),
    }
    given = (work.slip, work.sonar_noise, work.light_noise, work.compass_noise)
    fresh = slip, sonar, _, compass = tuple(np.empty_like(values[0]) for values in given)

    def run():
        before = work.start
        for now in range(steps):
            after = tuple(sense[now] for sense in senses.values())
            if drawn:
                noise_numba.draw(work.seed, now, slip, sonar, compass)
            noise = fresh if drawn else tuple(values[now] for values in given)
            step(
                work.segment, work.charger, columns, heard, touched, work.light, work.light_range2, work.dock_cosine,
                (work.action[now], *noise), drawn, work.seed, now, before, after,
            )  # fmt: skip
            before = after[0]
        return senses

    return run
