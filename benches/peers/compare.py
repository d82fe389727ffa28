"""Does the same work with skilltree and with its peers, checks that it is the same, and prints rates and ratios.

Everything runs on one core with one thread. Samples of all are taken in turn, forwards and backwards; a ratio is made of
two samples of the same round. A peer whose results are not skilltree's ends the command with exit code 1 before anything
is timed.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from worker import PEERS

HERE = Path(__file__).parent
THREADS = ("NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def main():
    arguments = parse()
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {arguments.core})
    os.environ.update({name: "1" for name in THREADS}, XLA_FLAGS="--xla_cpu_multi_thread_eigen=false")
    with tempfile.TemporaryDirectory() as folder:
        skilltree(arguments, "--export", folder)
        workers = {}
        try:
            for name in PEERS:
                workers[name] = start(name, folder)
            rounds = [measure(arguments, workers, number) for number in range(arguments.samples)]
        finally:
            for worker in workers.values():
                worker.stdin.close()
                worker.wait()
    show(rounds)


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("skilltree", help="the program, built for release")
    parser.add_argument("--samples", type=int, default=7, help="of everything, taken in turn (7)")
    parser.add_argument("--core", type=int, default=0, help="the core on which everything runs (0)")
    return parser.parse_args()


def skilltree(arguments, *words):
    """What `skilltree bench` prints; ends this program where it fails."""
    done = subprocess.run([arguments.skilltree, "bench", *words], stdout=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit(f"skilltree bench {' '.join(words)} failed, exit code {done.returncode}")
    return done.stdout


def start(name, folder):
    """Starts a peer and waits until it is checked; ends this program where it is wrong."""
    command = [sys.executable, HERE / "worker.py", name, folder]
    worker = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    agreed = worker.stdout.readline().strip()
    if not agreed:
        sys.exit(f"{name}: its results are not skilltree's, or it failed (see above); nothing was timed")
    print(f"{name}: {agreed}", flush=True)
    return worker


def measure(arguments, workers, number):
    """One sample of everybody: units per CPU-second by task and name, and the CPU's name."""
    rates = {}

    def ours():
        report = json.loads(skilltree(arguments, "--json", "--backend", "cpu", "--samples", "1", "--learners", "0"))
        for task in report["tasks"]:
            for row in task["rows"]:
                if row["executor"] == "cpu-1":
                    rates[task["name"], "skilltree"] = row["per_cpu_second"]["median"]
        rates["cpu"] = report["origin"]["cpu"]

    def peer(name):
        worker = workers[name]
        worker.stdin.write("again\n")
        worker.stdin.flush()
        answer = worker.stdout.readline()
        if not answer:
            sys.exit(f"{name} failed (see above)")
        rates[PEERS[name][0], name] = float(answer)

    turns = [ours, *(lambda name=name: peer(name) for name in workers)]
    for turn in turns if number % 2 == 0 else reversed(turns):
        turn()
    return rates


def show(rounds):
    """Prints medians and quartiles over the rounds."""
    print(f"\n{rounds[0]['cpu']}, one core, {len(rounds)} samples in turn: medians [quartiles]\n")
    print(f"{'work':<18} {'who':<20} {'M per CPU-second':>24} {'skilltree is':>24}")
    for task in dict.fromkeys(task for task, *_ in PEERS.values()):
        for name in ["skilltree", *(name for name, peer in PEERS.items() if peer[0] == task)]:
            rates = [found[task, name] * 1e-6 for found in rounds]
            ratios = [found[task, "skilltree"] / found[task, name] for found in rounds]
            faster = "" if name == "skilltree" else spread(ratios, 2) + " x"
            print(f"{task:<18} {name:<20} {spread(rates, 3):>24} {faster:>24}")


def spread(values, digits):
    """Median and quartiles in words."""
    low, middle, high = statistics.quantiles(values, n=4, method="inclusive") if len(values) > 1 else values * 3
    return f"{middle:.{digits}f} [{low:.{digits}f}, {high:.{digits}f}]"


if __name__ == "__main__":
    main()
