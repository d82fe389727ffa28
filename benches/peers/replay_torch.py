"""Replay in PyTorch: learners in batches, batched products, the gradient by hand, torch.compile.

One call learns one transition of every learner in a batch. Autograd would build and walk a graph for each of them;
without torch.compile the same function runs at a third of the speed. Each child's net is one row of a tensor, so that
index_select and index_copy_ move whole nets. A batch is as large as the cache allows, for every call costs the same
however many learners it serves.
"""

import numpy as np
import torch

BATCH = 64


def adam(hyper, weight, mean, square, slope, rate):
    """Adam with epsilon under the root, upwards."""
    mean = hyper["beta1"] * mean + (1 - hyper["beta1"]) * slope
    square = hyper["beta2"] * square + (1 - hyper["beta2"]) * slope * slope
    return weight + rate * mean * torch.rsqrt(square + hyper["epsilon2"]), mean, square


def learn(hyper, nets, best, returned, step):
    """Learns from one transition of every learner; changes `nets` and returns the new best value and return.

    `nets` are the hidden layer's weights, means and squares [nets, inputs + 1, units], the same three of the output
    [nets, units + 1], and the powers of Adam's betas [nets, 2]; biases come last. The last net belongs to nobody.
    """
    hidden_net, output_net, decay = nets[0], nets[3], nets[6]
    x, own, number, reward, going = step
    learners, (_, inputs, units) = len(best), hidden_net.shape
    active = torch.tanh(torch.matmul(x[:, None, None], hidden_net[:-1].view(learners, -1, inputs, units))).squeeze(2)
    output = output_net[:-1].view(learners, -1, units + 1)
    values = torch.tanh((active * output[..., :units]).sum(2) + output[..., units])

    future = (1 - hyper["lambda"]) * best + hyper["lambda"] * returned
    goal = torch.clamp(reward + hyper["gamma"] * going * future, -hyper["target_clip"], hyper["target_clip"])

    value = values.view(-1).index_select(0, own)
    active = active.reshape(-1, units).index_select(0, own)
    hidden, output = ([net.index_select(0, number) for net in layer] for layer in (nets[0:3], nets[3:6]))
    error = ((goal - value) * (1 - value * value))[:, None]
    back = error * output[0][:, :units] * (1 - active * active)
    decay = decay.index_select(0, number) * torch.tensor([hyper["beta1"], hyper["beta2"]])
    rate = (hyper["rate"] * torch.sqrt(1 - decay[:, 1]) / (1 - decay[:, 0]))[:, None]
    hidden = adam(hyper, *hidden, x[:, :, None] * back[:, None], rate[:, None])
    output = adam(hyper, *output, error * torch.cat([active, torch.ones_like(error)], dim=1), rate)
    for net, moved in zip(nets, (*hidden, *output, decay)):
        net.index_copy_(0, number, moved)
    return values.amax(1), goal


def prepare(work):
    """A function that replays `passes` times, all learners, and returns their weights."""
    torch.set_num_threads(1)
    torch.set_grad_enabled(False)
    order = np.argsort(work.length)
    batches = [order[at : at + BATCH] for at in range(0, len(order), BATCH)]
    hyper = {name: float(value) for name, value in work.hyper.items()}
    streams = [list(zip(*stream(work, batch))) for batch in batches]
    compiled = torch.compile(learn, dynamic=False)

    def replay(batch, steps, passes):
        nets = begin(work, batch)
        best, returned = torch.zeros(len(batch)), torch.zeros(len(batch))
        for _ in range(passes):
            for step in steps:
                best, returned = compiled(hyper, nets, best, returned, step)
        return nets[0][:-1].numpy(), nets[3][:-1].numpy()

    def run(passes):
        done = [replay(batch, steps, passes) for batch, steps in zip(batches, streams)]
        shape = work.initial["output.weight"].shape
        back = np.argsort(order)
        hidden = np.concatenate([each[0] for each in done]).reshape(*shape[:2], -1, shape[2])[back]
        output = np.concatenate([each[1] for each in done]).reshape(*shape[:2], -1)[back]
        return {
            "hidden.weight": hidden[:, :, :-1].swapaxes(2, 3),
            "hidden.bias": hidden[:, :, -1],
            "output.weight": output[..., :-1],
            "output.bias": output[..., -1],
        }

    return run


def begin(work, batch):
    """A batch's nets before any replay, and one that nobody has."""
    first = {name: values[batch] for name, values in work.initial.items()}
    hidden = np.concatenate([first["hidden.weight"].swapaxes(2, 3), first["hidden.bias"][:, :, None]], axis=2)
    output = np.concatenate([first["output.weight"], first["output.bias"][..., None]], axis=2)
    rows = [torch.from_numpy(layer.reshape(-1, *layer.shape[2:])) for layer in (hidden, output)]
    hidden, output = (torch.cat([layer, torch.zeros_like(layer[:1])]) for layer in rows)
    nets = [hidden, torch.zeros_like(hidden), torch.zeros_like(hidden)]
    nets += [output, torch.zeros_like(output), torch.zeros_like(output)]
    return [*nets, torch.ones(len(output), 2)]


def stream(work, batch):
    """The batch's transitions, time first: inputs, the net of the child, the net that learns, reward, what follows."""
    children = work.initial["output.bias"].shape[1]
    longest = work.length[batch].max()
    of = lambda values: values[batch, :longest]
    ones = np.ones((len(batch), longest, 1), np.float32)
    own = np.arange(len(batch))[:, None] * children + of(work.child)
    # What stands behind the end of a stream is learned by the net that nobody has.
    beyond = np.arange(longest) >= work.length[batch][:, None]
    number = np.where(beyond, len(batch) * children, own)
    going = 1 - of(work.last).astype(np.float32)
    parts = (np.concatenate([of(work.input), ones], axis=2), own, number, of(work.reward), going)
    return [torch.from_numpy(np.ascontiguousarray(part.swapaxes(0, 1))) for part in parts]
