"""The noise of all robots' steps in numba, drawn as skilltree draws it: Philox4x32-10 (Salmon et al., SC 2011).

Lanes are the innermost loops, so that LLVM makes vectors of them.
"""

import numpy as np
from numba import njit

from workload import ACTUATOR, BEAMS, COARSE, COMPASS, LIGHT, PURPOSE, SHARED, SLIP, SONAR, TERM, TURNED

u32, u64, f32 = np.uint32, np.uint64, np.float32
LANES = 8
M0, M1, W0, W1, WORD = u64(0xD2511F53), u64(0xCD9E8D57), u32(0x9E3779B9), u32(0xBB67AE85), u64(32)
HALF, SIXTEEN, ONE, MIDDLE = u32(0xFFFF), u32(16), f32(1), np.int32(131070)
BYTES, EIGHT, COARSE_MIDDLE = u32(0xFF00FF), u32(8), np.int32(510)

compiled = njit(error_model="numpy")


@compiled
def philox(number, first, k0, k1, words):
    """Fills in the four random words of eight draws, a lane each."""
    c0, c1, c2, c3 = words
    for lane in range(LANES):
        c0[lane], c1[lane], c2[lane], c3[lane] = u32(0), u32(number), u32((PURPOSE << 16) + first + lane), u32(0)
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
def coarse(word):
    """The same from one word: four 8-bit uniforms summed."""
    pairs = (word & BYTES) + ((word >> EIGHT) & BYTES)
    return f32(np.int32((pairs & HALF) + (pairs >> SIXTEEN)) - COARSE_MIDDLE) * COARSE


@compiled
def draw(seed, number, slip, sonar, compass):
    """Fills in the noise of step `number` of every robot, but for that of the light."""
    words = np.empty((4, LANES), u32)
    for robot in range(len(seed)):
        philox(number, 0, seed[robot, 0], seed[robot, 1], words)
        slip[robot] = ONE + SLIP * term(words[0, ACTUATOR], words[1, ACTUATOR])
        compass[robot] = TURNED * term(words[0, COMPASS], words[1, COMPASS])
        for word in range(4):
            for lane in range(SHARED):
                sonar[robot, word * SHARED + lane] = ONE + SONAR * coarse(words[word, lane])


@compiled
def draw_light(seed, number, words, light):
    """Fills in a robot's noise of the light."""
    philox(number, BEAMS, seed[0], seed[1], words)
    for word in range(4):
        for lane in range(SHARED):
            light[word * SHARED + lane] = ONE + LIGHT * coarse(words[word, lane])
