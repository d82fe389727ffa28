"""Replay in numba: loops over learners, transitions, inputs and hidden units, compiled by njit, one thread.

A learner replays all passes before the next one begins, so its nets stay in the cache. The inputs' weights of all nets
lie side by side, so that one product serves all children; the bias is one more input. Inner loops go along slices of
rows, of which LLVM makes vectors; along two indices of one array it makes none, at a tenth of the speed.
"""

import math

import numpy as np
from numba import njit

f32 = np.float32
ZERO, ONE, TWO = f32(0), f32(1), f32(2)

compiled = njit(fastmath=True, error_model="numpy")


@compiled
def adam(hyper, weight, mean, square, error, by, rate):
    """Adam with epsilon under the root, upwards, on one row of weights whose slopes are error times `by`."""
    _gamma, _lambda, _rate, beta1, beta2, epsilon2, _limit = hyper
    for at in range(len(by)):
        slope = error * by[at]
        mean[at] = beta1 * mean[at] + (ONE - beta1) * slope
        square[at] = beta2 * square[at] + (ONE - beta2) * slope * slope
        weight[at] += rate * mean[at] / math.sqrt(square[at] + epsilon2)


@compiled
def tanh(x):
    """tanh by one exponential, in half the time of math.tanh."""
    return ONE - TWO / (math.exp(TWO * x) + ONE)


@compiled
def forward(hidden, output, x, active, values):
    """Values of all children; `active` are the hidden units, each net's followed by 1."""
    children, width = active.shape
    sums = np.dot(x, hidden).reshape(children, width - 1)
    for child in range(children):
        total = output[child, width - 1]
        for unit in range(width - 1):
            active[child, unit] = tanh(sums[child, unit])
            total += active[child, unit] * output[child, unit]
        values[child] = tanh(total)


@compiled
def learn(hyper, hidden, output, decay, child, x, active, value, goal):
    """Moves the net of a child, and its moments, towards a goal."""
    decay[0] *= hyper[3]
    decay[1] *= hyper[4]
    rate = hyper[2] * math.sqrt(ONE - decay[1]) / (ONE - decay[0])
    units = len(active) - 1
    error = (goal - value) * (ONE - value * value)
    back = error * output[0, child, :units] * (ONE - active[:units] * active[:units])
    own = slice(child * units, (child + 1) * units)
    for row in range(len(x)):
        adam(hyper, hidden[0, row, own], hidden[1, row, own], hidden[2, row, own], x[row], back, rate)
    adam(hyper, output[0, child], output[1, child], output[2, child], error, active, rate)


@compiled
def replay(hyper, hidden, output, decay, input, child, reward, last, length, passes):
    """Every learner goes `passes` times over its stream."""
    gamma, lambda_, _rate, _beta1, _beta2, _epsilon2, limit = hyper
    children, width = output.shape[2:]
    active, values = np.ones((children, width), f32), np.empty(children, f32)
    for learner in range(len(hidden)):
        best, returned = ZERO, ZERO
        for _ in range(passes):
            for count in range(length[learner]):
                x = input[learner, count]
                forward(hidden[learner, 0], output[learner, 0], x, active, values)
                future = ZERO if last[learner, count] else (ONE - lambda_) * best + lambda_ * returned
                goal = min(max(reward[learner, count] + gamma * future, -limit), limit)
                best, returned, own = values.max(), goal, child[learner, count]
                learn(hyper, hidden[learner], output[learner], decay[learner, own], own, x, active[own], values[own], goal)


def prepare(work):
    """A function that replays `passes` times, all learners, and returns their weights."""
    first = work.initial
    learners, children, units, inputs = first["hidden.weight"].shape
    hidden = np.zeros((learners, 3, inputs + 1, children, units), f32)
    hidden[:, 0, :-1] = first["hidden.weight"].transpose(0, 3, 1, 2)
    hidden[:, 0, -1] = first["hidden.bias"]
    output = np.zeros((learners, 3, children, units + 1), f32)
    output[:, 0, :, :-1] = first["output.weight"]
    output[:, 0, :, -1] = first["output.bias"]
    given = np.concatenate([work.input, np.ones((*work.child.shape, 1), f32)], axis=2)
    hyper = tuple(work.hyper[name] for name in ("gamma", "lambda", "rate", "beta1", "beta2", "epsilon2", "target_clip"))

    def run(passes):
        nets = hidden.reshape(learners, 3, inputs + 1, -1).copy(), output.copy(), np.ones((learners, children, 2), f32)
        replay(hyper, *nets, given, work.child, work.reward, work.last, work.length, passes)
        weight = nets[0][:, 0].reshape(learners, inputs + 1, children, units)
        return {
            "hidden.weight": weight[:, :-1].transpose(0, 2, 3, 1),
            "hidden.bias": weight[:, -1],
            "output.weight": nets[1][:, 0, :, :-1],
            "output.bias": nets[1][:, 0, :, -1],
        }

    return run
