"""How fast one core of this machine is at best, measured: arithmetic and memory.

    python benchmarks/machine.py

A program can be no faster than its arithmetic over the first and its bytes over the second.
"""

import time
from dataclasses import dataclass
from functools import cache

import numpy as np

import peers

SIDE = 1024  # of the matrices that are multiplied
COPIED_BYTES = 1 << 28  # far more than any cache
REPEATS = 5


@dataclass(frozen=True)
class Machine:
    """One core.

    Attributes
    ----------
    flops_32, flops_64 : float
        Additions and multiplications per second, of numbers of so many bits, in a product of
        matrices.
    bytes_s : float
        Read and written per second by a copy of what no cache holds.
    """

    flops_32: float
    flops_64: float
    bytes_s: float


def least(function, repeats=REPEATS):
    """Return the least processor time of some runs, s, and what the last returned."""
    best_s, found = np.inf, None
    for _ in range(repeats):
        start = time.process_time()
        found = function()
        best_s = min(best_s, time.process_time() - start)
    return best_s, found


@cache
def measured():
    """Return the `Machine`, measured once in a process."""
    flops = []
    for kind in (np.float32, np.float64):
        matrix = np.ones((SIDE, SIDE), kind)
        best_s, _ = least(lambda matrix=matrix: matrix @ matrix)
        flops.append(2 * SIDE**3 / best_s)
    source = np.ones(COPIED_BYTES, np.uint8)
    target = np.empty_like(source)
    target[:] = 0  # so that its pages are there
    best_s, _ = least(lambda: np.copyto(target, source))
    return Machine(*flops, 2 * COPIED_BYTES / best_s)


if __name__ == "__main__":
    peers.on_one_thread()
    found = measured()
    print(f"{found.flops_32 / 1e9:.1f} GFlop/s of 32 bits, {found.flops_64 / 1e9:.1f} of 64 bits")
    print(f"{found.bytes_s / 1e9:.1f} GB/s read and written by a copy")
