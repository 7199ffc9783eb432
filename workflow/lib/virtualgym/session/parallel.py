"""Worker processes, and random numbers that do not depend on the division of work."""

import multiprocessing
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from functools import partial
from typing import Any

import cv2
import numpy as np


def stream(seed: int, *key: int) -> np.random.SeedSequence:
    """Return an independent stream of random numbers for a seed and a key of integers."""
    return np.random.SeedSequence(seed, spawn_key=key)


def generator(seed: int, *key: int) -> np.random.Generator:
    """Return a random generator that draws from `stream`."""
    return np.random.default_rng(stream(seed, *key))


@contextmanager
def workers(
    make: Callable[..., object], arguments: tuple, threads: int
) -> Iterator[Callable[[str, Iterable[tuple]], Iterator]]:
    """Make an object in each of several processes; call its methods there.

    Parameters
    ----------
    make : callable
        Makes the object, from `arguments`; defined in a module, so that it can be pickled.
    arguments : tuple
    threads : int
        Number of processes; 1: everything runs in this one.

    Yields
    ------
    call : callable
        (name of the method, list of tuples of arguments) -> iterator of results, in order.
    """
    if threads == 1:
        worker = make(*arguments)
        yield lambda method, calls: (getattr(worker, method)(*each) for each in calls)
        return
    # Spawn: the rendering libraries have threads of their own, which a fork would lose.
    context = multiprocessing.get_context("spawn")
    pool = ProcessPoolExecutor(threads, context, _open_worker, (make, arguments))
    try:
        yield lambda method, calls: pool.map(partial(_in_worker, method), calls)
    finally:
        pool.shutdown(cancel_futures=True)  # after an error, start no more pictures


_worker: Any = None  # the object that `make` made in this process; its type is the caller's


def _open_worker(make: Callable[..., object], arguments: tuple) -> None:
    global _worker
    cv2.setNumThreads(1)
    _worker = make(*arguments)


def _in_worker(method: str, arguments: tuple) -> Any:
    return getattr(_worker, method)(*arguments)
