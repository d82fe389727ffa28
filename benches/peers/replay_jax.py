"""Replay in JAX: one learner's transition, vmap over a few learners, a loop over time, jit.

What was tried and kept: the inputs' weights of all nets side by side, so that one product serves all children; the
bias as one more input; learners in batches that fit the cache, sorted by the length of their streams, so that little
is padded. Masking the update instead of gathering one child's net, one array for weights and moments, and a product
per net all ran at half the speed or less.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

BATCH = 8


class Weights(NamedTuple):
    """Weights, or one of their moments, of one learner's nets."""

    hidden: jax.Array  # [inputs + 1, children, units]; the last row is the bias
    output: jax.Array  # [children, units + 1]; the last column is the bias


class Learner(NamedTuple):
    """What replay changes."""

    weights: Weights
    means: Weights
    squares: Weights
    decay: jax.Array  # [children, 2] powers of Adam's betas
    best: jax.Array
    returned: jax.Array


class Transition(NamedTuple):
    """One replayed step; what stands behind the end of a stream has a child that there is not."""

    input: jax.Array
    child: jax.Array
    reward: jax.Array
    last: jax.Array


def adam(hyper, weight, mean, square, slope, rate):
    """Adam with epsilon under the root, upwards."""
    mean = hyper["beta1"] * mean + (1 - hyper["beta1"]) * slope
    square = hyper["beta2"] * square + (1 - hyper["beta2"]) * slope * slope
    return weight + rate * mean * jax.lax.rsqrt(square + hyper["epsilon2"]), mean, square


def learn(hyper, learner, step):
    """Learns from one transition."""
    weights, child = learner.weights, step.child
    inputs, children, units = weights.hidden.shape
    hidden = jnp.tanh((step.input @ weights.hidden.reshape(inputs, -1)).reshape(children, units))
    values = jnp.tanh((hidden * weights.output[:, :units]).sum(1) + weights.output[:, units])

    future = (1 - hyper["lambda"]) * learner.best + hyper["lambda"] * learner.returned
    goal = step.reward + hyper["gamma"] * jnp.where(step.last, 0, future)
    goal = jnp.clip(goal, -hyper["target_clip"], hyper["target_clip"])

    value, active = values[child], hidden[child]
    error = (goal - value) * (1 - value * value)
    back = error * weights.output[child, :units] * (1 - active * active)
    slope = Weights(step.input[:, None] * back, error * jnp.append(active, 1))
    decay = learner.decay[child] * jnp.stack([hyper["beta1"], hyper["beta2"]])
    rate = hyper["rate"] * jnp.sqrt(1 - decay[1]) / (1 - decay[0])

    own = [Weights(w.hidden[:, child], w.output[child]) for w in learner[:3]]
    moved = zip(*(adam(hyper, *parts, rate) for parts in zip(*own, slope)))
    weights, means, squares = (
        Weights(w.hidden.at[:, child].set(new[0], mode="drop"), w.output.at[child].set(new[1], mode="drop"))
        for w, new in zip(learner[:3], moved)
    )
    decay = learner.decay.at[child].set(decay, mode="drop")
    return Learner(weights, means, squares, decay, values.max(), goal)


@jax.jit
def replay(hyper, learners, streams, longest, passes):
    """A batch of learners goes `passes` times over its streams, of which the longest has `longest` transitions."""

    def transition(count, learners):
        step = jax.tree.map(lambda values: values[count % longest], streams)
        return jax.vmap(learn, (None, 0, 0))(hyper, learners, step)

    return jax.lax.fori_loop(0, passes * longest, transition, learners)


def prepare(work):
    """A function that replays `passes` times, all learners, and returns their weights."""
    order = np.argsort(work.length)
    batches = [order[at : at + BATCH] for at in range(0, len(order), BATCH)]
    hyper = {name: jnp.float32(value) for name, value in work.hyper.items()}
    learners = [jax.tree.map(jnp.asarray, begin(work, batch)) for batch in batches]
    streams = [jax.tree.map(jnp.asarray, stream(work, batch)) for batch in batches]
    longest = [int(work.length[batch].max()) for batch in batches]

    def run(passes):
        done = [replay(hyper, *each, passes) for each in zip(learners, streams, longest)]
        hidden = np.concatenate([batch.weights.hidden for batch in done])[np.argsort(order)]
        output = np.concatenate([batch.weights.output for batch in done])[np.argsort(order)]
        return {
            "hidden.weight": hidden[:, :-1].transpose(0, 2, 3, 1),
            "hidden.bias": hidden[:, -1],
            "output.weight": output[..., :-1],
            "output.bias": output[..., -1],
        }

    return run


def begin(work, batch):
    """Learners before any replay."""
    first = {name: values[batch] for name, values in work.initial.items()}
    hidden = first["hidden.weight"].transpose(0, 3, 1, 2)
    hidden = np.concatenate([hidden, first["hidden.bias"][:, None]], axis=1)
    output = np.concatenate([first["output.weight"], first["output.bias"][..., None]], axis=2)
    weights, nothing = Weights(hidden, output), Weights(np.zeros_like(hidden), np.zeros_like(output))
    zero = np.zeros(len(batch), np.float32)
    return Learner(weights, nothing, nothing, np.ones((*output.shape[:2], 2), np.float32), zero, zero)


def stream(work, batch):
    """The batch's transitions, time first."""
    ones = np.ones((*work.input.shape[:2], 1), np.float32)
    beyond = np.arange(work.child.shape[1]) >= work.length[:, None]
    nobody = work.initial["output.bias"].shape[1]
    child = np.where(beyond, nobody, work.child)
    parts = Transition(np.concatenate([work.input, ones], axis=2), child, work.reward, work.last)
    return Transition(*(part[batch].swapaxes(0, 1) for part in parts))
