"""The noise of a robot's step in JAX, drawn as skilltree draws it: Philox4x32-10 (Salmon et al., SC 2011)."""

import jax.numpy as jnp
import numpy as np

from workload import ACTUATOR, BEAMS, COARSE, COMPASS, LIGHT, PURPOSE, RAYS, SHARED, SLIP, SONAR, TERM, TURNED

MULTIPLIER = (0xD2511F53, 0xCD9E8D57)
WEYL = (0x9E3779B9, 0xBB67AE85)


def mul_high(a, b):
    """High word of the product of a constant and 32-bit words, from halves: JAX has no wider integers by default."""
    low_a, high_a = np.uint32(a & 0xFFFF), np.uint32(a >> 16)
    low_b, high_b = b & 0xFFFF, b >> 16
    cross, other = low_a * high_b, high_a * low_b
    middle = (low_a * low_b >> 16) + (cross & 0xFFFF) + (other & 0xFFFF)
    return high_a * high_b + (cross >> 16) + (other >> 16) + (middle >> 16)


def philox(counter, key):
    """Four random words for each counter."""
    (c0, c1, c2, c3), (k0, k1) = counter, key
    for _ in range(10):
        high0, low0 = mul_high(MULTIPLIER[0], c0), np.uint32(MULTIPLIER[0]) * c0
        high1, low1 = mul_high(MULTIPLIER[1], c2), np.uint32(MULTIPLIER[1]) * c2
        c0, c1, c2, c3 = high1 ^ c1 ^ k0, low1, high0 ^ c3 ^ k1, low0
        k0, k1 = k0 + np.uint32(WEYL[0]), k1 + np.uint32(WEYL[1])
    return c0, c1, c2, c3


def term(first, second):
    """A noise term of mean 0 and standard deviation 1: four 16-bit uniforms summed."""
    total = (first & 0xFFFF) + (first >> 16) + (second & 0xFFFF) + (second >> 16)
    return (total.astype(jnp.int32) - 131070).astype(jnp.float32) * TERM


def coarse(word):
    """The same from one word: four 8-bit uniforms summed."""
    pairs = (word & 0xFF00FF) + ((word >> 8) & 0xFF00FF)
    total = (pairs & 0xFFFF) + (pairs >> 16)
    return (total.astype(jnp.int32) - 510).astype(jnp.float32) * COARSE


def draw(seed, number):
    """A robot's noise at a step: slip, sonar, light, compass."""
    zero = jnp.zeros_like(number)

    def words(lane):
        return philox((zero, number, zero + np.uint32((PURPOSE << 16) + lane), zero), seed)

    def shared(first):
        drawn = [words(first + lane) for lane in range(SHARED)]
        return coarse(jnp.stack([drawn[ray % SHARED][ray // SHARED] for ray in range(RAYS)]))

    slip, compass = (term(*words(lane)[:2]) for lane in (ACTUATOR, COMPASS))
    return 1 + SLIP * slip, 1 + SONAR * shared(0), 1 + LIGHT * shared(BEAMS), TURNED * compass
