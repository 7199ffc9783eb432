"""Processes that film together, and random numbers that do not depend on who films what."""

import multiprocessing
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from functools import partial

import cv2
import numpy as np


def stream(seed, *key):
    """Return an independent stream of random numbers, for a seed and a key of whole numbers.

    Parameters
    ----------
    seed : int
    *key : int

    Returns
    -------
    stream : np.random.SeedSequence
    """
    return np.random.SeedSequence(seed, spawn_key=key)


def generator(seed, *key):
    """Return a random generator, np.random.Generator, that draws from `stream`."""
    return np.random.default_rng(stream(seed, *key))


@contextmanager
def crew(make, arguments, threads):
    """Give a function that calls a method of an object for each of some arguments, in order.

    Parameters
    ----------
    make : callable
        Makes the object in each process; of a module, so that processes find it.
    arguments : tuple
        Of `make`.
    threads : int
        Processes; with one, all happens in this.

    Yields
    ------
    call : callable
        (name of the method, list of tuples of arguments) -> iterator of results.
    """
    if threads == 1:
        worker = make(*arguments)
        yield lambda method, calls: (getattr(worker, method)(*each) for each in calls)
        return
    # Spawned: the libraries that render have threads of their own, which a fork would lose.
    context = multiprocessing.get_context("spawn")
    pool = ProcessPoolExecutor(threads, context, _open_worker, (make, arguments))
    try:
        yield lambda method, calls: pool.map(partial(_in_worker, method), calls)
    finally:
        pool.shutdown(cancel_futures=True)  # after an error, no picture more than those begun


_worker = None  # of a rendering process


def _open_worker(make, arguments):
    global _worker
    cv2.setNumThreads(1)
    _worker = make(*arguments)


def _in_worker(method, arguments):
    return getattr(_worker, method)(*arguments)
