"""One peer in a process of its own: prepares, does the work once, is checked, and then does it again whenever told.

Usage: worker.py NAME FOLDER. Prints a line on the check when ready; then, for each line read, the CPU-seconds of one
more time.
"""

import importlib
import sys
import time

import check
import workload

# Name of a peer: what it does, its module, and what it is told beforehand.
PEERS = {
    "jax, noise given": ("robot-steps", "simulate_jax", {"drawn": False}),
    "jax": ("robot-steps", "simulate_jax", {"drawn": True}),
    "numba, noise given": ("robot-steps", "simulate_numba", {"drawn": False}),
    "numba": ("robot-steps", "simulate_numba", {"drawn": True}),
    "jax, replay": ("transitions-adam", "replay_jax", {}),
    "torch, replay": ("transitions-adam", "replay_torch", {}),
    "numba, replay": ("transitions-adam", "replay_numba", {}),
}
# Passes of one timing of replay: enough to be timed, fewer than are checked.
PASSES = 10


def begin(name, folder):
    """Prepares a peer and checks it; returns a line on the check, a function to time, and the units of one call."""
    task, module, told = PEERS[name]
    peer = importlib.import_module(module)
    if task == "robot-steps":
        work = workload.walk(folder)
        run = peer.prepare(work, **told)
        return check.walk(work, run()), run, work.count
    work = workload.drill(folder)
    run = peer.prepare(work, **told)
    agreed = check.drill(work, run(1), run(work.passes))
    return agreed, lambda: run(PASSES), int(work.length.sum()) * PASSES


def main():
    name, folder = sys.argv[1:]
    try:
        agreed, run, units = begin(name, folder)
    except check.Mismatch as mismatch:
        sys.exit(f"{name}: {mismatch}")
    run()
    print(agreed, flush=True)
    for _ in sys.stdin:
        before = time.process_time()
        run()
        print(units / (time.process_time() - before), flush=True)


if __name__ == "__main__":
    main()
