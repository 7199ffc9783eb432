"""Whether a landmark network gains by several crops at once.

    python benchmarks/pose_batches.py RESULTS [--models blazepose-full blazepose-heavy]
        [--sizes 1 2 4 8] [--rounds 12] [--provider cpu]

RESULTS is of a run that converted the networks. Each is brought to a number of crops (the first
dimension of its input and of the sizes that it states) and runs on the same made crops, one thread,
all sizes in turn in each round; the least time a crop counts: processor time by `cpu`, else wall
time. `apart` is the largest difference of any output from that of single crops by the same
provider, over the output's largest value.
"""

import argparse
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np

from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.pose.networks import session
from courtside.pose.networks.batches import of_size


def measure(path, sizes, rounds, provider="cpu"):
    """Return {size: (ms a crop, largest relative difference)}."""
    clock = time.process_time if provider == "cpu" else time.perf_counter
    opened = partial(session.open_session, path, [provider])
    networks = {size: opened(of_size(path, size)) for size in sizes}
    name, shape = networks[sizes[0]].get_inputs()[0].name, networks[sizes[0]].get_inputs()[0].shape
    crops = np.random.default_rng(0).random((max(sizes), *shape[1:]), np.float32)
    single = opened(of_size(path, 1))
    alone = [
        np.concatenate(each)
        for each in zip(*(single.run(None, {name: one[None]}) for one in crops), strict=True)
    ]
    ms, apart = dict.fromkeys(sizes, np.inf), {}
    for _ in range(rounds):
        for size, network in networks.items():
            start = clock()
            found = network.run(None, {name: crops[:size]})
            ms[size] = min(ms[size], 1000 * (clock() - start) / size)
            pairs = zip(found, alone, strict=True)
            apart[size] = max(float(np.abs(a - b[:size]).max() / np.abs(b).max()) for a, b in pairs)
    return {size: (ms[size], apart[size]) for size in sizes}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("--models", nargs="+", default=["blazepose-full", "blazepose-heavy"])
    parser.add_argument("--sizes", type=int, nargs="+", default=[1, 2, 4, 8])
    parser.add_argument("--rounds", type=int, default=12)
    parser.add_argument("--provider", choices=session.PROVIDERS, default="cpu")
    given = parser.parse_args()
    for name in given.models:
        path = given.results / "networks" / name / "landmarks.onnx"
        found = measure(path, given.sizes, given.rounds, given.provider)
        for size, (ms, apart) in found.items():
            print(f"{name}, {size} at once: {ms:.2f} ms a crop, apart {apart:.1e}")


if __name__ == "__main__":
    main()
