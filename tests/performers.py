"""Virtual players for tests: a body's proportions, performed motions, their joints sampled over time."""

from functools import cache
from pathlib import Path

import numpy as np

from courtside.calibration.court import court
from virtualgym.body import stance
from virtualgym.movement import catalogue

COURT = court.read(Path(__file__).parents[1] / "config" / "courts" / "badminton.yaml")
BODY = stance.Proportions.of_height(1.75)
RATE_HZ = 100


def perform(name, seed=0, **options):
    """Return a new motion of a seed."""
    return catalogue.MOTIONS[name](BODY, COURT, np.random.default_rng(seed), **options)


@cache
def performed(name, seed=0):
    """Return a motion of a seed; the same object each time."""
    return perform(name, seed)


@cache
def filmed(name, seed=0):
    """Return (times (T,) s, stances, joints: name -> (T, 3) m) of a whole motion."""
    motion = performed(name, seed)
    times = np.arange(0, motion.seconds, 1 / RATE_HZ)
    stances = [motion.stance(time_s) for time_s in times]
    placed = [stance.joints(each, BODY) for each in stances]
    return times, stances, {joint: np.array([p[joint] for p in placed]) for joint in placed[0]}


def speed(xyz):
    """Return the speeds (T - 1,) of a path (T, 3), m/s."""
    return np.linalg.norm(np.diff(xyz, axis=0), axis=1) * RATE_HZ


def angles(stances, first, second):
    """Return the angles (T,) between two segments, degrees."""
    cosines = [np.clip(s.directions[first] @ s.directions[second], -1, 1) for s in stances]
    return np.degrees(np.arccos(cosines))
