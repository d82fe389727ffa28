"""The simulator in JAX: one robot's step, vmap over robots, scan over time, jit.

Everything that asks all segments is a scan over them: XLA makes each a loop whose body is one vectorised pass over the
robots. Arrays of [robots, segments] and [robots, rays, segments], the shorter way to write it, run at two thirds of
the speed.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

import noise_jax
from workload import RAYS

RADIUS, BUMPER_GAP, FAR, STILL, SONAR_LIMIT, SHARPNESS = 12.0, 0.4, 1e6, 1e-7, 127.0, 14.59025
TURN = jnp.array([15.0, -15.0, 60.0, -60.0, 0.0, 0.0])
TRAVEL = jnp.array([0.0, 0.0, 0.0, 0.0, 1.0, -1.0])
FORWARD = 4
BEARING = np.deg2rad(np.arange(RAYS) * 360.0 / RAYS).astype(np.float32)


class Segment(NamedTuple):
    """Segments of the floor, one array per coordinate."""

    ax: jax.Array
    ay: jax.Array
    bx: jax.Array
    by: jax.Array
    tx: jax.Array
    ty: jax.Array
    length: jax.Array
    charger: jax.Array


class Given(NamedTuple):
    """What one step is given."""

    action: jax.Array
    slip: jax.Array
    sonar_noise: jax.Array
    light_noise: jax.Array
    compass_noise: jax.Array


def over_segments(function, start, segments):
    """Folds a function over the segments."""
    return jax.lax.scan(lambda carry, segment: (function(carry, segment), None), start, segments)[0]


def contact(segment, x, y, ux, uy):
    """Distance to contact with one segment, and the cosine between the travel and the contact point."""
    wx, wy = x - segment.ax, y - segment.ay
    side = segment.tx * wy - segment.ty * wx
    drift = segment.tx * uy - segment.ty * ux
    closing = jnp.where(side < 0, drift, -drift)
    gap = jnp.maximum((jnp.abs(side) - RADIUS) / jnp.maximum(closing, STILL), 0)
    along = segment.tx * wx + segment.ty * wy + (segment.tx * ux + segment.ty * uy) * gap
    reach = jnp.where((closing > STILL) & (along >= 0) & (along <= segment.length), gap, FAR)
    cosine = closing
    for ex, ey in ((-wx, -wy), (segment.bx - x, segment.by - y)):
        ahead, across = ex * ux + ey * uy, ex * uy - ey * ux
        chord = RADIUS * RADIUS - across * across
        back = jnp.sqrt(jnp.maximum(chord, 0))
        end = jnp.where((chord > 0) & (ahead > 0), jnp.maximum(ahead - back, 0), FAR)
        cosine = jnp.where(end < reach, back / RADIUS, cosine)
        reach = jnp.minimum(reach, end)
    return reach, cosine


def sweep(segments, dock_cosine, x, y, ux, uy, reach):
    """Travel of the disc until contact: distance, whether blocked, whether at the charger."""

    def nearest(carry, segment):
        least, plugged = carry
        distance, cosine = contact(segment, x, y, ux, uy)
        plug = segment.charger & (cosine >= dock_cosine)
        return jnp.minimum(least, distance), jnp.where(distance < least, plug, plugged | ((distance == least) & plug))

    least, plugged = over_segments(nearest, (jnp.float32(FAR), False), segments)
    blocked = least < reach
    return jnp.minimum(least, reach), blocked, blocked & plugged


def bumpers(segments, x, y, cosine, sine):
    """Bits of the bumpers that touch: 1 front, 2 left, 4 back, 8 right."""

    def touch(bits, segment):
        wx, wy = x - segment.ax, y - segment.ay
        along = jnp.clip(segment.tx * wx + segment.ty * wy, 0, segment.length)
        px, py = segment.tx * along - wx, segment.ty * along - wy
        front, left = px * cosine + py * sine, py * cosine - px * sine
        lengthwise = jnp.abs(front) >= jnp.abs(left)
        sector = jnp.where(lengthwise, jnp.where(front > 0, 1, 4), jnp.where(left > 0, 2, 8)).astype(jnp.uint8)
        return bits | jnp.where(px * px + py * py < (RADIUS + BUMPER_GAP) ** 2, sector, jnp.uint8(0))

    return over_segments(touch, jnp.uint8(0), segments)


def crossing(segment, x, y, ux, uy):
    """Whether a line from (x, y) crosses a segment, and how far along (ux, uy), in its lengths."""
    ax, ay, bx, by = segment.ax - x, segment.ay - y, segment.bx - x, segment.by - y
    dx, dy = segment.bx - segment.ax, segment.by - segment.ay
    crosses = (ax * uy - ay * ux > 0) != (bx * uy - by * ux > 0)
    distance = (ax * dy - ay * dx) / (ux * dy - uy * dx)
    return crosses & (distance >= 0), distance


def ranges(segments, x, y, ux, uy):
    """Distance along every ray to the nearest segment."""

    def nearest(best, segment):
        hit, distance = crossing(segment, x, y, ux, uy)
        return jnp.where(hit, jnp.minimum(best, distance), best)

    return over_segments(nearest, jnp.full(RAYS, SONAR_LIMIT), segments)


def in_sight(segments, x, y, lx, ly):
    """Whether nothing but the charger stands between the robot and the light."""

    def hides(hidden, segment):
        hit, distance = crossing(segment, x, y, lx, ly)
        return hidden | (hit & (distance < 1) & ~segment.charger)

    return ~over_segments(hides, False, segments)


def step(work, segments, pose, given):
    """One robot carries out one action and senses."""
    x, y, heading = pose
    heading = (heading + TURN[given.action] * given.slip) % 360
    cosine, sine = jnp.cos(jnp.deg2rad(heading)), jnp.sin(jnp.deg2rad(heading))
    way = TRAVEL[given.action]
    reach = jnp.maximum(12 * given.slip, 0) * jnp.abs(way)
    distance, blocked, plugged = sweep(segments, work.dock_cosine, x, y, way * cosine, way * sine, reach)
    x, y = x + way * cosine * distance, y + way * sine * distance
    docked = plugged & (given.action == FORWARD)

    ux = cosine * np.cos(BEARING) - sine * np.sin(BEARING)
    uy = sine * np.cos(BEARING) + cosine * np.sin(BEARING)
    sonar = jnp.clip(ranges(segments, x, y, ux, uy) * given.sonar_noise, 0, SONAR_LIMIT) + 0.5
    lx, ly = work.light[0] - x, work.light[1] - y
    distance2 = jnp.maximum(lx * lx + ly * ly, 1)
    aim = (ux * lx + uy * ly) * jax.lax.rsqrt(distance2)
    bright = work.light_range2 / distance2 * jnp.exp(SHARPNESS * (aim - 1))
    senses = {
        "pose": jnp.stack([x, y, heading]),
        "compass": (heading + given.compass_noise) % 360,
        "sonar": sonar.astype(jnp.uint8),
        "light": in_sight(segments, x, y, lx, ly) & (bright * given.light_noise > 1),
        "bumpers": bumpers(segments, x, y, cosine, sine),
        "events": jnp.where(docked, 1, jnp.where(blocked, 2, 0)).astype(jnp.uint8),
    }
    return (x, y, heading), senses


def prepare(work, drawn):
    """A function that walks all robots through all steps; their noise is drawn on the way, or given beforehand."""
    segments = Segment(*map(jnp.asarray, work.segment.T), jnp.asarray(work.charger))
    steps, robots = work.action.shape
    if drawn:
        noise = (np.arange(steps, dtype=np.uint32)[:, None].repeat(robots, 1),)
    else:
        noise = (work.slip, work.sonar_noise, work.light_noise, work.compass_noise)

    def advance(pose, seed, action, noise):
        noise = noise_jax.draw(seed, *noise) if drawn else noise
        return step(work, segments, pose, Given(action, *noise))

    @jax.jit
    def walk(start, seed, action, noise):
        every = jax.vmap(advance)
        return jax.lax.scan(lambda pose, given: every(pose, seed, *given), start, (action, noise))[1]

    given = jax.tree.map(jnp.asarray, (tuple(work.start.T), tuple(work.seed.T), work.action, noise))
    return lambda: jax.tree.map(np.asarray, walk(*given))
