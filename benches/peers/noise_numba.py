"""The noise of all robots' steps in numba, drawn as skilltree draws it: Philox4x32-10 (Salmon et al., SC 2011).

Lanes are the innermost loops, so that LLVM makes vectors of them.
"""

import numpy as np
from numba import njit

from workload import ACTUATOR, COMPASS, LIGHT, PURPOSE, RAYS, SLIP, SONAR, TERM, TURNED

u32, u64, f32 = np.uint32, np.uint64, np.float32
LANES = COMPASS + 1
M0, M1, W0, W1, WORD = u64(0xD2511F53), u64(0xCD9E8D57), u32(0x9E3779B9), u32(0xBB67AE85), u64(32)
HALF, SIXTEEN, ONE, MIDDLE = u32(0xFFFF), u32(16), f32(1), np.int32(131070)

compiled = njit(error_model="numpy")


@compiled
def philox(c0, c1, c2, c3, k0, k1):
    """Replaces every lane's counter by its four random words."""
    for _ in range(10):
        for lane in range(LANES):
            product0, product1 = M0 * u64(c0[lane]), M1 * u64(c2[lane])
            c0[lane] = u32(product1 >> WORD) ^ c1[lane] ^ k0
            c2[lane] = u32(product0 >> WORD) ^ c3[lane] ^ k1
            c1[lane], c3[lane] = u32(product1), u32(product0)
        k0, k1 = u32(k0 + W0), u32(k1 + W1)


@compiled
def term(first, second):
    """A noise term of mean 0 and standard deviation 1: four 16-bit uniforms summed."""
    total = (first & HALF) + (first >> SIXTEEN) + (second & HALF) + (second >> SIXTEEN)
    return f32(np.int32(total) - MIDDLE) * TERM


@compiled
def draw(seed, number, slip, sonar, light, compass):
    """Fills in the noise of step `number` of every robot."""
    c0, c1, c2, c3 = np.empty(LANES, u32), np.empty(LANES, u32), np.empty(LANES, u32), np.empty(LANES, u32)
    for robot in range(len(seed)):
        for lane in range(LANES):
            c0[lane], c1[lane], c2[lane], c3[lane] = u32(0), u32(number), u32((PURPOSE << 16) + lane), u32(0)
        philox(c0, c1, c2, c3, seed[robot, 0], seed[robot, 1])
        slip[robot] = ONE + SLIP * term(c0[ACTUATOR], c1[ACTUATOR])
        compass[robot] = TURNED * term(c0[COMPASS], c1[COMPASS])
        for ray in range(RAYS):
            sonar[robot, ray] = ONE + SONAR * term(c0[ray], c1[ray])
            light[robot, ray] = ONE + LIGHT * term(c2[ray], c3[ray])
