"""Whether a peer's results are skilltree's.

Peers add in another order and have other elementary functions, so their last bits differ. What that may do is stated
here as limits; beyond them a peer does other work, and its speed means nothing.
"""

import numpy as np

# A robot has left skilltree's path where its pose is farther off than this, inches and degrees.
POSE_LIMIT = 1e-3
# A touch that is missed by a last bit sends a robot another way.
POSE_SHARE = 0.9999
# Of the robot-steps that agree in pose: a range next to half an inch is rounded to the other side, a brightness next
# to the threshold falls on the other side, and so may a ray next to a corner.
SHARE = {"sonar": 0.9999, "light": 0.99999, "bumpers": 0.9999, "events": 0.9999, "compass": 0.9999}
# Weights after one pass, and after all: differences grow as they are learned from.
WEIGHT_LIMITS = {"once": 1e-5, "all": 3e-3}


class Mismatch(Exception):
    """A peer's results are not skilltree's."""


def walk(work, result):
    """Compares robots; returns a line on how well they agree."""
    pose, expected = result["pose"], work.expected["pose"]
    same = np.abs(apart(pose, expected)).max(axis=2) <= POSE_LIMIT
    # A robot that went another way once does not come back.
    same = np.logical_and.accumulate(same, axis=0)
    shares = {"pose": (same.mean(), POSE_SHARE)}
    for name, least in SHARE.items():
        if name == "compass":
            equal = np.abs(turned(result[name], work.expected[name])) <= POSE_LIMIT
        else:
            equal = result[name] == work.expected[name]
        shares[name] = (equal[same].mean(), least)
    for name, (share, least) in shares.items():
        # Written so that a share that is no number fails.
        if not share >= least:
            raise Mismatch(f"{name}: {share:.6f} of the readings agree, {least} must")
    return ", ".join(f"{name} {share:.4%}" for name, (share, _least) in shares.items())


def apart(pose, expected):
    """Differences of poses, headings the short way round."""
    return np.concatenate([pose[..., :2] - expected[..., :2], turned(pose[..., 2:], expected[..., 2:])], axis=-1)


def turned(angle, expected):
    """Difference of angles in degrees, the short way round."""
    return (angle - expected + 180) % 360 - 180


def drill(work, once, result):
    """Compares weights after one pass and after all; returns a line on how well they agree."""
    found = {}
    for label, weights, expected in (("once", once, work.once), ("all", result, work.expected)):
        # Learning must have moved the weights far more than they may differ.
        moved = max(np.abs(expected[name] - work.initial[name]).max() for name in expected)
        worst = max(np.abs(weights[name] - expected[name]).max() for name in expected)
        limit = WEIGHT_LIMITS[label]
        if not (worst <= limit < moved / 100):
            allowed = f"{limit:.0e} allowed; learning moved them {moved:.1e}"
            raise Mismatch(f"weights after {label}: {worst:.1e} off, {allowed}")
        found[label] = worst
    return f"weights within {found['once']:.1e} after one pass, {found['all']:.1e} after {work.passes}"
