"""The noise of a robot's step in JAX, drawn as skilltree draws it: Philox4x32-10 (Salmon et al., SC 2011)."""

import jax.numpy as jnp
import numpy as np

from workload import ACTUATOR, COMPASS, LIGHT, PURPOSE, RAYS, SLIP, SONAR, TERM, TURNED

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


def draw(seed, number):
    """A robot's noise at a step: slip, sonar, light, compass."""
    lane = np.arange(COMPASS + 1, dtype=np.uint32)
    zero = jnp.zeros_like(lane)
    x, y, z, w = philox((zero, zero + number, zero + (PURPOSE << 16) + lane, zero), seed)
    rays, beams = term(x, y), term(z, w)
    slip, sonar = 1 + SLIP * rays[ACTUATOR], 1 + SONAR * rays[:RAYS]
    return slip, sonar, 1 + LIGHT * beams[:RAYS], TURNED * rays[COMPASS]
