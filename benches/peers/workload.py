"""The work that `skilltree bench --export` wrote, as arrays, beside what skilltree made of it.

The README in the exported folder defines every tensor and every formula.
"""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from safetensors import safe_open

RAYS = 24
# Which draws are for what (six are shared by all rays, a word each, and six from BEAMS on by the light's bearings), and the
# scale of each noise: shares, and degrees for the compass. See the README beside the files.
PURPOSE, SHARED, ACTUATOR, COMPASS, BEAMS = 8, 6, 6, 7, 16
SLIP, SONAR, LIGHT, TURNED = np.float32(0.08), np.float32(0.10), np.float32(0.10), np.float32(2.865)
TERM, COARSE = np.float32(2.6429e-5), np.float32(6.765875e-3)


@dataclass(frozen=True)
class Walk:
    """Robots, the action and the noise of every step, a floor; lengths in inches, angles in degrees."""

    start: np.ndarray  # [robots, 3] x, y, heading
    seed: np.ndarray  # [robots, 2] key of each robot's random numbers
    action: np.ndarray  # [steps, robots] 0 to 5
    slip: np.ndarray  # [steps, robots] factor
    sonar_noise: np.ndarray  # [steps, robots, 24] factor
    light_noise: np.ndarray  # [steps, robots, 24] factor
    compass_noise: np.ndarray  # [steps, robots] degrees
    segment: np.ndarray  # [segments, 7] ax, ay, bx, by, tx, ty, length
    charger: np.ndarray  # [segments] bool
    light: np.ndarray  # [2] x, y
    light_range2: np.float32
    dock_cosine: np.float32
    expected: dict[str, np.ndarray]  # what skilltree reads after each step, named as a peer's result is

    @property
    def count(self):
        """Robot-steps."""
        return self.action.size


@dataclass(frozen=True)
class Drill:
    """Learners, their first nets, and their lessons as one stream of transitions each, in the order of replay."""

    input: np.ndarray  # [learners, transitions, inputs]
    child: np.ndarray  # [learners, transitions]
    reward: np.ndarray  # [learners, transitions]
    last: np.ndarray  # [learners, transitions] bool: a lesson's last step, with which its replay begins
    length: np.ndarray  # [learners] transitions of one pass; what lies beyond is padding
    initial: dict[str, np.ndarray]
    once: dict[str, np.ndarray]  # skilltree's weights after one pass
    expected: dict[str, np.ndarray]  # and after all passes
    passes: int
    hyper: dict[str, np.float32]

    @property
    def count(self):
        """Transitions replayed in all passes."""
        return int(self.length.sum()) * self.passes


def read(path):
    """All tensors of a file and its numbers."""
    with safe_open(path, framework="np") as file:
        numbers = json.loads(file.metadata()["skilltree"])
        return {name: file.get_tensor(name) for name in file.keys()}, numbers


def walk(folder):
    """Reads `simulate.safetensors`."""
    tensor, number = read(Path(folder) / "simulate.safetensors")
    expected = {
        "pose": tensor["expected.pose"],
        "compass": tensor["expected.compass"],
        "sonar": tensor["expected.sonar"],
        "light": tensor["expected.light"] != 0,
        "bumpers": np.packbits(tensor["expected.bumpers"], axis=2, bitorder="little")[..., 0],
        "events": tensor["expected.events"],
    }
    return Walk(
        start=tensor["start"],
        seed=tensor["seed"],
        action=tensor["action"],
        slip=tensor["noise.slip"],
        sonar_noise=tensor["noise.sonar"],
        light_noise=tensor["noise.light"],
        compass_noise=tensor["noise.compass"],
        segment=tensor["segment"],
        charger=tensor["segment.charger"] != 0,
        light=np.array([number["light_x"], number["light_y"]], np.float32),
        light_range2=np.float32(number["light_range2"]),
        dock_cosine=np.float32(number["dock_cosine"]),
        expected=expected,
    )


def drill(folder):
    """Reads `replay.safetensors`."""
    tensor, number = read(Path(folder) / "replay.safetensors")
    length, given = tensor["lesson.length"], tensor["lesson"]
    # Every lesson backwards, one lesson after another.
    streams = [[(n, step) for n in own for step in reversed(range(length[n]))] for own in given]
    longest = max(map(len, streams))
    index = np.array([stream + [(0, 0)] * (longest - len(stream)) for stream in streams])
    lesson, step = index[..., 0], index[..., 1]
    names = ("hidden.weight", "hidden.bias", "output.weight", "output.bias")
    hyper = ("gamma", "lambda", "rate", "beta1", "beta2", "epsilon2", "target_clip")
    return Drill(
        input=tensor["lesson.input"][lesson, step],
        child=tensor["lesson.child"][lesson, step],
        reward=tensor["lesson.reward"][lesson, step],
        last=step == length[lesson] - 1,
        length=np.array([len(stream) for stream in streams]),
        initial={name: tensor[f"initial.{name}"] for name in names},
        once={name: tensor[f"once.{name}"] for name in names},
        expected={name: tensor[f"expected.{name}"] for name in names},
        passes=number["passes"],
        hyper={name: np.float32(number[name]) for name in hyper},
    )
